"""Aannaque (6.1)-(6.11): Taylor's formula, Newmark's scheme, its consistency and stability."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from seed_ledger import Ledger, hold, holds, quoted, same, truths

row = Ledger("Aannaque", __file__)
h, tau = sp.Symbol("h", positive=True), sp.Symbol("tau", real=True)
g, b, damping, phase = sp.symbols("gamma beta zeta x", real=True)
old, new, third = sp.symbols("a_k a_{k+1} q^{(3)}", real=True)
half = sp.Rational(1, 2)


@row("6.1")
def taylors_formula(entry):
    for f in (sp.exp(2 * tau), tau**5, sp.sin(tau)):
        for s in (0, 1, 2):
            derivatives = {k: f.diff(tau, k).subs(tau, 1) for k in range(s + 1)}
            point = {"t_k": sp.Integer(1), "dt": h, "s": sp.Integer(s), "fact": sp.factorial}
            point |= {"f": lambda at, f=f: f.subs(tau, at), "f_d": derivatives, "tau": tau}
            point |= {"f_s1": lambda at, f=f, s=s: f.diff(tau, s + 1).subs(tau, at)}
            hold(entry.printed, point)


@row("6.2")
def velocity_and_displacement(entry):
    for q in (tau**3, sp.sin(tau) + tau**4):
        names = {f"q_{'dot' * (k == 1)}{'ddot' * (k == 2)}": k for k in (1, 2)}
        functions = {k: lambda at, n=n, q=q: q.diff(tau, n).subs(tau, at) for k, n in names.items()}
        ends = {"t_k": sp.Integer(1), "t_k1": 1 + h, "dt": h}
        for name, n in {"q": 0, "q_dot": 1}.items():
            ends |= {
                f"{name}_k": q.diff(tau, n).subs(tau, 1),
                f"{name}_k1": q.diff(tau, n).subs(tau, 1 + h),
            }
        hold(entry.corrected, {**functions, **ends})
        hold(entry.printed[0], {**functions, **ends})
        if q == tau**3:
            step = {
                k: sp.sympify(v).subs(h, 1) if not callable(v) else v
                for k, v in (functions | ends).items()
            }
            right, printed = entry.printed.sides(**step)[1]
            assert (right, printed) == (8, sp.Rational(27, 4))


@cache
def interpolated(part):
    """Return the acceleration at tau from both ends, ``part`` of the new one (6.3).

    Taylor's series of the ends about tau, to the third derivative, is weighed so that the
    acceleration at tau has the weight 1; the step runs from 0 to h.
    """
    here = sp.Symbol("a_here", real=True)
    series = [here + third * (end - tau) for end in (sp.S.Zero, h)]
    total = (1 - part) * (series[0] - old) + part * (series[1] - new)
    return sp.expand(sp.solve(total, here)[0])


@cache
def weights(kernel, part):
    """Return an integral of the acceleration over a step by its ends, and what is beyond them."""
    whole = sp.expand(sp.integrate(sp.expand(kernel * interpolated(part)), (tau, 0, h)))
    return sp.collect(whole.subs(third, 0), [old, new]), sp.factor(whole.coeff(third)) * third


def velocity_weights():
    return weights(sp.S.One, g)


def displacement_weights():
    return weights(h - tau, 2 * b)


@row("6.3")
def acceleration_of_the_ends(entry):
    """Exact for a motion of fourth degree."""
    q = 3 * tau**4 - tau**3 + 2 * tau**2
    names = {"t_k": sp.Integer(2), "tau": tau, "q3": q.diff(tau, 3), "q4": q.diff(tau, 4)}
    accelerations = {
        "q_ddot_k": q.diff(tau, 2).subs(tau, 2),
        "q_ddot": lambda at: q.diff(tau, 2).subs(tau, at),
    }
    hold(entry.printed, {**names, **accelerations})


def ends():
    """Return the letters of 6.2.1 for a step, the integrals by their weights."""
    names = {"gamma": g, "beta": b, "dt": h, "q_ddot_k": old, "q_ddot_k1": new, "q3": third}
    (velocity, r), (place, r_p) = velocity_weights(), displacement_weights()
    return {**names, "I_v": velocity + r, "I_q": place + r_p, "r_k": r, "r_k_p": r_p}


row(
    "6.4",
    derived=lambda: sp.latex(displacement_weights()[0]),
    check=lambda e: hold(e.printed, ends()),
)


@row("6.2.1 remainders of Newmark's scheme", derived=lambda: sp.latex(velocity_weights()[1]))
def remainders(entry):
    turned = {**ends(), "r_k": -ends()["r_k"], "r_k_p": -ends()["r_k_p"]}
    hold(entry.printed, turned)
    # q'' = t: 1/2 exactly.
    unit = {old: 0, new: 1, third: 1, h: 1, g: 1}
    assert [part.subs(unit) for part in velocity_weights()] == [1, -half]
    assert entry.printed.values(gamma=1, beta=0, dt=1, q3=1)["r_k"] == 0.5


@cache
def constant(seed=5, n=3):
    """Return a march of Newmark's scheme, gamma = 1/2, with constant matrices."""
    random = np.random.default_rng(seed)
    m, c, k = random.normal(size=(3, n, n))
    M, K, C = m @ m.T + n * np.eye(n), k @ k.T + n * np.eye(n), 0.3 * (c + c.T) + np.eye(n)
    f = random.normal(size=(4, n))
    q, v, a = march(
        0.5, 0.21, 0.2, [M] * 4, C, K, f, np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.4, -0.3])
    )
    return {"M": M, "C": C, "K": K, "f": f, "q": q, "v": v, "a": a}


