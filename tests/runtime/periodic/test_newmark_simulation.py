"""Simulation by Newmark's scheme and generalized-alpha, and the Radau points."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import SelfCheckFailed
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.floquet.second_order import even_count, second_order, second_order_at
from elastolink.runtime.integrators.radau import RadauTableau, radau_tableau
from elastolink.runtime.simulation import simulate
from manufactured import manufactured

SECOND = ("newmark", "generalized_alpha")


@pytest.mark.parametrize("method", SECOND)
@pytest.mark.parametrize("seed", [3, 8])
def test_the_order_is_two_with_every_term_of_the_family(method, seed):
    system, speed, _ = manufactured(seed)
    errors = [
        float(np.max(simulate(system, speed, 1.3, method, steps=steps, start=0.4).error))
        for steps in (1440, 2880, 5760)
    ]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("method", SECOND)
def test_a_wanted_error_is_reached_and_the_period_may_be_any(method):
    wave = np.array([[0.3]])
    terms = (
        Term("M", None, lambda theta: 1.0 + np.cos(1.7 * theta)[:, None, None] * wave),
        Term("K", None, 9.0 * np.eye(1)),
        Term("C", None, 0.1 * np.eye(1)),
        Term("f", None, lambda theta: np.sin(1.7 * theta)[:, None]),
    )
    system = LinearPeriodic(1, terms, {}, lambda values: {}, period=2 * np.pi / 1.7)
    run = simulate(system, 1.0, 3.5, method, rtol=1e-3)
    assert run.success and run.passed and np.max(run.error) <= 1e-3
    other = simulate(system, 1.0, 3.5, samples=360)
    step = (len(run.theta) - 1) // (len(other.theta) - 1)
    gap = np.max(np.abs(run.q[::step] - other.q)) / np.max(np.abs(other.q))
    assert gap <= np.max(run.error) + np.max(other.error)


@pytest.mark.parametrize("method", SECOND)
def test_without_forcing_none_acts(method):
    """The free motion of a forced system, beside that of the default method."""
    system, speed, _ = manufactured(4)
    start = ([1e-3] * system.size, 0.0)
    given = {"initial": start, "forcing": False, "samples": 360}
    run = simulate(system, speed, 1.0, method, steps=1440, **given)
    other = simulate(system, speed, 1.0, **given)
    forced = simulate(system, speed, 1.0, initial=start, samples=360)
    gap, size = np.max(np.abs(run.q - other.q)), np.max(np.abs(other.q))
    assert gap <= size * (np.max(run.error) + np.max(other.error)) <= 0.02 * size
    assert np.max(np.abs(forced.q - other.q)) > 10.0 * gap


def test_the_coefficients_are_the_same_by_series_and_at_even_angles():
    system, speed, _ = manufactured(5)
    form = canonical_form(system, speed, {}, forcing=True)
    count = even_count(system)
    even = second_order(form, count)
    theta = np.arange(count) * system.period / count
    other = second_order_at(form, theta)
    for name in ("mass", "rate", "stiffness", "force"):
        np.testing.assert_allclose(getattr(even, name), getattr(other, name), atol=1e-10)
    # M' by the difference of neighbours.
    near = second_order_at(form, np.array([0.7 - 1e-5, 0.7, 0.7 + 1e-5]))
    slope = (near.mass[0, 2] - near.mass[0, 0]) / 2e-5
    gyro = form.assemble("A", np.array([0.7]))[0, 0]
    drag = form.assemble("C", np.array([0.7]))[0, 0]
    np.testing.assert_allclose(near.rate[0, 1], slope + gyro - gyro.T + drag, atol=1e-8)


@pytest.mark.parametrize("stages", [1, 2, 3, 5, 8, 12])
def test_radau_points_prove_themselves(stages):
    found = radau_tableau(stages)
    assert found.c[-1] == 1.0 and found.order == 2 * stages - 1
    if stages == 2:
        np.testing.assert_allclose(found.c, [1 / 3, 1.0], rtol=1e-14)
        np.testing.assert_allclose(found.a, [[5 / 12, -1 / 12], [3 / 4, 1 / 4]], rtol=1e-14)
    # What a step does not resolve dies at once.
    unit = np.ones(stages)
    stiff = 1.0 - 1e9 * found.b @ np.linalg.solve(np.eye(stages) + 1e9 * found.a, unit)
    assert abs(stiff) < 1e-6
    with pytest.raises(SelfCheckFailed, match="radau"):
        RadauTableau(stages, found.c, found.b * 1.001, found.a)
