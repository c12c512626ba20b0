"""The Kutta-Merson method: five stages, order four, with its own estimate of the local error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from .explicit import explicit_maps, stage_slopes, summed
from .protocol import Array, Generator, OneStep
from .tableau import ExplicitTableau

# Merson's estimate (2 k1 - 9 k3 + 8 k4 - k5) h / 30 is a fifth of the difference between the two
# solutions of the pair.  With constant coefficients it is the local error to leading order; else
# the second solution is of order three only, and the estimate is larger than the error.
TABLEAU = ExplicitTableau(
    name="kutta_merson",
    c=(Fraction(0), Fraction(1, 3), Fraction(1, 3), Fraction(1, 2), Fraction(1)),
    a=(
        (),
        (Fraction(1, 3),),
        (Fraction(1, 6), Fraction(1, 6)),
        (Fraction(1, 8), Fraction(0), Fraction(3, 8)),
        (Fraction(1, 2), Fraction(0), Fraction(-3, 2), Fraction(2)),
    ),
    b=(Fraction(1, 6), Fraction(0), Fraction(0), Fraction(2, 3), Fraction(1, 6)),
    order=4,
    error=(Fraction(1, 15), Fraction(0), Fraction(-3, 10), Fraction(4, 15), Fraction(-1, 30)),
)


def maps(generator: Generator, theta: Array, step: float) -> Array:
    """Return the matrices of fixed steps; see :class:`OneStep`."""
    return explicit_maps(TABLEAU, generator, theta, step)


def error_maps(generator: Generator, theta: Array, step: float) -> Array:
    """Return the matrices that take the state to Merson's estimate of the local error.

    Parameters and shapes as in :class:`OneStep`.
    """
    slopes = stage_slopes(TABLEAU, generator, theta, step)
    return summed(TABLEAU.error or (), slopes, step)


# Stands for an error that is not a number: the step shrinks as fast as it may.
_REJECT = 1e10


@dataclass(frozen=True)
class AdaptiveRun:
    """States of an adaptive run at wanted angles, with its counters.

    Attributes
    ----------
    states : ndarray
        Shape ``(reached, m)``; fewer than wanted where the run ended early.
    accepted, rejected : int
        Number of steps.
    """

    states: Array
    accepted: int
    rejected: int


def adaptive(
    generator: Generator,
    theta: Array,
    state: Array,
    rtol: float,
    atol: Array,
    *,
    stop: Callable[[Array], bool],
    first: float,
    tick: Callable[[int], None] | None = None,
) -> AdaptiveRun:
    """Integrate with steps chosen by Merson's error estimate; steps end on the wanted angles.

    Parameters
    ----------
    generator : callable
        From angles ``(nt,)`` to ``(nt, m, m)``.
    theta : ndarray
        Wanted angles [rad], increasing, shape ``(n,)``; the first is the start.
    state : ndarray
        State at the start, shape ``(m,)``.
    rtol : float
        Relative tolerance of one step.
    atol : ndarray
        Absolute tolerance of one step, shape ``(m,)``.
    stop : callable
        Returns True for a state after which to stop.
    first : float
        First step to try [rad].
    tick : callable, optional
        Told the number of wanted angles reached.

    Returns
    -------
    AdaptiveRun
        With fewer states than angles where ``stop`` said so or the step shrank to nothing.
    """
    states = [state]
    accepted = rejected = 0
    step = first
    here = float(theta[0])
    for count, target in enumerate(theta[1:], start=1):
        while here < target:
            remaining = float(target) - here
            pieces = max(1, int(np.ceil(remaining / step * (1 - 1e-12))))
            trial = remaining / pieces
            new, estimate = _trial(generator, here, trial, state)
            allowed = atol + rtol * np.maximum(np.abs(state), np.abs(new))
            ratio = float(np.max(np.abs(estimate) / allowed))
            if not np.isfinite(ratio):
                ratio = _REJECT
            proposal = trial * min(4.0, max(0.1, 0.9 * max(ratio, 1e-10) ** -0.2))
            if ratio > 1.0:
                rejected += 1
                step = proposal
                if step < 1e-13 * max(1.0, abs(here)):
                    return AdaptiveRun(np.array(states), accepted, rejected)
                continue
            here = float(target) if pieces == 1 else here + trial
            state = new
            accepted += 1
            # A step cut short to meet the angle says little about how long the next may be.
            step = proposal if ratio > 0.5 else max(step, proposal)
        states.append(state)
        if tick is not None:
            tick(count)
        if stop(state):
            break
    return AdaptiveRun(np.array(states), accepted, rejected)


def _trial(generator: Generator, here: float, step: float, state: Array) -> tuple[Array, Array]:
    """Return the new state and the error estimate of one step."""
    nodes = here + step * np.array([0.0, 1 / 3, 1 / 2, 1.0])
    first, third, half, last = generator(nodes)
    k1 = first @ state
    k2 = third @ (state + step / 3 * k1)
    k3 = third @ (state + step / 6 * (k1 + k2))
    k4 = half @ (state + step / 8 * (k1 + 3 * k3))
    k5 = last @ (state + step / 2 * (k1 - 3 * k3 + 4 * k4))
    new = state + step / 6 * (k1 + 4 * k4 + k5)
    return new, step / 30 * (2 * k1 - 9 * k3 + 8 * k4 - k5)


METHOD = OneStep("kutta_merson", order=4, maps=maps, explicit=True, symplectic=False)
