"""Where a call finds and leaves its numbers: shapes, steps and types, found once for each kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .rewriting import ARRAY, PLAIN, SCALAR, Output

Array: TypeAlias = NDArray[np.float64]
Shape: TypeAlias = tuple[int, ...]

# Arguments that are single numbers, as they stand for themselves in the key of a layout.
_FRACTION, _WHOLE, _SCALAR = "float", "int", "numpy"
NUMBERS: Mapping[type, str] = {float: _FRACTION, int: _WHOLE, np.float64: _SCALAR}
# Outputs over all points, over some of their axes, and those that are arguments.
_ROW, _PART, _GIVEN = "row", "part", "given"
# Points at a time, whose arguments stay in the processor's cache.
_BLOCK = 2048


@dataclass(frozen=True)
class Layout:
    """How the numbers of a call lie.

    Attributes
    ----------
    shape : tuple of int
        To which the arguments broadcast.
    points : int
        Number of points.
    places : ndarray of int
        Starts and steps of the arguments, then of the outputs.
    numbers : tuple of int
        Places of the arguments that are one number for all points; they come first.
    plain : bool
        True where each of these is a Python float.
    arrays : tuple of (int, bool)
        Places of the other arguments, and whether they must be spread over the points.
    size : int
        How many numbers come out.
    constants : tuple
        What is returned, as far as that does not depend on the arguments.
    rows : tuple of int
        Places of the outputs that are arrays over all points; they come out first.
    rest : tuple
        Of the others that depend on the arguments: place, where it starts, kind, and more.
    advance : ndarray of int
        By how much the places move on from one block of points to the next.
    """

    shape: Shape
    points: int
    places: NDArray[np.int64]
    numbers: tuple[int, ...]
    plain: bool
    arrays: tuple[tuple[int, bool], ...]
    size: int
    constants: tuple[Any, ...]
    rows: tuple[int, ...]
    rest: tuple[tuple[int, int, str, Any], ...]
    advance: NDArray[np.int64]

    def evaluated(self, run: Callable[..., None], arguments: Sequence[Any]) -> tuple[Any, ...]:
        """Return the values as the emitted function returns them.

        Parameters
        ----------
        run : callable
            The compiled loop.
        arguments : sequence
            Of the call.
        """
        numbers = [arguments[k] for k in self.numbers]
        if not self.plain:
            numbers = [v.item() if isinstance(v, np.ndarray) else float(v) for v in numbers]
        out = np.empty(self.size)
        arrays = [
            np.broadcast_to(arguments[k], self.shape) if spread else arguments[k]
            for k, spread in self.arrays
        ]
        if not arrays:
            run(self.points, self.places, np.array(numbers), out)
        elif self.points <= _BLOCK:
            values = np.concatenate([np.array(numbers), *arrays], axis=None)
            run(self.points, self.places, values, out)
        else:
            self._in_blocks(run, numbers, [array.reshape(-1) for array in arrays], out)
        return self._returned(out, arguments)

    def _in_blocks(
        self, run: Callable[..., None], numbers: list[float], arrays: list[Array], out: Array
    ) -> None:
        """Run over one block of points after the other."""
        first = len(numbers)
        values = np.empty(first + len(arrays) * _BLOCK)
        values[:first] = numbers
        table = values[first:].reshape(len(arrays), _BLOCK)
        places = self.places.copy()
        count = len(places) // 2 - len(self.constants)
        for row, (k, _) in enumerate(self.arrays):
            places[2 * k] = first + row * _BLOCK
        for start in range(0, self.points, _BLOCK):
            points = min(_BLOCK, self.points - start)
            for own, array in zip(table, arrays, strict=True):
                own[:points] = array[start : start + points]
            run(points, places, values, out)
            places[2 * count :: 2] += self.advance[count:]

    def _returned(self, out: Array, arguments: Sequence[Any]) -> tuple[Any, ...]:
        count = len(self.rows)
        over_points = out[: count * self.points].reshape(count, *self.shape)
        if count == len(self.constants):
            return tuple(over_points)
        found = list(self.constants)
        for place, row in zip(self.rows, over_points, strict=True):
            found[place] = row
        for place, start, kind, more in self.rest:
            found[place] = self._one(out, start, kind, more, arguments)
        return tuple(found)

    def _one(self, out: Array, start: int, kind: str, more: Any, arguments: Sequence[Any]) -> Any:
        if kind == SCALAR:
            return out[start]
        if kind == PLAIN:
            return float(out[start])
        if kind == ARRAY:
            return np.array(out[start])
        if kind == _GIVEN:
            return arguments[more]
        kept, shape = more
        whole = out[start : start + (self.points if kept else 1)]
        if kept:
            whole = whole.reshape(self.shape)[kept]
        return whole.reshape(shape).copy()


def lay_out(outputs: Sequence[Output], count: int, key: Sequence[object]) -> Layout | None:
    """Return the layout of calls whose arguments are numbers or arrays of certain shapes.

    Parameters
    ----------
    outputs : sequence of Output
        Of the function.
    count : int
        Number of its arguments.
    key : sequence
        Of each argument its kind of number, or its shape.

    Returns
    -------
    Layout or None
        None where the emitted function itself has to answer: a wrong number of arguments, shapes
        that do not broadcast, no point at all, or whole numbers that stay whole.
    """
    shapes = [item if isinstance(item, tuple) else () for item in key]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        return None
    points = prod(shape)
    if len(key) != count or points == 0:
        return None
    single = [prod(own) == 1 for own in shapes]
    numbers = tuple(k for k in range(count) if single[k])
    arrays = tuple((k, shapes[k] != shape) for k in range(count) if not single[k])
    places = np.zeros(2 * (count + len(outputs)), dtype=np.int64)
    for start, k in enumerate(numbers):
        places[2 * k] = start
    for start, (k, _) in enumerate(arrays):
        places[2 * k : 2 * k + 2] = len(numbers) + start * points, 1
    forms = [_form(output, key, shapes, shape) for output in outputs]
    if None in forms:
        return None
    rows = tuple(k for k, form in enumerate(forms) if form == (_ROW, None))
    order = [*rows, *(k for k in range(len(outputs)) if k not in rows)]
    size, rest = 0, []
    for k in order:
        kind, more = forms[k] or ("", None)
        long = kind == _ROW or (more is not None and kind == _PART and bool(more[0]))
        places[2 * (count + k) : 2 * (count + k) + 2] = size, int(long)
        if k not in rows and outputs[k].constant is None:
            rest.append((k, size, kind, more))
        size += points if long else 1
    return Layout(
        shape,
        points,
        places,
        numbers,
        all(key[k] == _FRACTION for k in numbers),
        arrays,
        size,
        tuple(output.constant for output in outputs),
        rows,
        tuple(rest),
        _BLOCK * places[1::2] * (np.arange(count + len(outputs)) >= count),
    )


def _form(
    output: Output, key: Sequence[object], shapes: Sequence[Shape], shape: Shape
) -> tuple[str, Any] | None:
    """Return the kind of an output, and what its kind needs; None where it stays a whole number."""
    if output.constant is not None:
        return "", None
    kinds = {key[place] for place in output.arguments}
    if output.kind == PLAIN and kinds == {_WHOLE}:
        return None
    if output.bare:
        return _GIVEN, output.arguments[0]
    own = np.broadcast_shapes(*(shapes[place] for place in output.arguments))
    if not own:
        if output.kind == PLAIN and not kinds <= {_FRACTION, _WHOLE}:
            return SCALAR, None
        return output.kind, None
    if own == shape:
        return _ROW, None
    if prod(own) == 1:
        return _PART, ((), own)
    padded = (1,) * (len(shape) - len(own)) + own
    kept = tuple(slice(None) if a == b else slice(0, 1) for a, b in zip(padded, shape, strict=True))
    return _PART, (kept, own)
