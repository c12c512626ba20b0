"""How the crank speed changes in time: run-ups, coast-downs, and holds between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import Problem, refuse
from ..core.inputs import require_mapping

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class SpeedProfile:
    """Crank speed, and geometry where it changes, as smooth functions of time.

    Between the given times the values are cubic and monotone, with continuous slope (Fritsch and
    Carlson's interpolant), so that the crank acceleration is continuous.

    Parameters
    ----------
    times : sequence of float
        Times [s] that increase, at least two.
    speeds : sequence of float
        Crank speeds [rad/s] at those times, none negative.
    geometry : mapping of str to sequence of float
        By name of a length, its values at those times; a change is taken to be quasi-static.

    Raises
    ------
    BadInput
        If the times do not increase, a value is not finite, a speed is negative, or the numbers
        of values differ; every problem is listed.

    Examples
    --------
    >>> import elastolink as el
    >>> ramp = el.SpeedProfile.ramp(20.0, 30.0, duration=0.5)
    >>> print(ramp.times, ramp.speeds)
    (0.0, 0.5) (20.0, 30.0)
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]
    geometry: Mapping[str, tuple[float, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the values, and hold copies that do not change."""
        require_mapping("SpeedProfile.geometry", self.geometry, 'say {"coupler": (0.3, 0.31)}')
        refuse(_problems(self.times, self.speeds, self.geometry))
        object.__setattr__(self, "times", tuple(float(t) for t in self.times))
        object.__setattr__(self, "speeds", tuple(float(w) for w in self.speeds))
        fixed = {name: tuple(float(v) for v in given) for name, given in self.geometry.items()}
        object.__setattr__(self, "geometry", fixed)

    @classmethod
    def ramp(
        cls, start: float, stop: float, duration: float, *, before: float = 0.0, after: float = 0.0
    ) -> SpeedProfile:
        """Return one change of speed, with holds before and after.

        Parameters
        ----------
        start, stop : float
            Crank speeds [rad/s].
        duration : float
            Time of the change [s].
        before, after : float
            Times [s] at the first and at the last speed.
        """
        times, speeds = [0.0], [start]
        if before > 0:
            times.append(before)
            speeds.append(start)
        times.append(times[-1] + duration)
        speeds.append(stop)
        if after > 0:
            times.append(times[-1] + after)
            speeds.append(stop)
        return cls(times=tuple(times), speeds=tuple(speeds))

    @property
    def duration(self) -> float:
        """Time from first to last [s]."""
        return self.times[-1] - self.times[0]

    @cached_property
    def _curve(self) -> Any:
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.times, self.speeds)

    def speed(self, time: Array) -> Array:
        """Return the crank speed [rad/s] at times [s]."""
        return np.asarray(self._curve(time))

    def acceleration(self, time: Array) -> Array:
        """Return the crank acceleration [rad/s^2] at times [s]."""
        return np.asarray(self._curve(time, 1))

    def angle(self, time: Array) -> Array:
        """Return the crank angle [rad] turned since the first time."""
        return np.asarray(self._curve.antiderivative()(time))

    def lengths(self, name: str, time: Array) -> Array:
        """Return a length [m] that changes, at times [s]."""
        from scipy.interpolate import PchipInterpolator

        return np.asarray(PchipInterpolator(self.times, self.geometry[name])(time))


def _numbers(values: object) -> Array:
    """Return values as numbers; none where they are something else."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return np.zeros(0)


def _problems(
    times: Sequence[float], speeds: Sequence[float], geometry: Mapping[str, Sequence[float]]
) -> list[Problem]:
    problems = []
    count = _numbers(times).size
    rows = {"times": times, "speeds": speeds, **{f"geometry {k}": v for k, v in geometry.items()}}
    for name, values in rows.items():
        array = _numbers(values)
        if array.ndim != 1 or array.size < 2 or not np.all(np.isfinite(array)):
            found, fix = repr(values), "give one value per time"
            problems.append(Problem(f"SpeedProfile.{name}", found, "2 finite numbers or more", fix))
        elif len(array) != count:
            expected = f"{count}, as many as times"
            fix = "complete it"
            problems.append(Problem(f"SpeedProfile.{name}", f"{len(array)} values", expected, fix))
    if problems:
        return problems
    if np.any(np.diff(times) <= 0):
        problems.append(Problem("SpeedProfile.times", repr(times), "increasing times", "sort them"))
    if min(speeds) < 0:
        fix = "the crank turns one way"
        problems.append(Problem("SpeedProfile.speeds", repr(speeds), "speeds from 0", fix))
    return problems
