"""Error estimates of held frequencies, of their means and of least gaps, over random systems."""

from __future__ import annotations

import mpmath
import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.frequencies import natural_frequencies
from elastolink.runtime.frequencies.held import cycle_mean, held_frequencies
from honesty import SCENES, verdict


def _exact(mass, stiffness):
    """Return natural frequencies by 40-digit arithmetic."""
    with mpmath.workdps(40):
        inverse = mpmath.cholesky(mpmath.matrix(mass.tolist())) ** -1
        symmetric = inverse * mpmath.matrix(stiffness.tolist()) * inverse.T
        squares = mpmath.eigsy((symmetric + symmetric.T) / 2, eigvals_only=True)
        return [mpmath.sqrt(square) for square in squares]


@SCENES
def test_errors_of_held_frequencies(scenes):
    rng = np.random.default_rng(11)
    ratio = []
    for _ in range(scenes):
        n = int(rng.integers(2, 5))
        turn = np.linalg.qr(rng.normal(size=(n, n)))[0]
        stiffness = turn @ np.diag(10.0 ** rng.uniform(0, 8, n)) @ turn.T
        stiffness = (stiffness + stiffness.T) / 2
        base = rng.normal(size=(n, n))
        mass = base @ base.T + 0.3 * np.eye(n)
        mass = (mass + mass.T) / 2
        terms = (Term("M", None, mass), Term("K", None, stiffness))
        system = LinearPeriodic(n, terms, {}, lambda values: {})
        frequency, error = held_frequencies(system, np.zeros(1), {})
        exact = _exact(mass, stiffness)
        for found, estimate, true in zip(frequency[0], error[0], exact, strict=True):
            ratio.append(float(estimate / max(abs(found - true), mpmath.mpf(found) * 2**-60)))
    verdict(ratio)


@SCENES
def test_errors_of_means(scenes):
    rng = np.random.default_rng(12)
    ratio = []
    for _ in range(scenes):
        depth, harmonic = rng.uniform(0.05, 0.95), int(rng.integers(1, 4))
        phase = rng.uniform(0, 2 * np.pi)

        def values(theta, depth=depth, harmonic=harmonic, phase=phase):
            found = 1.0 / (1.0 - depth * np.cos(harmonic * theta - phase))[:, None]
            return found, 1e-15 * found

        mean, error = cycle_mean(values, 2 * np.pi, enough=1e-7)
        # The mean of 1/(1 - a cos x) is 1/sqrt(1 - a^2).
        actual = abs(mean[0] - 1.0 / np.sqrt(1.0 - depth**2))
        ratio.append(error[0] / max(actual, 1e-17))
    verdict(ratio)


@SCENES
def test_errors_of_means_with_a_kink(scenes):
    rng = np.random.default_rng(13)
    ratio = []
    for _ in range(scenes):
        at = rng.uniform(0.0, 2 * np.pi)

        def values(theta, at=at):
            found = np.abs(np.cos((theta - at) / 2))[:, None] + 2.0
            return found, 1e-15 * found

        mean, error = cycle_mean(values, 2 * np.pi, [at + np.pi], enough=1e-9)
        ratio.append(error[0] / max(abs(mean[0] - 2.0 - 2.0 / np.pi), 1e-16))
    verdict(ratio)


@SCENES
def test_errors_of_least_gaps(scenes):
    rng = np.random.default_rng(14)
    ratio = []
    for _ in range(scenes // 5):
        coupling, at = 10.0 ** rng.uniform(-6, -1), rng.uniform(0, 2 * np.pi)

        def stiffness(theta, coupling=coupling, at=at):
            d = np.sin((theta - at) / 1.0)
            return np.moveaxis(
                np.array([[16 + d, coupling + 0 * d], [coupling + 0 * d, 16 - d]]), (0, 1), (-2, -1)
            )

        terms = (Term("M", None, np.eye(2)), Term("K", None, stiffness))
        found = natural_frequencies(LinearPeriodic(2, terms, {}, lambda values: {}), 0.0)
        assert [one.kind for one in found.encounters] == ["veering", "veering"]
        for one in found.encounters:
            # sqrt(16 + c) - sqrt(16 - c), free of cancellation.
            exact = 2 * coupling / (np.sqrt(16 + coupling) + np.sqrt(16 - coupling))
            ratio.append(one.gap_error / max(abs(one.gap - exact), 1e-17))
    verdict(ratio)
