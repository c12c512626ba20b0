import os
import sys

import numpy as np
import pytest
from elastolink.runtime.benchmarking import (
    benchmark_chart,
    benchmark_mathieu,
    benchmark_slices,
)
from elastolink.runtime.benchmarking.bisection import Brackets
from elastolink.runtime.benchmarking.mathieu import _remark
from elastolink.runtime.benchmarking.records import Contender, compare, functions, one_thread
from elastolink.runtime.benchmarking.reference import half_traces
from elastolink.runtime.benchmarking.slices import banded_boundaries
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import discriminant, hill_boundaries

PINNED = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@pytest.fixture
def pinned(monkeypatch):
    """Stay in this process: timings are not asserted here."""
    for name in PINNED:
        monkeypatch.setenv(name, "1")


def test_the_chart_benchmark_names_every_contender(pinned):
    pytest.importorskip("heyoka")
    found = benchmark_chart(points=60, rounds=1, sample=16, problems=("f3 (10,1,10,4)",))
    names = [row.contender for row in found.rows]
    assert names[0] == "elastolink"
    assert [name.split()[0].rstrip(",") for name in names[1:]] == ["heyoka", "heyoka", "solve_ivp"]
    assert found.rows[0].ratio == 1.0
    assert all(row.milliseconds > 0 for row in found.rows)
    assert all(row.error < 1e-10 for row in found.rows)
    assert found.passed
    table = found.table()
    assert all(name in table for name in names)
    assert len(found.to_dict()["rows"]) == 4


def test_a_peer_that_is_not_installed_is_left_out_with_a_note(pinned, monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    found = benchmark_chart(points=20, rounds=1, sample=16, problems=("f3 (10,1,10,4)",))
    notes = {row.contender: row.note for row in found.rows}
    assert [name for name, note in notes.items() if note == "not installed"] == [
        "heyoka, batch loop over every point",
        "heyoka at Chebyshev nodes, same interpolation",
    ]
    assert found.to_dict()["rows"][-1]["milliseconds"] is None
    assert "not installed" in found.table()


def test_the_slices_benchmark(pinned):
    pytest.importorskip("heyoka")
    found = benchmark_slices(slices=3, rounds=1, problems=("f3 (10,1,10,4)",))
    names = [row.contender for row in found.rows]
    assert [name.split(",")[0] for name in names] == [
        "elastolink",
        "ten lines with eig_banded",
        "elastolink",
        "heyoka",
        "heyoka",
        "solve_ivp (DOP853",
        "elastolink",
        "ten lines with eig_banded",
    ]
    assert found.passed
    assert set(found.checks) == {"error of the boundaries", "widest certified enclosure"}
    ours = [row for row in found.rows if row.contender.startswith("elastolink")]
    assert all(row.error < 1e-12 for row in ours)
    # Bisection to 1e-12 of a half trace good to 1e-12 over its slope.
    assert all(row.error < 1e-10 for row in found.rows)


def test_bisection_without_heyoka_says_so(pinned, monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    found = benchmark_slices(slices=1, rounds=1, problems=("f3 (10,1,10,4)",))
    assert sum(row.note == "not installed" for row in found.rows) == 2


def test_brackets_hold_the_ends():
    f = functions()["f3 (5,1,5,2)"]
    ends = hill_boundaries(f, 1.0, (1, 2, 3, 4, 5, 6))
    floor = hill_boundaries(f, 1.0, (0,)).upper[0]
    brackets = Brackets.of(np.stack([ends.lower, ends.upper]), floor)
    assert np.all((brackets.inside - brackets.truth) * (brackets.outside - brackets.truth) < 0)
    trace = lambda lam2, mu: discriminant(f, lam2, mu).value  # noqa: E731
    for found in (brackets.bisect(trace, 1.0), brackets.one_by_one(trace, 1.0)):
        assert brackets.error(found) < 1e-10
    assert np.all(np.abs(trace(brackets.inside, 1.0)) > 1.0)
    assert np.all(np.abs(trace(brackets.outside, 1.0)) < 1.0)


def test_the_mathieu_benchmark(pinned):
    found = benchmark_mathieu(orders=(0, 1, 2, 3, 10), strengths=(5.0, 15.525, 1e4), rounds=1)
    assert found.passed and found.error < 1e-14
    assert [row.contender for row in found.rows] == ["elastolink", "scipy.special"] * 3
    assert all(row.error < 1e-14 for row in found.rows[::2])
    assert found.rows[0].problem == "q = 5" and found.rows[1].error < 1e-14
    assert "scipy.special" in found.table()


def test_the_remark_counts_other_branches():
    assert _remark(np.array([1e-15, 0.3, np.inf]), ["a_0", "a_1", "b_1"]) == (
        "2 of 3 wrong: a_1, b_1"
    )
    assert _remark(np.array([1e-15]), ["a_0"]) == ""


def test_the_rival_of_the_slices_solves_the_same_problem():
    f = functions()["f3 (5,1,5,2)"]
    ours = hill_boundaries(f, -0.6, (1, 2, 3, 4, 5, 6))
    rival = banded_boundaries(f, -0.6, 30)
    np.testing.assert_allclose(np.stack([ours.lower, ours.upper]), rival, rtol=0, atol=1e-12)


def test_the_reference_of_a_constant():
    found = half_traces(PeriodicFunction([0.5]), [1.0, -2.0], 1.0, 0.1)
    root = np.sqrt(np.array([1.49, -1.51], dtype=complex))
    exact = (np.exp(-0.2 * np.pi) * np.cos(2 * np.pi * root)).real
    np.testing.assert_allclose(found.astype(float), exact, rtol=1e-13)


def test_times_are_scaled_by_the_share():
    contenders = [
        Contender("whole", lambda: 1.0, lambda found: found),
        Contender("part", lambda: 2.0, lambda found: found, share=1e-9),
    ]
    whole, part = compare("nothing", contenders, 5)
    assert (whole.error, part.error) == (1.0, 2.0)
    assert part.sampled
    assert not whole.sampled
    assert part.milliseconds > whole.milliseconds


def test_threads_are_pinned_in_a_new_process(monkeypatch):
    for name in PINNED:
        monkeypatch.delenv(name, raising=False)
    seen = one_thread(_environment)
    assert seen == "1 1"
    assert all(name not in os.environ for name in PINNED)


def _environment():
    return " ".join(os.environ[name] for name in PINNED)


@pytest.mark.parametrize(
    "arguments", [{"points": 1}, {"rounds": 0}, {"sample": 3}, {"problems": ("nothing",)}]
)
def test_bad_input(arguments):
    with pytest.raises(BadInput, match="benchmark_chart"):
        benchmark_chart(**arguments)
    with pytest.raises(BadInput, match="benchmark_slices"):
        benchmark_slices(slices=0)
    with pytest.raises(BadInput, match="correct the name"):
        benchmark_slices(problems=("nothing",))
    with pytest.raises(BadInput, match="benchmark_mathieu"):
        benchmark_mathieu(strengths=(0.0,))
