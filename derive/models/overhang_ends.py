"""Amplitudes of the modes of a beam with an overhang, their growth, and their end values.

The two shapes of the boundary value problem carry amplitudes that let slope and moment agree at
the support and give ``int e^2 = 1``; what a small move of the support does to both follows by
differentiation.

The boundary value problem: the general solution of ``e'''' = beta^4 e`` on both sides of the
support and the conditions (3), (4) of Beale & Scott give the shapes, and with them the
characteristic equation: slope and moment at the support agree from both sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import sympy as sp
from sympy.codegen.cfunctions import expm1

from ..projection.greens_identity import derivative
from ..safe import UnsafeRewriting
from ..staged import Step
from .overhang_integrals import (
    AFTER,
    BEFORE,
    DRIFT,
    MODE,
    PIN,
    RATE,
    TIP,
    Ends,
    eta,
    place,
    square_integral,
)
from .overhang_waves import CLOSE, HANG, REST, RISE, RUN, SINK, SPAN, SWITCH, Wave, proven

ORDERS = range(4)
_WAVES = (sp.sin, sp.cos, sp.sinh, sp.cosh)
# cosh y - sinh y -+ (cos y - sin y) where it is small with y, and its derivative.
LEAN, LEAN_SLOPE = sp.symbols("lean lean_slope", real=True)


@dataclass(frozen=True)
class Bay:
    """The shape between two supports but for a factor, stable.

    ``shape``: shape and three derivatives by the phase of the point; ``moved``: the same of its
    derivative by the phase of the support.
    """

    shape: tuple[sp.Expr, ...]
    moved: tuple[sp.Expr, ...]


@lru_cache(maxsize=2)
def plain_shape(free: bool) -> sp.Expr:
    """Return the shape of a bay as the boundary value problem has it, zero at the support.

    ``free``: true for the bay beyond the support, with neither moment nor shear force at its tip;
    False for the one between pin and support, at rest and without moment at the pin. The first is
    without a divisor, for it has to remain when the bay shrinks to nothing; the factor of the sine
    in the second is 1.
    """
    point, support = (REST, HANG) if free else (RUN, SPAN)
    v = point.phase
    factors = dict(zip(_WAVES, sp.symbols("c1:5"), strict=True))
    shape = sp.Add(*(factor * wave(v) for wave, factor in factors.items()))
    conditions = [sp.diff(shape, v, k).subs(v, 0) for k in ((2, 3) if free else (0, 2))]
    conditions.append(shape.subs(v, support.phase))
    given = factors[sp.cos] if free else factors[sp.sin]
    unknowns = [factor for factor in factors.values() if factor is not given]
    (values,) = sp.linsolve(conditions, *unknowns)
    found = shape.subs(dict(zip(unknowns, values, strict=True))).subs(given, 1)
    return sp.expand(sp.fraction(sp.together(found))[0] if free else found)


@lru_cache(maxsize=1)
def before() -> Bay:
    """Return the bay between pin and support."""
    plain, a, x = plain_shape(False), SPAN.phase, RUN.phase
    shape = []
    for order in ORDERS:
        derived = sp.diff(plain, x, order)
        # Value and slope are small differences where both phases are small.
        write = Wave.by_excess if order < 2 else Wave.by_size
        above = write(RUN, write(SPAN, sp.expand(derived * sp.sinh(a))))
        above = _over(above, SPAN, RUN, RISE)
        shape.append(proven(above / SPAN.odd, derived))
    ratio = plain.coeff(sp.sinh(x))
    slope = SPAN.reduced(sp.diff(ratio, a) * sp.sinh(a) ** 2)
    moved = []
    for order in ORDERS:
        steep = _over(RUN.by_size(sp.diff(sp.sinh(x), x, order)), SPAN, RUN, RISE)
        form = scaled(slope, SPAN, True) / SPAN.odd * steep / SPAN.odd
        moved.append(proven(form, sp.diff(plain, a, 1, x, order)))
    return Bay(tuple(shape), tuple(moved))


@lru_cache(maxsize=1)
def beyond() -> Bay:
    """Return the bay beyond the support, over ``exp(beta (1 - xi)) / 2``."""
    plain, b, y = plain_shape(True), HANG.phase, REST.phase
    lean = {2: LEAN, 3: LEAN_SLOPE}
    shape, moved = [], []
    for order in ORDERS:
        derived = sp.diff(plain, y, order)
        # sinh b = cosh b - exp(-b): the growing parts stand together.
        split = sp.expand(derived.subs(sp.sinh(b), sp.cosh(b) - HANG.fade))
        grown = split.coeff(sp.cosh(b))
        rest = sp.expand(split - grown * sp.cosh(b))
        small = _over(REST.by_excess(HANG.circular(rest)), HANG, REST, SINK)
        known = sp.expand(REST.elementary(grown))
        form = HANG.even * lean.get(order, known) + small
        proven(form.subs(lean.get(order, known), known), 2 * HANG.fade * derived)
        shape.append(form)
        change = sp.diff(plain, b, 1, y, order) - derived  # also of the factor 2 exp(-b)
        rest = sp.expand(change.subs(sp.sinh(b), sp.cosh(b) - HANG.fade))
        form = _over(REST.by_excess(HANG.circular(rest)), HANG, REST, SINK)
        moved.append(proven(form, 2 * HANG.fade * change))
    return Bay(tuple(shape), tuple(moved))


@lru_cache(maxsize=1)
def beyond_from_support() -> sp.Expr:
    """Return the shape beyond the support by slope, moment and shear force there.

    For a point close to the support, where the other form is a difference.
    """
    plain, b, y, z = plain_shape(True), HANG.phase, REST.phase, CLOSE.phase
    moved = HANG.reduced(sp.expand(sp.expand_trig(plain.subs(y, b - z))))
    starts = [HANG.reduced((-1) ** k * sp.diff(plain, y, k).subs(y, b)) for k in ORDERS]
    # Solutions of y^(4) = y that start with one derivative 2 and the others 0.
    swing, turn, rise, grow = sp.sin(z), sp.cos(z), sp.sinh(z), sp.cosh(z)
    units = (swing + rise, grow - turn, rise - swing)
    form = sp.Add(*(start * unit / 2 for start, unit in zip(starts[1:], units, strict=True)))
    if starts[0] != 0 or CLOSE.reduced(HANG.reduced(sp.expand(form - moved))) != 0:
        raise UnsafeRewriting(f"{form} is not the shape beyond the support")
    return sp.Add(
        *(
            scaled(start, HANG, k == 1) * CLOSE.by_excess(unit) / 2
            for k, (start, unit) in enumerate(zip(starts[1:], units, strict=True))
        )
    )


def _over(expression: sp.Expr, support: Wave, point: Wave, between: sp.Symbol) -> sp.Expr:
    """Return ``2 exp(-support)`` times an expression that has ``exp(-point)`` as divisor."""
    found = sp.expand(2 * support.fade * expression)
    found = sp.expand(found.subs(support.fade, between * point.fade))
    return found.subs(between * point.fade, support.fade)


def scaled(expression: sp.Expr, wave: Wave, excess: bool = False) -> sp.Expr:
    """Return ``2 exp(-v)`` times a function of one phase that is linear in sinh v and cosh v.

    ``expression``: the function; ``wave``: the phase; ``excess``: true where it is a small
    difference at small phases.
    """
    write = wave.by_excess if excess else wave.by_size
    reduced = wave.reduced(expression)
    return proven(sp.expand(2 * wave.fade * write(reduced)), 2 * wave.fade * reduced)


def lean_steps() -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Return the definitions of what remains of the growing parts, small near the tip."""
    y, f = REST.phase, REST.fade
    direct = f - REST.cosine + REST.sine
    close = proven((REST.spread - REST.excess) / (2 * f), direct)
    return (
        (LEAN, sp.Piecewise((direct, y > SWITCH), (close, True))),
        (LEAN_SLOPE, -expm1(-y) + REST.sine - 2 * sp.sin(y / 2) ** 2),
    )


