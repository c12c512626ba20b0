"""Quick-return mechanism, flexible rod in Buckens' frame, 1 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 1 modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 49 operations
    dynamics: 141 operations
    variations: 253 operations
Content hash 14c66002c7256c0dbb5ae0b800e19660; derived with SymPy 1.14.0.
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
    'rn","modes":1,"outputs":[]}'
)
CONTENT = "14c66002c7256c0dbb5ae0b800e19660"
COORDINATES = ('R1', 'R2', 'gamma', 'f1')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3')
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    4), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (1, 0, 7), (1, 1, 3), (1, 2, 8), (1, 3, 9),
    (2, 0, 7), (2, 1, 3), (2, 2, 10), (2, 3, 11),))}, 'dynamics': {'mass': ((4, 4), ((0, 0, 0), (1,
    1, 0), (2, 2, 1), (3, 3, 2),)), 'rest': ((4, 1), ((2, 0, 3), (3, 0, 4),)), 'forces': ((4, 1),
    ()), 'jacobian': ((3, 4), ((0, 0, 5), (0, 1, 6), (0, 2, 7), (0, 3, 8), (1, 0, 9), (1, 1, 5),
    (1, 2, 10), (1, 3, 11), (2, 0, 9), (2, 1, 5), (2, 2, 12), (2, 3, 13),)), 'velocity_rhs': ((3,
    1), ((2, 0, 14),)), 'gamma': ((3, 1), ((0, 0, 15), (1, 0, 16), (2, 0, 17),))}, 'variations':
    {'damping': ((4, 4), ((2, 2, 0), (2, 3, 1), (3, 2, 2),)), 'stiffness': ((4, 4), ((0, 2, 3), (1,
    2, 4), (2, 0, 3), (2, 1, 4), (2, 2, 5), (2, 3, 6), (3, 2, 7), (3, 3, 8),)), 'jacobian_rate':
    ((3, 4), ((0, 0, 9), (0, 1, 10), (0, 2, 11), (0, 3, 12), (1, 0, 13), (1, 1, 9), (1, 2, 14), (2,
    0, 13), (2, 1, 9), (2, 2, 15), (2, 3, 16),)), 'jacobian_acceleration': ((3, 4), ((0, 0, 17),
    (0, 1, 18), (0, 2, 19), (0, 3, 20), (1, 0, 21), (1, 1, 17), (1, 2, 22), (2, 0, 21), (2, 1, 17),
    (2, 2, 23), (2, 3, 24),))}}
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
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_3_3",
        "jacobian_3_4",
    ),
    "dynamics": (
        "mass_1_1",
        "mass_3_3",
        "mass_4_4",
        "rest_3_1",
        "rest_4_1",
        "jacobian_1_1",
        "jacobian_1_2",
        "jacobian_1_3",
        "jacobian_1_4",
        "jacobian_2_1",
        "jacobian_2_3",
        "jacobian_2_4",
        "jacobian_3_3",
        "jacobian_3_4",
        "velocity_rhs_3_1",
        "gamma_1_1",
        "gamma_2_1",
        "gamma_3_1",
    ),
    "variations": (
        "damping_3_3",
        "damping_3_4",
        "damping_4_3",
        "stiffness_1_3",
        "stiffness_2_3",
        "stiffness_3_3",
        "stiffness_3_4",
        "stiffness_4_3",
        "stiffness_4_4",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_1_4",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4",
        "jacobian_acceleration_2_1",
        "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3",
        "jacobian_acceleration_3_4",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    R1, R2, gamma, f1, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, crank, frame, length,
    bending_stiffness, mass_per_length, speed,
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
    jacobian_2_1 : float or ndarray
        Entry of jacobian.
    jacobian_2_3 : float or ndarray
        Entry of jacobian.
    jacobian_2_4 : float or ndarray
        Entry of jacobian.
    jacobian_3_3 : float or ndarray
        Entry of jacobian.
    jacobian_3_4 : float or ndarray
        Entry of jacobian.

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    slope = f1 * psi_1_d1
    value = f1 * psi_1
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
        12.370205669468392 * length * f1**2 - length / 2 + x4,
        f1 * x5 + x7,
        value * length + x10 + x7 + x9,
        x0,
        x2,
        R2 * x0 - x6,
        24.740411338936784 * f1 * length,
        -x2,
        -x4,
        x5,
        crank * xp.cos(x8) + x0 * frame + (-slope * length * (x10 * x11 + x11 * x9)) - x1 - x3,
        psi_1 * length,
    )


def dynamics(
    R1, R2, gamma, f1, R1_dot, R2_dot, gamma_dot, f1_dot, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3,
    crank, frame, length, bending_stiffness, mass_per_length, speed,
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
    R1_dot : float or ndarray, shape (...)
        Velocity R1_dot.
    R2_dot : float or ndarray, shape (...)
        Velocity R2_dot.
    gamma_dot : float or ndarray, shape (...)
        Velocity gamma_dot.
    f1_dot : float or ndarray, shape (...)
        Velocity f1_dot.
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
    jacobian_1_1 : float or ndarray
        Entry of jacobian.
    jacobian_1_2 : float or ndarray
        Entry of jacobian.
    jacobian_1_3 : float or ndarray
        Entry of jacobian.
    jacobian_1_4 : float or ndarray
        Entry of jacobian.
    jacobian_2_1 : float or ndarray
        Entry of jacobian.
    jacobian_2_3 : float or ndarray
        Entry of jacobian.
    jacobian_2_4 : float or ndarray
        Entry of jacobian.
    jacobian_3_3 : float or ndarray
        Entry of jacobian.
    jacobian_3_4 : float or ndarray
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
    curvature = f1 * psi_1_d2
    slope = f1 * psi_1_d1
    slope_rate = f1_dot * psi_1_d1
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 2.0497641363910746 * x1
    x3 = 1 / length
    x4 = xp.cos(gamma)
    x5 = xp.sin(gamma)
    x6 = R1 * x5
    x7 = R2 * x4
    x8 = x6 - x7
    x9 = 24.740411338936784 * length
    x10 = R1 * x4
    x11 = R2 * x5
    x12 = -x10 - x11
    x13 = 2 * length
    x14 = x4 * frame
    x15 = gamma - t * speed
    x16 = xp.cos(x15)
    x17 = x16 * crank
    x18 = x5 * frame
    x19 = xp.sin(x15)
    x20 = x19 * crank
    x21 = -x18 * x3 - x20 * x3
    x22 = x20 * speed
    x23 = R2_dot * x4
    x24 = R1_dot * x4
    x25 = R2_dot * x5
    x26 = x24 + x25
    x27 = gamma_dot * x24 + gamma_dot * x25
    x28 = speed**2
    x29 = x21 * x22
    x30 = gamma_dot * length
    x31 = x17 * speed
    return (
        length * mass_per_length,
        x0 * mass_per_length / 12 - x2 * f1**2,
        x1,
        -4.099528272782149 * f1 * f1_dot * gamma_dot * x1,
        500.5639017404326 * f1 * x3 * bending_stiffness + f1 * x2 * gamma_dot**2,
        x4,
        x5,
        -x8,
        f1 * x9,
        -x5,
        x12,
        x13,
        slope * x21 * length - x10 - x11 + x14 + x17,
        length * psi_1,
        x16 * crank * speed - slope * x22,
        (
            R1_dot * gamma_dot * x5 - x9 * f1_dot**2 - gamma_dot * x23 - gamma_dot * (gamma_dot *
            x12 - R1_dot * x5 + x23)
        ),
        (x26 - gamma_dot * x8) * gamma_dot + x27,
        (
            -curvature * (x28 * x3 * x19**2 * crank**2 + gamma_dot * x29 + gamma_dot * (x30 *
            x21**2 + x29)) - gamma_dot * x22 - gamma_dot * (x19 * crank * speed + gamma_dot * (x6 -
            x18 - x20 - x7) - x26) + slope * (x16 * x28 * crank - gamma_dot * x31 - gamma_dot *
            (-x30 * (x14 * x3 + x17 * x3) + x31)) + (-slope_rate * (gamma_dot * x13 * x21 + 2 *
            x22)) + x20 * x28 + x27
        ),
    )


def variations(
    R1, R2, gamma, f1, R1_dot, R2_dot, gamma_dot, f1_dot, R1_ddot, R2_ddot, gamma_ddot, f1_ddot,
    lam_1, lam_2, lam_3, t, psi_1, psi_1_d1, psi_1_d2, psi_1_d3, crank, frame, length,
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
    R1_dot : float or ndarray, shape (...)
        Velocity R1_dot.
    R2_dot : float or ndarray, shape (...)
        Velocity R2_dot.
    gamma_dot : float or ndarray, shape (...)
        Velocity gamma_dot.
    f1_dot : float or ndarray, shape (...)
        Velocity f1_dot.
    R1_ddot : float or ndarray, shape (...)
        Acceleration R1_ddot.
    R2_ddot : float or ndarray, shape (...)
        Acceleration R2_ddot.
    gamma_ddot : float or ndarray, shape (...)
        Acceleration gamma_ddot.
    f1_ddot : float or ndarray, shape (...)
        Acceleration f1_ddot.
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
    damping_4_3 : float or ndarray
        Entry of damping.
    stiffness_1_3 : float or ndarray
        Entry of stiffness.
    stiffness_2_3 : float or ndarray
        Entry of stiffness.
    stiffness_3_3 : float or ndarray
        Entry of stiffness.
    stiffness_3_4 : float or ndarray
        Entry of stiffness.
    stiffness_4_3 : float or ndarray
        Entry of stiffness.
    stiffness_4_4 : float or ndarray
        Entry of stiffness.
    jacobian_rate_1_1 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_2 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_4 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_2_1 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_2_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_3 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_3_4 : float or ndarray
        Entry of jacobian_rate.
    jacobian_acceleration_1_1 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_2 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_4 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_2_1 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_2_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_3 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_3_4 : float or ndarray
        Entry of jacobian_acceleration.

    Notes
    -----
    Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).
    """
    xp = _namespace(R1)
    curvature = f1 * psi_1_d2
    curvature_rate = f1_dot * psi_1_d2
    slope = f1 * psi_1_d1
    slope_rate = f1_dot * psi_1_d1
    slope_second_rate = f1_ddot * psi_1_d1
    third = f1 * psi_1_d3
    x0 = mass_per_length * length**3
    x1 = 4.099528272782149 * f1 * x0
    x2 = gamma_dot * x1
    x3 = xp.sin(gamma)
    x4 = xp.cos(gamma)
    x5 = R2 * x4
    x6 = R1 * x3 - x5
    x7 = R1 * x4 + R2 * x3
    x9 = 1 / length
    x10 = x4 * frame
    x11 = x10 * x9
    x12 = gamma - t * speed
    x13 = xp.cos(x12)
    x14 = x13 * crank
    x15 = x14 * x9
    x16 = -x11 - x15
    x17 = lam_3 * length
    x18 = x3 * frame
    x19 = xp.sin(x12)
    x20 = x19 * crank
    x21 = R1 * x3 - x18 - x20 - x5
    x22 = x18 * x9 + x20 * x9
    x24 = x22**2
    x25 = -x22 * length
    x26 = lam_3 * psi_1_d1 * x25
    x27 = 24.740411338936784 * length
    x28 = gamma_dot**2
    x29 = gamma_dot * x3
    x30 = gamma_dot * x4
    x31 = R2_dot * x4
    x32 = R1_dot * x3
    x33 = R1_dot * x4
    x34 = R2_dot * x3
    x35 = gamma_dot * x6 - x33 - x34
    x36 = x20 * speed
    x37 = x14 * speed
    x38 = gamma_dot * length
    x39 = x16 * x38
    x40 = x37 + x39
    x41 = x24 * x38
    x42 = -x22 * x36
    x43 = x41 + x42
    x44 = gamma_ddot * x4 - x28 * x3
    x45 = R1_ddot * x4
    x46 = R2_ddot * x3
    x47 = R2_dot * x30
    x48 = x32 - x31
    x49 = speed**2
    x50 = x49 * x9 * crank**2
    x51 = gamma_ddot * length
    x52 = x14 * x49
    x53 = 2 * x37
    x54 = x16 * x36 - x22 * x53
    x55 = gamma_dot * x36
    x56 = x50 * x19**2
    x57 = gamma_dot * x37 - x52
    return (
        -f1_dot * x1,
        -x2,
        x2,
        x3 * lam_1 + x4 * lam_2 + lam_3 * x4,
        x3 * lam_2 - x4 * lam_1 + lam_3 * x3,
        x7 * lam_1 - curvature * x17 * x24 - x6 * lam_2 - lam_3 * x21 - slope * x16 * x17,
        -4.099528272782149 * f1_dot * gamma_dot * x0 - gamma_ddot * x1 - x26,
        -x26,
        500.5639017404326 * x9 * bending_stiffness - x27 * lam_1 + 2.0497641363910746 * x0 * x28,
        -x29,
        x30,
        x31 - gamma_dot * x7 - x32,
        f1_dot * x27,
        -x30,
        x35,
        curvature * x43 + gamma_dot * x21 + slope * x40 + slope_rate * x25 - x33 - x34 + x36,
        psi_1_d1 * (x36 - x22 * x38),
        -gamma_ddot * x3 - x28 * x4,
        x44,
        (
            R2_ddot * x4 - R1_ddot * x3 - R1_dot * x30 - R2_dot * x29 - gamma_ddot * x7 + gamma_dot
            * x35
        ),
        f1_ddot * x27,
        -x44,
        (
            R1_dot * gamma_dot * x3 + gamma_ddot * x6 + gamma_dot * (gamma_dot * x7 + x48) - x45 -
            x46 - x47
        ),
        (
            R1_dot * x29 + curvature * (gamma_dot * x54 + gamma_dot * (gamma_dot * (x16 * x25 +
            (-x25 * (2 * x11 + 2 * x15))) + x54) + 2 * x13 * x19 * x50 + x22 * x52 + x24 * x51) +
            curvature_rate * (2 * x41 + 2 * x42) + gamma_ddot * x21 + gamma_dot * (gamma_dot * (x7
            - x10 - x14) + x37 + x48) + slope * (gamma_dot * (gamma_dot * x22 * length - x36) + x16
            * x51 + x20 * x49 - x55) + slope_rate * (2 * x39 + x53) + slope_second_rate * x25 +
            third * (gamma_dot * (x24 * x36 - x38 * x22**3) - x22 * x56 + x24 * x55) - x45 - x46 -
            x47 + x57
        ),
        (
            psi_1_d1 * (gamma_ddot * x25 + gamma_dot * x40 + x57) + psi_1_d2 * (gamma_dot * x42 +
            gamma_dot * x43 + x56)
        ),
    )
