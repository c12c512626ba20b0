"""Range that play at its joints gives the four-bar linkage, in closed form.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism four_bar, formulation clearance.
Equations: Smith (3.1)-(3.3).

For the follower, ``turning`` is the follower and ``opposite`` the coupler; for the coupler the
other way round.

An angle that play brings to 0 or pi stays there: the link lies along the diagonal, and may go on
to the other assembly.

Cost per evaluation:
    extremes: 125 operations
Content hash a0ec3405568ef053243c35cf7f061a7a; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["extremes"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"clearance","mechanism":"four_bar","mode'
    's":null,"outputs":[]}'
)
CONTENT = "a0ec3405568ef053243c35cf7f061a7a"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "theta2": ("rad", "Crank angle"),
    "frame": ("m", "Length of the fixed link AD"),
    "crank": ("m", "Length of the crank AB"),
    "turning": ("m", "Length of the link whose range is asked for"),
    "opposite": ("m", "Length of the link whose ends have play"),
    "play": ("m", "Sum of the radial clearances: half of the diametral ones"),
    "angle": ("rad", "Angle between the diagonal BD and the turning link, without play"),
    "opened": ("rad", "By how much play can open this angle"),
    "closed": ("rad", "By how much play can close this angle"),
    "small": (
        "rad", "opened and closed together for a small clearance (Smith 3.3); infinite in line",
    ),
    "free": (
        "m^4", "Product of the outer triangles' areas; 0 where play brings the link into line",
    ),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {"extremes": ("angle", "opened", "closed", "small", "free")}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def extremes(theta2, frame, crank, turning, opposite, play):
    """Return the angle of a link from the diagonal BD, and how far play turns it.

    theta2 : ndarray or float, shape (...)
    frame, crank, turning, opposite, play : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    straight = opposite + turning
    folded = opposite - turning
    x0 = theta2 / 2
    cos_half2 = xp.cos(x0)**2
    sin_half2 = xp.sin(x0)**2
    diagonal2 = near**2 * cos_half2 + far**2 * sin_half2
    x1 = near + straight
    x3 = near - straight
    x4 = far + straight
    x5 = far - straight
    x6 = folded + near
    x8 = folded - near
    x9 = far + folded
    x11 = far - folded
    square_nominal = (
        (x1 * x3 * cos_half2 + x4 * x5 * sin_half2) * (x6 * x8 * cos_half2 - x11 * x9 * sin_half2)
    )
    area_nominal = xp.sqrt(square_nominal / 2 + xp.abs(square_nominal) / 2)
    x13 = folded + play
    x14 = play + straight
    square_longer = (
        ((play + x1) * (near - x14) * cos_half2 + (play + x4) * (far - x14) * sin_half2) * ((play +
        x6) * (play + x8) * cos_half2 - (play + x9) * (far - x13) * sin_half2)
    )
    area_longer = xp.sqrt(square_longer / 2 + xp.abs(square_longer) / 2)
    del x0, square_nominal, square_longer
    square_shorter = (
        ((x1 - play) * (play + x3) * cos_half2 + (x4 - play) * (play + x5) * sin_half2) * ((x6 -
        play) * (folded - near - play) * cos_half2 - (play + x11) * (x9 - play) * sin_half2)
    )
    area_shorter = xp.sqrt(square_shorter / 2 + xp.abs(square_shorter) / 2)
    del cos_half2, sin_half2, square_shorter
    x16 = xp.atan2(area_nominal, diagonal2 - folded * straight)
    x17 = 2 * opposite
    return (
        x16,
        (
            xp.where((area_longer * area_nominal > 0), 2 * xp.atan2(play * (play + x17),
            area_longer + area_nominal), xp.atan2(area_longer, diagonal2 - x13 * x14) - x16)
        ),
        (
            xp.where((area_nominal * area_shorter > 0), 2 * xp.atan2(play * (x17 - play),
            area_nominal + area_shorter), x16 - xp.atan2(area_shorter, diagonal2 - (folded - play)
            * (straight - play)))
        ),
        4 * play * opposite / area_nominal, area_longer * area_shorter / 16,
    )
