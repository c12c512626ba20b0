"""Integral table: polynomials times products of sin, cos, sinh, cosh and exp, in closed form.

Products are turned into sums, hyperbolic functions into exponentials; what remains,
``x^k exp(a x) cos(b x + c)``, has a finite antiderivative by repeated integration by parts.  There
is no search and no heuristic: an integrand outside the table is an error.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Literal

import sympy as sp

from .arrays import IndexedEntry, IndexedVector

_Kind = Literal["cos", "sin"]
_HALF = sp.Rational(1, 2)


class UnknownIntegrand(ValueError):  # noqa: N818 - reads as what it is
    """An integrand is outside the table, or its closed form fails for some mode numbers."""


@dataclass(frozen=True)
class _Element:
    """``factor * x^power * exp(growth x + shift) * kind(frequency x + phase)``."""

    factor: sp.Expr = sp.S.One
    power: int = 0
    growth: sp.Expr = sp.S.Zero
    shift: sp.Expr = sp.S.Zero
    frequency: sp.Expr = sp.S.Zero
    phase: sp.Expr = sp.S.Zero
    kind: _Kind = "cos"

    @property
    def oscillates(self) -> bool:
        return not (self.frequency == 0 and self.phase == 0 and self.kind == "cos")

    def times(self, other: _Element) -> list[_Element]:
        """Return the product as a sum of elements."""
        base = replace(
            self,
            factor=self.factor * other.factor,
            power=self.power + other.power,
            growth=_sum(self.growth, other.growth),
            shift=_sum(self.shift, other.shift),
        )
        if not other.oscillates:
            return [base]
        if not self.oscillates:
            return [
                replace(base, frequency=other.frequency, phase=other.phase, kind=other.kind),
            ]
        return [
            replace(
                base,
                factor=base.factor * weight,
                frequency=_sum(self.frequency, sign * other.frequency),
                phase=_sum(self.phase, sign * other.phase),
                kind=kind,
            )
            for weight, sign, kind in _PRODUCTS[self.kind, other.kind]
        ]

    def same_shape(self) -> tuple[object, ...]:
        return (self.power, self.growth, self.shift, self.frequency, self.phase, self.kind)


def _sum(left: sp.Expr, right: sp.Expr) -> sp.Expr:
    """Return a sum in expanded form; most of them have a zero in them."""
    if right == 0:
        return left
    return right if left == 0 else sp.expand(left + right)


# cos A cos B, cos A sin B, ... as sums: (weight, sign of B, kind)
_PRODUCTS: dict[tuple[_Kind, _Kind], tuple[tuple[sp.Expr, int, _Kind], ...]] = {
    ("cos", "cos"): ((_HALF, -1, "cos"), (_HALF, 1, "cos")),
    ("sin", "sin"): ((_HALF, -1, "cos"), (-_HALF, 1, "cos")),
    ("sin", "cos"): ((_HALF, -1, "sin"), (_HALF, 1, "sin")),
    ("cos", "sin"): ((-_HALF, -1, "sin"), (_HALF, 1, "sin")),
}


def _linear(argument: sp.Expr, x: sp.Symbol, where: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    argument = sp.expand(argument)
    slope = argument.coeff(x, 1)
    rest = sp.expand(argument - slope * x)
    if rest.has(x) or slope.has(x):
        raise UnknownIntegrand(f"{where}: the argument is not linear in {x}")
    return slope, rest


def _factor_elements(factor: sp.Expr, x: sp.Symbol) -> list[_Element]:
    """Return one factor of a product as a sum of elements."""
    if not factor.has(x):
        return [_Element(factor=factor)]
    if factor == x:
        return [_Element(power=1)]
    if isinstance(factor, sp.exp):
        slope, rest = _linear(factor.args[0], x, factor)
        return [_Element(growth=slope, shift=rest)]
    if isinstance(factor, sp.Pow):
        base, exponent = factor.as_base_exp()
        if not (exponent.is_Integer and exponent > 0):
            raise UnknownIntegrand(
                f"{factor} is no polynomial, trigonometric or exponential factor"
            )
        if base == x:
            return [_Element(power=int(exponent))]
        return _multiply([_factor_elements(base, x)] * int(exponent))
    if isinstance(factor, sp.sin | sp.cos):
        slope, rest = _linear(factor.args[0], x, factor)
        kind: _Kind = "sin" if isinstance(factor, sp.sin) else "cos"
        return [_Element(frequency=slope, phase=rest, kind=kind)]
    if isinstance(factor, sp.sinh | sp.cosh):
        slope, rest = _linear(factor.args[0], x, factor)
        sign = -1 if isinstance(factor, sp.sinh) else 1
        up = _Element(factor=_HALF, growth=slope, shift=rest)
        return [up, _Element(factor=sign * _HALF, growth=-slope, shift=-rest)]
    raise UnknownIntegrand(f"{factor} is not in the table of integrals")


def _multiply(factors: Iterable[list[_Element]]) -> list[_Element]:
    total = [_Element()]
    for elements in factors:
        total = [piece for left in total for right in elements for piece in left.times(right)]
    return total


def _elements(expression: sp.Expr, x: sp.Symbol) -> list[_Element]:
    """Write an integrand as a sum of elements of distinct shapes."""
    merged: dict[tuple[object, ...], _Element] = {}
    for term in sp.Add.make_args(sp.expand(sp.sympify(expression))):
        for piece in _multiply(_factor_elements(f, x) for f in sp.Mul.make_args(term)):
            shape = piece.same_shape()
            known = merged.get(shape)
            merged[shape] = (
                piece if known is None else replace(known, factor=known.factor + piece.factor)
            )
    return [piece for piece in merged.values() if piece.factor != 0]


def _cis(phase: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return cos and sin of a phase, exactly where it is an integer multiple of pi/2."""
    turns = sp.expand(phase / sp.pi)
    if turns.is_integer:
        return _parity(turns), sp.S.Zero
    shifted = sp.expand(turns - _HALF)
    if shifted.is_integer:
        return sp.S.Zero, _parity(shifted)
    return sp.cos(phase), sp.sin(phase)


