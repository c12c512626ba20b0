"""What the gallery computes for Beale and Scott's figures, by other routes."""

import numpy as np
import pytest
from elastolink.runtime.frequencies import natural_frequencies
from elastolink.runtime.gallery import beale
from elastolink.runtime.gallery.beale import FLEXIBLE, HEAVY, STIFF, rod, stiff_tip
from elastolink.runtime.gallery.drawing import peak
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.transition import method, segments_of
from rod_reference import TIPS

# Deflections leave the linear range at resonances; the equations stay linear.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")

# Tip deflection over the length at crank angles pi/4, ..., 2 pi, flexible rod, crank ratio 0.01,
# 100 rad/s, without tension: from a fixed mesh that knows of no modes.
FIXED_MESH = TIPS["flexible, ratio 0.01, 100 rad/s", False]


def test_the_tip_from_rest_is_that_of_a_fixed_mesh():
    theta, tip = beale.tip_from_rest(rod(FLEXIBLE, "overhang", 6), 100.0)
    step = (len(theta) - 1) // 8
    np.testing.assert_allclose(theta[step], np.pi / 4, rtol=1e-12)
    # Six overhang modes are within 1.3e-5 of the peak of the exact deflection.
    gap = np.max(np.abs(tip[step::step] - FIXED_MESH))
    assert gap < 2e-5 * peak(tip)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [STIFF, HEAVY])
@pytest.mark.parametrize("damping", [{}, {"rod__relaxation_time": 0.002}])
def test_ten_polynomial_modes_of_the_paper_from_rest(scene, damping):
    """Its Fig. 5 by ``simulate``, beside fixed steps that are stable at any length."""
    system, count = rod(scene, "polynomial", 10, **damping), 1440
    theta, tip = beale.tip_from_rest(system, 90.0)
    equation = equation_of(system, 90.0, {}, forcing=True)
    state, states = np.append(np.zeros(20), 1.0), []
    for one in segments_of(equation, count, method("gauss", 6)).maps[0]:
        state = one @ state
        states.append(state[:10] * equation.scale[0])
    shapes = system.shapes(np.ones(1), theta[1:])[:, 0]
    fixed = system.reference_length * np.sum(shapes * np.array(states)[1::2], axis=1)
    assert peak(tip[1:] - fixed) < 1e-6 * peak(fixed)


def test_constrained_and_linear_free_free_modes_agree_where_deflections_are_small():
    # Amplitude over length 1.5e-4: what the linear form leaves out is of its square.
    for modes in (1, 2):
        theta, tip = beale.constrained_tip(FLEXIBLE, modes)
        linear = rod(FLEXIBLE, "free_free_linear", modes, ("tension",))
        angle, other = beale.tip_from_rest(linear, 100.0)
        np.testing.assert_allclose(theta, angle, atol=1e-12)
        assert peak(tip - other) < 1e-4 * peak(other)


@pytest.mark.parametrize("scene", [STIFF, pytest.param(HEAVY, marks=pytest.mark.slow)])
def test_components_belong_to_a_deflection_across_the_rod(scene):
    theta, along, across = beale.components(scene)
    tip = stiff_tip(scene, "overhang", 6, ())[1]
    np.testing.assert_allclose(np.hypot(along, across), np.abs(tip), atol=1e-13 * peak(tip))
    # The block at a_x + G e^(i theta) gives the rod's direction without the mechanism.
    block = 4.0 + 1.5 * np.exp(1j * theta)
    turned = (along + 1j * across) / (1j * block / np.abs(block))
    np.testing.assert_allclose(turned, tip, atol=1e-13 * peak(tip))


def test_frequencies_of_the_converged_modes_are_those_of_another_basis():
    # At crank length zero.
    overhang = beale.frequencies("overhang", 4)[:2]
    other = rod(FLEXIBLE, "two_segment", 8, links__crank_ratio=1e-6)
    np.testing.assert_allclose(overhang, natural_frequencies(other).mean[:2], rtol=2e-4)
    assert abs(overhang[0] - 858.228) < 1e-2
    # The mean over the cycle, by two bases that share nothing but the rod.
    overhang = beale.mean_frequency("overhang", 4)
    assert abs(overhang / beale.mean_frequency("two_segment", 8) - 1) < 1e-4
    assert abs(overhang - 873.597) < 5e-3


def _system(formulation, modes, *drop):
    return rod(FLEXIBLE, formulation, modes, drop, links__crank_ratio=0.2)


def test_the_unstable_region_at_900_rad_s_is_a_combination_in_converged_modes():
    largest = {}
    for modes in (4, 6):
        found = floquet_multipliers(_system("overhang", modes, "as_printed"), 900.0, rtol=1e-9)
        assert not found.stable
        top = found.multipliers[np.argmax(np.abs(found.multipliers))]
        # Off the real axis: no region of a single mode.
        assert abs(top.imag) > 0.5
        largest[modes] = abs(top) - 1
    # Eight modes give 0.06293; a fixed mesh grows alike (see the tip deflections' own tests).
    assert abs(largest[6] - 0.06293) < 2e-4
    assert abs(largest[4] - largest[6]) < 0.06 * largest[6]
    assert floquet_multipliers(_system("overhang", 6), 900.0, rtol=1e-9).stable
    assert floquet_multipliers(_system("polynomial", 3, "as_printed"), 900.0, rtol=1e-9).stable


@pytest.mark.slow
def test_resonances_lie_at_fractions_of_the_mean_frequency():
    curve = beale.resonances(0.05)
    assert list(np.sort(curve.order[curve.mode == 1])) == [1, 2, 3, 4]
    np.testing.assert_allclose(curve.ratio[curve.mode == 1], 1.0, atol=4e-3)
