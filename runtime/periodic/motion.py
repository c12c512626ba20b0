"""Motion of a linear periodic system at constant crank speed, with its error and checks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate, pairwise
from math import ceil, factorial, fmod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import LINEAR_RANGE, bad, warn_of_large_deflection
from ..core.families import Array, LinearPeriodic
from ..core.inputs import is_one_of, numbers, require_flag
from ..core.plotting import Axes, draw_coordinates
from ..core.progress import bar
from ..core.results import FAIR, Check, DeferredChecks, Result, provenance
from .equation import Equation, equation_of
from .periodic_motion import peaks
from .transition import Method, method, predicted_error, product, segments_from

SCIPY_METHODS = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
_EPS = float(np.finfo(float).eps)
_Tick = Callable[[int], None]
# Given angles in all, and of a revolution.
_MOST_INTERVALS, _MOST_SAMPLES = 2**22, 2**20
# Nodes of collocation between given angles, and the fineness of what an interval is divided into
# for fast modes: each level is compared with the one before.
_Level = tuple[int, float]
_LEVELS: tuple[_Level, ...] = (
    *((stages, 1.0) for stages in (2, 3, 4, 5, 6, 8)),
    # Whole numbers: two levels that round up to the same steps would agree however wrong they are.
    *((10, fineness) for fineness in (1.0, 2.0, 3.0, 4.0, 6.0, 8.0)),
)
# Coarser ones, where fast modes live to the end: Gauss's methods leave them their size, so that two
# levels that do not resolve them differ by it: at 1/64 a step of 1024 rad turns a mode by 0.2.
_COARSE: tuple[_Level, ...] = ((10, 1 / 64), (10, 1 / 16), (10, 1 / 4))
# Phase of the fastest living mode in a step of fineness 1 [rad].
_PHASE = 16.0
_STIFF = 7
# Decay from which a mode is dead, and the most steps between two given angles.
_DEAD, _MOST_DIVISIONS = 20.0, 4096
# Decay between two given angles that Gauss's methods follow without effort.
_LIVELY = 0.5
# The finer of two levels is taken to be in error by this times the predicted share of their
# difference, but at least by a share: a larger one where modes that are dead follow their load
# unresolved.  Of 160 random motions of four scenes, on every level, 99 of 100 errors above
# round-off are covered, 15 times in the middle (0.05 for both: 98 of 100, and 1500 times).
_MARGIN, _LEAST, _UNRESOLVED = 10.0, 1e-4, 0.3


@dataclass(frozen=True, kw_only=True)
class Trajectory(Result):
    """Motion of a linear periodic system.

    Attributes
    ----------
    theta : ndarray
        Crank angles [rad], shape ``(nt,)``.
    time : ndarray
        Times since the start [s], shape ``(nt,)``.
    q, qd : ndarray
        Coordinates and their time derivatives [1/s], shape ``(nt, n)``.
    speed : float
        Crank speed [rad/s].
    steps : int
        Steps per revolution, or in all for a method of SciPy's.
    status : int
        0 where the end was reached, 1 where the motion passed the bound, 2 where the method gave
        up.
    message : str
        What the status means.
    error : ndarray
        Largest error of each coordinate over its peak, shape ``(n,)``.
    labels : tuple of str
        Names of the coordinates.
    """

    theta: Array
    time: Array
    q: Array
    qd: Array
    speed: float
    steps: int
    status: int
    message: str
    labels: tuple[str, ...]

    arrays_along: ClassVar = {
        "sample": "theta time",
        "sample coordinate": "q qd",
        "coordinate": "error",
    }
    column_units: ClassVar = {"1/s": "qd"}

    @property
    def success(self) -> bool:
        """True where the end was reached."""
        return self.status == 0

    @property
    def at_end(self) -> tuple[Array, Array]:
        """Coordinates and their time derivatives at the last angle: a start for going on."""
        return self.q[-1], self.qd[-1]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over the revolutions of the crank and return the axes."""
        turns = self.theta / (2 * np.pi)
        return draw_coordinates(ax, turns, self.q, self.labels, "revolutions of the crank")


