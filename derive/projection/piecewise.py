"""Hill's equation with a piecewise constant coefficient: Meissner's half traces J_N by machine.

On an interval of length t where y'' + q y = 0 has constant q = v^2, (y, y') is carried over by

    C + s N,    N = [[0, 1], [-q, 0]],    C = cos v t,  s = sin(v t) / v,

both real for either sign of q.  The half trace of the product over all intervals is a sum of words,
one for every even choice of intervals that give their sine.  The matrices N are vectors of a
Clifford algebra, N_i N_j + N_j N_i = -(q_i + q_j), so that the half trace of a word is the Pfaffian
of those of its pairs: minus Aannaque's V_ik for two sines, V_ij V_kl - V_ik V_jl + V_il V_jk for
four, and so on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import sympy as sp

from ..safe import UnsafeRewriting

MOST_WORDS = 12


def cosine(i: int) -> sp.Symbol:
    """Return the symbol of C_i (intervals count from 1)."""
    return sp.Symbol(f"c{i}", real=True)


def sine(i: int) -> sp.Symbol:
    """Return the symbol of ``s_i = S_i / v_i``."""
    return sp.Symbol(f"s{i}", real=True)


def level(i: int) -> sp.Symbol:
    """Return the symbol of ``q_i = v_i^2``."""
    return sp.Symbol(f"q{i}", real=True)


@dataclass(frozen=True)
class Parts:
    """A matrix ``[[h + d, upper], [lower, h - d]]`` by its four parts.

    Attributes
    ----------
    half_trace, half_difference : Expr
        h and d: half the sum and half the difference of the diagonal.
    upper, lower : Expr
        The entries off the diagonal.
    """

    half_trace: sp.Expr
    half_difference: sp.Expr
    upper: sp.Expr
    lower: sp.Expr

    @classmethod
    def of(cls, matrix: sp.Matrix) -> Parts:
        """Take a matrix apart."""
        a, b, c, d = (sp.expand(entry) for entry in matrix)
        return cls(sp.expand((a + d) / 2), sp.expand((a - d) / 2), b, c)

    def matrix(self) -> sp.Matrix:
        """Put the matrix together."""
        h, d = self.half_trace, self.half_difference
        return sp.Matrix([[h + d, self.upper], [self.lower, h - d]])

    def named(self) -> tuple[tuple[str, sp.Expr], ...]:
        """Return the parts with their names."""
        return tuple((name, getattr(self, name)) for name in self.__dataclass_fields__)


def propagator(i: int) -> sp.Matrix:
    """Return the matrix of interval i: what (y, y') at its start becomes at its end."""
    return sp.Matrix([[cosine(i), sine(i)], [-level(i) * sine(i), cosine(i)]])


@lru_cache(maxsize=16)
def monodromy(count: int) -> Parts:
    """Multiply the matrices of ``count`` intervals out, the first one acting first."""
    product = sp.eye(2)
    for i in range(1, count + 1):
        product = (propagator(i) * product).expand()
    return Parts.of(product)


def one_more(before: Parts, i: int) -> Parts:
    """Return what a further interval makes of a matrix: the recursion for any number of them."""
    return Parts.of(propagator(i) * before.matrix())


def halves() -> sp.Matrix:
    """Return the matrix over half of a turn that starts in the middle of interval 1 of two.

    The coefficient is even about the middle of either interval, and its half trace factors: with
    ``[[y1, y2], [y1', y2']]`` over the half turn, ``J_2 = 1 + 2 y1' y2 = 2 y1 y2' - 1``.

    Raises
    ------
    UnsafeRewriting
        If it does not.
    """
    half = (propagator(2) * propagator(1)).expand()
    double: dict[sp.Symbol, sp.Expr] = {}
    for i in (1, 2):
        double |= {cosine(i): 1 - 2 * level(i) * sine(i) ** 2, sine(i): 2 * sine(i) * cosine(i)}
    whole = monodromy(2).half_trace.xreplace(double)
    first, second = 1 + 2 * half[1, 0] * half[0, 1], 2 * half[0, 0] * half[1, 1] - 1
    circle = {cosine(i) ** 2: 1 - level(i) * sine(i) ** 2 for i in (1, 2)}
    for form in (first, second):
        rest = sp.expand(whole - form).subs(circle)
        if sp.expand(rest) != 0:
            raise UnsafeRewriting(f"{form} is not {whole}")
    return half


# ---------------------------------------------------------------- Meissner's words


@dataclass(frozen=True)
class Word:
    """One term of J_N: the intervals that give a sine, and the factor before them.

    Attributes
    ----------
    sines : tuple of int
        Their numbers, rising, an even number of them; all others give a cosine.
    coefficient : Expr
        With its sign, in the symbols of :func:`ratio`.
    """

    sines: tuple[int, ...]
    coefficient: sp.Expr


def ratio(i: int, k: int) -> sp.Symbol:
    """Return the symbol of ``V_ik = (v_i / v_k + v_k / v_i) / 2``."""
    return sp.Symbol(f"V{i}{k}" if max(i, k) < 10 else f"V{i}_{k}", real=True)


def speed(i: int) -> sp.Symbol:
    """Return the symbol of v_i."""
    return sp.Symbol(f"v{i}", positive=True)


def in_speeds(expression: sp.Expr, count: int) -> sp.Expr:
    """Put ``(v_i / v_k + v_k / v_i) / 2`` for every V_ik."""
    pairs = combinations(range(1, count + 1), 2)
    return expression.xreplace(
        {ratio(i, k): (speed(i) / speed(k) + speed(k) / speed(i)) / 2 for i, k in pairs}
    )


def pfaffian(numbers: Sequence[int]) -> sp.Expr:
    """Return the Pfaffian of V_ik over some intervals, 1 for none."""
    if not numbers:
        return sp.Integer(1)
    first, rest = numbers[0], numbers[1:]
    terms = (
        (-1) ** j * ratio(first, k) * pfaffian([*rest[:j], *rest[j + 1 :]])
        for j, k in enumerate(rest)
    )
    return sp.expand(sp.Add(*terms))


def words(count: int) -> Iterator[Word]:
    """Yield the words of J_N, N = ``count``: those with few sines first.

    Raises
    ------
    ValueError
        If there are fewer than one or more than 12 intervals (2048 words).
    """
    if not 1 <= count <= MOST_WORDS:
        raise ValueError(f"found {count} intervals; expected 1 to {MOST_WORDS}")
    for size in range(0, count + 1, 2):
        sign = (-1) ** (size // 2)
        for chosen in combinations(range(1, count + 1), size):
            yield Word(chosen, sign * pfaffian(chosen))


def half_trace(count: int) -> sp.Expr:
    """Return J_N in C_i, S_i, V_ik, proved against the product of the matrices.

    Raises
    ------
    UnsafeRewriting
        If the words are not the half trace.
    """
    trace = monodromy(count).half_trace
    numbers = range(1, count + 1)
    generators = [sine(i) for i in numbers]
    products = sp.Poly(trace, *generators, *(cosine(i) for i in numbers)).as_dict()
    total = []
    for word in words(count):
        powers = tuple(int(i in word.sines) for i in numbers)
        found = products.pop((*powers, *(1 - p for p in powers)))
        # s_i = S_i / v_i
        scale = sp.Mul(*(1 / speed(i) for i in word.sines))
        printed = found.xreplace({level(i): speed(i) ** 2 for i in numbers}) * scale
        if sp.expand(printed - in_speeds(word.coefficient, count)) != 0:
            raise UnsafeRewriting(f"{word.coefficient} is not {printed}")
        letters = [big_sine(i) if i in word.sines else big_cosine(i) for i in numbers]
        total.append(word.coefficient * sp.Mul(*letters))
    if products:
        raise UnsafeRewriting(f"terms {list(products)} belong to no word")
    return sp.Add(*total)


def big_cosine(i: int) -> sp.Symbol:
    """Return the symbol of Meissner's C_i."""
    return sp.Symbol(f"C{i}", real=True)


def big_sine(i: int) -> sp.Symbol:
    """Return the symbol of Meissner's S_i."""
    return sp.Symbol(f"S{i}", real=True)


def latex_words(count: int) -> str:
    """Return J_N as LaTeX, a word to each term, in the order of the words."""
    terms = []
    for word in words(count):
        factor = sp.expand(word.coefficient)
        negative = not isinstance(factor, sp.Add) and factor.could_extract_minus_sign()
        shown = -factor if negative else factor
        if word.sines and len(word.sines) > 2:
            # Its sign stays inside: a Pfaffian has terms of either.
            text = rf"\left({_latex(shown)}\right)"
        else:
            text = "" if shown == 1 else _latex(shown)
        letters = [f"S_{{{i}}}" for i in word.sines]
        letters += [f"C_{{{i}}}" for i in range(1, count + 1) if i not in word.sines]
        sign = "-" if negative else "+"
        terms.append((sign, " ".join([text, *letters]).strip()))
    (_, first), *rest = terms
    return f"J_{{{count}}} = {first}" + "".join(f" {sign} {text}" for sign, text in rest)


def _latex(expression: sp.Expr) -> str:
    names = {
        symbol: rf"V_{{{symbol.name[1:].replace('_', ',')}}}" for symbol in expression.free_symbols
    }
    return str(sp.latex(expression, symbol_names=names, order="lex"))
