"""Checks of a computed motion, and the linear range that it may leave."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning
from ..core.families import LinearPeriodic
from ..core.results import Check, DeferredChecks
from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm
from .energy import energy_balance
from .marching import March

Array = NDArray[np.float64]

LINEAR_RANGE = 0.05
# Error that a motion may have where none was asked for, and most artificial damping.
FAIR = 0.01
# Places x/length at which fixed shapes are looked at, and moving ones.
_PLACES, _FEW_PLACES = np.linspace(0.0, 1.0, 101), np.linspace(0.0, 1.0, 26)
# Angles at which moving shapes are looked at first, and how far those between may exceed them.
_FEW_ANGLES, _DOUBT = 36, 2.0


@dataclass(frozen=True)
class MotionChecks:
    """What the checks of a motion look at.

    Attributes
    ----------
    form : CanonicalForm
        A batch of one.
    theta : ndarray
        Given crank angles [rad], ``(nt,)``.
    march : March
        The motion.
    error : float
        Its largest error figure.
    wanted : float
        Error that was asked for.
    symplectic : bool
        Whether the method keeps areas where the system does.
    """

    form: CanonicalForm
    theta: Array
    march: March
    error: float
    wanted: float
    symplectic: bool

    def __call__(self) -> Mapping[str, Check]:
        """Return the checks by name."""
        form, result = self.form, self.march
        checks = {"accuracy": Check(self.error, self.wanted)}
        if len(self.theta) > 1:
            balance = energy_balance(form, self.theta, result.q, result.slope, self.error)
            if balance is not None:
                checks["energy balance"] = balance
        if result.volume is not None:
            turned = self.theta[-1] - self.theta[0]
            mean = float(np.mean(form.trace(even_angles(form.system.period, 256))))
            drift = abs(float(result.volume - mean * turned)) / (2 * form.system.size)
            checks["liouville"] = Check(drift, FAIR)
        if self.symplectic and form.conservative:
            checks["symplectic"] = Check(result.defect, 1e-12)
        deflection = largest_deflection(form.system, self.theta, result.q)
        if deflection is not None:
            checks["linear range"] = Check(deflection, LINEAR_RANGE)
        return checks


class MotionChecksLater(DeferredChecks):
    """Checks of a motion that are made when they are looked at, or when the result is pickled.

    The functions of a system need not bear pickling; its motion does.
    """

    def __reduce__(self) -> tuple[Callable[..., object], tuple[object, ...]]:
        """Return the finished checks."""
        return dict, (dict(self),)


def warn_of_large_deflection(system: LinearPeriodic, theta: Array, q: Array) -> None:
    """Warn where the deflection leaves the linear range."""
    # Less work than every place at every angle, and mostly enough.
    peaks = np.max(np.abs(q), axis=0, initial=0.0)
    most = np.inf
    if system.moving_shape is not None:
        shapes = system.moving_shape(_FEW_PLACES, even_angles(2 * np.pi, _FEW_ANGLES))
        most = _DOUBT * float(np.max(np.abs(shapes) @ peaks))
    elif system.shape is not None:
        most = float(np.max(np.abs(system.shape(_PLACES)) @ peaks))
    if most <= LINEAR_RANGE:
        return
    deflection = largest_deflection(system, theta, q)
    if deflection is not None and deflection > LINEAR_RANGE:
        warnings.warn(
            f"deflection reaches {deflection:.3g} of the reference length; the linear "
            f"equations hold to about {LINEAR_RANGE}: lower the amplitude",
            LinearRangeWarning,
            stacklevel=4,
        )


def largest_deflection(system: LinearPeriodic, theta: Array, q: Array) -> float | None:
    """Return the largest deflection over the reference length; None where it has no meaning."""
    if system.moving_shape is not None:
        return _moving_deflection(system, theta, q)
    if system.shape is not None:
        shapes = np.asarray(system.shape(_PLACES))
        parts = (q[k : k + 4096] @ shapes.T for k in range(0, len(q), 4096))
        return max(float(np.max(np.abs(part))) for part in parts)
    if system.reference_length != 1.0:
        return float(np.max(np.abs(q)))
    return None


def _moving_deflection(system: LinearPeriodic, theta: Array, q: Array) -> float:
    """Return the largest deflection of shapes that move with the crank, at 26 places."""
    # Even angles repeat with every revolution, and so do the shapes.
    turn = len(q) if len(q) < 2 else max(1, round(2 * np.pi / float(theta[1] - theta[0])))
    places, largest = _FEW_PLACES, 0.0
    for first in range(0, min(turn, len(q)), 512):
        part = np.arange(first, min(first + 512, turn, len(q)))
        shapes = system.shapes(places, theta[part])
        if shapes is None:  # not with moving shapes; for the type checker
            return largest
        for begin in range(0, len(q), turn):
            rows = q[begin + first : begin + first + len(part)]
            values = np.einsum("txn,tn->tx", shapes[: len(rows)], rows)
            largest = max(largest, float(np.max(np.abs(values), initial=0.0)))
    return largest
