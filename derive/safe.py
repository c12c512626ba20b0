"""Rewriting without cancellation: equal expressions whose floating-point values keep their digits.

Every rewriting proves itself: it returns an expression only where the difference from the
original expands to zero.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp


class UnsafeRewriting(ArithmeticError):  # noqa: N818 - reads as what it is
    """A rewriting did not reproduce the expression that it started from."""


def vanishes(expression: sp.Expr) -> bool:
    """Return True where a rational function of exponentials is zero everywhere.

    Exponents, those of hyperbolic functions among them, are sums of whole multiples of halves of
    the same products.
    """
    plain = sp.expand(expression, deep=False).rewrite(sp.exp)
    bases: dict[sp.Expr, sp.Symbol] = {}
    table = {}
    for exponential in plain.atoms(sp.exp):
        value = sp.S.One
        for term in sp.Add.make_args(sp.expand(exponential.args[0])):
            multiple, product = term.as_coeff_Mul()
            base = bases.setdefault(product, sp.Symbol(f"base_{len(bases)}", positive=True))
            value *= base ** (2 * multiple)
        table[exponential] = value
    above, _ = sp.fraction(sp.together(plain.xreplace(table)))
    return bool(sp.expand(above) == 0)


def bernstein_in_cosine(
    expression: sp.Expr,
    cosine: sp.Symbol,
    cos_half_squared: sp.Expr,
    sin_half_squared: sp.Expr,
    sums: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> sp.Expr:
    """Write a polynomial in ``cos x`` by its end values, in ``cos^2(x/2)`` and ``sin^2(x/2)``.

    A linear factor ``a + b cos x`` is ``P(1) cos^2(x/2) + P(-1) sin^2(x/2)``.  Where both end
    values have one sign, nothing cancels, however close the factor comes to zero; and the end
    values factor into differences of lengths, which are computed to the last digit.

    ``expression``: polynomial in ``cosine``; it is factored first, each factor must be linear in
    it; ``cosine``: stands for ``cos x``; ``cos_half_squared``, ``sin_half_squared``: symbols or
    expressions for ``cos^2(x/2)`` and ``sin^2(x/2)``; ``sums``: symbols by sums and differences
    that are formed first, for example ``a: (s + d) / 2``; the end values are written in these, so
    that three lengths never meet in an order of chance.
    """
    constant, factors = sp.factor_list(expression)
    rewritten = constant
    for factor, multiplicity in factors:
        if not factor.has(cosine):
            rewritten *= factor**multiplicity
            continue
        if sp.degree(factor, cosine) != 1:
            raise UnsafeRewriting(f"factor {factor} is not linear in {cosine}")
        ends = (factor.subs(cosine, end).subs(sums or {}) for end in (1, -1))
        upper, lower = (sp.factor(end) for end in ends)
        form = upper * cos_half_squared + lower * sin_half_squared
        back = form.subs({cos_half_squared: (1 + cosine) / 2, sin_half_squared: (1 - cosine) / 2})
        if sp.expand(back - factor.subs(sums or {})) != 0:
            raise UnsafeRewriting(f"{form} is not {factor}")
        rewritten *= form**multiplicity
    return rewritten


def solve_cosine_sine(
    a: sp.Expr, b: sp.Expr, c: sp.Expr, root: sp.Expr
) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Solve ``a cos x + b sin x = c`` for ``(cos x, sin x)``.

    ``a``, ``b``, ``c``: coefficients; ``root``: symbol for the signed square root of the
    discriminant. Returns ``cos, sin, discriminant``: ``discriminant = a^2 + b^2 - c^2`` is the
    square of ``root``.
    """
    square = a**2 + b**2
    cos = (a * c - b * root) / square
    sin = (b * c + a * root) / square
    discriminant = square - c**2
    residual = sp.cancel(a * cos + b * sin - c)
    circle = sp.cancel((cos**2 + sin**2 - 1).subs(root, sp.sqrt(discriminant)))
    if residual != 0 or sp.simplify(circle) != 0:
        raise UnsafeRewriting(f"cos, sin do not solve {a} cos + {b} sin = {c}")
    return cos, sin, discriminant


def root_of_parts(
    parts: tuple[sp.Expr, sp.Expr],
    names: tuple[sp.Symbol, sp.Symbol],
    root: sp.Symbol,
    product: sp.Expr,
) -> sp.Expr:
    """Write ``sqrt(a b)`` with ``a + b`` known exactly so that errors of a and b cancel.

    Where a and b nearly agree, an error moves digits from one to the other and should leave the
    product alone; computed apart they do not know of each other.  Divided by their sum they do.

    ``parts``: a and b; their sum is to be free of what they vary with; ``names``: symbols that
    stand for a and b; ``root``: stands for ``sqrt(a b)`` from the computed values; ``product``:
    what a b must expand to.
    """
    first, second = parts
    if sp.expand(first * second - product) != 0:
        raise UnsafeRewriting(f"({first}) ({second}) is not {product}")
    return sp.expand(first + second) * root / (names[0] + names[1])
