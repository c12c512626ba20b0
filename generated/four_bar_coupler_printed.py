"""Flexible coupler of a four-bar linkage, printed equation.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation printed, flexible coupler, any number of modes.
Equations: Smith (6.14); Smith (6.17).

Coordinates are Y_m / l3 in y = sum Y_m sin(m pi x / l3); arrays are divided by the modal mass mu
l3^3 / 2.

Left out of the energies: axial_inertia.

Cost per evaluation:
    scales: 8 operations
    angle_functions: 149 operations
    acceleration_functions: 116 operations
    forcing_functions: 122 operations
    acceleration_forcing_functions: 93 operations
    modal_matrices: 8 operations
    modal_vectors: 6 operations
Content hash eaf92c112f31ea3e7778f9ed1f0ca2c6; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "scales", "angle_functions", "acceleration_functions", "forcing_functions",
    "acceleration_forcing_functions", "modal_matrices", "modal_vectors",
]
FAMILY = "linear_periodic"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["coupler"],"formulation":"printed","mechanism":"four_bar'
    '","modes":null,"outputs":[]}'
)
CONTENT = "eaf92c112f31ea3e7778f9ed1f0ca2c6"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "bending_stiffness": ("N m^2", "EI of the coupler"),
    "mass_per_length": ("kg/m", "mu of the coupler"),
    "damping": ("N s/m^2", "Viscous damping of the coupler per length"),
    "coupler_inertia": ("kg m^2", "I3 of the coupler about the crank pin B"),
    "coupler_first_moment": ("kg m", "m3 r3 of the coupler about B"),
    "follower_inertia": ("kg m^2", "I4 of the follower about D"),
    "coupler": ("m", "Length of the coupler BC"),
    "theta2": ("rad", "Crank angle"),
    "frame": ("m", "Length of the fixed link AD"),
    "crank": ("m", "Length of the crank AB"),
    "follower": ("m", "Length of the follower DC"),
    "assembly": ("", "+1 for the open, -1 for the crossed assembly"),
    "m": ("", "Mode numbers of the rows, from 1"),
    "n": ("", "Mode numbers of the columns, from 1"),
}
PARAMETERS = (
    "bending_stiffness", "mass_per_length", "damping", "coupler_inertia", "coupler_first_moment",
    "follower_inertia",
)

# Names of what each function returns, in order.
RETURNS = {
    "scales": (
        "coupler_first_moment_over_mass_per_length", "coupler_inertia_over_mass_per_length",
        "follower_inertia_over_mass_per_length", "damping_over_mass_per_length",
        "bending_stiffness_over_mass_per_length",
    ),
    "angle_functions": (
        "angle_omega3", "angle_end_load_coupler_first_moment_speed",
        "angle_end_load_coupler_inertia_speed", "angle_end_load_follower_inertia_speed",
    ),
    "acceleration_functions": (
        "acceleration_end_load_coupler_first_moment_acceleration",
        "acceleration_end_load_coupler_inertia_acceleration",
        "acceleration_end_load_follower_inertia_acceleration",
    ),
    "forcing_functions": ("forcing_alpha3", "forcing_sin23"),
    "acceleration_forcing_functions": (
        "acceleration_forcing_omega3", "acceleration_forcing_cos23",
    ),
    "modal_matrices": ("modal_1", "modal_2", "modal_3"),
    "modal_vectors": ("modal_4", "modal_5"),
}
EXTERNAL = ()

# Separated terms: array, extra power of the crank speed, scale, function of angle, and modal array
# or integral over the shapes.
TERMS = (
    ("M", 0, None, None, "modal_1"),
    ("B", 0, None, "angle_omega3", "modal_1"),
    (
        "B", 0, "coupler_first_moment_over_mass_per_length",
        "angle_end_load_coupler_first_moment_speed", "modal_2",
    ),
    (
        "B", 0, "coupler_inertia_over_mass_per_length", "angle_end_load_coupler_inertia_speed",
        "modal_2",
    ),
    (
        "B", 0, "follower_inertia_over_mass_per_length", "angle_end_load_follower_inertia_speed",
        "modal_2",
    ),
    (
        "S", 0, "coupler_first_moment_over_mass_per_length",
        "acceleration_end_load_coupler_first_moment_acceleration", "modal_2",
    ),
    (
        "S", 0, "coupler_inertia_over_mass_per_length",
        "acceleration_end_load_coupler_inertia_acceleration", "modal_2",
    ),
    (
        "S", 0, "follower_inertia_over_mass_per_length",
        "acceleration_end_load_follower_inertia_acceleration", "modal_2",
    ),
    ("C", 0, "damping_over_mass_per_length", None, "modal_1"),
    ("K", 0, "bending_stiffness_over_mass_per_length", None, "modal_3"),
    ("f", 0, None, "forcing_alpha3", "modal_4"),
    ("f", 0, None, "forcing_sin23", "modal_5"),
    ("g", 0, None, "acceleration_forcing_omega3", "modal_4"),
    ("g", 0, None, "acceleration_forcing_cos23", "modal_5"),
)


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def scales(
    bending_stiffness, mass_per_length, damping, coupler_inertia, coupler_first_moment,
    follower_inertia, coupler,
):
    """Return the factors made of parameters.

    bending_stiffness to coupler : float
    Returns float or ndarray each.
    """
    x0 = 1 / mass_per_length
    return (
        x0 * coupler_first_moment, x0 * coupler_inertia, x0 * follower_inertia, x0 * damping,
        x0 * bending_stiffness / coupler**4,
    )


def angle_functions(theta2, frame, crank, coupler, follower, assembly):
    """Return the functions of angle in the matrices.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    cos2 = x1 - x2
    diagonal_x = far * x2 + near * x1
    x3 = crank * sin2
    diagonal_y = -x3
    diagonal2 = far**2 * x2 + near**2 * x1
    x4 = folded * straight
    p = diagonal2 + x4
    q = diagonal2 - x4
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    del x1, x2, fold, root, stretch
    area = 2 * coupler * follower * sine_transmission
    x6 = area * diagonal_y
    x7 = 1 / coupler
    x8 = 0.5 / diagonal2
    x9 = x7 * x8
    cos3 = x9 * (diagonal_x * p - x6)
    x10 = area * diagonal_x
    sin3 = x9 * (diagonal_y * p + x10)
    del diagonal2, area, p, x9
    x11 = 1 / follower
    x12 = x11 * x8
    cos4 = (-diagonal_x * q - x6) * x12
    del x8, diagonal_x, x6
    sin4 = (x10 - diagonal_y * q) * x12
    del diagonal_y, q, x10, x12
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    x13 = 1 / far
    share = x13 * crank
    reduced = share * frame
    x14 = 1 / sine_transmission
    del cos2, sin2, sine_transmission
    x15 = x7 * x14
    excess3 = (sin24 - sin4) * x15
    x16 = reduced * excess3
    omega3 = share + x16
    x17 = -x13 * frame
    slip3 = -x17 - x16
    del sin24, sin4, x16
    x18 = x11 * x14
    excess4 = (sin23 - sin3) * x18
    x19 = reduced * excess4
    omega4 = share + x19
    slip4 = -x17 - x19
    spread = x11 * frame * x15 * x3
    del sin3, x19, x3
    x20 = x14 * cosine_transmission * spread
    alpha3 = -reduced * (x20 * excess3 + x15 * (cos4 * omega4 - cos24 * slip4))
    del spread, x14, cos24, cos4, excess3, omega4, slip4
    alpha4 = -reduced * (x20 * excess4 + x18 * (cos3 * omega3 - cos23 * slip3))
    del cos23, cos3, excess4, slip3, x20
    x21 = x15 * cosine_transmission
    end_load_coupler_inertia_speed = x21 * alpha3
    del cosine_transmission, x15, alpha3
    end_load_coupler_first_moment_speed = -crank * x21 * sin23
    end_load_follower_inertia_speed = x18 * alpha4
    del sin23, x21, alpha4, x18
    x22 = 1 / coupler**2
    return (
        omega3**2, -x22 * end_load_coupler_first_moment_speed,
        -x22 * end_load_coupler_inertia_speed, -x22 * end_load_follower_inertia_speed,
    )


