"""Periodic motions of constrained systems, by multiple shooting on the constraints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from numbers import Real
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import SelfCheckFailed, bad
from ..core.families import Constrained
from ..core.families.multipliers import check_rank, scaling
from ..core.files import NOT_SAVED
from ..core.inputs import numbers, require_kind
from ..core.plotting import Axes, axes_or_new, coordinates_label
from ..core.results import Check, Result, provenance
from ..periodic.ring import solve_ring
from .collocation import Nodes, at_places, nodes, stage_matrix
from .equations import EPS, Array, Equations, Linearised, NoConvergence, constraint_norms, solved
from .motion import linear_range, march

STAGES = 12
# Phase of the fastest motion that a first step covers [rad]; 12 stages err 1e-14 a step at 5.
_PHASE = 5.0
_FEWEST, _MOST_STEPS = 12, 8192
# States at which the guess is looked at, and at which a reference motion is one.
_WATCHED, _SAMPLES = 24, 64
_ITERATIONS, _LEAST_DAMPING = 40, 1.0 / 256
# Newton has arrived where its step, relative to the orbit, is rounding, or where it stops shrinking
# below the second; the defect that is left passes below the third.
_ROUNDING, _SMALL, _ARRIVED = 64 * EPS, 1e-8, 1e-9
# Of the difference between a grid and one twice as fine, in the finer one (order 24: 2^-24).
LEFT = 1.0 / 64


@dataclass(frozen=True)
class Ring:
    """A motion over one period as even collocation steps, each from a state of its own; scaled."""

    period: float  # period [s]
    advance: Array  # (n,): what the coordinates gain over a period
    # x, v: (m, n): states at the beginnings of the steps
    x: Array
    v: Array
    a: Array  # (m, s, n): accelerations at the Gauss points of each step

    @property
    def step(self) -> float:
        """Length of a step [s]."""
        return self.period / len(self.x)

    @property
    def start(self) -> Array:
        """Times at which the steps begin [s]."""
        return np.asarray(np.arange(len(self.x)) * self.step, dtype=np.float64)

    @property
    def points(self) -> Nodes:
        """Nodes of a step."""
        return nodes(self.a.shape[1])

    @property
    def times(self) -> Array:
        """Times of the Gauss points, shape ``(m, s)``."""
        return np.asarray(self.start[:, None] + self.step * self.points.c)

    def stages(self) -> tuple[Array, Array]:
        """Return coordinates and velocities at the Gauss points, shape ``(m, s, n)``."""
        h, points = self.step, self.points
        x = self.x[:, None] + h * points.c[:, None] * self.v[:, None]
        return x + h * h * (points.twice @ self.a), self.v[:, None] + h * (points.once @ self.a)

    def gaps(self) -> tuple[Array, Array]:
        """Return the ends of the steps less the beginnings of the next, shape ``(m, n)``."""
        h, b, c = self.step, self.points.b, self.points.c
        ahead = np.roll(self.x, -1, axis=0)
        ahead[-1] += self.advance
        x = self.x + h * (self.v + h * ((b * (1.0 - c)) @ self.a))
        return x - ahead, self.v + h * (b @ self.a) - np.roll(self.v, -1, axis=0)

    def at(self, t: Array) -> tuple[Array, Array]:
        """Return coordinates and velocities at any times ``(nt,)``, by the collocation itself."""
        turns = np.floor(t / self.period)
        within = (t - turns * self.period) / self.step
        j = np.clip(within.astype(int), 0, len(self.x) - 1)
        part, h = within - j, self.step
        values = at_places(part, self.a.shape[1]) @ (self.points.series @ self.a)[j]
        twice, once = values[:, 0], values[:, 1]
        x = self.x[j] + h * part[:, None] * self.v[j] + h * h * twice
        return x + turns[:, None] * self.advance, self.v[j] + h * once

    def refined(self) -> Ring:
        """Return the same motion on twice as many steps."""
        s, m, points = self.a.shape[1], 2 * len(self.x), self.points
        x, v = self.at(np.asarray(np.arange(m) * (self.period / m), dtype=np.float64))
        halves = np.concatenate([points.c, 1.0 + points.c]) - 1.0
        spread = np.polynomial.legendre.legvander(halves, s - 1) @ points.series
        return replace(self, x=x, v=v, a=(spread @ self.a).reshape(m, s, -1))


@dataclass(frozen=True)
class Sweep:
    """The steps of a ring linearised: what each passes on, and what is wrong with it.

    States are ``(x, v / rate)``.
    """

    slopes: Linearised  # at the Gauss points, shape ``(m, s)`` in front
    maps: Array  # (m, 2n, 2n): derivative of the end of each step by its beginning
    # (m, 2n): end of each step, its stages corrected, less the beginning of the next
    gap: Array
    # change, response: (m, s, n), (m, s, n, 2n): correction of the stage accelerations, and
    # their derivative by the beginning
    change: Array
    response: Array
    defect: float  # largest defect of a stage or a junction


def sweep(equations: Equations, ring: Ring, rate: float) -> Sweep:
    """Linearise all steps of a ring at once.

    The stage accelerations are the unknowns of a step:
    ``A_i = f(x + c_i h v + h^2 sum_j (a a)_ij A_j, v + h sum_j a_ij A_j)``.
    """
    slopes = equations.linearised(ring.times, *ring.stages())
    m, s, n = ring.a.shape
    h, points = ring.step, ring.points
    wrong = slopes.a - ring.a
    late = (h * points.c)[:, None, None] * slopes.by_x + slopes.by_v
    right = np.concatenate([wrong[..., None], slopes.by_x, rate * late], axis=-1)
    stages = np.empty((m, s * n, 1 + 2 * n))
    # Numbers of a batch of stage matrices that stay in a cache while they are solved.
    chunk = max((1 << 18) // (s * n) ** 2, 1)
    for first in range(0, m, chunk):
        part = slice(first, first + chunk)
        matrix = stage_matrix(slopes.by_x[part], slopes.by_v[part], h, points)
        stages[part] = solved(matrix, right[part].reshape(-1, s * n, 1 + 2 * n))
    stages = stages.reshape(right.shape)
    rise = h * np.einsum("i,minx->mnx", points.b, stages)
    move = h**2 * np.einsum("i,minx->mnx", points.b * (1.0 - points.c), stages)
    effect = np.concatenate([move, rise / rate], axis=1)
    maps = effect[..., 1:] + np.eye(2 * n) + h * rate * np.eye(2 * n, k=n)
    gap = ring.gaps()
    junction = np.concatenate([gap[0], gap[1] / rate], axis=-1)
    worst = max(float(np.max(np.abs(junction))), float(np.max(np.abs(wrong))) * h / rate)
    return Sweep(slopes, maps, junction + effect[..., 0], stages[..., 0], stages[..., 1:], worst)


@dataclass(frozen=True)
class Tangent:
    """The manifold of the constraints, at states: what leaves it and what stays."""

    # (*batch, 2k, 2n): derivatives of ``Phi`` and of ``dPhi/dt / rate`` by the state
    normals: Array
    along: Array  # (*batch, 2n, 2n - 2k): orthonormal basis of the tangent space
    across: Array  # (*batch, 2n, 2k): orthonormal basis of its complement


def tangent(equations: Equations, slopes: Linearised, rate: float) -> Tangent:
    """Return the tangent space of the constraint manifold at linearised states."""
    n, k = equations.n, equations.k
    factor = equations.rows[:, None] * equations.columns
    jacobian = factor * slopes.terms["jacobian"]
    normals = np.zeros((*jacobian.shape[:-2], 2 * k, 2 * n))
    normals[..., :k, :n] = normals[..., k:, n:] = jacobian
    normals[..., k:, :n] = factor * slopes.variations["jacobian_rate"] / rate
    basis = np.linalg.qr(np.swapaxes(normals, -1, -2), mode="complete")[0]
    return Tangent(normals, basis[..., 2 * k :], basis[..., : 2 * k])


@dataclass(frozen=True)
class Shot:
    """Where the iteration came to."""

    ring: Ring  # the motion
    sweep: Sweep  # its linearisation
    residual: float = np.inf  # largest defect of a stage or junction, relative to the motion's size
    iterations: int = 0  # Newton steps
    reason: str = ""  # empty where the iteration converged, else why not


@dataclass(frozen=True)
class Shooting:
    """Newton's iteration for a periodic motion, in tangent coordinates.

    The unknowns are the stage accelerations of all steps and the tangent coordinates of the
    states where steps meet; after each Newton step these states are moved onto the constraints.
    """

    equations: Equations  # the system
    rate: float  # of motions, which makes velocities comparable with coordinates [rad/s]

    def state(self, x: Array, v: Array) -> Array:
        """Return whole states, shape ``(*batch, 2n)``."""
        return np.concatenate([x, v / self.rate], axis=-1)

    def size(self, ring: Ring) -> float:
        """Return the largest number of the states."""
        return float(max(np.max(np.abs(self.state(ring.x, ring.v))), np.finfo(float).tiny))

    def junctions(self, ring: Ring) -> Tangent:
        """Return the tangent spaces where the steps meet."""
        slopes = self.equations.linearised(ring.start, ring.x, ring.v)
        return tangent(self.equations, slopes, self.rate)

    def solve(self, ring: Ring) -> Shot:
        """Return the periodic motion near a ring, by damped steps of Newton."""
        try:
            here = Shot(ring, sweep(self.equations, ring, self.rate))
        except NoConvergence as refusal:
            raise _no_guess(str(refusal)) from refusal
        before = np.inf
        for count in range(_ITERATIONS):
            size = self.size(here.ring)
            here = replace(here, residual=here.sweep.defect / size, iterations=count)
            try:
                *step, length = self._newton_step(here)
                length /= size
                if before / 2 < length < _SMALL:
                    return here
                taken, part = self._damped(here, step)
            except NoConvergence as reason:
                return replace(here, reason=f"diverging shooting: {reason}")
            if length <= _ROUNDING:
                return replace(taken, residual=taken.sweep.defect / size, iterations=count + 1)
            here, before = taken, length if part == 1.0 else np.inf
        return replace(here, reason=f"diverging shooting: not there after {_ITERATIONS} steps")

    def _newton_step(self, here: Shot) -> tuple[Array, Array, Array, float]:
        """Return the changes of states and stage accelerations, and the largest of them."""
        ring, swept, n = here.ring, here.sweep, self.equations.n
        along, within = self._closed(here, swept.gap[..., None])
        change = (along @ within)[..., 0]
        a = swept.change + (swept.response @ change[:, None, :, None])[..., 0]
        inner = float(np.max(np.abs(a))) * ring.step / self.rate
        largest = max(float(np.max(np.abs(change))), inner)
        return change[:, :n], change[:, n:] * self.rate, a, largest

    def _damped(self, here: Shot, step: Sequence[Array]) -> tuple[Shot, float]:
        """Return the motion after a step, and the part of it that was taken."""
        part, ring = 1.0, here.ring
        reason = NoConvergence("no shortened Newton step lessens the defect")
        while part >= _LEAST_DAMPING:
            old = ring.x, ring.v, ring.a
            x, v, a = (value + part * new for value, new in zip(old, step, strict=True))
            try:
                with np.errstate(all="ignore"):
                    x, v = self.equations.nearest(ring.start, x, v)
                    moved = replace(ring, x=x, v=v, a=a)
                    swept = sweep(self.equations, moved, self.rate)
            except NoConvergence as refusal:
                reason = refusal
            else:
                limit = (1.0 - part / 4) * here.sweep.defect
                rounding = _SMALL * self.size(moved) if part == 1.0 else 0.0
                if swept.defect <= max(limit, rounding):
                    return Shot(moved, swept), part
            part /= 2
        raise reason

    def _closed(self, shot: Shot, wrong: Array) -> tuple[Array, Array]:
        """Return the tangent spaces, and the changes in them ``(m, p, k)`` that close the ring."""
        # The ends of the steps are off by wrong (m, 2n, k).
        along = self.junctions(shot.ring).along
        back = np.swapaxes(np.roll(along, -1, axis=0), -1, -2)
        maps, loads = back @ shot.sweep.maps @ along, np.moveaxis(back @ wrong, -1, 0)
        if not loads.size:  # constraints that leave nothing free
            return along, np.moveaxis(loads, 0, -1)
        solution, _ = solve_ring(np.broadcast_to(maps, (len(loads), *maps.shape)), loads)
        if not np.all(np.isfinite(solution)):
            raise NoConvergence("singular, a multiplier of the motion is 1")
        return along, np.moveaxis(solution, 0, -1)

    def rounding(self, shot: Shot) -> float:
        """Return what rounding in every step does to the motion, by random samples of it."""
        size = self.size(shot.ring)
        # Of one step of the motion's size; enlarged for the largest of more samples.
        shape = (*shot.sweep.gap.shape, 4)
        noise = np.random.default_rng(0).normal(size=shape) * size * EPS
        try:
            _, moved = self._closed(shot, noise)
        except NoConvergence:
            return np.inf
        return 4.0 * float(np.max(np.abs(moved), initial=0.0)) / size

    def error(self, coarse: Shot, fine: Shot) -> float:
        """Return the error of the finer motion: what refinement changed, and rounding."""
        x, v = fine.ring.x[::2] - coarse.ring.x, fine.ring.v[::2] - coarse.ring.v
        gap = float(np.max(np.abs(self.state(x, v)))) / self.size(fine.ring)
        return gap * LEFT + self.rounding(fine)


@dataclass(frozen=True)
class OrbitSource:
    """What multipliers are made of: the motion on its steps, and on half as many."""

    shooting: Shooting
    fine: Shot
    coarse: Shot


@dataclass(frozen=True, kw_only=True)
class PeriodicOrbit(Result):
    """A periodic motion of a constrained system.

    Attributes
    ----------
    t : ndarray, shape (m,)
        Even times over one period [s], from 0.
    q, qd, qdd : ndarray, shape (m, n)
        Coordinates, velocities and accelerations.
    multipliers : ndarray, shape (m, k)
        Multipliers of the constraints.
    period : float
        Period [s].
    advance : ndarray, shape (n,)
        What the coordinates gain over a period.
    error : float
        Largest error of a coordinate (times the root of its mass), or of a velocity over the
        rate of the system's own vibrations, relative to the largest of them.
    residual : float
        Largest defect left at the junctions of the segments, in the same units.
    iterations : int
        Newton steps on all grids.
    position_norm, velocity_norm, acceleration_norm : float
        Largest violation of a constraint within the steps, at the three levels, scaled as
        :func:`.equations.constraint_norms` says.
    deflection : float
        Largest value of the system's ``watch``; NaN where there is none.
    moved : float
        Largest distance of the motion from the guess, at the times of the guess, in the units of
        ``error`` and over the larger of the two: near 1 it is another motion than the one meant.
    message : str
        Empty, or why the motion is not one: a diverging shooting.
    labels : tuple of str
        Names of the coordinates.
    """

    t: Array
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    period: float
    advance: Array
    residual: float
    iterations: int
    position_norm: float
    velocity_norm: float
    acceleration_norm: float
    deflection: float
    moved: float
    message: str
    labels: tuple[str, ...]
    source: OrbitSource = field(repr=False, metadata=NOT_SAVED)

    arrays_along: ClassVar = {
        "t": "t",
        "t coordinate": "q qd qdd",
        "t constraint": "multipliers",
        "coordinate": "advance",
    }
    column_units: ClassVar = {"s": "period"}

    @property
    def converged(self) -> bool:
        """True where the shooting arrived."""
        return not self.message

    def require(self) -> None:
        """Raise :class:`.errors.SelfCheckFailed` with the reason where there is no such motion."""
        if self.message:
            raise SelfCheckFailed(f"{type(self).__name__}: {self.message}")
        super().require()

    def at(self, t: ArrayLike) -> tuple[Array, Array]:
        """Return coordinates and velocities at any times, shape ``(nt,)`` to ``(nt, n)``."""
        columns = self.source.shooting.equations.columns
        x, v = self.source.fine.ring.at(np.atleast_1d(np.asarray(t, dtype=float)))
        return x * columns, v * columns

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over one period, each less its mean, and return the axes."""
        ax = axes_or_new(ax)
        t = np.append(self.t / self.period, 1.0)
        q = self.q - np.multiply.outer(t[:-1], self.advance)
        for values, name in zip((q - q.mean(axis=0)).T, self.labels, strict=True):
            ax.plot(t, np.append(values, values[0]), linewidth=1.0, label=name)
        names = coordinates_label(self.labels)
        ax.set(xlabel="time over period", ylabel=f"{names}, less their means")
        ax.legend(frameon=False, fontsize="small")
        return ax


