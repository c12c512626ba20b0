"""Aannaque chapter 7: Floquet's theory, constant intervals, Meissner's functions, steady state."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import expm, logm
from scipy.special import mathieu_a, mathieu_b
from seed_ledger import Ledger, hold, holds, point_by_point, quoted, same, truths
from seed_truth import normalised_solutions

row = Ledger("Aannaque", __file__)
PERIOD = 2.0
OMEGA = 2.0 * np.pi / PERIOD


def turning_mass(t):
    """Return M, C, K and M' of two freedoms whose mass turns."""
    c, s = np.cos(OMEGA * t), np.sin(OMEGA * t)
    mass = np.array([[2.0 + 0.5 * c, 0.3 * s], [0.3 * s, 1.5 - 0.4 * c]])
    slope = OMEGA * np.array([[-0.5 * s, 0.3 * c], [0.3 * c, 0.4 * s]])
    damping = np.array([[0.2, 0.05], [0.05, 0.1]])
    stiffness = np.array([[9.0 + c, 0.7], [0.7, 21.0 - 2.0 * s]])
    return mass, damping, stiffness, slope


def load(t):
    """Return the true acceleration of the rigid motion."""
    return np.array([np.cos(OMEGA * t), np.sin(2.0 * OMEGA * t)])


def state_matrix(t):
    """Return A(t) of (7.2)."""
    mass, damping, stiffness, _ = turning_mass(t)
    lower = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    return np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower])


def solved(rates, start, end, begin=0.0):
    tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    return solve_ivp(rates, (begin, end), start, **tight).y[:, -1]


@cache
def transition(end, begin=0.0):
    """Return the matrix from a start to an end, backwards too."""
    rates = lambda t, y: (state_matrix(t) @ y.reshape(4, 4)).ravel()  # noqa: E731
    return solved(rates, np.eye(4).ravel(), end, begin).reshape(4, 4)


def multipliers(drag):
    """Return the multipliers without damping, the mass's change left out or not."""

    def rates(t, y):
        mass, _, stiffness, slope = turning_mass(t)
        push = drag * slope @ y[2:] + stiffness @ y[:2]
        return np.concatenate([y[2:], -np.linalg.solve(mass, push)])

    return np.linalg.eigvals(np.stack([solved(rates, e, PERIOD) for e in np.eye(4)], axis=1))


def moment(t=0.37):
    """Return M, C, K and a state with its derivative by the equation (7.1) as it stands."""
    mass, damping, stiffness, _ = turning_mass(t)
    q, q_dot, r = np.array([0.3, -0.2]), np.array([1.1, 0.4]), load(t)
    point = {"M": mass, "C": damping, "K": stiffness, "q": q, "q_dot": q_dot, "qr_ddot": r}
    q_ddot = -np.linalg.solve(mass, damping @ q_dot + stiffness @ q) - r
    free = q_ddot + r
    blocks = {"Z": np.zeros((2, 2)), "E": np.eye(2), "q_ddot": q_ddot}
    return {**point, **blocks, "y": np.r_[q, q_dot], "y_dot": np.r_[q_dot, free]}


@row("7.1")
def instantaneous_form(entry):
    """It keeps the product of the multipliers, but not each of them on the circle."""
    hold(entry.printed, moment())
    kept, dropped = np.abs(multipliers(1.0)), np.abs(multipliers(0.0))
    np.testing.assert_allclose(kept, 1.0, atol=1e-9)
    assert np.prod(dropped) == pytest.approx(1.0, abs=1e-9)
    assert np.max(np.abs(dropped - 1.0)) > 1e-3


row("7.2", check=holds(lambda: [moment()]))


@cache
def floquet():
    """Return Floquet's form at some instants: B = ln R / T, its periodic factor, a multiplier."""
    R = transition(PERIOD)
    B = logm(R) / PERIOD
    roots, vectors = np.linalg.eig(R)

    def factor(t):
        """The periodic factor, from its first period."""
        return transition(t % PERIOD) @ expm(-B * (t % PERIOD))

    points = []
    for t in (0.31, 1.2, 2.31):
        whole = transition(t)
        point = {"t": t, "T": PERIOD, "Y": lambda at: transition(at), "Phi": factor, "B": B}
        point |= {"exp": expm, "R": R, "E": np.eye(4)}
        vector = vectors[:, 0]
        point |= {"y": lambda at, v=vector: transition(at) @ v, "rho": roots[0]}
        points.append(point | {"whole": whole})
    return points


row("7.3", "7.4", "7.5", check=holds(floquet, tol=1e-7))


