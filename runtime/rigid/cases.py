"""The cases of Smith's Fig. 20: partial and full force balance by counterweights.

A link's first moments in its own frame are written as one complex number, along + i across.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

from ..core.errors import bad
from .counterweights import (
    Counterweight,
    finite_number,
    require_link,
    require_machine,
    with_counterweights,
)

if TYPE_CHECKING:
    from . import Machine

Case: TypeAlias = Literal["a", "b", "c", "d"]
CASES: tuple[Case, ...] = ("a", "b", "c", "d")


def balance_case(
    machine: Machine,
    case: Case,
    offsets: float | Mapping[str, float] | None = None,
    *,
    density: float | None = None,
    thickness: float | None = None,
) -> Machine:
    """Return the machine balanced as in one of the cases of Smith's Fig. 20.

    - ``"a"``: as it is.
    - ``"b"``: partial balance: each link that turns about the frame is balanced on its pivot.
    - ``"c"``: full force balance, the coupler with a counterweight of its own.  It is balanced at
      the crank pin, where its mass then counts as a point mass (slider-crank: the slider, as a
      point mass at C, is balanced with it); the crank is balanced with that mass on its pin, and a
      follower on D.
    - ``"d"``: full force balance of a four-bar with two counterweights: the coupler counts as two
      masses at B and C with its mass and its centre, complex ones where the centre lies beside the
      line BC (the conditions of Berkof and Lowen).  A quick-return is balanced fully by crank and
      rod, since block and rod turn together; ``"c"`` and ``"d"`` are the same there.

    Any links are allowed, straight or not; each counterweight lies where it must, opposite to a
    straight link's centre.

    Parameters
    ----------
    machine : Machine
        The unbalanced machine.
    case : {"a", "b", "c", "d"}
        See above.
    offsets : float or mapping of str to float
        Distance [m] of the counterweights from the first joint of their links (A, B, D); by default
        the length of the link.
    density, thickness : float, optional
        Cylinders [kg/m^3, m] instead of point masses.

    Returns
    -------
    Machine
        With the counterweights of :func:`case_counterweights`.

    Raises
    ------
    BadInput
        If there is no such case for the linkage, or an offset is not positive.
    """
    added = case_counterweights(machine, case, offsets, density=density, thickness=thickness)
    return with_counterweights(machine, added.values())


def fully_balanced(
    machine: Machine,
    offsets: float | Mapping[str, float] | None = None,
    *,
    counterweights: int = 2,
    density: float | None = None,
    thickness: float | None = None,
) -> Machine:
    """Return the machine without shaking force: case (d) with two counterweights, (c) with three.

    A slider-crank needs the counterweight on its coupler and has two in any case.

    Parameters
    ----------
    machine, offsets, density, thickness
        As :func:`balance_case`.
    counterweights : {2, 3}
        How many a four-bar gets.

    Raises
    ------
    BadInput
        As :func:`balance_case`, or for another number.
    """
    if counterweights not in (2, 3):
        raise bad("counterweights", repr(counterweights), "2 or 3", "choose one")
    require_machine(machine)
    sliding = tuple(machine.linkage.links)[-1] == "slider"
    case: Case = "c" if counterweights == 3 or sliding else "d"
    return balance_case(machine, case, offsets, density=density, thickness=thickness)


def case_counterweights(
    machine: Machine,
    case: Case,
    offsets: float | Mapping[str, float] | None = None,
    *,
    density: float | None = None,
    thickness: float | None = None,
) -> dict[str, Counterweight]:
    """Return the counterweights of a case by link; parameters as :func:`balance_case`.

    Raises
    ------
    BadInput
        As :func:`balance_case`.
    """
    if case not in CASES:
        raise bad("case", repr(case), f"one of {', '.join(CASES)}", "choose one")
    require_machine(machine)
    links = tuple(machine.linkage.links)
    if isinstance(offsets, Mapping):
        for link in offsets:
            require_link(link, links, "offsets")
    maker = _Maker(machine, offsets, density, thickness)
    if case == "a":
        return {}
    if case == "b":
        turning = [link for link in (links[0], links[-1]) if link != "slider"]
        return maker.made({link: -moment(machine, link) for link in turning})
    kinds: dict[str, Any] = {"slider": _slider_crank, "rod": _quick_return, "follower": _four_bar}
    return cast("dict[str, Counterweight]", kinds[links[-1]](machine, case, maker))


def moment(machine: Machine, link: str) -> complex:
    """Return the first moments of a link [kg m] as along + i across."""
    own = machine.mass(link)
    return complex(own.along, own.across)


class _Maker:
    """Makes counterweights of wanted first moments at given offsets."""

    def __init__(
        self,
        machine: Machine,
        offsets: float | Mapping[str, float] | None,
        density: float | None,
        thickness: float | None,
    ) -> None:
        self.machine, self.offsets = machine, offsets
        self.density, self.thickness = density, thickness

    def offset(self, link: str) -> float:
        """Return the offset of a link's counterweight."""
        given = self.offsets.get(link) if isinstance(self.offsets, Mapping) else self.offsets
        found: Any = self.machine.linkage.lengths.get(link) if given is None else given
        number = finite_number(found, f"offsets.{link}")
        if not number > 0.0:
            raise bad(f"offsets.{link}", f"{number:g}", "a distance above zero", "correct it")
        return number

    def made(self, moments: Mapping[str, complex]) -> dict[str, Counterweight]:
        """Return counterweights with these first moments; none where there is nothing to do."""
        return {link: self.one(link, wanted) for link, wanted in moments.items() if wanted}

    def one(self, link: str, wanted: complex) -> Counterweight:
        """Return the counterweight with a first moment, at the link's offset."""
        offset = self.offset(link)
        mass = abs(wanted) / offset
        place = wanted / mass
        body = {"density": self.density, "thickness": self.thickness}
        return Counterweight(link, mass, place.real, place.imag, 0.0, **body)


