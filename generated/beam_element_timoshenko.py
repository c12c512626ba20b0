"""Beam element timoshenko in a turning frame.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_element, formulation timoshenko.
Equations: Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8).

Nodal values in order: u1, v1, r1, u2, v2, r2.

mass M, coupling W = int rho A N^T J N dx, J = [[0, -1], [1, 0]], stiffness K; centripetal is the
mass matrix less rotary inertia. In a frame that turns at the rate w the element has M qdd + 2 w W
qd + (K + Kg - w^2 centripetal + wd W) q.

Axial force P = P0 + P1 s + P2 s^2, s = x/length, tension positive: Kg = P0 geometric_0 + P1
geometric_1 + P2 geometric_2. Load: nodal forces by the end values px1, px2, py1, py2 of a force
per length along and across the element, linear between.

Cost per evaluation:
    element: 216 operations
Content hash a42dbff7f41fc99aa53c6991a2644cb3; derived with SymPy 1.14.0.
"""

__all__ = ["element"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"timoshenko","mechanism":"beam_element",'
    '"modes":null,"outputs":[]}'
)
CONTENT = "a42dbff7f41fc99aa53c6991a2644cb3"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "mass_per_length": ("kg/m", "rho A"),
    "axial_stiffness": ("N", "EA"),
    "bending_stiffness": ("N m^2", "EI"),
    "shear_stiffness": ("N", "k G A"),
    "rotary_inertia": ("kg m", "rho I per length"),
    "length": ("m", "Length of the element"),
}
PARAMETERS = (
    "mass_per_length", "axial_stiffness", "bending_stiffness", "shear_stiffness", "rotary_inertia",
)

# Names of what each function returns, in order.
RETURNS = {
    "element": (
        "mass_1_1", "mass_1_4", "mass_2_2", "mass_2_3", "mass_2_5", "mass_2_6", "mass_3_3",
        "mass_3_5", "mass_3_6", "mass_5_6", "coupling_1_2", "coupling_1_3", "coupling_1_5",
        "coupling_1_6", "coupling_2_1", "coupling_2_4", "coupling_3_1", "coupling_4_3",
        "centripetal_2_2", "centripetal_2_3", "centripetal_2_5", "centripetal_2_6",
        "centripetal_3_3", "centripetal_3_5", "centripetal_3_6", "centripetal_5_6",
        "stiffness_1_1", "stiffness_1_4", "stiffness_2_2", "stiffness_2_3", "stiffness_2_5",
        "stiffness_3_3", "stiffness_3_5", "stiffness_3_6", "geometric_0_2_2", "geometric_0_2_3",
        "geometric_0_2_5", "geometric_0_3_3", "geometric_0_3_5", "geometric_0_3_6",
        "geometric_1_2_2", "geometric_1_2_3", "geometric_1_2_5", "geometric_1_2_6",
        "geometric_1_3_3", "geometric_1_3_5", "geometric_1_3_6", "geometric_1_5_6",
        "geometric_1_6_6", "geometric_2_2_2", "geometric_2_2_3", "geometric_2_2_5",
        "geometric_2_2_6", "geometric_2_3_3", "geometric_2_3_5", "geometric_2_3_6",
        "geometric_2_5_6", "geometric_2_6_6", "load_1_1", "load_1_2", "load_2_3", "load_2_4",
        "load_3_3", "load_3_4", "load_6_3", "load_6_4",
    ),
}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "element": {
        "mass": (
            (6, 6),
            (
                (0, 0, 0), (0, 3, 1), (1, 1, 2), (1, 2, 3), (1, 4, 4), (1, 5, 5), (2, 1, 3),
                (2, 2, 6), (2, 4, 7), (2, 5, 8), (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 7),
                (4, 4, 2), (4, 5, 9), (5, 1, 5), (5, 2, 8), (5, 4, 9), (5, 5, 6),
            ),
        ),
        "coupling": (
            (6, 6),
            (
                (0, 1, 10), (0, 2, 11), (0, 4, 12), (0, 5, 13), (1, 0, 14), (1, 3, 15), (2, 0, 16),
                (2, 3, 13), (3, 1, 12), (3, 2, 17), (3, 4, 10), (3, 5, 16), (4, 0, 15), (4, 3, 14),
                (5, 0, 17), (5, 3, 11),
            ),
        ),
        "centripetal": (
            (6, 6),
            (
                (0, 0, 0), (0, 3, 1), (1, 1, 18), (1, 2, 19), (1, 4, 20), (1, 5, 21), (2, 1, 19),
                (2, 2, 22), (2, 4, 23), (2, 5, 24), (3, 0, 1), (3, 3, 0), (4, 1, 20), (4, 2, 23),
                (4, 4, 18), (4, 5, 25), (5, 1, 21), (5, 2, 24), (5, 4, 25), (5, 5, 22),
            ),
        ),
        "stiffness": (
            (6, 6),
            (
                (0, 0, 26), (0, 3, 27), (1, 1, 28), (1, 2, 29), (1, 4, 30), (1, 5, 29), (2, 1, 29),
                (2, 2, 31), (2, 4, 32), (2, 5, 33), (3, 0, 27), (3, 3, 26), (4, 1, 30), (4, 2, 32),
                (4, 4, 28), (4, 5, 32), (5, 1, 29), (5, 2, 33), (5, 4, 32), (5, 5, 31),
            ),
        ),
        "geometric_0": (
            (6, 6),
            (
                (1, 1, 34), (1, 2, 35), (1, 4, 36), (1, 5, 35), (2, 1, 35), (2, 2, 37), (2, 4, 38),
                (2, 5, 39), (4, 1, 36), (4, 2, 38), (4, 4, 34), (4, 5, 38), (5, 1, 35), (5, 2, 39),
                (5, 4, 38), (5, 5, 37),
            ),
        ),
        "geometric_1": (
            (6, 6),
            (
                (1, 1, 40), (1, 2, 41), (1, 4, 42), (1, 5, 43), (2, 1, 41), (2, 2, 44), (2, 4, 45),
                (2, 5, 46), (4, 1, 42), (4, 2, 45), (4, 4, 40), (4, 5, 47), (5, 1, 43), (5, 2, 46),
                (5, 4, 47), (5, 5, 48),
            ),
        ),
        "geometric_2": (
            (6, 6),
            (
                (1, 1, 49), (1, 2, 50), (1, 4, 51), (1, 5, 52), (2, 1, 50), (2, 2, 53), (2, 4, 54),
                (2, 5, 55), (4, 1, 51), (4, 2, 54), (4, 4, 49), (4, 5, 56), (5, 1, 52), (5, 2, 55),
                (5, 4, 56), (5, 5, 57),
            ),
        ),
        "load": (
            (6, 4),
            (
                (0, 0, 58), (0, 1, 59), (1, 2, 60), (1, 3, 61), (2, 2, 62), (2, 3, 63), (3, 0, 59),
                (3, 1, 58), (4, 2, 61), (4, 3, 60), (5, 2, 64), (5, 3, 65),
            ),
        ),
    },
}


