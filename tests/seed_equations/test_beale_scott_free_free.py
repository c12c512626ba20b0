"""Beale & Scott (28)-(49): free-free modes in Buckens' frame, and the constrained equations."""

from functools import cache

import free_free_truth as truth
import mpmath
import numpy as np
import sympy as sp
from elastolink.derive.lagrange import euler_lagrange
from elastolink.derive.models import free_free_modes as ff
from elastolink.derive.models import free_free_rod as rod
from elastolink.derive.records import Lagrangian
from elastolink.runtime.systems.rod.free_free import FreeFreeModes
from seed_ledger import Ledger, hold, is_zero, quoted, same

row = Ledger("Beale & Scott", __file__)
MODES = 3
RANGE = range(1, MODES + 1)
t, L = rod._T, rod._LENGTH
m, EI, G, a_x = rod._MASS, rod._STIFFNESS, rod._CRANK, rod._FRAME
R1, R2, gamma, theta = rod._R1, rod._R2, rod._GAMMA, rod._THETA
R, ALONG, ACROSS = sp.Matrix([R1, R2]), rod._ALONG, rod._ACROSS
LAM = dict(enumerate(sp.symbols("lam_1 lam_2 lam_3"), 1))
K = {i: sp.Symbol(f"k_{i}", positive=True) for i in RANGE}
F = {i: sp.Function(f"f{i}")(t) for i in RANGE}
BLOCK = rod.place_of_block()
PIN = -L / 2


def left_value(i):
    """Return mode i at the left end: odd numbers are even about the middle."""
    return (-1) ** (i + 1) * ff.end_value()


def psi(i, order=0):
    """Return a function in the place of mode i: any will do, but for its value at the pin."""

    def value(x):
        if x == PIN and not order:
            return left_value(i) / sp.sqrt(L)
        return (sp.sin, sp.cos)[order](i * x + 1) * i**order

    return value


def u(x):
    return sum(F[i] * psi(i)(x) for i in RANGE)


NAMES = {"L": L, "m_bar": m, "EI": EI, "G": G, "a_x": a_x, "x_1": BLOCK, "theta": theta, "u": u}
NAMES |= {"k": K, "lam": LAM, "i": RANGE, "j": RANGE, "psi": {i: psi(i) for i in RANGE}}
NAMES |= {"psi_p": {i: psi(i, 1) for i in RANGE}, "f_hat_1": ALONG, "f_hat_2": ACROSS, "R_cm": R}
for _order, _dots in enumerate(("", "_dot", "_ddot")):
    NAMES["f" + _dots] = {i: F[i].diff(t, _order) for i in RANGE}
    NAMES |= {f"R{_dots}_{k}": R[k - 1].diff(t, _order) for k in (1, 2)}
    NAMES["gamma" + _dots] = gamma.diff(t, _order)


@cache
def lagrangian():
    """Return the machine's Lagrangian and constraints in the paper's coordinates.

    The machine's amplitudes are lengths over L and its modes of unit square over unit length:
    f_i here is L^(3/2) times that there, psi_i here 1 / sqrt(L) times.
    """
    ours = rod.lagrangian(MODES, tension=False)
    table = {f: f / sp.sqrt(L) ** 3 for f in F.values()}
    table |= {sp.Symbol(f"stiffness_{i}"): (K[i] * L) ** 4 for i in RANGE}
    table |= {sp.Symbol(f"left_{i}"): left_value(i) for i in RANGE}

    def printed(expression):
        found = expression.subs(table, simultaneous=True).doit()
        for i in RANGE:
            mode = sp.Function(f"psi_{i}")
            found = found.replace(mode, lambda x, i=i: sp.sqrt(L) * psi(i)(L * x - L / 2))
        return sp.expand(found)

    constraints = tuple(printed(c) for c in ours.constraints)
    return Lagrangian(ours.coordinates, t, printed(ours.expression), constraints)


@cache
def equations():
    """Return ``M qdd + c - Q - Phi_q^T lam``, a row per coordinate, in functions of time."""
    found = euler_lagrange(lagrangian())
    unknown = lagrangian().coordinates
    qdd = sp.Matrix([c.diff(t, 2) for c in unknown])
    left = found.mass * qdd + found.rest - found.forces
    left -= found.jacobian.T * sp.Matrix(found.multipliers)
    back = {sp.Symbol(c.func.__name__): c for c in unknown}
    back |= {sp.Symbol(f"{c.func.__name__}_dot"): c.diff(t) for c in unknown}
    return [row.subs(back).doit() for row in left]


def energies():
    """Return the machine's kinetic and strain energy."""
    kinetic = lagrangian().expression.subs(EI, 0)
    return kinetic, kinetic - lagrangian().expression


@row("28")
def sum_of_modes(entry):
    x = sp.Symbol("x")
    point = {"f": {i: lambda _, i=i: F[i] for i in RANGE}, "x": x, "t": t, "n": MODES}
    same(entry.printed.value(**{**NAMES, **point}), u(x))


@row("34", "35", "36", "39")
def modes_of_the_free_beam(entry):
    """By quadrature of the textbook's modes."""
    length = 1.7

    def mode(i, order):
        at = np.vectorize(lambda x: float(truth.mode(i, x / length, order)), otypes=[float])
        return lambda x: at(x) / length ** (0.5 + order)

    tables = {"psi": {i: mode(i, 0) for i in (*RANGE, 4)}, "L": length}
    tables["psi_pp"] = {i: mode(i, 2) for i in (*RANGE, 4)}
    tables["k"] = {i: float(truth.root(i)) / length for i in (*RANGE, 4)}
    delta = {(i, j): float(i == j) for i in RANGE for j in (*RANGE, 4)}
    pairs = [(i, j) for i in RANGE for j in RANGE]
    hold(entry.printed, *({**tables, "delta": delta, "i": i, "j": j} for i, j in pairs))
    if entry.label in ("35", "36"):
        # What vanishes is the integral of the mode, or of its moment, over the length.
        probe = {"Int": lambda inside, low, high, _: (high - low) * inside(0.3)}
        part = length * tables["psi"][2](0.3) * (1.0 if entry.label == "35" else 0.3)
        same(entry.printed.value(0, **tables, i=2, **probe), part)


