"""Inextensible flexible coupler of a four-bar linkage, geometrically exact.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation inextensible, flexible coupler, any number of modes.
Equations: Smith 9.6, further work 2.

The coupler's points are r(s) = B + coupler int (cos phi, sin phi) ds.  Arrays with a value at each
of the Q stations have them on their first axis, all others one value there.

Multipliers: force on C along x and y, up to its sign.

Cost per evaluation:
    constraints: 25 operations
    dynamics: 76 operations
    variations: 92 operations
Content hash 6339df8380661245913139f5ebaf53d8; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["constraints", "dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible","mechanism":"fou'
    'r_bar","modes":null,"outputs":[]}'
)
CONTENT = "6339df8380661245913139f5ebaf53d8"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "frame": ("m", "Length of the frame"),
    "crank": ("m", "Length of the crank"),
    "coupler": ("m", "Length of the coupler"),
    "follower": ("m", "Length of the follower"),
    "bending_stiffness": ("N m^2", "EI of the coupler"),
    "mass_per_length": ("kg/m", "mu of the coupler"),
    "damping": ("N s/m^2", "Viscous damping of the coupler per length"),
    "gravity_x": ("m/s^2", "Acceleration of gravity along x"),
    "gravity_y": ("m/s^2", "Acceleration of gravity along y"),
    "follower_inertia": ("kg m^2", "I4 of the follower about D"),
    "follower_first_moment": ("kg m", "m4 r4 of the follower about D"),
    "psi": ("rad", "Follower angle"),
    "phi": ("rad", "Angle of the coupler's tangent at the stations"),
    "t": ("s", "Time"),
    "theta": ("rad", "Crank angle"),
    "theta_d1": ("rad/s", "Crank speed"),
    "theta_d2": ("rad/s^2", "Crank acceleration"),
    "end": ("", "Weights of int f ds along the coupler, of unit length"),
    "moment": ("", "Weights of int (1 - s) f ds"),
    "bow": ("rad", "Angle of the unloaded coupler's tangent"),
    "inertia": ("", "int (int f) (int g) ds, integrals from the crank pin"),
    "bending": ("", "int f' g' ds"),
    "drag": ("", "int (int f) (int g) ds of what has no mean"),
    "lam_1": ("", "Multiplier"),
    "lam_2": ("", "Multiplier"),
}
PARAMETERS = (
    "frame", "crank", "coupler", "follower", "bending_stiffness", "mass_per_length", "damping",
    "gravity_x", "gravity_y", "follower_inertia", "follower_first_moment",
)

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1", "constraints_2_1", "jacobian_1_1", "jacobian_1_2", "jacobian_2_1",
        "jacobian_2_2", "velocity_rhs_1_1", "velocity_rhs_2_1",
    ),
    "dynamics": (
        "mass_1_1", "mass_2_2_inertia_left1", "mass_2_2_inertia_right1", "mass_2_2_inertia_left2",
        "mass_2_2_inertia_right2", "rest_1_1", "rest_2_1", "forces_2_1", "jacobian_1_1",
        "jacobian_1_2", "jacobian_2_1", "jacobian_2_2", "velocity_rhs_1_1", "velocity_rhs_2_1",
        "gamma_1_1", "gamma_2_1",
    ),
    "variations": (
        "damping_2_2_drag_left1", "damping_2_2_drag_right1", "damping_2_2_inertia_left2",
        "damping_2_2_inertia_right2", "damping_2_2_inertia_left3", "damping_2_2_inertia_right3",
        "stiffness_1_1", "stiffness_2_2_diagonal", "stiffness_2_2_bending_right1",
        "stiffness_2_2_inertia_right2", "stiffness_2_2_inertia_right3", "jacobian_rate_1_1",
        "jacobian_rate_1_2", "jacobian_rate_2_1", "jacobian_rate_2_2", "jacobian_acceleration_1_1",
        "jacobian_acceleration_1_2", "jacobian_acceleration_2_1", "jacobian_acceleration_2_2",
    ),
}
COORDINATES = ("psi", "phi")
MULTIPLIERS = ("lam_1", "lam_2")
EXTERNAL = ("theta", "theta_d1", "theta_d2")

# Coordinate that stands for one of each station, and the numbers of stations and pairs.  In ARRAYS
# a matrix over the stations has its diagonal and, beside it, products of factors of the rows, a
# kernel, and factors of the columns.
STATIONS = ("phi", ("end", "moment", "bow", "inertia", "bending", "drag"))

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {
        "constraints": ((2, 1), ((0, 0, 0), (1, 0, 1))),
        "jacobian": ((2, 2), ((0, 0, 2), (0, 1, 3), (1, 0, 4), (1, 1, 5))),
        "velocity_rhs": ((2, 1), ((0, 0, 6), (1, 0, 7))),
    },
    "dynamics": {
        "mass": ((2, 2), ((0, 0, 0), (1, 1, 1, "inertia", 2), (1, 1, 3, "inertia", 4))),
        "rest": ((2, 1), ((0, 0, 5), (1, 0, 6))),
        "forces": ((2, 1), ((1, 0, 7),)),
        "jacobian": ((2, 2), ((0, 0, 8), (0, 1, 9), (1, 0, 10), (1, 1, 11))),
        "velocity_rhs": ((2, 1), ((0, 0, 12), (1, 0, 13))),
        "gamma": ((2, 1), ((0, 0, 14), (1, 0, 15))),
    },
    "variations": {
        "damping": (
            (2, 2), ((1, 1, 0, "drag", 1), (1, 1, 2, "inertia", 3), (1, 1, 4, "inertia", 5)),
        ),
        "stiffness": (
            (2, 2),
            (
                (0, 0, 6),
                (1, 1, 7),
                (1, 1, 0, "bending", 8),
                (1, 1, 4, "inertia", 9),
                (1, 1, 2, "inertia", 10),
            ),
        ),
        "jacobian_rate": ((2, 2), ((0, 0, 11), (0, 1, 12), (1, 0, 13), (1, 1, 14))),
        "jacobian_acceleration": ((2, 2), ((0, 0, 15), (0, 1, 16), (1, 0, 17), (1, 1, 18))),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    psi, phi, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower, bending_stiffness,
    mass_per_length, damping, gravity_x, gravity_y, follower_inertia, follower_first_moment, end,
    moment, bow, inertia, bending, drag,
):
    """Return the constraints and their Jacobian.

    psi : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(psi)
    x0 = crank * xp.cos(theta)
    x1 = -follower * xp.cos(psi)
    x2 = coupler * end
    x3 = x2 * xp.cos(phi)
    x4 = crank * xp.sin(theta)
    x5 = follower * xp.sin(psi)
    x6 = x2 * xp.sin(phi)
    return (
        x0 - frame + x1 + xp.sum(x3, axis=0), x4 - x5 + xp.sum(x6, axis=0), x5, -x6, x1, x3,
        x4 * theta_d1, -x0 * theta_d1,
    )


