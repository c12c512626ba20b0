"""Beam element curvature in a turning frame.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_element, formulation curvature.
Equations: Aannaque (4.11)-(4.24), (4.38), (4.39), (A.3), (A.4), (A.7), (A.8).

Nodal values in order: u1, v1, r1, u2, v2, r2, k1, k2.

mass M, coupling W = int rho A N^T J N dx, J = [[0, -1], [1, 0]], stiffness K; centripetal is the
mass matrix less rotary inertia. In a frame that turns at the rate w the element has M qdd + 2 w W
qd + (K + Kg - w^2 centripetal + wd W) q.

Axial force P = P0 + P1 s + P2 s^2, s = x/length, tension positive: Kg = P0 geometric_0 + P1
geometric_1 + P2 geometric_2. Load: nodal forces by the end values px1, px2, py1, py2 of a force
per length along and across the element, linear between.

Cost per evaluation:
    element: 168 operations
Content hash e65625e2b52dbc47ad6343db6a6fe098; derived with SymPy 1.14.0.
"""

__all__ = ["element"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"curvature","mechanism":"beam_element","'
    'modes":null,"outputs":[]}'
)
CONTENT = "e65625e2b52dbc47ad6343db6a6fe098"

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
        "mass_6_7", "mass_6_8", "mass_7_7", "mass_7_8", "coupling_1_2", "coupling_1_3",
        "coupling_1_5", "coupling_1_6", "coupling_1_7", "coupling_1_8", "coupling_2_1",
        "coupling_2_4", "coupling_3_1", "coupling_4_3", "coupling_7_1", "coupling_7_4",
        "stiffness_1_1", "stiffness_1_4", "stiffness_2_2", "stiffness_2_3", "stiffness_2_5",
        "stiffness_2_7", "stiffness_2_8", "stiffness_3_3", "stiffness_3_5", "stiffness_3_6",
        "stiffness_3_7", "stiffness_3_8", "stiffness_6_7", "stiffness_6_8", "stiffness_7_7",
        "stiffness_7_8", "geometric_0_2_2", "geometric_0_2_3", "geometric_0_2_5",
        "geometric_0_2_7", "geometric_0_2_8", "geometric_0_3_3", "geometric_0_3_5",
        "geometric_0_3_6", "geometric_0_3_7", "geometric_0_3_8", "geometric_0_6_7",
        "geometric_0_6_8", "geometric_0_7_7", "geometric_0_7_8", "geometric_1_2_2",
        "geometric_1_2_3", "geometric_1_2_5", "geometric_1_2_6", "geometric_1_3_3",
        "geometric_1_3_5", "geometric_1_3_6", "geometric_1_3_7", "geometric_1_3_8",
        "geometric_1_5_6", "geometric_1_6_6", "geometric_1_6_7", "geometric_1_6_8",
        "geometric_1_7_7", "geometric_1_7_8", "geometric_1_8_8", "geometric_2_2_2",
        "geometric_2_2_3", "geometric_2_2_5", "geometric_2_2_6", "geometric_2_2_7",
        "geometric_2_2_8", "geometric_2_3_3", "geometric_2_3_5", "geometric_2_3_6",
        "geometric_2_3_7", "geometric_2_3_8", "geometric_2_5_6", "geometric_2_5_7",
        "geometric_2_5_8", "geometric_2_6_6", "geometric_2_6_7", "geometric_2_6_8",
        "geometric_2_7_7", "geometric_2_7_8", "geometric_2_8_8", "load_1_1", "load_2_3",
        "load_2_4", "load_3_3", "load_3_4", "load_6_3", "load_6_4", "load_7_3", "load_7_4",
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
                (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 9), (4, 4, 2), (4, 5, 13), (4, 6, 7),
                (4, 7, 6), (5, 1, 5), (5, 2, 10), (5, 4, 13), (5, 5, 8), (5, 6, 14), (5, 7, 15),
                (6, 1, 6), (6, 2, 11), (6, 4, 7), (6, 5, 14), (6, 6, 16), (6, 7, 17), (7, 1, 7),
                (7, 2, 12), (7, 4, 6), (7, 5, 15), (7, 6, 17), (7, 7, 16),
            ),
        ),
        "coupling": (
            (8, 8),
            (
                (0, 1, 18), (0, 2, 19), (0, 4, 20), (0, 5, 21), (0, 6, 22), (0, 7, 23), (1, 0, 24),
                (1, 3, 25), (2, 0, 26), (2, 3, 21), (3, 1, 20), (3, 2, 27), (3, 4, 18), (3, 5, 26),
                (3, 6, 23), (3, 7, 22), (4, 0, 25), (4, 3, 24), (5, 0, 27), (5, 3, 19), (6, 0, 28),
                (6, 3, 29), (7, 0, 29), (7, 3, 28),
            ),
        ),
        "centripetal": (
            (8, 8),
            (
                (0, 0, 0), (0, 3, 1), (1, 1, 2), (1, 2, 3), (1, 4, 4), (1, 5, 5), (1, 6, 6),
                (1, 7, 7), (2, 1, 3), (2, 2, 8), (2, 4, 9), (2, 5, 10), (2, 6, 11), (2, 7, 12),
                (3, 0, 1), (3, 3, 0), (4, 1, 4), (4, 2, 9), (4, 4, 2), (4, 5, 13), (4, 6, 7),
                (4, 7, 6), (5, 1, 5), (5, 2, 10), (5, 4, 13), (5, 5, 8), (5, 6, 14), (5, 7, 15),
                (6, 1, 6), (6, 2, 11), (6, 4, 7), (6, 5, 14), (6, 6, 16), (6, 7, 17), (7, 1, 7),
                (7, 2, 12), (7, 4, 6), (7, 5, 15), (7, 6, 17), (7, 7, 16),
            ),
        ),
        "stiffness": (
            (8, 8),
            (
                (0, 0, 30), (0, 3, 31), (1, 1, 32), (1, 2, 33), (1, 4, 34), (1, 5, 33), (1, 6, 35),
                (1, 7, 36), (2, 1, 33), (2, 2, 37), (2, 4, 38), (2, 5, 39), (2, 6, 40), (2, 7, 41),
                (3, 0, 31), (3, 3, 30), (4, 1, 34), (4, 2, 38), (4, 4, 32), (4, 5, 38), (4, 6, 36),
                (4, 7, 35), (5, 1, 33), (5, 2, 39), (5, 4, 38), (5, 5, 37), (5, 6, 42), (5, 7, 43),
                (6, 1, 35), (6, 2, 40), (6, 4, 36), (6, 5, 42), (6, 6, 44), (6, 7, 45), (7, 1, 36),
                (7, 2, 41), (7, 4, 35), (7, 5, 43), (7, 6, 45), (7, 7, 44),
            ),
        ),
        "geometric_0": (
            (8, 8),
            (
                (1, 1, 46), (1, 2, 47), (1, 4, 48), (1, 5, 47), (1, 6, 49), (1, 7, 50), (2, 1, 47),
                (2, 2, 51), (2, 4, 52), (2, 5, 53), (2, 6, 54), (2, 7, 55), (4, 1, 48), (4, 2, 52),
                (4, 4, 46), (4, 5, 52), (4, 6, 50), (4, 7, 49), (5, 1, 47), (5, 2, 53), (5, 4, 52),
                (5, 5, 51), (5, 6, 56), (5, 7, 57), (6, 1, 49), (6, 2, 54), (6, 4, 50), (6, 5, 56),
                (6, 6, 58), (6, 7, 59), (7, 1, 50), (7, 2, 55), (7, 4, 49), (7, 5, 57), (7, 6, 59),
                (7, 7, 58),
            ),
        ),
        "geometric_1": (
            (8, 8),
            (
                (1, 1, 60), (1, 2, 61), (1, 4, 62), (1, 5, 63), (1, 6, 49), (2, 1, 61), (2, 2, 64),
                (2, 4, 65), (2, 5, 66), (2, 6, 67), (2, 7, 68), (4, 1, 62), (4, 2, 65), (4, 4, 60),
                (4, 5, 69), (4, 6, 50), (5, 1, 63), (5, 2, 66), (5, 4, 69), (5, 5, 70), (5, 6, 71),
                (5, 7, 72), (6, 1, 49), (6, 2, 67), (6, 4, 50), (6, 5, 71), (6, 6, 73), (6, 7, 74),
                (7, 2, 68), (7, 5, 72), (7, 6, 74), (7, 7, 75),
            ),
        ),
        "geometric_2": (
            (8, 8),
            (
                (1, 1, 76), (1, 2, 77), (1, 4, 78), (1, 5, 79), (1, 6, 80), (1, 7, 81), (2, 1, 77),
                (2, 2, 82), (2, 4, 83), (2, 5, 84), (2, 6, 85), (2, 7, 86), (4, 1, 78), (4, 2, 83),
                (4, 4, 76), (4, 5, 87), (4, 6, 88), (4, 7, 89), (5, 1, 79), (5, 2, 84), (5, 4, 87),
                (5, 5, 90), (5, 6, 91), (5, 7, 92), (6, 1, 80), (6, 2, 85), (6, 4, 88), (6, 5, 91),
                (6, 6, 93), (6, 7, 94), (7, 1, 81), (7, 2, 86), (7, 4, 89), (7, 5, 92), (7, 6, 94),
                (7, 7, 95),
            ),
        ),
        "load": (
            (8, 4),
            (
                (0, 0, 96), (0, 1, 70), (1, 2, 97), (1, 3, 98), (2, 2, 99), (2, 3, 100),
                (3, 0, 70), (3, 1, 96), (4, 2, 98), (4, 3, 97), (5, 2, 101), (5, 3, 102),
                (6, 2, 103), (6, 3, 104), (7, 2, 104), (7, 3, 103),
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
    x5 = 311 * x4 / 4620
    x6 = 151 * x4 / 4620
    x7 = length**3
    x8 = x7 * mass_per_length
    x9 = mass_per_length * length**4
    x10 = 23 * x9 / 18480
    x11 = 13 * x9 / 13860
    x12 = mass_per_length * length**5
    x13 = 5 * length / 14
    x14 = x13 * mass_per_length
    x15 = 13 * x3 / 210
    x16 = x15 * mass_per_length
    x17 = length / 7
    x18 = x17 * mass_per_length
    x19 = 4 * x3 / 105
    x20 = x19 * mass_per_length
    x21 = x7 / 210
    x22 = x21 * mass_per_length
    x23 = x7 / 280
    x24 = x23 * mass_per_length
    x25 = 1 / length
    x26 = x25 * axial_stiffness
    x27 = 120 * bending_stiffness / (7 * x7)
    x28 = 60 * bending_stiffness / (7 * x3)
    x29 = x25 * bending_stiffness
    x30 = 3 * x29 / 7
    x31 = 11 * bending_stiffness / 35
    x32 = 4 * bending_stiffness / 35
    x33 = length / 70
    x34 = 10 * x25 / 7
    x35 = length / 84
    x36 = x3 / 60
    x37 = x3 / 210
    x38 = 5 * x25 / 7
    x39 = 30 * x25 / 77
    x40 = 2 * length / 231
    x41 = length / 308
    return (
        x0 * mass_per_length, x1 * mass_per_length, 181 * x2 / 462, x5, 25 * x2 / 231, -x6,
        281 * x8 / 55440, 181 * x8 / 55440, 52 * x8 / 3465, x6, -19 * x8 / 1980, x10, x11, -x5,
        -x11, -x10, x12 / 9240, x12 / 11088, -x14, -x16, -x18, x20, -x22, -x24, x14, x18, x16,
        -x20, x22, x24, x26, -x26, x27, x28, -x27, x30, -x30, 192 * x29 / 35, -x28, 108 * x29 / 35,
        x31, -x32, x32, -x31, 3 * bending_stiffness * length / 35, x33 * bending_stiffness, x34,
        3 / 14, -x34, x35, -x35, 8 * length / 35, -3 / 14, -x33, x36, x37, -x37, -x36, x7 / 630,
        x7 / 1260, x38, 13 / 84, -x38, 5 / 84, 13 * length / 210, -13 / 84, -length / 140,
        29 * x3 / 5040, 13 * x3 / 5040, -5 / 84, x1, -11 * x3 / 5040, -11 * x3 / 1008, x7 / 1680,
        x7 / 2520, x7 / 1008, x39, 23 / 231, -x39, 1 / 231, x40, x41, 16 * length / 495, -23 / 231,
        -31 * length / 3465, 29 * x3 / 9240, x3 / 495, -1 / 231, -x40, -x41, 95 * length / 693,
        -x3 / 616, -23 * x3 / 2772, x7 / 3080, x7 / 3696, x7 / 1386, x0, x13, x17, x15, x19, -x19,
        -x15, x21, x23,
    )
