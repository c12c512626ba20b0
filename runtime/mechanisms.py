"""Mechanisms at run time: lengths and assembly, and the motion that they have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..generated import four_bar_kinematics
from .errors import BadInput, Problem, bad
from .results import Check, Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Assembly = Literal["open", "crossed"]


@dataclass(frozen=True, kw_only=True)
class Motion(Result):
    """Motion of a four-bar linkage at given crank angles; every array has their shape.

    Attributes
    ----------
    theta2, theta3, theta4 : ndarray
        Angles of crank, coupler and follower [rad], continuous over any number of turns.
    omega3, omega4 : ndarray
        Angular speeds over the crank's.
    alpha3, alpha4 : ndarray
        Angular accelerations over the crank speed squared, at constant crank speed.
    transmission_angle : ndarray
        Angle between coupler and follower [rad], from 0 to pi.
    """

    theta2: Array
    theta3: Array
    theta4: Array
    omega3: Array
    omega4: Array
    alpha3: Array
    alpha4: Array
    transmission_angle: Array

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw follower angle, speed and acceleration against the crank angle."""
        from .plotting import axes_or_new

        ax = axes_or_new(ax)
        degrees = np.degrees(self.theta2)
        for name, label in (
            ("theta4", r"$\theta_4$ [rad]"),
            ("omega4", r"$\omega_4/\omega_2$"),
            ("alpha4", r"$\alpha_4/\omega_2^2$"),
            ("omega3", r"$\omega_3/\omega_2$"),
        ):
            ax.plot(degrees, getattr(self, name), label=label)
        ax.set_xlabel("crank angle [deg]")
        ax.legend()
        return ax


@dataclass(frozen=True)
class FourBar:
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
    """

    frame: float
    crank: float
    coupler: float
    follower: float
    assembly: Assembly = "open"

    names: ClassVar[tuple[str, ...]] = ("frame", "crank", "coupler", "follower")

    def __post_init__(self) -> None:
        """Check the lengths."""
        problems = [
            Problem(f"FourBar.{name}", repr(value), "a positive finite length", "correct it")
            for name, value in self.lengths.items()
            if not (np.isfinite(value) and value > 0)
        ]
        if self.assembly not in ("open", "crossed"):
            problems.append(
                Problem(
                    "FourBar.assembly", repr(self.assembly), "'open' or 'crossed'", "choose one"
                )
            )
        if not problems:
            longest = max(self.lengths, key=lambda name: self.lengths[name])
            rest = sum(self.lengths.values()) - self.lengths[longest]
            if self.lengths[longest] >= rest:
                problems.append(
                    Problem(
                        f"FourBar.{longest}",
                        f"{self.lengths[longest]:g}",
                        f"less than {rest:g}, the sum of the other three",
                        "the linkage cannot close; shorten this link or lengthen another",
                    )
                )
        if problems:
            raise BadInput(*problems)

    @property
    def lengths(self) -> Mapping[str, float]:
        """Lengths by name."""
        return {name: getattr(self, name) for name in self.names}

    @property
    def branch(self) -> float:
        """+1 for the open assembly, -1 for the crossed one."""
        return 1.0 if self.assembly == "open" else -1.0

    @property
    def reach(self) -> tuple[float, float]:
        """Shortest and longest diagonal BD that coupler and follower allow."""
        return abs(self.coupler - self.follower), self.coupler + self.follower

    @property
    def crank_turns(self) -> bool:
        """True where the crank can turn fully without passing a change point."""
        shortest, longest = self.reach
        return bool(abs(self.frame - self.crank) > shortest and self.frame + self.crank < longest)

    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully."""
        if not self.crank_turns:
            shortest, longest = self.reach
            raise bad(
                "FourBar",
                f"diagonals from {abs(self.frame - self.crank):g} to {self.frame + self.crank:g}",
                f"diagonals strictly between {shortest:g} and {longest:g}",
                "the crank cannot turn fully; change a length",
            )

    def motion(self, theta: ArrayLike) -> Motion:
        """Return the motion of coupler and follower (Smith 2.2, 2.7, 2.10).

        Parameters
        ----------
        theta : array_like
            Crank angle [rad], any shape.

        Returns
        -------
        Motion
            Every array has the shape of ``theta``.

        Raises
        ------
        BadInput
            If an angle is not finite, or the linkage cannot reach it.
        """
        angles = np.asarray(theta, dtype=float)
        self._require_reachable(angles)
        values = four_bar_kinematics.motion(
            angles, **self.lengths, assembly=self.branch, winding=float(self.crank > self.frame)
        )
        theta3, theta4, *rest = (np.asarray(value, dtype=float) for value in values)
        closure = self._closure(angles, theta3, theta4)
        unit = np.finfo(float).eps
        # A dead centre amplifies the last digit of a length by 1/sin(transmission angle).
        gain = 1.0 / np.min(np.abs(np.sin(rest[-1])), initial=1.0)
        turns = np.max(np.abs(angles), initial=1.0)
        return Motion(
            theta2=angles,
            theta3=theta3,
            theta4=theta4,
            omega3=rest[0],
            omega4=rest[1],
            alpha3=rest[2],
            alpha4=rest[3],
            transmission_angle=rest[4],
            method="closed form",
            error=float(32 * unit * turns * gain),
            error_norm="angles [rad], largest absolute",
            checks={"loop closure over longest link": Check(closure, float(64 * unit * turns))},
        )

    def _closure(self, theta2: Array, theta3: Array, theta4: Array) -> float:
        gap = (
            self.crank * np.exp(1j * theta2)
            + self.coupler * np.exp(1j * theta3)
            - self.frame
            - self.follower * np.exp(1j * theta4)
        )
        return float(np.max(np.abs(gap), initial=0.0) / max(self.lengths.values()))

    def _require_reachable(self, theta: Array) -> None:
        if not np.all(np.isfinite(theta)):
            raise bad("theta", "a value that is not finite", "finite angles", "remove it")
        if self.crank_turns:
            return
        # Both differences of squares as sums that do not cancel, as in the emitted form.
        cos2, sin2 = np.cos(theta / 2) ** 2, np.sin(theta / 2) ** 2
        shortest, longest = self.reach
        near, far = abs(self.frame - self.crank), self.frame + self.crank
        over = (near - shortest) * (near + shortest) * cos2 + (far - shortest) * (
            far + shortest
        ) * sin2
        under = (longest - near) * (longest + near) * cos2 + (longest - far) * (
            longest + far
        ) * sin2
        outside = ~((over > 0) & (under > 0))
        if np.any(outside):
            worst = float(np.ravel(theta)[np.argmax(np.ravel(outside))])
            raise bad(
                "theta",
                f"{worst:.6g} rad",
                f"a diagonal BD between {shortest:g} and {longest:g}",
                "this linkage's crank is a rocker; keep theta inside its range",
            )
