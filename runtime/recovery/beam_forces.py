"""Forces and stresses along beams from the motion of their nodes.

Two ways, by name.  ``equilibrium``: the end forces of each element, and between its nodes what
balances the inertia of the rigid and the elastic motion, weight and axial forces: what is wrong
comes from the nodes alone.  ``shape``: derivatives of the shape functions times the stiffnesses,
one or two orders of the element's length less.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..beams.assembly import Array
from ..beams.element_forms import ElementForms, MovingElement, required_structure
from ..beams.elements import shapes_of
from ..beams.recovery_forms import LinearForm, stacked
from ..beams.structure import PlacedElement, Structure
from ..core.errors import BadInput, Problem, bad, shown
from ..core.families import LinearPeriodic
from ..core.inputs import is_whole, numbers, require_one_of
from ..core.plotting import Axes, axes_or_new
from .beam_motion import BeamMotion, Motion, beam_motion
from .beam_result import (
    MotionValues,
    StationResult,
    checked_forms,
    in_motion,
    over_motion,
    stations_on,
)
from .finer_mesh import CAUTION, ROUNDING, on_finer_mesh

# Places on the beams: how many on each, or by beam x over its length.
Stations = int | Mapping[str, ArrayLike] | None
METHODS = ("equilibrium", "shape")
FORCES = ("axial", "shear", "moment")
# Exact for the shape functions (to degree 5) times the axial force (to degree 2) times x.
_GAUSS_PLACES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class Station:
    """A place on a beam, and on one of the structure's elements."""

    beam: str
    place: float  # x over the beam's length, 0 to 1
    element: int
    xi: float  # x over the element's length, from its start


def stations_of(structure: Structure, stations: Stations = None) -> tuple[Station, ...]:
    """Return places on the beams of a structure, beam by beam.

    ``stations`` is the number on each beam, its ends included (by default 25), or by beam the
    places x/length.
    """
    if stations is None or isinstance(stations, int):
        count = 25 if stations is None else stations
        if not is_whole(count, 2, 100_000):
            raise bad("stations", shown(stations), "2 to 100000 places on each beam", "choose 25")
        wanted: Mapping[str, ArrayLike] = {
            beam.name: np.linspace(0.0, 1.0, count) for beam in structure.beams
        }
    elif isinstance(stations, Mapping):
        wanted = stations
    else:
        kind = type(stations).__name__
        raise bad("stations", kind, "a number, or places by beam", "give {'beam': [0.5]}")
    problems, found = [], []
    for name, given in wanted.items():
        beam = structure.beam(name)
        places = np.atleast_1d(numbers(f"stations on {name}", given))
        if places.ndim != 1 or not places.size or not np.all((places >= 0.0) & (places <= 1.0)):
            fix = "divide by the beam's length"
            problems.append(Problem(f"stations on {name}", str(given), "places from 0 to 1", fix))
            continue
        own = [(e, p) for e, p in enumerate(structure.elements) if p.beam.name == name]
        ends = np.array([placed.start + placed.length for _, placed in own[:-1]])
        for place in places.tolist():
            along = place * beam.length
            e, placed = own[int(np.searchsorted(ends, along))]
            xi = min(max((along - placed.start) / placed.length, 0.0), 1.0)
            found.append(Station(name, place, e, xi))
    if problems or not found:
        raise BadInput(*(problems or [Problem("stations", "none", "at least one", "name some")]))
    return tuple(found)


def require_method(method: str) -> None:
    """Refuse a way to recover forces that is not known."""
    require_one_of("method", method, METHODS, "choose 'equilibrium'")


def recovery(
    forms: ElementForms, stations: tuple[Station, ...], method: str = "equilibrium"
) -> dict[str, LinearForm]:
    """Return forces and displacements along beams as linear forms whose rows are the stations.

    ``axial`` and ``shear`` [N], ``moment`` [N m]; ``along``, ``across`` [m] and ``slope`` [rad]
    from the rigid beam, in its axes.
    """
    rows: dict[str, list[LinearForm]] = {name: [] for name in (*FORCES, *_FIELDS)}
    by_element: dict[int, list[Station]] = {}
    for station in dict.fromkeys(stations):
        by_element.setdefault(station.element, []).append(station)
    for e, own in by_element.items():
        xi, element = np.array([station.xi for station in own]), forms.elements[e]
        forces = _by_equilibrium if method == "equilibrium" else _by_shape
        shapes, local = shapes_of(element.placed, xi), element.local()
        for name, shape in zip(_FIELDS, ("u", "v", "rotation"), strict=True):
            rows[name].append(local.turned(shapes[shape]))
        for name, form in forces(element, xi).items():
            rows[name].append(form)
    met = [station for own in by_element.values() for station in own]
    order = np.array([met.index(station) for station in stations])
    return {name: stacked(parts).ordered(order) for name, parts in rows.items()}


