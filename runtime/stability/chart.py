"""Stability charts: what decides stability over two parameters, boundaries, self-checks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad, refuse
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import (
    is_one_of,
    numbers_in_a_row,
    require_between,
    require_flag,
    require_mapping,
    text_problems,
)
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result
from ..hill.form import is_hill
from ..hill.perturbation import check_order
from ..periodic import floquet_multipliers
from .chart_axes import natural_frequency, on_grid
from .chart_boundaries import BoundaryCurves, boundary_curves
from .chart_lines import Map, Sampler, Series, invariants, relative_error
from .invariants import instability_kind, known_to, largest_modulus, root_uncertainty

Axis = tuple[str, ArrayLike]

# Rows at which regions are traced: each takes a second or so.
_ROWS = 9


@dataclass(frozen=True)
class EdgeCurves:
    """Ends of unstable regions along the speed, at some values of the other axis.

    Attributes
    ----------
    at : ndarray, shape (m,)
        Values of the other axis.
    lower, upper : ndarray, shape (k, m)
        Speeds [rad/s]; NaN where the region is outside the chart or has no such end.
    error : ndarray, shape (k, m)
        Absolute error of either end [rad/s].
    modes : ndarray of int, shape (k, 2)
        The two modes, from 1.
    harmonic : ndarray of int, shape (k,)
        As in :class:`~.edges.StabilityEdges`.
    kind : tuple of str
        ``"principal"``, ``"sum"`` or ``"difference"``.
    check : Check
        Failed self-checks of all rows.
    """

    at: Array
    lower: Array
    upper: Array
    error: Array
    modes: NDArray[np.int64]
    harmonic: NDArray[np.int64]
    kind: tuple[str, ...]
    check: Check


@dataclass(frozen=True, kw_only=True)
class StabilityChart(Result):
    """Stable and unstable regions over two parameters.

    Attributes
    ----------
    x_name, y_name : str
        ``"speed"`` [rad/s], or a parameter or geometry of the system.
    x, y : ndarray, shapes (nx,), (ny,)
        Values along the axes.
    invariants : ndarray, shape (ny, nx, k)
        What decides stability: the half trace (one mode), or the coefficients of the reduced
        (undamped) or full characteristic polynomial of the monodromy matrix.
    stable : ndarray of bool, shape (ny, nx)
        True where no multiplier leaves the unit circle by more than the slack.
    largest : ndarray, shape (ny, nx)
        Largest modulus of a multiplier; infinite where the growth in a turn overflows, such a
        point being unstable, NaN where the matrix is, such a point being undecided.
    slack : ndarray, shape (ny, nx)
        How far a modulus may lie above 1 and still count as stable: what the error of the
        invariants explains.  A resonance that grows less than this in a turn is not seen.  0 for
        several undamped modes where signs prove that all multipliers are on the unit circle.
    undecided : ndarray of bool, shape (ny, nx)
        True where the errors leave open whether the point is stable.
    kind : ndarray of int8, shape (ny, nx)
        How a point is unstable, by its largest multiplier: 1 or -1 where that is real, positive
        or negative (principal regions of even and of odd number, or divergence); 2 where it is
        complex (combination); 0 where stable.
    exact, perturbation : BoundaryCurves or None
        Boundaries from the Hill matrix, and by perturbation to ``order``, NaN where that does not
        converge; one mode only.
    order : int
        Order of ``perturbation`` in the periodic part and the damping.
    edges : EdgeCurves or None
        Regions along the speed, at some rows; several modes, where asked for.
    natural_frequency : float
        Lowest natural frequency [rad/s] of the system at rest; NaN where speed is not an axis or
        the other axis changes the frequency.
    frequency_name : str
        What the plot calls it.
    marks : mapping
        Values along y or x to be marked, by label.
    nodes : tuple of int
        How many Chebyshev nodes were sampled along x and y; 0 along an axis at each of whose
        values the invariants were evaluated.
    speed : float
        Crank speed [rad/s] of all points; NaN where the speed is an axis.
    """

    x_name: str
    y_name: str
    x: Array
    y: Array
    invariants: Array
    stable: NDArray[np.bool_]
    largest: Array
    slack: Array
    undecided: NDArray[np.bool_]
    kind: NDArray[np.int8]
    exact: BoundaryCurves | None = None
    perturbation: BoundaryCurves | None = None
    order: int = 1
    edges: EdgeCurves | None = None
    natural_frequency: float = float("nan")
    frequency_name: str = "natural frequency"
    marks: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    nodes: tuple[int, int] = (0, 0)
    speed: float = float("nan")

    arrays_along: ClassVar = {
        "x": "x",
        "y": "y",
        "y x": "stable largest slack undecided kind",
        "y x invariant": "invariants",
    }

    def _own_units(self) -> dict[str, str]:
        names = {"x": self.x_name, "y": self.y_name}
        return {axis: "rad/s" for axis, name in names.items() if name == "speed"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Shade the unstable regions by kind and draw the boundaries; speeds in rpm."""
        ax = axes_or_new(ax)
        x, y = (_shown(n, v) for n, v in ((self.x_name, self.x), (self.y_name, self.y)))
        _shade(ax, self, x, y)
        order = "first-order boundary" if self.order == 1 else f"boundary of order {self.order}"
        for curves, style, colour, label in (
            (self.exact, "-", _EXACT, "exact boundary (Hill matrix)"),
            (self.perturbation, "--", _NEAR, order),
        ):
            if curves is not None:
                along = self.x if curves.along == self.x_name else self.y
                ends = np.concatenate([curves.lower, curves.upper])
                with np.errstate(invalid="ignore"):
                    here = np.any((ends >= along[0]) & (ends <= along[-1]))
                text = label if here else f"{label}: none here"
                for k, row in enumerate(ends):
                    line = _placed(self, curves.along, row, curves.at)
                    ax.plot(*line, style, color=colour, lw=1.0, label=None if k else text)
        if self.edges is not None:
            _draw_edges(ax, self, self.edges)
        ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
        for label, values in self.marks.items():
            at = _shown(self.y_name, np.asarray(values))
            for value in at:
                ax.axhline(value, color=_MARK, lw=0.6, alpha=0.7)
            left = np.full(len(at), float(x[0]))
            ax.plot(left, at, ">", color=_MARK, ms=6, clip_on=False, label=label)
        ax.set_xlabel(_LABELS.get(self.x_name, self.x_name))
        ax.set_ylabel(_LABELS.get(self.y_name, self.y_name))
        if self.x_name == "speed" and np.isfinite(self.natural_frequency):
            _draw_fractions(ax, self)
        what = "discriminant" if self.error_norm.startswith("half trace") else "invariants"
        text = f"error of the {what} < {self.error:.1e} (estimate)"
        corner: dict[str, Any] = {"transform": ax.transAxes, "ha": "right", "va": "bottom"}
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
        ax.text(0.99, 0.01, text, **corner, fontsize=7, bbox=box)
        # Below the axes, where it covers nothing.
        ax.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2, fontsize=8, frameon=False
        )
        return ax


