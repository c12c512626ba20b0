"""Forward dynamics: how a machine runs under a motor torque.

The unknowns are the crank angle and ``u = sqrt(J + flywheel) omega``: ``u^2 / 2`` is the kinetic
energy, and ``du/dt = (torque - load) / sqrt(J + flywheel)`` has no more in it than the power that
flows in.  A machine left to itself keeps its energy to round-off, whatever the steps.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from numbers import Real
from typing import Any, ClassVar, Literal, TypeAlias

import numpy as np

from ..core.errors import BadInput, Problem, bad, refuse, shown
from ..core.files import NOT_SAVED
from ..core.inputs import is_finite, is_whole, number_problems
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Deferred, DeferredChecks, DeferredField, Result, provenance
from ..linkages.linkage import EPS, TURN, Array
from .forces import RigidForces, rigid_forces
from .machine import Machine, finite_number, require_machine
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


# What is too large overflows quietly here, and is refused by its speed.
@np.errstate(over="ignore", invalid="ignore")
def integrate(
    system: OneFreedom,
    law: TorqueLaw,
    start: tuple[float, float],
    tolerance: float,
    longest: float,
    goals: Goals,
) -> Run:
    """Integrate until a goal is reached, the crank stalls or folds, or the steps are used up."""
    from scipy.integrate import DOP853, OdeSolution

    theta0, speed0 = start
    if not abs(speed0) < _FASTEST:
        raise _too_fast(speed0, 0.0)
    motion = _Motion(system, law)
    state = np.array([theta0, math.sqrt(motion.inertia(theta0)) * speed0, 0.0])
    if stuck := _cannot_start(system, law, theta0, speed0, goals.reversals):
        return Run(system, _Standing(state), "stalled", stuck)
    bound = np.inf if goals.duration is None else goals.duration
    scale = motion.scale(0.0, state)
    first = motion.longest_step(state, motion(0.0, state), longest)
    small: Any = tolerance * scale
    # The relative tolerance is left to the sizes: an angle of many turns is not allowed more.
    solver: Any = DOP853(motion, 0.0, state, bound, max_step=first, rtol=128.0 * EPS, atol=small)
    events = _Events(system, state, goals)
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
        return Run(system, _Standing(state), status, message)
    return Run(system, OdeSolution(times, pieces), status, message)


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
        self.direction = self.direction or float(np.sign(state[1]))
        low, high = self.range
        # So near to an end of the crank's range the reduced inertia grows beyond all bounds.
        fold = 1e-6
        made, ended = "the revolutions are made", "the crank came to an end of its range"
        watched: list[tuple[Callable[[Array], float], Status, str]] = [
            (lambda y: abs(float(y[0]) - self.theta) - self.goal, "finished", made),
            (lambda y: max(float(y[0]) - high, low - float(y[0])) + fold, "fold", ended),
        ]
        if not self.reversals:
            stalled = "the crank stalled"
            watched.append((lambda y: -self.direction * float(y[1]), "stalled", stalled))
        events = [
            (_root(rule, piece, begin, end), status, message)
            for rule, status, message in watched
            if 0.0 < rule(state) < np.inf
        ]
        return min(events, key=lambda item: item[0], default=None)


def _root(rule: Callable[[Array], float], piece: Any, begin: float, end: float) -> float:
    from scipy.optimize import brentq

    if rule(piece(begin)) >= 0:
        return begin
    if rule(piece(end)) <= 0:
        return end
    return float(brentq(lambda time: rule(piece(time)), begin, end, xtol=1e-15 * end, rtol=1e-14))


_LONGEST = TURN / 24.0
_LATER = DeferredField()


@dataclass(frozen=True, kw_only=True)
class RunUp(Result):
    """A run of a machine under a motor torque; arrays over the times.

    ``error`` is that of the crank angle [rad]: how far a run of longer steps and more
    tolerance departs, and the angle that the energy gone astray accounts for.

    Attributes
    ----------
    machine : Machine
        What runs.
    time, angle, speed, acceleration : ndarray, shape (n,)
        Time [s], crank angle [rad], speed [rad/s] and acceleration [rad/s^2].
    torque : ndarray, shape (n,)
        Motor torque [N m].
    energy : ndarray, shape (n,)
        Kinetic and potential energy [J], that of the flywheel among them.
    flywheel : float
        Inertia [kg m^2] added to the crank.
    status : {"finished", "stalled", "fold", "step limit"}
        Finished: the wanted time or number of revolutions is over.  Stalled: the crank came to
        rest, or the motor cannot start it.  Fold: the crank came to an end of its range.
    message : str
        The same in a sentence.
    steps : int
        Steps of the integrator.
    fluctuation : float or None
        Speed fluctuation in the last revolution, (greatest - least) / mean of the two, computed
        when it is first looked at; None where the run made less than a revolution.
    """

    machine: Machine
    time: Array
    angle: Array
    speed: Array
    acceleration: Array
    torque: Array
    energy: Array
    flywheel: float
    status: Status
    message: str
    steps: int
    fluctuation: Any = _LATER  # float | None
    run: Run = field(repr=False, compare=False, metadata=NOT_SAVED)

    arrays_along: ClassVar = {"time": "time angle speed acceleration torque energy"}

    exported: ClassVar[tuple[str, ...]] = ("revolutions",)
    column_units: ClassVar = {"rad": "error"}

    @property
    def revolutions(self) -> float:
        """Revolutions made, negative backwards."""
        return float((self.angle[-1] - self.angle[0]) / (2.0 * np.pi))

    def at(self, time: Any) -> tuple[Array, Array]:
        """Return crank angle [rad] and speed [rad/s] at times [s] within the run.

        Raises ``BadInput`` if a time is outside.
        """
        times = np.asarray(time, dtype=float)
        if not np.all((times >= self.time[0]) & (times <= self.time[-1])):
            expected = f"times from {self.time[0]:g} to {self.time[-1]:g} s"
            raise bad("RunUp.at", "a time outside the run", expected, "correct it")
        angle, speed, _ = self.run.at(times)
        return angle, speed

    def forces(self) -> RigidForces:
        """Return pin forces, shaking force and moment along the run.

        Its torque is that of the links alone; what the motor gives to the flywheel comes in
        addition.
        """
        return rigid_forces(self.machine, self.angle, self.speed, self.acceleration)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the crank speed over time."""
        ax = axes_or_new(ax)
        ax.plot(self.time, self.speed)
        ax.set(xlabel="time [s]", ylabel="crank speed [rad/s]")
        return ax


