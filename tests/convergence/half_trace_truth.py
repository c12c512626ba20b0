"""Half traces of Hill's equation to more digits than doubles hold: :mod:`taylor_truth`."""

import numpy as np
from elastolink.runtime.core.periodic_function import PeriodicFunction
from numpy.typing import ArrayLike
from taylor_truth import Equation, Reals, flows


def half_traces(f: PeriodicFunction, lam2: ArrayLike, mu: ArrayLike, damping: float = 0.0) -> Reals:
    """Return half traces of y'' + 2 K y' + (lam2 + mu f) y = 0 in extended precision.

    lam2 and mu broadcast together.  On machines whose long double has 64 bits of fraction good to
    about 1e-17 times the growth of the solutions; elsewhere no better than doubles.
    """
    x, y = np.broadcast_arrays(np.asarray(lam2, dtype=float), np.asarray(mu, dtype=float))
    real, loss = np.longdouble, np.longdouble(damping)
    # Of exp(K theta) y and its derivative, this over a rate.
    lam, amp = x.ravel().astype(real) - loss**2, y.ravel().astype(real)
    rate = np.sqrt(np.max(np.abs(lam)) + np.max(np.abs(amp)) * f.amplitudes.sum() + real(0.1))
    a, b = (
        np.zeros((f.harmonics + 1, lam.size, 2, 2), dtype=real)
        - np.multiply.outer(np.multiply.outer(part, amp), [[0, 0], [1 / rate, 0]])
        for part in (f.a, f.b)
    )
    a[0, :, 0, 1] += rate
    a[0, :, 1, 0] -= lam / rate
    none = np.zeros((1, 1))
    equation = Equation(a, b, 2.0 * np.pi, 1, none, none, np.ones(2))
    # Small steps: next to few harmonics a series in time grows as an exponential of one.
    whole = flows(equation, 1.0, int(max(32, 4 * f.harmonics, 8 * rate)))[-1]
    turn = 8 * np.arctan(real(1))
    trace: Reals = np.trace(whole, axis1=-2, axis2=-1) / 2 * np.exp(-turn * loss)
    return trace.reshape(x.shape)
