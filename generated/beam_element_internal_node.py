"""Beam element internal_node in a turning frame.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_element, formulation internal_node.
Equations: Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8).

Nodal values in order: u1, v1, r1, u2, v2, r2, v3, r3.

mass M, coupling W = int rho A N^T J N dx, J = [[0, -1], [1, 0]], stiffness K; centripetal is the
mass matrix less rotary inertia. In a frame that turns at the rate w the element has M qdd + 2 w W
qd + (K + Kg - w^2 centripetal + wd W) q.

Axial force P = P0 + P1 s + P2 s^2, s = x/length, tension positive: Kg = P0 geometric_0 + P1
geometric_1 + P2 geometric_2. Load: nodal forces by the end values px1, px2, py1, py2 of a force
per length along and across the element, linear between.

Cost per evaluation:
    element: 202 operations
Content hash 669364f2b799174e94bf5b7731179b3f; derived with SymPy 1.14.0.
"""

__all__ = ["element"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"internal_node","mechanism":"beam_elemen'
    't","modes":null,"outputs":[]}'
)
CONTENT = "669364f2b799174e94bf5b7731179b3f"

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
        "mass_1_1", "mass_1_4", "mass_2_2", "mass_2_3", "mass_2_5", "mass_2_6", "mass_2_7",
        "mass_2_8", "mass_3_3", "mass_3_5", "mass_3_6", "mass_3_7", "mass_3_8", "mass_5_6",
        "mass_5_8", "mass_6_7", "mass_7_7", "mass_8_8", "coupling_1_2", "coupling_1_3",
        "coupling_1_5", "coupling_1_6", "coupling_1_7", "coupling_1_8", "coupling_2_1",
        "coupling_2_4", "coupling_3_1", "coupling_4_3", "coupling_4_8", "coupling_7_1",
        "stiffness_1_1", "stiffness_1_4", "stiffness_2_2", "stiffness_2_3", "stiffness_2_5",
        "stiffness_2_6", "stiffness_2_7", "stiffness_2_8", "stiffness_3_3", "stiffness_3_5",
        "stiffness_3_6", "stiffness_3_7", "stiffness_3_8", "stiffness_5_6", "stiffness_5_8",
        "stiffness_6_7", "stiffness_7_7", "stiffness_8_8", "geometric_0_2_2", "geometric_0_2_3",
        "geometric_0_2_5", "geometric_0_2_6", "geometric_0_2_7", "geometric_0_2_8",
        "geometric_0_3_3", "geometric_0_3_5", "geometric_0_3_6", "geometric_0_3_7",
        "geometric_0_3_8", "geometric_0_5_6", "geometric_0_5_8", "geometric_0_6_7",
        "geometric_0_7_7", "geometric_0_8_8", "geometric_1_2_2", "geometric_1_2_3",
        "geometric_1_2_5", "geometric_1_2_6", "geometric_1_2_7", "geometric_1_2_8",
        "geometric_1_3_3", "geometric_1_3_5", "geometric_1_3_6", "geometric_1_3_8",
        "geometric_1_5_5", "geometric_1_5_7", "geometric_1_5_8", "geometric_1_6_6",
        "geometric_1_6_7", "geometric_1_6_8", "geometric_1_7_7", "geometric_1_7_8",
        "geometric_1_8_8", "geometric_2_2_2", "geometric_2_2_3", "geometric_2_2_5",
        "geometric_2_2_6", "geometric_2_2_7", "geometric_2_2_8", "geometric_2_3_3",
        "geometric_2_3_5", "geometric_2_3_6", "geometric_2_3_8", "geometric_2_5_5",
        "geometric_2_5_6", "geometric_2_5_7", "geometric_2_5_8", "geometric_2_6_6",
        "geometric_2_6_7", "geometric_2_6_8", "geometric_2_7_7", "geometric_2_8_8", "load_1_1",
        "load_1_2", "load_2_3", "load_2_4", "load_3_3", "load_3_4", "load_6_3", "load_6_4",
        "load_7_3", "load_8_3", "load_8_4",
    ),
}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "element": {
        "mass": (
            (8, 8),
            (
                (0, 0, 0), (0, 3, 1), (1, 1, 2), (1, 2, 3), (1, 4, 4), (1, 5, 5), (1, 6, 6),
                (1, 7, 7), (2, 1, 3), (2, 2, 8), (2, 4, 9), (2, 5, 10), (2, 6, 11), (2, 7, 12),
                (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 9), (4, 4, 2), (4, 5, 13), (4, 6, 6),
                (4, 7, 14), (5, 1, 5), (5, 2, 10), (5, 4, 13), (5, 5, 8), (5, 6, 15), (5, 7, 12),
                (6, 1, 6), (6, 2, 11), (6, 4, 6), (6, 5, 15), (6, 6, 16), (7, 1, 7), (7, 2, 12),
                (7, 4, 14), (7, 5, 12), (7, 7, 17),
            ),
        ),
        "coupling": (
            (8, 8),
            (
                (0, 1, 18), (0, 2, 19), (0, 4, 20), (0, 5, 21), (0, 6, 22), (0, 7, 23), (1, 0, 24),
                (1, 3, 25), (2, 0, 26), (2, 3, 21), (3, 1, 20), (3, 2, 27), (3, 4, 18), (3, 5, 26),
                (3, 6, 22), (3, 7, 28), (4, 0, 25), (4, 3, 24), (5, 0, 27), (5, 3, 19), (6, 0, 29),
                (6, 3, 29), (7, 0, 28), (7, 3, 23),
            ),
        ),
        "centripetal": (
            (8, 8),
            (
                (0, 0, 0), (0, 3, 1), (1, 1, 2), (1, 2, 3), (1, 4, 4), (1, 5, 5), (1, 6, 6),
                (1, 7, 7), (2, 1, 3), (2, 2, 8), (2, 4, 9), (2, 5, 10), (2, 6, 11), (2, 7, 12),
                (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 9), (4, 4, 2), (4, 5, 13), (4, 6, 6),
                (4, 7, 14), (5, 1, 5), (5, 2, 10), (5, 4, 13), (5, 5, 8), (5, 6, 15), (5, 7, 12),
                (6, 1, 6), (6, 2, 11), (6, 4, 6), (6, 5, 15), (6, 6, 16), (7, 1, 7), (7, 2, 12),
                (7, 4, 14), (7, 5, 12), (7, 7, 17),
            ),
        ),
        "stiffness": (
            (8, 8),
            (
                (0, 0, 30), (0, 3, 31), (1, 1, 32), (1, 2, 33), (1, 4, 34), (1, 5, 35), (1, 6, 36),
                (1, 7, 37), (2, 1, 33), (2, 2, 38), (2, 4, 39), (2, 5, 40), (2, 6, 41), (2, 7, 42),
                (3, 0, 31), (3, 3, 30), (4, 1, 34), (4, 2, 39), (4, 4, 32), (4, 5, 43), (4, 6, 36),
                (4, 7, 44), (5, 1, 35), (5, 2, 40), (5, 4, 43), (5, 5, 38), (5, 6, 45), (5, 7, 42),
                (6, 1, 36), (6, 2, 41), (6, 4, 36), (6, 5, 45), (6, 6, 46), (7, 1, 37), (7, 2, 42),
                (7, 4, 44), (7, 5, 42), (7, 7, 47),
            ),
        ),
        "geometric_0": (
            (8, 8),
            (
                (1, 1, 48), (1, 2, 49), (1, 4, 50), (1, 5, 51), (1, 6, 52), (1, 7, 53), (2, 1, 49),
                (2, 2, 54), (2, 4, 55), (2, 5, 56), (2, 6, 57), (2, 7, 58), (4, 1, 50), (4, 2, 55),
                (4, 4, 48), (4, 5, 59), (4, 6, 52), (4, 7, 60), (5, 1, 51), (5, 2, 56), (5, 4, 59),
                (5, 5, 54), (5, 6, 61), (5, 7, 58), (6, 1, 52), (6, 2, 57), (6, 4, 52), (6, 5, 61),
                (6, 6, 62), (7, 1, 53), (7, 2, 58), (7, 4, 60), (7, 5, 58), (7, 7, 63),
            ),
        ),
        "geometric_1": (
            (8, 8),
            (
                (1, 1, 64), (1, 2, 65), (1, 4, 66), (1, 5, 67), (1, 6, 68), (1, 7, 69), (2, 1, 65),
                (2, 2, 70), (2, 4, 71), (2, 5, 72), (2, 6, 67), (2, 7, 73), (4, 1, 66), (4, 2, 71),
                (4, 4, 74), (4, 5, 67), (4, 6, 75), (4, 7, 76), (5, 1, 67), (5, 2, 72), (5, 4, 67),
                (5, 5, 77), (5, 6, 78), (5, 7, 79), (6, 1, 68), (6, 2, 67), (6, 4, 75), (6, 5, 78),
                (6, 6, 80), (6, 7, 81), (7, 1, 69), (7, 2, 73), (7, 4, 76), (7, 5, 79), (7, 6, 81),
                (7, 7, 82),
            ),
        ),
        "geometric_2": (
            (8, 8),
            (
                (1, 1, 83), (1, 2, 84), (1, 4, 85), (1, 5, 86), (1, 6, 87), (1, 7, 88), (2, 1, 84),
                (2, 2, 89), (2, 4, 90), (2, 5, 91), (2, 7, 92), (4, 1, 85), (4, 2, 90), (4, 4, 93),
                (4, 5, 94), (4, 6, 95), (4, 7, 96), (5, 1, 86), (5, 2, 91), (5, 4, 94), (5, 5, 97),
                (5, 6, 98), (5, 7, 99), (6, 1, 87), (6, 4, 95), (6, 5, 98), (6, 6, 100),
                (6, 7, 81), (7, 1, 88), (7, 2, 92), (7, 4, 96), (7, 5, 99), (7, 6, 81),
                (7, 7, 101),
            ),
        ),
        "load": (
            (8, 4),
            (
                (0, 0, 102), (0, 1, 103), (1, 2, 104), (1, 3, 105), (2, 2, 106), (2, 3, 107),
                (3, 0, 103), (3, 1, 102), (4, 2, 105), (4, 3, 104), (5, 2, 108), (5, 3, 109),
                (6, 2, 110), (6, 3, 110), (7, 2, 111), (7, 3, 112),
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
    x5 = 19 * x4 / 2310
    x6 = 29 * x4 / 13860
    x7 = 8 * x4 / 693
    x8 = length**3
    x9 = x8 * mass_per_length
    x10 = 2 * x4 / 315
    x11 = 128 * length / 315
    x12 = 79 * length / 420
    x13 = x12 * mass_per_length
    x14 = x3 / 84
    x15 = x14 * mass_per_length
    x16 = 19 * length / 420
    x17 = x16 * mass_per_length
    x18 = x3 / 210
    x19 = x18 * mass_per_length
    x20 = 4 * length / 15
    x21 = x20 * mass_per_length
    x22 = 2 * x3 / 105
    x23 = x22 * mass_per_length
    x24 = 1 / length
    x25 = x24 * axial_stiffness
    x26 = bending_stiffness / x8
    x27 = bending_stiffness / x3
    x28 = 1138 * x27 / 35
    x29 = 242 * x27 / 35
    x30 = 384 * x27 / 7
    x31 = x24 * bending_stiffness
    x32 = 128 * x27 / 5
    x33 = 256 * x24 / 105
    return (
        x0 * mass_per_length, x1 * mass_per_length, 523 * x2 / 3465, x5, 131 * x2 / 6930, -x6,
        4 * x2 / 63, -x7, 2 * x9 / 3465, x6, -x9 / 4620, x10, -x9 / 1155, -x5, x7, -x10,
        x11 * mass_per_length, 32 * x9 / 3465, -x13, -x15, -x17, x19, -x21, x23, x13, x17, x15,
        -x19, -x23, x21, x25, -x25, 5092 * x26 / 35, x28, -1508 * x26 / 35, x29, -512 * x26 / 5,
        x30, 332 * x31 / 35, -x29, 38 * x31 / 35, -x32, 64 * x31 / 7, -x28, -x30, x32,
        1024 * x26 / 5, 256 * x31 / 7, 278 * x24 / 105, 13 / 210, -22 * x24 / 105, -1 / 70, -x33,
        8 / 21, 2 * length / 45, 1 / 70, -length / 126, -8 / 105, -4 * length / 315, -13 / 210,
        -8 / 21, 8 / 105, 512 * x24 / 105, x11, 59 * x24 / 105, 23 / 630, -11 * x24 / 105,
        -8 / 315, -16 * x24 / 35, 4 / 45, length / 210, -1 / 90, -length / 252, 2 * length / 315,
        73 * x24 / 35, -208 * x24 / 105, -92 / 315, 5 * length / 126, 16 / 315, -2 * length / 105,
        x33, 64 / 315, 64 * length / 315, 568 * x24 / 3465, 1 / 66, -56 * x24 / 495, -74 / 3465,
        -16 * x24 / 315, 188 / 3465, 2 * length / 1155, -1 / 66, -length / 330, 8 * length / 1155,
        5848 * x24 / 3465, -2 / 495, -496 * x24 / 315, -892 / 3465, 127 * length / 3465, 8 / 315,
        -64 * length / 3465, 512 * x24 / 315, 64 * length / 495, x0, x1, x12, x16, x14, x18, -x18,
        -x14, x20, -x22, x22,
    )
