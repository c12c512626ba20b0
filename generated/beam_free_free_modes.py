"""Elastic modes of a free-free beam.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam, formulation free_free_modes.
Equations: Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).

The forms hold on the roots: the characteristic equation is used in them.  Nothing grows with the
number of the mode but powers of its root.

Cost per evaluation:
    root_defect: 21 operations
    mode_constants: 14 operations
    modes: 31 operations
    slope_products: 35 operations
    slope_squares: 10 operations
Content hash 61392ed13b4cfd79267a2fdad5d74a9d; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "mode_constants",
    "modes",
    "root_defect",
    "slope_products",
    "slope_squares",
]

FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"free_free_modes","mechanism":"beam","mo'
    'des":null,"outputs":[]}'
)
CONTENT = "61392ed13b4cfd79267a2fdad5d74a9d"

# Parameters: name, unit, meaning.
PARAMETERS = (
)

# Names of what each function returns, in order.
RETURNS = {
    "root_defect": (
        "defect",
        "defect_slope",
    ),
    "mode_constants": (
        "amplitude",
        "weight",
        "end_slope",
    ),
    "modes": (
        "value",
        "slope",
        "curvature",
        "third",
    ),
    "slope_products": (
        "plain",
        "first",
        "second",
    ),
    "slope_squares": (
        "plain",
        "second",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def root_defect(offset, start, parity):
    """Return what vanishes at a root, and its slope.

    Parameters
    ----------
    offset : ndarray, shape (...)
        Root less its start.
    start : ndarray, shape (...)
        (i + 1/2) pi for mode i.
    parity : ndarray, shape (...)
        1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ....

    Returns
    -------
    defect : ndarray, shape (...)
        sin(offset) - parity / cosh(root).
    defect_slope : ndarray, shape (...)
        Its derivative with respect to the offset.

    Notes
    -----
    Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).
    """
    xp = _namespace(offset)
    x0 = xp.exp(-2 * offset - 2 * start)
    x1 = x0 + 1
    x2 = parity * xp.exp(-offset - start)
    x3 = 2 * x2 / x1
    return (
        xp.sin(offset) - x3,
        x3 - 4 * x0 * x2 / x1**2 + xp.cos(offset),
    )


def mode_constants(root, parity):
    """Return the constants of modes.

    Parameters
    ----------
    root : ndarray, shape (...)
        Root b of cos b cosh b = 1: the mode solves psi'''' = b^4 psi.
    parity : ndarray, shape (...)
        1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ....

    Returns
    -------
    amplitude : ndarray, shape (...)
        Modulus of the wave in a mode.
    weight : ndarray, shape (...)
        Factor of the parts that decay from the ends.
    end_slope : ndarray, shape (...)
        psi' at the right end; psi itself is 2 there and 2 parity at the left end.

    Notes
    -----
    Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).
    """
    xp = _namespace(root)
    x0 = 2 * root
    x1 = parity * xp.exp(-root)
    x2 = 1 / (x1 + 1)
    return (
        x2 * xp.sqrt(2 + 2 * xp.exp(-x0)),
        x2,
        x0 * x2 * (1 - x1),
    )


def modes(eta, root, phase, parity, amplitude, weight):
    """Return modes and their derivatives along eta.

    Parameters
    ----------
    eta : ndarray, shape (...)
        Place along the beam from its left end, in lengths.
    root : ndarray, shape (...)
        Root b of cos b cosh b = 1: the mode solves psi'''' = b^4 psi.
    phase : ndarray, shape (...)
        (i + 1) pi / 2 for mode i, or that less whole turns [rad].
    parity : ndarray, shape (...)
        1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ....
    amplitude : ndarray, shape (...)
        Modulus of the wave in a mode.
    weight : ndarray, shape (...)
        Factor of the parts that decay from the ends.

    Returns
    -------
    value : ndarray, shape (...)
        psi, of unit square over the beam.
    slope : ndarray, shape (...)
        psi'.
    curvature : ndarray, shape (...)
        psi''.
    third : ndarray, shape (...)
        psi'''.

    Notes
    -----
    Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).
    """
    xp = _namespace(eta)
    place = root * (eta - 1 / 2) - phase
    near = eta * root
    far = root * (1 - eta)
    swing = xp.cos(place)
    turn = xp.sin(place)
    left = xp.exp(-near)
    right = xp.exp(-far)
    del place, near, far
    x0 = amplitude * swing
    x1 = left * parity
    x2 = right + x1
    x3 = amplitude * turn
    del swing, left, turn
    x4 = right - x1
    return (
        x2 * weight + x0,
        root * (x4 * weight - x3),
        root**2 * (x2 * weight - x0),
        root**3 * (x4 * weight + x3),
    )


def slope_products(root, other, end_slope, other_end_slope, parity, other_parity):
    """Return integrals of products of slopes of two different modes.

    Parameters
    ----------
    root : ndarray, shape (...)
        Root b of cos b cosh b = 1: the mode solves psi'''' = b^4 psi.
    other : ndarray, shape (...)
        Root of the other mode.
    end_slope : ndarray, shape (...)
        psi' of the mode at the right end.
    other_end_slope : ndarray, shape (...)
        psi' of the other mode at the right end.
    parity : ndarray, shape (...)
        1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ....
    other_parity : ndarray, shape (...)
        Parity of the other mode.

    Returns
    -------
    plain : ndarray, shape (...)
        int psi_i' psi_j' ds over -1/2 < s < 1/2.
    first : ndarray, shape (...)
        int s psi_i' psi_j' ds.
    second : ndarray, shape (...)
        int s^2 psi_i' psi_j' ds.

    Notes
    -----
    Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).
    """
    x0 = other_parity * parity
    x1 = x0 + 1
    x3 = root**4
    x2 = other**4
    x4 = x3 - x2
    x5 = x2 * end_slope
    x6 = 1 / x4**2
    x7 = x2 * x3
    x8 = end_slope * other**8 + other_end_slope * root**8 - x2 * x3 * other_end_slope - x3 * x5
    return (
        2 * x1 * (x3 * other_end_slope - x5) / x4,
        (1 - x0) * x6 * (16 * x7 + x8),
        x1 * x6 * (32 * x7 + x8) / 2,
    )


def slope_squares(end_slope):
    """Return integrals of squared slopes.

    Parameters
    ----------
    end_slope : ndarray, shape (...)
        psi' of the mode at the right end.

    Returns
    -------
    plain : ndarray, shape (...)
        int psi_i' psi_j' ds over -1/2 < s < 1/2.
    second : ndarray, shape (...)
        int s^2 psi_i' psi_j' ds.

    Notes
    -----
    Beale & Scott (28); Beale & Scott (34)-(36); Beale & Scott (39).
    """
    return (
        end_slope * (end_slope + 12) / 4,
        end_slope**2 / 48 + 3 * end_slope / 4 - 5 / 2,
    )
