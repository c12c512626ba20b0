"""Inextensible flexible coupler of a slider-crank, geometrically exact.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation inextensible, flexible coupler, any number of modes.
Equations: Smith 9.6, further work 2.

The coupler's points are r(s) = B + coupler int (cos phi, sin phi) ds.  Arrays with a value at each
of the Q stations have them on their first axis, all others one value there.

Multipliers: force on C along x and y, up to its sign.

Cost per evaluation:
    constraints: 18 operations
    dynamics: 62 operations
    variations: 68 operations
Content hash 1d3fe57747c302e7ad503c28cbeb645b; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["constraints", "dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible","mechanism":"sli'
    'der_crank","modes":null,"outputs":[]}'
)
CONTENT = "1d3fe57747c302e7ad503c28cbeb645b"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "crank": ("m", "Length of the crank"),
    "coupler": ("m", "Length of the coupler"),
    "offset": ("m", "Height of the guide over the crank's pivot"),
    "bending_stiffness": ("N m^2", "EI of the coupler"),
    "mass_per_length": ("kg/m", "mu of the coupler"),
    "damping": ("N s/m^2", "Viscous damping of the coupler per length"),
    "gravity_x": ("m/s^2", "Acceleration of gravity along x"),
    "gravity_y": ("m/s^2", "Acceleration of gravity along y"),
    "slider_mass": ("kg", "Mass of the slider"),
    "x4": ("m", "Place of the slider's pin C along the guide"),
    "phi": ("rad", "Angle of the coupler's tangent at the stations"),
    "t": ("s", "Time"),
    "theta": ("rad", "Crank angle"),
    "theta_d1": ("rad/s", "Crank speed"),
    "theta_d2": ("rad/s^2", "Crank acceleration"),
    "tangent_x": ("", "Cosine of phi"),
    "tangent_y": ("", "Sine of phi"),
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
    "crank", "coupler", "offset", "bending_stiffness", "mass_per_length", "damping", "gravity_x",
    "gravity_y", "slider_mass",
)

# Names of what each function returns, in order.
RETURNS = {
    "constraints": (
        "constraints_1_1", "constraints_2_1", "jacobian_1_1", "jacobian_1_2", "jacobian_2_2",
        "velocity_rhs_1_1", "velocity_rhs_2_1",
    ),
    "dynamics": (
        "mass_1_1", "mass_2_2_inertia_left1", "mass_2_2_inertia_right1", "mass_2_2_inertia_left2",
        "mass_2_2_inertia_right2", "rest_1_1", "rest_2_1", "forces_2_1", "jacobian_1_1",
        "jacobian_1_2", "jacobian_2_2", "velocity_rhs_1_1", "velocity_rhs_2_1", "gamma_1_1",
        "gamma_2_1",
    ),
    "variations": (
        "damping_2_2_drag_left1", "damping_2_2_drag_right1", "damping_2_2_inertia_left2",
        "damping_2_2_inertia_right2", "damping_2_2_inertia_left3", "damping_2_2_inertia_right3",
        "stiffness_2_2_diagonal", "stiffness_2_2_bending_right1", "stiffness_2_2_inertia_right2",
        "stiffness_2_2_inertia_right3", "jacobian_rate_1_2", "jacobian_rate_2_2",
        "jacobian_acceleration_1_2", "jacobian_acceleration_2_2",
    ),
}
COORDINATES = ("x4", "phi")
MULTIPLIERS = ("lam_1", "lam_2")
EXTERNAL = ("theta", "theta_d1", "theta_d2")

# Coordinate that stands for one of each station, its cosine and sine, and the numbers of stations
# and pairs.  In ARRAYS a matrix over the stations has its diagonal and, beside it, products of
# factors of the rows, a kernel, and factors of the columns.
STATIONS = (
    "phi",
    ("tangent_x", "tangent_y"),
    ("end", "moment", "bow", "inertia", "bending", "drag"),
)

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {
        "constraints": ((2, 1), ((0, 0, 0), (1, 0, 1))),
        "jacobian": ((2, 2), ((0, 0, 2), (0, 1, 3), (1, 1, 4))),
        "velocity_rhs": ((2, 1), ((0, 0, 5), (1, 0, 6))),
    },
    "dynamics": {
        "mass": ((2, 2), ((0, 0, 0), (1, 1, 1, "inertia", 2), (1, 1, 3, "inertia", 4))),
        "rest": ((2, 1), ((0, 0, 5), (1, 0, 6))),
        "forces": ((2, 1), ((1, 0, 7),)),
        "jacobian": ((2, 2), ((0, 0, 8), (0, 1, 9), (1, 1, 10))),
        "velocity_rhs": ((2, 1), ((0, 0, 11), (1, 0, 12))),
        "gamma": ((2, 1), ((0, 0, 13), (1, 0, 14))),
    },
    "variations": {
        "damping": (
            (2, 2), ((1, 1, 0, "drag", 1), (1, 1, 2, "inertia", 3), (1, 1, 4, "inertia", 5)),
        ),
        "stiffness": (
            (2, 2),
            ((1, 1, 6), (1, 1, 0, "bending", 7), (1, 1, 4, "inertia", 8), (1, 1, 2, "inertia", 9)),
        ),
        "jacobian_rate": ((2, 2), ((0, 1, 10), (1, 1, 11))),
        "jacobian_acceleration": ((2, 2), ((0, 1, 12), (1, 1, 13))),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def constraints(
    x4, phi, t, theta, theta_d1, theta_d2, crank, coupler, offset, bending_stiffness,
    mass_per_length, damping, gravity_x, gravity_y, slider_mass, tangent_x, tangent_y, end, moment,
    bow, inertia, bending, drag,
):
    """Return the constraints and their Jacobian.

    x4 : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    crank to slider_mass : float
    tangent_x, tangent_y : ndarray, shape (Q, N)
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(x4)
    x0 = crank * xp.cos(theta)
    x1 = coupler * end
    x2 = tangent_x * x1
    x3 = crank * xp.sin(theta)
    x5 = tangent_y * x1
    return (
        x0 - x4 + xp.sum(x2, axis=0), x3 - offset + xp.sum(x5, axis=0), -1, -x5, x2, x3 * theta_d1,
        -x0 * theta_d1,
    )


