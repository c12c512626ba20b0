"""Hill's equation on a grid of period 4 pi, and sorted by powers of its parameters by machine.

Derivatives by FFT, the parts in cos and sin(h theta/2).
"""

from functools import cache
from itertools import product

import numpy as np
import sympy as sp
from seed_truth import fourier

COUNT = 256
THETA = 4 * np.pi * np.arange(COUNT) / COUNT
_NUMBER = np.fft.fftfreq(COUNT, 1.0 / COUNT)


def derivative(values, _name="theta", order=1):
    """Differentiate by theta."""
    return np.fft.ifft((0.5j * _NUMBER) ** order * np.fft.fft(values)).real


def parts(values, halves):
    """Return the factors of cos and sin(halves theta/2); of 1 and nothing where halves is 0."""
    factor = np.fft.fft(values)[halves] / COUNT * (1 if halves == 0 else 2)
    return factor.real, -factor.imag


def without(values, halves):
    """Return the function without its part in cos and sin(halves theta/2)."""
    spectrum = np.fft.fft(values)
    spectrum[[halves, -halves]] = 0
    return np.fft.ifft(spectrum).real


def solved(right, n):
    """Return the solution of y'' + (n/2)^2 y = right that has no part in cos, sin(n theta/2)."""
    divisor = 0.25 * (n**2 - _NUMBER**2)
    spectrum = np.fft.fft(without(right, n))
    return np.fft.ifft(spectrum / np.where(divisor == 0, 1, divisor)).real


HARMONICS = 9


class Coefficients(dict):
    """Fourier coefficients, 0 where there is none."""

    def __missing__(self, number):
        return 0.0


def function(a, b):
    """Return the sum of a[m] cos(m theta) + b[m] sin(m theta)."""
    return sum(a[m] * np.cos(m * THETA) + b.get(m, 0.0) * np.sin(m * THETA) for m in a)


def harmonics(samples):
    """Return the coefficients of a function given by samples over one turn."""
    c = fourier(samples)[: HARMONICS + 1]
    a, b = (Coefficients(enumerate(w)) for w in (2 * c.real, -2 * c.imag))
    a[0] = c[0].real
    return a, b


def resonance(f, n, damping=0.0):
    """Return both alpha1, upper first, and A0, B0 of each: no resonant part is left in (7.17).

    ``damping`` is beta of (7.42).
    """
    waves = np.cos(n / 2 * THETA), np.sin(n / 2 * THETA)
    columns = [parts(f * y + 2 * damping * derivative(y), n) for y in waves]
    values, vectors = np.linalg.eig(-np.transpose(columns))
    order = np.argsort(-values.real)
    return [(values[k], vectors[:, k]) for k in order]


@cache
def case(n, sign, seed=0):
    """Return a random f and what its resonance gives in region n, by their letters."""
    rng = np.random.default_rng([n, sign + 1, seed])
    a, b = (Coefficients(enumerate(rng.normal(size=7))) for _ in "ab")
    b[0] = 0.0
    return hill_region(a, b, n, sign, A1=rng.normal(), B1=rng.normal(), scale=rng.normal())


