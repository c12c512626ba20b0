"""Balancing: the best counterweights within bounds, the classic cases, and the trade-off curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput, bad
from ..core.inputs import names_in_a_row, require_mapping, require_one_of, require_whole
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..linkages.linkage import Array
from .counterweights import (
    CASES,
    Bounds,
    Case,
    Counterweight,
    Offsets,
    case_counterweights,
    with_counterweights,
)
from .machine import Machine, finite_number, require_machine
from .optimum import Candidate, Design, ForceBasis, Measure, Search, best_counterweights
from .peaks import TERMS

# The force in the crank pin, the driving torque and the moment on the frame, equally weighted.
DEFAULT_WEIGHTS: Mapping[str, float] = {"f23": 1.0, "torque": 1.0, "shaking_moment": 1.0}

# Gap or KKT residual counted as optimal; what a sum may hang on the places of its samples.
_OPTIMAL, _SAMPLED = 1e-5, 1e-6
# Last digits of a sum of relative peaks; by half of them, with these signs, lengths are moved.
_DIGITS = 8.0 * float(np.finfo(float).eps)
_SIGNS = ((0, 0, 0, 0), (1, -1, 1, -1), (-1, -1, 1, 1))
# At the ends of a trade-off one peak is the least possible; so much more is allowed, in units of
# the unbalanced one, in order to choose between counterweights that are equal in it.
_ALLOWANCE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Balancing(Result):
    """Counterweights that make a weighted sum of relative peaks least, and what they do.

    ``error`` says how far ``value`` can be above the least possible one, over the unbalanced
    linkage's (the sum of the weights); weak duality proves it for all counterweights in bounds.

    Attributes
    ----------
    counterweights : mapping of str to Counterweight
        By link; a link without one needs none.
    machine : Machine
        The balanced machine.
    weights, limits : mapping of str to float
        Of the relative peaks, as given; without weights nothing was optimised.
    value : float
        Weighted sum of the relative peaks.
    lower_bound : float
        What no counterweights within the bounds can undercut.
    measure : {"peak", "rms"}
        Of which quantity the sum is; "peak" below means it.
    unbalanced : mapping of str to float
        Peak of every force without counterweights [N] and of torque and moment [N m].
    relative : mapping of str to float
        Peaks with the counterweights over those without; a force that was zero is left out.
    peak_angles : mapping of str to float
        Crank angle [rad] of each peak with the counterweights.
    """

    counterweights: Mapping[str, Counterweight]
    machine: Machine
    weights: Mapping[str, float] = field(default_factory=dict)
    limits: Mapping[str, float] = field(default_factory=dict)
    value: float = 0.0
    lower_bound: float = 0.0
    measure: Measure = "peak"
    unbalanced: Mapping[str, float]
    relative: Mapping[str, float]
    peak_angles: Mapping[str, float]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative peaks as bars, those with a weight darker."""
        ax = axes_or_new(ax)
        names = list(self.relative)
        counted = [self.weights.get(name, 0.0) > 0.0 for name in names]
        colours = ["tab:blue" if weighted else "lightsteelblue" for weighted in counted]
        words = [name.replace("_", " ") for name in names]
        bars = ax.bar(words, [self.relative[name] for name in names], color=colours)
        ax.bar_label(bars, fmt="%.3f", padding=2)
        ax.axhline(1.0, color="black", linewidth=0.8)
        ax.set(ylabel="peak over that of the unbalanced linkage", title="pale: without a weight")
        ax.tick_params(axis="x", rotation=20)
        return ax


