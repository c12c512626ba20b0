"""Smith (7.38)-(7.51): the damped equation, its first-order boundaries and their tip."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from seed_ledger import Ledger, hold, holds, quoted, same
from seed_rigs import RIGS, critical, linkage_function
from seed_truth import TURN, boundaries, fourier, normalised_solutions
from seed_waves import THETA, Coefficients, derivative, function, resonance, solved

row = Ledger("Smith", __file__)


def f(x):
    """A function of period 2 pi, neither even nor odd."""
    return 0.1 + np.cos(x) + 0.6 * np.sin(x) + 0.5 * np.cos(2 * x) - 0.3 * np.sin(3 * x)


def damped_matrix(lam, amplitude, damping):
    """Return the monodromy matrix of (7.38) in y, y' by direct integration."""

    def rates(x, s):
        factor = lam + amplitude * f(x)
        return [s[2], s[3], *(-2 * damping * s[2 + i] - factor * s[i] for i in (0, 1))]

    start = [1.0, 0.0, 0.0, 1.0]
    end = solve_ivp(rates, (0.0, TURN), start, method="DOP853", rtol=1e-12, atol=1e-13)
    return end.y[:, -1].reshape(2, 2)


@cache
def symbols():
    """Return letters of the damped equation, y being exp(-K theta) u."""
    theta, K, lam, mu = sp.symbols("theta K lambda mu", real=True)
    u, g = (sp.Function(name) for name in "uf")
    y = lambda x: sp.exp(-K * x) * u(x)  # noqa: E731
    return {"theta": theta, "K": K, "lam": lam, "mu": mu, "u": u, "f": g, "y": y}


@cache
def transformed():
    """Put (7.39) into (7.38) and divide by the exponential."""
    s = symbols()
    x, y, K = s["theta"], s["y"](s["theta"]), s["K"]
    left = y.diff(x, 2) + 2 * K * y.diff(x) + (s["lam"] ** 2 + s["mu"] * s["f"](x)) * y
    return sp.expand(sp.expand(left) * sp.exp(K * x))


@row("7.38")
def damped_equation(entry):
    left, zero = entry.printed.sides(**symbols())[0]
    same((left - zero) * sp.exp(symbols()["K"] * symbols()["theta"]), transformed())


row("7.39", check=holds(lambda: [symbols()]))


@row("7.40", derived=lambda: [transformed()])
def undamped_equation(entry):
    left, zero = entry.printed.sides(**symbols())[0]
    same(left - zero, transformed())


@row("7.1.4.1 Floquet form of u")
def floquet_form(entry):
    """The larger root of the damped equation, for what was derived without damping."""
    base, amplitude = 0.3, 0.3
    bare = normalised_solutions(lambda x: base + amplitude * f(x), TURN)
    roots, vectors = np.linalg.eig(bare)
    k = int(np.argmax(np.abs(roots)))
    nu = np.log(np.abs(roots[k])) / TURN
    quoted([nu], "0.134")
    for damping, root in ((0.12, 1.09), (0.15, 0.91)):
        matrix = damped_matrix(base + damping**2, amplitude, damping)
        slope = vectors[1, k] / vectors[0, k] - damping
        start = np.array([1.0, slope])
        growth = matrix @ start
        values = {"nu": nu, "K": damping, "p": lambda _: np.sign(roots[k]), "theta": TURN}
        bare_growth = {"u": lambda _: roots[k], "y": lambda _, g=growth: g[0]}
        hold(entry.printed, {**values, **bare_growth}, tol=1e-8)
        damped = np.abs(np.linalg.eigvals(matrix))
        assert damped.max() == pytest.approx(root, abs=0.01)
        assert (damped.max() < 1) == (damping > nu)
        assert damped.prod() == pytest.approx(np.exp(-2 * damping * TURN), rel=1e-8)


