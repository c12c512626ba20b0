"""The inextensible coupler with its constraints: all matrices of the module's own coordinates.

A second route to what the runtime projects at the stations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from elastolink.runtime.core.families import Constrained
from elastolink.runtime.core.families.nonlinear import Reduced

_BY_ROW = ("mass", "damping", "stiffness", "rest", "forces")
_BY_COLUMN = ("mass", "damping", "stiffness", "jacobian", "jacobian_rate", "jacobian_acceleration")


@dataclass(frozen=True)
class Whole:
    """A function of an emitted module, in its first coordinate and amplitudes of the angles.

    ``shapes``: angles at the stations per amplitude, ``(Q, m)``; ``numbers``: of stations and
    pairs; ``external``: functions of state and time.
    """

    module: ModuleType
    name: str
    values: Mapping[str, float]
    shapes: np.ndarray
    numbers: Mapping[str, np.ndarray]
    external: Mapping[str, object]

    def __call__(self, *arguments):
        *vectors, time = (np.asarray(argument, dtype=float) for argument in arguments)
        batch = np.broadcast_shapes(time.shape, *(vector.shape[:-1] for vector in vectors))
        rows = [
            np.broadcast_to(vector, (*batch, vector.shape[-1])).reshape(-1, vector.shape[-1])
            for vector in vectors
        ]
        given = [
            np.broadcast_to(self.external[n](vectors[0], time), batch).ravel()
            for n in self.module.EXTERNAL
        ]
        taken = [part for row in rows[:3] for part in (row[:, 0], self.shapes @ row[:, 1:].T)]
        taken += [multiplier for row in rows[3:] for multiplier in row.T]
        numbers = (self.numbers[name] for name in self.module.STATIONS[2])
        returned = getattr(self.module, self.name)(
            *taken,
            np.broadcast_to(time, batch).ravel(),
            *given,
            *(self.values[name] for name in self.module.PARAMETERS),
            *(np.cos(taken[1]), np.sin(taken[1])),
            *(number if number.ndim == 2 else number[:, None] for number in numbers),
        )
        arrays = {}
        for name, (shape, entries) in self.module.ARRAYS[self.name].items():
            array = self.filled(name, shape, entries, returned, len(rows[0]))
            arrays[name] = array.reshape(*batch, *array.shape[1:])
        return arrays

    def filled(self, name, shape, entries, returned, count):
        stations = len(self.shapes)
        own = name in _BY_ROW, name in _BY_COLUMN
        full = np.zeros((count, *(n + (stations - 1) * own[k] for k, n in enumerate(shape))))
        each = slice(1, None)

        def of(value):  # (N, Q) or (N, 1)
            value = np.asarray(value, dtype=float)
            return np.broadcast_to(value, (stations if value.ndim == 2 else 1, count)).T

        # What a station's Coriolis terms by its own rate leave, nothing, comes before damping.
        for i, j, at, *product in reversed(entries):
            value = of(returned[at])
            row, column = own[0] and i == 1, own[1] and j == 1
            if product:
                kernel, right = self.numbers[product[0]], of(returned[product[1]])
                full[:, each, each] += value[:, :, None] * kernel * right[:, None]
            elif row and column:
                full[:, each, each] += value[:, :, None] * np.eye(stations)
            elif row:
                full[:, each, j] += value
            elif column:
                full[:, i, each] += value
            else:
                full[:, i, j] += value[:, 0]
        both = np.zeros((1 + stations, 1 + self.shapes.shape[1]))
        both[0, 0], both[1:, 1:] = 1.0, self.shapes
        full = both.T @ full if own[0] else full
        return full @ both if own[1] else full


def constrained(module, values, shapes, numbers, external) -> Constrained:
    """Return the constrained system of a module at numbers; see :class:`Whole`."""
    functions = (
        Whole(module, name, values, shapes, numbers, external)
        for name in ("dynamics", "constraints", "variations")
    )
    return Constrained(1 + shapes.shape[1], len(module.MULTIPLIERS), *functions)


def turning(system, parameters, external) -> Constrained:
    """Return a coupler with its first coordinate and mean angle, whose crank turns as given."""
    equations = system.equations
    stations = equations.stations(parameters)
    shapes = np.vstack([np.ones(stations.shapes.shape[1]), stations.shapes]).T
    return constrained(equations.module, parameters, shapes, stations.numbers, external)


def with_constraints(system) -> Reduced:
    """Return the equations of a coupler as those of the constrained system, reduced by matrices."""

    def make(parameters, drive):
        names = system.equations.module.EXTERNAL
        external = {
            name: lambda q, t, value=value: value for name, value in zip(names, drive, strict=True)
        }
        return turning(system, parameters, external)

    def guess(q, drive, parameters):
        chord = np.mean(np.exp(1j * (q @ system.equations.stations(parameters).shapes)), axis=-1)
        return np.moveaxis(system.equations.guess(chord, drive, parameters), 0, -1)

    free = tuple(range(2, system.size + 2))
    return Reduced(make, free, (0, 1), guess)
