"""What a user would take instead of this package: SciPy, heyoka, a loop compiled by numba.

All solve ``y' = L(theta) y``, and get L as a Fourier series that is made beforehand.  A peer takes
the equation and a setting, a tolerance or a number of steps a revolution, and returns a function
from a start ``(m, columns)`` and rising angles to the states ``(angles, m, columns)``; what is
compiled, is compiled then.  What is not installed is left out.
"""

import os
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from elastolink.runtime.periodic.equation import equation_of
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1] / "convergence"))
from taylor_truth import Equation
from taylor_truth import flows as flows

Solve = Callable[[Any, Any], Any]

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14)
# Entries of the series beyond which heyoka's compilation takes minutes.
_MOST_TERMS = 20_000


def one_thread() -> None:
    """Start the script anew with one thread for BLAS, which reads the number when it is loaded."""
    one = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    if not one.items() <= os.environ.items():
        os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, **one})


def equation(system: Any, speed: float, *, forced: bool) -> Equation:
    """Return the equation of a system in the scaled state of the solvers."""
    exact = Equation.of(system, speed, forced=forced, samples=512, cut=1e-14)
    unit = equation_of(system, speed, forcing=forced).scale[0]
    scale = np.concatenate([unit, 1.0 / unit, np.ones(int(forced))])
    turn = (scale / exact.scale) / (scale / exact.scale)[:, None]
    return replace(exact, a=exact.a * turn, b=exact.b * turn, scale=scale)


def shortened(whole: Equation) -> Equation:
    """Return an equation without what is below 1e-14 of the largest entry, for the peers."""
    least = 1e-14 * max(np.max(np.abs(whole.a)), np.max(np.abs(whole.b)))
    a, b = (np.where(np.abs(v) > least, v, 0.0) for v in (whole.a, whole.b))
    count = int(np.flatnonzero(np.any((a != 0.0) | (b != 0.0), axis=(1, 2)))[-1]) + 1
    return replace(whole, a=a[:count], b=b[:count])


def by_scipy(equation: Equation, tolerance: float) -> Solve:
    """Return ``solve_ivp`` by DOP853; LSODA, Radau and CVODE take longer on these systems."""

    def solve(start: Any, angles: Any) -> Any:
        done = solve_ivp(
            lambda theta, flat: (equation.at(theta) @ flat.reshape(start.shape)).ravel(),
            (angles[0], angles[-1]),
            start.ravel(),
            method="DOP853",
            t_eval=angles,
            rtol=max(tolerance, 3e-14),
            atol=0.01 * tolerance,
        )
        return done.y.T.reshape(-1, *start.shape)

    return solve


def by_heyoka(equation: Equation, tolerance: float) -> Solve:
    """Return heyoka's Taylor method: one column, or a batch with a column in each lane."""
    import heyoka as hy

    m, lanes = equation.states, int(hy.recommended_simd_size())
    names = hy.make_vars(*(f"y{i}" for i in range(m)))
    angle = 2.0 * np.pi / equation.period * hy.time
    waves = [(hy.cos(k * angle), hy.sin(k * angle)) for k in range(len(equation.a))]

    def series(i: int, j: int) -> list[Any]:
        a, b = equation.a[:, i, j].tolist(), equation.b[:, i, j].tolist()
        terms = [hy.expression(a[0])] if a[0] else []
        for k in range(1, len(a)):
            terms += [a[k] * waves[k][0]] if a[k] else []
            terms += [b[k] * waves[k][1]] if b[k] else []
        return terms

    system = []
    for i in range(m):
        entries = [(series(i, j), names[j]) for j in range(m)]
        products = [hy.sum(terms) * name for terms, name in entries if terms]
        system.append((names[i], hy.sum(products) if products else hy.expression(0.0)))
    options = {"tol": tolerance, "fast_math": True, "compact_mode": m > 6}
    single = cache(lambda: hy.taylor_adaptive(system, [0.0] * m, **options))
    batch = cache(lambda: hy.taylor_adaptive_batch(system, np.zeros((m, lanes)), **options))

    def solve(start: Any, angles: Any) -> Any:
        if start.shape[1] == 1:
            stepper = single()
            stepper.time = angles[0]
            stepper.state[:] = start[:, 0]
            return stepper.propagate_grid(angles)[-1][:, :, None]
        stepper, out = batch(), np.empty((len(angles), *start.shape))
        for first in range(0, start.shape[1], lanes):
            part = start[:, first : first + lanes]
            count = part.shape[1]
            stepper.set_time(float(angles[0]))
            stepper.state[:] = start[:, :1]
            stepper.state[:, :count] = part
            if len(angles) == 2:
                stepper.propagate_until(float(angles[1]))
                values = np.stack([part, stepper.state[:, :count]])
            else:
                values = stepper.propagate_grid(np.repeat(angles[:, None], lanes, axis=1))[-1]
            out[:, :, first : first + lanes] = values[..., :count]
        return out

    return solve


