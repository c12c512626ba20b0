"""Beale & Scott (1)-(11), (16): the rod's action, its equation, and Galerkin's method."""

from functools import cache, partial

import numpy as np
import sympy as sp
from elastolink.derive.models import flexible_rod as rod
from elastolink.derive.models import overhang_integrals as overhang
from elastolink.derive.models.quick_return import crank, frame, kinematics, theta2
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton, linearise, quadratic_action
from elastolink.runtime.linkages import QuickReturn
from elastolink.runtime.systems.rod import OverhangBasis, rod_system
from plain_basis import PlainBasis
from seed_ledger import Ledger, by_differences, hold, holds, is_zero, quoted, same

row = Ledger("Beale & Scott", __file__)
WHOLE = ModelSpec("quick_return", "moving_basis", flexible=("rod",))
PRINTED = WHOLE.with_(drop=("frame", "tension"))
x, t, v, phi, block, L = rod.x, rod.t, rod.v, rod.phi, rod.block, rod.length
m, EI = rod.density, rod.stiffness
eps, eta, speed = sp.symbols("epsilon eta Omega", positive=True)
FLEXIBLE = {"frame": 0.59997, "length": 1.0, "mass_per_length": 7.15}
FLEXIBLE["bending_stiffness"] = 0.7e11 * 0.5208e-6
RATIO = 0.3
LINKAGE = QuickReturn(frame=0.59997, crank=RATIO * 0.59997, rod=1.0)


def undamped(spec):
    return rod.action(spec).with_(dissipation=sp.S.Zero)


@cache
def derived(spec):
    return hamilton(undamped(spec))


def equal(ours, printed):
    return sp.expand(ours - printed).doit() == 0


def tension_work():
    """Return what the action up to second order holds beyond the printed one."""
    action = undamped(WHOLE)
    taut = quadratic_action(action, {rod.tension: rod.tension_in(derived(WHOLE))}, (rod.u,))
    return sp.factor(sp.expand(taut.density - undamped(PRINTED).density))


def work_left_out():
    names = {m: sp.Symbol(r"\bar{m}"), EI: sp.Symbol("EI"), L: sp.Symbol("L")}
    work = sp.latex(tension_work().xreplace(names))
    return rf"\mathcal{{L}}_{{(16)}} + \int_0^L {work}\,dx"


@row("16", derived=work_left_out)
def action_without_the_shortening(entry):
    """The density is the same on both sides: each integral is the density times its length."""
    names = {"m_bar": m, "EI": EI, "L": L, "x_1": block, "t": t, "v": v, "phi": phi, "x": x}
    ours = L * undamped(PRINTED).density
    same(
        entry.printed.value(**names, Int=lambda inside, low, high, _: (high - low) * inside(x)),
        ours,
    )
    # The tension from its own cause: what lies beyond x goes round with phi'.
    s = sp.Symbol("s")
    pull = sp.integrate(m * phi.diff(t) ** 2 * s, (s, x, L))
    assert equal(tension_work(), -pull * v.diff(x) ** 2 / 2)
    # Its size, of the first mode of the beam held at 0.6 of its length.
    basis, place = OverhangBasis(1), np.array([0.6])
    kept, missing = (basis.array(name, place)[0, 0, 0] for name in ("overlap", "tension"))
    quoted(missing / kept, "4.05")


@cache
def turning():
    """Return phi' and phi'' by the crank angle, in epsilon."""
    k = kinematics()
    values = (k.steps.inline(symbol) for symbol in (k.w4, k.a4))
    return [sp.simplify(value.subs(crank, eps * frame)) for value in values]


w = sp.Function("w")(eta, theta2)
FIRST, SECOND = sp.symbols("first second")


def scaled(expression, length=L, along=L, rate=speed):
    """Write v = length w, x = along eta, d/dt = rate d/dtheta; divide by -m L Omega^2."""
    jets = {
        v.diff(x, 4): length * w.diff(eta, 4) / along**4,
        v.diff(t, 2): length * rate**2 * w.diff(theta2, 2),
        v.diff(x, 2): length * w.diff(eta, 2) / along**2,
        v.diff(x): length * w.diff(eta) / along,
        phi.diff(t, 2): rate**2 * SECOND,
        phi.diff(t): rate * FIRST,
    }
    plain = expression.subs(jets).subs(v, length * w).subs(x, along * eta)
    return sp.expand(-plain / (m * L * speed**2))


