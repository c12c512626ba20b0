"""Natural frequencies with the crank held at an angle, and their mean over the cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.families import LinearPeriodic
from ..core.results import Check, Result, provenance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# Most angles over which a mean is taken.
_MOST = 4096


@dataclass(frozen=True, kw_only=True)
class FrozenFrequencies(Result):
    """Natural frequencies of a linear periodic system with its crank held.

    Attributes
    ----------
    theta : ndarray
        Crank angles [rad], shape ``(nt,)``.
    frequency : ndarray
        Natural frequencies [rad/s] of M and K + Kg there, rising, shape ``(nt, n)``.
    mean : ndarray
        Their means over the period, each rank by itself, shape ``(n,)`` [rad/s].
    error : ndarray
        Absolute error of ``frequency`` [rad/s], shape ``(nt, n)``: round-off of the eigenvalue
        problem; that of the basis is not in it.
    """

    theta: Array
    frequency: Array
    mean: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "theta": ("angle",),
        "frequency": ("angle", "mode"),
        "error": ("angle", "mode"),
        "mean": ("mode",),
    }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the first natural frequency over the crank angle and return the axes."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        ax.plot(np.degrees(self.theta), self.frequency[:, 0])
        ax.axhline(self.mean[0], color="0.6", linewidth=0.8)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("first natural frequency [rad/s]")
        return ax


def frozen_frequencies(
    system: LinearPeriodic, theta: ArrayLike | None = None, **parameters: float
) -> FrozenFrequencies:
    """Return the natural frequencies of a system with its crank held at angles.

    Neither the crank's speed nor damping plays a part: ``(K + Kg) q = omega^2 M q`` at each angle
    (Beale & Scott's Fig. 11).  :func:`~..frequencies.natural_frequencies` gives shapes too, and
    follows them.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    theta : array_like, optional
        Crank angles [rad], shape ``(nt,)``; 361 over a period by default.
    **parameters : float
        Parameter values that replace the system's own.

    Returns
    -------
    FrozenFrequencies
        Its check: ``mean``, the largest error of a mean over itself.

    Raises
    ------
    BadInput
        If an angle is not finite, a parameter is unknown, or a stiffness is not positive definite
        or a mass is not at some angle.
    """
    # The package of frequencies holds beams, too, which no other response needs.
    from ..frequencies.held import crank_angles, cycle_mean, held_frequencies

    angles = crank_angles(system, theta)
    frequency, error = held_frequencies(system, angles, parameters)
    values = partial(held_frequencies, system, parameters=parameters)
    mean, mean_error = cycle_mean(values, system.period, most=_MOST)
    return FrozenFrequencies(
        method="generalised eigenvalue problem of K + Kg and M",
        error=error,
        error_norm="absolute, of each frequency [rad/s], round-off alone",
        checks={"mean": Check(float(np.max(mean_error / mean)), 1e-9)},
        provenance=provenance(system.changed_provenance(**parameters)),
        theta=angles,
        frequency=frequency,
        mean=mean,
    )
