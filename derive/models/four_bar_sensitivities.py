"""The four-bar linkage: how its motion depends on each length and on the crank angle.

The closure of the loop is differentiated by a length and seen along coupler or follower, where
one of the two unknown turns drops out.  Speeds and accelerations are derivatives of the angles by
the crank angle; so their sensitivities are derivatives of those of the angles.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import sympy as sp

from ..ir import Description, Result
from ..pipeline import Model
from ..safe import UnsafeRewriting
from ..spec import ModelSpec
from ..staged import ClosedForm, Step, Steps
from .four_bar import (
    ARGUMENTS,
    Kinematics,
    assembly,
    coupler,
    crank,
    follower,
    frame,
    kinematics,
    theta2,
)

LENGTHS = (frame, crank, coupler, follower)
_TH2, _TH3, _TH4, _SEEN = sp.symbols("th2 th3 th4 seen", real=True)
_SPREAD_RATE, _PACE, _PACE_RATE, _PER3, _PER4, _DOUBLE, _LEAN, _LEAN_RATE, _SWAY = sp.symbols(
    "spread_rate pace pace_rate per3 per4 double lean lean_rate sway", real=True
)


def turns(length: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Return the derivatives of theta3 and theta4 by a length, from the closure of the loop.

    ``length``: one of the four lengths. Result: in the angles ``th2``, ``th3``, ``th4`` and the
    lengths.
    """
    links = ((crank, _TH2), (coupler, _TH3), (-follower, _TH4), (-frame, sp.S.Zero))
    # The component of the closure (Smith 2.1) along a fixed direction.
    closure = sum(size * sp.cos(angle - _SEEN) for size, angle in links)
    turn3, turn4 = sp.symbols("turn3 turn4", real=True)
    change = closure.diff(length) + closure.diff(_TH3) * turn3 + closure.diff(_TH4) * turn4
    found = []
    for turn, along in ((turn3, _TH4), (turn4, _TH3)):
        equation = sp.expand(change.subs(_SEEN, along))
        slope = equation.coeff(turn)
        known = sp.expand(equation - slope * turn)
        if known.has(turn3, turn4):
            raise UnsafeRewriting(f"{known} still holds an unknown turn")
        found.append(-known / slope)
    return found[0], found[1]


def _named(k: Kinematics, expression: sp.Expr) -> sp.Expr:
    """Write sines and cosines of angles and of their differences by the kinematics' symbols."""
    names: dict[sp.Expr, sp.Expr] = {}
    for angle, sine, cosine in (
        (_TH3, k.sin3, k.cos3),
        (_TH4, k.sin4, k.cos4),
        (_TH2 - _TH3, k.sin23, k.cos23),
        (_TH2 - _TH4, k.sin24, k.cos24),
        (_TH4 - _TH3, k.sine_transmission, k.cosine_transmission),
    ):
        # SymPy may hold the sine of a difference as minus that of its opposite.
        sign, function = sp.sin(angle).as_coeff_Mul()
        names |= {function: sign * sine, sp.cos(angle): cosine}
    return expression.xreplace(names)


def _derivative(
    k: Kinematics, expression: sp.Expr, more: Mapping[sp.Symbol, sp.Expr] | None = None
) -> sp.Expr:
    """Return the derivative by the crank angle of an expression in the steps' symbols."""
    rates = {k.w3: k.a3, k.w4: k.a4, k.slip3: -k.a3, k.slip4: -k.a4, **(more or {})}
    rates |= {k.spread: _SPREAD_RATE, _PACE: _PACE_RATE}
    rates |= {_PER3: -_PER3 * _PACE, _PER4: -_PER4 * _PACE}
    for sine, cosine, speed in (
        (k.sin2, k.cos2, sp.S.One),
        (k.sin3, k.cos3, k.w3),
        (k.sin4, k.cos4, k.w4),
        (k.sin23, k.cos23, k.slip3),
        (k.sin24, k.cos24, k.slip4),
        (k.sine_transmission, k.cosine_transmission, k.spread),
    ):
        rates |= {sine: speed * cosine, cosine: -speed * sine}
    return sp.Add(*(expression.diff(symbol) * rate for symbol, rate in rates.items()))


