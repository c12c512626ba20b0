"""Smith (6.7)-(6.13): sine modes, the projection and its integrals."""

import numpy as np
import pytest
import seed_machine as machine
import sympy as sp
from scipy.integrate import quad
from seed_derivations import (
    EI,
    alpha3,
    force_x,
    l2,
    l3,
    linear_beam,
    mu,
    omega2,
    omega3,
    projected,
    theta2,
    theta3,
    x,
    y,
)
from seed_ledger import establishes
from seed_truth import RIGS, motion

CRANK = l2 * omega2**2
COS, SIN = sp.cos(theta2 - theta3), sp.sin(theta2 - theta3)
F1 = force_x / mu + (l3 - x) * CRANK * COS + (l3**2 - x**2) * omega3**2 / 2
F2 = CRANK * COS + x * omega3**2
F3 = CRANK * SIN - x * alpha3


def numbers(expression):
    """Evaluate at one set of arbitrary numbers; x stays."""
    values = {l2: 1.3, l3: 4.0, omega2: 1.7, omega3: -0.6, alpha3: 0.9, theta2: 0.8, theta3: 0.3}
    return expression.subs({**values, force_x: 2.5, mu: 0.7, EI: 3.1})


def integral(function, m, n, kind):
    """Integrate function * sin(m pi x/l3) * sin or cos(n pi x/l3) over the coupler."""
    length = 4.0
    values = sp.lambdify(x, numbers(function) + 0 * x)
    other = {"sin": np.sin, "cos": np.cos, "one": lambda _: 1.0}[kind]

    def integrand(place):
        return (
            values(place) * np.sin(m * np.pi * place / length) * other(n * np.pi * place / length)
        )

    return quad(integrand, 0.0, length, epsabs=1e-12, epsrel=1e-12, limit=200)[0]


@establishes(
    "Smith",
    "6.7",
    printed=r"y = \sum_n Y_n(t)\sin\frac{n\pi x}{\ell_3},\; y(0,t) = y(\ell_3,t) = 0,\; "
    r"\dot y(0,t) = \dot y(\ell_3,t) = 0",
    verdict="slip",
    derived=lambda: rf"y = 0,\; {sp.latex(machine.end_conditions()[0])} = 0 \text{{ at both ends}}",
    remark="Pins carry no moment: the second condition is y'' = 0. Read as a rate in time the "
    "printed one adds nothing; read as a slope it is false: the first mode has slope pi/l3 at B.",
)
def test_end_conditions():
    for n in (1, 2, 3):
        shape = sp.sin(n * sp.pi * x / l3)
        for place in (0, l3):
            assert shape.subs(x, place) == 0
            assert sp.diff(shape, x, 2).subs(x, place) == 0
            assert sp.simplify(abs(sp.diff(shape, x).subs(x, place)) - n * sp.pi / l3) == 0
    # A clamped shape satisfies the condition on values and rates in time, yet it is no pinned one.
    clamped = x**2 * (l3 - x) ** 2
    assert clamped.subs(x, 0) == clamped.subs(x, l3) == 0
    assert sp.diff(clamped, x, 2).subs(x, 0) != 0


@establishes(
    "Smith",
    "6.8",
    printed=r"\sum\ddot Y_n s_n + \frac{EI}{\mu}\sum\left(\frac{n\pi}{\ell_3}\right)^4 Y_n s_n "
    r"+ f_1\sum\left(\frac{n\pi}{\ell_3}\right)^2 Y_n s_n + f_2\sum\frac{n\pi}{\ell_3}Y_n c_n "
    r"- \omega_3^2\sum Y_n s_n = f_3",
    verdict="agrees",
    derived=r"s_n = \sin\frac{n\pi x}{\ell_3},\; c_n = \cos\frac{n\pi x}{\ell_3}",
    remark="With f3 of (6.9), not with the right-hand side printed in (6.6).",
)
@establishes(
    "Smith",
    "6.9",
    printed=r"f_1 = \frac{F_x}{\mu} + \ell_2(\ell_3 - x)\omega_2^2\cos(\theta_2 - \theta_3) "
    r"+ \tfrac12(\ell_3^2 - x^2)\omega_3^2,\; f_2 = \ell_2\omega_2^2\cos(\theta_2 - \theta_3) "
    r"+ x\omega_3^2,\; f_3 = \ell_2\omega_2^2\sin(\theta_2 - \theta_3) - x\alpha_3",
    verdict="agrees",
    derived=lambda: rf"\mu f_1 = {sp.latex(machine.tension())},\; f_2 = -f_1'",
)
def test_modes_substituted():
    beam = linear_beam()
    assert sp.expand(beam["tension"] - mu * F1) == 0
    assert sp.expand(F2 + sp.diff(F1, x)) == 0
    Y, Y_tt, n = sp.symbols("Y Y_tt n", real=True)
    k = n * sp.pi / l3
    shape = sp.sin(k * x)
    y_x, y_xx, y_xxxx, y_t, y_tt = beam["symbols"]
    values = {y_tt: Y_tt * shape, y_t: 0, y: Y * shape}
    values |= {s: Y * sp.diff(shape, x, i) for s, i in ((y_x, 1), (y_xx, 2), (y_xxxx, 4))}
    printed = Y_tt * shape + EI / mu * k**4 * Y * shape + F1 * k**2 * Y * shape
    printed += F2 * k * Y * sp.cos(k * x) - omega3**2 * Y * shape - F3
    assert sp.simplify(sp.expand(mu * printed - beam["equation"].subs(values))) == 0


