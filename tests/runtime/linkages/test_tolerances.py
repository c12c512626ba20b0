"""Tolerances against derivatives in many digits, exact extremes, and random linkages."""

import itertools
import json
import math
from dataclasses import replace

import elastolink as el
import mpmath
import numpy as np
import pytest
from forces_truth import forces as exact_forces
from linkage_truth import motion as four_bar_motion
from refusals import refused
from sliding_truth import rod_motion, slider_motion

THETA = np.linspace(0.0, 2.0 * np.pi, 37)
FOUR_BAR = el.FourBar(0.5, 0.1, 0.45, 0.22)
DRAG_LINK = el.FourBar(2.0, 4.0, 5.0, 4.5, "crossed")
SLIDER = el.SliderCrank(0.04, 0.14, 0.01)
SHAPER = el.QuickReturn(0.25, 0.1, 0.5)
LINKAGES = (FOUR_BAR, DRAG_LINK, SLIDER, SHAPER)
BODY = el.MassDistribution.about_centre(0.7, 0.06, 0.01, 0.004)


MOTIONS = {
    el.FourBar: ("four_bar", four_bar_motion),
    el.SliderCrank: ("slider_crank", slider_motion),
    el.QuickReturn: ("quick_return", rod_motion),
}
EVERY = pytest.mark.parametrize("linkage", LINKAGES, ids=lambda item: type(item).__name__)


def machine_of(linkage, **more):
    return el.Machine(linkage, dict.fromkeys(linkage.links, BODY), **more)


def springs_of(linkage):
    """Springs and dampers of both kinds between all links and the frame."""
    second, third, fourth = linkage.links
    return (
        el.Spring(("frame", 0.1, 2.0), (third, 0.05, 0.02), 30.0, 0.1, damping=2.0, preload=3.0),
        el.Spring((second, 0.02, -0.01), (fourth, 0.03, 1.5), 20.0, 0.2),
        el.Spring(("frame", 0.0, -0.3), (fourth, 0.1, 0.0), 5.0),
        el.TorsionSpring(second, fourth, 2.0, 0.3, damping=0.1),
        el.TorsionSpring("frame", third, 1.0, preload=0.2),
    )


def exact(machine, theta, speed, acceleration):
    """Return numbers by parameter's name, and the exact outputs as their function."""
    mechanism, motion = MOTIONS[type(machine.linkage)]
    numbers = {name: mpmath.mpf(size) for name, size in machine.linkage.lengths.items()}
    numbers["theta2"] = mpmath.mpf(theta)
    for link in machine.linkage.links:
        numbers |= {f"{link}.{k}": mpmath.mpf(v) for k, v in vars(machine.mass(link)).items()}

    def outputs(values):
        given = {name: values[name] for name in machine.linkage.lengths}
        given |= {"theta2": values["theta2"], "assembly": mpmath.mpf(machine.linkage.branch)}
        m = dict(motion(given))
        for place, link in enumerate(machine.linkage.links, start=2):
            for name in vars(machine.mass(link)):
                given[f"{name}{place}"] = values[f"{link}.{name}"]
        given |= {"speed": mpmath.mpf(speed), "acceleration": mpmath.mpf(acceleration)}
        for w in {"omega3", "omega4", "slider_velocity", "slide_velocity"} & set(m):
            a = w.replace("omega", "alpha").replace("velocity", "acceleration")
            m[w], m[a] = m[w] * speed, m[a] * speed**2 + m[w] * acceleration
        return m | exact_forces(mechanism)(given)

    return numbers, outputs


@EVERY
def test_every_sensitivity_against_sixty_digits(linkage):
    machine = machine_of(linkage)
    angles, speed, acceleration = np.array([0.3, 4.4]), 7.0, -11.0
    found = el.tolerances(machine, {"crank": 1e-6}, angles, speed, acceleration)
    assert found.passed
    with mpmath.workdps(60):
        step = mpmath.mpf(10) ** -30
        for at, theta in enumerate(angles):
            numbers, outputs = exact(machine, theta, speed, acceleration)
            here = outputs(numbers)
            for parameter in found.parameters:
                there = outputs({**numbers, parameter: numbers[parameter] + step})
                for row, name in enumerate(found.outputs):
                    slope = float((there[name] - here[name]) / step)
                    sizes = np.abs(found.sensitivity[row, :, at])
                    size = sizes.max() + abs(found.nominal[row, at])
                    assert found.by(name, parameter)[at] == pytest.approx(
                        slope, rel=1e-11, abs=1e-12 * size
                    ), (name, parameter)


