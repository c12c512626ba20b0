"""Closed forms as named steps: how an expression too long for one line stays readable."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import TypeAlias, TypeVar

import sympy as sp

Step: TypeAlias = tuple[sp.Symbol, sp.Expr]
Output = TypeVar("Output")


@dataclass(frozen=True)
class Steps:
    """Named intermediate quantities, each a function of the inputs and of earlier steps.

    Attributes
    ----------
    steps : tuple of (Symbol, Expr)
        In order of dependence.
    """

    steps: tuple[Step, ...] = ()

    def __post_init__(self) -> None:
        """Refuse a name that is defined twice."""
        names = [symbol for symbol, _ in self.steps]
        twice = sorted({str(name) for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"steps defined twice: {twice}")

    def then(self, *more: Step) -> Steps:
        """Return these steps followed by more."""
        return Steps(self.steps + more)

    def needed(self, outputs: Iterable[sp.Expr]) -> Steps:
        """Return only the steps on which ``outputs`` depend."""
        wanted = set().union(*(sp.sympify(output).free_symbols for output in outputs), set())
        kept: list[Step] = []
        for symbol, expression in reversed(self.steps):
            if symbol in wanted:
                kept.append((symbol, expression))
                wanted |= expression.free_symbols
        return Steps(tuple(reversed(kept)))

    def inline(self, expression: sp.Expr) -> sp.Expr:
        """Return ``expression`` in terms of the inputs alone."""
        for symbol, value in reversed(self.steps):
            expression = expression.xreplace({symbol: value})
        return expression

    def mapping(self) -> Mapping[sp.Symbol, sp.Expr]:
        """Return the steps as a mapping in their order."""
        return dict(self.steps)


def vanishing(terms: Mapping[str, Iterable[str]]) -> dict[tuple[str, ...], tuple[str, ...]]:
    """Return what vanishes where some of the terms are dropped, by each choice of them.

    ``terms``: term to the names of arguments, numbers or multipliers that vanish without it.
    """
    return {
        chosen: tuple(name for term in chosen for name in terms[term])
        for count in range(1, len(terms) + 1)
        for chosen in combinations(sorted(terms), count)
    }


def chosen_outputs(
    outputs: Sequence[tuple[str, Output]], names: Iterable[str]
) -> tuple[tuple[str, Output], ...]:
    """Return those outputs that are named, in their own order.

    Raises ``ValueError`` if one is not there.
    """
    chosen, known = set(names), [name for name, _ in outputs]
    unknown = sorted(chosen - set(known))
    if unknown:
        raise ValueError(f"unknown outputs {unknown}; expected some of {known}")
    return tuple(item for item in outputs if item[0] in chosen)


@dataclass(frozen=True)
class ClosedForm:
    """Outputs as functions of inputs through named steps.

    Attributes
    ----------
    inputs : tuple of Symbol
        Arguments, in order; the first one is the array that sets the namespace.
    steps : Steps
        Intermediate quantities.
    outputs : tuple of (str, Expr)
        What is returned, by name.
    """

    inputs: tuple[sp.Symbol, ...]
    steps: Steps
    outputs: tuple[tuple[str, sp.Expr], ...]

    def only(self, names: Iterable[str]) -> ClosedForm:
        """Return the closed form with some of its outputs, and no step that they do not need.

        Raises ``ValueError`` if one is not there.
        """
        outputs = chosen_outputs(self.outputs, names)
        steps = self.steps.needed(expression for _, expression in outputs)
        return ClosedForm(self.inputs, steps, outputs)


@dataclass(frozen=True)
class KernelForm:
    """One function of a module of several: its name, first line, and closed form."""

    name: str
    summary: str
    form: ClosedForm


@dataclass(frozen=True)
class KernelForms:
    """Several functions of one module, each with the steps that it needs.

    Attributes
    ----------
    kernels : tuple of KernelForm
        In order.
    dropped : mapping
        Terms that a caller may leave out, to the arguments that then vanish.
    """

    kernels: tuple[KernelForm, ...]
    dropped: Mapping[tuple[str, ...], tuple[str, ...]] = field(default_factory=dict)

    def only(self, names: Iterable[str]) -> KernelForms:
        """Return some of the functions.

        Raises ``ValueError`` if one is not there.
        """
        known = [(kernel.name, kernel) for kernel in self.kernels]
        return replace(self, kernels=tuple(k for _, k in chosen_outputs(known, names)))
