"""Hill's equation of a scene as a system of the linear periodic family."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.families import LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from .assembly import assemble
from .modules import find_module

if TYPE_CHECKING:
    from ..scenes import Scene


def hill_function(scene: Scene) -> PeriodicFunction:
    """Return the periodic function f of a scene with mechanism ``hill``."""
    table = scene["function"]
    return PeriodicFunction(a=table["a"], b=table["b"])


def hill_system(scene: Scene) -> LinearPeriodic:
    """Return ``y'' + 2 K y' + (lam2 + mu f) y = 0`` (Smith 7.38); the speed that suits it is 1.

    Raises
    ------
    BadInput
        If no module was emitted for the scene's model.
    """
    emitted = find_module(scene.model_spec())
    return assemble(
        emitted.module,
        geometry={},
        parameters=dict(scene["parameters"]),
        external={"f": hill_function(scene)},
        labels=("y",),
        provenance={"scene": scene.name, "scene_digest": scene.digest(), **emitted.provenance},
    )
