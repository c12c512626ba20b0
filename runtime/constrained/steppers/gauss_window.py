"""One long window of Gauss collocation, all its nodes evaluated at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...integrators.tableau import gauss_tableau
from ..batches import Slopes, accelerations_with_slopes
from ..equations import Array, Equations, NoConvergence, State

_MOST = 25
_EPS = float(np.finfo(float).eps)
# A correction of this relative size leaves slopes that need not be made anew; slopes that are off
# by more would let the error figure grow with the number of windows.
_NEAR = 1e-3
# Newton's iteration may leave this part of the tolerance.
_LEFT = 1e-3
# Terms of the series of the accelerations that count as what a shorter series would miss.
MISSED = 2


@dataclass(frozen=True)
class Nodes:
    """Gauss points of [0, 1] and what belongs to polynomials through values at them.

    Attributes
    ----------
    c, b, back : ndarray, shape (s,)
        Points; weights of the integral; weights of the twofold integral over [0, 1].
    once, twice : ndarray, shape (s, s)
        Integrals from 0 to the points, and twofold ones.
    series, values : ndarray, shape (s, s)
        Legendre coefficients of the polynomial, and its values from them.
    """

    c: Array
    b: Array
    back: Array
    once: Array
    twice: Array
    series: Array
    values: Array

    def at(self, x: Array) -> tuple[Array, Array]:
        """Return the twofold and the single integral from 0 to x by the coefficients.

        Shapes ``(len(x), s)`` each.
        """
        once, twice = _integrals(len(self.c))
        values = np.polynomial.legendre.legvander(2.0 * x - 1.0, len(twice) - 1)
        return values @ twice, values[:, :-1] @ once

    def shortened(self, values: Array, part: float) -> Array:
        """Return the polynomial through values at the nodes of the first part of [0, 1]."""
        places = 2.0 * part * self.c - 1.0
        spread = np.polynomial.legendre.legvander(places, len(self.c) - 1)
        found: Array = spread @ (self.series @ values)
        return found


@lru_cache(maxsize=64)
def nodes(count: int) -> Nodes:
    """Return the nodes of a number of stages."""
    tableau = gauss_tableau(count)
    more = np.polynomial.legendre.legvander(2.0 * tableau.c - 1.0, count + 1)
    values = np.array(more[:, :count], dtype=np.float64)
    weights = (2.0 * np.arange(count) + 1.0)[:, None] * tableau.b
    back = tableau.b * (1.0 - tableau.c)
    series: Array = weights * values.T
    twice = np.asarray(more @ _integrals(count)[1] @ series, dtype=np.float64)
    return Nodes(tableau.c, tableau.b, back, tableau.a, twice, series, values)


@lru_cache(maxsize=64)
def _integrals(count: int) -> tuple[Array, Array]:
    legendre = np.polynomial.legendre
    once = np.asarray(legendre.legint(np.eye(count), scl=0.5, lbnd=-1.0), dtype=np.float64)
    return once, np.asarray(legendre.legint(once, scl=0.5, lbnd=-1.0), dtype=np.float64)


@dataclass(frozen=True)
class Units:
    """Sizes that a window's errors are relative to, of coordinates and velocities, ``(n,)``."""

    place: Array
    speed: Array

    def of(self, place: Array, speed: Array) -> float:
        """Return the largest relative size of changes ``(s, n)``."""
        most = max(
            float(np.max(np.abs(place) / self.place, initial=0.0)),
            float(np.max(np.abs(speed) / self.speed, initial=0.0)),
        )
        return most if np.isfinite(most) else np.inf


class TooLong(ArithmeticError):  # noqa: N818 - reads as what it is
    """A window whose series does not fall far enough, by this factor of the tolerance."""

    def __init__(self, size: float, slope: Array) -> None:
        super().__init__("the window is too long")
        self.size, self.slope = size, slope


