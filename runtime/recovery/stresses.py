"""Stresses along the beams in a motion, with their errors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..beams.assembly import Array
from ..beams.element_forms import ElementForms, required_structure
from ..beams.recovery_forms import LinearForm, stacked
from ..core.errors import Problem, refuse
from ..core.families import LinearPeriodic
from ..core.inputs import is_finite, numbers_in_a_row, require_one_of
from ..core.maxima import polished
from ..core.plotting import Axes, axes_or_new
from ..core.results import DeferredField, DeferredGroup
from ..core.trigonometric import resampled
from .beam_forces import (
    METHODS,
    Recovered,
    Station,
    Stations,
    recovery,
    require_method,
    stations_of,
)
from .beam_motion import BeamMotion, Motion, beam_motion, chunks
from .beam_result import StationResult, checked_forms, in_motion, stations_on
from .finer_mesh import CAUTION, ROUNDING

# How much finer the angles are at which the largest stress is sought, and how near to the largest
# at the coarse angles a row has to come to be looked at.
FINER, _NEAR = 8, 0.6
_STRESSING = ("axial", "moment")
# Places over each element for its energy: exact for the recovered polynomials' squares.
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def fibre_factors(system: LinearPeriodic, stations: Sequence[Station]) -> Array:
    """Return 1/A [1/m^2] and c/I [1/m^3], c half the thickness: ``(2, stations)``."""
    structure = required_structure(system)
    sections = {beam.name: beam.section for beam in structure.beams}
    problems = [
        Problem(f"section of {name}", "no thickness", "one, for stresses", "use recover() instead")
        for name in dict.fromkeys(station.beam for station in stations)
        if sections[name].thickness is None
    ]
    refuse(problems)
    own = [sections[station.beam] for station in stations]
    levers = [0.5 * (section.thickness or 0.0) / section.second_moment for section in own]
    return np.array([[1.0 / section.area for section in own], levers])


def stresses(asked: Recovered, factors: Array) -> Array:
    """Return stresses of axial force and of bending at the positive fibre [Pa].

    Shape ``(2, nt, stations)``, from the ``factors`` of :func:`fibre_factors`.
    """
    return _of_forces(asked.values(_STRESSING), factors)


def _of_forces(forces: Mapping[str, Array], factors: Array) -> Array:
    return np.stack([forces["axial"] * factors[0], -forces["moment"] * factors[1]])


def largest_difference(first: ArrayLike, second: ArrayLike) -> float:
    """Return the largest difference of the stresses of a fibre [Pa]."""
    return float(np.max(np.sum(np.abs(np.subtract(first, second)), axis=0)))


def frozen(system: LinearPeriodic, motion: BeamMotion) -> BeamMotion:
    """Return the quasi-static motion: equilibrium at each angle without any rates."""
    found = np.empty_like(motion.q)
    for chunk in chunks(motion):
        forms = ElementForms(system, motion.theta[chunk])
        rows = forms.resisted.at_speed(motion.speed)
        free = forms.arrays.free
        load = rows.get("1", np.zeros((len(found[chunk]), forms.arrays.count)))
        solved = np.linalg.solve(rows["q"][:, free], -load[:, free, None])
        found[chunk] = solved[..., 0]
    return replace(motion, q=found, qd=np.zeros_like(found), frozen=True)


def energy_gap(system: LinearPeriodic, motion: BeamMotion) -> float:
    """Return the energy of the difference of both recoveries over that of the forces.

    Of a natural mode this is the relative error of its squared frequency on the mesh.
    """
    structure = required_structure(system)
    picked = np.unique(np.linspace(0, len(motion.theta) - 1, 64).astype(int))
    rows = {name: getattr(motion, name)[picked] for name in ("theta", "q", "qd")}
    few = replace(motion, **rows, period=None)
    stations: dict[str, Array] = {}
    weights = []
    for beam in structure.beams:
        own = [placed for placed in structure.elements if placed.beam is beam]
        along = [placed.start + 0.5 * placed.length * (1.0 + _PLACES) for placed in own]
        stations[beam.name] = np.concatenate(along) / beam.length
        weights.append(np.concatenate([0.5 * placed.length * _WEIGHTS for placed in own]))
    first, second = (Recovered(system, few, stations, m).values(_STRESSING) for m in METHODS)
    scale = float(system.parameters.get("elasticity", 1.0))
    wrong = total = 0.0
    for name, key in (("axial", "axial_stiffness"), ("moment", "bending_stiffness")):
        stiff = [scale * getattr(beam.section, key) for beam in structure.beams]
        flat = np.concatenate([w / k for w, k in zip(weights, stiff, strict=True)])
        wrong += float(np.sum((first[name] - second[name]) ** 2 @ flat))
        total += float(np.sum(first[name] ** 2 @ flat))
    return min(wrong / total, 0.5) if total else 0.0


@dataclass(frozen=True)
class Peaks:
    """Largest stresses, each ``(links, ns)``: size [Pa], angle [rad], row, and error of the size.

    The error is what the quartic through five angles may miss, over the size.
    """

    size: Array
    theta: Array
    row: NDArray[np.int64]
    error: Array

    @classmethod
    def joined(cls, parts: Iterable[Peaks]) -> Peaks:
        """Return those of several parts of the speeds."""
        columns = zip(*(vars(part).values() for part in parts), strict=True)
        return cls(*(np.concatenate(column, axis=1) for column in columns))


def largest_of(values: Array, link: NDArray[np.int64], links: int, period: float) -> Peaks:
    """Return the largest size of stresses ``(nt, rows, ns)`` of each link at each speed.

    Between the angles the Fourier series is taken at eight times as many, and a quartic between
    these.
    """
    count, _, speeds = values.shape
    coarse = np.max(np.abs(values), axis=0)
    size, theta, error = (np.zeros((links, speeds)) for _ in range(3))
    row = np.zeros((links, speeds), dtype=np.int64)
    for k in range(links):
        rows_of = np.flatnonzero(link == k)
        rows, columns = np.nonzero(coarse[rows_of] >= _NEAR * np.max(coarse[rows_of], axis=0))
        fine = np.abs(resampled(values[:, rows_of[rows], columns], FINER * count)).T
        # Of several tops almost equal at the angles another may be the largest between them: half a
        # fine step beside its top the highest harmonic has cos(pi/16) of it.
        which, place = np.nonzero(fine >= 0.98 * np.max(fine, axis=1, keepdims=True))
        before, after = fine[which, place - 1], fine[which, (place + 1) % fine.shape[1]]
        at = fine[which, place]
        top = (at >= before) & (at >= after)
        which, place = which[top], place[top]
        around = (place + np.arange(-2, 3)[:, None]) % fine.shape[1]
        shift, height, missed = polished(fine[which, around])
        # Of each speed the highest, the first row of equal ones.
        speed = columns[which]
        order = np.lexsort((rows[which], -height, speed))
        first = order[np.unique(speed[order], return_index=True)[1]]
        size[k] = height[first]
        theta[k] = (place[first] + shift[first]) % fine.shape[1] * (period / fine.shape[1])
        row[k] = rows_of[rows[which[first]]]
        error[k] = missed[first] / np.maximum(size[k], np.finfo(float).tiny)
    return Peaks(size, theta, row, error)


FIBRES = ("positive", "negative")
PARTS = ("all", "quasi-static", "dynamic")
# Fields that are computed when they are first looked at.
_LATER = {
    name: DeferredField()
    for name in ("static_axial", "static_bending", "motion_error", "mesh_error")
}


@dataclass(frozen=True)
class StressPeak:
    """The largest size of a stress."""

    value: float  # stress [Pa], tension positive
    theta: float  # crank angle [rad]
    link: str
    place: float  # x over the beam's length
    fibre: str  # ``positive``, the outer fibre to the left of the beam's direction, or ``negative``


@dataclass(frozen=True, kw_only=True)
class StressResult(StationResult):
    """Stresses along the beams over the cycle.

    Speed, crank angles and stations: see :class:`StationResult`.

    Attributes
    ----------
    axial, bending : ndarray
        Stress [Pa] of the axial force, and of the bending moment at the outer fibre on the beam's
        positive side, shape ``(nt, stations)``; on the other side it has the other sign.
    static_axial, static_bending : ndarray
        The same of the quasi-static motion: equilibrium at each angle under the inertia of the
        rigid motion and the constant loads, no rates.
    motion_error, mesh_error : float
        The parts of the error estimate [Pa]: of the motion's own error, and of the mesh.
    period : float or None
        Period [rad] that the angles divide evenly; None of a motion that is not periodic.

    Notes
    -----
    The quasi-static part and the parts of the error estimate are computed when they are first
    looked at, as the estimate itself.
    """

    axial: Array
    bending: Array
    static_axial: Any = _LATER["static_axial"]  # Array
    static_bending: Any = _LATER["static_bending"]  # Array
    motion_error: Any = _LATER["motion_error"]  # float
    mesh_error: Any = _LATER["mesh_error"]  # float
    period: float | None = None

    arrays_along: ClassVar = {"sample station": "axial bending static_axial static_bending stress"}
    exported: ClassVar[tuple[str, ...]] = ("stress",)
    column_units: ClassVar = {
        "Pa": "axial bending static_axial static_bending stress error motion_error mesh_error",
        "rad": "period",
    }

    @property
    def stress(self) -> Array:
        """Largest size of the stress over the section [Pa], ``(nt, stations)``."""
        return np.asarray(np.abs(self.axial) + np.abs(self.bending))

    def fibre(self, name: str = "positive", part: str = "all") -> Array:
        """Return the stress of one outer fibre [Pa], ``(nt, stations)``.

        Parameters
        ----------
        name : str
            ``"positive"`` or ``"negative"``.
        part : str
            ``"all"``, ``"quasi-static"`` or ``"dynamic"``, the difference of these.

        Raises
        ------
        BadInput
            If either is unknown.
        """
        require_one_of("fibre", name, FIBRES)
        require_one_of("part", part, PARTS)
        sign = 1.0 if name == "positive" else -1.0
        whole = self.axial + sign * self.bending
        if part == "all":
            return np.asarray(whole)
        still = self.static_axial + sign * self.static_bending
        return np.asarray(still if part == "quasi-static" else whole - still)

    def at(self, link: str, place: float, fibre: str = "positive", part: str = "all") -> Array:
        """Return the stress of a fibre over the angles ``(nt,)`` at the station nearest a place.

        Raises ``BadInput`` if the link has no station, or a name is unknown.
        """
        own = stations_on(self.links, link)
        nearest = own[int(np.argmin(np.abs(self.places[own] - place)))]
        return np.asarray(self.fibre(fibre, part)[:, nearest])

    @cached_property
    def maximum(self) -> StressPeak:
        """The largest stress of all, over angles, stations and fibres."""
        return max(self.maxima.values(), key=lambda peak: abs(peak.value))

    @cached_property
    def maxima(self) -> dict[str, StressPeak]:
        """The largest stress of each beam."""
        return {link: self._peak(link) for link in dict.fromkeys(self.links)}

    def _peak(self, link: str) -> StressPeak:
        own = stations_on(self.links, link)
        values = np.concatenate([self.fibre(fibre)[:, own] for fibre in FIBRES], axis=1)
        row, column = divmod(int(np.argmax(np.abs(values))), values.shape[1])
        theta, size = float(self.theta[row]), abs(float(values[row, column]))
        if self.period is not None and len(self.theta) >= 3:
            rows = np.zeros(values.shape[1], dtype=np.int64)
            top = largest_of(values[..., None], rows, 1, self.period)
            column, theta, size = int(top.row[0, 0]), float(top.theta[0, 0]), float(top.size[0, 0])
            row = round(theta / self.period * len(self.theta)) % len(self.theta)
        fibre, place = divmod(column, len(own))
        value = float(np.copysign(size, values[row, column]))
        return StressPeak(value, theta, link, float(self.places[own[place]]), FIBRES[fibre])

    def safety(self, limit: float | Mapping[str, float]) -> dict[str, float]:
        """Return the factor of safety of each beam: allowed over largest stress.

        Parameters
        ----------
        limit : float or mapping of str to float
            Allowed stress [Pa], of all or by beam.

        Returns
        -------
        dict of str to float
            By beam; inf where there is no stress.

        Raises
        ------
        BadInput
            If a limit is missing or not positive.
        """
        found, problems = {}, []
        for link, peak in self.maxima.items():
            own = limit.get(link, np.nan) if isinstance(limit, Mapping) else limit
            if not (is_finite(own) and own > 0):
                fix = "give a positive limit for each beam"
                problems.append(Problem(f"limit of {link}", repr(own), "a stress [Pa]", fix))
            else:
                found[link] = float(own) / abs(peak.value) if peak.value else np.inf
        refuse(problems)
        return found

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the stress at each beam's worst place over the crank angle, its static part dashed.

        Of a structure that stands still, the stress along the beams.
        """
        ax = axes_or_new(ax)
        if len(self.theta) == 1:
            for link in self.maxima:
                own = stations_on(self.links, link)
                ax.plot(self.places[own], 1e-6 * self.stress[0, own], label=link, linewidth=0.9)
            ax.set(xlabel="place x/length", ylabel="largest stress [MPa]")
            ax.legend()
            return ax
        period, closed = self.period, self.period is not None
        angles = np.degrees(self.theta if period is None else np.append(self.theta, period))
        for link, peak in self.maxima.items():
            parts = [self.at(link, peak.place, peak.fibre, part) for part in PARTS[:2]]
            whole, still = (1e-6 * (np.append(p, p[:1]) if closed else p) for p in parts)
            label = f"{link}, x/length = {peak.place:.3g}"
            line = ax.plot(angles, whole, label=label, linewidth=0.9)[0]
            ax.plot(angles, still, "--", color=line.get_color(), linewidth=0.7)
            ax.plot(np.degrees(peak.theta), 1e-6 * peak.value, "o", color=line.get_color(), ms=3)
        ax.set(xlabel="crank angle [deg]", ylabel="stress at the worst fibre [MPa]")
        ax.set_title(f"{self.speed:.4g} rad/s; dashed: quasi-static", fontsize="medium")
        ax.legend()
        return ax


