"""The greatest size of every force over a range of crank angles, between samples too."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .barrier import Array
from .force_basis import NODES, summit

if TYPE_CHECKING:
    from . import Machine, RigidForces

_FEWEST, _MOST = 721, 23041
# Sampled peaks lower than this, over the highest, cannot be the highest one.
_CANDIDATE = 0.75
_MOST_CANDIDATES = 64
# A change on doubling the samples that ends the search.
_SAME = 1e-11
_EQUAL = 1e-13


@dataclass(frozen=True)
class ForcePeak:
    """The value of greatest size: a magnitude, or a torque or moment with its sign.

    Attributes
    ----------
    value : float
        Force [N], or torque, moment or couple [N m].
    crank_angle : float
        Where [rad].
    error : float
        Change of its size on the last doubling of the samples.
    """

    value: float
    crank_angle: float
    error: float


def force_peaks(
    machine: Machine, span: tuple[float, float], speed: float, acceleration: float = 0.0
) -> dict[str, ForcePeak]:
    """Return the peak of every pin force, of torque, shaking force, moment and couple.

    The samples are doubled until no peak changes any more.  Between samples each is the summit of
    an interpolating polynomial of degree 12, twice, the second time in an eighth of the interval.

    Parameters
    ----------
    machine : Machine
        Whose forces.
    span : tuple of 2 floats
        First and last crank angle [rad]; the ends count.
    speed, acceleration : float
        Of the crank [rad/s, rad/s^2].

    Returns
    -------
    mapping of str to ForcePeak
        ``f12`` ... ``f41``, ``torque``, ``shaking_force``, ``shaking_moment`` and, where a joint
        slides, ``couple34`` or ``couple41``.

    Raises
    ------
    BadInput
        As :func:`~elastolink.runtime.rigid.rigid_forces`.
    """
    count = _FEWEST
    before = _peaks(machine, span, speed, acceleration, count)
    while True:
        count = 2 * count - 1
        found = _peaks(machine, span, speed, acceleration, count)
        change = {name: abs(abs(found[name][0]) - abs(before[name][0])) for name in found}
        settled = all(change[name] <= _SAME * abs(found[name][0]) for name in found)
        if settled or count >= _MOST:
            break
        before = found
    return {name: ForcePeak(*values, change[name]) for name, values in found.items()}


def _peaks(
    machine: Machine, span: tuple[float, float], speed: float, acceleration: float, count: int
) -> dict[str, tuple[float, float]]:
    """Return value and angle of each peak, from so many samples."""
    from . import rigid_forces

    def values(theta: Array) -> dict[str, Array]:
        return _sizes(rigid_forces(machine, theta, speed, acceleration))

    theta = np.linspace(*span, count)
    width = (span[1] - span[0]) / (count - 1)
    starts = {name: _local(theta, np.abs(each)) for name, each in values(theta).items()}
    for half in (width, width / 8.0):
        # All at once: an evaluation for all costs little more than one for each.
        middle = {name: np.clip(at, span[0] + half, span[1] - half) for name, at in starts.items()}
        joined = np.concatenate([*middle.values()])
        near = values((joined[:, None] + half * NODES).ravel())
        place = 0
        for name, at in middle.items():
            rows = near[name].reshape(-1, len(NODES))[place : place + len(at)]
            starts[name] = at + half * np.array([summit(row * row) for row in rows])
            place += len(at)
    # A summit is no better than an end or a sample that lies higher.
    joined = np.sort(np.concatenate([*starts.values(), theta]))
    final = values(joined)
    tops = {name: _first_of_the_highest(np.abs(each)) for name, each in final.items()}
    return {name: (float(final[name][top]), float(joined[top])) for name, top in tops.items()}


def _first_of_the_highest(size: Array) -> int:
    """Return the first place that is as high as any: of two mirrored peaks, always the same."""
    return int(np.argmax(size >= (1.0 - _EQUAL) * size.max()))


def _local(theta: Array, size: Array) -> Array:
    """Return the sampled angles of the local maxima that may be the highest, ends included."""
    padded = np.concatenate([[-np.inf], size, [-np.inf]])
    chosen = (size >= padded[:-2]) & (size >= padded[2:]) & (size >= _CANDIDATE * size.max())
    found = np.flatnonzero(chosen)
    # Of a force that all but stays the same, the highest samples are enough.
    highest = found[np.argsort(-size[found], kind="stable")[:_MOST_CANDIDATES]]
    return np.asarray(theta[highest])


def _sizes(forces: RigidForces) -> dict[str, Array]:
    """Return magnitudes of forces; torque, moment and couples with their signs."""
    found = {}
    for joint in ("12", "23", "34", "41"):
        found["f" + joint] = np.hypot(forces["x" + joint], forces["y" + joint])
    found["torque"] = forces.torque
    found["shaking_force"] = np.hypot(forces["shaking_x"], forces["shaking_y"])
    found["shaking_moment"] = forces.shaking_moment
    found.update({name: forces[name] for name in forces.values if name.startswith("couple")})
    return found
