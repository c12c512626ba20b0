"""Linkages and frames of beams: from a scene to its structure and its system."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...derive.spec import BEAM_FORMULATIONS
from ..beams.frames import frame, without_stretching
from ..beams.linear import linear_system
from ..beams.linkages import linkage_system
from ..beams.section import Section
from ..beams.structure import DIRECTIONS
from ..core.families import LinearPeriodic
from ..core.families.modal_damping import with_modal_damping
from .from_scene import origin, pull_of_gravity

if TYPE_CHECKING:
    from ..scenes import Scene


def beams_of_scene(scene: Scene) -> LinearPeriodic:
    """Return the vibration of a scene's linkage or frame of beams, with its modal damping."""
    drop = scene.model["drop"]
    options: dict[str, Any] = {
        "form": "instantaneous" if "turning" in drop else "full",
        "geometric_stiffness": "geometric_stiffness" not in drop,
        "rayleigh": tuple(
            scene.get(f"damping.{key}", 0.0) for key in ("rayleigh_mass", "rayleigh_stiffness")
        ),
        "gravity": pull_of_gravity(scene),
    }
    still = scene.model["mechanism"] == "frame"
    tables = scene["members"] if still else {link: scene[link] for link in scene.layout.flexible}
    nodes = scene["nodes"] if still else scene.get("joints", {})
    sections = {name: section(table) for name, table in tables.items()}
    common = scene["mesh"]["elements"]
    parts: dict[str, Any] = {
        "elements": {name: int(table.get("elements", common)) for name, table in tables.items()},
        "kind": BEAM_FORMULATIONS[scene.model["formulation"]],
        "nodes": {name: _node(table) for name, table in nodes.items()},
        "provenance": origin(scene),
    }
    if still:
        structure = frame(
            {name: table["place"] for name, table in nodes.items()},
            {name: (table["start"], table["end"]) for name, table in tables.items()},
            sections,
            supports={name: table.get("held", ()) for name, table in nodes.items()},
            pins=[name for name, table in nodes.items() if table.get("pinned") == "yes"],
            **parts,
        )
        system = linear_system(structure, **options)
        if scene["frame"]["axial"] == "rigid":
            system = without_stretching(system)
    else:
        system = linkage_system(scene.mechanism(), sections, **parts, **options)
    ratio = scene.get("damping.ratio", 0.0)
    return with_modal_damping(system, ratio) if ratio else system


def section(table: Mapping[str, Any]) -> Section:
    """Return the section of a link's table."""
    names = ("area", "second_moment", "modulus", "density", "thickness", "shear_stiffness")
    given = {name: table[name] for name in names if name in table}
    return Section(**given, retardation=table.get("retardation_time", 0.0))


def _node(table: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a joint's table says, as :class:`Node` takes it."""
    plain = ("mass", "inertia", "carried_by", "held", "force")
    found: dict[str, Any] = {key: table[key] for key in plain if key in table}
    for group in ("stiffness", "damping"):
        parts = {part: table.get(f"{group}_{part}") for part in DIRECTIONS}
        given = {part: value for part, value in parts.items() if value is not None}
        if given:
            found[group] = given
    return found