def stress(
    system: LinearPeriodic,
    motion: Motion | float | None = None,
    *,
    stations: Stations = None,
    method: str = "equilibrium",
) -> StressResult:
    """Return the stresses along the beams of a linkage over the cycle, or of a frame.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams whose sections have a thickness.
    motion : SteadyState, Trajectory, BeamMotion, float or None
        A computed motion; a crank speed [rad/s], for the steady state there; None for a frame.
    stations : int or mapping of str to array_like, optional
        Places on each beam: how many, or by beam the places x/length; by default 25.
    method : str
        How forces are recovered: ``"equilibrium"`` or ``"shape"``, see :func:`recover`.

    Returns
    -------
    StressResult
        Its ``error`` is the largest error of a stress [Pa] over angles and stations.  What counts
        as true is the same model of beams, the mesh refined without end and the same law of
        damping: of modal damping the same ratio in every mode.  It is made of what the error of
        the motion does, and three times the difference to the stresses on a finer mesh, by
        ``equilibrium``: quintic elements in place of cubic ones, two at least on each beam.

        Of a motion that is given, or marched, the mesh's part is the difference of the two
        recoveries, for ``equilibrium`` times the square root of the mesh's relative error, and
        says nothing about the frequencies of the mesh.

    Warns
    -----
    LinearRangeWarning
        If a deflection passes 5 % of the length of its beam.

    Raises
    ------
    BadInput
        If an argument is unusable, or a section has no thickness.

    Notes
    -----
    Without a finer mesh its relative error is taken for the square of the energy norm of the
    difference of the two recoveries over that of the forces: for a natural mode this is the
    relative error of the squared frequency.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> largest = el.stress(system, 20.0).maximum
    >>> print(largest.link, round(largest.value / 1e6))
    crank 52
    """
    require_method(method)
    chosen = stations_of(required_structure(system), stations)
    factors = fibre_factors(system, chosen)
    asked = Recovered(system, beam_motion(system, motion), stations, method)
    own = stresses(asked, factors)
    still = DeferredGroup(partial(_still, asked, factors))
    doubt = partial(_doubt, asked, factors, own)
    return StressResult(
        method=method,
        links=tuple(station.beam for station in chosen),
        places=np.array([station.place for station in chosen]),
        axial=own[0],
        bending=own[1],
        static_axial=still.later("axial"),
        static_bending=still.later("bending"),
        period=asked.motion.period,
        **in_motion(system, asked.motion, doubt, later=("motion_error", "mesh_error")),
    )


