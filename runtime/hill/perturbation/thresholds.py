"""Critical damping and least parameter of the unstable regions of Hill's equation.

Smith (7.50), (7.51): damping closes a region below a least parameter, and at a given parameter
above a critical damping.  Exactly, and to any order up to 8.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import BadInput, bad
from ...results import Check, DeferredChecks, Result, provenance
from ...series.periodic import PeriodicFunction
from ..exact.matrix import check_regions, hill_boundaries
from ..exact.roots import crossing
from ..half_trace import arguments, check_function
from ..transfer import EPS
from .boundaries import HIGHEST, check_order
from .closing import Closing, exact_closing, order_closing
from .effective import effective_operator
from .orders import BEYOND

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]
Closings = Callable[[Array], Closing]

# Values of mu per decade in the search for the first crossing, and how far it goes: to mu f of so
# many times the square of the region's number.
_PER_DECADE = 24
_FARTHEST = 16.0
# How often a maximum between those values is looked at more closely, and by how much.
_ZOOMS, _ZOOM = 3, 8
_SAMPLE = 24
# Where the search begins without damping: there any width will do.
_SMALLEST = 1e-3
# With more harmonics order 8 takes longer than it is worth.
_MOST_HARMONICS = 200


@dataclass(frozen=True, kw_only=True)
class CriticalDamping(Result):
    """Damping K at which regions close.

    Attributes
    ----------
    critical : ndarray, shape (len(regions), *mu.shape)
        K above which the region is closed; 0 where the equation has no such region, NaN where
        the entry is flagged.
    lam2 : ndarray, same shape
        Where the region closes.
    error : ndarray, same shape
        Estimate of the absolute error of ``critical``.
    outside : ndarray of bool, same shape
        True where the orders do not visibly converge (never with ``order=None``).
    regions : tuple of int
        Numbers n.
    mu : ndarray
        As given.
    order : int or None
        Order of the perturbation; None for the exact value.
    """

    critical: Array
    lam2: Array
    outside: Mask
    regions: tuple[int, ...]
    mu: Array
    order: int | None

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("critical", "lam2", "error", "outside"), ("region", "mu")),
        "regions": ("region",),
        "mu": ("mu",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw K over mu, a line for each region.

        Raises
        ------
        BadInput
            If mu is not one-dimensional.
        """
        return _lines(ax, self, (self.mu, r"$\mu$"), (self.critical, "critical $K$"))


