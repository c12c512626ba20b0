"""What is sampled over a chart, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..hill import hill_form
from ..hill.form import is_hill
from ..periodic.equation import equation_of
from .chart_axes import Axes, Names, fixed_speed, is_damped, is_symplectic, plain_axes

# What does independent pieces of work, such as the builtin map.
Map = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]

# Flops, roughly, that one chart may cost: an hour or so.
_MOST_WORK = 1e13


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
    """What is asked of a chart at a fixed speed [rad/s], or with the speed as an axis."""

    def __init__(
        self, system: LinearPeriodic, names: Names, axes: Axes, speed: float | None, rtol: float
    ) -> None:
        self.speed = fixed_speed(system, names, speed)
        self.system, self.names, self.axes, self.rtol = system, names, axes, rtol
        self.damped = is_damped(system, names, axes)
        self.reduced = is_symplectic(system, self.damped)
        shaped = any(name in system.geometry for name in names)
        self.hill = is_hill(system) and not shaped and not (system.has("Kg") and "speed" in names)
        self.form = hill_form(system) if self.hill else None
        self.plain = (
            None if self.form is None or self.damped else plain_axes(self.form, names, self.speed)
        )

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

    def allowed(self, lines: int, nodes: int) -> None:
        """Refuse a chart whose lines, and nodes on each, would take more than an hour or so."""
        if self.hill:
            return
        corner: dict[str, Any] = {
            name: np.asarray([a[i] for i in pick], dtype=float)
            for name, a, pick in zip(
                self.names, self.axes, ((0, 0, -1, -1), (0, -1) * 2), strict=True
            )
            if name not in self.system.geometry
        }
        speed = corner.pop("speed", np.full(4, self.speed))
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
