"""Green's identity by machine, and what it gives for free-free beams."""

import free_free_truth as truth
import mpmath
import pytest
import sympy as sp
from elastolink.derive.models import free_free_modes as ff
from elastolink.derive.projection import greens_identity
from elastolink.derive.projection.greens_identity import NoPrimitive, integral, primitive

S = ff.MIDDLE
B, C = sp.symbols("b4 c4", positive=True)
HALF = sp.Rational(1, 2)


def at_ends(i, j):
    """Return the derivatives of two modes at the ends, in many digits."""

    def value(which, order, end):
        place = mpmath.mpf(0.5 if end > 0 else -0.5)
        return sp.Float(truth.mode((i, j)[which], place, order), 50)

    return value


@pytest.mark.parametrize("power", [0, 1, 2, 3])
@pytest.mark.parametrize("orders", [(1, 1), (0, 2), (0, 3), (2, 2)])
@pytest.mark.parametrize("pair", [(1, 2), (2, 4), (3, 3)])
def test_integrals_from_end_values(power, orders, pair):
    """Against integrals of exponentials: no step in common."""
    constants = (B, B if pair[0] == pair[1] else C)
    form = primitive(S**power, S, orders, constants)
    found = integral(form, S, (-HALF, HALF), at_ends(*pair))
    numbers = {B: sp.Float(truth.root(pair[0]), 50) ** 4, C: sp.Float(truth.root(pair[1]), 50) ** 4}
    exact = truth.integral(power, *pair, orders)
    assert abs(found.subs(numbers).evalf(40) - sp.Float(exact, 50)) < 1e-25 * (1 + abs(exact))


def test_a_form_with_another_derivative_is_refused(monkeypatch):
    right = greens_identity._solve_by_parts

    def wrong(*arguments):
        return {
            place: value * (2 if place == (0, 0) else 1)
            for place, value in right(*arguments).items()
        }

    monkeypatch.setattr(greens_identity, "_solve_by_parts", wrong)
    with pytest.raises(NoPrimitive, match="derivatives"):
        primitive.__wrapped__(S, S, (1, 1), (B, C))  # without the cache
