"""Inverse dynamics of a rigid machine: pin forces, driving torque, shaking force and moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.inputs import names_in_a_row, require_one_of
from ..core.plotting import Axes, axes_or_new
from ..core.results import Deferred, DeferredChecks, DeferredField, Result, provenance
from ..linkages.linkage import JOINTS, TURN, Array, checked_drive
from .evaluation import COUPLES, FRAME_FORCE, Evaluation, Output
from .machine import Machine, require_machine

_LATER = DeferredField()
OUTPUTS: tuple[Output, ...] = ("pins", "torque", "shaking_force", "shaking_moment")
_POLAR = {
    **{joint: (f"x{joint}", f"y{joint}", f"pin force {joint}") for joint in JOINTS},
    "frame": (*FRAME_FORCE, "force on the frame"),
}
_CURVES = {
    "torque": ("torque", "driving torque [N m]"),
    "moment": ("shaking_moment", "shaking moment about A [N m]"),
}


@dataclass(frozen=True, kw_only=True)
class RigidForces(Result):
    """Forces of a rigid machine; every array has the common shape of angles, speeds, accelerations.

    Signs are Smith's (Fig. 11): ``f_ij`` is the force of link i upon link j, the torque acts on the
    crank, anticlockwise positive.  What was not requested raises :class:`BadInput`.

    ``error`` and the checks are computed when they are first read: power balance, the momenta,
    and the statics of each link, at some of the angles.

    Attributes
    ----------
    theta2, speed, acceleration : ndarray
        Crank angle [rad], crank speed [rad/s] and crank acceleration [rad/s^2], as given.
    values : mapping of str to ndarray
        The arrays by name: ``x12`` ... ``y41`` [N], the couple of the sliding joint where there is
        one [N m], ``torque`` [N m], ``shaking_x``, ``shaking_y`` [N], ``shaking_moment`` [N m].
    """

    theta2: Array
    speed: Array
    acceleration: Array
    values: Mapping[str, Array]
    error: Any = _LATER

    arrays_along: ClassVar = {
        "...": (
            "theta2 speed acceleration torque error couple34 couple41 "
            "x12 x23 x34 x41 y12 y23 y34 y41 shaking_x shaking_y shaking_moment"
        ),
    }

    def __getitem__(self, name: str) -> Array:
        """Return one array of ``values``; refuse one that was not requested."""
        if name not in self.values:
            fix = "ask for it in outputs"
            raise bad("RigidForces", f"no {name}", f"one of {sorted(self.values)}", fix)
        return self.values[name]

    def _pair(self, x: str, y: str) -> Array:
        return np.stack((self[x], self[y]), axis=-1)

    @property
    def f12(self) -> Array:
        """Force of the frame on the crank at A [N], shape (..., 2)."""
        return self._pair("x12", "y12")

    @property
    def f23(self) -> Array:
        """Force of link 2 on link 3 at B [N], shape (..., 2)."""
        return self._pair("x23", "y23")

    @property
    def f34(self) -> Array:
        """Force of link 3 on link 4 [N], shape (..., 2); a quick-return's acts at B."""
        return self._pair("x34", "y34")

    @property
    def f41(self) -> Array:
        """Force of link 4 on the frame [N], shape (..., 2)."""
        return self._pair("x41", "y41")

    @property
    def torque(self) -> Array:
        """Driving torque on the crank [N m]."""
        return self["torque"]

    @property
    def shaking_force(self) -> Array:
        """Force on the frame [N], shape (..., 2); defined in :func:`rigid_forces`."""
        return self._pair(*FRAME_FORCE)

    @property
    def shaking_moment(self) -> Array:
        """Moment on the frame about A [N m]; defined in :func:`rigid_forces`."""
        return self["shaking_moment"]

    def arrays(self) -> dict[str, Array]:
        """Return the numeric fields and the values by name."""
        return {**super().arrays(), **self.values}

    def _own_units(self) -> dict[str, str]:
        return {name: "N m" if name.startswith(COUPLES) else "N" for name in self.values}

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        plain = super().to_dict()
        values = plain.pop("values")
        return {**plain, **values}

    def plot(self, ax: Axes | None = None, joint: str | None = None) -> Axes:
        """Draw a polar diagram (Smith Figs. 12-16), or the torque against the crank angle.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        joint : {"12", "23", "34", "41", "frame", "torque", "moment"}, optional
            The pin force of a joint, the force on the frame, the torque or the moment; by default
            the first of frame, 34, torque, moment that was requested.

        Raises
        ------
        BadInput
            If the joint is unknown or its force was not requested.
        """
        known = {**_POLAR, **_CURVES}
        if joint is None:
            first = ("frame", "34", "torque", "moment")
            joint = next(name for name in first if known[name][0] in self.values)
        require_one_of("joint", joint, sorted(known))
        *names, label = known[joint]
        columns = [self[name] for name in names]
        if columns[0].ndim == 0:
            raise bad("plot", "one crank angle", "an array of them", "ask for more angles")
        ax = axes_or_new(ax)
        if joint in _CURVES:
            return _over_the_turn(ax, self.theta2, columns[0], label)
        for still, other, axis in ((0, 1, "Y"), (1, 0, "X")):
            # A force that keeps its line, such as that of a guide, has no polar diagram.
            if not np.any(columns[still]):
                return _over_the_turn(ax, self.theta2, columns[other], f"{label}, {axis} [N]")
        angles = np.broadcast_to(self.theta2, columns[0].shape)
        curves = _curves(angles, *columns)
        for _, across, up in curves:
            ax.plot(across, up)
        _mark(ax, *curves[0])
        ax.plot(0.0, 0.0, "+", color="k")
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(xlabel="X [N]", ylabel="Y [N]", title=label)
        return ax


