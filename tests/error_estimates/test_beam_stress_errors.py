"""Errors of stresses, forces, energies and curves of random linkages, against fine meshes.

What counts as true is the same model of beams with the same law of damping on many more elements;
of bars that rock it is computed by dense Fourier collocation, another solver of the motion too.
"""

from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from beam_motions import elastic_linkage, periodic_motion, rocking_bar
from elastolink.runtime.periodic.periodic_motion import quiet_state
from elastolink.runtime.recovery import BeamMotion, beam_energies, elastic_coupler_curve
from elastolink.runtime.recovery.beam_forces import Recovered, stations_of
from elastolink.runtime.recovery.finer_mesh import intervals_for, solved
from elastolink.runtime.recovery.stresses import fibre_factors, largest_difference, stresses
from honesty import over_scenes

# Stiffness and speed are drawn without regard to the linear range.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
COUNT, PLACES = 32, 7
# Cubics per link of the mesh that is taken for the limit: an h^4 of the mesh of one, two or three
# elements is less there by a factor of 39 at least, an h^2 by 6.
TRUE = {1: 4, 2: 5, 3: 8}


def fine(system, elements):
    """Return the same system on many cubics."""

    def meshed(structure):
        beams = (replace(b, kind="cubic", elements=TRUE[elements]) for b in structure.beams)
        return replace(structure, beams=tuple(beams))

    return system.remesh(meshed)


def pairs_of(rng, kind, elements):
    """Return estimates and actual errors of one linkage, or of a rocking bar, by name."""
    if kind is None:
        system, first = rocking_bar(rng, elements)
        speed = rng.uniform(0.03, 0.6) * first
    else:
        system, speed = elastic_linkage(rng, kind, elements)
    method = "equilibrium" if rng.integers(2) else "shape"
    steady, true = quiet_state(system, speed, 1e-7), fine(system, elements)
    found = el.stress(system, steady, stations=PLACES, method=method)
    pins = el.pin_reactions(system, steady)
    every = len(found.theta) // COUNT if kind is None else 1
    if kind is None:
        motion = periodic_motion(true, speed, COUNT)
    else:
        intervals = intervals_for(steady.q.reshape(-1, system.size))
        q, qd = solved(true, speed, intervals, len(found.theta))
        motion = BeamMotion(theta=found.theta, q=q, qd=qd, speed=speed, period=2 * np.pi)
    factors = fibre_factors(true, stations_of(true.structure, PLACES))
    exact = stresses(Recovered(true, motion, PLACES, "equilibrium"), factors)
    out = {
        "stress": (
            found.error,
            largest_difference((found.axial[::every], found.bending[::every]), exact),
        )
    }
    limit = el.pin_reactions(true, motion)
    longest = max(beam.length for beam in true.structure.beams)
    scale = np.array([1.0, 1.0, 1.0 / longest])
    gaps = [
        np.max(np.linalg.norm((limit.on_beams[pair] - force[::every]) * scale, axis=-1))
        for pair, force in pins.on_beams.items()
    ]
    out["pins"] = pins.error, max(gaps)
    if kind is None:
        out |= pairs_along(system, steady, true, motion, every)
    return out


def pairs_along(system, steady, true, motion, every):
    """Return estimates and actual errors of forces, strain energy and curve of one bar."""
    ours, exact = (
        el.recover(system, steady, stations=PLACES),
        el.recover(true, motion, stations=PLACES),
    )
    out = {
        name: (error, np.max(np.abs(getattr(ours, name)[::every] - getattr(exact, name))))
        for name, error in zip(("axial", "shear", "moment"), ours.error, strict=True)
    }
    energy, limit = beam_energies(system, steady), beam_energies(true, motion)
    out["energy"] = energy.error, np.max(np.abs(energy.strain[::every] - limit.strain))
    link = system.structure.beams[0].name
    curve = elastic_coupler_curve(system, steady, 0.8, link=link)
    limit = elastic_coupler_curve(true, motion, 0.8, link=link)
    out["curve"] = curve.error, np.max(np.hypot(*(curve.elastic[::every] - limit.elastic).T))
    return out


@over_scenes(1996, few=2, many=24, median=30.0)
def test_rocking_bars(rng):
    return pairs_of(rng, None, int(rng.integers(1, 4)))


# References of more elements take too long.
@over_scenes(1997, few=None, many=6, median=30.0)
def test_slider_cranks(rng):
    return pairs_of(rng, el.SliderCrank, int(rng.integers(1, 3)))


@over_scenes(1998, few=None, many=2, median=30.0)
def test_four_bars(rng):
    return pairs_of(rng, el.FourBar, 1)
