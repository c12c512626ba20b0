"""What a method of the steady state is asked for, and what it answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.inputs import require_whole
from ..core.results import Check
from ..periodic import FloquetMultipliers
from ..periodic.first_order import CanonicalForm

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Request:
    """Periodic motions that are wanted, checked beforehand.

    Attributes
    ----------
    form : CanonicalForm
        The forced systems, a flat batch.
    rtol : float
        Wanted error of each coordinate over its own peak.
    samples : int
        Least number of crank angles that are given.
    options : mapping
        What the method was told beside.
    multipliers : callable
        Finds the Floquet multipliers of all.
    tick : callable or None
        Told how many motions are done.
    """

    form: CanonicalForm
    rtol: float
    samples: int
    options: Mapping[str, object]
    multipliers: Callable[[], FloquetMultipliers]
    tick: Callable[[int], None] | None = None


@dataclass(frozen=True)
class Found:
    """Periodic motions of a flat batch.

    Attributes
    ----------
    method : str
        The method in words.
    theta : ndarray
        Even crank angles [rad], shape ``(nt,)``.
    q, slope : ndarray
        Coordinates and d/dtheta of them, shape ``(nb, nt, n)``; NaN where there is no answer.
    error : ndarray
        Largest error of each coordinate over its own peak, shape ``(nb, n)``; inf where NaN.
    allowed : ndarray
        What the error may be: what was asked for, or what round-off leaves, shape ``(nb, n)``.
    sensitivity : ndarray
        Relative change of the motion over one of what it is solved from, shape ``(nb,)``.
    checks : mapping
        The method's own self-checks.
    multipliers : FloquetMultipliers or None
        Where the method needs them itself.
    cycles : ndarray of int or None
        Periods that a march took, shape ``(nb,)``.
    """

    method: str
    theta: Array
    q: Array
    slope: Array
    error: Array
    allowed: Array
    sensitivity: Array
    checks: Mapping[str, Check] = field(default_factory=dict)
    multipliers: FloquetMultipliers | None = None
    cycles: NDArray[np.int64] | None = None


def number_option(
    options: Mapping[str, object], name: str, default: float, low: float, high: float
) -> float:
    """Return a numeric option of a method.

    Raises
    ------
    BadInput
        If it is not a number from ``low`` to ``high``.
    """
    value = options.get(name, default)
    usable = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(
        value, bool
    )
    if not (usable and low <= float(value) <= high):  # type: ignore[arg-type]
        raise bad(
            f"option {name}",
            repr(value),
            f"a number from {low:g} to {high:g}",
            f"choose {default:g}",
        )
    return float(value)  # type: ignore[arg-type]


def whole_option(options: Mapping[str, object], name: str, low: int, high: int) -> int | None:
    """Return an option that is a whole number, or None where it is not given.

    Raises
    ------
    BadInput
        If it is not a whole number from ``low`` to ``high``.
    """
    value = options.get(name)
    return None if value is None else require_whole(f"option {name}", value, low, high)


def word_option(
    options: Mapping[str, object], name: str, default: str, words: tuple[str, ...]
) -> str:
    """Return an option that is one of some words.

    Raises
    ------
    BadInput
        If it is another.
    """
    value = options.get(name, default)
    if value not in words:
        raise bad(f"option {name}", repr(value), f"one of {words}", f"choose {default!r}")
    return str(value)


def peaks(values: Array) -> Array:
    """Return the largest size of each coordinate ``(..., n)`` of motions ``(..., nt, n)``.

    At least round-off of the largest of all, so that a coordinate at rest can be divided by it.
    """
    eps = float(np.finfo(float).eps)
    peak = np.max(np.abs(values), axis=-2)
    size = np.maximum(peak, eps * np.max(peak, axis=-1, keepdims=True))
    positive: Array = np.where(size > 0, size, 1.0)
    return positive


def resampled(values: Array, count: int) -> Array:
    """Return periodic samples ``(nt, m)`` on another even grid, by their Fourier series."""
    old = len(values)
    if old == count:
        return values
    if not np.all(np.isfinite(values)):
        return np.full((count, values.shape[1]), np.nan)
    half = np.fft.rfft(values, axis=0)
    if old % 2 == 0:
        # The highest one stands for two, which the finer grid tells apart.
        half[-1] *= 0.5
    finer: Array = np.fft.irfft(half, n=count, axis=0) * (count / old)
    return finer
