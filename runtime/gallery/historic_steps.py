"""The documents' one-step methods: de Vogelaere's and Kutta-Merson's (Smith), Newmark's (Aannaque).

They are redrawn, not recommended: :func:`~..periodic.steady_state` and
:func:`~..periodic.simulate` are what the library solves with.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Generator = Callable[[Array], Array]


def de_vogelaere_maps(generator: Generator, theta: Array, half_step: float) -> Array:
    """Return de Vogelaere's steps of ``y'' = P(theta) y`` as matrices (Smith, appendix 4).

    With h the *half* step, the values of y'' = f(theta, y) at -h, 0, h and 2h are used:

        y(h)   = y(0) + h y'(0) + h^2/6 (4 f(0) - f(-h)),
        y(2h)  = y(0) + 2h y'(0) + h^2/3 (2 f(0) + 4 f(h)),
        y'(2h) = y'(0) + h/3 (f(0) + 4 f(h) + f(2h)),

    and f(h) serves the next step as its f(-h).  From P ``(nt, n, n)`` at angles, the left ends
    ``(ns,)`` of the steps and h to matrices ``(ns, 3 n, 3 n)`` on (y, h y', h^2 f(-h)); forcing
    enters as a last component of y that stays 1.
    """
    angles = theta[:, None] + half_step * np.arange(3.0)
    values = half_step**2 * generator(angles.ravel())
    n = values.shape[-1]
    f0, f1, f2 = np.moveaxis(values.reshape(len(theta), 3, n, n), 1, 0)
    y, slope, past = np.eye(3 * n).reshape(3, n, 3 * n)
    start = f0 @ y
    middle = f1 @ (y + slope + (4 * start - past) / 6)
    end = y + 2 * slope + (2 * start + 4 * middle) / 3
    end_slope = slope + (start + 4 * middle + f2 @ end) / 3
    return np.concatenate([end, end_slope, middle], axis=-2)


def de_vogelaere_start(
    generator: Generator, theta: float, half_step: float, y: Array, slope: Array
) -> Array:
    """Return the first state ``(3 n,)`` of de Vogelaere's method from y and y' at an angle.

    The value at -h comes from the Taylor polynomial y - h y' + h^2/2 y''; its third-order error
    leaves the order of the method at four.
    """
    before, here = generator(np.array([theta - half_step, theta]))
    past = y - half_step * slope + half_step**2 / 2 * (here @ y)
    return np.concatenate([y, half_step * slope, half_step**2 * (before @ past)])


@dataclass(frozen=True)
class MersonRun:
    """States ``(nt, m)`` of a Kutta-Merson run at the angles of its output, and counts of steps."""

    states: Array
    accepted: int
    rejected: int


def kutta_merson(
    generator: Generator, theta: Array, state: Array, rtol: float, atol: Array, *, first: float
) -> MersonRun:
    """Integrate ``y' = L(theta) y`` with steps chosen by Merson's estimate of the local error.

    From a state ``(m,)`` at the first of the output's angles, on all of which steps end; with the
    relative and absolute tolerance ``(m,)`` of one step, and the first step to try.
    """
    states = [state]
    accepted = rejected = 0
    step, here = first, float(theta[0])
    for target in theta[1:]:
        while here < target:
            remaining = float(target) - here
            pieces = max(1, int(np.ceil(remaining / step * (1 - 1e-12))))
            trial = remaining / pieces
            new, estimate = merson_step(generator, here, trial, state)
            allowed = atol + rtol * np.maximum(np.abs(state), np.abs(new))
            ratio = float(np.max(np.abs(estimate) / allowed))
            proposal = trial * min(4.0, max(0.1, 0.9 * max(ratio, 1e-10) ** -0.2))
            if ratio > 1.0:
                rejected += 1
                step = proposal
                continue
            here = float(target) if pieces == 1 else here + trial
            state = new
            accepted += 1
            # A step cut short to meet the angle says little about how long the next may be.
            step = proposal if ratio > 0.5 else max(step, proposal)
        states.append(state)
    return MersonRun(np.array(states), accepted, rejected)


def merson_step(
    generator: Generator, here: float, step: float, state: Array
) -> tuple[Array, Array]:
    """Return the new state and Merson's estimate of the local error of one step.

    The estimate is a fifth of the difference between the two solutions of the pair.  With constant
    coefficients it is the local error to leading order; else the second solution is of order three
    only, and the estimate is larger than the error.
    """
    nodes = here + step * np.array([0.0, 1 / 3, 1 / 2, 1.0])
    first, third, half, last = generator(nodes)
    k1 = first @ state
    k2 = third @ (state + step / 3 * k1)
    k3 = third @ (state + step / 6 * (k1 + k2))
    k4 = half @ (state + step / 8 * (k1 + 3 * k3))
    k5 = last @ (state + step / 2 * (k1 - 3 * k3 + 4 * k4))
    new = state + step / 6 * (k1 + 4 * k4 + k5)
    return new, step / 30 * (2 * k1 - 9 * k3 + 8 * k4 - k5)


def newmark_matrices(
    mass: Array,
    rate: Array,
    stiffness: Array,
    force: Array,
    step: float,
    *,
    gamma: float = 0.5,
    beta: float = 0.25,
) -> tuple[Array, Array]:
    """Return Newmark's steps of ``M q'' + G q' + H q = F`` as matrices (Aannaque 6.5).

    Displacement and velocity at the end of a step come from accelerations at both ends,

        q+ = q + h v + h^2 ((1/2 - beta) a + beta a+),   v+ = v + h ((1 - gamma) a + gamma a+).

    From M, G, H ``(N + 1, n, n)`` and F ``(N + 1, n)`` at the ends of the steps to matrices
    ``(N, 2n, 2n)`` on the state (q, q') and what the force adds, ``(N, 2n)``.
    """
    n, count = mass.shape[-1], len(mass) - 1
    # Columns: what multiplies q, q' and 1 at the start of a step.
    right = np.concatenate([-stiffness, -rate, force[..., None]], axis=-1)
    a = np.linalg.solve(mass[:-1], right[:-1])
    q, v = np.broadcast_to(np.eye(2 * n, 2 * n + 1).reshape(2, 1, n, -1), (2, count, n, 2 * n + 1))
    q = q + step * v + (0.5 - beta) * step**2 * a
    v = v + (1.0 - gamma) * step * a
    load = -(rate[1:] @ v + stiffness[1:] @ q)
    load[..., -1] += force[1:]
    system = mass[1:] + gamma * step * rate[1:] + beta * step**2 * stiffness[1:]
    new = np.linalg.solve(system, load)
    whole = np.concatenate([q + beta * step**2 * new, v + gamma * step * new], axis=1)
    return whole[..., :-1], whole[..., -1]
