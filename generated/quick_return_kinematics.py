"""Kinematics of the quick-return mechanism in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation kinematics.
Equations: closure of the loop DA + AB = DB.

Every rate is a product of factors that are linear in the cosine of the crank angle, each written
by its values at the ends; so no digit is lost where the rod swings fastest, with the block near
the rod's pivot.

At theta2 = 0 the rod's angle is 0.

Cost per evaluation:
    motion: 48 operations
Content hash c6005e8b169ca0fb7f372b58a0bdd289; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["motion"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"kinematics","mechanism":"quick_return",'
    '"modes":null,"outputs":[]}'
)
CONTENT = "c6005e8b169ca0fb7f372b58a0bdd289"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle from the line DA"),
    "frame": ("m", "Distance DA of the rod's pivot from the crank's"),
    "crank": ("m", "Length of the crank AB"),
    "winding": ("", "1 where the crank is longer than the frame (the rod turns), else 0"),
    "theta4": ("rad", "Rod angle from D to B, continuous over any number of turns"),
    "slide": ("m", "Distance DB of the block along the rod"),
    "omega4": ("", "Rod speed over crank speed, d theta4 / d theta2"),
    "alpha4": ("", "Rod acceleration over crank speed squared, at constant crank speed"),
    "slide_velocity": ("m", "Velocity of the block along the rod over crank speed"),
    "slide_acceleration": ("m", "Second derivative of slide by the crank angle"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "motion": ("theta4", "slide", "omega4", "alpha4", "slide_velocity", "slide_acceleration"),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def motion(theta2, frame, crank, winding):
    """Return angle, speed and acceleration of the rod, and the block's slide along it.

    theta2 : ndarray or float, shape (...)
    frame, crank, winding : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = far**2 * x1 + near**2 * x2
    slide = xp.sqrt(slide2)
    x3 = far * x1
    x4 = near * x2
    x5 = crank * (x3 - x4) / slide2
    omega4 = x5
    x6 = frame / slide
    x7 = crank * sin2
    slide_velocity = -x6 * x7
    alpha4 = -far * near * frame * x7 / slide2**2
    del x1, x2, slide2, x7
    slide_acceleration = (-x3 - x4) * x5 * x6
    x8 = 1 - 2 * winding
    return (
        (
            winding * theta2 + xp.atan2(x8 * (crank * (1 - winding) + winding * frame) * sin2, x3 +
            x8 * x4)
        ),
        slide, omega4, alpha4, slide_velocity, slide_acceleration,
    )
