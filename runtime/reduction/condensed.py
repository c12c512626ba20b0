"""A system on a few moving modes, the answer of all others condensed quasi-statically.

``q = Phi eta + R (forces left over)``, R the flexibility of the modes left out: what the modes
kept leave of the equation of motion is answered statically (mode acceleration), and what that
answer's own inertia leaves is answered once more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.errors import bad
from ..core.families import LinearPeriodic
from .expressions import Arrays, Expression, constant_part, equation, plus, sampled_arrays, times
from ..periodic.moving_basis import MovingBasis
from ..core.trigonometric import Array

_FORCES = ("f", "h", "p")
# Size of a part of the operator, over that of the largest of its order, which is round-off.
_ROUND_OFF = 1e-14


@dataclass(frozen=True)
class Condensed:
    """What a reduced system and the way back from it consist of, on even angles.

    Attributes
    ----------
    theta : ndarray
        Even crank angles [rad], shape ``(nt,)``.
    period : float
        Period [rad].
    arrays : mapping
        Arrays of the full system by name and power of the speed in the equation times w^2.
    basis : ndarray
        Phi, scaled so that the mean of ``Phi^T K Phi`` is 1, shape ``(nt, n, m)``.
    flexibility : ndarray
        R, shape ``(nt, n, n)``.
    motion : dict
        q as an expression of eta, ``(nt, n, m)``.
    forced : dict
        What the forces add to q, by (power, 0), ``(nt, n, 1)``.
    operator : dict
        Left side of the reduced equation times w^2 as an expression of eta, ``(nt, m, m)``.
    load : dict
        Its right side by power, ``(nt, m)``.
    """

    theta: Array
    period: float
    arrays: Arrays
    basis: Array
    flexibility: Array
    motion: Expression
    forced: Expression
    operator: Expression
    load: dict[int, Array]


def condense(
    system: LinearPeriodic, basis: MovingBasis, *, answers: int = 2, arrays: Arrays | None = None
) -> Condensed:
    """Return a system condensed to the modes of a basis, at the angles that fix it.

    Parameters
    ----------
    system : LinearPeriodic
        Full system, with damping and forces.
    basis : MovingBasis
        The modes kept, which move.
    answers : int
        How often the modes left out answer: 0 for none; 1 for the static answer to what the
        modes kept leave over; 2 for that to its inertia beside.  The reduced equation itself
        takes the first along.
    arrays : mapping, optional
        From :func:`sampled_arrays` at the same angles, where known.

    Raises
    ------
    BadInput
        If no force acts.
    """
    theta, period = basis.theta, system.period
    arrays = sampled_arrays(system, theta) if arrays is None else arrays
    phi = _scaled(arrays, basis.values)
    across = np.swapaxes(phi, -1, -2)
    flexibility, stiff = _left_out(arrays, phi)
    # K of a mode left out is of the size of what is left over; all the rest of the equation is
    # smaller by the square of the ratio of the frequencies.
    rest = {name: powers for name, powers in arrays.items() if name not in ("K", *_FORCES)}
    rest = {**rest, "Kg": {p: v for p, v in rest.get("Kg", {}).items() if p}}
    whole = {**rest, "K": {0: stiff}}
    answer = {0: -flexibility}
    kept: Expression = {(0, 0): phi}
    pushes = _forces(arrays)
    if not pushes:
        raise bad("system", "no forcing f, h or p", "a forced system", "add the forcing")
    test = {0: across}
    operator = times(test, equation(whole, kept, period))
    load = times(test, pushes)
    motion = kept
    forced: Expression = {}
    # R M Phi = 0 and R K Phi = 0 but for round-off, and Phi^T M times an answer too.
    following = times(answer, equation(rest, kept, period))
    following = {key: v for key, v in following.items() if key[1] < 2}
    given = times({0: flexibility}, pushes)
    for count in range(answers):
        motion, forced = plus(motion, following), plus(forced, given)
        left, spare = equation(rest, following, period), equation(rest, given, period)
        if count + 1 < max(answers, 2):
            operator = plus(operator, times(test, left))
            load = plus(load, times({0: -across}, spare))
        following, given = times(answer, left), times(answer, spare)
    return Condensed(
        theta=theta,
        period=period,
        arrays=arrays,
        basis=phi,
        flexibility=flexibility,
        motion=motion,
        forced={key: value for key, value in forced.items() if key[1] == 0},
        operator=_needed(operator),
        load=constant_part(load),
    )


def _needed(operator: Expression) -> Expression:
    """Return an operator less the parts that are round-off."""
    largest: dict[int, float] = {}
    for (_, order), value in operator.items():
        largest[order] = max(largest.get(order, 0.0), float(np.max(np.abs(value))))
    inertia = largest.get(2, 0.0)
    return {
        key: value
        for key, value in operator.items()
        if float(np.max(np.abs(value))) > _ROUND_OFF * (largest[key[1]] if key[1] < 2 else inertia)
    }


def _forces(arrays: Arrays) -> Expression:
    total: Expression = {}
    for name in _FORCES:
        total = plus(total, {(p, 0): v[..., None] for p, v in arrays.get(name, {}).items()})
    return {key: value for key, value in total.items() if np.any(value)}


def _left_out(arrays: Arrays, phi: Array) -> tuple[Array, Array]:
    """Return the flexibility of the modes left out, and the stiffness that holds them."""
    stiff = arrays["K"][0]
    if 0 in arrays.get("Kg", {}):
        stiff = stiff + arrays["Kg"][0]
    across = np.swapaxes(phi, -1, -2)
    # What the modes kept yield is taken out before and behind, so that it is 0 to round-off.
    flexible = np.linalg.inv(stiff) - phi @ np.linalg.solve(across @ stiff @ phi, across)
    return np.asarray(flexible), np.asarray(stiff)


def _scaled(arrays: Arrays, phi: Array) -> Array:
    """Return the basis in which the mean stiffness is 1: norms of eta are energies then."""
    mean = np.mean(np.swapaxes(phi, -1, -2) @ arrays["K"][0] @ phi, axis=0)
    return np.asarray(phi @ np.linalg.inv(np.linalg.cholesky(0.5 * (mean + mean.T))).T)
