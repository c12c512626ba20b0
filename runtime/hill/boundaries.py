"""Exact boundaries of the unstable regions of Hill's equation, with damping or without.

On a boundary of the n-th region the equation has a solution of period 2 pi (n even) or one that
changes sign after 2 pi (n odd): the boundaries lam2 are the real eigenvalues of
``k^2 - 2 K d/d theta - mu f`` in the basis cos k theta, sin k theta, k whole or half-whole.

With y = exp(-K theta) u the equation becomes u'' + (lam2 - K^2 + mu f) u = 0, and the multipliers
+-1 of y belong to the half traces +-cosh(2 pi K) of u.  Within an undamped region the half trace
of u has one extremum, so that a damped region has two ends inside it, or none; region 0 always has
its one.  ``arccosh(max |D|) / (2 pi)`` at the extremum is the largest Floquet exponent of the
region, and so the damping that closes it.

Damping makes the matrix unsymmetric, and its eigenvalues ill-conditioned: the solutions and those
of the adjoint equation grow and fall like exp(K theta) over a turn.  The half trace has no such
weakness, and serves where damping is strong, or where a region that the matrix takes for closed
may be open within its rounding.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import chebyshev as series
from numpy.typing import ArrayLike, NDArray

from ..core.chebyshev import analysis, nodes
from ..core.errors import BadInput
from ..core.inputs import require_flag
from ..core.maxima import bracketed_roots
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes
from ..core.results import Check, DeferredChecks, Result, provenance
from .checks import EPS, Array, Index, Mask, axes_over, check_function, check_regions, points
from .fourier_matrix import banded, by_parity, chunks, stacked, truncation
from .half_trace import discriminant, growth_rate
from .meissner import Meissner, meissner_ends

# Ends whose half trace is compared with its level, and the step of the differences there.  The
# errors are estimates, and slope and curvature come from differences.
_SAMPLE, _STEP, LIMIT = 24, 1e-4, 4.0
# exp(2 pi 80) leaves room for the rest of the arithmetic in doubles.
_GROWTH = 80.0
# Half the length over which a narrow region is resolved, and what narrow means: far enough from
# all nodes that the half trace less its level keeps its digits there.
_RESOLVED, _NARROW = 0.25, 0.01
_NODES, _MOST_NODES = 16, 256
# Half traces at a time: beyond some thousand scattered points they would be interpolated.
_POINTS = 4096

# Lower and upper ends of regions and their error, ``(3, len(regions), n)`` or ``(3, n)``: NaN where
# a region is closed, and with an infinite error where it is not decided whether it is.
Ends = Array


@dataclass(frozen=True, kw_only=True)
class Boundaries(Result):
    """Boundaries of unstable regions of Hill's equation.

    Attributes
    ----------
    lower, upper : ndarray, shape ``(len(regions), *mu.shape)``
        Ends in lam2 of each unstable region; NaN where damping has closed it, or where that cannot
        be decided (a check fails).
    error : ndarray, shape ``(len(regions), *mu.shape)``
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

    arrays_along: ClassVar = {
        "region mu": "lower upper error",
        "mu": "mu damping",
        "region": "regions",
    }

    @property
    def width(self) -> Array:
        """Width of each region in lam2, same shape as ``lower``."""
        return self.upper - self.lower

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the regions over (lam2, mu), mu upwards.

        Raises ``BadInput`` if mu is not one-dimensional.
        """
        ax = axes_over(ax, "Boundaries.plot", "mu", self.mu)
        for low, high in zip(self.lower, self.upper, strict=True):
            line, other = ax.plot(np.stack([low, high], axis=1), self.mu)
            other.set_color(line.get_color())
            ax.fill_betweenx(self.mu, low, high, color=line.get_color(), alpha=0.3)
        ax.set(xlabel=r"$\lambda^2$", ylabel=r"$\mu$")
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

    Examples
    --------
    >>> import elastolink as el
    >>> cosine = el.PeriodicFunction(a=[0.0, 1.0])
    >>> found = el.hill_boundaries(cosine, mu=0.1, regions=(1, 2))
    >>> print(found.lower.round(6), found.upper.round(6))
    [0.198781 0.999167] [0.298719 1.004145]
    """
    require_flag("certified", certified)
    if certified or not isinstance(f, Meissner):
        check_function(f)
    numbers = check_regions(regions)
    (flat, friction), shape = points(mu=mu, damping=damping)
    if certified and isinstance(f, PeriodicFunction):
        from .certified import certified_boundaries

        return certified_boundaries(f, flat.reshape(shape), friction.reshape(shape), numbers)
    ends = ends_at(f, flat, friction, numbers)
    lower, upper, error = ends.reshape(3, len(numbers), *shape)
    return Boundaries(
        method="zeros of Meissner's factors" if isinstance(f, Meissner) else "Hill matrix",
        error=np.where(np.isinf(error), np.nan, error),
        error_norm="absolute, entrywise, for either end",
        checks=DeferredChecks(partial(_checks, f, flat, friction, numbers, ends)),
        provenance=provenance(),
        lower=lower,
        upper=upper,
        regions=numbers,
        mu=flat.reshape(shape),
        damping=friction.reshape(shape),
    )


