"""Figures of simulated motions by every integrator, over systems whose motion was chosen first."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.simulation.trajectory import simulate
from honesty import verdict
from manufactured import Series, manufactured

SCENES = 200


def springs(seed):
    """Return a system without first derivatives, a speed, and its motion."""
    rng = np.random.default_rng(seed)
    n, speed = int(rng.integers(1, 4)), float(rng.uniform(0.3, 4.0))
    root = np.eye(n) + 0.2 * rng.uniform(-1, 1, (n, n))
    mass = root @ root.T
    spring = Series.random(rng, (n, n), 1.0, 3, symmetric=True)
    spring.cosine[0] += np.diag(rng.uniform(4.0, 100.0, n))
    motion = Series.random(rng, (n,), 1.0, int(rng.integers(1, 12)))

    def forcing(theta):
        pull = np.einsum("tij,tj->ti", spring(theta), motion(theta)) / speed**2
        return motion.derivative.derivative(theta) @ mass + pull

    terms = (Term("M", None, mass), Term("K", None, spring), Term("f", None, forcing))
    return LinearPeriodic(n, terms, {}, lambda values: {}), speed, motion


def ratios(method, made, seed, scenes=SCENES, **options):
    """Return figures over actual errors of the coordinates of random motions."""
    out = []
    for number in range(scenes):
        system, speed, motion = made(seed + number)
        zero = np.zeros(1)
        start = motion(zero)[0], speed * motion.derivative(zero)[0]
        run = simulate(system, speed, 1.0, method, initial=start, samples=32, **options)
        exact = motion(run.theta)
        peak = np.max(np.abs(exact), axis=0)
        actual = np.max(np.abs(run.q - exact), axis=0) / peak
        out.append(run.error / np.maximum(actual, 1e-17))
    return out


@pytest.mark.parametrize("method", ["magnus4", "auto"])
def test_some_motions(method):
    verdict(ratios(method, manufactured, 6100, 30), 30)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["auto", "magnus6", "magnus8", "cf4", "cf6"])
def test_motions_of_whole_systems(method):
    verdict(ratios(method, manufactured, 6200), SCENES)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["srkn4", "srkn6", "de_vogelaere"])
def test_motions_without_first_derivatives(method):
    verdict(ratios(method, springs, 6300), SCENES)


@pytest.mark.slow
def test_motions_of_given_steps_and_tolerances():
    """Methods of SciPy under a tolerance, those of structural dynamics with given steps."""
    found = ratios("DOP853", manufactured, 6400, 70, rtol=1e-7)
    found += ratios("kutta_merson", manufactured, 6500, 70, rtol=1e-7)
    found += ratios("newmark", manufactured, 6600, 70, steps=256)
    found += ratios("generalized_alpha", manufactured, 6700, 70, steps=256)
    verdict(found, SCENES)