def balance(
    machine: Machine,
    speed: float,
    *,
    acceleration: float = 0.0,
    weights: Mapping[str, float] | None = None,
    links: Sequence[str] | None = None,
    bounds: Bounds | Mapping[str, Bounds] | None = None,
    limits: Mapping[str, float] | None = None,
    angles: ArrayLike | None = None,
    measure: Measure = "peak",
    case: Case | None = None,
    offsets: Offsets = None,
    density: float | None = None,
    thickness: float | None = None,
    fraction: float = 0.5,
) -> Balancing:
    """Return the counterweights that make a weighted sum of peak forces least, or a classic case.

    Minimises ``sum of w_k max |F_k(theta)| / max |F_k,unbalanced(theta)|``.  All forces are linear
    in mass, first moments and inertia of a counterweight (Smith 4.4-4.6), so that the sum is convex
    in these.  The least sum over their convex hull, a second-order cone programme solved by
    Clarabel, is a lower bound that no start can mislead; from there SciPy's SLSQP descends among
    the counterweights themselves.

    Parameters
    ----------
    machine : Machine
        The unbalanced machine.
    speed : float
        Crank speed [rad/s].
    acceleration : float
        Crank acceleration [rad/s^2], the same at every angle.
    weights : mapping of str to float
        Any of shaking_force, shaking_moment, torque, f12, f23, f34, f41; by default 1 for f23 (the
        crank pin), torque and shaking_moment (the moment on the frame).
    links : sequence of str
        Links that may carry a counterweight each; by default those that turn about the frame.
    bounds : Bounds or mapping of str to Bounds
        Where the counterweights may be; by default no heavier than all links together and no
        further out than the link is long.
    limits : mapping of str to float
        Relative peaks that must not be passed, with or without a weight.
    angles : array_like
        Crank angles [rad] that count; by default a whole turn, peaks between samples included.
    measure : {"peak", "rms"}
        Count the root mean square of each force instead of its peak.
    case : {"a", "b", "c", "d", "reciprocating"}, optional
        A case of Smith's Fig. 20, or a slider-crank's crank alone, in place of the optimum; see
        :func:`~elastolink.runtime.rigid.case_counterweights`.
    offsets, density, thickness, fraction
        Of a case: distance of the counterweights from their pivots [m], cylinders [kg/m^3, m] in
        place of point masses, share of the reciprocating mass.

    Returns
    -------
    Balancing
        With the check "gap or KKT residual": proved the best, or at least stationary.  Of root mean
        squares the check "samples" is what they hang on the places of the samples.  Of cases (c)
        and (d) the check "shaking force left" is the peak that is left, over the unbalanced one.

    Raises
    ------
    BadInput
        If a name is unknown, a weight or bound impossible, a weighted force zero without
        counterweights, limits cannot be met, or the crank cannot turn and no angles are given; if
        there is no such case for the linkage, or a choice of the optimum stands beside a case.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> best = el.balance(machine, speed=10.0, weights={"torque": 1.0, "shaking_force": 1.0})
    >>> print({name: round(best.relative[name], 3) for name in ("torque", "shaking_force")})
    {'torque': 1.232, 'shaking_force': 0.234}
    """
    if case is None:
        search = _searched(
            machine, speed, acceleration, weights, links, bounds, limits, angles, measure
        )
        return _described(search, best_counterweights(search))
    beside = {"weights": weights, "links": links, "bounds": bounds, "limits": limits}
    for name, value in beside.items():
        if value is not None:
            raise bad(name, f"beside case {case!r}", "the optimum, without a case", "leave it out")
    added = case_counterweights(
        machine, case, offsets, density=density, thickness=thickness, fraction=fraction
    )
    speed, acceleration = finite_number(speed, "speed"), finite_number(acceleration, "acceleration")
    return _compared(ForceBasis(machine, speed, acceleration), case, added, angles)


def _compared(
    plain: ForceBasis, case: Case, added: Mapping[str, Counterweight], angles: ArrayLike | None
) -> Balancing:
    balanced = replace(plain, machine=with_counterweights(plain.machine, added.values()))
    unbalanced, _ = _sizes(plain.sampled(angles))
    after, where = _sizes(balanced.sampled(angles))
    relative = _relative(after, unbalanced)
    moved = []
    for pair in zip(_all_but_equal(plain), _all_but_equal(balanced), strict=True):
        before, then = (_sizes(each.sampled(angles))[0] for each in pair)
        moved.append([then[term] / before[term] for term in relative])
    checks = {}
    if case in ("c", "d") and "shaking_force" in relative:
        checks["shaking force left"] = Check(relative["shaking_force"], 1e-10)
    spread = float(np.max(np.ptp(moved, axis=0), initial=0.0))
    return Balancing(
        counterweights=added,
        machine=balanced.machine,
        unbalanced=unbalanced,
        relative=relative,
        peak_angles=where,
        method=f"case ({case}) in closed form",
        error=spread / max(relative.values(), default=1.0) + _DIGITS,
        error_norm="relative peaks, over the largest of them",
        checks=checks,
        provenance=provenance({"speed": repr(plain.speed)}),
    )


