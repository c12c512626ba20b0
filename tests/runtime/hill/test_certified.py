"""Proved enclosures: many digits, pairs, damping, extremes; and the bounds they rest on."""

import pickle
from fractions import Fraction

import numpy as np
import pytest
from boundary_cases import rough
from boundary_truth import BITS, combined, fixed, hill_rows
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import (
    characteristic_exponents,
    critical_damping,
    hill_boundaries,
)
from hill_functions import COSINE, GENERAL


def negative_pivots(f, mu, damping, odd, harmonic, places):
    """Return how many pivots of Hill's matrix less a place are negative, at 500 bits.

    Without damping as many eigenvalues lie below (Sylvester); in any case their parity is the sign
    of the determinant.
    """
    rows = hill_rows(*combined([f], [mu]), fixed(damping), odd, harmonic)
    for place in places:
        work, count, at = {key: dict(row) for key, row in rows.items()}, 0, fixed(place)
        for key in sorted(work):
            row = work.pop(key)
            pivot = row.pop(key, 0) - at
            count += pivot < 0
            for other in list(row):
                factor = (work[other].pop(key, 0) << BITS) // pivot
                for column, value in row.items():
                    work[other][column] = work[other].get(column, 0) - (factor * value >> BITS)
        yield count


def assert_enclosed(f, mu, regions, found, harmonic):
    """Exactly the right number of eigenvalues below either end of each interval."""
    # The test's own cut raises its eigenvalues by less than this.
    slack = Fraction(1, 10**45)
    for row, n in enumerate(regions):
        for end, index in (("lower", n - 1), ("upper", n))[n == 0 :]:
            low, high = found.enclosure(end, row)
            places = low - slack, high + slack
            first, last = negative_pivots(f, mu, 0.0, n % 2, harmonic, places)
            assert first <= index < last


@pytest.mark.parametrize(
    ("f", "mu", "harmonic"),
    [(COSINE, 1.0, 30), (GENERAL, 0.7, 40), (GENERAL, -3.0, 70), (COSINE, 300.0, 90)],
)
def test_intervals_hold_the_eigenvalues_at_60_digits(f, mu, harmonic):
    regions = (0, 1, 2, 3, 4, 5, 6)
    found = hill_boundaries(f, mu, regions, certified=True)
    assert_enclosed(f, mu, regions, found, harmonic)
    assert max(found.lower_radius.max(), found.upper_radius.max()) < 1e-18
    assert not found.pair[1:].any()


@pytest.mark.parametrize("q", [1e3, 1e4])
def test_mathieu_values_at_large_q(q):
    """Low and high orders; 12 digits of max(|a|, 2 q), the larger of the value and the wells."""
    regions = (0, 1, 2, 7, 60, 150)
    proved = hill_boundaries(COSINE, -q / 2, regions, certified=True)
    assert_enclosed(COSINE, -q / 2, regions, proved, 260)
    plain = hill_boundaries(COSINE, -q / 2, regions)
    scale = np.maximum(np.abs(4 * proved.upper), 2 * q)
    assert np.all(4 * np.abs(plain.upper - proved.upper) <= 1e-12 * scale)
    assert np.all(4 * np.abs(plain.lower[1:] - proved.lower[1:]) <= 1e-12 * scale[1:])


@pytest.mark.parametrize("mu", [0.5, -2.0, 40.0])
def test_touching_edges_are_a_pair_and_never_a_gap(mu):
    """Only even harmonics: odd regions are closed, and even ones are those of half the angle."""
    f = PeriodicFunction([0.0, 0.0, 1.0])
    found = hill_boundaries(f, mu, (1, 2, 3, 4, 5), certified=True)
    np.testing.assert_array_equal(found.pair, [True, False, True, False, True])
    for i in (0, 2, 4):
        low, high = found.enclosure("lower", i), found.enclosure("upper", i)
        assert max(low[0], high[0]) <= min(low[1], high[1])
    # Open regions: Mathieu's equation in 2 theta, enclosed independently.
    same = hill_boundaries(COSINE, mu / 4, (1, 2), certified=True)
    for i, j in ((1, 0), (3, 1)):
        for end in ("lower", "upper"):
            a, b = found.enclosure(end, i), same.enclosure(end, j)
            assert a[0] <= 4 * b[1] and 4 * b[0] <= a[1]


