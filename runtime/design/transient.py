"""A linkage of beams that is run up, or down, through its critical speeds (Aannaque 7.5).

While a length of the ground changes in time, the arrays are cubic polynomials of it between the
levels at which the structure is made.  Straight lines would not do: halfway between two directions
of a link the mean of its stiffness matrices holds it across as a spring of a part of its axial
stiffness would.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from numbers import Real
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..beams.assembly import in_own_axes, products
from ..beams.element_forms import required_structure
from ..beams.elements import shapes_of
from ..core.collocation import gauss_maps
from ..core.errors import LINEAR_RANGE, Problem, bad, refuse, warn_of_large_deflection
from ..core.families import DAMPING, MATRICES, VECTORS, LinearPeriodic, require_system
from ..core.inputs import is_one_of, is_whole, require_whole
from ..core.maxima import turned_by_parabolas
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..frequencies.held import held_frequencies
from ..periodic import steady_state
from ..periodic.reduced import ReducedSystem, reduced_system
from .speed_profile import Array, SpeedProfile

# Forces of inertia and loads, with the power of the speed.
FORCES = {"f": 2, "h": 1, "p": 0}


class Drive(NamedTuple):
    """Crank angle, speed and acceleration at points of time, ``(nt,)`` each."""

    angle: Array
    speed: Array
    acceleration: Array

    @classmethod
    def of(cls, profile: SpeedProfile, time: Array) -> Drive:
        """Return those of a profile."""
        return cls(profile.angle(time), profile.speed(time), profile.acceleration(time))

    def force(self, arrays: Mapping[str, Array]) -> Array:
        """Return the generalised forces ``td^2 f + td h + p + tdd g``, ``(nt, n)``."""
        total = np.zeros(arrays["K"].shape[:2])
        for name, power in FORCES.items():
            if name in arrays:
                total += self.speed[:, None] ** power * arrays[name]
        if "g" in arrays:
            total += self.acceleration[:, None] * arrays["g"]
        return total


def arrays_of(
    system: LinearPeriodic, drive: Drive, only: Collection[str] | None = None
) -> dict[str, Array]:
    """Return the arrays of a system, or some, along a drive, their powers of the speed included.

    By name, ``(nt, n, n)`` or ``(nt, n)``; those without a term are left out.
    """
    names = [name for name in only or MATRICES + VECTORS if system.has(name)]
    return {name: system.array(name, drive.angle, drive.speed) for name in names}


def generator_of(arrays: Mapping[str, Array], drive: Drive) -> Array:
    """Return L of ``y' = L y`` in time, y = (q, p = M qd + td A q, 1): ``(nt, 2n + 1, 2n + 1)``."""
    count, size, _ = arrays["M"].shape
    speed, acceleration = drive.speed[:, None, None], drive.acceleration[:, None, None]
    none = np.zeros((count, size, size))
    inverse = np.linalg.inv(arrays["M"])
    drift = speed * arrays.get("A", none)
    back = inverse @ drift
    restoring = arrays.get("K", none) + arrays.get("Kg", none)
    restoring = restoring - speed**2 * arrays.get("B", none)
    restoring = restoring - acceleration * arrays.get("S", none)
    if any(name in arrays for name in DAMPING):
        restoring = restoring + speed * arrays.get("D", none)
    push = np.swapaxes(drift, -1, -2) - arrays.get("C", none)
    found = np.zeros((count, 2 * size + 1, 2 * size + 1))
    found[:, :size, :size] = -back
    found[:, :size, size:-1] = inverse
    found[:, size:-1, :size] = -push @ back - restoring
    found[:, size:-1, size:-1] = push @ inverse
    found[:, size:-1, -1] = drive.force(arrays)
    return found


