"""Critical speeds of a linear periodic system, found in several ways (Aannaque chapter 7)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import require_whole
from ..floquet.first_order import numbers
from .critical_floquet import by_meissner, by_multipliers
from .critical_means import by_mean_frequency, by_running_mean
from .critical_response import by_response
from .critical_result import CriticalSpeeds, Measure, Request
from .eigenproblem import require_system

Array = NDArray[np.float64]

_MODES = 4
_SPEEDS = 240


METHODS: Mapping[str, Callable[[Request], CriticalSpeeds]] = MappingProxyType(
    {
        "mean_frequency": by_mean_frequency,
        "running_mean": by_running_mean,
        "response": by_response,
        "multipliers": by_multipliers,
        "meissner": by_meissner,
    }
)


def critical_speeds(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    method: str = "mean_frequency",
    modes: int | None = None,
    speeds: int = _SPEEDS,
    measure: Measure | None = None,
    progress: bool = False,
) -> CriticalSpeeds:
    """Return the speeds within a range at which a mechanism is most responsive.

    Parameters
    ----------
    system : LinearPeriodic
        The system; forced and damped for ``response``.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s].
    method : str
        ``"mean_frequency"``: means of the natural frequencies over n = 1, 2, ..., crank held.
        ``"running_mean"``: the same with the axial forces of the speed itself, ``w = mean_m(w)/n``.
        ``"response"``: local maxima of the steady state over the speed.
        ``"multipliers"``: local maxima of the real part of a multiplier (Aannaque 7.2.3).
        ``"meissner"``: of J_N, each mode by itself with its frequency constant in each of N
        intervals (Aannaque 7.11).
    modes : int, optional
        Number of modes whose mean frequencies label the speeds, 4 by default.
    speeds : int
        Number of speeds of the first scan, of ``response``; a maximum between two of them that
        shows at neither is missed.
    measure : callable, optional
        What ``response`` looks at: from a steady state at several speeds to one number each.  By
        default the largest, over the watched places, root of the mean square over a period of the
        deflection over the link's length.
    progress : bool
        Whether to show a progress bar (extra ``progress``).

    Returns
    -------
    CriticalSpeeds

    Raises
    ------
    BadInput
        If the range, the method or a number is unusable, or nothing of the system depends on the
        crank angle, as of a frame; of ``response``, if the system has no damping or its
        deflections are not known.
    """
    require_system(system)
    _require_moving(system)
    low, high = _range(speed_range)
    if not isinstance(method, str) or method not in METHODS:
        raise bad("method", repr(method), f"one of {tuple(METHODS)}", "choose one")
    wanted = min(_MODES, system.size) if modes is None else modes
    count = require_whole("modes", wanted, 1, system.size)
    if not (isinstance(speeds, int) and speeds >= 3):
        raise bad("speeds", repr(speeds), "a whole number, 3 or more", "choose 240")
    request = Request(system, low, high, count, speeds, measure, progress)
    return METHODS[method](request)


def _require_moving(system: LinearPeriodic) -> None:
    """Refuse a frame: nothing of it depends on the angle of a crank, so that no speed matters."""
    if all(term.constant for term in system.terms):
        found, fix = "a frame: no crank moves it", "take natural_frequencies of it"
        raise bad("system", found, "a system that depends on a crank angle", fix)


def _range(speed_range: Sequence[float]) -> tuple[float, float]:
    ends = numbers("speed_range", speed_range)
    if ends.shape != (2,) or not np.all(np.isfinite(ends)) or not 0 < ends[0] < ends[1]:
        raise bad("speed_range", speed_range, "two rising positive speeds [rad/s]", "correct it")
    return float(ends[0]), float(ends[1])
