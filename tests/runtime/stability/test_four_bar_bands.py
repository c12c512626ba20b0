"""Unstable bands of the four-bar of Aannaque's Table 4.1, undamped, one element to a link."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.frequencies.multiplier_maxima import multiplier_maxima
from elastolink.runtime.periodic import floquet_multipliers, monodromy, reduced_system
from elastolink.runtime.periodic.decoupled import SlowModes, slow_system
from elastolink.runtime.stability import stability_edges

SPAN = (72.0, 73.0)
# The widest band below 75 rad/s: the first mode with itself.
INSIDE, OUTSIDE = 72.5964, 72.9


def four_bar(ratio=0.0):
    overrides = {
        "mesh.elements": 1,
        "damping.ratio": ratio,
        "model.drop": ["geometric_stiffness"],
    }
    return el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()


@pytest.fixture(scope="module")
def slow():
    return slow_system(four_bar(), (SPAN[0] / 1.02, SPAN[1] * 1.02), 5)


@pytest.fixture(scope="module")
def bands(slow):
    return stability_edges(slow, SPAN, margin=1.02)


def test_multipliers_are_on_the_circle_outside_the_bands(slow, bands):
    speeds = np.linspace(*SPAN, 80)
    margin = 1e-3
    near = (speeds[:, None] > bands.lower - margin) & (speeds[:, None] < bands.upper + margin)
    outside = speeds[~np.any(near, axis=1)][:40]
    assert len(outside) == 40
    found = floquet_multipliers(slow.system, outside)
    assert np.max(np.abs(np.abs(found.multipliers) - 1.0)) <= 1e-10


def test_multipliers_grow_inside_every_open_band(slow, bands):
    wide = np.flatnonzero(bands.width > 1e-4)
    assert len(wide) >= 3
    middle = 0.5 * (bands.lower + bands.upper)[wide]
    found = floquet_multipliers(slow.system, middle)
    assert np.all(np.max(np.abs(found.multipliers), axis=-1) > 1.0 + 1e-8)
    kinds = {bands.kind[i] for i in wide}
    assert "principal" in kinds and "sum" in kinds


def test_the_widest_band_is_found_by_reduction_too(bands):
    widest = int(np.nanargmax(bands.width))
    assert bands.labels[widest] == "region 5 of mode 1"
    assert bands.lower[widest] < INSIDE < bands.upper[widest] < OUTSIDE
    found = floquet_multipliers(reduced_system(four_bar(), 6), [INSIDE, OUTSIDE], rtol=1e-8)
    largest = np.max(np.abs(found.multipliers), axis=-1)
    # The modes left out move the band by 1e-5 of its speed, a hundredth of its width.
    assert abs(largest[0] - 1.02589) < 2e-3
    assert largest[1] < 1.0 + 1e-5


@pytest.mark.slow
def test_all_nine_freedoms_grow_as_the_slow_modes_do():
    found = floquet_multipliers(four_bar(), INSIDE, rtol=1e-7)
    assert abs(np.max(np.abs(found.multipliers)) - 1.0258942) < 1e-5


@pytest.mark.slow
def test_two_percent_of_damping_close_every_band():
    damped = slow_system(four_bar(0.02), SPAN, 5)
    speeds = np.append(np.linspace(*SPAN, 400), INSIDE)
    found = monodromy(damped.system, speeds)
    largest = np.max(np.abs(np.linalg.eigvals(found.scaled)), axis=-1)
    assert np.max(largest) < 0.8


@pytest.mark.slow
def test_maxima_swept_on_few_modes_are_those_of_the_whole_linkage():
    system = four_bar(0.02)
    found = multiplier_maxima(system, (66.0, 68.0))
    assert "natural modes" in found.method
    mode = int(np.argmax(found.value))
    centre, width = found.speed[mode], 0.05
    assert found.error[mode] < width
    slow = SlowModes(system)
    before, there, after = (
        slow.motions(speed, 4).multipliers()[0].real
        for speed in (centre - width, centre, centre + width)
    )
    assert np.min(np.abs(there - found.value[mode])) < 5e-3
    assert max(np.max(before), np.max(after)) <= np.max(there)
