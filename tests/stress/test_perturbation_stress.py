"""The perturbation boundaries at the ends of what they may be asked for."""

import tracemalloc

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.perturbation.boundaries import perturbation_boundaries
from elastolink.runtime.hill.perturbation.coefficients import boundary_series
from elastolink.runtime.hill.perturbation.effective import effective_operator
from hypothesis import given, settings
from hypothesis import strategies as st

COSINE = PeriodicFunction([0.0, 1.0])
FORMS = ("uniform", "series")
EPS = float(np.finfo(float).eps)


def general(harmonics, fall=0.7, seed=0):
    rng = np.random.default_rng(seed)
    size = fall ** np.arange(harmonics + 1)
    a, b = rng.uniform(-1, 1, (2, harmonics + 1)) * size
    b[0] = 0.0
    return PeriodicFunction(a, b)


MIXED = general(6)


def agrees(f, mu, regions, order, form="uniform", damping=0.0):
    """Compare with Hill's matrix wherever the entry is not flagged; return the result."""
    found = perturbation_boundaries(f, mu, regions, order, damping, form)
    exact = hill_boundaries(f, mu, regions, damping)
    for ours, theirs in ((found.lower, exact.lower), (found.upper, exact.upper)):
        there = np.isfinite(ours) & np.isfinite(theirs)
        gap = np.abs(ours[there] - theirs[there])
        assert np.all(gap <= (found.error + exact.error)[there])
    return found


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("order", [1, 4, 8])
def test_mu_zero(form, order):
    found = perturbation_boundaries(MIXED, 0.0, range(8), order, 0.0, form)
    levels = np.arange(8) ** 2 / 4
    np.testing.assert_array_equal(found.upper, levels)
    np.testing.assert_array_equal(found.lower[1:], levels[1:])
    assert found.lower[0] == -np.inf
    assert np.all(found.error <= 16 * EPS * (levels + 1))
    assert not found.outside.any()
    assert not found.closed.any()


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("mu", [1e-300, 5e-324, -1e-200, 1e-20])
def test_mu_hardly_there(form, mu):
    found = perturbation_boundaries(MIXED, mu, (0, 1, 2, 7), 8, 0.0, form)
    np.testing.assert_allclose(found.upper, [0.0, 0.25, 1.0, 12.25], atol=3 * abs(mu), rtol=EPS)
    assert not found.outside.any()
    assert np.all(np.isfinite(found.error))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("damping", [0.0, 1.0])
@pytest.mark.parametrize("mu", [1e3, 1e150, 1e300, -1e300, 1.7e308])
def test_mu_beyond_all_bounds_is_flagged(form, damping, mu):
    found = perturbation_boundaries(MIXED, [mu, 0.0], (0, 1, 2), 8, damping, form)
    assert found.outside[:, 0].all()
    assert np.isnan(found.upper[:, 0]).all()
    assert np.isnan(found.error[:, 0]).all()
    assert found.checks["entries outside the estimated range"].value == 3
    assert not found.passed
    told = perturbation_boundaries(MIXED, [mu, 0.0], (0, 1), 8, damping, form, outside="value")
    # The number where there is one, with no claim about it.
    gone = np.isnan(told.upper[:, 0])
    assert np.all(np.isposinf(told.error[:, 0]) | gone)
    assert not gone.any() or abs(mu) > 1e30


def test_huge_damping():
    for k in (1e3, 1e150, 1e300):
        found = perturbation_boundaries(MIXED, 0.1, (0, 1, 2), 6, k)
        assert np.all(np.isnan(found.upper) | found.outside)


