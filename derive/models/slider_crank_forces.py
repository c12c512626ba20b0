"""The rigid slider-crank: joint forces, torque, force and moment on the frame."""

from __future__ import annotations

import sympy as sp

from ..ir import Description
from ..pipeline import Model
from ..rigid.forces import CHOICES, SolvedMotion, description, forces, moments_of, rate_symbols
from ..rigid.multibody import multibody_model
from ..rigid.planar import Body, Pin, PlanarLinkage, Slide
from ..spec import ModelSpec
from ..staged import KernelForms
from . import slider_crank
from .slider_crank import ARGUMENTS, coupler, crank, offset

t = sp.Symbol("t", real=True)
th2, th3, place = (sp.Function(name)(t) for name in ("th2", "th3", "place"))
_ZERO = (sp.S.Zero, sp.S.Zero)


def linkage(spec: ModelSpec) -> PlanarLinkage:
    """Return bodies, joints and drive of the linkage ABC; the guide belongs to the frame."""
    pin = crank * sp.cos(th2), crank * sp.sin(th2)
    return PlanarLinkage(
        t,
        (
            Body("crank", th2, _ZERO, moments_of(2, spec)),
            Body("coupler", th3, pin, moments_of(3, spec)),
            Body("slider", sp.S.Zero, (place, offset), moments_of(4, spec)),
        ),
        (
            Pin(1, 2, _ZERO, _ZERO),
            Pin(2, 3, (crank, sp.S.Zero), _ZERO),
            Pin(3, 4, (coupler, sp.S.Zero), _ZERO),
            Slide(4, 1, slider=4, guide=1, through=(sp.S.Zero, offset), distance=place),
        ),
    )


def motion() -> SolvedMotion:
    """Return the kinematics as the forces use them."""
    k = slider_crank.kinematics()
    spin, turn = rate_symbols(th3)
    lifted = crank / coupler * (rate_symbols(th2)[0] * k.sin2 - rate_symbols(th2)[1] * k.cos2)
    return SolvedMotion(
        geometry=ARGUMENTS[1:],
        steps=k.steps,
        theta2=slider_crank.theta2,
        names={
            sp.sin(th2): k.sin2,
            sp.cos(th2): k.cos2,
            sp.sin(th3): k.sin3,
            sp.cos(th3): k.cos3,
            place: k.position,
        },
        rates={th2: (sp.S.One, sp.S.Zero), th3: (k.w3, k.a3), place: (k.v4, k.a4)},
        differences={
            k.sin2 * k.cos3: k.sin23 + k.cos2 * k.sin3,
            k.cos2 * k.cos3: k.cos23 - k.sin2 * k.sin3,
            # Across the guide the coupler moves as the crank pin: the closure twice differentiated.
            turn * k.cos3: spin * k.sin3 + lifted,
        },
    )


def _forces(spec: ModelSpec) -> KernelForms:
    return forces(spec, linkage(spec), motion())


def _describe(spec: ModelSpec) -> Description:
    return description(
        spec,
        "the rigid slider-crank",
        ARGUMENTS[0],
        ARGUMENTS[1:],
        ("Newton and Euler's, as Smith (4.4)-(4.6)",),
        sliding="41",
    )


MODEL = Model(
    mechanism="slider_crank",
    formulations=("forces",),
    energies=_forces,
    describe=_describe,
    choices=CHOICES,
)
MULTIBODY = multibody_model("slider_crank", "the rigid slider-crank", linkage, ARGUMENTS[1:-1])
