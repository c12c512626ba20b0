"""Arguments of a simulation, looked at before any work starts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.inputs import numbers
from ..integrators import METHODS, SCIPY_METHODS, SECOND_ORDER
from ..periodic.first_order import CanonicalForm
from .automatic import POWER_SERIES
from .marching import MOST_INTERVALS, MOST_STEPS

Array = NDArray[np.float64]


def scalar(name: str, value: Any) -> float:
    """Return an argument as one number.

    Raises
    ------
    BadInput
        If it is none.
    """
    array = numbers(name, value)
    if array.ndim != 0:
        raise bad(name, f"shape {array.shape}", "one number", "simulate one speed at a time")
    return float(array)


def start_of(
    form: CanonicalForm, initial: tuple[ArrayLike, ArrayLike] | Sequence[ArrayLike] | None
) -> tuple[Array, Array]:
    """Return q and dq/dtheta at the start.

    Raises
    ------
    BadInput
        If it is no pair of finite values, or nothing would move.
    """
    n = form.system.size
    if initial is None:
        if not form.forced:
            raise bad(
                "initial",
                "nothing, and no forcing acts",
                "a start away from rest",
                "give initial=(q, qd)",
            )
        return np.zeros(n), np.zeros(n)
    if not isinstance(initial, (tuple, list)) or len(initial) != 2:
        raise bad("initial", initial, "a pair (q, qd)", "give coordinates and time derivatives")
    parts = []
    for name, part in zip(("q", "qd"), initial, strict=True):
        values = numbers(f"initial {name}", part)
        if values.shape not in ((), (1,), (n,)) or not np.all(np.isfinite(values)):
            fix = f"one per coordinate: {', '.join(form.system.labels)}"
            raise bad(f"initial {name}", part, f"{n} finite numbers", fix)
        parts.append(np.broadcast_to(values, (n,)).copy())
    return parts[0], parts[1] / float(form.speed[0])


def check_arguments(
    method: str,
    revolutions: float,
    steps: int | None,
    rtol: float | None,
    samples: int,
    bound: float,
    start: float,
) -> None:
    """Raise :class:`BadInput` where an argument of ``simulate`` is unusable."""
    names = ["auto", POWER_SERIES, *METHODS, *SECOND_ORDER, *SCIPY_METHODS]
    if method not in names:
        raise bad("method", repr(method), f"one of {names}", "correct the name")
    for name, value in (("revolutions", revolutions), ("bound", bound)):
        if not 0 < scalar(name, value) < np.inf:
            raise bad(name, value, "a positive finite number", "correct it")
    if not np.isfinite(scalar("start", start)):
        raise bad("start", start, "a finite crank angle [rad]", "correct it")
    for name, count in (("steps", steps), ("samples", samples)):
        if count is None:
            continue
        given = scalar(name, count)
        if not 1 <= given <= MOST_STEPS or given != int(given):
            raise bad(name, count, f"a whole number from 1 to {MOST_STEPS}", "correct it")
    if float(revolutions) * max(samples, 1) > MOST_INTERVALS:
        raise bad(
            "revolutions",
            f"{revolutions:.6g} of {samples} samples each",
            f"at most {MOST_INTERVALS} given angles in all",
            "go on from at_end in parts, or lower samples",
        )
    if rtol is not None and not 1e-14 <= scalar("rtol", rtol) < 1:
        raise bad("rtol", rtol, "a number from 1e-14 to 1", "choose 1e-8")
    if steps is not None and rtol is not None:
        raise bad("steps and rtol", "both", "one of them", "leave one out")
    if steps is not None and method in (POWER_SERIES, *SCIPY_METHODS):
        raise bad("steps", steps, f"none, as {method} chooses its steps", "give rtol")
