"""The least changes of a machine with which a whole range of crank speeds is stable."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..core import inputs
from ..core.errors import BadInput, LinearRangeWarning, bad
from ..core.families import Array, LinearPeriodic
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers, simulate
from ..recovery import stress, stress_curve
from ..rigid import shaking_force
from ..scenes import Scene
from ..stability import speed_boundaries, stability_edges
from .drawing import Drawing, drawing_of

# Factor beyond the range within which regions are looked at, speeds of a range, angles of a turn;
# by how much, in logarithms, limits are kept by the search.
_BESIDE, _SPEEDS, _ANGLES, _INSIDE = 1.4, 200, 512, 2e-5


@dataclass(frozen=True)
class Change:
    """A change of the machine, with what verified it."""

    settings: Mapping[str, str]  # overrides for load_scene, in the units of the scene
    words: tuple[str, ...]  # what changes, with the values before
    size: float  # norm of the logarithms of the factors; of new damping the part of critical
    nearest: str  # the region nearest to the range, and where it ends
    distance: float  # of that from the range, over the speed; inf where there is none
    error: float  # of the distance
    excess: float  # largest modulus of a multiplier, less its error and what is allowed
    growth: float  # logarithmic, per turn, of marched motions, less what is allowed
    stress: float | None  # largest [Pa] with its error, where it is limited
    narrow: tuple[str, ...]  # regions in the range that are too narrow to count
    failed: tuple[str, ...]  # what was not confirmed


@dataclass(frozen=True, kw_only=True)
class Stabilisation(Result):
    """Changes of a machine that make a range of speeds stable; ``error`` is that of ``distance``.

    Attributes
    ----------
    speed_range : pair of float
        The range [rad/s].
    present : tuple of str
        What forbids the range at present; empty where nothing does.
    changes, unverified : tuple of Change
        The k changes that were verified, by rising size, and those that failed to be.
    impossible : tuple of str
        What cannot be had, and what forbids it.
    size, distance : ndarray, shape (k,)
        Of the changes.
    """

    speed_range: tuple[float, float]
    present: tuple[str, ...]
    changes: tuple[Change, ...]
    unverified: tuple[Change, ...]
    impossible: tuple[str, ...]
    size: Array
    distance: Array

    arrays_along: ClassVar = {"change": "size distance error"}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the sizes of the changes as bars, the least above."""
        ax = axes_or_new(ax)
        places = np.arange(1, len(self.changes) + 1)
        ax.barh(places, 100.0 * self.size)
        # A number and its change, without the values before and after.
        names = ["\n".join(word.split(" (")[0] for word in one.words) for one in self.changes]
        ax.set_yticks(places, names)
        ax.invert_yaxis()
        ax.set(xlabel="size of the change [%]")
        return ax


class _Aim(NamedTuple):
    """A range of speeds, as asked and with its margin, and limits."""

    low: float
    high: float
    begin: float
    end: float
    decay: float
    narrow: float
    limit: float | None
    shaking: float | None  # the largest shaking force at present [N], where it is to be kept

    @property
    def window(self) -> tuple[float, float]:
        return self.low / _BESIDE, self.high * _BESIDE

    def touches(self, ends: tuple[float, float]) -> bool:
        return ends[1] > self.begin and ends[0] < self.end


class _Machine(NamedTuple):
    """Ends of the regions that count, by name, and by how much limits are passed, in logarithms."""

    ends: dict[str, tuple[float, float]]
    over: dict[str, float]


