"""A scene of rigid links to its machine: masses, weight, loads, springs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..core.errors import bad

if TYPE_CHECKING:
    from ..rigid import Load, Machine, MassDistribution, Spring, TorsionSpring
    from .scene import Scene

_MASS = ("mass", "first_moment", "transverse_moment", "inertia")


def machine(scene: Scene) -> Machine:
    """Return the machine of a scene; links that bend are taken as rigid."""
    from ..rigid import Machine

    linkage = scene.mechanism()
    masses = {link: _mass(scene[link]) for link in linkage.links if _known(scene, link)}
    if not masses:
        raise bad(
            f"scene {scene.name}",
            "no mass",
            f"a mass, weight or inertia of one of {list(linkage.links)}",
            "write it into the link's table, or --set coupler.mass='0.4 kg'",
        )
    gravity = scene["gravity"]
    pull, direction = gravity["acceleration"], gravity.get("direction")
    weight = (0.0, 0.0)
    if direction is not None:
        weight = (pull * math.cos(direction), pull * math.sin(direction))
    springs: list[Spring | TorsionSpring] = []
    springs += [_spring(table) for table in scene.get("springs", {}).values()]
    springs += [_torsion(table) for table in scene.get("torsion_springs", {}).values()]
    loads = [_load(table) for table in scene.get("loads", {}).values()]
    return Machine(linkage, masses, weight, tuple(loads), tuple(springs))


def _known(scene: Scene, link: str) -> bool:
    return link in scene and any(key in scene[link] for key in _MASS)


def _mass(table: Mapping[str, Any]) -> MassDistribution:
    from ..rigid import MassDistribution

    return MassDistribution(*(table.get(key, 0.0) for key in _MASS))


def _load(table: Mapping[str, Any]) -> Load:
    from ..rigid import Load

    return Load(
        table["link"],
        force=table.get("force", (0.0, 0.0)),
        couple=table.get("couple", 0.0),
        along=table.get("along", 0.0),
        across=table.get("across", 0.0),
        axes=table["axes"],
    )


def _spring(table: Mapping[str, Any]) -> Spring:
    from ..rigid import Spring

    ends = [(table[end], *table.get(f"{end}_at", (0.0, 0.0))) for end in ("first", "second")]
    given = ("stiffness", "free_length", "damping", "preload")
    first, second = ends
    return Spring(first, second, **{key: table[key] for key in given if key in table})


def _torsion(table: Mapping[str, Any]) -> TorsionSpring:
    from ..rigid import TorsionSpring

    given = ("stiffness", "free_angle", "damping", "preload")
    present = {key: table[key] for key in given if key in table}
    return TorsionSpring(table["first"], table["second"], **present)
