"""Smith (7.1)-(7.25): Floquet theory and the first-order boundaries of Hill's equation."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from seed_ledger import Ledger, hold, holds, quoted, same
from seed_rigs import RIGS, linkage_function
from seed_truth import (
    TURN,
    boundaries,
    fourier,
    normalised_solutions,
)
from seed_waves import case, function, resonance

row = Ledger("Smith", __file__)


def q(x):
    """A function of period pi, neither even nor odd."""
    return np.cos(2 * x) + 0.4 * np.sin(4 * x) + 0.1


@cache
def solved(lam2, mu):
    """Return y1, y2 of (7.3) and their derivatives as functions over two periods."""
    rates = lambda x, s: [s[1], -(lam2 + mu * q(x)) * s[0]]  # noqa: E731
    tight = {"method": "DOP853", "dense_output": True, "rtol": 1e-12, "atol": 1e-13}
    span = (0.0, 2 * np.pi + 0.1)
    both = [solve_ivp(rates, span, start, **tight).sol for start in ([1.0, 0.0], [0.0, 1.0])]
    names = [("y1", "y1_p"), ("y2", "y2_p")]
    return {
        name: lambda x, sol=sol, k=k: sol(x)[k]
        for sol, pair in zip(both, names, strict=True)
        for k, name in enumerate(pair)
    }


def translated(lam2, mu):
    """Return the solutions' matrix over one period, roots and the solutions that go with them."""
    y = solved(lam2, mu)
    matrix = np.array([[y["y1"](np.pi), y["y2"](np.pi)], [y["y1_p"](np.pi), y["y2_p"](np.pi)]])
    return y, matrix, *np.linalg.eig(matrix)


@cache
def floquet():
    """Return solutions at several places of several equations, under the letters of 7.1.2."""
    points = []
    for lam2, mu in ((1.7, 0.5), (1.1, 0.9), (6.3, 1.2)):
        y, matrix, roots, vectors = translated(lam2, mu)
        X, W = np.trace(matrix) / 2, np.linalg.det(matrix)
        exponent = np.log(roots[0].astype(complex)) / (1j * np.pi)
        more = {"a1": matrix[0, 0], "a2": matrix[1, 0], "a3": matrix[0, 1], "a4": matrix[1, 1]}
        for k, sign in ((0, 1), (1, -1)):
            A, B = vectors[:, k]

            def mode(x, A=A, B=B, y=y):
                return A * y["y1"](x) + B * y["y2"](x)

            def periodic(x, mode=mode, power=sign * exponent):
                place = x % np.pi
                return mode(place) * np.exp(-1j * power * place)

            numbers = {"A": A, "B": B, "p": roots[k], "p1": roots[0], "p2": roots[1], "pm": sign}
            numbers |= {"alpha": exponent, "gamma": exponent, "p12": roots[k], "X": X, "W": W}
            for x in (0.3, 2.1, 3.0):
                ways = {"y": mode, "u12": mode, "w12": periodic, "x": x}
                points.append({**y, **more, **numbers, **ways})
    return points


@cache
def equations():
    """Return the rig's reduced equation in time by its angle, y'' being its acceleration.

    f3 is that of (5,1,5,2), epsilon3 that of the lightest follower.
    """
    f3 = linkage_function("5,1,5,2")
    frequency, speed, epsilon3 = RIGS["5,1,5,2"].frequency, 55.0, 3.43
    y = 0.4
    acceleration = -(frequency**2 + speed**2 * epsilon3 * f3) * y
    rates = {0: y, 2: acceleration / speed**2}
    D = lambda _, __, order: rates.get(order, 0.9)  # noqa: E731
    point = {"lam": frequency / speed, "mu": epsilon3, "f": lambda _: f3, "q": lambda _: f3}
    return [{**point, "Q": lambda _: epsilon3 * f3, "y": y, "D": D, "x": 0, "theta": 0}]


row("7.1", "7.2", check=holds(equations))


@row("7.11")
def reduced_equation(entry):
    hold(entry.printed, equations)
    first = fourier(equations()[0]["f"](0))[1]
    quoted([2 * first.real, -2 * first.imag], "0.567", "0.215")