def march(gamma, beta, step, masses, rate, stiffness, force, q, v):
    """Return displacements, velocities and accelerations: unknown is the new acceleration."""
    a = np.linalg.solve(masses[0], force[0] - rate @ v - stiffness @ q)
    found = [(q, v, a)]
    for mass, load in zip(masses[1:], force[1:], strict=True):
        q_guess = q + step * v + step**2 * (0.5 - beta) * a
        v_guess = v + step * (1 - gamma) * a
        left = mass + gamma * step * rate + beta * step**2 * stiffness
        a = np.linalg.solve(left, load - rate @ v_guess - stiffness @ q_guess)
        q, v = q_guess + beta * step**2 * a, v_guess + gamma * step * a
        found.append((q, v, a))
    return (np.array(part) for part in zip(*found, strict=True))


@row("6.5")
def scheme(entry):
    """The weights without their remainders."""
    names = {**ends(), "q_k": sp.Symbol("q"), "q_dot_k": sp.Symbol("v")}
    names |= {"q_dot_k1": sp.Symbol("v") + velocity_weights()[0]}
    names |= {"q_k1": sp.Symbol("q") + h * sp.Symbol("v") + displacement_weights()[0]}
    hold(entry.printed, names)


@row("6.6")
def recurrence_for_constant_matrices(entry):
    p = constant()
    named = {"M": p["M"], "C": p["C"], "K": p["K"], "beta": 0.21, "dt": 0.2, "E": np.eye(3)}
    start = {
        "q0": p["q"][0],
        "q1": p["q"][1],
        "q0_dot": p["v"][0],
        "f0": p["f"][0],
        "f1": p["f"][1],
    }
    for k in (1, 2):
        around = {
            f"{x}_k{s}": p[x][k + n] for x in "qf" for s, n in (("", 0), ("1", 1), ("m1", -1))
        }
        hold(entry.printed, {**named, **start, **around}, tol=1e-10)
    # One freedom whose mass grows: M q'' + M' q' + q = 1.
    one, push = np.ones((1, 1)), np.ones((3, 1))
    q, v = np.zeros(3), np.zeros(3)
    q[0], v[0], step = 0.0, 1.0, 0.5
    masses = [1.0, 1.2, 1.4, 1.5]
    # The step's own matrices at its end: M and M' by differences are left out as in the scheme.
    for k in range(2):
        a = (1.0 - q[k]) / masses[k]
        m = masses[k + 1]
        new_a = (1.0 - q[k] - step * v[k] - step**2 / 4 * a) / (m + step**2 / 4)
        q[k + 1] = q[k] + step * v[k] + step**2 / 4 * (a + new_a)
        v[k + 1] = v[k] + step / 2 * (a + new_a)
    single = {"M": 1.4 * one, "C": 0 * one, "K": one, "beta": 0.25, "dt": 0.5, "f_k": push[1]}
    single |= {"f_k1": push[2], "f_km1": push[0], "q_k": q[1:2], "q_km1": q[:1]}
    left, right = entry.printed[:4].sides(**single, q_k1=q[2:])[0]
    missed = abs(right[0] / left[0] - 1.0)
    assert missed == pytest.approx(0.018, abs=5e-4), missed


