"""Ends of the four-bar's unstable bands against all nine freedoms, integrated at full resolution.

The bands come from five decoupled modes; the check integrates all of the modes, up to 30 000 rad/s,
and knows nothing of the decoupling or of the tables over the speed.
"""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.decoupled import slow_system
from elastolink.runtime.stability import stability_edges

# Where to look for the widest band: spread over the range of speeds.
PLACES = ((24.4, 24.6), (44.0, 45.0), (66.3, 66.5), (78.2, 78.3))
# Distance from the end, in widths of the band, at which the multipliers are looked at.
BESIDE = 1e-2


def four_bar(geometric_stiffness):
    overrides = {"mesh.elements": 1, "damping.ratio": 0.0}
    if not geometric_stiffness:
        overrides["model.drop"] = ["geometric_stiffness"]
    return el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()


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
    slow = slow_system(four_bar(False), (span[0] / 1.02, span[1] * 1.02), 5)
    bands = stability_edges(slow, span, margin=1.02)
    widest = int(np.nanargmax(bands.width))
    lower, upper = float(bands.lower[widest]), float(bands.upper[widest])
    width = upper - lower
    assert lower > span[0] and upper < span[1]
    rtol = 1e-11 if width < 1e-3 else 1e-10
    ends, largest, gaps = ends_by_all_modes(four_bar(False), lower, upper, rtol)
    # On the circle outside, off it inside, on either side of both ends.
    assert np.all(gaps[[0, 3]] > 0.0) and np.all(gaps[[1, 2]] < 0.0)
    assert np.all(largest[[1, 2]] > largest[[0, 3]])
    # The cubic is right to (n b / w)^2 BESIDE^2 of a width b, n turns; the rest is its own noise.
    turns = float(bands.harmonic[widest]) * width / lower
    allowed = bands.error[widest] + width * (BESIDE * turns) ** 2 + 1e-6 * width
    assert np.max(np.abs(ends - [lower, upper])) <= allowed


@pytest.mark.slow
def test_the_choice_of_modes_is_made_for_three_elements_a_link():
    system = el.load_scene(
        "aannaque_1996_table_4_1",
        overrides={
            "mesh.elements": 3,
            "damping.ratio": 0.0,
            "model.drop": ["geometric_stiffness"],
        },
    ).system()
    slow = slow_system(system, (20.0, 84.0))
    assert slow.modes == 7
    assert slow.residual < 1e-6
    # One number of passes for all speeds: the arrays are smooth in the speed.
    assert slow.fit < 1e-9
