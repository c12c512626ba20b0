"""The quick-return mechanism: lengths, and the motion of its rod and sliding block."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ...generated import quick_return_kinematics
from ..core.errors import Problem, bad
from .linkage import ROUNDED, TINY, Array, Limits, Linkage, LinkMotion, Motion, Terms, turning


@dataclass(frozen=True, kw_only=True)
class QuickReturnMotion(Motion, kinematics=quick_return_kinematics):
    """Motion of a quick-return at given crank angles; every array has their shape.

    ``error`` has it too: that of the worse of theta4 [rad] and of the slide over its
    greatest value, from the round-off of crank angle and lengths that the place passes on; it grows
    where the block comes near the rod's pivot.

    Attributes
    ----------
    theta4 : ndarray
        Rod angle from D to B [rad], continuous over any number of turns.
    slide : ndarray
        Distance DB of the block along the rod [m].
    omega4, alpha4 : ndarray
        Speed and acceleration of the rod [rad/s, rad/s^2]; without a crank speed, over the crank's
        and its square.
    slide_velocity, slide_acceleration : ndarray
        First and second derivative of ``slide`` by time [m/s, m/s^2]; without a crank speed, by the
        crank angle.
    """

    theta4: Array
    slide: Array
    omega4: Array
    alpha4: Array
    slide_velocity: Array
    slide_acceleration: Array

    norm = "worse of theta4 [rad] and slide over its greatest value"
    drawn = ("theta4", "omega4", "alpha4")

    def _other_link(self, name: str) -> LinkMotion:
        if name == "block":
            return self._at_crank_pin(self.theta4, self.omega4, self.alpha4)
        return self._about(-self.linkage.lengths["frame"], self.theta4, self.omega4, self.alpha4)


@dataclass(frozen=True)
class QuickReturn(Linkage):
    """Quick-return: crank AB, a block at B, and a rod about D along which the block slides.

    A is the origin and D lies a distance ``frame`` to its left.

    Parameters
    ----------
    frame : float
        Distance DA of the two fixed pivots.
    crank : float
        Length AB.
    rod : float
        Length of the rod from D to its tip; beyond it the block has no hold.

    Raises
    ------
    BadInput
        If a length is not a positive number or the rod does not reach the block at all.

    Examples
    --------
    >>> import elastolink as el
    >>> shaper = el.QuickReturn(frame=0.3, crank=0.1, rod=0.6)
    >>> print(round(el.transmission_angle(shaper).time_ratio, 3))
    1.552
    """

    frame: float
    crank: float
    rod: float

    mechanism = "quick_return"
    moves = QuickReturnMotion
    names = ("frame", "crank", "rod")
    links = ("crank", "block", "rod")
    bars: ClassVar = {"crank": ("A", "B"), "block": ("B",), "rod": ("D", "C")}

    def _gaping(self) -> list[Problem]:
        if self._ends[0] > 0.0:
            return []
        expected = f"more than {abs(self.frame - self.crank):g}, the least distance DB"
        fix = "the rod never reaches the block; lengthen it"
        return [Problem("QuickReturn.rod", f"{self.rod:g}", expected, fix)]

    @property
    def eps(self) -> float:
        """Crank over frame: below 1 the rod swings, above 1 it turns with the crank."""
        return self.crank / self.frame

    @property
    def limits(self) -> Limits:
        """Where block and rod meet: between the rod's tip and, with eps = 1, its pivot."""
        frame, crank, rod = self.unit_lengths.values()
        longer, shorter = self._ends
        across, along = (2.0 * max(size, TINY) for size in (frame, crank))
        apart = (frame - crank) / across * ((frame - crank) / along)
        lower = -1.0, 2.0
        if not self._long_enough:
            most, least = (frame + crank + rod) / along, (rod + abs(frame - crank)) / along
            lower = shorter / across * most, longer / across * least
        return Limits(*lower, 1.0 + apart, -apart)

    @property
    def _long_enough(self) -> bool:
        frame, crank, _ = self.unit_lengths.values()
        # A rod given as the sum of the two, rounded, is long enough.
        return self._ends[1] <= ROUNDED * (frame + crank)

    @property
    def _ends(self) -> tuple[float, float]:
        """By how much the rod is longer than the least, and shorter than the greatest DB."""
        # Correctly rounded, so that no round-off can change their signs.
        frame, crank, rod = self.unit_lengths.values()
        far, near = max(frame, crank), min(frame, crank)
        return math.fsum((rod, near, -far)), math.fsum((far, near, -rod))

    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully, or does by rounding alone."""
        if abs(self.frame - self.crank) <= ROUNDED * self.frame:
            found = f"{self.crank:g}, as long as the frame (eps = 1)"
            fix = (
                "the block passes the rod's pivot, where the rod's angle is not defined; change it"
            )
            raise bad("QuickReturn.crank", found, "another length", fix)
        if not self._long_enough:
            expected = f"at least {self.frame + self.crank:g}, frame and crank"
            fix = "the block leaves the rod; lengthen it"
            raise bad("QuickReturn.rod", f"{self.rod:g}", expected, fix)

    def motion(
        self, theta: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
    ) -> QuickReturnMotion:
        """Return the motion of rod and block; see :meth:`Linkage.motion`."""
        return self._moved(QuickReturnMotion, theta, speed, acceleration)

    def _blur(self, m: Mapping[str, Array]) -> Array:
        frame, crank, rod = self.unit_lengths.values()
        moved = frame * np.abs(np.sin(m["theta4"]))
        moved = moved + crank * np.abs(np.sin(m["theta2"] - m["theta4"]))
        return np.where(m["slide"] <= rod * (1.0 + ROUNDED), moved / m["slide"], np.inf)

    def _error(self, m: Mapping[str, Array]) -> Array:
        frame, crank, _ = self.unit_lengths.values()
        theta2, theta4 = m["theta2"], m["theta4"]
        turned = np.abs(theta2 * m["omega4"]) + np.abs(theta4) + self._blur(m)
        moved = np.abs(theta2 * m["slide_velocity"]) + m["slide"] + frame * np.abs(np.cos(theta4))
        moved = moved + crank * np.abs(np.cos(theta2 - theta4))
        return np.asarray(np.maximum(turned, moved / (frame + crank)))

    def _loop(self, m: Mapping[str, Array]) -> Terms:
        frame, crank, _ = self.unit_lengths.values()
        ahead, w, a = np.exp(1j * m["theta4"]), m["omega4"], m["alpha4"]
        pin = turning(-crank, m["theta2"], 1.0, 0.0)
        x, v = m["slide"] * ahead, m["slide_velocity"] * ahead
        speeds = [v, 1j * w * x, pin[1]]
        # Sliding, Coriolis, tangential and centripetal parts.
        changes = [m["slide_acceleration"] * ahead, 2j * w * v, 1j * a * x, -(w**2) * x, pin[2]]
        return [x, pin[0], -frame], speeds, changes
