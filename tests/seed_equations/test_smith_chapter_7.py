"""Smith (7.1)-(7.25): Floquet theory and the first-order boundaries of Hill's equation."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from seed_ledger import establishes
from seed_truth import (
    CRANK_ROCKERS,
    RIGS,
    TURN,
    boundaries,
    coupler_functions,
    fourier,
    motion,
    normalised_solutions,
)

theta, amplitude = sp.symbols("theta mu", real=True)
A0, B0 = sp.symbols("A_0 B_0", real=True)
alpha = sp.symbols("alpha_1 alpha_2", real=True)


def q(x):
    """A function of period pi, neither even nor odd."""
    return np.cos(2 * x) + 0.4 * np.sin(4 * x) + 0.1


def solutions(lam2, mu, end=np.pi):
    return normalised_solutions(lambda x: lam2 + mu * q(x), end)


def trajectory(lam2, mu, start, places):
    """Return y at the places, from y(0), y'(0)."""
    result = solve_ivp(
        lambda x, s: [s[1], -(lam2 + mu * q(x)) * s[0]],
        (0.0, places[-1]),
        start,
        method="DOP853",
        t_eval=places,
        rtol=1e-12,
        atol=1e-13,
    )
    return result.y[0]


@establishes(
    "Smith",
    "7.1",
    printed=r"y'' + \{\lambda^2 + Q(x)\}y = 0",
    verdict="agrees",
    remark="A definition. That Q is usually even does not hold for linkages: f3 of (5,1,5,2) has a "
    "first sine harmonic of 0.215 beside a cosine harmonic of 0.567.",
)
@establishes(
    "Smith",
    "7.2",
    printed=r"y'' + \{\lambda^2 + \mu q(x)\}y = 0",
    verdict="agrees",
    derived=r"Q = \mu q",
)
@establishes(
    "Smith",
    "7.11",
    printed=r"\frac{d^2y}{d\theta^2} + \{\lambda^2 + \mu f(\theta)\}y = 0",
    verdict="agrees",
    derived=r"\mu = \epsilon_3,\; f = f_3 \text{ of (6.18), } m = 1",
    remark="The mu of appendix 4 is another one: epsilon3/lambda^2.",
)
def test_forms_of_the_equation():
    m = motion(CRANK_ROCKERS["5,1,5,2"])
    f3 = coupler_functions(m)[3]
    first = fourier(f3)[1]
    assert 2 * first.real == pytest.approx(0.567, abs=5e-4)
    assert -2 * first.imag == pytest.approx(0.215, abs=5e-4)
    # The reduced equation in time, and (7.11) over one turn: the same half trace.
    frequency, speed, epsilon3 = RIGS["5,1,5,2"].frequency, 55.0, 3.43
    harmonics = fourier(f3)[:40]

    def f(angle):
        waves = np.exp(1j * np.arange(40) * angle)
        return 2 * (harmonics @ waves).real - harmonics[0].real

    in_time = normalised_solutions(
        lambda t: frequency**2 + speed**2 * epsilon3 * f(speed * t), TURN / speed
    )
    in_angle = normalised_solutions(lambda x: (frequency / speed) ** 2 + epsilon3 * f(x), TURN)
    assert np.trace(in_time) == pytest.approx(np.trace(in_angle), abs=1e-7)


@establishes(
    "Smith",
    "7.1.2 Floquet solutions",
    printed=r"y_{1,2} = e^{\pm i\alpha x}p_{1,2}(x)",
    verdict="agrees",
    remark="Where both roots coincide without two eigenvectors a solution x p(x) takes the place "
    "of the second one.",
)
@establishes(
    "Smith",
    "7.1.2 roots",
    printed=r"p_1 p_2 = 1,\; p_{1,2} = e^{\pm i\gamma\pi}",
    verdict="agrees",
    derived=r"\det = W = 1",
)
def test_floquet_form():
    for lam2, mu in ((1.7, 0.5), (1.1, 0.9), (6.3, 1.2)):
        matrix = solutions(lam2, mu)
        roots, vectors = np.linalg.eig(matrix)
        assert np.prod(roots) == pytest.approx(1.0, abs=1e-10)
        exponent = np.log(roots[0].astype(complex)) / (1j * np.pi)
        assert np.exp(-1j * exponent * np.pi) == pytest.approx(roots[1], abs=1e-9)
        places = np.linspace(0.0, 2 * np.pi, 41)
        basis = [trajectory(lam2, mu, start, places) for start in ([1.0, 0.0], [0.0, 1.0])]
        for root, vector in zip(roots, vectors.T, strict=True):
            power = np.log(root.astype(complex)) / (1j * np.pi)
            periodic = (vector @ np.array(basis)) * np.exp(-1j * power * places)
            assert np.abs(periodic[20:] - periodic[:21]).max() < 1e-8