def simulate(
    system: LinearPeriodic,
    speed: float,
    revolutions: float,
    method: str = "auto",
    *,
    initial: tuple[ArrayLike, ArrayLike] | None = None,
    start: float = 0.0,
    rtol: float = 1e-8,
    samples: int = 360,
    forcing: bool = True,
    bound: float = 1e150,
    progress: bool = False,
    **parameters: ArrayLike,
) -> Trajectory:
    """Simulate a linear periodic system at constant crank speed.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    speed : float
        Crank speed [rad/s], positive.
    revolutions : float
        Length of the motion in revolutions of the crank.
    method : str
        ``auto``: transition matrices between the given angles, by collocation with as many nodes
        as the motion asks for; or SciPy's ``RK45``, ``DOP853``, ``Radau``, ``BDF``, ``LSODA``.
    initial : pair of array_like, optional
        Coordinates and their time derivatives [1/s] at the start, each broadcasting to ``(n,)``.
        At rest in zero by default, where the system is forced.
    start : float
        Crank angle at the start [rad].
    rtol : float
        Wanted ``error``; of a method of SciPy's the tolerance of a step.
    samples : int
        Given angles per revolution.
    forcing : bool
        Whether f, h and p act.
    bound : float
        Size of a coordinate beyond which the motion is stopped (status 1).
    progress : bool
        Whether to show a progress bar.
    **parameters : float
        Parameter values that replace the system's, geometry too where it has any.

    Returns
    -------
    Trajectory
        Its ``error`` compares with fewer nodes, or longer steps.  Its checks, made when they are
        looked at: ``accuracy``, the largest error against ``rtol`` or what round-off allows, of a
        method of SciPy's against 0.01; ``energy balance``; ``linear range``, the largest
        deflection over the reference length, for systems that have mode shapes.

    Warns
    -----
    LinearRangeWarning
        If the deflection passes 5 % of the reference length.

    Raises
    ------
    BadInput
        If an argument is unusable, or ``rtol`` is beyond what double precision reaches.

    Notes
    -----
    With theta as variable, ``q' = M^-1 (p - A q)`` and
    ``p' = A^T q' + B q - (K + Kg) q/w^2 - C q'/w - D q/w + f + h/w + p_ext/w^2``.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> motion = el.simulate(system, speed=35.0, revolutions=2)
    >>> print(motion.q.shape, round(float(motion.time[-1]), 4), motion.passed)
    (721, 1) 0.359 True
    """
    _check_arguments(method, revolutions, rtol, samples, bound, start)
    require_flag("forcing", forcing)
    equation = equation_of(system, one_number("speed", speed), parameters, forcing=forcing)
    begin = _within(equation.period, float(start))
    start_state = begin, _start(equation, initial, begin)
    march = _March(equation, start_state, float(revolutions), int(samples), bound)
    with bar(progress, march.intervals) as tick:
        if method == "auto":
            run, error, allowed = march.converged(rtol, tick)
        else:
            run = march.by_scipy(method, rtol, tick)
            other, remaining, _ = march.converged(1e-10)
            error, allowed = march.gap(other, run) + remaining, FAIR
    theta = march.theta[: len(run.states)]
    q, slope = _unscaled(equation, theta, run.states)
    largest = march.largest(q)
    warn_of_large_deflection(largest, nonlinear=equation.system.provenance.get("nonlinear", ""))
    checks = partial(_checks, equation, (theta, q, slope), float(np.max(error)), allowed, largest)
    value = float(equation.speed[0])
    return Trajectory(
        method="collocation between the given angles" if method == "auto" else method,
        error=error,
        error_norm="largest error of a coordinate over its peak",
        checks=DeferredChecks(checks),
        provenance=provenance(system.changed_provenance(**parameters)),
        theta=theta if begin == start else start + (theta - begin),
        time=(theta - begin) / value,
        q=q,
        qd=value * slope,
        speed=value,
        steps=run.steps,
        status=run.status,
        message=run.message,
        labels=system.labels,
    )


def _within(period: float, start: float) -> float:
    """Return a start within a period of zero: a large angle keeps no digits for what is added."""
    if abs(start) <= max(period, 2.0 * np.pi):
        return start
    if (2.0 * np.pi / period).is_integer():
        # The sine knows the remainder of any angle by pi itself, not by its nearest float.
        return float(np.arctan2(np.sin(start), np.cos(start)))
    return fmod(start, period)


