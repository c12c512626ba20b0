"""Stability charts: sample the entire functions that decide stability, interpolate spectrally."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from ..families import Array, LinearPeriodic
from ..floquet.monodromy_matrix import monodromy
from ..hill.form import hill_form, is_hill, plain_axes
from ..hill.half_trace import discriminant_grid
from ..results import Check, Result
from ..series import chebyshev
from .boundaries import BoundaryCurves, boundary_curves
from .invariants import characteristic, half_traces, largest_modulus

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Axis = tuple[str, ArrayLike]
_TOLERANCE = 1e-11
_FIRST, _MOST = 16, 512


@dataclass(frozen=True, kw_only=True)
class StabilityChart(Result):
    """Stable and unstable regions over two parameters.

    Attributes
    ----------
    x_name, y_name : str
        ``"speed"`` [rad/s] or a parameter of the system.
    x, y : ndarray, shapes (nx,), (ny,)
        Values along the axes.
    invariants : ndarray, shape (ny, nx, k)
        What decides stability: the half trace (one mode), or the coefficients of the reduced
        (undamped) or full characteristic polynomial of the monodromy matrix.
    stable : ndarray of bool, shape (ny, nx)
        True where no multiplier leaves the unit circle.
    largest : ndarray, shape (ny, nx)
        Largest modulus of a multiplier.
    exact, first_order : BoundaryCurves or None
        Boundaries from the Hill matrix, and of first order in the periodic part; one mode only.
    natural_frequency : float
        Lowest natural frequency [rad/s] of the system at rest; NaN where speed is not an axis.
    marks : mapping
        Values along y or x to be marked, by label.
    nodes : tuple of int
        How many Chebyshev nodes were sampled along x and y; (0, 0) where the half trace of one
        function was evaluated by :func:`~.half_trace.discriminant_grid`.
    """

    x_name: str
    y_name: str
    x: Array
    y: Array
    invariants: Array
    stable: NDArray[np.bool_]
    largest: Array
    exact: BoundaryCurves | None = None
    first_order: BoundaryCurves | None = None
    natural_frequency: float = float("nan")
    marks: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    nodes: tuple[int, int] = (0, 0)

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "x": ("x",),
        "y": ("y",),
        "stable": ("y", "x"),
        "largest": ("y", "x"),
        "invariants": ("y", "x", "invariant"),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the unstable regions and draw the boundaries; speeds in rpm."""
        from .picture import draw_chart

        return draw_chart(self, ax)


def stability_chart(
    system: LinearPeriodic,
    x: Axis,
    y: Axis,
    *,
    boundaries: bool = True,
    marks: Mapping[str, Sequence[float]] | None = None,
    rtol: float = _TOLERANCE,
) -> StabilityChart:
    """Return the stability of a system over two parameters.

    The invariants of the monodromy matrix are entire functions of the parameters and of the
    inverse (square of the) speed, so that a few dozen Chebyshev nodes along each axis fix them
    everywhere to near round-off.

    Parameters
    ----------
    system : LinearPeriodic
        Any number of modes, with or without damping.
    x, y : tuple of (str, array_like)
        ``("speed", values)`` in rad/s or ``(parameter, values)`` in SI units; values rise.
    boundaries : bool
        Whether exact and first-order boundaries are computed too; for one mode, where one of the
        axes is the speed or the constant stiffness.
    marks : mapping, optional
        Label to values along y that the plot marks.
    rtol : float
        Wanted error of the invariants, relative to their size where that exceeds 1.

    Returns
    -------
    StabilityChart
        ``error`` is the largest absolute error of an invariant, estimated from the tail of the
        series and the error of the samples.

    Raises
    ------
    BadInput
        If an axis is unknown, empty, not rising, or the speed not positive.
    """
    names, axes = _axes(system, x, y)
    sampler = _Sampler(system, names)
    series = _plain_hill(sampler, axes) or _interpolated(sampler, axes, rtol)
    largest, stable = _verdict(sampler, series.values, names, axes)
    exact, first = None, None
    if boundaries and is_hill(system):
        exact, first = boundary_curves(system, names, axes)
    return StabilityChart(
        method=sampler.method,
        error=series.error,
        error_norm="invariants of the monodromy matrix, largest absolute"
        + (" (half trace)" if sampler.hill else ""),
        checks={"spread of samples at nodes": Check(series.sample_error, max(1e-8, 1e3 * rtol))},
        provenance=system.provenance,
        x_name=names[0],
        y_name=names[1],
        x=axes[0],
        y=axes[1],
        invariants=series.values,
        stable=stable,
        largest=largest,
        exact=exact,
        first_order=first,
        natural_frequency=_natural_frequency(system) if "speed" in names else float("nan"),
        marks={k: tuple(float(v) for v in vs) for k, vs in (marks or {}).items()},
        nodes=series.nodes,
    )


