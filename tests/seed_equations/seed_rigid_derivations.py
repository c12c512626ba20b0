"""Machine derivations for rigid linkages: Newton-Euler, clearance, balanced bar, Freudenstein.

SymPy starts from positions of the centres of mass, from the cosine rule and from integrals over a
bar and a cylinder; no printed formula enters.
"""

from __future__ import annotations

from functools import cache

import sympy as sp
from seed_derivations import (
    _moving,
    _still,
    alpha2,
    alpha3,
    alpha4,
    l1,
    l2,
    l3,
    l4,
    t,
    theta2,
    theta3,
    theta4,
)

MASSES = M2, M3, M4 = sp.symbols("M_2 M_3 M_4", positive=True)
RADII = r2, r3, r4 = sp.symbols("r_2 r_3 r_4", real=True)
INERTIAS = I2A, I3B, I4D = sp.symbols("I_{2A} I_{3B} I_{4D}", positive=True)
PINS = sp.symbols("X_12 Y_12 X_23 Y_23 X_34 Y_34 X_41 Y_41", real=True)
X12, Y12, X23, Y23, X34, Y34, X41, Y41 = PINS
T = sp.Symbol("T", real=True)
phi, bd, c, delta = sp.symbols("phi BD c delta", positive=True)
K = sp.Symbol("K", positive=True)


def _unit(angle):
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


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


def _moment(arm, force):
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
        moment = _moment(arms[0], before) + _moment(arms[1], behind)
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
    pair = [
        sp.Matrix([[right[0], matrix[0, 1]], [right[1], matrix[1, 1]]]).det(),
        sp.Matrix([[matrix[0, 0], right[0]], [matrix[1, 0], right[1]]]).det(),
    ]
    known[X34], known[Y34] = (_tidy(top) / divisor for top in pair)
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
    """Return the coefficients of u^2, u, 1 for u = tan(t/2) of the follower or the coupler."""
    u = sp.Symbol("u", real=True)
    angle = TURNS[1] if coupler else TURNS[2]
    halves = {sp.cos(angle): (1 - u**2) / (1 + u**2), sp.sin(angle): 2 * u / (1 + u**2)}
    rest = sp.expand(sp.expand(freudenstein()[coupler]).subs(halves) * (1 + u**2))
    parts = sp.Poly(sp.cancel(sp.together(rest)), u).all_coeffs()
    return tuple(sp.collect(sp.expand(part), sp.cos(TURNS[0])) for part in parts)


FREUDENSTEIN = sp.symbols("L_1 L_2 L_3 L_4", positive=True)
TURNS = sp.symbols("t_1 t_2 t_3", real=True)
