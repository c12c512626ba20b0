"""Simulation of a linear periodic system at constant crank speed, with its error and checks."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import LinearRangeWarning, StepTooLongWarning, bad
from ..families import LinearPeriodic
from ..floquet.first_order import CanonicalForm, canonical_form, even_angles, numbers
from ..floquet.spring_form import spring_generator
from ..integrators import METHODS, SCIPY_METHODS, SECOND_ORDER, OneStep
from ..integrators.gauss_legendre import gauss_legendre
from ..results import Check, Result, provenance
from .adaptive import adaptive_march
from .energy import energy_balance
from .marching import MOST_INTERVALS, MOST_STEPS, Grid, March, make_grid, march, steps_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

LINEAR_RANGE = 0.05
_EPS = float(np.finfo(float).eps)
_REFERENCE = gauss_legendre(8)
# Phase of the highest mode that a default step covers [rad]: a quarter of the step limit of
# Smith's rule in explicit methods, and round-off accuracy in collocation of order 12.
_PHASE = {"gauss_legendre": 0.5, "magnus4": 0.15}
_EXPLICIT_PHASE = 0.15
# Error that a motion may have where none was asked for, and most artificial damping.
_FAIR = 0.01


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
        Steps per revolution, or steps in all for a method that chooses them.
    status : int
        0 where the end was reached, 1 where the motion passed the bound, 2 where the method gave
        up.
    message : str
        What the status means.
    error : ndarray
        Largest error of each coordinate over its own peak, shape ``(n,)``.
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

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta": ("sample",),
        "time": ("sample",),
        "q": ("sample", "coordinate"),
        "qd": ("sample", "coordinate"),
        "error": ("coordinate",),
    }

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
        if ax is None:
            from matplotlib.figure import Figure

            ax = Figure().add_subplot()
        for label, values in zip(self.labels, self.q.T, strict=True):
            ax.plot(self.theta / (2 * np.pi), values, label=label, linewidth=0.9)
        ax.set_xlabel("revolutions of the crank")
        ax.set_ylabel("coordinate")
        if len(self.labels) > 1:
            ax.legend()
        return ax


def simulate(
    system: LinearPeriodic,
    speed: float,
    revolutions: float,
    method: str = "gauss_legendre",
    *,
    initial: tuple[ArrayLike, ArrayLike] | None = None,
    start: float = 0.0,
    steps: int | None = None,
    rtol: float | None = None,
    samples: int = 360,
    forcing: bool = True,
    bound: float = 1e150,
    progress: bool = False,
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
        ``gauss_legendre`` (order 12), ``magnus4``, ``rk4``, ``de_vogelaere``, ``newmark`` (gamma
        1/2, beta 1/4), ``generalized_alpha`` (rho_inf 0.9), with fixed steps;
        ``kutta_merson``, adaptive unless ``steps`` is given; or SciPy's ``RK45``, ``DOP853``,
        ``Radau``, ``BDF``, ``LSODA``.
    initial : pair of array_like, optional
        Coordinates and their time derivatives [1/s] at the start, each broadcasting to ``(n,)``.
        At rest in zero by default, where the system is forced.
    start : float
        Crank angle at the start [rad].
    steps : int, optional
        Fixed steps per revolution.  By default short enough for the highest mode kept.
    rtol : float, optional
        Tolerance: of one step of an adaptive method (default 1e-8); for fixed steps the wanted
        ``error``, reached by doubling the steps.
    samples : int
        Given angles per revolution; all steps are given where there are fewer.
    forcing : bool
        Whether f, h and p act.
    bound : float
        Size of a coordinate beyond which the motion is stopped (status 1).
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    Trajectory
        Its ``error`` compares with a solution of order 16 on short steps.  Its checks:
        ``accuracy``, the largest error against the ``rtol`` that fixed steps were asked for, else
        0.01; ``energy balance``; ``liouville``, the artificial damping over the whole motion;
        ``symplectic``, for a symplectic method and a conservative system; ``linear range``, the
        largest deflection over the reference length, for systems that have mode shapes.

    Warns
    -----
    StepTooLongWarning
        If the fixed step of an explicit method violates Smith's rule (section 6.2.3.1): half the
        step below 18/lambda degrees, lambda being the highest natural frequency over the speed.
    LinearRangeWarning
        If the deflection passes 5 % of the reference length.

    Raises
    ------
    BadInput
        If an argument is unusable, or ``de_vogelaere`` is asked of a system with first
        derivatives.

    Notes
    -----
    With theta as variable, ``q' = M^-1 (p - A q)`` and
    ``p' = A^T q' + B q - (K + Kg) q/w^2 - C q'/w - D q/w + f + h/w + p_ext/w^2``.
    """
    _check_arguments(method, revolutions, steps, rtol, samples, bound, start)
    form = canonical_form(system, _scalar("speed", speed), forcing=forcing)
    q, slope = _initial(form, initial)
    if method == "de_vogelaere":
        spring_generator(form)
    steps_for(form, 1.0, samples)  # refuses speeds too low for the reference solution
    run = _Request(form, q, slope, start, float(revolutions), samples, bound, progress)
    if method in SCIPY_METHODS or (method == "kutta_merson" and steps is None):
        raw, error = _adaptive(run, method, 1e-8 if rtol is None else rtol)
        return _finish(run, method, raw, error, _FAIR)
    one_step = {**METHODS, **SECOND_ORDER}[method]
    if steps is not None:
        _warn_long_step(form, one_step, steps)
    raw, error = _fixed(run, one_step, steps, rtol)
    return _finish(run, method, raw, error, _FAIR if rtol is None else rtol)


