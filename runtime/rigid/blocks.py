"""Long arrays through emitted functions in blocks that stay in the processor's cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

# Measured with a dozen outputs: 8192 to 24576 entries take the same time within a few percent.
BLOCK = 8192


def evaluate(
    function: Callable[..., Any],
    arguments: Sequence[Any],
    out: Array,
    rows: Sequence[tuple[int, int]],
    *,
    add: bool = False,
    block: int = BLOCK,
) -> float:
    """Evaluate a function that broadcasts, block by block, into prepared arrays.

    An argument that does not vary along an axis is not spread along it: what depends on the crank
    angle alone is evaluated once for all the speeds of a block.

    Parameters
    ----------
    function : callable
        Returns an array, or a tuple of arrays, that broadcast to the batch.
    arguments : sequence of float or ndarray
        They broadcast to the batch.
    out : ndarray, shape (k, *batch)
        Filled.
    rows : sequence of (int, int)
        Row of ``out``, and the place of what belongs there among the returned arrays.
    add : bool
        Add to what is there, instead of replacing it.
    block : int
        Number of entries in a block.

    Returns
    -------
    float
        The sum of some of the returned arrays: no finite number where an entry is none.
    """
    total = 0.0
    if out.size == 0 or not rows:
        return total
    watched = {rows[0][1], rows[min(1, len(rows) - 1)][1], rows[-1][1]}
    varying = [isinstance(item, np.ndarray) and item.ndim > 0 for item in arguments]
    for where in _blocks(out.shape[1:], block):
        parts = [
            _part(item, where) if varies else item
            for item, varies in zip(arguments, varying, strict=True)
        ]
        returned = function(*parts)
        found = returned if isinstance(returned, tuple) else (returned,)
        into: Any = (slice(None), *where)
        target = out[into]
        for row, place in rows:
            if add:
                target[row] += found[place]
            else:
                target[row] = found[place]
        # An angle out of reach spoils every row; what overflows shows in the first ones or the
        # last, to which the others add up.  All of them would take a twentieth of the time.
        for place in watched:
            total += float(np.add.reduce(found[place], axis=None))
    return total


def _part(array: Array, where: tuple[slice, ...]) -> Array:
    """Return the part of an array that broadcasts to a block."""
    own = where[len(where) - array.ndim :]
    index = tuple(s if n > 1 else slice(None) for s, n in zip(own, array.shape, strict=True))
    return array[index]


def _blocks(batch: tuple[int, ...], block: int) -> Iterator[tuple[slice, ...]]:
    """Yield the index of each block: long in the last axes, of at most ``block`` entries."""
    lengths: list[int] = []
    left = block
    for size in reversed(batch):
        lengths.insert(0, max(1, min(size, left)))
        left = max(1, left // lengths[0])
    ranges = [range(0, size, step) for size, step in zip(batch, lengths, strict=True)]
    for starts in product(*ranges):
        yield tuple(slice(a, a + step) for a, step in zip(starts, lengths, strict=True))
