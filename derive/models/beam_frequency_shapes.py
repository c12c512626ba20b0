"""Shapes of a vibrating beam between its ends, as functions of the displacements of the ends.

Near an end, a power series in the distance from it, whose factors are end forces; elsewhere waves
and parts that decay from either end.  The shapes of the right end are formed; those of the left
end are their mirror images.
"""

from __future__ import annotations

from functools import lru_cache

import sympy as sp

from ..safe import UnsafeRewriting
from ..staged import ClosedForm, Steps
from . import beam_frequency_functions as ff
from .beam_frequency_problem import HALF, MIDDLE, B, Z, half_problem

XI = sp.Symbol("xi", real=True)
_REST = sp.Symbol("rest", real=True)  # 1 - xi
_ENDS = (1, -1)  # the right one, the left one


def _of_ends(word: str) -> dict[int, sp.Symbol]:
    return {end: sp.Symbol(f"{word}_{'right' if end > 0 else 'left'}", real=True) for end in _ENDS}


# Phase of the distance from an end, its fourth power, exp(-phase), cosine and sine.
_PHASES, _POWERS = _of_ends("phase"), _of_ends("fourth")
_FADES, _SWINGS, _TURNS = _of_ends("fade"), _of_ends("swing"), _of_ends("turn")
_NEARER = sp.Symbol("nearer", real=True)  # to the right end than to the left one
_ORDERS = range(4)
NAMES = ("value", "slope", "curvature", "third")
_TERMS = 5  # of a series in (z y)^4 <= 1; what is left out is below 1e-18 of the first
_DISTANCES = {1: _REST, -1: XI}  # from the right end, from the left one


@lru_cache(maxsize=2)
def _whole_shape(which: int) -> tuple[sp.Expr, sp.Expr]:
    """Return a shape of the right end (0 deflection, 1 rotation) over the common divisor."""
    even, odd = half_problem(False, 1), half_problem(False, -1)
    above = even.shapes[which] * odd.divisor + odd.shapes[which] * even.divisor
    return sp.expand(above * HALF), ff.numerators()[1]


def end_derivative(which: int, end: int, order: int) -> sp.Expr:
    """Return the second or third derivative of a shape at an end: a frequency function.

    ``which``: 0 for the unit deflection of the right end, 1 for its unit rotation; ``end``: 1 for
    the right end, -1 for the left one; ``order``: 2 or 3.
    """
    above, _ = _whole_shape(which)
    derived = sp.diff(above, MIDDLE, order).subs(MIDDLE, end * HALF)
    whole = ff.whole_phase(derived)
    for name, numerator in ff.numerators()[0].items():
        for sign in (1, -1):
            if sp.expand(whole - sign * numerator) == 0:
                return sign * ff.FUNCTIONS[name]
    raise UnsafeRewriting(f"{whole} is no frequency function")


@lru_cache(maxsize=4)
def _start(which: int, end: int) -> tuple[sp.Expr, ...]:
    """Return value and three derivatives of a shape at an end, by the distance from that end."""
    own = end > 0  # the right end is the one that moves
    given = (
        sp.Integer(own and which == 0),
        sp.Integer(own and which == 1),
        end_derivative(which, end, 2),
        end_derivative(which, end, 3),
    )
    return tuple((-end) ** k * value for k, value in enumerate(given))


def _series(which: int, end: int, order: int) -> sp.Expr:
    """Return a derivative of a shape by a power series in the distance from an end."""
    y, total = _DISTANCES[end], sp.S.Zero
    for k, value in enumerate(_start(which, end)):
        # Four derivatives multiply a shape by z^4: so does each fourth coefficient.
        first = 0 if k >= order else 1
        series = sp.S.Zero
        for j in reversed(range(first, first + _TERMS)):
            series = 1 / sp.factorial(4 * j + k - order) + _POWERS[end] * series
        front = ff.SQUARED**first * y ** (4 * first + k - order)
        total += value * front * series
    return (-end) ** order * total


@lru_cache(maxsize=4)
def _amplitudes(which: int, end: int) -> tuple[sp.Expr, ...]:
    """Return the amplitudes of ``cos zy``, ``sin zy``, ``exp(-zy)`` from value and derivatives."""
    y = sp.Symbol("y", positive=True)
    unknowns = sp.symbols("swing turn sink rise")
    waves = (sp.cos(Z * y), sp.sin(Z * y), sp.exp(-Z * y), sp.exp(Z * y))
    shape = sum(a * wave for a, wave in zip(unknowns, waves, strict=True))
    conditions = [
        sp.diff(shape, y, k).subs(y, 0) - value for k, value in enumerate(_start(which, end))
    ]
    (found,) = sp.linsolve(conditions, *unknowns)
    return tuple(sp.expand(value) for value in found[:3])


def _waves(which: int, end: int, order: int) -> sp.Expr:
    """Return a derivative of a shape by waves and parts that decay from either end."""
    y = sp.Symbol("y", positive=True)
    swing, turn, sink = _amplitudes(which, end)
    far = _amplitudes(which, -end)[2]
    shape = swing * sp.cos(Z * y) + turn * sp.sin(Z * y)
    derived = sp.diff(shape, y, order) + sink * (-Z) ** order * _FADES[end]
    derived += far * Z**order * _FADES[-end]
    values = {sp.cos(Z * y): _SWINGS[end], sp.sin(Z * y): _TURNS[end]}
    return (-end) ** order * sp.expand(derived.xreplace(values))


def bending_shapes() -> ClosedForm:
    """Return the shapes of the right end's deflection and rotation, with three derivatives."""
    names = ("deflection", "rotation")
    outputs = []
    for which, name in enumerate(names):
        for order in _ORDERS:
            left, right = (
                sp.Piecewise(
                    (_waves(which, end, order), _PHASES[end] > 1),
                    (_series(which, end, order), True),
                )
                for end in (-1, 1)
            )
            form = sp.Piecewise((right, _NEARER > 0), (left, True))
            outputs.append((f"{name}_{NAMES[order]}", form))
    steps = ff.steps().then(
        *((ff.FUNCTIONS[name], form) for name, form in ff.functions().items()),
        (ff.SQUARED, Z**4),
        (_REST, 1 - XI),
        *((_PHASES[end], Z * _DISTANCES[end]) for end in _ENDS),
        (_NEARER, _PHASES[-1] - _PHASES[1]),
        *((_POWERS[end], _PHASES[end] ** 4) for end in _ENDS),
        *((_FADES[end], sp.exp(-_PHASES[end])) for end in _ENDS),
        *((_SWINGS[end], sp.cos(_PHASES[end])) for end in _ENDS),
        *((_TURNS[end], sp.sin(_PHASES[end])) for end in _ENDS),
    )
    return ClosedForm((Z, XI), steps.needed(e for _, e in outputs), tuple(outputs))


def axial_shapes() -> ClosedForm:
    """Return the shape of the right end's displacement along the beam, with its slope."""
    total = sp.S.Zero
    for parity in (1, -1):
        half = half_problem(True, parity)
        total += half.shapes[0] / half.divisor / 2
    plain = sp.simplify(total.subs(MIDDLE, XI - HALF))
    above, below = sp.fraction(plain)
    short = sp.trigsimp(above) / sp.trigsimp(below)
    if sp.simplify(sp.expand_trig(short - plain)) != 0:
        raise UnsafeRewriting(f"{short} is not {plain}")
    outputs = (("stretch_value", short), ("stretch_slope", sp.diff(short, XI)))
    return ClosedForm((B, XI), Steps(), outputs)
