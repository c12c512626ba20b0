"""Stability of the constrained free-free equations, the open question of Beale & Scott's 3.1."""

import numpy as np
import pytest
from documented import documented_rows, last_digit
from elastolink.runtime.constrained import periodic_orbit
from free_free_loads import about, difference, in_step, linear, loaded, part_of_inertia, phases, rod
from orders import slope

SPEED = 150.0
PHYSICS = [(), ("tension",)]
# The linear form without the term that the frame adds.
FRAMELESS = {(): ("frame",), ("tension",): ("frame", "tension")}


@pytest.mark.parametrize("drop", PHYSICS)
@pytest.mark.parametrize(("modes", "ratio"), [(1, 0.2), (3, 0.05)])
def test_about_the_undeformed_rod_they_are_those_of_the_conjectured_linear_form(modes, ratio, drop):
    orbit, found = about(loaded(rod(modes, ratio, SPEED, drop), part_of_inertia(0.0)))
    assert orbit.deflection < 1e-14
    conjectured = linear(modes, ratio, SPEED, drop)
    away = np.abs(difference(found.physical, conjectured.multipliers))
    # Two independent eigenproblems: both errors count, and their difference is round-off.
    assert np.max(away) <= np.max(found.error) + np.max(conjectured.error) < 2e-9
    assert np.max(away) < 5e-12
    assert np.max(np.abs(found.others - 1.0)) <= min(found.others_error, 1e-5)
    # Without the frame term the linear form is another system.
    frameless = linear(modes, ratio, SPEED, FRAMELESS[drop])
    assert np.max(np.abs(difference(found.physical, frameless.multipliers))) > 2e-4


@pytest.mark.parametrize("drop", PHYSICS)
@pytest.mark.parametrize("modes", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_about_the_orbit_the_difference_falls_like_amplitude_squared(modes, drop):
    """The crank sets the amplitude; linear and constrained form share every coefficient."""
    amplitude, away = [], []
    for ratio in (0.02, 0.01, 0.005, 0.0025):
        orbit, found = about(rod(modes, ratio, SPEED, drop))
        same = linear(modes, ratio, SPEED, drop)
        amplitude.append(orbit.deflection)
        away.append(np.max(np.abs(difference(found.physical, same.multipliers))))
        assert away[-1] > 100 * (np.max(found.error) + np.max(same.error))
    assert slope(amplitude, away) == pytest.approx(2.0, abs=0.06)


@pytest.mark.parametrize("drop", PHYSICS)
def test_at_fixed_coefficients_a_load_in_step_leaves_exactly_the_square(drop):
    """A mirror image run backwards turns the load over: odd powers of it cannot occur."""
    still = about(loaded(rod(2, 0.1, SPEED, drop), part_of_inertia(0.0)))[1]
    sizes, away = np.array([0.4, 0.2, 0.1, 0.05]), []
    for size in sizes:
        found = about(loaded(rod(2, 0.1, SPEED, drop), in_step(size, SPEED)))[1]
        away.append(difference(found.physical, still.physical))
    away = np.array(away)
    for column in away.T:
        assert slope(sizes, column) == pytest.approx(2.0, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("drop", PHYSICS)
def test_a_fraction_of_the_inertia_load_leaves_a_product_with_the_motion_too(drop):
    """Load times rate of the line: first order in the fraction, but itself of the ratio squared.

    The difference is ``a(eps) s + b(eps) s^2`` for a part s of the load, both of order eps^2:
    with the machine's own load, s = 1, it is of the order of the amplitude squared.
    """
    odd, even = [], []
    for ratio in (0.01, 0.005):
        still = about(loaded(rod(2, ratio, SPEED, drop), part_of_inertia(0.0)))[1]
        values = []
        for part in (1.0, -1.0, 0.5, -0.5):
            found = about(loaded(rod(2, ratio, SPEED, drop), part_of_inertia(part)))[1]
            values.append(difference(found.physical, still.physical))
        whole, against, half, half_against = values
        odd.append((whole - against) / 2)
        even.append((whole + against) / 2)
        np.testing.assert_allclose((half - half_against) / 2, odd[-1] / 2, rtol=0.01)
        np.testing.assert_allclose((half + half_against) / 2, even[-1] / 4, rtol=0.01)
    np.testing.assert_allclose(odd[0] / odd[1], 4.0, atol=0.1)
    np.testing.assert_allclose(even[0] / even[1], 4.0, atol=0.1)


def test_the_practical_range_of_the_paper_is_stable_in_ground_coordinates_too():
    """Its fastest corner: 20 rad/s, ratio 0.3."""
    orbit, found = about(rod(2, 0.3, 20.0))
    assert found.stable
    assert orbit.deflection < 1e-3
    same = linear(2, 0.3, 20.0)
    assert np.max(np.abs(difference(found.physical, same.multipliers))) < 1e-4


def test_beyond_the_linear_range_shooting_diverges_and_says_so():
    """The paper's own observation at large deflections, at the speed of its Fig. 12."""
    orbit = periodic_orbit(rod(2, 0.2, 900.0))
    assert orbit.message.startswith("diverging shooting")
    assert not orbit.passed
    assert not orbit.checks["linear range"].passed


def rows(table):
    return documented_rows("free_free_stability", table)


def assert_written(cell, value):
    assert value == pytest.approx(float(cell), abs=last_digit(cell))


def away(found, *form, drop=()):
    """Return the largest difference of a phase from that of a linear form."""
    return np.max(np.abs(difference(found.physical, linear(*form, SPEED, drop).multipliers)))


@pytest.mark.slow
def test_the_numbers_of_the_page():
    for modes, told, _, without in rows("undeformed"):
        found = about(loaded(rod(int(modes), 0.2, SPEED), part_of_inertia(0.0)))[1]
        for cell, phase in zip(told.split(", "), phases(found.physical), strict=True):
            assert_written(cell, phase)
        assert away(found, int(modes), 0.2) < 1e-12
        assert_written(without, away(found, int(modes), 0.2, drop=("frame",)))
    for ratio, *cells in rows("orbits"):
        orbit, found = about(rod(1, float(ratio), SPEED))
        bent, gap = orbit.deflection, away(found, 1, float(ratio))
        for cell, value in zip(cells, (bent, gap, gap / bent**2), strict=True):
            assert_written(cell, value)
    for part, *cells in rows("loads"):
        found = about(loaded(rod(1, 0.1, SPEED), part_of_inertia(float(part))))[1]
        for cell, drop in zip(cells, ((), ("frame",)), strict=True):
            assert_written(cell, away(found, 1, 0.1, drop=drop))
    for modes, ratio, speed, *cells in rows("tongue"):
        place = int(modes), float(ratio), float(speed)
        orbit, found = about(rod(*place))
        growth = np.max(np.abs(linear(*place).multipliers))
        for cell, value in zip(cells, (orbit.deflection, found.largest, growth), strict=True):
            assert_written(cell, value)
