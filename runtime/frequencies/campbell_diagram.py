"""Campbell's diagram: frequencies against the crank speed, with the lines of its multiples.

The exponents of a running mechanism are known but for multiples of the speed, and those of
different modes pass each other as the speed changes.  Modes are distinguished by shape: at each
speed each motion is resolved, along the whole turn, into the modes of the mechanism held still.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, require_system
from ..core.inputs import numbers, require_whole
from ..core.plotting import Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Check, Result, provenance
from ..core.trigonometric import even_angles
from ..periodic.lowest_modes import FreeMotions, LowestModes, free_motions
from .held import HeldCrank, HeldModes, buckling_speed, mean_frequencies


def running_frequencies(
    system: LinearPeriodic, speeds: Array, held: Array, rest: Array
) -> tuple[dict[str, Any], float, float]:
    """Return running frequencies, growth and shares ``(ns, modes)``, as :class:`Campbell` has them.

    The multiples of the speed are chosen by the ``held`` frequencies [rad/s], ``(ns, modes)``;
    where they are NaN by those of the speed before, before the first by ``rest``.  Then the
    largest distance from what was expected, over half the speed, and the relative error of
    frequencies by the modes that are left out, of which the highest speed decides.
    """
    turn = 2.0 * np.pi / system.period
    frequency, growth, share = np.empty((3, *held.shape))
    count, before, farthest = held.shape[1], rest, 0.0
    truncated, error = LowestModes(system, count).required(float(speeds[-1]))
    modes = HeldCrank(system, {}).modes(even_angles(system.period, _STATIONS))
    for row, speed in enumerate(speeds.tolist()):
        found = free_motions(truncated, speed, _STATIONS)
        phase, rate, share[row] = _named(found, modes, speed, count)
        expected = np.where(np.isfinite(held[row]), held[row], before)
        spacing = speed * turn
        away = phase * speed / system.period - expected
        away -= spacing * np.round(away / spacing)
        frequency[row], growth[row] = expected + away, rate * speed / system.period
        farthest = max(farthest, float(np.max(np.abs(away))) / (0.5 * spacing))
        before = frequency[row]
    return {"running": frequency, "growth": growth, "share": share}, farthest, error


def _named(
    found: FreeMotions, held: HeldModes, speed: float, count: int
) -> tuple[Array, Array, Array]:
    """Return phase and growth over a period of each mode's motion, and its share of it."""
    from scipy.optimize import linear_sum_assignment

    shares = _shares(found, held, speed)[:, :count]
    motion, mode = linear_sum_assignment(-shares)
    chosen = np.empty(count, dtype=np.int64)
    chosen[mode] = motion
    phase, rate = np.angle(found.multipliers), np.log(np.abs(found.multipliers))
    own = shares[chosen, np.arange(count)]
    # Where a motion locks to the speed it grows in one form and decays in another: both are shown
    # as the one that grows.
    turned = np.abs(np.exp(1j * phase[:, None]) - np.exp(1j * phase[chosen]))
    # Motions whose phases are this close turn alike: pairs of which one grows and one decays.
    alike = (turned <= 1e-6) & (shares >= 0.5 * own)
    return phase[chosen], np.max(np.where(alike, rate[:, None], -np.inf), axis=0), own


def _shares(found: FreeMotions, held: HeldModes, speed: float) -> Array:
    """Return the share of each motion in each held mode, turning forward, ``(2m, n)``."""
    # A motion x e^(i w t) of a mode with unit mass has the action |w x - i v|^2 / (4 w); what turns
    # backward, its conjugate, has none.  Shares are means over the turn.
    across = np.swapaxes(held.shape, -1, -2) @ held.mass
    place, rate = across @ found.q, speed * (across @ found.slope)
    omega = held.frequency[:, :, None]
    forward, backward = (
        np.abs(omega * place - sign * 1j * rate) ** 2 / omega for sign in (1.0, -1.0)
    )
    whole = np.sum(forward + backward, axis=1, keepdims=True)
    return np.asarray(np.mean(forward / whole, axis=0).T)


