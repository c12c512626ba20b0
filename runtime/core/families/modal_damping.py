"""Damping by modal ratios, added to any linear-periodic system at run time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from ..errors import bad
from ..inputs import is_finite
from ..trigonometric import Remembered
from .linear_periodic import Array, LinearPeriodic, Term, require_system


def with_modal_damping(system: LinearPeriodic, ratio: float) -> LinearPeriodic:
    """Return the system with the same damping ratio in each mode of the frozen mechanism.

    At each crank angle the damping matrix is ``C = sum_k 2 zeta omega_k (M phi_k)(M phi_k)^T``
    with the natural frequencies and mass-normalised modes of M and K at that angle.

    On shapes that move with the mechanism the rates of the coordinates are not all of the
    velocity: its projection on the shapes has the coordinates ``qd + td M^-1 A q``.  That whole
    velocity is damped where the system has moving shapes (``D = C M^-1 A``), so that the answer
    does not depend on the basis; elsewhere the rates of the coordinates.

    Of a structure of beams these are displacements along fixed axes, whose rates are the elastic
    velocity seen from the ground (Aannaque (4.35)).  Axes that turn with the links would do as
    well, but those that meet at a pin turn differently.  The choice hardly matters: the four-bar
    of Table 4.1 (one element a link, 2 %) moves by less than 0.4 % of its peaks at 62 rad/s, 0.3 %
    at 30, when its pins' velocities are taken in the axes of crank and follower, and by 0.13 % and
    0.08 % with D as above.

    Parameters
    ----------
    system : LinearPeriodic
        With a positive definite mass matrix.
    ratio : float
        zeta, not negative; the parameter ``damping_ratio`` of the new system.

    Returns
    -------
    LinearPeriodic
        The matrices are those of the system's own parameters: changing stiffness or mass later
        does not change the damping.  Another geometry does: ``with_geometry`` damps the modes
        that the mechanism has there.

    Raises
    ------
    BadInput
        If the ratio is no number, negative or not finite, or the system has that parameter already.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> print(el.floquet_multipliers(el.with_modal_damping(system, ratio=0.02), 80.0).stable)
    True
    """
    require_system(system)
    if not (is_finite(ratio) and ratio >= 0.0):
        raise bad("ratio", repr(ratio), "a finite number, 0 or more", "correct it")
    if "damping_ratio" in system.parameters:
        raise bad("system", "modal damping already", "none", "set its damping_ratio instead")
    matrices = Remembered(partial(_matrices, system))
    fixed = all(system.is_constant(name) for name in ("M", "K"))
    function = matrices(np.zeros(1))[0] if fixed else matrices
    terms = [Term("C", "damping_ratio", function)]
    if system.moving_shape is not None and system.has("A"):
        terms.append(Term("D", "damping_ratio", partial(_carried, system, matrices)))
    damped = system.with_terms(*terms, scales={"damping_ratio": float(ratio)})
    damped = replace(damped, limits={**damped.limits, "damping_ratio": "non-negative"})
    return replace(damped, **system.remade(partial(_damped_again, system.parameters, ratio)))


def _damped_again(
    parameters: Mapping[str, float], ratio: float, made: LinearPeriodic
) -> LinearPeriodic:
    """Return the system of another geometry or mesh with its own modes damped."""
    return with_modal_damping(replace(made, parameters=dict(parameters)), ratio)


def _carried(system: LinearPeriodic, matrices: Remembered[Array], theta: Array) -> Array:
    """Return ``C M^-1 A`` at crank angles, ``(nt, n, n)``."""
    drift = np.linalg.solve(system.array("M", theta), system.array("A", theta))
    return np.asarray(matrices(theta) @ drift)


def _matrices(system: LinearPeriodic, theta: Array) -> Array:
    """Return ``sum_k 2 omega_k (M phi_k)(M phi_k)^T`` at crank angles, ``(nt, n, n)``."""
    mass, stiffness = system.array("M", theta), system.array("K", theta)
    factor = np.linalg.cholesky(mass)
    inverse = np.linalg.inv(factor)
    plain = inverse @ stiffness @ np.swapaxes(inverse, -1, -2)
    squares, modes = np.linalg.eigh(0.5 * (plain + np.swapaxes(plain, -1, -2)))
    carried = factor @ modes
    weights = 2.0 * np.sqrt(np.maximum(squares, 0.0))[:, None, :]
    found = np.asarray((carried * weights) @ np.swapaxes(carried, -1, -2))
    found.flags.writeable = False  # it is shared
    return found
