"""Lagrange's equations by machine against published and independently derived equations."""

import pytest
import sympy as sp
from elastolink.derive.arrays import CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import (
    NotRepresentable,
    euler_lagrange,
    linear_periodic,
    quadratic_form,
)
from elastolink.derive.records import EquationsOfMotion, Lagrangian

t = sp.Symbol("t", real=True)
m1, m2, l1, l2, g, k, w, c = sp.symbols("m1 m2 l1 l2 g k w c", positive=True)
m, p, load = sp.symbols("m p load", positive=True)
x, y = (sp.Function(name)(t) for name in ("x", "y"))
turn = sp.Function("turn")(t)
theta, td, tdd = sp.symbols("theta td tdd", real=True)
CRANK = CrankMotion(theta, td, tdd)


def functions(names: str) -> tuple[sp.Expr, ...]:
    return tuple(sp.Function(name)(t) for name in names.split())


def test_double_pendulum_against_the_textbook():
    a, b = functions("a b")
    x1, y1 = l1 * sp.sin(a), -l1 * sp.cos(a)
    x2, y2 = x1 + l2 * sp.sin(b), y1 - l2 * sp.cos(b)
    energy = m1 / 2 * (x1.diff(t) ** 2 + y1.diff(t) ** 2) - m1 * g * y1
    energy += m2 / 2 * (x2.diff(t) ** 2 + y2.diff(t) ** 2) - m2 * g * y2
    found = euler_lagrange(Lagrangian((a, b), t, energy))
    (qa, qb), (va, vb) = found.coordinates, found.velocities
    # Goldstein, Classical Mechanics: the equations of the plane double pendulum
    cos, sin = sp.cos(qa - qb), sp.sin(qa - qb)
    mass = sp.Matrix([[(m1 + m2) * l1**2, m2 * l1 * l2 * cos], [m2 * l1 * l2 * cos, m2 * l2**2]])
    rest = sp.Matrix(
        [
            m2 * l1 * l2 * vb**2 * sin + (m1 + m2) * g * l1 * sp.sin(qa),
            -m2 * l1 * l2 * va**2 * sin + m2 * g * l2 * sp.sin(qb),
        ]
    )
    assert sp.simplify(found.mass - mass) == sp.zeros(2, 2)
    assert sp.simplify(found.rest - rest) == sp.zeros(2, 1)
    assert found.constraints.shape == (0, 1)


def test_explicit_time_dependence_of_a_constraint():
    px, py = functions("px py")
    energy = m1 / 2 * (px.diff(t) ** 2 + py.diff(t) ** 2)
    rod = py * sp.cos(w * t) - px * sp.sin(w * t)
    found = euler_lagrange(Lagrangian((px, py), t, energy, (rod,)))
    # a bead on a rotating rod runs out as cosh
    motion = sp.Matrix([sp.cosh(w * t) * sp.cos(w * t), sp.cosh(w * t) * sp.sin(w * t)])
    speed, acceleration = motion.diff(t), motion.diff(t, 2)
    names = (*found.coordinates, *found.velocities)
    numbers = dict(zip(names, (*motion, *speed), strict=True))
    on_rod = (found.jacobian * speed - found.velocity_rhs).subs(numbers)
    bent = (found.jacobian * acceleration - found.gamma).subs(numbers)
    residual = found.mass * acceleration + found.rest
    assert sp.simplify(found.constraints.subs(numbers)) == sp.zeros(1, 1)
    assert sp.simplify(on_rod) == sp.zeros(1, 1)
    assert sp.simplify(bent) == sp.zeros(1, 1)
    assert sp.simplify(found.gamma.subs(numbers)) != sp.zeros(1, 1)
    # the reaction is normal to the rod, so along the rod nothing is left
    rod_direction = sp.Matrix([sp.cos(w * t), sp.sin(w * t)])
    assert sp.simplify((rod_direction.T * residual)[0]) == 0


