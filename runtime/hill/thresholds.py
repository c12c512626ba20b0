"""The damping that closes a region of Hill's equation, and the parameter that opens it.

Smith (7.50), (7.51): damping closes a region below a least parameter, and at a given parameter
above a critical damping.  Exactly, where the largest Floquet exponent of the undamped region is K
(:mod:`.boundaries`); of narrow regions, where ``|B| = |Im A|`` of the effective operator.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.maxima import bracketed_roots, local_maxima, narrowed
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes
from ..core.results import Check, DeferredChecks, Result, provenance
from .bloch import BEYOND, HIGHEST, effective_operator, level_distance
from .boundaries import ends_at, hill_boundaries, largest_exponent, sample_of
from .checks import EPS, Array, Index, Mask, axes_over, check_function, check_regions, points
from .perturbation import CONTRACTION, Sums

# Values of mu per decade in the search for the first crossing, and how far it goes: to mu f of so
# many times the square of the region's number.  Where it begins without damping any width will do.
_PER_DECADE, _FARTHEST, _SMALLEST = 24, 16.0, 1e-3


@dataclass(frozen=True, kw_only=True)
class Thresholds(Result):
    """Where regions close: the critical damping at given mu, or the least mu at given damping.

    What was solved for has the regions as its first axis, and so have ``lam2``, ``error`` and
    ``absent``; what was given has the shape of the argument.

    Attributes
    ----------
    damping : ndarray
        K above which the region is closed; 0 where the equation has no such region.  Or as given.
    mu : ndarray
        As given.  Or the least positive mu at which the region is open; inf where there is none
        up to ``searched`` (``absent``).
    lam2 : ndarray
        Where the region closes.
    error : ndarray
        Estimate of the absolute error of what was solved for; 0 where that is infinite.
    absent : ndarray of bool
        True where the region does not open up to ``searched``.
    regions : tuple of int
        Numbers n.
    searched : ndarray, shape (len(regions),)
        Largest mu that was looked at, for each region; empty where mu was given.
    """

    damping: Array
    mu: Array
    lam2: Array
    absent: Mask
    regions: tuple[int, ...]
    searched: Array

    arrays_along: ClassVar = {"...": "damping mu lam2 error absent", "region": "regions searched"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw what was solved for over what was given, a line for each region.

        Raises ``BadInput`` if what was given is not one-dimensional.
        """
        across, up = (self.damping, self.mu) if self.searched.size else (self.mu, self.damping)
        labels = ("$K$", r"least $\mu$") if self.searched.size else (r"$\mu$", "critical $K$")
        ax = axes_over(ax, "Thresholds.plot", "values", across)
        for n, row in zip(self.regions, up, strict=True):
            ax.plot(across, np.where(np.isfinite(row), row, np.nan), label=f"region {n}")
        ax.set(xlabel=labels[0], ylabel=labels[1])
        ax.legend()
        return ax


def critical_damping(
    f: PeriodicFunction,
    mu: ArrayLike | None = None,
    regions: Sequence[int] = (1, 2),
    *,
    damping: ArrayLike | None = None,
) -> Thresholds:
    """Return the damping K at which regions of y'' + 2 K y' + (lam2 + mu f) y = 0 close.

    Or, with ``damping`` in place of mu, the least mu > 0 at which they open.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi (``-f`` for the largest negative mu).
    mu : array_like, optional
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 1 (region 0 reaches to minus infinity and is never closed).
    damping : array_like, optional
        K, at least zero, any shape.

    Returns
    -------
    Thresholds
        The damping is ``arccosh(max |D|) / (2 pi)``, with D the undamped half trace: the
        largest Floquet exponent in the undamped region.  Where a narrow region's ends do not
        resolve it so well, the value of order 8 takes its place, with its error.  The check
        looks whether ``hill_boundaries`` has the region open just below and closed just above.

        The least mu is the first crossing of the critical damping with K as mu grows, sought on
        24 values per decade, with the maxima between them, and refined: a region that opens and
        closes again within one step and shows no maximum on these values is not seen.  Without
        damping it is 0, or inf where no value of mu up to ``searched`` opens the region.  The
        check is that the critical damping there is K again.

    Raises
    ------
    BadInput
        If both or neither of mu and damping are given, an argument is not finite, K is negative,
        a region is not a whole number >= 1, or mu f is too large for ``hill_boundaries``.

    Notes
    -----
    Smith (7.50) and (7.51), ``mu = 2 K n / sqrt(an^2 + bn^2)``, are the first order in mu and K.

    Examples
    --------
    >>> import elastolink as el
    >>> found = el.critical_damping(el.PeriodicFunction(a=[0.0, 1.0]), mu=0.1, regions=(1,))
    >>> print(found.damping.round(4))
    [0.0499]
    """
    check_function(f)
    numbers = check_regions(regions, least=1)
    if (mu is None) == (damping is None):
        given = "neither" if mu is None else "both"
        raise bad("mu, damping", given, "one of them", "pass damping= to have the least mu")
    checks: Mapping[str, Check]
    if mu is not None:
        (flat, _), shape = points(mu=mu, damping=0.0)
        closing = [_closing(f, n, flat) for n in numbers]
        k, lam2, error = np.reshape(closing, (len(numbers), 3, *shape)).swapaxes(0, 1)
        checks = DeferredChecks(partial(_either_side, f, flat, numbers, k, error))
        least, searched = flat.reshape(shape), np.zeros(0)
    else:
        (flat,), shape = points(damping=0.0 if damping is None else damping)
        reach = float(f.amplitudes[1:].sum())
        scale = max(max(numbers, default=1), float(flat.max(initial=0.0)))
        top = _FARTHEST * scale**2 / reach if reach > 0.0 else 0.0
        opening = [_opening(partial(_closing, f, n), n, flat, top) for n in numbers]
        rows = [row for row, _ in opening]
        least, lam2, error, gap = np.reshape(rows, (len(numbers), 4, *shape)).swapaxes(0, 1)
        worst = float(gap[np.isfinite(gap)].max(initial=0.0))
        checks = {"critical damping there less K, over its error": Check(worst, 4.0)}
        k, searched = flat.reshape(shape), np.array([highest for _, highest in opening])
    return Thresholds(
        method="largest half trace",
        error=error,
        error_norm=f"absolute, entrywise, of {'mu' if mu is None else 'K'}",
        checks=checks,
        provenance=provenance(),
        damping=k,
        mu=least,
        lam2=lam2,
        absent=np.isinf(np.broadcast_to(least, lam2.shape)),
        regions=numbers,
        searched=searched,
    )