def by_loop(equation: Equation, steps: float) -> Solve:
    """Return a loop by hand, compiled by numba: fixed steps of Dormand & Prince's order 8."""
    run = compiled_loop()
    rows, columns = np.nonzero(np.any((equation.a != 0.0) | (equation.b != 0.0), axis=0))
    a, b = (np.ascontiguousarray(v[:, rows, columns].T) for v in (equation.a, equation.b))
    wave = 2.0 * np.pi / equation.period

    def solve(start: Any, angles: Any) -> Any:
        inner = max(1, round(steps * (angles[1] - angles[0]) / (2.0 * np.pi)))
        return run(rows, columns, a, b, wave, np.ascontiguousarray(start), angles, inner)

    return solve


@cache
def compiled_loop() -> Callable[..., Any]:
    """Return the loop of :func:`by_loop`; L is the entries at rows and columns, each a series."""
    import numba
    from scipy.integrate._ivp import dop853_coefficients as published

    stages = 12
    stage = np.ascontiguousarray(published.A[:stages, :stages])
    weight = np.ascontiguousarray(published.B[:stages])
    node = np.ascontiguousarray(published.C[:stages])

    @numba.njit(fastmath=True)
    def entries(values, a, b, angle):
        cos, sin = np.cos(angle), np.sin(angle)
        values[:] = a[:, 0]
        c, s = 1.0, 0.0
        for k in range(1, a.shape[1]):
            c, s = c * cos - s * sin, s * cos + c * sin
            for e in range(len(values)):
                values[e] += a[e, k] * c + b[e, k] * s

    @numba.njit(fastmath=True)
    def loop(rows, columns, a, b, wave, start, angles, inner):
        m, count = start.shape
        out = np.empty((len(angles), m, count))
        out[0] = start
        state, trial = start.copy(), np.empty_like(start)
        slopes, values = np.zeros((stages, m, count)), np.empty(len(rows))
        for k in range(1, len(angles)):
            h = (angles[k] - angles[k - 1]) / inner
            for step in range(inner):
                theta = angles[k - 1] + step * h
                for s in range(stages):
                    for i in range(m):
                        for c in range(count):
                            total = 0.0
                            for earlier in range(s):
                                total += stage[s, earlier] * slopes[earlier, i, c]
                            trial[i, c] = state[i, c] + h * total
                            slopes[s, i, c] = 0.0
                    entries(values, a, b, wave * (theta + node[s] * h))
                    for e in range(len(rows)):
                        for c in range(count):
                            slopes[s, rows[e], c] += values[e] * trial[columns[e], c]
                for i in range(m):
                    for c in range(count):
                        for s in range(stages):
                            state[i, c] += h * weight[s] * slopes[s, i, c]
            out[k] = state
        return out

    return loop


def peers_of(
    equation: Equation,
) -> dict[str, tuple[Callable[[Equation, float], Solve], tuple[float, ...]]]:
    """Return the peers that suit an equation and are installed, with settings, loose to tight."""
    out = {"SciPy DOP853": (by_scipy, TOLERANCES)}
    terms = np.count_nonzero(equation.a) + np.count_nonzero(equation.b)
    if find_spec("heyoka") and terms <= _MOST_TERMS:
        out["heyoka"] = by_heyoka, TOLERANCES
    if find_spec("numba"):
        turn = 2.0 * np.pi * max(equation.rate, 1.0)
        out["numba loop"] = by_loop, tuple(float(round(turn * 2**k)) for k in range(1, 7))
    return out