@establishes(
    "Smith",
    "6.10",
    printed=r"\int_0^{\ell_3}\sin\frac{n\pi x}{\ell_3}\sin\frac{m\pi x}{\ell_3}dx = "
    r"\tfrac{\ell_3}{2}\delta_{mn}",
    verdict="agrees",
)
@establishes(
    "Smith",
    "6.2.2 integrals of inertia, stiffness and omega3^2",
    printed=r"\frac{\ell_3}{2}\ddot Y_m,\; \frac{\ell_3}{2}\left(\frac{m\pi}{\ell_3}\right)^4 Y_m,"
    r"\; \frac{\ell_3}{2}Y_m",
    verdict="agrees",
    remark="The text refers to (5.8); it is (6.8).",
)
def test_orthogonality():
    for m in range(1, 5):
        for n in range(1, 5):
            assert integral(sp.Integer(1), m, n, "sin") == pytest.approx(
                2.0 if m == n else 0.0, abs=1e-12
            )


@establishes(
    "Smith",
    "6.2.2 f1 integral",
    printed=r"\int_0^{\ell_3} f_1\sin\frac{m\pi x}{\ell_3}\sum\left(\frac{n\pi}{\ell_3}\right)^2 "
    r"Y_n\sin\frac{n\pi x}{\ell_3}dx = \frac{\ell_3}{2}\left(\frac{m\pi}{\ell_3}\right)^2"
    r"\frac{F_x}{\mu}Y_m",
    verdict="slip",
    derived=r"\text{diagonal: } \frac{\ell_3}{2}\left\{\left(\frac{m\pi}{\ell_3}\right)^2\left("
    r"\frac{F_x}{\mu} + \frac{\ell_2\ell_3}{2}\omega_2^2\cos(\theta_2 - \theta_3) + "
    r"\frac{\ell_3^2}{3}\omega_3^2\right) + \frac{\omega_3^2}{4}\right\}Y_m,"
    r"\text{ and a coupling to every other mode}",
    remark="Orthogonality does not remove a factor that depends on x. With the test's numbers and "
    "m = n = 1 the integral is 15.09, the printed value 4.41; from the second mode comes 14.28 "
    "where nothing is printed.",
)
def test_integral_with_f1():
    k = np.pi / 4.0
    true = integral(F1, 1, 1, "sin") * k**2
    printed = 2.0 * k**2 * 2.5 / 0.7
    assert printed == pytest.approx(4.41, abs=0.01)
    assert true == pytest.approx(15.09, abs=0.01)
    assert integral(F1, 1, 2, "sin") * (2 * k) ** 2 == pytest.approx(14.28, abs=0.01)
    for m in (1, 2, 3):
        bracket = (m * sp.pi / l3) ** 2
        bracket *= force_x / mu + l2 * l3 * omega2**2 * COS / 2 + l3**2 * omega3**2 / 3
        derived = l3 / 2 * (bracket + omega3**2 / 4)
        value = integral(F1, m, m, "sin") * (m * k) ** 2
        assert float(numbers(derived)) == pytest.approx(value, rel=1e-11)


