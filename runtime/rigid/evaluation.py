"""The emitted functions of forces at many angles, block by block."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from types import SimpleNamespace
from typing import Any, Literal, TypeAlias

import numpy as np

from ...derive.spec import ModelSpec
from ..core.errors import bad
from ..linkages.linkage import Array, arguments, emitted
from ..linkages.parametric import Parametric
from .machine import Machine, Part, wrenches

Output: TypeAlias = Literal["pins", "torque", "shaking_force", "shaking_moment"]

FRAME_FORCE = ("shaking_x", "shaking_y")
# How the names of what is in N m begin.
COUPLES = ("torque", "shaking_moment", "couple")
# Measured with a dozen outputs: 8192 to 24576 entries take the same time within a few percent.
BLOCK = 8192
# Emitted functions whose names are others than those of their outputs.
_KERNELS = {"pins": "pin_forces", "torque": "driving_torque"}


@cache
def force_kernels(mechanism: str) -> Any:
    """Return the emitted module of a mechanism's forces."""
    name = ModelSpec(mechanism, "forces").name()
    return import_module(f"...generated.{name}", __package__)


def pushes(
    machine: Any, motion: Any, speed: Any, names: Sequence[str], unit: float
) -> Iterator[tuple[list[str], dict[str, Any]]]:
    """Yield what loads and springs do to the links, as the emitted ``load_forces`` takes it.

    Each with the names of the forces that it changes; couples are multiplied by ``unit``.
    """
    # What springs and dampers bring to the frame, its pins bring back.
    inner = [name for name in names if not name.startswith("shaking")]
    parts: tuple[tuple[Part, list[str]], ...] = (("outside", list(names)), ("springs", inner))
    for part, changed in parts:
        by_link = wrenches(machine, motion, speed, part) if changed else {}
        pushed: dict[str, Any] = {}
        for place, link in enumerate(motion.linkage.links, start=2):
            fx, fy, couple = by_link.get(link, (0.0, 0.0, 0.0))
            pushed |= {f"fx{place}": fx, f"fy{place}": fy, f"couple{place}": couple * unit}
        if by_link:
            yield changed, pushed


