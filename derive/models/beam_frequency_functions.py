"""Frequency functions of a beam, and their rates with the squared frequency, without cancellation.

The two halves of the boundary value problem are put together, half phases become whole ones, what
grows is divided out, and differences that vanish with the phase are formed as such.  The rates are
quadratic in the functions themselves; near zero, where that cancels, a power series takes over.
"""

from __future__ import annotations

import itertools
import math
from functools import lru_cache

import sympy as sp

from ..safe import UnsafeRewriting
from ..series import series_terms, taylor
from ..staged import ClosedForm, Step, Steps
from .beam_frequency_problem import HALF, B, Z, half_problem
from .overhang_waves import SWITCH, Wave, without_square

# Generalised displacements: deflection and slope at the left end, then at the right one.
# The functions by their place in the matrix, and the sign that goes with it (Aannaque (5.18)).
PLACES = {
    "F1": ((1, 3), 1),
    "F2": ((3, 3), 1),
    "F3": ((0, 3), 1),
    "F4": ((2, 3), 1),
    "F5": ((0, 2), 1),
    "F6": ((2, 2), 1),
}
FULL, PART = Wave.of("full"), Wave.of("part")  # z, and half of it
LAGS = {wave: sp.Symbol(f"{wave.phase.name}_lag", real=True) for wave in (FULL, PART)}
DIVISOR = sp.Symbol("divisor", real=True)
FUNCTIONS = {name: sp.Symbol(name, real=True) for name in PLACES}
SQUARED = sp.Symbol("squared", real=True)  # z^4: the squared frequency
_RATE_SWITCH = sp.Integer(3)  # z below which the quadratic forms of the rates cancel
_INERTIA_SWITCH = sp.Integer(4)  # z below which a function is too near its static value
_AXIAL_SWITCH = sp.Integer(1)
_LEFT_OUT = sp.Rational(1, 2**57)  # largest remainder of a series, over its value


def lag(v: sp.Expr) -> sp.Expr:
    """Return what is left of two products that agree to the second order."""
    return sp.sin(v) * sp.cosh(v) - sp.cos(v) * sp.sinh(v)


@lru_cache(maxsize=1)
def numerators() -> tuple[dict[str, sp.Expr], sp.Expr]:
    """Return the frequency functions of bending over a common divisor, in the whole phase.

    Returns ``numerators``: by name, in z; ``divisor``: it vanishes at the frequencies of the
    clamped-clamped beam.
    """
    even, odd = half_problem(False, 1), half_problem(False, -1)
    divisor = sp.expand(even.divisor * odd.divisor)
    found = {}
    for name, (place, sign) in PLACES.items():
        total = sp.S.Zero
        for half, other, parity in ((even, odd, 1), (odd, even, -1)):
            row, column = (index % 2 for index in place)
            # The left end follows the right one: value with the parity, slope against it.
            factor = sp.S.One
            for index in place:
                factor *= 1 if index > 1 else parity * (-1) ** (index % 2)
            total += sign * factor * half.forces[row, column] * other.divisor * HALF
        found[name] = whole_phase(total)
    return found, whole_phase(divisor)


def whole_phase(expression: sp.Expr) -> sp.Expr:
    """Write products of functions of z/2 by those of z, as far as they are products of two."""
    h = Z / 2
    generators = (sp.sin(h), sp.cos(h), sp.sinh(h), sp.cosh(h))
    polynomial = sp.Poly(sp.expand(expression), *generators)
    circular = {(2, 0): (1 - sp.cos(Z)) / 2, (1, 1): sp.sin(Z) / 2, (0, 2): (1 + sp.cos(Z)) / 2}
    growing = {(2, 0): (sp.cosh(Z) - 1) / 2, (1, 1): sp.sinh(Z) / 2, (0, 2): (sp.cosh(Z) + 1) / 2}
    total = sp.S.Zero
    for (sine, cosine, rise, size), coefficient in polynomial.terms():
        total += coefficient * circular[sine, cosine] * growing[rise, size]
    return sp.expand(total)


def lag_step(wave: Wave) -> Step:
    """Return the definition of ``2 exp(-v) (sin v cosh v - cos v sinh v)``."""
    v = wave.phase
    fourth = sp.Symbol(f"{v.name}_fourth", real=True)
    start, series = nested(lag(v), v, SWITCH, fourth)
    direct = wave.sine * wave.even - wave.cosine * wave.odd
    small = 2 * wave.fade * v**start * series
    return LAGS[wave], sp.Piecewise((direct, v > SWITCH), (small, True))


def steps() -> Steps:
    """Return everything that the frequency functions of bending are made of."""
    even, odd = half_problem(False, 1).divisor, half_problem(False, -1).divisor
    product = scaled(even, PART) * scaled(odd, PART)
    return Steps(
        (
            *FULL.steps(Z),
            lag_step(FULL),
            *PART.steps(Z / 2),
            lag_step(PART),
            (DIVISOR, product),
        )
    )


