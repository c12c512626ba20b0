"""How far a running machine is from parametric instability, in speed and in each of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.optimize import brentq

from ..core.errors import BadInput, bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import require_between
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers
from ..periodic.equation import equation_of
from ..scenes import Scene
from ..stability import StabilityEdges, stability_edges
from .coefficient_changes import number_of, with_number
from .differentiation import feeding_of, sensitivities

# Width over the speed from which a region counts, and turns of the fastest mode per revolution up
# to which regions are looked for.
_WIDE, FASTEST = 1e-5, 25.0
# The largest change that is looked for, with how many trials; how closely it is solved for, and
# what multipliers leave of it.
_FAR, _MOST, _ROOT, _GAP_ERROR = 0.5, 24, 1e-14, 3e-13
_FEEDS = {
    "M": "inertia that varies with the crank angle",
    "A": "Coriolis coupling",
    "B": "centrifugal stiffness that varies with the crank angle",
    "K": "stiffness that varies with the crank angle",
    "Kg": "axial force in the link",
    "C": "damping that varies with the crank angle",
    "D": "damping of the carried motion",
}


@dataclass(frozen=True, kw_only=True)
class Margins(Result):
    """The ends of unstable regions that are nearest to a running speed.

    ``error`` is that of ``end`` [rad/s].

    Attributes
    ----------
    speed : float
        The running speed [rad/s].
    growth : float
        Largest logarithm of a multiplier's modulus: growth per turn, or, negative, the decay.
    growth_error : float
        Its error.
    stable : bool
        Whether no multiplier is outside the unit circle by more than its error.
    region : tuple of str, length k
        Names of the regions, by the distance of their nearest end: of each kind at most one that
        holds the speed, one below and one above.
    end, width : ndarray, shape (k,)
        The speed of that end and the width of the region [rad/s].
    distance : ndarray, shape (k,)
        Of the end from the speed, over the speed; negative where the region holds the speed.
    feeding : tuple of str, length k
        The term of the equation that does most for the width of the region.
    by : tuple of str
        Names of the m numbers.
    number : ndarray, shape (m,)
        Their values [SI].
    shift : ndarray, shape (k, m)
        Relative change of the end for a relative change of each number.
    change, change_error : ndarray, shape (k, m)
        Relative change of each number alone that brings the end to the speed, and its error; NaN
        where there is none up to one half.
    narrow : int
        Number of regions in the window that are too narrow to count.
    window : tuple of float
        Speeds [rad/s] between which regions were looked for.
    """

    speed: float
    growth: float
    growth_error: float
    stable: bool
    region: tuple[str, ...]
    end: Array
    width: Array
    distance: Array
    feeding: tuple[str, ...]
    by: tuple[str, ...]
    number: Array
    shift: Array
    change: Array
    change_error: Array
    narrow: int
    window: tuple[float, float]

    arrays_along: ClassVar = {
        "region": "end width distance error",
        "region by": "shift change change_error",
        "by": "number",
    }
    column_units: ClassVar = {"rad/s": "end width error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the changes that bring the nearest regions to the speed as bars."""
        ax = axes_or_new(ax)
        height = 0.8 / max(len(self.region), 1)
        for i, (name, change) in enumerate(zip(self.region, self.change, strict=True)):
            places = np.arange(len(self.by)) + height * i
            end = f"{name}, {self.end[i] * RPM:.4g} rpm"
            ax.barh(places, np.nan_to_num(100.0 * change), height, label=end)
        ax.set_yticks(np.arange(len(self.by)), self.by)
        ax.set(xlabel="change of the number alone that brings the end to the speed [%]")
        ax.legend(frameon=False, fontsize=8)
        return ax


