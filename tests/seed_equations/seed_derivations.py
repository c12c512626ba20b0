"""Machine derivations of the four-bar linkage: its closure, its forces, its flexible coupler.

SymPy starts from the closure of the four bars, from positions of elements and centres of mass, from
the cosine rule and from integrals over a bar and a cylinder; the coupler's field equation and its
modes are the package's own.  No printed formula enters.
"""

from __future__ import annotations

from functools import cache

import sympy as sp
from elastolink.derive.models import coupler
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton, quadratic_action
from sympy.simplify.fu import TR10i

l1, l2, l3, l4 = sp.symbols("ell_1 ell_2 ell_3 ell_4", positive=True)
theta2, theta3, theta4 = ANGLES = sp.symbols("theta_2 theta_3 theta_4", real=True)
omega2, omega3, omega4 = SPEEDS = sp.symbols("omega_2 omega_3 omega_4", real=True)
alpha2, alpha3, alpha4 = ACCELERATIONS = sp.symbols("alpha_2 alpha_3 alpha_4", real=True)
EI, mu, force_x, x, y = sp.symbols("EI mu F_x x y", real=True)
t = sp.Symbol("t", real=True)


def _moving():
    return [sp.Function(f"angle{i}")(t) for i in (2, 3, 4)]


def _still(expression, angles):
    """Replace angles of time and their derivatives by plain symbols, highest order first."""
    for order, names in ((2, ACCELERATIONS), (1, SPEEDS), (0, ANGLES)):
        values = [sp.diff(a, t, order) if order else a for a in angles]
        expression = expression.subs(dict(zip(values, names, strict=True)))
    return expression


def _unit(angle):
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


@cache
def closure_rows(order):
    """Return the horizontal and vertical closure, differentiated ``order`` times by time."""
    angles = _moving()
    crank, coupler, follower = (
        length * _unit(a) for length, a in zip((l2, l3, l4), angles, strict=True)
    )
    frame = sp.Matrix([l1, 0])
    rows = (crank + coupler - frame - follower).diff(t, order)
    return tuple(_still(row, angles) for row in rows)


@cache
def rates():
    """Solve the differentiated closure for omega3, omega4 and for alpha3, alpha4."""
    speeds = sp.solve(closure_rows(1), (omega3, omega4), dict=True)[0]
    accelerations = sp.solve(closure_rows(2), (alpha3, alpha4), dict=True)[0]
    return {name: _of_differences(value) for name, value in {**speeds, **accelerations}.items()}


def _of_differences(quotient):
    """Write a quotient of products of sines and cosines in differences of the angles."""
    halves = []
    for half in sp.fraction(sp.together(quotient)):
        for angle in ANGLES:
            half = sp.expand(sp.expand(half).subs(sp.sin(angle) ** 2, 1 - sp.cos(angle) ** 2))
        halves.append(sp.factor_terms(TR10i(half)))
    return halves[0] / halves[1]


@cache
def follower_quadratic():
    """Eliminate theta3 and sin(theta4): coefficients of the quadratic in cos(theta4)."""
    coupler_x, coupler_y = (
        sp.expand(row - l3 * trig)
        for row, trig in zip(closure_rows(0), (sp.cos(theta3), sp.sin(theta3)), strict=True)
    )
    cosine, sine = sp.symbols("c s", real=True)
    plain = {sp.cos(theta4): cosine, sp.sin(theta4): sine}
    equation = sp.expand((l3**2 - coupler_x**2 - coupler_y**2).subs(plain))
    equation = sp.expand(equation.subs(sine**2, 1 - cosine**2))
    equation = sp.expand(equation.subs(sp.sin(theta2) ** 2, 1 - sp.cos(theta2) ** 2))
    linear = sp.Poly(equation, cosine, sine)
    coefficients = zip("ABC", (cosine, 1, sine), strict=True)
    return {name: sp.factor(linear.coeff_monomial(term)) for name, term in coefficients}


@cache
def element_acceleration():
    """Return the acceleration of the element at (x, y) along and across the undeflected coupler.

    The crank turns at constant speed; y is a function of time alone.
    """
    crank, angle, _ = _moving()
    unit, normal = _unit(angle), _unit(angle + sp.pi / 2)
    deflection = sp.Function("y")(t)
    position = l2 * _unit(crank) + x * unit + deflection * normal
    y_t, y_tt = sp.symbols("y_t y_tt", real=True)
    plain = {sp.diff(deflection, t, 2): y_tt, sp.diff(deflection, t): y_t, deflection: y}
    components = []
    for axis in (unit, normal):
        component = sp.trigsimp(sp.expand(position.diff(t, 2).dot(axis)))
        components.append(sp.trigsimp(_still(component.subs(plain), _moving()).subs(alpha2, 0)))
    return tuple(components), (y_t, y_tt)


