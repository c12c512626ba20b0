"""The rotating, translating, inextensible pinned beam with an end load."""

from __future__ import annotations

import sympy as sp
from elastolink.derive.records import ActionDensity, EndForce, Essential
from elastolink.derive.variational import order_part, solve_end_value, solve_tension

x, t = sp.symbols("x t")
l2, l3, mu, EI = sp.symbols("l2 l3 mu EI", positive=True)
y, u, N = (sp.Function(name)(x, t) for name in ("y", "u", "N"))
th2, th3, Fx = (sp.Function(name)(t) for name in ("th2", "th3", "Fx"))
PINNED = (Essential(0, y, 0), Essential(l3, y, 0))


def zero(expression: sp.Expr) -> bool:
    """Return whether an expression vanishes when it is multiplied out."""
    return sp.expand(expression.doit()) == 0


def coupler(**changes: object) -> ActionDensity:
    """Return the action with the end load Fx; N keeps the beam from stretching."""
    w2, w3 = th2.diff(t), th3.diff(t)
    along = l2 * w2 * sp.sin(th3 - th2) + u.diff(t) - w3 * y
    across = l2 * w2 * sp.cos(th3 - th2) + y.diff(t) + w3 * (x + u)
    density = (
        mu / 2 * (along**2 + across**2)
        - EI / 2 * y.diff(x, 2) ** 2
        - N * (u.diff(x) + y.diff(x) ** 2 / 2)
    )
    action = ActionDensity(
        x,
        t,
        l3,
        (u, y, N),
        density,
        end_forces=(EndForce(l3, u, 0, Fx),),
        essential=(Essential(0, u, 0), *PINNED),
        orders={u: 2, y: 1, N: 0},
    )
    return action.with_(**changes)


def tension(equations) -> sp.Expr:
    """Return N of the undeformed beam."""
    end = solve_end_value(equations.condition(l3, u, 0), N)
    leading = order_part(equations.equations[u], equations.action.orders, 0)
    return solve_tension(leading, N, x, l3, end)