@dataclass(frozen=True)
class Solved:
    """A window that was solved; arrays are over the units of the coordinates.

    Attributes
    ----------
    begin : State
        Its beginning.
    h : float
        Length [s].
    points : Nodes
        Its nodes.
    slope : ndarray, shape (s, n)
        Accelerations at the nodes.
    size : float
        What the series leaves away, over the tolerance.
    fall : float
        The last terms of the series over those before them.
    left : float
        What the iteration may have left, relative.
    units : Units
        What relative sizes are relative to.
    slopes : Slopes
        How the accelerations vary along the window.
    unwind : callable
        Solves the linearised window for the accelerations.
    columns : ndarray, shape (n,)
        Units of the coordinates.
    """

    begin: State
    h: float
    points: Nodes
    slope: Array
    size: float
    fall: float
    left: float
    units: Units
    slopes: Slopes
    unwind: Callable[[Array], Array]
    columns: Array

    def along(self, x: Array, twice: Array, once: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities at parts x of the window, ``(nt, n)``.

        The integrals to there are those of :meth:`Nodes.at`.
        """
        series = self.points.series @ self.slope * self.columns
        h, begin = self.h, self.begin
        q = begin.q + h * x[:, None] * begin.qd + h * h * (twice @ series)
        return q, begin.qd + h * (once @ series)

    def end(self) -> tuple[Array, Array]:
        """Return coordinates and velocities at the end."""
        h, begin, points = self.h, self.begin, self.points
        rise = self.columns * (points.back @ self.slope)
        q = begin.q + h * (begin.qd + h * rise)
        return q, begin.qd + h * self.columns * (points.b @ self.slope)

    def unseen(self, after: Array) -> tuple[Array, Array]:
        """Return what forces that jump or kink may add to the errors; nothing where all is smooth.

        A jump between an end and the node next to it shows in the accelerations at the end alone;
        one between nodes in a series that does not fall.

        Parameters
        ----------
        after : ndarray, shape (n,)
            Accelerations at the end of the window.

        Returns
        -------
        place, speed : ndarray, shape (n,)
            Errors of coordinates and velocities over the units of the coordinates.
        """
        series, s = self.points.series @ self.slope, len(self.slope)
        signs = (-1.0) ** np.arange(s)
        first, last = np.sum(signs[:, None] * series, axis=0), np.sum(series, axis=0)
        gaps = (np.abs(first - self.begin.qdd / self.columns), np.abs(last - after / self.columns))
        # A smooth motion is off there by what the series misses, which is counted already.
        missed = np.sum(np.abs(series[-MISSED:]), axis=0)
        jump = sum(np.where(gap > missed, gap, 0.0) for gap in gaps)
        # A jump J has terms of the size J / sqrt(s), and the quadrature is off by J h / s.
        # It leaves them all along, while those of a smooth motion are long past their largest.
        once = self.h / (2.0 * s)
        middle, end = (
            self.units.of(once * once * part, once * part)
            for part in (series[s // 2 - 2 : s // 2 + 2], series[-MISSED:])
        )
        rough = min(1.0, end / middle) if middle > 0.0 else 0.0
        inside = 2.0 * rough * rough * missed / np.sqrt(s)
        speed: Array = self.h * (jump * self.points.c[0] + inside)
        return self.h * speed, speed

    def missed(self, place: Array, speed: Array) -> Array:
        """Return how the accelerations change with a shorter series and another beginning.

        Parameters
        ----------
        place, speed : ndarray, shape (n,)
            Change of the coordinates and velocities at the beginning, in their own units.

        Returns
        -------
        ndarray, shape (s, n)
            Over the units of the coordinates.
        """
        series = self.points.series @ self.slope
        right = np.sqrt(self.fall) * (self.points.values[:, -MISSED:] @ series[-MISSED:])
        start, rate = place / self.columns, speed / self.columns
        ahead = start + self.h * self.points.c[:, None] * rate
        right = right + np.einsum("sij,sj->si", self.slopes.by_place, ahead)
        right = right + self.slopes.by_speed @ rate
        found: Array = self.unwind(right)
        return found


def solve_window(
    equations: Equations,
    begin: State,
    h: float,
    points: Nodes,
    guess: Array,
    floors: tuple[Array, Array],
    rtol: float,
    *,
    forced: bool = False,
) -> Solved:
    """Return a window of collocation.

    The accelerations at the nodes are the unknowns.  Newton's iteration, whose slopes are
    differences of the emitted functions, all nodes and all differences in one evaluation; near the
    solution they are kept.

    Parameters
    ----------
    equations : Equations
        The system.
    begin : State
        Meets the constraints.
    h : float
        Length of the window [s].
    points : Nodes
        Its nodes.
    guess : ndarray, shape (s, n)
        Accelerations over the units of the coordinates.
    floors : tuple of ndarray, shape (n,) each
        Sizes of coordinates and velocities that are added to their own ones.
    rtol : float
        Tolerance.
    forced : bool
        Whether to take the window however its series falls.

    Raises
    ------
    NoConvergence
        If the iteration does not converge.
    TooLong
        If the series of the accelerations does not fall to the tolerance.
    """
    columns = equations.columns
    start, rate = begin.q / columns, begin.qd / columns
    t = begin.t + h * points.c
    drift = start + h * points.c[:, None] * rate
    slope, last, count = guess, np.inf, 0
    slopes: Slopes | None = None
    while count < _MOST:
        count += 1
        speed = rate + h * (points.once @ slope)
        place = drift + h * h * (points.twice @ slope)
        fresh = slopes is None
        if slopes is None:
            slopes = accelerations_with_slopes(equations, t, place, speed, h)
            found, unwind = slopes.accelerations, _unwinding(slopes, h, points)
        else:
            found = equations.accelerations(t, place * columns, speed * columns)[0] / columns
        change = unwind(found - slope)
        slope = slope + change
        units = Units(
            floors[0] / columns + np.max(np.abs(place), axis=0),
            floors[1] / columns + np.max(np.abs(speed), axis=0),
        )
        size = units.of(h * h * (points.twice @ change), h * (points.once @ change))
        if not size < 1e6:
            break
        part = min(size / last if np.isfinite(last) else 1.0, 1.0)
        left = min(10.0 * size, 1.0) if fresh else part
        rounding = size <= 1e-9 and part >= 0.25
        if (left < 0.5 and size * left <= _LEFT * rtol) or size <= 4 * _EPS or rounding:
            tail, fall = _tail(slope, h, points, units)
            # The terms that are not there fall on as those before them.
            over = tail * fall / rtol
            if over > 1.0 and not forced:
                raise TooLong(over, slope)
            return Solved(
                begin, h, points, slope, over, fall, size * left, units, slopes, unwind, columns
            )
        if not forced:
            tail, fall = _tail(slope, h, points, units)
            # What the iteration has not settled yet is no sign of a window that is too long.
            if tail * fall > max(30.0 * rtol, size if size < 1e-2 else 0.1):
                raise TooLong(tail * fall / rtol, slope)
        if size > 2.0 * last and last < 1e-2 and fresh:
            break
        if size > _NEAR or (part > 0.2 and not fresh):
            slopes = None
        last = size
    raise NoConvergence("the window does not converge")


def _tail(slope: Array, h: float, points: Nodes, units: Units) -> tuple[float, float]:
    """Return the size of the series' last terms, as errors, and over that of the ones before."""
    s = len(points.c)
    series = points.series[-2 * MISSED :] @ slope
    # P_k integrated once is below 1/k, twice below 1/k^2, over an interval of length 2.
    once = h / (2.0 * s)
    before, last = (
        units.of(once * once * part, once * part) for part in (series[:MISSED], series[MISSED:])
    )
    return last, min(1.0, last / before) if before > 0.0 else 1.0


def _unwinding(slopes: Slopes, h: float, points: Nodes) -> Callable[[Array], Array]:
    """Return the solver of ``change - (its effect on the accelerations) = defect``."""
    from scipy.linalg.lapack import dgetrf, dgetrs

    s, n = slopes.accelerations.shape
    blocks = (-h * h * points.twice)[:, None, :, None] * slopes.by_place[:, :, None, :]
    blocks -= (h * points.once)[:, None, :, None] * slopes.by_speed[:, :, None, :]
    matrix: NDArray[np.float64] = blocks.reshape(s * n, s * n)
    matrix[np.arange(s * n), np.arange(s * n)] += 1.0
    # The transpose is in the order of columns, so that nothing is copied.
    factors, pivots, wrong = dgetrf(matrix.T, overwrite_a=1)
    if wrong != 0:
        raise NoConvergence("the matrix of the window is singular")

    def unwind(right: Array) -> Array:
        solved, _ = dgetrs(factors, pivots, right.ravel(), trans=1)
        return np.asarray(solved, dtype=np.float64).reshape(s, n)

    return unwind