def acceleration_functions(theta2, frame, crank, coupler, follower, assembly):
    """Return the functions of angle that act while the crank accelerates.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    cos2 = x1 - x2
    diagonal_x = far * x2 + near * x1
    diagonal_y = -crank * sin2
    diagonal2 = far**2 * x2 + near**2 * x1
    x3 = folded * straight
    p = diagonal2 + x3
    q = diagonal2 - x3
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    del x1, x2, fold, root, stretch
    area = 2 * coupler * follower * sine_transmission
    x5 = area * diagonal_y
    x6 = 1 / coupler
    x7 = 0.5 / diagonal2
    x8 = x6 * x7
    cos3 = x8 * (diagonal_x * p - x5)
    x9 = area * diagonal_x
    sin3 = x8 * (diagonal_y * p + x9)
    del diagonal2, area, p, x8
    x10 = 1 / follower
    x11 = x10 * x7
    cos4 = (-diagonal_x * q - x5) * x11
    del x7, diagonal_x, x5
    sin4 = (x9 - diagonal_y * q) * x11
    del diagonal_y, q, x11, x9
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    del cos3, cos2, cos4, sin2
    share = crank / far
    reduced = share * frame
    x12 = 1 / sine_transmission
    x13 = x6 * x12
    excess3 = (sin24 - sin4) * x13
    del sine_transmission, sin24, sin4
    omega3 = reduced * excess3 + share
    x14 = x10 * x12
    excess4 = (sin23 - sin3) * x14
    del excess3, x12, sin23, sin3
    omega4 = reduced * excess4 + share
    x15 = x13 * cosine_transmission
    del excess4, cosine_transmission, x13
    end_load_coupler_inertia_acceleration = x15 * omega3
    end_load_coupler_first_moment_acceleration = crank * x15 * cos23
    del omega3, cos23, x15
    end_load_follower_inertia_acceleration = x14 * omega4
    x16 = 1 / coupler**2
    return (
        -x16 * end_load_coupler_first_moment_acceleration,
        -x16 * end_load_coupler_inertia_acceleration,
        -x16 * end_load_follower_inertia_acceleration,
    )


def forcing_functions(theta2, frame, crank, coupler, follower, assembly):
    """Return the functions of angle in the forcing.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    cos2 = x1 - x2
    diagonal_x = far * x2 + near * x1
    x3 = crank * sin2
    diagonal_y = -x3
    diagonal2 = far**2 * x2 + near**2 * x1
    x4 = folded * straight
    p = diagonal2 + x4
    q = diagonal2 - x4
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    del x1, x2, fold, root, stretch
    area = 2 * coupler * follower * sine_transmission
    x6 = area * diagonal_y
    x7 = 1 / coupler
    x8 = 0.5 / diagonal2
    x9 = x7 * x8
    cos3 = x9 * (diagonal_x * p - x6)
    x10 = area * diagonal_x
    sin3 = x9 * (diagonal_y * p + x10)
    del diagonal2, area, p, x9
    x11 = 1 / follower
    x12 = x11 * x8
    cos4 = (-diagonal_x * q - x6) * x12
    del x8, diagonal_x, x6
    sin4 = (x10 - diagonal_y * q) * x12
    del diagonal_y, q, x10, x12
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    del cos3, cos2, sin2
    x13 = 1 / far
    share = x13 * crank
    reduced = share * frame
    x14 = 1 / sine_transmission
    x15 = x7 * x14
    excess3 = (sin24 - sin4) * x15
    del sine_transmission, sin24, sin4
    excess4 = x11 * (sin23 - sin3) * x14
    x16 = reduced * excess4
    omega4 = share + x16
    slip4 = x13 * frame - x16
    del sin3, excess4, x16
    spread = x11 * frame * x15 * x3
    alpha3 = (
        -reduced * (x14 * cosine_transmission * excess3 * spread + x15 * (cos4 * omega4 - cos24 *
        slip4))
    )
    del x3, cos24, cos4, cosine_transmission, excess3, omega4, slip4, spread, x14, x15
    return 2 * alpha3, -2 * x7 * crank * sin23