@dataclass(frozen=True)
class _Request:
    """A simulation that has been checked."""

    form: CanonicalForm
    q: Array
    slope: Array
    start: float
    revolutions: float
    samples: int
    bound: float
    progress: bool


@dataclass(frozen=True)
class _Raw:
    """Coordinates of a run, before its checks."""

    theta: Array
    march: March
    steps: int
    status: int
    message: str
    symplectic: bool = False


def _fixed(
    run: _Request, method: OneStep, steps: int | None, rtol: float | None
) -> tuple[_Raw, Array]:
    number = steps
    if number is None:
        phase = _PHASE.get(method.name, _EXPLICIT_PHASE)
        number = steps_for(run.form, phase, run.samples)
    while True:
        grid = make_grid(run.start, run.revolutions, run.samples, number)
        raw = _raw(run, method, grid)
        error = _error(run, grid, raw.march)
        if rtol is None or np.all(error <= rtol):
            return raw, error
        number *= 2
        if number > MOST_STEPS:
            raise bad("rtol", rtol, f"an error within reach of {method.name}", "raise rtol")


def _raw(run: _Request, method: OneStep, grid: Grid) -> _Raw:
    from ..progress import bar

    with bar(run.progress, grid.intervals) as tick:
        result = march(method, run.form, grid, run.q, run.slope, run.bound, tick)
    reached = len(result.q)
    stopped = reached <= grid.intervals
    if stopped or np.max(np.abs(result.q)) > run.bound:
        status, message = 1, _passed(run, grid.theta[reached - 1])
    else:
        status, message = 0, "the end was reached"
    return _Raw(grid.theta[:reached], result, grid.steps, status, message, method.symplectic)


def _passed(run: _Request, theta: float) -> str:
    turns = (theta - run.start) / (2 * np.pi)
    return f"a coordinate passed the bound {run.bound:.3g} after {turns:.6g} revolutions"


def _adaptive(run: _Request, method: str, rtol: float) -> tuple[_Raw, Array]:
    from ..progress import bar

    grid = make_grid(run.start, run.revolutions, run.samples, run.samples)
    # A quarter of a wave sets the scale of the motion before growth can inflate it.
    wave = max(run.samples, ceil(16 * float(run.form.rate[0])))
    quarter = ceil(wave / (4 * float(run.form.rate[0])))
    beginning = _reference(run, Grid(run.start, wave, quarter, 1))
    with bar(run.progress, grid.intervals) as tick:
        outcome = adaptive_march(
            method, run.form, grid, (run.q, run.slope), beginning, rtol, run.bound, tick
        )
    message = {0: "the end was reached", 1: _passed(run, outcome.theta[-1])}
    raw = _Raw(
        outcome.theta,
        March(outcome.q, outcome.slope, None, float("nan")),
        outcome.steps,
        outcome.status,
        message.get(outcome.status, outcome.message),
    )
    return raw, _error(run, grid, raw.march)