def margins(
    machine: LinearPeriodic | Scene,
    speed: float,
    by: Sequence[str],
    *,
    window: float = 0.3,
    changes: bool = True,
) -> Margins:
    """Return how far a running speed is from unstable regions, in speed and in each number.

    Regions and their ends are those of :func:`stability_edges`; the change of a number that brings
    an end to the speed is begun by :func:`sensitivities` and solved for with the multipliers at
    that speed.

    Parameters
    ----------
    machine : LinearPeriodic or Scene
        The machine.
    speed : float
        Its running speed [rad/s].
    by : sequence of str
        Parameters and geometry of the system, or dotted keys of the scene.
    window : float
        Part of the speed below and above it within which regions are looked for, 0.01 to 0.9.
    changes : bool
        Whether the changes that bring the ends to the speed are wanted; they take most of the time.

    Returns
    -------
    Margins
        Its checks: ``edges``, whether those of the ends passed (0), and ``changes``, the largest
        error of a change over itself or a thousandth.

    Raises
    ------
    BadInput
        If an argument is unusable, or the fastest mode turns more than 25 times per revolution:
        then regions of high order lie at every speed, and any damping closes them.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch")
    >>> near = el.design.margins(scene, 82.0, ["links.coupler"])
    >>> print(near.region[0], near.end[0].round(3), near.distance[0].round(3))
    region 4 of mode 1 80.537 0.018
    """
    system = machine.linear_system() if isinstance(machine, Scene) else machine
    require_between("speed", speed, 1e-100, 1e100, "give a crank speed [rad/s]")
    require_between("window", window, 0.01, 0.9, "try 0.3")
    if (turns := fastest_mode(system, speed)) > FASTEST:
        found = f"a mode that turns {turns:.3g} times per revolution"
        raise bad("speed", found, f"at most {FASTEST:g}", "leave out the highest modes")
    around = (speed * (1.0 - window), speed * (1.0 + window))
    edges = stability_edges(system, around)
    multipliers = floquet_multipliers(system, speed, rtol=1e-11)
    rows = _nearest(edges, speed)
    region = np.array([row for row, _ in rows], dtype=int)
    side = np.array([end for _, end in rows], dtype=int)
    ends = np.stack([edges.lower, edges.upper], axis=1)[region, side]
    inside = (edges.lower[region] < speed) & (edges.upper[region] > speed)
    distance = np.where(inside, -1.0, 1.0) * np.abs(ends - speed) / speed
    slopes = sensitivities(machine, edges, by)
    change = np.full((len(rows), len(slopes.by)), np.nan)
    error = np.full(change.shape, np.nan)
    for k, (i, j) in enumerate(rows if changes else ()):
        gap = _gap(system, complex(edges.multiplier[i]), speed)
        for m, name in enumerate(slopes.by):
            rate = float(slopes.derivative[i, j, m] * slopes.number[m])
            first, breadth = (speed - ends[k]) / rate, edges.width[i] / abs(rate)
            change[k, m], error[k, m] = _solved(
                machine, system, name, gap, float(first), float(breadth)
            )
    known = np.isfinite(change)
    worst = np.max(error[known] / np.maximum(np.abs(change[known]), 1e-3), initial=0.0)
    exponents, feeding = multipliers.exponents.real, feeding_of(system, edges)
    top = int(np.argmax(exponents))
    return Margins(
        method="ends of unstable regions, and changes that bring them to the speed",
        error=edges.error[region],
        error_norm="absolute, of each end [rad/s]",
        checks={
            "edges": Check(0.0 if edges.passed else 1.0, 0.5),
            "changes": Check(float(worst), 1e-5),
        },
        provenance=provenance(system.provenance),
        speed=float(speed),
        growth=float(exponents[top]),
        growth_error=float(multipliers.error[top] / np.exp(exponents[top])),
        stable=bool(multipliers.stable),
        region=tuple(edges.labels[i] for i in region),
        end=ends,
        width=edges.width[region],
        distance=distance,
        feeding=tuple(_FEEDS.get(feeding[i], "") for i in region),
        by=slopes.by,
        number=slopes.number,
        shift=slopes.relative[region, side],
        change=change,
        change_error=error,
        narrow=int(np.count_nonzero(edges.width <= _WIDE * speed)),
        window=around,
    )


