"""Smith chapter 8: several parameters by the standard, the modified and the alternative method."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_series
from seed_ledger import Ledger, derivative, hold, holds, is_difference, order_of, quoted, same
from seed_rigs import RIGS
from seed_truth import CRANK_ROCKERS, boundaries, coupler_functions, fourier, motion, turning
from seed_waves import (
    THETA,
    TWO_FUNCTIONS,
    Coefficients,
    couplings,
    delta,
    eps,
    function,
    harmonics,
    hill_region,
    parts,
    resonance,
    rows,
    second_order,
    solved,
)
from seed_waves import derivative as wave_derivative

row = Ledger("Smith", __file__)
RIG = RIGS["5,1,5,2"]


@cache
def rig():
    """Return the rig's functions of the angle with their harmonics, its parameters and lengths."""
    m = motion(CRANK_ROCKERS["5,1,5,2"])
    functions = dict(zip(("phi", "f1", "f2", "f3"), coupler_functions(m), strict=True))
    parameters = dict(zip(("eps1", "eps2", "eps3"), RIG.epsilon(0.0058), strict=True))
    mu, l3 = RIG.mass_per_length, RIG.lengths[2]
    data = {"I3": mu * l3**3 / 3, "I4": 0.0058, "mu": mu, "r3": l3 / 2, "k3": l3 / 3**0.5}
    more = {"Omega": 6.6, "lam": 3.3}
    return {**turning(RIG.lengths, m, 2.0), **functions, **parameters, **data, **more}


@cache
def harmonics_of_both():
    """Return the harmonics of f1 and f3 under the letters of two functions."""
    (a, b), (c, d) = harmonics(rig()["f1"]), harmonics(rig()["f3"])
    return {"a": a, "b": b, "c": c, "d": d, "a0": a[0], "c0": c[0], "lam": 2.0}


def coefficient(entry, **more):
    """Return the periodic part of the printed coefficient: y = 1, y'' = 0, no lambda."""
    still = {"lam": 0.0, "y": 1.0, "D": lambda *_: 0.0, "g": 0, "theta": 0}
    return entry.printed.sides(**{**rig(), **more, **still})[0][0]


def definition(entry):
    """The equation itself: lambda^2 and y'' stand alone."""
    still = dict.fromkeys(("phi", "f1", "f2", "f3", "g"), 0.0)
    point = {**rig(), **still, "theta": 0, "y": 0.7, "D": derivative(2, 0.3)}
    left, zero = entry.printed.sides(**point)[0]
    same(left, 0.3 + rig()["lam"] ** 2 * 0.7)
    assert zero == 0


@row("8.1")
def equation_of_one_mode(entry):
    definition(entry)
    p = rig()
    rest = coefficient(entry) - p["eps3"] * p["f3"]
    quoted([np.abs(rest).max()], "0.57")
    bare = dict.fromkeys(("eps1", "eps2"), 0.0)
    quoted([(-coefficient(entry, eps3=0.0, **bare)).max()], "0.068")
    first = coefficient(entry) - coefficient(entry, eps1=0.0)
    assert np.abs(first - p["eps1"] * p["f1"]).max() < 1e-12


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
    kept = boundaries(coefficient(entry), 2)
    with_phi = boundaries(coefficient(entry) - p["phi"], 2)
    whole = boundaries(coefficient(entry) - p["phi"] + p["eps2"] * p["f2"], 2)
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


def half_width(x, y):
    """Return half the width of region 2 per unit along a direction."""
    return np.ptp(exact(2, 1e-4 * x, 1e-4 * y)) / 2e-4


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
        point = harmonics_of_both() | {"n": 2, "eps1": x, "eps2": y, "a0": 0.0, "c0": 0.0}
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
        point = harmonics_of_both() | {"n": 2, "pm": 1, "eps1": x, "eps2": y}
        printed = entry.corrected.sides(**point, A_00=1.0, B_00=float(ratio))[0]
        quoted(printed, ratio, ratio)
        _, (A, B) = resonance(function(*harmonics(x * rig()["f1"] + y * rig()["f3"])), 2)[0]
        assert pytest.approx(printed[1]) == B / A


