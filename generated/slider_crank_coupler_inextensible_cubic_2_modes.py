"""Inextensible flexible coupler of a slider-crank, to third order in its amplitudes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation inextensible_cubic, flexible coupler, 2 modes.
Equations: Smith 9.6, further work 2.

Angle of the coupler's tangent: a mean and sum q_k cos(k pi s), s from 0 at the crank to 1.
Derivatives by_u are those by the chord's length over the coupler's.

Cost per evaluation:
    dynamics: 663 operations
    variations: 705 operations
Content hash 5bbfd5cdd5abac3d7c44e769fa1068e4; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible_cubic","mechanism'
    '":"slider_crank","modes":2,"outputs":[]}'
)
CONTENT = "5bbfd5cdd5abac3d7c44e769fa1068e4"

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
    "q2": ("rad", "Amplitude of cos(2 pi s)"),
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
    "dynamics": (
        "mass_1_1", "mass_1_2", "mass_2_2", "rest_1_1", "rest_2_1", "forces_1_1", "forces_2_1",
    ),
    "variations": (
        "damping_1_1", "damping_1_2", "damping_2_1", "damping_2_2", "stiffness_1_1",
        "stiffness_1_2", "stiffness_2_1", "stiffness_2_2",
    ),
}
COORDINATES = ("q1", "q2")
MULTIPLIERS = ()
EXTERNAL = ("theta", "theta_d1", "theta_d2")

# Of each function its arrays: shape, and row, column and place among what it returns.
ARRAYS = {
    "constraints": {"constraints": ((0, 1), ()), "jacobian": ((0, 2), ())},
    "dynamics": {
        "mass": ((2, 2), ((0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 2))),
        "rest": ((2, 1), ((0, 0, 3), (1, 0, 4))),
        "forces": ((2, 1), ((0, 0, 5), (1, 0, 6))),
        "jacobian": ((0, 2), ()),
        "velocity_rhs": ((0, 1), ()),
        "gamma": ((0, 1), ()),
    },
    "variations": {
        "damping": ((2, 2), ((0, 0, 0), (0, 1, 1), (1, 0, 2), (1, 1, 3))),
        "stiffness": ((2, 2), ((0, 0, 4), (0, 1, 5), (1, 0, 6), (1, 1, 7))),
        "jacobian_rate": ((0, 2), ()),
        "jacobian_acceleration": ((0, 2), ()),
    },
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def dynamics(
    q1, q2, q1_dot, q2_dot, t, theta, theta_d1, theta_d2, crank, coupler, offset,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, slider_mass, bow, assembly,
):
    """Return everything in the equations of motion at acceleration level.

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
    x22 = slider_mass * x4_by_u**2
    x23 = 9.869604401089358
    x24 = 1 / x23
    x25 = x20 * x24
    x26 = 45 * x25
    mass11_q1_q1 = x17 * x21 + x21 + 24 * x22 - x26
    mass11_q1_q2 = x25
    x28 = x25 * theta3_by_u
    mass11_q1 = -x28
    mass11_q2_q2 = -x25
    x29 = 48 * x20
    mass12_q1_q2 = x17 * x29 + 144 * x22 - 145 * x25 + x29
    mass12_q1 = x28
    x30 = 32 * x20
    mass22_q2_q2 = x17 * x30 + 96 * x22 - x26 + x30
    x31 = gravity_x * slider_mass
    x32 = 96 * x4_by_uu
    x33 = 48 * x4_by_u
    x34 = x31 * x33
    x35 = theta3_d1**2
    x36 = -x29 * x35
    x37 = coupler**2
    x38 = x37 * mass_per_length
    x39 = x38 * along
    x40 = 24 * x39
    x41 = x4_d2 * slider_mass
    x42 = x33 * x41
    x43 = x4_by_u * slider_mass
    x44 = x43 * x4_by_u_d2
    x45 = across * theta3_by_u
    x46 = x38 * x45
    x47 = theta3_by_u_d1 * theta3_d1
    x48 = x20 * x47
    x49 = x38 * across * theta3_by_uu
    x50 = theta3_by_uu * theta3_d2
    x51 = x17 * x39
    x52 = x20 * theta3_by_u
    x53 = x52 * theta3_d2
    x54 = x25 * x35
    x55 = x28 * theta3_d2
    x56 = x25 * x47
    x57 = 245 * x54 - 240 * x55 + 240 * x56
    rest1_q1_q1_q1 = (
        x30 * theta3_by_u * theta3_by_u_d2 + x30 * x50 - x31 * x32 + x32 * x41 - x34 + x36 - x40 +
        x42 + 96 * x44 - 120 * x46 - 64 * x48 - 48 * x49 + 48 * x51 + 80 * x53 + x57
    )
    x58 = x47 * coupler
    x59 = 500 * x58
    x60 = x35 * coupler
    x61 = x24 * x38
    rest1_q1_q1_q2 = (
        x61 * (366 * along + 1000 * theta3_by_u * theta3_d2 * coupler - 1500 * x45 - x59 - 567 *
        x60)
    )
    rest1_q1_q1_q1_dot = x52 * theta3_by_u_d1 + 3 * x43 * x4_by_u_d1
    x62 = x28 * theta3_d1
    rest1_q1_q1_q2_dot = x62
    x63 = along * theta3_by_u
    x64 = 9 * theta3_by_u_d2
    x65 = 5 * theta3_d2
    rest1_q1_q1 = x61 * (28 * across - x64 * coupler - x65 * coupler - 54 * x63)
    x66 = 45 * theta3_d2
    x67 = 72 * x31
    x68 = 36 * x39
    x69 = 72 * x41
    x70 = x52 * theta3_by_u_d2
    x71 = x20 * x50
    x72 = (
        x17 * x68 - x29 * x47 + x36 + 72 * x44 - 108 * x46 - 36 * x49 - x67 * x4_by_u + x69 *
        x4_by_u - x67 * x4_by_uu + x69 * x4_by_uu + 72 * x53 + 119 * x54 - x68 + 24 * x70 + 24 *
        x71
    )
    rest1_q1_q2_q2 = 180 * x56 - x28 * x66 + x72
    x73 = x26 * theta3_by_u * theta3_d1
    x74 = 16 * x20
    x75 = x74 * theta3_by_u
    x76 = x33 * x4_by_u_d1 * slider_mass + x75 * theta3_by_u_d1
    rest1_q1_q2_q2_dot = x73 + x76
    x77 = x25 * theta3_d2
    rest1_q1_q2 = x77
    x78 = x25 * theta3_by_u_d1
    rest1_q1_q1_dot = -x78
    x79 = x17 * x74 + 48 * x22 + x74
    rest1_q1_q2_dot_q2_dot = x79 - 63 * x25
    x80 = x25 * theta3_d1
    rest1_q1_q2_dot = -x80
    x81 = 12 * x4_by_u
    x82 = x23 * x7 * bending_stiffness
    x83 = x20 * x35
    x84 = -15 * x54
    rest1_q1 = x31 * x81 + 6 * x39 - x41 * x81 + 6 * x46 - 4 * x53 + 12 * x82 + 4 * x83 + x84
    x85 = 12250 * x58
    rest1_q2_q2_q2 = -(6236 * along + 12250 * x45 + 9243 * x60 + x85) * x61
    rest1_q2_q2_q2_dot = -x62
    x86 = theta3_d2 * coupler
    x87 = 450 * x63 - 484 * across
    rest1_q2_q2 = -x61 * (225 * theta3_by_u_d2 * coupler + 467 * x86 + x87)
    rest1_q2_q2_dot = -(theta3_by_u_d1 + theta3_d1) * x25
    rest1_q2 = x61 * (2 * along + x60)
    rest1 = (
        2 * x10 * x24 * theta3_d2 * mass_per_length - 4 * x61 * across - 31.00627668029982 * bow *
        bending_stiffness / x37
    )
    rest2_q1_q1_q1 = x61 * (122 * along - 500 * x45 - x59 - 189 * x60)
    rest2_q1_q1_q2 = x26 * x47 - 180 * x55 + x72
    rest2_q1_q1 = x25 * (8 * theta3_by_u_d2 + x66)
    rest2_q1_q2_q2 = (
        x61 * (24500 * theta3_by_u * theta3_d2 * coupler - 18708 * along - 36750 * x45 - 27729 *
        x60 - x85)
    )
    rest2_q1_q2_q1_dot = x76 - x73
    rest2_q1_q2 = -x61 * (17 * x86 + x87)
    rest2_q1_q1_dot = x25 * (2 * theta3_by_u_d1 + 5 * theta3_d1)
    x88 = 384 * x4_by_uu
    x89 = 192 * x4_by_u
    rest2_q2_q2_q2 = (
        x41 * x88 - x31 * x88 - x31 * x89 - 96 * x39 + x41 * x89 + 384 * x44 - 480 * x46 - 256 *
        x48 - 192 * x49 + 192 * x51 + 320 * x53 + x57 + 128 * x70 + 128 * x71 - 192 * x83
    )
    rest2_q2_q2 = x25 * (x64 + x65)
    rest2_q2_q1_dot_q1_dot = x79 - 27 * x25
    rest2_q2_q1_dot = x80
    rest2_q2_q2_dot = x78
    rest2_q2 = x34 - x75 * theta3_d2 + x35 * x74 + x40 - x42 + 24 * x46 + 192 * x82 + x84
    rest2 = -x77
    x90 = q1 * q2
    x91 = 5 * mass11_q1_q2 / 9
    x92 = x90 * x91
    x93 = q1**2
    x94 = mass11_q1_q1 / 96
    x95 = q2**2
    x96 = mass11_q1 / 2
    x97 = mass12_q1 / 8
    x98 = 5 * mass11_q1_q2 / 18
    x99 = q2 / 4
    x100 = mass22_q2_q2 / 384
    x101 = 5 * rest1_q2 / 9
    x102 = q1 * q1_dot
    x103 = q2 * q2_dot
    x104 = q1_dot**2
    x105 = q2_dot**2
    x106 = q1**3
    x107 = q2**3
    x108 = q2_dot * x102
    x109 = q1_dot * x103
    x110 = q1 * x104
    x111 = q2 * x98
    x112 = q1 * x95
    x113 = q1 * x105
    x114 = rest1_q1_q1_q1_dot / 6
    x115 = q1_dot * x93
    x116 = q2 * x93
    x117 = 5 * q2_dot / 9
    x118 = q2 / 96
    x119 = x10 * x24 * damping
    return (
        mass11_q1 * q1 + mass11_q1_q2 / 2 + mass11_q2_q2 * x95 / 9 + x92 + x93 * x94,
        mass12_q1_q2 * x90 / 576 + q1 * x97 + q2 * x96 + x93 * x98 + x95 * x98,
        11 * mass11_q1_q2 * x93 / 144 + mass11_q1_q2 / 8 + mass12_q1 * x99 + x100 * x95 + x92,
        (
            2 * mass11_q2_q2 * x109 / 9 + 5 * q1 * q2_dot * rest1_q1_q2_dot / 8 + q1 * rest1_q1 /
            24 + q1 * rest1_q1_q2_q2_dot * x103 / 96 + q2 * x101 + rest1 / 2 + rest1_q1_q1 * x93 /
            36 + rest1_q1_q1_dot * x102 + rest1_q1_q1_q1 * x106 / 768 + rest1_q1_q1_q2 * x116 /
            1800 + rest1_q1_q1_q2_dot * x117 * x93 + 5 * rest1_q1_q2 * x90 / 64 +
            rest1_q1_q2_dot_q2_dot * x113 / 192 + rest1_q1_q2_q2 * x112 / 576 + rest1_q2_q2 * x95 /
            900 + rest1_q2_q2_dot * x103 + rest1_q2_q2_q2 * x107 / 44100 + rest1_q2_q2_q2_dot *
            x117 * x95 + x104 * x111 + x104 * x96 + x105 * x111 + x105 * x96 + x108 * x91 + x110 *
            x94 + x114 * x115
        ),
        (
            11 * mass11_q1_q2 * x108 / 72 + q1 * x101 + q1_dot * q2 * rest2_q2_q1_dot + 5 * q1_dot
            * rest1_q1_q1_q2_dot * x95 / 9 + q2 * rest2_q2_q1_dot_q1_dot * x104 / 192 + q2 * x100 *
            x105 + q2_dot * rest2_q2_q2_dot * x99 + q2_dot * x114 * x95 + 5 * rest1_q2_q2_q2_dot *
            x115 / 9 + rest2 / 4 + rest2_q1_q1 * x93 / 128 + rest2_q1_q1_dot * x102 / 8 +
            rest2_q1_q1_q1 * x106 / 1800 + rest2_q1_q1_q2 * x116 / 576 + rest2_q1_q2 * x90 / 450 +
            rest2_q1_q2_q1_dot * x102 * x118 + rest2_q1_q2_q2 * x112 / 44100 + rest2_q2 * x118 +
            rest2_q2_q2 * x95 / 144 + rest2_q2_q2_q2 * x107 / 3072 + x104 * x97 + x105 * x97 + x109
            * x91 + x110 * x98 + x113 * x98
        ),
        -q1_dot * x119 / 2, -q2_dot * x119 / 8,
    )


