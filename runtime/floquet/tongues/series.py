"""Principal and combination tongues of coupled modes by perturbation series, damped or not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.families import LinearPeriodic
from ...core.inputs import require_whole
from ...core.results import DeferredChecks, Result, provenance
from ..first_order import canonical_form, numbers
from .checks import Places, TongueChecks
from .ends import (
    CLOSED,
    MOST_DETUNING,
    UNBOUNDED,
    Ends,
    Several,
    expected,
    several_exponents,
    two_exponents,
)
from .expansion import Point, constant_at
from .operator import HIGHEST, ResonantOperator, resonant_operator
from .resonances import MeanSystem, Resonance, conservative

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Factor on either side of a resonance within which its like at other parameter values is sought.
_NEAR = 3.0
# The next two orders tell the size of what is left out, not its exact amount.
_SAFETY = 2.0
# Of order 1, which does not see how neighbouring tongues that touch bend each other: there the
# error was up to 2.6 times what the next two orders tell.
_SAFETY_FIRST = 3.0
# Distance of exponents that meet exactly, but for round-off.
_EXACT = 1e-10
# Growth without damping, over the size of the operator, that round-off makes.
_NOISE = 1e-11


@dataclass(frozen=True, kw_only=True)
class Tongue(Result):
    """An unstable range of speeds about a parametric resonance, over values of a parameter.

    Attributes
    ----------
    lower, upper : ndarray
        Ends of the range [rad/s] (values of the detuned parameter where it is not the speed),
        shape ``batch``.  Equal where the order is too low to open the range, or nothing opens it;
        not a number where damping closes it, or where it is lost in another range of the same
        exponents (the check ``told apart``); 0 and inf (-inf and inf) where the series shows no
        end to the instability.
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
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        speed = self.resonance.detuning == "speed"
        unit = 30 / np.pi if speed else 1.0
        bounded = np.isfinite(self.upper.ravel())
        lower = np.where(bounded, self.lower.ravel(), np.nan) * unit
        upper = np.where(bounded, self.upper.ravel(), np.nan) * unit
        if self.values.ndim and self.parameter:
            order = np.argsort(self.values.ravel(), kind="stable")
            ax.fill_betweenx(
                self.values.ravel()[order], lower[order], upper[order], alpha=0.4, label=self.label
            )
            ax.set_ylabel(self.parameter.replace("_", " "))
        else:
            for left, right in zip(lower, upper, strict=True):
                ax.axvspan(left, right, alpha=0.4, label=self.label)
            ax.set_yticks([])
        ax.set_xlabel("crank speed [rpm]" if speed else self.resonance.detuning.replace("_", " "))
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
    speed: float = 1.0,
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
        From :func:`~.resonances.resonances`; it is sought anew for each parameter value.
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
    speed : float
        Crank speed [rad/s] where the resonance is one of a parameter.
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
    order = require_whole("order", order, 1, HIGHEST - 2, "choose 2")
    apart = numbers("merge", merge)
    if apart.shape != () or not 0 <= apart < 0.5:
        raise bad("merge", merge, "a number from 0 to below 0.5", "choose 0.04")
    if not isinstance(resonance, Resonance):
        raise bad("resonance", repr(resonance), "a Resonance", "take one that resonances() gives")
    name, values, factor = _arguments(parameter, damping_factor)
    _checked(system, resonance, name, parameters, speed)
    problem = _Problem(system, resonance, dict(parameters), speed, order, merge)
    series = name is not None and problem.starts_at_zero(name)
    flat, drag = values.ravel(), factor.ravel()
    if series and name is not None:
        radius = float(np.max(np.abs(flat), initial=0.0)) or 1.0
        operators = [problem.operator({}, name, radius)]
        numbers_, which = flat / radius, np.zeros(len(flat), dtype=int)
    else:
        distinct, which = np.unique(flat, return_inverse=True)
        changes = [{} if name is None else {name: float(value)} for value in distinct]
        operators = [problem.operator(change, None, 1.0) for change in changes]
        numbers_ = np.ones(len(flat))
    rows = [
        problem.ends(operators[k], float(eps), float(delta))
        for k, eps, delta in zip(which, numbers_, drag, strict=True)
    ]
    places = Places(values, factor, which, numbers_)
    return _result(problem, name, places, rows, operators, "parameter" if series else "periodic")


