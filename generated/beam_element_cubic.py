"""Beam element cubic in a turning frame.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_element, formulation cubic.
Equations: Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8).

Nodal values in order: u1, v1, r1, u2, v2, r2.

mass M, coupling W = int rho A N^T J N dx, J = [[0, -1], [1, 0]], stiffness K; centripetal is the
mass matrix less rotary inertia. In a frame that turns at the rate w the element has M qdd + 2 w W
qd + (K + Kg - w^2 centripetal + wd W) q.

Axial force P = P0 + P1 s + P2 s^2, s = x/length, tension positive: Kg = P0 geometric_0 + P1
geometric_1 + P2 geometric_2. Load: nodal forces by the end values px1, px2, py1, py2 of a force
per length along and across the element, linear between.

Cost per evaluation:
    element: 81 operations
Content hash 2c0707b577f5b64e410b45490f6d1920; derived with SymPy 1.14.0.
"""

__all__ = ["element"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"cubic","mechanism":"beam_element","mode'
    's":null,"outputs":[]}'
)
CONTENT = "2c0707b577f5b64e410b45490f6d1920"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "mass_per_length": ("kg/m", "rho A"),
    "axial_stiffness": ("N", "EA"),
    "bending_stiffness": ("N m^2", "EI"),
    "length": ("m", "Length of the element"),
}
PARAMETERS = ("mass_per_length", "axial_stiffness", "bending_stiffness")

# Names of what each function returns, in order.
RETURNS = {
    "element": (
        "mass_1_1", "mass_1_4", "mass_2_2", "mass_2_3", "mass_2_5", "mass_2_6", "mass_3_3",
        "mass_3_5", "mass_3_6", "mass_5_6", "coupling_1_2", "coupling_1_3", "coupling_1_5",
        "coupling_1_6", "coupling_2_1", "coupling_2_4", "coupling_3_1", "coupling_4_3",
        "stiffness_1_1", "stiffness_1_4", "stiffness_2_2", "stiffness_2_3", "stiffness_2_5",
        "stiffness_3_3", "stiffness_3_5", "stiffness_3_6", "geometric_0_2_2", "geometric_0_2_3",
        "geometric_0_2_5", "geometric_0_3_3", "geometric_0_3_5", "geometric_0_3_6",
        "geometric_1_2_2", "geometric_1_2_5", "geometric_1_3_3", "geometric_1_3_6",
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
                (0, 0, 0), (0, 3, 1), (1, 1, 2), (1, 2, 3), (1, 4, 4), (1, 5, 5), (2, 1, 3),
                (2, 2, 6), (2, 4, 7), (2, 5, 8), (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 7),
                (4, 4, 2), (4, 5, 9), (5, 1, 5), (5, 2, 8), (5, 4, 9), (5, 5, 6),
            ),
        ),
        "stiffness": (
            (6, 6),
            (
                (0, 0, 18), (0, 3, 19), (1, 1, 20), (1, 2, 21), (1, 4, 22), (1, 5, 21), (2, 1, 21),
                (2, 2, 23), (2, 4, 24), (2, 5, 25), (3, 0, 19), (3, 3, 18), (4, 1, 22), (4, 2, 24),
                (4, 4, 20), (4, 5, 24), (5, 1, 21), (5, 2, 25), (5, 4, 24), (5, 5, 23),
            ),
        ),
        "geometric_0": (
            (6, 6),
            (
                (1, 1, 26), (1, 2, 27), (1, 4, 28), (1, 5, 27), (2, 1, 27), (2, 2, 29), (2, 4, 30),
                (2, 5, 31), (4, 1, 28), (4, 2, 30), (4, 4, 26), (4, 5, 30), (5, 1, 27), (5, 2, 31),
                (5, 4, 30), (5, 5, 29),
            ),
        ),
        "geometric_1": (
            (6, 6),
            (
                (1, 1, 32), (1, 2, 27), (1, 4, 33), (2, 1, 27), (2, 2, 34), (2, 4, 30), (2, 5, 35),
                (4, 1, 33), (4, 2, 30), (4, 4, 32), (5, 2, 35), (5, 5, 36),
            ),
        ),
        "geometric_2": (
            (6, 6),
            (
                (1, 1, 37), (1, 2, 38), (1, 4, 39), (1, 5, 40), (2, 1, 38), (2, 2, 41), (2, 4, 42),
                (2, 5, 43), (4, 1, 39), (4, 2, 42), (4, 4, 37), (4, 5, 44), (5, 1, 40), (5, 2, 43),
                (5, 4, 44), (5, 5, 45),
            ),
        ),
        "load": (
            (6, 4),
            (
                (0, 0, 46), (0, 1, 47), (1, 2, 48), (1, 3, 49), (2, 2, 50), (2, 3, 51), (3, 0, 47),
                (3, 1, 46), (4, 2, 49), (4, 3, 48), (5, 2, 52), (5, 3, 53),
            ),
        ),
    },
}


def element(length, mass_per_length, axial_stiffness, bending_stiffness):
    """Return the arrays of the element.

    length, mass_per_length, axial_stiffness, bending_stiffness : float
    Returns float or ndarray each.
    """
    x0 = length / 3
    x1 = length / 6
    x2 = length * mass_per_length
    x3 = length**2
    x4 = x3 * mass_per_length
    x5 = 11 * x4 / 210
    x6 = 13 * x4 / 420
    x7 = length**3
    x8 = x7 * mass_per_length
    x9 = 7 * length / 20
    x10 = x9 * mass_per_length
    x11 = x3 / 20
    x12 = x11 * mass_per_length
    x13 = 3 * length / 20
    x14 = x13 * mass_per_length
    x15 = x3 / 30
    x16 = x15 * mass_per_length
    x17 = 1 / length
    x18 = x17 * axial_stiffness
    x19 = 12 * bending_stiffness / x7
    x20 = 6 * bending_stiffness / x3
    x21 = x17 * bending_stiffness
    x22 = 6 * x17 / 5
    x23 = length / 30
    x24 = 3 * x17 / 5
    x25 = 12 * x17 / 35
    return (
        x0 * mass_per_length, x1 * mass_per_length, 13 * x2 / 35, x5, 9 * x2 / 70, -x6, x8 / 105,
        x6, -x8 / 140, -x5, -x10, -x12, -x14, x16, x10, x14, x12, -x16, x18, -x18, x19, x20, -x19,
        4 * x21, -x20, 2 * x21, x22, 1 / 10, -x22, 2 * length / 15, -1 / 10, -x23, x24, -x24, x23,
        -length / 60, length / 10, x25, 1 / 14, -x25, -1 / 35, 2 * length / 105, -1 / 14,
        -length / 70, 1 / 35, 3 * length / 35, x0, x1, x9, x13, x11, x15, -x15, -x11,
    )
