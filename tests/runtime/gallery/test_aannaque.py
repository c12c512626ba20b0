"""What the gallery computes for Aannaque's figures, by other routes."""

from functools import partial

import numpy as np
import pytest
from elastolink.runtime.frequencies import dynamic_stiffness
from elastolink.runtime.gallery import (
    aannaque_beams,
    aannaque_rig,
    aannaque_steady_state,
    aannaque_stresses,
)
from elastolink.runtime.gallery.aannaque_beams import (
    beams,
    exact_frequencies,
    hybrid_matrices,
    hybrid_model,
)
from elastolink.runtime.gallery.aannaque_kinematics import crossover, linkage
from elastolink.runtime.gallery.aannaque_stability import multiplier_surfaces
from elastolink.runtime.gallery.algorithms import operation_count
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.recovery import recover, stress_operator
from scipy.integrate import odeint
from scipy.optimize import brentq

# Deflections leave the linear range at resonances; the equations stay linear.
pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")


def test_the_pulses_cross_where_the_peaks_found_by_roots_do():
    # Another route: extremes of the acceleration as roots of its derivative.
    own = linkage()

    def excess(frame):
        other = FourBar(frame, own.crank, own.coupler, own.follower)

        def slope(angle, h=1e-5):
            ends = other.motion([angle - h, angle + h]).alpha4
            return (ends[1] - ends[0]) / (2.0 * h)

        places = [brentq(slope, *np.radians(ends)) for ends in ((30.0, 60.0), (165.0, 200.0))]
        first, second = np.abs(other.motion(places).alpha4)
        return second - first

    # Samples a tenth of a degree apart miss a peak by less than 2e-6 of its size here.
    assert crossover() == pytest.approx(brentq(excess, 0.62, 0.67), abs=5e-6)


def test_maxima_are_refined_between_samples_and_stand_out_by_the_share_asked_for():
    x = np.linspace(0.0, 10.0, 101)
    found = aannaque_beams.tops(x, np.cos(x - 1.234))
    assert found == pytest.approx([1.234, 1.234 + 2.0 * np.pi], abs=1e-4)
    x = np.linspace(0.0, 10.0, 401)
    y = np.exp(np.log(1.1) * np.exp(-(((x - 3.013) / 0.2) ** 2)))
    y *= np.exp(np.log(1.02) * np.exp(-(((x - 7.0) / 0.2) ** 2)))
    # A parabola through three places, an eighth of the width apart, is off by its cube.
    assert aannaque_beams.maxima(x, y, -np.log1p(-0.05)) == pytest.approx([3.013], abs=2e-4)
    assert len(aannaque_beams.maxima(x, y, -np.log1p(-0.01))) == 2


@pytest.mark.slow
def test_midpoints_by_the_recovery_of_displacements():
    for elements in (2, 3):
        system = beams(elements)
        motion = steady_state(system, 20.0, rtol=1e-5)
        for link in ("coupler", "follower") if elements == 2 else ("follower",):
            found = recover(system, motion, stations={link: [0.5]}, method="shape")
            ours = aannaque_beams.moved(system, link, motion.theta, motion.q)
            theirs = found.of(link, "across")[:, 0]
            assert np.max(np.abs(ours - theirs)) < 1e-9 * np.max(np.abs(theirs))


def test_the_march_settles_to_the_cyclic_solution():
    system = beams(1)
    values = aannaque_steady_state.march()[0][-1]
    motion = steady_state(system, aannaque_beams.CRITICAL)
    exact = aannaque_beams.moved(system, "follower", motion.theta, motion.q)
    # Newmark's 720 steps: the sixth oscillation of the second mode is 4e-4 late in phase.
    assert abs(np.max(values) / np.max(exact) - 1.0) < 5e-3


def test_the_exact_model_has_the_first_frequency_of_the_dynamic_stiffness():
    """At most five iterations at 1e-3, as in the thesis; two or three are enough."""
    angles = np.array([0.3, 2.0, 4.1])
    structure = beams(1).structure
    exact = exact_frequencies(structure, angles, 1)[:, 0]
    matrices = hybrid_matrices(structure, angles)
    assert matrices.iterations.min() >= 1 and matrices.iterations.max() <= 3
    np.testing.assert_allclose(matrices.first, exact, rtol=1e-4)
    fine = hybrid_matrices(structure, angles, rtol=1e-9)
    np.testing.assert_allclose(fine.first, exact, rtol=1e-11)
    formed = fine.stiffness[0] - fine.first[0] ** 2 * fine.mass[0]
    stiffness = dynamic_stiffness(structure, angles[0]).stiffness(fine.first[0])
    np.testing.assert_allclose(formed, stiffness, atol=1e-6 * np.abs(stiffness).max())


@pytest.mark.slow
def test_the_system_of_the_exact_model_has_it_too():
    system, angles = hybrid_model(), np.array([0.3, 2.0, 4.1])
    found = hybrid_matrices(beams(1).structure, angles, rtol=1e-10)
    mass, stiffness = system.array("M", angles), system.array("K", angles)
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.min(axis=1)
    np.testing.assert_allclose(np.sqrt(squares), found.first, rtol=1e-6)


