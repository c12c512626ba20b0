"""Response curves: the branches of periodic motions over a parameter, with their stability."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import groupby, pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import Array, Nonlinear
from ..core.files import NOT_SAVED
from ..core.inputs import is_finite, numbers, require_between, require_kind, require_whole
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.progress import bar
from ..core.results import Check, DeferredField, DeferredGroup, Result, provenance
from ..core.tables import with_unit
from .branch import CLOSED, JOINED, Branch, Limits, crossing, doubled, followed
from .march import Marcher, from_rest
from .orbit import FAILURES, FIRST_STEPS, MOST_STEPS, STAGES, Measure, Orbit, Solver, closed, taken
from .segments import Motion, Problem, sweep

_POINTS, _BRANCHES = 2000, 24  # points of one branch, and branches
SAMPLES = 128  # of a revolution, for extremes
# Relative distance within which motions are one: within its steps a motion is right to 1e-5 or so.
_SAME = 1e-4
# Places drawn between two points of a branch, and values of the linear answer.
_DRAWN, _LINEAR = 8, 120
# Fields that are computed when one of them is first looked at.
_LINEARISED = {
    name: DeferredField() for name in ("linear_value", "linear_lowest", "linear_highest")
}
_STYLE = {"fold": "o", "doubling": "s", "branch point": "D", "torus": "^"}


@dataclass(frozen=True, kw_only=True)
class ResponseCurve(Result):
    """Periodic motions over a parameter: all branches one behind the other, point by point.

    Attributes
    ----------
    parameter : str
        What is varied.
    value : ndarray, shape (k,)
        Its values [SI; rad/s for the speed].
    branch : ndarray of int, shape (k,)
        Number of the branch, from 0.
    turns : ndarray of int, shape (k,)
        Revolutions of the drive after which the motion repeats.
    lowest, highest : ndarray, shape (k,)
        Extremes of the deflection over the period, in ``unit``.
    multipliers : ndarray of complex, shape (k, 2n)
        Floquet multipliers over the period, the largest first.
    multiplier_error : ndarray, shape (k, 2n)
        Their absolute errors.
    error : ndarray, shape (k,)
        Distance of the motion from the branch, relative to its largest coordinate and rate.
    peak_error : ndarray, shape (k,)
        Absolute error of the extremes.
    special : tuple of str
        Kinds of the special points: ``"fold"``, ``"doubling"``, ``"branch point"``, ``"torus"``.
    special_value, special_error : ndarray, shape (p,)
        The parameter there, and its absolute error.
    special_branch : ndarray of int, shape (p,)
    special_lowest, special_highest : ndarray, shape (p,)
    ended : tuple of str
        Why each branch ends.
    bounds : tuple of float
        The range [SI].
    missed : tuple of float
        Ends of the range at which no motion was found to follow.
    linear_value, linear_lowest, linear_highest : ndarray, shape (l,)
        The answer of the equations linearised about no deflection, computed when first read.
    unit, parameter_unit : str
        Units of the deflection and of the parameter.

    Notes
    -----
    Branches that do not hang together with the one that begins at an end of the range are found
    by :func:`coexisting_motions` only, and never are all branches known.
    """

    parameter: str
    value: Array
    branch: NDArray[np.int64]
    turns: NDArray[np.int64]
    lowest: Array
    highest: Array
    multipliers: NDArray[np.complex128]
    multiplier_error: Array
    peak_error: Array
    special: tuple[str, ...]
    special_value: Array
    special_error: Array
    special_branch: NDArray[np.int64]
    special_lowest: Array
    special_highest: Array
    ended: tuple[str, ...]
    bounds: tuple[float, float]
    missed: tuple[float, ...] = ()
    unit: str = ""
    orbits: tuple[Orbit, ...] = ()
    special_orbits: tuple[Orbit, ...] = ()
    linear_value: Any = _LINEARISED["linear_value"]
    linear_lowest: Any = _LINEARISED["linear_lowest"]
    linear_highest: Any = _LINEARISED["linear_highest"]
    source: Solver = field(repr=False, metadata=NOT_SAVED)

    arrays_along: ClassVar = {
        "point": "value branch turns lowest highest error peak_error stable peak_to_peak",
        "point multiplier": "multipliers multiplier_error",
        "special_point": (
            "special_value special_error special_branch special_lowest special_highest special"
        ),
        "linear_point": " ".join(_LINEARISED),
    }
    exported: ClassVar[tuple[str, ...]] = ("stable", "peak_to_peak")

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where no multiplier lies outside the unit circle by more than its error."""
        return np.asarray(np.all(np.abs(self.multipliers) <= 1.0 + self.multiplier_error, axis=1))

    @property
    def peak_to_peak(self) -> Array:
        """Highest less lowest deflection, shape ``(k,)``."""
        return self.highest - self.lowest

    def _own_units(self) -> dict[str, str]:
        along = ("value", "special_value", "special_error", "linear_value")
        sizes = (
            *("lowest", "highest", "peak_to_peak", "peak_error"),
            *("special_lowest", "special_highest", "linear_lowest", "linear_highest"),
        )
        speed = dict.fromkeys(along, "rad/s") if self.parameter == "speed" else {}
        return {**speed, **dict.fromkeys(sizes, self.unit)}

    @property
    def _axes(self) -> tuple[float, str, float, str]:
        """Factors and labels or units of the parameter and of the deflection in pictures."""
        speed = self.parameter == "speed"
        along = (RPM, "crank speed [rpm]") if speed else (1.0, f"{self.parameter} [SI]")
        return (*along, *((1e3, "mm") if self.unit == "m" else (1.0, self.unit)))

    def draw(self, ax: Axes, *sizes: Array) -> None:
        """Draw sizes of the motions, ``(k,)`` each, smoothly: stable solid, unstable dotted."""
        from scipy.interpolate import PchipInterpolator

        factor, _, scale, _ = self._axes
        seen: set[str] = set()
        for number in range(len(self.ended)):
            (at,) = np.nonzero(self.branch == number)
            if len(at) < 2:
                continue
            turns = int(self.turns[at[0]])
            colour = f"C{turns.bit_length() - 1}"
            # A special point is all but stable: what it leads to decides.
            holds = self.stable[at[:-1]] & self.stable[at[1:]]
            ends = [0, *(np.flatnonzero(np.diff(holds)) + 1).tolist(), len(holds)]
            for size in sizes:
                both = np.stack([factor * self.value[at], scale * size[at]])
                # By the length of the curve as it is seen: motions lie unevenly about folds.
                extent = np.maximum(np.ptp(both, axis=1, keepdims=True), 1e-300)
                lengths = np.maximum(np.linalg.norm(np.diff(both) / extent, axis=0), 1e-9)
                places = np.concatenate([[0.0], np.cumsum(lengths)])
                fine = np.interp(
                    np.arange(_DRAWN * (len(at) - 1) + 1) / _DRAWN, np.arange(len(at)), places
                )
                along, shown = PchipInterpolator(places, both, axis=1)(fine)
                for first, last in pairwise(ends):
                    part = slice(_DRAWN * first, _DRAWN * last + 1)
                    style, word = ("-", "stable") if holds[first] else (":", "unstable")
                    label = f"{turns} turn{'s' * (turns > 1)}, {word}"
                    named = None if label in seen else label
                    ax.plot(along[part], shown[part], style, color=colour, label=named)
                    seen.add(label)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the peak-to-peak deflection: stable solid, unstable dotted, the linear one thin."""
        ax = axes_or_new(ax)
        factor, axis, size, unit = self._axes
        linear = size * (self.linear_highest - self.linear_lowest)
        ax.plot(factor * self.linear_value, linear, color="0.6", linewidth=0.8, label="linear")
        self.draw(ax, self.peak_to_peak)
        seen: set[str] = set()
        for kind, value, low, high in zip(
            self.special, self.special_value, self.special_lowest, self.special_highest, strict=True
        ):
            label, swing = None if kind in seen else kind, size * (high - low)
            ax.plot(factor * value, swing, _STYLE[kind], color="k", ms=4, label=label)
            seen.add(kind)
        largest = size * float(np.max(self.peak_to_peak, initial=0.0))
        height = with_unit("peak-to-peak deflection", unit)
        ax.set(xlabel=axis, ylabel=height, ylim=(0.0, 1.1 * largest))
        ax.legend(frameon=False, fontsize="small")
        return ax


def response_curve(
    system: Nonlinear,
    parameter: str,
    bounds: tuple[float, float],
    *,
    speed: float | None = None,
    turns: int = 1,
    largest: float = 0.25,
    rtol: float = 1e-8,
    starts: Iterable[tuple[float, Motion]] = (),
    progress: bool = False,
) -> ResponseCurve:
    """Follow the periodic motions of a nonlinear system over a parameter.

    Collocation of Gauss' with 12 stages on as many steps as the error wants, continued by its
    pseudo-arclength.  Folds, doublings, crossings of branches and tori are located on the way;
    branches that begin at doublings and crossings are followed too.

    Parameters
    ----------
    system : Nonlinear
        For example ``scene.system()`` of a scene with formulation ``inextensible``.
    parameter : str
        ``"speed"``, or a name of ``system.parameters``.
    bounds : tuple of float
        Lowest and highest value [SI].
    speed : float, optional
        Speed of the drive [rad/s] where something else is varied.
    turns : int
        Largest number of revolutions after which the motions repeat: doublings are followed up to
        it.
    largest : float
        Deflection over the length of the link at which a branch ends.
    rtol : float
        Wanted error of the motions, relative.
    starts : iterable of (float, Motion), optional
        More motions from which branches are followed both ways, as they come from
        :func:`coexisting_motions`.
    progress : bool
        Whether to show a bar.

    Returns
    -------
    ResponseCurve

    Raises
    ------
    BadInput
        If an argument is unusable, or no periodic motion is found at either end of the range.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    >>> rig = el.load_scene("smith_1972_101104_thirtysecond_inch", changes).system()
    >>> curve = el.response_curve(rig, "speed", (32.0, 40.0))
    >>> print(curve.special, curve.special_value.round(1))
    ('fold', 'fold') [37.3 36.8]
    """
    problem, low, high = checked_problem(system, parameter, bounds, speed)
    require_whole("turns", turns, 1, 64)
    if not (is_finite(rtol) and 1e-13 <= rtol <= 1e-3):
        raise bad("rtol", repr(rtol), "a number from 1e-13 to 1e-3", "try 1e-8")
    require_between("largest", largest, 1e-6, 10.0, "try 0.25")
    solver, limits = Solver(problem, high - low, rtol), Limits(low, high, largest, _POINTS)
    with bar(progress, _BRANCHES, unit="branch") as tick:
        tracer = _Tracer(solver, limits, turns, tick)
        missed = tracer.trace(starts)
    return _result(solver, tracer.branches, (low, high), missed)


def checked_problem(
    system: Nonlinear, parameter: str, bounds: tuple[float, float], speed: float | None
) -> tuple[Problem, float, float]:
    """Return the problem and the range, having checked the arguments."""
    fix = "take the .system() of a scene with formulation 'inextensible'"
    require_kind("system", system, Nonlinear, fix)
    known = ["speed", *sorted(system.parameters)]
    if parameter not in known:
        raise bad("parameter", repr(parameter), f"one of {known}", "correct the name")
    low, high = rising_pair(bounds)
    if parameter == "speed":
        if speed is not None:
            raise bad("speed", speed, "none, since the speed is varied", "leave it out")
        if not low > 0:
            raise bad("bounds", repr(bounds), "positive speeds", "begin above 0")
        return Problem(system, parameter, 0.0), low, high
    if speed is None or not (is_finite(speed) and speed > 0):
        raise bad("speed", repr(speed), "a positive speed of the drive [rad/s]", "give it")
    for value in (low, high):
        system.with_parameters(**{parameter: value})
    return Problem(system, parameter, float(speed)), low, high


def rising_pair(bounds: tuple[float, float]) -> tuple[float, float]:
    """Return the ends of a range; refuse what is none."""
    values = numbers("bounds", bounds)
    if values.shape != (2,) or not np.all(np.isfinite(values)) or not values[0] < values[1]:
        raise bad("bounds", repr(bounds), "(low, high) with low < high", "correct it")
    return float(values[0]), float(values[1])


def first_motion(problem: Problem, turns: int = 1) -> Motion:
    """Return no motion, on as many steps as the number of coordinates suggests."""
    steps = FIRST_STEPS * max(problem.system.size, 1) * turns
    return Motion.rest(problem.system, turns, min(steps, MOST_STEPS), STAGES)


@dataclass(frozen=True)
class _Tracer:
    """Follows branches, each of them once, and those that begin on them."""

    solver: Solver
    limits: Limits
    turns: int  # of motions after doublings, at the most
    tick: Callable[[int], None]
    branches: list[Branch] = field(default_factory=list)
    # Where other branches begin.
    queue: list[tuple[Orbit, Measure]] = field(default_factory=list)

    def trace(self, starts: Iterable[tuple[float, Motion]]) -> tuple[float, ...]:
        """Follow all branches; return the ends of the range at which no motion was found."""
        solver, limits = self.solver, self.limits
        missed: dict[float, str] = {}
        for value, sign in ((limits.low, 1.0), (limits.high, -1.0)):
            try:
                motion = _begun(solver, value)
                if self._known(value, motion):
                    continue
                begun = solver.fine(value, motion, solver.along_parameter(motion, sign))
            except FAILURES as failure:
                missed[value] = str(failure)
                continue
            self._follow(begun)
        for value, motion in starts:
            ahead, back = (
                solver.fine(value, motion, solver.along_parameter(motion, sign))
                for sign in (1.0, -1.0)
            )
            self._follow(ahead, back)
        if not self.branches:
            fix = "choose another range: begin where the motion is small"
            found = f"no periodic motion at either end ({missed[limits.high]})"
            raise bad("bounds", found, "one", fix)
        while self.queue and len(self.branches) < _BRANCHES:
            self._follow(self.queue.pop(0))
        return tuple(missed)

    def _known(self, value: float, motion: Motion) -> bool:
        return any(_on(self.solver, value, motion, branch) for branch in self.branches)

    def _follow(
        self, begun: tuple[Orbit, Measure], back: tuple[Orbit, Measure] | None = None
    ) -> None:
        """Follow a branch unless it is known; ``back``: from the same motion the other way, too."""
        first, _ = begun
        if self._known(first.value, first.motion):
            return
        branch = followed(self.solver, begun, self.limits)
        if back is not None and branch.ended != CLOSED:
            branch = followed(self.solver, back, self.limits).joined(branch)
        self.branches.append(branch)
        self.tick(len(self.branches))
        for point in branch.special:
            with suppress(*FAILURES):
                if point.kind == "doubling" and 2 * branch.turns <= self.turns:
                    self.queue.append(doubled(self.solver, point.orbit))
                elif point.kind == "branch point":
                    ways = [crossing(self.solver, point.orbit, sign) for sign in (1.0, -1.0)]
                    self.queue.extend(ways)


def _begun(solver: Solver, value: float) -> Motion:
    """Return the motion that is found from rest: by Newton's iteration, or after some turns."""
    try:
        return solver.settled(value, first_motion(solver.problem))
    except FAILURES:
        return solver.settled(value, from_rest(Marcher(solver.problem, solver.rtol), value))


