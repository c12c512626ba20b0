"""Campbell's diagram: frequencies against the crank speed, with the lines of its multiples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import bad
from ..families import LinearPeriodic
from ..floquet.first_order import numbers
from ..progress import bar
from ..results import Check, Result, provenance
from .buckling import buckling_speed
from .eigenproblem import held_frequencies
from .means import cycle_mean

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..floquet.decoupled.exponents import SlowMultipliers

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_MODES = 4
# Means end this far before the held mechanism buckles.
_SHORT = 0.999
_ENOUGH = 1e-9
# A frequency this close to a multiple of the speed, over the speed, is locked to it.
_LOCKED = 1e-7


@dataclass(frozen=True, kw_only=True)
class Campbell(Result):
    """Frequencies of a mechanism against its crank speed.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], rising, ``(ns,)``.
    held : ndarray
        Mean natural frequencies over the period, crank held under the axial forces of the speed
        [rad/s], ``(ns, modes)``; NaN from ``buckling`` on, where there are none.
    running : ndarray
        Frequencies of the running mechanism [rad/s], ``(ns, modes)``: the imaginary parts of the
        characteristic exponents, all terms with them (axial forces, Coriolis, centripetal, Euler),
        each with that multiple of the speed added that brings it to its mode; NaN where they were
        not asked for.
    growth : ndarray
        Their real parts [1/s], ``(ns, modes)``: positive where the motion grows.
    buckling : float
        Least crank speed [rad/s] at which the held mechanism buckles at some angle; inf if none.
    crossing_speed : ndarray
        Speeds at which a frequency is n times the speed, ``(nc,)`` [rad/s]: of ``running`` where
        it is there, else of ``held``.
    crossing_mode, crossing_order : ndarray of int
        Mode (from 1) and n of each, ``(nc,)``.
    crossing_error : ndarray
        Error of each [rad/s], ``(nc,)``: of interpolating between the speeds; half a locked range
        where the frequency is n times the speed over a range of it.
    error : ndarray
        Error of ``held`` [rad/s], ``(ns, modes)``; NaN with it.
    """

    speed: Array
    held: Array
    running: Array
    growth: Array
    buckling: float
    crossing_speed: Array
    crossing_mode: Indices
    crossing_order: Indices
    crossing_error: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "speed": ("speed",),
        **dict.fromkeys(("held", "running", "growth", "error"), ("speed", "mode")),
        **dict.fromkeys(
            ("crossing_speed", "crossing_mode", "crossing_order", "crossing_error"), ("crossing",)
        ),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the diagram and return the axes."""
        from ..plotting import axes_or_new

        ax = axes_or_new(ax)
        shown = np.where(np.isfinite(self.running), self.running, self.held)
        top = 1.1 * float(np.nanmax(shown))
        last = int(self.crossing_order.max(initial=1))
        for n in range(1, last + 1):
            ax.plot(self.speed, n * self.speed, color="0.8", lw=0.6, zorder=0)
            x, y = (self.speed[-1], n * self.speed[-1])
            if y > top:
                x, y = top / n, top
            # Where the lines are close only some are named.
            if n <= 10 or n % 5 == 0:
                ax.annotate(f"{n}", (x, y), fontsize=6, color="0.5", ha="right", va="bottom")
        for k in range(self.held.shape[1]):
            colour = f"C{k % 10}"
            ax.plot(self.speed, self.held[:, k], "--", color=colour, lw=0.9)
            ax.plot(self.speed, self.running[:, k], color=colour, lw=1.3)
            grown = self.growth[:, k] > 1e-6 * shown[:, k]
            ax.plot(self.speed[grown], self.running[grown, k], ".", color="r", ms=5)
        height = self.crossing_order * self.crossing_speed
        ax.plot(self.crossing_speed, height, "ko", ms=3, mfc="none", mew=0.7)
        if self.buckling < self.speed[-1]:
            ax.axvline(self.buckling, color="0.5", lw=0.8, ls=":")
        ax.set_xlim(self.speed[0], self.speed[-1])
        ax.set_ylim(0.0, 1.05 * top)
        ax.set_xlabel("crank speed [rad/s]")
        ax.set_ylabel("frequency [rad/s]")
        return ax


