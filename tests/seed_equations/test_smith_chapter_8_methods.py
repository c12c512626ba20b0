"""Smith (8.23)-(8.44): the modified and the alternative method for several parameters."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from seed_ledger import Ledger, derivative, hold, holds, quoted, same
from seed_rigs import RIGS
from seed_series import TWO_FUNCTIONS, couplings, delta, eps, rows
from seed_truth import CRANK_ROCKERS, boundaries, coupler_functions, fourier, motion
from seed_waves import (
    THETA,
    Coefficients,
    function,
    hill_region,
    parts,
    resonance,
    second_order,
    series,
    solved,
)
from seed_waves import derivative as wave_derivative

row = Ledger("Smith", __file__)
ONE, TWO = TWO_FUNCTIONS
THREE = ((*eps, delta), ("f1_bar", "f2_bar", "wave"))
TURN = slice(0, 128)  # of the grid over two turns


def is_row(key):
    """Return the check that left less right side is the machine's equation of one power."""

    def check(entry):
        equations, letters = rows(*THREE)
        one, other = entry.printed.sides(**letters)[0]
        same(one - other, equations[key])

    return check


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
    row(label, check=is_row(key), derived=shown(label))


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


@cache
def rig():
    """Return f1 and f3 of (5,1,5,2), Fourier coefficients by letters, and both parameters."""
    _, f1, _, f3 = coupler_functions(motion(CRANK_ROCKERS["5,1,5,2"]))
    e1, _, e3 = RIGS["5,1,5,2"].epsilon(0.0058)
    tables = {}
    for names, f in (("ab", f1), ("cd", f3)):
        c = fourier(f)
        tables |= {names[0]: {k: 2 * c[k].real for k in range(9)}}
        tables |= {names[1]: {k: -2 * c[k].imag for k in range(9)}}
        tables[f"{names[0]}0"] = c[0].real
    return {**tables, "eps1": e1, "eps2": e3, "lam": 2.0}, f1, f3


def letters(region, **more):
    """Return the rig's letters with delta_n of a region."""
    p = {**rig()[0], "n": region, **more}
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
    _, f1, f3 = rig()
    return np.array(boundaries(x * f1 + y * f3, region))


@row("8.29", "8.43", "8.41")
def first_order_boundaries(entry):
    p = rig()[0]
    error = {k: np.abs(both(entry, k) - exact(k, p["eps1"], p["eps2"])) for k in (1, 2)}
    quoted(error[1], "0.89", "0.44")
    quoted(error[2], "0.51", "0.28")
    gaps = [
        np.abs(both(entry, 2, eps1=h, eps2=-0.7 * h) - exact(2, h, -0.7 * h)).max()
        for h in (0.004, 0.002)
    ]
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(2.0, abs=0.1)


@row("8.4 width EF")
def width_of_both(entry):
    p = rig()[0]
    for region, quote, true in zip(
        (1, 2, 3, 4),
        ("2.21", "0.91", "0.63", "0.22"),
        ("2.66", "0.68", "0.23", "0.16"),
        strict=True,
    ):
        point = letters(region)
        hold(entry.printed, {**point, "EF": point["delta_n"]})
        low, high = exact(region, p["eps1"], p["eps2"])
        quoted([point["delta_n"], high - low], quote, true)


@row("8.44")
def one_parameter(entry):
    p = rig()[0]
    gaps = [np.abs(both(entry, k, eps2=0.0) - exact(k, p["eps1"], 0.0)) for k in (2, 1)]
    quoted(np.ravel(gaps), "0.0112", "0.0066", "0.0233", "0.0118")


@row("8.4 axis PH")
def axis(entry):
    """On epsilon1 = 0 the middle of the region is that of the second function."""
    p, size = rig()[0], 1e-4
    quoted([p["a0"], p["c0"]], "-0.0092", "0.0336")
    for form, right in (
        (entry.printed[0], False),
        (entry.printed[1], True),
        (entry.corrected, True),
    ):
        for n in (2, 3):
            four, printed = form.sides(**p | {"eps2": size}, n=n)[0]
            assert four == 4
            assert bool(abs(printed - np.mean(exact(n, 0.0, size))) < 1e-6) is right
    quoted([(entry.printed[0].sides(**p | {"eps2": 1.0}, n=3)[0][1])], "2.2592")


@row("8.4 widths AB and CD")
def widths_on_the_axes(entry):
    p = rig()[0]
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
    """The recursion takes alpha_k from y_0 .. y_(k-1); Rayleigh's quotient does better."""
    a, b = ONE
    f = function(a, b)
    for sign in (1, -1):
        alphas, ys = series(a, b, 2, sign, 4)
        assert len(ys) == len(alphas) == 4
        gaps = [
            abs(
                boundaries(mu * f[TURN], 2)[(1 + sign) // 2]
                - 1
                - np.polyval([*alphas[::-1], 0], mu)
            )
            for mu in (0.04, 0.02)
        ]
        assert np.log2(gaps[0] / gaps[1]) == pytest.approx(5.0, abs=0.5)
        quotients = []
        for mu in (0.02, 0.01):
            whole = ys[0] + mu * ys[1]
            slope = wave_derivative(whole)
            quotient = (slope @ slope - (mu * f * whole) @ whole) / (whole @ whole)
            quotients.append(abs(quotient - boundaries(mu * f[TURN], 2)[(1 + sign) // 2]))
        assert np.log2(quotients[0] / quotients[1]) == pytest.approx(4.0, abs=0.2)


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


def test_orders_of_the_alternative_method():
    """Every order of chapter 7 applies along the ray."""
    e1, e2 = 0.02, -1 / 70
    h = [
        Coefficients({k: x[k] + e2 / e1 * y.get(k, 0.0) for k in x})
        for x, y in zip(ONE, TWO, strict=True)
    ]
    exact = boundaries(e1 * function(*h)[TURN], 2)
    alphas = [series(*h, 2, sign, 4)[0] for sign in (-1, 1)]
    errors = [
        max(abs(1 + sum(x * e1 ** (k + 1) for k, x in enumerate(alpha[:order])) - limit)
            for alpha, limit in zip(alphas, exact, strict=True))
        for order in (1, 2, 3, 4)
    ]  # fmt: skip
    assert all(later < 0.2 * sooner for sooner, later in pairwise(errors))


test_row, test_falsified_row = row.tests()
