"""The rivals of the stress curve's benchmark solve the same problem; its rows and refusals."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.benchmarking.curve_rivals import (
    SecondOrder,
    StressMaxima,
    collocated,
    marched,
    newmark_march,
)
from elastolink.runtime.benchmarking.records import Row
from elastolink.runtime.benchmarking.stress_curve import _to_our_error, benchmark_stress_curve
from elastolink.runtime.core.errors import BadInput


@pytest.fixture(scope="module")
def system():
    return el.load_scene("aannaque_1996_table_4_1", overrides={"mesh.elements": 1}).system()


def test_collocation_converges_on_the_harmonic_balance(system):
    """Another assembly and another solver: the maxima agree to the collocation's own change."""
    maxima = StressMaxima(system, 3)
    found = [maxima(collocated(SecondOrder(system, n), 30.0)) for n in (97, 145)]
    assert found[0] == pytest.approx(found[1], rel=1e-5)
    steady = el.steady_state(system, 30.0, method="harmonic_balance", stability=False)
    assert maxima(steady.q) == pytest.approx(found[1], rel=1e-6)


def test_newmark_approaches_it_with_the_square_of_the_step(system):
    pytest.importorskip("numba")
    march, maxima = newmark_march(), StressMaxima(system, 3)
    truth = maxima(collocated(SecondOrder(system, 145), 30.0))
    errors = []
    for steps in (1024, 2048):
        found = maxima(marched(SecondOrder(system, steps), 30.0, 30, march))
        errors.append(np.max(np.abs(found / truth - 1.0)))
    assert errors[1] < 2e-3
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_the_row_at_our_error_says_that_it_was_not_run():
    row = Row("p", "Newmark, compiled", 100.0, 9e-5, 10.0, sampled=True)
    found = _to_our_error(row, 1e-5)
    assert found.ratio == pytest.approx(30.0)
    assert "not run" in found.note


def test_too_few_samples_are_refused():
    with pytest.raises(BadInput, match="samples"):
        benchmark_stress_curve(samples=0)
