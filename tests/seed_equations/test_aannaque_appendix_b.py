"""Aannaque Appendix B: the frequency functions F and G, for beams of length 1."""

from __future__ import annotations

import pytest
import sympy as sp
from seed_frequency import axial, bending, beta, lam, number, vanishes
from seed_ledger import establishes

PAPER = "Aannaque"
s, c, sh, ch = sp.sin(lam), sp.cos(lam), sp.sinh(lam), sp.cosh(lam)
DELTA = ch * c - 1


@establishes(
    PAPER,
    "B.1",
    printed=r"F_1 = -\frac{\lambda}{\delta}(\sinh\lambda - \sin\lambda)",
    verdict="agrees",
    remark="Lengths 1 throughout the appendix.",
)
@establishes(
    PAPER,
    "B.2",
    printed=r"F_2 = -\frac{\lambda}{\delta}(\cosh\lambda\sin\lambda - \sinh\lambda\cos\lambda)",
    verdict="agrees",
)
@establishes(
    PAPER,
    "B.3",
    printed=r"F_3 = -\frac{\lambda^2}{\delta}(\cosh\lambda - \cos\lambda)",
    verdict="agrees",
)
@establishes(
    PAPER,
    "B.4",
    printed=r"F_4 = \frac{\lambda^2}{\delta}\sinh\lambda\sin\lambda",
    verdict="agrees",
)
@establishes(
    PAPER,
    "B.5",
    printed=r"F_5 = \frac{\lambda^3}{\delta}(\sinh\lambda + \sin\lambda)",
    verdict="agrees",
)
@establishes(
    PAPER,
    "B.6",
    printed=r"F_6 = -\frac{\lambda^3}{\delta}(\cosh\lambda\sin\lambda + \sinh\lambda\cos\lambda)",
    verdict="agrees",
)
@establishes(
    PAPER,
    "B.9",
    printed=r"\delta = \cosh\lambda\cos\lambda - 1",
    verdict="agrees",
    remark="As written it has no digit left at lambda = 1e-4, where it is -1.7e-17; the product of "
    "the even and the odd beam's divisors keeps all.",
)
def test_functions_of_bending():
    printed = {
        "F1": -lam / DELTA * (sh - s),
        "F2": -lam / DELTA * (ch * s - sh * c),
        "F3": -(lam**2) / DELTA * (ch - c),
        "F4": lam**2 / DELTA * sh * s,
        "F5": lam**3 / DELTA * (sh + s),
        "F6": -(lam**3) / DELTA * (ch * s + sh * c),
    }
    for name, form in printed.items():
        assert vanishes(bending()[name] - form), name


@establishes(
    PAPER,
    "B.7",
    printed=r"F_7 = -\beta\cot\beta L",
    verdict="slip",
    derived=r"F_7 = \beta\cot\beta L",
    remark="At rest EA F7 has to be EA/L: 1 with lengths 1, not -1.",
)
@establishes(
    PAPER,
    "B.8",
    printed=r"F_8 = \beta/\sin\beta L",
    verdict="slip",
    derived=r"F_8 = -\beta/\sin\beta L",
    remark="At rest EA F8 has to be -EA/L: -1 with lengths 1, not 1.",
)
def test_functions_along_the_beam():
    assert vanishes(axial()["F7"] - beta * sp.cot(beta))
    assert vanishes(axial()["F8"] + beta / sp.sin(beta))
    assert sp.limit(axial()["F7"], beta, 0) == 1
    assert sp.limit(axial()["F8"], beta, 0) == -1


def rate(name):
    """Return ``-dF/d(lambda^4)`` or ``-dF/d(beta^2)``."""
    if name in bending():
        return -bending()[name].diff(lam) / (4 * lam**3)
    return -axial()[name].diff(beta) / (2 * beta)