def ends_at(f: PeriodicFunction | Meissner, mu: Array, k: Array, regions: tuple[int, ...]) -> Ends:
    """Return the ends for mu and K ``(n,)``."""
    ends = np.full((3, len(regions), mu.size), np.nan)
    if not ends.size:
        return ends
    if isinstance(f, Meissner):
        ends[:] = np.stack([meissner_ends(f, mu, n) for n in regions], axis=1)
    else:
        cut = truncation(f, float(np.abs(mu).max()), max(regions))
        mean = -f.a[0] * mu
        for odd, rows in by_parity(regions):
            count = max(regions[i] for i in rows) + 1
            values = _spectra(f, odd, cut.harmonic + odd, mu, count) + mean[:, None]
            for i in rows:
                ends[0, i] = values[:, regions[i] - 1] if regions[i] else -np.inf
                ends[1, i] = values[:, regions[i]]
        ends[2] = cut.left_out + cut.rounding + EPS * np.abs(mean) + f.error * np.abs(mu)
    return _damped(f, mu, k, regions, ends) if k.any() else ends


def _spectra(f: PeriodicFunction, odd: int, harmonic: int, mu: Array, count: int) -> Array:
    """Return the lowest eigenvalues of ``k^2 - mu (f - mean)``, shape ``(n, count)``."""
    size = 2 * harmonic + 1 - odd
    # Large matrices with a narrow band are reduced as bands.
    if size > 160 and 4 * (2 * f.harmonics + 1) < size:
        from scipy.linalg import eig_banded

        few = {"select": "i", "select_range": (0, count - 1)} if 8 * count < size else {}
        solve = partial(eig_banded, lower=True, eigvals_only=True, check_finite=False, **few)
        return np.stack([solve(banded(f, odd, harmonic, float(m)))[:count] for m in mu])
    stacks = (stacked(f, odd, harmonic, mu[part]) for part in chunks(mu.size, size))
    return np.concatenate([np.linalg.eigvalsh(stack)[:, :count] for stack in stacks])


# ---------------------------------------------------------------- the half trace as a check


def _checks(
    f: PeriodicFunction | Meissner, mu: Array, damping: Array, regions: tuple[int, ...], ends: Ends
) -> Mapping[str, Check]:
    """Count undecided regions, and compare half traces at a sample of ends with their level."""
    checks: dict[str, Check] = {}
    undecided = np.count_nonzero(np.isinf(ends[2]))
    if undecided:
        checks["regions neither open nor closed"] = Check(float(undecided), 0.0)
    places = np.argwhere(np.isfinite(ends[:2]))
    if len(places):
        side, row, column = sample_of(places)
        sign = np.where(np.asarray(regions)[row] % 2 == 0, 1.0, -1.0)
        k = damping[column]
        level = sign * 0.5 * (1.0 + np.exp(-4.0 * np.pi * k))
        checks["half trace at the ends over what the errors explain"] = half_trace_check(
            f, ends[side, row, column], ends[2, row, column], mu[column], k, level
        )
    return checks


def sample_of(places: Index, most: int = _SAMPLE) -> Index:
    """Return an even sample of places ``(n, d)``, its ends included, by coordinate."""
    chosen = np.unique(np.linspace(0, len(places) - 1, min(most, len(places))).round())
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


# ---------------------------------------------------------------- with damping


