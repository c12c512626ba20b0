"""The margins of stability of a Newmark step by its own linear equations, in many digits."""

from functools import lru_cache

import mpmath
import numpy as np
from elastolink.derive.checks import Exact, Point, exact_at


def step_matrix(gamma, beta, damping, phase):
    """Return the step on (q, h q') by solving for the new acceleration, column by column."""
    columns = []
    for q, v in ((1, 0), (0, 1)):
        old = -2 * damping * phase * v - phase**2 * q
        # a = -2 zeta phase (v + (1 - gamma) old + gamma a) - phase^2 (q + v + ...).
        known = -2 * damping * phase * (v + (1 - gamma) * old)
        known -= phase**2 * (q + v + (mpmath.mpf(1) / 2 - beta) * old)
        new = known / (1 + 2 * damping * phase * gamma + beta * phase**2)
        columns.append(
            (
                q + v + (mpmath.mpf(1) / 2 - beta) * old + beta * new,
                v + (1 - gamma) * old + gamma * new,
            )
        )
    return mpmath.matrix(columns).T


def margins(numbers):
    """Return what the emitted function returns, by trace and determinant."""
    matrix = step_matrix(*(numbers[name] for name in ("gamma", "beta", "damping", "phase")))
    trace = matrix[0, 0] + matrix[1, 1]
    product = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    return {
        "determinant_margin": 1 - product,
        "flip_margin": 1 + trace + product,
        "static_margin": 1 - trace + product,
        "turning": (product - trace**2 / 4) / numbers["phase"] ** 2,
    }


def _points():
    random = np.random.default_rng(61)
    for k in range(80):
        yield Point(
            f"random {k}",
            {
                "gamma": random.uniform(0.0, 1.5),
                "beta": random.uniform(0.0, 1.0),
                "damping": random.uniform(0.0, 2.0),
                "phase": 10.0 ** random.uniform(-6.0, 6.0),
            },
        )
    for name, values in (
        ("constant acceleration", (0.5, 0.25, 0.02, 1e8)),
        ("a hair from it", (0.5 + 1e-15, 0.25 - 1e-15, 0.0, 3.0)),
        ("linear acceleration at its limit", (0.5, 1.0 / 6.0, 0.0, 12.0**0.5)),
        ("explicit at its limit", (0.5, 0.0, 0.0, 2.0)),
        ("critical damping", (0.5, 0.25, 1.0, 1.0)),
        ("tiny step", (0.6, 0.3, 1e-9, 1e-9)),
    ):
        yield Point(name, dict(zip(("gamma", "beta", "damping", "phase"), values, strict=True)))


@lru_cache(maxsize=1)
def exact_newmark() -> tuple[Exact, ...]:
    """Return the exact margins at random and nasty points."""
    return tuple(exact_at(margins, point) for point in _points())
