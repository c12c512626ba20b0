"""Mathieu's and Meissner's equations, and those of Whittaker and Hill."""

import elastolink as el
import mpmath
import numpy as np
import pytest
from honesty import over_scenes
from scipy.special import mathieu_a, mathieu_b

# Abramowitz & Stegun table 20.1 (DLMF 28.1 cites it), all digits printed there.
TABLE = {
    "a0": (-5.80004602, -13.93697996, -40.25677955),
    "b1": (-5.79008060, -13.93655248, -40.25677898),
    "a1": (1.85818754, -2.39914240, -21.31489969),
    "b2": (2.09946045, -2.38215824, -21.31486062),
    "a2": (7.44910974, 7.71736985, -3.52216473),
    "b5": (25.51081605, 26.76642636, 28.06276590),
    "a5": (25.54997175, 27.70376873, 40.05019099),
}
TURN = 2.0 * np.pi


@pytest.mark.smoke
@pytest.mark.parametrize("name", TABLE)
def test_the_printed_table(name):
    found = el.Mathieu.characteristic(int(name[1]), (5, 10, 25), name[0])
    np.testing.assert_allclose(found.value, TABLE[name], rtol=0, atol=0.6e-8)


def test_signs_of_q():
    """DLMF 28.2.26: a_2n(-q) = a_2n(q), a_2n+1(-q) = b_2n+1(q), b_2n(-q) = b_2n(q)."""
    q = np.array([0.3, 2.0, 40.0])
    for m in (1, 2, 3, 4):
        for kind, other in (("a", "b"), ("b", "a")):
            mirrored = el.Mathieu.characteristic(m, -q, kind).value
            wanted = el.Mathieu.characteristic(m, q, other if m % 2 else kind).value
            np.testing.assert_allclose(mirrored, wanted, rtol=1e-13, atol=1e-12)


def test_the_characteristic_values_of_a_constant_coefficient():
    for m in (0, 1, 6):
        assert el.Mathieu.characteristic(m, 0.0).value == m * m
    found = el.Mathieu.characteristic(3, np.linspace(-1, 1, 5))
    assert found.value.shape == found.error.shape == (5,)
    assert found.passed and found.plot().lines


def test_mathieus_notation():
    """On the boundaries that SciPy computes the Hill form has the half traces 1 and -1 in turn."""
    for m in range(1, 6):
        for a in (mathieu_a(m, 5.0), mathieu_b(m, 5.0)):
            case = el.Mathieu(a, 5.0)
            half = el.discriminant(case.function(), case.lam2, case.mu).value
            assert half == pytest.approx((-1.0) ** m, abs=1e-12)
    with pytest.raises(el.BadInput, match=r"^a: "):
        _ = el.Mathieu(np.nan, 1.0).lam2


def meissner_boundaries(mu, regions=(1, 2), levels=(1.0, -1.0), lengths=(np.pi, np.pi), damping=0):
    return el.hill_boundaries(el.Meissner(levels, lengths), mu, regions, damping)


def true_half_trace(levels, lengths, lam2, mu, damping):
    """Half the trace of the product of the intervals' matrices at lam2 - K^2, in the digits set."""
    m = mpmath.eye(2)
    for level, length in zip(levels, lengths, strict=True):
        q = lam2 + mpmath.mpf(mu) * mpmath.mpf(level) - mpmath.mpf(damping) ** 2
        v = mpmath.sqrt(mpmath.mpc(q))
        x = v * mpmath.mpf(length)
        sine = mpmath.sin(x) / v if v else mpmath.mpf(length)
        m = mpmath.matrix([[mpmath.cos(x), sine], [-q * sine, mpmath.cos(x)]]) * m
    return ((m[0, 0] + m[1, 1]) / 2).real


def root(levels, lengths, mu, n, near, damping=0.0):
    """Return the zero of J_2 - (-1)^n cosh(2 pi K) next to a value."""
    level = (-1) ** n * mpmath.cosh(2 * mpmath.pi * mpmath.mpf(damping))
    start = mpmath.mpf(float(near))
    nudge = mpmath.mpf(10) ** -12 * (1 + abs(start))

    def gap(lam2):
        return true_half_trace(levels, lengths, lam2, mu, damping) - level

    return mpmath.findroot(gap, (start, start + nudge), tol=mpmath.mpf(10) ** -80, verify=False)


@over_scenes(8, few=10, many=None, floor=1e-40)
@pytest.mark.parametrize("damped", [False, True])
def test_boundaries_against_fifty_digits(rng, damped):
    mu, n = float(rng.uniform(-30.0, 30.0)), int(rng.integers(0, 8))
    k = float(10.0 ** rng.uniform(-4.0, -0.3)) if damped else 0.0
    first = float(rng.uniform(0.2, 5.0))
    levels, lengths = tuple(map(float, rng.uniform(-2.0, 2.0, 2))), (first, TURN - first)
    found = meissner_boundaries(mu, (n,), levels, lengths, k)
    assert found.passed
    if np.isnan(found.upper[0]):
        assert damped
        return None
    ends = [found.lower[0], found.upper[0]][n == 0 :]
    with mpmath.workdps(50):
        gaps = [root(levels, lengths, mu, n, end, k) - mpmath.mpf(float(end)) for end in ends]
    return found.error[0], [float(gap) for gap in gaps]


