"""Speeds at which a mechanism's multipliers say that it responds most.

Local maxima over the speed of the multipliers' real parts (Aannaque 7.2.3), and the same of each
mode by itself from intervals of constant frequency (Meissner's J_N, 7.11).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.maxima import local_maxima
from ..core.results import Check
from ..hill import Meissner, discriminant
from ..periodic.lowest_modes import LowestModes
from ..periodic.moving_basis import still_modes
from ..periodic.multipliers import ROUNDED
from ..periodic.over_speed import MatricesOverSpeed

Whole = NDArray[np.int64]

_MOST_SAMPLES = 4000
# Error of the transition matrices: the place of a maximum is open by the root of it.
_RTOL = 1e-9
# Step beside a maximum, over the speed: of its fourth power the place is off; the same of J_N as a
# part of a half turn of the mode, and how often a maximum is moved by it.
_BESIDE, _TURNED, _POLISHED = 1e-4, 3e-3, 2
# Maxima of fewer intervals are looked for beyond the range, by this factor at either end.
_ASIDE = 0.9


class Found(NamedTuple):
    """Speeds that a method finds critical, ``(k,)`` each, in any order."""

    method: str
    speed: Array  # [rad/s]
    mode: Whole  # from 1
    error: Array  # absolute, of each speed [rad/s]
    order: Whole | None = None  # None where the mode's mean frequency is to give it
    # What the method measures there, 1 where it is nothing, and at the speeds that were scanned.
    quantity: str = "none"
    height: Array | None = None
    scan: tuple[Array, Array] = (np.zeros(0), np.zeros(0))
    checks: Mapping[str, Check] = MappingProxyType({})


def multiplier_maxima(
    system: LinearPeriodic, speed_range: tuple[float, float], wanted: int
) -> Found:
    """Return the local maxima over the speed [rad/s] of the real parts of the multipliers.

    Each mode's multiplier of the larger real part is followed over the speed; where its real part
    has a local maximum the mechanism answers most to its periodic forcing (Aannaque 7.2.3).  In an
    unstable band with real multipliers beyond +1 it is the speed of greatest growth.  The speeds
    are swept on a modal truncation; what that costs at the highest speed is in the error.  A
    maximum between two samples, of which the highest mode turns by 0.35 rad at most, may be missed.
    One at which two modes trade their names lies where the modes that are kept put it.
    """
    low, high = speed_range
    held = np.sqrt(still_modes(system, 256).squares[:, :wanted])
    top = float(np.max(held))
    # The highest mode turns by 0.35 rad between two samples.
    number = int(np.ceil(top * system.period * (1 / low - 1 / high) / 0.35)) + 8
    if number > _MOST_SAMPLES:
        found = f"a lowest speed of {low:.4g} rad/s, which needs {number} samples"
        fix = "raise the lowest speed or ask for fewer modes"
        raise bad("speed_range", found, f"at most {_MOST_SAMPLES}", fix)
    # The reciprocal of a reciprocal may lie beyond an end by rounding.
    speed = np.clip(1.0 / np.linspace(1 / high, 1 / low, number), low, high)
    truncated, change = LowestModes(system, wanted).required(high)
    few = MatricesOverSpeed(truncated, (low, high), {}, _RTOL)
    real = _multipliers(few, speed, wanted)

    def value(at: Array, mode: Whole) -> Array:
        return np.asarray(_multipliers(few, at, wanted)[np.arange(len(at)), mode])

    inner = real[1:-1]
    mode, row = np.nonzero(((inner >= real[:-2]) & (inner > real[2:])).T)
    row = row + 1
    near = np.add.outer([-1, 0, 1], row)
    around = real[near, mode]
    at, best, width = refined_maxima(value, mode, speed[near], around)
    span = np.abs(speed[row + 1] - speed[row - 1])
    matrices, relative = few(speed[row])
    noise = float(np.max(relative, initial=0.0))
    size = float(np.max(np.abs(matrices), initial=1.0))
    # Rounding leaves the place of a maximum open by its root.
    curve = np.maximum(np.abs(around[0] - 2 * around[1] + around[2]), 1e-300)
    blur = np.sqrt(2 * noise * size * (span**2 / 4) / curve)
    method = "local maxima of the real parts of the multipliers"
    if truncated.size < system.size:
        method += f", on {truncated.size} natural modes"
    checks = {"truncated": Check(change, 1e-3), "converged": Check(noise, 100 * _RTOL)}
    # Steps of parabolas become small on one side of a maximum before they have reached it.
    moved, bend, smooth = _quartic(value, at, _BESIDE * at, mode, best)
    rough = width + np.abs(moved) + np.minimum(blur, span)
    for _ in range(_POLISHED):
        at = np.where(smooth, at + moved, at)
        best = value(at, mode)
        moved, bend, _ = _quartic(value, at, _BESIDE * at, mode, best)
    sharp = 2.0 * np.abs(moved) + ROUNDED * noise * size * _BESIDE * at / np.abs(bend)
    # A multiplier's turn is its frequency over the speed: what it is off by, the speed is.
    error = np.where(smooth, np.minimum(sharp, rough), rough) + change * at
    quantity = "real part of the multiplier"
    return Found(method, at, mode + 1, error, quantity=quantity, height=best, checks=checks)


def _quartic(
    call: Callable[[Array, Whole], Array], at: Array, step: Array, which: Whole, best: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return how far the maximum is off places ``(k,)`` by the quartic through five values."""
    # With it the second difference there, and whether it is smooth: at a corner, where a mode's
    # multipliers become real, second differences grow with the step, not with its square.
    first, low, high, last = (call(at + k * step, which) for k in (-2, -1, 1, 2))
    slope = (first - 8.0 * low + 8.0 * high - last) / 12.0
    bend = (-first + 16.0 * low - 30.0 * best + 16.0 * high - last) / 12.0
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.clip(-slope / bend, -1.0, 1.0)
    smooth = (bend < 0.0) & (first - 2.0 * best + last < 3.5 * (low - 2.0 * best + high))
    return step * np.where(bend < 0.0, moved, 0.0), bend, smooth


