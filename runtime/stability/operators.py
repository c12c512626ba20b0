"""Effective operator of a parametric resonance: the Floquet operator on the exponents that meet.

The Floquet operator L(theta) - d/dtheta of the canonical variables is a power series in eps (the
periodic part), sigma (the detuning) and delta (the damping) about a constant system; the
detuning of the speed is 1/w = (1 + sigma)/w0, so that K/w^2 and C/w are exact polynomials.  Bloch's
recursion (:mod:`..hill.bloch`) reduces it to the few harmonics of the few modes whose exponents
coincide; what keeps them apart at the expansion point is one more variable.  Where the undamped
flow is symplectic the result is brought to the symmetric form, h^H G + G h = 0 in the undamped
part, so that its truncations have exponents in the pairs (s, -conj s) of the whole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import DAMPING, LinearPeriodic
from ..core.trigonometric import even_angles
from ..hill.bloch import degree_of, monomials, product_table, recursion
from ..periodic.equation import SPEED_POWER
from ..periodic.signatures import form_matrix
from .meetings import IMAGINARY, Resonance

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Samples over a period of the crank angle by the powers of (eps, sigma, delta).
Index = tuple[int, int, int]
Series = dict[Index, Array]
# Homogeneous parts of a polynomial by degree, ``(M_k, ...)`` each.
Graded = list[Complex]

_ZERO: Index = (0, 0, 0)
_ARRAYS = ("M", "A", "B", *DAMPING, "K", "Kg")
# Chebyshev nodes for the dependence on a parameter; coefficients that are round-off of the samples;
# the last one where no polynomial follows.
_NODES = 24
_NOISE, _MOST_TAIL = 1e-14, 1e-10


@dataclass(frozen=True)
class Point:
    """The constant system about which everything is expanded, at the speed of resonance [rad/s].

    ``parameter`` is the name of p = radius eps; None where eps multiplies all that is periodic.
    """

    system: LinearPeriodic
    parameters: Mapping[str, float]
    speed: float
    parameter: str | None = None
    radius: float = 1.0


def constant_at(system: LinearPeriodic, parameters: Mapping[str, float]) -> bool:
    """Return True where nothing depends on the crank angle at these parameter values."""
    with np.errstate(divide="ignore", invalid="ignore"):
        scales = system.scale_values(**parameters)
    return all(
        term.constant or (term.scale is not None and not np.any(scales[term.scale]))
        for term in system.terms
        if term.array in _ARRAYS
    )


# ---------------------------------------------------------------- the generator as a series


def _generator(point: Point, order: int) -> Series:
    """Return the samples of L of y' = L(theta) y, each ``(nt, 2n, 2n)``.

    Raises
    ------
    BadInput
        If a parameter does not enter as a power series, or there is no mass.
    """
    n = point.system.size
    arrays = _arrays(point, order)
    if _ZERO not in arrays["M"]:
        raise bad("LinearPeriodic.terms", "no mass term M", "a positive definite M", "add the term")
    flexibility = _inverse(arrays["M"], order)
    gyro = arrays["A"]
    back = _sum({i: np.swapaxes(a, -1, -2) for i, a in gyro.items()}, _minus(arrays["C"]))
    through = _times(back, flexibility, order)
    slope = _times(flexibility, gyro, order)
    coupled = _minus(_times(back, slope, order))
    lower = _sum(arrays["B"], _minus(arrays["K"]), _minus(arrays["D"]), coupled)
    out: Series = {}
    first, last = slice(0, n), slice(n, 2 * n)
    blocks = (
        (first, first, _minus(slope)),
        (first, last, flexibility),
        (last, first, lower),
        (last, last, through),
    )
    for rows, columns, part in blocks:
        for index, value in part.items():
            whole = out.setdefault(index, np.zeros((len(value), 2 * n, 2 * n)))
            whole[:, rows, columns] += value
    # Units of mass and coordinates do not matter to (q/s, p s); powers of two round nothing.
    start = out[_ZERO][0]
    size = np.abs(np.diagonal(start[:n, n:]))
    stiffness = np.maximum(np.abs(np.diagonal(start[n:, :n])), 1 / size)
    root = np.exp2(np.round(np.log2(size / stiffness) / 4))
    scale = np.concatenate([root, 1 / root])
    return {i: value / scale[:, None] * scale for i, value in out.items() if np.any(value)}


def _sum(*parts: Series) -> Series:
    out: Series = {}
    for part in parts:
        for index, value in part.items():
            out[index] = out[index] + value if index in out else value
    return out


def _minus(series: Series) -> Series:
    return {index: -value for index, value in series.items()}


def _times(first: Series, second: Series, order: int) -> Series:
    """Return the product of two series of matrices, truncated."""
    pairs = product(first.items(), second.items())
    return _sum(
        *(
            {(i[0] + j[0], i[1] + j[1], i[2] + j[2]): a @ b}
            for (i, a), (j, b) in pairs
            if sum(i) + sum(j) <= order
        )
    )


def _inverse(mass: Series, order: int) -> Series:
    """Return the series of the inverse matrix, whose constant term is a constant matrix."""
    start: Array = np.linalg.inv(mass[_ZERO]).astype(np.float64)
    out: Series = {_ZERO: start}
    rest = {index: value for index, value in mass.items() if index != _ZERO}
    for _ in range(order if rest else 0):
        # Each pass of F = F0 - F0 M_rest F makes one more degree right.
        out = {_ZERO: start, **_times({_ZERO: -start}, _times(rest, out, order), order)}
    return out


def _arrays(point: Point, order: int) -> dict[str, Series]:
    """Return M, A, B, C, D and K + Kg of the equation in the angle, as series of samples."""
    system = point.system
    reach = 0
    for row, term in enumerate(system.terms):
        if term.array in SPEED_POWER and not term.constant:
            amplitude = system.spectrum(row)
            # Harmonics below this, over the largest, are round-off.
            seen = np.flatnonzero(amplitude > 4e-16 * np.max(amplitude, initial=0.0))
            reach = max(reach, int(seen[-1]) if len(seen) else 0)
    # So many angles tell all harmonics of a product of ``order`` factors apart.
    wanted = 2 * (order * min(reach, 128) + 40)
    count = min(2 ** int(np.ceil(np.log2(wanted))), 4096)
    theta = even_angles(system.period, count)
    scales = _scale_series(point, order)
    out: dict[str, Series] = {name: {} for name in ("M", "A", "B", *DAMPING, "K")}
    for term in system.terms:
        if term.array not in _ARRAYS:
            continue
        values = np.asarray(term(theta), dtype=float)
        parts = [values]
        if point.parameter is None and not term.constant:
            mean = np.broadcast_to(values.mean(axis=0), values.shape)
            parts = [mean, values - mean]
        name = "K" if term.array == "Kg" else term.array
        power = SPEED_POWER[term.array] + term.power
        speeds = [point.speed**power * c for c in _binomial(-power, order)]
        scale = scales[term.scale] if term.scale is not None else np.ones(1)
        for (i, number), (j, speed), (extra, part) in product(
            enumerate(scale.tolist()), enumerate(speeds), enumerate(parts)
        ):
            index = (i + extra, j, int(term.array in DAMPING))
            if number * speed != 0.0 and sum(index) <= order:
                out[name] = _sum(out[name], {index: number * speed * part})
    return out


def _binomial(power: int, order: int) -> list[float]:
    """Return the coefficients of (1 + sigma)**power."""
    if power >= 0:
        return [float(comb(power, k)) for k in range(min(power, order) + 1)]
    return [float((-1) ** k * comb(-power + k - 1, k)) for k in range(order + 1)]


def _scale_series(point: Point, order: int) -> dict[str, Array]:
    """Return the power series in eps of each parameter monomial that a term names."""
    given: dict[str, float | Array] = dict(point.parameters)
    if point.parameter is not None:
        given[point.parameter] = point.radius * chebyshev.chebpts1(_NODES)
    with np.errstate(divide="ignore", invalid="ignore"):
        scales = point.system.scale_values(**given)
    out: dict[str, Array] = {}
    for name in {term.scale for term in point.system.terms if term.scale is not None}:
        value = np.asarray(scales[name], dtype=float)
        if point.parameter is None:
            out[name] = value.reshape(1)
            continue
        out[name] = _power_series(np.broadcast_to(value, _NODES), order, point.parameter)
    return out


def _power_series(samples: Array, order: int, name: str) -> Array:
    """Return power-series coefficients in t of samples at Chebyshev's nodes, ``(order + 1,)``."""
    fix = "choose another parameter or values nearer to the expansion point"
    if not np.all(np.isfinite(samples)):
        reason = "a parameter monomial that is not finite about the expansion point"
        raise bad(name, reason, "a parameter that enters as a power series", fix)
    top = float(np.max(np.abs(samples)))
    coefficients = chebyshev.chebfit(chebyshev.chebpts1(_NODES), samples, _NODES - 1)
    kept = np.flatnonzero(np.abs(coefficients) > _NOISE * top)
    last = int(kept[-1]) if len(kept) else 0
    if last == _NODES - 1 and abs(coefficients[-1]) > _MOST_TAIL * top:
        reason = "a dependence that no polynomial of degree 23 follows"
        raise bad(name, reason, "a parameter that enters as a power series", fix)
    powers = chebyshev.cheb2poly(coefficients[: last + 1])
    # What is round-off in a polynomial would pass for a term of the series.
    powers[np.abs(powers) <= 16 * _NOISE * top] = 0.0
    out = np.zeros(order + 1)
    out[: min(len(powers), order + 1)] = powers[: order + 1]
    return out


