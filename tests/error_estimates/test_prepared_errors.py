"""Error figures of prepared systems, against Taylor series in extended precision.

The reference solves the Fourier series of the generator by steps of order 29 in long doubles; it
shares no stretch, node or polynomial with the tables.  It is known to about 1e-17 of the flow.
"""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.runtime.benchmarking.work_precision import reference
from elastolink.runtime.benchmarking.work_precision.equation import Equation
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.prepared import prepare

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning"),
]
SCENES = 200


def _waves(rng, n, size, *, symmetric=True):
    """Return a smooth periodic matrix function with three harmonics."""
    parts = size * rng.standard_normal((2, 3, n, n)) * 0.5 ** np.arange(1, 4)[:, None, None]
    if symmetric:
        parts = parts + np.swapaxes(parts, -1, -2)

    def function(theta):
        angle = np.arange(1, 4)[:, None] * theta
        found = np.einsum("kt,kij->tij", np.cos(angle), parts[0])
        return found + np.einsum("kt,kij->tij", np.sin(angle), parts[1])

    return function


def _system(rng) -> LinearPeriodic:
    n = int(rng.integers(1, 4))
    stiff = np.diag(rng.uniform(0.3, 60.0, n))
    force, mass = _waves(rng, n, 1.0), 0.3 * rng.standard_normal((n, n))
    terms = (
        Term("M", None, np.eye(n) + mass @ mass.T),
        Term("A", None, _waves(rng, n, 0.05, symmetric=False)),
        Term("B", None, _waves(rng, n, 0.1)),
        Term("C", None, 10.0 ** rng.uniform(-3, 0) * np.eye(n)),
        Term("K", None, stiff),
        Term("Kg", None, _waves(rng, n, 0.2), power=2),
        Term("f", None, lambda theta: force(theta)[:, :, 0]),
    )
    return LinearPeriodic(n, terms, {}, lambda values: {})


def _scenes():
    rng = np.random.default_rng(20261122)
    for _ in range(SCENES):
        system = _system(rng)
        low = 10.0 ** rng.uniform(-0.3, 0.5)
        span = (low, low * rng.uniform(1.0, 3.0))
        speed = float(rng.uniform(*span))
        ready = prepare(system, span, samples=8)
        yield system, ready, speed, Equation.of(system, speed, forced=True, cut=1e-15), rng


def test_figures_cover_the_errors_of_all_three_answers() -> None:
    """In 99 of 100 scenes, and not by more than a thousand times in the middle."""
    ratios: dict[str, list[float]] = {"matrix": [], "motion": [], "steady": []}
    for system, ready, speed, equation, rng in _scenes():
        n, m = system.size, 2 * system.size
        flows = reference.flows(equation, 1.0, 8)
        scale = equation.scale
        found = ready.monodromy(speed)
        exact = flows[-1, :m, :m] * (scale[:m, None] / scale[:m])
        inside = found.scale[:, None] / found.scale
        gap = np.max(np.abs(found.matrix - exact) / inside) / np.max(np.abs(exact) / inside)
        ratios["matrix"].append(float(found.error / gap))

        start = rng.standard_normal(n), speed * rng.standard_normal(n)
        motion = ready.simulate(speed, 3, start)
        state = equation.start(start[0], start[1] / speed).astype(np.longdouble)
        states = [state]
        for _ in range(3):
            states += list(flows[1:] @ states[-1])
        ratios["motion"].append(_least(motion, np.array(states)[:, :n] * scale[:n]))

        steady = ready.steady_state(speed)
        truth = reference.periodic(equation, 8)[:, :n] * scale[:n]
        ratios["steady"].append(_least(steady, truth))
    for name, values in ratios.items():
        covered = np.mean(np.array(values) >= 1.0)
        assert covered >= 0.99, f"{name}: {covered}"
        assert np.median(values) <= 1e3, f"{name}: {np.median(values)}"


def _least(found, truth) -> float:
    """Return the smallest figure over error among the coordinates."""
    peak = np.max(np.abs(truth), axis=0)
    gap = np.max(np.abs(found.q - truth), axis=0) / peak
    return float(np.min(found.error / np.maximum(gap, np.finfo(np.longdouble).tiny)))