def test_a_narrow_gap_is_proved_open():
    """Region n of Mathieu's equation is about mu^n wide; doubles do not show it, intervals do."""
    found = hill_boundaries(COSINE, 1e-3, (1, 2, 3, 4, 5, 6), certified=True)
    widths = [
        float(found.enclosure("upper", i)[0] - found.enclosure("lower", i)[1]) for i in range(6)
    ]
    # Leading term (DLMF 28.6): a_n - b_n = 8 (q/4)^n / ((n-1)!)^2, q = 2 mu, lam2 = a/4.
    expected = [2 * (0.5e-3) ** n / np.prod(np.arange(1.0, n)) ** 2 for n in range(1, 7)]
    np.testing.assert_allclose(widths[:5], expected[:5], rtol=1e-5)
    assert not found.pair.any()


@pytest.mark.parametrize(("mu", "k"), [(-3.0, 0.05), (0.8, 0.2)])
def test_damped_intervals_hold_an_eigenvalue_at_40_digits(mu, k):
    """The determinant of the damped matrix changes its sign across every interval."""
    regions = (0, 1, 2, 3)
    found = hill_boundaries(GENERAL, mu, regions, k, certified=True)
    plain = hill_boundaries(GENERAL, mu, regions, k)
    np.testing.assert_array_equal(found.closed, np.isnan(plain.upper))
    assert found.passed
    seen = 0
    for row, n in enumerate(regions):
        for end in ("lower", "upper")[n == 0 :] if not found.closed[row] else ():
            low, high = found.enclosure(end, row)
            # The cut of the test's matrix, whose tail falls faster than 1e-25 here.
            places = low - Fraction(1, 10**25), high + Fraction(1, 10**25)
            first, last = negative_pivots(GENERAL, mu, k, n % 2, 26, places)
            assert (first + last) % 2
            seen += 1
    assert seen >= 3


def test_damping_closes_with_proof_and_near_the_tip_says_undecided():
    mu = 0.6
    closing = float(critical_damping(COSINE, mu, (1,)).damping[0])
    inside, beyond, tip = (
        hill_boundaries(COSINE, mu, (1,), closing * k, certified=True) for k in (1 - 1e-6, 1.001, 1)
    )
    assert inside.passed and not inside.closed[0] and inside.lower[0] < inside.upper[0]
    assert beyond.passed and beyond.closed[0] and np.isnan(beyond.upper[0])
    assert not tip.passed and not tip.closed[0] and np.isnan(tip.upper[0])
    with pytest.raises(BadInput, match="finite end"):
        tip.enclosure("lower", 0)


def test_shapes_export_and_refusals(tmp_path):
    found = hill_boundaries(GENERAL, [[0.1, 0.2]], (0, 1, 3), [[0.0], [0.01]], certified=True)
    assert found.lower.shape == found.pair.shape == found.upper_radius.shape == (3, 2, 2)
    assert np.all(found.lower[0] == -np.inf)
    assert pickle.loads(pickle.dumps(found)).to_dict() == found.to_dict()
    found.save(tmp_path / "b.csv")
    with pytest.raises(BadInput, match="'lower' or 'upper'"):
        found.enclosure("middle", 0)
    nothing = hill_boundaries(GENERAL, np.zeros((0,)), (1,), certified=True)
    assert nothing.lower.shape == (1, 0)
    assert hill_boundaries(GENERAL, 1.0, (), certified=True).upper.shape == (0,)


@pytest.mark.parametrize(
    "f",
    [PeriodicFunction([0.5]), PeriodicFunction([0.0], [0.0, 1.0]), PeriodicFunction([0.0, 0.0])],
)
@pytest.mark.parametrize("k", [0.0, 0.1])
def test_poor_functions(f, k):
    agree(f, 1.5, (0, 1, 2), k)