def fastest_mode(system: LinearPeriodic, speed: float) -> float:
    """Return how often the fastest mode with the crank held turns in a revolution."""
    turned = float(np.max(equation_of(system, speed).frequency)) * system.period
    return turned / (2.0 * np.pi)


def _nearest(edges: StabilityEdges, speed: float) -> list[tuple[int, int]]:
    """Return region and end, of each kind those that hold the speed or are next to it."""
    wide = edges.width > _WIDE * speed
    found = []
    for kind in dict.fromkeys(edges.kind):
        own = [i for i in np.flatnonzero(wide).tolist() if edges.kind[i] == kind]
        holding = [i for i in own if edges.lower[i] < speed < edges.upper[i]]
        below = [i for i in own if edges.upper[i] <= speed]
        above = [i for i in own if edges.lower[i] >= speed]
        found += [(i, int(edges.upper[i] - speed < speed - edges.lower[i])) for i in holding]
        found += [(max(below, key=lambda i: float(edges.upper[i])), 1)] if below else []
        found += [(min(above, key=lambda i: float(edges.lower[i])), 0)] if above else []
    ends = np.stack([edges.lower, edges.upper], axis=1)
    return sorted(found, key=lambda row: abs(float(ends[row]) - speed))


def _gap(system: LinearPeriodic, like: complex, speed: float) -> Callable[[LinearPeriodic], float]:
    """Return what vanishes for systems whose multipliers leave the unit circle at the speed."""
    # As they do at `like`: with damping the largest modulus passes 1; else two multipliers meet,
    # and the square of the distance of their sums with their inverses, r + 1/r, is smooth.
    damped = system.is_damped()

    def gap(other: LinearPeriodic) -> float:
        values = floquet_multipliers(other, speed, rtol=1e-12)
        if damped:
            return float(np.max(values.exponents.real))
        sums = values.multipliers + 1.0 / values.multipliers
        if abs(like.imag) < 1e-5:
            nearest = sums[np.argmin(np.abs(sums - 2.0 * like.real))]
            return float(nearest.real - 2.0 * round(like.real))
        # Each sum stands twice, for both multipliers of a pair.
        order = np.argsort(np.abs(sums - 2.0 * like.real), kind="stable")[:4]
        four = sums[order]
        distances = np.abs(four[1:] - four[0])
        other_sum = four[1 + int(np.argmax(distances))]
        return float(np.real((four[0] - other_sum) ** 2))

    return gap


def _solved(
    machine: LinearPeriodic | Scene,
    system: LinearPeriodic,
    name: str,
    gap: Callable[[LinearPeriodic], float],
    first: float,
    breadth: float,
) -> tuple[float, float]:
    """Return the relative change of a number with which a gap closes, and its error; else NaN."""
    # `first` is what the derivative says, `breadth` that change from one end to the other.
    if not abs(first) < _FAR:
        return np.nan, np.nan
    number = number_of(machine, system, name)

    def at(place: float) -> float:
        return gap(with_number(machine, system, name, number * (1.0 + place)))

    # A root that is not hidden by the region's other end: what the derivative misses is of second
    # order.
    reach = min(0.3, abs(first) + 0.05) * abs(first)
    count = int(min(max(2.0 * reach / (0.4 * breadth), 4.0), _MOST))
    places = first + reach * np.linspace(-1.0, 1.0, count + 1)
    try:
        values = np.array([at(float(place)) for place in places])
        meets = np.flatnonzero(np.diff(np.sign(values)) != 0.0)
        if not len(meets):
            return np.nan, np.nan
        # Where it comes from outside: the first change of sign on the way from the present value.
        k = int(meets[np.argmin(np.abs(places[meets]))])
        found = float(brentq(at, places[k], places[k + 1], xtol=_ROOT, rtol=_ROOT))
        rise = (values[k + 1] - values[k]) / (places[k + 1] - places[k])
        return found, _ROOT * (1.0 + abs(found)) + _GAP_ERROR / abs(float(rise))
    except BadInput:  # the changed machine does not turn
        return np.nan, np.nan