def stability_chart(
    system: LinearPeriodic,
    x: Axis,
    y: Axis,
    *,
    boundaries: bool = True,
    order: int = 1,
    edges: bool = False,
    marks: Mapping[str, Sequence[float]] | None = None,
    speed: float | None = None,
    rtol: float = 1e-11,
    workers: Map = map,
    progress: bool = False,
    frequency_name: str = "natural frequency",
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
        ``("speed", values)`` in rad/s or ``(name, values)`` in SI units, of a parameter or of the
        geometry; values rise.
    boundaries : bool
        Whether exact and perturbation boundaries are computed too; for one mode, where one of the
        axes is the speed or the constant stiffness.
    order : int
        Order of the perturbation, 1 to 8; of several modes there is none in a chart, so that only 1
        is taken.
    edges : bool
        Whether regions along the speed, combinations among them, are traced at some rows too.
    marks : mapping, optional
        Label to values along y that the plot marks.
    speed : float, optional
        Crank speed [rad/s] of all points, where the speed is no axis.  Left out it is 1, as in
        Hill's and Mathieu's equations; systems whose geometry is an axis, and those of several
        modes that a turning crank drives, want it.  No boundaries are traced beside another one.
    rtol : float
        Wanted error of the invariants, relative to their size where that exceeds 1.
    workers : callable
        What maps a function over the lines of the chart, and over the verdicts of several modes:
        ``map``, or that of a pool of threads or processes, ``pool.map``, or of Dask's
        ``client.get_executor()``.  The answer does not depend on it.
    progress : bool
        Whether to show a progress bar.
    frequency_name : str
        What the plot calls the natural frequency.

    Returns
    -------
    StabilityChart
        ``error``: largest error of an invariant, over the larger of 1 and its size, estimated
        from the tail of the series and the samples.  Check ``spot check``: five points beside
        :func:`floquet_multipliers`.

    Raises
    ------
    BadInput
        If an axis or option is unusable, or values along the axes make no system: a chart is one
        series over both (``sweep("stability_chart", ...)`` leaves such points out); if a crank
        speed is wanted and missing; if modes and axes would take an hour or so.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> axes = {"x": ("speed", [78.0, 80.0, 82.0]), "y": ("damping", [0.0, 0.5])}
    >>> print(el.stability_chart(system, **axes).stable)
    [[ True False  True]
     [ True  True  True]]
    """
    require_system(system)
    names, axes = _axes(system, x, y)
    require_between("rtol", rtol, 1e-13, 1e-2, "choose 1e-9")
    check_order(order)
    if order != 1 and not is_hill(system):
        expected = "one mode, which alone has boundaries by perturbation in a chart"
        raise bad("order", order, expected, "leave it out; tongue has the series of several modes")
    require_flag("edges", edges)
    if edges and "speed" not in names:
        raise bad("edges", edges, "a chart with the speed as an axis", "leave it out")
    require_flag("boundaries", boundaries)
    refuse(text_problems("stability_chart", frequency_name=frequency_name))
    if marks is not None:
        require_mapping("marks", marks, 'say {"as built": [0.001]}')
    named = {k: tuple(numbers_in_a_row(f"marks[{k!r}]", v)) for k, v in (marks or {}).items()}
    if not callable(workers):
        raise bad("workers", repr(workers), "a callable like map", "give pool.map, or leave it out")
    sampler = Sampler(system, names, axes, speed, float(rtol))
    series = invariants(sampler, workers, progress=progress)
    found = judged(sampler, series, workers)
    exact = near = rows = None
    if boundaries and is_hill(system) and not sampler.shaped and sampler.speed == 1.0:
        exact, near = boundary_curves(system, names, axes, int(order))
    checks = {
        "error of samples": Check(series.sample_error, max(1e-8, 1e3 * rtol)),
        "spot check": spot_check(sampler, series, found),
    }
    if edges:
        rows = _edge_curves(system, names, axes)
        checks["edges"] = rows.check
    return StabilityChart(
        method=series.method,
        error=relative_error(series.error, series.values),
        error_norm=("half trace" if sampler.hill else "invariants")
        + " of the monodromy matrix, largest, relative where beyond 1",
        checks=checks,
        provenance=system.provenance,
        x_name=names[0],
        y_name=names[1],
        x=axes[0],
        y=axes[1],
        invariants=series.values,
        **found._asdict(),
        exact=exact,
        perturbation=near,
        order=int(order),
        edges=rows,
        natural_frequency=natural_frequency(system, names, axes),
        frequency_name=frequency_name,
        marks=named,
        nodes=series.nodes,
        speed=float("nan") if "speed" in names else sampler.speed,
    )


def _axes(system: LinearPeriodic, x: Axis, y: Axis) -> tuple[tuple[str, str], tuple[Array, Array]]:
    known = ["speed", *sorted({*system.parameters, *system.geometry})]
    found = []
    for label, axis in (("x", x), ("y", y)):
        if not isinstance(axis, (tuple, list)) or len(axis) != 2:
            raise bad(f"axis {label}", repr(axis), "a name and values", 'say ("speed", [20, 30])')
        name, given = axis
        if not is_one_of(name, known):
            raise bad(f"axis {label}", repr(name), f"one of {known}", "correct the name")
        values = numbers_in_a_row(f"axis {label}", given)
        if len(values) < 2 or np.any(np.diff(values) <= 0):
            what = "values that do not rise" if len(values) > 1 else "one value"
            raise bad(f"axis {label}", what, "at least two rising values", "give a range")
        if name == "speed" and values[0] <= 0:
            raise bad(f"axis {label}", f"speed {values[0]:g}", "positive speeds", "raise the range")
        found.append(values)
    if x[0] == y[0]:
        raise bad("axis y", repr(y[0]), "another parameter than along x", "choose another")
    return (x[0], y[0]), (found[0], found[1])


def _edge_curves(
    system: LinearPeriodic, names: tuple[str, str], axes: tuple[Array, Array]
) -> EdgeCurves:
    """Return the regions at up to nine rows across a chart whose one axis is the speed."""
    from .edges import stability_edges

    which = names.index("speed")
    values, speeds = axes[1 - which], axes[which]
    if len(values) > _ROWS:
        values = np.linspace(values[0], values[-1], _ROWS)
    span = float(speeds[0]), float(speeds[-1])
    changes: list[dict[str, Any]] = [{names[1 - which]: float(v)} for v in values]
    rows = [stability_edges(system, span, **change) for change in changes]
    keys = sorted({key for row in rows for key in row.names})
    ends = np.full((3, len(keys), len(rows)), np.nan)
    for column, row in enumerate(rows):
        places = [keys.index(key) for key in row.names]
        ends[:, places, column] = row.lower, row.upper, row.error
    failed = sum(not check.passed for row in rows for check in row.checks.values())
    modes = np.array([key[1:3] for key in keys], dtype=np.int64).reshape(-1, 2)
    harmonic = np.array([key[3] for key in keys], dtype=np.int64)
    lower, upper, error = ends
    kind, check = tuple(key[0] for key in keys), Check(float(failed), 0.0)
    return EdgeCurves(values, lower, upper, error, modes, harmonic, kind, check)


_SPOTS = 5


class Judged(NamedTuple):
    """What is told of each point, ``(ny, nx)``; see :class:`~.chart.StabilityChart`."""

    largest: Array
    stable: NDArray[np.bool_]
    slack: Array
    undecided: NDArray[np.bool_]
    kind: NDArray[np.int8]


def judged(sampler: Sampler, series: Series, workers: Map) -> Judged:
    """Return what is told of each point, some rows at a time, which bounds the memory."""
    rows, points = series.values.shape[:2]
    together = max(1, 250_000 // max(1, points))
    parts = [slice(start, start + together) for start in range(0, rows, together)]
    blocks: Iterable[Judged]
    if sampler.hill:
        traces, level, error = series.values[..., 0], _determinants(sampler), series.error
        level = np.broadcast_to(level, error.shape)
        # The verdict is quicker than the way to another process and back.
        blocks = (_judged_hill(traces[part], level[part], error[part]) for part in parts)
    else:
        error = series.error if series.errors is None else series.errors
        judge = partial(_judged_rows, sampler.reduced)
        blocks = workers(judge, ((series.values[part], error[part]) for part in parts))
    return Judged(*(np.concatenate(columns) for columns in zip(*blocks, strict=True)))


def _judged_rows(reduced: bool, item: tuple[Array, Array]) -> Judged:
    """Return what polynomials and the errors of their coefficients tell."""
    values, error = item
    largest, stable, slack = largest_modulus(values, reduced=reduced, error=error)
    # Unstable is only what some multiplier proves beyond its own error.
    doubtful = slack > 0.0 if reduced else largest + slack >= 1.0
    undecided = np.isnan(largest) | (stable & doubtful)
    return Judged(largest, stable, slack, undecided, instability_kind(values, stable, reduced))


def _determinants(sampler: Sampler) -> Array:
    """Return the determinants of the monodromy matrices of one mode; they broadcast to points."""
    if not sampler.damped:
        return np.ones((1, 1))
    speed, grid = on_grid(sampler.names, sampler.axes, sampler.speed)
    values: dict[str, Any] = {**grid}
    # Of one coordinate: what belongs to the points takes the place of rows and columns.
    mass, drag = (sampler.system.array(name, 0.0, **values)[0] for name in ("M", "C"))
    return np.asarray(np.exp(-2 * np.pi * drag / (mass * speed)))


def _judged_hill(trace: Array, level: Array, error: Array) -> Judged:
    """Return what half traces X and the determinants W of the monodromy matrices tell."""
    half = np.abs(trace)
    # An error of the half trace moves the boundary, where it is (1 + W) / 2.
    edge = 0.5 * (1.0 + level)
    slack = _larger_root(edge + error, level) - 1.0
    stable = half <= edge + error
    undecided = np.abs(half - edge) <= error
    kind = np.where(stable | np.isnan(trace), 0.0, np.sign(trace)).astype(np.int8)
    return Judged(_larger_root(half, level), stable, slack, undecided, kind)


def _larger_root(half: Array, level: Array) -> Array:
    """Return the largest modulus of the roots of ``rho^2 - 2 X rho + W`` at X >= 0."""
    # W is the determinant.
    with np.errstate(over="ignore"):
        square = half**2
        real = square >= level
        root = half + np.sqrt(np.where(real, square - level, 0.0))
    return np.where(real, root, np.sqrt(level))


def spot_check(sampler: Sampler, series: Series, found: Judged) -> Check:
    """Compare a handful of points with their Floquet multipliers.

    The value is the worst gap of the largest modulus over what the errors allow.  The allowance
    comes from the multipliers themselves, not from the slack of the verdict.
    """
    rng = np.random.default_rng(1972)
    largest, stable = found.largest, found.stable
    i = rng.integers(0, largest.shape[0], _SPOTS)
    j = rng.integers(0, largest.shape[1], _SPOTS)
    point = {"speed": np.full(_SPOTS, sampler.speed)}
    point |= {sampler.names[0]: sampler.axes[0][j], sampler.names[1]: sampler.axes[1][i]}
    with np.errstate(over="ignore", invalid="ignore"):
        multipliers, known = _direct(sampler.system, point)
    modulus = np.abs(multipliers)
    usable = np.all(np.isfinite(modulus), axis=-1) & np.isfinite(largest[i, j])
    usable &= np.all(np.isfinite(series.values[i, j]), axis=-1)
    if not np.any(usable):
        return Check(0.0, 1.0)
    top = np.argmax(modulus, axis=-1)
    rows = np.arange(_SPOTS)
    error = _full_errors(series, i, j, modulus.shape[-1])
    own = root_uncertainty(np.where(usable[:, None], multipliers, 0.0), error)[rows, top]
    peak = np.where(usable, modulus[rows, top], 1.0)
    allowed = 4.0 * (own + known[rows, top]) + 1e-12 * peak
    gap = np.abs(peak - np.where(usable, largest[i, j], peak))
    # A growth beyond the allowance that is called stable is a gap as well.
    gap = np.where(stable[i, j], np.maximum(gap, peak - 1.0), gap)
    return Check(float(np.max((gap / allowed)[usable])), 1.0)


def _full_errors(series: Series, i: NDArray[np.int64], j: NDArray[np.int64], size: int) -> Array:
    """Return errors of all coefficients of characteristic polynomials at points, doubled."""
    values = series.values[i, j]
    if series.errors is None:
        known = known_to(values, series.error[i, j])[..., :1]
        return np.broadcast_to(2.0 * known, (len(i), size))
    known = known_to(values, series.errors[i, j])
    if known.shape[-1] < size:
        # Palindromic: the same again backwards, and a last coefficient that is 1.
        known = np.concatenate([known, known[:, -2::-1], np.zeros((len(i), 1))], axis=1)
    return 2.0 * known


def _direct(
    system: LinearPeriodic, point: dict[str, Array]
) -> tuple[NDArray[np.complex128], Array]:
    """Return multipliers and their errors at points, ``(points, 2n)`` each."""
    if any(name in system.geometry for name in point):
        members = [{name: float(v[i]) for name, v in point.items()} for i in range(_SPOTS)]
        each = [floquet_multipliers(system, **member) for member in members]
        return np.stack([e.multipliers for e in each]), np.stack([e.error for e in each])
    values: dict[str, Any] = {**point}
    found = floquet_multipliers(system, **values)
    return found.multipliers, found.error


_LABELS = {
    "speed": "crank speed [rpm]",
    "follower_inertia": r"follower inertia $I_4$ [kg m$^2$]",
    "lam2": r"$\lambda^2$",
    "mu": r"$\mu$",
    "crank_ratio": r"crank ratio $\epsilon$",
}
_EXACT, _NEAR, _MARK = "#8c2d04", "#2b5c8a", "#3a7d44"
# By kind of instability; the shades differ in lightness too.
_SHADES = {
    -1: ("#f2c6a8", "odd regions (multiplier below -1)"),
    1: ("#e0a070", "even regions (multiplier above 1)"),
    2: ("#b9a3d6", "combination (complex multipliers)"),
}
_EDGES = {"principal": "#8c2d04", "sum": "#5b2d8c", "difference": "#1f6f6b"}


def _shade(ax: Axes, chart: StabilityChart, x: Array, y: Array) -> None:
    """Shade unstable points, but between exact boundaries what these enclose."""
    from matplotlib.colors import ListedColormap

    kinds = chart.kind.copy()
    enclosed = set(_fill(ax, chart, x, y, kinds))
    colours, codes = ["#ffffff"], np.zeros(kinds.shape)
    for kind, (colour, words) in _SHADES.items():
        here = kinds == kind
        if np.any(here):
            colours.append(colour)
            codes[here] = len(colours) - 1
        if np.any(here) or kind in enclosed:
            ax.fill([], [], color=colour, label=f"unstable: {words}")
    if len(colours) > 1:
        style: dict[str, Any] = {"shading": "nearest", "rasterized": True, "zorder": 0.5}
        shades = ListedColormap(colours)
        ax.pcolormesh(x, y, codes, cmap=shades, vmin=0, vmax=len(colours) - 1, **style)


def _fill(
    ax: Axes, chart: StabilityChart, x: Array, y: Array, kinds: NDArray[np.int8]
) -> Iterator[int]:
    """Fill the regions between exact boundaries, take them out of kinds, and yield theirs."""
    # A region with one end alone reaches to the end of the axis.
    curves = chart.exact
    if curves is None:
        return
    horizontal = curves.along == chart.x_name
    along, other, points = (x, y, kinds) if horizontal else (y, x, kinds.T)
    at = _shown(chart.y_name if horizontal else chart.x_name, curves.at)
    step = float(np.max(np.diff(along)))
    # What is lower in lam2 is the higher speed.
    both = (curves.lower, curves.upper)[:: -1 if curves.along == "speed" else 1]
    for number, *ends in zip(curves.regions, *both, strict=True):
        kind = 1 if number % 2 == 0 else -1
        low, high = (_shown(curves.along, end) for end in ends)
        alone = np.isnan(low) != np.isnan(high)
        low = np.where(alone & np.isnan(low), along[0], low)
        high = np.where(alone & np.isnan(high), along[-1], high)
        begin, end = (np.interp(other, at, values)[:, None] for values in (low, high))
        inside = (along > begin + step) & (along < end - step)
        if np.any(points[inside] != kind):
            continue
        fill = ax.fill_betweenx if horizontal else ax.fill_between
        fill(at, low, high, color=_SHADES[kind][0], lw=0, zorder=0.6)
        # Points are shaded half a step to either side of them.
        near = (along >= begin - step) & (along <= end + step)
        points[near & (points == kind)] = 0
        if np.any((low <= along[-1]) & (high >= along[0])):
            yield kind


def _draw_edges(ax: Axes, chart: StabilityChart, edges: EdgeCurves) -> None:
    """Draw the ends of traced regions between the rows at which they are known, with labels."""
    horizontal = chart.x_name == "speed"
    seen: set[str] = set()
    low, high = (chart.x if horizontal else chart.y)[[0, -1]]
    for i, kind in enumerate(edges.kind):
        with np.errstate(invalid="ignore"):
            # Such a region is drawn as a hair.
            narrow = not np.any(edges.upper[i] - edges.lower[i] > 1e-4 * edges.lower[i])
        for ends in (edges.lower[i], edges.upper[i]):
            label = None if kind in seen else f"{kind} regions, traced"
            line = _placed(chart, "speed", ends, edges.at)
            ax.plot(*line, color=_EDGES[kind], lw=0.35 if narrow else 0.8, label=label)
            seen.add(kind)
        if kind == "principal":
            continue
        # Labels stand at the row nearest to the end of the axis where the region is in the chart.
        known = np.flatnonzero((edges.lower[i] > low) & (edges.lower[i] < high))
        if len(known):
            first, second = edges.modes[i]
            text = f"{first}+{second}" if kind == "sum" else f"{second}-{first}"
            place = _placed(chart, "speed", edges.lower[i, known[-1]], edges.at[known[-1]])
            rotation, va = (90, "top") if horizontal else (0, "center")
            style: dict[str, Any] = {"color": _EDGES[kind], "rotation": rotation, "va": va}
            ax.annotate(f"{text}, {edges.harmonic[i]}", place, fontsize=6, ha="right", **style)


def _placed(chart: StabilityChart, along: str, values: Any, at: Any) -> tuple[Any, Any]:
    """Return x and y, as shown, of values along one axis at values of the other one."""
    horizontal = along == chart.x_name
    pair = _shown(along, values), _shown(chart.y_name if horizontal else chart.x_name, at)
    return pair if horizontal else pair[::-1]


def _shown(name: str, values: Array) -> Array:
    return values * RPM if name == "speed" else values


def _draw_fractions(ax: Axes, chart: StabilityChart) -> None:
    """Put the speeds 2 Omega / n on a second axis along the top, n the number of the region."""
    low, high = ax.get_xlim()
    ticks: list[float] = []
    labels: list[str] = []
    for n in range(1, 41):
        speed = 2.0 * chart.natural_frequency / n * RPM
        if low <= speed <= high and (not ticks or ticks[-1] - speed > 0.045 * (high - low)):
            ticks.append(speed)
            whole = r"\Omega" if n == 2 else rf"\Omega/{n // 2}"
            labels.append(f"${whole}$" if n % 2 == 0 else rf"$2\Omega/{n}$")
    top = ax.secondary_xaxis("top")
    top.set_xticks(ticks, labels, fontsize=8)
    top.set_xlabel(rf"fractions of the {chart.frequency_name} $\Omega$", fontsize=9)
