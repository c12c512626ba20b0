"""The benchmark of perturbation boundaries runs, compares like with like, and derives exactly."""

import numpy as np
import pytest
from elastolink.runtime.benchmarking import benchmark_perturbation
from elastolink.runtime.benchmarking.perturbation import matrix_ends
from elastolink.runtime.benchmarking.records import functions
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.perturbation.effective import effective_operator
from smith_chapter_8.exact import exact_operator
from smith_chapter_8.surd import ExactHarmonics

REGIONS = (1, 2, 3, 4, 5, 6)


@pytest.fixture
def pinned(monkeypatch):
    """Stay in this process: timings are not asserted here."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        monkeypatch.setenv(name, "1")


def exact_derivation():
    """Derive A and B of regions 1-6 to order 8 for 24 harmonics: what ``docs/benchmarks.md`` times.

    The coefficients are doubles, taken as the rational numbers that they are.
    """
    f = functions()["24 harmonics"]
    exact = ExactHarmonics.of(float(f.a[0]), f.a[1:].tolist(), f.b[1:].tolist())
    return [exact_operator([exact], n, 8) for n in REGIONS]


def test_the_benchmark(pinned):
    found = benchmark_perturbation(values=40, rounds=1)
    assert [row.contender for row in found.rows] == [
        "elastolink, a new function",
        "elastolink",
        "hill_boundaries",
        "numpy.linalg.eigvalsh",
        "elastolink",
        "hill_boundaries",
        "numpy.linalg.eigvalsh, 250 at a time",
        "numpy.linalg.eigvalsh",
    ]
    assert found.passed
    assert all(row.milliseconds > 0 for row in found.rows)
    high, low = found.rows[:4], found.rows[4:]
    # Order 8 at mu = 0.1, order 4 below: the rival is cut so as not to be more exact than needed.
    assert all(row.error < 1e-10 for row in high)
    assert all(row.error < 1e-5 for row in low)
    for ours, rival in ((high[0], high[3]), (low[0], low[3])):
        assert 1e-4 * ours.error < rival.error <= max(ours.error, 1e-13)
    assert all(row.contender in found.table() for row in found.rows)


def test_the_rival_solves_the_same_problem():
    f, mu = functions()["f3 (5,1,5,2)"], np.array([-0.6, 0.0, 0.3])
    ours = hill_boundaries(f, mu, REGIONS)
    rival = matrix_ends(f, mu, 30)
    np.testing.assert_allclose(np.stack([ours.lower, ours.upper]), rival, rtol=0, atol=1e-12)


def test_the_exact_derivation_of_order_eight():
    f = functions()["24 harmonics"]
    for n, exact in zip(REGIONS, exact_derivation(), strict=True):
        found = effective_operator([f], n, 8)
        for k in range(8):
            for ours, theirs in (
                (found.diagonal[k], exact.diagonal[k]),
                (found.coupling[k], exact.coupling[k]),
            ):
                expected = np.array([complex(*map(float, pair)) for pair in theirs])
                assert abs(ours - expected)[0] <= 1e-13 * float(f.amplitudes.sum()) ** (k + 1)


@pytest.mark.parametrize("arguments", [{"values": 0}, {"rounds": 0}])
def test_bad_input(arguments):
    with pytest.raises(BadInput, match="benchmark_perturbation"):
        benchmark_perturbation(**arguments)
