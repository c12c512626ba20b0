"""What decides stability: half trace, characteristic polynomial, reduced polynomial."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..families import Array
from ..hill.form import HillForm
from ..hill.half_trace import discriminant


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
    coefficients: Array, *, reduced: bool, slack: float = 1e-9
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the largest modulus of a multiplier, and whether all lie on or in the unit circle.

    Parameters
    ----------
    coefficients : ndarray, shape (..., k)
        As :func:`characteristic` returns them.
    reduced : bool
        Whether they are the first half of a palindromic polynomial; then the roots are sought in
        ``z = rho + 1/rho``, where stability means z real and ``|z| <= 2``.
    slack : float
        Distance from that interval, or from the circle, that still counts as stable.
    """
    if not reduced:
        moduli = np.abs(_roots(coefficients))
        largest = np.max(moduli, axis=-1)
        return largest, largest <= 1.0 + slack
    z = _roots(_in_sum(coefficients))
    rho = np.abs(z / 2 + np.sqrt(z**2 / 4 - 1 + 0j))
    largest = np.max(np.maximum(rho, 1.0 / rho), axis=-1)
    real = np.abs(z.imag) <= np.sqrt(slack)
    stable = np.all(real & (np.abs(z.real) <= 2.0 + slack), axis=-1)
    return largest, stable


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
) -> tuple[Array, float]:
    """Return the half traces of one mode on a grid, shape ``(1, nx, ny)``, and their error.

    A row of the grid shares one function f where the other axis is the speed or acts on the
    constant stiffness alone.
    """
    # The axis that changes f is the outer loop; along the inner one only lam2 and K change.
    inner = 0 if _leaves_function_alone(form, names[0]) else 1
    outer = 1 - inner
    axes = (x, y)
    values = np.empty((len(x), len(y)))
    worst = 0.0
    for j, fixed in enumerate(axes[outer]):
        points = [{names[outer]: float(fixed), names[inner]: float(v)} for v in axes[inner]]
        speeds = np.array([p.pop("speed", 1.0) for p in points])
        lam2 = np.array([form.stiffness(**p) for p in points]) / speeds**2
        damping = np.array([form.damping(**p) for p in points]) / (2 * speeds)
        if _leaves_function_alone(form, names[inner]):
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
        values[(slice(None), j) if inner == 0 else (j, slice(None))] = row
        worst = max(worst, float(np.max(error)))
    return values[None], worst


def _leaves_function_alone(form: HillForm, name: str) -> bool:
    """Return True where an axis changes the constant stiffness and damping but not f."""
    if name == "speed":
        return not form.elastic
    parts = [scale for scale, _ in (*form.inertial, *form.elastic) if scale is not None]
    base = form.system.scale_values()
    value = form.system.parameters[name]
    moved = form.system.scale_values(**{name: 2.0 * value + 1.0})
    return all(np.all(base[scale] == moved[scale]) for scale in parts)