def _on(solver: Solver, value: float, motion: Motion, branch: Branch) -> bool:
    """Return True for a motion that lies on a branch, from whatever turn it is counted."""
    if branch.turns != motion.turns:
        return False
    values = [point.value for point, _ in branch.points]
    for end, before in ((values[-1], values[-2]), (values[0], values[1])):
        if JOINED in branch.ended and abs(value - end) <= 2.0 * abs(end - before):
            return True
    slack = 1e-9 * solver.span  # ends of the range are met but for rounding
    for (one, _), (other, _) in pairwise(branch.points):
        low, high = sorted((one.value, other.value))
        if not low - slack <= value <= high + slack:
            continue
        near = min(one, other, key=lambda point: abs(point.value - value))
        try:
            settled = solver.settled(value, near.motion)
        except FAILURES:
            continue
        if same_motion(solver, settled, motion):
            return True
    return False


def same_motion(solver: Solver, one: Motion, other: Motion) -> bool:
    """Return True for one motion, from whatever turn it is counted."""
    if one.turns != other.turns:
        return False
    angles = 2.0 * np.pi * one.turns * np.arange(64) / 64
    place = float(solver.scale(one)[0])
    here = one.at(angles)[0]
    for turn in range(one.turns):
        shifted = (angles + 2.0 * np.pi * turn) % (2.0 * np.pi * one.turns)
        if float(np.max(np.abs(other.at(shifted)[0] - here))) < _SAME * place:
            return True
    return False