def dynamics(
    x4, phi, x4_dot, phi_dot, t, theta, theta_d1, theta_d2, crank, coupler, offset,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, slider_mass, tangent_x,
    tangent_y, end, moment, bow, inertia, bending, drag,
):
    """Return everything in the equations of motion at acceleration level.

    x4 : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    x4_dot : float or ndarray, shape (N,)
    phi_dot : ndarray, shape (Q, N)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    crank to slider_mass : float
    tangent_x, tangent_y : ndarray, shape (Q, N)
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(x4)
    x0 = coupler**3
    x1 = x0 * mass_per_length
    x2 = x1 * tangent_x
    x3 = x1 * tangent_y
    x4 = phi_dot**2
    x5 = xp.sin(theta)
    x6 = theta_d2 * crank
    x7 = xp.cos(theta)
    x8 = crank * theta_d1**2
    x9 = x5 * x6 + x7 * x8
    x10 = mass_per_length * coupler**2 * moment
    x11 = x5 * x8 - x6 * x7
    x12 = coupler * end
    x13 = tangent_y * x12
    x14 = tangent_x * x12
    x15 = theta_d1 * crank
    return (
        slider_mass, tangent_x, x2, tangent_y, x3, -gravity_x * slider_mass,
        (
            tangent_x * x10 * (-x11 - gravity_y) + tangent_x * (inertia @ (-x3 * x4)) + tangent_y *
            x10 * (gravity_x + x9) + tangent_y * (inertia @ (x2 * x4)) + bending @
            (bending_stiffness * (phi - bow) / coupler)
        ),
        drag @ (-x0 * phi_dot * damping), -1, -x13, x14, x15 * x5, -x15 * x7,
        x9 + xp.sum(x14 * x4, axis=0), x11 + xp.sum(x13 * x4, axis=0),
    )


def variations(
    x4, phi, x4_dot, phi_dot, x4_ddot, phi_ddot, lam_1, lam_2, t, theta, theta_d1, theta_d2, crank,
    coupler, offset, bending_stiffness, mass_per_length, damping, gravity_x, gravity_y,
    slider_mass, tangent_x, tangent_y, end, moment, bow, inertia, bending, drag,
):
    """Return the arrays of the motion linearised about a given one.

    x4 : float or ndarray, shape (N,)
    phi : ndarray, shape (Q, N)
    x4_dot : float or ndarray, shape (N,)
    phi_dot : ndarray, shape (Q, N)
    x4_ddot : float or ndarray, shape (N,)
    phi_ddot : ndarray, shape (Q, N)
    lam_1, lam_2 : float or ndarray, shape (...)
    t, theta, theta_d1, theta_d2 : float or ndarray, shape (N,)
    crank to slider_mass : float
    tangent_x, tangent_y : ndarray, shape (Q, N)
    end, moment, bow : ndarray, shape (Q, 1)
    inertia, bending, drag : ndarray, shape (Q, Q)
    Returns float or ndarray each.
    """
    xp = _namespace(x4)
    x0 = coupler**3
    x1 = x0 * mass_per_length
    x2 = 2 * x1 * phi_dot
    x3 = coupler * end
    x4 = tangent_x * x3
    x5 = tangent_y * x3
    x6 = phi_ddot * tangent_y
    x7 = phi_dot**2
    x8 = tangent_x * x7
    x9 = x1 * (x6 + x8)
    x10 = phi_ddot * tangent_x
    x11 = x10 - tangent_y * x7
    x12 = crank * xp.sin(theta)
    x13 = theta_d1**2
    x14 = crank * xp.cos(theta)
    x15 = mass_per_length * coupler**2 * moment
    return (
        1, x0 * damping, tangent_x, -tangent_y * x2, tangent_y, tangent_x * x2,
        (
            lam_1 * x4 + lam_2 * x5 + tangent_x * x15 * (gravity_x + x12 * theta_d2 + x13 * x14) +
            tangent_x * (inertia @ x9) + tangent_y * x15 * (gravity_y - x14 * theta_d2 + x12 * x13)
            + tangent_y * (inertia @ (-x1 * x11))
        ),
        bending_stiffness / coupler, x1 * x11, -x9, -phi_dot * x4, -phi_dot * x5,
        coupler * end * tangent_y * x7 - x10 * x3, -x3 * x6 - x3 * x8,
    )
