"""The benchmark of the rod's chart at tiny sizes: its parts, its reference, its plumbing."""

import sys

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.benchmarking import benchmark_rod
from elastolink.runtime.benchmarking.rod import PROBLEMS, heyoka_loop, rod_of
from elastolink.runtime.benchmarking.rod_reference import (
    Entries,
    monodromy_in_long_doubles,
    solve_once,
)
from elastolink.runtime.charts.invariants import characteristic
from elastolink.runtime.core.errors import BadInput

SPEEDS = np.array([700.0, 1500.0, 4000.0])


@pytest.fixture
def pinned(monkeypatch):
    """Stay in this process: timings are not asserted here."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        monkeypatch.setenv(name, "1")


@pytest.fixture(scope="module")
def entries():
    return Entries.of(rod_of(PROBLEMS[0]))


def test_the_reference_agrees_with_collocation(entries):
    """Taylor series in extended precision on Fourier series, against collocation of the system."""
    found = characteristic(monodromy_in_long_doubles(entries, SPEEDS), reduced=True)
    direct = el.monodromy(rod_of(PROBLEMS[0]), SPEEDS, rtol=1e-13)
    wanted = characteristic(direct.scaled, reduced=True)
    assert np.max(np.abs(found - wanted)) <= 1e-11 * np.max(np.abs(wanted))


def test_the_peers_solve_the_same_problem(entries):
    truth = monodromy_in_long_doubles(entries, SPEEDS).astype(float)
    one = solve_once(entries, SPEEDS[1], 1e-9)
    assert np.max(np.abs(one - truth[1])) < 1e-6
    pytest.importorskip("heyoka")
    # Compiling in the compact mode takes a second each.
    for batch in (1, 2):
        found = heyoka_loop(entries, batch, compact=True)(SPEEDS)
        assert np.max(np.abs(found - truth)) < 1e-8


def test_every_contender_is_named_and_the_paper_beside(pinned, monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    found = benchmark_rod(points=(40, 20), rounds=1, problems=PROBLEMS[:1])
    names = [row.contender for row in found.rows]
    assert names == [
        "elastolink",
        "solve_ivp (DOP853)",
        "heyoka, batch, Fourier entries",
        "heyoka, one point at a time",
        "Beale & Scott's estimate",
    ]
    assert found.passed
    assert found.error < 1e-9
    assert "us a point" in found.rows[0].note
    # 300 minutes for each of 800 points.
    assert found.rows[-1].milliseconds == pytest.approx(800 * 300 * 6e4)
    assert "not run" in found.rows[-1].note
    assert [row.note for row in found.rows[2:4]] == ["not installed"] * 2
    assert "not installed" in found.table()


@pytest.mark.parametrize("given", [{"points": (8, 40)}, {"rounds": 0}, {"problems": ("5 modes",)}])
def test_unusable_numbers_are_refused(given):
    with pytest.raises(BadInput):
        benchmark_rod(**given)