def is_row(parameters, names, key):
    """Return the check that left less right side is the machine's equation of one power."""

    def row_and_letters():
        equations, letters = rows(parameters, names)
        return equations[key], letters

    return is_difference(row_and_letters)


PAIR = (eps, ("f1", "f2"))
for label, key in {
    "8.6": (0, 0), "8.7": (1, 0), "8.8": (0, 1), "8.9": (2, 0), "8.10": (0, 2), "8.11": (1, 1),
}.items():  # fmt: skip
    row(label, check=is_row(*PAIR, key), derived=lambda key=key: [rows(*PAIR)[0][key]])


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
    a, b = harmonics(rig()["f1"])
    values = entry.printed.values(a=a, b=b, c=b, d=a, n=2, a0=0.1, c0=0.2, pm=1)
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
    p = harmonics_of_both()
    ratios = [p["b"][2] / p["a"][2], p["d"][2] / p["c"][2]]
    quoted(ratios, "5.48", "0.53")
    # Proportional n-th harmonics, other harmonics mixed: the third order grows like 1/delta_n.
    cosines, sines = ((0.8, 0.4, 0.5), (-0.5, 0.6, 0.0)), ((0.3, 0.2, -1 / 3), (0.7, 0.3, 0.0))
    third = []
    for off in (0.01, 0.001):
        x, y = ([0, *np.dot((0.6 + off, -0.4), rows_)] for rows_ in (cosines, sines))
        found = boundary_series(PeriodicFunction(x, y), 2, 3)
        third.append(abs(found.upper - found.lower)[2] / 2)
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
    point = {"a": {1: 2.0}, "b": {1: 3.0}, "c": {1: 4.0}, "d": {1: 6.0}}
    point |= {"n": 1, "eps1": 1, "eps2": 1}
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
    kept = (0, 1, 3, 4)
    bar1, bar2 = (
        sum(p[m] * np.cos(0.9 * m) + q[m] * np.sin(0.9 * m) for m in kept) for p, q in TWO_FUNCTIONS
    )
    lam2, whole = (np.polynomial.polynomial.polyval3d(x, y, z, v) for v in (alpha, table))
    true = 3.1 * whole + (lam2 + x * bar1 + y * bar2 + z * np.cos(n * 0.9 - 0.7)) * whole
    same(left, true)
    assert zero == 0


ONE = TWO_FUNCTIONS[0]
THREE = ((*eps, delta), ("f1_bar", "f2_bar", "wave"))
TURN = slice(0, 128)  # of the grid over two turns


RIGHT = r",\; \alpha_{%s} = %s"
FOUND = {
    "8.30": RIGHT % (200, r"w_{11} \mp \Re(W_{11}e^{i\psi_n})"),
    "8.31": RIGHT % ("020", r"w_{22} \mp \Re(W_{22}e^{i\psi_n})"),
    "8.32": RIGHT % ("002", r"-\tfrac{1}{8n^2}"),
    "8.33": RIGHT % (110, r"2w_{12} \mp 2\Re(W_{12}e^{i\psi_n})"),
    "8.34": RIGHT % (101, r"\pm\tfrac{1}{4n^2}(a_{2n}\cos2\psi_n + b_{2n}\sin2\psi_n)"),
    "8.35": RIGHT % ("011", r"\pm\tfrac{1}{4n^2}(c_{2n}\cos2\psi_n + d_{2n}\sin2\psi_n)"),
}
KEYS = {
    "8.23": (0, 0, 0), "8.24": (1, 0, 0), "8.25": (0, 1, 0), "8.26": (0, 0, 1), "8.30": (2, 0, 0),
    "8.31": (0, 2, 0), "8.32": (0, 0, 2), "8.33": (1, 1, 0), "8.34": (1, 0, 1), "8.35": (0, 1, 1),
}  # fmt: skip


