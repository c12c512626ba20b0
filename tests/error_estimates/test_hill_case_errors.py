"""Figures of the special cases of Hill's equation: steps, Mathieu, surfaces, charts, thresholds."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill.cases.meissner import meissner_boundaries
from elastolink.runtime.hill.cases.named import mathieu_characteristic
from elastolink.runtime.hill.cases.piecewise import piecewise_approximation, piecewise_monodromy
from elastolink.runtime.hill.cases.strutt import strutt_chart
from elastolink.runtime.hill.cases.surfaces import multiplier_surfaces
from half_trace_truth import half_traces
from honesty import verdict

SCENES = 200
MP = mpmath.MPContext()
MP.dps = 50
EXTENDED = np.longdouble
extended = pytest.mark.skipif(
    np.finfo(EXTENDED).eps > 1e-18, reason="the reference needs a long double of 80 bits"
)


def interval(level, length):
    """Return the matrix of one interval by the complex root of its level."""
    root = MP.sqrt(MP.mpc(level))
    cosine = MP.cos(root * length).real
    sine = (MP.sin(root * length) / root).real if level else MP.mpf(length)
    return MP.matrix([[cosine, sine], [-level * sine, cosine]])


def product(levels, lengths, damping):
    """Return the monodromy matrix of y'' + 2 K y' + q y = 0 in (y, y'), and its half trace."""
    k, whole = MP.mpf(damping), MP.eye(2)
    for level, length in zip(levels, lengths, strict=True):
        whole = interval(MP.mpf(float(level)) - k * k, MP.mpf(float(length))) * whole
    fall = MP.exp(-k * MP.fsum(map(float, lengths)))
    into, out = MP.matrix([[1, 0], [k, 1]]), MP.matrix([[1, 0], [-k, 1]])
    matrix = fall * (out * whole * into)
    return matrix, (matrix[0, 0] + matrix[1, 1]) / 2


def gap(ours, truth):
    return float(abs(MP.mpf(float(ours)) - truth))


def waves(rng):
    """Return a random function of 1 to 12 harmonics."""
    count = int(rng.choice([1, 2, 5, 12]))
    a, b = rng.normal(size=(2, count + 1)) * rng.uniform(0.3, 0.9) ** np.arange(count + 1)
    b[0] = 0.0
    return PeriodicFunction(a, b)


def test_half_traces_and_matrices_of_steps():
    rng = np.random.default_rng(31)
    traces, entries = [], []
    for _ in range(SCENES):
        count = int(rng.integers(2, 8))
        levels = rng.normal(size=count) * 10.0 ** rng.uniform(-1, 3)
        lengths = rng.uniform(0.05, 2.0, count)
        damping = float(rng.choice([0.0, rng.uniform(0.0, 3.0)]))
        found = piecewise_monodromy(levels, lengths, damping)
        assert found.passed
        matrix, half = product(levels, lengths, damping)
        traces.append(found.error / max(gap(found.half_trace, half), 1e-300))
        gaps = [[gap(found.matrix[i, j], matrix[i, j]) for j in range(2)] for i in range(2)]
        entries.append(np.ravel(found.matrix_error / np.maximum(gaps, 1e-300)))
    verdict([np.ravel(one) for one in traces], SCENES)
    verdict(entries, 4 * SCENES)


@pytest.mark.slow
def test_regions_of_two_levels():
    """Newton's steps of 50 digits on the half trace, wherever the end is a simple root."""
    rng = np.random.default_rng(32)
    ratios = []
    while len(ratios) < SCENES:
        levels = np.array([1.0, -rng.uniform(0.5, 2.0)])
        first = float(rng.uniform(0.5, 5.5))
        lengths = (first, float(2.0 * np.pi - first))
        mu = float(10.0 ** rng.uniform(-1.5, 1.5))
        found = meissner_boundaries(mu, (1, 2, 3), levels=levels, lengths=lengths)
        assert found.passed
        n = int(rng.integers(3))
        end = float(rng.choice([found.lower[n], found.upper[n]]))
        target = (-1) ** (n + 1)

        def defect(x, mu=mu, levels=levels, lengths=lengths, target=target):
            parts = [
                interval(x + MP.mpf(mu) * MP.mpf(float(v)), t)
                for v, t in zip(levels, lengths, strict=True)
            ]
            whole = parts[1] * parts[0]
            return (whole[0, 0] + whole[1, 1]) / 2 - target

        x, step = MP.mpf(end), MP.mpf("1e-12") * max(1.0, abs(end))
        slope = (defect(x + step) - defect(x - step)) / (2 * step)
        if abs(slope) < 1e-3:
            continue
        for _ in range(3):
            x -= defect(x) / slope
        ratios.append(np.array([found.error[n] / max(gap(end, x), 1e-17)]))
    verdict(ratios, SCENES)


