"""Green's identity by machine, and what it gives for free-free beams and the rod made of them."""

from __future__ import annotations

import free_free_truth as truth
import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import free_free_modes as ff
from elastolink.derive.models import free_free_rod as rod
from elastolink.derive.projection import greens_identity
from elastolink.derive.projection.greens_identity import (
    NoPrimitive,
    integral,
    primitive,
)

S = ff.MIDDLE
B, C = sp.symbols("b4 c4", positive=True)
HALF = sp.Rational(1, 2)


def at_ends(i, j):
    """Return the derivatives of two modes at the ends, in many digits."""

    def value(which, order, end):
        return mode_number((i, j)[which], order, end)

    return value


def mode_number(i, order, end):
    return sp.Float(truth.mode(i, mpmath.mpf(0.5 if end > 0 else -0.5), order), 50)


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


def inward_numbers(count):
    """Return ``int s alpha_ij ds = -1/2 int (1/4 - s^2)/2 psi_i' psi_j' ds`` by parts."""
    found = {}
    for i in range(1, count + 1):
        for j in range(i, count + 1):
            plain, second = (truth.integral(k, i, j, (1, 1)) for k in (0, 2))
            found[sp.Symbol(f"inward_{i}_{j}")] = float((second - plain / 4) / 4)
    return found


@pytest.mark.parametrize("tension", [True, False])
def test_kinetic_energy_is_that_of_the_material_points(tension):
    """Against quadrature of the squared velocity, the foreshortening integrated numerically."""
    count, t = 3, rod._T
    moments = rod.Moments(count, tension)
    energy = rod.kinetic_energy(moments)
    random = np.random.default_rng(5)
    names = (rod._R1, rod._R2, rod._GAMMA, *moments.f)
    q, qd = random.normal(size=(2, 3 + count))
    q[3:], qd[3:] = 1e-3 * q[3:], 1e-3 * qd[3:]
    values = {sp.Derivative(n, t): v for n, v in zip(names, qd, strict=True)}
    values |= dict(zip(names, q, strict=True))
    numbers = {rod._MASS: 1.7, rod._LENGTH: 1.3, **inward_numbers(count)}
    found = float(energy.xreplace(values).subs(numbers))
    assert found == pytest.approx(_by_quadrature(q, qd, tension, 1.7, 1.3), rel=1e-10)


def _by_quadrature(q, qd, tension, mass, length):
    """Return the kinetic energy to the second order in the amplitudes."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    s = nodes / 2
    shapes = [
        np.array([[float(truth.mode(i, mpmath.mpf(x), k)) for x in s] for i in (1, 2, 3)])
        for k in (0, 1)
    ]
    f, fd = q[3:], qd[3:]

    def shortened(a, b):
        """Return the primitive without mean of minus the product of slopes of a and b."""
        rate = -(a @ shapes[1]) * (b @ shapes[1])
        series = np.polynomial.legendre.Legendre.fit(nodes, rate / 2, 59, domain=[-1, 1]).integ()
        primitive_ = series(nodes)
        return primitive_ - np.sum(weights * primitive_) / 2

    along = np.array([np.cos(q[2]), np.sin(q[2])])
    across = np.array([-np.sin(q[2]), np.cos(q[2])])
    a = shortened(f, f) / 2 if tension else 0 * s
    rate = shortened(f, fd) if tension else 0 * s
    u, ud = f @ shapes[0], fd @ shapes[0]
    rigid = np.outer(qd[:2], np.ones_like(s)) + length * np.outer(across, qd[2] * s)
    first = length * (np.outer(along, -qd[2] * u) + np.outer(across, ud))
    second = length * (np.outer(along, rate) + np.outer(across, qd[2] * a))
    squared = np.sum((rigid + first) ** 2 + 2 * rigid * second, axis=0)
    return mass * length / 2 * np.sum(weights * squared) / 2
