"""Error figures of monodromy matrices, multipliers and boundaries against exact answers.

Two springs seen in random wavy coordinates z = R(theta) q have periodic mass, Coriolis,
centrifugal and stiffness terms, and multipliers and boundaries that are known in closed form.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.families import LinearPeriodic, Term
from elastolink.runtime.floquet.boundary_speeds import speed_boundaries
from elastolink.runtime.floquet.monodromy_matrix import floquet_multipliers, monodromy
from elastolink.runtime.simulation.trajectory import simulate

SCENES = 200


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


def _tame(scene):
    """True where the coordinates are nowhere near singular."""
    value, _ = scene.transform(np.linspace(0.0, 2 * np.pi, 64))
    return np.max(np.linalg.cond(value)) < 30


def _population(seed, repelling):
    rng = np.random.default_rng(seed)
    done = 0
    while done < SCENES:
        squares = rng.uniform(1.0, 60.0, 2)
        if repelling:
            squares[0] *= -0.2
        scene = Wavy(rng, squares)
        if _tame(scene):
            done += 1
            yield rng, scene, float(rng.uniform(0.3, 4.0))


def _verdict(actual, figure):
    """Return the share of covered scenes and the median of figure over actual error."""
    actual, figure = np.asarray(actual), np.asarray(figure)
    kept = actual > 0
    return np.mean(actual <= figure), np.median(figure[kept] / actual[kept])


@pytest.mark.parametrize("rtol", [1e-11, 1e-5])
def test_monodromy_figure(rtol):
    actual, figure = [], []
    for _, scene, speed in _population(1, repelling=False):
        found = monodromy(scene.system, speed, rtol=rtol)
        exact = scene.exact(speed) / found.scale[:, None] * found.scale
        top = np.max(np.abs(exact))
        actual.append(np.max(np.abs(found.scaled - exact)) / top)
        figure.append(float(found.error))
        assert found.passed, found.checks
    covered, idle = _verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3
    assert np.max(figure) <= rtol


@pytest.mark.parametrize("repelling", [False, True])
def test_multiplier_figure(repelling):
    actual, figure = [], []
    for _, scene, speed in _population(2, repelling):
        found = floquet_multipliers(scene.system, speed)
        exact = scene.multipliers(speed)
        assert found.passed, (found.checks, scene.squares, speed)
        for value, error in zip(found.multipliers, found.error, strict=True):
            actual.append(np.min(np.abs(exact - value)))
            figure.append(error)
    covered, idle = _verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3


def test_boundary_figure():
    actual, figure = [], []
    rng = np.random.default_rng(3)
    while len(actual) < 400:
        scene = Wavy(rng, rng.uniform(1.0, 9.0, 2))
        if not _tame(scene):
            continue
        found = speed_boundaries(scene.system, speed_range=(0.9, 7.0))
        # w = 2 Omega/k, k odd for -1; every one double, as nothing couples.
        natural = np.sqrt(scene.squares)
        exact = np.sort((2 * natural[:, None] / np.arange(1, 9)).ravel())
        exact = np.repeat(exact[(exact > 0.9) & (exact < 7.0)], 2)
        assert len(found.speed) == len(exact)
        assert found.passed, found.checks
        actual.extend(np.abs(found.speed - exact))
        figure.extend(found.error)
    covered, idle = _verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3


@pytest.mark.parametrize("method", ["auto", "gauss_legendre", "rk4", "magnus4"])
def test_motion_figure(method):
    actual, figure = [], []
    for rng, scene, speed in _population(4, repelling=False):
        start = rng.standard_normal((2, 2))
        run = simulate(scene.system, speed, 2.0, method, initial=(start[0], start[1]), samples=48)
        value, slope = scene.transform(run.theta)
        z0 = value[0] @ start[0]
        zd0 = value[0] @ start[1] + speed * slope[0] @ start[0]
        natural, time = np.sqrt(scene.squares), run.time[:, None]
        z = z0 * np.cos(natural * time) + zd0 / natural * np.sin(natural * time)
        exact = np.linalg.solve(value, z[:, :, None])[:, :, 0]
        peak = np.max(np.abs(exact), axis=0)
        actual.extend(np.max(np.abs(run.q - exact), axis=0) / peak)
        figure.extend(run.error)
    covered, idle = _verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3
