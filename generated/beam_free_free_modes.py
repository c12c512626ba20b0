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
    slope_products: 51 operations
    slope_squares: 15 operations
Content hash db10ce24ad57a45035c3e77d26138bf3; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["root_defect", "mode_constants", "modes", "slope_products", "slope_squares"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"free_free_modes","mechanism":"beam","mo'
    'des":null,"outputs":[]}'
)
CONTENT = "db10ce24ad57a45035c3e77d26138bf3"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "offset": ("", "Root less its start"),
    "start": ("", "(i + 1/2) pi for mode i"),
    "parity": ("", "1 for modes 1, 3, ..., which are even about the middle; -1 for 2, 4, ..."),
    "defect": ("", "sin(offset) - parity / cosh(root)"),
    "defect_slope": ("", "Its derivative with respect to the offset"),
    "root": ("", "Root b of cos b cosh b = 1: the mode solves psi'''' = b^4 psi"),
    "amplitude": ("", "Modulus of the wave in a mode"),
    "weight": ("", "Factor of the parts that decay from the ends"),
    "end_slope": ("", "psi' of the mode at the right end"),
    "eta": ("", "Place along the beam from its left end, in lengths"),
    "phase": ("rad", "(i + 1) pi / 2 for mode i, or that less whole turns"),
    "value": ("", "psi, of unit square over the beam"),
    "slope": ("", "psi'"),
    "curvature": ("", "psi''"),
    "third": ("", "psi'''"),
    "other": ("", "Root of the other mode"),
    "other_end_slope": ("", "psi' of the other mode at the right end"),
    "other_parity": ("", "Parity of the other mode"),
    "plain": ("", "int psi_i' psi_j' ds over -1/2 < s < 1/2"),
    "first": ("", "int s psi_i' psi_j' ds"),
    "second": ("", "int s^2 psi_i' psi_j' ds"),
    "inward": (
        "", "int s alpha ds of the foreshortening alpha' = -psi_i' psi_j' / 2 without mean",
    ),
    "retreat": ("", "alpha at the left end"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "root_defect": ("defect", "defect_slope"),
    "mode_constants": ("amplitude", "weight", "end_slope"),
    "modes": ("value", "slope", "curvature", "third"),
    "slope_products": ("plain", "first", "second", "inward", "retreat"),
    "slope_squares": ("plain", "second", "inward", "retreat"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def root_defect(offset, start, parity):
    """Return what vanishes at a root, and its slope.

    offset, start, parity : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(offset)
    x0 = xp.exp(-2 * offset - 2 * start)
    x1 = x0 + 1
    x2 = parity * xp.exp(-offset - start)
    x3 = 2 * x2 / x1
    return xp.sin(offset) - x3, x3 - 4 * x0 * x2 / x1**2 + xp.cos(offset)


def mode_constants(root, parity):
    """Return the constants of modes.

    root, parity : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(root)
    x0 = 2 * root
    x1 = parity * xp.exp(-root)
    x2 = 1 / (x1 + 1)
    return x2 * xp.sqrt(2 + 2 * xp.exp(-x0)), x2, x0 * x2 * (1 - x1)


def modes(eta, root, phase, parity, amplitude, weight):
    """Return modes and their derivatives along eta.

    eta, root, phase, parity, amplitude, weight : ndarray, shape (...)
    Returns ndarray, shape (...) each.
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
        x2 * weight + x0, root * (x4 * weight - x3), root**2 * (x2 * weight - x0),
        root**3 * (x4 * weight + x3),
    )


def slope_products(root, other, end_slope, other_end_slope, parity, other_parity):
    """Return integrals of products of slopes of two different modes.

    root, other, end_slope, other_end_slope, parity, other_parity : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x1 = root**4
    x0 = other**4
    x2 = x1 - x0
    x3 = other_parity * parity
    x4 = x3 + 1
    x5 = x0 * end_slope
    x6 = x4 * (x1 * other_end_slope - x5) / x2
    x7 = 1 / x2**2
    x8 = x0 * x1
    x9 = end_slope * other**8 + other_end_slope * root**8 - x0 * x1 * other_end_slope - x1 * x5
    del x2, x0, x1, x5
    x10 = x7 * (x3 - 1) * (16 * x8 + x9)
    return (
        2 * x6, -x10, x4 * x7 * (32 * x8 + x9) / 2,
        4 * x4 * x8 / ((other + root)**2 * (other - root)**2 * (other**2 + root**2)**2),
        x10 / 2 + x6 / 2,
    )


def slope_squares(end_slope):
    """Return integrals of squared slopes.

    end_slope : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = end_slope * (end_slope + 12)
    x1 = end_slope**2
    return x0 / 4, 3 * end_slope / 4 + x1 / 48 - 5 / 2, -x1 / 96 - 5 / 8, x0 / 16
