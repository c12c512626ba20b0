"""Mathieu, Whittaker-Hill and Meissner in their classical notations."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.cases.named import (
    Mathieu,
    Meissner,
    WhittakerHill,
    mathieu_characteristic,
)
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.half_trace import discriminant
from elastolink.runtime.hill.perturbation.boundaries import perturbation_boundaries
from scipy.integrate import solve_ivp
from scipy.linalg import eigh_tridiagonal

# Abramowitz & Stegun table 20.1 (DLMF 28.1 cites it), all digits printed there.
TABLE = {
    (0, "a", 5): -5.80004602,
    (0, "a", 10): -13.93697996,
    (0, "a", 25): -40.25677955,
    (1, "b", 5): -5.79008060,
    (1, "b", 25): -40.25677898,
    (1, "a", 5): 1.85818754,
    (2, "a", 5): 7.44910974,
    (2, "b", 5): 2.09946045,
}


def many_digits(m, q, kind, digits=40):
    """The eigenvalue of the tridiagonal matrix of DLMF 28.4, refined by Rayleigh's quotient."""
    count = int(60 + 2 * m + 8 * abs(q) ** 0.5)
    start = {("a", 0): 0, ("b", 0): 2}.get((kind, m % 2), 1)
    d = (start + 2.0 * np.arange(count)) ** 2
    place = (m - start) // 2
    if m % 2:
        d[0] += q if kind == "a" else -q
    root = start == 0
    e = np.full(count - 1, float(q))
    e[0] *= np.sqrt(2.0) if root else 1.0
    value, vector = eigh_tridiagonal(d, e, select="i", select_range=(place, place))
    with mpmath.workdps(digits):
        diagonal, x = [mpmath.mpf(v) for v in d], [mpmath.mpf(v) for v in vector[:, 0]]
        side = [mpmath.mpf(q)] * (count - 1)
        if root:
            side[0] *= mpmath.sqrt(2)
        lam = mpmath.mpf(value[0])
        for _ in range(3):
            x = _solved(diagonal, side, lam, x)
            size = mpmath.sqrt(mpmath.fsum(v * v for v in x))
            x = [v / size for v in x]
            lam = mpmath.fsum(a * v * v for a, v in zip(diagonal, x, strict=True))
            lam += 2 * mpmath.fsum(side[i] * x[i] * x[i + 1] for i in range(count - 1))
        return lam


def _solved(diagonal, side, lam, right):
    count = len(diagonal)
    pivots, y = [diagonal[0] - lam], [right[0]]
    for i in range(1, count):
        factor = side[i - 1] / pivots[i - 1]
        pivots.append(diagonal[i] - lam - factor * side[i - 1])
        y.append(right[i] - factor * y[i - 1])
    y[-1] /= pivots[-1]
    for i in range(count - 2, -1, -1):
        y[i] = (y[i] - side[i] * y[i + 1]) / pivots[i]
    return y


@pytest.mark.parametrize(("m", "kind", "q"), TABLE)
def test_the_printed_table(m, kind, q):
    found = mathieu_characteristic(m, q, kind)
    assert float(found.value) == pytest.approx(TABLE[m, kind, q], abs=0.6e-8)


@pytest.mark.parametrize("q", [0.5, 25.0, -25.0, 1e3, -1e4, 1e4])
@pytest.mark.parametrize("m", [0, 1, 2, 7, 40, 100])
@pytest.mark.parametrize("kind", ["a", "b"])
def test_twelve_digits(m, q, kind):
    if kind == "b" and m == 0:
        with pytest.raises(BadInput, match="m"):
            mathieu_characteristic(m, q, kind)
        return
    found, wanted = mathieu_characteristic(m, q, kind), many_digits(m, q, kind)
    gap = abs(float(mpmath.mpf(float(found.value)) - wanted))
    assert gap <= found.error
    assert gap <= 1e-13 * max(abs(float(wanted)), 2 * abs(q))
    assert found.error <= 1e-12 * max(abs(float(wanted)), 2 * abs(q))
    assert found.relative_error == found.error / abs(found.value)


