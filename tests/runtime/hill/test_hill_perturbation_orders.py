"""Orders 1 to 8, both forms, several parameters, damping, flags, error figures."""

from fractions import Fraction

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.exact.matrix import hill_boundaries
from elastolink.runtime.hill.half_trace import discriminant
from elastolink.runtime.hill.perturbation.boundaries import (
    PerturbationBoundaries,
    perturbation_boundaries,
)
from elastolink.runtime.hill.perturbation.thresholds import critical_damping

COSINE = PeriodicFunction([0.0, 1.0])
GENERAL = PeriodicFunction([0.3, 1.0, -0.4, 0.25], [0.0, -0.5, 0.3, 0.1])
SECOND = PeriodicFunction([-0.1, 0.2, 0.5], [0.0, 0.7, -0.2])

# Powers of q in a_m(q) and b_m(q) less m^2, exact: DLMF 28.6.1-28.6.7 (Abramowitz & Stegun
# 20.2.25), from the power given by the region's order up to q^8 or as far as printed.
MATHIEU = {
    (0, "a"): {2: "-1/2", 4: "7/128", 6: "-29/2304", 8: "68687/18874368"},
    (1, "a"): {
        **{1: "1", 2: "-1/8", 3: "-1/64", 4: "-1/1536", 5: "11/36864"},
        **{6: "49/589824", 7: "55/9437184", 8: "-83/35389440"},
    },
    (1, "b"): {
        **{1: "-1", 2: "-1/8", 3: "1/64", 4: "-1/1536", 5: "-11/36864"},
        **{6: "49/589824", 7: "-55/9437184", 8: "-83/35389440"},
    },
    (2, "a"): {2: "5/12", 4: "-763/13824", 6: "1002401/79626240", 8: "-1669068401/458647142400"},
    (2, "b"): {2: "-1/12", 4: "5/13824", 6: "-289/79626240", 8: "21391/458647142400"},
    (3, "a"): {
        **{2: "1/16", 3: "1/64", 4: "13/20480", 5: "-5/16384"},
        **{6: "-1961/23592960", 7: "-609/104857600"},
    },
    (3, "b"): {
        **{2: "1/16", 3: "-1/64", 4: "13/20480", 5: "5/16384"},
        **{6: "-1961/23592960", 7: "609/104857600"},
    },
    (4, "a"): {2: "1/30", 4: "433/864000", 6: "-5701/2721600000"},
    (4, "b"): {2: "1/30", 4: "-317/864000", 6: "10049/2721600000"},
}
# Radii of convergence in q, DLMF table 28.6.1: the series of a_0 and a_2; of b_2; of a_1 and b_1.
RADII = {0: 1.4687686138, 1: 3.7699574940, 2: 1.4687686138}


@pytest.mark.parametrize(
    ("m", "kind", "order"),
    [(*key, order) for key, printed in MATHIEU.items() for order in range(1, max(printed) + 1)],
)
def test_the_series_of_mathieus_equation(m, kind, order):
    """Truncated polynomials on both sides: they agree to round-off wherever q lies."""
    printed = {k: Fraction(v) for k, v in MATHIEU[m, kind].items()}
    q = np.array([0.01, 0.4, 1.3])
    wanted = np.array(
        [float(sum(c * Fraction(x) ** k for k, c in printed.items() if k <= order)) for x in q]
    )
    # A change of sign of mu changes a and b of odd number, and lower and upper with them.
    found = perturbation_boundaries(COSINE, -0.5 * q, (m,), order, form="series", outside="value")
    values = found.upper[0] if kind == "a" else found.lower[0]
    np.testing.assert_allclose(4 * values - m * m, wanted, rtol=0, atol=4e-15 * (1 + m * m))


@pytest.mark.parametrize("n", RADII)
def test_nothing_is_given_beyond_the_radius_of_convergence(n):
    q = RADII[n] * np.array([0.3, 0.45, 1.3, 2.0, 10.0])
    for order in range(2, 9):
        found = perturbation_boundaries(COSINE, 0.5 * q, (n,), order)
        np.testing.assert_array_equal(found.outside[0], [False, False, True, True, True])


@pytest.mark.parametrize("form", ["uniform", "series"])
@pytest.mark.parametrize("n", [0, 1, 2, 3])
@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_each_order_gains_a_power(form, n, damped, order):
    mu = np.array([0.04, 0.02])
    k = 0.03 * mu if damped else 0.0
    exact = hill_boundaries(GENERAL, mu, (n,), k)
    found = perturbation_boundaries(GENERAL, mu, (n,), order, k, form)
    for end in ("lower", "upper")[n == 0 :]:
        gap = (getattr(found, end) - getattr(exact, end))[0]
        slope = np.log2(np.abs(gap[0] / gap[1]))
        # The order after next shifts the slope of a single pair of points by a few tenths.
        assert slope > order + 0.7


