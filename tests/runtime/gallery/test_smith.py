"""What the gallery computes for Smith's figures, by other routes."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.gallery import smith_equation, smith_speeds
from elastolink.runtime.gallery.sketch import free_bodies
from elastolink.runtime.gallery.smith_balancing import (
    INCH,
    TURN,
    example,
    offset_function,
    optimal_offset,
    peak,
    relative_inertia,
)
from elastolink.runtime.gallery.smith_linkages import (
    LBF_IN_S2,
    RIGS,
    RPM,
    end_load,
    four_bar_of,
    linkage_of,
    series,
)
from elastolink.runtime.gallery.smith_responses import Response, envelope
from elastolink.runtime.gallery.smith_speeds import OBSERVATIONS
from elastolink.runtime.hill import hill_boundaries
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.rigid import case_counterweights, rigid_forces, with_counterweights
from elastolink.runtime.scenes import load_scene

# Deflections leave the linear range at resonances; the equations stay linear.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")

MP = mpmath.mp.clone()
MP.dps = 400
# Fig. 79.
LAST = Response("84", 0.0058, 200.0, 600.0)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.figure)
def test_the_reduced_coefficient_is_eps3_times_f3(rig):
    # Two routes: the emitted module, and f3 and eps3 as defined under Smith (6.17).
    scene = load_scene(rig.scene)
    inertia = float(rig.inertias[3])
    coupler, follower = scene["links"]["coupler"], scene["links"]["follower"]
    eps3 = inertia * np.pi**2 / (scene["coupler"]["mass_per_length"] * coupler**2 * follower)
    theta = np.linspace(0.0, 2 * np.pi, 50)
    expected = eps3 * end_load(linkage_of(rig.linkage), theta)["f3"]
    np.testing.assert_allclose(rig.function("reduced", inertia)(theta), expected, atol=1e-11)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.figure)
def test_what_the_printed_equation_leaves_out_is_the_part_by_hand(rig):
    inertia = float(rig.inertias[0])
    complete, printed = (rig.function(name, inertia)(TURN) for name in ("complete", "printed"))
    *_, tension, more = smith_speeds._terms(rig.linkage, TURN).values()
    np.testing.assert_allclose(complete - printed, tension + more, rtol=0.0, atol=1e-10)


def test_ends_in_a_batch_are_those_one_by_one():
    rig, regions = RIGS[0], (4, 5)
    for equation in ("reduced", "complete"):
        together = rig.ends(equation, rig.inertias[:3], regions)
        for k, inertia in enumerate(rig.inertias[:3]):
            one = hill_boundaries(rig.function(equation, float(inertia)), 1.0, regions)
            expected = rig.frequency / np.sqrt(np.stack([one.upper, one.lower]))
            np.testing.assert_allclose(together[..., k], expected, rtol=1e-11)


def test_observations_agree_with_the_scenes():
    for one in OBSERVATIONS:
        measured = one.rig.inertias / LBF_IN_S2
        assert len(measured) == 8
        assert np.min(np.abs(measured - one.inertia)) < 1e-9, one
    for rig in RIGS:
        scene = load_scene(rig.scene)
        keys = ("measured.speeds", "measured.regions", "measured.inertias")
        speeds, numbers, inertias = (scene.get(key, ()) for key in keys)
        seen = {
            (round(one.speed), one.region, round(one.inertia, 4))
            for one in OBSERVATIONS
            if one.rig is rig
        }
        for speed, n, inertia in zip(speeds, numbers, inertias, strict=True):
            assert (round(speed / RPM), n, round(inertia / LBF_IN_S2, 4)) in seen


@pytest.mark.parametrize("link", ["crank", "coupler", "follower"])
def test_all_that_acts_on_a_free_body_is_in_balance(link):
    machine, speed = example()
    body = free_bodies(machine, 0.7, speed)[0][link]
    forces, arms = np.array(body.forces), np.array(body.places) - body.places[2]
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-12 * np.abs(forces).max())
    moments = arms[:, 0] * forces[:, 1] - arms[:, 1] * forces[:, 0]
    moments = np.append(moments, [body.inertia_couple, body.torque])
    assert abs(moments.sum()) < 1e-11 * np.abs(moments).max()


def test_point_masses_alone_would_have_no_best_offset():
    # What the note on Fig. 23(d) says: without a size of its own the nearest weight is the best.
    machine, speed = example()
    cases = [case_counterweights(machine, "d", INCH * offset) for offset in (0.25, 1.0, 3.0, 6.0)]
    balanced = [with_counterweights(machine, weights.values()) for weights in cases]
    peaks = [peak(rigid_forces(one, TURN, speed).f23)[0] for one in balanced]
    assert np.all(np.diff(peaks) > 0.0)


def test_only_a_scene_with_a_four_bar_gives_one():
    assert four_bar_of("smith_1972_10_8_10_10").lengths["crank"] == pytest.approx(8.0 * INCH)
    with pytest.raises(BadInput, match="four-bar"):
        four_bar_of("slider_crank_example")


def test_the_surfaces_of_the_space_are_those_of_the_sum_of_both_functions():
    lower, upper = smith_equation.space_ends(0.3, 0.4, np.array([0.0, 1.0]))
    linkage = linkage_of("(2,1,2,2)")
    exact = hill_boundaries(series(linkage, "f1") * 0.3 + series(linkage) * 0.4, 1.0, (2,))
    assert lower[1] == exact.lower[0] and upper[1] == exact.upper[0]
    assert lower[0] == pytest.approx(1.0, abs=1e-13)
    near = smith_equation.space_series(np.array([3e-3]), np.array([4e-3]), 2)
    true = smith_equation.space_ends(3e-3, 4e-3, np.ones(1))
    # What is left out is of the third order.
    for one, other in zip(near, true, strict=True):
        assert abs(one[0] - other[0]) < 1e-6


def test_extremes_are_those_of_the_steady_peaks():
    decrement = LAST.rig.decrements[1]
    ends = envelope(LAST, decrement)
    system = LAST.rig.system(decrement=decrement, inertia=LAST.inertia)
    chosen = [0, 100, 200]
    peak = steady_state(system, ends.speed[chosen] * RPM).peak(0.5)
    size = np.maximum(ends.greatest, -ends.least)[chosen]
    # Both take the largest of even angles, here 256 or more of them.
    assert size == pytest.approx(1e3 * peak, rel=1e-3)
    for speed, place in ((400.0, 391.0), (530.0, 520.0)):
        assert LAST.resonance(speed) == pytest.approx(place, abs=2.0)


@pytest.mark.parametrize("k", [0.0, 0.02, 0.3, 0.5, 2.0])
def test_inertia_is_that_of_rod_extension_and_cylinder(k):
    """In 400 digits: bars from -delta to 1, a disc of radius^2 = 2 K m at -delta."""

    def exact(delta):
        disc = (1 - delta**2) / (2 * delta)
        return (1 + delta**3) / 3 + disc * delta**2 + disc * (2 * MP.mpf(k) * disc) / 2

    for delta in np.linspace(0.05, 1.0, 40):
        assert (
            abs(relative_inertia(delta, k) / exact(MP.mpf(float(delta))) - 1)
            < 8 * np.finfo(float).eps
        )


@pytest.mark.parametrize("k", [1e-4, 0.0199, 0.1, 0.3183, 0.45, 0.7, 3.0])
def test_root_is_the_least_inertia_of_all_offsets(k):
    delta, best = np.linspace(0.01, 1.0, 20001), optimal_offset(k)
    values = relative_inertia(delta, k)
    assert relative_inertia(best, k) <= values.min() * (1 + 1e-15)
    assert abs(delta[np.argmin(values)] - best) < 1e-4
    # From K = 1/2 on no counterweight at all is best.
    assert (best == 1.0) == (k >= 0.5)
    assert k >= 0.5 or offset_function(best) == pytest.approx(k, rel=1e-14)
