"""Shape functions of the beam element curvature.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_shapes, formulation curvature.
Equations: Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6).

Nodal values, the columns: u1, v1, r1, u2, v2, r2, k1, k2; u along the axis and v across it, r
rotations, k curvatures; node 3 is the middle.

Cost per evaluation:
    shapes: 113 operations
Content hash aa0a4bce7744b219c1347fdac100035d; derived with SymPy 1.14.0.
"""

__all__ = ["shapes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"curvature","mechanism":"beam_shapes","m'
    'odes":null,"outputs":[]}'
)
CONTENT = "aa0a4bce7744b219c1347fdac100035d"

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
    x0 = 2 * xi - 1
    centred = x0
    x1 = xi - 1
    x2 = 1 / length
    x3 = x1**3
    x4 = 9 * centred / 2
    x5 = centred**2
    x6 = 3 * x5 / 2
    x7 = x6 + 4
    x8 = 3 * xi
    x9 = length * xi
    x10 = xi**3
    x11 = length * x1
    x12 = xi**2
    x13 = length**2
    x14 = x13 / 2
    x15 = x1**2
    x16 = 30 * x2 * x12 * x15
    x17 = 5 * xi
    x18 = x17 - 2
    x19 = x17 - 3
    x20 = 1 / x13
    x21 = x1 * xi
    x22 = 60 * x20 * x0 * x21
    x23 = 12 * x2 * x21
    x24 = centred + 5 * x5 / 2 - 1 / 2
    x25 = 5 * x5 / 2 - centred - 1 / 2
    x26 = 60 * (x6 - 1 / 2) / length**3
    del x0, x21, x6
    x27 = centred / 2
    x28 = 12 * x20
    x29 = 3 * x2
    return (
        -x1, xi, -x2, x2, (-x4 - x7) * x3, (-1 - x8) * x3 * x9, x10 * (x7 - x4),
        (4 - x8) * x10 * x11, -x14 * x12 * x3, x14 * x10 * x15, -x16, (-1 - x17) * x15 * (x8 - 1),
        x16, (6 - x17) * x12 * (x8 - 2), -x15 * x18 * x9 / 2, x11 * x12 * x19 / 2, -x22,
        -x19 * x23, x22, -x18 * x23, -x1 * x24, x25 * xi, -x26, x28 * (x27 - 15 * x5 / 4 + 5 / 4),
        x26, x28 * (5 / 4 - x27 - 15 * x5 / 4), -x29 * x25, x29 * x24,
    )
