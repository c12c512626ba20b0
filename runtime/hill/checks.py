"""What the functions of this room are given, checked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.inputs import numbers as in_doubles
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes, axes_or_new

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

EPS = float(np.finfo(float).eps)

# Harmonics of the largest Hill matrix: of some 4000 rows, seconds of work.
LARGEST = 2048


def finite(name: str, values: ArrayLike) -> Array:
    """Return an array of finite numbers, or refuse by name."""
    out = in_doubles(name, values)
    if not np.all(np.isfinite(out)):
        raise bad(name, "an entry that is not finite", "finite numbers", "correct the input")
    return out


def arguments(**given: ArrayLike) -> tuple[tuple[Array, ...], tuple[int, ...]]:
    """Return the arguments as arrays and their broadcast shape, or refuse by name."""
    arrays = tuple(finite(name, value) for name, value in given.items())
    damping = arrays[list(given).index("damping")]
    if np.any(damping < 0.0):
        raise bad("damping", float(damping.min()), "K >= 0", "damping takes energy out")
    if np.any(damping > 1e100):
        raise bad("damping", float(damping.max()), "K up to 1e100", "its square is no number")
    try:
        return arrays, np.broadcast_shapes(*(item.shape for item in arrays))
    except ValueError as reason:
        found = f"shapes {', '.join(str(item.shape) for item in arrays)}"
        fix = "reshape them, for example to (n, 1) and (1, m)"
        raise bad(", ".join(given), found, "shapes that broadcast", fix) from reason


def points(**given: ArrayLike) -> tuple[tuple[Array, ...], tuple[int, ...]]:
    """Return the arguments at all points ``(n,)``, and the shape that they broadcast to."""
    arrays, shape = arguments(**given)
    return tuple(np.broadcast_to(item, shape).ravel() for item in arrays), shape


def check_function(f: object) -> PeriodicFunction:
    """Return f, or refuse anything but a :class:`PeriodicFunction`."""
    if not isinstance(f, PeriodicFunction):
        fix = "use PeriodicFunction(a=, b=), .from_samples or .from_callable"
        raise bad("f", type(f).__name__, "a PeriodicFunction", fix)
    return f


def check_regions(
    regions: Sequence[int], least: int = 0, most: int = LARGEST, name: str = "regions"
) -> tuple[int, ...]:
    """Return the numbers of regions (or bands), or refuse."""
    given = in_doubles(name, regions)
    if given.ndim != 1 or not np.all((given >= least) & (given % 1.0 == 0.0)):
        raise bad(name, repr(regions), f"whole numbers >= {least}", "for example (1, 2)")
    if np.any(given > most):
        raise bad(name, f"{np.max(given):g}", f"at most {most}", f"choose lower {name}")
    return tuple(given.astype(int).tolist())


def axes_over(ax: Axes | None, where: str, name: str, values: Array) -> Axes:
    """Return axes, new ones by default, to draw over a line of values; refuse any other shape."""
    if values.ndim != 1:
        raise bad(where, f"{name} of shape {values.shape}", f"a line of {name}", "slice it")
    return axes_or_new(ax)
