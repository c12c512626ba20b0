"""Hill's equation with viscous damping.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism hill, formulation plain.
Equations: Smith (7.11); Smith (7.38).

The caller supplies f as a function of the angle, by the name 'f'.

Cost per evaluation:
    scales: 0 operations
Content hash 5162758dfddaa24b387533ad83a55b5b; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "scales",
]

FAMILY = "linear_periodic"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"plain","mechanism":"hill","modes":null,'
    '"outputs":[]}'
)
CONTENT = "5162758dfddaa24b387533ad83a55b5b"
EXTERNAL = ('f',)
MODAL_1 = ((1.0,),)
MODAL_2 = ((2.0,),)

# Parameters: name, unit, meaning.
PARAMETERS = (
    ("lam2", "1/s^2", "Constant part of the stiffness"),
    ("mu", "1/s^2", "Factor of the periodic part f"),
    ("damping", "1/s", "K of 2 K y'"),
)

# Names of what each function returns, in order.
RETURNS = {
    "scales": (
        "damping",
        "lam2",
        "mu",
    ),
}

# Separated terms: array, extra power of the crank speed, scale, function of angle, modal array.
TERMS = (
    ("M", 0, None, None, "modal_1"),
    ("C", 0, "damping", None, "modal_2"),
    ("K", 0, "lam2", None, "modal_1"),
    ("Kg", 0, "mu", "f", "modal_1"),
)


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def scales(lam2, mu, damping):
    """Return the factors made of parameters.

    Parameters
    ----------
    lam2 : float
        Constant part of the stiffness [1/s^2].
    mu : float
        Factor of the periodic part f [1/s^2].
    damping : float
        K of 2 K y' [1/s].

    Returns
    -------
    damping : float or ndarray
        Factor damping.
    lam2 : float or ndarray
        Factor lam2.
    mu : float or ndarray
        Factor mu.
    """
    return (
        damping,
        lam2,
        mu,
    )
