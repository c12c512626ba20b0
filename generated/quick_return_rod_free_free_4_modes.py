"""Quick-return mechanism, flexible rod in Buckens' frame, 4 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 4 modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 133 operations
    dynamics: 315 operations
    variations: 478 operations
Content hash 32c8cb0f09ce9885699504e3727bb9ba; derived with SymPy 1.14.0.
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
    'rn","modes":4,"outputs":[]}'
)
CONTENT = "32c8cb0f09ce9885699504e3727bb9ba"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3', 'f4')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3', 'psi_4', 'psi_4_d1', 'psi_4_d2', 'psi_4_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    7), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (0, 4, 7), (0, 5, 8), (0, 6, 9), (1, 0, 10),
    (1, 1, 3), (1, 2, 11), (1, 3, 12), (1, 4, 13), (1, 5, 12), (1, 6, 13), (2, 0, 10), (2, 1, 3),
    (2, 2, 14), (2, 3, 15), (2, 4, 16), (2, 5, 17), (2, 6, 18),))}, 'dynamics': {'mass': ((7, 7),
    ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4, 2), (5, 5, 2), (6, 6, 2),)), 'rest': ((7,
    1), ((2, 0, 3), (3, 0, 4), (4, 0, 5), (5, 0, 6), (6, 0, 7),)), 'forces': ((7, 1), ()),
    'jacobian': ((3, 7), ((0, 0, 8), (0, 1, 9), (0, 2, 10), (0, 3, 11), (0, 4, 12), (0, 5, 13), (0,
    6, 14), (1, 0, 15), (1, 1, 8), (1, 2, 16), (1, 3, 17), (1, 4, 18), (1, 5, 17), (1, 6, 18), (2,
    0, 15), (2, 1, 8), (2, 2, 19), (2, 3, 20), (2, 4, 21), (2, 5, 22), (2, 6, 23),)),
    'velocity_rhs': ((3, 1), ((2, 0, 24),)), 'gamma': ((3, 1), ((0, 0, 25), (1, 0, 26), (2, 0,
    27),))}, 'variations': {'damping': ((7, 7), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (2, 5, 3), (2, 6,
    4), (3, 2, 5), (4, 2, 6), (5, 2, 7), (6, 2, 8),)), 'stiffness': ((7, 7), ((0, 2, 9), (1, 2,
    10), (2, 0, 9), (2, 1, 10), (2, 2, 11), (2, 3, 12), (2, 4, 13), (2, 5, 14), (2, 6, 15), (3, 2,
    16), (3, 3, 17), (3, 4, 18), (3, 5, 19), (3, 6, 20), (4, 2, 21), (4, 3, 18), (4, 4, 22), (4, 5,
    23), (4, 6, 24), (5, 2, 25), (5, 3, 19), (5, 4, 23), (5, 5, 26), (5, 6, 27), (6, 2, 28), (6, 3,
    20), (6, 4, 24), (6, 5, 27), (6, 6, 29),)), 'jacobian_rate': ((3, 7), ((0, 0, 30), (0, 1, 31),
    (0, 2, 32), (0, 3, 33), (0, 4, 34), (0, 5, 35), (0, 6, 36), (1, 0, 37), (1, 1, 30), (1, 2, 38),
    (2, 0, 37), (2, 1, 30), (2, 2, 39), (2, 3, 40), (2, 4, 41), (2, 5, 42), (2, 6, 43),)),
    'jacobian_acceleration': ((3, 7), ((0, 0, 44), (0, 1, 45), (0, 2, 46), (0, 3, 47), (0, 4, 48),
    (0, 5, 49), (0, 6, 50), (1, 0, 51), (1, 1, 44), (1, 2, 52), (2, 0, 51), (2, 1, 44), (2, 2, 53),
    (2, 3, 54), (2, 4, 55), (2, 5, 56), (2, 6, 57),))}}
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
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
        "jacobian_3_7",
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
        "jacobian_1_1",
        "jacobian_1_2",
        "jacobian_1_3",
        "jacobian_1_4",
        "jacobian_1_5",
        "jacobian_1_6",
        "jacobian_1_7",
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
        "jacobian_3_7",
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
        "damping_4_3",
        "damping_5_3",
        "damping_6_3",
        "damping_7_3",
        "stiffness_1_3",
        "stiffness_2_3",
        "stiffness_3_3",
        "stiffness_3_4",
        "stiffness_3_5",
        "stiffness_3_6",
        "stiffness_3_7",
        "stiffness_4_3",
        "stiffness_4_4",
        "stiffness_4_5",
        "stiffness_4_6",
        "stiffness_4_7",
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_5_6",
        "stiffness_5_7",
        "stiffness_6_3",
        "stiffness_6_6",
        "stiffness_6_7",
        "stiffness_7_3",
        "stiffness_7_7",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_1_4",
        "jacobian_rate_1_5",
        "jacobian_rate_1_6",
        "jacobian_rate_1_7",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_rate_3_6",
        "jacobian_rate_3_7",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4",
        "jacobian_acceleration_1_5",
        "jacobian_acceleration_1_6",
        "jacobian_acceleration_1_7",
        "jacobian_acceleration_2_1",
        "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3",
        "jacobian_acceleration_3_4",
        "jacobian_acceleration_3_5",
        "jacobian_acceleration_3_6",
        "jacobian_acceleration_3_7",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    R1, R2, gamma, f1, f2, f3, f4, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1,
    psi_2_d2, psi_2_d3, psi_3, psi_3_d1, psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3,
    crank, frame, length, bending_stiffness, mass_per_length, speed,
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1
    value = f1 * psi_1 + f2 * psi_2 + f3 * psi_3 + f4 * psi_4
    x0 = f4 * length
    x1 = f3 * length
    x2 = 17.688755938278415 * x1
    x3 = 65.85693087627438 * x1
    x4 = f1 * length
    x5 = 18.518623509610325 * x4
    x6 = 42.23903821396198 * x1
    x7 = 22.226509490533974 * x4
    x8 = xp.cos(gamma)
    x9 = R1 * x8
    x10 = xp.sin(gamma)
    x11 = R2 * x10
    x12 = x11 + x9
    x13 = 2 * length
    x14 = R1 * x10
    x15 = x14 - R2 * x8
    x16 = x10 * frame
    x17 = gamma - t * speed
    x18 = crank * xp.sin(x17)
    x19 = f2 * length
    x20 = 1 / length
    return (
        (
            12.370205669468392 * length * f1**2 + f1 * x2 + 27.23114806299836 * length * f2**2 +
            28.794406523989263 * f2 * x0 - f2 * x6 - f2 * x7 + 46.71667822409441 * length * f3**2 +
            71.17078590282887 * length * f4**2 - f4 * x3 - f4 * x5 - length / 2 + x12
        ),
        2 * f1 * length - f2 * x13 + 2 * f3 * length - f4 * x13 - x15,
        R2 * x8 + value * length - x14 + x16 + x18,
        x8,
        x10,
        -x15,
        x2 - 18.518623509610325 * x0 - 22.226509490533974 * x19 + 24.740411338936784 * x4,
        54.46229612599672 * f2 * length + 28.794406523989263 * f4 * length - x6 - x7,
        (
            93.43335644818882 * x1 - 65.85693087627438 * x0 - 42.23903821396198 * x19 +
            17.688755938278415 * x4
        ),
        28.794406523989263 * f2 * length + 142.34157180565774 * f4 * length - x3 - x5,
        -x10,
        -x12,
        x13,
        -x13,
        crank * xp.cos(x17) + x8 * frame + (-slope * length * (x16 * x20 + x18 * x20)) - x11 - x9,
        psi_1 * length,
        psi_2 * length,
        psi_3 * length,
        psi_4 * length,
    )


def dynamics(
    R1, R2, gamma, f1, f2, f3, f4, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, f4_dot, t,
    psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, psi_3, psi_3_d1,
    psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3, crank, frame, length,
    bending_stiffness, mass_per_length, speed,
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
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2 + f4 * psi_4_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1 + f4_dot * psi_4_d1
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 2.0497641363910746 * x1
    x3 = 5.3973948475526035 * x1
    x4 = 10.32460660632931 * x1
    x5 = 16.905002306592664 * x1
    x6 = f1 * x1
    x7 = gamma_dot * x6
    x8 = f2 * x1
    x9 = gamma_dot * x8
    x10 = gamma_dot * x1
    x11 = 1 / length
    x12 = x11 * bending_stiffness
    x13 = gamma_dot**2
    x14 = x1 * x13
    x15 = xp.cos(gamma)
    x16 = xp.sin(gamma)
    x17 = R1 * x16
    x18 = R2 * x15
    x19 = x17 - x18
    x20 = f1 * length
    x21 = f2 * length
    x22 = f3 * length
    x23 = f4 * length
    x24 = R1 * x15
    x25 = R2 * x16
    x26 = -x24 - x25
    x27 = 2 * length
    x28 = x15 * frame
    x29 = gamma - t * speed
    x30 = xp.cos(x29)
    x31 = x30 * crank
    x32 = x16 * frame
    x33 = xp.sin(x29)
    x34 = x33 * crank
    x35 = -x11 * x32 - x11 * x34
    x36 = x34 * speed
    x37 = R2_dot * x15
    x38 = f1_dot * length
    x39 = f2_dot * length
    x40 = f3_dot * length
    x41 = f4_dot * length
    x42 = R1_dot * x15
    x43 = R2_dot * x16
    x44 = x42 + x43
    x45 = gamma_dot * x42 + gamma_dot * x43
    x46 = speed**2
    x47 = x35 * x36
    x48 = gamma_dot * length
    x49 = x31 * speed
    return (
        length * mass_per_length,
        (
            1.174890980769858 * f1 * f3 * x0 * mass_per_length - x2 * f1**2 - x3 * f2**2 +
            3.7222403187279935 * f2 * f4 * x0 * mass_per_length - x4 * f3**2 - x5 * f4**2 + x0 *
            mass_per_length / 12
        ),
        x1,
        (
            f1_dot * (1.174890980769858 * f3 * gamma_dot * x0 * mass_per_length - 4.099528272782149
            * x7) + f2_dot * (3.7222403187279935 * f4 * gamma_dot * x0 * mass_per_length -
            10.794789695105207 * x9) + f3_dot * (1.174890980769858 * x7 - 20.64921321265862 * f3 *
            x10) + f4_dot * (3.7222403187279935 * x9 - 33.81000461318533 * f4 * x10)
        ),
        500.5639017404326 * f1 * x12 + f1 * x13 * x2 - 0.587445490384929 * f3 * x14,
        3803.5370804978666 * f2 * x12 + f2 * x13 * x3 - 1.8611201593639968 * f4 * x14,
        14617.630131122343 * f3 * x12 + f3 * x13 * x4 - 0.587445490384929 * x13 * x6,
        39943.799005709305 * f4 * x12 + f4 * x13 * x5 - 1.8611201593639968 * x13 * x8,
        x15,
        x16,
        -x19,
        (
            24.740411338936784 * x20 - 22.226509490533974 * x21 + 17.688755938278415 * x22 -
            18.518623509610325 * x23
        ),
        (
            54.46229612599672 * f2 * length + 28.794406523989263 * f4 * length - 22.226509490533974
            * x20 - 42.23903821396198 * x22
        ),
        (
            17.688755938278415 * x20 - 42.23903821396198 * x21 + 93.43335644818882 * x22 -
            65.85693087627438 * x23
        ),
        (
            28.794406523989263 * f2 * length + 142.34157180565774 * f4 * length -
            18.518623509610325 * x20 - 65.85693087627438 * x22
        ),
        -x16,
        x26,
        x27,
        -x27,
        slope * x35 * length - x24 - x25 + x28 + x31,
        length * psi_1,
        length * psi_2,
        length * psi_3,
        length * psi_4,
        x30 * crank * speed - slope * x36,
        (
            R1_dot * gamma_dot * x16 - f1_dot * (24.740411338936784 * x38 - 22.226509490533974 *
            x39 + 17.688755938278415 * x40 - 18.518623509610325 * x41) - f2_dot *
            (54.46229612599672 * f2_dot * length + 28.794406523989263 * f4_dot * length -
            22.226509490533974 * x38 - 42.23903821396198 * x40) - f3_dot * (17.688755938278415 *
            x38 - 42.23903821396198 * x39 + 93.43335644818882 * x40 - 65.85693087627438 * x41) -
            f4_dot * (28.794406523989263 * f2_dot * length + 142.34157180565774 * f4_dot * length -
            18.518623509610325 * x38 - 65.85693087627438 * x40) - gamma_dot * x37 - gamma_dot *
            (gamma_dot * x26 - R1_dot * x16 + x37)
        ),
        (x44 - gamma_dot * x19) * gamma_dot + x45,
        (
            -curvature * (x11 * x46 * x33**2 * crank**2 + gamma_dot * x47 + gamma_dot * (x48 *
            x35**2 + x47)) - gamma_dot * x36 - gamma_dot * (x33 * crank * speed + gamma_dot * (x17
            - x18 - x32 - x34) - x44) + slope * (x30 * x46 * crank - gamma_dot * x49 - gamma_dot *
            (-x48 * (x11 * x28 + x11 * x31) + x49)) + (-slope_rate * (gamma_dot * x27 * x35 + 2 *
            x36)) + x34 * x46 + x45
        ),
    )


def variations(
    R1, R2, gamma, f1, f2, f3, f4, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, f4_dot,
    R1_ddot, R2_ddot, gamma_ddot, f1_ddot, f2_ddot, f3_ddot, f4_ddot, lam_1, lam_2, lam_3, t,
    psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, psi_3, psi_3_d1,
    psi_3_d2, psi_3_d3, psi_4, psi_4_d1, psi_4_d2, psi_4_d3, crank, frame, length,
    bending_stiffness, mass_per_length, speed,
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
    damping_4_3 : float or ndarray
        Entry of damping.
    damping_5_3 : float or ndarray
        Entry of damping.
    damping_6_3 : float or ndarray
        Entry of damping.
    damping_7_3 : float or ndarray
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
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
        Entry of stiffness.
    stiffness_5_6 : float or ndarray
        Entry of stiffness.
    stiffness_5_7 : float or ndarray
        Entry of stiffness.
    stiffness_6_3 : float or ndarray
        Entry of stiffness.
    stiffness_6_6 : float or ndarray
        Entry of stiffness.
    stiffness_6_7 : float or ndarray
        Entry of stiffness.
    stiffness_7_3 : float or ndarray
        Entry of stiffness.
    stiffness_7_7 : float or ndarray
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2 + f4 * psi_4_d2
    curvature_rate = f1_dot * psi_1_d2 + f2_dot * psi_2_d2 + f3_dot * psi_3_d2 + f4_dot * psi_4_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1 + f4 * psi_4_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1 + f4_dot * psi_4_d1
    slope_second_rate = (
        f1_ddot * psi_1_d1 + f2_ddot * psi_2_d1 + f3_ddot * psi_3_d1 + f4_ddot * psi_4_d1
    )
    third = f1 * psi_1_d3 + f2 * psi_2_d3 + f3 * psi_3_d3 + f4 * psi_4_d3
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 4.099528272782149 * x1
    x3 = f1 * x2
    x4 = 1.174890980769858 * f3 * x0 * mass_per_length - x3
    x5 = 10.794789695105207 * x1
    x6 = f2 * x5
    x7 = 3.7222403187279935 * f4 * x0 * mass_per_length - x6
    x8 = 1.174890980769858 * x1
    x9 = f1 * x8
    x10 = 20.64921321265862 * x1
    x11 = f3 * x10
    x12 = x9 - x11
    x13 = 3.7222403187279935 * x1
    x14 = f2 * x13
    x15 = 33.81000461318533 * x1
    x16 = f4 * x15
    x17 = x14 - x16
    x18 = gamma_dot * x3 - 1.174890980769858 * f3 * gamma_dot * x0 * mass_per_length
    x19 = gamma_dot * x6 - 3.7222403187279935 * f4 * gamma_dot * x0 * mass_per_length
    x20 = gamma_dot * x9 - gamma_dot * x11
    x21 = gamma_dot * x14 - gamma_dot * x16
    x22 = xp.sin(gamma)
    x23 = xp.cos(gamma)
    x24 = R2 * x23
    x25 = R1 * x22 - x24
    x26 = R1 * x23 + R2 * x22
    x28 = 1 / length
    x29 = x23 * frame
    x30 = x28 * x29
    x31 = gamma - t * speed
    x32 = xp.cos(x31)
    x33 = x32 * crank
    x34 = x28 * x33
    x35 = -x30 - x34
    x36 = lam_3 * length
    x37 = x22 * frame
    x38 = xp.sin(x31)
    x39 = x38 * crank
    x40 = R1 * x22 - x24 - x37 - x39
    x41 = x28 * x37 + x28 * x39
    x43 = x41**2
    x44 = -x41 * length
    x45 = lam_3 * x44
    x46 = psi_1_d1 * x45
    x47 = psi_2_d1 * x45
    x48 = -psi_3_d1 * x45
    x49 = -psi_4_d1 * x45
    x50 = lam_1 * length
    x51 = x28 * bending_stiffness
    x52 = gamma_dot**2
    x53 = x1 * x52
    x54 = gamma_dot * x22
    x55 = gamma_dot * x23
    x56 = R2_dot * x23
    x57 = R1_dot * x22
    x58 = f1_dot * length
    x59 = f2_dot * length
    x60 = f3_dot * length
    x61 = f4_dot * length
    x62 = R1_dot * x23
    x63 = R2_dot * x22
    x64 = gamma_dot * x25 - x62 - x63
    x65 = x39 * speed
    x66 = x33 * speed
    x67 = gamma_dot * length
    x68 = x35 * x67
    x69 = x66 + x68
    x70 = x43 * x67
    x71 = -x41 * x65
    x72 = x70 + x71
    x73 = x65 - x41 * x67
    x74 = gamma_ddot * x23 - x22 * x52
    x75 = f1_ddot * length
    x76 = f2_ddot * length
    x77 = f3_ddot * length
    x78 = f4_ddot * length
    x79 = R1_ddot * x23
    x80 = R2_ddot * x22
    x81 = R2_dot * x55
    x82 = x57 - x56
    x83 = speed**2
    x84 = x28 * x83 * crank**2
    x85 = gamma_ddot * length
    x86 = x33 * x83
    x87 = 2 * x66
    x88 = x35 * x65 - x41 * x87
    x89 = gamma_dot * x65
    x90 = x84 * x38**2
    x91 = gamma_dot * x66 - x86
    x92 = gamma_ddot * x44 + gamma_dot * x69 + x91
    x93 = gamma_dot * x71 + gamma_dot * x72 + x90
    return (
        f1_dot * x4 + f2_dot * x7 + f3_dot * x12 + f4_dot * x17,
        -x18,
        -x19,
        x20,
        x21,
        x18,
        x19,
        -x20,
        -x21,
        lam_1 * x22 + x23 * lam_2 + lam_3 * x23,
        x22 * lam_2 - lam_1 * x23 + lam_3 * x22,
        lam_1 * x26 - curvature * x36 * x43 - x25 * lam_2 - lam_3 * x40 - slope * x35 * x36,
        (
            1.174890980769858 * f3_dot * gamma_dot * x0 * mass_per_length - f1_dot * gamma_dot * x2
            + gamma_ddot * x4 - x46
        ),
        (
            3.7222403187279935 * f4_dot * gamma_dot * x0 * mass_per_length - f2_dot * gamma_dot *
            x5 + gamma_ddot * x7 - x47
        ),
        f1_dot * gamma_dot * x8 - f3_dot * gamma_dot * x10 + gamma_ddot * x12 + x48,
        f2_dot * gamma_dot * x13 - f4_dot * gamma_dot * x15 + gamma_ddot * x17 + x49,
        -x46,
        500.5639017404326 * x51 - 24.740411338936784 * x50 + 2.0497641363910746 * x53,
        22.226509490533974 * x50,
        -17.688755938278415 * x50 - 0.587445490384929 * x53,
        18.518623509610325 * x50,
        -x47,
        3803.5370804978666 * x51 - 54.46229612599672 * x50 + 5.3973948475526035 * x53,
        42.23903821396198 * x50,
        -28.794406523989263 * x50 - 1.8611201593639968 * x53,
        x48,
        14617.630131122343 * x51 - 93.43335644818882 * x50 + 10.32460660632931 * x53,
        65.85693087627438 * x50,
        x49,
        39943.799005709305 * x51 - 142.34157180565774 * x50 + 16.905002306592664 * x53,
        -x54,
        x55,
        x56 - gamma_dot * x26 - x57,
        (
            24.740411338936784 * x58 - 22.226509490533974 * x59 + 17.688755938278415 * x60 -
            18.518623509610325 * x61
        ),
        (
            54.46229612599672 * f2_dot * length + 28.794406523989263 * f4_dot * length -
            22.226509490533974 * x58 - 42.23903821396198 * x60
        ),
        (
            17.688755938278415 * x58 - 42.23903821396198 * x59 + 93.43335644818882 * x60 -
            65.85693087627438 * x61
        ),
        (
            28.794406523989263 * f2_dot * length + 142.34157180565774 * f4_dot * length -
            18.518623509610325 * x58 - 65.85693087627438 * x60
        ),
        -x55,
        x64,
        curvature * x72 + gamma_dot * x40 + slope * x69 + slope_rate * x44 - x62 - x63 + x65,
        psi_1_d1 * x73,
        psi_2_d1 * x73,
        psi_3_d1 * x73,
        psi_4_d1 * x73,
        -gamma_ddot * x22 - x23 * x52,
        x74,
        (
            R2_ddot * x23 - R1_ddot * x22 - R1_dot * x55 - R2_dot * x54 - gamma_ddot * x26 +
            gamma_dot * x64
        ),
        (
            24.740411338936784 * x75 - 22.226509490533974 * x76 + 17.688755938278415 * x77 -
            18.518623509610325 * x78
        ),
        (
            54.46229612599672 * f2_ddot * length + 28.794406523989263 * f4_ddot * length -
            22.226509490533974 * x75 - 42.23903821396198 * x77
        ),
        (
            17.688755938278415 * x75 - 42.23903821396198 * x76 + 93.43335644818882 * x77 -
            65.85693087627438 * x78
        ),
        (
            28.794406523989263 * f2_ddot * length + 142.34157180565774 * f4_ddot * length -
            18.518623509610325 * x75 - 65.85693087627438 * x77
        ),
        -x74,
        (
            R1_dot * gamma_dot * x22 + gamma_ddot * x25 + gamma_dot * (gamma_dot * x26 + x82) - x79
            - x80 - x81
        ),
        (
            R1_dot * x54 + curvature * (gamma_dot * x88 + gamma_dot * (gamma_dot * (x35 * x44 +
            (-x44 * (2 * x30 + 2 * x34))) + x88) + 2 * x32 * x38 * x84 + x41 * x86 + x43 * x85) +
            curvature_rate * (2 * x70 + 2 * x71) + gamma_ddot * x40 + gamma_dot * (gamma_dot * (x26
            - x29 - x33) + x66 + x82) + slope * (gamma_dot * (gamma_dot * x41 * length - x65) + x35
            * x85 + x39 * x83 - x89) + slope_rate * (2 * x68 + x87) + slope_second_rate * x44 +
            third * (gamma_dot * (x43 * x65 - x67 * x41**3) - x41 * x90 + x43 * x89) - x79 - x80 -
            x81 + x91
        ),
        psi_1_d1 * x92 + psi_1_d2 * x93,
        psi_2_d1 * x92 + psi_2_d2 * x93,
        psi_3_d1 * x92 + psi_3_d2 * x93,
        psi_4_d1 * x92 + psi_4_d2 * x93,
    )
