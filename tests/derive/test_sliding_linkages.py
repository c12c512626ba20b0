"""The derived kinematics of slider-crank and quick-return: exact identities, structure, truth."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import quick_return, slider_crank
from elastolink.derive.pipeline import lower
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec
from elastolink.generated import quick_return_kinematics, slider_crank_kinematics
from judging import Point, exact_at, reference_of
from sliding_truth import (
    ROD,
    SLIDER,
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)

MODELS = {"slider_crank": slider_crank, "quick_return": quick_return}
SLIDER_INPUTS = (
    slider_crank.theta2,
    slider_crank.crank,
    slider_crank.coupler,
    slider_crank.offset,
    slider_crank.assembly,
)
ROD_INPUTS = (quick_return.theta2, quick_return.frame, quick_return.crank)


def evaluated(model, inputs, points):
    """Yield the inputs and all steps at points, in 80 digits without any lowering."""
    k = model.kinematics()
    reference = reference_of(
        inputs, [(symbol.name, symbol) for symbol, _ in k.steps.steps], k.steps
    )
    for point in points:
        with mpmath.workdps(80):
            exact = exact_at(reference, Point(point.name, {}, point.arguments))
            yield {name: mpmath.mpf(v) for name, v in point.arguments.items()}, exact.values


# ---------------------------------------------------------------- before lowering


def test_slider_crank_steps_close_the_loop_and_its_derivatives():
    for n, v in evaluated(slider_crank, SLIDER_INPUTS, random_sliders(12, seed=3)):
        r, length = n["crank"], n["coupler"]
        residuals = (
            r * v["cos2"] + length * v["cos3"] - v["position"],
            r * v["sin2"] + length * v["sin3"] - n["offset"],
            r * v["sin2"] + length * v["omega3"] * v["sin3"] + v["slider_velocity"],
            r * v["cos2"] + length * v["omega3"] * v["cos3"],
            r * v["cos2"]
            + length * (v["alpha3"] * v["sin3"] + v["omega3"] ** 2 * v["cos3"])
            + v["slider_acceleration"],
            -r * v["sin2"] + length * (v["alpha3"] * v["cos3"] - v["omega3"] ** 2 * v["sin3"]),
        )
        scale = max(r, length, abs(n["offset"])) * max(1, abs(v["alpha3"]))
        assert all(abs(residual) < 1e-70 * scale for residual in residuals)
        assert abs(v["sin3"] ** 2 + v["cos3"] ** 2 - 1) < 1e-70
        assert mpmath.sign(v["cos3"]) == n["assembly"]


def test_quick_return_steps_close_the_loop_and_its_derivatives():
    for n, v in evaluated(quick_return, ROD_INPUTS, random_rods(12, seed=4)):
        r, x, w, speed = n["crank"], v["slide"], v["omega4"], v["slide_velocity"]
        along = v["slide_acceleration"] - x * w**2
        across = x * v["alpha4"] + 2 * speed * w
        residuals = (
            x * v["cos4"] - n["frame"] - r * v["cos2"],
            x * v["sin4"] - r * v["sin2"],
            speed * v["cos4"] - x * w * v["sin4"] + r * v["sin2"],
            speed * v["sin4"] + x * w * v["cos4"] - r * v["cos2"],
            along * v["cos4"] - across * v["sin4"] + r * v["cos2"],
            along * v["sin4"] + across * v["cos4"] + r * v["sin2"],
            v["sin24"] - (v["sin2"] * v["cos4"] - v["cos2"] * v["sin4"]),
            v["cos24"] - (v["cos2"] * v["cos4"] + v["sin2"] * v["sin4"]),
        )
        scale = (n["frame"] + r) * max(1, abs(v["alpha4"]), w**2)
        assert all(abs(residual) < 1e-70 * max(1, scale) for residual in residuals)


@pytest.mark.parametrize("name", MODELS)
def test_rates_are_derivatives_of_places_by_symbols(name):
    """The steps written out in the crank angle and differentiated by SymPy: another route."""
    model = MODELS[name]
    k = model.kinematics()
    chains = {
        "slider_crank": (("position", "v4", "a4"),),
        "quick_return": (("slide", "v3", "a3"),),
    }[name]
    numbers = {"theta2": 0.7, "crank": 1.0, "coupler": 2.5, "offset": 0.4, "frame": 1.7}
    values = {s: numbers[s.name] for s in (*SLIDER_INPUTS[:4], *ROD_INPUTS)}
    values[slider_crank.assembly] = -1
    for place, speed, acceleration in chains:
        whole = [k.steps.inline(getattr(k, item)) for item in (place, speed, acceleration)]
        for value, slope in pairwise(whole):
            difference = (value.diff(model.theta2) - slope).subs(values)
            assert abs(sp.N(difference, 30)) < 1e-14


def test_angles_turn_as_their_rates_say():
    """d(sin) = cos * w, by symbols, for coupler and rod."""
    for model, sine, cosine, speed, acceleration in (
        (slider_crank, "sin3", "cos3", "w3", "a3"),
        (quick_return, "sin4", "cos4", "w4", "a4"),
    ):
        k = model.kinematics()
        numbers = {"theta2": 1.9, "crank": 1.0, "coupler": 2.5, "offset": -0.4, "frame": 0.7}
        values = {s: numbers[s.name] for s in (*SLIDER_INPUTS[:4], *ROD_INPUTS)}
        values[slider_crank.assembly] = 1
        s, c, w, a = (k.steps.inline(getattr(k, n)) for n in (sine, cosine, speed, acceleration))
        for difference in (s.diff(model.theta2) - c * w, w.diff(model.theta2) - a):
            assert abs(sp.N(difference.subs(values), 30)) < 1e-14


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


def test_fewer_outputs_cost_fewer_operations():
    for name, few in (("slider_crank", "position"), ("quick_return", "slide")):
        counts = []
        for outputs in ((), (few,)):
            spec = ModelSpec(name, "kinematics", outputs=outputs)
            module = lower(
                spec, MODELS[name].MODEL.energies(spec), MODELS[name].MODEL.describe(spec)
            )
            counts.append(module.operations)
        assert counts[1] < 0.6 * counts[0]


def test_a_rewriting_that_does_not_hold_is_refused():
    k = slider_crank.kinematics()
    with pytest.raises(UnsafeRewriting):
        slider_crank._by_ends(k, k.sin2**2)


# ---------------------------------------------------------------- the truth, the emitted


def test_the_exact_motions_are_consistent_with_their_own_differences():
    step = mpmath.mpf(10) ** -30
    chains = (
        ("theta3", "omega3", "alpha3"),
        ("position", "slider_velocity", "slider_acceleration"),
        ("theta4", "omega4", "alpha4"),
        ("slide", "slide_velocity", "slide_acceleration"),
    )
    points = random_sliders(20, seed=5) + random_rods(20, seed=6)
    for point in points + nasty_sliders()[::9] + nasty_rods()[::5]:
        with mpmath.workdps(80):
            truth = slider_motion if "coupler" in point.inputs else rod_motion
            n = {name: mpmath.mpf(v) for name, v in point.arguments.items()}
            here, after = truth(n), truth({**n, "theta2": n["theta2"] + step})
            for chain in chains:
                if chain[0] not in here:
                    continue
                for value, slope in pairwise(chain):
                    change = (after[value] - here[value]) / step
                    scale = abs(here[chain[0]]) + abs(here[slope]) + abs(here[chain[2]]) ** 2 + 1
                    assert abs(change - here[slope]) < mpmath.mpf(10) ** -12 * scale, point.name


def test_the_exact_slider_refuses_what_cannot_close():
    numbers = {"theta2": 1, "crank": 3, "coupler": 1, "offset": 0, "assembly": 1}
    with pytest.raises(ValueError, match="does not close"):
        slider_motion({name: mpmath.mpf(v) for name, v in numbers.items()})


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
