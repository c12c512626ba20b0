"""Aannaque (6.1)-(6.11): Taylor's formula, Newmark's scheme, its consistency and stability."""

from functools import cache

import newmark_scheme as newmark
import numpy as np
import pytest
import sympy as sp
from elastolink.runtime.gallery.newmark_stability import margins, newmark_limit
from elastolink.runtime.integrators.newmark import newmark_rule, step_maps
from seed_ledger import establishes

h, tau = newmark.step, newmark.place
g, b, x = newmark.gamma, newmark.beta, newmark.phase


@establishes(
    "Aannaque",
    "6.1",
    printed=r"f(t_k+\Delta t) = f + \Delta t f' + \dots + \frac{\Delta t^s}{s!}f^{(s)} + R_s,\;"
    r" R_s = \frac{1}{s!}\int f^{(s+1)}(\tau)[t_k+\Delta t-\tau]^s d\tau",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "6.2",
    printed=r"q_{k+1} = q_k + \Delta t\dot q_k + \int (t_{k+1}-\tau)\dot q(\tau)d\tau",
    verdict="slip",
    derived=r"q_{k+1} = q_k + \Delta t\dot q_k + \int (t_{k+1}-\tau)\ddot q(\tau)d\tau",
    remark="A dot is missing, perhaps in the scan alone. For q = t^3 over a step of 1 from t = 1: "
    "8 right, 6.75 with one dot. The part for the velocity is right.",
)
def test_taylors_formula_with_its_remainder():
    for f in (sp.exp(2 * tau), tau**5, sp.sin(tau)):
        for s in (0, 1, 2):
            series = sum(f.diff(tau, k).subs(tau, 1) * h**k / sp.factorial(k) for k in range(s + 1))
            rest = sp.integrate(
                sp.expand(f.diff(tau, s + 1) * (1 + h - tau) ** s), (tau, 1, 1 + h)
            ) / sp.factorial(s)
            assert sp.simplify(series + rest - f.subs(tau, 1 + h)) == 0
    q = tau**3
    start = q.subs(tau, 1) + q.diff(tau).subs(tau, 1)
    right, printed = (
        start + sp.integrate((2 - tau) * q.diff(tau, dots), (tau, 1, 2)) for dots in (2, 1)
    )
    assert right == 8 and printed == sp.Rational(27, 4)
    assert sp.integrate(q.diff(tau, 2), (tau, 1, 2)) == (q.diff(tau).subs(tau, 2) - 3)


@establishes(
    "Aannaque",
    "6.3",
    printed=r"\ddot q_k = \ddot q(\tau) + q^{(3)}(t_k-\tau) + q^{(4)}\frac{(t_k-\tau)^2}{2}+\dots",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "6.4",
    printed=r"\int\ddot q = (1-\gamma)\Delta t\ddot q_k + \gamma\Delta t\ddot q_{k+1} + r_k,\;"
    r" \int(t_{k+1}-\tau)\dot q = (\tfrac12-\beta)\Delta t^2\ddot q_k +"
    r" \beta\Delta t^2\ddot q_{k+1} + r'_k",
    verdict="slip",
    derived=lambda: sp.latex(newmark.displacement_weights().value),
    remark="The weights are right; in the second part the integrand must be the acceleration. The "
    "share of the new end is 2 beta there, not beta, as the text has it: at beta = 1/4 that is "
    "1/2.",
)
@establishes(
    "Aannaque",
    "6.2.1 remainders of Newmark's scheme",
    printed=r"r_k = (\gamma-\tfrac12)\Delta t^2q^{(3)},\; r'_k = (\beta-\tfrac16)\Delta t^3q^{(3)}",
    verdict="slip",
    derived=lambda: sp.latex(newmark.velocity_weights().remainder),
    remark="Both signs are turned: for q = t^3/6, gamma = 1 and a step of 1 the integral is 1/2, "
    "the weighted ends 1, the remainder -1/2; printed +1/2.",
)
def test_weights_and_remainders():
    velocity, place = newmark.velocity_weights(), newmark.displacement_weights()
    old, new, third = newmark.old, newmark.new, newmark.third
    assert sp.expand(velocity.value - ((1 - g) * h * old + g * h * new)) == 0
    assert sp.expand(place.value - ((sp.Rational(1, 2) - b) * h**2 * old + b * h**2 * new)) == 0
    assert sp.expand(velocity.remainder + (g - sp.Rational(1, 2)) * h**2 * third) == 0
    assert sp.expand(place.remainder + (b - sp.Rational(1, 6)) * h**3 * third) == 0
    # q'' = t: 1/2 exactly.
    ends = {old: 0, new: 1, third: 1, h: 1, g: 1}
    assert velocity.value.subs(ends) == 1 and velocity.remainder.subs(ends) == -sp.Rational(1, 2)
    assert velocity.value.subs(ends) + velocity.remainder.subs(ends) == sp.Rational(1, 2)


