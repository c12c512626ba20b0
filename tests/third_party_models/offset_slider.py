"""Kinematics of the slider-crank, offset or not, in closed form and derived from loop closure."""

from __future__ import annotations

import sympy as sp
from elastolink.derive import authoring as au

ARGUMENTS = (
    au.angle("theta", "Crank angle"),
    au.scalar("crank", "m", "Length of the crank"),
    au.scalar("rod", "m", "Length of the connecting rod"),
    au.scalar("offset", "m", "Height of the slide above the crank's centre"),
)
theta, crank, rod, offset = au.symbols(ARGUMENTS)
_SHAPE = "ndarray, shape (...)"
_RESULTS = {
    "position": ("m", "Place of the slider along the slide"),
    "speed": ("m", "Its derivative by the crank angle"),
    "acceleration": ("m", "Its second derivative by the crank angle"),
    "rod_angle": ("rad", "Angle of the rod from the slide, anticlockwise"),
    "rod_speed": ("", "Its derivative by the crank angle"),
    "rod_acceleration": ("1/rad", "Its second derivative by the crank angle"),
}


def _closed_form(spec: au.ModelSpec) -> au.ClosedForm:
    """Solve ``crank e(theta) + rod e(phi) = (x, offset)`` and differentiate the loop."""
    x, phi = sp.Function("x")(theta), sp.Function("phi")(theta)
    loop = (
        crank * sp.cos(theta) + rod * sp.cos(phi) - x,
        crank * sp.sin(theta) + rod * sp.sin(phi) - offset,
    )
    rise, along, angle, x1, phi1, x2, phi2 = sp.symbols(
        "rise along angle speed rod_speed acceleration rod_acceleration", real=True
    )
    first = [sp.diff(side, theta) for side in loop]
    second = [sp.diff(side, theta, 2) for side in loop]
    names = {
        x.diff(theta, 2): x2,
        phi.diff(theta, 2): phi2,
        x.diff(theta): x1,
        phi.diff(theta): phi1,
        sp.cos(phi): along / rod,
        sp.sin(phi): rise / rod,
    }
    rates = sp.solve([side.subs(names) for side in first], (x1, phi1), dict=True)[0]
    bends = sp.solve([side.subs(names) for side in second], (x2, phi2), dict=True)[0]
    steps = au.Steps(
        (
            (rise, offset - crank * sp.sin(theta)),
            (along, sp.sqrt((rod - rise) * (rod + rise))),
            (angle, sp.atan2(rise, along)),
            (phi1, rates[phi1]),
            (x1, rates[x1]),
            (phi2, bends[phi2]),
            (x2, bends[x2]),
        )
    )
    values = (crank * sp.cos(theta) + along, x1, x2, angle, phi1, phi2)
    outputs = tuple(zip(_RESULTS, values, strict=True))
    return au.ClosedForm((theta, crank, rod, offset), steps, outputs)


def _describe(spec: au.ModelSpec) -> au.Description:
    return au.Description(
        title="Kinematics of the slider-crank",
        references=("textbook",),
        arguments=ARGUMENTS,
        kernel="motion",
        summary="Return place, speeds and accelerations of slider and rod",
        results={
            name: au.Result(name, _SHAPE, unit, meaning)
            for name, (unit, meaning) in _RESULTS.items()
        },
    )


MODEL = au.Model(
    mechanism="offset_slider",
    formulations=("kinematics",),
    energies=_closed_form,
    describe=_describe,
)
SPECS = (
    au.ModelSpec("offset_slider", "kinematics"),
    au.ModelSpec("offset_slider", "kinematics", outputs=("position",)),
)
