"""Measured jumps and doublings of a machine, by its nonlinear equation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil, log

import numpy as np

from ..core.errors import bad
from ..core.families import Nonlinear
from ..core.results import Check
from ..nonlinear import ResponseCurve, response_curve
from ..nonlinear.branch import value_error
from ..nonlinear.loci import special_near
from ..nonlinear.orbit import FAILURES, Lost, Orbit, Solver, changed
from .measured import Computed, Point, nearest

# What a kind of point is called along a branch; by how much a motion beside a special point is
# aside along it; the change of a logarithm within which a special point is followed at once, into
# how many parts it is cut at most; and the largest error of a speed, relative.
_SPECIAL = {
    "jump rising": "fold",
    "jump falling": "fold",
    "unstable from": "doubling",
    "unstable to": "doubling",
}
_ASIDE, _AT_ONCE, _MOST_PARTS, _LIMIT = 1e-3, 0.02, 512, 1e-6


@dataclass
class _Followed:
    """A fold or doubling, followed as the numbers of the machine change."""

    solver: Solver
    orbit: Orbit
    special: str

    def moved(self, numbers: Mapping[str, float]) -> tuple[float, float]:
        """Return the speed with other numbers and its error; NaN where it is lost."""
        before = self.solver.problem.system.parameters
        start = {name: float(before[name]) for name in numbers}
        far = max(abs(log(value / start[name])) for name, value in numbers.items())
        parts = max(1, ceil(far / _AT_ONCE))
        while parts <= _MOST_PARTS:
            try:
                self.solver, self.orbit = self._along(start, numbers, parts)
                return self.orbit.value, value_error(self.solver, self.orbit, self.special)
            except FAILURES:
                parts *= 4
        return np.nan, np.nan

    def _along(
        self, start: Mapping[str, float], numbers: Mapping[str, float], parts: int
    ) -> tuple[Solver, Orbit]:
        solver, orbit = self.solver, self.orbit
        for k in range(1, parts + 1):
            part = k / parts
            values = {name: a ** (1.0 - part) * numbers[name] ** part for name, a in start.items()}
            values = dict(numbers) if k == parts else values
            system = solver.problem.system.with_parameters(**values)
            solver = replace(solver, problem=replace(solver.problem, system=system))
            orbit = special_near(solver, orbit, orbit.value, self.special)
        return solver, orbit


class BranchRun:
    """The points that were measured on one machine, as folds and doublings of its motions.

    A jump is seen where a stable motion of one revolution ends, an unstable range begins or ends
    where such a motion doubles.
    """

    def __init__(self, system: Nonlinear, points: list[tuple[int, Point]], window: float) -> None:
        self.system, self.points, self.window = system, points, window
        self._followed: dict[int, _Followed] = {}
        for i, point in points:
            if point.kind not in _SPECIAL:
                expected = f"one of {list(_SPECIAL)}, for a nonlinear equation"
                fix = "take a linear formulation for others"
                raise bad(f"point {i + 1}", point.kind, expected, fix)

    def fill(self, found: Computed, numbers: Mapping[str, float]) -> None:
        """Fill in what is computed with other numbers."""
        if not self._followed:
            self._pair(self.system.with_parameters(**numbers))
        for i, point in self.points:
            found.values[i], found.errors[i] = self._followed[i].moved(numbers)
            found.add({"special points": Check(float(found.errors[i]) / point.speed, _LIMIT)})

    def _pair(self, system: Nonlinear) -> None:
        speeds = [point.speed for _, point in self.points]
        span = min(speeds) * (1.0 - self.window), max(speeds) * (1.0 + self.window)
        curve = response_curve(system, "speed", span)
        seen: dict[str, list[Orbit]] = {kind: [] for kind in _SPECIAL}
        for kind, orbit in zip(curve.special, curve.special_orbits, strict=True):
            if orbit.motion.turns == 1 and (named := _seen(curve, kind, orbit)):
                seen[named].append(orbit)
        for i, point in self.points:
            orbits = seen[point.kind]
            k = nearest(i, point, [orbit.value for orbit in orbits], self.window)
            self._followed[i] = _Followed(curve.source, orbits[k], _SPECIAL[point.kind])


def _seen(curve: ResponseCurve, kind: str, orbit: Orbit) -> str | None:
    """Return what is measured at a special point, if it is where a stable motion ends."""
    if kind not in ("fold", "doubling"):
        return None
    try:
        sides = [_aside(curve.source, orbit, sign * _ASIDE) for sign in (1.0, -1.0)]
    except Lost:
        return None
    holds = [bool(np.max(np.abs(side.multipliers)) < 1.0) for side in sides]
    if holds[0] == holds[1]:
        return None
    rises = [side.value > orbit.value for side in sides]
    if kind == "fold":
        return "jump falling" if all(rises) else "jump rising"
    # Below the speed it is stable, or above.
    return "unstable to" if rises[holds.index(True)] else "unstable from"


def _aside(solver: Solver, orbit: Orbit, step: float) -> Orbit:
    """Return the motion a step further along the branch."""
    value, guess = changed(orbit, orbit.tangent, step)
    return solver.corrected(value, guess, orbit.tangent)[0]
