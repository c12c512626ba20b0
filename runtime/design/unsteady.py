"""A linear periodic system whose crank speed changes in time, marched by Gauss collocation."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from ..core.collocation import gauss_maps
from ..core.families import DAMPING, MATRICES, VECTORS, LinearPeriodic
from .speed_profile import Array, SpeedProfile

# Forces of inertia and loads, with the power of the speed.
FORCES = {"f": 2, "h": 1, "p": 0}


@dataclass(frozen=True)
class Drive:
    """Crank angle, speed and acceleration at points of time, ``(nt,)`` each."""

    angle: Array
    speed: Array
    acceleration: Array

    @classmethod
    def of(cls, profile: SpeedProfile, time: Array) -> Drive:
        """Return those of a profile."""
        return cls(profile.angle(time), profile.speed(time), profile.acceleration(time))

    def force(self, arrays: Mapping[str, Array]) -> Array:
        """Return the generalised forces ``td^2 f + td h + p + tdd g``, ``(nt, n)``."""
        total = np.zeros(arrays["K"].shape[:2])
        for name, power in FORCES.items():
            if name in arrays:
                total += self.speed[:, None] ** power * arrays[name]
        if "g" in arrays:
            total += self.acceleration[:, None] * arrays["g"]
        return total


def arrays_of(
    system: LinearPeriodic, drive: Drive, only: Collection[str] | None = None
) -> dict[str, Array]:
    """Return the arrays of a system, or some, along a drive, their powers of the speed included.

    By name, ``(nt, n, n)`` or ``(nt, n)``; those without a term are left out.
    """
    names = [name for name in only or MATRICES + VECTORS if system.has(name)]
    return {name: system.array(name, drive.angle, drive.speed) for name in names}


def generator_of(arrays: Mapping[str, Array], drive: Drive) -> Array:
    """Return L of ``y' = L y`` in time, y = (q, p = M qd + td A q, 1): ``(nt, 2n + 1, 2n + 1)``."""
    count, size, _ = arrays["M"].shape
    speed, acceleration = drive.speed[:, None, None], drive.acceleration[:, None, None]
    none = np.zeros((count, size, size))
    inverse = np.linalg.inv(arrays["M"])
    drift = speed * arrays.get("A", none)
    back = inverse @ drift
    restoring = arrays.get("K", none) + arrays.get("Kg", none)
    restoring = restoring - speed**2 * arrays.get("B", none)
    restoring = restoring - acceleration * arrays.get("S", none)
    if any(name in arrays for name in DAMPING):
        restoring = restoring + speed * arrays.get("D", none)
    push = np.swapaxes(drift, -1, -2) - arrays.get("C", none)
    found = np.zeros((count, 2 * size + 1, 2 * size + 1))
    found[:, :size, :size] = -back
    found[:, :size, size:-1] = inverse
    found[:, size:-1, :size] = -push @ back - restoring
    found[:, size:-1, size:-1] = push @ inverse
    found[:, size:-1, -1] = drive.force(arrays)
    return found


def march(generator: Callable[[Array], Array], edges: Array, start: Array, stages: int) -> Array:
    """Return the states at even times, ``(nt, m)``, by Gauss-Legendre collocation.

    The generator maps times to L of ``y' = L y``.  A-stable: modes far faster than the steps are
    damped or kept, never amplified, and not resolved.
    """
    step = edges[1] - edges[0]
    # Steps whose stage equations, two million numbers, are solved together.
    block = max(1, 2_000_000 // (stages * len(start)) ** 2)
    states = np.empty((len(edges), len(start)))
    states[0] = start
    for first in range(0, len(edges) - 1, block):
        maps = gauss_maps(stages, generator, edges[first:-1][:block], step)
        for k, matrix in enumerate(maps, first):
            states[k + 1] = matrix @ states[k]
    return states