def campbell(
    system: LinearPeriodic,
    speed: ArrayLike,
    *,
    modes: int | None = None,
    exponents: bool = True,
    progress: bool = False,
) -> Campbell:
    """Return the frequencies of a mechanism against its crank speed, and where orders meet them.

    A mechanism is forced at every multiple n w of its speed: where one meets a frequency the
    response may peak.  Frequencies that differ by a multiple of the speed are the same exponent;
    each is shown next to the mean natural frequency of its mode.

    Parameters
    ----------
    system : LinearPeriodic
        The system, damped or not.
    speed : array_like
        Crank speeds [rad/s], rising, ``(ns,)``, at least 4.
    modes : int, optional
        Number of modes, 4 by default.
    exponents : bool
        Whether the frequencies of the running mechanism are found too.
    progress : bool
        Whether to show a progress bar (extra ``progress``).

    Returns
    -------
    Campbell
        Its check ``near``: the largest distance of a running frequency from the held one or, where
        there is none, from that at the speed before, over half the speed; from 1 on its multiple
        of the speed would be open.

    Raises
    ------
    BadInput
        If the speeds or the number of modes are unusable.
    """
    speeds = numbers("speed", speed)
    if speeds.ndim != 1 or len(speeds) < 4 or not np.all(np.diff(speeds) > 0) or speeds[0] <= 0:
        raise bad("speed", speed, "at least four rising speeds [rad/s]", "use numpy.linspace")
    count = min(_MODES, system.size) if modes is None else modes
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= system.size:
        raise bad("modes", repr(modes), f"a whole number from 1 to {system.size}", "correct it")
    limit = buckling_speed(system).speed
    held, error = _held(system, speeds, count, limit, progress)
    running = growth = np.full(held.shape, np.nan)
    near = 0.0
    if exponents:
        running, growth, near = _running(system, speeds, held, count)
    told = running if exponents else held
    crossing = [row for k in range(count) for row in _crossings(speeds, told[:, k], k + 1)]
    crossing.sort()
    return Campbell(
        method="means of held frequencies" + "; characteristic exponents" * exponents,
        error=error,
        error_norm="absolute, of each held mean [rad/s]",
        checks={"near": Check(float(near), 0.8)},
        provenance=provenance(system.provenance),
        speed=speeds,
        held=held,
        running=running,
        growth=growth,
        buckling=limit,
        crossing_speed=np.array([row[0] for row in crossing]),
        crossing_mode=np.array([row[1] for row in crossing], dtype=np.int64),
        crossing_order=np.array([row[2] for row in crossing], dtype=np.int64),
        crossing_error=np.array([row[3] for row in crossing]),
    )


def _held(
    system: LinearPeriodic, speeds: Array, count: int, limit: float, progress: bool
) -> tuple[Array, Array]:
    """Return the means with the crank held under the axial forces of each speed."""
    out, error = np.full((2, len(speeds), count), np.nan)
    with bar(progress, len(speeds)) as tick:
        for k, speed in enumerate(speeds):
            if speed >= _SHORT * limit:
                break
            values = partial(_lowest, system, float(speed), count)
            out[k], error[k] = cycle_mean(values, system.period, enough=_ENOUGH)
            if tick is not None:
                tick(k + 1)
    return out, error


def _lowest(system: LinearPeriodic, speed: float, count: int, theta: Array) -> tuple[Array, Array]:
    frequency, error = held_frequencies(system, theta, {}, speed)
    return frequency[:, :count], error[:, :count]


