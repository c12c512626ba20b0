"""The derived kinematics of slider-crank and quick-return: exact identities, structure, truth."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import quick_return, slider_crank
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec
from elastolink.generated import quick_return_kinematics, slider_crank_kinematics
from sliding_truth import (
    ROD,
    SLIDER,
)

MODELS = {"slider_crank": slider_crank, "quick_return": quick_return}


# ---------------------------------------------------------------- before lowering


def test_rates_of_the_rod_are_products():
    """No sum but those of like-signed ends: the safe form that the derivation is to find."""
    k = quick_return.kinematics()
    values = k.steps.mapping()
    of_ends = {k.near, k.far, k.half_sine, k.half_cosine}
    for name in (k.w4, k.a4, k.v3, k.a3, k.sin24, k.cos24):
        factors = sp.Mul.make_args(values[name])
        sums = [factor for factor in factors if factor.is_Add]
        assert all(total.free_symbols == of_ends for total in sums)
    assert not any(factor.is_Add for factor in sp.Mul.make_args(values[k.a4]))


@pytest.mark.parametrize("name", MODELS)
def test_each_step_serves_an_output_or_the_forces(name):
    """What the motion leaves over is the sines and cosines that the forces are written in."""
    model = MODELS[name]
    closed = model.MODEL.energies(ModelSpec(name, "kinematics"))
    all_steps = {symbol.name for symbol, _ in model.kinematics().steps.steps}
    emitted = {symbol.name for symbol, _ in closed.steps.steps}
    assert all_steps - emitted <= {"cos23", "sin4", "cos4", "sin24", "cos24", "sin2", "cos2"}


def test_a_rewriting_that_does_not_hold_is_refused():
    k = slider_crank.kinematics()
    with pytest.raises(UnsafeRewriting):
        slider_crank._by_ends(k, k.sin2**2)


# ---------------------------------------------------------------- the truth, the emitted


def test_hand_cases_of_the_emitted_functions():
    """Crank 3 upright, coupler 5: the slider at 4 by Pythagoras; crank 3 upright over frame 4."""
    m = dict(
        zip(SLIDER, slider_crank_kinematics.motion(np.pi / 2, 3.0, 5.0, 0.0, 1.0), strict=True)
    )
    assert m["position"] == pytest.approx(4.0, rel=1e-15)
    assert m["theta3"] == pytest.approx(-np.arctan2(3, 4), rel=1e-15)
    assert m["omega3"] == pytest.approx(0.0, abs=1e-15)  # pi/2 is off by 6e-17
    # The pin's velocity is along the guide, and so is the slider's.
    assert m["slider_velocity"] == pytest.approx(-3.0, rel=1e-15)
    assert m["alpha3"] == pytest.approx(3.0 / 4.0, rel=1e-15)
    m = dict(zip(ROD, quick_return_kinematics.motion(np.pi / 2, 4.0, 3.0, 0.0), strict=True))
    assert m["slide"] == pytest.approx(5.0, rel=1e-15)
    assert m["theta4"] == pytest.approx(np.arctan2(3, 4), rel=1e-15)
    # The pin moves to the left with 3: 3 * 3/5 across the rod, -3 * 4/5 along it.
    assert m["omega4"] == pytest.approx(9.0 / 25.0, rel=1e-15)
    assert m["slide_velocity"] == pytest.approx(-12.0 / 5.0, rel=1e-15)
