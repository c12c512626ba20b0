"""Flexible rod of a quick-return mechanism, on shapes that follow the block.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism quick_return, formulation moving_basis, flexible rod, any number of modes.
Equations: Beale & Scott (1)-(4); Beale & Scott (16); Beale & Scott (18).

Coordinates are q_i in v = L sum q_i e_i(eta; xi), v the deflection from the line DB, eta = x/L, xi
the place of the block; arrays are divided by m L^3.

Cost per evaluation:
    scales: 6 operations
    angle_functions: 29 operations
    forcing_functions: 22 operations
    acceleration_forcing_functions: 18 operations
    place: 15 operations
    basis_products: 11 operations
Content hash 77ee5a9d5367c49e0b5bdf45a94a95bc; derived with SymPy 1.14.0.
"""

import numpy as np

__all__ = [
    "scales", "angle_functions", "forcing_functions", "acceleration_forcing_functions", "place",
    "basis_products",
]
FAMILY = "linear_periodic"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":["rod"],"formulation":"moving_basis","mechanism":"quick_r'
    'eturn","modes":null,"outputs":[]}'
)
CONTENT = "77ee5a9d5367c49e0b5bdf45a94a95bc"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "bending_stiffness": ("N m^2", "EI of the rod"),
    "mass_per_length": ("kg/m", "m of the rod"),
    "damping": ("N s/m^2", "Viscous damping of the rod per length"),
    "internal_damping": ("N m^2 s", "Moment per rate of curvature (Kelvin-Voigt)"),
    "length": ("m", "Length of the rod from D to its tip"),
    "theta2": ("rad", "Crank angle from the line DA"),
    "frame": ("m", "Distance DA of the rod's pivot from the crank's"),
    "crank": ("m", "Length of the crank AB"),
    "place": ("", "Place of the support as a fraction of the length"),
    "mean_row": ("", "The vector mean, along the rows"),
    "moment_row": ("", "The vector moment, along the rows"),
    "mean_column": ("", "The vector mean, along the columns"),
    "moment_column": ("", "The vector moment, along the columns"),
}
PARAMETERS = ("bending_stiffness", "mass_per_length", "damping", "internal_damping")

# Names of what each function returns, in order.
RETURNS = {
    "scales": (
        "damping_over_mass_per_length", "internal_damping_over_length_mass_per_length",
        "bending_stiffness_over_length_mass_per_length",
    ),
    "angle_functions": ("angle_sliding", "angle_omega4", "angle_sliding_3", "angle_omega4_4"),
    "forcing_functions": ("forcing_alpha4",),
    "acceleration_forcing_functions": ("acceleration_forcing_omega4",),
    "place": ("place",),
    "basis_products": ("frame",),
}
EXTERNAL = ()

# Integrals over shapes e_i(eta; xi) that are passed in: name, coefficients of the weight by powers
# of eta, derivatives by eta and xi of the first and of the second factor, and the eta of a value
# that is no integral.
BASIS = (
    ("overlap", (1.0,), (0, 0), (0, 0), None),
    ("drift", (1.0,), (0, 0), (0, 1), None),
    ("drift_drift", (1.0,), (0, 1), (0, 1), None),
    ("tension", (0.5, 0.0, -0.5), (1, 0), (1, 0), None),
    ("bending", (1.0,), (2, 0), (2, 0), None),
    ("bending_drift", (1.0,), (2, 0), (2, 1), None),
    ("moment", (0.0, 1.0), (0, 0), None, None),
    ("mean", (1.0,), (0, 0), None, None),
)

