"""Motion of a constrained system over a span of time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from numbers import Real
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import LINEAR_RANGE, Problem, RedundantConstraints, bad, warn_of_large_deflection
from ..core.families import Constrained, Guard
from ..core.families.multipliers import check_rank, scaling
from ..core.inputs import numbers, require_between, require_kind
from ..core.plotting import Axes, draw_coordinates
from ..core.results import FAIR, Check, Result, provenance
from .collocation import Step, StoppedEarly, Tolerance, collocation
from .equations import EPS, LEVELS, SMALL, Array, Equations, NoConvergence, State, constraint_norms


@dataclass(frozen=True, kw_only=True)
class ConsistentState(Result):
    """A state that meets the constraints at all three levels.

    Attributes
    ----------
    q, qd, qdd : ndarray, shape ``(*batch, n)``
        Coordinates, velocities and accelerations.
    multipliers : ndarray, shape ``(*batch, k)``
        Multipliers.
    t : ndarray, shape batch
        Time [s].
    moved : ndarray, shape ``(*batch, n)``
        How far the positions were moved.
    position_norm, velocity_norm, acceleration_norm : ndarray, shape batch
        Scaled defects of the constraints (see :func:`.equations.constraint_norms`).
    iterations : int
        Newton iterations.
    labels : tuple of str
        Names of the coordinates.
    """

    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    t: Array
    moved: Array
    position_norm: Array
    velocity_norm: Array
    acceleration_norm: Array
    iterations: int
    labels: tuple[str, ...]

    arrays_along: ClassVar = {
        "... coordinate": "q qd qdd moved",
        "...": "t position_norm velocity_norm acceleration_norm",
        "... constraint": "multipliers",
    }


def consistent_state(
    system: Constrained,
    q: ArrayLike,
    qd: ArrayLike,
    t: ArrayLike = 0.0,
    *,
    hold: Iterable[str | int] = (),
) -> ConsistentState:
    """Return the nearest state that meets the constraints.

    Positions: Newton's iteration on ``Phi(q, t) = 0``, each correction the smallest in the metric
    of the masses, damped where a full one does not lower the defect.  Velocities: the smallest
    change with ``Phi_q qd = velocity_rhs``.  Accelerations and multipliers: the equations of
    motion with ``Phi_q qdd = gamma``.

    Parameters
    ----------
    system : Constrained
        The system.
    q, qd : array_like, shape ``(*batch, n)``
        Coordinates and velocities near which to look; they broadcast.
    t : array_like, shape batch
        Time [s].
    hold : iterable of str or int
        Coordinates, by label or place, that keep their given position and velocity.

    Returns
    -------
    ConsistentState
        Its ``error`` is the largest scaled defect that is left.

    Raises
    ------
    BadInput
        If an input is not finite or of the wrong shape, a held coordinate is unknown, too many are
        held, or the iteration does not converge: no state near the given one meets the
        constraints.
    RedundantConstraints
        If the constraints repeat or contradict each other there.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "free_free", "model.modes": 2}
    >>> rod = el.load_scene("beale_1992_flexible_rod", changes).system()
    >>> q, qd = rod.reference(0.0)
    >>> state = el.consistent_state(rod, q + 1e-3, qd)
    >>> print(state.position_norm < 1e-12, abs(state.moved).max() < 3e-3)
    True True
    """
    require_kind("system", system, Constrained, "take the .system() of a scene with constraints")
    q0, qd0, time = _given(system, q, qd, t)
    free = _free(system, hold)
    place, speed, count = q0, qd0, 0
    if system.constraints:
        mass = _checked_mass(system, q0, time)
        equations = Equations(system, q0, np.zeros_like(q0), time)
        columns = equations.columns
        try:
            x, count = equations.positions(time, q0 / columns, mass, free)
        except NoConvergence as reason:
            found = "no state nearby that meets the constraints"
            fix = "start nearer to one, hold other coordinates, or check the dimensions"
            raise bad("q", found, "a position that the linkage can take", fix) from reason
        place = x * columns
        at = system.dynamics(place, qd0, time)
        check_rank(at["jacobian"] * free, *scaling(at["mass"], at["jacobian"]))
        speed = qd0 + columns * equations.velocity_change(at, qd0 / columns, free)
    qdd, multipliers = system.accelerations(place, speed, time)
    flat = [values.reshape(-1, system.size) for values in (place, speed, qdd)]
    made = constraint_norms(system, time.reshape(-1), *flat)
    norms: dict[str, Any] = {name: norm.reshape(time.shape) for name, norm in made.items()}
    worst = max(float(np.max(norm, initial=0.0)) for norm in norms.values())
    # Constraints count as met where their scaled defect is of this size.
    return ConsistentState(
        method="Newton's iteration, smallest change in the metric of the masses",
        error=worst,
        error_norm="largest scaled defect of a constraint, at position, velocity or acceleration",
        checks={"constraints": Check(worst, 1e-12)},
        provenance=provenance(system.provenance),
        q=place,
        qd=speed,
        qdd=qdd,
        multipliers=multipliers,
        t=time,
        moved=place - q0,
        iterations=count,
        labels=system.labels,
        **norms,
    )


def _given(
    system: Constrained, q: ArrayLike, qd: ArrayLike, t: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return checked positions, velocities and times of one batch."""
    arrays = {name: numbers(name, value) for name, value in (("q", q), ("qd", qd), ("t", t))}
    n = system.size
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise bad(name, "a number that is not finite", "finite numbers", "correct it")
        if name != "t" and array.shape[-1:] != (n,):
            fix = f"one for each of {', '.join(system.labels)}"
            raise bad(name, f"shape {array.shape}", f"shape (..., {n})", fix)
    shapes = [arrays["q"].shape[:-1], arrays["qd"].shape[:-1], arrays["t"].shape]
    try:
        batch = np.broadcast_shapes(*shapes)
    except ValueError as wrong:
        fix = "correct them"
        raise bad("q, qd, t", f"shapes {shapes}", "shapes that broadcast", fix) from wrong
    places, speeds = (np.broadcast_to(arrays[name], (*batch, n)).copy() for name in ("q", "qd"))
    return places, speeds, np.broadcast_to(arrays["t"], batch).copy()