beta = sp.Symbol("beta", positive=True)
LEFT, RIGHT = sp.symbols("left_amplitude right_amplitude", real=True)
LEFT_GROWTH, RIGHT_GROWTH = sp.symbols("left_growth right_growth", real=True)  # over the amplitude
SPAN_RATE, HANG_RATE = sp.symbols("span_rate hang_rate", real=True)  # of both phases along xi
ENDS = Ends.of()

_LAMBDA = sp.symbols("before_slope before_moment", real=True)
_RHO = sp.symbols("beyond_slope beyond_moment", real=True)
_LAMBDA_RATES = sp.symbols("before_slope_rate before_moment_rate", real=True)
_RHO_RATES = sp.symbols("beyond_slope_rate beyond_moment_rate", real=True)
_END, _END_RATE, _RATIO, _RATIO_RATE = sp.symbols("end end_rate ratio ratio_rate", real=True)
_DOT, _SQUARE, _OTHER, _SIZE, _TURN = sp.symbols("dot square other size turn", real=True)
_FREE = sp.Symbol("free", real=True)  # 1 - xi


def at_support(expression: sp.Expr, point: Wave, support: Wave, between: sp.Symbol) -> sp.Expr:
    """Return an expression at the support itself."""
    values = {old: new for old, new in zip(_symbols(point), _symbols(support), strict=True)}
    return sp.expand(expression.subs(between, 1).subs(values, simultaneous=True))


