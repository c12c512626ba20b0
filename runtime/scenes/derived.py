"""Quantities that follow from the given ones: mass per length, damping, a uniform bar's inertia."""

from __future__ import annotations

import math
from typing import Any

from ..errors import BadInput, Problem
from .checks import body_problems
from .schema import LINKS, Layout

Values = dict[str, dict[str, Any]]


def complete(values: Values, layout: Layout) -> None:
    """Fill in what the given quantities determine, so that a solver finds every key.

    Parameters
    ----------
    values : dict of dict
        Validated tables in SI units; completed in place.
    layout : Layout
        What the scene's mechanism and formulation call for.

    Raises
    ------
    BadInput
        If a link is said to be balanced and given a first moment, or if no body can have the
        mass, first moment and inertia of a link.
    """
    if layout.mechanism == "hill":
        _pad_series(values["function"])
    if layout.mechanism != "four_bar":
        return
    balanced = values["model"]["balanced"]
    contradictions = [
        Problem(
            f"{link}.first_moment",
            f"{values[link]['first_moment']:g} kg m",
            "0, since model.balanced names this link",
            "remove one of the two",
        )
        for link in balanced
        if values.get(link, {}).get("first_moment", 0.0) != 0.0
    ]
    if contradictions:
        raise BadInput(*contradictions)
    if "coupler" in layout.flexible:
        _flexible_bar(values["coupler"], values["links"]["coupler"])
    gravity = values["gravity"]["acceleration"]
    for link in LINKS[1:]:
        if link in values:
            _rigid_bar(values[link], values["links"][link], gravity, balanced=link in balanced)
    impossible = body_problems(values, layout)
    if impossible:
        raise BadInput(*impossible)


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


def _rigid_bar(bar: dict[str, Any], length: float, gravity: float, *, balanced: bool) -> None:
    """Mass from weight; first moment and inertia of a uniform bar where none are given."""
    if "weight" in bar:
        bar["mass"] = bar["weight"] / gravity
    if balanced:
        bar["first_moment"] = 0.0
    if "mass" in bar:
        bar.setdefault("first_moment", bar["mass"] * length / 2.0)
        bar.setdefault("inertia", bar["mass"] * length**2 / 3.0)