@EVERY
def test_values_and_slopes_are_those_of_motion_and_forces(linkage):
    """With weights, loads and springs: nominal values, and their differences over the crank."""
    loads = (
        el.Load(linkage.links[1], (3.0, -2.0), couple=0.4, along=0.05, across=0.02),
        el.Load(linkage.links[2], (1.0, 5.0), along=0.03, axes="link"),
    )

    def built(crank):
        moved = replace(linkage, crank=crank)
        springs = springs_of(linkage)
        return machine_of(moved, gravity=(0.3, -9.81), loads=loads, springs=springs)

    size = linkage.lengths["crank"]
    found = el.tolerances(built(size), {"crank": 1e-5 * size}, THETA, 9.0, 4.0)
    motion = linkage.motion(THETA, 9.0, 4.0)
    forces = el.rigid_forces(built(size), THETA, 9.0, 4.0).values
    for row, name in enumerate(found.outputs):
        expected = forces[name] if name in forces else getattr(motion, name)
        np.testing.assert_allclose(found.nominal[row], expected, rtol=1e-11, atol=1e-11)
    step = 1e-5 * size
    above, below = (
        el.rigid_forces(built(size + sign * step), THETA, 9.0, 4.0).values for sign in (1, -1)
    )
    for name in forces:
        slope = (above[name] - below[name]) / (2.0 * step)
        # Third order: step^2 over the crank's square, 1e-10; round-off: 1e-16 over the step.
        atol = 1e-8 * np.abs(slope).max() + 1e-9 * np.abs(above[name]).max() / size
        np.testing.assert_allclose(found.by(name, "crank"), slope, rtol=0, atol=atol)


@EVERY
def test_bars_grow_with_their_links(linkage):
    """Twice the lengths of uniform bars: forces of inertia grow as mass times length."""
    bars = {
        link: el.MassDistribution.uniform_bar(0.4, linkage.lengths[link])
        for link in linkage.links
        if link in linkage.lengths
    }
    machine = el.Machine(linkage, bars)
    found = el.tolerances(machine, {"crank": 1e-6}, THETA, 3.0, 2.0, masses="bars")
    sizes = np.array(list(linkage.lengths.values()))[:, np.newaxis]
    for name in found.outputs:
        row = found.place(name)
        grown = np.sum(found.sensitivity[row, : len(sizes)] * sizes, axis=0)
        moment = "moment" in name or name == "torque" or name.startswith("couple")
        degree = 3 if moment else 2 if name[0] in "xy" or "shaking" in name else 0
        degree = 1 if name.startswith("slide") or name == "position" else degree
        size = np.abs(found.sensitivity[row, : len(sizes)] * sizes).max() + 1e-300
        np.testing.assert_allclose(
            grown / size, degree * found.nominal[row] / size, rtol=0, atol=1e-12
        )


@EVERY
def test_the_error_holds_at_every_corner(linkage):
    widths = {name: 0.003 * abs(size) for name, size in linkage.lengths.items() if name != "rod"}
    machine = machine_of(linkage)
    found = el.tolerances(machine, widths, THETA, 5.0)
    largest = np.zeros_like(found.nominal)
    for signs in itertools.product((-1.0, 0.0, 1.0), repeat=len(widths)):
        moved = dict(linkage.lengths)
        for (name, width), sign in zip(widths.items(), signs, strict=True):
            moved[name] += sign * width
        other = replace(linkage, **moved)
        there = el.tolerances(machine_of(other), {}, THETA, 5.0).nominal
        largest = np.maximum(largest, np.abs(there - found.nominal))
    off = np.abs(largest - found.worst_case)
    assert np.all(off <= found.error + 1e-13)
    # The estimate is not idle.
    used = found.worst_case > 1e-9 * np.abs(found.nominal).max(axis=1, keepdims=True)
    assert np.median(found.error[used] / np.maximum(off[used], 1e-300)) < 50.0


def test_a_wrong_sensitivity_does_not_pass_the_trial():
    found = el.tolerances(FOUR_BAR, {"crank": 1e-4}, THETA)
    wrong = replace(found, sensitivity=found.sensitivity * 1.3)
    assert not wrong.monte_carlo(samples=2000).passed


def test_worst_case_root_of_squares_and_shares():
    found = el.tolerances(FOUR_BAR, {"crank": 1e-4, "coupler": 2e-4}, THETA)
    parts = np.stack([found.by("theta4", "crank") * 1e-4, found.by("theta4", "coupler") * 2e-4])
    row = found.place("theta4")
    np.testing.assert_allclose(found.worst_case[row], np.abs(parts).sum(axis=0), rtol=1e-14)
    np.testing.assert_allclose(found.root_sum_square[row], np.hypot(*parts), rtol=1e-14)
    np.testing.assert_allclose(found.contribution[row].sum(axis=0), 1.0, rtol=1e-14)
    assert found.unit("theta4") == "rad" and found.unit("omega4") == "1"
    assert el.tolerances(FOUR_BAR, {"crank": 1e-4}, THETA, 2.0).unit("alpha4") == "rad/s^2"