def _symbols(wave: Wave) -> tuple[sp.Symbol, ...]:
    return (
        wave.phase,
        wave.sine,
        wave.cosine,
        wave.fade,
        wave.odd,
        wave.even,
        wave.excess,
        wave.spread,
    )


@lru_cache(maxsize=1)
def sides() -> tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]:
    """Return slope and moment at the support of either shape, by eta / beta, as functions.

    Those of the bay at the pin times sinh of its phase, those of the free bay as they are.
    """
    a, x, b, y = SPAN.phase, RUN.phase, HANG.phase, REST.phase
    near, far = plain_shape(False), plain_shape(True)
    ours = (SPAN.reduced(sp.diff(near, x, k).subs(x, a) * sp.sinh(a)) for k in (1, 2))
    theirs = (HANG.reduced((-1) ** k * sp.diff(far, y, k).subs(y, b)) for k in (1, 2))
    return (next(ours), next(ours)), (next(theirs), next(theirs))


@lru_cache(maxsize=1)
def residual() -> tuple[sp.Expr, sp.Expr]:
    """Return the characteristic function, over growing factors, and its slope along beta.

    Slope and moment from one side are in the ratio of those from the other.
    """
    ours, theirs = sides()
    left = [_with_slope(e, SPAN, k == 0) for k, e in enumerate(ours)]
    right = [_with_slope(e, HANG, k == 1) for k, e in enumerate(theirs)]
    value = left[0][0] * right[1][0] - left[1][0] * right[0][0]
    slope = place * (left[0][1] * right[1][0] - left[1][1] * right[0][0])
    slope += (1 - place) * (left[0][0] * right[1][1] - left[1][0] * right[0][1])
    return value, slope


def _with_slope(expression: sp.Expr, wave: Wave, excess: bool) -> tuple[sp.Expr, sp.Expr]:
    """Return ``2 exp(-v)`` times an expression, and the derivative of that by v."""
    value = scaled(expression, wave, excess)
    return value, scaled(sp.diff(expression, wave.phase), wave) - value


def _mode_at(where: str, order: int) -> sp.Expr:
    """Return the value that the shape and its amplitude give at pin, support or tip."""
    if where in (PIN, BEFORE):
        form = before().shape[order]
        if where == BEFORE:
            form = at_support(form, RUN, SPAN, RISE)
        else:
            still = {RUN.sine: 0, RUN.cosine: 1, RUN.odd: 0, RUN.even: 2}
            form = form.subs({RISE: SPAN.fade, RUN.excess: 0, RUN.spread: 0} | still)
        return LEFT * beta**order * sp.cancel(form)
    far, (y, point) = plain_shape(True), (REST.phase, HANG.phase if where == AFTER else 0)
    plain = HANG.reduced(sp.diff(far, y, order).subs(y, point))
    return RIGHT * (-beta) ** order * scaled(plain, HANG)


def _first_integral() -> dict[tuple[int, ...], sp.Expr]:
    """Return the form in the derivatives of a mode that is constant on each side."""
    constant = sp.Symbol("constant", positive=True)
    form: dict[tuple[int, ...], sp.Expr] = {
        (1, 3): sp.S.One,
        (2, 2): -sp.Rational(1, 2),
        (0, 0): -constant / 2,
    }
    slope: dict[tuple[int, ...], sp.Expr] = {}
    for orders, value in derivative(form, eta, (constant, constant)).items():
        both = tuple(sorted(orders))
        slope[both] = slope.get(both, sp.S.Zero) + value
    if any(sp.expand(value) != 0 for value in slope.values()):
        raise ArithmeticError(f"{form} is not constant along a mode")
    return {orders: value.subs(constant, ENDS.constant) for orders, value in form.items()}


