"""Figures of frequencies, critical speeds and peaks over the speed, on scenes known exactly."""

from dataclasses import replace

import numpy as np
import pytest
from elastolink import resonance_curve
from elastolink.runtime.frequencies import campbell, critical_speeds, natural_frequencies
from honesty import over_scenes
from manufactured import manufactured
from periodic_systems import system_of, wave
from scipy.optimize import brentq
from scipy.special import ellipe
from wavy_springs import WavyCoordinates


class Turned:
    """Springs and dampers of given rates in random coordinates, which wave where asked."""

    def __init__(self, rng, count=2, drag=0.0, wavy=True):
        # Without waves the products below are exact: few digits.
        squares = np.rint(np.sort(rng.uniform(5.0, 80.0, count)) ** 2 * 256.0) / 256.0
        self.natural = np.sqrt(squares.astype(np.longdouble))
        fixed = np.eye(count) + 0.15 * rng.standard_normal((count, count))
        fixed = np.rint(fixed * 1024.0) / 1024.0
        waves = (0.08 if wavy else 0.0) * rng.standard_normal((2, 1, count, count))
        self.system = system_of(**WavyCoordinates(fixed, waves).arrays(squares, drag))


def to_a_digit(error, actual, size):
    """Return estimates and actual errors, these no less than half a last digit of a size."""
    return error, np.maximum(np.abs(actual), 1e-16 * np.abs(size))


@over_scenes(71, few=5)
def test_held_frequencies_and_campbell(rng):
    scene = Turned(rng, wavy=False)
    angles = rng.uniform(0.0, 6.0, 3)
    found = natural_frequencies(scene.system, angles, scene.system.size)
    drawn = campbell(scene.system, np.linspace(2.0, 9.0, 4))
    return {
        "held": to_a_digit(found.error, found.frequency - scene.natural, scene.natural),
        "drawn": to_a_digit(drawn.error, drawn.held - scene.natural, scene.natural),
    }


@over_scenes(72, few=200, many=None)
def test_fractions_of_mean_frequencies(rng):
    scene = Turned(rng, wavy=False)
    found = critical_speeds(scene.system, (6.0, 30.0))
    exact = scene.natural[found.mode - 1] / found.order
    return to_a_digit(found.error, found.speed - exact, exact)


@over_scenes(76, few=30, many=200)
def test_running_means(rng):
    """The mean of sqrt(k + c w^2 cos theta) is a complete elliptic integral."""
    k, share = float(rng.uniform(5.0, 50.0)) ** 2, float(rng.uniform(0.6, 0.98))
    n = int(rng.integers(1, 4))
    top = np.sqrt(k) / n
    # The cosine takes that share of the stiffness at the highest speed.
    c = share * k / (1.1 * top) ** 2
    system = system_of(M=np.eye(1), K=k * np.eye(1), Kg=(None, wave(c * np.eye(1)), 2))

    def excess(speed):
        depth = c * speed**2
        mean = 2.0 / np.pi * np.sqrt(k + depth) * ellipe(2.0 * depth / (k + depth))
        return mean - n * speed

    found = critical_speeds(system, (0.5 * top, 1.1 * top), method="running_mean")
    place = int(np.flatnonzero(found.order == n)[0])
    exact = brentq(excess, 0.5 * top, 1.1 * top, xtol=1e-15 * top)
    gap = found.speed[place] - exact
    return found.error[place], np.maximum(np.abs(gap), 4e-16 * exact)


@over_scenes(73, few=None, many=100)
def test_maxima_of_multipliers(rng):
    """exp(-c t/2) cos(w t) over the period t is greatest where tan(w t) = -c/(2 w)."""
    drag = float(rng.choice([0.0, rng.uniform(0.1, 3.0)]))
    scene = Turned(rng, count=1, drag=drag)
    own = np.sqrt(scene.natural[0] ** 2 - drag**2 / 4)
    n = int(rng.integers(1, 4))
    exact = 2 * np.pi * own / (2 * np.pi * n - np.arctan(drag / (2 * own)))
    found = critical_speeds(scene.system, (0.9 * exact, 1.1 * exact), method="multipliers")
    assert len(found.speed) == 1
    return to_a_digit(found.error, found.speed - exact, exact)


