"""Machine derivations of this ledger: loop closure, and an element of the moving coupler.

SymPy starts from the closure of the four bars and from the position of an element; no printed
formula enters.  Tests compare both with numeric truth.
"""

from __future__ import annotations

from functools import cache

import sympy as sp
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


@cache
def closure_rows(order):
    """Return the horizontal and vertical closure, differentiated ``order`` times by time."""
    angles = _moving()
    crank, coupler, follower = (
        sp.Matrix([length * sp.cos(a), length * sp.sin(a)])
        for length, a in zip((l2, l3, l4), angles, strict=True)
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
    return {
        "A": sp.factor(linear.coeff_monomial(cosine)),
        "B": linear.coeff_monomial(1),
        "C": sp.factor(linear.coeff_monomial(sine)),
    }


@cache
def follower_cosine():
    """Solve A c + B + C s = 0, c^2 + s^2 = 1 for the cosine, both roots."""
    A, B, C, cosine = sp.symbols("A B C c", real=True)
    quadratic = sp.expand((A * cosine + B) ** 2 - C**2 * (1 - cosine**2))
    return sp.solve(quadratic, cosine), (A, B, C)


def _position(along, across):
    """Return fixed-axes coordinates of an element, and the unit vectors along and across BC."""
    crank, coupler, _ = _moving()
    unit = sp.Matrix([sp.cos(coupler), sp.sin(coupler)])
    normal = sp.Matrix([-sp.sin(coupler), sp.cos(coupler)])
    pin = l2 * sp.Matrix([sp.cos(crank), sp.sin(crank)])
    return pin + along * unit + across * normal, unit, normal


def _components(vector, unit, normal):
    """Return the components of a vector along and across the undeflected coupler."""
    return [sp.trigsimp(sp.expand(vector.dot(axis))) for axis in (unit, normal)]


@cache
def element_acceleration():
    """Return the acceleration of the element at (x, y) along and across the undeflected coupler.

    The crank turns at constant speed; y is a function of time alone.
    """
    deflection = sp.Function("y")(t)
    position, unit, normal = _position(x, deflection)
    y_t, y_tt = sp.symbols("y_t y_tt", real=True)
    plain = {sp.diff(deflection, t, 2): y_tt, sp.diff(deflection, t): y_t, deflection: y}
    components = tuple(
        sp.trigsimp(_still(part.subs(plain), _moving()).subs(alpha2, 0))
        for part in _components(position.diff(t, 2), unit, normal)
    )
    return components, (y_t, y_tt)
