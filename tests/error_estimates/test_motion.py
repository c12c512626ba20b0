"""The estimates of the motions of all linkages against 80 digits, random and nasty ones."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from honesty import covers
from judging import Point
from linkage_truth import LENGTHS, angles, nasty_points, random_points
from sliding_truth import (
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)


def four_bar_errors(point):
    """Return the estimate and the worse of the two actual errors, of a four-bar."""
    lengths = [point.inputs[name] for name in LENGTHS]
    assembly = "open" if point.fixed["assembly"] > 0 else "crossed"
    motion = FourBar(*lengths, assembly).motion(point.inputs["theta2"])
    assert motion.passed
    with mpmath.workdps(80):
        theta2, *exact = (mpmath.mpf(v) for v in (point.inputs["theta2"], *lengths))
        true = angles(theta2, *exact, mpmath.mpf(point.fixed["assembly"]))
        actual = []
        for value, truth in zip((motion.theta3, motion.theta4), true, strict=True):
            apart = mpmath.mpf(float(value)) - truth
            turn = 2 * mpmath.pi
            actual.append(float(abs(apart - turn * mpmath.nint(apart / turn))))
    return float(motion.error), max(actual)


def slider_errors(point):
    """Return the estimate and the worse of the two actual errors, of a slider-crank."""
    lengths = [point.inputs[name] for name in ("crank", "coupler", "offset")]
    assembly = "open" if point.fixed["assembly"] > 0 else "crossed"
    motion = SliderCrank(*lengths, assembly).motion(point.inputs["theta2"])
    assert motion.passed
    with mpmath.workdps(80):
        truth = slider_motion({name: mpmath.mpf(v) for name, v in point.arguments.items()})
        turned = abs(mpmath.mpf(float(motion.theta3)) - truth["theta3"])
        moved = abs(mpmath.mpf(float(motion.position)) - truth["position"])
        return float(motion.error), float(max(turned, moved / max(map(abs, lengths))))


def rod_errors(point):
    """Return the estimate and the worse of the two actual errors, of a quick-return."""
    frame, crank = (point.inputs[name] for name in ("frame", "crank"))
    motion = QuickReturn(frame, crank, frame + crank).motion(point.inputs["theta2"])
    assert motion.passed
    with mpmath.workdps(80):
        numbers = {name: mpmath.mpf(v) for name, v in point.arguments.items()}
        found = mpmath.mpf(float(motion.theta4))
        truth = rod_motion(numbers, found)
        moved = abs(mpmath.mpf(float(motion.slide)) - truth["slide"]) / (frame + crank)
        return float(motion.error), float(max(abs(found - truth["theta4"]), moved))


def short_followers(count, seed):
    """Return linkages whose follower is short, at angles near their folds and far from them."""
    random = np.random.default_rng(seed)
    found = []
    while len(found) < count:
        lengths = [*random.uniform(0.1, 1.0, 3), 10.0 ** random.uniform(-4.0, -2.5)]
        # The follower closes what is left: the links are about as long as each other in pairs.
        lengths[2] = abs(lengths[0] + random.choice([-1.0, 1.0]) * lengths[1])
        lengths[2] += random.uniform(-0.9, 0.9) * lengths[3]
        assembly = random.choice(["open", "crossed"])
        try:
            low, high = FourBar(*map(float, lengths), assembly).crank_ranges()[0]
        except BadInput:
            continue
        theta = low + random.uniform(0.001, 0.999) * (high - low)
        inputs = {**dict(zip(LENGTHS, map(float, lengths), strict=True)), "theta2": float(theta)}
        sign = {"assembly": 1.0 if assembly == "open" else -1.0}
        found.append(Point("short follower", inputs, sign))
    return found


RANDOM = {
    "four-bar": (four_bar_errors, random_points, 31),
    "slider-crank": (slider_errors, random_sliders, 32),
    "quick-return": (rod_errors, random_rods, 33),
    "short follower": (four_bar_errors, short_followers, 3),
}
NASTY = {
    "four-bar": (four_bar_errors, nasty_points),
    "slider-crank": (slider_errors, nasty_sliders),
    "quick-return": (rod_errors, nasty_rods),
}


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", RANDOM)
def test_estimate_covers_the_error_and_is_not_idle(kind, count):
    errors, points, seed = RANDOM[kind]
    estimates, actual = zip(*map(errors, points(count, seed)), strict=True)
    covers(estimates, actual, count)


@pytest.mark.parametrize("kind", NASTY)
def test_estimate_covers_the_error_at_every_nasty_point(kind):
    errors, points = NASTY[kind]
    estimates, actual = zip(*map(errors, points()), strict=True)
    assert np.all(np.array(actual) <= estimates)
    covers(estimates, actual)


@pytest.mark.parametrize(
    ("lengths", "theta"),
    [
        (
            (0.741033130955611, 0.6482593665690473, 0.7160953146978349, 0.0017731521690162362),
            -1.0777686207770751,
        ),
        (
            (987635.9984780651, 690374.4558117427, 1675199.272225518, 2811.182003136147),
            -3.141459496765695,
        ),
    ],
)
def test_estimate_covers_the_round_off_of_the_diagonal(lengths, theta):
    """Without it the estimate was a ninth and a twentieth of the error."""
    inputs = {**dict(zip(LENGTHS, lengths, strict=True)), "theta2": theta}
    estimate, actual = four_bar_errors(Point("short follower", inputs, {"assembly": 1.0}))
    assert actual <= estimate