_FIELDS = ("along", "across", "slope")


def _by_shape(element: MovingElement, xi: Array) -> dict[str, LinearForm]:
    """Return forces by derivatives of the shape functions: E A u', E I v'', -E I v'''."""
    section, strain = element.placed.beam.section, element.strain()
    shapes = shapes_of(element.placed, xi)
    return {
        "axial": strain.turned(section.axial_stiffness * shapes["strain"]),
        "shear": strain.turned(-section.bending_stiffness * shapes["third"]),
        "moment": strain.turned(section.bending_stiffness * shapes["curvature"]),
    }


def _by_equilibrium(element: MovingElement, xi: Array) -> dict[str, LinearForm]:
    """Return forces that balance the part of an element before each place."""
    forms, placed = element.forms, element.placed
    share = forms.factor["distributed_mass"]
    mass = share * placed.beam.section.mass_per_length
    weights = _integrals(placed, xi)
    direct, across = element.direct(), element.across()
    plain = direct - element.centripetal()
    ends = element.end_forces()
    pick = np.repeat(np.eye(3, len(element.arrays.mass))[:, None], len(xi), axis=1)
    lever = (placed.length * xi)[:, None]
    # The inertia m a of the part: along, across, and its moment about the place.
    along = plain.turned(mass * weights["u"]) - across.turned(mass * weights["v"])
    sideways = plain.turned(mass * weights["v"]) + across.turned(mass * weights["u"])
    moment = plain.turned(mass * weights["v lever"]) + across.turned(mass * weights["u lever"])
    turned = ends.turned(lever * pick[1] - pick[2]) - moment
    if placed.beam.kind == "timoshenko":
        rotary = share * placed.beam.section.rotary_inertia
        turned = turned + direct.turned(rotary * weights["rotation"])
    for power, forces in forms.stiffening.items():
        kernel = np.einsum("tk,kxn->txn", forces[:, element.number], weights["slope"])
        turned = turned + element.local().turned(kernel).faster(power)
    return {
        "axial": along - ends.turned(pick[0]),
        "shear": sideways - ends.turned(pick[1]),
        "moment": turned,
    }


def _integrals(placed: PlacedElement, xi: Array) -> dict[str, Array]:
    """Return integrals of shape functions from the element's start to each place."""
    # `u`, `v`, `rotation`; u lever, v lever times the distance to the place; `slope` of v' times 1,
    # s and s^2, s the place over the element's length: (3, nx, n).
    places = 0.5 * xi[:, None] * (1.0 + _GAUSS_PLACES)
    weights = 0.5 * placed.length * xi[:, None] * _GAUSS_WEIGHTS
    lever = placed.length * (xi[:, None] - places)
    shapes = shapes_of(placed, np.clip(places, 0.0, 1.0))
    found = {
        name: np.einsum("xg,xgn->xn", weights, shapes[name]) for name in ("u", "v", "rotation")
    }
    for name in ("u", "v"):
        found[f"{name} lever"] = np.einsum("xg,xgn->xn", weights * lever, shapes[name])
    powers = np.stack([places**k for k in range(3)])
    found["slope"] = np.einsum("kxg,xgn->kxn", powers * weights, shapes["slope"])
    return found


QUANTITIES = (*_FIELDS, *FORCES)
_UNITS = {"along": "m", "across": "m", "slope": "rad", "axial": "N", "shear": "N", "moment": "N m"}


@dataclass(frozen=True, kw_only=True)
class BeamForces(StationResult):
    """Displacements and forces along the beams.

    Speed, crank angles and stations: see :class:`StationResult`.

    Attributes
    ----------
    along, across : ndarray
        Displacements from the rigid beam, in its axes [m], shape ``(nt, stations)``.
    slope : ndarray
        Rotation of the section from the rigid beam [rad].
    axial : ndarray
        Axial force [N], tension positive.
    shear : ndarray
        Force across the rigid beam that the part behind exerts on the part before [N].
    moment : ndarray
        Bending moment [N m], positive where the beam is hollow on its positive side: E I v''.
    error : ndarray
        Largest error of axial force [N], shear force [N] and moment [N m] over angles and
        stations: by the error of the motion, and by the difference to a finer mesh or, where that
        is not to be had, of the two ways to recover them.
    """

    along: Array
    across: Array
    slope: Array
    axial: Array
    shear: Array
    moment: Array

    arrays_along: ClassVar = {"force": "error", "sample station": " ".join(QUANTITIES)}
    column_units: ClassVar = {"m": "along across", "rad": "slope", "N": "axial shear"}

    def of(self, link: str, quantity: str) -> Array:
        """Return one quantity along one beam, ``(nt, its stations)``.

        Raises ``BadInput`` if either is unknown.
        """
        require_one_of("quantity", quantity, QUANTITIES)
        return np.asarray(getattr(self, quantity)[:, stations_on(self.links, link)])

    def plot(self, ax: Axes | None = None, quantity: str = "moment") -> Axes:
        """Draw one quantity along each beam, between its extremes over the angles."""
        ax = axes_or_new(ax)
        for link in dict.fromkeys(self.links):
            own = stations_on(self.links, link)
            values = self.of(link, quantity)
            lines = ax.plot(self.places[own], values.max(axis=0), label=link, linewidth=0.9)
            ax.plot(self.places[own], values.min(axis=0), color=lines[0].get_color(), linewidth=0.9)
        ax.axhline(0.0, color="0.7", linewidth=0.6)
        ax.set(xlabel="place x/length", ylabel=f"extremes of {quantity} [{_UNITS[quantity]}]")
        ax.legend()
        return ax


