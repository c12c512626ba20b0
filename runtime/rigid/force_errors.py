"""Error figure of the forces: what a round-off of every number they come from does to them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from .blocks import BLOCK, Array
from .loads import Load, Spring, TorsionSpring, frozen
from .machine import Machine
from .masses import MassDistribution

NORM = (
    "worst force component [N], worst torque or moment over the longest link [N], absolute,"
    " entrywise"
)

_UNIT = float(np.finfo(float).eps) / 2.0
# The emitted functions are off by a few round-offs of everything they are given.  Of 5700
# random machines near folds, near change points and with short links the worst needed 18.4 against
# 60 digits, all others less than 9 (tests/error_estimates has a part of them).
_FACTOR = 24.0
# Where the figure is as large as this share of what is added up, the linkage folds, and first
# order tells nothing: the forces may be as large as one likes.
MEANINGFUL = 0.5


def figure(machine: Machine, theta: Array, speed: Array, acceleration: Array) -> Array:
    """Return the error figure of all forces, in the common shape.

    Parameters
    ----------
    machine : Machine
        The machine.
    theta, speed, acceleration : ndarray
        Crank angle [rad], speed [rad/s], acceleration [rad/s^2].

    Returns
    -------
    ndarray
        See :func:`figure_and_size`.
    """
    return figure_and_size(machine, theta, speed, acceleration)[0]


def figure_and_size(
    machine: Machine, theta: Array, speed: Array, acceleration: Array
) -> tuple[Array, Array]:
    """Return the error figure, and the forces that its parts bring about, in the common shape.

    The figure is a few units of round-off times ``|f| + sum |x df/dx|``, the sum over crank angle,
    lengths, masses, moments, inertias and drive, of the worst of all forces.  The derivatives come
    from the emitted functions by the rules of differentiation, so that they grow near a fold with
    every power of the sine that the forces do.  What springs and loads add are the round-offs of
    their own wrenches.  What a load's callable returns counts as exact.  Beyond a share of
    :data:`MEANINGFUL` of what the masses, the drive and the wrenches bring about, added up without
    regard to signs, the figure is infinite: the linkage folds within the round-off of its lengths.
    """
    batch = np.broadcast_shapes(theta.shape, speed.shape, acceleration.shape)
    given = [np.ravel(np.broadcast_to(item, batch)) for item in (theta, speed, acceleration)]
    found, size = np.empty(given[0].size), np.empty(given[0].size)
    acting = _frozen_loads(machine, *given)
    scaled = _Scaled(machine)
    for where in _blocks(found.size):
        own = [(fx[where], fy[where], couple[where]) for fx, fy, couple in acting]
        found[where], size[where] = scaled.figure(own, *(item[where] for item in given))
    return found.reshape(batch), size.reshape(batch)


def share_of(error: Array, size: Array) -> Array:
    """Return the figure over what is added up, zero where nothing acts."""
    return np.where(size > 0.0, error / np.where(size > 0.0, size, 1.0), 0.0)


def _blocks(size: int) -> Iterator[slice]:
    # A dual number is some twenty numbers wide.
    step = BLOCK // 8
    return (slice(start, start + step) for start in range(0, size, step))


def _frozen_loads(
    machine: Machine, theta: Array, speed: Array, acceleration: Array
) -> list[tuple[Array, Array, Array]]:
    """Return force components, as given along the load's axes, and couple of each load."""
    if not machine.loads:
        return []
    motion = machine.linkage.motion(theta, speed, acceleration)
    found = []
    for load in machine.loads:
        force, couple = frozen(load, motion, speed)
        fx, fy = (np.broadcast_to(force[..., i], theta.shape) for i in (0, 1))
        found.append((fx, fy, np.broadcast_to(couple, theta.shape)))
    return found


@dataclass(frozen=True)
class _Acting:
    """A machine as the sensitivities take it: masses, weights, loads as numbers, springs."""

    masses: Mapping[str, MassDistribution]
    gravity: tuple[float, float]
    loads: tuple[Any, ...]
    springs: tuple[Any, ...]
    loaded: bool

    def mass(self, link: str) -> MassDistribution:
        return self.masses.get(link, MassDistribution())


