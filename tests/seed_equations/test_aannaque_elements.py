"""Aannaque (4.1)-(4.14) and appendix A: shape functions, strain energy, matrices of elements."""

from functools import cache

import numpy as np
import pytest
import scipy.linalg
import sympy as sp
from elastolink.derive.models import beam_elements as elements
from elastolink.derive.models.beam_shapes import t, u, v
from elastolink.derive.variational import hamilton
from seed_elements import EA, EI, L, arrays, letters, rho, shape_rows, x, zeta
from seed_ledger import Ledger, hold, holds, point_by_point, quoted, same

row = Ledger("Aannaque", __file__)
AXIAL, BENT = slice(0, 2), slice(2, 6)
SIZES = {L: 0.7, EA: 1.9, EI: 2.3, rho: 1.1}
LENGTH = SIZES[L]


@cache
def derived(kind):
    """Return the derived matrices in numbers, and the rows of shapes as functions of the place.

    ``("v", 2)`` is the second derivative by x of the row of v.
    """
    forms = arrays(kind)
    numbers = {k: np.array(forms[k].subs(SIZES), dtype=float) for k in ("mass", "stiffness")}
    for name, part in zip("uv", shape_rows(kind), strict=True):
        for order in range(3):
            form = part.diff(zeta, order) / L**order if order else part
            function = sp.lambdify(zeta, form.subs(SIZES))
            numbers[name, order] = lambda s, f=function: np.array(f(s / LENGTH), dtype=float)
    return numbers


@cache
def cubic():
    """Return places of a beam in the document's letters, for free nodal values."""
    d, q = derived("cubic"), np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.7])
    stiffness = d["stiffness"]
    common = {
        "u_x": lambda s: (d["u", 1](s) @ q)[0],
        "v": lambda s: (d["v", 0](s) @ q)[0],
        "v_xx": lambda s: (d["v", 2](s) @ q)[0],
        "B1": lambda s: d["u", 1](s)[:, AXIAL],
        "B2": lambda s: d["v", 2](s)[:, BENT],
        "N2": lambda s: d["v", 0](s)[:, BENT],
        "N2_pp": lambda s: d["v", 2](s)[:, BENT],
        **{"K": stiffness, "K1": stiffness[AXIAL, AXIAL], "K2": stiffness[BENT, BENT]},
        **{"q1": q[AXIAL], "q2": q[BENT], "U_int": q @ stiffness @ q / 2, "Int": point_by_point},
        **{"L": LENGTH, "EA": SIZES[EA], "EI_z": SIZES[EI]},
    }
    return [
        {**common, "x": s, "u": (d["u", 0](s) @ q)[0], "eps": (d["u", 1](s) @ q)[0]}
        for s in (0.1, 0.45)
    ]