class _Gap(NamedTuple):
    """Regions that are to be below the range and above it; of others the side that they are on."""

    aim: _Aim
    below: Sequence[str]
    above: Sequence[str]

    def over(self, machine: _Machine | None) -> dict[str, float]:
        """Return by how much each limit is passed, in logarithms."""
        if machine is None:
            return {"turn": np.inf}
        (_, low), (_, high) = self._beside(machine)
        own = {"below": math.log(low / self.aim.begin), "above": math.log(self.aim.end / high)}
        return {name: value + _INSIDE for name, value in (own | machine.over).items()}

    def reason(self, machine: _Machine | None) -> str:
        """Say which limit is passed most."""
        if machine is None:
            return "the crank cannot turn"
        over = self.over(machine)
        worst = max(over, key=over.__getitem__)
        more = f"{100.0 * math.expm1(over[worst]):.3g} %"
        (low, begin), (high, end) = self._beside(machine)
        return {
            "below": f"{low} still ends at {begin * RPM:.5g} rpm",
            "above": f"{high} still begins at {end * RPM:.5g} rpm",
            "growth": f"a motion still grows per turn by {more} more than allowed",
            "stress": f"the stress still passes its limit by {more}",
            "shaking": f"the shaking force is still larger than at present by {more}",
        }[worst]

    def _beside(self, machine: _Machine) -> list[tuple[str, float]]:
        """Return the regions next to the range, below and above, with the end on its side."""
        (low, high), middle = self.aim.window, self.aim.low + self.aim.high
        below, above = [("", low)], [("", high)]
        for name, (lower, upper) in machine.ends.items():
            if name in self.above or (name not in self.below and lower + upper > middle):
                above.append((name, lower))
            else:
                below.append((name, upper))
        return [max(below, key=lambda pair: pair[1]), min(above, key=lambda pair: pair[1])]


class _Search:
    """Looks for least shifts of the numbers of a drawing; machines once computed are kept."""

    def __init__(self, drawing: Drawing, aim: _Aim) -> None:
        self.drawing, self.aim = drawing, aim
        self._known: dict[tuple[float, ...], _Machine | None] = {}

    def machine(self, shifts: Array, regions: bool = True) -> _Machine | None:
        """Return the machine with shifted numbers; None where its crank cannot turn."""
        key = (*shifts.tolist(), float(regions))
        if key not in self._known:
            try:
                scene = self.drawing.changed(shifts.tolist())
                self._known[key] = _machine(scene, self.aim, regions)
            except BadInput:
                self._known[key] = None
        return self._known[key]

    def alone(self, place: int, gaps: Sequence[_Gap]) -> tuple[list[Array], str]:
        """Return the least shifts of one number alone, or else what forbids it."""
        number = self.drawing.numbers[place]
        unit = np.eye(len(self.drawing.numbers))[place]
        found, left = [], [(np.inf, "its bounds leave it as it is")]
        for gap, end in product(gaps[:1] if number.damping else gaps, filter(None, number.ends)):

            def over(shift: float, gap: _Gap = gap) -> dict[str, float]:
                return gap.over(self.machine(shift * unit, not number.damping))

            shift, kept = _outwards(over, end)
            if kept:
                found.append(shift * unit)
            reason = gap.reason(self.machine(shift * unit, not number.damping))
            left.append((max(over(shift).values()), reason))
        return found, "" if found else min(left)[1]

    def together(self, gap: _Gap, starts: Sequence[Array]) -> tuple[list[Array], str]:
        """Return the least shifts of all numbers but damping, or else what forbids it.

        Numbers that hardly take part are left as they are.
        """
        free = np.array([float(not number.damping) for number in self.drawing.numbers])
        for start in starts:
            found, reason = self._least(gap, start, free)
            if not reason:
                few = free * (np.abs(found) > 0.1 * np.max(np.abs(found)))
                fewer, worse = self._least(gap, found * few, few)
                return [found if worse else fewer], ""
        return [], reason

    def _least(self, gap: _Gap, start: Array, free: Array) -> tuple[Array, str]:
        """Return shifts of some numbers by SLSQP, in per cent, and what they fail to keep."""
        from scipy.optimize import minimize

        count = len(gap.over(self.machine(0.0 * free)))
        step = 1e-3 if self.aim.limit is None else 0.1

        def room(percent: Array) -> Array:
            over = gap.over(self.machine(0.01 * percent))
            return -100.0 * np.array([*over.values()] if len(over) == count else [1.0] * count)

        def slopes(percent: Array) -> Array:
            here, ways = room(percent), step * np.diag(free)
            columns = [room(percent + way) - here if np.any(way) else 0.0 * here for way in ways]
            return np.stack(columns, axis=-1) / step

        best = minimize(
            lambda percent: 0.5 * float(percent @ percent),
            100.0 * start,
            jac=lambda percent: percent,
            method="SLSQP",
            bounds=100.0 * free[:, None] * [number.ends for number in self.drawing.numbers],
            constraints={"type": "ineq", "fun": room, "jac": slopes},
            options={"maxiter": 20, "ftol": 1e-4},
        ).x
        kept = bool(np.all(room(best) >= -50.0 * _INSIDE))
        return 0.01 * best, "" if kept else gap.reason(self.machine(0.01 * best))


