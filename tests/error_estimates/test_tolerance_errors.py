"""The error estimate of tolerances against exact extremes of many digits, over random four-bars."""

import itertools

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.linkages.length_tolerances import tolerances
from honesty import over_scenes
from linkage_truth import motion, random_linkage

_OUTPUTS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle")


def _extreme(lengths, widths, theta, assembly):
    """Return the greatest deviations over the corners of the box, by output."""
    numbers = {name: mpmath.mpf(size) for name, size in lengths.items()}
    numbers |= {"theta2": mpmath.mpf(theta), "assembly": mpmath.mpf(assembly)}
    here = motion(numbers)
    worst = dict.fromkeys(_OUTPUTS, mpmath.mpf(0))
    for signs in itertools.product((-1, 1), repeat=len(widths)):
        moved = dict(numbers)
        for (name, width), sign in zip(widths.items(), signs, strict=True):
            moved[name] += sign * mpmath.mpf(width)
        there = motion(moved, here)
        for name in _OUTPUTS:
            worst[name] = max(worst[name], abs(there[name] - here[name]))
    return worst


@over_scenes(41)
@pytest.mark.parametrize("kind", ["rocker", "drag"])
def test_worst_cases(rng, kind):
    shape = random_linkage(rng, kind)
    linkage = FourBar(**shape.lengths, assembly="open" if shape.assembly > 0 else "crossed")
    widths = {
        name: float(size * 10.0 ** rng.uniform(-7.0, -1.5))
        for name, size in linkage.lengths.items()
        if rng.uniform() < 0.7
    }
    theta = float(rng.uniform(-np.pi, np.pi))
    try:
        found = tolerances(linkage, widths, [theta])
    except BadInput:
        return None  # it could fold
    with mpmath.workdps(40):
        exact = _extreme(linkage.lengths, widths, theta, shape.assembly)
        gaps = [
            float(worst - exact[name])
            for worst, name in zip(found.worst_case[:, 0], found.outputs, strict=True)
        ]
    return found.error[:, 0], gaps


@over_scenes(43)
@pytest.mark.parametrize("distribution", ["normal", "uniform"])
def test_spreads_of_trials(rng, distribution):
    """Tolerances so narrow that the first order is all: its spread is the exact one."""
    shape = random_linkage(rng, "rocker")
    linkage = FourBar(**shape.lengths, assembly="open" if shape.assembly > 0 else "crossed")
    widths = {name: 1e-7 * size for name, size in linkage.lengths.items()}
    try:
        found = tolerances(linkage, widths, [float(rng.uniform(-np.pi, np.pi))])
    except BadInput:
        return None  # it could fold
    trial = found.monte_carlo(int(rng.integers(3, 60)), int(rng.integers(2**32)), distribution)
    off = np.abs(trial.standard_deviation - trial.expected)
    # All outputs are of one draw.
    return float(np.median(trial.error / np.maximum(off, 1e-300))), 1.0
