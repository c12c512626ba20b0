"""Counterweights: bodies on links, bounds for an optimiser, the cases of Smith's Fig. 20."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from ..core.errors import Problem, bad, refuse
from ..core.inputs import number_problems, require_one_of
from .machine import Machine, finite_number, require_machine
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
        where = "Counterweight"
        problems = number_problems(where, {"along": self.along, "across": self.across})
        sizes = {"mass": self.mass, "radius": self.radius}
        problems += number_problems(where, sizes, "not negative")
        problems += _cylinder_problems(where, self.density, self.thickness)
        if not problems and self.radius and self.density is not None:
            expected = "a radius, or density and thickness"
            problems.append(Problem(f"{where}.radius", "all three", expected, "leave one out"))
        refuse(problems)

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
    density, thickness : float, optional
        A cylinder [kg/m^3, m], its radius given by its mass, instead of a point mass.

    Raises
    ------
    BadInput
        If a number is impossible.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> bounds, weights = el.Bounds(mass=0.2, offset=0.1), {"f12": 1.0}
    >>> best = el.balance(machine, 10.0, weights=weights, links=["crank"], bounds=bounds)
    >>> print(round(best.counterweights["crank"].mass, 3), round(best.relative["f12"], 3))
    0.2 0.947
    """

    mass: float | None = None
    offset: float | None = None
    density: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        problems = _not_positive("Bounds", {"mass": self.mass, "offset": self.offset})
        problems += _cylinder_problems("Bounds", self.density, self.thickness)
        refuse(problems)


def with_counterweights(machine: Machine, counterweights: Iterable[Counterweight]) -> Machine:
    """Return the machine with counterweights added to its links, several on one link too.

    A counterweight on a link that the linkage has not is refused.
    """
    require_machine(machine)
    masses = dict(machine.masses)
    for weight in counterweights:
        require_one_of("Counterweight.link", weight.link, machine.linkage.links)
        masses[weight.link] = masses.get(weight.link, MassDistribution()) + weight.distribution
    return replace(machine, masses=masses)


def _not_positive(where: str, values: Mapping[str, float | None]) -> list[Problem]:
    given = {name: value for name, value in values.items() if value is not None}
    return number_problems(where, given, "positive")


def _cylinder_problems(where: str, density: float | None, thickness: float | None) -> list[Problem]:
    problems = _not_positive(where, {"density": density, "thickness": thickness})
    if not problems and (density is None) != (thickness is None):
        expected = "both density and thickness, or none"
        problems.append(Problem(f"{where}.density", "one of the two", expected, "give both"))
    return problems


Case: TypeAlias = Literal["a", "b", "c", "d", "reciprocating"]
CASES: tuple[Case, ...] = ("a", "b", "c", "d")
Offsets: TypeAlias = float | Mapping[str, float] | None
# Makes counterweights of wanted first moments.
_Place: TypeAlias = Callable[[Mapping[str, complex]], dict[str, Counterweight]]


def case_counterweights(
    machine: Machine,
    case: Case,
    offsets: Offsets = None,
    *,
    density: float | None = None,
    thickness: float | None = None,
    fraction: float = 0.5,
) -> dict[str, Counterweight]:
    """Return the counterweights of a case of Smith's Fig. 20 by link.

    - ``"a"``: none.
    - ``"b"``: partial balance: each link that turns about the frame is balanced on its pivot.
    - ``"c"``: full force balance, the coupler with a counterweight of its own.  It is balanced at
      the crank pin, where its mass then counts as a point mass (slider-crank: the slider, as a
      point mass at C, is balanced with it); the crank is balanced with that mass on its pin, and a
      follower on D.
    - ``"d"``: full force balance of a four-bar with two counterweights: the coupler counts as two
      masses at B and C with its mass and its centre, complex ones where the centre lies beside the
      line BC (the conditions of Berkof and Lowen).  A quick-return is balanced fully by crank and
      rod, since block and rod turn together; ``"c"`` and ``"d"`` are the same there.
    - ``"reciprocating"``: a slider-crank's crank alone.  The coupler counts as two masses at B and
      C (exact for the shaking force).  What rotates is balanced wholly; of the primary force
      ``m r omega^2 cos theta`` of what reciprocates, a share is turned from the guide's direction
      across it.  Higher orders stay: a crank counterweight cannot reach them.

    Any links are allowed, straight or not; each counterweight lies where it must, opposite to a
    straight link's centre.

    Parameters
    ----------
    machine : Machine
        The unbalanced machine.
    case : {"a", "b", "c", "d", "reciprocating"}
        See above.
    offsets : float or mapping of str to float
        Distance [m] of the counterweights from the first joint of their links (A, B, D); by default
        the length of the link.
    density, thickness : float, optional
        Cylinders [kg/m^3, m] instead of point masses.
    fraction : float
        Share of the reciprocating mass that is balanced, of that case alone.

    Raises
    ------
    BadInput
        If there is no such case for the linkage, an offset is not positive, or the fraction is not
        finite.
    """
    known = (*CASES, "reciprocating")
    require_one_of("case", case, known)
    require_machine(machine)
    links = tuple(machine.linkage.links)
    if isinstance(offsets, Mapping):
        for link in offsets:
            require_one_of("offsets", link, links)

    def place(moments: Mapping[str, complex]) -> dict[str, Counterweight]:
        """Return counterweights with these first moments; none where there is nothing to do."""
        added = {}
        for link, wanted in ((link, moment) for link, moment in moments.items() if moment):
            given = offsets.get(link) if isinstance(offsets, Mapping) else offsets
            length = machine.linkage.lengths.get(link) if given is None else given
            offset = finite_number(length, f"offsets.{link}")
            if not offset > 0.0:
                raise bad(f"offsets.{link}", f"{offset:g}", "a distance above zero", "correct it")
            mass = abs(wanted) / offset
            at = wanted / mass
            added[link] = Counterweight(link, mass, at.real, at.imag, 0.0, density, thickness)
        return added

    if case == "a":
        return {}
    if case == "b":
        turning = [link for link in (links[0], links[-1]) if link != "slider"]
        return place({link: -_moment(machine, link) for link in turning})
    if case == "reciprocating":
        return _reciprocating(machine, place, finite_number(fraction, "fraction"))
    kinds = {"slider": _slider_crank, "rod": _quick_return, "follower": _four_bar}
    return kinds[links[-1]](machine, case, place)


