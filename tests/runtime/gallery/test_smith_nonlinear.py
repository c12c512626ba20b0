"""What the gallery computes by the nonlinear equation of Smith's coupler, by other routes."""

import numpy as np
import pytest
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.gallery import smith_nonlinear
from elastolink.runtime.gallery.smith_linkages import RIG, RIGS, RPM
from elastolink.runtime.gallery.smith_nonlinear import BENCHES, Bench
from elastolink.runtime.periodic import steady_state

# The resonance at Omega/3 with the heaviest follower, up to its fold.
FOLD = BENCHES["third_greatest"]


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.figure)
def test_the_decrement_taken_is_the_geometric_mean_of_those_measured(rig):
    least, _, most = rig.decrements
    assert rig.decrement == pytest.approx(np.sqrt(least * most), rel=0.06)


@pytest.mark.parametrize("rig", [RIGS[0], RIGS[3]], ids=lambda rig: rig.figure)
def test_the_linear_deflection_is_that_of_the_complete_equation(rig):
    one, speed = smith_nonlinear._Deflection(rig), 0.23 * rig.frequency
    linear = steady_state(rig.system(decrement=rig.decrement, inertia=0.0058), speed, samples=1024)
    assert one.linear(speed) == pytest.approx(np.max(np.abs(linear.q[:, 0])), rel=2e-4)
    # At half a per cent of the length both equations say the same.
    assert one.nonlinear(speed) == pytest.approx(one.linear(speed), rel=2e-3)
    assert one.nonlinear(speed) != pytest.approx(one.linear(speed), rel=1e-6)


def test_the_top_of_a_resonance_is_where_its_parabola_has_it():
    place, height = smith_nonlinear._top(lambda v: 1.0 / ((v - 9.873) ** 2 + 0.01), 10.0)
    assert place == pytest.approx(9.873, abs=1e-6) and height == pytest.approx(100.0, rel=1e-6)


@pytest.mark.slow
def test_a_rising_speed_jumps_at_the_fold_that_is_read():
    rise = FOLD.reading("rise")
    below, above = (FOLD.stable(rise + gap, 1) for gap in (-0.5, 0.5))
    assert (below, above) == (1, 0)
    near = Bench(FOLD.chart, FOLD.inertia, 0.0, 0.0, first=rise - 4.0, last=rise + 8.0, rate=2.0)
    way = smith_nonlinear._way(near, True)
    before, after = (way.within(rise + gap - 1.0, rise + gap).size for gap in (-1.0, 6.0))
    assert np.ptp(before) < 0.1 * np.max(before) and np.max(after) > 1.5 * np.max(before)


def test_harmonics_and_doublings_are_read_where_the_branch_has_them():
    one = BENCHES["third_least"]
    system = RIG["82"].system(decrement=0.2, inertia=0.0058)
    speeds = np.linspace(0.97, 1.0, 31) * one.rig.frequency / 3
    sizes = np.abs(np.fft.rfft(steady_state(system, speeds).q[..., 0], axis=-1))[:, 3]
    linear = speeds[np.argmax(sizes)] / RPM
    # Softened by less than the 2 % that a deflection of 4 % of the length makes of it.
    assert 0.98 * linear < one.reading("peak", 3) < linear
    fifths = BENCHES["fifths"]
    onset, end, middle = (fifths.reading(kind) for kind in ("onset", "end", "middle"))
    assert middle == 0.5 * (onset + end)
    inside = [fifths.stable(speed, 1) for speed in (onset - 1, middle, end + 1)]
    assert inside == [1, 0, 1]


def test_stable_motions_are_drawn_solid_and_others_dotted():
    ax, curve = new_figure().add_subplot(), smith_nonlinear.branches(FOLD)
    curve.draw(ax, curve.peak_to_peak)
    styles = [line.get_linestyle() for line in ax.lines]
    # Up to the first fold, back to the second one, up to a doubling, and beyond.
    assert styles == ["-", ":", "-", ":"]
    solid, dotted, *_ = (line.get_xydata() for line in ax.lines)
    np.testing.assert_array_equal(solid[-1], dotted[0])
    assert np.max(solid[:, 0]) == pytest.approx(FOLD.reading("rise"), abs=0.01)
