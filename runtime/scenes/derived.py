"""Quantities that follow from the given ones: mass per length, damping, a uniform bar's inertia."""

from __future__ import annotations

import math
from typing import Any

from ...derive.spec import BEAM_FORMULATIONS
from ..core.errors import BadInput, Problem, bad, refuse
from .beam_tables import complete_beams
from .checks import check_body, collecting
from .rod_tables import complete_crank, complete_rod
from .schema import Layout

Values = dict[str, dict[str, Any]]


def complete(values: Values, layout: Layout) -> None:
    """Fill in what the given quantities determine; refuse those that contradict each other."""
    if layout.mechanism == "hill":
        _pad_series(values["function"])
    if layout.formulations == tuple(BEAM_FORMULATIONS):
        complete_beams(values, layout.flexible)
    if "rod" in layout.flexible:
        complete_crank(values["links"])
        complete_rod(values["rod"])
    if not layout.links:
        return
    balanced = values["model"]["balanced"]
    expected, fix = "0, since model.balanced names this link", "remove one of the two"
    contradictions = [
        Problem(f"{link}.{key}", f"{values[link][key]:g}", expected, fix)
        for link in balanced
        for key in ("first_moment", "centre_along")
        if values.get(link, {}).get(key, 0.0) != 0.0
    ]
    if contradictions:
        raise BadInput(*contradictions)
    if "coupler" in layout.flexible:
        _flexible_bar(values["coupler"], values["links"]["coupler"])
    gravity = values["gravity"]["acceleration"]
    problems: list[Problem] = []
    for link in layout.links:
        if link in values:
            # A slider and a block have no length: their mass is at the pin unless they say more.
            length = values["links"].get(link, 0.0)
            with collecting(problems):
                _complete_bar(link, values[link], length, gravity, balanced=link in balanced)
                check_body(link, values[link])
    refuse(problems)


def _pad_series(function: dict[str, Any]) -> None:
    a, b = function["a"], function.get("b", ())
    size = max(len(a), len(b))
    function["a"] = a + (0.0,) * (size - len(a))
    function["b"] = b + (0.0,) * (size - len(b))


def _flexible_bar(bar: dict[str, Any], length: float) -> None:
    """Mass per length and frequency from each other, and the damping both ways.

    ``Omega = (pi/l)^2 sqrt(EI/mu)`` (Smith 6.12, 6.13), and ``c = 2 zeta mu Omega``.
    """
    wave = math.pi / length
    stiffness = bar["bending_stiffness"]
    if "mass_per_length" in bar:
        bar["natural_frequency"] = wave**2 * math.sqrt(stiffness / bar["mass_per_length"])
    else:
        bar["mass_per_length"] = stiffness * wave**4 / bar["natural_frequency"] ** 2
    critical = 2.0 * bar["mass_per_length"] * bar["natural_frequency"]
    if "damping_ratio" in bar:
        bar["damping"] = bar["damping_ratio"] * critical
    else:
        bar.setdefault("damping", 0.0)
        bar["damping_ratio"] = bar["damping"] / critical
    bar["mass"] = bar["mass_per_length"] * length


def _complete_bar(
    link: str, bar: dict[str, Any], length: float, gravity: float, *, balanced: bool
) -> None:
    """Mass, first moments and inertia from whatever gives them; a uniform bar's by default."""
    if "weight" in bar:
        bar["mass"] = bar["weight"] / gravity
    if "density" in bar:
        absent = [key for key in ("width", "thickness") if key not in bar]
        if absent:
            fix = f"add {' and '.join(absent)}, or give mass instead of density"
            raise bad(f"{link}.density", "no section", "width and thickness beside it", fix)
        bar["mass"] = bar["density"] * bar["width"] * bar["thickness"] * length
    given = sorted({"centre_along", "centre_across", "inertia_about_centre"} & set(bar))
    if given and "mass" not in bar:
        expected = "mass, weight or density beside it"
        raise bad(f"{link}.{given[0]}", "no mass", expected, "add the mass")
    if balanced:
        bar["first_moment"] = 0.0
    if "mass" in bar:
        _about_first_joint(bar, bar["mass"], length)


def _about_first_joint(bar: dict[str, Any], mass: float, length: float) -> None:
    """First moments and inertia about the first joint, from centre and inertia about it."""
    moment = mass * bar["centre_along"] if "centre_along" in bar else mass * length / 2.0
    bar.setdefault("first_moment", moment)
    if "centre_across" in bar:
        bar["transverse_moment"] = mass * bar["centre_across"]
    if "inertia_about_centre" in bar:
        squares = bar["first_moment"] ** 2 + bar.get("transverse_moment", 0.0) ** 2
        bar["inertia"] = bar["inertia_about_centre"] + squares / mass
    bar.setdefault("inertia", mass * length**2 / 3.0)
