"""Stresses from recovered forces, and how far mesh and motion may have them wrong."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, Problem
from ..core.families import LinearPeriodic
from .assembly import Array
from .beam_motion import BeamMotion, chunks
from .element_forms import ElementForms, required_structure
from .recovered import evaluated, propagated
from .recovery import METHODS, Station

Stations = int | Mapping[str, ArrayLike] | None
# Places over each element for its energy: exact for the recovered polynomials' squares.
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
# Angles at which the energy is looked at.
_ANGLES = 64


def fibre_factors(system: LinearPeriodic, stations: Sequence[Station]) -> tuple[Array, Array]:
    """Return 1/A [1/m^2] and c/I [1/m^3] of each station, c half the thickness.

    Raises
    ------
    BadInput
        If a section has no thickness.
    """
    structure = required_structure(system)
    sections = {beam.name: beam.section for beam in structure.beams}
    missing = [
        name
        for name in dict.fromkeys(station.beam for station in stations)
        if sections[name].thickness is None
    ]
    if missing:
        fix = "give Section.thickness, or use recover() for forces"
        problems = [
            Problem(f"section of {n}", "no thickness", "one, for stresses", fix) for n in missing
        ]
        raise BadInput(*problems)
    own = [sections[station.beam] for station in stations]
    levers = [0.5 * (section.thickness or 0.0) / section.second_moment for section in own]
    return np.array([1.0 / section.area for section in own]), np.array(levers)


def stresses(
    system: LinearPeriodic,
    motion: BeamMotion,
    stations: Stations,
    method: str,
    factors: tuple[Array, Array],
    *,
    frozen: bool = False,
) -> tuple[Array, Array]:
    """Return axial stress and bending stress at the positive fibre [Pa], ``(nt, stations)``."""
    names = ("axial", "moment")
    found = evaluated(system, motion, stations, method, names, frozen=frozen)
    return found["axial"] * factors[0], -found["moment"] * factors[1]


def largest_difference(first: tuple[Array, Array], second: tuple[Array, Array]) -> float:
    """Return the largest difference of the stresses of a fibre [Pa]."""
    axial, bending = (np.abs(a - b) for a, b in zip(first, second, strict=True))
    return float(np.max(axial + bending))


def motion_error(
    system: LinearPeriodic, motion: BeamMotion, stations: Stations, factors: tuple[Array, Array]
) -> float:
    """Return what the error of the motion can do to a stress [Pa]."""
    doubt = propagated(system, motion, stations)
    return float(np.max(factors[0]) * doubt[0] + np.max(factors[1]) * doubt[2])


def frozen(system: LinearPeriodic, motion: BeamMotion) -> BeamMotion:
    """Return the quasi-static motion: equilibrium at each angle without any rates."""
    found = np.empty_like(motion.q)
    for chunk in chunks(motion):
        forms = ElementForms(system, motion.theta[chunk])
        rows = forms.resisted.at_speed(motion.speed)
        free = forms.arrays.free
        load = rows.get("1", np.zeros((len(found[chunk]), forms.arrays.count)))
        solved = np.linalg.solve(rows["q"][:, free], -load[:, free, None])
        found[chunk] = solved[..., 0]
    return replace(motion, q=found, qd=np.zeros_like(found))


def energy_gap(system: LinearPeriodic, motion: BeamMotion) -> float:
    """Return the energy of the difference of both recoveries over that of the forces.

    Of a natural mode this is the relative error of its squared frequency on the mesh.
    """
    structure = required_structure(system)
    picked = np.unique(np.linspace(0, len(motion.theta) - 1, _ANGLES).astype(int))
    few = replace(
        motion, theta=motion.theta[picked], q=motion.q[picked], qd=motion.qd[picked], period=None
    )
    places: dict[str, list[Array]] = {beam.name: [] for beam in structure.beams}
    weights: dict[str, list[Array]] = {beam.name: [] for beam in structure.beams}
    for placed in structure.elements:
        along = placed.start + 0.5 * placed.length * (1.0 + _PLACES)
        places[placed.beam.name].append(along / placed.beam.length)
        weights[placed.beam.name].append(0.5 * placed.length * _WEIGHTS)
    stations = {name: np.concatenate(own) for name, own in places.items()}
    first, second = (evaluated(system, few, stations, m, ("axial", "moment")) for m in METHODS)
    scale = float(system.parameters.get("elasticity", 1.0))
    wrong = total = 0.0
    for name, key in (("axial", "axial_stiffness"), ("moment", "bending_stiffness")):
        flat = [
            weight / (scale * getattr(structure.beam(beam).section, key))
            for beam, own in weights.items()
            for weight in np.concatenate(own)
        ]
        wrong += float(np.sum((first[name] - second[name]) ** 2 @ np.array(flat)))
        total += float(np.sum(first[name] ** 2 @ np.array(flat)))
    return min(wrong / total, 0.5) if total else 0.0
