"""Errors of ends of unstable regions, by each way to them, against half traces of more digits.

Two of Hill's equations are hidden in wavy coordinates; each end that is a simple root of a half
trace is compared.  The half traces are Taylor series in extended precision.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.periodic.decoupled import slow_system
from elastolink.runtime.stability import resonances, stability_edges, tongue, tongue_curves
from hill_pairs import HillPair
from honesty import verdict

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
    ),
]
SPAN = (3.5, 9.5)
ENDS = 200


def compared(scene, mode, harmonic, found, error, factor=1.0):
    """Return figures over actual errors of ends that are simple roots."""
    exact, steep = scene.ends(mode, (-1) ** harmonic, found, factor)
    gaps = np.abs(exact - found).astype(float)
    return (error / np.maximum(gaps, 1e-18))[steep]


def of_regions(scene, found):
    ratios = [np.zeros(0)]
    for i, kind in enumerate(found.kind):
        ends = np.array([found.lower[i], found.upper[i]])
        if kind == "principal" and np.all(np.isfinite(ends)) and ends[1] > ends[0]:
            mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
            ratios.append(compared(scene, mode, harmonic, ends, found.error[i]))
    return np.concatenate(ratios)


@pytest.mark.parametrize("drag", [0.0, 0.01])
def test_ends_of_all_regions(drag):
    rng = np.random.default_rng(41)
    ratios, count = [], 0
    while count < ENDS:
        scene = HillPair(rng, drag)
        found = stability_edges(scene.system, SPAN)
        assert found.passed, found.checks
        ratios.append(of_regions(scene, found))
        count += len(ratios[-1])
    verdict(ratios, ENDS)


@pytest.mark.parametrize("drag", [0.0, 0.01])
def test_bands_of_slow_modes(drag):
    rng = np.random.default_rng(42)
    ratios, count = [], 0
    while count < ENDS:
        scene = HillPair(rng, drag, stiff=True)
        slow = slow_system(scene.system, (SPAN[0] / 1.05, SPAN[1] * 1.05), 2)
        found = stability_edges(slow, SPAN)
        assert found.passed, found.checks
        ratios.append(of_regions(scene, found))
        count += len(ratios[-1])
    verdict(ratios, ENDS)


def test_curves_from_their_feet():
    rng = np.random.default_rng(44)
    ratios, count = [], 0
    factors = np.linspace(0.1, 1.0, 7)
    while count < ENDS:
        scene = HillPair(rng, wavy=False)
        found = tongue_curves(scene.system, "pull", factors, SPAN, highest=2)
        for i, label in enumerate(found.labels):
            if not label.startswith("2"):
                continue
            mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
            for j, factor in enumerate(factors):
                ends = np.array([found.lower[i, j], found.upper[i, j]])
                if np.all(np.isfinite(ends)) and ends[1] > ends[0]:
                    error = found.error[i, j]
                    ratios.append(compared(scene, mode, harmonic, ends, error, factor))
                    count += len(ratios[-1])
    verdict(ratios, ENDS)


@pytest.mark.parametrize("drag", [0.0, 0.01])
def test_series_of_tongues(drag):
    """Here the figure is the truncation: it has to cover the next orders, not round-off."""
    rng = np.random.default_rng(45)
    ratios, count = [], 0
    factors = np.geomspace(0.05, 0.5, 5)
    while count < ENDS:
        scene = HillPair(rng, drag, wavy=False)
        order = int(rng.integers(2, 6))
        for one in resonances(scene.system, SPAN, kinds=("principal",), highest=2):
            found = tongue(scene.system, one, parameter=("pull", factors), order=order)
            for j, factor in enumerate(factors):
                ends = np.array([found.lower[j], found.upper[j]])
                # One Newton step of the reference leaves the square of the distance.
                if found.open[j] and found.error[j] < 1e-4 * ends[0]:
                    mode, harmonic = one.modes[0] - 1, one.harmonic
                    ratios.append(compared(scene, mode, harmonic, ends, found.error[j], factor))
                    count += len(ratios[-1])
    verdict(ratios, ENDS)
