"""Two of Hill's equations seen in wavy coordinates: ends of unstable regions known to more digits.

    z_i'' + 2 k z_i' + (w_i^2 + e_i f(theta)) z_i = 0 [1/s^2],   z = R(theta) q

A third, stiff and without f, may join them.  The coordinates couple everything; the half traces
of the two equations, from Taylor series in extended precision, know nothing of them.
"""

import numpy as np
from elastolink.runtime.core.periodic_function import PeriodicFunction
from half_trace_truth import half_traces
from periodic_systems import system_of
from wavy_springs import WavyCoordinates


class HillPair:
    """A random pair of equations, and the system that hides them."""

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
