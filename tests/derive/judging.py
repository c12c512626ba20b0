"""Numeric proof of emitted functions: their error at 80 digits, over the error that inputs justify.

A function evaluated in double precision may be off by the rounding of its result and by what a
rounding of its inputs would do.  The measure of an output f at a point x is

    |error| / (u (|f| + sum_i |x_i df/dx_i|)),    u = 2^-53,

with the exact value and its gradient in many digits at the doubles that were passed in.
"""

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import mpmath
import sympy as sp
from elastolink.derive.staged import Steps

DIGITS = 80
ROUNDOFF = 2.0**-53
ALLOWED = 32.0

Numbers: TypeAlias = Mapping[str, Any]
Reference: TypeAlias = Callable[[Numbers], Numbers]


@dataclass(frozen=True)
class Point:
    """Arguments of an emitted function at which it is judged.

    ``name`` says what is special about it; ``inputs`` are doubles taken as exact; ``fixed`` only
    choose a branch or count something, and so have no error of their own.
    """

    name: str
    inputs: Mapping[str, float]
    fixed: Mapping[str, float] = field(default_factory=dict)

    @property
    def arguments(self) -> dict[str, float]:
        """All arguments by name."""
        return {**self.inputs, **self.fixed}


@dataclass(frozen=True)
class Judgement:
    """Error of one output at one point; ``fair`` is ``|f| + sum_i |x_i df/dx_i|``."""

    output: str
    point: Point
    value: float
    error: float
    fair: float

    @property
    def measure(self) -> float:
        """Error over ``u`` times the fair size; infinite where there is no finite one."""
        if self.error == 0.0:
            return 0.0
        ratio = self.error / (ROUNDOFF * self.fair) if self.fair else math.inf
        return math.inf if math.isnan(ratio) else ratio

    @property
    def passed(self) -> bool:
        """True where the measure is a number within 32."""
        return self.measure <= ALLOWED


def reference_of(
    inputs: Sequence[sp.Symbol], outputs: Sequence[tuple[str, sp.Expr]], steps: Steps | None = None
) -> Reference:
    """Return a function of mpmath numbers by name: expressions before any lowering."""
    chain = [] if steps is None else list(steps.needed(e for _, e in outputs).steps)
    known = list(inputs)
    stages = []
    for symbol, expression in chain:
        stages.append(sp.lambdify(list(known), expression, modules="mpmath"))
        known.append(symbol)
    final = sp.lambdify(known, [sp.sympify(e) for _, e in outputs], modules="mpmath")
    names = [name for name, _ in outputs]

    def evaluate(numbers: Numbers) -> Numbers:
        values = [numbers[symbol.name] for symbol in inputs]
        for stage in stages:
            values.append(stage(*values))
        return dict(zip(names, final(*values), strict=True))

    return evaluate


@dataclass(frozen=True)
class Exact:
    """Exact outputs at one point and their fair sizes, computed when they are looked at."""

    point: Point
    compute: Callable[[], tuple[Numbers, Numbers]]

    @cached_property
    def both(self) -> tuple[Numbers, Numbers]:
        """Exact values and ``|f| + sum_i |x_i df/dx_i|``, by output name."""
        return self.compute()


def exact_at(reference: Reference, point: Point, digits: int = DIGITS) -> Exact:
    """Return the values of a reference and of its gradient at a point.

    The gradient is a forward difference with a relative step of ``10**(-0.4 digits)``.
    """

    def compute() -> tuple[Numbers, Numbers]:
        with mpmath.workdps(digits):
            numbers = {name: mpmath.mpf(value) for name, value in point.arguments.items()}
            values = dict(reference(numbers))
            step = mpmath.mpf(10) ** (-(2 * digits) // 5)
            fair = {name: abs(value) for name, value in values.items()}
            for name in point.inputs:
                if numbers[name] == 0:
                    continue
                moved = reference({**numbers, name: numbers[name] * (1 + step)})
                for key, value in values.items():
                    fair[key] += abs((moved[key] - value) / step)
            return values, fair

    return Exact(point, compute)


def judge(function: Callable[..., Any], names: Sequence[str], exact: Exact) -> list[Judgement]:
    """Compare one call of an emitted function, which returns ``names``, with exact values."""
    taken = inspect.signature(function).parameters
    arguments = {name: value for name, value in exact.point.arguments.items() if name in taken}
    returned = function(**arguments)
    values = returned if isinstance(returned, tuple) else (returned,)
    known, fair = exact.both
    found = []
    with mpmath.workdps(DIGITS):
        for name, value in zip(names, map(float, values), strict=True):
            error = float(abs(mpmath.mpf(value) - known[name]))
            found.append(Judgement(name, exact.point, value, error, float(fair[name])))
    return found


def worst(judgements: Iterable[Judgement]) -> dict[str, Judgement]:
    """Return, for each output, the judgement with the largest measure."""
    found: dict[str, Judgement] = {}
    for judgement in judgements:
        known = found.get(judgement.output)
        if known is None or judgement.measure > known.measure:
            found[judgement.output] = judgement
    return found
