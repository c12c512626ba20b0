"""What every single-loop linkage has: lengths, crank ranges, and motion of any point of a link."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.results import Check, DeferredChecks, Result, provenance
from .inputs import Array, spread

Terms = tuple[list[Any], list[Any], list[Any]]

TURN = 2.0 * np.pi
# However large the angles, a loop that gapes wider than this is no motion.
_WIDEST_GAP = 1e-8
# Rates may leave their closure by so many times what the error figure of the angles would do.
_RATES_LIMIT = 4.0


@dataclass(frozen=True)
class PointMotion:
    """Motion of a point of a moving link in the fixed frame.

    Attributes
    ----------
    position, velocity, acceleration : ndarray, shape (..., 2)
        Components along and across the frame [m, m/s, m/s^2]; rates are over the crank's speed and
        its square where the motion was asked for without a speed.
    """

    position: Array
    velocity: Array
    acceleration: Array

    def nearer(
        self, other_end: LinkMotion, along: Array, across: ArrayLike, length: float
    ) -> PointMotion:
        """Return the same, reached from the link's other end where that is nearer.

        Parameters
        ----------
        other_end : LinkMotion
            Motion of the link with its origin at its second joint.
        along, across : array_like
            Place of the point, seen from the first joint [m].
        length : float
            Distance of the two joints [m].
        """
        chosen = 2.0 * along > length
        if not np.any(chosen):
            return self
        there = other_end.point(along - length, across)
        parts = (
            (there.position, self.position),
            (there.velocity, self.velocity),
            (there.acceleration, self.acceleration),
        )
        return PointMotion(*(np.where(chosen[..., np.newaxis], *pair) for pair in parts))


@dataclass(frozen=True)
class LinkMotion:
    """Motion of a moving link: that of the origin of its own axes, and its turning.

    Attributes
    ----------
    origin, velocity, acceleration : ndarray, shape (..., 2)
        Of the link's first joint [m, m/s, m/s^2].
    angle, speed, angular_acceleration : ndarray
        Of the link's x axis [rad, rad/s, rad/s^2].
    """

    origin: Array
    velocity: Array
    acceleration: Array
    angle: Array
    speed: Array
    angular_acceleration: Array

    def point(self, along: ArrayLike, across: ArrayLike = 0.0) -> PointMotion:
        """Return the motion of a point of the link.

        Parameters
        ----------
        along, across : array_like
            Its place in the link's own axes [m]; broadcast with the angles.

        Returns
        -------
        PointMotion
        """
        arm = (np.asarray(along) + 1j * np.asarray(across)) * np.exp(1j * self.angle)
        turned, hurried = 1j * self.speed, 1j * self.angular_acceleration - self.speed**2
        return PointMotion(
            self.origin + planar(arm),
            self.velocity + planar(turned * arm),
            self.acceleration + planar(hurried * arm),
        )


def planar(value: ArrayLike) -> Array:
    """Return complex numbers as components, shape (..., 2)."""
    number = np.asarray(value, dtype=complex)
    return np.stack([number.real, number.imag], axis=-1)


@dataclass(frozen=True, kw_only=True)
class Motion(Result, ABC):
    """Motion of a linkage at given crank angles.

    Every array has the shape to which crank angle, speed and acceleration broadcast.

    Attributes
    ----------
    linkage : Linkage
        What moves.
    theta2 : ndarray
        Crank angle [rad].
    omega2, alpha2 : ndarray
        Its speed [rad/s] and acceleration [rad/s^2].  By default 1 and 0: then every other rate is
        over the crank speed or its square, at constant crank speed.
    """

    linkage: Linkage
    theta2: Array
    omega2: Array
    alpha2: Array

    # What moves, by name, with its unit: angles and places, then rates.
    places: ClassVar[Mapping[str, str]] = {}
    rates: ClassVar[Mapping[str, str]] = {}

    def link(self, name: str) -> LinkMotion:
        """Return the motion of a moving link, its origin at the link's first joint.

        Parameters
        ----------
        name : str
            One of ``linkage.links``.

        Raises
        ------
        BadInput
            If the linkage has no such moving link.
        """
        if name not in self.linkage.links:
            known = ", ".join(self.linkage.links)
            raise bad("link", repr(name), f"one of {known}", "choose a moving link")
        if name == "crank":
            still = np.zeros(np.shape(self.theta2), dtype=complex)
            return self._link(still, still, still, self.theta2, self.omega2, self.alpha2)
        return self._other_link(name)

    def point(self, link: str, along: ArrayLike, across: ArrayLike = 0.0) -> PointMotion:
        """Return place, velocity and acceleration of a point of a moving link.

        A point of a link between two moving joints is reached from the nearer one, so that either
        joint moves with its other link to the last digit.

        Parameters
        ----------
        link : str
            One of ``linkage.links``.
        along, across : array_like
            Place of the point in the link's own axes [m]: origin at the link's first joint, x
            along the link; broadcast with the angles.

        Returns
        -------
        PointMotion
            Fields of shape (..., 2).

        Raises
        ------
        BadInput
            If the linkage has no such moving link, or the place is not finite.
        """
        place = np.asarray(along, dtype=float), np.asarray(across, dtype=float)
        if not all(np.all(np.isfinite(part)) for part in place):
            raise bad("along, across", "a value that is not finite", "finite lengths", "correct it")
        near, far = self.link(link).point(*place), self._at_far_joint(link)
        if far is None:
            return near
        return near.nearer(far, *place, self.linkage.lengths[link])

    @property
    @abstractmethod
    def joints(self) -> Mapping[str, Array]:
        """Places of the joints by letter, each of shape (..., 2)."""

    @property
    def relative(self) -> bool:
        """True where rates are over the crank speed and its square, at constant speed."""
        return bool(np.all(self.omega2 == 1.0) and np.all(self.alpha2 == 0.0))

    def unit(self, name: str) -> str:
        """Return the unit of a place or rate; that of the defaults is per radian of the crank.

        Of an angle it is 1 then.
        """
        unit = {**self.places, **self.rates}[name]
        if name in self.places or not self.relative:
            return unit
        return "1" if unit.startswith("rad") else unit.replace("/s", "/rad")

    @abstractmethod
    def _other_link(self, name: str) -> LinkMotion:
        """Return the motion of a moving link that is not the crank."""

    def _at_far_joint(self, name: str) -> LinkMotion | None:
        """Return the motion of a link with its origin at its second joint, where that moves too."""
        return None

    def _at_crank_pin(self, angle: Array, speed: Array, acceleration: Array) -> LinkMotion:
        """Return the motion of a link that begins at B."""
        crank = self.linkage.lengths["crank"]
        arm = crank * np.exp(1j * self.theta2)
        hurried = (1j * self.alpha2 - self.omega2**2) * arm
        return self._link(arm, 1j * self.omega2 * arm, hurried, angle, speed, acceleration)

    @staticmethod
    def _link(
        origin: ArrayLike,
        velocity: ArrayLike,
        acceleration: ArrayLike,
        angle: Array,
        speed: Array,
        angular: Array,
    ) -> LinkMotion:
        start = planar(origin), planar(velocity), planar(acceleration)
        return LinkMotion(*start, angle, speed, angular)


class Linkage(ABC):
    """A linkage of one loop, driven by its crank: frame, crank and two more links.

    Attributes
    ----------
    names : tuple of str
        Names of the lengths.
    links : tuple of str
        The moving links, in the order 2, 3, 4.
    bars : mapping of str to tuple of str
        The joints between which each moving link is drawn.
    """

    names: ClassVar[tuple[str, ...]]
    links: ClassVar[tuple[str, str, str]]
    bars: ClassVar[Mapping[str, tuple[str, ...]]]

    @property
    def lengths(self) -> Mapping[str, float]:
        """Lengths by name."""
        return {name: getattr(self, name) for name in self.names}

    @property
    def branch(self) -> float:
        """+1 for the open assembly, -1 for the crossed one."""
        return -1.0 if getattr(self, "assembly", "open") == "crossed" else 1.0

    @property
    def geometry(self) -> Mapping[str, float]:
        """Geometry as the emitted modules take it: lengths, and the sign of the assembly."""
        found = dict(self.lengths)
        if hasattr(self, "assembly"):
            found["assembly"] = self.branch
        return found

    @property
    @abstractmethod
    def crank_turns(self) -> bool:
        """True where the crank can turn fully without passing a change point."""

    @abstractmethod
    def crank_ranges(self) -> tuple[tuple[float, float], ...]:
        """Return the intervals of crank angle [rad] that one turn offers; their ends are folds.

        Returns
        -------
        tuple of (float, float)
            Without their ends, each up to whole turns; ``((-pi, pi),)`` for a crank that turns
            fully, for which -pi and pi are no folds.
        """

    @abstractmethod
    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully."""

    @abstractmethod
    def motion(
        self, theta: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
    ) -> Motion:
        """Return the motion of all links at given crank angles, speeds and accelerations."""

    @abstractmethod
    def _loop(self, m: Mapping[str, Array]) -> Terms:
        """Return the complex terms whose sums vanish: places, first and second derivatives.

        Lengths in the units of ``_unit_lengths``; the derivatives are by the crank angle.
        """

    @abstractmethod
    def _figure(self, m: Mapping[str, Array]) -> Array:
        """Return what a unit round-off of the angle and of each length does, three times."""

    @property
    def _scale(self) -> int:
        """Binary exponent by which the lengths come below 1: their squares are safe then."""
        return -int(np.frexp(max(abs(value) for value in self.lengths.values()))[1])

    @property
    def _unit_lengths(self) -> dict[str, float]:
        """Lengths scaled by a power of two: their digits stay."""
        scale = self._scale
        return {name: float(np.ldexp(value, scale)) for name, value in self.lengths.items()}

    def _reachable(self) -> str:
        """Say which crank angles there are."""
        spans = " or ".join(f"({low:.6g}, {high:.6g})" for low, high in self.crank_ranges())
        return f"a crank angle in {spans} rad, give or take whole turns"

    def _common(self, m: Mapping[str, Array], drive: tuple[Array, Array], norm: str) -> Any:
        """Return the fields that every motion has, by name.

        Parameters
        ----------
        m : mapping
            ``theta2`` and what the emitted function gave, in the units of ``_unit_lengths``.
        drive : tuple of ndarray
            Speed and acceleration of the crank, in the shape of the result.
        norm : str
            What the error figure is of.
        """
        figure = self._figure(m)
        return {
            "linkage": self,
            "theta2": spread(m["theta2"], drive),
            "omega2": drive[0],
            "alpha2": drive[1],
            "method": "closed form",
            "error": spread(figure, drive),
            "error_norm": norm,
            "checks": DeferredChecks(partial(_checks, self, dict(m), figure)),
            "provenance": provenance(self._told()),
        }

    def _told(self) -> dict[str, str]:
        """Return lengths and assembly for the provenance."""
        told = {f"links.{name}": repr(float(size)) for name, size in self.lengths.items()}
        if hasattr(self, "assembly"):
            told["links.assembly"] = str(self.assembly)
        return told

    def _folds(self, theta: Array) -> int:
        """Count the folds strictly between the least and the greatest angle, each end once."""
        if self.crank_turns or theta.size == 0:
            return 0
        low, high = float(theta.min()), float(theta.max())
        found: list[float] = []
        for end in (end for span in self.crank_ranges() for end in span):
            # The first one beyond the least angle is enough to know.
            first = end + TURN * (np.floor((low - end) / TURN) + 1.0)
            new = all(abs(first - other) > 1e-9 for other in found)
            if low < first < high and new:
                found.append(float(first))
        return len(found)

    def _require_reached(self, m: Mapping[str, Array], expected: str) -> None:
        """Raise BadInput where the loop did not close, or the linkage folds."""
        reached = np.logical_and.reduce([np.isfinite(value) for value in m.values()])
        self._require(reached, m["theta2"], expected)

    @staticmethod
    def _require(reached: NDArray[np.bool_], theta: Array, expected: str) -> None:
        if not np.all(reached):
            first = float(np.ravel(theta)[np.argmin(np.ravel(reached))])
            raise bad(
                "theta",
                f"{first:.6g} rad",
                expected,
                "this linkage cannot reach the angle, or folds there; keep theta inside its range",
            )


