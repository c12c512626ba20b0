"""The quick-return mechanism: closed-form kinematics of its rod and sliding block.

The crank AB turns about A at the origin and carries a block at B; the block slides along a rod
that turns about D, a distance ``frame`` to the left of A.  ``theta2`` is the angle of AB,
``theta4`` that of the rod from D to B, ``slide`` the distance DB.  Derivatives are with respect to
the crank angle, as in the four-bar linkage.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from ..ir import Argument, Description, array_results
from ..pipeline import Model
from ..rigid.closure import SolvedLoop, closure_rates
from ..safe import UnsafeRewriting, bernstein_in_cosine
from ..spec import ModelSpec
from ..staged import ClosedForm, Step, Steps

theta2 = sp.Symbol("theta2", real=True)
frame, crank = sp.symbols("frame crank", positive=True)
winding = sp.Symbol("winding", real=True)

ARGUMENTS = (
    Argument("theta2", "ndarray or float, shape (...)", "rad", "Crank angle from the line DA"),
    Argument("frame", "float", "m", "Distance DA of the rod's pivot from the crank's"),
    Argument("crank", "float", "m", "Length of the crank AB"),
)
_WINDING = Argument(
    "winding", "float", "", "1 where the crank is longer than the frame (the rod turns), else 0"
)
_RESULTS = {
    "theta4": ("rad", "Rod angle from D to B, continuous over any number of turns"),
    "slide": ("m", "Distance DB of the block along the rod"),
    "omega4": ("", "Rod speed over crank speed, d theta4 / d theta2"),
    "alpha4": ("", "Rod acceleration over crank speed squared, at constant crank speed"),
    "slide_velocity": ("m", "Velocity of the block along the rod over crank speed"),
    "slide_acceleration": ("m", "Second derivative of slide by the crank angle"),
}


@dataclass(frozen=True, kw_only=True)
class Kinematics(SolvedLoop):
    """The solved linkage: its symbols, and the steps that define them.

    ``near``, ``far``: ``frame - crank`` and ``frame + crank``; ``sin4``, ``cos4``: sine and cosine
    of the rod angle; ``sin24``, ``cos24``: of ``theta2 - theta4``; ``slide2``, ``slide``: square of
    DB, and DB; ``w4``, ``a4``: first and second derivative of ``theta4`` by the crank angle;
    ``v3``, ``a3``: first and second derivative of ``slide`` by the crank angle.
    """

    near: sp.Symbol
    far: sp.Symbol
    sin4: sp.Symbol
    cos4: sp.Symbol
    sin24: sp.Symbol
    cos24: sp.Symbol
    slide2: sp.Symbol
    slide: sp.Symbol
    w4: sp.Symbol
    a4: sp.Symbol
    v3: sp.Symbol
    a3: sp.Symbol

    @property
    def of_angles(self) -> dict[sp.Expr, sp.Symbol]:
        """Sine and cosine of each link's angle as a function of time, and their symbols."""
        table = {sp.sin(_TH2): self.sin2, sp.sin(_TH4): self.sin4, _SLIDE: self.slide}
        return table | {sp.cos(_TH2): self.cos2, sp.cos(_TH4): self.cos4}


_EMITTED = {"w4": "omega4", "a4": "alpha4", "v3": "slide_velocity", "a3": "slide_acceleration"}
_T = sp.Symbol("t", real=True)
_TH2, _TH4, _SLIDE = (sp.Function(name)(_T) for name in ("th2", "th4", "x"))
_LOOP = (
    _SLIDE * sp.cos(_TH4) - frame - crank * sp.cos(_TH2),
    _SLIDE * sp.sin(_TH4) - crank * sp.sin(_TH2),
)


@cache
def kinematics() -> Kinematics:
    """Solve the loop closure DB = DA + AB for the rod and the block.

    Result: steps free of cancellation beyond that of the lengths themselves.
    """
    k = Kinematics.unsolved(_EMITTED)
    start = (
        (k.near, frame - crank),
        (k.far, frame + crank),
        (k.half_sine, sp.sin(theta2 / 2)),
        (k.half_cosine, sp.cos(theta2 / 2)),
        (k.sin2, 2 * k.half_sine * k.half_cosine),
        (k.cos2, (k.half_cosine - k.half_sine) * (k.half_cosine + k.half_sine)),
    )
    return replace(k, steps=Steps((*start, *_positions(k), *_rates(k))))


def _positions(k: Kinematics) -> tuple[Step, ...]:
    """Return the distance DB, and sine and cosine of the rod's angle."""
    rod = _of_rod(k)
    along, across = (sp.expand(rod[name] * k.slide) for name in (k.cos4, k.sin4))
    turned = (k.sin2 * k.cos4 - k.cos2 * k.sin4, k.cos2 * k.cos4 + k.sin2 * k.sin4)
    sin24, cos24 = (_product(k, value.subs(rod)) for value in turned)
    return (
        (k.slide2, _by_ends(k, _square(k))),
        (k.slide, sp.sqrt(k.slide2)),
        (k.cos4, _by_ends(k, along) / k.slide),
        (k.sin4, across / k.slide),
        (k.sin24, sin24),
        (k.cos24, cos24),
    )


