"""What the flexible rod's functions refuse: one clear line, and never a traceback or NaN."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.systems import rod as rods
from elastolink.runtime.systems.rod.basis import MATRIX_ARRAYS, VECTOR_ARRAYS
from free_free_loads import ROD
from refusals import each_of, refused

NUMBERS = {"crank_ratio": 0.2, **ROD}
BASES = [rods.OverhangBasis, rods.PolynomialBasis, rods.TwoSegmentBasis, rods.FreeFreeBasis]
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


@pytest.mark.parametrize("basis", [*BASES, rods.FreeFreeModes])
def test_number_of_modes(basis):
    assert basis(np.int64(3)).size == 3
    assert type(basis(np.int32(3)).size) is int
    most = {rods.TwoSegmentBasis: 40, rods.PolynomialBasis: 400}.get(basis, 1000)
    assert basis(most).size == most
    for modes in (0, -1, 2.0, np.float64(3.0), True, np.True_, "3", None, most + 1):
        with pytest.raises(BadInput, match=f"modes: found .* whole number from 1 to {most}"):
            basis(modes)


def linear(**given):
    return rods.rod_system("overhang", 1, **NUMBERS | given)


def buckens(**given):
    return rods.free_free_rod(1, **NUMBERS | {"speed": 10.0} | given)


def frequencies(place=0.5, **given):
    numbers = {"length": 1.0, "bending_stiffness": 1.0, "mass_per_length": 1.0}
    return rods.OverhangBasis(2).frequencies(place, **numbers | given)


def roots(place=0.5, modes=2):
    return rods.OverhangBasis(modes).roots(np.array([place]))


def deflection(places=1.0, size=5):
    return BENT.deflection(UNDEFORMED[:size], 0.0, places)


BENT = rods.free_free_rod(2, **NUMBERS, speed=100.0)
UNDEFORMED, _ = BENT.undeformed(0.0)
DROPS = [({"drop": d}, "drop: found") for d in (None, (1, "x"), [["tension"]], "tension", ("a",))]
VALUES = [
    ({name: value}, f"{name}: found")
    for name in NUMBERS
    for value in (0.0, -1.0, np.nan, np.inf, "a", None, 10**400, np.ones(2))
]
MACHINES = [
    ({"crank_ratio": 1.0}, "eps = 1"),
    ({"crank_ratio": 0.9, "length": 1.1}, "the block leaves the rod"),
    ({"length": 0.7}, "rod"),
]
CASES = {
    linear: [*DROPS, *VALUES, *MACHINES, ({"damping": -1.0}, "damping: found")],
    buckens: [
        *(*DROPS, *VALUES, *MACHINES),
        *(({"speed": speed}, "speed: found") for speed in (0.0, np.nan, "a")),
    ],
    frequencies: [
        ({"length": "a"}, "length: found 'a'"),
        ({"length": np.ones(2)}, "length: found"),
        ({"length": 1e200}, "beyond a double"),
        ({"length": 1e-200}, "beyond a double"),
        ({"bending_stiffness": 0.0}, "bending_stiffness: found"),
        ({"place": 1e-200}, "place: found"),
    ],
    roots: [({"modes": 1.5}, "modes: found"), ({"place": np.nan}, "place: found")],
    deflection: [
        *(({"places": p}, "places: found") for p in ("a", [[0.1], [0.2, 0.3]], 1.2, np.nan)),
        ({"size": 3}, "q: found shape"),
    ],
}


test_arguments = refused(lambda call, given: call(**given), each_of(CASES))


def test_places_without_a_side_and_names_of_bases():
    with pytest.raises(BadInput, match="lengthen the rod"):
        rods.TwoSegmentBasis(2).array("overlap", np.array([1.0]))
    with pytest.raises(BadInput, match="derivative: found 3"):
        rods.OverhangBasis(2).drift(HALF, HALF, 3)
    with pytest.raises(BadInput, match="basis: found 'hermite'"):
        rods.rod_system("hermite", **NUMBERS)


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
    system = rods.rod_system("overhang", 2, **NUMBERS)
    added = system.without("D").with_geometry(crank_ratio=0.1)
    for changed in (system, added):
        with pytest.raises(BadInput, match=f"{name}: found"):
            changed.with_parameters(**{name: value})
    with pytest.raises(BadInput, match=f"{name}: found"):
        el.floquet_multipliers(system, 300.0, **{name: value})
