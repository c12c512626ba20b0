"""The figure of FourBar.motion against 80 digits, over random and nasty linkages."""

from __future__ import annotations

import mpmath
import numpy as np
from elastolink.runtime.mechanisms import FourBar
from linkage_truth import LENGTHS, angles, nasty_points, random_points


def ratios(points):
    """Return actual error over figure, of the worse angle, for each point."""
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


def test_figure_covers_the_error_and_is_not_idle():
    found = ratios(random_points(300, seed=31))
    assert np.mean(found <= 1.0) >= 0.99
    assert np.median(found) >= 1e-3


def test_figure_covers_the_error_at_every_nasty_point():
    found = ratios(nasty_points())
    assert found.max() <= 1.0
    assert np.median(found) >= 1e-3
