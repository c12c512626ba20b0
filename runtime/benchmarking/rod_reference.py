"""Monodromy matrices of the rod to more digits than doubles hold, and by SciPy.

Shares with the charts only the generator, as a Fourier series.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..floquet.first_order import canonical_form, even_angles

Array = NDArray[np.float64]
Reals = NDArray[np.longdouble]

_SAMPLES = 256
_CUT = 1e-13
_TURN = np.longdouble("6.283185307179586476925286766559005768394")
_ORDER = 30


@dataclass(frozen=True)
class Entries:
    """The generator ``L = L0 + L1 / w^2`` of y' = L y in scaled variables, as Fourier series.

    Attributes
    ----------
    a, b : ndarray, shape (2, harmonics + 1, m, m)
        Cosine and sine coefficients of L0 and L1 times a power of two that keeps them alike.
    """

    a: Array
    b: Array

    @property
    def size(self) -> int:
        """Number m of components of the state."""
        return int(self.a.shape[-1])

    @classmethod
    def of(cls, system: LinearPeriodic) -> Entries:
        """Return the entries of an undamped system, less what is below 1e-13 of the largest."""
        speeds = np.array([1e3, 2e3])
        form = canonical_form(system, speeds)
        theta = even_angles(system.period, _SAMPLES)
        values = form.plain_generator(theta)
        size = form.scale[0]
        values = values / size[:, None] * size
        inverse = speeds**-2.0
        slope = (values[0] - values[1]) / (inverse[0] - inverse[1])
        parts = np.stack([values[1] - slope * inverse[1], slope])
        table = np.fft.rfft(parts, axis=1) / _SAMPLES
        table[:, 1:] *= 2.0
        sizes = np.max(np.abs(table), axis=(2, 3))
        kept = np.flatnonzero(np.any(sizes > _CUT * np.max(sizes, axis=1, keepdims=True), axis=0))
        table = table[:, : int(kept[-1]) + 1]
        least = _CUT * sizes.max(axis=1)[:, None, None, None]
        a, b = (np.where(np.abs(v) > least, v, 0.0) for v in (table.real, -table.imag))
        return cls(a, b)

    def series(self, part: int, row: int, column: int) -> tuple[Array, Array]:
        """Return the coefficients of one entry, without the zeros at the end."""
        a, b = self.a[part, :, row, column], self.b[part, :, row, column]
        used = np.flatnonzero((a != 0.0) | (b != 0.0))
        count = int(used[-1]) + 1 if len(used) else 1
        return a[:count], b[:count]

    def at(self, theta: float, inverse: float) -> Array:
        """Return L at an angle and 1/w^2."""
        k = np.arange(self.a.shape[1])
        cos, sin = np.cos(k * theta), np.sin(k * theta)
        both = np.tensordot(cos, self.a, (0, 1)) + np.tensordot(sin, self.b, (0, 1))
        value: Array = both[0] + inverse * both[1]
        return value


def monodromy_in_long_doubles(entries: Entries, speeds: Array) -> Reals:
    """Return the matrices over a turn at speeds, ``(n, m, m)``, by Taylor series.

    On machines whose long double has 64 bits of fraction they are good to about 1e-17 times the
    length of the way that the state goes.
    """
    inverse = speeds.astype(np.longdouble) ** -2
    top = float(np.max(np.abs(entries.at(0.0, float(np.max(inverse))))))
    steps = int(max(64, 2 * top, 3 * entries.a.shape[1]))
    h = _TURN / steps
    k = np.arange(entries.a.shape[1]).astype(np.longdouble)
    powers = np.arange(_ORDER)
    factorials = np.cumprod(np.maximum(powers, 1).astype(np.longdouble))
    falling = (k[:, None] * h) ** powers / factorials
    m = entries.size
    a, b = (v.astype(np.longdouble).reshape(2, len(k), -1) for v in (entries.a, entries.b))
    state = np.broadcast_to(np.eye(m, dtype=np.longdouble), (len(speeds), m, m))
    for step in range(steps):
        cos, sin = np.cos(k * (h * step)), np.sin(k * (h * step))
        turned = ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))
        series = np.empty((_ORDER, 2, m, m), dtype=np.longdouble)
        for part in (0, 1):
            for i, (c, s) in enumerate(turned):
                mixed = a[part] * c[:, None] + b[part] * s[:, None]
                series[i::4, part] = (falling.T @ mixed).reshape(-1, m, m)[i::4]
        full = h * (series[:, 0, None] + inverse[:, None, None] * series[:, 1, None])
        state = _advance(full, state)
    return np.asarray(state)


def invariants_in_long_doubles(matrices: Reals) -> Reals:
    """Return ``c_1 ... c_n`` of ``rho^2n + c_1 rho^(2n-1) + ...`` by Newton's sums of powers."""
    n = matrices.shape[-1] // 2
    power, traces = matrices, []
    found: list[Reals] = []
    for k in range(1, n + 1):
        traces.append(np.trace(power, axis1=-2, axis2=-1))
        mixed = sum((found[j] * traces[k - 2 - j] for j in range(k - 1)), start=np.longdouble(0))
        found.append(-(traces[-1] + mixed) / k)
        power = power @ matrices
    return np.stack(found, axis=-1)


def _advance(coefficients: Reals, state: Reals) -> Reals:
    """Return the state after a step, coefficients of L by powers of the step."""
    terms = [state]
    for k in range(1, _ORDER):
        total = coefficients[0] @ terms[k - 1]
        for j in range(1, k):
            total = total + coefficients[j] @ terms[k - 1 - j]
        terms.append(total / k)
    value = terms[-1]
    for term in terms[-2::-1]:
        value = value + term
    return value


def solve_once(entries: Entries, speed: float, tolerance: float) -> Array:
    """Return one matrix over a turn by SciPy's DOP853."""
    from scipy.integrate import solve_ivp

    m, inverse = entries.size, speed**-2.0

    def slope(theta: float, flat: Array) -> Array:
        return np.asarray((entries.at(theta, inverse) @ flat.reshape(m, m)).ravel())

    found = solve_ivp(
        slope,
        (0.0, 2.0 * pi),
        np.eye(m).ravel(),
        method="DOP853",
        rtol=tolerance,
        atol=1e-2 * tolerance,
    )
    return np.asarray(found.y[:, -1]).reshape(m, m)
