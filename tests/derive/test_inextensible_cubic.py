"""Expansions of the inextensible coupler, and the law of frequency against amplitude."""

import mpmath
import pytest
import sympy as sp
from elastolink.derive.amplitudes import ORDER, SMALL, composed, kept, product, tangent
from elastolink.derive.models import amplitude_law, four_bar, inextensible_cubic, slider_crank
from linkage_truth import angles

A, B = sp.symbols("a b")


def test_products_keep_what_is_up_to_fourth_order():
    one, other = A + SMALL**3 + SMALL**5, SMALL * B + SMALL**2
    assert kept(one) == A + SMALL**3
    assert sp.expand(product(one, other) - SMALL * A * B - SMALL**2 * A - SMALL**4 * B) == 0


def test_functions_of_second_order_changes():
    u = SMALL**2 * A + SMALL**4 * B
    found = composed(sp.sin(A) * B**2, {A: u, B: SMALL**2})
    whole = (sp.sin(A) * B**2).subs({A: A + u, B: B + SMALL**2}, simultaneous=True)
    left = sp.series(whole, SMALL, 0, ORDER + 1).removeO() - found
    assert sp.simplify(sp.expand(kept(left))) == 0


@pytest.mark.parametrize("modes", [(1,), (1, 2), (2, 3), (1, 2, 3)])
def test_harmonics_of_a_tangent_are_those_of_the_circle(modes):
    """Cosine and sine of the angle along the link, but for the fifth order and beyond."""
    amplitudes = dict(zip(modes, (sp.Rational(7, 10), sp.Rational(-3, 5), 1), strict=False))
    parts = tangent({sp.Integer(k): SMALL * a for k, a in amplitudes.items()})
    place = sp.Rational(3, 10)
    angle = sum(a * sp.cos(k * sp.pi * place) for k, a in amplitudes.items())
    for part, trig in zip(parts, (sp.cos, sp.sin), strict=True):
        found = sum(value * sp.cos(n * sp.pi * place) for n, value in part.items())
        expected = sp.series(trig(SMALL * angle), SMALL, 0, ORDER + 1).removeO()
        gaps = sp.Poly(sp.expand(found - expected), SMALL).coeffs()
        assert all(abs(sp.N(gap, 30)) < 1e-28 for gap in gaps)


def _solved(mechanism, crank_angle, chord):
    """Return the chord's angle and what it drives, by the length of the coupler over its own."""
    if mechanism == "four_bar":
        return angles(crank_angle, mpmath.mpf(5), mpmath.mpf(1), 4 * chord, mpmath.mpf(2), 1)
    sine = (mpmath.mpf("0.3") - mpmath.sin(crank_angle)) / (4 * chord)
    theta3 = mpmath.asin(sine)
    return theta3, mpmath.cos(crank_angle) + 4 * chord * mpmath.cos(theta3)


@pytest.mark.parametrize("mechanism", ["four_bar", "slider_crank"])
def test_places_by_the_chord_are_derivatives_of_the_solved_loop(mechanism):
    kinematics = four_bar if mechanism == "four_bar" else slider_crank
    numbers = {kinematics.theta2: sp.Rational(9, 10), kinematics.crank: 1, kinematics.coupler: 4}
    numbers[kinematics.assembly] = 1
    if mechanism == "four_bar":
        numbers |= {four_bar.frame: 5, four_bar.follower: 2}
    else:
        numbers[slider_crank.offset] = sp.Rational(3, 10)
    linkage = inextensible_cubic.rigid_linkage(mechanism)
    found = dict(numbers)
    steps = [*linkage.solved.steps.steps, *inextensible_cubic.closure_by_chord(linkage)]
    for symbol, value in steps:
        found[symbol] = sp.N(value.subs(found), 40)
    orders = {"by_u": (0, 1), "by_u_speed": (1, 1), "by_u_bend": (2, 1), "by_uu": (0, 2)}
    with mpmath.workdps(60):
        for place, coordinate in enumerate(linkage.rates):
            for name, order in orders.items():
                expected = mpmath.diff(
                    lambda a, c, place=place: _solved(mechanism, a, c)[place],
                    (mpmath.mpf(9) / 10, mpmath.mpf(1)),
                    order,
                )
                symbol = sp.Symbol(f"{coordinate.func.__name__}_{name}", real=True)
                assert mpmath.almosteq(expected, mpmath.mpf(str(found[symbol])), 1e-15, 1e-15)


def test_law_is_the_one_derived_from_lagranges_equations():
    """An independent derivation: Poincare and Lindstedt's series of Lagrange's equations.

    Its terms, over -(k pi)^4 / 8: the follower's inertia; the motion of the points along the chord
    and the cubic part of the deflection; the turning of the chord and the slaved motion of k; and
    those of the modes m.
    """
    k, m = amplitude_law.MODE, amplitude_law.OTHER
    gamma, mass = sp.symbols("transmission_angle driven_mass", positive=True)
    squares = (k * sp.pi) ** 2
    turning = sp.Rational(1, 3) - 2 / squares
    alone = mass / sp.sin(gamma) ** 2 + sp.Rational(1, 3) - sp.Rational(15, 8) / squares
    alone += turning * sp.cot(gamma) ** 2
    beside = 8 / sp.pi**2 * k**4 / (m**2 * (m**4 - 4 * k**4)) * sp.cot(gamma) ** 2
    for mechanism in ("four_bar", "slider_crank"):
        for found, expected in zip(amplitude_law.law(mechanism), (alone, beside), strict=True):
            gap = (found + squares**2 / 8 * expected).rewrite(sp.tan).subs(sp.tan(gamma / 2), mass)
            assert sp.cancel(gap.subs(sp.tan(gamma), 2 * mass / (1 - mass**2))) == 0