def _damped(
    f: PeriodicFunction | Meissner, mu: Array, k: Array, regions: tuple[int, ...], sharp: Ends
) -> Ends:
    """Return the ends for mu and K ``(n,)`` from the undamped ones, which serve where K = 0."""
    ends = sharp.copy()
    # Beyond this K the condition of the eigenvalues, of the size of exp(2 pi K) at worst, matters.
    strong = (k > 0.0) if isinstance(f, Meissner) else (k > 0.5)
    weak = (k > 0.0) & ~strong
    if weak.any() and not isinstance(f, Meissner):
        ends[..., weak] = _from_matrix(f, mu[weak], k[weak], regions, sharp[..., weak])
    for i, n in enumerate(regions):
        unsure = strong | np.isinf(ends[2, i])
        if unsure.any():
            near = sharp[:, i, unsure]
            ends[:, i, unsure] = _from_half_trace(f, mu[unsure], k[unsure], n, near)
    return ends


def _from_matrix(
    f: PeriodicFunction, mu: Array, k: Array, regions: tuple[int, ...], sharp: Ends
) -> Ends:
    """Return the ends by the real eigenvalues of the matrix; undecided are pairs almost real."""
    low, high, _ = sharp
    shift = k * k
    cut = truncation(f, float(np.abs(mu).max()), max(regions), float(shift.max()))
    # The damping term is part of the norm.
    rounding = cut.rounding * (1.0 + 2.0 * float(k.max()) * (cut.harmonic + 1) / cut.norm)
    local = cut.left_out + rounding + f.error * np.abs(mu)
    slack = 4.0 * local
    ends = np.full(sharp.shape, np.nan)
    for odd, rows in by_parity(regions):
        harmonic = cut.harmonic + odd
        stacks = (
            stacked(f, odd, harmonic, mu[part], k[part])
            for part in chunks(mu.size, 2 * harmonic + 1 - odd)
        )
        values = np.concatenate([np.linalg.eigvals(stack) for stack in stacks])
        place = values.real - (f.a[0] * mu + shift)[:, None]
        real = np.where(values.imag == 0.0, place, np.nan)
        for i in rows:
            # NaN compares false: complex eigenvalues drop out here.
            inside = (real >= (low[i] - slack)[:, None]) & (real <= (high[i] + slack)[:, None])
            first = np.where(inside, real, np.inf).min(axis=1)
            last = np.where(inside, real, -np.inf).max(axis=1)
            whole = inside.sum(axis=1) >= (1 if regions[i] == 0 else 2)
            # Two ends that met are as far from being real as the root of what moves them.
            # A complex pair that is real within four times its round-off goes to the half trace.
            blur = 4.0 * np.sqrt(np.maximum(high[i] - low[i], slack) * slack)
            near = (place >= (low[i] - blur)[:, None]) & (place <= (high[i] + blur)[:, None])
            near &= np.abs(values.imag) <= blur[:, None]
            undecided = ~whole & (near.any(axis=1) if regions[i] else True)
            ends[2, i, undecided] = np.inf
            first, last = first[whole], last[whole]
            ends[1, i, whole] = last + shift[whole]
            if regions[i] == 0:
                ends[0, i, whole], ends[2, i, whole] = -np.inf, local[whole]
                continue
            ends[0, i, whole] = first + shift[whole]
            ends[2, i, whole] = near_tip(
                local[whole], 0.5 * (last - first), 0.5 * (high[i] - low[i])[whole]
            )
    return ends


def near_tip(local: Array | float, half: Array | float, sharp_half: Array | float) -> Array:
    """Return the error of ends ``+-half`` that damping drew in from ``+-sharp_half``.

    The ends follow ``sqrt(sharp_half^2 - const)``: an error of the data is magnified by
    ``sharp_half / half``, and at the tip by the square root.
    """
    square = 2.0 * np.maximum(half, sharp_half) * local
    inner = np.maximum(half * half - square, 0.0)
    moved = np.where(inner > 0.0, half - np.sqrt(inner), np.sqrt(half * half + square))
    return np.asarray(moved + local)


# ---------------------------------------------------------------- strong damping


