"""Newmark's scheme by machine: Taylor's formula with an interpolated acceleration, its stability.

From Taylor's formula with the remainder as an integral of the acceleration (Aannaque 6.1, 6.2) and
the acceleration between the ends of a step from those at the ends (6.3) follow the weights (6.4)
and the scheme (6.5); on one damped freedom, its amplification matrix (6.9), the characteristic
polynomial (6.10), and the limits of stability by Routh's criterion on the half plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

gamma, beta, damping, phase = sp.symbols("gamma beta damping phase", real=True)
step = sp.Symbol("h", positive=True)
old, new, third, place = sp.symbols("a_old a_new third_derivative tau", real=True)
share = sp.Symbol("share", real=True)


@dataclass(frozen=True)
class Weights:
    """An integral of the acceleration over a step, by its values at the ends.

    Attributes
    ----------
    value : sympy.Expr
        The weighted ends.
    remainder : sympy.Expr
        What the integral has beyond them, in the third derivative of the displacement.
    """

    value: sp.Expr
    remainder: sp.Expr


def interpolated() -> sp.Expr:
    """Return the acceleration at tau from both ends: ``share`` of the new one (6.3).

    Taylor's series of the ends about tau, to the third derivative, is weighed so that the
    acceleration at tau has the weight 1.
    """
    here = sp.Symbol("a_here", real=True)
    series = [here + third * (end - place) for end in (sp.S.Zero, step)]
    total = (1 - share) * (series[0] - old) + share * (series[1] - new)
    (found,) = sp.solve(total, here)
    return sp.expand(found)


def weights(kernel: sp.Expr, part: sp.Expr) -> Weights:
    """Return the integral of kernel times acceleration over a step, ``part`` of the new end."""
    whole = sp.expand(sp.integrate(sp.expand(kernel * interpolated()), (place, 0, step)))
    whole = sp.expand(whole.subs(share, part))
    remainder = sp.factor(whole.coeff(third)) * third
    return Weights(sp.collect(sp.expand(whole.subs(third, 0)), [old, new]), remainder)


def velocity_weights() -> Weights:
    """Return (6.4a): the integral that carries the velocity, gamma of the new end."""
    return weights(sp.S.One, gamma)


def displacement_weights() -> Weights:
    """Return (6.4b): the integral that carries the displacement, 2 beta of the new end."""
    return weights(step - place, 2 * beta)


def amplification(loss: sp.Expr = damping) -> sp.Matrix:
    """Return the matrix of a step on (q, h q') of ``q'' + 2 loss omega q' + omega^2 q = 0``.

    ``phase`` is omega h (6.9).
    """
    q, v, q_new, v_new = sp.symbols("q v q_new v_new", real=True)
    # v is h q', and accelerations carry h^2.
    ends = {
        old: -(2 * loss * phase * v + phase**2 * q) / step**2,
        new: -(2 * loss * phase * v_new + phase**2 * q_new) / step**2,
    }
    carried = velocity_weights().value.subs(ends) * step
    moved = displacement_weights().value.subs(ends)
    equations = [sp.expand(v_new - v - carried), sp.expand(q_new - q - v - moved)]
    found = sp.solve(equations, [q_new, v_new], dict=True)[0]
    rows = [sp.expand(sp.cancel(found[end])) for end in (q_new, v_new)]
    return sp.Matrix([[sp.cancel(sp.together(row).diff(x)) for x in (q, v)] for row in rows])


@dataclass(frozen=True)
class Margins:
    """Routh's conditions on ``lambda^2 - trace lambda + determinant``, over a common denominator.

    With lambda = (1 + z)/(1 - z) the roots are within the unit circle where all three are positive.

    Attributes
    ----------
    denominator : sympy.Expr
        Positive where gamma, beta, damping and phase are.
    static : sympy.Expr
        ``1 - trace + determinant``: no root passes +1.
    growth : sympy.Expr
        ``1 - determinant``: no pair leaves the circle.
    flip : sympy.Expr
        ``1 + trace + determinant``: no root passes -1.
    turning : sympy.Expr
        ``determinant - trace^2/4`` times the square of the denominator over phase^2: positive
        where the roots are a pair (6.11).
    """

    denominator: sp.Expr
    static: sp.Expr
    growth: sp.Expr
    flip: sp.Expr
    turning: sp.Expr


def margins(loss: sp.Expr = damping) -> Margins:
    """Return the conditions of stability of a step."""
    matrix = amplification(loss)
    trace, determinant = sp.cancel(matrix.trace()), sp.cancel(matrix.det())
    below = sp.denom(sp.together(determinant))
    if sp.Poly(below, phase).eval(0) < 0:
        below = -below
    # The constant of the denominator is made 1, so that its sign is plain.
    below = sp.expand(below / sp.Poly(below, phase).eval(0))
    parts = [
        sp.cancel(value * below)
        for value in (1 - trace + determinant, 1 - determinant, 1 + trace + determinant)
    ]
    turning = sp.cancel((determinant - trace**2 / 4) * below**2 / phase**2)
    static, growth, flip = (_tidy(part) for part in parts)
    return Margins(below, static, growth, flip, _tidy(turning))


def _tidy(expression: sp.Expr) -> sp.Expr:
    """Return a polynomial in the phase, the factors of its powers collected."""
    found = sp.Poly(sp.expand(expression), phase)
    return sp.Add(*(sp.factor(c) * phase**p for (p,), c in found.terms()))