def _moment(machine: Machine, link: str) -> complex:
    """Return the first moments of a link [kg m] as along + i across."""
    mass = machine.mass(link)
    return complex(mass.along, mass.across)


def _four_bar(machine: Machine, case: Case, place: _Place) -> dict[str, Counterweight]:
    lengths, follower = machine.linkage.lengths, _moment(machine, "follower")
    if case == "c":
        return _balanced_at_pin(machine, place, 0.0) | place({"follower": -follower})
    # The coupler's momentum is that of masses at B and C: mu/l3 at C, the rest at B.
    at_c = _moment(machine, "coupler") / lengths["coupler"]
    crank = _moment(machine, "crank") + (machine.mass("coupler").mass - at_c) * lengths["crank"]
    return place({"crank": -crank, "follower": -follower - at_c * lengths["follower"]})


def _slider_crank(machine: Machine, case: Case, place: _Place) -> dict[str, Counterweight]:
    if case == "d":
        fix = "use case 'c', or 'reciprocating' for a crank counterweight alone"
        raise bad("case", "'d' for a slider-crank", "case b, c or reciprocating", fix)
    # The slider does not turn: wherever its centre is, it moves as a point mass at C.
    return _balanced_at_pin(machine, place, machine.mass("slider").mass)


def _balanced_at_pin(machine: Machine, place: _Place, at_c: float) -> dict[str, Counterweight]:
    """Balance the coupler, with a mass at C, on the crank's pin, and the crank with all of them."""
    lengths = machine.linkage.lengths
    middle = place({"coupler": -_moment(machine, "coupler") - at_c * lengths["coupler"]})
    at_pin = at_c + machine.mass("coupler").mass + sum(weight.mass for weight in middle.values())
    return place({"crank": -_moment(machine, "crank") - at_pin * lengths["crank"]}) | middle


def _quick_return(machine: Machine, case: Case, place: _Place) -> dict[str, Counterweight]:
    # The block's mass sits on the crank pin; its first moments turn with the rod.
    block, length = machine.mass("block"), machine.linkage.lengths["crank"]
    rod = _moment(machine, "rod") + _moment(machine, "block")
    return place({"crank": -_moment(machine, "crank") - block.mass * length, "rod": -rod})


def _reciprocating(machine: Machine, place: _Place, fraction: float) -> dict[str, Counterweight]:
    if tuple(machine.linkage.links)[-1] != "slider":
        given = f"'reciprocating' for a {type(machine.linkage).__name__}"
        raise bad("case", given, "a SliderCrank", "use case b, c or d")
    lengths = machine.linkage.lengths
    at_c = _moment(machine, "coupler") / lengths["coupler"]
    rotating = _moment(machine, "crank") + (machine.mass("coupler").mass - at_c) * lengths["crank"]
    # An uneven share at C (a centre beside the line BC) is no mass: it stays out of the fraction.
    reciprocating = machine.mass("slider").mass + at_c.real
    return place({"crank": -(rotating + fraction * reciprocating * lengths["crank"])})