@establishes(
    "Smith",
    "6.2.2 f2 integral",
    printed=r"\int_0^{\ell_3} f_2\sin\frac{m\pi x}{\ell_3}\sum\frac{n\pi}{\ell_3}Y_n"
    r"\cos\frac{n\pi x}{\ell_3}dx = 0",
    verdict="slip",
    derived=r"\text{diagonal: } -\frac{\ell_3}{4}\omega_3^2 Y_m,\text{ and a coupling to every "
    r"other mode}",
    remark="-0.36 for m = n = 1 with the test's numbers, -5.36 from mode 2 into mode 1.",
)
def test_integral_with_f2():
    k = np.pi / 4.0
    for m in (1, 2, 3):
        value = integral(F2, m, m, "cos") * m * k
        assert value == pytest.approx(-4.0 / 4 * 0.36, rel=1e-11)
    assert integral(F2, 1, 2, "cos") * 2 * k == pytest.approx(-5.36, abs=0.01)


@establishes(
    "Smith",
    "6.2.2 f3 integral",
    printed=r"\int_0^{\ell_3} f_3\sin\frac{m\pi x}{\ell_3}dx = "
    r"\frac{\ell_3}{m\pi}\{2\ell_2\omega_2^2\sin(\theta_2 - \theta_3) - \ell_3\alpha_3\}\ (m\text{ "
    r"odd}),\; \frac{\ell_3}{m\pi}\ell_3\alpha_3\ (m\text{ even})",
    verdict="agrees",
)
def test_integral_with_f3():
    for m in range(1, 6):
        odd = 2 * CRANK * SIN - l3 * alpha3
        printed = l3 / (m * sp.pi) * (odd if m % 2 else l3 * alpha3)
        assert float(numbers(printed)) == pytest.approx(integral(F3, m, 0, "one"), rel=1e-11)


def dropped(rig):
    """Return what (6.17) drops from the coefficient of the first mode, over one turn, and phi.

    The dropped part is measured at unit crank speed, like phi and epsilon_i f_i.
    """
    m = motion(rig.lengths)
    _, crank, coupler, _ = rig.lengths
    whole = sp.lambdify(
        [l2, l3, omega2, omega3, theta2, theta3], projected(1, 1)[1].subs({EI: 0, force_x: 0})
    )
    return whole(crank, coupler, 1.0, m.omega3, m.theta2, m.theta3) + m.omega3**2, m.omega3**2


@establishes(
    "Smith",
    "6.11",
    printed=r"\ddot Y_m + Y_m\left\{\frac{EI}{\mu}\left(\frac{m\pi}{\ell_3}\right)^4 - \omega_3^2 "
    r"+ \frac{F_x}{\mu}\left(\frac{m\pi}{\ell_3}\right)^2\right\} = "
    r"\frac{2}{m\pi}\{2\ell_2\omega_2^2\sin(\theta_2 - \theta_3) - \ell_3\alpha_3\}\ (m\text{ "
    r"odd}),\; \frac{2\ell_3\alpha_3}{m\pi}\ (m\text{ even})",
    verdict="approximation",
    derived=lambda: (
        r"\frac{\ddot Y_m}{\omega_2^2} + \left\{"
        + sp.latex(machine.mode_coefficient()[0])
        + r" + \tfrac{F_x}{\mu\omega_2^2}(\tfrac{m\pi}{\ell_3})^2\right\}Y_m + "
        r"\text{coupling},\; \phi = \tfrac{\omega_3^2}{\omega_2^2};\; \text{mode 2 in mode 1: }"
        + sp.latex(machine.coupling_coefficient(1, 2))
    ),
    remark="Dropped from the coefficient: m^2 pi^2 (l2/2 l3) omega2^2 cos(theta2 - theta3) + "
    "omega3^2 (m^2 pi^2/3 - 1/4), and the coupling of modes. At m = 1 its largest value over "
    "omega2^2 is 1.13 for (5,1,5,2) and 0.52 for (10,1,10,4), beside 0.068 and 0.012 of the kept "
    "omega3^2. With it the coefficient of omega3^2 is +2.04, not -1. Right-hand sides agree.",
)
@establishes(
    "Smith",
    "6.2.2 coefficient as effective frequency",
    printed=r"\frac{EI}{\mu}\left(\frac{m\pi}{\ell_3}\right)^4\left\{1 - \left(\frac{\omega_3}"
    r"{\Omega_m}\right)^2 + \frac{F_x}{F_{E_m}}\right\}",
    verdict="approximation",
    derived=r"\text{identical with the coefficient printed in (6.11)}",
    remark="Drops what (6.11) drops: up to 1.13 omega2^2 for (5,1,5,2).",
)
@pytest.mark.parametrize(
    ("name", "largest", "kept"), [("5,1,5,2", 1.127, 0.0676), ("10,1,10,4", 0.525, 0.01236)]
)
def test_equation_of_one_mode(name, largest, kept):
    extra, phi = dropped(RIGS[name])
    assert np.abs(extra).max() == pytest.approx(largest, rel=2e-3)
    assert phi.max() == pytest.approx(kept, rel=2e-3)
    for m in (1, 2, 3):
        inertia, coefficient, right = projected(m, m)
        k = m * sp.pi / l3
        printed = EI / mu * k**4 - omega3**2 + force_x / mu * k**2
        frequency2, euler = EI / mu * k**4, EI * k**2
        as_frequency = frequency2 * (1 - omega3**2 / frequency2 + force_x / euler)
        assert sp.simplify(as_frequency - printed) == 0
        missing = k**2 * l2 * l3 / 2 * omega2**2 * COS
        missing += omega3**2 * (sp.Rational(m**2, 3) * sp.pi**2 - sp.Rational(1, 4))
        assert inertia == 1
        assert sp.simplify(coefficient - printed - missing) == 0
        odd, even = 2 * CRANK * SIN - l3 * alpha3, l3 * alpha3
        assert sp.simplify(right - 2 / (m * sp.pi) * (odd if m % 2 else even)) == 0
    assert sp.simplify(projected(1, 2)[1]) != 0


