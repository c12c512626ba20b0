"""Bounds of the counterweights that an optimiser may choose."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING

from ..core.errors import BadInput, Problem, bad
from .counterweights import require_link

if TYPE_CHECKING:
    from . import Machine


@dataclass(frozen=True)
class Bounds:
    """Where a counterweight may be, and what it may weigh.

    Parameters
    ----------
    mass : float, optional
        Greatest mass [kg]; by default that of all links of the machine together.
    offset : float, optional
        Greatest distance [m] of its centre from the link's first joint; by default the length of
        the link.
    least_offset : float
        Least distance [m]; equal to ``offset`` for a counterweight at a given distance.
    radius : float
        Greatest radius [m] of a disc whose radius is free; 0 for a point mass.
    density, thickness : float, optional
        In place of the radius: a cylinder [kg/m^3, m], its radius given by its mass.

    Raises
    ------
    BadInput
        If a number is impossible.
    """

    mass: float | None = None
    offset: float | None = None
    least_offset: float = 0.0
    radius: float = 0.0
    density: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        """Check the numbers."""
        above = ("mass", "offset", "density", "thickness")
        problems = []
        for name in (*above, "least_offset", "radius"):
            value = getattr(self, name)
            if value is None and name in above:
                continue
            least = name in above
            good = isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
            if not good or value < 0 or (least and value == 0):
                expected = "a number above zero" if least else "a number of zero or more"
                problems.append(Problem(f"Bounds.{name}", repr(value)[:60], expected, "correct it"))
        if not problems and self.offset is not None and self.least_offset > self.offset:
            found = f"{self.least_offset:g}"
            expected = f"at most the greatest offset {self.offset:g}"
            problems.append(Problem("Bounds.least_offset", found, expected, "correct it"))
        if not problems and (self.density is None) != (self.thickness is None):
            expected = "both density and thickness, or none"
            problems.append(Problem("Bounds.density", "one of the two", expected, "give both"))
        if not problems and self.density is not None and self.radius > 0:
            expected = "a radius, or density and thickness"
            problems.append(Problem("Bounds.radius", "all three", expected, "leave one out"))
        if problems:
            raise BadInput(*problems)

    @property
    def inertia_over_square(self) -> float:
        """Own inertia of a cylinder over the square of its mass, ``1/(2 pi h rho)`` [m^2/kg]."""
        if self.density is None or self.thickness is None:
            return 0.0
        return 1.0 / (2.0 * math.pi * self.thickness * self.density)

    @property
    def required_mass(self) -> float:
        """The greatest mass, known by now."""
        return float(self.mass or 0.0)

    @property
    def required_offset(self) -> float:
        """The greatest offset, known by now."""
        return float(self.offset or 0.0)


def required_bounds(
    machine: Machine, links: tuple[str, ...], bounds: Bounds | Mapping[str, Bounds] | None
) -> dict[str, Bounds]:
    """Return the bounds of each link, with defaults where nothing is given.

    Raises
    ------
    BadInput
        If bounds are no :class:`Bounds`, name another link, or a default is not known.
    """
    if isinstance(bounds, Mapping):
        for link in bounds:
            require_link(link, links, "bounds")
        given = {link: bounds.get(link, Bounds()) for link in links}
    else:
        given = dict.fromkeys(links, Bounds() if bounds is None else bounds)
    total = sum(machine.mass(link).mass for link in machine.linkage.links)
    found = {}
    for link, own in given.items():
        if not isinstance(own, Bounds):
            raise bad("bounds", type(own).__name__, "Bounds", "give Bounds(mass=..., offset=...)")
        mass = own.mass if own.mass is not None else total
        offset = own.offset if own.offset is not None else machine.linkage.lengths.get(link)
        if not mass:
            raise bad(f"bounds.{link}", "a machine without mass", "a greatest mass", "give mass")
        if offset is None:
            raise bad(f"bounds.{link}", "no offset", "a greatest offset", "give offset")
        if own.least_offset > offset:
            found_text = f"least offset {own.least_offset:g}"
            raise bad(f"bounds.{link}", found_text, f"at most {offset:g}", "give offset too")
        found[link] = replace(own, mass=mass, offset=offset)
    return found
