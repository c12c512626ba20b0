"""Unstable regions of Smith's rigs along the speed: integration, multipliers, thin regions."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
import scipy.integrate
import scipy.optimize
from edge_truth import discriminant, region_of
from elastolink.runtime.hill import hill_boundaries, hill_form
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.stability import stability_edges
from elastolink.runtime.stability.boundary_speeds import speed_boundaries

RIG = "smith_1972_5152_sixteenth_inch"


def test_combination_edge_of_a_rig_against_solve_ivp():
    """Smith's rig with two modes, harmonic 10 of the sum, by Runge-Kutta of order 8 in q and q'."""
    system = el.load_scene(RIG, overrides={"model.modes": 2}).system()
    found = stability_edges(system, (81.0, 81.7))
    at = region_of(found, "sum", 10)

    angles = np.linspace(0.0, 2 * np.pi, 257)[:-1]
    mass = system.array("M", 0.0)[0]
    stiffness = np.linalg.solve(mass, system.array("K", 0.0)[0])
    samples = np.linalg.solve(mass, system.array("B", angles))
    waves = np.fft.rfft(samples, axis=0) / len(angles)
    waves[1:] *= 2
    number = np.arange(len(waves))
    kept = 60
    assert np.max(np.abs(waves[kept:])) < 1e-13 * np.max(np.abs(waves))

    def slope(theta, state, speed):
        turn = np.exp(1j * number[:kept] * theta)
        inertia = np.real(np.tensordot(turn, waves[:kept], axes=1))
        q = state.reshape(4, 4)
        return np.concatenate([q[2:], (inertia - stiffness / speed**2) @ q[:2]]).ravel()

    def at_speed(speed):
        run = scipy.integrate.solve_ivp(
            slope,
            (0, 2 * np.pi),
            np.eye(4).ravel(),
            method="DOP853",
            args=(speed,),
            rtol=1e-13,
            atol=1e-15,
        )
        return discriminant(run.y[:, -1].reshape(4, 4))

    width = found.width[at]
    for end, sign in ((found.lower[at], 1), (found.upper[at], -1)):
        # Two values either side and a secant: the discriminant is a parabola here.
        near = end + 0.02 * width * sign * np.array([-1.0, 0.0, 1.0])
        values = [at_speed(w) for w in near]
        assert values[0] > 0 > values[2]
        line = np.polyfit(near - end, values, 2)
        roots = np.roots(line)
        exact = end + roots[np.argmin(np.abs(roots))].real
        assert abs(exact - end) < 1e-8


# Rigs ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def rig():
    return el.load_scene(RIG, overrides={"model.modes": 2}).system()


@pytest.mark.parametrize("inertia", [pytest.param(6.55e-4, marks=pytest.mark.slow), 2.1467e-3])
def test_regions_of_a_rig_agree_with_multipliers_and_boundaries(rig, inertia):
    """Least and greatest measured follower inertia of Smith's rig, the complete equation."""
    found = stability_edges(rig, (60.0, 82.0), follower_inertia=inertia)
    assert found.passed, found.checks
    sums = [i for i, kind in enumerate(found.kind) if kind == "sum" and found.width[i] > 1e-7]
    assert len(sums) >= 2
    speeds = np.array([[found.lower[i], 0.5 * (found.lower + found.upper)[i]] for i in sums])
    inside = floquet_multipliers(rig, speeds[:, 1], follower_inertia=inertia)
    # Complex multipliers grow as n pi b / (2 w) in a turn, near the middle of a narrow region.
    for row, i in enumerate(sums):
        growth = np.max(inside.exponents[row].real)
        expected = np.pi * found.harmonic[i] * found.width[i] / (2 * speeds[row, 1])
        assert 0.8 * expected < growth < 5 * expected
        assert abs(inside.multipliers[row, 0].imag) > 1e-3
    ends = speed_boundaries(rig, speed_range=(60.0, 82.0), follower_inertia=inertia).speed
    listed = np.concatenate([found.lower, found.upper])[
        np.tile([kind == "principal" for kind in found.kind], 2)
    ]
    listed = listed[np.isfinite(listed)]
    assert np.max(np.min(np.abs(ends[:, None] - listed), axis=1)) < 1e-9


def test_nested_narrow_region_is_told_from_the_wide_one(rig):
    """Region 21 of mode 2, 3e-7 rad/s wide, lies in region 5 of mode 1, 2 rad/s wide."""
    found = stability_edges(rig, (60.0, 63.0), follower_inertia=2.1467117515247174e-3)
    wide, narrow = region_of(found, "principal", 5), region_of(found, "principal", 21)
    assert found.modes[wide].tolist() == [1, 1]
    assert found.modes[narrow].tolist() == [2, 2]
    assert 2.0 < found.width[wide] < 2.5
    assert 1e-7 < found.width[narrow] < 1e-6
    assert found.lower[wide] < found.lower[narrow] < found.upper[narrow] < found.upper[wide]


def test_regions_bear_the_numbers_that_each_mode_has_alone(rig):
    """The first mode's by its own Hill equation, where the mean one is off by whole turns."""
    inertia = 2.1467117515247174e-3
    found = stability_edges(rig, (68.0, 162.0), follower_inertia=inertia)
    assert found.passed, found.checks
    assert not np.any(found.doubtful)
    first = {n: found.lower[found.names.index(("principal", 1, 1, n))] for n in (2, 3, 4)}
    alone = el.load_scene(RIG, overrides={"model.modes": 1}).system()
    form = hill_form(alone)
    pull = form.function(1.0, follower_inertia=inertia)
    ends = hill_boundaries(pull, 1.0, tuple(first)).upper
    expected = np.sqrt(form.stiffness(follower_inertia=inertia) / ends)
    np.testing.assert_allclose(list(first.values()), expected.ravel(), rtol=5e-3)
    # None is left out, from 17 at 77 rad/s, where the mean frequency is right to 0.2 turns.
    second = found.harmonic[np.all(found.modes == 2, axis=1)]
    assert second.tolist() == list(range(19, 6, -1))


def test_widths_of_hair_thin_principal_regions(rig):
    """Growth in the middle against the width: region 26 of mode 2 is 8e-12 rad/s wide."""
    inertia = 2.1467117515247174e-3
    found = speed_boundaries(rig, 1, speed_range=(50.0, 50.6), follower_inertia=inertia)
    assert len(found.speed) == 2
    width = found.speed[1] - found.speed[0]
    growth = floquet_multipliers(
        rig, np.mean(found.speed), rtol=1e-13, follower_inertia=inertia
    ).exponents.real.max()
    assert width == pytest.approx(2 * found.speed[0] * growth / (26 * np.pi), rel=0.1)
    assert 5e-12 < width < 1e-11