def _parity(exponent: sp.Expr) -> sp.Expr:
    """Return ``(-1)**exponent``, the exponent's coefficients reduced modulo 2."""
    terms = sp.Add.make_args(sp.expand(exponent))
    reduced = sp.S.Zero
    for term in terms:
        coefficient, rest = term.as_coeff_Mul()
        reduced += (coefficient % 2) * rest if coefficient.is_Integer else term
    return (-1) ** reduced


def _reciprocal_powers(a: sp.Expr, b: sp.Expr, count: int) -> list[tuple[sp.Expr, sp.Expr]]:
    """Return real and imaginary parts of ``(a + i b)^-1 ... (a + i b)^-count``."""
    if a == 0:
        cycle = ((0, -1), (-1, 0), (0, 1), (1, 0))
        return [
            (cycle[j % 4][0] / b ** (j + 1), cycle[j % 4][1] / b ** (j + 1)) for j in range(count)
        ]
    if b == 0:
        return [(a ** -(j + 1), sp.S.Zero) for j in range(count)]
    square = a**2 + b**2
    parts = [(a / square, -b / square)]
    for _ in range(count - 1):
        re, im = parts[-1]
        parts.append((sp.expand(re * a + im * b) / square, sp.expand(im * a - re * b) / square))
    return parts


def _check_frequency(b: sp.Expr, distinct: tuple[sp.Symbol, sp.Symbol] | None) -> None:
    """Refuse a frequency that vanishes for some positive mode numbers."""
    indices = sorted((s for s in b.free_symbols if s.is_integer), key=lambda s: s.name)
    if not indices:
        return
    terms = sp.Add.make_args(sp.expand(b))
    scale = terms[0] / sp.Mul(*(f for f in sp.Mul.make_args(terms[0]) if f in indices))
    scale = sp.Abs(scale.as_coeff_Mul()[0]) ** -1 * scale
    ratios = [sp.cancel(term / scale) for term in terms]
    numbers = [ratio.as_coeff_Mul()[0] for ratio in ratios]
    clean = all((r / c).free_symbols <= set(indices) for r, c in zip(ratios, numbers, strict=True))
    if clean and (all(c > 0 for c in numbers) or all(c < 0 for c in numbers)):
        return
    if clean and distinct is not None and len(ratios) == 2 and sum(numbers) == 0:
        rests = {sp.cancel(r / c) for r, c in zip(ratios, numbers, strict=True)}
        if rests == set(distinct):
            return
    raise UnknownIntegrand(f"the frequency {b} may vanish for some mode numbers")


