"""Strutt charts: where y'' + 2 K y' + (d + eps f(2 t)) y = 0 is stable; Mathieu's equation first.

With theta = 2 t this is Hill's equation with lam2 = d / 4, mu = eps / 4 and damping K / 2; the
period pi of f(2 t) becomes 2 pi, and the monodromy matrix over it has the same multipliers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, pi, sqrt
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import bad
from ...inputs import is_whole
from ...results import Check, Result, provenance
from ...series.periodic import PeriodicFunction
from ..exact.matrix import hill_boundaries
from ..half_trace import HalfTrace, check_function, discriminant, discriminant_grid, finite
from ..transfer import EPS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Which = Literal["first", "second"]

COSINE = PeriodicFunction(a=[0.0, 1.0])
_UNSTABLE, _LINE = "#b9c4d0", "#1f3f5f"
_SECTIONS, _ROUNDS, _NEAR_TIP = 33, 6, 40
# Points so near to a boundary are on neither side of it.
_BESIDE = 1e-9


@dataclass(frozen=True, kw_only=True)
class StruttChart(Result):
    """Stability over the plane of d and eps, with the exact boundaries.

    Attributes
    ----------
    half_trace : ndarray, shape (n, m)
        Half trace of the monodromy matrix over the period pi of the coefficient.
    error : ndarray, shape (n, m)
        Estimate of its absolute error.
    d, eps : ndarray, shape (n,) and (m,)
        The grid.
    damping : float
        K of 2 K y'.
    regions : tuple of int
        Numbers of the unstable regions that reach into the chart; region i starts at d = i^2.
    lower, upper : ndarray, shape (len(regions), k)
        Their ends in d; -inf below region 0, NaN where damping has closed one.
    boundary_error : ndarray, shape (len(regions), k)
        Estimate of the absolute error of either end.
    boundary_eps : ndarray, shape (k,)
        Values of eps of the boundaries: those of the grid, and closer ones at blunted tips.
    """

    half_trace: Array = field(repr=False)
    d: Array = field(repr=False)
    eps: Array = field(repr=False)
    damping: float
    regions: tuple[int, ...]
    lower: Array = field(repr=False)
    upper: Array = field(repr=False)
    boundary_error: Array = field(repr=False)
    boundary_eps: Array = field(repr=False)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "half_trace": ("d", "eps"),
        "error": ("d", "eps"),
        "stable": ("d", "eps"),
        "d": ("d",),
        "eps": ("eps",),
        "regions": ("region",),
        "lower": ("region", "boundary_eps"),
        "upper": ("region", "boundary_eps"),
        "boundary_error": ("region", "boundary_eps"),
        "boundary_eps": ("boundary_eps",),
    }
    exported: ClassVar[tuple[str, ...]] = ("stable",)

    @property
    def level(self) -> float:
        """Half trace at which a multiplier is 1 (and, with a minus sign, -1)."""
        return _level(self.damping)

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where the motion is stable, shape (n, m)."""
        return np.asarray(np.abs(self.half_trace) < self.level)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the unstable regions over (d, eps) between their exact boundaries."""
        from ...plotting import axes_or_new

        ax = axes_or_new(ax)
        lowest = float(self.d[0])
        for low, high in zip(self.lower, self.upper, strict=True):
            open_ = np.isfinite(high)
            eps = self.boundary_eps[open_]
            left, right = np.maximum(low[open_], lowest), np.maximum(high[open_], lowest)
            ax.fill_betweenx(eps, left, right, color=_UNSTABLE, lw=0)
            outline = np.concatenate([low[open_][::-1], high[open_]])
            ax.plot(outline, np.concatenate([eps[::-1], eps]), color=_LINE, lw=0.9)
        ax.set_xlim(lowest, float(self.d[-1]))
        ax.set_ylim(float(self.eps[0]), float(self.eps[-1]))
        ax.set_xlabel("d")
        ax.set_ylabel("ε")
        ax.grid(visible=False)
        return ax


def strutt_chart(
    damping: float = 0.0,
    d_range: tuple[float, float] = (-2.0, 20.0),
    eps_range: tuple[float, float] = (0.0, 20.0),
    points: tuple[int, int] = (221, 201),
    function: PeriodicFunction | None = None,
) -> StruttChart:
    """Return the stability chart of y'' + 2 K y' + (d + eps f(2 t)) y = 0.

    Parameters
    ----------
    damping : float
        K, at least zero.
    d_range, eps_range : tuple of float
        Ends of the chart, each the lower one first.
    points : tuple of int
        Points of the grid in d and in eps, at least 2 each.
    function : PeriodicFunction, optional
        f; by default the cosine, which makes it Mathieu's equation.

    Returns
    -------
    StruttChart
        Its checks: the determinants, and that the signs of the grid and the boundaries, found by
        two methods, tell the same of every point.

    Raises
    ------
    BadInput
        If a range is empty or not finite, K is negative, or there are fewer than 2 points.

    Notes
    -----
    Aannaque 7.2.3 and Fig. E.3.
    """
    f = COSINE if function is None else function
    check_function(f)
    d, eps = (
        np.linspace(*_range(name, ends), _count(name, count))
        for name, ends, count in zip(("d", "eps"), (d_range, eps_range), points, strict=True)
    )
    k = _damping(damping)
    half = discriminant_grid(f, 0.25 * d, 0.25 * eps, 0.5 * k)
    numbers = _reaching(f, d, eps)
    lines = _with_tips(f, eps, numbers, k) if k else eps
    found = hill_boundaries(f, 0.25 * lines, numbers, damping=0.5 * k)
    lower, upper, error = 4.0 * found.lower, 4.0 * found.upper, 4.0 * found.error
    seen = np.any(np.isfinite(upper) & (upper >= d[0]) & (lower <= d[-1]), axis=1)
    kept = tuple(n for n, shown in zip(numbers, seen, strict=True) if shown)
    place = np.searchsorted(lines, eps)
    apart = _contradictions(half, d, lower[:, place], upper[:, place], error[:, place], _level(k))
    return StruttChart(
        method="half trace on a grid; boundaries from the Hill matrix",
        error=half.error,
        error_norm="absolute, entrywise, of the half trace",
        checks={**half.checks, "points on the wrong side of a boundary": Check(apart, 0.0)},
        provenance=provenance(),
        half_trace=half.value,
        d=d,
        eps=eps,
        damping=k,
        regions=kept,
        lower=lower[seen],
        upper=upper[seen],
        boundary_error=error[seen],
        boundary_eps=lines,
    )


def _level(damping: float) -> float:
    return float(0.5 * (1.0 + np.exp(-2.0 * pi * damping)))


def _range(name: str, ends: ArrayLike) -> tuple[float, float]:
    found = finite(f"{name}_range", ends)
    if found.shape != (2,) or not found[0] < found[1]:
        raise bad(f"{name}_range", ends, "two numbers, the lower one first", "correct it")
    return float(found[0]), float(found[1])


def _count(name: str, count: object) -> int:
    if not is_whole(count, 2):
        raise bad("points", f"{count!r} in {name}", "whole numbers from 2", "for example 201")
    return int(count)


def _damping(damping: float) -> float:
    k = finite("damping", damping)
    if k.ndim or k < 0.0:
        raise bad("damping", damping, "one number K >= 0", "damping takes energy out")
    return float(k)


def _reaching(f: PeriodicFunction, d: Array, eps: Array) -> tuple[int, ...]:
    """Return the regions whose ends may lie left of the chart's right edge."""
    farthest = float(d[-1]) + float(np.abs(eps).max()) * f.bound()
    return tuple(range(ceil(sqrt(max(farthest, 0.0))) + 2))


