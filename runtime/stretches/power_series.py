"""The solution over short stretches as power series about their middles: one kernel for all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Where a series is cut relative to its unit, the last terms it may have, and its most terms.
_CUT, ENDED, MOST_TERMS = 1e-17, 1e-15, 80
# Most growth and decay within half a stretch, together.
_MOST_GROWTH = 1e5
# Terms that are not looked at, as none of them is the last.
_TRUSTED = 4


def stretch_maps(coefficients: Array, places: Array) -> Array | None:
    """Return the matrices from the left ends of stretches to places in them.

    ``Y' = sum_j L_j tau^j Y`` on -1 < tau < 1 with Y(0) = 1 has ``Y = sum_k Y_k tau^k``,
    ``k Y_k = sum_j L_j Y_(k-1-j)``; the matrix to a place is ``Y(tau) Y(-1)^-1``.

    Parameters
    ----------
    coefficients : ndarray
        L_0, L_1, ... side by side, shape ``(..., m, powers m)``.
    places : ndarray
        tau, shape ``(nt,)`` for all stretches or ``(..., nt)``.

    Returns
    -------
    ndarray or None
        Shape ``(..., nt, m, m)``; None where a series has not ended after 80 terms, or the
        solution grows and decays so much within a stretch that it loses digits: the stretches are
        too long.
    """
    *lead, m, wide = coefficients.shape
    flat = coefficients.reshape(-1, m, wide)
    with np.errstate(over="ignore", invalid="ignore"):
        terms = _terms(flat)
    if terms is None:
        return None
    exponents = np.arange(terms.shape[1] - 1, -1, -1.0)
    weights = np.concatenate([np.full_like(places[..., :1], -1.0), places], axis=-1)
    values = (weights[..., None] ** exponents) @ terms.reshape(*lead, len(exponents), m * m)
    values = values.reshape(*lead, -1, m, m)
    begin = np.linalg.inv(values[..., 0, :, :])
    # Growth within a stretch takes digits.
    if not np.max(np.abs(begin)) * np.max(np.abs(values)) <= _MOST_GROWTH:
        return None
    maps: Array = values[..., 1:, :, :] @ begin[..., None, :, :]
    return maps


def _terms(coefficients: Array) -> Array | None:
    """Return the terms ``(k, terms, m, m)``, the last first; None where the series does not end."""
    count, m, wide = coefficients.shape
    powers = wide // m
    # In falling order the products of all coefficients are one product.
    terms = np.empty((count, MOST_TERMS + 1, m, m))
    terms[:, MOST_TERMS] = np.eye(m)
    number, last = 0, 1.0
    while last > _CUT and number < MOST_TERMS:
        number += 1
        used, place = min(number, powers), MOST_TERMS - number
        behind = terms[:, place + 1 : place + 1 + used].reshape(count, used * m, m)
        term = coefficients[:, :, : used * m] @ behind
        term *= 1.0 / number
        terms[:, place] = term
        # Two terms, as every other one may be zero.
        if number >= _TRUSTED and number % 2 == 0:
            last = float(np.max(np.abs(terms[:, place : place + 2])))
            if not np.isfinite(last):
                return None
    return None if last > ENDED else terms[:, MOST_TERMS - number :]
