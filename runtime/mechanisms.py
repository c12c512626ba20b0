"""Mechanisms at run time: lengths and assembly, and the motion that they have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..generated import four_bar_kinematics
from .errors import BadInput, Problem, bad
from .results import Check, Result, provenance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Assembly = Literal["open", "crossed"]

# However large the angles, a loop that gapes wider than this is no motion.
_WIDEST_GAP = 1e-8


@dataclass(frozen=True, kw_only=True)
class Motion(Result):
    """Motion of a four-bar linkage at given crank angles; every array has their shape.

    ``error`` has it too: the figure for the worse of theta3 and theta4 [rad], from the round-off of
    crank angle and lengths that the position passes on; it grows near a dead centre.

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
            if not (isinstance(value, Real) and 0 < value < np.inf)
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
    def _unit_lengths(self) -> dict[str, float]:
        """Lengths below 1, scaled by a power of two: their digits stay, their squares are safe."""
        exponent = -int(np.frexp(max(self.lengths.values()))[1])
        return {name: float(np.ldexp(value, exponent)) for name, value in self.lengths.items()}

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

        At ``theta = 0`` theta3 and theta4 lie between -pi and pi; from there they are continuous
        over any number of turns.

        Parameters
        ----------
        theta : array_like
            Crank angle [rad], any shape.

        Returns
        -------
        Motion
            Every array has the shape of ``theta``.  The check "folds within the angles" fails
            where coupler and follower come into one line between the least and the greatest
            angle: the motion is not continuous there, or it may leave by the other branch.

        Raises
        ------
        BadInput
            If an angle is not a finite number, or the linkage cannot reach it or folds there.
        """
        angles = _finite(theta)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            values = _MOTION(
                angles,
                **self._unit_lengths,
                assembly=self.branch,
                winding=float(self.crank > self.frame),
            )
        arrays: dict[str, Any] = dict(zip(_OUTPUTS, map(np.asarray, values), strict=True))
        self._require_reached(angles, arrays)
        closure = self._closure(angles, arrays["theta3"], arrays["theta4"])
        limit = 64 * np.finfo(float).eps * np.max(np.abs(angles), initial=1.0)
        checks = {
            "loop closure over longest link": Check(closure, min(float(limit), _WIDEST_GAP)),
            "folds within the angles": Check(float(self._folds(angles)), 0.0),
        }
        return Motion(
            theta2=angles,
            **arrays,
            method="closed form",
            error=self._angle_error(angles, arrays),
            error_norm="worse of theta3 and theta4 [rad], absolute, entrywise",
            checks=checks,
            provenance=provenance(
                {
                    **{f"links.{name}": repr(float(size)) for name, size in self.lengths.items()},
                    "links.assembly": self.assembly,
                }
            ),
        )

    def _folds(self, theta: Array) -> int:
        """Count the angles between the least and the greatest where BD has its extreme length."""
        if self.crank_turns or theta.size == 0:
            return 0
        frame, crank, coupler, follower = self._unit_lengths.values()
        near, far = abs(frame - crank), frame + crank
        low, high = float(theta.min()), float(theta.max())
        found: set[float] = set()
        for reach in (abs(coupler - follower), coupler + follower):
            if not near <= reach <= far:
                continue
            square = (reach - near) * (reach + near) / (4.0 * frame * crank)
            fold = 2.0 * float(np.arcsin(np.sqrt(min(square, 1.0))))
            for start in (fold, -fold):
                # The first one beyond the least angle is enough to know.
                first = start + 2.0 * np.pi * (np.floor((low - start) / (2.0 * np.pi)) + 1.0)
                found.update([float(first)] if low < first < high else [])
        return len(found)

    def _angle_error(self, theta2: Array, m: Mapping[str, Array]) -> Array:
        """Return what a unit round-off of the angle and of each length does, three times.

        A change of a length moves the closure along that link; seen along coupler or follower it
        turns the other one, the more the closer the two are to one line.
        """
        frame, crank, coupler, follower = self._unit_lengths.values()
        aligned = np.abs(np.cos(m["theta4"] - m["theta3"]))
        sine = np.abs(np.sin(m["transmission_angle"]))
        figures = []
        for link, other, own, opposite in (
            ("3", "4", coupler, follower),
            ("4", "3", follower, coupler),
        ):
            beside = m["theta" + other]
            moved = crank * np.abs(np.cos(theta2 - beside)) + frame * np.abs(np.cos(beside))
            moved += own * aligned + opposite
            turned = np.abs(theta2 * m["omega" + link]) + np.abs(m["theta" + link])
            figures.append(turned + moved / (own * sine))
        return np.asarray(1.5 * np.finfo(float).eps * np.maximum(*figures))

    def _closure(self, theta2: Array, theta3: Array, theta4: Array) -> float:
        frame, crank, coupler, follower = self._unit_lengths.values()
        gap = (
            crank * np.exp(1j * theta2)
            + coupler * np.exp(1j * theta3)
            - frame
            - follower * np.exp(1j * theta4)
        )
        longest = max(self._unit_lengths.values())
        return float(np.max(np.abs(gap), initial=0.0) / longest)

    def _require_reached(self, theta: Array, arrays: Mapping[str, Array]) -> None:
        """Raise BadInput where coupler and follower did not meet, or lie in one line."""
        reached = np.logical_and.reduce([np.isfinite(value) for value in arrays.values()])
        if not np.all(reached):
            shortest, longest = self.reach
            first = float(np.ravel(theta)[np.argmin(np.ravel(reached))])
            raise bad(
                "theta",
                f"{first:.6g} rad",
                f"a diagonal BD between {shortest:g} and {longest:g}",
                "this linkage cannot reach the angle, or folds there; keep theta inside its range",
            )


_MOTION: Callable[..., tuple[Array, ...]] = four_bar_kinematics.motion
_OUTPUTS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle")


def _finite(theta: ArrayLike) -> Array:
    """Return angles as an array, or raise BadInput."""
    try:
        angles = np.array(theta, dtype=float)
    except (TypeError, ValueError) as refusal:
        raise bad("theta", repr(theta)[:60], "an array of angles [rad]", "correct it") from refusal
    if not np.all(np.isfinite(angles)):
        raise bad("theta", "a value that is not finite", "finite angles", "remove it")
    return angles
