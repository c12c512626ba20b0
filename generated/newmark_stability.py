"""Stability of a step of Newmark's scheme on one damped freedom.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism newmark, formulation stability.
Equations: Aannaque (6.9); Aannaque (6.10); Aannaque (6.11).

The multipliers are within the unit circle where the first three are positive.

Cost per evaluation:
    margins: 41 operations
Content hash faa4ea6f6f671f4ba703a03c276bd42e; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "margins",
]

FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"stability","mechanism":"newmark","modes'
    '":null,"outputs":[]}'
)
CONTENT = "faa4ea6f6f671f4ba703a03c276bd42e"

# Parameters: name, unit, meaning.
PARAMETERS = (
)

# Names of what each function returns, in order.
RETURNS = {
    "margins": (
        "determinant_margin",
        "flip_margin",
        "static_margin",
        "turning",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def margins(gamma, beta, damping, phase):
    """Return the margins of stability of a step, all positive where it is stable.

    Parameters
    ----------
    gamma : ndarray, shape (...)
        Weight of the new acceleration in the velocity.
    beta : ndarray, shape (...)
        Weight of the new acceleration in the displacement.
    damping : ndarray, shape (...)
        Damping over the critical.
    phase : ndarray, shape (...)
        Natural frequency times the step [rad].

    Returns
    -------
    determinant_margin : ndarray, shape (...)
        1 less the product of the multipliers of a step.
    flip_margin : ndarray, shape (...)
        1 plus their sum and product: zero where one is -1.
    static_margin : ndarray, shape (...)
        1 less their sum plus their product: zero where one is +1.
    turning : ndarray, shape (...)
        Product less a quarter of the squared sum, over phase^2: positive for a pair.

    Notes
    -----
    Aannaque (6.9); Aannaque (6.10); Aannaque (6.11).
    """
    x0 = phase**2
    x1 = 2 * gamma
    x2 = damping * phase
    below = x0 * beta + x1 * x2 + 1
    x3 = 1 / below
    x4 = x1 - 1
    x5 = x4 / 2
    return (
        x3 * (x0 * x5 + 2 * x2),
        x3 * (2 * x0 * (2 * beta - gamma) + 4 * x2 * x4 + 4),
        x0 * x3,
        (
            (x0 * (16 * beta - 4 * gamma**2 - 4 * gamma - 1) / 16 + x2 * x5 - (damping + 1) *
            (damping - 1)) / below**2
        ),
    )
