"""Exact boundaries of the unstable regions of Hill's equation, from the eigenvalues of its matrix.

On a boundary of the n-th region the equation has a solution of period 2 pi (n even) or one that
changes sign after 2 pi (n odd): the boundaries lam2 are the real eigenvalues of
``k^2 - 2 K d/d theta - mu f`` in the basis cos k theta, sin k theta, k whole or half-whole.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check, DeferredChecks, Result, provenance
from .checks import arguments, axes_over, check_function, check_regions
from .damped import Ends, damped
from .fourier_matrix import CHUNK, banded, stacked, truncation
from .half_trace import discriminant, growth_rate
from .meissner import Meissner, meissner_ends
from .transfer import EPS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# Matrices larger than this, and so many times larger than their band, are reduced as bands.
_BANDED, _SPARSE = 160, 4
# Ends whose half trace is compared with its level, and the step of the differences there.  The
# errors are estimates, and slope and curvature come from differences.
_SAMPLE, _STEP, LIMIT = 24, 1e-4, 4.0
# exp(2 pi 80) leaves room for the rest of the arithmetic in doubles.
_GROWTH = 80.0


@dataclass(frozen=True, kw_only=True)
class Boundaries(Result):
    """Boundaries of unstable regions of Hill's equation.

    Attributes
    ----------
    lower, upper : ndarray, shape (len(regions), *mu.shape)
        Ends in lam2 of each unstable region; NaN where damping has closed it, or where that cannot
        be told (a check fails).
    error : ndarray, shape (len(regions), *mu.shape)
        Estimate of the absolute error, valid for both ends; NaN where they are.
    regions : tuple of int
        Numbers n; the region starts at lam2 = n^2/4 at mu = 0.
    mu, damping : ndarray
        As given, in their broadcast shape.
    """

    lower: Array
    upper: Array
    regions: tuple[int, ...]
    mu: Array
    damping: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("lower", "upper", "error"), ("region", "mu")),
        "regions": ("region",),
        **dict.fromkeys(("mu", "damping"), ("mu",)),
    }

    @property
    def width(self) -> Array:
        """Width of each region in lam2, same shape as ``lower``."""
        return self.upper - self.lower

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the regions over (lam2, mu), mu upwards.

        Raises
        ------
        BadInput
            If mu is not one-dimensional.
        """
        ax = axes_over(ax, "Boundaries.plot", "mu", self.mu)
        for low, high in zip(self.lower, self.upper, strict=True):
            line, other = ax.plot(np.stack([low, high], axis=1), self.mu)
            other.set_color(line.get_color())
            ax.fill_betweenx(self.mu, low, high, color=line.get_color(), alpha=0.3)
        ax.set_xlabel(r"$\lambda^2$")
        ax.set_ylabel(r"$\mu$")
        return ax


