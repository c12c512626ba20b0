"""From a user's guess to a first motion over a period; refusals before any work."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, bad
from ..core.families import Constrained
from ..core.families.multipliers import check_rank, scaling
from .gauss_steps import STAGES, Ring
from .variational import (
    Array,
    Linearised,
    Scale,
    linearised,
    onto_manifold,
    scale_of,
    tangent,
    variations_of,
)

# Phase of the fastest motion that a first step covers [rad]; 12 stages err 1e-14 a step at 5.
_PHASE = 5.0
_FEWEST, _MOST = 12, 8192
# A system that differs by more after a period has another period.
_SAME = 1e-9
_WATCHED = 24


@dataclass(frozen=True)
class Guess:
    """A guess of a periodic motion: one state at t = 0, or states at even times over a period."""

    period: float
    advance: Array
    q: Array
    qd: Array

    @property
    def times(self) -> Array:
        """Times of the states [s]."""
        return np.asarray(np.arange(len(self.q)) * (self.period / len(self.q)), np.float64)


def checked_guess(
    system: Constrained, period: float, q: ArrayLike, qd: ArrayLike, advance: ArrayLike
) -> Guess:
    """Return the guess as arrays, having checked numbers, shapes and the system's period.

    Raises
    ------
    BadInput
        As :func:`.orbits.periodic_orbit`.
    """
    variations_of(system)
    if not (isinstance(period, Real) and np.isfinite(float(period)) and period > 0):
        raise bad("period", repr(period), "a finite number above 0 [s]", "correct it")
    n = system.size
    gain = _numbers("advance", advance)
    states = [_states(name, values, n) for name, values in (("q", q), ("qd", qd))]
    if states[0].shape != states[1].shape:
        raise bad("qd", f"shape {np.shape(qd)}", f"that of q, {np.shape(q)}", "give both alike")
    if gain.shape not in ((), (n,)) or not np.all(np.isfinite(gain)):
        raise bad("advance", advance, f"a finite number, or {n} of them", "correct it")
    guess = Guess(float(period), np.broadcast_to(gain, (n,)).copy(), *states)
    _check_period(system, guess)
    found = system.dynamics(guess.q, guess.qd, guess.times)
    check_rank(found["jacobian"], *scaling(found["mass"], found["jacobian"]))
    return guess


def _numbers(name: str, values: ArrayLike) -> Array:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as wrong:
        raise bad(name, repr(values), "numbers", "correct it") from wrong


def _states(name: str, values: ArrayLike, n: int) -> Array:
    given = _numbers(name, values)
    if given.shape not in ((n,), (len(given) if given.ndim else 0, n)) or not given.size:
        raise bad(
            name,
            f"shape {given.shape}",
            f"({n},), or (samples, {n}) over a period",
            "give one state or several",
        )
    if not np.all(np.isfinite(given)):
        raise bad(name, "a value that is not finite", "finite numbers", "correct it")
    return given.reshape(-1, n)


def _check_period(system: Constrained, guess: Guess) -> None:
    """Refuse a system that is another one a period later."""
    t = np.linspace(0.0, guess.period, _WATCHED, endpoint=False)
    pick = np.arange(_WATCHED) * len(guess.q) // _WATCHED
    q, qd = guess.q[pick], guess.qd[pick]
    if len(guess.q) == 1:
        q = q + np.multiply.outer(t / guess.period, guess.advance)
    now = _arrays(system, q, qd, t)
    later = _arrays(system, q + guess.advance, qd, t + guess.period)
    place, speed = (float(np.max(np.abs(values), initial=0.0)) for values in (q, qd))
    rate = 2.0 * np.pi / guess.period
    row, mass = (float(np.max(np.abs(now[name]), initial=0.0)) for name in ("jacobian", "mass"))
    # Where an array is small or zero, what would be noticed beside its neighbours in the equations.
    beside = {"constraints": row * place, "velocity_rhs": row * speed, "gamma": row * speed * rate}
    beside |= dict.fromkeys(("rest", "forces"), mass * speed * rate)
    for name, values in now.items():
        size = max(float(np.max(np.abs(values), initial=0.0)), beside.get(name, 0.0))
        gap = float(np.max(np.abs(later[name] - values), initial=0.0))
        if not gap <= _SAME * size:
            raise bad(
                "period",
                f"{guess.period:.9g} s, after which {name} differs by {gap:.3g}",
                "a system that repeats after the period",
                "give the period of the drive, and in advance what angles gain over it",
            )


def _arrays(system: Constrained, q: Array, qd: Array, t: Array) -> dict[str, Array]:
    """Return all that the equations are made of, constraints included."""
    return {**system.dynamics(q, qd, t), **system.violation(q, t)}


def scale_for(system: Constrained, guess: Guess) -> Scale:
    """Return the units of states: from the masses, and the mean rate of the frozen vibrations.

    The mean is the geometric one: between the slowest and the fastest mode no other unit of time
    leaves the eigenvectors of the flow better conditioned.
    """
    pick = slice(None, None, max(len(guess.q) // _WATCHED, 1))
    found = linearised(system, guess.q[pick], guess.qd[pick], guess.times[pick])
    turning = 2.0 * np.pi / guess.period
    rates = np.maximum(np.abs(frozen_rates(found, scale_of(found.mass, turning))), turning)
    mean = float(np.exp(np.mean(np.log(rates)))) if rates.size else turning
    return scale_of(found.mass, mean)


def first_ring(system: Constrained, guess: Guess, scale: Scale) -> Ring | str:
    """Return the guess on even collocation steps, moved onto the constraints; or why it fails.

    One state is followed for a period; several are interpolated by Fourier series.
    """
    try:
        if len(guess.q) == 1:
            return _followed(system, guess, scale)
        steps = _steps(system, guess.q, guess.qd, guess.times, guess.period, scale)
        q = _fourier(guess.q, guess.times, guess, steps)
        qd = _fourier(guess.qd, guess.times, None, steps)
        return _ring(system, guess, q, qd, scale)
    except (BadInput, np.linalg.LinAlgError) as refusal:
        return f"the motion from the guess cannot be followed: {refusal}"


def _fourier(values: Array, times: Array, guess: Guess | None, count: int) -> Array:
    """Return periodic samples at ``count`` even places of the period."""
    drift = 0.0 if guess is None else np.multiply.outer(times / guess.period, guess.advance)
    series = np.fft.rfft(values - drift, axis=0)
    m = len(values)
    # At fewer places than samples: at a multiple of them that holds the whole series, thinned.
    fold = -(-m // count)
    whole = fold * count
    if m % 2 == 0 and whole > m:
        series[-1] /= 2.0
    room = np.zeros((whole // 2 + 1, values.shape[1]), dtype=complex)
    room[: len(series)] = series
    fine = np.fft.irfft(room, whole, axis=0) * (whole / m)
    found: Array = fine[::fold]
    if guess is not None:
        found = found + np.multiply.outer(np.arange(count) / count, guess.advance)
    return found


def _steps(system: Constrained, q: Array, qd: Array, t: Array, period: float, scale: Scale) -> int:
    """Return how many steps the fastest motion asks for."""
    pick = np.arange(0, len(q), max(len(q) // _WATCHED, 1))
    found = linearised(system, q[pick], qd[pick], t[pick])
    fastest = float(np.max(np.abs(frozen_rates(found, scale)), initial=0.0))
    wanted = np.ceil(fastest * period / _PHASE)
    if not wanted <= _MOST:
        raise bad(
            "system",
            f"motions of {fastest:.3g} rad/s",
            f"at most {_MOST * _PHASE / period:.3g} rad/s at this period",
            "use fewer or softer modes",
        )
    return max(int(wanted), _FEWEST)


def frozen_rates(found: Linearised, scale: Scale) -> NDArray[np.complex128]:
    """Return the eigenvalues [1/s] of the motions within the manifold, coefficients frozen."""
    n = found.mass.shape[-1]
    rate = np.zeros((*found.mass.shape[:-2], 2 * n, 2 * n))
    rate[..., :n, n:] = np.eye(n) * scale.rate
    rate[..., n:, :n] = found.by_q * (scale.size[:, None] / scale.size) / scale.rate
    rate[..., n:, n:] = found.by_qd * (scale.size[:, None] / scale.size)
    along = tangent(found, scale).along
    return np.linalg.eigvals(np.swapaxes(along, -1, -2) @ rate @ along).astype(complex)


def _ring(system: Constrained, guess: Guess, q: Array, qd: Array, scale: Scale) -> Ring:
    """Return a ring through states; its stages from Hermite's cubic between them."""
    m, n = q.shape
    empty = Ring(guess.period, guess.advance, q, qd, np.zeros((m, STAGES, n)))
    q, qd = onto_manifold(system, q, qd, empty.start, scale)
    ahead = empty.following(q)
    ahead[-1] += guess.advance
    speed, h, c = empty.following(qd), empty.step, empty.tableau.c[:, None]
    gap = (ahead - q)[:, None] / h
    now, late = qd[:, None], speed[:, None]
    rise = (6 * gap - 4 * now - 2 * late) + c * (6 * now + 6 * late - 12 * gap)
    return Ring(guess.period, guess.advance, q, qd, rise / h)


