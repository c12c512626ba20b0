"""What decides stability: half trace, characteristic polynomial, reduced polynomial."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..core.families import Array

# Round-off of coefficients and roots, relative to the largest coefficient.
_ROUNDING = 32.0 * float(np.finfo(float).eps)

Moduli = tuple[Array, NDArray[np.bool_], Array]
_EPS = float(np.finfo(float).eps)


def largest_modulus(coefficients: Array, *, reduced: bool, error: Array | float = 0.0) -> Moduli:
    """Return the largest modulus of a multiplier, whether all are stable, and the slack of that.

    From the coefficients of :func:`weighed_characteristic` ``(..., k)`` and the absolute error of
    all of them or of each, round-off added; where ``reduced``, roots are sought in
    ``z = rho + 1/rho``, where stability means z real and ``|z| <= 2``.  A root counts as stable
    where its modulus exceeds 1 by no more than what the errors explain; the slack is the largest
    such allowance of a point, 0 where signs of the reduced polynomial prove that every multiplier
    is on the unit circle.  Where a coefficient is infinite the growth overflowed: infinite,
    unstable, slack 0.  Where one is NaN nothing is known: NaN, not stable, infinite slack.
    """
    known = known_to(coefficients, np.asarray(error, dtype=float))
    usable = np.all(np.isfinite(coefficients), axis=-1)
    if np.all(usable):
        return _moduli(coefficients, known, reduced)
    lost = np.any(np.isnan(coefficients), axis=-1)
    largest = np.where(lost, np.nan, np.inf)
    slack = np.where(lost, np.inf, 0.0)
    stable = np.zeros(lost.shape, dtype=bool)
    if np.any(usable):
        found = _moduli(coefficients[usable], known[usable], reduced)
        largest[usable], stable[usable], slack[usable] = found
    return largest, stable, slack


def known_to(coefficients: Array, error: Array) -> Array:
    """Return the error of each coefficient with round-off, given for all of them or for each."""
    with np.errstate(over="ignore", invalid="ignore"):
        size = np.abs(coefficients)
        rough = np.max(size, axis=-1, initial=1.0, keepdims=True)
        if error.ndim < coefficients.ndim or not error.ndim:
            known = error[..., None] + _ROUNDING * rough
        else:
            # A large root leaves the first coefficients smaller, and their round-off with them.
            order = np.arange(1, size.shape[-1] + 1)
            reach = np.max(size ** (1.0 / order), axis=-1, initial=1.0, keepdims=True)
            known = error + _ROUNDING * np.minimum(rough, reach**order)
    known = np.where(np.isnan(known), np.inf, known)
    return np.broadcast_to(known, coefficients.shape)


def _moduli(coefficients: Array, known: Array, reduced: bool) -> Moduli:
    """Judge polynomials all of whose coefficients are finite."""
    if not reduced:
        rho = _roots(coefficients)
        return _judged(np.abs(rho), root_uncertainty(rho, known))
    polynomial = in_sum(coefficients)
    # On the unit circle a coefficient enters by 2 cos, the middle one by 1.
    n = known.shape[-1]
    even = (2.0 * np.sum(known, axis=-1) - known[..., -1]) / (2 * n - 1)
    # Most modes whose reduced polynomial has a slope with roots in closed form.
    if n <= 4:
        stable, z = surely_stable(polynomial, even), None
    else:
        z = _roots(polynomial)
        real = np.sort(z.real, axis=-1)
        stable = surely_stable(polynomial, even, 0.5 * (real[..., 1:] + real[..., :-1]))
    largest, slack = np.ones(stable.shape), np.zeros(stable.shape)
    rest = ~stable
    if np.any(rest):
        moved = known[rest] @ np.abs(_sum_weights(n)[1:])
        found = _by_sums(_roots(polynomial[rest]) if z is None else z[rest], moved)
        largest[rest], stable[rest], slack[rest] = found
    return largest, stable, slack


def _by_sums(z: NDArray[np.complex128], known: Array) -> Moduli:
    """Judge by the sums ``z = rho + 1/rho``."""
    off = root_uncertainty(z, known)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        rho, root = _outer(z)
        modulus = np.maximum(np.abs(rho), 1.0)
        # rho moves by rho dz / sqrt(z^2 - 4), and at z = +-2 by the square root.
        allowance = modulus * np.minimum(off / (2 * np.abs(root)), np.sqrt(off))
    return _judged(modulus, np.where(np.isnan(allowance), np.inf, allowance))


def _outer(z: NDArray[np.complex128]) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return of each pair of ``z = rho + 1/rho`` the larger rho, and ``sqrt(z^2/4 - 1)``."""
    # Beyond 1e8 the square of z may overflow, and 4 is lost beside it: root and rho are z/2 and z.
    far = np.abs(z) > 1e8
    root = np.where(far, z / 2, np.sqrt(np.where(far, 0.0, z) ** 2 / 4 - 1 + 0j))
    # The one without cancellation.
    rho = np.where(np.abs(z / 2 + root) >= np.abs(z / 2 - root), z / 2 + root, z / 2 - root)
    return rho, root