def test_signs_of_q():
    """DLMF 28.2.26: a_2n(-q) = a_2n(q), a_2n+1(-q) = b_2n+1(q), b_2n(-q) = b_2n(q)."""
    q = np.array([0.3, 2.0, 40.0])
    for m in (1, 2, 3, 4):
        for kind, other in (("a", "b"), ("b", "a")):
            mirrored = mathieu_characteristic(m, -q, kind).value
            wanted = mathieu_characteristic(m, q, other if m % 2 else kind).value
            np.testing.assert_allclose(mirrored, wanted, rtol=1e-13, atol=1e-12)


def test_the_characteristic_values_of_a_constant_coefficient():
    for m in (0, 1, 6):
        assert mathieu_characteristic(m, 0.0).value == m * m
    found = mathieu_characteristic(3, np.linspace(-1, 1, 5))
    assert found.value.shape == found.error.shape == (5,)
    assert found.passed and found.plot().lines


def solved(coefficient, period):
    """Half trace of x'' + coefficient(t) x = 0 over a period, by an integrator."""
    columns = []
    for start in ([1.0, 0.0], [0.0, 1.0]):
        run = solve_ivp(
            lambda t, s: [s[1], -coefficient(t) * s[0]],
            (0.0, period),
            start,
            rtol=1e-11,
            atol=1e-12,
        )
        columns.append(run.y[:, -1])
    return 0.5 * (columns[0][0] + columns[1][1])


def test_mathieus_notation():
    """The equation as printed, integrated in x, has the half trace of its Hill form."""
    a, q = 1.7, 0.9
    case = Mathieu(a, q)
    ours = discriminant(case.function(), case.lam2, case.mu).value
    assert ours == pytest.approx(solved(lambda x: a - 2 * q * np.cos(2 * x), np.pi), abs=1e-8)
    back = Mathieu.from_hill(case.lam2, case.mu)
    assert (back.a, back.q) == (a, q)


def test_the_notation_with_d_and_eps():
    d, eps = 2.3, -1.1
    case = Mathieu.from_cosine(d, eps)
    ours = discriminant(case.function(), case.lam2, case.mu).value
    assert ours == pytest.approx(solved(lambda t: d + eps * np.cos(2 * t), np.pi), abs=1e-8)
    assert (float(case.d), float(case.eps)) == (d, eps)


def test_the_notation_of_whittaker_and_hill():
    given = (2.0, 1.1, -0.7)
    case = WhittakerHill(*given)
    whole = sum(
        (f * float(v) for f, v in zip(case.functions(), case.parameters, strict=True)),
        PeriodicFunction(),
    )
    ours = discriminant(whole, case.lam2, 1.0).value
    wanted = solved(lambda x: given[0] + given[1] * np.cos(2 * x) + given[2] * np.cos(4 * x), np.pi)
    assert ours == pytest.approx(wanted, abs=1e-8)
    back = WhittakerHill.from_hill(case.lam2, *case.parameters)
    assert (back.constant, back.first, back.second) == given


@pytest.mark.parametrize("p", [0, 1, 2, 3])
@pytest.mark.parametrize("xi", [0.8, 1.7])
def test_coexistence(p, xi):
    """DLMF 28.31(ii): regions p + 2, p + 4, ... of Ince's form are closed, the others open."""
    case = WhittakerHill.ince(0.0, p, xi)
    whole = sum(
        (f * float(v) for f, v in zip(case.functions(), case.parameters, strict=True)),
        PeriodicFunction(),
    )
    regions = tuple(range(1, 8))
    found = hill_boundaries(whole, 1.0, regions)
    for n, width, error in zip(regions, found.width, found.error, strict=True):
        closed = n > p and (n - p) % 2 == 0
        assert (width <= 2 * error) == closed