def _four_bar(machine: Machine, case: Case, maker: _Maker) -> dict[str, Counterweight]:
    lengths = machine.linkage.lengths
    coupler = machine.mass("coupler")
    crank, follower = moment(machine, "crank"), moment(machine, "follower")
    if case == "c":
        found = maker.made({"coupler": -moment(machine, "coupler")})
        at_pin = coupler.mass + sum(weight.mass for weight in found.values())
        crank += at_pin * lengths["crank"]
    else:
        # The coupler's momentum is that of masses at B and C: mu/l3 at C, the rest at B.
        at_c = moment(machine, "coupler") / lengths["coupler"]
        crank += (coupler.mass - at_c) * lengths["crank"]
        follower += at_c * lengths["follower"]
        found = {}
    return {**maker.made({"crank": -crank}), **found, **maker.made({"follower": -follower})}


def _slider_crank(machine: Machine, case: Case, maker: _Maker) -> dict[str, Counterweight]:
    if case == "d":
        fix = "use case 'c', or reciprocating_balance for a crank counterweight alone"
        raise bad("case", "'d' for a slider-crank", "case b or c", fix)
    lengths = machine.linkage.lengths
    slider, coupler = machine.mass("slider"), machine.mass("coupler")
    # The slider does not turn: wherever its centre is, it moves as a point mass at C.
    found = maker.made({"coupler": -moment(machine, "coupler") - slider.mass * lengths["coupler"]})
    at_pin = slider.mass + coupler.mass + sum(weight.mass for weight in found.values())
    return {**maker.made({"crank": -moment(machine, "crank") - at_pin * lengths["crank"]}), **found}


def _quick_return(machine: Machine, case: Case, maker: _Maker) -> dict[str, Counterweight]:
    # The block's mass sits on the crank pin; its first moments turn with the rod.
    crank = moment(machine, "crank") + machine.mass("block").mass * machine.linkage.lengths["crank"]
    rod = moment(machine, "rod") + moment(machine, "block")
    return maker.made({"crank": -crank, "rod": -rod})
