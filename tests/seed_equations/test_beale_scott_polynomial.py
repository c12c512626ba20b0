"""Beale & Scott (12)-(15), (17)-(27): the polynomial modes and the matrices printed for them.

Only the modes and what each matrix is an integral of enter; powers are integrated term by term,
exactly.
"""

from fractions import Fraction
from functools import cache

import numpy as np
import sympy as sp
from elastolink.derive.lagrange import euler_lagrange
from elastolink.derive.records import Lagrangian
from seed_ledger import Ledger, quoted, same

row = Ledger("Beale & Scott", __file__)
RANGE = range(1, 6)
PAIRS = [(m, n) for m in RANGE for n in RANGE]
x, x1, L = sp.symbols("x x_1 L", positive=True)
v1, a1 = sp.symbols("v1 a1", real=True)
t = sp.Symbol("t", real=True)
block, phi = sp.Function("block")(t), sp.Function("phi")(t)
mass, stiffness = sp.symbols("m EI", positive=True)


def mode(n):
    """Return mode n on both sides of the block."""
    return x**n * (x - x1), x1 * x ** (n - 1) * (x - x1)


def rate(expression):
    """Differentiate by time; x_1 and its velocity move."""
    return sp.diff(expression, x1) * v1 + sp.diff(expression, v1) * a1


@cache
def gamma(kind, m, n=1):
    """Return one entry of a matrix of (18), or of its right-hand side for kind 5."""
    total = sp.S.Zero
    for (lower, upper), one, other in zip(((0, x1), (x1, L)), mode(m), mode(n), strict=True):
        density = {1: one * other, 2: one * rate(other), 3: one * rate(rate(other)), 5: x * one}
        density[4] = sp.diff(one, x, 2) * sp.diff(other, x, 2)
        total += sp.integrate(sp.expand(density[kind]), (x, lower, upper))
    return sp.expand(total)


@row("12", "13", "14")
def modes_satisfy_the_essential_conditions(entry):
    """Value, slope and rate in time are continuous; the curvature is not."""
    for n in RANGE if entry.label == "14" else [int(entry.label) - 11]:
        table = {(m, side): mode(m)[side - 1] for m in (*RANGE, 6) for side in (1, 2)}
        found = entry.printed.sides(x=x, x_1=x1, n=n, phi=table)
        bay, beyond = (form for _, form in found)
        assert bay.subs(x, 0) == bay.subs(x, x1) == beyond.subs(x, x1) == 0
        assert sp.simplify(sp.diff(bay - beyond, x).subs(x, x1)) == 0
        assert sp.simplify(sp.diff(bay - beyond, x1).subs(x, x1)) == 0
        jump = sp.diff(beyond - bay, x, 2).subs(x, x1)
        assert sp.simplify(jump + 2 / x1 * sp.diff(bay, x).subs(x, x1)) == 0
        for (name, form), right in zip(found, mode(n), strict=True):
            assert name == right
            same(form, right)
    powers = [[sp.Poly(mode(n)[0], x).coeff_monomial(x**k) for k in range(7)] for n in RANGE]
    assert sp.Matrix(powers).rank() == len(RANGE)


F = [sp.Function(f"f{n}")(t) for n in (1, 2)]
RATES = {
    name: dict(enumerate(sp.symbols(f"{name}1 {name}2"), 1)) for name in ("f", "f_dot", "f_ddot")
}
TURN, SWING = sp.symbols("phi_dot phi_ddot")
# Functions of time by symbols, the highest rates first.
PLAIN = [(phi.diff(t, 2), SWING), (phi.diff(t), TURN)]
PLAIN += [(block.diff(t, 2), a1), (block.diff(t), v1), (block, x1)]
PLAIN += [
    (f.diff(t, order), RATES[name][n])
    for order, name in ((2, "f_ddot"), (1, "f_dot"), (0, "f"))
    for n, f in enumerate(F, 1)
]
SHAPES = {(n, side): mode(n)[side - 1].subs(x1, block) for n in (1, 2) for side in (1, 2)}