# Rigid links.

MASSES = M2, M3, M4 = sp.symbols("M_2 M_3 M_4", positive=True)
RADII = r2, r3, r4 = sp.symbols("r_2 r_3 r_4", real=True)
INERTIAS = I2A, I3B, I4D = sp.symbols("I_{2A} I_{3B} I_{4D}", positive=True)
PINS = sp.symbols("X_12 Y_12 X_23 Y_23 X_34 Y_34 X_41 Y_41", real=True)
X12, Y12, X23, Y23, X34, Y34, X41, Y41 = PINS
T = sp.Symbol("T", real=True)
phi, bd, c, delta = sp.symbols("phi BD c delta", positive=True)
K = sp.Symbol("K", positive=True)


@cache
def centre_accelerations():
    """Return the accelerations of the three centres of mass, two components each."""
    crank, coupler, follower = _moving()
    places = (
        r2 * _unit(crank),
        l2 * _unit(crank) + r3 * _unit(coupler),
        sp.Matrix([l1, 0]) + r4 * _unit(follower),
    )
    return tuple(
        tuple(sp.expand(_still(part, _moving())) for part in place.diff(t, 2)) for place in places
    )


def _moment_of(arm, force):
    return arm[0] * force[1] - arm[1] * force[0]


@cache
def newton_euler():
    """Return the nine equations of the links, forces and moments about the centres of mass."""
    rows = []
    lengths = (l2, l3, l4)
    angles, spins = (theta2, theta3, theta4), (alpha2, alpha3, alpha4)
    # The follower's first joint is D: its centre lies r4 from D, and the coupler pulls at its tip.
    for i, (mass, inertia, radius) in enumerate(zip(MASSES, INERTIAS, RADII, strict=True)):
        before, behind = sp.Matrix(PINS[2 * i : 2 * i + 2]), -sp.Matrix(PINS[2 * i + 2 : 2 * i + 4])
        near, far = -radius * _unit(angles[i]), (lengths[i] - radius) * _unit(angles[i])
        arms = (far, near) if i == 2 else (near, far)
        acceleration = sp.Matrix(centre_accelerations()[i])
        rows += list(before + behind - mass * acceleration)
        moment = _moment_of(arms[0], before) + _moment_of(arms[1], behind)
        drive = T if i == 0 else 0
        rows.append(sp.expand(moment + drive - (inertia - mass * radius**2) * spins[i]))
    return tuple(rows)


@cache
def solution():
    """Solve the nine equations for the pin forces and the driving torque."""
    rows = newton_euler()
    known = {}
    for row, unknown in ((4, Y23), (3, X23), (1, Y12), (0, X12), (6, X41), (7, Y41)):
        known[unknown] = sp.solve(rows[row].subs(known), unknown)[0]
    moments = [sp.expand(rows[row].subs(known)) for row in (5, 8)]
    matrix, right = sp.linear_eq_to_matrix(moments, [X34, Y34])
    divisor = sp.simplify(matrix.det())
    known[X34], known[Y34] = (_tidy(top) / divisor for top in matrix.adjugate() * right)
    crank = {X12: sp.solve(rows[0], X12)[0], Y12: sp.solve(rows[1], Y12)[0]}
    known[T] = sp.trigsimp(sp.expand(sp.solve(rows[2], T)[0].subs(crank)))
    return known


def _tidy(expression):
    """Collect what multiplies the two inertias and the coupler's first moment."""
    parts = sp.collect(sp.expand(expression), (I3B * alpha3, I4D * alpha4, M3 * r3), evaluate=False)
    return sum(key * sp.factor(sp.trigsimp(part)) for key, part in parts.items())


def substituted(expression):
    """Return an expression with every solved pin force put in."""
    found = solution()
    for _ in range(4):
        expression = expression.subs(found)
    return expression


@cache
def cosine_change(sign):
    """Return cos(BDC) less its nominal value when BC is longer (+1) or shorter (-1) by c/2."""
    cosine = [(bd**2 + l4**2 - side**2) / (2 * bd * l4) for side in (l3 + sign * c / 2, l3)]
    return sp.factor(sp.expand(cosine[0] - cosine[1]))


@cache
def clearance_series():
    """Return the coefficients of c, c^2, c^3 in phi' - phi, phi being the nominal angle BDC."""
    change = sp.Function("delta")(c)
    rule = sp.cos(phi + change) - sp.cos(phi) - cosine_change(1)
    found = {change: sp.Integer(0)}
    coefficients = []
    for order in (1, 2, 3):
        row = sp.diff(rule, c, order)
        slope = sp.diff(change, c, order)
        value = sp.solve(row, slope)[0]
        for lower in range(order - 1, 0, -1):
            value = value.subs(sp.diff(change, c, lower), found[sp.diff(change, c, lower)])
        found[slope] = sp.simplify(value.subs(change, 0).subs(c, 0).doit())
        coefficients.append(found[slope] / sp.factorial(order))
    return tuple(coefficients)


