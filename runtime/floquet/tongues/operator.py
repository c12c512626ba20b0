"""Effective operator of a parametric resonance: the Floquet operator on the exponents that meet.

The Floquet operator L(theta) - d/dtheta is reduced to the few harmonics of the few modes whose
exponents coincide, by Bloch's recursion in several indices.  Where the undamped flow is symplectic
the result is brought to the symmetric form, h^H G + G h = 0 in the undamped part, so that its
truncations have exponents in the pairs (s, -conj s) of the whole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....generated import hill_recursion
from ...core.errors import bad
from ..krein import form_matrix
from .expansion import ZERO, Index, Point, RealSeries, Series, add, degree, generator_series
from .resonances import Resonance

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Of Bloch's recursion as it was emitted.
HIGHEST = 10
_GAP: Index = (0, 0, 0, 1)
# Condition of the eigenvectors of the constant system beyond which an exponent counts as defective.
_DEFECTIVE = 1e8


@dataclass(frozen=True)
class ResonantOperator:
    """Power series of the effective operator, ``s = centre + eigenvalues of sum_x h_x x``.

    Attributes
    ----------
    centre : complex
        Exponent (per radian) about which the others lie.
    members : tuple of (int, int)
        Eigenvalue number of the constant system and harmonic of each basis function; the first two
        are those of the resonance.
    modes : tuple of int
        Mode, from 1, of each basis function; 0 where its exponent is not imaginary.
    gaps : ndarray
        What each exponent lacks of ``centre`` at the expansion point, imaginary, ``(r,)``.
    terms : dict
        From the index (eps, sigma, delta, gap) to an ``(r, r)`` matrix.
    gram : ndarray or None
        G of the symmetric form, ``(r, r)``; None where the system is not conservative.
    order : int
        Highest total degree.
    """

    centre: complex
    members: tuple[tuple[int, int], ...]
    modes: tuple[int, ...]
    gaps: ComplexArray
    terms: Series
    gram: ComplexArray | None
    order: int

    @property
    def size(self) -> int:
        """Number r of exponents that meet."""
        return len(self.members)

    def polynomials(self, eps: float, delta: float, order: int) -> ComplexArray:
        """Return the matrix coefficients of the powers of sigma, ``(order + 1, r, r)``.

        Parameters
        ----------
        eps, delta : float
            Size of the periodic part and of the damping.
        order : int
            Total degree to keep.
        """
        out = np.zeros((order + 1, self.size, self.size), dtype=complex)
        for (i, j, k, _), value in self.terms.items():
            if i + j + k + _ <= order:
                out[j] += eps**i * delta**k * value
        return out


@dataclass(frozen=True)
class _Basis:
    """Eigenvectors of the constant system and the exponents that meet."""

    values: ComplexArray
    vectors: ComplexArray
    inverse: ComplexArray
    members: tuple[tuple[int, int], ...]
    modes: tuple[int, ...]
    centre: complex
    gaps: ComplexArray


def resonant_operator(
    point: Point, resonance: Resonance, order: int, merge: float, symplectic: bool
) -> ResonantOperator:
    """Return the effective operator of a resonance.

    Parameters
    ----------
    point : Point
        The expansion point; the two exponents meet there.
    resonance : Resonance
        Which exponents.
    order : int
        Total degree.
    merge : float
        Distance of exponents, in harmonics of the period, up to which more of them are taken in.
    symplectic : bool
        Whether the undamped system is conservative.

    Raises
    ------
    BadInput
        If the constant system has a defective or no such exponent.
    """
    series = _scaled(generator_series(point, order))
    turning = point.turning
    start = series[ZERO][0]
    basis = _basis(start, resonance, turning, merge)
    modal: Series = {
        index: basis.inverse @ value @ basis.vectors
        for index, value in series.items()
        if index != ZERO
    }
    columns, terms = _bloch(modal, basis, turning, order, len(series[ZERO]))
    gram: ComplexArray | None = None
    if symplectic:
        metric = form_matrix(basis.vectors)
        gram, terms = _symmetric(columns, terms, metric, order)
    return ResonantOperator(
        basis.centre, basis.members, basis.modes, basis.gaps, terms, gram, order
    )


def _scaled(series: RealSeries) -> RealSeries:
    """Return the generator of (q/s, p s), so that units do not pass for bad condition."""
    start = series[ZERO][0]
    n = len(start) // 2
    flexibility = np.abs(np.diagonal(start[:n, n:]))
    stiffness = np.maximum(np.abs(np.diagonal(start[n:, :n])), 1 / flexibility)
    # Powers of two make the scaling free of rounding.
    size = np.exp2(np.round(np.log2(flexibility / stiffness) / 4))
    scale = np.concatenate([size, 1 / size])
    return {index: value / scale[:, None] * scale for index, value in series.items()}


def _basis(start: Array, resonance: Resonance, turning: float, merge: float) -> _Basis:
    """Return the eigenvectors, normed in the symplectic form, and the members of the resonance."""
    values, vectors = np.linalg.eig(start)
    values, vectors = values.astype(complex), vectors.astype(complex)
    if np.linalg.cond(vectors) > _DEFECTIVE:
        raise bad(
            resonance.label,
            "a multiple exponent of the mean system",
            "a mean system away from divergence",
            "choose other parameter values",
        )
    size = float(np.max(np.abs(values)))
    form = np.abs(np.diagonal(form_matrix(vectors)))
    turns = (np.abs(values.real) <= 1e-7 * size) & (np.abs(values.imag) > 1e-7 * size)
    vectors = vectors / np.sqrt(np.where(turns & (form > 1e-8), form, 1.0))
    values = np.where(turns, 1j * values.imag, values)
    rising = np.argsort(np.abs(values.imag), kind="stable")
    upper, lower = (rising[(turns & (side * values.imag > 0))[rising]] for side in (1, -1))
    # Modes that do not oscillate are the lowest, and have numbers all the same.
    idle = len(values) // 2 - len(upper)
    i, j = (mode - 1 - idle for mode in resonance.modes)
    if min(i, j) < 0:
        raise bad(
            resonance.label,
            f"{idle} modes that do not oscillate, on the mean",
            "modes that do",
            "choose other parameter values",
        )
    first = int(upper[i])
    second = int((upper if resonance.kind == "difference" else lower)[j])
    n = resonance.harmonic
    shift = n // 2 if resonance.kind != "difference" else round(values[first].imag / turning)
    partner = shift - n
    levels = [values[k] - 1j * m * turning for k, m in ((first, shift), (second, partner))]
    centre = complex(np.mean(levels))
    # With its own conjugates near, the whole is kept free of a preference for either.
    real = 0.5j * turning * round(2 * centre.imag / turning)
    if abs(centre - real) <= merge * turning:
        centre = real
    members = [(first, shift), (second, partner)]
    gaps = [level - centre for level in levels]
    for k in np.concatenate([upper, lower]).tolist():
        nearest = round((values[k] - centre).imag / turning)
        gap = values[k] - 1j * nearest * turning - centre
        if (k, nearest) not in members and abs(gap) <= merge * turning:
            members.append((k, nearest))
            gaps.append(gap)
    number = {int(k): p + 1 + idle for side in (upper, lower) for p, k in enumerate(side)}
    return _Basis(
        values,
        np.asarray(vectors, dtype=complex),
        np.linalg.inv(vectors).astype(complex),
        tuple(members),
        tuple(number[k] for k, _ in members),
        centre,
        np.array(gaps, dtype=complex),
    )


class _Part:
    """Homogeneous part of a column: harmonics ``(nt, 2n, r)``, in the FFT's order, by index."""

    def __init__(self, terms: Series) -> None:
        self.terms = terms

    def __sub__(self, other: _Part) -> _Part:
        """Return the difference."""
        out = dict(self.terms)
        for index, value in other.terms.items():
            out[index] = out[index] - value if index in out else -value
        return _Part(out)


