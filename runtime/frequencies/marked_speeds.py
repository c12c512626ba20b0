"""Speeds at which a mechanism's multipliers say that it responds most: building blocks.

Three ways of the literature to critical speeds without a march in time: local maxima over the
speed of the multipliers' real parts (Aannaque 7.2.3), the same from few intervals of constant
frequency (Meissner's J_N, 7.11), and whole divisions of the mean frequency.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import BadInput, bad
from ..core.families import LinearPeriodic
from ..core.inputs import numbers, speed_span
from ..core.results import Result, provenance
from ..core.trigonometric import even_angles
from ..periodic import monodromy
from ..periodic.decoupled.exponents import SlowModes, SlowMultipliers
from ..periodic.decoupled.frames import held_modes
from ..periodic.first_order import canonical_form

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Whole = NDArray[np.int64]

# Turn of the highest mode between two samples [rad].
_TURN = 0.35
_MOST_SAMPLES = 4000
_ROUNDS = 12
# Relative step at which a maximum is found: beyond, the values say no more.
_CLOSE = 1e-7
# Lowest frequency left out, over the highest wanted and over the highest kept.
_BEYOND, _GAP = 4.0, 1.3
# Relative step of the speed by which frequencies are told.
_STEP = 1e-6


@dataclass(frozen=True, kw_only=True)
class MarkedSpeeds(Result):
    """Speeds marked by the equation without its forcing, mode by mode.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``(k,)``.
    mode : ndarray of int
        Mode, from 1, shape ``(k,)``.
    order : ndarray of int
        n: oscillations of that mode in a period, to the nearest; shape ``(k,)``.
    value : ndarray
        Real part of the multiplier, or J_N, at the speed; shape ``(k,)``.
    error : ndarray
        Absolute error of each speed [rad/s], shape ``(k,)``.
    speed_range : tuple of float
        The range [rad/s].
    """

    speed: Array
    mode: Whole
    order: Whole
    value: Array
    speed_range: tuple[float, float]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("speed", "mode", "order", "value", "error"), ("mark",)
    )

    @property
    def labels(self) -> tuple[str, ...]:
        """In words: ``mode 1, n = 3``."""
        pairs = zip(self.mode.tolist(), self.order.tolist(), strict=True)
        return tuple(f"mode {mode}, n = {n}" for mode, n in pairs)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the speeds as lines from 0 to their value, a colour to a mode."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for mode in np.unique(self.mode).tolist():
            own = self.mode == mode
            ax.vlines(self.speed[own], 0.0, self.value[own], f"C{mode - 1}", label=f"mode {mode}")
        ax.set_xlabel("crank speed [rad/s]")
        ax.set_ylabel("real part of the multiplier")
        if len(self.mode):
            ax.legend()
        return ax


def multiplier_maxima(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    count: int | None = None,
    *,
    rtol: float = 1e-9,
    **parameters: float,
) -> MarkedSpeeds:
    """Return the local maxima over the speed of the real parts of the multipliers.

    Each mode's multiplier of the larger real part is followed over the speed; where its real part
    has a local maximum the mechanism answers most to its periodic forcing (Aannaque 7.2.3).  In an
    unstable band with real multipliers beyond +1 it is the speed of greatest growth.

    Parameters
    ----------
    system : LinearPeriodic
        Of any size, stiff or not; with damping the maxima below the level of others count too.
        Where a few modes stand apart from the rest the speeds are swept on those alone; what that
        costs at the highest speed is in the error.
    speed_range : pair of float
        Lowest and highest speed [rad/s], the lowest positive.
    count : int, optional
        Number of modes, the lowest, see :func:`characteristic_exponents`.
    rtol : float
        Wanted error of the multipliers' matrix.
    **parameters : float
        Parameter values that replace the system's own; geometry too.

    Returns
    -------
    MarkedSpeeds
        Its checks: those of the multipliers on the grid.  A maximum between two samples, of which
        the highest mode turns by 0.35 rad at most, may be missed.

    Raises
    ------
    BadInput
        If an argument is unusable or the range needs more than 4000 samples.
    """
    low, high = speed_span(speed_range)
    slow = SlowModes(system, parameters)
    top = slow.highest_frequency(high, count)
    number = int(np.ceil(top * system.period * (1 / low - 1 / high) / _TURN)) + 8
    if number > _MOST_SAMPLES:
        raise bad(
            "speed_range",
            f"a lowest speed of {low:.4g} rad/s, which needs {number} samples",
            f"at most {_MOST_SAMPLES}",
            "raise the lowest speed or ask for fewer modes",
        )
    speed = 1.0 / np.linspace(1 / high, 1 / low, number)
    wanted = slow.wanted(count)
    swept = swept_modes(slow.system, (low, high), wanted)
    # At the highest speed the modes left out matter most.
    found = slow.exponents(speed if swept is None else speed[:1], wanted, rtol=rtol)
    frequency, slip = np.zeros(0), 0.0
    if swept is None:
        real, turns = _real_parts(found.multipliers, found.frequency, found)
    else:
        values, frequency = swept.multipliers(speed, wanted)
        real, turns = _real_parts(values, frequency, found, speed)
        slip = _slip(found, values[0], frequency[0])

    def value(at: Array, mode: Whole) -> Array:
        rows = np.arange(len(at))
        if swept is None:
            got = slow.exponents(at, wanted, rtol=rtol)
            return _real_parts(got.multipliers, got.frequency, got)[0][rows, mode]
        return _real_parts(*swept.multipliers(at, wanted), found, at)[0][rows, mode]

    row, mode = _peaks(real)
    own = speed[row], speed[row - 1], speed[row + 1]
    beside = real[row - 1, mode], real[row, mode], real[row + 1, mode]
    at, best, width = _refined(value, mode, (own[1], own[0], own[2]), beside)
    order = np.round(turns[row, mode]).astype(np.int64)
    noise = np.max(found.error[row if swept is None else np.zeros_like(row)], axis=-1)
    blur = _blur(beside, own[2] - own[1], noise)
    return MarkedSpeeds(
        method="local maxima of the real parts of the multipliers"
        + ("" if swept is None else f", on {swept.system.size} natural modes"),
        error=width + np.minimum(blur, np.abs(own[2] - own[1])) + slip * at,
        error_norm="absolute, of each speed [rad/s]",
        checks=found.checks,
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=at,
        mode=mode + 1,
        order=order,
        value=best,
        speed_range=(low, high),
    )


def _blur(values: tuple[Array, Array, Array], across: Array, noise: Array) -> Array:
    """Return how far the place of a maximum is open: rounding leaves it so by its root.

    From the values before, at and after the highest sample, and how far the outer two are apart.
    """
    curve = np.abs(values[0] - 2 * values[1] + values[2])
    return np.asarray(np.sqrt(2 * noise * (across**2 / 4) / np.maximum(curve, 1e-300)))


def _real_parts(
    values: ComplexArray, frequency: Array, found: SlowMultipliers, speed: Array | None = None
) -> tuple[Array, Array]:
    """Return the larger real part of each mode's multipliers, and its turns; ``(ns, m)``."""
    real = values.real
    m = real.shape[-1] // 2
    larger: Array = np.max(real.reshape(*real.shape[:-1], m, 2), axis=-1)
    rate = frequency.reshape(*real.shape[:-1], m, 2).mean(axis=-1)
    at = found.speed if speed is None else speed
    turns: Array = rate * found.period / (2 * np.pi * at[..., None])
    return larger, turns


