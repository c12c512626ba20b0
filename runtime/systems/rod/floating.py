"""The rod in Buckens' frame: nonlinear equations of motion with constraints, on free-free modes."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....derive.spec import ModelSpec
from ...core.errors import bad
from ...core.families import Array, Constrained, Guard
from ...core.modules import find_module
from ...linkages import QuickReturn
from .basis import require_drop, require_numbers, require_points
from .free_free import FreeFreeModes

DROPPED = ("tension",)
# Deflections over the length beyond which the equations mean nothing any more.
_BENT = 0.5
_STATIONS = np.linspace(0.0, 1.0, 21)


@dataclass(frozen=True)
class FreeFreeRod(Constrained):
    """The quick-return mechanism with a flexible rod, as a constrained system.

    Coordinates ``R1, R2`` [m] and ``gamma`` [rad], mean position and direction of the rod, and
    ``f1, ..., fN``: the displacement across the mean direction is ``L sum f_i psi_i(eta)`` with
    modes of unit square over unit length.  The crank angle is ``speed t``.

    Its reference motion is that of the undeformed rod, Beale & Scott's initial conditions; the
    largest deflection is watched; guards stop where the block leaves the rod's end or the
    deflection passes half of the rod's length.

    Attributes
    ----------
    linkage : QuickReturn
        The mechanism with the rod undeformed.
    modes : FreeFreeModes
        The modes of the rod.
    speed : float
        Crank speed [rad/s].
    bending_stiffness : float
        EI [N m^2].
    mass_per_length : float
        m [kg/m].
    """

    linkage: QuickReturn = field(kw_only=True)
    modes: FreeFreeModes = field(kw_only=True)
    speed: float = field(kw_only=True)
    bending_stiffness: float = field(kw_only=True)
    mass_per_length: float = field(kw_only=True)

    def undeformed(self, t: ArrayLike) -> tuple[Array, Array]:
        """Return coordinates and velocities of the undeformed rod, ``(*batch, n)`` each.

        They meet the constraints and their rates.
        """
        motion = self.linkage.motion(self.speed * np.asarray(t, dtype=float), self.speed)
        half = self.linkage.rod / 2.0
        sin, cos = np.sin(motion.theta4), np.cos(motion.theta4)
        q, qd = np.zeros((2, *motion.theta4.shape, self.size))
        q[..., 0], q[..., 1], q[..., 2] = half * cos, half * sin, motion.theta4
        qd[..., 0], qd[..., 1], qd[..., 2] = -half * sin, half * cos, 1.0
        return q, qd * np.asarray(motion.omega4)[..., None]

    def energy(self, q: Array, qd: Array, t: ArrayLike = 0.0) -> Array:
        """Return kinetic and strain energy [J], Beale & Scott (37) and (40); shape batch.

        Its rate is the power of the crank, the block's multiplier times the third entry of
        ``velocity_rhs``.  With the tension kept it is right to the second order in the amplitudes.

        Parameters
        ----------
        q, qd : ndarray, shape (*batch, n)
            Coordinates and velocities.
        t : array_like, shape batch
            Times [s].
        """
        moved = (self.dynamics(q, qd, t)["mass"] @ qd[..., None])[..., 0]
        bent = self.modes.roots**2 * q[..., 3:]
        elastic = self.bending_stiffness / self.linkage.rod * np.sum(bent**2, axis=-1)
        return np.asarray((np.sum(qd * moved, axis=-1) + elastic) / 2.0)

    def place_of_block(self, q: Array, t: ArrayLike) -> Array:
        """Return the distance of the block from the pin over the length; shape batch.

        Along the mean direction, ``x1/L`` with ``x1 = G cos(gamma - theta) + a_x cos(gamma)``,
        Beale & Scott (44).  Above 1 the block has left the rod, and the modes mean nothing there.
        """
        gamma, theta = q[..., 2], self.speed * np.asarray(t, dtype=float)
        linkage = self.linkage
        reached = linkage.crank * np.cos(gamma - theta) + linkage.frame * np.cos(gamma)
        return np.asarray(reached / linkage.rod)

    def deflection(self, q: Array, t: ArrayLike, places: ArrayLike) -> Array:
        """Return the deflection of the rod from the line through pin and block.

        That is v of the linear formulations: the distance from the line of the material point,
        which the foreshortening moves along the rod, to the second order.  At the tip it is that
        of Beale & Scott's Figs. 7-10 but for its sign.

        Parameters
        ----------
        q : ndarray, shape (*batch, n)
            Coordinates that meet the constraints.
        t : array_like, shape batch
            Times [s].
        places : array_like, shape (nx,)
            Places x/L on the rod, from 0 at the pin to 1 at the tip.

        Returns
        -------
        ndarray, shape (*batch, nx)
            Deflection [m], positive as the angle of the rod.

        Raises
        ------
        BadInput
            If a place is not on the rod, or the coordinates are not those of the system.
        """
        eta = require_points(places, "places", alone=True)
        if np.shape(q)[-1:] != (self.size,):
            raise bad("q", f"shape {np.shape(q)}", f"(..., {self.size})", "give all coordinates")
        return self._deflection(q, t, eta, self.modes(eta)[0])

    def _deflection(self, q: Array, t: ArrayLike, eta: Array, shapes: Array) -> Array:
        """Return the deflection at places at which the modes are known, ``(nx, m)``."""
        length = self.linkage.rod
        theta = self.speed * np.asarray(t, dtype=float)
        crank, frame = self.linkage.crank, self.linkage.frame
        line = np.arctan2(crank * np.sin(theta), frame + crank * np.cos(theta))
        lean = q[..., 2] - line
        centre = q[..., 1] * np.cos(line) - q[..., 0] * np.sin(line)
        bent = length * q[..., 3:] @ shapes.T
        along = length * (eta - 0.5) * np.sin(lean)[..., None]
        return np.asarray(centre[..., None] + along + bent * np.cos(lean)[..., None])

    @cached_property
    def _shapes(self) -> Array:
        """Modes at the stations, ``(21, m)``."""
        return self.modes(_STATIONS)[0]

    def largest_deflection(self, q: Array, t: ArrayLike) -> Array:
        """Return the largest deflection at 21 places, over the length of the rod; shape batch."""
        bent = np.abs(self._deflection(q, t, _STATIONS, self._shapes))
        return np.asarray(np.max(bent, axis=-1) / self.linkage.rod, dtype=np.float64)

    def _overhang(self, t: float, q: Array, qd: Array) -> float:
        return float(1.0 - self.place_of_block(q, t))

    def _unbent(self, t: float, q: Array, qd: Array) -> float:
        return _BENT - float(self.largest_deflection(q, t))


def free_free_rod(
    modes: int,
    *,
    crank_ratio: float,
    frame: float,
    length: float,
    bending_stiffness: float,
    mass_per_length: float,
    speed: float,
    drop: Collection[str] = (),
    provenance: Mapping[str, str] | None = None,
) -> FreeFreeRod:
    """Return the constrained equations of the flexible rod (Beale & Scott (29)-(49)).

    Parameters
    ----------
    modes : int
        Number N of elastic free-free modes.
    crank_ratio : float
        Crank length over base length G/a_x, positive; not 1.
    frame : float
        Base length a_x [m].
    length : float
        Length L of the rod from pin to tip [m].
    bending_stiffness : float
        EI [N m^2].
    mass_per_length : float
        m [kg/m].
    speed : float
        Crank speed [rad/s], not zero; the crank angle is ``speed t``.
    drop : collection of str
        ``("tension",)`` leaves out the second-order foreshortening and with it the centrifugal
        tension, as printed; ``()`` keeps it.
    provenance : mapping, optional
        Scene and options to record.

    Returns
    -------
    FreeFreeRod
        With N + 3 coordinates and three constraints.

    Raises
    ------
    BadInput
        If a number is not usable, a term to drop is unknown, or the crank cannot turn fully with
        the block on the rod.

    Notes
    -----
    Linearised about the undeformed rod this is :func:`rod_system` on :class:`FreeFreeBasis` with
    the same ``drop``.

    Examples
    --------
    >>> import elastolink as el
    >>> numbers = {"crank_ratio": 0.1, "frame": 0.6, "length": 1.0}
    >>> numbers |= {"bending_stiffness": 36456.0, "mass_per_length": 7.15}
    >>> rod = el.systems.free_free_rod(2, speed=100.0, **numbers)
    >>> print(rod.size, rod.constraints, round(rod.period, 5))
    5 3 0.06283
    """
    numbers = {
        "frame": frame,
        "length": length,
        "bending_stiffness": bending_stiffness,
        "mass_per_length": mass_per_length,
        "speed": speed,
    }
    require_numbers({"crank_ratio": crank_ratio, **numbers}, signed=("speed",))
    dropped = require_drop(drop, DROPPED)
    shapes = FreeFreeModes(modes)
    linkage = QuickReturn(frame=frame, crank=crank_ratio * frame, rod=length)
    linkage.require_full_turn()
    system = rod_equations(shapes, linkage, float(speed), numbers, dropped, provenance)
    rod = FreeFreeRod(
        **{f.name: getattr(system, f.name) for f in fields(Constrained)},
        linkage=linkage,
        modes=shapes,
        speed=float(speed),
        bending_stiffness=float(bending_stiffness),
        mass_per_length=float(mass_per_length),
    )
    return replace(
        rod,
        period=2.0 * np.pi / abs(rod.speed),
        # A crank longer than the base takes the rod round with it.
        advance=2.0 * np.pi * np.sign(speed) * (linkage.crank > frame) * np.eye(rod.size)[2],
        reference=rod.undeformed,
        watch=rod.largest_deflection,
        guards=(
            Guard(rod._overhang, "the block left the end of the rod"),
            Guard(rod._unbent, f"the deflection passed {_BENT:g} of the rod's length"),
        ),
    )


def rod_equations(
    modes: FreeFreeModes,
    linkage: QuickReturn,
    speed: float,
    parameters: Mapping[str, float],
    dropped: tuple[str, ...],
    origin: Mapping[str, str] | None = None,
) -> Constrained:
    """Return the equations of the emitted module for so many modes at a crank speed."""
    emitted = find_module(ModelSpec("quick_return", "free_free", ("rod",), modes.size, dropped))
    at_block = _AtBlock(modes, linkage, speed)
    parameters = {**parameters, "crank": linkage.crank, "speed": speed}
    return Constrained.from_module(
        emitted.module,
        parameters,
        external={f"psi{d}": at_block.modes(k) for k, d in enumerate(("", "_d1", "_d2", "_d3"))},
        modes={
            "left": modes.left_values,
            "stiffness": modes.roots**4,
            "inward": modes.slope_integrals["inward"],
            "retreat": modes.slope_integrals["retreat"],
        },
        drop=emitted.dropped,
        provenance={**(origin or {}), **emitted.provenance},
    )


class _AtBlock:
    """The modes at the place of the block, evaluated once for all that one state needs."""

    def __init__(self, modes: FreeFreeModes, linkage: QuickReturn, speed: float) -> None:
        self._modes, self._speed = modes, speed
        self._crank, self._frame = linkage.crank / linkage.rod, linkage.frame / linkage.rod
        self._last: tuple[object, tuple[Array, ...]] | None = None

    def modes(self, order: int) -> Callable[[Array, Array], ArrayLike]:
        """Return a derivative of the modes as a function of coordinates and time."""
        return lambda q, t: self._rows(q, t)[order]

    def _rows(self, q: Array, t: Any) -> tuple[Array, ...]:
        gamma: Any
        key: tuple[object, ...]
        single = q.ndim == 1 and (isinstance(t, float) or t.ndim == 0)
        if single:
            # Plain floats are several times faster than arrays of no dimension.
            key = gamma, t = float(q[2]), float(t)
        else:
            # Bytes are compared several times faster than small arrays.
            gamma = q[..., 2]
            key = gamma.shape, gamma.tobytes(), np.shape(t), np.asarray(t).tobytes()
        if self._last is None or self._last[0] != key:
            # The first part of the loop (44): the distance of the block from the pin.
            cos = math.cos if single else np.cos
            place = self._crank * cos(gamma - t * self._speed) + self._frame * cos(gamma)
            self._last = key, self._modes.at(place) if single else self._modes(place)
        return self._last[1]
