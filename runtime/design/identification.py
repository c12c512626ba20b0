"""Numbers of a machine from measured points, by least squares, and what the points cannot tell."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning, Problem, bad, refuse
from ..core.families import Array, LinearPeriodic, Nonlinear
from ..core.inputs import names_in_a_row, require_between, require_kind
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..frequencies import critical_speeds
from ..frequencies.response_maxima import response_maxima
from ..periodic import steady_state
from ..scenes.validation import nearest as nearest_name
from ..stability import stability_edges
from .measured import Computed, Point, checked_points, nearest

if TYPE_CHECKING:
    from .measured_branches import BranchRun

Machine: TypeAlias = "LinearPeriodic | Nonlinear"

_MOST, _WHOLE = 40, 3.5  # looks of a fit, and how far the logarithms may move
# Standard error, relative, beyond which a number is not decided; the part of the largest effect
# below which a combination of numbers has none, by what the differences tell apart; by how many
# logarithms that may be wrong; and deviation, relative, that is assumed where no point is to spare.
_UNSURE, _NO_EFFECT, _WIDEST, _ASSUMED = 0.5, 1e-6, 50.0, 0.01


@dataclass(frozen=True, kw_only=True)
class Identification(Result):
    """Numbers that were fitted to measured points.

    ``error`` is that of each number by the computation alone, relative.

    Attributes
    ----------
    unknown : tuple of str
        Names of the n numbers.
    value, start : ndarray, shape (n,)
        Their values that fit best, and those before [SI].
    deviation : ndarray, shape (n,)
        Standard errors [SI]; inf where the points do not decide.
    decided : ndarray of bool, shape (n,)
        Whether the points decide each: within 50 %.
    undecided : tuple of str
        What the points leave open, in words.
    points : tuple of Point
        The k measured points.
    kind : tuple of str
        Their kinds.
    speed : ndarray, shape (k,)
        Their speeds [rad/s].
    measured, computed : ndarray, shape (k,)
        What was measured and what is computed with the values [rad/s; m for deflections].
    residual : ndarray, shape (k,)
        Measured less computed, over the standard deviation of the measurement; NaN where that is
        not known.
    without : ndarray, shape (k, n)
        The values without each point, to first order [SI]; NaN where that moves one by half.
    scatter : float
        Root of the mean square of the residuals, over the k - n that are free; NaN if none is.
    """

    unknown: tuple[str, ...]
    value: Array
    start: Array
    deviation: Array
    decided: NDArray[np.bool_]
    undecided: tuple[str, ...]
    points: tuple[Point, ...] = field(repr=False)
    kind: tuple[str, ...]
    speed: Array
    measured: Array
    computed: Array
    residual: Array
    without: Array
    scatter: float

    arrays_along: ClassVar = {
        "unknown": "error value start deviation decided",
        "point": "speed measured computed residual",
        "point unknown": "without",
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the residuals over the speed, in standard deviations."""
        ax = axes_or_new(ax)
        for kind in dict.fromkeys(point.kind for point in self.points):
            at = [i for i, point in enumerate(self.points) if point.kind == kind]
            speeds = [self.points[i].speed * RPM for i in at]
            ax.plot(speeds, self.residual[at], "o", label=kind)
        ax.axhline(0.0, color="0.3", linewidth=0.8)
        ax.set(xlabel="crank speed [rpm]", ylabel="measured less computed [standard deviations]")
        ax.legend(frameon=False)
        return ax


