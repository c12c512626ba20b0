"""What every single-loop linkage has: lengths, crank ranges, and motion of any point of a link."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass
from functools import cache, cached_property, partial
from inspect import signature
from types import ModuleType
from typing import Any, ClassVar, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import Problem, bad, refuse
from ..core.inputs import is_finite, is_one_of, numbers, require_kind, require_one_of
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Deferred, DeferredChecks, DeferredField, Result, provenance
from ..core.twofold import Twofold

Array: TypeAlias = NDArray[np.float64]
Terms: TypeAlias = tuple[list[Any], list[Any], list[Any]]

TURN = 2.0 * np.pi
JOINTS = ("12", "23", "34", "41")
EPS = float(np.finfo(float).eps)
TINY = float(np.finfo(float).tiny)
# A round-off of each of the numbers that an expression comes from, three times.
ROUND_OFFS = 1.5 * EPS
# Sums of lengths that differ by no more than this part are equal but for the lengths' rounding.
ROUNDED = 4.0 * EPS
# A position that a round-off of the lengths moves so far [rad] is a change point.
UNDECIDED = 0.5
# What names of rates contain.
_RATES = {"speeds": ("omega", "velocity"), "accelerations": ("alpha", "acceleration")}
_LATER = DeferredField()


@dataclass(frozen=True)
class PointMotion:
    """Motion of a point of a moving link in the fixed frame.

    Attributes
    ----------
    position, velocity, acceleration : ndarray, shape (..., 2)
        Components along and across the frame [m, m/s, m/s^2]; rates are over the crank's speed and
        its square where the motion was computed without a speed.
    """

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class LinkMotion:
    """Motion of a moving link: that of the origin of its axes, and its turning.

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
            Its place in the link's axes [m]; broadcast with the angles.

        Returns
        -------
        PointMotion
        """
        x, y = self.turned(along, across)
        speed, change = self.speed, self.angular_acceleration
        square = speed * speed
        return PointMotion(
            self.origin + pair(x, y),
            self.velocity + pair(-speed * y, speed * x),
            self.acceleration + pair(-square * x - change * y, change * x - square * y),
        )

    def turned(self, along: ArrayLike, across: ArrayLike) -> tuple[Array, Array]:
        """Return a vector given along and across the link by its fixed components."""
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        u, v = np.asarray(along), np.asarray(across)
        return cos * u - sin * v, sin * u + cos * v


def pair(x: ArrayLike, y: ArrayLike) -> Array:
    """Return two components as one array, shape (..., 2)."""
    x, y = np.asarray(x), np.asarray(y)
    both: Array = np.empty((*np.broadcast(x, y).shape, 2), np.result_type(x, y))
    both[..., 0], both[..., 1] = x, y
    return both


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
    error: Any = _LATER

    kinematics: ClassVar[ModuleType]  # the emitted module
    # What moves, by name, with its unit: angles and places, then rates.
    places: ClassVar[Mapping[str, str]] = {}
    rates: ClassVar[Mapping[str, str]] = {}
    norm: ClassVar[str] = ""
    # What is drawn against the crank angle.
    drawn: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls, kinematics: ModuleType, **given: Any) -> None:
        """Take what moves from an emitted module."""
        super().__init_subclass__(**given)
        kinds = {"velocity": "m/s", "acceleration": "m/s^2", "omega": "rad/s", "alpha": "rad/s^2"}
        kinds |= {"position": "m", "slide": "m", "": "rad"}
        cls.kinematics, cls.places, cls.rates = kinematics, {}, {}
        for name in kinematics.RETURNS["motion"]:
            unit = next(unit for kind, unit in kinds.items() if kind in name)
            (cls.rates if "/" in unit else cls.places)[name] = unit

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the motion of the output against the crank angle.

        With a crank speed, each curve is scaled by a power of ten, named in the legend, so that all
        of them can be seen.
        """
        ax = axes_or_new(ax)
        degrees = np.degrees(self.theta2)
        over = {"omega": r"/\omega_2", "alpha": r"/\omega_2^2"} if self.relative else {}
        for name in self.drawn:
            values, unit = getattr(self, name), self.unit(name)
            greek, link = name[:-1], name[-1]
            words = rf"$\{greek}_{link}{over.get(greek, '')}$"
            words = words if link.isdigit() else name.removeprefix("slider_")
            peak = float(np.max(np.abs(values), initial=0.0))
            scaled = peak > 0.0 and not self.relative
            power = int(np.floor(np.log10(peak))) if scaled else 0
            size = f"$10^{{{power}}}$ " if power else ""
            label = words if unit == "1" else f"{words} [{size}{unit}]"
            ax.plot(degrees, values / 10.0**power, label=label)
        first = "angle" if self.unit(self.drawn[0]) == "rad" else "position"
        rates = "rates over the crank's" if self.relative else "rates"
        ax.set(xlabel="crank angle [deg]", ylabel=f"{first} and {rates}, units in the legend")
        ax.legend()
        return ax

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
        require_one_of("link", name, self.linkage.links, "choose a moving link")
        if name == "crank":
            return self._about(0.0, self.theta2, self.omega2, self.alpha2)
        return self._other_link(name)

    def point(self, link: str, along: ArrayLike, across: ArrayLike = 0.0) -> PointMotion:
        """Return place, velocity and acceleration of a point of a moving link.

        Parameters
        ----------
        link : str
            One of ``linkage.links``.
        along, across : array_like
            Place of the point in the link's axes [m]: origin at the link's first joint, x along
            the link; broadcast with the angles.

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
        return self.link(link).point(*place)

    @cached_property
    def errors(self) -> Mapping[str, Array]:
        """Error of every place and rate by name, in its unit; of the same shape.

        What round-off does to it, by the same formulas in 32 digits; of an angle half a unit in
        the last place more, since pi is a float in them.
        """
        drive = Twofold(self.omega2), Twofold(self.alpha2)
        exact = driven(_without_rounding(self.linkage, self.theta2), *drive)
        errors = {}
        for name, value in exact.items():
            own, unit = getattr(self, name), self.unit_of(name)
            # Places and rates of points are those of the unit lengths.
            shift = self.linkage.scale if unit.startswith("m") else 0
            errors[name] = np.ldexp(value.gap(np.ldexp(own, shift)), -shift)
            if unit == "rad":
                errors[name] = errors[name] + 0.5 * EPS * np.abs(own)
        return errors

    def point_errors(self, link: str, along: ArrayLike, across: ArrayLike = 0.0) -> PointMotion:
        """Return the errors of place, velocity and acceleration that :meth:`point` returns.

        Those of the link's motion, as :attr:`errors` has them, to first order, with the round-off
        of the point's own sums; arguments, shapes and units are those of :meth:`point`.
        """
        own = self.link(link)
        self.point(link, along, across)  # refuses what is no place
        still = dict.fromkeys((*self.errors, "theta2", "omega2", "alpha2"), np.zeros(()))
        still = {name: np.broadcast_to(zero, np.shape(self.theta2)) for name, zero in still.items()}
        shifted = copy(self), copy(self)  # what is deferred in them is not computed
        for other, values in zip(shifted, (still, {**still, **self.errors}), strict=True):
            vars(other).update(values)
        rest, off = (other.link(link) for other in shifted)
        reach = np.hypot(along, across)[..., np.newaxis]
        # Sines, products and sums: five halves of a unit in the last place of the largest.
        tilt, slip = off.angle + 3.0 * EPS, 3.0 * EPS
        speed, change = np.abs(own.speed), np.abs(own.angular_acceleration)
        turned = tilt, off.speed + speed * tilt
        bent = off.angular_acceleration + 2.0 * speed * off.speed + (change + speed**2) * tilt

        def error(moved: Array, of_origin: Array, of_angle: Array) -> Array:
            size = np.linalg.norm(of_origin, axis=-1, keepdims=True)
            return np.asarray(moved + slip * size + reach * of_angle[..., np.newaxis])

        return PointMotion(
            error(off.origin - rest.origin, own.origin, turned[0]),
            error(off.velocity, own.velocity, turned[1]),
            error(off.acceleration, own.acceleration, bent),
        )

    @property
    def joints(self) -> Mapping[str, Array]:
        """Places of the joints by letter (A, B, C, D), each of shape (..., 2)."""
        places = {}
        for link, letters in self.linkage.bars.items():
            places[letters[0]] = self.link(link).origin
            if len(letters) == 2:
                places[letters[1]] = self.point(link, self.linkage.lengths[link]).position
        return dict(sorted(places.items()))

    @property
    def relative(self) -> bool:
        """True where rates are over the crank speed and its square, at constant speed."""
        return bool(np.all(self.omega2 == 1.0) and np.all(self.alpha2 == 0.0))

    def unit(self, name: str) -> str:
        """Return the unit of a place or rate; relative ones are per radian, and 1 of an angle."""
        return self.unit_of(name, self.relative)

    def _own_units(self) -> dict[str, str]:
        return {name: self.unit(name).strip("1") for name in (*self.places, *self.rates)}

    @classmethod
    def unit_of(cls, name: str, relative: bool = False) -> str:
        """Return the unit of a place or rate, in time or per radian of the crank."""
        unit = {**cls.places, **cls.rates}[name]
        if name in cls.places or not relative:
            return unit
        return "1" if unit.startswith("rad") else unit.replace("/s", "/rad")

    @abstractmethod
    def _other_link(self, name: str) -> LinkMotion:
        """Return the motion of a moving link that is not the crank."""

    def _about(self, pivot: Any, angle: Array, speed: Array, change: Array) -> LinkMotion:
        """Return the motion of a link that turns about a fixed point of the frame line."""
        still = np.zeros((*np.shape(self.theta2), 2))
        start = still + pair(pivot, 0.0)
        return LinkMotion(start, still, still, angle, speed, change)

    def _at_crank_pin(self, angle: Array, speed: Array, change: Array) -> LinkMotion:
        pin = self.link("crank").point(self.linkage.lengths["crank"])
        return LinkMotion(pin.position, pin.velocity, pin.acceleration, angle, speed, change)


@dataclass(frozen=True)
class Limits:
    """Where the loop can close: ``q1 <= q <= q2``, each with its complement to 1.

    ``q = sin^2(psi/2)``, psi being the crank angle from ``Linkage.fold_axis``.  Every factor is a
    correctly rounded sum of lengths, so that no round-off can change a sign.
    """

    q1: float
    one_less_q1: float
    q2: float
    one_less_q2: float

    @property
    def ends(self) -> tuple[float | None, float | None]:
        """Angles psi from 0 to pi at which the linkage folds, None where the crank passes."""
        low, high = (
            float(2.0 * np.arctan2(np.sqrt(sine2), np.sqrt(cosine2))) if stops >= 0.0 else None
            for sine2, cosine2, stops in (
                (self.q1, self.one_less_q1, self.q1),
                (self.q2, self.one_less_q2, self.one_less_q2),
            )
        )
        return low, high


M = TypeVar("M", bound=Motion)


class Linkage(ABC):
    """A linkage of one loop, driven by its crank: frame, crank and two more links.

    Attributes
    ----------
    mechanism : str
        Name of its emitted modules.
    names : tuple of str
        Names of the lengths.
    links : tuple of str
        The moving links, in the order 2, 3, 4.
    bars : mapping of str to tuple of str
        The joints between which each moving link is drawn.
    fold_axis : float
        Crank angle [rad] about which the folds are mirror images.
    """

    mechanism: ClassVar[str]
    moves: ClassVar[type[Motion]]
    names: ClassVar[tuple[str, ...]]
    links: ClassVar[tuple[str, str, str]]
    bars: ClassVar[Mapping[str, tuple[str, ...]]]
    fold_axis: ClassVar[float] = 0.0

    def __post_init__(self) -> None:
        owner, problems = type(self).__name__, []
        for name, size in self.lengths.items():
            signed = name == "offset"
            if not (is_finite(size) and (signed or size > 0.0)):
                expected = "a finite length" if signed else "a positive finite length"
                problems.append(Problem(f"{owner}.{name}", repr(size), expected, "correct it"))
        assembly = getattr(self, "assembly", "open")
        if not is_one_of(assembly, ("open", "crossed")):
            where, expected = f"{owner}.assembly", "'open' or 'crossed'"
            problems.append(Problem(where, repr(assembly), expected, "choose one"))
        refuse(problems or self._gaping())

    @abstractmethod
    def _gaping(self) -> list[Problem]:
        """Return why lengths, good ones by themselves, cannot close."""

    @property
    def lengths(self) -> Mapping[str, float]:
        """Lengths by name."""
        return {name: getattr(self, name) for name in self.names}

    @property
    def branch(self) -> float:
        """+1 for the open assembly, -1 for the crossed one."""
        return -1.0 if getattr(self, "assembly", "open") == "crossed" else 1.0

    @property
    @abstractmethod
    def limits(self) -> Limits:
        """Where the loop can close."""

    @property
    def crank_turns(self) -> bool:
        """True where the crank can turn fully without passing a change point."""
        return self.limits.q1 < 0.0 and self.limits.one_less_q2 < 0.0

    def crank_ranges(self) -> tuple[tuple[float, float], ...]:
        """Return the intervals of crank angle [rad] that one turn offers; their ends are folds.

        There coupler and follower come into one line, the coupler stands across the guide, or the
        block is at the rod's tip or, with eps = 1, on its pivot.

        Returns
        -------
        tuple of (float, float)
            Without their ends, each up to whole turns; ``((-pi, pi),)`` for a crank that turns
            fully, for which -pi and pi are no folds.
        """
        axis, (low, high) = self.fold_axis, self.limits.ends
        if low is None and high is None:
            return ((-np.pi, np.pi),)
        if low is None or high is None:
            first = low or 0.0
            return ((axis - high, axis + high),) if high else ((axis + first, axis + TURN - first),)
        if axis:
            return ((axis + low, axis + high), (axis + TURN - high, axis + TURN - low))
        return ((-high, -low), (low, high))

    @abstractmethod
    def require_full_turn(self) -> None:
        """Raise BadInput where the crank cannot turn fully, or does by rounding alone."""

    @abstractmethod
    def motion(
        self, theta: ArrayLike, speed: ArrayLike = 1.0, acceleration: ArrayLike = 0.0
    ) -> Motion:
        """Return the motion of all links, from the closure of the loop (Smith 2.2, 2.7, 2.10).

        Angles are continuous over any number of turns.  At ``theta = 0`` theta3 and theta4 of a
        four-bar lie between -pi and pi, and theta4 of a quick-return is 0.

        Parameters
        ----------
        theta : array_like
            Crank angle [rad], any shape.
        speed, acceleration : array_like
            Crank speed [rad/s] and acceleration [rad/s^2]; they broadcast with ``theta``.

        Returns
        -------
        FourBarMotion, SliderCrankMotion or QuickReturnMotion
            Every array has the shape to which the three broadcast.  The check "folds within the
            angles" fails where the linkage folds between the least and the greatest angle (an end
            of :meth:`crank_ranges`): the motion is not continuous there, or it may leave by the
            other branch.

        Raises
        ------
        BadInput
            If an angle, a speed or an acceleration is not a finite number, their shapes do not fit
            together, or the linkage cannot reach an angle or folds there.
        """

    def _moved(
        self, kind: type[M], theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike
    ) -> M:
        """Return the motion; its error and checks are computed when they are first read."""
        angles, speeds, changes, shape = checked_drive(theta, speed, acceleration)
        drive = [np.array(np.broadcast_to(item, shape)) for item in (speeds, changes)]
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            moved = emitted(self, kind.kinematics, "motion", angles, self.unit_lengths)
        m = {"theta2": angles, **{name: np.asarray(value) for name, value in moved.items()}}
        reached = np.logical_and.reduce([np.isfinite(value) for value in m.values()])
        self.require(reached & (ROUND_OFFS * self._blur(m) < UNDECIDED), angles)
        fields: dict[str, Any] = {}
        with np.errstate(over="ignore", invalid="ignore"):
            moved = driven(m, *drive)
        for name, value in moved.items():
            spread = value if value.shape == shape else np.array(np.broadcast_to(value, shape))
            scaled = name != "theta2" and kind.unit_of(name).startswith("m")
            fields[name] = np.ldexp(spread, -self.scale) if scaled else spread
        if not all(np.all(np.isfinite(value)) for value in fields.values()):
            found = f"a rate that exceeds the range of doubles, at {np.max(np.abs(drive)):.3g}"
            raise bad("speed, acceleration", found, "finite rates of all links", "lower them")
        return kind(
            linkage=self,
            omega2=drive[0],
            alpha2=drive[1],
            **fields,
            method="closed form",
            error=Deferred(partial(_error, self, m, shape)),
            error_norm=f"{kind.norm}, absolute, entrywise",
            checks=DeferredChecks(partial(_checks, self, m)),
            provenance=provenance(self.provenance),
        )

    def course(self, name: str) -> Callable[[Array], Array]:
        """Return a place or rate of the motion as a function of the crank angle.

        Raises ``BadInput`` if the crank cannot turn fully, or the motion has no such field.
        """
        self.require_full_turn()
        known = (*self.moves.places, *self.moves.rates)
        require_one_of("source", name, known, "choose a field of the motion")
        return lambda theta: np.asarray(getattr(self.motion(theta), name))

    @property
    def provenance(self) -> dict[str, str]:
        """Lengths and assembly, for results."""
        names = {f"links.{name}": repr(float(size)) for name, size in self.lengths.items()}
        if hasattr(self, "assembly"):
            names["links.assembly"] = str(self.assembly)
        return names

    @property
    def scale(self) -> int:
        """Binary exponent by which the lengths come below 1: their squares are safe then."""
        return -int(np.frexp(max(abs(value) for value in self.lengths.values()))[1])

    @property
    def unit_lengths(self) -> dict[str, float]:
        """Lengths scaled by a power of two: their digits stay."""
        scale = self.scale
        return {name: float(np.ldexp(value, scale)) for name, value in self.lengths.items()}

    @property
    def reachable(self) -> str:
        """Which crank angles there are, in words."""
        spans = " or ".join(f"({low:.6g}, {high:.6g})" for low, high in self.crank_ranges())
        return f"a crank angle in {spans} rad, give or take whole turns"

    def require(self, reached: NDArray[np.bool_], theta: Array) -> None:
        """Raise BadInput, with the first crank angle that is not reached."""
        if not np.all(reached):
            first = float(np.ravel(theta)[np.argmin(np.ravel(reached))])
            fix = "this linkage cannot reach the angle, or folds there; keep theta inside its range"
            raise bad("theta", f"{first:.6g} rad", self.reachable, fix)

    def _blur(self, m: Mapping[str, Array]) -> Array:
        """Return what round-offs of the lengths do to the position [rad], in round-offs.

        Infinite where it is beyond the links' ends.
        """
        return np.zeros(np.shape(m["theta2"]))

    @abstractmethod
    def _error(self, m: Mapping[str, Array]) -> Array:
        """Return what round-offs of the angle and of the lengths do, in round-offs."""

    @abstractmethod
    def _loop(self, m: Mapping[str, Array]) -> Terms:
        """Return the complex terms whose sums vanish: places, first and second derivatives.

        Lengths in the units of ``unit_lengths``; the derivatives are by the crank angle.
        """

    def _folds(self, theta: Array) -> int:
        """Count the folds strictly between the least and the greatest angle, each end once."""
        if self.crank_turns or theta.size == 0:
            return 0
        low, ends = theta.min(), np.ravel(self.crank_ranges())
        # Of each end the first one beyond the least angle is enough to know.
        first = np.sort(ends + TURN * (np.floor((low - ends) / TURN) + 1.0))
        within = first[(low < first) & (first < theta.max())]
        return int(np.count_nonzero(np.diff(within, prepend=-np.inf) > 1e-9))


def emitted(
    linkage: Linkage, module: Any, function: str, theta: Any, values: Mapping[str, Any]
) -> dict[str, Any]:
    """Return what an emitted function returns, by name, given the values that it takes.

    Assembly and winding are the linkage's.
    """
    call: Callable[..., Any] = getattr(module, function)
    given = {"assembly": linkage.branch, **values}
    names = arguments(call)[1:]
    if "winding" in names and "winding" not in values:
        crank, frame = (np.real(values[name]) for name in ("crank", "frame"))
        given["winding"] = np.greater(crank, frame).astype(float)
    returned = call(theta, **{name: given[name] for name in names})
    return dict(zip(module.RETURNS[function], returned, strict=True))


def _without_rounding(linkage: Linkage, theta: Array) -> dict[str, Any]:
    """Return places and rates by the crank angle to twice the digits, of the unit lengths."""
    lengths = linkage.unit_lengths
    known: dict[str, Any] = {name: Twofold(value) for name, value in lengths.items()}
    known["winding"] = float(lengths["crank"] > lengths.get("frame", np.inf))
    with np.errstate(all="ignore"):
        return emitted(linkage, linkage.moves.kinematics, "motion", Twofold(theta), known)


@cache
def arguments(function: Callable[..., Any]) -> tuple[str, ...]:
    """Return the names of the arguments of an emitted function."""
    return tuple(signature(function).parameters)


def driven(m: Mapping[str, Any], speed: Any, acceleration: Any) -> dict[str, Any]:
    """Return speeds and accelerations in time from derivatives by the crank angle (Smith 2.10)."""
    moved = dict(m)
    for name, first in m.items():
        other = name.replace("omega", "alpha").replace("velocity", "acceleration")
        if other != name:
            moved[name] = speed * first
            moved[other] = speed**2 * m[other] + acceleration * first
    return moved


def _error(linkage: Linkage, m: Mapping[str, Array], shape: tuple[int, ...]) -> Array:
    """Return the error at the places of a result."""
    return np.array(np.broadcast_to(ROUND_OFFS * linkage._error(m), shape))


def _checks(linkage: Linkage, m: Mapping[str, Array]) -> dict[str, Check]:
    """Close the loop, and its first and second derivative."""
    error = ROUND_OFFS * linkage._error(m)
    places, *rates = linkage._loop(m)
    longest = max(abs(value) for value in linkage.unit_lengths.values())
    closure = float(np.max(np.abs(sum(places)), initial=0.0) / longest)
    limit = 64 * np.finfo(float).eps * np.max(np.abs(m["theta2"]), initial=1.0)
    # However large the angles, a loop that gapes wider than this is no motion.
    checks = {
        "loop closure over longest link": Check(closure, min(float(limit), 1e-8)),
        "folds within the angles": Check(float(linkage._folds(m["theta2"])), 0.0),
    }
    # Round-off of the rates is judged at the angles at which the position is known worst.
    judged = np.argsort(np.ravel(error))[-64:]
    exact = _without_rounding(linkage, np.ravel(m["theta2"])[judged])
    for name, terms in zip(_RATES, rates, strict=True):
        size = np.maximum(sum(np.abs(term) for term in terms), np.finfo(float).tiny)
        worst = float(np.max(np.abs(sum(terms)) / (size * error), initial=0.0))
        # Rates may leave their closure by so many times what the error of the angles would do.
        checks[f"closure of {name} over its error"] = Check(worst, 4.0)
        lost = 0.0
        for rate, value in exact.items():
            if any(kind in rate for kind in _RATES[name]):
                own = np.ravel(m[rate])[judged]
                parts = np.ravel(size)[judged] / (1.0 if "_" in rate else longest)
                part = value.gap(own) / np.maximum(np.abs(own), parts)
                lost = max(lost, float(np.max(part, initial=0.0)))
        checks[f"round-off of {name} over their terms"] = Check(lost, 1e-8)
    return checks


def require_linkage(linkage: object) -> None:
    """Raise BadInput for what is no linkage."""
    require_kind("linkage", linkage, Linkage, "give a FourBar, SliderCrank or QuickReturn")


def checked_drive(
    theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike
) -> tuple[Array, Array, Array, tuple[int, ...]]:
    """Return finite angles, speeds and accelerations, and the shape to which they broadcast."""
    angles = finite_array("theta", theta, "angles [rad]")
    speeds = finite_array("speed", speed, "crank speeds [rad/s]")
    changes = finite_array("acceleration", acceleration, "crank accelerations [rad/s^2]")
    try:
        shape = np.broadcast_shapes(angles.shape, speeds.shape, changes.shape)
    except ValueError as refusal:
        shapes = f"shapes {angles.shape}, {speeds.shape}, {changes.shape}"
        fix = "give one speed, or one for each angle"
        raise bad("theta, speed, acceleration", shapes, "shapes that broadcast", fix) from refusal
    return angles, speeds, changes, shape


def finite_array(name: str, value: ArrayLike, meaning: str) -> Array:
    """Return an array of finite numbers, or raise BadInput."""
    array = numbers(name, value)
    if not np.all(np.isfinite(array)):
        raise bad(name, "a value that is not finite", f"finite {meaning}", "remove it")
    return array


def over(part: Array, whole: Array) -> Array:
    """Return a quotient, zero where there is nothing to divide by."""
    return np.asarray(np.divide(part, whole, out=np.zeros(np.shape(whole)), where=whole > 0.0))


def turning(size: ArrayLike, angle: Array, speed: ArrayLike, change: ArrayLike) -> list[Any]:
    """Return a vector ``size e^(i angle)`` and its first two derivatives, as complex numbers."""
    arm = size * np.exp(1j * angle)
    return [arm, 1j * np.asarray(speed) * arm, (1j * np.asarray(change) - np.square(speed)) * arm]
