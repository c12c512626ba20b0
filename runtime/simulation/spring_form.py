"""Second-order form y'' = P(theta) y of systems without first derivatives, and derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.trigonometric import even_angles
from ..periodic.first_order import CanonicalForm

Array = NDArray[np.float64]


def spring_generator(form: CanonicalForm) -> Callable[[Array], Array]:
    """Return P of y'' = P(theta) y for a system without first derivatives.

    With forcing, y carries a last component that stays 1.

    Parameters
    ----------
    form : CanonicalForm
        The system at one or more speeds.

    Returns
    -------
    callable
        From angles ``(nt,)`` to ``(nb, nt, m, m)``, m = n or n + 1.

    Raises
    ------
    BadInput
        If damping C or the gyroscopic matrix G = M' + A - A^T does not vanish.
    """
    theta = even_angles(form.system.period, 64)
    gyro = form.assemble("A", theta)
    found = []
    if form.damped:
        found.append("damping C")
    if not form.system.is_constant("M"):
        found.append("a mass matrix that depends on the crank angle")
    if gyro is not None:
        skew = np.max(np.abs(gyro - np.swapaxes(gyro, -1, -2)))
        if skew > 1e-13 * np.max(np.abs(gyro)):
            found.append("a gyroscopic matrix A - A^T")
    if found:
        raise bad(
            "de_vogelaere",
            " and ".join(found),
            "an equation without first derivatives",
            "use gauss_legendre, magnus4 or rk4, or leave the term out",
        )
    slope = None
    if gyro is not None and not form.system.is_constant("A"):
        slope = periodic_derivative(lambda at: _dense(form, "A", at), form.system.period)
    n = form.system.size

    def generator(angles: Array) -> Array:
        total = np.zeros((len(form.speed), len(angles), n, n))
        for sign, names in ((-1.0, ("K", "Kg")), (1.0, ("B",))):
            value = form.assemble(names, angles)
            if value is not None:
                total += sign * value
        if slope is not None:
            total -= slope(angles)
        inverse = np.linalg.inv(form.require_mass(form.assemble("M", angles)))
        out = np.zeros((len(form.speed), len(angles), n + form.forced, n + form.forced))
        out[..., :n, :n] = inverse @ total
        force = form.assemble(("f", "h", "p"), angles) if form.forced else None
        if force is not None:
            out[..., :n, n] = np.einsum("...ij,...j->...i", inverse, force)
        return out

    return generator


def _dense(form: CanonicalForm, name: str, theta: Array) -> Array:
    value = form.assemble(name, theta)
    n = form.system.size
    return np.zeros((len(form.speed), len(theta), n, n)) if value is None else value


def periodic_derivative(
    function: Callable[[Array], Array], period: float
) -> Callable[[Array], Array]:
    """Return d/dtheta of a smooth periodic matrix function, by its Fourier series.

    Parameters
    ----------
    function : callable
        From angles ``(nt,)`` to ``(nb, nt, n, n)``.
    period : float
        Its period [rad].

    Raises
    ------
    BadInput
        If 4096 samples do not resolve the function to round-off.
    """
    count = 256
    while True:
        values = function(even_angles(period, count))
        coefficients = np.fft.rfft(values, axis=1) / count
        top = np.max(np.abs(coefficients))
        if np.max(np.abs(coefficients[:, count // 3 :])) <= 1e-14 * top:
            break
        count *= 2
        if count > 4096:
            raise bad(
                "coefficient",
                "a function that 4096 samples do not resolve",
                "a smooth one",
                "check it for jumps and kinks",
            )
    rate = 2j * np.pi / period * np.arange(count // 3)
    weights = 2 * rate[:, None, None] * coefficients[:, : count // 3]

    def derivative(theta: Array) -> Array:
        waves = np.exp(theta[:, None] * rate)
        result: Array = np.real(np.einsum("tk,bkij->btij", waves, weights))
        return result

    return derivative