row(
    "7.1.2 Floquet solutions", "7.1.2 roots", "7.4", "7.5", "7.6", "7.7", "7.8", "7.9", "7.10",
    check=holds(floquet, tol=1e-8),
)  # fmt: skip


@row("7.3")
def normalised(entry):
    """The solutions as they come from their first values."""
    for one, other in entry.printed.sides(**solved(1.7, 0.5)):
        assert one == pytest.approx(other, abs=1e-12)


@row("7.1.2 stability from the roots")
def stability_from_the_roots(_):
    _, matrix, roots, _ = translated(1.7, 0.5)
    assert 0.5 * np.trace(matrix) == pytest.approx(-0.568, abs=0.001)
    assert abs(roots[0] - roots[1]) > 1
    assert np.abs(np.linalg.matrix_power(matrix, 1000)).max() < 3
    edge = boundaries(0.5 * q(TURN * np.arange(256) / 256), 2)[0]
    _, matrix, roots, _ = translated(edge, 0.5)
    assert np.abs(roots + 1).max() < 1e-4
    growth = [np.abs(np.linalg.matrix_power(matrix, n)).max() for n in (200, 400)]
    assert growth[0] > 20 and growth[1] / growth[0] == pytest.approx(2.0, rel=0.02)


def period(edge, function, shortest):
    """Return the period of the solution on a boundary, from its root over one period of f."""
    root = np.linalg.eigvals(normalised_solutions(lambda x: edge + function(x), shortest)).mean()
    assert abs(root) == pytest.approx(1.0, abs=1e-3)
    return shortest if root.real > 0 else 2 * shortest


@row("7.1.3.1 periods")
def periods(entry):
    odd = {"odd": lambda k: k % 2 == 1}
    samples = 0.05 * q(TURN * np.arange(256) / 256)
    for n in (1, 2, 3):
        for edge in boundaries(samples, 2 * n):
            lam2, right = entry.corrected[0].sides(n=n, lam=np.sqrt(edge))[0]
            assert lam2 == pytest.approx(right, abs=0.05)
            true = period(edge, lambda x: 0.05 * q(x), np.pi)
            hold(entry.corrected[1], {**odd, "n": n, "period": true})
            assert true == pytest.approx(
                3 * np.pi - entry.printed.values(n=n, lam=1, **odd)["period"]
            )
    left, start = entry.printed[0].sides(n=1, lam=0.5)[0]
    assert left == start == 0.25
    roots = np.linalg.eigvals(normalised_solutions(lambda x: start + 0.05 * q(x), np.pi))
    assert np.abs(roots.real).max() < 0.1


@row("7.13")
def first_solution(entry):
    def f(x):
        return 0.05 * (np.cos(x) + 0.5 * np.sin(2 * x) + 0.3 * np.cos(3 * x))

    for n in (1, 2, 3):
        point = {**case(n, 1), "odd": lambda k: k % 2 == 1}
        for edge in boundaries(f(TURN * np.arange(64) / 64), n):
            hold(entry.corrected, {**point, "period": period(edge, f, TURN)})
        slip = {**point, "A1": point["A0"], "A0": 0.0, "period": TURN * (1 + n % 2)}
        hold(entry.printed, slip)


@cache
def expansion(order=2):
    """Return the coefficients of mu^0, mu^1, mu^2 in y'' + (lambda^2 + mu f) y, and the letters."""
    n, mu, theta = sp.Symbol("n", positive=True), *sp.symbols("mu theta", real=True)
    f, *ys = (sp.Function(name)(theta) for name in ("f", "y_0", "y_1", "y_2"))
    alpha = sp.symbols("alpha_1 alpha_2", real=True)
    lam2 = (n / 2) ** 2 + sum(a * mu ** (i + 1) for i, a in enumerate(alpha))
    y = sum(part * mu**i for i, part in enumerate(ys))
    left = sp.expand(sp.diff(y, theta, 2) + (lam2 + mu * f) * y)
    letters = {"n": n, "mu": mu, "theta": theta, "f": f, "y0": ys[0], "y1": ys[1], "y2": ys[2]}
    letters |= {"alpha1": alpha[0], "alpha2": alpha[1], "y": y, "lam": sp.sqrt(lam2)}
    return [left.coeff(mu, i) for i in range(order + 1)], letters