def _with_tips(f: PeriodicFunction, eps: Array, regions: Sequence[int], k: float) -> Array:
    """Return eps with more values just above the tips that damping has blunted."""
    more = [eps]
    for n in regions:
        found = hill_boundaries(f, 0.25 * eps, (n,), damping=0.5 * k).upper[0]
        open_ = np.isfinite(found)
        changes = np.flatnonzero(open_[1:] != open_[:-1])
        for j in changes:
            inner, outer = (eps[j + 1], eps[j]) if open_[j + 1] else (eps[j], eps[j + 1])
            tip = _tip(f, n, k, float(outer), float(inner))
            more.append(tip + (inner - tip) * np.linspace(0.0, 1.0, _NEAR_TIP) ** 2)
    return np.unique(np.concatenate(more))


def _tip(f: PeriodicFunction, n: int, k: float, outer: float, inner: float) -> float:
    """Return the eps nearest to ``outer``, where the region is closed, at which it is open."""
    for _ in range(_ROUNDS):
        between = np.linspace(outer, inner, _SECTIONS)
        open_ = np.isfinite(hill_boundaries(f, 0.25 * between, (n,), damping=0.5 * k).upper[0])
        first = max(int(np.argmax(open_)), 1)
        outer, inner = float(between[first - 1]), float(between[first])
    return inner