def test_near_toggle_the_first_order_says_how_far_it_holds():
    """Frame + crank nearly coupler + follower: at pi the transmission angle nears pi."""
    gap = 1e-4
    linkage = el.FourBar(0.5, 0.1, 0.35, 0.25 + gap)
    narrow, wide = (el.tolerances(linkage, {"crank": t}, [3.0, math.pi]) for t in (1e-9, 9e-5))
    assert narrow.passed and wide.passed and wide.keeps_turning
    row = narrow.place("theta4")
    assert narrow.error[row, 1] < 1e-4 * narrow.worst_case[row, 1]
    assert wide.error[row, 1] > 0.5 * wide.worst_case[row, 1]


test_wrong_tolerances_are_refused = refused(
    lambda given: el.tolerances(FOUR_BAR, given, THETA),
    [
        ({"krank": 1e-4}, "expected one of frame, crank"),
        ({"coupler.mass": 1e-4}, "masses need a Machine"),
        ({"crank": math.nan}, "zero or more"),
        ({"crank": "1 mm"}, "zero or more"),
        ({"crank": 0.2}, "less than the length"),
        ([1e-4], "a mapping"),
    ],
)


PRESS = el.Load("follower", lambda angle: (np.sin(angle), 0.0 * angle))
FOUND = el.tolerances(FOUR_BAR, {"crank": 1e-4}, THETA)

test_other_wrong_input_is_refused = refused(
    lambda call: call(),
    [
        (lambda: el.tolerances("four-bar", {"crank": 1e-4}, THETA), "a linkage or a Machine"),
        (lambda: el.tolerances(FOUR_BAR, {}, THETA, masses="rods"), "'fixed' or 'bars'"),
        (lambda: el.tolerances(machine_of(FOUR_BAR, loads=(PRESS,)), {}, THETA), "is a function"),
        (lambda: FOUND.by("theta5", "crank"), "theta5"),
        (lambda: FOUND.by("theta4", "krank"), "krank"),
        (lambda: FOUND.monte_carlo(1), "samples"),
        (lambda: FOUND.monte_carlo(10, -1), "seed"),
        (lambda: FOUND.monte_carlo(10, 0, "cauchy"), "distribution"),
        (lambda: el.tolerances(FOUR_BAR, {"crank": 1e-4}, 1.0).plot(), "one-dimensional"),
    ],
)

FOLDING = el.FourBar(0.5, 0.1, 0.35, 0.2501)
ROCKER = el.FourBar(0.5, 0.4, 0.45, 0.3)
END = ROCKER.crank_ranges()[-1][1]


test_tolerances_that_fold_the_linkage_are_refused = refused(
    lambda linkage, widths, theta: el.tolerances(linkage, widths, [theta]),
    [
        (FOLDING, {"crank": 2e-4, "coupler": 1e-6}, math.pi, r"'crank'.*3\.14159 rad.*crank first"),
        (el.SliderCrank(0.1, 0.2, 0.05), {"offset": 0.06}, -math.pi / 2, "offset"),
        (SHAPER, {"rod": 0.2}, 0.0, "rod"),
        (ROCKER, {"theta2": 0.01}, END - 0.009, "theta2 first"),
        (FOUR_BAR, {"theta2": 1.6}, 0.0, "a quarter turn"),
    ],
)


def test_elsewhere_it_is_said_whether_the_crank_keeps_turning():
    assert not el.tolerances(FOLDING, {"crank": 2e-4}, [0.0, 1.0]).keeps_turning
    assert not el.tolerances(ROCKER, {"theta2": 0.01}, [END - 0.011]).keeps_turning
    # A crank that turns fully folds nowhere.
    assert np.all(el.tolerances(FOUR_BAR, {"theta2": 1.5}, THETA).nominal < 10.0)


def test_results_leave_as_json_csv_and_pictures_of_the_band(tmp_path):
    slider = el.tolerances(SLIDER, {"crank": 1e-4}, THETA)
    ax = slider.plot()
    assert "mm" in ax.get_ylabel() and len(ax.get_lines()) == 2
    band = 1e3 * slider.worst_case[slider.place("position")].max()
    assert ax.get_ylim()[1] >= band * (1 - 1e-12) and ax.get_ylim()[0] < 0.0
    assert "omega3" in slider.plot(output="omega3").get_ylabel()
    found = el.tolerances(FOUR_BAR, {"crank": 1e-4})
    saved = json.loads(found.save(tmp_path / "t.json").read_text())
    assert saved["outputs"][1] == "theta4" and saved["units"]["theta4"] == "rad"
    np.testing.assert_array_equal(saved["worst_case"], found.worst_case)
    assert "model" not in saved
    assert found.save(tmp_path / "t.csv").read_text().count("\n") > 361
    trial = json.loads(found.monte_carlo(20).save(tmp_path / "m.json").read_text())
    assert trial["samples"] == 20


@pytest.mark.parametrize("shape", [(), (0,), (2, 3)])
def test_any_shape_of_angles(shape):
    found = el.tolerances(FOUR_BAR, {"crank": 1e-4}, np.full(shape, 0.4))
    assert found.sensitivity.shape == (7, 5, *shape)
    assert found.worst_case.shape == found.error.shape == (7, *shape)
    assert found.passed and found.monte_carlo(20).passed