def field_equation(**scales):
    """Return the derived equation in the printed quantities."""
    ours = scaled(derived(PRINTED).equations[v], **scales)
    return ours.subs(dict(zip((FIRST, SECOND), turning(), strict=True)))


@row("1", slow=True)
def equation_of_the_field(entry):
    names = {"theta": theta2, "theta_dot": speed, "eta": eta, "eps": eps, "w": w}
    ((left, right),) = entry.printed.sides(**names, lam=sp.sqrt(EI / (m * L**4)))
    same(left - right, field_equation())
    # With the tension, linear in v.
    taut = linearise(derived(WHOLE).equations[v], derived(WHOLE).action.orders, 1)
    taut = taut.subs(rod.tension, rod.tension_in(derived(WHOLE))).doit()
    added = -(FIRST**2) / 2 * ((1 - eta**2) * w.diff(eta)).diff(eta)
    assert is_zero(scaled(taut) - scaled(derived(PRINTED).equations[v]) - added)


def place_by_epsilon():
    """Return the block's distance from the pin over a_x."""
    k = kinematics()
    distance = k.steps.inline(k.slide2).subs(crank, eps * frame) / frame**2
    half = sp.cos(theta2)
    squares = {sp.cos(theta2 / 2) ** 2: (1 + half) / 2, sp.sin(theta2 / 2) ** 2: (1 - half) / 2}
    return sp.sqrt(sp.expand(sp.expand(distance).subs(squares)))


@row("2", derived=lambda: rf"\bar l = \frac{{a_x}}{{L}}{sp.latex(place_by_epsilon())}")
def quantities_without_dimension(entry):
    names = {"theta_dot": speed, "t": t, "L": L, "v": v, "x": x, "G": crank, "a_x": frame}
    given = entry.printed.values(**names, x_1=block, m_bar=m, EI=EI, lam=sp.S.One)
    scales = {"length": v / given["w"], "along": x / given["eta"], "rate": given["theta"] / t}
    assert is_zero(field_equation(**scales) - field_equation())
    assert is_zero(place_by_epsilon() ** 2 - 1 - 2 * eps * sp.cos(theta2) - eps**2)
    numbers = {**FLEXIBLE, "crank_ratio": 0.25, "length": 1.3}
    system = rod_system(PlainBasis(2), **numbers)
    (elastic,) = [term.scale for term in system.terms if term.array == "K"]
    linkage = QuickReturn(frame=0.59997, crank=0.25 * 0.59997, rod=1.3)
    point = {"G": 0.25 * 0.59997, "a_x": 0.59997, "eps": 0.25, "L": 1.3, "m_bar": 7.15}
    point |= {"x_1": float(linkage.motion(1.1).slide), "EI": numbers["bending_stiffness"]}
    point["l_bar"] = 0.59997 / 1.3 * np.sqrt(1 + 2 * 0.25 * np.cos(1.1) + 0.25**2)
    point["lam"] = np.sqrt(system.scale_values()[elastic])
    point |= {"theta_dot": 1.0, "t": 1.0, "v": 1.0, "x": 1.0}
    hold(entry.printed, point)


@cache
def conditions_of_the_action():
    """Derive what holds at pin, block and tip, with and without the tension."""
    for spec in (PRINTED, WHOLE):
        equations = derived(spec)
        held = [(e.position, e.order) for e in equations.action.essential if e.field == v]
        assert held == [(0, 0)]
        assert [(s.position, s.field) for s in equations.action.supports] == [(block, v)]
        shear, moment = [j for j in equations.jumps if j.field == v]
        assert (shear.order, shear.reaction) == (0, rod.reaction)
        assert (moment.order, moment.reaction, moment.applied) == (1, 0, 0)
        assert equal(moment.value, -EI * v.diff(x, 2))
        assert equal(equations.condition(0, v, 1), EI * v.diff(x, 2))
        assert equal(equations.condition(L, v, 1), -EI * v.diff(x, 2))
        tip = equations.condition(L, v, 0)
        if spec == WHOLE:
            force = rod.tension_in(equations)
            assert sp.expand(force.subs(x, L)) == 0
            tip = tip.subs(rod.tension, force).subs(L**2 * v.diff(x), x**2 * v.diff(x))
            tip = sp.expand(tip).subs(x**2, L**2).doit()
        assert equal(tip, EI * v.diff(x, 3))
    # No other variation is left free, so a jump of the slope is not.
    assert {j.order for j in derived(PRINTED).jumps} == {0, 1}