def element(
    length, mass_per_length, axial_stiffness, bending_stiffness, shear_stiffness, rotary_inertia,
):
    """Return the arrays of the element.

    length, mass_per_length, axial_stiffness, bending_stiffness, shear_stiffness, rotary_inertia :
        float
    Returns float or ndarray each.
    """
    x0 = length**2
    x1 = bending_stiffness / x0
    shear_ratio = x1 / shear_stiffness
    x2 = length / 3
    x3 = length / 6
    x4 = 1 / length
    x5 = 12 * shear_ratio + 1
    x6 = 1 / x5**2
    x7 = x4 * x6
    x8 = 6 * x7 / 5
    x9 = x8 * rotary_inertia
    x10 = shear_ratio**2
    x11 = x6 / 35
    x12 = x11 * length * mass_per_length * (294 * shear_ratio + 1680 * x10 + 13)
    x13 = 60 * shear_ratio
    x14 = x6 / 10
    x15 = x14 * rotary_inertia * (x13 - 1)
    x16 = x6 * mass_per_length
    x17 = x0 * x16
    x18 = x17 * (231 * shear_ratio + 1260 * x10 + 11) / 210
    x19 = x18 - x15
    x20 = x6 * length
    x21 = 3 * x20 * mass_per_length * (84 * shear_ratio + 560 * x10 + 3) / 70
    x22 = x17 * (378 * shear_ratio + 2520 * x10 + 13) / 420
    x23 = x15 + x22
    x24 = 360 * x10
    x25 = 15 * shear_ratio
    x26 = x25 + 1
    x27 = 2 * x20 / 15
    x28 = 21 * shear_ratio + 1
    x29 = length**3
    x30 = x16 * x29
    x31 = x30 * (126 * x10 + x28) / 105
    x32 = x13 + 1
    x33 = x30 * (28 * shear_ratio + 168 * x10 + 1) / 140
    x34 = 1 / x5
    x35 = x34 / 20
    x36 = x35 * length
    x37 = x36 * (80 * shear_ratio + 7)
    x38 = x37 * mass_per_length
    x39 = x0 * x35 * (10 * shear_ratio + 1)
    x40 = x39 * mass_per_length
    x41 = x36 * (40 * shear_ratio + 3)
    x42 = x41 * mass_per_length
    x43 = x0 * x26 * x34 / 30
    x44 = x43 * mass_per_length
    x45 = x4 * axial_stiffness
    x46 = x34 * bending_stiffness
    x47 = 12 * x46 / x29
    x48 = 6 * x1 * x34
    x49 = x4 * x46
    x50 = 120 * x10 + 1
    x51 = 20 * shear_ratio + x50
    x52 = x51 * x8
    x53 = x24 + x32
    x54 = x20 / 30
    x55 = 3 * x51 * x7 / 5
    x56 = x14 * (16 * shear_ratio + x50)
    x57 = 4 * x6 * shear_ratio * (x25 + 2) / 5
    x58 = 14 * shear_ratio + 1
    x59 = 12 * x7 * (140 * x10 + x28) / 35
    x60 = x6 / 70
    x61 = x60 * (98 * shear_ratio + 840 * x10 + 5)
    x62 = x11 * (63 * shear_ratio + 420 * x10 + 1)
    return (
        x2 * mass_per_length, x3 * mass_per_length, x12 + x9, x19, x21 - x9, -x23,
        x27 * rotary_inertia * (x24 + x26) + x31, x23,
        x6 * length * rotary_inertia * (720 * x10 - x32) / 30 - x33, -x19, -x38, -x40, -x42, x44,
        x38, x42, x40, -x44, x12, x18, x21, -x22, x31, x22, -x33, -x18, x45, -x45, x47, x48, -x47,
        4 * x49 * (3 * shear_ratio + 1), -x48, -2 * x49 * (6 * shear_ratio - 1), x52, x14, -x52,
        x27 * (90 * x10 + x26), -x14, -x53 * x54, x55, x56, -x55, -x57,
        x54 * (18 * shear_ratio + 180 * x10 + 1), -x56, -x20 * x53 / 60, x57,
        x14 * length * (60 * x10 + x58), x59, x61, -x59, -x62, 2 * x20 * (252 * x10 + x28) / 105,
        -x61, -(56 * shear_ratio + 336 * x10 + 1) * x60 * length, x62,
        3 * x20 * (56 * x10 + x58) / 35, x2, x3, x37, x41, x39, x43, -x43, -x39,
    )
