"""References of known digits for linear periodic systems: Taylor series in extended precision.

The generator of ``y' = L(theta) y`` is put together here from the arrays of the system's own
definition and expanded into a Fourier series; nothing of the solvers enters.  On machines whose
long double has 64 bits of fraction the results are good to about 1e-18 times the length of the way
that the state goes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Reals = NDArray[np.longdouble]


@dataclass(frozen=True)
class Equation:
    """A system at one speed in canonical variables: ``L = sum_k a_k cos k nu t + b_k sin k nu t``.

    The state is (q, p), and 1 where forced, over ``scale``: powers of two that make the entries of
    L alike.
    """

    a: Array
    b: Array
    period: float
    size: int
    mass: Array
    gyro: Array
    scale: Array

    @classmethod
    def of(cls, system, speed, *, forced, samples=256, cut=1e-15):
        """Return the equation of a system, harmonics below a share of their entry left out."""
        n, w = system.size, speed
        theta = system.period * np.arange(samples) / samples
        at = {name: system.array(name, theta, w) for name in ("M", "A", "B", "C", "D", "K", "Kg")}
        flexibility = np.linalg.inv(at["M"])
        feedback = np.swapaxes(at["A"], 1, 2) - at["C"] / w
        values = np.zeros((samples, 2 * n + forced, 2 * n + forced))
        values[:, :n, :n] = -flexibility @ at["A"]
        values[:, :n, n : 2 * n] = flexibility
        values[:, n : 2 * n, n : 2 * n] = feedback @ flexibility
        values[:, n : 2 * n, :n] = at["B"] - (at["K"] + at["Kg"]) / w**2 - at["D"] / w
        values[:, n : 2 * n, :n] += feedback @ values[:, :n, :n]
        if forced:
            force = [system.array(name, theta, w) / w**k for k, name in enumerate(("f", "h", "p"))]
            values[:, n : 2 * n, -1] = sum(force)
        pull = np.max(np.abs(values[:, n : 2 * n, :n])) / np.max(np.abs(flexibility))
        unit = np.exp2(np.round(np.log2(pull) / 4.0))
        scale = np.concatenate([np.full(n, 1.0 / unit), np.full(n, unit), np.ones(int(forced))])
        table = np.fft.rfft(values * (scale / scale[:, None]), axis=0) / samples
        table[1:] *= 2.0
        least = cut * np.max(np.abs(table), axis=0)
        a, b = (np.where(np.abs(v) > least, v, 0.0) for v in (table.real, -table.imag))
        count = int(np.flatnonzero(np.any((a != 0.0) | (b != 0.0), axis=(1, 2)))[-1]) + 1
        return cls(a[:count], b[:count], system.period, n, at["M"][0], at["A"][0], scale)

    @property
    def states(self):
        return self.a.shape[-1]

    def unscaled(self, flows):
        """Return transition matrices of (q, p), and 1 where forced."""
        return flows * (self.scale[:, None] / self.scale)

    @property
    def harmonics(self):
        return len(self.a) - 1

    @property
    def turns(self):
        """The period over that of a revolution."""
        return np.longdouble(self.period / (2.0 * np.pi))

    @property
    def rate(self):
        return float(np.max(np.abs(np.linalg.eigvals(self.a[0].astype(float)))))

    def at(self, theta):
        """Return L at an angle [rad]."""
        angle = np.arange(len(self.a)) * (theta * 2.0 * np.pi / self.period)
        return np.tensordot(np.cos(angle), self.a, 1) + np.tensordot(np.sin(angle), self.b, 1)

    def start(self, q, slope):
        """Return the state of coordinates and their derivatives d/dtheta at angle 0."""
        momentum = self.mass @ slope + self.gyro @ q
        state = np.ones(self.states)
        state[: 2 * self.size] = np.concatenate([q, momentum])
        return state / self.scale

    def coordinates(self, states):
        """Return q of states ``(nt, m)``."""
        return states[:, : self.size] * self.scale[: self.size]


_PI = np.longdouble("3.141592653589793238462643383279502884197")
# Of steps that cover so much of the largest rate and of a wave of the highest harmonic: with 30 a
# spring that waves twice a turn was off by 3e-11.
_ORDER = 40
_PHASE, _WAVES = 3.0, 0.35


def flows(equation: Equation, turn: float, count: int) -> Reals:
    """Return the transition matrices from angle 0 to even angles, ``(count + 1, m, m)``.

    The angles end at ``turn`` periods of the equation.
    """
    length = 2.0 * _PI * equation.turns * np.longdouble(turn)
    wave = 2.0 * np.pi * equation.harmonics / equation.period
    first = np.linalg.norm(equation.at(0.0).astype(float), 2, axis=(-2, -1))
    size = max(float(np.max(first)), equation.rate)
    steps = max(1, int(np.ceil(float(length) / count * max(size / _PHASE, wave * _WAVES))))
    h = length / (count * steps)
    state: Reals = np.zeros(equation.a.shape[1:], dtype=np.longdouble)
    state += np.eye(equation.states)
    found = [state]
    series = _Series(equation, h)
    for k in range(count * steps):
        state = _advance(series.at(k), state)
        if (k + 1) % steps == 0:
            found.append(state)
    return np.stack(found)


class _Series:
    """Taylor coefficients of h L at the beginnings of steps."""

    def __init__(self, equation: Equation, h: np.longdouble) -> None:
        k = np.arange(len(equation.a)).astype(np.longdouble) / equation.turns
        powers = np.arange(_ORDER)
        factorials = np.cumprod(np.maximum(powers, 1).astype(np.longdouble))
        self.falling = ((k[:, None] * h) ** powers / factorials).T.copy()
        self.waves, self.h, self.shape = k, h, (-1, *equation.a.shape[1:])
        self.a, self.b = (
            v.reshape(len(k), -1).astype(np.longdouble) for v in (equation.a, equation.b)
        )

    def at(self, step: int) -> Reals:
        angle = self.waves * (self.h * step)
        cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
        even = self.a * cos + self.b * sin
        odd = self.b * cos - self.a * sin
        found = np.empty((_ORDER, even.shape[1]), dtype=np.longdouble)
        found[0::4] = self.falling[0::4] @ even
        found[1::4] = self.falling[1::4] @ odd
        found[2::4] = -(self.falling[2::4] @ even)
        found[3::4] = -(self.falling[3::4] @ odd)
        return self.h * found.reshape(self.shape)


def _advance(coefficients: Reals, state: Reals) -> Reals:
    """Return the state after a step, coefficients of h L by powers of the step."""
    terms = np.empty((_ORDER, *state.shape), dtype=np.longdouble)
    terms[0] = state
    for k in range(1, _ORDER):
        terms[k] = np.sum(coefficients[:k] @ terms[k - 1 :: -1], axis=0) / k
    value: Reals = np.sum(terms[::-1], axis=0)
    return value