def identify(
    system: Machine, points: Sequence[Point], unknown: Sequence[str], *, window: float = 0.15
) -> Identification:
    """Fit numbers of a machine to measured points by least squares.

    Speeds of resonance are maxima of the steady deflection (:func:`critical_speeds`, ``response``),
    ends of unstable regions those of :func:`stability_edges`, deflections those of
    :func:`steady_state`.  By a nonlinear equation, jumps are folds of :func:`response_curve` at
    which a stable motion of one revolution ends, ends of unstable ranges its doublings.  To begin
    with each point is paired with the computed one of its kind that is nearest; then that is
    followed, by its modes and order or along with the numbers.  The logarithms of the numbers are
    fitted, so that they stay positive.

    Parameters
    ----------
    system : LinearPeriodic or Nonlinear
        With values to start from; forced and damped where resonances or deflections are measured.
    points : sequence of Point
        Measured points, for example of :func:`read_points`.  Standard deviations are those that
        the points tell; if none tells one, all have the same, relative, which the residuals tell.
        Where there are no more points than numbers nothing tells it: then 1 % decides what is
        decided, and standard errors are NaN.
    unknown : sequence of str
        Names of ``system.parameters``, of values above 0.
    window : float
        Part of a measured speed within which the computed one is looked for.

    Returns
    -------
    Identification
        Its checks: ``converged``, the last step over the standard error or 1e-6 of the numbers;
        ``fit``, the scatter against 3 where the points tell their deviations; and those of what is
        computed with the values.

    Raises
    ------
    BadInput
        If an argument is unusable, or to begin with a point has no computed one within its window,
        or two that are about as near.

    Warns
    -----
    LinearRangeWarning
        If a deflection passes 5 % of the length with the values.

    Examples
    --------
    >>> import elastolink as el
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping_ratio": 0.02})
    >>> points = [el.design.Point("deflection", 30.0, deflection=0.0026)]
    >>> found = el.design.identify(scene.system(), points, ["bending_stiffness"])
    >>> print(found.value.round(4), found.start.round(4))
    [0.504] [0.4922]
    """
    fix = "take the .system() of a scene of one flexible link or of beams"
    require_kind("system", system, (LinearPeriodic, Nonlinear), fix)
    measured = checked_points(points)
    names = _checked_names(system, unknown)
    require_between("window", window, 1e-3, 0.9, "try 0.15")
    linear = system if isinstance(system, LinearPeriodic) else None
    shown = linear and (linear.shape or linear.moving_shape)
    if shown is None and any(point.kind == "deflection" for point in measured):
        fix = "fit speeds alone"
        raise bad("points", "deflections", "a system of one flexible link, by its shapes", fix)
    told = [point.deviation is not None for point in measured]
    if any(told) and not all(told):
        found = f"{sum(told)} of {len(told)} deviations"
        raise bad("points", found, "one for each point, or none", "complete them")
    values = np.array([point.measured for point in measured])
    deviations = np.array([point.deviation or point.measured for point in measured])
    start = np.array([float(system.parameters[name]) for name in names])
    machines = Machines(system, names, measured, window)

    def residuals(logarithms: Array) -> Array:
        found = machines(start * np.exp(logarithms)).values
        return np.asarray((values - found) / deviations)

    residuals(np.zeros(len(names)))  # what has no counterpart is refused
    # What is computed for a structure of beams is good to 1e-6, else to 1e-9.
    beams = linear is not None and linear.structure is not None
    fit = _Fit(residuals, 3e-3 if beams else 1e-4, all(told))
    speeds = np.array([point.kind != "deflection" for point in measured])
    fitted = np.zeros(len(names))
    # A deflection beside a resonance tells the way only where that all but stands at its place.
    for used in (speeds, np.ones_like(speeds)):
        if np.any(used):
            fitted = fit.least(fitted, np.eye(len(names)), used)
    fitted, residual, spread = fit.settled(fitted)
    best = start * np.exp(fitted)
    computed = machines(best, quiet=False)
    last = -spread.inverse @ (spread.jacobian.T @ residual)
    off = np.abs(spread.inverse @ spread.jacobian.T) @ (computed.errors / deviations)
    scatter = _scatter(residual, len(names))
    checks = {
        **computed.checks,
        "converged": Check(float(np.max(np.abs(last) / spread.tolerance, initial=0.0)), 0.1),
    }
    if all(told) and np.isfinite(scatter):
        checks["fit"] = Check(scatter, 3.0)
    error = 2.0 * np.abs(last) + off
    deviation = np.where(spread.decided, np.maximum(spread.deviation, error), np.inf)
    shifts = spread.without_each(residual)
    return Identification(
        method="least squares of the logarithms, by differences",
        error=error,
        error_norm="of each number by the computation, relative",
        checks=checks,
        provenance=provenance(system.provenance),
        unknown=names,
        value=best,
        start=start,
        deviation=best * deviation,
        decided=spread.decided,
        undecided=spread.words(names),
        points=measured,
        kind=tuple(point.kind for point in measured),
        speed=np.array([point.speed for point in measured]),
        measured=values,
        computed=computed.values,
        residual=residual / (1.0 if all(told) else scatter if scatter > 0.0 else np.nan),
        without=np.where(np.abs(shifts) <= _UNSURE, best * np.exp(shifts), np.nan),
        scatter=scatter,
    )


