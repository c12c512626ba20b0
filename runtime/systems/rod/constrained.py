"""The rod in Buckens' frame: nonlinear equations of motion with constraints, on free-free modes."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....derive.spec import ModelSpec
from ...core.errors import bad
from ...core.families import Array, Constrained
from ...linkages import QuickReturn
from ..modules import find_module
from .free_free import FreeFreeModes
from .inputs import require_drop, require_numbers, require_points

DROPPED = ("tension",)
_DERIVATIVES = ("psi", "psi_d1", "psi_d2", "psi_d3")
_STATIONS = np.linspace(0.0, 1.0, 21)


@dataclass(frozen=True)
class FreeFreeRod(Constrained):
    """The quick-return mechanism with a flexible rod, as a constrained system.

    Coordinates ``R1, R2`` [m] and ``gamma`` [rad], mean position and direction of the rod, and
    ``f1, ..., fN``: the displacement across the mean direction is ``L sum f_i psi_i(eta)`` with
    modes of unit square over unit length.  The crank angle is ``speed t``.

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
    """

    linkage: QuickReturn = field(kw_only=True)
    modes: FreeFreeModes = field(kw_only=True)
    speed: float = field(kw_only=True)
    bending_stiffness: float = field(kw_only=True)

    @property
    def period(self) -> float:
        """Duration of a revolution of the crank [s]."""
        return 2.0 * np.pi / abs(self.speed)


class RigidState(NamedTuple):
    """Coordinates and velocities of the undeformed rod, shape ``(*theta.shape, n)`` each."""

    q: Array
    qd: Array


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
    """
    positive = {
        "crank_ratio": crank_ratio,
        "frame": frame,
        "length": length,
        "bending_stiffness": bending_stiffness,
        "mass_per_length": mass_per_length,
    }
    require_numbers({**positive, "speed": speed}, signed=("speed",))
    dropped = require_drop(drop, DROPPED)
    shapes = FreeFreeModes(modes)
    linkage = QuickReturn(frame=frame, crank=crank_ratio * frame, rod=length)
    linkage.require_full_turn()
    spec = ModelSpec("quick_return", "free_free", ("rod",), shapes.size, dropped)
    emitted = find_module(spec)
    at_block = _AtBlock(shapes, linkage, float(speed))
    system = Constrained.from_module(
        emitted.module,
        {
            "crank": linkage.crank,
            "frame": frame,
            "length": length,
            "bending_stiffness": bending_stiffness,
            "mass_per_length": mass_per_length,
            "speed": speed,
        },
        external={name: at_block.modes(order) for order, name in enumerate(_DERIVATIVES)},
        modes={
            "left": shapes.left_values,
            "stiffness": shapes.roots**4,
            "inward": shapes.shortening[0],
            "retreat": shapes.shortening[1],
        },
        drop=emitted.dropped,
        provenance={**(provenance or {}), **emitted.provenance},
    )
    own = {f.name: getattr(system, f.name) for f in fields(Constrained)}
    return FreeFreeRod(
        **own,
        linkage=linkage,
        modes=shapes,
        speed=float(speed),
        bending_stiffness=float(bending_stiffness),
    )


class _AtBlock:
    """The modes at the place of the block, found once for all that is asked at one state."""

    def __init__(self, modes: FreeFreeModes, linkage: QuickReturn, speed: float) -> None:
        self._modes, self._speed = modes, speed
        self._crank, self._frame = linkage.crank / linkage.rod, linkage.frame / linkage.rod
        self._last: tuple[float, float, tuple[Array, ...]] | None = None
        self._last_batch: tuple[object, tuple[Array, ...]] | None = None

    def modes(self, order: int) -> Callable[[Array, Array], ArrayLike]:
        """Return a derivative of the modes as a function of coordinates and time."""

        def values(q: Array, t: Array) -> ArrayLike:
            if q.ndim == 1 and np.ndim(t) == 0:
                return self._single(float(q[2]), float(t))[order]
            return self._batch(q[..., 2], t)[order]

        return values

    def _single(self, gamma: float, t: float) -> tuple[Array, ...]:
        last = self._last
        if last is None or last[0] != gamma or last[1] != t:
            # Plain floats are several times faster than arrays of no dimension.
            turned = math.cos(gamma - t * self._speed)
            found = self._modes.at(self._crank * turned + self._frame * math.cos(gamma))
            self._last = last = (gamma, t, found)
        return last[2]

    def _batch(self, gamma: Array, t: Array) -> tuple[Array, ...]:
        last = self._last_batch
        # Bytes are compared several times faster than small arrays.
        key = (gamma.shape, gamma.tobytes(), np.shape(t), np.asarray(t).tobytes())
        if last is None or last[0] != key:
            # The first part of the loop (44): the distance of the block from the pin.
            turned = np.cos(gamma - t * self._speed)
            found = self._modes(self._crank * turned + self._frame * np.cos(gamma))
            self._last_batch = last = (key, found)
        return last[1]


