"""Eigenvalues of monodromy matrices, each with its error, whatever the growth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .first_order import CanonicalForm
from .period_products import graded_multipliers

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_EPS = float(np.finfo(float).eps)
# Error, over the larger of 1 and the multiplier, from which the graded route is worth its time.
_HIDDEN = 1e-8


def eigenvalues(
    form: CanonicalForm,
    scaled: Array,
    exponent: NDArray[np.int64],
    error: Array,
    segments: NDArray[np.int64],
    volume: Array,
    relative: bool = False,
) -> tuple[Array, Array, Array]:
    """Return the multipliers of a batch by logarithm, with their errors, in a fixed order.

    Parameters
    ----------
    form : CanonicalForm
        The systems.
    scaled : ndarray
        Monodromy matrices in scaled variables, to be multiplied by ``2**exponent``,
        shape ``(nb, 2n, 2n)``.
    exponent : ndarray of int
        Shape ``(nb,)``.
    error : ndarray
        Largest error of an entry over the largest entry, shape ``(nb,)``.
    segments : ndarray of int
        Segments per period that gave the matrices, shape ``(nb,)``.
    volume : ndarray
        Logarithm of the determinant, by Liouville, shape ``(nb,)``.
    relative : bool
        Whether small multipliers are to keep their relative digits.

    Returns
    -------
    logarithm, angle, log_error : ndarray
        log |multiplier|, its argument and the logarithm of its absolute error, ``(nb, 2n)``.
    """
    m = scaled.shape[-1]
    unit, extra = _unit_size(scaled)
    power = exponent + extra
    logarithm, angle, uncertain = spectrum(unit, power, error)
    if m == 2:
        _second_from_determinant(logarithm, angle, uncertain, volume)
    else:
        hidden = np.max(uncertain - np.maximum(logarithm, 0.0), axis=-1) > np.log(_HIDDEN)
        # Without growth it is a defect that makes multipliers uncertain; no route mends that.
        hidden &= power > 12
        if relative:
            hidden |= np.max(uncertain - logarithm, axis=-1) > np.log(_HIDDEN)
        for number in np.unique(segments[hidden]):
            index = np.flatnonzero(hidden & (segments == number))
            logarithm[index], angle[index], uncertain[index] = _graded(
                form.take(index), int(number)
            )
    order = multiplier_order(logarithm, angle)
    ordered = [np.take_along_axis(value, order, axis=-1) for value in (logarithm, angle, uncertain)]
    return ordered[0], ordered[1], ordered[2]


def _unit_size(matrices: Array) -> tuple[Array, NDArray[np.int64]]:
    """Scale matrices by powers of two to a largest entry between 1/2 and 1."""
    _, power = np.frexp(np.max(np.abs(matrices), axis=(-2, -1)))
    return np.ldexp(matrices, -power[:, None, None]), power.astype(np.int64)


def _second_from_determinant(logarithm: Array, angle: Array, error: Array, volume: Array) -> None:
    """Put in place the smaller of two real multipliers from Liouville's determinant."""
    rows = np.arange(len(volume))
    large = np.argmax(logarithm, axis=-1)
    small = 1 - large
    apart = logarithm[rows, large] - volume / 2 > 1.0
    own = error[rows, large] - logarithm[rows, large]
    logarithm[rows[apart], small[apart]] = (volume - logarithm[rows, large])[apart]
    angle[rows[apart], small[apart]] = angle[rows, large][apart]
    rounding = np.log(8 * _EPS * (1 + np.abs(volume)))
    error[rows[apart], small[apart]] = (
        volume - logarithm[rows, large] + np.logaddexp(own, rounding)
    )[apart]


def spectrum(scaled: Array, power: NDArray[np.int64], error: Array) -> tuple[Array, Array, Array]:
    """Return log modulus, argument and log error of the eigenvalues of ``scaled 2**power``."""
    m = scaled.shape[-1]
    values, vectors = np.linalg.eig(scaled)
    values = values.astype(complex)
    condition = conditions(vectors)
    norm = np.linalg.norm(scaled, axis=(-2, -1))[:, None]
    top = np.max(np.abs(scaled), axis=(-2, -1))[:, None]
    shift = m * error[:, None] * top + 4 * m * _EPS * norm
    # Near a double eigenvalue the condition number explodes and the square root holds; near an
    # r-fold one the r-th root.
    radius = 2 * np.sqrt(norm * shift)
    distance = np.abs(values[:, :, None] - values[:, None, :])
    near = np.sum(distance <= radius[..., None], axis=-1)
    root = 2 * norm * (shift / norm) ** (1 / np.maximum(near, 2))
    uncertain = np.minimum(condition * shift, root)
    shift_of_log = power[:, None] * np.log(2.0)
    with np.errstate(divide="ignore"):
        logarithm = np.log(np.abs(values)) + shift_of_log
    return logarithm, np.angle(values), np.log(uncertain) + shift_of_log


def conditions(vectors: ComplexArray) -> Array:
    """Return the condition number of each eigenvalue; inf where eigenvectors coincide."""
    out = np.full(vectors.shape[:2], np.inf)
    usable = np.linalg.cond(vectors) < 1e300
    if np.any(usable):
        left = np.linalg.inv(vectors[usable])
        out[usable] = np.linalg.norm(left, axis=-1)
    return out


def _graded(form: CanonicalForm, segments: int) -> tuple[Array, Array, Array]:
    """Return log modulus, argument and log error by the graded decomposition, refined once."""
    found = []
    for number in (segments, 2 * segments):
        logarithm, angle = graded_multipliers(form, number)
        order = multiplier_order(logarithm, angle)
        found.append([np.take_along_axis(value, order, axis=-1) for value in (logarithm, angle)])
    (coarse, coarse_angle), (fine, angle) = found
    turn = np.abs(np.exp(1j * coarse_angle) - np.exp(1j * angle))
    gone = np.isinf(fine)
    relative = np.abs(np.where(gone, 0.0, fine) - np.where(gone, 0.0, coarse)) + turn
    rounding = _EPS * (64 + 4 * form.rate[:, None] * form.system.period)
    return fine, angle, np.where(gone, -745.0, fine) + np.log(relative + rounding)


def multiplier_order(logarithm: Array, angle: Array) -> NDArray[np.intp]:
    """Order by falling modulus, rounding aside, then by the argument's size, upper half first."""
    modulus = np.round(np.maximum(logarithm, -1e4), 6)
    return np.lexsort((-np.sign(angle), np.round(np.abs(angle), 9), -modulus), axis=-1)