def extremes(problem: Problem, orbit: Orbit) -> tuple[float, float]:
    """Return the extremes of the deflection over the period."""
    low, high = _all_extremes(problem, [orbit]).tolist()[0]
    return low, high


def _all_extremes(problem: Problem, orbits: Sequence[Orbit]) -> Array:
    """Return the extremes of the deflection over the period of each motion, ``(k, 2)``."""

    def alike(orbit: Orbit) -> object:
        motion = orbit.motion
        return motion.turns, motion.a.shape, None if problem.name == "speed" else orbit.value

    found = [np.empty((0, 2))]
    for _, group in groupby(orbits, alike):
        some = list(group)
        together = Motion.together([orbit.motion for orbit in some])
        _, parameters = problem.at(some[0].value)

        def deflection(
            row: NDArray[np.int64],
            angle: Array,
            together: Motion = together,
            parameters: Mapping[str, float] = parameters,
        ) -> Array:
            q = together.at(np.mod(angle, together.span), row)[0]
            return problem.system.shown(q, parameters)

        values = problem.system.shown(together.stages()[0], parameters).reshape(len(some), -1)
        angles = some[0].motion.angles.ravel() - together.begin
        width = together.step / together.a.shape[1]
        found.append(tops(deflection, angles, np.pad(values, ((0, 0), (1, 1)), "wrap"), width))
    return np.concatenate(found)