row("7.12", "7.14", check=lambda entry: series(entry))


def series(entry):
    """The printed terms are those of the expansion, to the second power."""
    letters = expansion()[1]
    one, other = entry.printed.sides(**letters)[0]
    same(one, other)
    f3 = linkage_function("5,1,5,2")
    values = [boundaries(mu * f3, 2)[1] for mu in (1e-4, 2e-4, 4e-4)]
    slopes = np.diff(values) / [1e-4, 2e-4]
    assert 2 * values[0] - values[1] == pytest.approx(1.0, abs=1e-6)
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-3)


@row("7.15")
def substituted(entry):
    rows, letters = expansion()
    left, zero = entry.printed.sides(**letters)[0]
    powers = sp.expand((left - zero).doit())
    for power in (0, 1):
        same(powers.coeff(letters["mu"], power), rows[power])


def powers_of_mu(number):
    """Return the check that left less right side is the machine's row."""

    def check(entry):
        rows, letters = expansion()
        one, other = entry.printed.sides(**letters)[0]
        same(one - other, rows[number])

    return check


for number, label in enumerate(("7.16", "7.17", "7.18")):
    row(label, check=powers_of_mu(number), derived=lambda k=number: [expansion()[0][k]])


def cases():
    """Return regions 1 to 6 with both signs of the root."""
    return [case(n, sign) for n in range(1, 7) for sign in (1, -1)]


row("7.19", "7.20", "7.21", "7.22", "7.1.3.2 rearranged conditions", "7.24", check=holds(cases))


@row("7.23")
def first_order(entry):
    """Both roots, and no other alpha1, leave nothing resonant."""
    hold(entry.printed, cases)
    for n in (1, 2):
        point = case(n, 1)
        upper, lower = (value for value, _ in resonance(point["f"], n))
        both = [entry.printed[1].value(**{**point, "pm": sign}) for sign in (1, -1)]
        assert both == pytest.approx([upper, lower])


def boundary(form, samples, n, mu):
    """Return both printed boundaries of a function given by samples, lower first."""
    c = fourier(samples)
    a, b = ({k: v for k, v in enumerate(w[:10])} for w in (2 * c.real, -2 * c.imag))
    a[0], b[0] = c[0].real, 0.0
    upper, lower = (value.real for value, _ in resonance(function(a, b), n))
    found = form.sides(n=n, mu=mu, alpha1_p=upper, alpha1_pp=lower, lam_p=0, lam_pp=0)
    return np.array([found[1][1], found[0][1]])


@row("7.25")
def first_order_boundaries(entry):
    errors = []
    for name in RIGS:
        f3 = linkage_function(name)

        def error(n, mu, f3=f3):
            gap = boundary(entry.printed, f3, n, mu) - boundaries(mu * f3, n)
            return np.abs(gap).max()

        for n in (1, 2, 3, 4):
            assert np.log2(error(n, 0.004) / error(n, 0.002)) == pytest.approx(2.0, abs=0.1)
        errors += [error(n, RIGS[name].epsilon(0.0058)[2]) for n in (2, 4)]
    quoted(errors, "0.39", "0.18", "0.13", "0.031")
    f3 = linkage_function("5,1,5,2")
    mu = RIGS["5,1,5,2"].epsilon(0.0058)[2]
    limits = (boundary(entry.printed, f3, 4, mu), (800, 783)), (boundaries(mu * f3, 4), (781, 772))
    for values, rpm in limits:
        assert 26 * 60 / np.sqrt(values) == pytest.approx(rpm, abs=0.6)
    one, other = entry.printed.sides(n=4, mu=0.5, alpha1_p=2, alpha1_pp=3, lam_p=3, lam_pp=2)
    assert (one[0], other[0]) == (9, 4)


test_row, test_falsified_row = row.tests()