@pytest.mark.parametrize("form", ["uniform", "series"])
def test_several_parameters_are_one_function(form):
    eps = np.array([[0.05, -0.02, 0.01], [0.02, 0.03, 0.0]])
    k = 0.001
    found = perturbation_boundaries([GENERAL, SECOND], list(eps), (1, 2, 3), 5, k, form)
    assert found.parameters.shape == (2, 3)
    np.testing.assert_array_equal(found.mu, eps[0])
    for j in range(3):
        whole = GENERAL * float(eps[0, j]) + SECOND * float(eps[1, j])
        one = perturbation_boundaries(whole, 1.0, (1, 2, 3), 5, k, form)
        np.testing.assert_allclose(found.lower[:, j], one.lower, rtol=2e-15)
        np.testing.assert_allclose(found.upper[:, j], one.upper, rtol=2e-15)
        # A single point of several parameters takes another way: one function.
        single = perturbation_boundaries([GENERAL, SECOND], list(eps[:, j]), (1, 2, 3), 5, k, form)
        np.testing.assert_allclose(single.upper, one.upper, rtol=2e-15)
        np.testing.assert_allclose(single.error, one.error, rtol=1e-3)


def test_parameters_broadcast():
    found = perturbation_boundaries(
        [COSINE, SECOND], [np.zeros((2, 1)), np.linspace(0, 0.1, 3)], (1, 2), 3, np.zeros(3)
    )
    assert isinstance(found, PerturbationBoundaries)
    assert found.lower.shape == found.outside.shape == found.closed.shape == (2, 2, 3)
    assert found.parameters.shape == (2, 2, 3)


def test_the_uniform_form_holds_where_c_n_vanishes():
    """The second harmonic of f and the second order of the first cancel: a kink, not a root."""
    mu = 0.1
    f = PeriodicFunction([0.0, 1.0, -0.5 * mu])
    exact = hill_boundaries(f, mu, (2,))
    for order in (3, 5):
        found = perturbation_boundaries(f, mu, (2,), order)
        assert not found.outside.any()
        gap = max(abs(found.upper - exact.upper)[0], abs(found.lower - exact.lower)[0])
        assert gap <= found.error[0] + exact.error[0]
        assert gap < 10 * mu ** (order + 1)
    # The first component of the root is not the dominant one there.
    assert perturbation_boundaries(f, mu, (2,), 3, form="series").outside.all()


def test_open_closed_flagged_and_undecided_are_told_apart():
    f, n = GENERAL, 1
    tip = 0.5 * f.amplitudes[n] * 0.05
    k = tip * np.array([0.5, 1.5])
    found = perturbation_boundaries(f, [0.05, 0.05], (n,), 6, k)
    np.testing.assert_array_equal(found.closed[0], [False, True])
    np.testing.assert_array_equal(np.isnan(found.upper[0]), [False, True])
    assert not found.outside.any() and not found.undecided.any()
    far = perturbation_boundaries(f, [5.0, 5.0], (n,), 6, k)
    assert far.outside.all() and not far.closed.any() and np.isnan(far.lower).all()
    assert not far.passed and found.passed


@pytest.mark.parametrize(("order", "mu", "most"), [(1, 0.01, 0.5), (3, 0.2, 0.1), (6, 0.2, 0.01)])
def test_the_exact_tip_lies_where_it_is_said_to_be_undecided(order, mu, most):
    """Scan the drag finely across the tip: never certain of what is false."""
    k = 0.5 * GENERAL.amplitudes[2] * mu / 2 * np.linspace(0.5, 1.5, 801)
    exact = np.isnan(hill_boundaries(GENERAL, mu, (2,), k).upper[0])
    found = perturbation_boundaries(GENERAL, mu, (2,), order, k)
    assert exact.any() and not exact.all()
    sure = ~found.undecided[0] & ~found.outside[0]
    np.testing.assert_array_equal(found.closed[0][sure], exact[sure])
    assert sure.mean() > 1.0 - most


def random_case(rng):
    def function():
        harmonics, fall = int(rng.choice([1, 2, 3, 5, 8, 24])), rng.uniform(0.3, 0.95)
        a, b = rng.normal(size=(2, harmonics + 1)) * fall ** np.arange(harmonics + 1)
        b *= rng.random() < 0.7
        b[0] = 0.0
        return PeriodicFunction(a, b)

    functions = [function() for _ in range(rng.integers(1, 4))]
    ray = rng.normal(size=len(functions))
    whole = sum((f * float(x) for f, x in zip(functions, ray, strict=True)), PeriodicFunction())
    n, order = int(rng.integers(0, 7)), int(rng.integers(1, 9))
    mu = 10.0 ** rng.uniform(-3, 0.6, 4) / whole.bound()
    k = np.zeros(4)
    if rng.random() < 0.5 and 0 < n <= whole.harmonics:
        k = 0.5 * whole.amplitudes[n] * mu / n * rng.uniform(0.0, 1.1, 4)
    return functions, ray, whole, n, order, mu, k