class Evaluation:
    """The emitted functions at angles, speeds and accelerations whose common shape is ``batch``."""

    def __init__(
        self, machine: Machine, theta: Array, speed: Array, acceleration: Array, batch: Any
    ) -> None:
        self.machine, self.batch, self.theta = machine, batch, theta
        longest = max(abs(size) for size in machine.linkage.lengths.values())
        exponent = int(np.frexp(longest)[1])
        # Lengths from 2^-60 to 2^60 keep their powers within what a float holds; others are scaled.
        self.exponent = exponent if abs(exponent) > 60 else 0
        self.kernels = force_kernels(machine.linkage.mechanism)
        self.numbers = self._numbers(speed, acceleration)

    def values(self, wanted: tuple[Output, ...]) -> dict[str, Array]:
        """Return the wanted forces by name."""
        # Two functions of a part repeat what they share: the one of everything costs less.
        function = _KERNELS.get(wanted[0], wanted[0]) if len(wanted) == 1 else "forces"
        kept = {*wanted, *(FRAME_FORCE if "shaking_force" in wanted else ())}
        kept |= set(self.kernels.RETURNS["pin_forces"]) if "pins" in wanted else set()
        names = [name for name in self.kernels.RETURNS[function] if name in kept]
        out = {name: np.empty(self.batch) for name in names}
        with np.errstate(all="ignore"):
            total = self._add(function, self.numbers, out, names)
            if self.machine.loaded:
                speed, unit = self.numbers["speed"], 2.0**-self.exponent
                motion = self.machine.linkage.motion(self.theta, speed)
                for changed, pushed in pushes(self.machine, motion, speed, names, unit):
                    given = self.numbers | pushed
                    total += self._add("load_forces", given, out, changed, more=True)
        for name in out if self.exponent else ():
            if name.startswith(COUPLES):
                out[name] = np.ldexp(out[name], self.exponent)
        if not math.isfinite(total):
            self.machine.linkage.motion(self.theta)  # says which angle is out of reach
            where = "forces beyond the largest float, or a fold of the linkage"
            fix = "use other units, or keep the angles off the fold"
            raise bad("rigid_forces", where, "finite forces", fix)
        return {name: values[()] for name, values in out.items()}

    def _numbers(self, speed: Array, acceleration: Array) -> dict[str, Any]:
        linkage = self.machine.linkage
        numbers: dict[str, Any] = {"speed": speed, "acceleration": acceleration}
        lengths = linkage.lengths.items()
        numbers |= {name: math.ldexp(size, -self.exponent) for name, size in lengths}
        numbers["assembly"] = linkage.branch
        numbers["winding"] = float(numbers["crank"] > numbers.get("frame", math.inf))
        for place, link in enumerate(linkage.links, start=2):
            mass = self.machine.mass(link)
            numbers[f"mass{place}"] = math.ldexp(mass.mass, self.exponent)
            numbers |= {f"along{place}": mass.along, f"across{place}": mass.across}
            numbers[f"inertia{place}"] = math.ldexp(mass.inertia, -self.exponent)
        return numbers

    def _add(
        self,
        function: str,
        numbers: Mapping[str, Any],
        out: Mapping[str, Array],
        names: list[str],
        more: bool = False,
    ) -> float:
        """Evaluate an emitted function into the named arrays, or add it to what is there.

        In blocks that stay in the processor's cache.  An argument that does not vary along an axis
        is not spread along it: what depends on the crank angle alone is evaluated once for all the
        speeds of a block.  Returns a sum that is no finite number where an entry is none.
        """
        total, size = 0.0, math.prod(self.batch)
        if size == 0 or not names:
            return total
        call: Callable[..., Any] = getattr(self.kernels, function)
        given = [self.theta, *(numbers[name] for name in arguments(call)[1:])]
        # One number as NumPy's, whose powers and quotients overflow without an exception.
        given = [np.float64(item) if np.ndim(item) == 0 else item for item in given]
        returned = self.kernels.RETURNS[function]
        places = [returned.index(name) for name in names]
        watched, batch = {*places[:2], places[-1]}, self.batch
        axis = max(range(len(batch)), key=batch.__getitem__, default=0)
        longest = batch[axis] if batch else 1
        step = max(1, BLOCK * longest // size)
        for start in range(0, longest, step):
            part = slice(start, start + step)
            arrays = call(*(_part(item, part, axis - len(batch) or -1) for item in given))
            arrays = arrays if isinstance(arrays, tuple) else (arrays,)
            at = (slice(None),) * axis + (part,) if batch else ()
            for name, place in zip(names, places, strict=True):
                target = out[name]
                target[at] = target[at] + arrays[place] if more else arrays[place]
            # An angle out of reach spoils every row; what overflows shows in the first ones or the
            # last, to which the others add up.  All of them would take a twentieth of the time.
            for place in watched:
                total += float(np.add.reduce(arrays[place], axis=None))
        return total


def _part(item: Any, part: slice, axis: int) -> Any:
    """Return a part of an argument along an axis counted from the last, where it varies there."""
    if np.ndim(item) < -axis or item.shape[axis] == 1:
        return item
    return item[(..., part) + (slice(None),) * (-axis - 1)]


_OF_A_MASS = ("mass", "along", "across", "inertia")


@dataclass(frozen=True)
class ParametricMachine(Parametric):
    """Motion and forces of a machine at given crank angles as functions of its numbers."""

    machine: Machine
    loads: tuple[Any, ...] = ()  # constant ones, in place of the machine's

    @property
    def values(self) -> dict[str, float]:
        """Every number by name: those of the linkage, ``link.mass`` and so on."""
        values = super().values
        for link in self.linkage.links:
            mass = self.machine.mass(link)
            values |= {f"{link}.{name}": float(getattr(mass, name)) for name in _OF_A_MASS}
        return values

    @property
    def forces(self) -> tuple[str, ...]:
        """Names of the forces."""
        return tuple(force_kernels(self.linkage.mechanism).RETURNS["forces"])

    def _size(self, name: str) -> float:
        if "." not in name:
            return super()._size(name)
        kind = name.partition(".")[2]
        return max(abs(getattr(mass, kind)) for mass in self.machine.masses.values()) or 1.0

    @np.errstate(all="ignore")
    def evaluate(self, numbers: Mapping[str, Any]) -> dict[str, Any]:
        """Return every output of the numbers; what cannot close is not finite."""
        theta = self._angle(numbers)
        moved = self._moved(theta, numbers)
        kernels, links = force_kernels(self.linkage.mechanism), self.linkage.links
        # In a unit of length in which the longest link is near 1, their powers are safe.
        size = 2.0**self.linkage.scale
        units = {"mass": 1.0 / size, "inertia": size}
        lengths = {name: numbers[name] * size for name in self.linkage.names}
        given = {"speed": self.speed, "acceleration": self.acceleration, **lengths}
        masses = {}
        for place, link in enumerate(links, start=2):
            mass = {name: numbers[f"{link}.{name}"] for name in _OF_A_MASS}
            masses[link] = SimpleNamespace(**mass)
            given |= {f"{k}{place}": value * units.get(k, 1.0) for k, value in mass.items()}
        forces = emitted(self.linkage, kernels, "forces", theta, given)
        if self.machine.loaded:
            # Their masses are those of the numbers.
            acting: Any = SimpleNamespace(
                masses=masses,
                gravity=self.machine.gravity,
                loads=self.loads or self.machine.loads,
                springs=self.machine.springs,
            )
            motion = self._motion(theta, numbers, moved)
            for names, pushed in pushes(acting, motion, self.speed, [*forces], size):
                more = emitted(self.linkage, kernels, "load_forces", theta, {**lengths, **pushed})
                forces |= {name: forces[name] + more[name] for name in names}
        moments = {k: value / size for k, value in forces.items() if k.startswith(COUPLES)}
        return moved | forces | moments
