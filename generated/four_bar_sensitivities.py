"""Sensitivities of the four-bar linkage's motion in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation sensitivities.
Equations: Smith (2.1), differentiated by each length.

Each is the derivative at fixed other lengths and crank angle, and grows as the transmission angle
nears 0 or pi: the angles' ones as 1/sin, the speeds' as its third power, the accelerations' as its
fifth.

Cost per evaluation:
    sensitivities: 306 operations
Content hash 5bee10bc09d06412174f5dd0d2bfcf87; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["sensitivities"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"sensitivities","mechanism":"four_bar","'
    'modes":null,"outputs":[]}'
)
CONTENT = "5bee10bc09d06412174f5dd0d2bfcf87"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle"),
    "frame": ("m", "Length of the fixed link AD"),
    "crank": ("m", "Length of the crank AB"),
    "coupler": ("m", "Length of the coupler BC"),
    "follower": ("m", "Length of the follower DC"),
    "assembly": ("", "+1 for the open, -1 for the crossed assembly"),
    "theta3_by_frame": ("1/m", "Coupler angle, its derivative by the length of the frame"),
    "theta3_by_crank": ("1/m", "Coupler angle, its derivative by the length of the crank"),
    "theta3_by_coupler": ("1/m", "Coupler angle, its derivative by the length of the coupler"),
    "theta3_by_follower": ("1/m", "Coupler angle, its derivative by the length of the follower"),
    "theta3_by_theta2": ("", "Coupler angle, its derivative by the crank angle"),
    "theta4_by_frame": ("1/m", "Follower angle, its derivative by the length of the frame"),
    "theta4_by_crank": ("1/m", "Follower angle, its derivative by the length of the crank"),
    "theta4_by_coupler": ("1/m", "Follower angle, its derivative by the length of the coupler"),
    "theta4_by_follower": ("1/m", "Follower angle, its derivative by the length of the follower"),
    "theta4_by_theta2": ("", "Follower angle, its derivative by the crank angle"),
    "omega3_by_frame": (
        "1/m", "Coupler speed over crank speed, its derivative by the length of the frame",
    ),
    "omega3_by_crank": (
        "1/m", "Coupler speed over crank speed, its derivative by the length of the crank",
    ),
    "omega3_by_coupler": (
        "1/m", "Coupler speed over crank speed, its derivative by the length of the coupler",
    ),
    "omega3_by_follower": (
        "1/m", "Coupler speed over crank speed, its derivative by the length of the follower",
    ),
    "omega3_by_theta2": ("", "Coupler speed over crank speed, its derivative by the crank angle"),
    "omega4_by_frame": (
        "1/m", "Follower speed over crank speed, its derivative by the length of the frame",
    ),
    "omega4_by_crank": (
        "1/m", "Follower speed over crank speed, its derivative by the length of the crank",
    ),
    "omega4_by_coupler": (
        "1/m", "Follower speed over crank speed, its derivative by the length of the coupler",
    ),
    "omega4_by_follower": (
        "1/m", "Follower speed over crank speed, its derivative by the length of the follower",
    ),
    "omega4_by_theta2": ("", "Follower speed over crank speed, its derivative by the crank angle"),
    "alpha3_by_frame": (
        "1/m",
        "Coupler acceleration over crank speed squared, its derivative by the length of the frame",
    ),
    "alpha3_by_crank": (
        "1/m",
        "Coupler acceleration over crank speed squared, its derivative by the length of the crank",
    ),
    "alpha3_by_coupler": (
        "1/m",
        (
            "Coupler acceleration over crank speed squared, its derivative by the length of the "
            "coupler"
        ),
    ),
    "alpha3_by_follower": (
        "1/m",
        (
            "Coupler acceleration over crank speed squared, its derivative by the length of the "
            "follower"
        ),
    ),
    "alpha3_by_theta2": (
        "", "Coupler acceleration over crank speed squared, its derivative by the crank angle",
    ),
    "alpha4_by_frame": (
        "1/m",
        (
            "Follower acceleration over crank speed squared, its derivative by the length of the "
            "frame"
        ),
    ),
    "alpha4_by_crank": (
        "1/m",
        (
            "Follower acceleration over crank speed squared, its derivative by the length of the "
            "crank"
        ),
    ),
    "alpha4_by_coupler": (
        "1/m",
        (
            "Follower acceleration over crank speed squared, its derivative by the length of the "
            "coupler"
        ),
    ),
    "alpha4_by_follower": (
        "1/m",
        (
            "Follower acceleration over crank speed squared, its derivative by the length of the "
            "follower"
        ),
    ),
    "alpha4_by_theta2": (
        "", "Follower acceleration over crank speed squared, its derivative by the crank angle",
    ),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "sensitivities": (
        "theta3_by_frame", "theta3_by_crank", "theta3_by_coupler", "theta3_by_follower",
        "theta3_by_theta2", "theta4_by_frame", "theta4_by_crank", "theta4_by_coupler",
        "theta4_by_follower", "theta4_by_theta2", "omega3_by_frame", "omega3_by_crank",
        "omega3_by_coupler", "omega3_by_follower", "omega3_by_theta2", "omega4_by_frame",
        "omega4_by_crank", "omega4_by_coupler", "omega4_by_follower", "omega4_by_theta2",
        "alpha3_by_frame", "alpha3_by_crank", "alpha3_by_coupler", "alpha3_by_follower",
        "alpha3_by_theta2", "alpha4_by_frame", "alpha4_by_crank", "alpha4_by_coupler",
        "alpha4_by_follower", "alpha4_by_theta2",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def sensitivities(theta2, frame, crank, coupler, follower, assembly):
    """Return the derivatives of angles, speeds and accelerations.

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
    x5 = diagonal2 + x4
    p = x5
    x6 = diagonal2 - x4
    q = x6
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    sine_transmission = 2 * assembly * root / (fold + stretch)
    del x1, x2, root
    area = 2 * coupler * follower * sine_transmission
    x8 = area * diagonal_y
    x9 = 1 / coupler
    x10 = 0.5 / diagonal2
    x11 = x9 * x10
    cos3 = x11 * (diagonal_x * p - x8)
    x12 = area * diagonal_x
    sin3 = x11 * (diagonal_y * p + x12)
    x13 = 1 / follower
    x14 = x13 * x10
    cos4 = (-diagonal_x * q - x8) * x14
    del p, x11, diagonal_x, x8
    sin4 = (x12 - diagonal_y * q) * x14
    del diagonal_y, q, x12, x14
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    x15 = 1 / far
    share = x15 * crank
    reduced = share * frame
    x16 = 1 / sine_transmission
    x17 = x9 * x16
    excess3 = (sin24 - sin4) * x17
    x18 = reduced * excess3
    omega3 = share + x18
    x19 = -x15 * frame
    slip3 = -x19 - x18
    x20 = x13 * x16
    excess4 = (sin23 - sin3) * x20
    x21 = reduced * excess4
    omega4 = share + x21
    slip4 = -x19 - x21
    x22 = x13 * x17
    spread = frame * x22 * x3
    del x18, x21, x3
    x23 = x16 * cosine_transmission * spread
    alpha3 = -reduced * (x23 * excess3 + x17 * (cos4 * omega4 - cos24 * slip4))
    alpha4 = -reduced * (x23 * excess4 + x20 * (cos3 * omega3 - cos23 * slip3))
    x24 = crank * frame
    spread_rate = x24 * x22 * (cos2 - x23 * sin2)
    del excess3, excess4, x22
    per3 = x17
    per4 = x20
    pace = x23
    del x17, x20, x23
    x25 = pace**2
    x26 = spread**2
    pace_rate = x16 * cosine_transmission * spread_rate - x25 - x26
    theta3_by_frame = cos4 * per3
    omega3_by_frame = -omega4 * per3 * sin4 - pace * theta3_by_frame
    x27 = 2 * pace
    x28 = pace_rate + x25
    del x16, pace_rate, x25
    alpha3_by_frame = (
        (-alpha4 * sin4 - cos4 * omega4**2) * per3 - x27 * omega3_by_frame - x28 * theta3_by_frame
    )
    theta4_by_frame = cos3 * per4
    omega4_by_frame = -omega3 * per4 * sin3 - pace * theta4_by_frame
    alpha4_by_frame = (
        (-alpha3 * sin3 - cos3 * omega3**2) * per4 - x27 * omega4_by_frame - x28 * theta4_by_frame
    )
    del cos4, sin4, cos3, sin3
    theta3_by_crank = -cos24 * per3
    omega3_by_crank = per3 * sin24 * slip4 - pace * theta3_by_crank
    alpha3_by_crank = (
        per3 * (cos24 * slip4**2 - alpha4 * sin24) - x27 * omega3_by_crank - x28 * theta3_by_crank
    )
    del cos24, sin24, slip4
    theta4_by_crank = -cos23 * per4
    omega4_by_crank = per4 * sin23 * slip3 - pace * theta4_by_crank
    alpha4_by_crank = (
        per4 * (cos23 * slip3**2 - alpha3 * sin23) - x27 * omega4_by_crank - x28 * theta4_by_crank
    )
    del cos23, sin23, slip3
    theta3_by_coupler = -cosine_transmission * per3
    omega3_by_coupler = per3 * sine_transmission * spread - pace * theta3_by_coupler
    x29 = x26 * cosine_transmission + sine_transmission * spread_rate
    alpha3_by_coupler = x29 * per3 - x27 * omega3_by_coupler - x28 * theta3_by_coupler
    omega4_by_coupler = pace * per4
    alpha4_by_coupler = x28 * per4 - x27 * omega4_by_coupler
    omega3_by_follower = -pace * per3
    alpha3_by_follower = -x27 * omega3_by_follower - x28 * per3
    theta4_by_follower = cosine_transmission * per4
    del spread_rate, x26, cosine_transmission
    omega4_by_follower = -pace * theta4_by_follower - per4 * sine_transmission * spread
    del pace, sine_transmission, spread
    alpha4_by_follower = -x27 * omega4_by_follower - x29 * per4 - x28 * theta4_by_follower
    del x27, x28, x29
    double = 2 * x24
    x30 = 1 / diagonal2**3
    x31 = sin2**2
    sway = double * far * near * x30 * (cos2 * diagonal2 - 2 * double * x31) / 2
    x32 = 1 / (fold * stretch)
    lean = x32 * (stretch - fold) / 2
    x33 = lean**2
    lean_rate = -2 * x33 - x32
    del fold, stretch, x32
    bendp1 = -x10 * x6
    x34 = x4 / diagonal2**2
    x35 = x34 / 2
    bendp2 = -bendp1 * lean - x35
    x36 = lean_rate - x33
    del x6, diagonal2, lean_rate, x33
    x37 = x34 * lean + x4 * x30
    bendp3 = x37 - x36 * bendp1
    x38 = 3 * double * cos2
    del x30, x34, cos2
    x39 = double**2 * x31
    x40 = double * sin2 / area
    del x31, area, sin2
    alpha3_by_theta2 = sway + x40 * (x38 * bendp2 - bendp1 + x39 * bendp3)
    del bendp1, bendp2, bendp3
    bendq1 = x10 * x5
    bendq2 = -bendq1 * lean - x35
    del x10, x5, lean, x35
    bendq3 = x37 - x36 * bendq1
    alpha4_by_theta2 = sway + x40 * (x38 * bendq2 - bendq1 + x39 * bendq3)
    del x36, x37, bendq1, bendq2, bendq3, sway, x38, x39, x40
    return (
        theta3_by_frame, theta3_by_crank, theta3_by_coupler, per3, omega3, theta4_by_frame,
        theta4_by_crank, -per4, theta4_by_follower, omega4, omega3_by_frame, omega3_by_crank,
        omega3_by_coupler, omega3_by_follower, alpha3, omega4_by_frame, omega4_by_crank,
        omega4_by_coupler, omega4_by_follower, alpha4, alpha3_by_frame, alpha3_by_crank,
        alpha3_by_coupler, alpha3_by_follower, alpha3_by_theta2, alpha4_by_frame, alpha4_by_crank,
        alpha4_by_coupler, alpha4_by_follower, alpha4_by_theta2,
    )
