"""Quick-return mechanism, flexible rod in Buckens' frame, 5 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 5 modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 167 operations
    dynamics: 402 operations
    variations: 575 operations
Content hash be56e70310a73508b983262e9aba91bb; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "constraints",
    "dynamics",
    "variations",
]

FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["rod"],"formulation":"free_free","mechanism":"quick_retu'
    'rn","modes":5,"outputs":[]}'
)
CONTENT = "be56e70310a73508b983262e9aba91bb"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3', 'f4', 'f5')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3', 'psi_4', 'psi_4_d1', 'psi_4_d2', 'psi_4_d3',
    'psi_5', 'psi_5_d1', 'psi_5_d2', 'psi_5_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    8), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (0, 4, 7), (0, 5, 8), (0, 6, 9), (0, 7, 10),
    (1, 0, 11), (1, 1, 3), (1, 2, 12), (1, 3, 13), (1, 4, 14), (1, 5, 13), (1, 6, 14), (1, 7, 13),
    (2, 0, 11), (2, 1, 3), (2, 2, 15), (2, 3, 16), (2, 4, 17), (2, 5, 18), (2, 6, 19), (2, 7,
    20),))}, 'dynamics': {'mass': ((8, 8), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4, 2),
    (5, 5, 2), (6, 6, 2), (7, 7, 2),)), 'rest': ((8, 1), ((2, 0, 3), (3, 0, 4), (4, 0, 5), (5, 0,
    6), (6, 0, 7), (7, 0, 8),)), 'forces': ((8, 1), ()), 'jacobian': ((3, 8), ((0, 0, 9), (0, 1,
    10), (0, 2, 11), (0, 3, 12), (0, 4, 13), (0, 5, 14), (0, 6, 15), (0, 7, 16), (1, 0, 17), (1, 1,
    9), (1, 2, 18), (1, 3, 19), (1, 4, 20), (1, 5, 19), (1, 6, 20), (1, 7, 19), (2, 0, 17), (2, 1,
    9), (2, 2, 21), (2, 3, 22), (2, 4, 23), (2, 5, 24), (2, 6, 25), (2, 7, 26),)), 'velocity_rhs':
    ((3, 1), ((2, 0, 27),)), 'gamma': ((3, 1), ((0, 0, 28), (1, 0, 29), (2, 0, 30),))},
    'variations': {'damping': ((8, 8), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (2, 5, 3), (2, 6, 4), (2,
    7, 5), (3, 2, 6), (4, 2, 7), (5, 2, 8), (6, 2, 9), (7, 2, 10),)), 'stiffness': ((8, 8), ((0, 2,
    11), (1, 2, 12), (2, 0, 11), (2, 1, 12), (2, 2, 13), (2, 3, 14), (2, 4, 15), (2, 5, 16), (2, 6,
    17), (2, 7, 18), (3, 2, 19), (3, 3, 20), (3, 4, 21), (3, 5, 22), (3, 6, 23), (3, 7, 24), (4, 2,
    25), (4, 3, 21), (4, 4, 26), (4, 5, 27), (4, 6, 28), (4, 7, 29), (5, 2, 30), (5, 3, 22), (5, 4,
    27), (5, 5, 31), (5, 6, 32), (5, 7, 33), (6, 2, 34), (6, 3, 23), (6, 4, 28), (6, 5, 32), (6, 6,
    35), (6, 7, 36), (7, 2, 37), (7, 3, 24), (7, 4, 29), (7, 5, 33), (7, 6, 36), (7, 7, 38),)),
    'jacobian_rate': ((3, 8), ((0, 0, 39), (0, 1, 40), (0, 2, 41), (0, 3, 42), (0, 4, 43), (0, 5,
    44), (0, 6, 45), (0, 7, 46), (1, 0, 47), (1, 1, 39), (1, 2, 48), (2, 0, 47), (2, 1, 39), (2, 2,
    49), (2, 3, 50), (2, 4, 51), (2, 5, 52), (2, 6, 53), (2, 7, 54),)), 'jacobian_acceleration':
    ((3, 8), ((0, 0, 55), (0, 1, 56), (0, 2, 57), (0, 3, 58), (0, 4, 59), (0, 5, 60), (0, 6, 61),
    (0, 7, 62), (1, 0, 63), (1, 1, 55), (1, 2, 64), (2, 0, 63), (2, 1, 55), (2, 2, 65), (2, 3, 66),
    (2, 4, 67), (2, 5, 68), (2, 6, 69), (2, 7, 70),))}}
)

# Parameters: name, unit, meaning.
PARAMETERS = (
    ("crank", "m", "Length of the crank"),
    ("frame", "m", "Distance from the pin to the centre of the crank"),
    ("length", "m", "Length of the rod"),
    ("bending_stiffness", "N m^2", "Bending stiffness of the rod"),
    ("mass_per_length", "kg/m", "Mass per length of the rod"),
    ("speed", "rad/s", "Speed of the crank"),
)

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1",
        "constraints_2_1",
        "constraints_3_1",
        "jacobian_1_1",
        "jacobian_1_2",
        "jacobian_1_3",
        "jacobian_1_4",
        "jacobian_1_5",
        "jacobian_1_6",
        "jacobian_1_7",
        "jacobian_1_8",
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
        "jacobian_3_7",
        "jacobian_3_8",
    ),
    "dynamics": (
        "mass_1_1",
        "mass_3_3",
        "mass_4_4",
        "rest_3_1",
        "rest_4_1",
        "rest_5_1",
        "rest_6_1",
        "rest_7_1",
        "rest_8_1",
        "jacobian_1_1",
        "jacobian_1_2",
        "jacobian_1_3",
        "jacobian_1_4",
        "jacobian_1_5",
        "jacobian_1_6",
        "jacobian_1_7",
        "jacobian_1_8",
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
        "jacobian_3_7",
        "jacobian_3_8",
        "velocity_rhs_3_1",
        "gamma_1_1",
        "gamma_2_1",
        "gamma_3_1",
    ),
    "variations": (
        "damping_3_3",
        "damping_3_4",
        "damping_3_5",
        "damping_3_6",
        "damping_3_7",
        "damping_3_8",
        "damping_4_3",
        "damping_5_3",
        "damping_6_3",
        "damping_7_3",
        "damping_8_3",
        "stiffness_1_3",
        "stiffness_2_3",
        "stiffness_3_3",
        "stiffness_3_4",
        "stiffness_3_5",
        "stiffness_3_6",
        "stiffness_3_7",
        "stiffness_3_8",
        "stiffness_4_3",
        "stiffness_4_4",
        "stiffness_4_5",
        "stiffness_4_6",
        "stiffness_4_7",
        "stiffness_4_8",
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_5_6",
        "stiffness_5_7",
        "stiffness_5_8",
        "stiffness_6_3",
        "stiffness_6_6",
        "stiffness_6_7",
        "stiffness_6_8",
        "stiffness_7_3",
        "stiffness_7_7",
        "stiffness_7_8",
        "stiffness_8_3",
        "stiffness_8_8",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_1_4",
        "jacobian_rate_1_5",
        "jacobian_rate_1_6",
        "jacobian_rate_1_7",
        "jacobian_rate_1_8",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_rate_3_6",
        "jacobian_rate_3_7",
        "jacobian_rate_3_8",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4",
        "jacobian_acceleration_1_5",
        "jacobian_acceleration_1_6",
        "jacobian_acceleration_1_7",
        "jacobian_acceleration_1_8",
        "jacobian_acceleration_2_1",
        "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3",
        "jacobian_acceleration_3_4",
        "jacobian_acceleration_3_5",
        "jacobian_acceleration_3_6",
        "jacobian_acceleration_3_7",
        "jacobian_acceleration_3_8",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    R1, R2, gamma, f1, f2, f3, f4, f5, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1,
    psi_2_d2, psi_2_d3, psi_3, psi_3_d1, psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3,
    psi_5, psi_5_d1, psi_5_d2, psi_5_d3, crank, frame, length, bending_stiffness, mass_per_length,
    speed,
):
    """Return the constraints and their Jacobian.

    Parameters
    ----------
    R1 : float or ndarray, shape (...)
        Mean position of the rod along the frame [m].
    R2 : float or ndarray, shape (...)
        Mean position of the rod across the frame [m].
    gamma : float or ndarray, shape (...)
        Mean direction of the rod [rad].
    f1 : float or ndarray, shape (...)
        Amplitude of mode 1, in lengths.
    f2 : float or ndarray, shape (...)
        Amplitude of mode 2, in lengths.
    f3 : float or ndarray, shape (...)
        Amplitude of mode 3, in lengths.
    f4 : float or ndarray, shape (...)
        Amplitude of mode 4, in lengths.
    f5 : float or ndarray, shape (...)
        Amplitude of mode 5, in lengths.
    t : float or ndarray, shape (...)
        Time; the crank angle is speed t [s].
    psi_1 : float or ndarray, shape (...)
        psi of mode 1 at the block.
    psi_1_d1 : float or ndarray, shape (...)
        psi' of mode 1 at the block.
    psi_1_d2 : float or ndarray, shape (...)
        psi'' of mode 1 at the block.
    psi_1_d3 : float or ndarray, shape (...)
        psi''' of mode 1 at the block.
    psi_2 : float or ndarray, shape (...)
        psi of mode 2 at the block.
    psi_2_d1 : float or ndarray, shape (...)
        psi' of mode 2 at the block.
    psi_2_d2 : float or ndarray, shape (...)
        psi'' of mode 2 at the block.
    psi_2_d3 : float or ndarray, shape (...)
        psi''' of mode 2 at the block.
    psi_3 : float or ndarray, shape (...)
        psi of mode 3 at the block.
    psi_3_d1 : float or ndarray, shape (...)
        psi' of mode 3 at the block.
    psi_3_d2 : float or ndarray, shape (...)
        psi'' of mode 3 at the block.
    psi_3_d3 : float or ndarray, shape (...)
        psi''' of mode 3 at the block.
    psi_4 : float or ndarray, shape (...)
        psi of mode 4 at the block.
    psi_4_d1 : float or ndarray, shape (...)
        psi' of mode 4 at the block.
    psi_4_d2 : float or ndarray, shape (...)
        psi'' of mode 4 at the block.
    psi_4_d3 : float or ndarray, shape (...)
        psi''' of mode 4 at the block.
    psi_5 : float or ndarray, shape (...)
        psi of mode 5 at the block.
    psi_5_d1 : float or ndarray, shape (...)
        psi' of mode 5 at the block.
    psi_5_d2 : float or ndarray, shape (...)
        psi'' of mode 5 at the block.
    psi_5_d3 : float or ndarray, shape (...)
        psi''' of mode 5 at the block.
    crank : float or ndarray
        Length of the crank [m].
    frame : float or ndarray
        Distance from the pin to the centre of the crank [m].
    length : float or ndarray
        Length of the rod [m].
    bending_stiffness : float or ndarray
        Bending stiffness of the rod [N m^2].
    mass_per_length : float or ndarray
        Mass per length of the rod [kg/m].
    speed : float or ndarray
        Speed of the crank [rad/s].

    Returns
    -------
    constraints_1_1 : float or ndarray
        Entry of constraints.
    constraints_2_1 : float or ndarray
        Entry of constraints.
    constraints_3_1 : float or ndarray
        Entry of constraints.
    jacobian_1_1 : float or ndarray
        Entry of jacobian.
    jacobian_1_2 : float or ndarray
        Entry of jacobian.
    jacobian_1_3 : float or ndarray
        Entry of jacobian.
    jacobian_1_4 : float or ndarray
        Entry of jacobian.
    jacobian_1_5 : float or ndarray
        Entry of jacobian.
    jacobian_1_6 : float or ndarray
        Entry of jacobian.
    jacobian_1_7 : float or ndarray
        Entry of jacobian.
    jacobian_1_8 : float or ndarray
        Entry of jacobian.
    jacobian_2_1 : float or ndarray
        Entry of jacobian.
    jacobian_2_3 : float or ndarray
        Entry of jacobian.
    jacobian_2_4 : float or ndarray
        Entry of jacobian.
    jacobian_2_5 : float or ndarray
        Entry of jacobian.
    jacobian_3_3 : float or ndarray
        Entry of jacobian.
    jacobian_3_4 : float or ndarray
        Entry of jacobian.
    jacobian_3_5 : float or ndarray
        Entry of jacobian.
    jacobian_3_6 : float or ndarray
        Entry of jacobian.
    jacobian_3_7 : float or ndarray
        Entry of jacobian.
    jacobian_3_8 : float or ndarray
        Entry of jacobian.

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1 + f5 * psi_5_d1
    value = f1 * psi_1 + f2 * psi_2 + f3 * psi_3 + f4 * psi_4 + f5 * psi_5
    x0 = f4 * length
    x1 = f3 * length
    x2 = 17.688755938278415 * x1
    x3 = f5 * length
    x4 = 18.303757610682673 * x3
    x5 = 39.05057971910695 * x1
    x6 = 93.42823304738424 * x3
    x7 = 65.85693087627438 * x1
    x8 = f1 * length
    x9 = 18.518623509610325 * x8
    x10 = 31.24773431610854 * x3
    x11 = 42.23903821396198 * x1
    x12 = 22.226509490533974 * x8
    x13 = xp.cos(gamma)
    x14 = R1 * x13
    x15 = xp.sin(gamma)
    x16 = R2 * x15
    x17 = x14 + x16
    x18 = 2 * length
    x19 = R1 * x15
    x20 = R2 * x13 - x19
    x21 = gamma - t * speed
    x22 = crank * xp.sin(x21)
    x23 = x15 * frame
    x24 = f2 * length
    x25 = 1 / length
    return (
        (
            12.370205669468392 * length * f1**2 + f1 * x2 + f1 * x4 + 27.23114806299836 * length *
            f2**2 + 28.794406523989263 * f2 * x0 - f2 * x10 - f2 * x11 - f2 * x12 +
            46.71667822409441 * length * f3**2 + 71.17078590282887 * length * f4**2 - f4 * x6 - f4
            * x7 - f4 * x9 + 100.55701233363588 * length * f5**2 + f5 * x5 - length / 2 + x17
        ),
        f1 * x18 - f2 * x18 + f3 * x18 - f4 * x18 + f5 * x18 + x20,
        value * length + x20 + x22 + x23,
        x13,
        x15,
        R2 * x13 - x19,
        x2 - 18.518623509610325 * x0 - 22.226509490533974 * x24 + x4 + 24.740411338936784 * x8,
        54.46229612599672 * f2 * length + 28.794406523989263 * f4 * length - x10 - x11 - x12,
        (
            93.43335644818882 * x1 - 65.85693087627438 * x0 - 42.23903821396198 * x24 +
            39.05057971910695 * x3 + 17.688755938278415 * x8
        ),
        28.794406523989263 * f2 * length + 142.34157180565774 * f4 * length - x6 - x7 - x9,
        (
            201.11402466727176 * x3 - 93.42823304738424 * x0 - 31.24773431610854 * x24 + x5 +
            18.303757610682673 * x8
        ),
        -x15,
        -x17,
        x18,
        -x18,
        (
            crank * xp.cos(x21) + x13 * frame + (-slope * length * (x22 * x25 + x23 * x25)) - x14 -
            x16
        ),
        psi_1 * length,
        psi_2 * length,
        psi_3 * length,
        psi_4 * length,
        psi_5 * length,
    )


def dynamics(
    R1, R2, gamma, f1, f2, f3, f4, f5, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, f4_dot,
    f5_dot, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, psi_3,
    psi_3_d1, psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3, psi_5, psi_5_d1, psi_5_d2,
    psi_5_d3, crank, frame, length, bending_stiffness, mass_per_length, speed,
):
    """Return everything in the equations of motion at acceleration level.

    Parameters
    ----------
    R1 : float or ndarray, shape (...)
        Mean position of the rod along the frame [m].
    R2 : float or ndarray, shape (...)
        Mean position of the rod across the frame [m].
    gamma : float or ndarray, shape (...)
        Mean direction of the rod [rad].
    f1 : float or ndarray, shape (...)
        Amplitude of mode 1, in lengths.
    f2 : float or ndarray, shape (...)
        Amplitude of mode 2, in lengths.
    f3 : float or ndarray, shape (...)
        Amplitude of mode 3, in lengths.
    f4 : float or ndarray, shape (...)
        Amplitude of mode 4, in lengths.
    f5 : float or ndarray, shape (...)
        Amplitude of mode 5, in lengths.
    R1_dot : float or ndarray, shape (...)
        Velocity R1_dot.
    R2_dot : float or ndarray, shape (...)
        Velocity R2_dot.
    gamma_dot : float or ndarray, shape (...)
        Velocity gamma_dot.
    f1_dot : float or ndarray, shape (...)
        Velocity f1_dot.
    f2_dot : float or ndarray, shape (...)
        Velocity f2_dot.
    f3_dot : float or ndarray, shape (...)
        Velocity f3_dot.
    f4_dot : float or ndarray, shape (...)
        Velocity f4_dot.
    f5_dot : float or ndarray, shape (...)
        Velocity f5_dot.
    t : float or ndarray, shape (...)
        Time; the crank angle is speed t [s].
    psi_1 : float or ndarray, shape (...)
        psi of mode 1 at the block.
    psi_1_d1 : float or ndarray, shape (...)
        psi' of mode 1 at the block.
    psi_1_d2 : float or ndarray, shape (...)
        psi'' of mode 1 at the block.
    psi_1_d3 : float or ndarray, shape (...)
        psi''' of mode 1 at the block.
    psi_2 : float or ndarray, shape (...)
        psi of mode 2 at the block.
    psi_2_d1 : float or ndarray, shape (...)
        psi' of mode 2 at the block.
    psi_2_d2 : float or ndarray, shape (...)
        psi'' of mode 2 at the block.
    psi_2_d3 : float or ndarray, shape (...)
        psi''' of mode 2 at the block.
    psi_3 : float or ndarray, shape (...)
        psi of mode 3 at the block.
    psi_3_d1 : float or ndarray, shape (...)
        psi' of mode 3 at the block.
    psi_3_d2 : float or ndarray, shape (...)
        psi'' of mode 3 at the block.
    psi_3_d3 : float or ndarray, shape (...)
        psi''' of mode 3 at the block.
    psi_4 : float or ndarray, shape (...)
        psi of mode 4 at the block.
    psi_4_d1 : float or ndarray, shape (...)
        psi' of mode 4 at the block.
    psi_4_d2 : float or ndarray, shape (...)
        psi'' of mode 4 at the block.
    psi_4_d3 : float or ndarray, shape (...)
        psi''' of mode 4 at the block.
    psi_5 : float or ndarray, shape (...)
        psi of mode 5 at the block.
    psi_5_d1 : float or ndarray, shape (...)
        psi' of mode 5 at the block.
    psi_5_d2 : float or ndarray, shape (...)
        psi'' of mode 5 at the block.
    psi_5_d3 : float or ndarray, shape (...)
        psi''' of mode 5 at the block.
    crank : float or ndarray
        Length of the crank [m].
    frame : float or ndarray
        Distance from the pin to the centre of the crank [m].
    length : float or ndarray
        Length of the rod [m].
    bending_stiffness : float or ndarray
        Bending stiffness of the rod [N m^2].
    mass_per_length : float or ndarray
        Mass per length of the rod [kg/m].
    speed : float or ndarray
        Speed of the crank [rad/s].

    Returns
    -------
    mass_1_1 : float or ndarray
        Entry of mass.
    mass_3_3 : float or ndarray
        Entry of mass.
    mass_4_4 : float or ndarray
        Entry of mass.
    rest_3_1 : float or ndarray
        Entry of rest.
    rest_4_1 : float or ndarray
        Entry of rest.
    rest_5_1 : float or ndarray
        Entry of rest.
    rest_6_1 : float or ndarray
        Entry of rest.
    rest_7_1 : float or ndarray
        Entry of rest.
    rest_8_1 : float or ndarray
        Entry of rest.
    jacobian_1_1 : float or ndarray
        Entry of jacobian.
    jacobian_1_2 : float or ndarray
        Entry of jacobian.
    jacobian_1_3 : float or ndarray
        Entry of jacobian.
    jacobian_1_4 : float or ndarray
        Entry of jacobian.
    jacobian_1_5 : float or ndarray
        Entry of jacobian.
    jacobian_1_6 : float or ndarray
        Entry of jacobian.
    jacobian_1_7 : float or ndarray
        Entry of jacobian.
    jacobian_1_8 : float or ndarray
        Entry of jacobian.
    jacobian_2_1 : float or ndarray
        Entry of jacobian.
    jacobian_2_3 : float or ndarray
        Entry of jacobian.
    jacobian_2_4 : float or ndarray
        Entry of jacobian.
    jacobian_2_5 : float or ndarray
        Entry of jacobian.
    jacobian_3_3 : float or ndarray
        Entry of jacobian.
    jacobian_3_4 : float or ndarray
        Entry of jacobian.
    jacobian_3_5 : float or ndarray
        Entry of jacobian.
    jacobian_3_6 : float or ndarray
        Entry of jacobian.
    jacobian_3_7 : float or ndarray
        Entry of jacobian.
    jacobian_3_8 : float or ndarray
        Entry of jacobian.
    velocity_rhs_3_1 : float or ndarray
        Entry of velocity_rhs.
    gamma_1_1 : float or ndarray
        Entry of gamma.
    gamma_2_1 : float or ndarray
        Entry of gamma.
    gamma_3_1 : float or ndarray
        Entry of gamma.

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2 + f4 * psi_4_d2 + f5 * psi_5_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1 + f5 * psi_5_d1
    slope_rate = (
        f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1 + f4_dot * psi_4_d1 + f5_dot *
        psi_5_d1
    )
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 2.0497641363910746 * x1
    x3 = 5.3973948475526035 * x1
    x4 = 10.32460660632931 * x1
    x5 = 16.905002306592664 * x1
    x6 = 25.12962482381789 * x1
    x7 = f2 * x1
    x8 = gamma_dot * x7
    x9 = gamma_dot * x1
    x10 = f1 * x1
    x11 = gamma_dot * x10
    x12 = f3 * x1
    x13 = gamma_dot * x12
    x14 = 1 / length
    x15 = x14 * bending_stiffness
    x16 = gamma_dot**2
    x17 = 0.587445490384929 * x16
    x18 = x1 * x16
    x19 = f5 * x18
    x20 = xp.cos(gamma)
    x21 = xp.sin(gamma)
    x22 = R1 * x21
    x23 = R2 * x20
    x24 = x22 - x23
    x25 = f1 * length
    x26 = f2 * length
    x27 = f3 * length
    x28 = f4 * length
    x29 = f5 * length
    x30 = R1 * x20
    x31 = R2 * x21
    x32 = -x30 - x31
    x33 = 2 * length
    x34 = x20 * frame
    x35 = gamma - t * speed
    x36 = xp.cos(x35)
    x37 = x36 * crank
    x38 = x21 * frame
    x39 = xp.sin(x35)
    x40 = x39 * crank
    x41 = -x14 * x38 - x14 * x40
    x42 = x40 * speed
    x43 = R2_dot * x20
    x44 = f1_dot * length
    x45 = f2_dot * length
    x46 = f3_dot * length
    x47 = f4_dot * length
    x48 = f5_dot * length
    x49 = R1_dot * x20
    x50 = R2_dot * x21
    x51 = x49 + x50
    x52 = gamma_dot * x49 + gamma_dot * x50
    x53 = speed**2
    x54 = x41 * x42
    x55 = gamma_dot * length
    x56 = x37 * speed
    return (
        length * mass_per_length,
        (
            1.174890980769858 * f1 * f3 * x0 * mass_per_length - x2 * f1**2 + 0.18174011294434841 *
            f1 * f5 * x0 * mass_per_length - x3 * f2**2 + 3.7222403187279935 * f2 * f4 * x0 *
            mass_per_length - x4 * f3**2 + 7.508573126562312 * f3 * f5 * x0 * mass_per_length - x5
            * f4**2 - x6 * f5**2 + x0 * mass_per_length / 12
        ),
        x1,
        (
            f1_dot * (1.174890980769858 * f3 * x9 + 0.18174011294434841 * f5 * x9 -
            4.099528272782149 * x11) + f2_dot * (3.7222403187279935 * f4 * gamma_dot * x0 *
            mass_per_length - 10.794789695105207 * x8) + f3_dot * (7.508573126562312 * f5 * x9 +
            1.174890980769858 * x11 - 20.64921321265862 * x13) + f4_dot * (3.7222403187279935 * x8
            - 33.81000461318533 * f4 * x9) + f5_dot * (0.18174011294434841 * x11 -
            50.25924964763578 * f5 * x9 + 7.508573126562312 * x13)
        ),
        500.5639017404326 * f1 * x15 + f1 * x16 * x2 - x12 * x17 - 0.09087005647217421 * x19,
        3803.5370804978666 * f2 * x15 + f2 * x16 * x3 - 1.8611201593639968 * f4 * x18,
        14617.630131122343 * f3 * x15 + f3 * x16 * x4 - x10 * x17 - 3.754286563281156 * x19,
        39943.799005709305 * f4 * x15 + f4 * x16 * x5 - 1.8611201593639968 * x16 * x7,
        (
            89135.40765718032 * f5 * x15 + f5 * x16 * x6 - 0.09087005647217421 * x10 * x16 -
            3.754286563281156 * x12 * x16
        ),
        x20,
        x21,
        -x24,
        (
            24.740411338936784 * x25 - 22.226509490533974 * x26 + 17.688755938278415 * x27 -
            18.518623509610325 * x28 + 18.303757610682673 * x29
        ),
        (
            54.46229612599672 * f2 * length + 28.794406523989263 * f4 * length - 22.226509490533974
            * x25 - 42.23903821396198 * x27 - 31.24773431610854 * x29
        ),
        (
            17.688755938278415 * x25 - 42.23903821396198 * x26 + 93.43335644818882 * x27 -
            65.85693087627438 * x28 + 39.05057971910695 * x29
        ),
        (
            28.794406523989263 * f2 * length + 142.34157180565774 * f4 * length -
            18.518623509610325 * x25 - 65.85693087627438 * x27 - 93.42823304738424 * x29
        ),
        (
            18.303757610682673 * x25 - 31.24773431610854 * x26 + 39.05057971910695 * x27 -
            93.42823304738424 * x28 + 201.11402466727176 * x29
        ),
        -x21,
        x32,
        x33,
        -x33,
        slope * x41 * length - x30 - x31 + x34 + x37,
        length * psi_1,
        length * psi_2,
        length * psi_3,
        length * psi_4,
        length * psi_5,
        x36 * crank * speed - slope * x42,
        (
            R1_dot * gamma_dot * x21 - f1_dot * (24.740411338936784 * x44 - 22.226509490533974 *
            x45 + 17.688755938278415 * x46 - 18.518623509610325 * x47 + 18.303757610682673 * x48) -
            f2_dot * (54.46229612599672 * f2_dot * length + 28.794406523989263 * f4_dot * length -
            22.226509490533974 * x44 - 42.23903821396198 * x46 - 31.24773431610854 * x48) - f3_dot
            * (17.688755938278415 * x44 - 42.23903821396198 * x45 + 93.43335644818882 * x46 -
            65.85693087627438 * x47 + 39.05057971910695 * x48) - f4_dot * (28.794406523989263 *
            f2_dot * length + 142.34157180565774 * f4_dot * length - 18.518623509610325 * x44 -
            65.85693087627438 * x46 - 93.42823304738424 * x48) - f5_dot * (18.303757610682673 * x44
            - 31.24773431610854 * x45 + 39.05057971910695 * x46 - 93.42823304738424 * x47 +
            201.11402466727176 * x48) - gamma_dot * x43 - gamma_dot * (gamma_dot * x32 - R1_dot *
            x21 + x43)
        ),
        (x51 - gamma_dot * x24) * gamma_dot + x52,
        (
            -curvature * (x14 * x53 * x39**2 * crank**2 + gamma_dot * x54 + gamma_dot * (x55 *
            x41**2 + x54)) - gamma_dot * x42 - gamma_dot * (x39 * crank * speed + gamma_dot * (x22
            - x23 - x38 - x40) - x51) + slope * (x36 * x53 * crank - gamma_dot * x56 - gamma_dot *
            (-x55 * (x14 * x34 + x14 * x37) + x56)) + (-slope_rate * (gamma_dot * x33 * x41 + 2 *
            x42)) + x40 * x53 + x52
        ),
    )


