"""The flexible coupler through the whole pipeline: dropped terms, hand cases, exact arrays."""

import mpmath
import numpy as np
import pytest
from derivations import loaded, lowered, text_of
from elastolink.derive.spec import ModelSpec
from elastolink.generated import (
    four_bar_coupler_complete,
    four_bar_coupler_printed,
    four_bar_coupler_reduced,
)
from elastolink.runtime.systems import assemble
from linkage_truth import Linkage, end_load, motion

EMITTED = {
    "complete": four_bar_coupler_complete,
    "printed": four_bar_coupler_printed,
    "reduced": four_bar_coupler_reduced,
}
PARAMETERS = {
    "bending_stiffness": 3.0,
    "mass_per_length": 0.7,
    "damping": 0.2,
    "coupler_inertia": 0.9,
    "coupler_first_moment": 0.5,
    "follower_inertia": 1.3,
}
LINKAGES = {
    "crank rocker, open": Linkage(5.0, 1.0, 4.5, 2.0, 1.0),
    "crank rocker, crossed": Linkage(5.0, 1.0, 4.5, 2.0, -1.0),
    "drag link, open": Linkage(2.0, 4.0, 5.0, 4.5, 1.0),
    "drag link, crossed": Linkage(2.0, 4.0, 5.0, 4.5, -1.0),
}
THETA = np.array([-0.4, 0.3, 1.9, 4.4])
MATRICES = ("M", "B", "S", "C", "K")
ARRAYS = (*MATRICES, "f", "g")


def spec(formulation="complete", **changes):
    return ModelSpec("four_bar", formulation, flexible=("coupler",)).with_(**changes)


def system(module, linkage, modes=4, **changes):
    return assemble(
        module,
        geometry={**linkage.lengths, "assembly": linkage.assembly},
        parameters={**PARAMETERS, **changes},
        modes=modes,
    )


def close(found, expected, tolerance=1e-12):
    scale = np.abs(expected).max(initial=0.0)
    np.testing.assert_allclose(found, expected, rtol=tolerance, atol=tolerance * scale)


def pose(linkage, theta):
    """Return the exact motion at one angle as floats, and the numbers that gave it."""
    with mpmath.workdps(40):
        numbers = {"theta2": mpmath.mpf(theta), "assembly": linkage.assembly}
        numbers |= {name: mpmath.mpf(value) for name, value in linkage.lengths.items()}
        exact = motion(numbers)
    return numbers, exact


def by_hand(linkage, theta, modes=4):
    """Galerkin arrays by quadrature, the powers of the crank's rates apart.

    mu y_tt + c y_t + EI y'''' - (N y')' - mu w3^2 y = load:  N is what the part of the coupler
    beyond x and the end load need along BC; the load is minus the acceleration of the rigid
    coupler across it.
    """
    numbers, m = pose(linkage, theta)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    xi, weights = (nodes + 1) / 2, weights / 2
    wave = np.pi * np.arange(1, modes + 1)[:, None]
    shape, slope, bend = np.sin(wave * xi), wave * np.cos(wave * xi), -(wave**2) * np.sin(wave * xi)
    mu, length, crank = PARAMETERS["mass_per_length"], linkage.coupler, linkage.crank
    turn = theta - float(m["theta3"])
    inertias = {
        "inertia3": PARAMETERS["coupler_inertia"],
        "moment3": PARAMETERS["coupler_first_moment"],
        "inertia4": PARAMETERS["follower_inertia"],
    }
    pull = float(end_load(numbers, m, **inertias))
    starting = float(end_load(numbers, m, **inertias, rate=0, acceleration=1))
    w3, a3, beyond = float(m["omega3"]), float(m["alpha3"]), length * (1 - xi)
    spin2 = w3**2 * length**2 * (1 - xi**2) / 2
    tension = pull + mu * (crank * np.cos(turn) * beyond + spin2)
    tension_s = starting + mu * crank * np.sin(turn) * beyond
    load = mu * (crank * np.sin(turn) - length * xi * a3)
    load_g = -mu * (crank * np.cos(turn) + length * xi * w3)

    def weighted(a, b, weight=1.0):
        return np.einsum("mi,ni,i->mn", a, b, weight * weights) * 2 / mu

    identity = weighted(shape, shape) * mu
    return {
        "M": identity,
        "C": identity * PARAMETERS["damping"] / mu,
        "K": weighted(bend, bend) * PARAMETERS["bending_stiffness"] / length**4,
        "B": identity * w3**2 - weighted(slope, slope, tension) / length**2,
        "S": -weighted(slope, slope, tension_s) / length**2,
        "f": 2 / (mu * length) * shape @ (weights * load),
        "g": 2 / (mu * length) * shape @ (weights * load_g),
    }


