"""Half trace of Hill's equation with damping, y'' + 2 K y' + (lam2 + mu f(theta)) y = 0.

With y = exp(-K theta) u the equation becomes u'' + (lam2 - K^2 + mu f) u = 0 (Smith (7.39),
(7.40)); the half trace of the damped monodromy matrix over 2 pi is exp(-2 pi K) times that of the
undamped one.  The half trace is an entire function of (lam2, mu): where many points are wanted it
is sampled at few Chebyshev nodes and interpolated, the tail of the coefficients checked.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log, pi, sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core import chebyshev
from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from .checks import EPS, Array, Mask, arguments, check_function
from .meissner import Meissner
from .transfer import Transfer, transfer

Box = tuple[float, float, float, float]

# Up to so many points direct evaluation is as fast as interpolation, and its error is entrywise.
_DIRECT_GRID, _DIRECT_POINTS = 2048, 8192
# A box is split where the solutions' growth varies more than this over it, or where it would need
# more nodes in one direction.
_GROWTH, _MOST_NODES = 1e2, 768


@dataclass(frozen=True, kw_only=True)
class HalfTrace(Result):
    """Half trace of the monodromy matrix over one turn of the damped equation.

    Attributes
    ----------
    value : ndarray
        ``(y1(2 pi) + y2'(2 pi)) / 2``, Smith's X of (7.9), in the broadcast shape of the
        arguments; infinite where it exceeds the range of doubles, which fails a check.
    error : ndarray
        Estimate of the absolute error of each entry.
    damping : ndarray
        K, in a shape that broadcasts to that of ``value``.
    lam2, mu : ndarray
        The parameters, likewise.
    """

    value: Array
    damping: Array
    lam2: Array
    mu: Array

    arrays_along: ClassVar = {"...": "value error damping lam2 mu level stable"}
    exported: ClassVar[tuple[str, ...]] = ("level", "stable")

    @property
    def level(self) -> Array:
        """Boundary level ``(1 + exp(-4 pi K)) / 2``: the motion is stable while ``|value|`` < it.

        It is ``exp(-2 pi K) cosh(2 pi K)``: the level cosh(2 pi K) of the undamped half trace.
        """
        return np.asarray(0.5 * (1.0 + np.exp(-4.0 * pi * self.damping)))

    @property
    def stable(self) -> Mask:
        """True where both multipliers lie inside the unit circle (on it, when undamped)."""
        return np.asarray(np.abs(self.value) < self.level)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the unstable part of a grid, or draw the half trace along a line.

        Raises ``BadInput`` if the values are neither a grid of lam2 by mu nor a line.
        """
        ax = axes_or_new(ax)
        lam2, mu = np.squeeze(self.lam2), np.squeeze(self.mu)
        if self.value.ndim == 2 and lam2.ndim == mu.ndim == 1:
            shown = self.value if lam2.size == self.value.shape[0] else self.value.T
            excess = np.abs(shown) - self.level
            ax.contourf(lam2, mu, excess.T, levels=[0.0, np.inf], colors=["0.8"])
            ax.set(xlabel=r"$\lambda^2$", ylabel=r"$\mu$")
            return ax
        if self.value.ndim == 1:
            across, label = (lam2, r"$\lambda^2$") if lam2.ndim == 1 else (mu, r"$\mu$")
            ax.plot(across, self.value)
            ax.set(xlabel=label, ylabel="half trace")
            return ax
        found = f"values of shape {self.value.shape}"
        raise bad("HalfTrace.plot", found, "a line or a grid", "slice it")


def discriminant(
    f: PeriodicFunction | Meissner, lam2: ArrayLike, mu: ArrayLike, damping: ArrayLike = 0.0
) -> HalfTrace:
    """Return the half trace of the monodromy matrix of y'' + 2 K y' + (lam2 + mu f) y = 0.

    The motion is stable where ``|value| < (1 + exp(-4 pi K)) / 2`` (undamped: 1); multiplier +1
    at the positive, -1 at the negative level.

    Parameters
    ----------
    f : PeriodicFunction or Meissner
        Coefficient of period 2 pi.
    lam2, mu : array_like
        Parameters; any sign, any shapes that broadcast.  Arrays that vary along different axes,
        such as ``(n, 1)`` and ``(1, m)``, are evaluated as a grid by two matrix products.
    damping : array_like
        K of Smith (7.38), at least zero; broadcasts with the others.

    Returns
    -------
    HalfTrace
        ``value`` and ``error`` (absolute, entrywise estimate) in the broadcast shape.

    Raises
    ------
    BadInput
        If an argument is not finite, shapes do not broadcast, K is negative, or ``lam2 + mu f``
        is so large that more than 65536 segments would be needed.

    Notes
    -----
    Smith (7.9), (7.38)-(7.40).  The error estimate holds round-off (amplified by the norm of the
    monodromy matrices round the circle), the truncation of the transfer polynomials, the tail of
    the Chebyshev series and the error of ``f``.

    Examples
    --------
    >>> import elastolink as el
    >>> cosine = el.PeriodicFunction(a=[0.0, 1.0])
    >>> trace = el.discriminant(cosine, lam2=[0.25, 0.6], mu=0.1)
    >>> print(trace.value.round(4), trace.stable)
    [-1.0493  0.1397] [False  True]
    """
    method = "exact matrices of intervals"
    if not isinstance(f, Meissner):
        check_function(f)
        method = "transfer polynomials"
    (lam, amp, k), shape = arguments(lam2=lam2, mu=mu, damping=damping)
    x, y, log2_scale = (
        _collapsed(np.array(item, ndmin=len(shape)))
        for item in (lam - k * k, amp, k * (-2.0 * pi / log(2.0)))
    )
    x, log2_scale = np.broadcast_arrays(x, log2_scale)
    if all(min(n, m) == 1 for n, m in zip(x.shape, y.shape, strict=True)):
        work = _Work(f, grid=True)
        pairs = work.values(x.ravel(), y.ravel(), log2_scale.ravel())
        # Where the values of all pairs stand in the shape of the arguments.
        at = np.arange(x.size).reshape(x.shape), np.arange(y.size).reshape(y.shape)
        value, error = (np.broadcast_to(item[at], shape) for item in pairs)
    else:
        work = _Work(f, grid=False)
        x, y, log2_scale = (np.broadcast_to(v, shape).ravel() for v in (x, y, log2_scale))
        value, error = (item.reshape(shape) for item in work.values(x, y, log2_scale))
    beyond = float(value.size - np.count_nonzero(np.isfinite(value)))
    return HalfTrace(
        method=method + (" at Chebyshev nodes, interpolated" if work.interpolated else ""),
        error=error,
        error_norm="absolute, entrywise",
        checks={
            "determinant": Check(work.defect, 1e-10),
            "entries beyond the range of doubles": Check(beyond, 0.0),
        },
        provenance=provenance(),
        value=value,
        damping=k,
        lam2=lam,
        mu=amp,
    )


def growth_rate(f: PeriodicFunction | Meissner, lam2: Array, mu: Array) -> Array:
    """Return the mean of ``sqrt(-(lam2 + mu f))`` where that is real: how fast solutions grow."""
    values = f(2.0 * pi * np.arange(1024) / 1024)
    negative = np.maximum(-(lam2[..., None] + mu[..., None] * values), 0.0)
    return np.asarray(np.sqrt(negative).mean(axis=-1))


class _Work:
    """One evaluation at points or on a grid, cut into boxes that a Chebyshev series can serve."""

    def __init__(self, f: PeriodicFunction | Meissner, grid: bool) -> None:
        self.f, self.grid = f, grid
        self.defect, self.interpolated = 0.0, False

    def values(self, x: Array, y: Array, log2_scale: Array) -> tuple[Array, Array]:
        """Return value and error: shape ``(nx, ny)`` on a grid, ``(n,)`` at points."""
        shape = (x.size, y.size) if self.grid else x.shape
        if 0 in shape:
            return np.zeros(shape), np.zeros(shape)
        found = self._box(x, y, log2_scale)
        if not isinstance(found, int):
            return found
        along = y if found else x
        lower = along <= 0.5 * (along.min() + along.max())
        if lower.all():
            lower = np.arange(along.size) < along.size // 2
        value, error = np.empty((2, *shape))
        whole = slice(None)
        for half in (lower, ~lower):
            rows, columns = half, half
            if self.grid:
                rows, columns = (whole, half) if found else (half, whole)
            where = (rows, columns) if self.grid else half
            value[where], error[where] = self.values(x[rows], y[columns], log2_scale[rows])
        return value, error

    def _box(self, x: Array, y: Array, scale: Array) -> tuple[Array, Array] | int:
        """Evaluate one box; the axis along which it should be split where it cannot be."""
        count = x.size * y.size if self.grid else x.size
        if isinstance(self.f, Meissner):
            return self._direct(self.f, x, y, scale)
        limits = float(x.min()), float(x.max()), float(y.min()), float(y.max())
        direct = transfer(self.f, limits[:2], limits[2:])
        # Wide boxes cost digits: terms of the polynomials grow with the distance from the middle.
        if sum(direct.spread) > 200.0:
            return int(direct.spread[1] > direct.spread[0])
        few = _DIRECT_GRID if self.grid else _DIRECT_POINTS
        if count <= few or direct.floor < -1e3:
            return self._direct(direct, x, y, scale)
        series = _series(direct, limits)
        if isinstance(series, int):
            return series
        coefficients, everywhere, profile, defect = series
        self.interpolated = True
        self.defect = max(self.defect, defect)
        u, v = chebyshev.unit(x, *limits[:2]), chebyshev.unit(y, *limits[2:])
        error = np.interp(u, chebyshev.nodes(profile.size)[::-1], profile[::-1]) + everywhere
        if self.grid:
            value = chebyshev.tensor_values(coefficients, u, v)
            error, scale = error[:, None], scale[:, None]
        else:
            value = chebyshev.point_values(coefficients, u, v)
        if scale.any():
            factor = np.exp2(scale)
            value, error = value * factor, error * factor
        return value, np.broadcast_to(error, value.shape)

    def _direct(
        self, polynomials: Transfer | Meissner, x: Array, y: Array, scale: Array
    ) -> tuple[Array, Array]:
        shape = (x.size, y.size) if self.grid else x.shape
        if self.grid:
            x, y, scale = np.repeat(x, y.size), np.tile(y, x.size), np.repeat(scale, y.size)
        value, error, exponent, defect = polynomials.half_trace_with_error(x, y)
        self.defect = max(self.defect, float(defect.max()))
        whole = np.rint(scale)
        # Beyond this there is nothing but 0 and infinity.
        power = exponent + np.maximum(whole, -(2.0**40)).astype(np.int64)
        with np.errstate(over="ignore", under="ignore"):
            value = np.ldexp(value * np.exp2(scale - whole), power)
            error = np.ldexp(error * np.exp2(scale - whole), power)
        return value.reshape(shape), error.reshape(shape)


def _series(polynomials: Transfer, limits: Box) -> tuple[Array, float, Array, float] | int:
    """Interpolate over a box; the number of the axis to split where that would not do.

    Return the coefficients of the double Chebyshev series; its error, which depends on lam2 alone,
    as what it is everywhere and a profile over the nodes; and the defect of determinants.
    """
    x0, x1, y0, y1 = limits
    n = _guess(x1 - x0, x0) if x1 > x0 else 1
    m = _guess(polynomials.swing, 0.0) if y1 > y0 else 1
    # The edges show how fast the half trace grows, how many nodes it needs, and its errors.
    while True:
        x, y = _nodes((x0, x1), n), _nodes((y0, y1), m)
        points_x = np.concatenate([x, x, np.full(m, x0), np.full(m, x1)])
        points_y = np.concatenate([np.full(n, y0), np.full(n, y1), y, y])
        value, error, _, defect = polynomials.half_trace_with_error(points_x, points_y)
        lines = [value[: 2 * n].reshape(2, n), value[2 * n :].reshape(2, m)]
        size = [np.maximum(1.0, np.abs(line)) for line in lines]
        growth = [float((s.max(axis=1) / s.min(axis=1)).max()) for s in size]
        if max(growth) > _GROWTH:
            return int(growth[1] > growth[0])
        largest, noise = float(max(s.max() for s in size)), float(error.max())
        spectra = [np.abs(line @ chebyshev.analysis(line.shape[1]).T).max(axis=0) for line in lines]
        tolerance = max(2.0 * EPS * largest, 0.05 * noise)
        needed = [chebyshev.length(sizes, tolerance) for sizes in spectra]
        short = [count > 1 and need > count - 3 for count, need in zip((n, m), needed, strict=True)]
        if not any(short):
            break
        n, m = (2 * n if short[0] else n), (2 * m if short[1] else m)
        if max(n, m) > _MOST_NODES:
            return int(m > n)
    profile = np.pad(error[: 2 * n].reshape(2, n).max(axis=0), 1, mode="edge")
    profile = 1.5 * np.maximum(np.maximum(profile[:-2], profile[2:]), profile[1:-1])
    rounding = max(4.0 * EPS * largest, 0.1 * noise)
    # The last two of some more nodes show whether the inside needs more than the edges.
    for more in (2, 16, 48):
        rows, columns = (
            need + more if k > 1 else 1 for need, k in zip(needed, (n, m), strict=True)
        )
        x, y = _nodes((x0, x1), rows), _nodes((y0, y1), columns)
        values = polynomials.half_trace(np.repeat(x, columns), np.tile(y, rows))
        over_x, over_y = (chebyshev.analysis(count) for count in (rows, columns))
        c = over_x @ values.reshape(rows, columns) @ over_y.T
        above = max(1.0, float(np.abs(values).max()) / largest)
        sizes = np.abs(c)
        tails = [
            float(sizes[-2:].sum()) if rows > 1 else 0.0,
            float(sizes[:, -2:].sum()) if columns > 1 else 0.0,
        ]
        # Every entry carries round-off: that much of a tail does not show a lack of nodes.
        allowed = 2.0 * rounding * above
        if tails[0] <= allowed * columns and tails[1] <= allowed * rows:
            # Errors of the nodal values stay where they are, but for a few per cent.
            everywhere = sum(tails) + 2.0 * EPS * float(sizes.sum()) + 0.05 * above * noise
            return c, everywhere, above * profile, float(defect.max())
    return 0 if tails[0] > allowed * columns else 1


def _nodes(limits: tuple[float, float], count: int) -> Array:
    low, high = limits
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(count))


def _guess(span: float, low: float) -> int:
    """Guess how many nodes an axis needs; only the time depends on it."""
    start = sqrt(max(low, 0.0))
    half_phase = pi * (sqrt(start * start + span) - start)
    return min(16 * ceil((1.4 * half_phase + 14.0) / 16.0), _MOST_NODES)


def _collapsed(values: Array) -> Array:
    """Cut every axis along which an array does not vary to length 1."""
    for axis, count in enumerate(values.shape):
        if count > 1 and np.all(values == (first := values.take([0], axis=axis))):
            values = first
    return values
