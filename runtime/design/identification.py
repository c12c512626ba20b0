"""Numbers of a machine from measured points, by least squares, and what the points cannot tell."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning, Problem, bad, refuse
from ..core.families import Array, LinearPeriodic
from ..core.inputs import names_in_a_row, require_between, require_kind
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result
from ..frequencies import critical_speeds
from ..frequencies.response_maxima import response_maxima
from ..periodic import steady_state
from ..stability import stability_edges
from .measured import Point, checked_points

# Step of the differences, in logarithms of the numbers, as what is computed is good to 1e-9; and
# part of a speed beside the expected one within which a resonance is looked for.
_STEP, _NEAR = 1e-4, 0.003
# Steps of a fit; the longest one, the one after which derivatives are kept, and the last one.
_MOST, _LONGEST, _KEPT, _SHORTEST = 20, 0.5, 0.01, 1e-6
# Standard error, relative, beyond which a number is not decided; the part of the largest effect
# below which a combination of numbers has none, by what the differences tell apart; and by how many
# logarithms that may be wrong.
_UNSURE, _NO_EFFECT, _WIDEST = 0.5, 1e-6, 50.0


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
    measured, computed : ndarray, shape (k,)
        What was measured and what is computed with the values [rad/s; m for deflections].
    residual : ndarray, shape (k,)
        Measured less computed, over the standard deviation of the measurement.
    without : ndarray, shape (k, n)
        The values without each point, to first order [SI]; NaN where it alone decides one.
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
    measured: Array
    computed: Array
    residual: Array
    without: Array
    scatter: float

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("error", "value", "start", "deviation", "decided"), ("unknown",)),
        **dict.fromkeys(("measured", "computed", "residual"), ("point",)),
        "without": ("point", "unknown"),
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
    system: LinearPeriodic,
    points: Sequence[Point],
    unknown: Sequence[str],
    *,
    window: float = 0.15,
) -> Identification:
    """Fit numbers of a machine to measured points by least squares.

    Speeds of resonance are maxima of the steady deflection (:func:`critical_speeds`, ``response``),
    ends of unstable regions those of :func:`stability_edges`, deflections those of
    :func:`steady_state`.  Each point is compared with the computed one of its kind that is nearest.
    The logarithms of the numbers are fitted, so that they stay positive.

    Parameters
    ----------
    system : LinearPeriodic
        With values to start from; forced and damped where resonances or deflections are measured.
    points : sequence of Point
        Measured points, for example of :func:`read_points`.  Standard deviations are those that
        the points tell; if none tells one, all have the same, relative, which the residuals tell.
    unknown : sequence of str
        Names of ``system.parameters``, of values above 0.
    window : float
        Part of a measured speed within which the computed one is looked for.

    Returns
    -------
    Identification
        Its checks: ``converged``, the last step over the standard error or 1e-6 of the numbers;
        ``fit``, the scatter against 3 where the points tell their deviations.

    Raises
    ------
    BadInput
        If an argument is unusable, or a point has no computed one within its window to begin with.
    """
    require_kind("system", system, LinearPeriodic, "take the .system() of a linear scene")
    measured = checked_points(points)
    names = _checked_names(system, unknown)
    require_between("window", window, 1e-3, 0.9, "try 0.15")
    shown = system.shape or system.moving_shape
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
    computing = _Computings(system, names, measured, window)
    _require_all(computing(start), measured, window)

    def residuals(logarithms: Array) -> Array:
        off = (values - computing(start * np.exp(logarithms))) / deviations
        return np.where(np.isfinite(off), off, 1e3)  # as far off as no point is

    speeds = np.array([point.kind != "deflection" for point in measured])
    fitted = np.zeros(len(names))
    # A deflection beside a resonance tells the way only where that all but stands at its place.
    for used in (speeds, np.ones_like(speeds)):
        if np.any(used):
            fitted = _fitted(residuals, used, fitted, all(told))
    residual = residuals(fitted)
    jacobian = _derivative(residuals, fitted)
    scatter = _scatter(residual, len(names))
    noise = 1.0 if all(told) else scatter
    spread = _Spread.of(jacobian, noise)
    last = _last_step(jacobian, residual, spread)
    best = start * np.exp(fitted)
    shifts = spread.without_each(jacobian, residual)
    checks = {"converged": Check(float(np.max(np.abs(last) / spread.tolerance, initial=0.0)), 0.1)}
    if all(told) and np.isfinite(scatter):
        checks["fit"] = Check(scatter, 3.0)
    return Identification(
        method="least squares of the logarithms, by differences",
        error=np.abs(last) + _STEP**2,
        error_norm="of each number by the computation, relative",
        checks=checks,
        provenance=dict(system.provenance),
        unknown=names,
        value=best,
        start=start,
        deviation=best * np.where(spread.decided, spread.deviation, np.inf),
        decided=spread.decided,
        undecided=spread.words(names),
        points=measured,
        measured=values,
        computed=values - residual * deviations,
        residual=residual / (scatter if scatter > 0.0 and not all(told) else 1.0),
        without=best * np.exp(shifts),
        scatter=scatter,
    )


def _fitted(
    residuals: Callable[[Array], Array], used: NDArray[np.bool_], place: Array, told: bool
) -> Array:
    """Return the place of the least sum of squares of some residuals, by Gauss-Newton's iteration.

    It leaves what the points do not decide where it is.
    """

    def some(place: Array) -> Array:
        return residuals(place)[used]

    here, moved = some(place), np.inf
    for _ in range(_MOST):
        if moved > _KEPT:
            steps = _STEP * np.eye(len(place))
            slopes = np.stack([(some(place + step) - here) / _STEP for step in steps], axis=-1)
        step = _last_step(slopes, here, _Spread.of(slopes, 1.0 if told else _scatter(here, 1)))
        step *= min(1.0, _LONGEST / max(float(np.max(np.abs(step))), 1e-300))
        ahead = some(place + step)
        while np.sum(ahead**2) > np.sum(here**2) and np.max(np.abs(step)) > _SHORTEST:
            step *= 0.25
            ahead = some(place + step)
        if not np.sum(ahead**2) <= np.sum(here**2):
            break
        place, here, moved = place + step, ahead, float(np.max(np.abs(step)))
        if moved <= _SHORTEST:
            break
    return place


def _scatter(residual: Array, unknown: int) -> float:
    """Return the standard deviation that residuals tell, NaN where none is left to tell."""
    free = len(residual) - unknown
    return float(np.sqrt(np.sum(residual**2) / free)) if free > 0 else np.nan


def _derivative(residuals: Callable[[Array], Array], place: Array) -> Array:
    """Return the derivative of the residuals by differences to both sides, ``(k, n)``."""
    steps = _STEP * np.eye(len(place))
    columns = [
        (residuals(place + step) - residuals(place - step)) / (2.0 * _STEP) for step in steps
    ]
    return np.stack(columns, axis=-1)


def _checked_names(system: LinearPeriodic, unknown: Sequence[str]) -> tuple[str, ...]:
    names = names_in_a_row("unknown", unknown)
    problems = []
    if not names or len(set(names)) < len(names):
        problems.append(Problem("unknown", repr(names), "different names, at least one", "mend it"))
    for name in names:
        value = system.parameters.get(name)
        if value is None:
            known = f"one of {sorted(system.parameters)}"
            problems.append(Problem("unknown", repr(name), known, "correct the name"))
        elif not (np.ndim(value) == 0 and value > 0.0):
            fix = "set a value to start from"
            problems.append(Problem(name, f"{value!r}", "a number above 0 to start from", fix))
    refuse(problems)
    return names


def _require_all(computed: Array, points: Iterable[Point], window: float) -> None:
    """Refuse points that have no computed one to begin with."""
    problems = []
    for i, (point, value) in enumerate(zip(points, computed.tolist(), strict=True), 1):
        if not np.isfinite(value):
            words = f"{point.kind} at {point.speed * RPM:.6g} rpm"
            expected = f"a computed one within {100 * window:g} % of the speed"
            fix = "start from other values, or widen the window"
            problems.append(Problem(f"point {i}", words, expected, fix))
    refuse(problems)


class _Computings:
    """What is computed at the measured points with other numbers, each on its own machine."""

    def __init__(
        self,
        system: LinearPeriodic,
        names: tuple[str, ...],
        points: tuple[Point, ...],
        window: float,
    ) -> None:
        machines: dict[tuple[tuple[str, float], ...], list[int]] = {}
        for i, point in enumerate(points):
            machines.setdefault(tuple(sorted(point.given.items())), []).append(i)
        self.size = len(points)
        self.parts = [
            (at, _Computing(_run_with(system, names, given, at[0]), names, some, window))
            for given, at in machines.items()
            for some in [tuple(points[i] for i in at)]
        ]

    def __call__(self, values: Array) -> Array:
        found = np.empty(self.size)
        for at, computing in self.parts:
            found[at] = computing(values)
        return found


def _run_with(
    system: LinearPeriodic, names: tuple[str, ...], given: tuple[tuple[str, float], ...], place: int
) -> LinearPeriodic:
    """Return the system with what the machine was run with, refused where that is not known."""
    wrong = [name for name, _ in given if name in names or name not in system.parameters]
    if wrong:
        known = f"one of {sorted(set(system.parameters) - set(names))}: known or unknown, not both"
        raise bad(f"point {place + 1}", repr(wrong[0]), known, "correct the column")
    return system.with_parameters(**dict(given)) if given else system


class _Computing:
    """What is computed at the measured points with other numbers; NaN where there is nothing."""

    def __init__(
        self,
        system: LinearPeriodic,
        names: tuple[str, ...],
        points: tuple[Point, ...],
        window: float,
    ) -> None:
        self.system, self.names, self.points, self.window = system, names, points, window
        # Of the resonances: mode, order, and their speed over the mode's mean frequency.
        self._followed: tuple[NDArray[np.int64], Array] | None = None

    def __call__(self, values: Array) -> Array:
        system = self.system.with_parameters(**dict(zip(self.names, values.tolist(), strict=True)))
        found = np.full(len(self.points), np.nan)
        with warnings.catch_warnings():
            # The fit passes values that are not those of the machine.
            warnings.simplefilter("ignore", LinearRangeWarning)
            if at := self._of("resonance"):
                found[at] = self._resonances(system, at)
            if at := self._of("unstable from", "unstable to"):
                edges = stability_edges(system, self._span(at))
                seen = edges.lower < edges.upper
                for kind, speeds in (("from", edges.lower[seen]), ("to", edges.upper[seen])):
                    own = self._of(f"unstable {kind}")
                    self._nearest(found, own, speeds, own)
            if at := self._of("deflection"):
                state = steady_state(system, [self.points[i].speed for i in at], rtol=1e-9)
                for i, q in zip(at, state.q, strict=True):
                    largest = system.largest_deflection(state.theta, q[None]) or np.nan
                    found[i] = largest * system.reference_length
        return found

    def _resonances(self, system: LinearPeriodic, at: list[int]) -> Array:
        """Return the resonances of the points; those that were found at first are followed."""
        span, speeds = self._span(at), np.full(len(at), np.nan)
        if self._followed is None:
            first = critical_speeds(system, span, method="response")
            self._nearest(speeds, at, first.speed, range(len(at)))
            if not np.all(np.isfinite(speeds)):
                return speeds
            modes = first.mode[[int(np.argmin(np.abs(first.speed - speed))) for speed in speeds]]
            self._followed = modes, speeds / first.mean_frequency[modes - 1]
            return speeds
        modes, ratios = self._followed
        means = critical_speeds(system, span, modes=int(np.max(modes))).mean_frequency
        expected = ratios * means[modes - 1]
        return response_maxima(system, expected * (1.0 - _NEAR), expected * (1.0 + _NEAR))[0]

    def _of(self, *kinds: str) -> list[int]:
        return [i for i, point in enumerate(self.points) if point.kind in kinds]

    def _span(self, at: list[int]) -> tuple[float, float]:
        speeds = [self.points[i].speed for i in at]
        return min(speeds) * (1.0 - self.window), max(speeds) * (1.0 + self.window)

    def _nearest(self, found: Array, at: list[int], speeds: Array, places: Iterable[int]) -> None:
        for place, i in zip(places, at, strict=True):
            off = np.abs(speeds - self.points[i].speed)
            if len(off) and np.min(off) <= self.window * self.points[i].speed:
                found[place] = speeds[np.argmin(off)]


@dataclass(frozen=True)
class _Spread:
    """How well the logarithms of numbers are known, by the singular values of their effect."""

    directions: Array  # (n, n): combinations of the numbers, as columns
    effects: Array  # (n,): what each does to all residuals; 0 where the points do not tell
    noise: float  # standard deviation of the residuals; NaN where it is not known

    @classmethod
    def of(cls, jacobian: Array, noise: float) -> _Spread:
        """Return it from the derivatives ``(k, n)`` of residuals."""
        n = jacobian.shape[1]
        _, effects, rows = np.linalg.svd(np.vstack([jacobian, np.zeros((n, n))]))
        tells = effects > _NO_EFFECT * max(float(effects[0]), np.finfo(float).tiny)
        return cls(rows.T, np.where(tells, effects, 0.0), noise)

    @property
    def width(self) -> Array:
        """Standard error along each combination, within bounds; none that is not known."""
        noise = self.noise if np.isfinite(self.noise) else 0.0
        found = np.full(len(self.effects), _WIDEST)
        np.divide(noise, self.effects, out=found, where=self.effects > 0.0)
        return np.asarray(np.minimum(found, _WIDEST))

    @property
    def open(self) -> NDArray[np.bool_]:
        """Which combinations the points do not decide."""
        return np.asarray(self.width > _UNSURE)

    @property
    def deviation(self) -> Array:
        """Standard errors of the logarithms; NaN where as many points as numbers tell none."""
        if not np.isfinite(self.noise):
            return np.full(len(self.effects), np.nan)
        return np.asarray(np.linalg.norm(self.directions * self.width, axis=1))

    @property
    def decided(self) -> NDArray[np.bool_]:
        """Which numbers they decide."""
        left = np.where(self.open, self.width, 0.0)
        return np.asarray(np.linalg.norm(self.directions * left, axis=1) <= _UNSURE)

    @property
    def tolerance(self) -> Array:
        """What a step of each logarithm is measured by."""
        known = np.where(np.isfinite(self.deviation), self.deviation, 0.0)
        return np.maximum(known, 1e-6)

    @property
    def inverse(self) -> Array:
        """Covariance of the logarithms over the variance of the residuals, decided ones alone."""
        gains = np.zeros(len(self.effects))
        np.divide(1.0, self.effects, out=gains, where=(self.effects > 0.0) & ~self.open)
        return np.asarray((self.directions * gains**2) @ self.directions.T)

    def without_each(self, jacobian: Array, residuals: Array) -> Array:
        """Return by how much the logarithms move if one point is left out, ``(k, n)``."""
        gain = jacobian @ self.inverse
        held = np.sum(gain * jacobian, axis=1)
        alone = held > 1.0 - 1e-6
        weight = np.divide(residuals, 1.0 - held, out=np.full(len(held), np.nan), where=~alone)
        return np.asarray(gain * weight[:, None])

    def words(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return what is left open, in words."""
        told, known = [], self.decided
        for direction in self.directions[:, self.open].T:
            most = int(np.argmax(np.abs(direction)))
            parts = direction / direction[most]
            others = [i for i in range(len(names)) if i != most and not known[i]]
            if not others:
                told.append(f"{names[most]} is not decided: the points hardly depend on it")
                continue
            along = " and ".join(f"{names[i]} by {parts[i]:+.2g} %" for i in others)
            told.append(
                f"{', '.join(names[i] for i in (most, *others))} are not decided: the points "
                f"hardly change if {names[most]} changes by +1 % and {along}"
            )
        return tuple(told)


def _last_step(jacobian: Array, residuals: Array, spread: _Spread) -> Array:
    """Return the step of the logarithms that Newton's iteration would still take, ``(n,)``."""
    return np.asarray(-spread.inverse @ (jacobian.T @ residuals))