def _characteristic(m, q, kind, near):
    """Return a_m(q) or b_m(q) by inverse iteration on the matrix of cosines or sines."""
    first = 1 if kind == "b" and m % 2 == 0 else 0
    numbers = [2 * (k + first) + m % 2 for k in range(30 + m + int(abs(q) ** 0.5))]
    below = {(0, "a"): 0, (1, "a"): q, (1, "b"): -q}.get((m % 2, kind), 0)
    diagonal = [MP.mpf(k) ** 2 for k in numbers]
    diagonal[0] += below
    beside = [MP.mpf(q)] * (len(numbers) - 1)
    if kind == "a" and m % 2 == 0:
        beside[0] *= MP.sqrt(2)
    x = MP.mpf(near) + MP.mpf("1e-9") * max(1.0, abs(near))
    vector = [MP.mpf(1)] * len(numbers)
    for _ in range(6):
        pivots, right = [diagonal[0] - x], [vector[0]]
        for k, side in enumerate(beside):
            factor = side / pivots[-1]
            pivots.append(diagonal[k + 1] - x - factor * side)
            right.append(vector[k + 1] - factor * right[-1])
        found = [right[-1] / pivots[-1]]
        for k in range(len(beside) - 1, -1, -1):
            found.append((right[k] - beside[k] * found[-1]) / pivots[k])
        found.reverse()
        top = MP.sqrt(MP.fsum(v * v for v in found))
        vector = [v / top for v in found]
    part = MP.fsum(d * v * v for d, v in zip(diagonal, vector, strict=True))
    return part + 2 * MP.fsum(
        s * v * w for s, v, w in zip(beside, vector[:-1], vector[1:], strict=True)
    )


@pytest.mark.slow
def test_mathieu_characteristic_values():
    rng = np.random.default_rng(33)
    ratios = []
    for _ in range(SCENES):
        kind = str(rng.choice(["a", "b"]))
        m = int(rng.integers(kind == "b", 12))
        q = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-2, 2))
        found = mathieu_characteristic(m, q, kind)
        truth = _characteristic(m, q, kind, float(found.value))
        ratios.append(np.ravel(found.error / max(gap(found.value, truth), 1e-17)))
    verdict(ratios, SCENES)


@extended
def test_steps_in_the_place_of_a_function():
    """The figure of the approximation is its distance from the smooth equation."""
    rng = np.random.default_rng(34)
    ratios = []
    for _ in range(50):
        f = waves(rng)
        lam2, mu = rng.uniform(-1.0, 20.0, 4), rng.uniform(-3.0, 3.0, 4)
        rule = str(rng.choice(["midpoint", "mean"]))
        found = piecewise_approximation(f, lam2, mu, int(rng.integers(8, 200)), rule)
        gaps = np.abs(found.half_trace - half_traces(f, lam2, mu)).astype(float)
        ratios.append(found.error / np.maximum(gaps, 1e-18))
    verdict(ratios, SCENES)


@extended
def test_surfaces_of_multipliers():
    """Roots of rho^2 - 2 J rho + exp(-2 pi K), from half traces of more digits."""
    rng = np.random.default_rng(35)
    first, second = [], []
    for _ in range(50):
        f, k = waves(rng), float(rng.choice([0.0, rng.uniform(0.0, 0.5)]))
        d, eps = rng.uniform(-2.0, 40.0, 2), rng.uniform(-5.0, 5.0, 2)
        found = multiplier_surfaces(d, eps, k, f)
        half = half_traces(f, *np.meshgrid(d / 4, eps / 4, indexing="ij"), k / 2)
        volume = np.exp(-8 * np.arctan(EXTENDED(1)) * EXTENDED(k))
        root = np.sqrt((half * half - volume).astype(np.clongdouble))
        pair = np.stack([half + root, half - root])
        for ours, figure, out in (
            (found.first, found.error, first),
            (found.second, found.second_error, second),
        ):
            gaps = np.min(np.abs(ours - pair), axis=0).astype(float)
            out.append(np.ravel(figure / np.maximum(gaps, 1e-18)))
    verdict(first, SCENES)
    verdict(second, SCENES)


@extended
@pytest.mark.slow
def test_half_traces_of_a_strutt_chart():
    rng = np.random.default_rng(36)
    ratios = []
    for _ in range(10):
        k, f = float(rng.choice([0.0, rng.uniform(0.0, 0.5)])), waves(rng)
        found = strutt_chart(k, (-1.0, float(rng.uniform(3.0, 20.0))), (0.0, 5.0), (9, 7), f)
        d, eps = np.meshgrid(found.d / 4, found.eps / 4, indexing="ij")
        truth = half_traces(f, d, eps, k / 2)
        ours, figure = found.half_trace, np.broadcast_to(found.error, found.half_trace.shape)
        if ours.shape != truth.shape:
            truth = truth.T
        gaps = np.abs(ours - truth).astype(float)
        ratios.append(np.ravel(figure / np.maximum(gaps, 1e-18)))
    verdict(ratios, SCENES)
