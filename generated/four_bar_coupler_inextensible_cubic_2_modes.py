"""Inextensible flexible coupler of a four-bar linkage, to third order in its amplitudes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation inextensible_cubic, flexible coupler, 2 modes.
Equations: Smith 9.6, further work 2.

Angle of the coupler's tangent: a mean and sum q_k cos(k pi s), s from 0 at the crank to 1.
Derivatives by_u are those by the chord's length over the coupler's.

Cost per evaluation:
    dynamics: 789 operations
    variations: 831 operations
Content hash 665f8471de1ec6bd8322eab30e9c4570; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible_cubic","mechanism'
    '":"four_bar","modes":2,"outputs":[]}'
)
CONTENT = "665f8471de1ec6bd8322eab30e9c4570"

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
    "bow": ("m", "Deflection of the unloaded coupler's middle"),
    "assembly": ("", "+1 for the open, -1 for the crossed assembly"),
    "q1": ("rad", "Amplitude of cos(1 pi s)"),
    "q2": ("rad", "Amplitude of cos(2 pi s)"),
    "t": ("s", "Time"),
    "theta": ("rad", "Crank angle"),
    "theta_d1": ("rad/s", "Crank speed"),
    "theta_d2": ("rad/s^2", "Crank acceleration"),
}
PARAMETERS = (
    "frame", "crank", "coupler", "follower", "bending_stiffness", "mass_per_length", "damping",
    "gravity_x", "gravity_y", "follower_inertia", "follower_first_moment", "bow", "assembly",
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
    q1, q2, q1_dot, q2_dot, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, follower_inertia,
    follower_first_moment, bow, assembly,
):
    """Return everything in the equations of motion at acceleration level.

    q1 to theta_d2 : float or ndarray, shape (...)
    frame to assembly : float
    Returns float or ndarray each.
    """
    xp = _namespace(q1)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    cos2 = x1 - x2
    diagonal_x = x2 * far + x1 * near
    x3 = sin2 * crank
    diagonal_y = -x3
    diagonal2 = x2 * far**2 + x1 * near**2
    x4 = folded * straight
    p = diagonal2 + x4
    q = diagonal2 - x4
    stretch = (
        -(near + straight) * x1 * (near - straight) - x2 * (far + straight) * (far - straight)
    )
    fold = -(folded + near) * x1 * (folded - near) + x2 * (far + folded) * (far - folded)
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    x6 = 2 * follower
    x7 = sine_transmission * coupler
    area = x6 * x7
    x8 = area * diagonal_y
    x9 = 1 / coupler
    x10 = 0.5 / diagonal2
    x11 = x10 * x9
    cos3 = x11 * (diagonal_x * p - x8)
    x12 = area * diagonal_x
    sin3 = x11 * (diagonal_y * p + x12)
    x13 = 1 / follower
    x14 = x10 * x13
    cos4 = -(diagonal_x * q + x8) * x14
    sin4 = (x12 - diagonal_y * q) * x14
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    x15 = 1 / far
    share = x15 * crank
    reduced = share * frame
    x16 = 1 / sine_transmission
    x17 = x16 * x9
    excess3 = (sin24 - sin4) * x17
    x18 = excess3 * reduced
    omega3 = share + x18
    x19 = -x15 * frame
    slip3 = -x18 - x19
    x20 = x13 * x16
    excess4 = (sin23 - sin3) * x20
    x21 = excess4 * reduced
    omega4 = share + x21
    slip4 = -x19 - x21
    spread = x13 * x17 * x3 * frame
    x22 = x16 * cosine_transmission
    x23 = x22 * spread
    alpha3 = -reduced * (x23 * excess3 + x17 * (cos4 * omega4 - cos24 * slip4))
    alpha4 = -reduced * (x23 * excess4 + x20 * (cos3 * omega3 - cos23 * slip3))
    theta3_by_u = -x22
    psi_by_u = -x20 * coupler
    x24 = omega3 * coupler
    x25 = psi_by_u * follower
    x26 = x25 * omega4
    theta3_by_u_speed = (
        x17 * (cosine_transmission * omega3 * theta3_by_u * coupler - x24 * sine_transmission -
        x26)
    )
    psi_by_u_speed = x20 * (omega3 * theta3_by_u * coupler - x26 * cosine_transmission)
    x27 = alpha3 * coupler
    x28 = x25 * alpha4
    x29 = x6 * omega4 * psi_by_u_speed
    x30 = x27 * theta3_by_u
    x31 = coupler * omega3**2
    x32 = 2 * x24 * theta3_by_u_speed
    theta3_by_u_bend = (
        x17 * (x30 * cosine_transmission + x31 * cosine_transmission + x32 * cosine_transmission +
        x31 * sine_transmission * theta3_by_u - x27 * sine_transmission - x28 - x29)
    )
    psi_by_u_bend = (
        x20 * (x25 * sine_transmission * omega4**2 - x28 * cosine_transmission - x29 *
        cosine_transmission + x30 + x31 + x32)
    )
    x33 = psi_by_u**2
    x34 = x33 * follower
    x35 = theta3_by_u**2
    theta3_by_uu = x17 * (x35 * cosine_transmission * coupler - 2 * x7 * theta3_by_u - x34)
    psi_by_uu = x20 * (x35 * coupler - x34 * cosine_transmission)
    theta3_d1 = theta_d1 * omega3
    x36 = theta_d1**2
    theta3_d2 = x36 * alpha3 + theta_d2 * omega3
    psi_d2 = x36 * alpha4 + theta_d2 * omega4
    theta3_by_u_d1 = theta_d1 * theta3_by_u_speed
    theta3_by_u_d2 = x36 * theta3_by_u_bend + theta_d2 * theta3_by_u_speed
    psi_by_u_d1 = theta_d1 * psi_by_u_speed
    psi_by_u_d2 = x36 * psi_by_u_bend + theta_d2 * psi_by_u_speed
    x37 = cos23 * crank
    along = cos3 * gravity_x + theta_d2 * sin23 * crank + gravity_y * sin3 + x36 * x37
    across = cos3 * gravity_y + x36 * sin23 * crank - gravity_x * sin3 - theta_d2 * x37
    x38 = coupler**3
    x39 = x38 * mass_per_length
    x40 = 8 * x39
    x41 = x33 * follower_inertia
    x42 = 9.869604401089358
    x43 = 1 / x42
    x44 = x39 * x43
    x45 = 45 * x44
    mass11_q1_q1 = x35 * x40 + x40 + 24 * x41 - x45
    mass11_q1_q2 = x44
    x47 = x44 * theta3_by_u
    mass11_q1 = -x47
    mass11_q2_q2 = -x44
    x48 = 48 * x39
    mass12_q1_q2 = x35 * x48 + 144 * x41 - 145 * x44 + x48
    mass12_q1 = x47
    x49 = 32 * x39
    mass22_q2_q2 = x35 * x49 + 96 * x41 - x45 + x49
    x50 = theta3_d1**2
    x51 = -x48 * x50
    x52 = coupler**2
    x53 = x52 * mass_per_length
    x54 = x53 * along
    x55 = 24 * x54
    x56 = psi_by_u * follower_inertia
    x57 = x56 * psi_d2
    x58 = 48 * x57
    x59 = x56 * psi_by_u_d2
    x60 = 96 * psi_by_uu
    x61 = psi_d2 * follower_inertia
    x62 = across * theta3_by_u
    x63 = x53 * x62
    x64 = cos4 * follower_first_moment
    x65 = x64 * gravity_y
    x66 = theta3_by_u_d1 * theta3_d1
    x67 = x39 * x66
    x68 = x53 * across * theta3_by_uu
    x69 = 48 * psi_by_u
    x70 = x65 * x69
    x71 = theta3_by_uu * theta3_d2
    x72 = x35 * x54
    x73 = follower_first_moment * sin4
    x74 = x73 * gravity_x
    x75 = x69 * x74
    x76 = x39 * theta3_by_u
    x77 = x76 * theta3_d2
    x78 = 96 * x33
    x79 = x64 * gravity_x
    x80 = x73 * gravity_y
    x81 = x44 * x50
    x82 = x47 * theta3_d2
    x83 = x44 * x66
    x84 = 245 * x81 - 240 * x82 + 240 * x83
    rest1_q1_q1_q1 = (
        x49 * theta3_by_u * theta3_by_u_d2 + x49 * x71 + x51 - x55 + x58 + 96 * x59 + x60 * x61 -
        x60 * x65 + x60 * x74 - 120 * x63 - 64 * x67 - 48 * x68 - x70 + 48 * x72 + x75 + 80 * x77 +
        x78 * x79 + x78 * x80 + x84
    )
    x85 = x66 * coupler
    x86 = 500 * x85
    x87 = x50 * coupler
    x88 = x43 * x53
    rest1_q1_q1_q2 = (
        x88 * (366 * along + 1000 * theta3_by_u * theta3_d2 * coupler - 1500 * x62 - x86 - 567 *
        x87)
    )
    x89 = x56 * psi_by_u_d1
    rest1_q1_q1_q1_dot = x76 * theta3_by_u_d1 + 3 * x89
    x90 = x47 * theta3_d1
    rest1_q1_q1_q2_dot = x90
    x91 = along * theta3_by_u
    x92 = 9 * theta3_by_u_d2
    x93 = 5 * theta3_d2
    rest1_q1_q1 = x88 * (28 * across - x92 * coupler - x93 * coupler - 54 * x91)
    x94 = 45 * theta3_d2
    x95 = 36 * x54
    x96 = x61 * psi_by_uu
    x97 = 72 * x65
    x98 = x76 * theta3_by_u_d2
    x99 = x39 * x71
    x100 = 72 * x33
    x101 = 72 * x74
    x102 = (
        x101 * psi_by_u - x97 * psi_by_u + x101 * psi_by_uu - x97 * psi_by_uu + x100 * x79 + x100 *
        x80 + x35 * x95 - x48 * x66 + x51 + 72 * x57 + 72 * x59 - 108 * x63 - 36 * x68 + 72 * x77 +
        119 * x81 - x95 + 72 * x96 + 24 * x98 + 24 * x99
    )
    rest1_q1_q2_q2 = x102 - x47 * x94 + 180 * x83
    x103 = x45 * theta3_by_u * theta3_d1
    x104 = 16 * x39
    x105 = x104 * theta3_by_u
    x106 = x105 * theta3_by_u_d1 + 48 * x89
    rest1_q1_q2_q2_dot = x103 + x106
    x107 = x44 * theta3_d2
    rest1_q1_q2 = x107
    x108 = x44 * theta3_by_u_d1
    rest1_q1_q1_dot = -x108
    x109 = x104 * x35 + x104 + 48 * x41
    rest1_q1_q2_dot_q2_dot = x109 - 63 * x44
    x110 = x44 * theta3_d1
    rest1_q1_q2_dot = -x110
    x111 = 12 * psi_by_u
    x112 = x42 * x9 * bending_stiffness
    x113 = x39 * x50
    x114 = -15 * x81
    rest1_q1 = (
        x111 * x65 - x111 * x74 + 12 * x112 + 4 * x113 + x114 + 6 * x54 - 12 * x57 + 6 * x63 - 4 *
        x77
    )
    x115 = 12250 * x85
    rest1_q2_q2_q2 = -(6236 * along + x115 + 12250 * x62 + 9243 * x87) * x88
    rest1_q2_q2_q2_dot = -x90
    x116 = theta3_d2 * coupler
    x117 = 450 * x91 - 484 * across
    rest1_q2_q2 = -x88 * (225 * theta3_by_u_d2 * coupler + 467 * x116 + x117)
    rest1_q2_q2_dot = -(theta3_by_u_d1 + theta3_d1) * x44
    rest1_q2 = x88 * (2 * along + x87)
    rest1 = (
        2 * x38 * x43 * theta3_d2 * mass_per_length - 4 * x88 * across - 31.00627668029982 * bow *
        bending_stiffness / x52
    )
    rest2_q1_q1_q1 = x88 * (122 * along - 500 * x62 - x86 - 189 * x87)
    rest2_q1_q1_q2 = x102 + x45 * x66 - 180 * x82
    rest2_q1_q1 = x44 * (8 * theta3_by_u_d2 + x94)
    rest2_q1_q2_q2 = (
        x88 * (24500 * theta3_by_u * theta3_d2 * coupler - 18708 * along - x115 - 36750 * x62 -
        27729 * x87)
    )
    rest2_q1_q2_q1_dot = x106 - x103
    rest2_q1_q2 = -x88 * (17 * x116 + x117)
    rest2_q1_q1_dot = x44 * (2 * theta3_by_u_d1 + 5 * theta3_d1)
    x118 = 384 * psi_by_uu
    x119 = 192 * psi_by_u
    x120 = 384 * x33
    rest2_q2_q2_q2 = (
        x118 * x74 - 192 * x113 - x118 * x65 - x119 * x65 + x119 * x74 + x120 * x79 + x120 * x80 -
        96 * x54 + 192 * x57 + 384 * x59 - 480 * x63 - 256 * x67 - 192 * x68 + 192 * x72 + 320 *
        x77 + x84 + 384 * x96 + 128 * x98 + 128 * x99
    )
    rest2_q2_q2 = x44 * (x92 + x93)
    rest2_q2_q1_dot_q1_dot = x109 - 27 * x44
    rest2_q2_q1_dot = x110
    rest2_q2_q2_dot = x108
    rest2_q2 = x104 * x50 - x105 * theta3_d2 + 192 * x112 + x114 + x55 - x58 + 24 * x63 + x70 - x75
    rest2 = -x107
    x121 = q1 * q2
    x122 = 5 * mass11_q1_q2 / 9
    x123 = x121 * x122
    x124 = q1**2
    x125 = mass11_q1_q1 / 96
    x126 = q2**2
    x127 = mass11_q1 / 2
    x128 = mass12_q1 / 8
    x129 = 5 * mass11_q1_q2 / 18
    x130 = q2 / 4
    x131 = mass22_q2_q2 / 384
    x132 = 5 * rest1_q2 / 9
    x133 = q1 * q1_dot
    x134 = q2 * q2_dot
    x135 = q1_dot**2
    x136 = q2_dot**2
    x137 = q1**3
    x138 = q2**3
    x139 = q2_dot * x133
    x140 = q1_dot * x134
    x141 = q1 * x135
    x142 = q2 * x129
    x143 = q1 * x126
    x144 = q1 * x136
    x145 = rest1_q1_q1_q1_dot / 6
    x146 = q1_dot * x124
    x147 = q2 * x124
    x148 = 5 * q2_dot / 9
    x149 = q2 / 96
    x150 = x38 * x43 * damping
    return (
        mass11_q1 * q1 + mass11_q1_q2 / 2 + mass11_q2_q2 * x126 / 9 + x123 + x124 * x125,
        mass12_q1_q2 * x121 / 576 + q1 * x128 + q2 * x127 + x124 * x129 + x126 * x129,
        11 * mass11_q1_q2 * x124 / 144 + mass11_q1_q2 / 8 + mass12_q1 * x130 + x123 + x126 * x131,
        (
            2 * mass11_q2_q2 * x140 / 9 + 5 * q1 * q2_dot * rest1_q1_q2_dot / 8 + q1 * rest1_q1 /
            24 + q1 * rest1_q1_q2_q2_dot * x134 / 96 + q2 * x132 + rest1 / 2 + rest1_q1_q1 * x124 /
            36 + rest1_q1_q1_dot * x133 + rest1_q1_q1_q1 * x137 / 768 + rest1_q1_q1_q2 * x147 /
            1800 + rest1_q1_q1_q2_dot * x124 * x148 + 5 * rest1_q1_q2 * x121 / 64 +
            rest1_q1_q2_dot_q2_dot * x144 / 192 + rest1_q1_q2_q2 * x143 / 576 + rest1_q2_q2 * x126
            / 900 + rest1_q2_q2_dot * x134 + rest1_q2_q2_q2 * x138 / 44100 + rest1_q2_q2_q2_dot *
            x126 * x148 + x122 * x139 + x125 * x141 + x127 * x135 + x127 * x136 + x135 * x142 +
            x136 * x142 + x145 * x146
        ),
        (
            11 * mass11_q1_q2 * x139 / 72 + q1 * x132 + q1_dot * q2 * rest2_q2_q1_dot + 5 * q1_dot
            * rest1_q1_q1_q2_dot * x126 / 9 + q2 * rest2_q2_q1_dot_q1_dot * x135 / 192 + q2 * x131
            * x136 + q2_dot * rest2_q2_q2_dot * x130 + q2_dot * x126 * x145 + 5 *
            rest1_q2_q2_q2_dot * x146 / 9 + rest2 / 4 + rest2_q1_q1 * x124 / 128 + rest2_q1_q1_dot
            * x133 / 8 + rest2_q1_q1_q1 * x137 / 1800 + rest2_q1_q1_q2 * x147 / 576 + rest2_q1_q2 *
            x121 / 450 + rest2_q1_q2_q1_dot * x133 * x149 + rest2_q1_q2_q2 * x143 / 44100 +
            rest2_q2 * x149 + rest2_q2_q2 * x126 / 144 + rest2_q2_q2_q2 * x138 / 3072 + x122 * x140
            + x128 * x135 + x128 * x136 + x129 * x141 + x129 * x144
        ),
        -q1_dot * x150 / 2, -q2_dot * x150 / 8,
    )


def variations(
    q1, q2, q1_dot, q2_dot, q1_ddot, q2_ddot, t, theta, theta_d1, theta_d2, frame, crank, coupler,
    follower, bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, follower_inertia,
    follower_first_moment, bow, assembly,
):
    """Return the arrays of the motion linearised about a given one.

    q1 to theta_d2 : float or ndarray, shape (...)
    frame to assembly : float
    Returns float or ndarray each.
    """
    xp = _namespace(q1)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    cos2 = x1 - x2
    diagonal_x = x2 * far + x1 * near
    x3 = sin2 * crank
    diagonal_y = -x3
    diagonal2 = x2 * far**2 + x1 * near**2
    x4 = folded * straight
    p = diagonal2 + x4
    q = diagonal2 - x4
    stretch = (
        -(near + straight) * x1 * (near - straight) - x2 * (far + straight) * (far - straight)
    )
    fold = -(folded + near) * x1 * (folded - near) + x2 * (far + folded) * (far - folded)
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    x6 = 2 * follower
    x7 = sine_transmission * coupler
    area = x6 * x7
    x8 = area * diagonal_y
    x9 = 1 / coupler
    x10 = 0.5 / diagonal2
    x11 = x10 * x9
    cos3 = x11 * (diagonal_x * p - x8)
    x12 = area * diagonal_x
    sin3 = x11 * (diagonal_y * p + x12)
    x13 = 1 / follower
    x14 = x10 * x13
    cos4 = -(diagonal_x * q + x8) * x14
    sin4 = (x12 - diagonal_y * q) * x14
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    x15 = 1 / far
    share = x15 * crank
    reduced = share * frame
    x16 = 1 / sine_transmission
    x17 = x16 * x9
    excess3 = (sin24 - sin4) * x17
    x18 = excess3 * reduced
    omega3 = share + x18
    x19 = -x15 * frame
    slip3 = -x18 - x19
    x20 = x13 * x16
    excess4 = (sin23 - sin3) * x20
    x21 = excess4 * reduced
    omega4 = share + x21
    slip4 = -x19 - x21
    spread = x13 * x17 * x3 * frame
    x22 = x16 * cosine_transmission
    x23 = x22 * spread
    alpha3 = -reduced * (x23 * excess3 + x17 * (cos4 * omega4 - cos24 * slip4))
    alpha4 = -reduced * (x23 * excess4 + x20 * (cos3 * omega3 - cos23 * slip3))
    theta3_by_u = -x22
    psi_by_u = -x20 * coupler
    x24 = omega3 * coupler
    x25 = psi_by_u * follower
    x26 = x25 * omega4
    theta3_by_u_speed = (
        x17 * (cosine_transmission * omega3 * theta3_by_u * coupler - x24 * sine_transmission -
        x26)
    )
    psi_by_u_speed = x20 * (omega3 * theta3_by_u * coupler - x26 * cosine_transmission)
    x27 = alpha3 * coupler
    x28 = x25 * alpha4
    x29 = x6 * omega4 * psi_by_u_speed
    x30 = x27 * theta3_by_u
    x31 = coupler * omega3**2
    x32 = 2 * x24 * theta3_by_u_speed
    theta3_by_u_bend = (
        x17 * (x30 * cosine_transmission + x31 * cosine_transmission + x32 * cosine_transmission +
        x31 * sine_transmission * theta3_by_u - x27 * sine_transmission - x28 - x29)
    )
    psi_by_u_bend = (
        x20 * (x25 * sine_transmission * omega4**2 - x28 * cosine_transmission - x29 *
        cosine_transmission + x30 + x31 + x32)
    )
    x33 = psi_by_u**2
    x34 = x33 * follower
    x35 = theta3_by_u**2
    theta3_by_uu = x17 * (x35 * cosine_transmission * coupler - 2 * x7 * theta3_by_u - x34)
    psi_by_uu = x20 * (x35 * coupler - x34 * cosine_transmission)
    theta3_d1 = theta_d1 * omega3
    x36 = theta_d1**2
    theta3_d2 = x36 * alpha3 + theta_d2 * omega3
    psi_d2 = x36 * alpha4 + theta_d2 * omega4
    theta3_by_u_d1 = theta_d1 * theta3_by_u_speed
    theta3_by_u_d2 = x36 * theta3_by_u_bend + theta_d2 * theta3_by_u_speed
    psi_by_u_d1 = theta_d1 * psi_by_u_speed
    psi_by_u_d2 = x36 * psi_by_u_bend + theta_d2 * psi_by_u_speed
    x37 = cos23 * crank
    along = cos3 * gravity_x + theta_d2 * sin23 * crank + gravity_y * sin3 + x36 * x37
    across = cos3 * gravity_y + x36 * sin23 * crank - gravity_x * sin3 - theta_d2 * x37
    x38 = coupler**3
    x39 = x38 * mass_per_length
    x40 = 8 * x39
    x41 = x33 * follower_inertia
    x42 = 9.869604401089358
    x43 = 1 / x42
    x44 = x39 * x43
    x45 = 45 * x44
    mass11_q1_q1 = x35 * x40 + x40 + 24 * x41 - x45
    mass11_q1_q2 = x44
    x47 = x44 * theta3_by_u
    mass11_q1 = -x47
    mass11_q2_q2 = -x44
    x48 = 48 * x39
    mass12_q1_q2 = x35 * x48 + 144 * x41 - 145 * x44 + x48
    mass12_q1 = x47
    x49 = 32 * x39
    mass22_q2_q2 = x35 * x49 + 96 * x41 - x45 + x49
    x50 = theta3_d1**2
    x51 = -x48 * x50
    x52 = mass_per_length * coupler**2
    x53 = x52 * along
    x54 = 24 * x53
    x55 = psi_by_u * follower_inertia
    x56 = x55 * psi_d2
    x57 = 48 * x56
    x58 = x55 * psi_by_u_d2
    x59 = 96 * psi_by_uu
    x60 = psi_d2 * follower_inertia
    x61 = across * theta3_by_u
    x62 = x52 * x61
    x63 = cos4 * follower_first_moment
    x64 = x63 * gravity_y
    x65 = theta3_by_u_d1 * theta3_d1
    x66 = x39 * x65
    x67 = x52 * across * theta3_by_uu
    x68 = 48 * psi_by_u
    x69 = x64 * x68
    x70 = theta3_by_uu * theta3_d2
    x71 = x35 * x53
    x72 = follower_first_moment * sin4
    x73 = x72 * gravity_x
    x74 = x68 * x73
    x75 = x39 * theta3_by_u
    x76 = x75 * theta3_d2
    x77 = 96 * x33
    x78 = x63 * gravity_x
    x79 = x72 * gravity_y
    x80 = x44 * x50
    x81 = x47 * theta3_d2
    x82 = x44 * x65
    x83 = 245 * x80 - 240 * x81 + 240 * x82
    rest1_q1_q1_q1 = (
        x49 * theta3_by_u * theta3_by_u_d2 + x49 * x70 + x51 - x54 + x57 + 96 * x58 + x59 * x60 -
        x59 * x64 + x59 * x73 - 120 * x62 - 64 * x66 - 48 * x67 - x69 + 48 * x71 + x74 + 80 * x76 +
        x77 * x78 + x77 * x79 + x83
    )
    x84 = x65 * coupler
    x85 = 500 * x84
    x86 = x50 * coupler
    x87 = x43 * x52
    rest1_q1_q1_q2 = (
        x87 * (366 * along + 1000 * theta3_by_u * theta3_d2 * coupler - 1500 * x61 - x85 - 567 *
        x86)
    )
    x88 = x55 * psi_by_u_d1
    rest1_q1_q1_q1_dot = x75 * theta3_by_u_d1 + 3 * x88
    x89 = x47 * theta3_d1
    rest1_q1_q1_q2_dot = x89
    x90 = along * theta3_by_u
    x91 = 9 * theta3_by_u_d2
    x92 = 5 * theta3_d2
    rest1_q1_q1 = x87 * (28 * across - x91 * coupler - x92 * coupler - 54 * x90)
    x93 = 45 * theta3_d2
    x94 = 36 * x53
    x95 = x60 * psi_by_uu
    x96 = 72 * x64
    x97 = x75 * theta3_by_u_d2
    x98 = x39 * x70
    x99 = 72 * x33
    x100 = 72 * x73
    x101 = (
        x100 * psi_by_u - x96 * psi_by_u + x100 * psi_by_uu - x96 * psi_by_uu + x35 * x94 - x48 *
        x65 + x51 + 72 * x56 + 72 * x58 - 108 * x62 - 36 * x67 + 72 * x76 + x78 * x99 + x79 * x99 +
        119 * x80 - x94 + 72 * x95 + 24 * x97 + 24 * x98
    )
    rest1_q1_q2_q2 = x101 - x47 * x93 + 180 * x82
    x102 = x45 * theta3_by_u * theta3_d1
    x103 = 16 * x39
    x104 = x103 * theta3_by_u
    x105 = x104 * theta3_by_u_d1 + 48 * x88
    rest1_q1_q2_q2_dot = x102 + x105
    rest1_q1_q2 = x44 * theta3_d2
    x106 = x44 * theta3_by_u_d1
    rest1_q1_q1_dot = -x106
    x107 = x103 * x35 + x103 + 48 * x41
    rest1_q1_q2_dot_q2_dot = x107 - 63 * x44
    x108 = x44 * theta3_d1
    rest1_q1_q2_dot = -x108
    x109 = 12 * psi_by_u
    x110 = x42 * x9 * bending_stiffness
    x111 = x39 * x50
    x112 = -15 * x80
    rest1_q1 = (
        x109 * x64 - x109 * x73 + 12 * x110 + 4 * x111 + x112 + 6 * x53 - 12 * x56 + 6 * x62 - 4 *
        x76
    )
    x113 = 12250 * x84
    rest1_q2_q2_q2 = -(6236 * along + x113 + 12250 * x61 + 9243 * x86) * x87
    rest1_q2_q2_q2_dot = -x89
    x114 = theta3_d2 * coupler
    x115 = 450 * x90 - 484 * across
    rest1_q2_q2 = -x87 * (225 * theta3_by_u_d2 * coupler + 467 * x114 + x115)
    rest1_q2_q2_dot = -(theta3_by_u_d1 + theta3_d1) * x44
    rest1_q2 = x87 * (2 * along + x86)
    rest2_q1_q1_q1 = x87 * (122 * along - 500 * x61 - x85 - 189 * x86)
    rest2_q1_q1_q2 = x101 + x45 * x65 - 180 * x81
    rest2_q1_q1 = x44 * (8 * theta3_by_u_d2 + x93)
    rest2_q1_q2_q2 = (
        x87 * (24500 * theta3_by_u * theta3_d2 * coupler - 18708 * along - x113 - 36750 * x61 -
        27729 * x86)
    )
    rest2_q1_q2_q1_dot = x105 - x102
    rest2_q1_q2 = -x87 * (17 * x114 + x115)
    rest2_q1_q1_dot = x44 * (2 * theta3_by_u_d1 + 5 * theta3_d1)
    x116 = 384 * psi_by_uu
    x117 = 192 * psi_by_u
    x118 = 384 * x33
    rest2_q2_q2_q2 = (
        x116 * x73 - 192 * x111 - x116 * x64 - x117 * x64 + x117 * x73 + x118 * x78 + x118 * x79 -
        96 * x53 + 192 * x56 + 384 * x58 - 480 * x62 - 256 * x66 - 192 * x67 + 192 * x71 + 320 *
        x76 + x83 + 384 * x95 + 128 * x97 + 128 * x98
    )
    rest2_q2_q2 = x44 * (x91 + x92)
    rest2_q2_q1_dot_q1_dot = x107 - 27 * x44
    rest2_q2_q1_dot = x108
    rest2_q2_q2_dot = x106
    rest2_q2 = x103 * x50 - x104 * theta3_d2 + 192 * x110 + x112 + x54 - x57 + 24 * x62 + x69 - x74
    x119 = q1**2
    x120 = rest1_q1_q1_q1_dot / 6
    x121 = x38 * x43 * damping
    x122 = mass11_q1_q1 * q1 / 48
    x123 = 2 * mass11_q2_q2 / 9
    x124 = q2 * x123
    x125 = 5 * mass11_q1_q2 / 9
    x126 = q1 * x125
    x127 = q2 * x125
    x128 = q1_dot * x127 + q2_dot * x126
    x129 = 5 * rest1_q1_q2_dot / 8
    x130 = 5 * rest1_q1_q1_q2_dot / 9
    x131 = q2**2
    x132 = 5 * rest1_q2_q2_q2_dot / 9
    x133 = q1 / 96
    x134 = q2 * x133
    x135 = q2_dot * x133
    x136 = q1_dot * x126 + q2_dot * x127
    x137 = mass12_q1 / 4
    x138 = rest2_q1_q1_dot / 8
    x139 = q2 / 96
    x140 = q1_dot * x139
    x141 = 11 * mass11_q1_q2 / 72
    x142 = q1 * x141
    x143 = rest2_q2_q2_dot / 4
    x144 = mass22_q2_q2 * q2 / 192
    x145 = 5 * rest1_q1_q2 / 64
    x146 = q1_dot * q2_dot
    x147 = x125 * x146
    x148 = q1 * q1_dot
    x149 = rest1_q1_q1_q1_dot / 3
    x150 = q1 * q2
    x151 = 10 * q2_dot / 9
    x152 = q1_dot**2
    x153 = q2_dot**2
    x154 = mass12_q1_q2 / 576
    x155 = mass12_q1 / 8 + q2 * x154 + x126
    x156 = mass11_q1 / 2 + q1 * x154 + x127
    x157 = q2 / 450
    x158 = x150 / 288
    x159 = 5 * mass11_q1_q2 / 18
    x160 = 5 * rest1_q2 / 9 + x152 * x159 + x153 * x159
    return (
        (
            mass11_q1 * q1_dot + q1 * rest1_q1_q1_dot + q1_dot * x122 + q2_dot * x124 + x119 * x120
            + x121 / 2 + x128
        ),
        (
            mass11_q1 * q2_dot + q1 * x129 + q1_dot * x124 + q2 * rest1_q2_q2_dot +
            rest1_q1_q2_dot_q2_dot * x135 + rest1_q1_q2_q2_dot * x134 + x119 * x130 + x131 * x132 +
            x136
        ),
        (
            q1 * x138 + q1_dot * x137 + q2 * rest2_q2_q1_dot + q2_dot * x142 + rest2_q1_q2_q1_dot *
            x134 + rest2_q2_q1_dot_q1_dot * x140 + x119 * x132 + x130 * x131 + x136
        ),
        q1_dot * x142 + q2 * x143 + q2_dot * x137 + q2_dot * x144 + x120 * x131 + x121 / 8 + x128,
        (
            mass11_q1_q1 * x152 / 96 + q1 * rest1_q1_q1 / 18 + q1 * rest1_q1_q1_q2_dot * x151 +
            (mass11_q1 + x122 + x127) * q1_ddot + q1_dot * rest1_q1_q1_dot + q2 * x145 + x155 *
            q2_ddot + q2_dot * rest1_q1_q2_q2_dot * x139 + q2_dot * x129 + rest1_q1 / 24 +
            rest1_q1_q1_q1 * x119 / 256 + rest1_q1_q1_q2 * x150 / 900 + rest1_q1_q2_dot_q2_dot *
            x153 / 192 + rest1_q1_q2_q2 * x131 / 576 + x147 + x148 * x149
        ),
        (
            q1 * x145 + (x124 + x126) * q1_ddot + q2 * rest1_q2_q2_q2_dot * x151 + x156 * q2_ddot +
            q2_dot * rest1_q2_q2_dot + rest1_q1_q1_q2 * x119 / 1800 + rest1_q1_q2_q2 * x158 +
            rest1_q1_q2_q2_dot * x135 + rest1_q2_q2 * x157 + rest1_q2_q2_q2 * x131 / 14700 + x123 *
            x146 + x160
        ),
        (
            q1 * rest2_q1_q1 / 64 + x155 * q1_ddot + q1_dot * x138 + (x127 + x142) * q2_ddot + 10 *
            rest1_q2_q2_q2_dot * x148 / 9 + rest2_q1_q1_q1 * x119 / 600 + rest2_q1_q1_q2 * x158 +
            rest2_q1_q2 * x157 + rest2_q1_q2_q1_dot * x140 + rest2_q1_q2_q2 * x131 / 44100 + x141 *
            x146 + x160
        ),
        (
            mass22_q2_q2 * x153 / 384 + q1 * rest2_q1_q2 / 450 + x156 * q1_ddot + 10 * q1_dot * q2
            * rest1_q1_q1_q2_dot / 9 + q1_dot * rest2_q1_q2_q1_dot * x133 + q1_dot *
            rest2_q2_q1_dot + q2 * q2_dot * x149 + q2 * rest2_q2_q2 / 72 + (x126 + x137 + x144) *
            q2_ddot + q2_dot * x143 + rest2_q1_q1_q2 * x119 / 576 + rest2_q1_q2_q2 * x150 / 22050 +
            rest2_q2 / 96 + rest2_q2_q1_dot_q1_dot * x152 / 192 + rest2_q2_q2_q2 * x131 / 1024 +
            x147
        ),
    )
