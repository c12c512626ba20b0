"""Arrays of emitted modules whose last coordinate is the angle of a link's tangent at stations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
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
    def between(self) -> dict[str, Array]:
        """Kernels from stations to coordinates and stations, ``(Q, m Q)``."""
        count, m = self.shapes.shape
        return {
            name: (self.shapes[:, :, None] * kernel[:, None]).reshape(count, m * count)
            for name, kernel in self.numbers.items()
            if kernel.ndim == 2
        }

    @cached_property
    def pairs(self) -> Array:
        """Products of shapes, from stations to pairs of coordinates, ``(Q, m m)``."""
        both = self.shapes[:, :, None] * self.shapes[:, None]
        return np.asarray(both.reshape(len(both), -1))

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
        first, shapes = len(self.module.COORDINATES) - 1, self.stations.shapes
        taken: list[Any] = []
        for number, vector in enumerate(vectors):
            if number == 3:  # multipliers follow coordinates, rates and accelerations
                taken += [vector[..., i : i + 1] for i in range(vector.shape[-1])]
                continue
            taken += [vector[..., i : i + 1] for i in range(first)]
            taken.append(vector[..., first:] @ shapes.T)
        taken.append(time[..., None])
        for name in self.module.EXTERNAL:
            taken.append(np.asarray(self.given[name](vectors[0], time))[..., None])
        batch = np.broadcast_shapes(time.shape, *(vector.shape[:-1] for vector in vectors))
        numbers = (self.stations.numbers[name] for name in self.module.STATIONS[1])
        returned = getattr(self.module, self.name)(*taken, *self.values.values(), *numbers)
        across: dict[tuple[int, str], Array] = {}  # products that several arrays share
        arrays = {}
        for name, shape, entries in _plan(self.module, self.name, shapes.shape[1] - 1):
            array = arrays[name] = np.zeros((*batch, *shape))
            block, weighted = array[..., first:, first:], []
            for kind, i, j, at, *product in entries:
                value = returned[at]
                if kind == "entry":
                    array[..., i, j] = value[..., 0] if isinstance(value, np.ndarray) else value
                elif kind == "row":
                    array[..., first:, j] += _times(value, shapes)
                elif kind == "column":
                    array[..., i, first:] += _times(value, shapes)
                elif kind == "diagonal":
                    block += _split(_times(value, self.stations.pairs), *block.shape[-2:])
                else:
                    kernel, place = product
                    right = returned[place]
                    if _alone(value) and _alone(right):
                        between = np.asarray(value * right)[..., None]
                        block += between * self.stations.projected[kernel]
                        continue
                    if (at, kernel) not in across:
                        by_row = _times(value, self.stations.between[kernel])
                        across[at, kernel] = _split(by_row, *shapes.T.shape)
                    weighted.append(across[at, kernel] * np.asarray(right)[..., None, :])
            if weighted:
                block += _times(sum(weighted[1:], weighted[0]), shapes)
        return arrays


def _alone(value: Any) -> bool:
    """Return True for what is the same at all stations."""
    return not isinstance(value, np.ndarray) or value.shape[-1:] in ((), (1,))


def _times(many: Array, matrix: Array) -> Array:
    """Return ``many @ matrix`` of rows ``(*batch, Q)`` as one product."""
    if _alone(many):
        many = np.broadcast_to(many, (*np.shape(many)[:-1], len(matrix)))
    if many.ndim <= 2:
        return np.asarray(many @ matrix)
    flat = many.reshape(-1, many.shape[-1]) @ matrix
    return np.asarray(flat.reshape(*many.shape[:-1], matrix.shape[1]))


def _split(rows: Array, count: int, each: int) -> Array:
    """Return rows ``(*batch, count * each)`` as matrices, ``(*batch, count, each)``."""
    return rows.reshape(*rows.shape[:-1], count, each)


@lru_cache(maxsize=64)
def _plan(
    module: ModuleType, function: str, more: int
) -> list[tuple[str, tuple[int, ...], list[tuple[Any, ...]]]]:
    """Return by array its shape by coordinates, and where what a function returns goes.

    The last of the module's coordinates stands for ``more`` besides.
    """
    first = len(module.COORDINATES) - 1
    plan = []
    for name, (shape, filled) in module.ARRAYS[function].items():
        # Rows and columns that stand for coordinates, the others for constraints or alone.
        by = name in _BY_ROW, name in _SQUARE or name.startswith("jacobian")
        entries: list[tuple[Any, ...]] = []
        for i, j, *rest in filled:
            place = (i == first and by[0], j == first and by[1])
            entries.append(("product" if len(rest) > 1 else _KINDS[place], i, j, *rest))
        full = tuple(n + more * own for n, own in zip(shape, by, strict=True))
        plan.append((name, full, entries))
    return plan


_KINDS = {
    (True, True): "diagonal",
    (True, False): "row",
    (False, True): "column",
    (False, False): "entry",
}