def _free(system: Constrained, hold: Iterable[str | int]) -> Array:
    """Return 1.0 for the coordinates that may move and 0.0 for those that are held."""
    free = np.ones(system.size)
    for item in hold:
        place = system.labels.index(item) if item in system.labels else item
        if isinstance(place, str) or not 0 <= place < system.size:
            known = f"one of {list(system.labels)} or its place"
            raise bad("hold", repr(item), known, "correct the name")
        free[place] = 0.0
    number, most = system.size - int(free.sum()), max(system.size - system.constraints, 0)
    if number > most:
        fix = "hold fewer"
        raise bad("hold", f"{number} coordinates", f"at most {most}, the degrees of freedom", fix)
    return free


def _checked_mass(system: Constrained, q: Array, t: Array) -> Array:
    """Return the masses; refuse constraints that depend on each other or have no direction."""
    mass = system.dynamics(q, np.zeros_like(q), t)["mass"]
    at = system.violation(q, t)
    if not all(np.isfinite(value).all() for value in (mass, *at.values())):
        raise bad("q", "constraints that are not finite", "a state that they allow", "correct it")
    columns, rows = scaling(mass, at["jacobian"])
    check_rank(at["jacobian"], columns, rows)
    # A vanishing row is short against its size a little aside, by incommensurate parts, so that no
    # symmetry can hide it.
    place = np.max(np.abs(q / columns), axis=-1, keepdims=True)
    # A row of the Jacobian vanishes where it is this much shorter than a little aside.
    parts = 1e-3 * np.cos(1.0 + np.sqrt(2.0) * np.arange(system.size))
    aside = q + np.where(place > 0, place, 1.0) * columns * parts
    here, there = (
        np.linalg.norm(jacobian * columns[..., None, :], axis=-1)
        for jacobian in (at["jacobian"], system.violation(aside, t)["jacobian"])
    )
    if np.any(here <= 1e-9 * there):
        expected = "rows of the Jacobian that do not vanish"
        fix = "leave the position where the linkage can branch"
        raise RedundantConstraints(Problem("constraints", "one without a direction", expected, fix))
    return mass


