"""Newmark's scheme as derived: weights, remainders, amplification, limits of stability."""

import numpy as np
import pytest
import sympy as sp
from elastolink.derive.checks import judge, worst
from elastolink.derive.models import newmark
from elastolink.generated import newmark_stability
from newmark_truth import exact_newmark


def test_the_weights_are_those_of_an_exact_integral():
    # An acceleration that is linear in time: the weighted ends and the remainder are everything.
    start, rise = sp.symbols("start rise")
    for found, kernel in (
        (newmark.velocity_weights(), sp.S.One),
        (newmark.displacement_weights(), newmark.step - newmark.place),
    ):
        exact = sp.integrate(
            sp.expand(kernel * (start + rise * newmark.place)), (newmark.place, 0, newmark.step)
        )
        ends = {
            newmark.old: start,
            newmark.new: start + rise * newmark.step,
            newmark.third: rise,
        }
        assert sp.expand((found.value + found.remainder).subs(ends) - exact) == 0


def test_a_change_of_the_interpolation_moves_the_scheme():
    # With all of the new end, the implicit scheme of first order.
    found = newmark.velocity_weights().value.subs(newmark.gamma, 1)
    assert sp.expand(found - newmark.step * newmark.new) == 0
    assert newmark.velocity_weights().remainder.subs(newmark.gamma, sp.Rational(1, 2)) == 0
    assert newmark.displacement_weights().remainder.subs(newmark.beta, sp.Rational(1, 6)) == 0


def test_the_matrix_is_the_exact_step_to_the_order_of_the_scheme():
    matrix = newmark.amplification()
    z, x = newmark.damping, newmark.phase
    # Of (q, h q') over the time in steps.
    generator = sp.Matrix([[0, 1], [-(x**2), -2 * z * x]])
    exact = sum((generator**k / sp.factorial(k) for k in range(7)), sp.zeros(2))
    half = {newmark.gamma: sp.Rational(1, 2)}
    # h q' is of the order of the step, so that its column may miss one order more.
    for found, wanted, order in zip(matrix, exact, (3, 2, 3, 2), strict=True):
        gap = sp.series(sp.together(found.subs(half) - wanted), x, 0, order).removeO()
        assert sp.simplify(gap) == 0


def test_the_emitted_margins_are_exact_and_those_of_the_eigenvalues():
    names = newmark_stability.RETURNS["margins"]
    found = worst(
        judgement
        for at in exact_newmark()
        for judgement in judge(newmark_stability.margins, names, at)
    )
    for item in found.values():
        assert item.error <= 32 * 2.0**-53 * item.fair
    random = np.random.default_rng(3)
    values = random.uniform(0.0, 1.0, (200, 3)) * (1.2, 0.6, 0.5)
    phases = 10.0 ** random.uniform(-1.0, 2.0, 200)
    matrix = sp.lambdify(
        (newmark.gamma, newmark.beta, newmark.damping, newmark.phase), newmark.amplification()
    )
    for (gamma, beta, damping), phase in zip(values, phases, strict=True):
        growth, flip, static, turning = newmark_stability.margins(gamma, beta, damping, phase)
        roots = np.linalg.eigvals(np.array(matrix(gamma, beta, damping, phase), dtype=float))
        inside = np.max(np.abs(roots)) < 1.0
        assert inside == (min(growth, flip, static) > 0.0)
        assert (abs(roots[0].imag) > 0.0) == (turning > 0.0)
        assert growth == pytest.approx(1.0 - np.prod(roots).real, rel=1e-10, abs=1e-12)
