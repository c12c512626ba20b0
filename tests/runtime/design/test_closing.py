"""The damping that closes regions: of one mode, two modes and beams, and its derivatives."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.design import closing_damping, sensitivities
from elastolink.runtime.scenes import with_numbers
from refusals import refused

SCENE = el.load_scene("smith_1972_5152_sixteenth_inch")
SYSTEM = SCENE.linear_system()
SPAN = (62.0, 86.0)
EDGES = el.stability_edges(SYSTEM, SPAN)


def _moduli(system, low, high):
    return np.abs(el.floquet_multipliers(system, np.linspace(low, high, 101)).multipliers)


def test_a_little_less_leaves_a_region_open_and_as_much_closes_it():
    found = closing_damping(SYSTEM, EDGES)
    assert found.region == EDGES.labels and found.passed and found.plot().get_ylabel()
    for i, (low, high) in enumerate(zip(EDGES.lower, EDGES.upper, strict=True)):
        assert low < found.speed[i] < high
        much, little = (
            SYSTEM.with_parameters(damping=found.damping[i] * factor) for factor in (1.001, 0.99)
        )
        assert np.all(_moduli(much, low, high) < 1.0)
        assert np.any(_moduli(little, low, high) > 1.0)
        # One mode: exactly what Hill's equation says, but that its K falls with the speed.
        form = el.hill_form(SYSTEM)
        f = form.function(found.speed[i])
        exact = el.critical_damping(f, 1.0, (int(EDGES.harmonic[i]),)).damping[0]
        unit = form.damping(damping=1.0) / (2.0 * found.speed[i])
        assert found.damping[i] * unit == pytest.approx(exact, rel=1e-2)


def test_what_has_damping_needs_the_same_in_all():
    some = SYSTEM.with_parameters(damping=0.1)
    edges = el.stability_edges(some, SPAN)
    more = closing_damping(some, edges)
    whole = dict(zip(EDGES.labels, closing_damping(SYSTEM, EDGES).damping, strict=True))
    for name, value in zip(more.region, more.damping, strict=True):
        assert np.isnan(value) or value == pytest.approx(whole[name], rel=1e-9)


def test_lengths_move_it_as_differences_of_whole_answers_do():
    found = closing_damping(SYSTEM, EDGES)
    slopes = sensitivities(SCENE, found, ["links.crank", "bending_stiffness"])
    # By its dimension it goes with the root of the stiffness.
    assert np.allclose(slopes.relative[:, 1], 0.5, rtol=0, atol=1e-7) and slopes.passed
    crank = SCENE.get("links.crank")

    def closed(factor):
        moved = with_numbers(SCENE, {"links.crank": factor * crank}).linear_system()
        return closing_damping(moved, el.stability_edges(moved, SPAN)).damping

    by_difference = (closed(1.0 + 1e-4) - closed(1.0 - 1e-4)) / (2e-4 * crank)
    np.testing.assert_allclose(slopes.derivative[:, 0], by_difference, rtol=1e-5)


def test_a_region_of_two_modes_together():
    system = el.load_scene("smith_1972_5152_sixteenth_inch", {"model.modes": 2}).linear_system()
    edges = el.stability_edges(system, (79.0, 112.0))
    found = closing_damping(system, edges)
    assert any(kind != "principal" for kind in edges.kind)
    for value, low, high in zip(found.damping, edges.lower, edges.upper, strict=True):
        if np.isfinite(value):
            moved = (system.with_parameters(damping=f * value) for f in (1.001, 0.98))
            much, little = (_moduli(one, low, high) for one in moved)
            assert np.all(much < 1.0) and np.any(little > 1.0)


def test_its_own_damping_and_the_speed_do_not_move_it():
    found = closing_damping(SYSTEM, EDGES)
    for name in ("damping", "speed"):
        with pytest.raises(el.BadInput, match=f"leave the {name} out"):
            sensitivities(SYSTEM, found, [name])


test_refusals = refused(
    closing_damping,
    [
        (SCENE, EDGES, "linear scene"),
        (SYSTEM, 3.0, "stability_edges"),
        (SYSTEM, EDGES, "drag", "one that damps"),
        (SYSTEM, EDGES, "follower_inertia", "does not close it"),
    ],
)
