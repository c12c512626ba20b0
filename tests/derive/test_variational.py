"""Hamilton's principle by machine against equations derived by hand."""

import pytest
import sympy as sp
from coupler_action import EI, Fx, N, beam, coupler, l3, mu, t, tension, th2, th3, u, x, y, zero
from elastolink.derive import variational as variational
from elastolink.derive.arrays import CrankMotion
from elastolink.derive.records import ActionDensity, EndForce, Essential, PointTerm, Support

tip, k, J, r, T = sp.symbols("tip k J r T", positive=True)


def d(expression: sp.Expr, *by: sp.Symbol) -> sp.Expr:
    return sp.Derivative(expression, *by) if by else expression


@pytest.mark.smoke
def test_string_and_euler_bernoulli_beam():
    string = ActionDensity(x, t, l3, (y,), mu / 2 * y.diff(t) ** 2 - T / 2 * y.diff(x) ** 2)
    result = variational.hamilton(string)
    assert zero(result.equations[y] - (T * d(y, (x, 2)) - mu * d(y, (t, 2))))
    assert zero(result.condition(l3, y, 0) + T * d(y, x))
    assert zero(result.condition(0, y, 0) - T * d(y, x))
    result = variational.hamilton(beam())
    assert zero(result.equations[y] + mu * d(y, (t, 2)) + EI * d(y, (x, 4)))
    assert zero(result.condition(l3, y, 0) - EI * d(y, (x, 3)))
    assert zero(result.condition(l3, y, 1) + EI * d(y, (x, 2)))


def test_mixed_derivatives_of_rotary_inertia():
    action = ActionDensity(x, t, l3, (y,), mu * r**2 / 2 * y.diff(x, t) ** 2)
    result = variational.hamilton(action)
    assert zero(result.equations[y] - mu * r**2 * d(y, (x, 2), (t, 2)))
    assert zero(result.condition(l3, y, 0) + mu * r**2 * d(y, x, (t, 2)))


def test_end_conditions_of_mass_spring_and_moment():
    moment = sp.Symbol("moment")
    action = beam(
        point_terms=(
            PointTerm(l3, tip / 2 * y.diff(t) ** 2 + J / 2 * y.diff(x, t) ** 2 - k / 2 * y**2),
        ),
        end_forces=(EndForce(l3, y, 1, moment),),
        essential=(Essential(0, y, 0), Essential(0, y, 1)),
    )
    result = variational.hamilton(action)
    assert {(c.position, c.order) for c in result.natural} == {(l3, 0), (l3, 1)}
    assert zero(result.condition(l3, y, 0) - (EI * d(y, (x, 3)) - tip * d(y, (t, 2)) - k * y))
    rotation = -EI * d(y, (x, 2)) - J * d(y, x, (t, 2)) + moment
    assert zero(result.condition(l3, y, 1) - rotation)
    with pytest.raises(KeyError, match="no natural condition"):
        result.condition(0, y, 0)


def test_interior_support_spring_and_mass_jump_conditions():
    a, b, R = sp.symbols("a b R")
    action = beam(
        point_terms=(PointTerm(b, tip / 2 * y.diff(t) ** 2 - k / 2 * y**2),),
        supports=(Support(a, y, R),),
    )
    jumps = {(j.position, j.order): j for j in variational.hamilton(action).jumps}
    assert set(jumps) == {(a, 0), (a, 1), (b, 0), (b, 1)}
    # the shear jumps by the support's force (static beam: EI y'''' = load), the moment does not
    assert zero(jumps[a, 0].value - EI * d(y, (x, 3)))
    assert (jumps[a, 0].applied, jumps[a, 0].reaction) == (0, R)
    assert zero(jumps[a, 1].value + EI * d(y, (x, 2)))
    assert (jumps[a, 1].applied, jumps[a, 1].reaction) == (0, 0)
    assert zero(jumps[b, 0].applied + tip * d(y, (t, 2)) + k * y)
    assert jumps[b, 0].reaction == 0


def test_sliding_support_carries_the_momentum_flux():
    a, R = sp.Function("a")(t), sp.Symbol("R")
    action = ActionDensity(
        x,
        t,
        l3,
        (y,),
        mu / 2 * y.diff(t) ** 2 - T / 2 * y.diff(x) ** 2,
        supports=(Support(a, y, R),),
    )
    (jump,) = variational.hamilton(action).jumps
    # travelling along with the point, the quantity that jumps is -T y_x - adot mu y_t
    assert zero(jump.value + T * d(y, x) + a.diff(t) * mu * d(y, t))
    assert jump.reaction == R


