"""Critical speeds: what a method returns, and what it is asked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..core.results import Result, provenance

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..periodic import SteadyState

Array = NDArray[np.float64]
Measure = Callable[["SteadyState"], Array]


@dataclass(frozen=True, kw_only=True)
class CriticalSpeeds(Result):
    """Critical speeds of one method, by rising speed.

    Attributes
    ----------
    speed : ndarray
        Critical speeds [rad/s], shape ``(ns,)``.
    mode, order : ndarray of int
        Labels m (from 1) and n, ``(ns,)``: the speed belongs to the mean frequency of mode m over
        n.  Of ``mean_frequency`` by construction; of the others the nearest, a guess where two are
        near.
    ratio : ndarray
        The mean frequency of mode m over n times the speed, ``(ns,)``.
    height : ndarray
        What the method measures at the speed, ``(ns,)``: see ``quantity``; inf where a response
        has no bound: a multiplier is 1 there, at an end of an unstable band.
    error : ndarray
        Error of each speed [rad/s], ``(ns,)``, as the place of what the method looks for.
    mean_frequency : ndarray
        Mean natural frequencies over the period, crank held [rad/s], ``(modes,)``.
    scan_speed, scan : ndarray
        Speeds [rad/s] at which the quantity was looked at first, and it, for the picture; empty
        where no curve is scanned.
    quantity : str
        What ``height`` and ``scan`` are.
    """

    speed: Array
    mode: NDArray[np.int64]
    order: NDArray[np.int64]
    ratio: Array
    height: Array
    mean_frequency: Array
    scan_speed: Array
    scan: Array
    quantity: str

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("speed", "mode", "order", "ratio", "height", "error"), ("speed",)),
        "mean_frequency": ("frequency",),
        **dict.fromkeys(("scan_speed", "scan"), ("scan",)),
    }

    @property
    def labels(self) -> tuple[tuple[int, int], ...]:
        """Mode and order of each speed."""
        return tuple((int(m), int(n)) for m, n in zip(self.mode, self.order, strict=True))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the scanned quantity with the critical speeds labelled, and return the axes.

        Where nothing was scanned, the order n of each speed, mode by mode.
        """
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        ax.set_xlabel("crank speed [rad/s]")
        if not len(self.scan):
            return self._plot_orders(ax)
        top = np.isfinite(self.height)
        joined = np.concatenate([self.scan_speed, self.speed])
        order = np.argsort(joined, kind="stable")
        values = np.concatenate([self.scan, np.where(top, self.height, np.nan)])
        ax.plot(joined[order], values[order], lw=0.9)
        ax.set_ylabel(self.quantity)
        for speed, (mode, order_of), height in zip(
            self.speed, self.labels, self.height, strict=True
        ):
            ax.annotate(
                rf"$\bar\omega_{mode}/{order_of}$",
                (speed, min(height, 1.2 * np.max(self.scan))),
                xytext=(0, 3),
                textcoords="offset points",
                ha="center",
                fontsize=7,
                rotation=90,
            )
        return ax

    def _plot_orders(self, ax: Axes) -> Axes:
        """Draw the order of each speed, a row of points for each mode."""
        for mode in np.unique(self.mode):
            own = self.mode == mode
            points = (self.speed[own], self.order[own])
            colour = f"C{(mode - 1) % 10}"
            ax.plot(*points, "o", ms=4, color=colour, label=f"mode {mode}")
            ax.vlines(self.speed[own], 0, self.order[own], color=colour, lw=0.4)
        ax.set_ylabel("order n")
        ax.set_ylim(bottom=0.0)
        if len(self.mode):
            ax.legend(fontsize=8)
        return ax


@dataclass(frozen=True)
class Request:
    """What is asked for: range, number of modes and speeds, measure."""

    system: LinearPeriodic
    low: float
    high: float
    count: int
    speeds: int
    measure: Measure | None
    progress: bool


def listed(
    request: Request, mean: Array, rows: Sequence[tuple[float, int, int, float]], method: str
) -> CriticalSpeeds:
    """Return the result of a method that names mode and order itself."""
    kept = sorted(row for row in rows if request.low <= row[0] <= request.high)
    speed, error = (np.array([row[k] for row in kept], dtype=float) for k in (0, 3))
    mode, order = (np.array([row[k] for row in kept], dtype=np.int64) for k in (1, 2))
    return CriticalSpeeds(
        method=method,
        error=error,
        error_norm="absolute, of each speed [rad/s], as this method defines it",
        provenance=provenance(request.system.provenance),
        speed=speed,
        mode=mode,
        order=order,
        ratio=mean[mode - 1] / (order * speed),
        height=np.ones(len(speed)),
        mean_frequency=mean,
        scan_speed=np.zeros(0),
        scan=np.zeros(0),
        quantity="none",
    )
