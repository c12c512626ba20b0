"""Principal and combination tongues of coupled modes by perturbation series, damped or not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers, require_whole
from ..core.maxima import local_maxima
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, DeferredChecks, Result, provenance
from ..hill.bloch import BEYOND, HIGHEST
from ..hill.boundaries import sample_of
from ..periodic import floquet_multipliers
from ..periodic.equation import equation_of
from .meetings import MeanSystem, Resonance, conservative
from .operators import ResonantOperator, resonant_operator

Complex = NDArray[np.complex128]

# Largest detuning, relatively, that is looked at.
MOST_DETUNING = 0.4
# Imaginary parts of the undamped equation for the exponents up to this, relatively, are round-off,
# and a coupling over the detuning's own effect.
_ROUND, _NO_COUPLING = 1e-11, 1e-14
# Share of a growing motion from which it is that of one mode.
_PRINCIPAL = 0.75


class Ends(NamedTuple):
    """Two ends of a range of the detuning, and whether the range between is unstable.

    Conjugate complex where damping closes the range or none opens.
    """

    low: complex
    high: complex
    open: bool


CLOSED = Ends(complex(np.nan), complex(np.nan), False)
# Unstable as far as the series can be trusted.
UNBOUNDED = Ends(complex(-np.inf), complex(np.inf), True)


def expected(matrices: Complex) -> tuple[float, float]:
    """Return centre and half-width of the range to first order, both positive or zero.

    From the coefficients of the powers of the detuning, ``(2, r, r)``, degree 1 alone; the first
    two rows and columns are those of the resonance.
    """
    y = -1j * matrices[:, :2, :2]
    gap = (y[:, 0, 0] - y[:, 1, 1]).real
    slope = float(gap[1])
    if slope == 0.0:
        return 0.0, 0.0
    coupling = float(np.sqrt(abs(y[0, 0, 1] * y[0, 1, 0])))
    return float(-gap[0] / slope), 2 * coupling / abs(slope)


# ---------------------------------------------------------------- two exponents


def two_exponents(matrices: Complex, centre: float, lossless: bool | None) -> Ends:
    """Return where an exponent of a 2 x 2 effective operator has a real part of zero.

    With y = -i s the exponents are ``m +- sqrt(D)``.  Undamped, m and D are real and D < 0 is
    unstable; else the condition of Routh and Hurwitz, ``4 m2^2 (m2^2 + D1) - D2^2 < 0`` with
    m2 = Im m, D = D1 + i D2.
    """
    y = -1j * matrices
    centre = _middle((y[:, 0, 0] - y[:, 1, 1]).real, centre)
    y = _shifted(y, centre)
    mean: Complex = (y[:, 0, 0] + y[:, 1, 1]) / 2
    half_gap: Complex = (y[:, 0, 0] - y[:, 1, 1]) / 2
    inner = np.asarray(polynomial.polymul(y[:, 0, 1], y[:, 1, 0]), dtype=complex)
    if lossless is None:
        pairs = ((mean, half_gap), (half_gap, half_gap), (inner, inner))
        lossless = all(np.max(np.abs(v.imag)) <= _ROUND * np.max(np.abs(s)) for v, s in pairs)
        if not lossless:
            # Without damping the real parts add up to zero: some exponent grows.
            return UNBOUNDED
    discriminant = polynomial.polyadd(polynomial.polymul(half_gap, half_gap), inner)
    if lossless:
        if abs(inner[0]) <= (_NO_COUPLING * float(np.max(np.abs(half_gap)))) ** 2:
            # The order is too low to open the range, or nothing opens it.
            return Ends(complex(centre), complex(centre), False)
        ends = _near_roots(np.asarray(discriminant.real, dtype=float), centre)
        if ends.low.imag != 0.0 and np.isfinite(ends.low):
            middle = complex((ends.low + ends.high).real / 2)
            return Ends(middle, middle, False)
        return ends
    loss = polynomial.polymul(mean.imag, mean.imag)
    condition = polynomial.polysub(
        4 * polynomial.polymul(loss, polynomial.polyadd(loss, discriminant.real)),
        polynomial.polymul(discriminant.imag, discriminant.imag),
    )
    ends = _near_roots(np.asarray(condition, dtype=float), centre)
    # Both exponents may grow: then there is no end between one and none.
    growing = float(mean[0].imag) < -_ROUND * float(np.max(np.abs(half_gap)))
    return UNBOUNDED if growing and not ends.open else ends


def _middle(gap: Array, centre: float) -> float:
    """Return where the diagonal entries agree, by Newton from an expected place."""
    slope = polynomial.polyder(gap)
    at = centre
    for _ in range(20):
        gradient = float(polynomial.polyval(at, slope))
        if gradient == 0.0:
            return centre
        step = float(polynomial.polyval(at, gap)) / gradient
        at -= step
        if abs(at - centre) > MOST_DETUNING:
            return centre
        if abs(step) <= 1e-16 + 4e-16 * abs(at):
            break
    return at


def _near_roots(condition: Array, centre: float) -> Ends:
    """Return the two roots nearest to zero of a polynomial, beyond a centre."""
    if len(condition) < 3 or condition[2] == 0.0:
        return CLOSED
    # The quadratic part shows how far the ends are from the centre.
    scale = max(float(np.max(np.abs(polynomial.polyroots(condition[:3])))), 1e-14)
    scaled = condition * scale ** np.arange(len(condition))
    # Powers that round-off hides where the ends can lie, up to eight times as far as the quadratic
    # part shows, would only blur the others' roots.
    weight = np.abs(scaled) * 8.0 ** np.arange(len(scaled))
    last = max(2, int(np.flatnonzero(weight > 1e-17 * np.max(np.abs(scaled)))[-1]))
    roots = polynomial.polyroots(scaled[: last + 1]).astype(complex)
    near = _polished(scaled, roots[np.argsort(np.abs(roots), kind="stable")[:2]])
    low, high = sorted((complex(root) for root in near), key=lambda root: (root.real, root.imag))
    real = low.imag == 0.0 and high.imag == 0.0
    inside = float(polynomial.polyval((low.real + high.real) / 2, scaled)) < 0
    if inside and not real:
        return UNBOUNDED
    return Ends(centre + scale * low, centre + scale * high, real and inside)


def _polished(coefficients: Array, roots: Complex) -> Complex:
    """Return roots after a few steps of Newton; far roots blur those of the companion matrix."""
    slope = polynomial.polyder(coefficients)
    for _ in range(3):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = polynomial.polyval(roots, coefficients) / polynomial.polyval(roots, slope)
        # Near a double root the quotient has no meaning.
        roots = np.where(np.abs(step) < 1e-2 * (1 + np.abs(roots)), roots - step, roots)
    return roots


def _shifted(coefficients: Complex, centre: float) -> Complex:
    """Return the coefficients in t of a polynomial in ``centre + t``."""
    out = np.zeros_like(coefficients)
    for value in coefficients[::-1]:
        out[1:] = centre * out[1:] + out[:-1]
        out[0] = centre * out[0] + value
    return out


# ---------------------------------------------------------------- more than two


@dataclass(frozen=True)
class Several:
    """Effective operator of any dimension at given parameters, as a function of the detuning.

    ``matrices`` ``(order + 1, r, r)`` are the coefficients of the detuning's powers, ``members``
    the mode, from 1, of each basis function, ``modes`` the two of the resonance, None where all
    exponents meet exactly, so that no motion belongs to some of the modes.  Where ``lossless``,
    exponents can leave the imaginary axis in pairs alone; up to ``noise``, over the size of the
    operator, an exponent does not count as growing.
    """

    matrices: Complex
    members: tuple[int, ...]
    modes: tuple[int, int] | None
    lossless: bool
    noise: float

    def ends(self, centre: float, half: float) -> Ends:
        """Return the unstable range of the resonance's modes that is nearest to a centre."""
        y = -1j * self.matrices
        slope = abs(complex(y[1, 0, 0] - y[1, 1, 1]))
        if slope == 0.0:
            return CLOSED
        reach = min(4 * float(np.linalg.norm(y[0], ord=2)) / slope, MOST_DETUNING)
        sigma = self._search_points(centre, half, reach)
        growth = self._growth(sigma)
        unstable = np.concatenate([[False], growth > self._limit, [False]])
        starts = np.flatnonzero(unstable[1:] & ~unstable[:-1])
        stops = np.flatnonzero(unstable[:-1] & ~unstable[1:]) - 1
        best, out = np.inf, CLOSED
        for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
            unbounded = start == 0 or stop == len(sigma) - 1
            if unbounded and self.lossless:
                continue
            # Without an end the range holds other tongues too, and their tops.
            inside = sigma[start : stop + 1]
            best_of = -np.abs(inside - centre) if unbounded else growth[start : stop + 1]
            top = float(inside[int(np.argmax(best_of))])
            apart = max(float(sigma[start]) - centre, centre - float(sigma[stop]), 0.0)
            if not (apart < best and self._belongs(top)):
                continue
            best, out = apart, UNBOUNDED
            if not unbounded:
                outer, inner = sigma[[start - 1, stop + 1]], sigma[[start, stop]]
                for _ in range(60):
                    middle = (outer + inner) / 2
                    grows = self._growth(middle) > self._limit
                    outer, inner = np.where(grows, outer, middle), np.where(grows, middle, inner)
                low, high = (outer + inner) / 2
                out = Ends(complex(low), complex(high), True)
        return out

    @property
    def _limit(self) -> float:
        """Growth from which an exponent counts as growing."""
        return self.noise * float(np.max(np.abs(self.matrices[0]), initial=1e-300))

    def _at(self, sigma: Array) -> Complex:
        powers = sigma[:, None] ** np.arange(len(self.matrices))
        return np.asarray(-1j * np.tensordot(powers, self.matrices, axes=1))

    def _growth(self, sigma: Array) -> Array:
        """Return the largest real part of an exponent, ``(nb,)``."""
        return np.asarray(np.max(-np.linalg.eigvals(self._at(sigma)).imag, axis=-1))

    def _hidden(self, sigma: Array) -> Array:
        """Return what is low where a narrow range may be hidden, ``(nb, c)``.

        The distances of the turnings of neighbouring exponents; with losses the decay of the least.
        """
        values = np.linalg.eigvals(self._at(sigma))
        if self.lossless:
            return np.diff(np.sort(values.real, axis=-1), axis=-1)
        return np.asarray(np.min(values.imag, axis=-1, keepdims=True))

    def _belongs(self, sigma: float) -> bool:
        """Return True where the growing motion is that of the resonance's modes."""
        # Looked at is the power that each mode takes up, its action times the growth and what
        # damping takes: two modes of one tongue share it alike, whereas of the actions the lightly
        # damped mode has nearly all.
        if self.modes is None:
            return True
        matrix = self._at(np.array([sigma]))[0]
        values, vectors = np.linalg.eig(matrix)
        top = int(np.argmin(values.imag))
        action = np.abs(vectors[:, top]) ** 2
        first, second = (np.equal(self.members, mode) for mode in self.modes)
        if self.modes[0] == self.modes[1]:
            return float(np.sum(action[first])) >= _PRINCIPAL * float(np.sum(action))
        # With y = -i s the growth is -Im y.
        power = action * np.abs(np.diagonal(matrix).imag - values[top].imag)
        least = min(float(np.sum(power[first])), float(np.sum(power[second])))
        return least >= (1 - _PRINCIPAL) * float(np.sum(power))

    def _search_points(self, centre: float, half: float, reach: float) -> Array:
        """Return points all over, dense about the centre and where exponents nearly meet."""
        fine = max(half, 1e-3 * reach) / 8
        spread = np.linspace(-1.0, 1.0, 401)
        dense = fine * np.sinh(spread * np.arcsinh(reach / fine))
        sigma = np.unique(centre + np.concatenate([dense, reach * spread]))
        parts, values = [sigma], self._hidden(sigma)
        # Exponents that coincide all along differ by round-off alone; growth that shows is enough.
        least = 1e-12 * np.max(values, axis=0) if self.lossless else [-self._limit]
        for column, row in enumerate(values.T):
            for low in local_maxima(-row).tolist():
                if row[low] > least[column]:
                    parts += self._zoomed(sigma, low, column)
        return np.unique(np.concatenate(parts))

    def _zoomed(self, sigma: Array, place: int, column: int) -> list[Array]:
        """Return points that close in on a low of what is hidden, until growth is seen there."""
        left, right = float(sigma[place - 1]), float(sigma[place + 1])
        parts = []
        for _ in range(12):
            inner = np.linspace(left, right, 17)
            parts.append(inner)
            best = int(np.argmin(self._hidden(inner)[:, column]))
            if self._growth(inner[best : best + 1])[0] > self._limit:
                break
            left, right = float(inner[max(best - 1, 0)]), float(inner[min(best + 1, 16)])
        return parts


