"""What a user would take instead of this package: SciPy, SUNDIALS, heyoka, a loop by numba.

All solve ``y' = L(theta) y``, and get L as a Fourier series that is made beforehand.  What is not
installed is left out.  A peer takes the equation and a setting, a tolerance or a number of steps a
revolution, and returns a function from a start ``(m, columns)`` and rising angles to the states
``(angles, m, columns)``; what is compiled, is compiled then.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from elastolink.runtime.periodic.equation import equation_of
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[1] / "convergence"))
from taylor_truth import Equation

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14)
# Seconds after which a run is broken off.
PATIENCE = 20.0
# Largest rate of the state [1/rad] from which an equation counts as stiff.
STIFF = 100.0
# Entries of the series beyond which heyoka's compilation takes minutes.
_MOST_TERMS = 20_000
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


class TooLongError(Exception):
    """A run took longer than ``PATIENCE``."""


def one_thread() -> None:
    """Start the script anew with one thread for BLAS, which reads the number when it is loaded."""
    if any(os.environ.get(name) != "1" for name in _THREADS):
        environment = {**os.environ, **dict.fromkeys(_THREADS, "1")}
        os.execve(sys.executable, [sys.executable, *sys.argv], environment)


def patient(rate: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that raises TooLongError once ``PATIENCE`` has passed."""
    end = time.process_time() + PATIENCE

    def limited(*arguments: Any) -> Any:
        if time.process_time() > end:
            raise TooLongError
        return rate(*arguments)

    return limited


def equation(system: Any, speed: float, *, forced: bool) -> Equation:
    """Return the equation of a system in the scaled state of the solvers."""
    samples = 512
    exact = Equation.of(system, speed, forced=forced, samples=samples, cut=1e-14)
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


def by_scipy(method: str, equation: Equation, tolerance: float) -> Callable[..., Any]:
    """Return ``solve_ivp`` with a method."""

    def solve(start: Any, angles: Any) -> Any:
        shape = start.shape
        rate = patient(lambda theta, flat: (equation.at(theta) @ flat.reshape(shape)).ravel())
        jacobian = {}
        if shape[1] == 1 and method in ("Radau", "LSODA"):
            jacobian["jac"] = lambda theta, _: equation.at(theta)
        done = solve_ivp(
            rate,
            (angles[0], angles[-1]),
            start.ravel(),
            method=method,
            t_eval=angles,
            rtol=max(tolerance, 3e-14),
            atol=0.01 * tolerance,
            **jacobian,
        )
        return done.y.T.reshape(-1, *shape)

    return solve


def by_cvode(equation: Equation, tolerance: float) -> Callable[..., Any]:
    """Return CVODE of scikit-sundae: Adams, BDF where the system is stiff."""

    def solve(start: Any, angles: Any) -> Any:
        shape = start.shape
        method = "BDF" if equation.rate > STIFF else "Adams"
        rate = patient(lambda theta, flat: (equation.at(theta) @ flat.reshape(shape)).ravel())
        return cvode(rate, start.ravel(), angles, method, tolerance, 0.01 * tolerance).reshape(
            -1, *shape
        )

    return solve


def cvode(
    rate: Callable[..., Any], start: Any, places: Any, method: str, rtol: float, atol: Any
) -> Any:
    """Return the states at places, ``(places, m)``."""
    from sksundae.cvode import CVODE

    def into(place: float, state: Any, out: Any) -> None:
        out[:] = rate(place, state)

    solver = CVODE(into, method=method, rtol=max(rtol, 1e-15), atol=atol, max_num_steps=10**7)
    return np.asarray(solver.solve(places, start).y)


def by_heyoka(equation: Equation, tolerance: float) -> Callable[..., Any]:
    """Return heyoka's Taylor method: a batch with a column in each lane, or one column."""
    import heyoka as hy

    m, lanes = equation.states, int(hy.recommended_simd_size())
    names = hy.make_vars(*(f"y{i}" for i in range(m)))
    angle = 2.0 * np.pi / equation.period * hy.time
    waves = [(hy.cos(k * angle), hy.sin(k * angle)) for k in range(len(equation.a))]
    system = []
    for i in range(m):
        products = []
        for j in range(m):
            a, b = equation.a[:, i, j], equation.b[:, i, j]
            terms = [hy.expression(float(a[0]))] if a[0] else []
            terms += [float(a[k]) * waves[k][0] for k in range(1, len(a)) if a[k]]
            terms += [float(b[k]) * waves[k][1] for k in range(1, len(b)) if b[k]]
            if terms:
                products.append(hy.sum(terms) * names[j])
        system.append((names[i], hy.sum(products) if products else hy.expression(0.0)))
    options = {"tol": tolerance, "fast_math": True, "compact_mode": m > 6}

    @cache
    def single() -> Any:
        return hy.taylor_adaptive(system, [0.0] * m, **options)

    @cache
    def batch() -> Any:
        return hy.taylor_adaptive_batch(system, np.zeros((m, lanes)), **options)

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


def by_loop(equation: Equation, steps: float) -> Callable[..., Any]:
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
                        total = 0.0
                        for s in range(stages):
                            total += weight[s] * slopes[s, i, c]
                        state[i, c] += h * total
            out[k] = state
        return out

    return loop


def peers_of(equation: Equation) -> dict[str, tuple[Callable[..., Any], tuple[float, ...]]]:
    """Return the peers that suit an equation and are installed, with settings, loose to tight."""
    terms = np.count_nonzero(equation.a) + np.count_nonzero(equation.b)
    steps = [round(2.0 * np.pi * max(equation.rate, 1.0) * s) for s in (2, 4, 8, 16, 32, 64)]
    out: dict[str, tuple[Callable[..., Any], tuple[float, ...]]] = {
        f"SciPy {name}": (partial(by_scipy, name), TOLERANCES)
        for name in ("DOP853", "LSODA", *(["Radau"] if equation.rate > STIFF else []))
    }
    if find_spec("sksundae"):
        out["CVODE"] = by_cvode, TOLERANCES
    if find_spec("heyoka") and terms <= _MOST_TERMS:
        out["heyoka"] = by_heyoka, TOLERANCES
    if find_spec("numba"):
        out["numba loop"] = by_loop, tuple(float(s) for s in steps)
    return out