def _all_but_equal(basis: ForceBasis) -> Iterator[ForceBasis]:
    """Yield machines whose lengths are a few last digits away from one's."""
    linkage: Any = basis.machine.linkage
    for signs in _SIGNS:
        moved = {
            name: length * (1.0 + 0.5 * sign * _DIGITS)
            for (name, length), sign in zip(linkage.lengths.items(), signs, strict=False)
        }
        machine = replace(basis.machine, linkage=replace(linkage, **moved))
        yield replace(basis, machine=machine)


def _searched(
    machine: Machine,
    speed: float,
    acceleration: float,
    weights: Mapping[str, float] | None,
    links: Sequence[str] | None,
    bounds: Bounds | Mapping[str, Bounds] | None,
    limits: Mapping[str, float] | None,
    angles: ArrayLike | None,
    measure: Measure = "peak",
) -> Search:
    require_machine(machine)
    speed, acceleration = finite_number(speed, "speed"), finite_number(acceleration, "acceleration")
    require_one_of("measure", measure, ("peak", "rms"))
    wanted = _terms(DEFAULT_WEIGHTS if weights is None else weights, "weights", zero=True)
    tops = _terms({} if limits is None else limits, "limits", zero=False)
    wanted = {term: weight for term, weight in wanted.items() if weight > 0.0}
    if not wanted:
        raise bad("weights", "no weight above zero", "at least one", "give --weights torque=1")
    chosen = _links(machine, links)
    masses, lengths, stiffness = _units(machine, chosen, bounds)
    basis = ForceBasis(machine, speed, acceleration, chosen, masses, lengths, measure)
    basis = basis.sampled(angles)
    peaks, _ = _sizes(basis)
    search = Search(basis, peaks, Design(stiffness), wanted, tops)
    zero = _zero_forces(peaks)
    for term in search.terms:
        if term in zero:
            fix = "leave it out: it has no peak to compare with"
            raise bad(f"weights.{term}", "no such force without counterweights", "a force", fix)
    return search


def _described(search: Search, best: Candidate) -> Balancing:
    basis, p, added = search.basis, search.design.parameters(best.x), {}
    units = zip(basis.links, basis.masses, basis.lengths, search.design.stiffness, strict=True)
    for unit, (m, u, v) in zip(units, best.x.reshape(-1, 3), strict=True):
        link, mass, length, stiffness = unit
        # Inertia about the centre over mass is half the square of the radius.
        radius = length * np.sqrt(2.0 * stiffness * m)
        body = (m * mass, u * length, v * length, radius)
        if m > 0.0:
            added[link] = Counterweight(link, *map(float, body))
    balanced, where = _sizes(basis, p)
    relative = _relative(balanced, search.unbalanced)
    gap = (best.value - best.bound) / search.unit
    # Some last digits, of forces that have limits by what the limits are worth; and near a change
    # point, where forces hang on the last digits of the lengths, what some of these change.
    rounded = [_weighted(search, each, p) for each in _all_but_equal(basis)]
    rounding = (float(np.ptp(rounded)) + _DIGITS * best.slope) / search.unit + _DIGITS
    over = max((relative[term] / top - 1.0 for term, top in search.limits.items()), default=0.0)
    sampling = _sampling(search, p) / search.unit
    checks = {
        "gap or KKT residual": Check(min(gap, best.residual), _OPTIMAL),
        "limits passed, relative": Check(max(over, 0.0), 1e-7),
    }
    if basis.measure == "rms":
        checks["samples"] = Check(sampling, _SAMPLED)
    return Balancing(
        counterweights=added,
        machine=with_counterweights(basis.machine, added.values()),
        weights=dict(search.weights),
        limits=dict(search.limits),
        value=best.value,
        lower_bound=best.bound,
        unbalanced=search.unbalanced,
        measure=basis.measure,
        relative=relative,
        peak_angles=where,
        method="second-order cone programme over the convex hull, SLSQP within",
        error=gap + rounding + sampling,
        error_norm="weighted sum above the least possible one, over the unbalanced linkage's",
        error_kind="bound",
        checks=checks,
        provenance=provenance({"speed": repr(basis.speed)}),
    )


