"""Slow parametric driving: how wide a tongue of high order can be, extrapolated from lower ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.results import Check, Result, provenance
from .edges.over_geometry import checked_values, followed, foot_of
from .first_order import numbers
from .tongues.resonances import MeanSystem, Resonance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

# A width counts as measured from so many times its error on; so many make a line.
_MEASURED, _FEWEST = 50.0, 4
# Parts of the way over all values in one step: narrow tongues wander little.
_STEPS = 8
# Standard deviations of the slope that a line is lifted by, beside its largest residual and what
# the slope changed by.
_SAFETY = 3.0


@dataclass(frozen=True, kw_only=True)
class SlowTongues(Result):
    """Tongues of high order under slow driving; pairs k of modes, values m, orders h.

    Attributes
    ----------
    name : str
        The geometry value or parameter.
    at : ndarray, shape (m,)
        Its values.
    speed : float
        The range is from 0 to this speed [rad/s].
    modes : ndarray of int, shape (k, 2)
        The pairs.
    order : ndarray of int, shape (h,)
        Orders n of the tongues that were measured.
    relative_width : ndarray, shape (k, m, h)
        Width over speed; NaN where it is below what double precision resolves.
    lowest : ndarray of int, shape (k,)
        Lowest order whose foot is within the range.
    slope : ndarray, shape (k, m)
        Change of ``ln(n width/speed)`` from one order n to the next, on the mean.
    largest_width : ndarray, shape (k, m)
        Upper estimate of the width [rad/s] of the widest tongue of the pair in the range, the
        lowest order; NaN where too few widths were measured.
    error : ndarray, shape (k, m)
        Factor by which that estimate lies above the line itself, as a natural logarithm.
    """

    name: str
    at: Array
    speed: float
    modes: Whole
    order: Whole
    relative_width: Array
    lowest: Whole
    slope: Array
    largest_width: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "at": ("value",),
        "modes": ("pair", "mode"),
        "order": ("order",),
        "relative_width": ("pair", "value", "order"),
        "lowest": ("pair",),
        **dict.fromkeys(("slope", "largest_width", "error"), ("pair", "value")),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative widths over the order."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for pair, rows in zip(self.modes.tolist(), self.relative_width, strict=True):
            for value, row in zip(self.at.tolist(), rows, strict=True):
                label = f"w{pair[0]} + w{pair[1]}, {self.name.replace('_', ' ')} {value:g}"
                ax.semilogy(self.order, row, "o-", ms=3, lw=0.8, label=label)
        ax.set_xlabel("order n")
        ax.set_ylabel("width over speed")
        ax.legend(fontsize=6)
        return ax


def slow_tongues(
    system: LinearPeriodic,
    speed: float,
    name: str,
    values: ArrayLike,
    *,
    orders: Sequence[int] = tuple(range(5, 21)),
    pairs: Sequence[tuple[int, int]] = ((1, 1),),
    rtol: float = 1e-11,
) -> SlowTongues:
    """Tell how wide the tongues below a low speed can be, which no search could see.

    The width of a tongue ``w_i + w_j = n w`` of a smooth system over its speed falls like
    ``exp(-s n)/n`` (to leading order of slow driving: the share of the motion that changes its
    sense in a period, over the turns that it makes in it).  Those of moderate order are traced and
    measured; a line through the logarithms of n times the width, of the upper half of the orders,
    lifted by its uncertainty, is carried on to the lowest order in the range.  A kink of the line
    beyond what is measured would go unseen.

    Parameters
    ----------
    system : LinearPeriodic
        Its damping is left out.
    speed : float
        Highest speed of the range [rad/s].
    name : str
        A geometry name or parameter, at whose value 0 nothing is periodic.
    values : array_like, shape (m,)
        Positive and rising.
    orders : sequence of int
        Orders to measure, rising.
    pairs : sequence of (int, int)
        Modes, from 1.
    rtol : float
        Wanted error of the monodromy matrices.

    Returns
    -------
    SlowTongues
        An estimate, not a bound.  Check ``measured``: the number of lines with fewer than four
        measured widths.

    Raises
    ------
    BadInput
        If an argument is unusable, or the speed is within the orders measured.
    """
    at = checked_values(system, name, values)
    top = float(numbers("speed", speed))
    order = np.array(sorted({int(n) for n in orders}), dtype=np.int64)
    if not len(order) or order[0] < 1:
        raise bad("orders", orders, "whole numbers from 1", "choose range(5, 21)")
    if not 0.0 < top < np.inf:
        raise bad("speed", speed, "a finite number above 0", "choose the highest practical speed")
    sharp = system.without(*DAMPING)
    foot = foot_of(sharp, name, at)
    feet, totals = [], []
    for pair in pairs:
        if not (len(pair) == 2 and 1 <= pair[0] <= pair[1] <= system.size):
            raise bad(
                "pairs", pair, f"two modes (i, j), 1 <= i <= j <= {system.size}", "correct it"
            )
        frequency = MeanSystem(foot, {}).frequencies(np.array([top]))[0] * top
        total = float(frequency[pair[0] - 1] + frequency[pair[1] - 1])
        totals.append(total)
        feet += [_foot(pair, int(n), total / int(n), frequency) for n in order]
    lowest = np.array([int(np.ceil(total / top)) for total in totals], dtype=np.int64)
    if np.any(lowest <= order[-1]):
        raise bad("speed", top, "one below all that is measured", "use tongue_curves there")
    tracks = followed(sharp, name, at, feet, rtol, _STEPS)
    shape = (len(totals), len(order), len(at))
    low, high, error, least, _ = (row.reshape(shape).swapaxes(1, 2) for row in tracks.ends)
    with np.errstate(invalid="ignore"):
        width = high - low
        fine = width > _MEASURED * np.maximum(error, least)
        relative = np.where(fine, width / (0.5 * (low + high)), np.nan)
    slope, most, lift = _lines(order, relative, lowest)
    short = np.sum(np.isnan(slope))
    return SlowTongues(
        method="tongues traced from their feet, logarithm of order times width linear in the order",
        error=lift,
        error_norm="natural logarithm of the factor on largest_width",
        checks={"measured": Check(float(short), 0.0)},
        provenance=provenance(system.changed_provenance(**{name: at})),
        name=name,
        at=at,
        speed=top,
        modes=np.array(pairs, dtype=np.int64).reshape(-1, 2),
        order=order,
        relative_width=relative,
        lowest=lowest,
        slope=slope,
        largest_width=np.exp(most) * top,
    )


def _lines(order: Whole, width: Array, lowest: Whole) -> tuple[Array, Array, Array]:
    """Return slope, logarithm of the largest width and its uncertainty of every tongue's line."""
    slope, most, lift = (np.full(width.shape[:2], np.nan) for _ in range(3))
    for k, m in np.ndindex(slope.shape):
        slope[k, m], most[k, m], lift[k, m] = _line(order, width[k, m], int(lowest[k]))
    return slope, most, lift


