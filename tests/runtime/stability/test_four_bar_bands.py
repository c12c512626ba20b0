"""Unstable bands of the four-bar of Aannaque's Table 4.1, undamped.

The bands come from the five lowest modes; the check of their ends integrates all nine, up to 30 000
rad/s, and knows nothing of the truncation or of the tables over the speed.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.frequencies.multiplier_maxima import multiplier_maxima
from elastolink.runtime.periodic import floquet_multipliers, monodromy, reduced_system
from elastolink.runtime.periodic.lowest_modes import LowestModes
from elastolink.runtime.stability import stability_edges

SPAN = (72.0, 73.0)
# The widest band below 75 rad/s: the first mode with itself.
INSIDE, OUTSIDE = 72.5964, 72.9


def four_bar(ratio=0.0):
    rigid = {"mesh.elements": 1, "model.drop": ["geometric_stiffness"]}
    overrides = {"damping.ratio": ratio, **rigid}
    return el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()


def test_the_widest_band_is_found_by_reduction_too():
    bands = stability_edges(four_bar(), SPAN, modes=5, margin=1.02)
    # Its checks: multipliers grow well inside every band, and nowhere else.
    assert bands.passed, bands.checks
    assert "sum" in {bands.kind[i] for i in np.flatnonzero(bands.width > 1e-4)}
    widest = int(np.nanargmax(bands.width))
    assert bands.labels[widest] == "region 5 of mode 1"
    assert bands.lower[widest] < INSIDE < bands.upper[widest] < OUTSIDE
    found = floquet_multipliers(reduced_system(four_bar(), 6), [INSIDE, OUTSIDE], rtol=1e-8)
    largest = np.max(np.abs(found.multipliers), axis=-1)
    # The modes left out move the band by 1e-5 of its speed, a hundredth of its width.
    assert abs(largest[0] - 1.02589) < 2e-3
    assert largest[1] < 1.0 + 1e-5


@pytest.mark.slow
def test_two_percent_of_damping_close_every_band():
    truncated, _ = LowestModes(four_bar(0.02)).required(SPAN[1], 5)
    speeds = np.append(np.linspace(*SPAN, 400), INSIDE)
    found = monodromy(truncated, speeds)
    largest = np.max(np.abs(np.linalg.eigvals(found.scaled)), axis=-1)
    assert np.max(largest) < 0.8


@pytest.mark.slow
def test_maxima_swept_on_few_modes_are_those_of_the_whole_linkage():
    system = four_bar(0.02)
    found = multiplier_maxima(system, (66.0, 68.0), 4)
    assert "natural modes" in found.method
    mode = int(np.argmax(found.height))
    centre, width = found.speed[mode], 0.05
    assert found.error[mode] < width
    speeds = [centre - width, centre, centre + width]
    before, there, after = floquet_multipliers(system, speeds).multipliers.real
    assert np.min(np.abs(there - found.height[mode])) < 5e-3
    assert max(np.max(before), np.max(after)) <= np.max(there)


# Ends against all nine freedoms

# Where to look for the widest band: spread over the range of speeds.
PLACES = ((24.4, 24.6), (44.0, 45.0), (66.3, 66.5), (78.2, 78.3))
# Distance from the end, in widths of the band, at which the multipliers are looked at.
BESIDE = 1e-2


def meeting_gap(multipliers, where):
    """Return -(r - s)^2 / (r s) of the two multipliers nearest to where they meet."""
    r, s = multipliers[np.argsort(np.abs(multipliers - where))[:2]]
    return float(np.real(-((r - s) ** 2) / (r * s)))


def ends_by_all_modes(system, lower, upper, rtol):
    """Return both ends by a cubic through the gap on either side of each, all modes resolved."""
    width = upper - lower
    beside = BESIDE * width
    speeds = np.array([lower - beside, lower + beside, upper - beside, upper + beside])
    found = floquet_multipliers(system, speeds, rtol=rtol)
    largest = np.max(np.abs(found.multipliers), axis=-1)
    gaps = []
    for row, inside in enumerate((1, 1, 2, 2)):
        growing = found.multipliers[inside, np.argmax(np.abs(found.multipliers[inside]))]
        gaps.append(meeting_gap(found.multipliers[row], growing / abs(growing)))
    cubic = np.polynomial.polynomial.polyfit((speeds - lower) / width, gaps, 3)
    roots = np.polynomial.polynomial.polyroots(cubic).real
    ends = [lower + width * roots[np.argmin(np.abs(roots - at))] for at in (0.0, 1.0)]
    return np.array(ends), largest, np.array(gaps)


@pytest.mark.slow
@pytest.mark.parametrize("span", PLACES)
def test_all_nine_freedoms_leave_the_circle_at_the_ends(span):
    bands = stability_edges(four_bar(), span, modes=5, margin=1.02)
    widest = int(np.nanargmax(bands.width))
    lower, upper = float(bands.lower[widest]), float(bands.upper[widest])
    width = upper - lower
    assert lower > span[0] and upper < span[1]
    rtol = 1e-11 if width < 1e-3 else 1e-10
    ends, largest, gaps = ends_by_all_modes(four_bar(), lower, upper, rtol)
    # On the circle outside, off it inside, on either side of both ends.
    assert np.all(gaps[[0, 3]] > 0.0) and np.all(gaps[[1, 2]] < 0.0)
    assert np.all(largest[[1, 2]] > largest[[0, 3]])
    # The cubic is right to (n b / w)^2 BESIDE^2 of a width b, n turns; the rest is its own noise.
    turns = float(bands.harmonic[widest]) * width / lower
    allowed = bands.error[widest] + width * (BESIDE * turns) ** 2 + 1e-6 * width
    assert np.max(np.abs(ends - [lower, upper])) <= allowed
