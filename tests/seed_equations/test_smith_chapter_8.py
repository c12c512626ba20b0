"""Smith (8.1)-(8.22): several parameters, the standard method, and what it asks for."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from seed_ledger import Ledger, derivative, hold, holds, quoted, same
from seed_rigs import RIGS
from seed_series import TWO_FUNCTIONS, couplings, eps, rows
from seed_truth import CRANK_ROCKERS, boundaries, coupler_functions, fourier, motion, named
from seed_waves import THETA, Coefficients, function, resonance, series

row = Ledger("Smith", __file__)
RIG = RIGS["5,1,5,2"]


@cache
def rig():
    """Return the rig's functions of the angle, its parameters and lengths."""
    m = motion(CRANK_ROCKERS["5,1,5,2"])
    functions = dict(zip(("phi", "f1", "f2", "f3"), coupler_functions(m), strict=True))
    parameters = dict(zip(("eps1", "eps2", "eps3"), RIG.epsilon(0.0058), strict=True))
    mu, l3 = RIG.mass_per_length, RIG.lengths[2]
    data = {"I3": mu * l3**3 / 3, "I4": 0.0058, "mu": mu, "r3": l3 / 2, "k3": l3 / 3**0.5}
    turning = {k: 2 * v if k.startswith("omega") else v for k, v in vars(m).items()}
    turning |= {k: 4 * v for k, v in vars(m).items() if k.startswith("alpha")}
    more = {"omega2": 2.0, "Omega": 6.6, "lam": 3.3}
    return {**named(RIG.lengths), **turning, **functions, **parameters, **data, **more}


def coefficient(entry, **more):
    """Return the periodic part of the printed coefficient: y = 1, y'' = 0, no lambda."""
    left, _ = entry.printed.sides(**{**rig(), **more, "lam": 0.0, "y": 1.0}, D=_flat, g=0, theta=0)[
        0
    ]
    return left


def _flat(*_):
    return 0.0


def definition(entry):
    """The equation itself: lambda^2 and y'' stand alone."""
    still = dict.fromkeys(("phi", "f1", "f2", "f3", "g"), 0.0)
    point = {**rig(), **still, "theta": 0, "y": 0.7, "D": derivative(2, 0.3)}
    left, zero = entry.printed.sides(**point)[0]
    same(left, 0.3 + rig()["lam"] ** 2 * 0.7)
    assert zero == 0


def limits(samples):
    return np.array(boundaries(samples, 2))


@row("8.1")
def equation_of_one_mode(entry):
    definition(entry)
    p = rig()
    rest = coefficient(entry) - p["eps3"] * p["f3"]
    quoted([np.abs(rest).max()], "0.57")
    bare = dict.fromkeys(("eps1", "eps2"), 0.0)
    quoted([(-coefficient(entry, eps3=0.0, **bare)).max()], "0.068")
    assert (
        np.abs(coefficient(entry, eps1=0.0) - coefficient(entry) + p["eps1"] * p["f1"]).max()
        < 1e-12
    )


@row("8.1 parameters of (6.17)")
def parameters(entry):
    hold(entry.corrected, {k: rig()[k] for k in ("I3", "mu", "l3", "eps1")})
    for k in range(1, 8):
        hold(entry.printed[k], rig(), tol=1e-8)
    quoted([entry.printed[0].value(**rig()), rig()["eps1"]], "49.348", "3.29")


@row("8.2")
def two_parameters(entry):
    definition(entry)
    p = rig()
    kept = limits(coefficient(entry))
    with_phi = limits(coefficient(entry) - p["phi"])
    whole = limits(coefficient(entry) - p["phi"] + p["eps2"] * p["f2"])
    assert with_phi - kept == pytest.approx([0.016, 0.023], abs=5e-4)
    assert whole - with_phi == pytest.approx([-0.088, -0.099], abs=5e-4)
    rpm = [26 * 60 / np.sqrt(x) for x in (kept, with_phi)]
    assert rpm[0] == pytest.approx([1585, 1215], abs=0.6)
    assert rpm[1] == pytest.approx([1572, 1206], abs=0.6)


@row("8.3", "8.38")
def reduced_equation(entry):
    p = rig()
    definition(entry)
    same(coefficient(entry), p["eps1"] * p["f1"] + p["eps2"] * p["f2"])


def nth(samples, region):
    c = fourier(samples)[region]
    return 2 * c.real, -2 * c.imag


def half_width(x, y):
    """Return half the width of region 2 per unit along a direction."""
    low, high = boundaries(1e-4 * (x * rig()["f1"] + y * rig()["f3"]), 2)
    return (high - low) / 2e-4


