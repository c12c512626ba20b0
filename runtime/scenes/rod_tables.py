"""Tables of a scene whose quick-return rod bends, and what follows from its quantities."""

from __future__ import annotations

from typing import Any

from ..core.errors import BadInput, Problem
from .schema import Key, Table

ROD_LINKS = Table(
    "links",
    "lengths between the pins, and of the rod",
    (
        Key(
            "frame",
            "distance between the pivots of crank and rod",
            dimension="length",
            required=True,
            limit="positive",
        ),
        Key("crank", "length of the driven link", dimension="length", limit="positive"),
        Key("crank_ratio", "crank over frame, eps", limit="positive"),
        Key(
            "rod",
            "length of the rod, which a block on the crank pin slides along",
            dimension="length",
            required=True,
            limit="positive",
        ),
    ),
    required=True,
    exactly_one=(("crank", "crank_ratio"),),
)
ROD = Table(
    "rod",
    "the flexible rod",
    (
        Key(
            "bending_stiffness",
            "EI, in the plane of motion",
            dimension="bending_stiffness",
            limit="positive",
        ),
        Key("modulus", "E; with second_moment it gives EI", dimension="stress", limit="positive"),
        Key(
            "second_moment",
            "I, in the plane of motion",
            dimension="second_moment",
            limit="positive",
        ),
        Key(
            "mass_per_length",
            "mass per length",
            dimension="mass_per_length",
            required=True,
            limit="positive",
        ),
        Key(
            "damping",
            "viscous damping of the rod's own motion, per length",
            dimension="damping_per_length",
            limit="non-negative",
        ),
        Key(
            "relaxation_time",
            "Kelvin-Voigt damping: the moment is EI (v'' + relaxation_time d v''/dt)",
            dimension="time",
            limit="non-negative",
        ),
        Key(
            "damping_ratio",
            "of the first mode with the block at frame's distance, by damping_law",
            limit="non-negative",
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
    """Fill in the bending stiffness, and zeros where no damping is given.

    Raises
    ------
    BadInput
        If a modulus stands without a second moment of area.
    """
    if "modulus" in rod:
        if "second_moment" not in rod:
            expected = "second_moment beside it"
            raise BadInput(Problem("rod.modulus", "no section", expected, "add second_moment"))
        rod["bending_stiffness"] = rod["modulus"] * rod["second_moment"]
    rod.setdefault("damping", 0.0)
    rod.setdefault("relaxation_time", 0.0)
    rod.setdefault("damping_ratio", 0.0)