Row = tuple[float, float, bool, float]
Made = tuple[ResonantOperator, float]


@dataclass(frozen=True)
class _Problem:
    """What does not change over the values of the parameter."""

    system: LinearPeriodic
    resonance: Resonance
    parameters: dict[str, float]
    speed: float
    order: int
    merge: float

    def starts_at_zero(self, name: str) -> bool:
        """Return True where the system rests on a constant one with the parameter zero."""
        given = {**self.parameters, name: 0.0}
        at = self.resonance.speed
        if not constant_at(self.system, {**given, **_at(self.resonance, at)}):
            return False
        return len(_meetings(self.system, self.resonance, given, self.speed)) > 0

    def operator(self, changes: Mapping[str, float], name: str | None, radius: float) -> Made:
        """Return the effective operator, two orders beyond the wanted, and its centre."""
        given = {**self.parameters, **changes}
        fixed = given if name is None else {**given, name: 0.0}
        at = _located(self.system, self.resonance, fixed, self.speed)
        point = Point(
            self.system, given, self.resonance.detuning, at, self.speed, name, 0.0, radius
        )
        whole = {**given, **({} if name is None else {name: radius}), **_at(self.resonance, at)}
        speed = at if self.resonance.detuning == "speed" else self.speed
        symplectic = conservative(self.system, speed, whole)
        found = resonant_operator(point, self.resonance, self.order + 2, self.merge, symplectic)
        return found, at

    def ends(self, made: Made, eps: float, delta: float) -> Row:
        """Return lower and upper end, whether open, and the error, at one point."""
        operator, at = made
        found = self.detunings(operator, eps, delta)
        if found[0] == UNBOUNDED:
            lowest = 0.0 if self.resonance.detuning == "speed" else -np.inf
            return lowest, np.inf, True, np.inf
        speeds = [np.array([self.turned(end.high, at), self.turned(end.low, at)]) for end in found]
        first, later = speeds[0], speeds[1:]
        moved = max(float(np.max(np.abs(other - first))) for other in later)
        moved = moved if np.isfinite(moved) else np.inf
        safety = _SAFETY_FIRST if self.order == 1 else _SAFETY
        error = safety * moved + 64 * _EPS * abs(at)
        low, high = sorted(first.real.tolist())
        if not found[0].open and not _touching(found[0]):
            return np.nan, np.nan, False, np.nan
        return low, high, found[0].open, error

    def detunings(self, operator: ResonantOperator, eps: float, delta: float) -> list[Ends]:
        """Return the ends in sigma at the wanted order and the two beyond it."""
        centre, half = expected(operator.polynomials(eps, 0.0, 1))
        damped = delta != 0.0 and any(index[2] for index in operator.terms)
        lossless = False if damped else True if operator.gram is not None else None
        found = []
        for order in range(1, self.order + 3):
            matrices = operator.polynomials(eps, delta, order)
            if operator.size == 2:
                ends = two_exponents(matrices, centre, lossless)
                middle = (ends.low + ends.high).real / 2
                centre = middle if np.isfinite(middle) else centre
            elif order < self.order:
                continue
            else:
                several = self.several(operator, matrices, damped, bool(lossless))
                ends = _several_ends(several, centre, half)
            found.append(ends)
        return found[-3:]

    def several(
        self, operator: ResonantOperator, matrices: ComplexArray, damped: bool, lossless: bool
    ) -> Several:
        """Return the operator of more than two exponents as a function of the detuning."""
        together = float(np.max(np.abs(operator.gaps))) <= _EXACT
        return Several(
            matrices,
            operator.modes,
            None if together else self.resonance.modes,
            lossless,
            0.0 if damped else _NOISE,
        )

    def turned(self, sigma: complex, at: float) -> complex:
        """Return the speed, or the detuned parameter, at a detuning."""
        if not np.isfinite(sigma):
            return sigma
        if self.resonance.detuning == "speed":
            return at / (1 + sigma)
        return at * (1 + sigma)