def _sampling(search: Search, p: Array) -> float:
    """Return what the weighted sum of root mean squares of a turn hangs on where its samples lie.

    Samples between the given ones are off by as much to the other side where they resolve the
    motion; where they do not, no two of four rows of samples agree.
    """
    basis = search.basis
    if not basis.whole or basis.measure != "rms":
        return 0.0
    step = float(basis.theta[1] - basis.theta[0])
    rows = [basis.theta + share * step for share in (0.0, 0.25, 0.5, 0.75)]
    return float(np.ptp([_weighted(search, replace(basis, theta=theta), p) for theta in rows]))


def _weighted(search: Search, basis: ForceBasis, p: Array) -> float:
    """Return the weighted sum of relative sizes, both sizes with the same basis."""
    before, after = (basis.sizes(each, tuple(search.weights)) for each in (None, p))
    return sum(
        weight * float(after[name][1].max()) / float(before[name][1].max())
        for name, weight in search.weights.items()
    )


def _sizes(basis: ForceBasis, p: Array | None = None) -> tuple[dict[str, float], dict[str, float]]:
    """Return the peak or root mean square of each force, and the angle of the peak."""
    sizes = basis.sizes(p)
    where = {term: float(at[int(np.argmax(size))]) for term, (at, size) in sizes.items()}
    return {term: float(size.max()) for term, (_, size) in sizes.items()}, where


def _relative(after: Mapping[str, float], before: Mapping[str, float]) -> dict[str, float]:
    zero = _zero_forces(before)
    return {term: after[term] / before[term] for term in TERMS if term not in zero}


def _zero_forces(peaks: Mapping[str, float]) -> set[str]:
    """Return the names of forces that are round-off: pins and shaking force, torque and moment."""
    moments = ("torque", "shaking_moment")
    forces = max(peaks[term] for term in TERMS if term not in moments)
    most = dict.fromkeys(TERMS, forces)
    most |= dict.fromkeys(moments, max(peaks[term] for term in moments))
    # A force below this, over the largest of its kind, is no force to compare with.
    return {term for term in TERMS if not peaks[term] > 1e-12 * most[term]}


def _terms(given: Mapping[str, float], where: str, *, zero: bool) -> dict[str, float]:
    require_mapping(where, given, 'say {"torque": 1.0}, for example')
    terms = {}
    for term, value in given.items():
        require_one_of(where, term, TERMS)
        number = finite_number(value, f"{where}.{term}")
        if number < 0.0 or (number == 0.0 and not zero):
            expected = "zero or more" if zero else "above zero"
            raise bad(f"{where}.{term}", f"{number:g}", expected, "correct it")
        terms[term] = number
    return terms


def _links(machine: Machine, links: Sequence[str] | None) -> tuple[str, ...]:
    moving = tuple(machine.linkage.links)
    if links is None:
        # The first and the last link are joined to the frame; a slider does not turn.
        return tuple(link for link in (moving[0], moving[-1]) if link != "slider")
    chosen = names_in_a_row("links", links)
    for link in chosen:
        require_one_of("links", link, [name for name in moving if name != "slider"])
    if not chosen or len(set(chosen)) != len(chosen):
        raise bad("links", repr(chosen), "different links, at least one", "correct the list")
    return chosen


