"""Springs seen in wavy coordinates: periodic systems whose Floquet analysis is in closed form.

Two springs seen in random wavy coordinates z = R(theta) q have periodic mass, Coriolis,
centrifugal and stiffness terms, and multipliers and boundaries that are known.
"""

import numpy as np
from periodic_systems import system_of


class WavyCoordinates:
    """Coordinates ``z = R(theta) q`` that wave with the crank, and oscillators seen in them.

    R is a fixed matrix with ``waves``, cosines and sines by harmonic, ``(2, harmonics, n, n)``.
    """

    def __init__(self, fixed, waves):
        self.fixed, self.waves = fixed, np.asarray(waves)
        self.order = np.arange(1, self.waves.shape[1] + 1)

    def turn(self, theta):
        """Return R, ``(nt, n, n)``."""
        return self.fixed + self._sum(theta, *self.waves)

    def slope(self, theta):
        """Return dR/dtheta, ``(nt, n, n)``."""
        cosine, sine = self.order[:, None, None] * self.waves
        return self._sum(theta, sine, -cosine)

    def _sum(self, theta, cosine, sine):
        angle = np.multiply.outer(theta, self.order)
        return np.tensordot(np.cos(angle), cosine, 1) + np.tensordot(np.sin(angle), sine, 1)

    def arrays(self, squares, drag=0.0):
        """Return by name the arrays of oscillators of squared frequencies, and of a drag on all."""

        def between(left, right, weight=1.0):
            return lambda theta: np.swapaxes(left(theta), 1, 2) * weight @ right(theta)

        found = {
            "M": between(self.turn, self.turn),
            "A": between(self.turn, self.slope),
            "B": between(self.slope, self.slope),
            "K": between(self.turn, self.turn, squares),
        }
        if drag:
            found["C"] = between(self.turn, self.turn, drag)
            found["D"] = between(self.turn, self.slope, drag)
        return found


class Wavy:
    """Springs of given squared frequencies, negative ones repelling, in wavy coordinates."""

    def __init__(self, rng: np.random.Generator, squares: np.ndarray) -> None:
        self.squares = squares
        n = len(squares)
        fixed = np.eye(n) + 0.2 * rng.standard_normal((n, n))
        waves = 0.12 * rng.standard_normal((2, 2, n, n))
        coordinates = WavyCoordinates(fixed, np.swapaxes(waves, 0, 1))
        self.turn, self.system = coordinates.turn, system_of(**coordinates.arrays(squares))

    def multipliers(self, speed):
        """Return all of them, from extended precision."""
        extended = np.longdouble
        found = []
        for square in self.squares:
            phase = np.sqrt(abs(extended(square))) * 8 * np.arctan(extended(1)) / extended(speed)
            if square > 0:
                wave = complex(float(np.cos(phase)), float(np.sin(phase)))
                found += [wave, wave.conjugate()]
            else:
                found += [float(np.exp(phase)), float(np.exp(-phase))]
        return np.array(found, dtype=complex)


def tame(scene):
    """True where the coordinates are nowhere near singular."""
    return np.max(np.linalg.cond(scene.turn(np.linspace(0.0, 2 * np.pi, 64)))) < 30
