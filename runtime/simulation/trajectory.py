"""Simulation of a linear periodic system at constant crank speed, with its error and checks."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import StepTooLongWarning, bad
from ..core.families import LinearPeriodic
from ..core.results import Result, provenance
from ..integrators import METHODS, SCIPY_METHODS, SECOND_ORDER, OneStep
from ..periodic.first_order import CanonicalForm, canonical_form
from .adaptive import adaptive_march
from .arguments import check_arguments, scalar, start_of
from .automatic import FALLBACK, POWER_SERIES, default_phase
from .marching import MOST_STEPS, Grid, March, make_grid, march, steps_for
from .motion_checks import (
    FAIR,
    LINEAR_RANGE,
    MotionChecks,
    MotionChecksLater,
    largest_deflection,
    warn_of_large_deflection,
)
from .reference import Reference
from .spring_form import spring_generator

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

__all__ = ["LINEAR_RANGE", "Trajectory", "largest_deflection", "simulate"]

_EPS = float(np.finfo(float).eps)


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
        Steps or stretches per revolution, or steps in all for an adaptive method.
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
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
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
    method: str = "auto",
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
        ``power_series``: stretches as long as the motion allows, found to round-off, for smooth
        coefficients.  With fixed steps: ``gauss_legendre`` (order 12), ``gauss_legendre4`` to
        ``gauss_legendre16``, ``magnus4``, ``magnus6``, ``magnus8``, ``cf4``, ``cf6``, ``srkn4``,
        ``srkn6``, ``rk4``, ``de_vogelaere``, ``newmark`` (gamma 1/2, beta 1/4),
        ``generalized_alpha`` (rho_inf 0.9).  ``kutta_merson``, adaptive unless ``steps`` is
        given; or SciPy's ``RK45``, ``DOP853``, ``Radau``, ``BDF``, ``LSODA``.  ``auto``:
        ``power_series``; ``gauss_legendre`` where the coefficients are not smooth or ``steps``
        is given.
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
        Its ``error`` compares with power series on other stretches, or, where the coefficients
        are not smooth, with a solution of order 16 on short steps; ``method`` tells what ran.  Its
        checks, made when they are looked at:
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
        If an argument is unusable, ``power_series`` is asked for coefficients that are not smooth,
        ``rtol`` is beyond what a method reaches, or ``de_vogelaere``, ``srkn4`` or ``srkn6`` is
        asked of a system with first derivatives.

    Notes
    -----
    With theta as variable, ``q' = M^-1 (p - A q)`` and
    ``p' = A^T q' + B q - (K + Kg) q/w^2 - C q'/w - D q/w + f + h/w + p_ext/w^2``.
    """
    check_arguments(method, revolutions, steps, rtol, samples, bound, start)
    form = canonical_form(system, scalar("speed", speed), forcing=forcing)
    q, slope = start_of(form, initial)
    if method == "de_vogelaere":
        spring_generator(form)
    steps_for(form, 1.0, samples)  # refuses speeds too low for the reference solution
    reference = Reference(form, (q, slope), bound)
    run = _Request(form, q, slope, start, float(revolutions), samples, bound, progress, reference)
    wanted = FAIR if rtol is None else rtol
    if method == POWER_SERIES or (method == "auto" and steps is None):
        found = _power_series(run, rtol, required=method == POWER_SERIES)
        if found is not None:
            return _finish(run, POWER_SERIES, *found, wanted)
    if method == "auto":
        method = FALLBACK
    if method in SCIPY_METHODS or (method == "kutta_merson" and steps is None):
        raw, error = _adaptive(run, method, 1e-8 if rtol is None else rtol)
        return _finish(run, method, raw, error, FAIR)
    one_step = {**METHODS, **SECOND_ORDER}[method]
    if steps is not None:
        _warn_long_step(form, one_step, steps)
    raw, error = _fixed(run, one_step, steps, rtol)
    return _finish(run, method, raw, error, wanted)


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
    reference: Reference


@dataclass(frozen=True)
class _Raw:
    """Coordinates of a run, before its checks."""

    theta: Array
    march: March
    steps: int
    status: int
    message: str
    symplectic: bool = False