def _judged(modulus: Array, allowance: Array) -> Moduli:
    stable = np.all(modulus <= 1.0 + allowance, axis=-1)
    return np.max(modulus, axis=-1), stable, np.max(allowance, axis=-1)


def instability_kind(
    coefficients: Array, stable: NDArray[np.bool_], reduced: bool
) -> NDArray[np.int8]:
    """Return 1 or -1 where the largest multiplier is real, 2 where complex, 0 where stable.

    Where it overflowed, by the sign of the sum of the multipliers; 0 where nothing is known.
    """
    out = np.zeros(stable.shape, dtype=np.int8)
    grown = ~np.all(np.isfinite(coefficients), axis=-1)
    if np.any(grown):
        # Overflowed: the sum of the multipliers tells the sign of the largest.
        first = coefficients[grown, 0]
        out[grown] = np.where(np.isinf(first), -np.sign(first), 0.0)
        stable = stable | grown
    chosen = coefficients[~stable]
    if not len(chosen):
        return out
    rho = _outer(_roots(in_sum(chosen)))[0] if reduced else _roots(chosen)
    top = np.take_along_axis(rho, np.argmax(np.abs(rho), axis=-1)[..., None], axis=-1)[..., 0]
    # Relative imaginary part up to which a multiplier counts as real: round-off at a double one.
    real = np.abs(top.imag) <= 1e-6 * np.abs(top)
    out[~stable] = np.where(real, np.where(top.real > 0, 1, -1), 2)
    return out


def root_uncertainty(roots: NDArray[np.complex128], error: Array) -> Array:
    """Return how far each root of a monic polynomial moves with its coefficients' errors.

    Of a root alone the error of the polynomial over its slope; within a cluster of r roots the r-th
    root of the error over the distances to the others; the smallest, doubled.
    """
    k = roots.shape[-1]
    with np.errstate(over="ignore", invalid="ignore"):
        change = sum(error[..., k - 1 - j, None] * np.abs(roots) ** j for j in range(k))
    apart = np.sort(np.abs(roots[..., :, None] - roots[..., None, :]), axis=-1)[..., 1:]
    # Distances to the farthest k - r others, r = 1 ... k.
    far = np.cumprod(apart[..., ::-1], axis=-1)[..., ::-1]
    far = np.concatenate([far, np.ones((*far.shape[:-1], 1))], axis=-1)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        moved = (np.asarray(change)[..., None] / far) ** (1.0 / np.arange(1, k + 1))
    moved = np.where(np.isnan(moved), np.inf, moved)
    return np.asarray(2.0 * np.min(moved, axis=-1))


