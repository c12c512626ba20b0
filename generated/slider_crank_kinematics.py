"""Kinematics of the slider-crank in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism slider_crank, formulation kinematics.
Equations: closure of the loop AB + BC = AC.

The length of the coupler along the guide is the root of two factors, each a sum of like-signed
terms for every crank that turns fully; so no digit is lost where the coupler nearly stands across
the guide.

Cost per evaluation:
    motion: 78 operations
Content hash 739043042ba52fda9413cf801d572c86; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["motion"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"kinematics","mechanism":"slider_crank",'
    '"modes":null,"outputs":[]}'
)
CONTENT = "739043042ba52fda9413cf801d572c86"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle from the guide"),
    "crank": ("m", "Length of the crank AB"),
    "coupler": ("m", "Length of the coupler BC"),
    "offset": ("m", "Height of the guide over the crank's pivot A"),
    "assembly": ("", "+1 where the slider is right of B (open), -1 left"),
    "theta3": ("rad", "Coupler angle from B to C; open -pi/2 to pi/2, crossed pi/2 to 3 pi/2"),
    "position": ("m", "Place of the slider's pin C along the guide, from A"),
    "omega3": ("", "Coupler speed over crank speed, d theta3 / d theta2"),
    "alpha3": ("", "Coupler acceleration over crank speed squared, at constant crank speed"),
    "slider_velocity": ("m", "Slider velocity over crank speed"),
    "slider_acceleration": (
        "m", "Slider acceleration over crank speed squared, at constant crank speed",
    ),
    "transmission_angle": ("rad", "Angle between coupler and the normal of the guide, 0 to pi"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "motion": (
        "theta3", "position", "omega3", "alpha3", "slider_velocity", "slider_acceleration",
        "transmission_angle",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def motion(theta2, crank, coupler, offset, assembly):
    """Return angles and places, speeds and accelerations of coupler and slider.

    theta2 : ndarray or float, shape (...)
    crank, coupler, offset, assembly : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    reach = coupler - crank
    total = coupler + crank
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine + half_sine
    x2 = half_cosine - half_sine
    del x0, half_cosine, half_sine
    cos2 = x1 * x2
    raised = x1**2 / 2
    lowered = x2**2 / 2
    x3 = (offset + total) * lowered
    x4 = (offset + reach) * raised
    above = x3 + x4
    x5 = offset - reach
    x6 = offset - total
    below = -x5 * lowered - x6 * raised
    del x1, x2, lowered, raised
    root = xp.sqrt(above * below)
    x7 = 1 / coupler
    sin3 = x7 * (offset - crank * sin2)
    cos3 = 2 * assembly * root / (above + below)
    del above, below, root
    sin23 = cos3 * sin2 - cos2 * sin3
    x8 = crank * cos2
    x9 = coupler * cos3
    position = x8 + x9
    x10 = 1 / cos3
    omega3 = -x7 * x10 * x8
    alpha3 = (
        crank * (offset * crank * cos2**2 + sin2 * (-x5 * x3 - x6 * x4)) / (cos3**3 * coupler**3)
    )
    del cos2, sin2, x3, x4
    slider_velocity = -crank * x10 * sin23
    slider_acceleration = -coupler * alpha3 * sin3 - x9 * omega3**2 - x8
    del sin23, x10, x8, x9
    x11 = assembly * cos3
    return (
        (1.5707963267948966 - 1.5707963267948966 * assembly) + xp.atan2(assembly * sin3, x11),
        position, omega3, alpha3, slider_velocity, slider_acceleration, xp.atan2(x11, sin3),
    )
