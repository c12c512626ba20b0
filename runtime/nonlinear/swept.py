"""Slow run-ups and coast-downs as a test bench has them: jumps, hysteresis, basins of motions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, Nonlinear
from ..core.inputs import is_finite, numbers_in_a_row, require_between, require_whole
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Check, Result, provenance
from ..core.tables import with_unit
from .march import Marcher, between_ends, end, from_rest, unresolved
from .orbit import EPS, Lost, Solver
from .response import SAMPLES, checked_problem, first_motion, tops
from .segments import Motion, NotFinite, Problem, Ramp

_MOST_TURNS = 200_000
# A jump: the peak-to-peak value changes by this factor, in logarithms; revolutions between two
# parts of one jump; for how many times the longest decay the motion settles; and revolutions over
# which most stable motions repeat.
_JUMP, _PAUSE, _SETTLED, _WINDOWS = 0.15, 6, 3.0, (1, 2)
# Basins: revolutions at the most, how near to a motion a state has come to it, in its sizes; places
# of the grid each way, and steps of a revolution at the most; and how many initial states are
# marched, or of a larger number check the map.
_REVOLUTIONS, _REACHED, _GRID, _COARSE, _FEW = 400, 0.02, 41, 64, 16


@dataclass(frozen=True, kw_only=True)
class SweepResponse(Result):
    """A motion while the speed of the drive changes slowly, revolution by revolution.

    Attributes
    ----------
    speed : ndarray, shape (k,)
        Speed in the middle of each revolution [rad/s].
    rising : ndarray of bool, shape (k,)
        Whether it rises.
    lowest, highest : ndarray, shape (k,)
        Extremes of the deflection in the revolution.
    jump_speed : ndarray, shape (j,)
        Speeds [rad/s] at which the deflection jumps: where the multipliers of the revolutions say
        that the motion is repelled from where it was, and it comes to another size, half of the
        way there.  A passage so quick that it never is repelled is no jump.
    jump_rising : ndarray of bool, shape (j,)
        Whether the speed rises.
    jump_ratio : ndarray, shape (j,)
        Largest or least peak-to-peak deflection after the jump over that before.
    rate : float
        Acceleration of the drive [rad/s^2].
    kicks : float
        Standard deviation of what disturbs coordinates and rates in each revolution.
    stopped : str
        Why it ends early; empty where it does not.
    """

    speed: Array
    rising: NDArray[np.bool_]
    lowest: Array
    highest: Array
    jump_speed: Array
    jump_rising: NDArray[np.bool_]
    jump_ratio: Array
    rate: float
    kicks: float
    stopped: str = ""
    unit: str = ""

    arrays_along: ClassVar = {
        "revolution": "speed rising lowest highest peak_to_peak error",
        "jump": "jump_speed jump_rising jump_ratio",
    }
    exported: ClassVar[tuple[str, ...]] = ("peak_to_peak",)
    column_units: ClassVar = {"rad/s^2": "rate"}

    @property
    def peak_to_peak(self) -> Array:
        """Highest less lowest deflection in each revolution, shape ``(k,)``."""
        return self.highest - self.lowest

    @property
    def hysteresis(self) -> float:
        """Distance of the first jump, run up, from the last below it, run down [rad/s]; or NaN."""
        up = self.jump_speed[self.jump_rising & (self.jump_ratio > 1.0)]
        down = self.jump_speed[~self.jump_rising]
        if not up.size or not down.size:
            return float("nan")
        below = down[down <= up[0]]
        return float(up[0] - np.max(below)) if below.size else float("nan")

    def _own_units(self) -> dict[str, str]:
        return dict.fromkeys(("lowest", "highest", "peak_to_peak"), self.unit)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the peak-to-peak deflection over the speed, up and down."""
        ax = axes_or_new(ax)
        size, unit = (1e3, "mm") if self.unit == "m" else (1.0, self.unit)
        for rising, colour, label in ((True, "C0", "run up"), (False, "C3", "run down")):
            at = self.rising == rising
            if np.any(at):
                values = size * self.peak_to_peak[at]
                ax.plot(self.speed[at] * RPM, values, color=colour, linewidth=1.0, label=label)
        ax.set(xlabel="crank speed [rpm]", ylabel=with_unit("peak-to-peak deflection", unit))
        ax.legend(frameon=False, fontsize="small")
        return ax


