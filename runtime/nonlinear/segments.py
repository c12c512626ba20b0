"""Motions over some revolutions as collocation steps, all of them evaluated and linearised at once.

The independent variable is the angle of the drive.  With x and v = dx/dtheta at the beginning of
each step and the accelerations a = d^2x/dtheta^2 at its Gauss points, what is left of the equations
at the points and the gaps between the steps are to vanish.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..constrained.collocation import Nodes, at_places, nodes, stage_matrix
from ..core.errors import SelfCheckFailed
from ..core.families import Array
from ..core.families.nonlinear import Drive, Nonlinear, Varied

# Relative step of the differences by a parameter: rounding and second derivatives leave 1e-8, which
# slows Newton's iteration by as much and turns the tangent by as much.
_DIFFERENCE = 2.0**-26
# Numbers of a batch of matrices that stay in a cache while they are solved, and states that are
# evaluated at once: temporary arrays of many more cost three times as much a state.
_CACHED, _ROWS = 1 << 18, 256


@dataclass(frozen=True)
class Problem:
    """A system whose parameter ``name`` is varied: of the system, or the ``speed`` of the drive."""

    system: Nonlinear
    name: str
    speed: float  # [rad/s], where it is not what is varied

    def at(self, value: float) -> tuple[float, Mapping[str, float]]:
        """Return speed and parameters at a value of what is varied."""
        if self.name == "speed":
            return value, self.system.parameters
        return self.speed, {**self.system.parameters, self.name: value}


@dataclass(frozen=True)
class Motion:
    """A motion as collocation steps of one length, each from a state of its own.

    Several runs over the same angles stand one behind the other.
    """

    turns: int  # revolutions over which the steps go
    # x, v: (m, n): states at the beginnings of the steps
    x: Array
    v: Array
    a: Array  # (m, s, n): accelerations at the Gauss points of each step
    begin: float = 0.0  # angle of the drive at the beginning [rad]
    runs: int = 1
    left: float = 0.0  # what its iteration may have left, relative
    # Of marched motions: derivatives of the ends by the beginnings, (runs, 2n, 2n).
    map: Array | None = None

    @property
    def span(self) -> float:
        """Angle over which the motion goes [rad]."""
        return 2.0 * np.pi * self.turns

    @property
    def step(self) -> float:
        """Length of a step [rad]."""
        return self.span * self.runs / len(self.x)

    @property
    def points(self) -> Nodes:
        """Nodes of a step."""
        return nodes(self.a.shape[1])

    @property
    def angles(self) -> Array:
        """Drive angles of the Gauss points [rad], shape ``(m, s)``."""
        start = np.arange(len(self.x) // self.runs)[:, None] + self.points.c
        return np.tile(self.begin + self.step * start, (self.runs, 1))

    @property
    def states(self) -> Array:
        """States at the beginnings of the steps, ``(m, 2n)``."""
        return np.concatenate([self.x, self.v], axis=1)

    def stages(self) -> tuple[Array, Array]:
        """Return coordinates and rates at the Gauss points, shape ``(m, s, n)``."""
        h, points = self.step, self.points
        x = self.x[:, None] + h * points.c[:, None] * self.v[:, None]
        return x + h * h * (points.twice @ self.a), self.v[:, None] + h * (points.once @ self.a)

    def ends(self) -> Array:
        """Return the states at the ends of the steps, shape ``(m, 2n)``."""
        h, b, c = self.step, self.points.b, self.points.c
        x = self.x + h * (self.v + h * ((b * (1.0 - c)) @ self.a))
        return np.concatenate([x, self.v + h * (b @ self.a)], axis=1)

    def at(self, angle: ArrayLike, run: int | NDArray[np.int64] = 0) -> tuple[Array, Array, Array]:
        """Return coordinates, rates and accelerations at angles ``(k,)`` from the beginning.

        Of the first run, or of one for each angle.
        """
        within = np.atleast_1d(np.asarray(angle, dtype=float)) / self.step
        m = len(self.x) // self.runs
        j = np.clip(within.astype(int), 0, m - 1)
        part, h = within - j, self.step
        j = j + m * run
        terms = (self.points.series @ self.a)[j]
        values = at_places(part, terms.shape[1]) @ terms
        twice, once, value = values[:, 0], values[:, 1], values[:, 2]
        x = self.x[j] + h * part[:, None] * self.v[j] + h * h * twice
        return x, self.v[j] + h * once, value

    def with_stages(self, stages: int) -> Motion:
        """Return the motion on other stages of the same steps."""
        _, values = _at_stages(self.a.shape[1], stages)
        return replace(self, a=values @ self.a)

    def at_stages(self, stages: int) -> Array:
        """Return the coordinates at the points of so many stages, ``(m, stages, n)``."""
        h, twice = self.step, _at_stages(self.a.shape[1], stages)[0]
        x = self.x[:, None] + h * nodes(stages).c[:, None] * self.v[:, None]
        return np.asarray(x + h * h * (twice @ self.a))

    def resampled(self, steps: int, stages: int, turns: int | None = None) -> Motion:
        """Return the motion on other steps; on more turns it is repeated."""
        turns = self.turns if turns is None else turns
        h = 2.0 * np.pi * turns / steps
        begin = h * np.arange(steps)
        inner = begin[:, None] + h * nodes(stages).c
        x, v, _ = self.at(begin % self.span)
        a = self.at(inner.ravel() % self.span)[2].reshape(steps, stages, -1)
        return Motion(turns, x, v, a, self.begin)

    def moved(self, states: Array, a: Array) -> Motion:
        """Return the motion with changes of its states and accelerations."""
        n = self.x.shape[1]
        x, v = self.x + states[:, :n], self.v + states[:, n:]
        return replace(self, x=x, v=v, a=self.a + a)

    def run(self, number: int) -> Motion:
        """Return one of several runs."""
        m = len(self.x) // self.runs
        at = slice(number * m, (number + 1) * m)
        return replace(self, x=self.x[at], v=self.v[at], a=self.a[at], runs=1)

    @staticmethod
    def together(motions: Sequence[Motion]) -> Motion:
        """Return motions over the same angles and as many steps as runs of one."""
        x, v, a = (np.concatenate([getattr(m, name) for m in motions]) for name in ("x", "v", "a"))
        return Motion(motions[0].turns, x, v, a, motions[0].begin, len(motions))

    @classmethod
    def rest(cls, system: Nonlinear, turns: int, steps: int, stages: int) -> Motion:
        """Return no motion at all."""
        n = system.size
        return cls(turns, np.zeros((steps, n)), np.zeros((steps, n)), np.zeros((steps, stages, n)))


@lru_cache(maxsize=16)
def _at_stages(stages: int, others: int) -> tuple[Array, Array]:
    """Return what accelerations at the points of stages are at those of others, ``(others, s)``."""
    # Integrated twice from the beginning of a step of length 1, and themselves.
    terms = at_places(nodes(others).c, stages) @ nodes(stages).series
    return terms[:, 0], terms[:, 2]


class Sweep(NamedTuple):
    """The steps of a motion linearised: what each passes on, and what is wrong with it.

    States are ``(x, v)``.  ``loads`` are what is added at the end of each step: in its first
    column the gap to the next one, stages corrected; then by the parameter, where it is wanted.
    """

    maps: Array  # (m, 2n, 2n)
    loads: Array  # (m, 2n, k)
    stage_loads: Array  # (m, s, n, k): the same for the accelerations at the points
    response: Array  # (m, s, n, 2n): derivative of these accelerations by the beginning
    by_parameter: Array  # (m, s, n, 1 or 0): derivative of the residual by the parameter

    def runs(self, number: int) -> list[Sweep]:
        """Return the steps of each of so many runs."""
        if number == 1:
            return [self]
        return [Sweep(*parts) for parts in zip(*(np.split(a, number) for a in self), strict=True)]


class NotFinite(ArithmeticError):  # noqa: N818 - reads as what it is
    """The equations cannot be evaluated along a motion."""


class Ramp(NamedTuple):
    """The acceleration of a drive [rad/s^2], and the angle at which it has its speed."""

    acceleration: float
    begin: float = 0.0


@np.errstate(all="ignore")
def evaluated(
    problem: Problem,
    value: float | Array,
    angles: Array,
    states: tuple[Array, Array, Array],
    *,
    derivatives: bool = True,
    ramp: Ramp | None = None,
) -> Varied:
    """Return residual and derivatives at drive angles, over the speed squared, by the angle.

    ``value``: one, or one of each run, ``(runs,)``.  ``angles``: ``(m, s)``; ``states``: x, v and
    a there, ``(m, s, n)`` each.
    """
    varied = problem.name == "speed"
    speed = _of_steps(value, len(angles))[..., None] if varied else problem.speed
    rise = ramp.acceleration if ramp else 0.0
    since = angles - ramp.begin if ramp else np.zeros_like(angles)
    batch, n = angles.shape, problem.system.size
    # One row of states, which arrays are quickest with.
    x, v, a = (part.reshape(-1, n) for part in states)
    square = np.maximum(speed**2 + 2.0 * rise * since, 0.0).reshape(-1, 1)
    w: Array = np.sqrt(square)
    rates, accelerations = w * v, square * a + rise * v

    # Parameters are numbers: states of one value of them are evaluated at once.
    values = np.atleast_1d(value)
    alike = len(x) if varied else len(x) // len(values)

    def part_of(first: int) -> Varied:
        at = slice(first, min(first + _ROWS, (first // alike + 1) * alike))
        angle = angles.ravel()[at]
        drive = Drive(angle, w[at, 0], np.full_like(angle, rise))
        _, parameters = problem.at(float(values[first // alike]))
        return problem.system.equations(
            x[at], rates[at], accelerations[at], drive, parameters, derivatives
        )

    firsts = (i for k in range(0, len(x), alike) for i in range(k, k + alike, _ROWS))
    try:
        parts = [part_of(first) for first in firsts]
    except (SelfCheckFailed, np.linalg.LinAlgError) as lost:
        raise NotFinite(str(lost)) from lost
    found = parts[0] if len(parts) == 1 else Varied(*map(np.concatenate, zip(*parts, strict=True)))
    residual = (found.residual / square).reshape(*batch, n)
    if not np.all(np.isfinite(residual)):
        raise NotFinite("the equations are not finite along the motion")
    if not derivatives:
        return Varied(residual)
    w, square = w[..., None], square[..., None]
    damping = found.damping / w + found.mass * (rise / square)
    matrices = (found.mass, damping, found.stiffness / square)
    return Varied(residual, *(matrix.reshape(*batch, n, n) for matrix in matrices))


def _of_steps(value: float | Array, steps: int) -> Array:
    """Return a value for each step, ``(m,)``, of one, or of one of each run."""
    values = np.atleast_1d(value)
    return np.repeat(values, steps // len(values))


@np.errstate(all="ignore")  # what is not finite is refused
def sweep(
    problem: Problem,
    value: float | Array,
    motion: Motion,
    *,
    by_parameter: bool | Array = False,
    ramp: Ramp | None = None,
    periodic: bool = True,
) -> Sweep:
    """Linearise all steps of a motion at once, at one value or at one of each run, ``(runs,)``.

    ``by_parameter``: whether the derivative by the parameter is wanted, or what it was at a motion
    nearby, as it is returned.  The ends are to meet the beginnings of the next steps, round the
    period unless the motion is not ``periodic``.
    """
    angles, states = motion.angles, (*motion.stages(), motion.a)
    found = evaluated(problem, value, angles, states, ramp=ramp)
    columns = [found.residual[..., None]]
    if by_parameter is True:
        moved = _by_parameter(problem, value, angles, states, found.residual)
        columns.append(moved[..., None])
    elif by_parameter is not False:
        columns.append(by_parameter)
    m, s, n = motion.a.shape
    h, points = motion.step, motion.points
    try:
        right = np.concatenate([*columns, found.stiffness, found.damping], axis=-1)
        solved = -np.linalg.solve(found.mass, right)
    except np.linalg.LinAlgError as singular:
        raise NotFinite("the mass matrix is singular along the motion") from singular
    k = len(columns)
    by_x, by_v = solved[..., k : k + n], solved[..., k + n :]
    late = (h * points.c)[:, None, None] * by_x + by_v
    right = np.concatenate([solved[..., :k], by_x, late], axis=-1).reshape(m, s * n, -1)
    stages = np.empty_like(right)
    chunk = max(_CACHED // (s * n) ** 2, 1)
    for first in range(0, m, chunk):
        part = slice(first, first + chunk)
        matrix = stage_matrix(by_x[part], by_v[part], h, points)
        stages[part] = np.linalg.solve(matrix, right[part])
    stages = stages.reshape(m, s, n, -1)
    flat = stages.reshape(m, s, -1)
    rise = (h * points.b) @ flat
    move = (h * h * points.b * (1.0 - points.c)) @ flat
    effect = np.concatenate([move.reshape(m, n, -1), rise.reshape(m, n, -1)], axis=1)
    maps = effect[..., k:] + np.eye(2 * n) + h * np.eye(2 * n, k=n)
    loads = effect[..., :k]
    by_run = (motion.runs, -1, 2 * n)
    begins = motion.states.reshape(by_run)
    gaps = motion.ends().reshape(by_run) - np.roll(begins, -1, axis=1)
    if not periodic:
        gaps[:, -1] = 0.0
    loads[..., 0] += gaps.reshape(m, 2 * n)
    by_value = columns[1] if k > 1 else np.empty((m, s, n, 0))
    return Sweep(maps, loads, stages[..., :k], stages[..., k:], by_value)


def _by_parameter(
    problem: Problem,
    value: float | Array,
    angles: Array,
    states: tuple[Array, Array, Array],
    residual: Array,
) -> Array:
    """Return the derivative of what :func:`evaluated` calls residual by the parameter."""
    step = _DIFFERENCE * np.where(value, np.abs(value), 1.0)
    ahead = evaluated(problem, value + step, angles, states, derivatives=False).residual
    return np.asarray((ahead - residual) / _of_steps(step, len(angles))[:, None, None])


@np.errstate(all="ignore")
def chained(maps: Array, loads: Array) -> tuple[Array, Array]:
    """Return the states at all ends by the first one: ``y[j] = whole[j] y[0] + added[j]``.

    Of maps ``(m, *batch, 2n, 2n)`` and loads ``(m, *batch, 2n, k)``; ``whole[0]`` is the identity,
    and the last of the m + 1 belongs to the end of the motion.
    """
    m, *batch, size, k = loads.shape
    both = np.empty((m + 1, *batch, size, size + k))
    both[0] = np.eye(size, size + k)
    for j in range(m):
        np.matmul(maps[j], both[j], out=both[j + 1])
        both[j + 1, ..., size:] += loads[j]
    return both[..., :size], both[..., size:]
