"""Periodic orbits and multipliers on constraints, against a motion known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from cycloid_truth import Cycloid
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.constrained import orbit_multipliers, periodic_orbit
from elastolink.runtime.core.errors import BadInput, SelfCheckFailed
from elastolink.runtime.core.families import Constrained

BEAD = Cycloid(mass=0.7, radius=0.4, gravity=9.81, drag=0.3, force=2.8, speed=3.2)


@pytest.fixture(scope="module")
def bead(emit):
    def system(given: Cycloid) -> Constrained:
        found = emit("cycloid", ModelSpec("cycloid", "multiplier"))
        return Constrained.from_module(found.module, given.numbers, provenance=found.provenance)

    return system


def test_orbit_and_multipliers_are_the_exact_ones(bead):
    orbit = periodic_orbit(bead(BEAD), BEAD.period, np.zeros(3), np.zeros(3))
    orbit.require()
    q, qd = BEAD.state(orbit.t)
    # More than a radian of rolling: far from a small motion.
    assert np.max(np.abs(q[:, 2])) > 1.0
    np.testing.assert_allclose(orbit.q, q, atol=2e-14)
    np.testing.assert_allclose(orbit.qd, qd, atol=1e-13)
    # Inside the steps; their ends are on the constraints.
    assert max(orbit.position_norm, orbit.velocity_norm, orbit.acceleration_norm) < 1e-12
    found = orbit_multipliers(orbit)
    found.require()
    gap = np.min(np.abs(found.physical[:, None] - BEAD.multipliers()), axis=1)
    assert np.max(gap) <= np.max(found.error) < 1e-12
    assert found.multipliers.shape == (6,)
    assert np.all(np.abs(found.others - 1.0) <= found.others_error)
    assert found.violation_defect < 1e-13
    assert "symplectic" not in found.checks
    assert found.stable
    assert found.largest == pytest.approx(np.exp(-BEAD.drag / (2 * BEAD.mass) * BEAD.period))
    assert found.growth == pytest.approx(-BEAD.drag / (2 * BEAD.mass))


def test_the_motion_between_the_steps(bead):
    orbit = periodic_orbit(bead(BEAD), BEAD.period, np.zeros(3), np.zeros(3))
    t = np.linspace(-1.3, 2.4, 57) * BEAD.period
    q, qd = orbit.at(t)
    exact = BEAD.state(t)
    # Inside a step the collocation polynomial is of lower order than at its ends.
    np.testing.assert_allclose(q, exact[0], atol=1e-11)
    np.testing.assert_allclose(qd, exact[1], atol=1e-10)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"period": 1.1 * BEAD.period}, "period: found .* differs"),
        ({"period": -1.0}, "period"),
        ({"period": np.nan}, "period"),
        ({"q": np.zeros(4)}, "q: found shape"),
        ({"q": np.full(3, np.nan)}, "not finite"),
        ({"qd": np.zeros((5, 3))}, "qd: found shape"),
        ({"advance": [0.0, 1.0]}, "advance"),
        ({"rtol": 0.0}, "rtol"),
    ],
)
def test_unusable_input_is_refused(bead, changes, words):
    given = {"period": BEAD.period, "q": np.zeros(3), "qd": np.zeros(3), **changes}
    with pytest.raises(BadInput, match=words):
        periodic_orbit(bead(BEAD), **given)


def test_a_system_without_variations_is_refused(bead, emit):
    whole = bead(BEAD)
    lean = Constrained(3, 2, whole.dynamics, whole.violation)
    with pytest.raises(BadInput, match="no variational equations"):
        periodic_orbit(lean, BEAD.period, np.zeros(3), np.zeros(3))


def test_a_pull_that_tears_the_bead_off_has_no_orbit(bead):
    """Steady amplitudes beyond 4 r do not exist on a cycloid; it is said, not guessed at."""
    torn = Cycloid(mass=0.7, radius=0.4, gravity=9.81, drag=0.3, force=9.0, speed=2.4)
    assert np.max(np.abs(torn.arc(np.linspace(0, 3, 200))[:, 0])) > 4 * torn.radius
    t = np.arange(32) * (torn.period / 32)
    q = np.stack([0.1 * np.cos(torn.speed * t), 0 * t, 0.1 * np.cos(torn.speed * t)], axis=1)
    orbit = periodic_orbit(bead(torn), torn.period, q, np.zeros_like(q))
    assert orbit.message.startswith("diverging shooting")
    assert not orbit.converged
    assert not orbit.passed
    assert np.all(np.isfinite(orbit.q))
    with pytest.raises(SelfCheckFailed, match="diverging shooting"):
        orbit.require()
    with pytest.raises(BadInput, match="diverging shooting"):
        orbit_multipliers(orbit)