def _common(k: Kinematics) -> Iterator[Step]:
    """Return the rates that the sensitivities of speeds and accelerations share."""
    yield _SPREAD_RATE, sp.factor_terms(_derivative(k, k.steps.mapping()[k.spread]))
    yield _PER3, 1 / (coupler * k.sine_transmission)
    yield _PER4, 1 / (follower * k.sine_transmission)
    # Logarithmic derivative of the sine of the transmission angle.
    slope = _derivative(k, k.sine_transmission) / k.sine_transmission
    yield _PACE, slope
    yield _PACE_RATE, sp.expand(_derivative(k, slope)).subs(slope**2, _PACE**2)


def _of_length(k: Kinematics, length: sp.Symbol) -> Iterator[Step]:
    """Return the sensitivities of angles, speeds and accelerations to a length."""
    for link, turn, size, per in zip(
        (3, 4), turns(length), (coupler, follower), (_PER3, _PER4), strict=True
    ):
        theta, omega, alpha = (
            sp.Symbol(f"{quantity}{link}_by_{length}", real=True) for quantity in _WORDS
        )
        # N per, with per' = -pace per: its derivative is N' per - pace theta, and so on.
        above = _named(k, turn * size) * k.sine_transmission
        changed = _derivative(k, above)
        again = sp.expand(_derivative(k, changed))
        yield theta, above * per
        yield omega, sp.factor_terms(changed) * per - _PACE * theta
        whole = _derivative(k, changed * per - _PACE * theta, {theta: omega})
        kept = again * per - _PACE * changed * per - _PACE_RATE * theta - _PACE * omega
        if sp.expand(whole - kept) != 0:
            raise UnsafeRewriting(f"{kept} is not the derivative of {omega}")
        # N' per is omega + pace theta.
        rest = 2 * _PACE * omega + (_PACE_RATE + _PACE**2) * theta
        yield alpha, sp.factor_terms(again) * per - rest


def _jerks(k: Kinematics) -> Iterator[Step]:
    """Return the third derivatives of the angles by the crank angle.

    An angle is that of the diagonal BD and one of the triangle BCD, which depends on the square of
    BD alone.  The third derivative of this one holds the sine of the crank angle as a factor; left
    apart, it takes no digit from the other where the linkage nearly folds.
    """
    square = sp.Symbol("square", real=True)
    cosine = (frame**2 + crank**2 - square) / (2 * frame * crank)
    # The diagonal turns with the component of the crank pin's speed across it.
    speed = sp.cancel((crank - frame * cosine) * crank / square)
    half = sp.cancel((speed - sp.Rational(1, 2)) * square)
    if half.has(square):
        raise UnsafeRewriting(f"{speed} is not 1/2 and a part over the square")
    half = sp.factor(half).subs({frame - crank: k.near, frame + crank: k.far})
    yield _DOUBLE, 2 * crank * frame
    over = _second_derivative(k, 1 / square, square)
    yield _SWAY, half * over
    stretch, fold = k.straight**2 - square, square - k.folded**2
    yield _LEAN, (k.stretch - k.fold) / (2 * k.stretch * k.fold)
    yield _LEAN_RATE, -1 / (k.stretch * k.fold) - 2 * _LEAN**2
    for link, adjacent, name in ((3, k.p, "p"), (4, -k.q, "q")):
        along = square + k.straight * k.folded if link == 3 else k.straight * k.folded - square
        # The angle is atan2(area, adjacent): its derivative by the square is ``first / area``.
        below = sp.expand(stretch * fold + along**2)
        above = along * (stretch - fold) / 2 - stretch * fold * along.diff(square)
        first = sp.factor(sp.cancel(above / below))
        names = (adjacent, name)
        yield from _triangle_jerk(k, link, first, square, names)


