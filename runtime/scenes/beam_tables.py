"""Tables of a scene whose links, or whose rod, bend, and what follows from its quantities."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from ..core.errors import Problem, bad, refuse
from .linkage_tables import QUICK_RETURN_LENGTHS
from .schema import Key, Table, choice, not_negative, positive, quantities

# Terms of the moving beams that a scene may leave out, and names for sets of them.
DROPPED = ("geometric_stiffness", "turning")
BEAM_DROPS: Mapping[str, tuple[str, ...]] = {
    "instantaneous": ("turning",),
    "as_printed": ("geometric_stiffness", "turning"),
}
BEAM_PARAMETERS = {
    "speed": "frequency",
    "elasticity": "dimensionless",
    "distributed_mass": "dimensionless",
    "lumped_mass": "dimensionless",
    "damping_ratio": "dimensionless",
    **dict.fromkeys(("frame", "crank", "coupler", "follower"), "length"),
}
MATERIAL = Table(
    "material",
    "what the links are made of, where a link does not say otherwise",
    (
        positive("modulus", "Young's modulus", "stress"),
        positive("density", "mass per volume", "density"),
        not_negative(
            "retardation_time",
            "Kelvin-Voigt damping: stress = E (strain + retardation_time d strain/dt)",
            "time",
            default=0.0,
        ),
        positive("limit_stress", "stress that it bears", "stress"),
        not_negative("poisson", "Poisson's ratio, for Timoshenko's beam", most=0.5),
    ),
)
MESH = Table(
    "mesh",
    "how the links are divided",
    (Key("elements", "elements of every link", "count", default=3, limit="positive", most=200),),
)
DAMPING = Table(
    "damping",
    "damping of the whole structure",
    (
        not_negative("ratio", "of every mode of the structure held still"),
        not_negative("rayleigh_mass", "a of C = a M + b K", "frequency"),
        not_negative("rayleigh_stiffness", "b of C = a M + b K", "time"),
    ),
)
SECTION_KEYS = (
    positive("area", "cross-section area", "area"),
    positive("second_moment", "second moment of area", "second_moment"),
    positive("width", "width of a bar across the plane", "length"),
    positive("thickness", "thickness in the plane", "length"),
    positive("shear_stiffness", "k G A", "force"),
    *(replace(key, default=None) for key in MATERIAL.keys if key.name != "poisson"),
    Key("elements", "number of elements", "count", limit="positive", most=200),
)
_HELD = ("x", "y", "rotation")
_NODE_KEYS = (
    not_negative("mass", "lumped mass", "mass"),
    not_negative("inertia", "lumped moment of inertia", "inertia"),
    Key("carried_by", "link that the inertia turns with", "text"),
    not_negative("stiffness_x", "spring along x", "stiffness"),
    not_negative("stiffness_y", "spring along y", "stiffness"),
    not_negative("stiffness_rotation", "torsion spring", "rotational_stiffness"),
    not_negative("damping_x", "damper along x", "damping"),
    not_negative("damping_y", "damper along y", "damping"),
    not_negative("damping_rotation", "torsion damper", "rotational_damping"),
    Key("held", "what ground or shaft hold; else what the mechanism says", "texts", choices=_HELD),
    quantities("force", "constant load, x and y component", "force", length=2),
)
JOINTS = Table("joints", "what is at a joint, under its letter: A, B, C, D", _NODE_KEYS, named=True)
NODES = Table(
    "nodes",
    "points of a frame, each under a name of its own",
    (
        quantities("place", "x and y", "length", length=2, required=True),
        choice("pinned", "whether members turn by themselves there", "yes", "no"),
        *_NODE_KEYS,
    ),
    required=True,
    named=True,
)
MEMBERS = Table(
    "members",
    "beams of a frame, each under a name of its own",
    (
        Key("start", "node where it begins", "text", required=True),
        Key("end", "node where it ends", "text", required=True),
        *SECTION_KEYS,
    ),
    required=True,
    named=True,
)
FRAME = Table(
    "frame",
    "assumptions about all members",
    (choice("axial", "whether members stretch", "elastic", "rigid", default="elastic"),),
)


def beam_table(link: str) -> Table:
    """Return the table of a link that is a beam."""
    return Table(link, f"section of the {link}", SECTION_KEYS, required=True)


def complete_beams(values: dict[str, dict[str, Any]], links: Iterable[str]) -> None:
    """Fill in section and material of every link, and of every member of a frame."""
    problems = []
    strange = sorted(set(values["model"]["drop"]) - set(DROPPED))
    if strange:
        known = f"some of {[*DROPPED, *BEAM_DROPS]}"
        problems.append(Problem("model.drop", str(strange), known, "correct the name"))
    tables = {link: values[link] for link in links if link in values}
    tables |= {f"members.{name}": table for name, table in values.get("members", {}).items()}
    material = values.get("material", {})
    needs_shear = values["model"]["formulation"] == "timoshenko_beams"
    for where, table in tables.items():
        problems += _complete_section(where, table, material, needs_shear)
    refuse(problems)


def _complete_section(
    where: str, table: dict[str, Any], material: Mapping[str, Any], needs_shear: bool
) -> list[Problem]:
    for key in ("modulus", "density", "retardation_time", "limit_stress"):
        if key in material:
            table.setdefault(key, material[key])
    if {"width", "thickness"} <= set(table):
        table.setdefault("area", table["width"] * table["thickness"])
        table.setdefault("second_moment", table["width"] * table["thickness"] ** 3 / 12.0)
    needed = {
        **dict.fromkeys(("area", "second_moment"), "give it, or width and thickness"),
        **dict.fromkeys(("modulus", "density"), "give it here or in [material]"),
    }
    problems = [
        Problem(f"{where}.{key}", "nothing", "a positive value", fix)
        for key, fix in needed.items()
        if key not in table
    ]
    if needs_shear and "shear_stiffness" not in table and not problems:
        if "poisson" in material:
            nu = material["poisson"]
            factor = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
            modulus = table["modulus"] / (2.0 * (1.0 + nu))
            table["shear_stiffness"] = factor * modulus * table["area"]
        else:
            fix = "give it, or material.poisson for a rectangle's"
            expected = "k G A for Timoshenko's beam"
            problems.append(Problem(f"{where}.shear_stiffness", "nothing", expected, fix))
    return problems


_FRAME, _CRANK, _ROD = QUICK_RETURN_LENGTHS.keys
_RATIO = positive("crank_ratio", "crank over frame, eps")
ROD_LINKS = replace(
    QUICK_RETURN_LENGTHS,
    keys=(_FRAME, replace(_CRANK, required=False), _RATIO, _ROD),
    exactly_one=(("crank", "crank_ratio"),),
)
ROD = Table(
    "rod",
    "the flexible rod",
    (
        positive("bending_stiffness", "EI, in the plane of motion", "bending_stiffness"),
        positive("modulus", "E; with second_moment it gives EI", "stress"),
        positive("second_moment", "I, in the plane of motion", "second_moment"),
        positive("mass_per_length", "mass per length", "mass_per_length", required=True),
        not_negative(
            "damping", "viscous damping of the rod's own motion, per length", "damping_per_length"
        ),
        not_negative(
            "relaxation_time",
            "Kelvin-Voigt damping: the moment is EI (v'' + relaxation_time d v''/dt)",
            "time",
        ),
        not_negative(
            "damping_ratio", "of the first mode with the block at frame's distance, by damping_law"
        ),
        Key(
            "damping_law",
            "what damping_ratio is made of: viscous (proportional to mass), internal "
            "(proportional to stiffness), or modal (the same ratio in every mode)",
            "text",
            default="internal",
            choices=("viscous", "internal", "modal"),
        ),
    ),
    required=True,
    exactly_one=(("bending_stiffness", "modulus"),),
    at_most_one=(
        ("bending_stiffness", "second_moment"),
        ("damping", "damping_ratio"),
        ("relaxation_time", "damping_ratio"),
    ),
)
ROD_PARAMETERS = {
    "speed": "frequency",
    "crank_ratio": "dimensionless",
    "bending_stiffness": "bending_stiffness",
    "mass_per_length": "mass_per_length",
    "damping": "damping_per_length",
}


def complete_crank(links: dict[str, Any]) -> None:
    """Fill in the crank's length from its ratio to the frame, or the ratio from the length."""
    if "crank_ratio" in links:
        links["crank"] = links["crank_ratio"] * links["frame"]
    else:
        links["crank_ratio"] = links["crank"] / links["frame"]


def complete_rod(rod: dict[str, Any]) -> None:
    """Fill in the bending stiffness, and zeros where no damping is given."""
    if "modulus" in rod:
        if "second_moment" not in rod:
            expected = "second_moment beside it"
            raise bad("rod.modulus", "no section", expected, "add second_moment")
        rod["bending_stiffness"] = rod["modulus"] * rod["second_moment"]
    for key in ("damping", "relaxation_time", "damping_ratio"):
        rod.setdefault(key, 0.0)