Indices = NDArray[np.int64]

_ENOUGH = 1e-9
# Even angles at which motions are compared with modes.
_STATIONS = 16


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
        each with that multiple of the speed added that brings it to its mode.  A motion is named
        by its shape, taken apart along the turn into the modes of the mechanism held still: names
        do not depend on the other speeds.
    growth : ndarray
        Their real parts [1/s], ``(ns, modes)``: positive where the motion grows.
    share : ndarray
        Share of each motion's action that is its own mode's, ``(ns, modes)``.  Where the exponents
        of two modes meet and their motions mix it drops to about a half, and the names change
        hands there.
    buckling : float
        Least crank speed [rad/s] at which the held mechanism buckles at some angle; inf if none.
    crossing_speed : ndarray
        Speeds at which a frequency of ``running`` is n times the speed, ``(nc,)`` [rad/s].
    crossing_mode, crossing_order : ndarray of int
        Mode (from 1) and n of each, ``(nc,)``.
    crossing_error : ndarray
        Error of each [rad/s], ``(nc,)``: of interpolating between the speeds, as uneven as the
        frequencies are there; half a locked range where the frequency is n times the speed over a
        range of it.
    error : ndarray
        Error of ``held`` [rad/s], ``(ns, modes)``; NaN with it.
    """

    speed: Array
    held: Array
    running: Array
    growth: Array
    share: Array
    buckling: float
    crossing_speed: Array
    crossing_mode: Indices
    crossing_order: Indices
    crossing_error: Array

    arrays_along: ClassVar = {
        "speed": "speed",
        "speed mode": "held running growth share error",
        "crossing": "crossing_speed crossing_mode crossing_order crossing_error",
    }
    column_units: ClassVar = {"rad/s": "error", "1/s": "growth"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the diagram and return the axes."""
        ax = axes_or_new(ax)
        top = 1.1 * float(np.nanmax(self.running))
        last = int(self.crossing_order.max(initial=1))
        named, room = np.inf, 0.03 * float(self.speed[-1] - self.speed[0])
        for n in range(1, last + 1):
            ax.plot(self.speed, n * self.speed, color="0.8", lw=0.6, zorder=0)
            x = min(float(self.speed[-1]), top / n)
            # Where the lines are close only some are named.
            if x == self.speed[-1] or named - x >= room:
                named = x
                ax.annotate(f"{n}", (x, n * x), fontsize=6, color="0.5", ha="right", va="bottom")
        for k in range(self.held.shape[1]):
            colour = f"C{k % 10}"
            ax.plot(self.speed, self.held[:, k], "--", color=colour, lw=0.9)
            ax.plot(self.speed, self.running[:, k], color=colour, lw=1.3)
            grown = self.growth[:, k] > 1e-6 * self.running[:, k]
            ax.plot(self.speed[grown], self.running[grown, k], ".", color="r", ms=5)
        height = self.crossing_order * self.crossing_speed
        ax.plot(self.crossing_speed, height, "ko", ms=3, mfc="none", mew=0.7)
        if self.buckling < self.speed[-1]:
            ax.axvline(self.buckling, color="0.5", lw=0.8, ls=":")
        ax.set(xlim=(self.speed[0], self.speed[-1]), ylim=(0.0, 1.05 * top))
        ax.set(xlabel="crank speed [rad/s]", ylabel="natural frequency [rad/s]; dashed: crank held")
        return ax


