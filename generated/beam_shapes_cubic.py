"""Shape functions of the beam element cubic.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_shapes, formulation cubic.
Equations: Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6).

Nodal values, the columns: u1, v1, r1, u2, v2, r2; u along the axis and v across it, r rotations, k
curvatures; node 3 is the middle.

Cost per evaluation:
    shapes: 36 operations
Content hash 88656bfdb21aeee0ff6354929d48ec53; derived with SymPy 1.14.0.
"""

__all__ = ["shapes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"cubic","mechanism":"beam_shapes","modes'
    '":null,"outputs":[]}'
)
CONTENT = "88656bfdb21aeee0ff6354929d48ec53"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "xi": ("", "Place in the element over its length, 0 to 1"),
    "length": ("m", "Length of the element"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "shapes": (
        "u_1_1", "u_1_4", "strain_1_1", "strain_1_4", "v_1_2", "v_1_3", "v_1_5", "v_1_6",
        "slope_1_2", "slope_1_3", "slope_1_5", "slope_1_6", "curvature_1_2", "curvature_1_3",
        "curvature_1_5", "curvature_1_6", "third_1_2", "third_1_3", "third_1_5",
    ),
}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "shapes": {
        "u": ((1, 6), ((0, 0, 0), (0, 3, 1))),
        "strain": ((1, 6), ((0, 0, 2), (0, 3, 3))),
        "v": ((1, 6), ((0, 1, 4), (0, 2, 5), (0, 4, 6), (0, 5, 7))),
        "slope": ((1, 6), ((0, 1, 8), (0, 2, 9), (0, 4, 10), (0, 5, 11))),
        "curvature": ((1, 6), ((0, 1, 12), (0, 2, 13), (0, 4, 14), (0, 5, 15))),
        "third": ((1, 6), ((0, 1, 16), (0, 2, 17), (0, 4, 18), (0, 5, 17))),
    },
}


def shapes(xi, length):
    """Return the shape functions and their derivatives by x.

    xi : ndarray, shape (...)
    length : float
    Returns float or ndarray each.
    """
    x0 = xi - 1
    x1 = 1 / length
    x2 = x0**2
    x3 = 2 * xi
    x4 = xi**2
    x5 = 6 * x1 * x0 * xi
    x6 = 3 * xi
    x7 = x6 - 1
    x8 = x6 - 2
    x9 = 6 / length**2
    x10 = x9 * (x3 - 1)
    x11 = 2 * x1
    x12 = 12 / length**3
    return (
        -x0, xi, -x1, x1, x2 * (x3 + 1), length * x2 * xi, (3 - x3) * x4, length * x0 * x4, x5,
        x0 * x7, -x5, x8 * xi, x10, x11 * x8, -x10, x11 * x7, x12, x9, -x12,
    )