def in_sum(coefficients: Array) -> Array:
    """Turn ``1, c_1 ... c_n ... c_1, 1`` in rho into a monic polynomial in ``rho + 1/rho``."""
    weights = _sum_weights(coefficients.shape[-1])
    return np.asarray(coefficients @ weights[1:] + weights[0])


def from_sum(polynomial: Array) -> Array:
    """Undo :func:`in_sum`."""
    n = polynomial.shape[-1]
    return np.asarray((polynomial - _sum_weights(n)[0]) @ sum_weights_back(n))


def sum_weights_back(n: int) -> Array:
    """Return what each of ``a_1 ... a_n`` adds to ``c_1 ... c_n``, shape ``(n, n)``."""
    # Triangular with a diagonal of ones and whole entries: so is the inverse.
    return np.round(np.linalg.inv(_sum_weights(n)[1:]))


@lru_cache(maxsize=64)
def _sum_weights(n: int) -> Array:
    """Return what 1 and each of ``c_1 ... c_n`` add to ``a_1 ... a_n``, shape ``(n + 1, n)``."""
    table = np.zeros((n + 1, n + 1))  # rho^j + rho^-j as a polynomial in z, lowest power first
    table[0, 0] = 2.0
    if n:
        table[1, 1] = 1.0
    for j in range(2, n + 1):
        table[j, 1:] = table[j - 1, :-1]
        table[j] -= table[j - 2]
    weights = table[::-1].copy()
    weights[n] /= 2.0  # the middle coefficient stands once
    found: Array = weights[:, ::-1][:, 1:]
    found.setflags(write=False)
    return found


def _roots(monic: Array) -> NDArray[np.complex128]:
    """Return the roots of ``z^k + a_1 z^(k-1) + ...``, coefficients along the last axis."""
    degree = monic.shape[-1]
    if degree == 1:
        return np.asarray(-monic, dtype=complex)
    if degree == 2:
        half = -monic[..., 0] / 2
        root = np.sqrt((half**2 - monic[..., 1]).astype(complex))
        return np.stack([half + root, half - root], axis=-1)
    companion = np.zeros((*monic.shape[:-1], degree, degree))
    companion[..., 0, :] = -monic
    companion[..., np.arange(1, degree), np.arange(degree - 1)] = 1.0
    return np.asarray(np.linalg.eigvals(companion), dtype=complex)


def weighed_characteristic(
    matrices: Array, wanted: int, change: Array | None = None
) -> tuple[Array, Array]:
    """Return the first coefficients of characteristic polynomials, and what moves them.

    ``c_1, c_2, ...`` of ``rho^2n + c_1 rho^(2n-1) + ...``, not finite where they overflow; those of
    a symplectic matrix are palindromic, so that n of them are enough.
    Faddeev and LeVerrier: ``B_k = X B_(k-1) + c_k``, ``c_k = -tr(X B_(k-1)) / k``.  Its round-off
    grows like powers of X, and where too much of a coefficient would be lost the polynomial is
    made from the eigenvalues instead.
    """
    m = matrices.shape[-1]
    found, weight = [], []
    with np.errstate(over="ignore", invalid="ignore"):
        size = frobenius(matrices)
        change = size if change is None else change
        power = np.broadcast_to(np.eye(m), matrices.shape)
        rough, worst = np.zeros_like(size), np.zeros_like(size)
        for k in range(1, wanted + 1):
            norm = frobenius(power)
            rough = size * (rough + _EPS * norm)
            worst = np.maximum(worst, rough / k)
            product = matrices @ power
            coefficient = -np.trace(product, axis1=-2, axis2=-1) / k
            found.append(coefficient)
            weight.append(np.maximum(change * norm, 1.0))
            power = product + coefficient[..., None, None] * np.eye(m)
        coefficients = np.stack(found, axis=-1)
        top = np.maximum(np.max(np.abs(coefficients), axis=-1), 1.0)
        # Round-off of the recursion, over the coefficients where beyond 1, from which eigenvalues
        # do better.
        lost = (worst > 1e-11 * top) & np.all(np.isfinite(coefficients), axis=-1)
    if np.any(lost):
        coefficients[lost] = _from_eigenvalues(matrices[lost], wanted)
    return coefficients, np.stack(weight, axis=-1)