def campbell(
    system: LinearPeriodic, speed: ArrayLike, *, modes: int | None = None, progress: bool = False
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
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    Campbell
        Its check ``near``: the largest distance of a running frequency from the held one or, where
        there is none, from that at the speed before, over half the speed; from 1 on its multiple
        of the speed would be open.  ``truncated``: the relative error of running frequencies by
        the modes that are left out; where two motions are nearly one, of their mean.

    Raises
    ------
    BadInput
        If the speeds or the number of modes are unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.campbell(system, [29.5, 30.5, 31.5, 32.5], modes=1)
    >>> print(found.crossing_order, found.crossing_speed.round(1))
    [6] [30.7]
    """
    require_system(system)
    speeds = numbers("speed", speed)
    if speeds.ndim != 1 or len(speeds) < 4 or not np.all(np.diff(speeds) > 0) or speeds[0] <= 0:
        raise bad("speed", speed, "at least four rising speeds [rad/s]", "use numpy.linspace")
    wanted = min(4, system.size) if modes is None else modes
    count = require_whole("modes", wanted, 1, system.size)
    limit = buckling_speed(system).speed
    held, error = _held(system, speeds, count, limit, progress)
    rest = mean_frequencies(system, count, _ENOUGH)[0]
    found, away, left_out = running_frequencies(system, speeds, held, rest)
    crossing = sorted(
        row for k, curve in enumerate(found["running"].T, 1) for row in _crossings(speeds, curve, k)
    )
    return Campbell(
        method="means of held frequencies; characteristic exponents",
        error=error,
        error_norm="absolute, of each held mean [rad/s]",
        checks={"near": Check(away, 0.8), "truncated": Check(left_out, 1e-3)},
        provenance=provenance(system.provenance),
        speed=speeds,
        held=held,
        **found,
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
            if speed >= 0.999 * limit:  # next to buckling the means are no longer smooth
                break
            out[k], error[k] = mean_frequencies(system, count, _ENOUGH, float(speed))
            tick(k + 1)
    return out, error


def _crossings(speeds: Array, values: Array, mode: int) -> list[tuple[float, int, int, float]]:
    """Return speed, mode, order and error where a frequency is a whole multiple of the speed."""
    from scipy.interpolate import PchipInterpolator

    there = np.isfinite(values)
    w, f = speeds[there], values[there]
    if len(w) < 4:
        return []
    ratio = f / w
    # The frequency changes little with the speed; its ratio to the speed does.
    every_other = np.unique(np.append(np.arange(0, len(w), 2), len(w) - 1))
    curves = [PchipInterpolator(w[rows], f[rows]) for rows in (slice(None), every_other)]
    out = []
    for n in range(max(1, int(np.ceil(ratio.min()))), int(np.floor(ratio.max())) + 1):
        # A frequency this close to a multiple of the speed, over the speed, is locked to it.
        side = np.where(np.abs(ratio - n) <= 1e-7, 0.0, np.sign(ratio - n))
        known = np.flatnonzero(side)
        for i, j in pairwise(known):
            if side[i] == side[j]:
                continue
            if j > i + 1:
                out.append((float(0.5 * (w[i] + w[j])), mode, n, float(0.5 * (w[j] - w[i]))))
                continue
            fine, coarse = (_root(curve, n, w[i], w[j]) for curve in curves)
            # What the two rows to either side do beside the chord, meeting other frequencies, this
            # one may do inside unseen.
            near, slope = slice(max(0, i - 2), i + 4), (f[j] - f[i]) / (w[j] - w[i])
            off = np.max(np.abs(f[near] - f[i] - slope * (w[near] - w[i])))
            unseen = float(off) / abs(n - slope)
            out.append((fine, mode, n, abs(fine - coarse) + unseen + 1e-12 * fine))
    return out


def _root(curve: Any, order: int, low: float, high: float) -> float:
    """Return where a curve crosses a multiple of the speed within a bracket, or its nearer end."""
    from scipy.optimize import brentq

    ends = [float(curve(w)) - order * w for w in (low, high)]
    if ends[0] * ends[1] >= 0.0:
        return float(low if abs(ends[0]) <= abs(ends[1]) else high)
    return float(brentq(lambda w: float(curve(w)) - order * w, low, high, xtol=1e-13 * high))
