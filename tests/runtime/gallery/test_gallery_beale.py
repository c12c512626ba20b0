"""Beale & Scott's tip deflections, setting and chart in the gallery, by routes of their own."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import LinearRangeWarning
from elastolink.runtime.frequencies import natural_frequencies
from elastolink.runtime.gallery import (
    beale_chart,
    beale_free_free,
    beale_setting,
    beale_tip,
    figures,
)
from elastolink.runtime.gallery.beale_tip import FLEXIBLE, HEAVY, STIFF, peak, rod, stiff_tip
from elastolink.runtime.periodic import steady_state
from gallery_rows import require_rows
from rod_tip_deflections import TIPS

SLOW = {"2", "3", "5", "8", "9", "10", "chart"}
# How many numbers of each figure differ from the text for a stated reason.
DIFFERING = {"2": 2, "3": 1, "4": 2, "5": 3, "7": 0, "8": 2, "9": 1, "10": 1, "chart": 1}
# Tip deflection over the length at crank angles pi/4, ..., 2 pi, flexible rod, crank ratio 0.01,
# 100 rad/s, without tension: from a fixed mesh that knows of no modes.
FIXED_MESH = TIPS["flexible, ratio 0.01, 100 rad/s", False][1][:8]


@pytest.mark.parametrize(
    "label",
    [pytest.param(label, marks=pytest.mark.slow if label in SLOW else ()) for label in DIFFERING],
)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(label):
    gallery = require_rows("beale", label, DIFFERING[label])
    assert all(item.drawn.notes for item in gallery.shown)


def test_the_figures_that_were_promised_are_there_once():
    labels = [entry.label for entry in figures("beale")]
    assert labels == [*"234578", "9", "10", "11", "12", "resonances", "chart"]


def test_the_tip_from_rest_is_that_of_a_fixed_mesh():
    theta, tip = beale_tip.tip_from_rest(rod(FLEXIBLE, "overhang", 6), 100.0)
    step = (len(theta) - 1) // 8
    np.testing.assert_allclose(theta[step], np.pi / 4, rtol=1e-12)
    # Six overhang modes are within 1.3e-5 of the peak of the exact deflection.
    gap = np.max(np.abs(tip[step::step] - FIXED_MESH))
    assert gap < 2e-5 * peak(tip)


def test_steps_of_a_turn_are_enough():
    for scene, formulation, modes in ((STIFF, "polynomial", 6), (HEAVY, "overhang", 3)):
        system = rod(scene, formulation, modes)
        fewest, usual, more = (
            beale_tip.tip_from_rest(system, 90.0, steps=steps)[1] for steps in (720, 1440, 2880)
        )
        assert peak(more - usual) < 1e-6 * peak(more)
        assert peak(more - fewest) < 1e-6 * peak(more)


def test_constrained_and_linear_free_free_modes_agree_where_deflections_are_small():
    # Amplitude over length 1.5e-4: what the linear form leaves out is of its square.
    for modes in (1, 2):
        theta, tip, run = beale_free_free.constrained_tip(FLEXIBLE, modes)
        assert run.success
        linear = rod(FLEXIBLE, "free_free_linear", modes, ("tension",))
        angle, other = beale_tip.tip_from_rest(linear, 100.0)
        np.testing.assert_allclose(theta, angle, atol=1e-12)
        assert peak(tip - other) < 1e-4 * peak(other)


@pytest.mark.parametrize("scene", [STIFF, HEAVY])
def test_components_belong_to_a_deflection_across_the_rod(scene):
    theta, along, across = beale_setting.components(scene)
    tip = stiff_tip(scene, "overhang", 6, ())[1]
    np.testing.assert_allclose(np.hypot(along, across), np.abs(tip), atol=1e-13 * peak(tip))
    # The block at a_x + G e^(i theta) gives the rod's direction without the mechanism.
    block = 4.0 + 1.5 * np.exp(1j * theta)
    turned = (along + 1j * across) / (1j * block / np.abs(block))
    np.testing.assert_allclose(turned, tip, atol=1e-13 * peak(tip))


def test_foreshortening_turns_the_tip_by_an_angle_in_proportion_to_the_deflection():
    light, heavy = (
        beale_setting.lean(scene) / peak(stiff_tip(scene, "overhang", 6, ())[1])
        for scene in (STIFF, HEAVY)
    )
    # The bent shapes differ, but not by much: the first mode in both.
    assert 0.5 < light / heavy < 2.0


@pytest.mark.parametrize("place", [1, 3])
def test_the_settled_motion_is_the_steady_state(place):
    _, first, settled = beale_tip.damped_tip(HEAVY, place, 3)
    system = rod(HEAVY, "polynomial", 3, **beale_tip._DAMPINGS[place][1])
    with pytest.warns(LinearRangeWarning):
        steady = steady_state(system, 90.0, samples=1024)
    x = np.append(steady.theta, 2 * np.pi)
    y = np.append(steady.deflection(), steady.deflection()[0])
    angle = np.linspace(0.0, 2 * np.pi, len(settled))
    # Straight lines between the steady state's angles set what can be told.
    curvature = peak(np.diff(y, 2)) / 8
    assert peak(np.interp(angle, x, y) - settled) < 2 * curvature + 1e-5 * peak(settled)
    assert peak(first - settled) > 10 * curvature


def test_frequencies_at_crank_length_zero_are_those_of_another_basis():
    overhang = beale_chart.frequencies("overhang", 4)[:2]
    other = rod(FLEXIBLE, "two_segment", 8, links__crank_ratio=1e-6)
    np.testing.assert_allclose(overhang, natural_frequencies(other).mean[:2], rtol=2e-4)
    assert abs(overhang[0] - 858.228) < 1e-2


def test_the_command_redraws_a_figure(tmp_path, capsys):
    folder = tmp_path / "gallery"
    assert main(["reproduce", "beale", "--figure", "11", "--out", str(folder)]) == 0
    assert "mean first natural frequency" in capsys.readouterr().out
    assert sorted(path.name for path in folder.iterdir()) == ["beale_11.png", "index.html"]
