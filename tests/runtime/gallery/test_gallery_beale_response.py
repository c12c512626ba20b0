"""Beale & Scott's section 3.2 in the gallery: its numbers, and those of converged modes."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.gallery import beale_response
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.scenes import load_scene


def _drawn(function, rows=1):
    axes = new_figure().subplots(rows, 1, squeeze=False).ravel()
    return function(list(axes))


def _system(formulation, modes, *drop):
    changes = {"model.formulation": formulation, "model.modes": modes, "model.drop": list(drop)}
    overrides = {**changes, "links.crank_ratio": 0.2}
    return load_scene("beale_1992_flexible_rod", overrides=overrides).linear_system()


def test_the_frequency_over_the_cycle():
    drawn = _drawn(beale_response.figure_11)
    assert all(row.check.passed for row in drawn.quoted)
    # The mean of the converged modes, by two bases that share nothing but the rod.
    overhang = beale_response.mean_frequency("overhang", 4)
    assert abs(overhang / beale_response.mean_frequency("two_segment", 8) - 1) < 1e-4
    assert abs(overhang - 873.597) < 5e-3


def test_the_beating_and_what_converged_modes_make_of_it():
    drawn = _drawn(beale_response.figure_12, 2)
    assert all(row.check.passed for row in drawn.quoted)
    assert [row.verdict for row in drawn.quoted].count("known to differ") == 1
    assert len(drawn.tables[0].rows) == 8


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
    drawn = _drawn(beale_response.figure_resonances)
    assert all(row.check.passed for row in drawn.quoted)
    curve = beale_response.resonances(0.05)
    assert list(np.sort(curve.order[curve.mode == 1])) == [1, 2, 3, 4]
    np.testing.assert_allclose(curve.ratio[curve.mode == 1], 1.0, atol=4e-3)


def test_the_steady_state_at_a_tenth_is_small_and_converged_in_modes():
    tips = [
        steady_state(_system("overhang", modes), 87.36, internal_damping=0.8).peak()
        for modes in (2, 4)
    ]
    assert tips[0] < 0.01
    assert abs(tips[0] - tips[1]) < 0.02 * tips[1]