def _slip(found: SlowMultipliers, values: ComplexArray, frequency: Array) -> float:
    """Return the relative error of speeds by the modes left out, from one speed.

    A multiplier's turn is its frequency over the speed: what it is off by, the speed is.
    """
    gap = np.min(np.abs(found.multipliers[0][:, None] - values), axis=0) / np.abs(values)
    turn = frequency * found.period / found.speed[0]
    return float(np.max(gap / turn))


def _peaks(values: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return row and column of the entries above both neighbours in their column."""
    inner = values[1:-1]
    above = (inner >= values[:-2]) & (inner > values[2:])
    column, row = np.nonzero(above.T)
    return row + 1, column


def _refined(
    call: Callable[[Array, Whole], Array],
    mode: Whole,
    brackets: tuple[Array, Array, Array],
    values: tuple[Array, Array, Array],
) -> tuple[Array, Array, Array]:
    """Refine maxima between samples by parabolas, all at once; return places, values, errors.

    ``brackets`` and ``values`` are first, middle and last, the middle value the largest.
    """
    x, f = np.stack(brackets), np.stack(values)
    moved = np.max(np.abs(x - x[1]), axis=0)
    for _ in range(_ROUNDS):
        wide = moved > _CLOSE * x[1]
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
        got[wide] = call(trial[wide], mode[wide])
        moved = np.where(wide, np.abs(trial - x[1]), moved)
        better = wide & (got > f[1])
        beyond = (trial - x[1]) * (x[2] - x[1]) > 0
        for side, chosen in ((0, beyond), (2, ~beyond)):
            # The old middle closes the bracket behind a better place.
            own = better & chosen
            x[side, own], f[side, own] = x[1, own], f[1, own]
        for side, chosen in ((2, beyond), (0, ~beyond)):
            own = wide & ~better & chosen
            x[side, own], f[side, own] = trial[own], got[own]
        x[1], f[1] = np.where(better, trial, x[1]), np.where(better, got, f[1])
    return x[1], f[1], moved


def meissner_function(phases: ArrayLike, frequencies: ArrayLike) -> Array:
    """Return Meissner's J_N: half the trace over a period of N intervals of constant frequency.

    The general N of (7.11), of which J_2 and J_3 are the products written out; from N = 4 on
    a Pfaffian of the ratios V_ik stands before four sines.

    Parameters
    ----------
    phases : array_like
        v_i t_i, frequency times length of each interval [rad], shape ``(..., N)``.
    frequencies : array_like
        v_i, positive, shape ``(..., N)``; only their ratios matter.

    Returns
    -------
    ndarray
        J_N, shape ``(...)``; the multipliers are ``J +- sqrt(J^2 - 1)``.

    Raises
    ------
    BadInput
        If a value is not finite or a frequency not positive.
    """
    turn, rate = np.broadcast_arrays(numbers("phases", phases), numbers("frequencies", frequencies))
    if not turn.ndim or not np.all(np.isfinite(turn)):
        raise bad("phases", phases, "finite numbers, at least one", "correct them")
    if not np.all(np.isfinite(rate) & (rate > 0)):
        raise bad("frequencies", frequencies, "positive numbers", "leave out what does not swing")
    cosine, sine = np.cos(turn), np.sin(turn)
    # Columns of the product of [[c, s/v], [-v s, c]], displacement over velocity.
    one, two = (np.stack([np.full(turn.shape[:-1], float(a)), np.full(turn.shape[:-1], float(b))])
                for a, b in ((1, 0), (0, 1)))  # fmt: skip
    for i in range(turn.shape[-1]):
        c, s, v = cosine[..., i], sine[..., i], rate[..., i]
        one, two = (
            np.stack([c * x[0] + s / v * x[1], c * x[1] - v * s * x[0]]) for x in (one, two)
        )
    value: Array = 0.5 * (one[0] + two[1])
    return value


def meissner_speeds(
    frequencies: ArrayLike,
    speed_range: tuple[float, float],
    intervals: int | None = None,
) -> MarkedSpeeds:
    """Return the local maxima over the speed of Meissner's J_N, from frequencies over the cycle.

    The even samples of each mode's frequency are averaged over ``intervals`` equal parts of the
    cycle; each mode is then y'' + (v(theta)/w)^2 y = 0 on its own, as in Aannaque's Fig. 7.3.
    What modes exchange, and the change of their shapes, is not in it.

    Parameters
    ----------
    frequencies : array_like
        Natural frequencies with the crank held, at even angles over one cycle without its end
        [rad/s], shape ``(nt, m)``, a column to a mode.
    speed_range : pair of float
        Lowest and highest speed [rad/s].
    intervals : int, optional
        N; by default one interval to a sample.

    Returns
    -------
    MarkedSpeeds
        ``error`` is how far the maximum lies from that of an interval to each sample, or, of as
        many, from that of half the intervals: an estimate of what the steps cost, where the
        frequencies themselves are right.

    Raises
    ------
    BadInput
        If a frequency is not positive, or there are more intervals than samples.
    """
    low, high = speed_span(speed_range)
    values = numbers("frequencies", frequencies)
    if values.ndim != 2 or not values.size or not np.all(np.isfinite(values) & (values > 0)):
        raise bad("frequencies", f"shape {values.shape}", "positive, (nt, m)", "correct them")
    count = len(values) if intervals is None else intervals
    if count != int(count) or not 1 <= count <= len(values):
        raise bad("intervals", intervals, f"a whole number from 1 to {len(values)}", "correct it")
    other = len(values) if count < len(values) else int(count) // 2
    levels, compared = _averaged(values, int(count)), _averaged(values, max(other, 1))
    parts = [_one_mode(levels[:, j], compared[:, j], (low, high)) for j in range(values.shape[1])]
    mode = np.repeat(np.arange(len(parts)), [len(part[0]) for part in parts]) + 1
    speed, value, error, order = (np.concatenate(c) for c in zip(*parts, strict=True))
    return MarkedSpeeds(
        method=f"local maxima of Meissner's J_{count}",
        error=error,
        error_norm="absolute, of each speed [rad/s], by the number of intervals alone",
        checks={},
        provenance=provenance(),
        speed=speed,
        mode=mode.astype(np.int64),
        order=order.astype(np.int64),
        value=value,
        speed_range=(low, high),
    )


def _averaged(values: Array, count: int) -> Array:
    """Return means over equal parts of the cycle, of samples that stand for their surroundings."""
    samples = len(values)
    edges = np.arange(count + 1) * samples / count
    total = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    places = np.arange(samples + 1, dtype=float)
    rows = [np.interp(edges, places, column) for column in total.T]
    means: Array = np.diff(np.stack(rows, axis=1), axis=0) * count / samples
    return means


def _one_mode(
    levels: Array, compared: Array, span: tuple[float, float]
) -> tuple[Array, Array, Array, Array]:
    """Return speeds, values, errors and orders of the maxima of one mode."""
    mean = float(np.mean(levels))
    number = int(np.ceil(2 * np.pi * mean * (1 / span[0] - 1 / span[1]) / 0.05)) + 8
    speed = 1.0 / np.linspace(1 / span[1], 1 / span[0], number)

    def value(at: Array, own: Array) -> Array:
        step = 2 * np.pi / len(own)
        return meissner_function(
            own * step / at[:, None], np.broadcast_to(own, (len(at), len(own)))
        )

    def maxima(own: Array) -> tuple[Array, Array, Array]:
        values = value(speed, own)
        row, _ = _peaks(values[:, None])
        zero = np.zeros(len(row), dtype=np.int64)
        brackets = speed[row - 1], speed[row], speed[row + 1]
        around = values[row - 1], values[row], values[row + 1]
        return _refined(lambda at, _: value(at, own), zero, brackets, around)

    at, best, width = maxima(levels)
    beside = maxima(compared)[0]
    gap = np.min(np.abs(at[:, None] - beside), axis=1, initial=np.inf)
    # A maximum that the other number of intervals does not have is not known at all.
    error = width + np.minimum(gap, at)
    return at, best, error, np.round(mean / at)


def mean_frequency_speeds(
    frequencies: ArrayLike, speed_range: tuple[float, float], most: int | None = None
) -> MarkedSpeeds:
    """Return whole divisions of each mode's mean frequency: w = mean / n (Aannaque 7.2.3).

    Parameters
    ----------
    frequencies : array_like
        As of :func:`meissner_speeds`, or the means alone, shape ``(m,)``.
    speed_range : pair of float
        Lowest and highest speed [rad/s].
    most : int, optional
        Highest n; by default all whose speeds lie in the range.

    Returns
    -------
    MarkedSpeeds
        ``value`` is 1, the real part of a multiplier at the mean frequency.  ``error`` is the part
        of a speed by which a variable frequency moves it, to leading order: the variance of the
        frequency over its mean squared, times the speed; of means alone it is not known (inf).

    Raises
    ------
    BadInput
        If a frequency is not positive.
    """
    low, high = speed_span(speed_range)
    values = numbers("frequencies", frequencies)
    if values.ndim not in (1, 2) or not np.all(np.isfinite(values) & (values > 0)):
        raise bad("frequencies", f"shape {values.shape}", "positive, (nt, m) or (m,)", "correct it")
    if most is not None and (most != int(most) or most < 1):
        raise bad("most", most, "a whole number of at least 1", "leave it out")
    mean = values if values.ndim == 1 else values.mean(axis=0)
    relative = np.full(len(mean), np.inf) if values.ndim == 1 else values.var(axis=0) / mean**2
    rows = []
    for j, rate in enumerate(mean.tolist()):
        first = max(1, int(np.ceil(rate / high)))
        last = int(np.floor(rate / low))
        last = last if most is None else min(last, int(most))
        rows += [(rate / n, j + 1, n, relative[j] * rate / n) for n in range(first, last + 1)]
    table = np.array(rows, dtype=float).reshape(-1, 4)
    return MarkedSpeeds(
        method="whole divisions of the mean frequency",
        error=table[:, 3],
        error_norm="absolute, of each speed [rad/s], by the frequency's variance",
        checks={},
        provenance=provenance(),
        speed=table[:, 0],
        mode=table[:, 1].astype(np.int64),
        order=table[:, 2].astype(np.int64),
        value=np.ones(len(table)),
        speed_range=(low, high),
    )


@dataclass(frozen=True)
class SweptModes:
    """The lowest modes of a stiff system over a range of speeds.

    Attributes
    ----------
    system : LinearPeriodic
        On its lowest natural modes.
    highest : float
        Highest speed [rad/s].
    """

    system: LinearPeriodic
    highest: float

    def multipliers(self, speed: Array, count: int) -> tuple[ComplexArray, Array]:
        """Return multipliers and mean frequencies [rad/s] of the lowest modes.

        Parameters
        ----------
        speed : ndarray, shape (ns,)
            Within the range [rad/s].
        count : int
            Number m of modes.

        Returns
        -------
        multipliers, frequency : ndarray
            Shape ``(ns, 2m)``, two to a mode, by rising frequency.  The frequency is the
            multiplier's turn by the time that a period takes.
        """
        system = self.system
        three = np.stack([speed / (1 + _STEP), speed, speed / (1 - _STEP)])
        found = monodromy(system, three.ravel(), rtol=1e-9)
        # The speed's own scale for all three.
        scale = found.scale.reshape(3, len(speed), -1)
        half = system.size
        plain = np.ldexp(found.matrix, found.exponent[:, None, None])
        plain = plain.reshape(3, len(speed), 2 * half, 2 * half)
        # In velocities of time, not of angle, a state is the same at all speeds.
        rate = np.ones((3, len(speed), 2 * half))
        rate[..., half:] = three[..., None]
        own = rate / np.concatenate([scale[1, :, :half], scale[1, :, half:] * speed[:, None]], 1)
        matrix = plain * own[..., :, None] / own[..., None, :]
        values, vectors = np.linalg.eig(matrix[1])
        inverse = np.linalg.inv(vectors)
        change = np.einsum("kij,kjl,kli->ki", inverse, matrix[2] - matrix[0], vectors)
        duration = system.period * (1 / three[2] - 1 / three[0])
        # Conjugates turn against each other.
        frequency = np.abs(np.imag(change / values)) / np.abs(duration)[:, None]
        # A locked pair does not turn on: it takes the frequency of the speeds beside.
        frequency[values.imag == 0.0] = np.nan
        size = np.concatenate([scale[1, :, :half], scale[1, :, half:] * speed[:, None]], 1)
        order = np.argsort(self._level(vectors * size[:, :, None]), axis=-1, kind="stable")
        order = order[:, : 2 * count]
        chosen = np.take_along_axis(values.astype(complex), order, axis=-1)
        rate = np.take_along_axis(frequency, order, axis=-1)
        return chosen, _filled(speed, rate, count)

    def _level(self, states: ComplexArray) -> Array:
        """Return energy over action of states (q, M qd) in columns, by the modes held at 0."""
        form = canonical_form(self.system, np.array([self.highest]), {})
        frequency, shapes, mass, _ = held_modes(form, np.zeros(1))
        half = self.system.size
        rest = np.abs(shapes[0].T @ mass[0] @ states[:, :half]) ** 2
        moved = np.abs(shapes[0].T @ states[:, half:]) ** 2
        rate = np.maximum(frequency[0], 1.0)[:, None]
        energy = rate**2 * rest + moved
        value: Array = np.sum(energy, axis=1) / np.sum(energy / rate, axis=1)
        return value


def _filled(speed: Array, rate: Array, count: int) -> Array:
    """Return frequencies, two to a mode, with those of locked pairs interpolated."""
    out = np.array(rate)
    for mode in range(count):
        own = rate[:, 2 * mode : 2 * mode + 2]
        known = np.all(np.isfinite(own), axis=1)
        order = np.flatnonzero(known)[np.argsort(speed[known])]
        mean = np.mean(own[order], axis=1)
        if len(order):
            filled = np.interp(speed, speed[order], mean)
            out[:, 2 * mode : 2 * mode + 2] = np.where(known, np.mean(own, axis=1), filled)[:, None]
    value: Array = np.where(np.isfinite(out), out, 0.0)
    return value


def swept_modes(system: LinearPeriodic, span: tuple[float, float], count: int) -> SweptModes | None:
    """Return the lowest modes over a range of speeds; None where no few modes stand apart.

    Parameters
    ----------
    system : LinearPeriodic
        Damped or not.
    span : pair of float
        Lowest and highest speed [rad/s].
    count : int
        Number of modes wanted.
    """
    from ..periodic.reduced import reduced_system

    form = canonical_form(system, np.array([span[1]]), {})
    frequency = held_modes(form, even_angles(system.period, 128))[0]
    top, low = np.max(frequency, axis=0), np.min(frequency, axis=0)
    for kept in range(count, system.size):
        apart = low[kept] >= _GAP * top[kept - 1] and low[kept] >= _BEYOND * top[count - 1]
        if not apart:
            continue
        try:
            reduced = reduced_system(system, kept)
        except BadInput:
            continue
        return SweptModes(reduced, span[1])
    return None
