"""The balance of harmonics as a real matrix."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from ..simulation.second_order import Series

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def real_matrix(series: Series, harmonics: int, nu: float, scale: Array, first: int = 0) -> Array:
    """Return the balance in real and imaginary parts of the harmonics, ``(N, N)``.

    Unknowns and equations: real parts of harmonics 0 to H, then imaginary parts of 1 to H, each
    with the n coordinates; N = (2 H + 1) n.  Of harmonics first to H all imaginary parts too.
    """
    n, size = len(scale), harmonics + 1 - first
    weights = scale[:, None] * scale
    kappa = (nu * np.arange(first, harmonics + 1))[None, None, :, None]
    straight = [
        _window(part * weights, size, -1, 0)
        for part in (series.stiffness, series.rate, series.mass)
    ]
    crossed = [
        _window(part * weights, size, 1, 2 * first)
        for part in (series.stiffness, series.rate, series.mass)
    ]
    # The mean is real and has no partner.
    alone = 1 if first == 0 else 0
    out = np.empty(((2 * size - alone) * n,) * 2)
    middle, rest = size * n, (size - alone) * n
    blocks = {}
    # E(k, l) = H + i kappa G - kappa^2 M at k - l; at -l the sign of kappa turns.
    for name, (h, g, m), sign in (("+", straight, 1.0), ("-", crossed, -1.0)):
        real = h.real - (sign * kappa) * g.imag - kappa**2 * m.real
        imaginary = h.imag + (sign * kappa) * g.real - kappa**2 * m.imag
        blocks[name] = (real, imaginary)
    (pr, pi), (mr, mi) = blocks["+"], blocks["-"]
    rr, ir = pr + mr, pi + mi
    if alone:
        rr[:, :, 0], ir[:, :, 0] = pr[:, :, 0], pi[:, :, 0]
    out[:middle, :middle] = rr.reshape(middle, middle)
    out[middle:, :middle] = ir[alone:].reshape(rest, middle)
    out[:middle, middle:] = (mi - pi)[:, :, alone:].reshape(middle, rest)
    out[middle:, middle:] = (pr - mr)[alone:, :, alone:].reshape(rest, rest)
    return out


def _window(part: ComplexArray, size: int, direction: int, offset: int) -> ComplexArray:
    """Return the view ``(k, i, l, j)`` of the coefficient at k - l (direction -1) or k + l.

    With an offset the coefficient that lies as many harmonics higher.
    """
    n = part.shape[1]
    middle = 2 * size + offset
    padded = np.zeros((2 * middle + 1, n, n), dtype=complex)
    kept = min(len(part), middle + 1)
    padded[middle : middle + kept] = part[:kept]
    padded[middle - kept + 1 : middle + 1] = part[:kept][::-1].conj()
    # The mean itself, not its conjugate.
    padded[middle] = part[0]
    start = padded[middle + offset :]
    a, b, c = padded.strides
    return as_strided(start, (size, n, size, n), (a, b, direction * a, c), writeable=False)
