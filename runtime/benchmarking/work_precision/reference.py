"""References of known digits: Taylor series in extended precision.

They share with the solvers the Fourier series of the generator and nothing else.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .equation import Array, Equation

Reals = NDArray[np.longdouble]

_PI = np.longdouble("3.141592653589793238462643383279502884197")
_ORDER = 30
# What a step covers of the largest rate, and of a wave of the highest harmonic.
_PHASE, _WAVES = 3.0, 0.35


def flows(equation: Equation, turn: float, count: int) -> Reals:
    """Return the transition matrices from angle 0 to even angles, ``(count + 1, m, m)``.

    Parameters
    ----------
    equation : Equation
        The equation.
    turn : float
        Multiple of its period at which the angles end.
    count : int
        Intervals between them.

    Notes
    -----
    On machines whose long double has 64 bits of fraction they are good to about 1e-18 times the
    length of the way that the state goes.
    """
    length = np.longdouble(equation.period) * np.longdouble(turn)
    wave = 2.0 * np.pi * equation.harmonics / equation.period
    size = max(float(np.linalg.norm(equation.at(0.0), 2)), equation.rate)
    steps = max(1, int(np.ceil(float(length) / count * max(size / _PHASE, wave * _WAVES))))
    h = length / (count * steps)
    state: Reals = np.eye(equation.states, dtype=np.longdouble)
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
        m = equation.states
        k = np.arange(len(equation.a)).astype(np.longdouble)
        k = k * (2.0 * _PI / np.longdouble(equation.period))
        powers = np.arange(_ORDER)
        factorials = np.cumprod(np.maximum(powers, 1).astype(np.longdouble))
        self.falling = ((k[:, None] * h) ** powers / factorials).T.copy()
        self.waves, self.h, self.shape = k, h, (-1, m, m)
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


def motion(equation: Equation, start: Array, turns: int, each: int) -> Reals:
    """Return the states ``(turns * each + 1, m)`` of a motion at even angles."""
    one = flows(equation, 1.0, each)
    state = start.astype(np.longdouble)
    found = [state[None]]
    for _ in range(turns):
        found.append(one[1:] @ state)
        state = found[-1][-1]
    return np.concatenate(found)


def periodic(equation: Equation, each: int) -> Reals:
    """Return the states ``(each, m)`` of the periodic motion at even angles of a period."""
    one = flows(equation, 1.0, each)
    m = equation.states - 1
    gap = np.eye(m, dtype=np.longdouble) - one[-1, :m, :m]
    start = _solved(gap, one[-1, :m, m])
    return np.asarray(one[:-1] @ np.append(start, np.longdouble(1.0)))


def _solved(matrix: Reals, right: Reals) -> Reals:
    """Solve by doubles, and refine in extended precision."""
    inverse = np.linalg.inv(matrix.astype(float)).astype(np.longdouble)
    value = inverse @ right
    for _ in range(6):
        value = value + inverse @ (right - matrix @ value)
    return np.asarray(value)
