"""A scene of the user's own mechanism to its system: names in the file are names in the module."""

from __future__ import annotations

import inspect
from collections import Counter
from types import ModuleType
from typing import TYPE_CHECKING

from ..core.errors import BadInput, Problem
from ..core.families import LinearPeriodic, Nonlinear
from ..core.modules import find_module
from ..systems import assemble
from ..systems.driven import driven_system
from ..systems.from_scene import origin

if TYPE_CHECKING:
    from .scene import Scene

_NOT_PHYSICS = ("model", "operation", "chart")


def own_system(scene: Scene) -> LinearPeriodic | Nonlinear:
    """Return the system of a scene that declares its own tables.

    That is the linear-periodic one, or the nonlinear one of a model without constraints.

    Every parameter and every argument of the emitted module is looked up among the scene's
    numbers, as ``KEY`` or as ``TABLE_KEY``; where two tables share a key, only the latter names
    it.  A module that takes something else needs a builder of its own around
    :func:`elastolink.runtime.systems.assemble`.
    """
    emitted = find_module(scene.model_spec())
    numbers = _numbers(scene)
    driven = emitted.module.FAMILY == "constrained"
    parameters = [n for n in emitted.module.PARAMETERS if not (driven and n == "speed")]
    arguments = _arguments(emitted.module) - set(parameters) - set(emitted.module.EXTERNAL)
    missing = sorted((set(parameters) | arguments) - set(numbers))
    if missing:
        known = f"one of {sorted(numbers)}"
        fix = f"module {emitted.entry.module} takes it: declare it in [schema] and give it"
        raise BadInput(*(Problem(name, "nothing", known, fix) for name in missing))
    limits = _limits(scene, parameters)
    if driven:
        values = {name: numbers[name] for name in parameters}
        return driven_system(emitted, values, limits=limits, provenance=origin(scene))
    return assemble(
        emitted.module,
        geometry={name: numbers[name] for name in sorted(arguments)},
        parameters={name: numbers[name] for name in parameters},
        modes=scene.model.get("modes"),
        drop=emitted.dropped,
        limits=limits,
        provenance={**origin(scene), **emitted.provenance},
    )


def _numbers(scene: Scene) -> dict[str, float]:
    """Return the scene's numbers by key, where it is unique, and by table and key."""
    tables = {name: table for name, table in scene.tables.items() if name not in _NOT_PHYSICS}
    shared = Counter(key for table in tables.values() for key in table)
    found: dict[str, float] = {}
    for name, table in tables.items():
        for key, value in table.items():
            if isinstance(value, (int, float)):
                found[f"{name}_{key}"] = float(value)
                if shared[key] == 1:
                    found[key] = float(value)
    return found


def _limits(scene: Scene, parameters: list[str]) -> dict[str, str]:
    """Return the declared limits of parameters, by the names that :func:`_numbers` gives them."""
    declared: dict[str, str] = {}
    for table in scene.layout.tables:
        for key in table.keys:
            declared[f"{table.name}_{key.name}"] = declared[key.name] = key.limit
    return {name: declared[name] for name in parameters if declared.get(name, "any") != "any"}


def _arguments(module: ModuleType) -> set[str]:
    """Return what the emitted functions of angle and of parameters take, beside the angle."""
    found: set[str] = set()
    for kernel in module.RETURNS:
        names = list(inspect.signature(getattr(module, kernel)).parameters)
        if kernel.endswith("_functions"):
            found.update(names[1:])
        elif kernel == "scales":
            found.update(names)
    return found
