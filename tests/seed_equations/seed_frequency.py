"""The thesis' beam of chapter 5: machine-derived functions in its own letters, and numbers."""

from __future__ import annotations

from functools import cache

import sympy as sp
from elastolink.derive.models import beam_frequency_functions as ff
from elastolink.derive.models import beam_frequency_problem as problem
from elastolink.derive.records import ActionDensity
from elastolink.derive.variational import hamilton

x, t = problem.X, problem.TIME
E, INERTIA, A, rho, L = sp.symbols("E I A rho L", positive=True)
lam, beta, omega = sp.symbols("lambda beta omega", positive=True)
v, u = problem.DEFLECTION, problem.STRETCH


@cache
def field_equations():
    """Return Hamilton's equations of the beam of length L, bending and stretching."""
    density = rho * A * (v.diff(t) ** 2 + u.diff(t) ** 2) / 2
    density -= E * INERTIA * v.diff(x, 2) ** 2 / 2 + E * A * u.diff(x) ** 2 / 2
    return hamilton(ActionDensity(x, t, L, (u, v), density))


def end_force(field, order, position):
    """Return the force at an end that goes with a field or its slope, in the running x."""
    (found,) = (
        condition.expression
        for condition in field_equations().natural
        if (condition.field, condition.order) == (field, order)
        and sp.simplify(condition.position - position) == 0
    )
    return -found


@cache
def bending():
    """Return F1 to F6 of a beam of length 1, in lambda."""
    above, divisor = ff.numerators()
    return {name: (above[name] / divisor).subs(problem.Z, lam) for name in above}


@cache
def axial():
    """Return F7 and F8 of a beam of length 1, in beta."""
    steps, functions, _ = ff.axial()
    found = {}
    for name, form in functions.items():
        for symbol, value in reversed(steps.steps):
            form = form.xreplace({symbol: value})
        found[name] = form.subs(problem.B, beta)
    return found