@establishes(
    "Smith",
    "7.3",
    printed=r"y_1(0) = 1,\; y_1'(0) = 0,\; y_2(0) = 0,\; y_2'(0) = 1",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.4",
    printed=r"y_1(x + \pi) = a_1 y_1 + a_2 y_2,\; y_2(x + \pi) = a_3 y_1 + a_4 y_2",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.5",
    printed=r"a_1 = y_1(\pi),\; a_2 = y_1'(\pi),\; a_3 = y_2(\pi),\; a_4 = y_2'(\pi)",
    verdict="agrees",
    remark="In the order of (7.4) a2 belongs to y1' and a3 to y2; interchanged they fail.",
)
def test_translation_by_a_period():
    lam2, mu = 1.7, 0.5
    places = np.linspace(0.0, 2 * np.pi, 41)
    y1, y2 = (trajectory(lam2, mu, start, places) for start in ([1.0, 0.0], [0.0, 1.0]))
    (a1, a3), (a2, a4) = solutions(lam2, mu)
    assert np.abs(y1[20:] - a1 * y1[:21] - a2 * y2[:21]).max() < 1e-9
    assert np.abs(y2[20:] - a3 * y1[:21] - a4 * y2[:21]).max() < 1e-9
    assert np.abs(y1[20:] - a1 * y1[:21] - a3 * y2[:21]).max() > 0.1
    assert (y1[0], y2[0]) == (1.0, 0.0)


@establishes(
    "Smith", "7.6", printed=r"y(x + \pi) = p\,y(x)", verdict="agrees", derived=r"p \text{ a root}"
)
@establishes(
    "Smith",
    "7.7",
    printed=r"A y_1(\pi) - A p + B y_2(\pi) = 0,\; A y_1'(\pi) + B y_2'(\pi) - B p = 0",
    verdict="agrees",
    remark="Follows with x = 0 in (7.6) and its derivative; the text says x = pi.",
)
@establishes(
    "Smith",
    "7.8",
    printed=r"\det\begin{pmatrix} y_1(\pi) - p & y_2(\pi) \\ y_1'(\pi) & y_2'(\pi) - p "
    r"\end{pmatrix} = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.9",
    printed=r"p^2 - 2Xp + W = 0,\; X = \tfrac12(y_1(\pi) + y_2'(\pi)),\; "
    r"W = y_1(\pi)y_2'(\pi) - y_1'(\pi)y_2(\pi)",
    verdict="agrees",
)
@establishes("Smith", "7.10", printed=r"p^2 - 2Xp + 1 = 0", verdict="agrees")
def test_characteristic_equation():
    for lam2, mu in ((1.7, 0.5), (1.1, 0.9)):
        matrix = solutions(lam2, mu)
        (y1, y2), (y1_x, y2_x) = matrix
        X, W = 0.5 * (y1 + y2_x), y1 * y2_x - y1_x * y2
        assert abs(W - 1.0) < 1e-10
        roots, vectors = np.linalg.eig(matrix)
        for p, (A, B) in zip(roots, vectors.T, strict=True):
            assert abs(A * y1 - A * p + B * y2) < 1e-10
            assert abs(y1_x * A + y2_x * B - B * p) < 1e-10
            assert abs((y1 - p) * (y2_x - p) - y1_x * y2) < 1e-10
            assert abs(p**2 - 2 * X * p + 1) < 1e-9


