"""Meissner's equation as emitted closed forms: J_2, J_3, J_4 and the recursion for any J_N.

On an interval of length t where y'' + q y = 0 has constant q = v^2, (y, y') is carried over by

    C + s N,    N = [[0, 1], [-q, 0]],    C = cos v t,  s = sin(v t) / v,

both real for either sign of q: cosine and cosh are the two branches of one entire function of q,
and so are sin(v t) / v and sinh; only these are ever formed.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..safe import UnsafeRewriting
from ..spec import ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms, Steps

_SHAPE = "ndarray, shape (...)"
_COUNTS = {2: "two_intervals", 3: "three_intervals", 4: "four_intervals"}


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

    ``half_trace``, ``half_difference``: h and d: half the sum and half the difference of the
    diagonal; ``upper``, ``lower``: the entries off the diagonal.
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


def monodromy(count: int) -> Parts:
    """Multiply the matrices of ``count`` intervals out, the first one acting first."""
    product = sp.eye(2)
    for i in range(1, count + 1):
        product = (propagator(i) * product).expand()
    return Parts.of(product)


def one_more(before: Parts, i: int) -> Parts:
    """Return what a further interval makes of a matrix: the recursion for any number of them."""
    return Parts.of(propagator(i) * before.matrix())


def half_turn_matrix() -> sp.Matrix:
    """Return the matrix over half of a turn that starts in the middle of interval 1 of two.

    The coefficient is even about the middle of either interval, and its half trace factors: with
    ``[[y1, y2], [y1', y2']]`` over the half turn, ``J_2 = 1 + 2 y1' y2 = 2 y1 y2' - 1``.
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


_BEFORE = Parts(
    *sp.symbols("half_trace_before half_difference_before upper_before lower_before", real=True)
)


def _interval() -> KernelForm:
    """Return cosine and sine over root of one interval.

    One of ``turn`` and ``rise`` is zero, and with it one factor of each product is 1.
    """
    level, length = sp.symbols("level length", real=True)
    turn, rise, no_turn, no_rise = sp.symbols("turn rise no_turn no_rise", real=True)
    steps = Steps(
        (
            (turn, length * sp.sqrt((sp.Abs(level) + level) / 2)),
            (rise, length * sp.sqrt((sp.Abs(level) - level) / 2)),
            # Where an angle is zero its sine over itself is 1.
            (no_turn, sp.Piecewise((1, sp.Eq(turn, 0)), (0, True))),
            (no_rise, sp.Piecewise((1, sp.Eq(rise, 0)), (0, True))),
        )
    )
    across = (sp.sin(turn) / (turn + no_turn) + no_turn) * (
        sp.sinh(rise) / (rise + no_rise) + no_rise
    )
    outputs = (("cosine", sp.cos(turn) * sp.cosh(rise)), ("sine", length * across))
    return KernelForm(
        "interval",
        "Return cos v t and sin(v t) / v of an interval of length t with level v^2",
        ClosedForm((level, length), steps, outputs),
    )


def _symbols(count: int) -> tuple[sp.Symbol, ...]:
    """Return the arguments of a closed form of several intervals, interval by interval."""
    kinds = (cosine, sine, level)
    return tuple(kind(i) for i in range(1, count + 1) for kind in kinds)


def _closed(count: int) -> KernelForm:
    """Return the parts of the matrix over ``count`` intervals; the half trace is J_N."""
    parts = monodromy(count)
    outputs = tuple((name, _tidy(value, count)) for name, value in parts.named())
    return KernelForm(
        _COUNTS[count],
        f"Return J_{count} and the other parts of the matrix over {count} intervals",
        ClosedForm(_symbols(count), Steps(), outputs),
    )