def test_mass_that_moves_along_a_string():
    a = sp.Function("a")(t)
    speed = y.diff(t) + a.diff(t) * y.diff(x)
    action = beam(point_terms=(PointTerm(a, tip / 2 * speed**2),))
    jump = next(j for j in variational.hamilton(action).jumps if j.order == 0)
    slope = next(j for j in variational.hamilton(action).jumps if j.order == 1)
    # the mass feels the acceleration of its own path: y_tt + 2 a' y_xt + a'^2 y_xx + a'' y_x
    path = d(y, (t, 2)) + 2 * a.diff(t) * d(y, x, t) + a.diff(t) ** 2 * d(y, (x, 2))
    path += a.diff(t, 2) * d(y, x)
    assert zero(jump.applied + tip * path)
    assert zero(slope.applied)


def test_quadratic_action_gives_the_linearised_equation():
    equations = variational.hamilton(coupler())
    force = tension(equations)
    reduced = variational.quadratic_action(equations.action, {N: force}, (u,))
    assert reduced.fields == (y,)
    assert reduced.end_forces == ()
    linear = variational.linearise(equations.equations[y], equations.action.orders, 1).subs(
        N, force
    )
    assert zero(variational.hamilton(reduced).equations[y] - linear)


def test_quadratic_action_refuses_a_wrong_tension():
    equations = variational.hamilton(coupler())
    force = tension(equations)
    with pytest.raises(ValueError, match="not stationary in u"):
        variational.quadratic_action(equations.action, {N: force + x}, (u,))
    with pytest.raises(ValueError, match="not stationary at an end"):
        variational.quadratic_action(equations.action, {N: force + 1}, (u,))


def test_crank_angle_rewriting_is_the_chain_rule():
    theta, theta3, omega3, alpha3, td, tdd = sp.symbols("theta theta3 omega3 alpha3 td tdd")
    crank = CrankMotion(theta, td, tdd, {theta3: omega3, omega3: alpha3})
    followers = {th2: theta, th3: theta3}
    rewritten = variational.in_crank_angle(
        th3.diff(t, 2) + th3.diff(t) * th2.diff(t) + sp.sin(th2), crank, t, followers
    )
    by_hand = alpha3 * td**2 + omega3 * tdd + omega3 * td**2 + sp.sin(theta)
    assert sp.expand(rewritten - by_hand) == 0
    # against an explicit follower angle
    explicit = theta + sp.sin(theta) / 3
    moving = CrankMotion(theta, td, tdd)
    value = variational.in_crank_angle(th3.diff(t, 2), moving, t, {th3: explicit, th2: theta})
    motion = sp.Rational(7, 10) * t**2
    direct = sp.diff(explicit.subs(theta, motion), t, 2)
    back = value.subs({td: sp.diff(motion, t), tdd: sp.diff(motion, t, 2)}).subs(theta, motion)
    assert sp.expand(direct - back) == 0


def test_crank_angle_rewriting_refuses_what_it_does_not_know():
    theta, theta3, omega3, td, tdd = sp.symbols("theta theta3 omega3 td tdd")
    crank = CrankMotion(theta, td, tdd, {theta3: omega3})
    with pytest.raises(ValueError, match="omega3"):
        variational.in_crank_angle(th3.diff(t, 2), crank, t, {th3: theta3})
    with pytest.raises(ValueError, match="gives no derivative"):
        variational.in_crank_angle(Fx.diff(t), crank, t, {Fx: sp.Symbol("load")})
    with pytest.raises(ValueError, match="beyond the second"):
        variational.in_crank_angle(th2.diff(t, 3), crank, t, {th2: theta})


def test_bad_actions_are_refused():
    with pytest.raises(ValueError, match="not an applied function"):
        ActionDensity(x, t, l3, (th2,), th2)
    with pytest.raises(ValueError, match="unknown fields"):
        ActionDensity(x, t, l3, (y,), y, essential=(Essential(0, u, 0),))
    density = -T / 2 * y.diff(x) ** 2
    slope = PointTerm(l3, -k / 2 * y.diff(x) ** 2)
    with pytest.raises(ValueError, match="x derivative 1"):
        variational.hamilton(ActionDensity(x, t, l3, (y,), density, point_terms=(slope,)))
    inner = Essential(l3 / 2, y, 0)
    with pytest.raises(ValueError, match="use a Support"):
        variational.hamilton(ActionDensity(x, t, l3, (y,), density, essential=(inner,)))
    with pytest.raises(ValueError, match="running point"):
        variational.hamilton(ActionDensity(x, t, l3, (y,), density * y.subs(x, l3)))


def test_solve_tension_refuses_other_equations():
    with pytest.raises(ValueError, match="not of the form"):
        variational.solve_tension(N.diff(x) + N, N, x, l3, sp.S.Zero)
    with pytest.raises(ValueError, match="not of the form"):
        variational.solve_tension(x * N.diff(x) + 1, N, x, l3, sp.S.Zero)
    with pytest.raises(ValueError, match="not linear"):
        variational.solve_end_value(N**2 - 1, N)
    value = variational.solve_tension(2 * N.diff(x) + sp.sin(x) + x**2, N, x, l3, Fx)
    assert zero(2 * value.diff(x) + sp.sin(x) + x**2)
    assert zero(value.subs(x, l3) - Fx)
