"""Error estimates of linear periodic systems, over random systems that other routes solve.

Two routes: Taylor series in extended precision (``taylor_truth``: every kind of term, one to three
coordinates, known to about 1e-15 of the flow, which the Fourier series of the terms lose), and
springs seen in wavy coordinates, whose multipliers and boundary speeds are known in closed form.
"""

import elastolink as el
import numpy as np
import pytest
import taylor_truth
from honesty import over_scenes
from manufactured import manufactured
from periodic_systems import system_of, wave
from wavy_springs import Wavy, WavyCoordinates, tame

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")
EPS = float(np.finfo(float).eps)
SAMPLES = 8


def _of_motion(result, truth):
    """Return the error estimates of a motion, and the actual errors over the peaks."""
    gap = np.max(np.abs(result.q - truth), axis=0) / np.max(np.abs(truth), axis=0)
    return result.error, gap


def _of_matrix(result, exact):
    """Return the error estimate of a monodromy matrix, and its error in scaled variables."""
    exact = exact / result.scale[:, None] * result.scale
    return result.error, np.max(np.abs(result.scaled - exact)) / np.max(np.abs(exact))


def _outcomes(seed):
    """Return by answer the estimates and the actual errors, of one random system."""
    system, speed, motion = manufactured(seed)
    rng, n = np.random.default_rng(seed), system.size
    truth = taylor_truth.Equation.of(system, speed, forced=True)
    flows = taylor_truth.flows(truth, 1.0, SAMPLES)
    whole = truth.unscaled(flows[-1])[: 2 * n, : 2 * n]
    out = {}
    for rtol in (1e-13, 1e-10, 1e-5):
        matrix = el.monodromy(system, speed, rtol=rtol)
        assert matrix.passed, matrix.checks
        out[f"monodromy {rtol:g}"] = _of_matrix(matrix, whole)

    start = rng.standard_normal(n), speed * rng.standard_normal(n)
    states = [truth.start(start[0], start[1] / speed).astype(np.longdouble)]
    for _ in range(2):
        states += list(flows[1:] @ states[-1])
    exact = truth.coordinates(np.array(states))
    for rtol in (1e-11, 1e-6):
        run = el.simulate(system, speed, 2.0, initial=start, samples=SAMPLES, rtol=rtol)
        assert run.passed, run.checks
        out[f"simulate {rtol:g}"] = _of_motion(run, exact)

    for method, rtol in (("auto", 1e-10), ("auto", 1e-4), ("harmonic_balance", 1e-9)):
        steady = el.steady_state(system, speed, method=method, rtol=rtol)
        exact_steady = motion(steady.theta)
        out[f"{method} {rtol:g}"] = _of_motion(steady, exact_steady)
        assert steady.passed, steady.checks
        # A rate is less accurate by the harmonics that it weighs up.
        rate = speed * motion.derivative(steady.theta)
        rates = np.max(np.abs(steady.qd - rate), axis=0) / np.max(np.abs(rate), axis=0)
        assert np.all(rates <= 100 * np.max(steady.error) + 1e-12)

    if seed % 2:
        return out
    ready = el.prepare(system, (0.8 * speed, 1.3 * speed), samples=SAMPLES)
    out["prepared monodromy"] = _of_matrix(ready.monodromy(speed), whole)
    out["prepared simulate"] = _of_motion(ready.simulate(speed, 2, start), exact)
    angles = ready.theta
    out["prepared steady"] = _of_motion(ready.steady_state(speed), motion(angles))
    return out


@pytest.mark.parametrize("scenes", [10, pytest.param(100, marks=pytest.mark.slow)])
def test_the_estimates_cover_the_errors_and_are_not_idle(scenes):
    """In 99 of 100 cases, of few systems in all but one, and within a hundred in the middle."""
    total: dict[str, list] = {}
    for seed in range(scenes):
        for name, (estimate, actual) in _outcomes(seed).items():
            total.setdefault(name, []).append(np.broadcast_arrays(estimate, np.atleast_1d(actual)))
    for name, pairs in total.items():
        estimate, actual = np.hstack(pairs).astype(float)
        assert np.sum(actual > estimate) <= max(1, 0.01 * len(actual)), name
        # Below a few units in the last place the reference's own rounding shows.
        assert np.median(estimate / np.maximum(actual, 4 * EPS)) <= 1e2, name


