"""Charts of several modes where the growth is large or overflows, and at a speed that is given."""

import elastolink as el
import mpmath
import numpy as np
import pytest
from edge_truth import flexible_rod
from elastolink.runtime.stability.invariants import weighed_characteristic
from elastolink.runtime.systems.rod import PolynomialBasis
from periodic_systems import system_of, wave


def divergent(modes, first=-1.0):
    """The first mode is pushed away by k, or held where k is negative."""
    held = np.zeros((modes, modes))
    held[1:, 1:] = np.diag(np.arange(2.0, modes + 1))
    own, pair = np.zeros_like(held), np.zeros_like(held)
    own[0, 0] = first
    pair[0, 1] = pair[1, 0] = 0.2
    return system_of({"k": 1.0}, M=np.eye(modes), K=[held, ("k", own), wave(pair)])


@pytest.mark.parametrize("modes", [2, pytest.param(5, marks=pytest.mark.slow)])
def test_growth_that_overflows_is_unstable(modes):
    """At 0.005 rad/s the state grows by exp(2 pi sqrt(k) / speed), 1e385 and more."""
    speeds = np.array([0.005, 0.5, 1.0])
    system = divergent(modes)
    chart = el.stability_chart(system, ("speed", speeds), ("k", [0.5, 1.0]))
    assert np.all(chart.largest[:, 0] == np.inf)
    assert not np.any(chart.stable)
    assert not np.any(chart.undecided)
    assert np.all(chart.kind == 1)
    for i, k in enumerate(chart.y):
        direct = el.floquet_multipliers(system, speeds[1:], k=k)
        wanted = np.max(np.abs(direct.multipliers), axis=-1)
        assert np.allclose(chart.largest[i, 1:], wanted, rtol=1e-8)


def test_stable_points_beside_overflow_are_found():
    """One chart from a spring that holds to one that pushes, over speeds down to 0.004 rad/s."""
    speeds = np.concatenate([[0.004], np.linspace(0.7, 3.0, 30)])
    system = divergent(2, first=1.0)
    stiff = np.linspace(-1.0, 1.0, 6)
    chart = el.stability_chart(system, ("speed", speeds), ("k", stiff))
    assert np.all(chart.largest[:2, 0] == np.inf)
    direct = el.floquet_multipliers(system, speeds[None, 1:], k=stiff[:, None])
    modulus = np.max(np.abs(direct.multipliers), axis=-1)
    clear = np.abs(modulus - 1.0) > 1e-6
    assert np.array_equal(chart.stable[:, 1:][clear], modulus[clear] < 1.0)
    assert np.mean(chart.undecided[:, 1:]) < 0.02
    assert 0.1 < np.mean(chart.stable[:, 1:]) < 0.9


def test_waves_alone_move_a_system_whose_mean_stiffness_vanishes():
    """At k = 0 the mean rate is zero, the stiffness 0.2 cos(theta) / speed^2 is not."""
    pair = np.array([[0.3, 0.2], [0.2, 0.1]])
    system = system_of({"k": 1.0}, M=np.eye(2), K=[("k", np.diag([1.0, 2.0])), wave(pair)])
    speeds, stiff = np.array([0.02, 0.3, 1.0]), np.linspace(-1.0, 1.0, 3)
    chart = el.stability_chart(system, ("speed", speeds), ("k", stiff))
    direct = el.floquet_multipliers(system, speeds[1:], k=0.0)
    wanted = np.max(np.abs(direct.multipliers), axis=-1)
    assert np.allclose(chart.largest[1, 1:], wanted, rtol=1e-7)
    assert not chart.stable[1, 0]


def _characteristic_in_many_digits(matrix):
    """Faddeev and LeVerrier in 80 digits."""
    with mpmath.workdps(80):
        x = mpmath.matrix(matrix.tolist())
        m = matrix.shape[0]
        power, found = mpmath.eye(m), []
        for k in range(1, m + 1):
            product = x * power
            found.append(-sum(product[i, i] for i in range(m)) / k)
            power = product + found[-1] * mpmath.eye(m)
        return np.array([float(c) for c in found])