def _units(
    machine: Machine, links: tuple[str, ...], bounds: Bounds | Mapping[str, Bounds] | None
) -> tuple[Array, Array, Array]:
    """Return greatest masses [kg] and offsets [m], and the stiffness of scaled counterweights."""
    bounds = Bounds() if bounds is None else bounds
    given = bounds if isinstance(bounds, Mapping) else dict.fromkeys(links, bounds)
    for link, each in given.items():
        require_one_of("bounds", link, links)
        if not isinstance(each, Bounds):
            raise bad("bounds", type(each).__name__, "Bounds", "give Bounds(mass=..., offset=...)")
    whole = sum(machine.mass(link).mass for link in machine.linkage.links)
    rows = []
    for link in links:
        each = given.get(link, Bounds())
        mass, offset = each.mass or whole, each.offset or machine.linkage.lengths.get(link)
        if not mass:
            raise bad(f"bounds.{link}", "a machine without mass", "a greatest mass", "give mass")
        if offset is None:
            raise bad(f"bounds.{link}", "no offset", "a greatest offset", "give offset")
        stiffness = 0.0
        if each.density is not None and each.thickness is not None:
            # Inertia of a cylinder over the square of its mass: 1/(2 pi h rho).
            stiffness = mass / (2.0 * np.pi * each.thickness * each.density * offset**2)
        rows.append((mass, offset, stiffness))
    masses, offsets, stiff = np.array(rows).T
    return masses, offsets, stiff


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

    arrays_along: ClassVar = {"point": "first_values second_values error"}

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
    offsets: Offsets = None,
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
        Of the marked cases, as :func:`balance`; (c) has a counterweight on the coupler, and may lie
        below a curve whose ``links`` have none.

    Returns
    -------
    TradeOff
        With the check "gap or KKT residual" for the worst point.

    Raises
    ------
    BadInput
        As :func:`balance`, and for equal or unknown forces, or another number of points.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> curve = el.trade_off(machine, speed=10.0, points=3)
    >>> print(curve.first_values.round(2), curve.second_values.round(2))
    [0.   0.35 0.7 ] [1.52 1.13 1.  ]
    """
    for name, term in (("first", first), ("second", second)):
        require_one_of(name, term, TERMS)
    if first == second:
        raise bad("second", repr(second), "another force than the first", "choose another")
    require_whole("points", points, 2, 1000)
    both = {first: 1.0, second: 1.0}
    search = _searched(machine, speed, acceleration, both, links, bounds, None, angles)
    (low, least), (high, _) = _end(search, first, second), _end(search, second, first)
    ends = [_described(search, end).relative[first] for end in (low, high)]
    bests = [low]
    inner = np.linspace(ends[0], ends[1], points)[1:-1]
    tops = [max(float(top), least + _ALLOWANCE) for top in inner]
    for top in tops:
        limited = replace(search, weights={second: 1.0}, limits={first: top})
        bests.append(best_counterweights(limited))
    bests.append(high)
    results = tuple(_described(search, one) for one in bests)
    values = [np.array([one.relative[term] for one in results]) for term in (first, second)]
    gaps = [one.value - one.bound for one in bests]
    # Each bound is that at a limit, which points pass by the last digits of the solver.
    passed = np.zeros(points)
    passed[1:-1] = np.maximum(values[0][1:-1] / tops - 1.0, 0.0)
    beyond = passed * [one.slope for one in bests]
    worst = max(min(gap, one.residual) for gap, one in zip(gaps, bests, strict=True))
    return TradeOff(
        first=first,
        second=second,
        first_values=values[0],
        second_values=values[1],
        points=results,
        cases=_cases(search.basis, offsets, angles, (first, second)),
        method="limits to the first peak; second-order cone programmes, SLSQP within",
        # Of points on which both peaks count: the second has the weight 1, and is relative already.
        error=np.array([search.unit * one.error for one in results]) + beyond,
        error_norm="second peak above the least possible one, absolute, entrywise",
        error_kind="bound",
        checks={"gap or KKT residual": Check(worst, _OPTIMAL)},
        provenance=provenance({"speed": repr(search.basis.speed)}),
    )


def _end(search: Search, term: str, other: str) -> tuple[Candidate, float]:
    """Return the least of the other peak where one is the least possible, and that one."""
    least = best_counterweights(replace(search, weights={term: 1.0})).value
    limits = {term: least + _ALLOWANCE}
    return best_counterweights(replace(search, weights={other: 1.0}, limits=limits)), least


def _cases(
    basis: ForceBasis, offsets: Offsets, angles: ArrayLike | None, terms: tuple[str, str]
) -> dict[str, tuple[float, float]]:
    peaks: dict[str, tuple[float, float]] = {}
    for case in CASES:
        try:
            added = case_counterweights(basis.machine, case, offsets)
        except BadInput:
            if offsets is not None and case != "d":
                raise
            # A slider-crank has no case (d), and a link without a length no default offset.
            continue
        relative = _compared(basis, case, added, angles).relative
        peaks[case] = relative[terms[0]], relative[terms[1]]
    return peaks
