"""Error estimates of flywheels, run-ups and transmission against closed forms of more digits.

A slider-crank whose crank is a bar and whose slider has a mass, the coupler none: its inertia is
``J = I + m (dx/dtheta)^2``, and constant energy or constant torque gives the rest.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.linkages import FourBar, SliderCrank, transmission_angle
from elastolink.runtime.rigid import (
    Machine,
    MassDistribution,
    flywheel_inertia,
    run_up,
    torque_fluctuation,
)
from honesty import SCENES, verdict

MP = mpmath.MPContext()
MP.dps = 40


class Slider:
    """A random slider-crank, and its inertia in any arithmetic."""

    def __init__(self, rng):
        self.radius = float(rng.uniform(0.05, 0.5))
        self.rod = self.radius * float(rng.uniform(1.8, 5.0))
        self.offset = self.radius * float(rng.choice([0.0, rng.uniform(-0.5, 0.5)]))
        self.mass = float(10.0 ** rng.uniform(-1, 1))
        self.bar = float(10.0 ** rng.uniform(-1, 1))
        self.linkage = SliderCrank(self.radius, self.rod, self.offset)
        crank = MassDistribution.uniform_bar(mass=self.bar, length=self.radius)
        self.machine = Machine(
            self.linkage, {"crank": crank, "slider": MassDistribution(self.mass)}
        )

    def slope(self, theta, lib=np, number=np.longdouble):
        """Return dx/dtheta of the slider."""
        r, rod, e = (number(v) for v in (self.radius, self.rod, self.offset))
        height = e - r * lib.sin(theta)
        return -r * lib.sin(theta) + height * r * lib.cos(theta) / lib.sqrt(
            rod * rod - height * height
        )

    def inertia(self, theta, lib=np, number=np.longdouble):
        crank = number(self.bar) * number(self.radius) ** 2 / 3
        return crank + number(self.mass) * self.slope(theta, lib, number) ** 2


def extremes(scene):
    """Return the least and greatest inertia over a turn, in extended precision."""
    turn = 8 * np.arctan(np.longdouble(1))
    grid = np.arange(2048) * (turn / 2048)
    values = scene.inertia(grid)
    found = []
    for pick in (np.argmin, np.argmax):
        at, step = grid[pick(values)], turn / 2048
        for _ in range(60):
            three = at + step * np.array([-1, 0, 1])
            best = int(pick(scene.inertia(three)))
            at, step = three[best], step if best != 1 else step / 2
        found.append(scene.inertia(at))
    return found


@SCENES
def test_energy_fluctuations(scenes):
    rng = np.random.default_rng(51)
    ratios = []
    for _ in range(scenes):
        scene, speed = Slider(rng), float(rng.uniform(1.0, 50.0))
        low, high = extremes(scene)
        found = torque_fluctuation(scene.machine, speed)
        truth = (high - low) * np.longdouble(speed) ** 2 / 2
        ratios.append(found.error / max(abs(found.energy_fluctuation - truth), 1e-300))
    verdict(ratios, scenes)


@pytest.mark.parametrize("scenes", [6, pytest.param(40, marks=pytest.mark.slow)])
def test_flywheels(scenes):
    """Without motor and load the energy stays: the inertias' ratio is that of squared speeds."""
    rng = np.random.default_rng(52)
    ratios = []
    for _ in range(scenes):
        scene, speed = Slider(rng), float(rng.uniform(1.0, 50.0))
        wanted = float(rng.uniform(0.005, 0.2))
        low, high = extremes(scene)
        half = np.longdouble(wanted) / 2
        square = ((1 + half) / (1 - half)) ** 2
        truth = max((high - square * low) / (square - 1), np.longdouble(0))
        found = flywheel_inertia(scene.machine, speed, wanted)
        ratios.append(found.error / max(abs(found.inertia - truth), 1e-300))
    verdict(ratios, scenes)


def _angle_error(scene, run, torque, wheel, start):
    """Return the largest error of the angle: the time at an angle is an integral in closed form."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    wheel = np.longdouble(wheel)
    energy = (scene.inertia(np.longdouble(0)) + wheel) * np.longdouble(start) ** 2 / 2

    def rate(theta):
        return np.sqrt(
            2 * (energy + np.longdouble(torque) * theta) / (scene.inertia(theta) + wheel)
        )

    worst, before, elapsed = 0.0, np.longdouble(0), np.longdouble(0)
    for time, angle in zip(run.time[1:], run.angle[1:], strict=True):
        middle, half = (angle + before) / 2, (angle - before) / 2
        elapsed += half * np.sum(weights / rate(middle + half * nodes.astype(np.longdouble)))
        before = np.longdouble(angle)
        worst = max(worst, float(abs(elapsed - time) * rate(before)))
    return worst


@SCENES
def test_run_ups(scenes):
    """Constant torque from a start with speed: the energy is known at every angle."""
    rng = np.random.default_rng(53)
    ratios = []
    for _ in range(scenes):
        scene, start = Slider(rng), float(rng.uniform(1.0, 10.0))
        own = float(scene.inertia(np.longdouble(0)))
        torque, wheel = own * float(rng.uniform(0.1, 10.0)), own * float(rng.choice([0.0, 1.0]))
        tolerance = float(10.0 ** rng.uniform(-11, -4))
        run = run_up(
            scene.machine,
            torque,
            revolutions=float(rng.uniform(0.5, 2.0)),
            speed0=start,
            flywheel=wheel,
            tolerance=tolerance,
            samples=33,
        )
        actual = _angle_error(scene, run, torque, wheel, start)
        ratios.append(run.error / max(actual, 1e-18))
    verdict(ratios, scenes)


@SCENES
def test_extreme_transmission_angles(scenes):
    """By the law of cosines at the two collinear positions of crank and frame, 40 digits."""
    rng = np.random.default_rng(56)
    ratios = []
    while len(ratios) < scenes:
        crank, coupler, follower = rng.uniform(0.1, 2.0, 3)
        frame = float(rng.uniform(0.1, 2.0))
        sides = sorted([frame, crank, coupler, follower])
        if crank != sides[0] or sides[0] + sides[3] > 0.98 * (sides[1] + sides[2]):
            continue
        linkage = FourBar(frame, float(crank), float(coupler), float(follower))
        found = transmission_angle(linkage)
        c, f = MP.mpf(float(coupler)), MP.mpf(float(follower))
        truth = [
            MP.acos(
                (c * c + f * f - (MP.mpf(frame) + side * MP.mpf(float(crank))) ** 2) / (2 * c * f)
            )
            for side in (-1, 1)
        ]
        gap = max(abs(MP.mpf(found.least) - min(truth)), abs(MP.mpf(found.greatest) - max(truth)))
        assert gap <= found.error
        ratios.append(found.error / max(float(gap), 1e-300))
    verdict(ratios, scenes)


@SCENES
def test_mechanical_advantages(scenes):
    """Output speed of slider-cranks by the closed form above, in extended precision."""
    rng = np.random.default_rng(57)
    ratios = []
    for _ in range(scenes):
        scene, theta = Slider(rng), rng.uniform(-3.0, 3.0, 3)
        found = transmission_angle(scene.linkage).mechanical_advantage(theta)
        truth = scene.slope(theta.astype(np.longdouble))
        gaps = np.abs(np.abs(found.speed_ratio) - np.abs(truth)).astype(float)
        ratios.append(found.error / np.maximum(gaps, 1e-300))
    verdict(ratios, scenes)
