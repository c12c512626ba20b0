"""Counterweights: bodies added to the links of a machine, and where an optimiser may put them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from ..core.errors import BadInput, Problem, bad
from .inputs import not_finite, require_link
from .machine import Machine, require_machine
from .masses import MassDistribution


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
        where = "Counterweight"
        problems = not_finite(where, {"along": self.along, "across": self.across})
        problems += not_finite(where, {"mass": self.mass}, least=0.0)
        problems += _body_problems(where, self)
        if problems:
            raise BadInput(*problems)

    @property
    def own_inertia(self) -> float:
        """Moment of inertia [kg m^2] about its own centre."""
        return 0.5 * self.mass * self.disc_radius**2

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
        where = "Bounds"
        problems = not_finite(where, {"least_offset": self.least_offset}, least=0.0)
        problems += _not_positive(where, {"mass": self.mass, "offset": self.offset})
        problems += _body_problems(where, self)
        if not problems and self.offset is not None and self.least_offset > self.offset:
            expected = f"at most the greatest offset {self.offset:g}"
            problems.append(
                Problem("Bounds.least_offset", f"{self.least_offset:g}", expected, "correct it")
            )
        if problems:
            raise BadInput(*problems)

    def completed(self, machine: Machine, link: str) -> tuple[float, float]:
        """Return greatest mass [kg] and offset [m], with the machine's defaults."""
        lengths = machine.linkage.lengths
        mass = self.mass or sum(machine.mass(name).mass for name in machine.linkage.links)
        offset = self.offset or lengths.get(link)
        if not mass:
            raise bad(f"bounds.{link}", "a machine without mass", "a greatest mass", "give mass")
        if offset is None:
            raise bad(f"bounds.{link}", "no offset", "a greatest offset", "give offset")
        if self.least_offset > offset:
            least = f"least offset {self.least_offset:g}"
            raise bad(f"bounds.{link}", least, f"at most {offset:g}", "give offset too")
        return mass, offset


def bounds_by_link(
    links: tuple[str, ...], bounds: Bounds | Mapping[str, Bounds] | None
) -> dict[str, Bounds]:
    """Return the bounds of each link, or raise BadInput where they are none or name another."""
    if isinstance(bounds, Mapping):
        for link in bounds:
            require_link(link, links, "bounds")
        given = {link: bounds.get(link, Bounds()) for link in links}
    else:
        given = dict.fromkeys(links, Bounds() if bounds is None else bounds)
    for each in given.values():
        if not isinstance(each, Bounds):
            raise bad("bounds", type(each).__name__, "Bounds", "give Bounds(mass=..., offset=...)")
    return given


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
    for weight in counterweights:
        require_link(weight.link, tuple(machine.linkage.links), "Counterweight.link")
        masses[weight.link] = masses.get(weight.link, MassDistribution()) + weight.distribution
    return replace(machine, masses=masses)


def _not_positive(where: str, values: Mapping[str, float | None]) -> list[Problem]:
    given = {name: value for name, value in values.items() if value is not None}
    return not_finite(where, given) or [
        Problem(f"{where}.{name}", f"{value:g}", "a number above zero", "correct it")
        for name, value in given.items()
        if value <= 0.0
    ]


def _body_problems(where: str, body: Counterweight | Bounds) -> list[Problem]:
    """Return what is wrong with a disc of a radius, or a cylinder of density and thickness."""
    cylinder = {"density": body.density, "thickness": body.thickness}
    problems = not_finite(where, {"radius": body.radius}, least=0.0)
    problems += _not_positive(where, cylinder)
    if not problems and (body.density is None) != (body.thickness is None):
        expected = "both density and thickness, or none"
        problems.append(Problem(f"{where}.density", "one of the two", expected, "give both"))
    elif not problems and body.radius and body.density is not None:
        expected = "a radius, or density and thickness"
        problems.append(Problem(f"{where}.radius", "all three", expected, "leave one out"))
    return problems
