"""The critical speeds of several methods side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.results import Result, provenance
from .critical import METHODS, CriticalSpeeds, critical_speeds
from .held import require_system

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_FIRST = ("response", "multipliers", "meissner", "running_mean", "mean_frequency")


@dataclass(frozen=True, kw_only=True)
class CriticalComparison(Result):
    """Critical speeds by several methods, a row to a label.

    Attributes
    ----------
    methods : tuple of str
        The methods.
    mode, order : ndarray of int
        Labels, ``(nl,)``, by mode and order.
    speed : ndarray
        Critical speed of each label by each method [rad/s], ``(nl, methods)``; NaN where a method
        has none: the response shows few of the speeds that the equation without forcing has.
    error : ndarray
        Their errors [rad/s], each as its method defines the speed, ``(nl, methods)``; NaN alike.
    spread : ndarray
        Largest less least speed of a label over their mean, ``(nl,)``.
    """

    methods: tuple[str, ...]
    mode: Indices
    order: Indices
    speed: Array
    spread: Array

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **dict.fromkeys(("mode", "order", "spread"), ("label",)),
        **dict.fromkeys(("speed", "error"), ("label", "method")),
    }

    def table(self) -> str:
        """Return the speeds as a Markdown table, those that the first method has."""
        lines = ["| mode, n | " + " | ".join(self.methods) + " |"]
        lines.append("|---" * (len(self.methods) + 1) + "|")
        for mode, order, speeds in zip(self.mode, self.order, self.speed, strict=True):
            if np.isfinite(speeds[0]):
                cells = [f"{w:.2f}" if np.isfinite(w) else "-" for w in speeds]
                lines.append(f"| {mode}, {order} | " + " | ".join(cells) + " |")
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the speeds of each method on a line of its own, labels that agree joined."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        height = np.arange(len(self.methods), dtype=float)
        for mode, order, speeds in zip(self.mode, self.order, self.speed, strict=True):
            there = np.isfinite(speeds)
            ax.plot(speeds[there], height[there], "-o", ms=3, lw=0.6, color=f"C{mode - 1}")
            if there[0]:
                label = rf"$\bar\omega_{mode}/{order}$"
                ax.annotate(
                    label,
                    (speeds[0], height[0]),
                    fontsize=7,
                    ha="center",
                    va="top",
                    xytext=(0, -5),
                    textcoords="offset points",
                )
        ax.set_yticks(height, self.methods)
        ax.set_ylim(-0.6, len(self.methods) - 0.6)
        ax.set_xlabel("crank speed [rad/s]")
        return ax


def compare_critical_speeds(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    methods: Sequence[str] = _FIRST,
    modes: int | None = None,
    speeds: int = 240,
) -> CriticalComparison:
    """Return the critical speeds within a range by several methods, label by label.

    Parameters
    ----------
    system : LinearPeriodic
        Forced and damped where ``response`` is among the methods.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s].
    methods : sequence of str
        As :func:`~.critical.critical_speeds` takes them; all by default.
    modes, speeds : int
        As there.

    Returns
    -------
    CriticalComparison

    Raises
    ------
    BadInput
        If a method is unknown, or as :func:`~.critical.critical_speeds`.
    """
    require_system(system)
    if not isinstance(methods, (tuple, list)) or not all(isinstance(m, str) for m in methods):
        raise bad("methods", repr(methods), f"some of {tuple(METHODS)}", "name them in a row")
    chosen = tuple(methods)
    strange = sorted(set(chosen) - set(METHODS))
    if not chosen or strange:
        raise bad("methods", strange or "none", f"some of {tuple(METHODS)}", "correct the name")
    found = {
        name: critical_speeds(system, speed_range, method=name, modes=modes, speeds=speeds)
        for name in chosen
    }
    labels = sorted({label for one in found.values() for label in one.labels})
    rows = [[_of(one, label) for one in found.values()] for label in labels]
    table = np.array(rows, dtype=float).reshape(len(labels), len(chosen), 2)
    speed, error = table[..., 0], table[..., 1]
    spread = np.array([np.ptp(w[np.isfinite(w)]) / np.mean(w[np.isfinite(w)]) for w in speed])
    checks = {
        f"{name}: {key}": check for name, one in found.items() for key, check in one.checks.items()
    }
    return CriticalComparison(
        method=", ".join(chosen),
        error=error,
        error_norm="absolute, of each speed [rad/s], as its method defines it",
        checks=checks,
        provenance=provenance(system.provenance),
        methods=chosen,
        mode=np.array([label[0] for label in labels], dtype=np.int64),
        order=np.array([label[1] for label in labels], dtype=np.int64),
        speed=speed,
        spread=spread,
    )


def _of(found: CriticalSpeeds, label: tuple[int, int]) -> tuple[float, float]:
    """Return speed and error of a label; of several the one whose mean fits best."""
    places = [k for k, own in enumerate(found.labels) if own == label]
    if not places:
        return np.nan, np.nan
    best = min(places, key=lambda k: abs(float(found.ratio[k]) - 1.0))
    return float(found.speed[best]), float(found.error[best])
