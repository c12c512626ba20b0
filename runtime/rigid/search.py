"""Search for the best counterweights: hull, realisation, descent, with the true peaks exchanged in.

The peaks between sampled angles are found at each optimum and join the problem (Remez's exchange),
until none is higher than the bound that the problem has for it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from ..core.errors import BadInput, bad
from .barrier import PER_LINK, Array, Cones, HullOptimum, PeakProblem, Room, hull_minimum
from .descent import Descent, local_minimum
from .designs import PointDesign
from .force_basis import ForceBasis

Measure: TypeAlias = Literal["peak", "rms"]

_ROUNDS = (1e-3, 1e-5, *([1e-7] * 8))
_EXCESS = 1e-11
_HULL_EXCESS = 1e-8
_GAP = 1e-9
_UNFELT = 1e-9
_COARSE = 16  # samples between the angles that a descent starts with


@dataclass(frozen=True)
class Found:
    """Best counterweights: design variables, value, proved lower bound, KKT residual."""

    x: Array
    value: float
    bound: float
    residual: float


@dataclass(frozen=True)
class Search:
    """Everything about one search that stays as it is.

    Attributes
    ----------
    basis : ForceBasis
        The forces that count.
    theta : ndarray
        Sampled angles.
    between : bool
        True where peaks between the samples count.
    scales : mapping of str to float
        Peaks of the unbalanced linkage.
    rooms : sequence of Room
        One for each link of the basis.
    weights, limits : mapping of str to float
        Of the relative peaks.
    measure : {"peak", "rms"}
        What counts of each force: its peak, or its root mean square over the sampled angles, which
        is the length of one long vector.
    """

    basis: ForceBasis
    theta: Array
    between: bool
    scales: Mapping[str, float]
    rooms: Sequence[Room]
    weights: Mapping[str, float]
    limits: Mapping[str, float]
    measure: Measure = "peak"

    @property
    def terms(self) -> tuple[str, ...]:
        """Forces with a weight or a limit, in the order of the basis."""
        used = {*self.weights, *self.limits}
        return tuple(term for term in self.basis.terms if term in used)

    @property
    def unit(self) -> float:
        """Weighted sum of the relative peaks of the unbalanced linkage."""
        return sum(self.weights.values())

    def cones(self, theta: Mapping[str, Array]) -> list[Cones]:
        """Return relative forces at angles of each term's own."""
        terms = self.terms
        joined = np.concatenate([theta[term] for term in terms])
        fixed, unit = self.basis.forces(joined), self.basis.unit_forces(joined)
        found, place = [], 0
        for k, term in enumerate(terms):
            rows = slice(place, place + len(theta[term]))
            parts = (fixed[term][rows] / self.scales[term], unit[term][rows] / self.scales[term])
            found.append(Cones(k, *(parts if self.measure == "peak" else _mean_square(*parts))))
            place += len(theta[term])
        return found

    def problem(self, theta: Mapping[str, Array]) -> PeakProblem:
        """Return the problem with the peaks at given angles."""
        terms = self.terms
        cost = np.array([float(self.weights.get(term, 0.0)) for term in terms])
        tops = np.array([float(self.limits.get(term, np.inf)) for term in terms])
        return PeakProblem(self.rooms, self.cones(theta), cost, tops)

    def peaks(self, p: Array) -> dict[str, tuple[Array, Array]]:
        """Return angles and relative sizes of the highest peaks with parameters p.

        The root mean square counts as one peak, at the first of the angles.
        """
        if self.measure == "rms":
            forces = self.basis.forces(self.theta, p)
            return {
                term: (self.theta[:1], np.array([rms(force) / self.scales[term]]))
                for term, force in forces.items()
            }
        found = self.basis.peaks(self.theta, p, self.between)
        return {term: (at, size / self.scales[term]) for term, (at, size) in found.items()}

    def value(self, peaks: Mapping[str, tuple[Array, Array]]) -> float:
        """Return the weighted sum of relative peaks."""
        return sum(w * float(peaks[term][1].max()) for term, w in self.weights.items())

    def broken(self, peaks: Mapping[str, tuple[Array, Array]]) -> float:
        """Return how far a peak is above its limit, over the limit."""
        over = [float(peaks[term][1].max()) / top - 1.0 for term, top in self.limits.items()]
        return max(over, default=0.0)

    def sampled(self, step: int = 1) -> dict[str, Array]:
        """Return the sampled angles for every term."""
        return dict.fromkeys(self.terms, self.theta[::step])

    def exchanged(
        self, problem: PeakProblem, peaks: Mapping[str, tuple[Array, Array]], t: Array
    ) -> PeakProblem:
        """Return the problem with the high peaks among its angles."""
        chosen = {}
        for k, term in enumerate(self.terms):
            at, size = peaks[term]
            high = size >= (1.0 - 1e-3) * t[k]
            chosen[term] = at[high] if np.any(high) else at[[int(np.argmax(size))]]
        more = self.cones(chosen)
        both = [a.joined(b.fixed, b.basis) for a, b in zip(problem.cones, more, strict=True)]
        return replace(problem, cones=both)

    def excess(self, peaks: Mapping[str, tuple[Array, Array]], t: Array) -> float:
        """Return how far a peak is above its bound t, over the bound."""
        terms = self.terms
        above = [float(peaks[term][1].max()) / float(t[k]) - 1.0 for k, term in enumerate(terms)]
        return max(above)


