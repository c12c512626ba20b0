"""Error estimates of run-ups of random bars against Gauss collocation of a far finer mesh of time.

The reference marches the second-order equation, with the derivatives of its arrays, and takes four
stages a step, in which the axial waves turn by 0.4 rad; the solver marches the canonical form with
three stages and a hundred times longer steps.
"""

import numpy as np
import pytest
from beam_motions import rocking_bar
from elastolink.runtime.beams import Section
from elastolink.runtime.core.collocation import gauss_maps
from elastolink.runtime.design import SpeedProfile, run_through
from elastolink.runtime.design.transient import _between, largest_by_shape
from elastolink.runtime.periodic import steady_state
from honesty import over_scenes
from periodic_systems import second_order
from scipy.interpolate import CubicSpline

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
STATIONS = 5
# A bar of 1 m and a tenth of it thick, so that its axial waves are no faster than they need be.
SECTION = Section.rectangle(0.02, 0.1, modulus=2.1e11, density=7850.0)
SQUARE = np.sqrt(SECTION.bending_stiffness / SECTION.mass_per_length)
# The fastest rate of one element: axial, or the second bending mode of a cubic [rad/s].
AXIAL = max(3.5 * np.sqrt(SECTION.axial_stiffness / SECTION.mass_per_length), 110.0 * SQUARE)
STAGES, PHASE = 4, 0.4


def random_profile(rng, first):
    """Return a run-up or a run-down of a few revolutions through some of the fractions."""
    low, high = np.sort(first * rng.uniform(0.1, 0.5, 2))
    start, stop = (low, high) if rng.integers(4) else (high, low)
    duration = float(rng.uniform(1.0, 2.0) * 2 * np.pi / high)
    return SpeedProfile.ramp(start, stop, duration, after=float(rng.choice([0.0, 0.3 * duration])))


class SecondOrder:
    """``M qdd + (C + w G) qd + (K + w D + w^2 H + a E) q = w^2 f + a g`` along a drive."""

    def __init__(self, system, profile):
        self.system, self.profile = system, profile

    def generator(self, time):
        """Return the generator of (q, qd, 1) at times, ``(nt, 2n + 1, 2n + 1)``."""
        n, drive = self.system.size, self.profile
        motion = drive.angle(time), drive.speed(time), drive.acceleration(time)
        stiff, damping, mass, force = second_order(self.system, *motion)
        sides = np.concatenate([-stiff, -damping, force[:, :, None]], axis=2)
        found = np.zeros((len(time), 2 * n + 1, 2 * n + 1))
        found[:, :n, n : 2 * n] = np.eye(n)
        found[:, n : 2 * n] = np.linalg.solve(mass, sides)
        return found

    def march(self, start, phase):
        """Return times and coordinates by Gauss collocation, between the profile's own times."""
        times, states = [np.zeros(1)], [start[None]]
        for begin, end in zip(self.profile.times[:-1], self.profile.times[1:], strict=True):
            steps = int(np.ceil(AXIAL * (end - begin) / phase))
            edges = np.linspace(begin, end, steps + 1)
            step = edges[1] - edges[0]
            maps = gauss_maps(STAGES, self.generator, edges[:-1], step)
            inside = np.empty((steps, len(start)))
            state = states[-1][-1]
            for k in range(steps):
                inside[k] = state = maps[k] @ state
            times.append(edges[1:])
            states.append(inside)
        return np.concatenate(times), np.concatenate(states)[:, : self.system.size]


def largest(system, profile, time, q):
    """Return the largest stress at the times and, by splines, between them."""

    def at(when, values):
        return largest_by_shape(system, profile.angle(when), values, STATIONS)[:, 0]

    rough = at(time, q)
    near = np.flatnonzero(rough > 0.97 * np.max(rough))
    spline = CubicSpline(time, q)
    steps = np.linspace(-1.0, 1.0, 33)[:, None] * (time[1] - time[0])
    between = np.clip((time[near] + steps).ravel(), time[0], time[-1])
    return max(np.max(rough), np.max(at(between, spline(between))))


def exact_largest(system, profile, start, phase):
    """Return the largest stress of the run; the fastest rate turns by ``phase`` in a step."""
    n, first = system.size, np.zeros(2 * system.size + 1)
    first[-1] = 1.0
    if start == "steady":
        speed = float(profile.speeds[0])
        steady = steady_state(system, speed, rtol=1e-10)
        first[:n], first[n : 2 * n] = steady.q.reshape(-1, n)[0], steady.qd.reshape(-1, n)[0]
    return largest(system, profile, *SecondOrder(system, profile).march(first, phase))


def compared(rng, modes=None):
    """Return the estimate and the actual error of the largest stress of one random run."""
    system, first = rocking_bar(rng, thickness=0.1)
    profile = random_profile(rng, first)
    start = str(rng.choice(["steady", "rest"]))
    rtol = float(10.0 ** rng.uniform(-3.5, -1.2))
    found = run_through(system, profile, modes=modes, stations=STATIONS, rtol=rtol, start=start)
    estimate = float(found.error[0])
    phase = PHASE if estimate > 1e-4 else 0.3 * PHASE
    return estimate, found.largest["bar"] / exact_largest(system, profile, start, phase) - 1.0


@pytest.mark.parametrize("at", [18.5, 18.7, 18.9])
def test_a_peak_between_the_last_two_steps_is_told(at):
    wave = np.cos(0.3 * (np.arange(20.0) - at))[:, None]
    for values in (wave, wave[::-1]):
        missed = 1.0 / np.max(values) - 1.0
        assert missed <= _between(values)[0] < 10.0 * missed


@over_scenes(8200, few=2, many=34, floor=1e-12)
def test_runs_of_all_coordinates(rng):
    return compared(rng)


@over_scenes(8300, few=2, many=20, floor=1e-12)
def test_runs_of_a_few_modes(rng):
    """Those left out are added, all in the end: their estimate is that of what they change."""
    return compared(rng, int(rng.integers(1, 3)))
