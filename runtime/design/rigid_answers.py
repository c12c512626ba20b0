"""Derivatives of the motion and the forces of a rigid machine by the numbers of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np

from ..core.errors import bad
from ..core.families import Array
from ..linkages.linkage import Motion
from ..rigid.forces import RigidForces, rigid_forces
from ..scenes import Scene, with_numbers
from .coefficient_changes import checked_names, differences

RigidAnswer: TypeAlias = Motion | RigidForces
# Units of the last place that a value may be off by, of the largest of its row.
_ROUNDING = 8.0 * np.finfo(float).eps


def rigid_slopes(
    scene: object, answer: RigidAnswer, by: Sequence[str]
) -> tuple[tuple[str, ...], Array, Array, Array]:
    """Return the names of the rows, their values ``(rows, ...)``, derivatives and errors.

    Derivatives have the numbers on a last axis.
    """
    if not isinstance(scene, Scene):
        fix = "give the scene that the motion or the forces are of"
        raise bad("machine", type(scene).__name__, "a Scene", fix)
    names = checked_names(scene, (), by)
    own = answer.values if isinstance(answer, RigidForces) else vars(answer)
    rows = tuple(own) if isinstance(answer, RigidForces) else (*answer.places, *answer.rates)
    shape = np.broadcast_shapes(*(np.shape(own[row]) for row in rows))
    found = _rows_of(scene, answer)
    same = set(rows) <= set(found)

    def stacked(values: Mapping[str, Array]) -> Array:
        return np.array([np.broadcast_to(values[row], shape) for row in rows])

    value = stacked(found) if same else np.zeros(0)
    top = np.max(np.abs(value), axis=tuple(range(1, value.ndim)), keepdims=True, initial=0.0)
    if not same or any(
        np.any(np.abs(own[row] - value[i]) > 1e-9 * top[i]) for i, row in enumerate(rows)
    ):
        fix = "compute it anew from this scene"
        raise bad("answer", "one of another machine", "one of the scene", fix)
    slope, error = np.empty((2, *value.shape, len(names)))
    longest = max(map(abs, scene.mechanism().lengths.values()))
    for i, name in enumerate(names):
        size = longest if name.startswith("links.") else 1.0
        places, step, (fine, coarse) = differences(scene.get(name), size=size)
        moved = [with_numbers(scene, {name: scene.get(name) + step * place}) for place in places]
        changes = np.array([stacked(_rows_of(one, answer)) - value for one in moved])
        slope[..., i] = np.tensordot(fine, changes, axes=1)
        rough = np.abs(np.tensordot(coarse, changes, axes=1) - slope[..., i])
        error[..., i] = rough + _ROUNDING * np.sum(np.abs(fine)) * top
    return rows, value, slope, error


def _rows_of(scene: Scene, answer: RigidAnswer) -> Mapping[str, Array]:
    """Return the motion or the forces of a scene, driven as those of the answer."""
    if isinstance(answer, RigidForces):
        drive = answer.theta2, answer.speed, answer.acceleration
        return rigid_forces(scene.machine(), *drive).values
    return vars(scene.mechanism().motion(answer.theta2, answer.omega2, answer.alpha2))
