"""Frequency of an inextensible coupler against its amplitude, the crank held still.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam, formulation amplitude_law.
Equations: Smith 9.6, further work 2.

kappa is the first coefficient and the sum of what all other modes add; they count only where
coupler and follower do not meet at right angles.

Cost per evaluation:
    coefficients: 46 operations
Content hash 8cb8e4c444789cce648daa7b1e7c3911; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = ["coefficients"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"amplitude_law","mechanism":"beam","mode'
    's":null,"outputs":[]}'
)
CONTENT = "8cb8e4c444789cce648daa7b1e7c3911"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "transmission_angle": ("rad", "Transmission angle"),
    "mode": ("", "Number k of the mode"),
    "other": ("", "Number m of another mode, which follows at 2 omega"),
    "driven_mass": ("", "Mass that C drives over that of the coupler: I4/l4^2, or the slider's"),
    "alone": ("", "kappa of a coupler with this mode alone"),
    "alone_by_angle": ("", "Its derivative by the transmission angle"),
    "beside": ("", "What the other mode adds to kappa"),
    "beside_by_angle": ("", "Its derivative by the transmission angle"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {"coefficients": ("alone", "alone_by_angle", "beside", "beside_by_angle")}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def coefficients(transmission_angle, mode, other, driven_mass):
    """Return kappa of omega = omega_k (1 + kappa (A/l3)^2), A that of the deflection.

    transmission_angle : ndarray, shape (...)
    mode : float
    other : ndarray, shape (...)
    driven_mass : float
    Returns ndarray, shape (...) each.
    """
    xp = _namespace(transmission_angle)
    x0 = xp.sin(transmission_angle)
    x1 = x0**2
    x2 = 9.869604401089358
    x3 = mode**2
    x4 = x2 * x3
    x5 = x4 * driven_mass
    x6 = xp.tan(transmission_angle)
    x7 = x6**2
    x8 = other**2
    x9 = x2 * mode**8 / x8
    x10 = 2 * x3
    return (
        x4 * (48 - 3 * x1 - 8 * x4 - 24 * x5) / (192 * x1),
        x4 * (x4 + 3 * x5 - 6) * xp.cos(transmission_angle) / (12 * x0**3),
        x9 / (x7 * (4 * mode**4 - other**4)),
        -2 * x9 * (x7 + 1) / (x6**3 * (x10 + x8) * (x10 - x8)),
    )
