"""The fourth-order Magnus method: one matrix exponential per step."""

from __future__ import annotations

import numpy as np

from .expm import expm
from .protocol import Array, Generator, OneStep, at_nodes

_ROOT3 = float(np.sqrt(3.0))


def maps(generator: Generator, theta: Array, step: float) -> Array:
    """Return ``exp(h/2 (L1 + L2) - sqrt(3)/12 h^2 [L1, L2])`` with L at the two Gauss points.

    Parameters and shapes as in :class:`OneStep`.  Exact for constant coefficients, and symplectic
    for undamped systems.
    """
    values = at_nodes(generator, theta, step * (0.5 + np.array([-1.0, 1.0]) * _ROOT3 / 6))
    first, second = values[..., 0, :, :], values[..., 1, :, :]
    commutator = first @ second - second @ first
    return expm(step / 2 * (first + second) - _ROOT3 / 12 * step**2 * commutator)


METHOD = OneStep("magnus4", order=4, maps=maps, explicit=False, symplectic=True)