def _power_series(
    run: _Request, rtol: float | None, *, required: bool
) -> tuple[_Raw, Array] | None:
    """Return a motion by power series and its error; None where coefficients are not smooth."""
    from ..core.progress import bar

    grid = make_grid(run.start, run.revolutions, run.samples, run.samples)
    for fineness in (1.0, 2.0, 4.0):
        with bar(run.progress, grid.intervals) as tick:
            found = run.reference.power_series(grid, fineness, tick)
        if found is None:
            break
        result, count = found
        error = _error(run, grid, result, beside=count)
        if rtol is None or np.all(error <= rtol):
            return _reached(run, grid, result, count, symplectic=True), error
    else:
        raise bad("rtol", rtol, "an error within reach of double precision", "raise rtol")
    if required:
        raise bad(
            "method",
            POWER_SERIES,
            "one for coefficients that are not smooth, or grow too fast",
            f"take {FALLBACK}",
        )
    return None


def _fixed(
    run: _Request, method: OneStep, steps: int | None, rtol: float | None
) -> tuple[_Raw, Array]:
    number = steps
    if number is None:
        number = steps_for(run.form, default_phase(method.name), run.samples)
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
    from ..core.progress import bar

    with bar(run.progress, grid.intervals) as tick:
        result = march(method, run.form, grid, run.q, run.slope, run.bound, tick)
    return _reached(run, grid, result, grid.steps, symplectic=method.symplectic)


def _reached(run: _Request, grid: Grid, result: March, steps: int, *, symplectic: bool) -> _Raw:
    reached = len(result.q)
    stopped = reached <= grid.intervals
    if stopped or np.max(np.abs(result.q)) > run.bound:
        status, message = 1, _passed(run, grid.theta[reached - 1])
    else:
        status, message = 0, "the end was reached"
    return _Raw(grid.theta[:reached], result, steps, status, message, symplectic)


def _passed(run: _Request, theta: float) -> str:
    turns = (theta - run.start) / (2 * np.pi)
    return f"a coordinate passed the bound {run.bound:.3g} after {turns:.6g} revolutions"


def _adaptive(run: _Request, method: str, rtol: float) -> tuple[_Raw, Array]:
    from ..core.progress import bar

    grid = make_grid(run.start, run.revolutions, run.samples, run.samples)
    # A quarter of a wave sets the scale of the motion before growth can inflate it.
    wave = max(run.samples, ceil(16 * float(run.form.rate[0])))
    quarter = ceil(wave / (4 * float(run.form.rate[0])))
    beginning = run.reference.march(Grid(run.start, wave, quarter, 1), slopes=True)
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


def _error(run: _Request, grid: Grid, result: March, beside: int = 0) -> Array:
    """Return the largest error of each coordinate over its peak, with a round-off allowance."""
    other = run.reference.march(grid, beside)
    number = min(len(result.q), len(other.q))
    with np.errstate(over="ignore", invalid="ignore"):
        gap = np.max(np.abs(result.q[:number] - other.q[:number]), axis=0)
        peak = np.max(np.abs(other.q[:number]), axis=0)
    turned = float(grid.theta[number - 1] - grid.theta[0])
    rounding = _EPS * (32.0 + float(run.form.rate[0]) * turned)
    # A coordinate that stays at zero has no peak of its own.
    size = np.maximum(peak, _EPS * np.max(peak, initial=0.0))
    size[size == 0.0] = 1.0
    # Of two alike, either may be as far off on its own side.
    error: Array = (2.0 if beside else 1.0) * gap / size + rounding
    return error


def _finish(run: _Request, method: str, raw: _Raw, error: Array, wanted: float) -> Trajectory:
    form, q = run.form, raw.march.q
    speed = float(form.speed[0])
    checks = MotionChecks(
        form,
        raw.theta,
        raw.march,
        float(np.max(error)),
        wanted,
        raw.symplectic,
    )
    warn_of_large_deflection(form.system, raw.theta, q)
    return Trajectory(
        method=method,
        error=error,
        error_norm=f"largest error of a coordinate over its own peak, against {run.reference.name}",
        checks=MotionChecksLater(checks),
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
