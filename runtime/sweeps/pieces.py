"""The grid of a sweep and its pieces, whose borders depend on nothing but the request."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.families import Array
from ..core.inputs import is_whole

_MOST_POINTS = 10**12


@dataclass(frozen=True)
class Grid:
    """All combinations of values along named axes, the last axis running fastest.

    ``parts`` are into how many parts each axis is cut: every axis after the first that is cut is
    whole, and every one before it cut to single values, so that a piece is a run of the grid.
    """

    names: tuple[str, ...]
    axes: tuple[Array, ...]
    parts: tuple[int, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each axis."""
        return tuple(len(axis) for axis in self.axes)

    @property
    def points(self) -> int:
        """Number of combinations."""
        return prod(self.shape)

    @property
    def pieces(self) -> int:
        """Number of pieces."""
        return prod(self.parts)

    def slices(self, number: int) -> tuple[slice, ...]:
        """Return where a piece lies along each axis."""
        found = []
        for place, size, parts in zip(
            np.unravel_index(number, self.parts), self.shape, self.parts, strict=True
        ):
            first, last = (int(k) * size // parts for k in (place, place + 1))
            found.append(slice(first, last))
        return tuple(found)

    def run(self, number: int) -> slice:
        """Return which points of the grid, counted along the last axis first, a piece holds."""
        slices = self.slices(number)
        start = int(np.ravel_multi_index([part.start for part in slices], self.shape))
        return slice(start, start + prod(part.stop - part.start for part in slices))

    def values(self, number: int) -> dict[str, Array]:
        """Return the values of a piece along each axis, by name."""
        slices = self.slices(number)
        return {
            name: axis[part] for name, axis, part in zip(self.names, self.axes, slices, strict=True)
        }


def grid_of(values: Mapping[str, ArrayLike], chunk: int, *, rows: bool = False) -> Grid:
    """Return the grid of a sweep, cut into pieces of about ``chunk`` points."""
    if not is_whole(chunk, 1):
        raise bad("chunk", repr(chunk), "a whole number of points, 1 or more", "leave it out")
    if not isinstance(values, Mapping) or not values:
        fix = 'give values={"speed": numpy.linspace(...)}'
        raise bad("values", repr(values)[:60], "values along at least one named axis", fix)
    names = tuple(values)
    axes = tuple(_axis(name, values[name]) for name in names)
    shape = [len(axis) for axis in axes]
    if prod(shape) > _MOST_POINTS:
        found = f"{prod(shape):.3g} points"
        raise bad("values", found, f"at most {_MOST_POINTS:.0e}", "take fewer")
    parts = [1] * len(shape)
    inner = 1
    for axis in range(len(shape) - 1, -1, -1):
        size = shape[axis]
        together = max(1, int(chunk) // inner)
        if rows and axis == len(shape) - 1:
            together = size
        elif rows and axis == len(shape) - 2:
            together = max(2, together)
        if together < size:
            parts[axis] = -(-size // together)
            if rows and size // parts[axis] < 2:
                parts[axis] = max(1, size // together)
            parts[:axis] = shape[:axis]
            break
        inner *= size
    return Grid(names, axes, tuple(parts))


def _axis(name: object, given: ArrayLike) -> Array:
    if not isinstance(name, str) or not name:
        raise bad("values", f"an axis called {name!r}", "a name", "name it by its parameter")
    try:
        values = np.array(given, dtype=float)
    except (TypeError, ValueError):
        raise bad(f"values of {name}", repr(given)[:60], "numbers", "correct them") from None
    if values.ndim != 1 or not values.size or not np.all(np.isfinite(values)):
        found = f"shape {values.shape}" if values.ndim != 1 or not values.size else "one not finite"
        expected = "at least one finite value, all in a line"
        raise bad(f"values of {name}", found, expected, "give a range")
    values.setflags(write=False)
    return values
