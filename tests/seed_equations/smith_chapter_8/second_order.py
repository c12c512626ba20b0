"""The second-order formulas of a general region as sums over harmonics, derived by machine.

Smith (7.26)-(7.37): product of f with y_0, collection by frequency, division, product with f again.
The harmonics of f that can meet are found by their frequencies; the coefficients come from SymPy's
product-to-sum rule.  From these sums follow ``w0`` and ``W`` of the closed form

    lam2 = n^2/4 - a_0 mu + w0 mu^2 +- |c_n mu - W mu^2|,   c_n = (a_n - i b_n)/2,

which holds through the tip of the tongue and to second order everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import sympy as sp
from sympy.simplify.fu import TR8

from .strained import Expansion, Matrix2
from .surd import ExactHarmonics, Surd

n, m = sp.symbols("n m", integer=True, positive=True)
A0, B0 = sp.symbols("A_0 B_0", real=True)
a, b = sp.IndexedBase("a", real=True), sp.IndexedBase("b", real=True)
_theta, _p, _q = sp.symbols("theta p q", positive=True)
_Two = tuple[sp.Expr, sp.Expr]
_Three = tuple[sp.Expr, sp.Expr, sp.Expr]


def _products(wave: _Two, harmonic: _Two) -> tuple[_Two, _Two]:
    """Return the (cos, sin) coefficients at p + q and at p - q of a product at p and q."""
    (A, B), (am, bm) = wave, harmonic
    first = A * sp.cos(_p * _theta) + B * sp.sin(_p * _theta)
    second = am * sp.cos(_q * _theta) + bm * sp.sin(_q * _theta)
    both = sp.expand(TR8(sp.expand(first * second)))
    both = sp.expand(both.replace(lambda e: isinstance(e, sp.sin | sp.cos), _ordered))
    parts = []
    for frequency in (_p + _q, _p - _q):
        angle = sp.expand(frequency * _theta)
        parts.append((both.coeff(sp.cos(angle)), both.coeff(sp.sin(angle))))
    return parts[0], parts[1]


def _ordered(wave: sp.Expr) -> sp.Expr:
    """Write the angle with a positive p, so that each frequency has one form."""
    angle = sp.expand(wave.args[0])
    if angle.coeff(_p * _theta) < 0 or (_p not in angle.free_symbols):
        angle = -angle
        return -wave.func(angle) if isinstance(wave, sp.sin) else wave.func(angle)
    return wave.func(angle)


def _mirrored(pair: _Two) -> _Two:
    """Return the coefficients at the frequency of the other sign."""
    return pair[0], -pair[1]


def _scaled(pair: _Two, factor: sp.Expr) -> _Two:
    return pair[0] * factor, pair[1] * factor


def _sum(one: _Two, other: _Two) -> _Two:
    return sp.expand(one[0] + other[0]), sp.expand(one[1] + other[1])


@dataclass(frozen=True)
class SecondOrderSums:
    """Summands of the second order for a general region n.

    Attributes
    ----------
    P, Q, R, S, T : Expr
        Smith's (7.28), linear in A_0 and B_0: cosine and sine coefficients of ``-2 f y_0`` at
        m + n/2 (P, Q), at n/2 - m (R and -S), and the constant (T, even n only).
    above, below, middle : Matrix
        What second order returns to the resonant harmonic per unit (A_0, B_0): a term of the sum
        over m >= 1, a term of that over 1 <= m <= (n - 1)/2, and the term of even n.
    """

    P: sp.Expr
    Q: sp.Expr
    R: sp.Expr
    S: sp.Expr
    T: sp.Expr
    above: sp.ImmutableDenseMatrix
    below: sp.ImmutableDenseMatrix
    middle: sp.ImmutableDenseMatrix

    def summands(self) -> tuple[_Three, _Three, _Three]:
        """Return (w0, Re W, Im W) of the three ranges: above, below, middle."""
        above, below, middle = (
            _centre_and_coupling(x) for x in (self.above, self.below, self.middle)
        )
        return above, below, middle

    def formulas(self) -> _Three:
        """Return w0, Re W and Im W as SymPy sums; a term of even n stands as a ``Piecewise``."""
        above, below, middle = self.summands()
        last = sp.floor((n - 1) / 2)
        centre, real, imaginary = (
            sp.Sum(x, (m, 1, sp.oo))
            + sp.Sum(y, (m, 1, last))
            + sp.Piecewise((z, sp.Eq(sp.Mod(n, 2), 0)), (0, True))
            for x, y, z in zip(above, below, middle, strict=True)
        )
        return centre, real, imaginary

    def value(self, f: ExactHarmonics, region: int) -> tuple[Fraction, Fraction, Fraction]:
        """Return (w0, Re W, Im W) of a function, in exact rational numbers."""
        above, below, middle = self.summands()
        result = [Fraction(0)] * 3
        count = len(f.cosine)
        places = [(above, k) for k in range(1, count + 1)]
        places += [(below, k) for k in range(1, (region - 1) // 2 + 1)]
        places += [(middle, region // 2)] if region % 2 == 0 else []
        for terms, k in places:
            table = _numbers(f, region, k)
            for i, term in enumerate(terms):
                result[i] += _rational(term, table)
        return result[0], result[1], result[2]


def _numbers(f: ExactHarmonics, region: int, k: int) -> Mapping[sp.Expr, sp.Expr]:
    table: dict[sp.Expr, sp.Expr] = {}
    for index, number in ((m, k), (m + n, k + region), (n - m, region - k), (n / 2, region // 2)):
        cosine, sine = f.harmonic(number) if number > 0 else (Fraction(0), Fraction(0))
        table[a[index]], table[b[index]] = sp.Rational(cosine), sp.Rational(sine)
    return {**table, m: sp.Integer(k), n: sp.Integer(region)}


def _rational(term: sp.Expr, table: Mapping[sp.Expr, sp.Expr]) -> Fraction:
    indexed = {k: v for k, v in table.items() if isinstance(k, sp.Indexed)}
    plain = {k: v for k, v in table.items() if not isinstance(k, sp.Indexed)}
    number = sp.Rational(term.xreplace(indexed).xreplace(plain))
    return Fraction(int(number.p), int(number.q))


def _centre_and_coupling(matrix: sp.ImmutableDenseMatrix) -> _Three:
    """Split minus a symmetric matrix into w0, Re W, Im W as the first order has -a_0 and -c_n."""
    centre = -(matrix[0, 0] + matrix[1, 1]) / 2
    real = -(matrix[0, 0] - matrix[1, 1]) / 2
    first, second, third = (sp.factor(sp.expand(x)) for x in (centre, real, matrix[0, 1]))
    return first, second, third


@cache
def second_order_sums() -> SecondOrderSums:
    """Derive the second order of a general region (Smith 7.26-7.32).

    Returns
    -------
    SecondOrderSums
        Printed notation, and the matrices of the second-order conditions.
    """
    y0 = (A0, B0)

    def harmonic(k: sp.Expr) -> _Two:
        return a[k], b[k]

    # f y_0 at m + n/2: harmonic m adds its frequency, harmonic m + n subtracts; at n/2 - m:
    # harmonics m and n - m subtract, and the latter arrives mirrored; at zero: harmonic n/2.
    up = _sum(_products(y0, harmonic(m))[0], _mirrored(_products(y0, harmonic(m + n))[1]))
    down = _sum(_products(y0, harmonic(m))[1], _mirrored(_products(y0, harmonic(n - m))[1]))
    zero = _products(y0, harmonic(n / 2))[1][0]
    # y_1 by (7.30): minus the product, over (n/2)^2 less the square of its frequency.
    half = sp.Rational(1, 2) * n
    y_up = _scaled(up, -1 / (half**2 - (m + half) ** 2))
    y_down = _scaled(down, -1 / (half**2 - (half - m) ** 2))
    y_zero = -zero / half**2
    # f y_1 at n/2 again.
    above = _sum(_products(y_up, harmonic(m))[1], _mirrored(_products(y_up, harmonic(m + n))[1]))
    below = _sum(
        _products(y_down, harmonic(m))[0], _mirrored(_products(y_down, harmonic(n - m))[1])
    )
    middle = (y_zero * a[n / 2], y_zero * b[n / 2])

    def matrix(pair: _Two) -> sp.ImmutableDenseMatrix:
        rows = [[sp.factor(sp.expand(x).coeff(v)) for v in y0] for x in pair]
        return sp.ImmutableDenseMatrix(rows)

    return SecondOrderSums(
        P=2 * up[0],
        Q=2 * up[1],
        R=2 * down[0],
        S=-2 * down[1],
        T=2 * zero,
        above=matrix(above),
        below=matrix(below),
        middle=matrix(middle),
    )


def second_order_matrix(f: ExactHarmonics, region: int) -> Matrix2:
    """Return the second-order secular matrix of a function by strained parameters (7.31)-(7.32)."""
    expansion = Expansion(f, region, ())
    expansion.next_secular()
    expansion.advance(Surd(Fraction(0)))
    return expansion.next_secular()


def centre_and_coupling(
    f: ExactHarmonics, region: int
) -> tuple[Fraction, tuple[Fraction, Fraction]]:
    """Return w0 and (Re W, Im W) of a function, exactly, from the strained route.

    Parameters
    ----------
    f : ExactHarmonics
        Periodic function.
    region : int
        n >= 1.
    """
    (s11, s12), (_, s22) = second_order_matrix(f, region)
    centre, real = -(s11 + s22) / 2, -(s11 - s22) / 2
    return centre.rational, (real.rational, s12.rational)
