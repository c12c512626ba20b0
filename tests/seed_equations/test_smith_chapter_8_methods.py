"""Smith (8.23)-(8.44): the modified and the alternative method for several parameters."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from seed_ledger import establishes
from seed_series import TWO_FUNCTIONS, eps, psi, resonant, theta
from seed_truth import CRANK_ROCKERS, RIGS, TURN, boundaries, coupler_functions, fourier, motion
from smith_chapter_8.modified import alternative_method
from smith_chapter_8.strained import strained_boundaries
from smith_chapter_8.surd import combine

F = Fraction
A, B = sp.symbols("A B", real=True)
ONE, TWO = TWO_FUNCTIONS


def prime(level, region, sign=-1):
    """Return the resonant parts of the right side of (8.26) in the turned frame."""
    angle = (region * theta) / 2
    y0 = A * sp.cos(angle) + B * sp.sin(angle)
    return resonant(sign * level * y0 - sp.cos(region * theta) * y0, region)


@establishes(
    "Smith",
    "8.3.2 first-order coefficients",
    printed=r"\alpha_{100} = -a_0,\; \alpha_{010} = -c_0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "8.3.2 equation of y_001",
    printed=r"y_{001}'' + (\tfrac n2)^2 y_{001} = \alpha_{001}\{A'c_1 + B's_1\} - \tfrac{A'}2\{c_3 "
    r"+ c_1\} - \tfrac{B'}2\{s_3 - s_1\}",
    verdict="slip",
    derived=r"= -\alpha_{001}\{A'c_1 + B's_1\} - \tfrac{A'}2\{c_3 + c_1\} - \tfrac{B'}2\{s_3 - "
    r"s_1\}",
    remark="Minus alpha_001, by (8.26); c_k, s_k are cos and sin of k(n theta - psi_n)/2. As "
    "printed A' = 1 would go with alpha_001 = +1/2; (8.27) has the right signs again.",
)
@establishes(
    "Smith",
    "8.27",
    printed=r"A'_{000}\left(\alpha_{001} + \tfrac12\right) = 0,\; B'_{000}\left(\alpha_{001} - "
    r"\tfrac12\right) = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "8.28",
    printed=r"A'_{000} = 0 \Rightarrow \alpha_{001} = +\tfrac12,\; B'_{000} = 0 \Rightarrow "
    r"\alpha_{001} = -\tfrac12",
    verdict="agrees",
    remark="With delta_n = 0 both constants stay free.",
)
def test_first_order_of_the_modified_method():
    level = sp.Symbol("level", real=True)
    for region in (1, 2, 3):
        cosine, sine = prime(level, region)
        assert sp.expand(cosine + A * (level + sp.Rational(1, 2))) == 0
        assert sp.expand(sine + B * (level - sp.Rational(1, 2))) == 0
        wrong, _ = prime(level, region, sign=1)
        assert wrong.subs({level: sp.Rational(1, 2), A: 1}) == 0
        # The products as printed, in the frame of psi_n.
        x = (region * theta - psi) / 2
        product = sp.cos(2 * x) * (A * sp.cos(x) + B * sp.sin(x))
        printed = A / 2 * (sp.cos(3 * x) + sp.cos(x)) + B / 2 * (sp.sin(3 * x) - sp.sin(x))
        numbers = {theta: 0.7, psi: 0.4, A: 1.3, B: -0.6}
        assert float((product - printed).subs(numbers)) == pytest.approx(0.0, abs=1e-14)
        # No n-th harmonic in the bar functions: only their means reach n/2.
        bare, mean = sp.symbols("bare mean", real=True)
        y0 = A * sp.cos(region * theta / 2) + B * sp.sin(region * theta / 2)
        f = mean + bare * sp.cos((region + 1) * theta) + bare * sp.sin((region + 2) * theta)
        found = resonant(-(level + f) * y0, region)
        assert [value.subs(level, -mean) for value in found] == [0, 0]


def rig_case(region):
    """Return exact and first-order boundaries of (8.3) for (5,1,5,2), lightest follower."""
    _, f1, _, f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))
    e1, _, e3 = RIGS["5,1,5,2"].epsilon(0.0058)
    c1, c3 = fourier(f1), fourier(f3)
    width = 2 * abs(e1 * c1[region] + e3 * c3[region])
    centre = region**2 / 4 - e1 * c1[0].real - e3 * c3[0].real
    exact = np.array(boundaries(e1 * f1 + e3 * f3, region))
    return exact, np.array([centre - width / 2, centre + width / 2])


@establishes(
    "Smith",
    "8.29",
    printed=r"\lambda^2 = \left(\tfrac n2\right)^2 - \epsilon_1 a_0 - \epsilon_2 c_0 \pm "
    r"\tfrac12\delta_n + O(2)",
    verdict="approximation",
    derived=r"+ w_0 \mp \Re(W e^{i\psi_n}) + O(\epsilon^3)",
    remark="The scan has i/2 for 1/2. Error of order epsilon^2: for (5,1,5,2) with its own "
    "epsilon1 = 3.29 and epsilon3 = 3.43 the boundaries of region 1 are off by 0.89 and 0.44 in "
    "lambda^2, those of region 2 by 0.51 and 0.28.",
)
@establishes(
    "Smith",
    "8.43",
    printed=r"\lambda^2 = \left(\tfrac n2\right)^2 - a_0\epsilon_1 - c_0\epsilon_2 \pm \tfrac12"
    r"\sqrt{\epsilon_1^2(a_n^2 + b_n^2) + \epsilon_2^2(c_n^2 + d_n^2) + 2\epsilon_1\epsilon_2"
    r"(a_n c_n + b_n d_n)}",
    verdict="approximation",
    derived=r"\text{as (8.29)}",
    remark="Equal to (8.29), with its error: 0.51 and 0.28 in region 2 of (5,1,5,2).",
)
@establishes(
    "Smith",
    "8.4 width EF",
    printed=r"EF = \delta_n = \sqrt{\epsilon_1^2(a_n^2 + b_n^2) + \epsilon_2^2(c_n^2 + d_n^2) + "
    r"2\epsilon_1\epsilon_2(a_n c_n + b_n d_n)}",
    verdict="approximation",
    derived=r"EF = 2\lvert\tfrac12\delta_n e^{-i\psi_n} - W\rvert + O(\epsilon^3)",
    remark="First order. Regions 1 to 4 of (5,1,5,2), its own parameters: 2.21, 0.91, 0.63, 0.22 "
    "for the exact 2.66, 0.68, 0.23, 0.16.",
)
def test_first_order_boundaries_of_two_parameters():
    e1, e2 = eps
    an, bn, cn, dn = sp.symbols("a_n b_n c_n d_n", real=True)
    square = (e1 * an + e2 * cn) ** 2 + (e1 * bn + e2 * dn) ** 2
    printed = e1**2 * (an**2 + bn**2) + e2**2 * (cn**2 + dn**2) + 2 * e1 * e2 * (an * cn + bn * dn)
    assert sp.expand(square - printed) == 0
    errors, widths = {}, []
    for region in (1, 2, 3, 4):
        exact, first = rig_case(region)
        errors[region] = np.abs(exact - first)
        widths.append((first[1] - first[0], exact[1] - exact[0]))
    assert errors[1] == pytest.approx([0.89, 0.44], abs=0.005)
    assert errors[2] == pytest.approx([0.51, 0.28], abs=0.005)
    assert np.array(widths).T[0] == pytest.approx([2.21, 0.91, 0.63, 0.22], abs=0.005)
    assert np.array(widths).T[1] == pytest.approx([2.66, 0.68, 0.23, 0.16], abs=0.005)
    _, f1, _, f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))
    gaps = []
    for size in (0.004, 0.002):
        c = size * (fourier(f1) - 0.7 * fourier(f3))
        series = 1 - c[0].real + np.array([-1, 1]) * abs(c[2])
        gaps.append(np.abs(series - boundaries(size * (f1 - 0.7 * f3), 2)).max())
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(2.0, abs=0.1)


@establishes(
    "Smith",
    "8.36",
    printed=r"y_{100}'' + (\tfrac n2)^2 y_{100} = -\sum_{m \ge 1, m \ne n}(a_m\cos m\theta + b_m"
    r"\sin m\theta)\{A_{000}\cos\tfrac n2\theta + B_{000}\sin\tfrac n2\theta\}",
    verdict="agrees",
    derived=r"\alpha_{100} + a_0 = 0",
)
@establishes(
    "Smith",
    "8.37",
    printed=r"y_{100} = \tfrac12\sum_m\{P^{*\prime}\cos(m + \tfrac n2)\theta + Q^{*\prime}\sin(m + "
    r"\tfrac n2)\theta\} + \tfrac12\sum_{m=1}^N\{R^{*\prime}\cos(\tfrac n2 - m)\theta - S^{*\prime}"
    r"\sin(\tfrac n2 - m)\theta\} - \tfrac12(\tfrac2n)^2 T_n^* + A_{100}\cos\tfrac n2\theta + "
    r"B_{100}\sin\tfrac n2\theta",
    verdict="agrees",
    derived=r"T_n^* = A_{000}a_{n/2} + B_{000}b_{n/2}",
    remark="With the T_n of (7.27); the one that (7.28) prints has halves, and the constant would "
    "be half as large. The star only says that harmonic n is left out: it enters no other term.",
)
@pytest.mark.parametrize("region", [1, 2, 3, 4])
def test_first_order_solution(region):
    a0, b0 = 1.3, -0.6
    count = len(ONE.cosine)
    bare = ONE.without(region)
    a = np.array([0.0, *map(float, bare.cosine), *np.zeros(2 * region + count)])
    b = np.array([0.0, *map(float, bare.sine), *np.zeros(2 * region + count)])
    k = region / 2
    angle = TURN * np.arange(256) / 128

    def solution(constant):
        y = np.zeros_like(angle)
        for m in range(1, count + 1):
            p = a0 * (a[m] + a[m + region]) - b0 * (b[m] - b[m + region])
            q = a0 * (b[m] + b[m + region]) + b0 * (a[m] - a[m + region])
            scale = 0.5 / (m * (m + region))
            y += scale * (p * np.cos((m + k) * angle) + q * np.sin((m + k) * angle))
        for m in range(1, (region - 1) // 2 + 1):
            r = a0 * (a[m] + a[region - m]) + b0 * (b[m] + b[region - m])
            s = a0 * (b[m] - b[region - m]) - b0 * (a[m] - a[region - m])
            scale = -0.5 / (m * (region - m))
            y += scale * (r * np.cos((k - m) * angle) - s * np.sin((k - m) * angle))
        return y - 0.5 / k**2 * constant

    constant = a0 * a[region // 2] + b0 * b[region // 2] if region % 2 == 0 else 0.0
    waves = np.arange(1, count + 1)[:, None] * angle
    f = a[1 : count + 1] @ np.cos(waves) + b[1 : count + 1] @ np.sin(waves)
    right = -f * (a0 * np.cos(k * angle) + b0 * np.sin(k * angle))
    # y'' over the period 4 pi of these samples, by its Fourier series.
    number = np.fft.fftfreq(256, 1 / 256) / 2

    def left(y):
        return np.fft.ifft((k**2 - number**2) * np.fft.fft(y)).real

    assert left(solution(constant)) == pytest.approx(right, abs=1e-11)
    if constant:
        short = left(solution(constant / 2)) - right
        assert np.abs(short) == pytest.approx(abs(constant) / 4) and abs(constant) > 0.2


@establishes(
    "Smith",
    "8.3.3 order of the approximation",
    printed=r"\text{order } k \text{ of } \lambda^2 \text{ needs the solutions to order } k - 1",
    verdict="agrees",
    derived=r"\text{to order } k - s,\; s \text{ the order at which the boundaries part}",
    remark="s = 1 where the n-th harmonic is there. Without it, or with Rayleigh's quotient of the "
    "solution, fewer do: the quotient of y_0 + mu y_1 is right to order 3.",
)
def test_order_of_the_approximation():
    for f, s in ((ONE, 1), (ONE.without(2), 2)):
        found = strained_boundaries(f, 2, 5)
        assert found.split == s
        assert all(len(x.solutions) - 1 == 5 - s for x in found.branches)
    # Rayleigh's quotient of two terms, against the exact boundary.
    found = strained_boundaries(ONE, 2, 2).branches[0]
    angle = TURN * np.arange(128) / 128
    y = [np.array([float(w(t)) for t in angle]) for w in found.solutions]
    waves = np.arange(1, 5)[:, None] * angle
    f = 0.9 + np.array([float(x) for x in ONE.cosine]) @ np.cos(waves)
    f = f + np.array([float(x) for x in ONE.sine]) @ np.sin(waves)
    number = np.fft.fftfreq(128, 1 / 128)
    gaps = []
    for mu in (0.02, 0.01):
        whole = y[0] + mu * y[1]
        slope = np.fft.ifft(1j * number * np.fft.fft(whole)).real
        quotient = (slope @ slope - (mu * f * whole) @ whole) / (whole @ whole)
        gaps.append(abs(quotient - boundaries(mu * f, 2)[1]))
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(4.0, abs=0.2)


@establishes(
    "Smith",
    "8.38",
    printed=r"y'' + \{\lambda^2 + \epsilon_1 f_1 + \epsilon_2 f_2\}y = 0",
    verdict="agrees",
)
@establishes(
    "Smith",
    "8.39",
    printed=r"h = f_1 + \frac{\epsilon_2}{\epsilon_1}f_2",
    verdict="agrees",
    remark="For epsilon1 different from 0; with the larger parameter in front no quotient exceeds "
    "one.",
)
@establishes(
    "Smith",
    "8.40",
    printed=r"y'' + \{\lambda^2 + \epsilon_1 h\}y = 0",
    verdict="agrees",
    remark="Exactly (8.38), so that every order of chapter 7 applies along the ray, not the "
    "first one only.",
)
@establishes(
    "Smith",
    "8.41",
    printed=r"\lambda^2 = \left(\tfrac n2\right)^2 + \alpha_1\epsilon_1,\; \alpha_1 = -r_0 \pm "
    r"\tfrac12\sqrt{r_n^2 + s_n^2}",
    verdict="approximation",
    derived=r"+ \alpha_2\epsilon_1^2 + \cdots",
    remark="First order, as (8.29): 0.51 and 0.28 off in region 2 of (5,1,5,2). For epsilon1 < 0 "
    "the upper sign is the lower boundary.",
)
@establishes(
    "Smith",
    "8.42",
    printed=r"r_i = a_i + \frac{\epsilon_2}{\epsilon_1}c_i,\; s_i = b_i + \frac{\epsilon_2}"
    r"{\epsilon_1}d_i",
    verdict="agrees",
)
def test_alternative_method():
    e1, e2 = F(1, 50), F(-1, 70)
    h = combine((ONE, TWO), (1, e2 / e1))
    for m in range(5):
        pairs = zip(ONE.harmonic(m), TWO.harmonic(m), h.harmonic(m), strict=True)
        assert all(z == x + e2 / e1 * y for x, y, z in pairs)
    whole = combine((ONE, TWO), (e1, e2))
    assert all(e1 * x == y for x, y in zip(h.cosine, whole.cosine, strict=True))
    angle = TURN * np.arange(64) / 64
    waves = np.arange(1, 5)[:, None] * angle
    samples = float(whole.mean) + np.array([float(x) for x in whole.cosine]) @ np.cos(waves)
    samples = samples + np.array([float(x) for x in whole.sine]) @ np.sin(waves)
    exact = np.array(boundaries(samples, 2))
    errors = [
        np.abs(exact - alternative_method((ONE, TWO), 2, (e1, e2), order)).max()
        for order in (1, 2, 3, 4)
    ]
    assert all(later < 0.2 * sooner for sooner, later in pairwise(errors))
    for sign in (1, -1):
        upper, lower = strained_boundaries(h, 2, 1).branches
        values = [float(branch.alpha[0]) * sign for branch in (lower, upper)]
        assert (values[0] < values[1]) == (sign > 0)
    found, first = rig_case(2)
    assert np.abs(found - first) == pytest.approx([0.51, 0.28], abs=0.005)


@establishes(
    "Smith",
    "8.44",
    printed=r"\lambda^2 = \left(\tfrac n2\right)^2 - a_0\epsilon_1 \pm \tfrac12\sqrt{(a_n^2 + "
    r"b_n^2)\epsilon_1^2} = \left(\tfrac n2\right)^2 + \epsilon_1\{-a_0 \pm \tfrac12\sqrt{a_n^2 + "
    r"b_n^2}\}",
    verdict="approximation",
    derived=r"\epsilon_2 = 0 \text{ in (8.43)}",
    remark="First order: with epsilon1 = 3.29 alone, region 2 of (5,1,5,2), the boundaries are off "
    "by 0.0112 and 0.0066 in lambda^2. The width is epsilon1's modulus times the root.",
)
@establishes(
    "Smith",
    "8.4 axis PH",
    printed=r"\lambda^2 = \left(\tfrac n2\right)^2 - a_0\epsilon_2 \text{ (text)},\; \left(\tfrac "
    r"n2\right)^2 - c_0\epsilon_2 \text{ (Fig. 38)}",
    verdict="slip",
    derived=r"\lambda^2 = \left(\tfrac n2\right)^2 - c_0\epsilon_2",
    remark="c_0, as the figure has it, for on epsilon1 = 0 only f2 acts: its mean is 0.0336 for "
    "(5,1,5,2) (f3 there), that of f1 is -0.0092.",
)
@establishes(
    "Smith",
    "8.4 widths AB and CD",
    printed=r"AB = \epsilon_1\sqrt{a_n^2 + b_n^2},\; CD = \epsilon_2\sqrt{c_n^2 + d_n^2}",
    verdict="approximation",
    derived=r"2\lvert c_n\epsilon - W\epsilon^2\rvert + O(\epsilon^3)",
    remark="First order. Region 2 of (5,1,5,2): AB 0.262 for the exact 0.244 at epsilon1 = 3.29, "
    "CD 0.727 for 0.657 at epsilon3 = 3.43.",
)
def test_planes_of_the_stability_space():
    _, f1, _, f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))
    e1, _, e3 = RIGS["5,1,5,2"].epsilon(0.0058)
    means = fourier(f1)[0].real, fourier(f3)[0].real
    assert means == pytest.approx((-0.0092, 0.0336), abs=5e-5)
    size = 1e-4
    centre = np.mean(boundaries(size * f3, 2))
    assert (1 - centre) / size == pytest.approx(means[1], abs=1e-4)
    assert abs((1 - centre) / size - means[0]) > 0.04
    found = {}
    for name, e, f in (("AB", e1, f1), ("CD", e3, f3)):
        c = e * fourier(f)
        exact = np.array(boundaries(e * f, 2))
        first = 1 - c[0].real + np.array([-1, 1]) * abs(c[2])
        found[name] = (first[1] - first[0], exact[1] - exact[0], np.abs(exact - first))
    assert found["AB"][:2] == pytest.approx((0.262, 0.244), abs=5e-4)
    assert found["CD"][:2] == pytest.approx((0.727, 0.657), abs=5e-4)
    assert found["AB"][2] == pytest.approx([0.0112, 0.0066], abs=5e-5)
    low, high = boundaries(-size * f1, 2)
    assert (high - low) / size == pytest.approx(2 * abs(fourier(f1)[2]), rel=1e-3)
