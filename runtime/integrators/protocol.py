"""What a one-step method for linear systems is: a matrix per step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.namespaces import namespace_of

Array = NDArray[np.float64]
Generator = Callable[[Array], Array]


@dataclass(frozen=True)
class OneStep:
    """A one-step method for ``y' = L(theta) y``.

    On a linear system a step is a matrix that does not depend on the state, so the steps of one
    period serve all revolutions and all initial values.  Forcing enters as one more state that
    stays 1.

    Attributes
    ----------
    name : str
        Name in the registry.
    order : int
        Order of the global error in the step.
    maps : callable
        ``maps(generator, theta, step)``: generator from angles ``(nt,)`` to ``(*batch, nt, m, m)``,
        left ends of the steps ``(ns,)`` [rad] and their common length [rad], to the matrices
        ``(*batch, ns, m, m)`` with ``y(theta + step) = matrix y(theta)``.  Angles are NumPy's; the
        matrices are of the array namespace of what the generator returns.
    explicit : bool
        Whether the step is limited by stability.
    symplectic : bool
        Whether the matrices are symplectic when the system is undamped.
    """

    name: str
    order: int
    maps: Callable[[Generator, Array, float], Array]
    explicit: bool
    symplectic: bool


def at_nodes(generator: Generator, theta: Array, offsets: Array) -> Array:
    """Evaluate the generator at ``theta_i + offset_j``; return ``(*batch, ns, nodes, m, m)``."""
    angles = theta[:, None] + offsets
    values = generator(angles.ravel())
    shape = (*values.shape[:-3], *angles.shape, *values.shape[-2:])
    reshaped: Array = namespace_of(values).reshape(values, shape)
    return reshaped