@dataclass(frozen=True)
class _Run:
    """Scaled states at the given angles as far as a motion went."""

    states: Array
    steps: int
    status: int = 0
    message: str = "the end was reached"


class _March:
    """A motion that is wanted: from a scaled state on, at given angles, until it passes a bound."""

    def __init__(
        self,
        equation: Equation,
        start: tuple[float, Array],
        revolutions: float,
        samples: int,
        bound: float,
    ) -> None:
        self.equation, self.samples, self.bound = equation, samples, bound
        self.start, self.state = start
        self.step = 2.0 * np.pi / samples
        whole = revolutions * samples
        self.intervals = max(1, ceil(whole - 1e-9))
        self.theta = self.start + self.step * np.arange(self.intervals + 1.0)
        self.theta[-1] = self.start + revolutions * 2.0 * np.pi
        self.lengths = np.diff(self.theta)
        self.short = self.lengths < (1.0 - 1e-8) * self.step
        # Intervals after which the coefficients repeat; all of them, where at no given angle.
        cycle = equation.period / self.step
        repeats = abs(cycle - round(cycle)) < 1e-9 * cycle
        self.cycle = round(cycle) if repeats else self.intervals

    def largest(self, q: Array) -> float | None:
        """Return the largest deflection over the length; the shapes are those of one period."""
        cycle = min(self.cycle, len(q))
        whole = len(q) // cycle
        parts = [q[: whole * cycle].reshape(whole, cycle, -1)]
        if len(q) > whole * cycle:
            parts.append(q[None, whole * cycle :])
        largest = self.equation.system.largest_deflection
        sizes = [largest(self.theta[: part.shape[1]], part) for part in parts]
        return None if sizes[0] is None else max(size for size in sizes if size is not None)

    def converged(self, rtol: float, tick: _Tick | None = None) -> tuple[_Run, Array, float]:
        """Return a motion, its error and what it may be: levels are compared until they agree."""
        equation = self.equation
        turned = float(np.max(equation.frequency)) * (self.theta[-1] - self.start)
        rounding = _EPS * (64.0 + 2.0 * turned)
        kind, levels = self._ladder(rtol)
        coarse = self._on_level(kind, levels[0])
        before, last = np.inf, np.zeros(equation.size)
        for below, level in pairwise(levels):
            fine = self._on_level(kind, level, tick)
            _, likely, share = self._likely(kind, (below, level))
            gap = self.gap(coarse, fine)
            # What is not resolved, but falls, falls at least as much again.
            falling = _MARGIN * gap / np.maximum(last, 1e-300) if below[1] < 1.0 else 1.0
            error, last = np.minimum(share, falling) * gap + rounding, gap
            worst = float(np.max(error))
            stuck = worst > 0.5 * before and worst < 1e-3 and likely < worst
            if worst <= rtol or stuck:
                break
            coarse, before = fine, worst
        return fine, error, max(rtol, 100.0 * rounding)

    def _likely(self, kind: str, levels: tuple[_Level, _Level]) -> tuple[float, float, float]:
        """Return the likely errors of two levels, and the share of their gap."""
        coarse, fine = (self._predicted(kind, level) for level in levels)
        turned = float(self.equation.fastest[0]) * self.step
        unresolved = kind == "radau" and turned > _PHASE * levels[1][1]
        least = _UNRESOLVED if unresolved else _LEAST
        # What modes that the nodes resolve make of missed waves falls with the order of the method.
        power = 2 if turned < levels[0][0] * ceil(levels[0][1]) else 1
        missed = [self._missed(level) ** power for level in levels]
        # Waves that are missed by less than round-off do not count.
        waves = missed[1] / max(missed[0], 1e-300) if missed[1] > _EPS else 0.0
        part = max(_MARGIN * fine / max(coarse, 1e-300), waves)
        return coarse, fine, float(np.clip(part, least, 1.0))

    def _missed(self, level: _Level) -> float:
        """Return what the nodes of a step miss of the coefficients' waves, at most 1."""
        # The polynomial through s nodes misses 2 (R h/4)^s / s! of a wave R; of amplitudes that
        # fall to a millionth at the reach the worst is that of about s/14 of it.
        stages, fineness = level
        wave = self.equation.reach * min(1.0, stages / 14.0) * self.step / ceil(fineness)
        return min(1.0, 2.0 * (0.25 * wave) ** stages / factorial(stages))

    def _predicted(self, kind: str, level: _Level) -> float:
        """Return the likely error of a motion on a level, over its first period."""
        equation, (stages, fineness) = self.equation, level
        way, steps = method(kind, stages), equation.period / self.step
        parts = np.ceil(fineness * _power(equation.frequency[0] * self.step))
        rates = equation.rates[0]
        quick = replace(equation, frequency=rates[None])
        error = [
            predicted_error(quick.with_slow_modes(rate), way, np.array([steps * part]))[0]
            for rate, part in zip(rates, parts, strict=True)
        ]
        return float(np.max(error, initial=0.0))

    def _ladder(self, rtol: float) -> tuple[str, tuple[_Level, ...]]:
        """Return the kind of collocation, and levels whose second is likely accurate enough."""
        equation = self.equation
        kind = "radau" if equation.damped else "gauss"
        periods = (self.theta[-1] - self.start) / equation.period
        turned = float(np.max(equation.frequency, initial=0.0)) * self.step
        if turned > 2.0:
            # How far fast modes are excited is not known beforehand: seldom much.
            most = float(np.max(equation.decay, initial=0.0))
            if most * periods > _DEAD or most * self.step > _LIVELY * equation.period:
                return kind, _LEVELS[_STIFF - 1 :]
            parts = np.max(self._divisions(1, 1.0))
            coarser = (at for at in _COARSE if at[1] * parts >= 1.0)
            return "gauss", (*coarser, *_LEVELS[_STIFF - 1 :])
        # Errors of an undamped mode add up from one period to the next.
        decay = float(np.min(equation.decay, initial=np.inf))
        adding = min(max(periods, 1.0), 1.0 + 1.0 / max(decay, 1e-9))
        for place in range(1, len(_LEVELS) - 1):
            coarse, fine, share = self._likely(kind, (_LEVELS[place - 1], _LEVELS[place]))
            if max(_MARGIN * fine, share * coarse) * adding <= rtol:
                break
        return kind, _LEVELS[place - 1 :]

    def _divisions(self, count: int, fineness: float) -> NDArray[np.intp]:
        """Return the steps that each of the first intervals is divided into, by modes alive."""
        equation = self.equation
        passed = self.step * np.arange(float(count)) / equation.period
        alive = equation.decay[0] * passed[:, None] < _DEAD
        rate = np.max(np.where(alive, equation.frequency[0], 0.0), axis=1)
        parts = np.ceil(fineness * _power(rate * self.step))
        if np.max(parts) > _MOST_DIVISIONS:
            raise bad(
                "speed",
                f"{float(equation.speed[0]):.6g} rad/s, where the highest mode turns through "
                f"{float(np.max(equation.frequency)) * equation.period:.3g} rad in a period",
                f"{_MOST_DIVISIONS} steps at most between two given angles",
                "raise the speed or samples, or leave out the highest modes",
            )
        return np.asarray(parts, dtype=np.intp)

    def _on_level(self, kind: str, level: _Level, tick: _Tick | None = None) -> _Run:
        """Return the motion by transition matrices between the given angles."""
        stages, fineness = level
        way = method(kind, stages)
        divisions = self._divisions(self.intervals, fineness)
        steps = int(self.samples * divisions[-1])
        pieces = [self.state[None]]
        limit = self.bound / self.equation.scale[0]
        known: dict[tuple[int, int, bool], Array] = {}
        # From period to period.
        for begin, end in pairwise([*range(0, self.intervals, self.cycle), self.intervals]):
            key = (end - begin, int(np.max(divisions[begin:end])), bool(self.short[end - 1]))
            same = key in known and bool(np.all(divisions[begin:end] == divisions[-1]))
            if not same:
                known[key] = self._flows((begin, end), divisions[begin:end], way)
            with np.errstate(over="ignore", invalid="ignore"):
                piece = (known[key] @ pieces[-1][-1][:, None])[:, :, 0]
            pieces.append(piece)
            if tick is not None:
                tick(end)
            outside = ~np.all(np.abs(piece[:, : self.equation.size]) <= limit, axis=1)
            if np.any(outside):
                last = int(np.argmax(outside))
                kept = last if not np.all(np.isfinite(piece[last])) else last + 1
                pieces[-1] = piece[:kept]
                return self._passed(np.concatenate(pieces), steps)
        return _Run(np.concatenate(pieces), steps)

    def _passed(self, states: Array, steps: int) -> _Run:
        turns = (self.theta[len(states) - 1] - self.start) / (2 * np.pi)
        told = f"a coordinate passed the bound {self.bound:.3g} after {turns:.6g} revolutions"
        return _Run(states, steps, 1, told)

    def _flows(self, block: tuple[int, int], divisions: NDArray[np.intp], way: Method) -> Array:
        """Return the transition matrices from the beginning of a block of intervals to the ends."""
        begin, end = block
        m = 2 * self.equation.size + self.equation.forced
        single = np.empty((end - begin, m, m))
        lengths = self.lengths[begin:end]
        kinds = np.stack([divisions, self.short[begin:end]])
        for parts, short in np.unique(kinds, axis=1).T:
            places = np.flatnonzero((kinds[0] == parts) & (kinds[1] == short))
            count = int(parts)
            h = float(lengths[places[0]] if short else self.step) / count
            left = self.theta[begin + places][:, None] + h * np.arange(float(count))
            maps = segments_from(self.equation, left.ravel(), h, way).maps[0]
            single[places], _ = product(maps.reshape(len(places), count, m, m))
        with np.errstate(over="ignore", invalid="ignore"):
            return np.array([*accumulate(single, lambda total, one: one @ total)])

    def gap(self, coarse: _Run, fine: _Run) -> Array:
        """Return the largest difference of each coordinate over its peak, ``(n,)``."""
        n, number = self.equation.size, min(len(coarse.states), len(fine.states))
        first, second = coarse.states[:number, :n], fine.states[:number, :n]
        with np.errstate(over="ignore", invalid="ignore"):
            gap = np.max(np.abs(first - second), axis=0) / peaks(second[None])[0]
        return np.where(np.isfinite(gap), gap, 1.0)

    def by_scipy(self, name: str, rtol: float, tick: _Tick | None) -> _Run:
        """Return the motion by a method of :func:`scipy.integrate.solve_ivp`."""
        from scipy.integrate import solve_ivp

        equation, state = self.equation, self.state
        limit, reached = self.bound / equation.scale[0], 0

        def jacobian(angle: float, y: Array) -> Array:
            del y
            value: Array = equation.generator(np.array([angle]))[0, 0]
            return value

        def slope(angle: float, y: Array) -> Array:
            return np.asarray(jacobian(angle, y) @ y)

        def inside(angle: float, y: Array) -> float:
            nonlocal reached
            if tick is not None:
                reached = max(reached, int(np.searchsorted(self.theta, angle, side="right")) - 1)
                tick(reached)
            return float(1.0 - np.max(np.abs(y[: len(limit)]) / limit))

        inside.terminal = True  # type: ignore[attr-defined]
        options: dict[str, Any] = {"method": name, "events": inside, "t_eval": self.theta}
        if name in ("Radau", "BDF", "LSODA"):
            options["jac"] = jacobian
        # A motion from rest has no size yet: that of the first quarter of a wave.
        quarter = 0.25 / max(1.0, float(np.max(equation.frequency)))
        beginning = _March(equation, (self.start, state), quarter, 16, np.inf)
        states = beginning._on_level("radau", _LEVELS[5]).states
        peak = float(np.max(np.abs(states[:, : 2 * equation.size])))
        atol = np.full(len(state), rtol * (peak if 0 < peak < np.inf else 1.0) * 1e-2)
        options |= {"rtol": max(rtol, 2.5e-14), "atol": atol, "dense_output": True}
        with np.errstate(over="ignore", invalid="ignore"):
            solution = solve_ivp(slope, (self.theta[0], self.theta[-1]), state, **options)
        states = np.ascontiguousarray(solution.y.T)
        steps = 0 if solution.sol is None else len(solution.sol.ts) - 1
        if solution.status == 1:
            return self._passed(states, steps)
        if solution.status == 0:
            return _Run(states, steps)
        return _Run(states, steps, 2, str(solution.message))


