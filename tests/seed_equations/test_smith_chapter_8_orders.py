"""Smith (8.23)-(8.26), (8.30)-(8.35): the equations of each order of the modified method."""

import numpy as np
import pytest
import sympy as sp
from seed_ledger import establishes
from seed_series import (
    TWO_FUNCTIONS,
    alpha,
    delta,
    eps,
    function,
    n,
    operator,
    part,
    psi,
    rows,
    theta,
)
from smith_chapter_8.modified import modified_formulas, modified_method

ONE, TWO = TWO_FUNCTIONS
bar1, bar2 = function("fbar1"), function("fbar2")
wave = sp.cos(n * theta - psi)
THREE = ((*eps, delta), eps[0] * bar1 + eps[1] * bar2 + delta * wave)


def row(*powers, found=""):
    """Return the derived equation of one order in LaTeX, and what it gives."""
    return lambda: f"{sp.latex(rows(*THREE)[powers])} = 0{found}"


def sums(one, other, region):
    """Return w and W of two functions, over all harmonics but 0 and n, as the remark of 8.30."""

    def c(f, m):
        a, b = (float(x) for x in f.harmonic(abs(m)))
        return complex(a, -b if m > 0 else b) / 2 if abs(m) != region else 0.0

    numbers = [m for m in range(-20, 21) if m not in (0, region)]
    w = -sum((c(one, m).conjugate() * c(other, m)).real / (m * (m - region)) for m in numbers)
    coupling = sum(c(one, m) * c(other, region - m) / (m * (region - m)) for m in numbers)
    return w, coupling


RIGHT = {
    (0, 0, 0): 0,
    (1, 0, 0): -(alpha(1, 0, 0) + bar1) * part(0, 0, 0),
    (0, 1, 0): -(alpha(0, 1, 0) + bar2) * part(0, 0, 0),
    (0, 0, 1): -(alpha(0, 0, 1) + wave) * part(0, 0, 0),
    (2, 0, 0): -alpha(2, 0, 0) * part(0, 0, 0) - (alpha(1, 0, 0) + bar1) * part(1, 0, 0),
    (0, 2, 0): -alpha(0, 2, 0) * part(0, 0, 0) - (alpha(0, 1, 0) + bar2) * part(0, 1, 0),
    (0, 0, 2): -alpha(0, 0, 2) * part(0, 0, 0) - (alpha(0, 0, 1) + wave) * part(0, 0, 1),
    (1, 1, 0): -alpha(1, 1, 0) * part(0, 0, 0)
    - (alpha(1, 0, 0) + bar1) * part(0, 1, 0)
    - (alpha(0, 1, 0) + bar2) * part(1, 0, 0),
    (1, 0, 1): -alpha(1, 0, 1) * part(0, 0, 0)
    - (alpha(1, 0, 0) + bar1) * part(0, 0, 1)
    - (alpha(0, 0, 1) + wave) * part(1, 0, 0),
    (0, 1, 1): -alpha(0, 1, 1) * part(0, 0, 0)
    - (alpha(0, 1, 0) + bar2) * part(0, 0, 1)
    - (alpha(0, 0, 1) + wave) * part(0, 1, 0),
}