def run_up(
    machine: Machine,
    torque: TorqueLine | TorqueLaw | float,
    *,
    revolutions: float | None = None,
    duration: float | None = None,
    speed0: float = 0.0,
    theta0: float = 0.0,
    flywheel: float = 0.0,
    tolerance: float = 1e-9,
    samples: int = 1001,
    reversals: bool = False,
    max_steps: int = 100_000,
) -> RunUp:
    """Return how a machine runs under a motor torque: one degree of freedom, integrated.

    Parameters
    ----------
    machine : Machine
        Linkage, masses, gravity, loads, springs.
    torque : TorqueLine, callable or float
        Motor torque [N m]; a callable takes speed [rad/s], or also angle [rad], and time [s].
    revolutions, duration : float, optional
        Where the run ends, in revolutions of either direction or in seconds; one at least.
    speed0, theta0 : float
        Crank speed [rad/s] and angle [rad] at the start.
    flywheel : float
        Inertia [kg m^2] added to the crank.
    tolerance : float
        Of a step: in the crank angle [rad], and in the energy relative to its largest value so
        far, 1e-12 to 1e-3.  No step exceeds a twenty-fourth of a revolution.
    samples : int
        Number of times in the result, evenly spaced; the run itself takes its own steps.
    reversals : bool
        Whether the run goes on where the crank turns back, instead of ending as stalled.
    max_steps : int
        The run ends there with status "step limit".

    Returns
    -------
    RunUp
        The checks compare the energy with the work of motor, loads and dampers, and how the run
        ends with how one of longer steps does.

    Raises
    ------
    BadInput
        If no end is given, a number is unusable, the linkage cannot reach the first angle, the
        inertia vanishes at a crank angle, the torque law returns no finite number, or the crank
        runs away.

    Notes
    -----
    ``(J + flywheel) alpha + J'/2 omega^2 + load = torque``, with J from the driving torque (Smith
    4.11) by linearity.  In ``u = sqrt(J + flywheel) omega`` it is ``sqrt(J + flywheel) du/dt =
    torque - load``: the kinetic energy ``u^2/2`` changes by the power alone.  SciPy's DOP853 with
    its dense output, twice.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> run = el.run_up(machine, el.TorqueLine(stall=20.0, no_load_speed=30.0), revolutions=2)
    >>> print(run.status, round(run.revolutions, 6))
    finished 2.0
    """
    ends = {"revolutions": revolutions, "duration": duration}
    numbers = {"speed0": speed0, "theta0": theta0, "tolerance": tolerance}
    _require(machine, ends, {**numbers, "samples": samples, "max_steps": max_steps})
    law, system = torque_law(torque), OneFreedom(machine, flywheel)
    system.require_inertia(float(theta0))
    start = (float(theta0), float(speed0))
    goals = Goals(revolutions, duration, bool(reversals), int(max_steps))
    fine = integrate(system, law, start, tolerance, _LONGEST, goals)
    if fine.status == "step limit":  # no further than this one came
        goals = replace(goals, duration=fine.end)
    # The run that tells the error has so much more tolerance, and steps so much longer.  Of 800
    # random slider-cranks at tolerances of 1e-11 to 1e-4 the estimate covers all but one, 80 times
    # the error in the median; with twice as long steps it is 180 times, with less tolerance too
    # little for one in 400.  Steps of a twelfth of a revolution fool DOP853's own estimate now and
    # then, and a torque may act over a few degrees only.
    loose = (min(100.0 * tolerance, 1e-2), 1.7 * _LONGEST, goals)
    coarse = integrate(system, law, start, *loose) if fine.steps else fine
    time = np.linspace(0.0, fine.end, samples if fine.steps else 1)
    angle, speed, _ = fine.at(time)
    gap = np.abs(coarse.at(np.minimum(time, coarse.end))[0] - angle)
    defect, astray = fine.drift()
    given = np.array([float(law(*at)) for at in zip(speed, angle, time, strict=True)])
    energy = system.energy(angle, speed)
    return RunUp(
        machine=machine,
        time=time,
        angle=angle,
        speed=speed,
        acceleration=system.acceleration(angle, speed, given),
        torque=given,
        energy=energy,
        flywheel=float(flywheel),
        status=fine.status,
        message=fine.message,
        steps=fine.steps,
        fluctuation=Deferred(partial(_fluctuation, fine, float(angle[-1]))),
        run=fine,
        method=f"DOP853, tolerance {tolerance:g}",
        error=float(np.max(gap)) + astray + 16.0 * EPS * (1.0 + float(np.max(np.abs(angle)))),
        error_norm="crank angle [rad], largest over the run",
        checks=DeferredChecks(partial(_checks, defect, fine.status, coarse.status)),
        provenance=provenance({**machine.provenance, "torque": _name(torque)}),
    )


