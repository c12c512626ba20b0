"""Error figures of monodromy matrices, multipliers and boundaries against exact answers.

Two springs seen in random wavy coordinates z = R(theta) q have periodic mass, Coriolis,
centrifugal and stiffness terms, and multipliers and boundaries that are known in closed form.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.floquet.boundary_speeds import speed_boundaries
from elastolink.runtime.periodic import floquet_multipliers, monodromy
from elastolink.runtime.simulation.trajectory import simulate
from wavy_springs import Wavy, tame, verdict

SCENES = 200


def _population(seed, repelling):
    rng = np.random.default_rng(seed)
    done = 0
    while done < SCENES:
        squares = rng.uniform(1.0, 60.0, 2)
        if repelling:
            squares[0] *= -0.2
        scene = Wavy(rng, squares)
        if tame(scene):
            done += 1
            yield rng, scene, float(rng.uniform(0.3, 4.0))


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
    covered, idle = verdict(actual, figure)
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
    covered, idle = verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3


def test_boundary_figure():
    actual, figure = [], []
    rng = np.random.default_rng(3)
    while len(actual) < 400:
        scene = Wavy(rng, rng.uniform(1.0, 9.0, 2))
        if not tame(scene):
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
    covered, idle = verdict(actual, figure)
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
    covered, idle = verdict(actual, figure)
    assert covered >= 0.99
    assert idle <= 1e3
