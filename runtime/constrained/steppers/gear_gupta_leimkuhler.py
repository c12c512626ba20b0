"""The stabilised index-2 form of Gear, Gupta and Leimkuhler, by SUNDIALS' IDA."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...core.errors import bad
from ..equations import Array, Equations, NoConvergence, State
from .protocol import Control, Step, StoppedEarly


def gear_gupta_leimkuhler(
    equations: Equations, start: State, times: Array, control: Control
) -> Iterator[Step]:
    """March the form that meets the constraints of positions and of velocities.

    ``M (qd - v) = Phi_q^T mu``, ``M vd + c = Phi_q^T lam + Q``, ``Phi = 0``,
    ``Phi_q v = velocity_rhs`` (Gear, Leimkuhler and Gupta 1985), with the integrals of mu and lam
    as unknowns, which lowers the index to 1.  Backward differentiation of variable order up to 5
    meets the constraints to its tolerance; the given states are projected, which takes them to
    round-off.

    Parameters
    ----------
    equations : Equations
        The system.
    start : State
        Meets the constraints.
    times : ndarray, shape (nt,)
        Given times [s]; each is the end of one yielded step.
    control : Control
        Tolerance.

    Yields
    ------
    Step
        From one given time to the next.

    Raises
    ------
    BadInput
        If scikit-sundae is not installed.
    StoppedEarly
        If IDA gives up.
    """
    solver = _solver(equations, control)
    n, k = equations.n, equations.k
    zero = np.zeros(k)
    y = np.concatenate([start.q / equations.columns, start.qd / equations.columns, zero, zero])
    rate = np.concatenate([start.qd / equations.columns, start.qdd / equations.columns, zero, zero])
    rate[2 * n + k :] = start.multipliers / equations.rows
    solver.init_step(start.t, y, rate)
    state = start
    for t in times[1:]:
        found = solver.step(float(t))
        if not found.success:
            raise StoppedEarly(f"IDA stopped: {found.message}")
        values = np.asarray(found.y)
        q, qd = values[:n] * equations.columns, values[n : 2 * n] * equations.columns
        try:
            after = equations.state(float(t), q, qd)
        except NoConvergence as reason:
            raise StoppedEarly(str(reason)) from reason
        yield Step(state, after, _hermite(state, after))
        state = after


def _solver(equations: Equations, control: Control) -> Any:
    try:
        from sksundae.ida import IDA
    except ImportError as missing:
        raise bad(
            "method",
            "'gear_gupta_leimkuhler' without scikit-sundae",
            "scikit-sundae installed",
            "pip install 'elastolink[dae]', or take projection",
        ) from missing
    columns = equations.columns
    floor = np.concatenate([control.q_scale / columns, control.qd_scale / columns])
    # Integrals of multipliers carry no error of interest: only their rates are used.
    atol = np.concatenate([control.rtol * floor, np.full(2 * equations.k, 1e6)])
    return IDA(
        _residual(equations),
        rtol=control.rtol,
        atol=atol,
        max_num_steps=1_000_000,
        max_step=control.longest,
    )


def _residual(equations: Equations) -> Callable[[float, Array, Array, Array], None]:
    n, k, columns, rows = equations.n, equations.k, equations.columns, equations.rows
    system = equations.system

    def residual(t: float, y: Array, rate: Array, out: Array) -> None:
        q, qd = y[:n] * columns, y[n : 2 * n] * columns
        mu, lam = rate[2 * n : 2 * n + k], rate[2 * n + k :]
        a = equations.terms(t, q, qd)
        jacobian = rows[:, None] * a["jacobian"] * columns
        mass = columns[:, None] * a["mass"] * columns
        push = columns * (a["rest"] - a["forces"])[:, 0]
        out[:n] = mass @ (rate[:n] - y[n : 2 * n]) - jacobian.T @ mu
        out[n : 2 * n] = mass @ rate[n : 2 * n] + push - jacobian.T @ lam
        out[2 * n : 2 * n + k] = rows * system.violation(q, t)["constraints"][:, 0]
        out[2 * n + k :] = jacobian @ y[n : 2 * n] - rows * a["velocity_rhs"][:, 0]

    return residual


def _hermite(before: State, after: State) -> Callable[[float], tuple[Array, Array]]:
    """Return the polynomials of degree 5 that meet both ends with velocities and accelerations."""
    h = after.t - before.t

    def between(t: float) -> tuple[Array, Array]:
        x = (t - before.t) / h
        left = before.q + x * h * before.qd + 0.5 * (x * h) ** 2 * before.qdd
        gap = after.q - (before.q + h * before.qd + 0.5 * h * h * before.qdd)
        slope = h * (after.qd - before.qd - h * before.qdd)
        bend = h * h * (after.qdd - before.qdd)
        a, b, c = (
            10 * gap - 4 * slope + 0.5 * bend,
            -15 * gap + 7 * slope - bend,
            6 * gap - 3 * slope + 0.5 * bend,
        )
        q = left + x**3 * (a + x * (b + x * c))
        speed = before.qd + x * h * before.qdd + x * x * (3 * a + x * (4 * b + 5 * x * c)) / h
        return q, speed

    return between