@row("3", "4")
def conditions_at_pin_block_and_tip(entry):
    """The derived ones and no others, held by every mode of the basis, which is built on them."""
    conditions_of_the_action()
    basis, xi, held = OverhangBasis(4), 0.6, set()
    beyond = np.nextafter(xi, 1.0)

    def shape(order):
        def value(at):
            held.add((order, at))
            return basis.shapes(np.array([at]), np.array([xi]), order)[0, 0]

        return value

    names = {"w": shape(0), "w_1": shape(1), "w_2": shape(2), "w_3": shape(3), "l_bar": xi}
    scale = basis.roots(np.array([xi]))[0, -1]
    hold(entry.printed, {**names, "l_plus": beyond, "l_minus": xi}, tol=1e-13 * scale**2)
    essential = {(0, 0), (0, xi), (1, xi), (1, beyond)}
    natural = {(2, 0), (2, 1), (3, 1), (2, xi), (2, beyond)}
    assert held == {"3": essential, "4": natural}[entry.label]


MODE, DRIFT = (overhang.MODE, 0), (overhang.DRIFT, 0)
PAIR = (overhang.Ends.of("_k"), overhang.Ends.of("_n"))
# Galerkin's method: four modes with an overhang, three of them in the sums.
COUNT, STEP = 4, 2e-3
BASIS = OverhangBasis(COUNT)
SYSTEM = rod_system(OverhangBasis(3), **FLEXIBLE, crank_ratio=RATIO, drop=("frame", "tension"))


def place(theta):
    return LINKAGE.motion(theta).slide / LINKAGE.rod


def modes(theta, order=0):
    """Return the rates of the modes by the angle, by differences, each on its side of the block."""
    xi = place(theta)

    def rate(side, k):
        def value(at):
            at = np.ravel(at)

            def shape(angle):
                return BASIS.shapes(at, np.array([place(angle)]))[0, :, k - 1]

            values = by_differences(shape, theta, order, STEP) if order else shape(theta)
            return np.where(at <= xi if side == 1 else at >= xi, values, 0.0)

        return value

    return {(k, side): rate(side, k) for k in range(1, COUNT + 1) for side in (1, 2)}


@row("5", "6")
def trial_functions(entry):
    """Every sum of the modes is admissible at every angle, of continuous slope and moment."""
    basis = OverhangBasis(6)
    places = np.linspace(0.05, 0.999, 60)
    for place_ in places[::6]:
        xi = np.array([place_])
        around = np.array([place_, np.nextafter(place_, 1.0)])
        assert np.max(np.abs(basis.shapes(around, xi)[0])) < 1e-13
        for order in (1, 2):
            before, beyond = basis.shapes(around, xi, order)[0]
            assert np.max(np.abs(beyond - before) / basis.roots(xi)[0] ** order) < 1e-13
    assert np.all(basis.shapes(np.array([1.0]), places)[:, 0] > 0)
    f = np.array([0.3, -0.2, 0.7, 0.4])
    at = np.array([0.2, 0.5]) if entry.label == "5" else np.array([0.8, 1.0])
    both = {key: lambda at, _, e=e: e(at) for key, e in modes(1.1).items()}
    tables = {"f": {k + 1: lambda _, k=k: f[k] for k in range(COUNT)}, "e": both}
    value = entry.printed.value(**tables, theta=1.1, eta=at, N=COUNT)
    same(value, BASIS.shapes(at, np.array([place(1.1)]))[0] @ f)


