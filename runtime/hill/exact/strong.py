"""Boundaries of the strongly damped Hill's equation, from its half trace.

The periodic solutions of the damped equation and of its adjoint grow and fall like exp(K theta)
over a turn, and the eigenvalues of the non-symmetric matrix are ill-conditioned accordingly: many
digits at K = 5.  The half trace has no such weakness.  With ``y = exp(-K theta) u`` region n ends
where the half trace of u passes cosh(2 pi K), once on either side of its one extremum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.periodic_function import PeriodicFunction
from ..half_trace import discriminant
from ..transfer import EPS
from .extremum import largest
from .roots import crossing

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

# Logarithms of ratios beyond this are all alike.
_FAR = 700.0
# Proposals of the error, each so many times the one before.
_STEPS, _RATIO = 40, 3.0


@dataclass(frozen=True)
class StrongEnds:
    """Ends of one region at points ``(n,)``, NaN where it is closed or undecided.

    Attributes
    ----------
    lower, upper, error : ndarray
        As in :class:`.matrix.Boundaries`.
    undecided : ndarray of bool
        True where the figure of the critical damping covers K.
    """

    lower: Array
    upper: Array
    error: Array
    undecided: Mask


@dataclass(frozen=True)
class _Level:
    """How far the half trace is above the level of region n, at its points ``(n,)``."""

    f: PeriodicFunction
    sign: float
    mu: Array
    k: Array

    def share(self, lam2: Array, which: Index) -> Array:
        """Return the logarithm of half trace over level, clipped."""
        found = discriminant(self.f, lam2, self.mu[which], self.k[which])
        share = self.sign * found.value / found.level
        return np.asarray(np.log(np.clip(share, np.exp(-_FAR), np.exp(_FAR))))

    def sure(self, lam2: Array, which: Index, above: bool) -> Mask:
        """Return True where the half trace is above, or below, by more than its figure."""
        found = discriminant(self.f, lam2, self.mu[which], self.k[which])
        gap = self.sign * found.value - found.level
        figure = np.where(np.isfinite(found.value), found.error, 0.0) + 2.0 * EPS * found.level
        return np.asarray(gap > figure if above else gap < -figure)

    def end(self, outer: Array, inner: Array) -> tuple[Array, Array]:
        """Return the crossing between a place below the level and one above, and its figure."""
        turned = np.where(inner < outer, -1.0, 1.0)

        def function(t: Array, which: Index) -> Array:
            return self.share(turned[which] * t, which)

        place = turned * crossing(function, turned * outer, turned * inner)
        size = np.maximum(np.abs(place), self.k * self.k) + 1.0
        error, left = 2.0 * EPS * size, np.arange(place.size)
        for _ in range(_STEPS):
            step = turned[left] * error[left]
            within, beyond = place[left] + step, place[left] - step
            # Between the undamped end and the extremum there is a crossing in any case.
            past = turned[left] * (within - inner[left]) >= 0.0
            before = turned[left] * (outer[left] - beyond) >= 0.0
            good = past | self.sure(np.where(past, inner[left], within), left, above=True)
            good &= before | self.sure(np.where(before, outer[left], beyond), left, above=False)
            left = left[~good]
            if not left.size:
                break
            error[left] *= _RATIO
        return place, error


def strong_ends(
    f: PeriodicFunction, mu: Array, k: Array, n: int, sharp: tuple[Array, Array], slack: Array
) -> StrongEnds:
    """Return the ends of region n for mu and K ``(n,)`` from the undamped ones and their error."""
    low, high = sharp
    nothing = np.full(mu.size, np.nan)
    lower, upper, error = nothing, nothing.copy(), nothing.copy()
    level = _Level(f, 1.0 if n % 2 == 0 else -1.0, mu, k)
    shift = k * k
    if n == 0:
        # With z = y'/y the equation says that the mean of lam2 + mu f is that of -z^2 on the end;
        # where it is below zero all the way round, the solutions grow faster than K.
        reach = np.abs(mu) * f.bound() * (1.0 + 4.0 * EPS)
        most = np.minimum(high + shift + slack, EPS * reach + slack - mu * f.a[0])
        upper, error = level.end(most, -reach - 1.0)
        return StrongEnds(np.full(mu.size, -np.inf), upper, error, np.zeros(mu.size, dtype=bool))
    critical, peak, figure = largest(f, n, mu, sharp, slack)
    undecided = ~(np.abs(k - critical) > figure)
    there = np.flatnonzero((k < critical) & ~undecided)
    if there.size:
        part = _Level(f, level.sign, mu[there], k[there])
        top = (peak + shift)[there]
        lower[there], first = part.end((low + shift - slack)[there], top)
        upper[there], last = part.end((high + shift + slack)[there], top)
        error[there] = np.maximum(first, last)
    return StrongEnds(lower, upper, error, undecided)
