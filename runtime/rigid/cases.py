"""Counterweights in closed form: the cases of Smith's Fig. 20, and a slider-crank's crank alone.

A link's first moments in its own frame are written as one complex number, along + i across.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from ..core.errors import bad
from .counterweights import Counterweight
from .inputs import finite_number, require_link
from .machine import Machine, require_machine

Case: TypeAlias = Literal["a", "b", "c", "d", "reciprocating"]
CASES: tuple[Case, ...] = ("a", "b", "c", "d")
Offsets: TypeAlias = float | Mapping[str, float] | None


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
    if case not in known:
        raise bad("case", repr(case), f"one of {', '.join(known)}", "choose one")
    require_machine(machine)
    links = tuple(machine.linkage.links)
    if isinstance(offsets, Mapping):
        for link in offsets:
            require_link(link, links, "offsets")
    place = _Placing(machine, offsets, density, thickness)
    if case == "a":
        return {}
    if case == "b":
        turning = [link for link in (links[0], links[-1]) if link != "slider"]
        return place.all({link: -_moment(machine, link) for link in turning})
    if case == "reciprocating":
        return _reciprocating(machine, place, finite_number(fraction, "fraction"))
    kinds: dict[str, Any] = {"slider": _slider_crank, "rod": _quick_return, "follower": _four_bar}
    counterweights: dict[str, Counterweight] = kinds[links[-1]](machine, case, place)
    return counterweights


def _moment(machine: Machine, link: str) -> complex:
    """Return the first moments of a link [kg m] as along + i across."""
    mass = machine.mass(link)
    return complex(mass.along, mass.across)


@dataclass(frozen=True)
class _Placing:
    """Makes counterweights of wanted first moments at given offsets."""

    machine: Machine
    offsets: Offsets
    density: float | None
    thickness: float | None

    def all(self, moments: Mapping[str, complex]) -> dict[str, Counterweight]:
        """Return counterweights with these first moments; none where there is nothing to do."""
        return {link: self._one(link, wanted) for link, wanted in moments.items() if wanted}

    def _one(self, link: str, wanted: complex) -> Counterweight:
        given = self.offsets.get(link) if isinstance(self.offsets, Mapping) else self.offsets
        length = self.machine.linkage.lengths.get(link) if given is None else given
        offset = finite_number(length, f"offsets.{link}")
        if not offset > 0.0:
            raise bad(f"offsets.{link}", f"{offset:g}", "a distance above zero", "correct it")
        mass = abs(wanted) / offset
        at = wanted / mass
        body = {"density": self.density, "thickness": self.thickness}
        return Counterweight(link, mass, at.real, at.imag, 0.0, **body)


def _four_bar(machine: Machine, case: Case, place: _Placing) -> dict[str, Counterweight]:
    lengths = machine.linkage.lengths
    coupler = machine.mass("coupler")
    crank, follower = _moment(machine, "crank"), _moment(machine, "follower")
    if case == "c":
        middle = place.all({"coupler": -_moment(machine, "coupler")})
        at_pin = coupler.mass + sum(weight.mass for weight in middle.values())
        crank += at_pin * lengths["crank"]
    else:
        # The coupler's momentum is that of masses at B and C: mu/l3 at C, the rest at B.
        at_c = _moment(machine, "coupler") / lengths["coupler"]
        crank += (coupler.mass - at_c) * lengths["crank"]
        follower += at_c * lengths["follower"]
        middle = {}
    return {**place.all({"crank": -crank}), **middle, **place.all({"follower": -follower})}


def _slider_crank(machine: Machine, case: Case, place: _Placing) -> dict[str, Counterweight]:
    if case == "d":
        fix = "use case 'c', or 'reciprocating' for a crank counterweight alone"
        raise bad("case", "'d' for a slider-crank", "case b, c or reciprocating", fix)
    lengths = machine.linkage.lengths
    slider, coupler = machine.mass("slider"), machine.mass("coupler")
    # The slider does not turn: wherever its centre is, it moves as a point mass at C.
    middle = place.all({"coupler": -_moment(machine, "coupler") - slider.mass * lengths["coupler"]})
    at_pin = slider.mass + coupler.mass + sum(weight.mass for weight in middle.values())
    return {
        **place.all({"crank": -_moment(machine, "crank") - at_pin * lengths["crank"]}),
        **middle,
    }


def _quick_return(machine: Machine, case: Case, place: _Placing) -> dict[str, Counterweight]:
    # The block's mass sits on the crank pin; its first moments turn with the rod.
    crank = (
        _moment(machine, "crank") + machine.mass("block").mass * machine.linkage.lengths["crank"]
    )
    rod = _moment(machine, "rod") + _moment(machine, "block")
    return place.all({"crank": -crank, "rod": -rod})


def _reciprocating(machine: Machine, place: _Placing, fraction: float) -> dict[str, Counterweight]:
    if tuple(machine.linkage.links)[-1] != "slider":
        given = f"'reciprocating' for a {type(machine.linkage).__name__}"
        raise bad("case", given, "a SliderCrank", "use case b, c or d")
    lengths = machine.linkage.lengths
    at_c = _moment(machine, "coupler") / lengths["coupler"]
    rotating = _moment(machine, "crank") + (machine.mass("coupler").mass - at_c) * lengths["crank"]
    # An uneven share at C (a centre beside the line BC) is no mass: it stays out of the fraction.
    reciprocating = machine.mass("slider").mass + at_c.real
    return place.all({"crank": -(rotating + fraction * reciprocating * lengths["crank"])})
