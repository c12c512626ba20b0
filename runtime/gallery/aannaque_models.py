"""The beams of Aannaque's Table 4.1: models, frequencies, the "exact" model of section 7.4.1."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.signal import find_peaks

from ..beams import Structure
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, Term
from ..core.trigonometric import even_angles, interpolated
from ..frequencies import dynamic_stiffness, wittrick_williams
from ..frequencies.held import held_frequencies
from ..recovery.stress_over_speed import StressCurve, stress_curve
from ..scenes import load_scene
from ..systems import with_modal_damping

SCENE = "aannaque_1996_table_4_1"
# The thesis' form (7.1), without stiffening; and the whole of the equations.
THESIS: tuple[str, ...] = ("as_printed",)
FULL: tuple[str, ...] = ()
FRAME = 0.547
# The distances of the pivots [m] of Figs. 8.19 to 8.23, and one more of chapter 7.
FRAMES = (0.547, 0.600, 0.632, 0.642, 0.652, 0.662)
CRITICAL = 62.0
# Angles of a turn at which the matrices of the "exact" model are formed.
_ANGLES = 128
LINKS = ("crank", "coupler", "follower")


@lru_cache(maxsize=24)
def beams(
    elements: int = 3,
    drop: tuple[str, ...] = THESIS,
    *,
    kind: str = "cubic_beams",
    ratio: float = 0.02,
    frame: float = FRAME,
) -> LinearPeriodic:
    """Return the mechanism of Table 4.1 with modal damping.

    So many elements for each link; the form :data:`THESIS` or :data:`FULL`; the scene's
    formulation, which names the elements; the damping ratio of every mode; L4 [m].
    """
    overrides = {
        "mesh.elements": elements,
        "model.drop": list(drop),
        "model.formulation": kind,
        "damping.ratio": ratio,
        "links.frame": f"{frame} m",
    }
    return load_scene(SCENE, overrides=overrides).linear_system()


def structure_of(system: LinearPeriodic) -> Structure:
    """Return the beams of a system, which is refused where it has none."""
    if system.structure is None:
        raise bad("system", "no beams", "a system of beams", "load a scene with a mesh")
    return system.structure


def stresses(system: LinearPeriodic, speeds: Array, rtol: float = 1e-3) -> StressCurve:
    """Return the largest stresses over the speed, by the shapes as in the thesis."""
    return stress_curve(system, speeds, rtol=rtol, method="shape")


def midpoint(system: LinearPeriodic, link: str, theta: Array) -> Array:
    """Return what turns coordinates into the displacement across a link's midpoint [m], (nt, n)."""
    placed, deflection = structure_of(system).elements, system.relative_deflection
    assert deflection is not None, "beams have deflections"
    at = [i for i, item in enumerate(placed) if item.beam.name == link]
    count = len(at)
    # Two places to each element: its middle and its end.
    row = 2 * at[count // 2] if count % 2 else 2 * at[count // 2 - 1] + 1
    return np.asarray(deflection(theta)[:, row] * placed[at[0]].beam.length)


def moved(system: LinearPeriodic, link: str, theta: Array, q: Array) -> Array:
    """Return the displacement across a link's midpoint [m], shape ``(..., nt)``."""
    return np.asarray(np.einsum("tn,...tn->...t", midpoint(system, link, theta), q))


def rms(values: Array) -> Array:
    """Return the root of the mean square along the last axis."""
    return np.asarray(np.sqrt(np.mean(np.square(values), axis=-1)))


def tops(speed: Array, values: Array, prominence: float | None = None) -> Array:
    """Return the speeds of local maxima that stand out of a curve, each refined by a parabola."""
    at = find_peaks(values, prominence=prominence)[0]
    before, here, after = values[at - 1], values[at], values[at + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * here + after)
    return np.asarray(speed[at] + shift * (speed[1] - speed[0]))


def maxima(speed: Array, values: Array, prominence: float = 0.02) -> Array:
    """Return the speeds of local maxima that stand out of a curve by a part of their height."""
    return tops(speed, np.log(values), prominence)


def nearest(places: Array, speed: float) -> float:
    """Return the place nearest to a speed."""
    return float(places[np.argmin(np.abs(places - speed))])


def held(system: LinearPeriodic, theta: Array, count: int = 4) -> Array:
    """Return the lowest natural frequencies [rad/s] with the crank held, ``(nt, count)``."""
    return np.asarray(held_frequencies(system, theta, {})[0][:, :count])


def exact_frequencies(structure: Structure, theta: Array, count: int) -> Array:
    """Return the lowest natural frequencies [rad/s] by dynamic stiffness, ``(nt, count)``."""
    problems = (dynamic_stiffness(structure, float(angle)) for angle in theta)
    return np.stack([wittrick_williams(one, count=count).frequencies[:count] for one in problems])


class HybridMatrices(NamedTuple):
    """Mass and stiffness of one element for each link at crank angles [rad], at their first mode.

    M and K ``(nt, n, n)`` as in (5.16) and (5.17), that frequency [rad/s], how often the matrices
    were formed anew, and the names of the coordinates.
    """

    mass: Array
    stiffness: Array
    first: Array
    iterations: NDArray[np.int64]
    labels: tuple[str, ...]


def hybrid_matrices(structure: Structure, theta: Array, rtol: float = 1e-3) -> HybridMatrices:
    """Return the matrices of the thesis' "exact" model at crank angles.

    At each angle the first frequency of the cubic elements gives M(omega) and K(omega), these a
    better frequency, and so on until it changes by less than ``rtol``.  That is Newton's method on
    the exact eigenproblem, so that few steps suffice; it needs a cubic element that is not far off.
    """
    rows = []
    for angle in theta:
        problem = dynamic_stiffness(structure, float(angle))
        omega, formed, steps = 0.0, -1.0, -1
        while steps < 1 or abs(omega - formed) > rtol * omega:
            formed, steps = omega, steps + 1
            mass = problem.mass(formed)
            stiffness = problem.stiffness(formed) + formed**2 * mass
            square = eigh(stiffness, mass, eigvals_only=True, subset_by_index=(0, 0))[0]
            omega = float(np.sqrt(square))
        rows.append((mass, stiffness, omega, steps))
    mass, stiffness, first, iterations = (np.array(part) for part in zip(*rows, strict=True))
    return HybridMatrices(mass, stiffness, first, iterations, problem.labels)


@lru_cache(maxsize=2)
def hybrid(rtol: float) -> HybridMatrices:
    """Return the matrices of the beams of Table 4.1 at even crank angles."""
    return hybrid_matrices(structure_of(beams(1)), even_angles(2.0 * np.pi, _ANGLES), rtol)


@lru_cache(maxsize=1)
def hybrid_model() -> LinearPeriodic:
    """Return the thesis' "exact" model: one element for each link, M and K at the first frequency.

    Damping 2 %, the form of the thesis; the inertia of the rigid motion by the same masses.
    """
    base, exact, theta = beams(1), hybrid(1e-10), even_angles(2.0 * np.pi, _ANGLES)
    order = [exact.labels.index(label) for label in base.labels]
    places = np.ix_(range(_ANGLES), order, order)
    push = exact.mass[places] @ np.linalg.solve(
        base.array("M", theta), base.array("f", theta)[..., None]
    )
    mass, stiffness, force = (
        interpolated(values, 2.0 * np.pi)
        for values in (exact.mass[places], exact.stiffness[places], push[..., 0])
    )
    terms = (
        Term("M", None, mass),
        # The family's own M' is taken out, as of any instantaneous form.
        Term("C", None, lambda angles: -mass.derivative(angles), power=1),
        Term("K", None, stiffness),
        Term("f", None, force),
    )
    kept = {name: getattr(base, name) for name in ("labels", "relative_deflection", "structure")}
    return with_modal_damping(LinearPeriodic(base.size, terms, {}, lambda _: {}, **kept), 0.02)
