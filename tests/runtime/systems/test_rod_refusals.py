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
    galerkin_integrals,
    overhang_frequencies,
    rigid_state,
    rod_system,
    tip_deflection,
)
from elastolink.runtime.systems.rod.constrained import deflection
from elastolink.runtime.systems.rod.overhang import root_count
from elastolink.runtime.systems.rod.segments import FACTORS

NUMBERS = {
    "crank_ratio": 0.2,
    "frame": 0.59997,
    "length": 1.0,
    "bending_stiffness": 36456.0,
    "mass_per_length": 7.15,
}
BASES = [OverhangBasis, PolynomialBasis, TwoSegmentBasis, FreeFreeBasis]


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("x", [0.5, [1.2], [-0.1], [np.nan], "a", [[0.1, 0.2]]])
def test_points_off_the_rod(basis, x):
    with pytest.raises(BadInput, match="x: found"):
        basis(2).shapes(x, np.array([0.5]))


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("place", [[1e-300], [0.0], [-0.5], [1.1], [np.nan], 0.5, "a"])
def test_places_off_the_rod(basis, place):
    with pytest.raises(BadInput, match="place: found"):
        basis(2).array("overlap", place)
    with pytest.raises(BadInput, match="place: found"):
        basis(2).shapes(np.array([0.3]), place)


def test_the_sign_of_a_place_is_told():
    with pytest.raises(BadInput, match=r"values from -0\.5 to 0\.3"):
        OverhangBasis(1).array("overlap", np.array([-0.5, 0.3]))


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("name", sorted(FACTORS))
def test_nearest_place_is_finite(basis, name):
    assert np.all(np.isfinite(basis(12).array(name, np.array([1e-12]))))


@pytest.mark.parametrize("basis", [*BASES, FreeFreeModes])
def test_number_of_modes(basis):
    assert basis(np.int64(3)).size == 3
    assert type(basis(np.int32(3)).size) is int
    for modes in (0, -1, 2.0, np.float64(3.0), True, np.True_, "3", None):
        with pytest.raises(BadInput, match="whole number from 1"):
            basis(modes)
    most = {TwoSegmentBasis: 40, PolynomialBasis: 400}.get(basis, 1000)
    assert basis(most).size == most
    with pytest.raises(BadInput, match=f"at most {most}: "):
        basis(most + 1)


@pytest.mark.parametrize("drop", [None, (1, "x"), [["tension"]], "tension", ("tensions",)])
def test_terms_to_drop(drop):
    with pytest.raises(BadInput, match="drop: found"):
        rod_system(OverhangBasis(1), **NUMBERS, drop=drop)
    with pytest.raises(BadInput, match="drop: found"):
        free_free_rod(1, **NUMBERS, speed=10.0, drop=drop)


@pytest.mark.parametrize("name", sorted(NUMBERS))
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf, "a", None, 10**400, np.ones(2)])
def test_numbers(name, value):
    changed = {**NUMBERS, name: value}
    with pytest.raises(BadInput, match=f"{name}: found"):
        rod_system(OverhangBasis(1), **changed)
    with pytest.raises(BadInput, match=f"{name}: found"):
        free_free_rod(1, **changed, speed=10.0)


@pytest.mark.parametrize("speed", [0.0, np.nan, "a"])
def test_speed_of_the_constrained_rod(speed):
    with pytest.raises(BadInput, match="speed: found"):
        free_free_rod(1, **NUMBERS, speed=speed)


@pytest.mark.parametrize(
    "name, value",
    [
        ("mass_per_length", 0.0),
        ("mass_per_length", -1.0),
        ("mass_per_length", [7.0, 0.0]),
        ("bending_stiffness", "x"),
        ("bending_stiffness", np.inf),
        ("damping", np.nan),
        ("damping", -3.0),
        ("internal_damping", -1e-9),
    ],
)
def test_parameters_changed_later(name, value):
    """As strict as when the system is made: nothing else sees a mass that is divided out."""
    system = rod_system(OverhangBasis(2), **NUMBERS)
    with pytest.raises(BadInput, match=f"{name}: found"):
        system.with_parameters(**{name: value})
    with pytest.raises(BadInput, match=f"{name}: found"):
        el.floquet_multipliers(system, 300.0, **{name: value})
    added = system.without("D").with_geometry(crank_ratio=0.1)
    with pytest.raises(BadInput, match=f"{name}: found"):
        added.with_parameters(**{name: value})


def test_parameters_at_their_limits_pass():
    system = rod_system(OverhangBasis(2), **NUMBERS, damping=1.0)
    assert not system.with_parameters(damping=0.0).is_damped()
    assert system.is_damped(damping=[0.0, 2.0])


@pytest.mark.parametrize("theta", [[], "a", [np.nan], np.zeros((2, 2))])
def test_angles_of_the_integrals(theta):
    with pytest.raises(BadInput, match="theta: found"):
        galerkin_integrals(theta, 2, crank_ratio=0.2, frame=0.5, length=1.0)


def test_integrals_need_the_block_on_the_rod_at_their_own_angles_only():
    """A crank as long as the frame: the block is at the pin at half a turn, and nowhere else."""
    equal = {"crank_ratio": 1.0, "frame": 0.4, "length": 1.0}
    found = galerkin_integrals(0.5, 2, **equal)
    np.testing.assert_allclose(found.place, 0.8 * np.cos(0.25), rtol=1e-14)
    with pytest.raises(BadInput, match=r"theta: found 3\.14"):
        galerkin_integrals([0.5, np.pi], 2, **equal)


@pytest.mark.parametrize(
    "changes, words",
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
        overhang_frequencies(given.pop("place", 0.5), 2, **given)


@pytest.mark.parametrize(
    "place, beta, words",
    [
        (0.5, np.nan, "beta"),
        (0.5, np.inf, "beta"),
        (0.5, -1.0, "beta"),
        (0.5, "b", "beta"),
        (2.0, 5.0, "place"),
        ("a", 5.0, "place"),
    ],
)
def test_counts(place, beta, words):
    with pytest.raises(BadInput, match=f"{words}: found"):
        root_count(place, beta)


def test_deflections():
    rod = free_free_rod(2, **NUMBERS, speed=100.0)
    q = rigid_state(rod, 0.0).q
    for places in ("a", [[0.1], [0.2, 0.3]], 1.2, np.nan, np.zeros((2, 2))):
        with pytest.raises(BadInput, match="places: found"):
            deflection(rod, q, 0.0, places)
    with pytest.raises(BadInput, match="q: found shape"):
        tip_deflection(rod, q[:3], 0.0)
