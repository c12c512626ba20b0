"""Functions of Hill's equation that tests and benchmarks share, and heyoka's half trace of them."""

from __future__ import annotations

import elastolink as el
import numpy as np


def functions():
    """A general function of 24 harmonics, and f3 = -alpha4/sin(theta3 - theta4), Smith (6.16)."""
    rng = np.random.default_rng(1972)
    fall = 0.7 ** np.arange(25)
    a, b = rng.uniform(-1.0, 1.0, 25) * fall, rng.uniform(-1.0, 1.0, 25) * fall
    b[0] = 0.0
    out = {"24 harmonics": el.PeriodicFunction(a, b)}
    for lengths in ((5, 1, 5, 2), (10, 1, 10, 4), (2, 1, 2, 2)):
        name = f"f3 ({','.join(map(str, lengths))})"
        motion = el.FourBar(*map(float, lengths)).motion
        out[name] = el.PeriodicFunction.from_callable(_end_load(motion), name=name)
    return out


def _end_load(motion):
    def f3(theta):
        at = motion(theta)
        return -at.alpha4 / np.sin(at.theta3 - at.theta4)

    return f3


def batched_heyoka(f, size=0, tolerance=1e-12):
    """Heyoka's batch loop over points (lam2, mu), compiled; None where it is not installed."""
    try:
        import heyoka as hy
    except ImportError:
        return None
    short = f.truncated(tolerance)
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
        tol=tolerance,
        pars=np.zeros((2, batch)),
        fast_math=True,
    )

    def run(lam2, mu):
        out = np.empty(lam2.size)
        for first in range(0, lam2.size, batch):
            part = slice(first, first + batch)
            count = lam2[part].size
            stepper.set_time(0.0)
            stepper.state[:] = start
            stepper.pars[0, :count], stepper.pars[1, :count] = lam2[part], mu[part]
            stepper.propagate_until(2.0 * np.pi)
            out[part] = 0.5 * (stepper.state[0, :count] + stepper.state[3, :count])
        return out

    return run