def shown(label):
    """Return the derived equation of one order in LaTeX, and what it gives."""
    return lambda: f"{sp.latex(rows(*THREE)[0][KEYS[label]])} = 0{FOUND.get(label, '')}"


for label, key in KEYS.items():
    row(label, check=is_row(*THREE, key), derived=shown(label))


@pytest.mark.parametrize("psi", [0.3, 1.9, 4.0])
@pytest.mark.parametrize("sign", [1, -1])
def test_second_order_coefficients_of_the_modified_method(psi, sign):
    """What (8.30)-(8.35) give, n = 2: projections on y_000 and across it, on the grid."""
    order, half = 2, THETA - psi / 2
    y000, across = (np.sin(half), np.cos(half)) if sign > 0 else (np.cos(half), -np.sin(half))

    def projected(right):
        c, s = parts(right, order)
        pair = [(parts(y, order)[0] * c + parts(y, order)[1] * s) for y in (y000, across)]
        return np.array(pair)

    bars = [function(*({**p, 2: 0.0} for p in pair)) for pair in TWO_FUNCTIONS]
    wave = np.cos(order * THETA - psi)
    first = {k: -TWO_FUNCTIONS[k][0][0] for k in (0, 1)} | {2: sign / 2}
    functions = [*bars, wave]
    y = [solved(-(first[k] + functions[k]) * y000, order) for k in range(3)]

    def condition(j, k):
        """Return what alpha has to be, and what is left over; the constants of y are zero."""
        right = -(first[j] + functions[j]) * y[k]
        return projected(right if j == k else right - (first[k] + functions[k]) * y[j])

    for (j, k), times in {(0, 0): 1, (1, 1): 1, (0, 1): 2}.items():
        w, W = couplings(order, j, k)
        turned = W * np.exp(1j * psi)
        alpha, excess = condition(j, k)
        assert alpha == pytest.approx(times * (w - sign * turned.real), abs=1e-12)
        assert abs(excess) == pytest.approx(times * abs(turned.imag), abs=1e-12)
        # No constant of y_100, y_010 changes them: what it multiplies has no resonant part.
        assert np.abs(projected((first[j] + functions[j]) * across)).max() < 1e-12
    assert condition(2, 2) == pytest.approx([-1 / 32, 0.0], abs=1e-12)
    for j in (0, 1):
        a, b = TWO_FUNCTIONS[j]
        expected = sign / 16 * (a[4] * np.cos(2 * psi) + b[4] * np.sin(2 * psi))
        assert condition(j, 2)[0] == pytest.approx(expected, abs=1e-12)
        # The constant of y_100 meets the second condition: it stands there with a factor.
        assert abs(projected((first[2] + wave) * across)[1]) > 0.5


def turned(sign=1):
    """Return the zero-order solution of the modified method in the frame of psi_n."""
    for order in (1, 2, 3):
        half = (order * THETA - 0.4) / 2
        f = np.cos(order * THETA - 0.4)
        for alpha, (A, B) in resonance(f, order):
            # In the frame of psi_n.
            a, b = A * np.cos(0.2) + B * np.sin(0.2), B * np.cos(0.2) - A * np.sin(0.2)
            a, b = (np.round(x, 12) for x in (a, b))
            y = a * np.cos(half) + b * np.sin(half)
            second = -(alpha + f) * y - order**2 / 4 * 0.3
            letters = {"n": order, "theta": THETA, "psi_n": 0.4, "A_000_p": a, "B_000_p": b}
            yield {**letters, "alpha_001": alpha, "y_001": 0.3, "D": derivative(2, second)}


@row("8.3.2 first-order coefficients")
def means_alone(entry):
    """With harmonic n left out only the means reach n/2."""
    for order in (1, 2, 3):
        (a, b), (c, d) = ([Coefficients({**x, order: 0.0}) for x in pair] for pair in TWO_FUNCTIONS)
        levels = [v for pair in ((a, b), (c, d)) for v, _ in resonance(function(*pair), order)]
        point = {"alpha_100": levels[0], "alpha_010": levels[2], "a0": a[0], "c0": c[0]}
        hold(entry.printed, point, {**point, "alpha_100": levels[1], "alpha_010": levels[3]})