def test_prescribed_motion_is_differentiated():
    (a,) = functions("a")
    z = sp.Function("z")(t)
    px, py = l1 * sp.sin(a), z - l1 * sp.cos(a)
    energy = m1 / 2 * (px.diff(t) ** 2 + py.diff(t) ** 2) - m1 * g * py
    symbolic = euler_lagrange(Lagrangian((a,), t, energy))
    (q,) = symbolic.coordinates
    # pendulum with a vibrating pivot: gravity becomes g + z''
    by_hand = m1 * l1 * (g + z.diff(t, 2)) * sp.sin(q)
    assert sp.simplify(symbolic.rest[0] - by_hand) == 0
    given = euler_lagrange(Lagrangian((a,), t, energy, prescribed={z: sp.cos(w * t)}))
    by_hand = m1 * l1 * (g - w**2 * sp.cos(w * t)) * sp.sin(q)
    assert sp.simplify(given.rest[0] - by_hand) == 0


def test_terms_outside_the_family_are_reported():
    (p, q) = functions("p q")
    with pytest.raises(NotRepresentable, match=r"p\*\*3"):
        quadratic_form(p.diff(t) ** 2 + p**3, (p,), CRANK, t)
    with pytest.raises(NotRepresentable, match="td"):
        quadratic_form(td * p.diff(t) ** 2, (p,), CRANK, t)
    with pytest.raises(NotRepresentable, match=r"td\*\*3"):
        quadratic_form(p.diff(t) ** 2 + td**3 * p**2, (p,), CRANK, t)
    with pytest.raises(NotRepresentable, match="forces"):
        quadratic_form(p.diff(t) ** 2, (p,), CRANK, t, forces={p: -c * p.diff(t) ** 2})
    with pytest.raises(NotRepresentable, match="q_dot"):
        quadratic_form(p.diff(t) * q - q.diff(t) * p, (p, q), CRANK, t)


def test_bad_input_is_refused():
    (p, q) = functions("p q")
    with pytest.raises(ValueError, match="first time derivatives"):
        euler_lagrange(Lagrangian((p,), t, p.diff(t, 2) * p))
    with pytest.raises(ValueError, match="holonomic"):
        euler_lagrange(Lagrangian((p, q), t, p.diff(t) ** 2, (p.diff(t) - q,)))
    with pytest.raises(ValueError, match="unknown coordinates"):
        Lagrangian((p,), t, p, forces={q: k})
    with pytest.raises(ValueError, match="multipliers"):
        Lagrangian((p,), t, p, (p,), multipliers=sp.symbols("a b"))
    with pytest.raises(ValueError, match="not an applied function"):
        Lagrangian((k,), t, k)
    with pytest.raises(ValueError, match="present time"):
        euler_lagrange(Lagrangian((p,), t, p.diff(t) ** 2 + p.subs(t, t - 1)))


def test_system_records_refuse_nonsense():
    with pytest.raises(ValueError, match="unknown array"):
        DiscreteSystem(CRANK, 1, {"X": sp.ImmutableDenseMatrix([[1]])})
    with pytest.raises(ValueError, match="shape"):
        DiscreteSystem(CRANK, 2, {"M": sp.ImmutableDenseMatrix([[1]])})
    system = DiscreteSystem(CRANK, 1, {"M": sp.ImmutableDenseMatrix([[1]])})
    with pytest.raises(ValueError, match="1 modes"):
        system.matrix("M", 2)
    with pytest.raises(ValueError, match="no derivative"):
        CrankMotion(theta, td, tdd, {k: w}).derivative(w * theta)


def equations(energy: sp.Expr, coordinates=(x, y), forces=None) -> EquationsOfMotion:
    return euler_lagrange(Lagrangian(coordinates, t, energy, forces=forces or {}))