def augmented():
    """Return the machine's Lagrangian with forces of the constraints."""
    forces = sum(LAM[j] * phi for j, phi in enumerate(lagrangian().constraints, 1))
    return lagrangian().expression + forces


@row("29")
def augmented_lagrangian(entry):
    kinetic, strain = energies()
    constraints = dict(enumerate(lagrangian().constraints, 1))
    point = {"T": kinetic, "V": strain, "lam": LAM, "Phi": constraints, "m": 3}
    same(entry.printed.value(**point), augmented())


@row("30", "31")
def multipliers(entry):
    """Its Euler-Lagrange equations are those of the machine, with the constraints."""
    if entry.label == "31":
        phi = dict(enumerate(lagrangian().constraints, 1))
        for j in phi:
            names = {"Lambda": augmented(), "lam_j": LAM[j], "Phi": phi, "j": j}
            ((one, other, zero),) = entry.printed.sides(**names)
            same(one, other)
            assert zero == 0
        return
    for q, motion in zip(lagrangian().coordinates, equations(), strict=True):
        by = {"q_dot_i": q.diff(t), "q_i": q, "t": t}
        rate = {"D": lambda value, name, _, by=by: sp.diff(value, by[name])}
        ((left, right),) = entry.printed.sides(Lambda=augmented(), **by, **rate)
        same(left - right, motion)


@row("32")
def foreshortening(entry):
    """What is printed is the place without it; its share by the machine and by quadrature."""
    x, field = sp.symbols("x u")
    unit = {"i_hat": sp.Matrix([1, 0]), "j_hat": sp.Matrix([0, 1]), "x": x, "u": field}
    same(entry.printed.value(**{**NAMES, **unit}), R + x * ALONG + field * ACROSS)
    parts = FreeFreeModes(1).slope_integrals
    inward, retreat = (float(parts[name][0, 0]) for name in ("inward", "retreat"))
    quoted([-2 * inward, retreat], "3.05", "12.37")
    turning = 900.0 * 0.2 / (1 - 0.2)  # where the block is nearest to the pin
    elastic = 0.7e11 * 0.5208e-6 * float(truth.root(1)) ** 4
    quoted(7.15 * turning**2 * -2 * inward / elastic, "0.060")


X = sp.Symbol("_x", real=True)


@row("33")
def kinetic_energy(entry):
    """Against the velocity of every point: the density times the length, as if it were constant."""
    field = sp.Function("u")(t)
    velocity = (R + X * ALONG + field * ACROSS).diff(t)
    point = {"u": field, "u_dot": field.diff(t)}
    point["Int"] = lambda inside, low, high, _: (high - low) * inside(X)
    same(entry.printed.value(**{**NAMES, **point}), m * L * velocity.dot(velocity) / 2)


@row("37", "40")
def energies_of_the_modes(entry):
    same(entry.printed.value(**NAMES), energies()[entry.label == "40"])


@row("38")
def strain_energy(entry):
    """Held at one end and bent by a force P at the other: half P times its way."""
    s, P = X + L / 2, sp.Symbol("P")
    bent = P * s**2 * (3 * L - s) / (6 * EI)
    same(entry.printed.value(**{**NAMES, "u": bent}), P / 2 * bent.subs(X, L / 2))


# The pin holds the end of the rod; the block is where the rod crosses the crank's end.
PINNED = L / 2 * ALONG - u(PIN) * ACROSS


def crossing(x):
    """Return the deflection, at the block that which lets the loop close."""
    turn = G * sp.sin(gamma - theta) + a_x * sp.sin(gamma)
    return u(PIN) - turn if x == BLOCK - L / 2 else u(x)


@row("41", "44")
def loops(entry):
    unit = {"i_hat": sp.Matrix([1, 0]), "j_hat": sp.Matrix([0, 1])}
    point = {**NAMES, **unit, "R_cm": PINNED, "u": crossing}
    ((left, right),) = entry.printed.sides(**point)
    assert is_zero(left)
    assert right == 0
    same(BLOCK, G * sp.cos(gamma - theta) + a_x * sp.cos(gamma))


@row("42", "43", "45")
def constraints(entry):
    number = {"42": 1, "43": 2, "45": 3}[entry.label]
    ours = lagrangian().constraints[number - 1]
    ((one, other, zero),) = entry.printed.sides(**NAMES, **{f"Phi_{number}": ours})
    same(one, other)
    assert zero == 0
    if number < 3:
        assert is_zero(other.subs(dict(zip(R, PINNED, strict=True))))


def residual(form, **more):
    ((left, right),) = form.sides(**{**NAMES, **more})
    return left - right


@row("46", "47", "48")
def motion_of_the_frame(entry):
    same(residual(entry.printed), equations()[int(entry.label) - 46])


@row("49")
def motion_of_the_modes(entry):
    for i, motion in zip(RANGE, equations()[3:], strict=True):
        same(residual(entry.corrected, i=i), motion)
        same(residual(entry.printed, i=i, x_i=BLOCK), motion)
    place = 0.59997 * (1 + 0.01**2) ** 0.5  # of the block, the crank across the frame
    quoted([truth.mode(1, mpmath.mpf(at - 0.5)) for at in (place, 1.0)], "-1.04", "2.00")


test_row, test_falsified_row = row.tests()
