"""Stability proved by signs: the reduced polynomial changes sign between all its roots."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.families import Array

_EPS = float(np.finfo(float).eps)


def surely_stable(
    polynomial: Array, error: Array, between: Array | None = None
) -> NDArray[np.bool_]:
    """Return where all roots are real, simple and between -2 and 2, whatever the errors.

    A polynomial of degree n that changes sign n times between -2 and 2 has n roots there.  It is
    tried at the ends and at places between its roots; how well those are chosen is of no matter
    to the proof.

    Parameters
    ----------
    polynomial : ndarray, shape (..., n)
        ``a_1 ... a_n`` of ``z^n + a_1 z^(n-1) + ...``, z = rho + 1/rho.
    error : ndarray, shape (...)
        Absolute error of each coefficient of the characteristic polynomial in rho.
    between : ndarray, shape (..., n - 1), optional
        Places to try, rising; by default those where the slope vanishes, which needs n <= 4.

    Returns
    -------
    ndarray of bool, shape (...)
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
    q = -0.5 * _cubic(a, middle)
    root = np.sqrt(np.maximum(p, 0.0))
    with np.errstate(divide="ignore"):
        angle = np.arccos(np.clip(q / root**3, -1.0, 1.0)) / 3.0
    third = 2.0 * np.pi / 3.0
    return [middle + 2.0 * root * np.cos(angle + k * third) for k in (1, 2, 0)]


def _cubic(a: Array, z: Array) -> Array:
    """Return a quarter of the slope of a polynomial of degree four."""
    value: Array = ((z + 0.75 * a[0]) * z + 0.5 * a[1]) * z + 0.25 * a[2]
    return value
