"""The beams of Aannaque's Table 4.1 as the gallery uses them: models, motions, frequencies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..beams import Structure
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..frequencies import dynamic_stiffness, wittrick_williams
from ..frequencies.held import held_frequencies
from ..recovery.stress_over_speed import StressCurve, stress_curve
from ..scenes import load_scene

SCENE = "aannaque_1996_table_4_1"
# The thesis' form (7.1), without stiffening; and the whole of the equations.
THESIS: tuple[str, ...] = ("as_printed",)
FULL: tuple[str, ...] = ()
FRAME = 0.547
# The distances of the pivots [m] of Figs. 8.19 to 8.23, and one more of chapter 7.
FRAMES = (0.547, 0.600, 0.632, 0.642, 0.652, 0.662)
CRITICAL = 62.0
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
    if deflection is None:
        raise bad("system", "no deflections", "a system of beams", "load a scene with a mesh")
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


def maxima(speed: Array, values: Array, prominence: float = 0.02) -> Array:
    """Return the speeds of local maxima that stand out of a curve by a part of their height.

    The place is that of the parabola through the logarithms of three values.
    """
    from scipy.signal import find_peaks

    level = np.log(values)
    return _tops_of_parabolas(speed, level, find_peaks(level, prominence=prominence)[0])


def tops(speed: Array, values: Array) -> Array:
    """Return the speeds of all local maxima of a smooth curve, each refined by a parabola."""
    at = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    return _tops_of_parabolas(speed, values, at)


def _tops_of_parabolas(speed: Array, values: Array, at: NDArray[np.intp]) -> Array:
    before, here, after = values[at - 1], values[at], values[at + 1]
    shift = 0.5 * (before - after) / (before - 2.0 * here + after)
    return np.asarray(speed[at] + shift * (speed[1] - speed[0]))


def nearest(places: Array, speed: float) -> float:
    """Return the place nearest to a speed."""
    return float(places[np.argmin(np.abs(places - speed))])


@dataclass(frozen=True)
class ModelComparison:
    """Natural frequencies of several models of a mechanism held at the same crank angles [rad].

    Frequencies [rad/s], rising, ``(models, nt, count)``; the size of a model is its number of
    coordinates, 0 of ``exact``, that of dynamic stiffness.
    """

    names: tuple[str, ...]
    size: NDArray[np.int64]
    theta: Array
    frequency: Array

    def difference(self, model: str, reference: str = "exact") -> Array:
        """Return a model's frequencies over those of another, less 1, ``(nt, count)``."""
        one, other = (self.frequency[self.names.index(name)] for name in (model, reference))
        return np.asarray(one / other - 1.0)


def compare_models(
    models: Mapping[str, LinearPeriodic], theta: Array, count: int = 4, *, exact: bool = True
) -> ModelComparison:
    """Return the frequencies of several models and, by the first one's structure, exact ones."""
    names, sizes = list(models), [system.size for system in models.values()]
    rows = [held_frequencies(system, theta, {})[0][:, :count] for system in models.values()]
    structure = next(iter(models.values())).structure
    if exact and structure is not None:
        names, sizes = [*names, "exact"], [*sizes, 0]
        rows.append(exact_frequencies(structure, theta, count))
    return ModelComparison(
        tuple(names), np.array(sizes, dtype=np.int64), np.asarray(theta), np.stack(rows)
    )


def exact_frequencies(structure: Structure, theta: Array, count: int) -> Array:
    """Return the lowest natural frequencies [rad/s] by dynamic stiffness, ``(nt, count)``."""
    problems = (dynamic_stiffness(structure, float(angle)) for angle in theta)
    return np.stack([wittrick_williams(one, count=count).frequencies[:count] for one in problems])