def _power(turned: Array) -> Array:
    """Return the divisions of fineness 1, powers of two: so few different numbers occur."""
    value: Array = np.exp2(np.ceil(np.log2(np.maximum(1.0, turned / _PHASE))))
    return value


def _unscaled(equation: Equation, theta: Array, states: Array) -> tuple[Array, Array]:
    """Return coordinates and dq/dtheta from scaled states, ``(nt, n)`` each."""
    n, unit = equation.size, equation.scale[0]
    q, momentum = states[:, :n], states[:, n : 2 * n]
    if "gyroscopic" in equation.fields:
        momentum = momentum - (equation.at("gyroscopic", theta)[0] @ q[..., None])[..., 0]
    mass = np.broadcast_to(equation.at("mass", theta)[0], (len(theta), n, n))
    slope = np.linalg.solve(mass, momentum[..., None])[..., 0]
    return q * unit, slope * unit


def _checks(
    equation: Equation,
    motion: tuple[Array, Array, Array],
    error: float,
    allowed: float,
    largest: float | None,
) -> Mapping[str, Check]:
    checks = {"accuracy": Check(error, allowed)}
    balance = energy_balance(equation, *motion, error)
    if balance is not None:
        checks["energy balance"] = balance
    if largest is not None:
        checks["linear range"] = Check(largest, LINEAR_RANGE)
    return checks


