"""Step by step through a run of a machine, until its time, its revolutions or its motion end.

The unknowns are the crank angle and ``u = sqrt(J + flywheel) omega``: ``u^2 / 2`` is the kinetic
energy, and ``du/dt = (torque - load) / sqrt(J + flywheel)`` has no more in it than the power that
flows in.  A machine left to itself keeps its energy to round-off, whatever the steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from ..core.errors import BadInput, bad
from ..linkages.linkage import EPS, TURN, Array
from .one_freedom import OneFreedom

Status = Literal["finished", "stalled", "fold", "step limit"]
TorqueLaw: TypeAlias = Callable[[Any, Any, Any], Any]

# No crank turns as fast: a centimetre of it would outrun half the light.
_FASTEST = 1e9


@dataclass(frozen=True)
class Run:
    """A run as its integrator leaves it."""

    system: OneFreedom  # the machine
    # times, (n,), to angle, ``sqrt(J + flywheel) omega`` and work, (3, n); ``ts`` are
    # the ends of its steps
    solution: Any
    # status, message: how it ended
    status: Status
    message: str

    @property
    def times(self) -> Array:
        """Ends of the steps [s], shape (steps + 1,)."""
        return np.asarray(self.solution.ts)

    @property
    def end(self) -> float:
        """Its last time [s]."""
        return float(self.times[-1])

    @property
    def steps(self) -> int:
        """Accepted steps."""
        return self.times.size - 1

    def at(self, time: Array) -> tuple[Array, Array, Array]:
        """Return angle [rad], speed [rad/s], and work done on the machine [J]."""
        flat = np.asarray(self.solution(np.ravel(time)))
        angle, momentum, work = (row.reshape(np.shape(time)) for row in flat)
        inertia = self.system.coefficients(angle)[0] + self.system.flywheel
        return angle, momentum / np.sqrt(inertia), work

    def drift(self) -> tuple[float, float]:
        """Return the energy defect over the largest energy, and the angle [rad] it accounts for.

        At the ends of the steps and halfway, where interpolation adds its own.  An energy off by d
        puts the speed off by ``d / (J omega)``; near rest, a tenth of the greatest ``u`` stands
        for the present one.
        """
        middles = (self.times[1:] + self.times[:-1]) / 2.0
        times = np.sort(np.concatenate([self.times, middles]))
        angle, momentum, work = self.solution(times)
        potential = self.system.machine.potential_energy(angle)
        kinetic = momentum**2 / 2.0
        defect = np.abs((kinetic - kinetic[0]) + (potential - potential[0]) - work)
        size = float(max(np.max(kinetic), np.max(np.abs(work)), np.ptp(potential))) or 1.0
        least = 0.1 * float(np.max(np.abs(momentum))) or 1.0
        root = np.sqrt(self.system.coefficients(angle)[0] + self.system.flywheel)
        rate = defect / (np.maximum(np.abs(momentum), least) * root)
        gone = float(np.sum((rate[1:] + rate[:-1]) / 2.0 * np.diff(times)))
        return float(np.max(defect)) / size, gone


@dataclass(frozen=True)
class Goals:
    """Where a run ends, and what it may do."""

    # revolutions, duration: ends
    revolutions: float | None
    duration: float | None
    reversals: bool  # whether the run goes on where the crank turns back
    max_steps: int  # most steps


def integrate(
    system: OneFreedom,
    law: TorqueLaw,
    start: tuple[float, float],
    tolerance: float,
    longest: float,
    goals: Goals,
) -> Run:
    """Integrate until a goal is reached, the crank stalls or folds, or the steps are used up."""
    theta0, speed0 = start
    if not abs(speed0) < _FASTEST:
        raise _too_fast(speed0, 0.0)
    motion = _Motion(system, law)
    state = np.array([theta0, math.sqrt(motion.inertia(theta0)) * speed0, 0.0])
    if stuck := _cannot_start(system, law, theta0, speed0, goals.reversals):
        return Run(system, _Standing(state), "stalled", stuck)
    # What is too large overflows quietly here, and is refused by its speed.
    with np.errstate(over="ignore", invalid="ignore"):
        return _stepped(motion, state, tolerance, longest, goals)


def _stepped(motion: _Motion, state: Array, tolerance: float, longest: float, goals: Goals) -> Run:
    from scipy.integrate import DOP853, OdeSolution

    bound = np.inf if goals.duration is None else goals.duration
    scale = motion.scale(0.0, state)
    first = motion.longest_step(state, motion(0.0, state), longest)
    small: Any = tolerance * scale
    # The relative tolerance is left to the sizes: an angle of many turns is not allowed more.
    solver: Any = DOP853(motion, 0.0, state, bound, max_step=first, rtol=128.0 * EPS, atol=small)
    events = _Events(motion.system, state, goals)
    times: list[float] = [0.0]
    pieces: list[Any] = []
    status: Status = "finished"
    message = "the time is over"
    while solver.status == "running":
        if len(pieces) >= goals.max_steps:
            status, message = "step limit", f"{goals.max_steps} steps are used up"
            break
        solver.step()
        if solver.status == "failed":
            status, message = events.failed(solver.y)
            break
        piece = solver.dense_output()
        pieces.append(piece)
        ended = events.first(piece, solver.t_old, solver.t, solver.y)
        if ended is not None:
            end, status, message = ended
            times.append(end)
            break
        times.append(solver.t)
        scale = np.maximum(scale, motion.scale(solver.t, solver.y))
        solver.atol = tolerance * scale
        solver.max_step = motion.longest_step(solver.y, solver.f, longest)
    if not pieces:
        return Run(motion.system, _Standing(state), status, message)
    return Run(motion.system, OdeSolution(times, pieces), status, message)


@dataclass(frozen=True)
class _Standing:
    """A machine that does not move."""

    state: Array
    ts: tuple[float, ...] = (0.0,)

    def __call__(self, time: Array) -> Array:
        return np.repeat(self.state[:, np.newaxis], np.size(time), axis=1)


class _Motion:
    """Rates of crank angle, ``sqrt(J + flywheel) omega``, and work."""

    def __init__(self, system: OneFreedom, law: TorqueLaw) -> None:
        self.system, self.law = system, law
        self.inertia, self.loads = system.tables()

    def __call__(self, time: float, state: Array) -> Array:
        theta, momentum = float(state[0]), float(state[1])
        try:
            root = math.sqrt(self.inertia(theta))
        except BadInput:
            if self.system.machine.linkage.crank_turns:
                raise
            # A trial beyond the crank's range: the step is refused and shortened.
            return np.full(3, np.nan)
        speed = momentum / root
        if not abs(speed) < _FASTEST:
            raise _too_fast(speed, time)
        torque = float(self.law(speed, theta, time))
        required, lost = self.loads(theta, speed)
        return np.array([speed, (torque - required) / root, (torque - lost) * speed])

    def scale(self, time: float, state: Array) -> Array:
        """Return what angle, ``u`` and work are small against."""
        theta, momentum = float(state[0]), float(state[1])
        speed = momentum / math.sqrt(self.inertia(theta))
        torque = abs(float(self.law(speed, theta, time))) + abs(self.loads(theta, speed)[0])
        size = max(abs(momentum), math.sqrt(torque)) or 1.0
        return np.array([1.0, size, size**2])

    def longest_step(self, state: Array, rates: Array, angle: float) -> float:
        """Return the time [s] in which the crank turns by an angle, judged from here."""
        change = abs(float(rates[1])) / math.sqrt(self.inertia(float(state[0])))
        speed = abs(float(rates[0]))
        pace = speed + float(np.sqrt(speed * speed + 2.0 * change * angle))
        return 2.0 * angle / pace if 0.0 < pace < np.inf else np.inf


def _too_fast(speed: float, time: float) -> BadInput:
    reached = f"a crank speed of {speed:.3g} rad/s after {time:.3g} s"
    fix = "take a smaller torque or load, a shorter run, or check the units"
    return bad("run_up", reached, f"a speed below {_FASTEST:g} rad/s", fix)


def _cannot_start(
    system: OneFreedom, law: TorqueLaw, theta: float, speed: float, reversals: bool
) -> str:
    """Return why a machine at rest does not start in the motor's direction; '' where it does."""
    if speed != 0.0:
        return ""
    torque = float(law(0.0, theta, 0.0))
    change = float(system.acceleration(theta, 0.0, torque))
    if change == 0.0:
        return "at rest in equilibrium"
    if torque * change < 0 and not reversals:
        needed = float(system.load(theta, 0.0))
        return f"the motor's {torque:.4g} N m cannot start it against {needed:.4g} N m"
    return ""