@row("7.6")
def transition_matrices_form_a_group(entry):
    hold(entry.printed, {"psi": transition, "t1": 0.2, "t2": 1.7, "t3": 0.9}, tol=1e-8)


def variation():
    """Return a motion under the rigid acceleration, and the periodic one."""

    def h(t):
        return np.concatenate([np.zeros(2), -load(t)])

    rates = lambda t, y: state_matrix(t) @ y + h(t)  # noqa: E731
    start = np.array([0.1, 0.0, -0.2, 0.3])
    whole = transition(PERIOD)
    pushed = point_by_point(lambda t: transition(PERIOD, float(t)) @ h(t), 0.0, PERIOD)
    periodic = np.linalg.solve(np.eye(4) - whole, pushed)
    np.testing.assert_allclose(solved(rates, periodic, PERIOD), periodic, atol=1e-9)
    y = {0.0: start, PERIOD: solved(rates, start, PERIOD)}
    names = {"psi": lambda a, b: transition(float(a), float(b)), "E": np.eye(4)}
    names |= {"y": lambda t: y[t], "t": PERIOD, "t_0": 0.0, "z": np.zeros(2), "T": PERIOD}
    names["Int"] = point_by_point
    return {**names, "qr_ddot": load, "h": h, "periodic": periodic}


@row("7.7")
def variation_of_constants(entry):
    p = {k: v for k, v in variation().items() if k != "h"}
    hold(entry.corrected, p, tol=1e-8)
    hold(entry.printed, {**p, "qr_ddot": lambda t: -load(t)}, tol=1e-8)


@row("7.8")
def periodic_state(entry):
    p = variation()
    hold(entry.printed, {**p, "y": lambda t: p["periodic"] * (1 + t)}, tol=1e-8)


@row("7.2 stability from the multipliers")
def multipliers_on_the_circle(entry):
    """They may belong to growing solutions: y'' = 0, and a boundary of Mathieu's equation."""
    r = np.array([[1.0, PERIOD], [0.0, 1.0]])
    assert all(truths(entry.printed, rho=root)[0] for root in np.linalg.eigvals(r))
    assert np.linalg.matrix_power(r, 1000)[0, 1] == 1000 * PERIOD
    assert truths(entry.printed, rho=1.001) == [False]
    d = float(mathieu_a(1, 1.0))
    found = normalised_solutions(lambda t: d - 2.0 * np.cos(2.0 * t), np.pi)
    np.testing.assert_allclose(np.linalg.eigvals(found), -1.0, atol=1e-4)
    assert np.linalg.norm(np.linalg.matrix_power(found, 1000)) > 300.0


def half_trace(levels, lengths):
    """Return half the trace of a product of matrix exponentials."""
    whole = np.eye(2)
    for level, length in zip(levels, lengths, strict=True):
        whole = expm(np.array([[0.0, 1.0], [-level, 0.0]]) * length) @ whole
    return 0.5 * np.trace(whole)


@row("7.2 ends of a stable range")
def one_sign_on_both_sides(_):
    places = np.linspace(4.5, 9.0, 901)
    values = np.array([half_trace((x + 2.5, x - 2.5), (np.pi, np.pi)) for x in places])
    touch = np.argmin(values)
    assert places[touch] == pytest.approx(6.5, abs=1e-3)
    assert values[touch] == pytest.approx(-1.0, abs=1e-9)
    left, right = (
        np.flatnonzero(values[part] > 1.0) for part in (slice(touch), slice(touch, None))
    )
    inside = values[left[-1] + 1 : touch + right[0]]
    assert np.all(np.abs(inside) <= 1.0 + 1e-12) and len(inside) > 200


def interval(w=1.3, dt=0.4):
    """Return the matrix of one interval of constant frequency as an exponential."""
    return {"w": w, "dt": dt, "A": expm(np.array([[0.0, 1.0], [-(w**2), 0.0]]) * dt)}


row("7.9", check=holds(lambda: [interval()]))


@row("7.2 powers of the interval matrix")
def powers_of_the_matrix(entry):
    p = interval(1.0, 0.3)
    square = (p["A"] @ p["A"])[0, 1]
    hold(entry.corrected, {**p, "A2_12": square})
    quoted([entry.printed.values(**p)["A2_12"], square], "0.087", "0.565")
    quoted([entry.printed.values(w=2.0, dt=0.7)["A2_12"]], "0.4856")


