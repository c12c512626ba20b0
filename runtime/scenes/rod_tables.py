"""Tables of a scene whose quick-return rod bends, and what follows from its quantities."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..core.errors import BadInput, Problem
from .linkage_tables import QUICK_RETURN_LENGTHS
from .schema import Key, Table, not_negative, positive

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
            raise BadInput(Problem("rod.modulus", "no section", expected, "add second_moment"))
        rod["bending_stiffness"] = rod["modulus"] * rod["second_moment"]
    rod.setdefault("damping", 0.0)
    rod.setdefault("relaxation_time", 0.0)
    rod.setdefault("damping_ratio", 0.0)