L, M, h, rho = sp.symbols("L M h rho", positive=True)


@cache
def balanced_bar():
    """Return the inertia of the balanced bar by integration, in terms of delta, and its parts.

    Bar and extension have one mass per length; the cylinder's axis stands across the plane.
    """
    x, s, radius, place, weight = sp.symbols("x s r_c ell m_c", positive=True)
    bar = sp.integrate(M / L * x**2, (x, -place, L))
    spin = sp.integrate(h * rho * s**2 * 2 * sp.pi * s, (s, 0, radius))
    volume = sp.integrate(h * 2 * sp.pi * s, (s, 0, radius))
    needed = sp.solve(sp.integrate(M / L * x, (x, -place, L)) - weight * place, weight)[0]
    squared = sp.solve(volume * rho - weight, radius**2)[0]
    spin = sp.expand(spin.subs(radius**4, squared**2))
    parts = [part.subs(weight, needed).subs(place, delta * L) for part in (spin, weight * place**2)]
    return sp.expand(bar.subs(place, delta * L)), *(sp.factor(part) for part in parts)


@cache
def balanced_bar_inertia():
    """Return the whole moment of inertia of the balanced bar about its pivot."""
    return sum(balanced_bar())


FREUDENSTEIN = sp.symbols("L_1 L_2 L_3 L_4", positive=True)
TURNS = sp.symbols("t_1 t_2 t_3", real=True)


def freudenstein():
    """Return, for follower and coupler, the rest of the closure: its zero is the equation.

    Each is the squared length of the link between, divided so that cos(t1 - t) stands alone.
    """
    L1, L2, L3, L4 = FREUDENSTEIN
    t1, t2, t3 = TURNS
    found = []
    for angle, length, other, far in ((t3, L3, L2, True), (t2, L2, L3, False)):
        own = length * _unit(angle)
        pin = L1 * _unit(t1)
        gap = own + sp.Matrix([L4, 0]) - pin if far else pin + own - sp.Matrix([L4, 0])
        square = sp.expand(gap.dot(gap) - other**2)
        square = square.subs(sp.sin(angle) ** 2, 1 - sp.cos(angle) ** 2)
        square = sp.expand(square.subs(sp.sin(t1) ** 2, 1 - sp.cos(t1) ** 2))
        found.append(sp.expand(square / (2 * L1 * length) * (1 if far else -1)))
    return found


@cache
def half_angle_quadratic(coupler):
    """Return the quadratic in tan(t/2) of the follower or the coupler."""
    u = sp.Symbol("u", real=True)
    angle = TURNS[1] if coupler else TURNS[2]
    halves = {sp.cos(angle): (1 - u**2) / (1 + u**2), sp.sin(angle): 2 * u / (1 + u**2)}
    rest = sp.expand(sp.expand(freudenstein()[coupler]).subs(halves) * (1 + u**2))
    parts = sp.Poly(sp.cancel(sp.together(rest)), u).all_coeffs()
    parts = (sp.collect(sp.expand(part), sp.cos(TURNS[0])) for part in parts)
    half = sp.tan(angle / 2)
    return sum(part * half**power for power, part in zip((2, 1, 0), parts, strict=True))


# What the package itself derives, in the same symbols: coupler, end load, modes.

SPEC = ModelSpec("four_bar", "complete", flexible=("coupler",))
y_x, y_xx, y_xxxx, y_t, y_tt = sp.symbols("y_x y_xx y_xxxx y_t y_tt", real=True)
first_moment, inertia3, inertia4, mode = (
    sp.Symbol(name, positive=True) for name in ("{m_3 r_3}", "I_3", "I_4", "m")
)


def _plain(expression):
    """Replace the package's symbols and functions of time, at constant crank speed."""
    time, place, field = coupler.t, coupler.x, coupler.y
    table = {coupler.end_load: force_x, coupler.stiffness: EI, coupler.density: mu, place: x}
    table |= {coupler.crank: l2, coupler.coupler: l3, coupler.follower: l4}
    table |= {coupler.damping: sp.S.Zero, field: y}
    for angle, names in (
        (coupler.th2, (theta2, omega2, sp.S.Zero)),
        (coupler.th3, (theta3, omega3, alpha3)),
    ):
        table |= {angle.diff(time, order): name for order, name in enumerate(names)}
    table |= {field.diff(place, order): name for order, name in ((1, y_x), (2, y_xx), (4, y_xxxx))}
    table |= {field.diff(time, order): name for order, name in ((1, y_t), (2, y_tt))}
    return sp.expand(sp.sympify(expression).xreplace(table).doit())