def recover(
    system: LinearPeriodic,
    motion: Motion | float | None = None,
    *,
    stations: Stations = None,
    method: str = "equilibrium",
) -> BeamForces:
    """Return displacements and forces along the beams of a system in a motion.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    motion : SteadyState, Trajectory, BeamMotion, float or None
        A computed motion; a crank speed [rad/s], for the steady state there; None for a frame.
    stations : int or mapping of str to array_like, optional
        Places on each beam: how many, or by beam the places x/length; by default 25.
    method : str
        ``"equilibrium"``: end forces of the elements, and between nodes what balances inertia,
        weight and axial force.  ``"shape"``: E I v'' of the shape functions, Aannaque's way.

    Returns
    -------
    BeamForces

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> print(abs(el.recover(system, 20.0, stations=5).of("coupler", "moment")).max().round(2))
    0.47
    """
    require_method(method)
    chosen = stations_of(required_structure(system), stations)
    asked = Recovered(system, beam_motion(system, motion), stations, method)
    own: dict[str, Any] = dict(asked.values())
    return BeamForces(
        method=method,
        links=tuple(station.beam for station in chosen),
        places=np.array([station.place for station in chosen]),
        **in_motion(system, asked.motion, partial(_doubt, asked, own)),
        **own,
    )


def _doubt(asked: Recovered, own: Mapping[str, Array]) -> dict[str, Any]:
    norm = "largest error of axial force [N], shear force [N], moment [N m]"
    better, finer = asked.compared(FORCES)
    gaps = np.array([np.max(np.abs(own[name] - better[name])) for name in FORCES])
    sizes = np.array([np.max(np.abs(own[name])) for name in FORCES])
    share = CAUTION if finer else 1.0
    return {
        "error": share * gaps + asked.propagated() + ROUNDING * sizes,
        "error_norm": norm if finer else f"{norm}; that of the mesh's frequencies apart",
    }


@dataclass(frozen=True)
class Recovered:
    """Forces and displacements along the beams of a system in a motion, recovered by a method."""

    system: LinearPeriodic
    motion: BeamMotion
    stations: Stations
    method: str

    def values(self, names: tuple[str, ...] = QUANTITIES) -> dict[str, Array]:
        """Return quantities at all angles, ``(nt, stations)`` each."""
        chosen = stations_of(required_structure(self.system), self.stations)

        def piece(forms: ElementForms, values: MotionValues) -> dict[str, Array]:
            made, shape = recovery(forms, chosen, self.method), (len(forms.theta), len(chosen))
            return {name: np.broadcast_to(values(made[name]), shape) for name in names}

        return over_motion(self.system, self.motion, piece)

    def compared(self, names: tuple[str, ...]) -> tuple[dict[str, Array], bool]:
        """Return them on a finer mesh, or else by the other method; and whether there is one."""
        finer = on_finer_mesh(self.system, self.motion)
        if finer is not None:
            return Recovered(*finer, self.stations, "equilibrium").values(names), True
        other = next(name for name in METHODS if name != self.method)
        return replace(self, method=other).values(names), False

    def propagated(self) -> Array:
        """Return what the error of the motion can do to axial force, shear force and moment.

        The errors of the coordinates are taken to vary no faster than the crank turns, and not to
        cancel each other.
        """
        motion = self.motion
        if not np.any(motion.doubt):
            return np.zeros(len(FORCES))
        # A few angles tell the size of the coefficients.
        picked = np.linspace(0, len(motion.theta) - 1, min(len(motion.theta), 16)).astype(int)
        chosen = stations_of(required_structure(self.system), self.stations)
        made = recovery(checked_forms(self.system, motion.theta[picked]), chosen, "shape")
        rows = [made[name].at_speed(motion.speed)["q"] for name in FORCES]
        return np.array([np.max(np.abs(row) @ motion.doubt) for row in rows])
