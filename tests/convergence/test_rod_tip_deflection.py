"""The rod's tip from rest: every basis against a fixed mesh that knows of no moving basis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.systems.rod import (
    OverhangBasis,
    PolynomialBasis,
    TwoSegmentBasis,
)
from marching import marched
from rod_bases import made
from rod_reference import CASES, flexible, kinematics, mesh_for, tip_motion
from rod_series import tabulated
from rod_tip_deflections import TIPS

# Steps of order 16 in a revolution; twice as many change nothing here.
STEPS = 384


def _tip(basis, rod, revolutions=2):
    """Return v(L)/L at eight crank angles a revolution, the start left out."""
    system = made(rod, basis)
    every = STEPS // 8
    q = marched(8, tabulated(system), rod.speed, STEPS, revolutions)[::every]
    shapes = system.shapes(np.ones(1), np.pi / 4 * np.arange(len(q)))
    assert shapes is not None
    return np.einsum("tn,tn->t", shapes[:, 0], q)[1:]


def _error(basis, name, tension, revolutions=2):
    known, exact = TIPS[name, tension]
    exact = exact[: 8 * revolutions]
    gap = np.max(np.abs(_tip(basis, replace(CASES[name], tension=tension), revolutions) - exact))
    return float(gap / np.max(np.abs(exact))), known / np.max(np.abs(exact))


@pytest.mark.slow
def test_the_reference_holds_the_block_and_repeats_its_table():
    name = "flexible, ratio 0.2, 300 rad/s"
    rod = CASES[name]
    tips, held = tip_motion(rod, mesh_for(rod, 12, 8), 1, 200, 8)
    assert np.max(np.abs(held)) < 1e-13
    # Twelve elements and 200 steps are good to a few units of 1e-7 of a tip of 0.1.
    assert np.max(np.abs(tips[1:] - TIPS[name, True][1][:8])) < 1e-6


@pytest.mark.slow
def test_the_reference_knows_the_static_deflection():
    # A very slow crank: each moment the rod bends as under the resting load m x phi'' w^2.
    rod = flexible(0.2, 2.0)
    tips, _ = tip_motion(rod, mesh_for(rod, 12, 8), 1, 400, 8)
    expected = []
    for k in range(1, 9):
        place, _, _, turn = kinematics(rod, k * np.pi / 4)
        expected.append(_static_tip(place, -turn) / rod.stiffness)
    # Free waves are left from the start, where the load rises at a finite rate: of the order of
    # speed/frequency, 2/900, beside the static deflection.
    assert np.max(np.abs(tips[1:] - expected)) < 0.01 * np.max(np.abs(expected))


def _static_tip(place, load):
    """Tip deflection of a unit beam, EI = 1, pinned at 0 and ``place``, under ``load x``.

    Moments about the pin give the block's force load/(3 place), the sum the pin's; then
    EI times the fourth derivative is load less forces; v(place) = 0 fixes the slope at the pin.
    """
    block = load / (3 * place)
    pin = load / 2 - block

    def without_slope(x):
        return load * x**5 / 120 - pin * x**3 / 6 - block * max(x - place, 0.0) ** 3 / 6

    return without_slope(1.0) - without_slope(place) / place


@pytest.mark.parametrize("tension", [True, False])
def test_overhang_modes_come_near_with_few(tension):
    name = "flexible, ratio 0.01, 100 rad/s"
    first, _ = _error(OverhangBasis(1), name, tension, 1)
    second, _ = _error(OverhangBasis(2), name, tension, 1)
    assert first < 0.05
    assert second < first / 3


@pytest.mark.slow
@pytest.mark.parametrize("name", list(CASES))
def test_overhang_modes_converge_with_and_without_tension(name):
    for tension in (True, False):
        errors = [_error(OverhangBasis(n), name, tension, 1)[0] for n in (1, 2, 4)]
        assert errors[1] < errors[0] / 2 and errors[2] < errors[1] / 4, errors
        assert errors[2] < 1e-3


@pytest.mark.slow
def test_the_motion_at_900_rad_s_grows_on_the_fixed_mesh_as_in_overhang_modes():
    # Beale & Scott's Fig. 12 as printed: bounded beating in three polynomials, growth in truth.
    rod, turns, samples = flexible(0.2, 900.0, tension=False), 20, 32
    tips, _ = tip_motion(rod, mesh_for(rod, 12, 8), turns, 96, samples)
    peaks = np.max(np.abs(tips[1:]).reshape(turns, samples), axis=1)
    assert np.max(peaks[-6:]) > 1.4 * np.max(peaks[:6])
    found = _tip(OverhangBasis(6), rod, turns)
    # This mesh and these steps are good to a few per cent of the peak, by refining both.
    gap = np.abs(found - tips[samples // 8 :: samples // 8])
    assert np.max(gap) < 0.05 * np.max(peaks)


@pytest.mark.slow
def test_two_segment_polynomials_converge_to_the_reference():
    name = "flexible, ratio 0.2, 300 rad/s"
    errors = [_error(TwoSegmentBasis(n), name, True, 1)[0] for n in (4, 6, 8)]
    assert errors[1] < errors[0] / 10
    assert errors[2] < errors[1] / 10
    assert errors[2] < 1e-3


def test_one_polynomial_over_the_block_converges_slowly():
    # Both sides of the block share one polynomial, so that the shear force cannot jump there.
    name = "flexible, ratio 0.2, 300 rad/s"
    errors = [_error(PolynomialBasis(n), name, False, 1)[0] for n in (2, 4, 6)]
    assert errors[0] > errors[1] > errors[2] > 0.01