def test_coefficients_keep_their_digits_beside_a_large_multiplier():
    """Random matrices with multipliers from 0.03 to 30: within round-off of the matrices."""
    rng = np.random.default_rng(4)
    size = 8
    basis = rng.normal(size=(10, size, size)) + 3.0 * np.eye(size)
    spread = np.geomspace(0.03, 30.0, size)
    matrices = basis @ (spread[:, None] * np.linalg.inv(basis))
    found, weight = weighed_characteristic(matrices, size)
    wanted = np.array([_characteristic_in_many_digits(x) for x in matrices])
    assert np.all(np.abs(found - wanted) <= 32 * size * np.finfo(float).eps * weight)


def test_error_estimates_of_circulatory_systems_hold():
    """Undamped: the last coefficient is the determinant, 1; the others from multipliers."""
    rng = np.random.default_rng(4)
    covered = []
    for _ in range(3):
        turn = rng.normal(size=(4, 4))
        waves = rng.normal(size=(4, 4)) * 0.6
        springs = ("k", np.diag(rng.uniform(1.0, 20.0, 4)))
        push = [springs, 0.7 * (turn - turn.T), wave(waves + waves.T)]
        system = system_of({"k": 1.0}, M=np.eye(4), K=push)
        axes = ("speed", np.linspace(0.7, 3.0, 20)), ("k", np.linspace(0.5, 1.5, 5))
        chart = el.stability_chart(system, *axes)
        direct = el.floquet_multipliers(system, chart.x[None, :], k=chart.y[:, None])
        wanted = np.array([[np.poly(v).real[1:] for v in row] for row in direct.multipliers])
        size = np.maximum(1.0, np.max(np.abs(wanted), axis=-1))
        assert np.all(np.abs(chart.invariants[..., -1] - 1.0) <= chart.error * size)
        moved = np.sum(direct.error / np.abs(direct.multipliers), axis=-1)
        gap = np.max(np.abs(chart.invariants - wanted), axis=-1) / size
        covered += (gap <= chart.error + moved).ravel().tolist()
    assert np.mean(covered) >= 0.99


def test_a_given_speed_is_a_slice_of_the_chart_over_speeds():
    """Damping, several powers of the speed, and geometry as an axis."""
    system = flexible_rod(PolynomialBasis(2)).with_parameters(damping=30.0)
    ratios, masses = np.linspace(0.05, 0.2, 4), np.linspace(6.5, 8.0, 3)
    chart = el.stability_chart(
        system, ("crank_ratio", ratios), ("mass_per_length", masses), speed=1500.0
    )
    assert chart.speed == 1500.0
    assert chart.passed
    for i, mass in enumerate(masses):
        other = el.stability_chart(
            system.with_parameters(mass_per_length=mass),
            ("crank_ratio", ratios),
            ("speed", [1400.0, 1500.0]),
        )
        assert np.allclose(chart.invariants[i], other.invariants[1], atol=1e-9)
        assert np.array_equal(chart.stable[i], other.stable[1])


def test_one_mode_at_a_given_speed_agrees_with_multipliers():
    system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    inertias, stiff = np.linspace(6e-4, 2.2e-3, 5), system.parameters["bending_stiffness"]
    chart = el.stability_chart(
        system,
        ("follower_inertia", inertias),
        ("bending_stiffness", stiff * np.array([0.8, 1.0, 1.3])),
        speed=70.0,
    )
    direct = el.monodromy(
        system, 70.0, follower_inertia=chart.x[None, :], bending_stiffness=chart.y[:, None]
    )
    wanted = np.trace(direct.matrix, axis1=-2, axis2=-1) / 2
    assert np.allclose(chart.invariants[..., 0], wanted, rtol=1e-8, atol=1e-9)
