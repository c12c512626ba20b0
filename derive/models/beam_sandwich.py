"""Bending stiffness of a beam of three layers whose core is viscoelastic in shear.

The outer layers stretch and bend, the core shears; the deflection is a sine along the beam.  The
field equations of the two stretchings give their amplitudes, that of the deflection the stiffness;
the core's complex shear modulus then enters by the correspondence principle.
"""

from __future__ import annotations

import sympy as sp

from ..integrals import definite
from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..records import ActionDensity
from ..spec import ModelSpec
from ..staged import ClosedForm, Steps
from ..variational import hamilton

_SHAPE = "ndarray, shape (...)"
_ARGUMENTS = (
    Argument("wave_number", _SHAPE, "rad/m", "2 pi over the wave length of the deflection"),
    Argument("width", "float or ndarray", "m", "Extent across the plane of bending"),
    Argument("base_modulus", "float or ndarray", "Pa", "Young's modulus of the first layer"),
    Argument("base_thickness", "float or ndarray", "m", "Thickness of the first layer"),
    Argument("core_shear_modulus", "float or ndarray", "Pa", "Real part of the shear modulus"),
    Argument("core_loss", "float or ndarray", "", "Imaginary part over the real part"),
    Argument("core_thickness", "float or ndarray", "m", "Thickness of the core"),
    Argument("cover_modulus", "float or ndarray", "Pa", "Young's modulus of the third layer"),
    Argument("cover_thickness", "float or ndarray", "m", "Thickness of the third layer"),
)
_INPUTS = tuple(sp.Symbol(argument.name, positive=True) for argument in _ARGUMENTS)
k, width, e1, h1, shear, loss, h2, e3, h3 = _INPUTS
x, t, y = sp.symbols("x t y", real=True)
u1, u3, w = (sp.Function(name)(x, t) for name in ("u1", "u3", "w"))
modulus = sp.Symbol("complex_modulus")


def sandwich_action() -> ActionDensity:
    """Return less the strain energy per length of three layers, the core's modulus any number.

    u1 and u3 are the displacements along the beam of the mid-lines of the outer layers, w the
    deflection that all layers share.
    """
    energy = sp.S.Zero
    for stretch, young, height in ((u1, e1, h1), (u3, e3, h3)):
        strain = stretch.diff(x) - y * w.diff(x, 2)
        across = definite(sp.expand(young * width * strain**2 / 2), y, -height / 2, height / 2)
        energy += across
    below, above = u1 - h1 / 2 * w.diff(x), u3 + h3 / 2 * w.diff(x)
    angle = (above - below) / h2 + w.diff(x)
    energy += modulus * width * h2 * angle**2 / 2
    return ActionDensity(x=x, t=t, length=sp.Symbol("l"), fields=(u1, u3, w), density=-energy)


def complex_stiffness() -> sp.Expr:
    """Return the bending stiffness felt by a sinusoidal deflection, rational in the modulus."""
    a1, a3 = sp.symbols("a1 a3")
    wave = {u1: a1 * sp.cos(k * x), u3: a3 * sp.cos(k * x), w: sp.sin(k * x)}
    equations = hamilton(sandwich_action()).equations
    residual = {item: sp.expand(equations[item].subs(wave).doit()) for item in (u1, u3, w)}
    stretching = [residual[item].coeff(sp.cos(k * x)) for item in (u1, u3)]
    (amplitudes,) = sp.solve(stretching, [a1, a3], dict=True)
    load = residual[w].coeff(sp.sin(k * x)).subs(amplitudes)
    return sp.cancel(-load / k**4)


def _form(spec: ModelSpec) -> ClosedForm:
    whole = complex_stiffness()
    slack = whole.subs(modulus, 0)
    upper, lower = (sp.Poly(part, modulus) for part in sp.fraction(whole))
    bonded = sp.cancel(upper.LC() / lower.LC())
    coupled = sp.factor(sp.cancel(whole - slack).subs(modulus, shear * (1 + sp.I * loss)))
    over, under = sp.fraction(coupled)
    by_parts = [sp.expand(part).as_real_imag() for part in (over, under)]
    (a, b), (c, d) = by_parts
    below = sp.factor(sp.expand(c)) ** 2 + sp.factor(sp.expand(d)) ** 2
    stored = sp.factor(slack) + sp.factor(sp.expand(a * c + b * d)) / below
    lost = sp.factor(sp.expand(b * c - a * d)) / below
    for part in (sp.fraction(sp.together(value)) for value in (stored, lost)):
        if any(term < 0 for polynomial in part for term in sp.Poly(polynomial, *_INPUTS).coeffs()):
            raise ValueError("a stiffness is no sum of positive terms")
    real, imaginary = sp.symbols("stored lost", positive=True)
    outputs = (
        ("bending_stiffness", real),
        ("loss_factor", imaginary / real),
        ("slack", sp.factor(slack)),
        ("bonded", sp.factor(slack) + sp.factor(sp.cancel(bonded - slack))),
    )
    return ClosedForm(_INPUTS, Steps(((real, stored), (imaginary, lost))), outputs)


def _describe(spec: ModelSpec) -> Description:
    results = (
        ("bending_stiffness", "N m^2", "Real part of the bending stiffness"),
        ("loss_factor", "", "Its imaginary part over its real part"),
        ("slack", "N m^2", "Bending stiffness where the core does not resist shear"),
        ("bonded", "N m^2", "Bending stiffness where the core is rigid in shear"),
    )
    return Description(
        title="Bending stiffness of three layers with a viscoelastic core",
        references=("Aannaque 9.2 (laminated viscoelastic beam)",),
        arguments=_ARGUMENTS,
        kernel="sandwich",
        summary="Return the bending stiffness of a sinusoidal deflection, and its loss factor",
        results={name: Result(name, _SHAPE, unit, text) for name, unit, text in results},
        notes=(
            "The outer layers are elastic and bend without shear; the core, of complex shear "
            "modulus core_shear_modulus (1 + i core_loss), shears and carries no axial force.",
        ),
    )


MODEL = Model(
    mechanism="beam_section",
    formulations=("sandwich",),
    energies=_form,
    describe=_describe,
)
