"""Marching with fixed steps through a linear periodic system, the steps of a revolution reused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..integrators import OneStep
from ..integrators import de_vogelaere as _de_vogelaere
from ..integrators.newmark import RULES, StepRule, acceleration, step_maps
from ..periodic.first_order import CanonicalForm
from ..periodic.transition import product as ordered_product
from .second_order import second_order_at
from .spring_form import spring_generator

Array = NDArray[np.float64]
Tick = Callable[[int], None]

# Steps whose matrices are held at a time while they are multiplied together.
_STEPS_TOGETHER = 4096
# Most steps in a revolution, and given angles in a march.
MOST_STEPS = 2**22
MOST_INTERVALS = 2**25
# Growth within a revolution up to which the revolution's flows serve as they are.
MODERATE = 1e8


@dataclass(frozen=True)
class Grid:
    """Crank angles at which the solution is given, and the steps between them.

    Attributes
    ----------
    start : float
        First crank angle [rad].
    per_revolution : int
        Intervals between given angles in a revolution.
    intervals : int
        Number of intervals in all.
    substeps : int
        Steps in an interval.
    """

    start: float
    per_revolution: int
    intervals: int
    substeps: int

    @property
    def theta(self) -> Array:
        """Crank angles [rad], shape ``(intervals + 1,)``."""
        turns = np.arange(self.intervals + 1, dtype=np.float64) / self.per_revolution
        return self.start + turns * (2 * pi)

    @property
    def step(self) -> float:
        """Length of a step [rad]."""
        return 2 * pi / (self.per_revolution * self.substeps)

    @property
    def steps(self) -> int:
        """Steps in a revolution."""
        return self.per_revolution * self.substeps


def make_grid(start: float, revolutions: float, samples: int, steps: int) -> Grid:
    """Return the grid with at most ``samples`` given angles a revolution and ``steps`` steps.

    Every k-th step is given, k being the largest divisor of ``steps`` that leaves at least
    ``samples``; all are given where there are fewer steps than samples.
    """
    largest = max(1, steps // samples)
    substeps = next(k for k in range(largest, 0, -1) if steps % k == 0)
    per_revolution = steps // substeps
    return Grid(start, per_revolution, max(1, round(revolutions * per_revolution)), substeps)


def cyclic(form: CanonicalForm) -> bool:
    """Return True where the coefficients repeat with every revolution."""
    turns = 2 * pi / form.system.period
    return form.constant or abs(turns - round(turns)) < 1e-12 * turns


@dataclass(frozen=True)
class March:
    """States along a march.

    Attributes
    ----------
    q, slope : ndarray
        Coordinates and their derivatives d/dtheta at the given angles, shape ``(reached, n)``.
    volume : float or None
        Logarithm of the determinant of the steps' product over the march; None for a method
        whose state is not the system's.
    defect : float
        Largest defect of ``X^T J X = J`` over ``|X|^2`` of an interval; nan where not canonical.
    """

    q: Array
    slope: Array
    volume: float | None
    defect: float


def march(
    method: OneStep,
    form: CanonicalForm,
    grid: Grid,
    q: Array,
    slope: Array,
    bound: float,
    tick: Tick | None = None,
) -> March:
    """March a single system from a start; stop where a coordinate passes a bound.

    Parameters
    ----------
    method : OneStep
        The method.
    form : CanonicalForm
        A batch of one.
    grid : Grid
        Angles and steps.
    q, slope : ndarray
        Coordinates and d/dtheta at the start, shape ``(n,)``.
    bound : float
        Where to stop: the first state beyond is the last that is given, if it is finite.
    tick : callable, optional
        Told the number of intervals done.
    """
    if method.name == "de_vogelaere":
        return _march_de_vogelaere(form, grid, q, slope, bound, tick)
    if method.name in RULES:
        return _march_second_order(RULES[method.name], form, grid, (q, slope), bound, tick)
    n = form.system.size
    generator = partial(generator_of_one, form)

    def maps(theta: Array) -> Array:
        return method.maps(generator, theta, grid.step)

    state = scaled_state(form, grid.start, q, slope)
    runner = _Runner(maps, grid, cyclic(form), bound / form.scale[0][:n])
    states = runner.run(state, tick)
    coordinates, slopes = unscaled(form, grid.theta[: len(states)], states)
    return March(coordinates, slopes, runner.volume(2 * n), runner.defect(n))


def generator_of_one(form: CanonicalForm, theta: Array) -> Array:
    """Return the generator of a batch of one at angles ``(nt,)``: ``(nt, m, m)``."""
    value: Array = form.generator(theta)[0]
    return value


def scaled_state(form: CanonicalForm, theta: float, q: Array, slope: Array) -> Array:
    """Return the canonical state of a batch of one, over its scale.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    theta : float
        Crank angle [rad].
    q, slope : ndarray, shape (n,)
        Coordinates and their derivatives by the crank angle.
    """
    n = form.system.size
    state = np.ones(form.size)
    state[: 2 * n] = np.concatenate([q, form.momentum(theta, q, slope)]) / form.scale[0][: 2 * n]
    return state


def unscaled(form: CanonicalForm, theta: Array, states: Array) -> tuple[Array, Array]:
    """Return coordinates and their derivatives by the crank angle, ``(nt, n)`` each.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    theta : ndarray, shape (nt,)
        Crank angles [rad].
    states : ndarray, shape (nt, m)
        As :func:`scaled_state` gives them.
    """
    n, scale = form.system.size, form.scale[0]
    coordinates = states[:, :n] * scale[:n]
    return coordinates, form.slope(theta, coordinates, states[:, n : 2 * n] * scale[n : 2 * n])


def _march_de_vogelaere(
    form: CanonicalForm, grid: Grid, q: Array, slope: Array, bound: float, tick: Tick | None
) -> March:
    n = form.system.size
    m = n + int(form.forced)
    spring = spring_generator(form)
    half = grid.step / 2

    def generator(theta: Array) -> Array:
        value: Array = spring(theta)[0]
        return value

    def maps(theta: Array) -> Array:
        return _de_vogelaere.maps(generator, theta, half)

    one = np.ones(m - n)
    state = _de_vogelaere.start(
        generator, grid.start, half, np.concatenate([q, one]), np.concatenate([slope, 0 * one])
    )
    states = _Runner(maps, grid, cyclic(form), np.full(n, bound)).run(state, tick)
    return March(states[:, :n], states[:, m : m + n] / half, None, float("nan"))


def _march_second_order(
    rule: StepRule,
    form: CanonicalForm,
    grid: Grid,
    start: tuple[Array, Array],
    bound: float,
    tick: Tick | None,
) -> March:
    n = form.system.size

    def arrays(theta: Array) -> list[Array]:
        found = second_order_at(form, theta)
        force = found.force[0] if form.forced else np.zeros_like(found.force[0])
        parts = (found.mass[0], found.rate[0], found.stiffness[0], force)
        return [np.broadcast_to(a, (len(theta), *a.shape[1:])) for a in parts]

    def maps(theta: Array) -> Array:
        ends = np.append(theta, theta[-1] + grid.step)
        mass, rate, stiffness, force = arrays(ends)
        return step_maps(rule, mass, rate, stiffness, force, grid.step)

    state = np.concatenate([*start, [1.0]])
    if rule.carries_acceleration:
        mass, rate, stiffness, force = arrays(np.array([grid.start]))
        first = acceleration(mass, rate, stiffness, force)[0] @ state
        state = np.concatenate([*start, first, [1.0]])
    states = _Runner(maps, grid, cyclic(form), np.full(n, bound)).run(state, tick)
    # The determinant of these steps is not that of the canonical state.
    return March(states[:, :n], states[:, n : 2 * n], None, float("nan"))


def up_to(states: Array, bound: Array) -> tuple[Array, bool]:
    """Return states up to the first beyond a bound, and whether there is one.

    Parameters
    ----------
    states : ndarray, shape (nt, m)
        In the order of the march.
    bound : ndarray, shape (n,)
        Of the first n components: the first state beyond is the last one kept, if it is finite.
    """
    passed = np.any(np.abs(states[:, : len(bound)]) > bound, axis=1)
    broken = ~np.all(np.isfinite(states), axis=1)
    if not np.any(passed | broken):
        return states, False
    last = int(np.argmax(passed | broken))
    return states[: last if broken[last] else last + 1], True


class _Runner:
    """Matrices of the intervals of one revolution, made once where they repeat."""

    def __init__(
        self, maps: Callable[[Array], Array], grid: Grid, repeats: bool, bound: Array
    ) -> None:
        self._maps = maps
        self._grid = grid
        self._repeats = repeats
        self._bound = bound
        self._block: Array | None = None
        self._flows: Array | None = None

    def run(self, state: Array, tick: Tick | None) -> Array:
        """Return the states at the given angles, fewer where a coordinate passed the bound."""
        grid = self._grid
        pieces = [state[None]]
        done = 0
        while done < grid.intervals:
            number = min(grid.per_revolution, grid.intervals - done)
            if self._block is None or not self._repeats:
                self._block = self._intervals(done, number)
                self._flows = _flows(self._block)
            piece = self._advance(state, number)
            piece, stopped = up_to(piece, self._bound)
            pieces.append(piece)
            if stopped:
                break
            state = piece[-1]
            done += number
            if tick is not None:
                tick(done)
        return np.concatenate(pieces)

    def volume(self, size: int) -> float:
        """Return the logarithm of the determinant over the whole march."""
        if self._block is None:
            return 0.0
        _, logarithm = np.linalg.slogdet(self._block[:, :size, :size])
        return float(np.mean(logarithm)) * self._grid.intervals

    def defect(self, n: int) -> float:
        """Return the largest relative symplectic defect of an interval."""
        if self._block is None:
            return 0.0
        return symplectic_defect(self._block, n)

    def _intervals(self, done: int, number: int) -> Array:
        grid = self._grid
        together = max(1, _STEPS_TOGETHER // grid.substeps)
        blocks = []
        for left in range(0, number, together):
            count = min(together, number - left)
            first = grid.start + (done + left) * grid.substeps * grid.step
            theta = first + grid.step * np.arange(count * grid.substeps, dtype=np.float64)
            matrices = self._maps(theta)
            m = matrices.shape[-1]
            product, power = ordered_product(matrices.reshape(count, grid.substeps, m, m))
            blocks.append(np.ldexp(product, power[:, None, None]))
        return np.concatenate(blocks)

    def _advance(self, state: Array, number: int) -> Array:
        if self._flows is not None:
            ahead: Array = self._flows[:number] @ state
            return ahead
        states = np.empty((number, len(state)))
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(number):
                state = self._block[k] @ state  # type: ignore[index]
                states[k] = state
        return states


def symplectic_defect(maps: Array, n: int) -> float:
    """Return the largest defect of ``X^T J X = J`` over ``|X|^2`` of matrices ``(k, m, m)``."""
    part = maps[:, : 2 * n, : 2 * n]
    unit = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))
    gap = np.swapaxes(part, -1, -2) @ unit @ part - unit
    norm = np.linalg.norm(part, axis=(-2, -1))
    return float(np.max(np.linalg.norm(gap, axis=(-2, -1)) / norm**2))


def _flows(block: Array) -> Array | None:
    """Return the matrices from the start of a revolution to each angle; None where they grow."""
    flows = np.empty_like(block)
    flow = np.eye(block.shape[-1])
    with np.errstate(over="ignore", invalid="ignore"):
        for k, matrix in enumerate(block):
            flow = matrix @ flow
            flows[k] = flow
    return flows if np.max(np.abs(flows)) <= MODERATE else None


def steps_for(form: CanonicalForm, phase: float, samples: int) -> int:
    """Return a multiple of ``samples`` steps a revolution, of at most ``phase`` radians each.

    Raises
    ------
    BadInput
        If a revolution needs more than four million steps.
    """
    # The highest harmonic of a coefficient is seen four times a wave by the eight angles of a
    # reference step (phase 1), more often by the shorter steps.
    fastest = max(float(form.rate[0]), form.reach / (2 * form.system.period))
    wanted = 2 * pi * fastest / (phase * samples)
    if not wanted * samples <= MOST_STEPS:
        raise bad(
            "speed",
            f"{float(form.speed[0]):.6g} rad/s, where a revolution needs "
            f"{wanted * samples:.3g} steps",
            f"at most {MOST_STEPS} steps a revolution",
            "raise the speed or leave out the highest modes",
        )
    return samples * max(1, ceil(wanted))
