"""Half traces over a chart: at each point where that is cheaper, else at Chebyshev nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core import chebyshev
from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.progress import bar
from ..core.workers import Workers, check_executor
from ..hill import discriminant, hill_form
from ..hill.form import is_hill
from ..periodic.equation import equation_of
from .chart_axes import (
    Axes,
    Names,
    at_speed,
    is_damped,
    is_symplectic,
    leaves_function_alone,
    plain_axes,
)
from .invariants import half_trace_rows, half_traces

if TYPE_CHECKING:
    from concurrent.futures import Executor

_FIRST, _MOST = 16, 512
# Flops, roughly, that one chart may cost: an hour or so.
_MOST_WORK = 1e13

Tick = Callable[[int], None] | None


@dataclass(frozen=True)
class Series:
    """Invariants on the chart ``(ny, nx, k)``, absolute errors ``(ny, nx)``, how they were found.

    ``sample_error`` is that of single samples, relative to the size of the invariants; ``errors``
    are those of each invariant ``(ny, nx, k)`` where they are known one by one.
    """

    values: Array
    error: Array
    sample_error: float
    nodes: tuple[int, int]
    method: str
    errors: Array | None = None

    def rows(self, part: slice) -> Series:
        """Return the same of some rows of the chart."""
        errors = None if self.errors is None else self.errors[part]
        return replace(self, values=self.values[part], error=self.error[part], errors=errors)


class Sampler:
    """Evaluates the invariants at given points of the transformed axes."""

    def __init__(self, system: LinearPeriodic, names: Names, axes: Axes, rtol: float) -> None:
        self.system, self.names, self.axes, self.rtol = system, names, axes, rtol
        self.damped = is_damped(system, names, axes)
        self.reduced = is_symplectic(system, self.damped)
        shaped = any(name in system.geometry for name in names)
        self.hill = is_hill(system) and not shaped and not (system.has("Kg") and "speed" in names)
        self.form = hill_form(system) if self.hill else None
        self.plain = None if self.form is None or self.damped else plain_axes(self.form, names)
        self._executor: Executor | None = None
        self._asked: tuple[LinearPeriodic, float | None] = (system, None)

    @classmethod
    def of_chart(
        cls,
        system: LinearPeriodic,
        names: Names,
        axes: Axes,
        speed: float | None,
        rtol: float,
        executor: Executor | None = None,
    ) -> Sampler:
        """Return the sampler of a chart at a fixed speed [rad/s], or with the speed as an axis."""
        check_executor(executor)
        made = cls(at_speed(system, names, speed), names, axes, rtol)
        made._executor, made._asked = executor, (system, speed)
        return made

    @cached_property
    def workers(self) -> Workers:
        """What does independent pieces, each with a sampler of its own where it is elsewhere."""
        if self._executor is None:
            return Workers(None, _itself, self)
        # The system as it was given: one slowed down does not bear pickling.
        system, speed = self._asked
        made = (Sampler.of_chart, system, self.names, self.axes, speed, self.rtol)
        return Workers(self._executor, *made)

    def rows(self, part: slice) -> Sampler:
        """Return the sampler of some rows of the chart."""
        found = copy(self)
        found.axes = (self.axes[0], self.axes[1][part])
        return found

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

    def __call__(self, x: Array, y: Array, tick: Tick = None) -> tuple[Array, Array]:
        """Return half traces ``(1, nx, ny)`` of one mode and the error of each ``(nx, ny)``."""
        if self.form is None:
            raise ValueError("several modes are solved line by line")
        ax, ay = (self.back(n, v) for n, v in zip(self.names, (x, y), strict=True))
        # For each y a function f, and all x at once where x leaves f alone: the axis that changes
        # f is the outer loop.
        outer = 1 if leaves_function_alone(self.form, self.names[0]) else 0
        return half_traces(outer, ax, ay, tick, partial(self.workers.run, _half_trace_rows))

    def allowed(self, lines: int, nodes: int) -> None:
        """Refuse a chart whose lines, and nodes on each, would take too long.

        Raises
        ------
        BadInput
            If modes, points and segments of the turn amount to more than an hour or so.
        """
        corner: dict[str, Any] = {
            name: np.asarray([a[i] for i in pick], dtype=float)
            for name, a, pick in zip(
                self.names, self.axes, ((0, 0, -1, -1), (0, -1) * 2), strict=True
            )
            if name not in self.system.geometry
        }
        speed = corner.pop("speed", np.ones(4))
        rate = float(np.max(equation_of(self.system, speed, corner).rate()))
        # A segment has a phase of 4 rad; its series cost as much as 3000 products of matrices.
        segments = max(8.0, rate * self.system.period / 4.0)
        product = 2.0 * (2 * self.system.size) ** 3
        work = lines * (nodes + 3000) * segments * product
        if all(name in self.system.geometry for name in self.names):
            # A point alone costs 300 products, and its system, made anew, 1.4e8 flops.
            work = lines * nodes * (300 * segments * product + 1.4e8)
        if work > _MOST_WORK:
            raise bad(
                "stability_chart",
                f"{self.system.size} modes, {lines} lines of {nodes} points, up to "
                f"{segments:.2g} segments of the period each",
                f"at most {_MOST_WORK / work:.2g} of that",
                "raise the lowest speed, give fewer modes or points, or narrower axes",
            )


def _itself(sampler: Sampler) -> Sampler:
    return sampler


def _half_trace_rows(sampler: Sampler, rows: tuple[int, Array, Array]) -> tuple[Array, Array]:
    """Return the half traces of one mode at some values of the outer axis."""
    if sampler.form is None:
        raise ValueError("several modes are solved line by line")
    outer, fixed, along = rows
    return half_trace_rows(sampler.form, sampler.names, outer, fixed, along)


def invariants(sampler: Sampler, *, progress: bool) -> Series:
    """Return the half traces of a chart in the way that suits it."""
    return _plain_hill(sampler) or _sampled(sampler, progress)


def _plain_hill(sampler: Sampler) -> Series | None:
    """Return half traces where the axes are lam2 and the factor of one function, else None."""
    if sampler.plain is None:
        return None
    which, f, lam2, factor = sampler.plain
    axes = sampler.axes
    order = np.argsort(lam2(axes[which]))
    found = discriminant(f, lam2(axes[which])[order, None], factor(axes[1 - which]))
    values, error = np.empty_like(found.value), np.empty_like(found.value)
    values[order], error[order] = found.value, found.error
    if which == 0:
        values, error = values.T, error.T
    sample = relative_error(error, values[..., None])
    return Series(values[..., None], error, sample, (0, 0), f"half trace, {found.method}")


def relative_error(error: Array, values: Array) -> float:
    """Return the largest error over the larger of 1 and the size of the invariants there.

    Invariants that overflowed have none; one that is NaN, or an error that is, counts as infinite.
    """
    # A maximum over one entry is dear.
    largest = np.abs(values[..., 0]) if values.shape[-1] == 1 else np.max(np.abs(values), axis=-1)
    size = np.maximum(1.0, largest)
    if np.any(np.isnan(size) | (np.isnan(error) & np.isfinite(size))):
        return float("inf")
    finite = np.isfinite(size)
    return float(np.max(error[finite] / size[finite], initial=0.0))


def _sampled(sampler: Sampler, progress: bool) -> Series:
    """Sample at the points of the chart, or at Chebyshev nodes where those are fewer."""
    axes = tuple(sampler.transform(n, a) for n, a in zip(sampler.names, sampler.axes, strict=True))
    points = len(axes[0]) * len(axes[1])
    count: list[int] = []
    if points > 2 * _FIRST**2:
        count = [_counted(sampler, axes[axis], axis, axes[1 - axis]) for axis in (0, 1)]
    if not count or count[0] * count[1] > 0.8 * points:
        return _direct(sampler, axes, progress)
    while True:
        with bar(progress, count[0] * count[1]) as tick:
            coefficients, samples, error = _coefficients(sampler, axes, count, tick)
        size = max(1.0, max(float(np.max(np.abs(c))) for c in coefficients))
        tails = [_tail(coefficients, axis) for axis in (0, 1)]
        worst = float(np.max(error))
        floor = max(sampler.rtol * size, worst)
        if max(tails) <= floor or max(count) >= _MOST:
            break
        for axis in (0, 1):
            if tails[axis] > floor:
                count[axis] = min(_MOST, count[axis] + count[axis] // 3)
    places = [chebyshev.unit(a, float(a.min()), float(a.max())) for a in axes]
    values = np.stack(
        [chebyshev.tensor_values(c, places[0], places[1]).T for c in coefficients], axis=-1
    )
    # Round-off of the series is spread over the chart by its largest values.
    total = sum(tails) + worst + 8 * np.finfo(float).eps * size
    sample = relative_error(error, np.moveaxis(samples, 0, -1))
    kind = "half trace at Chebyshev nodes, spectral interpolation"
    return Series(values, np.full(values.shape[:2], total), sample, (count[0], count[1]), kind)


def _direct(sampler: Sampler, axes: Sequence[Array], progress: bool) -> Series:
    """Sample at each point of the chart."""
    points = len(axes[0]) * len(axes[1])
    with bar(progress, points) as tick:
        values, error = sampler(axes[0], axes[1], tick)
    shown = np.transpose(values, (2, 1, 0))
    method = "half trace at each point"
    return Series(shown, error.T, relative_error(error.T, shown), (0, 0), method)


def _counted(sampler: Sampler, values: Array, axis: int, across: Array) -> int:
    """Return how many nodes one axis needs, judged on lines at both ends of the other one.

    The number is doubled until the tail is small; then the coefficients tell where it begins.
    """
    count = _FIRST
    ends = np.array([across.min(), across.max()])
    while True:
        points = _nodes(values, count)
        found, _ = sampler(points, ends) if axis == 0 else sampler(ends, points)
        lines = found if axis == 0 else np.swapaxes(found, 1, 2)
        table = np.abs(chebyshev.analysis(count) @ lines)
        sizes = np.sum(np.max(table, axis=2), axis=0)
        limit = sampler.rtol * max(1.0, float(np.max(table)))
        needed = chebyshev.length(sizes, limit / 8)
        if needed <= count - max(2, count // 16) or count >= _MOST:
            # Inside the chart a little more may be needed than at its edges.
            return min(_MOST, needed + 3 + needed // 16)
        count *= 2


def _nodes(values: Array, count: int) -> Array:
    low, high = float(values.min()), float(values.max())
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(count))


def _coefficients(
    sampler: Sampler, axes: Sequence[Array], count: Sequence[int], tick: Tick
) -> tuple[list[Array], Array, Array]:
    """Return Chebyshev coefficients of each invariant, the samples and their errors."""
    samples, error = sampler(_nodes(axes[0], count[0]), _nodes(axes[1], count[1]), tick)
    return [chebyshev.coefficients2(values) for values in samples], samples, error


def _tail(coefficients: Sequence[Array], axis: int) -> float:
    """Return the sum of the sizes of the last two coefficients (an eighth of many) of an axis."""
    worst = 0.0
    for table in coefficients:
        sizes = np.max(np.abs(table), axis=1 - axis)
        worst = max(worst, float(np.sum(sizes[-min(max(2, len(sizes) // 32), 8) :])))
    return worst
