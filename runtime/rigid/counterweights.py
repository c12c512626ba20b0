"""Counterweights: bodies added to a link of a machine, and the machine with them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from numbers import Real
from typing import TYPE_CHECKING

from ..core.errors import BadInput, Problem, bad
from .masses import MassDistribution

if TYPE_CHECKING:
    from . import Machine


@dataclass(frozen=True)
class Counterweight:
    """A point mass, a disc or a cylinder fixed to a link (Smith Fig. 20).

    Its place is given in the link's own frame: origin at the link's first joint (crank: A; coupler
    and block: B; follower and rod: D; slider: C), x axis along the link.

    Parameters
    ----------
    link : str
        Link that carries it, for example ``"crank"``.
    mass : float
        Mass [kg].
    along, across : float
        Centre [m]; a negative ``along`` lies beyond the first joint.
    radius : float
        Radius [m] of the disc about its centre; 0 for a point mass.
    density, thickness : float, optional
        In place of the radius: a cylinder [kg/m^3, m] whose axis is normal to the plane; its
        radius follows from ``mass = pi radius^2 thickness density`` (Smith chapter 5).

    Raises
    ------
    BadInput
        If a number is not finite, mass or radius is negative, or density and thickness are not
        both given and positive, without a radius beside them.
    """

    link: str
    mass: float
    along: float
    across: float = 0.0
    radius: float = 0.0
    density: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        """Check the numbers."""
        cylinder = {"density": self.density, "thickness": self.thickness}
        given = {name: value for name, value in cylinder.items() if value is not None}
        numbers = {name: getattr(self, name) for name in ("mass", "along", "across", "radius")}
        problems = [
            Problem(f"Counterweight.{name}", repr(value)[:60], "a finite number", "correct it")
            for name, value in {**numbers, **given}.items()
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value)
        ]
        if not problems:
            problems = [
                Problem(f"Counterweight.{name}", f"{numbers[name]:g}", "zero or more", "correct it")
                for name in ("mass", "radius")
                if numbers[name] < 0
            ]
            problems += [
                Problem(f"Counterweight.{name}", f"{value:g}", "above zero", "correct it")
                for name, value in given.items()
                if value <= 0
            ]
            if len(given) == 1 or (given and self.radius):
                problems.append(
                    Problem(
                        "Counterweight",
                        " and ".join([*given, *(["radius"] if self.radius else [])]),
                        "a radius, or density and thickness",
                        "give one or the other",
                    )
                )
        if problems:
            raise BadInput(*problems)

    @property
    def own_inertia(self) -> float:
        """Moment of inertia [kg m^2] about its own centre."""
        if self.density is None or self.thickness is None:
            return 0.5 * self.mass * self.radius * self.radius
        return self.mass * self.mass / (2.0 * math.pi * self.thickness * self.density)

    @property
    def disc_radius(self) -> float:
        """Radius [m], given or from density and thickness."""
        if self.density is None or self.thickness is None:
            return self.radius
        return math.sqrt(self.mass / (math.pi * self.thickness * self.density))

    @property
    def offset(self) -> float:
        """Distance [m] of its centre from the link's first joint."""
        return math.hypot(self.along, self.across)

    @property
    def distribution(self) -> MassDistribution:
        """What it adds to its link: mass, first moments and inertia about the first joint."""
        return MassDistribution.about_centre(self.mass, self.along, self.across, self.own_inertia)


def with_counterweights(machine: Machine, counterweights: Iterable[Counterweight]) -> Machine:
    """Return the machine with counterweights added to its links.

    Parameters
    ----------
    machine : Machine
        Stays as it is.
    counterweights : iterable of Counterweight
        Any number, several on one link too.

    Raises
    ------
    BadInput
        If a counterweight sits on a link that the linkage has not.
    """
    require_machine(machine)
    masses = dict(machine.masses)
    links = tuple(machine.linkage.links)
    for weight in counterweights:
        require_link(weight.link, links, "Counterweight.link")
        before = masses.get(weight.link, MassDistribution())
        masses[weight.link] = before + weight.distribution
    return replace(machine, masses=masses)


def require_link(link: object, links: tuple[str, ...], where: str) -> None:
    """Raise BadInput where a linkage has no such moving link."""
    if link not in links:
        raise bad(where, repr(link), f"one of {', '.join(links)}", "correct the name")


def require_machine(machine: object) -> None:
    """Raise BadInput for what is no Machine."""
    from . import Machine

    if not isinstance(machine, Machine):
        raise bad("machine", type(machine).__name__, "a Machine", "build one of a linkage")


def finite_number(value: object, where: str) -> float:
    """Return a finite number, or raise BadInput."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError) as refusal:
        raise bad(where, repr(value)[:60], "a number", "correct it") from refusal
    if not math.isfinite(number):
        raise bad(where, repr(value)[:60], "a finite number", "correct it")
    return number