@establishes(
    "Smith",
    "7.1.2 stability from the roots",
    printed=r"p_1 \ne p_2 \Rightarrow \text{unstable, since } p_1 > 1 \text{ or } p_2 > 1;\; "
    r"p_1 = p_2 \Rightarrow \text{stable, period } \pi\ (p = 1),\; 2\pi\ (p = -1)",
    verdict="slip",
    derived=r"\lvert X\rvert < 1: p_{1,2} = e^{\pm i\gamma\pi},\text{ stable};\; "
    r"\lvert X\rvert > 1: \text{unstable};\; \lvert X\rvert = 1: \text{one periodic solution, "
    r"the other grows like } x",
    remark="Different roots on the unit circle are the stable case: lambda^2 = 1.7, mu = 0.5 has "
    "X = -0.57 and stays bounded. On a boundary the roots coincide and one solution grows "
    "linearly. Only roots that differ in size are unstable.",
)
def test_stability_from_the_roots():
    matrix = solutions(1.7, 0.5)
    roots = np.linalg.eigvals(matrix)
    assert 0.5 * np.trace(matrix) == pytest.approx(-0.568, abs=0.001)
    assert abs(roots[0] - roots[1]) > 1
    assert np.abs(np.linalg.matrix_power(matrix, 1000)).max() < 3
    samples = 0.5 * q(TURN * np.arange(256) / 256)
    edge = boundaries(samples, 2)[0]
    matrix = solutions(edge, 0.5)
    roots = np.linalg.eigvals(matrix)
    assert np.abs(roots + 1).max() < 1e-4
    growth = [np.abs(np.linalg.matrix_power(matrix, n)).max() for n in (200, 400)]
    assert growth[0] > 20 and growth[1] / growth[0] == pytest.approx(2.0, rel=0.02)


@establishes(
    "Smith",
    "7.1.3.1 periods",
    printed=r"\lambda^2 \approx (n/2)^2:\; \text{period } \pi \text{ for } n = 1, 3, 5,\ldots,\; "
    r"2\pi \text{ for } n = 2, 4, 6,\ldots",
    verdict="slip",
    derived=r"q \text{ of period } \pi: \lambda^2 \approx n^2,\; \text{period } \pi \text{ for "
    r"even } n,\; 2\pi \text{ for odd } n",
    remark="Twice wrong: with q of period pi the regions start at n^2, and odd n gives the longer "
    "period. At lambda^2 near 1/4 the roots are near +-i, far from any periodic solution; near 1 "
    "the period is 2 pi, near 4 it is pi. For f of period 2 pi the text after (7.13) is right.",
)
@establishes(
    "Smith",
    "7.13",
    printed=r"y_0 = A_1\cos\frac n2\theta + B_0\sin\frac n2\theta,\; \text{period } 2\pi "
    r"\text{ or } 4\pi \text{ for even or odd } n",
    verdict="slip",
    derived=r"y_0 = A_0\cos\frac n2\theta + B_0\sin\frac n2\theta",
    remark="A0, not A1, by (7.16) and (7.19); A1 later belongs to the first-order solution. The "
    "periods are right.",
)
def test_periods_of_the_boundary_solutions():
    samples = 0.05 * q(TURN * np.arange(256) / 256)
    for n in (1, 2, 3):
        for edge in boundaries(samples, 2 * n):
            roots = np.linalg.eigvals(solutions(edge, 0.05))
            assert np.abs(roots - (-1.0) ** n).max() < 1e-3
            assert edge == pytest.approx(n**2, abs=0.05)
    roots = np.linalg.eigvals(solutions(0.25, 0.05))
    assert np.abs(roots.real).max() < 0.1

    # f of period 2 pi: over one period y changes sign for odd n, and repeats for even n.
    def shifted(x):
        return 0.05 * (np.cos(x) + 0.5 * np.sin(2 * x) + 0.3 * np.cos(3 * x))

    for n in (1, 2, 3):
        for edge in boundaries(shifted(TURN * np.arange(64) / 64), n):
            matrix = normalised_solutions(lambda x, edge=edge: edge + shifted(x), TURN)
            assert np.abs(np.linalg.eigvals(matrix) - (-1.0) ** n).max() < 1e-3


