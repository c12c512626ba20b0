"""Quick-return mechanism, flexible rod in Buckens' frame, 3 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 3 modes, without tension.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 58 operations
    dynamics: 168 operations
    variations: 303 operations
Content hash e66879671d0e3a1ea46a3fd549287398; derived with SymPy 1.14.0.
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
    'uick_return","modes":3,"outputs":[]}'
)
CONTENT = "e66879671d0e3a1ea46a3fd549287398"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    6), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (1, 0, 6), (1, 1, 3), (1, 2, 7), (1, 3, 8), (1, 4, 9),
    (1, 5, 8), (2, 0, 6), (2, 1, 3), (2, 2, 10), (2, 3, 11), (2, 4, 12), (2, 5, 13),))},
    'dynamics': {'mass': ((6, 6), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4, 2), (5, 5,
    2),)), 'rest': ((6, 1), ((2, 0, 3), (3, 0, 4), (4, 0, 5), (5, 0, 6),)), 'forces': ((6, 1), ()),
    'jacobian': ((3, 6), ((0, 0, 7), (0, 1, 8), (0, 2, 9), (1, 0, 10), (1, 1, 7), (1, 2, 11), (1,
    3, 12), (1, 4, 13), (1, 5, 12), (2, 0, 10), (2, 1, 7), (2, 2, 14), (2, 3, 15), (2, 4, 16), (2,
    5, 17),)), 'velocity_rhs': ((3, 1), ((2, 0, 18),)), 'gamma': ((3, 1), ((0, 0, 19), (1, 0, 20),
    (2, 0, 21),))}, 'variations': {'damping': ((6, 6), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (2, 5, 3),
    (3, 2, 4), (4, 2, 5), (5, 2, 6),)), 'stiffness': ((6, 6), ((0, 2, 7), (1, 2, 8), (2, 0, 7), (2,
    1, 8), (2, 2, 9), (2, 3, 10), (2, 4, 11), (2, 5, 12), (3, 2, 13), (3, 3, 14), (4, 2, 15), (4,
    4, 16), (5, 2, 17), (5, 5, 18),)), 'jacobian_rate': ((3, 6), ((0, 0, 19), (0, 1, 20), (0, 2,
    21), (1, 0, 22), (1, 1, 19), (1, 2, 23), (2, 0, 22), (2, 1, 19), (2, 2, 24), (2, 3, 25), (2, 4,
    26), (2, 5, 27),)), 'jacobian_acceleration': ((3, 6), ((0, 0, 28), (0, 1, 29), (0, 2, 30), (1,
    0, 31), (1, 1, 28), (1, 2, 32), (2, 0, 31), (2, 1, 28), (2, 2, 33), (2, 3, 34), (2, 4, 35), (2,
    5, 36),))}}
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
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_6_3",
        "stiffness_6_6",
        "jacobian_rate_1_1",
        "jacobian_rate_1_2",
        "jacobian_rate_1_3",
        "jacobian_rate_2_1",
        "jacobian_rate_2_3",
        "jacobian_rate_3_3",
        "jacobian_rate_3_4",
        "jacobian_rate_3_5",
        "jacobian_rate_3_6",
        "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2",
        "jacobian_acceleration_1_3",
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
        f1 * x5 - f2 * x5 + f3 * x5 + x7,
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
        x0 * f1**2 + x0 * f2**2 + x0 * f3**2 + x0 / 12,
        x0,
        f1 * f1_dot * x1 + f2 * f2_dot * x1 + f3 * f3_dot * x1,
        500.5639017404326 * f1 * x3 - f1 * x4,
        3803.5370804978666 * f2 * x3 - f2 * x4,
        14617.630131122343 * f3 * x3 - f3 * x4,
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
    stiffness_5_3 : float or ndarray
        Entry of stiffness.
    stiffness_5_5 : float or ndarray
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
    x0 = mass_per_length * length**3
    x1 = 2 * x0
    x2 = f1 * x1
    x3 = f2 * x1
    x4 = f3 * x1
    x5 = gamma_dot * x2
    x6 = gamma_dot * x3
    x7 = gamma_dot * x4
    x8 = xp.sin(gamma)
    x9 = xp.cos(gamma)
    x10 = R2 * x9
    x11 = R1 * x8 - x10
    x12 = R1 * x9 + R2 * x8
    x14 = 1 / length
    x15 = x9 * frame
    x16 = x14 * x15
    x17 = gamma - t * speed
    x18 = xp.cos(x17)
    x19 = x18 * crank
    x20 = x14 * x19
    x21 = -x16 - x20
    x22 = lam_3 * length
    x23 = x8 * frame
    x24 = xp.sin(x17)
    x25 = x24 * crank
    x26 = R1 * x8 - x10 - x23 - x25
    x27 = x14 * x23 + x14 * x25
    x29 = x27**2
    x30 = gamma_dot * x1
    x31 = -x27 * length
    x32 = lam_3 * x31
    x33 = -psi_1_d1 * x32
    x34 = -psi_2_d1 * x32
    x35 = -psi_3_d1 * x32
    x36 = x14 * bending_stiffness
    x37 = gamma_dot**2
    x38 = -x0 * x37
    x39 = gamma_dot * x8
    x40 = gamma_dot * x9
    x41 = R2_dot * x9
    x42 = R1_dot * x8
    x43 = R1_dot * x9
    x44 = R2_dot * x8
    x45 = gamma_dot * x11 - x43 - x44
    x46 = x25 * speed
    x47 = x19 * speed
    x48 = gamma_dot * length
    x49 = x21 * x48
    x50 = x47 + x49
    x51 = x29 * x48
    x52 = -x27 * x46
    x53 = x51 + x52
    x54 = x46 - x27 * x48
    x55 = gamma_ddot * x9 - x37 * x8
    x56 = R1_ddot * x9
    x57 = R2_ddot * x8
    x58 = R2_dot * x40
    x59 = x42 - x41
    x60 = speed**2
    x61 = x14 * x60 * crank**2
    x62 = gamma_ddot * length
    x63 = x19 * x60
    x64 = 2 * x47
    x65 = x21 * x46 - x27 * x64
    x66 = gamma_dot * x46
    x67 = x61 * x24**2
    x68 = gamma_dot * x47 - x63
    x69 = gamma_ddot * x31 + gamma_dot * x50 + x68
    x70 = gamma_dot * x52 + gamma_dot * x53 + x67
    return (
        f1_dot * x2 + f2_dot * x3 + f3_dot * x4,
        x5,
        x6,
        x7,
        -x5,
        -x6,
        -x7,
        x8 * lam_1 + x9 * lam_2 + lam_3 * x9,
        x8 * lam_2 - x9 * lam_1 + lam_3 * x8,
        x12 * lam_1 - curvature * x22 * x29 - x11 * lam_2 - lam_3 * x26 - slope * x21 * x22,
        f1_dot * x30 + gamma_ddot * x2 + x33,
        f2_dot * x30 + gamma_ddot * x3 + x34,
        f3_dot * x30 + gamma_ddot * x4 + x35,
        x33,
        500.5639017404326 * x36 + x38,
        x34,
        3803.5370804978666 * x36 + x38,
        x35,
        14617.630131122343 * x36 + x38,
        -x39,
        x40,
        x41 - gamma_dot * x12 - x42,
        -x40,
        x45,
        curvature * x53 + gamma_dot * x26 + slope * x50 + slope_rate * x31 - x43 - x44 + x46,
        psi_1_d1 * x54,
        psi_2_d1 * x54,
        psi_3_d1 * x54,
        -gamma_ddot * x8 - x37 * x9,
        x55,
        (
            R2_ddot * x9 - R1_ddot * x8 - R1_dot * x40 - R2_dot * x39 - gamma_ddot * x12 +
            gamma_dot * x45
        ),
        -x55,
        (
            R1_dot * gamma_dot * x8 + gamma_ddot * x11 + gamma_dot * (gamma_dot * x12 + x59) - x56
            - x57 - x58
        ),
        (
            R1_dot * x39 + curvature * (gamma_dot * x65 + gamma_dot * (gamma_dot * (x21 * x31 +
            (-x31 * (2 * x16 + 2 * x20))) + x65) + 2 * x18 * x24 * x61 + x27 * x63 + x29 * x62) +
            curvature_rate * (2 * x51 + 2 * x52) + gamma_ddot * x26 + gamma_dot * (gamma_dot * (x12
            - x15 - x19) + x47 + x59) + slope * (gamma_dot * (gamma_dot * x27 * length - x46) + x21
            * x62 + x25 * x60 - x66) + slope_rate * (2 * x49 + x64) + slope_second_rate * x31 +
            third * (gamma_dot * (x29 * x46 - x48 * x27**3) - x27 * x67 + x29 * x66) - x56 - x57 -
            x58 + x68
        ),
        psi_1_d1 * x69 + psi_1_d2 * x70,
        psi_2_d1 * x69 + psi_2_d2 * x70,
        psi_3_d1 * x69 + psi_3_d2 * x70,
    )