# Where one region closes: K, lam2 and the error of K, ``(3, n)``.
Closing = Array


def _closing(f: PeriodicFunction, n: int, mu: Array) -> Closing:
    """Return where region n closes, by perturbation where that has the smaller error."""
    sharp = ends_at(f, mu, np.zeros_like(mu), (n,))[:, 0]
    found = largest_exponent(f, n, mu, sharp)
    found[1] += np.square(found[0])
    coarse = np.flatnonzero(found[2] > 1e-13 * found[0])
    # With more harmonics order 8 takes longer than the half trace.
    if coarse.size and f.harmonics <= 200:
        high = _to_order(f, n, mu[coarse])
        # An order that does not see a tongue is not wrong about its width: the errors decide.
        better = high[2] < found[2, coarse]
        found[:, coarse[better]] = high[:, better]
    return found


def _to_order(f: PeriodicFunction, n: int, mu: Array) -> Closing:
    """Return the critical damping to order 8, ``|B| = |Im A|``; infinite errors: not settled."""
    operator = effective_operator((f,), n, HIGHEST + BEYOND, damped=True)

    def excess(which: Index, k: Array) -> tuple[Array, float]:
        a, b = operator.components(np.stack([mu[which], k]))
        drag, split = a[:HIGHEST].imag.sum(axis=0), b[:HIGHEST].sum(axis=0)
        return np.asarray(np.abs(drag) - np.abs(split)), 0.0

    with np.errstate(all="ignore"):
        split = -excess(np.arange(mu.size), np.zeros_like(mu))[0]
        # Where the components overflow there is nothing to start from, and the ratio flags it.
        split = np.where(np.isfinite(split), split, 0.0)
        k = bracketed_roots(excess, np.zeros_like(mu), 4.0 * split / n)[0]
        rate = np.where(k > 0.0, np.clip(split / k, 0.25 * n, 4.0 * n), n)
        a, b = operator.components(np.stack([mu, k]))
        # The level n^2/4 takes no part in B and Im A, and neither does its round-off.
        strength = np.abs(mu) * float(f.amplitudes[1:].sum())
        noise = f.error * np.abs(mu) + 8.0 * EPS * np.abs(a.imag).sum(axis=0)
        for power, coupling in enumerate(operator.coupling):
            # Components that vanish term by term carry no round-off either.
            if np.any(coupling != 0.0):
                noise = noise + 8.0 * EPS * strength * (strength / level_distance(n)) ** power
        sums = Sums.of(n, HIGHEST, a, b, noise, strength)
        left = sums.turned + sums.spread
        settled = (sums.ratio < CONTRACTION) & (left < 0.5 * max(n - 1, 1))
        settled &= np.abs(sums.split - sums.drag) <= np.maximum(left, 1e-9 * sums.split)
        error = np.where(settled, left / rate + 4.0 * EPS * k, np.inf)
        return np.stack([k, sums.centre, error])