def _fluctuation(run: Run, last: float) -> float | None:
    """Return the speed fluctuation in the last revolution, which ends at an angle."""
    before = np.nonzero(np.abs(run.at(run.times)[0] - last) >= TURN * (1.0 - 1e-12))[0]
    if before.size == 0:
        return None
    # Times at which the speeds of the last revolution are taken.
    angle, speed, _ = run.at(np.linspace(run.times[int(before[-1])], run.end, 2001))
    speeds = np.abs(speed[np.abs(angle - last) <= TURN * (1.0 + 1e-12)])
    high, low = float(np.max(speeds)), float(np.min(speeds))
    return 2.0 * (high - low) / (high + low)


def _checks(defect: float, status: Status, other: Status) -> dict[str, Check]:
    cut = status == "step limit"
    # Share of the largest energy that may be lost, whatever the tolerance.
    return {
        "energy less work, relative": Check(defect, 1e-6),
        "run cut short": Check(float(cut), 0.0),
        "longer steps end otherwise": Check(float(not cut and status != other), 0.0),
    }


def _name(torque: object) -> str:
    plain = isinstance(torque, (int, float, TorqueLine))
    return repr(torque) if plain else str(getattr(torque, "__name__", type(torque).__name__))


def _require(machine: object, ends: Mapping[str, object], numbers: Mapping[str, object]) -> None:
    require_machine(machine)
    if all(value is None for value in ends.values()):
        raise bad("run_up", "no end", "revolutions or duration", "give revolutions=10, for example")
    given = {name: value for name, value in ends.items() if value is not None}
    limits = {name: (5e-324, np.inf, "a finite number above 0") for name in given}
    limits |= dict.fromkeys(("speed0", "theta0"), (-np.inf, np.inf, "a finite number"))
    limits["tolerance"] = 1e-12, 1e-3, "a number from 1e-12 to 1e-3"
    problems = []
    for name, value in (given | dict(numbers)).items():
        if name in limits:
            least, most, expected = limits[name]
            fits = is_finite(value) and least <= value <= most  # type: ignore[operator]
        else:
            least = 2 if name == "samples" else 1
            fits, expected = is_whole(value, least), f"a whole number, {least} or more"
        if not fits:
            problems.append(Problem(name, shown(value), expected, "correct it"))
    refuse(problems)


