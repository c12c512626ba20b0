"""Figures of closing damping, of least parameters, and of the coefficients of the boundaries."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.benchmarking.reference import half_traces
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.perturbation.coefficients import boundary_series
from elastolink.runtime.hill.perturbation.thresholds import critical_damping, least_parameter
from honesty import verdict
from smith_chapter_8.exact import exact_operator, exact_series
from smith_chapter_8.surd import ExactHarmonics

SCENES = 200
extended = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


def waves(rng, count):
    """Return a random function whose coefficients have few binary digits."""
    size = 0.6 ** np.arange(count + 1)
    a, b = np.rint(rng.normal(size=(2, count + 1)) * size * 64.0) / 64.0
    a[0] = b[0] = 0.0
    a[1] = a[1] or 1.0
    return PeriodicFunction(a, b)


def closing(f, lam2, mu):
    """Return the damping at which a region closes, from the half trace where it is largest.

    A maximum's place needs half the digits of its height; without damping it is at lam2 - K^2.
    """
    height = np.abs(half_traces(f, lam2, mu))
    return np.arccosh(np.maximum(height, 1)) / (8 * np.arctan(np.longdouble(1)))


@extended
@pytest.mark.slow
def test_damping_that_closes_regions():
    rng = np.random.default_rng(81)
    ratios = []
    for _ in range(70):
        f = waves(rng, int(rng.choice([1, 2, 5])))
        mu = rng.uniform(0.2, 3.0, 2)
        found = critical_damping(f, mu, (1, 2))
        truth = closing(f, found.lam2 - found.critical**2, np.broadcast_to(mu, found.lam2.shape))
        known = np.asarray(found.critical > 1e-3)
        gaps = np.abs(found.critical - truth).astype(float)
        ratios.append((found.error / np.maximum(gaps, 1e-18))[known])
    verdict(ratios, SCENES)


@extended
@pytest.mark.slow
def test_least_parameters():
    """The damping that closes the region at the parameter found, over how fast it grows there."""
    rng = np.random.default_rng(82)
    ratios, count = [], 0
    while count < SCENES:
        f = waves(rng, int(rng.choice([1, 2, 5])))
        damping = rng.uniform(0.02, 0.3, 2)
        found = least_parameter(f, damping, (1,))
        kept = np.isfinite(found.least[0])
        if not kept.any():
            continue
        mu, lam2 = found.least[0, kept], found.lam2[0, kept]
        step = 1e-5 * mu
        low, high = critical_damping(f, np.stack([mu - step, mu + step]), (1,)).critical[0]
        slope = (high - low) / (2 * step)
        at = closing(f, lam2 - damping[kept] ** 2, mu)
        gaps = np.abs((at - damping[kept]) / slope).astype(float)
        ratios.append(found.error[0, kept] / np.maximum(gaps, 1e-18))
        count += len(gaps)
    verdict(ratios, SCENES)


def test_coefficients_of_boundaries():
    """Against the same series in rational numbers and square roots of them."""
    rng = np.random.default_rng(83)
    ratios = []
    for _ in range(SCENES):
        f, region = waves(rng, 2), int(rng.integers(0, 4))
        found = boundary_series(f, region, 3)
        exact = ExactHarmonics(
            Fraction(0),
            tuple(Fraction(float(v)) for v in f.a[1:]),
            tuple(Fraction(float(v)) for v in f.b[1:]),
        )
        series = exact_series(exact_operator([exact], region, 3), [1])
        for ours, figure, theirs in (
            (found.lower, found.error[0], series.lower),
            (found.upper, found.error[1], series.upper),
        ):
            truth = np.array([float(v) for v in theirs])
            gaps = np.abs(ours - truth)
            # What is zero in both is known.
            known = (gaps > 0.0) | (figure > 0.0)
            ratios.append((figure / np.maximum(gaps, 1e-17 * np.abs(truth) + 1e-300))[known])
    verdict(ratios, SCENES)