def scaled(expression: sp.Expr, wave: Wave) -> sp.Expr:
    """Return ``2 exp(-v)`` times a function linear in sinh v and cosh v, without cancellation."""
    v = wave.phase
    plain = sp.expand(expression.subs(Z, v if wave is FULL else 2 * v))
    waves = (sp.sin, sp.cos, sp.sinh, sp.cosh)
    factor, rest = sp.factor_terms(plain).as_independent(*waves, as_Add=False)
    rest = sp.expand(rest)
    order = [_leading(term, v) for term in (rest, *sp.Add.make_args(rest))]
    if order[0] == min(order[1:]):
        return sp.expand(factor * sp.expand(2 * wave.fade * wave.by_size(rest)))
    ratio = rest.coeff(sp.sin(v) * sp.cosh(v))
    if ratio != 0 and sp.expand(rest - ratio * lag(v)) == 0:
        return factor * ratio * LAGS[wave]
    form = sp.expand(2 * wave.fade * wave.by_excess(rest))
    # Two terms of one sign or a single one remain where the difference itself was named.
    if not form.is_Mul and form not in (wave.excess, wave.spread):
        raise UnsafeRewriting(f"{rest} cancels near zero")
    return factor * form


def _leading(expression: sp.Expr, v: sp.Symbol) -> int:
    """Return the order of the first term of the power series at zero."""
    return int(sp.Poly(taylor(expression, v, 1).value, v).degree())


@lru_cache(maxsize=1)
def functions() -> dict[str, sp.Expr]:
    """Return F1 to F6 in the quantities of :func:`steps`, having shown that they are equal."""
    above, divisor = numerators()
    found = {}
    for name, numerator in above.items():
        # 2 exp(-z) of the numerator, 4 exp(-z) of the divisor.
        form = 2 * scaled(numerator, FULL) / DIVISOR
        _prove(form, numerator / divisor)
        found[name] = form
    return found


def _prove(form: sp.Expr, original: sp.Expr) -> None:
    """Raise where a form is not the original."""
    f, s, c = sp.symbols("f s c", positive=True)  # exp(-z/2), sin z/2, cos z/2
    whole = {
        sp.sin(Z): 2 * s * c,
        sp.cos(Z): c**2 - s**2,
        sp.sinh(Z): (1 / f**2 - f**2) / 2,
        sp.cosh(Z): (1 / f**2 + f**2) / 2,
    }
    inner = steps().mapping()
    known = form.subs(DIVISOR, inner[DIVISOR])
    for wave, sine, cosine, fade in ((FULL, 2 * s * c, c**2 - s**2, f**2), (PART, s, c, f)):
        known = known.xreplace({LAGS[wave]: sine * wave.even - cosine * wave.odd})
        known = wave.elementary(known)
        known = known.xreplace({wave.sine: sine, wave.cosine: cosine, wave.fade: fade})
        known = known.xreplace({wave.phase: Z if wave is FULL else Z / 2})
    difference = known - original.xreplace(whole)
    above = sp.expand(sp.fraction(sp.together(difference))[0])
    if sp.expand(without_square(above, s, 1 - c**2)) != 0:
        raise UnsafeRewriting(f"{form} is not {original}")


@lru_cache(maxsize=1)
def rate_forms() -> dict[str, sp.Expr]:
    """Return ``4 z^4 G_i = -z dF_i/dz`` as polynomials in the functions.

    The shortest combination of the functions and of products of two of them, of the right power
    of z, that is equal.
    """
    above, divisor = numerators()
    waves = (sp.sin(Z), sp.cos(Z), sp.sinh(Z), sp.cosh(Z))
    weights = {name: sp.Poly(n, Z, *waves).degree(Z) for name, n in above.items()}
    plain = {name: n / Z ** weights[name] for name, n in above.items()}
    found = {}
    for name, numerator in plain.items():
        weight = weights[name]
        bare = sp.diff(numerator, Z) * divisor - numerator * sp.diff(divisor, Z)
        single = [n for n in plain if weights[n] == weight + 1]
        pairs = [
            pair
            for pair in itertools.combinations_with_replacement(plain, 2)
            if weights[pair[0]] + weights[pair[1]] == weight + 1
        ]
        table = {FUNCTIONS[n]: _monomials(plain[n] * divisor) for n in single}
        table |= {
            FUNCTIONS[one] * FUNCTIONS[two]: _monomials(plain[one] * plain[two])
            for one, two in pairs
        }
        rest = _shortest(_monomials(bare), table)
        found[name] = sp.expand(-weight * FUNCTIONS[name] - rest)
    return found


