"""Quick-return mechanism, flexible rod in Buckens' frame, 4 free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, 4 modes, without tension.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Cost per evaluation:
    constraints: 68 operations
    dynamics: 185 operations
    variations: 332 operations
Content hash f2a7364a4d10ac079e6508b4f2301c08; derived with SymPy 1.14.0.
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
    'uick_return","modes":4,"outputs":[]}'
)
CONTENT = "f2a7364a4d10ac079e6508b4f2301c08"
COORDINATES = ('R1', 'R2', 'gamma', 'f1', 'f2', 'f3', 'f4')
MULTIPLIERS = ('lam_1', 'lam_2', 'lam_3')
EXTERNAL = (
    ('psi_1', 'psi_1_d1', 'psi_1_d2', 'psi_1_d3', 'psi_2', 'psi_2_d1', 'psi_2_d2', 'psi_2_d3',
    'psi_3', 'psi_3_d1', 'psi_3_d2', 'psi_3_d3', 'psi_4', 'psi_4_d1', 'psi_4_d2', 'psi_4_d3')
)
ARRAYS = (
    {'constraints': {'constraints': ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2),)), 'jacobian': ((3,
    7), ((0, 0, 3), (0, 1, 4), (0, 2, 5), (1, 0, 6), (1, 1, 3), (1, 2, 7), (1, 3, 8), (1, 4, 9),
    (1, 5, 8), (1, 6, 9), (2, 0, 6), (2, 1, 3), (2, 2, 10), (2, 3, 11), (2, 4, 12), (2, 5, 13), (2,
    6, 14),))}, 'dynamics': {'mass': ((7, 7), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2), (4, 4,
    2), (5, 5, 2), (6, 6, 2),)), 'rest': ((7, 1), ((2, 0, 3), (3, 0, 4), (4, 0, 5), (5, 0, 6), (6,
    0, 7),)), 'forces': ((7, 1), ()), 'jacobian': ((3, 7), ((0, 0, 8), (0, 1, 9), (0, 2, 10), (1,
    0, 11), (1, 1, 8), (1, 2, 12), (1, 3, 13), (1, 4, 14), (1, 5, 13), (1, 6, 14), (2, 0, 11), (2,
    1, 8), (2, 2, 15), (2, 3, 16), (2, 4, 17), (2, 5, 18), (2, 6, 19),)), 'velocity_rhs': ((3, 1),
    ((2, 0, 20),)), 'gamma': ((3, 1), ((0, 0, 21), (1, 0, 22), (2, 0, 23),))}, 'variations':
    {'damping': ((7, 7), ((2, 2, 0), (2, 3, 1), (2, 4, 2), (2, 5, 3), (2, 6, 4), (3, 2, 5), (4, 2,
    6), (5, 2, 7), (6, 2, 8),)), 'stiffness': ((7, 7), ((0, 2, 9), (1, 2, 10), (2, 0, 9), (2, 1,
    10), (2, 2, 11), (2, 3, 12), (2, 4, 13), (2, 5, 14), (2, 6, 15), (3, 2, 16), (3, 3, 17), (4, 2,
    18), (4, 4, 19), (5, 2, 20), (5, 5, 21), (6, 2, 22), (6, 6, 23),)), 'jacobian_rate': ((3, 7),
    ((0, 0, 24), (0, 1, 25), (0, 2, 26), (1, 0, 27), (1, 1, 24), (1, 2, 28), (2, 0, 27), (2, 1,
    24), (2, 2, 29), (2, 3, 30), (2, 4, 31), (2, 5, 32), (2, 6, 33),)), 'jacobian_acceleration':
    ((3, 7), ((0, 0, 34), (0, 1, 35), (0, 2, 36), (1, 0, 37), (1, 1, 34), (1, 2, 38), (2, 0, 37),
    (2, 1, 34), (2, 2, 39), (2, 3, 40), (2, 4, 41), (2, 5, 42), (2, 6, 43),))}}
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
        "stiffness_5_3",
        "stiffness_5_5",
        "stiffness_6_3",
        "stiffness_6_6",
        "stiffness_7_3",
        "stiffness_7_7",
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
        2 * f1 * length - f2 * x5 + 2 * f3 * length - f4 * x5 - x7,
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
        x0 * f1**2 + x0 * f2**2 + x0 * f3**2 + x0 * f4**2 + x0 / 12,
        x0,
        f1 * f1_dot * x1 + f2 * f2_dot * x1 + f3 * f3_dot * x1 + f4 * f4_dot * x1,
        500.5639017404326 * f1 * x3 - f1 * x4,
        3803.5370804978666 * f2 * x3 - f2 * x4,
        14617.630131122343 * f3 * x3 - f3 * x4,
        39943.799005709305 * f4 * x3 - f4 * x4,
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
    x0 = mass_per_length * length**3
    x1 = 2 * x0
    x2 = f1 * x1
    x3 = f2 * x1
    x4 = f3 * x1
    x5 = f4 * x1
    x6 = gamma_dot * x2
    x7 = gamma_dot * x3
    x8 = gamma_dot * x4
    x9 = gamma_dot * x5
    x10 = xp.sin(gamma)
    x11 = xp.cos(gamma)
    x12 = R2 * x11
    x13 = R1 * x10 - x12
    x14 = R1 * x11 + R2 * x10
    x16 = 1 / length
    x17 = x11 * frame
    x18 = x16 * x17
    x19 = gamma - t * speed
    x20 = xp.cos(x19)
    x21 = x20 * crank
    x22 = x16 * x21
    x23 = -x18 - x22
    x24 = lam_3 * length
    x25 = x10 * frame
    x26 = xp.sin(x19)
    x27 = x26 * crank
    x28 = R1 * x10 - x12 - x25 - x27
    x29 = x16 * x25 + x16 * x27
    x31 = x29**2
    x32 = gamma_dot * x1
    x33 = -x29 * length
    x34 = lam_3 * x33
    x35 = -psi_1_d1 * x34
    x36 = -psi_2_d1 * x34
    x37 = -psi_3_d1 * x34
    x38 = -psi_4_d1 * x34
    x39 = x16 * bending_stiffness
    x40 = gamma_dot**2
    x41 = -x0 * x40
    x42 = gamma_dot * x10
    x43 = gamma_dot * x11
    x44 = R2_dot * x11
    x45 = R1_dot * x10
    x46 = R1_dot * x11
    x47 = R2_dot * x10
    x48 = gamma_dot * x13 - x46 - x47
    x49 = x27 * speed
    x50 = x21 * speed
    x51 = gamma_dot * length
    x52 = x23 * x51
    x53 = x50 + x52
    x54 = x31 * x51
    x55 = -x29 * x49
    x56 = x54 + x55
    x57 = x49 - x29 * x51
    x58 = gamma_ddot * x11 - x10 * x40
    x59 = R1_ddot * x11
    x60 = R2_ddot * x10
    x61 = R2_dot * x43
    x62 = x45 - x44
    x63 = speed**2
    x64 = x16 * x63 * crank**2
    x65 = gamma_ddot * length
    x66 = x21 * x63
    x67 = 2 * x50
    x68 = x23 * x49 - x29 * x67
    x69 = gamma_dot * x49
    x70 = x64 * x26**2
    x71 = gamma_dot * x50 - x66
    x72 = gamma_ddot * x33 + gamma_dot * x53 + x71
    x73 = gamma_dot * x55 + gamma_dot * x56 + x70
    return (
        f1_dot * x2 + f2_dot * x3 + f3_dot * x4 + f4_dot * x5,
        x6,
        x7,
        x8,
        x9,
        -x6,
        -x7,
        -x8,
        -x9,
        x10 * lam_1 + x11 * lam_2 + lam_3 * x11,
        x10 * lam_2 - x11 * lam_1 + lam_3 * x10,
        x14 * lam_1 - curvature * x24 * x31 - x13 * lam_2 - lam_3 * x28 - slope * x23 * x24,
        f1_dot * x32 + gamma_ddot * x2 + x35,
        f2_dot * x32 + gamma_ddot * x3 + x36,
        f3_dot * x32 + gamma_ddot * x4 + x37,
        f4_dot * x32 + gamma_ddot * x5 + x38,
        x35,
        500.5639017404326 * x39 + x41,
        x36,
        3803.5370804978666 * x39 + x41,
        x37,
        14617.630131122343 * x39 + x41,
        x38,
        39943.799005709305 * x39 + x41,
        -x42,
        x43,
        x44 - gamma_dot * x14 - x45,
        -x43,
        x48,
        curvature * x56 + gamma_dot * x28 + slope * x53 + slope_rate * x33 - x46 - x47 + x49,
        psi_1_d1 * x57,
        psi_2_d1 * x57,
        psi_3_d1 * x57,
        psi_4_d1 * x57,
        -gamma_ddot * x10 - x11 * x40,
        x58,
        (
            R2_ddot * x11 - R1_ddot * x10 - R1_dot * x43 - R2_dot * x42 - gamma_ddot * x14 +
            gamma_dot * x48
        ),
        -x58,
        (
            R1_dot * gamma_dot * x10 + gamma_ddot * x13 + gamma_dot * (gamma_dot * x14 + x62) - x59
            - x60 - x61
        ),
        (
            R1_dot * x42 + curvature * (gamma_dot * x68 + gamma_dot * (gamma_dot * (x23 * x33 +
            (-x33 * (2 * x18 + 2 * x22))) + x68) + 2 * x20 * x26 * x64 + x29 * x66 + x31 * x65) +
            curvature_rate * (2 * x54 + 2 * x55) + gamma_ddot * x28 + gamma_dot * (gamma_dot * (x14
            - x17 - x21) + x50 + x62) + slope * (gamma_dot * (gamma_dot * x29 * length - x49) + x23
            * x65 + x27 * x63 - x69) + slope_rate * (2 * x52 + x67) + slope_second_rate * x33 +
            third * (gamma_dot * (x31 * x49 - x51 * x29**3) - x29 * x70 + x31 * x69) - x59 - x60 -
            x61 + x71
        ),
        psi_1_d1 * x72 + psi_1_d2 * x73,
        psi_2_d1 * x72 + psi_2_d2 * x73,
        psi_3_d1 * x72 + psi_3_d2 * x73,
        psi_4_d1 * x72 + psi_4_d2 * x73,
    )
