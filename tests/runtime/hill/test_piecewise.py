"""Piecewise constant coefficients: exact matrices, honest figures, second order, edges."""

import mpmath
import numpy as np
import pytest
from elastolink.generated import hill_meissner
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import (
    piecewise_approximation,
    piecewise_monodromy,
)
from elastolink.runtime.hill.cases.piecewise import interval_values

TURN = 2.0 * np.pi
F = PeriodicFunction([0.1, 1.0, 0.4], [0.0, 0.3, -0.2])


def true_matrix(levels, lengths, damping=0.0):
    """Return the monodromy matrix by matrix exponentials in many digits."""
    whole = mpmath.eye(2)
    for level, length in zip(levels, lengths, strict=True):
        generator = mpmath.matrix([[0, 1], [-mpmath.mpf(float(level)), -2 * mpmath.mpf(damping)]])
        whole = mpmath.expm(generator * mpmath.mpf(float(length))) * whole
    return whole


def cases():
    random = np.random.default_rng(4)
    for i in range(60):
        count = int(random.integers(1, 7))
        levels = random.uniform(-3.0, 10.0, count) * 10.0 ** random.uniform(-4, 1.5)
        yield levels, random.dirichlet(np.ones(count)) * TURN, (0.0, 0.01, 0.3)[i % 3]


def test_values_and_their_figures_against_fifty_digits():
    shares = {name: [] for name in ("half trace", "margin", "matrix", "multipliers")}
    for levels, lengths, k in cases():
        found = piecewise_monodromy(levels, lengths, k)
        assert found.passed
        with mpmath.workdps(60):
            m = true_matrix(levels, lengths, k)
            half = (m[0, 0] + m[1, 1]) / 2
            turn = mpmath.fsum(mpmath.mpf(float(t)) for t in lengths)
            decay = mpmath.exp(-mpmath.mpf(k) * turn)
            margin = decay * mpmath.cosh(mpmath.mpf(k) * turn) - abs(half)
            root = mpmath.sqrt(mpmath.mpc(half * half - decay**2))
            pair = sorted((half + root, half - root), key=lambda z: (-abs(z), -z.imag))
            if abs(pair[0].imag) > 0:
                pair.sort(key=lambda z: -z.imag)
            for name, exact, value, error in (
                ("half trace", half, found.half_trace, found.error),
                ("margin", margin, found.margin, found.margin_error),
                *(
                    ("matrix", m[i, j], found.matrix[i, j], found.matrix_error[i, j])
                    for i in (0, 1)
                    for j in (0, 1)
                ),
                *(
                    ("multipliers", pair[i], found.multipliers[i], found.multiplier_error[i])
                    for i in (0, 1)
                ),
            ):
                off = abs(exact - mpmath.mpmathify(complex(value)))
                shares[name].append(float(off) / float(error))
    for name, found in shares.items():
        assert max(found) <= 1.0, name
        assert np.median(found) >= 1e-3, name


def test_two_to_four_intervals_are_the_closed_forms():
    random = np.random.default_rng(5)
    for count, name in ((2, "two"), (3, "three"), (4, "four")):
        q, t = random.uniform(-2.0, 9.0, (30, count)), random.uniform(0.1, 2.0, count)
        pairs = [hill_meissner.interval(q[:, i], t[i]) for i in range(count)]
        letters = [x for i, pair in enumerate(pairs) for x in (*pair, q[:, i])]
        closed = getattr(hill_meissner, f"{name}_intervals")(*letters)[0]
        found = piecewise_monodromy(q, t)
        assert np.all(np.abs(found.half_trace - closed) <= found.error)


