"""Which test holds the error figure of which solver: a public name without one fails here."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import elastolink
import pytest
from elastolink.runtime.core.results import Result

HERE = Path(__file__).parent

# Two hundred random scenes and more against references of more digits, in this folder.
COVERED = {
    "balance": "test_balancing_errors.py",
    "boundary_derivatives": "test_hill_errors.py",
    "boundary_series": "test_hill_errors.py",
    "boundary_solution": "test_hill_solution_errors.py",
    "campbell": "test_speed_errors.py",
    "characteristic_exponents": "test_hill_errors.py",
    "clearance_range": "test_clearance_errors.py",
    "consistent_state": "test_constrained_errors.py",
    "constrained_motion": "test_constrained_errors.py",
    "coupler_curve": "test_curve_errors.py",
    "critical_damping": "test_hill_errors.py",
    "critical_speeds": "test_speed_errors.py",
    "damping_effect": "test_design_errors.py",
    "discriminant": "test_hill_errors.py",
    "fatigue": "test_design_errors.py",
    "floquet_multipliers": "test_periodic_errors.py",
    "flywheel_inertia": "test_machine_errors.py",
    "harmonics": "test_curve_errors.py",
    "hill_boundaries": "test_hill_errors.py",
    "krein_signatures": "test_band_errors.py",
    "length_effect": "test_design_errors.py",
    "monodromy": "test_periodic_errors.py",
    "natural_frequencies": "test_frequency_errors.py",
    "orbit_multipliers": "test_orbit_errors.py",
    "periodic_orbit": "test_orbit_errors.py",
    "perturbation_boundaries": "test_perturbation_errors.py",
    "pin_reactions": "test_beam_stress_errors.py",
    "prepare": "test_periodic_errors.py",
    "quiet_speeds": "test_design_errors.py",
    "recover": "test_beam_stress_errors.py",
    "reduced_system": "test_reduction_errors.py",
    "resonance_curve": "test_speed_errors.py",
    "rigid_forces": "test_force_errors.py",
    "run_through": "test_run_through_errors.py",
    "run_up": "test_machine_errors.py",
    "running_speed": "test_design_errors.py",
    "simulate": "test_periodic_errors.py",
    "speed_boundaries": "test_floquet_errors.py",
    "stability_chart": "test_rod_chart_errors.py",
    "stability_edges": "test_band_errors.py",
    "steady_peaks": "test_speed_errors.py",
    "steady_state": "test_periodic_errors.py",
    "stress": "test_beam_stress_errors.py",
    "stress_curve": "test_stress_curve_errors.py",
    "tolerances": "test_tolerance_errors.py",
    "tongue": "test_band_errors.py",
    "tongue_curves": "test_band_errors.py",
    "trade_off": "test_trade_off_errors.py",
    "transmission_angle": "test_machine_errors.py",
    "unstable_bands": "test_band_errors.py",
    "wittrick_williams": "test_frame_errors.py",
}
# Called in a helper of this name.
THROUGH = {"balance": "with_crank_counterweight"}
# The figure is that of another solver, which is called: the second name.
DELEGATED = {
    "driving_torque": "rigid_forces",
    "link_frequencies": "natural_frequencies",
    "pin_forces": "rigid_forces",
    "shaking_force": "rigid_forces",
    "shaking_moment": "rigid_forces",
    "sweep": "stability_chart",
    "trace_tongue": "stability_edges",
}
# Whole numbers, classes, or an approximation whose figure is another function's.
WITHOUT = {
    "classify": "exact arithmetic decides the class",
    "explain": "counts of terms, operations and bytes",
    "mobility": "a whole number",
    "screen": "says itself that it has none; screening_error measures it",
}


def _descendants(kind):
    for child in kind.__subclasses__():
        yield child
        yield from _descendants(child)


# Rooms with solvers beside those that `elastolink` itself names.
ROOMS = ("beams", "design", "frequencies", "periodic", "stability", "sweeps")


def _solvers():
    """Return the public functions that return a result; of the rooms, those listed here."""
    listed = {*COVERED, *DELEGATED, *WITHOUT}
    public = {name: getattr(elastolink, name) for name in elastolink.__all__}
    for room in ROOMS:
        module = import_module(f"elastolink.runtime.{room}")
        public |= {name: getattr(module, name) for name in listed & set(module.__all__)}
    names = {kind.__name__ for kind in _descendants(Result)} | {"Prepared", "ReducedSystem"}
    return {
        name
        for name, value in public.items()
        if not isinstance(value, type)
        and callable(value)
        and names & set(re.findall(r"\w+", str(value.__annotations__.get("return", ""))))
    }


def test_every_solver_has_a_place():
    listed = [*COVERED, *DELEGATED, *WITHOUT]
    assert sorted(listed) == sorted(set(listed)), "listed twice"
    assert set(listed) == _solvers()


@pytest.mark.parametrize("name", sorted(COVERED))
def test_the_file_named_tests_the_solver(name):
    text = (HERE / COVERED[name]).read_text()
    assert re.search(rf"\b{THROUGH.get(name, name)}\(", text)
    # Some count scenes, some the figures that come of them.
    assert re.search(r"\b(SCENES|SYSTEMS|ENDS|MACHINES|BARS|\d{3,})\b", text)


def test_those_that_hand_on_a_figure_hand_on_a_covered_one():
    assert set(DELEGATED.values()) <= set(COVERED)