def _start(
    equation: Equation,
    initial: tuple[ArrayLike, ArrayLike] | Sequence[ArrayLike] | None,
    start: float,
) -> Array:
    """Return the scaled state at the start, ``(m,)``; refuse a rest that nothing moves."""
    n = equation.size
    if initial is None:
        if not equation.forced:
            fix = "give initial=(q, qd)"
            raise bad("initial", "nothing, and no forcing acts", "a start away from rest", fix)
        return np.concatenate([np.zeros(2 * n), [1.0]])
    q, qd = start_values(equation.system, initial)
    (state,) = equation.states(np.array([start]), q[None], qd[None] / equation.speed[0])
    return np.append(state, 1.0) if equation.forced else state


def start_values(
    system: LinearPeriodic, initial: tuple[ArrayLike, ArrayLike] | Sequence[ArrayLike]
) -> list[Array]:
    """Return coordinates and their time derivatives, ``(n,)`` each; refuse what is no start."""
    if not isinstance(initial, (tuple, list)) or len(initial) != 2:
        raise bad("initial", initial, "a pair (q, qd)", "give coordinates and time derivatives")
    parts, n = [], system.size
    for name, part in zip(("q", "qd"), initial, strict=True):
        values = numbers(f"initial {name}", part)
        if values.shape not in ((), (1,), (n,)) or not np.all(np.isfinite(values)):
            fix = f"one per coordinate: {', '.join(system.labels)}"
            raise bad(f"initial {name}", part, f"{n} finite numbers", fix)
        parts.append(np.broadcast_to(values, (n,)))
    return parts


