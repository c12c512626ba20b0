"""Stability boundaries of Hill's equation from the eigenvalues of its Fourier (Hill) matrix.

On a boundary of the n-th region the equation has a solution of period 2 pi (n even) or one that
changes sign after 2 pi (n odd).  In the basis cos k theta, sin k theta (k whole or half-whole) the
boundaries lam2 are the eigenvalues of ``k^2 - 2 K d/d theta - mu f``: symmetric without damping.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.periodic_function import PeriodicFunction
from ...core.results import DeferredChecks, Result, provenance
from ..half_trace import arguments, check_function
from ..transfer import EPS
from .damped import damped
from .layout import LARGEST, banded, stacked, truncation
from .verification import boundary_checks

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes

    from .certified import CertifiedBoundaries

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_CHUNK = 2**18
# Matrices larger than this, and so many times larger than their band, are reduced as bands.
_BANDED, _SPARSE = 160, 4


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
        "lower": ("region", "mu"),
        "upper": ("region", "mu"),
        "error": ("region", "mu"),
        "regions": ("region",),
        "mu": ("mu",),
        "damping": ("mu",),
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
        from ...core.plotting import axes_or_new

        if self.mu.ndim != 1:
            raise bad("Boundaries.plot", f"mu of shape {self.mu.shape}", "a line of mu", "slice it")
        ax = axes_or_new(ax)
        for low, high in zip(self.lower, self.upper, strict=True):
            line, other = ax.plot(np.stack([low, high], axis=1), self.mu)
            other.set_color(line.get_color())
            ax.fill_betweenx(self.mu, low, high, color=line.get_color(), alpha=0.3)
        ax.set_xlabel(r"$\lambda^2$")
        ax.set_ylabel(r"$\mu$")
        return ax


@overload
def hill_boundaries(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = ...,
    damping: ArrayLike = ...,
    certified: Literal[False] = ...,
) -> Boundaries: ...


@overload
def hill_boundaries(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = ...,
    damping: ArrayLike = ...,
    *,
    certified: Literal[True],
) -> CertifiedBoundaries: ...


@overload
def hill_boundaries(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = ...,
    damping: ArrayLike = ...,
    certified: bool = ...,
) -> Boundaries: ...


def hill_boundaries(
    f: PeriodicFunction,
    mu: ArrayLike,
    regions: Sequence[int] = (1, 2),
    damping: ArrayLike = 0.0,
    certified: bool = False,
) -> Boundaries:
    """Return the exact boundaries of unstable regions of y'' + 2 K y' + (lam2 + mu f) y = 0.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi.
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
    :func:`.layout.truncation`); the error figure adds an estimate of round-off and the error of
    ``f``, so that the whole is an estimate.  With damping each region
    lies within the undamped one moved by K^2 (the half trace has one extremum in each), which
    is how its real eigenvalues get their number.  Near the tip of a damped region the
    two ends depend on the data through a square root, and the error figure grows accordingly.
    The eigenvalues lose digits as K grows; beyond K = 0.5 the ends are roots of the half trace, a
    hundred times slower for a single slice.
    """
    check_function(f)
    numbers = check_regions(regions)
    (amp, k), shape = arguments(mu=mu, damping=damping)
    if not isinstance(certified, bool | np.bool_):
        raise bad("certified", repr(certified), "True or False", "choose one")
    if certified:
        from .certified import certified_boundaries

        mus, drags = np.broadcast_arrays(amp, k)
        return certified_boundaries(f, mus, drags, numbers)
    flat, friction = (np.broadcast_to(item, shape).ravel() for item in (amp, k))
    lower, upper, error, undecided = _boundaries(f, flat, friction, numbers)
    ends = partial(boundary_checks, f, flat, friction, numbers, lower, upper, error, undecided)
    full = (len(numbers), *shape)
    return Boundaries(
        method="Hill matrix",
        error=error.reshape(full),
        error_norm="absolute, entrywise, for either end",
        checks=DeferredChecks(ends),
        provenance=provenance(),
        lower=lower.reshape(full),
        upper=upper.reshape(full),
        regions=numbers,
        mu=flat.reshape(shape),
        damping=friction.reshape(shape),
    )


def _boundaries(
    f: PeriodicFunction, mu: Array, k: Array, regions: tuple[int, ...]
) -> tuple[Array, Array, Array, Mask]:
    """Return lower, upper, error and undecided, ``(len(regions), n)``, for mu and K ``(n,)``."""
    undecided: Mask = np.zeros((len(regions), mu.size), dtype=bool)
    if not undecided.size:
        nothing = np.zeros(undecided.shape)
        return nothing, nothing.copy(), nothing.copy(), undecided
    lower, upper, error = _undamped(f, mu, regions)
    hit = k > 0.0
    if hit.any():
        lower[:, hit], upper[:, hit], error[:, hit], undecided[:, hit] = damped(
            f, mu[hit], k[hit], regions, (lower[:, hit], upper[:, hit], error[:, hit])
        )
    return lower, upper, error, undecided


def _undamped(
    f: PeriodicFunction, mu: Array, regions: tuple[int, ...]
) -> tuple[Array, Array, Array]:
    """Return lower, upper and error, each ``(len(regions), n)``, for mu ``(n,)``."""
    lower = np.empty((len(regions), mu.size))
    upper = np.empty_like(lower)
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
            lower[i] = values[:, n - 1] if n else -np.inf
            upper[i] = values[:, n]
    # LAPACK's errors are a few roundings of the norm, and grow with the root of the size.
    rounding = EPS * max(4.0, 0.25 * (2.0 * cut.harmonic) ** 0.5)
    figure = cut.left_out + rounding * cut.norm + EPS * np.abs(mean) + f.error * np.abs(mu)
    return lower, upper, np.tile(figure, (len(regions), 1))


def _spectra(f: PeriodicFunction, odd: int, harmonic: int, mu: Array, count: int) -> Array:
    """Return the lowest eigenvalues of ``k^2 - mu (f - mean)``, shape ``(n, count)``."""
    size = 2 * harmonic + 1 - odd
    if size > _BANDED and _SPARSE * (2 * f.harmonics + 1) < size:
        return np.stack([_banded(f, odd, harmonic, float(m), count) for m in mu])
    step = max(1, _CHUNK // (size * size))
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


def check_regions(regions: Sequence[int]) -> tuple[int, ...]:
    """Return the numbers of the regions, or refuse."""
    try:
        numbers = tuple(int(n) for n in regions)
        good = all(n == given and n >= 0 for n, given in zip(numbers, regions, strict=True))
    except (TypeError, ValueError, OverflowError):
        good = False
    if not good:
        raise bad("regions", repr(regions), "whole numbers >= 0", "for example (1, 2)")
    if numbers and max(numbers) > LARGEST:
        raise bad("regions", max(numbers), f"at most {LARGEST}", "ask for lower regions")
    return numbers
