"""The estimate of FourBar.motion against 80 digits, over random and nasty linkages."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar
from judging import Point
from linkage_truth import LENGTHS, angles, nasty_points, random_points


def ratios(points):
    """Return actual error over estimate, of the worse angle, for each point."""
    found = []
    for point in points:
        lengths = [point.inputs[name] for name in LENGTHS]
        assembly = "open" if point.fixed["assembly"] > 0 else "crossed"
        motion = FourBar(*lengths, assembly).motion(point.inputs["theta2"])
        with mpmath.workdps(80):
            theta2, *exact = (mpmath.mpf(v) for v in (point.inputs["theta2"], *lengths))
            true = angles(theta2, *exact, mpmath.mpf(point.fixed["assembly"]))
            actual = []
            for value, truth in zip((motion.theta3, motion.theta4), true, strict=True):
                apart = mpmath.mpf(float(value)) - truth
                turn = 2 * mpmath.pi
                actual.append(float(abs(apart - turn * mpmath.nint(apart / turn))))
        found.append(max(actual) / float(motion.error))
    return np.array(found)


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
def test_estimate_covers_the_error_and_is_not_idle(count):
    found = ratios(random_points(count, seed=31))
    assert np.mean(found <= 1.0) >= 0.99
    assert np.median(found) >= 1e-3


def test_estimate_covers_the_error_at_every_nasty_point():
    found = ratios(nasty_points())
    assert found.max() <= 1.0
    assert np.median(found) >= 1e-3


def _short_followers(count):
    """Yield linkages whose follower is short, at angles near their folds and far from them."""
    random = np.random.default_rng(3)
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


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
def test_estimate_covers_the_error_with_a_short_follower(count):
    found = ratios(_short_followers(count))
    assert np.mean(found <= 1.0) >= 0.99
    assert np.median(found) >= 1e-3


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
    assert ratios([Point("short follower", inputs, {"assembly": 1.0})])[0] <= 1.0