class _Algebra:
    """The callables of Bloch's recursion for the Floquet operator in modal coordinates.

    ``act`` remembers the columns that it was given, one order after the other: the terms of degree
    d of the operator act on the column of d orders before.

    Parameters
    ----------
    modal : dict
        Samples of the generator in modal coordinates by index, ``(nt, 2n, 2n)``.
    basis : _Basis
        The exponents that meet.
    turning : float
        2 pi/period.
    samples : int
        Number nt of angles.
    """

    def __init__(self, modal: Series, basis: _Basis, turning: float, samples: int) -> None:
        width = len(basis.members)
        self._modal, self._before = modal, list[Series]()
        self._rows = np.array([m % samples for _, m in basis.members])
        self._places = np.array([k for k, _ in basis.members])
        harmonics = np.fft.fftfreq(samples, 1 / samples)
        distance = basis.values - 1j * turning * harmonics[:, None] - basis.centre
        distance[self._rows, self._places] = 1.0
        self._resolvent = -1.0 / distance[:, :, None]
        self._resolvent[self._rows, self._places] = 0.0
        start = np.zeros((samples, len(basis.values), width), dtype=complex)
        start[self._rows, self._places, np.arange(width)] = 1.0
        self.start = _Part({ZERO: start})
        self._gaps = start * basis.gaps

    def act(self, column: _Part) -> _Part:
        """Return the part of (H - H0) Omega that is one degree higher than ``column``."""
        first = not self._before
        self._before.append({i: np.fft.ifft(v, axis=0) for i, v in column.terms.items()})
        out: Series = {}
        for step, matrix in self._modal.items():
            if degree(step) <= len(self._before):
                for index, value in self._before[-degree(step)].items():
                    _accumulate(out, add(index, step), matrix @ value)
        moved = _Part({index: np.fft.fft(value, axis=0) for index, value in out.items()})
        if first and np.any(self._gaps):
            _accumulate(moved.terms, _GAP, self._gaps)
        return moved

    def resolve(self, column: _Part) -> _Part:
        """Return the column over the distance of its exponents, without those that meet."""
        return _Part({index: value * self._resolvent for index, value in column.terms.items()})

    def project(self, column: _Part) -> Series:
        """Return the rows of the exponents that meet, ``(r, r)`` by index."""
        return {index: value[self._rows, self._places] for index, value in column.terms.items()}

    def combine(self, column: _Part, effective: Series) -> _Part:
        """Return a column times an effective operator."""
        flat = {index: _flat(value) for index, value in column.terms.items()}
        shape = self._gaps.shape
        found = _product(flat, effective)
        return _Part({index: value.reshape(shape) for index, value in found.items()})


