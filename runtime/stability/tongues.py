"""Principal and combination tongues of coupled modes by perturbation series, damped or not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers, require_whole
from ..core.results import Check, DeferredChecks, Result, provenance
from ..hill.bloch import BEYOND, HIGHEST
from ..periodic import floquet_multipliers
from ..periodic.equation import equation_of
from .ends import UNBOUNDED, Ends, Several, expected, two_exponents
from .meetings import MeanSystem, Resonance, conservative
from .operators import ResonantOperator, resonant_operator

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
        Values of the parameter, ``batch``; zero without one.
    parameter : str
        Name of the parameter; empty without one.
    resonance : Resonance
        Which exponents meet.
    order : int
        Total degree in periodic part, detuning and damping.
    dimension : int
        Largest number of exponents taken together.
    operators : tuple of ResonantOperator
        The series themselves, one for each value.
    """

    lower: Array
    upper: Array
    open: NDArray[np.bool_]
    values: Array
    parameter: str
    resonance: Resonance
    order: int
    dimension: int
    operators: tuple[ResonantOperator, ...]

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
    **parameters: float,
) -> Tongue:
    """Return the ends of the tongue that starts at a resonance, to a chosen order.

    The Floquet operator L(theta) - d/dtheta of the canonical variables is reduced to the exponents
    that meet, and others within 0.04 harmonics of the period: a power series about the mean system,
    in which all that is periodic, the detuning and the damping are of first order.  Its eigenvalues
    are the exponents; the ends are where the largest real part passes zero.  The detuning sigma of
    the speed is defined by 1/w = (1 + sigma)/w0.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    resonance : Resonance
        From :func:`~.meetings.resonances`; it is sought anew for each parameter value.
    parameter : (str, array_like), optional
        A parameter and its values, any shape.
    order : int
        Total degree, 1 to 8.
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
    if not isinstance(resonance, Resonance):
        raise bad("resonance", repr(resonance), "a Resonance", "take one that resonances() gives")
    if max(resonance.modes) > system.size or min(resonance.modes) < 1:
        expected_modes = f"modes from 1 to {system.size}"
        raise bad("resonance.modes", resonance.modes, expected_modes, "correct it")
    name, values = _checked(parameter, parameters)
    changed = {} if name is None else {name: values}
    start = {name: system.parameters.get(name, 0.0) for name in changed}
    equation_of(system, resonance.speed, {**parameters, **start})
    made = {
        value: _operator(system, {**parameters, **dict.fromkeys(changed, value)}, resonance, order)
        for value in np.unique(values).tolist()
    }
    operators = tuple(made[value] for value in values.ravel().tolist())
    rows = [_ends(operator, resonance, order) for operator in operators]
    columns = (np.array([row[i] for row in rows]) for i in range(4))
    lower, upper, opened, error = (column.reshape(values.shape) for column in columns)
    dimension = max((len(operator.modes) for operator in operators), default=2)
    result = Tongue(
        method=f"perturbation of order {order}, {dimension} exponents together",
        error=error,
        error_norm="absolute, of either end",
        provenance=provenance(system.changed_provenance(**parameters, **changed)),
        lower=lower,
        upper=upper,
        open=opened.astype(bool),
        values=values,
        parameter=name or "",
        resonance=resonance,
        order=order,
        dimension=dimension,
        operators=operators,
    )
    return replace(result, checks=DeferredChecks(TongueChecks(system, parameters, result)))


def _checked(
    parameter: tuple[str, ArrayLike] | None, parameters: Mapping[str, float]
) -> tuple[str | None, Array]:
    if parameter is None:
        return None, np.zeros(())
    if len(parameter) != 2 or not isinstance(parameter[0], str):
        raise bad("parameter", repr(parameter), "(name, values)", "give a pair")
    name, values = parameter[0], numbers(parameter[0], parameter[1])
    if not np.all(np.isfinite(values)):
        raise bad(name, values, "finite numbers", "correct it")
    if name in parameters:
        raise bad("parameters", sorted([*parameters, name]), "each parameter once", "leave one out")
    return name, values


def _operator(
    system: LinearPeriodic, parameters: Mapping[str, float], resonance: Resonance, order: int
) -> ResonantOperator:
    span = resonance.speed / _NEAR, resonance.speed * _NEAR
    condition = resonance.kind, resonance.modes, resonance.harmonic
    meetings = MeanSystem(system, parameters).meetings(span, [condition])[0]
    if not len(meetings):
        raise bad(
            resonance.label,
            f"no such resonance from {span[0]:.4g} to {span[1]:.4g}",
            "one at every parameter value",
            "choose values nearer to those that the resonance was found at",
        )
    at = float(meetings[np.argmin(np.abs(meetings - resonance.speed))])
    flow = conservative(system, at, parameters)
    return resonant_operator(system, parameters, resonance, at, order + BEYOND, flow)


def _ends(
    operator: ResonantOperator, resonance: Resonance, order: int, *, undamped: bool = False
) -> tuple[float, float, bool, float]:
    """Return lower and upper end, whether open, and the error."""
    ends = _detunings(operator, resonance, order, undamped)
    first = ends[0]
    if first == UNBOUNDED:
        return 0.0, np.inf, True, np.inf
    at = operator.speed
    places = [np.array([_speed(e.high, at), _speed(e.low, at)]) for e in ends]
    moved = max(float(np.max(np.abs(other - places[0]))) for other in places[1:])
    moved = moved if np.isfinite(moved) else np.inf
    # The next two orders show the size of what is left out, not its exact amount.  Order 1 does
    # not see how neighbouring tongues that touch bend each other: there the error was up to 2.6
    # times that.
    error = (3.0 if order == 1 else 2.0) * moved + 64 * _EPS * abs(at)
    touching = first.low == first.high and first.low.imag == 0.0
    if not (first.open or touching):
        return np.nan, np.nan, False, np.nan
    low, high = sorted(places[0].real.tolist())
    return low, high, first.open, error


def _detunings(
    operator: ResonantOperator, resonance: Resonance, order: int, undamped: bool
) -> list[Ends]:
    """Return the ends in sigma at the wanted order and the two beyond it."""
    centre, half = expected(operator.polynomials(1, undamped=True))
    damped = operator.damped and not undamped
    lossless = False if damped else True if operator.conservative else None
    together = float(np.max(np.abs(operator.gaps))) <= _EXACT
    out = []
    for degree in range(1, order + BEYOND + 1):
        matrices = operator.polynomials(degree, undamped=undamped)
        if len(operator.modes) == 2:
            ends = two_exponents(matrices, centre, lossless)
            middle = (ends.low + ends.high).real / 2
            centre = middle if np.isfinite(middle) else centre
            out.append(ends)
        elif degree >= order:
            # Growth without damping, over the size of the operator, that round-off makes.
            several = Several(
                matrices,
                operator.modes,
                None if together else resonance.modes,
                bool(lossless),
                0.0 if damped else 1e-11,
            )
            out.append(several.ends(centre, half))
    return out[-1 - BEYOND :]


def _speed(sigma: complex, at: float) -> complex:
    return at / (1 + sigma) if np.isfinite(sigma) else sigma


# ---------------------------------------------------------------- checks


@dataclass(frozen=True)
class TongueChecks:
    """Compares a tongue with multipliers from integration when it is called."""

    system: LinearPeriodic
    parameters: Mapping[str, float]
    tongue: Tongue

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
            wrong = np.sum([self._contradictions(place) for place in _some(opened)], axis=0)
            checks["stable inside"] = Check(float(wrong[0]), 0.0)
            checks["unstable outside"] = Check(float(wrong[1]), 0.0)
        return checks

    def _lost(self) -> int:
        """Count the ranges that are missing although damping does not close them."""
        missing = np.flatnonzero(np.isnan(self.tongue.lower.ravel())).tolist()
        closed = np.array([k for k in missing if self.tongue.operators[k].damped], dtype=np.intp)
        lost = len(missing) - len(closed)
        at = {int(place): self._within(int(place)) for place in closed}
        size = {k: np.max(np.abs(self._multipliers(k, x)), axis=-1) for k, x in at.items()}
        # All that the series doubts, and a few others; at the middle and the likeliest place.
        for k in sorted({k for k in at if np.max(size[k]) > 1.0} | set(_some(closed))):
            modulus, error = self._modulus(k, at[k][[0, int(np.argmax(size[k]))]])
            lost += bool(np.any(modulus > 1 + error))
        return lost

    def _within(self, place: int) -> Array:
        """Return places, the middle first, all over the range that damping is said to close."""
        operator = self.tongue.operators[place]
        low, high, _, error = _ends(
            operator, self.tongue.resonance, self.tongue.order, undamped=True
        )
        if not np.all(np.isfinite([low, high, error])):
            centre, half = expected(operator.polynomials(1, undamped=True))
            sigma = np.array([centre - half, centre + half])
            low, high = np.sort(operator.speed / (1 + sigma)).tolist()
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
        given = dict(self.parameters)
        if self.tongue.parameter:
            given[self.tongue.parameter] = float(self.tongue.values.ravel()[place])
        exact = floquet_multipliers(self.system, at, rtol=1e-11, **given)
        series = self._multipliers(place, at)
        nearest = np.argmin(np.abs(series[:, :, None] - exact.multipliers[:, None, :]), axis=-1)
        modulus = np.take_along_axis(np.abs(exact.multipliers), nearest, axis=-1)
        error = np.take_along_axis(exact.error, nearest, axis=-1) + 1e-10
        best = np.arange(len(at)), np.argmax(modulus, axis=-1)
        return modulus[best], error[best]

    def _multipliers(self, place: int, at: Array) -> Complex:
        """Return the multipliers of the series, two orders beyond the tongue's; ``(nb, r)``."""
        operator = self.tongue.operators[place]
        matrices = operator.polynomials(len(operator.terms))
        powers = (operator.speed / at - 1)[:, None] ** np.arange(len(matrices))
        values = operator.centre + np.linalg.eigvals(np.tensordot(powers, matrices, axes=1))
        return np.asarray(np.exp(values * self.system.period))


def _some(places: NDArray[np.intp]) -> list[int]:
    if not len(places):
        return []
    chosen = np.unique(np.linspace(0, len(places) - 1, 3).round().astype(int))
    return [int(place) for place in places[chosen]]