def march(generator: Callable[[Array], Array], edges: Array, start: Array, stages: int) -> Array:
    """Return the states at even times, ``(nt, m)``, by Gauss-Legendre collocation.

    The generator maps times to L of ``y' = L y``.  A-stable: modes far faster than the steps are
    damped or kept, never amplified, and not resolved.
    """
    step = edges[1] - edges[0]
    # Steps whose stage equations, two million numbers, are solved together.
    block = max(1, 2_000_000 // (stages * len(start)) ** 2)
    states = np.empty((len(edges), len(start)))
    states[0] = start
    for first in range(0, len(edges) - 1, block):
        maps = gauss_maps(stages, generator, edges[first:-1][:block], step)
        for k, matrix in enumerate(maps, first):
            states[k + 1] = matrix @ states[k]
    return states


# Levels whose cubic holds between the middle two, or beside the ends.
_STENCIL = 4

ByName = Mapping[str, Array]
Places = NDArray[np.intp]


class ChangingLength:
    """A structure at even levels of a length that changes, four or more, and what is between.

    The length is one of the ground, so that no beam's own changes; the crank turns at every level.
    """

    def __init__(
        self, system: LinearPeriodic, profile: SpeedProfile, name: str, count: int
    ) -> None:
        values = profile.geometry[name]
        self.profile, self.name = profile, name
        self.places = np.linspace(min(values), max(values), count)
        self.made = [system.with_geometry(**{name: float(place)}) for place in self.places]
        own = [placed.length for placed in required_structure(system).elements]
        for one in (self.made[0], self.made[-1]):
            lengths = [placed.length for placed in required_structure(one).elements]
            if not np.allclose(lengths, own, rtol=1e-12, atol=0.0):
                fix = "change one of the ground, such as frame"
                found = f"{name}, the length of a beam"
                raise bad("profile.geometry", found, "a length that no beam has", fix)

    def arrays(self, drive: Drive, time: Array) -> dict[str, Array]:
        """Return the arrays of the system at points of time, by name."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            return arrays_of(system, Drive(*(part[own] for part in drive)))

        return self._between(time, find)

    def directions(self, angle: Array, time: Array) -> dict[str, Array]:
        """Return cosine and sine of each link's angle, ``(nt, 2)`` by link."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            motion = required_structure(system).configuration(angle[own])
            return {link: products(each.angle)[:, 1:3] for link, each in motion.items()}

        return self._between(time, find)

    def deflections(self, angle: Array, time: Array) -> Array:
        """Return the rows of the deflections over the links' lengths, ``(nt, k, n)``."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            return {"rows": np.asarray(system.deflection_rows(angle[own]))}

        return self._between(time, find)["rows"]

    def _between(
        self, time: Array, find: Callable[[LinearPeriodic, Places], ByName]
    ) -> dict[str, Array]:
        """Return what is found at the levels about each point of time, by Lagrange's cubic."""
        places = self.places
        at = np.clip(self.profile.lengths(self.name, time), places[0], places[-1])
        position = (at - places[0]) / (places[1] - places[0])
        first = np.clip(position.astype(int) - 1, 0, len(places) - _STENCIL)
        cubics = np.linalg.inv(np.vander(np.arange(float(_STENCIL))))
        weights = np.vander(position - first, _STENCIL) @ cubics
        total: dict[str, Array] = {}
        for k in range(int(np.min(first)), int(np.max(first)) + _STENCIL):
            own = np.flatnonzero((first <= k) & (k < first + _STENCIL))
            if not own.size:
                continue
            weight = weights[own, k - first[own]]
            for name, value in find(self.made[k], own).items():
                if name not in total:
                    total[name] = np.zeros((len(time), *value.shape[1:]))
                total[name][own] += value * weight.reshape(-1, *(1,) * (value.ndim - 1))
        return total


_STAGES = 3
# Steps whose motion and stresses are recovered together.
_CHUNK = 512
# Modes that are added to see what the others would change.
_MORE = 3
_MOST_STEPS = 200_000
# Coordinates that are followed without a reduction; their steps leave the axial modes unresolved.
_FOLLOWED = 5


@dataclass(frozen=True, kw_only=True)
class Transient(Result):
    """Motion of a linkage of beams while its crank speed changes.

    ``error`` is that of the largest stress of each link over the whole run, relative: halved
    steps, what may lie between them, more modes of a reduced system, and more levels of a length
    that changes tell it.  Mesh and choice of stations are not in it.

    Attributes
    ----------
    time, angle, speed : ndarray, shape (nt,)
        Time [s], crank angle [rad] and speed [rad/s].
    q, qd : ndarray, shape (nt, n)
        Coordinates of the structure and their time derivatives [1/s].
    links : tuple of str
        Links.
    stress : ndarray, shape (nt, links)
        Largest size of the stress over each link's stations and fibres [Pa], of the steps from a
        sample up to the next.
    profile : SpeedProfile
        The drive.
    """

    time: Array
    angle: Array
    speed: Array
    q: Array
    qd: Array
    links: tuple[str, ...]
    stress: Array
    profile: SpeedProfile = field(repr=False)

    arrays_along: ClassVar = {
        "sample": "time angle speed",
        "sample coordinate": "q qd",
        "sample link": "stress",
        "link": "error",
    }
    column_units: ClassVar = {"1/s": "qd", "Pa": "stress"}

    @property
    def largest(self) -> dict[str, float]:
        """Largest stress of each link [Pa]."""
        return dict(zip(self.links, np.max(self.stress, axis=0).tolist(), strict=True))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest stress of each link over the time, and the crank speed."""
        ax = axes_or_new(ax)
        for link, values in zip(self.links, self.stress.T, strict=True):
            ax.plot(self.time, values / 1e6, linewidth=0.7, label=link)
        beside = ax.twinx()
        beside.plot(self.time, self.speed, color="0.4", linestyle="--", linewidth=0.9)
        beside.set_ylabel("crank speed, dashed [rad/s]")
        ax.set(xlabel="time [s]", ylabel="largest stress [MPa]")
        ax.legend(loc="upper left")
        return ax


def run_through(
    system: LinearPeriodic,
    profile: SpeedProfile,
    *,
    modes: int | None = _FOLLOWED,
    stations: int = 9,
    rtol: float = 1e-2,
    start: str = "steady",
) -> Transient:
    """Return the motion of a linkage of beams while its crank speed changes in time.

    A true transient: crank speed and acceleration enter the equations as they are at each time.
    A length that changes (``profile.geometry``) is quasi-static: the equations are those of the
    length at the time, without its rate.  It is one of the ground: no beam may change its own.

    Parameters
    ----------
    system : LinearPeriodic
        Of a linkage of beams whose sections have a thickness.
    profile : SpeedProfile
        The drive.
    modes : int or None
        Number of natural modes that are followed, the others in equilibrium; None for all
        coordinates, which a changing length needs.
    stations : int
        Places on each element at which stresses are taken, its ends included; 2 or more.
    rtol : float
        Wanted error of the largest stresses, relative, 1e-6 to 0.1.
    start : str
        ``"steady"``: in the steady state of the first speed; ``"rest"``: undeformed.

    Returns
    -------
    Transient
        Its checks: ``converged``, the error over what was asked; ``linear range``.

    Warns
    -----
    LinearRangeWarning
        If a deflection passes 5 % of the length of its link.

    Raises
    ------
    BadInput
        If an argument is unusable, a length that changes is asked for with ``modes``, or the run
        would take too many steps.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> profile = el.SpeedProfile.ramp(20.0, 22.0, duration=0.05)
    >>> found = el.run_through(system, profile, modes=2, stations=3)
    >>> print({link: round(value / 1e6) for link, value in found.largest.items()})
    {'crank': 55, 'coupler': 9, 'follower': 35}
    """
    _check(system, profile, modes, rtol, start)
    require_whole("stations", stations, 2, 1000, "choose 9")
    chosen = modes if modes is None or modes < system.size else None
    name = next(iter(profile.geometry), None)
    if name is not None and min(profile.geometry[name]) == max(profile.geometry[name]):
        system, name = system.with_geometry(**{name: profile.geometry[name][0]}), None
    # Of a changing length the structure is made anew at nine levels first.
    run = _Run(system, profile, stations, start, name, chosen, levels=9)
    steps = run.first_steps()
    found, before = run.solve(steps), None
    while True:
        finer = run.solve(2 * steps)
        change = _difference(finer, found)
        stepping = _stepping(change, before)
        found, steps, before = finer, 2 * steps, change
        if np.max(stepping + found.between) <= 0.5 * rtol or 2 * steps > _MOST_STEPS:
            break
    truncation = np.zeros(len(run.links))
    for _ in range(4 if chosen is not None or name is not None else 0):
        richer = run.richer()
        more = richer.solve(steps)
        # Cubics between twice as many levels are better by far more than the half of the change.
        truncation = _difference(more, found) * (1.0 if name is None else 0.5)
        run, found = richer, more
        if np.max(truncation) <= 0.5 * rtol or (name is None and run.followed is system):
            break
    error = stepping + truncation + found.between + run.start_error
    return _result(run, found, error, rtol)


def _stepping(change: Array, before: Array | None) -> Array:
    """Return the error left by a number of steps, from the change that halving them made."""
    # It shrinks on as it has been seen to, at most as the order promises; unseen, as one halving of
    # an order of two does.
    shrunk = 4.0
    if before is not None:
        seen = float(np.max(before)) / max(float(np.max(change)), np.finfo(float).tiny)
        shrunk = float(np.clip(seen, 1.5, 2.0 ** (2 * _STAGES)))
    return change / (shrunk - 1.0)


@dataclass(frozen=True)
class _Motion:
    """One run: samples of the motion of the structure, and the links' largest stresses."""

    time: Array
    q: Array
    qd: Array
    stress: Array  # from each sample up to the next
    steps: Array  # at every step
    between: Array  # what the largest stress is beyond that at the steps, over it, by links


@dataclass
class _Run:
    """What one number of modes needs."""

    full: LinearPeriodic
    profile: SpeedProfile
    stations: int
    start: str
    length: str | None  # the one that changes
    modes: int | None
    levels: int  # of the length that changes
    start_error: float = field(default=1e-14, init=False)  # of the first state, with round-off

    def __post_init__(self) -> None:
        full, modes, length = self.full, self.modes, self.length
        self.links = tuple(beam.name for beam in required_structure(full).beams)
        self.followed: LinearPeriodic = full if modes is None else reduced_system(full, modes)
        self.changing: ChangingLength | None = None
        if length is not None:
            self.changing = ChangingLength(full, self.profile, length, self.levels)

    def richer(self) -> _Run:
        """Return a run with more modes, or with more levels of a length that changes."""
        more = None if self.modes is None else self.modes + _MORE
        modes = None if more is None or more >= self.full.size else more
        return replace(self, modes=modes, levels=2 * self.levels - 1)

    def first_steps(self) -> int:
        """Return the number of steps of the first try."""
        theta = np.linspace(0.0, self.followed.period, 16, endpoint=False)
        ranked = held_frequencies(self.followed, theta, {})[0]
        fastest = float(np.max(ranked[:, min(_FOLLOWED, ranked.shape[1]) - 1]))
        periods = fastest * self.profile.duration / (2.0 * np.pi)
        turns = float(self.profile.angle(np.array(self.profile.times[-1]))) / (2.0 * np.pi)
        steps = int(np.ceil(max(48.0 * turns, 2.0 * periods, 16)))
        if 4 * steps > _MOST_STEPS:
            found = f"{self.profile.duration:g} s, {periods:.0f} periods of the modes followed"
            fix = "shorten it, or follow fewer modes"
            raise bad("profile", found, f"at most {_MOST_STEPS // 4} steps", fix)
        return steps

    def arrays(self, drive: Drive, time: Array) -> Mapping[str, Array]:
        """Return the arrays at points of time, between the levels of a length that changes."""
        if self.changing is None:
            return arrays_of(self.followed, drive)
        return self.changing.arrays(drive, time)

    def solve(self, steps: int) -> _Motion:
        """Return the run with a number of steps."""

        def generator(time: Array) -> Array:
            drive = Drive.of(self.profile, time)
            return generator_of(self.arrays(drive, time), drive)

        time = np.linspace(self.profile.times[0], self.profile.times[-1], steps + 1)
        states = march(generator, time, np.append(self._first, 1.0), _STAGES)
        every = -(-len(time) // 20_000)  # as many samples are kept at most
        q = np.empty((-(-len(time) // every), self.full.size))
        qd = np.empty_like(q)
        stress = np.empty((len(time), len(self.links)))
        chunk = every * max(1, _CHUNK // every)
        for begin in range(0, len(time), chunk):
            part = slice(begin, begin + chunk)
            own_q, own_qd, stress[part] = self._recovered(time[part], states[part])
            kept = slice(begin // every, begin // every + -(-len(own_q) // every))
            q[kept], qd[kept] = own_q[::every], own_qd[::every]
        highest = np.maximum.reduceat(stress, np.arange(0, len(time), every), axis=0)
        return _Motion(time[::every], q, qd, highest, stress, _between(stress))

    def _recovered(self, time: Array, states: Array) -> tuple[Array, Array, Array]:
        """Return coordinates, their rates and the largest stresses at points of time."""
        size = self.followed.size
        drive = Drive.of(self.profile, time)
        arrays = self.arrays(drive, time)
        drift = np.zeros_like(states[:, :size])
        if "A" in arrays:
            drift = drive.speed[:, None] * np.einsum("tij,tj->ti", arrays["A"], states[:, :size])
        momentum = states[:, size:-1] - drift
        rates = np.asarray(np.linalg.solve(arrays["M"], momentum[..., None])[..., 0])
        q, qd = self._lifted(drive, states[:, :size], rates)
        turned = None if self.changing is None else self.changing.directions(drive.angle, time)
        return q, qd, largest_by_shape(self.full, drive.angle, q, self.stations, turned)

    @cached_property
    def _first(self) -> Array:
        speed = float(self.profile.speeds[0])
        size = self.followed.size
        if self.start == "rest" or speed == 0.0:
            return np.zeros(2 * size)
        own = self.followed
        for name, values in self.profile.geometry.items():
            own = own.with_geometry(**{name: values[0]})
        steady = steady_state(own, speed, rtol=1e-8)
        self.start_error += float(np.max(steady.error))
        q, qd = steady.q.reshape(-1, size)[0], steady.qd.reshape(-1, size)[0]
        zero = np.zeros(1)
        mass = own.array("M", zero, speed)[0]
        return np.concatenate([q, mass @ qd + speed * own.array("A", zero, speed)[0] @ q])

    def _lifted(self, drive: Drive, q: Array, qd: Array) -> tuple[Array, Array]:
        """Return the coordinates of the structure, modes left out in equilibrium."""
        own = self.followed
        if not isinstance(own, ReducedSystem) or own.basis is None:
            return q, qd
        phi, slope = own.basis(drive.angle), own.basis.derivative(drive.angle)
        full = np.einsum("tnm,tm->tn", phi, q)
        rates = np.einsum("tnm,tm->tn", phi, qd)
        rates += drive.speed[:, None] * np.einsum("tnm,tm->tn", slope, q)
        # The equilibrium of the modes left out under the inertia of the rigid motion.
        arrays = arrays_of(self.full, drive, ("K", "g", *FORCES))
        force, stiffness = drive.force(arrays), arrays["K"]
        whole = np.linalg.solve(stiffness, force[..., None])[..., 0]
        kept = np.einsum("tnm,tnk,tkj->tmj", phi, stiffness, phi)
        part = np.linalg.solve(kept, np.einsum("tnm,tn->tm", phi, force)[..., None])[..., 0]
        return full + whole - np.einsum("tnm,tm->tn", phi, part), rates

    def deflection(self, found: _Motion) -> float:
        """Return the largest deflection over the length of a link."""
        largest = 0.0
        for begin in range(0, len(found.time), _CHUNK):
            part = slice(begin, begin + _CHUNK)
            time = found.time[part]
            angle = self.profile.angle(time)
            rows: Any = (
                self.full.deflection_rows(angle)
                if self.changing is None
                else self.changing.deflections(angle, time)
            )
            values = np.einsum("tkn,tn->tk", rows, found.q[part])
            largest = max(largest, float(np.max(np.abs(values))))
        return largest


def largest_by_shape(
    system: LinearPeriodic,
    theta: Array,
    q: Array,
    stations: int,
    directions: Mapping[str, Array] | None = None,
) -> Array:
    """Return the largest stress of each link, ``E (|u'| + h/2 |v''|)``, ``(nt, links)`` [Pa].

    By the shapes of the elements, at so many stations on each.  ``directions`` are cosine and sine
    of each link's angle, ``(nt, 2)``, where they are not those of the system.
    """
    structure = required_structure(system)
    full = np.zeros((len(theta), len(structure.freedoms.all)))
    full[:, structure.freedoms.free] = q
    links = [beam.name for beam in structure.beams]
    if directions is None:
        motion = structure.configuration(theta)
        directions = {name: products(motion[name].angle)[:, 1:3] for name in links}
    largest = np.zeros((len(theta), len(links)))
    xi = np.linspace(0.0, 1.0, stations)
    for placed in structure.elements:
        section = placed.beam.section
        if section.thickness is None:
            fix = "give Section.thickness"
            raise bad(f"beam {placed.beam.name}", "no thickness", "one, for its stresses", fix)
        shapes = shapes_of(placed, xi)
        bend = 0.5 * section.thickness * shapes["curvature"]
        local = in_own_axes(full[:, placed.indices], *directions[placed.beam.name].T)
        strain = np.abs(local @ shapes["strain"].T) + np.abs(local @ bend.T)
        k = links.index(placed.beam.name)
        largest[:, k] = np.maximum(largest[:, k], section.modulus * np.max(strain, axis=1))
    return largest


def _between(stress: Array) -> Array:
    """Return what lies above the largest of the steps by parabolas, over it, by links."""
    # Next to the ends too, beyond which the stress goes on as a quartic through five steps.
    wide = stress
    for _ in range(2):
        # The next value from five, if their fourth difference stays.
        quartic = np.array([5.0, -10.0, 10.0, -5.0, 1.0])
        beyond = [np.tensordot(quartic, part, 1)[None] for part in (wide[:5], wide[:-6:-1])]
        wide = np.concatenate([beyond[0], wide, beyond[1]])
    top, missed = turned_by_parabolas(*(wide[k : len(wide) - 4 + k] for k in range(5)))
    largest = np.maximum(np.max(stress, axis=0), np.finfo(float).tiny)
    beyond = np.max(top + missed, axis=0, initial=0.0) / largest - 1.0
    return np.asarray(2.0 * np.maximum(beyond, 0.0))  # with a margin of as much again


def _difference(finer: _Motion, coarse: _Motion) -> Array:
    """Return the change of the large stresses of each link at the times of both, over the largest.

    Of all of them, as the largest itself may stay by chance.
    """
    every = (len(finer.steps) - 1) // (len(coarse.steps) - 1)
    old, new = coarse.steps, finer.steps[::every]
    largest = np.maximum(np.max(finer.steps, axis=0), np.finfo(float).tiny)
    near = np.maximum(old, new) >= 0.7 * largest
    return np.asarray(np.max(np.where(near, np.abs(new - old), 0.0), axis=0) / largest)


def _result(run: _Run, found: _Motion, error: Array, rtol: float) -> Transient:
    system, profile = run.full, run.profile
    largest = run.deflection(found)
    fix = "run through faster, or add damping"
    warn_of_large_deflection(largest, "the length of its link", fix, stacklevel=4)
    followed = "all coordinates" if run.followed is system else f"{run.followed.size} modes or more"
    return Transient(
        method=f"Gauss-Legendre collocation of order {2 * _STAGES}, {followed}",
        error=error,
        error_norm="largest stress of each link over the run, relative",
        checks={
            "converged": Check(float(np.max(error)) / rtol, 1.0),
            "linear range": Check(largest, LINEAR_RANGE),
        },
        provenance=provenance(dict(system.provenance)),
        time=found.time,
        angle=profile.angle(found.time),
        speed=profile.speed(found.time),
        q=found.q,
        qd=found.qd,
        links=run.links,
        stress=found.stress,
        profile=profile,
    )


def _check(
    system: LinearPeriodic, profile: SpeedProfile, modes: int | None, rtol: float, start: str
) -> None:
    require_system(system)
    problems = []
    if not isinstance(profile, SpeedProfile):
        raise bad("profile", repr(profile), "a SpeedProfile", "make one: SpeedProfile.ramp")
    if system.structure is None or not system.structure.moving:
        fix = "make it with linkage_system, or load a scene of beams"
        problems.append(Problem("system", "no linkage of beams", "one", fix))
    if modes is not None and not is_whole(modes, 1):
        problems.append(Problem("modes", repr(modes), "a number from 1, or None", "choose 8"))
    if not (isinstance(rtol, Real) and 1e-6 <= rtol <= 0.1):
        problems.append(Problem("rtol", repr(rtol), "a number from 1e-6 to 0.1", "choose 0.01"))
    if not is_one_of(start, ("steady", "rest")):
        problems.append(Problem("start", repr(start), "'steady' or 'rest'", "choose one"))
    strange = sorted(set(profile.geometry) - set(system.geometry))
    if strange:
        known = f"some of {sorted(system.geometry)}"
        problems.append(Problem("profile.geometry", str(strange), known, "correct the name"))
    if len(profile.geometry) > 1:
        fix = "change one after the other"
        problems.append(Problem("profile.geometry", "several lengths", "one at a time", fix))
    if profile.geometry and modes is not None:
        fix = "set modes=None: the modes of one length are not those of another"
        problems.append(Problem("modes", str(modes), "None where a length changes", fix))
    refuse(problems)
