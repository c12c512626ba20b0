"""Conditions that stop a motion, with the reason in words."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.errors import bad
from .equations import Array, Equations, NoConvergence, State
from .steppers.protocol import Step

Margin = Callable[[float, Array, Array], float]

_HALVINGS = 60


@dataclass(frozen=True)
class Guard:
    """A condition under which a motion stops.

    Attributes
    ----------
    margin : callable
        ``margin(t, q, qd)``, positive while the motion may go on; ``q`` and ``qd`` of shape
        ``(n,)``.
    reason : str
        Why it stops, for the message: ``the slider left the rod's end``.
    """

    margin: Margin
    reason: str

    def left(self, state: State) -> float:
        """Return the margin at a state.

        Raises
        ------
        BadInput
            If the margin is not one number.
        """
        value = np.asarray(self.margin(state.t, state.q, state.qd), dtype=float)
        if value.shape != () or np.isnan(value):
            raise bad("guards", f"{value} at t = {state.t:.6g}", "one number", "mend the margin")
        return float(value)


def first_crossing(
    equations: Equations, step: Step, guards: Sequence[Guard]
) -> tuple[State, Guard] | None:
    """Return the state at which the first guard of a step is met, and that guard.

    The step's ends decide whether a guard is met; the place is found by halving.

    Parameters
    ----------
    equations : Equations
        The system.
    step : Step
        Accepted.
    guards : sequence of Guard
        Conditions.
    """
    found: tuple[State, Guard] | None = None
    for guard in guards:
        if guard.left(step.after) > 0.0:
            continue
        state = _halved(equations, step, guard)
        if found is None or state.t < found[0].t:
            found = state, guard
    return found


def _halved(equations: Equations, step: Step, guard: Guard) -> State:
    low, high, best = step.before.t, step.after.t, step.after
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        try:
            state = equations.state(middle, *step.between(middle))
        except NoConvergence:
            break
        if guard.left(state) > 0.0:
            low = middle
        else:
            high, best = middle, state
    return best
