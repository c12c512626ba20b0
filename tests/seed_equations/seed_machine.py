"""What the package itself derives, in this ledger's symbols: coupler, end load, modes."""

from __future__ import annotations

from functools import cache

import sympy as sp
from elastolink.derive.models import coupler
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton, quadratic_action
from seed_derivations import (
    EI,
    alpha2,
    alpha3,
    alpha4,
    force_x,
    l2,
    l3,
    l4,
    mu,
    omega2,
    omega3,
    theta2,
    theta3,
    theta4,
    x,
    y,
)

SPEC = ModelSpec("four_bar", "complete", flexible=("coupler",))
y_x, y_xx, y_xxxx, y_t, y_tt = sp.symbols("y_x y_xx y_xxxx y_t y_tt", real=True)
first_moment, inertia3, inertia4, mode = (
    sp.Symbol(name, positive=True) for name in ("{m_3 r_3}", "I_3", "I_4", "m")
)


def _plain(expression):
    """Replace the package's symbols and functions of time, at constant crank speed."""
    th2, th3, t, place = coupler.th2, coupler.th3, coupler.t, coupler.x
    field = coupler.y
    table = {
        sp.diff(th2, t, 2): alpha2,
        sp.diff(th3, t, 2): alpha3,
        sp.diff(th2, t): omega2,
        sp.diff(th3, t): omega3,
        th2: theta2,
        th3: theta3,
        coupler.end_load: force_x,
        sp.diff(field, place, 4): y_xxxx,
        sp.diff(field, place, 2): y_xx,
        sp.diff(field, place): y_x,
        sp.diff(field, t, 2): y_tt,
        sp.diff(field, t): y_t,
        field: y,
        coupler.crank: l2,
        coupler.coupler: l3,
        coupler.follower: l4,
        coupler.stiffness: EI,
        coupler.density: mu,
        coupler.damping: 0,
        place: x,
    }
    return sp.expand(sp.sympify(expression).xreplace(table).subs(alpha2, 0).doit())


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
    table = {
        "theta2_rate": omega2,
        "theta2_acceleration": 0,
        "crank": l2,
        "coupler": l3,
        "follower": l4,
        "bending_stiffness": EI,
        "mass_per_length": mu,
        "sin23": sp.sin(theta2 - theta3),
        "cos23": sp.cos(theta2 - theta3),
        "sine_transmission": -sp.sin(theta3 - theta4),
        "cosine_transmission": sp.cos(theta3 - theta4),
        # The package's rates are per crank speed.
        "omega3": omega3 / omega2,
        "alpha3": alpha3 / omega2**2,
        "alpha4": alpha4 / omega2**2,
        **more,
    }
    found = {symbol: table[symbol.name] for symbol in expression.free_symbols}
    return sp.expand(expression.subs(found, simultaneous=True))


@cache
def pin_force():
    """Return the force on the coupler at C, along and across it, at constant crank speed."""
    inertias = {
        "coupler_inertia": inertia3,
        "coupler_first_moment": first_moment,
        "follower_inertia": inertia4,
    }
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
