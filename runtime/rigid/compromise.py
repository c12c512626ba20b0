"""The trade-off between two peaks: how little of one is possible with so much of the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.inputs import require_whole
from ..core.results import Check, Result, provenance
from .barrier import PER_LINK, Array
from .bounds import Bounds
from .cases import CASES, balance_case
from .force_basis import TERMS
from .optimum import Balancing, described, peaks_of, searched
from .search import Found, Search, best_counterweights

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import Machine

# At the ends of the curve one peak is the least possible; so much more is allowed, in units of the
# unbalanced one, in order to choose between counterweights that are equal in it.
_ALLOWANCE = 1e-6
_OPTIMAL = 1e-5


@dataclass(frozen=True, kw_only=True)
class TradeOff(Result):
    """Least possible second peak over the first one allowed, each over the unbalanced linkage's.

    ``error`` says for each point how far ``second_values`` may be above the least possible one.

    Attributes
    ----------
    first, second : str
        Names of the two forces.
    first_values, second_values : ndarray
        Relative peaks of the points of the curve; the first rises, the second falls.
    points : tuple of Balancing
        Counterweights and all other peaks of each point.
    cases : mapping of str to (float, float)
        Relative peaks of the cases of Smith's Fig. 20 that the linkage has.
    """

    first: str
    second: str
    first_values: Array
    second_values: Array
    points: tuple[Balancing, ...]
    cases: Mapping[str, tuple[float, float]]

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("first_values", "second_values", "error"), ("point",)
    )

    def to_dict(self) -> dict[str, Any]:
        """Return the curve, and for each point its counterweights and all relative peaks."""
        kept = ("counterweights", "relative", "peak_angles")
        points = [point.to_dict() for point in self.points]
        return {
            **super().to_dict(),
            "points": [{name: point[name] for name in kept} for point in points],
        }

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curve and mark the cases of Smith's Fig. 20."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        ax.plot(self.first_values, self.second_values, ".-", label="least possible")
        for name, (x, y) in self.cases.items():
            ax.plot(x, y, "s", color="black", markersize=5)
            ax.annotate(f"({name})", (x, y), textcoords="offset points", xytext=(6, 5))
        ax.set_xlabel(f"peak {self.first.replace('_', ' ')}, over the unbalanced linkage's")
        ax.set_ylabel(f"peak {self.second.replace('_', ' ')}, over the unbalanced linkage's")
        # Full force balance lies on an axis: its mark stays whole.
        ax.margins(0.06)
        ax.axvline(0.0, color="0.8", lw=0.8, zorder=0)
        ax.legend()
        return ax


def trade_off(
    machine: Machine,
    speed: float,
    first: str = "shaking_force",
    second: str = "torque",
    points: int = 13,
    *,
    acceleration: float = 0.0,
    links: Sequence[str] | None = None,
    bounds: Bounds | Mapping[str, Bounds] | None = None,
    offsets: float | Mapping[str, float] | None = None,
    angles: ArrayLike | None = None,
) -> TradeOff:
    """Return the trade-off (Pareto) curve of two peak forces.

    From the least possible first peak to that with which the second is least, equally spaced limits
    are set to the first and the second is minimised, each time as :func:`balance` does.  (At the
    two ends, 1e-6 more than the least possible is allowed.)

    Parameters
    ----------
    machine, speed, acceleration, links, bounds, angles
        As :func:`balance`.
    first, second : str
        Two of shaking_force, shaking_moment, torque, f12, f23, f34, f41.
    points : int
        Number of points, from 2 to 1000.
    offsets : float or mapping of str to float
        Of the marked cases, as :func:`balance_case`; (c) has a counterweight on the coupler, and
        may lie below a curve whose ``links`` have none.

    Returns
    -------
    TradeOff
        With the check "gap or KKT residual" for the worst point.

    Raises
    ------
    BadInput
        As :func:`balance`, and for equal or unknown forces, or another number of points.
    """
    for name, term in (("first", first), ("second", second)):
        if term not in TERMS:
            raise bad(name, repr(term), f"one of {', '.join(TERMS)}", "correct the name")
    if first == second:
        raise bad("second", repr(second), "another force than the first", "choose another")
    require_whole("points", points, 2, 1000)
    both = {first: 1.0, second: 1.0}
    search, everything = searched(machine, speed, acceleration, both, links, bounds, None, angles)
    (low, least), (high, _) = _end(search, first, second), _end(search, second, first)
    ends = [float(search.peaks(_parameters(search, end))[first][1].max()) for end in (low, high)]
    found = [low]
    for limit in np.linspace(ends[0], ends[1], points)[1:-1]:
        top = max(float(limit), least + _ALLOWANCE)
        limited = replace(search, weights={second: 1.0}, limits={first: top})
        found.append(best_counterweights(limited))
    found.append(high)
    results = tuple(described(machine, search, everything, one) for one in found)
    values = [np.array([one.relative[term] for one in results]) for term in (first, second)]
    gaps = np.array([_gap(one) for one in found])
    return TradeOff(
        first=first,
        second=second,
        first_values=values[0],
        second_values=values[1],
        points=results,
        cases=_cases(machine, everything.speed, acceleration, offsets, angles, (first, second)),
        method="limits to the first peak; barrier, SLSQP and Newton on the KKT conditions",
        error=gaps,
        error_norm="second peak above the least possible one, absolute, entrywise",
        error_kind="bound",
        checks={
            "gap or KKT residual": Check(
                max(min(gap, one.residual) for gap, one in zip(gaps, found, strict=True)), _OPTIMAL
            )
        },
        provenance=provenance({"speed": repr(everything.speed)}),
    )


def _end(search: Search, term: str, other: str) -> tuple[Found, float]:
    """Return the least of the other peak where one is the least possible, and that one."""
    least = best_counterweights(replace(search, weights={term: 1.0})).value
    limits = {term: least + _ALLOWANCE}
    return best_counterweights(replace(search, weights={other: 1.0}, limits=limits)), least


def _gap(found: Found) -> float:
    # The second peak has the weight 1, and is relative already.
    return max(found.value - found.bound, 1e-13)


def _parameters(search: Search, found: Found) -> Array:
    from .designs import PointDesign

    p = PointDesign(search.rooms).parameters(found.x)
    return p.reshape(PER_LINK * len(search.rooms))


def _cases(
    machine: Machine,
    speed: float,
    acceleration: float,
    offsets: float | Mapping[str, float] | None,
    angles: ArrayLike | None,
    terms: tuple[str, str],
) -> dict[str, tuple[float, float]]:
    """Return the relative peaks of the cases that the linkage has."""
    unbalanced = peaks_of(machine, speed, acceleration, angles)
    found: dict[str, tuple[float, float]] = {}
    for case in CASES:
        try:
            balanced = balance_case(machine, case, offsets)
        except BadInput:
            if offsets is not None and case != "d":
                raise
            # A slider-crank has no case (d), and a link without a length no default offset.
            continue
        peaks = peaks_of(balanced, speed, acceleration, angles)
        x, y = (peaks[term] / unbalanced[term] for term in terms)
        found[case] = (x, y)
    return found