def rms(force: Array) -> float:
    """Return the root mean square of the magnitudes of a force (n, d)."""
    return float(np.sqrt(np.mean(np.sum(force * force, axis=1))))


def _mean_square(fixed: Array, basis: Array) -> tuple[Array, Array]:
    """Return one force of a few components whose magnitude is the root mean square of many."""
    count = basis.shape[-1]
    columns = np.concatenate([basis, fixed[..., None]], axis=-1).reshape(-1, count + 1)
    short = np.asarray(np.linalg.qr(columns / np.sqrt(len(fixed)), mode="r"))
    return short[None, :, count], short[None, :, :count]


def hull(search: Search) -> tuple[HullOptimum, PeakProblem]:
    """Return the optimum over the convex hull, true peaks included.

    Raises
    ------
    BadInput
        If no counterweights meet the limits.
    """
    problem = search.problem(search.sampled())
    bound = 0.0  # no sum of magnitudes is less
    for tolerance in _ROUNDS:
        optimum = hull_minimum(problem, _inside(search, problem), tolerance)
        bound = max(bound, optimum.bound)
        if not search.between:
            if tolerance == _ROUNDS[-1]:
                break
            continue
        peaks = search.peaks(optimum.p)
        if tolerance == _ROUNDS[-1] and search.excess(peaks, optimum.t) < _HULL_EXCESS:
            break
        problem = search.exchanged(problem, peaks, optimum.t)
    return replace(optimum, bound=bound), problem


def _inside(search: Search, problem: PeakProblem) -> tuple[Array, Array] | None:
    """Return a start below the limits, by the least greatest ratio of peaks to limits."""
    if not search.limits:
        return None
    capped = [cone for cone in problem.cones if np.isfinite(problem.ceilings[cone.bound])]
    shared = []
    for cone in capped:
        top = problem.ceilings[cone.bound]
        shared.append(Cones(0, cone.fixed / top, cone.basis / top))
    ratio = PeakProblem(problem.rooms, shared, np.ones(1), np.full(1, np.inf))
    for tolerance in (1e-4, 1e-6, 1e-8):
        least = hull_minimum(ratio, tolerance=tolerance)
        if least.t[0] < 1.0 or least.bound >= 1.0:
            break
    if least.t[0] >= 1.0:
        raise _out_of_reach(search.limits, max(least.bound, 1.0))
    # As far towards the middle of the hulls as the limits allow, halfway.
    p, ceiling = least.p, 0.5 * (1.0 + least.t[0])
    for share in np.linspace(0.9, 0.0, 10):
        trial = share * problem.centre() + (1.0 - share) * least.p
        if ratio.lifted(trial, 0.0)[0] <= ceiling:
            p = trial
            break
    t, tops = problem.lifted(p, 0.0), problem.ceilings
    return p, np.where(np.isfinite(tops), 0.5 * (t + np.minimum(tops, 1e300)), 1.5 * t)