_MOST_SAMPLES = 2_000_000


@dataclass(frozen=True, kw_only=True)
class ConstrainedMotion(Result):
    """Motion of a constrained system at given times.

    Attributes
    ----------
    time : ndarray, shape (nt,)
        Times reached [s].
    q, qd, qdd : ndarray, shape (nt, n)
        Coordinates, velocities and accelerations.
    multipliers : ndarray, shape (nt, k)
        Multipliers of the constraints.
    position_norm, velocity_norm, acceleration_norm : ndarray, shape (nt,)
        Scaled defects of the constraints (see :func:`.equations.constraint_norms`).
    steps, evaluations : int
        Steps taken, and evaluations of the equations of motion.
    status : int
        0 the end was reached, 1 a guard or the bound stopped the motion, 2 the method gave up.
    message : str
        Why the motion ended.
    labels : tuple of str
        Names of the coordinates.
    error : ndarray, shape (n,)
        Estimate of the largest error of each coordinate, in its own unit.
    """

    time: Array
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    position_norm: Array
    velocity_norm: Array
    acceleration_norm: Array
    steps: int
    evaluations: int
    status: int
    message: str
    labels: tuple[str, ...]

    arrays_along: ClassVar = {
        "sample coordinate": "q qd qdd",
        "sample constraint": "multipliers",
        "sample": "time position_norm velocity_norm acceleration_norm",
        "coordinate": "error",
    }

    @property
    def success(self) -> bool:
        """True where the end was reached."""
        return self.status == 0

    @property
    def at_end(self) -> tuple[Array, Array]:
        """Coordinates and velocities at the last time: a start for going on."""
        return self.q[-1], self.qd[-1]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over time and return the axes."""
        return draw_coordinates(ax, self.time, self.q, self.labels, "time [s]")


def constrained_motion(
    system: Constrained,
    q: ArrayLike | None = None,
    qd: ArrayLike | None = None,
    span: float | tuple[float, float] | None = None,
    *,
    rtol: float = 1e-9,
    samples: int | ArrayLike = 200,
    guards: Sequence[Guard] | None = None,
    bound: float = 1e9,
    progress: bool = False,
) -> ConstrainedMotion:
    """Integrate a constrained system from a state that meets its constraints.

    By Gauss collocation over long windows, all points of a window evaluated at once.

    Parameters
    ----------
    system : Constrained
        The system; its parameters are single numbers.
    q, qd : array_like, shape (n,), optional
        Coordinates and velocities at the start; by default those of the system's reference motion.
        They are moved onto the constraints where they are off by no more than 1e-6; take
        :func:`consistent_state` before if they are further off.
    span : float or pair of float, optional
        Length of the motion from t = 0, or its first and last time [s]; by default a period of the
        system.
    rtol : float
        Relative tolerance of one step.
    samples : int or array_like
        Number of equal intervals between the given times, or the given times [s] themselves.
    guards : sequence of Guard, optional
        Pairs ``(margin, reason)``, conditions that stop the motion (status 1), with their reason
        as message; by default the system's own.
    bound : float
        Size of a coordinate, over its size at the start, at which the motion counts as diverged.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    ConstrainedMotion
        Its ``error`` is the motion's linearised response to the terms that the series of the
        accelerations lack, enlarged by 5, with an allowance for round-off.  Its check ``accuracy``
        compares it with a hundredth of the coordinates' sizes.

    Warns
    -----
    LinearRangeWarning
        If the deflection passes 5 % of the link's length.

    Raises
    ------
    BadInput
        If an argument is unusable, the start does not meet the constraints, or the span would take
        more than 100 000 windows.
    RedundantConstraints
        If the constraints depend on each other at the start.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "free_free", "model.modes": 2}
    >>> rod = el.load_scene("beale_1992_flexible_rod", changes).system()
    >>> motion = el.constrained_motion(rod, span=0.1 * rod.period, samples=9)
    >>> print(motion.q.shape, motion.success, motion.position_norm.max() < 1e-9)
    (10, 5) True True
    """
    require_kind("system", system, Constrained, "take the .system() of a scene with constraints")
    first, last = _span(system.period if span is None else span)
    times = _times(samples, first, last)
    require_between("rtol", rtol, 1e-14, 0.1, "choose 1e-9")
    if not (isinstance(bound, Real) and bound > 1):
        raise bad("bound", repr(bound), "a number above 1", "choose 1e9")
    start = _start(system, q, qd, first)
    kept = tuple(system.guards if guards is None else guards)
    found = march(system, *start, times, rtol, kept, bound, progress)
    if system.watch is None:
        return found
    reached = linear_range(system.watch, found.q, found.time)
    if not reached.passed:
        warn_of_large_deflection(reached.value, "the link's length", "lower the load or the speed")
    return replace(found, checks={**found.checks, "linear range": reached})


def march(
    system: Constrained,
    q: Array,
    qd: Array,
    times: Array,
    rtol: float,
    guards: Sequence[Guard] = (),
    bound: float = 1e6,
    progress: bool = False,
) -> ConstrainedMotion:
    """Follow a motion from a state on the constraints as far as it goes."""
    from ..core.progress import bar

    begin = float(times[0])
    equations = Equations(system, q, qd, begin)
    columns = equations.columns
    start = equations.at(begin, q / columns, qd / columns)
    tolerance = _tolerance(rtol, start)
    for guard in guards:
        if not _margin(equations, guard, start.t, start.x, start.v) > 0.0:
            raise bad("guards", f"{guard[1]}, at the start", "a start inside", "move it")
    parts = [(times[:1], start.x[None], start.v[None])]
    count, steps, error = 1, 0, np.zeros(equations.n)
    status, message = 0, "the end was reached"
    limit = np.zeros(equations.n)
    # Where a step goes too far numbers may overflow; the steps notice and become shorter.
    with bar(progress, len(times) - 1) as tick, np.errstate(all="ignore"):
        try:
            for step in collocation(equations, start, float(times[-1]), tolerance):
                if not steps:  # from rest at the origin a motion has its size from here
                    least = max(tolerance.place, SMALL * float(np.max(step.window.units.place)))
                    limit = bound * np.maximum(np.abs(start.x), least)
                steps += 1
                stopped = _stop(equations, step, guards, limit)
                end, because = (step.after, "") if stopped is None else stopped
                error = np.maximum(error, step.error)
                stop = int(np.searchsorted(times, end.t, side="right"))
                inside, count = times[count:stop], stop
                if stopped is not None and (not len(inside) or inside[-1] < end.t):
                    inside = np.append(inside, end.t)
                if len(inside):
                    x, v = step.at(inside)
                    if inside[-1] == end.t:
                        x[-1], v[-1] = end.x, end.v
                    parts.append((inside, x, v))
                if because:
                    status, message = 1, because
                    break
                tick(count - 1)
        except (StoppedEarly, NoConvergence) as reason:
            status, message = 2, f"{reason}, after t = {parts[-1][0][-1]:.6g}"
        t, x, v, a, multipliers = _on_constraints(equations, parts)
    states = x * columns, v * columns, a * columns
    norms = constraint_norms(system, t, *states)
    # Constraints count as kept where their scaled defect is below this.
    checks = {
        f"{level} constraints": Check(float(np.max(norms[f"{level}_norm"])), 1e-12)
        for level in LEVELS
    }
    error, checks["accuracy"] = _accuracy(t[-1] - t[0], x, v, steps, error)
    return ConstrainedMotion(
        method="collocation",
        error=columns * error,
        error_norm="largest error of a coordinate over the given times, in its own unit",
        checks=checks | {"end reached": Check(float(status), 0.0)},
        provenance=provenance(system.provenance),
        labels=system.labels,
        time=t,
        q=states[0],
        qd=states[1],
        qdd=states[2],
        multipliers=multipliers * equations.rows,
        **norms,
        steps=steps,
        evaluations=equations.evaluations,
        status=status,
        message=message,
    )


def _accuracy(span: float, x: Array, v: Array, steps: int, error: Array) -> tuple[Array, Check]:
    """Return error estimates of scaled coordinates, and the largest over their sizes as a check."""
    reach = np.max(np.abs(x), axis=0)
    # Rounding changes the speeds too, which acts over the rest of the motion: roundings of a long
    # window may all lie on one side.
    rounding = EPS * (8.0 + 20.0 * steps) * (reach + np.max(np.abs(v), axis=0) * span)
    # Estimates are enlarged: with 5 they cover 99 of 100 pendulums, rods and forces that jump, and
    # all of 1300 with 6.
    error = 6.0 * error + rounding
    size = np.maximum(reach, max(SMALL * float(np.max(reach)), 1e-300))
    return error, Check(float(np.max(error / size)), FAIR)


def _on_constraints(
    equations: Equations, parts: Sequence[tuple[Array, Array, Array]]
) -> tuple[Array, ...]:
    """Return times and whole states of samples, of the first half where not all of them exist."""
    t, x, v = (np.concatenate(part) for part in zip(*parts, strict=True))
    try:
        x, v = equations.nearest(t, x, v)
        return t, x, v, *equations.accelerations(t, x, v)
    except NoConvergence:
        if len(parts) == 1:
            raise
        return _on_constraints(equations, parts[: len(parts) // 2])


def _tolerance(rtol: float, start: State) -> Tolerance:
    """Return the tolerance, absolute for coordinates and velocities far below the largest."""
    place = max(float(np.max(np.abs(start.x))), 1e-300)
    # A motion that starts from rest gets speeds of the order sqrt(acceleration x length).
    push = float(np.sqrt(place) * np.sqrt(np.max(np.abs(start.a))))
    speed = max(float(np.max(np.abs(start.v))), push, 1e-300)
    return Tolerance(rtol, SMALL * place, speed)


def _margin(equations: Equations, guard: Guard, t: float, x: Array, v: Array) -> float:
    """Return the margin of a guard at a state in scaled coordinates."""
    columns = equations.columns
    value = np.asarray(guard[0](float(t), x * columns, v * columns), dtype=float)
    if value.shape != () or np.isnan(value):
        raise bad("guards", f"{value} at t = {t:.6g}", "one number", "mend the margin")
    return float(value)


def _stop(
    equations: Equations, step: Step, guards: Sequence[Guard], limit: Array
) -> tuple[State, str] | None:
    """Return where and why a step stops the motion; None where it goes on."""
    if not guards and np.all(step.window.units.place <= limit):
        return None
    x, v = step.at(step.inner)
    # Mostly all is well by far: only what may stop the motion is carried onto the constraints.
    passed = [(step.after.t, step.after.x, step.after.v), *zip(step.inner, x, v, strict=True)]
    bounded = np.all(np.abs(x) <= limit) and np.all(np.abs(step.after.x) <= limit)
    if bounded and all(_margin(equations, guard, *at) > 0.0 for at in passed for guard in guards):
        return None
    x, v = equations.nearest(step.inner, x, v)
    a, _ = equations.accelerations(step.inner, x, v)
    inner = [State(float(t), *at) for t, *at in zip(step.inner, x, v, a, strict=True)]
    for before, after in pairwise([step.window.before, *inner, step.after]):
        met = [g for g in guards if not _margin(equations, g, after.t, after.x, after.v) > 0.0]
        stops = [(_crossing(equations, step, guard, before, after), guard) for guard in met]
        if stops:
            state, guard = min(stops, key=lambda stop: stop[0].t)
            return state, f"{guard[1]}, at t = {state.t:.6g}"
        if np.any(np.abs(after.x) > limit):
            what = "the motion diverged: a coordinate passed its bound"
            return after, f"{what} at t = {after.t:.6g}"
    return None


def _crossing(equations: Equations, step: Step, guard: Guard, before: State, after: State) -> State:
    """Return the state at which a guard is met between two states, by halving."""
    low = before.t
    for _ in range(60):
        middle = 0.5 * (low + after.t)
        if not low < middle < after.t:
            break
        try:
            x, v = step.at(np.array([middle]))
            state = equations.state(middle, x[0], v[0])
        except NoConvergence:
            break
        if _margin(equations, guard, state.t, state.x, state.v) > 0.0:
            low = middle
        else:
            after = state
    return after


def linear_range(watch: Callable[[Array, Array], ArrayLike], q: Array, t: Array) -> Check:
    """Compare the largest deflection over the link's length with 5 %."""
    deflection = float(np.max(np.abs(np.asarray(watch(q, t), dtype=float))))
    return Check(deflection, LINEAR_RANGE)