@pytest.mark.parametrize("name", LINKAGES)
def test_complete_arrays_against_quadrature_of_the_weak_form(name):
    linkage = LINKAGES[name]
    complete = system(four_bar_coupler_complete, linkage)
    for i, theta in enumerate(THETA):
        expected = by_hand(linkage, theta)
        for array in ARRAYS:
            close(complete.array(array, THETA)[i], expected[array])
    assert not complete.has("A") and not complete.has("Kg")


def rows(module):
    """Return the separated terms of a module: array, power, scale, angle, modal."""
    (found,) = (table.value for table in module.tables if table.name == "TERMS")
    return found


def terms(wanted):
    return {(array, scale, angle) for array, _, scale, angle, _ in rows(lowered(wanted))}


@pytest.mark.slow
def test_balancing_at_the_crank_pin_removes_the_first_moment():
    whole, balanced = terms(spec()), terms(spec(balanced=("coupler",)))
    assert {scale for _, scale, _ in whole - balanced} == {
        "coupler_first_moment_over_mass_per_length"
    }
    assert balanced < whole
    assert lowered(spec(balanced=("coupler",))).operations < lowered(spec()).operations
    linkage = LINKAGES["crank rocker, crossed"]
    lean = system(loaded(text_of(spec(balanced=("coupler",)))), linkage)
    full = system(four_bar_coupler_complete, linkage, coupler_first_moment=0.0)
    for array in ARRAYS:
        close(lean.array(array, THETA), full.array(array, THETA), 1e-14)


@pytest.mark.slow
def test_dropping_the_axial_inertia_gives_the_printed_equation():
    dropped = loaded(text_of(spec(drop=("axial_inertia",))))
    assert dropped.TERMS == four_bar_coupler_printed.TERMS
    all_three = loaded(text_of(spec(drop=("axial_inertia", "spin", "coupler_end_load"))))
    assert all_three.TERMS == four_bar_coupler_reduced.TERMS


@pytest.mark.slow
def test_dropping_the_spin_takes_omega3_squared_from_the_stiffness_and_nothing_else():
    """The forcing keeps the rotation of the coupler: Smith (6.18) has that of (6.17)."""
    linkage = LINKAGES["drag link, open"]
    whole = system(four_bar_coupler_complete, linkage)
    without = system(loaded(text_of(spec(drop=("spin",)))), linkage)
    spin = np.array([float(pose(linkage, theta)[1]["omega3"]) ** 2 for theta in THETA])
    close(
        whole.array("B", THETA) - without.array("B", THETA), spin[:, None, None] * np.eye(4), 1e-12
    )
    for array in ("M", "S", "C", "K", "f", "g"):
        close(without.array(array, THETA), whole.array(array, THETA), 1e-13)


def test_every_formulation_has_the_same_forcing():
    for linkage in LINKAGES.values():
        found = [system(module, linkage) for module in EMITTED.values()]
        for array in ("f", "g"):
            for other in found[1:]:
                close(other.array(array, THETA), found[0].array(array, THETA), 1e-13)
