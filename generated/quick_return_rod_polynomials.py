"""Piecewise polynomial shapes of a rod held at a moving block.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation rod_polynomials.
Equations: Beale & Scott (12)-(14); the same with one polynomial on each side.

The bay is the rod between pin and block, the tail what is beyond. Every shape vanishes at the pin
and at the block, and its slope is continuous at the block.

A basis: the functions through_... with polynomials p that span those of a degree; or one turn,
with j = 1 at the block on both sides, and any number of bubbles.

Cost per evaluation:
    through_bay: 23 operations
    through_tail: 17 operations
    turn_bay: 51 operations
    turn_tail: 28 operations
    bubble_bay: 65 operations
    bubble_tail: 46 operations
Content hash 229a7e8c13e7538c93513650ba84b277; derived with SymPy 1.14.0.
"""

__all__ = ["through_bay", "through_tail", "turn_bay", "turn_tail", "bubble_bay", "bubble_tail"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"rod_polynomials","mechanism":"quick_ret'
    'urn","modes":null,"outputs":[]}'
)
CONTENT = "229a7e8c13e7538c93513650ba84b277"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "eta": ("", "Place on the rod over its length, from the pin"),
    "gap": ("", "eta - xi, without cancellation"),
    "p": ("", "Polynomial in eta"),
    "p_d1": ("", "Derivative 1 of p by eta"),
    "p_d2": ("", "Derivative 2 of p by eta"),
    "p_d3": ("", "Derivative 3 of p by eta"),
    "value": ("", "Shape e"),
    "slope": ("", "First derivative by eta"),
    "curvature": ("", "Second derivative by eta"),
    "shear": ("", "Third derivative by eta"),
    "drift": ("", "Derivative by xi at fixed eta"),
    "drift_curvature": ("", "Second derivative by eta of the derivative by xi"),
    "xi": ("", "The block's place over the rod's length"),
    "s": ("", "Local coordinate of the side, 0 to 1 away from the pin"),
    "length": ("", "Length of the side over the rod's"),
    "j": ("", "Polynomial in s"),
    "j_d1": ("", "Derivative 1 of j by s"),
    "j_d2": ("", "Derivative 2 of j by s"),
    "j_d3": ("", "Derivative 3 of j by s"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "through_bay": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
    "through_tail": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
    "turn_bay": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
    "turn_tail": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
    "bubble_bay": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
    "bubble_tail": ("value", "slope", "curvature", "shear", "drift", "drift_curvature"),
}


def through_bay(eta, gap, p, p_d1, p_d2, p_d3):
    """Return modes eta (eta - xi) p(eta) between pin and block, and their derivatives.

    eta, gap, p, p_d1, p_d2, p_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = p * eta
    x1 = eta * gap
    x2 = eta + gap
    x3 = p_d2 * eta
    x4 = 2 * p_d1
    return (
        x0 * gap, p * x2 + p_d1 * x1, x3 * gap + 2 * p + x2 * x4,
        6 * p_d1 + 3 * p_d2 * x2 + p_d3 * x1, -x0, -x3 - x4,
    )


def through_tail(gap, xi, p, p_d1, p_d2, p_d3):
    """Return modes xi (eta - xi) p(eta) beyond, and their derivatives.

    gap, xi, p, p_d1, p_d2, p_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = p * xi
    x1 = gap * xi
    x2 = 2 * p_d1
    x3 = gap - xi
    return (
        x0 * gap, p_d1 * x1 + x0, p_d2 * x1 + x2 * xi, 3 * p_d2 * xi + p_d3 * x1, p * x3,
        p_d2 * x3 + x2,
    )


def turn_bay(s, length, j, j_d1, j_d2, j_d3):
    """Return shapes length s*(s - 1) j(s) of the bay, and their derivatives.

    s, length, j, j_d1, j_d2, j_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = s - 1
    x1 = x0 * s
    x2 = j_d1 * x0
    x3 = 2 * s - 1
    x4 = 1 / length
    x5 = 2 * j
    x6 = 1 / length**2
    x7 = j_d1 * x6
    x8 = j_d3 * x6
    x9 = j_d2 * x6
    x10 = s**2
    return (
        j * x1 * length, j * x3 + x2 * s, 2 * j_d1 * x3 * x4 + j_d2 * x1 * x4 + x4 * x5,
        x1 * x8 + 3 * x3 * x9 + 6 * x7, -j * x10 - x10 * x2,
        (4 - 7 * s) * x9 * s - x0 * x10 * x8 - x5 * x6 - 2 * x7 * (5 * s - 1),
    )


def turn_tail(s, length, j, j_d1, j_d2, j_d3):
    """Return shapes length s j(s) of the tail, and their derivatives.

    s, length, j, j_d1, j_d2, j_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = 1 / length
    x1 = 2 * j_d1
    x2 = 1 / length**2
    x3 = j_d2 * x2
    x4 = j_d3 * x2 * s
    x5 = s - 1
    return (
        j * length * s, j + j_d1 * s, j_d2 * x0 * s + x0 * x1, 3 * x3 + x4, j_d1 * x5 * s - j,
        x1 * x2 + x3 * (4 * s - 3) + x4 * x5,
    )


def bubble_bay(s, length, j, j_d1, j_d2, j_d3):
    """Return shapes length s*(1 - s)**2 j(s) of the bay, and their derivatives.

    s, length, j, j_d1, j_d2, j_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = s - 1
    x1 = x0**2
    x2 = x1 * s
    x3 = j_d1 * x1
    x4 = 3 * s
    x5 = x4 - 1
    x6 = j * x0
    x7 = x4 - 2
    x8 = 1 / length
    x9 = 2 * x8
    x10 = 1 / length**2
    x11 = 6 * x10
    x12 = j_d3 * x10
    x13 = x10 * x5
    x14 = j_d2 * x0
    x15 = s**2
    x16 = 2 * x10
    return (
        j * x2 * length, x3 * s + x5 * x6, j * x7 * x9 + j_d1 * x0 * x5 * x9 + j_d2 * x2 * x8,
        j * x11 + j_d1 * x11 * x7 + x12 * x2 + 3 * x13 * x14, -2 * x15 * x6 - x15 * x3,
        (
            (10 * s - 12 * x15 - 1) * j_d1 * x16 - 4 * j * x13 - x14 * x16 * s * (5 * s - 2) - x1 *
            x12 * x15
        ),
    )


def bubble_tail(s, length, j, j_d1, j_d2, j_d3):
    """Return shapes length s**2 j(s) of the tail, and their derivatives.

    s, length, j, j_d1, j_d2, j_d3 : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = s**2
    x1 = 2 * j
    x2 = j_d1 * x0
    x3 = 1 / length
    x4 = 1 / length**2
    x5 = 6 * x4
    x6 = j_d2 * s
    x7 = j_d3 * x0 * x4
    x8 = s - 1
    return (
        j * x0 * length, x1 * s + x2, 4 * j_d1 * x3 * s + j_d2 * x0 * x3 + x1 * x3,
        j_d1 * x5 + x5 * x6 + x7, j * s * (s - 2) + x2 * x8,
        2 * j_d1 * x4 * (5 * s - 3) + x1 * x4 + x4 * x6 * (7 * s - 6) + x7 * x8,
    )
