"""The overhang modes' derivation: what it solves, what it proves, and what moves with it."""

import mpmath
import pytest
import sympy as sp
from elastolink.derive.models import overhang_integrals
from elastolink.derive.models.overhang_integrals import MODE, Ends, eta, place
from elastolink.derive.models.overhang_waves import SPAN, Wave, proven
from elastolink.derive.projection.greens_identity import NoPrimitive
from elastolink.derive.safe import UnsafeRewriting
from overhang_reference import DIGITS, mode_at


def test_a_wrong_form_is_refused():
    with pytest.raises(UnsafeRewriting):
        proven(SPAN.odd, 2 * SPAN.fade * sp.cosh(SPAN.phase))
    with pytest.raises(NoPrimitive):
        overhang_integrals.square_primitive.__wrapped__(((MODE, 0), (MODE, 0)), -1)


def test_waves_near_zero_and_far_away():
    wave = Wave.of("v")
    for value in (1e-9, 0.3, 1.5, 1.6, 20.0, 400.0):
        numbers = {}
        with mpmath.workdps(400):
            for symbol, expression in wave.steps(sp.Float(value, 400)):
                numbers[symbol] = sp.sympify(expression).subs(numbers).evalf(60)
            v = mpmath.mpf(value)
            scale = 2 * mpmath.exp(-v)
            excess = scale * (mpmath.sinh(v) - mpmath.sin(v))
            spread = scale * (mpmath.cosh(v) - mpmath.cos(v))
            # The series leaves out less than the last digit of a double.
            assert abs(mpmath.mpf(str(numbers[wave.excess])) / excess - 1) < 1e-17
            assert abs(mpmath.mpf(str(numbers[wave.spread])) / spread - 1) < 1e-17


@pytest.mark.parametrize(
    "power", [1, *(pytest.param(k, marks=pytest.mark.slow) for k in (0, 2, 3))]
)
def test_weights_that_the_model_does_not_use(power):
    """Metamorphic: any polynomial tension, from the same identity, against quadrature."""
    from overhang_reference import product

    pair, one = (Ends.of("_1"), Ends.of("_2")), Ends.of()
    weight = eta**power
    closed = overhang_integrals.in_roots(
        overhang_integrals.pair_integral(weight, (MODE, 1), (MODE, 1), pair), pair
    ).subs(*overhang_integrals.gap_step(pair))
    own = overhang_integrals.square_integral((MODE, 1), (MODE, 1), power, one)
    with mpmath.workdps(DIGITS):
        xi = mpmath.mpf("0.37")
        modes = [mode_at(xi, start) for start in (2.5, 5.9)]
        roots = [mode.beta for mode in modes]
        assert abs(roots[0] - roots[1]) > 1
        numbers = {place: xi}
        for ends, mode in zip(pair, modes, strict=True):
            numbers |= values_at(ends, mode)
        exact = product(*modes, (1, 1), lambda x: x**power)
        assert abs(evaluate(closed, numbers) - exact) < mpmath.mpf(10) ** -40
        exact = product(modes[0], modes[0], (1, 1), lambda x: x**power)
        found = evaluate(own, {place: xi, **values_at(one, modes[0])})
        assert abs(found - exact) < mpmath.mpf(10) ** -40


def values_at(ends, mode):
    """Return the end values of a mode in many digits, by symbol."""
    beyond = {"pin": False, "before": False, "after": True, "tip": True}
    where = {"pin": 0, "before": mode.xi, "after": mode.xi, "tip": 1}
    found = {ends.beta: mode.beta}
    for (at, kind, order), symbol in ends.values.items():
        if kind != MODE:
            continue
        found[symbol] = mode.side(where[at], order, beyond[at])
        if at == "after":
            found[symbol] -= mode.side(where[at], order, False)
    return found


def evaluate(expression, numbers):
    """Return the value of an expression in many digits."""
    return sp.lambdify(list(numbers), expression, "mpmath")(*numbers.values())
