"""Driven oscillators with cubic springs, some with a periodic motion planted in them."""

from dataclasses import dataclass, field

import numpy as np
from elastolink.runtime.core.families import Nonlinear, Varied


@dataclass(frozen=True)
class Cubic:
    """``q'' + C q' + K q + cos(theta) P q + k3 q^3 = F(theta)``, time in seconds.

    F is ``force cos(theta)``, or what makes a given sum of harmonics the motion at one speed.
    """

    stiffness: np.ndarray  # K, (n, n)
    damping: np.ndarray  # C, (n, n)
    cubic: np.ndarray  # k3, (n, n)
    pumped: np.ndarray  # P, (n, n)
    force: np.ndarray  # (n,)
    harmonics: np.ndarray | None = None  # complex, (n, h): of the planted motion
    speed: float = field(default=1.0)  # at which it is a motion

    def motion(self, theta):
        """Return the planted motion and its derivatives by the angle, ``(*batch, n)`` each."""
        order = np.arange(1, self.harmonics.shape[1] + 1)
        waves = np.exp(1j * np.multiply.outer(theta, order))
        return [np.real((waves * (1j * order) ** k) @ self.harmonics.T) for k in range(3)]

    def _left(self, q, qd, qdd, wave):
        springs = q @ self.stiffness.T + wave * (q @ self.pumped.T) + q**3 @ self.cubic.T
        return qdd + qd @ self.damping.T + springs

    def __call__(self, q, qd, qdd, drive, parameters, derivatives=True):
        theta = np.asarray(drive.angle)
        wave = np.cos(theta)[..., None]
        factor = parameters.get("pumping", 1.0)
        if self.harmonics is None:
            load = self.force * wave * parameters.get("force", 1.0)
        else:
            x, v, a = self.motion(theta)
            load = self._left(x, self.speed * v, self.speed**2 * a, wave)
        residual = self._left(q, qd, qdd, factor * wave) - load
        if not derivatives:
            return Varied(residual)
        one = np.broadcast_to(np.eye(q.shape[-1]), (*residual.shape, q.shape[-1]))
        springs = self.stiffness + factor * wave[..., None] * self.pumped
        springs = springs + 3.0 * self.cubic * (q**2)[..., None, :]
        return Varied(residual, one, np.broadcast_to(self.damping, one.shape), springs)


def duffing(damping=0.05, cubic=0.05, force=0.3, pumped=0.0):
    """Return ``q'' + damping q' + (1 + pumped cos) q + cubic q^3 = force cos`` as a system."""
    rows = [np.array([[value]]) for value in (1.0, damping, cubic, pumped)]
    return Nonlinear(1, Cubic(*rows, np.array([force])), {"force": 1.0, "pumping": 1.0})


def planted_system(rng):
    """Return a random system of one or two coordinates, its speed, and its planted motion."""
    n = int(rng.integers(1, 3))
    own = np.sort(rng.uniform(1.5, 6.0, n))
    turn = np.linalg.qr(rng.normal(size=(n, n)))[0]
    stiffness = turn @ np.diag(own**2) @ turn.T
    damping = turn @ np.diag(2.0 * rng.uniform(0.005, 0.05) * own) @ turn.T
    cubic = 3.0 * rng.uniform(-1.0, 1.0) * own[-1] ** 2 * np.diag(rng.uniform(0.2, 1.0, n))
    pumped = rng.uniform(0.0, 0.3) * own[0] ** 2 * np.diag(rng.uniform(0.3, 1.0, n))
    speed = float(rng.uniform(0.8, 1.2) * own[0] / rng.integers(1, 4))
    order = np.arange(1, 5)
    harmonics = 0.12 * (rng.normal(size=(n, 4)) + 1j * rng.normal(size=(n, 4))) / np.sqrt(order)
    equations = Cubic(stiffness, damping, cubic, pumped, np.zeros(n), harmonics, speed)
    return Nonlinear(n, equations), speed, equations.motion
