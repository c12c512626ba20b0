"""Machine derivations of the four-bar linkage: clearance, balancing, and its flexible coupler.

SymPy starts from positions of elements, from the cosine rule and from integrals over a bar and a
cylinder; the coupler's field equation and its modes are the package's own.  No printed formula
enters.
"""

from functools import cache

import sympy as sp
from elastolink.derive.models import coupler
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton, quadratic_action

l1, l2, l3, l4 = sp.symbols("ell_1 ell_2 ell_3 ell_4", positive=True)
theta2, theta3, theta4 = sp.symbols("theta_2 theta_3 theta_4", real=True)
omega2, omega3 = sp.symbols("omega_2 omega_3", real=True)
alpha3, alpha4 = sp.symbols("alpha_3 alpha_4", real=True)
EI, mu, force_x, x, y = sp.symbols("EI mu F_x x y", real=True)


def _unit(angle):
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


@cache
def element_acceleration():
    """Return the acceleration of the element at (x, y) along and across the undeflected coupler.

    The crank turns at constant speed; y is a function of time alone.
    """
    t, y_t, y_tt = sp.symbols("t y_t y_tt", real=True)
    angle = theta3 + omega3 * t + alpha3 * t**2 / 2
    deflection = y + y_t * t + y_tt * t**2 / 2
    place = l2 * _unit(theta2 + omega2 * t) + x * _unit(angle)
    place += deflection * _unit(angle + sp.pi / 2)
    found = place.diff(t, 2).subs(t, 0)
    axes = _unit(theta3), _unit(theta3 + sp.pi / 2)
    return tuple(sp.trigsimp(sp.expand(found.dot(axis))) for axis in axes), (y_t, y_tt)


# Clearance and balancing.

phi, bd, c, delta = sp.symbols("phi BD c delta", positive=True)
K = sp.Symbol("K", positive=True)


@cache
def cosine_change(sign):
    """Return cos(BDC) less its nominal value when BC is longer (+1) or shorter (-1) by c/2."""
    cosine = [(bd**2 + l4**2 - side**2) / (2 * bd * l4) for side in (l3 + sign * c / 2, l3)]
    return sp.factor(sp.expand(cosine[0] - cosine[1]))


@cache
def clearance_series():
    """Return the coefficients of c, c^2, c^3 in phi' - phi, phi being the nominal angle BDC."""
    shift = sp.Symbol("shift", real=True)
    slope = -sp.diff(cosine_change(1), c) / sp.sin(phi + shift)
    derivative, coefficients = slope, []
    for order in (1, 2, 3):
        value = sp.simplify(derivative.subs({shift: 0, c: 0}))
        coefficients.append(value / sp.factorial(order))
        derivative = derivative.diff(c) + slope * derivative.diff(shift)
    return tuple(coefficients)


L, M, h, rho = sp.symbols("L M h rho", positive=True)


@cache
def balanced_bar():
    """Return extension, mass and radius of the cylinder and the inertia about the pivot.

    Bar and extension have one mass per length; the cylinder's axis stands across the plane.
    """
    x, s, radius, place, weight = sp.symbols("x s r_c ell m_c", positive=True)
    bar = sp.integrate(M / L * x**2, (x, -place, L))
    spin = sp.integrate(h * rho * s**2 * 2 * sp.pi * s, (s, 0, radius))
    volume = sp.integrate(h * 2 * sp.pi * s, (s, 0, radius))
    needed = sp.solve(sp.integrate(M / L * x, (x, -place, L)) - weight * place, weight)[0]
    squared = sp.solve(volume * rho - weight, radius**2)[0]
    spin = sp.expand(spin.subs(radius**4, squared**2))
    found = {"m": M / L * place, "m_c": weight, "r_c": sp.sqrt(squared)}
    found["I_G"] = sp.expand(bar + spin + weight * place**2)
    return {k: form.subs(weight, needed).subs(place, delta * L) for k, form in found.items()}


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
