"""Nonlinear oscillators under a periodic force or a periodic stiffness, and their motions by SciPy.

    q'' + 2 damping q' + (K + excitation P cos(theta)) q + quadratic q^2 + cubic q^3
        = force f cos(theta)

coordinate by coordinate where it says powers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from elastolink.runtime.core.families import Nonlinear
from elastolink.runtime.core.families.nonlinear import Drive, Varied
from scipy.integrate import solve_ivp

NUMBERS = {"damping": 0.0, "quadratic": 0.0, "cubic": 0.0, "force": 0.0, "excitation": 0.0}


@dataclass(frozen=True)
class Oscillators:
    """What is left of the equations above."""

    stiffness: np.ndarray  # K, (n, n)
    parametric: np.ndarray  # P, (n, n)
    load: np.ndarray  # f, (n,)

    def __call__(self, q, qd, qdd, drive, parameters, derivatives=True):
        numbers = [parameters[name] for name in NUMBERS]
        damping, quadratic, cubic, force, excitation = numbers
        turn = np.broadcast_to(np.cos(drive.angle), q.shape[:-1])[..., None]
        stiffness = self.stiffness + excitation * turn[..., None] * self.parametric
        left = qdd + 2.0 * damping * qd + (stiffness @ q[..., None])[..., 0]
        left = left + quadratic * q**2 + cubic * q**3 - force * turn * self.load
        if not derivatives:
            return Varied(left)
        one = np.broadcast_to(np.eye(q.shape[-1]), stiffness.shape)
        slope = (2.0 * quadratic * q + 3.0 * cubic * q**2)[..., None]
        return Varied(left, one, 2.0 * damping * one, stiffness + slope * one)


def oscillators(stiffness=1.0, parametric=None, load=None, **numbers: float) -> Nonlinear:
    """Return coupled oscillators; a number stands for one of them."""
    matrix = np.atleast_2d(np.asarray(stiffness, dtype=float))
    n = len(matrix)
    equations = Oscillators(
        matrix,
        np.eye(n) if parametric is None else np.atleast_2d(parametric),
        np.ones(n) if load is None else np.asarray(load, dtype=float),
    )
    return Nonlinear(size=n, equations=equations, parameters={**NUMBERS, **numbers})


def marched(
    system,
    speed: float,
    state,
    turns: int,
    samples: int = 0,
    rtol: float = 1e-12,
    rise: float = 0.0,
):
    """Return states ``(q, dq/dtheta)`` after each turn by DOP853, the first one included.

    With ``samples`` at as many even angles of each turn; ``rise``: acceleration of the drive.
    """
    n = system.size

    def rates(theta, y):
        q, v = y[:n], y[n:]
        now = np.sqrt(speed**2 + 2.0 * rise * theta)
        drive = Drive(theta, now, rise)
        found = system.equations(q, now * v, rise * v, drive, system.parameters)
        return np.concatenate([v, -np.linalg.solve(found.mass, found.residual) / now**2])

    end = 2.0 * np.pi * turns
    solved = solve_ivp(
        rates,
        (0.0, end),
        np.asarray(state, dtype=float),
        method="DOP853",
        rtol=rtol,
        atol=1e-3 * rtol,
        t_eval=np.linspace(0.0, end, turns * max(samples, 1) + 1),
    )
    return solved.y.T


def shot(system, speed: float, state, turns: int = 1, rtol: float = 1e-12):
    """Return a periodic state near a guess, and the multipliers, by DOP853 and differences.

    The monodromy matrix is that of the marched map, by central differences.
    """
    state = np.array(state, dtype=float)
    size = len(state)
    for _ in range(12):
        matrix = np.empty((size, size))
        for j in range(size):
            step = 1e-5 * np.eye(size)[j]
            both = [marched(system, speed, state + s * step, turns, rtol=rtol)[-1] for s in (1, -1)]
            matrix[:, j] = (both[0] - both[1]) / 2e-5
        gap = marched(system, speed, state, turns, rtol=rtol)[-1] - state
        change = np.linalg.solve(np.eye(size) - matrix, gap)
        state = state + change
        if np.max(np.abs(change)) < 1e-12:
            break
    return state, np.linalg.eigvals(matrix)