def hill_boundaries(
    f: PeriodicFunction | Meissner,
    mu: ArrayLike,
    regions: Sequence[int] = (1, 2),
    damping: ArrayLike = 0.0,
    certified: bool = False,
) -> Boundaries:
    """Return the exact boundaries of unstable regions of y'' + 2 K y' + (lam2 + mu f) y = 0.

    Parameters
    ----------
    f : PeriodicFunction or Meissner
        Coefficient of period 2 pi; of two levels the boundaries are in closed form.
    mu : array_like
        Any shape, any sign.
    regions : sequence of int
        Numbers n >= 0.  Region n >= 1 starts at lam2 = n^2/4 at mu = 0.  Region 0 reaches from
        minus infinity to the lowest eigenvalue of period 2 pi: ``lower`` is -inf.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with mu.
    certified : bool
        Prove every end: the result is a :class:`CertifiedBoundaries`, whose ``error`` is a bound
        (of the equation whose f has the coefficients as given: its own ``f.error`` stands apart
        in ``function_error``), with enclosures narrower than doubles can show.  Exact integer
        arithmetic; some ten to a hundred times slower.  Touching ends are enclosed as a pair; with
        damping an open region is proved open and a closed one closed, and where neither succeeds,
        next to the tip or under strong damping in deep wells, a check fails.

    Returns
    -------
    Boundaries
        ``lower``, ``upper`` and ``error`` of shape ``(len(regions), *mu.shape)`` (the broadcast
        shape of mu and damping).  NaN where damping has closed a region, and, with a check that
        fails, where K is so close to the value that closes it that doubles do not decide.  Its
        other check compares the half trace at up to 24 of the ends with the level of the
        boundary; it takes several times as long as one slice and is made when ``checks`` (or
        ``passed``) is first looked at.

    Raises
    ------
    BadInput
        If an argument is not finite, a region is not a whole number >= 0, K is negative or beyond
        1e100, the truncated matrix would need more than 2048 harmonics, or (certified) double
        precision does not tell the eigenvalues apart.

    Notes
    -----
    Smith 7.1.3 and 7.1.4: the curves that (7.37) and (7.48) approximate.  Without damping, what the
    truncated matrix leaves out lowers the eigenvalues by a proved amount (about 1e-13 or less, see
    :func:`.fourier_matrix.truncation`); the error adds an estimate of round-off and the error of
    ``f``, so that the whole is an estimate.  With damping each region lies within the undamped one
    moved by K^2 (the half trace has one extremum in each), which is how its real eigenvalues get
    their number.  Near the tip of a damped region the two ends depend on the data through a square
    root, and the error grows accordingly.  The eigenvalues lose digits as K grows; beyond K = 0.5
    the ends are roots of the half trace, a hundred times slower for a single slice.
    """
    if certified or not isinstance(f, Meissner):
        check_function(f)
    numbers = check_regions(regions)
    (amp, k), shape = arguments(mu=mu, damping=damping)
    if not isinstance(certified, bool | np.bool_):
        raise bad("certified", repr(certified), "True or False", "choose one")
    if certified and isinstance(f, PeriodicFunction):
        from .certified import certified_boundaries

        mus, drags = np.broadcast_arrays(amp, k)
        return certified_boundaries(f, mus, drags, numbers)
    flat, friction = (np.broadcast_to(item, shape).ravel() for item in (amp, k))
    ends = _ends(f, flat, friction, numbers)
    full = (len(numbers), *shape)
    return Boundaries(
        method="zeros of Meissner's factors" if isinstance(f, Meissner) else "Hill matrix",
        error=ends.error.reshape(full),
        error_norm="absolute, entrywise, for either end",
        checks=DeferredChecks(partial(_checks, f, flat, friction, numbers, ends)),
        provenance=provenance(),
        lower=ends.lower.reshape(full),
        upper=ends.upper.reshape(full),
        regions=numbers,
        mu=flat.reshape(shape),
        damping=friction.reshape(shape),
    )


def _ends(f: PeriodicFunction | Meissner, mu: Array, k: Array, regions: tuple[int, ...]) -> Ends:
    """Return the ends for mu and K ``(n,)``."""
    if not regions or not mu.size:
        return Ends.nothing((len(regions), mu.size))
    if isinstance(f, Meissner):
        ends = Ends.nothing((len(regions), mu.size))
        for i, n in enumerate(regions):
            ends.put(i, Ends(*meissner_ends(f, mu, n), ends.undecided[i]))
    else:
        ends = _undamped(f, mu, regions)
    return damped(f, mu, k, regions, ends) if k.any() else ends


def _undamped(f: PeriodicFunction, mu: Array, regions: tuple[int, ...]) -> Ends:
    ends = Ends.nothing((len(regions), mu.size))
    cut = truncation(f, float(np.abs(mu).max()), max(regions))
    mean = -f.a[0] * mu
    for odd in (0, 1):
        rows = [i for i, n in enumerate(regions) if n % 2 == odd]
        if not rows:
            continue
        count = max(regions[i] for i in rows) + 1
        values = _spectra(f, odd, cut.harmonic + odd, mu, count)
        values += mean[:, None]
        for i in rows:
            n = regions[i]
            ends.lower[i] = values[:, n - 1] if n else -np.inf
            ends.upper[i] = values[:, n]
    ends.error[:] = cut.left_out + cut.rounding + EPS * np.abs(mean) + f.error * np.abs(mu)
    return ends


