"""Beam elements: shapes, exact matrices, a change of the action alone."""

from __future__ import annotations

from functools import cache

import pytest
import sympy as sp
from elastolink.derive.models import beam_elements as be
from elastolink.derive.models import beam_shapes as bs
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton

KINDS = bs.KINDS
x, L = bs.x, bs.length
mass, EA, EI, GA, rotary = be.density, be.axial, bs.bending, bs.shear, be.rotary


def quick(*first):
    """Return the kinds, those that are not named first in the second stage."""
    return [kind if kind in first else pytest.param(kind, marks=pytest.mark.slow) for kind in KINDS]


@cache
def arrays(kind):
    form = be.MODEL.discretise(ModelSpec("beam_element", kind), hamilton(be.beam_action(kind)))
    ratio = bs.shear_steps().mapping()
    return {name: matrix.subs(ratio) for name, matrix in form.arrays}


@cache
def shapes(kind):
    """Return u, v and the section's rotation per nodal value, without the shear ratio."""
    ratio = bs.shear_steps().mapping()
    found = {
        f: [sp.sympify(e).subs(ratio) for e in row] for f, row in bs.field_shapes(kind).items()
    }
    turn = found.get(bs.psi, [sp.diff(e, x) for e in found[bs.v]])
    return found[bs.u], found[bs.v], turn


def same(one, other):
    return (sp.Matrix(one) - sp.Matrix(other)).applyfunc(sp.simplify).is_zero_matrix


# Exact numbers for what would take long in symbols.
CHOSEN = dict(
    zip((L, mass, EA, EI, GA, rotary), map(sp.Rational, (2, 3, 5, 7, 11, 13)), strict=True)
)


def numbered(rows):
    return [sp.Poly(sp.sympify(row).subs(CHOSEN), x) for row in rows]


def along(polynomial):
    """Integrate a polynomial in x over the length."""
    moments = polynomial.all_coeffs()[::-1]
    return sp.Add(*(c * CHOSEN[L] ** (k + 1) / (k + 1) for k, c in enumerate(moments)))


def gram(rows, others=None, weight=1):
    factor = sp.Poly(sp.sympify(weight).subs(CHOSEN), x)
    others = rows if others is None else others
    return sp.Matrix([[along(factor * a * b) for b in others] for a in rows])


# ---------------------------------------------------------------- shapes and integrals


@pytest.mark.parametrize("kind", KINDS)
def test_shapes_are_the_functions_that_take_the_nodal_values(kind):
    u, v, turn = shapes(kind)
    listed = {bs.u: u, bs.v: v, bs.psi: turn}
    values = bs.nodal_values(kind)
    for row, condition in enumerate(values):
        for column, shape in enumerate(listed[condition.field]):
            at = sp.diff(shape, x, condition.order).subs(x, condition.place * L)
            assert sp.simplify(at - int(row == column)) == 0
    if kind != "timoshenko":
        count = sum(condition.field == bs.v for condition in values)
        assert max(sp.degree(shape, x) for shape in v if shape != 0) == count - 1
        assert max(sp.degree(shape, x) for shape in u if shape != 0) == 1


def test_shapes_of_timoshenkos_beam_are_static_solutions():
    _, v, psi = shapes("timoshenko")
    for one, turn in zip(v, psi, strict=True):
        shear = GA * (sp.diff(one, x) - turn)
        assert sp.simplify(sp.diff(shear, x)) == 0
        assert sp.simplify(EI * sp.diff(turn, x, 2) + shear) == 0


@pytest.mark.parametrize("kind", quick("cubic"))
def test_matrices_are_the_integrals_of_the_shapes(kind):
    """Exact, not to rounding: the same fractions, from integrals written out here."""
    found = {name: matrix.subs(CHOSEN) for name, matrix in arrays(kind).items()}
    u, v, turn = (numbered(rows) for rows in shapes(kind))
    translation = CHOSEN[mass] * (gram(u) + gram(v))
    assert found["centripetal"] == translation
    spun = CHOSEN[rotary] * gram(turn) if kind == "timoshenko" else sp.zeros(len(v))
    assert found["mass"] == translation + spun
    assert found["coupling"] == CHOSEN[mass] * (gram(v, u) - gram(u, v))
    stretch, slopes, bend = ([row.diff(x) for row in rows] for rows in (u, v, turn))
    stiffness = CHOSEN[EA] * gram(stretch) + CHOSEN[EI] * gram(bend)
    if kind == "timoshenko":
        stiffness += CHOSEN[GA] * gram([a - b for a, b in zip(slopes, turn, strict=True)])
    assert found["stiffness"] == stiffness
    for k in range(3):
        assert found[f"geometric_{k}"] == gram(slopes, weight=(x / L) ** k)
    ends = numbered((1 - x / L, x / L))
    assert found["load"] == sp.Matrix.hstack(gram(u, ends), gram(v, ends))


@pytest.mark.slow
def test_cantilever_of_timoshenko_is_exact_and_free_of_locking():
    """One element: tip deflection ``P L^3/(3 EI) + P L/(k G A)``, whatever the slenderness."""
    stiffness = arrays("timoshenko")["stiffness"][4:6, 4:6]
    tip = stiffness.LUsolve(sp.Matrix([1, 0]))
    assert sp.simplify(tip[0] - L**3 / (3 * EI) - L / GA) == 0
    assert sp.simplify(tip[1] - L**2 / (2 * EI)) == 0
    # A distributed load is nodally exact too: p L^4/(8 EI) + p L^2/(2 k G A).
    load = arrays("timoshenko")["load"][4:6, 2:4] * sp.ones(2, 1)
    assert sp.simplify(stiffness.LUsolve(load)[0] - L**4 / (8 * EI) - L**2 / (2 * GA)) == 0


# ---------------------------------------------------------------- metamorphic


def system(**changes):
    return be.element_system(be.beam_action("cubic").with_(**changes), "cubic")


def density_without(*symbols):
    return be.beam_action("cubic").density.subs(dict.fromkeys(symbols, 0))


def test_a_tip_mass_in_the_action_moves_the_mass_matrix():
    from elastolink.derive.records import PointTerm

    tip = sp.Symbol("tip")
    spin = be.turn.diff(bs.t)
    speed2 = (bs.u.diff(bs.t) - spin * bs.v) ** 2 + (bs.v.diff(bs.t) + spin * (x + bs.u)) ** 2
    loaded = system(point_terms=(PointTerm(L, tip * speed2 / 2),))
    plain = arrays("cubic")
    added = loaded.matrix("M") - plain["mass"]
    assert same(added, sp.diag(0, 0, 0, tip, tip, 0))
    turning = sp.zeros(6)
    turning[3, 4], turning[4, 3] = -tip, tip
    assert same(loaded.matrix("A") - plain["coupling"], turning)
    assert same(loaded.matrix("K"), plain["stiffness"])


def test_without_foreshortening_there_is_no_geometric_stiffness():
    found = system(density=density_without(*be.forces))
    assert not found.has("Kg")
    assert same(found.matrix("K"), arrays("cubic")["stiffness"])