def _foot(pair: tuple[int, int], n: int, speed: float, frequency: Array) -> Resonance:
    i, j = pair
    two = float(frequency[i - 1]), float(frequency[j - 1])
    kind = "principal" if i == j else "sum"
    return Resonance(
        kind="principal" if kind == "principal" else "sum",
        modes=pair,
        harmonic=n,
        speed=speed,
        frequencies=two,
        signatures=(1, -1),
    )


def _line(order: Whole, relative: Array, lowest: int) -> tuple[float, float, float]:
    """Return slope, logarithm of the lifted estimate at the lowest order, and the lift."""
    kept = np.flatnonzero(np.isfinite(relative))
    if len(kept) < _FEWEST:
        return np.nan, np.nan, np.nan
    # The slope is still settling: the upper half of the orders tells more of those to come, and
    # by as much as it differs from that of the lower half it may settle further.
    part = max(len(kept) // 2, 2)
    early, late = kept[: len(kept) - part], kept[-part:]
    if len(early) < 2:
        return np.nan, np.nan, np.nan
    logs = np.log(order * relative)
    slope, *spread = _fitted(order[late].astype(float), logs[late])
    # Few points lie on any line: what all of them tell of the scatter counts too.
    _, *whole = _fitted(order[kept].astype(float), logs[kept])
    doubt, rest = max(spread[0], whole[0]), max(spread[1], whole[1])
    change = abs(slope - _fitted(order[early].astype(float), logs[early])[0])
    ahead = lowest - float(np.mean(order[late]))
    lift = (_SAFETY * doubt + change) * ahead + rest
    middle = float(np.mean(logs[late]))
    return slope, middle + slope * ahead + lift - float(np.log(lowest)), lift


def _fitted(x: Array, y: Array) -> tuple[float, float, float]:
    """Return the slope of a line through points, its standard deviation, the largest residual."""
    dx, dy = x - np.mean(x), y - np.mean(y)
    spread = float(np.sum(dx**2))
    slope = float(np.sum(dx * dy)) / spread
    rest = dy - slope * dx
    doubt = float(np.sqrt(np.sum(rest**2) / max(len(x) - 2, 1) / spread))
    return slope, doubt, float(np.max(np.abs(rest)))
