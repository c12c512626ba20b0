"""The four-bar linkage: closed-form kinematics of both assemblies, from loop closure alone.

Angles as in Smith Fig. 1: ``theta2``, ``theta3``, ``theta4`` of crank AB, coupler BC and follower
DC, anticlockwise from the frame AD.  Derivatives are with respect to the crank angle, so that
``omega3 = omega2 * w3`` and ``alpha3 = omega2^2 * a3 + alpha2 * w3``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from ..ir import Argument, Description, array_results
from ..pipeline import Model
from ..rigid.closure import SolvedLoop
from ..safe import bernstein_in_cosine, root_of_parts, solve_cosine_sine
from ..spec import ModelSpec
from ..staged import ClosedForm, Step, Steps

theta2 = sp.Symbol("theta2", real=True)
frame, crank, coupler, follower = sp.symbols("frame crank coupler follower", positive=True)
assembly, winding = sp.symbols("assembly winding", real=True)

ARGUMENTS = (
    Argument("theta2", "ndarray or float, shape (...)", "rad", "Crank angle"),
    Argument("frame", "float", "m", "Length of the fixed link AD"),
    Argument("crank", "float", "m", "Length of the crank AB"),
    Argument("coupler", "float", "m", "Length of the coupler BC"),
    Argument("follower", "float", "m", "Length of the follower DC"),
    Argument("assembly", "float", "", "+1 for the open, -1 for the crossed assembly"),
)
_WINDING = Argument(
    "winding", "float", "", "1 where the crank is longer than the frame (drag link), else 0"
)
_RESULTS = {
    "theta3": ("rad", "Coupler angle, continuous over any number of turns"),
    "theta4": ("rad", "Follower angle, continuous over any number of turns"),
    "omega3": ("", "Coupler speed over crank speed, d theta3 / d theta2"),
    "omega4": ("", "Follower speed over crank speed, d theta4 / d theta2"),
    "alpha3": ("", "Coupler acceleration over crank speed squared, at constant crank speed"),
    "alpha4": ("", "Follower acceleration over crank speed squared, at constant crank speed"),
    "transmission_angle": ("rad", "Angle between coupler and follower at C, from 0 to pi"),
}


@dataclass(frozen=True, kw_only=True)
class Kinematics(SolvedLoop):
    """The solved linkage: its symbols, and the steps that define them.

    Attributes
    ----------
    near, far, straight, folded : Symbol
        ``l1 - l2``, ``l1 + l2``, ``l3 + l4`` and ``l3 - l4``; their differences lose no digit.
    sin3, cos3, sin4, cos4 : Symbol
        Sines and cosines of the angles of coupler and follower.
    sin23, cos23, sin24, cos24 : Symbol
        Of ``theta2 - theta3`` and ``theta2 - theta4``.
    w3, w4, a3, a4 : Symbol
        First and second derivatives of the angles by the crank angle.
    share, reduced : Symbol
        ``l2 / (l1 + l2)`` and ``l1 l2 / (l1 + l2)``.
    excess3, excess4 : Symbol
        ``(w3 - share) / reduced`` and ``(w4 - share) / reduced``.
    slip3, slip4, spread : Symbol
        ``1 - w3``, ``1 - w4`` and ``w4 - w3``, without cancellation.
    diagonal_x, diagonal_y, diagonal2 : Symbol
        The diagonal BD and its square.
    p, q : Symbol
        ``2 l3 BD cos(CBD)`` and ``2 l4 BD cos(CDB)``.
    stretch, fold, root : Symbol
        ``(l3 + l4)^2 - BD^2``, ``BD^2 - (l3 - l4)^2``, and the root of their product.
    area : Symbol
        ``4 x`` area of BCD with the sign of the assembly.
    sine_transmission, cosine_transmission : Symbol
        Of ``theta4 - theta3``.
    """

    near: sp.Symbol
    far: sp.Symbol
    straight: sp.Symbol
    folded: sp.Symbol
    sin3: sp.Symbol
    cos3: sp.Symbol
    sin4: sp.Symbol
    cos4: sp.Symbol
    sin23: sp.Symbol
    cos23: sp.Symbol
    sin24: sp.Symbol
    cos24: sp.Symbol
    w3: sp.Symbol
    w4: sp.Symbol
    a3: sp.Symbol
    a4: sp.Symbol
    share: sp.Symbol
    reduced: sp.Symbol
    excess3: sp.Symbol
    excess4: sp.Symbol
    slip3: sp.Symbol
    slip4: sp.Symbol
    spread: sp.Symbol
    diagonal_x: sp.Symbol
    diagonal_y: sp.Symbol
    diagonal2: sp.Symbol
    p: sp.Symbol
    q: sp.Symbol
    stretch: sp.Symbol
    fold: sp.Symbol
    root: sp.Symbol
    area: sp.Symbol
    sine_transmission: sp.Symbol
    cosine_transmission: sp.Symbol

    @property
    def of_angles(self) -> dict[sp.Expr, sp.Symbol]:
        """Sine and cosine of each link's angle as a function of time, and their symbols."""
        sines, cosines = (self.sin2, self.sin3, self.sin4), (self.cos2, self.cos3, self.cos4)
        table = {sp.sin(angle): symbol for angle, symbol in zip(_ANGLES, sines, strict=True)}
        return table | {sp.cos(angle): s for angle, s in zip(_ANGLES, cosines, strict=True)}


