"""Unstable regions of Smith's rigs along the speed: multipliers, numbers, thin regions."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import region_of
from edge_truth import rig as smiths_rig
from scipy.integrate import solve_ivp

# The greatest measured inertia of the follower.
INERTIA = 2.1467117515247174e-3


@pytest.fixture(scope="module")
def rig():
    return smiths_rig(**{"model.modes": 2})


def test_a_combination_region_ends_where_runge_kutta_says(rig):
    """Where the discriminant of the sums of reciprocal multipliers, by DOP853, passes zero."""
    found = el.stability_edges(rig, (81.0, 81.7))
    at = region_of(found, "sum", 10)
    flexibility = np.linalg.inv(rig.array("M", 0.0)[0])
    stiffness = rig.array("K", 0.0)[0]

    def slope(theta, state, speed):
        q, rate = state.reshape(2, 2, 4)
        force = (rig.array("B", theta)[0] - stiffness / speed**2) @ q
        return np.concatenate([rate, flexibility @ force]).ravel()

    def discriminant(speed):
        fine = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
        run = solve_ivp(slope, (0.0, 2 * np.pi), np.eye(4).ravel(), args=(speed,), **fine)
        whole = run.y[:, -1].reshape(4, 4)
        return 2 * np.trace(whole @ whole) - np.trace(whole) ** 2 + 8

    for end, way in ((found.lower[at], 0.02), (found.upper[at], -0.02)):
        off = found.width[at] * way * np.array([-1.0, 0.0, 1.0])
        values = [discriminant(end + place) for place in off]
        assert values[0] > 0 > values[2]
        roots = np.roots(np.polyfit(off, values, 2))
        assert np.min(np.abs(roots)) < 1e-8


@pytest.mark.parametrize("inertia", [pytest.param(6.55e-4, marks=pytest.mark.slow), INERTIA])
def test_regions_of_a_rig_agree_with_multipliers_and_boundaries(rig, inertia):
    """Least and greatest measured follower inertia of Smith's rig, the complete equation."""
    found = el.stability_edges(rig, (60.0, 82.0), follower_inertia=inertia)
    assert found.passed, found.checks
    sums = [i for i, kind in enumerate(found.kind) if kind == "sum" and found.width[i] > 1e-7]
    assert len(sums) >= 2
    speeds = np.array([[found.lower[i], 0.5 * (found.lower + found.upper)[i]] for i in sums])
    inside = el.floquet_multipliers(rig, speeds[:, 1], follower_inertia=inertia)
    # Complex multipliers grow as n pi b / (2 w) in a turn, near the middle of a narrow region.
    for row, i in enumerate(sums):
        growth = np.max(inside.exponents[row].real)
        expected = np.pi * found.harmonic[i] * found.width[i] / (2 * speeds[row, 1])
        assert 0.8 * expected < growth < 5 * expected
        assert abs(inside.multipliers[row, 0].imag) > 1e-3
    ends = el.speed_boundaries(rig, speed_range=(60.0, 82.0), follower_inertia=inertia).speed
    listed = np.concatenate([found.lower, found.upper])[
        np.tile([kind == "principal" for kind in found.kind], 2)
    ]
    listed = listed[np.isfinite(listed)]
    assert np.max(np.min(np.abs(ends[:, None] - listed), axis=1)) < 1e-9


def test_regions_bear_the_numbers_that_each_mode_has_alone(rig):
    """The first mode's by its own Hill equation, where the mean one is off by whole turns."""
    found = el.stability_edges(rig, (68.0, 162.0), follower_inertia=INERTIA)
    assert found.passed, found.checks
    assert not np.any(found.doubtful)
    first = {n: found.lower[found.names.index(("principal", 1, 1, n))] for n in (2, 3, 4)}
    form = el.hill_form(smiths_rig(**{"model.modes": 1}))
    pull = form.function(1.0, follower_inertia=INERTIA)
    ends = el.hill_boundaries(pull, 1.0, tuple(first)).upper
    expected = np.sqrt(form.stiffness(follower_inertia=INERTIA) / ends)
    np.testing.assert_allclose(list(first.values()), expected.ravel(), rtol=5e-3)
    # None is left out, from 17 at 77 rad/s, where the mean frequency is right to 0.2 turns.
    second = found.harmonic[np.all(found.modes == 2, axis=1)]
    assert second.tolist() == list(range(19, 6, -1))


def test_widths_of_hair_thin_principal_regions(rig):
    """Growth in the middle against the width: region 26 of mode 2 is 8e-12 rad/s wide."""
    found = el.speed_boundaries(rig, 1, speed_range=(50.0, 50.6), follower_inertia=INERTIA)
    assert len(found.speed) == 2
    width = found.speed[1] - found.speed[0]
    inside = el.floquet_multipliers(rig, np.mean(found.speed), rtol=1e-13, follower_inertia=INERTIA)
    growth = inside.exponents.real.max()
    assert width == pytest.approx(2 * found.speed[0] * growth / (26 * np.pi), rel=0.1)
    assert 5e-12 < width < 1e-11
