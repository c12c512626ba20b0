"""Error figures of tongues of random coupled systems, and an integration that is not ours."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.floquet import floquet_multipliers
from elastolink.runtime.stability import resonances, tongue
from periodic_systems import named
from scipy.integrate import solve_ivp


def _waves(rng, size, symmetric=True):
    """Return two harmonics with random matrices as a function of angle."""
    parts = []
    for harmonic in (1, 2):
        for phase in (0.0, np.pi / 2):
            matrix = rng.normal(size=(size, size)) / (2 * harmonic)
            parts.append((harmonic, phase, (matrix + matrix.T) / 2 if symmetric else matrix))
    return lambda theta: sum(
        np.cos(harmonic * theta - phase)[:, None, None] * matrix
        for harmonic, phase, matrix in parts
    )


def _definite(rng, size):
    root = np.eye(size) + 0.2 * rng.normal(size=(size, size))
    return root @ root.T


def _random(seed: int, size: int = 2) -> LinearPeriodic:
    """Every array of the family periodic in proportion to eps, with damping."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(size, size)))[0]
    stiffness = turn @ np.diag(np.sort(rng.uniform(1.0, 12.0, size))) @ turn.T
    terms = (
        Term("M", None, _definite(rng, size)),
        Term("M", "eps", _waves(rng, size)),
        Term("A", None, 0.1 * rng.normal(size=(size, size))),
        Term("A", "eps", _waves(rng, size, symmetric=False)),
        Term("B", None, 0.05 * np.diag(rng.normal(size=size))),
        Term("B", "eps", _waves(rng, size)),
        Term("K", None, stiffness),
        Term("K", "eps", _waves(rng, size)),
        Term("C", "c", _definite(rng, size)),
    )
    return LinearPeriodic(size, terms, {"eps": 0.0, "c": 0.0}, named(["eps", "c"]))


def _growing(system, speed, limit, **parameters):
    """Return how many multipliers are outside the unit circle, so that tongues may overlap."""
    values = floquet_multipliers(system, speed, rtol=1e-13, **parameters).multipliers
    return np.sum(np.abs(values) > 1 + limit, axis=-1)


# Small enough that neighbouring tongues do not touch.
EPS = np.array([0.02, 0.01, 0.005])


def _ratios(system, resonance, order, drag):
    """Return actual errors over the figures, at all ends that are known to half a width."""
    found = tongue(
        system, resonance, parameter=("eps", EPS), order=order, c=drag, damping_factor=EPS / EPS[0]
    )
    kept = np.flatnonzero(found.open & (2 * found.error < found.width))
    if not len(kept):
        return []
    eps, error = EPS[kept], found.error[kept]
    given = {"eps": eps, "c": drag * eps / EPS[0]}
    # Undamped, round-off of a double multiplier is magnified by the square root.
    limit = 0.0 if drag else 1e-8
    ratios = []
    for end, side in ((found.lower[kept], -1.0), (found.upper[kept], 1.0)):
        inner, outer = end - 2 * side * error, end + 2 * side * error
        beyond = _growing(system, outer, limit, **given)
        covered = _growing(system, inner, limit, **given) > beyond
        for _ in range(14):
            trial = (inner + outer) / 2
            grows = _growing(system, trial, limit, **given) > beyond
            inner, outer = np.where(grows, trial, inner), np.where(grows, outer, trial)
        actual = np.abs((inner + outer) / 2 - end)
        ratios += np.where(covered, actual / error, np.inf)[error > 1e-10].tolist()
    return ratios


def _sample(seeds):
    ratios = []
    for seed in seeds:
        system = _random(seed)
        for place, resonance in enumerate(resonances(system, (0.9, 9.0), highest=2)):
            if resonance.opens:
                drag = 0.0 if (seed + place) % 2 else 0.0015
                ratios += _ratios(system, resonance, 1 + (seed + place) % 3, drag)
    return np.array(ratios)


def test_error_figures_of_a_few_random_systems():
    ratios = _sample(range(1))
    assert len(ratios) > 12
    assert np.all(ratios <= 1)
    assert np.median(ratios) > 1e-3


@pytest.mark.slow
def test_error_figures_of_random_systems():
    ratios = _sample(range(100, 109))
    assert len(ratios) >= 200
    assert np.mean(ratios <= 1) >= 0.99
    assert np.median(ratios) > 1e-3


def test_three_modes_against_an_integration_of_the_second_order_equation():
    system, eps = _random(7, size=3), 0.02
    compared = 0
    for resonance in resonances(system, (1.5, 9.0), kinds=("principal", "sum"), highest=1):
        found = tongue(system, resonance, parameter=("eps", eps), order=4)
        if not found.open or 40 * found.error > found.width:
            continue
        for end, side in ((found.lower, -1), (found.upper, 1)):
            counts = [
                int(np.sum(np.abs(np.linalg.eigvals(_by_hand(system, speed, eps))) > 1 + 1e-6))
                for speed in end + 0.05 * found.width * np.array([-side, side])
            ]
            assert counts[0] == counts[1] + (1 if resonance.kind == "principal" else 2)
            compared += 1
    assert compared >= 6


def _by_hand(system, speed, eps):
    """Return the monodromy matrix of (q, dq/dtheta) from M q'' + ... = 0, M' by differences."""
    n, h = system.size, 1e-5

    def arrays(theta):
        at = np.array([theta - h, theta, theta + h])
        found = {name: system.array(name, at, speed, eps=eps) for name in "MABK"}
        mass_slope = (found["M"][2] - found["M"][0]) / (2 * h)
        gyro_slope = (found["A"][2] - found["A"][0]) / (2 * h)
        return {name: value[1] for name, value in found.items()}, mass_slope, gyro_slope

    def slope(theta, state):
        now, mass_slope, gyro_slope = arrays(theta)
        q, rate = state.reshape(2, n, 2 * n)
        force = -(mass_slope + now["A"] - now["A"].T) @ rate
        force -= (now["K"] / speed**2 + gyro_slope - now["B"]) @ q
        return np.concatenate([rate, np.linalg.solve(now["M"], force)]).ravel()

    start = np.eye(2 * n).ravel()
    solution = solve_ivp(slope, (0.0, system.period), start, "DOP853", rtol=1e-10, atol=1e-12)
    return solution.y[:, -1].reshape(2 * n, 2 * n)