def frobenius(matrices: Array) -> Array:
    """Return the Frobenius norms of matrices."""
    return np.asarray(np.sqrt(np.einsum("...ij,...ij->...", matrices, matrices)))


def _from_eigenvalues(matrices: Array, wanted: int) -> Array:
    """Return coefficients as products of eigenvalues, those of balanced matrices."""
    values: NDArray[np.complex128] = np.linalg.eigvals(matrices).astype(complex)
    # The largest first: no partial product is larger than a coefficient of its own.
    order = np.argsort(-np.abs(values), axis=-1)
    values = np.take_along_axis(values, order, axis=-1)
    table = np.zeros((*values.shape[:-1], values.shape[-1] + 1), dtype=complex)
    table[..., 0] = 1.0
    with np.errstate(over="ignore", invalid="ignore"):
        for i in range(values.shape[-1]):
            table[..., 1 : i + 2] -= values[..., i : i + 1] * table[..., : i + 1]
    return np.asarray(table[..., 1 : wanted + 1].real)


def surely_stable(
    polynomial: Array, error: Array, between: Array | None = None
) -> NDArray[np.bool_]:
    """Return where all roots are real, simple and between -2 and 2, whatever the errors.

    A polynomial of degree n that changes sign n times between -2 and 2 has n roots there.  It is
    tried at the ends and at places between its roots; how well those are chosen is of no matter
    to the proof.
    """
    n = polynomial.shape[-1]
    if between is None and n > 4:
        raise ValueError("more than four roots want places between them")
    a = np.moveaxis(polynomial, -1, 0)
    # With z = 2 cos phi a coefficient enters by 2 cos(k phi), the middle one by 1; the rest is the
    # round-off of Horner's rule.
    powers = 2.0 ** np.arange(n, -1, -1)
    size = powers[0] + sum(np.abs(a[j]) * powers[j + 1] for j in range(n))
    with np.errstate(invalid="ignore", over="ignore"):
        least = (2 * n - 1) * error + 4 * n * _EPS * size
        sure = np.ones(polynomial.shape[:-1], dtype=bool)
        inner = _turning(a) if between is None else list(np.moveaxis(between, -1, 0))
        ends = np.full(a[0].shape, 2.0)
        place = -ends
        for i, wanted in enumerate([place, *(np.minimum(t, 2.0) for t in inner), ends]):
            place = np.maximum(place, wanted)  # the proof wants rising places
            value = place + a[0]
            for j in range(1, n):
                value = value * place + a[j]
            sure &= (value if (n - i) % 2 == 0 else -value) > least
    return sure


def _turning(a: Array) -> list[Array]:
    """Return the places where the slope vanishes, rising; anything where they are not all real."""
    n = len(a)
    if n == 1:
        return []
    middle = -a[0] / n
    if n == 2:
        return [middle]
    if n == 3:
        reach = np.sqrt(np.maximum(middle**2 - a[1] / 3.0, 0.0))
        return [middle - reach, middle + reach]
    # Slope / 4 = z^3 + 3 a_1/4 z^2 + a_2/2 z + a_3/4; with z = middle + t: t^3 - 3 p t - 2 q.
    p = middle**2 - a[1] / 6.0
    q = -0.5 * (((middle + 0.75 * a[0]) * middle + 0.5 * a[1]) * middle + 0.25 * a[2])
    root = np.sqrt(np.maximum(p, 0.0))
    with np.errstate(divide="ignore"):
        angle = np.arccos(np.clip(q / root**3, -1.0, 1.0)) / 3.0
    third = 2.0 * np.pi / 3.0
    return [middle + 2.0 * root * np.cos(angle + k * third) for k in (1, 2, 0)]