def _scatter(residual: Array, unknown: int) -> float:
    """Return the standard deviation that residuals tell, NaN where none is left to tell."""
    free = len(residual) - unknown
    return float(np.sqrt(np.sum(residual**2) / free)) if free > 0 else np.nan


@dataclass(frozen=True)
class _Fit:
    """Least squares of residuals, NaN where there is nothing to compare, by logarithms."""

    residuals: Callable[[Array], Array]
    step: float  # of the differences
    told: bool  # whether residuals have deviation 1

    def least(self, place: Array, ways: Array, used: NDArray[np.bool_]) -> Array:
        """Return the place of the least sum of squares of some residuals, along ways ``(n, m)``.

        A step that loses a point is none.
        """
        from scipy.optimize import least_squares

        def some(shift: Array) -> Array:
            return self.residuals(place + ways @ shift)[used]

        def slopes(shift: Array) -> Array:
            """Return forward differences, backward ones where a point is lost."""
            here, columns = some(shift), []
            for step in self.step * np.eye(len(shift)):
                change = some(shift + step) - here
                change = change if np.all(np.isfinite(change)) else here - some(shift - step)
                columns.append(np.where(np.isfinite(change), change, 0.0) / self.step)
            return np.stack(columns, axis=-1)

        start = np.zeros(ways.shape[1])
        ends = {"ftol": None, "xtol": 1e-7, "gtol": 1e-10, "max_nfev": _MOST}
        found = least_squares(some, start, slopes, (-_WHOLE, _WHOLE), x_scale=0.3, **ends)
        return np.asarray(place + ways @ found.x)

    def settled(self, place: Array) -> tuple[Array, Array, _Spread]:
        """Return the place at which what is not decided is as at first, with residuals and spread.

        That is where the fit may not tell it from the best one.
        """
        n, here = len(place), self.residuals(place)
        spread = self._spread(place, here)
        if not spread.known:
            # No point is to spare: what was open at first has been moved to meet them at any cost.
            first = self._spread(0.0 * place, self.residuals(0.0 * place))
            spread = first if np.any(first.open) else spread
        if np.any(spread.open):
            kept = spread.directions[:, ~spread.open]
            back = kept @ (kept.T @ place)
            if np.all(np.isfinite(self.residuals(back))):
                back = self.least(back, kept, np.ones(len(here), bool)) if kept.size else back
                there = self.residuals(back)
                worse = float(np.sum(there**2) - np.sum(here**2))
                if not spread.known or worse <= 4.0 * n * spread.noise**2 + 1e-12:
                    return back, there, self._spread(back, there)
        return place, here, spread

    def _spread(self, place: Array, here: Array) -> _Spread:
        ways = np.eye(len(place))
        columns = [self._slope(self.residuals, place, here, way) for way in ways]
        scatter = 1.0 if self.told else _scatter(here, len(place))
        known = bool(np.isfinite(scatter))
        return _Spread(np.stack(columns, axis=-1), scatter if known else _ASSUMED, known)

    def _slope(
        self, some: Callable[[Array], Array], place: Array, here: Array, way: Array
    ) -> Array:
        """Return differences to both sides, to one where a point is lost."""
        sides = [some(place + side * self.step * way) for side in (1.0, -1.0)]
        known = [np.isfinite(side) for side in sides]
        ahead, behind = (np.where(k, side, here) for k, side in zip(known, sides, strict=True))
        width = self.step * np.maximum(np.sum(known, axis=0), 1)
        return np.asarray((ahead - behind) / width)


