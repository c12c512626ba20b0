"""The flexible coupler through the whole pipeline: dropped terms, hand cases, exact arrays."""

from __future__ import annotations

import importlib.util
import itertools
from functools import lru_cache

import array_api_strict
import mpmath
import numpy as np
import pytest
from elastolink.derive.emission import emit
from elastolink.derive.models import coupler as model
from elastolink.derive.models import four_bar
from elastolink.derive.pipeline import equations_of_motion, lower
from elastolink.derive.records import IndexedEntry
from elastolink.derive.spec import ModelSpec
from elastolink.generated import (
    four_bar_coupler_complete,
    four_bar_coupler_printed,
    four_bar_coupler_reduced,
)
from elastolink.runtime.systems import assemble
from judging import Point, exact_at, reference_of
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


@lru_cache(maxsize=16)
def discretised(wanted):
    return model.discretise(wanted, equations_of_motion(model.action(wanted)))


@lru_cache(maxsize=16)
def lowered(wanted):
    return lower(wanted, discretised(wanted), model.MODEL.describe(wanted))


def emitted(wanted, tmp_path):
    """Return a freshly derived module, loaded from a file."""
    path = tmp_path / f"{wanted.name()}.py"
    path.write_text(emit(lowered(wanted), "0" * 32))
    loader = importlib.util.spec_from_file_location(wanted.name(), path)
    module = importlib.util.module_from_spec(loader)
    loader.loader.exec_module(module)
    return module


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


# ---------------------------------------------------------------- against a hand-written Galerkin


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


def test_entries_against_quadrature_in_many_digits():
    """A few entries of high modes, the weak form integrated by mpmath at 20 digits."""
    linkage = LINKAGES["drag link, open"]
    numbers, m = pose(linkage, 0.3)
    found = system(four_bar_coupler_complete, linkage, 40, coupler_inertia=0.0)
    found = found.with_parameters(coupler_first_moment=0.0, follower_inertia=0.0)
    matrix = found.array("B", np.array([0.3]))[0]
    with mpmath.workdps(20):
        cosine = mpmath.cos(numbers["theta2"] - m["theta3"])
        ratio = numbers["crank"] / numbers["coupler"]

        def integrand(xi, i, j):
            slopes = i * j * mpmath.pi**2 * mpmath.cos(i * mpmath.pi * xi)
            slopes *= mpmath.cos(j * mpmath.pi * xi)
            tension = ratio * cosine * (1 - xi) + m["omega3"] ** 2 * (1 - xi**2) / 2
            spun = mpmath.sin(i * mpmath.pi * xi) * mpmath.sin(j * mpmath.pi * xi)
            return 2 * (m["omega3"] ** 2 * spun - tension * slopes)

        for i, j in ((1, 1), (3, 7), (39, 40)):
            ends = mpmath.linspace(0, 1, i + j + 2)
            exact = mpmath.quad(lambda xi, i=i, j=j: integrand(xi, i, j), ends)
            assert matrix[i - 1, j - 1] == pytest.approx(float(exact), rel=1e-13)


def test_equation_of_motion_of_one_mode_by_hand():
    """Steady forcing of a mode alone, Smith (6.11): 2/(m pi) {2 l2 sin - l3 a3} for m odd."""
    linkage = LINKAGES["crank rocker, open"]
    for module in EMITTED.values():
        forcing = system(module, linkage).array("f", THETA)
        for i, theta in enumerate(THETA):
            _, m = pose(linkage, theta)
            a3, sine = float(m["alpha3"]), np.sin(theta - float(m["theta3"]))
            ratio = linkage.crank / linkage.coupler
            odd, even = 2 / np.pi * (2 * ratio * sine - a3), 2 / (2 * np.pi) * a3
            close(forcing[i, :2], np.array([odd, even]), 1e-13)


# ---------------------------------------------------------------- before separation


@pytest.mark.parametrize("formulation", EMITTED)
def test_emitted_sums_reproduce_the_unseparated_arrays(formulation):
    """Entries of the discrete system before separation, staging and CSE, in 80 digits."""
    staged = discretised(spec(formulation))
    linkage = LINKAGES["drag link, crossed"]
    found = system(EMITTED[formulation], linkage, 5)
    for array, entry in staged.system.arrays.items():
        if isinstance(entry, IndexedEntry):
            pairs = [(1, 1), (1, 2), (2, 5), (4, 4), (5, 3)]
            entries = [
                entry.diagonal.subs(entry.m, i)
                if i == j
                else entry.off_diagonal.subs({entry.m: i, entry.n: j})
                for i, j in pairs
            ]
        else:
            pairs = [(1,), (2,), (5,)]
            entries = [entry.entry.subs(entry.m, i) for (i,) in pairs]
        outputs = [(str(k), value) for k, value in enumerate(entries)]
        inputs = (*staged.parameters, *staged.geometry)
        reference = reference_of(inputs, outputs, staged.steps)
        for i, theta in enumerate(THETA):
            numbers = {**PARAMETERS, **linkage.lengths, "assembly": linkage.assembly}
            point = Point("", {}, {**numbers, "theta2": float(theta)})
            values = exact_at(reference, point).values
            at = found.array(array, THETA)[i]
            for k, pair in enumerate(pairs):
                index = tuple(p - 1 for p in pair)
                expected = float(values[str(k)])
                assert at[index] == pytest.approx(expected, rel=1e-13, abs=1e-14 * abs(at).max())


