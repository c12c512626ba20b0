import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.exact.verification import boundary_checks
from elastolink.runtime.hill.half_trace import discriminant
from hill_functions import functions
from hypothesis import given, settings
from hypothesis import strategies as st

FUNCTIONS = functions()
COSINE = PeriodicFunction([0.0, 1.0])

# Abramowitz & Stegun, Table 20.1: characteristic values of y'' + (a - 2 q cos 2x) y = 0, eight
# decimals printed: q, a0, (b1, a1), (b2, a2), (b5, a5).
MATHIEU = [
    (
        5,
        -5.80004602,
        (-5.79008060, 1.85818754),
        (2.09946045, 7.44910974),
        (25.51081605, 25.54997175),
    ),
    (
        10,
        -13.93697996,
        (-13.93655248, -2.39914240),
        (-2.38215824, 7.71736985),
        (26.76642636, 27.70376873),
    ),
    (
        25,
        -40.25677955,
        (-40.25677898, -21.31489969),
        (-21.31486062, -3.52216473),
        (28.06276590, 40.05019099),
    ),
]


@pytest.mark.parametrize(("q", "lowest", "first", "second", "fifth"), MATHIEU)
def test_mathieu_characteristic_values(q, lowest, first, second, fifth):
    """With theta = 2x: lam2 = a/4, mu = -q/2, f = cos theta; the sign of mu does not matter."""
    for sign in (-1.0, 1.0):
        found = hill_boundaries(COSINE, sign * q / 2, (0, 1, 2, 5))
        assert 4 * found.upper[0] == pytest.approx(lowest, abs=6e-9)
        assert found.lower[0] == -np.inf
        both = 4 * np.stack([found.lower, found.upper], axis=1)[1:]
        np.testing.assert_allclose(both, [first, second, fifth], rtol=0, atol=6e-9)


def hill_matrix_in_mpmath(f, mu, odd, harmonic):
    """Eigenvalues of Hill's matrix in exp(i k theta), made real by hand, at mpmath's precision."""
    from mpmath import mp, mpf

    k = [mpf(j) + mpf(odd) / 2 for j in range(-harmonic, harmonic + 1 - odd)]
    n = len(k)
    matrix = mp.zeros(2 * n)
    for i in range(n):
        for j in range(n):
            m = abs(i - j)
            real = imaginary = mpf(0)
            if 0 < m <= f.harmonics:
                real = -mpf(mu) * mpf(f.a[m]) / 2
                imaginary = mpf(mu) * mpf(f.b[m]) / 2 * (1 if i > j else -1)
            if i == j:
                real = k[i] ** 2 - mpf(mu) * mpf(f.a[0])
            matrix[i, j] = matrix[n + i, n + j] = real
            matrix[n + i, j], matrix[i, n + j] = imaginary, -imaginary
    return sorted(mp.eigsy(matrix, eigvals_only=True))[::2]


@pytest.mark.parametrize("mu", [0.8, -0.8])
def test_boundaries_against_mpmath_eigenvalues(mu):
    from mpmath import mp

    f = FUNCTIONS["f3 (5,1,5,2)"].truncated(1e-7)
    found = hill_boundaries(f, mu, (0, 1, 2, 3, 4))
    with mp.workdps(25):
        even, odd = (hill_matrix_in_mpmath(f, mu, parity, 14) for parity in (0, 1))
        truth = [even[0], odd[0], odd[1], even[1], even[2], odd[2], odd[3], even[3], even[4]]
        ours = [found.upper[0]]
        for n in (1, 2, 3, 4):
            ours += [found.lower[n], found.upper[n]]
        gaps = np.array([float(abs(x - float(y))) for x, y in zip(truth, ours, strict=True)])
    assert gaps.max() < 1e-12
    # The test's own matrix is cut where the coupling squared is below 1e-14.
    assert gaps.max() <= found.error.max() + 1e-14


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("mu", [1.0, -1.6, 0.01])
def test_boundaries_against_roots_of_heyokas_half_trace(name, mu):
    from hill_functions import batched_heyoka

    pytest.importorskip("heyoka")
    f = FUNCTIONS[name]
    regions = (0, 1, 2, 3, 4, 5, 6)
    found = hill_boundaries(f, mu, regions)
    ends = np.stack([found.lower, found.upper])[:, :]
    level = np.where(np.array(regions) % 2 == 1, -1.0, 1.0)
    h = 1e-5
    ends = np.where(np.isinf(ends), found.upper[0], ends)
    points = (ends + np.array([-h, 0.0, h])[:, None, None]).ravel()
    left, middle, right = batched_heyoka(f)(points, np.full(points.size, mu)).reshape(3, 2, -1)
    slope = (right - left) / (2 * h)
    simple = np.abs(slope) > 0.2
    assert simple.sum() >= 2
    gap = np.abs((middle - level) / slope)
    assert gap[simple].max() < 1e-11


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_half_trace_stands_at_its_level_on_every_boundary(name):
    f = FUNCTIONS[name]
    mu = np.linspace(-2, 2, 21)
    found = hill_boundaries(f, mu, (1, 2, 3, 4, 5, 6))
    for ends in (found.lower, found.upper):
        for i, n in enumerate(found.regions):
            half = discriminant(f, ends[i], mu)
            # |d half trace / d lam2| is below 2 pi cosh(...) there; 100 covers all cases here.
            off = np.abs(half.value - (-1.0) ** n)
            assert np.all(off <= half.error + 100 * found.error[i])