def _outwards(over: Callable[[float], dict[str, float]], end: float) -> tuple[float, bool]:
    """Return the first shift on the way to an end that keeps all limits, and True."""
    # Else the shift that passes them least, and False.
    from scipy.optimize import brentq, minimize_scalar

    def worst(shift: float) -> float:
        return max(over(shift).values())

    here, step, best, least = 0.0, end / 8.0, 0.0, abs(end) / 100.0
    while abs(end - here) > least:
        there = end if abs(here + step) > 0.999 * abs(end) else here + step
        before, after = over(here), over(there)
        if "turn" in after:
            end = 0.5 * (here + there)
            continue
        inside = there
        changed = max(before, key=before.__getitem__) != max(after, key=after.__getitem__)
        if worst(there) > 0.0 and changed:
            # What goes away and what comes nearer change places: between, the gap is best.
            ends, options = sorted((here, there)), {"xatol": 1e-4}
            found = minimize_scalar(worst, bounds=ends, method="bounded", options=options)
            inside = float(found.x)
        best = min(best, there, inside, key=worst)
        if worst(inside) <= 0.0:
            return float(brentq(worst, here, inside, xtol=1e-6)), True
        rise = (worst(there) - worst(here)) / (there - here) * end
        if rise > 0.0 and len(after) == 2:  # regions go the wrong way
            break
        wanted = -1.02 * worst(there) / rise if rise < 0.0 else 0.0
        here, step = there, end * float(np.clip(wanted, 1.0 / 8.0, 1.0 / 2.0))
    return best, False


def _gaps(machine: _Machine, aim: _Aim) -> list[_Gap]:
    """Return the ways to put the range between regions that are neighbours."""
    names = sorted(machine.ends, key=lambda name: sum(machine.ends[name]))
    cuts = [i for i, name in enumerate(names) if aim.touches(machine.ends[name])]
    below = sum(sum(machine.ends[name]) < aim.low + aim.high for name in names)
    cuts = [*cuts, cuts[-1] + 1] if cuts else [below]
    return [_Gap(aim, names[:cut], names[cut:]) for cut in cuts]


def _machine(scene: Scene, aim: _Aim, regions: bool = True) -> _Machine:
    """Return regions, where they are wanted, else growth; and by how much limits are passed."""
    system, speeds = scene.linear_system(), np.linspace(aim.begin, aim.end, _SPEEDS)
    found, over = _Machine({}, {}), {}
    if aim.limit is not None:
        curve: Any = stress_curve(system, speeds[::2], rtol=1e-2, whole=False)
        # A finer curve is higher by a thousandth at the most.
        over["stress"] = math.log(1.001 * np.max(curve.maximum) / aim.limit)
        over["growth"] = math.log(np.max(curve.multiplier)) + aim.decay
    elif aim.decay or not regions:
        exponents = floquet_multipliers(system, speeds).exponents
        over["growth"] = float(np.max(exponents.real)) + aim.decay
    if aim.shaking is not None:
        over["shaking"] = math.log(_shaking(scene, aim.high) / aim.shaking)
    if regions and aim.limit is None:
        names, lower, upper, _ = _of_one_mode(system, aim) or _regions(system, aim)
        for name, *ends in zip(names, lower.tolist(), upper.tolist(), strict=True):
            if ends[1] - ends[0] > aim.narrow * ends[0]:
                known = found.ends.get(name, ends)
                found.ends[name] = min(ends[0], known[0]), max(ends[1], known[1])
    return found._replace(over=over)


def _shaking(scene: Scene, speed: float) -> float:
    """Return the largest shaking force [N], the links taken as rigid."""
    angles = np.linspace(0.0, 2.0 * np.pi, _ANGLES, endpoint=False)
    force = shaking_force(scene.machine(), angles, speed).shaking_force
    return float(np.max(np.linalg.norm(force, axis=-1)))