@dataclass(frozen=True)
class TorqueLine:
    """A motor whose torque falls in a straight line from stall to the no-load speed.

    Parameters
    ----------
    stall : float
        Torque [N m] at rest; its sign is the direction in which the motor drives.
    no_load_speed : float
        Speed [rad/s] at which the torque is zero; the same sign.  Beyond it the motor brakes.

    Raises
    ------
    BadInput
        If a number is not finite, the speed is zero, or the signs differ.

    Examples
    --------
    >>> import elastolink as el
    >>> print(el.TorqueLine(stall=4.0, no_load_speed=50.0)(25.0))
    2.0
    """

    stall: float
    no_load_speed: float

    def __post_init__(self) -> None:
        given = {"stall": self.stall, "no_load_speed": self.no_load_speed}
        problems = number_problems("TorqueLine", given)
        if not problems and not self.stall * self.no_load_speed > 0:
            pair = f"stall {self.stall:g} N m, no-load speed {self.no_load_speed:g} rad/s"
            fix = "correct a sign, or give a callable"
            problems.append(Problem("TorqueLine", pair, "two numbers of one sign, not zero", fix))
        refuse(problems)

    def __call__(self, speed: Any, angle: Any = 0.0, time: Any = 0.0) -> Any:
        """Return the torque [N m] at a speed [rad/s]."""
        return self.stall * (1.0 - speed / self.no_load_speed)


def torque_law(torque: object) -> TorqueLaw:
    """Return a motor torque by speed, angle and time, which refuses what is no finite number."""
    if isinstance(torque, Real) and not isinstance(torque, bool):
        value = finite_number(torque, "torque")
        return lambda speed, angle, time: value
    if not callable(torque) or isinstance(torque, type):
        raise bad("torque", shown(torque), "a number or a callable", "give a TorqueLine")
    law: Any = torque
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    try:
        given = [item.kind for item in inspect.signature(law).parameters.values()]
    except (TypeError, ValueError):  # some built-in callables tell nothing
        given = [inspect.Parameter.VAR_POSITIONAL]
    whole = inspect.Parameter.VAR_POSITIONAL in given
    count = 3 if whole else min(sum(kind in kinds for kind in given), 3)
    if count == 0:
        raise bad("torque", "a callable without arguments", "torque(speed, ...)", "take the speed")

    def checked(speed: float, angle: float, time: float) -> float:
        value = law(*(speed, angle, time)[:count])
        number = isinstance(value, Real) and not isinstance(value, bool)
        if not number and isinstance(value, np.ndarray) and value.size == 1:
            value, number = value.item(), value.dtype.kind in "fiu"
        if not (number and np.isfinite(value)):
            place = f"speed {speed:.6g} rad/s, angle {angle:.6g} rad, time {time:.6g} s"
            found = shown(value) + f" from the torque law at {place}"
            raise bad("torque", found, "a finite number [N m]", "correct the torque law")
        return float(value)

    return checked