@cache
def _linear():
    equations = hamilton(coupler.action(SPEC))
    tension = coupler.tension_in(equations)
    action = quadratic_action(equations.action, {coupler.tension: tension}, (coupler.u,))
    return equations, tension, hamilton(action)


@cache
def tension():
    """Return the tension along the coupler."""
    return _plain(_linear()[1])


@cache
def equation():
    """Return mu y_tt minus all other forces per length."""
    return _plain(-_linear()[2].equations[coupler.y])


def _named(expression, **more):
    """Replace the package's symbols by their names; a name that is not known is an error."""
    table = {"crank": l2, "coupler": l3, "follower": l4, "bending_stiffness": EI}
    table |= {"mass_per_length": mu, "theta2_rate": omega2, "theta2_acceleration": 0}
    table |= {"sin23": sp.sin(theta2 - theta3), "cos23": sp.cos(theta2 - theta3)}
    table |= {"sine_transmission": -sp.sin(theta3 - theta4)}
    table |= {"cosine_transmission": sp.cos(theta3 - theta4)}
    # The package's rates are per crank speed.
    table |= {"omega3": omega3 / omega2, "alpha3": alpha3 / omega2**2, "alpha4": alpha4 / omega2**2}
    table |= more
    found = {symbol: table[symbol.name] for symbol in expression.free_symbols}
    return sp.expand(expression.subs(found, simultaneous=True))


@cache
def pin_force():
    """Return the force on the coupler at C, along and across it, at constant crank speed."""
    names = ("coupler_inertia", "coupler_first_moment", "follower_inertia")
    inertias = dict(zip(names, (inertia3, first_moment, inertia4), strict=True))
    steady = (part.subs(coupler.acceleration, 0) for part in coupler.pin_force(SPEC))
    return tuple(_named(part, **inertias) for part in steady)


@cache
def _modes():
    return coupler.discretise(SPEC, _linear()[0]).system.arrays


def _without_end_load(expression):
    return expression.subs({coupler.inertia3: 0, coupler.moment3: 0, coupler.inertia4: 0})


@cache
def mode_coefficient():
    """Return what multiplies U_m in the complete equation of mode m, over omega2^2, without F_x."""
    arrays = _modes()
    phi = sp.Symbol("phi", positive=True)
    elastic = _named(arrays["K"].diagonal, m=mode) / omega2**2
    rigid = _named(_without_end_load(arrays["B"].diagonal), m=mode, omega3=sp.sqrt(phi))
    return sp.collect(sp.expand(elastic - rigid), phi), phi


@cache
def coupling_coefficient(m, n):
    """Return what multiplies U_n in the equation of mode m, over omega2^2."""
    return _named(-_without_end_load(_modes()["B"].off_diagonal), m=m, n=n)


@cache
def mode_forcing():
    """Return the right-hand side of mode m over omega2^2, for the deflection over l3."""
    return _named(_modes()["f"].entry, m=mode)


@cache
def _moment(power, trig, number):
    """Return the integral of u^power trig(number pi u) over u from 0 to 1."""
    u = sp.Symbol("u", positive=True)
    if number < 0:
        return _moment(power, trig, -number) * (1 if trig is sp.cos else -1)
    return sp.integrate(u**power * trig(number * sp.pi * u), (u, 0, 1))


@cache
def projected(m, n):
    """Project the linear beam on sin(m pi x/l3) with deflection Y_n sin(n pi x/l3).

    Returns the coefficients of Y_n'' and Y_n and the right-hand side, divided by mu l3 / 2.
    """
    Y, Y_tt, sine, cosine = sp.symbols("Y Y_tt s c", real=True)
    k = n * sp.pi / l3
    values = {y_tt: Y_tt * sine, y_t: 0, y: Y * sine, y_x: Y * k * cosine}
    values |= {y_xx: -Y * k**2 * sine, y_xxxx: Y * k**4 * sine}
    total = sp.S.Zero
    for (power, s, c), factor in sp.Poly(equation().subs(values), x, sine, cosine).terms():
        if s:  # sin(m) sin(n) = (cos(m - n) - cos(m + n))/2
            integral = (_moment(power, sp.cos, m - n) - _moment(power, sp.cos, m + n)) / 2
        elif c:
            integral = (_moment(power, sp.sin, m - n) + _moment(power, sp.sin, m + n)) / 2
        else:
            integral = _moment(power, sp.sin, m)
        total += factor * integral * l3 ** (power + 1)
    total = sp.expand(total * 2 / (mu * l3))
    rest = sp.collect(total.coeff(Y), (force_x, omega3))
    return total.coeff(Y_tt), rest, sp.expand(-total.subs({Y: 0, Y_tt: 0}))
