"""The slider-crank: lengths, offset and assembly, and the motion that they have."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...generated import slider_crank_kinematics
from ..core.errors import Problem, bad
from .linkage import ROUNDED, TINY, Array, Limits, Linkage, LinkMotion, Motion, Terms, pair, turning


@dataclass(frozen=True, kw_only=True)
class SliderCrankMotion(Motion, kinematics=slider_crank_kinematics):
    """Motion of a slider-crank at given crank angles; every array has their shape.

    ``error`` has it too: that of the worse of theta3 [rad] and of the position over the
    longest length, from the round-off of crank angle and lengths that the place passes on; it grows
    where the coupler nearly stands across the guide.

    Attributes
    ----------
    theta3 : ndarray
        Coupler angle from B to C [rad]: between -pi/2 and pi/2 in the open assembly, between pi/2
        and 3 pi/2 in the crossed one.
    position : ndarray
        Place of the slider's pin C along the guide [m].
    omega3, alpha3 : ndarray
        Speed and acceleration of the coupler [rad/s, rad/s^2]; without a crank speed, over the
        crank's and its square.
    slider_velocity, slider_acceleration : ndarray
        Of the slider along the guide [m/s, m/s^2]; without a crank speed, over the crank's and its
        square.
    transmission_angle : ndarray
        Angle between the coupler and the normal of the guide [rad], from 0 to pi; the pull of the
        coupler turns into that of the slider best at pi/2.
    """

    theta3: Array
    position: Array
    omega3: Array
    alpha3: Array
    slider_velocity: Array
    slider_acceleration: Array
    transmission_angle: Array

    norm = "worse of theta3 [rad] and position over the longest length"
    drawn = ("position", "slider_velocity", "slider_acceleration")

    def _other_link(self, name: str) -> LinkMotion:
        if name == "coupler":
            return self._at_crank_pin(self.theta3, self.omega3, self.alpha3)
        still = np.zeros(np.shape(self.theta2))
        pin = pair(self.position, self.linkage.lengths["offset"])
        velocity, change = pair(self.slider_velocity, 0.0), pair(self.slider_acceleration, 0.0)
        return LinkMotion(pin, velocity, change, still, still, still)


@dataclass(frozen=True)
class SliderCrank(Linkage):
    """Slider-crank ABC: crank AB, coupler BC, and a slider whose pin C moves along ``y = offset``.

    Parameters
    ----------
    crank, coupler : float
        Lengths, in one unit.
    offset : float
        Height of the guide over the crank's pivot A; negative below it.
    assembly : {"open", "crossed"}
        The slider to the right or to the left of B.

    Raises
    ------
    BadInput
        If a length is not a positive number, or crank and coupler cannot reach the guide.

    Examples
    --------
    >>> import elastolink as el
    >>> motion = el.SliderCrank(crank=0.1, coupler=0.3).motion(theta=[0.0, 1.0], speed=20.0)
    >>> print(motion.position.round(3), motion.slider_acceleration.round(2))
    [0.4   0.342] [-53.33 -16.18]
    """

    crank: float
    coupler: float
    offset: float = 0.0
    assembly: Literal["open", "crossed"] = "open"

    mechanism = "slider_crank"
    moves = SliderCrankMotion
    names = ("crank", "coupler", "offset")
    links = ("crank", "coupler", "slider")
    bars: ClassVar = {"crank": ("A", "B"), "coupler": ("B", "C"), "slider": ("C",)}
    fold_axis = -np.pi / 2.0

    def _gaping(self) -> list[Problem]:
        # Each factor is zero where the links just reach the guide, correctly rounded.
        if min(self.limits.one_less_q1, self.limits.q2) > 0.0:
            return []
        expected = f"less than {self.crank + self.coupler:g} in magnitude, crank and coupler"
        fix = "they cannot reach the guide; bring it nearer or lengthen one of them"
        return [Problem("SliderCrank.offset", f"{self.offset:g}", expected, fix)]

    @property
    def limits(self) -> Limits:
        """Where the loop can close: where the coupler comes to stand across the guide."""
        c, m, e = self.unit_lengths.values()
        factors = ((c, e, -m), (c, m, -e), (c, m, e), (c, -e, -m))
        return Limits(*(math.fsum(terms) / (2.0 * max(c, TINY)) for terms in factors))

    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully, or does by rounding alone."""
        crank, coupler, offset = self.unit_lengths.values()
        gap = math.fsum((coupler, -crank, -abs(offset)))
        equal = abs(gap) <= ROUNDED * coupler
        if equal or not self.crank_turns:
            found = f"coupler {self.coupler:g} for crank {self.crank:g} and offset {self.offset:g}"
            expected = f"a coupler above {self.crank + abs(self.offset):g}"
            where = "at this change point, coupler = crank + offset, " if equal else ""
            fix = f"{where}the crank cannot turn fully; change a length"
            raise bad("SliderCrank", found, expected, fix)

    def motion(
        self, theta: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
    ) -> SliderCrankMotion:
        """Return the motion of coupler and slider; see :meth:`Linkage.motion`."""
        return self._moved(SliderCrankMotion, theta, speed, acceleration)

    def _blur(self, m: Mapping[str, Array]) -> Array:
        crank, coupler, offset = self.unit_lengths.values()
        sine = np.abs(np.cos(m["transmission_angle"]))
        moved = abs(offset) + crank * np.abs(np.sin(m["theta2"])) + coupler * sine
        across = np.abs(np.sin(m["transmission_angle"]))
        return np.asarray(moved / (coupler * across))

    def _error(self, m: Mapping[str, Array]) -> Array:
        # A change of a length across the guide moves the slider by its product with the tangent.
        crank, coupler, offset = self.unit_lengths.values()
        theta2, blur = m["theta2"], self._blur(m)
        turned = np.abs(theta2 * m["omega3"]) + np.abs(m["theta3"]) + blur
        along = crank * np.abs(np.cos(theta2)) + coupler * np.abs(np.cos(m["theta3"]))
        moved = np.abs(theta2 * m["slider_velocity"]) + np.abs(m["position"]) + along
        moved = moved + blur * coupler * np.abs(np.cos(m["transmission_angle"]))
        longest = max(crank, coupler, abs(offset))
        return np.asarray(np.maximum(turned, moved / longest))

    def _loop(self, m: Mapping[str, Array]) -> Terms:
        crank, coupler, offset = self.unit_lengths.values()
        terms = zip(
            turning(crank, m["theta2"], 1.0, 0.0),
            turning(coupler, m["theta3"], m["omega3"], m["alpha3"]),
            (-m["position"], -m["slider_velocity"], -m["slider_acceleration"]),
            strict=True,
        )
        places, speeds, changes = (list(item) for item in terms)
        return [*places, -1j * offset], speeds, changes