def _followed(system: Constrained, guess: Guess, scale: Scale) -> Ring | str:
    """Follow one state for a period, its projection onto the constraints first."""
    from scipy.integrate import solve_ivp

    n = system.size
    start = np.zeros(1)
    q, qd = onto_manifold(system, guess.q, guess.qd, start, scale)

    def rate(t: float, state: Array) -> Array:
        place, speed = state[:n] / scale.size, state[n:] * (scale.rate / scale.size)
        push = system.accelerations(place, speed, t)[0]
        return scale.rate * scale.state(speed / scale.rate, push / scale.rate)

    def away(t: float, state: Array) -> float:
        return float(np.log10(np.max(np.abs(state)) / bound))

    away.terminal = True  # type: ignore[attr-defined]
    state = scale.state(q, qd)[0]
    bound = 1e6 * max(float(np.max(np.abs(state))), float(np.max(scale.size)))
    with np.errstate(all="ignore"):
        run = solve_ivp(
            rate, (0.0, guess.period), state, "DOP853", rtol=1e-8, atol=1e-10, events=away,
            dense_output=True,
        )  # fmt: skip
    if run.status != 0 or run.sol is None:
        told = "leaves all bounds" if run.status == 1 else "cannot be followed"
        return f"the motion from the guess {told} at t = {run.t[-1]:.6g} s"
    samples = run.sol(np.linspace(0.0, guess.period, _WATCHED)).T
    visited = scale.physical(samples)
    steps = _steps(system, *visited, np.linspace(0.0, guess.period, _WATCHED), guess.period, scale)
    t = np.arange(steps) * (guess.period / steps)
    q, qd = scale.physical(run.sol(t).T)
    return _ring(system, guess, q, qd, scale)
