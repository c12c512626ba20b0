"""Beam elements: a change of the action alone moves their arrays to a hand case.

The arrays themselves are compared with energies by quadrature: ``test_beam_assembly.py``.
"""

from __future__ import annotations

import sympy as sp
from elastolink.derive.models import beam_elements as be
from elastolink.derive.models import beam_shapes as bs
from elastolink.derive.records import PointTerm


def system(**changes):
    return be.element_system(be.beam_action("cubic").with_(**changes), "cubic")


def same(one, other):
    return (sp.Matrix(one) - sp.Matrix(other)).applyfunc(sp.simplify).is_zero_matrix


def test_a_tip_mass_in_the_action_moves_the_mass_matrix():
    tip, x, spin = sp.Symbol("tip"), bs.x, be.turn.diff(bs.t)
    speed2 = (bs.u.diff(bs.t) - spin * bs.v) ** 2 + (bs.v.diff(bs.t) + spin * (x + bs.u)) ** 2
    loaded = system(point_terms=(PointTerm(bs.length, tip * speed2 / 2),))
    plain = system()
    assert same(loaded.matrix("M") - plain.matrix("M"), sp.diag(0, 0, 0, tip, tip, 0))
    turning = sp.zeros(6)
    turning[3, 4], turning[4, 3] = -tip, tip
    assert same(loaded.matrix("A") - plain.matrix("A"), turning)
    assert same(loaded.matrix("K"), plain.matrix("K"))


def test_without_foreshortening_there_is_no_geometric_stiffness():
    density = be.beam_action("cubic").density.subs(dict.fromkeys(be.forces, 0))
    found, plain = system(density=density), system()
    assert plain.has("Kg") and not found.has("Kg")
    assert same(found.matrix("K"), plain.matrix("K"))
