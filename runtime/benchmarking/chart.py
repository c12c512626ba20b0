"""Benchmark of a stability chart: a grid of half traces of Hill's equation."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import chebyshev
from ..core.errors import bad
from ..core.periodic_function import PeriodicFunction
from ..core.results import Check
from ..hill import discriminant
from .records import Benchmark, Contender, Row, compare, functions, missing, one_thread
from .reference import half_traces

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LAM2, _MU = 30.0, 2.0
_TOLERANCE = 1e-12
_WANTED = 1e-10
_OURS = "elastolink"
_HEYOKA = "heyoka, batch loop over every point"
_HEYOKA_NODES = "heyoka at Chebyshev nodes, same interpolation"
_SCIPY = "solve_ivp (DOP853, rtol 1e-12)"


def benchmark_chart(
    points: int = 1000, rounds: int = 7, sample: int = 400, problems: tuple[str, ...] | None = None
) -> Benchmark:
    """Time a chart of ``points x points`` half traces, lam2 to 30 and mu to 2, beside its peers.

    Parameters
    ----------
    points : int
        Points along each axis.
    rounds : int
        How often each contender runs, in turn.
    sample : int
        Points at which peers without interpolation are run (solve_ivp: a hundredth of them).
    problems : tuple of str, optional
        Some of ``"24 harmonics"``, ``"f3 (5,1,5,2)"``, ``"f3 (10,1,10,4)"``, ``"f3 (2,1,2,2)"``;
        all by default.

    Returns
    -------
    Benchmark
        ``error`` is the largest deviation of our half traces from the reference, at the sample
        and at the corners; peers that are not installed are named and left out.

    Raises
    ------
    BadInput
        If a number is too small or a problem is unknown.

    Notes
    -----
    heyoka integrates batches of its recommended size, with a Clenshaw sum for f, fast_math and
    tolerance 1e-12; its compilation is excluded.  It, and solve_ivp, are given f without the
    harmonics below 1e-12.  The reference is a Taylor series in extended precision.
    """
    if points < 2 or rounds < 1 or sample < 16:
        raise bad(
            "benchmark_chart",
            f"points={points}, rounds={rounds}, sample={sample}",
            "points >= 2, rounds >= 1, sample >= 16",
            "take larger numbers",
        )
    known = functions()
    unknown = sorted(set(problems or ()) - set(known))
    if unknown:
        raise bad("benchmark_chart", unknown, f"some of {sorted(known)}", "correct the name")
    return one_thread(_measure, points, rounds, sample, problems or tuple(known))


def _measure(points: int, rounds: int, sample: int, problems: tuple[str, ...]) -> Benchmark:
    known = functions()
    rows: list[Row] = []
    worst = covered = 0.0
    for name in problems:
        chart = _Chart(known[name], points, sample)
        found = chart.ours()
        deviation = np.abs(found.value[chart.i, chart.j] - chart.truth).astype(float)
        worst = max(worst, float(deviation.max()))
        covered = max(covered, float(found.error.max()))
        contenders = [
            Contender(
                _OURS, chart.ours, chart.grid_error, note=f"figure {float(found.error.max()):.1e}"
            )
        ]
        left_out = []
        peer = batched_heyoka(known[name])
        if peer is None:
            left_out = [missing(name, n, "not installed") for n in (_HEYOKA, _HEYOKA_NODES)]
        else:
            contenders += chart.heyoka(peer, known[name])
        contenders.append(chart.scipy(known[name]))
        rows += compare(name, contenders, rounds) + left_out
    return Benchmark(
        method="interleaved timing",
        error=worst,
        error_norm="half traces, absolute, against extended precision",
        checks={
            "error of the half traces": Check(worst, _WANTED),
            "largest error figure": Check(covered, _WANTED),
        },
        title=f"Chart of {points} x {points} half traces, lam2 <= {_LAM2:g}, mu <= {_MU:g}",
        rows=tuple(rows),
    )


class _Chart:
    """One chart with the points at which contenders are compared."""

    def __init__(self, f: PeriodicFunction, points: int, sample: int) -> None:
        self.f = f
        self.lam2, self.mu = np.linspace(0.0, _LAM2, points), np.linspace(0.0, _MU, points)
        rng = np.random.default_rng(7)
        corners = np.array([[0, 0, -1, -1], [0, -1, 0, -1]]) % points
        drawn = rng.integers(0, points, (2, sample - 4))
        self.i, self.j = np.concatenate([corners, drawn], axis=1)
        self.truth = half_traces(f, self.lam2[self.i], self.mu[self.j])

    def ours(self) -> Any:
        return discriminant(self.f, self.lam2[:, None], self.mu)

    def grid_error(self, found: Any) -> float:
        grid = getattr(found, "value", found)
        return float(np.abs(grid[self.i, self.j] - self.truth).max())

    def point_error(self, values: Array) -> float:
        return float(np.abs(values - self.truth[: len(values)]).max())

    def heyoka(self, peer: Callable[[Array, Array], Array], f: PeriodicFunction) -> list[Contender]:
        """Return the loop over every point (a sample of it) and the interpolated one."""
        x, y = self.lam2[self.i], self.mu[self.j]
        n, m = _node_counts(f)

        def interpolated() -> Array:
            u, v = chebyshev.nodes(n), chebyshev.nodes(m)
            lam2, mu = 0.5 * _LAM2 * (1.0 + u), 0.5 * _MU * (1.0 + v)
            values = peer(np.repeat(lam2, m), np.tile(mu, n)).reshape(n, m)
            return chebyshev.tensor_values(
                chebyshev.coefficients2(values),
                self.lam2 * (2.0 / _LAM2) - 1.0,
                self.mu * (2.0 / _MU) - 1.0,
            )

        whole = self.lam2.size * self.mu.size
        setting = f"tol {_TOLERANCE:g}"
        return [
            Contender(_HEYOKA, lambda: peer(x, y), self.point_error, x.size / whole, setting),
            Contender(
                _HEYOKA_NODES, interpolated, self.grid_error, note=f"{setting}, {n} x {m} nodes"
            ),
        ]

    def scipy(self, f: PeriodicFunction) -> Contender:
        """Return solve_ivp on a small sample."""
        count = max(4, len(self.i) // 100)
        x, y = self.lam2[self.i[:count]], self.mu[self.j[:count]]
        short = f.truncated(_TOLERANCE)

        def run() -> Array:
            return np.array([one_half_trace(short, p, q) for p, q in zip(x, y, strict=True)])

        share = count / (self.lam2.size * self.mu.size)
        return Contender(_SCIPY, run, self.point_error, share)


def _node_counts(f: PeriodicFunction) -> tuple[int, int]:
    """Return how many Chebyshev nodes each direction needs, for the peer's benefit.

    Found once and not timed: the peer is spared the search that our own figure includes.
    """
    n, m = 64, 40
    u, v = chebyshev.nodes(n), chebyshev.nodes(m)
    grid = discriminant(f, 0.5 * _LAM2 * (1.0 + u[:, None]), 0.5 * _MU * (1.0 + v)).value
    size = np.abs(chebyshev.coefficients2(grid))
    floor = _TOLERANCE * max(1.0, float(size.max()))
    return (
        chebyshev.length(size.max(axis=1), floor),
        chebyshev.length(size.max(axis=0), floor),
    )


def one_half_trace(f: PeriodicFunction, lam2: float, mu: float) -> float:
    """Return one half trace by SciPy's solve_ivp."""
    from scipy.integrate import solve_ivp

    c, m = f.a - 1j * f.b, 1j * np.arange(len(f.a))

    def slope(theta: float, state: Array) -> list[float]:
        q = -(lam2 + mu * (c @ np.exp(m * theta)).real)
        return [state[1], q * state[0], state[3], q * state[2]]

    end = solve_ivp(
        slope, (0.0, 2.0 * pi), [1.0, 0.0, 0.0, 1.0], method="DOP853", rtol=1e-12, atol=1e-14
    )
    return float(0.5 * (end.y[0, -1] + end.y[3, -1]))