def test_batches_are_their_points():
    random = np.random.default_rng(6)
    q, t, k = random.uniform(-1.0, 5.0, (3, 4, 5)), np.full(5, TURN / 5), np.array([0.0, 0.1, 0.4])
    whole = piecewise_monodromy(q, t, k[:, None])
    assert whole.half_trace.shape == (3, 4) and whole.matrix.shape == (3, 4, 2, 2)
    assert whole.multipliers.shape == (3, 4, 2) and whole.stable.shape == (3, 4)
    for i in range(3):
        for j in range(4):
            one = piecewise_monodromy(q[i, j], t, float(k[i]))
            for name in ("half_trace", "matrix", "multipliers", "margin"):
                np.testing.assert_allclose(
                    getattr(one, name), getattr(whole, name)[i, j], rtol=1e-13
                )


def test_the_determinant_is_that_of_the_damping():
    found = piecewise_monodromy([3.0, -0.5, 1.0], [2.0, 1.0, 3.0], 0.2)
    assert np.linalg.det(found.matrix) == pytest.approx(np.exp(-2.0 * 0.2 * 6.0), rel=1e-13)
    assert found.checks["determinant over exp(-2 K T)"].value < 1e-15


def test_a_whole_turn_between_edges_has_a_margin_of_many_digits():
    # Both phases a hair off pi and 3 pi: the margin is of the order 1e-17.
    levels = np.array([9.0 * (1.0 + 1e-9), 1.0 - 2e-9])
    found = piecewise_monodromy(levels, [np.pi, np.pi])
    with mpmath.workdps(60):
        m = true_matrix(levels, [np.pi, np.pi])
        exact = 1 - abs(m[0, 0] + m[1, 1]) / 2
        assert 1e-18 < abs(exact) < 1e-15
        assert abs(found.margin - float(exact)) <= min(float(found.margin_error), 1e-7 * abs(exact))


def test_a_steep_interval_is_cut_and_what_is_beyond_doubles_is_flagged():
    steep = piecewise_monodromy([-1e4, 2.0], [np.pi, np.pi])
    with mpmath.workdps(200):
        exact = true_matrix([-1e4, 2.0], [np.pi, np.pi])
        half = float((exact[0, 0] + exact[1, 1]) / 2)
    assert abs(steep.half_trace - half) <= steep.error and steep.error < 1e-11 * abs(half)
    assert steep.passed and not steep.stable
    beyond = piecewise_monodromy([[-1e7, 2.0], [1.0, 2.0]], [np.pi, np.pi])
    assert (
        not beyond.passed and np.isinf(beyond.half_trace[0]) and np.isfinite(beyond.half_trace[1])
    )
    assert not beyond.stable[0]
    assert beyond.checks["entries beyond the range of doubles"].value == 1.0


@pytest.mark.parametrize("k", [0.5, 5.0, 50.0, 200.0])
@pytest.mark.parametrize("scaled", [False, True])
def test_heavy_damping_neither_overflows_nor_loses_its_figure(k, scaled):
    # Growth without damping up to exp(1256), times a decay below all doubles.
    levels = np.array([4.0 * k * k, 9.0 * k * k] if scaled else [4.0, -0.5])
    found = piecewise_monodromy(levels, [np.pi, np.pi], k)
    assert found.passed
    with mpmath.workdps(60 + int(6 * k)):
        whole = mpmath.eye(2)
        for level in levels:
            inner = mpmath.mpf(level) - mpmath.mpf(k) ** 2
            v, t = mpmath.sqrt(mpmath.mpc(inner)), mpmath.mpf(np.pi)
            c, s = mpmath.cos(v * t).real, (mpmath.sin(v * t) / v).real
            whole = mpmath.matrix([[c, s], [-inner * s, c]]) * whole
        decay = mpmath.exp(-2 * mpmath.mpf(k) * mpmath.mpf(np.pi))
        half = decay * (whole[0, 0] + whole[1, 1]) / 2
        margin = (1 + decay**2) / 2 - abs(half)
        for exact, value, error in (
            (half, found.half_trace, found.error),
            (margin, found.margin, found.margin_error),
        ):
            # Below all doubles zero is right.
            assert abs(exact - mpmath.mpf(float(value))) <= mpmath.mpf(float(error)) + 1e-307
    # A constant level below zero outweighs any damping: it is unstable only there.
    assert bool(found.stable) == (margin > 0)