def _norm(end: sp.Expr) -> sp.Expr:
    """Return ``int e^2`` as a sum of positive terms, in the tip and the product at the pin.

    Green's identity leaves a product of slope and reaction, of either sign.  On each side of the
    support ``e' e''' - e''^2 / 2 - beta^4 e^2 / 2`` is constant, which gives that product.
    """
    plain = square_integral((MODE, 0), (MODE, 0), 0, ENDS)
    product = sp.Symbol("product")  # of slope and reaction
    at = ENDS.at
    constant = {
        where: sum(
            factor * at(where, MODE, m) * at(where, MODE, n)
            for (m, n), factor in _first_integral().items()
        )
        for where in (PIN, BEFORE, AFTER, TIP)
    }
    jump = sp.expand(constant[AFTER] - constant[BEFORE])
    slope, reaction = at(BEFORE, MODE, 1), ENDS.values[AFTER, MODE, 3]
    if sp.expand(jump - slope * reaction) != 0:
        raise ArithmeticError(f"{jump} is not slope times reaction")
    found = plain.subs(slope * reaction, product).subs(product, constant[TIP] - constant[PIN])
    parts = sp.collect(sp.expand(found), at(TIP, MODE, 0), evaluate=False)
    by_tip = parts.pop(at(TIP, MODE, 0) ** 2)
    (rest,) = parts.values()
    return sp.expand(by_tip.subs(place, 1 - _FREE)) * end**2 + rest


def rate() -> sp.Expr:
    """Return ``beta' / beta`` in the tip's value and the product at the pin."""
    at = ENDS.at
    product = -ENDS.constant * at(TIP, MODE, 0) ** 2 / 2 - at(PIN, MODE, 1) * at(PIN, MODE, 3)
    found = ENDS.constant_rate / (4 * ENDS.constant)
    slope, reaction = at(BEFORE, MODE, 1), ENDS.values[AFTER, MODE, 3]
    return sp.expand(found.subs(slope * reaction, product))


def _phase_rates() -> tuple[Step, ...]:
    """Return how fast both phases of the support change as it moves, each a product.

    The unit square turns ``1 + xi beta'/beta`` into the tip's part alone, and what goes with the
    other phase into the pin's.
    """
    norm = _norm(RIGHT * _END)
    plain = rate().subs(ENDS.at(TIP, MODE, 0), RIGHT * _END)
    pin = {ENDS.at(PIN, MODE, k): _mode_at(PIN, k) for k in (1, 3)}
    found = []
    for symbol, change in ((SPAN_RATE, norm + place * plain), (HANG_RATE, _FREE * plain - norm)):
        one = sp.expand(sp.expand(change).subs(_FREE, 1 - place)).subs(ENDS.beta, beta)
        found.append((symbol, sp.factor(beta * one.subs(pin))))
    return tuple(found)


def _square_of(values: tuple[sp.Symbol, ...], others: tuple[sp.Symbol, ...]) -> sp.Expr:
    return sp.Add(*(one * other for one, other in zip(values, others, strict=True)))


def _support_steps() -> tuple[Step, ...]:
    """Return slope and moment of either shape at the support, and how its phase changes them.

    Nothing is divided by what vanishes: where the support is a node of slope, or of moment, of
    both shapes, the other condition takes over.
    """
    a, b = SPAN.phase, HANG.phase
    ours, theirs = sides()
    slope_rate = scaled(sp.diff(ours[0], a), SPAN) - _LAMBDA[0] * SPAN.even
    moment = sp.cancel(ours[1] / sp.sinh(a))
    near = (
        (_LAMBDA[0], sp.cancel(at_support(before().shape[1], RUN, SPAN, RISE))),
        (_LAMBDA[1], SPAN.circular(moment)),
        (_LAMBDA_RATES[0], slope_rate / SPAN.odd),
        (_LAMBDA_RATES[1], SPAN.circular(sp.diff(moment, a))),
    )
    far = tuple(
        (name, scaled(e, HANG, k == 1))
        for k, (name, e) in enumerate(zip(_RHO, theirs, strict=True))
    )
    rates = tuple(
        (name, scaled(sp.diff(e, b), HANG) - value)
        for name, value, e in zip(_RHO_RATES, _RHO, theirs, strict=True)
    )
    return (*near, *far, *rates)