def _constant(seed, n=3):
    random = np.random.default_rng(seed)
    m, c, k = random.normal(size=(3, n, n))
    mass, stiffness = m @ m.T + n * np.eye(n), k @ k.T + n * np.eye(n)
    return mass, 0.3 * (c + c.T) + np.eye(n), stiffness, random.normal(size=(4, n))


def _march(gamma, beta, step, mass, rate, stiffness, force, count, start):
    """Return displacements and velocities of Newmark steps; arrays over the angles or constant."""
    shaped = [np.broadcast_to(a, (count + 1, *a.shape[-2:])) for a in (mass, rate, stiffness)]
    maps = step_maps(newmark_rule(gamma, beta), *shaped, force[: count + 1], step)
    n = mass.shape[-1]
    states = [np.concatenate([*start, [1.0]])]
    for matrix in maps:
        states.append(matrix @ states[-1])
    found = np.array(states)
    return found[:, :n], found[:, n : 2 * n]


@establishes(
    "Aannaque",
    "6.5",
    printed=r"\dot q_{k+1} = \dot q_k + (1-\gamma)\Delta t\ddot q_k + \gamma\Delta t\ddot q_{k+1},"
    r"\; q_{k+1} = q_k + \Delta t\dot q_k + \Delta t^2(\tfrac12-\beta)\ddot q_k +"
    r" \Delta t^2\beta\ddot q_{k+1}",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "6.6",
    printed=r"Dq_{k+1} = Bq_k - Fq_{k-1} + \beta\Delta t^2[f_{k+1} + (1/\beta-2)f_k + f_{k-1}]",
    verdict="approximation",
    derived=r"\gamma = \tfrac12 \text{ and constant matrices}",
    remark="Right, with its start (6.6.b), for constant matrices and gamma = 1/2. Where the mass "
    "grows from 1 to 1.4 in two steps, with the step's own matrices, it misses the scheme (6.5) "
    "by 1.8 % of the displacement.",
)
def test_the_recurrence_holds_for_constant_matrices_alone():
    step, beta = 0.2, 0.21
    mass, drag, spring, force = _constant(5)
    start = (np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.4, -0.3]))
    q, v = _march(0.5, beta, step, mass, drag, spring, force, 3, start)
    inverse = np.linalg.inv(mass)
    acceleration = [inverse @ (force[k] - drag @ v[k] - spring @ q[k]) for k in range(4)]
    for k in range(3):
        old, new = acceleration[k], acceleration[k + 1]
        np.testing.assert_allclose(v[k + 1], v[k] + step * (0.5 * old + 0.5 * new))
        moved = q[k] + step * v[k] + step**2 * ((0.5 - beta) * old + beta * new)
        np.testing.assert_allclose(q[k + 1], moved)
    left = mass + step / 2 * drag + beta * step**2 * spring
    middle = 2 * mass - (1 - 2 * beta) * step**2 * spring
    before = mass - step / 2 * drag + beta * step**2 * spring
    for k in (1, 2):
        push = force[k + 1] + (1 / beta - 2) * force[k] + force[k - 1]
        right = middle @ q[k] - before @ q[k - 1] + beta * step**2 * push
        np.testing.assert_allclose(left @ q[k + 1], right, rtol=1e-12)
    p = mass + step / 2 * drag - (1 - 2 * beta) / 2 * step**2 * spring
    p -= (1 - 4 * beta) / 4 * step**3 * drag @ inverse @ spring
    big = (mass - (1 - 4 * beta) / 4 * step**2 * drag @ inverse @ drag) * step
    r = ((1 - 2 * beta) / 2 * np.eye(3) + (1 - 4 * beta) / 4 * step * drag @ inverse) * step**2
    first = p @ q[0] + big @ v[0] + beta * step**2 * force[1] + r @ force[0]
    np.testing.assert_allclose(left @ q[1], first, rtol=1e-12)
    # One freedom whose mass grows: M q'' + M' q' + q = 1.
    growing = np.array([1.0, 1.2, 1.4, 1.5])[:, None, None]
    one, push = np.ones((1, 1)), np.ones((4, 1))
    q, _ = _march(0.5, 0.25, 0.5, growing[:3], 0 * one, one, push, 2, (np.zeros(1), np.ones(1)))
    d = growing[2] + 0.25 * 0.25 * one
    guess = (2 * growing[2] - 0.5 * 0.25) @ q[1] - d @ q[0] + 0.25 * 0.25 * 4.0
    missed = abs(np.linalg.solve(d, guess)[0] / q[2, 0] - 1.0)
    assert missed == pytest.approx(0.018, abs=5e-4)


