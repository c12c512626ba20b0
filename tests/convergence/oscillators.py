"""Nonlinear oscillators under a periodic force or a periodic stiffness, and their motions by SciPy.

    q'' + 2 damping q' + (K + excitation P cos(theta)) q + quadratic q^2 + cubic q^3
        = force f cos(theta)

coordinate by coordinate where it says powers.
"""

from dataclasses import dataclass

import numpy as np
from elastolink.runtime.core.families import Nonlinear
from elastolink.runtime.core.families.nonlinear import Drive, Varied
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import newton

# Differences of eighth order: where, their weights, and the step.
AT = np.array([-4.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0])
WEIGHTS = np.array([3.0, -32.0, 168.0, -672.0, 672.0, -168.0, 32.0, -3.0]) / 840.0
STEP = 2.5e-3  # with it and half of it multipliers differ by 1e-12, mostly by rounding
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
    system, speed, state, turns: int, samples: int = 0, rtol: float = 3e-14, rise: float = 0.0
):
    """Return states ``(q, dq/dtheta)`` after each turn by DOP853, the first one included.

    With ``samples`` at as many even angles of each turn; ``rise``: acceleration of the drive.
    Several states ``(k, 2n)``, each at its own speed where ``(k, 1)`` are given, go side by side,
    with the same steps: what they differ by is right to rounding.
    """
    begin = np.atleast_2d(np.asarray(state, dtype=float))

    def rates(theta, y):
        q, v = np.split(y.reshape(begin.shape), 2, axis=1)
        now = np.sqrt(np.asarray(speed) ** 2 + 2.0 * rise * theta)
        drive = Drive(*(np.broadcast_to(each, (len(q), 1))[:, 0] for each in (theta, now, rise)))
        found = system.equations(q, now * v, rise * v, drive, system.parameters)
        a = -np.linalg.solve(found.mass, found.residual[..., None])[..., 0] / now**2
        return np.concatenate([v, a], axis=1).ravel()

    end = 2.0 * np.pi * turns
    solved = solve_ivp(
        rates,
        (0.0, end),
        begin.ravel(),
        method="DOP853",
        rtol=rtol,
        atol=1e-3 * rtol,
        t_eval=np.linspace(0.0, end, turns * max(samples, 1) + 1),
    )
    return solved.y.T.reshape(-1, *np.shape(state))


def returned(system, speed: float, state, turns: int = 1, rtol: float = 3e-14):
    """Return the state some turns later, and its derivatives by the state and by the speed."""
    size = len(state)
    moves = STEP * np.concatenate(
        [np.zeros((1, size + 1)), *np.multiply.outer(AT, np.eye(size + 1))]
    )
    states, speeds = np.asarray(state) + moves[:, :size], speed + moves[:, size:]
    ends = marched(system, speeds, states, turns, rtol=rtol)[-1]
    slopes = np.tensordot(WEIGHTS, ends[1:].reshape(len(AT), size + 1, size), 1).T / STEP
    return ends[0], slopes[:, :size], slopes[:, size]


def shot(system, speed: float, state, turns: int = 1, rtol: float = 3e-14):
    """Return a periodic state near a guess, and the multipliers, by DOP853 and differences."""
    state = np.array(state, dtype=float)
    for _ in range(20):
        end, matrix, _ = returned(system, speed, state, turns, rtol)
        change = np.linalg.solve(np.eye(len(state)) - matrix, end - state)
        state = state + change
        if np.max(np.abs(change)) < 1e-12:
            return state, np.linalg.eigvals(matrix)
    raise ArithmeticError("no periodic motion is near the guess")


def shot_where(test, system, speed: float, state, turns: int = 1):
    """Return the speed at which a test of the multipliers of the motion vanishes, and its state.

    By the secant rule from a guess.
    """
    state = np.array(state, dtype=float)

    def tested(speed):
        nonlocal state
        state, multipliers = shot(system, speed, state, turns)
        return test(multipliers)

    return newton(tested, speed, x1=speed * (1.0 + 1e-4), tol=1e-13 * speed), state


def shot_special(system, kind: str, speed: float, state, turns: int = 1, rtol: float = 3e-14):
    """Return the speed and the periodic state at a fold or doubling near a guess, by DOP853.

    Steps along the branch by the secant rule for the determinant that vanishes there, each with
    Newton's correction across it; the guess may be off by some thousandths.
    """
    state, multiplier = np.array(state, dtype=float), {"fold": 1.0, "doubling": -1.0}[kind]
    one, step, before, way = np.eye(len(state)), 1e-3, None, None
    for _ in range(12):
        end, matrix, by_speed = returned(system, speed, state, turns, rtol)
        test = np.linalg.det(matrix - multiplier * one)
        equations = np.column_stack([matrix - one, speed * by_speed])
        last, way = way, np.linalg.svd(equations)[2][-1]
        way = way if last is None or last @ way > 0.0 else -way
        if before is not None:
            step = float(np.clip(-test * step / (test - before), -0.02, 0.02))
        change = np.linalg.lstsq(equations, state - end)[0] + step * way
        state, speed, before = state + change[:-1], speed * (1.0 + change[-1]), test
        if np.max(np.abs(change)) < 1e-8:
            return speed, state
    raise ArithmeticError(f"no {kind} is near the guess")


def extremes(path, turns: int):
    """Return lowest and highest first coordinate along states at even angles of some turns.

    By an interpolation of fourth order: of 2048 angles a turn right to 1e-12.
    """
    angles = np.linspace(0.0, 2.0 * np.pi * turns, len(path))
    curve = CubicHermiteSpline(angles, path[:, 0], path[:, path.shape[1] // 2])
    values = curve(np.append(curve.derivative().roots(extrapolate=False), angles[[0, -1]]))
    return np.array([np.min(values), np.max(values)])
