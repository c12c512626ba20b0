"""The documents' one-step methods: de Vogelaere, Kutta-Merson, Newmark."""

import numpy as np
import pytest
import scipy.linalg
from beam_motions import damped_four_bar
from elastolink.runtime.core.collocation import gauss_maps
from elastolink.runtime.gallery.algorithms import (
    de_vogelaere_maps,
    de_vogelaere_start,
    kutta_merson,
    merson_step,
    newmark_limit,
    newmark_maps,
    newmark_matrices,
)
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.periodic.ring import solve_ring
from marching import wavy
from seed_listings import de_vogelaere

START = np.array([0.3, -1.0, 0.7])


def constant(theta):
    return np.broadcast_to(wavy(np.array([1.1])), (len(theta), 3, 3))


# Kutta-Merson -----------------------------------------------------------------------------------


def test_merson_estimate_is_exact_to_leading_order_for_constant_coefficients():
    ratios = []
    for step in (0.1, 0.05, 0.025, 0.0125):
        exact = scipy.linalg.expm(step * constant([0.0])[0]) @ START
        end, estimate = merson_step(constant, 0.0, step, START)
        ratios.append(np.linalg.norm(estimate) / np.linalg.norm(end - exact))
    gaps = np.abs(np.array(ratios) - 1)
    assert gaps[-1] < 0.01
    assert np.all(gaps[1:] < 0.6 * gaps[:-1])


def test_kutta_merson_keeps_its_tolerance():
    theta = np.linspace(0.0, 6.0, 13)
    exact = [START]
    for left in theta[:-1]:
        state = exact[-1]
        for matrix in gauss_maps(8, wavy, left + 0.05 * np.arange(10), 0.05):
            state = matrix @ state
        exact.append(state)
    counts, tried = [], []

    def counted(angles):
        tried.append(1)
        return wavy(angles)

    for rtol in (1e-5, 1e-7, 1e-9):
        tried.clear()
        states = kutta_merson(counted, theta, START, rtol, np.full(3, rtol), first=0.3)
        assert np.max(np.abs(states - np.array(exact))) < 20 * rtol
        counts.append(len(tried))
    # With these coefficients the estimate is of fourth order in the step: 100**(1/4) = 3.16.
    assert 2.8 < counts[2] / counts[1] < 3.4


# De Vogelaere -----------------------------------------------------------------------------------


def hill(theta):
    """P of a forced Hill equation; its second component stays 1."""
    out = np.zeros((len(theta), 2, 2))
    out[:, 0, 0] = -30.0 * (1 + 0.3 * np.cos(theta))
    out[:, 0, 1] = 0.2 * np.sin(theta)
    return out


def march(generator, x0, h, steps, y0, z0):
    states = [de_vogelaere_start(generator, x0, h, np.array([y0, 1.0]), np.array([z0, 0.0]))]
    for matrix in de_vogelaere_maps(generator, x0 + 2 * h * np.arange(steps), h):
        states.append(matrix @ states[-1])
    return np.array(states)[:, 0]


@pytest.mark.parametrize("start", [(0.0, 0.1, 0.0), (0.0, 0.0, 0.4), (0.7, 0.05, -0.2)])
def test_de_vogelaere_equals_the_recurrence_of_the_listing(start):
    h = np.radians(0.5)

    def force(theta, y):
        return -30.0 * (1 + 0.3 * np.cos(theta)) * y + 0.2 * np.sin(theta)

    _, listed = de_vogelaere(force, *start, h, 720, ("slope", "start"))
    found = march(hill, start[0], h, 720, *start[1:])[1:]
    np.testing.assert_allclose(found, listed, rtol=0, atol=1e-12 * np.max(np.abs(listed)))


# Newmark ----------------------------------------------------------------------------------------


def growth(phase, **weights):
    """Return the largest modulus of a multiplier of an undamped step of one freedom."""
    one = np.ones((2, 1, 1))
    maps, _ = newmark_matrices(one, 0.0 * one, phase**2 * one, np.zeros((2, 1)), 1.0, **weights)
    return float(np.max(np.abs(np.linalg.eigvals(maps[0]))))


@pytest.mark.parametrize(
    ("gamma", "beta", "limit"),
    [
        # Central differences; Fox and Goodwin; linear acceleration: 4/(1 - 4 beta), squared.
        (0.5, 0.0, 2.0),
        (0.5, 1.0 / 12.0, 6.0**0.5),
        (0.5, 1.0 / 6.0, 12.0**0.5),
        (0.5, 0.25, np.inf),
        (0.8, 0.4, np.inf),
        (0.4, 0.25, 0.0),
    ],
)
def test_known_limits(gamma, beta, limit):
    assert newmark_limit(gamma, beta) == pytest.approx(limit, rel=1e-12)


def test_the_limit_is_where_the_steps_begin_to_grow():
    random = np.random.default_rng(8)
    for _ in range(100):
        gamma, beta = random.uniform(0.0, 1.0, 2) * (1.2, 0.5)
        limit = float(newmark_limit(gamma, beta))
        below, above = (1e3, None) if np.isinf(limit) else (0.999 * limit, 1.01 * limit or 0.1)
        assert growth(below, gamma=gamma, beta=beta) <= 1.0 + 1e-9
        assert above is None or growth(above, gamma=gamma, beta=beta) > 1.0


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_newmarks_steps_come_near_a_steady_state():
    """Second order, on the four-bar of beams: four times as many steps, a sixteenth of the gap."""
    system, gaps = damped_four_bar(), []
    for intervals in (720, 2880):
        exact = steady_state(system, 62.0, samples=intervals).q
        maps, loads = newmark_maps(system, 62.0, intervals)
        found = solve_ring(maps[None], loads[None])[0][0, :, : system.size]
        gaps.append(np.max(np.max(np.abs(found - exact), axis=0) / np.max(np.abs(exact), axis=0)))
    assert gaps[0] < 0.03
    assert gaps[1] < gaps[0] / 12
