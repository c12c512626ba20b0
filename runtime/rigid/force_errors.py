"""Errors of the forces from round-off, and self-checks from the motion alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.results import Check
from ..linkages.linkage import EPS, Array, Linkage, over
from ..linkages.parametric import ANGLE
from .evaluation import BLOCK, COUPLES, ParametricMachine
from .loads import Load, Spring, Wrench, at_first_joint, frozen
from .machine import Machine, power_of, wrenches

NORM = (
    "worst force component [N], worst torque or moment over the longest link [N], absolute,"
    " entrywise"
)

# Where the error is as large as this share of what is added up, the linkage folds, and first
# order tells nothing: the forces may be as large as one likes.
_MEANINGFUL = 0.5


def error(machine: Machine, theta: Array, speed: Array, acceleration: Array) -> Array:
    """Return the error of all forces, in the common shape; see :func:`error_and_size`."""
    return error_and_size(machine, theta, speed, acceleration)[0]


def error_and_size(
    machine: Machine, theta: Array, speed: Array, acceleration: Array
) -> tuple[Array, Array]:
    """Return the error, and the forces that its parts bring about, in the common shape.

    The error is a few units of round-off times ``|f| + sum |x df/dx|``, the sum over crank angle,
    lengths, masses, moments, inertias and drive, of the worst of all forces.  The derivatives come
    from the emitted functions by a complex step, so that they grow near a fold with every power of
    the sine that the forces do.  What springs and loads add are the round-offs of their wrenches.
    What a load's callable returns counts as exact.  Beyond a share of a half of what the masses,
    the drive and the wrenches bring about, added up without regard to signs, the error is infinite:
    the linkage folds within the round-off of its lengths.
    """
    batch = np.broadcast_shapes(theta.shape, speed.shape, acceleration.shape)
    given = [np.ravel(np.broadcast_to(item, batch)) for item in (theta, speed, acceleration)]
    errors, size = np.empty(given[0].size), np.empty(given[0].size)
    # Some twenty derivatives of each number.
    step = BLOCK // 8
    for where in (slice(start, start + step) for start in range(0, errors.size, step)):
        errors[where], size[where] = _of_block(machine, *(item[where] for item in given))
    return errors.reshape(batch), size.reshape(batch)


@dataclass(frozen=True)
class _FrozenLoad:
    """A load with its force (..., 2), along its axes, and couple (...) at given angles."""

    load: Load
    force: Array
    couple: Array

    def wrenches(self, motion: Any, _: Array) -> dict[str, Wrench]:
        return {self.load.link: at_first_joint(self.load, motion, self.force, self.couple)}


def _of_block(machine: Machine, theta: Array, speed: Array, change: Array) -> tuple[Array, Array]:
    """Return the error and what is added up [N] at angles of one axis."""
    linkage = machine.linkage
    motion = linkage.motion(theta, speed, change)
    loads = tuple(_FrozenLoad(load, *frozen(load, motion, speed)) for load in machine.loads)
    model = ParametricMachine(linkage, theta, speed, change, machine=machine, loads=loads)
    numbers = model.values
    longest = max(abs(size) for size in linkage.lengths.values())
    fixed = [n for n in linkage.names if numbers[n] or n == "offset"]
    moments = [n for n, value in numbers.items() if value and "." in n]
    with np.errstate(all="ignore"):
        values, slopes = model.derivatives(numbers, (ANGLE, *fixed, *moments))
        steps = [np.abs(theta), *(_step(linkage, n, numbers[n]) for n in (*fixed, *moments))]
        drives = []
        if np.any(model.acceleration):
            # The forces at no speed and at no acceleration may cancel each other.
            still = ({"speed": np.zeros_like(model.speed)}, {"acceleration": np.zeros(1)})
            drives = [replace(model, **part).evaluate(numbers) for part in still]
        moved, size = np.zeros(theta.shape), np.zeros(theta.shape)
        split = 1 + len(fixed)
        for name in model.forces:
            arm = longest if name.startswith(COUPLES) else 1.0
            terms = [step * np.abs(slope) for step, slope in zip(steps, slopes[name], strict=True)]
            parts = np.abs(values[name]) + sum(terms[split:])
            parts = parts + sum(np.abs(part[name]) for part in drives)
            moved = np.fmax(moved, (sum(terms[:split]) + parts) / arm)
            size = np.fmax(size, parts / arm)
        pulls = _pulls(machine, loads, longest, motion)
        # The emitted functions are off by a few round-offs of everything they are given.  Of 5700
        # random machines near folds, near change points and with short links the worst needed 18.4
        # against 60 digits, all others less than 9 (tests/error_estimates has a part of them).
        errors, size = 18.5 * EPS / 2.0 * (moved + pulls), size + pulls
        known = np.isfinite(errors) & (over(errors, size) <= _MEANINGFUL)
    return np.where(known, errors, np.inf), size


def _step(linkage: Linkage, name: str, value: float) -> float:
    """Return what a number counts as in round-offs."""
    if name != "offset":
        return abs(value)
    # The height of the coupler's end over the guide is a difference of parts of crank and
    # coupler, which are larger than what is left near small crank angles.
    return abs(value) + (linkage.lengths["crank"] + linkage.lengths["coupler"]) / 4.0


def _pulls(machine: Machine, loads: tuple[_FrozenLoad, ...], longest: float, motion: Any) -> Array:
    """Return how large the parts of loads and springs are, seen in the joints [N]."""
    total: Array = np.zeros(motion.theta2.shape)
    if not (loads or machine.springs):
        return total
    for one in loads:
        reach = abs(one.load.along) + abs(one.load.across) + longest
        total = total + np.hypot(*one.force.T) * reach + np.abs(one.couple)
    for spring in machine.springs:
        if isinstance(spring, Spring):
            reach = longest + spring.free_length + np.hypot(*spring.first[1:])
            reach += np.hypot(*spring.second[1:])
            total = total + (spring.stiffness * reach + abs(spring.preload)) * longest
            continue
        moving = (link for link in spring.links if link in machine.linkage.links)
        turned = sum(np.abs(motion.link(link).angle) for link in moving)
        total = total + spring.stiffness * (turned + abs(spring.free_angle)) + abs(spring.preload)
    # The shortest arm by which a force in a joint balances a moment: the coupler's length seen
    # across the follower or across the guide, the follower's across the coupler, or the slide.
    if hasattr(motion, "slide"):
        return np.asarray(total / motion.slide)
    lengths = machine.linkage.lengths
    bars = (lengths[name] for name in ("coupler", "follower") if name in lengths)
    return np.asarray(total / (min(bars) * np.abs(np.sin(motion.transmission_angle))))


def checks(
    machine: Machine, theta: Array, speed: Array, acceleration: Array, values: Mapping[str, Array]
) -> dict[str, Check]:
    """Return the checks that the values at hand allow, at some of the places.

    Residuals over the error, at places all over and where a force is largest; and the error itself
    over the forces that the parts of the machine bring about, which fails at a fold.
    """
    batch = np.broadcast_shapes(theta.shape, speed.shape, acceleration.shape)
    if int(np.prod(batch, dtype=int)) == 0:
        return {}
    flat = {name: np.ravel(value) for name, value in values.items()}
    # Places all over, and those at which each of the values is largest.
    spread = np.linspace(0, len(next(iter(flat.values()))) - 1, 24).astype(int)
    peaks = [int(np.argmax(np.abs(value))) for value in flat.values()]
    chosen = np.unique(np.concatenate([spread, peaks]))
    given = [
        np.ravel(np.broadcast_to(item, batch))[chosen] for item in (theta, speed, acceleration)
    ]
    forces = {name: value[chosen] for name, value in flat.items()}
    errors, size = error_and_size(machine, *given)
    allowed = np.maximum(errors, np.finfo(float).tiny)
    broken = sum(int(np.count_nonzero(~np.isfinite(value))) for value in values.values())
    share = float(np.max(over(errors, size)))
    with np.errstate(over="ignore", invalid="ignore"):
        gaps = _Balance(machine, *given).residuals(forces)
        return {
            "values that are not finite": Check(float(broken), 0.0),
            "error over what is added up": Check(share, _MEANINGFUL),
        } | {
            f"{name} over its error": Check(float(np.max(np.abs(gap) / allowed)), 1.0)
            for name, gap in gaps.items()
        }


class _Balance:
    """Newton's and Euler's equations at some places."""

    def __init__(self, machine: Machine, theta: Array, speed: Array, acceleration: Array) -> None:
        self.machine = machine
        self.motion = machine.linkage.motion(theta, speed, acceleration)
        self.unit = machine.linkage.motion(theta)
        # What acts on each link, and of it what comes from outside, less the rate of its momentum.
        self.acting = self._left(wrenches(machine, self.motion, speed))
        self.outside = self._left(wrenches(machine, self.motion, speed, "outside"))
        self.longest = max(abs(length) for length in machine.linkage.lengths.values())

    def residuals(self, forces: Mapping[str, Array]) -> dict[str, Array]:
        """Return by how much each balance that can be made fails [N]."""
        gaps = {}
        if "torque" in forces:
            power = power_of(self.acting, self.unit)
            gaps["power balance"] = (forces["torque"] + power) / self.longest
        fx, fy, moment = self._frame()
        if "shaking_x" in forces:
            gap = np.hypot(forces["shaking_x"] - fx, forces["shaking_y"] - fy)
            gaps["shaking force against -dP/dt"] = gap
        if "shaking_moment" in forces:
            gap = forces["shaking_moment"] - moment
            gaps["shaking moment against -dH/dt"] = gap / self.longest
        if "x12" in forces:
            gaps["equilibrium of the links"] = self._statics(forces)
        return gaps

    def _left(self, acting: Mapping[str, Wrench]) -> dict[str, Wrench]:
        """Return wrenches less the rates of change of the links' momenta, at the first joints."""
        left: dict[str, Wrench] = {}
        for link in self.machine.linkage.links:
            moving, mass = self.motion.link(link), self.machine.mass(link)
            x, y = moving.turned(mass.along, mass.across)
            ax, ay = moving.acceleration[..., 0], moving.acceleration[..., 1]
            alpha, square = moving.angular_acceleration, moving.speed**2
            fx, fy, couple = acting.get(link, (0.0, 0.0, 0.0))
            left[link] = (
                fx - (mass.mass * ax - alpha * y - square * x),
                fy - (mass.mass * ay + alpha * x - square * y),
                couple - (mass.inertia * alpha + x * ay - y * ax),
            )
        return left

    def _frame(self) -> tuple[Any, Any, Any]:
        """Return what momenta and the outside leave for the frame, moment about A."""
        parts = []
        for link, (fx, fy, couple) in self.outside.items():
            x, y = np.moveaxis(self.motion.link(link).origin, -1, 0)
            parts.append((fx, fy, couple + x * fy - y * fx))
        fx, fy, moment = (sum(part) for part in zip(*parts, strict=True))
        return fx, fy, moment

    def _statics(self, forces: Mapping[str, Array]) -> Array:
        """Return the worst of the nine equations (Smith 4.4-4.6) [N]."""
        none: Any = np.zeros(np.shape(self.motion.theta2))
        places = self.motion.joints
        meeting = places["B"] if "couple34" in forces else places["C"]
        gaps = []
        first = {"12": places["A"], "23": places["B"], "34": meeting, "41": meeting}
        for link, (ahead, behind) in zip(
            self.machine.linkage.links, (("12", "23"), ("23", "34"), ("34", "41")), strict=True
        ):
            origin = self.motion.link(link).origin
            total = np.stack(self.acting[link])
            for joint, sign in ((ahead, 1.0), (behind, -1.0)):
                # The follower and the rod turn on their own first joint, where 41 acts.
                arm = (origin if joint == "41" else first[joint]) - origin
                fx, fy = forces["x" + joint], forces["y" + joint]
                turned = arm[..., 0] * fy - arm[..., 1] * fx + forces.get("couple" + joint, none)
                total = total + sign * np.stack([fx, fy, turned])
            gaps += [total[0], total[1]]
            if link != "crank":
                gaps.append(total[2] / self.longest)
            elif "torque" in forces:
                gaps.append((total[2] + forces["torque"]) / self.longest)
        return np.asarray(np.max(np.abs(gaps), axis=0))
