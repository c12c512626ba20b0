"""Principal and combination tongues of coupled modes by perturbation series, damped or not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import DAMPING, LinearPeriodic, Term
from ..core.inputs import numbers, require_whole
from ..core.results import Check, DeferredChecks, Result, provenance
from ..hill.bloch import BEYOND, HIGHEST
from ..periodic import floquet_multipliers
from ..periodic.equation import equation_of
from .ends import UNBOUNDED, Ends, Several, expected, two_exponents
from .meetings import MeanSystem, Resonance, conservative
from .operators import Point, ResonantOperator, constant_at, resonant_operator

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Factor on either side of a resonance within which its like at other parameter values is sought.
_NEAR = 3.0
# Distance of exponents that meet exactly, but for round-off.
_EXACT = 1e-10


@dataclass(frozen=True, kw_only=True)
class Tongue(Result):
    """An unstable range of speeds about a parametric resonance, over values of a parameter.

    Attributes
    ----------
    lower, upper : ndarray
        Ends of the range [rad/s], shape ``batch``.  Equal where the order is too low to open the
        range, or nothing opens it; not a number where damping closes it, or where it is lost in
        another range of the same exponents (the check ``told apart``); 0 and inf where the series
        shows no end to the instability.
    open : ndarray of bool
        True where the range is unstable and has a width.
    error : ndarray
        Estimate of the truncation, for either end [rad/s], shape ``batch``: how far the next two
        orders move it, and round-off.
    values : ndarray
        Values of the parameter, broadcast to ``batch``; zeros without one.
    damping_factor : ndarray
        Factor on the system's own damping, ``batch``.
    parameter : str
        Name of the parameter; empty without one.
    resonance : Resonance
        Which exponents meet.
    order : int
        Total degree in periodic part, detuning and damping.
    dimension : int
        Largest number of exponents taken together.
    expansion : str
        "parameter": one series in the parameter, about the system where it is zero and nothing is
        periodic; "periodic": for each value a series in all that is periodic, about the mean.
    operators : tuple of ResonantOperator
        The series themselves, one, or one for each value.
    centres : ndarray
        Expansion points [rad/s], one for each operator.
    """

    lower: Array
    upper: Array
    open: NDArray[np.bool_]
    values: Array
    damping_factor: Array
    parameter: str
    resonance: Resonance
    order: int
    dimension: int
    expansion: str
    operators: tuple[ResonantOperator, ...]
    centres: Array

    exported: ClassVar[tuple[str, ...]] = ("width",)

    @property
    def width(self) -> Array:
        """Width of the range [rad/s]; zero where it is closed."""
        value: Array = np.where(self.open, self.upper - self.lower, 0.0)
        return value

    @property
    def label(self) -> str:
        """The resonance in words, such as ``w1 + w2 = 3 w``."""
        return self.resonance.label

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the range over the values, speed to the right, and return the axes.

        Ranges without an end are left out.
        """
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        unit = 30 / np.pi
        bounded = np.isfinite(self.upper.ravel())
        lower = np.where(bounded, self.lower.ravel(), np.nan) * unit
        upper = np.where(bounded, self.upper.ravel(), np.nan) * unit
        if self.values.ndim and self.parameter:
            values = self.values.ravel()
            order = np.argsort(values, kind="stable")
            ends = lower[order], upper[order]
            ax.fill_betweenx(values[order], *ends, alpha=0.4, label=self.label)
            ax.set_ylabel(self.parameter.replace("_", " "))
        else:
            for left, right in zip(lower, upper, strict=True):
                ax.axvspan(left, right, alpha=0.4, label=self.label)
            ax.set_yticks([])
        ax.set_xlabel("crank speed [rpm]")
        ax.legend()
        return ax