@cache
def expansion(order=2):
    """Return the coefficients of mu^0, mu^1, mu^2 in y'' + (lambda^2 + mu f) y by machine."""
    n = sp.Symbol("n", positive=True)
    f = sp.Function("f")(theta)
    ys = [sp.Function(f"y{i}")(theta) for i in range(order + 1)]
    lam2 = (n / 2) ** 2 + sum(a * amplitude ** (i + 1) for i, a in enumerate(alpha))
    y = sum(part * amplitude**i for i, part in enumerate(ys))
    left = sp.expand(sp.diff(y, theta, 2) + (lam2 + amplitude * f) * y)
    return [left.coeff(amplitude, i) for i in range(order + 1)], ys, f, n


@establishes(
    "Smith",
    "7.12",
    printed=r"\lambda^2 = \left(\frac n2\right)^2 + \alpha_1\mu + \alpha_2\mu^2 + \cdots",
    verdict="agrees",
    remark="One series for each of the two boundaries of region n.",
)
@establishes("Smith", "7.14", printed=r"y = y_0 + \mu y_1 + \mu^2 y_2 + \cdots", verdict="agrees")
@establishes(
    "Smith",
    "7.15",
    printed=r"\frac{d^2}{d\theta^2}(y_0 + \mu y_1 + \cdots) + \{(\tfrac n2)^2 + \alpha_1\mu + "
    r"\cdots + \mu f\}\{y_0 + \mu y_1 + \cdots\} = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.16",
    printed=r"y_0'' + (\tfrac n2)^2 y_0 = 0",
    verdict="agrees",
    derived=lambda: f"{sp.latex(expansion()[0][0])} = 0",
)
@establishes(
    "Smith",
    "7.17",
    printed=r"y_1'' + (\tfrac n2)^2 y_1 = -\alpha_1 y_0 - f y_0",
    verdict="agrees",
    derived=lambda: f"{sp.latex(expansion()[0][1])} = 0",
)
@establishes(
    "Smith",
    "7.18",
    printed=r"y_2'' + (\tfrac n2)^2 y_2 = -\alpha_1 y_1 - f y_1 - \alpha_2 y_0",
    verdict="agrees",
    derived=lambda: f"{sp.latex(expansion()[0][2])} = 0",
)
def test_powers_of_mu():
    rows, (y0, y1, y2), f, n = expansion()

    def operator(y):
        return sp.diff(y, theta, 2) + (n / 2) ** 2 * y

    assert sp.expand(rows[0] - operator(y0)) == 0
    assert sp.expand(rows[1] - operator(y1) - alpha[0] * y0 - f * y0) == 0
    second = operator(y2) + alpha[0] * y1 + f * y1 + alpha[1] * y0
    assert sp.expand(rows[2] - second) == 0
    # The series itself: fit lambda^2 at small mu and recover (n/2)^2 and a finite slope.
    f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))[3]
    values = [boundaries(mu * f3, 2)[1] for mu in (1e-4, 2e-4, 4e-4)]
    slopes = np.diff(values) / [1e-4, 2e-4]
    assert 2 * values[0] - values[1] == pytest.approx(1.0, abs=1e-6)
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-3)


def harmonics(n):
    a = sp.symbols(f"a:{2 * n + 2}", real=True)
    b = sp.symbols(f"b:{2 * n + 2}", real=True)
    f = sum(
        a[m] * sp.cos(m * theta) + (b[m] * sp.sin(m * theta) if m else 0) for m in range(len(a))
    )
    return a, b, f


def sine_cosine_parts(expression, n):
    """Return the coefficients of cos and sin(n theta/2), from powers of e^(i theta/2)."""
    z = sp.Symbol("z")
    powers = expression.rewrite(sp.exp).replace(
        sp.exp, lambda exponent: z ** (2 * exponent / (sp.I * theta))
    )
    expanded = sp.expand(powers)
    plus, minus = expanded.coeff(z, n), expanded.coeff(z, -n)
    return sp.expand(plus + minus), sp.expand(sp.I * (plus - minus))


