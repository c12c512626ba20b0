"""Inextensible flexible coupler of a four-bar linkage, geometrically exact.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation inextensible, flexible coupler, any number of modes.
Equations: Smith 9.6, further work 2.

The coupler's points are r(s) = B + coupler int (cos phi, sin phi) ds.  Arrays with a value at each
of the Q stations have them on their last axis, all others one value there.

Multipliers: force on C along x and y, up to its sign.

Cost per evaluation:
    constraints: 22 operations
    dynamics: 76 operations
    variations: 92 operations
Content hash d61542e8c5931149cccbde21cfc5ccb5; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["constraints", "dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible","mechanism":"fou'
    'r_bar","modes":null,"outputs":[]}'
)
CONTENT = "d61542e8c5931149cccbde21cfc5ccb5"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "frame": ("m", "Length of the frame"),
    "crank": ("m", "Length of the crank"),
    "coupler": ("m", "Length of the coupler"),
    "follower": ("m", "Length of the follower"),
    "bending_stiffness": ("N m^2", "EI of the coupler"),
    "mass_per_length": ("kg/m", "mu of the coupler"),
    "damping": ("N s/m^2", "Viscous damping of the coupler per length"),
    "gravity": ("m/s^2", "Acceleration of gravity, against y"),
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
    "gravity", "follower_inertia", "follower_first_moment",
)

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1", "constraints_2_1", "jacobian_1_1", "jacobian_1_2", "jacobian_2_1",
        "jacobian_2_2",
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
    mass_per_length, damping, gravity, follower_inertia, follower_first_moment, end, moment, bow,
    inertia, bending, drag,
):
    """Return the constraints and their Jacobian.

    psi : float or ndarray, shape (..., 1)
    phi : ndarray, shape (..., Q)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (..., 1)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q,)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(psi)
    x0 = -follower * xp.cos(psi)
    x1 = coupler * end
    x2 = x1 * xp.cos(phi)
    x3 = follower * xp.sin(psi)
    x4 = x1 * xp.sin(phi)
    return (
        crank * xp.cos(theta) - frame + x0 + xp.sum(x2, axis=-1, keepdims=True),
        crank * xp.sin(theta) - x3 + xp.sum(x4, axis=-1, keepdims=True), x3, -x4, x0, x2,
    )


def dynamics(
    psi, phi, psi_dot, phi_dot, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower,
    bending_stiffness, mass_per_length, damping, gravity, follower_inertia, follower_first_moment,
    end, moment, bow, inertia, bending, drag,
):
    """Return everything in the equations of motion at acceleration level.

    psi : float or ndarray, shape (..., 1)
    phi : ndarray, shape (..., Q)
    psi_dot : float or ndarray, shape (...)
    phi_dot : ndarray, shape (..., Q)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (..., 1)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q,)
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
    x6 = xp.cos(psi)
    x7 = mass_per_length * coupler**2 * moment
    x8 = x0 * x7
    x9 = xp.sin(theta)
    x10 = x9 * crank
    x11 = theta_d2 * x10
    x12 = x4 * x7
    x13 = xp.cos(theta)
    x14 = x13 * crank
    x15 = theta_d2 * x14
    x16 = theta_d1**2
    x17 = x14 * x16
    x18 = phi_dot**2
    x19 = x10 * x16
    x20 = follower * xp.sin(psi)
    x21 = coupler * end
    x22 = x21 * x4
    x23 = x6 * follower
    x24 = x0 * x21
    x25 = theta_d1 * crank
    x26 = psi_dot**2
    return (
        follower_inertia, x0, x3, x4, x5, x6 * follower_first_moment * gravity,
        (
            x8 * gravity + x0 * ((-x18 * x5) @ inertia) + x11 * x12 + x17 * x12 + x15 * x8 - x19 *
            x8 + x4 * ((x18 * x3) @ inertia) + (bending_stiffness * (phi - bow) / coupler) @
            bending
        ),
        (-x1 * phi_dot * damping) @ drag, x20, -x22, -x23, x24, x25 * x9, -x13 * x25,
        x11 + x17 - x23 * x26 + xp.sum(x18 * x24, axis=-1, keepdims=True),
        x19 - x15 - x20 * x26 + xp.sum(x18 * x22, axis=-1, keepdims=True),
    )


def variations(
    psi, phi, psi_dot, phi_dot, psi_ddot, phi_ddot, lam_1, lam_2, t, theta, theta_d1, theta_d2,
    frame, crank, coupler, follower, bending_stiffness, mass_per_length, damping, gravity,
    follower_inertia, follower_first_moment, end, moment, bow, inertia, bending, drag,
):
    """Return the arrays of the motion linearised about a given one.

    psi : float or ndarray, shape (..., 1)
    phi : ndarray, shape (..., Q)
    psi_dot : float or ndarray, shape (...)
    phi_dot : ndarray, shape (..., Q)
    psi_ddot : float or ndarray, shape (...)
    phi_ddot : ndarray, shape (..., Q)
    lam_1, lam_2 : float or ndarray, shape (...)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (..., 1)
    frame to follower_first_moment : float
    end, moment, bow : ndarray, shape (Q,)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(psi)
    x0 = coupler**3
    x1 = xp.cos(phi)
    x2 = xp.sin(phi)
    x3 = x0 * mass_per_length
    x4 = 2 * x3 * phi_dot
    x5 = follower * xp.cos(psi)
    x6 = xp.sin(psi)
    x7 = x6 * follower
    x8 = coupler * end
    x9 = x1 * x8
    x10 = x2 * x8
    x11 = mass_per_length * coupler**2 * moment
    x12 = x11 * x2
    x13 = crank * xp.sin(theta)
    x14 = x1 * x11
    x15 = crank * xp.cos(theta)
    x16 = theta_d1**2
    x17 = phi_ddot * x2
    x18 = phi_dot**2
    x19 = x1 * x18
    x20 = x3 * (x17 + x19)
    x21 = phi_ddot * x1
    x22 = x21 - x18 * x2
    x23 = psi_dot**2
    return (
        1, x0 * damping, x1, -x2 * x4, x2, x1 * x4,
        -x6 * follower_first_moment * gravity - x5 * lam_1 - x7 * lam_2,
        (
            lam_1 * x9 - x12 * gravity + lam_2 * x10 - x15 * theta_d2 * x12 + x13 * theta_d2 * x14
            + x1 * (x20 @ inertia) + x13 * x16 * x12 + x15 * x16 * x14 + x2 * ((-x3 * x22) @
            inertia)
        ),
        bending_stiffness / coupler, x3 * x22, -x20, psi_dot * x5, -phi_dot * x9, psi_dot * x7,
        -phi_dot * x10, x5 * psi_ddot - x23 * x7, coupler * end * x18 * x2 - x21 * x8,
        x7 * psi_ddot + x23 * x5, -x17 * x8 - x19 * x8,
    )
