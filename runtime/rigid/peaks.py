"""The greatest size of every force over a range of crank angles, between samples too."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..linkages.linkage import TURN, Array
from .forces import OUTPUTS, rigid_forces
from .machine import Machine

TERMS = ("shaking_force", "shaking_moment", "torque", "f12", "f23", "f34", "f41")
COUPLES = ("couple34", "couple41")

# Each of them in words, with its unit.
LABELS = {
    **{f"f{joint}": (f"pin force {joint}", "N") for joint in ("12", "23", "34", "41")},
    "torque": ("driving torque", "N m"),
    "shaking_force": ("force on the frame", "N"),
    "shaking_moment": ("moment on the frame", "N m"),
    **{f"couple{joint}": (f"couple of the slide {joint}", "N m") for joint in ("34", "41")},
}

_DEGREE = 12
_NODES = np.cos(np.pi * np.arange(_DEGREE + 1) / _DEGREE)
_ORDERS = np.arange(_DEGREE + 1.0)[:, np.newaxis]
_TO_POWERS = np.linalg.inv(np.vander(_NODES, increasing=True))

Forces = Callable[[Array], Mapping[str, Array]]


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
    machine: Machine,
    speed: float,
    acceleration: float = 0.0,
    *,
    span: tuple[float, float] = (0.0, TURN),
) -> dict[str, ForcePeak]:
    """Return the peak of every pin force, of torque, shaking force, moment and couple.

    The samples are doubled until no peak changes any more.  Between samples each is the summit of
    an interpolating polynomial of degree 12, twice, the second time in an eighth of the interval.
    Speed and acceleration are the crank's [rad/s, rad/s^2], the ends of ``span`` [rad] count; the
    names are ``f12`` ...  ``f41``, ``torque``, ``shaking_force``, ``shaking_moment`` and, where a
    joint slides, ``couple34`` or ``couple41``.
    """

    def forces(theta: Array) -> dict[str, Array]:
        return forces_of(machine, theta, speed, acceleration, (*TERMS, *COUPLES))

    count = 721
    before = _tops(forces, span, count)
    while True:
        count = 2 * count - 1
        after = _tops(forces, span, count)
        change = {name: abs(abs(after[name][0]) - abs(before[name][0])) for name in after}
        # A change on doubling the samples that ends the search.
        settled = all(change[name] <= 1e-11 * abs(after[name][0]) for name in after)
        if settled or count >= 23041:
            return {name: ForcePeak(*top, change[name]) for name, top in after.items()}
        before = after


def _tops(forces: Forces, span: tuple[float, float], count: int) -> dict[str, tuple[float, float]]:
    """Return value and angle of each peak, from so many samples."""
    tops = {}
    for name, (at, values) in highest(forces, np.linspace(*span, count), around=False).items():
        sizes = _sizes(values)
        # Of mirrored peaks always the same one.
        first = int(np.argmax(sizes >= (1.0 - 1e-13) * sizes.max()))
        one = values[first]
        tops[name] = (float(one[0] if one.size == 1 else sizes[first]), float(at[first]))
    return tops


def forces_of(
    machine: Machine, theta: Array, speed: float, acceleration: float, terms: Sequence[str]
) -> dict[str, Array]:
    """Return forces by name, each of shape (n, d); couples only where the machine has them."""
    of_pins = [term for term in terms if term[0] == "f" or term in COUPLES]
    wanted = [output for output in OUTPUTS if output in terms or (output == "pins" and of_pins)]
    result = rigid_forces(machine, theta, speed, acceleration, outputs=wanted)
    forces = {}
    for term in terms:
        if term not in COUPLES or term in result.values:
            part = result[term] if term in result.values else getattr(result, term)
            forces[term] = np.reshape(part, (len(theta), -1))
    return forces


def highest(forces: Forces, theta: Array, *, around: bool) -> dict[str, tuple[Array, Array]]:
    """Return angles (k,) and values (k, d) of the highest local peaks of each force, by angle.

    The samples ``theta`` are evenly spaced, and with ``around`` make a whole turn, the end not
    repeated; else the ends count.
    """
    sampled = forces(theta)
    width = float(theta[1] - theta[0])
    ends = (-np.inf, np.inf) if around else (theta[0], theta[-1])
    places = {name: _local(_sizes(each), around) for name, each in sampled.items()}
    starts = {name: theta[at] for name, at in places.items()}
    for half in (width, width / 8.0):
        middles = {name: np.clip(at, ends[0] + half, ends[1] - half) for name, at in starts.items()}
        nodes = {name: np.add.outer(at, half * _NODES) for name, at in middles.items()}
        for name, near in _at_own(forces, nodes).items():
            squares = np.sum(near**2, axis=1).reshape(-1, len(_NODES))
            starts[name] = middles[name] + half * _summits(squares)
    peaks = {}
    for name, refined in _at_own(forces, starts).items():
        sample = sampled[name][places[name]]
        # Where a load jumps, no polynomial is better than the sample.
        worse = _sizes(refined) < _sizes(sample)
        values = np.where(worse[:, np.newaxis], sample, refined)
        peaks[name] = (np.where(worse, theta[places[name]], starts[name]), values)
    return peaks


def _at_own(forces: Forces, places: Mapping[str, Array]) -> dict[str, Array]:
    """Return each force at angles of its own; all at once costs little more than one alone."""
    values = forces(np.concatenate([at.ravel() for at in places.values()]))
    own, first = {}, 0
    for name, at in places.items():
        own[name] = values[name][first : first + at.size]
        first += at.size
    return own


def _sizes(forces: Array) -> Array:
    return np.asarray(np.linalg.norm(forces, axis=1))


def _local(size: Array, around: bool) -> Array:
    """Return the places of the local maxima that may be the highest, in rising order."""
    edges = (size[-1:], size[:1]) if around else ([-np.inf], [-np.inf])
    padded = np.concatenate([edges[0], size, edges[1]])
    # Sampled peaks lower than this, over the highest, cannot be the highest one.
    chosen = (size >= padded[:-2]) & (size >= padded[2:]) & (size >= 0.75 * size.max())
    places = np.flatnonzero(chosen)
    # Of a force that all but stays the same, the highest samples are enough.
    return np.sort(places[np.argsort(-size[places], kind="stable")[:32]])


def _summits(squares: Array) -> Array:
    """Return where in [-1, 1] each row's interpolating polynomial is greatest near its top node."""
    series = _TO_POWERS @ squares.T
    slope = _ORDERS[1:] * series[1:]
    bend = _ORDERS[1:-1] * slope[1:]
    x = _NODES[np.argmax(squares, axis=1)]
    for _ in range(8):
        powers = x ** _ORDERS[:-1]
        rise, curve = np.sum(slope * powers, axis=0), np.sum(bend * powers[:-1], axis=0)
        falling = curve < 0.0
        x = np.clip(x - np.where(falling, rise / np.where(falling, curve, 1.0), 0.0), -1.0, 1.0)
    return np.asarray(x)