def tongue(
    system: LinearPeriodic,
    resonance: Resonance,
    *,
    parameter: tuple[str, ArrayLike] | None = None,
    order: int = 2,
    damping_factor: ArrayLike = 1.0,
    merge: float = 0.04,
    **parameters: float,
) -> Tongue:
    """Return the ends of the tongue that starts at a resonance, to a chosen order.

    The Floquet operator L(theta) - d/dtheta of the canonical variables is reduced to the exponents
    that meet: a power series in the periodic part, the detuning and the damping, all of first
    order.  Its eigenvalues are the exponents; the ends are where the largest real part passes
    zero.  The detuning sigma of the speed is defined by 1/w = (1 + sigma)/w0.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    resonance : Resonance
        From :func:`~.meetings.resonances`; it is sought anew for each parameter value.
    parameter : (str, array_like), optional
        A parameter and its values, any shape.  Where nothing is periodic once it is zero, the
        series is one in the parameter; else all that is periodic is the small part.
    order : int
        Total degree, 1 to 8.
    damping_factor : array_like
        Factor on the system's own damping terms, at least zero; broadcasts with the values.
    merge : float
        Distance of other exponents, in harmonics of the period, up to which they are treated
        together with the two of the resonance.
    **parameters : float
        Values of further parameters that replace the system's own.

    Returns
    -------
    Tongue
        Its checks: ``error over half the width``, the worst over open ranges; and, made when
        looked at, ``stable inside`` and ``unstable outside``: how many of up to three values of
        the parameter show a multiplier on the wrong side of the unit circle just within or just
        beyond the ends; and ``told apart``, how many undamped ranges are lost in others, and how
        many of those that damping is said to close have a multiplier outside the circle.

    Raises
    ------
    BadInput
        If an argument is unusable, the resonance does not occur at a value, or the mean system is
        at a divergence.

    Notes
    -----
    Smith, chapter 9, suggestion 1; Smith (7.12)-(7.18) for one mode.
    """
    order = require_whole("order", order, 1, HIGHEST, "choose 2")
    apart = numbers("merge", merge)
    if apart.shape != () or not 0 <= apart < 0.5:
        raise bad("merge", merge, "a number from 0 to below 0.5", "choose 0.04")
    if not isinstance(resonance, Resonance):
        raise bad("resonance", repr(resonance), "a Resonance", "take one that resonances() gives")
    name, values, factor = _arguments(parameter, damping_factor)
    _check_names(system, resonance, name, parameters)
    problem = _Problem(system, resonance, dict(parameters), order, merge)
    flat, drag = values.ravel(), factor.ravel()
    series = name is not None and problem.starts_at_zero(name)
    if series and name is not None:
        radius = float(np.max(np.abs(flat), initial=0.0)) or 1.0
        operators = [problem.operator({}, name, radius)]
        eps, which = flat / radius, np.zeros(len(flat), dtype=int)
    else:
        distinct, which = np.unique(flat, return_inverse=True)
        changes = [{} if name is None else {name: float(value)} for value in distinct]
        operators = [problem.operator(change, None, 1.0) for change in changes]
        eps = np.ones(len(flat))
    places = _Places(values, factor, which, eps)
    rows = [
        problem.ends(operators[k][0], operators[k][1], float(size), float(delta))
        for k, size, delta in zip(which, eps, drag, strict=True)
    ]
    columns = (np.array([row[i] for row in rows]) for i in range(4))
    lower, upper, opened, error = (column.reshape(values.shape) for column in columns)
    dimension = max((operator.size for operator, _ in operators), default=2)
    changed = {} if name is None else {name: values}
    result = Tongue(
        method=f"perturbation of order {order}, {dimension} exponents together",
        error=error,
        error_norm="absolute, of either end",
        provenance=provenance(system.changed_provenance(**parameters, **changed)),
        lower=lower,
        upper=upper,
        open=opened.astype(bool),
        values=np.array(values),
        damping_factor=np.array(factor),
        parameter=name or "",
        resonance=resonance,
        order=order,
        dimension=dimension,
        expansion="parameter" if series else "periodic",
        operators=tuple(operator for operator, _ in operators),
        centres=np.array([at for _, at in operators]),
    )
    return replace(result, checks=DeferredChecks(TongueChecks(problem, result, places)))