def _rates(k: Kinematics) -> tuple[Step, ...]:
    """Differentiate the loop closure twice by the crank angle and solve for the derivatives.

    In terms of the crank angle alone each of them is a product of factors linear in its cosine.
    """
    rates = {_TH2: (sp.S.One, sp.S.Zero), _TH4: (k.w4, k.a4), _SLIDE: (k.v3, k.a3)}
    speeds, changes = closure_rates(_LOOP, _T, rates, k.of_angles)
    found = _solved(k, speeds, (k.w4, k.v3))
    found |= _solved(k, [e.subs(found) for e in changes], (k.a4, k.a3))
    return tuple((name, _product(k, value)) for name, value in found.items())


def _solved(
    k: Kinematics, equations: list[sp.Expr], unknowns: tuple[sp.Symbol, sp.Symbol]
) -> dict[sp.Symbol, sp.Expr]:
    """Solve two linear equations, in terms of the crank angle and ``slide``."""
    solution = sp.linsolve(equations, *unknowns)
    (values,) = solution
    of_rod = _of_rod(k)
    return {
        name: sp.together(value.subs(of_rod)) for name, value in zip(unknowns, values, strict=True)
    }


@cache
def _of_rod(k: Kinematics) -> dict[sp.Symbol, sp.Expr]:
    """Return cosine and sine of the rod's angle by the crank angle and ``slide``."""
    rows = [equation.subs(k.of_angles) for equation in _LOOP]
    return {name: sp.solve(row, name)[0] for name, row in zip((k.cos4, k.sin4), rows, strict=True)}


def _product(k: Kinematics, value: sp.Expr) -> sp.Expr:
    """Write a rational function of crank angle and ``slide`` as a product over ``slide**n``."""
    square = _square(k)
    above, below = (_lowest(k, part) for part in sp.fraction(sp.together(value)))
    product = sp.factor(sp.cancel(above / below))
    # Powers of the square in the divisor, and of slide, go together again.
    above, below = sp.fraction(product)
    power = 0
    for factor, multiplicity in sp.factor_list(below)[1]:
        if sp.expand(factor - square) == 0:
            power += 2 * multiplicity
        elif factor == k.slide:
            power += multiplicity
        else:
            raise UnsafeRewriting(f"divisor {factor} in {product}")
    if above.has(k.slide):
        above, power = sp.cancel(above / k.slide), power - 1
    sine = k.sin2 if above.has(k.sin2) else sp.Integer(1)
    form = _by_ends(k, sp.cancel(above / sine)) * sine
    return form / (k.slide2 ** (power // 2) * k.slide ** (power % 2))


def _lowest(k: Kinematics, polynomial: sp.Expr) -> sp.Expr:
    """Reduce a polynomial by ``sin^2 + cos^2 = 1`` and by the square of ``slide``."""
    circle = k.sin2**2 + k.cos2**2 - 1
    rest = sp.rem(sp.expand(polynomial), k.slide**2 - _square(k), k.slide)
    return sp.factor(sp.rem(sp.expand(rest), circle, k.sin2))


def _square(k: Kinematics) -> sp.Expr:
    """Return ``DB^2`` in the cosine of the crank angle."""
    rod = _of_rod(k)
    square = sp.expand((rod[k.cos4] ** 2 + rod[k.sin4] ** 2) * k.slide**2)
    return sp.expand(square.subs(k.sin2**2, 1 - k.cos2**2))


def _by_ends(k: Kinematics, value: sp.Expr) -> sp.Expr:
    """Write each factor by its values where the crank lies along the frame."""
    lengths = {frame: (k.far + k.near) / 2, crank: (k.far - k.near) / 2}
    form, factors = sp.factor_list(value)
    for factor, multiplicity in factors:
        if factor.has(k.cos2):
            part = bernstein_in_cosine(factor, k.cos2, *k.half_squares, lengths)
        else:
            part = factor if factor.is_Symbol else factor.subs(lengths)
        form *= part**multiplicity
    return form


def _closed_form(spec: ModelSpec) -> ClosedForm:
    solved = kinematics()
    # The angle of DB from the frame, or for a rod that turns with the crank, from the crank.
    along_frame = 1 - 2 * winding
    shorter = (1 - winding) * crank + winding * frame
    squares = solved.half_squares
    diagonal = sp.atan2(
        along_frame * shorter * solved.sin2,
        solved.far * squares[0] + along_frame * solved.near * squares[1],
    )
    outputs = {
        "theta4": winding * theta2 + diagonal,
        "slide": solved.slide,
        "omega4": solved.w4,
        "alpha4": solved.a4,
        "slide_velocity": solved.v3,
        "slide_acceleration": solved.a3,
    }
    inputs = (theta2, frame, crank, winding)
    closed = ClosedForm(inputs, solved.steps, tuple(outputs.items()))
    return closed.only(spec.outputs or outputs)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Kinematics of the quick-return mechanism in closed form",
        references=("closure of the loop DA + AB = DB",),
        arguments=(*ARGUMENTS, _WINDING),
        kernel="motion",
        summary="Return angle, speed and acceleration of the rod, and the block's slide along it",
        results=array_results(_RESULTS),
        notes=(
            "Every rate is a product of factors that are linear in the cosine of the crank angle, "
            "each written by its values at the ends; so no digit is lost where the rod swings "
            "fastest, with the block near the rod's pivot.",
            "At theta2 = 0 the rod's angle is 0.",
        ),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("kinematics",),
    energies=_closed_form,
    describe=_describe,
)
