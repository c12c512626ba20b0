"""The gallery's figures of Aannaque's rig: paths, modes, largest stresses, appendices."""

import numpy as np
import pytest
from elastolink.runtime.gallery import (
    aannaque_appendices,
    aannaque_measured,
    aannaque_modes,
    aannaque_paths,
    aannaque_rig,
    figures,
    reproduce,
)
from gallery_rows import require_rows

# Figure, and how many of its numbers are known to differ.
QUICK = (("8.3", 0), ("8.9", 0), ("8.18", 1), ("9.1", 0))
SLOW = (
    *((label, 0) for label in ("8.2", "8.4", *(f"8.{k}" for k in range(10, 18)))),
    *(("8.19", 0), ("8.20", 0), ("8.21", 0), ("8.22", 1), ("8.23", 1)),
    *(("8.24", 0), ("8.25", 0), ("8.26", 0)),
)


@pytest.mark.parametrize(("label", "differing"), QUICK)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(label, differing):
    require_rows("aannaque", label, differing)


@pytest.mark.slow
@pytest.mark.parametrize(("label", "differing"), SLOW)
def test_every_other_quoted_number_does_too(label, differing):
    require_rows("aannaque", label, differing)


@pytest.mark.slow
@pytest.mark.parametrize("letter", ["C", "D"])
def test_every_sheet_of_an_appendix(letter):
    gallery = reproduce("aannaque", letter)
    assert len(gallery.shown) == len(aannaque_appendices.sheets(letter))
    assert [name for name, check in gallery.checks.items() if not check.passed] == []


def test_sheets_hold_each_figure_of_an_appendix_once():
    for letter, count in (("C", 24), ("D", 26)):
        sheets = aannaque_appendices.sheets(letter)
        assert [number for sheet in sheets for number in sheet] == list(range(1, count + 1))
        assert list(aannaque_appendices.speeds_of(letter)) == sorted(
            aannaque_appendices.speeds_of(letter)
        )


def test_a_figure_on_a_sheet_chooses_the_sheet():
    (entry,) = figures("aannaque", "C.8")
    assert entry.label == "C.7-C.12"
    assert entry.stem == "aannaque_C_07C_12"
    assert [entry.label for entry in figures("aannaque", "d.26")] == ["D.21-D.26"]
    assert len(figures("aannaque", "C")) == 4


def test_stresses_of_a_cycle_are_those_of_the_curve_over_the_speed():
    # Two routes: the full equations at some speeds, and the sweep on moving modes.
    speeds = (11.1, 17.725, 24.35)
    found = aannaque_rig.cycles(aannaque_rig.SHORT, aannaque_rig.FRAME, speeds)
    swept = aannaque_rig.curve(aannaque_rig.SHORT, aannaque_rig.FRAME, *speeds[::2], 3)
    stations = {"crank": 0.0, "coupler": 0.5, "follower": 0.5}
    size = np.stack([np.max(np.abs(found.stress[pair]), axis=1) for pair in stations.items()], -1)
    # The sweep's error, and a peak between 256 angles: (pi/256)^2/2 times its harmonic squared.
    tolerance = 1e-3 + 0.5 * (6 * np.pi / 256) ** 2
    whole = np.stack([swept.of(link) for link in stations], axis=-1)
    own = np.stack([swept.fibre[:, swept.links.index(link)] for link in stations], axis=-1) > 0
    assert np.any(own) and np.any(~own)
    np.testing.assert_allclose(size[own], whole[own], rtol=tolerance)
    # Where the other fibre has the largest stress, this one's is less.
    assert np.all(size[~own] < whole[~own] * (1 + tolerance))


def test_maxima_stand_out_by_the_share_asked_for():
    x = np.linspace(0.0, 10.0, 401)
    y = np.exp(np.log(1.1) * np.exp(-(((x - 3.013) / 0.2) ** 2)))
    y *= np.exp(np.log(1.02) * np.exp(-(((x - 7.0) / 0.2) ** 2)))
    # A parabola through three places, an eighth of the width apart, is off by its cube.
    assert aannaque_rig.tops(x, y, 0.05) == pytest.approx([3.013], abs=2e-4)
    assert len(aannaque_rig.tops(x, y, 0.01)) == 2


def test_the_ten_angles_are_even():
    np.testing.assert_array_equal(np.diff(aannaque_modes.ANGLES), 36)
    assert len(aannaque_modes.ANGLES) == 10
    assert aannaque_modes.CAPTIONS[:-1] == aannaque_modes.ANGLES[:-1]


def test_lengths_at_which_both_pinned_links_vibrate_alike():
    # sqrt(I/A) is what the sections differ by; lengths go with its square root.
    ratio = np.sqrt(83.34 / 85.5) / np.sqrt(65.12 / 78.75)
    assert aannaque_modes.crossing() == pytest.approx(0.525 * np.sqrt(ratio), rel=1e-12)


def test_the_slow_path_moves_as_the_squared_speed():
    slow, slower = (aannaque_paths.midpoint(speed) for speed in (3.0, 1.5))
    # Far below the lowest resonance inertia forces alone count, and their square of the speed.
    assert slow.largest / slower.largest == pytest.approx(4.0, rel=0.02)


def test_the_second_mode_explains_what_the_first_does_not():
    assert aannaque_measured.mean_frequency(aannaque_rig.LONG, 0.547, 1) < 130.0
    assert aannaque_measured.mean_frequency(aannaque_rig.LONG, 0.547, 2) > 150.0
