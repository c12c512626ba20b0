"""What a machine does where it was measured: its resonances, ends of regions and deflections."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..core.errors import LinearRangeWarning, Problem, bad, refuse
from ..core.families import Array, LinearPeriodic
from ..core.plotting import RPM
from ..core.results import Check
from ..frequencies import critical_speeds
from ..frequencies.response_maxima import response_maxima
from ..periodic import steady_state
from ..stability import stability_edges
from .measured import Point

# Parts of a speed beside the expected one within which a resonance is looked for, one after the
# other, as a small one stands out between narrow ends alone; how many are looked at; and error of a
# speed, relative, beyond which there is none.
_NEAR, _EXPECTED, _BLUNT = (0.003, 0.001, 0.0003), 6, 1e-3


@dataclass(frozen=True)
class Computed:
    """What is computed at k points.

    Attributes
    ----------
    values, errors : ndarray, shape (k,)
        Speeds [rad/s] and deflections [m], NaN where there is none; and their errors.
    checks : mapping
        The worst check of each name.
    """

    values: Array
    errors: Array
    checks: Mapping[str, Check] = field(default_factory=dict)


@dataclass
class _Found:
    """What is computed, as it is filled in."""

    values: Array
    errors: Array
    checks: dict[str, Check] = field(default_factory=dict)

    def add(self, checks: Mapping[str, Check]) -> None:
        for name, check in checks.items():
            known = self.checks.get(name)
            if known is None or check.value * known.limit > known.value * check.limit:
                self.checks[name] = check


class Machines:
    """Measured points computed with other numbers, each on the machine as it was run.

    The first call pairs each point with the nearest computed one and refuses those without one, or
    with two that are about as near; then resonance or region are followed by modes and order.
    """

    def __init__(
        self,
        system: LinearPeriodic,
        names: tuple[str, ...],
        points: Sequence[Point],
        window: float,
    ) -> None:
        runs: dict[tuple[tuple[str, float], ...], list[int]] = {}
        for i, point in enumerate(points):
            runs.setdefault(tuple(sorted(point.given.items())), []).append(i)
        self.names, self.size = names, len(points)
        self._runs = [
            _Run(_run_with(system, names, given, at[0]), [(i, points[i]) for i in at], window)
            for given, at in runs.items()
        ]

    def __call__(self, values: Array, quiet: bool = True) -> Computed:
        """Return what is computed with values of the named parameters."""
        numbers = dict(zip(self.names, values.tolist(), strict=True))
        found = _Found(np.full(self.size, np.nan), np.full(self.size, np.nan))
        with warnings.catch_warnings():
            if quiet:  # a fit passes values that are not those of the machine
                warnings.simplefilter("ignore", LinearRangeWarning)
            for run in self._runs:
                run.fill(found, numbers)
        return Computed(found.values, found.errors, found.checks)


def _run_with(
    system: LinearPeriodic, names: tuple[str, ...], given: tuple[tuple[str, float], ...], place: int
) -> LinearPeriodic:
    """Return the system with what the machine was run with, refused where that is not known."""
    wrong = [name for name, _ in given if name in names or name not in system.parameters]
    if wrong:
        known = f"one of {sorted(set(system.parameters) - set(names))}: known or unknown, not both"
        raise bad(f"point {place + 1}", repr(wrong[0]), known, "correct the column")
    return system.with_parameters(**dict(given)) if given else system


class _Run:
    """The points that were measured on one machine."""

    def __init__(
        self, system: LinearPeriodic, points: list[tuple[int, Point]], window: float
    ) -> None:
        self.system, self.points, self.window = system, points, window
        # By point: mode and ratio of a resonance, the name of a region.
        self._paired: dict[int, Any] = {}

    def fill(self, found: _Found, numbers: Mapping[str, float]) -> None:
        """Fill in what is computed with other numbers."""
        system = self.system.with_parameters(**numbers)
        if at := self._of("unstable from", "unstable to"):
            self._ends(system, at, found)
        if at := self._of("resonance"):
            self._resonances(system, at, found)
        if at := self._of("deflection"):
            state = steady_state(system, [point.speed for _, point in at], rtol=1e-9)
            found.add(state.checks)
            for (i, _), q, error in zip(at, state.q, state.error, strict=True):
                largest = system.largest_deflection(state.theta, q[None]) or np.nan
                found.values[i] = largest * system.reference_length
                found.errors[i] = found.values[i] * float(np.max(error))

    def _of(self, *kinds: str) -> list[tuple[int, Point]]:
        return [(i, point) for i, point in self.points if point.kind in kinds]

    def _ends(self, system: LinearPeriodic, at: list[tuple[int, Point]], found: _Found) -> None:
        speeds = [point.speed for _, point in at]
        span = min(speeds) * (1.0 - self.window), max(speeds) * (1.0 + self.window)
        edges = stability_edges(system, span)
        found.add(edges.checks)
        for i, point in at:
            ends = edges.lower if point.kind == "unstable from" else edges.upper
            seen = np.flatnonzero(np.isfinite(ends) & (edges.lower != edges.upper)).tolist()
            if i not in self._paired:
                k = seen[self._nearest(i, point, ends[seen].tolist())]
                self._paired[i] = edges.names[k]
            named = [k for k in seen if edges.names[k] == self._paired[i]]
            if named:
                k = named[int(np.argmin(np.abs(ends[named] - point.speed)))]
                found.values[i], found.errors[i] = ends[k], edges.error[k]

    def _resonances(
        self, system: LinearPeriodic, at: list[tuple[int, Point]], found: _Found
    ) -> None:
        for i, point in at:
            if i not in self._paired:
                self._paired[i] = self._first(system, i, point)
        modes = np.array([self._paired[i][0] for i, _ in at])
        speeds = np.array([point.speed for _, point in at])
        span = 0.5 * float(np.min(speeds)), 2.0 * float(np.max(speeds))
        means = critical_speeds(system, span, modes=int(np.max(modes))).mean_frequency
        expected = np.array([self._paired[i][1] for i, _ in at]) * means[modes - 1]
        places, errors = _maxima(system, expected)
        for (i, _), place, error in zip(at, places, errors, strict=True):
            found.values[i], found.errors[i] = place, error

    def _first(self, system: LinearPeriodic, i: int, point: Point) -> tuple[int, float]:
        """Return the mode of the nearest resonance, and its speed over the mode's frequency."""
        span = point.speed * (1.0 - self.window), point.speed * (1.0 + self.window)
        # Narrow ones are found beside the fractions of the frequencies, others by a scan.
        near = critical_speeds(system, span)
        order = np.argsort(np.abs(near.speed - point.speed), kind="stable")[:_EXPECTED]
        places, _ = _maxima(system, near.speed[order])
        scanned = critical_speeds(system, span, method="response")
        rows = [*zip(places.tolist(), near.mode[order].tolist(), strict=True)]
        rows += [*zip(scanned.speed.tolist(), scanned.mode.tolist(), strict=True)]
        rows = [row for row in rows if np.isfinite(row[0])]
        place, mode = rows[self._nearest(i, point, [place for place, _ in rows])]
        return mode, place / float(near.mean_frequency[mode - 1])

    def _nearest(self, i: int, point: Point, speeds: list[float]) -> int:
        """Return which speed is nearest to that of a point; refused where it is not clear."""
        off = np.abs(np.array(speeds) - point.speed)
        order = np.argsort(off, kind="stable")
        words = f"{point.kind} at {point.speed * RPM:.6g} rpm"
        fix = "start from other values, or change the window"
        if not len(off) or off[order[0]] > self.window * point.speed:
            expected = f"a computed one within {100 * self.window:g} % of the speed"
            refuse([Problem(f"point {i + 1}", words, expected, fix)])
        first = int(order[0])
        others = [k for k in order.tolist() if abs(speeds[k] - speeds[first]) > 1e-6 * point.speed]
        if others and off[first] > 0.5 * off[others[0]]:
            both = " and ".join(f"{speeds[k] * RPM:.6g}" for k in (first, others[0]))
            found = f"{words}, and computed ones at {both} rpm"
            refuse([Problem(f"point {i + 1}", found, "one that is clearly the nearest", fix)])
        return first


def _maxima(system: LinearPeriodic, expected: Array) -> tuple[Array, Array]:
    """Return resonances beside expected speeds and their errors, NaN where there is none."""
    if not len(expected):
        return expected, expected
    places, errors = np.full((2, len(expected)), np.nan)
    for near in _NEAR:
        left = np.flatnonzero(np.isnan(places))
        if not left.size:
            break
        middle = expected[left]
        found, _, off = response_maxima(system, middle * (1.0 - near), middle * (1.0 + near))
        beside = np.abs(found - middle) <= 10.0 * near * middle
        sharp = (off <= _BLUNT * found) & beside
        places[left[sharp]], errors[left[sharp]] = found[sharp], off[sharp]
    return places, errors
