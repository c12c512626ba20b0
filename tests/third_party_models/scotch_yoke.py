"""Kinematics of a Scotch yoke whose slot leans, in closed form and derived from loop closure."""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

ARGUMENTS = (
    au.angle("theta", "Crank angle"),
    au.scalar("crank", "m", "Length of the crank"),
    au.scalar("lean", "rad", "Angle of the slot from the normal of the slide"),
)
theta, crank, lean = au.symbols(ARGUMENTS)
_RESULTS = {
    "position": ("m", "Place of the yoke along the slide"),
    "speed": ("m", "Its derivative by the crank angle"),
    "acceleration": ("m", "Its second derivative by the crank angle"),
}


def _closed_form(spec: au.ModelSpec) -> au.ClosedForm:
    """Solve ``crank e(theta) = (x, 0) + rise (-sin lean, cos lean)`` and differentiate."""
    x, rise, place = sp.symbols("x rise place", real=True)
    loop = (
        crank * sp.cos(theta) - x + rise * sp.sin(lean),
        crank * sp.sin(theta) - rise * sp.cos(lean),
    )
    solved = sp.solve(loop, (x, rise), dict=True)[0][x]
    values = (place, sp.diff(solved, theta), sp.diff(solved, theta, 2))
    outputs = tuple(zip(_RESULTS, values, strict=True))
    return au.ClosedForm((theta, crank, lean), au.Steps(((place, solved),)), outputs)


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Kinematics of the Scotch yoke",
        references=("textbook",),
        arguments=ARGUMENTS,
        kernel="motion",
        summary="Return place, speed and acceleration of the yoke",
        results={
            name: au.Result(name, "ndarray, shape (...)", unit, meaning)
            for name, (unit, meaning) in _RESULTS.items()
        },
    )


MODEL = au.Model(
    mechanism="scotch_yoke", formulations=("kinematics",), energies=_closed_form, describe=_describe
)
_ALL = au.ModelSpec("scotch_yoke", "kinematics")
SPECS = (_ALL, _ALL.with_(outputs=("position",)))