_Rows = tuple[Sequence[str], Array, Array, Array]


def _regions(system: LinearPeriodic, aim: _Aim) -> _Rows:
    """Return names, ends and errors of regions; what lies beyond the window ends with it."""
    if aim.limit is not None:  # by multipliers alone, as in the search: regions of beams take long
        return (), *np.zeros((3, 0))
    beams = system.structure is not None  # their regions take long: those of the range alone
    window = (aim.begin, aim.end) if beams else aim.window
    edges = stability_edges(system, window, modes="auto" if beams else None)
    ends = np.stack([edges.lower, edges.upper])
    lower, upper = np.where(np.isfinite(ends), ends, np.array(aim.window)[:, None])
    return edges.labels, lower, upper, np.asarray(edges.error)


def _of_one_mode(system: LinearPeriodic, aim: _Aim) -> _Rows | None:
    """Return the same for one undamped mode, quickly; None for others, or too few to tell."""
    # The motions at both ends of the n-th region have n zeros in a turn.
    if system.size > 1 or system.is_damped():
        return None
    bounds = speed_boundaries(system, (1, -1), speed_range=aim.window)
    angles = np.linspace(0.0, system.period, 8 * bounds.harmonics, endpoint=False)
    rows: dict[int, list[float]] = {}
    for i, speed in enumerate(bounds.speed.tolist()):
        signs = np.sign(bounds.motion(i, angles)[:, 0])
        signs = np.append(signs, signs[0] * bounds.multiplier[i])
        rows.setdefault(int(np.count_nonzero(np.diff(signs))), []).append(speed)
    if len(rows) < 2:
        return None
    if len(rows[min(rows)]) == 1:
        rows[min(rows)].append(aim.window[1])
    if len(rows[max(rows)]) == 1:
        rows[max(rows)].insert(0, aim.window[0])
    lower, upper = np.array([ends[:2] for ends in rows.values()]).T
    return [f"region {n} of mode 1" for n in rows], lower, upper, 0.0 * lower


