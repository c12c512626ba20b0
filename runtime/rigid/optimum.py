"""The best counterweights for a weighted sum of peak forces, within bounds, with a proof."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.results import Check, Result, provenance
from .barrier import PER_LINK, Array, Room
from .bounds import Bounds, required_bounds
from .cases import Case, case_counterweights
from .counterweights import (
    Counterweight,
    finite_number,
    require_link,
    require_machine,
    with_counterweights,
)
from .force_basis import TERMS, ForceBasis
from .masses import MassDistribution
from .search import Found, Measure, Search, best_counterweights, rms

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import Machine

# The force in the crank pin, the driving torque and the moment on the frame, equally weighted.
DEFAULT_WEIGHTS: Mapping[str, float] = {"f23": 1.0, "torque": 1.0, "shaking_moment": 1.0}

# A force below this, over the largest of its kind, is no force to compare with.
_NO_FORCE = 1e-12
_ROUND_OFF = 2e-14
_OPTIMAL = 1e-5


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
        Of the relative peaks, as given.
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
    weights: Mapping[str, float]
    limits: Mapping[str, float] = field(default_factory=dict)
    value: float
    lower_bound: float
    measure: Measure
    unbalanced: Mapping[str, float]
    relative: Mapping[str, float]
    peak_angles: Mapping[str, float]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative peaks as bars, those with a weight darker."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        names = list(self.relative)
        counted = [self.weights.get(name, 0.0) > 0.0 for name in names]
        colours = ["tab:blue" if weighted else "lightsteelblue" for weighted in counted]
        bars = ax.bar(names, [self.relative[name] for name in names], color=colours)
        ax.bar_label(bars, fmt="%.3f", padding=2)
        ax.axhline(1.0, color="black", linewidth=0.8)
        ax.set_ylabel("peak over that of the unbalanced linkage")
        ax.set_title("pale: without a weight")
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
) -> Balancing:
    """Return the counterweights that make a weighted sum of peak forces least.

    Minimises ``sum of w_k max |F_k(theta)| / max |F_k,unbalanced(theta)|``.  All forces are linear
    in mass, first moments and inertia of a counterweight (Smith 4.4-4.6), so that the sum is convex
    in these.  Their convex hull is searched first (barrier method: no start can mislead it), then
    the counterweights themselves, to the last digit, from the answer.

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

    Returns
    -------
    Balancing
        With the check "gap or KKT residual": proved the best, or at least stationary.

    Raises
    ------
    BadInput
        If a name is unknown, a weight or bound impossible, a weighted force zero without
        counterweights, limits cannot be met, or the crank cannot turn and no angles are given.
    """
    search, all_terms = searched(
        machine, speed, acceleration, weights, links, bounds, limits, angles, measure
    )
    found = best_counterweights(search)
    return described(machine, search, all_terms, found)


def searched(
    machine: Machine,
    speed: float,
    acceleration: float,
    weights: Mapping[str, float] | None,
    links: Sequence[str] | None,
    bounds: Bounds | Mapping[str, Bounds] | None,
    limits: Mapping[str, float] | None,
    angles: ArrayLike | None,
    measure: Measure = "peak",
) -> tuple[Search, ForceBasis]:
    """Return the search that :func:`balance` makes, and the basis of every force.

    Raises
    ------
    BadInput
        As :func:`balance`.
    """
    require_machine(machine)
    speed, acceleration = finite_number(speed, "speed"), finite_number(acceleration, "acceleration")
    if measure not in ("peak", "rms"):
        raise bad("measure", repr(measure), "'peak' or 'rms'", "choose one")
    wanted = _terms(DEFAULT_WEIGHTS if weights is None else weights, "weights", zero=True)
    tops = _terms(limits or {}, "limits", zero=False)
    if not any(wanted.values()):
        raise bad("weights", "no weight above zero", "at least one", "give --weights torque=1")
    wanted = {term: weight for term, weight in wanted.items() if weight > 0.0}
    chosen = _links(machine, links)
    rooms, masses, lengths = _rooms(machine, chosen, bounds)
    terms = tuple(term for term in TERMS if term in wanted or term in tops)
    everything = ForceBasis(machine, chosen, speed, acceleration, TERMS, masses, lengths)
    theta, between = _angles(machine, everything, angles)
    nothing = np.zeros(PER_LINK * len(chosen))
    peaks = _sizes(everything, theta, nothing, between, measure)[0]
    zero = _zero_forces(peaks)
    for term in terms:
        if term in zero:
            fix = "leave it out: it has no peak to compare with"
            raise bad(f"weights.{term}", "no such force without counterweights", "a force", fix)
    basis = ForceBasis(machine, chosen, speed, acceleration, terms, masses, lengths)
    scales = {term: peaks[term] for term in terms}
    # A mean over the samples has no peaks between them.
    between = between and measure == "peak"
    return Search(basis, theta, between, scales, rooms, wanted, tops, measure), everything


def _sizes(
    basis: ForceBasis, theta: Array, p: Array, between: bool, measure: Measure
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the peak or root mean square of each force, and the angle of the peak."""
    found = basis.peaks(theta, p, between)
    where = {term: float(at[int(np.argmax(size))]) for term, (at, size) in found.items()}
    if measure == "rms":
        return {term: rms(force) for term, force in basis.forces(theta, p).items()}, where
    return {term: float(size.max()) for term, (_, size) in found.items()}, where