@pytest.mark.parametrize("order", range(1, 9))
def test_boundaries_below_zero(order):
    """A mean of either sign takes lam2 down or up without touching the rest."""
    for mean in (50.0, -50.0, 1e6):
        shifted = COSINE + mean
        plain = perturbation_boundaries(COSINE, 0.1, (0, 1, 2, 3), order)
        found = perturbation_boundaries(shifted, 0.1, (0, 1, 2, 3), order)
        np.testing.assert_allclose(
            found.upper, plain.upper - 0.1 * mean, rtol=0, atol=2 * EPS * abs(mean)
        )
        assert np.all(np.abs(found.upper - plain.upper + 0.1 * mean) <= found.error + plain.error)
        assert np.sign(found.upper[1]) == -np.sign(mean)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("f", [PeriodicFunction(), PeriodicFunction([0.7])], ids=["zero", "one"])
def test_a_constant_has_no_width(f, form):
    found = perturbation_boundaries(f, [0.3, -40.0], range(5), 8, 0.0, form)
    levels = np.arange(5)[:, None] ** 2 / 4 - f.mean * np.array([0.3, -40.0])
    np.testing.assert_allclose(found.upper, levels, rtol=2 * EPS, atol=2 * EPS)
    np.testing.assert_array_equal(found.lower[1:], found.upper[1:])
    assert not found.outside.any()
    drag = perturbation_boundaries(f, 0.3, (1, 2), 8, 0.01, form)
    assert drag.closed.all()


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("order", [1, 2, 5, 8])
def test_where_c_n_vanishes(form, order):
    a, b = MIXED.a.copy(), MIXED.b.copy()
    a[3] = b[3] = 0.0
    found = agrees(PeriodicFunction(a, b), np.array([1e-6, 0.01, 0.05, -0.05]), (3,), order, form)
    assert not found.outside.any()
    assert np.all(found.width[0] >= 0)
    almost = a.copy()
    almost[3] = 1e-9
    # The series may be flagged about a root of almost nothing, but never be wrong.
    agrees(PeriodicFunction(almost, b), np.array([1e-6, 1e-3, 0.05]), (3,), order, form)


def test_a_thousand_harmonics():
    """Order 1 and 2 of a function with a thousand harmonics, within bounds of memory."""
    rng = np.random.default_rng(4)
    size = 1.0 / (1.0 + np.arange(1001)) ** 2
    a, b = rng.uniform(-1, 1, (2, 1001)) * size
    b[0] = 0.0
    f = PeriodicFunction(a, b)
    tracemalloc.start()
    try:
        for order in (1, 2, 4, 8):
            agrees(f, np.array([1e-3, 0.02]), (1, 2), order)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # Hill's matrix itself takes most: (2 x 1000)^2 doubles, a few times.
    assert peak < 1.5e9


@pytest.mark.parametrize("damping", [0.0, 1e-3])
def test_memory_of_order_eight(damping):
    """The columns hold 24 x 8 harmonics on either side, times the monomials of two parameters."""
    f = general(24)
    tracemalloc.start()
    try:
        agrees(f, np.linspace(-0.1, 0.1, 11), range(1, 7), 8, "uniform", damping)
        perturbation_boundaries(f, np.linspace(-0.1, 0.1, 100_000), (1,), 8, damping)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # Five results of 1e5 doubles and what blocks of 4096 points take.
    assert peak < 1e8


def test_too_many_parameters_are_refused_before_any_work():
    parts = [general(24, seed=i) for i in range(12)]
    with pytest.raises(BadInput, match="coefficients"):
        perturbation_boundaries(parts, [np.zeros(2)] * 12, (1,), 8)


