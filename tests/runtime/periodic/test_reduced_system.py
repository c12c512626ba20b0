"""Reduction to moving modes: the basis, other geometry, refusals.

Its arrays and their errors: ``error_estimates/test_reduction_errors.py``.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.periodic import reduced_system
from elastolink.runtime.periodic.moving_basis import moving_basis


@pytest.fixture(scope="module")
def damped():
    return el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()


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


def test_another_geometry_gets_modes_of_its_own(damped):
    changed = reduced_system(damped, 4).with_geometry(coupler=0.636)
    wanted = reduced_system(damped.with_geometry(coupler=0.636), 4)
    theta = np.array([0.4, 2.0])
    assert changed.array("K", theta) == pytest.approx(wanted.array("K", theta), rel=1e-9)
