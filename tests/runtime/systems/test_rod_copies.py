"""Copies of the rod's system: deep ones, pickled ones, and those with terms replaced."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Term
from elastolink.runtime.systems import rod_system, with_modal_damping
from elastolink.runtime.systems.rod.linear import BASES
from free_free_loads import ROD

NUMBERS = {"crank_ratio": 0.2, **ROD, "damping": 2.0}
THETA = np.array([0.3, 2.0, 4.4])
ARRAYS = ("M", "A", "B", "C", "D", "K", "f", "g")


def _system(basis="overhang"):
    return rod_system(basis, 2, **NUMBERS)


def _scaled(term):
    """Return a term twice as large where it is damping."""
    if term.array not in ("C", "D"):
        return term
    return replace(term, function=lambda theta: 2.0 * term(theta))


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
@pytest.mark.parametrize("basis", BASES)
def test_copies_are_the_same_system(basis, copied):
    own = with_modal_damping(_system(basis).without("g"), 0.01)
    other = copied(own)
    here, there = (s.with_geometry(crank_ratio=0.1) for s in (own, other))
    for name in ARRAYS:
        np.testing.assert_array_equal(other.array(name, THETA), own.array(name, THETA))
        np.testing.assert_array_equal(there.array(name, THETA), here.array(name, THETA))
    x = np.array([0.2, 1.0])
    np.testing.assert_array_equal(other.shapes(x, THETA), own.shapes(x, THETA))


def test_changed_terms_stay_changed_in_another_geometry():
    changed = _system().with_changed_terms(_scaled).with_geometry(crank_ratio=0.1)
    plain = _system().with_geometry(crank_ratio=0.1)
    for name in ARRAYS:
        factor = 2.0 if name in ("C", "D") else 1.0
        expected = factor * plain.array(name, THETA)
        np.testing.assert_allclose(changed.array(name, THETA), expected, rtol=1e-14)
    assert np.any(changed.array("D", THETA))


@pytest.mark.parametrize(
    "change",
    [
        lambda terms: tuple(t for t in terms if t.array != "K"),
        lambda terms: tuple(_scaled(t) for t in terms),
        lambda terms: (*terms, Term("Kg", None, np.eye(2))),
    ],
)
def test_terms_replaced_by_other_means_are_not_brought_back_silently(change):
    system = _system()
    replaced = replace(system, terms=change(system.terms))
    with pytest.raises(BadInput, match="terms that are not those"):
        replaced.with_geometry(crank_ratio=0.1)
    with pytest.raises(BadInput, match="made for one geometry"):
        replace(replaced, rebuild=None).with_geometry(crank_ratio=0.1)


def test_own_methods_may_change_terms_in_any_order():
    system = rod_system("overhang", 2, **NUMBERS, provenance={"scene": "one"})
    system = system.with_terms(Term("Kg", "push", np.eye(2)), scales={"push": 3.0})
    system = system.without("g").with_parameters(push=4.0, damping=1.0)
    moved = with_modal_damping(system, 0.01).with_geometry(crank_ratio=0.1, length=1.1)
    again = moved.with_geometry(crank_ratio=0.2, length=1.0)
    fresh = with_modal_damping(system, 0.01)
    for name in (*ARRAYS, "Kg"):
        np.testing.assert_array_equal(again.array(name, THETA), fresh.array(name, THETA))
    assert again.array("Kg", THETA)[0, 0, 0] == 4.0
    assert not moved.has("g")
    assert moved.geometry == {"crank_ratio": 0.1, "frame": 0.59997, "length": 1.1}
    assert moved.reference_length == 1.1 and moved.parameters["damping"] == 1.0
    assert moved.provenance["scene"] == "one"
    assert "crank_ratio=0.1" in moved.provenance["changed"]


def test_unknown_limits_are_refused():
    with pytest.raises(BadInput, match="limits"):
        replace(_system(), limits={"damping": "small"})