@establishes(
    "Smith",
    "8.23",
    printed=r"y_{000}'' + (\tfrac n2)^2 y_{000} = 0",
    verdict="agrees",
    derived=row(0, 0, 0),
)
@establishes(
    "Smith",
    "8.24",
    printed=r"y_{100}'' + (\tfrac n2)^2 y_{100} = -\{\alpha_{100} + \bar f_1\}y_{000}",
    verdict="agrees",
    derived=row(1, 0, 0),
    remark="The scan has z for f here and in (8.25).",
)
@establishes(
    "Smith",
    "8.25",
    printed=r"y_{010}'' + (\tfrac n2)^2 y_{010} = -\{\alpha_{010} + \bar f_2\}y_{000}",
    verdict="agrees",
    derived=row(0, 1, 0),
)
@establishes(
    "Smith",
    "8.26",
    printed=r"y_{001}'' + (\tfrac n2)^2 y_{001} = -\{\alpha_{001} + \cos(n\theta - \psi_n)\}"
    r"y_{000}",
    verdict="agrees",
    derived=row(0, 0, 1),
)
@establishes(
    "Smith",
    "8.30",
    printed=r"y_{200}'' + (\tfrac n2)^2 y_{200} = -\alpha_{200}y_{000} - \{\alpha_{100} + \bar "
    r"f_1\}y_{100}",
    verdict="agrees",
    derived=row(2, 0, 0, found=r",\; \alpha_{200} = w_{11} \mp \Re(W_{11}e^{i\psi_n})"),
    remark="The equation; no solution is periodic. With alpha_100 = -a_0 the constants of y_100 "
    "drop out, and alpha_200 alone would have to meet two conditions; the text says that y_200 may "
    "be found by straightforward means. The first gives the alpha_200 of the boundary, the second "
    "is left over: Im(W_11 exp(i psi_n)). With c_m^j = (a_m - i b_m)/2 of f_j, w_jk = "
    "-sum Re(conj(c_m^j) c_m^k)/(m(m - n)), W_jk = sum c_m^j c_(n-m)^k/(m(n - m)), over all m but "
    "0 and n, positive and negative, harmonic n taken as zero. Upper signs: upper boundary.",
)
@establishes(
    "Smith",
    "8.31",
    printed=r"y_{020}'' + (\tfrac n2)^2 y_{020} = -\alpha_{020}y_{000} - \{\alpha_{010} + \bar "
    r"f_2\}y_{010}",
    verdict="agrees",
    derived=row(0, 2, 0, found=r",\; \alpha_{020} = w_{22} \mp \Re(W_{22}e^{i\psi_n})"),
    remark="As (8.30).",
)
@establishes(
    "Smith",
    "8.32",
    printed=r"y_{002}'' + (\tfrac n2)^2 y_{002} = -\alpha_{002}y_{000} - \{\alpha_{001} + \cos("
    r"n\theta - \psi_n)\}y_{001}",
    verdict="agrees",
    derived=row(0, 0, 2, found=r",\; \alpha_{002} = -\tfrac{1}{8n^2}"),
    remark="Solvable, and the same on both boundaries.",
)
@establishes(
    "Smith",
    "8.33",
    printed=r"y_{110}'' + (\tfrac n2)^2 y_{110} = -\alpha_{110}y_{000} - \{\alpha_{100} + \bar "
    r"f_1\}y_{010} - \{\alpha_{010} + \bar f_2\}y_{100}",
    verdict="agrees",
    derived=row(1, 1, 0, found=r",\; \alpha_{110} = 2w_{12} \mp 2\Re(W_{12}e^{i\psi_n})"),
    remark="As (8.30).",
)
@establishes(
    "Smith",
    "8.34",
    printed=r"y_{101}'' + (\tfrac n2)^2 y_{101} = -\alpha_{101}y_{000} - \{\alpha_{100} + \bar "
    r"f_1\}y_{001} - \{\alpha_{001} + \cos(n\theta - \psi_n)\}y_{100}",
    verdict="agrees",
    derived=row(
        1,
        0,
        1,
        found=r",\; \alpha_{101} = \pm\tfrac{1}{4n^2}(a_{2n}\cos2\psi_n + b_{2n}\sin2\psi_n)",
    ),
    remark="Solvable: its second condition fixes the constant of y_100.",
)
@establishes(
    "Smith",
    "8.35",
    printed=r"y_{011}'' + (\tfrac n2)^2 y_{011} = -\alpha_{011}y_{000} - \{\alpha_{010} + \bar "
    r"f_2\}y_{001} - \{\alpha_{001} + \cos(n\theta - \psi_n)\}y_{010}",
    verdict="agrees",
    derived=row(
        0,
        1,
        1,
        found=r",\; \alpha_{011} = \pm\tfrac{1}{4n^2}(c_{2n}\cos2\psi_n + d_{2n}\sin2\psi_n)",
    ),
    remark="As (8.34).",
)
def test_powers_of_three_parameters():
    found = rows(*THREE)
    assert set(found) == set(RIGHT)
    for powers, value in RIGHT.items():
        assert sp.expand(found[powers] - operator(part(*powers)) + value) == 0
    # Which of the second-order equations can be solved.
    method = modified_method((ONE, TWO), 2)
    for branch in (method.lower, method.upper):
        assert set(branch.excess) == {(2, 0, 0), (1, 1, 0), (0, 2, 0)}
        assert all(value != 0 for value in branch.excess.values())
        assert set(branch.constants) == {(1, 0, 0), (0, 1, 0), (0, 0, 1)}
        assert branch.alpha[0, 0, 2] == sp.Rational(-1, 32)
    table = modified_formulas()
    assert table["alpha_002"] == -1 / (8 * n**2)
    sigma = sp.Symbol("sigma", real=True)
    (angle,) = method.upper.alpha[1, 0, 1].free_symbols
    a2n, b2n = (sp.Rational(x) for x in ONE.harmonic(4))
    expected = (a2n * sp.cos(2 * angle) + b2n * sp.sin(2 * angle)) / 16
    assert sp.expand(method.upper.alpha[1, 0, 1] - expected) == 0
    assert sp.expand(method.lower.alpha[1, 0, 1] + expected) == 0
    assert table["alpha_101"].coeff(sigma) != 0
    # The coefficients of the second order without delta, and what is left over, by complex sums.
    pairs = {(2, 0, 0): (ONE, ONE, 1), (0, 2, 0): (TWO, TWO, 1), (1, 1, 0): (ONE, TWO, 2)}
    for powers, (one, other, times) in pairs.items():
        w, coupling = sums(one, other, 2)
        for turned in (0.3, 1.9, 4.0):
            projected = coupling * np.exp(1j * turned)
            for sign, branch in ((1, method.upper), (-1, method.lower)):
                value = float(branch.alpha[powers].subs(angle, turned))
                assert value == pytest.approx(times * (w - sign * projected.real), abs=1e-12)
                left_over = abs(float(branch.excess[powers].subs(angle, turned)))
                assert left_over == pytest.approx(times * abs(projected.imag), abs=1e-12)
