"""Motors: torque against speed."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any, TypeAlias

import numpy as np

from ..core.errors import BadInput, Problem, bad
from .inputs import not_finite

TorqueLaw: TypeAlias = Callable[[Any, Any, Any], Any]


@dataclass(frozen=True)
class TorqueLine:
    """A motor whose torque falls in a straight line from stall to the no-load speed.

    Parameters
    ----------
    stall : float
        Torque [N m] at rest; its sign is the direction in which the motor drives.
    no_load_speed : float
        Speed [rad/s] at which the torque is zero; the same sign.  Beyond it the motor brakes.

    Raises
    ------
    BadInput
        If a number is not finite, the speed is zero, or the signs differ.

    Examples
    --------
    >>> TorqueLine(stall=4.0, no_load_speed=50.0)(25.0)
    2.0
    """

    stall: float
    no_load_speed: float

    def __post_init__(self) -> None:
        """Check the numbers."""
        given = {"stall": self.stall, "no_load_speed": self.no_load_speed}
        problems = not_finite("TorqueLine", given)
        if not problems and not self.stall * self.no_load_speed > 0:
            pair = f"stall {self.stall:g} N m, no-load speed {self.no_load_speed:g} rad/s"
            fix = "correct a sign, or give a callable"
            problems.append(Problem("TorqueLine", pair, "two numbers of one sign, not zero", fix))
        if problems:
            raise BadInput(*problems)

    def __call__(self, speed: Any, angle: Any = 0.0, time: Any = 0.0) -> Any:
        """Return the torque [N m] at a speed [rad/s]."""
        return self.stall * (1.0 - speed / self.no_load_speed)


def torque_law(torque: object) -> TorqueLaw:
    """Return a motor torque as a function of speed, angle and time."""
    if isinstance(torque, Real) and not isinstance(torque, bool):
        value = float(torque)
        if not np.isfinite(value):
            raise bad("torque", f"{value}", "a finite number", "correct it")
        return lambda speed, angle, time: value
    if not callable(torque):
        raise bad("torque", repr(torque)[:60], "a number or a callable", "give a TorqueLine")
    law: Any = torque
    try:
        parameters = inspect.signature(law).parameters.values()
    except (TypeError, ValueError):  # some built-in callables tell nothing
        return _checked(law)
    if any(item.kind is inspect.Parameter.VAR_POSITIONAL for item in parameters):
        return _checked(law)
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    count = min(sum(item.kind in kinds for item in parameters), 3)
    if count == 0:
        raise bad("torque", "a callable without arguments", "torque(speed, ...)", "take the speed")
    return _checked(lambda speed, angle, time: law(*(speed, angle, time)[:count]))


def _checked(law: TorqueLaw) -> TorqueLaw:
    """Return a torque law that refuses what is no finite number."""

    def torque(speed: float, angle: float, time: float) -> float:
        value = law(speed, angle, time)
        number = isinstance(value, Real) and not isinstance(value, bool)
        if not number and isinstance(value, np.ndarray) and value.size == 1:
            value, number = value.item(), value.dtype.kind in "fiu"
        if not (number and np.isfinite(value)):
            place = f"speed {speed:.6g} rad/s, angle {angle:.6g} rad, time {time:.6g} s"
            raise bad(
                "torque",
                f"{value!r}"[:60] + f" from the torque law at {place}",
                "a finite number [N m]",
                "correct the torque law",
            )
        return float(value)

    return torque
