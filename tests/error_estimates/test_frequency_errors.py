"""Error estimates of frequencies: held ones, their means, least gaps, and bounds of frames'."""

import frame_truth
import frequency_truth
import mpmath
import numpy as np
from elastolink.runtime.frequencies import dynamic_stiffness, natural_frequencies, wittrick_williams
from elastolink.runtime.frequencies.held import cycle_mean, held_frequencies
from honesty import over_scenes
from periodic_systems import system_of


def _exact(mass, stiffness):
    """Return natural frequencies by 40-digit arithmetic."""
    with mpmath.workdps(40):
        inverse = mpmath.cholesky(mpmath.matrix(mass.tolist())) ** -1
        symmetric = inverse * mpmath.matrix(stiffness.tolist()) * inverse.T
        squares = mpmath.eigsy((symmetric + symmetric.T) / 2, eigvals_only=True)
        return [mpmath.sqrt(square) for square in squares]


@over_scenes(11)
def test_errors_of_held_frequencies(rng):
    n = int(rng.integers(2, 5))
    turn = np.linalg.qr(rng.normal(size=(n, n)))[0]
    stiffness = turn @ np.diag(10.0 ** rng.uniform(0, 8, n)) @ turn.T
    stiffness = (stiffness + stiffness.T) / 2
    base = rng.normal(size=(n, n))
    mass = base @ base.T + 0.3 * np.eye(n)
    mass = (mass + mass.T) / 2
    frequency, error = held_frequencies(system_of(M=mass, K=stiffness), np.zeros(1), {})
    gaps = [float(abs(a - b)) for a, b in zip(frequency[0], _exact(mass, stiffness), strict=True)]
    return error[0], np.maximum(gaps, frequency[0] * 2.0**-60)


@over_scenes(12, floor=1e-16)
def test_errors_of_means(rng):
    depth, harmonic = rng.uniform(0.05, 0.95), int(rng.integers(1, 4))
    phase = rng.uniform(0, 2 * np.pi)

    def values(theta):
        found = 1.0 / (1.0 - depth * np.cos(harmonic * theta - phase))[:, None]
        return found, 5e-16 * found

    mean, error = cycle_mean(values, 2 * np.pi, enough=1e-7)
    # The mean of 1/(1 - a cos x) is 1/sqrt(1 - a^2).
    return error, mean - 1.0 / np.sqrt(1.0 - depth**2)


@over_scenes(13, floor=1e-16)
def test_errors_of_means_with_a_kink(rng):
    at = rng.uniform(0.0, 2 * np.pi)

    def values(theta):
        found = np.abs(np.cos((theta - at) / 2))[:, None] + 2.0
        return found, 5e-16 * found

    mean, error = cycle_mean(values, 2 * np.pi, [at + np.pi], enough=1e-9)
    return error, mean - 2.0 - 2.0 / np.pi


@over_scenes(14, few=4, many=40, floor=1e-17)
def test_errors_of_least_gaps(rng):
    coupling, at = 10.0 ** rng.uniform(-6, -1), rng.uniform(0, 2 * np.pi)

    def stiffness(theta):
        d = np.sin(theta - at)[:, None, None]
        return np.array([[16.0, coupling], [coupling, 16.0]]) + d * np.diag([1.0, -1.0])

    found = natural_frequencies(system_of(M=np.eye(2), K=stiffness), 0.0).encounters
    assert [one.kind for one in found] == ["veering", "veering"]
    # sqrt(16 + c) - sqrt(16 - c), free of cancellation.
    exact = 2 * coupling / (np.sqrt(16 + coupling) + np.sqrt(16 - coupling))
    return [one.gap_error for one in found], [one.gap - exact for one in found]


@over_scenes(2024, few=None, many=100)
def test_bounds_of_frames(rng):
    """Against determinants in 60 digits."""
    structure = frame_truth.random_frame(rng)
    number = int(rng.integers(1, 5))
    found = wittrick_williams(dynamic_stiffness(structure), count=number)
    assert found.passed
    place = found.frequencies[-1]
    if np.max(np.abs(found.vectors()[-1])) * place < 1e-12:
        return None  # the nodes stand still: a pole of the determinant
    frequency_truth.stiffness.cache_clear()
    frequency_truth.amplitudes.cache_clear()
    gap = abs(float(frame_truth.exact_frequency(structure, place) - float(place)))
    assert gap <= found.error[-1]
    return found.error[-1], gap