def one_number(name: str, value: ArrayLike, fix: str = "simulate one speed at a time") -> float:
    """Return a number; refuse an array of several."""
    array = numbers(name, value)
    if array.ndim:
        raise bad(name, f"shape {array.shape}", "one number", fix)
    return float(array)


def _check_arguments(
    method: str, revolutions: float, rtol: float, samples: int, bound: float, start: float
) -> None:
    names = ("auto", *SCIPY_METHODS)
    if not is_one_of(method, names):
        raise bad("method", repr(method), f"one of {names}", "choose 'auto'")
    for name, value, least in (("revolutions", revolutions, 1e-12), ("bound", bound, 1e-300)):
        if not least <= one_number(name, value) < np.inf:
            raise bad(name, value, f"a positive finite number, from {least:g}", "correct it")
    if not np.isfinite(one_number("start", start)):
        raise bad("start", start, "a finite crank angle [rad]", "correct it")
    given = one_number("samples", samples)
    if not 1 <= given <= _MOST_SAMPLES or given != int(given):
        expected = f"a whole number from 1 to {_MOST_SAMPLES}"
        raise bad("samples", samples, expected, "correct it")
    if float(revolutions) * samples > _MOST_INTERVALS:
        found = f"{revolutions:.6g} of {samples} samples each"
        fix = "go on from at_end in parts, or lower samples"
        raise bad("revolutions", found, f"at most {_MOST_INTERVALS} given angles in all", fix)
    if not 1e-14 <= one_number("rtol", rtol) < 1:
        raise bad("rtol", rtol, "a number from 1e-14 to 1", "choose 1e-8")


