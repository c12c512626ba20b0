"""Certified boundaries: every end with an interval that is proved to hold it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check, provenance
from .boundaries import Boundaries
from .enclosures import (
    Ball,
    DampedProblem,
    HillOperator,
    Spectrum,
    enclosures,
    refusal,
    spectrum,
)

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Ends = tuple[Ball | None, Ball]

_UNDECIDED = "regions that damping may have closed, undecided"


@dataclass(frozen=True, kw_only=True)
class CertifiedBoundaries(Boundaries):
    """Boundaries with proved enclosures, for the equation with the coefficients of f as given.

    ``lower + lower_rest``, added without rounding, lies within ``lower_radius`` of the end, and
    likewise for the upper one; ``error`` bounds what ``lower`` and ``upper`` alone are off by.

    Attributes
    ----------
    lower_rest, upper_rest : ndarray, shape (len(regions), *mu.shape)
        What the doubles ``lower`` and ``upper`` lack, as doubles.
    lower_radius, upper_radius : ndarray, same shape
        Half-widths of the enclosures.
    pair : ndarray of bool, same shape
        True where the enclosures of the two ends overlap: the region is closed, or open by no
        more than their widths.  Where it is false, and the ends are numbers, the region is open.
    closed : ndarray of bool, same shape
        True where damping is proved to have closed the region: the ends are NaN there.  They are
        NaN as well where neither could be proved (close to the tip), which fails a check.
    function_error : ndarray, shape of mu
        ``|mu| f.error``: how much further the ends of the function that is meant may lie.  It is
        as good as ``f.error``, mostly an estimate, and not part of the bounds.
    """

    lower_rest: Array
    upper_rest: Array
    lower_radius: Array
    upper_radius: Array
    pair: Flags
    closed: Flags
    function_error: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **Boundaries.dimensions,
        **dict.fromkeys(
            ("lower_rest", "upper_rest", "lower_radius", "upper_radius", "pair", "closed"),
            ("region", "mu"),
        ),
        "function_error": ("mu",),
    }

    def enclosure(self, end: str, *index: int) -> tuple[Fraction, Fraction]:
        """Return the exact ends of one interval.

        Parameters
        ----------
        end : {"lower", "upper"}
            Which end of the region.
        *index : int
            Place in ``lower`` or ``upper``.

        Raises
        ------
        BadInput
            If the end is neither, or is not a number there.
        """
        if end not in ("lower", "upper"):
            raise bad("enclosure", repr(end), "'lower' or 'upper'", "name one of them")
        parts = [float(getattr(self, end + tail)[index]) for tail in ("", "_rest", "_radius")]
        if not np.isfinite(parts[0]):
            raise bad("enclosure", f"an end of {parts[0]}", "a finite end", "choose another")
        middle, radius = Fraction(parts[0]) + Fraction(parts[1]), Fraction(parts[2])
        return middle - radius, middle + radius


def certified_boundaries(
    f: PeriodicFunction, mu: Array, damping: Array, regions: tuple[int, ...]
) -> CertifiedBoundaries:
    """Return proved enclosures of the ends; see :func:`.boundaries.hill_boundaries`.

    For an f taken with its coefficients as they stand, mu and K of one shape, all checked.
    """
    size = len(regions), mu.size
    names = [side + tail for side in ("lower", "upper") for tail in ("", "_rest", "_radius")]
    arrays: dict[str, Array] = {name: np.full(size, np.nan) for name in names}
    pair, closed = np.zeros((2, *size), dtype=bool)
    for column, (amp, k) in enumerate(zip(mu.ravel(), damping.ravel(), strict=True)):
        for row, ends in enumerate(_slice(f, float(amp), float(k), regions)):
            place = row, column
            if not isinstance(ends, tuple):
                closed[place] = ends is True
                continue
            for side, ball in zip(("lower", "upper"), ends, strict=True):
                parts = (-inf, 0.0, 0.0) if ball is None else _in_doubles(ball)
                for tail, value in zip(("", "_rest", "_radius"), parts, strict=True):
                    arrays[side + tail][place] = value
            lower, upper = ends
            if lower is not None:
                pair[place] = upper.middle - lower.middle <= upper.radius + lower.radius
    # What the doubles alone are off by.
    left = [
        np.abs(arrays[side + "_rest"]) + arrays[side + "_radius"] for side in ("lower", "upper")
    ]
    undecided = np.isnan(arrays["upper"]) & ~closed
    shape = (len(regions), *mu.shape)
    return CertifiedBoundaries(
        method="Hill matrix, certified: exact residuals, Kato-Temple bounds",
        error=np.nextafter(np.maximum(*left), np.inf).reshape(shape),
        error_norm="absolute, entrywise, for either end",
        error_kind="bound",
        checks={_UNDECIDED: Check(float(np.count_nonzero(undecided)), 0.0)},
        provenance=provenance(),
        regions=regions,
        mu=mu,
        damping=damping,
        function_error=np.abs(mu) * f.error,
        **{name: values.reshape(shape) for name, values in arrays.items()},
        pair=pair.reshape(shape),
        closed=closed.reshape(shape),
    )


def _in_doubles(ball: Ball) -> tuple[float, float, float]:
    """Return the middle as the sum of two doubles, and a double above the radius."""
    value = float(ball.middle)
    rest = float(ball.middle - Fraction(value))
    radius = ball.radius + abs(ball.middle - Fraction(value) - Fraction(rest))
    return value, rest, nextafter(float(radius), inf) if radius else 0.0


def _slice(
    f: PeriodicFunction, mu: float, k: float, regions: tuple[int, ...]
) -> list[Ends | bool | None]:
    """Return the balls of both ends of each region at one mu; no lower one for region 0.

    With damping: True where the region is proved closed, None where nothing is proved.
    """
    mean = Fraction(mu) * Fraction(float(f.a[0]))
    out: dict[int, Ends | bool | None] = {}
    for odd in (0, 1):
        numbers = sorted({n for n in regions if n % 2 == odd})
        if not numbers:
            continue
        coarse = spectrum(f, mu, odd, numbers[-1] + 2, k * k)
        if k > 0.0:
            problem = DampedProblem(f, mu, k, coarse)
            for n in numbers:
                ends = problem.ends(n)
                out[n] = _moved(ends, mean) if isinstance(ends, tuple) else ends
            continue
        operator, known = HillOperator(f, mu), dict[int, Ball]()
        for n in numbers:
            for j in (n - 1, n) if n else (0,):
                if j not in known:
                    coarse, first, last = _group(f, mu, coarse, j)
                    balls = enclosures(coarse, operator, first, last)
                    known.update(zip(range(first, last + 1), balls, strict=True))
            out[n] = _moved((known[n - 1] if n else None, known[n]), mean)
    return [out[n] for n in regions]


def _group(f: PeriodicFunction, mu: float, coarse: Spectrum, j: int) -> tuple[Spectrum, int, int]:
    """Return the group of eigenvalue j, with more of the spectrum where it takes that."""
    for _ in range(6):
        group = coarse.cluster(j)
        if group is not None:
            return coarse, *group
        coarse = spectrum(f, mu, coarse.odd, 2 * len(coarse.values) + coarse.odd)
    raise refusal(f"{len(coarse.values)} eigenvalues close together")


def _moved(ends: Ends, mean: Fraction) -> Ends:
    lower, upper = ends
    moved = Ball(upper.middle - mean, upper.radius)
    return None if lower is None else Ball(lower.middle - mean, lower.radius), moved
