"""Smith (6.7)-(6.13): sine modes, the projection and its integrals."""

from functools import cache

import numpy as np
import pytest
import seed_machine as machine
import sympy as sp
from seed_derivations import l2, l3, linear_beam, omega2, omega3, projected, theta2, theta3
from seed_formula import Formula
from seed_ledger import Ledger, hold, holds, latex, quoted, same
from seed_rigs import RIGS
from seed_truth import motion

row = Ledger("Smith", __file__)
MOTION = dict(l2=1.3, l3=4.0, omega2=1.7, omega3=-0.6, alpha3=0.9, theta2=0.8, theta3=0.3)
POINT = MOTION | dict(mu=0.7, EI=3.1, F_x=2.5)
Y = {1: 0.3, 2: -0.2, 3: 0.1}


def numeric(expression, **more):
    """Return a derived expression as a function of x at the numbers of the point."""
    values = {**POINT, **more}
    names = {s: s.name.replace("ell_", "l").replace("_", "") for s in expression.free_symbols}
    known = {s: values.get(s.name, values.get(n)) for s, n in names.items() if n != "x"}
    return sp.lambdify(sp.Symbol("x", real=True), expression.subs(known))


@cache
def modal():
    """Return places of the coupler where Hamilton's equation holds for three sine modes."""
    beam = linear_beam()
    tension = numeric(beam["tension"])
    slope = numeric(sp.diff(beam["tension"], sp.Symbol("x", real=True)))
    y_x, y_xx, y_xxxx, y_t, y_tt = beam["symbols"]
    still = dict.fromkeys((sp.Symbol("y", real=True), y_x, y_xx, y_xxxx, y_t, y_tt), 0)
    load = numeric(-beam["equation"].subs(still))
    mu = POINT["mu"]
    functions = {
        "f1": lambda x: tension(x) / mu,
        "f2": lambda x: -slope(x) / mu,
        "f3": lambda x: load(x) / mu,
    }
    points = []
    for place in (0.7, 1.9, 3.1):
        k = {n: n * np.pi / POINT["l3"] for n in Y}
        s, c = ({n: f(k[n] * place) for n in Y} for f in (np.sin, np.cos))
        shape = {y_t: 0, y_x: sum(Y[n] * k[n] * c[n] for n in Y)}
        shape |= {sp.Symbol("y", real=True): sum(Y[n] * s[n] for n in Y)}
        shape |= {y_xx: -sum(Y[n] * k[n] ** 2 * s[n] for n in Y)}
        shape |= {y_xxxx: sum(Y[n] * k[n] ** 4 * s[n] for n in Y), y_tt: 0}
        rest = numeric(beam["equation"].subs(shape))(place)
        Y_ddot = {1: (-rest / mu - 0.4 * s[2] + 0.5 * s[3]) / s[1], 2: 0.4, 3: -0.5}
        values = {name: f(place) for name, f in functions.items()}
        more = {"Y": Y, "Y_ddot": Y_ddot, "s": s, "c": c, "oo": 3, "functions": functions}
        points.append({**POINT, **values, **more, "x": place})
    return points


def shapes():
    """Return the sum of three modes with free functions of time."""
    t, length = sp.Symbol("t", real=True), sp.Symbol("l3", positive=True)
    x = sp.Symbol("x", real=True)

    def deflection(place, _):
        modes = (sp.Function(f"Y{n}")(t) * sp.sin(n * sp.pi * x / length) for n in (1, 2, 3))
        return sum(modes).subs(x, place)

    def bend(place, _):
        return deflection(x, t).diff(x, 2).subs(x, place)

    amplitude = lambda n, _: sp.Function(f"Y{n}")(t)  # noqa: E731
    return {"x": x, "t": t, "l3": length, "oo": 3, "y": deflection, "y_pp": bend, "Y": amplitude}


row("6.7", check=holds(lambda: [shapes()]))


row("6.8", check=holds(modal))


@row("6.9", derived=lambda: rf"\mu f_1 = {latex(machine.tension())},\; f_2 = -f_1'")
def functions_of_the_place(entry):
    hold(entry.printed, modal)
    for point in modal():
        same(numeric(machine.tension())(point["x"]), point["mu"] * point["f1"])


def pairs(last=4):
    """Return pairs of modes."""
    return [{**POINT, "m": m, "n": n} for m in range(1, last) for n in range(1, last)]


row("6.10", check=holds(lambda: ({**p, "delta": lambda m, n: float(m == n)} for p in pairs(5))))
row(
    "6.2.2 integrals of inertia, stiffness and omega3^2",
    check=holds(lambda: ({**modal()[0], "m": m} for m in (1, 2))),
)


def loaded(m, **modes):
    """Return the point with functions of the place for f1 to f3, and given amplitudes."""
    point = modal()[0]
    amplitudes = dict({n: modes.get(f"Y{n}", 0.0) for n in range(5)})
    return {**point, **point["functions"], "m": m, "Y": amplitudes}


@row("6.2.2 f1 integral")
def integral_with_f1(entry):
    hold(entry.corrected, *(loaded(m, Y1=1.0, Y2=0.7, Y3=0.4) for m in (1, 2, 3)))
    quoted(entry.printed.sides(**loaded(1, Y1=1.0))[0], "15.09", "4.406")
    quoted(entry.printed.sides(**loaded(1, Y2=1.0))[0], "14.28", "0")
    quoted(entry.printed.sides(**loaded(2, Y2=1.0, Y1=0.2))[0], "60.53", "17.62")


