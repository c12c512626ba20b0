"""The motion of a constrained system as a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..core.results import Result
from .equations import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, kw_only=True)
class ConstrainedMotion(Result):
    """Motion of a constrained system at given times.

    Attributes
    ----------
    time : ndarray, shape (nt,)
        Times reached [s].
    q, qd, qdd : ndarray, shape (nt, n)
        Coordinates, velocities and accelerations.
    multipliers : ndarray, shape (nt, k)
        Multipliers of the constraints.
    position_norm, velocity_norm, acceleration_norm : ndarray, shape (nt,)
        Scaled defects of the constraints (see :func:`.norms.constraint_norms`).
    steps, evaluations : int
        Steps taken, and evaluations of the equations of motion.
    status : int
        0 the end was reached, 1 a guard or the bound stopped the motion, 2 the method gave up.
    message : str
        Why the motion ended.
    labels : tuple of str
        Names of the coordinates.
    error : ndarray, shape (n,)
        Figure of the largest error of each coordinate, in its own unit.
    """

    time: Array
    q: Array
    qd: Array
    qdd: Array
    multipliers: Array
    position_norm: Array
    velocity_norm: Array
    acceleration_norm: Array
    steps: int
    evaluations: int
    status: int
    message: str
    labels: tuple[str, ...]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "time": ("sample",),
        "q": ("sample", "coordinate"),
        "qd": ("sample", "coordinate"),
        "qdd": ("sample", "coordinate"),
        "multipliers": ("sample", "constraint"),
        "position_norm": ("sample",),
        "velocity_norm": ("sample",),
        "acceleration_norm": ("sample",),
        "error": ("coordinate",),
    }

    @property
    def success(self) -> bool:
        """True where the end was reached."""
        return self.status == 0

    @property
    def at_end(self) -> tuple[Array, Array]:
        """Coordinates and velocities at the last time: a start for going on."""
        return self.q[-1], self.qd[-1]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the coordinates over time and return the axes."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        names = self.labels or tuple(f"q{i + 1}" for i in range(self.q.shape[1]))
        for label, values in zip(names, self.q.T, strict=True):
            ax.plot(self.time, values, label=label, linewidth=0.9)
        ax.set_xlabel("time [s]")
        ax.set_ylabel("coordinate")
        if len(names) > 1:
            ax.legend()
        return ax
