"""Mechanisms that one crank drives completely: speeds, accelerations and constraint forces."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from .arrays import CrankMotion
from .records import EquationsOfMotion
from .staged import Steps


@dataclass(frozen=True)
class DrivenMotion:
    """A rigid mechanism whose coordinates all follow the crank.

    Attributes
    ----------
    crank : CrankMotion
        The crank, with the chain from each coordinate to its speed and acceleration.
    steps : Steps
        For the coordinate ``q``: ``q_speed = dq / d theta`` and ``q_bend = d^2 q / d theta^2``.
    forces : tuple of Expr
        The multipliers lam, in the symbols of the steps and the crank's rate and acceleration.
    """

    crank: CrankMotion
    steps: Steps
    forces: tuple[sp.Expr, ...]


def driven_motion(equations: EquationsOfMotion, angle: sp.Expr, crank: CrankMotion) -> DrivenMotion:
    """Solve the constraints for the motion, and the equations of motion for the multipliers.

    ::

        Phi_q dq/d theta = v,   Phi_q d2q/d theta2 = gamma,   Phi_q^T lam = M qdd + c - Q

    Parameters
    ----------
    equations : EquationsOfMotion
        With as many constraints as coordinates, and ``angle`` prescribed.
    angle : Expr
        The crank angle as the applied function of time that occurs in the equations.
    crank : CrankMotion
        Symbols for the angle and its rates.

    Returns
    -------
    DrivenMotion
        The positions themselves are left to the caller: closed forms need a choice of branch.

    Raises
    ------
    ValueError
        If there are more or fewer constraints than coordinates.
    """
    names = [q.name for q in equations.coordinates]
    if equations.constraints.rows != len(names):
        raise ValueError(
            f"{equations.constraints.rows} constraints do not fix the coordinates {names}; "
            "one for each is needed"
        )
    speeds = [sp.Symbol(f"{name}_speed") for name in names]
    bends = [sp.Symbol(f"{name}_bend") for name in names]
    rate, acceleration, t = crank.rate, crank.acceleration, equations.t
    table = {q: w * rate for q, w in zip(equations.velocities, speeds, strict=True)}
    table |= {angle.diff(t, 2): acceleration, angle.diff(t): rate, angle: crank.theta}

    def plain(matrix: sp.Matrix) -> sp.Matrix:
        return sp.Matrix(matrix).subs(table)

    # The adjugate over the determinant: no pivot has to be chosen.
    jacobian = plain(equations.jacobian)
    inverse = jacobian.adjugate() / sp.factor_terms(sp.expand(jacobian.det()))
    steady = {rate: 1, acceleration: 0}
    slopes = (inverse * plain(equations.velocity_rhs)).subs(steady)
    curvatures = (inverse * plain(equations.gamma)).subs(steady)
    qdd = sp.Matrix(bends) * rate**2 + sp.Matrix(speeds) * acceleration
    forces = inverse.T * (plain(equations.mass) * qdd + plain(equations.rest - equations.forces))
    chain = dict(crank.chain) | dict(zip(equations.coordinates, speeds, strict=True))
    chain |= dict(zip(speeds, bends, strict=True))
    return DrivenMotion(
        CrankMotion(crank.theta, rate, acceleration, chain),
        Steps((*zip(speeds, slopes, strict=True), *zip(bends, curvatures, strict=True))),
        tuple(forces),
    )
