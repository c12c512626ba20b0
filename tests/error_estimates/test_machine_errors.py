"""Error estimates of flywheels, run-ups and transmission against closed forms of more digits.

A slider-crank whose crank is a bar and whose slider has a mass, the coupler none: its inertia is
``J = I + m (dx/dtheta)^2``, and constant energy or constant torque gives the rest.
"""

import elastolink as el
import mpmath
import numpy as np
from elastolink.runtime.rigid import torque_fluctuation
from honesty import over_scenes

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
        self.linkage = el.SliderCrank(self.radius, self.rod, self.offset)
        crank = el.MassDistribution.uniform_bar(mass=self.bar, length=self.radius)
        self.machine = el.Machine(
            self.linkage, {"crank": crank, "slider": el.MassDistribution(self.mass)}
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


@over_scenes(51)
def test_energy_fluctuations(rng):
    scene, speed = Slider(rng), float(rng.uniform(1.0, 50.0))
    low, high = extremes(scene)
    found = torque_fluctuation(scene.machine, speed)
    truth = (high - low) * np.longdouble(speed) ** 2 / 2
    return found.error, found.energy_fluctuation - truth


@over_scenes(52, few=20, many=100)
def test_flywheels(rng):
    """Without motor and load the energy stays: the inertias' ratio is that of squared speeds."""
    scene, speed = Slider(rng), float(rng.uniform(1.0, 50.0))
    wanted = float(rng.uniform(0.005, 0.2))
    low, high = extremes(scene)
    half = np.longdouble(wanted) / 2
    square = ((1 + half) / (1 - half)) ** 2
    truth = max((high - square * low) / (square - 1), np.longdouble(0))
    found = el.flywheel_inertia(scene.machine, speed, wanted)
    if not truth:
        return None  # none is needed: nothing is rounded
    return found.error, found.inertia - truth


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


@over_scenes(53, floor=1e-18)
def test_run_ups(rng):
    """Constant torque from a start with speed: the energy is known at every angle."""
    scene, start = Slider(rng), float(rng.uniform(1.0, 10.0))
    own = float(scene.inertia(np.longdouble(0)))
    torque, wheel = own * float(rng.uniform(0.1, 10.0)), own * float(rng.choice([0.0, 1.0]))
    tolerance = float(10.0 ** rng.uniform(-11, -4))
    run = el.run_up(
        scene.machine,
        torque,
        revolutions=float(rng.uniform(0.5, 2.0)),
        speed0=start,
        flywheel=wheel,
        tolerance=tolerance,
        samples=33,
    )
    return run.error, _angle_error(scene, run, torque, wheel, start)


@over_scenes(56)
def test_extreme_transmission_angles(rng):
    """By the law of cosines at the two collinear positions of crank and frame, 40 digits.

    Every other linkage is next to a change point.
    """
    frame, crank, coupler, follower = map(float, rng.uniform(0.1, 2.0, 4))
    if rng.random() < 0.5:
        frame = coupler + follower - crank - 10.0 ** float(rng.uniform(-15.0, -1.0))
    try:
        found = el.transmission_angle(el.FourBar(frame, crank, coupler, follower))
    except el.BadInput:
        return None
    c, f = MP.mpf(coupler), MP.mpf(follower)
    reach = [MP.mpf(frame) + side * MP.mpf(crank) for side in (-1, 1)]
    cosines = [(c * c + f * f - base**2) / (2 * c * f) for base in reach]
    truth = [MP.acos(max(-1, min(1, cosine))) for cosine in cosines]
    gap = max(abs(MP.mpf(found.least) - min(truth)), abs(MP.mpf(found.greatest) - max(truth)))
    assert gap <= found.error
    return found.error, float(gap)


@over_scenes(57)
def test_mechanical_advantages(rng):
    """Output speed of slider-cranks by the closed form above, in extended precision."""
    scene, theta = Slider(rng), rng.uniform(-3.0, 3.0, 3)
    found = el.transmission_angle(scene.linkage).mechanical_advantage(theta)
    truth = scene.slope(theta.astype(np.longdouble))
    return found.error, np.abs(found.speed_ratio) - np.abs(truth)
