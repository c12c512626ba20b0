"""The estimates of the motions of all linkages against 80 digits, random and nasty ones."""

from __future__ import annotations

import linkage_truth
import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from honesty import covers
from judging import Point
from linkage_truth import LENGTHS, nasty_points, random_points
from sliding_truth import (
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)


def four_bar(frame, crank, coupler, follower, assembly):
    return FourBar(frame, crank, coupler, follower, assembly), linkage_truth.motion


def slider_crank(crank, coupler, offset, assembly):
    return SliderCrank(crank, coupler, offset, assembly), slider_motion


def quick_return(frame, crank, assembly):
    return QuickReturn(frame, crank, frame + crank), rod_motion


def errors(made, point):
    """Return the estimate and the worse of two actual errors, of places over the size."""
    lengths = {k: v for k, v in point.inputs.items() if k != "theta2"}
    assembly = "open" if point.fixed.get("assembly", 1.0) > 0 else "crossed"
    linkage, truth = made(**lengths, assembly=assembly)
    motion = linkage.motion(point.inputs["theta2"])
    assert motion.passed
    size = max(abs(length) for length in linkage.lengths.values())
    gaps = []
    with mpmath.workdps(80):
        exact = truth({name: mpmath.mpf(value) for name, value in point.arguments.items()})
        turn = 2 * mpmath.pi
        for name in {"theta3", "theta4", "position", "slide"} & exact.keys():
            gap = mpmath.mpf(float(getattr(motion, name))) - exact[name]
            angle = name.startswith("theta")
            gaps.append(abs(gap - turn * mpmath.nint(gap / turn)) if angle else abs(gap) / size)
    return float(motion.error), float(max(gaps))


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
    "four-bar": (four_bar, random_points, 31),
    "slider-crank": (slider_crank, random_sliders, 32),
    "quick-return": (quick_return, random_rods, 33),
    "short follower": (four_bar, short_followers, 3),
}
NASTY = {
    "four-bar": (four_bar, nasty_points),
    "slider-crank": (slider_crank, nasty_sliders),
    "quick-return": (quick_return, nasty_rods),
}


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", RANDOM)
def test_estimate_covers_the_error_and_is_not_idle(kind, count):
    made, points, seed = RANDOM[kind]
    estimates, actual = zip(*(errors(made, p) for p in points(count, seed)), strict=True)
    covers(estimates, actual, count)


@pytest.mark.parametrize("kind", NASTY)
def test_estimate_covers_the_error_at_every_nasty_point(kind):
    made, points = NASTY[kind]
    estimates, actual = zip(*(errors(made, point) for point in points()), strict=True)
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
    estimate, actual = errors(four_bar, Point("short follower", inputs, {"assembly": 1.0}))
    assert actual <= estimate