@establishes(
    "Aannaque",
    "6.7",
    printed=r"\lim_{\Delta t\to0}\frac{y_{k+1}-y_k}{\Delta t} ="
    r" \begin{bmatrix}\ddot q_k\\ \dot q_k\end{bmatrix} = \dot y_k",
    verdict="agrees",
    remark="The order of the state is that of the velocity first, elsewhere the displacement comes "
    "first; the scan's second row has lost the velocity itself.",
)
@establishes(
    "Aannaque",
    "6.8",
    printed=r"y_{k+1} = B^{k+1}y_0 + \sum_{j=0}^{k+1}B^{k-j+1}g_j",
    verdict="slip",
    derived=r"y_{k+1} = B^{k+1}y_0 + \sum_{j=1}^{k+1}B^{k-j+1}g_j",
    remark="There is no step into the start: with B = 1/2, y_0 = 1 and all g = 1 the first step "
    "leads to 3/2; the printed sum gives 2.",
)
def test_consistency_and_the_sum_of_the_loads():
    slopes = (newmark.amplification().subs(newmark.damping, 0) - sp.eye(2)).applyfunc(sp.simplify)
    # On (q, h q'): the increments over h, with phase = omega h.
    omega, q, v = sp.symbols("omega q v")
    moved = (slopes * sp.Matrix([q, h * v])).subs(x, omega * h)
    assert sp.limit(moved[0] / h, h, 0) == v
    assert sp.simplify(sp.limit(moved[1] / h**2, h, 0) + omega**2 * q) == 0
    matrix, state, k = sp.Rational(1, 2), sp.S.One, 3
    for _ in range(k + 1):
        state = matrix * state + 1
    right = matrix ** (k + 1) + sum(matrix ** (k - j + 1) for j in range(1, k + 2))
    printed = matrix ** (k + 1) + sum(matrix ** (k - j + 1) for j in range(k + 2))
    assert state == right and printed - right == matrix ** (k + 1)
    assert matrix + 1 == sp.Rational(3, 2) and matrix + 1 + matrix == 2


@cache
def undamped():
    return newmark.amplification(sp.S.Zero)


mu2 = x**2 / (1 + b * x**2)