def _checks(linkage: Linkage, m: Mapping[str, Array], figure: Array) -> dict[str, Check]:
    """Close the loop, and its first and second derivative, with the numbers that were found."""
    places, *rates = linkage._loop(m)
    longest = max(abs(value) for value in linkage._unit_lengths.values())
    closure = float(np.max(np.abs(sum(places)), initial=0.0) / longest)
    limit = 64 * np.finfo(float).eps * np.max(np.abs(m["theta2"]), initial=1.0)
    checks = {
        "loop closure over longest link": Check(closure, min(float(limit), _WIDEST_GAP)),
        "folds within the angles": Check(float(linkage._folds(m["theta2"])), 0.0),
    }
    for name, terms in zip(("speeds", "accelerations"), rates, strict=True):
        size = np.maximum(sum(np.abs(term) for term in terms), np.finfo(float).tiny)
        ratio = np.abs(sum(terms)) / (size * figure)
        worst = float(np.max(ratio, initial=0.0))
        checks[f"closure of {name} over the figure"] = Check(worst, _RATES_LIMIT)
    return checks


def require_linkage(linkage: object) -> None:
    """Raise BadInput for what is no linkage."""
    if not isinstance(linkage, Linkage):
        wrong = type(linkage).__name__
        raise bad("linkage", wrong, "FourBar, SliderCrank or QuickReturn", "give one")


