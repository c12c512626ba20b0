"""Critical speeds of a linear periodic system by five methods (Aannaque chapter 7)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import DAMPING, Array, LinearPeriodic, require_system
from ..core.inputs import require_flag, require_whole, speed_span
from ..core.maxima import local_maxima
from ..core.plotting import ABOVE, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..core.trigonometric import even_angles
from .held import buckling_speed, held_frequencies, mean_frequencies
from .multiplier_maxima import Found, meissner_maxima, multiplier_maxima
from .response_maxima import response_maxima, scanned_deflections

Indices = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class CriticalSpeeds(Result):
    """Critical speeds of one method, by rising speed.

    Attributes
    ----------
    speed : ndarray
        Critical speeds [rad/s], shape ``(ns,)``.
    mode, order : ndarray of int
        Labels m (from 1) and n, ``(ns,)``: the speed belongs to the mean frequency of mode m over
        n.  Of ``mean_frequency`` by construction; of the others the nearest, a guess where two are
        near.
    ratio : ndarray
        The mean frequency of mode m over n times the speed, ``(ns,)``.
    height : ndarray
        What the method measures at the speed, ``(ns,)``: see ``quantity``; inf where a response
        has no bound: a multiplier is 1 there, at an end of an unstable band.
    error : ndarray
        Error of each speed [rad/s], ``(ns,)``, as the place of what the method looks for.
    mean_frequency : ndarray
        Mean natural frequencies over the period, crank held [rad/s], ``(modes,)``.
    scan_speed, scan : ndarray
        Speeds [rad/s] at which the quantity was looked at first, and it, for the picture; empty
        where no curve is scanned.
    quantity : str
        What ``height`` and ``scan`` are.
    """

    speed: Array
    mode: Indices
    order: Indices
    ratio: Array
    height: Array
    mean_frequency: Array
    scan_speed: Array
    scan: Array
    quantity: str

    arrays_along: ClassVar = {
        "speed": "speed mode order ratio height error",
        "frequency": "mean_frequency",
        "scan": "scan_speed scan",
    }
    column_units: ClassVar = {"rad/s": "error"}

    @property
    def labels(self) -> tuple[tuple[int, int], ...]:
        """Mode and order of each speed."""
        return tuple((int(m), int(n)) for m, n in zip(self.mode, self.order, strict=True))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the scanned quantity with the critical speeds labelled, and return the axes.

        Where nothing was scanned, the order n of each speed, mode by mode.
        """
        ax = axes_or_new(ax)
        ax.set_xlabel("crank speed [rad/s]")
        if not len(self.scan):
            return self._plot_orders(ax)
        top = np.isfinite(self.height)
        joined = np.concatenate([self.scan_speed, self.speed])
        order = np.argsort(joined, kind="stable")
        values = np.concatenate([self.scan, np.where(top, self.height, np.nan)])
        ax.plot(joined[order], values[order], lw=0.9)
        ax.set_ylabel(self.quantity)
        highest = 1.2 * np.max(self.scan)
        for speed, (mode, order_of), height in zip(
            self.speed, self.labels, self.height, strict=True
        ):
            name, place = rf"$\bar\omega_{mode}/{order_of}$", (speed, min(height, highest))
            ax.annotate(name, place, (0, 3), rotation=90, **ABOVE)
        return ax

    def _plot_orders(self, ax: Axes) -> Axes:
        """Draw the order of each speed, a row of points for each mode."""
        for mode in np.unique(self.mode):
            own = self.mode == mode
            points = (self.speed[own], self.order[own])
            colour = f"C{(mode - 1) % 10}"
            ax.plot(*points, "o", ms=4, color=colour, label=f"mode {mode}")
            ax.vlines(self.speed[own], 0, self.order[own], color=colour, lw=0.4)
        ax.set(ylabel="order n", ylim=(0.0, None))
        if len(self.mode):
            ax.legend(fontsize=8)
        return ax


@dataclass(frozen=True)
class Request:
    """A range of speeds [rad/s], and how many of them are scanned."""

    system: LinearPeriodic
    low: float
    high: float
    mean: Array  # natural frequencies, crank held, at rest, and their errors [rad/s], (modes,)
    mean_error: Array
    speeds: int
    progress: bool

    def listed(self, method: str, rows: Sequence[tuple[float, int, int, float]]) -> Found:
        """Return those within the range of speed, mode, order and error in rows."""
        kept = [row for row in rows if self.low <= row[0] <= self.high]
        speed, mode, order, error = np.array(kept, dtype=float).reshape(-1, 4).T
        return Found(method, speed, mode.astype(np.int64), error, order.astype(np.int64))