def _end(
    f: PeriodicFunction | Meissner, n: int, mu: Array, k: Array, outer: Array, inner: Array
) -> tuple[Array, Array]:
    """Return where half traces cross the level of region n, and the error, at points ``(m,)``."""
    # Between a place `outer` below the level and one `inner` above it.
    sign, turned = 1.0 if n % 2 == 0 else -1.0, np.where(inner < outer, -1.0, 1.0)

    def share(which: Index, lam2: Array) -> tuple[Array, float]:
        # The logarithm of half trace over level, clipped where all are alike.
        half = discriminant(f, lam2, mu[which], k[which])
        return np.asarray(np.log(np.clip(sign * half.value / half.level, 1e-304, 1e304))), 0.0

    def sure(lam2: Array, which: Index, above: bool) -> Mask:
        # Whether the half trace is above, or below, by more than its error.
        half = discriminant(f, lam2, mu[which], k[which])
        gap = sign * half.value - half.level
        error = np.where(np.isfinite(half.value), half.error, 0.0) + 2.0 * EPS * half.level
        return np.asarray(gap > error if above else gap < -error)

    place = bracketed_roots(share, outer, inner)[0]
    error = 2.0 * EPS * (np.maximum(np.abs(place), k * k) + 1.0)
    left = np.arange(place.size)
    # Proposals of the error, each three times the one before.
    for _ in range(40):
        step = turned[left] * error[left]
        within, beyond = place[left] + step, place[left] - step
        # Between the undamped end and the extremum there is a crossing in any case.
        past = turned[left] * (within - inner[left]) >= 0.0
        before = turned[left] * (outer[left] - beyond) >= 0.0
        good = past | sure(np.where(past, inner[left], within), left, above=True)
        good &= before | sure(np.where(before, outer[left], beyond), left, above=False)
        left = left[~good]
        if not left.size:
            break
        error[left] *= 3.0
    return place, error


def _from_half_trace(
    f: PeriodicFunction | Meissner, mu: Array, k: Array, n: int, sharp: Ends
) -> Ends:
    """Return the ends of region n for mu and K ``(n,)``; undecided where K may be critical."""
    low, high, slack = sharp
    shift = k * k
    if n == 0:
        # With z = y'/y the equation says that the mean of lam2 + mu f is that of -z^2 on the end;
        # where it is below zero all the way round, the solutions grow faster than K.
        reach = np.abs(mu) * f.bound() * (1.0 + 4.0 * EPS)
        most = np.minimum(high + shift + slack, EPS * reach + slack - mu * f.mean)
        upper, error = _end(f, n, mu, k, most, -reach - 1.0)
        return np.stack([np.full(mu.shape, -np.inf), upper, error])
    critical, peak, doubt = largest_exponent(f, n, mu, sharp)
    decided = np.abs(k - critical) > doubt
    ends = np.full(sharp.shape, np.nan)
    ends[2, ~decided] = np.inf
    there = np.flatnonzero((k < critical) & decided)
    if there.size:
        point, top = (f, n, mu[there], k[there]), (peak + shift)[there]
        lower, first = _end(*point, (low + shift - slack)[there], top)
        upper, last = _end(*point, (high + shift + slack)[there], top)
        ends[:, there] = lower, upper, np.maximum(first, last)
    return ends


# ---------------------------------------------------------------- the largest exponent


def largest_exponent(f: PeriodicFunction | Meissner, n: int, mu: Array, sharp: Ends) -> Array:
    """Return the largest exponent in region n >= 1, the lam2 where it stands and its error.

    For mu ``(n,)`` from the undamped ends there; shape ``(3, n)``.
    """
    out = np.zeros((3, mu.size))
    narrow = sharp[1] - sharp[0] < _NARROW
    for these, solve in ((narrow, _narrow), (~narrow, _wide)):
        if these.any():
            out[:, these] = solve(f, n, mu[these], sharp[:, these])
    return out


def _excess(
    f: PeriodicFunction | Meissner, n: int, lam2: Array, mu: Array, drag: Array | float = 0.0
) -> tuple[Array, Array]:
    """Return ``(|D| - 1) exp(-2 pi drag)`` inside the region (negative beyond it) and its error."""
    shape = lam2.shape
    x, y, k = (np.broadcast_to(item, shape).ravel() for item in (lam2, mu, drag))
    value, error = np.empty((2, x.size))
    for start in range(0, x.size, _POINTS):
        part = slice(start, start + _POINTS)
        half = discriminant(f, x[part] + np.square(k[part]), y[part], k[part])
        value[part], error[part] = half.value, half.error
    sign = 1.0 if n % 2 == 0 else -1.0
    return (sign * value - np.exp(-2.0 * np.pi * k)).reshape(shape), error.reshape(shape)