def test_between_the_ends_it_is_unstable_and_outside_stable():
    f = FUNCTIONS["24 harmonics"]
    found = hill_boundaries(f, 0.7, (1, 2, 3, 4))
    ends = np.stack([found.lower, found.upper], axis=1)
    middles = discriminant(f, ends.mean(axis=1), 0.7)
    between = discriminant(f, 0.5 * (found.upper[:-1] + found.lower[1:]), 0.7)
    assert not middles.stable.any()
    assert between.stable.all()
    assert not discriminant(f, hill_boundaries(f, 0.7, (0,)).upper[0] - 0.1, 0.7).stable


@pytest.mark.parametrize("name", FUNCTIONS)
def test_mu_zero_gives_the_squares(name):
    regions = range(0, 9)
    found = hill_boundaries(FUNCTIONS[name], 0.0, regions)
    exact = np.arange(9) ** 2 / 4
    np.testing.assert_allclose(found.upper, exact, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.lower[1:], exact[1:], rtol=0, atol=1e-13)
    assert np.all(np.abs(found.upper - exact) <= found.error)


def test_closed_tongues_are_closed():
    """f = cos 2 theta has only tongues of even n: odd ones coexist."""
    f = PeriodicFunction([0.0, 0.0, 1.0])
    found = hill_boundaries(f, np.array([0.5, 1.3, -2.0]), (1, 2, 3, 4, 5))
    assert np.all(np.abs(found.width[[0, 2, 4]]) <= 2 * found.error[[0, 2, 4]])
    assert np.all(found.width[[1, 3]] > 1e-3)
    # In phi = 2 theta it is Mathieu's equation with lam2/4 and mu/4.
    same = hill_boundaries(COSINE, found.mu / 4, (1, 2))
    np.testing.assert_allclose(found.lower[[1, 3]], 4 * same.lower, atol=1e-12)
    np.testing.assert_allclose(found.upper[[1, 3]], 4 * same.upper, atol=1e-12)


def test_whittaker_coexistence_of_ince_type():
    """A finite-gap potential: 2 k^2 sn^2 has one gap of its period; n >= 2 are closed.

    Lame's equation y'' + (h - 2 k^2 sn^2(x)) y = 0, period 2K of sn^2 mapped to 2 pi.
    """
    from scipy.special import ellipj, ellipk

    m = 0.5
    scale = ellipk(m) / np.pi

    def potential(theta):
        sn = ellipj(theta * scale, m)[0]
        return -2 * m * sn**2 * scale**2

    f = PeriodicFunction.from_callable(potential)
    found = hill_boundaries(f, 1.0, (0, 1, 2, 3, 4))
    # Band edges h = k^2, 1, 1 + k^2; all other gaps are closed.
    edges = np.array([found.upper[0], found.lower[1], found.upper[1]]) / scale**2
    np.testing.assert_allclose(edges, [m, 1.0, 1.0 + m], rtol=0, atol=1e-12)
    assert np.all(np.abs(found.width[2:]) <= 2 * found.error[2:] + 1e-13)


def test_the_mean_only_shifts():
    f, mu = FUNCTIONS["24 harmonics"], np.array([0.3, -1.1])
    plain, shifted = hill_boundaries(f, mu, (1, 2)), hill_boundaries(f + 5.0, mu, (1, 2))
    np.testing.assert_allclose(shifted.lower, plain.lower - 5 * mu, rtol=0, atol=1e-13)
    np.testing.assert_allclose(shifted.upper, plain.upper - 5 * mu, rtol=0, atol=1e-13)


def test_shifting_the_angle_changes_nothing():
    """theta + 1: new coefficients, same equation."""
    f = FUNCTIONS["f3 (5,1,5,2)"]
    m = np.arange(f.harmonics + 1)
    turned = (f.a + 1j * -f.b) * np.exp(1j * m)
    g = PeriodicFunction(turned.real, -turned.imag)
    one, two = (hill_boundaries(h, 1.2, (1, 2, 3, 4)) for h in (f, g))
    assert np.all(np.abs(one.lower - two.lower) <= one.error + two.error)
    assert np.all(np.abs(one.upper - two.upper) <= one.error + two.error)


