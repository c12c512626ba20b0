"""Folds and doublings followed in a second parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..core.errors import bad
from ..core.families import Array
from ..core.inputs import require_kind
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Result, provenance
from .branch import TESTS, value_error
from .orbit import FAILURES, Lost, Orbit, Solver, changed
from .response import ResponseCurve, rising_pair
from .segments import Problem

# Steps in the plane of both parameters, in parts of their ranges: the first, least and largest.
_FIRST, _LEAST, _LARGEST = 0.01, 1e-5, 0.05
_POINTS = 400
# Steps of the secant rule along a branch, and the length of one that is the last.
_SECANTS, _THERE = 14, 1e-10


@dataclass(frozen=True, kw_only=True)
class SpecialCurve(Result):
    """Where folds or doublings lie in the plane of two parameters.

    Attributes
    ----------
    kind : str
        ``"fold"`` or ``"doubling"``.
    parameters : tuple of str
        Names of both parameters.
    first, second : ndarray, shape (k,)
        Their values [SI], along the curve.
    turns : int
        Revolutions after which the motions repeat.
    ended : tuple of str
        Why the curve ends, either way.
    """

    kind: str
    parameters: tuple[str, str]
    first: Array
    second: Array
    turns: int
    ended: tuple[str, str]

    arrays_along: ClassVar = {"point": "first second error"}

    def _own_units(self) -> dict[str, str]:
        names = zip(("first", "second"), self.parameters, strict=True)
        return {name: "rad/s" for name, of in names if of == "speed"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curve; speeds in rpm, as in stability charts."""
        ax = axes_or_new(ax)
        factors = [RPM if name == "speed" else 1.0 for name in self.parameters]
        label = f"{self.kind} of {self.turns} turn{'s' * (self.turns > 1)}"
        ax.plot(factors[0] * self.first, factors[1] * self.second, label=label)
        x, y = ("crank speed [rpm]" if n == "speed" else f"{n} [SI]" for n in self.parameters)
        ax.set(xlabel=x, ylabel=y)
        ax.legend(frameon=False, fontsize="small")
        return ax


def special_curve(
    curve: ResponseCurve,
    number: int,
    parameter: str,
    bounds: tuple[float, float],
    *,
    progress: bool = False,
) -> SpecialCurve:
    """Follow a fold or a doubling of a response curve in a second parameter, both ways.

    At each step one of the two parameters is held, that along the curve changes less is found: the
    fold or doubling as the zero of its test along a branch.

    Parameters
    ----------
    curve : ResponseCurve
        Over the first parameter.
    number : int
        Number of the special point, from 0.
    parameter : str
        The second parameter: ``"speed"``, or a name of the system's parameters.
    bounds : tuple of float
        Its lowest and highest value [SI].
    progress : bool
        Whether to show a bar.

    Returns
    -------
    SpecialCurve

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    >>> rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    >>> curve = el.response_curve(rig, "speed", (32.0, 40.0))
    >>> fold = el.nonlinear.special_curve(curve, 0, "damping", (0.2, 0.3))
    >>> print(fold.kind, fold.parameters, fold.second.max().round(3))
    fold ('speed', 'damping') 0.264
    """
    require_kind("curve", curve, ResponseCurve, "take what response_curve returns")
    known = len(curve.special)
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < known:
        fix = "count them from 0"
        raise bad("number", repr(number), f"one of {known} special points", fix)
    kind = curve.special[number]
    if kind not in ("fold", "doubling"):
        raise bad("number", f"a {kind}", "a fold or a doubling", "choose another point")
    system, speed = curve.source.problem.system, curve.source.problem.speed
    names = ["speed", *sorted(system.parameters)]
    if parameter not in names or parameter == curve.parameter:
        expected = f"another than {curve.parameter!r}, of {names}"
        raise bad("parameter", repr(parameter), expected, "correct it")
    low, high = rising_pair(bounds)
    here = speed if parameter == "speed" else system.parameters[parameter]
    if not low <= here <= high:
        raise bad("bounds", repr(bounds), f"a range that holds {here:.6g}", "widen it")
    plane = _Plane(curve, parameter, kind, (low, high))
    start = _Point(curve.special_orbits[number], here)
    halves, ends = [], []
    with bar(progress, 2 * _POINTS, unit="point") as tick:
        for sign in (-1.0, 1.0):
            points, ended = plane.walked(start, sign)
            halves.append(points)
            ends.append(ended)
            tick(_POINTS * len(halves))
    points = [*reversed(halves[0]), start, *halves[1]]
    errors = [value_error(plane.solver(p.second), p.orbit, kind) for p in points]
    return SpecialCurve(
        method="secants across branches, stepping along the curve",
        error=np.array(errors),
        error_norm=f"of {curve.parameter} [SI], absolute",
        provenance=provenance(system.provenance),
        kind=kind,
        parameters=(curve.parameter, parameter),
        first=np.array([point.orbit.value for point in points]),
        second=np.array([point.second for point in points]),
        turns=start.orbit.motion.turns,
        ended=(ends[0], ends[1]),
    )