def hill_region(a, b, n, sign, A1=0.0, B1=0.0, scale=1.0):
    """Return f, its resonance and its first solution; with A1, B1 left to choose."""
    f = function(a, b)
    alpha1, (A0, B0) = resonance(f, n)[(1 - sign) // 2]
    A0, B0 = scale, scale * B0 / A0
    c, s = np.cos(n / 2 * THETA), np.sin(n / 2 * THETA)
    y0 = A0 * c + B0 * s
    y1 = solved(-(alpha1 + f) * y0, n) + A1 * c + B1 * s
    numbers = {"n": n, "A0": A0, "B0": B0, "A1": A1, "B1": B1, "alpha1": alpha1, "pm": sign}
    more = {"a": a, "b": b, "oo": max(a), "N": (n - 1) // 2, "D": derivative, "theta": THETA}
    return {**numbers, **more, "f": f, "y0": y0, "y1": y1, "a0": a[0], "a_n": a[n], "b_n": b[n]}


@cache
def second(n, sign, seed=0):
    """Return a case with the letters of (7.28) to (7.34), read from Fourier series."""
    return second_order(case(n, sign, seed))


def second_order(point):
    """Add what is read from the series of the right side of (7.17) and of y1, and B1, alpha2."""
    n = point["n"]
    right = without(-(point["alpha1"] + point["f"]) * point["y0"], n)
    tables = {name: Coefficients() for name in ("P", "Q", "R", "S", "T")}
    primed = {f"{name}_p": Coefficients() for name in "PQRS"}
    for m in range(1, max(point["a"]) + 1):
        pairs = [(("P", "Q"), 2 * m + n, (1, 1))]
        pairs += [(("R", "S"), n - 2 * m, (1, -1))] * (m <= point["N"])
        for names, halves, signs in pairs:
            in_right, in_y1 = parts(right, halves), parts(point["y1"], halves)
            for k, name in enumerate(names):
                tables[name][m, n] = -2 * signs[k] * in_right[k]
                primed[f"{name}_p"][m, n] = 2 * signs[k] * in_y1[k]
    tables["T"][n] = -2 * parts(right, 0)[0] if n % 2 == 0 else 0.0
    c, s = np.cos(n / 2 * THETA), np.sin(n / 2 * THETA)
    base = point["y1"] - point["B1"] * s
    columns = [
        parts(-alpha2 * point["y0"] - (point["alpha1"] + point["f"]) * y1, n)
        for alpha2, y1 in ((1, 0 * c), (0, s), (0, base))
    ]
    alpha2, B1 = np.linalg.solve(np.transpose(columns[:2]), -np.array(columns[2]))
    rest = {"alpha2": alpha2, "B1": B1, "y1": base + B1 * s}
    return {**point, **tables, **primed, **rest}


# Several small parameters, by SymPy.

theta = sp.Symbol("theta", real=True)
n = sp.Symbol("n", integer=True, positive=True)
eps = sp.symbols("epsilon_1 epsilon_2", real=True)
delta, psi = sp.symbols("delta_n psi_n", real=True)
# Two functions, neither even nor odd, for counterexamples in numbers (n = 2): a, b of each.
TWO_FUNCTIONS = tuple(
    (Coefficients(enumerate(a)), Coefficients(enumerate(b, 1)))
    for a, b in (
        ((0.9, 0.1, 0.4, -0.5, 0.4), (0.7, 0.3, -0.4, -0.9)),
        ((0.8, -0.8, 0.2, 0.3, -0.2), (0.5, -0.6, 0.9, -0.7)),
    )
)


def _name(letter, powers):
    return f"{letter}_{''.join(map(str, powers))}"


@cache
def rows(parameters, names, order=2, drag=0):
    """Return the equations of y'' + {lambda^2 + sum of parameter times function} y by powers.

    ``drag`` adds twice its product with the first parameter, times y'.  With them, the letters of
    a formula: functions of theta under their names, alpha_ij, y_ij.
    """
    powers = [k for k in product(range(order + 1), repeat=len(parameters)) if sum(k) <= order]
    functions = {name: sp.Function(name)(theta) for name in names}
    if "wave" in functions:
        functions["wave"] = sp.cos(n * theta - psi)
    coefficient = sum(x * f for x, f in zip(parameters, functions.values(), strict=True))
    alpha = {k: sp.Symbol(_name("alpha", k), real=True) for k in powers}
    part = {k: sp.Function(_name("y", k))(theta) for k in powers}

    def monomial(k):
        return sp.prod([x**i for x, i in zip(parameters, k, strict=True)])

    lam2 = n**2 / sp.Integer(4) + sum(alpha[k] * monomial(k) for k in powers if sum(k))
    y = sum(part[k] * monomial(k) for k in powers)
    left = sp.diff(y, theta, 2) + (lam2 + coefficient) * y
    left += 2 * drag * parameters[0] * sp.diff(y, theta)
    left = sp.Poly(sp.expand(left), *parameters)
    letters = {"theta": theta, "n": n, "psi_n": psi, **functions}
    letters |= {f"alpha_{''.join(map(str, k))}": v for k, v in alpha.items()}
    letters |= {f"y_{''.join(map(str, k))}": v for k, v in part.items()}
    return {k: left.coeff_monomial(monomial(k)) for k in powers}, letters


@cache
def couplings(n, one, other):
    """Return w and W of two functions, over all harmonics but 0 and n, as the remark of 8.30."""

    def c(k, m):
        a, b = TWO_FUNCTIONS[k]
        return complex(a[abs(m)], -b[m] if m > 0 else b[-m]) / 2 if abs(m) != n else 0.0

    numbers = [m for m in range(-20, 21) if m not in (0, n)]
    w = -sum((c(one, m).conjugate() * c(other, m)).real / (m * (m - n)) for m in numbers)
    return w, sum(c(one, m) * c(other, n - m) / (m * (n - m)) for m in numbers)