def tops(
    deflection: Callable[[NDArray[np.int64], Array], Array],
    angles: Array,
    values: Array,
    width: float,
    ends: tuple[float, float] = (-np.inf, np.inf),
) -> Array:
    """Return lowest and highest of deflections between ends, ``(r, 2)``.

    From samples of each at the same angles, and one more at either side, ``(r, k + 2)``.  Every
    lowest and highest among its neighbours is polished by ever narrower parabolas, for the largest
    sample need not be next to the highest top.  ``deflection``: of some rows, at angles.
    """
    signed = np.array([[[-1.0]], [[1.0]]]) * values
    inner = signed[..., 1:-1]
    which, rows, samples = np.nonzero((inner >= signed[..., :-2]) & (inner >= signed[..., 2:]))
    places, signs = angles[samples], 2.0 * which - 1.0
    widths, thrice = np.full(places.shape, width), np.repeat(rows, 3)
    # Parabolas about the highest sample, each a tenth as wide where it holds the top.
    for _ in range(5):
        around = places[:, None] + np.multiply.outer(widths, [-1.0, 0.0, 1.0])
        near = deflection(thrice, around.ravel()).reshape(-1, 3)
        left, middle, right = (signs[:, None] * near).T
        bend = left - 2.0 * middle + right
        shift = np.divide(left - right, 2.0 * bend, out=np.zeros_like(bend), where=bend < 0.0)
        least, most = ((end - places) / widths for end in ends)
        shift = np.clip(shift, np.maximum(least, -1.0), np.minimum(most, 1.0))
        places = places + shift * widths
        # One that may lie beyond is looked for as widely again.
        widths = np.where(np.abs(shift) < 1.0, 0.1 * widths, widths)
    # Of the last parabolas.
    last = middle - 0.5 * (left - right) * shift + 0.5 * bend * shift**2
    found = np.full((2, len(values)), -np.inf)
    np.maximum.at(found, (which, rows), last)
    return np.stack([-found[0], found[1]], axis=-1)


