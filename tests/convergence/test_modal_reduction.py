"""Reduction to moving modes: what it keeps exactly, and how fast it converges with the modes.

References: the whole system's multipliers and motions.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic import reduced_system, steady_state
from elastolink.runtime.periodic.moving_basis import moving_basis
from elastolink.runtime.periodic.truncation import modal_truncation

SCENE = "aannaque_1996_table_4_1"


def linkage(elements=1, ratio=0.02):
    overrides = {"mesh.elements": elements, "damping.ratio": ratio}
    return el.load_scene(SCENE, overrides=overrides).system()


@pytest.fixture(scope="module")
def damped():
    return linkage()


def test_the_basis_is_smooth_periodic_and_orthonormal(damped):
    basis = moving_basis(damped, 4)
    theta = np.linspace(0.0, 4.0 * np.pi, 37)
    phi = basis(theta)
    mass = damped.array("M", theta)
    unit = np.swapaxes(phi, 1, 2) @ mass @ phi
    assert np.max(np.abs(unit - np.eye(4))) < 1e-11
    assert np.max(np.abs(basis(theta + 2.0 * np.pi) - phi)) < 1e-12 * np.max(np.abs(phi))
    # Central differences of order two: the error is that of the step, 1e-5 squared, and round-off.
    step = 1e-5
    slope = (basis(theta + step) - basis(theta - step)) / (2.0 * step)
    assert np.max(np.abs(slope - basis.derivative(theta))) < 1e-8 * np.max(np.abs(phi))


def test_the_basis_spans_the_lowest_modes_where_they_cross_or_not(damped):
    """K and M on the basis have the lowest frequencies, whatever the crossings within."""
    basis = moving_basis(damped, 4)
    theta = np.array([0.3, 1.7, 4.4])
    phi = basis(theta)
    small = np.swapaxes(phi, 1, 2) @ damped.array("K", theta) @ phi
    mass, stiffness = damped.array("M", theta), damped.array("K", theta)
    for k in range(3):
        wanted = np.sort(np.linalg.eigvals(np.linalg.solve(mass[k], stiffness[k])).real)[:4]
        assert np.linalg.eigvalsh(small[k]) == pytest.approx(wanted, rel=1e-8)


@pytest.mark.slow
def test_multipliers_of_fewer_modes_approach_those_of_the_full_system(damped):
    """What a mode more changes falls; with 8 of 9 the rest is of the size of its own coupling."""
    wanted = np.sort(np.abs(el.floquet_multipliers(damped, 62.0).multipliers))[::-1][:8]
    errors = []
    for modes in (4, 8):
        found = el.floquet_multipliers(reduced_system(damped, modes), 62.0).multipliers
        errors.append(np.max(np.abs(np.sort(np.abs(found))[::-1][:8] - wanted)))
    assert errors[0] < 1e-3
    assert errors[1] < 0.3 * errors[0]


def test_an_undamped_reduced_system_stays_symplectic():
    """Outside its bands every multiplier of the reduced system is on the circle to round-off."""
    reduced = reduced_system(linkage(ratio=0.0), 4)
    found = np.abs(el.floquet_multipliers(reduced, 45.0).multipliers)
    assert np.max(np.abs(np.sort(found) * np.sort(found)[::-1] - 1.0)) < 1e-9


def test_what_cannot_be_reduced_is_refused(damped):
    for modes in (0, 10, 2.5, True):
        with pytest.raises(BadInput, match="modes"):
            reduced_system(damped, modes)


def test_another_geometry_gets_modes_of_its_own(damped):
    changed = reduced_system(damped, 4).with_geometry(coupler=0.636)
    wanted = reduced_system(damped.with_geometry(coupler=0.636), 4)
    theta = np.array([0.4, 2.0])
    assert changed.array("K", theta) == pytest.approx(wanted.array("K", theta), rel=1e-9)


@pytest.mark.parametrize(
    ("elements", "modes", "speed", "most"),
    [
        (1, 4, 40.0, 2e-4),
        (3, 4, 40.0, 2e-4),
        (3, 6, 62.0, 1e-4),
        (3, 8, 62.0, 3e-5),
    ],
)
@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_what_follows_in_equilibrium_is_lifted(elements, modes, speed, most):
    """Motions of the truncated system against those of the whole one, each over its peak."""
    full = linkage(elements=elements)
    truncated = modal_truncation(full, modes)
    z = steady_state(truncated, speed, rtol=1e-8, samples=128).q
    q, change = truncated.lift(z[None], [speed])
    truth = steady_state(full, speed, rtol=1e-8, samples=len(truncated.theta)).q
    gap = np.max(np.abs(q[0] - truth), axis=0) / np.max(np.abs(truth), axis=0)
    assert np.max(gap) < most
    assert change[0] < 1e-2