# ---------------------------------------------------------------- the effective operator


@dataclass(frozen=True)
class ResonantOperator:
    """Power series of the effective operator, ``s = centre + eigenvalues of sum_x h_x x``.

    Attributes
    ----------
    centre : complex
        Exponent (per radian) about which the others lie.
    modes : tuple of int
        Mode, from 1, of each basis function, those of the resonance first.
    gaps : ndarray
        What each exponent lacks of ``centre`` at the expansion point, imaginary, ``(r,)``.
    exponents : tuple of ndarray
        Powers of (eps, sigma, delta, gap) of the terms of degree 1, 2, ..., ``(M_k, 4)``.
    terms : tuple of ndarray
        The terms, ``(M_k, r, r)``.
    conservative : bool
        Whether the undamped part has the symmetric form.
    """

    centre: complex
    modes: tuple[int, ...]
    gaps: Complex
    exponents: tuple[NDArray[np.intp], ...]
    terms: tuple[Complex, ...]
    conservative: bool

    @property
    def order(self) -> int:
        """Highest total degree."""
        return len(self.terms)

    @property
    def size(self) -> int:
        """Number r of exponents that meet."""
        return len(self.modes)

    @property
    def damped(self) -> bool:
        """True where damping does anything."""
        return any(
            bool(np.any(value[powers[:, 2] > 0]))
            for powers, value in zip(self.exponents, self.terms, strict=True)
        )

    def polynomials(self, eps: float, delta: float, order: int) -> Complex:
        """Return the matrix coefficients of the powers of sigma, ``(order + 1, r, r)``.

        For the size eps of the periodic part and delta of the damping, to a total degree.
        """
        out = np.zeros((order + 1, self.size, self.size), dtype=complex)
        for powers, values in zip(self.exponents[:order], self.terms[:order], strict=True):
            factors = eps ** powers[:, 0] * delta ** powers[:, 2]
            np.add.at(out, powers[:, 1], factors[:, None, None] * values)
        return out