def test_arrays_are_symmetric_and_modes_couple_only_through_what_varies_along_the_coupler():
    everywhere = {n: system(m, LINKAGES["drag link, open"], 6) for n, m in EMITTED.items()}
    for name, array in itertools.product(EMITTED, MATRICES):
        matrix = everywhere[name].array(array, THETA)
        np.testing.assert_array_equal(matrix, matrix.swapaxes(1, 2))
        diagonal = np.einsum("tii->ti", matrix)
        off = matrix - diagonal[..., None] * np.eye(6)
        if name == "complete" and array in ("B", "S"):
            assert np.all(np.abs(off).max(axis=(1, 2)) > 1e-3 * np.abs(diagonal).max(axis=1))
        else:
            assert not off.any()


def test_modes_nest():
    """The arrays of few modes are the leading blocks of those of many."""
    for module in EMITTED.values():
        few, many = (system(module, LINKAGES["drag link, open"], n) for n in (3, 60))
        for array in ARRAYS:
            small = few.array(array, THETA)
            block = many.array(array, THETA)[(slice(None), *(slice(3),) * (small.ndim - 1))]
            np.testing.assert_array_equal(small, block)


# ---------------------------------------------------------------- metamorphic


def rows(module):
    """Return the separated terms of a module: array, power, scale, angle, modal."""
    (found,) = (table.value for table in module.tables if table.name == "TERMS")
    return found


def terms(wanted):
    return {(array, scale, angle) for array, _, scale, angle, _ in rows(lowered(wanted))}


END_LOADS = ("coupler_first_moment", "coupler_inertia")


def test_formulations_cost_less_the_more_they_leave_out():
    costs = {name: lowered(spec(name)).operations for name in EMITTED}
    assert costs["reduced"] < 0.9 * costs["printed"] < 0.9 * costs["complete"]


@pytest.mark.slow
def test_dropping_the_follower_removes_its_term_alone():
    whole, without = terms(spec()), terms(spec(drop=("follower_end_load",)))
    assert without < whole
    assert {scale for _, scale, _ in whole - without} == {"follower_inertia_over_mass_per_length"}


@pytest.mark.slow
def test_dropping_the_couplers_end_load_removes_its_two_terms_alone():
    whole, without = terms(spec()), terms(spec(drop=("coupler_end_load",)))
    assert without < whole
    assert {scale for _, scale, _ in whole - without} == {
        f"{name}_over_mass_per_length" for name in END_LOADS
    }


@pytest.mark.slow
def test_balancing_at_the_crank_pin_removes_the_first_moment(tmp_path):
    whole, balanced = terms(spec()), terms(spec(balanced=("coupler",)))
    assert {scale for _, scale, _ in whole - balanced} == {
        "coupler_first_moment_over_mass_per_length"
    }
    assert balanced < whole
    assert lowered(spec(balanced=("coupler",))).operations < lowered(spec()).operations
    linkage = LINKAGES["crank rocker, crossed"]
    lean = system(emitted(spec(balanced=("coupler",)), tmp_path), linkage)
    full = system(four_bar_coupler_complete, linkage, coupler_first_moment=0.0)
    for array in ARRAYS:
        close(lean.array(array, THETA), full.array(array, THETA), 1e-14)


@pytest.mark.slow
def test_dropping_the_axial_inertia_gives_the_printed_equation(tmp_path):
    dropped = emitted(spec(drop=("axial_inertia",)), tmp_path)
    assert dropped.TERMS == four_bar_coupler_printed.TERMS
    all_three = emitted(spec(drop=("axial_inertia", "spin", "coupler_end_load")), tmp_path)
    assert all_three.TERMS == four_bar_coupler_reduced.TERMS


@pytest.mark.slow
def test_dropping_the_spin_takes_omega3_squared_from_the_stiffness_and_nothing_else(tmp_path):
    """The forcing keeps the rotation of the coupler: Smith (6.18) has that of (6.17)."""
    linkage = LINKAGES["drag link, open"]
    whole = system(four_bar_coupler_complete, linkage)
    without = system(emitted(spec(drop=("spin",)), tmp_path), linkage)
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


