"""Adaptive quadrature along a circuit: length and enclosed area with an error figure."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from math import pi

import numpy as np

from .linkage import Array

_EPS = float(np.finfo(float).eps)
_FEW, _MANY = 10, 16
_HALVINGS = 60
_PANELS = 24
# More panels than this at once: what is left is the round-off of the integrands.
_MOST_PANELS = 2000


@lru_cache(maxsize=2)
def _rule(nodes: int) -> tuple[Array, Array]:
    places, weights = np.polynomial.legendre.leggauss(nodes)
    return places, weights


def integrate_turn(
    f: Callable[[Array], Array], breaks: Array, relative: float = 4.0 * _EPS
) -> tuple[Array, Array]:
    """Integrate over 0 to 2 pi, halving the panels on which two Gauss rules differ.

    Parameters
    ----------
    f : callable
        Parameter, shape (n,), to integrands, shape (k, n).
    breaks : ndarray, shape (b,)
        Parameters at which an integrand has a kink: panels end there.
    relative : float
        A panel is good where the rules differ by no more than this part of the integral of the
        size of the integrand.

    Returns
    -------
    integral, error : ndarray, shape (k,)
        The error is the sum of the differences of the panels, a generous figure, and round-off.
    """
    ends = np.unique(np.concatenate([np.linspace(0, 2 * pi, _PANELS + 1), breaks % (2 * pi)]))
    low, high = ends[:-1], ends[1:]
    total: Array | None = None
    for level in range(_HALVINGS):
        few, _ = _panels(f, low, high, _FEW)
        many, size = _panels(f, low, high, _MANY)
        difference = np.abs(many - few)
        if total is None:
            total, error = np.zeros(len(many)), np.zeros(len(many))
            scale = np.sum(size, axis=1)
            whole = np.zeros(len(many))
        good = np.all(difference <= relative * scale[:, None] / 8, axis=0)
        if level == _HALVINGS - 1 or np.count_nonzero(~good) > _MOST_PANELS:
            good[:] = True
        total = total + np.sum(many[:, good], axis=1)
        error = error + np.sum(difference[:, good], axis=1)
        whole = whole + np.sum(size[:, good], axis=1)
        if np.all(good):
            break
        low, high = low[~good], high[~good]
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    assert total is not None
    return total, error + 8.0 * _EPS * whole


def _panels(
    f: Callable[[Array], Array], low: Array, high: Array, nodes: int
) -> tuple[Array, Array]:
    """Return the integrals of f and of its size over each panel, shape (k, panels)."""
    places, weights = _rule(nodes)
    half = 0.5 * (high - low)
    s = 0.5 * (high + low)[:, None] + half[:, None] * places
    values = f(s.ravel())
    values = values.reshape(len(values), *s.shape)
    return np.sum(values * weights, axis=2) * half, np.sum(np.abs(values) * weights, axis=2) * half