@row("8.4")
def no_series_of_the_boundaries(entry):
    """The first order that a series can have, against the width along a third direction."""
    widths = [half_width(1, 0), half_width(0, 1), half_width(1, 1)]
    quoted(widths, "0.040", "0.106", "0.134")
    for sign, quote in ((1, "0.146"), (-1, "0.066")):
        alpha = {(0, 0): 1.0, (1, 0): widths[0] * sign, (0, 1): widths[1]}
        alpha[1, 1] = 0.0
        point = {"eps1": 1e-4, "eps2": 1e-4, "alpha": alpha, "oo": 1, "n": 2, "lam": 2.0}
        lam2, printed = entry.printed.sides(**point)[0]
        assert lam2 == 4
        quoted([(printed - 1) / 1e-4], quote)
    assert entry.printed[1].sides(n=3, alpha={(0, 0): 9 / 4})[0] == (9 / 4, 9 / 4)
    powers = np.random.default_rng(5).normal(size=(3, 3))
    printed = entry.printed.sides(eps1=0.3, eps2=-0.7, alpha=powers, oo=2, n=2, lam=2.0)[0][1]
    same(printed, np.polynomial.polynomial.polyval2d(0.3, -0.7, powers))
    for x, y in ((1, 0), (0, 1), (1, 1)):
        (a, b), (c, d) = nth(rig()["f1"], 2), nth(rig()["f3"], 2)
        tables = {"a": {2: a}, "b": {2: b}, "c": {2: c}, "d": {2: d}, "n": 2, "lam": 2.0}
        point = {**tables, "eps1": x, "eps2": y, "a0": 0.0, "c0": 0.0}
        both = [entry.corrected.sides(**point, pm=s)[0] for s in (1, -1)]
        assert both[0][0] == 4 and (both[0][1] + both[1][1]) / 2 == 1
        assert (both[0][1] - both[1][1]) / 2 == pytest.approx(half_width(x, y), rel=1e-3)
    shifted = entry.corrected.sides(**{**point, "a0": 0.3, "c0": -0.4, "eps2": 0.5}, pm=1)[0][1]
    centre = entry.corrected.sides(**{**point, "eps2": 0.5}, pm=1)[0][1] - 0.3 + 0.2
    assert shifted == pytest.approx(centre)


@row("8.5")
def no_series_of_the_solution(entry):
    """One y_00 cannot be both limits along the axes."""
    rng = np.random.default_rng(1)
    table = rng.normal(size=(3, 3))
    point = {"ys": table, "oo": 2, "eps1": 0.3, "eps2": -0.7}
    same(entry.printed.values(**point)["y"], np.polynomial.polynomial.polyval2d(0.3, -0.7, table))
    assert entry.printed.values(**{**point, "eps1": 0, "eps2": 0})["y"] == table[0, 0]
    for x, y, ratio in ((1, 0, "-1.20"), (0, 1, "-4.04"), (0.8, 1, "-2.82")):
        (a, b), (c, d) = nth(rig()["f1"], 2), nth(rig()["f3"], 2)
        tables = {"a": {2: a}, "b": {2: b}, "c": {2: c}, "d": {2: d}, "n": 2, "pm": 1}
        printed = entry.corrected.sides(**tables, eps1=x, eps2=y, A_00=1.0, B_00=float(ratio))[0]
        quoted(printed, ratio, ratio)
        samples = Coefficients({2: x * a + y * c}), Coefficients({2: x * b + y * d})
        _, (A, B) = resonance(function(*samples), 2)[0]
        assert pytest.approx(printed[1]) == B / A


def is_row(parameters, names, key):
    """Return the check that left less right side is the machine's equation of one power."""

    def check(entry):
        equations, letters = rows(parameters, names)
        one, other = entry.printed.sides(**letters)[0]
        same(one - other, equations[key])

    return check


TWO = (eps, ("f1", "f2"))
for label, key in {
    "8.6": (0, 0), "8.7": (1, 0), "8.8": (0, 1), "8.9": (2, 0), "8.10": (0, 2), "8.11": (1, 1),
}.items():  # fmt: skip
    row(label, check=is_row(*TWO, key), derived=lambda key=key: [rows(*TWO)[0][key]])


