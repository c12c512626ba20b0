"""Small linear periodic systems, and how far two of their motions differ."""

from __future__ import annotations

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.trigonometric import resampled
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.equation import equation_of


def named(names):
    """Return scale factors that are the parameters themselves."""
    return lambda values: {name: np.asarray(values[name], dtype=float) for name in names}


def wave(matrix, harmonic=1, phase=0.0):
    """Return a matrix, or a vector, times a cosine of the crank angle."""
    flat = (1,) * np.ndim(matrix)
    return lambda theta: np.cos(harmonic * theta + phase).reshape(-1, *flat) * np.array(matrix)


def mathieu(period=2 * np.pi, **values) -> LinearPeriodic:
    """y'' + 2 K y' + (lam2 + mu cos(2 pi theta / period)) y = 0 at every speed."""
    numbers = {"lam2": 1.3, "mu": 0.4, "K2": 0.0, **values}
    terms = (
        Term("M", None, np.eye(1)),
        Term("K", "lam2", np.eye(1), power=2),
        Term("Kg", "mu", wave(np.eye(1), 2 * np.pi / period), power=2),
        Term("C", "K2", np.eye(1), power=1),
    )
    return LinearPeriodic(1, terms, numbers, named(numbers), period=period)


def is_growing(system, speed, limit, **parameters):
    """Return where a multiplier is larger than 1 by more than a limit."""
    values = floquet_multipliers(system, speed, rtol=1e-13, **parameters).multipliers
    return np.max(np.abs(values), axis=-1) > 1 + limit


def peak_gap(found, other):
    """Return the largest difference of each coordinate over its peak, at common angles."""
    count = max(len(found.theta), len(other.theta))
    one, two = resampled(found.q, count), resampled(other.q, count)
    return np.max(np.abs(one - two), axis=0) / np.max(np.abs(two), axis=0)


def hamiltonian_gap(system, speed, angles):
    """Return how far J L is from symmetric, entries over their natural sizes."""
    flow = equation_of(system, speed).generator(angles)[0]
    n = system.size
    unit = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    hamiltonian = unit @ flow
    odd = np.abs(hamiltonian - np.swapaxes(hamiltonian, -1, -2))
    return float(np.max(odd) / np.max(np.abs(hamiltonian)))
