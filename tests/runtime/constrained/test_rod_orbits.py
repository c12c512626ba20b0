"""Periodic motion of the rod in Buckens' frame: against marching, and its refusals."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.constrained import (
    constrained_motion,
    motion_with_variations,
    orbit_multipliers,
)
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.systems.rod import (
    free_free_rod,
    rod_orbit,
)
from elastolink.runtime.systems.rod.constrained import rigid_state, tip_deflection
from elastolink.runtime.systems.rod.motion import rod_motion
from scipy.integrate import solve_ivp

ROD = {
    "frame": 0.59997,
    "length": 1.0,
    "bending_stiffness": 0.7e11 * 0.5208e-6,
    "mass_per_length": 7.15,
}


@pytest.fixture(scope="module")
def rod():
    return free_free_rod(1, crank_ratio=0.2, speed=150.0, **ROD)


@pytest.fixture(scope="module")
def orbit(rod):
    return rod_orbit(rod)


def test_a_march_from_the_orbit_comes_back(rod, orbit):
    orbit.require()
    march = constrained_motion(rod, orbit.q[0], orbit.qd[0], rod.period, samples=5)
    np.testing.assert_allclose(march.q[-1], orbit.q[0], atol=1e-8)
    between, _ = orbit.at(march.time)
    np.testing.assert_allclose(march.q, between, atol=1e-8)
    tip = np.abs(tip_deflection(rod, orbit.q, orbit.t))
    assert np.max(tip) <= orbit.deflection * rod.linkage.rod * 1.001
    assert orbit.deflection > 1e-3


def test_the_monodromy_matrix_is_the_derivative_of_the_flow(rod, orbit):
    """All neighbours marched together, those off the constraints too; central differences."""
    found = orbit_multipliers(orbit)
    found.require()
    n = rod.size
    reach = np.r_[np.full(n, 1e-5), np.full(n, 1e-5 * 150.0)]
    start = np.concatenate([orbit.q[0], orbit.qd[0]])
    states = start + np.concatenate([np.diag(reach), -np.diag(reach)])

    def rate(t, flat):
        q, qd = np.split(flat.reshape(-1, 2 * n), 2, axis=1)
        push = rod.accelerations(q, qd, np.full(len(q), t))[0]
        return np.concatenate([qd, push], axis=1).ravel()

    run = solve_ivp(rate, (0.0, rod.period), states.ravel(), "DOP853", rtol=1e-12, atol=1e-14)
    plus, minus = np.split(run.y[:, -1].reshape(-1, 2 * n), 2)
    slopes = (plus - minus).T / (2 * reach)
    unit = np.r_[np.ones(n), np.full(n, 150.0)]
    gap = (slopes - found.monodromy) * unit / unit[:, None]
    # Third derivatives times 1e-10, the square of the reach, and rounding over the reach.
    assert np.max(np.abs(gap)) < 1e-5 * np.max(np.abs(found.monodromy * unit / unit[:, None]))
    inside = np.linalg.lstsq(found.basis, slopes @ found.basis, rcond=None)[0]
    np.testing.assert_allclose(
        np.sort_complex(np.linalg.eigvals(inside)), np.sort_complex(found.physical), atol=1e-5
    )


def test_another_integrator_carries_the_variations_alike(rod, orbit):
    """Lobatto pairs on the index-3 equations, with their own variations: an independent map."""
    found = orbit_multipliers(orbit)
    other = motion_with_variations(
        rod, orbit.q[0], orbit.qd[0], (0.0, rod.period), found.basis, steps=120
    )
    np.testing.assert_allclose(other.q[-1], orbit.q[0], atol=1e-10)
    inside, left, *_ = np.linalg.lstsq(found.basis, other.columns, rcond=None)
    assert np.sqrt(np.max(left)) < 1e-8 * np.linalg.norm(other.columns)
    np.testing.assert_allclose(
        np.sort_complex(np.linalg.eigvals(inside)), np.sort_complex(found.physical), atol=1e-9
    )


@pytest.mark.parametrize(
    ("changes", "turn"),
    [
        ({"crank_ratio": 2.0, "frame": 0.2, "speed": 30.0}, 2 * np.pi),
        ({"crank_ratio": 2.0, "frame": 0.2, "speed": -30.0}, -2 * np.pi),
        ({"crank_ratio": 0.3, "speed": -50.0}, 0.0),
    ],
)
def test_cranks_that_take_the_rod_round_or_turn_back(changes, turn):
    one = free_free_rod(2, **{**ROD, **changes})
    orbit = rod_orbit(one)
    orbit.require()
    assert orbit.advance[2] == turn
    late, _ = orbit.at(orbit.t + 3 * orbit.period)
    np.testing.assert_allclose(late, orbit.q + 3 * orbit.advance, atol=1e-11)
    multipliers = orbit_multipliers(orbit)
    multipliers.require()
    mirrored = free_free_rod(2, **{**ROD, **changes, "speed": -changes["speed"]})
    other = orbit_multipliers(rod_orbit(mirrored)).physical
    np.testing.assert_allclose(multipliers.physical, other, atol=1e-11)


def test_counts_order_and_pictures(orbit):
    found = orbit_multipliers(orbit)
    assert found.physical.shape == found.error.shape == (2,)
    assert found.others.shape == (6,)
    assert found.physical[0].imag > 0
    assert found.basis.shape == (8, 2)
    assert {"symplectic", "reciprocal pairs", "liouville", "tangent"} <= set(found.checks)
    assert found.checks["symplectic"].value < 1e-13
    assert found.plot().get_xlabel() == "real part of multiplier"
    assert len(orbit.plot().lines) == 4
    assert orbit.multipliers.shape == (len(orbit.t), 3)


def test_the_guess_of_one_state_leads_to_the_same_orbit(rod, orbit):
    from elastolink.runtime.constrained import periodic_orbit

    q, qd = rigid_state(rod, 0.0)
    other = periodic_orbit(rod, rod.period, q, qd)
    other.require()
    np.testing.assert_allclose(other.at(orbit.t)[0], orbit.q, atol=1e-12)


@pytest.mark.parametrize("samples", [8, 61, 600])
def test_the_orbit_does_not_depend_on_the_samples_of_the_guess(rod, orbit, samples):
    other = rod_orbit(rod, samples=samples)
    other.require()
    np.testing.assert_allclose(other.at(orbit.t)[0], orbit.q, atol=1e-12)


def test_the_block_stays_on_the_rod(rod, orbit):
    check = orbit.checks["block on the rod"]
    assert check.passed
    # The deflection moves the block along the rod by its square only.
    reach = 1.2 * ROD["frame"]
    assert abs(check.value - reach) < 3 * orbit.deflection**2


@pytest.mark.parametrize("samples", [4, "x", 9.5, np.nan])
def test_unusable_samples_are_refused(rod, samples):
    with pytest.raises(BadInput, match="samples"):
        rod_orbit(rod, samples=samples)


@pytest.mark.parametrize("changes", [{"revolutions": "x"}, {"samples": "x"}, {"rtol": "x"}])
def test_unusable_motions_are_refused(rod, changes):
    with pytest.raises(BadInput, match=f"{next(iter(changes))}: found 'x'"):
        rod_motion(rod, **{"revolutions": 0.1, **changes})


def test_the_distance_from_the_rigid_motion_is_told(rod, orbit):
    """It falls with the square of the speed, as the deflection does."""
    slow = rod_orbit(free_free_rod(1, crank_ratio=0.2, speed=15.0, **ROD))
    assert slow.moved < 0.1 * orbit.moved < 0.05
