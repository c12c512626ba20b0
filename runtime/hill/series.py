"""Coefficients alpha_1, alpha_2, ... of the boundaries of a region as power series in mu."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.inputs import is_whole
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check, Result, provenance
from .bloch import HIGHEST_ORDER, effective_operator
from .boundaries import hill_boundaries
from .checks import check_function, check_regions
from .perturbation import root_components
from .transfer import EPS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# Origins of theta that show the round-off: the boundaries do not depend on it.
_ORIGINS = (0.0, 1.0, 2.0, 3.0, 4.0)
_CAUTION = 8.0
# Roundings of the leading component of the root, which all others hang on.
_LEADING = 4.0 * EPS
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

    def latex(self, any_region: bool = False) -> str:
        """Return both boundaries as a formula, to the order; see :func:`.formulas.boundary_latex`.

        Parameters
        ----------
        any_region : bool
            True to have the letter n, for any region from 1, in place of the number.

        Raises
        ------
        BadInput
            If the order is above 6.
        """
        from .formulas import boundary_latex

        region = None if any_region else self.region
        return boundary_latex(self.order, region, self.damping_ratio > 0.0)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw partial sums of every order and the exact boundaries, mu upwards."""
        from ..core.plotting import axes_or_new

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
    if not is_whole(order, 1, HIGHEST_ORDER):
        raise bad("order", repr(order), f"a whole number from 1 to {HIGHEST_ORDER}", "choose one")
    real = isinstance(damping_ratio, int | float | np.integer | np.floating)
    if not real or not 0.0 <= damping_ratio < np.inf:
        raise bad("damping_ratio", repr(damping_ratio), "a finite number >= 0", "correct it")
    runs = [_alphas(_turned(f, origin), n, order, damping_ratio) for origin in _ORIGINS]
    (middle, half), splitting, doubt = runs[0]
    spread = np.max([np.abs(other - runs[0][0]) for other, *_ in runs[1:]], axis=0).sum(axis=0)
    error = _CAUTION * spread + 2.0 * EPS * (np.abs(middle) + np.abs(half)) + doubt
    disagreeing = float(sum(other != splitting for _, other, _ in runs))
    return BoundarySeries(
        method=f"Bloch's recursion, order {order}",
        error=np.stack([error, error]),
        error_norm="absolute, entrywise",
        checks={"origins that disagree on the order of splitting": Check(disagreeing, 0.0)},
        provenance=provenance(),
        lower=middle - half,
        upper=middle + half,
        region=n,
        order=order,
        damping_ratio=float(damping_ratio),
        splitting=splitting,
        function=f,
    )


def _turned(f: PeriodicFunction, origin: float, power: int = 1) -> PeriodicFunction:
    """Return ``f(theta + origin)``, or with other phases that grow with a power of the harmonic."""
    turn = (f.a - 1j * f.b) * np.exp(1j * origin * np.arange(len(f.a)) ** power)
    return PeriodicFunction(a=turn.real, b=-turn.imag, error=f.error)


def _uncertain(f: PeriodicFunction, n: int, k: int, size: float) -> float:
    """Return below which size the coupling ``B_k`` of region n may be zero; ``size`` is its own.

    Whether its terms cancel is seen with other phases of the harmonics.
    """
    reach = float(f.amplitudes[1:].sum())
    given = k * f.error * (reach / float({1: 2}.get(n, n - 1))) ** (k - 1)
    if size > _CLEAR * reach**k:
        return given
    point = np.array([[1.0], [0.0]])
    others = [
        effective_operator([_turned(f, phase, 2)], n, k, True).components(point)[1][-1, 0]
        for phase in _PHASES
    ]
    return _ROUNDED * EPS * max(size, *map(abs, others)) + given


def _alphas(f: PeriodicFunction, n: int, order: int, ratio: float) -> tuple[Array, int, Array]:
    """Return the coefficients of middle and half, shape (2, order), and the order of splitting.

    Also what the coefficients may be off by for a leading one that is zero or uncertain, (order,).
    """
    point = np.array([[1.0], [ratio]])
    a, b = effective_operator([f], n, order, True).components(point)
    middle, drag = a[:, 0].real, a.imag
    half, doubt = np.zeros(order), np.zeros(order)
    # Damping is of the first order, and exact.
    s = 1 if ratio > 0.0 and n else 0
    for k in range(1, order + 1 if n and not s else 0):
        size = float(np.abs(b[k - 1, 0]))
        # Where no path leads from one harmonic to the other there is a zero without round-off.
        least = _uncertain(f, n, k, size) if size > 0.0 else 0.0
        if size > least:
            s = k
            break
        doubt[k - 1] = least
    if not s:
        return np.stack([middle, half]), 0, doubt
    root, sign, _ = root_components(drag, b, s)
    if sign[0] <= 0.0:
        closing = np.abs(b[s - 1, 0]) / n
        expected = f"less than {closing:.6g}, where the damping closes region {n}"
        raise bad("damping_ratio", f"{ratio:g}", expected, "take less damping")
    nudged = b.copy()
    nudged[s - 1] *= 1.0 + _LEADING
    half[s - 1 :] = root[:, 0]
    doubt[s - 1 :] += np.abs(root_components(drag, nudged, s)[0] - root)[:, 0]
    return np.stack([middle, half]), s, doubt
