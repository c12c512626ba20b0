"""The four-bar linkage: lengths and assembly, and the motion that they have."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...generated import four_bar_kinematics
from ..core.errors import Problem, bad
from .linkage import ROUNDED, TINY, Array, Limits, Linkage, LinkMotion, Motion, Terms, turning


class LoopSums(NamedTuple):
    """Sums of the four lengths of a loop ABCD.

    ``less_x`` is the sum of the other three less x, ``two``, ``three`` and ``four`` are frame +
    crank, frame + coupler and frame + follower less the other two.
    """

    total: Any
    less_frame: Any
    less_crank: Any
    less_coupler: Any
    less_follower: Any
    two: Any
    three: Any
    four: Any

    @classmethod
    def of(cls, lengths: Iterable[Any], add: Callable[[Any], Any]) -> LoopSums:
        """Return the sums of frame, crank, coupler and follower by a function that adds."""
        a, b, c, d = lengths
        less = (-a, b, c, d), (a, -b, c, d), (a, b, -c, d), (a, b, c, -d)
        pairs = (a, b, -c, -d), (a, -b, c, -d), (a, -b, -c, d)
        return cls(add((a, b, c, d)), *map(add, less), *map(add, pairs))

    @property
    def less(self) -> tuple[Any, ...]:
        """The sums of three links less the other one: positive where they close and can move."""
        return self[1:5]

    @property
    def pairs(self) -> tuple[Any, ...]:
        """The sums of the frame and another link less the other two."""
        return self[5:]


@dataclass(frozen=True, kw_only=True)
class FourBarMotion(Motion, kinematics=four_bar_kinematics):
    """Motion of a four-bar linkage at given crank angles; every array has their shape.

    ``error`` has it too: that of the worse of theta3 and theta4 [rad], from the round-off of crank
    angle and lengths that the position passes on; it grows near a dead centre.

    Attributes
    ----------
    theta3, theta4 : ndarray
        Angles of coupler and follower [rad], continuous over any number of turns.
    omega3, omega4 : ndarray
        Angular speeds [rad/s]; without a crank speed, over the crank's.
    alpha3, alpha4 : ndarray
        Angular accelerations [rad/s^2]; without a crank speed, over its square and at constant
        crank speed.
    transmission_angle : ndarray
        Angle between coupler and follower [rad], from 0 to pi.
    """

    theta3: Array
    theta4: Array
    omega3: Array
    omega4: Array
    alpha3: Array
    alpha4: Array
    transmission_angle: Array

    norm = "worse of theta3 and theta4 [rad]"
    drawn = ("theta4", "omega4", "alpha4", "omega3")

    def _other_link(self, name: str) -> LinkMotion:
        if name == "coupler":
            return self._at_crank_pin(self.theta3, self.omega3, self.alpha3)
        return self._about(self.linkage.lengths["frame"], self.theta4, self.omega4, self.alpha4)


@dataclass(frozen=True)
class FourBar(Linkage):
    """Four-bar linkage ABCD: frame AD, crank AB, coupler BC, follower DC (Smith Fig. 1).

    Parameters
    ----------
    frame, crank, coupler, follower : float
        Lengths, all in one unit; with flexible links in metres.
    assembly : {"open", "crossed"}
        Which of the two closures: C to the left or to the right of the line from B to D.

    Raises
    ------
    BadInput
        If a length is not a positive number or the four cannot close.

    Examples
    --------
    >>> import elastolink as el
    >>> linkage = el.FourBar(frame=12.0, crank=6.0, coupler=12.0, follower=12.0)
    >>> print(linkage.motion(theta=[0.0, 1.0]).transmission_angle.round(4))
    [0.5054 0.8696]
    """

    frame: float
    crank: float
    coupler: float
    follower: float
    assembly: Literal["open", "crossed"] = "open"

    mechanism = "four_bar"
    moves = FourBarMotion
    names = ("frame", "crank", "coupler", "follower")
    links = ("crank", "coupler", "follower")
    bars: ClassVar = {"crank": ("A", "B"), "coupler": ("B", "C"), "follower": ("D", "C")}

    def _gaping(self) -> list[Problem]:
        # Exact, as the class is: a sum in floats may close what cannot close.
        spare = min(LoopSums.of(map(Fraction, map(float, self.lengths.values())), sum).less)
        if spare > 0:
            return []
        longest = max(self.lengths, key=lambda name: self.lengths[name])
        rest = sum(self.lengths.values()) - self.lengths[longest]
        why = "cannot close" if spare < 0 else "is stretched and cannot move"
        expected = f"less than {rest:g}, the sum of the other three"
        fix = f"the linkage {why}; shorten this link or lengthen another"
        return [Problem(f"FourBar.{longest}", f"{self.lengths[longest]:g}", expected, fix)]

    @property
    def reach(self) -> tuple[float, float]:
        """Shortest and longest diagonal BD that coupler and follower allow."""
        return abs(self.coupler - self.follower), self.coupler + self.follower

    @property
    def sums(self) -> LoopSums:
        """Sums of ``unit_lengths``, each correctly rounded."""
        return LoopSums.of(self.unit_lengths.values(), math.fsum)

    @property
    def limits(self) -> Limits:
        """Where the loop can close: where coupler and follower come into one line."""
        s = self.sums
        frame, crank = (2.0 * max(self.unit_lengths[name], TINY) for name in ("frame", "crank"))
        factors = (
            (0.0 - s.four, s.three),
            (s.less_coupler, s.less_follower),
            (s.less_frame, s.less_crank),
            (s.two, s.total),
        )
        return Limits(*(one / frame * (other / crank) for one, other in factors))

    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully, or does by rounding alone."""
        sums = self.sums
        sides = (
            "frame + crank = coupler + follower",
            "frame + coupler = crank + follower",
            "frame + follower = crank + coupler",
        )
        equal = [
            side
            for side, gap in zip(sides, sums.pairs, strict=True)
            if abs(gap) <= ROUNDED * sums.total
        ]
        if equal or not self.crank_turns:
            near, far = abs(self.frame - self.crank), self.frame + self.crank
            found = f"diagonals from {near:g} to {far:g}"
            shortest, longest = self.reach
            expected = f"diagonals strictly between {shortest:g} and {longest:g}"
            where = f"at this change point, {equal[0]}, " if equal else ""
            fix = f"{where}the crank cannot turn fully; change a length"
            raise bad("FourBar", found, expected, fix)

    def motion(
        self, theta: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
    ) -> FourBarMotion:
        """Return the motion of coupler and follower; see :meth:`Linkage.motion`."""
        return self._moved(FourBarMotion, theta, speed, acceleration)

    @property
    def reachable(self) -> str:
        """Which diagonals and crank angles there are, in words."""
        shortest, longest = self.reach
        return f"a diagonal BD between {shortest:g} and {longest:g}, {super().reachable}"

    def _error(self, m: Mapping[str, Array]) -> Array:
        # A change of a length moves the closure along that link; seen along coupler or follower it
        # turns the other one, the more the closer the two are to one line.  The triangle BCD comes
        # from the square of BD: its round-off moves C, seen from a short link most.
        frame, crank, coupler, follower = self.unit_lengths.values()
        theta2 = m["theta2"]
        aligned = np.abs(np.cos(m["theta4"] - m["theta3"]))
        sine = np.abs(np.sin(m["transmission_angle"]))
        square = (frame - crank) ** 2 + 4.0 * frame * crank * np.sin(theta2 / 2.0) ** 2
        leaning = np.sqrt(square) * aligned
        lying = (1.0 + abs(coupler - follower) * (coupler + follower) / square) * sine**2 / 2.0
        errors = []
        for link, other, length, opposite in (
            ("3", "4", coupler, follower),
            ("4", "3", follower, coupler),
        ):
            beside = m["theta" + other]
            moved = crank * np.abs(np.cos(theta2 - beside)) + frame * np.abs(np.cos(beside))
            # Round-offs of the square of BD and of the area of the triangle BCD, thrice a unit
            # each.
            moved += length * aligned + opposite + 2.0 * (leaning + opposite * lying)
            turned = np.abs(theta2 * m["omega" + link]) + np.abs(m["theta" + link])
            errors.append(turned + moved / (length * sine))
        return np.asarray(np.maximum(*errors))

    def _loop(self, m: Mapping[str, Array]) -> Terms:
        frame, crank, coupler, follower = self.unit_lengths.values()
        terms = zip(
            turning(crank, m["theta2"], 1.0, 0.0),
            turning(coupler, m["theta3"], m["omega3"], m["alpha3"]),
            turning(-follower, m["theta4"], m["omega4"], m["alpha4"]),
            strict=True,
        )
        places, speeds, changes = (list(item) for item in terms)
        return [*places, -frame], speeds, changes
