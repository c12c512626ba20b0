"""Waves of a beam of two bays: phases, and functions of them that neither cancel nor overflow."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy.codegen.cfunctions import expm1

from ..safe import UnsafeRewriting
from ..series import taylor
from ..staged import Step

SWITCH = sp.Rational(3, 2)  # phase below which sinh - sin is a series
_TERMS = 5  # of it; what is left out is below 1e-18 of the first


@dataclass(frozen=True)
class Wave:
    """A phase v, and functions of it that keep their digits at any v.

    ``phase``: v; ``sine``, ``cosine``: of v; ``fade``: ``exp(-v)``; ``odd``, ``even``: ``2 exp(-v)
    sinh v`` and ``2 exp(-v) cosh v``; ``excess``, ``spread``: ``2 exp(-v) (sinh v - sin v)`` and
    ``2 exp(-v) (cosh v - cos v)``.
    """

    phase: sp.Symbol
    sine: sp.Symbol
    cosine: sp.Symbol
    fade: sp.Symbol
    odd: sp.Symbol
    even: sp.Symbol
    excess: sp.Symbol
    spread: sp.Symbol

    @classmethod
    def of(cls, name: str) -> Wave:
        """Return the wave of a phase, its quantities named after it."""
        words = ("sine", "cosine", "fade", "odd", "even", "excess", "spread")
        symbols = (sp.Symbol(f"{name}_{word}", real=True) for word in words)
        return cls(sp.Symbol(name, positive=True), *symbols)

    def steps(self, value: sp.Expr) -> tuple[Step, ...]:
        """Return the definitions of all quantities at the phase ``value``."""
        v = self.phase
        square, fourth = (sp.Symbol(f"{v.name}_{word}", real=True) for word in ("square", "fourth"))
        # Terms of every fourth power, all positive: nested, from the last one on.
        series = sp.Poly(taylor(sp.sinh(v) - sp.sin(v), v, _TERMS).value, v)
        nested = sp.S.Zero
        for _, coefficient in series.terms():
            nested = coefficient + fourth * nested
        direct = self.odd - 2 * self.fade * self.sine
        small = 2 * self.fade * v * square * nested
        return (
            (v, value),
            (square, v**2),
            (fourth, square**2),
            (self.sine, sp.sin(v)),
            (self.cosine, sp.cos(v)),
            (self.fade, sp.exp(-v)),
            (self.odd, -expm1(-2 * v)),
            (self.even, 1 + self.fade**2),
            (self.excess, sp.Piecewise((direct, v > SWITCH), (small, True))),
            (self.spread, expm1(-v) ** 2 + 4 * self.fade * sp.sin(v / 2) ** 2),
        )

    def circular(self, expression: sp.Expr) -> sp.Expr:
        """Put symbols in the place of sin v and cos v."""
        v = self.phase
        return expression.xreplace({sp.sin(v): self.sine, sp.cos(v): self.cosine})

    def by_excess(self, expression: sp.Expr) -> sp.Expr:
        """Write sinh v and cosh v by how far they exceed sin v and cos v."""
        values = {
            sp.sinh(self.phase): self.excess / (2 * self.fade) + self.sine,
            sp.cosh(self.phase): self.spread / (2 * self.fade) + self.cosine,
        }
        return self.circular(expression.xreplace(values))

    def by_size(self, expression: sp.Expr) -> sp.Expr:
        """Write sinh v and cosh v by their scaled values."""
        values = {
            sp.sinh(self.phase): self.odd / (2 * self.fade),
            sp.cosh(self.phase): self.even / (2 * self.fade),
        }
        return self.circular(expression.xreplace(values))

    def reduced(self, expression: sp.Expr) -> sp.Expr:
        """Return a polynomial in sin v, cos v, sinh v and cosh v in its simplest form."""
        v = self.phase
        found = sp.expand(expression)
        for square, other, sign in ((sp.cos(v), sp.sin(v), -1), (sp.cosh(v), sp.sinh(v), 1)):
            found = without_square(found, square, 1 + sign * other**2)
        return found

    def elementary(self, expression: sp.Expr) -> sp.Expr:
        """Write everything by sine, cosine and ``exp(-v)``, for comparison."""
        f, s, c = self.fade, self.sine, self.cosine
        v = self.phase
        values = {
            sp.sinh(v): (1 / f - f) / 2,
            sp.cosh(v): (1 / f + f) / 2,
            self.odd: 1 - f**2,
            self.even: 1 + f**2,
            self.excess: 1 - f**2 - 2 * f * s,
            self.spread: 1 + f**2 - 2 * f * c,
        }
        return self.circular(expression.xreplace(values))


# Of a point between pin and support (beta eta) and of the support there (beta xi); of a point
# beyond (beta (1 - eta)) and of the support there (beta (1 - xi)).
RUN, SPAN, REST, HANG = (Wave.of(name) for name in ("run", "span", "rest", "hang"))
# From the support to a point beyond, not above SWITCH.
CLOSE = Wave.of("close")
# exp(-v) from the point to the support, on either side.
RISE = sp.Symbol("rise", real=True)
SINK = sp.Symbol("sink", real=True)


def proven(form: sp.Expr, original: sp.Expr) -> sp.Expr:
    """Return a form of an expression, having shown that it is equal."""
    difference = form - original
    for wave in (RUN, SPAN, REST, HANG):
        difference = wave.elementary(difference)
    difference = difference.xreplace({SPAN.fade: RISE * RUN.fade, HANG.fade: SINK * REST.fade})
    above = sp.expand(sp.fraction(sp.together(difference))[0])
    for wave in (RUN, SPAN, REST, HANG):
        above = without_square(above, wave.sine, 1 - wave.cosine**2)
    if above != 0:
        raise UnsafeRewriting(f"{form} is not {original}")
    return form


def without_square(expression: sp.Expr, base: sp.Expr, square: sp.Expr) -> sp.Expr:
    """Return an expanded polynomial with the square of ``base`` replaced."""

    def reduced(power: sp.Pow) -> sp.Expr:
        return square ** (power.exp // 2) * base ** (power.exp % 2)

    powers = [p for p in expression.atoms(sp.Pow) if p.base == base and p.exp >= 2]
    return sp.expand(expression.xreplace({p: reduced(p) for p in powers}))