def _running(
    system: LinearPeriodic, speeds: Array, held: Array, count: int
) -> tuple[Array, Array, float]:
    """Return frequencies and growth rates from the exponents, and how far they had to be sought."""
    from scipy.optimize import linear_sum_assignment

    from ..floquet import characteristic_exponents

    found = characteristic_exponents(system, speeds, count, rtol=1e-8)
    turn = 2.0 * np.pi / system.period
    rest = cycle_mean(partial(_lowest, system, 0.0, count), system.period, enough=_ENOUGH)[0]
    running, growth = np.empty((2, len(speeds), count))
    near, before = 0.0, rest
    for row, speed in enumerate(speeds):
        expected = np.where(np.isfinite(held[row]), held[row], before)
        spacing = speed * turn
        phase, rate = _phases(found, row, count)
        # Distance of each motion from each mode, a multiple of the speed aside; either sign of its
        # phase where the signature leaves it open.
        away = phase[:, :, None] * speed / system.period - expected
        away -= spacing * np.round(away / spacing)
        best = np.argmin(np.abs(away), axis=1)
        away = np.take_along_axis(away, best[:, None, :], axis=1)[:, 0]
        motion, mode = linear_sum_assignment(np.abs(away))
        running[row, mode] = expected[mode] + away[motion, mode]
        growth[row, mode] = rate[motion] * speed / system.period
        near = max(near, float(np.max(np.abs(away[motion, mode]))) / (0.5 * spacing))
        before = running[row]
    return running, growth, near


def _phases(found: SlowMultipliers, row: int, count: int) -> tuple[Array, Array]:
    """Return the phases of each motion, two where its sign is open, and its growth a period."""
    exponent, sign = found.exponents[row], found.signatures[row]
    phase, rate = np.empty((count, 2)), np.empty(count)
    for k in range(count):
        own = np.flatnonzero(found.mode[row] == k + 1)
        positive = own[sign[own] > 0]
        if len(positive):
            phase[k] = exponent.imag[positive[0]]
        else:
            phase[k] = abs(exponent.imag[own[0]]) * np.array([1.0, -1.0])
        rate[k] = float(np.max(exponent.real[own]))
    return phase, rate


def _crossings(speeds: Array, values: Array, mode: int) -> list[tuple[float, int, int, float]]:
    """Return speed, mode, order and error where a frequency is a whole multiple of the speed."""
    from scipy.interpolate import CubicSpline

    there = np.isfinite(values)
    w, f = speeds[there], values[there]
    if len(w) < 4:
        return []
    ratio = f / w
    curves = [CubicSpline(w[::step], ratio[::step]) for step in (1, 2)]
    out = []
    for n in range(max(1, int(np.ceil(ratio.min()))), int(np.floor(ratio.max())) + 1):
        side = np.where(np.abs(ratio - n) <= _LOCKED, 0.0, np.sign(ratio - n))
        known = np.flatnonzero(side)
        for i, j in pairwise(known):
            if side[i] == side[j]:
                continue
            if j > i + 1:
                out.append((float(0.5 * (w[i] + w[j])), mode, n, float(0.5 * (w[j] - w[i]))))
                continue
            fine = _root(curves[0], n, w[i], w[j])
            coarse = _root(curves[1], n, w[i], w[j])
            out.append((fine, mode, n, abs(fine - coarse) + 1e-12 * fine))
    return out


def _root(curve: Any, level: int, low: float, high: float) -> float:
    """Return the place within a bracket at which a curve takes a value; the chord's if none."""
    roots = np.asarray(curve.solve(level, extrapolate=False))
    inside = roots[(roots >= low) & (roots <= high)]
    if len(inside):
        return float(inside[0])
    ends = np.asarray(curve(np.array([low, high]))) - level
    share = ends[0] / (ends[0] - ends[1]) if ends[0] != ends[1] else 0.5
    return float(low + np.clip(share, 0.0, 1.0) * (high - low))
