"""Monodromy matrices and motions under strain: fast waves, growth, defects, jumps, size, units."""

import numpy as np
import pytest
import scipy.linalg
from elastolink.runtime.periodic import floquet_multipliers, monodromy, simulate
from elastolink.runtime.stability.boundary_speeds import speed_boundaries
from periodic_systems import mathieu, system_of, wave


@pytest.mark.parametrize("waves", [100.25, 5000.3])
def test_thousands_of_oscillations_per_revolution(waves):
    found = monodromy(mathieu(mu=0.0), 1.0, lam2=waves**2, rtol=1e-13)
    phase = 8 * np.arctan(np.longdouble(1)) * np.longdouble(waves)
    c, s = float(np.cos(phase)), float(np.sin(phase))
    exact = np.array([[c, s / waves], [-s * waves, c]])
    scaled = exact / found.scale[:, None] * found.scale
    actual = np.max(np.abs(found.scaled - scaled)) / np.max(np.abs(scaled))
    # waves**2 is rounded, so the answer itself is open to half of 2 pi waves eps.
    assert actual < 20 * waves * np.finfo(float).eps
    assert actual <= found.error
    assert found.passed


def test_fast_waves_over_many_revolutions():
    system = mathieu(mu=0.0).with_parameters(lam2=500.5**2)
    run = simulate(system, 1.0, 20.0, initial=(0.01, 0.0), samples=36, rtol=1e-9)
    exact = 0.01 * np.cos(500.5 * run.theta)
    actual = np.max(np.abs(run.q[:, 0] - exact)) / 0.01
    assert actual <= run.error[0] < 1e-9


@pytest.mark.parametrize("rate", [1.0, 110.0])
def test_growth_does_not_hide_the_quiet_modes(rate):
    # Three modes, one repelled, and a rotation of the coordinates that mixes all of them.
    basis, _ = np.linalg.qr(np.random.default_rng(5).standard_normal((3, 3)))
    springs = basis @ np.diag([-(rate**2), 0.83**2, 2.71**2]) @ basis.T
    found = floquet_multipliers(system_of(M=np.eye(3), K=springs), 1.0)
    exact = np.exp(2j * np.pi * np.array([0.83, -0.83, 2.71, -2.71]))
    for value in exact:
        gap = np.abs(found.multipliers - value)
        nearest = int(np.argmin(gap))
        # Springs of size rate^2 are rounded; the slow modes carry that.
        assert gap[nearest] < 1e-13 * max(1.0, rate**2)
    np.testing.assert_allclose(found.exponents[0].real, 2 * np.pi * rate, rtol=1e-11)
    assert found.passed, found.checks


def test_marginal_multipliers_stay_on_the_circle_within_their_error():
    # Through a tongue in steps of 1e-9 of its width: inside off the circle, outside on it.
    tongue = system_of(M=np.eye(1), K=np.eye(1), Kg=wave([[0.1]]))
    low, high = speed_boundaries(tongue, -1, speed_range=(1.5, 3.0)).speed
    system = mathieu(mu=0.0)
    offsets = np.concatenate([-np.logspace(-12, -2, 40), np.logspace(-12, -2, 40)])
    for edge, inward in ((low, 1.0), (high, -1.0)):
        speed = edge + offsets * (high - low)
        found = floquet_multipliers(system, 1.0, lam2=1 / speed**2, mu=0.1 / speed**2)
        outside = offsets * inward < 0
        distance = np.abs(np.abs(found.multipliers) - 1)
        assert np.all(distance[outside] <= found.error[outside])
        assert np.all(found.stable[outside])
        # Well inside the answer is a clear no.
        deep = offsets * inward > 1e-9
        assert not np.any(found.stable[deep])


@pytest.mark.parametrize("jump", [np.pi, 2.0])
def test_coefficients_with_a_jump(jump):
    """Meissner's equation: the spring switches; exact by two exponentials."""

    def spring(theta):
        return np.where(np.mod(theta, 2 * np.pi) < jump, 3.0, 1.0)[:, None, None]

    found = monodromy(system_of(M=np.eye(1), K=spring), 1.0)

    def piece(square, length):
        return scipy.linalg.expm(length * np.array([[0.0, 1.0], [-square, 0.0]]))

    exact = piece(1.0, 2 * np.pi - jump) @ piece(3.0, jump)
    exact = exact / found.scale[:, None] * found.scale
    actual = np.max(np.abs(found.scaled - exact)) / np.max(np.abs(exact))
    assert actual <= found.error
    assert found.error < (1e-11 if jump == np.pi else 1e-2)


@pytest.mark.parametrize(("length", "mass"), [(1e-6, 1e-9), (1e6, 1e-9), (1e-6, 1e9)])
def test_units_do_not_matter(length, mass):
    def system(unit, weight):
        scale = np.array([1.0, unit])
        outer = weight * scale[:, None] * scale

        return system_of(
            M=outer * [[2.0, 0.3], [0.3, 1.0]],
            A=outer * [[0.0, -0.4], [0.5, 0.0]],
            K=outer * [[20.0, 3.0], [3.0, 9.0]],
            Kg=wave(outer * [[2.0, 1.0], [1.0, 3.0]]),
        )

    speeds = np.linspace(0.8, 6.0, 15)
    plain = floquet_multipliers(system(1.0, 1.0), speeds)
    other = floquet_multipliers(system(length, mass), speeds)
    gap = np.abs(plain.multipliers - other.multipliers)
    assert np.all(gap <= plain.error + other.error)
    assert np.max(other.error) < 1e3 * np.max(plain.error)
    found = speed_boundaries(system(length, mass), speed_range=(1.0, 12.0))
    expected = speed_boundaries(system(1.0, 1.0), speed_range=(1.0, 12.0))
    np.testing.assert_allclose(found.speed, expected.speed, rtol=1e-11)


@pytest.mark.parametrize("turns", [0.5, 1 / 3])
def test_other_periods(turns):
    period = 2 * np.pi * turns
    found = monodromy(mathieu(period), 1.0, lam2=2.0, mu=0.5)
    # Scale the angle: y'' + (lam2 turns^2 + mu turns^2 cos x) y over 2 pi.
    other = monodromy(mathieu(mu=0.0), 1.0, lam2=2.0 * turns**2, mu=0.5 * turns**2)
    units = np.array([[1.0, turns], [1 / turns, 1.0]])
    np.testing.assert_allclose(found.matrix, other.matrix * units, atol=1e-12)
