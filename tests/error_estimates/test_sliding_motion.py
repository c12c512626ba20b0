"""The estimates of SliderCrank.motion and QuickReturn.motion against 80 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.linkages import QuickReturn, SliderCrank
from sliding_truth import (
    nasty_rods,
    nasty_sliders,
    random_rods,
    random_sliders,
    rod_motion,
    slider_motion,
)


def slider_ratio(point):
    """Return the worse of the two actual errors over the figure."""
    lengths = [point.inputs[name] for name in ("crank", "coupler", "offset")]
    assembly = "open" if point.fixed["assembly"] > 0 else "crossed"
    motion = SliderCrank(*lengths, assembly).motion(point.inputs["theta2"])
    with mpmath.workdps(80):
        truth = slider_motion({name: mpmath.mpf(v) for name, v in point.arguments.items()})
        turned = abs(mpmath.mpf(float(motion.theta3)) - truth["theta3"])
        moved = abs(mpmath.mpf(float(motion.position)) - truth["position"])
        return float(max(turned, moved / max(map(abs, lengths))) / float(motion.error))


def rod_ratio(point):
    """Return the worse of the two actual errors over the figure."""
    frame, crank = (point.inputs[name] for name in ("frame", "crank"))
    motion = QuickReturn(frame, crank, frame + crank).motion(point.inputs["theta2"])
    with mpmath.workdps(80):
        numbers = {name: mpmath.mpf(v) for name, v in point.arguments.items()}
        found = mpmath.mpf(float(motion.theta4))
        truth = rod_motion(numbers, found)
        moved = abs(mpmath.mpf(float(motion.slide)) - truth["slide"]) / (frame + crank)
        return float(max(abs(found - truth["theta4"]), moved) / float(motion.error))


@pytest.mark.parametrize("count", [60, pytest.param(300, marks=pytest.mark.slow)])
def test_estimates_cover_the_error_and_are_not_idle(count):
    for ratio, points in (
        (slider_ratio, random_sliders(count, seed=32)),
        (rod_ratio, random_rods(count, seed=33)),
    ):
        found = np.array([ratio(point) for point in points])
        assert np.mean(found <= 1.0) >= 0.99
        assert np.median(found) >= 1e-3


def test_estimates_cover_the_error_at_every_nasty_point():
    for ratio, points in ((slider_ratio, nasty_sliders()), (rod_ratio, nasty_rods())):
        found = np.array([ratio(point) for point in points])
        assert found.max() <= 1.0
        assert np.median(found) >= 1e-3
