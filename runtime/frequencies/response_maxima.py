"""Speeds at which the steady state of a damped mechanism deflects most."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..core.errors import BadInput, bad
from ..core.families import Array, LinearPeriodic
from ..core.progress import bar

# Errors of the motions, of a structure and of matrices; angles of a revolution at which a structure
# is truncated to its lowest modes, and speeds solved together.
_RTOL, _FINE, _ANGLES, _TOGETHER = 1e-6, 1e-9, 64, 16
# Places along the link at which its deflection is watched.
_PLACES = np.linspace(0.0, 1.0, 21)
# Speeds within a bracket, its ends among them: each look at one leaves a third of it about.
_NODES = -np.cos(np.pi * np.arange(9) / 8)
# Values at them to the coefficients of their Chebyshev series.
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, len(_NODES) - 1))
# Looks at a bracket, by which a peak a millionth as wide as the first one is resolved; and by how
# much of a speed two looks may differ, of matrices and of a structure, whose motions take seconds:
# a resonance too narrow for both looks shows in that alone.
_LOOKS, _AGREED, _ROUGHLY = 16, 5e-11, 1e-4
_EPS = float(np.finfo(float).eps)
# Round-off of a motion over its sensitivity, another at each speed: of 646 places of two constant
# oscillators (three seeds) 99.5 to 100 % are covered with 13, of waving systems all, medians of
# estimate over error 52 to 93 with four seeds.
_NOISE = 13.0 * _EPS


def scanned_deflections(system: LinearPeriodic, speeds: Array, progress: bool) -> Array:
    """Return r.m.s. deflections over the length at rising speeds, ``(ns,)``, to look for maxima.

    Of a structure of beams they are those of its lowest modes.
    """
    values = _on_lowest_modes(system, speeds)
    if values is None:
        squares, _ = _mean_squares(system, speeds, progress)
        values = np.sqrt(np.max(squares, axis=1))
    return values


def _on_lowest_modes(system: LinearPeriodic, speeds: Array) -> Array | None:
    """Return how far a structure of beams bends over rising speeds, on its lowest modes."""
    # None where the system has no slow modes apart from fast ones.
    from ..periodic.swept_motions import Truncations, speed_ranges

    if system.structure is None or system.relative_deflection is None:
        return None
    try:
        truncations = Truncations(system)
        modes = truncations.usable(0, _ANGLES)[-1]
    except (BadInput, IndexError):
        # No subspace is smooth: the steady states themselves are computed.
        return None
    out = np.empty(len(speeds))
    for piece in speed_ranges(speeds):
        span = float(speeds[piece][0]), float(speeds[piece][-1])
        moving = truncations.motions(modes, _ANGLES, span, _RTOL)
        rows = system.relative_deflection(moving.truncated.theta)
        for part, q, *_ in moving.blocks(speeds[piece]):
            bent = rows @ np.moveaxis(q, 0, -1)
            out[piece][part] = np.sqrt(np.max(np.mean(bent**2, axis=0), axis=0))
    return out


def _rtol(system: LinearPeriodic) -> float:
    """Return the error wanted of the motions, and of the places of their maxima."""
    return _FINE if system.structure is None else _RTOL


def _mean_squares(
    system: LinearPeriodic, speeds: Array, progress: bool = False
) -> tuple[Array, Array]:
    """Return mean squares of the deflection over the length, ``(ns, places)``."""
    # With them the motions' relative error, and what of it is round-off, (2, ns).
    from ..periodic.periodic_motion import quiet_state

    out, error = [], np.empty((2, len(speeds)))
    with bar(progress, len(speeds)) as tick:
        for begin in range(0, len(speeds), _TOGETHER):
            part = slice(begin, min(begin + _TOGETHER, len(speeds)))
            state = quiet_state(system, speeds[part], _rtol(system))
            rows = system.deflection_rows(state.theta, _PLACES)
            if rows is None:
                found = "deflections that are not known"
                expected = "mode shapes or relative_deflection"
                raise bad("system", found, expected, "choose another method")
            # One speed at a time: deflections of all would fill the memory.
            out += [np.mean(np.einsum("tkn,tn->tk", rows, q) ** 2, axis=0) for q in state.q]
            error[0, part] = np.max(np.reshape(state.error, (len(state.q), -1)), axis=1)
            error[1, part] = _NOISE * np.reshape(state.sensitivity, -1)
            tick(part.stop)
    squares = np.array(out)
    known = np.all(np.isfinite(squares), axis=1)
    if not np.all(known):
        found = f"no single periodic motion at {float(speeds[np.argmin(known)]):.6g} rad/s"
        raise bad("speed_range", found, "speeds with one each", "move the range or add damping")
    return squares, error


class _Peak(NamedTuple):
    """What is known of a maximum, and the bracket for the next look at it [rad/s]."""

    low: float
    high: float
    place: float
    height: float
    error: float
    settled: bool


def response_maxima(system: LinearPeriodic, low: Array, high: Array) -> tuple[Array, Array, Array]:
    """Return place, height and error of the place of the maxima within brackets ``(k,)``.

    About a maximum one over the mean square is nearly a parabola of the speed: the least value is
    taken of a polynomial through nine speeds.  The bracket closes in on the lowest of the nine
    until two looks agree.
    """
    peaks = [
        # At an end of its bracket no maximum is: the first look agrees with nothing.
        _Peak(a, b, a, np.inf, b - a, settled=False)
        for a, b in zip(low.tolist(), high.tolist(), strict=True)
    ]
    agreed = _AGREED if system.structure is None else _ROUGHLY
    for _ in range(_LOOKS):
        rest = [k for k, peak in enumerate(peaks) if not peak.settled]
        if not rest:
            break
        ends = np.array([peaks[k][:2] for k in rest])
        inside = ends.mean(axis=1)[:, None] + 0.5 * np.diff(ends, axis=1) * _NODES
        squares, error = _mean_squares(system, inside.ravel())
        squares, error = squares.reshape(*inside.shape, -1), error.reshape(2, *inside.shape)
        for i, k in enumerate(rest):
            worst = np.max(error[:, i], axis=1)
            peaks[k] = _closer(peaks[k], inside[i], squares[i], worst, _rtol(system), agreed)
    place, height, error = np.array([peak[2:5] for peak in peaks]).reshape(-1, 3).T
    return place, height, error


def _closer(
    peak: _Peak, speeds: Array, squares: Array, error: Array, wanted: float, enough: float
) -> _Peak:
    """Return what is known of a maximum after a look at speeds ``(9,)`` of its bracket."""
    # `squares` of the deflection are (9, places); `error` is that of the motions and their
    # round-off, (2,).  Of the place an error `wanted` is asked for, and that two looks agree to
    # `enough`.
    best, place = (int(k) for k in np.unravel_index(np.argmax(squares), squares.shape))
    values = 1.0 / np.maximum(squares, np.finfo(float).tiny)
    middle, half = speeds.mean(), 0.5 * float(speeds[-1] - speeds[0])
    # The place along the link that moves most there, alone: where two change roles is a corner.
    for _ in values.T:
        shift, least, doubt, doubt_of_place = _least(values[:, place], error, best)
        before, place = place, int(np.argmin(chebyshev.chebval(shift, _TO_SERIES @ values)))
        if place == before:
            break
    at = float(middle + half * shift)
    off = half * min(doubt_of_place, 1.0) + 2.0 * _EPS * at
    apart = abs(at - peak.place)
    # It has no bound where one over its square is no more than what that is off by.
    height = least**-0.5 if least > doubt else np.inf
    settled = off <= wanted * at and apart <= enough * at
    if settled and apart > wanted * at:
        # The look before is off by the fifth power of its bracket and more.
        off = max(off, apart / 64.0)
    ends = max(best - 1, 0), min(best + 1, len(speeds) - 1)
    low, high = (float(speeds[end]) for end in ends)
    if best in (0, len(speeds) - 1):
        # What was scanned is not what is computed here: the maximum may lie beyond.
        low = max(float(speeds[best]) - half, 0.5 * float(speeds[0]))
        high = float(speeds[best]) + half
    return _Peak(low, high, at, height, off if settled else max(off, apart), settled)


def _least(values: Array, error: Array, best: int) -> tuple[float, float, float, float]:
    """Return place in [-1, 1] and value of the least of a polynomial through nine values."""
    # With them their errors, from the terms left out, of which round-off keeps the last ones, and
    # from the relative `error` of the motions.
    whole, noise = error.tolist()
    series = _TO_SERIES @ values
    roots = chebyshev.chebroots(chebyshev.chebder(series))
    # Between the neighbours of the lowest node.
    low, high = _NODES[max(best - 1, 0)], _NODES[min(best + 1, len(_NODES) - 1)]
    inner = roots[(np.abs(roots.imag) < 1e-9) & (roots.real >= low) & (roots.real <= high)].real
    if not len(inner):
        return float(_NODES[best]), float(values[best]), np.inf, np.inf
    at = float(inner[np.argmin(chebyshev.chebval(inner, series))])
    least = float(chebyshev.chebval(at, series))
    curve = float(chebyshev.chebval(at, chebyshev.chebder(series, 2)))
    if not curve > 0.0:
        return at, least, np.inf, np.inf
    # The next terms fall as the last ones, unless those fall ever more slowly.
    early, before, last = (float(np.sum(np.abs(series[k : k + 2]))) for k in (3, 5, 7))
    following = last * (last / before) ** 0.5 if last * early < before**2 else last
    noise *= float(np.sum(np.abs(series)))
    # An error that varies as the motions do moves the peak by this part of its half width.
    width = (2.0 * max(least, 0.0) / curve) ** 0.5
    return (
        at,
        least,
        following + noise + 2.0 * whole * abs(least),
        # The slope of what follows is that of few terms; round-off has it of any degree.
        2.0 * len(_NODES) * (following / 3.0 + noise) / curve + whole * width,
    )
