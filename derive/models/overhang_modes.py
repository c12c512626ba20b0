"""Modes of a beam pinned at one end and at an interior support, as emitted closed forms.

Roots, shapes, drift as the support moves, and every integral that the equations of a rod through
a sliding block want (Beale & Scott (8)-(11)).
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ..ir import Argument, Description, Result
from ..pipeline import Model
from ..spec import ModelSpec
from ..staged import ClosedForm, KernelForm, KernelForms, Steps
from . import overhang_ends as ends
from .overhang_integrals import (
    DRIFT,
    MODE,
    RATE,
    Ends,
    eta,
    gap_step,
    in_roots,
    pair_integral,
    pair_rate,
    place,
    single_integral,
    square_integral,
)
from .overhang_waves import HANG, SPAN

_PULL = (1 - eta**2) / 2  # centrifugal tension over m phi'^2 L^2
_PAIR = (Ends.of("_1"), Ends.of("_2"))
_SHAPES = ("value", "slope_along", "curvature", "third")
_DRIFTS = ("drift", "drift_slope", "drift_curvature")
_AMPLITUDES = (ends.LEFT, ends.RIGHT, ends.LEFT_GROWTH, ends.RIGHT_GROWTH)


def _characteristic() -> KernelForm:
    steps = Steps((*SPAN.steps(ends.beta * place), *HANG.steps(ends.beta * (1 - place))))
    outputs = tuple(zip(("residual", "residual_slope"), ends.residual(), strict=True))
    return KernelForm(
        "characteristic",
        "Return what vanishes on a root, over growing factors, and its slope along beta",
        ClosedForm((ends.beta, place), steps, outputs),
    )


def _ends() -> KernelForm:
    rates = (RATE, ends.SPAN_RATE, ends.HANG_RATE)
    names = (*_AMPLITUDES, *rates, *ends.ENDS.values.values())
    return KernelForm(
        "end_values",
        "Return amplitudes of modes of unit square, their growth, and values at the ends",
        ClosedForm((ends.beta, place), Steps(ends.end_steps()), tuple((s.name, s) for s in names)),
    )


def _bay(free: bool) -> tuple[KernelForm, KernelForm]:
    """Return the modes on one side of the support, and their drift."""
    word, where = ("beyond", "beyond the support") if free else ("before", "up to the support")
    factor, growth = (ends.RIGHT, ends.RIGHT_GROWTH) if free else (ends.LEFT, ends.LEFT_GROWTH)
    phase_rate = ends.HANG_RATE if free else ends.SPAN_RATE
    shape, moved, steps = ends.shape(free), ends.bay(free).moved, Steps(ends.point_steps(free))
    drifts = tuple((name, ends.drift(k, shape, free, moved[k])) for k, name in enumerate(_DRIFTS))
    return (
        KernelForm(
            f"modes_{word}",
            f"Return modes {where} and their derivatives along eta",
            ClosedForm(
                (ends.beta, eta, place, factor), steps, tuple(zip(_SHAPES, shape, strict=True))
            ),
        ),
        KernelForm(
            f"drift_{word}",
            f"Return the derivatives of modes {where} along the support's place xi",
            ClosedForm((ends.beta, eta, place, factor, growth, RATE, phase_rate), steps, drifts),
        ),
    )


def _of_pairs() -> KernelForm:
    """Return integrals over two different modes."""
    wanted = {
        "drift_12": (sp.S.One, (MODE, 0), (DRIFT, 0)),
        "drift_drift_12": (sp.S.One, (DRIFT, 0), (DRIFT, 0)),
        "bending_drift_12": (sp.S.One, (MODE, 2), (DRIFT, 2)),
        "tension_12": (_PULL, (MODE, 1), (MODE, 1)),
    }
    outputs = []
    for name, (weight, row, column) in wanted.items():
        plain = pair_integral(weight, row, column, _PAIR)
        outputs.append((name, in_roots(plain, _PAIR)))
    outputs.append(("drift_rate_12", pair_rate(dict(outputs)["drift_12"], _PAIR)))
    if pair_integral(sp.S.One, (MODE, 0), (MODE, 0), _PAIR) != 0:
        raise ArithmeticError("the modes are not orthogonal")
    return KernelForm(
        "pair_integrals",
        "Return integrals over two different modes",
        ClosedForm(_inputs(outputs, _PAIR), Steps((gap_step(_PAIR),)), tuple(outputs)),
    )


def _inputs(outputs: list[tuple[str, sp.Expr]], modes: tuple[Ends, ...]) -> tuple[sp.Symbol, ...]:
    """Return place, roots and those end values that are wanted, in one order."""
    used = set().union(*(value.free_symbols for _, value in outputs))
    found = [place]
    for mode in modes:
        found += [mode.beta, *(symbol for symbol in mode.values.values() if symbol in used)]
    return (*found, *([RATE] if RATE in used else ()))


def _of_one() -> KernelForm:
    """Return integrals over one mode, and over one mode and itself."""
    mode = Ends.of()
    drift_curvature = square_integral((MODE, 2), (DRIFT, 2), 0, mode)
    # int e f = 0, the derivative of int e^2 = 1.
    drift_curvature -= mode.constant * square_integral((MODE, 0), (DRIFT, 0), 0, mode)
    pull = sp.Poly(_PULL, eta)
    tension = sum(
        factor * square_integral((MODE, 1), (MODE, 1), power, mode)
        for (power,), factor in pull.terms()
    )
    plain = {
        "drift_drift": square_integral((DRIFT, 0), (DRIFT, 0), 0, mode),
        "bending_drift": sp.expand(drift_curvature),
        "tension": sp.expand(tension),
        "moment_integral": single_integral(eta, 0, mode),
        "mean": single_integral(sp.S.One, 0, mode),
    }
    outputs = [(name, sp.collect(value, mode.beta)) for name, value in plain.items()]
    return KernelForm(
        "own_integrals",
        "Return integrals over one mode, and over one mode and itself",
        ClosedForm(_inputs(outputs, (mode,)), Steps(), tuple(outputs)),
    )


def _forms(spec: ModelSpec) -> KernelForms:
    return KernelForms(
        (_characteristic(), _ends(), *_bay(False), *_bay(True), _of_pairs(), _of_one())
    )


_SHAPE = "ndarray, shape (...)"
_END_WORDS: Mapping[str, str] = {
    "root_slope": "e' at the pin",
    "root_shear": "e''' at the pin",
    "slope": "e' at the support",
    "moment": "e'' at the support",
    "shear": "e''' before the support",
    "reaction": "Jump of e''' at the support, beyond less before",
    "tip": "e at the tip",
    "tip_slope": "e' at the tip",
    "root_slope_drift": "de'/dxi at the pin",
    "root_shear_drift": "de'''/dxi at the pin",
    "slope_drift": "de'/dxi at the support, eta fixed",
    "moment_drift": "de''/dxi before the support, eta fixed",
    "shear_drift": "de'''/dxi before the support, eta fixed",
    "reaction_drift": "Jump of de'''/dxi at the support, eta fixed, beyond less before",
    "tip_drift": "de/dxi at the tip",
    "tip_slope_drift": "de'/dxi at the tip",
}
_WORDS: Mapping[str, str] = {
    "eta": "Place of a point along the beam, in lengths from the pin",
    "place": "Place xi of the support, in lengths from the pin; above 0, to 1",
    "beta": "Root: the mode solves e'''' = beta^4 e",
    "left_amplitude": "Factor of the wave between pin and support",
    "right_amplitude": "Factor of the shape beyond the support",
    "left_growth": "Derivative of the left amplitude by xi, over it",
    "right_growth": "Derivative of the right amplitude by xi, over it",
    "rate": "Derivative of beta by xi, over beta",
    "span_rate": "Derivative of beta xi by xi",
    "hang_rate": "Derivative of beta (1 - xi) by xi",
    **_END_WORDS,
}
_RESULTS: Mapping[str, str] = {
    "residual": "Vanishes on a root, and changes its sign there",
    "residual_slope": "Its derivative by beta",
    "value": "e, of unit square over the beam, positive at the tip",
    "slope_along": "e'",
    "curvature": "e''",
    "third": "e'''",
    "drift": "de/dxi at a fixed point",
    "drift_slope": "Its first derivative along the beam",
    "drift_curvature": "Its second derivative along the beam",
    "drift_12": "int e_1 de_2/dxi; with the modes exchanged, its negative",
    "drift_drift_12": "int de_1/dxi de_2/dxi",
    "bending_drift_12": "int e_1'' de_2''/dxi; with the modes exchanged, its negative",
    "drift_rate_12": "Derivative of drift_12 by xi",
    "tension_12": "int (1 - eta^2)/2 e_1' e_2'",
    "drift_drift": "int (de/dxi)^2",
    "bending_drift": "int e'' de''/dxi",
    "tension": "int (1 - eta^2)/2 e'^2",
    "moment_integral": "int eta e",
    "mean": "int e",
    **{name: _WORDS[name] for name in _WORDS if name not in ("eta", "place", "beta")},
}


def _arguments() -> tuple[Argument, ...]:
    found = [Argument(name, _SHAPE, "", meaning) for name, meaning in _WORDS.items()]
    for i in (1, 2):
        words = {"beta": _WORDS["beta"], **_END_WORDS}
        found += [
            Argument(f"{name}_{i}", _SHAPE, "", f"Of mode {i}: {meaning}")
            for name, meaning in words.items()
        ]
    return tuple(found)


def _describe(spec: ModelSpec) -> Description:
    return Description(
        title="Modes of a beam with an overhang: pinned at an end and at a support",
        references=("Beale & Scott (3)-(6)", "Beale & Scott (8)-(11)"),
        arguments=_arguments(),
        results={name: Result(name, _SHAPE, "", words) for name, words in _RESULTS.items()},
        notes=(
            "The tip of no mode is at rest, and no mode starts without slope at the pin: the sign "
            "that makes the tip positive is continuous as the support moves, and the slope at the "
            "pin of mode n then has the sign of (-1)^n.",
        ),
    )


MODEL = Model(
    mechanism="quick_return",
    formulations=("overhang_modes",),
    energies=_forms,
    describe=_describe,
)
