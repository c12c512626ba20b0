"""A smooth periodic basis of the lowest natural modes of a mechanism held still at each angle.

Single modes cross and veer as the crank turns, and may come back exchanged or with the other sign;
the subspace that they span does neither where the next frequency keeps its distance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import require_whole
from ..core.trigonometric import (
    Array,
    PeriodicArray,
    differentiated,
    even_angles,
    interpolated,
    tail,
)

_FEWEST, _MOST = 64, 2048
# Upper harmonics, over the largest, at which the samples are taken to fix the basis.
RESOLVED = 1e-13
_USABLE = 1e-6


@dataclass(frozen=True)
class MovingBasis:
    """Basis Phi(theta) of the lowest natural modes, M-orthonormal, smooth and periodic.

    Attributes
    ----------
    series : PeriodicArray
        Phi as a trigonometric series, ``(n, m)`` at an angle.
    theta : ndarray
        The angles that it was fixed at [rad], even, shape ``(nt,)``.
    values, slopes : ndarray
        Phi and dPhi/dtheta there, shape ``(nt, n, m)``.
    kept, left_out : ndarray
        Highest frequency that the basis holds and lowest that it does not [rad/s], with the
        mechanism held still at each of these angles; infinite where all modes are kept.
    tail : float
        Upper harmonics of Phi over the largest one: how well the series has converged.
    """

    series: PeriodicArray
    theta: Array
    values: Array
    slopes: Array
    kept: Array
    left_out: Array
    tail: float

    def __call__(self, theta: Array) -> Array:
        """Return Phi at angles ``(nt,)`` [rad], shape ``(nt, n, m)``."""
        return self.series(np.asarray(theta, dtype=float))

    def derivative(self, theta: Array) -> Array:
        """Return dPhi/dtheta at angles ``(nt,)`` [rad], shape ``(nt, n, m)``."""
        return self.series.derivative(np.asarray(theta, dtype=float))

    def deflections_of(self, system: LinearPeriodic) -> dict[str, Any]:
        """Return how a system deflects by coordinates on the basis, as a LinearPeriodic has it."""
        found: dict[str, Any] = {}
        if system.shape is not None or system.moving_shape is not None:
            found["moving_shape"] = partial(_shapes, system, self)
        if system.relative_deflection is not None:
            found["relative_deflection"] = partial(_deflections, system.relative_deflection, self)
        return found

    @property
    def fixed(self) -> bool:
        """True where the basis does not depend on the angle."""
        return len(self.theta) == 1


def _shapes(system: LinearPeriodic, basis: MovingBasis, x: Array, theta: Array) -> Array:
    shapes = system.shapes(x, theta)
    assert shapes is not None
    return np.asarray(shapes @ basis(theta))


def _deflections(full: Callable[[Array], Array], basis: MovingBasis, theta: Array) -> Array:
    return np.asarray(full(theta) @ basis(theta))


@dataclass(frozen=True)
class StillModes:
    """All natural modes with the mechanism held still at even angles."""

    theta: Array  # the angles [rad], shape (nt,)
    squares: Array  # squared natural frequencies, rising, shape (nt, n)
    shapes: Array  # M-orthonormal modes, shape (nt, n, n)
    mass: Array  # M, shape (nt, n, n)


def moving_basis(system: LinearPeriodic, modes: int) -> MovingBasis:
    """Return a smooth periodic basis of the lowest modes of M and K held still at each angle.

    From angle to angle the basis is carried along with the least rotation within the subspace (the
    orthogonal factor of ``Phi(theta_k)^T M Phi(theta_k-1)``); the rotation that is left after a
    period is spread evenly over it.  It is fixed at as many even angles as it needs, 64 to 2048.

    Refused where M or K is not positive definite, the number of modes is none of 1 to n, or the
    subspace is not smooth and periodic: the frequencies of modes m and m + 1 come too close.
    """
    modes = require_whole("modes", modes, 1, system.size)
    if system.is_constant("M") and system.is_constant("K"):
        return _fixed_basis(system, modes)
    held = partial(still_modes, system)
    found = smooth_basis(system.period, modes, held, (_FEWEST, _MOST), RESOLVED)
    if not found.tail <= _USABLE:
        gap = float(np.min(found.left_out / found.kept))
        raise _rough(modes, f"a ratio of {gap:.6g} between the next frequency and its highest")
    return found


def _fixed_basis(system: LinearPeriodic, modes: int) -> MovingBasis:
    theta = np.zeros(1)
    squares, shapes = _lowest(system, theta)[:2]
    values = shapes[:, :, :modes]
    series = PeriodicArray(values.astype(complex), system.period)
    kept, left_out = _border(squares, modes)
    return MovingBasis(series, theta, values, np.zeros_like(values), kept, left_out, 0.0)


def smooth_basis(
    period: float,
    modes: int,
    held: Callable[[int], StillModes],
    angles: tuple[int, int],
    smooth: float,
) -> MovingBasis:
    """Return the basis at even angles, the fewest, doubled up to the most until it is smooth.

    ``held`` gives the modes of the mechanism held still at a number of even angles.
    """
    count, most = angles
    while True:
        found = carried_basis(period, modes, held(count))
        if found.tail <= smooth or 2 * count > most:
            return found
        count *= 2


def carried_basis(period: float, modes: int, still: StillModes) -> MovingBasis:
    """Return the basis of the lowest modes at even angles; refuse a span that is not periodic."""
    theta, squares, shapes, mass = still.theta, still.squares, still.shapes, still.mass
    values = shapes[:, :, :modes]
    carried = mass @ values
    turn = np.eye(modes)
    turns = [turn]
    for k in range(1, len(theta) + 1):
        here = k % len(theta)
        overlap = np.swapaxes(values[here], 0, 1) @ carried[k - 1]
        # The orthogonal factor of the polar decomposition.
        left, _, right = np.linalg.svd(overlap @ turn)
        turn = left @ right
        turns.append(turn)
    back = _evenly(turns[-1], len(theta))
    if back is None:
        raise _rough(modes, "a basis that comes back mirrored after a period")
    smooth = values @ (np.stack(turns[:-1]) @ back)
    phi, slopes = interpolated(smooth, period), differentiated(smooth, period)
    return MovingBasis(phi, theta, smooth, slopes, *_border(squares, modes), tail(smooth))


def still_modes(system: LinearPeriodic, angles: int) -> StillModes:
    """Return the natural modes with the mechanism held still at even angles."""
    theta = even_angles(system.period, angles)
    return StillModes(theta, *_lowest(system, theta))


def _lowest(system: LinearPeriodic, theta: Array) -> tuple[Array, Array, Array]:
    """Return squared natural frequencies, M-orthonormal modes and the mass at angles."""
    mass, stiffness = system.array("M", theta), system.array("K", theta)
    for term in system.terms:
        if term.array == "Kg" and term.power == 0:
            factor = 1.0 if term.scale is None else float(system.scale_values()[term.scale])
            stiffness = stiffness + factor * term(theta)
    try:
        values, shapes = flexible_modes(mass, stiffness)
    except np.linalg.LinAlgError as indefinite:
        found = "a mass or stiffness that is not positive definite at some angle"
        fix = "check the parameters; hold the structure"
        raise bad("system", found, "both positive definite", fix) from indefinite
    return 1.0 / values, shapes / np.sqrt(values)[:, None, :], mass


def flexible_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Return one over squared natural frequencies, falling, and K-orthonormal modes at angles.

    Where the matrices are ill-conditioned the last values are round-off, of either sign.  NumPy's
    ``LinAlgError`` says that a matrix is not positive definite.
    """
    np.linalg.cholesky(mass)
    root = np.linalg.inv(np.linalg.cholesky(stiffness))
    # The flexible modes are the large eigenvalues of the inverse problem, the accurate ones.
    flexible = root @ mass @ np.swapaxes(root, -1, -2)
    values, vectors = np.linalg.eigh(0.5 * (flexible + np.swapaxes(flexible, -1, -2)))
    return values[:, ::-1], np.swapaxes(root, -1, -2) @ vectors[:, :, ::-1]