def dynamics(
    psi, phi, psi_dot, phi_dot, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, follower_inertia,
    follower_first_moment, end, moment, bow, inertia, bending, drag,
):
    """Return everything in the equations of motion at acceleration level.

    psi : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    psi_dot : float or ndarray, shape (...)
    phi_dot : ndarray, shape (Q, N)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(psi)
    x0 = xp.cos(phi)
    x1 = coupler**3
    x2 = x1 * mass_per_length
    x3 = x2 * x0
    x4 = xp.sin(phi)
    x5 = x2 * x4
    x6 = xp.sin(psi)
    x7 = xp.cos(psi)
    x8 = phi_dot**2
    x9 = xp.sin(theta)
    x10 = theta_d2 * crank
    x11 = xp.cos(theta)
    x12 = crank * theta_d1**2
    x13 = x10 * x9 + x11 * x12
    x14 = mass_per_length * coupler**2 * moment
    x15 = x12 * x9 - x10 * x11
    x16 = x6 * follower
    x17 = coupler * end
    x18 = x17 * x4
    x19 = x7 * follower
    x20 = x0 * x17
    x21 = theta_d1 * crank
    x22 = psi_dot**2
    return (
        follower_inertia, x0, x3, x4, x5,
        x6 * follower_first_moment * gravity_x - x7 * follower_first_moment * gravity_y,
        (
            x0 * x14 * (-x15 - gravity_y) + x0 * (inertia @ (-x5 * x8)) + x14 * x4 * (gravity_x +
            x13) + x4 * (inertia @ (x3 * x8)) + bending @ (bending_stiffness * (phi - bow) /
            coupler)
        ),
        drag @ (-x1 * phi_dot * damping), x16, -x18, -x19, x20, x21 * x9, -x11 * x21,
        x13 - x19 * x22 + xp.sum(x20 * x8, axis=0), x15 - x16 * x22 + xp.sum(x18 * x8, axis=0),
    )


def variations(
    psi, phi, psi_dot, phi_dot, psi_ddot, phi_ddot, lam_1, lam_2, t, theta, theta_d1, theta_d2,
    frame, crank, coupler, follower, bending_stiffness, mass_per_length, damping, gravity_x,
    gravity_y, follower_inertia, follower_first_moment, end, moment, bow, inertia, bending, drag,
):
    """Return the arrays of the motion linearised about a given one.

    psi : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    psi_dot : float or ndarray, shape (...)
    phi_dot : ndarray, shape (Q, N)
    psi_ddot : float or ndarray, shape (...)
    phi_ddot : ndarray, shape (Q, N)
    lam_1, lam_2 : float or ndarray, shape (...)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(psi)
    x0 = coupler**3
    x1 = xp.cos(phi)
    x2 = xp.sin(phi)
    x3 = x0 * mass_per_length
    x4 = 2 * x3 * phi_dot
    x5 = xp.cos(psi)
    x6 = x5 * follower
    x7 = xp.sin(psi)
    x8 = x7 * follower
    x9 = coupler * end
    x10 = x1 * x9
    x11 = x2 * x9
    x12 = phi_ddot * x2
    x13 = phi_dot**2
    x14 = x1 * x13
    x15 = x3 * (x12 + x14)
    x16 = phi_ddot * x1
    x17 = x16 - x13 * x2
    x18 = crank * xp.sin(theta)
    x19 = theta_d1**2
    x20 = crank * xp.cos(theta)
    x21 = mass_per_length * coupler**2 * moment
    x22 = psi_dot**2
    return (
        1, x0 * damping, x1, -x2 * x4, x2, x1 * x4,
        (
            x5 * follower_first_moment * gravity_x + x7 * follower_first_moment * gravity_y - x6 *
            lam_1 - x8 * lam_2
        ),
        (
            lam_1 * x10 + lam_2 * x11 + x1 * x21 * (gravity_x + x18 * theta_d2 + x19 * x20) + x1 *
            (inertia @ x15) + x2 * x21 * (gravity_y - x20 * theta_d2 + x18 * x19) + x2 * (inertia @
            (-x3 * x17))
        ),
        bending_stiffness / coupler, x3 * x17, -x15, psi_dot * x6, -phi_dot * x10, psi_dot * x8,
        -phi_dot * x11, x6 * psi_ddot - x22 * x8, coupler * end * x13 * x2 - x16 * x9,
        x8 * psi_ddot + x22 * x6, -x12 * x9 - x14 * x9,
    )
