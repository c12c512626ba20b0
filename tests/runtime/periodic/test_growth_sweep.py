"""Largest multipliers at many speeds at once, against multipliers found one speed at a time."""

from concurrent.futures import ThreadPoolExecutor

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.floquet import characteristic_exponents
from elastolink.runtime.reduction.growth import FreeMotion, Growth, MultiplierSweep, _exponential
from elastolink.runtime.reduction.ranges import grid_of, wider
from scipy.linalg import expm

TABLE = "aannaque_1996_table_4_1"


def one_element(ratio):
    overrides = {"mesh.elements": 1, "damping.ratio": ratio}
    return el.load_scene(TABLE, overrides=overrides).system()


@pytest.fixture(scope="module")
def calm():
    """With 0.1 % damping, unstable in several bands."""
    system = one_element(0.001)
    return system, grid_of(system, None)


def test_exponentials_of_about_unit_size_are_exact():
    rng = np.random.default_rng(3)
    matrices = rng.normal(size=(20, 6, 6))
    matrices /= np.linalg.norm(matrices, ord=2, axis=(-2, -1))[:, None, None]
    # The first term left out is 1/13!.
    np.testing.assert_allclose(_exponential(matrices), expm(matrices), atol=4e-10)


def test_steps_are_of_order_six(calm):
    system, grid = calm
    condensed = wider(system, grid, 60.0, 0, {})
    rate = 2452.0
    free = FreeMotion.of(condensed, rate)
    turns = [free.turn(60.0, finer) for finer in (1, 2, 4)]
    ratio = np.linalg.norm(turns[0] - turns[1]) / np.linalg.norm(turns[1] - turns[2])
    assert 2**5.5 < ratio < 2**6.5


def test_the_monodromy_matrix_keeps_liouvilles_determinant(calm):
    """Its logarithm is the mean trace of the generator, all of it damping, over a turn."""
    system, grid = calm
    condensed = wider(system, grid, 60.0, 0, {})
    free = FreeMotion.of(condensed, 2452.0)
    m = len(free.root)
    means = free.series[:, 0, :, m:].real.trace(axis1=-2, axis2=-1)
    expected = -free.period / 60.0 * (60.0 ** np.arange(len(means)) @ means)
    sign, logarithm = np.linalg.slogdet(free.turn(60.0))
    assert sign == 1.0 and expected < -0.5
    assert logarithm == pytest.approx(expected, rel=1e-6)


def test_bands_of_little_damping_are_seen_as_one_speed_at_a_time_does(calm):
    """Speeds of the bands of docs/unstable_bands.md, those beside, and some others."""
    system, grid = calm
    speeds = np.array([45.7, 61.5, 61.9, 67.6, 72.9, 74.2, 75.9, 76.4])
    many = np.unique(np.concatenate([speeds, np.linspace(30.0, 78.0, 60)]))
    found = MultiplierSweep(system, grid).growth(many)
    at = np.searchsorted(many, speeds)
    truth = characteristic_exponents(system, speeds, 5, rtol=1e-7)
    largest = np.max(np.abs(truth.multipliers), axis=1)
    own = np.max(truth.error, axis=1)
    assert np.all(np.abs(found.modulus[at] - largest) <= found.error[at] + own)
    assert np.max(found.error[at]) < 5e-3
    stable = found.modulus[at] + found.error[at] < 1.0
    assert stable.tolist() == (largest < 1.0).tolist()
    assert 2 < np.count_nonzero(~stable) < 8


def test_tables_and_single_speeds_agree(calm):
    """Forty speeds share polynomials, five are found alone; the same by any workers."""
    system, grid = calm
    many = np.linspace(50.0, 70.0, 41)
    tables = MultiplierSweep(system, grid).growth(many)
    alone = MultiplierSweep(system, grid).growth(many[::10])
    both = tables.error[::10] + alone.error
    assert np.all(np.abs(tables.modulus[::10] - alone.modulus) <= both)
    with ThreadPoolExecutor(2) as pool:
        threads = MultiplierSweep(system, grid).growth(many, pool.map)
    assert np.array_equal(threads.modulus, tables.modulus)
    assert np.array_equal(threads.error, tables.error)


def test_slow_cranks_are_decided_by_the_mean_damping(calm):
    """At 0.01 rad/s the first mode turns 2e4 times in a turn of the crank."""
    system, grid = calm
    found = MultiplierSweep(system, grid).growth(np.array([0.01, 0.1]))
    mean = np.mean(np.sqrt(grid.still.squares[:, 0]))
    expected = np.exp(-2.0 * np.pi * 0.001 * mean / np.array([0.01, 0.1]))
    np.testing.assert_allclose(found.modulus, expected, rtol=1e-6, atol=1e-300)
    assert np.all(found.modulus + found.error < 1.0)


def test_equal_and_lonely_speeds_are_served(calm):
    system, grid = calm
    close = 40.0 * (1.0 + 1e-12 * np.arange(20))
    found = MultiplierSweep(system, grid).growth(close)
    one = MultiplierSweep(system, grid).growth(close[:1])
    assert np.all(np.abs(found.modulus - one.modulus) <= found.error + one.error)


def test_undecided_speeds_are_found_from_the_full_system(calm):
    system, grid = calm
    speeds = np.array([50.0, 61.5])
    sweep = MultiplierSweep(system, grid)
    before = sweep.growth(speeds)
    vague = Growth(before.modulus, np.array([before.error[0], 1.0]))
    after = sweep.refined(vague, speeds)
    assert after.modulus[0] == before.modulus[0]
    assert after.error[1] < 1e-5
    assert abs(after.modulus[1] - before.modulus[1]) <= before.error[1] + after.error[1]
    assert sweep.refined(before, speeds) is before


@pytest.mark.slow
def test_three_elements_and_usual_damping_have_an_unstable_range():
    """27 freedoms at 2 %: unstable from 66.3 to 67.3 rad/s, by the full system too."""
    system = el.load_scene(TABLE).system()
    speeds = np.linspace(60.0, 70.0, 101)
    found = MultiplierSweep(system, grid_of(system, None)).growth(speeds)
    unstable = speeds[found.modulus - found.error > 1.0]
    assert 66.2 < unstable[0] < 66.35 and 67.25 < unstable[-1] < 67.35
    picked = [0, 61, 68, 74, 100]
    truth = characteristic_exponents(system, speeds[picked], 7, rtol=1e-6)
    largest = np.max(np.abs(truth.multipliers), axis=1)
    own = np.max(truth.error, axis=1)
    assert np.all(np.abs(found.modulus[picked] - largest) <= found.error[picked] + own)
    assert np.any(largest > 1.0) and np.any(largest < 1.0)