@dataclass(frozen=True, kw_only=True)
class LeastParameter(Result):
    """Least positive mu at which regions open.

    Attributes
    ----------
    least : ndarray, shape (len(regions), *damping.shape)
        The least mu; inf where none was found (``absent``), NaN where the entry is flagged.
    lam2 : ndarray, same shape
        Where the region opens.
    error : ndarray, same shape
        Estimate of the absolute error of ``least``; 0 where that is infinite.
    absent : ndarray of bool, same shape
        True where the region does not open up to ``searched``.
    outside : ndarray of bool, same shape
        True where the orders do not visibly converge before the region opens.
    regions : tuple of int
        Numbers n.
    damping : ndarray
        As given.
    order : int or None
        Order of the perturbation; None for the exact value.
    searched : ndarray, shape (len(regions),)
        Largest mu that was looked at, for each region.
    """

    least: Array
    lam2: Array
    absent: Mask
    outside: Mask
    regions: tuple[int, ...]
    damping: Array
    order: int | None
    searched: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("least", "lam2", "error", "absent", "outside"), ("region", "damping")),
        "regions": ("region",),
        "damping": ("damping",),
        "searched": ("region",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the least mu over K, a line for each region.

        Raises
        ------
        BadInput
            If the damping is not one-dimensional.
        """
        return _lines(ax, self, (self.damping, "$K$"), (self.least, r"least $\mu$"))


def _lines(
    ax: Axes | None,
    result: CriticalDamping | LeastParameter,
    across: tuple[Array, str],
    up: tuple[Array, str],
) -> Axes:
    from ...plotting import axes_or_new

    if across[0].ndim != 1:
        name = type(result).__name__
        raise bad(f"{name}.plot", f"an array of shape {across[0].shape}", "a line", "slice it")
    ax = axes_or_new(ax)
    for n, row in zip(result.regions, up[0], strict=True):
        ax.plot(across[0], np.where(np.isfinite(row), row, np.nan), label=f"region {n}")
    ax.set_xlabel(across[1])
    ax.set_ylabel(up[1])
    ax.legend()
    return ax


def critical_damping(
    f: PeriodicFunction, mu: ArrayLike, regions: Sequence[int] = (1, 2), order: int | None = None
) -> CriticalDamping:
    """Return the damping K at which regions of y'' + 2 K y' + (lam2 + mu f) y = 0 close.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
    mu : array_like
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 1 (region 0 reaches to minus infinity and is never closed).
    order : int, optional
        1 to 8: total degree in mu and K that is kept.  By default the exact value.

    Returns
    -------
    CriticalDamping
        The exact value is ``arccosh(max |D|) / (2 pi)``, with D the undamped half trace: the
        largest Floquet exponent in the undamped region.  Where a narrow region's ends do not
        resolve it so well, the value of order 8 takes its place, with its figure.  The check
        looks whether ``hill_boundaries`` finds the region open just below and closed just above.

    Raises
    ------
    BadInput
        If an argument is not finite, a region is not a whole number >= 1, the order is not 1 to
        8, or mu f is too large for ``hill_boundaries``.

    Notes
    -----
    Smith (7.50) is order 1.  To an order N: the root of ``|B|^2 = (Im A)^2`` with the components of
    the effective operator up to N.
    """
    check_function(f)
    numbers = _numbers(regions)
    if order is not None:
        check_order(order)
    (amp, _), shape = arguments(mu=mu, damping=0.0)
    flat = np.broadcast_to(amp, shape).ravel()
    found = [_closings(f, n, order)(flat) for n in numbers]
    full = (len(numbers), *shape)
    fields = _stacked(found, full)
    checks: Mapping[str, Check] = {}
    if order is None:
        critical, error = (
            fields[name].reshape(len(numbers), flat.size) for name in ("damping", "error")
        )
        checks = DeferredChecks(partial(_either_side, f, flat, numbers, critical, error))
    return CriticalDamping(
        method="largest half trace" if order is None else f"perturbation, order {order}",
        error=fields["error"],
        error_norm="absolute, entrywise, of K",
        checks=checks,
        provenance=provenance(),
        critical=fields["damping"],
        lam2=fields["lam2"],
        outside=fields["outside"].astype(bool),
        regions=numbers,
        mu=flat.reshape(shape),
        order=None if order is None else int(order),
    )


def least_parameter(
    f: PeriodicFunction,
    damping: ArrayLike,
    regions: Sequence[int] = (1, 2),
    order: int | None = None,
) -> LeastParameter:
    """Return the least mu > 0 at which regions of the damped Hill's equation open.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi (``-f`` for negative mu).
    damping : array_like
        K, at least zero, any shape.
    regions : sequence of int
        Numbers n >= 1.
    order : int, optional
        1 to 8; by default the exact value.

    Returns
    -------
    LeastParameter
        The first crossing of the critical damping with K as mu grows, sought on 24 values per
        decade, with the maxima between them, and refined: a region that opens and closes again
        within one step and shows no maximum on these values is not seen.  Without
        damping it is 0, or inf where no value of mu up to ``searched`` opens the region.  The
        check is that :func:`critical_damping` at the mu found gives K again.

    Raises
    ------
    BadInput
        If an argument is not finite or negative, a region is not a whole number >= 1, or the
        order is not 1 to 8.

    Notes
    -----
    Smith (7.51), ``mu = 2 K n / sqrt(an^2 + bn^2)``, is order 1.
    """
    check_function(f)
    numbers = _numbers(regions)
    if order is not None:
        check_order(order)
    (k,), shape = arguments(damping=damping)
    flat = np.broadcast_to(k, shape).ravel()
    reach = float(f.amplitudes[1:].sum())
    scale = max(max(numbers, default=1), float(flat.max(initial=0.0)))
    top = _FARTHEST * scale**2 / reach if reach > 0.0 else 0.0
    rows = [_least(_closings(f, n, order), n, flat, _silent(f, n, order), top) for n in numbers]
    fields = {
        name: np.reshape([getattr(row, name) for row in rows], (len(numbers), *shape))
        for name in ("least", "lam2", "error", "absent", "outside", "gap")
    }
    gap = fields["gap"][np.isfinite(fields["gap"])]
    return LeastParameter(
        method="largest half trace" if order is None else f"perturbation, order {order}",
        error=fields["error"],
        error_norm="absolute, entrywise, of mu",
        checks={
            "critical damping there less K, over its figure": Check(
                float(gap.max(initial=0.0)), 4.0
            )
        },
        provenance=provenance(),
        least=fields["least"],
        lam2=fields["lam2"],
        absent=fields["absent"].astype(bool),
        outside=fields["outside"].astype(bool),
        regions=numbers,
        damping=flat.reshape(shape),
        order=None if order is None else int(order),
        searched=np.array([row.searched[0] for row in rows]),
    )


@dataclass(frozen=True)
class _Least:
    """What the search found for one region, entry by entry."""

    least: Array
    lam2: Array
    error: Array
    absent: Mask
    outside: Mask
    gap: Array
    searched: Array

    @classmethod
    def nothing(cls, size: int) -> _Least:
        """Return the answer of a region that never opens."""
        infinite, unknown = np.full(size, np.inf), np.full(size, np.nan)
        flag = np.ones(size, dtype=bool)
        return cls(infinite, unknown, np.zeros(size), flag, ~flag, unknown.copy(), np.zeros(1))


def _numbers(regions: Sequence[int]) -> tuple[int, ...]:
    numbers = check_regions(regions)
    if 0 in numbers:
        raise bad("regions", 0, "whole numbers >= 1", "region 0 is never closed by damping")
    return numbers


def _stacked(found: Sequence[Closing], shape: tuple[int, ...]) -> dict[str, Array]:
    names = ("damping", "lam2", "error", "outside")
    fields = {name: np.reshape([getattr(row, name) for row in found], shape) for name in names}
    for name in names[:3]:
        fields[name][fields["outside"].astype(bool)] = np.nan
    return fields


def _closings(f: PeriodicFunction, n: int, order: int | None) -> Closings:
    """Return the function from mu to the closing of region n."""
    if order is not None:
        operator = effective_operator((f,), n, int(order) + BEYOND, damped=True)
        return partial(_quietly, partial(order_closing, operator, f))
    return partial(_best, f, n)


def _silent(f: PeriodicFunction, n: int, order: int | None) -> bool:
    """Return True where nothing up to the order couples the two resonant harmonics."""
    if order is None:
        return False
    operator = effective_operator((f,), n, int(order) + BEYOND, damped=True)
    return not any(np.any(row != 0.0) for row in operator.coupling[: int(order)])


def _quietly(closing: Closings, mu: Array) -> Closing:
    with np.errstate(all="ignore"):
        return closing(mu)


def _best(f: PeriodicFunction, n: int, mu: Array) -> Closing:
    """Return the exact closing, or that of order 8 where its figure is smaller."""
    exact = exact_closing(f, n, mu)
    coarse = np.flatnonzero(exact.error > 1e-13 * exact.damping)
    if not coarse.size or f.harmonics > _MOST_HARMONICS:
        return exact
    high = _closings(f, n, HIGHEST)(mu[coarse])
    # An order that does not see a tongue is not wrong about its width: the figures decide.
    better = ~high.outside & (high.error < exact.error[coarse])
    at = coarse[better]
    exact.damping[at], exact.lam2[at] = high.damping[better], high.lam2[better]
    exact.error[at] = high.error[better]
    return exact


def _either_side(
    f: PeriodicFunction, mu: Array, regions: tuple[int, ...], critical: Array, error: Array
) -> Mapping[str, Check]:
    """Count the contradictions with the damped boundaries just below and just above."""
    wrong, seen = 0, 0
    for i, n in enumerate(regions):
        k, slack = critical[i], np.maximum(1e-4 * critical[i], 100.0 * error[i])
        # Narrow regions open with a square root: Hill's matrix needs some width to see it.
        sure = np.flatnonzero((k > 2.0 * slack) & (k > 1e-6) & np.isfinite(k))
        if not sure.size:
            continue
        chosen = sure[np.unique(np.linspace(0, sure.size - 1, _SAMPLE).astype(int))]
        seen += chosen.size
        both = hill_boundaries(f, mu[chosen], (n,), k[chosen] + slack[chosen] * [[-1.0], [1.0]])
        shut = np.isnan(both.upper[0])
        wrong += int(np.count_nonzero(shut[0]) + np.count_nonzero(~shut[1]))
    return {"regions open above or closed below": Check(float(wrong), 0.0)} if seen else {}


def _least(closing: Closings, n: int, damping: Array, silent: bool, top: float) -> _Least:
    """Search one region: bracket the first crossing of the critical damping, and refine it."""
    out = _Least.nothing(damping.size)
    if silent or top == 0.0 or damping.size == 0:
        return out
    drag = damping[damping > 0.0]
    # Half traces grow with the first power of mu at most while mu f is small.
    least = min(1.0, 0.125 * n * float(drag.min())) if drag.size else _SMALLEST
    bottom = least * top / _FARTHEST
    bottom /= max(n, float(damping.max())) ** 2
    decades = np.log10(top / bottom)
    grid = np.geomspace(bottom, top, int(np.ceil(_PER_DECADE * decades)) + 1)
    grid, highest, edge = _climb(closing, grid, float(damping.max()))
    out.searched[0] = grid[-1]
    # The first grid value above each K: the running maximum is in order.
    first = np.searchsorted(highest, damping, side="right")
    found = first < grid.size
    out.outside[:] = np.minimum(first, grid.size - 1) >= edge
    out.absent[:] = ~found & ~out.outside
    out.least[out.outside] = np.nan
    still = found & ~out.outside & (damping == 0.0)
    out.least[still], out.lam2[still] = 0.0, 0.25 * n * n
    there = np.flatnonzero(found & ~out.outside & (damping > 0.0))
    if there.size:
        low = np.where(first[there] > 1, grid[np.maximum(first[there] - 2, 0)], 0.25 * bottom)
        _refine(out, closing, damping, there, np.log(low), np.log(grid[first[there]]))
    return out


def _climb(closing: Closings, grid: Array, enough: float) -> tuple[Array, Array, int]:
    """Return the grid with the running maximum of the critical damping, as far as needed.

    Less its figure, and with the peaks between the values of the grid.  Also the place of the
    first value at which the orders do not converge.  A decade at a time: small values of mu need
    small matrices.
    """
    found, edge = np.zeros(0), -1
    for part in np.array_split(grid, -(-grid.size // _PER_DECADE)):
        try:
            known = closing(part)
        except BadInput:
            # Hill's matrix would be too large: the search ends here.
            if not found.size:
                raise
            break
        value = np.where(known.outside, -np.inf, known.damping - known.error)
        before = found.size
        found = np.concatenate([found, value])
        if known.outside.any():
            edge = before + int(np.argmax(known.outside))
            break
        if found.max() > enough:
            break
    grid = grid[: found.size]
    last = found.size if edge < 0 else edge
    peaks, tops = _peaks(closing, grid[:last], found[:last])
    order = np.argsort(np.concatenate([grid, peaks]), kind="stable")
    grid, found = (
        np.concatenate([own, more])[order] for own, more in ((grid, peaks), (found, tops))
    )
    return grid, np.maximum.accumulate(found), grid.size if edge < 0 else last + peaks.size


def _peaks(closing: Closings, grid: Array, value: Array) -> tuple[Array, Array]:
    """Return the places of maxima near those on a grid, and the values there."""
    inner = np.flatnonzero((value[1:-1] > value[:-2]) & (value[1:-1] >= value[2:])) + 1
    if not inner.size:
        return np.zeros(0), np.zeros(0)
    low, high = np.log(grid[inner - 1]), np.log(grid[inner + 1])
    each = np.arange(inner.size)
    for _ in range(_ZOOMS):
        x = np.linspace(low, high, _ZOOM + 1)
        known = closing(np.exp(x.ravel()))
        tops = np.where(known.outside, -np.inf, known.damping - known.error).reshape(x.shape)
        best, step = tops.argmax(axis=0), (high - low) / _ZOOM
        low, high = x[best, each] - step, x[best, each] + step
    return np.exp(x[best, each]), tops[best, each]


def _refine(
    out: _Least, closing: Closings, damping: Array, there: Index, low: Array, high: Array
) -> None:
    """Solve ``log K_crit(mu) = log K`` in log mu, and enter what is found."""
    wanted = damping[there]

    def excess(x: Array, which: Index) -> Array:
        k = closing(np.exp(x)).damping
        return np.asarray(np.log(np.maximum(k / wanted[which], 1e-3)))

    x = crossing(excess, low, high)
    at, step = closing(np.exp(x)), 1e-4
    with np.errstate(divide="ignore", invalid="ignore"):
        up, down = (closing(np.exp(x + d)).damping for d in (step, -step))
        slope = np.maximum((np.log(up) - np.log(down)) / (2.0 * step), 1e-3)
    rounding = 8.0 * EPS * wanted * (1.0 + slope * np.abs(x))
    out.least[there], out.lam2[there] = np.exp(x), at.lam2
    out.error[there] = np.exp(x) * ((at.error + rounding) / (wanted * slope) + 4.0 * EPS)
    out.gap[there] = np.abs(at.damping - wanted) / (at.error + rounding)
    lost = there[at.outside]
    out.outside[lost], out.least[lost] = True, np.nan
