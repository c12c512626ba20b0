"""Motion of a constrained system over a span of time."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import LinearRangeWarning, bad
from ..core.families import Constrained
from ..core.results import Check, provenance
from .batches import nearest_states
from .consistent import consistent_state
from .equations import Array, Equations, NoConvergence, State
from .guards import Guard, first_crossing
from .norms import constraint_norms
from .result import ConstrainedMotion
from .steppers import METHODS, Window
from .steppers.protocol import STAGES, Control, Step, StoppedEarly, natural_scales

Watch = Callable[[Array, Array], ArrayLike]
Energy = Callable[[Array, Array, Array], ArrayLike]

LINEAR_RANGE = 0.05
# The second run, which tells the error, has steps shortened by the first of these factors, and
# its gap is enlarged by the second; where a library chooses the steps, a tolerance so much looser.
_REFINED, _SAFETY, _LOOSER = 1.5, 3.0, 32.0
_MOST_SAMPLES = 2_000_000
_EPS = float(np.finfo(float).eps)
# Roundings of a long window, which may all lie on one side.
_WINDOW = 20.0
# States that are moved onto the constraints together.
_TOGETHER = 4096
# Constraints count as kept where their scaled defect is below this.
_KEPT = 1e-12


def constrained_motion(
    system: Constrained,
    q: ArrayLike,
    qd: ArrayLike,
    span: float | tuple[float, float],
    *,
    method: str = "collocation",
    rtol: float = 1e-9,
    step: float | None = None,
    stages: int | None = None,
    samples: int | ArrayLike = 200,
    guards: Sequence[Guard] = (),
    watch: Watch | None = None,
    energy: Energy | None = None,
    bound: float = 1e9,
    progress: bool = False,
) -> ConstrainedMotion:
    """Integrate a constrained system from a state that meets its constraints.

    Parameters
    ----------
    system : Constrained
        The system; its parameters are single numbers.
    q, qd : array_like, shape (n,)
        Coordinates and velocities at the start.  They are moved onto the constraints where they
        are off by no more than 1e-6; take :func:`consistent_state` before if they are further off.
    span : float or pair of float
        Length of the motion from t = 0, or its first and last time [s].
    method : str
        ``collocation`` (Gauss points of long windows, all evaluated at once; the fastest),
        ``projection`` (explicit, order 8, projected after each step), ``coordinate_partitioning``
        (order 8 in independent coordinates), ``lobatto`` (symmetric, implicit, fixed steps), or
        ``gear_gupta_leimkuhler`` (stabilised index 2, SUNDIALS, extra ``dae``).
    rtol : float
        Relative tolerance of one step.
    step : float, optional
        Fixed step [s] instead of a tolerance.
    stages : int, optional
        Stages of ``lobatto``, 2 to 20, of order ``2 stages - 2`` (5 where none are given), or
        nodes of ``collocation``, 6 to 32, of order ``2 stages``.
    samples : int or array_like
        Number of equal intervals between the given times, or the given times [s] themselves.
    guards : sequence of Guard
        Conditions that stop the motion (status 1), with their reason as message.
    watch : callable, optional
        ``watch(q, t)`` gives the largest deflection over the length of the link, from
        ``(nt, n)`` and ``(nt,)`` to ``(nt,)``: the check ``linear range``.
    energy : callable, optional
        ``energy(q, qd, t)``, constant over the motion, ``(nt,)`` [J]: the check ``energy``.
    bound : float
        Size of a coordinate, over its size at the start, at which the motion counts as diverged.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    ConstrainedMotion
        Its ``error`` is the largest gap to a motion of ``collocation`` with a shorter series, which
        goes beside it; with other methods to a second run whose steps are shorter by 1.5 (of
        ``gear_gupta_leimkuhler``: one of 32 times the tolerance).  It is enlarged threefold, with
        an allowance for round-off.

    Warns
    -----
    LinearRangeWarning
        If the deflection passes 5 % of the link's length.

    Raises
    ------
    BadInput
        If an argument is unusable or the start does not meet the constraints.
    RedundantConstraints
        If the constraints depend on each other at the start.
    """
    first, last = _span(span)
    times = _times(samples, first, last)
    _check_numbers(method, rtol, step, last - first, bound)
    _check_stages(method, stages)
    start = _start(system, q, qd, first)
    run = _Run(system, start, times, method, rtol, step, tuple(guards), bound, stages)
    made = _march(run, progress)
    error = _error(run, made)
    return _finish(run, made, error, watch, energy)


@dataclass(frozen=True)
class _Run:
    """A request that has been checked."""

    system: Constrained
    start: State
    times: Array
    method: str
    rtol: float
    step: float | None
    guards: tuple[Guard, ...]
    bound: float
    stages: int | None
    refine: float = 1.0
    grid: Array | None = None

    def second(self, ends: Array) -> tuple[_Run, float]:
        """Return the run whose distance tells the error, and the part of the error it shows.

        Its steps are those of this one, whose ends are given, shorter by a factor, so that its
        error is below by a known factor.  Where a library chooses the steps it is a looser run,
        whose own error is above that of this one.
        """
        method = METHODS[self.method]
        if not method.fixed:
            return replace(self, rtol=min(self.rtol * _LOOSER, 0.5), guards=()), 1.0
        shown = (1.0 - _REFINED ** -method.order(self.stages or STAGES)) / _SAFETY
        if not method.gridded:
            return replace(self, refine=_REFINED, guards=()), shown
        number = len(ends) - 1
        places = np.linspace(0.0, number, int(np.ceil(_REFINED * number)) + 1)
        grid = np.interp(places, np.arange(number + 1), ends)
        return replace(self, grid=grid, guards=()), shown


@dataclass
class _Made:
    """States at the given times that were reached."""

    states: list[State]
    ends: list[float]
    evaluations: int
    status: int
    message: str
    gap: Array | None = None

    @property
    def steps(self) -> int:
        """Number of steps."""
        return len(self.ends) - 1


class _Reached:
    """The given times that were passed, the states not yet moved onto the constraints."""

    def __init__(self, start: State, times: Array) -> None:
        self.times, self.count, self.last = times, 1, start.t
        self._known = {0: start}
        self._places: list[int] = []
        self._parts: list[tuple[Array, Array, Array]] = []
        self._number = 1
        self.gap = np.zeros_like(start.q)

    def add(self, state: State) -> None:
        """Add a state that is not at a given time."""
        if self.last < state.t:
            self._known[self._number] = state
            self._number, self.last = self._number + 1, state.t

    def up_to(self, step: Step, end: float) -> None:
        """Add the given times of a step up to one."""
        stop = int(np.searchsorted(self.times, end, side="right"))
        if stop <= self.count:
            return
        inside, self.count = self.times[self.count : stop], stop
        at_end = step.after if inside[-1] == step.after.t else None
        predicted = inside[:-1] if at_end is not None else inside
        if isinstance(step, Window):
            q, qd, gap = step.samples(inside)
            self.gap = np.maximum(self.gap, np.max(gap, axis=0))
            self._parts.append((predicted, q[: len(predicted)], qd[: len(predicted)]))
        elif len(predicted):
            q, qd = (np.array(p) for p in zip(*map(step.between, predicted), strict=True))
            self._parts.append((predicted, q, qd))
        self._places += range(self._number, self._number + len(predicted))
        self._number, self.last = self._number + len(inside), float(inside[-1])
        if at_end is not None:
            self._known[self._number - 1] = at_end

    def states(self, equations: Equations) -> list[State]:
        """Return all states, on the constraints."""
        found = dict(self._known)
        if self._parts:
            t, q, qd = (np.concatenate(parts) for parts in zip(*self._parts, strict=True))
            for first in range(0, len(t), _TOGETHER):
                part = slice(first, first + _TOGETHER)
                moved = nearest_states(equations, t[part], q[part], qd[part])
                found.update(zip(self._places[part], moved, strict=True))
        return [found[i] for i in range(self._number)]


def _march(run: _Run, progress: bool = False) -> _Made:
    from ..core.progress import bar

    start, times, method = run.start, run.times, METHODS[run.method]
    equations = Equations(run.system, start.q, start.qd, start.t)
    q_scale, qd_scale = natural_scales(start, equations.columns)
    longest = float(times[-1] - times[0])
    control = Control(
        run.rtol, q_scale, qd_scale, run.step, longest, run.refine, run.stages, run.grid
    )
    made = _Made([start], [start.t], 0, 0, "the end was reached")
    for guard in run.guards:
        if not guard.left(start) > 0.0:
            raise bad("guards", f"{guard.reason}, at the start", "a start inside", "move it")
    limit = run.bound * np.maximum(np.abs(start.q), q_scale)
    reached = _Reached(start, times)
    # Where a step goes too far numbers may overflow; the steps find that and become shorter.
    with bar(progress, len(times) - 1) as tick, np.errstate(all="ignore"):
        try:
            for taken in method.march(equations, start, times, control):
                made.ends.append(taken.after.t)
                if _collect(equations, run, made, reached, taken, limit):
                    break
                if tick is not None:
                    tick(reached.count - 1)
        except (StoppedEarly, NoConvergence) as reason:
            made.status, made.message = 2, f"{reason}, after t = {reached.last:.6g}"
        made.states = reached.states(equations)
    if method.judged:
        made.gap = reached.gap
    made.evaluations = equations.evaluations
    return made


def _collect(
    equations: Equations, run: _Run, made: _Made, reached: _Reached, step: Step, limit: Array
) -> bool:
    """Add the given times that a step passes; return True where the motion is to stop."""
    parts = [step]
    if isinstance(step, Window) and (run.guards or np.any(step.largest() > limit)):
        parts = step.pieces(equations)
    for part in parts:
        crossing = first_crossing(equations, part, run.guards) if run.guards else None
        if crossing is not None:
            state, guard = crossing
            reached.up_to(step, state.t)
            reached.add(state)
            made.status, made.message = 1, f"{guard.reason}, at t = {state.t:.6g}"
            return True
        end = part.after.t
        if np.any(np.abs(part.after.q) > limit):
            reached.up_to(step, end)
            reached.add(part.after)
            made.status = 1
            made.message = f"the motion diverged: a coordinate passed its bound at t = {end:.6g}"
            return True
    reached.up_to(step, step.after.t)
    return False


def _error(run: _Run, made: _Made) -> Array:
    """Return the largest gap of each coordinate to a second run, with a round-off allowance."""
    if made.gap is not None:
        return _SAFETY * made.gap + _rounding(made.states, _WINDOW * made.steps)
    second, shown = run.second(np.array(made.ends))
    return _figure(made, _march(second), shown)


def _figure(made: _Made, other: _Made, shown: float) -> Array:
    """Return the error from a second run, whose gap shows a part of it."""
    number = min(len(made.states), len(other.states))
    times = np.array([state.t for state in made.states[:number]])
    same = times == np.array([state.t for state in other.states[:number]])
    q = np.array([state.q for state in made.states[:number]])
    gap = np.max(np.abs(q - np.array([s.q for s in other.states[:number]]))[same], axis=0)
    error: Array = gap / shown + _rounding(made.states[:number], float(np.sqrt(made.steps)))
    # A second run that stops before the first tells nothing of what comes after.
    if other.status != 0 and other.states[-1].t < made.states[-1].t:
        return np.full_like(error, np.inf)
    return error


def _rounding(states: list[State], steps: float) -> Array:
    """Return an allowance for round-off in the coordinates."""
    place = np.max(np.abs([state.q for state in states]), axis=0)
    rate = np.max(np.abs([state.qd for state in states]), axis=0)
    # The rounding of each step changes the speeds too, which acts over the rest of the motion.
    way = place + rate * (states[-1].t - states[0].t)
    found: Array = _EPS * (8.0 + steps) * way
    return found


def _finish(
    run: _Run, made: _Made, error: Array, watch: Watch | None, energy: Energy | None
) -> ConstrainedMotion:
    t = np.array([state.t for state in made.states])
    q, qd, qdd, multipliers = (
        np.array([getattr(state, name) for state in made.states])
        for name in ("q", "qd", "qdd", "multipliers")
    )
    norms = constraint_norms(run.system, t, q, qd, qdd)
    return ConstrainedMotion(
        method=run.method,
        error=error,
        error_norm="largest error of a coordinate over the given times, in its own unit, from "
        "its gap to a second run",
        checks=_checks(q, qd, t, norms, watch, energy, made.status),
        provenance=provenance(run.system.provenance),
        time=t,
        q=q,
        qd=qd,
        qdd=qdd,
        multipliers=multipliers,
        position_norm=norms[0],
        velocity_norm=norms[1],
        acceleration_norm=norms[2],
        steps=made.steps,
        evaluations=made.evaluations,
        status=made.status,
        message=made.message,
        labels=run.system.labels,
    )


def _checks(
    q: Array,
    qd: Array,
    t: Array,
    norms: tuple[Array, Array, Array],
    watch: Watch | None,
    energy: Energy | None,
    status: int,
) -> Mapping[str, Check]:
    levels = ("position", "velocity", "acceleration")
    checks = {
        f"{level} constraints": Check(float(np.max(norm)), _KEPT)
        for level, norm in zip(levels, norms, strict=True)
    }
    checks["end reached"] = Check(float(status), 0.0)
    if energy is not None:
        held = np.asarray(energy(q, qd, t), dtype=float)
        size = float(np.max(np.abs(held))) or 1.0
        checks["energy"] = Check(float(np.max(np.abs(held - held[0]))) / size, 1e-6)
    if watch is not None:
        deflection = float(np.max(np.abs(np.asarray(watch(q, t), dtype=float))))
        checks["linear range"] = Check(deflection, LINEAR_RANGE)
        if deflection > LINEAR_RANGE:
            warnings.warn(
                f"deflection reaches {deflection:.3g} of the link's length; small deflections "
                f"were assumed, to about {LINEAR_RANGE}: lower the load or the speed",
                LinearRangeWarning,
                stacklevel=4,
            )
    return checks


def _start(system: Constrained, q: ArrayLike, qd: ArrayLike, t: float) -> State:
    """Return the start, on the constraints."""
    found = consistent_state(system, q, qd, t)
    if found.q.ndim != 1:
        raise bad("q", f"shape {found.q.shape}", f"shape ({system.size},)", "one motion at a time")
    given_q, given_qd = np.asarray(q, dtype=float), np.asarray(qd, dtype=float)
    for name, now, given in (("q", found.q, given_q), ("qd", found.qd, given_qd)):
        size = float(np.max(np.abs(now))) or 1.0
        off = float(np.max(np.abs(now - given)))
        if off > 1e-6 * size:
            raise bad(
                name,
                f"a start {off:.3g} off the constraints",
                "one that meets them",
                "take q and qd of consistent_state(system, q, qd, t)",
            )
    return State(t, found.q, found.qd, found.qdd, found.multipliers)


def _span(span: float | tuple[float, float]) -> tuple[float, float]:
    try:
        ends = np.asarray(span, dtype=float)
    except (TypeError, ValueError) as wrong:
        raise bad("span", repr(span), "a time or two [s]", "correct it") from wrong
    if ends.shape not in ((), (2,)) or not np.isfinite(ends).all():
        raise bad("span", span, "a finite time, or first and last time [s]", "correct it")
    first, last = (0.0, float(ends)) if ends.shape == () else (float(ends[0]), float(ends[1]))
    if not last > first:
        raise bad("span", span, "a last time after the first", "correct it")
    return first, last


def _times(samples: int | ArrayLike, first: float, last: float) -> Array:
    try:
        given = np.asarray(samples, dtype=float)
    except (TypeError, ValueError) as wrong:
        raise bad("samples", repr(samples), "a number or times", "correct it") from wrong
    if given.ndim == 0:
        if not 1 <= given <= _MOST_SAMPLES or given != np.floor(given):
            raise bad("samples", samples, f"a whole number from 1 to {_MOST_SAMPLES}", "correct it")
        return np.linspace(first, last, int(given) + 1)
    inside = given.ndim == 1 and len(given) > 0 and np.isfinite(given).all()
    if not inside or given[0] < first or given[-1] > last or not np.all(np.diff(given) > 0):
        raise bad("samples", "times", f"rising times from {first:g} to {last:g}", "correct them")
    ends = ([] if given[0] == first else [first]), ([] if given[-1] == last else [last])
    times: Array = np.concatenate([ends[0], given, ends[1]])
    return times


def _check_stages(method: str, stages: int | None) -> None:
    least, most = METHODS[method].stages
    if stages is not None and stages not in range(least, most + 1):
        wanted = f"a whole number from {least} to {most} for {method}"
        raise bad("stages", stages, wanted, "correct it")


def _check_numbers(
    method: str, rtol: float, step: float | None, length: float, bound: float
) -> None:
    if method not in METHODS:
        raise bad("method", repr(method), f"one of {list(METHODS)}", "correct the name")
    for name, value in (("rtol", rtol), ("step", step), ("bound", bound)):
        if not (isinstance(value, Real) or (name == "step" and value is None)):
            raise bad(name, repr(value), "a number", "correct it")
    if not 1e-14 <= rtol < 0.1:
        raise bad("rtol", rtol, "a number from 1e-14 to 0.1", "choose 1e-9")
    if step is not None and not 0 < step <= length:
        raise bad("step", step, f"a time up to the span, {length:g} s", "correct it")
    if step is not None and not METHODS[method].fixed:
        raise bad("step", step, f"none, as {method} chooses its steps", "give rtol")
    if step is not None and length / step > 1e8:
        raise bad("step", step, "at most 1e8 steps in all", "lengthen it")
    if not bound > 1:
        raise bad("bound", bound, "a number above 1", "choose 1e9")
