"""Quick-return mechanism, flexible rod in Buckens' frame, 1 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 1 modes, without tension.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 43 operations
    dynamics: 132 operations
    variations: 245 operations
Content hash 4e173f7f11571dd2f683d36277a8593d; derived with SymPy 1.14.0.
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
    'uick_return","modes":1,"outputs":[]}'
)
CONTENT = "4e173f7f11571dd2f683d36277a8593d"
COORDINATES = ('R1', 'R2', 'gamma', 'f1')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3')
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    4), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (1, 0, 6), (1, 1, 3), (1, 2, 7), (1, 3, 8), (2, 0, 6),
    (2, 1, 3), (2, 2, 9), (2, 3, 10),))}, 'dynamics': {'mass': ((4, 4), ((0, 0, 0), (1, 1, 0), (2,
    2, 1), (3, 3, 2),)), 'rest': ((4, 1), ((2, 0, 3), (3, 0, 4),)), 'forces': ((4, 1), ()),
    'jacobian': ((3, 4), ((0, 0, 5), (0, 1, 6), (0, 2, 7), (1, 0, 8), (1, 1, 5), (1, 2, 9), (1, 3,
    10), (2, 0, 8), (2, 1, 5), (2, 2, 11), (2, 3, 12),)), 'velocity_rhs': ((3, 1), ((2, 0, 13),)),
    'gamma': ((3, 1), ((0, 0, 14), (1, 0, 15), (2, 0, 16),))}, 'variations': {'damping': ((4, 4),
    ((2, 2, 0), (2, 3, 1), (3, 2, 2),)), 'stiffness': ((4, 4), ((0, 2, 3), (1, 2, 4), (2, 0, 3),
    (2, 1, 4), (2, 2, 5), (2, 3, 6), (3, 2, 7), (3, 3, 8),)), 'jacobian_rate': ((3, 4), ((0, 0, 9),
    (0, 1, 10), (0, 2, 11), (1, 0, 12), (1, 1, 9), (1, 2, 13), (2, 0, 12), (2, 1, 9), (2, 2, 14),
    (2, 3, 15),)), 'jacobian_acceleration': ((3, 4), ((0, 0, 16), (0, 1, 17), (0, 2, 18), (1, 0,
    19), (1, 1, 16), (1, 2, 20), (2, 0, 19), (2, 1, 16), (2, 2, 21), (2, 3, 22),))}}
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
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
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
        x4 - length / 2,
        f1 * x5 + x7,
        value * length + x10 + x7 + x9,
        x0,
        x2,
        R2 * x0 - x6,
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
    x0 = mass_per_length * length**3
    x1 = f1 * x0
    x2 = 1 / length
    x3 = xp.cos(gamma)
    x4 = xp.sin(gamma)
    x5 = R1 * x4
    x6 = R2 * x3
    x7 = x5 - x6
    x8 = R1 * x3
    x9 = R2 * x4
    x10 = -x8 - x9
    x11 = 2 * length
    x12 = x3 * frame
    x13 = gamma - t * speed
    x14 = xp.cos(x13)
    x15 = x14 * crank
    x16 = x4 * frame
    x17 = xp.sin(x13)
    x18 = x17 * crank
    x19 = -x16 * x2 - x18 * x2
    x20 = x18 * speed
    x21 = R2_dot * x3
    x22 = R1_dot * x3
    x23 = R2_dot * x4
    x24 = x22 + x23
    x25 = gamma_dot * x22 + gamma_dot * x23
    x26 = speed**2
    x27 = x19 * x20
    x28 = gamma_dot * length
    x29 = x15 * speed
    return (
        length * mass_per_length,
        x0 * f1**2 + x0 / 12,
        x0,
        2 * f1_dot * gamma_dot * x1,
        500.5639017404326 * f1 * x2 * bending_stiffness - x1 * gamma_dot**2,
        x3,
        x4,
        -x7,
        -x4,
        x10,
        x11,
        slope * x19 * length + x12 + x15 - x8 - x9,
        length * psi_1,
        x14 * crank * speed - slope * x20,
        (
            R1_dot * gamma_dot * x4 - gamma_dot * x21 - gamma_dot * (gamma_dot * x10 - R1_dot * x4
            + x21)
        ),
        (x24 - gamma_dot * x7) * gamma_dot + x25,
        (
            -curvature * (x2 * x26 * x17**2 * crank**2 + gamma_dot * x27 + gamma_dot * (x28 *
            x19**2 + x27)) - gamma_dot * x20 - gamma_dot * (x17 * crank * speed + gamma_dot * (x5 -
            x16 - x18 - x6) - x24) + slope * (x14 * x26 * crank - gamma_dot * x29 - gamma_dot *
            (-x28 * (x12 * x2 + x15 * x2) + x29)) + (-slope_rate * (gamma_dot * x11 * x19 + 2 *
            x20)) + x18 * x26 + x25
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
    x1 = 2 * f1 * x0
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
    x26 = -lam_3 * psi_1_d1 * x25
    x27 = gamma_dot**2
    x28 = gamma_dot * x3
    x29 = gamma_dot * x4
    x30 = R2_dot * x4
    x31 = R1_dot * x3
    x32 = R1_dot * x4
    x33 = R2_dot * x3
    x34 = gamma_dot * x6 - x32 - x33
    x35 = x20 * speed
    x36 = x14 * speed
    x37 = gamma_dot * length
    x38 = x16 * x37
    x39 = x36 + x38
    x40 = x24 * x37
    x41 = -x22 * x35
    x42 = x40 + x41
    x43 = gamma_ddot * x4 - x27 * x3
    x44 = R1_ddot * x4
    x45 = R2_ddot * x3
    x46 = R2_dot * x29
    x47 = x31 - x30
    x48 = speed**2
    x49 = x48 * x9 * crank**2
    x50 = gamma_ddot * length
    x51 = x14 * x48
    x52 = 2 * x36
    x53 = x16 * x35 - x22 * x52
    x54 = gamma_dot * x35
    x55 = x49 * x19**2
    x56 = gamma_dot * x36 - x51
    return (
        f1_dot * x1,
        x2,
        -x2,
        x3 * lam_1 + x4 * lam_2 + lam_3 * x4,
        x3 * lam_2 - x4 * lam_1 + lam_3 * x3,
        x7 * lam_1 - curvature * x17 * x24 - x6 * lam_2 - lam_3 * x21 - slope * x16 * x17,
        2 * f1_dot * gamma_dot * x0 + gamma_ddot * x1 + x26,
        x26,
        500.5639017404326 * x9 * bending_stiffness - x0 * x27,
        -x28,
        x29,
        x30 - gamma_dot * x7 - x31,
        -x29,
        x34,
        curvature * x42 + gamma_dot * x21 + slope * x39 + slope_rate * x25 - x32 - x33 + x35,
        psi_1_d1 * (x35 - x22 * x37),
        -gamma_ddot * x3 - x27 * x4,
        x43,
        (
            R2_ddot * x4 - R1_ddot * x3 - R1_dot * x29 - R2_dot * x28 - gamma_ddot * x7 + gamma_dot
            * x34
        ),
        -x43,
        (
            R1_dot * gamma_dot * x3 + gamma_ddot * x6 + gamma_dot * (gamma_dot * x7 + x47) - x44 -
            x45 - x46
        ),
        (
            R1_dot * x28 + curvature * (gamma_dot * x53 + gamma_dot * (gamma_dot * (x16 * x25 +
            (-x25 * (2 * x11 + 2 * x15))) + x53) + 2 * x13 * x19 * x49 + x22 * x51 + x24 * x50) +
            curvature_rate * (2 * x40 + 2 * x41) + gamma_ddot * x21 + gamma_dot * (gamma_dot * (x7
            - x10 - x14) + x36 + x47) + slope * (gamma_dot * (gamma_dot * x22 * length - x35) + x16
            * x50 + x20 * x48 - x54) + slope_rate * (2 * x38 + x52) + slope_second_rate * x25 +
            third * (gamma_dot * (x24 * x35 - x37 * x22**3) - x22 * x55 + x24 * x54) - x44 - x45 -
            x46 + x56
        ),
        (
            psi_1_d1 * (gamma_ddot * x25 + gamma_dot * x39 + x56) + psi_1_d2 * (gamma_dot * x41 +
            gamma_dot * x42 + x55)
        ),
    )
