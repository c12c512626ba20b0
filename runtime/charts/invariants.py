"""What decides stability: half trace, characteristic polynomial, reduced polynomial."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..families import Array
from ..hill.form import HillForm, leaves_function_alone
from ..hill.half_trace import discriminant

# Round-off of coefficients and roots, relative to the largest coefficient.
_ROUNDING = 32.0 * float(np.finfo(float).eps)
# Relative imaginary part up to which a multiplier counts as real: round-off at a double one.
_REAL = 1e-6


def characteristic(matrices: Array, *, reduced: bool) -> Array:
    """Return coefficients of the characteristic polynomial of each matrix.

    Parameters
    ----------
    matrices : ndarray, shape (..., 2n, 2n)
        Monodromy matrices.
    reduced : bool
        For a symplectic matrix the coefficients are palindromic; only the first n are returned.

    Returns
    -------
    ndarray, shape (..., n) or (..., 2n)
        ``c_1, c_2, ...`` of ``rho^2n + c_1 rho^(2n-1) + ...``, by Faddeev and LeVerrier.
    """
    size = matrices.shape[-1]
    wanted = size // 2 if reduced else size
    found = []
    power = np.broadcast_to(np.eye(size), matrices.shape)
    for k in range(1, wanted + 1):
        product = matrices @ power
        coefficient = -np.trace(product, axis1=-2, axis2=-1) / k
        found.append(coefficient)
        power = product + coefficient[..., None, None] * np.eye(size)
    return np.stack(found, axis=-1)


def largest_modulus(
    coefficients: Array, *, reduced: bool, error: Array | float = 0.0
) -> tuple[Array, NDArray[np.bool_], Array]:
    """Return the largest modulus of a multiplier, whether all are stable, and the slack of that.

    Parameters
    ----------
    coefficients : ndarray, shape (..., k)
        As :func:`characteristic` returns them.
    reduced : bool
        Whether they are the first half of a palindromic polynomial; then the roots are sought in
        ``z = rho + 1/rho``, where stability means z real and ``|z| <= 2``.
    error : float or ndarray, shape (...)
        Absolute error of the coefficients; round-off is added.

    Returns
    -------
    largest, stable, slack : ndarray, shape (...)
        A root counts as stable where its modulus exceeds 1 by no more than what the error of the
        coefficients explains; ``slack`` is the largest such allowance of a point.
    """
    known = np.asarray(error) + _ROUNDING * np.max(np.abs(coefficients), axis=-1, initial=1.0)
    if not reduced:
        rho = _roots(coefficients)
        allowance = root_uncertainty(rho, known)
        modulus = np.abs(rho)
    else:
        z = _roots(_in_sum(coefficients))
        off = root_uncertainty(z, known)
        root = np.sqrt(z**2 / 4 - 1 + 0j)
        # Of the pair rho, 1/rho the one without cancellation.
        near, far = np.abs(z / 2 + root), np.abs(z / 2 - root)
        modulus = np.maximum(np.maximum(near, far), 1.0)
        # rho moves by rho dz / sqrt(z^2 - 4), and at z = +-2 by the square root.
        with np.errstate(divide="ignore"):
            allowance = modulus * np.minimum(off / (2 * np.abs(root)), np.sqrt(off))
    stable = np.all(modulus <= 1.0 + allowance, axis=-1)
    return np.max(modulus, axis=-1), stable, np.max(allowance, axis=-1)


def instability_kind(
    coefficients: Array, stable: NDArray[np.bool_], *, hill: bool, reduced: bool
) -> NDArray[np.int8]:
    """Return how unstable points are so, by the largest multiplier.

    Parameters
    ----------
    coefficients : ndarray, shape (..., k)
        As :func:`characteristic` returns them, or the half trace.
    stable : ndarray of bool, shape (...)
        Where not to look.
    hill : bool
        Whether they are half traces.
    reduced : bool
        Whether they are the first half of a palindromic polynomial.

    Returns
    -------
    ndarray of int8, shape (...)
        1 or -1 where the largest multiplier is real, 2 where it is complex, 0 where stable.
    """
    out = np.zeros(stable.shape, dtype=np.int8)
    chosen = coefficients[~stable]
    if hill or not len(chosen):
        out[~stable] = np.sign(chosen[..., 0]) if hill else 0
        return out
    if reduced:
        z = _roots(_in_sum(chosen))
        half = np.sqrt(z**2 / 4 - 1 + 0j)
        rho = np.where(np.abs(z / 2 + half) >= np.abs(z / 2 - half), z / 2 + half, z / 2 - half)
    else:
        rho = _roots(chosen)
    top = np.take_along_axis(rho, np.argmax(np.abs(rho), axis=-1)[..., None], axis=-1)[..., 0]
    real = np.abs(top.imag) <= _REAL * np.abs(top)
    out[~stable] = np.where(real, np.where(top.real > 0, 1, -1), 2)
    return out


def root_uncertainty(roots: NDArray[np.complex128], error: Array) -> Array:
    """Return how far each root of a monic polynomial moves with an error of the coefficients.

    Parameters
    ----------
    roots : ndarray, shape (..., k)
        The roots.
    error : ndarray, shape (...)
        Absolute error of a coefficient.

    Returns
    -------
    ndarray, shape (..., k)
        For a root alone the error of the polynomial over its slope; within a cluster of r roots
        the r-th root of the error over the distances to the others; the smallest figure, doubled.
    """
    k = roots.shape[-1]
    change = np.asarray(error)[..., None] * sum(np.abs(roots) ** j for j in range(k))
    apart = np.sort(np.abs(roots[..., :, None] - roots[..., None, :]), axis=-1)[..., 1:]
    # Distances to the farthest k - r others, r = 1 ... k.
    far = np.cumprod(apart[..., ::-1], axis=-1)[..., ::-1]
    far = np.concatenate([far, np.ones((*far.shape[:-1], 1))], axis=-1)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        moved = (change[..., None] / far) ** (1.0 / np.arange(1, k + 1))
    moved = np.where(np.isnan(moved), np.inf, moved)
    value: Array = 2.0 * np.min(moved, axis=-1)
    return value


def _in_sum(coefficients: Array) -> Array:
    """Turn ``1, c_1 ... c_n ... c_1, 1`` in rho into a monic polynomial in ``rho + 1/rho``."""
    n = coefficients.shape[-1]
    table = np.zeros((n + 1, n + 1))  # rho^j + rho^-j as a polynomial in z, lowest power first
    table[0, 0] = 2.0
    if n:
        table[1, 1] = 1.0
    for j in range(2, n + 1):
        table[j, 1:] = table[j - 1, :-1]
        table[j] -= table[j - 2]
    full = np.concatenate([np.ones((*coefficients.shape[:-1], 1)), coefficients], axis=-1)
    weights = table[::-1].copy()
    weights[n] /= 2.0  # the middle coefficient stands once
    polynomial: Array = full @ weights
    return polynomial[..., ::-1][..., 1:]


def _roots(monic: Array) -> NDArray[np.complex128]:
    """Return the roots of ``z^k + a_1 z^(k-1) + ...``, coefficients along the last axis."""
    degree = monic.shape[-1]
    if degree == 1:
        return np.asarray(-monic, dtype=complex)
    if degree == 2:
        half = -monic[..., 0] / 2
        root = np.sqrt((half**2 - monic[..., 1]).astype(complex))
        return np.stack([half + root, half - root], axis=-1)
    companion = np.zeros((*monic.shape[:-1], degree, degree))
    companion[..., 0, :] = -monic
    companion[..., np.arange(1, degree), np.arange(degree - 1)] = 1.0
    return np.asarray(np.linalg.eigvals(companion), dtype=complex)


def half_traces(
    form: HillForm,
    names: tuple[str, str],
    x: Array,
    y: Array,
    tick: Callable[[int], None] | None = None,
) -> tuple[Array, Array]:
    """Return the half traces of one mode on a grid, shape ``(1, nx, ny)``, and errors (nx, ny).

    A row of the grid shares one function f where the other axis is the speed or acts on the
    constant stiffness alone.
    """
    # The axis that changes f is the outer loop; along the inner one only lam2 and K change.
    inner = 0 if leaves_function_alone(form, names[0]) else 1
    outer = 1 - inner
    axes = (x, y)
    values = np.empty((len(x), len(y)))
    errors = np.empty((len(x), len(y)))
    for j, fixed in enumerate(axes[outer]):
        points = [{names[outer]: float(fixed), names[inner]: float(v)} for v in axes[inner]]
        speeds = np.array([p.pop("speed", 1.0) for p in points])
        lam2 = np.array([form.stiffness(**p) for p in points]) / speeds**2
        damping = np.array([form.damping(**p) for p in points]) / (2 * speeds)
        if leaves_function_alone(form, names[inner]):
            f = form.function(float(speeds[0]), **points[0])
            result = discriminant(f, lam2, 1.0, damping)
            row, error = result.value, result.error
        else:
            results = [
                discriminant(form.function(float(w), **p), float(v), 1.0, float(k))
                for w, p, v, k in zip(speeds, points, lam2, damping, strict=True)
            ]
            row = np.array([float(r.value) for r in results])
            error = np.array([float(r.error) for r in results])
        place = (slice(None), j) if inner == 0 else (j, slice(None))
        values[place], errors[place] = row, error
        if tick is not None:
            tick((j + 1) * len(axes[inner]))
    return values[None], errors
