"""Quick-return mechanism, flexible rod in Buckens' frame, 3 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 3 modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 95 operations
    dynamics: 239 operations
    variations: 384 operations
Content hash 20bd759595f9ae400e099d7aa77ca0d7; derived with SymPy 1.14.0.
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
    'rn","modes":3,"outputs":[]}'
)
CONTENT = "20bd759595f9ae400e099d7aa77ca0d7"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    6), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (0, 4, 7), (0, 5, 8), (1, 0, 9), (1, 1, 3),
    (1, 2, 10), (1, 3, 11), (1, 4, 12), (1, 5, 11), (2, 0, 9), (2, 1, 3), (2, 2, 13), (2, 3, 14),
    (2, 4, 15), (2, 5, 16),))}, 'dynamics': {'mass': ((6, 6), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3,
    3, 2), (4, 4, 2), (5, 5, 2),)), 'rest': ((6, 1), ((2, 0, 3), (3, 0, 4), (4, 0, 5), (5, 0,
    6),)), 'forces': ((6, 1), ()), 'jacobian': ((3, 6), ((0, 0, 7), (0, 1, 8), (0, 2, 9), (0, 3,
    10), (0, 4, 11), (0, 5, 12), (1, 0, 13), (1, 1, 7), (1, 2, 14), (1, 3, 15), (1, 4, 16), (1, 5,
    15), (2, 0, 13), (2, 1, 7), (2, 2, 17), (2, 3, 18), (2, 4, 19), (2, 5, 20),)), 'velocity_rhs':
    ((3, 1), ((2, 0, 21),)), 'gamma': ((3, 1), ((0, 0, 22), (1, 0, 23), (2, 0, 24),))},
    'variations': {'damping': ((6, 6), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (2, 5, 3), (3, 2, 4), (4,
    2, 5), (5, 2, 6),)), 'stiffness': ((6, 6), ((0, 2, 7), (1, 2, 8), (2, 0, 7), (2, 1, 8), (2, 2,
    9), (2, 3, 10), (2, 4, 11), (2, 5, 12), (3, 2, 13), (3, 3, 14), (3, 4, 15), (3, 5, 16), (4, 2,
    17), (4, 3, 15), (4, 4, 18), (4, 5, 19), (5, 2, 20), (5, 3, 16), (5, 4, 19), (5, 5, 21),)),
    'jacobian_rate': ((3, 6), ((0, 0, 22), (0, 1, 23), (0, 2, 24), (0, 3, 25), (0, 4, 26), (0, 5,
    27), (1, 0, 28), (1, 1, 22), (1, 2, 29), (2, 0, 28), (2, 1, 22), (2, 2, 30), (2, 3, 31), (2, 4,
    32), (2, 5, 33),)), 'jacobian_acceleration': ((3, 6), ((0, 0, 34), (0, 1, 35), (0, 2, 36), (0,
    3, 37), (0, 4, 38), (0, 5, 39), (1, 0, 40), (1, 1, 34), (1, 2, 41), (2, 0, 40), (2, 1, 34), (2,
    2, 42), (2, 3, 43), (2, 4, 44), (2, 5, 45),))}}
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
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
    ),
    "dynamics": (
        "mass_1_1",
        "mass_3_3",
        "mass_4_4",
        "rest_3_1",
        "rest_4_1",
        "rest_5_1",
        "rest_6_1",
        "jacobian_1_1",
        "jacobian_1_2",
        "jacobian_1_3",
        "jacobian_1_4",
        "jacobian_1_5",
        "jacobian_1_6",
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_2_5",
        "jacobian_3_3",
        "jacobian_3_4",
        "jacobian_3_5",
        "jacobian_3_6",
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
        "damping_4_3",
        "damping_5_3",
        "damping_6_3",
        "stiffness_1_3",
        "stiffness_2_3",
        "stiffness_3_3",
        "stiffness_3_4",
        "stiffness_3_5",
        "stiffness_3_6",
        "stiffness_4_3",
        "stiffness_4_4",
        "stiffness_4_5",
        "stiffness_4_6",
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_5_6",
        "stiffness_6_3",
        "stiffness_6_6",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_1_4",
        "jacobian_rate_1_5",
        "jacobian_rate_1_6",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_rate_3_6",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4",
        "jacobian_acceleration_1_5",
        "jacobian_acceleration_1_6",
        "jacobian_acceleration_2_1",
        "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3",
        "jacobian_acceleration_3_4",
        "jacobian_acceleration_3_5",
        "jacobian_acceleration_3_6",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    R1, R2, gamma, f1, f2, f3, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2,
    psi_2_d3, psi_3, psi_3_d1, psi_3_d2, psi_3_d3, crank, frame, length, bending_stiffness,
    mass_per_length, speed,
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1
    value = f1 * psi_1 + f2 * psi_2 + f3 * psi_3
    x0 = f3 * length
    x1 = 17.688755938278415 * x0
    x2 = 42.23903821396198 * x0
    x3 = f1 * length
    x4 = 22.226509490533974 * x3
    x5 = xp.cos(gamma)
    x6 = R1 * x5
    x7 = xp.sin(gamma)
    x8 = R2 * x7
    x9 = x6 + x8
    x10 = 2 * length
    x11 = R1 * x7
    x12 = R2 * x5 - x11
    x13 = gamma - t * speed
    x14 = crank * xp.sin(x13)
    x15 = x7 * frame
    x16 = f2 * length
    x17 = 1 / length
    return (
        (
            12.370205669468392 * length * f1**2 + f1 * x1 + 27.23114806299836 * length * f2**2 - f2
            * x2 - f2 * x4 + 46.71667822409441 * length * f3**2 - length / 2 + x9
        ),
        f1 * x10 - f2 * x10 + f3 * x10 + x12,
        value * length + x12 + x14 + x15,
        x5,
        x7,
        R2 * x5 - x11,
        x1 - 22.226509490533974 * x16 + 24.740411338936784 * x3,
        54.46229612599672 * f2 * length - x2 - x4,
        93.43335644818882 * x0 - 42.23903821396198 * x16 + 17.688755938278415 * x3,
        -x7,
        -x9,
        x10,
        -x10,
        crank * xp.cos(x13) + x5 * frame + (-slope * length * (x14 * x17 + x15 * x17)) - x6 - x8,
        psi_1 * length,
        psi_2 * length,
        psi_3 * length,
    )


def dynamics(
    R1, R2, gamma, f1, f2, f3, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, t, psi_1,
    psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, psi_3, psi_3_d1, psi_3_d2,
    psi_3_d3, crank, frame, length, bending_stiffness, mass_per_length, speed,
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
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 2.0497641363910746 * x1
    x3 = 5.3973948475526035 * x1
    x4 = 10.32460660632931 * x1
    x5 = gamma_dot * x1
    x6 = f1 * x1
    x7 = gamma_dot * x6
    x8 = 1 / length
    x9 = x8 * bending_stiffness
    x10 = gamma_dot**2
    x11 = f3 * x10
    x12 = xp.cos(gamma)
    x13 = xp.sin(gamma)
    x14 = R1 * x13
    x15 = R2 * x12
    x16 = x14 - x15
    x17 = f1 * length
    x18 = f2 * length
    x19 = f3 * length
    x20 = R1 * x12
    x21 = R2 * x13
    x22 = -x20 - x21
    x23 = 2 * length
    x24 = x12 * frame
    x25 = gamma - t * speed
    x26 = xp.cos(x25)
    x27 = x26 * crank
    x28 = x13 * frame
    x29 = xp.sin(x25)
    x30 = x29 * crank
    x31 = -x28 * x8 - x30 * x8
    x32 = x30 * speed
    x33 = R2_dot * x12
    x34 = f1_dot * length
    x35 = f2_dot * length
    x36 = f3_dot * length
    x37 = R1_dot * x12
    x38 = R2_dot * x13
    x39 = x37 + x38
    x40 = gamma_dot * x37 + gamma_dot * x38
    x41 = speed**2
    x42 = x31 * x32
    x43 = gamma_dot * length
    x44 = x27 * speed
    return (
        length * mass_per_length,
        (
            1.174890980769858 * f1 * f3 * x0 * mass_per_length - x2 * f1**2 - x3 * f2**2 - x4 *
            f3**2 + x0 * mass_per_length / 12
        ),
        x1,
        (
            f1_dot * (1.174890980769858 * f3 * gamma_dot * x0 * mass_per_length - 4.099528272782149
            * x7) - 10.794789695105207 * f2 * f2_dot * x5 + f3_dot * (1.174890980769858 * x7 -
            20.64921321265862 * f3 * x5)
        ),
        f1 * x10 * x2 + 500.5639017404326 * f1 * x9 - 0.587445490384929 * x1 * x11,
        f2 * x10 * x3 + 3803.5370804978666 * f2 * x9,
        14617.630131122343 * f3 * x9 - 0.587445490384929 * x10 * x6 + x11 * x4,
        x12,
        x13,
        -x16,
        24.740411338936784 * x17 - 22.226509490533974 * x18 + 17.688755938278415 * x19,
        54.46229612599672 * f2 * length - 22.226509490533974 * x17 - 42.23903821396198 * x19,
        17.688755938278415 * x17 - 42.23903821396198 * x18 + 93.43335644818882 * x19,
        -x13,
        x22,
        x23,
        -x23,
        slope * x31 * length - x20 - x21 + x24 + x27,
        length * psi_1,
        length * psi_2,
        length * psi_3,
        x26 * crank * speed - slope * x32,
        (
            R1_dot * gamma_dot * x13 - f1_dot * (24.740411338936784 * x34 - 22.226509490533974 *
            x35 + 17.688755938278415 * x36) - f2_dot * (54.46229612599672 * f2_dot * length -
            22.226509490533974 * x34 - 42.23903821396198 * x36) - f3_dot * (17.688755938278415 *
            x34 - 42.23903821396198 * x35 + 93.43335644818882 * x36) - gamma_dot * x33 - gamma_dot
            * (gamma_dot * x22 - R1_dot * x13 + x33)
        ),
        (x39 - gamma_dot * x16) * gamma_dot + x40,
        (
            -curvature * (x41 * x8 * x29**2 * crank**2 + gamma_dot * x42 + gamma_dot * (x43 *
            x31**2 + x42)) - gamma_dot * x32 - gamma_dot * (x29 * crank * speed + gamma_dot * (x14
            - x15 - x28 - x30) - x39) + slope * (x26 * x41 * crank - gamma_dot * x44 - gamma_dot *
            (-x43 * (x24 * x8 + x27 * x8) + x44)) + (-slope_rate * (gamma_dot * x23 * x31 + 2 *
            x32)) + x30 * x41 + x40
        ),
    )


def variations(
    R1, R2, gamma, f1, f2, f3, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, f3_dot, R1_ddot, R2_ddot,
    gamma_ddot, f1_ddot, f2_ddot, f3_ddot, lam_1, lam_2, lam_3, t, psi_1, psi_1_d1, psi_1_d2,
    psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, psi_3, psi_3_d1, psi_3_d2, psi_3_d3, crank,
    frame, length, bending_stiffness, mass_per_length, speed,
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
    damping_4_3 : float or ndarray
        Entry of damping.
    damping_5_3 : float or ndarray
        Entry of damping.
    damping_6_3 : float or ndarray
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
    stiffness_4_3 : float or ndarray
        Entry of stiffness.
    stiffness_4_4 : float or ndarray
        Entry of stiffness.
    stiffness_4_5 : float or ndarray
        Entry of stiffness.
    stiffness_4_6 : float or ndarray
        Entry of stiffness.
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
        Entry of stiffness.
    stiffness_5_6 : float or ndarray
        Entry of stiffness.
    stiffness_6_3 : float or ndarray
        Entry of stiffness.
    stiffness_6_6 : float or ndarray
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2 + f3 * psi_3_d2
    curvature_rate = f1_dot * psi_1_d2 + f2_dot * psi_2_d2 + f3_dot * psi_3_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1 + f3 * psi_3_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1 + f3_dot * psi_3_d1
    slope_second_rate = f1_ddot * psi_1_d1 + f2_ddot * psi_2_d1 + f3_ddot * psi_3_d1
    third = f1 * psi_1_d3 + f2 * psi_2_d3 + f3 * psi_3_d3
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 10.794789695105207 * f2 * x1
    x3 = 4.099528272782149 * x1
    x4 = f1 * x3
    x5 = 1.174890980769858 * f3 * x0 * mass_per_length - x4
    x6 = 1.174890980769858 * x1
    x7 = f1 * x6
    x8 = 20.64921321265862 * x1
    x9 = f3 * x8
    x10 = x7 - x9
    x11 = gamma_dot * x4 - 1.174890980769858 * f3 * gamma_dot * x0 * mass_per_length
    x12 = gamma_dot * x2
    x13 = gamma_dot * x7 - gamma_dot * x9
    x14 = xp.sin(gamma)
    x15 = xp.cos(gamma)
    x16 = R2 * x15
    x17 = R1 * x14 - x16
    x18 = R1 * x15 + R2 * x14
    x20 = 1 / length
    x21 = x15 * frame
    x22 = x20 * x21
    x23 = gamma - t * speed
    x24 = xp.cos(x23)
    x25 = x24 * crank
    x26 = x20 * x25
    x27 = -x22 - x26
    x28 = lam_3 * length
    x29 = x14 * frame
    x30 = xp.sin(x23)
    x31 = x30 * crank
    x32 = R1 * x14 - x16 - x29 - x31
    x33 = x20 * x29 + x20 * x31
    x35 = x33**2
    x36 = -x33 * length
    x37 = lam_3 * x36
    x38 = psi_1_d1 * x37
    x39 = psi_2_d1 * x37
    x40 = -psi_3_d1 * x37
    x41 = lam_1 * length
    x42 = x20 * bending_stiffness
    x43 = gamma_dot**2
    x44 = x1 * x43
    x45 = gamma_dot * x14
    x46 = gamma_dot * x15
    x47 = R2_dot * x15
    x48 = R1_dot * x14
    x49 = f1_dot * length
    x50 = f2_dot * length
    x51 = f3_dot * length
    x52 = R1_dot * x15
    x53 = R2_dot * x14
    x54 = gamma_dot * x17 - x52 - x53
    x55 = x31 * speed
    x56 = x25 * speed
    x57 = gamma_dot * length
    x58 = x27 * x57
    x59 = x56 + x58
    x60 = x35 * x57
    x61 = -x33 * x55
    x62 = x60 + x61
    x63 = x55 - x33 * x57
    x64 = gamma_ddot * x15 - x14 * x43
    x65 = f1_ddot * length
    x66 = f2_ddot * length
    x67 = f3_ddot * length
    x68 = R1_ddot * x15
    x69 = R2_ddot * x14
    x70 = R2_dot * x46
    x71 = x48 - x47
    x72 = speed**2
    x73 = x20 * x72 * crank**2
    x74 = gamma_ddot * length
    x75 = x25 * x72
    x76 = 2 * x56
    x77 = x27 * x55 - x33 * x76
    x78 = gamma_dot * x55
    x79 = x73 * x30**2
    x80 = gamma_dot * x56 - x75
    x81 = gamma_ddot * x36 + gamma_dot * x59 + x80
    x82 = gamma_dot * x61 + gamma_dot * x62 + x79
    return (
        f1_dot * x5 - f2_dot * x2 + f3_dot * x10,
        -x11,
        -x12,
        x13,
        x11,
        x12,
        -x13,
        lam_1 * x14 + x15 * lam_2 + lam_3 * x15,
        x14 * lam_2 - lam_1 * x15 + lam_3 * x14,
        lam_1 * x18 - curvature * x28 * x35 - x17 * lam_2 - lam_3 * x32 - slope * x27 * x28,
        (
            1.174890980769858 * f3_dot * gamma_dot * x0 * mass_per_length - f1_dot * gamma_dot * x3
            + gamma_ddot * x5 - x38
        ),
        -10.794789695105207 * f2_dot * gamma_dot * x1 - gamma_ddot * x2 - x39,
        f1_dot * gamma_dot * x6 - f3_dot * gamma_dot * x8 + gamma_ddot * x10 + x40,
        -x38,
        500.5639017404326 * x42 - 24.740411338936784 * x41 + 2.0497641363910746 * x44,
        22.226509490533974 * x41,
        -17.688755938278415 * x41 - 0.587445490384929 * x44,
        -x39,
        3803.5370804978666 * x42 - 54.46229612599672 * x41 + 5.3973948475526035 * x44,
        42.23903821396198 * x41,
        x40,
        14617.630131122343 * x42 - 93.43335644818882 * x41 + 10.32460660632931 * x44,
        -x45,
        x46,
        x47 - gamma_dot * x18 - x48,
        24.740411338936784 * x49 - 22.226509490533974 * x50 + 17.688755938278415 * x51,
        54.46229612599672 * f2_dot * length - 22.226509490533974 * x49 - 42.23903821396198 * x51,
        17.688755938278415 * x49 - 42.23903821396198 * x50 + 93.43335644818882 * x51,
        -x46,
        x54,
        curvature * x62 + gamma_dot * x32 + slope * x59 + slope_rate * x36 - x52 - x53 + x55,
        psi_1_d1 * x63,
        psi_2_d1 * x63,
        psi_3_d1 * x63,
        -gamma_ddot * x14 - x15 * x43,
        x64,
        (
            R2_ddot * x15 - R1_ddot * x14 - R1_dot * x46 - R2_dot * x45 - gamma_ddot * x18 +
            gamma_dot * x54
        ),
        24.740411338936784 * x65 - 22.226509490533974 * x66 + 17.688755938278415 * x67,
        54.46229612599672 * f2_ddot * length - 22.226509490533974 * x65 - 42.23903821396198 * x67,
        17.688755938278415 * x65 - 42.23903821396198 * x66 + 93.43335644818882 * x67,
        -x64,
        (
            R1_dot * gamma_dot * x14 + gamma_ddot * x17 + gamma_dot * (gamma_dot * x18 + x71) - x68
            - x69 - x70
        ),
        (
            R1_dot * x45 + curvature * (gamma_dot * x77 + gamma_dot * (gamma_dot * (x27 * x36 +
            (-x36 * (2 * x22 + 2 * x26))) + x77) + 2 * x24 * x30 * x73 + x33 * x75 + x35 * x74) +
            curvature_rate * (2 * x60 + 2 * x61) + gamma_ddot * x32 + gamma_dot * (gamma_dot * (x18
            - x21 - x25) + x56 + x71) + slope * (gamma_dot * (gamma_dot * x33 * length - x55) + x27
            * x74 + x31 * x72 - x78) + slope_rate * (2 * x58 + x76) + slope_second_rate * x36 +
            third * (gamma_dot * (x35 * x55 - x57 * x33**3) - x33 * x79 + x35 * x78) - x68 - x69 -
            x70 + x80
        ),
        psi_1_d1 * x81 + psi_1_d2 * x82,
        psi_2_d1 * x81 + psi_2_d2 * x82,
        psi_3_d1 * x81 + psi_3_d2 * x82,
    )
