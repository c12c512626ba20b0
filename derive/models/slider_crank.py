"""The slider-crank: closed-form kinematics of both assemblies, from loop closure alone.

The crank AB turns about A at the origin; the coupler BC ends at the slider's pin C, which moves
along ``y = offset``.  ``theta2`` and ``theta3`` are the angles of AB and BC with the guide.
Derivatives are with respect to the crank angle, as in the four-bar linkage.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from ..ir import Argument, Description, array_results
from ..pipeline import Model
from ..rigid.closure import SolvedLoop, closure_rates
from ..safe import UnsafeRewriting, root_of_parts
from ..spec import ModelSpec
from ..staged import ClosedForm, Step, Steps

theta2 = sp.Symbol("theta2", real=True)
crank, coupler = sp.symbols("crank coupler", positive=True)
offset, assembly = sp.symbols("offset assembly", real=True)

ARGUMENTS = (
    Argument("theta2", "ndarray or float, shape (...)", "rad", "Crank angle from the guide"),
    Argument("crank", "float", "m", "Length of the crank AB"),
    Argument("coupler", "float", "m", "Length of the coupler BC"),
    Argument("offset", "float", "m", "Height of the guide over the crank's pivot A"),
    Argument("assembly", "float", "", "+1 where the slider is right of B (open), -1 left"),
)
_RESULTS = {
    "theta3": ("rad", "Coupler angle from B to C; open -pi/2 to pi/2, crossed pi/2 to 3 pi/2"),
    "position": ("m", "Place of the slider's pin C along the guide, from A"),
    "omega3": ("", "Coupler speed over crank speed, d theta3 / d theta2"),
    "alpha3": ("", "Coupler acceleration over crank speed squared, at constant crank speed"),
    "slider_velocity": ("m", "Slider velocity over crank speed"),
    "slider_acceleration": (
        "m",
        "Slider acceleration over crank speed squared, at constant crank speed",
    ),
    "transmission_angle": ("rad", "Angle between coupler and the normal of the guide, 0 to pi"),
}


@dataclass(frozen=True, kw_only=True)
class Kinematics(SolvedLoop):
    """The solved linkage: its symbols, and the steps that define them.

    ``reach``, ``total``: ``l3 - l2`` and ``l3 + l2``; ``sin3``, ``cos3``: sine and cosine of the
    coupler angle; ``sin23``, ``cos23``: of ``theta2 - theta3``; ``raised``, ``lowered``: ``(1 +
    sin2) / 2`` and ``(1 - sin2) / 2``; ``above``, ``below``: ``l3 + offset - l2 sin2`` and ``l3 -
    offset + l2 sin2``: by how much the coupler is longer than what it must bridge across the guide,
    from either side; ``root``: ``sqrt(above below)``, the coupler's length along the guide; ``w3``,
    ``a3``: first and second derivative of ``theta3`` by the crank angle; ``position``, ``v4``,
    ``a4``: place of C along the guide, and its first and second derivative by the crank angle.
    """

    reach: sp.Symbol
    total: sp.Symbol
    sin3: sp.Symbol
    cos3: sp.Symbol
    sin23: sp.Symbol
    cos23: sp.Symbol
    raised: sp.Symbol
    lowered: sp.Symbol
    above: sp.Symbol
    below: sp.Symbol
    root: sp.Symbol
    w3: sp.Symbol
    a3: sp.Symbol
    position: sp.Symbol
    v4: sp.Symbol
    a4: sp.Symbol

    @property
    def of_angles(self) -> dict[sp.Expr, sp.Symbol]:
        """Sine and cosine of each link's angle as a function of time, and their symbols."""
        table = {sp.sin(_TH2): self.sin2, sp.sin(_TH3): self.sin3}
        return table | {sp.cos(_TH2): self.cos2, sp.cos(_TH3): self.cos3}


_EMITTED = {"w3": "omega3", "a3": "alpha3", "v4": "slider_velocity", "a4": "slider_acceleration"}
_T = sp.Symbol("t", real=True)
_TH2, _TH3, _PLACE = (sp.Function(name)(_T) for name in ("th2", "th3", "place"))
_LOOP = (
    crank * sp.cos(_TH2) + coupler * sp.cos(_TH3) - _PLACE,
    crank * sp.sin(_TH2) + coupler * sp.sin(_TH3) - offset,
)


@cache
def kinematics() -> Kinematics:
    """Solve the loop closure AB + BC = AC for coupler and slider.

    Result: steps free of cancellation beyond that of the lengths themselves.
    """
    k = Kinematics.unsolved(_EMITTED)
    start = (
        (k.reach, coupler - crank),
        (k.total, coupler + crank),
        (k.half_sine, sp.sin(theta2 / 2)),
        (k.half_cosine, sp.cos(theta2 / 2)),
        (k.sin2, 2 * k.half_sine * k.half_cosine),
        (k.cos2, (k.half_cosine - k.half_sine) * (k.half_cosine + k.half_sine)),
        (k.raised, (k.half_cosine + k.half_sine) ** 2 / 2),
        (k.lowered, (k.half_cosine - k.half_sine) ** 2 / 2),
    )
    return replace(k, steps=Steps((*start, *_positions(k), *_rates(k))))


