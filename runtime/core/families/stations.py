"""Arrays of emitted modules whose last coordinate is the angle of a link's tangent at stations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .linear_periodic import Array

_SQUARE = ("mass", "damping", "stiffness")
_BY_ROW = (*_SQUARE, "rest", "forces")


@dataclass(frozen=True)
class Stations:
    """Places along a link, and the shapes by which the angle there follows from coordinates.

    Attributes
    ----------
    shapes : ndarray, shape (Q, m)
        Angles at the Q stations per coordinate: the last m coordinates of the system.
    numbers : mapping
        What the module wants of each station, ``(Q,)``, and of pairs of them, symmetric ``(Q, Q)``.
    """

    shapes: Array
    numbers: Mapping[str, Array]

    @cached_property
    def projected(self) -> dict[str, Array]:
        """Kernels between the coordinates, ``(m, m)``, where nothing stands beside them."""
        kernels = {name: n for name, n in self.numbers.items() if n.ndim == 2}
        return {name: self.shapes.T @ kernel @ self.shapes for name, kernel in kernels.items()}


@dataclass(frozen=True)
class AtStations:
    """An emitted function of angles at stations as one of the coordinates they follow from.

    Of coordinates ``(*batch, n)`` the last m give the angles at the stations.  The arrays come
    back by coordinates, as those of :class:`.constrained.Constrained` do.
    """

    module: ModuleType
    name: str
    given: Mapping[str, Callable[[Array, Array], ArrayLike]]
    values: Mapping[str, float]
    stations: Stations

    def __call__(self, *arguments: ArrayLike) -> Mapping[str, Array]:
        """Evaluate at coordinates, more vectors, and time last."""
        *vectors, time = (np.asarray(argument, dtype=float) for argument in arguments)
        first = len(self.module.COORDINATES) - 1
        shapes = self.stations.shapes
        taken: list[Any] = []
        for number, vector in enumerate(vectors):
            if number == 3:  # multipliers follow coordinates, rates and accelerations
                taken += [vector[..., i, None] for i in range(vector.shape[-1])]
                continue
            taken += [vector[..., i, None] for i in range(first)]
            taken.append(vector[..., first:] @ shapes.T)
        taken.append(time[..., None])
        for name in self.module.EXTERNAL:
            taken.append(np.asarray(self.given[name](vectors[0], time))[..., None])
        batch = np.broadcast_shapes(time.shape, *(vector.shape[:-1] for vector in vectors))
        numbers = (self.stations.numbers[name] for name in self.module.STATIONS[1])
        returned = getattr(self.module, self.name)(*taken, *self.values.values(), *numbers)
        places = self.module.ARRAYS[self.name]
        across: dict[tuple[int, str], Array] = {}  # products that several arrays share
        return {
            name: self._array(name, shape, filled, returned, batch, across)
            for name, (shape, filled) in places.items()
        }

    def _array(
        self,
        name: str,
        shape: tuple[int, int],
        filled: tuple[tuple[Any, ...], ...],
        returned: tuple[Any, ...],
        batch: tuple[int, ...],
        across: dict[tuple[int, str], Array],
    ) -> Array:
        """Return an array ``(*batch, rows, columns)`` by coordinates."""
        first = len(self.module.COORDINATES) - 1
        shapes = self.stations.shapes
        more = shapes.shape[1] - 1
        # Rows and columns that stand for coordinates, the others for constraints or alone.
        by = name in _BY_ROW, name in _SQUARE or name.startswith("jacobian")
        array = np.zeros((*batch, *(n + more * own for n, own in zip(shape, by, strict=True))))
        for i, j, at, *product in filled:
            value, rows, columns = returned[at], i == first and by[0], j == first and by[1]
            if product:
                kernel, right = product[0], returned[product[1]]
                if np.size(value) == 1 and np.shape(right)[-1:] in ((), (1,)):
                    constant = self.stations.projected[kernel]
                    array[..., first:, first:] += np.asarray(value * right)[..., None] * constant
                    continue
                if (at, kernel) not in across:
                    before = np.asarray(value)[..., None] * shapes
                    across[at, kernel] = np.swapaxes(self.stations.numbers[kernel] @ before, -1, -2)
                after = np.asarray(right)[..., None] * shapes
                array[..., first:, first:] += across[at, kernel] @ after
            elif rows and columns:
                array[..., first:, first:] += shapes.T @ (value[..., None] * shapes)
            elif rows:
                array[..., first:, j] += value @ shapes
            elif columns:
                array[..., i, first:] += value @ shapes
            else:
                array[..., i, j] = value[..., 0] if np.ndim(value) else value
        return array
