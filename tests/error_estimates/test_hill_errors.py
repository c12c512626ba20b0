"""Errors of half traces, exponents, boundaries and thresholds: references of more digits."""

import elastolink as el
import numpy as np
import pytest
from boundary_truth import coefficients
from half_trace_truth import half_traces
from honesty import extended, over_scenes

PI = 4 * np.arctan(np.longdouble(1))
# Errors below the references' own are not told apart from zero.
LEAST = 1e-17
BOTH = (False, True)


def scene(rng, counts=(1, 2, 4, 8)):
    """A random function and mu, of 20 binary places."""
    count = int(rng.choice(counts))
    size = rng.uniform(0.3, 0.9) ** np.arange(count + 1)
    a, b = np.rint(rng.normal(size=(2, count + 1)) * size * 2.0**20) * 2.0**-20
    b[0] = 0.0
    mu = np.rint(10.0 ** rng.uniform(-2, 0.7) * 2.0**20) * 2.0**-20
    return el.PeriodicFunction(a, b), float(mu)


@extended
@over_scenes(11, floor=1e-18)
def test_half_traces(rng):
    """At points and, by interpolation, on a grid that holds them."""
    f, _ = scene(rng, (1, 2, 5, 12, 24))
    low = -(10.0 ** rng.uniform(-1, 1.5)) if rng.random() < 0.3 else 0.0
    high, reach = 10.0 ** rng.uniform(-1, 2.5), 10.0 ** rng.uniform(-2, 1)
    lam2, mu = rng.uniform(low, high, 2), rng.uniform(-reach, reach, 2)
    x = np.sort(np.concatenate([lam2, np.linspace(low, high, 70)]))
    y = np.sort(np.concatenate([mu, np.linspace(-reach, reach, 40)]))
    truth, at = half_traces(f, lam2, mu), (np.searchsorted(x, lam2), np.searchsorted(y, mu))
    least = 1e-18 * np.maximum(1.0, np.abs(truth.astype(float)))
    found = {
        "points": (el.discriminant(f, lam2, mu), ...),
        "grid": (el.discriminant(f, x[:, None], y), at),
    }
    return {
        name: (made.error[where], np.maximum(np.abs(made.value[where] - truth), least))
        for name, (made, where) in found.items()
    }


@extended
@over_scenes(24, floor=LEAST)
def test_exponents(rng):
    (f, mu), lam2 = scene(rng), rng.uniform(0.0, 6.0, 2)
    k = float(rng.choice([0.0, 0.03]))
    found = el.characteristic_exponents(f, lam2, mu, k)
    x = half_traces(f, lam2, mu, k) * np.exp(2 * PI * np.longdouble(k))
    rise = np.where(np.abs(x) > 1, np.arccosh(np.maximum(np.abs(x), 1)), 0) / (2 * PI)
    nu = np.arccos(np.clip(x, -1, 1)) / (2 * PI)
    gap = np.hypot((found.growth - (rise - k)).astype(float), (found.nu - nu).astype(float))
    return found.error, gap


@over_scenes(25, floor=LEAST)
@pytest.mark.parametrize("damped", [False, True])
def test_boundaries_against_enclosures(rng, damped):
    """Weak and strong damping, shallow and deep wells."""
    f, mu = scene(rng)
    mu *= 10.0 ** rng.uniform(0, 2)
    k = float(10.0 ** rng.uniform(-2, 0.8)) if damped else 0.0
    plain, proved = (el.hill_boundaries(f, mu, (0, 1, 2, 3), k, certified=c) for c in BOTH)
    assert np.isnan(plain.upper[proved.closed]).all()
    errors, gaps = [], []
    for end in ("lower", "upper"):
        known = np.isfinite(getattr(proved, end))
        gaps.append(getattr(plain, end)[known] - getattr(proved, end)[known])
        gaps[-1] -= getattr(proved, f"{end}_rest")[known]
        errors.append(plain.error[known])
    assert not np.isnan(np.concatenate(gaps)).any()
    return np.concatenate(errors), np.concatenate(gaps)


@over_scenes(22, floor=LEAST)
def test_bands_against_enclosures(rng):
    """Bands at nu = 1/4 are every other boundary of the equation with twice the period.

    With theta = 2 x the function f(2 x), four times lam2 and mu, has the phase 1/2: its odd
    regions end at the bands of nu = 1/4, both ends of region 2 j + 1 being band j.
    """
    f, mu = scene(rng)
    ours = el.characteristic_exponents(f, None, mu, nu=0.25, bands=(0, 1, 2, 3))
    a, b = np.zeros((2, 2 * f.harmonics + 1))
    a[::2], b[::2] = f.a, f.b
    proved = el.hill_boundaries(el.PeriodicFunction(a, b), 4 * mu, (1, 3, 5, 7), certified=True)
    assert proved.pair.all()
    return ours.error, ours.lam2 - 0.25 * proved.lower - 0.25 * proved.lower_rest


def waves(rng, count):
    """Return a random function whose coefficients have few binary digits."""
    size = 0.6 ** np.arange(count + 1)
    a, b = np.rint(rng.normal(size=(2, count + 1)) * size * 64.0) / 64.0
    a[0] = b[0] = 0.0
    a[1] = a[1] or 1.0
    return el.PeriodicFunction(a, b)


def closing(f, lam2, mu):
    """Return the damping at which a region closes, from the half trace where it is largest.

    A maximum's place needs half the digits of its height; without damping it is at lam2 - K^2.
    """
    return np.arccosh(np.maximum(np.abs(half_traces(f, lam2, mu)), 1)) / (2 * PI)


@extended
@over_scenes(81, floor=1e-18)
def test_damping_that_closes_regions(rng):
    f, mu = waves(rng, int(rng.choice([1, 2, 5]))), rng.uniform(0.2, 3.0, 2)
    found = el.critical_damping(f, mu, (1, 2))
    truth = closing(f, found.lam2 - found.damping**2, np.broadcast_to(mu, found.lam2.shape))
    known = np.asarray(found.damping > 1e-3)
    return (found.error[known], (found.damping - truth)[known]) if known.any() else None


@extended
@over_scenes(82, floor=1e-18)
def test_least_parameters(rng):
    """The damping that closes the region at the parameter found, over how fast it grows there."""
    f, damping = waves(rng, int(rng.choice([1, 2, 5]))), rng.uniform(0.02, 0.3, 2)
    found = el.critical_damping(f, None, (1,), damping=damping)
    kept = np.isfinite(found.mu[0])
    if not kept.any():
        return None
    mu, lam2 = found.mu[0, kept], found.lam2[0, kept]
    step = 1e-5 * mu
    low, high = el.critical_damping(f, np.stack([mu - step, mu + step]), (1,)).damping[0]
    at = closing(f, lam2 - damping[kept] ** 2, mu)
    return found.error[0, kept], (at - damping[kept]) / ((high - low) / (2 * step))


@over_scenes(83)
def test_coefficients_of_boundaries(rng):
    """Against those of Hill's matrix in 90 digits."""
    f, region = waves(rng, 2), int(rng.integers(0, 4))
    found = el.boundary_series(f, region, 3)
    truth = np.array([coefficients(f, 0, region, side, 3) for side in (-1, 1)], dtype=float)
    gaps = np.abs(np.array([found.lower, found.upper]) - truth)
    errors = np.asarray(found.error)
    # What is zero in both is known.
    known = (gaps > 1e-20) | (errors > 0.0)
    return errors[known], np.maximum(gaps, 1e-17 * np.abs(truth))[known]