def test_many_parameters_at_one_point_are_one_function():
    parts = [general(24, seed=i) for i in range(12)]
    eps = np.linspace(-0.01, 0.01, 12)
    found = perturbation_boundaries(parts, list(eps), (1, 2, 3), 8)
    whole = sum((p * float(e) for p, e in zip(parts, eps, strict=True)), PeriodicFunction())
    exact = hill_boundaries(whole, 1.0, (1, 2, 3))
    assert np.all(np.abs(found.upper - exact.upper) <= found.error + exact.error)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_at_and_beyond_critical_damping(n):
    f, mu = MIXED, 0.02
    width = perturbation_boundaries(f, mu, (n,), 8).width[0]
    critical = 0.5 * width / n
    for share, closed in ((0.9, False), (1.1, True), (3.0, True)):
        for form in FORMS:
            found = agrees(f, mu, (n,), 8, form, share * critical)
            assert found.outside[0] or found.closed[0] == closed
    # A hair's breadth from the tip: the result says so where it cannot tell.
    for share in 1 + np.array([-1e-3, -1e-6, -1e-9, 0.0, 1e-9, 1e-6, 1e-3]):
        found = agrees(f, mu, (n,), 8, "uniform", share * critical)
        exact = hill_boundaries(f, mu, (n,), share * critical)
        assert found.undecided[0] or found.closed[0] == np.isnan(exact.upper[0])


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("damping", [0.0, 1e-3])
def test_negative_mu_is_the_negative_function(form, damping):
    mu = np.array([1e-5, 0.01, 0.05])
    for order in (1, 3, 8):
        one = perturbation_boundaries(MIXED, -mu, range(5), order, damping, form)
        other = perturbation_boundaries(-MIXED, mu, range(5), order, damping, form)
        for name in ("lower", "upper", "error"):
            np.testing.assert_allclose(
                getattr(one, name), getattr(other, name), rtol=1e-13, atol=1e-15
            )
        np.testing.assert_array_equal(one.outside, other.outside)


@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_region_zero(damping):
    mu = np.array([1e-6, 0.02, -0.05])
    for order in range(1, 9):
        for form in FORMS:
            found = agrees(MIXED, mu, (0,), order, form, damping)
            assert np.all(np.isneginf(found.lower))
            assert np.all(np.isfinite(found.upper))
            assert not found.undecided.any()


@pytest.mark.parametrize("form", FORMS)
def test_very_high_regions(form):
    f = general(8)
    for n in (50, 100, 400):
        found = agrees(f, np.array([0.01, 0.4, -0.9]), (n,), 8, form)
        # Far from resonance with any harmonic the gap is narrower than round-off.
        assert np.all(found.width[0] <= 2 * found.error[0])
        assert not found.outside.any()
    wide = general(60, 0.99)
    assert np.any(agrees(wide, np.array([1e-3, 0.1]), (50,), 8, form).width > 1e-4)


@pytest.mark.parametrize("scale", [1e-300, 1e-200, 1e-20, 1e20])
def test_the_scale_of_f_and_mu_may_be_exchanged(scale):
    mu = np.array([0.01, -0.03])
    plain = perturbation_boundaries(MIXED, mu, (0, 1, 2, 5), 8)
    with np.errstate(under="ignore"):
        found = perturbation_boundaries(MIXED * scale, mu / scale, (0, 1, 2, 5), 8)
    tiny = scale < 1e-30
    assert tiny or not found.outside.any()
    for name in ("lower", "upper"):
        ours, theirs = getattr(found, name), getattr(plain, name)
        there = np.isfinite(ours) & np.isfinite(theirs)
        gaps = np.abs(ours[there] - theirs[there])
        assert np.all(gaps <= (found.error + plain.error)[there])


@pytest.mark.parametrize("scale", [1e150, 1e307])
def test_a_huge_function_is_refused_or_right(scale):
    try:
        found = perturbation_boundaries(MIXED * scale, 0.01 / scale, (0, 1, 2), 8)
    except BadInput as refusal:
        assert "overflow" in str(refusal)
        return
    plain = perturbation_boundaries(MIXED, 0.01, (0, 1, 2), 8)
    there = ~found.outside
    assert np.all(np.abs(found.upper - plain.upper)[there] <= (found.error + plain.error)[there])


