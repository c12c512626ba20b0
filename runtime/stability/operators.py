"""Effective operator of a parametric resonance: the Floquet operator on the exponents that meet.

The Floquet operator L(theta) - d/dtheta of the canonical variables is expanded about the mean of
the undamped system at the speed w0 of the resonance.  All that is periodic, all that is damped and
the detuning sigma are of first order, with 1/w = (1 + sigma)/w0, so that K/w^2 and C/w are exact
polynomials; the part of degree k is a polynomial in sigma.  Bloch's recursion
(:mod:`..hill.bloch`) reduces the operator to the few harmonics of the few modes whose exponents
coincide; what keeps them apart at w0 is of first order too.  Where the undamped flow is symplectic
the result is brought to the symmetric form, h^H G + G h = 0 in the undamped part, so that its
truncations have exponents in the pairs (s, -conj s) of the whole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import DAMPING, Array, LinearPeriodic
from ..core.trigonometric import even_angles
from ..hill.bloch import recursion
from ..periodic.equation import SPEED_POWER, sampled
from ..periodic.signatures import form_matrix
from .meetings import IMAGINARY, Resonance

Complex = NDArray[np.complex128]
# Samples over a period of the crank angle by degree and power of sigma.
Series = dict[tuple[int, int], Array]
# Parts of a series by degree: coefficients of the powers of sigma, ``(k + 1, ...)`` of degree k.
Graded = list[Complex]

_ZERO = (0, 0)
_ARRAYS = ("M", "A", "B", *DAMPING, "K", "Kg")
# Distance of other exponents, in harmonics of the period, up to which they are taken together with
# the two that meet: on Smith's rig a pair alone diverges where others are nearer.
_TOGETHER = 0.04


# ---------------------------------------------------------------- the generator as a series


def _generator(
    system: LinearPeriodic, parameters: Mapping[str, float], speed: float, order: int
) -> Series:
    """Return the samples of L of y' = L(theta) y, each ``(nt, 2n, 2n)``."""
    n = system.size
    arrays = _arrays(system, parameters, speed, order)
    if _ZERO not in arrays["M"]:
        raise bad("LinearPeriodic.terms", "no mass term M", "a positive definite M", "add the term")
    flexibility = _inverse(arrays["M"], order)
    gyro = arrays["A"]
    back = _sum({i: np.swapaxes(a, -1, -2) for i, a in gyro.items()}, _minus(arrays["C"]))
    slope = _times(flexibility, gyro, order)
    coupled = _minus(_times(back, slope, order))
    lower = _sum(arrays["B"], _minus(arrays["K"]), _minus(arrays["D"]), coupled)
    out: Series = {}
    first, last = slice(0, n), slice(n, 2 * n)
    blocks = (
        (first, first, _minus(slope)),
        (first, last, flexibility),
        (last, first, lower),
        (last, last, _times(back, flexibility, order)),
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
        *({(i[0] + j[0], i[1] + j[1]): a @ b} for (i, a), (j, b) in pairs if i[0] + j[0] <= order)
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


def _arrays(
    system: LinearPeriodic, parameters: Mapping[str, float], speed: float, order: int
) -> dict[str, Series]:
    """Return M, A, B, C, D and K + Kg of the equation in the angle, as series of samples."""
    reach = sampled(system, forcing=False).harmonics
    # So many angles tell all harmonics of a product of ``order`` factors apart.
    wanted = 2 * (order * (min(reach, 128) if reach >= 0 else 128) + 40)
    count = min(2 ** int(np.ceil(np.log2(wanted))), 4096)
    theta = even_angles(system.period, count)
    scales = system.scale_values(**parameters)
    out: dict[str, Series] = {name: {} for name in ("M", "A", "B", *DAMPING, "K")}
    for term in system.terms:
        scale = 1.0 if term.scale is None else float(scales[term.scale])
        if term.array not in _ARRAYS or scale == 0.0:
            continue
        values = scale * np.asarray(term(theta), dtype=float)
        parts = [values]
        if not term.constant:
            mean = np.broadcast_to(values.mean(axis=0), values.shape)
            parts = [mean, values - mean]
        name = "K" if term.array == "Kg" else term.array
        power = SPEED_POWER[term.array] + term.power
        for (j, factor), (extra, part) in product(
            enumerate(_binomial(-power, order)), enumerate(parts)
        ):
            degree = j + extra + (term.array in DAMPING)
            if degree <= order and factor:
                out[name] = _sum(out[name], {(degree, j): speed**power * factor * part})
    return out


def _binomial(power: int, order: int) -> list[float]:
    """Return the coefficients of (1 + sigma)**power, zeros where it has ended."""
    return list(accumulate(range(order), lambda c, k: c * (power - k) / (k + 1), initial=1.0))


# ---------------------------------------------------------------- the effective operator


@dataclass(frozen=True)
class ResonantOperator:
    """Series of the effective operator, ``s = centre + eigenvalues of the sum of the terms``."""

    speed: float  # speed w0 [rad/s] about which it is expanded
    centre: complex  # exponent (per radian) about which the others lie
    modes: tuple[int, ...]  # mode, from 1, of each basis function, those of the resonance first
    gaps: Complex  # what each exponent lacks of centre at the expansion point, imaginary, (r,)
    # Coefficients of the powers of sigma, (k + 1, r, r), of degree k = 1, 2, ...; the same without
    # damping.
    terms: tuple[Complex, ...]
    undamped: tuple[Complex, ...]
    conservative: bool  # whether the undamped part has the symmetric form

    @property
    def damped(self) -> bool:
        """True where damping does anything."""
        return self.terms is not self.undamped

    def polynomials(self, order: int, *, undamped: bool = False) -> Complex:
        """Return the coefficients of the powers of sigma to a total degree, (order + 1, r, r)."""
        out = np.zeros((order + 1, len(self.modes), len(self.modes)), dtype=complex)
        for part in (self.undamped if undamped else self.terms)[:order]:
            out[: len(part)] += part
        return out


def resonant_operator(
    system: LinearPeriodic,
    parameters: Mapping[str, float],
    resonance: Resonance,
    speed: float,
    order: int,
    conservative: bool,
) -> ResonantOperator:
    """Return the effective operator of a resonance at a speed, to a total degree.

    Raises ``BadInput`` if the mean system has a defective or no such exponent, or no mass.
    """
    series = _generator(system.without(*DAMPING), parameters, speed, order)
    start = series.pop(_ZERO)
    basis = _basis(start[0], resonance, 2 * np.pi / system.period)
    columns = _Columns(series, basis, len(start))
    effective, wave = recursion(columns, order)
    none = np.zeros((1, len(basis.modes), len(basis.modes)), dtype=complex)
    undamped: Graded = [none, *effective]
    terms = undamped
    if system.is_damped(**parameters):
        series = _generator(system, parameters, speed, order)
        del series[_ZERO]
        damped, _ = recursion(_Columns(series, basis, len(start)), order)
        terms = [undamped[0], *damped]
    if conservative:
        undamped, terms = _symmetric([columns.start, *wave[:-1]], undamped, terms, basis)
    calm = tuple(undamped[1:])
    whole = calm if terms is undamped else tuple(terms[1:])
    own = (basis.centre, basis.modes, basis.gaps)
    return ResonantOperator(speed, *own, whole, calm, conservative)


class _Basis(NamedTuple):
    """Eigenvectors of the constant system and the exponents that meet."""

    values: Complex
    vectors: Complex
    turning: float
    # Number of the eigenvalue and harmonic of each, those of the resonance first.
    members: tuple[tuple[int, int], ...]
    modes: tuple[int, ...]
    centre: complex
    gaps: Complex


def _basis(start: Array, resonance: Resonance, turning: float) -> _Basis:
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
    if abs(centre - real) <= _TOGETHER * turning:
        centre = real
    gaps = [level - centre for level in levels]
    for k in np.concatenate([upper, lower]).tolist():
        nearest = round((values[k] - centre).imag / turning)
        gap = values[k] - 1j * nearest * turning - centre
        if (k, nearest) not in members and abs(gap) <= _TOGETHER * turning:
            members.append((k, nearest))
            gaps.append(gap)
    number = {int(k): p + 1 + idle for side in (upper, lower) for p, k in enumerate(side)}
    modes = tuple(number[k] for k, _ in members)
    return _Basis(
        values, vectors, turning, tuple(members), modes, centre, np.array(gaps, dtype=complex)
    )


class _Columns:
    """Omega of the Floquet operator in modal coordinates, for Bloch's recursion.

    A part of degree k is an array over powers of sigma, harmonics (in the FFT's order), modes and
    the exponents that meet, ``(k + 1, nt, 2n, r)``.  ``act`` remembers the parts that it was given,
    one degree after the other: the terms of degree d act on the part d degrees before.
    """

    def __init__(self, series: Series, basis: _Basis, samples: int) -> None:
        width = len(basis.members)
        inverse = np.linalg.inv(basis.vectors)
        self._terms = [
            (degree, power, inverse @ value @ basis.vectors)
            for (degree, power), value in series.items()
        ]
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
        self._gaps = self.start[0] * basis.gaps

    def act(self, column: Complex) -> Complex:
        """Return the part of (H - H0) Omega that is one degree higher than ``column``."""
        self._before.append(np.fft.ifft(column, axis=1))
        total = len(self._before)
        out = np.zeros((total + 1, *column.shape[1:]), dtype=complex)
        for degree, power, matrix in self._terms:
            if degree <= total:
                part = matrix @ self._before[-degree]
                out[power : power + len(part)] += part
        out = np.fft.fft(out, axis=1)
        if total == 1:
            out[0] += self._gaps
        return out

    def resolve(self, column: Complex) -> Complex:
        """Return the column over the distance of its exponents, without those that meet."""
        return column * self._resolvent

    def project(self, column: Complex) -> Complex:
        """Return the rows of the exponents that meet, ``(k + 1, r, r)``."""
        return column[:, self._rows, self._places]

    def combine(self, column: Complex, effective: Complex) -> Complex:
        """Return a column times an effective operator."""
        flat = column.reshape(len(column), -1, column.shape[-1])
        return _product(flat, effective).reshape(-1, *column.shape[1:])


def _product(first: Complex, second: Complex) -> Complex:
    """Return the product of polynomials in sigma whose coefficients are matrices."""
    shape = len(first) + len(second) - 1, first.shape[1], second.shape[2]
    out = np.zeros(shape, dtype=complex)
    for power, matrix in enumerate(second):
        out[power : power + len(first)] += first @ matrix
    return out


def _part(first: Graded, second: Graded, total: int) -> Complex:
    """Return the part of one degree of a product, as far as the parts of both are known."""
    least, most = max(0, total + 1 - len(second)), min(total, len(first) - 1)
    parts = [_product(first[k], second[total - k]) for k in range(least, most + 1)]
    return np.asarray(sum(parts[1:], parts[0]))


def _symmetric(
    wave: Graded, undamped: Graded, terms: Graded, basis: _Basis
) -> tuple[Graded, Graded]:
    """Return both effective operators in the basis where the form is the same at every order."""
    width = wave[0].shape[-1]
    metric = form_matrix(basis.vectors)
    right = [(metric @ part).reshape(len(part), -1, width) for part in wave]
    left = [part.reshape(len(part), -1, width).conj().swapaxes(1, 2) for part in wave]
    form = [_part(left, right, k) for k in range(len(wave))]
    gram = form[0][0]
    scaled = np.linalg.inv(gram)
    root = [np.eye(width, dtype=complex)[None]]
    inverse = root.copy()
    for k in range(1, len(form)):
        turned = scaled @ form[k]
        square = _part(root, root, k) if k > 1 else np.zeros_like(turned)
        root.append((turned - square) / 2)
        inverse.append(-_part(root, inverse, k))

    def carried(old: Graded) -> Graded:
        half = [_part(root, old, k) for k in range(len(old))]
        return [_part(half, inverse, k) for k in range(len(old))]

    plain = carried(undamped)
    # Round-off alone: the undamped part is skew in the form G.
    wrong = [(part + scaled @ part.conj().swapaxes(1, 2) @ gram) / 2 for part in plain]
    out = [part - other for part, other in zip(plain, wrong, strict=True)]
    if terms is undamped:
        return out, out
    return out, [part - other for part, other in zip(carried(terms), wrong, strict=True)]
