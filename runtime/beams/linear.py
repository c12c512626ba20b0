"""The vibration of a structure of beams as a linear periodic system (Aannaque 4.31, 6.15, 7.1)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, Problem, bad
from ..core.families import LinearPeriodic, Term
from ._checks import are_finite
from .assembly import AngleArrays, Array
from .axial_forces import AxialForces
from .deflections import relative_deflection
from .freedoms import Freedoms
from .held import require_held
from .sliding import Slide, slid_terms
from .structure import Structure

FORMS = ("full", "instantaneous")
# Factors of the structure's own numbers: of every modulus, density and lumped mass.
FACTORS = ("elasticity", "distributed_mass", "lumped_mass")


def linear_system(
    structure: Structure,
    *,
    form: str = "full",
    geometric_stiffness: bool = True,
    rayleigh: tuple[float, float] = (0.0, 0.0),
    gravity: tuple[float, float] = (0.0, 0.0),
) -> LinearPeriodic:
    """Return the vibration of a structure about its rigid-body motion.

    Coordinates are the elastic displacements of the nodes along the fixed axes [m] and the
    rotations [rad], see ``structure.labels``.

    Parameters
    ----------
    structure : Structure
        A linkage or a frame, for example from :func:`beam_linkage`.
    form : str
        ``"full"``: all terms of the Lagrangian (4.27).  ``"instantaneous"``: Coriolis,
        centripetal and Euler terms of the elastic motion left out, as in (7.1); it is not
        conservative.
    geometric_stiffness : bool
        Whether axial forces stiffen the beams (4.38): those of the rigid-body motion, and of
        weight and constant loads.
    rayleigh : pair of float
        a [1/s] and b [s] of ``C = a M + b K``.
    gravity : pair of float
        Acceleration of gravity [m/s^2] along the fixed axes.

    Returns
    -------
    LinearPeriodic
        With the factors ``elasticity``, ``distributed_mass`` and ``lumped_mass`` (1) as
        parameters, ``rayleigh_mass`` and ``rayleigh_stiffness`` (a, b) where given, ``retardation``
        (factor, 1) where a material is viscous.  Add modal damping with ``with_modal_damping``.
        With a sliding pin it keeps no structure: stresses cannot be asked for.

    Raises
    ------
    BadInput
        If an argument is unusable, or a motion of the structure meets no stiffness.
    """
    _check(structure, form, rayleigh, gravity)
    arrays = AngleArrays(structure)
    lumped, springs, dampers = lumped_values(structure)
    free = arrays.free
    slide = Slide(arrays) if structure.sliding else None
    require_held(arrays, springs[free], slide)
    axial = AxialForces(arrays, np.diag(springs[free]), lumped, gravity, slide)
    acting = _sources(structure, lumped, gravity)
    terms = [
        Term("M", "distributed_mass", arrays.mass),
        Term("K", "elasticity", arrays.stiffness),
        Term("f", "distributed_mass", arrays.inertia_force),
        Term("g", "distributed_mass", partial(arrays.inertia_force, derivative=1)),
    ]
    terms += _form_terms(arrays, form)
    terms += _constant_terms(np.diag(lumped[free]), np.diag(springs[free]), np.diag(dampers[free]))
    terms += _damping_terms(arrays, rayleigh, np.diag(lumped[free]), np.diag(springs[free]))
    terms += _loading_terms(axial, acting, geometric_stiffness)
    if slide is not None:
        terms = slid_terms(terms, slide, form=form)
    if not structure.moving:
        terms = [_frozen(term) for term in terms if term.array not in ("A", "B", "f", "g", "D")]
    parameters = dict.fromkeys(FACTORS, 1.0)
    if any(rayleigh):
        parameters |= {"rayleigh_mass": rayleigh[0], "rayleigh_stiffness": rayleigh[1]}
    if any(beam.section.retardation for beam in structure.beams):
        parameters["retardation"] = 1.0
    options = {"form": form, "geometric_stiffness": str(geometric_stiffness).lower()}
    told = {
        "form": form,
        "geometric_stiffness": geometric_stiffness,
        "rayleigh": rayleigh,
        "gravity": gravity,
    }
    return LinearPeriodic(
        size=structure.size,
        terms=tuple(terms),
        parameters=parameters,
        scales=_scales,
        period=structure.period,
        labels=structure.labels,
        provenance={**structure.provenance, **options},
        limits={name: "non-negative" for name in parameters} | dict.fromkeys(FACTORS, "positive"),
        relative_deflection=partial(_relative_deflection, arrays, slide),
        structure=structure if slide is None else None,
        remesh=partial(_remeshed, structure, told),
    )


def _remeshed(
    structure: Structure,
    options: Mapping[str, Any],
    change: Callable[[Structure], Structure],
) -> LinearPeriodic:
    """Return the system of a changed structure, made with the same options."""
    return linear_system(change(structure), **options)


def _scales(values: Mapping[str, ArrayLike]) -> Mapping[str, Array]:
    """Return the factors and the products of them that the terms name."""
    found = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    one = np.ones(())
    a, b = found.get("rayleigh_mass", one), found.get("rayleigh_stiffness", one)
    tau = found.get("retardation", one)
    return {
        **found,
        "rayleigh distributed": a * found["distributed_mass"],
        "rayleigh lumped": a * found["lumped_mass"],
        "rayleigh elastic": b * found["elasticity"],
        "rayleigh springs": b,
        "viscous": tau * found["elasticity"],
    }


def _check(
    structure: Structure, form: str, rayleigh: tuple[float, float], gravity: tuple[float, float]
) -> None:
    problems = []
    if not isinstance(structure, Structure):
        found, fix = type(structure).__name__, "make one with beam_linkage or frame"
        problems.append(Problem("structure", found, "a Structure", fix))
    if form not in FORMS:
        problems.append(Problem("form", repr(form), f"one of {FORMS}", "choose 'full'"))
    if not (are_finite(rayleigh, 2) and min(rayleigh) >= 0):
        found, fix = repr(rayleigh), "negative damping drives the motion"
        problems.append(Problem("rayleigh", found, "two numbers, 0 or more", fix))
    if not are_finite(gravity, 2):
        problems.append(Problem("gravity", repr(gravity), "two finite numbers", "correct them"))
    if problems:
        raise BadInput(*problems)


def lumped_values(
    structure: Structure, freedoms: Freedoms | None = None
) -> tuple[Array, Array, Array]:
    """Return lumped mass, springs and dampers of all coordinates, held ones included.

    Parameters
    ----------
    structure : Structure
        The nodes.
    freedoms : Freedoms, optional
        Another numbering of the coordinates than the structure's own.
    """
    freedoms = structure.freedoms if freedoms is None else freedoms
    mass, springs, dampers = (np.zeros(len(freedoms.all)) for _ in range(3))
    for node in structure.nodes:
        meeting = [b.name for b in structure.beams if node.name in (b.start, b.end)]
        turning = node.carried_by or (node.joined or tuple(meeting))[0]
        needs = node.inertia or node.stiffness.get("rotation") or node.damping.get("rotation")
        if needs and not (node.carried_by or node.joined or len(meeting) == 1):
            raise bad(
                f"node {node.name}",
                "an inertia, spring or damper on the rotation where several beams are pinned",
                "the beam that it turns with",
                f"set carried_by to one of {', '.join(meeting)}",
            )
        for part in ("x", "y"):
            place = freedoms.at(node.name, part)
            mass[place] += node.mass
            springs[place] += node.stiffness.get(part, 0.0)
            dampers[place] += node.damping.get(part, 0.0)
        place = freedoms.at(node.name, turning)
        mass[place] += node.inertia
        springs[place] += node.stiffness.get("rotation", 0.0)
        dampers[place] += node.damping.get("rotation", 0.0)
    return mass, springs, dampers


def _relative_deflection(arrays: AngleArrays, slide: Slide | None, theta: Array) -> Array:
    found = relative_deflection(arrays, theta)
    return found if slide is None else np.asarray(found @ slide.basis(theta))


def _sources(structure: Structure, lumped: Array, gravity: tuple[float, float]) -> list[str]:
    """Return what loads the beams: their own mass, lumped masses, constant loads."""
    found = ["distributed"] if structure.moving else []
    if structure.moving and np.any(lumped):
        found.append("lumped")
    if any(gravity) or any(any(node.force) for node in structure.nodes):
        found.append("static")
    return found


def _form_terms(arrays: AngleArrays, form: str) -> list[Term]:
    if form == "full":
        return [
            Term("A", "distributed_mass", arrays.coupling),
            Term("B", "distributed_mass", arrays.centripetal),
        ]
    # The family's equation holds M' qd, which this form lacks: the damping takes it out again.
    return [Term("C", "distributed_mass", partial(_minus_mass_slope, arrays), power=1)]


def _minus_mass_slope(arrays: AngleArrays, theta: Array) -> Array:
    return -arrays.mass_slope(theta)


def _constant_terms(mass: Array, springs: Array, dampers: Array) -> list[Term]:
    found = [("M", "lumped_mass", mass), ("K", None, springs), ("C", None, dampers)]
    return [Term(array, scale, value) for array, scale, value in found if np.any(value)]


def _damping_terms(
    arrays: AngleArrays, rayleigh: tuple[float, float], mass: Array, springs: Array
) -> list[Term]:
    found: list[Term] = []
    if rayleigh[0] or rayleigh[1]:
        found += [
            Term("C", "rayleigh distributed", arrays.mass),
            Term("C", "rayleigh lumped", mass),
            Term("C", "rayleigh elastic", arrays.stiffness),
            Term("C", "rayleigh springs", springs),
        ]
    if any(beam.section.retardation for beam in arrays.structure.beams):
        found += [
            Term("C", "viscous", arrays.retarded),
            Term("D", "viscous", arrays.retarded_turning),
        ]
    return found


def _loading_terms(axial: AxialForces, acting: list[str], stiffening: bool) -> list[Term]:
    """Return forces of lumped masses and constant loads, and geometric stiffness of all."""
    found = []
    scales = {"distributed": "distributed_mass", "lumped": "lumped_mass", "static": None}
    if "lumped" in acting:
        found.append(Term("f", "lumped_mass", partial(axial.force, "lumped")))
        found.append(Term("g", "lumped_mass", partial(_lumped_impulse, axial)))
    if "static" in acting:
        found.append(Term("p", None, partial(axial.force, "static")))
    if stiffening:
        found += [
            Term("Kg", scales[s], partial(axial.geometric, s), power=0 if s == "static" else 2)
            for s in acting
        ]
    return found


def _lumped_impulse(axial: AxialForces, theta: Array) -> Array:
    arrays = axial.arrays
    return np.asarray(-(arrays.motion(theta).first * axial.lumped)[:, arrays.free])


def _frozen(term: Term) -> Term:
    """Return the term of a structure that does not move as a constant one."""
    return Term(term.array, term.scale, term(np.zeros(1))[0], term.power)
