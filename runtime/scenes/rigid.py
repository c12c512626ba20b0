"""A scene of rigid links to its machine: masses, weight, loads, springs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..core.errors import bad
from ..rigid import Load, Machine, MassDistribution, Spring, TorsionSpring

if TYPE_CHECKING:
    from ..linkages.linkage import Linkage
    from .scene import Scene

_MASS = {
    "mass": "mass",
    "along": "first_moment",
    "across": "transverse_moment",
    "inertia": "inertia",
}


def rigid_numbers(scene: Scene, linkage: Linkage) -> dict[str, Any]:
    """Return lengths, and masses by ``crank.mass`` and so on, as a parametric machine names them.

    They may be other numbers than floats; the linkage tells their names.
    """
    numbers = {name: scene["links"][name] for name in linkage.names}
    for link in linkage.links:
        table = scene.get(link, {})
        numbers |= {f"{link}.{name}": table.get(key, 0.0) for name, key in _MASS.items()}
    return numbers


def machine(scene: Scene) -> Machine:
    """Return the machine of a scene; links that bend are taken as rigid."""
    linkage = scene.mechanism()
    tables = {link: scene[link] for link in linkage.links if link in scene}
    masses = {
        link: MassDistribution(**{name: table.get(key, 0.0) for name, key in _MASS.items()})
        for link, table in tables.items()
        if any(key in table for key in _MASS.values())
    }
    if not masses:
        expected = f"a mass, weight or inertia of one of {list(linkage.links)}"
        fix = "write it into the link's table, or --set coupler.mass='0.4 kg'"
        raise bad(f"scene {scene.name}", "no mass", expected, fix)
    gravity = scene["gravity"]
    pull, direction = gravity["acceleration"], gravity.get("direction")
    weight = (0.0, 0.0)
    if direction is not None:
        weight = (pull * math.cos(direction), pull * math.sin(direction))
    springs: list[Spring | TorsionSpring] = []
    springs += [_spring(table) for table in scene.get("springs", {}).values()]
    keys = ("stiffness", "free_angle", "damping", "preload")
    springs += [
        TorsionSpring(table["first"], table["second"], **_given(table, *keys))
        for table in scene.get("torsion_springs", {}).values()
    ]
    loads = [
        Load(table["link"], **_given(table, "force", "couple", "along", "across", "axes"))
        for table in scene.get("loads", {}).values()
    ]
    return Machine(linkage, masses, weight, tuple(loads), tuple(springs))


def _spring(table: Mapping[str, Any]) -> Spring:
    first, second = (
        (table[end], *table.get(f"{end}_at", (0.0, 0.0))) for end in ("first", "second")
    )
    return Spring(first, second, **_given(table, "stiffness", "free_length", "damping", "preload"))


def _given(table: Mapping[str, Any], *keys: str) -> dict[str, Any]:
    return {key: table[key] for key in keys if key in table}