@cache
def galerkin(theta):
    """Return the library's integrals, the derived side of (8)-(11), and the printed integrands."""
    xi, motion = np.array([place(theta)]), LINKAGE.motion(theta)
    drift, both, moment = (BASIS.array(n, xi)[0] for n in ("drift", "drift_drift", "moment"))
    second = BASIS.drift_rate(xi)[0] - both
    tables = {
        "Delta": np.eye(COUNT),
        "a_bar": 2 * motion.slide_velocity * drift,
        "b_bar": motion.slide_acceleration * drift + motion.slide_velocity**2 * second,
    }
    tables = {
        name: {(k + 1, n + 1): table[k, n] for k in range(COUNT) for n in range(COUNT)}
        for name, table in tables.items()
    }
    functions = {f"e{name}": modes(theta, k) for k, name in enumerate(("", "_theta", "_2theta"))}
    return {**tables, "g_bar": dict(enumerate(moment, 1)), **functions, "l_bar": place(theta)}


def integrals(entry, tol):
    for theta in (1.1, 2.9, 5.0):
        for k in (1, 2, 3):
            for n in (1, 2, 3):
                hold(entry.printed, {**galerkin(theta), "k": k, "n": n}, tol=tol)


@row("8")
def squares_of_the_modes(entry):
    integrals(entry, 1e-12)
    assert overhang.pair_integral(sp.S.One, MODE, MODE, PAIR) == 0


@row("9", slow=True)
def drift_of_the_modes(entry):
    integrals(entry, 1e-8)
    closed = overhang.in_roots(overhang.pair_integral(sp.S.One, MODE, DRIFT, PAIR), PAIR)
    s, r = sp.symbols("slope_k slope_n", real=True), sp.symbols("reaction_k reaction_n", real=True)
    assert sp.expand(closed - (r[0] * s[1] + r[1] * s[0]) / overhang.gap_step(PAIR)[0]) == 0


@row("10", slow=True)
def second_drift_of_the_modes(entry):
    integrals(entry, 1e-5)
    for theta in (1.1, 2.9, 5.0):
        drifts = BASIS.array("drift_drift", np.array([place(theta)]))[0]
        both = LINKAGE.motion(theta).slide_velocity ** 2 * drifts
        for (k, n), b in galerkin(theta)["b_bar"].items():
            assert abs(b + galerkin(theta)["b_bar"][n, k] + 2 * both[k - 1, n - 1]) < 2e-12


@row("11")
def moments_of_the_modes(entry):
    integrals(entry, 1e-12)
    one = overhang.Ends.of()
    at, reaction = sp.Symbol("place", positive=True), sp.Symbol("reaction", real=True)
    closed = -at * reaction / one.beta**4
    assert sp.expand(overhang.single_integral(overhang.eta, 0, one) - closed) == 0


def second_order_motion():
    """Yield motions of three modes by the canonical form's arrays: f'' from f' and f."""
    theta, rate = 1.1, 400.0

    def at(name, angle=theta):
        return SYSTEM.array(name, np.array([angle]))[0]

    def slope(name):
        return by_differences(partial(at, name), theta, h=5e-3)

    damping = slope("M") + at("A") - at("A").T
    stiffness = at("K") / rate**2 + slope("A") - at("B")
    rng = np.random.default_rng(0)
    for k in (1, 2, 3):
        f, f_p = rng.standard_normal((2, 3))
        f_pp = np.linalg.solve(at("M"), at("f") - damping @ f_p - stiffness @ f)
        motion = {
            name: dict(enumerate(u, 1)) for name, u in {"f": f, "f_p": f_p, "f_pp": f_pp}.items()
        }
        omega = dict(enumerate(np.sqrt(np.diag(at("K"))), 1))
        more = {"theta": theta, "theta_dot": rate, "eps": RATIO, "omega": omega, "N": 3, "k": k}
        yield {**galerkin(theta), **motion, **more}


@row("7")
def galerkin_equation(entry):
    holds(second_order_motion, tol=1e-6)(entry)
    # Plain polynomials are not orthogonal: the form with Delta_kk alone is not theirs.
    other = rod_system(PlainBasis(2), **FLEXIBLE, crank_ratio=RATIO)
    mass = other.array("M", np.array([1.1]))[0]
    assert abs(mass[0, 1]) > 0.5 * np.sqrt(mass[0, 0] * mass[1, 1])


test_row, test_falsified_row = row.tests()