def batched_heyoka(f: PeriodicFunction, size: int = 0) -> Callable[[Array, Array], Array] | None:
    """Return heyoka's batch loop over points, compiled, or None where it is not installed.

    ``size`` is that of a batch, by default the one heyoka recommends.
    """
    try:
        import heyoka as hy
    except ImportError:
        return None
    short = f.truncated(_TOLERANCE)
    y1, v1, y2, v2 = hy.make_vars("y1", "v1", "y2", "v2")
    cos, sin = hy.cos(hy.time), hy.sin(hy.time)
    u1 = u2 = w1 = w2 = hy.expression(0.0)
    for am, bm in zip(short.a[:0:-1].tolist(), short.b[:0:-1].tolist(), strict=True):
        u1, u2 = 2.0 * cos * u1 - u2 + am, u1
        w1, w2 = 2.0 * cos * w1 - w2 + bm, w1
    q = -(hy.par[0] + hy.par[1] * (float(short.a[0]) + cos * u1 - u2 + sin * w1))
    batch = size or int(hy.recommended_simd_size())
    start = np.repeat(np.array([[1.0], [0.0], [0.0], [1.0]]), batch, axis=1)
    stepper = hy.taylor_adaptive_batch(
        [(y1, v1), (v1, q * y1), (y2, v2), (v2, q * y2)],
        start.copy(),
        tol=_TOLERANCE,
        pars=np.zeros((2, batch)),
        fast_math=True,
    )

    def run(lam2: Array, mu: Array) -> Array:
        out = np.empty(lam2.size)
        for first in range(0, lam2.size, batch):
            part = slice(first, first + batch)
            count = lam2[part].size
            stepper.set_time(0.0)
            stepper.state[:] = start
            stepper.pars[0, :count], stepper.pars[1, :count] = lam2[part], mu[part]
            stepper.propagate_until(2.0 * pi)
            out[part] = 0.5 * (stepper.state[0, :count] + stepper.state[3, :count])
        return out

    return run
