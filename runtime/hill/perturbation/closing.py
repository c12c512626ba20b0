"""Where damping closes a region of Hill's equation: exactly, and to an order.

With ``y = exp(-K theta) u`` the damped equation at lam2 is the undamped one at ``lam2 - K^2``, and
its region n is open while the half trace D of u exceeds ``cosh(2 pi K)`` somewhere in the undamped
region: it closes at ``K = arccosh(max |D|) / (2 pi)``, the largest Floquet exponent there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.periodic_function import PeriodicFunction
from ..exact.extremum import largest
from ..exact.matrix import hill_boundaries
from ..transfer import EPS
from .effective import EffectiveOperator
from .orders import BEYOND, CONTRACTION, Components, Sums

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Closing:
    """Where one region closes, at points ``(n,)``.

    Attributes
    ----------
    damping, lam2, error : ndarray
        K at which the region closes, the lam2 at which it does, and the figure of K.
    outside : ndarray of bool
        True where the orders do not visibly converge.
    """

    damping: Array
    lam2: Array
    error: Array
    outside: Mask


def exact_closing(f: PeriodicFunction, n: int, mu: Array) -> Closing:
    """Return the critical damping of region n at mu ``(count,)`` from the half trace."""
    ends = hill_boundaries(f, mu, (n,))
    k, place, figure = largest(f, n, mu, (ends.lower[0], ends.upper[0]), ends.error[0])
    return Closing(k, place + k * k, figure, np.zeros(mu.size, dtype=bool))


def sums_at(operator: EffectiveOperator, f: PeriodicFunction, mu: Array, damping: Array) -> Sums:
    """Return the sums of A and B with the round-off that a coupling without detours has.

    The level n^2/4 takes no part in B and Im A, and neither does its round-off.
    """
    n, order = operator.n, operator.order - BEYOND
    a, b = operator.components(np.stack([mu, damping]))
    strength = np.abs(mu) * float(f.amplitudes[1:].sum())
    distance = float({1: 2}.get(n, n - 1))
    noise = f.error * np.abs(mu)
    for k in range(len(b)):
        # Components that vanish term by term carry no round-off either.
        there = np.any(operator.coupling[k] != 0.0)
        noise = noise + (8.0 * EPS * strength * (strength / distance) ** k if there else 0.0)
    noise = noise + 8.0 * EPS * np.abs(a.imag).sum(axis=0)
    shape = np.zeros(mu.shape, dtype=bool)
    return Sums.of(Components(n, order, a, b, noise, strength, ~shape))


def order_closing(operator: EffectiveOperator, f: PeriodicFunction, mu: Array) -> Closing:
    """Return the critical damping to the operator's order less two: ``|B| = |Im A|``."""
    n = operator.n

    def gap(k: Array) -> Array:
        found = sums_at(operator, f, mu, k)
        return found.split - found.drag

    first = gap(np.zeros_like(mu)) / n
    # Where the components overflow there is nothing to start from, and the ratio flags it.
    start = np.where(np.isfinite(first), np.maximum(first, 0.0), 0.0)
    before, value_before = np.zeros_like(mu), first * n
    k = start
    rate = np.full(mu.shape, float(n))
    for _ in range(40):
        value = gap(k)
        step = k - before
        steep = (value_before - value) / np.where(step == 0.0, 1.0, step)
        rate = np.where((step != 0.0) & (steep > 0.25 * n) & (steep < 4.0 * n), steep, rate)
        new = np.clip(k + value / rate, 0.0, 4.0 * start)
        new = np.where(np.isfinite(new), new, k)
        before, value_before, k = k, value, new
        if np.all(np.abs(k - before) <= 2.0 * EPS * k):
            break
    found = sums_at(operator, f, mu, k)
    left = found.turned + found.spread
    outside = ~(found.ratio < CONTRACTION) | ~(left < 0.5 * max(n - 1, 1))
    settled = np.abs(found.split - found.drag) <= np.maximum(left, 1e-9 * found.split)
    return Closing(k, found.centre, left / rate + 4.0 * EPS * k, outside | ~settled)