def sweep_response(
    system: Nonlinear,
    bounds: tuple[float, float],
    rate: float,
    direction: Literal["up", "down", "both"] = "both",
    *,
    kicks: float = 1e-6,
    seed: int = 0,
    rtol: float = 1e-8,
    progress: bool = False,
) -> SweepResponse:
    """March a nonlinear system while the speed of its drive rises or falls slowly.

    Parameters
    ----------
    system : Nonlinear
    bounds : tuple of float
        Lowest and highest speed [rad/s].
    rate : float
        Acceleration of the drive [rad/s^2], positive.
    direction : {"up", "down", "both"}
        ``both``: up, and down again from where that ends.
    kicks : float
        Standard deviation of the normal disturbance of coordinates and rates at the beginning of
        each revolution; without one a motion of two turns is never entered.
    seed : int
        Of the disturbances.
    rtol : float
        Wanted error of a revolution, relative.
    progress : bool
        Whether to show a bar.

    Returns
    -------
    SweepResponse

    Raises
    ------
    BadInput
        If an argument is unusable, or no motion can be begun with.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    >>> rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    >>> found = el.sweep_response(rig, (36.0, 38.0), rate=0.1, direction="down")
    >>> print(found.jump_speed.round(1), found.jump_rising)
    [36.5] [False]
    """
    problem, low, high = checked_problem(system, "speed", bounds, None)
    if not (is_finite(rate) and rate > 0):
        raise bad("rate", repr(rate), "a positive acceleration [rad/s^2]", "give its size")
    if direction not in ("up", "down", "both"):
        raise bad("direction", repr(direction), "'up', 'down' or 'both'", "correct it")
    require_between("kicks", kicks, 0.0, 1.0, "try 1e-6")
    require_whole("seed", seed, 0, 2**32 - 1)
    ways = {"up": (1,), "down": (-1,), "both": (1, -1)}[direction]
    turns = (high**2 - low**2) / (4.0 * np.pi * rate)
    if not 1.0 <= turns <= _MOST_TURNS / len(ways):
        fix = "sweep faster, or over less" if turns > 1.0 else "sweep slower, or over more"
        raise bad("rate", f"{turns:.3g} revolutions", f"1 to {_MOST_TURNS // len(ways)}", fix)
    marcher = Marcher(problem, rtol)
    rows: list[tuple[float, bool, float, float, float]] = []
    maps: list[Array] = []
    stopped = ""
    random = np.random.default_rng(seed)
    with bar(progress, int(turns * len(ways)) + 1, unit="turn") as tick:
        state = _begun(marcher, low if ways[0] > 0 else high)
        for way in ways:
            try:
                steps = _swept(marcher, (low, high), way * rate, state, kicks, random)
                for speed, extremes, unsure, motion in steps:
                    rows.append((speed, way > 0, *extremes, unsure))
                    assert motion.map is not None
                    maps.append(motion.map[0])
                    state = end(motion)
                    tick(len(rows))
            except (Lost, NotFinite) as failure:
                stopped = f"at {rows[-1][0] if rows else low:.6g} rad/s: {failure}"
                break
    speeds, rising, lowest_, highest_, error = (
        np.array(column) for column in zip(*rows, strict=True)
    )
    size, every, jumps = highest_ - lowest_, np.array(maps), []
    # What the speed changes in a revolution, over itself, and the error of the maps.
    least = 2.0 * np.pi * rate / low**2 + 100.0 * rtol
    for way in (True, False):
        at = rising == way
        found = _jumps(speeds[at], size[at], every[at], least)
        jumps += [(place, way, ratio) for place, ratio in found]
    return SweepResponse(
        method=f"marching by revolutions, Gauss collocation, seed {seed}",
        error=error,
        error_norm="of each revolution by itself, relative to its largest coordinate and rate",
        checks={"whole": Check(0.0 if not stopped else 1.0, 0.0)},
        provenance=provenance(system.provenance),
        speed=speeds,
        rising=rising.astype(bool),
        lowest=lowest_,
        highest=highest_,
        jump_speed=np.array([jump[0] for jump in jumps]),
        jump_rising=np.array([jump[1] for jump in jumps], dtype=bool),
        jump_ratio=np.array([jump[2] for jump in jumps]),
        rate=float(rate),
        kicks=float(kicks),
        stopped=stopped,
        unit=system.unit,
    )


