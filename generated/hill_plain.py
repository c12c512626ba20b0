"""Hill's equation with viscous damping.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism hill, formulation plain.
Equations: Smith (7.11); Smith (7.38).

The caller supplies f as a function of the angle, by the name 'f'.

Cost per evaluation:
    scales: 0 operations
Content hash 7ee6a238fac2a59cc2d78dbe61ba21ca; derived with SymPy 1.14.0.
"""

__all__ = ["scales"]
FAMILY = "linear_periodic"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"plain","mechanism":"hill","modes":null,'
    '"outputs":[]}'
)
CONTENT = "7ee6a238fac2a59cc2d78dbe61ba21ca"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "lam2": ("1/s^2", "Constant part of the stiffness"),
    "mu": ("1/s^2", "Factor of the periodic part f"),
    "damping": ("1/s", "K of 2 K y'"),
}
PARAMETERS = ("lam2", "mu", "damping")

# Names of what each function returns, in order.
RETURNS = {"scales": ("damping", "lam2", "mu")}
EXTERNAL = ("f",)
MODAL_1 = ((1.0,),)
MODAL_2 = ((2.0,),)

# Separated terms: array, extra power of the crank speed, scale, function of angle, and modal array
# or integral over the shapes.
TERMS = (
    ("M", 0, None, None, "modal_1"),
    ("C", 0, "damping", None, "modal_2"),
    ("K", 0, "lam2", None, "modal_1"),
    ("Kg", 0, "mu", "f", "modal_1"),
)


def scales(lam2, mu, damping):
    """Return the factors made of parameters.

    lam2, mu, damping : float
    Returns float or ndarray each.
    """
    return damping, lam2, mu