@establishes(
    "Smith",
    "6.12",
    printed=r"\ddot Y_m + \frac{EI}{\mu}\left(\frac{m\pi}{\ell_3}\right)^4 Y_m = 0",
    verdict="agrees",
    derived=r"\text{all speeds and the end load zero}",
)
@establishes(
    "Smith",
    "6.13",
    printed=r"\ddot Y_m + \Omega_m^2 Y_m = 0",
    verdict="agrees",
    derived=r"\Omega_m = \frac{m^2\pi^2}{\ell_3^2}\sqrt{\frac{EI}{\mu}}",
)
@establishes(
    "Smith",
    "6.2.2 growth of the natural frequencies",
    printed=r"\Omega_m \propto m^4 \text{ (text)}",
    verdict="slip",
    derived=r"\Omega_m \propto m^2,\; \Omega_m^2 \propto m^4",
    remark="Omega_2/Omega_1 is 4, not 16. The factors 16 and 4 that the text draws for "
    "(omega3/Omega_m)^2 and F_x/F_Em are right.",
)
def test_stationary_coupler():
    # A pinned beam by finite differences: an independent eigenvalue problem.
    count, length, stiffness, mass = 400, 4.0, 3.1, 0.7
    step = length / count
    second = np.diag(np.full(count - 1, -2.0)) + np.diag(np.ones(count - 2), 1)
    second = (second + np.diag(np.ones(count - 2), -1)) / step**2
    found = np.sqrt(np.linalg.eigvalsh(stiffness / mass * second @ second)[:3])
    still = {omega2: 0, omega3: 0, force_x: 0, EI: stiffness, mu: mass, l3: length}
    ours = [np.sqrt(float(projected(m, m)[1].subs(still))) for m in (1, 2, 3)]
    printed = [m**2 * np.pi**2 / length**2 * np.sqrt(stiffness / mass) for m in (1, 2, 3)]
    assert ours == pytest.approx(printed, rel=1e-12)
    assert found == pytest.approx(printed, rel=2e-4)
    assert found[1] / found[0] == pytest.approx(4.0, rel=1e-3)


@establishes(
    "Smith",
    "6.2.2 Euler load",
    printed=r"F_{E_m} = \frac{EI m^2\pi^2}{\ell_3^2}",
    verdict="agrees",
    remark="At F_x = -F_Em, all speeds zero, the derived coefficient vanishes.",
)
def test_euler_load():
    for m in (1, 2, 3):
        loaded = projected(m, m)[1].subs({omega2: 0, omega3: 0})
        assert sp.simplify(loaded.subs(force_x, -EI * (m * sp.pi / l3) ** 2)) == 0
