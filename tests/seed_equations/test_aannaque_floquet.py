"""Aannaque (7.1), (7.2), (7.7), (7.8): systems of chapter 7 and their steady state; J_N."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.floquet import meissner_function
from scipy.integrate import solve_ivp
from seed_ledger import establishes

PERIOD = 2.0
OMEGA = 2.0 * np.pi / PERIOD


def turning_mass(t):
    """Return M, C, K and M' of two freedoms whose mass turns."""
    c, s = np.cos(OMEGA * t), np.sin(OMEGA * t)
    mass = np.array([[2.0 + 0.5 * c, 0.3 * s], [0.3 * s, 1.5 - 0.4 * c]])
    slope = OMEGA * np.array([[-0.5 * s, 0.3 * c], [0.3 * c, 0.4 * s]])
    damping = np.array([[0.2, 0.05], [0.05, 0.1]])
    stiffness = np.array([[9.0 + c, 0.7], [0.7, 21.0 - 2.0 * s]])
    return mass, damping, stiffness, slope


def load(t):
    """Return the true acceleration of the rigid motion."""
    return np.array([np.cos(OMEGA * t), np.sin(2.0 * OMEGA * t)])


def state_matrix(t):
    mass, damping, stiffness, _ = turning_mass(t)
    lower = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    return np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower])


def solved(rates, start, end, begin=0.0):
    found = solve_ivp(rates, (begin, end), start, method="DOP853", rtol=1e-12, atol=1e-13)
    return found.y[:, -1]


def transition(end, begin=0.0):
    columns = [solved(lambda t, y: state_matrix(t) @ y, e, end, begin) for e in np.eye(4)]
    return np.stack(columns, axis=1)


@establishes(
    "Aannaque",
    "7.1",
    printed=r"M\ddot q + C\dot q + Kq = -M\ddot q_r",
    verdict="approximation",
    derived=r"M\ddot q + (C + \omega(M' + A - A^T))\dot q + (K + \omega^2(A' - B))q "
    r"= -M\ddot q_r",
    remark="The instantaneous structure: Coriolis, centripetal and the change of M are dropped, so "
    "that nothing but M' itself drains or feeds energy. Without C the determinant of the "
    "transition matrix is still 1, but single multipliers leave the unit circle; see "
    "docs/instantaneous_form.md.",
)
def test_the_instantaneous_form_is_not_conservative():
    # One freedom: m(t) q'' + k q = 0 against (m q')' + k q = 0.
    def multipliers(whole):
        def rates(t, y):
            m, slope = 1.0 + 0.4 * np.cos(OMEGA * t), -0.4 * OMEGA * np.sin(OMEGA * t)
            drag = slope if whole else 0.0
            return np.array([y[1], -(drag * y[1] + 30.0 * y[0]) / m])

        return np.linalg.eigvals(np.stack([solved(rates, e, PERIOD) for e in np.eye(2)], axis=1))

    # A single mass: both determinants are 1, the mean of m'/m being zero.
    for whole in (True, False):
        assert np.prod(multipliers(whole)).real == pytest.approx(1.0, abs=1e-9)

    def pair(whole):
        def rates(t, y):
            mass, _, stiffness, slope = turning_mass(t)
            drag = slope if whole else np.zeros((2, 2))
            return np.concatenate([y[2:], -np.linalg.solve(mass, drag @ y[2:] + stiffness @ y[:2])])

        return np.linalg.eigvals(np.stack([solved(rates, e, PERIOD) for e in np.eye(4)], axis=1))

    kept, dropped = np.abs(pair(True)), np.abs(pair(False))
    np.testing.assert_allclose(kept, 1.0, atol=1e-9)
    assert np.prod(dropped) == pytest.approx(1.0, abs=1e-9)
    assert np.max(np.abs(dropped - 1.0)) > 1e-3


@establishes(
    "Aannaque",
    "7.2",
    printed=r"\dot y = A(t)y,\; A = \begin{bmatrix}0 & I\\-M^{-1}K & -M^{-1}C\end{bmatrix}",
    verdict="agrees",
    remark="Of (7.1) without its load.",
)
def test_first_order_form_of_the_homogeneous_equation():
    t, y = 0.37, np.array([0.3, -0.2, 1.1, 0.4])
    mass, damping, stiffness, _ = turning_mass(t)
    slope = state_matrix(t) @ y
    np.testing.assert_allclose(slope[:2], y[2:])
    left = mass @ slope[2:] + damping @ y[2:] + stiffness @ y[:2]
    np.testing.assert_allclose(left, 0.0, atol=1e-13)


@establishes(
    "Aannaque",
    "7.7",
    printed=r"y(t) = \psi(t,t_0)y(t_0) + \int_{t_0}^t\psi(t,\tau)h(\tau)d\tau,\; "
    r"h = [0\;\ddot q_r]^T",
    verdict="slip",
    derived=r"h = [0\;{-\ddot q_r}]^T",
    remark="The formula is right; the sign of h contradicts (7.1), whose load is -M q_r''. With "
    "the printed one every deflection has the wrong sign.",
)
@establishes(
    "Aannaque",
    "7.8",
    printed=r"y(0) = [I - \psi(T,0)]^{-1}\int_0^T\psi(T,\tau)h(\tau)d\tau",
    verdict="agrees",
)
def test_variation_of_constants_and_the_periodic_state():
    def rates(t, y):
        return state_matrix(t) @ y + np.concatenate([np.zeros(2), -load(t)])

    nodes, weights = np.polynomial.legendre.leggauss(24)
    times, weights = 0.5 * PERIOD * (nodes + 1.0), 0.5 * PERIOD * weights
    right = sum(
        w * transition(PERIOD, t) @ np.concatenate([np.zeros(2), -load(t)])
        for t, w in zip(times, weights, strict=True)
    )
    start = np.array([0.1, 0.0, -0.2, 0.3])
    whole = transition(PERIOD)
    np.testing.assert_allclose(solved(rates, start, PERIOD), whole @ start + right, atol=1e-9)
    periodic = np.linalg.solve(np.eye(4) - whole, right)
    np.testing.assert_allclose(solved(rates, periodic, PERIOD), periodic, atol=1e-9)
    # With the printed sign the state is that of the opposite load.
    printed = np.linalg.solve(np.eye(4) - whole, -right)
    assert np.max(np.abs(solved(rates, printed, PERIOD) - printed)) > 0.01


def test_meissners_function_of_any_number_of_intervals():
    generator = np.random.default_rng(72)
    for _ in range(20):
        v, phases = generator.uniform(0.3, 6.0, 4), generator.uniform(0.1, 5.0, 4)
        c, s = np.cos(phases), np.sin(phases)

        def ratio(i, k, v=v):
            return 0.5 * (v[i] / v[k] + v[k] / v[i])

        two = c[0] * c[1] - ratio(0, 1) * s[0] * s[1]
        three = c[0] * c[1] * c[2] - ratio(0, 1) * s[0] * s[1] * c[2]
        three -= ratio(0, 2) * s[0] * s[2] * c[1] + ratio(1, 2) * s[1] * s[2] * c[0]
        assert meissner_function(phases[:2], v[:2]) == pytest.approx(two, abs=1e-13)
        assert meissner_function(phases[:3], v[:3]) == pytest.approx(three, abs=1e-13)
    # Equal frequencies: the cosine of the whole phase, for any number.
    assert meissner_function(np.full(180, 0.1), np.full(180, 3.0)) == pytest.approx(
        np.cos(18.0), abs=1e-12
    )
    with pytest.raises(BadInput, match="frequencies"):
        meissner_function([1.0, 1.0], [1.0, 0.0])