@establishes(
    "Smith",
    "7.19",
    printed=r"y_1'' + (\tfrac n2)^2 y_1 = -\{\alpha_1 + f\}\{A_0\cos\tfrac n2\theta + "
    r"B_0\sin\tfrac n2\theta\}",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.20",
    printed=r"f = \sum_{m=0}^\infty(a_m\cos m\theta + b_m\sin m\theta)",
    verdict="agrees",
    derived=r"a_0 = \tfrac{1}{2\pi}\int f,\; a_m = \tfrac1\pi\int f\cos m\theta",
    remark="a0 carries no half here, against the heading of appendix 3 (the text refers to an "
    "appendix 5 that does not exist).",
)
@establishes(
    "Smith",
    "7.21",
    printed=r"y_1'' + (\tfrac n2)^2 y_1 = -\alpha_1(A_0 c + B_0 s) - \tfrac12\sum_m\{(a_m A_0 - "
    r"b_m B_0)\cos(m + \tfrac n2)\theta + (a_m A_0 + b_m B_0)\cos(m - \tfrac n2)\theta + "
    r"(a_m B_0 + b_m A_0)\sin(m + \tfrac n2)\theta - (a_m B_0 - b_m A_0)\sin(m - \tfrac n2)"
    r"\theta\}",
    verdict="agrees",
)
@pytest.mark.parametrize("n", [1, 2, 3])
def test_products_with_the_first_solution(n):
    a, b, f = harmonics(n)
    k = sp.Rational(n, 2)
    y0 = A0 * sp.cos(k * theta) + B0 * sp.sin(k * theta)
    printed = -alpha[0] * y0
    for m, (am, bm) in enumerate(zip(a, b, strict=True)):
        bm = bm if m else 0
        printed -= sp.Rational(1, 2) * (
            (am * A0 - bm * B0) * sp.cos((m + k) * theta)
            + (am * A0 + bm * B0) * sp.cos((m - k) * theta)
            + (am * B0 + bm * A0) * sp.sin((m + k) * theta)
            - (am * B0 - bm * A0) * sp.sin((m - k) * theta)
        )
    right = -(alpha[0] + f) * y0
    symbols = (theta, A0, B0, alpha[0], *a, *b)
    rng = np.random.default_rng(n)
    difference = sp.lambdify(symbols, [printed, right])
    for _ in range(20):
        one, other = difference(*rng.normal(size=len(symbols)))
        assert one == pytest.approx(other, abs=1e-12)


@cache
def conditions(n):
    """Return the coefficients of cos and sin(n theta/2) of the right-hand side of (7.19)."""
    a, b, f = harmonics(n)
    k = sp.Rational(n, 2)
    y0 = A0 * sp.cos(k * theta) + B0 * sp.sin(k * theta)
    return sine_cosine_parts(-(alpha[0] + f) * y0, n), a, b