def _reference(run: _Request, grid: Grid) -> March:
    steps = steps_for(run.form, 1.0, grid.per_revolution)
    fine = replace(grid, substeps=steps // grid.per_revolution)
    return march(_REFERENCE, run.form, fine, run.q, run.slope, run.bound)


def _error(run: _Request, grid: Grid, result: March) -> Array:
    """Return the largest error of each coordinate over its peak, with a round-off allowance."""
    other = _reference(run, grid)
    number = min(len(result.q), len(other.q))
    with np.errstate(over="ignore", invalid="ignore"):
        gap = np.max(np.abs(result.q[:number] - other.q[:number]), axis=0)
        peak = np.max(np.abs(other.q[:number]), axis=0)
    turned = float(grid.theta[number - 1] - grid.theta[0])
    rounding = _EPS * (32.0 + float(run.form.rate[0]) * turned)
    # A coordinate that stays at zero has no peak of its own.
    size = np.maximum(peak, _EPS * np.max(peak, initial=0.0))
    size[size == 0.0] = 1.0
    error: Array = gap / size + rounding
    return error


def _finish(run: _Request, method: str, raw: _Raw, error: Array, wanted: float) -> Trajectory:
    form, q = run.form, raw.march.q
    speed = float(form.speed[0])
    return Trajectory(
        method=method,
        error=error,
        error_norm="largest error of a coordinate over its own peak, against Gauss-Legendre "
        "collocation of order 16",
        checks=_checks(run, raw, float(np.max(error)), wanted),
        provenance=provenance(form.system.provenance),
        theta=raw.theta,
        time=(raw.theta - run.start) / speed,
        q=q,
        qd=speed * raw.march.slope,
        speed=speed,
        steps=raw.steps,
        status=raw.status,
        message=raw.message,
        labels=form.system.labels,
    )


def _checks(run: _Request, raw: _Raw, error: float, wanted: float) -> Mapping[str, Check]:
    form, result = run.form, raw.march
    checks = {"accuracy": Check(error, wanted)}
    if len(raw.theta) > 1:
        balance = energy_balance(form, raw.theta, result.q, result.slope, error)
        if balance is not None:
            checks["energy balance"] = balance
    if result.volume is not None:
        turned = raw.theta[-1] - raw.theta[0]
        mean = float(np.mean(form.trace(even_angles(form.system.period, 256))))
        drift = abs(float(result.volume - mean * turned)) / (2 * form.system.size)
        checks["liouville"] = Check(drift, _FAIR)
    if raw.symplectic and form.conservative:
        checks["symplectic"] = Check(result.defect, 1e-12)
    deflection = _deflection(form.system, raw.theta, result.q)
    if deflection is not None:
        checks["linear range"] = Check(deflection, LINEAR_RANGE)
        if deflection > LINEAR_RANGE:
            warnings.warn(
                f"deflection reaches {deflection:.3g} of the reference length; the linear "
                f"equations hold to about {LINEAR_RANGE}: lower the amplitude",
                LinearRangeWarning,
                stacklevel=4,
            )
    return checks


def _deflection(system: LinearPeriodic, theta: Array, q: Array) -> float | None:
    """Return the largest deflection over the reference length; None where it has no meaning."""
    if system.moving_shape is not None:
        return _moving_deflection(system, theta, q)
    if system.shape is not None:
        shapes = np.asarray(system.shape(np.linspace(0.0, 1.0, 101)))
        parts = (q[k : k + 4096] @ shapes.T for k in range(0, len(q), 4096))
        return max(float(np.max(np.abs(part))) for part in parts)
    if system.reference_length != 1.0:
        return float(np.max(np.abs(q)))
    return None


def _moving_deflection(system: LinearPeriodic, theta: Array, q: Array) -> float:
    """Return the largest deflection of shapes that move with the crank, at 26 places."""
    # Even angles repeat with every revolution, and so do the shapes.
    turn = len(q) if len(q) < 2 else max(1, round(2 * np.pi / float(theta[1] - theta[0])))
    places, largest = np.linspace(0.0, 1.0, 26), 0.0
    for first in range(0, min(turn, len(q)), 512):
        part = np.arange(first, min(first + 512, turn, len(q)))
        shapes = system.shapes(places, theta[part])
        if shapes is None:  # not with moving shapes; for the type checker
            return largest
        for begin in range(0, len(q), turn):
            rows = q[begin + first : begin + first + len(part)]
            values = np.einsum("txn,tn->tx", shapes[: len(rows)], rows)
            largest = max(largest, float(np.max(np.abs(values), initial=0.0)))
    return largest


def _warn_long_step(form: CanonicalForm, method: OneStep, steps: int) -> None:
    if not method.explicit:
        return
    natural = float(form.frequency[0])
    half = 180.0 / steps
    if half * natural >= 18.0 * (1.0 - 1e-12):
        warnings.warn(
            f"{method.name}: half step {half:.4g} degrees, but the highest natural frequency is "
            f"{natural:.4g} per revolution and asks for less than {18.0 / natural:.4g}: "
            f"take more than {int(10 * natural)} steps per revolution",
            StepTooLongWarning,
            stacklevel=3,
        )


def _scalar(name: str, value: Any) -> float:
    array = numbers(name, value)
    if array.ndim != 0:
        raise bad(name, f"shape {array.shape}", "one number", "simulate one speed at a time")
    return float(array)


def _initial(
    form: CanonicalForm, initial: tuple[ArrayLike, ArrayLike] | Sequence[ArrayLike] | None
) -> tuple[Array, Array]:
    """Return q and dq/dtheta at the start."""
    n = form.system.size
    if initial is None:
        if not form.forced:
            raise bad(
                "initial",
                "nothing, and no forcing acts",
                "a start away from rest",
                "give initial=(q, qd)",
            )
        return np.zeros(n), np.zeros(n)
    if not isinstance(initial, (tuple, list)) or len(initial) != 2:
        raise bad("initial", initial, "a pair (q, qd)", "give coordinates and time derivatives")
    parts = []
    for name, part in zip(("q", "qd"), initial, strict=True):
        values = numbers(f"initial {name}", part)
        if values.shape not in ((), (1,), (n,)) or not np.all(np.isfinite(values)):
            fix = f"one per coordinate: {', '.join(form.system.labels)}"
            raise bad(f"initial {name}", part, f"{n} finite numbers", fix)
        parts.append(np.broadcast_to(values, (n,)).copy())
    return parts[0], parts[1] / float(form.speed[0])


def _check_arguments(
    method: str,
    revolutions: float,
    steps: int | None,
    rtol: float | None,
    samples: int,
    bound: float,
    start: float,
) -> None:
    names = [*METHODS, *SECOND_ORDER, *SCIPY_METHODS]
    if method not in names:
        raise bad("method", repr(method), f"one of {names}", "correct the name")
    for name, value in (("revolutions", revolutions), ("bound", bound)):
        if not 0 < _scalar(name, value) < np.inf:
            raise bad(name, value, "a positive finite number", "correct it")
    if not np.isfinite(_scalar("start", start)):
        raise bad("start", start, "a finite crank angle [rad]", "correct it")
    for name, count in (("steps", steps), ("samples", samples)):
        if count is None:
            continue
        given = _scalar(name, count)
        if not 1 <= given <= MOST_STEPS or given != int(given):
            raise bad(name, count, f"a whole number from 1 to {MOST_STEPS}", "correct it")
    if float(revolutions) * max(samples, 1) > MOST_INTERVALS:
        raise bad(
            "revolutions",
            f"{revolutions:.6g} of {samples} samples each",
            f"at most {MOST_INTERVALS} given angles in all",
            "go on from at_end in parts, or lower samples",
        )
    if rtol is not None and not 1e-14 <= _scalar("rtol", rtol) < 1:
        raise bad("rtol", rtol, "a number from 1e-14 to 1", "choose 1e-8")
    if steps is not None and rtol is not None:
        raise bad("steps and rtol", "both", "one of them", "leave one out")
    if steps is not None and method in SCIPY_METHODS:
        raise bad("steps", steps, f"none, as {method} chooses its steps", "give rtol")
