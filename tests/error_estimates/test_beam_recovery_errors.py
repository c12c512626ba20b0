"""Figures of forces, energies and curves of elastic links, over random rocking bars.

What counts as true is the same bar of more cubics, moved by dense Fourier collocation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from beam_motions import periodic_motion, rocking_bar
from elastolink.runtime.recovery import beam_energies, elastic_coupler_curve, recover
from elastolink.runtime.recovery.beam_motion import quiet_steady_state
from honesty import covers

SCENES, COUNT, FINE = 200, 32, 4
FORCES = ("axial", "shear", "moment")


def fine(system):
    """Return the same system on many cubics."""

    def meshed(structure):
        beams = (replace(b, kind="cubic", elements=FINE) for b in structure.beams)
        return replace(structure, beams=tuple(beams))

    return system.remesh(meshed)


def compared(rng):
    """Return actual errors and figures of forces, strain energy and curve of one bar."""
    system, speed = rocking_bar(rng, int(rng.integers(1, 3)))
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
    for actual, estimates in np.moveaxis(rows, 0, -1):
        covers(estimates, actual, SCENES)