def _axes(system: LinearPeriodic, x: Axis, y: Axis) -> tuple[tuple[str, str], tuple[Array, Array]]:
    known = ["speed", *sorted(system.parameters)]
    found = []
    for label, (name, given) in (("x", x), ("y", y)):
        if name not in known:
            raise bad(f"axis {label}", repr(name), f"one of {known}", "correct the name")
        values = np.asarray(given, dtype=float)
        if values.ndim != 1 or len(values) < 2 or not np.all(np.isfinite(values)):
            raise bad(
                f"axis {label}",
                f"shape {values.shape}",
                "at least two finite values in a line",
                "give a range",
            )
        if np.any(np.diff(values) <= 0):
            raise bad(f"axis {label}", "values that do not rise", "rising values", "sort them")
        if name == "speed" and values[0] <= 0:
            raise bad(f"axis {label}", f"speed {values[0]:g}", "positive speeds", "raise the range")
        found.append(values)
    if x[0] == y[0]:
        raise bad("axis y", repr(y[0]), "another parameter than along x", "choose another")
    return (x[0], y[0]), (found[0], found[1])


class _Sampler:
    """Evaluates the invariants at given points of the transformed axes."""

    def __init__(self, system: LinearPeriodic, names: tuple[str, str]) -> None:
        self.system, self.names = system, names
        damping = system.has("C") and bool(np.any(system.array("C", 0.0)))
        self.damped = damping or "damping" in names
        self.hill = is_hill(system) and not (system.has("Kg") and "speed" in names)
        self.method = "half trace" if self.hill else "characteristic polynomial"
        self.method += " at Chebyshev nodes, spectral interpolation"
        self._form = hill_form(system) if self.hill else None
        self.plain = None if self._form is None or self.damped else plain_axes(self._form, names)

    def transform(self, name: str, values: Array) -> Array:
        """Return the variable in which the invariants are entire."""
        if name != "speed":
            return values
        return np.asarray(1.0 / values if self.damped else 1.0 / values**2)

    def back(self, name: str, values: Array) -> Array:
        """Undo :meth:`transform`."""
        if name != "speed":
            return values
        return np.asarray(1.0 / values if self.damped else 1.0 / np.sqrt(values))

    def __call__(self, x: Array, y: Array) -> tuple[Array, float]:
        """Return invariants ``(k, nx, ny)`` and the largest error of a sample."""
        ax, ay = (self.back(n, v) for n, v in zip(self.names, (x, y), strict=True))
        if self._form is not None:
            # One mode: for each y a function f, and all x at once where x leaves f alone.
            return half_traces(self._form, self.names, ax, ay)
        point: dict[str, Any] = {self.names[0]: ax[:, None], self.names[1]: ay[None, :]}
        speed = point.pop("speed", 1.0)
        result = monodromy(self.system, speed, **point)
        shape = (len(ax), len(ay))
        size = 2 * self.system.size
        matrices = np.broadcast_to(result.matrix, (*shape, size, size))
        values = characteristic(matrices, reduced=not self.damped)
        scale = np.max(np.abs(matrices), axis=(-2, -1)) ** min(2, self.system.size)
        return np.moveaxis(values, -1, 0), float(np.max(result.error * scale) * size)


@dataclass(frozen=True)
class _Series:
    """Invariants on the chart, with their error and that of the samples."""

    values: Array
    error: float
    sample_error: float
    nodes: tuple[int, int]


def _plain_hill(sampler: _Sampler, axes: tuple[Array, Array]) -> _Series | None:
    """Return half traces where the axes are lam2 and the factor of one function, else None."""
    if sampler.plain is None:
        return None
    which, f, lam2, factor = sampler.plain
    order = np.argsort(lam2(axes[which]))
    found = discriminant_grid(f, lam2(axes[which])[order], factor(axes[1 - which]))
    values = np.empty_like(found.value)
    values[order] = found.value
    error = float(np.max(found.error))
    shown = values.T if which == 0 else values
    return _Series(shown[..., None], error, error, (0, 0))


