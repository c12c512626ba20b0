"""Generator of a linear periodic system as a power series about a constant system.

Indices are (eps, sigma, delta, gap): the periodic part, the detuning, the damping, and what keeps
nearly coinciding exponents apart.  All four count alike; a coefficient is an array of samples over
one period of the crank angle.  With the speed as detuning, 1/w = (1 + sigma)/w0, so that K/w^2 and
C/w are exact polynomials, and so is the exponent of a constant system without inertial terms.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.families import DAMPING, LinearPeriodic, Term
from ..first_order import SPEED_POWER, even_angles

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Index = tuple[int, int, int, int]
RealSeries = dict[Index, Array]
Series = dict[Index, ComplexArray]

ZERO: Index = (0, 0, 0, 0)
_ARRAYS = ("M", "A", "B", *DAMPING, "K", "Kg")
_NODES = 24
# Chebyshev coefficients below this, over the largest, are round-off of the samples.
_NOISE = 1e-14
_MOST_TAIL = 1e-10
_SEEN = 4e-16
_MOST_SAMPLES = 4096
# Detuning of a named parameter, relatively, over which its polynomial is fitted.
_DETUNING = 0.5


@dataclass(frozen=True)
class Point:
    """The constant system about which everything is expanded, and the two variables.

    Attributes
    ----------
    system : LinearPeriodic
        The system.
    parameters : mapping of str to float
        Values that replace the system's own.
    detuning : str
        "speed" or the name of the parameter that is detuned.
    at : float
        Value of the detuned quantity at resonance; speed [rad/s].
    speed : float
        Crank speed [rad/s] where a parameter is detuned.
    parameter : str or None
        Name of the parameter p = origin + radius eps; None where eps multiplies all that is
        periodic.
    origin, radius : float
        As above.
    """

    system: LinearPeriodic
    parameters: Mapping[str, float]
    detuning: str
    at: float
    speed: float
    parameter: str | None = None
    origin: float = 0.0
    radius: float = 1.0

    @property
    def turning(self) -> float:
        """Harmonic number 1 of the period, 2 pi/period."""
        return 2 * np.pi / self.system.period


def degree(index: Index) -> int:
    """Return the total degree."""
    return sum(index)


def add(first: Index, second: Index) -> Index:
    """Return the sum of two indices."""
    i, j, k, l = first  # noqa: E741 - four like letters
    p, q, r, s = second
    return i + p, j + q, k + r, l + s


def multiply(first: RealSeries, second: RealSeries, order: int) -> RealSeries:
    """Return the product of two series of matrices, truncated."""
    out: RealSeries = {}
    for i, a in first.items():
        for j, b in second.items():
            if degree(i) + degree(j) <= order:
                at = add(i, j)
                product = a @ b
                out[at] = out[at] + product if at in out else product
    return out


def accumulate(target: RealSeries, source: RealSeries, sign: float = 1.0) -> None:
    """Add a series to another, in place of its entries."""
    for index, value in source.items():
        target[index] = target[index] + sign * value if index in target else sign * value


def generator_series(point: Point, order: int) -> RealSeries:
    """Return the samples of L of y' = L(theta) y by index, each ``(nt, 2n, 2n)``.

    Raises
    ------
    BadInput
        If a parameter does not enter as a power series, or there is no mass.
    """
    n = point.system.size
    arrays = _arrays(point, order)
    mass = arrays["M"]
    if ZERO not in mass:
        raise bad("LinearPeriodic.terms", "no mass term M", "a positive definite M", "add the term")
    flexibility = _inverse(mass, order)
    gyro, damping = arrays["A"], arrays["C"]
    back: RealSeries = {}
    accumulate(back, {i: np.swapaxes(a, -1, -2) for i, a in gyro.items()})
    accumulate(back, damping, -1.0)
    through = multiply(back, flexibility, order)
    slope = multiply(flexibility, gyro, order)
    lower: RealSeries = {}
    accumulate(lower, arrays["B"])
    accumulate(lower, arrays["K"], -1.0)
    accumulate(lower, arrays["D"], -1.0)
    accumulate(lower, multiply(back, slope, order), -1.0)
    out: RealSeries = {}
    first, last = slice(0, n), slice(n, 2 * n)
    blocks = ((first, first, slope, -1.0), (first, last, flexibility, 1.0))
    for rows, columns, part, sign in (
        *blocks,
        (last, first, lower, 1.0),
        (last, last, through, 1.0),
    ):
        for index, value in part.items():
            if index not in out:
                out[index] = np.zeros((len(value), 2 * n, 2 * n))
            out[index][:, rows, columns] += sign * value
    return {index: value for index, value in out.items() if np.any(value)}


def _inverse(mass: RealSeries, order: int) -> RealSeries:
    """Return the series of the inverse matrix, whose constant term is a constant matrix."""
    start: Array = np.linalg.inv(mass[ZERO]).astype(np.float64)
    out: RealSeries = {ZERO: start}
    rest = {index: value for index, value in mass.items() if index != ZERO}
    for _ in range(order if rest else 0):
        # Each pass of F = F0 - F0 M_rest F makes one more degree right.
        correction = multiply({ZERO: -start}, multiply(rest, out, order), order)
        out = {ZERO: start, **correction}
    return out


def _arrays(point: Point, order: int) -> dict[str, RealSeries]:
    """Return M, A, B, C, D and K + Kg of the equation in the angle, as series of samples."""
    system = point.system
    theta = even_angles(system.period, _samples(system, order))
    factors = _factors(point, order)
    out: dict[str, RealSeries] = {name: {} for name in ("M", "A", "B", *DAMPING, "K")}
    for term, factor in zip(system.terms, factors, strict=True):
        if term.array not in _ARRAYS or not factor:
            continue
        values = np.asarray(term(theta), dtype=float)
        into = out["K" if term.array == "Kg" else term.array]
        damping = int(term.array in DAMPING)
        if point.parameter is None and not term.constant:
            mean = np.broadcast_to(values.mean(axis=0), values.shape)
            parts = [(0, mean), (1, values - mean)]
        else:
            parts = [(0, values)]
        for (i, j), number in factor.items():
            for extra, part in parts:
                index = (i + extra, j, damping, 0)
                if degree(index) <= order:
                    accumulate(into, {index: number * part})
    return out


def _samples(system: LinearPeriodic, order: int) -> int:
    """Return how many angles tell all harmonics of a product of ``order`` factors apart."""
    reach = 0
    for row, term in enumerate(system.terms):
        if term.array in SPEED_POWER and not term.constant:
            amplitude = system.spectrum(row)
            kept = np.flatnonzero(amplitude > _SEEN * np.max(amplitude, initial=0.0))
            reach = max(reach, int(kept[-1]) if len(kept) else 0)
    wanted = 2 * (order * min(reach, 128) + 40)
    return int(min(2 ** int(np.ceil(np.log2(wanted))), _MOST_SAMPLES))


Factor = dict[tuple[int, int], float]


def _factors(point: Point, order: int) -> list[Factor]:
    """Return the power series in (eps, sigma) of the factor of each term."""
    scales = _scale_series(point, order)
    out: list[Factor] = []
    for term in point.system.terms:
        if term.array not in SPEED_POWER:
            out.append({})
            continue
        own = scales[term.scale] if term.scale is not None else {(0, 0): 1.0}
        power = SPEED_POWER[term.array] + term.power
        if point.detuning == "speed":
            speeds = [point.at**power * c for c in _binomial(-power, order)]
        else:
            speeds = [point.speed**power]
        found: Factor = {}
        for (i, j), number in own.items():
            for k, factor in enumerate(speeds):
                if number * factor != 0.0 and i + j + k <= order:
                    found[i, j + k] = found.get((i, j + k), 0.0) + number * factor
        out.append(found)
    return out


def _binomial(power: int, order: int) -> list[float]:
    """Return the coefficients of (1 + sigma)**power."""
    if power >= 0:
        return [float(comb(power, k)) for k in range(min(power, order) + 1)]
    return [float((-1) ** k * comb(-power + k - 1, k)) for k in range(order + 1)]


def _scale_series(point: Point, order: int) -> dict[str, Factor]:
    """Return the power series of each parameter monomial that a term names."""
    nodes = chebyshev.chebpts1(_NODES)
    axes: list[tuple[str, Array]] = []
    if point.parameter is not None:
        axes.append((point.parameter, point.origin + point.radius * nodes))
    if point.detuning != "speed":
        axes.append((point.detuning, point.at * (1 + _DETUNING * nodes)))
    given: dict[str, float | Array] = dict(point.parameters)
    for place, (name, values) in enumerate(axes):
        given[name] = values.reshape([-1 if a == place else 1 for a in range(len(axes))])
    with np.errstate(divide="ignore", invalid="ignore"):
        found = point.system.scale_values(**given)
    shape = (_NODES,) * len(axes)
    out: dict[str, Factor] = {}
    for name in {term.scale for term in point.system.terms if term.scale is not None}:
        table = np.broadcast_to(np.asarray(found[name], dtype=float), shape)
        for axis in range(len(axes)):
            label = axes[axis][0]
            table = np.apply_along_axis(_power_series, axis, table, order, label)
        if point.detuning != "speed":
            table = table * _DETUNING ** -np.arange(order + 1.0)
        if point.parameter is None:
            table = table[None]
        if point.detuning == "speed":
            table = table[..., None]
        places = np.argwhere(table != 0.0).tolist()
        out[name] = {(i, j): float(table[i, j]) for i, j in places if i + j <= order}
    return out


def _power_series(samples: Array, order: int, name: str) -> Array:
    """Return power-series coefficients in t of samples at Chebyshev's nodes, ``(order + 1,)``."""
    if not np.all(np.isfinite(samples)):
        raise bad(
            name,
            "a parameter monomial that is not finite about the expansion point",
            "a parameter that enters as a power series",
            "choose another parameter or values nearer to the expansion point",
        )
    top = float(np.max(np.abs(samples)))
    coefficients = chebyshev.chebfit(chebyshev.chebpts1(_NODES), samples, _NODES - 1)
    kept = np.flatnonzero(np.abs(coefficients) > _NOISE * top)
    last = int(kept[-1]) if len(kept) else 0
    if last == _NODES - 1 and abs(coefficients[-1]) > _MOST_TAIL * top:
        raise bad(
            name,
            "a dependence that no polynomial of degree 23 follows",
            "a parameter that enters as a power series",
            "choose values nearer to the expansion point",
        )
    powers = chebyshev.cheb2poly(coefficients[: last + 1])
    # What is round-off in a polynomial would pass for a term of the series.
    powers[np.abs(powers) <= 16 * _NOISE * top] = 0.0
    out = np.zeros(order + 1)
    out[: min(len(powers), order + 1)] = powers[: order + 1]
    return out


def constant_at(system: LinearPeriodic, parameters: Mapping[str, float]) -> bool:
    """Return True where nothing depends on the crank angle at these parameter values."""
    with np.errstate(divide="ignore", invalid="ignore"):
        scales = system.scale_values(**parameters)

    def rests(term: Term) -> bool:
        return term.constant or (term.scale is not None and not np.any(scales[term.scale]))

    return all(rests(term) for term in system.terms if term.array in _ARRAYS)
