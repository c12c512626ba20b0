"""All tongues of a system over a geometry value or a parameter, each named after its foot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.inputs import numbers
from ..core.results import Check, Result, provenance
from .meetings import Resonance, resonances
from .over_speed import MatricesOverSpeed
from .pairs import Events, pairs_at, refined_edges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

# Where the feet are, as a share of the least value; and how far their speeds may be off the range.
_FOOT, _BEYOND = 1e-6, 1.3
# Parts of the way over all values in one step; half a window of speeds, relative, to begin with.
_STEPS, _WINDOW = 16, 2e-3
_WIDER, _ROUNDS, _FARTHEST = 1.6, 9, 0.45
# Part of its width before that a wide tongue keeps in one step.
_SHRUNK = 0.6
# Places across an open tongue at which its growth is taken.
_ACROSS = np.linspace(0.1, 0.9, 9)


@dataclass(frozen=True, kw_only=True)
class TongueCurves(Result):
    """Ends of all tongues over one value; tongues k, values m.

    Attributes
    ----------
    name : str
        The geometry value or the parameter.
    at : ndarray, shape (m,)
        Its values.
    foot : ndarray, shape (k,)
        Speed [rad/s] from which the tongue starts where nothing is periodic.
    lower, upper : ndarray, shape (k, m)
        Speeds [rad/s]; equal where the tongue is narrower than ``least``; NaN from where it was
        lost on, in another tongue of one of its modes as a rule.
    error : ndarray, shape (k, m)
        Absolute error of either end [rad/s]; NaN where lost.
    least : ndarray, shape (k, m)
        Width [rad/s] below which the tongue would not be told from none.
    growth : ndarray, shape (k, m)
        Largest growth rate inside [1/s], of nine places across; 0 where closed.
    modes : ndarray of int, shape (k, 2)
        The two modes at the foot, from 1.
    harmonic : ndarray of int, shape (k,)
        n of ``w_i +- w_j = n w``.
    labels : tuple of str
        The condition at the foot, such as ``2 w1 = w``.
    """

    name: str
    at: Array
    foot: Array
    lower: Array
    upper: Array
    least: Array
    growth: Array
    modes: Whole
    harmonic: Whole
    labels: tuple[str, ...]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "at": ("value",),
        **dict.fromkeys(("foot", "harmonic", "labels"), ("tongue",)),
        **dict.fromkeys(("lower", "upper", "error", "least", "growth"), ("tongue", "value")),
        "modes": ("tongue", "mode"),
    }
    exported: ClassVar[tuple[str, ...]] = ("width",)

    @property
    def width(self) -> Array:
        """Widths [rad/s], shape ``(k, m)``."""
        return self.upper - self.lower

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tongues, speeds in rpm to the right, each named where it ends."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        rpm = 30.0 / np.pi
        colours = {"+": "#b2182b", "-": "#1b7837", "2": "#2166ac"}
        for i, label in enumerate(self.labels):
            kind = "2" if label.startswith("2") else "+" if "+" in label else "-"
            low = np.concatenate([[self.foot[i]], self.lower[i]]) * rpm
            high = np.concatenate([[self.foot[i]], self.upper[i]]) * rpm
            at = np.concatenate([[0.0], self.at])
            ax.fill_betweenx(at, low, high, color=colours[kind], alpha=0.35, lw=0)
            for ends in (low, high):
                ax.plot(ends, at, color=colours[kind], lw=0.8)
            last = int(np.flatnonzero(np.isfinite(low + high))[-1])
            ax.annotate(
                label,
                (0.5 * (low[last] + high[last]), at[last]),
                (0, 3),
                textcoords="offset points",
                rotation=90,
                fontsize=6,
                ha="center",
                va="bottom",
            )
        # Room for the names.
        ax.set_ylim(0.0, 1.2 * float(self.at[-1]))
        ax.set_xlabel("crank speed [rpm]")
        ax.set_ylabel(self.name.replace("_", " "))
        return ax


def tongue_curves(
    system: LinearPeriodic,
    name: str,
    values: ArrayLike,
    speed_range: tuple[float, float],
    *,
    highest: int = 3,
    modes: int | None = None,
    rtol: float = 1e-11,
) -> TongueCurves:
    """Follow every tongue of a conservative system from its foot over a geometry value.

    The feet are where exponents meet close to the value 0, where nothing is periodic any more.
    From there each is followed in small steps: two multipliers of opposite Krein signature, found
    by their arguments, and the zeros of ``2 - r/s - s/r`` of the two.

    Parameters
    ----------
    system : LinearPeriodic
        Its damping is left out.
    name : str
        A geometry name, such as ``crank_ratio``, or a parameter; at 0 nothing may be periodic.
    values : array_like, shape (m,)
        Positive and rising.
    speed_range : pair of float
        Speeds [rad/s]; tongues that start up to 1.3 times beyond are followed too, and kept where
        they reach it.
    highest : int
        Highest harmonic n.
    modes : int, optional
        Only tongues of the first so many modes; all without.
    rtol : float
        Wanted error of the monodromy matrices.

    Returns
    -------
    TongueCurves
        By rising foot.  Its checks: ``lost``, how many tongues were lost on the way (no error);
        ``verdicts``, at how many places inside open tongues no multiplier grows as it should.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Notes
    -----
    Beale & Scott 1992, section 3.1: feet at ``2 w1/n``, ``(w1 + w2)/n``, ``2 w2/n``.
    """
    at = _checked_values(system, name, values)
    sharp = system.without(*DAMPING)
    low, high = (float(v) for v in numbers("speed_range", speed_range))
    if not 0.0 < low < high < np.inf:
        raise bad("speed_range", speed_range, "(low, high), positive and rising", "correct it")
    span = (low / _BEYOND, high * _BEYOND)
    feet = resonances(_changed(sharp, name, _FOOT * float(at[0])), span, highest=highest)
    most = modes or system.size
    feet = [foot for foot in feet if foot.opens and max(foot.modes) <= most]
    feet.sort(key=lambda foot: foot.speed)
    tracks = _Tracks(feet, len(at))
    for value in _path(at, _STEPS):
        where = int(np.searchsorted(at, value)) if value in at else None
        tracks.step(_changed(sharp, name, float(value)), float(value), where, rtol)
    with np.errstate(invalid="ignore"):
        seen = np.any((tracks.ends[1] >= low) & (tracks.ends[0] <= high), axis=1)
    kept = np.flatnonzero(seen)
    lower, upper, error, least, growth = (row[kept] for row in tracks.ends)
    return TongueCurves(
        method="gap of multipliers of opposite Krein signature, followed from the foot",
        error=error,
        error_norm="absolute, of either end [rad/s]",
        checks={
            "lost": Check(float(np.sum(np.isnan(lower[:, -1]))), float(len(kept))),
            "verdicts": Check(float(tracks.wrong), 0.0),
        },
        provenance=provenance(system.changed_provenance(**{name: at})),
        name=name,
        at=at,
        foot=np.array([feet[i].speed for i in kept]),
        lower=lower,
        upper=upper,
        least=least,
        growth=growth,
        modes=np.array([feet[i].modes for i in kept], dtype=np.int64).reshape(-1, 2),
        harmonic=np.array([feet[i].harmonic for i in kept], dtype=np.int64),
        labels=tuple(feet[i].label for i in kept),
    )


def _checked_values(system: LinearPeriodic, name: str, values: ArrayLike) -> Array:
    """Return the values of a geometry name or parameter; raise where they are none."""
    names = sorted({*system.parameters, *system.geometry})
    if name not in names:
        raise bad("name", repr(name), f"one of {names}", "correct it")
    at = np.atleast_1d(numbers("values", values))
    if at.ndim != 1 or not np.all(np.isfinite(at)) or np.any(np.diff(at) <= 0) or not at[0] > 0:
        raise bad("values", f"shape {at.shape}", "positive rising values", "correct them")
    return at


def _changed(system: LinearPeriodic, name: str, value: float) -> LinearPeriodic:
    if name in system.geometry:
        return system.with_geometry(**{name: value})
    return system.with_parameters(**{name: value})


def _path(at: Array, steps: int) -> Array:
    """Return the values with steps between them of at most a part of the whole way."""
    stride = float(at[-1]) / steps
    first = min(float(at[0]), stride) / 4
    marks = np.concatenate([[first], at])
    parts = [
        np.linspace(a, b, int(np.ceil((b - a) / stride)) + 1)[:-1]
        for a, b in pairwise(marks.tolist())
        if b > a
    ]
    return np.unique(np.concatenate([*parts, at]))


@dataclass
class _Tracks:
    """What is known of each tongue so far, and the step to the next value.

    Attributes
    ----------
    feet : list of Resonance
        Where they start.
    count : int
        Number m of values kept.
    ends : ndarray, shape (5, k, m)
        Lower and upper end, error, least width and growth rate.
    wrong : int
        How many open tongues show no growth inside.
    """

    feet: list[Resonance]
    count: int
    ends: Array = field(init=False)
    wrong: int = 0

    def __post_init__(self) -> None:
        """Start every tongue at its foot, closed."""
        k = len(self.feet)
        self.ends = np.full((5, k, self.count), np.nan)
        self.middle = [[(0.0, foot.speed)] for foot in self.feet]
        self.wide = np.zeros(k)
        self.alive = np.ones(k, dtype=bool)
        rates = np.array([foot.frequencies for foot in self.feet]).reshape(k, 2)
        speed = np.array([foot.speed for foot in self.feet])
        # Turns in a period of the multiplier of positive signature, and of that of negative one.
        turns = rates / speed[:, None]
        difference = np.array([foot.kind == "difference" for foot in self.feet], dtype=bool)
        self.plus = turns[:, 0]
        self.minus = np.where(difference, turns[:, 1], -turns[:, 1])
        self.phase = 2 * np.pi * self.plus

    def step(self, system: LinearPeriodic, value: float, where: int | None, rtol: float) -> None:
        """Follow all living tongues to the next value; keep their ends where asked for."""
        index = np.flatnonzero(self.alive)
        if not len(index):
            return
        centre = np.array([_expected(self.middle[i], value) for i in index])
        last = np.array([self.middle[i][-1][1] for i in index])
        half = np.maximum(_WINDOW * centre, 0.75 * self.wide[index])
        half = np.clip(np.abs(centre - last), half, np.maximum(half, 0.05 * centre))
        half = np.minimum(half, _FARTHEST * centre)
        # A bracket that grows beyond this is solved for itself.
        span = 0.9 * float(np.min(centre - half)), 1.1 * float(np.max(centre + half))
        matrices = MatricesOverSpeed(system, span, {}, rtol)
        events, good = self._bracketed(matrices, index, centre, half)
        lost = index[~good]
        self.alive[lost] = False
        index, centre = index[good], centre[good]
        if not len(index):
            return
        edges = refined_edges(matrices, events)
        growth = self._growth(matrices, index, edges.lower, edges.upper)
        for place, i in enumerate(index):
            low, high = float(edges.lower[place]), float(edges.upper[place])
            if not np.isfinite(low + high) or self._jumped(int(i), low, high, float(centre[place])):
                self.alive[i] = False
                continue
            self.middle[i].append((value, 0.5 * (low + high)))
            self.wide[i] = high - low
            self.phase[i] = edges.phase[place]
            if where is not None:
                error, least = float(edges.error[place]), float(edges.least[place])
                self.ends[:, i, where] = low, high, error, least, growth[place]

    def _bracketed(
        self, matrices: MatricesOverSpeed, index: NDArray[np.intp], centre: Array, half: Array
    ) -> tuple[Events, NDArray[np.bool_]]:
        """Return speeds on either side of each tongue, and where such were found."""
        k = len(index)
        sides = np.stack([centre - half, centre + half])
        angles, fine = np.zeros((2, 2, k)), np.zeros((2, k), dtype=bool)
        ahead = np.zeros((2, k))
        for _ in range(_ROUNDS):
            for side in (0, 1):
                rows = np.flatnonzero(~(fine[0] & fine[1]))
                if not len(rows):
                    break
                speed = sides[side, rows]
                slip = centre[rows] / speed - 1.0
                own = index[rows]
                plus = self.phase[own] + 2 * np.pi * self.plus[own] * slip
                minus = self.phase[own] + 2 * np.pi * self.minus[own] * slip
                pair = pairs_at(matrices, speed, plus, minus)
                fine[side, rows] = pair.gap > 4 * pair.noise
                ahead[side, rows] = np.sign(pair.ahead)
                angles[0, side, rows], angles[1, side, rows] = pair.plus, pair.minus
            apart = fine[0] & fine[1] & (ahead[0] * ahead[1] < 0)
            if np.all(apart):
                break
            reach = np.where(apart, 1.0, _WIDER)
            reach = np.minimum(reach, np.maximum(1.0, _FARTHEST * centre / (sides[1] - centre)))
            sides = centre + (sides - centre) * reach
            fine &= apart
        good = fine[0] & fine[1]
        kept = np.flatnonzero(good)
        turn = 2 * np.pi
        # The arguments at the upper side on the turn of those at the lower.
        for row in angles:
            row[1] = row[0] + np.mod(row[1] - row[0] + np.pi, turn) - np.pi
        nothing = np.full(len(kept), np.nan)
        low, high = sides[0, kept], sides[1, kept]
        both = [np.stack([row[0, kept], row[1, kept]], axis=-1) for row in angles]
        return Events(low, high, nothing, np.stack([low, high], -1), both[0], both[1]), good

    def _jumped(self, i: int, low: float, high: float, expected: float) -> bool:
        """Return True where another pair was taken for this one: its tongue is elsewhere, or less.

        A tongue that another one of its modes reaches is cut to pieces; what is left of it there is
        not followed.
        """
        before, width = float(self.wide[i]), high - low
        off = abs(0.5 * (low + high) - expected)
        reach = max(before, _WINDOW * expected, abs(expected - self.middle[i][-1][1]))
        shrunk = width < _SHRUNK * before and before > _WINDOW * expected
        return off > 0.5 * max(reach, min(width, 2 * before)) or shrunk

    def _growth(
        self,
        matrices: MatricesOverSpeed,
        index: NDArray[np.intp],
        lower: Array,
        upper: Array,
    ) -> Array:
        """Return the largest growth rate inside each tongue [1/s]; 0 where closed."""
        out = np.zeros(len(index))
        rows = np.flatnonzero(upper > lower)
        if not len(rows):
            return out
        speed = (lower[rows] + np.multiply.outer(_ACROSS, upper[rows] - lower[rows])).ravel()
        many = np.tile(rows, len(_ACROSS))
        phase = self.phase[index[many]]
        pair = pairs_at(matrices, speed, phase, phase)
        turn = 2.0 * np.arcsinh(0.5 * np.sqrt(np.maximum(-pair.gap, 0.0))) / 2.0
        rate = (turn * speed / matrices.system.period).reshape(len(_ACROSS), -1)
        out[rows] = np.max(rate, axis=0)
        self.wrong += int(np.sum(np.all(pair.gap.reshape(len(_ACROSS), -1) > 0, axis=0)))
        return out


def _expected(known: list[tuple[float, float]], value: float) -> float:
    """Return the middle at a value: a polynomial in its square through the last three."""
    places = [(x * x, y) for x, y in known[-3:]]
    x = value * value
    total = 0.0
    for i, (xi, yi) in enumerate(places):
        factor = 1.0
        for j, (xj, _) in enumerate(places):
            if j != i:
                factor *= (x - xj) / (xi - xj)
        total += factor * yi
    return total