def _begun(marcher: Marcher, speed: float) -> Array:
    """Return a state to begin with: of the periodic motion near rest, or after a while from it."""
    problem = marcher.problem
    try:
        solver = Solver(problem, speed, min(marcher.rtol, 1e-10))
        motion = solver.settled(speed, first_motion(problem))
        return solver.fine(speed, motion, solver.along_parameter(motion))[0].motion.states[:1]
    except (Lost, NotFinite):
        pass
    try:
        return end(from_rest(marcher, speed))
    except (Lost, NotFinite) as failure:
        fix = "begin at a speed where the motion stays small"
        raise bad("bounds", f"no motion at {speed:.6g} rad/s: {failure}", "one", fix) from failure


def _swept(
    marcher: Marcher,
    bounds: tuple[float, float],
    rise: float,
    state: Array,
    kicks: float,
    random: np.random.Generator,
) -> Iterator[tuple[float, tuple[float, float], float, Motion]]:
    """Yield speed, extremes, error and the motion of each revolution."""
    low, high = bounds
    speed = low if rise > 0 else high
    system, before = marcher.problem.system, None
    angles = np.linspace(0.0, 2.0 * np.pi, SAMPLES + 1)
    while True:
        after = speed**2 + 4.0 * np.pi * rise
        if not low**2 <= after <= high**2:
            return
        state = state + kicks * random.normal(size=state.shape)
        before = marcher.revolution(speed, state, before, Ramp(rise))
        # Rates by the angle stay what they are when the speed changes.
        error = unresolved(before) + between_ends(before) + 256 * EPS
        yield speed + np.pi * rise / speed, _extremes(system, before, angles), error, before
        state, speed = end(before), float(np.sqrt(after))


def _extremes(system: Nonlinear, motion: Motion, angles: Array) -> tuple[float, float]:
    """Return lowest and highest deflection of a revolution, that need not close."""

    def deflection(row: NDArray[np.int64], angle: Array) -> Array:
        return system.shown(motion.at(angle, row)[0])

    values = np.pad(deflection(np.zeros(len(angles), int), angles), 1, mode="edge")
    low, high = tops(deflection, angles, values[None], angles[1], (0.0, motion.span)).tolist()[0]
    return low, high


def _jumps(speed: Array, size: Array, maps: Array, least: float) -> list[tuple[float, float]]:
    """Return speed and ratio of each jump of a deflection, revolution by revolution."""
    # A motion that jumps is repelled from where it was: some of its multipliers over the
    # revolutions behind it are beyond the unit circle, however few it takes, by more than `least`
    # for each, of logarithms.  From there it comes to rest on another motion, of another size.
    count = len(size)
    largest = float(np.max(size, initial=0.0))
    if count < 8 or not largest:
        return []
    # A motion of two revolutions has two sizes; what rests has none.
    size = np.maximum(np.maximum(size, np.append(size[1:], size[-1])), 1e-9 * largest)
    repelled = np.arange(count) >= max(_WINDOWS) - 1
    for window in _WINDOWS:
        growth = _growth([maps[k : count - window + 1 + k] for k in range(window)])
        repelled[window - 1 :] &= growth > least * window
    decay = -float(np.median(growth)) / window
    settled = int(np.ceil(_SETTLED / decay)) if decay > 0.0 else count
    found: list[tuple[float, float]] = []
    last = 0
    places = np.flatnonzero(repelled)
    for part in np.split(places, np.flatnonzero(np.diff(places) > _PAUSE) + 1):
        if not part.size or part[0] < last:
            continue
        # Motions that repeat after more revolutions are not repelled over all of them.
        every = maps[part[0] : part[-1] + 1]
        if _growth(every) <= least * len(every):
            continue
        first = max(int(part[0]) - max(_WINDOWS), 0)
        last = min(int(part[-1]) + settled, count - 1)
        change = np.log(size[first : last + 1] / size[first])
        most = first + int(np.argmax(np.abs(change)))
        if abs(change[most - first]) < _JUMP:
            continue
        moved = np.abs(size[first : most + 1] - size[first])
        half = int(np.argmax(moved >= 0.5 * moved[-1]))
        found.append((float(speed[first + half]), float(size[most] / size[first])))
    return found


