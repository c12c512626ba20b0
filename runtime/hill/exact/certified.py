"""Certified boundaries: every end with an interval that is proved to hold it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, provenance
from .damped_certified import DampedProblem, RealPairs, damped_ends
from .enclosure import Ball, enclosures, refusal
from .integer_products import HillOperator
from .isolation import Spectrum, cluster, spectrum
from .matrix import Boundaries

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
    """Return proved enclosures of the ends; see :func:`.matrix.hill_boundaries`.

    Parameters
    ----------
    f : PeriodicFunction
        Taken with its coefficients as they stand.
    mu, damping : ndarray
        Checked, of one shape.
    regions : tuple of int
        Checked numbers.
    """
    ends = _Ends((len(regions), mu.size))
    for column, (amp, k) in enumerate(zip(mu.ravel(), damping.ravel(), strict=True)):
        for row, balls in enumerate(_slice(f, float(amp), float(k), regions)):
            if isinstance(balls, tuple):
                ends.put(row, column, *balls)
            else:
                ends.closed[row, column] = balls is True
    shape = (len(regions), *mu.shape)
    undecided = np.isnan(ends.arrays["upper"]) & ~ends.closed
    return CertifiedBoundaries(
        method="Hill matrix, certified: exact residuals, Kato-Temple bounds",
        error=ends.error().reshape(shape),
        error_norm="absolute, entrywise, for either end",
        error_kind="bound",
        checks={_UNDECIDED: Check(float(np.count_nonzero(undecided)), 0.0)},
        provenance=provenance(),
        regions=regions,
        mu=mu,
        damping=damping,
        function_error=np.abs(mu) * f.error,
        **{name: values.reshape(shape) for name, values in ends.arrays.items()},
        pair=ends.pair.reshape(shape),
        closed=ends.closed.reshape(shape),
    )


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
        found = spectrum(f, mu, odd, numbers[-1] + 2, k * k)
        if k > 0.0:
            problem = DampedProblem.of(f, mu, k, found)
            pairs = RealPairs.of(problem)
            for n in numbers:
                ends = damped_ends(problem, pairs, k, n, found)
                out[n] = _moved(ends, mean) if isinstance(ends, tuple) else ends
            continue
        operator, known = HillOperator(f, mu), dict[int, Ball]()
        for n in numbers:
            for j in (n - 1, n) if n else (0,):
                if j not in known:
                    found, first, last = _group(f, mu, found, j)
                    balls = enclosures(found, operator, first, last)
                    known.update(zip(range(first, last + 1), balls, strict=True))
            out[n] = _moved((known[n - 1] if n else None, known[n]), mean)
    return [out[n] for n in regions]


def _group(f: PeriodicFunction, mu: float, found: Spectrum, j: int) -> tuple[Spectrum, int, int]:
    """Return the group of eigenvalue j, with more of the spectrum where it takes that."""
    for _ in range(6):
        group = cluster(found, (j, j))
        if group is not None:
            return found, *group
        found = spectrum(f, mu, found.odd, 2 * len(found.values) + found.odd)
    raise refusal(f"{len(found.values)} eigenvalues close together")


def _moved(ends: Ends, mean: Fraction) -> Ends:
    lower, upper = ends
    moved = Ball(upper.middle - mean, upper.radius)
    return None if lower is None else Ball(lower.middle - mean, lower.radius), moved


class _Ends:
    """The arrays of a result while they are filled; NaN where nothing is put."""

    def __init__(self, shape: tuple[int, int]) -> None:
        names = [side + tail for side in ("lower", "upper") for tail in ("", "_rest", "_radius")]
        self.arrays: dict[str, Array] = {name: np.full(shape, np.nan) for name in names}
        self.pair: Flags = np.zeros(shape, dtype=bool)
        self.closed: Flags = np.zeros(shape, dtype=bool)

    def put(self, row: int, column: int, lower: Ball | None, upper: Ball) -> None:
        """Enter the ends of one region; without a lower end it reaches to minus infinity."""
        place = row, column
        if lower is None:
            for tail, value in (("", -inf), ("_rest", 0.0), ("_radius", 0.0)):
                self.arrays["lower" + tail][place] = value
        else:
            self._put("lower", place, lower)
            self.pair[place] = upper.middle - lower.middle <= upper.radius + lower.radius
        self._put("upper", place, upper)

    def _put(self, side: str, place: tuple[int, int], ball: Ball) -> None:
        value = float(ball.middle)
        rest = float(ball.middle - Fraction(value))
        left = ball.middle - Fraction(value) - Fraction(rest)
        self.arrays[side][place] = value
        self.arrays[side + "_rest"][place] = rest
        self.arrays[side + "_radius"][place] = _above(ball.radius + abs(left))

    def error(self) -> Array:
        """Return the bound of what the doubles alone are off by."""
        sides = [
            np.abs(self.arrays[side + "_rest"]) + self.arrays[side + "_radius"]
            for side in ("lower", "upper")
        ]
        return np.asarray(np.nextafter(np.maximum(*sides), np.inf))


def _above(value: Fraction) -> float:
    """Return a double that is not smaller."""
    return nextafter(float(value), inf) if value else 0.0