def _arguments(
    parameter: tuple[str, ArrayLike] | None, damping_factor: ArrayLike
) -> tuple[str | None, Array, Array]:
    """Return the parameter's name, its values and the damping factors, broadcast."""
    name: str | None = None
    values = np.zeros(())
    if parameter is not None:
        if len(parameter) != 2 or not isinstance(parameter[0], str):
            raise bad("parameter", repr(parameter), "(name, values)", "give a pair")
        name, values = parameter[0], numbers(parameter[0], parameter[1])
    factor = numbers("damping_factor", damping_factor)
    for where, array in ((name or "parameter", values), ("damping_factor", factor)):
        if not np.all(np.isfinite(array)):
            raise bad(where, array, "finite numbers", "correct it")
    if np.any(factor < 0):
        raise bad("damping_factor", damping_factor, "factors of at least 0", "0 leaves damping out")
    try:
        values, factor = np.broadcast_arrays(values, factor)
    except ValueError as mismatch:
        shapes = (values.shape, factor.shape)
        raise bad(
            "parameter and damping_factor", shapes, "shapes that broadcast", "add axes of length 1"
        ) from mismatch
    return name, values, factor


def _check_names(
    system: LinearPeriodic,
    resonance: Resonance,
    name: str | None,
    parameters: Mapping[str, float],
) -> None:
    """Raise where names clash or are unknown, or a resonance does not fit the system."""
    if name is not None and name in parameters:
        raise bad("parameters", sorted([*parameters, name]), "each parameter once", "leave one out")
    if max(resonance.modes) > system.size or min(resonance.modes) < 1:
        expected_modes = f"modes from 1 to {system.size}"
        raise bad("resonance.modes", resonance.modes, expected_modes, "correct it")
    given = {} if name is None else {name: system.parameters.get(name, 0.0)}
    equation_of(system, resonance.speed, {**parameters, **given})


class _Places(NamedTuple):
    """Points of a tongue: values and factors; flat, which operator, and its eps."""

    values: Array
    damping: Array
    which: NDArray[np.intp]
    eps: Array


