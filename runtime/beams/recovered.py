"""Displacements and forces along the beams in a motion, as a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.deferred import DeferredGroup
from ..core.errors import bad
from ..core.families import LinearPeriodic
from .assembly import Array
from .beam_motion import BeamMotion, beam_motion, chunks
from .beam_result import StationResult, in_motion, stations_on
from .element_forms import required_structure
from .finer_mesh import CAUTION, ROUNDING, on_finer_mesh
from .recovery import FORCES, METHODS, Recovery, recovery, require_method, stations_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .beam_motion import Motion

QUANTITIES = ("along", "across", "slope", *FORCES)
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

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        **StationResult.dimensions,
        "error": ("force",),
        **dict.fromkeys(QUANTITIES, ("sample", "station")),
    }

    def of(self, link: str, quantity: str) -> Array:
        """Return one quantity along one beam, ``(nt, its stations)``.

        Raises
        ------
        BadInput
            If either is unknown.
        """
        if quantity not in QUANTITIES:
            raise bad("quantity", repr(quantity), f"one of {QUANTITIES}", "correct the name")
        return np.asarray(getattr(self, quantity)[:, stations_on(self.links, link)])

    def plot(self, ax: Axes | None = None, quantity: str = "moment") -> Axes:
        """Draw one quantity along each beam, between its extremes over the angles."""
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        for link in dict.fromkeys(self.links):
            own = stations_on(self.links, link)
            values = self.of(link, quantity)
            lines = ax.plot(self.places[own], values.max(axis=0), label=link, linewidth=0.9)
            ax.plot(self.places[own], values.min(axis=0), color=lines[0].get_color(), linewidth=0.9)
        ax.axhline(0.0, color="0.7", linewidth=0.6)
        ax.set_xlabel("place x/length")
        ax.set_ylabel(f"extremes of {quantity} [{_UNITS[quantity]}]")
        ax.legend()
        return ax


def recover(
    system: LinearPeriodic,
    motion: Motion | float | None = None,
    *,
    stations: int | Mapping[str, ArrayLike] | None = None,
    method: str = "equilibrium",
    finer_mesh: bool = True,
) -> BeamForces:
    """Return displacements and forces along the beams of a system in a motion.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    motion : SteadyState, Trajectory, BeamMotion, float or None
        As :func:`beam_motion` takes it.
    stations : int or mapping of str to array_like, optional
        Places on each beam: how many, or by beam the places x/length; by default 25.
    method : str
        ``"equilibrium"``: end forces of the elements, and between nodes what balances inertia,
        weight and axial force.  ``"shape"``: E I v'' of the shape functions, Aannaque's way.
    finer_mesh : bool
        Whether the error of the mesh is told by a finer one, as :func:`stress` does.

    Returns
    -------
    BeamForces

    Raises
    ------
    BadInput
        If an argument is unusable.
    """
    require_method(method)
    moving = beam_motion(system, motion)
    chosen = stations_of(required_structure(system), stations)
    own: dict[str, Any] = dict(evaluated(system, moving, stations, method))
    doubt = DeferredGroup(partial(_doubt, system, moving, stations, method, own, finer_mesh))
    return BeamForces(
        method=method,
        links=tuple(station.beam for station in chosen),
        places=np.array([station.place for station in chosen]),
        **in_motion(system, moving, doubt),
        **own,
    )


def _doubt(
    system: LinearPeriodic,
    moving: BeamMotion,
    stations: int | Mapping[str, ArrayLike] | None,
    method: str,
    own: Mapping[str, Array],
    finer_mesh: bool,
) -> dict[str, Any]:
    """Return the error figure and its norm."""
    norm = "largest error of axial force [N], shear force [N], moment [N m]"
    finer = on_finer_mesh(system, moving) if finer_mesh else None
    if finer is None:
        other = next(name for name in METHODS if name != method)
        better = evaluated(system, moving, stations, other, FORCES)
        norm = f"{norm}; that of the mesh's frequencies apart"
    else:
        better = evaluated(*finer, stations, "equilibrium", FORCES)
    gaps = np.array([np.max(np.abs(own[name] - better[name])) for name in FORCES])
    sizes = np.array([np.max(np.abs(own[name])) for name in FORCES])
    share = 1.0 if finer is None else CAUTION
    return {
        "error": share * gaps + propagated(system, moving, stations) + ROUNDING * sizes,
        "error_norm": norm,
    }


def evaluated(
    system: LinearPeriodic,
    motion: BeamMotion,
    stations: int | Mapping[str, ArrayLike] | None,
    method: str,
    names: tuple[str, ...] = QUANTITIES,
    *,
    frozen: bool = False,
) -> dict[str, Array]:
    """Return quantities ``(nt, stations)`` in a motion; of a frozen one, without any rates.

    Parameters
    ----------
    system, stations, method
        As :func:`recover` takes them.
    motion : BeamMotion
        The motion; a frozen one is taken for displacements without rates or accelerations.
    names : tuple of str
        Which quantities.
    frozen : bool
        Whether rates and accelerations of the coordinates are left out.
    """
    parts: dict[str, list[Array]] = {name: [] for name in names}
    for chunk in chunks(motion):
        made = recovery(system, motion.theta[chunk], stations, method)
        q, slope = motion.q[chunk], motion.slope[chunk]
        second = np.zeros_like(q) if frozen else None
        slope = np.zeros_like(q) if frozen else slope
        for name in names:
            parts[name].append(made.values(name, motion.speed, q, slope, second))
    return {name: np.concatenate(values) for name, values in parts.items()}


def propagated(
    system: LinearPeriodic, motion: BeamMotion, stations: int | Mapping[str, ArrayLike] | None
) -> Array:
    """Return what the error of the motion can do to axial force, shear force and moment.

    The errors of the coordinates are taken to vary no faster than the crank turns, and not to
    cancel each other.
    """
    if not np.any(motion.doubt):
        return np.zeros(len(FORCES))
    # A few angles tell the size of the coefficients.
    picked = np.linspace(0, len(motion.theta) - 1, min(len(motion.theta), 16)).astype(int)
    made: Recovery = recovery(system, motion.theta[picked], stations, "shape")
    found = []
    for name in FORCES:
        rows = made.forms[name].at_speed(motion.speed)
        found.append(max(float(np.max(np.abs(r) @ motion.doubt)) for r in (rows["q"],)))
    return np.array(found)