@settings(max_examples=40, deadline=None)
@given(
    shape=st.sampled_from([(), (1,), (5,), (2, 3), (0,), (2, 1, 2)]),
    regions=st.lists(st.integers(0, 8), max_size=4),
    seed=st.integers(0, 99),
)
def test_shapes_and_independence_of_the_batch(shape, regions, seed):
    f = PeriodicFunction([0.1, 1.0, 0.3], [0, 0.2, -0.5])
    mu = np.random.default_rng(seed).uniform(-2, 2, shape)
    found = hill_boundaries(f, mu, regions)
    assert found.lower.shape == found.upper.shape == found.error.shape == (len(regions), *shape)
    assert found.regions == tuple(regions)
    for index in list(np.ndindex(mu.shape))[:2]:
        for i, n in enumerate(regions):
            alone = hill_boundaries(f, mu[index], (n,))
            slack = alone.error[0] + found.error[(i, *index)]
            assert abs(alone.upper[0] - found.upper[(i, *index)]) <= slack
            assert np.all(found.lower[i] <= found.upper[i] + found.error[i])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((np.nan,), "mu"),
        ((1.0, (1.5,)), "regions"),
        ((1.0, (-1,)), "regions"),
        ((1.0, 3), "regions"),
        ((1.0, (1,), -0.1), "damping"),
        ((1.0, (1,), np.inf), "damping"),
        ((np.ones(2), (1,), np.ones(3)), "broadcast"),
        ((1e9, (1,)), "2048 harmonics"),
        ((1e301, (1,)), "2048 harmonics"),
        ((1.0, (5000,)), "at most 2048"),
    ],
)
def test_bad_input(arguments, message):
    with pytest.raises(BadInput, match=message):
        hill_boundaries(COSINE, *arguments)


def test_the_figure_is_not_idle():
    found = hill_boundaries(FUNCTIONS["f3 (5,1,5,2)"], np.linspace(-1, 1, 11), (1, 2, 3, 4, 5, 6))
    assert found.error.max() < 1e-12


def test_plot_and_export():
    import matplotlib.pyplot as plt

    found = hill_boundaries(COSINE, np.linspace(0, 1, 5), (1, 2))
    assert len(found.plot().lines) == 4
    plt.close("all")
    assert found.to_dict()["regions"] == [1, 2]
    with pytest.raises(BadInput, match="slice"):
        hill_boundaries(COSINE, 1.0).plot()


CHECK = "half trace at the ends over what the figures explain"


@pytest.mark.parametrize(
    "given",
    [
        {"mu": np.linspace(0.0, 50.0, 6), "regions": (0, 1, 2, 5, 8)},
        {"mu": np.linspace(0.0, 1.0, 300), "regions": (1, 2, 3)},
        {"mu": np.linspace(0.0, 3.0, 50), "regions": (1, 2), "damping": 0.1},
        {"mu": 1e4, "regions": (1, 2)},
    ],
)
def test_the_half_trace_confirms_the_ends(given):
    found = hill_boundaries(PeriodicFunction([0.3, 1.0, 0.5], [0.0, 0.2]), **given)
    assert list(found.checks) == [CHECK] and found.passed
    assert {"elastolink", "numpy"} <= set(found.provenance)


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_wrong_end_fails_the_check(damping):
    f, mu, k = PeriodicFunction([0.0, 1.0, 0.5]), np.array([0.7]), np.array([damping])
    right = hill_boundaries(f, mu, (1, 2), damping=damping)
    arguments = (f, mu, k, right.regions)
    shut = np.zeros(right.lower.shape, dtype=bool)
    good = boundary_checks(*arguments, right.lower, right.upper, right.error, shut)
    wrong = boundary_checks(*arguments, right.lower, right.upper + 1e-9, right.error, shut)
    assert good[CHECK].passed and not wrong[CHECK].passed


def test_checks_are_made_late_once_and_survive_pickling():
    import pickle

    found = pickle.loads(pickle.dumps(hill_boundaries(PeriodicFunction([0.0, 1.0]), 1.0)))
    assert found.checks[CHECK] is found.checks[CHECK]
    assert found.to_dict()["checks"][CHECK]["passed"]
    nothing = hill_boundaries(PeriodicFunction([0.0, 1.0]), 0.0, (1,), damping=0.1)
    assert len(nothing.checks) == 0


def test_csv_has_long_form(tmp_path):
    found = hill_boundaries(PeriodicFunction([0.0, 1.0]), [0.1, 0.2, 0.3], (1, 4))
    lines = found.save(tmp_path / "b.csv").read_text().splitlines()
    header = lines[0].split(",")
    rows = [dict(zip(header, map(float, line.split(",")), strict=True)) for line in lines[1:]]
    assert [row["regions"] for row in rows] == [1, 1, 1, 4, 4, 4]
    assert [row["mu"] for row in rows] == [0.1, 0.2, 0.3] * 2
    assert [row["lower"] for row in rows] == found.lower.ravel().tolist()


@pytest.mark.parametrize("word", ["no", 1, None])
def test_certified_is_true_or_false(word):
    with pytest.raises(BadInput, match="certified"):
        hill_boundaries(PeriodicFunction([0.0, 1.0]), 0.1, (1,), certified=word)