def label_speeds(mean: Array, speed: Array) -> tuple[Indices, Indices]:
    """Return mode (from 1) and order of each speed: whose mean frequency over n is nearest.

    The pairs that fit best choose first, and no label is given twice where another is left.
    """
    ratio = mean / speed[:, None]
    orders = np.maximum(1, np.round(ratio)).astype(np.int64)
    # How far the speed is from the fraction, over itself: of high orders all are near.
    misfit = np.abs(ratio - orders) / orders
    mode, order = np.zeros((2, len(speed)), dtype=np.int64)
    taken: set[tuple[int, int]] = set()
    for place, column in zip(
        *np.unravel_index(np.argsort(misfit, axis=None, kind="stable"), misfit.shape), strict=True
    ):
        label = int(column) + 1, int(orders[place, column])
        if not mode[place] and label not in taken:
            taken.add(label)
            mode[place], order[place] = label
    rest = mode == 0
    nearest = np.argmin(misfit, axis=1)
    mode[rest], order[rest] = nearest[rest] + 1, orders[rest, nearest[rest]]
    return mode, order


# Relative error of the means.
_ENOUGH = 1e-12
# Speeds at which the means are taken; between them they are interpolated.
_NODES = 12
# The means end this far before the held mechanism buckles: there they lose their smoothness.
_SHORT = 0.98


def by_mean_frequency(request: Request) -> Found:
    """Return the means of the natural frequencies over n = 1, 2, ..., crank held."""
    means = zip(request.mean, request.mean_error, strict=True)
    rows = [
        (float(mean / n), mode, n, float(error / n))
        for mode, (mean, error) in enumerate(means, 1)
        for n in range(1, int(np.floor(mean / request.low)) + 1)
    ]
    return request.listed("mean natural frequencies over n", rows)


def by_running_mean(request: Request) -> Found:
    """Return the speeds w = mean(w)/n, the means with the axial forces of the speed itself.

    They end where those forces buckle the held mechanism at some angle.
    """
    limit = _SHORT * buckling_speed(request.system).speed
    if limit <= request.low:
        found = f"a lowest speed of {request.low:.6g} rad/s, buckled at {limit / _SHORT:.6g} rad/s"
        fix = "use another method: beyond it there are no natural frequencies"
        raise bad("speed_range", found, "speeds below that", fix)
    low, high = request.low, min(request.high, limit)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    place = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    runs = [
        mean_frequencies(request.system, len(request.mean), _ENOUGH, float(middle + half * x))
        for x in place
    ]
    rows = []
    for mode in range(1, len(request.mean) + 1):
        values = np.array([mean[mode - 1] for mean, _ in runs])
        curve = np.polynomial.Chebyshev.fit(place, values, _NODES - 1, domain=[-1, 1])
        # The mean is smooth in the square of the speed: twice its last terms tell what is left out.
        doubt = 2.0 * float(np.sum(np.abs(curve.coef[-2:])))
        doubt += max(float(error[mode - 1]) for _, error in runs)
        for n in range(1, int(np.floor(np.max(values) / low)) + 1):
            line = np.polynomial.Chebyshev([n * middle, n * half], domain=[-1, 1])
            roots = (curve - line).roots()
            real = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) <= 1.0)].real
            steep = np.abs((curve - line).deriv()(real)) / half
            rows += [
                (float(middle + half * x), mode, n, doubt / rate)
                for x, rate in zip(real, np.maximum(steep, 1e-9 * n).tolist(), strict=True)
            ]
    return request.listed("mean natural frequencies at the speed over n", rows)


def by_multipliers(request: Request) -> Found:
    """Return the local maxima of the real part of each mode's multiplier (Aannaque 7.2.3)."""
    return multiplier_maxima(request.system, (request.low, request.high), len(request.mean))


# Of the fastest mode's motion at the lowest speed an interval of Meissner's is to hold so much at
# most [rad], of longer ones the steps throw waves back; and so many intervals at the most.
_INTERVAL, _MOST_INTERVALS = 0.4, 2**13


def by_meissner(request: Request) -> Found:
    """Return the local maxima of J_N of each mode by itself, N = 256 or more (Aannaque 7.11)."""
    period = request.system.period
    turned = float(np.max(request.mean)) * period / request.low
    intervals = 2 ** max(8, int(np.ceil(np.log2(turned / _INTERVAL))))
    if intervals > _MOST_INTERVALS:
        least = request.low * intervals / _MOST_INTERVALS
        found = f"a lowest speed of {request.low:.4g} rad/s, which needs {intervals} intervals"
        fix = f"raise the lowest speed to {least:.4g} rad/s or ask for fewer modes"
        raise bad("speed_range", found, f"at most {_MOST_INTERVALS}", fix)
    held = held_frequencies(request.system, even_angles(period, intervals), {})
    frequency, rounding = (part[:, : len(request.mean)] for part in held)
    return meissner_maxima(frequency, rounding, period, (request.low, request.high))