def periodic_orbit(
    system: Constrained,
    period: float | None = None,
    q: ArrayLike | None = None,
    qd: ArrayLike | None = None,
    *,
    advance: ArrayLike | None = None,
    rtol: float = 1e-10,
) -> PeriodicOrbit:
    """Find a periodic motion from a guess, near it where the guess is good: see ``moved``.

    Multiple shooting with one Gauss-Legendre step of order 24 a segment.  The unknowns are the
    tangent coordinates of the constraint manifold where segments meet; the variational equations
    of the steps give the Newton matrix, the constraints are met by projection.

    Parameters
    ----------
    system : Constrained
        With variations; its dependence on time must have the period.
    period : float, optional
        Period [s]; by default the system's.
    q, qd : array_like, shape (n,) or (samples, n), optional
        Guess: the state at t = 0, from which the motion is followed for a period, or the motion at
        even times from 0, its end left out, which is then interpolated; by default the system's
        reference motion.
    advance : array_like, shape () or (n,), optional
        What the coordinates gain over a period: 2 pi for the angle of a link that turns; by
        default the system's.
    rtol : float
        Wanted error of the motion relative to its size.

    Returns
    -------
    PeriodicOrbit
        Where the iteration does not arrive, ``message`` says why, the check ``converged`` fails,
        and the motion is the last iterate.  From a bad guess it may arrive at quite another
        motion, at rest for one that swings, say, and all checks pass: ``moved`` tells how far it
        is from the guess.  Each guard of the system is a check of the name of its reason.

    Raises
    ------
    BadInput
        If a number is unusable, shapes do not fit, the system has no variations, or it does not
        repeat after the period.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "free_free", "model.modes": 2}
    >>> rod = el.load_scene("beale_1992_flexible_rod", changes).system()
    >>> orbit = el.periodic_orbit(rod)
    >>> print(orbit.converged, round(orbit.period, 5))
    True 0.06283
    """
    require_kind("system", system, Constrained, "take the .system() of a scene with constraints")
    if not (isinstance(rtol, Real) and 0 < rtol < 1):
        raise bad("rtol", repr(rtol), "a number between 0 and 1", "try 1e-10")
    guess = _checked(system, period, q, qd, advance)
    shooting, ring = _first(system, guess)
    coarse = shooting.solve(ring)
    iterations, error, before = coarse.iterations, np.inf, np.inf
    fine = coarse
    while not coarse.reason:
        fine = shooting.solve(coarse.ring.refined())
        iterations += fine.iterations
        error = shooting.error(coarse, fine)
        # Where halving the steps does not help, rounding is what is left.
        if fine.reason or error <= rtol or error > before / 2 or len(fine.ring.x) > _MOST_STEPS:
            break
        coarse, before = fine, error
    source = OrbitSource(shooting, fine, coarse)
    return _result(source, guess, error, iterations, Check(error, rtol))


