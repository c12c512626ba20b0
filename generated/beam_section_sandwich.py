"""Bending stiffness of three layers with a viscoelastic core.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam_section, formulation sandwich.
Equations: Aannaque 9.2 (laminated viscoelastic beam).

The outer layers are elastic and bend without shear; the core, of complex shear modulus
core_shear_modulus (1 + i core_loss), shears and carries no axial force.

Cost per evaluation:
    sandwich: 58 operations
Content hash 68d6ed5a3dd445b183824b8b5d006a31; derived with SymPy 1.14.0.
"""

__all__ = ["sandwich"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"sandwich","mechanism":"beam_section","m'
    'odes":null,"outputs":[]}'
)
CONTENT = "68d6ed5a3dd445b183824b8b5d006a31"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "wave_number": ("rad/m", "2 pi over the wave length of the deflection"),
    "width": ("m", "Extent across the plane of bending"),
    "base_modulus": ("Pa", "Young's modulus of the first layer"),
    "base_thickness": ("m", "Thickness of the first layer"),
    "core_shear_modulus": ("Pa", "Real part of the shear modulus"),
    "core_loss": ("", "Imaginary part over the real part"),
    "core_thickness": ("m", "Thickness of the core"),
    "cover_modulus": ("Pa", "Young's modulus of the third layer"),
    "cover_thickness": ("m", "Thickness of the third layer"),
    "bending_stiffness": ("N m^2", "Real part of the bending stiffness"),
    "loss_factor": ("", "Its imaginary part over its real part"),
    "slack": ("N m^2", "Bending stiffness where the core does not resist shear"),
    "bonded": ("N m^2", "Bending stiffness where the core is rigid in shear"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {"sandwich": ("bending_stiffness", "loss_factor", "slack", "bonded")}


def sandwich(
    wave_number, width, base_modulus, base_thickness, core_shear_modulus, core_loss,
    core_thickness, cover_modulus, cover_thickness,
):
    """Return the bending stiffness of a sinusoidal deflection, and its loss factor.

    wave_number : ndarray, shape (...)
    width to cover_thickness : float or ndarray
    Returns ndarray, shape (...) each.
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
    return stored, lost / stored, x0, x0 + x10 * x6 / (4 * x9)