@row("8.3.2 equation of y_001")
def equation_of_y_001(entry):
    hold(entry.corrected, turned)
    hold(entry.printed, *({**p, "alpha_001": -p["alpha_001"]} for p in turned()))


row("8.27", check=holds(turned))


@row("8.28")
def either_constant(entry):
    """A' = 0 goes with the first value, B' = 0 with the second."""
    values = [right for _, right in entry.printed.sides(A_000_p=0, B_000_p=0, alpha_001=0)]
    for point in turned():
        zero, level = ("A_000_p", values[1]) if point["alpha_001"] > 0 else ("B_000_p", values[3])
        assert point[zero] == pytest.approx(0.0, abs=1e-12)
        assert point["alpha_001"] == pytest.approx(level)
    assert values[::2] == [0, 0]


def both_parameters():
    """Return the harmonics of f1 and f3 with their parameters."""
    return harmonics_of_both() | {"eps1": rig()["eps1"], "eps2": rig()["eps3"]}


def letters(region, **more):
    """Return the rig's letters with delta_n of a region."""
    p = both_parameters() | {"n": region, **more}
    whole = [p["eps1"] * p[x][region] + p["eps2"] * p[y][region] for x, y in ("ac", "bd")]
    p |= {"delta_n": np.hypot(*whole), "psi_n": np.arctan2(*whole[::-1])}
    mean = p["a0"] * p["eps1"] + p["c0"] * p["eps2"]
    alpha1 = (-mean + more.get("pm", 1) * p["delta_n"] / 2) / p["eps1"]
    tables = {"r": {}, "s": {}}
    for name, (x, y) in {"r": "ac", "s": "bd"}.items():
        tables[name] = {k: p[x][k] + p["eps2"] / p["eps1"] * p[y][k] for k in range(1, 9)}
    return {**p, **tables, "r0": mean / p["eps1"], "alpha1": alpha1}


def both(entry, region, **more):
    """Return both printed boundaries, lower first; the left side is lambda^2."""
    sides = []
    for sign in (-1, 1):
        point = letters(region, pm=sign, **more)
        if entry.label == "8.41":
            point["alpha1"] = entry.printed.values(
                **{k: v for k, v in point.items() if k != "alpha1"}
            )["alpha1"]
        first = entry.printed.sides(**point)[0]
        assert all(s == pytest.approx(first[1]) for s in first[2:]) and first[0] == 4
        sides.append(first[1])
    return np.array(sides)


def exact(region, x, y):
    return boundaries(x * rig()["f1"] + y * rig()["f3"], region)


@row("8.29", "8.43", "8.41")
def first_order_boundaries(entry):
    p = both_parameters()
    error = {k: np.abs(both(entry, k) - exact(k, p["eps1"], p["eps2"])) for k in (1, 2)}
    quoted(error[1], "0.89", "0.44")
    quoted(error[2], "0.51", "0.28")

    def gap(h):
        return np.abs(both(entry, 2, eps1=h, eps2=-0.7 * h) - exact(2, h, -0.7 * h)).max()

    assert order_of(gap, 0.004) == pytest.approx(2.0, abs=0.1)


@row("8.4 width EF")
def width_of_both(entry):
    p = both_parameters()
    quotes = (("2.21", "2.66"), ("0.91", "0.68"), ("0.63", "0.23"), ("0.22", "0.16"))
    for region, (quote, true) in enumerate(quotes, 1):
        point = letters(region)
        hold(entry.printed, {**point, "EF": point["delta_n"]})
        low, high = exact(region, p["eps1"], p["eps2"])
        quoted([point["delta_n"], high - low], quote, true)


@row("8.44")
def one_parameter(entry):
    p = both_parameters()
    gaps = [np.abs(both(entry, k, eps2=0.0) - exact(k, p["eps1"], 0.0)) for k in (2, 1)]
    quoted(np.ravel(gaps), "0.0112", "0.0066", "0.0233", "0.0118")