def _result(
    source: OrbitSource, guess: _Guess, error: float, iterations: int, accuracy: Check
) -> PeriodicOrbit:
    shot, equations = source.fine, source.shooting.equations
    ring, system, columns = shot.ring, equations.system, equations.columns
    a, multipliers = equations.accelerations(ring.start, ring.x, ring.v)
    inside = [
        (values * columns).reshape(-1, system.size)
        for values in (*ring.stages(), shot.sweep.slopes.a)
    ]
    times = ring.times.ravel()
    norms = constraint_norms(system, times, *inside)
    largest: dict[str, Any] = {name: float(np.max(norm)) for name, norm in norms.items()}
    checks = {
        "converged": Check(shot.residual if not shot.reason else np.inf, _ARRIVED),
        "accuracy": accuracy,
    }
    deflection = float("nan")
    if system.watch is not None:
        checks["linear range"] = linear_range(system.watch, inside[0], times)
        deflection = checks["linear range"].value
    given = source.shooting.state(guess.q / columns, guess.qd / columns)
    with np.errstate(all="ignore"):
        reached = source.shooting.state(*ring.at(guess.times))
    size = max(float(np.max(np.abs(state))) for state in (given, reached))
    q, qd = ring.x * columns, ring.v * columns
    pick = slice(None, None, max(len(q) // _SAMPLES, 1))
    for margin, reason in system.guards:
        states = zip(ring.start[pick].tolist(), q[pick], qd[pick], strict=True)
        least = min(margin(*state) for state in states)
        checks[reason] = Check(max(-float(least), 0.0), 0.0)
    return PeriodicOrbit(
        method=f"multiple shooting, {len(ring.x)} Gauss-Legendre steps of order {2 * STAGES}",
        error=error,
        error_norm="largest of coordinates and scaled velocities, relative to the largest",
        checks=checks,
        provenance=provenance(system.provenance),
        t=ring.start,
        q=q,
        qd=qd,
        qdd=a * columns,
        multipliers=multipliers * equations.rows,
        period=ring.period,
        advance=guess.advance,
        residual=shot.residual,
        iterations=iterations,
        deflection=deflection,
        moved=float(np.max(np.abs(reached - given))) / size if size > 0 else 0.0,
        message=shot.reason,
        labels=system.labels,
        source=source,
        **largest,
    )


# From a guess to a first ring ---------------------------------------------------------------------


@dataclass(frozen=True)
class _Guess:
    """A guess of a periodic motion: one state at t = 0, or states at even times over a period."""

    period: float
    advance: Array
    q: Array
    qd: Array

    @property
    def times(self) -> Array:
        """Times of the states [s]."""
        return np.asarray(np.arange(len(self.q)) * (self.period / len(self.q)), np.float64)


def _checked(
    system: Constrained,
    period: float | None,
    q: ArrayLike | None,
    qd: ArrayLike | None,
    advance: ArrayLike | None,
) -> _Guess:
    """Return the guess as arrays, having checked numbers, shapes and the system's period."""
    if system.variations is None:
        expected, fix = "one with variations", "emit the model with the output 'variations'"
        raise bad("system", "no variational equations", expected, fix)
    period = system.period if period is None else period
    if not (isinstance(period, Real) and np.isfinite(float(period)) and period > 0):
        raise bad("period", repr(period), "a finite number above 0 [s]", "correct it")
    n = system.size
    if q is None or qd is None:
        if system.reference is None:
            raise bad("q, qd", "none", "a guess: the system has no reference motion", "give both")
        even = np.arange(_SAMPLES) * (period / _SAMPLES)
        q, qd = (
            reference if given is None else given
            for given, reference in zip((q, qd), system.reference(even), strict=True)
        )
    gain = numbers("advance", system.advance if advance is None else advance)
    states = [_states(name, values, n) for name, values in (("q", q), ("qd", qd))]
    if states[0].shape != states[1].shape:
        raise bad("qd", f"shape {np.shape(qd)}", f"that of q, {np.shape(q)}", "give both alike")
    if gain.shape not in ((), (n,)) or not np.all(np.isfinite(gain)):
        raise bad("advance", advance, f"a finite number, or {n} of them", "correct it")
    guess = _Guess(float(period), np.broadcast_to(gain, (n,)).copy(), *states)
    _check_period(system, guess)
    at = system.dynamics(guess.q, guess.qd, guess.times)
    check_rank(at["jacobian"], *scaling(at["mass"], at["jacobian"]))
    return guess


def _states(name: str, values: ArrayLike, n: int) -> Array:
    given = numbers(name, values)
    if given.shape not in ((n,), (len(given) if given.ndim else 0, n)) or not given.size:
        fix = "give one state or several"
        raise bad(name, f"shape {given.shape}", f"({n},), or (samples, {n}) over a period", fix)
    if not np.all(np.isfinite(given)):
        raise bad(name, "a value that is not finite", "finite numbers", "correct it")
    return given.reshape(-1, n)


def _check_period(system: Constrained, guess: _Guess) -> None:
    """Refuse a system that is another one a period later."""
    t = np.linspace(0.0, guess.period, _WATCHED, endpoint=False)
    pick = np.arange(_WATCHED) * len(guess.q) // _WATCHED
    q, qd = guess.q[pick], guess.qd[pick]
    if len(guess.q) == 1:
        q = q + np.multiply.outer(t / guess.period, guess.advance)
    now, later = (
        {**system.dynamics(q + gain, qd, t + late), **system.violation(q + gain, t + late)}
        for gain, late in ((0.0, 0.0), (guess.advance, guess.period))
    )
    place, speed = (float(np.max(np.abs(values), initial=0.0)) for values in (q, qd))
    rate = 2.0 * np.pi / guess.period
    row, mass = (float(np.max(np.abs(now[name]), initial=0.0)) for name in ("jacobian", "mass"))
    # Where an array is small or zero, what would be noticed beside its neighbours in the equations.
    beside = {"constraints": row * place, "velocity_rhs": row * speed, "gamma": row * speed * rate}
    beside |= dict.fromkeys(("rest", "forces"), mass * speed * rate)
    for name, values in now.items():
        size = max(float(np.max(np.abs(values), initial=0.0)), beside.get(name, 0.0))
        gap = float(np.max(np.abs(later[name] - values), initial=0.0))
        # A system that differs by more after a period has another period.
        if not gap <= 1e-9 * size:
            found = f"{guess.period:.9g} s, after which {name} differs by {gap:.3g}"
            fix = "give the period of the drive, and in advance what angles gain over it"
            raise bad("period", found, "a system that repeats after the period", fix)


def _first(system: Constrained, guess: _Guess) -> tuple[Shooting, Ring]:
    """Return the guess on even collocation steps, moved onto the constraints, and its units."""
    # The rate that makes velocities comparable is the geometric mean of the frozen vibrations:
    # between the slowest and the fastest mode no other unit of time leaves the eigenvectors of the
    # flow better conditioned.
    from scipy.interpolate import CubicHermiteSpline

    equations = Equations(system, guess.q, guess.qd, guess.times)
    columns, turning = equations.columns, 2.0 * np.pi / guess.period
    try:
        rates = np.maximum(frozen_rates(equations, guess, turning), turning)
        mean = float(np.exp(np.mean(np.log(rates)))) if rates.size else turning
        path = guess if len(guess.q) > 1 else _followed(system, guess, _WATCHED)
        steps = _steps(frozen_rates(equations, path, mean), guess.period)
        if len(guess.q) == 1:
            path = _followed(system, guess, steps)
        q = np.concatenate([path.q, path.q[:1] + guess.advance]) / columns
        qd = np.concatenate([path.qd, path.qd[:1]]) / columns
        spline = CubicHermiteSpline(np.append(path.times, guess.period), q, qd)
        start = np.asarray(np.arange(steps) * (guess.period / steps), dtype=np.float64)
        x, v = equations.nearest(start, spline(start), spline(start, 1))
    except NoConvergence as reason:
        raise _no_guess(f"the motion from the guess cannot be followed: {reason}") from reason
    empty = np.zeros((steps, STAGES, equations.n))
    ring = Ring(guess.period, guess.advance / columns, x, v, empty)
    return Shooting(equations, mean), replace(ring, a=spline(ring.times, 2))


def _no_guess(reason: str) -> Exception:
    return bad("guess", reason, "a motion that stays finite for a period", "give a better one")


def _followed(system: Constrained, guess: _Guess, samples: int) -> _Guess:
    """Return the motion from one state at even times over a period."""
    equations = Equations(system, guess.q[0], guess.qd[0], 0.0)
    columns = equations.columns
    x, v = equations.nearest(0.0, guess.q[0] / columns, guess.qd[0] / columns)
    times = np.linspace(0.0, guess.period, samples + 1)
    path = march(system, x * columns, v * columns, times, 1e-8)
    if path.status:
        raise _no_guess(f"the motion from the guess ends: {path.message}")
    return replace(guess, q=path.q[:-1], qd=path.qd[:-1])


def frozen_rates(equations: Equations, guess: _Guess, rate: float) -> Array:
    """Return the moduli [1/s] of the motions within the manifold, coefficients frozen."""
    n, pick = equations.n, slice(None, None, max(len(guess.q) // _WATCHED, 1))
    x, v = guess.q[pick] / equations.columns, guess.qd[pick] / equations.columns
    slopes = equations.linearised(guess.times[pick], x, v)
    matrix = np.zeros((len(x), 2 * n, 2 * n))
    matrix[:, :n, n:] = np.eye(n) * rate
    matrix[:, n:, :n], matrix[:, n:, n:] = slopes.by_x / rate, slopes.by_v
    along = tangent(equations, slopes, rate).along
    values = np.linalg.eigvals(np.swapaxes(along, -1, -2) @ matrix @ along)
    return np.asarray(np.abs(values), dtype=np.float64)


def _steps(rates: Array, period: float) -> int:
    """Return how many steps the fastest motion needs."""
    fastest = float(np.max(rates, initial=0.0))
    wanted = np.ceil(fastest * period / _PHASE)
    if not wanted <= _MOST_STEPS:
        found = f"motions of {fastest:.3g} rad/s"
        expected = f"at most {_MOST_STEPS * _PHASE / period:.3g} rad/s at this period"
        raise bad("system", found, expected, "use fewer or softer modes")
    return max(int(wanted), _FEWEST)
