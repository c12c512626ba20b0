"""Array namespaces beside NumPy's: which one arrays belong to, and what solvers need in any.

An array says which namespace it belongs to (``__array_namespace__`` of the Python array API
standard); what does not is taken for NumPy's.  Coefficients of methods and angles are NumPy's
own, and are carried into the namespace of the arrays that they meet.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import bad

Array = NDArray[np.float64]

# The kind of device, in DLPack's numbering, whose memory NumPy sees.
_HOST = 1


def is_foreign(value: object) -> bool:
    """Return True for an array of another namespace than NumPy's."""
    return hasattr(value, "__array_namespace__") and not isinstance(value, (np.ndarray, np.generic))


def namespace_of(array: Any) -> Any:
    """Return the namespace of an array, NumPy where it names none."""
    if isinstance(array, np.ndarray) or not is_foreign(array):
        return np
    return array.__array_namespace__()


def in_numpy(array: Any) -> bool:
    """Return True for an array of NumPy, which may be filled in place."""
    return isinstance(array, np.ndarray)


def carried(values: Array, like: Any) -> Any:
    """Return NumPy values in namespace, precision and device of another array."""
    if isinstance(like, np.ndarray):
        return values
    return namespace_of(like).asarray(values, dtype=like.dtype, device=like.device)


def identity(size: int, like: Any) -> Any:
    """Return the identity matrix in namespace, precision and device of an array."""
    if isinstance(like, np.ndarray):
        return np.eye(size)
    return namespace_of(like).eye(size, dtype=like.dtype, device=like.device)


def to_numpy(array: Any) -> NDArray[Any]:
    """Return a copy of an array in NumPy, from whatever device it is on."""
    if not hasattr(array, "__dlpack_device__"):
        return np.array(array)
    if array.__dlpack_device__()[0] == _HOST:
        return np.array(np.from_dlpack(array))
    return np.array(np.from_dlpack(array, device="cpu"))


def in_numpy_if_foreign(value: Any) -> Any:
    """Return an array of another namespace as one of NumPy, and anything else as it is."""
    return to_numpy(value) if is_foreign(value) else value


def common_array(values: Mapping[str, Any]) -> Any:
    """Return a zero of double precision from the namespace of named arguments; None for NumPy.

    Raises
    ------
    BadInput
        If arrays are of different namespaces or devices, are neither of double precision nor whole
        numbers, or their namespace does not solve linear systems.
    """
    first, named = None, ""
    for name, value in values.items():
        if is_foreign(value):
            _require_double(name, value)
            if first is None:
                first, named = value, name
    if first is None:
        return None
    xp = namespace_of(first)
    if not hasattr(xp, "linalg"):
        raise bad(named, _name(xp), "a namespace with linalg", "give NumPy arrays")
    for name, value in values.items():
        other = np.ndim(value) > 0 if isinstance(value, np.ndarray) else is_foreign(value)
        if not other:
            continue
        if namespace_of(value) is not xp:
            found = f"{_name(xp)} and {_name(namespace_of(value))}"
            raise bad(f"{named} and {name}", found, "arrays of one namespace", "convert one")
        if str(value.device) != str(first.device):
            found = f"devices {first.device} and {value.device}"
            raise bad(f"{named} and {name}", found, "arrays on one device", "move one")
    return xp.zeros((), dtype=xp.float64, device=first.device)


def _require_double(name: str, value: Any) -> None:
    xp = namespace_of(value)
    double = getattr(xp, "float64", None)
    if value.dtype != double and not xp.isdtype(value.dtype, "integral"):
        raise bad(
            name,
            f"an array of {value.dtype} of {_name(xp)}",
            "double precision, float64",
            "convert it: error figures are those of double precision",
        )


def _name(namespace: Any) -> str:
    return str(getattr(namespace, "__name__", namespace))


class BlockMatrices:
    """Square matrices made of sums of blocks: filled in place in NumPy, joined elsewhere.

    Parameters
    ----------
    lead : tuple of int
        Shape in front of the matrices.
    sizes : tuple of int
        Rows, and columns, of the blocks.
    like : array
        Gives namespace, precision and device.
    """

    def __init__(self, lead: tuple[int, ...], sizes: tuple[int, ...], like: Any) -> None:
        self._lead, self._sizes, self._like = lead, sizes, like
        self._ends = list(accumulate(sizes, initial=0))
        self._out = np.zeros((*lead, self._ends[-1], self._ends[-1])) if in_numpy(like) else None
        self._sums: dict[tuple[int, int], Any] = {}

    def add(self, row: int, column: int, part: Any, sign: int = 1) -> None:
        """Add an array that broadcasts to the block at (row, column), or subtract it."""
        place = row, column
        if self._out is None:
            shape = (*self._lead, self._sizes[row], self._sizes[column])
            held = self._sums.get(place)
            if held is None:
                held = namespace_of(part).broadcast_to(part, shape)
                self._sums[place] = held if sign > 0 else -held
            else:
                self._sums[place] = held + part if sign > 0 else held - part
            return
        target = self._sums.get(place)
        if target is None:
            rows, columns = (slice(self._ends[k], self._ends[k + 1]) for k in place)
            target = self._sums[place] = self._out[..., rows, columns]
            target[...] = part if sign > 0 else -part
        elif sign > 0:
            target += part
        else:
            target -= part

    def whole(self) -> Any:
        """Return the matrices, shape ``(*lead, sum(sizes), sum(sizes))``."""
        if self._out is not None:
            return self._out
        xp, like = namespace_of(self._like), self._like
        rows = []
        for row, height in enumerate(self._sizes):
            cells = []
            for column, width in enumerate(self._sizes):
                cell = self._sums.get((row, column))
                if cell is None:
                    shape = (*self._lead, height, width)
                    cell = xp.zeros(shape, dtype=like.dtype, device=like.device)
                cells.append(cell)
            rows.append(xp.concat(cells, axis=-1))
        return xp.concat(rows, axis=-2)


def any_entry(array: Any) -> bool:
    """Return True where some entry of an array is not zero."""
    if isinstance(array, np.ndarray):
        return bool(array.any())
    return 0 not in array.shape and bool(namespace_of(array).any(array != 0.0))


def weighted_sum(weights: Array, values: Any) -> Any:
    """Return ``sum_i weights[i] values[..., i, :, :]``."""
    if isinstance(values, np.ndarray):
        return np.einsum("i,...irc->...rc", weights, values)
    xp = namespace_of(values)
    return xp.sum(carried(weights[:, None, None], values) * values, axis=-3)