@cache
def amplification():
    """Return the matrix of a step on (q, h q') of ``q'' + 2 zeta omega q' + omega^2 q = 0``.

    ``x`` is omega h.
    """
    q, v, q_new, v_new = sp.symbols("q v q_new v_new", real=True)
    # v is h q', and accelerations carry h^2.
    values = {
        old: -(2 * damping * phase * v + phase**2 * q) / h**2,
        new: -(2 * damping * phase * v_new + phase**2 * q_new) / h**2,
    }
    carried = velocity_weights()[0].subs(values) * h
    moved = displacement_weights()[0].subs(values)
    found = sp.solve([v_new - v - carried, q_new - q - v - moved], [q_new, v_new], dict=True)[0]
    rows = [sp.cancel(sp.together(found[end])) for end in (q_new, v_new)]
    return sp.Matrix([[sp.cancel(line.diff(x)) for x in (q, v)] for line in rows])


@cache
def _step():
    return sp.lambdify((g, b, damping, phase), amplification())


@row("6.7")
def consistency(entry):
    """The increments over a short step."""
    omega, dt = 2.3, 1e-5
    matrix = np.array(_step()(0.5, 0.25, 0.0, omega * dt), dtype=float)
    q, v = 0.7, -0.4
    q_new, moved = matrix @ [q, dt * v]
    point = {"y_k1": np.array([moved / dt, q_new]), "y_k": np.array([v, q]), "dt": dt}
    point |= {"q_ddot_k": -(omega**2) * q, "q_dot_k": v}
    np.testing.assert_allclose(*entry.printed.sides(**point)[0], rtol=1e-3)


@row("6.8")
def sum_of_the_loads(entry):
    """There is no step into the start."""
    state, k, loads = 1.0, 3, {0: 0.9, 1: 1.3, 2: 0.7, 3: -0.4, 4: 0.5}
    for j in range(1, k + 2):
        state = 0.5 * state + loads[j]
    point = {"B": 0.5, "k": k, "y_0": 1.0, "g": loads}
    hold(entry.corrected, {**point, "y_k1": state})
    same(entry.printed.values(**point)["y_k1"] - state, 0.5 ** (k + 1) * loads[0])
    ones = {"B": 0.5, "k": 0, "y_0": 1.0, "g": dict.fromkeys(range(2), 1.0)}
    forms = (entry.corrected, entry.printed)
    assert [form.values(**ones)["y_k1"] for form in forms] == [1.5, 2.0]