def stabilise(
    scene: Scene,
    speed_range: tuple[float, float],
    change: Sequence[str] | None = None,
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    margin: float = 0.01,
    decay: float = 0.0,
    limit: float | None = None,
    keep: Sequence[str] = (),
    narrow: float = 1e-4,
    turns: int | None = None,
    most: int = 6,
) -> Stabilisation:
    """Find the least changes of a machine with which a whole range of crank speeds is stable.

    Each number alone is moved until the range lies between two regions of instability
    (:func:`speed_boundaries`, :func:`stability_edges`), damping until it closes them, and all but
    damping together by SLSQP.  What is found is verified with the values that are told: regions
    anew, multipliers by collocation at 200 speeds (13 for beams), motions marched at three.

    Parameters
    ----------
    scene : Scene
        With a flexible link, of a linear formulation.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s].
    change : sequence of str, optional
        Keys of the scene; ``LINK.thickness`` of a flexible link of constant width changes all that
        follows from it.  By default lengths, thicknesses, masses at joints, the follower's inertia
        and damping.
    bounds : mapping of str to pair of float, optional
        Least and greatest value by key [SI], factors of a thickness that the scene does not give;
        by default 1.5 times less and more, new damping up to a fifth of the critical one.
    margin : float
        Part of the speed by which regions keep away from the range.
    decay : float
        Least logarithmic decay of all motions per turn.
    limit : float, optional
        Allowed stress [Pa], for linkages of beams with damping.
    keep : sequence of str
        ``"shaking_force"``, of the links taken as rigid, is not to become larger.
    narrow : float
        Width of a region over the speed below which it is told, but does not count: damping of half
        that, over the critical one, closes it.
    turns : int, optional
        Revolutions of a marched motion: 200, 20 of a linkage of beams.
    most : int
        How many changes are wanted.

    Returns
    -------
    Stabilisation
        Its checks, of the changes: ``multipliers``, the largest excess; ``march``, the largest
        growth.

    Raises
    ------
    BadInput
        If an argument is unusable, a key is no number or without effect, or the scene has no linear
        equations that regions can be found of.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch")
    >>> change, *_ = el.design.stabilise(scene, (77.5, 81.7), ["coupler.damping"]).changes
    >>> print(list(change.settings), round(change.size, 4))
    ['coupler.damping'] 0.0119
    """
    inputs.require_kind("scene", scene, Scene, "take load_scene(...)")
    low, high = inputs.speed_span(speed_range)
    inputs.require_between("margin", margin, 0.0, 0.2, "try 0.01")
    inputs.require_between("decay", decay, 0.0, 10.0, "leave it out")
    inputs.require_between("narrow", narrow, 1e-9, 0.1, "try 1e-4")
    inputs.require_positive("stabilise", **({} if limit is None else {"limit": limit}))
    most = inputs.require_whole("most", most, 1, 100)
    if set(kept := inputs.names_in_a_row("keep", keep)) - {"shaking_force"}:
        raise bad("keep", repr(kept), "('shaking_force',) or nothing", "correct it")
    drawing = drawing_of(scene, change, bounds)
    if turns is None:
        turns = 200 if scene.linear_system().structure is None else 20
    turns = inputs.require_whole("turns", turns, 20, 100_000)
    ends = low * (1.0 - margin), high * (1.0 + margin)
    aim = _Aim(low, high, *ends, decay, narrow, limit, _shaking(scene, high) if kept else None)
    present = _machine(scene, aim)
    gaps, told = _gaps(present, aim), tuple(_told(present, aim))
    candidates, impossible = _candidates(_Search(drawing, aim), gaps) if told else ([], [])
    verified: list[Change] = []
    for shifts in sorted(candidates, key=np.linalg.norm):
        if sum(not one.failed for one in verified) < most:
            verified.append(_verified(drawing, shifts, aim, turns))
    changes = tuple(one for one in verified if not one.failed)
    checks = {}
    if changes:
        checks["multipliers"] = Check(max(one.excess for one in changes), 0.0)
        checks["march"] = Check(max(one.growth for one in changes), _beats(turns))
    return Stabilisation(
        method="ends of regions by the Fourier matrix, roots and SLSQP over the numbers",
        error=np.array([one.error for one in changes]),
        error_norm="of each distance, over the speed",
        checks=checks,
        provenance=provenance(scene.linear_system().provenance),
        speed_range=(low, high),
        present=told,
        changes=changes,
        unverified=tuple(one for one in verified if one.failed),
        impossible=tuple(impossible),
        size=np.array([one.size for one in changes]),
        distance=np.array([one.distance for one in changes]),
    )


def _told(machine: _Machine, aim: _Aim) -> Iterator[str]:
    """Yield what forbids the range."""
    for name, ends in machine.ends.items():
        if aim.touches(ends):
            first, last = (f"{end * RPM:.5g}" for end in ends)
            yield f"{name} ({first} to {last} rpm) lies in the range or within its margin"
    if max(machine.over.values(), default=0.0) > 0.0:
        yield _Gap(aim, (), ()).reason(machine._replace(ends={}))


def _candidates(search: _Search, gaps: Sequence[_Gap]) -> tuple[list[Array], list[str]]:
    """Return shifts that the search found, and what cannot be had."""
    found: list[Array] = []
    impossible: list[str] = []
    numbers, written = search.drawing.numbers, search.drawing.written
    for place, number in enumerate(numbers):
        shifts, reason = search.alone(place, gaps)
        found += shifts
        if reason:
            low, high = (written(number.key, end) for end in number.bounds)
            impossible.append(f"with {number.key} alone from {low} to {high}: {reason}")
    if sum(not number.damping for number in numbers) > 1:
        starts = [np.zeros(len(numbers)), *sorted(found, key=np.linalg.norm)[:2]]
        for gap in gaps:
            shifts, reason = search.together(gap, starts)
            found += shifts
            if reason:
                impossible.append(f"with all but damping together within their bounds: {reason}")
    apart = [all(np.max(np.abs(a - b)) > 1e-4 for b in found[:i]) for i, a in enumerate(found)]
    return [one for one, new in zip(found, apart, strict=True) if new], impossible


def _beats(turns: int) -> float:
    """Return the growth per turn that beats of a marched motion may feign."""
    return math.log(1.2) / (turns / 2.0)