@dataclass(frozen=True)
class _Problem:
    """What does not change over the values of the parameter."""

    system: LinearPeriodic
    resonance: Resonance
    parameters: dict[str, float]
    order: int
    merge: float

    def starts_at_zero(self, name: str) -> bool:
        """Return True where the system rests on a constant one with the parameter zero."""
        given = {**self.parameters, name: 0.0}
        return constant_at(self.system, given) and len(self._meetings(given)) > 0

    def _meetings(self, parameters: Mapping[str, float]) -> Array:
        """Return where the exponents of the resonance meet, not too far from where they did."""
        item = self.resonance
        mean = MeanSystem(self.system, parameters)
        return mean.meetings(self._span, [(item.kind, item.modes, item.harmonic)])[0]

    @property
    def _span(self) -> tuple[float, float]:
        return self.resonance.speed / _NEAR, self.resonance.speed * _NEAR

    def operator(
        self, changes: Mapping[str, float], name: str | None, radius: float
    ) -> tuple[ResonantOperator, float]:
        """Return the effective operator, two orders beyond the wanted, and its centre."""
        given = {**self.parameters, **changes}
        meetings = self._meetings(given if name is None else {**given, name: 0.0})
        item = self.resonance
        if not len(meetings):
            low, high = self._span
            raise bad(
                item.label,
                f"no such resonance from {low:.4g} to {high:.4g}",
                "one at every parameter value",
                "choose values nearer to those that the resonance was found at",
            )
        at = float(meetings[np.argmin(np.abs(meetings - item.speed))])
        point = Point(self.system, given, at, name, radius)
        flow = conservative(self.system, at, given if name is None else {**given, name: radius})
        return resonant_operator(point, item, self.order + BEYOND, self.merge, flow), at

    def ends(
        self, operator: ResonantOperator, at: float, eps: float, delta: float
    ) -> tuple[float, float, bool, float]:
        """Return lower and upper end, whether open, and the error, at one point."""
        ends = self._detunings(operator, eps, delta)
        first = ends[0]
        if first == UNBOUNDED:
            return 0.0, np.inf, True, np.inf
        places = [np.array([_speed(e.high, at), _speed(e.low, at)]) for e in ends]
        moved = max(float(np.max(np.abs(other - places[0]))) for other in places[1:])
        moved = moved if np.isfinite(moved) else np.inf
        # The next two orders show the size of what is left out, not its exact amount.  Order 1 does
        # not see how neighbouring tongues that touch bend each other: there the error was up to 2.6
        # times that.
        error = (3.0 if self.order == 1 else 2.0) * moved + 64 * _EPS * abs(at)
        touching = first.low == first.high and first.low.imag == 0.0
        if not (first.open or touching):
            return np.nan, np.nan, False, np.nan
        low, high = sorted(places[0].real.tolist())
        return low, high, first.open, error

    def _detunings(self, operator: ResonantOperator, eps: float, delta: float) -> list[Ends]:
        """Return the ends in sigma at the wanted order and the two beyond it."""
        centre, half = expected(operator.polynomials(eps, 0.0, 1))
        damped = delta != 0.0 and operator.damped
        lossless = False if damped else True if operator.conservative else None
        together = float(np.max(np.abs(operator.gaps))) <= _EXACT
        out = []
        for order in range(1, self.order + BEYOND + 1):
            matrices = operator.polynomials(eps, delta, order)
            if operator.size == 2:
                ends = two_exponents(matrices, centre, lossless)
                middle = (ends.low + ends.high).real / 2
                centre = middle if np.isfinite(middle) else centre
                out.append(ends)
            elif order >= self.order:
                # Growth without damping, over the size of the operator, that round-off makes.
                several = Several(
                    matrices,
                    operator.modes,
                    None if together else self.resonance.modes,
                    bool(lossless),
                    0.0 if damped else 1e-11,
                )
                out.append(several.ends(centre, half))
        return out[-1 - BEYOND :]


def _speed(sigma: complex, at: float) -> complex:
    """Return the speed at a detuning."""
    return at / (1 + sigma) if np.isfinite(sigma) else sigma


# ---------------------------------------------------------------- checks