def refined_maxima(
    call: Callable[[Array, Whole], Array],
    which: Whole,
    brackets: Array,
    values: Array,
    *,
    steps: int = 24,
    rtol: float = 1e-7,
) -> tuple[Array, Array, Array]:
    """Refine maxima of many functions by parabolas; return places, values and errors ``(k,)``.

    ``call`` takes places and ``which`` functions; ``brackets`` and ``values``, ``(3, k)``, stand
    before, at and after each maximum.  One has settled where a step is below ``rtol``.
    """
    x, f = brackets.copy(), values.copy()
    moved = np.max(np.abs(x - x[1]), axis=0)
    for _ in range(steps):
        wide = moved > rtol * x[1]
        if not np.any(wide):
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            left, right = (f[1] - f[0]) / (x[1] - x[0]), (f[2] - f[1]) / (x[2] - x[1])
            curve = (right - left) / (x[2] - x[0])
            vertex = 0.5 * (x[0] + x[1]) - 0.5 * left / curve
        low, high = np.minimum(x[0], x[2]), np.maximum(x[0], x[2])
        usable = np.isfinite(vertex) & (vertex > low) & (vertex < high)
        trial = np.where(usable & (vertex != x[1]), vertex, 0.5 * (x[1] + x[2]))
        got = np.array(f[1])
        got[wide] = call(trial[wide], which[wide])
        moved = np.where(wide, np.abs(trial - x[1]), moved)
        better = wide & (got > f[1])
        beyond = (trial - x[1]) * (x[2] - x[1]) > 0
        # The worse one of the old middle and the new place closes the bracket on its side.
        own = np.flatnonzero(wide)
        side = np.where(better == beyond, 0, 2)[own]
        x[side, own] = np.where(better, x[1], trial)[own]
        f[side, own] = np.where(better, f[1], got)[own]
        x[1], f[1] = np.where(better, trial, x[1]), np.where(better, got, f[1])
    return x[1], f[1], moved


