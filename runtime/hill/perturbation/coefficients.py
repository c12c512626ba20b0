"""Coefficients alpha_1, alpha_2, ... of the boundaries of a region as power series in mu."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.inputs import is_whole
from ...core.periodic_function import PeriodicFunction
from ...core.results import Check, Result, provenance
from ..exact.matrix import check_regions, hill_boundaries
from ..half_trace import check_function
from ..transfer import EPS
from .effective import HIGHEST_ORDER, effective_operator
from .orders import root_components

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# Origins of theta that tell the round-off: the boundaries do not depend on it.
_ORIGINS = (0.0, 1.0, 2.0, 3.0, 4.0)
_CAUTION = 8.0
# A leading coefficient of the root is taken for zero where it is within the round-off of the terms
# that make it, so many units of their size; above this share of its majorant it cannot be.
_ROUNDED, _CLEAR = 64.0, 1e-6
# Turns of the phases of f, harmonic by harmonic: what cancels at one does not at another.
_PHASES = (0.7, 1.3, 2.1)


@dataclass(frozen=True, kw_only=True)
class BoundarySeries(Result):
    """``lam2 = n^2/4 + alpha_1 mu + alpha_2 mu^2 + ...`` for both boundaries of a region.

    Attributes
    ----------
    lower, upper : ndarray, shape (order,)
        alpha_1, alpha_2, ... of the boundary that is the lower and the upper one at small
        positive mu; for negative mu they change places where the first difference is of odd order.
        Both are the same for region 0, and where they do not part up to this order.
    error : ndarray, shape (2, order)
        Estimate of their absolute error.
    region, order : int
        Number n and highest power of mu.
    damping_ratio : float
        beta of ``K = beta mu``.
    splitting : int
        Power of mu at which the two part; 0 where they do not up to this order.
    function : PeriodicFunction
        As given.
    """

    lower: Array
    upper: Array
    region: int
    order: int
    damping_ratio: float
    splitting: int
    function: PeriodicFunction

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "lower": ("power",),
        "upper": ("power",),
        "error": ("end", "power"),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw partial sums of every order and the exact boundaries, mu upwards."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        mu = np.linspace(0.0, 1.0, 101)
        exact = hill_boundaries(self.function, mu, (self.region,), damping=self.damping_ratio * mu)
        start = 0.25 * self.region**2
        pairs = ((exact.upper[0], self.upper), (exact.lower[0], self.lower))
        for end, alpha in pairs if self.region else pairs[:1]:
            named = "exact" if alpha is self.upper else None
            ax.plot(end, mu, color="black", lw=1.6, label=named)
            for k in range(1, self.order + 1):
                partial = start + sum(alpha[j] * mu ** (j + 1) for j in range(k))
                label = f"order {k}" if named else None
                ax.plot(partial, mu, "--", color=f"C{k - 1}", lw=1.0, label=label)
        known = np.concatenate([exact.lower[0], exact.upper[0]])
        known = known[np.isfinite(known)]
        room = 0.3 * np.ptp(known) + 0.1
        ax.set_xlim(known.min() - room, known.max() + room)
        ax.set_xlabel(r"$\lambda^2$")
        ax.set_ylabel(r"$\mu$")
        ax.legend()
        return ax


def boundary_series(
    f: PeriodicFunction, region: int, order: int = 4, damping_ratio: float = 0.0
) -> BoundarySeries:
    """Return the power series in mu of the boundaries of one region.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi in ``y'' + 2 K y' + (lam2 + mu f) y = 0``.
    region : int
        Number n >= 0.
    order : int
        1 to 10: highest power of mu.
    damping_ratio : float
        beta >= 0 of ``K = beta mu``, Smith 7.1.4.2.

    Returns
    -------
    BoundarySeries
        The error estimate compares series for several origins of theta, on which the boundaries
        do not depend; it covers round-off, not the error of f.  A difference of the two that is
        within the round-off of its terms, or within the error of f, is taken for zero, and the
        error holds what it may be; one that no harmonics of f make is zero indeed.

    Raises
    ------
    BadInput
        If an argument is out of range, or the damping closes the region at every small mu.

    Notes
    -----
    Smith (7.12), (7.23), (7.35), (7.46), to any order by Bloch's recursion.
    """
    check_function(f)
    (n,) = check_regions((region,))
    _check(order, damping_ratio)
    runs = [_alphas(_shifted(f, origin), n, order, damping_ratio) for origin in _ORIGINS]
    (middle, half), splitting, unknown = runs[0]
    spread = np.max([np.abs(other - runs[0][0]) for other, *_ in runs[1:]], axis=0).sum(axis=0)
    error = _CAUTION * spread + 2.0 * EPS * (np.abs(middle) + np.abs(half)) + unknown
    return BoundarySeries(
        method=f"Bloch's recursion, order {order}",
        error=np.stack([error, error]),
        error_norm="absolute, entrywise",
        checks={
            "origins that disagree on the order of splitting": Check(
                float(sum(other != splitting for _, other, _ in runs)), 0.0
            )
        },
        provenance=provenance(),
        lower=middle - half,
        upper=middle + half,
        region=n,
        order=order,
        damping_ratio=float(damping_ratio),
        splitting=splitting,
        function=f,
    )


def _check(order: object, damping_ratio: float) -> None:
    if not is_whole(order, 1, HIGHEST_ORDER):
        raise bad("order", repr(order), f"a whole number from 1 to {HIGHEST_ORDER}", "choose one")
    real = isinstance(damping_ratio, int | float | np.integer | np.floating)
    if not real or not 0.0 <= damping_ratio < np.inf:
        raise bad("damping_ratio", repr(damping_ratio), "a finite number >= 0", "correct it")


def _shifted(f: PeriodicFunction, origin: float) -> PeriodicFunction:
    """Return ``f(theta + origin)``."""
    m = np.arange(len(f.a))
    turn = (f.a - 1j * f.b) * np.exp(1j * m * origin)
    return PeriodicFunction(a=turn.real, b=-turn.imag, error=f.error)


def _doubt(f: PeriodicFunction, n: int, k: int, size: float) -> float:
    """Return below which size the coupling ``B_k`` of region n may be zero.

    ``size`` is its own.  Whether its terms cancel is seen with other phases of the harmonics.
    """
    reach = float(f.amplitudes[1:].sum())
    distance = float({1: 2}.get(n, n - 1))
    given = k * f.error * (reach / distance) ** (k - 1)
    if size > _CLEAR * reach**k:
        return given
    m = np.arange(len(f.a))
    point = np.array([[1.0], [0.0]])
    terms = size
    for phase in _PHASES:
        turn = (f.a - 1j * f.b) * np.exp(1j * phase * m * m)
        other = PeriodicFunction(a=turn.real, b=-turn.imag)
        b = effective_operator([other], n, k, True).components(point)[1]
        terms = max(terms, float(np.abs(b[-1, 0])))
    return _ROUNDED * EPS * terms + given


def _alphas(f: PeriodicFunction, n: int, order: int, ratio: float) -> tuple[Array, int, Array]:
    """Return the coefficients of middle and half, shape (2, order), and the order of splitting.

    Also what each coefficient may be that was taken for zero, shape (order,).
    """
    point = np.array([[1.0], [ratio]])
    a, b = (item[:, 0] for item in effective_operator([f], n, order, True).components(point))
    middle = a.real
    unknown = np.zeros(order)
    none = np.stack([middle, np.zeros(order)])
    if n == 0:
        return none, 0, unknown
    drag = a.imag
    # Damping is of the first order, and exact.
    s = 1 if ratio > 0.0 else 0
    for k in range(1, order + 1 if not s else 0):
        size = float(np.abs(b[k - 1]))
        # Where no path leads from one harmonic to the other there is a zero without round-off.
        doubt = _doubt(f, n, k, size) if size > 0.0 else 0.0
        if size > doubt:
            s = k
            break
        unknown[k - 1] = doubt
    if not s:
        return none, 0, unknown
    root, sign, _ = root_components(drag[:, None], b[:, None], s)
    if sign[0] <= 0.0:
        raise bad(
            "damping_ratio",
            f"{ratio:g}",
            f"less than {np.abs(b[s - 1]) / n:.6g}, where the damping closes region {n}",
            "take less damping",
        )
    half = np.zeros(order)
    half[s - 1 :] = root[:, 0]
    return np.stack([middle, half]), s, unknown