def _growth(maps: Sequence[Array] | Array) -> Array:
    """Return the logarithm of the largest multiplier of revolutions ``(k, ..., 2n, 2n)``."""
    # One comes behind the other; what is multiplied is scaled, so that no number of them is too
    # many.
    behind, scale = maps[0], np.zeros(maps[0].shape[:-2])
    for one in maps[1:]:
        behind = one @ behind
        size = np.max(np.abs(behind), axis=(-2, -1))
        behind, scale = behind / size[..., None, None], scale + np.log(size)
    return np.asarray(np.log(np.max(np.abs(np.linalg.eigvals(behind)), axis=-1)) + scale)


@dataclass(frozen=True, kw_only=True)
class Basins(Result):
    """Which periodic motion a system comes to from initial states at one speed.

    Attributes
    ----------
    q, rate : ndarray, shape (kx,) and (ky,)
        Initial first coordinate, and its rate by the angle of the drive.
    motion : ndarray of int, shape (ky, kx)
        Number of the motion, from 0; -1 where none was reached.
    peak_to_peak : ndarray, shape (m,)
        Deflection of each motion.
    turns : ndarray of int, shape (m,)
    speed : float
        [rad/s].
    """

    q: Array
    rate: Array
    motion: NDArray[np.int64]
    peak_to_peak: Array
    turns: NDArray[np.int64]
    speed: float
    unit: str = ""

    arrays_along: ClassVar = {
        "q": "q",
        "rate": "rate",
        "rate q": "motion",
        "attractor": "peak_to_peak turns",
    }

    def _own_units(self) -> dict[str, str]:
        return {"peak_to_peak": self.unit}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the basins in colours."""
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        ax = axes_or_new(ax)
        size, unit = (1e3, "mm") if self.unit == "m" else (1.0, self.unit)
        colours = ["0.85", *(f"C{i}" for i in range(len(self.turns)))]
        words = ["none of them"]
        for turns, deflection in zip(self.turns.tolist(), self.peak_to_peak, strict=True):
            words.append(f"{turns} turn{'s' * (turns > 1)}, {size * deflection:.3g} {unit}")
        ends: dict[str, Any] = {"vmin": -0.5, "vmax": len(colours) - 0.5}
        ax.pcolormesh(self.q, self.rate, self.motion + 1, cmap=ListedColormap(colours), **ends)
        patches = [Patch(color=c, label=w) for c, w in zip(colours, words, strict=True)]
        above: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
        ax.legend(handles=patches, fontsize="small", frameon=False, **above)
        ax.set(xlabel="initial q1", ylabel="initial dq1/dtheta")
        return ax


def basins(
    system: Nonlinear,
    speed: float,
    motions: Sequence[Motion],
    q: ArrayLike,
    rate: ArrayLike,
    *,
    progress: bool = False,
) -> Basins:
    """Return which of several periodic motions is reached from initial states at one speed.

    Each state is marched.  Of a system of one coordinate and more than 16 states the map of a
    revolution is computed on a grid of 41 by 41 states around them, and iterated by its splines.

    Parameters
    ----------
    system : Nonlinear
    speed : float
        [rad/s].
    motions : sequence of Motion
        Stable ones, as :func:`coexisting_motions` returns them.
    q, rate : array_like, shape (kx,) and (ky,)
        Initial first coordinates, and rates of it by the drive's angle, rising; others are 0.
    progress : bool
        Whether to show a bar.

    Returns
    -------
    Basins
        Its ``error``, of a map, is the share of 16 states, marched, that come to another motion: a
        way there may lead beyond the grid.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    >>> rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    >>> small, _, large = el.nonlinear.coexisting_motions(rig, "speed", 37.0).motions
    >>> found = el.nonlinear.basins(rig, 37.0, (small, large), q=[0.0], rate=[0.0])
    >>> print(found.motion, (1000.0 * found.peak_to_peak).round(1))
    [[0]] [30.8 61.7]
    """
    problem, _, _ = checked_problem(system, "speed", (0.5 * speed, speed), None)
    columns, rows = numbers_in_a_row("q", q), numbers_in_a_row("rate", rate)
    n, marcher = system.size, Marcher(problem, 1e-6, _COARSE)
    grid = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    states = np.zeros((len(grid), 2 * n))
    states[:, 0], states[:, n] = grid[:, 0], grid[:, 1]
    ends = [motion.states[:: len(motion.x) // motion.turns] for motion in motions]
    sizes = np.max([np.max(np.abs(part), axis=0) for part in ends], axis=0) + system.small
    number = np.repeat(np.arange(len(ends)), [len(part) for part in ends])
    reached = partial(_reached, np.concatenate(ends) / sizes, number, sizes)
    wrong, mapped = 0.0, n == 1 and len(states) > _FEW
    march = partial(_marched, marcher, speed)
    if mapped:
        step = _mapped(marcher, speed, columns, rows, progress)
        found = reached(step, states)
        some = np.random.default_rng(0).choice(len(states), _FEW, replace=False)
        wrong = float(np.mean(reached(march, states[some]) != found[some]))
    else:
        found = np.full(len(states), -1)
        with bar(progress, len(states), unit="state") as tick:
            for i in range(len(states)):
                (found[i],) = reached(march, states[i : i + 1])
                tick(i + 1)
    return Basins(
        method="map of a revolution on a grid" if mapped else "marching by revolutions",
        error=wrong,
        error_norm="share of states that come to another motion",
        provenance=provenance(system.provenance),
        q=columns,
        rate=rows,
        motion=found.reshape(len(rows), len(columns)),
        peak_to_peak=np.array([_peak_to_peak(problem, motion) for motion in motions]),
        turns=np.array([motion.turns for motion in motions]),
        speed=float(speed),
        unit=system.unit,
    )


def _peak_to_peak(problem: Problem, motion: Motion) -> float:
    angles = np.linspace(0.0, motion.span, SAMPLES * motion.turns, endpoint=False)
    return float(np.ptp(problem.system.shown(motion.at(angles)[0])))


def _reached(
    marks: Array,
    number: NDArray[np.int64],
    sizes: Array,
    step: Callable[[Array], Array],
    states: Array,
) -> NDArray[np.int64]:
    """Return the number of the motion that each state comes to, -1 where to none.

    ``marks``: states of all motions at the beginnings of revolutions, over sizes of the
    coordinates, with the number of each one's motion.  ``step`` takes states over a revolution;
    those that it loses become NaN.
    """
    found = np.full(len(states), -1)
    alive = np.arange(len(states))
    for _ in range(_REVOLUTIONS):
        states = step(states)
        gaps = np.max(np.abs((states / sizes)[:, None] - marks), axis=2)
        arrived = np.min(gaps, axis=1) < _REACHED
        found[alive[arrived]] = number[np.argmin(gaps, axis=1)[arrived]]
        keep = ~arrived & np.all(np.isfinite(states), axis=1)
        alive, states = alive[keep], states[keep]
        if not alive.size:
            break
    return found


def _marched(marcher: Marcher, speed: float, states: Array) -> Array:
    """Return states a revolution later, NaN where they are lost."""
    later, before = np.full_like(states, np.nan), None
    for i in range(len(states)):
        with suppress(Lost, NotFinite):
            # Neighbours of a grid begin one revolution from another's.
            before = marcher.revolution(speed, states[i : i + 1], before)
            later[i] = end(before)[0]
    return later


def _mapped(
    marcher: Marcher, speed: float, columns: Array, rows: Array, progress: bool
) -> Callable[[Array], Array]:
    """Return the map of a revolution by splines through its values on a grid."""
    from scipy.interpolate import RectBivariateSpline

    axes = [np.linspace(*_widened(values), _GRID) for values in (columns, rows)]
    later = np.full((_GRID, _GRID, 2), np.nan)
    with bar(progress, _GRID, unit="row") as tick:
        for i, q in enumerate(axes[0]):
            before = np.column_stack([np.full(_GRID, q), axes[1]])
            later[i] = _marched(marcher, speed, before)
            tick(i + 1)
    lost = np.any(np.isnan(later), axis=2)
    filled = np.where(lost[..., None], 0.0, later)
    splines = [RectBivariateSpline(*axes, filled[..., i]) for i in range(2)]
    gone = RectBivariateSpline(*axes, lost.astype(float), kx=1, ky=1)

    def step(states: Array) -> Array:
        inside = np.ones(len(states), dtype=bool)
        for values, axis in zip(states.T, axes, strict=True):
            inside &= (values >= axis[0]) & (values <= axis[-1])
        inside &= gone(*states.T, grid=False) <= 0.0
        after = np.stack([spline(*states.T, grid=False) for spline in splines], axis=1)
        return np.where(inside[:, None], after, np.nan)

    return step


def _widened(values: Array) -> tuple[float, float]:
    """Return the ends of a row, a quarter further apart: motions leave where they began."""
    low, high = float(np.min(values)), float(np.max(values))
    margin = 0.125 * (high - low) + 1e-9
    return low - margin, high + margin