def by_response(request: Request) -> Found:
    """Return the speeds of the local maxima of a measure of the periodic motion."""
    system = request.system
    if not any(system.has(name) for name in DAMPING) or not system.is_damped():
        expected = "a damped system: without damping the maxima are infinite"
        raise bad("system", "no damping", expected, "add some with with_modal_damping")
    speeds = np.linspace(request.low, request.high, request.speeds)
    values = scanned_deflections(system, speeds, request.progress)
    top = local_maxima(values)
    speed, height, error = response_maxima(system, speeds[top - 1], speeds[top + 1])
    mode, order = label_speeds(request.mean, speed)
    return Found(
        f"local maxima of the steady state, {len(speeds)} speeds scanned",
        speed,
        mode,
        error,
        order,
        quantity="r.m.s. deflection over length",
        height=height,
        scan=(speeds, values),
        checks={"placed": Check(float(np.max(error / speed, initial=0.0)), 1e-3)},
    )


METHODS: Mapping[str, Callable[[Request], Found]] = MappingProxyType(
    {
        "mean_frequency": by_mean_frequency,
        "running_mean": by_running_mean,
        "response": by_response,
        "multipliers": by_multipliers,
        "meissner": by_meissner,
    }
)


def critical_speeds(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    method: str = "mean_frequency",
    modes: int | None = None,
    speeds: int = 240,
    progress: bool = False,
) -> CriticalSpeeds:
    """Return the speeds within a range at which a mechanism is most responsive.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forced and damped for ``response``.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s].
    method : str
        ``"mean_frequency"``: means of the natural frequencies over n = 1, 2, ..., crank held.
        ``"running_mean"``: the same with the axial forces of the speed itself, ``w = mean_m(w)/n``.
        ``"response"``: local maxima over the speed of the steady state's deflection: the largest,
        over the watched places, root of its mean square over a period, over the link's length.
        ``"multipliers"``: local maxima of the real part of a multiplier (Aannaque 7.2.3).
        ``"meissner"``: of J_N, each mode by itself with its frequency constant in each of N
        intervals (Aannaque 7.11).
    modes : int, optional
        Number of modes whose mean frequencies label the speeds, 4 by default.
    speeds : int
        Number of speeds of the first scan, of ``response``; a maximum between two of them that
        shows at neither is missed.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    CriticalSpeeds

    Raises
    ------
    BadInput
        If the range, the method or a number is unusable, or nothing of the system depends on the
        crank angle, as of a frame; of ``response``, if the system has no damping or its
        deflections are not known.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.critical_speeds(system, (40.0, 70.0), modes=1)
    >>> print(found.order, found.speed.round(2))
    [4 3] [46.02 61.36]
    """
    require_system(system)
    require_flag("progress", progress)
    if all(term.constant for term in system.terms):
        found, fix = "a frame: no crank moves it", "take natural_frequencies of it"
        raise bad("system", found, "a system that depends on a crank angle", fix)
    low, high = speed_span(speed_range)
    if not isinstance(method, str) or method not in METHODS:
        raise bad("method", repr(method), f"one of {tuple(METHODS)}", "choose one")
    wanted = min(4, system.size) if modes is None else modes
    count = require_whole("modes", wanted, 1, system.size)
    if not (isinstance(speeds, int) and speeds >= 3):
        raise bad("speeds", repr(speeds), "a whole number, 3 or more", "choose 240")
    mean, mean_error = mean_frequencies(system, count, _ENOUGH)
    answer = METHODS[method](Request(system, low, high, mean, mean_error, speeds, progress))
    rising = np.argsort(answer.speed, kind="stable")
    speed, mode = answer.speed[rising], answer.mode[rising]
    nearest = np.maximum(1, np.round(mean[mode - 1] / speed)).astype(np.int64)
    order = nearest if answer.order is None else answer.order[rising]
    return CriticalSpeeds(
        method=answer.method,
        error=answer.error[rising],
        error_norm="absolute, of each speed [rad/s], as this method defines it",
        checks=answer.checks,
        provenance=provenance(system.provenance),
        speed=speed,
        mode=mode,
        order=order,
        ratio=mean[mode - 1] / (order * speed),
        height=np.ones(len(rising)) if answer.height is None else answer.height[rising],
        mean_frequency=mean,
        scan_speed=answer.scan[0],
        scan=answer.scan[1],
        quantity=answer.quantity,
    )