@row("7.2 multipliers at a constant frequency")
def multipliers_at_a_constant_frequency(entry):
    """Real, and -1, also where the frequency is 3/2, 5/2 ... of the speed."""
    for ratio, expected in ((3.0, 1.0), (1.5, -1.0), (2.5, -1.0), (1.3, None)):
        roots = np.linalg.eigvals(interval(1.0, 2 * np.pi * ratio)["A"])
        if expected:
            np.testing.assert_allclose(roots, expected, atol=1e-7)
        values = [entry.printed.values(w=ratio, omega=1.0, pm=sign)["lam"] for sign in (1, -1)]
        np.testing.assert_allclose(np.sort_complex(roots), np.sort_complex(values), atol=1e-7)
        same(values[0], entry.printed.values(w=2 * ratio, omega=2.0, pm=1)["lam"])


@cache
def meissner():
    """Return periods of two and three intervals, J by half traces of matrix exponentials."""
    generator, points = np.random.default_rng(711), []
    for _ in range(6):
        T = generator.uniform(0.5, 4.0)
        v, parts = generator.uniform(0.3, 6.0, 3), generator.dirichlet(np.ones(3)) * 2.0 * np.pi
        point = {"T": T, "v": {k: w for k, w in enumerate(v, 1)}}
        for count in (2, 3):
            share = parts[:count] * 2.0 * np.pi / parts[:count].sum()
            levels = (T * v[:count] / (2.0 * np.pi)) ** 2
            phases = T * v[:count] * share / (2.0 * np.pi)
            letters = {"theta": {k: w for k, w in enumerate(share, 1)}}
            letters |= {"count": count, f"J{count}": half_trace(levels, share)}
            letters["C"], letters["S"] = (dict(enumerate(f(phases), 1)) for f in (np.cos, np.sin))
            numbers = [(i, k) for i in range(count) for k in range(count)]
            ratios = {(i + 1, k + 1): v[i] / v[k] for i, k in numbers}
            letters["V"] = {(i, k): (ratios[i, k] + ratios[k, i]) / 2 for i, k in ratios}
            points.append({**point, **letters, "i": 1, "k": 2})
    return points


row("7.2 C, S and V", check=holds(meissner))


@row("7.11")
def meissners_functions(entry):
    """J is half the trace; C, S and V as the row before defines them."""
    for point in meissner():
        hold(entry.printed[point["count"] - 2], point)


@row("7.10")
def equation_of_an_interval(entry):
    """The wave of an interval of frequency v, its angle running 2 pi in the period T."""
    theta, T, v = sp.symbols("theta T v", positive=True)
    names = {"theta": theta, "T": T, "v": {sp.Symbol("i"): v}, "i": sp.Symbol("i")}
    hold(entry.printed, {**names, "y": sp.cos(T * v * theta / (2 * sp.pi))})


def test_four_sines_have_the_pfaffian_before_them():
    """From N = 4 on the printed pattern of single factors ends."""
    generator = np.random.default_rng(712)
    v, phases = generator.uniform(0.3, 6.0, 4), generator.uniform(0.1, 5.0, 4)
    c, s = np.cos(phases), np.sin(phases)
    V = (v[:, None] / v + v / v[:, None]) / 2
    total = np.prod(c)
    for i in range(4):
        for k in range(i + 1, 4):
            rest = [j for j in range(4) if j not in (i, k)]
            total -= V[i, k] * s[i] * s[k] * np.prod(c[rest])
    pfaffian = V[0, 1] * V[2, 3] - V[0, 2] * V[1, 3] + V[0, 3] * V[1, 2]
    found = half_trace(v**2, phases / v)
    assert total + pfaffian * np.prod(s) == pytest.approx(found, abs=1e-11)


@row("7.2 Mathieu's equation without modulation")
def nothing_grows_without_modulation(entry):
    t = sp.Symbol("t", real=True)
    d = entry.printed[1].value(i=3)
    for i in (1, 2, 3, 4):
        w = sp.sqrt(sp.nsimplify(entry.printed[1].value(i=i)))
        matrix = sp.Matrix(
            [[sp.cos(w * t), sp.sin(w * t) / w], [-w * sp.sin(w * t), sp.cos(w * t)]]
        )
        assert matrix.subs(t, sp.pi) == (-1) ** i * sp.eye(2)
    ends = sorted([float(mathieu_a(3, 0.5)), float(mathieu_b(3, 0.5))])
    quoted(ends, "9.0137", "9.0176")
    eps = entry.printed[0].value() + 1.0
    trace = 0.5 * np.trace(normalised_solutions(lambda t: d + eps * np.cos(2.0 * t), np.pi))
    assert abs(trace) < 1.0 and eps == 1.0


test_row, test_falsified_row = row.tests()
