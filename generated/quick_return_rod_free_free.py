"""Quick-return mechanism, flexible rod in Buckens' frame, free-free modes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation free_free, flexible rod, any number of modes.
Equations: Beale & Scott (29)-(33); Beale & Scott (37)-(38); Beale & Scott (40)-(49).

The displacement across the mean direction is L sum f_i psi_i, with modes of unit square over unit
length; they are passed in at the place of the block, (crank cos(gamma - speed t) + frame
cos(gamma)) / length from the pin.  The foreshortening is L sum f_i f_j alpha_ij with alpha_ij' =
-psi_i' psi_j' / 2 and no mean, s from the middle.

Multipliers: force of the pin along and across the rod, force of the block, up to the signs that
the constraints give them.

Operations are those with 2 modes.

Cost per evaluation:
    constraints: 67 operations
    dynamics: 195 operations
    variations: 339 operations
Content hash 705e07ccda8307284216eb1d1ffa4dc0; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["constraints", "dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["rod"],"formulation":"free_free","mechanism":"quick_retu'
    'rn","modes":null,"outputs":[]}'
)
CONTENT = "705e07ccda8307284216eb1d1ffa4dc0"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "crank": ("m", "Length of the crank"),
    "frame": ("m", "Distance from the pin to the centre of the crank"),
    "length": ("m", "Length of the rod"),
    "bending_stiffness": ("N m^2", "Bending stiffness of the rod"),
    "mass_per_length": ("kg/m", "Mass per length of the rod"),
    "speed": ("rad/s", "Speed of the crank"),
    "R1": ("m", "Mean position of the rod along the frame"),
    "R2": ("m", "Mean position of the rod across the frame"),
    "gamma": ("rad", "Mean direction of the rod"),
    "f": ("", "Amplitudes of the modes, in lengths"),
    "t": ("s", "Time; the crank angle is speed t"),
    "psi": ("", "psi of the modes at the block"),
    "psi_d1": ("", "psi' of the modes at the block"),
    "psi_d2": ("", "psi'' of the modes at the block"),
    "psi_d3": ("", "psi''' of the modes at the block"),
    "left": ("", "psi of the modes at the pin"),
    "stiffness": ("", "Fourth powers of the modes' roots"),
    "inward": ("", "int s alpha_ij ds of pairs of modes"),
    "retreat": ("", "alpha_ij of pairs of modes at the pin"),
    "lam_1": ("", "Multiplier"),
    "lam_2": ("", "Multiplier"),
    "lam_3": ("", "Multiplier"),
}
PARAMETERS = ("crank", "frame", "length", "bending_stiffness", "mass_per_length", "speed")

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1", "constraints_2_1", "constraints_3_1", "jacobian_1_1", "jacobian_1_2",
        "jacobian_1_3", "jacobian_1_4", "jacobian_2_1", "jacobian_2_3", "jacobian_2_4",
        "jacobian_3_3", "jacobian_3_4",
    ),
    "dynamics": (
        "mass_1_1", "mass_3_3", "mass_4_4_identity", "rest_3_1", "rest_4_1", "jacobian_1_1",
        "jacobian_1_2", "jacobian_1_3", "jacobian_1_4", "jacobian_2_1", "jacobian_2_3",
        "jacobian_2_4", "jacobian_3_3", "jacobian_3_4", "velocity_rhs_3_1", "gamma_1_1",
        "gamma_2_1", "gamma_3_1",
    ),
    "variations": (
        "damping_3_3", "damping_3_4", "damping_4_3", "stiffness_1_3", "stiffness_2_3",
        "stiffness_3_3", "stiffness_3_4", "stiffness_4_3", "stiffness_4_4_identity",
        "stiffness_4_4_stiffness", "stiffness_4_4_inward", "stiffness_4_4_retreat",
        "jacobian_rate_1_1", "jacobian_rate_1_2", "jacobian_rate_1_3", "jacobian_rate_1_4",
        "jacobian_rate_2_1", "jacobian_rate_2_3", "jacobian_rate_3_3", "jacobian_rate_3_4",
        "jacobian_acceleration_1_1", "jacobian_acceleration_1_2", "jacobian_acceleration_1_3",
        "jacobian_acceleration_1_4", "jacobian_acceleration_2_1", "jacobian_acceleration_2_3",
        "jacobian_acceleration_3_3", "jacobian_acceleration_3_4",
    ),
}
COORDINATES = ("R1", "R2", "gamma", "f")
MULTIPLIERS = ("lam_1", "lam_2", "lam_3")
EXTERNAL = ("psi", "psi_d1", "psi_d2", "psi_d3")

# Coordinate that stands for one of each mode, and the numbers of modes and pairs.
MODES = ("f", ("left", "stiffness", "inward", "retreat"))

# Terms of the energies that may be left out, to the names of what then vanishes, or to the
# separated terms that go and those that come.
DROPS = {("tension",): ("inward", "retreat")}

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {
        "constraints": ((3, 1), ((0, 0, 0), (1, 0, 1), (2, 0, 2))),
        "jacobian": (
            (3, 4),
            (
                (0, 0, 3), (0, 1, 4), (0, 2, 5), (0, 3, 6), (1, 0, 7), (1, 1, 3), (1, 2, 8),
                (1, 3, 9), (2, 0, 7), (2, 1, 3), (2, 2, 10), (2, 3, 11),
            ),
        ),
    },
    "dynamics": {
        "mass": ((4, 4), ((0, 0, 0), (1, 1, 0), (2, 2, 1), (3, 3, 2, "identity"))),
        "rest": ((4, 1), ((2, 0, 3), (3, 0, 4))),
        "forces": ((4, 1), ()),
        "jacobian": (
            (3, 4),
            (
                (0, 0, 5), (0, 1, 6), (0, 2, 7), (0, 3, 8), (1, 0, 9), (1, 1, 5), (1, 2, 10),
                (1, 3, 11), (2, 0, 9), (2, 1, 5), (2, 2, 12), (2, 3, 13),
            ),
        ),
        "velocity_rhs": ((3, 1), ((2, 0, 14),)),
        "gamma": ((3, 1), ((0, 0, 15), (1, 0, 16), (2, 0, 17))),
    },
    "variations": {
        "damping": ((4, 4), ((2, 2, 0), (2, 3, 1), (3, 2, 2))),
        "stiffness": (
            (4, 4),
            (
                (0, 2, 3),
                (1, 2, 4),
                (2, 0, 3),
                (2, 1, 4),
                (2, 2, 5),
                (2, 3, 6),
                (3, 2, 7),
                (3, 3, 8, "identity"),
                (3, 3, 9, "stiffness"),
                (3, 3, 10, "inward"),
                (3, 3, 11, "retreat"),
            ),
        ),
        "jacobian_rate": (
            (3, 4),
            (
                (0, 0, 12), (0, 1, 13), (0, 2, 14), (0, 3, 15), (1, 0, 16), (1, 1, 12), (1, 2, 17),
                (2, 0, 16), (2, 1, 12), (2, 2, 18), (2, 3, 19),
            ),
        ),
        "jacobian_acceleration": (
            (3, 4),
            (
                (0, 0, 20), (0, 1, 21), (0, 2, 22), (0, 3, 23), (1, 0, 24), (1, 1, 20), (1, 2, 25),
                (2, 0, 24), (2, 1, 20), (2, 2, 26), (2, 3, 27),
            ),
        ),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def _sum(left, right):
    """Return the sum of products over the modes."""
    return sum([a * b for a, b in zip(left, right)])


def _product(matrix, vector):
    """Return a matrix of the modes times a vector."""
    return [_sum(row, vector) for row in matrix]


def constraints(
    R1, R2, gamma, f, t, psi, psi_d1, psi_d2, psi_d3, crank, frame, length, bending_stiffness,
    mass_per_length, speed, left, stiffness, inward, retreat,
):
    """Return the constraints and their Jacobian.

    R1, R2, gamma : float or ndarray, shape (...)
    f : sequence of N, each float or ndarray, shape (...)
    t : float or ndarray, shape (...)
    psi, psi_d1, psi_d2, psi_d3 : sequence of N, each float or ndarray, shape (...)
    crank, frame, length, bending_stiffness, mass_per_length, speed : float or ndarray
    left, stiffness : sequence of N floats
    inward, retreat : N by N floats
    Returns float or ndarray each.
    """
    xp = _namespace(R1)
    retreat_f = _product(retreat, f)
    f_retreat_f = _sum(f, retreat_f)
    f_left = _sum(f, left)
    f_psi = _sum(f, psi)
    f_psi_d1 = _sum(f, psi_d1)
    x0 = xp.cos(gamma)
    x1 = R1 * x0
    x2 = xp.sin(gamma)
    x3 = R2 * x2
    x4 = x1 + x3
    x5 = R1 * x2
    x6 = R2 * x0 - x5
    x7 = gamma - t * speed
    x8 = crank * xp.sin(x7)
    x9 = x2 * frame
    x10 = 1 / length
    return (
        length * f_retreat_f - length / 2 + x4, length * f_left + x6,
        length * f_psi + x6 + x8 + x9, x0, x2, R2 * x0 - x5,
        [2 * length * retreat_f_i for retreat_f_i in retreat_f], -x2, -x4,
        [length * left_i for left_i in left],
        crank * xp.cos(x7) + (-length * (x10 * x8 + x10 * x9) * f_psi_d1) + x0 * frame - x1 - x3,
        [length * psi_i for psi_i in psi],
    )


def dynamics(
    R1, R2, gamma, f, R1_dot, R2_dot, gamma_dot, f_dot, t, psi, psi_d1, psi_d2, psi_d3, crank,
    frame, length, bending_stiffness, mass_per_length, speed, left, stiffness, inward, retreat,
):
    """Return everything in the equations of motion at acceleration level.

    R1, R2, gamma : float or ndarray, shape (...)
    f : sequence of N, each float or ndarray, shape (...)
    R1_dot, R2_dot, gamma_dot : float or ndarray, shape (...)
    f_dot : sequence of N, each float or ndarray, shape (...)
    t : float or ndarray, shape (...)
    psi, psi_d1, psi_d2, psi_d3 : sequence of N, each float or ndarray, shape (...)
    crank, frame, length, bending_stiffness, mass_per_length, speed : float or ndarray
    left, stiffness : sequence of N floats
    inward, retreat : N by N floats
    Returns float or ndarray each.
    """
    xp = _namespace(R1)
    inward_f = _product(inward, f)
    f_inward_f = _sum(f, inward_f)
    f_f = _sum(f, f)
    f_dot_inward_f = _sum(f_dot, inward_f)
    f_f_dot = _sum(f, f_dot)
    retreat_f = _product(retreat, f)
    f_psi_d1 = _sum(f, psi_d1)
    retreat_f_dot = _product(retreat, f_dot)
    f_dot_retreat_f_dot = _sum(f_dot, retreat_f_dot)
    f_psi_d2 = _sum(f, psi_d2)
    f_dot_psi_d1 = _sum(f_dot, psi_d1)
    x0 = mass_per_length * length**3
    x1 = 2 * x0
    x2 = 1 / length
    x3 = gamma_dot**2
    x4 = xp.cos(gamma)
    x5 = xp.sin(gamma)
    x6 = R1 * x5
    x7 = R2 * x4
    x8 = x6 - x7
    x9 = 2 * length
    x10 = R1 * x4
    x11 = R2 * x5
    x12 = -x10 - x11
    x13 = x4 * frame
    x14 = gamma - t * speed
    x15 = xp.cos(x14)
    x16 = x15 * crank
    x17 = x5 * frame
    x18 = xp.sin(x14)
    x19 = x18 * crank
    x20 = -x17 * x2 - x19 * x2
    x21 = x19 * speed
    x22 = R2_dot * x4
    x23 = R1_dot * x4
    x24 = R2_dot * x5
    x25 = x23 + x24
    x26 = gamma_dot * x23 + gamma_dot * x24
    x27 = gamma_dot * x20
    x28 = x16 * speed
    x29 = speed**2
    x30 = gamma_dot * length
    return (
        length * mass_per_length, x0 * f_f + x1 * f_inward_f + x0 / 12, x0,
        4 * gamma_dot * x0 * f_dot_inward_f + gamma_dot * x1 * f_f_dot,
        (
            [x2 * f_i * stiffness_i * bending_stiffness - x0 * x3 * f_i - x1 * x3 * inward_f_i for
            f_i, inward_f_i, stiffness_i in zip(f, inward_f, stiffness)]
        ),
        x4, x5, -x8, [x9 * retreat_f_i for retreat_f_i in retreat_f], -x5, x12,
        [length * left_i for left_i in left], x20 * length * f_psi_d1 - x10 - x11 + x13 + x16,
        [length * psi_i for psi_i in psi], x15 * crank * speed - x21 * f_psi_d1,
        (
            R1_dot * gamma_dot * x5 - x9 * f_dot_retreat_f_dot - gamma_dot * x22 - gamma_dot *
            (gamma_dot * x12 - R1_dot * x5 + x22)
        ),
        (x25 - gamma_dot * x8) * gamma_dot + x26,
        (
            -(2 * x21 + x27 * x9) * f_dot_psi_d1 + (x15 * x29 * crank - gamma_dot * x28 - gamma_dot
            * (x28 + (-x30 * (x13 * x2 + x16 * x2)))) * f_psi_d1 + (-(x2 * x29 * x18**2 * crank**2
            + gamma_dot * (x30 * x20**2 + x20 * x21) + x21 * x27) * f_psi_d2) - gamma_dot * x21 -
            gamma_dot * (x18 * crank * speed + gamma_dot * (x6 - x17 - x19 - x7) - x25) + x19 * x29
            + x26
        ),
    )


def variations(
    R1, R2, gamma, f, R1_dot, R2_dot, gamma_dot, f_dot, R1_ddot, R2_ddot, gamma_ddot, f_ddot,
    lam_1, lam_2, lam_3, t, psi, psi_d1, psi_d2, psi_d3, crank, frame, length, bending_stiffness,
    mass_per_length, speed, left, stiffness, inward, retreat,
):
    """Return the arrays of the motion linearised about a given one.

    R1, R2, gamma : float or ndarray, shape (...)
    f : sequence of N, each float or ndarray, shape (...)
    R1_dot, R2_dot, gamma_dot : float or ndarray, shape (...)
    f_dot : sequence of N, each float or ndarray, shape (...)
    R1_ddot, R2_ddot, gamma_ddot : float or ndarray, shape (...)
    f_ddot : sequence of N, each float or ndarray, shape (...)
    lam_1, lam_2, lam_3, t : float or ndarray, shape (...)
    psi, psi_d1, psi_d2, psi_d3 : sequence of N, each float or ndarray, shape (...)
    crank, frame, length, bending_stiffness, mass_per_length, speed : float or ndarray
    left, stiffness : sequence of N floats
    inward, retreat : N by N floats
    Returns float or ndarray each.
    """
    xp = _namespace(R1)
    inward_f = _product(inward, f)
    f_dot_inward_f = _sum(f_dot, inward_f)
    f_f_dot = _sum(f, f_dot)
    f_psi_d1 = _sum(f, psi_d1)
    retreat_f_dot = _product(retreat, f_dot)
    f_psi_d2 = _sum(f, psi_d2)
    f_dot_psi_d1 = _sum(f_dot, psi_d1)
    inward_f_dot = _product(inward, f_dot)
    retreat_f_ddot = _product(retreat, f_ddot)
    f_psi_d3 = _sum(f, psi_d3)
    f_dot_psi_d2 = _sum(f_dot, psi_d2)
    f_ddot_psi_d1 = _sum(f_ddot, psi_d1)
    x0 = mass_per_length * length**3
    x1 = 4 * x0
    x2 = 2 * x0
    x3 = [x2 * f_i for f_i in f]
    x4 = [x1 * inward_f_i for inward_f_i in inward_f]
    x5 = [gamma_dot * x3_i + gamma_dot * x4_i for x3_i, x4_i in zip(x3, x4)]
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
    x28 = -x25 * length
    x29 = [-lam_3 * x28 * psi_d1_i for psi_d1_i in psi_d1]
    x30 = gamma_dot**2
    x31 = x0 * x30
    x32 = 2 * length
    x33 = gamma_dot * x6
    x34 = gamma_dot * x7
    x35 = R2_dot * x7
    x36 = R1_dot * x6
    x37 = R1_dot * x7
    x38 = R2_dot * x6
    x39 = gamma_dot * x9 - x37 - x38
    x40 = x23 * speed
    x41 = x17 * speed
    x42 = gamma_dot * length
    x43 = x19 * x42 + x41
    x44 = -x25 * x40
    x45 = x27 * x42 + x44
    x46 = gamma_ddot * x7 - x30 * x6
    x47 = R1_ddot * x7
    x48 = R2_ddot * x6
    x49 = R2_dot * x34
    x50 = x36 - x35
    x51 = 2 * x41
    x52 = gamma_dot * x32
    x53 = speed**2
    x54 = gamma_dot * x40
    x55 = gamma_ddot * length
    x56 = x12 * x53 * crank**2
    x57 = x17 * x53
    x58 = x19 * x40 - x25 * x51
    x59 = x56 * x22**2
    x60 = gamma_dot * x41 - x57
    return (
        x1 * f_dot_inward_f + x2 * f_f_dot, x5, [-x5_i for x5_i in x5],
        x6 * lam_1 + x7 * lam_2 + lam_3 * x7, x6 * lam_2 - x7 * lam_1 + lam_3 * x6,
        x10 * lam_1 - x19 * x20 * f_psi_d1 - x20 * x27 * f_psi_d2 - x9 * lam_2 - lam_3 * x24,
        (
            [gamma_dot * x2 * f_dot_i + gamma_ddot * x3_i + gamma_ddot * x4_i + gamma_dot * x1 *
            inward_f_dot_i + x29_i for x3_i, x4_i, x29_i, f_dot_i, inward_f_dot_i in zip(x3, x4,
            x29, f_dot, inward_f_dot)]
        ),
        x29, -x31, x12 * bending_stiffness, -2 * x31, -x32 * lam_1, -x33, x34,
        x35 - gamma_dot * x10 - x36, [x32 * retreat_f_dot_i for retreat_f_dot_i in retreat_f_dot],
        -x34, x39,
        x28 * f_dot_psi_d1 + x43 * f_psi_d1 + x45 * f_psi_d2 + gamma_dot * x24 - x37 - x38 + x40,
        [(x40 - x25 * x42) * psi_d1_i for psi_d1_i in psi_d1], -gamma_ddot * x6 - x30 * x7, x46,
        (
            R2_ddot * x7 - R1_ddot * x6 - R1_dot * x34 - R2_dot * x33 - gamma_ddot * x10 +
            gamma_dot * x39
        ),
        [x32 * retreat_f_ddot_i for retreat_f_ddot_i in retreat_f_ddot], -x46,
        (
            R1_dot * gamma_dot * x6 + gamma_ddot * x9 + gamma_dot * (gamma_dot * x10 + x50) - x47 -
            x48 - x49
        ),
        (
            R1_dot * x33 + x28 * f_ddot_psi_d1 + (x19 * x52 + x51) * f_dot_psi_d1 + (x27 * x52 + 2
            * x44) * f_dot_psi_d2 + (gamma_dot * (gamma_dot * x25 * length - x40) + x19 * x55 + x23
            * x53 - x54) * f_psi_d1 + (gamma_dot * x58 + gamma_dot * (gamma_dot * (x19 * x28 +
            (-x28 * (2 * x14 + 2 * x18))) + x58) + 2 * x16 * x22 * x56 + x25 * x57 + x27 * x55) *
            f_psi_d2 + (gamma_dot * (x27 * x40 - x42 * x25**3) - x25 * x59 + x27 * x54) * f_psi_d3
            + gamma_ddot * x24 + gamma_dot * (gamma_dot * (x10 - x13 - x17) + x41 + x50) - x47 -
            x48 - x49 + x60
        ),
        (
            [(gamma_ddot * x28 + gamma_dot * x43 + x60) * psi_d1_i + (gamma_dot * x44 + gamma_dot *
            x45 + x59) * psi_d2_i for psi_d1_i, psi_d2_i in zip(psi_d1, psi_d2)]
        ),
    )