def resonant_operator(
    point: Point, resonance: Resonance, order: int, merge: float, conservative: bool
) -> ResonantOperator:
    """Return the effective operator of a resonance, to a total degree.

    Raises
    ------
    BadInput
        If the constant system has a defective or no such exponent.
    """
    series = _generator(point, order)
    start = series.pop(_ZERO)
    basis = _basis(start[0], resonance, 2 * np.pi / point.system.period, merge)
    columns = _Columns(series, basis, len(start))
    effective, wave = recursion(columns, order)
    terms: Graded = [np.zeros((1, len(basis.modes), len(basis.modes)), dtype=complex), *effective]
    if conservative:
        terms = _symmetric(columns, [columns.start, *wave[:-1]], terms, basis)
    return ResonantOperator(
        basis.centre,
        basis.modes,
        basis.gaps,
        tuple(columns.powers(k) for k in range(1, order + 1)),
        tuple(terms[1:]),
        conservative,
    )


class _Basis(NamedTuple):
    """Eigenvectors of the constant system and the exponents that meet."""

    values: Complex
    vectors: Complex
    turning: float
    members: tuple[tuple[int, int], ...]
    """Number of the eigenvalue and harmonic of each, those of the resonance first."""
    modes: tuple[int, ...]
    centre: complex
    gaps: Complex