@pytest.mark.parametrize("form", ["uniform", "series"])
@pytest.mark.parametrize(
    "cases", [pytest.param(60, id="some"), pytest.param(600, id="all", marks=pytest.mark.slow)]
)
def test_the_figures_cover_the_truth(form, cases):
    rng = np.random.default_rng(17)
    ratios, covered, flagged, wrong = [], [], [], 0
    for _ in range(cases):
        functions, ray, whole, n, order, mu, k = random_case(rng)
        exact = hill_boundaries(whole, mu, (n,), k)
        found = perturbation_boundaries(functions, list(ray[:, None] * mu), (n,), order, k, form)
        flagged.append(found.outside)
        sure = ~found.outside & ~found.undecided
        wrong += np.count_nonzero(sure & (np.isnan(exact.upper) != found.closed))
        both = np.isfinite(found.upper) & np.isfinite(exact.upper)
        gap = np.abs(found.upper - exact.upper)[both]
        if n:
            gap = np.maximum(gap, np.abs(found.lower - exact.lower)[both])
        slack = exact.error[both]
        covered.append(gap <= found.error[both] + slack)
        clear = gap > 10 * slack
        ratios.append((found.error[both] / np.maximum(gap, 1e-300))[clear])
    covered, ratios = np.concatenate(covered), np.concatenate(ratios)
    assert covered.size > 2 * cases
    assert covered.mean() >= 0.99
    assert wrong == 0
    assert np.median(ratios) < 20
    # A flag is no way out: at these parameters most of the entries are numbers.
    assert np.mean(flagged) < 0.45


@pytest.mark.parametrize(
    "cases", [pytest.param(60, id="some"), pytest.param(600, id="all", marks=pytest.mark.slow)]
)
def test_nothing_certain_is_false_about_the_tip(cases):
    """Damping within 1e-7 to a third of the critical one, which the half trace gives."""
    rng = np.random.default_rng(23)
    seen = 0
    for _ in range(cases):
        _, _, whole, n, order, mu, _ = random_case(rng)
        truth = critical_damping(whole, mu, (max(n, 1),))
        k = truth.critical[0] * (1 + rng.normal(size=4) * 10.0 ** rng.uniform(-7, -0.5, 4))
        k = np.maximum(k, 0.0)
        apart = np.abs(k - truth.critical[0]) > 4 * truth.error[0]
        for form in ("uniform", "series"):
            found = perturbation_boundaries(whole, mu, (max(n, 1),), order, k, form)
            sure = apart & ~found.outside[0] & ~found.undecided[0]
            np.testing.assert_array_equal(found.closed[0][sure], (k > truth.critical[0])[sure])
            seen += np.count_nonzero(sure)
    assert seen > 2 * cases


@pytest.mark.parametrize("form", ["uniform", "series"])
@pytest.mark.parametrize("order", [1, 4, 8])
def test_nothing_happens_at_zero(form, order):
    found = perturbation_boundaries(GENERAL, [0.0, -0.0], (0, 1, 4), order, form=form)
    np.testing.assert_array_equal(found.upper, np.array([0.0, 0.25, 4.0])[:, None] * np.ones(2))
    np.testing.assert_array_equal(found.lower[1:], found.upper[1:])
    assert np.all(found.lower[0] == -np.inf)
    assert not found.outside.any() and not found.closed.any()
    # With drag alone there is no region to be open, but for the lowest.
    closed = perturbation_boundaries(GENERAL, 0.0, (0, 1, 4), order, 0.1, form)
    np.testing.assert_array_equal(closed.closed, [False, True, True])


@pytest.mark.parametrize("form", ["uniform", "series"])
def test_a_constant_function_only_moves_the_levels(form):
    found = perturbation_boundaries(PeriodicFunction([2.0]), [0.3, -1e5], (0, 1, 2), 8, form=form)
    for i, n in enumerate((0, 1, 2)):
        for end in (found.lower, found.upper)[n == 0 :]:
            np.testing.assert_allclose(end[i], n * n / 4 - 2 * found.mu, rtol=1e-15)
    assert not found.outside.any()


