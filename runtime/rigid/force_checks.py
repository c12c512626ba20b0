"""Self-checks of the forces, from the motion alone: power, momenta, statics of each link."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.results import Check
from .blocks import Array
from .force_errors import MEANINGFUL, figure_and_size, share_of
from .force_multipliers import multipliers
from .loads import Wrench
from .machine import Machine

_PLACES = 24
# Places at which Lagrange's equations are solved as well.
_SOLVED = 6
# The figure covers what is left in the balances, too: the joint forces and their arms are worked
# out from the same angle and lengths.
_LIMIT = 1.0


def checks(
    machine: Machine,
    theta: Array,
    speed: Array,
    acceleration: Array,
    values: Mapping[str, Array],
) -> dict[str, Check]:
    """Return the checks that the values at hand allow, at some of the places.

    Parameters
    ----------
    machine : Machine
        The machine.
    theta, speed, acceleration : ndarray
        Crank angle [rad], speed [rad/s], acceleration [rad/s^2].
    values : mapping of str to ndarray
        Forces by name.

    Returns
    -------
    dict of str to Check
        Residuals over the error figure, at places all over and where a force is largest; the
        figure itself over the forces that the parts of the machine bring about, which fails at a
        fold; and how far the multipliers of Lagrange's equations are off, solved as a whole at a
        few of the places.
    """
    batch = np.broadcast_shapes(theta.shape, speed.shape, acceleration.shape)
    if int(np.prod(batch, dtype=int)) == 0:
        return {}
    flat = {name: np.ravel(value) for name, value in values.items()}
    chosen = _places(flat)
    given = [
        np.ravel(np.broadcast_to(item, batch))[chosen] for item in (theta, speed, acceleration)
    ]
    found = {name: value[chosen] for name, value in flat.items()}
    error, size = figure_and_size(machine, *given)
    allowed = np.maximum(error, np.finfo(float).tiny)
    broken = sum(int(np.count_nonzero(~np.isfinite(value))) for value in values.values())
    share = float(np.max(share_of(error, size)))
    made = {
        "values that are not finite": Check(float(broken), 0.0),
        "error over what is added up": Check(share, MEANINGFUL),
    }
    with np.errstate(over="ignore", invalid="ignore"):
        gaps = _Balance(machine, *given).residuals(found)
        few = np.unique(np.linspace(0, chosen.size - 1, _SOLVED).astype(int))
        other = _against_multipliers(machine, given, found, allowed, few)
        made |= {
            f"{name} over the figure": Check(float(np.max(np.abs(gap) / allowed)), _LIMIT)
            for name, gap in gaps.items()
        }
        if other is not None:
            name = "multipliers of Lagrange's equations over the figures"
            made[name] = Check(float(np.max(other)), _LIMIT)
    return made


def _places(values: Mapping[str, Array]) -> NDArray[np.intp]:
    """Return places all over, and those at which each of the values is largest."""
    size = next(iter(values.values())).size
    spread = np.linspace(0, size - 1, _PLACES).astype(int)
    peaks = [int(np.argmax(np.abs(value))) for value in values.values()]
    return np.unique(np.concatenate([spread, np.array(peaks, dtype=int)]))


def _against_multipliers(
    machine: Machine,
    given: list[Array],
    found: Mapping[str, Array],
    allowed: Array,
    few: NDArray[np.intp],
) -> Array | None:
    """Return how far the values leave the multipliers, over both figures; None without any."""
    names = [name for name in found if not name.startswith("shaking")]
    if not names:
        return None
    there, off = multipliers(machine, *(item[few] for item in given))
    longest = max(abs(length) for length in machine.linkage.lengths.values())
    gaps = [
        np.abs(found[name][few] - there[name]) / (1.0 if name[0] in "xy" else longest)
        for name in names
    ]
    return np.asarray(np.max(gaps, axis=0) / (allowed[few] + off))


class _Balance:
    """Newton's and Euler's equations at some places."""

    def __init__(self, machine: Machine, theta: Array, speed: Array, acceleration: Array) -> None:
        self.machine = machine
        self.motion = machine.linkage.motion(theta, speed, acceleration)
        self.unit = machine.linkage.motion(theta)
        self.inertia = {link: self._momentum(link) for link in machine.linkage.links}
        self.acting = machine.wrenches(self.motion, speed)
        self.outside = machine.wrenches(self.motion, speed, "outside")
        self.longest = max(abs(length) for length in machine.linkage.lengths.values())

    def residuals(self, found: Mapping[str, Array]) -> dict[str, Array]:
        """Return by how much each balance that can be made fails [N]."""
        gaps = {}
        if "torque" in found:
            power = self._power(self.acting) - self._power(self.inertia)
            gaps["power balance"] = (found["torque"] + power) / self.longest
        if "shaking_x" in found:
            fx, fy, _ = self._frame()
            gap = np.hypot(found["shaking_x"] - fx, found["shaking_y"] - fy)
            gaps["shaking force against -dP/dt"] = gap
        if "shaking_moment" in found:
            gap = found["shaking_moment"] - self._frame()[2]
            gaps["shaking moment against -dH/dt"] = gap / self.longest
        if "x12" in found:
            gaps["equilibrium of the links"] = self._statics(found)
        return gaps

    def _momentum(self, link: str) -> Wrench:
        """Return the rate of change of a link's momentum, and of its moment at the first joint."""
        moving, mass = self.motion.link(link), self.machine.mass(link)
        cos, sin = np.cos(moving.angle), np.sin(moving.angle)
        x, y = cos * mass.along - sin * mass.across, sin * mass.along + cos * mass.across
        ax, ay = moving.acceleration[..., 0], moving.acceleration[..., 1]
        alpha, square = moving.angular_acceleration, moving.speed**2
        return (
            mass.mass * ax - alpha * y - square * x,
            mass.mass * ay + alpha * x - square * y,
            mass.inertia * alpha + x * ay - y * ax,
        )

    def _power(self, wrenches: Mapping[str, Wrench]) -> Array:
        """Return the power at a crank speed of 1 rad/s."""
        total: Array = np.zeros(np.shape(self.motion.theta2))
        for link, (fx, fy, couple) in wrenches.items():
            moving = self.unit.link(link)
            vx, vy = moving.velocity[..., 0], moving.velocity[..., 1]
            total = total + fx * vx + fy * vy + couple * moving.speed
        return total

    def _frame(self) -> Wrench:
        """Return what the momenta and the outside leave for the frame, moment about A."""
        total: list[Array] = [np.zeros(np.shape(self.motion.theta2)) for _ in range(3)]
        for wrenches, sign in ((self.inertia, -1.0), (self.outside, 1.0)):
            for link, (fx, fy, couple) in wrenches.items():
                origin = self.motion.link(link).origin
                moment = couple + origin[..., 0] * fy - origin[..., 1] * fx
                parts = zip(total, (fx, fy, moment), strict=True)
                total = [old + sign * part for old, part in parts]
        return total[0], total[1], total[2]

    def _statics(self, found: Mapping[str, Array]) -> Array:
        """Return the worst of the nine equations (Smith 4.4-4.6) [N]."""
        none: Any = np.zeros(np.shape(self.motion.theta2))
        places = self.motion.joints
        meeting = places["B"] if "couple34" in found else places["C"]
        gaps = []
        first = {"12": places["A"], "23": places["B"], "34": meeting, "41": meeting}
        for link, (ahead, behind) in zip(
            self.machine.linkage.links, (("12", "23"), ("23", "34"), ("34", "41")), strict=True
        ):
            origin = self.motion.link(link).origin
            acting = self.acting.get(link, (none, none, none))
            total = [a - b for a, b in zip(acting, self.inertia[link], strict=True)]
            for joint, sign in ((ahead, 1.0), (behind, -1.0)):
                # The follower and the rod turn on their own first joint, where 41 acts.
                arm = (origin if joint == "41" else first[joint]) - origin
                fx, fy = found["x" + joint], found["y" + joint]
                turned = arm[..., 0] * fy - arm[..., 1] * fx + found.get("couple" + joint, none)
                total = [
                    old + sign * part for old, part in zip(total, (fx, fy, turned), strict=True)
                ]
            gaps += [total[0], total[1]]
            if link != "crank":
                gaps.append(total[2] / self.longest)
            elif "torque" in found:
                gaps.append((total[2] + found["torque"]) / self.longest)
        return np.asarray(np.max(np.abs(gaps), axis=0))
