"""Smooth periodic bases of the slow and the fast natural modes, crank held, at each crank angle.

A single mode is not smooth where its frequency meets a neighbour's; the span of the lowest k is,
as long as a gap stays open above them.  The bases are made of the projectors on the two spans.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import bad
from ...core.trigonometric import even_angles
from ..first_order import CanonicalForm

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Angles over which bases are carried, and harmonics of them that are kept to steer by.
_STEPS, _WAVES = 256, 24
_FEWEST, _MOST = 64, 2048
# Tail of the Fourier series of the bases, over their size, that counts as round-off.
_TAIL = 1e-13
# Least singular value, over the mean mass, of a basis that is still smooth and regular.
_REGULAR = 0.05


@dataclass(frozen=True)
class Frames:
    """Bases of displacements at even crank angles, orthonormal by the mass.

    Attributes
    ----------
    theta : ndarray
        Even crank angles over the period [rad], shape ``(nt,)``.
    basis : ndarray
        The k slow columns, then the fast ones, shape ``(nt, n, n)``.
    slope : ndarray
        Its derivative by the crank angle, shape ``(nt, n, n)``.
    modes : int
        Number k of slow modes.
    level : ndarray
        Mean stiffness of each column, the root of it a frequency [rad/s], shape ``(n,)``.
    slow, fast : ndarray
        Natural frequencies with the crank held [rad/s], shapes ``(nt, k)`` and ``(nt, n - k)``.
    """

    theta: Array
    basis: Array
    slope: Array
    modes: int
    level: Array
    slow: Array
    fast: Array


def held_modes(form: CanonicalForm, theta: Array) -> tuple[Array, Array, Array, Array]:
    """Return natural frequencies [rad/s], modes, mass and stiffness of the first of a batch.

    The stiffness is K + Kg; negative squares count as frequency 0.

    Returns
    -------
    frequency, modes, mass, stiffness : ndarray
        Shapes ``(nt, n)``, rising, and ``(nt, n, n)``; the modes are columns of unit mass.
    """
    one = form.take(slice(0, 1))
    count, n = len(theta), form.system.size
    mass = np.broadcast_to(one.require_mass(one.assemble("M", theta))[0], (count, n, n))
    stiffness = one.assemble(("K", "Kg"), theta)
    if stiffness is None:
        raise bad("LinearPeriodic.terms", "no stiffness", "K or Kg", "add the term")
    own = np.broadcast_to(stiffness[0], (count, n, n)) * one.speed[0] ** 2
    own = 0.5 * (own + np.swapaxes(own, -1, -2))
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    square, vectors = np.linalg.eigh(inverse @ own @ np.swapaxes(inverse, -1, -2))
    modes = np.swapaxes(inverse, -1, -2) @ vectors
    return np.sqrt(np.maximum(square, 0.0)), modes, np.asarray(mass), own


def gap_choices(frequency: Array, fewest: int) -> list[tuple[int, float]]:
    """Return numbers of slow modes from ``fewest`` on with the gap above each [rad/s].

    The gap is the least distance over the angles between the k-th frequency and the next one;
    the rest of the modes follows at no less.
    """
    n = frequency.shape[1]
    gaps = np.min(frequency[:, 1:] - frequency[:, :-1], axis=0)
    return [(k, float(gaps[k - 1])) for k in range(max(fewest, 1), n)]


def moving_frames(form: CanonicalForm, modes: int) -> Frames:
    """Return smooth bases of the lowest modes and of the rest.

    Parameters
    ----------
    form : CanonicalForm
        The first of its batch decides mass and stiffness.
    modes : int
        Number k of slow modes, less than n.

    Raises
    ------
    BadInput
        If no number of angles resolves the bases, or they are not regular: the frequency of mode
        k + 1 comes too near to that of mode k.
    """
    count = _FEWEST
    while count < 4 * form.reach:
        count *= 2
    references = _references(form, modes)
    while True:
        theta = even_angles(form.system.period, count)
        frequency, shapes, mass, stiffness = held_modes(form, theta)
        if references is None:
            regular = 0.0
            break
        basis, regular = _aligned(shapes, mass, references, modes)
        spectrum = np.fft.rfft(basis, axis=0) / count
        size = np.max(np.abs(spectrum), axis=0)
        tail = np.max(np.abs(spectrum[count // 3 :]) / np.max(size))
        if tail <= _TAIL or not regular > _REGULAR:
            break
        if 2 * count > _MOST:
            regular = 0.0
            break
        count *= 2
    if not regular > _REGULAR:
        raise bad(
            "modes",
            f"{modes}, where the natural frequencies of modes {modes} and {modes + 1} come within "
            f"{np.min(frequency[:, modes] - frequency[:, modes - 1]):.3g} rad/s of each other",
            "a number of modes with a gap above them",
            "choose another number",
        )
    moved = stiffness_in(basis, stiffness)
    return Frames(
        theta=theta,
        basis=basis,
        slope=angle_slope(basis, form.system.period),
        modes=modes,
        level=np.mean(np.diagonal(moved, axis1=-2, axis2=-1), axis=0),
        slow=frequency[:, :modes],
        fast=frequency[:, modes:],
    )


def stiffness_in(basis: Array, matrix: Array) -> Array:
    """Return ``basis^T matrix basis``."""
    value: Array = np.swapaxes(basis, -1, -2) @ matrix @ basis
    return value


def angle_slope(values: Array, period: float) -> Array:
    """Return the derivative by the angle of even samples over the period, along the first axis."""
    count = len(values)
    spectrum = np.fft.rfft(values, axis=0)
    rate = 2j * np.pi / period * np.arange(len(spectrum))
    if count % 2 == 0:
        rate[-1] = 0.0
    shape = (-1,) + (1,) * (values.ndim - 1)
    slope: Array = np.fft.irfft(rate.reshape(shape) * spectrum, n=count, axis=0)
    return slope


def _references(form: CanonicalForm, modes: int) -> list[ComplexArray] | None:
    """Return Fourier coefficients of smooth periodic displacements near each of the two spans.

    None where a span has turned itself over after a period, so that no periodic basis exists.
    """
    theta = even_angles(form.system.period, _STEPS)
    _, shapes, mass, stiffness = held_modes(form, theta)
    if modes == form.system.size:
        # All displacements: any constant basis will do.
        average = np.mean(mass, axis=0)
        inverse = np.linalg.inv(np.linalg.cholesky(average))
        moved = inverse @ np.mean(stiffness, axis=0) @ inverse.T
        own = inverse.T @ np.linalg.eigh(0.5 * (moved + moved.T))[1]
        return [own[None].astype(complex)]
    found = []
    for part in (slice(0, modes), slice(modes, None)):
        carried = _carried(shapes[..., part], mass, stiffness)
        if carried is None:
            return None
        spectrum = np.fft.rfft(carried, axis=0)[: _WAVES + 1] / _STEPS
        found.append(spectrum)
    return found


def _carried(shapes: Array, mass: Array, stiffness: Array) -> Array | None:
    """Return bases of a span that turn as little as they can, and close after a period."""
    from scipy.linalg import logm

    count = len(shapes)
    basis = shapes[0]
    rows = []
    for at in [*range(count), 0]:
        basis = _nearest(shapes[at], mass[at], basis)[0]
        rows.append(basis)
    holonomy = rows[0].T @ mass[0] @ rows[-1]
    if np.linalg.det(holonomy) < 0:
        return None
    turned = np.asarray(logm(holonomy))
    if np.max(np.abs(turned.imag), initial=0.0) > 1e-6 * max(1.0, float(np.max(np.abs(turned)))):
        turned = _paired_logarithm(holonomy)
    turned = 0.5 * (turned.real - turned.real.T)
    # Of a skew matrix, whose exponentials are turns.
    rate, axes = np.linalg.eigh(1j * turned)
    turns = np.exp(1j * np.outer(np.arange(count) / count, rate))
    back = np.real((axes * turns[:, None, :]) @ axes.conj().T)
    smooth = np.stack(rows[:-1]) @ back
    # The mean stiffness tells the columns apart.
    moved = np.mean(stiffness_in(smooth, stiffness), axis=0)
    value: Array = smooth @ np.linalg.eigh(0.5 * (moved + moved.T))[1]
    return value


def _paired_logarithm(holonomy: Array) -> Array:
    """Return a real logarithm of a rotation with eigenvalues -1, which come in pairs."""
    from scipy.linalg import schur

    block, vectors = schur(holonomy, output="real")
    out = np.zeros_like(block)
    k = len(block)
    flipped, i = [], 0
    while i < k:
        if i + 1 < k and abs(block[i + 1, i]) > 1e-9:
            angle = np.arctan2(block[i + 1, i], block[i, i])
            out[i, i + 1], out[i + 1, i] = -angle, angle
            i += 2
            continue
        if block[i, i] < 0:
            flipped.append(i)
        i += 1
    for a, b in zip(flipped[::2], flipped[1::2], strict=True):
        out[a, b], out[b, a] = -np.pi, np.pi
    value: Array = vectors @ out @ vectors.T
    return value


def _nearest(shapes: Array, mass: Array, reference: Array) -> tuple[Array, float]:
    """Return the basis of the span of shapes that is nearest to a reference, and how near."""
    turn = np.swapaxes(shapes, -1, -2) @ mass @ reference
    left, size, right = np.linalg.svd(turn)
    return shapes @ (left @ right), float(np.min(size))


def _aligned(
    shapes: Array, mass: Array, references: list[ComplexArray], modes: int
) -> tuple[Array, float]:
    """Return the references projected and made orthonormal, and how regular they are."""
    columns, regular = [], np.inf
    for spectrum, part in zip(references, (slice(0, modes), slice(modes, None)), strict=False):
        padded = np.zeros((len(shapes) // 2 + 1, *spectrum.shape[1:]), dtype=complex)
        padded[: len(spectrum)] = spectrum
        reference = np.fft.irfft(padded, n=len(shapes), axis=0) * len(shapes)
        basis, size = _nearest(shapes[..., part], mass, reference)
        columns.append(basis)
        regular = min(regular, size)
    return np.concatenate(columns, axis=-1), regular
