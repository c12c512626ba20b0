"""Errors of ends of unstable regions, by each way to them, against half traces of more digits.

Two of Hill's equations are hidden in wavy coordinates; each end that is a simple root of a half
trace is compared.  The half traces are Taylor series in extended precision.
"""

import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.stability import resonances, stability_edges, tongue, tongue_curves
from half_trace_truth import half_traces
from honesty import extended, over_scenes
from periodic_systems import system_of
from wavy_springs import WavyCoordinates

damped = pytest.mark.parametrize("drag", [0.0, 0.01])


class HillPair:
    """A random pair z_i'' + 2 k z_i' + (w_i^2 + e_i f(theta)) z_i = 0 [1/s^2], hidden by z = R q.

    A third, stiff and without f, may join them.
    """

    def __init__(self, rng, drag=0.0, pull=0.25, wavy=True, stiff=False):
        low = float(rng.uniform(2.0, 4.0))
        # Ratios away from whole numbers: no meetings of four multipliers.
        natural = [low, low * float(rng.uniform(1.25, 1.75))]
        self.natural = np.array([*natural, low * float(rng.uniform(80.0, 200.0))][: 2 + stiff])
        n = len(self.natural)
        count = int(rng.choice([1, 2, 3]))
        a, b = rng.normal(size=(2, count + 1)) * 0.5 ** np.arange(count + 1)
        a[0] = b[0] = 0.0
        self.f, self.drag = PeriodicFunction(a, b), drag
        self.pull = pull * self.natural**2 * rng.uniform(0.2, 1.0, n) / np.sum(self.f.amplitudes)
        self.pull[2:] = 0.0
        fixed = np.eye(n) + 0.2 * rng.standard_normal((n, n))
        waves = (0.06 if wavy else 0.0) * rng.standard_normal((2, 1, n, n))
        self.system = self._system(WavyCoordinates(fixed, waves))

    def _system(self, coordinates):
        arrays = coordinates.arrays(self.natural**2, 1.0)

        def wave(theta):
            turned = coordinates.turn(theta)
            weight = np.multiply.outer(self.f(theta), self.pull)[:, None, :]
            return (np.swapaxes(turned, -1, -2) * weight) @ turned

        arrays["K"] = [arrays["K"], ("pull", wave)]
        for name in ("C", "D"):
            damping = arrays.pop(name)
            if self.drag:
                arrays[name] = ("drag", damping)
        return system_of({"pull": 1.0, "drag": 2.0 * self.drag}, **arrays)

    def ends(self, mode, sign, speeds, factor=1.0):
        """Return the ends of regions next to given speeds, and how steep the half traces are.

        One Newton step from each speed, with the slope from differences: what is left is the
        square of the distance.
        """
        at = np.asarray(speeds, dtype=float)
        step = 1e-6 * at
        turns = np.stack([at - step, at, at + step])
        lam2, mu = self.natural[mode] ** 2 / turns**2, factor * self.pull[mode] / turns**2
        own = np.asarray(self.drag / turns, dtype=np.longdouble)
        # u = exp(K theta) z has no first derivative.
        fall = np.exp(-8 * np.arctan(np.longdouble(1)) * own)
        trace = fall * half_traces(self.f, lam2 - (self.drag / turns) ** 2, mu)
        trace = trace - 0.5 * sign * (1 + fall * fall)
        slope = (trace[2] - trace[0]) / (2 * step)
        steep = np.abs(slope * at) > 1e-3
        return at - trace[1] / np.where(steep, slope, np.inf), np.asarray(steep, dtype=bool)


pytestmark = [pytest.mark.slow, extended]
SPAN = (3.5, 9.5)
ENDS = 48


def compared(scene, mode, harmonic, found, error, factor=1.0):
    """Return estimates and actual errors of ends that are simple roots."""
    exact, steep = scene.ends(mode, (-1) ** harmonic, found, factor)
    return np.broadcast_to(error, steep.shape)[steep], (exact - found)[steep]


def joined(pairs):
    """Return pairs of estimates and errors in one; None where there are none."""
    both = [np.concatenate([part for part in parts]) for parts in zip(*pairs, strict=True)]
    return both if both and both[0].size else None


def of_regions(scene, found):
    assert found.passed, found.checks
    pairs = []
    for i, kind in enumerate(found.kind):
        ends = np.array([found.lower[i], found.upper[i]])
        if kind == "principal" and np.all(np.isfinite(ends)) and ends[1] > ends[0]:
            mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
            pairs.append(compared(scene, mode, harmonic, ends, found.error[i]))
    return joined(pairs)


@over_scenes(41, few=None, many=ENDS, floor=1e-18)
@damped
def test_ends_of_all_regions(rng, drag):
    scene = HillPair(rng, drag)
    return of_regions(scene, stability_edges(scene.system, SPAN))


@over_scenes(42, few=None, many=24, floor=1e-18)
def test_bands_of_a_truncated_system(rng):
    scene = HillPair(rng, drag=float(rng.choice([0.0, 0.01])), stiff=True)
    return of_regions(scene, stability_edges(scene.system, SPAN, modes=2))


@over_scenes(44, few=None, many=8, floor=1e-18)
def test_curves_from_their_feet(rng):
    scene, factors, pairs = HillPair(rng, wavy=False), np.linspace(0.1, 1.0, 7), []
    found = tongue_curves(scene.system, "pull", factors, SPAN, highest=2)
    for i, label in enumerate(found.labels):
        if not label.startswith("2"):
            continue
        mode, harmonic = int(found.modes[i, 0]) - 1, int(found.harmonic[i])
        for j, factor in enumerate(factors):
            ends = np.array([found.lower[i, j], found.upper[i, j]])
            if np.all(np.isfinite(ends)) and ends[1] > ends[0]:
                pairs.append(compared(scene, mode, harmonic, ends, found.error[i, j], factor))
    return joined(pairs)


@over_scenes(45, few=None, many=ENDS // 5, floor=1e-18)
@damped
def test_series_of_tongues(rng, drag):
    """Here the estimate is the truncation: it has to cover the next orders, not round-off."""
    scene, factors, pairs = HillPair(rng, drag, wavy=False), np.geomspace(0.05, 0.5, 5), []
    order = int(rng.integers(2, 6))
    for one in resonances(scene.system, SPAN, kinds=("principal",), highest=2):
        found = tongue(scene.system, one, parameter=("pull", factors), order=order)
        for j, factor in enumerate(factors):
            ends = np.array([found.lower[j], found.upper[j]])
            # One Newton step of the reference leaves the square of the distance.
            if found.open[j] and found.error[j] < 1e-4 * ends[0]:
                mode, harmonic = one.modes[0] - 1, one.harmonic
                pairs.append(compared(scene, mode, harmonic, ends, found.error[j], factor))
    return joined(pairs)
