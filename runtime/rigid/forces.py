"""Inverse dynamics of a rigid machine: pin forces, driving torque, shaking force and moment."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.deferred import Deferred
from ..core.errors import bad
from ..core.results import DeferredChecks, provenance
from .blocks import Array, evaluate
from .force_modules import force_module
from .force_result import FRAME_FORCE, RigidForces
from .machine import Machine

Output: TypeAlias = Literal["pins", "torque", "shaking_force", "shaking_moment"]
OUTPUTS: tuple[Output, ...] = ("pins", "torque", "shaking_force", "shaking_moment")

_KERNELS = {
    "pins": "pin_forces",
    "torque": "driving_torque",
    "shaking_force": "shaking_force",
    "shaking_moment": "shaking_moment",
}
_OWN_NAMES = {
    "torque": ("torque",),
    "shaking_force": FRAME_FORCE,
    "shaking_moment": ("shaking_moment",),
}
# What springs and dampers bring to the frame, its pins bring back: they change none of these.
_FRAME_NAMES = (*FRAME_FORCE, "shaking_moment")
# Lengths from 2^-60 to 2^60 keep their powers within what a float holds; others are scaled.
_SAFE_EXPONENT = 60


def rigid_forces(
    machine: Machine,
    theta: ArrayLike,
    speed: ArrayLike,
    acceleration: ArrayLike = 0.0,
    outputs: Sequence[Output] = OUTPUTS,
) -> RigidForces:
    """Return the forces in a rigid machine whose crank moves as prescribed (Smith 4.7-4.13).

    Parameters
    ----------
    machine : Machine
        Linkage, masses, gravity, loads, springs.
    theta, speed, acceleration : array_like
        Crank angle [rad], crank speed [rad/s], crank acceleration [rad/s^2]; they broadcast.
    outputs : sequence of str
        Some of ``"pins"``, ``"torque"``, ``"shaking_force"``, ``"shaking_moment"``.  What is left
        out is not computed; each one alone takes its own shortest way.

    Returns
    -------
    RigidForces
        The shaking force is the resultant of all that the machine does to the frame, the weight
        of the frame apart: ``-dP/dt`` + applied loads + weights of the links.  A spring to the
        frame is part of the machine: what it does to the frame is counted, so that springs do not
        change the shaking force.  The shaking moment is that of the same forces about A, with the
        reaction of the drive: ``-dH_A/dt`` + moments of loads and weights.  (Smith's (4.13) lacks
        the reaction: without springs, M = l1 Y41 - T.)

    Raises
    ------
    BadInput
        If an output is unknown, shapes do not broadcast, a number is not finite, or the linkage
        cannot reach an angle or folds there.

    Examples
    --------
    >>> from elastolink import FourBar, MassDistribution
    >>> bar = MassDistribution.uniform_bar(mass=0.45, length=0.3)
    >>> machine = Machine(FourBar(0.3, 0.15, 0.3, 0.3), {"coupler": bar, "follower": bar})
    >>> rigid_forces(machine, theta=[0.0, 1.0], speed=10.0).f34.shape
    (2, 2)
    """
    wanted = _wanted(outputs)
    _require_machine(machine)
    angles, speeds, accelerations = (
        _numbers(name, value)
        for name, value in (("theta", theta), ("speed", speed), ("acceleration", acceleration))
    )
    batch = _common_shape(angles, speeds, accelerations)
    values = Evaluation(machine, angles, speeds, accelerations, batch).values(wanted)
    from . import force_checks, force_errors

    state = (machine, angles, speeds, accelerations)
    return RigidForces(
        theta2=angles,
        speed=speeds,
        acceleration=accelerations,
        values=values,
        method="closed form",
        error=Deferred(partial(force_errors.figure, *state)),
        error_norm=force_errors.NORM,
        checks=DeferredChecks(partial(force_checks.checks, *state, values)),
        provenance=provenance(described(machine)),
    )


def pin_forces(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the pin forces alone (Smith 4.7-4.10); see :func:`rigid_forces`."""
    return rigid_forces(machine, theta, speed, acceleration, ("pins",))