@dataclass(frozen=True)
class _Point:
    """A special point in the plane of both parameters."""

    orbit: Orbit  # of the problem over the first parameter
    second: float


@dataclass(frozen=True)
class _Plane:
    """The plane of two parameters, and the curve that is followed in it."""

    curve: ResponseCurve
    parameter: str
    kind: str
    bounds: tuple[float, float]

    @property
    def span(self) -> float:
        """Range of the second parameter."""
        return self.bounds[1] - self.bounds[0]

    def solver(self, second: float) -> Solver:
        """Return the solver over the first parameter at a value of the second."""
        problem = self._held(self.parameter, second, self.curve.parameter)
        return replace(self.curve.source, problem=problem)

    def across(self, first: float) -> Solver:
        """Return the solver over the second parameter at a value of the first."""
        problem = self._held(self.curve.parameter, first, self.parameter)
        return replace(self.curve.source, problem=problem, span=self.span)

    def _held(self, name: str, value: float, varied: str) -> Problem:
        """Return the problem over one parameter at a value of the other."""
        problem = self.curve.source.problem
        if name == "speed":
            return Problem(problem.system, varied, value)
        system = problem.system.with_parameters(**{name: value})
        return Problem(system, varied, problem.speed)

    def place(self, point: _Point) -> Array:
        """Return both parameters over their ranges."""
        return np.array([point.orbit.value / self.curve.source.span, point.second / self.span])

    def walked(self, start: _Point, sign: float) -> tuple[list[_Point], str]:
        """Return the points of the curve from a first one, one way, and why it ends."""
        points: list[_Point] = []
        for point in self._steps(start, sign):
            inside = self.bounds[0] <= point.second <= self.bounds[1]
            if not inside:
                return points, "it leaves the range of the second parameter"
            low, high = np.min(self.curve.value), np.max(self.curve.value)
            points.append(point)
            if not low <= point.orbit.value <= high:
                return points, "it leaves the range of the first parameter"
            if len(points) >= _POINTS:
                return points, f"{_POINTS} points"
        return points, "it cannot be followed"

    def _steps(self, start: _Point, sign: float) -> Iterator[_Point]:
        step, before, last = _FIRST, None, start
        way = np.array([0.0, sign])
        while step >= _LEAST:
            if before is not None:
                way = self.place(last) - self.place(before)
                way = way / np.linalg.norm(way)
            try:
                point = self._next(before, last, way, step)
            except FAILURES:
                step *= 0.4
                continue
            moved = self.place(point) - self.place(last)
            if before is not None and moved @ way < 0.8 * np.linalg.norm(moved):
                step *= 0.4
                continue
            yield point
            before, last = last, point
            step = min(1.4 * step, _LARGEST)

    def _next(self, before: _Point | None, last: _Point, way: Array, step: float) -> _Point:
        """Return the next point: one parameter a step further, the other found."""
        first = last.orbit.value + step * way[0] * self.curve.source.span
        second = last.second + step * way[1] * self.span
        if abs(way[1]) >= abs(way[0]):
            return _Point(special_near(self.solver(second), last.orbit, first, self.kind), second)
        found = special_near(self.across(first), last.orbit, second, self.kind)
        # The same motion as one over the first parameter.
        solver = self.solver(found.value)
        orbit, _ = solver.corrected(first, found.motion, last.orbit.tangent)
        return _Point(orbit, found.value)


def special_near(solver: Solver, near: Orbit, value: float, kind: str) -> Orbit:
    """Return the motion at which a test vanishes, near one at another parameter."""
    test = TESTS[kind]
    direction = replace(near.tangent, span=solver.span)
    if kind == "doubling":
        direction = solver.along_parameter(near.motion)
    orbit, _ = solver.corrected(value, near.motion, direction)
    orbit, _ = solver.refined(orbit)
    step, before = 1e-3, None
    for _ in range(_SECANTS):
        at = test(orbit)
        if before is not None:
            slope = (at - before) / step
            if slope == 0.0 or not np.isfinite(slope):
                break
            step = -at / slope
        if abs(step) > 0.5:
            break
        ahead_value, guess = changed(orbit, orbit.tangent, step)
        ahead, _ = solver.corrected(ahead_value, guess, orbit.tangent)
        if ahead.tangent.dot(orbit.tangent) < 0.0:
            ahead = ahead.turned()
        before, orbit = at, ahead
        if abs(step) <= _THERE:
            return orbit
    raise Lost(f"no {kind} was found near")