@over_scenes(6, few=15, many=150)
def test_prepared_for_any_tolerance(rng):
    """From growth to a decay by 1e-12 in a period, at some place of the range."""
    n = int(rng.integers(1, 4))
    mixed = np.eye(n) + 0.2 * rng.standard_normal((n, n))
    squares = rng.uniform(1.0, 20.0, n) ** 2
    mass, stiffness = mixed.T @ mixed, mixed.T @ np.diag(squares) @ mixed
    speed = float(np.sqrt(np.max(squares)) * 10.0 ** rng.uniform(-1.0, 0.5))
    drag = speed * float(rng.choice([0.0, 0.01, 2.0, 8.0]))
    system = system_of(
        M=mass,
        C=drag * mass,
        K=stiffness,
        Kg=wave(0.1 * np.min(squares) * mass, int(rng.integers(1, 3))),
        f=wave(rng.standard_normal(n)),
    )
    span = speed * rng.uniform(0.6, 1.0), speed * rng.uniform(1.0, 1.6)
    rtol = float(10.0 ** rng.uniform(-13.0, -4.0))
    ready = el.prepare(system, span, samples=SAMPLES, rtol=rtol)
    truth = taylor_truth.Equation.of(system, speed, forced=True)
    flows = taylor_truth.flows(truth, 1.0, SAMPLES)
    matrix = ready.monodromy(speed)
    assert matrix.checks["converged"].limit >= rtol
    estimate, actual = _of_matrix(matrix, truth.unscaled(flows[-1])[: 2 * n, : 2 * n])
    assert estimate <= 1e4 * max(actual, EPS)
    start, turns = (rng.standard_normal(n), speed * rng.standard_normal(n)), int(rng.integers(1, 9))
    states = [truth.start(start[0], start[1] / speed).astype(np.longdouble)]
    for _ in range(turns):
        states += list(flows[1:] @ states[-1])
    run = ready.simulate(speed, turns, start)
    moved = _of_motion(run, truth.coordinates(np.array(states)))
    return {"matrix": (estimate, np.maximum(actual, EPS / 4)), "motion": moved}


def _on_the_circle(rng):
    """Return two or three undamped springs in coordinates that wave thrice a turn, and rates."""
    n = int(rng.integers(2, 4))
    # Products of few digits are exact: rounding of K would move the rates.
    squares = np.rint(rng.uniform(1.0, 5.0, n) ** 2 * 256.0) / 256.0
    fixed = np.eye(n) + np.rint(150.0 * rng.standard_normal((n, n))) / 1024.0
    waves = WavyCoordinates(fixed, 0.03 * rng.standard_normal((2, 3, n, n)))
    return waves.arrays(squares), np.sqrt(squares)


def _nearest(values, rates, speed):
    """Return how far multipliers are from the nearest ``exp(+-2 pi i rate/speed)``."""
    turns = np.concatenate([rates, -rates]) / speed
    return np.min(np.abs(values[:, None] - np.exp(2j * np.pi * turns)), axis=1)


@over_scenes(7, few=30, many=250, floor=EPS)
def test_multipliers_on_the_circle_at_a_coarse_tolerance(rng):
    """Where the waves, not the rates, make the error: it cancels by chance on one rung."""
    arrays, rates = _on_the_circle(rng)
    speed = float(np.max(rates) * 10.0 ** rng.uniform(-0.3, 1.0))
    found = el.floquet_multipliers(system_of(**arrays), speed, rtol=1e-4)
    return found.error, _nearest(found.multipliers, rates, speed)


@over_scenes(8, few=15, many=150, floor=EPS)
def test_multipliers_of_a_prepared_system(rng):
    """The tables are good to the last digits here, and the error is that of their round-off."""
    arrays, rates = _on_the_circle(rng)
    low = float(np.max(rates) * 10.0 ** rng.uniform(-0.5, 0.5))
    rtol = float(10.0 ** rng.uniform(-12.0, -4.0))
    system = system_of(**arrays, f=wave(rng.standard_normal(len(rates))))
    ready = el.prepare(system, (low, 1.5 * low), samples=SAMPLES, rtol=rtol)
    speed = low * rng.uniform(1.0, 1.5)
    motion = ready.steady_state(speed)
    return motion.multiplier_error, _nearest(motion.multipliers, rates, speed)