def _either_side(
    f: PeriodicFunction, mu: Array, regions: tuple[int, ...], critical: Array, error: Array
) -> Mapping[str, Check]:
    """Count the contradictions with the damped boundaries just below and just above."""
    wrong, seen = 0, 0
    for n, row, doubt in zip(regions, critical, error, strict=True):
        k, slack = row.ravel(), np.maximum(1e-4 * row, 100.0 * doubt).ravel()
        # Narrow regions open with a square root: Hill's matrix needs some width to see it.
        sure = np.argwhere((k > 2.0 * slack) & (k > 1e-6))
        if not sure.size:
            continue
        (chosen,) = sample_of(sure)
        seen += chosen.size
        both = hill_boundaries(f, mu[chosen], (n,), k[chosen] + slack[chosen] * [[-1.0], [1.0]])
        shut = np.isnan(both.upper[0])
        wrong += int(np.count_nonzero(shut[0]) + np.count_nonzero(~shut[1]))
    return {"regions open above or closed below": Check(float(wrong), 0.0)} if seen else {}


# ---------------------------------------------------------------- the least parameter


Solver = Callable[[Array], Closing]


def _opening(closing: Solver, n: int, damping: Array, top: float) -> tuple[Array, float]:
    """Return where region n opens at values of K, and the largest mu that was looked at."""
    # The least mu, lam2, the error and what is left of K over its error, (4, n); infinite, NaN, 0
    # and NaN where there is no crossing of the critical damping up to `top`.
    out = np.tile([[np.inf], [np.nan], [0.0], [np.nan]], damping.size)
    if not (damping.size and top):
        return out, 0.0
    drag = damping[damping > 0.0]
    # Half traces grow with the first power of mu at most while mu f is small.
    least = min(1.0, 0.125 * n * float(drag.min())) if drag.size else _SMALLEST
    bottom = least * top / _FARTHEST / max(n, float(damping.max())) ** 2
    count = int(np.ceil(_PER_DECADE * np.log10(top / bottom))) + 1
    grid, highest = _climb(closing, np.geomspace(bottom, top, count), float(damping.max()))
    # The first grid value above each K: the running maximum is in order.
    first = np.searchsorted(highest, damping, side="right")
    open_ = first < grid.size
    out[:2, open_ & (damping == 0.0)] = [[0.0], [0.25 * n * n]]
    there = np.flatnonzero(open_ & (damping > 0.0))
    if there.size:
        low = np.where(first[there] > 1, grid[np.maximum(first[there] - 2, 0)], 0.25 * bottom)
        out[:, there] = _refined(closing, damping[there], np.log(low), np.log(grid[first[there]]))
    return out, float(grid[-1])


def _climb(closing: Solver, grid: Array, most: float) -> tuple[Array, Array]:
    """Return the grid with the running maximum of the critical damping, as far as needed."""

    def sure(mu: Array) -> Array:
        k, _, error = closing(mu.ravel())
        return np.reshape(k - error, mu.shape)

    # A decade at a time: small values of mu need small matrices.
    value = np.zeros(0)
    for part in np.array_split(grid, -(-grid.size // _PER_DECADE)):
        try:
            value = np.concatenate([value, sure(part)])
        except BadInput:
            # Hill's matrix would be too large: the search ends here.
            if not value.size:
                raise
            break
        if value.max() > most:
            break
    grid = grid[: value.size]
    # With the peaks between the values of the grid.
    inner = local_maxima(value)
    ends = np.log(grid[inner - 1]), np.log(grid[inner + 1])
    low, high = narrowed(lambda x: sure(np.exp(x)), *ends, 3)
    peaks = np.exp(0.5 * (low + high))
    grid, value = np.append(grid, peaks), np.append(value, sure(peaks))
    order = np.argsort(grid, kind="stable")
    return grid[order], np.maximum.accumulate(value[order])


def _refined(closing: Solver, wanted: Array, low: Array, high: Array) -> Array:
    """Solve ``log K_crit(mu) = log K`` in log mu; the rows are those of :func:`_opening`."""

    def excess(which: Index, x: Array) -> tuple[Array, float]:
        k, *_ = closing(np.exp(x))
        return np.asarray(np.log(np.maximum(k / wanted[which], 1e-3))), 0.0

    x = bracketed_roots(excess, low, high)[0]
    (k, lam2, error), step = closing(np.exp(x)), 1e-4
    with np.errstate(divide="ignore", invalid="ignore"):
        up, down = (closing(np.exp(x + d))[0] for d in (step, -step))
        slope = np.maximum((np.log(up) - np.log(down)) / (2.0 * step), 1e-3)
    noise = error + 8.0 * EPS * wanted * (1.0 + slope * np.abs(x))
    error = np.exp(x) * (noise / (wanted * slope) + 4.0 * EPS)
    return np.stack([np.exp(x), lam2, error, np.abs(k - wanted) / noise])