class _Events:
    """What ends a run before its time."""

    def __init__(self, system: OneFreedom, state: Array, goals: Goals) -> None:
        self.theta, self.reversals = float(state[0]), goals.reversals
        self.goal = np.inf if goals.revolutions is None else TURN * goals.revolutions
        self.direction = float(np.sign(state[1]))
        self.range = system.range_about(self.theta)

    def failed(self, state: Array) -> tuple[Status, str]:
        """Return status and message where the integrator cannot go on."""
        low, high = self.range
        # Steps that fail this near to an end of the range failed because of it.
        if min(float(state[0]) - low, high - float(state[0])) < 1e-3:
            return "fold", "the crank came to an end of its range"
        return "step limit", "the steps became too short to go on: the torques are too uneven"

    def first(
        self, piece: Any, begin: float, end: float, state: Array
    ) -> tuple[float, Status, str] | None:
        """Return the first event in a step, if there is one: its time, status and message."""
        if self.direction == 0.0:
            self.direction = float(np.sign(state[1]))
        low, high = self.range
        # So near to an end of the crank's range the reduced inertia grows beyond all bounds.
        fold = 1e-6
        watched: dict[tuple[Status, str], Callable[[Array], float]] = {
            ("finished", "the revolutions are made"): (
                lambda y: abs(float(y[0]) - self.theta) - self.goal
            ),
            ("fold", "the crank came to an end of its range"): (
                lambda y: max(float(y[0]) - high, low - float(y[0])) + fold
            ),
        }
        if not self.reversals:
            watched["stalled", "the crank stalled"] = lambda y: -self.direction * float(y[1])
        events = [
            (_root(rule, piece, begin, end), *words)
            for words, rule in watched.items()
            if np.isfinite(rule(state)) and rule(state) > 0
        ]
        return min(events, key=lambda item: item[0], default=None)


def _root(rule: Callable[[Array], float], piece: Any, begin: float, end: float) -> float:
    from scipy.optimize import brentq

    if rule(piece(begin)) >= 0:
        return begin
    if rule(piece(end)) <= 0:
        return end
    return float(brentq(lambda time: rule(piece(time)), begin, end, xtol=1e-15 * end, rtol=1e-14))