def second_order(system: DiscreteSystem) -> dict[str, sp.Matrix]:
    """M, C + td G, and everything that multiplies q, and the force."""
    slope = CRANK.derivative
    arrays = {name: system.matrix(name) for name in ("M", "A", "B", "S", "C", "K", "Kg")}
    gyro = arrays["M"].applyfunc(slope) + arrays["A"] - arrays["A"].T
    stiffness = arrays["K"] + arrays["Kg"]
    stiffness += td**2 * (arrays["A"].applyfunc(slope) - arrays["B"])
    stiffness += tdd * (arrays["A"] - arrays["S"])
    force = td**2 * system.matrix("f") + td * system.matrix("h") + tdd * system.matrix("g")
    return {
        "M": arrays["M"],
        "first": arrays["C"] + td * gyro,
        "zeroth": stiffness,
        "force": force + system.matrix("p"),
    }


def energy(th: sp.Expr, rate: sp.Expr, acceleration: sp.Expr) -> sp.Expr:
    """Every kind of term that the family has, its arrays varying with the angle."""
    xd, yd = x.diff(t), y.diff(t)
    kinetic = m / 2 * (2 + sp.cos(th)) * xd**2 + m * sp.sin(th) * xd * yd + 3 * m * yd**2
    gyro = rate * (sp.cos(th) * xd * y + 2 * sp.sin(2 * th) * yd * y + xd * x)
    frame = rate**2 * (sp.sin(th) * x**2 + x * y) + acceleration * sp.cos(th) * y**2
    linear = rate * sp.sin(th) * xd + rate**2 * sp.cos(th) * y + acceleration * p * x
    linear += sp.cos(3 * th) * yd + rate * load * y + p * sp.sin(th) * x
    return kinetic + gyro + frame + linear - k / 2 * (x - sp.cos(th) * y) ** 2


def test_equations_and_the_quadratic_lagrangian_give_the_same_arrays():
    """Two routes: read off the derived equations, and off the energy."""
    rate = turn.diff(t)
    forces = {x: -c * x.diff(t) + k * y * rate**2 + p, y: turn.diff(t, 2) * sp.sin(turn) * x}
    derived = equations(energy(turn, rate, turn.diff(t, 2)), forces=forces)
    one = second_order(linear_periodic(derived, CRANK, followers={turn: theta}))
    plain = {turn.diff(t, 2): tdd, turn.diff(t): td, turn: theta}
    plain_forces = {item: force.subs(plain) for item, force in forces.items()}
    found = quadratic_form(energy(theta, td, tdd), (x, y), CRANK, t, forces=plain_forces)
    for name, matrix in second_order(found).items():
        assert (matrix - one[name]).applyfunc(sp.expand) == sp.zeros(*matrix.shape), name


def test_drag_of_what_stands_still_goes_to_c_and_d_in_turning_axes():
    spin = turn.diff(t)
    moved = x.diff(t) - spin * y, y.diff(t) + spin * x
    energy, forces = m / 2 * (moved[0] ** 2 + moved[1] ** 2), {x: -c * moved[0], y: -c * moved[1]}
    from_equations = linear_periodic(
        equations(energy, forces=forces), CRANK, followers={turn: theta}
    )
    plain = {turn.diff(t): td}
    from_energy = quadratic_form(
        energy.subs(plain), (x, y), CRANK, t, forces={k: v.subs(plain) for k, v in forces.items()}
    )
    for system in (from_equations, from_energy):
        assert system.matrix("C") == c * sp.eye(2)
        assert system.matrix("D") == c * sp.Matrix([[0, -1], [1, 0]])


def test_constrained_equations_are_no_linear_system():
    found = euler_lagrange(Lagrangian((x, y), t, m * x.diff(t) ** 2 / 2, (x - y,)))
    with pytest.raises(NotRepresentable, match="constrained"):
        linear_periodic(found, CRANK)


@pytest.mark.parametrize(
    ("term", "shown"), [(x**3, "x"), (td**3 * x, "td"), (x.diff(t) ** 2 * y, "x_dot")]
)
def test_what_has_no_place_is_refused(term, shown):
    with pytest.raises(NotRepresentable, match=shown):
        linear_periodic(equations(m / 2 * (x.diff(t) ** 2 + y.diff(t) ** 2) + term), CRANK)