def _contradictions(
    half: HalfTrace, d: Array, lower: Array, upper: Array, error: Array, level: float
) -> float:
    """Count the points that half trace and boundaries put on different sides."""
    place = d[:, None]
    inside = np.zeros(half.value.shape, dtype=bool)
    beside = np.zeros_like(inside)
    for low, high, own in zip(lower, upper, error, strict=True):
        near = np.nan_to_num(own) + _BESIDE * (1.0 + np.abs(place))
        with np.errstate(invalid="ignore"):
            inside |= (place > low) & (place < high)
            beside |= (np.abs(place - low) < near) | (np.abs(place - high) < near)
    gap = np.abs(half.value) - level
    clear = ~beside & (np.abs(gap) > half.error)
    return float(np.count_nonzero(clear & (inside != (gap > 0.0))))


# ---------------------------------------------------------------- the multipliers' surfaces


@dataclass(frozen=True, kw_only=True)
class MultiplierSurfaces(Result):
    """Both multipliers over the plane of d and eps.

    Attributes
    ----------
    first, second : ndarray of complex, shape (n, m)
        Multipliers over the period pi: the first has the larger modulus or, of a pair on one
        circle, the positive imaginary part.
    error, second_error : ndarray, shape (n, m)
        Estimates of the absolute errors of either; next to a boundary they grow as a square root.
    d, eps : ndarray, shape (n, m)
        The parameters.
    damping : float
        K of 2 K y'.
    """

    first: NDArray[np.complex128] = field(repr=False)
    second: NDArray[np.complex128] = field(repr=False)
    second_error: Array = field(repr=False)
    d: Array = field(repr=False)
    eps: Array = field(repr=False)
    damping: float

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "first": ("d", "eps"),
        "second": ("d", "eps"),
        "error": ("d", "eps"),
        "second_error": ("d", "eps"),
        "d": ("d", "eps"),
        "eps": ("d", "eps"),
    }

    def plot(
        self,
        ax: Axes | None = None,
        which: Which = "first",
        limits: tuple[float, float] = (-1.0, 1.0),
    ) -> Axes:
        """Draw the real part of one multiplier as a surface, cut off at ``limits``.

        Parameters
        ----------
        ax : Axes, optional
            With three dimensions; a new one by default.
        which : {"first", "second"}
            Which multiplier.
        limits : tuple of float
            Ends of the vertical axis; values beyond are drawn at the ends.

        Raises
        ------
        BadInput
            If the axes are flat, or ``which`` is neither.
        """
        from matplotlib import colormaps

        from ...plotting import new_figure

        if which not in ("first", "second"):
            raise bad("which", repr(which), "'first' or 'second'", "correct it")
        if ax is None:
            ax = new_figure().add_subplot(projection="3d")
        space: Any = ax
        if not hasattr(space, "plot_surface"):
            raise bad("ax", "flat axes", "axes of three dimensions", "use projection='3d'")
        height = np.clip((self.first if which == "first" else self.second).real, *limits)
        share = (height[1:, 1:] + height[:-1, :-1] - 2.0 * limits[0]) / np.ptp(limits) / 2.0
        faces = colormaps["cividis"](0.15 + 0.8 * share)
        faces[..., :3] *= _light(self.d, self.eps, height)[..., None]
        drawn = space.plot_surface(
            self.d,
            self.eps,
            height,
            rstride=1,
            cstride=1,
            facecolors=faces,
            shade=False,
            linewidth=0.0,
            antialiased=False,
        )
        # By the nearest corner: thin ridges then hide what is behind them.
        drawn.set_zsort("max")
        space.set_zlim(*limits)
        space.set_xlabel("d")
        space.set_ylabel("ε")
        space.set_zlabel("real part")
        return ax


def _light(d: Array, eps: Array, height: Array) -> Array:
    """Return how bright each face of a surface is, lit from the front left and above."""
    place = np.stack([values / max(float(np.ptp(values)), 1e-300) for values in (d, eps, height)])
    place[2] *= 0.5
    along = place[:, 1:, 1:] - place[:, :-1, 1:]
    across = place[:, 1:, 1:] - place[:, 1:, :-1]
    normal = np.cross(along, across, axis=0)
    size = np.maximum(np.linalg.norm(normal, axis=0), 1e-300)
    upright = np.abs(normal[2]) / size
    facing = np.where(normal[2] < 0.0, -1.0, 1.0) * (0.7 * normal[0] - 0.5 * normal[1]) / size
    return np.asarray(np.clip(0.68 + 0.22 * upright + 0.25 * facing, 0.45, 1.0))


