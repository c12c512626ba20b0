"""Quick-return mechanism, flexible rod in Buckens' frame, 2 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 2 modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 72 operations
    dynamics: 179 operations
    variations: 305 operations
Content hash 9bb48f69b4c06d3acf694e7d8a943b72; derived with SymPy 1.14.0.
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
    'rn","modes":2,"outputs":[]}'
)
CONTENT = "9bb48f69b4c06d3acf694e7d8a943b72"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    5), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (0, 4, 7), (1, 0, 8), (1, 1, 3), (1, 2, 9),
    (1, 3, 10), (1, 4, 11), (2, 0, 8), (2, 1, 3), (2, 2, 12), (2, 3, 13), (2, 4, 14),))},
    'dynamics': {'mass': ((5, 5), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4, 2),)),
    'rest': ((5, 1), ((2, 0, 3), (3, 0, 4), (4, 0, 5),)), 'forces': ((5, 1), ()), 'jacobian': ((3,
    5), ((0, 0, 6), (0, 1, 7), (0, 2, 8), (0, 3, 9), (0, 4, 10), (1, 0, 11), (1, 1, 6), (1, 2, 12),
    (1, 3, 13), (1, 4, 14), (2, 0, 11), (2, 1, 6), (2, 2, 15), (2, 3, 16), (2, 4, 17),)),
    'velocity_rhs': ((3, 1), ((2, 0, 18),)), 'gamma': ((3, 1), ((0, 0, 19), (1, 0, 20), (2, 0,
    21),))}, 'variations': {'damping': ((5, 5), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (3, 2, 3), (4, 2,
    4),)), 'stiffness': ((5, 5), ((0, 2, 5), (1, 2, 6), (2, 0, 5), (2, 1, 6), (2, 2, 7), (2, 3, 8),
    (2, 4, 9), (3, 2, 10), (3, 3, 11), (3, 4, 12), (4, 2, 13), (4, 3, 12), (4, 4, 14),)),
    'jacobian_rate': ((3, 5), ((0, 0, 15), (0, 1, 16), (0, 2, 17), (0, 3, 18), (0, 4, 19), (1, 0,
    20), (1, 1, 15), (1, 2, 21), (2, 0, 20), (2, 1, 15), (2, 2, 22), (2, 3, 23), (2, 4, 24),)),
    'jacobian_acceleration': ((3, 5), ((0, 0, 25), (0, 1, 26), (0, 2, 27), (0, 3, 28), (0, 4, 29),
    (1, 0, 30), (1, 1, 25), (1, 2, 31), (2, 0, 30), (2, 1, 25), (2, 2, 32), (2, 3, 33), (2, 4,
    34),))}}
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
        "jacobian_1_4",
        "jacobian_1_5",
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
        "stiffness_4_5",
        "stiffness_5_3",
        "stiffness_5_5",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_1_4",
        "jacobian_rate_1_5",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4",
        "jacobian_acceleration_1_5",
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
    jacobian_1_4 : float or ndarray
        Entry of jacobian.
    jacobian_1_5 : float or ndarray
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
    x0 = f1 * length
    x1 = 22.226509490533974 * x0
    x2 = xp.cos(gamma)
    x3 = R1 * x2
    x4 = xp.sin(gamma)
    x5 = R2 * x4
    x6 = x3 + x5
    x7 = 2 * length
    x8 = R1 * x4
    x9 = x8 - R2 * x2
    x10 = x4 * frame
    x11 = gamma - t * speed
    x12 = crank * xp.sin(x11)
    x13 = 1 / length
    return (
        (
            12.370205669468392 * length * f1**2 + 27.23114806299836 * length * f2**2 - f2 * x1 -
            length / 2 + x6
        ),
        2 * f1 * length - f2 * x7 - x9,
        R2 * x2 + value * length + x10 + x12 - x8,
        x2,
        x4,
        -x9,
        24.740411338936784 * x0 - 22.226509490533974 * f2 * length,
        54.46229612599672 * f2 * length - x1,
        -x4,
        -x6,
        x7,
        -x7,
        crank * xp.cos(x11) + x2 * frame + (-slope * length * (x10 * x13 + x12 * x13)) - x3 - x5,
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
    jacobian_1_4 : float or ndarray
        Entry of jacobian.
    jacobian_1_5 : float or ndarray
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
    x0 = length**3
    x1 = x0 * mass_per_length
    x2 = 2.0497641363910746 * x1
    x3 = 5.3973948475526035 * x1
    x4 = gamma_dot * x1
    x5 = 1 / length
    x6 = x5 * bending_stiffness
    x7 = gamma_dot**2
    x8 = xp.cos(gamma)
    x9 = xp.sin(gamma)
    x10 = R1 * x9
    x11 = R2 * x8
    x12 = x10 - x11
    x13 = f1 * length
    x14 = R1 * x8
    x15 = R2 * x9
    x16 = -x14 - x15
    x17 = 2 * length
    x18 = x8 * frame
    x19 = gamma - t * speed
    x20 = xp.cos(x19)
    x21 = x20 * crank
    x22 = x9 * frame
    x23 = xp.sin(x19)
    x24 = x23 * crank
    x25 = -x22 * x5 - x24 * x5
    x26 = x24 * speed
    x27 = R2_dot * x8
    x28 = f1_dot * length
    x29 = R1_dot * x8
    x30 = R2_dot * x9
    x31 = x29 + x30
    x32 = gamma_dot * x29 + gamma_dot * x30
    x33 = speed**2
    x34 = x25 * x26
    x35 = gamma_dot * length
    x36 = x21 * speed
    return (
        length * mass_per_length,
        x0 * mass_per_length / 12 - x2 * f1**2 - x3 * f2**2,
        x1,
        -4.099528272782149 * f1 * f1_dot * x4 - 10.794789695105207 * f2 * f2_dot * x4,
        f1 * x2 * x7 + 500.5639017404326 * f1 * x6,
        f2 * x3 * x7 + 3803.5370804978666 * f2 * x6,
        x8,
        x9,
        -x12,
        24.740411338936784 * x13 - 22.226509490533974 * f2 * length,
        54.46229612599672 * f2 * length - 22.226509490533974 * x13,
        -x9,
        x16,
        x17,
        -x17,
        slope * x25 * length - x14 - x15 + x18 + x21,
        length * psi_1,
        length * psi_2,
        x20 * crank * speed - slope * x26,
        (
            R1_dot * gamma_dot * x9 - f1_dot * (24.740411338936784 * x28 - 22.226509490533974 *
            f2_dot * length) - f2_dot * (54.46229612599672 * f2_dot * length - 22.226509490533974 *
            x28) - gamma_dot * x27 - gamma_dot * (gamma_dot * x16 - R1_dot * x9 + x27)
        ),
        (x31 - gamma_dot * x12) * gamma_dot + x32,
        (
            -curvature * (x33 * x5 * x23**2 * crank**2 + gamma_dot * x34 + gamma_dot * (x35 *
            x25**2 + x34)) - gamma_dot * x26 - gamma_dot * (x23 * crank * speed + gamma_dot * (x10
            - x11 - x22 - x24) - x31) + slope * (x20 * x33 * crank - gamma_dot * x36 - gamma_dot *
            (-x35 * (x18 * x5 + x21 * x5) + x36)) + (-slope_rate * (gamma_dot * x17 * x25 + 2 *
            x26)) + x24 * x33 + x32
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
    stiffness_4_5 : float or ndarray
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
    jacobian_rate_1_4 : float or ndarray
        Entry of jacobian_rate.
    jacobian_rate_1_5 : float or ndarray
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
    jacobian_acceleration_1_4 : float or ndarray
        Entry of jacobian_acceleration.
    jacobian_acceleration_1_5 : float or ndarray
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
    x1 = 4.099528272782149 * f1 * x0
    x2 = 10.794789695105207 * f2 * x0
    x3 = gamma_dot * x1
    x4 = gamma_dot * x2
    x5 = xp.sin(gamma)
    x6 = xp.cos(gamma)
    x7 = R2 * x6
    x8 = R1 * x5 - x7
    x9 = R1 * x6 + R2 * x5
    x11 = 1 / length
    x12 = x6 * frame
    x13 = x11 * x12
    x14 = gamma - t * speed
    x15 = xp.cos(x14)
    x16 = x15 * crank
    x17 = x11 * x16
    x18 = -x13 - x17
    x19 = lam_3 * length
    x20 = x5 * frame
    x21 = xp.sin(x14)
    x22 = x21 * crank
    x23 = R1 * x5 - x20 - x22 - x7
    x24 = x11 * x20 + x11 * x22
    x26 = x24**2
    x27 = gamma_dot * x0
    x28 = -x24 * length
    x29 = lam_3 * x28
    x30 = psi_1_d1 * x29
    x31 = psi_2_d1 * x29
    x32 = lam_1 * length
    x33 = x11 * bending_stiffness
    x34 = gamma_dot**2
    x35 = x0 * x34
    x36 = gamma_dot * x5
    x37 = gamma_dot * x6
    x38 = R2_dot * x6
    x39 = R1_dot * x5
    x40 = f1_dot * length
    x41 = R1_dot * x6
    x42 = R2_dot * x5
    x43 = gamma_dot * x8 - x41 - x42
    x44 = x22 * speed
    x45 = x16 * speed
    x46 = gamma_dot * length
    x47 = x18 * x46
    x48 = x45 + x47
    x49 = x26 * x46
    x50 = -x24 * x44
    x51 = x49 + x50
    x52 = x44 - x24 * x46
    x53 = gamma_ddot * x6 - x34 * x5
    x54 = f1_ddot * length
    x55 = R1_ddot * x6
    x56 = R2_ddot * x5
    x57 = R2_dot * x37
    x58 = x39 - x38
    x59 = speed**2
    x60 = x11 * x59 * crank**2
    x61 = gamma_ddot * length
    x62 = x16 * x59
    x63 = 2 * x45
    x64 = x18 * x44 - x24 * x63
    x65 = gamma_dot * x44
    x66 = x60 * x21**2
    x67 = gamma_dot * x45 - x62
    x68 = gamma_ddot * x28 + gamma_dot * x48 + x67
    x69 = gamma_dot * x50 + gamma_dot * x51 + x66
    return (
        -f1_dot * x1 - f2_dot * x2,
        -x3,
        -x4,
        x3,
        x4,
        lam_1 * x5 + x6 * lam_2 + lam_3 * x6,
        x5 * lam_2 - lam_1 * x6 + lam_3 * x5,
        lam_1 * x9 - curvature * x19 * x26 - x8 * lam_2 - lam_3 * x23 - slope * x18 * x19,
        -4.099528272782149 * f1_dot * x27 - gamma_ddot * x1 - x30,
        -10.794789695105207 * f2_dot * x27 - gamma_ddot * x2 - x31,
        -x30,
        500.5639017404326 * x33 - 24.740411338936784 * x32 + 2.0497641363910746 * x35,
        22.226509490533974 * x32,
        -x31,
        3803.5370804978666 * x33 - 54.46229612599672 * x32 + 5.3973948475526035 * x35,
        -x36,
        x37,
        x38 - gamma_dot * x9 - x39,
        24.740411338936784 * x40 - 22.226509490533974 * f2_dot * length,
        54.46229612599672 * f2_dot * length - 22.226509490533974 * x40,
        -x37,
        x43,
        curvature * x51 + gamma_dot * x23 + slope * x48 + slope_rate * x28 - x41 - x42 + x44,
        psi_1_d1 * x52,
        psi_2_d1 * x52,
        -gamma_ddot * x5 - x34 * x6,
        x53,
        (
            R2_ddot * x6 - R1_ddot * x5 - R1_dot * x37 - R2_dot * x36 - gamma_ddot * x9 + gamma_dot
            * x43
        ),
        24.740411338936784 * x54 - 22.226509490533974 * f2_ddot * length,
        54.46229612599672 * f2_ddot * length - 22.226509490533974 * x54,
        -x53,
        (
            R1_dot * gamma_dot * x5 + gamma_ddot * x8 + gamma_dot * (gamma_dot * x9 + x58) - x55 -
            x56 - x57
        ),
        (
            R1_dot * x36 + curvature * (gamma_dot * x64 + gamma_dot * (gamma_dot * (x18 * x28 +
            (-x28 * (2 * x13 + 2 * x17))) + x64) + 2 * x15 * x21 * x60 + x24 * x62 + x26 * x61) +
            curvature_rate * (2 * x49 + 2 * x50) + gamma_ddot * x23 + gamma_dot * (gamma_dot * (x9
            - x12 - x16) + x45 + x58) + slope * (gamma_dot * (gamma_dot * x24 * length - x44) + x18
            * x61 + x22 * x59 - x65) + slope_rate * (2 * x47 + x63) + slope_second_rate * x28 +
            third * (gamma_dot * (x26 * x44 - x46 * x24**3) - x24 * x66 + x26 * x65) - x55 - x56 -
            x57 + x67
        ),
        psi_1_d1 * x68 + psi_1_d2 * x69,
        psi_2_d1 * x68 + psi_2_d2 * x69,
    )