def variations(
    R1, R2, gamma, f1, f2, f3, f4, f5, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, f4_dot,
    f5_dot, R1_ddot, R2_ddot, gamma_ddot, f1_ddot, f2_ddot, f3_ddot, f4_ddot, f5_ddot, lam_1,
    lam_2, lam_3, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3,
    psi_3, psi_3_d1, psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3, psi_5, psi_5_d1,
    psi_5_d2, psi_5_d3, crank, frame, length, bending_stiffness, mass_per_length, speed,
):
    """Return the arrays of the motion linearised about a given one.

    Parameters
    ----------
    R1 : float or ndarray, shape (...)
        Mean position of the rod along the frame [m].
    R2 : float or ndarray, shape (...)
        Mean position of the rod across the frame [m].
    gamma : float or ndarray, shape (...)
        Mean direction of the rod [rad].
    f1 : float or ndarray, shape (...)
        Amplitude of mode 1, in lengths.
    f2 : float or ndarray, shape (...)
        Amplitude of mode 2, in lengths.
    f3 : float or ndarray, shape (...)
        Amplitude of mode 3, in lengths.
    f4 : float or ndarray, shape (...)
        Amplitude of mode 4, in lengths.
    f5 : float or ndarray, shape (...)
        Amplitude of mode 5, in lengths.
    R1_dot : float or ndarray, shape (...)
        Velocity R1_dot.
    R2_dot : float or ndarray, shape (...)
        Velocity R2_dot.
    gamma_dot : float or ndarray, shape (...)
        Velocity gamma_dot.
    f1_dot : float or ndarray, shape (...)
        Velocity f1_dot.
    f2_dot : float or ndarray, shape (...)
        Velocity f2_dot.
    f3_dot : float or ndarray, shape (...)
        Velocity f3_dot.
    f4_dot : float or ndarray, shape (...)
        Velocity f4_dot.
    f5_dot : float or ndarray, shape (...)
        Velocity f5_dot.
    R1_ddot : float or ndarray, shape (...)
        Acceleration R1_ddot.
    R2_ddot : float or ndarray, shape (...)
        Acceleration R2_ddot.
    gamma_ddot : float or ndarray, shape (...)
        Acceleration gamma_ddot.
    f1_ddot : float or ndarray, shape (...)
        Acceleration f1_ddot.
    f2_ddot : float or ndarray, shape (...)
        Acceleration f2_ddot.
    f3_ddot : float or ndarray, shape (...)
        Acceleration f3_ddot.
    f4_ddot : float or ndarray, shape (...)
        Acceleration f4_ddot.
    f5_ddot : float or ndarray, shape (...)
        Acceleration f5_ddot.
    lam_1 : float or ndarray, shape (...)
        Multiplier lam_1.
    lam_2 : float or ndarray, shape (...)
        Multiplier lam_2.
    lam_3 : float or ndarray, shape (...)
        Multiplier lam_3.
    t : float or ndarray, shape (...)
        Time; the crank angle is speed t [s].
    psi_1 : float or ndarray, shape (...)
        psi of mode 1 at the block.
    psi_1_d1 : float or ndarray, shape (...)
        psi' of mode 1 at the block.
    psi_1_d2 : float or ndarray, shape (...)
        psi'' of mode 1 at the block.
    psi_1_d3 : float or ndarray, shape (...)
        psi''' of mode 1 at the block.
    psi_2 : float or ndarray, shape (...)
        psi of mode 2 at the block.
    psi_2_d1 : float or ndarray, shape (...)
        psi' of mode 2 at the block.
    psi_2_d2 : float or ndarray, shape (...)
        psi'' of mode 2 at the block.
    psi_2_d3 : float or ndarray, shape (...)
        psi''' of mode 2 at the block.
    psi_3 : float or ndarray, shape (...)
        psi of mode 3 at the block.
    psi_3_d1 : float or ndarray, shape (...)
        psi' of mode 3 at the block.
    psi_3_d2 : float or ndarray, shape (...)
        psi'' of mode 3 at the block.
    psi_3_d3 : float or ndarray, shape (...)
        psi''' of mode 3 at the block.
    psi_4 : float or ndarray, shape (...)
        psi of mode 4 at the block.
    psi_4_d1 : float or ndarray, shape (...)
        psi' of mode 4 at the block.
    psi_4_d2 : float or ndarray, shape (...)
        psi'' of mode 4 at the block.
    psi_4_d3 : float or ndarray, shape (...)
        psi''' of mode 4 at the block.
    psi_5 : float or ndarray, shape (...)
        psi of mode 5 at the block.
    psi_5_d1 : float or ndarray, shape (...)
        psi' of mode 5 at the block.
    psi_5_d2 : float or ndarray, shape (...)
        psi'' of mode 5 at the block.
    psi_5_d3 : float or ndarray, shape (...)
        psi''' of mode 5 at the block.
    crank : float or ndarray
        Length of the crank [m].
    frame : float or ndarray
        Distance from the pin to the centre of the crank [m].
    length : float or ndarray
        Length of the rod [m].
    bending_stiffness : float or ndarray
        Bending stiffness of the rod [N m^2].
    mass_per_length : float or ndarray
        Mass per length of the rod [kg/m].
    speed : float or ndarray
        Speed of the crank [rad/s].

    Returns
    -------
    damping_3_3 : float or ndarray
        Entry of damping.
    damping_3_4 : float or ndarray
        Entry of damping.
    damping_3_5 : float or ndarray
        Entry of damping.
    damping_3_6 : float or ndarray
        Entry of damping.
    damping_3_7 : float or ndarray
        Entry of damping.
    damping_3_8 : float or ndarray
        Entry of damping.
    damping_4_3 : float or ndarray
        Entry of damping.
    damping_5_3 : float or ndarray
        Entry of damping.
    damping_6_3 : float or ndarray
        Entry of damping.
    damping_7_3 : float or ndarray
        Entry of damping.
    damping_8_3 : float or ndarray
        Entry of damping.
    stiffness_1_3 : float or ndarray
        Entry of stiffness.
    stiffness_2_3 : float or ndarray
        Entry of stiffness.
    stiffness_3_3 : float or ndarray
        Entry of stiffness.
    stiffness_3_4 : float or ndarray
        Entry of stiffness.
    stiffness_3_5 : float or ndarray
        Entry of stiffness.
    stiffness_3_6 : float or ndarray
        Entry of stiffness.
    stiffness_3_7 : float or ndarray
        Entry of stiffness.
    stiffness_3_8 : float or ndarray
        Entry of stiffness.
    stiffness_4_3 : float or ndarray
        Entry of stiffness.
    stiffness_4_4 : float or ndarray
        Entry of stiffness.
    stiffness_4_5 : float or ndarray
        Entry of stiffness.
    stiffness_4_6 : float or ndarray
        Entry of stiffness.
    stiffness_4_7 : float or ndarray
        Entry of stiffness.
    stiffness_4_8 : float or ndarray
        Entry of stiffness.
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
        Entry of stiffness.
    stiffness_5_6 : float or ndarray
        Entry of stiffness.
    stiffness_5_7 : float or ndarray
        Entry of stiffness.
    stiffness_5_8 : float or ndarray
        Entry of stiffness.
    stiffness_6_3 : float or ndarray
        Entry of stiffness.
    stiffness_6_6 : float or ndarray
        Entry of stiffness.
    stiffness_6_7 : float or ndarray
        Entry of stiffness.
    stiffness_6_8 : float or ndarray
        Entry of stiffness.
    stiffness_7_3 : float or ndarray
        Entry of stiffness.
    stiffness_7_7 : float or ndarray
        Entry of stiffness.
    stiffness_7_8 : float or ndarray
        Entry of stiffness.
    stiffness_8_3 : float or ndarray
        Entry of stiffness.
    stiffness_8_8 : float or ndarray
        Entry of stiffness.
    jacobian_rate_1_1 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_2 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_4 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_5 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_6 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_7 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_8 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_2_1 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_2_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_4 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_5 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_6 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_7 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_8 : float or ndarray
        Entry of jacobian_rate.
    jacobian_acceleration_1_1 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_2 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_4 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_5 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_6 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_7 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_8 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_2_1 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_2_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_4 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_5 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_6 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_7 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_8 : float or ndarray
        Entry of jacobian_acceleration.

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2 + f4 * psi_4_d2 + f5 * psi_5_d2
    curvature_rate = (
        f1_dot * psi_1_d2 + f2_dot * psi_2_d2 + f3_dot * psi_3_d2 + f4_dot * psi_4_d2 + f5_dot *
        psi_5_d2
    )
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1 + f5 * psi_5_d1
    slope_rate = (
        f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1 + f4_dot * psi_4_d1 + f5_dot *
        psi_5_d1
    )
    slope_second_rate = (
        f1_ddot * psi_1_d1 + f2_ddot * psi_2_d1 + f3_ddot * psi_3_d1 + f4_ddot * psi_4_d1 + f5_ddot
        * psi_5_d1
    )
    third = f1 * psi_1_d3 + f2 * psi_2_d3 + f3 * psi_3_d3 + f4 * psi_4_d3 + f5 * psi_5_d3
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 10.794789695105207 * x1
    x3 = f2 * x2
    x4 = 3.7222403187279935 * f4 * x0 * mass_per_length - x3
    x5 = 3.7222403187279935 * x1
    x6 = f2 * x5
    x7 = 33.81000461318533 * x1
    x8 = f4 * x7
    x9 = x6 - x8
    x10 = f1 * x1
    x11 = 4.099528272782149 * x10
    x12 = 1.174890980769858 * x1
    x13 = f3 * x12
    x14 = f5 * x1
    x15 = 0.18174011294434841 * x14
    x16 = x13 - x11 + x15
    x17 = f1 * x12
    x18 = f3 * x1
    x19 = 20.64921321265862 * x18
    x20 = 7.508573126562312 * x14
    x21 = x17 - x19 + x20
    x22 = 0.18174011294434841 * x10
    x23 = 7.508573126562312 * x18
    x24 = 50.25924964763578 * x14
    x25 = x22 + x23 - x24
    x26 = gamma_dot * x13 - gamma_dot * x11 + gamma_dot * x15
    x27 = gamma_dot * x3 - 3.7222403187279935 * f4 * gamma_dot * x0 * mass_per_length
    x28 = gamma_dot * x17 - gamma_dot * x19 + gamma_dot * x20
    x29 = gamma_dot * x6 - gamma_dot * x8
    x30 = gamma_dot * x22 + gamma_dot * x23 - gamma_dot * x24
    x31 = xp.sin(gamma)
    x32 = xp.cos(gamma)
    x33 = R2 * x32
    x34 = R1 * x31 - x33
    x35 = R1 * x32 + R2 * x31
    x37 = 1 / length
    x38 = x32 * frame
    x39 = x37 * x38
    x40 = gamma - t * speed
    x41 = xp.cos(x40)
    x42 = x41 * crank
    x43 = x37 * x42
    x44 = -x39 - x43
    x45 = lam_3 * length
    x46 = x31 * frame
    x47 = xp.sin(x40)
    x48 = x47 * crank
    x49 = R1 * x31 - x33 - x46 - x48
    x50 = x37 * x46 + x37 * x48
    x52 = x50**2
    x53 = gamma_dot * x1
    x54 = f1_dot * x53
    x55 = gamma_dot * x12
    x56 = f5_dot * x53
    x57 = -x50 * length
    x58 = lam_3 * x57
    x59 = -psi_1_d1 * x58
    x60 = psi_2_d1 * x58
    x61 = f3_dot * x53
    x62 = -psi_3_d1 * x58
    x63 = -psi_4_d1 * x58
    x64 = -psi_5_d1 * x58
    x65 = lam_1 * length
    x66 = x37 * bending_stiffness
    x67 = gamma_dot**2
    x68 = x1 * x67
    x69 = gamma_dot * x31
    x70 = gamma_dot * x32
    x71 = R2_dot * x32
    x72 = R1_dot * x31
    x73 = f1_dot * length
    x74 = f2_dot * length
    x75 = f3_dot * length
    x76 = f4_dot * length
    x77 = f5_dot * length
    x78 = R1_dot * x32
    x79 = R2_dot * x31
    x80 = gamma_dot * x34 - x78 - x79
    x81 = x48 * speed
    x82 = x42 * speed
    x83 = gamma_dot * length
    x84 = x44 * x83
    x85 = x82 + x84
    x86 = x52 * x83
    x87 = -x50 * x81
    x88 = x86 + x87
    x89 = x81 - x50 * x83
    x90 = gamma_ddot * x32 - x31 * x67
    x91 = f1_ddot * length
    x92 = f2_ddot * length
    x93 = f3_ddot * length
    x94 = f4_ddot * length
    x95 = f5_ddot * length
    x96 = R1_ddot * x32
    x97 = R2_ddot * x31
    x98 = R2_dot * x70
    x99 = x72 - x71
    x100 = speed**2
    x101 = x100 * x37 * crank**2
    x102 = gamma_ddot * length
    x103 = x100 * x42
    x104 = 2 * x82
    x105 = x44 * x81 - x104 * x50
    x106 = gamma_dot * x81
    x107 = x101 * x47**2
    x108 = gamma_dot * x82 - x103
    x109 = gamma_ddot * x57 + gamma_dot * x85 + x108
    x110 = gamma_dot * x87 + gamma_dot * x88 + x107
    return (
        f1_dot * x16 + f2_dot * x4 + f3_dot * x21 + f4_dot * x9 + f5_dot * x25,
        x26,
        -x27,
        x28,
        x29,
        x30,
        -x26,
        x27,
        -x28,
        -x29,
        -x30,
        lam_1 * x31 + x32 * lam_2 + lam_3 * x32,
        x31 * lam_2 - lam_1 * x32 + lam_3 * x31,
        lam_1 * x35 - curvature * x45 * x52 - x34 * lam_2 - lam_3 * x49 - slope * x44 * x45,
        (
            f3_dot * x55 + gamma_ddot * x16 - 4.099528272782149 * x54 + 0.18174011294434841 * x56 +
            x59
        ),
        (
            3.7222403187279935 * f4_dot * gamma_dot * x0 * mass_per_length - f2_dot * gamma_dot *
            x2 + gamma_ddot * x4 - x60
        ),
        f1_dot * x55 + gamma_ddot * x21 + 7.508573126562312 * x56 - 20.64921321265862 * x61 + x62,
        f2_dot * gamma_dot * x5 - f4_dot * gamma_dot * x7 + gamma_ddot * x9 + x63,
        (
            gamma_ddot * x25 + 0.18174011294434841 * x54 - 50.25924964763578 * x56 +
            7.508573126562312 * x61 + x64
        ),
        x59,
        500.5639017404326 * x66 - 24.740411338936784 * x65 + 2.0497641363910746 * x68,
        22.226509490533974 * x65,
        -17.688755938278415 * x65 - 0.587445490384929 * x68,
        18.518623509610325 * x65,
        -18.303757610682673 * x65 - 0.09087005647217421 * x68,
        -x60,
        3803.5370804978666 * x66 - 54.46229612599672 * x65 + 5.3973948475526035 * x68,
        42.23903821396198 * x65,
        -28.794406523989263 * x65 - 1.8611201593639968 * x68,
        31.24773431610854 * x65,
        x62,
        14617.630131122343 * x66 - 93.43335644818882 * x65 + 10.32460660632931 * x68,
        65.85693087627438 * x65,
        -39.05057971910695 * x65 - 3.754286563281156 * x68,
        x63,
        39943.799005709305 * x66 - 142.34157180565774 * x65 + 16.905002306592664 * x68,
        93.42823304738424 * x65,
        x64,
        89135.40765718032 * x66 - 201.11402466727176 * x65 + 25.12962482381789 * x68,
        -x69,
        x70,
        x71 - gamma_dot * x35 - x72,
        (
            24.740411338936784 * x73 - 22.226509490533974 * x74 + 17.688755938278415 * x75 -
            18.518623509610325 * x76 + 18.303757610682673 * x77
        ),
        (
            54.46229612599672 * f2_dot * length + 28.794406523989263 * f4_dot * length -
            22.226509490533974 * x73 - 42.23903821396198 * x75 - 31.24773431610854 * x77
        ),
        (
            17.688755938278415 * x73 - 42.23903821396198 * x74 + 93.43335644818882 * x75 -
            65.85693087627438 * x76 + 39.05057971910695 * x77
        ),
        (
            28.794406523989263 * f2_dot * length + 142.34157180565774 * f4_dot * length -
            18.518623509610325 * x73 - 65.85693087627438 * x75 - 93.42823304738424 * x77
        ),
        (
            18.303757610682673 * x73 - 31.24773431610854 * x74 + 39.05057971910695 * x75 -
            93.42823304738424 * x76 + 201.11402466727176 * x77
        ),
        -x70,
        x80,
        curvature * x88 + gamma_dot * x49 + slope * x85 + slope_rate * x57 - x78 - x79 + x81,
        psi_1_d1 * x89,
        psi_2_d1 * x89,
        psi_3_d1 * x89,
        psi_4_d1 * x89,
        psi_5_d1 * x89,
        -gamma_ddot * x31 - x32 * x67,
        x90,
        (
            R2_ddot * x32 - R1_ddot * x31 - R1_dot * x70 - R2_dot * x69 - gamma_ddot * x35 +
            gamma_dot * x80
        ),
        (
            24.740411338936784 * x91 - 22.226509490533974 * x92 + 17.688755938278415 * x93 -
            18.518623509610325 * x94 + 18.303757610682673 * x95
        ),
        (
            54.46229612599672 * f2_ddot * length + 28.794406523989263 * f4_ddot * length -
            22.226509490533974 * x91 - 42.23903821396198 * x93 - 31.24773431610854 * x95
        ),
        (
            17.688755938278415 * x91 - 42.23903821396198 * x92 + 93.43335644818882 * x93 -
            65.85693087627438 * x94 + 39.05057971910695 * x95
        ),
        (
            28.794406523989263 * f2_ddot * length + 142.34157180565774 * f4_ddot * length -
            18.518623509610325 * x91 - 65.85693087627438 * x93 - 93.42823304738424 * x95
        ),
        (
            18.303757610682673 * x91 - 31.24773431610854 * x92 + 39.05057971910695 * x93 -
            93.42823304738424 * x94 + 201.11402466727176 * x95
        ),
        -x90,
        (
            R1_dot * gamma_dot * x31 + gamma_ddot * x34 + gamma_dot * (gamma_dot * x35 + x99) - x96
            - x97 - x98
        ),
        (
            R1_dot * x69 + curvature * (gamma_dot * x105 + gamma_dot * (gamma_dot * (x44 * x57 +
            (-x57 * (2 * x39 + 2 * x43))) + x105) + 2 * x101 * x41 * x47 + x102 * x52 + x103 * x50)
            + curvature_rate * (2 * x86 + 2 * x87) + gamma_ddot * x49 + gamma_dot * (gamma_dot *
            (x35 - x38 - x42) + x82 + x99) + slope * (gamma_dot * (gamma_dot * x50 * length - x81)
            + x100 * x48 + x102 * x44 - x106) + slope_rate * (x104 + 2 * x84) + slope_second_rate *
            x57 + third * (gamma_dot * (x52 * x81 - x83 * x50**3) + x106 * x52 - x107 * x50) + x108
            - x96 - x97 - x98
        ),
        psi_1_d1 * x109 + psi_1_d2 * x110,
        psi_2_d1 * x109 + psi_2_d2 * x110,
        psi_3_d1 * x109 + psi_3_d2 * x110,
        psi_4_d1 * x109 + psi_4_d2 * x110,
        psi_5_d1 * x109 + psi_5_d2 * x110,
    )
