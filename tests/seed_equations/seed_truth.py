"""Numeric truth that no printed formula enters: the package's motions and boundaries."""

from collections.abc import Callable
from functools import cache

import numpy as np
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import hill_boundaries
from elastolink.runtime.linkages import FourBar
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


def closure(lengths, theta2, assembly="open"):
    """Return coupler and follower angle at each crank angle, between -pi and pi."""
    m = FourBar(*lengths, assembly).motion(np.atleast_1d(theta2))
    return [np.angle(np.exp(1j * angle)) for angle in (m.theta3, m.theta4)]


@cache
def motion(lengths, assembly="open", count=512, unsteady=0.0):
    """Return one turn of the linkage; theta2 = t + unsteady * sin(t), t sampled evenly."""
    time = TURN * np.arange(count) / count
    wave = unsteady * np.exp(1j * time)
    return FourBar(*lengths, assembly).motion(time + wave.imag, 1 + wave.real, -wave.imag)


def rates(m):
    """Return angles, speeds and accelerations of a motion by name."""
    return {
        f"{x}{k}": getattr(m, f"{x}{k}") for x in ("theta", "omega", "alpha") for k in (2, 3, 4)
    }


def named(lengths):
    """Return the lengths by their names in a formula."""
    return dict(zip(("l1", "l2", "l3", "l4"), lengths, strict=True))


def turning(lengths, m, speed=1.0):
    """Return lengths and angles, speeds and accelerations of a motion at a crank speed, by name."""
    powers = {"theta": 0, "omega": 1, "alpha": 2}
    return named(lengths) | {name: speed ** powers[name[:5]] * v for name, v in rates(m).items()}


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


def boundaries(samples, region, damping=0.0):
    """Return the ends of a region of y'' + 2 damping y' + (lambda^2 + f) y = 0, f by samples."""
    found = hill_boundaries(PeriodicFunction.from_samples(samples), 1.0, (region,), damping)
    return np.array([found.lower.item(), found.upper.item()])


def normalised_solutions(coefficient: Callable[[float], float], end, damping=0.0):
    """Return [[y1, y2], [y1', y2']] at an end of y'' + 2 damping y' + coefficient(x) y = 0."""

    def rates(x, state):
        y, slope = state[:2], state[2:]
        return np.concatenate([slope, -2 * damping * slope - coefficient(x) * y])

    solution = solve_ivp(
        rates, (0.0, end), [1.0, 0.0, 0.0, 1.0], method="DOP853", rtol=1e-12, atol=1e-13
    )
    return solution.y[:, -1].reshape(2, 2)
