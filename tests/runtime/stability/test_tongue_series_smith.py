"""Second-mode and combination tongues of Smith's 1/16 inch rig with two modes.

Smith, chapter 9, suggestion 1: what his theory of a single mode leaves out.
The exact ends come from tracing the multipliers (:func:`stability_edges`), another route.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink import load_scene
from elastolink.runtime.floquet import speed_boundaries
from elastolink.runtime.stability import resonances, tongue
from elastolink.runtime.floquet.edges.tracing import stability_edges

SPAN = (38.0, 95.0)


@pytest.fixture(scope="module")
def rig():
    overrides = {"model.modes": 2}
    return load_scene("smith_1972_5152_sixteenth_inch", overrides=overrides).system()


@pytest.fixture(scope="module")
def exact(rig):
    found = stability_edges(rig, speed_range=SPAN)
    return {
        (kind, tuple(modes), int(harmonic)): (lower, upper)
        for kind, modes, harmonic, lower, upper in zip(
            found.kind,
            found.modes.tolist(),
            found.harmonic,
            found.lower,
            found.upper,
            strict=True,
        )
    }


def _resonance(rig, label):
    return next(item for item in resonances(rig, SPAN, highest=16) if item.label == label)


def test_which_resonances_there_are(rig):
    found = resonances(rig, SPAN, highest=10)
    labels = [item.label for item in found]
    assert [label for label in labels if "+" in label] == ["w1 + w2 = 9 w", "w1 + w2 = 10 w"]
    assert all(item.opens == (item.kind != "difference") for item in found)
    assert all(np.ptp(item.signatures) == 0 for item in found if item.kind == "difference")
    assert {"2 w1 = 4 w", "w2 - w1 = 6 w"} < set(labels)


@pytest.mark.parametrize(
    ("label", "figure"),
    [
        # The largest figures at order 4 [rad/s]: speeds are near 80, or 1 per cent and better.
        ("2 w1 = 8 w", 0.003),
        ("2 w1 = 7 w", 0.015),
        ("2 w1 = 6 w", 0.08),
        ("2 w2 = 16 w", 0.002),
        ("2 w2 = 15 w", 0.004),
        ("2 w2 = 14 w", 0.008),
        ("w1 + w2 = 16 w", 0.005),
        ("w1 + w2 = 14 w", 0.015),
        ("w1 + w2 = 12 w", 0.04),
        ("w1 + w2 = 10 w", 0.3),
        ("w1 + w2 = 9 w", 0.3),
    ],
)
def test_tongues_against_the_exact_tracing(rig, exact, label, figure):
    resonance = _resonance(rig, label)
    lower, upper = exact[resonance.kind, resonance.modes, resonance.harmonic]
    found = tongue(rig, resonance, order=4)
    assert found.expansion == "periodic"
    actual = max(abs(found.lower - lower), abs(found.upper - upper))
    assert actual <= found.error <= figure
    # The mean equation alone is much farther off.
    assert actual < 0.6 * abs(resonance.speed - (lower + upper) / 2)


def test_higher_orders_come_nearer(rig, exact):
    resonance = _resonance(rig, "2 w1 = 8 w")
    ends = exact[resonance.kind, resonance.modes, resonance.harmonic]
    errors = [
        max(abs(found.lower - ends[0]), abs(found.upper - ends[1]))
        for found in (tongue(rig, resonance, order=order) for order in (2, 4, 6))
    ]
    assert np.all(np.diff(np.log10(errors)) < -0.9)
    assert errors[-1] < 1e-4


def test_four_exponents_that_nearly_meet_are_treated_together(rig, exact):
    # 2 w1 = 4 w lies beside w1 + w2 = 10 w: alone the pair's series diverges.
    resonance = _resonance(rig, "w1 + w2 = 10 w")
    ends = exact[resonance.kind, resonance.modes, resonance.harmonic]
    together = tongue(rig, resonance, order=6)
    alone = tongue(rig, resonance, order=6, merge=0.0)
    assert (together.dimension, alone.dimension) == (4, 2)
    assert abs(together.lower - ends[0]) < 0.03 < abs(alone.lower - ends[0])
    assert together.open
    # Below order 4 the wide tongue of the first mode hides the other, and that is said.
    hidden = tongue(rig, resonance, order=2)
    assert np.isnan(hidden.lower)
    assert not hidden.checks["told apart"].passed


def test_over_the_follower_inertia(rig):
    resonance = _resonance(rig, "2 w1 = 8 w")
    inertia = rig.parameters["follower_inertia"] * np.array([1.0, 2.0])
    found = tongue(rig, resonance, parameter=("follower_inertia", inertia), order=5)
    for k, value in enumerate(inertia):
        edges = speed_boundaries(rig, 1, speed_range=(40.6, 41.2), follower_inertia=value).speed
        # The only region here that has a width to speak of; figures within 0.05 per cent.
        widest = int(np.argmax(np.diff(edges)[::2])) * 2
        assert abs(found.lower[k] - edges[widest]) <= found.error[k] < 0.02
        assert abs(found.upper[k] - edges[widest + 1]) <= found.error[k]
    assert np.all(np.diff(found.width) > 0)


def test_damping_of_the_rig_closes_the_combination_tongues(rig):
    # A decrement of 0.05, the lowest that Smith observed (section 9.5.5), of the first mode.
    first = _resonance(rig, "2 w1 = 6 w").frequencies[0]
    drag = 2 * (0.05 / (2 * np.pi)) * first * rig.parameters["mass_per_length"]
    for label in ("w1 + w2 = 12 w", "2 w2 = 14 w"):
        resonance = _resonance(rig, label)
        found = tongue(rig, resonance, order=3, damping_factor=[0.0, 1.0], damping=drag)
        assert found.open.tolist() == [True, False]