@cache
def expansion():
    """Return the coefficients of mu^0, mu^1, mu^2 of (7.38) with K = mu beta, and the letters."""
    theta, mu, beta, *alpha = sp.symbols("theta mu beta alpha_1 alpha_2", real=True)
    n = sp.Symbol("n", positive=True)
    g, *ys = (sp.Function(name)(theta) for name in ("f", "y0", "y1", "y2"))
    y = sum(part * mu**i for i, part in enumerate(ys))
    square = (n / 2) ** 2 + alpha[0] * mu + alpha[1] * mu**2
    left = sp.expand(y.diff(theta, 2) + 2 * beta * mu * y.diff(theta) + (square + mu * g) * y)
    letters = {"theta": theta, "mu": mu, "beta": beta, "n": n, "f": g, "oo": sp.Integer(2)}
    letters |= {
        "alpha": {k: a for k, a in enumerate([0, *alpha])} | {3: 0},
        "ys": dict(enumerate(ys)),
    }
    letters |= {"alpha1": alpha[0], "alpha2": alpha[1]} | {
        f"y{i}": part for i, part in enumerate(ys)
    }
    letters["ys"][3] = sp.Function("y3")(theta)
    return [left.coeff(mu, i) for i in range(3)], letters


@row("7.41")
def series_with_damping(entry):
    """Both forms in powers of mu: the slip is in the damping term."""
    rows, letters = expansion()
    mu, beta, Y = letters["mu"], letters["beta"], letters["ys"]
    for form, order in ((entry.corrected, 1), (entry.printed, 2)):
        left, zero = form.sides(**letters)[0]
        powers = sp.expand((left - zero).doit())
        for k in range(3):
            theta = letters["theta"]
            slip = 2 * beta * (Y[k - 1].diff(theta, order) - Y[k - 1].diff(theta)) if k else 0
            same(powers.coeff(mu, k), rows[k] + slip)


@row("7.42", derived=lambda: [expansion()[0][2]])
def powers_of_mu_with_damping(entry):
    rows, letters = expansion()
    for (one, other), true in zip(entry.printed.sides(**letters), rows, strict=True):
        same(one - other, true)


@cache
def cases():
    """Return regions with both roots, damping and a random f of two harmonics, not resonant."""
    rng, points = np.random.default_rng(3), []
    for n in (1, 2, 3):
        a, b = (Coefficients({0: rng.normal(), n: rng.normal(), n + 2: 0.3}) for _ in "ab")
        b[0], beta = 0.0, 0.2 * np.hypot(a[n], b[n]) / n
        series = function(a, b)
        for k, (alpha1, (A0, B0)) in enumerate(resonance(series, n, beta)):
            y0 = A0 * np.cos(n / 2 * THETA) + B0 * np.sin(n / 2 * THETA)
            y1 = solved(-(alpha1 + series) * y0 - 2 * beta * derivative(y0), n)
            numbers = {"n": n, "beta": beta, "alpha1": alpha1, "A0": A0, "B0": B0, "pm": 1 - 2 * k}
            tables = {"a": a, "b": b, "oo": n + 2, "a0": a[0]}
            points.append({**numbers, **tables, "y1": y1, "theta": THETA, "D": derivative})
    return points


row("7.43", "7.44", "7.45", "7.46", "7.47", check=holds(cases))


def damped_ends(samples, region, damping):
    """Return the ends of a damped region: real eigenvalues of the Fourier matrix, or None."""
    harmonics = 40
    number = np.arange(-harmonics, harmonics + 1) + 0.5 * (region % 2)
    index = np.arange(number.size)
    difference = (index[:, None] - index[None, :]) % samples.size
    matrix = np.diag(number**2 - 2j * damping * number) - fourier(samples)[difference]
    values = np.linalg.eigvals(matrix)
    low, high = boundaries(samples, region)
    real = values.real[np.abs(values.imag) < 1e-7]
    slack = 1e-9
    inside = (real > low + damping**2 - slack) & (real < high + damping**2 + slack)
    assert inside.sum() == 2
    return np.array([real[inside].min(), real[inside].max()])


