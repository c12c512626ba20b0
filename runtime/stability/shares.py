"""Modes, crank held, and how much of each is in motions that meet, to label their band by.

Where modes veer, the averaged equation has modes of its own; the mean of a mode's frequency with
the crank held is what its phase in a turn is nearest to.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..core.families import LinearPeriodic
from ..core.trigonometric import even_angles
from ..periodic import monodromy
from ..periodic.first_order import canonical_form
from .edges.mode_labels import Modes

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_TOGETHER = 256
# Angles and speeds at which frequencies are worked out; between speeds they change little.
_ANGLES, _SPEEDS = 64, 65
# Log modulus from which a multiplier has left the circle, not by the noise of a double one.
_OFF = 1e-5


def held_modes_at(system: LinearPeriodic, speed: Array) -> Modes:
    """Return the modes with the crank held: mean frequencies in turns, shapes at angle 0.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    speed : ndarray, shape (k,)
        Speeds [rad/s].
    """
    n = system.size
    if not len(speed):
        return Modes(np.zeros((0, n)), np.zeros((0, n, n), dtype=complex), np.zeros((0, n, n)))
    some = np.linspace(np.min(speed), np.max(speed), _SPEEDS)
    turns, _, _ = _held(system, some, even_angles(system.period, _ANGLES))
    mean = np.mean(turns, axis=1) * some[:, None]
    frequency = np.stack([np.interp(speed, some, mean[:, j]) for j in range(n)], axis=1)
    _, shapes, mass = _held(system, speed, np.zeros(1))
    rows = np.swapaxes(shapes[:, 0], -1, -2).astype(complex)
    whole = system.period / (2 * np.pi)
    return Modes(frequency / speed[:, None] * whole, rows, mass[:, 0])


def _held(system: LinearPeriodic, speed: Array, theta: Array) -> tuple[Array, Array, Array]:
    """Return frequencies over the speed ``(k, nt, n)``, modes in columns, and the mass."""
    form = canonical_form(system, speed, {})
    shape = (len(speed), len(theta), system.size, system.size)
    mass = np.broadcast_to(form.require_mass(form.assemble("M", theta)), shape)
    held = np.zeros(shape)
    for names, sign in ((("K", "Kg"), 1.0), ("B", -1.0)):
        part = form.assemble(names, theta)
        held = held if part is None else held + sign * part
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    moved = inverse @ held @ np.swapaxes(inverse, -1, -2)
    square, vectors = np.linalg.eigh(0.5 * (moved + np.swapaxes(moved, -1, -2)))
    return np.sqrt(np.maximum(square, 0.0)), np.swapaxes(inverse, -1, -2) @ vectors, mass


def pair_shares(
    system: LinearPeriodic, modes: Modes, speed: Array, met: ComplexArray, rtol: float
) -> Array:
    """Return the shares of the modes in the action of pairs of motions, each row of sum 1.

    The action, energy over frequency, does not favour the high modes that a motion drags along.

    Parameters
    ----------
    system : LinearPeriodic
        Conservative.
    modes : Modes
        From :func:`held_modes_at`, at the speeds.
    speed : ndarray, shape (k,)
        Speeds within the bands [rad/s].
    met : ndarray of complex, shape (k,)
        Where on the unit circle the two multipliers of each band meet, in one half plane.
    rtol : float
        Of the monodromy matrices.

    Returns
    -------
    ndarray, shape (k, n)
    """
    k, n = modes.turns.shape
    shares = np.zeros((k, n))
    for start in range(0, k, _TOGETHER):
        part = slice(start, start + _TOGETHER)
        found = monodromy(system, speed[part], rtol=rtol)
        values, vectors = np.linalg.eig(np.ldexp(found.scaled, found.exponent[:, None, None]))
        values = values.astype(complex)
        chosen = _chosen(values, met[part])
        rows = np.arange(len(values))
        for column in chosen.T:
            motion = (vectors[rows, :, column] * found.scale)[:, :n]
            along = np.einsum("kjn,knh,kh->kj", modes.shapes[part].conj(), modes.mass[part], motion)
            action = np.abs(along) ** 2 * modes.turns[part]
            total = np.sum(action, axis=1, keepdims=True)
            shares[part] += 0.5 * action / np.where(total > 0.0, total, 1.0)
    return shares


def _chosen(values: ComplexArray, met: ComplexArray) -> NDArray[np.intp]:
    """Return the numbers of the two multipliers of each pair, shape ``(k, 2)``."""
    size = np.abs(np.log(np.abs(values)))
    away = np.abs(np.angle(values / met[:, None]))
    off = size > _OFF
    nearest = np.argsort(np.abs(values - met[:, None]), axis=1)[:, :2]
    # Off the circle: the one of nearest argument, of like ones the largest, and its inverse.
    first = np.argmin(np.where(off, np.round(away, 6) - 1e-9 * size, np.inf), axis=1)
    own = values[np.arange(len(values)), first]
    second = np.argmin(np.abs(values - (1.0 / own.conj())[:, None]), axis=1)
    gone = np.any(off, axis=1) & (away[np.arange(len(values)), first] < 0.5)
    pairs: NDArray[np.intp] = np.where(gone[:, None], np.stack([first, second], axis=1), nearest)
    return pairs
