"""Aannaque (7.3)-(7.6), (7.9)-(7.11): Floquet, constant intervals, Meissner's functions."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm, logm
from seed_ledger import establishes
from seed_truth import normalised_solutions

PERIOD = 2.0
OMEGA = 2.0 * np.pi / PERIOD


def coefficients(t):
    """Return A(t) of (7.2) for two freedoms with a damper and periodic, coupled springs."""
    wave = np.cos(OMEGA * t)
    stiffness = np.array([[5.0 + 1.5 * wave, 0.7], [0.7, 11.0 - 2.0 * np.sin(OMEGA * t)]])
    damping = np.array([[0.2, 0.05], [0.05, 0.1]])
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -damping]])


def transition(end, start=0.0):
    """Return the matrix from a start to an end, backwards too."""
    n = 4

    def rates(t, state):
        return (coefficients(t) @ state.reshape(n, n)).ravel()

    found = solve_ivp(
        rates, (start, end), np.eye(n).ravel(), method="DOP853", rtol=1e-12, atol=1e-13
    )
    return found.y[:, -1].reshape(n, n)


@cache
def monodromy():
    return transition(PERIOD)


@establishes(
    "Aannaque",
    "7.3",
    printed=r"Y(t) = \Phi(t)\exp(Bt)",
    verdict="agrees",
    derived=r"B = \frac{1}{T}\ln R,\; \Phi(t + T) = \Phi(t)",
    remark="With negative multipliers B is complex; a real B needs the period 2T.",
)
@establishes(
    "Aannaque",
    "7.4",
    printed=r"y(t+T) = \rho\,y(t)",
    verdict="agrees",
    derived=r"y = \Phi(t)\exp(Bt)z,\; \exp(BT)z = \rho z",
)
def test_floquet_form_of_a_damped_system_of_two_freedoms():
    r = monodromy()
    b = logm(r) / PERIOD
    for t in (0.31, 1.2, 1.9):
        phi = transition(t) @ expm(-b * t)
        later = transition(t + PERIOD) @ expm(-b * (t + PERIOD))
        np.testing.assert_allclose(later, phi, rtol=0.0, atol=1e-9)
    roots, vectors = np.linalg.eig(r)
    for root, vector in zip(roots, vectors.T, strict=True):
        for t in (0.0, 0.77):
            np.testing.assert_allclose(
                transition(t + PERIOD) @ vector, root * transition(t) @ vector, atol=1e-9
            )


@establishes(
    "Aannaque",
    "7.5",
    printed=r"R = Y(T) \text{ when } Y(0) = I",
    verdict="agrees",
    derived=r"R = \exp(BT),\; \det R = \exp\int_0^T \operatorname{tr}A\,dt",
)
@establishes(
    "Aannaque",
    "7.6",
    printed=r"\psi(t_3,t_1) = \psi(t_3,t_2)\psi(t_2,t_1),\; \psi(t_2,t_1) = \psi^{-1}(t_1,t_2)",
    verdict="agrees",
)
def test_transition_matrices_form_a_group():
    t1, t2, t3 = 0.2, 1.7, 0.9
    whole = transition(t3, t1)
    np.testing.assert_allclose(transition(t3, t2) @ transition(t2, t1), whole, atol=1e-9)
    np.testing.assert_allclose(np.linalg.inv(transition(t1, t2)), transition(t2, t1), atol=1e-9)
    r = monodromy()
    assert np.linalg.det(r) == pytest.approx(np.exp(-0.3 * PERIOD), abs=1e-10)
    np.testing.assert_allclose(expm(logm(r)), r, atol=1e-10)


@establishes(
    "Aannaque",
    "7.2 stability from the multipliers",
    printed=r"\lvert\rho_i\rvert \le 1 \text{ for all } i: \text{ stable}",
    verdict="slip",
    derived=r"\lvert\rho_i\rvert < 1, \text{ or } 1 \text{ with as many eigenvectors as its order}",
    remark="Without stiffness both multipliers of y'' = 0 are 1, and y = t grows: by 1000 T over "
    "1000 periods. The same holds on every boundary of an unstable region.",
)
def test_multipliers_on_the_circle_may_belong_to_growing_solutions():
    # y'' = 0: no stiffness at all.
    r = np.array([[1.0, PERIOD], [0.0, 1.0]])
    assert np.max(np.abs(np.linalg.eigvals(r))) == 1.0
    assert np.linalg.matrix_power(r, 1000)[0, 1] == 1000 * PERIOD
    # A boundary of Mathieu's equation: d = a_1(q), found to round-off.
    from scipy.special import mathieu_a

    d, q = float(mathieu_a(1, 1.0)), 1.0
    found = normalised_solutions(lambda t: d - 2.0 * q * np.cos(2.0 * t), np.pi)
    np.testing.assert_allclose(np.linalg.eigvals(found), -1.0, atol=1e-4)
    power = np.linalg.matrix_power(found, 1000)
    assert np.linalg.norm(power) > 300.0


def half_trace(levels, lengths):
    """Return half the trace of a product of matrix exponentials."""
    whole = np.eye(2)
    for level, length in zip(levels, lengths, strict=True):
        whole = expm(np.array([[0.0, 1.0], [-level, 0.0]]) * length) @ whole
    return 0.5 * np.trace(whole)


@establishes(
    "Aannaque",
    "7.2 ends of a stable range",
    printed=r"\rho = 1 \text{ at one end of a stable range},\; \rho = -1 \text{ at the other}",
    verdict="approximation",
    derived=r"\text{one freedom, and no region of zero width between}",
    remark="Two levels 6.5 +- 2.5, each for half a turn: region 5 has no width, and the range "
    "between regions 4 and 6 ends with 1 on both sides. With 2 freedoms or more, ranges also end "
    "where two pairs meet on the circle away from 1 and -1.",
)
def test_a_stable_range_may_end_with_one_sign_on_both_sides():
    lengths = (np.pi, np.pi)

    def half(middle):
        return half_trace((middle + 2.5, middle - 2.5), lengths)

    places = np.linspace(4.5, 9.0, 901)
    values = np.array([half(x) for x in places])
    touch = np.argmin(values)
    assert places[touch] == pytest.approx(6.5, abs=1e-3)
    assert values[touch] == pytest.approx(-1.0, abs=1e-9)
    left, right = (
        np.flatnonzero(values[part] > 1.0) for part in (slice(touch), slice(touch, None))
    )
    inside = values[left[-1] + 1 : touch + right[0]]
    assert np.all(np.abs(inside) <= 1.0 + 1e-12)
    assert len(inside) > 200


@establishes(
    "Aannaque",
    "7.9",
    printed=r"\begin{bmatrix}\cos\varpi\Delta t & \frac{1}{\varpi}\sin\varpi\Delta t\\"
    r"-\varpi\sin\varpi\Delta t & \cos\varpi\Delta t\end{bmatrix}",
    verdict="agrees",
    derived=r"\exp\begin{bmatrix}0 & 1\\-\varpi^2 & 0\end{bmatrix}\Delta t",
)
@establishes(
    "Aannaque",
    "7.2 powers of the interval matrix",
    printed=r"(A^2)_{12} = \frac{1}{\varpi}\sin^2\varpi\Delta t",
    verdict="slip",
    derived=r"(A^2)_{12} = \frac{2}{\varpi}\sin\varpi\Delta t\cos\varpi\Delta t",
    remark="0.087 printed, 0.565 right at a frequency of 1 and a step of 0.3. The second line, "
    "sin(2 ...), and the power N are right.",
)
@establishes(
    "Aannaque",
    "7.2 multipliers at a constant frequency",
    printed=r"\lambda = \cos(2\pi\varpi/\omega) \pm i\sin(2\pi\varpi/\omega)",
    verdict="agrees",
    remark="They are real, and -1, also at speeds of 2/3, 2/5 ... of the frequency; the motion "
    "there has the period 2T. The text has the whole divisions alone.",
)
def test_powers_of_the_matrix_of_one_interval():
    w, step = sp.symbols("w h", positive=True)
    matrix = sp.Matrix([[0, 1], [-(w**2), 0]])
    c, s = sp.cos(w * step), sp.sin(w * step)
    printed = sp.Matrix([[c, s / w], [-w * s, c]])
    # The exponential by its equation: M' = A M, M(0) = 1.
    assert sp.simplify(printed.diff(step) - matrix * printed) == sp.zeros(2)
    assert printed.subs(step, 0) == sp.eye(2)
    square = printed**2
    assert sp.simplify(square[0, 1] - 2 * s * c / w) == 0
    assert sp.simplify(square[1, 0] + 2 * w * s * c) == 0
    assert sp.simplify(square - printed.subs(step, 2 * step)) == sp.zeros(2)
    values = {w: 1, step: sp.Rational(3, 10)}
    assert float((s**2 / w).subs(values)) == pytest.approx(0.087, abs=5e-4)
    assert float(square[0, 1].subs(values)) == pytest.approx(0.565, abs=5e-4)
    power = (printed**3 - printed.subs(step, 3 * step)).applyfunc(sp.expand_trig)
    assert power.applyfunc(lambda e: sp.simplify(sp.expand(e))) == sp.zeros(2)
    for ratio, expected in ((3.0, 1.0), (1.5, -1.0), (2.5, -1.0)):
        # T = 2 pi / omega with omega = w / ratio.
        period = 2.0 * np.pi * ratio
        roots = np.linalg.eigvals(np.array(printed.subs({w: 1, step: period}), dtype=float))
        np.testing.assert_allclose(roots, expected, atol=1e-7)


@establishes(
    "Aannaque",
    "7.10",
    printed=r"\frac{d^2y}{d\theta^2} + T^2 q(\theta)y = 0,\; q = v_i^2/4\pi^2",
    verdict="agrees",
    derived=r"T^2 q = v_i^2/\omega^2,\; \omega = 2\pi/T",
)
@establishes(
    "Aannaque",
    "7.2 C, S and V",
    printed=r"C_i = \cos\frac{Tv_i\theta_i}{2\pi},\; S_i = \sin\frac{Tv_i\theta_i}{2\pi},\; "
    r"V_{ik} = \frac12\left(\frac{v_i}{v_k} + \frac{v_k}{v_i}\right)",
    verdict="agrees",
)
@establishes(
    "Aannaque",
    "7.11",
    printed=r"J_2 = C_1C_2 - V_{12}S_1S_2,\; J_3 = C_1C_2C_3 - V_{12}S_1S_2C_3 - "
    r"V_{13}S_1S_3C_2 - V_{23}S_2S_3C_1",
    verdict="agrees",
    derived=r"J_N = \tfrac12\operatorname{tr}\prod_i A_i",
    remark="From N = 4 on a product of four sines has no single V before it but "
    "V12 V34 - V13 V24 + V14 V23, the Pfaffian. In Fig. 7.2 the axes T v/2 are the phases of the "
    "intervals only where both are half a turn.",
)
def test_meissners_functions_are_half_traces():
    theta, t, v = sp.symbols("theta T v", positive=True)
    wave = sp.cos(t * v * theta / (2 * sp.pi))
    assert sp.simplify(wave.diff(theta, 2) + t**2 * v**2 / (4 * sp.pi**2) * wave) == 0
    generator = np.random.default_rng(711)
    for _ in range(20):
        period = generator.uniform(0.5, 4.0)
        v, angles = generator.uniform(0.3, 6.0, 4), generator.dirichlet(np.ones(4)) * 2.0 * np.pi
        for count in (2, 3, 4):
            part = angles[:count] * 2.0 * np.pi / np.sum(angles[:count])
            levels = (period * v[:count] / (2.0 * np.pi)) ** 2
            found = half_trace(levels, part)
            phases = period * v[:count] * part / (2.0 * np.pi)
            assert printed_j(np.cos(phases), np.sin(phases), v) == pytest.approx(found, abs=1e-11)


def printed_j(c, s, v):
    """Return J_2, J_3 as printed, and J_4 with the factor of its four sines."""

    def ratio(i, k):
        return 0.5 * (v[i] / v[k] + v[k] / v[i])

    if len(c) == 2:
        return c[0] * c[1] - ratio(0, 1) * s[0] * s[1]
    if len(c) == 3:
        return (
            c[0] * c[1] * c[2]
            - ratio(0, 1) * s[0] * s[1] * c[2]
            - ratio(0, 2) * s[0] * s[2] * c[1]
            - ratio(1, 2) * s[1] * s[2] * c[0]
        )
    pairs = [(i, k) for i in range(4) for k in range(i + 1, 4)]
    total = np.prod(c)
    for i, k in pairs:
        rest = [j for j in range(4) if j not in (i, k)]
        total -= ratio(i, k) * s[i] * s[k] * np.prod(c[rest])
    pfaffian = ratio(0, 1) * ratio(2, 3) - ratio(0, 2) * ratio(1, 3) + ratio(0, 3) * ratio(1, 2)
    return total + pfaffian * np.prod(s)


@establishes(
    "Aannaque",
    "7.2 Mathieu's equation without modulation",
    printed=r"\epsilon = 0,\; d = i^2: \text{ unstable}",
    verdict="slip",
    derived=r"R = (-1)^i I \text{ for } i \ge 1: \text{ every solution is periodic; regions of "
    r"instability start there for } \epsilon \ne 0",
    remark="Only d = 0 has a growing solution at eps = 0. At d = 9 the point itself stays stable "
    "for small eps: both ends of region 3 lie above it, at 9.0137 and 9.0176 with eps = 1.",
)
def test_without_modulation_nothing_grows_but_at_zero():
    t = sp.Symbol("t", real=True)
    for i in (1, 2, 3, 4):
        matrix = sp.Matrix(
            [[sp.cos(i * t), sp.sin(i * t) / i], [-i * sp.sin(i * t), sp.cos(i * t)]]
        )
        assert matrix.subs(t, sp.pi) == (-1) ** i * sp.eye(2)
    from scipy.special import mathieu_a, mathieu_b

    ends = sorted([float(mathieu_a(3, 0.5)), float(mathieu_b(3, 0.5))])
    assert ends == pytest.approx([9.0137, 9.0176], abs=5e-5)
    trace = 0.5 * np.trace(normalised_solutions(lambda t: 9.0 + np.cos(2.0 * t), np.pi))
    assert abs(trace) < 1.0
