"""Shape functions of the beam element timoshenko.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_shapes, formulation timoshenko.
Equations: Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6).

Nodal values, the columns: u1, v1, r1, u2, v2, r2; u along the axis and v across it, r rotations, k
curvatures; node 3 is the middle.

Cost per evaluation:
    shapes: 86 operations
Content hash 16e8412fbb77ae20bafad652ba258d30; derived with SymPy 1.14.0.
"""

__all__ = ["shapes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"timoshenko","mechanism":"beam_shapes","'
    'modes":null,"outputs":[]}'
)
CONTENT = "16e8412fbb77ae20bafad652ba258d30"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "xi": ("", "Place in the element over its length, 0 to 1"),
    "length": ("m", "Length of the element"),
    "bending_stiffness": ("N m^2", "EI"),
    "shear_stiffness": ("N", "k G A"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "shapes": (
        "u_1_1", "u_1_4", "strain_1_1", "strain_1_4", "v_1_2", "v_1_3", "v_1_5", "v_1_6",
        "slope_1_2", "slope_1_3", "slope_1_5", "slope_1_6", "curvature_1_2", "curvature_1_3",
        "curvature_1_5", "curvature_1_6", "third_1_2", "third_1_3", "third_1_5", "rotation_1_2",
        "rotation_1_3", "rotation_1_5", "rotation_1_6",
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
        "rotation": ((1, 6), ((0, 1, 19), (0, 2, 20), (0, 4, 21), (0, 5, 22))),
        "rotation_slope": ((1, 6), ((0, 1, 12), (0, 2, 13), (0, 4, 14), (0, 5, 15))),
        "rotation_second": ((1, 6), ((0, 1, 16), (0, 2, 17), (0, 4, 18), (0, 5, 17))),
    },
}


def shapes(xi, length, bending_stiffness, shear_stiffness):
    """Return the shape functions and their derivatives by x.

    xi : ndarray, shape (...)
    length, bending_stiffness, shear_stiffness : float
    Returns float or ndarray each.
    """
    x0 = 1 / length**2
    shear_ratio = x0 * bending_stiffness / shear_stiffness
    x1 = 2 * xi - 1
    centred = x1
    x2 = xi - 1
    x3 = 1 / length
    x4 = centred / 2
    x5 = 12 * shear_ratio
    x6 = centred**2
    x7 = x5 + 1
    x8 = 1 / x7
    x9 = x8 * x2
    x10 = 6 * shear_ratio
    x11 = x9 * xi
    x12 = length * x11
    x13 = x8 * xi
    x14 = 6 * x8
    x15 = x14 * x3 * (x6 / 4 - 2 * shear_ratio - 1 / 4)
    x16 = x10 * centred + x4
    x17 = x0 * x14
    x18 = x17 * x1
    x19 = -3 * xi
    x20 = 2 * x3 * x8
    x21 = 3 * xi
    x22 = 12 * x8 / length**3
    x23 = 6 * x3 * x11
    del centred, x1, x11
    return (
        -x2, xi, -x3, x3, x9 * (x4 - x5 + x6 / 2 - 1), x12 * (xi - x10 - 1),
        (x4 - x6 / 2 + x7) * x13, x12 * (x10 + xi), x15, x8 * (3 * x6 / 4 - x16 - 1 / 4), -x15,
        x8 * (x16 + 3 * x6 / 4 - 1 / 4), x18, -x20 * (x10 + x19 + 2), -x18, x20 * (x10 + x21 - 1),
        x22, x17, -x22, x23, x9 * (-x7 - x19), -x23, x13 * (x21 + x5 - 2),
    )