def letters(samples, n, mu, damping):
    """Return the letters of (7.48), (7.49) for a function given by samples."""
    c = fourier(samples)
    a = Coefficients({n: 2 * c[n].real})
    b = Coefficients({n: -2 * c[n].imag})
    a[0], beta = c[0].real, damping / mu
    both = [value.real for value, _ in resonance(function(a, b), n, beta)]
    roots = dict(zip(("alpha1_p", "alpha1_pp"), both, strict=True))
    return {"a": a, "b": b, "a0": a[0], "n": n, "mu": mu, "beta": beta, **roots}


@row("7.48", "7.49")
def damped_first_order_boundaries(entry):
    def ends(samples, region, mu, damping):
        point = letters(samples, region, mu, damping)
        if entry.label == "7.48":
            upper, lower = entry.printed.sides(**point, lam_p=3, lam_pp=2)
            assert (upper[0], lower[0]) == (9, 4)
            return np.array([lower[1], upper[1]])
        rest = {"lam": 3.0, "alpha1": point["alpha1_p"]}
        square, first, upper = entry.printed.sides(**point, **rest, pm=1)[0]
        assert square == 9 and first == pytest.approx(upper)
        return np.array([entry.printed.sides(**point, **rest, pm=-1)[0][2], upper])

    errors = []
    for name in ("5,1,5,2", "10,1,10,4"):
        f3 = linkage_function(name)
        for region in (1, 2, 3):
            share = 0.3 * np.abs(fourier(f3)[region]) / region
            gaps = [
                np.abs(
                    ends(f3, region, m, share * m) - damped_ends(m * f3, region, share * m)
                ).max()
                for m in (0.01, 0.005)
            ]
            assert np.log2(gaps[0] / gaps[1]) == pytest.approx(2.0, abs=0.1)
        own = RIGS[name].epsilon(0.0058)[2]
        errors.append(np.abs(ends(f3, 2, own, 0.02) - damped_ends(own * f3, 2, 0.02)).max())
    quoted(errors, "0.387", "0.133")


@row("7.50")
def real_roots(entry):
    """The roots of the first order are real where the condition holds, and nowhere else."""
    for point in cases():
        n, a, b = point["n"], point["a"], point["b"]
        for beta, real in ((0.49, True), (0.51, False)):
            damping = beta * np.hypot(a[n], b[n]) / n
            values = [v for v, _ in resonance(function(a, b), n, damping)]
            assert bool(np.abs(np.imag(values)).max() < 1e-9) is real
            size, limit = entry.printed.sides(**{**point, "beta": damping})[0]
            assert bool(size >= limit) is real


@row("7.51", slow=True)
def least_parameter(entry):
    wrong = {
        "5,1,5,2": ("0.73", "3.3", "1.3", "14.6", "2.4"),
        "10,1,10,4": ("0.58", "2.7", "1.5", "9.0", "2.8"),
    }
    for name, ratios in wrong.items():

        def ratio(mu, region, name=name):
            """Return K of the printed equality over the exact one, mu_min proportional to K."""
            c = fourier(linkage_function(name))[region]
            coefficients = {"a": {region: 2 * c.real}, "b": {region: -2 * c.imag}, "n": region}
            coefficients = {k: Coefficients(v) if k in "ab" else v for k, v in coefficients.items()}
            limit, least = entry.printed.sides(**coefficients, K=1.0, mu_min=mu)[0]
            return limit / least / critical(name, mu, region)

        for region in (1, 2, 3):
            gaps = [abs(ratio(mu, region) - 1.0) for mu in (0.02, 0.01)]
            assert np.log2(gaps[0] / gaps[1]) == pytest.approx(1.0, abs=0.1)
        own = RIGS[name].epsilon(0.0069)[2]
        quoted([own], "4.08")
        quoted([ratio(own, region) for region in (2, 3, 4, 5, 6)], *ratios)


test_row, test_falsified_row = row.tests()