def energy_balance(
    equation: Equation, theta: Array, q: Array, slope: Array, error: float
) -> Check | None:
    """Return the defect of the energy balance over its largest term; None where angles are too few.

    With v = dq/dtheta the energy is ``E = v^T M v/2 - q^T N_s q/2``, N_s the symmetric part of N,
    and ``dE/dtheta = v^T (N - N_s) q - v^T C v/w + v^T F - v^T A' q - v^T M' v/2 - q^T N_s' q/2``.
    The angles ``theta`` [rad], ``(nt,)``, are even but for the last; q and ``slope``, which is v,
    have shape ``(nt, n)``, and ``error`` is that of the motion over its peak.
    """
    if len(theta) < 10 or equation.harmonics < 0:
        return None
    step = float(theta[1] - theta[0])
    # Modes too fast for the angles have to be dead: the balance begins where the last of them is.
    # From this phase on given angles do not tell a mode's part of an integral.
    fast = step * equation.frequency[0] > 0.5
    decay = float(np.min(equation.decay[0], initial=np.inf, where=fast))
    dead = _DEAD / max(decay, 1e-300) * equation.period / step
    begin = ceil(min(dead, len(theta)))
    even = 4 * ((len(theta) - 2 - begin) // 4) + 1
    if even < 9:
        return None
    part = slice(begin, begin + even)
    theta, q, slope = theta[part], q[part], slope[part]
    unit = equation.scale[0]
    place, rate = q / unit, slope / unit
    power = np.zeros(even)
    energy = 0.5 * _form(equation.at("mass", theta)[0], rate, rate)
    power -= 0.5 * _form(equation.slope("mass", theta), rate, rate)
    if "stiffness" in equation.fields:
        stiffness = equation.at("stiffness", theta)[0]
        energy -= 0.5 * _form(stiffness, place, place)
        turned = stiffness - np.swapaxes(stiffness, -1, -2)
        power += 0.5 * _form(turned, rate, place)
        power -= 0.5 * _form(equation.slope("stiffness", theta), place, place)
    if "gyroscopic" in equation.fields:
        power -= _form(equation.slope("gyroscopic", theta), rate, place)
    if "damping" in equation.fields:
        power -= _form(equation.at("damping", theta)[0], rate, rate)
    if equation.forced:
        power += np.sum(equation.at("force", theta)[0] * rate, axis=-1)
    fine, coarse = _simpson(power, step), _simpson(power[::2], 2.0 * step)
    # Boole's rule.
    work = fine + (fine - coarse) / 15.0
    size = float(np.max(np.abs(energy))) + step * float(np.sum(np.abs(power)))
    if not 0.0 < size < np.inf:
        return None
    defect = abs(float(energy[-1] - energy[0]) - work) / size
    # Simpson's rule on twice the step is in error by far more than Boole's.
    return Check(defect, 20.0 * error + abs(work - coarse) / size + 1e-12)


def _form(matrices: Array, left: Array, right: Array) -> Array:
    value: Array = np.sum(left * (matrices @ right[..., None])[..., 0], axis=-1)
    return value


def _simpson(values: Array, step: float) -> float:
    inner = 4.0 * float(np.sum(values[1:-1:2])) + 2.0 * float(np.sum(values[2:-1:2]))
    return step / 3.0 * (float(values[0] + values[-1]) + inner)