_EMITTED = {"w3": "omega3", "w4": "omega4", "a3": "alpha3", "a4": "alpha4"}
_T = sp.Symbol("t", real=True)
_ANGLES = tuple(sp.Function(f"th{link}")(_T) for link in (2, 3, 4))


@cache
def kinematics() -> Kinematics:
    """Solve the loop closure AB + BC = AD + DC (Smith 2.1) for both moving links.

    The coupler turns by ``theta3`` so that C, a distance ``l3`` from B, lies ``l4`` from D; the
    diagonal from B to D carries all dependence on the crank angle.

    Result: steps free of cancellation beyond that of the lengths themselves.
    """
    k = Kinematics.unsolved(_EMITTED)
    lengths = (
        (k.near, frame - crank),
        (k.far, frame + crank),
        (k.straight, coupler + follower),
        (k.folded, coupler - follower),
    )
    crank_angle = (
        (k.half_sine, sp.sin(theta2 / 2)),
        (k.half_cosine, sp.cos(theta2 / 2)),
        (k.sin2, 2 * k.half_sine * k.half_cosine),
        (k.cos2, k.half_cosine**2 - k.half_sine**2),
    )
    differences = (
        (k.sin23, k.sin2 * k.cos3 - k.cos2 * k.sin3),
        (k.cos23, k.cos2 * k.cos3 + k.sin2 * k.sin3),
        (k.sin24, k.sin2 * k.cos4 - k.cos2 * k.sin4),
        (k.cos24, k.cos2 * k.cos4 + k.sin2 * k.sin4),
    )
    positions, rates = _positions(k), _rates(k)
    return replace(k, steps=Steps((*lengths, *crank_angle, *positions, *differences, *rates)))