_EPS = float(np.finfo(float).eps)
# Factor on either side of a resonance within which its like at other parameter values is sought.
_NEAR = 3.0


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
    column_units: ClassVar = {"rad/s": "lower upper error width"}

    @property
    def width(self) -> Array:
        """Width of the range [rad/s]; zero where it is closed."""
        return np.asarray(np.where(self.open, self.upper - self.lower, 0.0))

    @property
    def label(self) -> str:
        """The resonance in words, such as ``w1 + w2 = 3 w``."""
        return self.resonance.label

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the range over the values, speed to the right, and return the axes.

        Ranges without an end are left out.
        """
        ax = axes_or_new(ax)
        bounded = np.isfinite(self.upper.ravel())
        lower = np.where(bounded, self.lower.ravel(), np.nan) * RPM
        upper = np.where(bounded, self.upper.ravel(), np.nan) * RPM
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
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
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

    Examples
    --------
    >>> import elastolink as el
    >>> import numpy as np
    >>> mass, spring = el.Term("M", None, np.eye(1)), el.Term("K", None, np.array([[4.0]]))
    >>> pulsating = el.Term("K", None, lambda theta: 0.5 * np.cos(theta)[:, None, None])
    >>> system = el.LinearPeriodic(size=1, terms=(mass, spring, pulsating))
    >>> resonance, *_ = el.stability.resonances(system, (3.5, 4.5))
    >>> region = el.stability.tongue(system, resonance, order=4)
    >>> print(region.label, region.lower.round(3), region.upper.round(3))
    2 w1 = w 3.874 4.124
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
    table = np.array(rows, dtype=float).reshape(*values.shape, 4)
    lower, upper, opened, error = np.moveaxis(table, -1, 0)
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
        found = f"no such resonance from {span[0]:.4g} to {span[1]:.4g}"
        fix = "choose values nearer to those that the resonance was found at"
        raise bad(resonance.label, found, "one at every parameter value", fix)
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
    # Exponents that meet exactly, but for round-off.
    together = float(np.max(np.abs(operator.gaps))) <= 1e-10
    out = []
    for degree in range(1, order + BEYOND + 1):
        matrices = operator.polynomials(degree, undamped=undamped)
        if len(operator.modes) == 2:
            ends = two_exponents(matrices, centre, lossless)
            if max(abs(ends.low), abs(ends.high)) > MOST_DETUNING:
                ends = UNBOUNDED if ends.open else CLOSED
            middle = (ends.low + ends.high).real / 2
            centre = middle if np.isfinite(middle) else centre
            out.append(ends)
        elif degree >= order:
            # Growth without damping, over the size of the operator, that round-off makes.
            modes, noise = None if together else resonance.modes, 0.0 if damped else 1e-11
            several = Several(matrices, operator.modes, modes, bool(lossless), noise)
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
            few = sample_of(opened, 3).tolist()
            wrong = np.sum([self._contradictions(place) for place in few], axis=0)
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
        doubted = {k for k in at if np.max(size[k]) > 1.0}
        for k in sorted(doubted.union(sample_of(closed, 3).tolist())):
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