def _amplitude_steps() -> tuple[Step, ...]:
    """Return amplitudes of unit square, the tip on the positive side, and the rate of the root."""
    end = REST.phase
    free = HANG.reduced(plain_shape(True).subs(end, 0))
    pin = {ENDS.at(PIN, MODE, k): _mode_at(PIN, k).subs(LEFT, _DOT) for k in (1, 3)}
    tip = {ENDS.at(TIP, MODE, 0): RIGHT * _END}
    of_rate = {key: value.subs(_DOT, LEFT) for key, value in pin.items()}
    return (
        (_END, scaled(free, HANG)),
        (_END_RATE, scaled(sp.diff(free, HANG.phase), HANG) - _END),
        # (amplitude of the pin's bay) lambda = (amplitude beyond) rho, both vectors never zero.
        (_DOT, _square_of(_LAMBDA, _RHO)),
        (_SQUARE, _square_of(_LAMBDA, _LAMBDA)),
        (_OTHER, _square_of(_RHO, _RHO)),
        (_FREE, 1 - place),
        (_SIZE, sp.sqrt(_tidy(_norm(_SQUARE * _END).subs(pin)))),
        (LEFT, _DOT / _SIZE),
        (RIGHT, _SQUARE / _SIZE),
        (RATE, _tidy(rate().subs(of_rate | tip))),
    )


def _tidy(expression: sp.Expr) -> sp.Expr:
    """Return a sum with the differences in each term as the steps have them."""
    return sp.Add(*(sp.factor(term) for term in expression.args))


def _growth_steps() -> tuple[Step, ...]:
    """Differentiate the amplitudes along the support's way, as parts of themselves.

    The ratio of the two is that of the lengths of the vectors lambda and rho.
    """
    pin, growth = sp.symbols("pin growth", real=True)
    norm = _norm(RIGHT * _END).subs(ENDS.at(PIN, MODE, 1), -pin * LEFT**2 * ENDS.constant)
    norm = norm.subs({ENDS.at(PIN, MODE, 3): 1, ENDS.beta: beta})
    ratio = -plain_shape(False).coeff(sp.sinh(RUN.phase))
    first = sp.cancel(sp.diff(plain_shape(False), RUN.phase).subs(RUN.phase, 0))
    third = sp.cancel(sp.diff(plain_shape(False), RUN.phase, 3).subs(RUN.phase, 0))
    if sp.cancel(first * third + 1 - ratio**2) != 0:
        raise ArithmeticError("the product at the pin is not 1 less the square of the ratio")
    moves = (
        (LEFT, growth * LEFT),
        (RIGHT, (growth + _TURN) * RIGHT),
        (place, 1),
        (_FREE, -1),
        (_END, _END_RATE * HANG_RATE),
        (pin, -2 * _RATIO * _RATIO_RATE * SPAN_RATE),
    )
    change = sp.expand(sp.Add(*(sp.diff(norm, of) * value for of, value in moves)))
    rest = change.coeff(growth, 0)
    # The growth beyond is that at the pin and the turn; with its own sum nothing cancels.
    pin_part = norm.coeff(pin) * pin
    far_rest = sp.expand(rest - 2 * pin_part * _TURN - 2 * (norm - pin_part) * _TURN)
    # What multiplies the growth is twice the norm, 2.
    if sp.expand(change.coeff(growth, 1) - 2 * norm) != 0:
        raise ArithmeticError("the norm is not quadratic in the amplitudes")
    product = sp.cancel(_mode_at(PIN, 1) / (LEFT * beta)) * sp.cancel(
        _mode_at(PIN, 3) / (LEFT * beta**3)
    )
    slope = scaled(sides()[0][0], SPAN, True)
    return (
        *_phase_rates(),
        (_RATIO, 2 * SPAN.fade * SPAN.sine / SPAN.odd),
        (_RATIO_RATE, 2 * SPAN.fade * slope / SPAN.odd**2),
        (
            _TURN,
            _square_of(_LAMBDA, _LAMBDA_RATES) / _SQUARE * SPAN_RATE
            - _square_of(_RHO, _RHO_RATES) / _OTHER * HANG_RATE,
        ),
        (LEFT_GROWTH, -_tidy(rest.subs(pin, -product)) / 2),
        (RIGHT_GROWTH, -_tidy(far_rest.subs(pin, -product)) / 2),
    )


