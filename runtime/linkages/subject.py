"""What tolerances act on: the motion of a linkage, or motion and forces, as functions of numbers.

The numbers are the lengths and, of a machine, mass, first moments and inertia of each link.  They
may be arrays (of samples) or dual numbers (of derivatives): the emitted functions take both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...generated import four_bar_kinematics, quick_return_kinematics, slider_crank_kinematics
from ..core.errors import bad
from . import FourBar, Linkage, QuickReturn, SliderCrank
from .dual import Dual, seeded, split
from .pulls import Pose, outside, springs

if TYPE_CHECKING:
    from ..rigid import Machine

Array = NDArray[np.float64]

ANGLE = "theta2"
MOMENTS = ("mass", "along", "across", "inertia")
# How mass, first moments and inertia of a bar grow with its length.
_GROWTH = {"mass": 1, "along": 2, "across": 1, "inertia": 3}
_NAMES = {FourBar: "four_bar", SliderCrank: "slider_crank", QuickReturn: "quick_return"}
_KINEMATICS: dict[str, Any] = {
    "four_bar": four_bar_kinematics,
    "slider_crank": slider_crank_kinematics,
    "quick_return": quick_return_kinematics,
}
_RATES = (
    ("omega3", "alpha3"),
    ("omega4", "alpha4"),
    ("slider_velocity", "slider_acceleration"),
    ("slide_velocity", "slide_acceleration"),
)
_ANGLES = ("theta3", "theta4", "transmission_angle")


@dataclass(frozen=True)
class Subject:
    """A linkage or a machine at given crank angles.

    Attributes
    ----------
    linkage : Linkage
        Lengths and assembly.
    machine : Machine or None
        Its masses, where forces are wanted.
    theta, speed, acceleration : ndarray, shape (...)
        Crank angle [rad], speed [rad/s], acceleration [rad/s^2], of one shape.
    bars : bool
        Whether the masses grow with the links' lengths as those of bars.
    """

    linkage: Linkage
    machine: Machine | None
    theta: Array
    speed: Array
    acceleration: Array
    bars: bool = False

    @cached_property
    def mechanism(self) -> str:
        """Name of the linkage's emitted modules.

        Raises
        ------
        BadInput
            If there are none.
        """
        name = _NAMES.get(type(self.linkage))
        if name is None:
            found = type(self.linkage).__name__
            expected = "a FourBar, a SliderCrank or a QuickReturn"
            raise bad("tolerances", found, expected, "sensitivities of others are not offered")
        return name

    @cached_property
    def values(self) -> dict[str, float]:
        """Every number by name: lengths, what the crank angle is off, ``link.mass`` and so on."""
        found = {name: float(size) for name, size in self.linkage.lengths.items()}
        found[ANGLE] = 0.0
        if self.machine is not None:
            for link in self.linkage.links:
                own = self.machine.mass(link)
                found |= {f"{link}.{name}": float(getattr(own, name)) for name in MOMENTS}
        return found

    @property
    def lengths(self) -> tuple[str, ...]:
        """Names of the lengths."""
        return self.linkage.names

    @cached_property
    def scale(self) -> float:
        """A power of two that brings the lengths below 1, where their squares are safe."""
        return float(2.0 ** -np.frexp(max(abs(v) for v in self.linkage.lengths.values()))[1])

    @cached_property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        names = tuple(_KINEMATICS[self.mechanism].RETURNS["motion"])
        return names if self.machine is None else (*names, *self._module.RETURNS["forces"])

    def unit(self, name: str) -> str:
        """Return the unit of an output."""
        if name in _ANGLES:
            return "rad"
        if name in ("torque", "shaking_moment") or name.startswith("couple"):
            return "N m"
        if name in ("position", "slide"):
            return "m"
        if name.startswith(("omega", "alpha", "slide")):
            relative = np.all(self.speed == 1.0) and np.all(self.acceleration == 0.0)
            base = "m" if name.startswith("slide") else "rad"
            order = "/s" if name.startswith("omega") or name.endswith("velocity") else "/s^2"
            return base.replace("rad", "1") if relative and self.machine is None else base + order
        return "N"

    def evaluate(self, numbers: Mapping[str, Any]) -> dict[str, Any]:
        """Return every output of the numbers, arrays or dual ones, in the units of the result.

        What cannot close is not finite.
        """
        theta = self.theta + numbers[ANGLE]
        with np.errstate(all="ignore"):
            found = self._motion(theta, numbers)
            if self.machine is not None:
                found |= self._forces(theta, numbers, found)
        return found

    def derivatives(
        self, numbers: Mapping[str, Any], names: tuple[str, ...]
    ) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return values of shape (...) and derivatives by the named numbers, shape (n, ...)."""
        duals = seeded(dict(numbers), names)
        batch = np.broadcast_shapes(self.theta.shape, *(np.shape(v) for v in numbers.values()))
        values, slopes = {}, {}
        for name, number in self.evaluate(duals).items():
            values[name], slopes[name] = split(number, batch, len(names))
        return values, slopes

    def _motion(self, theta: Any, numbers: Mapping[str, Any]) -> dict[str, Any]:
        module = _KINEMATICS[self.mechanism]
        taken = tuple(signature(module.motion).parameters)
        given = {name: numbers[name] * self.scale for name in self.lengths if name in taken}
        found = dict(
            zip(module.RETURNS["motion"], self._call(module.motion, theta, given), strict=True)
        )
        for first, second in _RATES:
            if first in found:
                w, a = found[first], found[second]
                found[first] = w * self.speed
                found[second] = a * self.speed**2 + w * self.acceleration
        for name in found:
            if name.startswith(("position", "slide")):
                found[name] = found[name] * (1.0 / self.scale)
        return found

    def _call(self, function: Callable[..., Any], theta: Any, given: dict[str, Any]) -> Any:
        taken = signature(function).parameters
        if "assembly" in taken:
            given["assembly"] = self.linkage.branch
        if "winding" in taken:
            crank, frame = (given[name] for name in ("crank", "frame"))
            longer = np.greater(*(x.value if isinstance(x, Dual) else x for x in (crank, frame)))
            given["winding"] = longer.astype(float)
        return function(theta, **given)

    @cached_property
    def _module(self) -> Any:
        from ...derive.spec import ModelSpec
        from ..core.modules import find_module

        return find_module(ModelSpec(self.mechanism, "forces")).module

    def _forces(
        self, theta: Any, numbers: Mapping[str, Any], motion: Mapping[str, Any]
    ) -> dict[str, Any]:
        module = self._module
        lengths = {name: numbers[name] for name in self.lengths}
        masses: dict[str, Any] = {}
        for place, link in enumerate(self.linkage.links, start=2):
            # A bar's length over its nominal one; the block and the slider are no bars.
            grown: Any = 1.0
            if self.bars and link in lengths:
                grown = lengths[link] * (1.0 / self.linkage.lengths[link])
            for name in MOMENTS:
                factor = grown ** _GROWTH[name] if self.bars and link in lengths else 1.0
                masses[f"{name}{place}"] = numbers[f"{link}.{name}"] * factor
        taken = signature(module.forces).parameters
        geometry = {name: size for name, size in lengths.items() if name in taken}
        drive = {"speed": self.speed, "acceleration": self.acceleration}
        values = self._call(module.forces, theta, {**drive, **geometry, **masses})
        found = dict(zip(module.RETURNS["forces"], values, strict=True))
        if self.machine is None or not self.machine.loaded:
            return found
        pose = Pose(theta, self.speed, lengths, motion)
        by_link = {
            link: (masses[f"mass{n}"], masses[f"along{n}"], masses[f"across{n}"])
            for n, link in enumerate(self.linkage.links, start=2)
        }
        # What springs bring to the frame, its pins bring back.
        inner = [name for name in found if not name.startswith("shaking")]
        for wrenches, names in (
            (outside(self.machine, pose, by_link), list(found)),
            (springs(self.machine, pose), inner),
        ):
            pushes: dict[str, Any] = {}
            for place, link in enumerate(self.linkage.links, start=2):
                parts = wrenches.get(link, (0.0, 0.0, 0.0))
                keys = (f"fx{place}", f"fy{place}", f"couple{place}")
                pushes |= dict(zip(keys, parts, strict=True))
            more = self._call(module.load_forces, theta, {**geometry, **pushes})
            added = dict(zip(module.RETURNS["load_forces"], more, strict=True))
            for name in names:
                found[name] = found[name] + added[name]
        return found

    def require_loads(self) -> None:
        """Refuse what has no known derivative: loads that are functions.

        Raises
        ------
        BadInput
            If the machine has one.
        """
        if self.machine is None:
            return
        moving = any(callable(item.force) or callable(item.couple) for item in self.machine.loads)
        if moving:
            raise bad(
                "tolerances",
                "a machine with a load that is a function",
                "masses, gravity, constant loads and springs",
                "leave it out, or ask for the linkage alone",
            )