def _positions(k: Kinematics) -> tuple[Step, ...]:
    """Return sine and cosine of the coupler's angle, and the place of the slider."""
    along, across = (equation.subs(k.of_angles) for equation in _LOOP)
    (sine,) = sp.solve(across, k.sin3)
    (place,) = sp.solve(along, _PLACE)
    # cos^2 = (1 - sin) (1 + sin); each factor is linear in the sine of the crank angle.
    above, below = (sp.expand(coupler * (1 + sign * sine)) for sign in (1, -1))
    square = sp.expand(coupler**2 * (1 - sine**2))
    length = root_of_parts((above, below), (k.above, k.below), k.root, square)
    return (
        (k.above, _by_ends(k, above)),
        (k.below, _by_ends(k, below)),
        (k.root, sp.sqrt(k.above * k.below)),
        (k.sin3, sine),
        (k.cos3, assembly * length / coupler),
        (k.sin23, k.sin2 * k.cos3 - k.cos2 * k.sin3),
        (k.cos23, k.cos2 * k.cos3 + k.sin2 * k.sin3),
        (k.position, place),
    )


def _rates(k: Kinematics) -> tuple[Step, ...]:
    """Differentiate the loop closure twice by the crank angle and solve for the derivatives.

    The coupler's acceleration times ``cos^3`` is a quadratic in the sine of the crank angle.  It
    vanishes with ``cos^3`` at a change point; in terms that vanish there too, it keeps its digits.
    """
    rates = {_TH2: (sp.S.One, sp.S.Zero), _TH3: (k.w3, k.a3), _PLACE: (k.v4, k.a4)}
    speeds, changes = closure_rates(_LOOP, _T, rates, k.of_angles)
    (w3,) = sp.solve(speeds[1], k.w3)
    (v4,) = sp.solve(speeds[0].subs(k.w3, w3), k.v4)
    (a3,) = sp.solve(changes[1], k.a3)
    (a4,) = sp.solve(changes[0], k.a4)
    turning = k.sin23 + k.cos2 * k.sin3  # sin2 cos3
    v4 = sp.expand(v4 * k.cos3).subs(k.sin2 * k.cos3, turning)
    curve = sp.expand(sp.cancel(a3.subs(k.w3, w3) * (coupler * k.cos3) ** 3 / crank))
    curve = sp.expand(curve.subs(k.cos3**2, 1 - k.sin3**2).subs(k.cos2**2, 1 - k.sin2**2))
    (sine,) = sp.solve(_LOOP[1].subs(k.of_angles), k.sin3)
    curve = sp.expand(curve.subs(k.sin3, sine))
    return (
        (k.w3, w3),
        (k.a3, crank * _by_square(k, curve) / (coupler * k.cos3) ** 3),
        (k.v4, sp.factor(sp.expand(v4)) / k.cos3),
        (k.a4, sp.factor_terms(a4)),
    )


def _by_ends(k: Kinematics, factor: sp.Expr) -> sp.Expr:
    """Write a factor linear in the sine of the crank angle by ``raised`` and ``lowered``."""
    ends = (sp.factor(factor.subs(k.sin2, end).subs(_sums(k))) for end in (1, -1))
    form = sum(end * part for end, part in zip(ends, (k.raised, k.lowered), strict=True))
    back = form.subs({k.raised: (1 + k.sin2) / 2, k.lowered: (1 - k.sin2) / 2})
    if sp.expand(back - factor.subs(_sums(k))) != 0:
        raise UnsafeRewriting(f"{form} is not {factor}")
    return form


def _by_square(k: Kinematics, polynomial: sp.Expr) -> sp.Expr:
    """Write ``c + s (a + b s)`` in the sine s as ``c cos^2 + s (a + (b + c) s)``.

    The factor of the sine is then written by its ends.
    """
    level = polynomial.subs(k.sin2, 0)
    factor = sp.cancel((polynomial - level * (1 - k.sin2**2)) / k.sin2)
    return level * k.cos2**2 + k.sin2 * _by_ends(k, factor)


def _sums(k: Kinematics) -> dict[sp.Symbol, sp.Expr]:
    return {coupler: (k.total + k.reach) / 2, crank: (k.total - k.reach) / 2}


def _closed_form(spec: ModelSpec) -> ClosedForm:
    solved = kinematics()
    # Crossed, the coupler lies about pi; counted from there no branch of the angle is met.
    turned = sp.pi * (1 - assembly) / 2
    outputs = {
        "theta3": turned + sp.atan2(assembly * solved.sin3, assembly * solved.cos3),
        "position": solved.position,
        "omega3": solved.w3,
        "alpha3": solved.a3,
        "slider_velocity": solved.v4,
        "slider_acceleration": solved.a4,
        "transmission_angle": sp.atan2(assembly * solved.cos3, solved.sin3),
    }
    inputs = (theta2, crank, coupler, offset, assembly)
    closed = ClosedForm(inputs, solved.steps, tuple(outputs.items()))
    return closed.only(spec.outputs or outputs)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Kinematics of the slider-crank in closed form",
        references=("closure of the loop AB + BC = AC",),
        arguments=ARGUMENTS,
        kernel="motion",
        summary="Return angles and places, speeds and accelerations of coupler and slider",
        results=array_results(_RESULTS),
        notes=(
            "The length of the coupler along the guide is the root of two factors, each a sum of "
            "like-signed terms for every crank that turns fully; so no digit is lost where the "
            "coupler nearly stands across the guide.",
        ),
    )


MODEL = Model(
    mechanism="slider_crank",
    formulations=("kinematics",),
    energies=_closed_form,
    describe=_describe,
)
