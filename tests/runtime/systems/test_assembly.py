"""From an emitted module and numbers to the system: shapes, sharing, what is refused."""

from __future__ import annotations

import types

import numpy as np
import pytest
from elastolink.generated import four_bar_coupler_complete, four_bar_kinematics, hill_plain
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.systems import assemble

GEOMETRY = {"frame": 5.0, "crank": 1.0, "coupler": 5.0, "follower": 2.0, "assembly": 1.0}
PARAMETERS = {
    "bending_stiffness": 3.0,
    "mass_per_length": 0.7,
    "damping": 0.2,
    "coupler_inertia": 0.9,
    "coupler_first_moment": 0.5,
    "follower_inertia": 1.3,
}
THETA = np.array([0.1, 2.0, 5.0])


def system(**changes):
    options = {"geometry": GEOMETRY, "parameters": PARAMETERS, "modes": 3, **changes}
    return assemble(four_bar_coupler_complete, **options)


def test_every_row_of_the_table_becomes_a_term():
    rows = [(row[0], row[1], row[2]) for row in four_bar_coupler_complete.TERMS]
    assert [(t.array, t.power, t.scale) for t in system().terms] == rows
    constant = [row[3] is None for row in four_bar_coupler_complete.TERMS]
    assert [t.constant for t in system().terms] == constant


def test_functions_of_angle_are_evaluated_once_for_all_terms(monkeypatch):
    """All terms of B ask at one array of angles: one call; equal angles again: none."""
    calls = []
    real = four_bar_coupler_complete.angle_functions

    def counted(theta2, frame, crank, coupler, follower, assembly):
        calls.append(np.array(theta2))
        return real(theta2, frame, crank, coupler, follower, assembly)

    monkeypatch.setattr(four_bar_coupler_complete, "angle_functions", counted)
    found = system()
    calls.clear()
    first = found.array("B", THETA)
    assert len(calls) == 1
    np.testing.assert_array_equal(found.array("B", THETA.copy()), first)
    assert len(calls) == 1
    moved = THETA.copy()
    found.array("B", moved)
    moved[0] = 0.2
    assert not np.array_equal(found.array("B", moved)[0], first[0])


def test_parameters_broadcast():
    values = np.array([0.5, 1.0, 2.0])
    scales = system().scale_values(mass_per_length=values, damping=values[:, None])
    assert scales["damping_over_mass_per_length"].shape == (3, 3)
    np.testing.assert_allclose(
        scales["bending_stiffness_over_mass_per_length"], 3.0 / (625.0 * values), rtol=1e-15
    )


def test_supplied_functions_reach_their_terms():
    values = {"lam2": 2.0, "mu": 0.3, "damping": 0.05}
    found = assemble(hill_plain, geometry={}, parameters=values, external={"f": np.cos})
    assert found.size == 1
    np.testing.assert_allclose(found.array("Kg", THETA)[:, 0, 0], 0.3 * np.cos(THETA), rtol=1e-15)
    np.testing.assert_array_equal(found.array("C", THETA)[:, 0, 0], [0.1] * 3)
    np.testing.assert_array_equal(found.array("K", THETA)[:, 0, 0], [2.0] * 3)


@pytest.mark.parametrize("modes", [None, 0, -1])
def test_a_number_of_modes_is_needed(modes):
    with pytest.raises(BadInput, match="a number of modes, from 1"):
        system(modes=modes)


def test_another_number_of_modes_than_the_module_has_is_refused():
    values = {"lam2": 2.0, "mu": 0.3, "damping": 0.05}
    with pytest.raises(BadInput, match="modes: found 2; expected 1"):
        assemble(hill_plain, geometry={}, parameters=values, external={"f": np.cos}, modes=2)


def test_what_is_missing_is_named():
    parameters = {k: v for k, v in PARAMETERS.items() if k != "damping"}
    with pytest.raises(BadInput, match="damping"):
        system(parameters=parameters)
    geometry = {k: v for k, v in GEOMETRY.items() if k not in ("crank", "assembly")}
    with pytest.raises(BadInput, match=r"\['assembly', 'crank'\]"):
        system(geometry=geometry)
    values = {"lam2": 2.0, "mu": 0.3, "damping": 0.05}
    with pytest.raises(BadInput, match="'f'"):
        assemble(hill_plain, geometry={}, parameters=values)


def test_a_module_of_another_family_is_refused():
    with pytest.raises(BadInput, match="linear_periodic"):
        assemble(four_bar_kinematics, geometry=GEOMETRY, parameters={})
    with pytest.raises(BadInput, match="linear_periodic"):
        assemble(types.ModuleType("empty"), geometry={}, parameters={})