def _basis(start: Array, resonance: Resonance, turning: float, merge: float) -> _Basis:
    """Return the eigenvectors, normed in the symplectic form, and the members of the resonance."""
    values, vectors = (item.astype(complex) for item in np.linalg.eig(start))
    fix = "choose other parameter values"
    # Beyond this condition of the eigenvectors an exponent counts as defective.
    if np.linalg.cond(vectors) > 1e8:
        reason = "a multiple exponent of the mean system"
        raise bad(resonance.label, reason, "a mean system away from divergence", fix)
    size = IMAGINARY * float(np.max(np.abs(values)))
    form = np.abs(np.diagonal(form_matrix(vectors)))
    turns = (np.abs(values.real) <= size) & (np.abs(values.imag) > size)
    vectors = vectors / np.sqrt(np.where(turns & (form > 1e-8), form, 1.0))
    values = np.where(turns, 1j * values.imag, values)
    rising = np.argsort(np.abs(values.imag), kind="stable")
    upper, lower = (rising[(turns & (side * values.imag > 0))[rising]] for side in (1, -1))
    # Modes that do not oscillate are the lowest, and have numbers all the same.
    idle = len(values) // 2 - len(upper)
    i, j = (mode - 1 - idle for mode in resonance.modes)
    if min(i, j) < 0:
        reason = f"{idle} modes that do not oscillate, on the mean"
        raise bad(resonance.label, reason, "modes that do", fix)
    first = int(upper[i])
    second = int((upper if resonance.kind == "difference" else lower)[j])
    n = resonance.harmonic
    shift = n // 2 if resonance.kind != "difference" else round(values[first].imag / turning)
    members = [(first, shift), (second, shift - n)]
    levels = [values[k] - 1j * m * turning for k, m in members]
    centre = complex(np.mean(levels))
    # With its conjugates near, the whole is kept free of a preference for either.
    real = 0.5j * turning * round(2 * centre.imag / turning)
    if abs(centre - real) <= merge * turning:
        centre = real
    gaps = [level - centre for level in levels]
    for k in np.concatenate([upper, lower]).tolist():
        nearest = round((values[k] - centre).imag / turning)
        gap = values[k] - 1j * nearest * turning - centre
        if (k, nearest) not in members and abs(gap) <= merge * turning:
            members.append((k, nearest))
            gaps.append(gap)
    number = {int(k): p + 1 + idle for side in (upper, lower) for p, k in enumerate(side)}
    modes = tuple(number[k] for k, _ in members)
    return _Basis(
        values, vectors, turning, tuple(members), modes, centre, np.array(gaps, dtype=complex)
    )