def agree(f, mu, regions, damping=0.0):
    """Plain and certified boundaries, each within the other's estimate; the certified ones."""
    plain = hill_boundaries(f, mu, regions, damping)
    proved = hill_boundaries(f, mu, regions, damping, certified=True)
    assert proved.passed
    np.testing.assert_array_equal(np.isnan(plain.upper), np.isnan(proved.upper))
    for end in ("lower", "upper"):
        ours, truth = getattr(plain, end), getattr(proved, end)
        there = np.isfinite(truth)
        slack = (plain.error + proved.error)[there]
        assert np.all(np.abs(ours[there] - truth[there]) <= slack)
    return proved


@pytest.mark.parametrize("mu", [100.0, -1e4, pytest.param(1e5, marks=pytest.mark.slow)])
def test_mu_is_large(mu):
    """Deep wells: lam2 < 0, regions that cover all but a hair."""
    found = agree(COSINE, mu, (0, 1, 2, 3))
    assert np.all(found.upper < 0.0)
    assert found.error.max() < 1e-15 * abs(mu)
    # The stable band between two regions narrows like exp(-8 sqrt(|mu| / 2)) or so; the ends
    # belong to the two problems, so that each is enclosed by itself.
    if abs(mu) <= 1e4:
        gap = found.enclosure("lower", 1)[1] - found.enclosure("upper", 0)[0]
        assert gap >= 0


@pytest.mark.parametrize(
    ("mu", "n", "k"), [(150.0, 1, 5.137), (100.0, 3, 6.0), (30.0, 0, 2.0), (-2000.0, 2, 10.9)]
)
def test_strong_damping_in_deep_wells(mu, n, k):
    """The eigenvalues of the matrix are off by many times its round-off, or beyond their slack."""
    assert np.isfinite(agree(COSINE, mu, (n,), k).upper[0])


@pytest.mark.parametrize("b", [0.125, -0.25, 0.5])
def test_coexistence_in_the_whittaker_hill_equation(b):
    """cos theta + b cos 2 theta closes all even regions at mu = 2 b, odd ones from 3 on at 8 b.

    There it is Ince's equation with polynomial solutions; b and mu are exact in doubles.
    """
    f, regions = PeriodicFunction([0.0, 1.0, b]), (1, 2, 3, 4, 5, 6)
    for mu, closed in ((2 * b, (2, 4, 6)), (8 * b, (3, 5))):
        found = agree(f, mu, regions)
        np.testing.assert_array_equal(found.pair, [n in closed for n in regions])
        for i in np.flatnonzero(found.pair):
            low, high = found.enclosure("lower", i), found.enclosure("upper", i)
            assert max(low[0], high[0]) <= min(low[1], high[1])
    for mu in (2 * b + 2.0**-40, 2 * b - 2.0**-40):
        # 1e-12 beside it region 2 is open, by less than doubles show, and that is proved.
        other = hill_boundaries(f, mu, (2,), certified=True)
        gap = float(other.enclosure("upper", 0)[0] - other.enclosure("lower", 0)[1])
        assert 1e-15 < gap < 1e-11 and not other.pair[0]


def test_three_equal_wells_make_clusters():
    """cos 3 theta, deep: three nearly equal levels in every group, told apart or held together."""
    f = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    found = agree(f, 400.0, (0, 1, 2, 3, 4, 5))
    for n in (1, 2, 4, 5):
        assert found.pair[n]
    # Levels r of the well in 3 theta: mu/9 in Mathieu's equation, whose own ends these are.
    same = agree(COSINE, 400.0 / 9, (0, 1, 2))
    np.testing.assert_allclose(found.upper[[0, 3]], 9 * same.upper[[0, 1]], rtol=1e-15)


@pytest.mark.slow
def test_many_rough_harmonics_certified():
    found = agree(rough(300), 0.3, (1, 2))
    assert found.error.max() < 1e-13


@pytest.mark.parametrize("mu", [1e-300, 1e4, -300.0])
def test_bands_at_the_extremes(mu):
    bands = characteristic_exponents(COSINE, None, mu, nu=[0.0, 0.25, 0.5], bands=(0, 1))
    assert np.all(np.diff(bands.lam2, axis=0) >= -bands.error[1:])