class Forced:
    """Two damped oscillators, each forced by three harmonics; what both add up to is known."""

    def __init__(self, rng):
        self.natural = np.array([rng.uniform(10.0, 20.0), rng.uniform(40.0, 70.0)])
        self.drag = float(10.0 ** rng.uniform(-2.0, -1.0)) * self.natural[0]
        self.force = rng.uniform(0.3, 1.0, (3, 2))
        order = np.arange(1, 4)

        def force(theta):
            return np.cos(np.multiply.outer(theta, order)) @ self.force

        def shape(x):
            return 1e-6 * np.stack([np.asarray(x)] * 2, axis=1)

        springs = {"K": np.diag(self.natural**2), "C": self.drag * np.eye(2)}
        self.system = replace(system_of(M=np.eye(2), **springs, p=force), shape=shape)

    def square(self, speed):
        """Return the mean square of the sum of both, over speeds in extended precision."""
        w = np.asarray(speed, dtype=np.longdouble)[..., None, None]
        n = np.arange(1, 4, dtype=np.longdouble)[:, None]
        stiff = self.natural.astype(np.longdouble) ** 2 - (n * w) ** 2
        sums = (self.force / (stiff + 1j * np.longdouble(self.drag) * n * w)).sum(axis=-1)
        return (np.abs(sums) ** 2).sum(axis=-1)

    def maximum(self, near):
        """Return the place of the maximum next to a speed, by parabolas closing in.

        The last ones span 1e-8 of it: a third derivative moves their tops by some 1e-16 of it.
        """
        at, step = np.longdouble(near), np.longdouble(near) * 1e-4
        for _ in range(14):
            low, middle, high = 1 / self.square(at + step * np.array([-1, 0, 1]))
            at += step * (low - high) / (2 * (low - 2 * middle + high))
            step = max(step / 4, np.longdouble(near) * 1e-8)
        return at


@over_scenes(74, few=None)
def test_maxima_of_the_response(rng):
    """The speed at which two oscillators and three harmonics together move most."""
    scene = Forced(rng)
    top = scene.natural[0] / int(rng.integers(1, 4))
    span = (top * rng.uniform(0.75, 0.9), top * rng.uniform(1.1, 1.25))
    found = critical_speeds(scene.system, span, method="response", speeds=31)
    exact = np.array([scene.maximum(speed) for speed in found.speed])
    return to_a_digit(found.error, found.speed - exact, found.speed)


def _largest(motion, weights):
    """Return the largest deflection of a known motion, between the angles too."""
    theta = 2 * np.pi * np.arange(1024) / 1024
    best = float(theta[np.argmax(np.abs(motion(theta) @ weights))])
    width = 2 * np.pi / 1024
    for _ in range(4):
        near = best + width * np.linspace(-1.0, 1.0, 201)
        values = np.abs(motion(near) @ weights)
        best, width = float(near[np.argmax(values)]), width / 50
    return float(np.max(values))


@pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
@over_scenes(75, few=None)
def test_peaks_of_steady_motions(rng):
    system, speed, motion = manufactured(int(rng.integers(2**32)))
    powers = np.arange(1, system.size + 1)
    system = replace(system, shape=lambda x: 1e-4 * np.asarray(x)[:, None] ** powers)
    x = float(rng.choice([0.5, 1.0]))
    curve = resonance_curve(system, speed * np.array([0.999, 1.0, 1.001]), x=x)
    gap = curve.peak[1] / _largest(motion, 1e-4 * x**powers) - 1.0
    return to_a_digit(curve.error[1], gap, 1.0)