def _exponent(excess: Array, drag: Array | float = 0.0) -> tuple[Array, Array]:
    """Return ``arccosh(1 + x) / (2 pi)`` from ``excess = x exp(-2 pi drag)``, and its steepness."""
    # Without cancellation, and without overflow; its derivative to the excess is 1 over 2 pi times
    # the steepness.
    unit = np.exp(-2.0 * np.pi * np.asarray(drag))
    root = np.sqrt(excess) * np.sqrt(2.0 * unit + excess)
    rest = np.maximum(unit + excess + root, np.finfo(float).tiny)
    growth = np.where(unit < 1.0, np.log(rest), np.log1p(excess + root))
    return np.asarray(drag + growth / (2.0 * np.pi)), root


def _narrow(f: PeriodicFunction | Meissner, n: int, mu: Array, sharp: Ends) -> Array:
    """Return K, the lam2 of the largest half trace and the error of K for narrow regions."""
    # |D| - 1 = (lam2 - low)(high - lam2) g with g smooth across the region: g comes from points
    # well outside, where nothing cancels, and the width from the two ends.
    low, high, slack = sharp
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    lam2 = centre + _RESOLVED * nodes(_NODES)[:, None]
    value, error = _excess(f, n, lam2, mu)
    product = (lam2 - low) * (high - lam2)
    c = analysis(_NODES) @ (value / product)
    tail = np.abs(c[-2:]).sum(axis=0) + np.max(np.abs(error / product), axis=0)
    slope = series.chebder(c)
    place = np.zeros_like(centre)
    for _ in range(6):
        x = place * half / _RESOLVED
        g, rise = _at(c, x), _at(slope, x) / _RESOLVED
        place = 0.5 * (1.0 - place * place) * half * rise / g
    g = np.maximum(_at(c, place * half / _RESOLVED), 0.0)
    k, _ = _exponent(half * half * (1.0 - place * place) * g)
    rate = np.sqrt(2.0 * g) / (2.0 * np.pi)
    doubt = rate * slack + 0.5 * k * tail / np.maximum(g, EPS) + 4.0 * EPS * k
    return np.stack([k, centre + place * half, doubt])


def _wide(f: PeriodicFunction | Meissner, n: int, mu: Array, sharp: Ends) -> Array:
    """Do the same for wide regions: the half trace is interpolated across the region itself."""
    centre, half = 0.5 * (sharp[0] + sharp[1]), 0.5 * (sharp[1] - sharp[0])
    count, out = _NODES, np.empty((3, mu.size))
    growth = growth_rate(f, centre, mu)
    drag = np.where(growth > _GROWTH, growth, 0.0)
    left = np.arange(mu.size)
    while left.size:
        m, h = centre[left], half[left]
        value, error = _excess(f, n, m + h * nodes(count)[:, None], mu[left], drag[left])
        c = analysis(count) @ value
        tail, most = np.abs(c[-2:]).sum(axis=0), np.abs(value).max(axis=0)
        done = (tail <= 1e-13 * most + error.max(axis=0)) | (count >= _MOST_NODES)
        if done.any():
            place, x = _summit(c[:, done])
            doubt = tail[done] + error[:, done].max(axis=0) + 4.0 * EPS * most[done]
            k, steep = _exponent(x, drag[left[done]])
            reply = doubt / np.maximum(2.0 * np.pi * steep, EPS)
            out[:, left[done]] = k, m[done] + h[done] * place, reply + 4.0 * EPS * k
        left, count = left[~done], 2 * count
    return out


def _at(c: NDArray[Any], x: Array) -> Array:
    """Evaluate one Chebyshev series per point."""
    return np.asarray(series.chebval(x, c, tensor=False))


def _summit(c: Array) -> tuple[Array, Array]:
    """Return place and value, not below 0, of the one maximum of each series on [-1, 1]."""
    slope, last = series.chebder(c), np.ones(c.shape[1])

    def rise(which: Index, x: Array) -> tuple[Array, float]:
        return _at(slope[:, which], x), 0.0

    place = bracketed_roots(rise, -last, last)[0]
    return place, np.maximum(_at(c, place), 0.0)
