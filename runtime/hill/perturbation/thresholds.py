"""Critical damping and least parameter of the unstable regions of Hill's equation.

Smith (7.50), (7.51): damping closes a region below a least parameter, and at a given parameter
above a critical damping.  Exactly, and to any order up to 8.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, DeferredChecks, Result, provenance
from ..exact.matrix import check_regions, hill_boundaries
from ..half_trace import arguments, check_function
from .boundaries import HIGHEST, check_order
from .closing import Closing, exact_closing, order_closing
from .effective import effective_operator
from .opening_search import FARTHEST, Closings, first_opening
from .orders import BEYOND

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_SAMPLE = 24
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
    from ...core.plotting import axes_or_new

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
    top = FARTHEST * scale**2 / reach if reach > 0.0 else 0.0
    rows = [
        first_opening(_closings(f, n, order), n, flat, _silent(f, n, order), top) for n in numbers
    ]
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
