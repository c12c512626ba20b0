"""Damping by modal ratios: the mechanism held still, other geometry, and what it refuses."""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from edge_truth import scene_rod
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.systems import with_modal_damping
from periodic_systems import system_of
from scipy.linalg import eig

RATIO = 0.02
POLYNOMIAL = scene_rod(0.2, 3, **{"model.formulation": "polynomial"})


def _ratios(system, theta):
    """Damping ratios of the mechanism held still, from its full quadratic eigenvalue problem."""
    mass, drag, stiff = (system.array(name, np.array([theta]))[0] for name in ("M", "C", "K"))
    n = len(mass)
    zero, unit = np.zeros((n, n)), np.eye(n)
    values = eig(
        np.block([[zero, unit], [-stiff, -drag]]),
        np.block([[unit, zero], [zero, mass]]),
        right=False,
    )
    upper = values[values.imag > 0]
    return np.sort(-upper.real / np.abs(upper))


@pytest.mark.parametrize("theta", [0.0, 1.1, 2.9])
def test_every_mode_has_the_ratio_at_every_angle(theta):
    damped = with_modal_damping(POLYNOMIAL, RATIO)
    np.testing.assert_allclose(_ratios(damped, theta), RATIO, rtol=1e-9)
    assert not np.any(POLYNOMIAL.array("C", np.array([theta])))


def test_another_geometry_damps_the_modes_that_it_has():
    """The same as made there from the start; the old matrices would be far off."""
    theta = np.linspace(0.0, 6.0, 7)
    moved = with_modal_damping(scene_rod(0.05, 3), RATIO).with_geometry(crank_ratio=0.3)
    fresh = with_modal_damping(scene_rod(0.3, 3), RATIO)
    expected = fresh.array("C", theta)
    np.testing.assert_allclose(moved.array("C", theta), expected, rtol=1e-13)
    old = with_modal_damping(scene_rod(0.05, 3), RATIO).array("C", theta)
    assert np.max(np.abs(old - expected)) > 0.1 * np.max(np.abs(expected))
    np.testing.assert_allclose(_ratios(moved, 0.7), RATIO, rtol=1e-9)
    assert moved.geometry["crank_ratio"] == 0.3
    assert moved.parameters["damping_ratio"] == RATIO


def test_a_ratio_changed_as_a_parameter_stays_so():
    doubled = (
        with_modal_damping(scene_rod(0.1, 3), RATIO)
        .with_parameters(damping_ratio=2 * RATIO)
        .with_geometry(crank_ratio=0.3)
    )
    np.testing.assert_allclose(_ratios(doubled, 1.0), 2 * RATIO, rtol=1e-9)


def test_a_constant_system_gets_a_constant_matrix():
    system = system_of(M=np.diag([1.0, 4.0]), K=np.array([[5.0, -1.0], [-1.0, 8.0]]))
    damped = with_modal_damping(system, 0.1)
    assert damped.is_constant("C")
    assert damped.rebuild is None
    np.testing.assert_allclose(_ratios(damped, 0.0), 0.1, rtol=1e-12)


@pytest.mark.slow
def test_the_damping_does_not_depend_on_the_basis():
    """Least damped multiplier on two bases, far from small cranks.

    The velocity that a moving basis carries along is damped too: without it the bases differ by
    4e-3 here.  With it they differ by what they truncate: 1e-5 at eight modes and twelve shapes.
    """
    formulations = {"overhang": 8, "two_segment": 12}
    moduli, without = (
        [
            np.max(np.abs(el.floquet_multipliers(change(system), 300.0).multipliers))
            for system in (
                with_modal_damping(scene_rod(0.3, modes, **{"model.formulation": name}), RATIO)
                for name, modes in formulations.items()
            )
        ]
        for change in (lambda system: system, lambda system: system.without("D"))
    )
    assert abs(moduli[0] - moduli[1]) < 5e-5
    assert abs(without[0] - without[1]) > 1e-3


def test_a_bad_ratio_and_damping_twice_are_refused():
    for ratio in (-0.1, np.nan, np.inf, "a", None, np.ones(2)):
        with pytest.raises(BadInput, match="ratio"):
            with_modal_damping(scene_rod(), ratio)
    damped = with_modal_damping(scene_rod(), RATIO)
    with pytest.raises(BadInput, match="modal damping already"):
        with_modal_damping(damped, RATIO)
    # A copy without geometry to rebuild works as well.
    fixed = with_modal_damping(replace(scene_rod(), rebuild=None, geometry={}), RATIO)
    with pytest.raises(BadInput, match="one geometry"):
        fixed.with_geometry(crank_ratio=0.1)