@cache
def steps():
    """Return undamped steps: the matrix on (q, q'), its eigenvalues, modulus and angle."""
    points = []
    for gamma, beta, omega, dt in (
        (0.5, 0.21, 1.7, 0.6),
        (0.7, 0.4, 2.1, 0.4),
        (0.55, 0.3, 1.2, 0.9),
    ):
        matrix = np.array(_step()(gamma, beta, 0.0, omega * dt), dtype=float)
        B = np.diag([1, 1 / dt]) @ matrix @ np.diag([1, dt])
        for root in np.linalg.eigvals(B):
            point = {"gamma": gamma, "beta": beta, "omega": omega, "dt": dt, "B": B, "lam": root}
            point |= {"mu": omega * dt / np.sqrt(1 + beta * (omega * dt) ** 2)}
            points.append({**point, "rho": abs(root), "theta": abs(np.angle(root))})
    return points


row(
    "6.9",
    derived=lambda: sp.latex(amplification().subs(damping, 0)),
    check=lambda e: hold(e.printed, steps),
)
row("6.10", "6.2.3 modulus and angle of the multiplier", check=holds(steps))


@row("6.11")
def pair_of_multipliers(entry):
    """The condition holds exactly where the multipliers are no two real ones."""
    seen = set()
    for gamma, beta in ((0.5, 0.1), (0.9, 0.3), (0.6, 0.25)):
        for x in np.linspace(0.1, 12.0, 60):
            roots = np.linalg.eigvals(np.array(_step()(gamma, beta, 0.0, x), dtype=float))
            pair = bool(np.abs(roots.imag).max() > 1e-9)
            seen.add(pair)
            assert truths(entry.printed, gamma=gamma, beta=beta, omega=2.0, dt=x / 2) == [pair]
    assert seen == {True, False}


def limit(gamma, beta, zeta=0.0):
    """Return the largest phase up to which all steps are stable; inf beyond 1e4."""

    def stable(x):
        roots = np.linalg.eigvals(np.array(_step()(gamma, beta, zeta, x), dtype=float))
        return np.abs(roots).max() <= 1 + 1e-7 * (1 if x > 0.1 else x)

    phases = np.geomspace(1e-3, 1e4, 300)
    unstable = [k for k, x in enumerate(phases) if not stable(x)]
    if not unstable:
        return np.inf
    if unstable[0] == 0:
        return 0.0
    low, high = phases[unstable[0] - 1], phases[unstable[0]]
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low


@row("6.2.3 unconditional stability")
def unconditional_stability(entry):
    """Both forms are enough; below the corrected one long steps are unstable."""
    for gamma in (0.5, 0.9, 1.3):
        for beta in np.array([0.98, 1.02]) * gamma / 2:
            assert all(truths(entry.corrected, gamma=gamma, beta=beta)) == np.isinf(
                limit(gamma, beta)
            )
        for factor in (0.999, 1.001):
            beta = factor * 0.25 * (gamma + 0.5) ** 2
            assert all(truths(entry.printed, gamma=gamma, beta=beta)) == (factor > 1)
    for form in (entry.printed, entry.corrected):
        assert truths(form, gamma=0.499, beta=9.0) == [False, True] and limit(0.499, 9.0) < np.inf
        assert truths(form, gamma=0.501, beta=9.0) == [True, True]
    assert np.isinf(limit(0.9, 0.46))
    quoted([entry.printed.sides(gamma=0.9, beta=0)[1][1], limit(0.9, 0.44)], "0.49", "10.0")


@row("6.2.3 damping and the limits of stability")
def damping_and_the_limits(_):
    ratios = np.linspace(0.0, 1.0, 41)
    limits = [limit(0.4, 0.1, zeta) for zeta in ratios]
    best = int(np.argmax(limits))
    assert limits[0] == 0.0 and limits[best] == pytest.approx(3.01, abs=0.01)
    assert ratios[best] == pytest.approx(0.15, abs=0.03) and limits[-1] < limits[best]
    np.testing.assert_allclose([limit(0.5, 0.1, zeta) for zeta in (0.1, 0.7)], limit(0.5, 0.1))


test_row, test_falsified_row = row.tests()
