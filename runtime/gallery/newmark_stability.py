"""Up to which step Newmark's scheme is stable (Aannaque, Fig. 6.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad

Array = NDArray[np.float64]

# Phases omega h between which a loss of stability is looked for, and how finely at first.
_PHASES = np.geomspace(1e-6, 1e6, 481)
_HALVINGS = 60


def newmark_limit(gamma: ArrayLike, beta: ArrayLike, damping: ArrayLike = 0.0) -> Array:
    """Return the largest stable phase ``omega h`` of a step, of one freedom.

    Parameters
    ----------
    gamma, beta : array_like
        Parameters of the scheme; they broadcast.
    damping : array_like
        Damping over the critical, not negative.

    Returns
    -------
    ndarray
        The limit [rad]; inf where no step up to 1e6 is too long (stable without condition), 0
        where none is short enough.

    Raises
    ------
    BadInput
        If a number is not finite, or negative.

    Notes
    -----
    A multiplier may be on the unit circle: so it is at ``gamma = 1/2`` without damping.  The limit
    is where a pair leaves the circle or one multiplier passes -1.
    """
    values = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (gamma, beta, damping)))
    if not all(np.all(np.isfinite(v)) and np.all(v >= 0.0) for v in values):
        raise bad(
            "newmark_limit", "a number that is not finite or negative", "0 or more", "correct it"
        )
    g, b, z = (v[..., None] for v in values)
    held = _stable(g, b, z, _PHASES)
    first = np.argmin(held, axis=-1)
    low = np.where(first > 0, _PHASES[first - 1], 0.0)
    high = _PHASES[first]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        kept = _stable(values[0], values[1], values[2], middle)
        low, high = np.where(kept, middle, low), np.where(kept, high, middle)
    limit = np.where(first > 0, low, 0.0)
    return np.where(np.all(held, axis=-1), np.inf, limit)


def newmark_regions(
    gamma: ArrayLike, beta: ArrayLike, damping: ArrayLike = 0.0
) -> NDArray[np.int64]:
    """Return the region of Fig. 6.1 that a scheme lies in.

    Parameters
    ----------
    gamma, beta, damping : array_like
        As :func:`newmark_limit`.

    Returns
    -------
    ndarray of int
        0 unstable at every step, 1 stable up to a step, 2 stable without condition with two real
        multipliers at long steps, 3 stable without condition with a pair at every step.
    """
    limit = newmark_limit(gamma, beta, damping)
    at = (np.asarray(v, dtype=float) for v in (gamma, beta, damping, _PHASES[-1]))
    turning = margins(*at)[3]
    paired = np.broadcast_to(turning >= 0.0, limit.shape)
    found = np.where(limit > 0.0, 1, 0)
    found = np.where(np.isinf(limit), 2, found)
    return np.where(np.isinf(limit) & paired, 3, found).astype(np.int64)


def margins(gamma: Array, beta: Array, damping: Array, phase: Array) -> tuple[Array, ...]:
    """Return Routh's margins of a step (Aannaque (6.9)-(6.11)), all positive where it is stable.

    Parameters
    ----------
    gamma, beta, damping, phase : ndarray
        Parameters of the scheme, damping over the critical, natural frequency times the step.

    Returns
    -------
    growth, flip, static, turning : ndarray
        1 less the product P of the multipliers; 1 plus their sum S and P; 1 less S plus P; and
        ``P - S^2/4`` over the squared phase: positive for a pair.
    """
    below = 1.0 + 2.0 * damping * gamma * phase + beta * phase**2
    growth = (2.0 * damping * phase + (gamma - 0.5) * phase**2) / below
    turned = 4.0 * damping * (2.0 * gamma - 1.0) * phase
    flip = (4.0 + turned + 2.0 * (2.0 * beta - gamma) * phase**2) / below
    square = (beta - 0.25 * (gamma + 0.5) ** 2) * phase**2
    turning = (1.0 - damping**2 + damping * (gamma - 0.5) * phase + square) / below**2
    return growth, flip, phase**2 / below, turning


def _stable(gamma: Array, beta: Array, damping: Array, phase: Array) -> NDArray[np.bool_]:
    growth, flip, static, _ = margins(gamma, beta, damping, phase)
    value: NDArray[np.bool_] = (growth >= 0.0) & (flip >= 0.0) & (static >= 0.0)
    return value
