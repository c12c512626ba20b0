"""Self-checks of clearance ranges: the loop closes at both ends, and the first order is right."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.results import Check
from . import FourBar, QuickReturn
from ._joint_play import Play
from .clearance import Task

Array = NDArray[np.float64]
_EPS = float(np.finfo(float).eps)
# Of the play at which the linkage folds: the terms beyond the first order are of its square.
_SMALL_PLAY = 1e-4


def checks(task: Task, play: Play) -> dict[str, Check]:
    """Close the loop at both ends, and take a small part of the clearances."""
    return {
        "loop closure at both ends over its round-off": Check(_gap(task, play), 1.0),
        "small clearances against the first order": Check(_first_order(task), 1.0),
    }


def _gap(task: Task, play: Play) -> float:
    """Return how far the loop with all clearance taken up stays open, over its round-off."""
    sizes = task.linkage.unit_lengths
    longest = max(abs(size) for size in sizes.values())
    limit = 64.0 * _EPS * longest * np.maximum(np.abs(task.theta), 1.0)
    blur = limit + longest * (play.error + play.nominal_error)
    pin = sizes["crank"] * np.exp(1j * task.theta)
    worst = 0.0
    for end in (play.nominal - play.below, play.nominal + play.above):
        missing = np.where(play.free, 0.0, _missing(task, sizes, pin, end))
        worst = max(worst, float(np.max(np.abs(missing) / blur, initial=0.0)))
    return worst


def _missing(task: Task, sizes: Mapping[str, float], pin: Any, end: Array) -> Array:
    """Return by how much the loop at an end of the range leaves or exceeds the play."""
    play, guide = task.radius, task.guide
    if isinstance(task.linkage, QuickReturn):
        away = np.abs(((pin + sizes["frame"]) * np.exp(-1j * end)).imag)
        return np.asarray(away - (play + guide))
    if isinstance(task.linkage, FourBar):
        own, other, span = sizes["follower"], sizes["coupler"], pin - sizes["frame"]
        if task.link == "coupler":
            own, other, span = other, own, -span
        bridged = np.abs(own * np.exp(1j * end) - span)
        return _nearest(bridged - (other + play), bridged - (other - play))
    gap = sizes["offset"] - pin.imag
    if task.link == "coupler":
        height = sizes["coupler"] * np.sin(end) - gap
        return _nearest(height - (play + guide), height + (play + guide))
    along, coupler = end - pin.real, sizes["coupler"]
    near, far = np.maximum(np.abs(gap) - guide, 0.0), np.abs(gap) + guide
    return _nearest(
        np.hypot(along, near) - (coupler + play), np.hypot(along, far) - (coupler - play)
    )


def _nearest(one: Any, other: Any) -> Array:
    return np.asarray(np.minimum(np.abs(one), np.abs(other)))


def _first_order(task: Task) -> float:
    """Return how far small clearances leave the first order, over what the next order may do.

    The series in the radius of play converges up to the first fold; its next term but one is of
    the second power of that ratio.
    """
    whole = task.radius + task.guide
    if whole == 0.0 or task.theta.size == 0:
        return 0.0
    route = task.route
    full = route.at(task.theta, task.radius, task.guide)
    margin = np.maximum(full.margin, 0.0)
    part = _SMALL_PLAY * margin / whole
    small = route.at(task.theta, task.radius * part, task.guide * part)
    apart = np.abs(small.below + small.above - small.small)
    allowed = 8.0 * _SMALL_PLAY**2 * small.small + 4.0 * small.error
    if task.link == "slider":
        # Across the guide the first order vanishes where the coupler lies along it.
        leg = np.sqrt(task.linkage.unit_lengths["coupler"] * np.maximum(margin, _EPS))
        allowed = allowed + 2.0 * (task.guide * part) ** 2 / leg
    clear = full.margin > 1e6 * full.blur
    return float(np.max(apart[clear] / allowed[clear], initial=0.0))
