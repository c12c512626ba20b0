"""Monodromy matrices and Floquet multipliers of linear periodic systems of any size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.inputs import require_between
from ..core.plotting import Axes, multiplier_plane
from ..core.results import Check, DeferredChecks, Result, provenance
from .equation import Equation, equation_of
from .signatures import signatures_of
from .transition import Method, choose, product, refined, segments_of

ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Error of a multiplier from which it says nothing about stability.
_TELLING = 0.1
# What parts of an undamped multiplier's error that cancel by chance count for, over their size: of
# systems of two and three freedoms at a tolerance of 1e-4, 949 values of 1000 are covered without
# it, 982 with a tenth and 996 with 0.3, the medians of estimate over error 11, 11 and 14.
_CANCELLED = 0.3
# What counts of the round-off that a matrix is allowed: a part is in the difference of two of them
# too, and all entries seldom err for the same multiplier, but where two have all but met.  With 1
# the estimates of 700 multipliers good to the last digits are 13 times the error at the least, and
# 275 in the middle.
ROUNDED = 0.125
# Powers of two from which growth hides the symplectic form in round-off.
_GROWTH = 50


@dataclass(frozen=True, kw_only=True)
class Monodromy(Result):
    """Monodromy matrices of the canonical variables (q, p = M q' + A q) over one period.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    matrix : ndarray
        Shape ``(*batch, 2n, 2n)``; the monodromy matrix is ``matrix * 2**exponent``.
    exponent : ndarray
        Power of two taken out where the growth would overflow, else 0; shape ``batch``.
    scale : ndarray
        Sizes of the state's components, shape ``(*batch, 2n)``; the error and the checks refer to
        the scaled matrix ``matrix[i, j] * scale[j] / scale[i]``.
    error : ndarray
        Shape ``batch``, in the norm that ``error_norm`` names.
    segments : ndarray
        Number of segments of the period, shape ``batch``.
    """

    speed: Array
    matrix: Array
    exponent: NDArray[np.int64]
    scale: Array
    segments: NDArray[np.int64]

    arrays_along: ClassVar = {
        "...": "speed exponent error segments",
        "... state state_1": "matrix",
        "... state": "scale",
    }

    @property
    def scaled(self) -> Array:
        """The matrices in scaled variables, shape ``(*batch, 2n, 2n)``."""
        value: Array = self.matrix / self.scale[..., :, None] * self.scale[..., None, :]
        return value

    @property
    def determinant(self) -> Array:
        """Determinant of each monodromy matrix, shape ``batch``; may underflow with damping."""
        sign, logarithm = np.linalg.slogdet(self.matrix)
        shift = self.matrix.shape[-1] * self.exponent * np.log(2.0)
        value: Array = sign * np.exp(logarithm + shift)
        return value


def monodromy(
    system: LinearPeriodic, speed: ArrayLike, *, rtol: float = 1e-10, **parameters: ArrayLike
) -> Monodromy:
    """Return the monodromy matrix of the canonical variables over one period.

    The equation is ``q' = M^-1 (p - A q)``,
    ``p' = A^T q' + B q - (K + Kg) q/w^2 - (C q' + D q)/w`` with theta as variable.  It is solved by
    collocation over equal segments of the period (:mod:`~.transition`).

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds w [rad/s], positive.
    rtol : float
        Wanted error, in the norm of ``error_norm``; 1e-13 to 1e-2.  Long periods with many
        oscillations may not reach it, because of round-off: see ``error``.
    **parameters : array_like
        Parameter values that replace the system's; they broadcast with ``speed``.  Geometry too,
        one number each, where the system can be made anew for it.

    Returns
    -------
    Monodromy
        Its checks: ``converged``, the error at the worst place against ``rtol`` or what round-off
        allows there; ``liouville``, the determinant against ``exp(-integral trace(M^-1 C)/w)``,
        where the matrix is well enough conditioned; and ``symplectic``, the defect of
        ``X^T J X = J`` over ``|X|^2``, where conservative.

    Raises
    ------
    BadInput
        If speeds or parameters are unusable (see :func:`~.equation.equation_of`), or more than a
        million segments would be needed.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> print(el.monodromy(system, speed=80.0).matrix.trace().round(4))
    2.0202
    """
    require_between("rtol", rtol, 1e-13, 1e-2, "choose 1e-8")
    equation = equation_of(system, speed, parameters)
    way, m = choose(equation, rtol), 2 * equation.size
    solutions, errors, segments = refined(equation, way, rtol, partial(_matrices, way), _gap)
    scaled, exponent, rounding = _stacked(solutions, (m, m), (), ())
    exponent, error = exponent.astype(np.int64), errors[:, 0]
    allowed = np.minimum(np.maximum(rtol, 100.0 * rounding), 1e-2)
    # The exponent stays only where the unscaled matrix would overflow.
    unit = np.concatenate([equation.scale, 1.0 / equation.scale], axis=1)
    size = np.log2(np.maximum(np.max(np.abs(scaled), axis=(-2, -1)), 1e-300)) + exponent
    spread = 2.0 * np.max(np.abs(np.log2(unit)), axis=1)
    kept = np.where(size + spread < 1000, 0, exponent)
    scaled = np.ldexp(scaled, (exponent - kept)[:, None, None])
    matrix = scaled * unit[:, :, None] / unit[:, None, :]
    batch = equation.batch
    return Monodromy(
        method="collocation over segments of the period",
        error=error.reshape(batch),
        error_norm="largest entry of the error, relative to the largest entry of the matrix, "
        "both in scaled variables",
        checks=DeferredChecks(partial(_matrix_checks, equation, scaled, kept, error, allowed)),
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=equation.speed.reshape(batch),
        matrix=matrix.reshape(*batch, m, m),
        exponent=kept.reshape(batch),
        scale=unit.reshape(*batch, m),
        segments=segments.reshape(batch),
    )


@dataclass(frozen=True, kw_only=True)
class FloquetMultipliers(Result):
    """Floquet multipliers: the eigenvalues of the monodromy matrix.

    Attributes
    ----------
    speed : ndarray
        Crank speeds [rad/s], shape ``batch``.
    multipliers : ndarray of complex
        Shape ``(*batch, 2n)``, by falling modulus, then by the size of the argument, upper half
        plane first; inf where one overflows.
    exponents : ndarray of complex
        Their logarithms, growth and turning per period; finite where a multiplier overflows.
    error : ndarray
        Absolute error of each multiplier, shape ``(*batch, 2n)``.
    signatures : ndarray of int8
        Krein signatures, shape ``(*batch, 2n)``: +1 or -1 on the unit circle of a conservative
        system; 0 off the circle, where multiplier are multiple and the form is indefinite, where
        errors leave the sign open, and wherever there is damping.  See :mod:`~.signatures`.
    period : float
        Period of the coefficients [rad].
    """

    speed: Array
    multipliers: ComplexArray
    exponents: ComplexArray
    signatures: NDArray[np.int8]
    period: float

    arrays_along: ClassVar = {
        "...": "speed stable growth",
        "... multiplier": "multipliers exponents error signatures",
    }
    exported: ClassVar[tuple[str, ...]] = ("stable", "growth")
    column_units: ClassVar = {"rad": "period"}

    @property
    def stable(self) -> NDArray[np.bool_]:
        """True where no multiplier is outside the unit circle by more than its error.

        An error of 0.1 or more says nothing: the multiplier then has to be inside by its error.
        """
        modulus = np.abs(self.multipliers)
        slack = np.where(self.error < _TELLING, self.error, -self.error)
        inside = np.isfinite(modulus) & (modulus <= 1.0 + slack)
        value: NDArray[np.bool_] = np.all(inside, axis=-1)
        return value

    @property
    def growth(self) -> Array:
        """Largest growth rate of the logarithm of the amplitude [1/s], shape ``batch``."""
        value: Array = np.max(self.exponents.real, axis=-1) * self.speed / self.period
        return value

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers and the unit circle into ``ax`` and return the axes."""
        ax = multiplier_plane(ax)
        values = self.multipliers.ravel()
        ax.plot(values.real, values.imag, "o", markersize=3)
        return ax


def floquet_multipliers(
    system: LinearPeriodic, speed: ArrayLike, *, rtol: float = 1e-8, **parameters: ArrayLike
) -> FloquetMultipliers:
    """Return the Floquet multipliers over one period, each with its error.

    Where growth hides the small multipliers in the rounding of the monodromy matrix, the product
    of its segments is decomposed without being formed, so that all multipliers keep their digits.
    Where damping makes multipliers small, their absolute error alone is held.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forcing plays no part.
    speed : array_like
        Crank speeds [rad/s], positive.
    rtol : float
        Wanted error of each multiplier, over the larger of 1 and its size; 1e-13 to 1e-2.
    **parameters : array_like
        Parameter values that replace the system's; they broadcast with ``speed``.  Geometry too,
        one number each, where the system can be made anew for it.

    Returns
    -------
    FloquetMultipliers
        Its checks: ``converged``, the error at the worst place against ``rtol`` or what round-off
        allows there; ``product``, the product of the multipliers against Liouville's determinant,
        where all of them are known; ``reciprocal pairs`` where undamped.

    Raises
    ------
    BadInput
        As :func:`monodromy`.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> found = el.floquet_multipliers(system, speed=[75.0, 80.0])
    >>> print(found.stable, abs(found.multipliers).max(axis=-1).round(4))
    [ True False] [1.     1.1526]
    """
    require_between("rtol", rtol, 1e-13, 1e-2, "choose 1e-8")
    equation = equation_of(system, speed, parameters)
    way, m = choose(equation, rtol), 2 * equation.size
    solutions, relative, segments = refined(
        equation, way, rtol, partial(_spectra, way), partial(_shifts, way)
    )
    _, power, eigenvalues, rounding, vectors = _stacked(solutions, (m, m), (), (m,), (m,), (m, m))
    exponent = power.astype(np.int64)
    with np.errstate(divide="ignore"):
        logarithm = np.log(np.abs(eigenvalues)) + exponent[:, None] * np.log(2.0)
    angle = np.angle(eigenvalues)
    error = np.log(relative.reshape(-1, m)) + np.maximum(logarithm, 0.0)
    divergence = equation.divergence()
    if m == 2:
        _second_from_determinant(logarithm, angle, error, divergence)
    else:
        _grade_hidden(equation, way, rtol, segments, exponent, (logarithm, angle, error))
    row, order = np.arange(len(angle))[:, None], multiplier_order(logarithm, angle)
    logarithm, angle, error = (value[row, order] for value in (logarithm, angle, error))
    with np.errstate(over="ignore"):
        modulus, absolute = np.exp(logarithm), np.exp(error)
    turning: ComplexArray = np.cos(angle) + 1j * np.where(
        np.abs(angle) == np.pi, 0.0, np.sin(angle)
    )
    finite = np.isfinite(modulus)
    values: ComplexArray = np.where(finite, np.where(finite, modulus, 0.0) * turning, np.inf)
    signs = np.zeros(values.shape, dtype=np.int8)
    if not equation.damped:
        vectors = np.take_along_axis(vectors, order[:, None, :], axis=-1)
        signs = signatures_of(vectors.astype(np.complex128), values, absolute)
        signs[exponent >= _GROWTH] = 0
    # What round-off allows, over the larger of 1 and the multiplier.
    with np.errstate(over="ignore", divide="ignore"):
        size = np.maximum(
            np.abs(eigenvalues), np.ldexp(1.0, np.clip(-exponent, -1000, 1000))[:, None]
        )
    least = 100.0 * np.max(rounding / size, axis=-1, initial=0.0)
    allowed = np.minimum(np.maximum(rtol, least), 1e-2)
    checks = partial(_multiplier_checks, equation, (logarithm, angle, error), divergence, allowed)
    shape = (*equation.batch, m)
    return FloquetMultipliers(
        method="eigenvalues of the monodromy matrix, by collocation over segments of the period",
        error=absolute.reshape(shape),
        error_norm="absolute, of each multiplier",
        checks=DeferredChecks(checks),
        provenance=provenance(system.changed_provenance(**parameters)),
        speed=equation.speed.reshape(equation.batch),
        multipliers=values.reshape(shape),
        exponents=(logarithm + 1j * angle).reshape(shape),
        signatures=signs.reshape(shape),
        period=equation.period,
    )


def _stacked(solutions: list[tuple[Array, ...]], *shapes: tuple[int, ...]) -> tuple[Array, ...]:
    """Return the arrays of all members, one row each; of given shapes where there is no member."""
    columns = zip(*solutions, strict=True) if solutions else [()] * len(shapes)
    return tuple(
        np.array(column).reshape(len(solutions), *shape)
        for column, shape in zip(columns, shapes, strict=True)
    )


def multiplier_order(logarithm: Array, angle: Array) -> NDArray[np.intp]:
    """Order by falling modulus, rounding aside, then by the argument's size, upper half first."""
    modulus = np.round(np.maximum(logarithm, -1e4), 6)
    return np.lexsort((-np.sign(angle), np.round(np.abs(angle), 9), -modulus), axis=-1)


def rounding_error(equation: Equation, segments: int) -> Array:
    """Return what round-off adds to a scaled matrix, over its largest entry, ``(nb,)``.

    Equal segments round alike, so that their errors add up; each loses a unit in the last place
    for every radian that its fastest living mode turns.
    """
    living = equation.frequency * np.exp(-equation.decay)
    turning = np.max(living, axis=1, initial=0.0) * equation.period
    value: Array = _EPS * (128.0 + 3.0 * segments + 3.0 * turning)
    return value


def _matrices(way: Method, equation: Equation, segments: int) -> tuple[NDArray[Any], ...]:
    """Return scaled monodromy matrices, the powers of two taken out of them, and round-off."""
    matrix, exponent = product(segments_of(equation, segments, way).maps)
    return matrix, exponent, rounding_error(equation, segments)


def _gap(coarse: tuple[Array, ...], fine: tuple[Array, ...]) -> tuple[Array, Array]:
    """Return the difference of matrices and round-off, over their largest entries, ``(nb, 1)``."""
    aligned = np.ldexp(coarse[0], _shift(coarse[1], fine[1])[:, None, None])
    top = np.max(np.abs(fine[0]), axis=(-2, -1))
    with np.errstate(over="ignore", invalid="ignore"):
        gap = np.max(np.abs(aligned - fine[0]), axis=(-2, -1)) / top
    return gap[:, None], fine[2][:, None]


def _shift(coarse: Array, fine: Array) -> NDArray[np.int64]:
    shift: NDArray[np.int64] = np.clip(coarse - fine, -1000, 1000).astype(np.int64)
    return shift


def _spectra(way: Method, equation: Equation, segments: int) -> tuple[Array, ...]:
    """Return matrices, powers of two, eigenvalues of the matrices, and what round-off moves them.

    The last is relative to the largest entry of the matrix, which is between 1/2 and 1.
    """
    matrix, exponent, rounding = _matrices(way, equation, segments)
    _, extra = np.frexp(np.max(np.abs(matrix), axis=(-2, -1)))
    matrix, exponent = np.ldexp(matrix, -extra[:, None, None]), exponent + extra
    found: tuple[Any, ...] = (matrix, exponent, *eigenvalues(matrix, rounding, ROUNDED))
    return found


def eigenvalues(
    matrices: Array, shift: Array, lone: float = 1.0
) -> tuple[ComplexArray, Array, ComplexArray]:
    """Return eigenvalues, how far errors of the matrices ``(nb,)`` may move them, eigenvectors.

    ``lone``: the share of the errors that counts for an eigenvalue far from all others.
    """
    values, vectors = np.linalg.eig(matrices)
    values, shift = values.astype(complex), shift[:, None]
    norm = np.linalg.norm(matrices, axis=(-2, -1))[:, None]
    # Near a double eigenvalue the condition number explodes and the square root holds; near an
    # r-fold one the r-th root.
    distance = np.abs(values[:, :, None] - values[:, None, :])
    near = np.sum(distance <= 2.0 * np.sqrt(norm * shift)[..., None], axis=-1)
    root = 2.0 * norm * (shift / norm) ** (1.0 / np.maximum(near, 2))
    moved = conditions(vectors) * shift * np.where(near > 1, 1.0, lone)
    return values, np.minimum(moved, root), vectors.astype(complex)


def conditions(vectors: ComplexArray) -> Array:
    """Return the condition number of each eigenvalue; inf where eigenvectors coincide."""
    try:
        return np.asarray(np.linalg.norm(np.linalg.inv(vectors), axis=-1))
    except np.linalg.LinAlgError:
        if len(vectors) == 1:
            return np.full(vectors.shape[:2], np.inf)
        return np.concatenate([conditions(row[None]) for row in vectors])


def _shifts(way: Method, coarse: tuple[Array, ...], fine: tuple[Array, ...]) -> tuple[Array, Array]:
    """Return how far multipliers differ, and round-off, over the larger of 1 and their sizes."""
    # Of shape (nb, m) each.  Each multiplier is compared with the nearest of the other rung; one of
    # the coarser rung that is left over counts for the finer one that is nearest to it.
    other = coarse[2] * np.ldexp(1.0, _shift(coarse[1], fine[1]))[:, None]
    gaps = np.abs(fine[2][:, :, None] - other[:, None, :])
    error = np.min(gaps, axis=2)
    nearest, left = np.argmin(gaps, axis=1), np.min(gaps, axis=1)
    for row, (places, distances) in enumerate(zip(nearest, left, strict=True)):
        np.maximum.at(error[row], places, distances)
    if not way.ends:
        error = np.maximum(error, _CANCELLED * _exchanged(coarse, fine))
    with np.errstate(over="ignore", divide="ignore"):
        size = np.maximum(np.abs(fine[2]), np.ldexp(1.0, -np.clip(fine[1], -1000, 1000))[:, None])
    return error / size, fine[3] / size


def _exchanged(coarse: tuple[Array, ...], fine: tuple[Array, ...]) -> Array:
    """Return what the difference of two rungs exchanges between each eigenvector and the others."""
    # Of the difference in coordinates of the eigenvectors the diagonal moves the eigenvalues to
    # first order; on the unit circle it is small by chance, or by symmetry, on one rung and not on
    # the next.  Returned are the geometric means of the norms of its rows and columns, (nb, m), in
    # which vectors of another modulus count by the ratio of both.
    gap = np.ldexp(coarse[0], _shift(coarse[1], fine[1])[:, None, None]) - fine[0]
    exchanged = np.zeros(fine[2].shape)
    # Eigenvectors that coincide are known from their condition.
    known = np.all(np.isfinite(gap), axis=(1, 2)) & (np.linalg.cond(fine[4]) < 1.0 / _EPS)
    vectors, modulus = fine[4][known], np.maximum(np.abs(fine[2][known]), np.finfo(float).tiny)
    inner = np.abs(np.linalg.solve(vectors, gap[known] @ vectors))
    ratio = np.log(modulus[:, :, None]) - np.log(modulus[:, None, :])
    inner *= np.exp(-np.abs(ratio))
    norms = np.linalg.norm(inner, axis=2) * np.linalg.norm(inner, axis=1)
    exchanged[known] = np.sqrt(norms)
    return exchanged


def _second_from_determinant(
    logarithm: Array, angle: Array, error: Array, divergence: Array
) -> None:
    """Put in place the smaller of two real multipliers from Liouville's determinant."""
    rows = np.flatnonzero(np.max(logarithm, axis=-1) - divergence / 2 > 1.0)
    large = np.argmax(logarithm[rows], axis=-1)
    top, divergence = logarithm[rows, large], divergence[rows]
    rounding = np.log(8 * _EPS * (1 + np.abs(divergence)))
    known = np.logaddexp(error[rows, large] - top, rounding)
    logarithm[rows, 1 - large] = divergence - top
    angle[rows, 1 - large] = angle[rows, large]
    error[rows, 1 - large] = divergence - top + known


def _grade_hidden(
    equation: Equation,
    way: Method,
    rtol: float,
    segments: NDArray[np.int64],
    exponent: NDArray[np.int64],
    spectrum: tuple[Array, Array, Array],
) -> None:
    """Put in place the multipliers of members whose growth hides the small ones."""
    logarithm, angle, error = spectrum
    uncertain = np.max(error - np.maximum(logarithm, 0.0), axis=-1) > np.log(rtol)
    # Without growth it is a defect that makes multipliers uncertain; no route mends that.
    hidden = uncertain & (exponent > 12)
    for number in np.unique(segments[hidden]):
        members = np.flatnonzero(hidden & (segments == number))
        part = equation.take(members)
        (coarse, turned), (fine, angles) = (
            graded_multipliers(segments_of(part, count, way).maps)
            for count in (int(number), 2 * int(number))
        )
        turn = np.abs(np.exp(1j * turned) - np.exp(1j * angles))
        gone = np.isinf(fine)
        relative = np.abs(np.where(gone, 0.0, fine) - np.where(gone, 0.0, coarse)) + turn
        rounding = 4.0 * rounding_error(part, 2 * int(number))[:, None]
        logarithm[members], angle[members] = fine, angles
        error[members] = np.where(gone, -745.0, fine) + np.log(relative + rounding)


# Growth, and decay, that one merged matrix may hold: what is small in it keeps its digits.
_MERGED_NORM, _MERGED_INVERSE = 10.0, 1e3
# Sweeps at the least, and at the most where blocks still hold moduli that are far apart.
_SWEEPS, _MOST_SWEEPS, _FAR_APART = 8, 64, float(np.log(1e4))


def graded_multipliers(maps: Array) -> tuple[Array, Array]:
    """Return the multipliers of a product of ``(nb, segments, m, m)`` that is never formed.

    An orthogonal basis is carried round the period (``Phi_k Q_k = Q_{k+1} R_k``) until it returns
    to itself in blocks; each block of the triangular factors then holds multipliers of like
    modulus, whatever the others do, and keeps its relative digits.  Returned are log |multiplier|,
    -inf where it is zero, and its argument, ``(nb, m)``, in the order of :func:`multiplier_order`.
    """
    maps = _merged(maps)
    count, m = len(maps), maps.shape[-1]
    basis = np.broadcast_to(np.eye(m), (count, m, m))
    for sweep in range(_MOST_SWEEPS):
        end, factors = _carried(maps, basis)
        turn = np.swapaxes(basis, -1, -2) @ end
        basis = end
        if sweep + 1 >= _SWEEPS and not _mixed(turn, factors):
            break
    logarithm, angle = np.empty((count, m)), np.empty((count, m))
    for index, returned in enumerate(turn):
        for begin, stop in pairwise(_cuts(returned)):
            block = slice(begin, stop)
            whole, power = product(factors[index : index + 1, :, block, block])
            values = np.linalg.eigvals(returned[block, block] @ whole[0]).astype(complex)
            with np.errstate(divide="ignore"):
                logarithm[index, block] = np.log(np.abs(values)) + power[0] * np.log(2.0)
            angle[index, block] = np.angle(values)
    order = multiplier_order(logarithm, angle)
    return np.take_along_axis(logarithm, order, -1), np.take_along_axis(angle, order, -1)


def _merged(maps: Array) -> Array:
    """Multiply neighbours as long as no product grows beyond ``_MERGED_NORM``."""
    while maps.shape[1] > 1 and maps.shape[1] % 2 == 0:
        pairs = maps[:, 1::2] @ maps[:, 0::2]
        if not np.max(np.abs(pairs)) <= _MERGED_NORM:
            break
        try:
            back = float(np.max(np.abs(np.linalg.inv(pairs))))
        except np.linalg.LinAlgError:
            break
        if not back <= _MERGED_INVERSE:
            break
        maps = pairs
    return maps


def _carried(maps: Array, basis: Array) -> tuple[Array, Array]:
    """Carry bases over all matrices; return the last bases and the triangular factors."""
    factors = np.empty_like(maps)
    for k in range(maps.shape[1]):
        basis, factor = np.linalg.qr(maps[:, k] @ basis)
        sign = np.where(np.diagonal(factor, axis1=-2, axis2=-1) < 0, -1.0, 1.0)
        basis, factors[:, k] = basis * sign[:, None, :], sign[:, :, None] * factor
    return basis, factors


def _mixed(turn: Array, factors: Array) -> bool:
    """Return True where a block that has not come apart holds moduli that are far apart."""
    with np.errstate(divide="ignore"):
        size = np.sum(np.log(np.abs(np.diagonal(factors, axis1=-2, axis2=-1))), axis=1)
    return any(
        np.ptp(levels[begin:stop]) > _FAR_APART
        for returned, levels in zip(turn, np.maximum(size, -1e300), strict=True)
        for begin, stop in pairwise(_cuts(returned))
    )


def _cuts(turn: Array) -> list[int]:
    """Return where the basis has returned to itself in blocks."""
    m = len(turn)
    inner = [i for i in range(1, m) if np.max(np.abs(turn[i:, :i])) < 1e-11]
    return [0, *inner, m]


def _matrix_checks(
    equation: Equation, scaled: Array, exponent: NDArray[np.int64], error: Array, allowed: Array
) -> Mapping[str, Check]:
    """Convergence, Liouville's determinant and symplecticity, at the worst member."""
    if not len(error):
        return {}
    n = equation.size
    last = int(np.argmax(error / allowed))
    checks = {"converged": Check(float(error[last]), float(allowed[last]))}
    sign, logarithm = np.linalg.slogdet(scaled)
    expected = equation.divergence() - 2 * n * exponent * np.log(2.0)
    # A determinant is known to the error of the matrix times its condition.
    with np.errstate(over="ignore"):
        condition = np.linalg.cond(scaled)
    known = condition * error < 0.01
    if np.any(known):
        gap = np.where(sign > 0, np.abs(logarithm - expected), np.inf)[known]
        limit = 8 * n * float(np.max(error[known]))
        checks["liouville"] = Check(float(np.max(gap / np.maximum(condition[known], 1.0))), limit)
    if not equation.damped:
        unit = np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(n))
        shrink = np.ldexp(1.0, np.clip(-2 * exponent, -1060, 1000))[:, None, None]
        defect = np.swapaxes(scaled, -1, -2) @ unit @ scaled - unit * shrink
        norm = np.linalg.norm(scaled, axis=(-2, -1))
        worst = np.max(np.linalg.norm(defect, axis=(-2, -1)) / norm**2)
        checks["symplectic"] = Check(float(worst), min(8 * n * float(np.max(error)), 1e-3))
    return checks


def _multiplier_checks(
    equation: Equation, spectrum: tuple[Array, Array, Array], divergence: Array, allowed: Array
) -> Mapping[str, Check]:
    """Convergence, the product of the multipliers, and reciprocal pairs, at the worst member."""
    logarithm, angle, error = spectrum
    if not len(divergence):
        return {}
    relative = np.max(np.exp(error - np.maximum(logarithm, 0.0)), axis=-1)
    last = int(np.argmax(relative / allowed))
    checks = {"converged": Check(float(relative[last]), float(allowed[last]))}
    # One multiplier lost in round-off, and the product says nothing.
    known = np.exp(np.minimum(error - np.maximum(logarithm, -1e4), 0.0))
    finite = np.all(np.isfinite(logarithm) & (known < 1.0), axis=-1)
    if np.any(finite):
        total = np.sum(logarithm[finite], axis=-1)
        limit = 2 * np.sum(known[finite], axis=-1) + 64 * _EPS * (1 + np.abs(divergence[finite]))
        gap = np.abs(total - divergence[finite])
        worst = int(np.argmax(gap / limit))
        checks["product"] = Check(float(gap[worst]), float(limit[worst]))
    if not equation.damped:
        checks["reciprocal pairs"] = _reciprocal(logarithm, angle, error)
    return checks


def _reciprocal(logarithm: Array, angle: Array, error: Array) -> Check:
    """How far the multipliers are from reciprocal pairs, at the worst place against the error."""
    pair = logarithm[:, :, None] + logarithm[:, None, :]
    turn = angle[:, :, None] + angle[:, None, :]
    defect = np.abs(np.expm1(np.clip(pair, -50, 50) + 1j * turn))
    partner = np.argmin(defect, axis=-1)
    value = np.take_along_axis(defect, partner[..., None], axis=-1)[..., 0]
    known = np.exp(np.clip(error - logarithm, -50, 50))
    limit = 2 * (known + np.take_along_axis(known, partner, axis=-1)) + 64 * _EPS
    worst = np.unravel_index(np.argmax(value / limit), value.shape)
    return Check(float(value[worst]), float(limit[worst]))


def cycles_to_settle(
    multiplier: ArrayLike, tolerance: float, *, norm: str = "change"
) -> NDArray[np.int64]:
    """Return how many periods a march from rest takes, with the last.

    After k periods the motion from rest is ``y_s - rho^k y_s``, where y_s lies along the mode of
    rho, the multiplier nearest to the unit circle; what else the start holds has died away before.

    Parameters
    ----------
    multiplier : array_like
        rho, real or complex.
    tolerance : float
        Between 0 and 1, over the size of the motion.
    norm : {"change", "remaining"}
        Of the last period from the one before, ``abs(1 - rho) abs(rho)^(k - 2)``; or of the rest of
        the start in the last period, ``abs(rho)^(k - 1)``.

    Returns
    -------
    ndarray of int
        k, of the shape of the multiplier; -1 where it never settles.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> print(el.periodic.cycles_to_settle([0.5, 0.9, 1.1], 0.01))
    [ 8 24 -1]
    """
    if not 0.0 < tolerance < 1.0:
        raise bad("tolerance", tolerance, "a number between 0 and 1", "choose 1e-4")
    if norm not in ("change", "remaining"):
        raise bad("norm", repr(norm), "'change' or 'remaining'", "choose 'change'")
    rho = np.asarray(multiplier, dtype=complex)
    size = np.abs(rho)
    # The change of a first period from none is no change.
    first, least = (np.abs(1.0 - rho), 2.0) if norm == "change" else (np.ones_like(size), 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = least + np.log(tolerance / np.maximum(first, 1e-300)) / np.log(size)
    whole = np.ceil(np.where(size > 0.0, np.maximum(needed, least), least))
    return np.where(size < 1.0, whole, -1.0).astype(np.int64)