def _positions(k: Kinematics) -> tuple[Step, ...]:
    """Return sines and cosines of coupler and follower, from the triangle BCD."""
    # |d - l3 e3| = l4 and |d + l4 e4| = l3, each a cos x + b sin x = c.
    diagonal = k.diagonal_x, k.diagonal_y
    c3, s3, discriminant = solve_cosine_sine(*diagonal, k.p / (2 * coupler), k.root)
    c4, s4, _ = solve_cosine_sine(*diagonal, -k.q / (2 * follower), k.root)
    # The diagonal in cos(theta2) alone, for the rewriting by end values.
    along = frame - crank * k.cos2
    square = sp.expand(along**2 + crank**2 * (1 - k.cos2**2))
    stretch, fold = (coupler + follower) ** 2 - square, square - (coupler - follower) ** 2
    area2 = sp.expand(4 * coupler**2 * discriminant).subs(k.diagonal_y**2, square - along**2)
    area2 = area2.subs({k.diagonal_x: along, k.p: square + coupler**2 - follower**2})
    area = root_of_parts((stretch, fold), (k.stretch, k.fold), k.root, area2)

    sums = {
        frame: (k.far + k.near) / 2,
        crank: (k.far - k.near) / 2,
        coupler: (k.straight + k.folded) / 2,
        follower: (k.straight - k.folded) / 2,
    }

    def by_ends(value: sp.Expr) -> sp.Expr:
        return bernstein_in_cosine(sp.expand(value), k.cos2, *k.half_squares, sums)

    def solved(value: sp.Expr, length: sp.Symbol) -> sp.Expr:
        value = value.subs(k.root, k.area / (2 * length))
        return sp.factor(value).subs(k.diagonal_x**2 + k.diagonal_y**2, k.diagonal2)

    return (
        (k.diagonal_x, by_ends(along)),
        (k.diagonal_y, -crank * k.sin2),
        (k.diagonal2, by_ends(square)),
        (k.p, k.diagonal2 + k.straight * k.folded),
        (k.q, k.diagonal2 - k.straight * k.folded),
        (k.stretch, by_ends(stretch)),
        (k.fold, by_ends(fold)),
        (k.root, sp.sqrt(k.stretch * k.fold)),
        (k.sine_transmission, assembly * area / (2 * coupler * follower)),
        (k.area, 2 * coupler * follower * k.sine_transmission),
        (k.cos3, solved(c3, coupler)),
        (k.sin3, solved(s3, coupler)),
        (k.cos4, solved(c4, follower)),
        (k.sin4, solved(s4, follower)),
        # Not by the law of cosines: near 90 deg the errors of the angles would not cancel.
        (k.cosine_transmission, k.cos3 * k.cos4 + k.sin3 * k.sin4),
    )


def _rates(k: Kinematics) -> tuple[Step, ...]:
    """Differentiate the loop closure twice by the crank angle and solve for the derivatives.

    A speed follows from the closure as a product with the crank or, by way of ``1 - w``, with the
    frame.  Where one of the two is short, the other form loses digits; their mean, weighted with
    the other length, is ``w = share + reduced * excess`` and loses none.
    """
    th2, th3, th4 = _ANGLES
    loop = [
        crank * trig(th2) + coupler * trig(th3) - follower * trig(th4) - at
        for trig, at in ((sp.cos, frame), (sp.sin, 0))
    ]
    speeds = {th2.diff(_T): sp.Integer(1), th3.diff(_T): k.w3, th4.diff(_T): k.w4}
    rows = [equation.diff(_T).subs(speeds) for equation in loop]
    matrix, right = sp.linear_eq_to_matrix(rows, (k.w3, k.w4))
    below = matrix.det()
    above3, above4 = (_column_replaced(matrix, i, right).det() for i in (0, 1))
    divisor = _by_differences(k, below)
    spread = _by_differences(k, _by_closure(above4 - above3, loop, follower))
    excesses, accelerations = [], []
    for above, excess, w, slip, a in (
        (above3, k.excess3, k.w3, k.slip3, k.a3),
        (above4, k.excess4, k.w4, k.slip4, k.a4),
    ):
        by_frame = _by_closure(below - above, loop, crank)
        dividend = _by_differences(k, sp.expand(above / crank - by_frame / frame))
        slope = sp.factor_terms(_derivative(k, dividend) / divisor)
        slope -= sp.factor_terms(excess * _derivative(k, divisor) / divisor)
        excesses += [
            (excess, sp.factor_terms(dividend / divisor)),
            (w, k.share + k.reduced * excess),
            (slip, frame / k.far - k.reduced * excess),
        ]
        accelerations.append((a, k.reduced * slope))
    return (
        (k.share, crank / k.far),
        (k.reduced, k.share * frame),
        *excesses,
        (k.spread, sp.factor(spread / divisor)),
        *accelerations,
    )


