"""Actions that tests share: a beam at rest, and a coupler with an end load, in variants."""

import sympy as sp
from elastolink.derive.arrays import CrankMotion
from elastolink.derive.records import ActionDensity, EndForce, Essential, FieldEquations
from elastolink.derive.variational import (
    hamilton,
    order_part,
    quadratic_action,
    solve_end_value,
    solve_tension,
)

x, t = sp.symbols("x t")
l2, l3, mu, EI, g = sp.symbols("l2 l3 mu EI g", positive=True)
y, u, N = (sp.Function(name)(x, t) for name in ("y", "u", "N"))
th2, th3, Fx = (sp.Function(name)(t) for name in ("th2", "th3", "Fx"))
theta, theta3, omega3, alpha3, td, tdd = sp.symbols("theta theta3 omega3 alpha3 td tdd")
CRANK = CrankMotion(theta, td, tdd, {theta3: omega3, omega3: alpha3})
PINNED = (Essential(0, y, 0), Essential(l3, y, 0))


def zero(expression: sp.Expr) -> bool:
    """Return whether an expression vanishes when it is multiplied out."""
    return sp.expand(expression.doit()) == 0


def beam(**changes: object) -> ActionDensity:
    """Return the action of Euler and Bernoulli's beam, its ends free."""
    density = mu / 2 * y.diff(t) ** 2 - EI / 2 * y.diff(x, 2) ** 2
    return ActionDensity(x, t, l3, (y,), density).with_(**changes)


def coupler(
    *, crank: sp.Expr = l2, gravity: sp.Expr = sp.S.Zero, **changes: object
) -> ActionDensity:
    """Return that of a turning, moving beam with the end load Fx; N keeps it from stretching."""
    w2, w3 = th2.diff(t), th3.diff(t)
    along = crank * w2 * sp.sin(th3 - th2) + u.diff(t) - w3 * y
    across = crank * w2 * sp.cos(th3 - th2) + w3 * (x + u) + y.diff(t)
    height = (x + u) * sp.sin(th3) + y * sp.cos(th3)
    density = mu / 2 * (along**2 + across**2) - mu * gravity * height - EI / 2 * y.diff(x, 2) ** 2
    action = ActionDensity(
        x,
        t,
        l3,
        (u, y, N),
        density - N * (u.diff(x) + y.diff(x) ** 2 / 2),
        end_forces=(EndForce(l3, u, 0, Fx),),
        essential=(Essential(0, u, 0), *PINNED),
        orders={u: 2, y: 1, N: 0},
    )
    return action.with_(**changes)


def tension(equations: FieldEquations) -> sp.Expr:
    """Return N of the undeformed beam."""
    end = solve_end_value(equations.condition(l3, u, 0), N)
    leading = order_part(equations.equations[u], equations.action.orders, 0)
    return solve_tension(leading, N, x, l3, end)


def reduced(action: ActionDensity) -> ActionDensity:
    """Return the quadratic action in y alone."""
    return quadratic_action(action, {N: tension(hamilton(action))}, (u,))