class _Columns:
    """Omega of the Floquet operator in modal coordinates, for Bloch's recursion.

    A homogeneous part is an array over monomials, harmonics (in the FFT's order), modes and the
    exponents that meet, ``(M_k, nt, 2n, r)``.  ``act`` remembers the parts that it was given, one
    degree after the other: the terms of degree d of the operator act on the part d degrees before.
    """

    def __init__(self, series: Series, basis: _Basis, samples: int) -> None:
        width = len(basis.members)
        damped, apart = any(index[2] for index in series), bool(np.any(basis.gaps))
        # The variables that occur: eps, sigma, delta, gap.
        self._names = [0, 1, *([2] if damped else []), *([3] if apart else [])]
        self.count = len(self._names)
        inverse = np.linalg.inv(basis.vectors)
        self._terms: dict[int, list[tuple[int, Complex]]] = {}
        for index, value in series.items():
            degree = sum(index)
            place = self.powers(degree).tolist().index([*index, 0])
            modal = inverse @ value @ basis.vectors
            self._terms.setdefault(degree, []).append((place, modal))
        self._before: list[Complex] = []
        self._rows = np.array([m % samples for _, m in basis.members])
        self._places = np.array([k for k, _ in basis.members])
        harmonics = np.fft.fftfreq(samples, 1 / samples)
        distance = basis.values - 1j * basis.turning * harmonics[:, None] - basis.centre
        distance[self._rows, self._places] = 1.0
        self._resolvent = -1.0 / distance[:, :, None]
        self._resolvent[self._rows, self._places] = 0.0
        self.start = np.zeros((1, samples, len(basis.values), width), dtype=complex)
        self.start[0, self._rows, self._places, np.arange(width)] = 1.0
        self._gaps = self.start[0] * basis.gaps if apart else None

    def powers(self, degree: int) -> NDArray[np.intp]:
        """Return the powers of (eps, sigma, delta, gap) of the monomials of a degree."""
        rows = monomials(self.count, degree)
        out = np.zeros((len(rows), 4), dtype=np.intp)
        out[:, self._names] = rows
        return out

    def act(self, column: Complex) -> Complex:
        """Return the part of (H - H0) Omega that is one degree higher than ``column``."""
        self._before.append(np.fft.ifft(column, axis=1))
        total = len(self._before)
        out = np.zeros((len(monomials(self.count, total)), *column.shape[1:]), dtype=complex)
        for degree, terms in self._terms.items():
            if degree <= total:
                table = product_table(self.count, degree, total - degree)
                for place, matrix in terms:
                    out[table[place]] += matrix @ self._before[-degree]
        out = np.fft.fft(out, axis=1)
        if total == 1 and self._gaps is not None:
            out[-1] += self._gaps
        return out

    def resolve(self, column: Complex) -> Complex:
        """Return the column over the distance of its exponents, without those that meet."""
        return column * self._resolvent

    def project(self, column: Complex) -> Complex:
        """Return the rows of the exponents that meet, ``(M_k, r, r)``."""
        return column[:, self._rows, self._places]

    def combine(self, column: Complex, effective: Complex) -> Complex:
        """Return a column times an effective operator."""
        flat = column.reshape(len(column), -1, column.shape[-1])
        return _times_graded(flat, effective, self.count).reshape(-1, *column.shape[1:])


def _times_graded(first: Complex, second: Complex, count: int) -> Complex:
    """Return the product of homogeneous polynomials of matrices, monomials first."""
    degrees = degree_of(len(first), count), degree_of(len(second), count)
    shape = len(monomials(count, sum(degrees))), first.shape[1], second.shape[2]
    out = np.zeros(shape, dtype=complex)
    for places, matrix in zip(product_table(count, *degrees), first, strict=True):
        out[places] += matrix @ second
    return out


def _part(first: Graded, second: Graded, total: int, count: int) -> Complex:
    """Return the part of one degree of a product, as far as the parts of both are known."""
    least, most = max(0, total + 1 - len(second)), min(total, len(first) - 1)
    parts = [_times_graded(first[k], second[total - k], count) for k in range(least, most + 1)]
    return np.asarray(sum(parts[1:], parts[0]))


def _symmetric(columns: _Columns, wave: Graded, terms: Graded, basis: _Basis) -> Graded:
    """Return the effective operator in the basis where the form stays the same at every order."""
    count, order = columns.count, len(terms)
    still = [columns.powers(k)[:, 2] == 0 for k in range(order)]
    undamped = [
        np.where(keep[:, None, None, None], part, 0.0)
        for keep, part in zip(still, wave, strict=False)
    ]
    metric, width = form_matrix(basis.vectors), wave[0].shape[-1]
    right = [(metric @ part).reshape(len(part), -1, width) for part in undamped]
    left = [part.reshape(len(part), -1, width).conj().swapaxes(1, 2) for part in undamped]
    form = [_part(left, right, k, count) for k in range(len(wave))]
    gram = form[0][0]
    scaled = np.linalg.inv(gram)
    turned = [scaled @ part for part in form]
    root = [np.eye(width, dtype=complex)[None]]
    inverse = root.copy()
    for k in range(1, len(turned)):
        square = _part(root, root, k, count) if k > 1 else np.zeros_like(turned[k])
        root.append((turned[k] - square) / 2)
        inverse.append(-_part(root, inverse, k, count))
    half = [_part(root, terms, k, count) for k in range(order)]
    out = [_part(half, inverse, k, count) for k in range(order)]
    for keep, part in zip(still, out, strict=True):
        # Round-off alone: the undamped part is skew in the form G.
        value = part[keep]
        part[keep] = (value - scaled @ value.conj().swapaxes(1, 2) @ gram) / 2
    return out
