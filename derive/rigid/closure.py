"""What the closed-form kinematics of all linkages begin with: named symbols, rates of the loop."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Self

import sympy as sp

from ..staged import Steps


@dataclass(frozen=True, kw_only=True)
class SolvedLoop:
    """A solved linkage: its symbols, and the steps that define them.

    ``steps``: definitions, in order; ``half_sine``, ``half_cosine``: of half the crank angle;
    ``sin2``, ``cos2``: of the crank angle.
    """

    steps: Steps
    half_sine: sp.Symbol
    half_cosine: sp.Symbol
    sin2: sp.Symbol
    cos2: sp.Symbol

    @classmethod
    def unsolved(cls, emitted: Mapping[str, str]) -> Self:
        """Return the symbols without steps, each named as its field.

        ``emitted``: other names, for what the emitted function returns.
        """
        names = [item.name for item in fields(cls) if item.name != "steps"]
        made = {name: sp.Symbol(emitted.get(name, name), real=True) for name in names}
        return cls(steps=Steps(), **made)

    @property
    def half_squares(self) -> tuple[sp.Expr, sp.Expr]:
        """``cos^2`` and ``sin^2`` of half the crank angle."""
        return self.half_cosine**2, self.half_sine**2


def closure_rates(
    loop: Iterable[sp.Expr],
    t: sp.Symbol,
    rates: Mapping[sp.Expr, tuple[sp.Expr, sp.Expr]],
    names: Mapping[sp.Expr, sp.Expr],
) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Differentiate the closure of a loop once and twice by the crank angle.

    ``loop``: components of the sum that vanishes, in functions of t; ``t``: stands for the crank
    angle; ``rates``: each function to its first and second derivative; ``names``: what else to
    replace: sines, cosines and places by their symbols.
    """
    first = {function.diff(t): rate for function, (rate, _) in rates.items()}
    second = {function.diff(t, 2): change for function, (_, change) in rates.items()}
    speeds = [part.diff(t).subs(first).subs(names) for part in loop]
    changes = [part.diff(t, 2).subs(second).subs(first).subs(names) for part in loop]
    return speeds, changes
