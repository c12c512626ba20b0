"""From an emitted module and numbers to the system: shapes, sharing, what is refused."""

import types

import numpy as np
from elastolink.generated import four_bar_coupler_complete, four_bar_kinematics, hill_plain
from elastolink.runtime.systems import assemble
from refusals import refused

GEOMETRY = {"frame": 5.0, "crank": 1.0, "coupler": 5.0, "follower": 2.0, "assembly": 1.0}
PARAMETERS = {
    "bending_stiffness": 3.0,
    "mass_per_length": 0.7,
    "damping": 0.2,
    "coupler_inertia": 0.9,
    "coupler_first_moment": 0.5,
    "follower_inertia": 1.3,
}
HILL = {"lam2": 2.0, "mu": 0.3, "damping": 0.05}
THETA = np.array([0.1, 2.0, 5.0])


def system(module=four_bar_coupler_complete, **changes):
    options = {"geometry": GEOMETRY, "parameters": PARAMETERS, "modes": 3, **changes}
    return assemble(module, **options)


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
    found = assemble(hill_plain, geometry={}, parameters=HILL, external={"f": np.cos})
    assert found.size == 1
    np.testing.assert_allclose(found.array("Kg", THETA)[:, 0, 0], 0.3 * np.cos(THETA), rtol=1e-15)
    np.testing.assert_array_equal(found.array("C", THETA)[:, 0, 0], [0.1] * 3)
    np.testing.assert_array_equal(found.array("K", THETA)[:, 0, 0], [2.0] * 3)


def without(numbers, *names):
    return {name: value for name, value in numbers.items() if name not in names}


PLAIN = {"module": hill_plain, "geometry": {}, "parameters": HILL, "modes": None}
test_what_does_not_fit_is_named = refused(
    lambda given: system(**given),
    [
        *(({"modes": modes}, "a number of modes, from 1") for modes in (None, 0, -1)),
        ({**PLAIN, "external": {"f": np.cos}, "modes": 2}, "modes: found 2; expected 1"),
        ({"parameters": without(PARAMETERS, "damping")}, "damping"),
        ({"geometry": without(GEOMETRY, "crank", "assembly")}, r"\['assembly', 'crank'\]"),
        (PLAIN, "'f'"),
        ({"module": four_bar_kinematics}, "linear_periodic"),
        ({"module": types.ModuleType("empty")}, "linear_periodic"),
    ],
)
