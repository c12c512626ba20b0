"""The rigid quick-return mechanism: joint forces, torque, force and moment on the frame."""

from __future__ import annotations

import sympy as sp

from ..ir import Description
from ..pipeline import Model
from ..rigid.forces import CHOICES, SolvedMotion, description, forces, moments_of
from ..rigid.multibody import multibody_model
from ..rigid.planar import Body, Pin, PlanarLinkage, Slide
from ..spec import ModelSpec
from ..staged import KernelForms
from . import quick_return
from .quick_return import ARGUMENTS, crank, frame

t = sp.Symbol("t", real=True)
th2, th4, slide = (sp.Function(name)(t) for name in ("th2", "th4", "slide"))
_ZERO = (sp.S.Zero, sp.S.Zero)


def linkage(spec: ModelSpec) -> PlanarLinkage:
    """Return bodies, joints and drive: crank AB, the block at B, the rod through it from D."""
    pin = crank * sp.cos(th2), crank * sp.sin(th2)
    pivot = -frame, sp.S.Zero
    return PlanarLinkage(
        t,
        (
            Body("crank", th2, _ZERO, moments_of(2, spec)),
            Body("block", th4, pin, moments_of(3, spec)),
            Body("rod", th4, pivot, moments_of(4, spec)),
        ),
        (
            Pin(1, 2, _ZERO, _ZERO),
            Pin(2, 3, (crank, sp.S.Zero), _ZERO),
            Slide(3, 4, slider=3, guide=4, through=_ZERO, distance=slide),
            Pin(4, 1, _ZERO, pivot),
        ),
    )


def motion() -> SolvedMotion:
    """Return the kinematics as the forces use them."""
    k = quick_return.kinematics()
    slip = sp.Symbol("slip4", real=True)
    return SolvedMotion(
        geometry=ARGUMENTS[1:],
        # Seen from the crank, the frame turns backward.
        steps=k.steps.then((slip, frame * k.cos4 / k.slide)),
        theta2=quick_return.theta2,
        names={
            sp.sin(th2): k.sin2,
            sp.cos(th2): k.cos2,
            sp.sin(th4): k.sin4,
            sp.cos(th4): k.cos4,
            slide: k.slide,
        },
        rates={th2: (sp.S.One, sp.S.Zero), th4: (k.w4, k.a4)},
        differences={
            k.sin2 * k.cos4: k.sin24 + k.cos2 * k.sin4,
            k.cos2 * k.cos4: k.cos24 - k.sin2 * k.sin4,
            k.cos4**2: 1 - k.sin4**2,
        },
        groups=(k.sin24, k.cos24),
        slips={k.w4: slip},
    )


def _forces(spec: ModelSpec) -> KernelForms:
    return forces(spec, linkage(spec), motion())


def _describe(spec: ModelSpec) -> Description:
    return description(
        spec,
        "the rigid quick-return mechanism",
        ARGUMENTS[0],
        ARGUMENTS[1:],
        ("Newton and Euler's, as Smith (4.4)-(4.6)",),
        sliding="34",
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("forces",),
    energies=_forces,
    describe=_describe,
    choices=CHOICES,
)
MULTIBODY = multibody_model(
    "quick_return", "the rigid quick-return mechanism", linkage, ARGUMENTS[1:]
)