@dataclass(frozen=True)
class TongueChecks:
    """Compares a tongue with multipliers from integration when it is called."""

    problem: _Problem
    tongue: Tongue
    places: _Places

    def __call__(self) -> Mapping[str, Check]:
        """Return the checks by name."""
        result = self.tongue
        width, error = result.width.ravel(), result.error.ravel()
        opened = np.flatnonzero(result.open.ravel())
        checks = {"told apart": Check(float(self._lost()), 0.0)}
        if not len(opened):
            return checks
        with np.errstate(invalid="ignore"):
            share = 2 * error[opened] / width[opened]
        worst = float(np.max(np.where(np.isnan(share), np.inf, share)))
        checks["error over half the width"] = Check(worst, 1.0)
        opened = opened[share < 1]
        if len(opened):
            wrong = [self._contradictions(place) for place in _some(opened)]
            names = ("stable inside", "unstable outside")
            for name, counts in zip(names, zip(*wrong, strict=True), strict=True):
                checks[name] = Check(float(sum(counts)), 0.0)
        return checks

    def _lost(self) -> int:
        """Count the ranges that are missing although damping does not close them."""
        missing = np.isnan(self.tongue.lower).ravel()
        undamped = missing & (self.places.damping.ravel() == 0.0)
        if not self.problem.system.is_damped(**self.problem.parameters):
            undamped = missing
        closed = np.flatnonzero(missing & ~undamped)
        lost = int(np.sum(undamped))
        if not len(closed):
            return lost
        at = {int(place): self._within(int(place)) for place in closed}
        size = {k: np.max(np.abs(self._multipliers(k, x)), axis=-1) for k, x in at.items()}
        # All that the series doubts, and a few others; at the middle and the likeliest place.
        for k in sorted({k for k in at if np.max(size[k]) > 1.0} | set(_some(closed))):
            modulus, error = self._modulus(k, at[k][[0, int(np.argmax(size[k]))]])
            lost += bool(np.any(modulus > 1 + error))
        return lost

    def _operator(self, place: int) -> tuple[ResonantOperator, float, float]:
        which = int(self.places.which[place])
        result = self.tongue
        return result.operators[which], float(result.centres[which]), float(self.places.eps[place])

    def _within(self, place: int) -> Array:
        """Return places, the middle first, all over the range that damping is said to close."""
        operator, at, eps = self._operator(place)
        low, high, _, error = self.problem.ends(operator, at, eps, 0.0)
        if not np.all(np.isfinite([low, high, error])):
            centre, half = expected(operator.polynomials(eps, 0.0, 1))
            sigma = np.array([centre - half, centre + half])
            low, high = np.sort(at / (1 + sigma)).tolist()
            error = 0.0
        within = np.linspace(low - error, high + error, 101)
        return np.concatenate([[(low + high) / 2], within])

    def _contradictions(self, place: int) -> tuple[int, int]:
        """Count wrong verdicts just inside and just outside at one value."""
        low, high, error = (
            float(item.ravel()[place])
            for item in (self.tongue.lower, self.tongue.upper, self.tongue.error)
        )
        # Looked at is a twentieth of the width from the ends, where the growth is at least a
        # fiftieth of that in the middle.
        margin = max(3 * error, 0.05 * (high - low))
        inner = np.array([low + margin, high - margin])
        modulus, doubt = self._modulus(place, np.array([low - margin, high + margin]))
        beyond = int(np.sum(modulus > 1 + doubt))
        if inner[0] > inner[1]:
            return 0, beyond
        top = np.abs(self._multipliers(place, np.array([(low + high) / 2]))).max()
        middle = (top - 1) * 0.02
        modulus, doubt = self._modulus(place, inner)
        return int(np.sum((modulus - 1 <= middle) & (doubt <= middle))), beyond

    def _modulus(self, place: int, at: Array) -> tuple[Array, Array]:
        """Return the largest modulus of the multipliers that the series has, and its error."""
        given = dict(self.problem.parameters)
        if self.tongue.parameter:
            given[self.tongue.parameter] = float(self.places.values.ravel()[place])
        factor = float(self.places.damping.ravel()[place])
        damped = self.problem.system.with_changed_terms(partial(_damped, factor=factor))
        exact = floquet_multipliers(damped, at, rtol=1e-11, **given)
        series = self._multipliers(place, at)
        nearest = np.argmin(np.abs(series[:, :, None] - exact.multipliers[:, None, :]), axis=-1)
        modulus = np.take_along_axis(np.abs(exact.multipliers), nearest, axis=-1)
        error = np.take_along_axis(exact.error, nearest, axis=-1) + 1e-10
        best = np.arange(len(at)), np.argmax(modulus, axis=-1)
        return modulus[best], error[best]

    def _multipliers(self, place: int, at: Array) -> Complex:
        """Return the multipliers of the series, two orders beyond the tongue's; ``(nb, r)``."""
        operator, centre, eps = self._operator(place)
        delta = float(self.places.damping.ravel()[place])
        matrices = operator.polynomials(eps, delta, operator.order)
        powers = (centre / at - 1)[:, None] ** np.arange(len(matrices))
        values = operator.centre + np.linalg.eigvals(np.tensordot(powers, matrices, axes=1))
        return np.asarray(np.exp(values * self.problem.system.period))


def _some(places: NDArray[np.intp]) -> list[int]:
    """Return an even sample of places."""
    chosen = np.unique(np.linspace(0, len(places) - 1, 3).round().astype(int))
    return [int(place) for place in places[chosen]]


def _damped(term: Term, factor: float) -> Term:
    """Return a term, multiplied by a factor where it is damping."""
    if term.array not in DAMPING or factor == 1.0:
        return term
    given = term.function
    scaled = (lambda theta: factor * given(theta)) if callable(given) else factor * given
    return replace(term, function=scaled)
