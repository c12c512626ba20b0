"""Random linear periodic systems whose periodic motion was chosen beforehand."""

import numpy as np
from periodic_systems import system_of


class Series:
    """A trigonometric polynomial with array coefficients, and its exact derivative."""

    def __init__(self, cosine, sine):
        self.cosine, self.sine = np.asarray(cosine), np.asarray(sine)

    @classmethod
    def random(cls, rng, shape, size, harmonics, symmetric=False):
        decay = (size * 0.5 ** np.arange(harmonics + 1)).reshape(-1, *(1,) * len(shape))
        parts = [decay * rng.uniform(-1, 1, (harmonics + 1, *shape)) for _ in range(2)]
        if symmetric:
            parts = [(part + np.swapaxes(part, -1, -2)) / 2 for part in parts]
        return cls(*parts)

    def __call__(self, theta):
        k = np.arange(len(self.cosine))
        angle = np.multiply.outer(theta, k)
        return np.tensordot(np.cos(angle), self.cosine, 1) + np.tensordot(
            np.sin(angle), self.sine, 1
        )

    @property
    def derivative(self):
        k = np.arange(len(self.cosine)).reshape(-1, *(1,) * (self.cosine.ndim - 1))
        return Series(k * self.sine, -k * self.cosine)


def manufactured(seed):
    """Return a random system, a speed, and the periodic motion that its forcing was made for."""
    rng = np.random.default_rng(seed)
    n, speed = int(rng.integers(1, 4)), float(rng.uniform(0.3, 4.0))
    mass = Series.random(rng, (n, n), 0.2, 3, symmetric=True)
    mass.cosine[0] += 1.5 * np.eye(n)
    gyro = Series.random(rng, (n, n), 0.3, 2)
    inertia = Series.random(rng, (n, n), 0.3, 2, symmetric=True)
    spring = Series.random(rng, (n, n), 1.0, 3, symmetric=True)
    spring.cosine[0] += np.diag(rng.uniform(2.0, 400.0, n))
    drag = Series.random(rng, (n, n), 0.05, 2)
    drag.cosine[0] += rng.choice([0.0, 0.2, 3.0]) * np.eye(n)
    carried = Series.random(rng, (n, n), 0.2, 2)
    motion = Series.random(rng, (n,), 1.0, int(rng.integers(1, 12)))

    def times(matrix, vector, theta):
        return np.einsum("tij,tj->ti", matrix(theta), vector(theta))

    def forcing(theta):
        q, slope = motion, motion.derivative
        total = times(mass.derivative, slope, theta) + times(mass, slope.derivative, theta)
        total += times(gyro.derivative, q, theta) + times(gyro, slope, theta)
        total -= np.einsum("tji,tj->ti", gyro(theta), slope(theta)) + times(inertia, q, theta)
        total += times(spring, q, theta) / speed**2
        return total + (times(drag, slope, theta) + times(carried, q, theta)) / speed

    arrays = {"M": mass, "A": gyro, "B": inertia, "K": spring, "C": drag, "D": carried}
    return system_of(**arrays, f=forcing), speed, motion
