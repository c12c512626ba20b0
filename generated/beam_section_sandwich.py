"""Bending stiffness of three layers with a viscoelastic core.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_section, formulation sandwich.
Equations: Aannaque 9.2 (laminated viscoelastic beam).

The outer layers are elastic and bend without shear; the core, of complex shear modulus
core_shear_modulus (1 + i core_loss), shears and carries no axial force.

Cost per evaluation:
    sandwich: 58 operations
Content hash cbaf12c66f2c28d82f6d862521ce2ce3; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "sandwich",
]

FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"sandwich","mechanism":"beam_section","m'
    'odes":null,"outputs":[]}'
)
CONTENT = "cbaf12c66f2c28d82f6d862521ce2ce3"

# Parameters: name, unit, meaning.
PARAMETERS = (
)

# Names of what each function returns, in order.
RETURNS = {
    "sandwich": (
        "bending_stiffness",
        "loss_factor",
        "slack",
        "bonded",
    ),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def sandwich(
    wave_number, width, base_modulus, base_thickness, core_shear_modulus, core_loss,
    core_thickness, cover_modulus, cover_thickness,
):
    """Return the bending stiffness of a sinusoidal deflection, and its loss factor.

    Parameters
    ----------
    wave_number : ndarray, shape (...)
        2 pi over the wave length of the deflection [rad/m].
    width : float or ndarray
        Extent across the plane of bending [m].
    base_modulus : float or ndarray
        Young's modulus of the first layer [Pa].
    base_thickness : float or ndarray
        Thickness of the first layer [m].
    core_shear_modulus : float or ndarray
        Real part of the shear modulus [Pa].
    core_loss : float or ndarray
        Imaginary part over the real part.
    core_thickness : float or ndarray
        Thickness of the core [m].
    cover_modulus : float or ndarray
        Young's modulus of the third layer [Pa].
    cover_thickness : float or ndarray
        Thickness of the third layer [m].

    Returns
    -------
    bending_stiffness : ndarray, shape (...)
        Real part of the bending stiffness [N m^2].
    loss_factor : ndarray, shape (...)
        Its imaginary part over its real part.
    slack : ndarray, shape (...)
        Bending stiffness where the core does not resist shear [N m^2].
    bonded : ndarray, shape (...)
        Bending stiffness where the core is rigid in shear [N m^2].

    Notes
    -----
    Aannaque 9.2 (laminated viscoelastic beam).
    """
    x0 = width * (base_modulus * base_thickness**3 + cover_modulus * cover_thickness**3) / 12
    x1 = core_loss**2
    x2 = base_modulus * base_thickness
    x3 = x2 * core_shear_modulus
    x4 = cover_modulus * cover_thickness
    x5 = x4 * core_shear_modulus
    x6 = x2 * x4
    x7 = core_thickness * wave_number**2
    x8 = x3 + x5 + x6 * x7
    x9 = x2 + x4
    x10 = width * (base_thickness + 2 * core_thickness + cover_thickness)**2
    x11 = 4 * x10 / (16 * x1 * x9**2 * core_shear_modulus**2 + 16 * x8**2)
    stored = x0 + x3 * x4 * x11 * (x1 * x3 + x1 * x5 + x8)
    lost = (
        core_loss * core_shear_modulus * base_modulus**2 * base_thickness**2 * cover_modulus**2 *
        cover_thickness**2 * x11 * x7
    )
    del x8, x11, x7
    return (
        stored,
        lost / stored,
        x0,
        x0 + x10 * x6 / (4 * x9),
    )