def _checked_names(system: Machine, unknown: Sequence[str]) -> tuple[str, ...]:
    names = names_in_a_row("unknown", unknown)
    problems = []
    if not names:
        problems.append(
            Problem("unknown", "nothing", "at least one parameter", "give --unknown NAME")
        )
    if len(set(names)) < len(names):
        problems.append(Problem("unknown", repr(names), "different names", "name each once"))
    for name in names:
        value = system.parameters.get(name)
        if value is None:
            known = f"one of {sorted(system.parameters)}"
            # A key of the scene, coupler.bending_stiffness, is meant by its last part.
            last = name.rpartition(".")[2]
            word = last if last in system.parameters else name.replace(".", "_")
            fix = nearest_name(word, sorted(system.parameters), "correct the name")
            problems.append(Problem("unknown", repr(name), known, fix))
        elif not (np.ndim(value) == 0 and value > 0.0):
            fix = "set a value to start from"
            problems.append(Problem(name, f"{value!r}", "a number above 0 to start from", fix))
    refuse(problems)
    return names


class _Spread:
    """How well the logarithms of numbers are known, by the singular values of their effect.

    Of the derivatives ``(k, n)`` of residuals of standard deviation ``noise``, which is ``known``
    or assumed.
    """

    def __init__(self, jacobian: Array, noise: float, known: bool) -> None:
        n = jacobian.shape[1]
        self.jacobian, self.noise, self.known = jacobian, noise, known
        _, effects, rows = np.linalg.svd(np.vstack([jacobian, np.zeros((n, n))]))
        tells = effects > _NO_EFFECT * max(float(effects[0]), np.finfo(float).tiny)
        # Combinations of the numbers as columns, and what each does to all residuals.
        self.directions, self._effects = rows.T, np.where(tells, effects, 0.0)
        width = np.full(n, _WIDEST)
        np.divide(noise, self._effects, out=width, where=tells)
        self._width = np.minimum(width, _WIDEST)

    @property
    def _shares(self) -> Array:
        """Standard errors of the numbers by each combination, ``(n, n)``."""
        return np.asarray(np.abs(self.directions) * self._width)

    @property
    def open(self) -> NDArray[np.bool_]:
        """Which combinations leave a number undecided."""
        return np.asarray(np.any(self._shares > _UNSURE, axis=0))

    @property
    def decided(self) -> NDArray[np.bool_]:
        """Which numbers are decided."""
        return np.asarray(~np.any(self._shares > _UNSURE, axis=1))

    @property
    def deviation(self) -> Array:
        """Standard errors of the logarithms; NaN where no point is to spare."""
        found = np.linalg.norm(self._shares, axis=1)
        return np.asarray(found if self.known else np.full(len(found), np.nan))

    @property
    def tolerance(self) -> Array:
        """What a step of each logarithm is measured by."""
        known = np.where(np.isfinite(self.deviation), self.deviation, 0.0)
        return np.asarray(np.maximum(known, 1e-6))

    @property
    def inverse(self) -> Array:
        """Covariance of the logarithms over the variance of the residuals, decided ones alone."""
        gains = np.zeros(len(self._effects))
        np.divide(1.0, self._effects, out=gains, where=(self._effects > 0.0) & ~self.open)
        return np.asarray((self.directions * gains**2) @ self.directions.T)

    def without_each(self, residuals: Array) -> Array:
        """Return by how much the logarithms move if one point is left out, ``(k, n)``."""
        gain = self.jacobian @ self.inverse
        held = np.sum(gain * self.jacobian, axis=1)
        alone = held > 1.0 - 1e-6
        weight = np.divide(residuals, 1.0 - held, out=np.full(len(held), np.nan), where=~alone)
        return np.asarray(gain * weight[:, None])

    def words(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return what is left open, in words."""
        told = []
        for k in np.flatnonzero(self.open).tolist():
            direction, shares = self.directions[:, k], self._shares[:, k]
            most = int(np.argmax(shares))
            parts = direction / direction[most]
            others = [i for i in range(len(names)) if i != most and shares[i] > _UNSURE]
            if not others:
                told.append(f"{names[most]} is not decided: the points hardly depend on it")
                continue
            along = " and ".join(f"{names[i]} by {parts[i]:+.2g} %" for i in others)
            told.append(
                f"{', '.join(names[i] for i in (most, *others))} are not decided: the points "
                f"hardly change if {names[most]} changes by +1 % and {along}"
            )
        return tuple(told)


# Parts of a speed beside the expected one within which a resonance is looked for, one after the
# other, as a small one stands out between narrow ends alone; how many are looked at; and error of a
# speed, relative, beyond which there is none.
_NEAR, _EXPECTED, _BLUNT = (0.003, 0.001, 0.0003), 6, 1e-3


class Machines:
    """Measured points computed with other numbers, each on the machine as it was run.

    The first call pairs each point with the nearest computed one and refuses those without one, or
    with two that are about as near; then resonance or region are followed by modes and order.
    """

    def __init__(
        self, system: Machine, names: tuple[str, ...], points: Sequence[Point], window: float
    ) -> None:
        runs: dict[tuple[tuple[str, float], ...], list[int]] = {}
        for i, point in enumerate(points):
            runs.setdefault(tuple(sorted(point.given.items())), []).append(i)
        self.names, self.size = names, len(points)
        self._runs: list[_Run | BranchRun] = []
        for given, at in runs.items():
            wrong = [name for name, _ in given if name in names or name not in system.parameters]
            if wrong:
                known = sorted(set(system.parameters) - set(names))
                expected = f"one of {known}: known or unknown, not both"
                raise bad(f"point {at[0] + 1}", repr(wrong[0]), expected, "correct the column")
            own = system.with_parameters(**dict(given)) if given else system
            numbered = [(i, points[i]) for i in at]
            if isinstance(own, LinearPeriodic):
                self._runs.append(_Run(own, numbered, window))
                continue
            # What stays in the linear range imports nothing of this.
            from .measured_branches import BranchRun

            self._runs.append(BranchRun(own, numbered, window))

    def __call__(self, values: Array, quiet: bool = True) -> Computed:
        """Return what is computed with values of the named parameters."""
        numbers = dict(zip(self.names, values.tolist(), strict=True))
        found = Computed(np.full(self.size, np.nan), np.full(self.size, np.nan))
        with warnings.catch_warnings():
            if quiet:  # a fit passes values that are not those of the machine
                warnings.simplefilter("ignore", LinearRangeWarning)
            for run in self._runs:
                run.fill(found, numbers)
        return found


class _Run:
    """The points that were measured on one machine."""

    def __init__(
        self, system: LinearPeriodic, points: list[tuple[int, Point]], window: float
    ) -> None:
        self.system, self.points, self.window = system, points, window
        for i, point in points:
            if point.kind.startswith("jump"):
                expected = "no jump of a linear machine"
                fix = "take the scene with model.formulation 'inextensible'"
                raise bad(f"point {i + 1}", point.kind, expected, fix)
        # By point: mode and ratio of a resonance, the name of a region.
        self._paired: dict[int, Any] = {}

    def fill(self, found: Computed, numbers: Mapping[str, float]) -> None:
        """Fill in what is computed with other numbers."""
        system = self.system.with_parameters(**numbers)
        if at := self._of("unstable from", "unstable to"):
            self._ends(system, at, found)
        if at := self._of("resonance"):
            self._resonances(system, at, found)
        if at := self._of("deflection"):
            state = steady_state(system, [point.speed for _, point in at], rtol=1e-9)
            found.add(state.checks)
            for (i, _), q, error in zip(at, state.q, state.error, strict=True):
                largest = system.largest_deflection(state.theta, q[None]) or np.nan
                found.values[i] = largest * system.reference_length
                found.errors[i] = found.values[i] * float(np.max(error))

    def _of(self, *kinds: str) -> list[tuple[int, Point]]:
        return [(i, point) for i, point in self.points if point.kind in kinds]

    def _ends(self, system: LinearPeriodic, at: list[tuple[int, Point]], found: Computed) -> None:
        speeds = [point.speed for _, point in at]
        span = min(speeds) * (1.0 - self.window), max(speeds) * (1.0 + self.window)
        edges = stability_edges(system, span)
        found.add(edges.checks)
        for i, point in at:
            ends = edges.lower if point.kind == "unstable from" else edges.upper
            seen = np.flatnonzero(np.isfinite(ends) & (edges.lower != edges.upper)).tolist()
            if i not in self._paired:
                k = seen[nearest(i, point, ends[seen].tolist(), self.window)]
                self._paired[i] = edges.names[k]
            named = [k for k in seen if edges.names[k] == self._paired[i]]
            if named:
                k = named[int(np.argmin(np.abs(ends[named] - point.speed)))]
                found.values[i], found.errors[i] = ends[k], edges.error[k]

    def _resonances(
        self, system: LinearPeriodic, at: list[tuple[int, Point]], found: Computed
    ) -> None:
        for i, point in at:
            if i not in self._paired:
                self._paired[i] = self._first(system, i, point)
        modes = np.array([self._paired[i][0] for i, _ in at])
        speeds = np.array([point.speed for _, point in at])
        span = 0.5 * float(np.min(speeds)), 2.0 * float(np.max(speeds))
        means = critical_speeds(system, span, modes=int(np.max(modes))).mean_frequency
        expected = np.array([self._paired[i][1] for i, _ in at]) * means[modes - 1]
        places, errors = _maxima(system, expected)
        for (i, _), place, error in zip(at, places, errors, strict=True):
            found.values[i], found.errors[i] = place, error

    def _first(self, system: LinearPeriodic, i: int, point: Point) -> tuple[int, float]:
        """Return the mode of the nearest resonance, and its speed over the mode's frequency."""
        span = point.speed * (1.0 - self.window), point.speed * (1.0 + self.window)
        # Narrow ones are found beside the fractions of the frequencies, others by a scan.
        near = critical_speeds(system, span)
        order = np.argsort(np.abs(near.speed - point.speed), kind="stable")[:_EXPECTED]
        places, _ = _maxima(system, near.speed[order])
        scanned = critical_speeds(system, span, method="response")
        rows = [*zip(places.tolist(), near.mode[order].tolist(), strict=True)]
        rows += [*zip(scanned.speed.tolist(), scanned.mode.tolist(), strict=True)]
        rows = [row for row in rows if np.isfinite(row[0])]
        place, mode = rows[nearest(i, point, [place for place, _ in rows], self.window)]
        return mode, place / float(near.mean_frequency[mode - 1])


def _maxima(system: LinearPeriodic, expected: Array) -> tuple[Array, Array]:
    """Return resonances beside expected speeds and their errors, NaN where there is none."""
    if not len(expected):
        return expected, expected
    places, errors = np.full((2, len(expected)), np.nan)
    for near in _NEAR:
        left = np.flatnonzero(np.isnan(places))
        if not left.size:
            break
        middle = expected[left]
        found, _, off = response_maxima(system, middle * (1.0 - near), middle * (1.0 + near))
        beside = np.abs(found - middle) <= 10.0 * near * middle
        sharp = (off <= _BLUNT * found) & beside
        places[left[sharp]], errors[left[sharp]] = found[sharp], off[sharp]
    return places, errors