def _out_of_reach(limits: Mapping[str, float], times: float) -> BadInput:
    """Return the complaint about limits that can be met only so many times higher."""
    names = ", ".join(f"{term} {top:g}" for term, top in limits.items())
    # Rounded up: what is asked for can be given.
    least = [f"{term} at least {_rounded_up(times * top)}" for term, top in limits.items()]
    together = "" if len(limits) == 1 else " where all are raised alike"
    fix = "raise a limit, or allow more mass or offset"
    return bad("limits", names, ", ".join(least) + together, fix)


def _rounded_up(value: float) -> str:
    """Return a number in four digits, none below it."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 3)
    return f"{math.ceil(value / unit) * unit:.4g}"


def best_counterweights(search: Search) -> Found:
    """Return the best counterweights that are known, and the proof of how good they are.

    Raises
    ------
    BadInput
        If no counterweights meet the limits.
    """
    optimum, problem = hull(search)
    design = PointDesign(search.rooms)
    unfelt = _unfelt(problem)
    start = design.realised(optimum.p, unfelt)
    candidates = [_descended(search, design, start)]
    bound = max(optimum.bound, candidates[0].bound)
    if candidates[0].value - bound > _GAP * search.unit:
        candidates += [_descended(search, design, x) for x in _starts(design)]
    chosen = min(candidates, key=lambda found: found.value)
    bound = max(bound, *(found.bound for found in candidates))
    x = _lightened(search, design, chosen.x, unfelt)
    value = search.value(search.peaks(design.parameters(x)))
    return Found(x, value, min(bound, value), chosen.residual)


def _starts(design: PointDesign) -> list[Array]:
    """Return further starts, the same ones each time: nothing, and four directions."""
    low, high = design.box
    nothing = np.clip(np.zeros(len(low)), low, high)
    found = [nothing]
    for u, v in ((-0.7, 0.0), (0.7, 0.0), (0.0, 0.7), (0.0, -0.7)):
        p = []
        for _ in design.rooms:
            p += [0.5, 0.5 * u, 0.5 * v, 0.25]
        found.append(design.realised(np.array(p), [False] * len(design.rooms)))
    return found


def _descended(search: Search, design: PointDesign, x: Array) -> Descent:
    """Return the local optimum near x, true peaks included, or x itself where it is no worse."""
    problem = search.problem(search.sampled(_COARSE if search.between else 1))
    peaks = search.peaks(design.parameters(x))
    at_start = Descent(x, np.zeros(0), _penalised(search, peaks), np.inf, -np.inf)
    t = np.array([float(peaks[term][1].max()) for term in search.terms])
    best = at_start
    for _ in range(len(_ROUNDS)):
        if search.between:
            problem = search.exchanged(problem, peaks, t)
        found = local_minimum(problem, design, x)
        x, t = found.x, found.t
        peaks = search.peaks(design.parameters(x))
        found = replace(found, value=_penalised(search, peaks), bound=max(found.bound, best.bound))
        best = (
            found
            if found.value <= best.value + 1e-12 * search.unit
            else replace(best, bound=found.bound)
        )
        if not search.between or search.excess(peaks, t) < _EXCESS:
            break
    return best


def _penalised(search: Search, peaks: Mapping[str, tuple[Array, Array]]) -> float:
    """Return the value; infinite where a limit is passed by more than round-off."""
    return search.value(peaks) if search.broken(peaks) < 1e-8 else float(np.inf)


def _unfelt(problem: PeakProblem) -> list[bool]:
    """Return for each link whether nothing but the first moments of its counterweight matters."""
    found = []
    for i in range(len(problem.rooms)):
        columns = [PER_LINK * i, PER_LINK * i + 3]
        felt = max(float(np.max(np.abs(cone.basis[:, :, columns]))) for cone in problem.cones)
        found.append(felt < _UNFELT)
    return found


def _lightened(search: Search, design: PointDesign, x: Array, unfelt: Sequence[bool]) -> Array:
    """Return the design with the least mass that serves as well."""
    value = search.value(search.peaks(design.parameters(x)))
    lighter = design.realised(design.parameters(x), unfelt)
    place = 0
    for room in search.rooms:
        size = 3 + (room.own > 0.0)
        for trial in (lighter[place : place + size], np.zeros(size)):
            changed = x.copy()
            changed[place : place + size] = trial
            if changed[place] >= x[place]:
                continue
            peaks = search.peaks(design.parameters(changed))
            if _penalised(search, peaks) <= value + 1e-12 * search.unit:
                x = changed
        place += size
    return x