@establishes(
    "Smith",
    "7.22",
    printed=r"-\alpha_1 A_0 - \tfrac12(2A_0 a_0 + A_0 a_n + B_0 b_n) = 0,\; "
    r"-\alpha_1 B_0 - \tfrac12(2B_0 a_0 + A_0 b_n - B_0 a_n) = 0",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{sp.latex(part)} = 0" for part in conditions(1)[0]),
)
@establishes(
    "Smith",
    "7.1.3.2 rearranged conditions",
    printed=r"A_0(\alpha_1 + a_0 + \tfrac{a_n}2) + B_0\tfrac{b_n}2 = 0,\; A_0\tfrac{b_n}2 + "
    r"B_0(\alpha_1 + a_0 - \tfrac{a_n}2) = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.23",
    printed=r"(\alpha_1 + a_0)^2 - (\tfrac{a_n}2)^2 - (\tfrac{b_n}2)^2 = 0,\; "
    r"\alpha_1 = -a_0 \pm \tfrac12\sqrt{a_n^2 + b_n^2}",
    verdict="agrees",
)
@establishes(
    "Smith",
    "7.24",
    printed=r"B_0 = -\frac{A_0}{b_n}\{a_n \pm \sqrt{a_n^2 + b_n^2}\}",
    verdict="agrees",
    remark="Fails for b_n = 0 (even f): then one boundary has A0 = 0, the other B0 = 0.",
)
def test_periodicity_conditions():
    for n in (1, 2, 3):
        (cosine, sine), a, b = conditions(n)
        printed_c = -alpha[0] * A0 - (2 * A0 * a[0] + A0 * a[n] + B0 * b[n]) / 2
        printed_s = -alpha[0] * B0 - (2 * B0 * a[0] + A0 * b[n] - B0 * a[n]) / 2
        assert sp.expand(cosine - printed_c) == 0
        assert sp.expand(sine - printed_s) == 0
        centre = alpha[0] + a[0]
        first = A0 * (centre + a[n] / 2) + B0 * b[n] / 2
        second = A0 * b[n] / 2 + B0 * (centre - a[n] / 2)
        assert sp.expand(cosine + first) == 0 and sp.expand(sine + second) == 0
        matrix = sp.Matrix([cosine, sine]).jacobian([A0, B0])
        assert sp.expand(matrix.det() - (centre**2 - a[n] ** 2 / 4 - b[n] ** 2 / 4)) == 0
        for sign in (1, -1):
            root = sign * sp.sqrt(a[n] ** 2 + b[n] ** 2)
            ratio = -(a[n] + root) / b[n]
            values = {alpha[0]: -a[0] + root / 2, A0: 1, B0: ratio}
            assert sp.simplify(cosine.subs(values)) == 0
            assert sp.simplify(sine.subs(values)) == 0


@establishes(
    "Smith",
    "7.25",
    printed=r"\lambda'^2 = (\tfrac n2)^2 + \alpha_1'\mu,\; \lambda''^2 = (\tfrac n2)^2 + "
    r"\alpha_1''\mu",
    verdict="approximation",
    derived=r"+ O(\mu^2)",
    remark="Error of order mu^2. At the rigs' own epsilon3 (reduced equation, lightest follower) "
    "lambda^2 is off by 0.39 (region 2) and 0.18 (region 4) for (5,1,5,2), by 0.13 and 0.031 for "
    "(10,1,10,4). Region 4 of (5,1,5,2) reads 783-800 rpm for the exact 772-781 rpm.",
)
def test_first_order_boundaries():
    def first_order(f, n, mu):
        c = fourier(f)
        a0, width = c[0].real, np.abs(c[n])
        return np.array([n**2 / 4 - (a0 + width) * mu, n**2 / 4 - (a0 - width) * mu])

    errors = {}
    for name in RIGS:
        f3 = coupler_functions(motion(CRANK_ROCKERS[name]))[3]
        for n in (1, 2, 3, 4):
            gaps = [
                np.abs(first_order(f3, n, mu) - boundaries(mu * f3, n)).max()
                for mu in (0.004, 0.002)
            ]
            assert np.log2(gaps[0] / gaps[1]) == pytest.approx(2.0, abs=0.1)
            mu = RIGS[name].epsilon(0.0058)[2]
            errors[name, n] = np.abs(first_order(f3, n, mu) - boundaries(mu * f3, n)).max()
    assert errors["5,1,5,2", 2] == pytest.approx(0.388, abs=0.001)
    assert errors["5,1,5,2", 4] == pytest.approx(0.185, abs=0.001)
    assert errors["10,1,10,4", 2] == pytest.approx(0.129, abs=0.001)
    assert errors["10,1,10,4", 4] == pytest.approx(0.031, abs=0.001)
    f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))[3]
    mu = RIGS["5,1,5,2"].epsilon(0.0058)[2]
    for values, rpm in ((first_order(f3, 4, mu), (800, 783)), (boundaries(mu * f3, 4), (781, 772))):
        assert 26 * 60 / np.sqrt(values) == pytest.approx(rpm, abs=0.6)
