"""The boundary value problem of a uniform beam that vibrates with prescribed ends.

Field equations and end forces come from Hamilton's principle; the problem is solved about the
middle, where it falls into an even and an odd half.  Bending in units of EI, L and the mass per
length, the axial motion in units of EA, L and the mass per length: the frequency is then z^2 in
bending and b along the beam.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import sympy as sp

from ..records import ActionDensity, FieldEquations
from ..variational import hamilton

X, TIME = sp.symbols("x t", real=True)
DEFLECTION, STRETCH = (sp.Function(name)(X, TIME) for name in ("v", "u"))
Z, B = sp.symbols("z b", positive=True)
MIDDLE = sp.Symbol("s", real=True)  # from the middle, in lengths
HALF = sp.Rational(1, 2)
_OMEGA, _RATE = sp.symbols("omega rate", positive=True)


def bending() -> ActionDensity:
    """Return the action of a beam that bends, without shear and rotary inertia."""
    density = sp.diff(DEFLECTION, TIME) ** 2 / 2 - sp.diff(DEFLECTION, X, 2) ** 2 / 2
    return ActionDensity(X, TIME, sp.S.One, (DEFLECTION,), density)


def stretching() -> ActionDensity:
    """Return the action of a beam that moves along itself."""
    density = sp.diff(STRETCH, TIME) ** 2 / 2 - sp.diff(STRETCH, X) ** 2 / 2
    return ActionDensity(X, TIME, sp.S.One, (STRETCH,), density)


def wave_numbers(equations: FieldEquations, frequency: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return the exponents of ``exp(rate x)`` that solve the field equation, in a fixed order.

    ``equations``: of one field; ``frequency``: of the harmonic motion.
    """
    (field,) = equations.action.fields
    trial = sp.exp(_RATE * X) * sp.cos(_OMEGA * TIME)
    expression = equations.equations[field].subs(field, trial).doit()
    polynomial = sp.Poly(sp.expand(expression / trial), _RATE)
    found = sp.roots(polynomial.as_expr().subs(_OMEGA, frequency), _RATE)
    return tuple(sorted((sp.simplify(r) for r in found), key=sp.default_sort_key))


def end_forces(equations: FieldEquations, frequency: sp.Expr, shape: sp.Expr) -> list[sp.Expr]:
    """Return the generalised forces at the right end that keep up a harmonic motion.

    ``equations``: of one field; a force at an end adds to its natural condition; ``frequency``: of
    the motion; ``shape``: function of the place from the middle.
    """
    (field,) = equations.action.fields
    swing = sp.cos(_OMEGA * TIME)
    motion = shape.subs(MIDDLE, X - HALF) * swing
    found = []
    for condition in sorted(equations.natural, key=lambda c: c.order):
        if condition.position == 1:
            force = -condition.expression.subs(field, motion).doit()
            found.append(sp.expand(force.subs(X, 1) / swing).subs(_OMEGA, frequency))
    return found


@dataclass(frozen=True)
class HalfProblem:
    """One half of the problem: shapes of one parity about the middle.

    ``shapes``: numerators of the shapes that have a unit generalised displacement at the right end:
    the value, and in bending the slope; ``forces``: numerators of the forces at that end: row force
    and moment, column displacement; ``divisor``: what divides all of them.
    """

    shapes: tuple[sp.Expr, ...]
    forces: sp.ImmutableDenseMatrix
    divisor: sp.Expr


@lru_cache(maxsize=4)
def half_problem(axial: bool, parity: int) -> HalfProblem:
    """Solve the boundary value problem of one parity.

    ``axial``: true for the motion along the beam; ``parity``: 1 for even shapes, -1 for odd ones.
    """
    equations = hamilton(stretching() if axial else bending())
    frequency = B if axial else Z**2
    waves = []
    for rate in wave_numbers(equations, frequency):
        if sp.im(rate) > 0:
            waves.append((sp.cos if parity > 0 else sp.sin)(sp.im(rate) * MIDDLE))
        elif sp.re(rate) > 0:
            waves.append((sp.cosh if parity > 0 else sp.sinh)(rate * MIDDLE))
    ends = sp.Matrix(
        len(waves), len(waves), lambda k, j: sp.diff(waves[j], MIDDLE, k).subs(MIDDLE, HALF)
    )
    divisor = sp.expand(ends.det())
    amplitudes = ends.adjugate()
    shapes = [
        sp.expand(sum(amplitudes[j, k] * wave for j, wave in enumerate(waves)))
        for k in range(len(waves))
    ]
    columns = [end_forces(equations, frequency, shape) for shape in shapes]
    forces = sp.Matrix(columns).T.applyfunc(sp.expand)
    common = sp.gcd_terms(divisor).as_independent(sp.sin, sp.cos, sp.sinh, sp.cosh)[0]
    return HalfProblem(
        tuple(sp.expand(shape / common) for shape in shapes),
        sp.ImmutableDenseMatrix((forces / common).applyfunc(sp.expand)),
        sp.expand(divisor / common),
    )
