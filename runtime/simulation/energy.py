"""Energy balance of a computed motion: an independent check of solver and equations."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..errors import BadInput
from ..floquet.first_order import CanonicalForm
from ..floquet.spring_form import periodic_derivative
from ..results import Check
from .marching import cyclic

Array = NDArray[np.float64]

# Given angles that the balance covers; a longer motion is checked over its beginning.
_MOST = 50_001


def energy_balance(
    form: CanonicalForm, theta: Array, q: Array, slope: Array, error: float
) -> Check | None:
    """Compare the change of energy with the work done, over a computed motion.

    With L2 the Lagrangian per speed squared, ``H = q'^T dL2/dq' - L2`` obeys
    ``dH/dtheta = -(partial L2/partial theta) + q'^T Q``, Q the damping and the forcing.  The
    right-hand side is integrated by a spline through the given angles.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.
    theta : ndarray
        Crank angles [rad], evenly spaced, shape ``(nt,)``.
    q, slope : ndarray
        Coordinates and d/dtheta, shape ``(nt, n)``.
    error : float
        Error figure of the motion, relative.

    Returns
    -------
    Check or None
        Value: imbalance at the end over the largest energy met.  Limit: from the error figure and
        the spline's own error; None where that error is too large for the check to say anything,
        where a coefficient jumps, or where it varies between the given angles.
    """
    if len(theta) < 9:
        return None
    # Two given angles a wave of the highest harmonic at the least, or the spline misses it.
    if form.reach * 2 * (theta[1] - theta[0]) > form.system.period:
        return None
    theta, q, slope = theta[:_MOST], q[:_MOST], slope[:_MOST]
    # Energies of a motion near the bound may overflow; there is no balance to check then.
    with np.errstate(over="ignore", invalid="ignore"):
        try:
            return _balance(form, theta, q, slope, error)
        except BadInput:  # a coefficient with jumps has no derivative to balance with
            return None


def _balance(
    form: CanonicalForm, theta: Array, q: Array, slope: Array, error: float
) -> Check | None:
    # Arrays repeat with every revolution of even angles.
    once = theta
    if cyclic(form):
        once = theta[: max(1, round(2 * np.pi / float(theta[1] - theta[0])))]
    kinetic = 0.5 * _form(form, "M", once, slope, slope)
    potential = 0.5 * (_form(form, ("K", "Kg"), once, q, q) - _form(form, "B", once, q, q))
    power = _power(form, once, q, slope)
    largest = float(np.max(np.abs(kinetic)) + np.max(np.abs(potential)))
    if not 0 < largest < np.inf or not np.all(np.isfinite(power)):
        return None
    change = kinetic[-1] + potential[-1] - kinetic[0] - potential[0]
    fine = CubicSpline(theta, power).antiderivative()(theta)
    work = fine[-1]
    # The largest difference on the way, as the one at the end may be small by chance.
    coarse = CubicSpline(theta[::2], power[::2]).antiderivative()(theta[::2])
    quadrature = float(np.max(np.abs(coarse - fine[::2]))) / largest
    limit = quadrature + 20.0 * len(form.system.labels) * error + 1e-12
    if limit > 0.1:
        return None
    return Check(float(abs(change - work)) / largest, float(limit))


def _form(
    form: CanonicalForm, names: str | tuple[str, ...], theta: Array, left: Array, right: Array
) -> Array:
    matrix = form.assemble(names, theta)
    if matrix is None:
        return np.zeros(len(left))
    return _double(matrix[0], left, right)


def _double(matrix: Array, left: Array, right: Array) -> Array:
    """Return ``left^T matrix right`` along a motion, the matrices repeating."""
    ahead = (_repeated(matrix, len(right)) @ right[:, :, None])[:, :, 0]
    value: Array = np.sum(left * ahead, axis=1)
    return value


def _repeated(value: Array, count: int) -> Array:
    if len(value) == 1:
        return np.broadcast_to(value, (count, *value.shape[1:]))
    return value if len(value) == count else value[np.arange(count) % len(value)]


def _power(form: CanonicalForm, theta: Array, q: Array, slope: Array) -> Array:
    """Return ``-(partial L2/partial theta) + q'^T Q`` along a motion, theta its revolution."""
    total = np.zeros(len(q))
    for sign, names, left, right in (
        (-0.5, ("M",), slope, slope),
        (-1.0, ("A",), slope, q),
        (-0.5, ("B",), q, q),
        (0.5, ("K", "Kg"), q, q),
    ):
        if all(form.system.is_constant(name) for name in names):
            continue
        total += sign * _double(_derivative(form, names)(theta)[0], left, right)
    total -= _form(form, "C", theta, slope, slope) + _form(form, "D", theta, slope, q)
    # Only the symmetric part of a stiffness has a potential.
    skew = () if form.conservative else ((0.5, ("B",)), (-0.5, ("K", "Kg")))
    for sign, names in skew:
        total += sign * _form(form, names, theta, slope, q)
        total -= sign * _form(form, names, theta, q, slope)
    force = form.assemble(("f", "h", "p"), theta) if form.forced else None
    if force is not None:
        total += np.einsum("ti,ti->t", _repeated(force[0], len(q)), slope)
    return total


def _derivative(form: CanonicalForm, names: tuple[str, ...]) -> Callable[[Array], Array]:
    n = form.system.size

    def function(theta: Array) -> Array:
        value = form.assemble(names, theta)
        if value is None:
            return np.zeros((1, len(theta), n, n))
        return np.broadcast_to(value, (1, len(theta), n, n))

    return periodic_derivative(function, form.system.period)
