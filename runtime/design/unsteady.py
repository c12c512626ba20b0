"""Step maps of a linear periodic system whose crank speed changes in time."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from ..core.collocation import CollocationTableau, gauss_tableau
from ..core.families import DAMPING, LinearPeriodic
from .speed_profile import Array, SpeedProfile

# Floats of the stage equations of a block of steps that are solved together.
_BLOCK_FLOATS = 2_000_000
_INERTIA_POWER = {"f": 2, "h": 1, "p": 0}


@dataclass(frozen=True)
class Drive:
    """Crank angle, speed and acceleration at points of time, ``(nt,)`` each."""

    angle: Array
    speed: Array
    acceleration: Array

    @classmethod
    def of(cls, profile: SpeedProfile, time: Array) -> Drive:
        """Return those of a profile."""
        return cls(profile.angle(time), profile.speed(time), profile.acceleration(time))


Arrays = Callable[[Drive, Array], Mapping[str, Array]]


def arrays_of(
    system: LinearPeriodic, drive: Drive, only: Collection[str] | None = None
) -> dict[str, Array]:
    """Return the arrays of a system along a drive, terms with a power of the speed included.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    drive : Drive
        At points of time ``(nt,)``.
    only : collection of str, optional
        The arrays that are wanted; by default all.

    Returns
    -------
    dict of str to ndarray
        By array, ``(nt, n, n)`` or ``(nt, n)``; those without a term are left out.
    """
    scales = system.scale_values()
    found: dict[str, Array] = {}
    for term in system.terms:
        if only is not None and term.array not in only:
            continue
        value = term(drive.angle)
        factor = drive.speed**term.power * (1.0 if term.scale is None else scales[term.scale])
        value = value * factor.reshape(-1, *(1,) * (value.ndim - 1))
        found[term.array] = found[term.array] + value if term.array in found else value
    return found


def first_order(arrays: Mapping[str, Array], drive: Drive, size: int) -> tuple[Array, Array]:
    """Return L and g of ``y' = L y + g`` in time, y = (q, p = M qd + td A q).

    Returns
    -------
    generator : ndarray, shape (nt, 2n, 2n)
    forcing : ndarray, shape (nt, 2n)
    """
    count = len(drive.angle)
    speed, acceleration = drive.speed[:, None, None], drive.acceleration[:, None, None]
    none = np.zeros((count, size, size))
    inverse = np.linalg.inv(arrays["M"])
    drift = speed * arrays.get("A", none)
    back = inverse @ drift
    restoring = arrays.get("K", none) + arrays.get("Kg", none)
    restoring = restoring - speed**2 * arrays.get("B", none)
    restoring = restoring - acceleration * arrays.get("S", none)
    if any(name in arrays for name in DAMPING):
        restoring = restoring + speed * arrays.get("D", none)
    push = np.swapaxes(drift, -1, -2) - arrays.get("C", none)
    generator = np.empty((count, 2 * size, 2 * size))
    generator[:, :size, :size] = -back
    generator[:, :size, size:] = inverse
    generator[:, size:, :size] = -push @ back - restoring
    generator[:, size:, size:] = push @ inverse
    forcing = np.zeros((count, 2 * size))
    for name, power in _INERTIA_POWER.items():
        if name in arrays:
            forcing[:, size:] += drive.speed[:, None] ** power * arrays[name]
    if "g" in arrays:
        forcing[:, size:] += drive.acceleration[:, None] * arrays["g"]
    return generator, forcing


def march(
    find: Arrays, profile: SpeedProfile, size: int, start: Array, steps: int, stages: int
) -> tuple[Array, Array]:
    """Return times and states of Gauss-Legendre collocation with even steps.

    A-stable: modes far faster than the steps are damped or kept, never amplified, and not resolved.

    Parameters
    ----------
    find : callable
        Drive and times to the arrays.
    profile : SpeedProfile
        The drive.
    size : int
        Number n of coordinates.
    start : ndarray, shape (2n,)
        State at the first time.
    steps, stages : int
        Number of steps, and of stages in each.

    Returns
    -------
    time : ndarray, shape (steps + 1,)
    states : ndarray, shape (steps + 1, 2n)
    """
    tableau = gauss_tableau(stages)
    edges = np.linspace(profile.times[0], profile.times[-1], steps + 1)
    step = (edges[-1] - edges[0]) / steps
    block = max(1, _BLOCK_FLOATS // (stages * 2 * size) ** 2)
    states = np.empty((steps + 1, 2 * size))
    states[0] = start
    for first in range(0, steps, block):
        own = np.arange(first, min(first + block, steps))
        nodes = (edges[own][:, None] + step * tableau.c).ravel()
        drive = Drive.of(profile, nodes)
        generator, forcing = first_order(find(drive, nodes), drive, size)
        shape = (len(own), stages, 2 * size)
        matrix, shift = _step_maps(
            tableau, step, generator.reshape(*shape, 2 * size), forcing.reshape(shape)
        )
        for k, i in enumerate(own):
            states[i + 1] = states[i] + matrix[k] @ states[i] + shift[k]
    return edges, states


def _step_maps(
    tableau: CollocationTableau, step: float, generator: Array, forcing: Array
) -> tuple[Array, Array]:
    """Return the change of the state over each step: ``P y + r``.

    The stage slopes solve ``k_i = L_i (y + h sum_j a_ij k_j) + g_i``, all steps at once.
    """
    count, stages, m = forcing.shape
    system = -step * np.einsum("ij,nirc->nirjc", tableau.a, generator)
    diagonal, rows = np.arange(stages), np.arange(m)
    system[:, diagonal[:, None], rows, diagonal[:, None], rows] += 1.0
    right = np.concatenate([generator, forcing[..., None]], axis=-1)
    slopes = np.linalg.solve(
        system.reshape(count, stages * m, stages * m), right.reshape(count, stages * m, m + 1)
    ).reshape(count, stages, m, m + 1)
    total = np.einsum("i,nirc->nrc", step * tableau.b, slopes)
    return total[..., :m], total[..., m]