def described(machine: Machine, search: Search, everything: ForceBasis, found: Found) -> Balancing:
    """Return the result for what a search found."""
    added = _counterweights(search, found.x)
    balanced = with_counterweights(machine, added.values())
    p = _parameters(search, added)
    sampling = (search.between, search.measure)
    unbalanced, _ = _sizes(everything, search.theta, np.zeros_like(p), *sampling)
    balanced_sizes, where = _sizes(everything, search.theta, p, *sampling)
    zero = _zero_forces(unbalanced)
    gap = (found.value - found.bound) / search.unit
    over = search.broken(search.peaks(p))
    return Balancing(
        counterweights=added,
        machine=balanced,
        weights=dict(search.weights),
        limits=dict(search.limits),
        value=found.value,
        lower_bound=found.bound,
        unbalanced=unbalanced,
        measure=search.measure,
        relative={t: balanced_sizes[t] / unbalanced[t] for t in TERMS if t not in zero},
        peak_angles=where,
        method="barrier over the convex hull, SLSQP and Newton on the KKT conditions",
        error=max(gap, _ROUND_OFF),
        error_norm="weighted sum above the least possible one, over the unbalanced linkage's",
        error_kind="bound",
        checks={
            "gap or KKT residual": Check(min(gap, found.residual), _OPTIMAL),
            "limits passed, relative": Check(max(over, 0.0), 1e-7),
        },
        provenance=provenance({"speed": repr(everything.speed)}),
    )


def peaks_of(
    machine: Machine,
    speed: float,
    acceleration: float = 0.0,
    angles: ArrayLike | None = None,
) -> dict[str, float]:
    """Return the peak of every force over a turn of the crank [N; N m], between samples too.

    Parameters
    ----------
    machine : Machine
        With or without counterweights.
    speed, acceleration : float
        Of the crank [rad/s, rad/s^2].
    angles : array_like
        Crank angles [rad] that count instead.

    Raises
    ------
    BadInput
        As :func:`balance`.
    """
    return {
        term: size for term, (size, _) in _turn_peaks(machine, speed, acceleration, angles).items()
    }


def _turn_peaks(
    machine: Machine, speed: float, acceleration: float, angles: ArrayLike | None
) -> dict[str, tuple[float, float]]:
    """Return peak and its angle for every force."""
    require_machine(machine)
    speed, acceleration = finite_number(speed, "speed"), finite_number(acceleration, "acceleration")
    one = np.ones(1)
    link = tuple(machine.linkage.links[:1])
    basis = ForceBasis(machine, link, speed, acceleration, TERMS, one, one)
    theta, between = _angles(machine, basis, angles)
    found = basis.peaks(theta, np.zeros(PER_LINK), between)
    return {
        term: (float(size.max()), float(at[int(np.argmax(size))]))
        for term, (at, size) in found.items()
    }


def _zero_forces(peaks: Mapping[str, float]) -> set[str]:
    """Return the names of forces that are round-off: pins and shaking force, torque and moment."""
    moments = ("torque", "shaking_moment")
    forces = max(peaks[term] for term in TERMS if term not in moments)
    most = {term: forces for term in TERMS}
    most |= dict.fromkeys(moments, max(peaks[term] for term in moments))
    return {term for term in TERMS if not peaks[term] > _NO_FORCE * most[term]}


def _counterweights(search: Search, x: Array) -> dict[str, Counterweight]:
    """Return the counterweights of design variables; none where the mass is zero."""
    added, place = {}, 0
    for i, (link, room) in enumerate(zip(search.basis.links, search.rooms, strict=True)):
        m, u, v = (float(item) for item in x[place : place + 3])
        q = float(x[place + 3]) if room.own > 0.0 else 0.0
        place += 3 + (room.own > 0.0)
        if m <= 0.0:
            continue
        mass, length = float(search.basis.masses[i]), float(search.basis.lengths[i])
        # Own inertia over mass is half the square of the radius.
        radius = length * float(np.sqrt(2.0 * (q + room.stiffness * m)))
        added[link] = Counterweight(link, m * mass, u * length, v * length, radius)
    return added


