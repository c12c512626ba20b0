"""Products of the step matrices of a period: without overflow, and graded for large growth."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.namespaces import carried, in_numpy, namespace_of, to_numpy
from ..integrators.gauss_legendre import gauss_legendre, gauss_maps
from ..integrators.protocol import OneStep
from .first_order import CanonicalForm

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

STAGES = 8
GAUSS = gauss_legendre(STAGES)
_BLOCK_FLOATS = 4_000_000


def period_product(
    form: CanonicalForm, segments: int, method: OneStep = GAUSS
) -> tuple[Array, NDArray[np.int64]]:
    """Return the scaled monodromy matrices from a number of equal segments.

    Parameters
    ----------
    form : CanonicalForm
        The systems, ``nb`` of them.
    segments : int
        Steps per period.
    method : OneStep
        Gauss-Legendre collocation of order 16 by default.

    Returns
    -------
    matrix : ndarray
        Shape ``(nb, 2n, 2n)``, of the array namespace that the generator of the form is of; the
        largest entry is of order 1 where a power was taken out.
    exponent : ndarray of int
        Powers of two taken out, shape ``(nb,)``.
    """
    m = form.size
    per_segment = (STAGES * m) ** 2
    together = int(np.clip(_BLOCK_FLOATS // (per_segment * min(segments, 64)), 1, len(form.speed)))
    stretch = int(np.clip(_BLOCK_FLOATS // (per_segment * together), 1, segments))
    step = float(form.system.period) / segments
    results, powers = [], []
    for begin in range(0, len(form.speed), together):
        part = form.take(slice(begin, begin + together))
        total: Any = np.eye(m)
        power: Any = 0
        for left in range(0, segments, stretch):
            maps = method.maps(part.generator, _left_ends(left, stretch, segments, step), step)
            product, more = ordered_product(maps)
            total, extra = _normalised(product @ total if left else product)
            power = power + more + extra
        results.append(total)
        powers.append(power)
    xp = namespace_of(results[0])
    return xp.concat(results, axis=0), xp.concat(powers, axis=0)


def ordered_product(maps: Array) -> tuple[Array, NDArray[np.int64]]:
    """Return ``maps[:, -1] @ ... @ maps[:, 0]`` by pairs, powers of two taken out.

    The maps may be of any array namespace; the answer is of the same.
    """
    xp = namespace_of(maps)
    power: Any = 0
    while maps.shape[1] > 1:
        odd = maps.shape[1] % 2
        even = maps.shape[1] - odd
        pairs = maps[:, 1:even:2, ...] @ maps[:, 0:even:2, ...]
        maps = xp.concat([pairs, maps[:, even:, ...]], axis=1) if odd else pairs
        # One power per matrix would do no better: the sum is all that matters.
        maps, extra = _normalised(maps)
        power = power + xp.sum(extra, axis=1)
    whole: Array = maps[:, 0, ...]
    if isinstance(power, int):
        power = xp.astype(xp.zeros_like(whole[:, 0, 0]), xp.int64)
    return whole, power


def _normalised(matrices: Array) -> tuple[Array, NDArray[np.int64]]:
    """Take a power of two out of matrices whose largest entry is beyond 1e60 or below 1e-60."""
    if not in_numpy(matrices):
        return _normalised_elsewhere(matrices)
    top = np.max(np.abs(matrices), axis=(-2, -1))
    extreme = ((top > 1e60) | (top < 1e-60)) & (top > 0) & np.isfinite(top)
    _, power = np.frexp(np.where(extreme, top, 0.5))
    return np.ldexp(matrices, -power[..., None, None]), power.astype(np.int64)


def _normalised_elsewhere(matrices: Any) -> tuple[Any, Any]:
    """Do so in another namespace, which has no function that takes a number apart."""
    xp = namespace_of(matrices)
    top = xp.max(xp.abs(matrices), axis=(-2, -1))
    if not xp.any((top > 1e60) | (top < 1e-60)):
        return matrices, xp.astype(xp.zeros_like(top), xp.int64)
    known = to_numpy(top)
    extreme = ((known > 1e60) | (known < 1e-60)) & (known > 0) & np.isfinite(known)
    _, power = np.frexp(np.where(extreme, known, 0.5))
    first = power // 2  # in two factors: one alone could overflow
    for part in (first, power - first):
        matrices = matrices * carried(np.ldexp(1.0, -part), matrices)[..., None, None]
    return matrices, xp.asarray(power.astype(np.int64), device=matrices.device)


# Growth, and decay, that one merged matrix may hold: what is small in it keeps its digits.
_MERGED_NORM, _MERGED_INVERSE = 10.0, 1e3
# Sweeps at the least, and at the most where blocks still hold moduli that are far apart.
_SWEEPS, _MOST_SWEEPS = 8, 64
_FAR_APART = np.log(1e4)


def graded_multipliers(form: CanonicalForm, segments: int) -> tuple[Array, Array]:
    """Return the multipliers of systems whose growth hides the small ones in the product.

    The product of the segments' matrices is never formed.  An orthogonal basis is carried round
    the period (``Phi_k Q_k = Q_{k+1} R_k``) until it returns to itself in blocks; each block of
    the triangular factors then holds multipliers of like modulus, whatever the others do.  So each
    multiplier keeps the relative digits that its own block leaves it: all but what the
    collocation and the rounding of as many factors take, unless many moduli lie close together,
    by less than a factor of 1.3 each, over more than four powers of ten.

    Parameters
    ----------
    form : CanonicalForm
        The systems.
    segments : int
        Number of collocation segments per period.

    Returns
    -------
    logarithm, angle : ndarray
        log |multiplier| and its argument, shape ``(nb, 2n)``; -inf where a multiplier is zero.
    """
    maps = _merged(_all_maps(form, segments))
    basis = np.broadcast_to(np.eye(form.size), (len(form.speed), form.size, form.size))
    for sweep in range(_MOST_SWEEPS):
        end, factors = _carry(maps, basis)
        turn = np.swapaxes(basis, -1, -2) @ end
        basis = end
        if sweep + 1 >= _SWEEPS and not _mixed(turn, factors):
            break
    logarithm = np.empty((len(form.speed), form.size))
    angle = np.empty_like(logarithm)
    for index, returned in enumerate(turn):
        cuts = _cuts(returned)
        for begin, stop in pairwise(cuts):
            block = slice(begin, stop)
            product, power = ordered_product(factors[index : index + 1, :, block, block])
            values = np.linalg.eigvals(returned[block, block] @ product[0]).astype(complex)
            with np.errstate(divide="ignore"):
                logarithm[index, block] = np.log(np.abs(values)) + power[0] * np.log(2.0)
            angle[index, block] = np.angle(values)
    return logarithm, angle


def _all_maps(form: CanonicalForm, segments: int) -> Array:
    step = float(form.system.period) / segments
    stretch = max(1, _BLOCK_FLOATS // ((STAGES * form.size) ** 2 * len(form.speed)))
    parts = [
        gauss_maps(STAGES, form.generator, _left_ends(left, stretch, segments, step), step)
        for left in range(0, segments, stretch)
    ]
    return np.concatenate(parts, axis=1)


def _left_ends(left: int, stretch: int, segments: int, step: float) -> Array:
    angles: Array = step * np.arange(left, min(left + stretch, segments), dtype=float)
    return angles


def _merged(maps: Array) -> Array:
    """Multiply neighbours as long as no product grows beyond ``_MERGED_NORM``."""
    while maps.shape[1] > 1 and maps.shape[1] % 2 == 0:
        pairs = maps[:, 1::2] @ maps[:, 0::2]
        if np.max(np.abs(pairs)) > _MERGED_NORM:
            break
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            try:
                back = np.max(np.abs(np.linalg.inv(pairs)))
            except np.linalg.LinAlgError:
                break
        if not back <= _MERGED_INVERSE:
            break
        maps = pairs
    return maps


def _mixed(turn: Array, factors: Array) -> bool:
    """Return True where a block that has not come apart holds moduli that are far apart."""
    with np.errstate(divide="ignore"):
        size = np.sum(np.log(np.abs(np.diagonal(factors, axis1=-2, axis2=-1))), axis=1)
    for returned, levels in zip(turn, np.maximum(size, -1e300), strict=True):
        for begin, stop in pairwise(_cuts(returned)):
            if np.ptp(levels[begin:stop]) > _FAR_APART:
                return True
    return False


def _carry(maps: Array, basis: Array) -> tuple[Array, Array]:
    """Carry bases over all matrices; return the last bases and the triangular factors."""
    factors = np.empty_like(maps)
    for k in range(maps.shape[1]):
        basis, factor = np.linalg.qr(maps[:, k] @ basis)
        sign = np.where(np.diagonal(factor, axis1=-2, axis2=-1) < 0, -1.0, 1.0)
        basis, factors[:, k] = basis * sign[:, None, :], sign[:, :, None] * factor
    return basis, factors


def _cuts(turn: Array) -> list[int]:
    """Return where the basis has returned to itself in blocks."""
    m = len(turn)
    inner = [i for i in range(1, m) if np.max(np.abs(turn[i:, :i])) < 1e-11]
    return [0, *inner, m]
