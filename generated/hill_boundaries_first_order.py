"""First-order stability boundaries of Hill's equation.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism hill, formulation boundaries_first_order.
Equations: Smith (7.23), (7.25); Smith (7.46), (7.49).

Cost per evaluation:
    first_order: 14 operations
Content hash 60be0f3ea0148f5bc2dafdfe97274f5b; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "first_order",
]

FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"boundaries_first_order","mechanism":"hi'
    'll","modes":null,"outputs":[]}'
)
CONTENT = "60be0f3ea0148f5bc2dafdfe97274f5b"

# Parameters: name, unit, meaning.
PARAMETERS = (
)

# Names of what each function returns, in order.
RETURNS = {
    "first_order": (
        "centre",
        "half_width_squared",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def first_order(n, mu, a0, an, bn, damping):
    """Return the centre and half width of region n in lam2.

    Parameters
    ----------
    n : ndarray or float, shape (...)
        Number of the region, from 1.
    mu : ndarray or float, shape (...)
        Parameter that multiplies f.
    a0 : float or ndarray
        Mean of f.
    an : float or ndarray
        Cosine coefficient n of f.
    bn : float or ndarray
        Sine coefficient n of f.
    damping : float or ndarray
        K of 2 K y'.

    Returns
    -------
    centre : ndarray, shape (...)
        Mean of the two boundaries in lam2.
    half_width_squared : ndarray, shape (...)
        Square of half their distance; negative where damping has closed the tongue.

    Notes
    -----
    Smith (7.23), (7.25); Smith (7.46), (7.49).
    """
    x0 = n**2
    x1 = mu**2 / 4
    return (
        x0 / 4 - a0 * mu,
        x1 * an**2 + x1 * bn**2 - x0 * damping**2,
    )