@establishes(
    PAPER,
    "B.10",
    printed=r"G_1 = \frac{1}{4\lambda^4}(F_1 F_2 - F_3 - F_1)",
    verdict="agrees",
    remark="G is -dF/d lambda^4, so that M = rho A G across the beam.",
)
@establishes(
    PAPER,
    "B.11",
    printed=r"G_2 = \frac{1}{4\lambda^4}(F_1 F_4 + 2 F_3)",
    verdict="slip",
    derived=r"G_2 = \frac{1}{4\lambda^4}(F_1^2 - F_2)",
    remark="The right side is -G3: 0.0312 at lambda = 1, for 0.00956. Perhaps the scan has joined "
    "(B.11) and (B.12).",
)
@establishes(
    PAPER,
    "B.12",
    printed=r"G_? = ...",
    verdict="not legible",
    derived=r"G_3 = -\frac{1}{4\lambda^4}(F_1 F_4 + 2 F_3)",
    remark="One function is missing; if it is what stands at (B.11), it lacks the sign.",
)
@establishes(
    PAPER,
    "B.13",
    printed=r"G_3 = -\frac{1}{4\lambda^4}(F_1 F_3 + 2 F_4)",
    verdict="slip",
    derived=r"G_4 = -\frac{1}{4\lambda^4}(F_1 F_3 + 2 F_4)",
    remark="The right side is G4: -0.0525 at lambda = 1, where G3 is -0.0311.",
)
@establishes(
    PAPER,
    "B.14",
    printed=r"G_5 = \frac{1}{4\lambda^4}(F_5 F_4 - 3 F_5)",
    verdict="slip",
    derived=r"G_5 = \frac{1}{4\lambda^4}(F_3 F_4 - 3 F_5)",
    remark="At lambda = 1 the printed form is 27.2, right is 0.129.",
)
@establishes(PAPER, "B.15", printed=r"G_6 = \frac{1}{4\lambda^4}(F_3^2 - 3 F_6)", verdict="agrees")
def test_rates_of_bending():
    f = {name: sp.Symbol(name) for name in bending()}
    quadratic = {
        "F1": f["F1"] * f["F2"] - f["F3"] - f["F1"],
        "F2": f["F1"] ** 2 - f["F2"],
        "F3": -(f["F1"] * f["F4"] + 2 * f["F3"]),
        "F4": -(f["F1"] * f["F3"] + 2 * f["F4"]),
        "F5": f["F3"] * f["F4"] - 3 * f["F5"],
        "F6": f["F3"] ** 2 - 3 * f["F6"],
    }
    table = {f[name]: form for name, form in bending().items()}
    for name, form in quadratic.items():
        assert vanishes(rate(name) - form.subs(table) / (4 * lam**4)), name
    at = {"lambda": 1}
    printed = {
        "B.11": (f["F1"] * f["F4"] + 2 * f["F3"], 0.0312, "F2", 0.00956),
        "B.13": (-(f["F1"] * f["F3"] + 2 * f["F4"]), -0.0525, "F3", -0.0311),
        "B.14": (f["F5"] * f["F4"] - 3 * f["F5"], 27.2, "F5", 0.129),
    }
    for form, value, name, right in printed.values():
        assert number(form.subs(table) / (4 * lam**4), **at) == pytest.approx(value, rel=5e-3)
        assert number(rate(name), **at) == pytest.approx(right, rel=5e-3)


@establishes(
    PAPER,
    "B.16",
    printed=r"G_7 = \frac{\beta}{2\sin^2\beta L} - \frac{1}{2}\cot\beta L",
    verdict="slip",
    derived=r"G_7 = \frac{1}{2\beta}\left(\frac{\beta L}{\sin^2\beta L} - \cot\beta L\right)",
    remark="1/beta is missing, as M = rho A G: at beta = 0.1, L = 1 it gives 0.0334 for the 1/3 of "
    "a bar's mass matrix.",
)
@establishes(
    PAPER,
    "B.17",
    printed=r"G_8 = \frac{-\beta^2\cos\beta L}{2\sin^2\beta L} + \frac{1}{2\sin\beta L}",
    verdict="slip",
    derived=r"G_8 = \frac{1}{2\beta}\left(\frac{1}{\sin\beta L} - "
    r"\frac{\beta L\cos\beta L}{\sin^2\beta L}\right)",
    remark="beta^2 for beta, and 1/beta is missing: at beta = 0.1, L = 1 it gives 4.51 for 1/6.",
)
def test_rates_along_the_beam():
    sine, cosine = sp.sin(beta), sp.cos(beta)
    assert vanishes(rate("F7") - (beta / sine**2 - cosine / sine) / (2 * beta))
    assert vanishes(rate("F8") - (1 / sine - beta * cosine / sine**2) / (2 * beta))
    printed = {
        "F7": (beta / (2 * sine**2) - cosine / (2 * sine), 0.0334, sp.Rational(1, 3)),
        "F8": (-(beta**2) * cosine / (2 * sine**2) + 1 / (2 * sine), 4.51, sp.Rational(1, 6)),
    }
    for name, (form, value, limit) in printed.items():
        assert number(form, beta="0.1") == pytest.approx(value, rel=5e-3)
        assert sp.limit(rate(name), beta, 0) == limit
