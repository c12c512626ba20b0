"""Steps of explicit Runge-Kutta methods as matrices."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ..core.namespaces import identity, namespace_of
from .protocol import Array, Generator, at_nodes
from .tableau import ExplicitTableau


def stage_slopes(
    tableau: ExplicitTableau, generator: Generator, theta: Array, step: float
) -> list[Array]:
    """Return the matrices ``K_i`` with stage slope ``k_i = K_i y(theta)``.

    Parameters
    ----------
    tableau : ExplicitTableau
        The method.
    generator : callable
        As in :class:`~.protocol.OneStep`.
    theta : ndarray
        Left ends of the steps [rad], shape ``(ns,)``.
    step : float
        Length of the steps [rad].

    Returns
    -------
    list of ndarray
        One ``(*batch, ns, m, m)`` per stage.  Angles that stages share are evaluated once.
    """
    nodes = sorted(set(tableau.c))
    values = at_nodes(generator, theta, step * np.array([float(c) for c in nodes]))
    slopes: list[Array] = []
    unit = identity(values.shape[-1], values)
    for c, row in zip(tableau.c, tableau.a, strict=True):
        inner = unit
        for weight, slope in zip(row, slopes, strict=True):
            if weight:
                inner = inner + step * float(weight) * slope
        slopes.append(values[..., nodes.index(c), :, :] @ inner)
    return slopes


def explicit_maps(
    tableau: ExplicitTableau, generator: Generator, theta: Array, step: float
) -> Array:
    """Return the step matrices ``I + h sum_i b_i K_i``, shape ``(*batch, ns, m, m)``."""
    slopes = stage_slopes(tableau, generator, theta, step)
    total: Array = summed(tableau.b, slopes, step)
    total = total + identity(total.shape[-1], total)
    return total


def summed(weights: tuple[Fraction, ...], slopes: list[Array], step: float) -> Array:
    """Return ``step sum_i weights[i] slopes[i]``."""
    total: Array = namespace_of(slopes[0]).zeros_like(slopes[0])
    for weight, slope in zip(weights, slopes, strict=True):
        if weight:
            total += step * float(weight) * slope
    return total
