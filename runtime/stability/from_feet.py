"""All tongues of a system over a geometry value or a parameter, each named after its foot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import DAMPING, Array, LinearPeriodic
from ..core.inputs import numbers_in_a_row, speed_span
from ..core.plotting import RPM, Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic import floquet_multipliers
from .edges import StabilityEdges, stability_edges
from .meetings import Resonance, resonances

Whole = NDArray[np.int64]

# Where the feet are, as a share of the least value; and how far their speeds may be off the range.
_FOOT, _BEYOND = 1e-6, 1.3


@dataclass(frozen=True, kw_only=True)
class TongueCurves(Result):
    """Ends of all tongues over one value; tongues k, values m.

    Attributes
    ----------
    name : str
        The geometry value or the parameter.
    at : ndarray, shape (m,)
        Its values.
    foot : ndarray, shape (k,)
        Speed [rad/s] from which the tongue starts where nothing is periodic.
    lower, upper : ndarray, shape (k, m)
        Speeds [rad/s]; equal where the tongue is too narrow to be told from none; NaN where no
        region bears its label, in another tongue of one of its modes as a rule; one alone where
        that end is far beyond the range.
    error : ndarray, shape (k, m)
        Absolute error of either end [rad/s]; NaN where lost.
    growth : ndarray, shape (k, m)
        Largest growth rate inside [1/s], of nine places across; 0 where closed, NaN where an end
        is missing.
    modes : ndarray of int, shape (k, 2)
        The two modes at the foot, from 1.
    harmonic : ndarray of int, shape (k,)
        n of ``w_i +- w_j = n w``.
    labels : tuple of str
        The condition at the foot, such as ``2 w1 = w``.
    """

    name: str
    at: Array
    foot: Array
    lower: Array
    upper: Array
    growth: Array
    modes: Whole
    harmonic: Whole
    labels: tuple[str, ...]

    arrays_along: ClassVar = {
        "value": "at",
        "tongue": "foot harmonic labels",
        "tongue value": "lower upper error growth width",
        "tongue mode": "modes",
    }
    exported: ClassVar[tuple[str, ...]] = ("width",)
    column_units: ClassVar = {"rad/s": "foot lower upper error width", "1/s": "growth"}

    @property
    def width(self) -> Array:
        """Widths [rad/s], shape ``(k, m)``."""
        return self.upper - self.lower

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tongues, speeds in rpm to the right, each named where it ends."""
        ax = axes_or_new(ax)
        colours = {"+": "#b2182b", "-": "#1b7837", "2": "#2166ac"}
        for i, label in enumerate(self.labels):
            kind = "2" if label.startswith("2") else "+" if "+" in label else "-"
            low = np.concatenate([[self.foot[i]], self.lower[i]]) * RPM
            high = np.concatenate([[self.foot[i]], self.upper[i]]) * RPM
            at = np.concatenate([[0.0], self.at])
            ax.fill_betweenx(at, low, high, color=colours[kind], alpha=0.35, lw=0)
            for ends in (low, high):
                ax.plot(ends, at, color=colours[kind], lw=0.8)
            last = int(np.flatnonzero(np.isfinite(low + high))[-1])
            end = 0.5 * (low[last] + high[last]), at[last]
            above: dict[str, Any] = {"textcoords": "offset points", "fontsize": 6, "rotation": 90}
            ax.annotate(label, end, (0, 3), ha="center", va="bottom", **above)
        # Room for the names.
        ax.set_ylim(0.0, 1.2 * float(self.at[-1]))
        ax.set(xlabel="crank speed [rpm]", ylabel=self.name.replace("_", " "))
        return ax