@row("8.4 axis PH")
def axis(entry):
    """On epsilon1 = 0 the middle of the region is that of the second function."""
    p, size = both_parameters(), 1e-4
    quoted([p["a0"], p["c0"]], "-0.0092", "0.0336")
    forms = {entry.printed[0]: False, entry.printed[1]: True, entry.corrected: True}
    for form, right in forms.items():
        for n in (2, 3):
            four, printed = form.sides(**p | {"eps2": size}, n=n)[0]
            assert four == 4
            assert bool(abs(printed - np.mean(exact(n, 0.0, size))) < 1e-6) is right
    quoted([(entry.printed[0].sides(**p | {"eps2": 1.0}, n=3)[0][1])], "2.2592")


@row("8.4 widths AB and CD")
def widths_on_the_axes(entry):
    p = both_parameters()
    values = entry.printed.values(**p, n=2)
    widths = [np.ptp(exact(2, p["eps1"], 0.0)), np.ptp(exact(2, 0.0, p["eps2"]))]
    quoted([values["AB"], values["CD"], *widths], "0.262", "0.727", "0.244", "0.657")


def first_solutions():
    """Return y_100 of (8.36) with the letters of (8.37): harmonic n is left out of the function."""
    for order in (1, 2, 3, 4):
        a, b = (Coefficients({**x, 0: 0.0, order: 0.0}) for x in ONE)
        point = {**hill_region(a, b, order, 1), "y_star": None}
        A, B, A1, B1 = 1.3, -0.6, 0.2, 0.5
        c, s = np.cos(order / 2 * THETA), np.sin(order / 2 * THETA)
        f = function(a, b)
        y = solved(-f * (A * c + B * s), order) + A1 * c + B1 * s
        whole = second_order(
            {**point, "y0": A * c + B * s, "y1": y, "alpha1": 0.0, "f": f, "B1": 0.0}
        )
        stars = {f"{k}_star_p": whole[f"{k}_p"] for k in "PQRS"} | {"T_star": whole["T"]}
        yield {
            **point, **stars, "y_100": y, "A_000": A, "B_000": B, "A_100": A1, "B_100": B1,
            "T_n": A * a[order / 2] + B * b[order / 2], "D": wave_derivative,
        }  # fmt: skip


row("8.36", "8.37", check=holds(first_solutions))


@row("8.3.3 order of the approximation")
def order_of_the_approximation(_):
    """Two solutions give Rayleigh's quotient three orders."""
    f = function(*ONE)
    for sign in (1, -1):
        point = second_order(hill_region(*ONE, 2, sign))

        def error(mu, sign=sign, point=point):
            whole = point["y0"] + mu * point["y1"]
            slope = wave_derivative(whole)
            quotient = (slope @ slope - (mu * f * whole) @ whole) / (whole @ whole)
            return abs(quotient - boundaries(mu * f[TURN], 2)[(1 + sign) // 2])

        assert order_of(error, 0.02) == pytest.approx(4.0, abs=0.2)


@cache
def rays():
    """Return (8.38) and its ray h: y'' is that of the equation with both functions."""
    points = []
    for e1, e2 in ((0.02, -0.013), (-0.7, 0.4)):
        (a, b), (c, d) = TWO_FUNCTIONS
        f1, f2 = function(a, b), function(c, d)
        second = -(1.69 + e1 * f1 + e2 * f2) * 0.6
        h = (e1 * f1 + e2 * f2) / e1
        spectrum = np.fft.fft(h[TURN]) / 128
        for k in (1, 2, 3):
            point = {"a": a, "b": b, "c": c, "d": d, "eps1": e1, "eps2": e2, "i": k, "y": 0.6}
            point |= {"r": {k: 2 * spectrum[k].real}, "s": {k: -2 * spectrum[k].imag}, "f1": f1}
            point |= {"f2": f2, "h": h, "lam": 1.3, "theta": THETA, "D": derivative(2, second)}
            points.append(point)
    return points


row("8.39", "8.40", "8.42", check=holds(rays))


test_row, test_falsified_row = row.tests()
