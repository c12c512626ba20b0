"""One unstable region followed along a second parameter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import bad
from ...core.families import LinearPeriodic
from ...core.inputs import numbers
from ...core.results import Check, Result, provenance
from .tracing import StabilityEdges, stability_edges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# Half the window of speeds that is searched, relative, to begin with; how often it is doubled.
_WINDOW, _DOUBLINGS = 0.01, 3


@dataclass(frozen=True, kw_only=True)
class TongueTrace(Result):
    """Ends of one unstable region over a parameter.

    Attributes
    ----------
    name : str
        The parameter.
    at : ndarray, shape (m,)
        Its values [SI].
    lower, upper : ndarray, shape (m,)
        Speeds [rad/s]; equal where the region is narrower than its error; both NaN where no
        region of that label was found near where it was expected, one alone as in
        :class:`~.tracing.StabilityEdges`.
    error : ndarray, shape (m,)
        Absolute error of either end [rad/s]; NaN where not found.
    label : str
        As in :attr:`~.tracing.StabilityEdges.labels`.
    """

    name: str
    at: Array
    lower: Array
    upper: Array
    label: str

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        key: ("parameter",) for key in ("at", "lower", "upper", "error")
    }
    exported: ClassVar[tuple[str, ...]] = ("width",)

    @property
    def width(self) -> Array:
        """Widths [rad/s], shape ``(m,)``."""
        return self.upper - self.lower

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw both ends over the parameter, the region between them shaded; speeds in rpm."""
        from ...core.plotting import axes_or_new

        ax = axes_or_new(ax)
        rpm = 30.0 / np.pi
        ax.fill_betweenx(self.at, self.lower * rpm, self.upper * rpm, color="#b9a3d6", lw=0)
        for ends in (self.lower, self.upper):
            ax.plot(ends * rpm, self.at, color="#5b2d8c", lw=0.9)
        ax.set_xlabel("crank speed [rpm]")
        ax.set_ylabel(self.name)
        ax.set_title(self.label, fontsize=9)
        return ax


def trace_tongue(
    system: LinearPeriodic,
    edges: StabilityEdges,
    index: int,
    name: str,
    values: ArrayLike,
    *,
    rtol: float = 1e-11,
    **parameters: float,
) -> TongueTrace:
    """Follow one unstable region over a parameter, from where it is known.

    At each value :func:`stability_edges` searches a window of speeds about where the values
    before make the region expected; it is recognised by its label.

    Parameters
    ----------
    system : LinearPeriodic
        That ``edges`` belongs to.
    edges : StabilityEdges
        Where the region is known.
    index : int
        Which of its regions.
    name : str
        The parameter.
    values : array_like, shape (m,)
        Rising; followed from the one nearest to the system's own value to either side.
    rtol : float
        As in :func:`stability_edges`.
    **parameters : float
        Parameter values that ``edges`` was found with.

    Returns
    -------
    TongueTrace
        Its checks: ``found``, the number of values at which the region was not found; ``edges``,
        the number of failed self-checks of all searches.

    Raises
    ------
    BadInput
        If an argument is unusable.
    """
    at = _values(values)
    names = sorted(system.parameters)
    if name not in system.parameters:
        raise bad("name", repr(name), f"one of {names}", "correct it")
    if not -len(edges.lower) <= index < len(edges.lower):
        raise bad("index", index, f"a region, 0 to {len(edges.lower) - 1}", "correct it")
    own = float(parameters.get(name, system.parameters[name]))
    label = edges.labels[index]
    found = np.full((3, len(at)), np.nan)
    failed, width = 0, float(np.nan_to_num(edges.width[index]))
    start = int(np.argmin(np.abs(at - own)))
    begin = (own, _middle(edges, index))
    order = [range(start, len(at)), range(start - 1, -1, -1)]
    for way in order:
        known: list[tuple[float, float]] = [begin]
        if way is order[1] and np.isfinite(found[0, start] + found[1, start]):
            known.append((float(at[start]), float(0.5 * (found[0, start] + found[1, start]))))
        for k in way:
            changes = {**parameters, name: float(at[k])}
            expected = _expected(known, float(at[k]))
            row, wrong = _nearby(system, label, (expected, width), rtol, changes)
            failed += wrong
            found[:, k] = row
            width = max(0.0, float(np.nan_to_num(row[1] - row[0], nan=width)))
            ends = [end for end in row[:2] if np.isfinite(end)]
            if ends:
                known.append((float(at[k]), sum(ends) / len(ends)))
    lost = int(np.sum(~np.isfinite(found[0]) & ~np.isfinite(found[1])))
    return TongueTrace(
        method=f"stability_edges in windows of speed; {edges.method}",
        error=found[2],
        error_norm="absolute, of either end [rad/s]",
        checks={"found": Check(float(lost), 0.0), "edges": Check(float(failed), 0.0)},
        provenance=provenance(system.changed_provenance(**parameters)),
        name=name,
        at=at,
        lower=found[0],
        upper=found[1],
        label=label,
    )


def _values(values: ArrayLike) -> Array:
    at = numbers("values", values)
    if at.ndim != 1 or not len(at) or not np.all(np.isfinite(at)) or np.any(np.diff(at) <= 0):
        raise bad("values", f"shape {at.shape}", "finite rising values in a line", "correct them")
    return at


def _middle(edges: StabilityEdges, index: int) -> float:
    ends = [float(e[index]) for e in (edges.lower, edges.upper) if np.isfinite(e[index])]
    return sum(ends or edges.speed_range) / (len(ends) or 2)


def _expected(known: list[tuple[float, float]], value: float) -> float:
    """Return where a line through the last two middles leads, or the last one."""
    (x1, y1), (x0, y0) = known[-1], known[-2] if len(known) > 1 else known[-1]
    if x1 == x0:
        return y1
    return y1 + (y1 - y0) * (value - x1) / (x1 - x0)


def _nearby(
    system: LinearPeriodic,
    label: str,
    place: tuple[float, float],
    rtol: float,
    changes: dict[str, float],
) -> tuple[tuple[float, float, float], int]:
    """Return the ends and the error of the region of a label, and how many checks failed.

    ``place`` is its middle and width, as expected; the window grows until both ends are seen.
    """
    row, failed = (np.nan, np.nan, np.nan), 0
    expected, width = place
    for doubling in range(_DOUBLINGS + 1):
        share = max(_WINDOW, width / expected) * 2**doubling
        if share >= 0.5:
            break
        window = (expected * (1 - share), expected * (1 + share))
        edges = stability_edges(system, window, rtol=rtol, margin=1.0 + share, **changes)
        if label in edges.labels:
            i = edges.labels.index(label)
            failed = sum(not check.passed for check in edges.checks.values())
            row = float(edges.lower[i]), float(edges.upper[i]), float(edges.error[i])
            if np.isfinite(edges.width[i]):
                break
    return row, failed