def tongue_curves(
    system: LinearPeriodic,
    name: str,
    values: ArrayLike,
    speed_range: tuple[float, float],
    *,
    highest: int = 3,
    modes: int | None = None,
    rtol: float = 1e-11,
) -> TongueCurves:
    """Return every tongue of a conservative system over a parameter, named after its foot.

    The feet are where exponents meet close to the value 0, where nothing is periodic any more.  At
    each value :func:`stability_edges` gives all regions; each belongs to the foot of its label, or
    where that names no modes to the one that it overlaps at the value before.

    Parameters
    ----------
    system : LinearPeriodic
        Its damping is left out.
    name : str
        A geometry name, such as ``crank_ratio``, or a parameter; at 0 nothing may be periodic.
    values : array_like, shape (m,)
        Positive and rising.
    speed_range : pair of float
        Speeds [rad/s]; tongues that start up to 1.3 times beyond are kept where they reach it.
    highest : int
        Highest harmonic n.
    modes : int, optional
        Only tongues of the first so many modes; all without.
    rtol : float
        Wanted error of the monodromy matrices.

    Returns
    -------
    TongueCurves
        By rising foot.  Its checks: ``lost``, how many tongues were not found at the last value (no
        error); ``edges``, the number of failed self-checks of all searches.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Notes
    -----
    Beale & Scott 1992, section 3.1: feet at ``2 w1/n``, ``(w1 + w2)/n``, ``2 w2/n``.

    Examples
    --------
    >>> import elastolink as el
    >>> rod = el.load_scene("beale_1992_flexible_rod", {"model.modes": 2}).system()
    >>> found = el.stability.tongue_curves(rod, "crank_ratio", [0.02], (1700.0, 1900.0), highest=1)
    >>> print(found.labels, found.foot.round(0), found.width.round(1))
    ('2 w1 = w',) [1716.] [[42.7]]
    """
    at = _checked_values(system, name, values)
    sharp = system.without(*DAMPING)
    low, high = speed_span(speed_range)
    span = (low / _BEYOND, high * _BEYOND)
    start: dict[str, Any] = {name: _FOOT * float(at[0])}
    feet = resonances(sharp, span, highest=highest, **start)
    most = modes or system.size
    feet = [foot for foot in feet if foot.opens and max(foot.modes) <= most]
    feet.sort(key=lambda foot: foot.speed)
    row = {(str(foot.kind), *sorted(foot.modes), foot.harmonic): k for k, foot in enumerate(feet)}
    ends, failed = np.full((4, len(feet), len(at)), np.nan), 0
    for column, value in enumerate(at.tolist()):
        edges = stability_edges(sharp, (low, high), rtol=rtol, margin=_BEYOND, **{name: value})
        failed += sum(not check.passed for check in edges.checks.values())
        growth = _growth(sharp, {name: value}, edges)
        places = [row.get((kind, *label)) for kind, *label in edges.names]
        if column:
            places = _carried_on(feet, ends[:2, :, column - 1], edges, places)
        for i, place in enumerate(places):
            if place is not None:
                one = edges.lower[i], edges.upper[i], edges.error[i], growth[i]
                ends[:, place, column] = one
    with np.errstate(invalid="ignore"):
        seen = np.any((ends[1] >= low) & (ends[0] <= high), axis=1)
    feet = [foot for foot, reached in zip(feet, seen, strict=True) if reached]
    lower, upper, error, growth = ends[:, seen]
    return TongueCurves(
        method=f"stability_edges at each value, by label; {edges.method}",
        error=error,
        error_norm="absolute, of either end [rad/s]",
        checks={
            "lost": Check(float(np.sum(np.isnan(lower[:, -1]))), float(len(feet))),
            "edges": Check(float(failed), 0.0),
        },
        provenance=provenance(system.changed_provenance(**{name: at})),
        name=name,
        at=at,
        foot=np.array([foot.speed for foot in feet]),
        lower=lower,
        upper=upper,
        growth=growth,
        modes=np.array([foot.modes for foot in feet], dtype=np.int64).reshape(-1, 2),
        harmonic=np.array([foot.harmonic for foot in feet], dtype=np.int64),
        labels=tuple(foot.label for foot in feet),
    )


def _carried_on(
    feet: list[Resonance], before: Array, edges: StabilityEdges, places: list[int | None]
) -> list[int | None]:
    """Return the feet of regions, those without modes by what they overlap at the value before."""
    # Where much is periodic the averaged equation may have no modes to name a region after.
    begin, end = np.nan_to_num(edges.lower, nan=0.0), np.nan_to_num(edges.upper, nan=np.inf)
    last = np.nan_to_num(before[1], nan=np.inf)
    carried = list(places)
    for i, (kind, mode, *_) in enumerate(edges.names):
        if mode:
            continue
        principal, sign = kind == "principal", float(edges.multiplier[i].real)
        fitting = [
            k
            for k, foot in enumerate(feet)
            if k not in carried
            and (foot.kind == "principal") == principal
            and (not principal or sign == (-1.0) ** foot.harmonic)
            and before[0, k] <= end[i]
            and last[k] >= begin[i]
        ]
        if len(fitting) == 1:
            carried[i] = fitting[0]
    return carried


def _growth(system: LinearPeriodic, at: Mapping[str, float], edges: StabilityEdges) -> Array:
    """Return the largest growth rate of nine places inside each region [1/s]; 0 where closed."""
    # NaN of one without two ends.
    growth = np.where(np.isfinite(edges.width), 0.0, np.nan)
    wide = np.flatnonzero(edges.width > 2 * edges.error)
    if len(wide):
        speed = edges.lower[wide] + np.multiply.outer(np.linspace(0.1, 0.9, 9), edges.width[wide])
        growth[wide] = np.max(floquet_multipliers(system, speed, **at).growth, axis=0)
    return growth


def _checked_values(system: LinearPeriodic, name: str, values: ArrayLike) -> Array:
    """Return the values of a geometry name or parameter; raise where they are none."""
    names = sorted({*system.parameters, *system.geometry})
    if name not in names:
        raise bad("name", repr(name), f"one of {names}", "correct it")
    at = numbers_in_a_row("values", values)
    if np.any(np.diff(at) <= 0) or not at[0] > 0:
        raise bad("values", repr(values), "positive rising values", "correct them")
    return at