def rigid_forces(
    machine: Machine,
    theta: ArrayLike,
    speed: ArrayLike,
    acceleration: ArrayLike = 0.0,
    outputs: Sequence[Output] = OUTPUTS,
) -> RigidForces:
    """Return the forces in a rigid machine whose crank moves as prescribed (Smith 4.7-4.13).

    Parameters
    ----------
    machine : Machine
        Linkage, masses, gravity, loads, springs.
    theta, speed, acceleration : array_like
        Crank angle [rad], crank speed [rad/s], crank acceleration [rad/s^2]; they broadcast.
    outputs : sequence of str
        Some of ``"pins"``, ``"torque"``, ``"shaking_force"``, ``"shaking_moment"``.  What is left
        out is not computed; each one alone takes its own shortest way.

    Returns
    -------
    RigidForces
        The shaking force is the resultant of all that the machine does to the frame, the weight
        of the frame apart: ``-dP/dt`` + applied loads + weights of the links.  A spring to the
        frame is part of the machine: what it does to the frame is counted, so that springs do not
        change the shaking force.  The shaking moment is that of the same forces about A, with the
        reaction of the drive: ``-dH_A/dt`` + moments of loads and weights.  (Smith's (4.13) lacks
        the reaction: without springs, M = l1 Y41 - T.)

    Raises
    ------
    BadInput
        If an output is unknown, shapes do not broadcast, a number is not finite, or the linkage
        cannot reach an angle or folds there.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> forces = el.rigid_forces(machine, theta=[0.0, 1.0], speed=10.0)
    >>> print(forces.f34.shape, forces.torque.round(3))
    (2, 2) [-2.188  0.713]
    """
    given = names_in_a_row("outputs", outputs)
    unknown = [item for item in given if item not in OUTPUTS]
    if unknown or not given:
        raise bad("outputs", f"{unknown or 'nothing'}", f"some of {OUTPUTS}", "correct the names")
    wanted = tuple(output for output in OUTPUTS if output in given)
    require_machine(machine)
    angles, speeds, accelerations, batch = checked_drive(theta, speed, acceleration)
    values = Evaluation(machine, angles, speeds, accelerations, batch).values(wanted)
    from . import force_errors

    state = (machine, angles, speeds, accelerations)
    return RigidForces(
        theta2=angles,
        speed=speeds,
        acceleration=accelerations,
        values=values,
        method="closed form",
        error=Deferred(partial(force_errors.error, *state)),
        error_norm=force_errors.NORM,
        checks=DeferredChecks(partial(force_errors.checks, *state, values)),
        provenance=provenance(machine.provenance),
    )


