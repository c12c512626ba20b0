"""The gallery's frequency responses of Smith's rigs."""

import numpy as np
import pytest
from elastolink.runtime.gallery import smith_responses
from elastolink.runtime.gallery.smith_linkages import RPM
from elastolink.runtime.periodic import steady_peaks
from gallery_rows import require_rows

# Figure, and how many of its numbers are known to differ.
QUICK = (("54", 0), ("55", 0), ("62", 1), ("79", 0))
SLOW = (
    *(("52", 0), ("53", 1), ("56", 0), ("57", 1), ("58", 1), ("59", 0), ("60", 0), ("61", 0)),
    *(("63", 1), ("65", 1), ("66", 1), ("67", 0), ("68", 0), ("74", 0), ("75", 1), ("76", 0)),
    ("80", 0),
)


@pytest.mark.parametrize(("label", "differing"), QUICK)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(label, differing):
    require_rows("smith", label, differing)


@pytest.mark.slow
@pytest.mark.parametrize(("label", "differing"), SLOW)
def test_every_other_quoted_number_does_too(label, differing):
    require_rows("smith", label, differing, quoted=label != "67")


def test_all_figures_have_an_entry_or_a_reason():
    drawn = {int(one.figure) for one in smith_responses.RESPONSES} | {54, 55}
    reasons = {64, 69, 70, 71, 72, 73, 77, 78}
    assert drawn | reasons == set(range(52, 81))
    assert not drawn & reasons


def test_extremes_are_those_of_the_steady_peaks():
    one = smith_responses.RESPONSE["79"]
    decrement = smith_responses.decrements(one.rig)[1]
    found = smith_responses.envelope("79", decrement)
    system = smith_responses.coupler(one.rig.scene, one.inertia, decrement)
    chosen = [0, 100, 200]
    peaks = steady_peaks(system, found.speed[chosen] * RPM, x=[0.5])
    size = np.maximum(found.greatest, -found.least)[chosen]
    # Both take the largest of even angles, here 256 or more of them.
    assert size == pytest.approx(1e3 * peaks.peak, rel=1e-3)


def test_more_damping_lowers_a_resonance():
    least, middle, greatest = smith_responses.decrements(smith_responses.RESPONSE["62"].rig)
    heights = [
        np.max(smith_responses.envelope("62", value).greatest)
        for value in (least, middle, greatest)
    ]
    assert heights[0] > heights[1] > heights[2]


def test_the_nearest_maximum_is_found():
    assert smith_responses.resonance("79", 400.0) == pytest.approx(391.0, abs=2.0)
    assert smith_responses.resonance("79", 530.0) == pytest.approx(520.0, abs=2.0)