def test_surfaces_of_multipliers_are_those_of_an_integrated_turn():
    both = multiplier_surfaces((0.0, 30.0), np.linspace(0.0, 20.0, 5), per_band=6)
    tight = {"rtol": 1e-12, "atol": 1e-12}

    def motion(t, y, stiffness, eps):
        return [y[2], y[3], *(-(stiffness + eps * np.cos(2.0 * t)) * y[:2])]

    for place in [(3, 0), (10, 1), (20, 2), (28, 3), (40, 4)]:
        given = both.d[place], both.eps[place]
        ends = odeint(motion, [1, 0, 0, 1], [0.0, np.pi], given, tfirst=True, **tight)
        first, second = both.first[place], both.second[place]
        assert first * second == pytest.approx(1.0, rel=1e-12)
        assert first + second == pytest.approx(ends[-1, 0] + ends[-1, 3], rel=1e-8)
        assert abs(first) > abs(second) or first.imag >= 0.0


def test_operations_of_marching_from_where_it_costs_more():
    # 16 N n^3 + ... = 4 n_c N n^2: 4 n and a little more.
    for freedoms in (10, 50):
        assert 4 * freedoms <= aannaque_steady_state._break_even(freedoms) <= 4 * freedoms + 3


@pytest.mark.slow
def test_multipliers_of_four_modes_are_those_of_all():
    place = 168
    speed = float(aannaque_stresses._SPEEDS[place])
    whole = floquet_multipliers(beams(1), speed, rtol=1e-7).multipliers
    pairs = whole[:4].real.reshape(2, 2).max(axis=1)
    # The five higher modes carry no motion: 1e-3 of the second pair, less of the first.
    np.testing.assert_allclose(aannaque_stresses.real_parts()[place, :2], pairs, atol=2e-3)


@pytest.mark.slow
def test_stresses_over_the_speed_by_single_motions():
    system = beams(3)
    curve = aannaque_stresses._curve(3)
    for place in (150, 250):
        speed = float(aannaque_stresses._WIDE[place])
        motion = steady_state(system, speed, rtol=1e-5)
        form = stress_operator(system, motion.theta, 7, method="shape")[0]
        values = form.values(speed, motion.q, motion.qd / speed)
        # Between 256 angles the peak is a little higher.
        assert np.max(np.abs(values)) == pytest.approx(np.max(curve[place]), rel=3e-3)


@pytest.mark.slow
def test_stresses_of_a_cycle_are_those_of_the_curve_over_the_speed():
    # Two routes: the full equations at some speeds, and the sweep on moving modes.
    speeds = (11.1, 17.725, 24.35)
    stress = aannaque_rig.cycles(aannaque_rig.SHORT, aannaque_rig.FRAME, speeds)[1]
    swept = aannaque_rig.stress_curve(
        aannaque_rig.rig(), np.array(speeds), stations=aannaque_rig.STATIONS, rtol=1e-3
    )
    stations = {"crank": 0.0, "coupler": 0.5, "follower": 0.5}
    size = np.stack([np.max(np.abs(stress[pair]), axis=1) for pair in stations.items()], -1)
    # The sweep's error, and a peak between 256 angles: (pi/256)^2/2 times its harmonic squared.
    tolerance = 1e-3 + 0.5 * (6 * np.pi / 256) ** 2
    whole = np.stack([swept.of(link) for link in stations], axis=-1)
    own = np.stack([swept.fibre[:, swept.links.index(link)] for link in stations], axis=-1) > 0
    assert np.any(own) and np.any(~own)
    np.testing.assert_allclose(size[own], whole[own], rtol=tolerance)
    # Where the other fibre has the largest stress, this one's is less.
    assert np.all(size[~own] < whole[~own] * (1 + tolerance))


@pytest.mark.slow
def test_lengths_at_which_both_pinned_links_vibrate_alike():
    # sqrt(I/A) is what the sections differ by; lengths go with its square root.
    ratio = np.sqrt(83.34 / 85.5) / np.sqrt(65.12 / 78.75)
    assert aannaque_rig.crossing() == pytest.approx(0.525 * np.sqrt(ratio), rel=1e-12)


@pytest.mark.slow
def test_the_slow_path_moves_as_the_squared_speed():
    slow, slower = (aannaque_rig.midpoint(speed) for speed in (3.0, 1.5))
    # Far below the lowest resonance inertia forces alone count, and their square of the speed.
    assert slow.largest / slower.largest == pytest.approx(4.0, rel=0.02)


def test_operations_of_a_further_cycle_by_hand():
    marching = partial(operation_count, "time_marching", intervals=90, freedoms=9)
    kept = marching(cycles=31)
    # A product with a vector of 2 n, and the load.
    assert (kept - marching(cycles=1)) / 30 == 90 * ((2 * 18 - 1) * 18 + 18)
    assert marching(cycles=31, storage=False) > 5 * kept
