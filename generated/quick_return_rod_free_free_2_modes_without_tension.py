"""Quick-return mechanism, flexible rod in Buckens' frame, 2 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 2 modes, without tension.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 53 operations
    dynamics: 151 operations
    variations: 274 operations
Content hash 8c539d0fcff7c43f9108e5f5a424974e; derived with SymPy 1.14.0.
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
    'uick_return","modes":2,"outputs":[]}'
)
CONTENT = "8c539d0fcff7c43f9108e5f5a424974e"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    5), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (1, 0, 6), (1, 1, 3), (1, 2, 7), (1, 3, 8), (1, 4, 9),
    (2, 0, 6), (2, 1, 3), (2, 2, 10), (2, 3, 11), (2, 4, 12),))}, 'dynamics': {'mass': ((5, 5),
    ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4, 2),)), 'rest': ((5, 1), ((2, 0, 3), (3, 0,
    4), (4, 0, 5),)), 'forces': ((5, 1), ()), 'jacobian': ((3, 5), ((0, 0, 6), (0, 1, 7), (0, 2,
    8), (1, 0, 9), (1, 1, 6), (1, 2, 10), (1, 3, 11), (1, 4, 12), (2, 0, 9), (2, 1, 6), (2, 2, 13),
    (2, 3, 14), (2, 4, 15),)), 'velocity_rhs': ((3, 1), ((2, 0, 16),)), 'gamma': ((3, 1), ((0, 0,
    17), (1, 0, 18), (2, 0, 19),))}, 'variations': {'damping': ((5, 5), ((2, 2, 0), (2, 3, 1), (2,
    4, 2), (3, 2, 3), (4, 2, 4),)), 'stiffness': ((5, 5), ((0, 2, 5), (1, 2, 6), (2, 0, 5), (2, 1,
    6), (2, 2, 7), (2, 3, 8), (2, 4, 9), (3, 2, 10), (3, 3, 11), (4, 2, 12), (4, 4, 13),)),
    'jacobian_rate': ((3, 5), ((0, 0, 14), (0, 1, 15), (0, 2, 16), (1, 0, 17), (1, 1, 14), (1, 2,
    18), (2, 0, 17), (2, 1, 14), (2, 2, 19), (2, 3, 20), (2, 4, 21),)), 'jacobian_acceleration':
    ((3, 5), ((0, 0, 22), (0, 1, 23), (0, 2, 24), (1, 0, 25), (1, 1, 22), (1, 2, 26), (2, 0, 25),
    (2, 1, 22), (2, 2, 27), (2, 3, 28), (2, 4, 29),))}}
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
    ),
    "dynamics": (
        "mass_1_1",
        "mass_3_3",
        "mass_4_4",
        "rest_3_1",
        "rest_4_1",
        "rest_5_1",
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
        "velocity_rhs_3_1",
        "gamma_1_1",
        "gamma_2_1",
        "gamma_3_1",
    ),
    "variations": (
        "damping_3_3",
        "damping_3_4",
        "damping_3_5",
        "damping_4_3",
        "damping_5_3",
        "stiffness_1_3",
        "stiffness_2_3",
        "stiffness_3_3",
        "stiffness_3_4",
        "stiffness_3_5",
        "stiffness_4_3",
        "stiffness_4_4",
        "stiffness_5_3",
        "stiffness_5_5",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_2_1",
        "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3",
        "jacobian_acceleration_3_4",
        "jacobian_acceleration_3_5",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    R1, R2, gamma, f1, f2, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1, psi_2_d2,
    psi_2_d3, crank, frame, length, bending_stiffness, mass_per_length, speed,
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    slope = f1 * psi_1_d1 + f2 * psi_2_d1
    value = f1 * psi_1 + f2 * psi_2
    x0 = xp.cos(gamma)
    x1 = R1 * x0
    x2 = xp.sin(gamma)
    x3 = R2 * x2
    x4 = x1 + x3
    x5 = 2 * length
    x6 = R1 * x2
    x7 = x6 - R2 * x0
    x8 = x2 * frame
    x9 = gamma - t * speed
    x10 = crank * xp.sin(x9)
    x11 = 1 / length
    return (
        x4 - length / 2,
        2 * f1 * length - f2 * x5 - x7,
        R2 * x0 + value * length + x10 - x6 + x8,
        x0,
        x2,
        -x7,
        -x2,
        -x4,
        x5,
        -x5,
        crank * xp.cos(x9) + x0 * frame + (-slope * length * (x10 * x11 + x11 * x8)) - x1 - x3,
        psi_1 * length,
        psi_2 * length,
    )


def dynamics(
    R1, R2, gamma, f1, f2, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, t, psi_1, psi_1_d1, psi_1_d2,
    psi_1_d3, psi_2, psi_2_d1, psi_2_d2, psi_2_d3, crank, frame, length, bending_stiffness,
    mass_per_length, speed,
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
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1
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
        x0 * f1**2 + x0 * f2**2 + x0 / 12,
        x0,
        f1 * f1_dot * x1 + f2 * f2_dot * x1,
        500.5639017404326 * f1 * x3 - f1 * x4,
        3803.5370804978666 * f2 * x3 - f2 * x4,
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
    R1, R2, gamma, f1, f2, R1_dot, R2_dot, gamma_dot, f1_dot, f2_dot, R1_ddot, R2_ddot, gamma_ddot,
    f1_ddot, f2_ddot, lam_1, lam_2, lam_3, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, psi_2, psi_2_d1,
    psi_2_d2, psi_2_d3, crank, frame, length, bending_stiffness, mass_per_length, speed,
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
    damping_4_3 : float or ndarray
        Entry of damping.
    damping_5_3 : float or ndarray
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
    stiffness_4_3 : float or ndarray
        Entry of stiffness.
    stiffness_4_4 : float or ndarray
        Entry of stiffness.
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
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

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2 + f2 * psi_2_d2
    curvature_rate = f1_dot * psi_1_d2 + f2_dot * psi_2_d2
    slope = f1 * psi_1_d1 + f2 * psi_2_d1
    slope_rate = f1_dot * psi_1_d1 + f2_dot * psi_2_d1
    slope_second_rate = f1_ddot * psi_1_d1 + f2_ddot * psi_2_d1
    third = f1 * psi_1_d3 + f2 * psi_2_d3
    x0 = mass_per_length * length**3
    x1 = 2 * x0
    x2 = f1 * x1
    x3 = f2 * x1
    x4 = gamma_dot * x2
    x5 = gamma_dot * x3
    x6 = xp.sin(gamma)
    x7 = xp.cos(gamma)
    x8 = R2 * x7
    x9 = R1 * x6 - x8
    x10 = R1 * x7 + R2 * x6
    x12 = 1 / length
    x13 = x7 * frame
    x14 = x12 * x13
    x15 = gamma - t * speed
    x16 = xp.cos(x15)
    x17 = x16 * crank
    x18 = x12 * x17
    x19 = -x14 - x18
    x20 = lam_3 * length
    x21 = x6 * frame
    x22 = xp.sin(x15)
    x23 = x22 * crank
    x24 = R1 * x6 - x21 - x23 - x8
    x25 = x12 * x21 + x12 * x23
    x27 = x25**2
    x28 = gamma_dot * x1
    x29 = -x25 * length
    x30 = lam_3 * x29
    x31 = -psi_1_d1 * x30
    x32 = -psi_2_d1 * x30
    x33 = x12 * bending_stiffness
    x34 = gamma_dot**2
    x35 = -x0 * x34
    x36 = gamma_dot * x6
    x37 = gamma_dot * x7
    x38 = R2_dot * x7
    x39 = R1_dot * x6
    x40 = R1_dot * x7
    x41 = R2_dot * x6
    x42 = gamma_dot * x9 - x40 - x41
    x43 = x23 * speed
    x44 = x17 * speed
    x45 = gamma_dot * length
    x46 = x19 * x45
    x47 = x44 + x46
    x48 = x27 * x45
    x49 = -x25 * x43
    x50 = x48 + x49
    x51 = x43 - x25 * x45
    x52 = gamma_ddot * x7 - x34 * x6
    x53 = R1_ddot * x7
    x54 = R2_ddot * x6
    x55 = R2_dot * x37
    x56 = x39 - x38
    x57 = speed**2
    x58 = x12 * x57 * crank**2
    x59 = gamma_ddot * length
    x60 = x17 * x57
    x61 = 2 * x44
    x62 = x19 * x43 - x25 * x61
    x63 = gamma_dot * x43
    x64 = x58 * x22**2
    x65 = gamma_dot * x44 - x60
    x66 = gamma_ddot * x29 + gamma_dot * x47 + x65
    x67 = gamma_dot * x49 + gamma_dot * x50 + x64
    return (
        f1_dot * x2 + f2_dot * x3,
        x4,
        x5,
        -x4,
        -x5,
        x6 * lam_1 + x7 * lam_2 + lam_3 * x7,
        x6 * lam_2 - x7 * lam_1 + lam_3 * x6,
        x10 * lam_1 - curvature * x20 * x27 - x9 * lam_2 - lam_3 * x24 - slope * x19 * x20,
        f1_dot * x28 + gamma_ddot * x2 + x31,
        f2_dot * x28 + gamma_ddot * x3 + x32,
        x31,
        500.5639017404326 * x33 + x35,
        x32,
        3803.5370804978666 * x33 + x35,
        -x36,
        x37,
        x38 - gamma_dot * x10 - x39,
        -x37,
        x42,
        curvature * x50 + gamma_dot * x24 + slope * x47 + slope_rate * x29 - x40 - x41 + x43,
        psi_1_d1 * x51,
        psi_2_d1 * x51,
        -gamma_ddot * x6 - x34 * x7,
        x52,
        (
            R2_ddot * x7 - R1_ddot * x6 - R1_dot * x37 - R2_dot * x36 - gamma_ddot * x10 +
            gamma_dot * x42
        ),
        -x52,
        (
            R1_dot * gamma_dot * x6 + gamma_ddot * x9 + gamma_dot * (gamma_dot * x10 + x56) - x53 -
            x54 - x55
        ),
        (
            R1_dot * x36 + curvature * (gamma_dot * x62 + gamma_dot * (gamma_dot * (x19 * x29 +
            (-x29 * (2 * x14 + 2 * x18))) + x62) + 2 * x16 * x22 * x58 + x25 * x60 + x27 * x59) +
            curvature_rate * (2 * x48 + 2 * x49) + gamma_ddot * x24 + gamma_dot * (gamma_dot * (x10
            - x13 - x17) + x44 + x56) + slope * (gamma_dot * (gamma_dot * x25 * length - x43) + x19
            * x59 + x23 * x57 - x63) + slope_rate * (2 * x46 + x61) + slope_second_rate * x29 +
            third * (gamma_dot * (x27 * x43 - x45 * x25**3) - x25 * x64 + x27 * x63) - x53 - x54 -
            x55 + x65
        ),
        psi_1_d1 * x66 + psi_1_d2 * x67,
        psi_2_d1 * x66 + psi_2_d2 * x67,
    )
