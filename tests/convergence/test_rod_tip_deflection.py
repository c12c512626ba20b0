"""The rod's tip from rest: every basis against a fixed mesh that knows of no moving basis."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.systems.rod import OverhangBasis
from rod_bases import STEPS, transient_tip
from rod_reference import CASES, TIPS, flexible, mesh_for, tip_motion


def _tip(basis, rod, revolutions=1):
    """Return v(L)/L at eight crank angles a revolution, the start left out."""
    return transient_tip(rod, basis, revolutions)[:: STEPS // 8][1:]


def _error(basis, name, tension):
    exact = TIPS[name, tension]
    gap = np.max(np.abs(_tip(basis, replace(CASES[name], tension=tension)) - exact))
    return float(gap / np.max(np.abs(exact)))


@pytest.mark.slow
def test_the_reference_holds_the_block_and_repeats_its_table():
    name = "flexible, ratio 0.2, 300 rad/s"
    rod = CASES[name]
    tips, held = tip_motion(rod, mesh_for(rod, 12, 8), 1, 200, 8)
    assert np.max(np.abs(held)) < 1e-13
    # Twelve elements and 200 steps are good to a few units of 1e-7 of a tip of 0.1.
    assert np.max(np.abs(tips[1:] - TIPS[name, True])) < 1e-6


@pytest.mark.parametrize("name", CASES)
def test_overhang_modes_converge_with_and_without_tension(name):
    for tension in (True, False):
        errors = [_error(OverhangBasis(n), name, tension) for n in (1, 2, 4)]
        assert errors[1] < errors[0] / 2 and errors[2] < errors[1] / 4, errors
        assert errors[2] < 1e-3
        if name == next(iter(CASES)):
            assert errors[0] < 0.05 and errors[1] < errors[0] / 3


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