@over_scenes(4, few=15, many=100)
def test_motions_of_fast_modes_that_live(rng):
    """From a state in which all of them ring, up to a thousand radians between given angles."""
    n, samples, turns = int(rng.integers(2, 5)), int(rng.choice([8, 24, 60])), rng.uniform(0.2, 1.5)
    rates = np.sort(10.0 ** rng.uniform(0.0, np.log10(160.0 * samples), n))
    loss = float(rng.choice([0.0, 0.02, 0.5])) / np.pi
    # Uncoupled: rounding of a full K would change the slow rates.
    system = system_of(
        M=np.eye(n),
        C=2.0 * loss * np.eye(n),
        K=np.diag(rates**2 + loss**2),
        f=wave(rng.standard_normal(n)),
    )
    # The slow ones ring by far more than the fast ones.
    size = 10.0 ** (rng.uniform(-6.0, 0.0) * np.arange(n) / n)
    steady = system.array("f", np.zeros(1))[0] / (rates**2 + loss**2 - 1.0 + 2j * loss)
    start = steady.real + size, (1j * steady).real
    rtol = float(10.0 ** rng.uniform(-8.0, -2.0))
    found = el.simulate(system, 1.0, turns, initial=start, samples=samples, rtol=rtol)
    time = found.theta[:, None]
    ring = np.exp(-loss * time) * (np.cos(rates * time) + loss / rates * np.sin(rates * time))
    exact = (steady * np.exp(1j * time)).real + size * ring
    return _of_motion(found, exact)


@over_scenes(9, few=20, many=200, floor=16 * EPS)
def test_motions_of_overdamped_modes(rng):
    """Each has a rate far above its frequency, which dies within a step, and one far below."""
    n, samples, turns = int(rng.integers(1, 4)), int(rng.choice([8, 24])), rng.uniform(0.2, 4.0)
    natural = 10.0 ** rng.uniform(-0.5, 1.5, n)
    loss = natural * 10.0 ** rng.uniform(0.02, 2.5, n)
    system = system_of(
        M=np.eye(n),
        C=np.diag(2.0 * loss),
        K=np.diag(natural**2),
        f=wave(rng.standard_normal(n)),
    )
    force = system.array("f", np.zeros(1))[0]
    steady = force / (natural**2 - 1.0 + 2j * loss)
    fast = loss + np.sqrt(loss**2 - natural**2)
    slow = natural**2 / fast
    place, rate = rng.standard_normal((2, n)) * np.array([[1.0], [10.0 ** rng.uniform(-1.0, 2.0)]])
    rtol = float(10.0 ** rng.uniform(-9.0, -2.0))
    found = el.simulate(system, 1.0, turns, initial=(place, rate), samples=samples, rtol=rtol)
    # Of place and rate less those of the steady motion: q = a exp(-slow t) + b exp(-fast t).
    free, moved = place - steady.real, rate - (1j * steady).real
    b = -(moved + slow * free) / (fast - slow)
    time = found.theta[:, None]
    exact = (steady * np.exp(1j * time)).real
    exact += (free - b) * np.exp(-slow * time) + b * np.exp(-fast * time)
    return _of_motion(found, exact)


@over_scenes(2, few=40, many=300)
def test_estimates_of_multipliers(rng):
    """Of every other system one coordinate is repelled: its multipliers reach far."""
    squares = rng.uniform(1.0, 60.0, 2)
    if rng.random() < 0.5:
        squares[0] *= -0.2
    scene = Wavy(rng, squares)
    if not tame(scene):
        return None
    speed = float(rng.uniform(0.3, 4.0))
    result = el.floquet_multipliers(scene.system, speed)
    assert result.passed, (result.checks, squares, speed)
    gaps = np.abs(scene.multipliers(speed)[:, None] - result.multipliers)
    return result.error, np.min(gaps, axis=0)


@over_scenes(3, few=60, many=None)
def test_boundary_estimate(rng):
    scene = Wavy(rng, rng.uniform(1.0, 9.0, 2))
    if not tame(scene):
        return None
    found = el.speed_boundaries(scene.system, speed_range=(0.9, 7.0))
    # w = 2 Omega/k, k odd for -1; every one double, as nothing couples.
    natural = np.sqrt(scene.squares)
    exact = np.sort((2 * natural[:, None] / np.arange(1, 9)).ravel())
    exact = np.repeat(exact[(exact > 0.9) & (exact < 7.0)], 2)
    assert len(found.speed) == len(exact)
    assert found.passed, found.checks
    return found.error, found.speed - exact
