"""How folds, doublings and tori of nonlinear branches move with the numbers of a machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

import numpy as np

from ..core.errors import bad
from ..core.families import Array, Nonlinear
from ..nonlinear.orbit import EPS, FAILURES, Orbit
from ..nonlinear.response import ResponseCurve
from ..nonlinear.segments import Motion, Problem, chained, sweep
from ..scenes import Scene, with_numbers
from .coefficient_changes import PLACES, SMALL_STEP, SPEED, checked_names, difference_weights

_Differences: TypeAlias = tuple[Array, Array]

# The largest change of a motion within the differences of its multipliers, over its size; and what
# round-off leaves of a step.
_MOVED, _ROUNDING = 0.02, 0.25 * EPS


class Slope(NamedTuple):
    """A derivative and its error."""

    value: float
    error: float


@dataclass(frozen=True)
class Number:
    """A number of the machine, or the parameter of the curve: what its changes make."""

    value: float  # what it is
    # Change of the number to a problem, and to the change of the curve's parameter.
    at: Callable[[float], tuple[Problem, float]]
    step: float  # step of differences by it
    one_sided: bool = False  # whether it can only grow

    def slope(self, of: Callable[[Problem, float, float], Array], step: float) -> _Differences:
        """Return the derivative of a function of problem, change of the parameter and of itself.

        By differences of eighth order, and how far those of sixth order are from them.
        """
        places = PLACES - PLACES[0] * self.one_sided
        table = np.stack([of(*self.at(step * place), step * place) for place in places])
        first, second = (
            np.tensordot(difference_weights(tuple(places), unused) / step, table, axes=1)
            for unused in (0, 1)
        )
        return first, np.abs(first - second)


def special_numbers(machine: object, curve: ResponseCurve, by: Sequence[str]) -> list[Number]:
    """Return the numbers of a machine by their names, for a response curve of it."""
    problem = curve.source.problem
    system = machine.system() if isinstance(machine, Scene) else machine
    fix = "take the machine that the curve was computed for"
    if not isinstance(system, Nonlinear):
        raise bad("machine", type(system).__name__, "a nonlinear system, or a scene of one", fix)
    if system.parameters != problem.system.parameters:
        raise bad("machine", "other parameters than those of the curve", "its own", fix)
    known = [SPEED, *sorted(system.parameters)]
    known.remove(curve.parameter)
    return [_number(machine, problem, name) for name in checked_names(machine, known, by)]


def _number(machine: object, problem: Problem, name: str) -> Number:
    system = problem.system
    if name == SPEED:
        speed = problem.speed
        return Number(speed, lambda x: (replace(problem, speed=speed + x), 0.0), SMALL_STEP * speed)
    if name in system.parameters:
        value = system.parameters[name]

        def moved(change: float) -> tuple[Problem, float]:
            # Not within its limits: a damping that is 0 goes below.
            parameters = {**system.parameters, name: value + change}
            return replace(problem, system=replace(system, parameters=parameters)), 0.0

        return Number(value, moved, SMALL_STEP * (abs(value) or 1.0))
    assert isinstance(machine, Scene)
    scene, value = machine, float(machine.get(name))

    def made(change: float) -> tuple[Problem, float]:
        other = with_numbers(scene, {name: value + change}).system()
        assert isinstance(other, Nonlinear)
        return replace(problem, system=other), 0.0

    return Number(value, made, SMALL_STEP * (abs(value) or 1.0), one_sided=not value)


def special_slopes(curve: ResponseCurve, numbers: list[Number]) -> tuple[Array, Array]:
    """Return derivatives of special points by numbers and their errors, ``(p, k)`` each.

    At a fold, where a row p closes no motion, ``p (M - 1) = 0``, the parameter moves as ``p dG``
    vanishes, G being what lacks for a motion to close; at doublings and tori as a multiplier, the
    motion moving with the numbers, stays on the unit circle.  NaN at branch points.
    """
    shape = (len(curve.special), len(numbers))
    found, error = np.full(shape, np.nan), np.full(shape, np.inf)
    for i, (kind, orbit) in enumerate(zip(curve.special, curve.special_orbits, strict=True)):
        if kind == "branch point":
            continue
        every = [_own(curve.source.problem, orbit.value), *numbers]
        rows, fewer = _moves(kind, orbit, every), [np.nan] * len(every)
        with suppress(*FAILURES):
            motion = orbit.motion.with_stages(orbit.motion.a.shape[1] - 1)
            other, _ = curve.source.corrected(orbit.value, motion, orbit.tangent)
            fewer = [row.value for row in _moves(kind, other, every)]
        for j, (row, rough) in enumerate(zip(rows[1:], fewer[1:], strict=True)):
            found[i, j], gap = row.value, abs(row.value - rough)
            error[i, j] = row.error + (gap if np.isfinite(gap) else np.inf)
    return found, error


def _own(problem: Problem, value: float) -> Number:
    """Return the parameter of the curve as a number."""
    return Number(value, lambda x: (problem, x), SMALL_STEP * (abs(value) or 1.0))


def _moves(kind: str, orbit: Orbit, numbers: list[Number]) -> list[Slope]:
    """Return by how much the parameter of the curve moves with numbers, itself the first."""
    if kind == "fold":
        left, _, _ = np.linalg.svd(orbit.matrix - np.eye(len(orbit.matrix)))
        effects = [_closing(orbit, number, left[:, -1]) for number in numbers]
    else:
        effects = [_leaving(kind, orbit, number) for number in numbers]
    pace = effects[0]
    moves = [-effect.value / pace.value for effect in effects]
    return [
        Slope(move, (effect.error + abs(move) * pace.error) / abs(pace.value))
        for move, effect in zip(moves, effects, strict=True)
    ]


def _gaps(orbit: Orbit, number: Number) -> tuple[Array, Array, Array]:
    """Return what a number adds to the states at all ends, and to the accelerations."""
    # And the error of the states at the last end.
    motion = orbit.motion

    def lacking(problem: Problem, change: float, _along: float) -> Array:
        swept = sweep(problem, orbit.value + change, motion)
        added = chained(swept.maps, swept.loads)[1]
        return np.concatenate([added[..., 0].ravel(), swept.stage_loads[..., 0].ravel()])

    slope, rough = number.slope(lacking, number.step)
    ends = orbit.added[..., 0].size
    size = len(orbit.matrix)
    rounding = _ROUNDING * len(motion.x) * orbit.tangent.scale / number.step
    states = slope[:ends].reshape(-1, size)
    return states, slope[ends:].reshape(motion.a.shape), rough[ends - size : ends] + rounding


def _closing(orbit: Orbit, number: Number, row: Array) -> Slope:
    """Return what a row says of the gap that a number opens."""
    states, _, error = _gaps(orbit, number)
    return Slope(float(row @ states[-1]), float(np.abs(row) @ error))


def _leaving(kind: str, orbit: Orbit, number: Number) -> Slope:
    """Return the derivative of the logarithm of a multiplier's size, the motion moving along."""
    values, vectors = orbit.eigen
    upper = np.where(values.imag > 0.0, np.abs(np.log(np.abs(values))), np.inf)
    place = int(np.argmin(np.abs(values + 1.0) if kind == "doubling" else upper))
    right, left = vectors[:, place], np.linalg.inv(vectors)[place]
    states, accelerations, error = _gaps(orbit, number)
    closing = np.eye(len(orbit.matrix)) - orbit.matrix
    change = orbit.whole[:-1] @ np.linalg.solve(closing, states[-1]) + states[:-1]
    bent = accelerations + (orbit.swept.response @ change[:, None, :, None])[..., 0]
    scale = orbit.tangent.scale
    size = float(np.max(np.abs(change) / scale))
    step = min(number.step, _MOVED / size) if size else number.step

    def multiplier(problem: Problem, moved: float, along: float) -> Array:
        motion: Motion = orbit.motion.moved(along * change, along * bent)
        swept = sweep(problem, orbit.value + moved, motion)
        whole, _ = chained(swept.maps, swept.loads)
        return np.asarray((left @ whole[-1] @ right) / values[place])

    slope, rough = number.slope(multiplier, step)
    # Multipliers are known to round-off over the step, and move with the motion.
    sizes = float(np.linalg.norm(left)) * float(np.linalg.norm(orbit.matrix))
    rounding = _ROUNDING * len(orbit.motion.x) * sizes / step
    off = float(np.max(np.abs(np.linalg.solve(closing * scale, error)))) / max(size, 1.0)
    return Slope(float(slope.real), float(rough) + rounding + off * float(np.abs(slope)))