def variations(
    q1, q2, q1_dot, q2_dot, q1_ddot, q2_ddot, t, theta, theta_d1, theta_d2, crank, coupler, offset,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, slider_mass, bow, assembly,
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
    x22 = slider_mass * x4_by_u**2
    x23 = 9.869604401089358
    x24 = 1 / x23
    x25 = x20 * x24
    x26 = 45 * x25
    mass11_q1_q1 = x17 * x21 + x21 + 24 * x22 - x26
    mass11_q1_q2 = x25
    x28 = x25 * theta3_by_u
    mass11_q1 = -x28
    mass11_q2_q2 = -x25
    x29 = 48 * x20
    mass12_q1_q2 = x17 * x29 + 144 * x22 - 145 * x25 + x29
    mass12_q1 = x28
    x30 = 32 * x20
    mass22_q2_q2 = x17 * x30 + 96 * x22 - x26 + x30
    x31 = gravity_x * slider_mass
    x32 = 96 * x4_by_uu
    x33 = 48 * x4_by_u
    x34 = x31 * x33
    x35 = theta3_d1**2
    x36 = -x29 * x35
    x37 = mass_per_length * coupler**2
    x38 = x37 * along
    x39 = 24 * x38
    x40 = x4_d2 * slider_mass
    x41 = x33 * x40
    x42 = x4_by_u * slider_mass
    x43 = x42 * x4_by_u_d2
    x44 = across * theta3_by_u
    x45 = x37 * x44
    x46 = theta3_by_u_d1 * theta3_d1
    x47 = x20 * x46
    x48 = x37 * across * theta3_by_uu
    x49 = theta3_by_uu * theta3_d2
    x50 = x17 * x38
    x51 = x20 * theta3_by_u
    x52 = x51 * theta3_d2
    x53 = x25 * x35
    x54 = x28 * theta3_d2
    x55 = x25 * x46
    x56 = 245 * x53 - 240 * x54 + 240 * x55
    rest1_q1_q1_q1 = (
        x30 * theta3_by_u * theta3_by_u_d2 + x30 * x49 - x31 * x32 + x32 * x40 - x34 + x36 - x39 +
        x41 + 96 * x43 - 120 * x45 - 64 * x47 - 48 * x48 + 48 * x50 + 80 * x52 + x56
    )
    x57 = x46 * coupler
    x58 = 500 * x57
    x59 = x35 * coupler
    x60 = x24 * x37
    rest1_q1_q1_q2 = (
        x60 * (366 * along + 1000 * theta3_by_u * theta3_d2 * coupler - 1500 * x44 - x58 - 567 *
        x59)
    )
    rest1_q1_q1_q1_dot = x51 * theta3_by_u_d1 + 3 * x42 * x4_by_u_d1
    x61 = x28 * theta3_d1
    rest1_q1_q1_q2_dot = x61
    x62 = along * theta3_by_u
    x63 = 9 * theta3_by_u_d2
    x64 = 5 * theta3_d2
    rest1_q1_q1 = x60 * (28 * across - x63 * coupler - x64 * coupler - 54 * x62)
    x65 = 45 * theta3_d2
    x66 = 72 * x31
    x67 = 36 * x38
    x68 = 72 * x40
    x69 = x51 * theta3_by_u_d2
    x70 = x20 * x49
    x71 = (
        x17 * x67 - x29 * x46 + x36 + 72 * x43 - 108 * x45 - 36 * x48 - x66 * x4_by_u + x68 *
        x4_by_u - x66 * x4_by_uu + x68 * x4_by_uu + 72 * x52 + 119 * x53 - x67 + 24 * x69 + 24 *
        x70
    )
    rest1_q1_q2_q2 = 180 * x55 - x28 * x65 + x71
    x72 = x26 * theta3_by_u * theta3_d1
    x73 = 16 * x20
    x74 = x73 * theta3_by_u
    x75 = x33 * x4_by_u_d1 * slider_mass + x74 * theta3_by_u_d1
    rest1_q1_q2_q2_dot = x72 + x75
    rest1_q1_q2 = x25 * theta3_d2
    x76 = x25 * theta3_by_u_d1
    rest1_q1_q1_dot = -x76
    x77 = x17 * x73 + 48 * x22 + x73
    rest1_q1_q2_dot_q2_dot = x77 - 63 * x25
    x78 = x25 * theta3_d1
    rest1_q1_q2_dot = -x78
    x79 = 12 * x4_by_u
    x80 = x23 * x7 * bending_stiffness
    x81 = x20 * x35
    x82 = -15 * x53
    rest1_q1 = x31 * x79 + 6 * x38 - x40 * x79 + 6 * x45 - 4 * x52 + 12 * x80 + 4 * x81 + x82
    x83 = 12250 * x57
    rest1_q2_q2_q2 = -(6236 * along + 12250 * x44 + 9243 * x59 + x83) * x60
    rest1_q2_q2_q2_dot = -x61
    x84 = theta3_d2 * coupler
    x85 = 450 * x62 - 484 * across
    rest1_q2_q2 = -x60 * (225 * theta3_by_u_d2 * coupler + 467 * x84 + x85)
    rest1_q2_q2_dot = -(theta3_by_u_d1 + theta3_d1) * x25
    rest1_q2 = x60 * (2 * along + x59)
    rest2_q1_q1_q1 = x60 * (122 * along - 500 * x44 - x58 - 189 * x59)
    rest2_q1_q1_q2 = x26 * x46 - 180 * x54 + x71
    rest2_q1_q1 = x25 * (8 * theta3_by_u_d2 + x65)
    rest2_q1_q2_q2 = (
        x60 * (24500 * theta3_by_u * theta3_d2 * coupler - 18708 * along - 36750 * x44 - 27729 *
        x59 - x83)
    )
    rest2_q1_q2_q1_dot = x75 - x72
    rest2_q1_q2 = -x60 * (17 * x84 + x85)
    rest2_q1_q1_dot = x25 * (2 * theta3_by_u_d1 + 5 * theta3_d1)
    x86 = 384 * x4_by_uu
    x87 = 192 * x4_by_u
    rest2_q2_q2_q2 = (
        x40 * x86 - x31 * x86 - x31 * x87 - 96 * x38 + x40 * x87 + 384 * x43 - 480 * x45 - 256 *
        x47 - 192 * x48 + 192 * x50 + 320 * x52 + x56 + 128 * x69 + 128 * x70 - 192 * x81
    )
    rest2_q2_q2 = x25 * (x63 + x64)
    rest2_q2_q1_dot_q1_dot = x77 - 27 * x25
    rest2_q2_q1_dot = x78
    rest2_q2_q2_dot = x76
    rest2_q2 = x34 - x74 * theta3_d2 + x35 * x73 + x39 - x41 + 24 * x45 + 192 * x80 + x82
    x88 = q1**2
    x89 = rest1_q1_q1_q1_dot / 6
    x90 = x10 * x24 * damping
    x91 = mass11_q1_q1 * q1 / 48
    x92 = 2 * mass11_q2_q2 / 9
    x93 = q2 * x92
    x94 = 5 * mass11_q1_q2 / 9
    x95 = q1 * x94
    x96 = q2 * x94
    x97 = q1_dot * x96 + q2_dot * x95
    x98 = 5 * rest1_q1_q2_dot / 8
    x99 = 5 * rest1_q1_q1_q2_dot / 9
    x100 = q2**2
    x101 = 5 * rest1_q2_q2_q2_dot / 9
    x102 = q1 / 96
    x103 = q2 * x102
    x104 = q2_dot * x102
    x105 = q1_dot * x95 + q2_dot * x96
    x106 = mass12_q1 / 4
    x107 = rest2_q1_q1_dot / 8
    x108 = q2 / 96
    x109 = q1_dot * x108
    x110 = 11 * mass11_q1_q2 / 72
    x111 = q1 * x110
    x112 = rest2_q2_q2_dot / 4
    x113 = mass22_q2_q2 * q2 / 192
    x114 = 5 * rest1_q1_q2 / 64
    x115 = q1_dot * q2_dot
    x116 = x115 * x94
    x117 = q1 * q1_dot
    x118 = rest1_q1_q1_q1_dot / 3
    x119 = q1 * q2
    x120 = 10 * q2_dot / 9
    x121 = q1_dot**2
    x122 = q2_dot**2
    x123 = mass12_q1_q2 / 576
    x124 = mass12_q1 / 8 + q2 * x123 + x95
    x125 = mass11_q1 / 2 + q1 * x123 + x96
    x126 = q2 / 450
    x127 = x119 / 288
    x128 = 5 * mass11_q1_q2 / 18
    x129 = 5 * rest1_q2 / 9 + x121 * x128 + x122 * x128
    return (
        (
            mass11_q1 * q1_dot + q1 * rest1_q1_q1_dot + q1_dot * x91 + q2_dot * x93 + x88 * x89 +
            x90 / 2 + x97
        ),
        (
            mass11_q1 * q2_dot + q1 * x98 + q1_dot * x93 + q2 * rest1_q2_q2_dot +
            rest1_q1_q2_dot_q2_dot * x104 + rest1_q1_q2_q2_dot * x103 + x100 * x101 + x105 + x88 *
            x99
        ),
        (
            q1 * x107 + q1_dot * x106 + q2 * rest2_q2_q1_dot + q2_dot * x111 + rest2_q1_q2_q1_dot *
            x103 + rest2_q2_q1_dot_q1_dot * x109 + x100 * x99 + x101 * x88 + x105
        ),
        q1_dot * x111 + q2 * x112 + q2_dot * x106 + q2_dot * x113 + x100 * x89 + x90 / 8 + x97,
        (
            mass11_q1_q1 * x121 / 96 + q1 * rest1_q1_q1 / 18 + q1 * rest1_q1_q1_q2_dot * x120 +
            (mass11_q1 + x91 + x96) * q1_ddot + q1_dot * rest1_q1_q1_dot + q2 * x114 + x124 *
            q2_ddot + q2_dot * rest1_q1_q2_q2_dot * x108 + q2_dot * x98 + rest1_q1 / 24 +
            rest1_q1_q1_q1 * x88 / 256 + rest1_q1_q1_q2 * x119 / 900 + rest1_q1_q2_dot_q2_dot *
            x122 / 192 + rest1_q1_q2_q2 * x100 / 576 + x116 + x117 * x118
        ),
        (
            q1 * x114 + (x93 + x95) * q1_ddot + q2 * rest1_q2_q2_q2_dot * x120 + x125 * q2_ddot +
            q2_dot * rest1_q2_q2_dot + rest1_q1_q1_q2 * x88 / 1800 + rest1_q1_q2_q2 * x127 +
            rest1_q1_q2_q2_dot * x104 + rest1_q2_q2 * x126 + rest1_q2_q2_q2 * x100 / 14700 + x115 *
            x92 + x129
        ),
        (
            q1 * rest2_q1_q1 / 64 + x124 * q1_ddot + q1_dot * x107 + (x111 + x96) * q2_ddot + 10 *
            rest1_q2_q2_q2_dot * x117 / 9 + rest2_q1_q1_q1 * x88 / 600 + rest2_q1_q1_q2 * x127 +
            rest2_q1_q2 * x126 + rest2_q1_q2_q1_dot * x109 + rest2_q1_q2_q2 * x100 / 44100 + x110 *
            x115 + x129
        ),
        (
            mass22_q2_q2 * x122 / 384 + q1 * rest2_q1_q2 / 450 + x125 * q1_ddot + 10 * q1_dot * q2
            * rest1_q1_q1_q2_dot / 9 + q1_dot * rest2_q1_q2_q1_dot * x102 + q1_dot *
            rest2_q2_q1_dot + q2 * q2_dot * x118 + q2 * rest2_q2_q2 / 72 + (x106 + x113 + x95) *
            q2_ddot + q2_dot * x112 + rest2_q1_q1_q2 * x88 / 576 + rest2_q1_q2_q2 * x119 / 22050 +
            rest2_q2 / 96 + rest2_q2_q1_dot_q1_dot * x121 / 192 + rest2_q2_q2_q2 * x100 / 1024 +
            x116
        ),
    )
