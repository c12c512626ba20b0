"""Kinematics of the four-bar linkage in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation kinematics.
Equations: Smith (2.1)-(2.10); Smith (A.1)-(A.8).

The squares of the diagonal and of the area are sums of like-signed terms for every crank that
turns fully, so that no digit is lost near a dead centre; speeds and accelerations hold the short
one of crank and frame as a factor.

At theta2 = 0 both angles lie between -pi and pi.

Cost per evaluation:
    motion: 158 operations
Content hash ca46885dc202bdca1a629f76b3470d94; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["motion"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"kinematics","mechanism":"four_bar","mod'
    'es":null,"outputs":[]}'
)
CONTENT = "ca46885dc202bdca1a629f76b3470d94"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle"),
    "frame": ("m", "Length of the fixed link AD"),
    "crank": ("m", "Length of the crank AB"),
    "coupler": ("m", "Length of the coupler BC"),
    "follower": ("m", "Length of the follower DC"),
    "assembly": ("", "+1 for the open, -1 for the crossed assembly"),
    "winding": ("", "1 where the crank is longer than the frame (drag link), else 0"),
    "theta3": ("rad", "Coupler angle, continuous over any number of turns"),
    "theta4": ("rad", "Follower angle, continuous over any number of turns"),
    "omega3": ("", "Coupler speed over crank speed, d theta3 / d theta2"),
    "omega4": ("", "Follower speed over crank speed, d theta4 / d theta2"),
    "alpha3": ("", "Coupler acceleration over crank speed squared, at constant crank speed"),
    "alpha4": ("", "Follower acceleration over crank speed squared, at constant crank speed"),
    "transmission_angle": ("rad", "Angle between coupler and follower at C, from 0 to pi"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "motion": ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def motion(theta2, frame, crank, coupler, follower, assembly, winding):
    """Return angles, speeds and accelerations of coupler and follower.

    theta2 : ndarray or float, shape (...)
    frame, crank, coupler, follower, assembly, winding : float
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
    x3 = far * x2
    x4 = near * x1
    diagonal_x = x3 + x4
    x5 = crank * sin2
    diagonal_y = -x5
    diagonal2 = far**2 * x2 + near**2 * x1
    x6 = folded * straight
    p = diagonal2 + x6
    q = diagonal2 - x6
    stretch = (
        -(near + straight) * (near - straight) * x1 - (far + straight) * (far - straight) * x2
    )
    fold = -(folded + near) * (folded - near) * x1 + (far + folded) * (far - folded) * x2
    root = xp.sqrt(fold * stretch)
    x8 = 2 * root
    del x1, x2, root
    sine_transmission = assembly * x8 / (fold + stretch)
    area = 2 * coupler * follower * sine_transmission
    x9 = area * diagonal_y
    x10 = 1 / coupler
    x11 = 0.5 / diagonal2
    x12 = x10 * x11
    cos3 = x12 * (diagonal_x * p - x9)
    x13 = area * diagonal_x
    sin3 = x12 * (diagonal_y * p + x13)
    x14 = 1 / follower
    x15 = x14 * x11
    del diagonal2, x12, x11
    cos4 = (-diagonal_x * q - x9) * x15
    sin4 = (x13 - diagonal_y * q) * x15
    del diagonal_x, x9, diagonal_y, x13, x15
    cosine_transmission = cos3 * cos4 + sin3 * sin4
    sin23 = cos3 * sin2 - cos2 * sin3
    cos23 = cos2 * cos3 + sin2 * sin3
    sin24 = cos4 * sin2 - cos2 * sin4
    cos24 = cos2 * cos4 + sin2 * sin4
    x16 = 1 / far
    share = x16 * crank
    reduced = share * frame
    x17 = 1 / sine_transmission
    x18 = x10 * x17
    excess3 = (sin24 - sin4) * x18
    del cos2, sine_transmission, sin24, sin4
    x19 = reduced * excess3
    omega3 = share + x19
    x20 = -x16 * frame
    slip3 = -x20 - x19
    x21 = x14 * x17
    excess4 = (sin23 - sin3) * x21
    del x19, sin23, sin3
    x22 = reduced * excess4
    omega4 = share + x22
    slip4 = -x20 - x22
    spread = x14 * frame * x18 * x5
    x23 = x17 * cosine_transmission * spread
    del x22, x5, cosine_transmission, spread, x17
    alpha3 = -reduced * (x23 * excess3 + x18 * (cos4 * omega4 - cos24 * slip4))
    del cos24, cos4, excess3, slip4, x18
    alpha4 = -reduced * (x23 * excess4 + x21 * (cos3 * omega3 - cos23 * slip3))
    del cos23, cos3, excess4, slip3, x21, x23
    x24 = 2 * winding - 1
    phi = (
        winding * theta2 + xp.atan2(x24 * (crank * (1 - winding) + winding * frame) * sin2, x3 -
        x24 * x4)
    )
    del sin2, x3, x4
    return (
        phi - x24 * xp.atan2(area, -x24 * p), phi - x24 * xp.atan2(area, x24 * q), omega3, omega4,
        alpha3, alpha4, xp.atan2(x8, stretch - fold),
    )