def _tidy(expression: sp.Expr, count: int) -> sp.Expr:
    """Collect the words of a polynomial: one factor before each product of C and s."""
    letters = [kind(i) for i in range(1, count + 1) for kind in (cosine, sine)]
    found = sp.Poly(expression, *letters)
    return sp.Add(
        *(
            sp.factor_terms(factor) * sp.Mul(*(x**p for x, p in zip(letters, powers, strict=True)))
            for powers, factor in found.terms()
        )
    )


def _recursion() -> KernelForm:
    parts = one_more(_BEFORE, 1)
    names = {_BEFORE.half_trace, _BEFORE.half_difference, _BEFORE.upper, _BEFORE.lower}
    outputs = tuple(
        (name, sp.collect(sp.expand(value), sorted(names, key=str)))
        for name, value in parts.named()
    )
    before = tuple(value for _, value in _BEFORE.named())
    return KernelForm(
        "one_more_interval",
        "Return the parts of a matrix after one more interval",
        ClosedForm((*before, *_symbols(1)), Steps(), outputs),
    )


def _halves() -> KernelForm:
    half = half_turn_matrix()
    names = ("y1", "y2", "y1_slope", "y2_slope")
    return KernelForm(
        "half_turn",
        "Return the normalised solutions half a turn from the middle of the first of two intervals",
        ClosedForm(_symbols(2), Steps(), tuple(zip(names, half, strict=True))),
    )


def _forms(spec: ModelSpec) -> KernelForms:
    closed = tuple(_closed(count) for count in _COUNTS)
    return KernelForms((_interval(), *closed, _recursion(), _halves()))


def _arguments() -> tuple[Argument, ...]:
    found = [
        Argument("level", _SHAPE, "", "Coefficient q = v^2 of y, of either sign"),
        Argument("length", _SHAPE, "rad", "Length t of the interval"),
    ]
    for i in range(1, 5):
        found += [
            Argument(f"c{i}", _SHAPE, "", f"cos v t of interval {i}"),
            Argument(f"s{i}", _SHAPE, "", f"sin(v t) / v of interval {i}"),
            Argument(f"q{i}", _SHAPE, "", f"Level v^2 of interval {i}"),
        ]
    for name, result in _PARTS.items():
        meaning = result.meaning[0].lower() + result.meaning[1:]
        found.append(Argument(f"{name}_before", _SHAPE, "", f"Before it, {meaning}"))
    return tuple(found)


def _result(name: str, meaning: str) -> Result:
    return Result(name, _SHAPE, "", meaning)


_PARTS = {
    name: _result(name, meaning)
    for name, meaning in (
        ("half_trace", "Half the sum of the diagonal: J of Meissner"),
        ("half_difference", "Half the difference of the diagonal, first entry less second"),
        ("upper", "Entry above the diagonal: y from y'"),
        ("lower", "Entry below the diagonal: y' from y"),
    )
}
_OTHERS = (
    _result("cosine", "cos v t, the hyperbolic one where the level is negative"),
    _result("sine", "sin(v t) / v, likewise; t where the level is zero"),
    _result("y1", "The solution that starts as (1, 0)"),
    _result("y2", "The solution that starts as (0, 1)"),
    _result("y1_slope", "Slope of y1"),
    _result("y2_slope", "Slope of y2"),
)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Meissner's equation: Hill's equation with a piecewise constant coefficient",
        references=("Aannaque (7.9)", "Aannaque (7.11)"),
        arguments=_arguments(),
        results={**_PARTS, **{result.name: result for result in _OTHERS}},
        notes=(
            "The matrix that carries (y, y') over all intervals has the determinant 1; so "
            "J^2 - 1 = half_difference^2 + upper lower, which keeps its digits where J is near 1 "
            "or -1.",
            "Of two intervals, over half a turn from the middle of the first to the middle of the "
            "second: J_2 - 1 = 2 y1' y2 and J_2 + 1 = 2 y1 y2'.",
        ),
    )


MODEL = Model(
    mechanism="hill",
    formulations=("meissner",),
    energies=_forms,
    describe=_describe,
)
