"""Errors of ends of unstable regions, by each way to them, against half traces of more digits.

Two of Hill's equations are hidden in wavy coordinates; each end that is a simple root of a half
trace is compared.  The half traces are Taylor series in extended precision.
"""

import numpy as np
import pytest
from elastolink.runtime.stability import resonances, stability_edges, tongue, tongue_curves
from hill_pairs import HillPair
from honesty import extended, over_scenes

pytestmark = [pytest.mark.slow, extended]
SPAN = (3.5, 9.5)
ENDS = 60


def compared(scene, mode, harmonic, found, error, factor=1.0):
    """Return estimates and actual errors of ends that are simple roots."""
    exact, steep = scene.ends(mode, (-1) ** harmonic, found, factor)
    return np.broadcast_to(error, steep.shape)[steep], (exact - found)[steep]


def joined(pairs):
    """Return pairs of estimates and errors in one; None where there are none."""
    both = [np.concatenate([part for part in parts]) for parts in zip(*pairs, strict=True)]
    return both if both and both[0].size else None


def of_regions(scene, found):
    assert found.passed, found.checks
    pairs = []
    for i, kind in enumerate(found.kind):
        ends = np.array([found.lower[i], found.upper[i]])
        if kind == "principal" and np.all(np.isfinite(ends)) and ends[1] > ends[0]:
            mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
            pairs.append(compared(scene, mode, harmonic, ends, found.error[i]))
    return joined(pairs)


damped = pytest.mark.parametrize("drag", [0.0, 0.01])


@over_scenes(41, few=None, many=ENDS, floor=1e-18)
@damped
def test_ends_of_all_regions(rng, drag):
    scene = HillPair(rng, drag)
    return of_regions(scene, stability_edges(scene.system, SPAN))


@over_scenes(42, few=None, many=ENDS, floor=1e-18)
def test_bands_of_a_truncated_system(rng):
    scene = HillPair(rng, drag=float(rng.choice([0.0, 0.01])), stiff=True)
    return of_regions(scene, stability_edges(scene.system, SPAN, modes=2))


@over_scenes(44, few=None, many=ENDS // 5, floor=1e-18)
def test_curves_from_their_feet(rng):
    scene, factors, pairs = HillPair(rng, wavy=False), np.linspace(0.1, 1.0, 7), []
    found = tongue_curves(scene.system, "pull", factors, SPAN, highest=2)
    for i, label in enumerate(found.labels):
        if not label.startswith("2"):
            continue
        mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
        for j, factor in enumerate(factors):
            ends = np.array([found.lower[i, j], found.upper[i, j]])
            if np.all(np.isfinite(ends)) and ends[1] > ends[0]:
                pairs.append(compared(scene, mode, harmonic, ends, found.error[i, j], factor))
    return joined(pairs)


@over_scenes(45, few=None, many=ENDS // 5, floor=1e-18)
@damped
def test_series_of_tongues(rng, drag):
    """Here the estimate is the truncation: it has to cover the next orders, not round-off."""
    scene, factors, pairs = HillPair(rng, drag, wavy=False), np.geomspace(0.05, 0.5, 5), []
    order = int(rng.integers(2, 6))
    for one in resonances(scene.system, SPAN, kinds=("principal",), highest=2):
        found = tongue(scene.system, one, parameter=("pull", factors), order=order)
        for j, factor in enumerate(factors):
            ends = np.array([found.lower[j], found.upper[j]])
            # One Newton step of the reference leaves the square of the distance.
            if found.open[j] and found.error[j] < 1e-4 * ends[0]:
                mode, harmonic = one.modes[0] - 1, one.harmonic
                pairs.append(compared(scene, mode, harmonic, ends, found.error[j], factor))
    return joined(pairs)
