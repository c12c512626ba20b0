"""Figures of forces, energies and curves of elastic links, over random rocking bars.

What counts as true is the same bar of more cubics, moved by dense Fourier collocation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from beam_motions import periodic_motion, turning_bar
from elastolink.runtime.recovery import beam_energies, elastic_coupler_curve, recover
from elastolink.runtime.recovery.beam_motion import quiet_steady_state

SCENES, COUNT, FINE = 200, 32, 4
FIRST = {False: 3.516, True: 9.870}  # (lambda L)^2 of a clamped and of a pinned bar
FORCES = ("axial", "shear", "moment")


def rocking_bar(rng):
    """Return a random rocking bar of one or two elements, and its speed."""
    size, second = rng.uniform(0.05, 0.5), rng.uniform(-0.2, 0.2)

    def angle(theta):
        phi = size * np.sin(theta) + second * np.cos(2 * theta)
        rate = size * np.cos(theta) - 2 * second * np.sin(2 * theta)
        return phi, rate, -size * np.sin(theta) - 4 * second * np.cos(2 * theta)

    pinned = bool(rng.integers(2))
    # Of the bar of 1 m, 10 mm thick: sqrt(EI/m) = 14.93 m^2/s.
    first = FIRST[pinned] * 14.93
    drag, elements = rng.uniform(0.01, 0.1) * first, int(rng.integers(1, 3))
    system = turning_bar(angle, pinned=pinned, drag=drag, elements=elements)
    return system, rng.uniform(0.03, 0.6) * first


def fine(system):
    """Return the same system on many cubics."""

    def meshed(structure):
        beams = (replace(b, kind="cubic", elements=FINE) for b in structure.beams)
        return replace(structure, beams=tuple(beams))

    return system.remesh(meshed)


def compared(rng):
    """Return actual errors and figures of forces, strain energy and curve of one bar."""
    system, speed = rocking_bar(rng)
    steady, true = quiet_steady_state(system, speed), fine(system)
    motion = periodic_motion(true, speed, COUNT)
    link = system.structure.beams[0].name
    ours = recover(system, steady, stations=7)
    exact = recover(true, motion, stations=7, finer_mesh=False)
    every = len(ours.theta) // COUNT
    rows = [
        (np.max(np.abs(getattr(ours, name)[::every] - getattr(exact, name))), figure)
        for name, figure in zip(FORCES, ours.error, strict=True)
    ]
    energy = beam_energies(system, steady)
    limit = beam_energies(true, motion, finer_mesh=False)
    rows.append((np.max(np.abs(energy.strain[::every] - limit.strain)), energy.error))
    curve = elastic_coupler_curve(system, steady, 0.8, link=link)
    limit = elastic_coupler_curve(true, motion, 0.8, link=link, finer_mesh=False)
    gap = np.hypot(*(curve.elastic[::every] - limit.elastic).T)
    rows.append((np.max(gap), curve.error))
    return rows


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_actual_errors_stay_within_their_figures():
    rng = np.random.default_rng(1997)
    rows = np.array([compared(rng) for _ in range(SCENES)])
    for actual, figure in np.moveaxis(rows, 0, -1):
        assert np.mean(actual <= figure) >= 0.99
        assert np.median(figure / np.maximum(actual, 1e-300)) <= 1e3
