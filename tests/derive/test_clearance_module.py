"""Emitted ranges of play: Smith (3.1)-(3.3), trial of the pin, and the run time's own route.

The measure of every output at all points is that of ``emitted_accuracy``.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.generated import four_bar_clearance
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.linkages.clearance import clearance_range
from linkage_truth import LENGTHS, random_points

NAMES = four_bar_clearance.RETURNS["extremes"]
LONG_CRANK = {"frame": 10.0, "crank": 8.0, "turning": 10.0, "opposite": 10.0}
SHAPES = (
    LONG_CRANK,
    {"frame": 5.0, "crank": 1.0, "turning": 2.0, "opposite": 5.0},
    {"frame": 2.0, "crank": 4.0, "turning": 4.5, "opposite": 5.0},
)


def emitted(theta, play, lengths):
    with np.errstate(divide="ignore"):
        values = four_bar_clearance.extremes(theta, **lengths, play=play)
    return dict(zip(NAMES, values, strict=True))


def diagonal(theta, lengths):
    """Return BD by the law of cosines."""
    frame, crank = lengths["frame"], lengths["crank"]
    return np.sqrt(frame**2 + crank**2 - 2 * frame * crank * np.cos(theta))


@pytest.mark.parametrize("lengths", SHAPES)
@pytest.mark.parametrize("clearance", [1e-3, 0.1, 0.5])
def test_smiths_exact_equations(lengths, clearance):
    """(3.1), and (3.2) with c^2/4 in the place of the printed c^2/l4."""
    theta = np.linspace(0.1, 6.1, 25)
    found = emitted(theta, clearance / 2, lengths)
    below = 2 * diagonal(theta, lengths) * lengths["turning"]
    cosine = np.cos(found["angle"])
    for end, sign in (
        (found["angle"] + found["opened"], 1),
        (found["angle"] - found["closed"], -1),
    ):
        right = (lengths["opposite"] * clearance + sign * clearance**2 / 4) / below
        np.testing.assert_allclose(sign * (cosine - np.cos(end)), right, rtol=0, atol=1e-14)


@pytest.mark.parametrize("base, angle", [(20.0, 0.0), (4.0, np.pi)])
def test_links_in_line(base, angle):
    """At a dead position the range is one-sided; the link may leave on either side of the line."""
    own, other, clearance = (10.0, 10.0, 1.0) if angle == 0.0 else (6.0, 10.0, 1.0)
    lengths = {"frame": base + 1.0, "crank": 1.0, "turning": own, "opposite": other}
    found = emitted(0.0, clearance / 2, lengths)
    assert found["angle"] == pytest.approx(angle, abs=1e-15)
    assert found["free"] == 0.0 and np.isinf(found["small"])
    change = (other * clearance + (1 if angle == 0.0 else -1) * clearance**2 / 4) / (2 * base * own)
    moved, held = ("opened", "closed") if angle == 0.0 else ("closed", "opened")
    assert found[held] == 0.0
    # 1 - cos = change, by the half-angle.
    assert found[moved] == pytest.approx(2 * np.arcsin(np.sqrt(change / 2)), rel=1e-14)


def test_vanishing_clearances_keep_their_digits():
    for play in (1e-9, 1e-100, 1e-250):
        found = emitted(1.0, play, LONG_CRANK)
        for side in ("opened", "closed"):
            assert found[side] == pytest.approx(found["small"] / 2, rel=2e-9)


@pytest.mark.parametrize("link", ["follower", "coupler"])
def test_the_run_time_goes_another_way_to_the_same_numbers(link):
    """``clearance_range`` takes differences of half-angles from those of their squared sines."""
    seen = 0
    for point in random_points(60, seed=9):
        sizes = {name: point.inputs[name] for name in LENGTHS}
        other = "coupler" if link == "follower" else "follower"
        play = 0.01 * min(sizes[link], sizes[other])
        lengths = {"frame": sizes["frame"], "crank": sizes["crank"]}
        lengths |= {"turning": sizes[link], "opposite": sizes[other]}
        theta = point.inputs["theta2"]
        direct = emitted(theta, play, lengths)
        if direct["free"] == 0.0:
            continue
        assembly = "open" if point.fixed["assembly"] > 0 else "crossed"
        found = clearance_range(FourBar(**sizes, assembly=assembly), 2 * play, theta, link=link)
        # Opening lowers the follower's angle and raises the coupler's in the open assembly.
        raises = (link == "coupler") == (assembly == "open")
        up, down = ("opened", "closed") if raises else ("closed", "opened")
        # What a round-off of the crank angle does comes on top of the figure.
        slack = 1e-13 * (1 + abs(theta)) * found.width / np.sin(direct["angle"]) ** 2
        assert found.above == pytest.approx(direct[up], rel=0, abs=float(found.error + slack))
        assert found.below == pytest.approx(direct[down], rel=0, abs=float(found.error + slack))
        seen += 1
    assert seen > 40


def test_the_movement_is_convex_in_the_square_of_the_diagonal():
    """So a turning crank has its greatest movement at 0 or 180 deg, whatever the clearance."""
    lengths = {"frame": 10.0, "crank": 3.0, "turning": 8.0, "opposite": 6.0}
    squares = np.linspace(49.0, 169.0, 401)
    theta = np.arccos(np.clip((109.0 - squares) / 60.0, -1.0, 1.0))
    found = emitted(theta, 0.2, lengths)
    movement = found["opened"] + found["closed"]
    assert np.all(np.diff(movement, 2) > 0.0)
    with mpmath.workdps(50):
        base = mpmath.mpf(13)
        ends = [
            mpmath.acos((base**2 + 64 - side**2) / (2 * base * 8))
            for side in (mpmath.mpf("6.2"), mpmath.mpf("5.8"))
        ]
        assert float(ends[0] - ends[1]) == pytest.approx(movement.max(), rel=1e-12)