def _primitive(
    element: _Element,
    x: sp.Expr,
    wave: Callable[[sp.Expr], tuple[sp.Expr, sp.Expr]],
) -> sp.Expr:
    """Evaluate the antiderivative of an element at x."""
    k, a, b = element.power, element.growth, element.frequency
    if a == 0 and b == 0:
        constant = sp.exp(element.shift)
        if element.oscillates:
            constant *= wave(element.phase)[0 if element.kind == "cos" else 1]
        return element.factor * constant * x ** (k + 1) / (k + 1)
    cos, sin = wave(b * x + element.phase)
    b = sp.factor_terms(b)
    total = sp.S.Zero
    coefficient = sp.S.One
    for j, (re, im) in enumerate(_reciprocal_powers(a, b, k + 1)):
        rotated = re * cos - im * sin if element.kind == "cos" else re * sin + im * cos
        total += coefficient * x ** (k - j) * rotated
        coefficient *= -(k - j)
    return element.factor * sp.exp(a * x + element.shift) * total


def antiderivative(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Return an antiderivative in x.

    Parameters
    ----------
    expression : Expr
        Sum of polynomials in x times products of sin, cos, sinh, cosh, exp of linear arguments.
    x : Symbol
        Variable.

    Raises
    ------
    UnknownIntegrand
        If the integrand is outside the table.
    """
    total = sp.S.Zero
    for element in _elements(expression, x):
        _check_frequency(element.frequency, None)
        total += _primitive(element, x, lambda phase: (sp.cos(phase), sp.sin(phase)))
    return total


def definite(
    expression: sp.Expr,
    x: sp.Symbol,
    lower: sp.Expr = sp.S.Zero,
    upper: sp.Expr = sp.S.One,
    *,
    distinct: tuple[sp.Symbol, sp.Symbol] | None = None,
) -> sp.Expr:
    """Return the integral from ``lower`` to ``upper`` in closed form.

    Parameters
    ----------
    expression : Expr
        As for :func:`antiderivative`.  Symbols declared integer count as positive mode numbers.
    x : Symbol
        Variable.
    lower, upper : Expr
        Limits.
    distinct : (Symbol, Symbol), optional
        Two mode numbers that are known to differ.

    Returns
    -------
    Expr
        With ``sin(m pi) = 0`` and ``cos(m pi) = (-1)**m`` for mode numbers m.

    Raises
    ------
    UnknownIntegrand
        If the integrand is outside the table, or the closed form divides by something that is
        zero for some mode numbers.
    """
    total = sp.S.Zero
    for element in _elements(expression, x):
        _check_frequency(element.frequency, distinct)
        total += _primitive(element, sp.sympify(upper), _cis)
        total -= _primitive(element, sp.sympify(lower), _cis)
    return total


def mode_integral(
    integrand: sp.Expr,
    x: sp.Symbol,
    m: sp.Symbol,
    n: sp.Symbol,
    lower: sp.Expr = sp.S.Zero,
    upper: sp.Expr = sp.S.One,
) -> IndexedEntry:
    """Integrate a product of two modes for all mode numbers: equal and different ones apart.

    ``integrand``: in x and the integer symbols m (row) and n (column); ``x``, ``m``, ``n``:
    variable and mode numbers; m and n must be declared integer; ``lower``, ``upper``: limits.
    Raises ``UnknownIntegrand`` as for :func:`definite`.
    """
    _require_integers(m, n)
    integrand = sp.sympify(integrand)
    return IndexedEntry(
        diagonal=definite(integrand.subs(n, m), x, lower, upper),
        off_diagonal=definite(integrand, x, lower, upper, distinct=(m, n)),
        m=m,
        n=n,
    )


def mode_vector(
    integrand: sp.Expr,
    x: sp.Symbol,
    m: sp.Symbol,
    lower: sp.Expr = sp.S.Zero,
    upper: sp.Expr = sp.S.One,
) -> IndexedVector:
    """Integrate an expression with one mode in it, for all mode numbers.

    Raises ``UnknownIntegrand`` as for :func:`definite`.
    """
    _require_integers(m)
    return IndexedVector(definite(integrand, x, lower, upper), m)


def _require_integers(*symbols: sp.Symbol) -> None:
    wrong = [str(s) for s in symbols if not s.is_integer]
    if wrong:
        raise ValueError(f"mode numbers {wrong} are not declared integer")
