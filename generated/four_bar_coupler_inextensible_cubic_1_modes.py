"""Inextensible flexible coupler of a four-bar linkage, to third order in its amplitudes.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation inextensible_cubic, flexible coupler, 1 modes.
Equations: Smith 9.6, further work 2.

Angle of the coupler's tangent: a mean and sum q_k cos(k pi s), s from 0 at the crank to 1.
Derivatives by_u are those by the chord's length over the coupler's.

Cost per evaluation:
    dynamics: 405 operations
    variations: 392 operations
Content hash 94cebf50babe46470459118f597a10dc; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["dynamics", "variations"]
FAMILY = "constrained"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"inextensible_cubic","mechanism'
    '":"four_bar","modes":1,"outputs":[]}'
)
CONTENT = "94cebf50babe46470459118f597a10dc"

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
    q1, q1_dot, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower, bending_stiffness,
    mass_per_length, damping, gravity_x, gravity_y, follower_inertia, follower_first_moment, bow,
    assembly,
):
    """Return everything in the equations of motion at acceleration level.

    q1, q1_dot, t, theta, theta_d1, theta_d2 : float or ndarray, shape (...)
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
    x41 = 9.869604401089358
    x42 = 1 / x41
    x43 = x39 * x42
    mass11_q1_q1 = 24 * x33 * follower_inertia + x35 * x40 + x40 - 45 * x43
    x44 = x43 * theta3_by_u
    mass11_q1 = -x44
    mass11 = x43
    x45 = psi_by_u * follower_inertia
    x46 = x45 * psi_d2
    x47 = 96 * psi_by_uu
    x48 = cos4 * follower_first_moment
    x49 = x48 * gravity_y
    x50 = 48 * psi_by_u
    x51 = follower_first_moment * sin4
    x52 = x51 * gravity_x
    x53 = coupler**2
    x54 = x53 * mass_per_length
    x55 = x54 * along
    x56 = x54 * across
    x57 = x56 * theta3_by_u
    x58 = 96 * x33
    x59 = 32 * x39
    x60 = x39 * theta3_by_u * theta3_d2
    x61 = x39 * theta3_by_u_d1
    x62 = theta3_d1**2
    x63 = x39 * x62
    x64 = x43 * theta3_by_u_d1
    x65 = x43 * x62
    rest1_q1_q1_q1 = (
        x47 * psi_d2 * follower_inertia + x48 * x58 * gravity_x + x51 * x58 * gravity_y + 96 * x45
        * psi_by_u_d2 + x59 * theta3_by_u * theta3_by_u_d2 + x59 * theta3_by_uu * theta3_d2 - 48 *
        x56 * theta3_by_uu - 64 * x61 * theta3_d1 + 240 * x64 * theta3_d1 - 240 * x44 * theta3_d2 +
        48 * x35 * x55 + 48 * x46 - x47 * x49 + x47 * x52 - x49 * x50 + x50 * x52 - 24 * x55 - 120
        * x57 + 80 * x60 - 48 * x63 + 245 * x65
    )
    rest1_q1_q1_q1_dot = 3 * x45 * psi_by_u_d1 + x61 * theta3_by_u
    x66 = x42 * x54
    rest1_q1_q1 = (
        x66 * (28 * across - 54 * along * theta3_by_u - 9 * theta3_by_u_d2 * coupler - 5 *
        theta3_d2 * coupler)
    )
    rest1_q1_q1_dot = -x64
    x67 = 12 * psi_by_u
    rest1_q1 = (
        12 * x41 * x9 * bending_stiffness - 12 * x46 + x49 * x67 - x52 * x67 + 6 * x55 + 6 * x57 -
        4 * x60 + 4 * x63 - 15 * x65
    )
    rest1 = (
        2 * x38 * x42 * theta3_d2 * mass_per_length - 4 * x66 * across - 31.00627668029982 * bow *
        bending_stiffness / x53
    )
    x68 = q1**2
    x69 = mass11_q1_q1 / 96
    x70 = q1_dot**2
    return (
        mass11 / 2 + mass11_q1 * q1 + x68 * x69,
        (
            mass11_q1 * x70 / 2 + rest1_q1_q1_q1 * q1**3 / 768 + q1 * q1_dot * rest1_q1_q1_dot + q1
            * rest1_q1 / 24 + q1 * x69 * x70 + q1_dot * rest1_q1_q1_q1_dot * x68 / 6 + rest1 / 2 +
            rest1_q1_q1 * x68 / 36
        ),
        -q1_dot * x38 * x42 * damping / 2,
    )


