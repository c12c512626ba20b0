"""Pictures of the forces: polar diagrams (Smith Figs. 12-16), torque and moment over the turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import bad
from ..core.plotting import axes_or_new
from .blocks import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .force_result import RigidForces

_POLAR = {
    "12": ("x12", "y12", "pin force 12"),
    "23": ("x23", "y23", "pin force 23"),
    "34": ("x34", "y34", "pin force 34"),
    "41": ("x41", "y41", "pin force 41"),
    "frame": ("shaking_x", "shaking_y", "force on the frame"),
}
_CURVES = {
    "torque": ("torque", "driving torque [N m]"),
    "moment": ("shaking_moment", "shaking moment about A [N m]"),
}
_DEFAULTS = ("frame", "34", "torque", "moment")
# Labels keep this share of the picture away from each other.
_APART = 0.06
_MARKS = np.radians(np.arange(0.0, 360.0, 30.0))


def draw(forces: RigidForces, ax: Axes | None, joint: str | None) -> Axes:
    """Draw one of the forces; see :meth:`RigidForces.plot`."""
    known = {**_POLAR, **_CURVES}
    if joint is None:
        there = [name for name in _DEFAULTS if known[name][0] in forces.values]
        joint = there[0]
    if joint not in known:
        raise bad("joint", repr(joint), f"one of {sorted(known)}", "correct the name")
    columns = [forces[name] for name in known[joint][:-1]]
    label = known[joint][-1]
    if columns[0].ndim == 0:
        raise bad("plot", "one crank angle", "an array of them", "ask for more angles")
    ax = axes_or_new(ax)
    if joint in _CURVES:
        return _over_the_turn(ax, forces.theta2, columns[0], label)
    for still, other, axis in ((0, 1, "Y"), (1, 0, "X")):
        # A force that keeps its line, such as that of a guide, has no polar diagram.
        if not np.any(columns[still]):
            return _over_the_turn(ax, forces.theta2, columns[other], f"{label}, {axis} [N]")
    return _hodograph(ax, forces.theta2, columns[0], columns[1], label)


def _over_the_turn(ax: Axes, theta: Array, values: Array, label: str) -> Axes:
    degrees = np.degrees(np.broadcast_to(theta, values.shape))
    for row, value in _rows(degrees, values):
        ax.plot(row, value)
    ax.axhline(0.0, color="0.7", linewidth=0.8)
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel(label)
    return ax


def _hodograph(ax: Axes, theta: Array, x: Array, y: Array, label: str) -> Axes:
    angles = np.broadcast_to(theta, x.shape)
    for _, across, up in _rows(angles, x, y):
        ax.plot(across, up)
    _mark(ax, *_rows(angles, x, y)[0])
    ax.plot(0.0, 0.0, "+", color="k")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("X [N]")
    ax.set_ylabel("Y [N]")
    ax.set_title(label)
    return ax


def _mark(ax: Axes, theta: Array, x: Array, y: Array) -> None:
    """Mark every 30 degrees of crank angle; no text where the marks crowd."""
    written: list[tuple[float, float]] = []
    apart = _APART * float(max(np.ptp(x), np.ptp(y)))
    for angle in _MARKS:
        place = _passing(theta, float(angle))
        if place is None:
            continue
        left, share = place
        px, py = (float(c[left] + share * (c[left + 1] - c[left])) for c in (x, y))
        ax.plot(px, py, "o", color="k", markersize=3)
        if any(np.hypot(px - qx, py - qy) < apart for qx, qy in written):
            continue
        written.append((px, py))
        # Away from the origin, where the curve seldom goes.
        size = float(np.hypot(px, py)) or 1.0
        ax.annotate(
            f"{np.degrees(angle):.0f}°",
            (px, py),
            xytext=(14.0 * px / size, 10.0 * py / size),
            textcoords="offset points",
            fontsize=7,
            ha="center",
            va="center",
        )


def _rows(*arrays: Array) -> list[tuple[Array, ...]]:
    """Return the curves along the first axis of angles; those of several speeds one by one."""
    flat = [np.atleast_1d(item).reshape(-1, item.shape[-1]) for item in arrays]
    return list(zip(*flat, strict=True))


def _passing(theta: Array, angle: float) -> tuple[int, float] | None:
    """Return where a rising row of angles passes one, up to whole turns: interval and share."""
    if theta.size < 2 or not np.all(np.diff(theta) > 0):
        return None
    turn = 2.0 * np.pi
    first = angle + turn * np.ceil((theta[0] - angle) / turn - 1e-12)
    if first > theta[-1]:
        return None
    left = min(max(int(np.searchsorted(theta, first, side="right")) - 1, 0), theta.size - 2)
    return left, float((first - theta[left]) / (theta[left + 1] - theta[left]))
