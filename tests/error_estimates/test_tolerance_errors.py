"""The error estimate of tolerances against exact extremes of many digits, over random four-bars."""

import itertools

import elastolink as el
import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.design import tolerance_bands
from elastolink.runtime.design.within_tolerances import answer_of
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.linkages.length_tolerances import tolerances
from elastolink.runtime.scenes import with_numbers
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


@over_scenes(47, few=6, many=60)
def test_how_much_too_wide_bands_are(rng):
    """Worst cases of scenes against all corners and 30 machines; the truth lies between."""
    name, answer = [
        ("smith_1972_12_6_12_12", "forces"),
        ("smith_1972_5152_sixteenth_inch", "forces"),
        ("beale_1992_flexible_rod", "frequencies"),
    ][rng.integers(3)]
    given = el.load_scene(name).given["links"]
    keys = {k: 10.0 ** rng.uniform(-3.0, 0.0) for k, v in given.items() if isinstance(v, float)}
    scene = el.load_scene(name, {f"links.{k}": f"{given[k]!r} +- {p} %" for k, p in keys.items()})
    theta = [float(rng.uniform(0.0, 2.0 * np.pi))]
    bands = tolerance_bands(scene, answer, theta, trials=1)
    names = list(scene.tolerances)
    corners = list(itertools.product((-1.0, 1.0), repeat=len(names)))
    points = np.concatenate([corners, rng.uniform(-1.0, 1.0, (30, len(names)))])
    asked = answer_of(scene, answer, theta, None)
    made = [scene.get(key) for key in names] + points * [scene.tolerances[key] for key in names]
    found = [
        np.asarray(asked.compute(with_numbers(scene, dict(zip(names, row, strict=True)))))[:, 0]
        for row in made.tolist()
    ]
    top, bottom = np.max(found, axis=0), np.min(found, axis=0)
    assert np.all(bands.lower[:, 0] <= bottom) and np.all(top <= bands.upper[:, 0])
    return bands.error[:, 0], np.maximum(bands.upper[:, 0] - top, bottom - bands.lower[:, 0])