def pin_forces(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the pin forces alone (Smith 4.7-4.10); see :func:`rigid_forces`.

    Parameters
    ----------
    machine, theta, speed, acceleration
        As :func:`rigid_forces`.

    Returns
    -------
    RigidForces
        Its ``f12``, ``f23``, ``f34``, ``f41`` ``(..., 2)`` [N], of the first link on the second.

    Raises
    ------
    BadInput
        As :func:`rigid_forces`.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> print(el.pin_forces(machine, theta=1.0, speed=10.0).f23.round(2))
    [-10.1   -7.07]
    """
    return rigid_forces(machine, theta, speed, acceleration, ("pins",))


def driving_torque(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the driving torque alone (Smith 4.11); see :func:`rigid_forces`.

    Parameters
    ----------
    machine, theta, speed, acceleration
        As :func:`rigid_forces`.

    Returns
    -------
    RigidForces
        Its ``torque`` [N m] on the crank, of the shape of the broadcast arguments.

    Raises
    ------
    BadInput
        As :func:`rigid_forces`.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> print(el.driving_torque(machine, theta=[0.0, 1.0], speed=10.0).torque.round(3))
    [-2.188  0.713]
    """
    return rigid_forces(machine, theta, speed, acceleration, ("torque",))


def shaking_force(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the force on the frame alone (Smith 4.12); see :func:`rigid_forces`.

    Parameters
    ----------
    machine, theta, speed, acceleration
        As :func:`rigid_forces`.

    Returns
    -------
    RigidForces
        Its ``shaking_force`` ``(..., 2)`` [N].

    Raises
    ------
    BadInput
        As :func:`rigid_forces`.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> print(el.shaking_force(machine, theta=1.0, speed=10.0).shaking_force.round(2))
    [12.24  4.4 ]
    """
    return rigid_forces(machine, theta, speed, acceleration, ("shaking_force",))


def shaking_moment(
    machine: Machine, theta: ArrayLike, speed: ArrayLike, acceleration: ArrayLike = 0.0
) -> RigidForces:
    """Return the moment on the frame alone (Smith 4.13, completed); see :func:`rigid_forces`.

    Parameters
    ----------
    machine, theta, speed, acceleration
        As :func:`rigid_forces`.

    Returns
    -------
    RigidForces
        Its ``shaking_moment`` ``(...)`` [N m] about A, the reaction of the drive in it.

    Raises
    ------
    BadInput
        As :func:`rigid_forces`.

    Examples
    --------
    >>> import elastolink as el
    >>> machine = el.load_scene("smith_1972_12_6_12_12").machine()
    >>> print(el.shaking_moment(machine, theta=1.0, speed=10.0).shaking_moment.round(3))
    -1.971
    """
    return rigid_forces(machine, theta, speed, acceleration, ("shaking_moment",))


def _over_the_turn(ax: Axes, theta: Array, values: Array, label: str) -> Axes:
    degrees = np.degrees(np.broadcast_to(theta, values.shape))
    for row, value in _curves(degrees, values):
        ax.plot(row, value)
    ax.axhline(0.0, color="0.7", linewidth=0.8)
    ax.set(xlabel="crank angle [deg]", ylabel=label)
    return ax


def _mark(ax: Axes, theta: Array, x: Array, y: Array) -> None:
    """Mark every 30 degrees of a rising crank angle, each text where curve and texts leave room."""
    if theta.size < 2 or not np.all(np.diff(theta) > 0):
        return
    # Places in points of type: the curve takes some four fifths of the axes.
    size = ax.get_window_extent()
    points = 0.8 * min(size.width, size.height) * 72.0 / ax.figure.get_dpi()
    scale = points / (float(max(np.ptp(x), np.ptp(y))) or 1.0)
    taken = scale * np.stack([x, y], axis=-1)
    around = np.linspace(0.0, TURN, 16, endpoint=False)
    circle = np.stack([np.cos(around), np.sin(around)], axis=-1)
    offsets = np.concatenate([far * circle for far in (11.0, 17.0, 25.0, 36.0, 50.0, 70.0)])
    width = np.array([[-9.0, 0.0], [0.0, 0.0], [9.0, 0.0]])
    centred: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": "center"}
    line = {"arrowstyle": "-", "lw": 0.5, "color": "0.5"}
    for degrees in range(0, 360, 30):
        angle = np.radians(degrees)
        angle += TURN * np.ceil((theta[0] - angle) / TURN - 1e-12)
        if angle > theta[-1]:
            continue
        place = np.array([np.interp(angle, theta, values) for values in (x, y)])
        ax.plot(*place, "o", color="k", markersize=3)
        texts = scale * place + offsets[:, None, :] + width
        gaps = texts[:, :, None, :] - taken
        room = np.min(np.hypot(gaps[..., 0], gaps[..., 1]), axis=(1, 2))
        best = int(np.argmax(np.minimum(room, 8.0)))
        taken = np.concatenate([taken, texts[best]])
        arrow = line if np.hypot(*offsets[best]) > 12.0 else None
        text, at = tuple(offsets[best]), tuple(place)
        ax.annotate(f"{degrees}°", at, text, fontsize=7, arrowprops=arrow, **centred)


def _curves(*arrays: Array) -> list[tuple[Array, ...]]:
    """Return the curves along the first axis of angles; those of several speeds one by one."""
    flat = [np.atleast_1d(item).reshape(-1, item.shape[-1]) for item in arrays]
    return list(zip(*flat, strict=True))
