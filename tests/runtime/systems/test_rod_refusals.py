"""What the flexible rod's functions refuse: one clear line, and never a traceback or NaN."""

from __future__ import annotations

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.systems.rod import (
    FreeFreeBasis,
    FreeFreeModes,
    OverhangBasis,
    PolynomialBasis,
    TwoSegmentBasis,
    free_free_rod,
    overhang_roots,
    rod_system,
)
from elastolink.runtime.systems.rod.basis import MATRIX_ARRAYS, VECTOR_ARRAYS

NUMBERS = {
    "crank_ratio": 0.2,
    "frame": 0.59997,
    "length": 1.0,
    "bending_stiffness": 36456.0,
    "mass_per_length": 7.15,
}
BASES = [OverhangBasis, PolynomialBasis, TwoSegmentBasis, FreeFreeBasis]
HALF = np.array([0.5])


@pytest.mark.parametrize("basis", BASES)
def test_points_and_places_off_the_rod(basis):
    for x in (0.5, [1.2], [-0.1], [np.nan], "a", [[0.1, 0.2]]):
        with pytest.raises(BadInput, match="x: found"):
            basis(2).shapes(x, HALF)
    for place in ([1e-300], [0.0], [-0.5], [1.1], [np.nan], 0.5, "a"):
        with pytest.raises(BadInput, match="place: found"):
            basis(2).array("overlap", place)
        with pytest.raises(BadInput, match="place: found"):
            basis(2).shapes(np.array([0.3]), place)
    with pytest.raises(BadInput, match=r"values from -0\.5 to 0\.3"):
        basis(1).array("overlap", np.array([-0.5, 0.3]))
    with pytest.raises(BadInput, match="array: found mass"):
        basis(2).array("mass", HALF)
    with pytest.raises(BadInput, match="derivative: found 4"):
        basis(2).shapes(HALF, HALF, 4)
    for name in (*MATRIX_ARRAYS, *VECTOR_ARRAYS):
        assert np.all(np.isfinite(basis(12).array(name, np.array([1e-12]))))


@pytest.mark.parametrize("basis", [*BASES, FreeFreeModes])
def test_number_of_modes(basis):
    assert basis(np.int64(3)).size == 3
    assert type(basis(np.int32(3)).size) is int
    most = {TwoSegmentBasis: 40, PolynomialBasis: 400}.get(basis, 1000)
    assert basis(most).size == most
    for modes in (0, -1, 2.0, np.float64(3.0), True, np.True_, "3", None, most + 1):
        with pytest.raises(BadInput, match=f"modes: found .* whole number from 1 to {most}"):
            basis(modes)


def test_places_without_a_side():
    with pytest.raises(BadInput, match="lengthen the rod"):
        TwoSegmentBasis(2).array("overlap", np.array([1.0]))
    with pytest.raises(BadInput, match="derivative: found 3"):
        OverhangBasis(2).drift(HALF, HALF, 3)


def test_terms_to_drop_and_names_of_bases():
    for drop in (None, (1, "x"), [["tension"]], "tension", ("tensions",)):
        with pytest.raises(BadInput, match="drop: found"):
            rod_system("overhang", 1, **NUMBERS, drop=drop)
        with pytest.raises(BadInput, match="drop: found"):
            free_free_rod(1, **NUMBERS, speed=10.0, drop=drop)
    with pytest.raises(BadInput, match="basis: found 'hermite'"):
        rod_system("hermite", **NUMBERS)


@pytest.mark.parametrize("name", sorted(NUMBERS))
def test_numbers(name):
    for value in (0.0, -1.0, np.nan, np.inf, "a", None, 10**400, np.ones(2)):
        changed = {**NUMBERS, name: value}
        with pytest.raises(BadInput, match=f"{name}: found"):
            rod_system("overhang", 1, **changed)
        with pytest.raises(BadInput, match=f"{name}: found"):
            free_free_rod(1, **changed, speed=10.0)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"crank_ratio": 1.0}, "eps = 1"),
        ({"crank_ratio": 0.9, "length": 1.1}, "the block leaves the rod"),
        ({"length": 0.7}, "rod"),
        ({"speed": 0.0}, "speed: found"),
        ({"speed": np.nan}, "speed: found"),
        ({"speed": "a"}, "speed: found"),
    ],
)
def test_machines_that_cannot_be(change, words):
    given = {**NUMBERS, "speed": 10.0, **change}
    with pytest.raises(BadInput, match=words):
        free_free_rod(1, **given)
    if "speed" not in change:
        del given["speed"]
        with pytest.raises(BadInput, match=words):
            rod_system("overhang", 1, **given, damping=1.0)
    with pytest.raises(BadInput, match="damping: found"):
        rod_system("overhang", 1, **NUMBERS, damping=-1.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("mass_per_length", 0.0),
        ("mass_per_length", [7.0, 0.0]),
        ("bending_stiffness", "x"),
        ("bending_stiffness", np.inf),
        ("damping", np.nan),
        ("internal_damping", -1e-9),
    ],
)
def test_parameters_changed_later(name, value):
    """As strict as when the system is made: nothing else sees a mass that is divided out."""
    system = rod_system("overhang", 2, **NUMBERS)
    added = system.without("D").with_geometry(crank_ratio=0.1)
    for changed in (system, added):
        with pytest.raises(BadInput, match=f"{name}: found"):
            changed.with_parameters(**{name: value})
    with pytest.raises(BadInput, match=f"{name}: found"):
        el.floquet_multipliers(system, 300.0, **{name: value})


def test_parameters_at_their_limits_pass():
    system = rod_system("overhang", 2, **NUMBERS, damping=1.0)
    assert not system.with_parameters(damping=0.0).is_damped()
    assert system.is_damped(damping=[0.0, 2.0])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"length": "a"}, "length: found 'a'"),
        ({"length": np.ones(2)}, "length: found"),
        ({"length": 1e200}, "beyond a double"),
        ({"length": 1e-200}, "beyond a double"),
        ({"bending_stiffness": 0.0}, "bending_stiffness: found"),
        ({"place": 1e-200}, "place: found"),
        ({"place": "a"}, "place: found 'a'"),
    ],
)
def test_frequencies(changes, words):
    given = {"length": 1.0, "bending_stiffness": 1.0, "mass_per_length": 1.0, **changes}
    with pytest.raises(BadInput, match=words):
        OverhangBasis(2).frequencies(given.pop("place", 0.5), **given)


def test_roots():
    for place, modes, words in ((0.5, 1.5, "modes"), (1.1, 2, "place"), (np.nan, 2, "place")):
        with pytest.raises(BadInput, match=f"{words}: found"):
            overhang_roots(place, modes)


def test_deflections():
    rod = free_free_rod(2, **NUMBERS, speed=100.0)
    q, _ = rod.undeformed(0.0)
    for places in ("a", [[0.1], [0.2, 0.3]], 1.2, np.nan, np.zeros((2, 2))):
        with pytest.raises(BadInput, match="places: found"):
            rod.deflection(q, 0.0, places)
    with pytest.raises(BadInput, match="q: found shape"):
        rod.deflection(q[:3], 0.0, 1.0)
