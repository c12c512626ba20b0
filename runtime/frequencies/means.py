"""Means of natural frequencies over the period, each with its error."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..floquet.first_order import even_angles

Array = NDArray[np.float64]
# Crank angles to values and their round-off, both (nt, k).
Values = Callable[[Array], tuple[Array, Array]]

_EPS = float(np.finfo(float).eps)
_ENOUGH = 1e-12
_FEWEST, _MOST = 64, 1024
# Nodes of a panel, and panels a period, to begin with.
_NODES = (10, 16)
_PANELS = 12
_HALVINGS = 24
# Panels open at once, beyond which their error is told instead.
_MOST_PANELS = 48


def cycle_mean(
    values: Values,
    period: float,
    breaks: Sequence[float] = (),
    *,
    most: int = _MOST,
    enough: float = _ENOUGH,
) -> tuple[Array, Array]:
    """Return means over the period and their errors, ``(k,)`` each.

    By the trapezoidal rule, which converges geometrically where the values are analytic.  Where
    that is slow, by Gauss-Legendre panels that end at the given angles and are halved where their
    error is: near a veering the values are analytic in a narrow strip, at a crossing their order
    changes.

    Parameters
    ----------
    values : callable
        Crank angles to values and their round-off.
    period : float
        Period [rad].
    breaks : sequence of float
        Angles at which the values are not smooth, or nearly not.
    most : int
        Most angles of the trapezoidal rule.
    enough : float
        Relative error that is small enough.
    """
    count = _FEWEST
    found, rounding = _even(values, period, count)
    while True:
        before, count = found, 2 * count
        found, rounding = _even(values, period, count)
        change = np.abs(found - before)
        if np.all(change <= enough * np.abs(found) + rounding):
            return found, change + rounding
        slow = count >= 256 and len(breaks) > 0
        if slow or 2 * count > most:
            return _by_panels(values, period, breaks, enough)


def _even(values: Values, period: float, count: int) -> tuple[Array, Array]:
    value, error = values(even_angles(period, count))
    # Row by row a plain sum would add a round-off for every angle.
    found = np.array([math.fsum(column) for column in value.T]) / count
    return found, error.mean(axis=0) + 4 * _EPS * np.abs(found)


def _by_panels(
    values: Values, period: float, breaks: Sequence[float], enough: float
) -> tuple[Array, Array]:
    """Return means by panels, each halved until two rules agree."""
    inner = np.unique(np.asarray(breaks, dtype=float) % period)
    start = float(inner[0]) if len(inner) else 0.0
    ends = np.concatenate([inner, start + period * np.arange(_PANELS + 1) / _PANELS])
    ends = np.unique(np.clip(ends, start, start + period))
    panels = np.stack([ends[:-1], ends[1:]], axis=1)
    total: Array | float = 0.0
    error: Array | float = 0.0
    for step in range(_HALVINGS + 1):
        coarse, _ = _panel_integrals(values, panels, _NODES[0])
        fine, rounding = _panel_integrals(values, panels, _NODES[1])
        gap = np.abs(fine - coarse)
        share = (panels[:, 1] - panels[:, 0])[:, None] / period
        allowed = enough * np.abs(fine) + rounding + 0.1 * enough * share * np.max(np.abs(fine))
        last = step == _HALVINGS or len(panels) > _MOST_PANELS
        good = np.all(gap <= allowed, axis=1) | last
        total = total + np.sum(fine[good], axis=0)
        error = error + np.sum(gap[good] + rounding[good], axis=0)
        if np.all(good):
            break
        rest = panels[~good]
        middle = rest.mean(axis=1)
        panels = np.concatenate(
            [np.stack([rest[:, 0], middle], axis=1), np.stack([middle, rest[:, 1]], axis=1)]
        )
    return np.asarray(total / period), np.asarray(error / period)


def _panel_integrals(values: Values, panels: Array, nodes: int) -> tuple[Array, Array]:
    """Return the integral over each panel and its round-off, ``(panels, k)``."""
    place, weight = np.polynomial.legendre.leggauss(nodes)
    half = 0.5 * (panels[:, 1] - panels[:, 0])[:, None]
    theta = panels.mean(axis=1)[:, None] + half * place
    value, error = values(theta.ravel())
    shape = (*theta.shape, -1)
    scaled = half * weight
    found = np.einsum("pn,pnk->pk", scaled, value.reshape(shape))
    rounding = np.einsum("pn,pnk->pk", scaled, error.reshape(shape))
    return found, rounding + 4 * _EPS * np.abs(found)