def meissner_maxima(
    frequencies: Array, rounding: Array, period: float, speed_range: tuple[float, float]
) -> Found:
    """Return the local maxima over the speed of Meissner's J_N, each mode by itself.

    Its frequency, in a column of ``(N, m)`` at even angles with N a multiple of 4, is constant in
    each of N intervals: ``y'' + (v_i/w)^2 y = 0``, as in Aannaque's Fig. 7.3.  What modes exchange,
    and the change of their shapes, is not in it.  The error is that of the intervals and of the
    ``rounding`` of the frequencies, ``(N, m)``: from N to N/2 intervals a maximum moves by three
    times the former, and by a quarter of what it moves from N/2 to N/4.
    """
    count = len(frequencies)
    low, high = speed_range
    parts = []
    for mode, levels in enumerate(frequencies.T):
        place, value, width = _meissner_maxima(levels, period, speed_range)
        # Maxima that fewer intervals put beyond the ends, too.
        aside = _ASIDE * low, high / _ASIDE
        half, quarter = (
            _nearest(_meissner_maxima(levels[::share], period, aside)[0], place) for share in (2, 4)
        )
        # One of both may vanish by chance.
        gap = np.maximum(np.abs(place - half), np.abs(half - quarter) / 4.0)
        # A maximum that fewer intervals do not have is not known at all.
        error = width + np.fmin(gap, place)
        error += place * float(np.max(rounding[:, mode] / levels))
        parts.append((place, np.full(len(place), mode + 1), value, error))
    speed, number, value, error = (np.concatenate(column) for column in zip(*parts, strict=True))
    method = f"local maxima of Meissner's J_{count}"
    return Found(method, speed, number.astype(np.int64), error, quantity="J_N", height=value)


def _nearest(places: Array, to: Array) -> Array:
    """Return the nearest of some places to each of others; NaN where there is none."""
    if not len(places):
        return np.full(len(to), np.nan)
    return np.asarray(places[np.argmin(np.abs(to[:, None] - places), axis=1)])


def _meissner_maxima(
    levels: Array, period: float, span: tuple[float, float]
) -> tuple[Array, Array, Array]:
    """Return places, values and errors of the maxima of one mode."""
    turn = period / (2.0 * np.pi)
    steps = Meissner.of((levels * turn) ** 2)

    def half_trace(at: Array, _: Whole | None = None) -> Array:
        return discriminant(steps, 0.0, 1.0 / at**2).value

    # Half turns of the mode's motion in a period are so many times the inverse of the speed.
    waves = period * float(np.mean(levels))
    number = int(np.ceil(waves * (1 / span[0] - 1 / span[1]) / 0.05)) + 8
    speed = 1.0 / np.linspace(1 / span[1], 1 / span[0], number)
    values = half_trace(speed)
    row = local_maxima(values)
    which = np.zeros(len(row), dtype=np.int64)
    near = np.add.outer([-1, 0, 1], row)
    at, best, _ = refined_maxima(half_trace, which, speed[near], values[near])
    step = _TURNED * at**2 / waves
    for _ in range(_POLISHED):
        moved, bend, _ = _quartic(half_trace, at, step, which, best)
        at = at + moved
        answer = discriminant(steps, 0.0, 1.0 / at**2)
        best = answer.value
    noise = 2.0 * answer.error * step / np.maximum(-bend, np.finfo(float).tiny)
    return at, best, np.abs(moved) + np.minimum(noise, step)


def _multipliers(few: MatricesOverSpeed, speed: Array, count: int) -> Array:
    """Return the larger real part of the two multipliers of each of the lowest modes."""
    half = few.system.size
    values, vectors = np.linalg.eig(few(speed)[0])
    # In velocities of time, not of angle, a state (q, M qd) is the same at all speeds.
    states = np.asarray(vectors.astype(complex) * few.scale[:, None], dtype=np.complex128)
    states[:, half:] *= speed[:, None, None]
    # The lowest modes are told by energy over action, by the modes held at 0.
    still = still_modes(few.system, 1)
    shapes, rate = still.shapes[0], np.sqrt(still.squares[0])[:, None]
    rest = np.abs(np.linalg.solve(shapes, states[:, :half])) ** 2
    energy = rate**2 * rest + np.abs(shapes.T @ states[:, half:]) ** 2
    level = np.sum(energy, axis=1) / np.sum(energy / rate, axis=1)
    order = np.argsort(level, axis=-1, kind="stable")[:, : 2 * count]
    real = np.take_along_axis(values.real, order, axis=-1).reshape(len(speed), count, 2)
    return np.asarray(np.max(real, axis=-1))
