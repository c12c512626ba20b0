"""Hill's equation with several small parameters, sorted by powers by machine (Smith chapter 8)."""

from __future__ import annotations

from functools import cache
from itertools import product

import sympy as sp
from seed_waves import Coefficients

theta = sp.Symbol("theta", real=True)
n = sp.Symbol("n", integer=True, positive=True)
eps = sp.symbols("epsilon_1 epsilon_2", real=True)
delta, psi = sp.symbols("delta_n psi_n", real=True)
# Two functions, neither even nor odd, for counterexamples in numbers (n = 2): a, b of each.
TWO_FUNCTIONS = (
    (
        Coefficients({0: 0.9, 1: 0.1, 2: 0.4, 3: -0.5, 4: 0.4}),
        Coefficients({1: 0.7, 2: 0.3, 3: -0.4, 4: -0.9}),
    ),
    (
        Coefficients({0: 0.8, 1: -0.8, 2: 0.2, 3: 0.3, 4: -0.2}),
        Coefficients({1: 0.5, 2: -0.6, 3: 0.9, 4: -0.7}),
    ),
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