def _spectra(f: PeriodicFunction, odd: int, harmonic: int, mu: Array, count: int) -> Array:
    """Return the lowest eigenvalues of ``k^2 - mu (f - mean)``, shape ``(n, count)``."""
    size = 2 * harmonic + 1 - odd
    if size > _BANDED and _SPARSE * (2 * f.harmonics + 1) < size:
        return np.stack([_banded(f, odd, harmonic, float(m), count) for m in mu])
    step = max(1, CHUNK // (size * size))
    out = np.empty((mu.size, count))
    for start in range(0, mu.size, step):
        part = slice(start, start + step)
        out[part] = np.linalg.eigvalsh(stacked(f, odd, harmonic, mu[part]))[:, :count]
    return out


def _banded(f: PeriodicFunction, odd: int, harmonic: int, mu: float, count: int) -> Array:
    """Return the lowest eigenvalues of a matrix that is large beside its band, shape (count,)."""
    from scipy.linalg import eig_banded

    whole = banded(f, odd, harmonic, mu)
    few = 8 * count < whole.shape[1]
    wanted: dict[str, Any] = {"select": "i", "select_range": (0, count - 1)} if few else {}
    values = eig_banded(whole, lower=True, eigvals_only=True, check_finite=False, **wanted)
    return np.asarray(values[:count])


# ---------------------------------------------------------------- the half trace as a check


def _checks(
    f: PeriodicFunction | Meissner, mu: Array, damping: Array, regions: tuple[int, ...], ends: Ends
) -> Mapping[str, Check]:
    """Count undecided regions, and compare half traces at a sample of ends with their level."""
    checks: dict[str, Check] = {}
    if np.any(ends.undecided):
        undecided = float(np.count_nonzero(ends.undecided))
        checks["regions neither open nor closed"] = Check(undecided, 0.0)
    both = np.stack([ends.lower, ends.upper])
    places = np.argwhere(np.isfinite(both))
    if len(places):
        side, row, column = sample_of(places)
        sign = np.where(np.asarray(regions)[row] % 2 == 0, 1.0, -1.0)
        k = damping[column]
        level = sign * 0.5 * (1.0 + np.exp(-4.0 * np.pi * k))
        checks["half trace at the ends over what the errors explain"] = half_trace_check(
            f, both[side, row, column], ends.error[row, column], mu[column], k, level
        )
    return checks


def sample_of(places: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return an even sample of places ``(n, d)``, its ends included, by coordinate."""
    chosen = np.unique(np.linspace(0, len(places) - 1, min(_SAMPLE, len(places))).round())
    return np.asarray(places[chosen.astype(int)].T)


def half_trace_check(
    f: PeriodicFunction | Meissner,
    lam2: Array,
    error: Array,
    mu: Array,
    damping: Array,
    level: Array,
) -> Check:
    """Compare half traces with what they should be, over what the errors explain; all ``(n,)``.

    Explained are slope times error, half the curvature times its square (the slope vanishes where
    a region is closed), and the error of the half trace.  NaN, which fails, where the half trace
    cannot be computed.
    """
    step = _STEP * (1.0 + np.sqrt(np.abs(lam2)))
    # Where solutions grow beyond doubles, more damping takes the growth away from all of them.
    growth = growth_rate(f, lam2 - damping * damping, mu)
    drag = np.where(growth > _GROWTH, np.maximum(growth, damping), damping)
    place = lam2 + (drag - damping) * (drag + damping)
    try:
        half = discriminant(f, place + step * np.array([[-1.0], [0.0], [1.0]]), mu, drag)
    except BadInput:
        return Check(np.nan, LIMIT)
    level = level * np.exp(2.0 * np.pi * (damping - drag))
    with np.errstate(invalid="ignore", over="ignore"):
        before, at, after = half.value
        slope = np.abs(after - before) / (2.0 * step)
        bend = np.abs(after - 2.0 * at + before) / step**2
        explained = (
            slope * error + 0.5 * bend * error**2 + half.error[1] + 4.0 * EPS * np.abs(level)
        )
        share = np.abs(at - level) / explained
    return Check(float(share.max()), LIMIT)