@pytest.mark.parametrize(
    "changes",
    [
        {"mu": np.nan},
        {"mu": np.inf},
        {"mu": "much"},
        {"mu": None},
        {"mu": 1j},
        {"mu": [[1.0], [1.0, 2.0]]},
        {"f": None},
        {"f": "cos"},
        {"f": []},
        {"f": [COSINE, "cos"], "mu": [0.1, 0.2]},
        {"f": [COSINE, COSINE]},
        {"f": [COSINE, COSINE], "mu": [0.1]},
        {"f": [COSINE, COSINE], "mu": [0.1, np.nan]},
        {"f": [COSINE, COSINE], "mu": [np.ones(2), np.ones(3)]},
        {"damping": -1e-300},
        {"damping": np.nan},
        {"damping": "a little"},
        {"damping": [0.1, np.inf]},
        {"damping": np.ones(3), "mu": np.ones(2)},
        {"order": 0},
        {"order": 9},
        {"order": 2.0},
        {"order": True},
        {"order": "2"},
        {"order": None},
        {"order": np.nan},
        {"regions": (-1,)},
        {"regions": (0.5,)},
        {"regions": "two"},
        {"regions": 2},
        {"regions": (np.nan,)},
        {"regions": (np.inf,)},
        {"regions": (10**9,)},
        {"regions": None},
        {"form": "exact"},
        {"form": None},
        {"form": 1},
        {"outside": "zero"},
        {"outside": None},
        {"form": ["uniform"]},
        {"outside": []},
    ],
    ids=lambda item: next(iter(item)) + " " + repr(next(iter(item.values())))[:20],
)
def test_bad_input_is_refused_in_one_line(changes):
    with pytest.raises(BadInput) as refusal:
        perturbation_boundaries(**{"f": COSINE, "mu": 0.1, **changes})
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "changes",
    [
        {"order": 0},
        {"order": 11},
        {"order": "2"},
        {"region": -1},
        {"region": 1.5},
        {"region": None},
        {"damping_ratio": -1.0},
        {"damping_ratio": np.nan},
        {"damping_ratio": "some"},
        {"damping_ratio": 10.0},
        {"f": 3},
    ],
    ids=repr,
)
def test_bad_input_of_the_coefficients(changes):
    with pytest.raises(BadInput) as refusal:
        boundary_series(**{"f": COSINE, "region": 1, **changes})
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "arguments",
    [([], 1, 2), ([COSINE], -1, 2), ([COSINE], 1, 11), ([COSINE], 1.0, 2), (["cos"], 1, 2)],
)
def test_bad_input_of_the_operator(arguments):
    with pytest.raises(BadInput):
        effective_operator(*arguments)


@settings(max_examples=60, deadline=None)
@given(
    n=st.integers(0, 12),
    order=st.integers(1, 8),
    form=st.sampled_from(FORMS),
    mu=st.floats(-1e3, 1e3),
    k=st.one_of(st.just(0.0), st.floats(0.0, 2.0)),
    a=st.lists(st.floats(-2, 2), min_size=1, max_size=5),
    b=st.lists(st.floats(-2, 2), min_size=0, max_size=4),
)
def test_anything_finite_is_answered_or_flagged(n, order, form, mu, k, a, b):
    f = PeriodicFunction(a, [0.0, *b])
    found = perturbation_boundaries(f, mu, (n,), order, k, form)
    upper, error = found.upper[0], found.error[0]
    assert np.isnan(upper) == bool(found.outside[0] or found.closed[0])
    assert np.isnan(upper) or (np.isfinite(error) and error >= 0.0)
    if n and not np.isnan(upper):
        assert found.lower[0] <= upper
    again = perturbation_boundaries(f, mu, (n,), order, k, form)
    np.testing.assert_array_equal(again.upper, found.upper)
    np.testing.assert_array_equal(again.error, found.error)


def test_no_points_and_no_regions():
    assert perturbation_boundaries(COSINE, np.zeros((0, 3)), (1, 2)).lower.shape == (2, 0, 3)
    assert perturbation_boundaries(COSINE, 0.1, ()).lower.shape == (0,)