def polynomial(count, item, first=1):
    """Return the check of a polynomial: determined by the nodal values, and a solution at rest."""

    def check(entry):
        a = sp.symbols(f"a{first}:{first + count}")
        names = {f"a{k}": c for k, c in enumerate(a, first)} | {"a": dict(enumerate(a, 1))}
        trial = entry.printed.value(**names, n=sp.Integer(count), x=x)
        same(trial, sum(c * x**k for k, c in enumerate(a)))
        ends = [sp.diff(trial, x, k).subs(x, e * L) for e in (0, 1) for k in range(count // 2)]
        assert sp.simplify(sp.Matrix(ends).jacobian(a).det()) != 0
        still = {elements.turn: 0, **dict.fromkeys((*elements.forces, *elements.loads), 0)}
        values = {u: trial, v: 0} if item is u else {u: 0, v: trial}
        equation = hamilton(elements.beam_action("cubic")).equations[item]
        assert sp.expand(equation.subs(values).doit().subs(still).doit()) == 0

    return check


def shapes(kind, columns=slice(None), order=0):
    """Return the check of printed shapes or their second derivatives, functions of zeta."""

    def check(entry):
        for s in (0.1, 0.3, 0.85):
            true = derived(kind)["v", order](s * LENGTH)[0, columns] * LENGTH**order
            same(np.ravel(entry.printed.value(L=LENGTH, zeta=s, xi=s, N_T=0, B_T=0)), true, 1e-9)

    return check


def latex_of(kind, name, rows=slice(None), columns=slice(None)):
    """Return what shows a derived matrix."""
    return lambda: letters(arrays(kind)[name][rows, columns])


row("4.1", "4.2", check=polynomial(2, u))
row("4.5", check=polynomial(4, v, first=3))
row(
    "4.3",
    derived=lambda: letters(shape_rows("cubic")[0][:, AXIAL]),
    check=lambda entry: hold(entry.printed, cubic),
)


@row("4.4", derived=lambda: letters(shape_rows("cubic")[0][:, AXIAL].diff(zeta) / L))
def strain(entry):
    hold(entry.printed, *({k: v for k, v in p.items() if k != "B1"} for p in cubic()))


row("4.6", "4.8", "4.9", "4.11", "4.14", check=holds(cubic))


@row("4.10")
def curvature(entry):
    there = [{**p, **{k: p[k](p["x"]) for k in ("B2", "v_xx")}} for p in cubic()]
    hold(entry.printed, *there)


row(
    "4.2.1 cubic shape functions",
    derived=lambda: letters(shape_rows("cubic")[1][:, BENT]),
    check=shapes("cubic", BENT),
)


@row("4.7")
def hamiltons_principle(_):
    """A frame at rest, no axial force: the wave equation and the beam equation with loads."""
    found = hamilton(elements.beam_action("cubic")).equations
    rest = {elements.turn: 0, **dict.fromkeys(elements.forces, 0)}
    s, loads = x / L, dict(zip(("px1", "px2", "py1", "py2"), elements.loads, strict=True))
    rod = EA * u.diff(x, 2) - rho * u.diff(t, 2) + loads["px1"] * (1 - s) + loads["px2"] * s
    beam = -EI * v.diff(x, 4) - rho * v.diff(t, 2) + loads["py1"] * (1 - s) + loads["py2"] * s
    assert sp.simplify(found[u].subs(rest).doit() - rod) == 0
    assert sp.simplify(found[v].subs(rest).doit() - beam) == 0


@row("4.12", derived=latex_of("cubic", "stiffness", AXIAL, AXIAL))
def lost_denominator(entry):
    hold(entry.printed, *({**point, "hole": LENGTH} for point in cubic()))


row(
    "4.13",
    derived=latex_of("cubic", "stiffness", BENT, BENT),
    check=lambda entry: hold(entry.printed, cubic),
)

# Appendix A: the elements of the p-version.


def matrix(entry):
    """Return a printed matrix at the sizes of the test."""
    return entry.printed.value(L=LENGTH, rhoA=SIZES[rho], EI=SIZES[EI])


row(
    "A.1",
    derived=lambda: letters(shape_rows("internal_node")[1]),
    check=shapes("internal_node"),
)


@row("A.2")
def strains_by_zeta(entry):
    shapes("internal_node", order=2)(entry)
    quoted([0.328**-2], "9.3")


@row("A.3", derived=latex_of("internal_node", "mass"))
def mass_with_an_inner_node(entry):
    same(matrix(entry), derived("internal_node")["mass"], 1e-9)


@row("A.4")
def stiffness_with_an_inner_node(entry):
    true, printed = derived("internal_node")["stiffness"], matrix(entry)
    wrong = np.argwhere(np.abs(printed - true) > 1e-9 * np.abs(true).max())
    assert wrong.tolist() == [[1, 1]]
    hold(entry.corrected, {"EI": SIZES[EI], "L": LENGTH, "K_22": true[1, 1], "K_66": true[5, 5]})
    turned = np.array([0, 1, LENGTH / 2, 1, LENGTH, 1])
    assert turned @ printed @ turned / 2 == pytest.approx(-SIZES[EI] / (7 * LENGTH))
    kept, unit = np.ix_([1, 2, 3, 5], [1, 2, 3, 5]), {L: 1, EI: 1, rho: 1}
    mass, right = (
        np.array(arrays("internal_node")[k].subs(unit), dtype=float) for k in ("mass", "stiffness")
    )
    squares = [
        scipy.linalg.eigvalsh(stiffness[kept], mass[kept])[0]
        for stiffness in (right, entry.printed.value(L=1, EI=1))
    ]
    quoted(np.sqrt(squares), "9.8725", "9.5705")


def curvatures(name, quotes=()):
    """Return the check of a repeated form: the one before to the letter, so not the right one.

    ``quotes`` are entry (1, 1) of the right and of the printed matrix without L, rho A and EI.
    """

    def check(entry):
        before = {"A.5": "A.1", "A.6": "A.2", "A.7": "A.3", "A.8": "A.4"}[entry.label]
        first = Ledger("Aannaque", "")._entry(before, None, None, False)
        assert str(entry.printed) == str(first.printed)
        if quotes:
            unit = entry.printed.value(L=1, rhoA=1, EI=1)[0, 0]
            right = arrays("curvature")[name].subs({L: 1, EI: 1, rho: 1})[0, 0]
            quoted([right, unit], *quotes)

    return check


row("A.5", check=curvatures("v"), derived=lambda: letters(shape_rows("curvature")[1]))
row(
    "A.6",
    check=curvatures("v"),
    derived=lambda: letters((shape_rows("curvature")[1].diff(zeta, 2) / L**2).applyfunc(sp.factor)),
)
row("A.7", check=curvatures("mass", ("0.392", "0.151")), derived=latex_of("curvature", "mass"))
row(
    "A.8",
    check=curvatures("stiffness", ("17.1", "145.5")),
    derived=latex_of("curvature", "stiffness"),
)


test_row, test_falsified_row = row.tests()