@pytest.mark.parametrize("lengths", [(np.pi, np.pi), (1.0, TURN - 1.0)])
@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_regions_vanish_where_both_intervals_hold_whole_half_waves(n, lengths):
    levels = (0.7, -0.4)
    j = np.arange(n - 1, 0, -1)
    first, second = (j * np.pi / lengths[0]) ** 2, ((n - j) * np.pi / lengths[1]) ** 2
    other = j * lengths[1] != (n - j) * lengths[0]
    mu = (first - second)[other] / (levels[0] - levels[1])
    lam2, equal = first[other] - mu * levels[0], lengths[0] == lengths[1]
    assert len(mu) == n - 1 - (equal and n % 2 == 0)
    for place, factor in zip(lam2, mu, strict=True):
        found = meissner_boundaries(factor, (n,), levels, lengths)
        assert abs(found.lower[0] - place) <= found.error[0] + 1e-14 * abs(place)
        assert abs(found.upper[0] - place) <= found.error[0] + 1e-14 * abs(place)
    if len(mu) > 1:
        # Between two of them the region is open.
        between = meissner_boundaries(0.6 * mu[0] + 0.4 * mu[1], (n,), levels, lengths)
        assert between.width[0] > 1e-3


def test_a_region_that_damping_closed_is_stable_throughout():
    bare = meissner_boundaries(0.7, (3,))
    assert np.isnan(meissner_boundaries(0.7, (3,), damping=0.2).upper[0])
    inside = np.linspace(bare.lower[0], bare.upper[0], 201) + 0.04
    assert np.all(el.discriminant(el.Meissner(), inside, 0.7, 0.2).stable)
    assert np.all(el.characteristic_exponents(el.Meissner(), inside, 0.7, 0.2).stable)


@over_scenes(4, floor=1e-40)
def test_half_traces_of_any_number_of_levels(rng):
    """Aannaque (7.9)-(7.11) for N = 1 to 12, steep intervals and damping included."""
    lengths = rng.uniform(0.1, 1.0, int(rng.integers(1, 13)))
    lengths *= TURN / lengths.sum()
    case = el.Meissner(tuple(rng.uniform(-1, 1, lengths.size)), tuple(lengths))
    lam2, mu = float(rng.uniform(-3, 20)), float(rng.normal() * 10 ** rng.uniform(-1, 2))
    k = float(rng.uniform(0, 2)) if rng.random() < 0.5 else 0.0
    found = el.discriminant(case, lam2, mu, k)
    assert found.passed
    with mpmath.workdps(50):
        truth = true_half_trace(case.levels, case.lengths, mpmath.mpf(lam2), mu, k)
        truth *= mpmath.exp(-2 * mpmath.pi * mpmath.mpf(k))
        gap = float(truth - mpmath.mpf(float(found.value)))
    assert abs(gap) <= found.error
    return found.error, gap


def test_a_smooth_function_in_steps():
    """The method of Pipes and Hsu: half traces err with the second power of the step."""
    f, gaps = el.PeriodicFunction([0.0, 1.0, 0.3], [0.0, 0.2]), []
    exact = el.discriminant(f, [0.3, 2.0], 0.8, 0.05).value
    for n in (50, 100, 200):
        steps = el.Meissner.of(f(TURN / n * (np.arange(n) + 0.5)))
        gaps.append(np.abs(el.discriminant(steps, [0.3, 2.0], 0.8, 0.05).value - exact).max())
    np.testing.assert_allclose(np.log2(np.divide(gaps[:-1], gaps[1:])), 2.0, atol=0.02)


def test_half_traces_of_levels_over_grids_and_beyond_doubles():
    case = el.Meissner((2.0, -1.0, 0.5), (1.0, 2.0, TURN - 3.0))
    grid = el.discriminant(case, np.linspace(0, 3, 4)[:, None], np.linspace(0, 2, 3), 0.1)
    assert grid.value.shape == (4, 3) and grid.method == "exact matrices of intervals"
    assert grid.value[2, 1] == el.discriminant(case, 2.0, 1.0, 0.1).value
    np.testing.assert_allclose(case([0.5, 1.5, 4.0, 7.0]), [2.0, -1.0, 0.5, 2.0])
    assert case.mean == pytest.approx((2.0 - 2.0 + 0.5 * (TURN - 3.0)) / TURN)
    steep = el.discriminant(case, -1e6, 1.0)
    assert np.isinf(steep.value) and not steep.passed