def trial(side):
    return sum(F[n - 1] * SHAPES[n, side] for n in (1, 2))


@cache
def lagrangian():
    """Return (16) with (17), integrated exactly."""
    total = sp.S.Zero
    for v, lower, upper in ((trial(1), 0, x1), (trial(2), x1, L)):
        turn = phi.diff(t)
        speed = v.diff(t) ** 2 + 2 * x * v.diff(t) * turn + (x**2 + v**2) * turn**2
        density = sp.expand(mass / 2 * speed - stiffness / 2 * sp.diff(v, x, 2) ** 2)
        for (power,), factor in sp.Poly(density, x).all_terms():
            total += factor * sp.integrate(x**power, (x, lower, upper)).subs(x1, block)
    return total


@cache
def of_two_modes():
    """Return the left sides of the equations of motion of two modes."""
    found = euler_lagrange(Lagrangian(tuple(F), t, lagrangian()))
    rest = dict(zip(found.coordinates, RATES["f"].values(), strict=True))
    rest |= dict(zip(found.velocities, RATES["f_dot"].values(), strict=True))
    ours = found.mass * sp.Matrix(list(RATES["f_ddot"].values())) + found.rest.subs(rest)
    return [row.subs(PLAIN) for row in ours]


@row("15", slow=True)
def lagrange_equation(entry):
    f, motion = F[1], of_two_modes()[1]
    by = {"f_dot_i": f.diff(t), "f_i": f, "t": t}
    rates = {"D": lambda value, name, _: sp.diff(value, by[name])}
    ((left, right),) = entry.printed.sides(Lag=lagrangian(), **by, **rates)
    same((left - right).doit().subs(PLAIN), motion)


@row("17")
def trial_solution(entry):
    given = entry.printed.values(f=dict(enumerate(F, 1)), phi=SHAPES, i=(1, 2))
    assert [given["v_T1"], given["v_T2"]] == [trial(1), trial(2)]


@row("18")
def equations_of_motion(entry):
    """Euler-Lagrange on the exact Lagrangian of two modes, against the matrices' definitions."""
    table = {(k, m, n): gamma(k, m, n) for k in (1, 2, 3, 4) for m in (1, 2) for n in (1, 2)}
    table |= {(5, m): gamma(5, m) for m in (1, 2)}
    point = {**RATES, "Gamma": table, "phi_dot": TURN, "phi_ddot": SWING}
    for i, motion in enumerate(of_two_modes(), 1):
        ((left, right),) = entry.printed.sides(**point, m_bar=mass, EI=stiffness, i=i, j=(1, 2))
        same(left - right, motion)


class Whole(Fraction):
    """A fraction with the rule that a term of prefactor zero is dropped: 0/0 is 0."""


def _whole(name):
    plain = getattr(Fraction, name)

    def operation(one, other):
        zero = one == 0 == other and name.endswith("truediv__")
        return Whole(0 if zero else plain(one, other))

    setattr(Whole, name, operation)


for _name in ("add", "sub", "mul", "truediv", "pow"):
    _whole(f"__{_name}__")
    _whole(f"__r{_name}__")


def at_indices(kind, pairs=PAIRS):
    """Yield the derived entry of one matrix and the numbers for every pair of indices, exactly."""
    values = {x1: Whole(13, 10), L: Whole(19, 10), v1: Whole(3, 5), a1: Whole(-2)}
    names = {"x_1": values[x1], "L": values[L], "x_dot_1": values[v1], "x_ddot_1": values[a1]}
    exact = {symbol: sp.Rational(value) for symbol, value in values.items()}
    for i, j in pairs:
        label = (kind, i) if kind == 5 else (kind, i, j)
        entry = {label: Fraction(str(gamma(*label).subs(exact)))}
        yield {**names, "Gamma": entry, "i": Whole(i), "j": Whole(j)}


def exactly(form, kind, pairs=PAIRS, slip=lambda _: 0):
    """Return whether a printed entry is the derived one, but for a slip, for all pairs."""
    found = ((*form.sides(**point)[0], slip(point)) for point in at_indices(kind, pairs))
    return all(left + wrong == right for left, right, wrong in found)