def _several_ends(several: Several, centre: float, half: float) -> Ends:
    """Return the ends where more than two exponents meet."""
    y = -1j * several.matrices
    slope = abs(complex(y[1, 0, 0] - y[1, 1, 1]))
    if slope == 0.0:
        return CLOSED
    size = float(np.linalg.norm(y[0], ord=2))
    return several_exponents(several, centre, half, min(4 * size / slope, MOST_DETUNING))


def _touching(ends: Ends) -> bool:
    """Return True for a range that is closed without damping: two equal real ends."""
    return ends.low == ends.high and ends.low.imag == 0.0


def _at(resonance: Resonance, at: float) -> dict[str, float]:
    return {} if resonance.detuning == "speed" else {resonance.detuning: at}


def _meetings(
    system: LinearPeriodic, resonance: Resonance, parameters: Mapping[str, float], speed: float
) -> Array:
    """Return where the exponents of the resonance meet, not too far from where they did."""
    mean = MeanSystem(system, parameters, resonance.detuning, speed)
    return mean.meetings(_span(resonance), resonance.kind, resonance.modes, resonance.harmonic)


def _span(resonance: Resonance) -> tuple[float, float]:
    low, high = sorted((resonance.speed / _NEAR, resonance.speed * _NEAR))
    return low, high


def _located(
    system: LinearPeriodic, resonance: Resonance, parameters: Mapping[str, float], speed: float
) -> float:
    """Return where the exponents of the resonance meet at the given parameter values."""
    found = _meetings(system, resonance, parameters, speed)
    if not len(found):
        low, high = _span(resonance)
        raise bad(
            resonance.label,
            f"no such resonance from {low:.4g} to {high:.4g}",
            "one at every parameter value",
            "choose values nearer to those that the resonance was found at",
        )
    return float(found[np.argmin(np.abs(found - resonance.speed))])


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


def _checked(
    system: LinearPeriodic,
    resonance: Resonance,
    name: str | None,
    parameters: Mapping[str, float],
    speed: float,
) -> None:
    """Raise where names clash or are unknown, or a resonance does not fit the system."""
    names = [*parameters, *([] if name is None else [name]), *_at(resonance, 0.0)]
    if len(set(names)) != len(names):
        raise bad("parameters", sorted(names), "each parameter once", "leave one out")
    if max(resonance.modes) > system.size or min(resonance.modes) < 1:
        raise bad(
            "resonance.modes", resonance.modes, f"modes from 1 to {system.size}", "correct it"
        )
    varied = _at(resonance, resonance.speed)
    own = {} if name is None else {name: system.parameters.get(name, 0.0)}
    at = resonance.speed if not varied else speed
    canonical_form(system, at, {**parameters, **own, **varied})


def _result(
    problem: _Problem,
    name: str | None,
    places: Places,
    rows: list[Row],
    operators: list[Made],
    expansion: str,
) -> Tongue:
    columns = [np.array([row[i] for row in rows]) for i in range(4)]
    lower, upper, opened, error = (column.reshape(places.values.shape) for column in columns)
    dimension = max((operator.size for operator, _ in operators), default=2)
    changed = {} if name is None else {name: places.values}
    found = Tongue(
        method=f"perturbation of order {problem.order}, {dimension} exponents together",
        error=error,
        error_norm="absolute, of either end",
        provenance=provenance(problem.system.changed_provenance(**problem.parameters, **changed)),
        lower=lower,
        upper=upper,
        open=opened.astype(bool),
        values=np.array(places.values),
        damping_factor=np.array(places.damping),
        parameter=name or "",
        resonance=problem.resonance,
        order=problem.order,
        dimension=dimension,
        expansion=expansion,
        operators=tuple(operator for operator, _ in operators),
        centres=np.array([at for _, at in operators]),
    )
    return replace(
        found,
        checks=DeferredChecks(
            TongueChecks(
                problem.system,
                problem.resonance,
                problem.parameters,
                problem.speed,
                found,
                places,
                problem.ends,
            )
        ),
    )
