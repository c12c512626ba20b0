"""Springs seen in wavy coordinates: periodic systems whose Floquet analysis is in closed form.

Two springs seen in random wavy coordinates z = R(theta) q have periodic mass, Coriolis,
centrifugal and stiffness terms, and multipliers and boundaries that are known.
"""

from __future__ import annotations

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term


class Wavy:
    """Springs of given squared frequencies, negative ones repelling, in wavy coordinates."""

    def __init__(self, rng: np.random.Generator, squares: np.ndarray) -> None:
        self.squares = squares
        n = len(squares)
        self._fixed = np.eye(n) + 0.2 * rng.standard_normal((n, n))
        self._waves = 0.12 * rng.standard_normal((2, 2, n, n))
        terms = (
            Term("M", None, self._product(0, 0)),
            Term("A", None, self._product(0, 1)),
            Term("B", None, self._product(1, 1)),
            Term("K", None, self._product(0, 0, np.diag(squares))),
        )
        self.system = LinearPeriodic(n, terms, {}, lambda values: {})

    def transform(self, theta):
        """Return R and dR/dtheta, ``(nt, n, n)``."""
        value = np.broadcast_to(self._fixed, (len(theta), *self._fixed.shape)).copy()
        slope = np.zeros_like(value)
        for k, (c, s) in enumerate(self._waves, start=1):
            cos, sin = np.cos(k * theta)[:, None, None], np.sin(k * theta)[:, None, None]
            value += c * cos + s * sin
            slope += k * (s * cos - c * sin)
        return value, slope

    def _product(self, first, second, weight=None):
        def function(theta):
            parts = self.transform(theta)
            left = np.swapaxes(parts[first], 1, 2)
            return (left if weight is None else left @ weight) @ parts[second]

        return function

    def exact(self, speed):
        """Return the monodromy matrix in extended precision until the last product."""
        extended = np.longdouble
        period = 8 * np.arctan(extended(1)) / extended(speed)
        n = len(self.squares)
        flow = np.zeros((2 * n, 2 * n))
        for i, square in enumerate(self.squares):
            w = np.sqrt(abs(extended(square)))
            if square > 0:
                c, s = np.cos(w * period), np.sin(w * period)
                block = [[c, s / w * speed], [-w * s / speed, c]]
            else:
                c, s = np.cosh(w * period), np.sinh(w * period)
                block = [[c, s / w * speed], [w * s / speed, c]]
            flow[np.ix_([i, n + i], [i, n + i])] = np.array(block, dtype=float)
        start = self.transform(np.zeros(1))[0][0]
        zero = np.zeros((n, n))
        into = np.block([[start, zero], [zero, np.linalg.inv(start).T]])
        return np.linalg.solve(into, flow @ into)

    def multipliers(self, speed):
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
    value, _ = scene.transform(np.linspace(0.0, 2 * np.pi, 64))
    return np.max(np.linalg.cond(value)) < 30