def _bloch(
    modal: Series, basis: _Basis, turning: float, order: int, samples: int
) -> tuple[Series, Series]:
    """Solve H Omega = Omega h with P Omega = P; return Omega (Fourier) and h by index."""
    algebra = _Algebra(modal, basis, turning, samples)
    solve: Callable[..., tuple[tuple[Series, ...], tuple[_Part, ...]]]
    solve = getattr(hill_recursion, f"order_{order}")
    effective, wave = solve(
        algebra.start, algebra.act, algebra.resolve, algebra.project, algebra.combine
    )
    columns, terms = dict(algebra.start.terms), dict[Index, ComplexArray]()
    for part in wave[:-1]:
        columns |= part.terms
    for matrices in effective:
        terms |= {index: value for index, value in matrices.items() if np.any(value)}
    return columns, terms


def _symmetric(
    columns: Series, terms: Series, metric: ComplexArray, order: int
) -> tuple[ComplexArray, Series]:
    """Return G and the effective operator in the basis where the form stays G at every order."""
    undamped = {index: value for index, value in columns.items() if index[2] == 0}
    form = _form(undamped, metric, order - 1)
    gram = form[ZERO]
    scaled = np.linalg.inv(gram).astype(np.complex128)
    turned: Series = {index: scaled @ value for index, value in form.items()}
    turned[ZERO] = np.diag(np.ones(len(gram), dtype=complex))
    root = _root(_graded(turned, order - 1))
    inverse = _reciprocal(root)
    middle = _graded(terms, order)
    left = [_part_of(root, middle, k) for k in range(order + 1)]
    out: Series = {}
    for k in range(1, order + 1):
        out |= _part_of(left, inverse, k)
    for index, value in out.items():
        if index[2] == 0:
            # Round-off alone: the undamped part is skew in the form G.
            out[index] = (value - scaled @ value.conj().T @ gram) / 2
    return gram, out


def _form(columns: Series, metric: ComplexArray, order: int) -> Series:
    """Return the mean of Omega^H (-i J) Omega over the period, by index."""
    left: Series = {index: _flat(value).conj().T for index, value in columns.items()}
    right = {index: _flat(metric @ value) for index, value in columns.items()}
    out: Series = {}
    first, second = _graded(left, order), _graded(right, order)
    for k in range(order + 1):
        out |= _part_of(first, second, k)
    return out


def _flat(value: ComplexArray) -> ComplexArray:
    return value.reshape(-1, value.shape[-1])


def _accumulate(target: Series, index: Index, value: ComplexArray) -> None:
    """Add a value to one coefficient of a series."""
    target[index] = target[index] + value if index in target else value


def _product(first: Series, second: Series) -> Series:
    """Return the product of two series of matrices."""
    out: Series = {}
    for i, a in first.items():
        for j, b in second.items():
            # One dimension is long, the others tiny: threads of a BLAS would only wait.
            _accumulate(out, add(i, j), np.einsum("ik,kl->il", a, b))
    return out


def _graded(series: Series, order: int) -> list[Series]:
    """Return the homogeneous parts of a series, by degree."""
    parts: list[Series] = [{} for _ in range(order + 1)]
    for index, value in series.items():
        if degree(index) <= order:
            parts[degree(index)][index] = value
    return parts


def _part_of(
    first: list[Series], second: list[Series], total: int, start: int = 0, stop: int = 0
) -> Series:
    """Return the part of one degree of a product; ``start`` and ``stop`` leave ends out."""
    out: Series = {}
    for k in range(start, total + 1 - stop):
        if k < len(first) and total - k < len(second):
            for index, value in _product(first[k], second[total - k]).items():
                _accumulate(out, index, value)
    return out


def _root(series: list[Series]) -> list[Series]:
    """Return the square root of a series of matrices that begins with the unit matrix."""
    parts = [series[0]]
    for total in range(1, len(series)):
        part = {index: value / 2 for index, value in series[total].items()}
        for index, value in _part_of(parts, parts, total, 1, 1).items():
            _accumulate(part, index, -value / 2)
        parts.append(part)
    return parts


def _reciprocal(series: list[Series]) -> list[Series]:
    """Return the inverse of a series of matrices that begins with the unit matrix."""
    parts = [series[0]]
    for total in range(1, len(series)):
        found = _part_of(series, parts, total, 1)
        parts.append({index: -value for index, value in found.items()})
    return parts