def acceleration_forcing_functions(theta2, frame, crank, coupler, follower, assembly):
    """Return the functions of angle in the forcing while the crank accelerates.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = coupler + follower
    folded = coupler - follower
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    cos2 = x1 - x2
    diagonal_x = far * x2 + near * x1
    diagonal_y = -crank * sin2
    diagonal2 = far**2 * x2 + near**2 * x1
    x3 = folded * straight
    p = diagonal2 + x3
    q = diagonal2 - x3
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    del x1, x2, fold, root, stretch
    area = 2 * coupler * follower * sine_transmission
    x5 = area * diagonal_y
    x6 = 1 / coupler
    x7 = 0.5 / diagonal2
    x8 = x6 * x7
    cos3 = x8 * (diagonal_x * p - x5)
    x9 = area * diagonal_x
    sin3 = x8 * (diagonal_y * p + x9)
    del diagonal2, area, p, x8
    x10 = x7 / follower
    cos4 = (-diagonal_x * q - x5) * x10
    del x7, diagonal_x, x5
    sin4 = (x9 - diagonal_y * q) * x10
    del diagonal_y, q, x10, x9
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    del cos3, sin3, cos2, cos4, sin2
    share = crank / far
    reduced = share * frame
    excess3 = x6 * (sin24 - sin4) / sine_transmission
    del sin24, sin4, sine_transmission
    omega3 = reduced * excess3 + share
    return 2 * omega3, 2 * x6 * crank * cos23


def modal_matrices(m, n):
    """Return the modal arrays of the matrices.

    m : ndarray, shape (N, 1)
    n : ndarray, shape (1, N)
    Returns ndarray, shape (N, N) each.
    """
    xp = _namespace(m)
    x0 = (m == n)
    return (
        xp.asarray(x0, dtype=xp.float64), xp.where(x0, 9.869604401089358 * m**2, 0),
        xp.where(x0, 97.40909103400244 * m**4, 0),
    )


def modal_vectors(m):
    """Return the modal arrays of the forcing.

    m : ndarray, shape (N,)
    Returns ndarray, shape (N,) each.
    """
    x0 = (1 - 2 * ((m) % 2))
    x1 = 0.3183098861837907 / m
    return x0 * x1, x1 * (x0 - 1)