def _monomials(expression: sp.Expr) -> dict[tuple[int, ...], sp.Expr]:
    """Return the coefficients of a polynomial in sin z, cos z, sinh z and cosh z."""
    found = sp.expand(expression)
    for square, other, sign in ((sp.cos(Z), sp.sin(Z), -1), (sp.cosh(Z), sp.sinh(Z), 1)):
        found = without_square(found, square, 1 + sign * other**2)
    polynomial = sp.Poly(found, sp.sin(Z), sp.cos(Z), sp.sinh(Z), sp.cosh(Z))
    return dict(polynomial.terms())


def _shortest(
    wanted: dict[tuple[int, ...], sp.Expr], table: dict[sp.Expr, dict[tuple[int, ...], sp.Expr]]
) -> sp.Expr:
    for size in range(1, len(table) + 1):
        for chosen in itertools.combinations(table, size):
            columns = [table[item] for item in chosen]
            rows = sorted(set(wanted).union(*columns))
            matrix = sp.Matrix([[column.get(row, 0) for column in columns] for row in rows])
            right = sp.Matrix([wanted.get(row, 0) for row in rows])
            unknowns = sp.symbols(f"k:{size}")
            solution = sp.linsolve((matrix, right), *unknowns)
            if solution != sp.S.EmptySet:
                (values,) = solution
                if not set().union(*(value.free_symbols for value in values)):
                    return sp.Add(*(k * item for k, item in zip(values, chosen, strict=True)))
    raise UnsafeRewriting(f"{wanted} is no combination of {sorted(map(str, table))}")


def nested(
    expression: sp.Expr, variable: sp.Symbol, switch: sp.Expr, power: sp.Symbol
) -> tuple[int, sp.Expr]:
    """Return a power series that serves below ``switch``, nested, its numbers rounded once.

    ``expression``: entire function; ``variable``: its argument; ``switch``: where it has to be
    exact to the last digit; so many terms are taken; ``power``: stands for the power of the
    variable by which the series goes. Returns ``start``: power of the variable in front; ``value``:
    the rest, in ``power``.
    """
    found: list[tuple[int, sp.Expr]] = []
    total = sp.S.Zero
    for order, coefficient in series_terms(expression, variable):
        reached = coefficient * switch**order
        if len(found) > 1 and abs(reached / total) < _LEFT_OUT:
            break
        found.append((order, coefficient))
        total += reached
    start, last = found[0][0], found[-1][0]
    table = dict(found)
    step = math.gcd(*(order - start for order, _ in found))
    value = sp.S.Zero
    for order in range(last, start - 1, -step):
        value = sp.Float(table.get(order, 0), 40) + power * value
    return start, value


@lru_cache(maxsize=1)
def rates() -> dict[str, sp.Expr]:
    """Return G1 to G6 in the functions, and near zero by a power series over the divisor."""
    above, divisor = numerators()
    found = {}
    for name, form in rate_forms().items():
        direct = form / (4 * SQUARED)
        # Over the squared divisor the rate is entire, and begins with its eighth power.
        entire = sp.expand(sp.diff(divisor, Z) * above[name] - sp.diff(above[name], Z) * divisor)
        start, series = nested(entire / 4, Z, _RATE_SWITCH, SQUARED)
        if start != 3 + 8:
            raise UnsafeRewriting(f"{entire} begins with power {start}")
        small = (4 * FULL.fade * SQUARED / DIVISOR) ** 2 * series
        found[f"G{name[1:]}"] = sp.Piecewise((direct, Z > _RATE_SWITCH), (small, True))
    return found


@lru_cache(maxsize=1)
def inertias() -> dict[str, sp.Expr]:
    """Return H1 to H6: what takes a function from its static value, over z^4."""
    above, divisor = numerators()
    found = {}
    for name in PLACES:
        static = static_value(above[name], divisor, Z)
        direct = (static - FUNCTIONS[name]) / SQUARED
        start, series = nested(static * divisor - above[name], Z, _INERTIA_SWITCH, SQUARED)
        if start != 8:
            raise UnsafeRewriting(f"{name} leaves its static value with power {start - 4}")
        small = 4 * FULL.fade * SQUARED / DIVISOR * series
        found[f"H{name[1:]}"] = sp.Piecewise((direct, Z > _INERTIA_SWITCH), (small, True))
    return found