def turning(size: ArrayLike, angle: Array, speed: ArrayLike, change: ArrayLike) -> list[Any]:
    """Return a vector ``size e^(i angle)`` and its first two derivatives, as complex numbers."""
    arm = size * np.exp(1j * angle)
    return [arm, 1j * np.asarray(speed) * arm, (1j * np.asarray(change) - np.square(speed)) * arm]


def plot_against_crank(motion: Motion, curves: Sequence[tuple[str, str]], ax: Any) -> Any:
    """Draw fields of a motion against the crank angle; return the axes.

    With a crank speed, each curve is scaled by a power of ten, named in the legend, so that all of
    them can be seen.

    Parameters
    ----------
    motion : Motion
        What moves.
    curves : sequence of (str, str)
        Names of fields and their words.
    ax : Axes or None
        Where; new ones by default.
    """
    from ..core.plotting import axes_or_new

    ax = axes_or_new(ax)
    degrees = np.degrees(motion.theta2)
    units: dict[str, None] = {}
    for name, words in curves:
        values, unit = getattr(motion, name), motion.unit(name)
        peak = float(np.max(np.abs(values), initial=0.0))
        scaled = peak > 0.0 and not motion.relative
        power = int(np.floor(np.log10(peak))) if scaled else 0
        size = f"$10^{{{power}}}$ " if power else ""
        units[size + unit] = None
        label = words if unit == "1" else f"{words} [{size}{unit}]"
        ax.plot(degrees, values / 10.0**power, label=label)
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel(", ".join(units))
    ax.legend()
    return ax
