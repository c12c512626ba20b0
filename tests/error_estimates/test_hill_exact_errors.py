"""Figures of certified ends, bands and derivatives against references of more digits."""

from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.derivatives import boundary_derivatives
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.exact.quasi import bloch_bands, characteristic_exponents
from elastolink.runtime.hill.exact.systems import hill_exponents
from honesty import verdict

SOME = [pytest.param(20, id="some"), pytest.param(200, marks=pytest.mark.slow, id="all")]
STEP = 2.0**-14


def scene(rng):
    """A random function whose coefficients, like mu, bear a change by STEP without rounding."""
    count = int(rng.choice([1, 2, 4, 8]))
    size = rng.uniform(0.3, 0.8) ** np.arange(count + 1)
    a, b = np.rint(rng.normal(size=(2, count + 1)) * size * 2.0**20) * 2.0**-20
    b[0] = 0.0
    mu = np.rint(10.0 ** rng.uniform(-2, 0.7) * 2.0**20) * 2.0**-20
    return PeriodicFunction(a, b), float(mu)


def exact_ends(f, mu, n, k):
    found = hill_boundaries(f, mu, (n,), k, certified=True)
    return [sum(found.enclosure(end, 0)) / 2 for end in ("lower", "upper")]


@pytest.mark.parametrize("scenes", SOME)
def test_plain_boundaries_against_enclosures(scenes):
    rng = np.random.default_rng(21)
    ratios = []
    for _ in range(scenes):
        f, mu = scene(rng)
        plain = hill_boundaries(f, mu, (1, 2, 3, 4))
        proved = hill_boundaries(f, mu, (1, 2, 3, 4), certified=True)
        for end in ("lower", "upper"):
            ours = getattr(plain, end)
            gaps = ours - getattr(proved, end) - getattr(proved, f"{end}_rest")
            ratios.append(plain.error / np.maximum(np.abs(gaps), 1e-17))
    verdict(ratios, 8 * scenes)


@pytest.mark.parametrize("scenes", SOME)
def test_damped_boundaries_against_enclosures(scenes):
    """Weak and strong damping, shallow and deep wells."""
    rng = np.random.default_rng(25)
    ratios = []
    for _ in range(scenes):
        f, _ = scene(rng)
        mu, k = float(10.0 ** rng.uniform(-1, 2.5)), float(10.0 ** rng.uniform(-1, 0.8))
        plain = hill_boundaries(f, mu, (0, 1, 2, 3), k)
        proved = hill_boundaries(f, mu, (0, 1, 2, 3), k, certified=True)
        for end in ("lower", "upper"):
            known = np.isfinite(getattr(proved, end))
            gaps = getattr(plain, end)[known] - getattr(proved, end)[known]
            assert not np.isnan(gaps).any()
            ratios.append(plain.error[known] / np.maximum(np.abs(gaps), 1e-17))
    verdict(ratios, 2 * scenes)


@pytest.mark.parametrize("scenes", SOME)
def test_bands_against_enclosures(scenes):
    """Bands at nu = 1/4 are every other boundary of the equation with twice the period.

    With theta = 2 x the function f(2 x), four times lam2 and mu, has the phase 1/2: its odd
    regions end at the bands of nu = 1/4, both ends of region 2 j + 1 being band j.
    """
    rng = np.random.default_rng(22)
    ratios = []
    for _ in range(scenes):
        f, mu = scene(rng)
        ours = bloch_bands(f, mu, 0.25, (0, 1, 2, 3))
        a, b = np.zeros((2, 2 * f.harmonics + 1))
        a[::2], b[::2] = f.a, f.b
        proved = hill_boundaries(PeriodicFunction(a, b), 4 * mu, (1, 3, 5, 7), certified=True)
        assert proved.pair.all()
        gaps = ours.lam2 - 0.25 * proved.lower - 0.25 * proved.lower_rest
        ratios.append(ours.error / np.maximum(np.abs(gaps), 1e-17))
    verdict(ratios, 4 * scenes)


@pytest.mark.parametrize("scenes", SOME)
@pytest.mark.parametrize("k", [0.0, 2.0**-6])
def test_derivatives_against_differences_of_enclosures(scenes, k):
    """Central differences of sixth order, between ends known to 1e-20 or better."""
    rng = np.random.default_rng(23)
    weights = {1: Fraction(3, 4), 2: Fraction(-3, 20), 3: Fraction(1, 60)}
    ratios = []
    for _ in range(scenes):
        f, mu = scene(rng)
        n = int(rng.integers(1, 4))
        found = boundary_derivatives(f, mu, (n,), damping=k)
        if not hill_boundaries(f, mu, (n,), k).width[0] > 0.02:
            # Closed, or so narrow that the ends turn about each other within the steps.
            continue
        slopes = [Fraction(0), Fraction(0)]
        for j, weight in weights.items():
            up, down = (exact_ends(f, mu + side * j * STEP, n, k) for side in (1, -1))
            for end in (0, 1):
                slopes[end] += weight * (up[end] - down[end]) / Fraction(STEP)
        ours = (found.lower[0, 0], found.upper[0, 0])
        gaps = [abs(float(Fraction(float(x)) - y)) for x, y in zip(ours, slopes, strict=True)]
        # The difference itself: the seventh derivative over 140, at most about 1 / width^6 there,
        # times STEP^6 = 5e-26.
        ratios.append(found.error[0, 0] / np.maximum(gaps, 1e-17))
    verdict(ratios, scenes // 2)


@pytest.mark.parametrize("scenes", SOME)
def test_exponents_of_systems_against_the_single_equation(scenes):
    """One mode, away from double exponents, where the half trace gives nu to 1e-14 or so."""
    rng = np.random.default_rng(24)
    ratios = []
    for _ in range(scenes):
        f, mu = scene(rng)
        lam2, k = rng.uniform(0.0, 6.0), float(rng.choice([0.0, 0.03]))
        terms = (
            Term("M", None, np.eye(1)),
            Term("K", None, lam2 * np.eye(1), power=2),
            Term("Kg", None, lambda theta, g=f * mu: g(theta)[:, None, None], power=2),
            Term("C", None, 2 * k * np.eye(1), power=1),
        )
        ours = hill_exponents(LinearPeriodic(1, terms, {}, lambda values: {}), 1.0)
        truth = characteristic_exponents(f, lam2, mu, k)
        if truth.error > 1e-13:
            continue
        turns = np.abs(ours.exponents.imag - np.rint(ours.exponents.imag))
        gaps = np.hypot(turns - truth.nu, ours.exponents.real.max() - truth.growth)
        growing = int(ours.exponents.real.argmax())
        ratios.append(ours.error[growing : growing + 1] / max(gaps[growing], 1e-17))
    verdict(ratios, scenes // 4)