@pytest.mark.parametrize("mu", [1e3, -1e20, 1e160, 1e300])
@pytest.mark.parametrize("form", ["uniform", "series"])
@pytest.mark.parametrize("k", [0.0, 1e-3, 1e200])
def test_huge_parameters_are_flagged(mu, form, k):
    found = perturbation_boundaries(GENERAL, mu, (0, 1, 3), 8, k, form)
    assert found.outside.all()
    assert np.isnan(found.upper).all() and np.isnan(found.error).all()


@pytest.mark.parametrize("k", [0.0, 0.01])
@pytest.mark.parametrize("order", [4, 8])
def test_a_single_harmonic_couples_its_multiples(k, order):
    """cos 3 theta: region 3 at first, region 6 at second order, none of the others ever."""
    f = PeriodicFunction([0.0, 0.0, 0.0, 1.0])
    found = perturbation_boundaries(f, 0.2, (1, 2, 3, 4, 5, 6), order, k)
    width = np.nan_to_num(found.width)
    assert width[2] > 0.1 and (width[5] > 1e-3 or k > 0)
    # What is left is the root of round-off of the level.
    assert np.all(width[[0, 1, 3, 4]] < 1e-7)
    same = perturbation_boundaries(COSINE, 0.2 / 9, (1,), order, k / 3)
    np.testing.assert_allclose(found.upper[2], 9 * same.upper[0], rtol=1e-14)


def test_damping_beyond_critical_closes_every_region():
    found = perturbation_boundaries(GENERAL, np.linspace(-0.2, 0.2, 9), (1, 2, 3), 6, 0.3)
    assert found.closed[~found.outside].all()
    assert found.closed.any()


def test_negative_levels():
    """Region 0 and a mean that pushes all levels below zero."""
    f = GENERAL + 5.0
    found = perturbation_boundaries(f, 0.4, (0, 1, 2), 8)
    assert np.all(found.upper < 0)
    half = discriminant(f, found.upper, 0.4)
    slope = np.abs(discriminant(f, found.upper + 1e-5, 0.4).value - half.value) / 1e-5
    gap = np.abs(half.value - np.array([1.0, -1.0, 1.0]))
    assert np.all(gap <= slope * found.error * 1.1 + half.error)


@pytest.mark.parametrize("k", [0.0, 1e-4])
def test_a_thousand_harmonics(k):
    """The half trace at the ends is at its level, as near as their figure explains."""
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 1001)) * 0.99 ** np.arange(1001)
    b[0] = 0.0
    f = PeriodicFunction(a, b)
    found = perturbation_boundaries(f, [2e-3, 5e-3], (1, 2), 3, k)
    open_ = np.isfinite(found.upper)
    assert open_.any()
    step = 1e-6
    for ends in (found.lower, found.upper):
        half = discriminant(f, ends[open_], (found.mu * np.ones((2, 1)))[open_], k)
        beside = discriminant(f, ends[open_] + step, (found.mu * np.ones((2, 1)))[open_], k)
        slope = np.abs(beside.value - half.value) / step
        gap = np.abs(np.abs(half.value) - half.level)
        assert np.all(gap <= 1.2 * slope * found.error[open_] + half.error)


def test_what_would_not_fit_is_refused():
    f = PeriodicFunction(np.ones(1001))
    with pytest.raises(BadInput, match="coefficients"):
        perturbation_boundaries([f, f, f], [np.zeros(2)] * 3, (1,), 8, 0.1)


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        ({"f": [COSINE, SECOND], "mu": 0.1}, "mu"),
        ({"f": [COSINE, SECOND], "mu": [0.1]}, "mu"),
        ({"f": [], "mu": []}, "f"),
        ({"f": [COSINE, 3.0], "mu": [0.1, 0.1]}, "f"),
        ({"f": COSINE, "mu": 0.1, "form": "other"}, "form"),
        ({"f": COSINE, "mu": 0.1, "outside": "zero"}, "outside"),
        ({"f": [COSINE, SECOND], "mu": [0.1, np.inf]}, "mu"),
        ({"f": [COSINE, SECOND], "mu": [[0.1, 0.2], [0.1, 0.2, 0.3]]}, "mu"),
    ],
)
def test_bad_input_is_named(arguments, where):
    with pytest.raises(BadInput, match=where):
        perturbation_boundaries(**arguments)


def test_the_result_leaves_with_its_masks(tmp_path):
    found = perturbation_boundaries(GENERAL, np.linspace(0, 2, 5), (1, 2), 4, 0.01)
    with np.load(found.save(tmp_path / "found.npz")) as kept:
        np.testing.assert_array_equal(kept["outside"], found.outside)
        np.testing.assert_array_equal(kept["closed"], found.closed)
    assert (tmp_path / "found.csv") == found.save(tmp_path / "found.csv")
    assert found.to_dict()["order"] == 4
    assert found.plot().lines
