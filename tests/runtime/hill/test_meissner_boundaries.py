"""Meissner's equation with two levels: exact boundaries, coexistence, damping."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import (
    coexistence_points,
    hill_boundaries,
    meissner_boundaries,
    perturbation_boundaries,
    piecewise_monodromy,
)

TURN = 2.0 * np.pi


def root(levels, lengths, mu, n, near, damping=0.0):
    """Return the zero of J_2 - (-1)^n cosh(2 pi K) next to a value, in the digits that are set."""
    k = mpmath.mpf(damping)

    def gap(lam2):
        m = mpmath.eye(2)
        for level, length in zip(levels, lengths, strict=True):
            v = mpmath.sqrt(mpmath.mpc(lam2 - k * k + mpmath.mpf(mu) * mpmath.mpf(level)))
            x = v * mpmath.mpf(length)
            c, s = mpmath.cos(x), mpmath.sin(x)
            m = mpmath.matrix([[c, s / v], [-v * s, c]]) * m
        return ((m[0, 0] + m[1, 1]) / 2).real - (-1) ** n * mpmath.cosh(2 * mpmath.pi * k)

    start = mpmath.mpf(float(near))
    nudge = mpmath.mpf(10) ** -12 * (1 + abs(start))
    return mpmath.findroot(gap, (start, start + nudge), tol=mpmath.mpf(10) ** -80, verify=False)


@pytest.mark.parametrize("damped", [False, True])
def test_boundaries_against_fifty_digits(damped):
    random = np.random.default_rng(8)
    shares, closed = [], 0
    for i in range(24 if damped else 40):
        mu, n = float(random.uniform(-30.0, 30.0)), i % 8
        k = float(10.0 ** random.uniform(-4.0, -0.3)) if damped else 0.0
        first = float(random.uniform(0.2, 5.0))
        levels, lengths = tuple(map(float, random.uniform(-2.0, 2.0, 2))), (first, TURN - first)
        found = meissner_boundaries(mu, (n,), levels, lengths, k)
        assert found.passed
        if np.isnan(found.upper[0]):
            closed += 1
            continue
        for end in (found.lower[0], found.upper[0])[n == 0 :]:
            with mpmath.workdps(50):
                off = abs(root(levels, lengths, mu, n, end, k) - mpmath.mpf(float(end)))
            shares.append(float(off / float(found.error[0])))
    assert max(shares) <= 1.0
    assert np.median(shares) >= 1e-3
    assert (closed > 0) == damped and len(shares) > 25


@pytest.mark.parametrize("lengths", [(np.pi, np.pi), (1.0, TURN - 1.0)])
@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_regions_vanish_where_both_intervals_hold_whole_half_waves(n, lengths):
    levels = (0.7, -0.4)
    lam2, mu = coexistence_points(n, levels, lengths)
    equal = lengths[0] == lengths[1]
    assert len(mu) == n - 1 - (equal and n % 2 == 0)
    for place, factor in zip(lam2, mu, strict=True):
        found = meissner_boundaries(factor, (n,), levels, lengths)
        assert abs(found.lower[0] - place) <= found.error[0] + 1e-14 * abs(place)
        assert abs(found.upper[0] - place) <= found.error[0] + 1e-14 * abs(place)
        q = place + factor * np.array(levels)
        matrix = piecewise_monodromy(q, lengths).matrix
        np.testing.assert_allclose(matrix, (-1.0) ** n * np.eye(2), atol=1e-12 * np.max(q))
    if len(mu) > 1:
        # Between two of them the region is open.
        between = meissner_boundaries(0.6 * mu[0] + 0.4 * mu[1], (n,), levels, lengths)
        assert between.width[0] > 1e-3


def square_wave(harmonics):
    m = np.arange(harmonics + 1)
    wave = np.where(m % 2 == 1, 4.0 / (np.pi * np.maximum(m, 1)) * np.where(m % 4 == 1, 1, -1), 0.0)
    return PeriodicFunction(wave)


def test_boundaries_of_the_truncated_square_wave_tend_to_them():
    regions, mu = (0, 1, 2, 3, 4), np.array([0.3, 1.1])
    exact = meissner_boundaries(mu, regions)
    gaps = []
    for harmonics in (15, 31, 63):
        near = hill_boundaries(square_wave(harmonics), mu, regions)
        gaps.append(np.max(np.abs(near.upper - exact.upper)))
    # What is left out has coefficients 1/m, felt through 1/m^2: the third power of 1/m.
    assert np.all(np.log2(np.divide(gaps[:-1], gaps[1:])) > 2.7)


@pytest.mark.parametrize(("order", "power"), [(1, 2), (2, 3)])
def test_perturbation_misses_the_exact_boundaries_by_the_next_power(order, power):
    # Region 3: its third-order term does not vanish.  The truncation is felt below 1e-7 mu^2.
    f, gaps = square_wave(199), []
    for mu in (0.08, 0.04):
        exact = meissner_boundaries(mu, (3,))
        near = perturbation_boundaries(f, mu, (3,), order=order, form="series")
        gaps.append(float(np.max(np.abs([near.lower - exact.lower, near.upper - exact.upper]))))
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(power, abs=0.15)


@pytest.mark.parametrize("damping", [0.01, 0.1, 1.0])
def test_damped_boundaries_are_those_of_the_hill_matrix(damping):
    regions, mu = (0, 1, 2, 3), np.array([0.1, 0.7, 1.5])
    exact = meissner_boundaries(mu, regions, damping=damping)
    near = hill_boundaries(square_wave(79), mu, regions, damping=damping)
    assert exact.passed
    assert np.array_equal(np.isnan(exact.upper), np.isnan(near.upper))
    # The truncation is felt through the third power of 1/80.
    np.testing.assert_allclose(exact.upper, near.upper, rtol=0.0, atol=1e-5)
    np.testing.assert_allclose(exact.lower[1:], near.lower[1:], rtol=0.0, atol=1e-5)


def test_a_region_that_damping_closed_is_stable_throughout():
    bare = meissner_boundaries(0.7, (3,))
    assert np.isnan(meissner_boundaries(0.7, (3,), damping=0.2).upper[0])
    inside = np.linspace(bare.lower[0], bare.upper[0], 201) + 0.04
    q = inside[:, None] + 0.7 * np.array([1.0, -1.0])
    assert np.all(piecewise_monodromy(q, [np.pi, np.pi], 0.2).stable)


def test_damping_broadcasts_and_zero_is_none():
    found = meissner_boundaries([[0.5], [2.0]], (1, 2), damping=[0.0, 0.05, 0.1])
    assert found.lower.shape == (2, 2, 3) and found.damping.shape == (2, 3)
    plain = meissner_boundaries([0.5, 2.0], (1, 2))
    assert np.array_equal(found.upper[..., 0], plain.upper)
    assert np.all(found.width[..., 1] < found.width[..., 0])


def test_equal_levels_leave_no_region():
    found = meissner_boundaries([0.0, 2.0], (0, 1, 2), (0.5, 0.5))
    np.testing.assert_allclose(found.upper[:, 1], np.array([0.0, 0.25, 1.0]) - 1.0, atol=1e-13)
    np.testing.assert_allclose(found.lower[1:], found.upper[1:], atol=1e-13)
    assert np.all(found.lower[0] == -np.inf)


def test_the_sign_of_mu_turns_the_levels():
    one = meissner_boundaries(1.7, (0, 1, 2, 3), (0.4, -1.0), (2.0, TURN - 2.0))
    other = meissner_boundaries(-1.7, (0, 1, 2, 3), (-0.4, 1.0), (2.0, TURN - 2.0))
    assert np.array_equal(one.upper, other.upper) and np.array_equal(one.lower, other.lower)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"mu": np.nan}, "mu"),
        ({"mu": 1e9}, "mu"),
        ({"damping": -1.0}, "damping"),
        ({"regions": (-1,)}, "regions"),
        ({"levels": (1.0, 2.0, 3.0)}, "levels"),
        ({"lengths": (1.0, 1.0)}, "2 pi"),
        ({"lengths": (-1.0, TURN + 1.0)}, "lengths"),
    ],
)
def test_bad_boundaries_are_refused(change, word):
    with pytest.raises(BadInput, match=word):
        meissner_boundaries(**{"mu": 1.0, **change})


@pytest.mark.parametrize(
    ("n", "levels", "word"), [(0, (1.0, -1.0), "n"), (2, (1.0, 1.0), "levels")]
)
def test_bad_coexistence_is_refused(n, levels, word):
    with pytest.raises(BadInput, match=word):
        coexistence_points(n, levels)