def _border(squares: Array, modes: int) -> tuple[Array, Array]:
    kept = np.sqrt(squares[:, modes - 1])
    beyond = squares.shape[1] > modes
    return kept, np.sqrt(squares[:, modes]) if beyond else np.full_like(kept, np.inf)


def _evenly(turn: Array, count: int) -> Array | None:
    """Return rotations ``(count, m, m)`` that undo ``turn`` little by little; None if mirrored."""
    # turn^(-k/count) with the smallest angles; a pair of eigenvalues -1 is half a turn.
    from scipy.linalg import schur

    form, vectors = schur(turn, output="real")
    m = len(turn)
    flipped = []
    out = np.tile(np.eye(m), (count, 1, 1))
    share = -np.arange(count) / count
    k = 0
    while k < m:
        if k + 1 < m and abs(form[k + 1, k]) > 1e-14:
            angle = np.arctan2(form[k + 1, k], form[k, k])
            _turn_in(out, k, k + 1, angle * share)
            k += 2
            continue
        if form[k, k] < 0:
            flipped.append(k)
        k += 1
    if len(flipped) % 2:
        return None
    for first, second in zip(flipped[::2], flipped[1::2], strict=True):
        _turn_in(out, first, second, np.pi * share)
    return np.asarray(vectors @ out @ vectors.T)


def _turn_in(rotations: Array, first: int, second: int, angles: Array) -> None:
    """Put rotations by angles into the plane of two coordinates."""
    cosine, sine = np.cos(angles), np.sin(angles)
    rotations[:, first, first] = rotations[:, second, second] = cosine
    rotations[:, second, first], rotations[:, first, second] = sine, -sine


def _rough(modes: int, found: str) -> Exception:
    expected = "a subspace that is smooth and periodic in the crank angle"
    fix = "keep one mode more or less, so that the next frequency keeps its distance at all angles"
    return bad(f"modes = {modes}", found, expected, fix)
