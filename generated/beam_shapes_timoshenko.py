"""Shape functions of the beam element timoshenko.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_shapes, formulation timoshenko.
Equations: Aannaque (4.1)-(4.6), (A.1), (A.2), (A.5), (A.6).

Nodal values, the columns: u1, v1, r1, u2, v2, r2; u along the axis and v across it, r rotations, k
curvatures; node 3 is the middle.

Cost per evaluation:
    shapes: 96 operations
Content hash 5d299512f4d18e57fde991b11706db2e; derived with SymPy 1.14.0.
"""

__all__ = ["shapes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"timoshenko","mechanism":"beam_shapes","'
    'modes":null,"outputs":[]}'
)
CONTENT = "5d299512f4d18e57fde991b11706db2e"

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
    x1 = xi - 1
    beyond = -x1
    x3 = 1 / length
    x4 = xi**2
    x5 = 12 * shear_ratio
    x6 = 3 * xi
    x7 = (8 * shear_ratio + 1) * x6 * beyond
    x8 = beyond**2
    x9 = x5 + 1
    x11 = 1 / x9
    x12 = x11 * x1
    x13 = 6 * shear_ratio
    x14 = x13 + 1
    x15 = x12 * xi
    x16 = length * x15
    x17 = x11 * xi
    x18 = 2 * shear_ratio
    x19 = 6 * x11
    x20 = x19 * x3 * (-(4 * shear_ratio + 1) * beyond * xi - x18 * x4 - x18 * x8)
    x21 = 2 * xi
    x22 = x21 * beyond
    x23 = x0 * x19
    x24 = x23 * (x21 - 1)
    x25 = -3 * xi
    x26 = 2 * x11 * x3
    x27 = 12 * x11 / length**3
    x28 = 6 * x3 * x15
    del beyond, x21, x15
    return (
        -x1, xi, -x3, x3, x12 * (-x5 * x4 - x7 - x9 * x8), x16 * (xi - x14),
        (x9 * x4 + x5 * x8 + x7) * x17, x16 * (x13 + xi), x20, x11 * (x14 * x8 - x13 * x4 - x22),
        -x20, x11 * (x14 * x4 - x13 * x8 - x22), x24, -x26 * (x13 + x25 + 2), -x24,
        x26 * (x13 + x6 - 1), x27, x23, -x27, x28, x12 * (-x9 - x25), -x28, x17 * (x5 + x6 - 2),
    )