@row("6.2.2 f2 integral")
def integral_with_f2(entry):
    hold(entry.corrected, *(loaded(m, Y1=1.0, Y2=0.7, Y3=0.4) for m in (1, 2, 3)))
    quoted(entry.printed.sides(**loaded(1, Y1=1.0))[0], "-0.36", "0")
    quoted(entry.printed.sides(**loaded(1, Y2=1.0))[0], "-5.36", "0")
    quoted(entry.printed.sides(**loaded(2, Y2=1.0, Y1=0.2))[0], "0.7112", "0")


def with_parity(m):
    """Return the point for a mode, with the word for odd numbers."""
    return {**loaded(m), "odd": lambda k: k % 2 == 1}


row("6.2.2 f3 integral", check=holds(lambda: map(with_parity, range(1, 6))))
# What (6.11) drops from the coefficient of mode m.
DROPPED = Formula(
    "m**2*pi**2*l2/(2*l3)*omega2**2*cos(theta2 - theta3) + omega3**2*(m**2*pi**2/3 - 1/4)"
)


@cache
def coefficients(m):
    """Return inertia, coefficient and right-hand side of mode m by projection, in numbers."""
    return [float(numeric(sp.sympify(part))(0)) for part in projected(m, m)]


def dropped(rig):
    """Return what (6.17) drops from the coefficient of the first mode, over one turn, and phi.

    The dropped part is measured at unit crank speed, like phi and epsilon_i f_i.
    """
    m = motion(rig.lengths)
    _, crank, coupler, _ = rig.lengths
    names = {sp.Symbol(name, real=True): 0 for name in ("EI", "F_x")}
    whole = sp.lambdify([l2, l3, omega2, omega3, theta2, theta3], projected(1, 1)[1].subs(names))
    return whole(crank, coupler, 1.0, m.omega3, m.theta2, m.theta3) + m.omega3**2, m.omega3**2


@row(
    "6.11",
    derived=lambda: (
        r"\frac{\ddot Y_m}{\omega_2^2} + \left\{"
        + latex(machine.mode_coefficient()[0])
        + r" + \tfrac{F_x}{\mu\omega_2^2}(\tfrac{m\pi}{\ell_3})^2\right\}Y_m + "
        r"\text{coupling},\; \phi = \tfrac{\omega_3^2}{\omega_2^2};\; \text{mode 2 in mode 1: }"
        + latex(machine.coupling_coefficient(1, 2))
    ),
)
def equation_of_one_mode(entry):
    for m in (1, 2, 3):
        inertia, coefficient, right = coefficients(m)
        point = {**with_parity(m), "Y": 0.4, "Y_ddot": 0.7}
        left, printed = entry.printed.sides(**point)[0]
        same(left + 0.4 * DROPPED.value(**point), inertia * 0.7 + coefficient * 0.4)
        same(printed, right)
    assert abs(float(numeric(projected(1, 2)[1])(0))) > 1.0
    for name, largest, kept in (("5,1,5,2", 1.127, 0.0676), ("10,1,10,4", 0.525, 0.01236)):
        extra, phi = dropped(RIGS[name])
        assert [np.abs(extra).max(), phi.max()] == pytest.approx([largest, kept], rel=2e-3)


@row("6.2.2 coefficient as effective frequency")
def effective_frequency(entry):
    for m in (1, 2, 3):
        wave = m * np.pi / POINT["l3"]
        frequencies = {m: wave**2 * np.sqrt(POINT["EI"] / POINT["mu"])}
        loads = {m: POINT["EI"] * wave**2}
        point = {**with_parity(m), "Omega": frequencies, "F_E": loads}
        same(entry.printed.value(**point) + DROPPED.value(**point), coefficients(m)[1])


@cache
def stationary():
    """Return a pinned beam by finite differences: an independent eigenvalue problem."""
    count, length, stiffness, mass = 400, 4.0, 3.1, 0.7
    step = length / count
    second = np.diag(np.full(count - 1, -2.0)) + np.diag(np.ones(count - 2), 1)
    second = (second + np.diag(np.ones(count - 2), -1)) / step**2
    squares = np.linalg.eigvalsh(stiffness / mass * second @ second)[:3]
    named = {"EI": stiffness, "mu": mass, "l3": length}
    return [
        {**named, "m": m, "Omega_m": np.sqrt(square), "Y": 0.3, "Y_ddot": -square * 0.3}
        for m, square in enumerate(squares, 1)
    ]


def test_projection_of_the_stationary_coupler():
    still = {"omega2": 0, "omega3": 0, "F_x": 0}
    for point in stationary():
        square = numeric(projected(point["m"], point["m"])[1], **still)(0)
        assert square == pytest.approx(point["Omega_m"] ** 2, rel=4e-4)


row("6.12", check=holds(stationary, tol=4e-4))
row("6.13", check=holds(stationary, tol=2e-4))


@row("6.2.2 growth of the natural frequencies")
def growth_of_the_frequencies(entry):
    first, second, third = stationary()
    for point in (second, third):
        hold(entry.corrected, {**point, "Omega_1": first["Omega_m"]}, tol=1e-3)
    ratio, printed = entry.printed.sides(**second, Omega_1=first["Omega_m"])[0]
    assert ratio == pytest.approx(4.0, rel=1e-3) and printed == 16


@row("6.2.2 Euler load")
def euler_load(entry):
    for m in (1, 2, 3):
        load = entry.printed.values(**POINT, m=m)["F_E"]
        rest = numeric(projected(m, m)[1], omega2=0, omega3=0, F_x=-load)(0)
        assert rest == pytest.approx(0.0, abs=1e-12 * load)


test_row, test_falsified_row = row.tests()