def _parameters(search: Search, added: Mapping[str, Counterweight]) -> Array:
    p: list[float] = []
    for i, link in enumerate(search.basis.links):
        body = added[link].distribution if link in added else MassDistribution()
        mass, length = float(search.basis.masses[i]), float(search.basis.lengths[i])
        moment = mass * length
        p += [body.mass / mass, body.along / moment, body.across / moment]
        p.append(body.inertia / (moment * length))
    return np.array(p)


def _terms(given: Mapping[str, float], where: str, *, zero: bool) -> dict[str, float]:
    found = {}
    for term, value in given.items():
        if term not in TERMS:
            raise bad(where, repr(term), f"one of {', '.join(TERMS)}", "correct the name")
        number = finite_number(value, f"{where}.{term}")
        if number < 0.0 or (number == 0.0 and not zero):
            expected = "zero or more" if zero else "above zero"
            raise bad(f"{where}.{term}", f"{number:g}", expected, "correct it")
        found[term] = number
    return found


def _links(machine: Machine, links: Sequence[str] | None) -> tuple[str, ...]:
    own = tuple(machine.linkage.links)
    if links is None:
        # The first and the last link are joined to the frame; a slider does not turn.
        return tuple(link for link in (own[0], own[-1]) if link != "slider")
    chosen = (links,) if isinstance(links, str) else tuple(links)
    for link in chosen:
        require_link(link, tuple(name for name in own if name != "slider"), "links")
    if not chosen or len(set(chosen)) != len(chosen):
        raise bad("links", repr(chosen), "different links, at least one", "correct the list")
    return chosen


def _rooms(
    machine: Machine, links: tuple[str, ...], bounds: Bounds | Mapping[str, Bounds] | None
) -> tuple[list[Room], Array, Array]:
    rooms, masses, lengths = [], [], []
    for own in required_bounds(machine, links, bounds).values():
        mass, offset = own.required_mass, own.required_offset
        own_inertia = own.inertia_over_square * mass / offset**2
        half = 0.5 * (own.radius / offset) ** 2
        rooms.append(Room(own.least_offset / offset, own_inertia, half))
        masses.append(mass)
        lengths.append(offset)
    return rooms, np.array(masses), np.array(lengths)


def _angles(machine: Machine, basis: ForceBasis, angles: ArrayLike | None) -> tuple[Array, bool]:
    if angles is not None:
        try:
            theta = np.asarray(angles, dtype=float).ravel()
        except (TypeError, ValueError) as refusal:
            raise bad("angles", repr(angles)[:60], "angles [rad]", "correct it") from refusal
        if theta.size == 0 or not np.all(np.isfinite(theta)):
            raise bad("angles", "nothing or not finite", "finite angles [rad]", "correct it")
        return theta, False
    if not machine.linkage.crank_turns:
        fix = "give angles that the crank can reach"
        raise bad("angles", "a crank that cannot turn fully", "angles [rad]", fix)
    return basis.grid(), True


def compare_case(
    machine: Machine,
    case: Case,
    speed: float,
    offsets: float | Mapping[str, float] | None = None,
    *,
    acceleration: float = 0.0,
    angles: ArrayLike | None = None,
    density: float | None = None,
    thickness: float | None = None,
) -> Balancing:
    """Return what a case of Smith's Fig. 20 does to every peak force.

    Parameters
    ----------
    machine, case, offsets, density, thickness
        As :func:`balance_case`.
    speed, acceleration, angles
        As :func:`balance`.

    Returns
    -------
    Balancing
        Without weights: nothing was optimised.  The check "shaking force left" of (c) and (d) is
        the peak that is left, over the unbalanced one.

    Raises
    ------
    BadInput
        As :func:`balance_case` and :func:`balance`.
    """
    added = case_counterweights(machine, case, offsets, density=density, thickness=thickness)
    balanced = with_counterweights(machine, added.values())
    before = _turn_peaks(machine, speed, acceleration, angles)
    after = _turn_peaks(balanced, speed, acceleration, angles)
    unbalanced = {term: size for term, (size, _) in before.items()}
    zero = _zero_forces(unbalanced)
    relative = {t: after[t][0] / unbalanced[t] for t in TERMS if t not in zero}
    checks = {}
    if case in ("c", "d") and "shaking_force" in relative:
        checks["shaking force left"] = Check(relative["shaking_force"], 1e-10)
    return Balancing(
        counterweights=added,
        machine=balanced,
        weights={},
        value=0.0,
        lower_bound=0.0,
        measure="peak",
        unbalanced=unbalanced,
        relative=relative,
        peak_angles={term: angle for term, (_, angle) in after.items()},
        method=f"case ({case}) in closed form",
        error=_ROUND_OFF,
        error_norm="relative peaks, over the largest of them",
        checks=checks,
        provenance=provenance({"speed": repr(float(speed))}),
    )