@establishes(
    "Aannaque",
    "6.9",
    printed=r"B = \begin{bmatrix}1-\tfrac12\mu^2 & \frac{\Delta t}{1+\beta\omega^2\Delta t^2}\\"
    r"-\omega^2\Delta t(1-\tfrac\gamma2\mu^2) & 1-\gamma\mu^2\end{bmatrix}",
    verdict="agrees",
    derived=lambda: sp.latex(undamped()),
)
@establishes(
    "Aannaque",
    "6.10",
    printed=r"\lambda^2 - \lambda(2-(\gamma+\tfrac12)\mu^2) + 1 - (\gamma-\tfrac12)\mu^2 = 0",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "6.11",
    printed=r"(\gamma+\tfrac12)^2 - 4\beta \le \frac{4}{\omega^2\Delta t^2}",
    verdict="agrees",
    derived=lambda: sp.latex(newmark.margins(sp.S.Zero).turning) + r" \ge 0",
)
@establishes(
    "Aannaque",
    "6.2.3 modulus and angle of the multiplier",
    printed=r"\rho = \sqrt{1-(\gamma-\tfrac12)\mu^2},\; \theta = \tan^{-1}"
    r"\frac{\mu\sqrt{1-\frac14(\gamma+\frac12)^2\mu^2}}{1-\frac12(\gamma+\frac12)\mu^2}",
    verdict="agrees",
    remark="Beyond a quarter turn the angle is the arc tangent plus pi.",
)
def test_the_amplification_matrix_and_its_eigenvalues():
    half = sp.Rational(1, 2)
    # The printed one is on (q, q'): the step stands apart.
    printed = sp.Matrix(
        [[1 - mu2 / 2, 1 / (1 + b * x**2)], [-(x**2) * (1 - g * mu2 / 2), 1 - g * mu2]]
    )
    assert (undamped() - printed).applyfunc(sp.simplify) == sp.zeros(2)
    trace, determinant = printed.trace(), printed.det()
    assert sp.simplify(trace - (2 - (g + half) * mu2)) == 0
    assert sp.simplify(determinant - (1 - (g - half) * mu2)) == 0
    turning = newmark.margins(sp.S.Zero).turning
    assert sp.simplify(turning - x**2 * (4 / x**2 - (g + half) ** 2 + 4 * b) / 4) == 0
    rest = sp.simplify(determinant - trace**2 / 4 - mu2 * (1 - (g + half) ** 2 * mu2 / 4))
    assert rest == 0


@establishes(
    "Aannaque",
    "6.2.3 unconditional stability",
    printed=r"\gamma \ge \tfrac12,\; \beta \ge \tfrac14(\gamma+\tfrac12)^2",
    verdict="approximation",
    derived=r"\gamma \ge \tfrac12,\; \beta \ge \tfrac12\gamma",
    remark="Enough, not needed: with two real multipliers the steps are stable as well, down to "
    "gamma/2. At gamma = 0.9 and beta = 0.46, below the printed 0.49, no step is unstable; at "
    "0.44 those with omega h beyond 10 are.",
)
@establishes(
    "Aannaque",
    "6.2.3 damping and the limits of stability",
    printed=r"\text{damping stabilises below a critical ratio}",
    verdict="agrees",
    derived=lambda: sp.latex(newmark.margins().flip) + r" \ge 0",
    remark="It does for gamma below 1/2: at gamma = 0.4, beta = 0.1 the longest step omega h grows "
    "from 0 to 3.01 at a ratio of 0.15 and falls again. At 1/2 it changes nothing.",
)
def test_limits_of_stability():
    flip = newmark.margins(sp.S.Zero).flip
    assert sp.simplify(flip - (4 + 2 * x**2 * (2 * b - g))) == 0
    assert 0.46 < 0.25 * (0.9 + 0.5) ** 2 < 0.5
    assert np.isinf(newmark_limit(0.9, 0.46)) and np.isinf(newmark_limit(0.9, 0.4901))
    assert newmark_limit(0.9, 0.44) == pytest.approx(10.0, rel=1e-9)
    ratios = np.linspace(0.0, 1.0, 201)
    limits = newmark_limit(0.4, 0.1, ratios)
    best = int(np.argmax(limits))
    assert limits[0] == 0.0 and limits[best] == pytest.approx(3.01, abs=0.01)
    assert ratios[best] == pytest.approx(0.15, abs=0.01) and limits[-1] < limits[best]
    np.testing.assert_allclose(newmark_limit(0.5, 0.1, ratios), newmark_limit(0.5, 0.1))


def test_the_margins_of_the_gallery_are_the_derived_ones():
    found = newmark.margins()
    z = newmark.damping
    parts = (found.growth, found.flip, found.static, found.turning / found.denominator)
    exact = sp.lambdify((g, b, z, x), [part / found.denominator for part in parts])
    numbers = np.random.default_rng(1).uniform(0.0, 2.0, (4, 200))
    for value, wanted in zip(margins(*numbers), exact(*numbers), strict=True):
        np.testing.assert_allclose(value, wanted, rtol=1e-12, atol=1e-13)


def test_a_change_of_the_interpolation_moves_the_scheme():
    # With all of the new end, the implicit scheme of first order.
    assert sp.expand(newmark.velocity_weights().value.subs(g, 1) - h * newmark.new) == 0
    assert newmark.velocity_weights().remainder.subs(g, sp.Rational(1, 2)) == 0
    assert newmark.displacement_weights().remainder.subs(b, sp.Rational(1, 6)) == 0