@cache
def either():
    """Return what either function makes resonant in regions 1 to 3, under the letters of 8.2."""
    points = []
    for n in (1, 2, 3):
        tables, values = {}, {"n": n, "theta": THETA}
        for k, names in enumerate((("a", "b", "f1"), ("c", "d", "f2"))):
            x, y = TWO_FUNCTIONS[k]
            tables |= {names[0]: x, names[1]: y, names[2]: function(x, y), f"{names[0]}0": x[0]}
        for sign in (1, -1):
            (one, (A, B)), (two, (C, D)) = (
                resonance(tables[f], n)[(1 - sign) // 2] for f in ("f1", "f2")
            )
            roots = {"alpha_10": one, "alpha_01": two, "A_00": A, "B_00": B, "pm": sign, "oo": 4}
            y = A * np.cos(n / 2 * THETA) + B * np.sin(n / 2 * THETA)
            points.append({**values, **tables, **roots, "y_00": y, "of_second": (C, D)})
    return points


def second_function():
    """Return the same points with the zero-order solution of the second function."""
    return [{**p, "A_00": p["of_second"][0], "B_00": p["of_second"][1]} for p in either()]


row("8.12", "8.13", "8.15", check=holds(either))
row("8.16", check=holds(second_function))


@row("8.14")
def first_order_of_either_function(entry):
    hold(entry.corrected, either)
    a, b = nth(rig()["f1"], 2)
    tables = {"a": {2: a}, "b": {2: b}, "c": {2: b}, "d": {2: a}, "n": 2, "a0": 0.1, "c0": 0.2}
    values = entry.printed.values(**tables, pm=1)
    quoted([values["alpha_10"] + 0.1, values["alpha_01"] + 0.2], "1.02", "5.57")
    quoted([half_width(1, 0)], "0.040")
    point = {**either()[0], "b": {1: 2.0}, "d": {1: 2.0}, "pm": -1}
    point = {k: v for k, v in point.items() if "alpha" not in k}
    quoted(list(entry.printed.values(**point).values()), "-1.901", "-1.877")


@row("8.17")
def one_zero_order_solution(entry):
    a, b, c, d, ratio = sp.symbols("a b c d r", real=True)
    # The ratios B/A of (8.15), (8.16) are the roots of these: a common one, or a common other.
    same_root = sp.resultant(
        b * ratio**2 + 2 * a * ratio - b, d * ratio**2 + 2 * c * ratio - d, ratio
    )
    same(same_root, -4 * (a * d - b * c) ** 2)
    letters = {str(s): {1: s} for s in (a, b, c, d)} | {"n": sp.Integer(1)}
    one, other = entry.printed.sides(**letters)[0]
    same((one - other) * b * d, a * d - b * c)
    left, zero = entry.corrected.sides(**letters)[0]
    same(-4 * (left - zero) ** 2, same_root)
    for values in ({b: 0, d: 0}, {a: 2, b: 3, c: -4, d: -6}, {a: 0, c: 0}, {c: 0, d: 0}):
        assert same_root.subs(values) == 0
    ratios = [y / x for x, y in (nth(rig()["f1"], 2), nth(rig()["f3"], 2))]
    quoted(ratios, "5.48", "0.53")
    # Proportional n-th harmonics, other harmonics mixed: the third order grows like 1/delta_n.
    cosines, sines = ((0.8, 0.4, 0.5), (-0.5, 0.6, 0.0)), ((0.3, 0.2, -1 / 3), (0.7, 0.3, 0.0))
    third = []
    for off in (0.01, 0.001):
        x = Coefficients(enumerate([0, *np.dot((0.6 + off, -0.4), cosines)]))
        y = Coefficients(enumerate([0, *np.dot((0.6 + off, -0.4), sines)]))
        upper, lower = (series(x, y, 2, sign, 3)[0][2] for sign in (1, -1))
        third.append(abs(upper - lower) / 2)
    quoted(third, "0.52", "5.25")


def collected():
    """Return points of (8.18): the n-th harmonics in one by complex numbers."""
    y = 0.6
    for n in (1, 2):
        for e1, e2 in ((1.0, 0.5), (-0.7, 0.4)):
            (a, b), (c, d) = TWO_FUNCTIONS
            whole = e1 * (a[n] - 1j * b[n]) + e2 * (c[n] - 1j * d[n])
            f1, f2 = function(a, b), function(c, d)
            second = -(1.3**2 + e1 * f1 + e2 * f2) * y
            point = {"eps1": e1, "eps2": e2, "n": n, "a": a, "b": b, "c": c, "d": d, "y": y}
            point |= {"f1": f1, "f2": f2, "theta": THETA, "lam": 1.3, "D": derivative(2, second)}
            point |= {"delta": {n: abs(whole)}, "psi": {n: -np.angle(whole)}}
            yield {**point, "delta_n": abs(whole), "psi_n": -np.angle(whole)}


row("8.18", check=holds(collected))


@row("8.19")
def nth_harmonics_in_one(entry):
    hold(entry.printed, collected)
    # A point in the second quadrant: the principal value of the tangent gives minus the function.
    tables = {"a": {2: -2.0}, "b": {2: 1.0}, "c": {2: 0.4}, "d": {2: 0.6}, "n": 2}
    point = {**tables, "eps1": 1.0, "eps2": 0.5, "psi_n": 0.0}
    tangent = entry.printed[1].sides(**point)[0][1]
    u, v = -2.0 + 0.5 * 0.4, 1.0 + 0.5 * 0.6
    right = u * np.cos(2 * THETA) + v * np.sin(2 * THETA)
    assert np.hypot(u, v) * np.cos(2 * THETA - np.arctan(tangent)) == pytest.approx(-right)


@row("8.2 delta_n for proportional harmonics")
def proportional_harmonics(entry):
    point = {
        "a": {1: 2.0},
        "b": {1: 3.0},
        "c": {1: 4.0},
        "d": {1: 6.0},
        "n": 1,
        "eps1": 1,
        "eps2": 1,
    }
    for e2 in (1.0, -0.8):
        hold(entry.corrected, {**point, "eps2": e2, "delta_n": np.hypot(2 + 4 * e2, 3 + 6 * e2)})
    quoted([np.hypot(6, 9), entry.printed.values(**point)["delta_n"]], "10.8", "9.0")
    quoted([entry.printed.values(**{**point, "eps1": 0.3, "eps2": -0.8})["delta_n"]], "-3.245")


@row("8.20")
def no_series_in_three_parameters(entry):
    """To the second order alpha_ijk depends on psi_n."""
    w, W = couplings(2, 0, 1)
    turns = 2 * w - 2 * (W * np.exp(1j * np.linspace(0, 2 * np.pi, 721))).real
    quoted([turns.min(), turns.max()], "-0.34", "0.63")
    alpha = np.random.default_rng(2).normal(size=(3, 3, 3))
    powers = {"eps1": 0.3, "eps2": -0.2, "delta_n": 0.4, "lam": 2.0}
    four, printed = entry.printed.sides(**powers, alpha=alpha, oo=2, n=3)[0]
    same([four, printed], [4, np.polynomial.polynomial.polyval3d(0.3, -0.2, 0.4, alpha)])
    assert entry.printed[1].sides(n=3, alpha={(0, 0, 0): 9 / 4})[0] == (9 / 4, 9 / 4)
    gaps = []
    for size in (0.04, 0.02):
        e = np.array([0.9, -0.7]) * size
        f = e[0] * function(*TWO_FUNCTIONS[0]) + e[1] * function(*TWO_FUNCTIONS[1])
        c = fourier(f[:128])
        numbers = [j for j in range(-9, 10) if j]
        w0 = -sum(abs(c[j]) ** 2 / (j * (j + 2)) for j in numbers if j != -2)
        W = sum(c[j] * c[2 - j] / (j * (2 - j)) for j in numbers if j != 2)
        point = {"n": 2, "a0": 0.9, "c0": 0.8, "eps1": e[0], "eps2": e[1], "w0": w0, "W": W}
        point |= {"delta_n": 2 * abs(c[2]), "psi_n": -np.angle(c[2]), "lam": 2.0}
        four, upper = entry.corrected.sides(**point, pm=1)[0]
        lower = entry.corrected.sides(**point, pm=-1)[0][1]
        assert four == 4
        gaps.append(np.abs(np.array([lower, upper]) - boundaries(f[:128], 2)).max())
    assert np.log2(gaps[0] / gaps[1]) > 2.8


@row("8.21")
def no_periodic_second_order(entry):
    """The second condition of y_200 is left with the imaginary part of W exp(i psi_n)."""
    quoted([abs(couplings(2, 0, 0)[1])], "0.067")
    table = np.random.default_rng(3).normal(size=(3, 3, 3))
    powers = {"eps1": 0.3, "eps2": -0.2, "delta_n": 0.4}
    value = entry.printed.values(**powers, ys=table, oo=2)["y"]
    same(value, np.polynomial.polynomial.polyval3d(0.3, -0.2, 0.4, table))


@row("8.22")
def substituted(entry):
    """As a product of series; the second derivative stands for any linear operation."""
    rng = np.random.default_rng(4)
    alpha, table = rng.normal(size=(2, 3, 3, 3))
    x, y, z, n = 0.3, -0.2, 0.4, 2
    (a, b), (c, d) = TWO_FUNCTIONS
    letters = {"a": a, "b": b, "c": c, "d": d, "alpha": alpha, "ys": table, "oo": 2, "n": n}
    point = {**letters, "eps1": x, "eps2": y, "delta_n": z, "psi_n": 0.7, "theta": 0.9}
    left, zero = entry.printed.sides(**point, MM=4, D=lambda v, _, k: 3.1 ** (k - 1) * v)[0]
    bar1, bar2 = (
        sum(p[m] * np.cos(0.9 * m) + q[m] * np.sin(0.9 * m) for m in range(5) if m != n)
        for p, q in TWO_FUNCTIONS
    )
    lam2, whole = (np.polynomial.polynomial.polyval3d(x, y, z, v) for v in (alpha, table))
    true = 3.1 * whole + (lam2 + x * bar1 + y * bar2 + z * np.cos(n * 0.9 - 0.7)) * whole
    same(left, true)
    assert zero == 0


test_row, test_falsified_row = row.tests()
