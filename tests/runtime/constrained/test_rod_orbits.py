"""Periodic motion of the rod in Buckens' frame: against marching, and its refusals."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.constrained import constrained_motion, orbit_multipliers, periodic_orbit
from elastolink.runtime.core.families import Constrained
from elastolink.runtime.systems import free_free_rod
from free_free_loads import ROD
from scipy.integrate import solve_ivp


@pytest.fixture(scope="module")
def rod():
    return free_free_rod(1, crank_ratio=0.2, speed=150.0, **ROD)


@pytest.fixture(scope="module")
def orbit(rod):
    return periodic_orbit(rod)


def test_a_march_from_the_orbit_comes_back(rod, orbit):
    orbit.require()
    march = constrained_motion(rod, orbit.q[0], orbit.qd[0], rod.period, samples=5)
    np.testing.assert_allclose(march.q[-1], orbit.q[0], atol=1e-8)
    between, _ = orbit.at(march.time)
    np.testing.assert_allclose(march.q, between, atol=1e-8)
    tip = np.abs(rod.deflection(orbit.q, orbit.t, 1.0))
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


@pytest.mark.parametrize(
    ("changes", "turn"),
    [
        ({"crank_ratio": 2.0, "frame": 0.2, "speed": 30.0}, 2 * np.pi),
        ({"crank_ratio": 0.3, "speed": -50.0}, 0.0),
    ],
)
def test_cranks_that_take_the_rod_round_or_turn_back(changes, turn):
    one = free_free_rod(2, **{**ROD, **changes})
    orbit = periodic_orbit(one)
    orbit.require()
    assert orbit.advance[2] == turn
    late, _ = orbit.at(orbit.t + 3 * orbit.period)
    np.testing.assert_allclose(late, orbit.q + 3 * orbit.advance, atol=1e-11)
    multipliers = orbit_multipliers(orbit)
    multipliers.require()
    mirrored = free_free_rod(2, **{**ROD, **changes, "speed": -changes["speed"]})
    other = orbit_multipliers(periodic_orbit(mirrored)).physical
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


def test_other_guesses_lead_to_the_same_orbit(rod, orbit):
    """One state, followed for a period; and eight places of the undeformed rod."""
    even = np.arange(8) * (rod.period / 8)
    for guess in (rod.reference(np.zeros(())), rod.reference(even)):
        other = periodic_orbit(rod, rod.period, *guess)
        other.require()
        np.testing.assert_allclose(other.at(orbit.t)[0], orbit.q, atol=1e-12)


def test_the_block_stays_on_the_rod(rod, orbit):
    assert orbit.checks["the block left the end of the rod"].passed
    lean = (lambda t, q, qd: 0.1 - abs(q[2]), "the rod leaned too far")
    bounded = periodic_orbit(replace(rod, guards=(lean,)))
    most = np.max(np.abs(orbit.q[:, 2]))
    np.testing.assert_allclose(bounded.checks["the rod leaned too far"].value, most - 0.1)
    assert not bounded.passed


def test_the_distance_from_the_rigid_motion_is_told(rod, orbit):
    """It falls with the square of the speed, as the deflection does."""
    slow = periodic_orbit(free_free_rod(1, crank_ratio=0.2, speed=15.0, **ROD))
    assert slow.moved < 0.1 * orbit.moved < 0.05


def test_where_nothing_is_free_the_constraints_give_the_motion():
    """A mass of 2 on a spring of 3, led along x = cos t: the force that leads it is cos t."""

    def one(values):
        return np.asarray(values, dtype=float)[..., None, None]

    def violation(q, t):
        gap = q[..., 0] - np.cos(t)
        return {"constraints": one(gap), "jacobian": one(np.ones_like(gap))}

    def dynamics(q, qd, t):
        x, cos, sin = np.broadcast_arrays(q[..., 0], np.cos(t), np.sin(t))
        unit = np.ones_like(x)
        parts = {"mass": 2 * unit, "rest": 0 * unit, "forces": -3 * x, "jacobian": unit}
        parts |= {"velocity_rhs": -sin, "gamma": -cos}
        return {name: one(part) for name, part in parts.items()}

    def variations(q, *_):
        parts = {"damping": 0, "stiffness": 3, "jacobian_rate": 0, "jacobian_acceleration": 0}
        return {name: one(np.full_like(q[..., 0], part)) for name, part in parts.items()}

    led = Constrained(1, 1, dynamics, violation, variations, period=2 * np.pi)
    orbit = periodic_orbit(led, q=[1.0], qd=[0.0])
    orbit.require()
    np.testing.assert_allclose(orbit.q[:, 0], np.cos(orbit.t), atol=1e-14)
    np.testing.assert_allclose(orbit.multipliers[:, 0], np.cos(orbit.t), atol=1e-14)
    found = orbit_multipliers(orbit)
    found.require()
    assert found.physical.shape == (0,) and found.stable