# Input ------------------------------------------------------------------------------------------


def _start(
    system: Constrained, q: ArrayLike | None, qd: ArrayLike | None, t: float
) -> tuple[Array, Array]:
    """Return coordinates and velocities of the start, on the constraints."""
    if q is None or qd is None:
        if system.reference is None:
            raise bad("q, qd", "none", "a start: the system has no reference motion", "give both")
        place, speed = system.reference(np.asarray(t))
        q, qd = place if q is None else q, speed if qd is None else qd
    state = consistent_state(system, q, qd, t)
    if state.q.ndim != 1:
        raise bad("q", f"shape {state.q.shape}", f"shape ({system.size},)", "one motion at a time")
    for name, now, given in (("q", state.q, q), ("qd", state.qd, qd)):
        off = float(np.max(np.abs(now - np.asarray(given, dtype=float))))
        if off > 1e-6 * (float(np.max(np.abs(now))) or 1.0):
            fix = "take q and qd of consistent_state(system, q, qd, t)"
            raise bad(name, f"a start {off:.3g} off the constraints", "one that meets them", fix)
    return state.q, state.qd


def _span(span: float | tuple[float, float] | None) -> tuple[float, float]:
    if span is None:
        raise bad("span", "none", "a time, as the system has no period", "give one [s]")
    ends = numbers("span", span)
    if ends.shape not in ((), (2,)) or not np.isfinite(ends).all():
        raise bad("span", span, "a finite time, or first and last time [s]", "correct it")
    first, last = (0.0, float(ends)) if ends.shape == () else (float(ends[0]), float(ends[1]))
    if not last > first:
        raise bad("span", span, "a last time after the first", "correct it")
    return first, last


def _times(samples: int | ArrayLike, first: float, last: float) -> Array:
    given = numbers("samples", samples)
    if given.ndim == 0:
        if not 1 <= given <= _MOST_SAMPLES or given != np.floor(given):
            raise bad("samples", samples, f"a whole number from 1 to {_MOST_SAMPLES}", "correct it")
        return np.linspace(first, last, int(given) + 1)
    inside = given.ndim == 1 and len(given) > 0 and np.isfinite(given).all()
    if not inside or given[0] < first or given[-1] > last or not np.all(np.diff(given) > 0):
        raise bad("samples", "times", f"rising times from {first:g} to {last:g}", "correct them")
    return np.unique(np.concatenate([[first], given, [last]]))
