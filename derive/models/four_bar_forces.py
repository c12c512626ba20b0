"""The rigid four-bar linkage: joint forces, torque, force and moment on the frame."""

from __future__ import annotations

import sympy as sp

from ..ir import Description
from ..pipeline import Model
from ..rigid.forces import CHOICES, SolvedMotion, description, forces, moments_of
from ..rigid.multibody import multibody_model
from ..rigid.planar import Body, Pin, PlanarLinkage
from ..spec import ModelSpec
from ..staged import KernelForms
from .four_bar import ARGUMENTS, coupler, crank, follower, frame, theta2
from .four_bar_vectors import link_vectors

t = sp.Symbol("t", real=True)
th2, th3, th4 = (sp.Function(name)(t) for name in ("th2", "th3", "th4"))
_ZERO = (sp.S.Zero, sp.S.Zero)


def linkage(spec: ModelSpec) -> PlanarLinkage:
    """Return bodies, joints and drive of the linkage ABCD (Smith Fig. 11)."""
    pin = crank * sp.cos(th2), crank * sp.sin(th2)
    pivot = frame, sp.S.Zero
    return PlanarLinkage(
        t,
        (
            Body("crank", th2, _ZERO, moments_of(2, spec)),
            Body("coupler", th3, pin, moments_of(3, spec)),
            Body("follower", th4, pivot, moments_of(4, spec)),
        ),
        (
            Pin(1, 2, _ZERO, _ZERO),
            Pin(2, 3, (crank, sp.S.Zero), _ZERO),
            Pin(3, 4, (coupler, sp.S.Zero), (follower, sp.S.Zero)),
            Pin(4, 1, _ZERO, pivot),
        ),
    )


def motion() -> SolvedMotion:
    """Return the kinematics as the forces use them."""
    v = link_vectors()
    return SolvedMotion(
        geometry=ARGUMENTS[1:],
        steps=v.steps,
        theta2=theta2,
        names={
            sp.cos(th2): v.crank_x / crank,
            sp.sin(th2): v.crank_y / crank,
            sp.cos(th3): v.coupler_x / coupler,
            sp.sin(th3): v.coupler_y / coupler,
            sp.cos(th4): v.follower_x / follower,
            sp.sin(th4): v.follower_y / follower,
        },
        rates={th2: (sp.S.One, sp.S.Zero), th3: (v.w3, v.a3), th4: (v.w4, v.a4)},
        differences=v.products,
        reciprocals={v.area: -v.inverse},
        groups=(v.area, v.facing),
        slips={v.w3: v.slip3, v.w4: v.slip4},
    )


def _forces(spec: ModelSpec) -> KernelForms:
    return forces(spec, linkage(spec), motion())


def _describe(spec: ModelSpec) -> Description:
    return description(
        spec,
        "the rigid four-bar linkage",
        ARGUMENTS[0],
        ARGUMENTS[1:],
        ("Smith (4.1)-(4.13)",),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=("forces",),
    energies=_forces,
    describe=_describe,
    choices=CHOICES,
)
MULTIBODY = multibody_model("four_bar", "the rigid four-bar linkage", linkage, ARGUMENTS[1:-1])