def _derivative(k: Kinematics, expression: sp.Expr) -> sp.Expr:
    """Return the derivative by the crank angle of an expression in sines and cosines."""
    total = sp.Integer(0)
    for sine, cosine, speed in (
        (k.sin2, k.cos2, sp.Integer(1)),
        (k.sin3, k.cos3, k.w3),
        (k.sin4, k.cos4, k.w4),
        (k.sin23, k.cos23, k.slip3),
        (k.sin24, k.cos24, k.slip4),
        (k.sine_transmission, k.cosine_transmission, k.spread),
    ):
        total += speed * (expression.diff(sine) * cosine - expression.diff(cosine) * sine)
    return total


def _column_replaced(matrix: sp.Matrix, column: int, by: sp.Matrix) -> sp.Matrix:
    replaced = matrix.copy()
    replaced[:, column] = by
    return replaced


def _by_closure(expression: sp.Expr, loop: list[sp.Expr], length: sp.Symbol) -> sp.Expr:
    """Eliminate one link by the closure: its components are those of the other three."""
    total = sp.expand(expression)
    for equation in loop:
        component = next(term for term in equation.args if term.has(length))
        factor = component.as_coeff_Mul()[0]
        total = total.subs(component / factor, sp.expand(component - equation) / factor)
    return sp.expand(total)


def _by_differences(k: Kinematics, expression: sp.Expr) -> sp.Expr:
    """Write products of sines and cosines by those of angle differences; ``sin^2 + cos^2 = 1``."""
    result = sp.expand(expression.subs(k.of_angles))
    products = {
        k.sin2 * k.cos3: k.sin23 + k.cos2 * k.sin3,
        k.cos2 * k.cos3: k.cos23 - k.sin2 * k.sin3,
        k.sin2 * k.cos4: k.sin24 + k.cos2 * k.sin4,
        k.cos2 * k.cos4: k.cos24 - k.sin2 * k.sin4,
        k.sin4 * k.cos3: k.sine_transmission + k.cos4 * k.sin3,
        k.cos3 * k.cos4: k.cosine_transmission - k.sin3 * k.sin4,
        **{c**2: 1 - s**2 for s, c in ((k.sin2, k.cos2), (k.sin3, k.cos3), (k.sin4, k.cos4))},
    }
    for product, value in products.items():
        result = sp.expand(result.subs(product, value))
    return result


def _closed_form(spec: ModelSpec) -> ClosedForm:
    solved = kinematics()
    # The angle of the diagonal: from B to D, or for a drag link, where it turns with the crank,
    # from D to B.  Both angles then lie between -pi and pi at theta2 = 0, and no pi is added.
    along_frame = 1 - 2 * winding
    shorter = (1 - winding) * crank + winding * frame
    squares = solved.half_squares
    diagonal = sp.atan2(
        -along_frame * shorter * solved.sin2,
        along_frame * solved.near * squares[0] + solved.far * squares[1],
    )
    phi = sp.Symbol("phi", real=True)
    steps = solved.steps.then((phi, winding * theta2 + diagonal))
    outputs = {
        "theta3": phi + along_frame * sp.atan2(solved.area, along_frame * solved.p),
        "theta4": phi + along_frame * sp.atan2(solved.area, -along_frame * solved.q),
        "omega3": solved.w3,
        "omega4": solved.w4,
        "alpha3": solved.a3,
        "alpha4": solved.a4,
        "transmission_angle": sp.atan2(2 * solved.root, solved.stretch - solved.fold),
    }
    inputs = (theta2, frame, crank, coupler, follower, assembly, winding)
    return ClosedForm(inputs, steps, tuple(outputs.items())).only(spec.outputs or outputs)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Kinematics of the four-bar linkage in closed form",
        references=("Smith (2.1)-(2.10)", "Smith (A.1)-(A.8)"),
        arguments=(*ARGUMENTS, _WINDING),
        kernel="motion",
        summary="Return angles, speeds and accelerations of coupler and follower",
        results=array_results(_RESULTS),
        notes=(
            "The squares of the diagonal and of the area are sums of like-signed terms for every "
            "crank that turns fully, so that no digit is lost near a dead centre; speeds and "
            "accelerations hold the short one of crank and frame as a factor.",
            "At theta2 = 0 both angles lie between -pi and pi.",
        ),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=("kinematics",),
    energies=_closed_form,
    describe=_describe,
)