def rigid_state(rod: FreeFreeRod, theta: ArrayLike) -> RigidState:
    """Return the state of the undeformed rod, Beale & Scott's initial conditions.

    It meets the constraints and their rates.

    Parameters
    ----------
    rod : FreeFreeRod
        The system.
    theta : array_like
        Crank angles [rad], any shape.

    Returns
    -------
    RigidState
        Coordinates ``q`` and velocities ``qd`` at the rod's crank speed, ``(*theta.shape, n)``.

    Raises
    ------
    BadInput
        If an angle is not a finite number.
    """
    motion = rod.linkage.motion(theta, rod.speed)
    half = rod.linkage.rod / 2.0
    sin, cos = np.sin(motion.theta4), np.cos(motion.theta4)
    q = np.zeros((*motion.theta4.shape, rod.size))
    qd = np.zeros_like(q)
    q[..., 0], q[..., 1], q[..., 2] = half * cos, half * sin, motion.theta4
    qd[..., 0] = -half * sin * motion.omega4
    qd[..., 1] = half * cos * motion.omega4
    qd[..., 2] = motion.omega4
    return RigidState(q, qd)


def energy(rod: FreeFreeRod, q: Array, qd: Array, t: ArrayLike = 0.0) -> Array:
    """Return kinetic and strain energy of the rod, Beale & Scott (37) and (40).

    Its rate is the power of the crank, the block's multiplier times the third entry of
    ``velocity_rhs``.

    Parameters
    ----------
    rod : FreeFreeRod
        The system.
    q, qd : ndarray, shape (*batch, n)
        Coordinates and velocities.
    t : array_like, shape batch
        Times [s].

    Returns
    -------
    ndarray, shape batch
        Energy [J]; with the tension kept, to the second order in the amplitudes.
    """
    moved = (rod.dynamics(q, qd, t)["mass"] @ qd[..., None])[..., 0]
    bent = rod.modes.roots**2 * q[..., 3:]
    elastic = rod.bending_stiffness / rod.linkage.rod * np.sum(bent**2, axis=-1)
    return np.asarray((np.sum(qd * moved, axis=-1) + elastic) / 2.0)


def place_of_block(rod: FreeFreeRod, q: Array, t: ArrayLike) -> Array:
    """Return the distance of the block from the pin along the mean direction, over the length.

    Above 1 the block has left the rod, and the modes mean nothing there.

    Parameters
    ----------
    rod : FreeFreeRod
        The system.
    q : ndarray, shape (*batch, n)
        Coordinates.
    t : array_like, shape batch
        Times [s].

    Returns
    -------
    ndarray, shape batch
        ``x1 / L`` with ``x1 = G cos(gamma - theta) + a_x cos(gamma)``, Beale & Scott (44).
    """
    gamma, theta = q[..., 2], rod.speed * np.asarray(t, dtype=float)
    reached = rod.linkage.crank * np.cos(gamma - theta) + rod.linkage.frame * np.cos(gamma)
    return np.asarray(reached / rod.linkage.rod)


def deflection(rod: FreeFreeRod, q: Array, t: ArrayLike, places: ArrayLike) -> Array:
    """Return the deflection of the rod from the line through pin and block.

    That is v of the linear formulations: the distance from the line of the material point, which
    the foreshortening moves along the rod, to the second order.

    Parameters
    ----------
    rod : FreeFreeRod
        The system.
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
    if np.shape(q)[-1:] != (rod.size,):
        raise bad("q", f"shape {np.shape(q)}", f"(..., {rod.size})", "give all coordinates")
    length = rod.linkage.rod
    line = np.asarray(rod.linkage.motion(rod.speed * np.asarray(t, dtype=float)).theta4)
    lean = q[..., 2] - line
    centre = q[..., 1] * np.cos(line) - q[..., 0] * np.sin(line)
    bent = length * q[..., 3:] @ rod.modes(eta)[0].T
    along = length * (eta - 0.5) * np.sin(lean)[..., None]
    return np.asarray(centre[..., None] + along + bent * np.cos(lean)[..., None])


def largest_deflection(rod: FreeFreeRod, q: Array, t: ArrayLike) -> Array:
    """Return the largest deflection at 21 places, over the length of the rod; shape batch."""
    bent = np.abs(deflection(rod, q, t, _STATIONS))
    return np.asarray(np.max(bent, axis=-1) / rod.linkage.rod, dtype=np.float64)


def tip_deflection(rod: FreeFreeRod, q: Array, t: ArrayLike) -> Array:
    """Return the deflection of the tip from the line through pin and block, v(L) [m].

    Parameters
    ----------
    rod : FreeFreeRod
        The system.
    q : ndarray, shape (*batch, n)
        Coordinates that meet the constraints.
    t : array_like, shape batch
        Times [s].

    Returns
    -------
    ndarray, shape batch
        Deflection [m]; the tip deflection of Beale & Scott's Figs. 7-10 but for its sign.
    """
    return deflection(rod, q, t, 1.0)[..., 0]
