"""Speeds in ranges, each with as few modes and harmonics as its speeds need."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..core.errors import BadInput, bad
from ..core.families import LinearPeriodic
from ..core.inputs import require_whole
from .balance import Balance, balance
from .condensed import Condensed, condense
from .expressions import sampled_arrays
from ..periodic.moving_basis import MovingBasis, StillModes, basis_of, still_modes
from ..core.trigonometric import Array

# Angles: a power of two; and how the harmonics of a motion compare with theirs.
_FEWEST, _MOST = 128, 1024
# Upper harmonics of a basis, over the largest, at which the angles resolve it.
_RESOLVED = 1e-9
# A gap to the next frequency at all angles that keeps a subspace smooth.
_GAP = 1.25
# Amplitude of a coefficient, over the largest, from which its harmonic counts; and how far beyond
# the highest that counts the first mode left out has to lie.
_SEEN = 1e-6
_BEYOND = 2.9
# How often the modes left out answer.
_ANSWERS = 2
# Share of the speeds below which a range is not worth its own reduced system.
_SHORT = 0.1
# Norm of the harmonics left out, over the wanted error, before four more are kept.
_CUT = 0.03
# Speeds in a range that tell how many harmonics it needs.
_PROBES = 3


@dataclass(frozen=True)
class Grid:
    """What all ranges share: the angles, arrays and modes there, subspaces that can be kept.

    Attributes
    ----------
    still : StillModes
        All modes at the angles.
    arrays : mapping
        Arrays of the system at the angles.
    bases : mapping of int to MovingBasis
        Smooth bases by number of modes, rising.
    reach : float
        Harmonic that the first mode left out has to lie beyond at each speed.
    """

    still: StillModes
    arrays: Mapping[str, Mapping[int, Array]]
    bases: Mapping[int, MovingBasis]
    reach: float


def grid_of(system: LinearPeriodic, modes: int | None, angles: int = _FEWEST) -> Grid:
    """Return the angles of a system, as many as its subspaces need.

    Parameters
    ----------
    system : LinearPeriodic
        The full system.
    modes : int, optional
        The number of modes to keep, where it is to be no other.
    angles : int
        The fewest.

    Raises
    ------
    BadInput
        If no subspace is smooth and periodic.
    """
    count = angles
    while True:
        still = still_modes(system, count)
        bases = _bases(system, still, modes)
        resolved = {m: b for m, b in bases.items() if b.tail <= _RESOLVED}
        if modes in resolved or (modes is None and len(resolved) >= min(3, len(bases)) > 0):
            break
        if 2 * count > _MOST:
            raise bad(
                "modes" if modes is None else f"modes = {modes}",
                "no subspace that the crank angle changes smoothly",
                "a gap to the next frequency at all angles",
                "give another number of modes",
            )
        count *= 2
    arrays = sampled_arrays(system, still.theta)
    return Grid(still, arrays, resolved, _BEYOND * _reach(arrays))


def _bases(system: LinearPeriodic, still: StillModes, modes: int | None) -> dict[int, MovingBasis]:
    """Return bases by number of modes, of those that leave a gap to the next frequency."""
    if modes is not None:
        count = require_whole("modes", modes, 1, system.size)
        return {count: basis_of(system, count, still)}
    found = {}
    for m in _numbers(still):
        try:
            found[m] = basis_of(system, m, still)
        except BadInput:
            # It comes back mirrored; another number of modes does not.
            continue
        if len(found) == 4:
            break
    return found


def _numbers(still: StillModes) -> list[int]:
    """Return the numbers of modes that leave a gap to the next frequency, and all."""
    ratios = np.sqrt(np.min(still.squares[:, 1:] / still.squares[:, :-1], axis=0))
    return [*(np.flatnonzero(ratios >= _GAP) + 1).tolist(), still.squares.shape[1]]


def limits(grid: Grid) -> Array:
    """Return the speeds [rad/s] up to which each number of modes with a gap reaches, rising."""
    lowest = np.sqrt(np.min(grid.still.squares, axis=0))
    return np.asarray(lowest[_numbers(grid.still)[:-1]] / grid.reach)


def wider(
    system: LinearPeriodic,
    grid: Grid,
    speed: float,
    beyond: int,
    known: dict[int, Condensed],
    fastest: float = np.inf,
) -> Condensed | None:
    """Return a system condensed to the fewest modes that do for a speed; None where none do.

    Parameters
    ----------
    system : LinearPeriodic
        The full system.
    grid : Grid
        Its angles.
    speed : float
        Speed [rad/s]: the first mode left out lies beyond ``grid.reach`` times it.
    beyond : int
        Number of modes that is not enough.
    known : dict
        Condensed systems by number of modes; what is made is put there.
    fastest : float
        Frequency beyond which none is kept [rad/s].
    """
    lowest = np.sqrt(np.min(grid.still.squares, axis=0))
    highest = np.sqrt(np.max(grid.still.squares, axis=0))
    for m in _numbers(grid.still):
        if m <= beyond or (m < system.size and lowest[m] < grid.reach * speed):
            continue
        if highest[m - 1] > fastest:
            return None
        if m not in known:
            try:
                basis = grid.bases.get(m) or basis_of(system, m, grid.still)
            except BadInput:
                # It comes back mirrored; another number of modes does not.
                continue
            if basis.tail > _RESOLVED and m < system.size:
                continue
            known[m] = condense(system, basis, answers=1, arrays=grid.arrays)
        return known[m]
    return None


def _reach(arrays: Mapping[str, Mapping[int, Array]]) -> int:
    """Return the highest harmonic of the stiffnesses and forces that counts."""
    highest = 1
    for name in ("K", "Kg", "f", "h", "p"):
        for values in arrays.get(name, {}).values():
            size = np.max(np.abs(np.fft.rfft(values.reshape(len(values), -1), axis=0)), axis=1)
            seen = np.flatnonzero(size > _SEEN * np.max(size, initial=0.0))
            highest = max(highest, int(seen[-1]) if len(seen) else 0)
    return highest


@dataclass(frozen=True)
class Range:
    """Speeds that share a reduced system.

    Attributes
    ----------
    part : slice
        Which of the rising speeds.
    condensed : Condensed
        The reduced system.
    whole : Balance
        Its balanced equation, of as many harmonics as the angles allow.
    harmonics : int
        How many a few of the speeds need.
    rate : float
        Highest frequency kept [rad/s].
    """

    part: slice
    condensed: Condensed
    whole: Balance
    harmonics: int
    rate: float


def ranges_of(
    system: LinearPeriodic, grid: Grid, speeds: Array, rtol: float, farther: float = 1.0
) -> list[Range]:
    """Return rising speeds in ranges with their reduced systems.

    Parameters
    ----------
    system : LinearPeriodic
        The full system.
    grid : Grid
        Angles and subspaces.
    speeds : ndarray
        Rising speeds [rad/s].
    rtol : float
        Wanted error, from which the number of harmonics follows.
    farther : float
        How much farther than by ``grid.reach`` the first mode left out has to lie.
    """
    modes = _modes_needed(grid, speeds * farther)
    edges = [0, *(np.flatnonzero(np.diff(modes)) + 1).tolist(), len(speeds)]
    found = []
    for begin, end in pairwise(edges):
        basis = grid.bases[int(modes[begin])]
        condensed = condense(system, basis, answers=_ANSWERS, arrays=grid.arrays)
        whole = balance(condensed, 7 * len(grid.still.theta) // 16)
        wanted = _harmonics(whole, speeds[begin:end], rtol)
        rate = float(np.max(basis.kept))
        found.append(Range(slice(begin, end), condensed, whole, wanted, rate))
    return found


def _modes_needed(grid: Grid, speeds: Array) -> NDArray[np.int64]:
    """Return the number of modes to keep at rising speeds, the same over stretches of them."""
    offered = list(grid.bases)
    lowest = np.array([np.min(grid.bases[m].left_out) for m in offered])
    enough = lowest[None, :] >= grid.reach * speeds[:, None]
    enough[:, -1] = True
    choice = np.argmax(enough, axis=1)
    for k in range(len(offered) - 1):
        if 0 < np.count_nonzero(choice == k) < _SHORT * len(speeds):
            choice[choice == k] = k + 1
    return np.asarray(np.array(offered)[choice], dtype=np.int64)


def _harmonics(whole: Balance, speeds: Array, rtol: float) -> int:
    """Return how many harmonics some of the speeds need, the amplitudes beyond them small."""
    picked = speeds[np.linspace(0, len(speeds) - 1, min(_PROBES, len(speeds))).astype(int)]
    wanted, tolerance = 4, _CUT * rtol
    for speed in picked:
        x = np.linalg.solve(whole.taylor(speed)[0], whole.load(speed))
        energy = np.sum(x.reshape(-1, whole.modes) ** 2, axis=1)
        each = np.concatenate([energy[:1], energy[1::2] + energy[2::2]])
        beyond = np.sqrt(np.cumsum(each[::-1])[::-1] / np.sum(each))
        small = np.flatnonzero(beyond <= tolerance)
        wanted = max(wanted, int(small[0]) if len(small) else whole.harmonics)
    return min(wanted + 4, whole.harmonics)


def last_harmonics(whole: Balance, series: Array) -> Array:
    """Return the norm of the last four harmonics over that of each motion, ``(ns,)``."""
    last = 8 * whole.modes
    return np.asarray(np.linalg.norm(series[-last:], axis=0) / np.linalg.norm(series, axis=0))