def _verified(drawing: Drawing, shifts: Array, aim: _Aim, turns: int) -> Change:
    """Return a change with what regions, multipliers and marching say of the changed scene."""
    settings = drawing.settings(shifts.tolist())
    scene = drawing.loaded(settings)
    system = scene.linear_system()
    rows = _regions(system, aim)
    nearest, distance, error, hidden, failed = _placed(rows, aim)
    speeds = np.linspace(aim.begin, aim.end, 13 if system.structure else _SPEEDS)
    lower, upper, slack = rows[1][hidden], rows[2][hidden], rows[3][hidden] + 1e-6 * aim.low
    at = speeds[:, None]
    speeds = speeds[~np.any((at > lower - slack) & (at < upper + slack), axis=1)]
    found = floquet_multipliers(system, speeds)
    excess = np.max(np.abs(found.multipliers) - found.error, axis=1) - math.exp(-aim.decay)
    marched = aim.low, aim.high, float(speeds[np.argmax(excess)])
    growth = max(_marched(system, speed, turns) for speed in marched) + aim.decay
    largest = None if aim.limit is None else _stress(system, aim)
    if np.max(excess) > 0.0:
        failed.append(f"a multiplier is {np.max(excess):.2g} too large")
    if growth > _beats(turns):
        failed.append(f"a marched motion grows per turn by {100.0 * growth:.2g} % too much")
    if aim.limit is not None and largest is not None and largest > aim.limit:
        failed.append(f"the stress reaches {largest / 1e6:.4g} MPa")
    if aim.shaking is not None and _shaking(scene, aim.high) > (1.0 + 1e-9) * aim.shaking:
        failed.append("the shaking force is larger than at present")
    return Change(
        settings=settings,
        words=tuple(drawing.words(shifts.tolist())),
        size=float(np.linalg.norm(shifts)),
        nearest=nearest,
        distance=distance,
        error=error,
        excess=float(np.max(excess)),
        growth=growth,
        stress=largest,
        narrow=tuple(
            f"{rows[0][i]}, {(upper - lower)[k] * RPM:.2g} rpm wide" for k, i in enumerate(hidden)
        ),
        failed=tuple(failed),
    )


def _placed(rows: _Rows, aim: _Aim) -> tuple[str, float, float, list[int], list[str]]:
    """Return the nearest region, its distance and the error of that; what is in the range."""
    # That is the regions too narrow to count, by their places, and the others in words.
    names, lower, upper, errors = rows
    inside = (upper > aim.begin) & (lower < aim.end)
    wide = upper - lower > aim.narrow * lower
    failed = [f"{names[i]} lies in the range" for i in np.flatnonzero(wide & inside).tolist()]
    hidden = np.flatnonzero(inside & ~wide).tolist()
    if not np.any(wide):
        return "no region is near", np.inf, 0.0, hidden, failed
    apart = np.where(wide, np.maximum(1.0 - upper / aim.low, lower / aim.high - 1.0), np.inf)
    i = int(np.argmin(apart))
    below = upper[i] < aim.low
    place = f"ends at {upper[i] * RPM:.5g}" if below else f"begins at {lower[i] * RPM:.5g}"
    return f"{names[i]} {place} rpm", float(apart[i]), float(errors[i] / aim.low), hidden, failed


def _marched(system: LinearPeriodic, speed: float, turns: int) -> float:
    """Return the logarithmic growth per turn of free motions, from half of the time to half."""
    start = np.full(system.size, 1e-6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        given: dict[str, Any] = {"initial": (start, speed * start), "forcing": False}
        motion = simulate(system, speed, turns, samples=24, **given)
    first, second = (np.max(np.abs(half)) for half in np.array_split(motion.q, 2))
    return math.log(max(second, 1e-300) / first) / (turns / 2.0)


def _stress(system: LinearPeriodic, aim: _Aim) -> float:
    """Return the largest stress of the range with its error, also by the whole equation [Pa]."""
    curve = stress_curve(system, np.linspace(aim.begin, aim.end, 2 * _SPEEDS), rtol=1e-3)
    sizes = np.max(curve.maximum * (1.0 + curve.error), axis=1)
    whole = stress(system, float(curve.speed[np.argmax(sizes)])).stress
    return float(max(np.max(sizes), np.max(whole)))