def static_value(above: sp.Expr, below: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Return the limit of a quotient at zero."""
    return sp.cancel(taylor(above, variable, 1).value / taylor(below, variable, 1).value)


@lru_cache(maxsize=1)
def axial_inertias() -> tuple[Steps, dict[str, sp.Expr]]:
    """Return steps, H7 and H8: what takes F7, F8 from their static values, over b^2."""
    own, functions_, _ = axial()
    square, sine, cosine = (symbol for symbol, _ in own.steps)
    back = {sine: sp.sin(B), cosine: sp.cos(B)}
    found = {}
    for name, function in functions_.items():
        numerator = sp.expand(function.xreplace(back) * sp.sin(B))
        static = sp.cancel(sp.limit(numerator / B, B, 0))
        entire = sp.expand(static * sp.sin(B) - numerator)
        direct = (static - function) / square
        start, series = nested(entire, B, _AXIAL_SWITCH, square)
        if start != 3:
            raise UnsafeRewriting(f"{name} leaves its static value with power {start - 1}")
        found[f"H{name[1:]}"] = sp.Piecewise((direct, B > _AXIAL_SWITCH), (B / sine * series, True))
    return own, found


@lru_cache(maxsize=1)
def axial() -> tuple[Steps, dict[str, sp.Expr], dict[str, sp.Expr]]:
    """Return steps, F7, F8 and G7, G8 of the motion along the beam."""
    even, odd = half_problem(True, 1), half_problem(True, -1)
    divisor = _whole_angle(even.divisor * odd.divisor)
    functions_, rates_ = {}, {}
    square = sp.Symbol("square", real=True)
    sine, cosine = sp.symbols("sine cosine", real=True)
    values = {sp.sin(B): sine, sp.cos(B): cosine}
    for name, rate, parity in (("F7", "G7", 1), ("F8", "G8", -1)):
        total = even.forces[0, 0] * odd.divisor + parity * odd.forces[0, 0] * even.divisor
        function = sp.cancel(_whole_angle(total / 2) / divisor)
        functions_[name] = function.xreplace(values)
        # b times the rate, over the squared sine: an entire function that begins with b^3.
        slope = sp.expand(-sp.diff(function, B) * sp.sin(B) ** 2 / 2)
        slope = sp.expand(slope.subs(sp.cos(B) ** 2, 1 - sp.sin(B) ** 2))
        if slope.has(1 / sp.sin(B)):
            raise UnsafeRewriting(f"{slope} is not entire")
        start, series = nested(slope, B, _AXIAL_SWITCH, square)
        if start != 3:
            raise UnsafeRewriting(f"{slope} begins with power {start}")
        direct = slope.xreplace(values) / (B * sine**2)
        small = (B / sine) ** 2 * series
        rates_[rate] = sp.Piecewise((direct, B > _AXIAL_SWITCH), (small, True))
    own = Steps(((square, B**2), (sine, sp.sin(B)), (cosine, sp.cos(B))))
    return own, functions_, rates_


def _whole_angle(expression: sp.Expr) -> sp.Expr:
    half = {sp.sin(B / 2) * sp.cos(B / 2): sp.sin(B) / 2}
    found = sp.expand(expression)
    for square, value in ((sp.sin, 1 - sp.cos(B)), (sp.cos, 1 + sp.cos(B))):
        found = found.subs(square(B / 2) ** 2, value / 2)
    return sp.expand(sp.expand(found).subs(half))


def bending_poles() -> ClosedForm:
    """Return the count of roots of the divisor below z.

    Its sign changes once in each interval between two whole multiples of pi, but for the first
    one; at the multiples it is that of ``-cos`` there.  The sign is that of the computed divisor:
    count and stiffness change together.
    """
    divisor = numerators()[1]
    cosine = divisor.coeff(sp.cosh(Z))
    at_multiples = [sp.sign(cosine.subs(Z, k * sp.pi)) * (-1) ** k for k in range(1, 5)]
    if set(at_multiples) != {-1} or taylor(divisor, Z, 1).value.subs(Z, 1) <= 0:
        raise UnsafeRewriting(f"the sign of {divisor} at multiples of pi is not known")
    whole, turned = sp.symbols("whole turned", real=True)
    sign = sp.Piecewise((1, DIVISOR > 0), (-1, True))
    own = steps().then((whole, sp.floor(Z / sp.pi)), (turned, 1 - 2 * sp.Mod(whole, 2)))
    count = whole - (1 - turned * sign) / 2
    return ClosedForm((Z,), own.needed((count,)), (("bending_count", count),))


def axial_poles() -> ClosedForm:
    """Return the count of roots of the axial divisor, whole multiples of pi, below b.

    The nearest multiple is counted where the computed sine has changed its sign.
    """
    nearest, turned, short = sp.symbols("nearest turned short", real=True)
    below = sp.Piecewise((1, short > 0), (0, True))
    own = Steps(
        (
            (nearest, sp.floor(B / sp.pi + HALF)),
            (turned, 1 - 2 * sp.Mod(nearest, 2)),
            (short, -turned * sp.sin(B)),
        )
    )
    count = nearest - below
    return ClosedForm((B,), own, (("axial_count", count),))