def test_a_stability_only_module_holds_no_forcing():
    lean, whole = lowered(spec(outputs=("stability",))), lowered(spec())
    assert not {row[0] for row in rows(lean)} & {"f", "g", "h", "p"}
    names = {kernel.name for kernel in lean.kernels}
    assert names == {"scales", "angle_functions", "acceleration_functions", "modal_matrices"}
    assert lean.operations < 0.75 * whole.operations
    assert [row for row in rows(whole) if row[0] in MATRICES] == list(rows(lean))


def test_unknown_terms_are_refused():
    with pytest.raises(ValueError, match=r"unknown terms \['friction'\]"):
        model.action(spec(drop=("friction",)))


def test_pin_force_has_tension_positive_and_balances_both_moments():
    """Force along and across BC against the 40-digit balance of moments, all inertias at once."""
    along, across = model.pin_force(spec())
    k = four_bar.kinematics()
    inputs = (*model_inputs(), model.rate, model.acceleration)
    reference = reference_of(inputs, [("along", along), ("across", across)], k.steps)
    for linkage in LINKAGES.values():
        numbers, m = pose(linkage, 0.8)
        inertias = {"inertia3": 0.9, "moment3": 0.5, "inertia4": 1.3}
        rates = {"rate": 2.0, "acceleration": -0.7}
        values = reference(
            {
                **{name: numbers[name] for name in (*linkage.lengths, "theta2", "assembly")},
                "coupler_inertia": 0.9,
                "coupler_first_moment": 0.5,
                "follower_inertia": 1.3,
                "theta2_rate": rates["rate"],
                "theta2_acceleration": rates["acceleration"],
            }
        )
        expected = end_load(numbers, m, **inertias, **rates)
        assert float(values["along"]) == pytest.approx(float(expected), rel=1e-12)
        # The moment of the coupler about B alone fixes the other component.
        turn = numbers["theta2"] - m["theta3"]
        lift = linkage.crank * (-(2.0**2) * np.sin(float(turn)) - 0.7 * np.cos(float(turn)))
        turned = 0.9 * (float(m["alpha3"]) * 2.0**2 - 0.7 * float(m["omega3"]))
        moment = turned + 0.5 * lift
        assert float(values["across"]) * linkage.coupler == pytest.approx(moment, rel=1e-12)


def model_inputs():
    lengths = (four_bar.frame, four_bar.crank, four_bar.coupler, four_bar.follower)
    inertias = (model.inertia3, model.moment3, model.inertia4)
    return (four_bar.theta2, *lengths, four_bar.assembly, *inertias)


# ---------------------------------------------------------------- namespaces


@pytest.mark.parametrize("formulation", EMITTED)
def test_array_namespaces_give_the_same_bits(formulation):
    module, linkage = EMITTED[formulation], LINKAGES["drag link, open"]
    theta = np.linspace(-7.0, 7.0, 30)
    geometry = {**linkage.lengths, "assembly": linkage.assembly}
    m = np.arange(1.0, 9.0)
    calls = {name: ((theta,), geometry) for name in module.RETURNS if name.endswith("_functions")}
    calls["modal_matrices"] = ((m[:, None], m[None, :]), {})
    calls["modal_vectors"] = ((m,), {})
    used = {name: np.full(3, value) for name, value in PARAMETERS.items()}
    calls["scales"] = ((*used.values(), np.full(3, linkage.coupler)), {})
    assert set(calls) == set(module.RETURNS)
    for name, (arrays, fixed) in calls.items():
        for array in arrays:
            array.flags.writeable = False
        expected = getattr(module, name)(*arrays, **fixed)
        strict = getattr(module, name)(*map(array_api_strict.asarray, arrays), **fixed)
        for one, other in zip(expected, strict, strict=True):
            assert type(other) is type(array_api_strict.asarray(m))
            np.testing.assert_array_equal(np.asarray(other), one)


@pytest.mark.parametrize("kind", [float, np.float64, int])
def test_scalars_give_the_same_numbers(kind):
    module, linkage = four_bar_coupler_complete, LINKAGES["crank rocker, open"]
    geometry = {**linkage.lengths, "assembly": linkage.assembly}
    for name in module.RETURNS:
        function = getattr(module, name)
        if name.endswith("_functions"):
            whole, one = function(np.array([2.0]), **geometry), function(kind(2), **geometry)
        elif name == "modal_matrices":
            whole, one = function(np.array([2.0]), np.array([5.0])), function(kind(2), kind(5))
        elif name == "modal_vectors":
            whole, one = function(np.array([3.0])), function(kind(3))
        else:
            continue
        for array, scalar in zip(whole, one, strict=True):
            assert float(scalar) == pytest.approx(float(np.ravel(array)[0]), rel=1e-14, abs=1e-15)
