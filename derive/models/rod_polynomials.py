"""Piecewise polynomial shapes of a rod held at a moving block, as emitted closed forms.

The polynomials that multiply the end conditions are open functions: their values and derivatives
are arguments, so that the functions serve any number of modes.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ..external import external_values
from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..spec import ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms, Steps

_SHAPE = "ndarray, shape (...)"
_NAMES = ("value", "slope", "curvature", "shear", "drift", "drift_curvature")

eta, gap, xi, s, length = sp.symbols("eta gap xi s length", real=True)
_P, _J = sp.Function("p"), sp.Function("j")
_Rate = Callable[[sp.Expr], sp.Expr]


def _six(shape: sp.Expr, along: _Rate, across: _Rate) -> tuple[tuple[str, sp.Expr], ...]:
    """Return a shape with its derivatives along the rod and by the block's place.

    ``shape``: with one open function; ``along``, ``across``: derivative by eta at fixed xi, and by
    xi at fixed eta.
    """
    slopes = [shape]
    for _ in range(3):
        slopes.append(sp.expand(along(slopes[-1])))
    drift = sp.expand(across(shape))
    return tuple(zip(_NAMES, (*slopes, drift, sp.expand(along(along(drift)))), strict=True))


def _kernel(
    name: str, summary: str, inputs: tuple[sp.Symbol, ...], outputs: tuple[tuple[str, sp.Expr], ...]
) -> KernelForm:
    """Return a function whose further arguments are the open function and its derivatives."""
    external = external_values([value for _, value in outputs])
    symbols = external.symbols
    ours = tuple((key, _collected(external.plain(value), symbols)) for key, value in outputs)
    return KernelForm(name, summary, ClosedForm((*inputs, *symbols), Steps(), ours))


def _collected(expression: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> sp.Expr:
    """Return one factored coefficient before each value of the open function."""
    collected = sp.collect(sp.expand(expression), symbols, evaluate=False)
    return sp.Add(*(sp.factor(factor) * symbol for symbol, factor in collected.items()))


def _through_the_block() -> tuple[KernelForm, KernelForm]:
    """Return Beale & Scott's modes: one polynomial p(eta) on both sides.

    ``gap = eta - xi`` moves with eta, and against xi.
    """

    def along(e: sp.Expr) -> sp.Expr:
        return sp.diff(e, eta) + sp.diff(e, gap)

    def across(e: sp.Expr) -> sp.Expr:
        return sp.diff(e, xi) - sp.diff(e, gap)

    found = []
    for side, where, factor in (("bay", "between pin and block", eta), ("tail", "beyond", xi)):
        outputs = _six(factor * _P(eta) * gap, along, across)
        summary = f"Return modes {factor} (eta - xi) p(eta) {where}, and their derivatives"
        inputs = (eta, gap) if side == "bay" else (eta, gap, xi)
        found.append(_kernel(f"through_{side}", summary, inputs[-2:], outputs))
    return found[0], found[1]


def _one_side(name: str, factor: sp.Expr, side: str) -> KernelForm:
    """Return shapes of one side, over its length, in the local coordinate s.

    In the bay the length is xi and s = eta/xi; in the tail they are 1 - xi and (eta - xi)/(1 - xi).
    """
    grows, moves = (1, -s) if side == "bay" else (-1, s - 1)

    def along(e: sp.Expr) -> sp.Expr:
        return sp.diff(e, s) / length

    def across(e: sp.Expr) -> sp.Expr:
        return grows * sp.diff(e, length) + moves * sp.diff(e, s) / length

    outputs = _six(length * factor * _J(s), along, across)
    summary = f"Return shapes length {factor} j(s) of the {side}, and their derivatives"
    return _kernel(name, summary, (s, length), outputs)


def _forms(spec: ModelSpec) -> KernelForms:
    bay, tail = _through_the_block()
    return KernelForms(
        (
            bay,
            tail,
            _one_side("turn_bay", s * (s - 1), "bay"),
            _one_side("turn_tail", s, "tail"),
            _one_side("bubble_bay", s * (1 - s) ** 2, "bay"),
            _one_side("bubble_tail", s**2, "tail"),
        )
    )


def _arguments() -> tuple[Argument, ...]:
    found = [
        Argument("eta", _SHAPE, "", "Place on the rod over its length, from the pin"),
        Argument("gap", _SHAPE, "", "eta - xi, without cancellation"),
        Argument("xi", _SHAPE, "", "The block's place over the rod's length"),
        Argument("s", _SHAPE, "", "Local coordinate of the side, 0 to 1 away from the pin"),
        Argument("length", _SHAPE, "", "Length of the side over the rod's"),
    ]
    for name, variable in (("p", "eta"), ("j", "s")):
        found.append(Argument(name, _SHAPE, "", f"Polynomial in {variable}"))
        found += [
            Argument(f"{name}_d{k}", _SHAPE, "", f"Derivative {k} of {name} by {variable}")
            for k in (1, 2, 3)
        ]
    return tuple(found)


_MEANINGS = (
    "Shape e",
    "First derivative by eta",
    "Second derivative by eta",
    "Third derivative by eta",
    "Derivative by xi at fixed eta",
    "Second derivative by eta of the derivative by xi",
)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Piecewise polynomial shapes of a rod held at a moving block",
        references=("Beale & Scott (12)-(14)", "the same with one polynomial on each side"),
        arguments=_arguments(),
        results={
            name: Result(name, _SHAPE, "", meaning)
            for name, meaning in zip(_NAMES, _MEANINGS, strict=True)
        },
        notes=(
            "The bay is the rod between pin and block, the tail what is beyond. Every shape "
            "vanishes at the pin and at the block, and its slope is continuous at the block.",
            "A basis: the functions through_... with polynomials p that span those of a degree; or "
            "one turn, with j = 1 at the block on both sides, and any number of bubbles.",
        ),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("rod_polynomials",),
    energies=_forms,
    describe=_describe,
)
