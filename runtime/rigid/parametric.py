"""The forces of a machine as functions of its lengths and masses, for derivatives and samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..linkages.linkage import emitted
from ..linkages.parametric import Parametric
from .evaluation import force_kernels, pushes
from .machine import Machine

# How mass, first moments and inertia of a bar grow with its length.
_GROWTH = {"mass": 1, "along": 2, "across": 1, "inertia": 3}


@dataclass(frozen=True)
class ParametricMachine(Parametric):
    """Motion and forces of a machine at given crank angles as functions of its numbers."""

    machine: Machine
    bars: bool = False  # whether the masses grow with the links' lengths as those of bars
    loads: tuple[Any, ...] = ()  # constant ones, in place of the machine's

    @property
    def values(self) -> dict[str, float]:
        """Every number by name: those of the linkage, ``link.mass`` and so on."""
        values = super().values
        for link in self.linkage.links:
            mass = self.machine.mass(link)
            values |= {f"{link}.{name}": float(getattr(mass, name)) for name in _GROWTH}
        return values

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs."""
        return (*super().outputs, *self.forces)

    @property
    def forces(self) -> tuple[str, ...]:
        """Names of the forces."""
        return tuple(force_kernels(self.linkage.mechanism).RETURNS["forces"])

    def unit(self, name: str) -> str:
        """Return the unit of an output; rates are in time, whatever the speed."""
        if name in self.forces:
            couple = name in ("torque", "shaking_moment") or name.startswith("couple")
            return "N m" if couple else "N"
        return self.linkage.moves.unit_of(name)

    def evaluate(self, numbers: Mapping[str, Any]) -> dict[str, Any]:
        """Return every output of the numbers; what cannot close is not finite."""
        theta = self._angle(numbers)
        with np.errstate(all="ignore"):
            moved = self._moved(theta, numbers)
            return moved | self._forces(theta, numbers, moved)

    def _size(self, name: str) -> float:
        if "." not in name:
            return super()._size(name)
        kind = name.partition(".")[2]
        return max(abs(getattr(mass, kind)) for mass in self.machine.masses.values()) or 1.0

    def _forces(
        self, theta: Any, numbers: Mapping[str, Any], moved: Mapping[str, Any]
    ) -> dict[str, Any]:
        kernels, links = force_kernels(self.linkage.mechanism), self.linkage.links
        # In a unit of length in which the longest link is near 1, their powers are safe.
        size = 2.0**self.linkage.scale
        units = {"mass": 1.0 / size, "inertia": size}
        lengths = {name: numbers[name] * size for name in self.linkage.names}
        given = {"speed": self.speed, "acceleration": self.acceleration, **lengths}
        masses = {}
        for place, link in enumerate(links, start=2):
            mass = self._mass(link, numbers)
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
        return {k: value / size if self.unit(k) == "N m" else value for k, value in forces.items()}

    def _mass(self, link: str, numbers: Mapping[str, Any]) -> dict[str, Any]:
        mass = {name: numbers[f"{link}.{name}"] for name in _GROWTH}
        # The block and the slider are no bars.
        if not self.bars or link not in self.linkage.names:
            return mass
        grown = numbers[link] / self.linkage.lengths[link]
        return {name: value * grown ** _GROWTH[name] for name, value in mass.items()}