class _Scaled:
    """A machine in a unit of length in which the longest link is between a half and 1."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        sizes = machine.linkage.lengths
        self.exponent = int(np.frexp(max(abs(size) for size in sizes.values()))[1])
        shorter = {name: self._length(size) for name, size in sizes.items()}
        changes: Any = shorter
        self.linkage = replace(machine.linkage, **changes)  # type: ignore[type-var]
        self.longest = max(abs(size) for size in shorter.values())
        self.masses = {
            link: MassDistribution(
                self._rate(own.mass), own.along, own.across, self._length(own.inertia)
            )
            for link, own in machine.masses.items()
        }
        gx, gy = machine.gravity
        self.gravity = self._length(gx), self._length(gy)
        self.springs = tuple(self._spring(spring) for spring in machine.springs)

    def _length(self, value: Any) -> Any:
        return np.ldexp(value, -self.exponent)

    def _rate(self, value: float) -> float:
        return float(np.ldexp(value, self.exponent))

    def _spring(self, spring: Spring | TorsionSpring) -> Spring | TorsionSpring:
        if isinstance(spring, TorsionSpring):
            names = ("stiffness", "damping", "preload")
            changes: Any = {name: float(self._length(getattr(spring, name))) for name in names}
            return replace(spring, **changes)
        ends: Any = {
            name: (end[0], float(self._length(end[1])), float(self._length(end[2])))
            for name, end in (("first", spring.first), ("second", spring.second))
        }
        return replace(
            spring,
            **ends,
            stiffness=self._rate(spring.stiffness),
            damping=self._rate(spring.damping),
            free_length=float(self._length(spring.free_length)),
        )

    def figure(
        self, acting: list[tuple[Array, Array, Array]], theta: Array, speed: Array, change: Array
    ) -> tuple[Array, Array]:
        """Return the figure and what is added up [N] at angles of one axis."""
        from ..linkages.subject import ANGLE, Subject

        loads = tuple(
            self._load(load, *wrench)
            for load, wrench in zip(self.machine.loads, acting, strict=True)
        )
        whole: Any = _Acting(self.masses, self.gravity, loads, self.springs, self.machine.loaded)
        subject = Subject(self.linkage, whole, theta, speed, change)
        numbers = subject.values
        fixed = [n for n in self.linkage.names if numbers[n] or n == "offset"]
        moments = [n for n, value in numbers.items() if value and "." in n]
        names = (ANGLE, *fixed, *moments)
        with np.errstate(all="ignore"):
            values, slopes = subject.derivatives(numbers, names)
            steps = [np.abs(theta), *(self._step(n, numbers[n]) for n in names[1:])]
            drives = self._drives(subject)
            moved, size = np.zeros(theta.shape), np.zeros(theta.shape)
            for name in subject._module.RETURNS["forces"]:
                arm = self.longest if subject.unit(name) == "N m" else 1.0
                terms = [
                    step * np.abs(slope) for step, slope in zip(steps, slopes[name], strict=True)
                ]
                split = 1 + len(fixed)
                parts = np.abs(values[name]) + sum(terms[split:])
                parts = parts + sum(np.abs(part[name]) for part in drives)
                moved = np.fmax(moved, (sum(terms[:split]) + parts) / arm)
                size = np.fmax(size, parts / arm)
            wrenches = self._wrenches(acting, theta, speed, change)
            found, size = _FACTOR * _UNIT * (moved + wrenches), size + wrenches
            known = np.isfinite(found) & (share_of(found, size) <= MEANINGFUL)
        return np.where(known, found, np.inf), size

    def _step(self, name: str, value: float) -> float:
        """Return what a number counts as in round-offs."""
        if name != "offset":
            return abs(value)
        # The height of the coupler's end over the guide is a difference of parts of crank and
        # coupler, which are larger than what is left near small crank angles.
        lengths = self.linkage.lengths
        return abs(value) + (lengths["crank"] + lengths["coupler"]) / 4.0

    def _load(self, load: Load, fx: Array, fy: Array, couple: Array) -> Any:
        return SimpleNamespace(
            link=load.link,
            force=(fx, fy),
            couple=self._length(couple),
            along=float(self._length(load.along)),
            across=float(self._length(load.across)),
            axes=load.axes,
        )

    @staticmethod
    def _drives(subject: Any) -> list[Mapping[str, Array]]:
        """Return the forces at no speed and at no acceleration, which may cancel each other."""
        if not np.any(subject.acceleration):
            return []
        parts = ({"speed": np.zeros_like(subject.speed)}, {"acceleration": np.zeros(1)})
        return [replace(subject, **part).evaluate(subject.values) for part in parts]

    def _wrenches(
        self, acting: list[tuple[Array, Array, Array]], theta: Array, speed: Array, change: Array
    ) -> Array:
        """Return how large the parts of the wrenches are, seen in the joints [N]."""
        total: Array = np.zeros(theta.shape)
        if not (acting or self.springs):
            return total
        motion = self.linkage.motion(theta, speed, change)
        for load, (fx, fy, couple) in zip(self.machine.loads, acting, strict=True):
            reach = self._length(abs(load.along) + abs(load.across)) + self.longest
            total = total + np.hypot(fx, fy) * reach + np.abs(self._length(couple))
        total = total + self._tensions(motion) * self.longest
        return np.asarray(total / _shortest_arm(self.linkage.lengths, motion))

    def _tensions(self, motion: Any) -> Array:
        """Return how large the parts are of which the springs' tensions are differences [N]."""
        total: Array = np.zeros(np.shape(motion.theta2))
        for spring in self.springs:
            if isinstance(spring, Spring):
                reach = self.longest + spring.free_length + np.hypot(*spring.first[1:])
                reach += np.hypot(*spring.second[1:])
                total = total + spring.stiffness * reach + abs(spring.preload)
                continue
            turned = sum(
                np.abs(motion.link(link).angle)
                for link in spring.links
                if link in self.linkage.links
            )
            couple = spring.stiffness * (turned + abs(spring.free_angle)) + abs(spring.preload)
            total = total + couple / self.longest
        return total


def _shortest_arm(lengths: Mapping[str, float], motion: Any) -> Array:
    """Return the shortest arm by which a force in a joint balances a moment.

    The coupler's length seen across the follower or across the guide, the follower's across the
    coupler, or the slide of a block along its rod.
    """
    if hasattr(motion, "slide"):
        return np.asarray(motion.slide)
    sine = np.abs(np.sin(motion.transmission_angle))
    bars = (lengths[name] for name in ("coupler", "follower") if name in lengths)
    return np.asarray(min(bars) * sine)
