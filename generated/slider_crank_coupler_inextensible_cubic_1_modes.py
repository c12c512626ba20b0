"""Inextensible flexible coupler of a slider-crank, to third order in its amplitudes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation inextensible_cubic, flexible coupler, 1 modes.
Equations: Smith 9.6, further work 2.

Angle of the coupler's tangent: a mean and sum q_k cos(k pi s), s from 0 at the crank to 1.
Derivatives by_u are those by the chord's length over the coupler's.

Cost per evaluation:
    dynamics: 298 operations
    variations: 285 operations
Content hash 425b9e2c51d228c75309bcc6e6923855; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible_cubic","mechanism'
    '":"slider_crank","modes":1,"outputs":[]}'
)
CONTENT = "425b9e2c51d228c75309bcc6e6923855"

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
    "bow": ("m", "Deflection of the unloaded coupler's middle"),
    "assembly": ("", "+1 where the slider is right of B (open), -1 left"),
    "q1": ("rad", "Amplitude of cos(1 pi s)"),
    "t": ("s", "Time"),
    "theta": ("rad", "Crank angle"),
    "theta_d1": ("rad/s", "Crank speed"),
    "theta_d2": ("rad/s^2", "Crank acceleration"),
}
PARAMETERS = (
    "crank", "coupler", "offset", "bending_stiffness", "mass_per_length", "damping", "gravity_x",
    "gravity_y", "slider_mass", "bow", "assembly",
)

# Names of what each function returns, in order.
RETURNS = {
    "dynamics": ("mass_1_1", "rest_1_1", "forces_1_1"),
    "variations": ("damping_1_1", "stiffness_1_1"),
}
COORDINATES = ("q1",)
MULTIPLIERS = ()
EXTERNAL = ("theta", "theta_d1", "theta_d2")

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {"constraints": ((0, 1), ()), "jacobian": ((0, 1), ())},
    "dynamics": {
        "mass": ((1, 1), ((0, 0, 0),)),
        "rest": ((1, 1), ((0, 0, 1),)),
        "forces": ((1, 1), ((0, 0, 2),)),
        "jacobian": ((0, 1), ()),
        "velocity_rhs": ((0, 1), ()),
        "gamma": ((0, 1), ()),
    },
    "variations": {
        "damping": ((1, 1), ((0, 0, 0),)),
        "stiffness": ((1, 1), ((0, 0, 1),)),
        "jacobian_rate": ((0, 1), ()),
        "jacobian_acceleration": ((0, 1), ()),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def dynamics(
    q1, q1_dot, t, theta, theta_d1, theta_d2, crank, coupler, offset, bending_stiffness,
    mass_per_length, damping, gravity_x, gravity_y, slider_mass, bow, assembly,
):
    """Return everything in the equations of motion at acceleration level.

    q1, q1_dot, t, theta, theta_d1, theta_d2 : float or ndarray, shape (...)
    crank to assembly : float
    Returns float or ndarray each.
    """
    xp = _namespace(q1)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = lowered * (offset + total)
    x4 = raised * (offset + reach)
    above = x3 + x4
    x5 = offset - reach
    x6 = offset - total
    below = -x5 * lowered - x6 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    sin3 = x7 * (offset - sin2 * crank)
    cos3 = 2 * assembly * root / (above + below)
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    x8 = 1 / cos3
    x9 = cos2 * crank
    omega3 = -x7 * x8 * x9
    x10 = coupler**3
    alpha3 = crank * (offset * crank * cos2**2 + (-sin2 * (x3 * x5 + x4 * x6))) / (x10 * cos3**3)
    x11 = sin23 * crank
    slider_velocity = -x11 * x8
    x12 = omega3**2
    x13 = x12 * cos3
    slider_acceleration = -alpha3 * sin3 * coupler - x13 * coupler - x9
    theta3_by_u = -x8 * sin3
    x14 = x8 * coupler
    x4_by_u = x14
    x15 = -sin3 * theta3_by_u
    theta3_by_u_speed = -x8 * omega3 * (cos3 + x15)
    x4_by_u_speed = -x14 * omega3 * theta3_by_u
    x16 = 2 * omega3 * theta3_by_u_speed
    theta3_by_u_bend = (
        x8 * (alpha3 * sin3 * theta3_by_u - alpha3 * cos3 + x12 * sin3 + x16 * sin3 + x13 *
        theta3_by_u)
    )
    x4_by_u_bend = -(alpha3 * theta3_by_u + x12 + x16) * x14
    theta3_by_uu = -x8 * theta3_by_u * (2 * cos3 + x15)
    x17 = theta3_by_u**2
    x4_by_uu = -x14 * x17
    theta3_d1 = theta_d1 * omega3
    x18 = theta_d1**2
    theta3_d2 = x18 * alpha3 + theta_d2 * omega3
    x4_d2 = x18 * slider_acceleration + theta_d2 * slider_velocity
    theta3_by_u_d1 = theta_d1 * theta3_by_u_speed
    theta3_by_u_d2 = x18 * theta3_by_u_bend + theta_d2 * theta3_by_u_speed
    x4_by_u_d1 = theta_d1 * x4_by_u_speed
    x4_by_u_d2 = theta_d2 * x4_by_u_speed + x18 * x4_by_u_bend
    x19 = cos23 * crank
    along = cos3 * gravity_x + gravity_y * sin3 + theta_d2 * x11 + x18 * x19
    across = cos3 * gravity_y + x18 * sin23 * crank - gravity_x * sin3 - theta_d2 * x19
    x20 = x10 * mass_per_length
    x21 = 8 * x20
    x22 = 9.869604401089358
    x23 = 1 / x22
    x24 = x20 * x23
    mass11_q1_q1 = 24 * slider_mass * x4_by_u**2 + x17 * x21 + x21 - 45 * x24
    x25 = x24 * theta3_by_u
    mass11_q1 = -x25
    mass11 = x24
    x26 = gravity_x * slider_mass
    x27 = 48 * x4_by_u
    x28 = 96 * x4_by_uu
    x29 = x4_by_u * slider_mass
    x30 = x4_d2 * slider_mass
    x31 = coupler**2
    x32 = x31 * mass_per_length
    x33 = x32 * along
    x34 = x32 * across
    x35 = x34 * theta3_by_u
    x36 = 32 * x20
    x37 = x20 * theta3_by_u * theta3_d2
    x38 = x20 * theta3_by_u_d1
    x39 = theta3_d1**2
    x40 = x20 * x39
    x41 = x24 * theta3_by_u_d1
    x42 = x24 * x39
    rest1_q1_q1_q1 = (
        x36 * theta3_by_u * theta3_by_u_d2 + x36 * theta3_by_uu * theta3_d2 - 48 * x34 *
        theta3_by_uu - 64 * x38 * theta3_d1 + 240 * x41 * theta3_d1 - 240 * x25 * theta3_d2 + 48 *
        x17 * x33 - x26 * x27 - x26 * x28 + x27 * x30 + x28 * x30 + 96 * x29 * x4_by_u_d2 - 24 *
        x33 - 120 * x35 + 80 * x37 - 48 * x40 + 245 * x42
    )
    rest1_q1_q1_q1_dot = x38 * theta3_by_u + 3 * x29 * x4_by_u_d1
    x43 = x23 * x32
    rest1_q1_q1 = (
        x43 * (28 * across - 54 * along * theta3_by_u - 9 * theta3_by_u_d2 * coupler - 5 *
        theta3_d2 * coupler)
    )
    rest1_q1_q1_dot = -x41
    x44 = 12 * x4_by_u
    rest1_q1 = (
        12 * x22 * x7 * bending_stiffness + x26 * x44 - x30 * x44 + 6 * x33 + 6 * x35 - 4 * x37 + 4
        * x40 - 15 * x42
    )
    rest1 = (
        2 * x10 * x23 * theta3_d2 * mass_per_length - 4 * x43 * across - 31.00627668029982 * bow *
        bending_stiffness / x31
    )
    x45 = q1**2
    x46 = mass11_q1_q1 / 96
    x47 = q1_dot**2
    return (
        mass11 / 2 + mass11_q1 * q1 + x45 * x46,
        (
            mass11_q1 * x47 / 2 + rest1_q1_q1_q1 * q1**3 / 768 + q1 * q1_dot * rest1_q1_q1_dot + q1
            * rest1_q1 / 24 + q1 * x46 * x47 + q1_dot * rest1_q1_q1_q1_dot * x45 / 6 + rest1 / 2 +
            rest1_q1_q1 * x45 / 36
        ),
        -q1_dot * x10 * x23 * damping / 2,
    )


def variations(
    q1, q1_dot, q1_ddot, t, theta, theta_d1, theta_d2, crank, coupler, offset, bending_stiffness,
    mass_per_length, damping, gravity_x, gravity_y, slider_mass, bow, assembly,
):
    """Return the arrays of the motion linearised about a given one.

    q1 to theta_d2 : float or ndarray, shape (...)
    crank to assembly : float
    Returns float or ndarray each.
    """
    xp = _namespace(q1)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = lowered * (offset + total)
    x4 = raised * (offset + reach)
    above = x3 + x4
    x5 = offset - reach
    x6 = offset - total
    below = -x5 * lowered - x6 * raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    sin3 = x7 * (offset - sin2 * crank)
    cos3 = 2 * assembly * root / (above + below)
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    x8 = 1 / cos3
    x9 = cos2 * crank
    omega3 = -x7 * x8 * x9
    x10 = coupler**3
    alpha3 = crank * (offset * crank * cos2**2 + (-sin2 * (x3 * x5 + x4 * x6))) / (x10 * cos3**3)
    x11 = sin23 * crank
    slider_velocity = -x11 * x8
    x12 = omega3**2
    x13 = x12 * cos3
    slider_acceleration = -alpha3 * sin3 * coupler - x13 * coupler - x9
    theta3_by_u = -x8 * sin3
    x14 = x8 * coupler
    x4_by_u = x14
    x15 = -sin3 * theta3_by_u
    theta3_by_u_speed = -x8 * omega3 * (cos3 + x15)
    x4_by_u_speed = -x14 * omega3 * theta3_by_u
    x16 = 2 * omega3 * theta3_by_u_speed
    theta3_by_u_bend = (
        x8 * (alpha3 * sin3 * theta3_by_u - alpha3 * cos3 + x12 * sin3 + x16 * sin3 + x13 *
        theta3_by_u)
    )
    x4_by_u_bend = -(alpha3 * theta3_by_u + x12 + x16) * x14
    theta3_by_uu = -x8 * theta3_by_u * (2 * cos3 + x15)
    x17 = theta3_by_u**2
    x4_by_uu = -x14 * x17
    theta3_d1 = theta_d1 * omega3
    x18 = theta_d1**2
    theta3_d2 = x18 * alpha3 + theta_d2 * omega3
    x4_d2 = x18 * slider_acceleration + theta_d2 * slider_velocity
    theta3_by_u_d1 = theta_d1 * theta3_by_u_speed
    theta3_by_u_d2 = x18 * theta3_by_u_bend + theta_d2 * theta3_by_u_speed
    x4_by_u_d1 = theta_d1 * x4_by_u_speed
    x4_by_u_d2 = theta_d2 * x4_by_u_speed + x18 * x4_by_u_bend
    x19 = cos23 * crank
    along = cos3 * gravity_x + gravity_y * sin3 + theta_d2 * x11 + x18 * x19
    across = cos3 * gravity_y + x18 * sin23 * crank - gravity_x * sin3 - theta_d2 * x19
    x20 = x10 * mass_per_length
    x21 = 8 * x20
    x22 = 9.869604401089358
    x23 = 1 / x22
    x24 = x20 * x23
    mass11_q1_q1 = 24 * slider_mass * x4_by_u**2 + x17 * x21 + x21 - 45 * x24
    x25 = x24 * theta3_by_u
    mass11_q1 = -x25
    x26 = gravity_x * slider_mass
    x27 = 48 * x4_by_u
    x28 = 96 * x4_by_uu
    x29 = x4_by_u * slider_mass
    x30 = x4_d2 * slider_mass
    x31 = mass_per_length * coupler**2
    x32 = x31 * along
    x33 = x31 * across
    x34 = x33 * theta3_by_u
    x35 = 32 * x20
    x36 = x20 * theta3_by_u * theta3_d2
    x37 = x20 * theta3_by_u_d1
    x38 = theta3_d1**2
    x39 = x20 * x38
    x40 = x24 * theta3_by_u_d1
    x41 = x24 * x38
    rest1_q1_q1_q1 = (
        x35 * theta3_by_u * theta3_by_u_d2 + x35 * theta3_by_uu * theta3_d2 - 48 * x33 *
        theta3_by_uu - 64 * x37 * theta3_d1 + 240 * x40 * theta3_d1 - 240 * x25 * theta3_d2 + 48 *
        x17 * x32 - x26 * x27 - x26 * x28 + x27 * x30 + x28 * x30 + 96 * x29 * x4_by_u_d2 - 24 *
        x32 - 120 * x34 + 80 * x36 - 48 * x39 + 245 * x41
    )
    rest1_q1_q1_q1_dot = x37 * theta3_by_u + 3 * x29 * x4_by_u_d1
    rest1_q1_q1 = (
        x23 * x31 * (28 * across - 54 * along * theta3_by_u - 9 * theta3_by_u_d2 * coupler - 5 *
        theta3_d2 * coupler)
    )
    rest1_q1_q1_dot = -x40
    x42 = 12 * x4_by_u
    rest1_q1 = (
        12 * x22 * x7 * bending_stiffness + x26 * x42 - x30 * x42 + 6 * x32 + 6 * x34 - 4 * x36 + 4
        * x39 - 15 * x41
    )
    x43 = mass11_q1_q1 * q1 / 48
    x44 = q1**2
    return (
        (
            x10 * x23 * damping / 2 + mass11_q1 * q1_dot + q1 * rest1_q1_q1_dot + x43 * q1_dot +
            rest1_q1_q1_q1_dot * x44 / 6
        ),
        (
            mass11_q1_q1 * q1_dot**2 / 96 + q1 * rest1_q1_q1_q1_dot * q1_dot / 3 + q1 * rest1_q1_q1
            / 18 + (mass11_q1 + x43) * q1_ddot + rest1_q1_q1_dot * q1_dot + rest1_q1 / 24 +
            rest1_q1_q1_q1 * x44 / 256
        ),
    )