def _still(asked: Recovered, factors: Array) -> dict[str, Array]:
    still = replace(asked, motion=frozen(asked.system, asked.motion))
    return dict(zip(("axial", "bending"), stresses(still, factors), strict=True))


def _doubt(asked: Recovered, factors: Array, own: Array) -> dict[str, float | str]:
    axial, _, moment = asked.propagated()
    by_motion = float(np.max(factors[0]) * axial + np.max(factors[1]) * moment)
    norm = "largest error of a stress over angles and stations [Pa]"
    better, finer = asked.compared(_STRESSING)
    by_mesh = largest_difference(own, _of_forces(better, factors))
    if not finer:
        norm = f"{norm}, that of the mesh's frequencies apart"
        if asked.method == "equilibrium":
            by_mesh *= float(np.sqrt(energy_gap(asked.system, asked.motion)))
    largest = float(np.max(np.sum(np.abs(own), axis=0)))
    return {
        "error": by_motion + CAUTION * by_mesh + ROUNDING * largest,
        "error_norm": norm,
        "motion_error": by_motion,
        "mesh_error": by_mesh,
    }


def stress_operator(
    system: LinearPeriodic,
    theta: ArrayLike,
    stations: Stations = None,
    *,
    method: str = "equilibrium",
    accelerations: bool = False,
) -> tuple[LinearForm, tuple[Station, ...]]:
    """Return the stresses of both outer fibres as a linear form of the motion, for many speeds.

    Of a structure of beams whose sections have a thickness, at crank angles [rad], ``(nt,)``;
    stations and method are those of :func:`stress`.  With ``accelerations`` d2q/dtheta2 stays in
    the form; else the equation of motion replaces it, so that the form needs ``q`` and
    ``dq/dtheta`` alone.  Its parts are ``(nt, 2 stations, n)`` by what they multiply and the power
    of the speed: first the fibres on the positive sides of all stations, then those on the negative
    sides [Pa].
    """
    require_method(method)
    angles = numbers_in_a_row("theta", theta, " [rad]")
    chosen = stations_of(required_structure(system), stations)
    areas, levers = fibre_factors(system, chosen)
    forms = checked_forms(system, angles)
    made = recovery(forms, chosen, method)
    axial = made["axial"].turned(np.diag(areas))
    bending = made["moment"].turned(np.diag(-levers))
    both = stacked([axial + bending, axial - bending])
    return both if accelerations else both.eliminated(forms.acceleration), chosen
