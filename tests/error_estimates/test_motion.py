"""The estimates of the motions of all linkages against 80 digits, random and nasty ones."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from honesty import covers
from judging import Point
from linkage_truth import LENGTHS, nasty_points, random_points
from linkage_truth import motion as four_bar_motion
from sliding_truth import (
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)

TRUTHS = {FourBar: four_bar_motion, SliderCrank: slider_motion, QuickReturn: rod_motion}


def errors_of(kind, point):
    """Return the estimate and the worse of the two actual errors of the places."""
    lengths = {name: value for name, value in point.inputs.items() if name != "theta2"}
    if kind is QuickReturn:
        lengths["rod"] = lengths["frame"] + lengths["crank"]
    else:
        lengths["assembly"] = "open" if point.fixed["assembly"] > 0 else "crossed"
    motion = kind(**lengths).motion(point.inputs["theta2"])
    sizes = {
        "position": max(map(abs, motion.linkage.lengths.values())),
        "slide": lengths.get("rod"),
    }
    actual = []
    with mpmath.workdps(80):
        truth = TRUTHS[kind]({name: mpmath.mpf(v) for name, v in point.arguments.items()})
        for name in set(truth) & {"theta3", "theta4", *sizes}:
            apart, turn = mpmath.mpf(float(getattr(motion, name))) - truth[name], 2 * mpmath.pi
            if name in sizes:
                actual.append(float(abs(apart / sizes[name])))
            else:
                actual.append(float(abs(apart - turn * mpmath.nint(apart / turn))))
    return float(motion.error), max(actual)


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
    "four-bar": (FourBar, random_points, 31),
    "slider-crank": (SliderCrank, random_sliders, 32),
    "quick-return": (QuickReturn, random_rods, 33),
    "short follower": (FourBar, short_followers, 3),
}
NASTY = {
    "four-bar": (FourBar, nasty_points),
    "slider-crank": (SliderCrank, nasty_sliders),
    "quick-return": (QuickReturn, nasty_rods),
}


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", RANDOM)
def test_estimate_covers_the_error_and_is_not_idle(kind, count):
    linkage, points, seed = RANDOM[kind]
    estimates, actual = zip(*(errors_of(linkage, p) for p in points(count, seed)), strict=True)
    covers(estimates, actual, count)


@pytest.mark.parametrize("kind", NASTY)
def test_estimate_covers_the_error_at_every_nasty_point(kind):
    linkage, points = NASTY[kind]
    estimates, actual = zip(*(errors_of(linkage, p) for p in points()), strict=True)
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
    estimate, actual = errors_of(FourBar, Point("short follower", inputs, {"assembly": 1.0}))
    assert actual <= estimate