def driving_torque(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the driving torque alone (Smith 4.11); see :func:`rigid_forces`."""
    return rigid_forces(machine, theta, speed, acceleration, ("torque",))


def shaking_force(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the force on the frame alone (Smith 4.12); see :func:`rigid_forces`."""
    return rigid_forces(machine, theta, speed, acceleration, ("shaking_force",))


def shaking_moment(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the moment on the frame alone (Smith 4.13, completed); see :func:`rigid_forces`."""
    return rigid_forces(machine, theta, speed, acceleration, ("shaking_moment",))


class Evaluation:
    """The emitted functions at given angles, speeds and accelerations.

    Parameters
    ----------
    machine : Machine
        The machine.
    theta, speed, acceleration : ndarray
        Crank angle [rad], speed [rad/s], acceleration [rad/s^2].
    batch : tuple of int
        Their common shape.

    Raises
    ------
    BadInput
        If there is no emitted module for the linkage.
    """

    def __init__(
        self, machine: Machine, theta: Array, speed: Array, acceleration: Array, batch: Any
    ) -> None:
        self.machine, self.batch = machine, batch
        self.theta, self.speed, self.acceleration = theta, speed, acceleration
        longest = max(abs(size) for size in machine.linkage.lengths.values())
        exponent = int(np.frexp(longest)[1])
        self.exponent = exponent if abs(exponent) > _SAFE_EXPONENT else 0
        self.kernels = force_module(machine)

    def values(self, wanted: tuple[Output, ...]) -> dict[str, Array]:
        """Return the wanted forces by name.

        Raises
        ------
        BadInput
            If one is not finite.
        """
        names: list[str] = []
        calls: list[tuple[str, list[str]]] = []
        for function in self._functions(wanted):
            returned = self.kernels.returned[function]
            own = [name for name in returned if name in self._names(wanted)]
            calls.append((function, own))
            names += own
        out = np.empty((len(names), *self.batch))
        rows = {name: place for place, name in enumerate(names)}
        with np.errstate(all="ignore"):
            total = sum(self._inertia(out, rows, *call) for call in calls)
            if self.machine.loaded:
                total += self._loads(out, rows)
        if self.exponent:
            for name in ("torque", "shaking_moment", "couple34", "couple41"):
                if name in rows:
                    out[rows[name]] = np.ldexp(out[rows[name]], self.exponent)
        if not math.isfinite(total):
            self._refuse()
        return {name: out[row] for name, row in rows.items()}

    def _functions(self, wanted: tuple[Output, ...]) -> list[str]:
        # Two functions of a part repeat what they share: the one of everything costs less.
        return [_KERNELS[wanted[0]]] if len(wanted) == 1 else ["forces"]

    def _names(self, wanted: tuple[Output, ...]) -> set[str]:
        names = {name for output in wanted for name in _OWN_NAMES.get(output, ())}
        return names | (set(self.kernels.returned["pin_forces"]) if "pins" in wanted else set())

    def _inertia(self, out: Array, rows: Mapping[str, int], function: str, own: list[str]) -> float:
        motion = [_plain(self.theta), _plain(self.speed), _plain(self.acceleration)]
        masses: list[float] = []
        for link in self.machine.linkage.links:
            mass = self.machine.mass(link)
            masses += [math.ldexp(mass.mass, self.exponent), mass.along, mass.across]
            masses.append(math.ldexp(mass.inertia, -self.exponent))
        arguments = [*motion, *self._geometry(), *map(np.float64, masses)]
        return self._evaluate(function, arguments, out, rows, own)

    def _loads(self, out: Array, rows: Mapping[str, int]) -> float:
        motion = self.machine.linkage.motion(self.theta, self.speed)
        outside = self.machine.wrenches(motion, self.speed, "outside")
        springs = self.machine.wrenches(motion, self.speed, "springs")
        total = 0.0
        inner = [name for name in rows if name not in _FRAME_NAMES]
        for wrenches, own in ((outside, list(rows)), (springs, inner)):
            if not (wrenches and own):
                continue
            parts: list[Any] = []
            for link in self.machine.linkage.links:
                fx, fy, couple = wrenches.get(link, (0.0, 0.0, 0.0))
                parts += [fx, fy, np.ldexp(couple, -self.exponent)]
            arguments = [_plain(self.theta), *self._geometry(), *map(_plain, parts)]
            total += self._evaluate("load_forces", arguments, out, rows, own, add=True)
        return total

    def _evaluate(
        self,
        function: str,
        arguments: Sequence[Any],
        out: Array,
        rows: Mapping[str, int],
        own: list[str],
        add: bool = False,
    ) -> float:
        returned = self.kernels.returned[function]
        places = [(rows[name], returned.index(name)) for name in own]
        call: Callable[..., Any] = getattr(self.kernels.module, function)
        return evaluate(call, arguments, out, places, add=add)

    def _geometry(self) -> list[np.float64]:
        lengths = self.machine.linkage.lengths
        return [
            np.float64(math.ldexp(value, -self.exponent) if name in lengths else value)
            for name, value in self.kernels.geometry(self.machine.linkage)
        ]

    def _refuse(self) -> None:
        """Say why something is not finite: an angle out of reach, or numbers too large."""
        self.machine.linkage.motion(self.theta)
        found = "forces beyond the largest float, or a fold of the linkage"
        fix = "use other units, or keep the angles off the fold"
        raise bad("rigid_forces", found, "finite forces", fix)


def _wanted(outputs: Sequence[Output]) -> tuple[Output, ...]:
    given = (outputs,) if isinstance(outputs, str) else tuple(outputs)
    unknown = [item for item in given if item not in OUTPUTS]
    if unknown or not given:
        raise bad("outputs", f"{unknown or 'nothing'}", f"some of {OUTPUTS}", "correct the names")
    return tuple(output for output in OUTPUTS if output in given)


def _require_machine(machine: object) -> None:
    if not isinstance(machine, Machine):
        raise bad("machine", type(machine).__name__, "a Machine", "build one")


def _numbers(name: str, value: ArrayLike) -> Array:
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError) as refusal:
        raise bad(name, repr(value)[:60], "numbers", "correct it") from refusal


def _common_shape(theta: Array, speed: Array, acceleration: Array) -> tuple[int, ...]:
    for name, array in (("speed", speed), ("acceleration", acceleration)):
        if not np.all(np.isfinite(array)):
            raise bad(name, "a value that is not finite", "finite numbers", "remove it")
    try:
        return np.broadcast_shapes(theta.shape, speed.shape, acceleration.shape)
    except ValueError as refusal:
        found = f"shapes {theta.shape}, {speed.shape}, {acceleration.shape}"
        fix = "give one speed, or one for each angle"
        raise bad("theta, speed, acceleration", found, "shapes that broadcast", fix) from refusal


def _plain(value: Any) -> Any:
    """Return one number as NumPy's, whose powers and quotients overflow without an exception."""
    return np.float64(value) if np.ndim(value) == 0 else value


def described(machine: Machine) -> dict[str, str]:
    """Return lengths, assembly and masses for the provenance."""
    lengths = machine.linkage.lengths.items()
    found = {f"links.{name}": repr(float(size)) for name, size in lengths}
    found["links.assembly"] = str(getattr(machine.linkage, "assembly", ""))
    for link, mass in machine.masses.items():
        numbers = (mass.mass, mass.along, mass.across, mass.inertia)
        found[f"masses.{link}"] = " ".join(repr(float(number)) for number in numbers)
    return found