def variations(
    q1, q1_dot, q1_ddot, t, theta, theta_d1, theta_d2, frame, crank, coupler, follower,
    bending_stiffness, mass_per_length, damping, gravity_x, gravity_y, follower_inertia,
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
    x41 = 9.869604401089358
    x42 = 1 / x41
    x43 = x39 * x42
    mass11_q1_q1 = 24 * x33 * follower_inertia + x35 * x40 + x40 - 45 * x43
    x44 = x43 * theta3_by_u
    mass11_q1 = -x44
    x45 = psi_by_u * follower_inertia
    x46 = x45 * psi_d2
    x47 = 96 * psi_by_uu
    x48 = cos4 * follower_first_moment
    x49 = x48 * gravity_y
    x50 = 48 * psi_by_u
    x51 = follower_first_moment * sin4
    x52 = x51 * gravity_x
    x53 = mass_per_length * coupler**2
    x54 = x53 * along
    x55 = x53 * across
    x56 = x55 * theta3_by_u
    x57 = 96 * x33
    x58 = 32 * x39
    x59 = x39 * theta3_by_u * theta3_d2
    x60 = x39 * theta3_by_u_d1
    x61 = theta3_d1**2
    x62 = x39 * x61
    x63 = x43 * theta3_by_u_d1
    x64 = x43 * x61
    rest1_q1_q1_q1 = (
        x47 * psi_d2 * follower_inertia + x48 * x57 * gravity_x + x51 * x57 * gravity_y + 96 * x45
        * psi_by_u_d2 + x58 * theta3_by_u * theta3_by_u_d2 + x58 * theta3_by_uu * theta3_d2 - 48 *
        x55 * theta3_by_uu - 64 * x60 * theta3_d1 + 240 * x63 * theta3_d1 - 240 * x44 * theta3_d2 +
        48 * x35 * x54 + 48 * x46 - x47 * x49 + x47 * x52 - x49 * x50 + x50 * x52 - 24 * x54 - 120
        * x56 + 80 * x59 - 48 * x62 + 245 * x64
    )
    rest1_q1_q1_q1_dot = 3 * x45 * psi_by_u_d1 + x60 * theta3_by_u
    rest1_q1_q1 = (
        x42 * x53 * (28 * across - 54 * along * theta3_by_u - 9 * theta3_by_u_d2 * coupler - 5 *
        theta3_d2 * coupler)
    )
    rest1_q1_q1_dot = -x63
    x65 = 12 * psi_by_u
    rest1_q1 = (
        12 * x41 * x9 * bending_stiffness - 12 * x46 + x49 * x65 - x52 * x65 + 6 * x54 + 6 * x56 -
        4 * x59 + 4 * x62 - 15 * x64
    )
    x66 = mass11_q1_q1 * q1 / 48
    x67 = q1**2
    return (
        (
            x38 * x42 * damping / 2 + mass11_q1 * q1_dot + q1 * rest1_q1_q1_dot + x66 * q1_dot +
            rest1_q1_q1_q1_dot * x67 / 6
        ),
        (
            mass11_q1_q1 * q1_dot**2 / 96 + q1 * rest1_q1_q1_q1_dot * q1_dot / 3 + q1 * rest1_q1_q1
            / 18 + (mass11_q1 + x66) * q1_ddot + rest1_q1_q1_dot * q1_dot + rest1_q1 / 24 +
            rest1_q1_q1_q1 * x67 / 256
        ),
    )
