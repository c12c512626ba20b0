"""Numeric truth that no printed formula enters: loop closure by search, derivatives by FFT.

Angles and derivatives come from the closure of the four bars alone, boundaries from the Fourier
matrix of Hill's equation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

TURN = 2.0 * np.pi
CRANK_ROCKERS = {
    "5,1,5,2": (5.0, 1.0, 5.0, 2.0),
    "10,1,10,4": (10.0, 1.0, 10.0, 4.0),
    "2,1,2,2": (2.0, 1.0, 2.0, 2.0),
    "4,1,4,4": (4.0, 1.0, 4.0, 4.0),
    "12,6,12,12": (12.0, 6.0, 12.0, 12.0),
}
LONG_CRANK = (10.0, 8.0, 10.0, 10.0)
DRAG_LINK = (2.0, 4.0, 5.0, 4.5)


@dataclass(frozen=True)
class Motion:
    """Angles [rad] and their first and second derivatives, one value per sample of one turn."""

    theta2: np.ndarray
    theta3: np.ndarray
    theta4: np.ndarray
    omega2: np.ndarray
    omega3: np.ndarray
    omega4: np.ndarray
    alpha2: np.ndarray
    alpha3: np.ndarray
    alpha4: np.ndarray


def closure(lengths, theta2, assembly="open"):
    """Solve the loop closure for coupler and follower angle at each crank angle by bisection.

    The coupler angle is searched on a fine grid for the two places where C is one follower length
    away from D; the open assembly is the one with sin(theta4 - theta3) > 0.
    """
    l1, l2, l3, l4 = lengths
    theta2 = np.atleast_1d(np.asarray(theta2, dtype=float))
    grid = np.linspace(0.0, TURN, 721)

    def residual(angle):
        pin = l2 * np.exp(1j * theta2[:, None]) + l3 * np.exp(1j * angle) - l1
        return np.abs(pin) - l4

    values = residual(grid[None, :])
    change = np.signbit(values[:, :-1]) != np.signbit(values[:, 1:])
    assert np.all(change.sum(axis=1) == 2), "the grid must see both assemblies at every angle"
    places = np.argwhere(change)[:, 1].reshape(-1, 2)
    low, high = grid[places], grid[places + 1]
    sign = np.signbit(residual(low))
    for _ in range(60):
        middle = 0.5 * (low + high)
        same = np.signbit(residual(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    coupler = 0.5 * (low + high)
    pin = l2 * np.exp(1j * theta2[:, None]) + l3 * np.exp(1j * coupler) - l1
    follower = np.angle(pin)
    is_open = np.sin(follower - coupler) > 0
    assert np.all(is_open.sum(axis=1) == 1)
    pick = is_open if assembly == "open" else ~is_open
    return coupler[pick], follower[pick]


def spectral_derivative(samples, order=1, growth=0.0):
    """Differentiate ``growth * t + periodic`` sampled evenly over one period 2 pi of t."""
    count = samples.size
    time = TURN * np.arange(count) / count
    number = np.fft.fftfreq(count, 1.0 / count)
    if order % 2:
        number[count // 2] = 0.0
    periodic = np.fft.fft(samples - growth * time)
    result = np.fft.ifft((1j * number) ** order * periodic)
    result = result if np.iscomplexobj(samples) else result.real
    return result + growth if order == 1 else result


@cache
def motion(lengths, assembly="open", count=512, unsteady=0.0):
    """Return one turn of the linkage; theta2 = t + unsteady * sin(t), t sampled evenly."""
    time = TURN * np.arange(count) / count
    theta2 = time + unsteady * np.sin(time)
    theta3, theta4 = (np.unwrap(angle) for angle in closure(lengths, theta2, assembly))
    rates = [theta2, theta3, theta4]
    for order in (1, 2):
        for angle in (theta2, theta3, theta4):
            last_step = np.angle(np.exp(1j * (angle[0] - angle[-1])))
            growth = np.round((angle[-1] + last_step - angle[0]) / TURN)
            rates.append(spectral_derivative(angle, order, growth))
    return Motion(*rates)


def named(lengths):
    """Return the lengths by their names in a formula."""
    return dict(zip(("l1", "l2", "l3", "l4"), lengths, strict=True))


def turning(lengths, m, speed=1.0):
    """Return lengths and angles, speeds and accelerations of a motion at a crank speed, by name."""
    powers = {"theta": 0, "omega": 1, "alpha": 2}
    return named(lengths) | {name: speed ** powers[name[:5]] * v for name, v in vars(m).items()}


def vectors(lengths, angles):
    """Return the links as complex numbers by their names; the frame lies along 0."""
    units = (1.0, *(np.exp(1j * angle) for angle in angles))
    return {f"l{k + 1}_vec": lengths[k] * units[k] for k in range(4)}


def coupler_functions(m):
    """Return phi, f1, f2, f3 by their definitions from a motion at unit crank speed."""
    between = m.theta3 - m.theta4
    sine, tangent = np.sin(m.theta2 - m.theta3), np.tan(between)
    return m.omega3**2, -m.alpha3 / tangent, sine / tangent, -m.alpha4 / np.sin(between)


def fourier(samples):
    """Return complex coefficients c[k], f = sum c[k] exp(i k theta), k as in numpy.fft."""
    return np.fft.fft(samples) / samples.size


def fourier_matrix(samples, region, damping=0.0, harmonics=40):
    """Return the matrix of -y'' - 2 damping y' - f y by even samples of f over 2 pi.

    Over the periodic exponentials for an even region, the antiperiodic ones for an odd region.
    """
    number = np.arange(-harmonics, harmonics + 1) + 0.5 * (region % 2)
    index = np.arange(number.size)
    difference = (index[:, None] - index[None, :]) % samples.size
    return np.diag(number**2 - 2j * damping * number) - fourier(samples)[difference]


def boundaries(samples, region, harmonics=40):
    """Return both values of lambda^2 that bound a region of y'' + (lambda^2 + f) y = 0."""
    values = np.sort(np.linalg.eigvalsh(fourier_matrix(samples, region, 0.0, harmonics)))
    return values[region - 1], values[region]


def normalised_solutions(coefficient: Callable[[float], float], end, damping=0.0):
    """Return [[y1, y2], [y1', y2']] at an end of y'' + 2 damping y' + coefficient(x) y = 0."""

    def rates(x, state):
        y, slope = state[:2], state[2:]
        return np.concatenate([slope, -2 * damping * slope - coefficient(x) * y])

    solution = solve_ivp(
        rates, (0.0, end), [1.0, 0.0, 0.0, 1.0], method="DOP853", rtol=1e-12, atol=1e-13
    )
    return solution.y[:, -1].reshape(2, 2)
