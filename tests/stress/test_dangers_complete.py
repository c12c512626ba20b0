"""The dangers that stress tests are for: which test faces each, and which figure it guards."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

HERE = Path(__file__).parent

# Danger, figure guarded, tests.
DANGERS = {
    "mode numbers from 1 to 100": (
        "bounds of frequencies; shapes stay finite; boundaries of high regions",
        [
            "test_conditioning_stress.py::test_every_mode_from_the_first_to_the_hundredth",
            "test_frame_stress.py::test_the_hundredth_mode",
            "test_hill_stress.py::test_high_regions",
            "test_rod_basis_stress.py::test_as_many_shapes_as_there_are",
        ],
    ),
    "an element whose length goes to zero": (
        "round-off of natural frequencies, or a refusal",
        [
            "test_conditioning_stress.py::test_an_element_whose_length_vanishes",
            "test_short_element_stress.py::test_a_held_bar_is_never_called_loose",
            "test_short_element_stress.py::test_a_linkage_with_a_short_element",
            "test_frame_stress.py::test_members_of_very_different_size",
            "test_beam_element_stress.py::test_any_positive_numbers_are_taken_or_refused",
        ],
    ),
    "thousands of oscillations in a revolution": (
        "monodromy, half trace, motion",
        [
            "test_floquet_stress.py::test_thousands_of_oscillations_per_revolution",
            "test_floquet_stress.py::test_fast_waves_over_many_revolutions",
            "test_hill_stress.py::test_thousands_of_oscillations_per_turn",
            "test_integrator_stress.py::test_constant_coefficients_are_exact_at_any_step",
        ],
    ),
    "a hair's breadth from a change point": (
        "motions, curves, harmonics and forces of linkages",
        [
            "test_kinematics_stress.py"
            "::test_speed_at_the_dead_centre_of_a_linkage_a_hair_from_its_change_point",
            "test_sliding_stress.py::test_slider_crank_a_hair_from_its_change_point",
            "test_sliding_stress.py::test_quick_return_a_hair_from_its_change_point",
            "test_curve_stress.py::test_a_hair_from_a_change_point",
            "test_constrained_stress.py::test_a_hair_from_a_branching_point",
        ],
    ),
    "marginal stability": (
        "multipliers, signs of charts, closing damping",
        [
            "test_floquet_stress.py::test_marginal_multipliers_stay_on_the_circle_within_their_error",
            "test_chart_stress.py::test_weak_combination_resonance_is_seen",
            "test_perturbation_stress.py::test_at_and_beyond_critical_damping",
            "test_conditioning_stress.py::test_a_hair_from_an_undamped_resonance",
        ],
    ),
    "growth by 1e200": (
        "multipliers, invariants, half traces",
        [
            "test_floquet_stress.py::test_growth_by_powers_of_ten",
            "test_chart_growth_stress.py::test_growth_that_overflows_is_unstable",
            "test_hill_stress.py::test_growth_beyond_the_range_of_doubles",
            "test_strong_damping_stress.py::test_small_multipliers_keep_their_relative_digits",
        ],
    ),
    "ill-conditioned bases": (
        "multipliers, arrays of the rod's bases, frequencies in any unit",
        [
            "test_conditioning_stress.py::test_coordinates_that_hardly_differ",
            "test_rod_basis_stress.py::test_frequencies_bound_the_exact_ones_from_above",
            "test_floquet_stress.py::test_units_do_not_matter",
            "test_constrained_stress.py::test_units_do_not_matter",
        ],
    ),
    "10 000 revolutions of a constrained system": (
        "norm of the constraints, return to the start",
        [
            "test_constrained_stress.py::test_the_rod_returns_after_ten_thousand_revolutions",
            "test_constrained_stress.py"
            "::test_the_pendulum_turns_ten_thousand_times_as_its_elliptic_function",
            "test_integrator_stress.py::test_thousands_of_revolutions_keep_the_energy",
        ],
    ),
    "random scenes": (
        "whatever is drawn is answered within its figure or refused",
        [
            "test_floquet_stress.py::test_random_systems_pass_their_own_checks",
            "test_curve_stress.py::test_any_four_bar_is_traced_or_refused",
            "test_perturbation_stress.py::test_anything_finite_is_answered_or_flagged",
            "test_hill_stress.py::test_any_box_is_within_its_figure",
            "test_classification_stress.py::test_classified_or_refused",
        ],
    ),
    "malformed scene files": (
        "one clear line for each problem",
        [
            "test_malformed_scenes.py::test_any_document_at_all",
            "test_malformed_scenes.py::test_a_file_with_a_random_cut",
            "test_malformed_scenes.py::test_every_problem_of_a_file_is_reported_at_once",
        ],
    ),
    "a step long beside the fastest mode": (
        "motion; or the refusal of an exponent that means nothing",
        [
            "test_integrator_stress.py::test_slow_modes_survive_steps_long_beside_the_fast_one",
        ],
    ),
    "coefficients that jump": (
        "monodromy",
        [
            "test_floquet_stress.py::test_coefficients_with_a_jump",
            "test_piecewise_stress.py::test_levels_over_thirty_decades",
        ],
    ),
    "an interrupt or a full disk": (
        "files whole or absent",
        ["test_interrupts.py::test_a_full_disk_leaves_the_old_file"],
    ),
    "a resonance met exactly": (
        "steady state: infinite, or refused",
        ["test_conditioning_stress.py::test_at_an_undamped_resonance_no_motion_is_claimed"],
    ),
}


@pytest.mark.parametrize("danger", sorted(DANGERS))
def test_each_danger_is_faced(danger):
    figure, tests = DANGERS[danger]
    assert figure and tests
    for name in tests:
        file, function = name.split("::")
        text = (HERE / file).read_text()
        assert re.search(rf"^def {function}\(", text, re.MULTILINE), name


def test_each_file_says_what_it_is_for():
    for path in sorted(HERE.glob("test_*.py")):
        first = path.read_text().splitlines()[0]
        assert first.startswith('"""') or path.name in _NAMED_BY_THEIR_TESTS, path.name


# Their tests' names and first lines say which danger each faces.
_NAMED_BY_THEIR_TESTS = {"test_hill_stress.py"}
