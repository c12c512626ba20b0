"""Shape functions of the beam element internal_node.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_shapes, formulation internal_node.
Equations: Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6).

Nodal values, the columns: u1, v1, r1, u2, v2, r2, v3, r3; u along the axis and v across it, r
rotations, k curvatures; node 3 is the middle.

Cost per evaluation:
    shapes: 124 operations
Content hash bfa2c5be802c3648440297862edc5ad3; derived with SymPy 1.14.0.
"""

__all__ = ["shapes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"internal_node","mechanism":"beam_shapes'
    '","modes":null,"outputs":[]}'
)
CONTENT = "bfa2c5be802c3648440297862edc5ad3"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "xi": ("", "Place in the element over its length, 0 to 1"),
    "length": ("m", "Length of the element"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "shapes": (
        "u_1_1", "u_1_4", "strain_1_1", "strain_1_4", "v_1_2", "v_1_3", "v_1_5", "v_1_6", "v_1_7",
        "v_1_8", "slope_1_2", "slope_1_3", "slope_1_5", "slope_1_6", "slope_1_7", "slope_1_8",
        "curvature_1_2", "curvature_1_3", "curvature_1_5", "curvature_1_6", "curvature_1_7",
        "curvature_1_8", "third_1_2", "third_1_3", "third_1_5", "third_1_6", "third_1_7",
        "third_1_8",
    ),
}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "shapes": {
        "u": ((1, 8), ((0, 0, 0), (0, 3, 1))),
        "strain": ((1, 8), ((0, 0, 2), (0, 3, 3))),
        "v": ((1, 8), ((0, 1, 4), (0, 2, 5), (0, 4, 6), (0, 5, 7), (0, 6, 8), (0, 7, 9))),
        "slope": (
            (1, 8), ((0, 1, 10), (0, 2, 11), (0, 4, 12), (0, 5, 13), (0, 6, 14), (0, 7, 15)),
        ),
        "curvature": (
            (1, 8), ((0, 1, 16), (0, 2, 17), (0, 4, 18), (0, 5, 19), (0, 6, 20), (0, 7, 21)),
        ),
        "third": (
            (1, 8), ((0, 1, 22), (0, 2, 23), (0, 4, 24), (0, 5, 25), (0, 6, 26), (0, 7, 27)),
        ),
    },
}


def shapes(xi, length):
    """Return the shape functions and their derivatives by x.

    xi : ndarray, shape (...)
    length : float
    Returns float or ndarray each.
    """
    x0 = 2 * xi
    x1 = x0 - 1
    centred = x1
    x2 = xi - 1
    x3 = 1 / length
    x4 = 6 * xi
    x5 = x2**2
    x6 = x1**2
    x7 = x5 * x6
    x8 = xi**2
    x9 = x6 * x8
    x10 = x5 * x8
    del x6, x5, x8
    x11 = 30 * xi
    x12 = x1 * x2
    x13 = x3 * x12
    x14 = x0 * x13
    x15 = centred / 2
    x16 = centred**2
    x17 = 5 * x16 / 2
    x18 = 5 * x16 / 4 - 1 / 4
    x19 = 12 * x16
    x20 = centred**3
    x21 = 30 * x20 - 15 * centred
    x22 = 1 / length**2
    x23 = 2 * x22
    x24 = 3 * x16
    x25 = 5 * x20 - 3 * centred / 2
    x26 = 2 * x3
    x27 = 8 * centred
    x28 = 1 / length**3
    x29 = 12 * x28
    x30 = 4 * centred
    del x0, x20, centred
    x31 = 6 * x22
    return (
        -x2, xi, -x3, x3, x7 * (x4 + 1), length * x7 * xi, (7 - x4) * x9, length * x2 * x9,
        16 * x10, 8 * length * x1 * x10, x14 * (x11 - 23), x12 * (x15 + x17 - 1), (7 - x11) * x14,
        x1 * xi * (5 * x16 / 2 - x15 - 1), 32 * x13 * xi, 16 * x18 * x2 * xi,
        x23 * (x21 - x19 + 4), x26 * (x25 - x24 + 1 / 2), x23 * (4 - x19 - x21),
        x26 * (x24 + x25 - 1 / 2), 32 * x22 * (3 * x16 / 2 - 1 / 2), 16 * x3 * x1 * (x17 - 3 / 2),
        x29 * (30 * x16 - x27 - 5), x31 * (10 * x16 - x30 - 1), x29 * (5 - 30 * x16 - x27),
        x31 * (10 * x16 + x30 - 1), 192 * x28 * x1, 192 * x22 * x18,
    )