# Separated terms: array, extra power of the crank speed, scale, function of angle, and modal array
# or integral over the shapes.
TERMS = (
    ("M", 0, None, None, "overlap"),
    ("A", 0, None, "angle_sliding", "drift"),
    ("B", 0, None, "angle_omega4", "overlap"),
    ("B", 0, None, "angle_sliding_3", "drift_drift"),
    ("B", 0, None, "angle_omega4_4", "tension"),
    ("C", 0, "damping_over_mass_per_length", None, "overlap"),
    ("C", 0, "internal_damping_over_length_mass_per_length", None, "bending"),
    ("D", 0, "damping_over_mass_per_length", "angle_sliding", "drift"),
    ("D", 0, "internal_damping_over_length_mass_per_length", "angle_sliding", "bending_drift"),
    ("K", 0, "bending_stiffness_over_length_mass_per_length", None, "bending"),
    ("f", 0, None, "forcing_alpha4", "moment"),
    ("g", 0, None, "acceleration_forcing_omega4", "moment"),
)

# Terms of the energies that may be left out, to the names of what then vanishes, or to the
# separated terms that go and those that come.
DROPS = {
    ("frame",): ((), (("B", 0, None, "angle_omega4_4", "frame"),)),
    ("tension",): (
        (("B", 0, None, "angle_omega4_4", "tension"),), (("B", 0, None, "angle_omega4", "frame"),),
    ),
    ("frame", "tension"): ((("B", 0, None, "angle_omega4_4", "tension"),), ()),
}


def _namespace(array):
    """Return the array namespace of an argument, NumPy where it has none."""
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    return np


def scales(bending_stiffness, mass_per_length, damping, internal_damping, length):
    """Return the factors made of parameters.

    bending_stiffness, mass_per_length, damping, internal_damping, length : float
    Returns float or ndarray each.
    """
    x0 = 1 / mass_per_length
    x1 = x0 / length**4
    return x0 * damping, x1 * internal_damping, x1 * bending_stiffness


def angle_functions(theta2, frame, crank, length):
    """Return the functions of angle in the matrices.

    theta2 : ndarray or float, shape (...)
    frame, crank, length : float
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
    omega4 = crank * (far * x1 - near * x2) / slide2
    del slide2, x1, x2
    slide_velocity = -crank * frame * sin2 / slide
    sliding = slide_velocity / length
    del sin2, slide, slide_velocity
    x3 = omega4**2
    return sliding, x3, sliding**2, -x3


def forcing_functions(theta2, frame, crank):
    """Return the functions of angle in the forcing.

    theta2 : ndarray or float, shape (...)
    frame, crank : float
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    sin2 = 2 * half_cosine * half_sine
    slide2 = far**2 * half_cosine**2 + near**2 * half_sine**2
    del x0, half_cosine, half_sine
    alpha4 = -far * near * crank * frame * sin2 / slide2**2
    return -alpha4


def acceleration_forcing_functions(theta2, frame, crank):
    """Return the functions of angle in the forcing while the crank accelerates.

    theta2 : ndarray or float, shape (...)
    frame, crank : float
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    x1 = half_cosine**2
    x2 = half_sine**2
    del x0, half_cosine, half_sine
    slide2 = far**2 * x1 + near**2 * x2
    omega4 = crank * (far * x1 - near * x2) / slide2
    del slide2, x1, x2
    return -omega4


def place(theta2, frame, crank, length):
    """Return the place of the support, on which the shapes depend.

    theta2 : ndarray or float, shape (...)
    frame, crank, length : float
    Returns ndarray, shape (...).
    """
    xp = _namespace(theta2)
    near = frame - crank
    far = crank + frame
    x0 = theta2 / 2
    half_sine = xp.sin(x0)
    half_cosine = xp.cos(x0)
    slide2 = far**2 * half_cosine**2 + near**2 * half_sine**2
    del x0, half_cosine, half_sine
    slide = xp.sqrt(slide2)
    place = slide / length
    return place


def basis_products(mean_row, moment_row, mean_column, moment_column):
    """Return the matrices that are made of products of integrals.

    mean_row, moment_row : ndarray, shape (..., N, 1)
    mean_column, moment_column : ndarray, shape (..., 1, N)
    Returns ndarray, shape (..., N, N).
    """
    return (
        12 * mean_column * mean_row - 18 * mean_column * moment_row - 18 * mean_row * moment_column
        + 24 * moment_column * moment_row
    )