@row("20", "21")
def drift_and_second_rates(entry):
    assert exactly(entry.printed, 2 if entry.label == "20" else 3)
    for m, n in PAIRS:
        # The symmetric part of the drift is half the rate of the inertia: nothing is lost.
        both = gamma(2, m, n) + gamma(2, n, m)
        assert sp.expand(both - sp.diff(gamma(1, m, n), x1) * v1) == 0


@row("19")
def inertia(entry):
    def denominator(p):
        a = p["i"] + p["j"]
        return p["x_1"] ** (a + 3) * (1 / (a + 3) - 1 / (a + 1))

    assert exactly(entry.corrected, 1)
    assert exactly(entry.printed, 1, slip=denominator)
    at = {"x_1": 0.6, "L": 1.0}
    wrong, right = (
        np.linalg.eigvalsh([[form.value(**at, i=i, j=j) for i in (1, 2, 3)] for j in (1, 2, 3)])
        for form in (entry.printed, entry.corrected)
    )
    quoted(wrong, "-3.18e-3", "-6.43e-6", "1.30e-2")
    quoted(right, "1.04e-5", "9.53e-4", "2.11e-2")
    # Up to the block alone: no rod beyond it.
    wrong, right = (form.value(x_1=1, L=1, i=1, j=1) for form in (entry.printed, entry.corrected))
    quoted([wrong, 1 / right], "-0.1", "30")


@row("22", "23", "24", "25")
def special_entries_of_the_stiffness(entry):
    """What is wrong is the dimension alone: length^(i + j - 1) is due."""
    pairs = {"22": [(1, 1)], "23": [(1, n) for n in RANGE[1:]]}
    pairs |= {"24": [(n, 1) for n in RANGE[1:]], "25": [(2, 2)]}
    assert exactly(entry.corrected, 4, pairs[entry.label])
    for point in at_indices(4, pairs[entry.label]):
        ((right, wrong),) = entry.printed.sides(**point)
        assert wrong * point["L"] ** (point["i"] + point["j"] + 2) == right
    wrong, right = (form.value(x_1=1, L=2, i=2, j=2) for form in (entry.printed, entry.corrected))
    quoted([1 / wrong, right], *{"22": ("4", "4"), "25": ("8", "8")}.get(entry.label, ("16", "2")))


@row("26")
def stiffness_matrix(entry):
    def denominator(p):
        a, both = p["i"] + p["j"], p["i"] * p["j"]
        return both * p["x_1"] ** (a - 1) * (both + a + 1) * (1 / (a + 1) - 1 / (a - 1))

    assert exactly(entry.corrected, 4)
    assert exactly(entry.printed, 4, slip=denominator)
    point = {"x_1": Whole(3, 5), "L": Whole(1), "i": Whole(2), "j": Whole(3)}
    wrong, right = (form.value(**point) for form in (entry.printed, entry.corrected))
    quoted([float(wrong), float(right)], "0.778", "1.555")
    # The last bracket as it stands, without the rule.
    whole = {name: sp.Rational(value) for name, value in point.items()}
    assert entry.printed.value(**whole) is sp.nan


@row("27")
def forcing(entry):
    def powers(p):
        i, x_1, high = p["i"], p["x_1"], p["L"] ** (p["i"] + 1)
        last = (high - i + 1) / (i + 2) - (high - x_1 ** (i + 1)) / (i + 1)
        return x_1 * (x_1 ** (i + 2) - i + 2) / (i + 2) - x_1**2 * last

    singles = [(n, 1) for n in RANGE]
    assert exactly(entry.corrected, 5, singles)
    assert exactly(entry.printed, 5, singles, slip=powers)
    at = {"x_1": 0.6, "L": 1.0, "i": 1}
    quoted([entry.printed.value(**at), entry.corrected.value(**at)], "0.269", "0.031")


test_row, test_falsified_row = row.tests()