def drift(order: int, shape: tuple[sp.Expr, ...], free: bool, moved: sp.Expr) -> sp.Expr:
    """Return a derivative of the mode's drift at a point.

    The support's way changes amplitude, root and the support's own phase.

    ``order``: derivative by eta; ``shape``: the mode and three derivatives; ``free``: whether
    beyond the support; the phase there runs from the tip; ``moved``: the same derivative of the
    shape's derivative by the support's phase.
    """
    mode, arm = sp.Function("mode")(eta), eta - 1 if free else eta
    growth = RIGHT_GROWTH if free else LEFT_GROWTH
    found = sp.diff(growth * mode + RATE * arm * sp.diff(mode, eta), eta, order).doit()
    values = {sp.Derivative(mode, (eta, k)): shape[k] for k in (1, 2, 3)}
    values |= {
        sp.Derivative(mode, eta): shape[1],
        sp.Derivative(mode, (eta, 4)): beta**4 * shape[0],
    }
    found = sp.expand(found).xreplace(values).xreplace({mode: shape[0]})
    change = RIGHT * HANG_RATE * (-beta) ** order if free else LEFT * SPAN_RATE * beta**order
    return sp.collect(found, RATE) + change * moved


def _end_steps() -> tuple[Step, ...]:
    """Return the mode's values at pin, support and tip, then those of its drift."""
    named = {key: symbol for key, symbol in ENDS.values.items()}
    found: list[Step] = []
    jump = sp.Symbol("shear_beyond", real=True)
    for key, symbol in named.items():
        where, kind, order = key
        if kind != MODE:
            continue
        value = _mode_at(where, order)
        if where == AFTER:
            found.append((jump, value))
            value = jump - ENDS.values[BEFORE, MODE, 3]
        found.append((symbol, value))
    beyond_jump = sp.Symbol("shear_drift_beyond", real=True)
    for key, symbol in named.items():
        where, kind, order = key
        if kind != DRIFT:
            continue
        value = _drift_at(where, order, jump)
        if where == AFTER:
            found.append((beyond_jump, value))
            value = beyond_jump - ENDS.values[BEFORE, DRIFT, 3]
        found.append((symbol, value))
    return tuple(found)


def _drift_at(where: str, order: int, shear_beyond: sp.Symbol) -> sp.Expr:
    """Return a derivative of the drift at pin, support or tip."""
    shape = tuple(ENDS.at(where, MODE, k) for k in ORDERS)
    if where == AFTER:
        shape = (*shape[:3], shear_beyond)
    free = where in (AFTER, TIP)
    if free:
        plain, b = plain_shape(True), HANG.phase
        y = b if where == AFTER else sp.S.Zero
        change = sp.diff(plain, b, 1, REST.phase, order) - sp.diff(plain, REST.phase, order)
        moved = scaled(change.subs(REST.phase, y), HANG)
    elif where == BEFORE:
        moved = sp.cancel(at_support(before().moved[order], RUN, SPAN, RISE))
    else:
        steep = {RISE: SPAN.fade, RUN.odd: 0, RUN.even: 2}
        moved = sp.cancel(before().moved[order].subs(steep))
    at = {PIN: sp.S.Zero, BEFORE: place, AFTER: place, TIP: sp.S.One}[where]
    return drift(order, shape, free, moved).subs(eta, at)


@lru_cache(maxsize=1)
def end_steps() -> tuple[Step, ...]:
    """Return all steps from place and root to amplitudes and end values."""
    return (
        *SPAN.steps(beta * place),
        *HANG.steps(beta * (1 - place)),
        *_support_steps(),
        *_amplitude_steps(),
        *_growth_steps(),
        *((symbol, value.subs(ENDS.beta, beta)) for symbol, value in _end_steps()),
    )


def point_steps(free: bool) -> tuple[Step, ...]:
    """Return the phases of a point on one side of the support."""
    if free:
        beyond_support = beta * (eta - place)
        close = sp.Piecewise((SWITCH, beyond_support > SWITCH), (beyond_support, True))
        return (
            *REST.steps(beta * (1 - eta)),
            *HANG.steps(beta * (1 - place)),
            *CLOSE.steps(close),
            (SINK, sp.exp(-beyond_support)),
            *lean_steps(),
        )
    return (
        *RUN.steps(beta * eta),
        *SPAN.steps(beta * place),
        (RISE, sp.exp(-beta * (place - eta))),
    )


def bay(free: bool) -> Bay:
    """Return the bay beyond the support, or the one between pin and support."""
    return beyond() if free else before()


def shape(free: bool) -> tuple[sp.Expr, ...]:
    """Return the mode and three derivatives by eta on one side of the support."""
    factor, turn = (RIGHT, -beta) if free else (LEFT, beta)
    values = list(bay(free).shape)
    if free:
        away = beta * (eta - place) > SWITCH
        values[0] = sp.Piecewise((values[0], away), (beyond_from_support(), True))
    return tuple(factor * turn**k * value for k, value in enumerate(values))
