"""Motions that follow a few coordinates and their derivatives, with powers of the crank speed.

An expression is ``sum w^e V_ej(theta) eta^(j)``: arrays by (power e, order j), sampled on even
angles.  Putting one into the equation of motion, or into a form of recovery, gives another.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..beams.recovery_forms import LinearForm
from ..core.families import LinearPeriodic
from ..floquet.first_order import SPEED_POWER
from ..core.trigonometric import Array, differentiated

Key = tuple[int, int]
Expression = dict[Key, Array]
Arrays = Mapping[str, Mapping[int, Array]]


def sampled_arrays(system: LinearPeriodic, theta: Array) -> dict[str, dict[int, Array]]:
    """Return the arrays at crank angles by name and by power of w in the equation times w^2."""
    scales = system.scale_values()
    found: dict[str, dict[int, Array]] = {}
    for term in system.terms:
        if term.array not in SPEED_POWER:
            continue
        power = 2 + SPEED_POWER[term.array] + term.power
        factor = 1.0 if term.scale is None else float(scales[term.scale])
        own = found.setdefault(term.array, {})
        samples = factor * np.asarray(term(theta), dtype=float)
        own[power] = own[power] + samples if power in own else samples
    return found


def plus(*expressions: Expression) -> Expression:
    """Return a sum."""
    total: Expression = {}
    for expression in expressions:
        for key, value in expression.items():
            total[key] = total[key] + value if key in total else value
    return total


def times(matrices: Mapping[int, Array], expression: Expression) -> Expression:
    """Return matrices by power, ``(nt, k, n)``, times an expression."""
    return plus(
        *({(e + p, j): matrix @ value} for p, matrix in matrices.items()
          for (e, j), value in expression.items())
    )  # fmt: skip


def derivative(expression: Expression, period: float) -> Expression:
    """Return d/dtheta of an expression."""
    inner = {key: differentiated(value, period) for key, value in expression.items()}
    return plus(inner, {(e, j + 1): value for (e, j), value in expression.items()})


def equation(arrays: Arrays, expression: Expression, period: float) -> Expression:
    """Return the left side of the equation of motion times w^2, of an expression put in.

    ``w^2 [(M q' + A q)' - A^T q' - B q] + w (C q' + D q) + (K + Kg) q``.
    """
    slope = derivative(expression, period)
    minus_transposed = {p: -np.swapaxes(v, -1, -2) for p, v in arrays.get("A", {}).items()}
    minus_inertia = {p: -v for p, v in arrays.get("B", {}).items()}
    momentum = plus(times(arrays["M"], slope), times(arrays.get("A", {}), expression))
    return plus(
        derivative(momentum, period),
        times(minus_transposed, slope),
        times(minus_inertia, expression),
        times(arrays.get("C", {}), slope),
        times(arrays.get("D", {}), expression),
        times(arrays.get("K", {}), expression),
        times(arrays.get("Kg", {}), expression),
    )


def recovered(form: LinearForm, expression: Expression, period: float) -> Expression:
    """Return a form of recovery of an expression; what stands by itself in the form is left out.

    The form counts the square of the speed of second derivatives in its powers.
    """
    slope = derivative(expression, period)
    second = derivative(slope, period)
    found: Expression = {}
    for (name, power), rows in form.parts.items():
        if name == "q":
            found = plus(found, times({power: rows}, expression))
        elif name == "dq":
            found = plus(found, times({power: rows}, slope))
        elif name == "ddq":
            found = plus(found, times({power: rows}, second))
    return found


def constant_part(expression: Expression) -> dict[int, Array]:
    """Return an expression of the constant 1 by power of the speed, its only axis left out."""
    return {e: value[..., 0] for (e, j), value in expression.items() if j == 0}