def test_one_equation_is_drawn_as_steps():
    found = piecewise_monodromy([1.0, 3.0], [1.0, 2.0])
    ax = found.plot()
    assert ax.get_xlim() == (0.0, 3.0) and "half trace" in ax.get_title()
    with pytest.raises(BadInput, match="one equation"):
        piecewise_monodromy([[1.0, 3.0]], [1.0, 2.0]).plot()


@pytest.mark.parametrize(
    ("levels", "lengths", "damping", "word"),
    [
        ([1.0, np.nan], [1.0, 1.0], 0.0, "levels"),
        ([1.0, 2.0], [1.0], 0.0, "levels"),
        (1.0, [1.0], 0.0, "levels"),
        ([1.0], [0.0], 0.0, "lengths"),
        ([[1.0]], [[1.0]], 0.0, "lengths"),
        ([], [], 0.0, "lengths"),
        ([1.0], [1.0], -0.1, "damping"),
        ([[1.0], [2.0]], [1.0], [0.0, 0.1, 0.2], "shapes"),
        ([-1e16], [1e3], 0.0, "intervals"),
    ],
)
def test_bad_input_is_refused(levels, lengths, damping, word):
    with pytest.raises(BadInput, match=word):
        piecewise_monodromy(levels, lengths, damping)


# ---------------------------------------------------------------- a smooth coefficient


@pytest.mark.parametrize("damping", [0.0, 0.07])
@pytest.mark.parametrize("rule", ["midpoint", "mean"])
def test_steps_converge_with_the_second_power(rule, damping):
    found = [piecewise_approximation(F, 2.3, 0.8, n, rule, damping) for n in (40, 80, 160, 320)]
    gaps = [float(abs(one.half_trace - one.exact.value)) for one in found]
    np.testing.assert_allclose(np.log2(np.divide(gaps[:-1], gaps[1:])), 2.0, atol=0.05)
    for one, gap in zip(found, gaps, strict=True):
        assert gap <= one.error <= 1.001 * gap + 1e-11 and one.passed


def test_values_of_both_rules():
    count = 6
    edges = np.linspace(0.0, TURN, count + 1)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    places = 0.5 * (edges[1:] + edges[:-1])[:, None] + 0.5 * TURN / count * nodes
    mean = F(places) @ weights / 2.0
    np.testing.assert_allclose(interval_values(F, count, "mean"), mean, rtol=0.0, atol=1e-14)
    middles = 0.5 * (edges[1:] + edges[:-1])
    np.testing.assert_allclose(interval_values(F, count), F(middles), rtol=0.0, atol=1e-14)


def test_one_interval_has_the_mean_alone():
    found = piecewise_approximation(F, [1.0, 2.0], 0.7, 1, "mean")
    np.testing.assert_allclose(
        found.half_trace, np.cos(TURN * np.sqrt(np.array([1.0, 2.0]) + 0.07)), atol=1e-14
    )
    assert found.plot().get_xlabel() == r"$\lambda^2$"


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"intervals": 0}, "intervals"),
        ({"intervals": 2.5}, "intervals"),
        ({"intervals": True}, "intervals"),
        ({"rule": "left"}, "rule"),
        ({"f": np.cos}, "PeriodicFunction"),
        ({"lam2": np.inf}, "lam2"),
    ],
)
def test_a_bad_approximation_is_refused(change, word):
    with pytest.raises(BadInput, match=word):
        piecewise_approximation(**{"f": F, "lam2": 1.0, "mu": 0.5, "intervals": 8, **change})


def test_only_a_line_is_drawn():
    with pytest.raises(BadInput, match="a line"):
        piecewise_approximation(F, 1.0, 0.5, 8).plot()
