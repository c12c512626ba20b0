"""Speeds of multipliers +1 and -1: Mathieu values, Hill boundaries, closed regions, damping."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.stability.boundary_speeds import parity
from periodic_systems import every_term, system_of, wave
from scipy.special import mathieu_a, mathieu_b


def _beam(**changes) -> el.LinearPeriodic:
    """Return qdd + C qd + (k + depth cos theta + w^2 pull cos theta) q = 0."""
    cosine = wave(np.eye(1))
    return system_of(
        {"k": 4.0, "depth": 0.0, "pull": 0.0, "C": 0.0, **changes},
        M=np.eye(1),
        K=("k", np.eye(1)),
        Kg=[("depth", cosine), ("pull", cosine, 2)],
        C=("C", np.eye(1)),
    )


def test_mathieu_characteristic_values():
    # x = theta/2: y'' + (a - 2 q cos 2x) y = 0 with a = 4 k/w^2, |q| = 2 depth/w^2.
    found = el.speed_boundaries(_beam(depth=1.5), speed_range=(0.6, 10.0))
    assert len(found.speed) == 12
    assert found.passed
    odd = np.repeat([1, 2, 3, 4, 5, 6], 2)[::-1]
    for speed, sign, order in zip(found.speed, found.multiplier, odd, strict=True):
        assert sign == (1 if order % 2 == 0 else -1)
        a, q = 16.0 / speed**2, 3.0 / speed**2
        gap = min(abs(mathieu_a(order, q) - a), abs(mathieu_b(order, q) - a))
        assert gap < 1e-11 * a


def test_damped_boundaries_are_those_of_hills_equation():
    function = el.PeriodicFunction(a=[0.0, 1.0], b=[0.0, 0.0])
    damping = 0.05
    system = _beam(pull=0.3).with_terms(el.Term("C", None, 2 * damping * np.eye(1), power=1))
    found = el.speed_boundaries(system, -1, speed_range=(2.0, 20.0))
    bounds = el.hill_boundaries(function, np.array([0.3]), regions=(1,), damping=damping)
    expected = 2.0 / np.sqrt([bounds.upper[0, 0], bounds.lower[0, 0]])
    np.testing.assert_allclose(found.speed, expected, rtol=1e-11)


def test_divergence_of_a_whirling_shaft():
    # qdd + (k - w^2) q: multiplier +1 at w = sqrt k by a constant motion, as B = 1.
    system = system_of(M=np.eye(1), B=np.eye(1), K=9.0 * np.eye(1))
    found = el.speed_boundaries(system, 1, speed_range=(2.5, 10.0))
    np.testing.assert_allclose(found.speed, [3.0], rtol=1e-13)
    np.testing.assert_allclose(found.motion(0, [0.0, 1.0, 2.0])[:, 0] ** 2, 1.0, rtol=1e-12)
    # Lower down it oscillates at sqrt(9 - w^2) = j w: w = 3/sqrt(1 + j^2).
    more = el.speed_boundaries(system, 1, speed_range=(0.9, 10.0))
    np.testing.assert_allclose(
        more.speed, 3 / np.sqrt([10.0, 10.0, 5.0, 5.0, 2.0, 2.0, 1.0]), rtol=1e-13
    )


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_coupled_modes_against_multipliers(damping):
    system = every_term(eps=1.0, c=damping)
    found = el.speed_boundaries(system, speed_range=(1.0, 12.0))
    assert len(found.speed) >= (2 if damping else 8)
    assert found.passed, found.checks
    assert np.all(found.error < 1e-11 * found.speed)
    values = el.floquet_multipliers(system, found.speed)
    gap = np.abs(values.multipliers - found.multiplier[:, None])
    nearest = np.argmin(gap, axis=1)
    rows = np.arange(len(gap))
    # At a boundary the multiplier is double and defective: its error is of square-root size.
    assert np.all(gap[rows, nearest] <= values.error[rows, nearest] + 1e-6 * np.sqrt(found.error))


def test_motion_solves_the_equation():
    system = every_term(eps=1.0)
    found = el.speed_boundaries(system, speed_range=(3.0, 12.0))
    for index in range(len(found.speed)):
        theta = np.linspace(0.0, 2 * np.pi, 3)
        ends = found.motion(index, theta[[0, -1]])
        np.testing.assert_allclose(ends[1], found.multiplier[index] * ends[0], atol=1e-12)
        # p = M q' + A q, q' by the series itself.
        step = 1e-4
        slope = (found.motion(index, step) - found.motion(index, -step))[0] / (2 * step)
        zero = np.zeros(1)
        momentum = system.array("M", zero)[0] @ slope + system.array("A", zero)[0] @ ends[0]
        start = np.concatenate([ends[0], momentum])
        end = el.monodromy(system, found.speed[index]).matrix @ start
        gap = np.max(np.abs(end - found.multiplier[index] * start))
        assert gap < 1e-6 * np.max(np.abs(start))


def test_another_period_and_another_parameter():
    double = system_of({"k": 4.0}, np.pi, M=np.eye(1), K=("k", np.eye(1)), Kg=wave(np.eye(1), 2))
    single = _beam(depth=1.0)
    found = el.speed_boundaries(double, speed_range=(0.5, 4.0), k=3.0)
    # cos 2 theta at speed w is cos theta at speed 2 w.
    other = el.speed_boundaries(single, speed_range=(1.0, 8.0), k=3.0)
    np.testing.assert_allclose(2 * found.speed, other.speed, rtol=1e-12)


def test_picture():
    found = el.speed_boundaries(_beam(depth=1.0), speed_range=(2.0, 8.0))
    assert found.plot().get_xlabel() == "crank speed [rpm]"


def test_every_result_has_its_checks():
    many = el.speed_boundaries(_beam(), speed_range=(0.02, 5.0))
    assert len(many.speed) > 256
    assert set(many.checks) == {"truncation", "parity", "monodromy"}
    assert many.passed, many.checks
    none = el.speed_boundaries(_beam(), speed_range=(100.0, 200.0))
    assert none.speed.shape == (0,) and none.cosine.shape[0] == 0
    assert none.passed and set(none.checks) == {"truncation", "parity"}


def test_parity_notices_a_boundary_left_out():
    system = _beam(depth=1.5)
    found = el.speed_boundaries(system, -1, speed_range=(1.0, 10.0))
    whole = parity(system, [(-1, found.speed)], (1.0, 10.0), {})
    assert whole.passed
    for index in range(len(found.speed)):
        left = np.delete(found.speed, index)
        assert not parity(system, [(-1, left)], (1.0, 10.0), {}).passed


def test_a_high_harmonic_is_not_mistaken_for_a_mean():
    # cos 64 theta at 32 even angles is one.
    wave = el.Term("Kg", None, lambda theta: np.cos(64 * theta)[:, None, None])
    found = el.speed_boundaries(_beam().with_terms(wave), -1, speed_range=(3.0, 5.0))
    np.testing.assert_allclose(found.speed, [4.0, 4.0], rtol=1e-3)
    assert found.passed, found.checks
