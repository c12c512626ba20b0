"""Periodic motions of constrained systems, found by multiple shooting on the constraints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from numbers import Real
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import SelfCheckFailed, bad
from ..core.families import Constrained
from ..core.results import Check, Result, provenance
from .gauss_steps import STAGES
from .norms import constraint_norms
from .orbit_guess import Guess, checked_guess, first_ring, scale_for
from .shooting import Shot, closed_chain, junctions, shoot
from .variational import Array, Scale, linearised

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Watch = Callable[[Array, Array], ArrayLike]

_EPS = float(np.finfo(float).eps)
_MOST = 8192
# Of the difference between a grid and one twice as fine, in the finer one (order 24: 2^-24).
_LEFT = 1.0 / 64
# Rounding of one step of the motion's size, sampled, and the largest of more samples.
_SAMPLES, _SAFETY = 4, 4.0
_ARRIVED = 1e-9


@dataclass(frozen=True)
class OrbitSource:
    """What multipliers are made of.

    Attributes
    ----------
    system : Constrained
        The system.
    scale : Scale
        Units of the states.
    fine, coarse : Shot
        The motion on its steps, and on half as many.
    """

    system: Constrained
    scale: Scale
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
        Newton steps on the coarser and on the finer grid.
    position_norm, velocity_norm, acceleration_norm : float
        Largest violation of a constraint within the steps, at the three levels, scaled as
        :func:`.norms.constraint_norms` says.
    deflection : float
        Largest value of ``watch``; NaN where none was given.
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
    source: OrbitSource = field(repr=False)

    dimensions: ClassVar = {
        "t": ("t",),
        "q": ("t", "coordinate"),
        "qd": ("t", "coordinate"),
        "qdd": ("t", "coordinate"),
        "multipliers": ("t", "constraint"),
        "advance": ("coordinate",),
    }

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
        return self.source.fine.ring.at(np.atleast_1d(np.asarray(t, dtype=float)))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over one period, each less its mean, and return the axes."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        t = np.linspace(0.0, self.period, 1001)
        q = self.at(t)[0] - np.multiply.outer(t / self.period, self.advance)
        names = self.labels or tuple(f"q{i + 1}" for i in range(q.shape[1]))
        for values, name in zip((q - q.mean(axis=0)).T, names, strict=True):
            ax.plot(t / self.period, values, linewidth=1.0, label=name)
        ax.set_xlabel("time over period")
        ax.set_ylabel("coordinates less their means")
        ax.legend(frameon=False, fontsize="small")
        return ax


def periodic_orbit(
    system: Constrained,
    period: float,
    q: ArrayLike,
    qd: ArrayLike,
    *,
    advance: ArrayLike = 0.0,
    rtol: float = 1e-10,
    watch: Watch | None = None,
) -> PeriodicOrbit:
    """Find a periodic motion from a guess, near it where the guess is good: see ``moved``.

    Multiple shooting with one Gauss-Legendre step of order 24 a segment.  The unknowns are the
    tangent coordinates of the constraint manifold where segments meet; the variational equations
    of the steps give the Newton matrix, the constraints are met by projection.

    Parameters
    ----------
    system : Constrained
        With variations; its dependence on time must have the period.
    period : float
        Period [s].
    q, qd : array_like, shape (n,) or (samples, n)
        Guess: the state at t = 0, from which the motion is followed for a period, or the motion at
        even times from 0, its end left out, which is then interpolated by Fourier series.
    advance : array_like, shape () or (n,)
        What the coordinates gain over a period: 2 pi for the angle of a link that turns.
    rtol : float
        Wanted error of the motion relative to its size.
    watch : callable, optional
        ``(q, t)`` of shapes ``(m, n)``, ``(m,)`` to deflections over a reference length, shape
        ``(m,)``; beyond 5 % the check ``linear range`` fails.

    Returns
    -------
    PeriodicOrbit
        Where the iteration does not arrive, ``message`` says why, the check ``converged`` fails,
        and the motion is the last iterate.  From a bad guess it may arrive at quite another
        motion, at rest for one that swings, say, and all checks pass: ``moved`` tells how far it
        is from the guess.

    Raises
    ------
    BadInput
        If a number is unusable, shapes do not fit, the system has no variations, or it does not
        repeat after the period.
    """
    if not (isinstance(rtol, Real) and 0 < rtol < 1):
        raise bad("rtol", repr(rtol), "a number between 0 and 1", "try 1e-10")
    guess = checked_guess(system, period, q, qd, advance)
    scale = scale_for(system, guess)
    ring = first_ring(system, guess, scale)
    if isinstance(ring, str):
        raise bad("guess", ring, "a motion that stays finite for a period", "give a better one")
    coarse = shoot(system, ring, scale)
    iterations, error, before = coarse.iterations, np.inf, np.inf
    fine = coarse
    while not coarse.reason:
        fine = shoot(system, coarse.ring.refined(), scale)
        iterations += fine.iterations
        error = _error(system, coarse, fine, scale)
        # Where halving the steps does not help, rounding is what is left.
        if fine.reason or error <= rtol or error > before / 2 or len(fine.ring.q) > _MOST:
            break
        coarse, before = fine, error
    source = OrbitSource(system, scale, fine, coarse)
    moved = _moved(guess, fine, scale)
    return _result(source, error, iterations, rtol, moved, watch)


def _moved(guess: Guess, shot: Shot, scale: Scale) -> float:
    """Return the largest scaled distance of the motion from its guess, over the larger one."""
    given = scale.state(guess.q, guess.qd)
    with np.errstate(all="ignore"):
        reached = scale.state(*shot.ring.at(guess.times))
    size = max(float(np.max(np.abs(state))) for state in (given, reached))
    gap = float(np.max(np.abs(reached - given)))
    return gap / size if size > 0 else 0.0


def _error(system: Constrained, coarse: Shot, fine: Shot, scale: Scale) -> float:
    """Return the error of the finer motion: what refinement changed, and what rounding leaves."""
    ring = fine.ring
    size = float(np.max(np.abs(scale.state(ring.q, ring.qd))))
    gap = scale.state(ring.q[::2] - coarse.ring.q, ring.qd[::2] - coarse.ring.qd)
    return float(np.max(np.abs(gap))) * _LEFT / size + _rounding(system, fine, scale)


def _rounding(system: Constrained, shot: Shot, scale: Scale) -> float:
    """Return what rounding in every step does to the motion, by random samples of it."""
    ring = shot.ring
    meeting = junctions(system, ring, scale)
    joined = np.swapaxes(ring.following(meeting.along), -1, -2)
    state = np.abs(scale.state(ring.q, ring.qd))
    size = float(np.max(state))
    noise = np.random.default_rng(0).normal(size=(*state.shape, _SAMPLES)) * size * _EPS
    moved = closed_chain(joined @ shot.sweep.maps @ meeting.along, joined @ noise)
    return np.inf if moved is None else _SAFETY * float(np.max(np.abs(moved))) / size


def _result(
    source: OrbitSource,
    error: float,
    iterations: int,
    rtol: float,
    moved: float,
    watch: Watch | None,
) -> PeriodicOrbit:
    shot, system = source.fine, source.system
    ring, found = shot.ring, shot.sweep.found
    places, speeds = ring.stages()
    found_at = linearised(system, ring.q, ring.qd, ring.start)
    times, flat = ring.times.ravel(), (-1, system.size)
    inside = [values.reshape(flat) for values in (places, speeds, found.qdd)]
    norms = constraint_norms(system, times, *inside)
    checks = {
        "converged": Check(shot.residual if shot.reason == "" else np.inf, _ARRIVED),
        "accuracy": Check(error, rtol),
    }
    deflection = float("nan")
    if watch is not None:
        from ..core.errors import LINEAR_RANGE

        watched = np.asarray(watch(inside[0], times), dtype=float)
        deflection = float(np.max(np.abs(watched)))
        checks["linear range"] = Check(deflection, LINEAR_RANGE)
    return PeriodicOrbit(
        method=f"multiple shooting, {len(ring.q)} Gauss-Legendre steps of order {2 * STAGES}",
        error=error,
        error_norm="largest of coordinates and scaled velocities, relative to the largest",
        checks=checks,
        provenance=provenance(system.provenance),
        t=ring.start,
        q=ring.q,
        qd=ring.qd,
        qdd=found_at.qdd,
        multipliers=found_at.lam,
        period=ring.period,
        advance=ring.advance,
        residual=shot.residual,
        iterations=iterations,
        position_norm=float(np.max(norms[0])),
        velocity_norm=float(np.max(norms[1])),
        acceleration_norm=float(np.max(norms[2])),
        deflection=deflection,
        moved=moved,
        message=shot.reason,
        labels=system.labels,
        source=source,
    )