def _interpolated(sampler: _Sampler, axes: tuple[Array, Array], rtol: float) -> _Series:
    """Refine the nodes along each axis until the tails of all series are small.

    How many nodes an axis needs is found on three lines across the chart; then the whole grid is
    sampled once, and again only where that was too few.
    """
    axes = (
        sampler.transform(sampler.names[0], axes[0]),
        sampler.transform(sampler.names[1], axes[1]),
    )
    count = [_counted(sampler, axes, axis, rtol) for axis in (0, 1)]
    while True:
        coefficients, sample_error = _sampled(sampler, axes, count)
        size = max(1.0, max(float(np.max(np.abs(c))) for c in coefficients))
        tails = [_tail(coefficients, axis) for axis in (0, 1)]
        floor = max(rtol * size, sample_error)
        if max(tails) <= floor or max(count) >= _MOST:
            break
        for axis in (0, 1):
            if tails[axis] > floor:
                count[axis] = min(_MOST, count[axis] + count[axis] // 3)
    places = [chebyshev.unit(a, float(a.min()), float(a.max())) for a in axes]
    values = [chebyshev.tensor_values(c, places[0], places[1]).T for c in coefficients]
    error = sum(tails) + sample_error
    return _Series(np.stack(values, axis=-1), error, sample_error / size, (count[0], count[1]))


def _counted(sampler: _Sampler, axes: tuple[Array, Array], axis: int, rtol: float) -> int:
    """Return how many nodes one axis needs, judged on three lines along it."""
    count = _FIRST
    while True:
        trial = [3, 3]
        trial[axis] = count
        coefficients, _ = _sampled(sampler, axes, trial)
        size = max(1.0, max(float(np.max(np.abs(c))) for c in coefficients))
        if _tail(coefficients, axis) <= rtol * size or count >= _MOST:
            return count
        count = min(_MOST, count + max(4, count // 4))


def _sampled(
    sampler: Callable[[Array, Array], tuple[Array, float]],
    axes: Sequence[Array],
    count: Sequence[int],
) -> tuple[list[Array], float]:
    """Return the Chebyshev coefficients of each invariant on a tensor of nodes."""
    points = []
    for number, values in zip(count, axes, strict=True):
        low, high = float(values.min()), float(values.max())
        points.append(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(number))
    samples, error = sampler(points[0], points[1])
    return [chebyshev.coefficients2(values) for values in samples], error


def _tail(coefficients: Sequence[Array], axis: int) -> float:
    """Return the size of the last quarter of the coefficients along an axis."""
    worst = 0.0
    for table in coefficients:
        sizes = np.sum(np.abs(table), axis=1 - axis)
        worst = max(worst, float(np.sum(sizes[-max(2, len(sizes) // 8) :])))
    return worst


def _verdict(
    sampler: _Sampler, values: Array, names: tuple[str, str], axes: tuple[Array, Array]
) -> tuple[Array, NDArray[np.bool_]]:
    if not sampler.hill:
        return largest_modulus(values, reduced=not sampler.damped)
    level = np.ones((len(axes[1]), len(axes[0])))
    if sampler.damped and sampler._form is not None:
        grid = dict(zip(names, (axes[0][None, :], axes[1][:, None]), strict=True))
        speed = np.asarray(grid.pop("speed", 1.0))
        scales = sampler.system.scale_values(**grid)
        total = np.zeros_like(level)
        for term in sampler.system.terms:
            if term.array == "C":
                factor = 1.0 if term.scale is None else scales[term.scale]
                total = total + factor * float(term(np.zeros(1))[0, 0, 0]) / speed
        mass = float(sampler.system.array("M", 0.0)[0, 0, 0])
        level = np.exp(-2 * np.pi * total / mass)
    half = values[..., 0]
    # rho^2 - 2 X rho + W = 0 with W the determinant.
    root = np.sqrt(np.maximum(half**2 - level, 0.0))
    largest = np.maximum(np.abs(half) + root, np.sqrt(level))
    return largest, 2 * np.abs(half) <= 1.0 + level


def _natural_frequency(system: LinearPeriodic) -> float:
    mass = system.array("M", 0.0)[0]
    stiffness = system.array("K", 0.0)[0]
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    return float(np.sqrt(np.min(squares)))
