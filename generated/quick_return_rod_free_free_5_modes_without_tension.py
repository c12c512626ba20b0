"""Quick-return mechanism, flexible rod in Buckens' frame, 5 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 5 modes, without tension.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 72 operations
    dynamics: 202 operations
    variations: 361 operations
Content hash 180188dd4e75c04bb3523a2613fccd81; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "constraints",
    "dynamics",
    "variations",
]

FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":["tension"],"flexible":["rod"],"formulation":"free_free","mechanism":"q'
    'uick_return","modes":5,"outputs":[]}'
)
CONTENT = "180188dd4e75c04bb3523a2613fccd81"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3', 'f4', 'f5')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3', 'psi_4', 'psi_4_d1', 'psi_4_d2', 'psi_4_d3',
    'psi_5', 'psi_5_d1', 'psi_5_d2', 'psi_5_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    8), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (1, 0, 6), (1, 1, 3), (1, 2, 7), (1, 3, 8), (1, 4, 9),
    (1, 5, 8), (1, 6, 9), (1, 7, 8), (2, 0, 6), (2, 1, 3), (2, 2, 10), (2, 3, 11), (2, 4, 12), (2,
    5, 13), (2, 6, 14), (2, 7, 15),))}, 'dynamics': {'mass': ((8, 8), ((0, 0, 0), (1, 1, 0), (2, 2,
    1), (3, 3, 2), (4, 4, 2), (5, 5, 2), (6, 6, 2), (7, 7, 2),)), 'rest': ((8, 1), ((2, 0, 3), (3,
    0, 4), (4, 0, 5), (5, 0, 6), (6, 0, 7), (7, 0, 8),)), 'forces': ((8, 1), ()), 'jacobian': ((3,
    8), ((0, 0, 9), (0, 1, 10), (0, 2, 11), (1, 0, 12), (1, 1, 9), (1, 2, 13), (1, 3, 14), (1, 4,
    15), (1, 5, 14), (1, 6, 15), (1, 7, 14), (2, 0, 12), (2, 1, 9), (2, 2, 16), (2, 3, 17), (2, 4,
    18), (2, 5, 19), (2, 6, 20), (2, 7, 21),)), 'velocity_rhs': ((3, 1), ((2, 0, 22),)), 'gamma':
    ((3, 1), ((0, 0, 23), (1, 0, 24), (2, 0, 25),))}, 'variations': {'damping': ((8, 8), ((2, 2,
    0), (2, 3, 1), (2, 4, 2), (2, 5, 3), (2, 6, 4), (2, 7, 5), (3, 2, 6), (4, 2, 7), (5, 2, 8), (6,
    2, 9), (7, 2, 10),)), 'stiffness': ((8, 8), ((0, 2, 11), (1, 2, 12), (2, 0, 11), (2, 1, 12),
    (2, 2, 13), (2, 3, 14), (2, 4, 15), (2, 5, 16), (2, 6, 17), (2, 7, 18), (3, 2, 19), (3, 3, 20),
    (4, 2, 21), (4, 4, 22), (5, 2, 23), (5, 5, 24), (6, 2, 25), (6, 6, 26), (7, 2, 27), (7, 7,
    28),)), 'jacobian_rate': ((3, 8), ((0, 0, 29), (0, 1, 30), (0, 2, 31), (1, 0, 32), (1, 1, 29),
    (1, 2, 33), (2, 0, 32), (2, 1, 29), (2, 2, 34), (2, 3, 35), (2, 4, 36), (2, 5, 37), (2, 6, 38),
    (2, 7, 39),)), 'jacobian_acceleration': ((3, 8), ((0, 0, 40), (0, 1, 41), (0, 2, 42), (1, 0,
    43), (1, 1, 40), (1, 2, 44), (2, 0, 43), (2, 1, 40), (2, 2, 45), (2, 3, 46), (2, 4, 47), (2, 5,
    48), (2, 6, 49), (2, 7, 50),))}}
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
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_6_3",
        "stiffness_6_6",
        "stiffness_7_3",
        "stiffness_7_7",
        "stiffness_8_3",
        "stiffness_8_8",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
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
    x0 = xp.cos(gamma)
    x1 = R1 * x0
    x2 = xp.sin(gamma)
    x3 = R2 * x2
    x4 = x1 + x3
    x5 = 2 * length
    x6 = R1 * x2
    x7 = R2 * x0 - x6
    x8 = gamma - t * speed
    x9 = crank * xp.sin(x8)
    x10 = x2 * frame
    x11 = 1 / length
    return (
        x4 - length / 2,
        f1 * x5 - f2 * x5 + f3 * x5 - f4 * x5 + f5 * x5 + x7,
        value * length + x10 + x7 + x9,
        x0,
        x2,
        R2 * x0 - x6,
        -x2,
        -x4,
        x5,
        -x5,
        crank * xp.cos(x8) + x0 * frame + (-slope * length * (x10 * x11 + x11 * x9)) - x1 - x3,
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
    x0 = mass_per_length * length**3
    x1 = 2 * gamma_dot * x0
    x2 = 1 / length
    x3 = x2 * bending_stiffness
    x4 = x0 * gamma_dot**2
    x5 = xp.cos(gamma)
    x6 = xp.sin(gamma)
    x7 = R1 * x6
    x8 = R2 * x5
    x9 = x7 - x8
    x10 = R1 * x5
    x11 = R2 * x6
    x12 = -x10 - x11
    x13 = 2 * length
    x14 = x5 * frame
    x15 = gamma - t * speed
    x16 = xp.cos(x15)
    x17 = x16 * crank
    x18 = x6 * frame
    x19 = xp.sin(x15)
    x20 = x19 * crank
    x21 = -x18 * x2 - x2 * x20
    x22 = x20 * speed
    x23 = R2_dot * x5
    x24 = R1_dot * x5
    x25 = R2_dot * x6
    x26 = x24 + x25
    x27 = gamma_dot * x24 + gamma_dot * x25
    x28 = speed**2
    x29 = x21 * x22
    x30 = gamma_dot * length
    x31 = x17 * speed
    return (
        length * mass_per_length,
        x0 * f1**2 + x0 * f2**2 + x0 * f3**2 + x0 * f4**2 + x0 * f5**2 + x0 / 12,
        x0,
        (
            f1 * f1_dot * x1 + f2 * f2_dot * x1 + f3 * f3_dot * x1 + f4 * f4_dot * x1 + f5 * f5_dot
            * x1
        ),
        500.5639017404326 * f1 * x3 - f1 * x4,
        3803.5370804978666 * f2 * x3 - f2 * x4,
        14617.630131122343 * f3 * x3 - f3 * x4,
        39943.799005709305 * f4 * x3 - f4 * x4,
        89135.40765718032 * f5 * x3 - f5 * x4,
        x5,
        x6,
        -x9,
        -x6,
        x12,
        x13,
        -x13,
        slope * x21 * length - x10 - x11 + x14 + x17,
        length * psi_1,
        length * psi_2,
        length * psi_3,
        length * psi_4,
        length * psi_5,
        x16 * crank * speed - slope * x22,
        (
            R1_dot * gamma_dot * x6 - gamma_dot * x23 - gamma_dot * (gamma_dot * x12 - R1_dot * x6
            + x23)
        ),
        (x26 - gamma_dot * x9) * gamma_dot + x27,
        (
            -curvature * (x2 * x28 * x19**2 * crank**2 + gamma_dot * x29 + gamma_dot * (x30 *
            x21**2 + x29)) - gamma_dot * x22 - gamma_dot * (x19 * crank * speed + gamma_dot * (x7 -
            x18 - x20 - x8) - x26) + slope * (x16 * x28 * crank - gamma_dot * x31 - gamma_dot *
            (-x30 * (x14 * x2 + x17 * x2) + x31)) + (-slope_rate * (gamma_dot * x13 * x21 + 2 *
            x22)) + x20 * x28 + x27
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
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
        Entry of stiffness.
    stiffness_6_3 : float or ndarray
        Entry of stiffness.
    stiffness_6_6 : float or ndarray
        Entry of stiffness.
    stiffness_7_3 : float or ndarray
        Entry of stiffness.
    stiffness_7_7 : float or ndarray
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
    x0 = mass_per_length * length**3
    x1 = 2 * x0
    x2 = f1 * x1
    x3 = f2 * x1
    x4 = f3 * x1
    x5 = f4 * x1
    x6 = f5 * x1
    x7 = gamma_dot * x2
    x8 = gamma_dot * x3
    x9 = gamma_dot * x4
    x10 = gamma_dot * x5
    x11 = gamma_dot * x6
    x12 = xp.sin(gamma)
    x13 = xp.cos(gamma)
    x14 = R2 * x13
    x15 = R1 * x12 - x14
    x16 = R1 * x13 + R2 * x12
    x18 = 1 / length
    x19 = x13 * frame
    x20 = x18 * x19
    x21 = gamma - t * speed
    x22 = xp.cos(x21)
    x23 = x22 * crank
    x24 = x18 * x23
    x25 = -x20 - x24
    x26 = lam_3 * length
    x27 = x12 * frame
    x28 = xp.sin(x21)
    x29 = x28 * crank
    x30 = R1 * x12 - x14 - x27 - x29
    x31 = x18 * x27 + x18 * x29
    x33 = x31**2
    x34 = gamma_dot * x1
    x35 = -x31 * length
    x36 = lam_3 * x35
    x37 = -psi_1_d1 * x36
    x38 = -psi_2_d1 * x36
    x39 = -psi_3_d1 * x36
    x40 = -psi_4_d1 * x36
    x41 = -psi_5_d1 * x36
    x42 = x18 * bending_stiffness
    x43 = gamma_dot**2
    x44 = -x0 * x43
    x45 = gamma_dot * x12
    x46 = gamma_dot * x13
    x47 = R2_dot * x13
    x48 = R1_dot * x12
    x49 = R1_dot * x13
    x50 = R2_dot * x12
    x51 = gamma_dot * x15 - x49 - x50
    x52 = x29 * speed
    x53 = x23 * speed
    x54 = gamma_dot * length
    x55 = x25 * x54
    x56 = x53 + x55
    x57 = x33 * x54
    x58 = -x31 * x52
    x59 = x57 + x58
    x60 = x52 - x31 * x54
    x61 = gamma_ddot * x13 - x12 * x43
    x62 = R1_ddot * x13
    x63 = R2_ddot * x12
    x64 = R2_dot * x46
    x65 = x48 - x47
    x66 = speed**2
    x67 = x18 * x66 * crank**2
    x68 = gamma_ddot * length
    x69 = x23 * x66
    x70 = 2 * x53
    x71 = x25 * x52 - x31 * x70
    x72 = gamma_dot * x52
    x73 = x67 * x28**2
    x74 = gamma_dot * x53 - x69
    x75 = gamma_ddot * x35 + gamma_dot * x56 + x74
    x76 = gamma_dot * x58 + gamma_dot * x59 + x73
    return (
        f1_dot * x2 + f2_dot * x3 + f3_dot * x4 + f4_dot * x5 + f5_dot * x6,
        x7,
        x8,
        x9,
        x10,
        x11,
        -x7,
        -x8,
        -x9,
        -x10,
        -x11,
        x12 * lam_1 + x13 * lam_2 + lam_3 * x13,
        x12 * lam_2 - x13 * lam_1 + lam_3 * x12,
        x16 * lam_1 - curvature * x26 * x33 - x15 * lam_2 - lam_3 * x30 - slope * x25 * x26,
        f1_dot * x34 + gamma_ddot * x2 + x37,
        f2_dot * x34 + gamma_ddot * x3 + x38,
        f3_dot * x34 + gamma_ddot * x4 + x39,
        f4_dot * x34 + gamma_ddot * x5 + x40,
        f5_dot * x34 + gamma_ddot * x6 + x41,
        x37,
        500.5639017404326 * x42 + x44,
        x38,
        3803.5370804978666 * x42 + x44,
        x39,
        14617.630131122343 * x42 + x44,
        x40,
        39943.799005709305 * x42 + x44,
        x41,
        89135.40765718032 * x42 + x44,
        -x45,
        x46,
        x47 - gamma_dot * x16 - x48,
        -x46,
        x51,
        curvature * x59 + gamma_dot * x30 + slope * x56 + slope_rate * x35 - x49 - x50 + x52,
        psi_1_d1 * x60,
        psi_2_d1 * x60,
        psi_3_d1 * x60,
        psi_4_d1 * x60,
        psi_5_d1 * x60,
        -gamma_ddot * x12 - x13 * x43,
        x61,
        (
            R2_ddot * x13 - R1_ddot * x12 - R1_dot * x46 - R2_dot * x45 - gamma_ddot * x16 +
            gamma_dot * x51
        ),
        -x61,
        (
            R1_dot * gamma_dot * x12 + gamma_ddot * x15 + gamma_dot * (gamma_dot * x16 + x65) - x62
            - x63 - x64
        ),
        (
            R1_dot * x45 + curvature * (gamma_dot * x71 + gamma_dot * (gamma_dot * (x25 * x35 +
            (-x35 * (2 * x20 + 2 * x24))) + x71) + 2 * x22 * x28 * x67 + x31 * x69 + x33 * x68) +
            curvature_rate * (2 * x57 + 2 * x58) + gamma_ddot * x30 + gamma_dot * (gamma_dot * (x16
            - x19 - x23) + x53 + x65) + slope * (gamma_dot * (gamma_dot * x31 * length - x52) + x25
            * x68 + x29 * x66 - x72) + slope_rate * (2 * x55 + x70) + slope_second_rate * x35 +
            third * (gamma_dot * (x33 * x52 - x54 * x31**3) - x31 * x73 + x33 * x72) - x62 - x63 -
            x64 + x74
        ),
        psi_1_d1 * x75 + psi_1_d2 * x76,
        psi_2_d1 * x75 + psi_2_d2 * x76,
        psi_3_d1 * x75 + psi_3_d2 * x76,
        psi_4_d1 * x75 + psi_4_d2 * x76,
        psi_5_d1 * x75 + psi_5_d2 * x76,
    )