def _second_derivative(k: Kinematics, value: sp.Expr, square: sp.Symbol) -> sp.Expr:
    """Differentiate a function of the square of BD twice by the crank angle."""
    first, second = value.diff(square), value.diff(square, 2)
    slope, bend = _DOUBLE * k.sin2, _DOUBLE * k.cos2
    return sp.factor(first * bend + second * slope**2).subs(square, k.diagonal2)


def _triangle_jerk(
    k: Kinematics, link: int, first: sp.Expr, square: sp.Symbol, names: tuple[sp.Expr, str]
) -> Iterator[Step]:
    """Return the jerk of a link from ``first / area``, its angle's derivative by the square."""
    one, two, three = (sp.Symbol(f"bend{names[1]}{i}", real=True) for i in (1, 2, 3))
    changes = [sp.factor(first.diff(square, i)).subs(square, k.diagonal2) for i in range(3)]
    yield one, changes[0]
    # (h / area)' = (h' - lean h) / area
    yield two, changes[1] - _LEAN * one
    yield three, changes[2] - 2 * _LEAN * changes[1] - (_LEAN_RATE - _LEAN**2) * one
    part = (_DOUBLE * k.sin2) ** 2 * three + 3 * _DOUBLE * k.cos2 * two - one
    yield (
        sp.Symbol(f"alpha{link}_by_theta2", real=True),
        _SWAY + _DOUBLE * k.sin2 * part / k.area,
    )


def _closed_form(spec: ModelSpec) -> ClosedForm:
    k = kinematics()
    found = [step for length in LENGTHS for step in _of_length(k, length)]
    jerks = list(_jerks(k))
    outputs = {str(name): name for name, _ in (*found, *jerks)}
    outputs |= {"theta3_by_theta2": k.w3, "theta4_by_theta2": k.w4}
    outputs |= {"omega3_by_theta2": k.a3, "omega4_by_theta2": k.a4}
    steps = Steps((*k.steps.steps, *_common(k), *found, *jerks))
    inputs = (theta2, *LENGTHS, assembly)
    ordered = tuple((name, outputs[name]) for name in _names())
    return ClosedForm(inputs, steps, ordered).only(spec.outputs or _names())


def _names() -> tuple[str, ...]:
    """Return the names of all outputs, in order."""
    quantities = [f"{quantity}{link}" for quantity in _WORDS for link in (3, 4)]
    return tuple(f"{quantity}_by_{by}" for quantity in quantities for by in (*LENGTHS, theta2))


_WORDS = {
    "theta": "angle",
    "omega": "speed over crank speed",
    "alpha": "acceleration over crank speed squared",
}
_LINKS = {"3": "Coupler", "4": "Follower"}


def _result(name: str) -> Result:
    quantity, _, by = name.partition("_by_")
    words = f"{_LINKS[quantity[-1]]} {_WORDS[quantity[:-1]]}, its derivative by"
    if by == "theta2":
        return Result(name, "ndarray, shape (...)", "", f"{words} the crank angle")
    return Result(name, "ndarray, shape (...)", "1/m", f"{words} the length of the {by}")


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Sensitivities of the four-bar linkage's motion in closed form",
        references=("Smith (2.1), differentiated by each length",),
        arguments=ARGUMENTS,
        kernel="sensitivities",
        summary="Return the derivatives of angles, speeds and accelerations",
        results={name: _result(name) for name in _names()},
        notes=(
            "Each is the derivative at fixed other lengths and crank angle, and grows as the "
            "transmission angle nears 0 or pi: the angles' ones as 1/sin, the speeds' as its third "
            "power, the accelerations' as its fifth.",
        ),
    )


MODEL = Model(
    mechanism="four_bar",
    formulations=("sensitivities",),
    energies=_closed_form,
    describe=_describe,
)