def test_the_polynomials_of_ince():
    """p = 1: eta = 1 -+ xi are the ends of region 1, with exact solutions (DLMF 28.31.7, 8)."""
    xi = 1.3
    case = WhittakerHill.ince(0.0, 1, xi)
    found = perturbation_boundaries(case.functions(), [float(v) for v in case.parameters], (1,), 8)
    whole = sum(
        (f * float(v) for f, v in zip(case.functions(), case.parameters, strict=True)),
        PeriodicFunction(),
    )
    exact = hill_boundaries(whole, 1.0, (1,))
    # lam2 = A / 4 = (eta - xi^2 / 8) / 4.
    ends = (np.array([1 - xi, 1 + xi]) - xi**2 / 8) / 4
    np.testing.assert_allclose([exact.lower[0], exact.upper[0]], ends, atol=1e-13)
    inside = ~found.outside[0]
    assert not inside or abs(found.lower[0] - ends[0]) <= found.error[0]


def test_coexistence_to_an_order():
    """The closed interval of a two-parameter case: its width is within the figure."""
    case = WhittakerHill.ince(0.0, 0, 0.5)
    found = perturbation_boundaries(
        case.functions(), [float(v) for v in case.parameters], (2, 4), 8
    )
    assert not found.outside.any()
    assert np.all(found.width <= 2 * found.error)
    assert np.all(found.error < 1e-6)


@pytest.mark.parametrize(
    "case", [Meissner(), Meissner((2.0, -0.5), (2.0, 2 * np.pi - 2.0))], ids=["even", "uneven"]
)
def test_meissners_function(case):
    series = case.function(300)
    theta = np.linspace(0.0, 2 * np.pi, 4001)
    gap = np.abs(series(theta) - case(theta))
    assert gap.max() <= series.error
    assert series.error < 0.51 * abs(case.jump)
    # Coefficients by quadrature on either interval.
    for m in (0, 1, 2, 7):
        t = np.array([0.0, case.lengths[0], 2 * np.pi])
        pieces = [
            level * (np.exp(-1j * m * b) - np.exp(-1j * m * a)) / (-1j * m)
            if m
            else level * (b - a)
            for level, a, b in zip(case.levels, t[:-1], t[1:], strict=True)
        ]
        c = sum(pieces) / (2 * np.pi)
        scale = 2.0 if m else 1.0
        assert series.a[m] == pytest.approx(scale * c.real, abs=1e-15)
        assert series.b[m] == pytest.approx(-scale * np.imag(c), abs=1e-15)


def test_meissners_boundaries_from_the_series():
    """The cut series nears the closed form; its worst-case figure covers what is left."""
    case = Meissner((1.0, -0.5), (2.0, 2 * np.pi - 2.0))
    exact = case.boundaries(0.4, (1, 2, 3))
    gaps = []
    for harmonics in (20, 80):
        near = hill_boundaries(case.function(harmonics), 0.4, (1, 2, 3))
        gap = np.abs(near.upper - exact.upper)
        assert np.all(gap <= near.error + exact.error)
        gaps.append(gap.max())
    assert gaps[1] < 0.1 * gaps[0]


@pytest.mark.parametrize(
    ("call", "where"),
    [
        (lambda: mathieu_characteristic(1, 1.0, "c"), "kind"),
        (lambda: mathieu_characteristic(-1, 1.0), "m"),
        (lambda: mathieu_characteristic(1.0, 1.0), "m"),
        (lambda: mathieu_characteristic(501, 1.0), "m"),
        (lambda: mathieu_characteristic(1, 1e7), "q"),
        (lambda: mathieu_characteristic(1, np.nan), "q"),
        (lambda: Meissner((1.0, np.inf)), "levels"),
        (lambda: Meissner((1.0, 0.0), (1.0, 2.0)), "lengths"),
        (lambda: Meissner((1.0, 0.0, 2.0)), "Meissner"),
        (lambda: Meissner().function(0), "harmonics"),
        (lambda: Mathieu(np.nan, 1.0).lam2, "a"),
    ],
)
def test_bad_input(call, where):
    with pytest.raises(BadInput, match=where):
        call()