def _result(
    solver: Solver, branches: list[Branch], bounds: tuple[float, float], missed: tuple[float, ...]
) -> ResponseCurve:
    problem = solver.problem
    points = [point for branch in branches for point in branch.points]
    counts = [len(branch.points) for branch in branches]
    special = [point for branch in branches for point in branch.special]
    shown = _all_extremes(problem, [orbit for orbit, _ in points])
    at_special = _all_extremes(problem, [point.orbit for point in special])
    error = np.array([measure.error for _, measure in points])
    peak_error = [measure.peak_error for _, measure in points]
    linearised = DeferredGroup(partial(_linear, problem, bounds))
    return ResponseCurve(
        method="Gauss collocation with 12 stages, pseudo-arclength continuation",
        error=error,
        error_norm="distance from the branch, relative to the largest coordinate or rate",
        checks={"accuracy": Check(float(np.max(error)), solver.rtol)},
        provenance=provenance(problem.system.provenance),
        parameter=problem.name,
        value=np.array([orbit.value for orbit, _ in points]),
        branch=np.repeat(np.arange(len(branches)), counts),
        turns=np.array([orbit.motion.turns for orbit, _ in points]),
        lowest=shown[:, 0],
        highest=shown[:, 1],
        multipliers=np.array([orbit.multipliers for orbit, _ in points]),
        multiplier_error=np.array([measure.multiplier_errors for _, measure in points]),
        peak_error=np.array(peak_error),
        special=tuple(point.kind for point in special),
        special_value=np.array([point.orbit.value for point in special]),
        special_error=np.array([point.value_error for point in special]),
        special_branch=np.repeat(
            np.arange(len(branches)), [len(branch.special) for branch in branches]
        ),
        special_lowest=at_special[:, 0],
        special_highest=at_special[:, 1],
        ended=tuple(branch.ended for branch in branches),
        bounds=bounds,
        missed=missed,
        unit=problem.system.unit,
        orbits=tuple(orbit for orbit, _ in points),
        special_orbits=tuple(point.orbit for point in special),
        source=solver,
        **linearised.fields(_LINEARISED),
    )


def _linear(problem: Problem, bounds: tuple[float, float]) -> dict[str, Array]:
    """Return values and extremes of the motion by the equations linearised about no deflection."""
    values = np.linspace(*bounds, _LINEAR)
    rest = first_motion(problem)
    low, high = np.full((2, _LINEAR), np.nan)
    angles = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    for i, value in enumerate(values.tolist()):
        motion = linear_motion(problem, value, rest)
        shown = problem.system.shown(motion.at(angles)[0], problem.at(value)[1])
        low[i], high[i] = np.min(shown), np.max(shown)
    return dict(zip(_LINEARISED, (values, low, high), strict=True))


def linear_motion(problem: Problem, value: float, rest: Motion) -> Motion:
    """Return the periodic motion of the equations linearised about no deflection."""
    swept = sweep(problem, value, rest)
    return taken(rest, swept, closed(swept), 0.0)