def multiplier_surfaces(
    d: ArrayLike,
    eps: ArrayLike,
    damping: float = 0.0,
    function: PeriodicFunction | None = None,
) -> MultiplierSurfaces:
    """Return both multipliers of y'' + 2 K y' + (d + eps f(2 t)) y = 0 over a grid.

    Parameters
    ----------
    d, eps : array_like, shape (n,) and (m,), or both (n, m)
        Values of the parameters: all pairs of two lines, or a grid such as
        :func:`boundary_fitted_grid` gives.
    damping : float
        K, at least zero.
    function : PeriodicFunction, optional
        f; by default the cosine.

    Raises
    ------
    BadInput
        If an argument is not finite, the shapes are others, or K is negative.

    Notes
    -----
    Aannaque 7.2.3, Figs. E.1 and E.2: eigenvalues of the monodromy matrix over the period pi.
    """
    f = COSINE if function is None else function
    check_function(f)
    k = _damping(damping)
    across, along = finite("d", d), finite("eps", eps)
    if across.ndim == along.ndim == 1:
        across, along = across[:, None], along[None, :]
    elif across.ndim != 2 or across.shape != along.shape:
        shapes = f"shapes {across.shape} and {along.shape}"
        raise bad("d, eps", shapes, "two lines, or two grids of one shape", "reshape them")
    half = discriminant(f, 0.25 * across, 0.25 * along, 0.5 * k)
    across, along = np.broadcast_arrays(across, along)
    first, second, errors = _multipliers(half.value, half.error, float(np.exp(-2.0 * pi * k)))
    return MultiplierSurfaces(
        method="half trace on a grid",
        error=errors[0],
        error_norm="absolute, entrywise, of the first multiplier",
        checks=half.checks,
        provenance=provenance(),
        first=first,
        second=second,
        second_error=errors[1],
        d=across,
        eps=along,
        damping=k,
    )


def boundary_fitted_grid(
    d_range: tuple[float, float],
    eps: ArrayLike,
    damping: float = 0.0,
    function: PeriodicFunction | None = None,
    per_band: int = 20,
) -> tuple[Array, Array]:
    """Return a grid over (d, eps) that follows the lines on which both multipliers meet.

    Surfaces of multipliers have their kinks there; on this grid they are drawn sharp.

    Parameters
    ----------
    d_range : tuple of float
        Ends of d, the lower one first.
    eps : array_like, shape (m,)
        Values of eps.
    damping : float
        K, at least zero: the lines lie K^2 above the boundaries without damping.
    function : PeriodicFunction, optional
        f; by default the cosine.
    per_band : int
        Steps across each band, from 2.

    Returns
    -------
    d, eps : ndarray, shape (n, m)

    Raises
    ------
    BadInput
        If an argument is not finite or of the wrong shape, or K is negative.
    """
    f = COSINE if function is None else function
    check_function(f)
    low, high = _range("d", d_range)
    along, k, steps = finite("eps", eps), _damping(damping), _count("per_band", per_band)
    if along.ndim != 1 or along.size == 0:
        raise bad("eps", f"shape {along.shape}", "a line of values", "pass a flat sequence")
    numbers = _reaching(f, np.array([high]), along)
    found = hill_boundaries(f, 0.25 * along, numbers)
    lines = np.sort(np.concatenate([found.lower[1:], found.upper]), axis=0)
    edges = np.clip(4.0 * lines + k * k, low, high)
    ends = np.full((1, along.size), low), np.full((1, along.size), high)
    edges = np.concatenate([ends[0], edges, ends[1]])
    # Closer at the lines, where the multipliers change as a root.
    share = 0.5 - 0.5 * np.cos(pi * np.arange(steps) / steps)
    bands = [
        first + share[:, None] * (last - first)
        for first, last in pairwise(edges)
        if np.any(last > first)
    ]
    grid = np.concatenate([*bands, ends[1]])
    return grid, np.broadcast_to(along, grid.shape)


def _multipliers(
    half: Array, error: Array, product: float
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], tuple[Array, Array]]:
    """Return the roots of ``rho^2 - 2 half rho + product = 0`` and their errors."""
    edge = sqrt(product)
    square = (np.abs(half) - edge) * (np.abs(half) + edge)
    root = np.sqrt(np.abs(square))
    noise = (2.0 * np.abs(half) + error) * error + EPS * product
    # At a boundary the root is known to the square root of the noise alone.
    moved = error + np.minimum(np.sqrt(noise), noise / np.maximum(root, 1e-300))
    real = square >= 0.0
    sign = np.where(half < 0.0, -1.0, 1.0)
    large = half + sign * root
    first = np.where(real, large, half) + 1j * np.where(real, 0.0, root)
    small = product / np.where(real, large, 1.0)
    second = np.where(real, small, half) - 1j * np.where(real, 0.0, root)
    share = np.where(real, np.abs(small) / np.maximum(np.abs(large), 1e-300), 1.0)
    return first, second, (moved, moved * share + EPS * np.abs(second))
