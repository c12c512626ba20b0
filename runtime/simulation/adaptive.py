"""Marching with steps that the method chooses: Kutta-Merson, and SciPy's integrators."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ..integrators import kutta_merson
from ..periodic.first_order import CanonicalForm
from .generator_series import generator_series
from .marching import Grid, March, Tick, generator_of_one, scaled_state, unscaled

Array = NDArray[np.float64]


@dataclass(frozen=True)
class AdaptiveMarch:
    """Outcome of an adaptive march.

    Attributes
    ----------
    theta, q, slope : ndarray
        Angles reached, coordinates and d/dtheta.
    steps : int
        Steps taken in all.
    status : int
        0 end reached, 1 bound passed, 2 the method gave up.
    message : str
        The method's words.
    """

    theta: Array
    q: Array
    slope: Array
    steps: int
    status: int
    message: str


def adaptive_march(
    method: str,
    form: CanonicalForm,
    grid: Grid,
    start: tuple[Array, Array],
    beginning: March,
    rtol: float,
    bound: float,
    tick: Tick | None,
) -> AdaptiveMarch:
    """March a single system with steps that the method chooses.

    Parameters
    ----------
    method : str
        ``kutta_merson`` or a method of :func:`scipy.integrate.solve_ivp`.
    form : CanonicalForm
        A batch of one.
    grid : Grid
        Given angles.
    start : pair of ndarray
        q and dq/dtheta at the start, each ``(n,)``.
    beginning : March
        Motion over the first quarter of a wave: its peaks set the absolute tolerances.
    rtol : float
        Relative tolerance of a step.
    bound : float
        Size of a coordinate at which to stop.
    tick : callable, optional
        Told the number of given angles reached.
    """
    n = form.system.size
    scale = form.scale[0]
    q, slope = start
    state = scaled_state(form, grid.start, q, slope)
    atol = _tolerance(form, grid, beginning, rtol)

    generator = sampled_generator(form)

    def outside(y: Array) -> bool:
        return not bool(np.all(np.abs(y[:n] * scale[:n]) <= bound))

    if method == "kutta_merson":
        run = kutta_merson.adaptive(
            generator,
            grid.theta,
            state,
            rtol,
            atol,
            stop=outside,
            first=0.1 / float(form.rate[0]),
            tick=tick,
        )
        states, steps = run.states, run.accepted
        status, message = 0, ""
        if outside(states[-1]):
            status = 1
        elif len(states) < len(grid.theta):
            status, message = 2, "the step shrank to nothing: the motion grows or jumps too fast"
    else:
        states, steps, status, message = _scipy(
            method, generator, grid.theta, state, rtol, atol, bound / scale[:n], tick
        )
    theta = grid.theta[: len(states)]
    coordinates, slopes = unscaled(form, theta, states)
    return AdaptiveMarch(theta, coordinates, slopes, steps, status, message)


def sampled_generator(form: CanonicalForm) -> Callable[[Array], Array]:
    """Return the generator of a batch of one, as its Fourier series where that is exact.

    A method that asks for one angle at a time would assemble every term at each call; the series
    costs one small product.

    Parameters
    ----------
    form : CanonicalForm
        A batch of one.

    Returns
    -------
    callable
        From angles ``(nt,)`` to ``(nt, m, m)``; assembled at each call where samples do not
        resolve the generator to round-off.
    """
    series = generator_series(form)
    return partial(generator_of_one, form) if series is None else series


def _tolerance(form: CanonicalForm, grid: Grid, beginning: March, rtol: float) -> Array:
    """Return absolute tolerances from the peaks of the scaled state at the beginning."""
    n = form.system.size
    q = beginning.q / form.scale[0, :n]
    slope = beginning.slope * form.scale[0, :n]
    peak = float(np.max(np.abs(q), initial=0.0) + np.max(np.abs(slope), initial=0.0))
    return np.full(form.size, rtol * (peak if 0 < peak < np.inf else 1.0) * 1e-2)


def _scipy(
    method: str,
    generator: Callable[[Array], Array],
    theta: Array,
    state: Array,
    rtol: float,
    atol: Array,
    bound: Array,
    tick: Tick | None,
) -> tuple[Array, int, int, str]:
    reached = 0

    def slope(angle: float, y: Array) -> Array:
        value: Array = generator(np.array([angle]))[0] @ y
        return value

    def jacobian(angle: float, _: Array) -> Array:
        value: Array = generator(np.array([angle]))[0]
        return value

    def inside(angle: float, y: Array) -> float:
        nonlocal reached
        if tick is not None:
            now = int(np.searchsorted(theta, angle, side="right")) - 1
            reached = max(reached, now)
            tick(reached)
        return float(1.0 - np.max(np.abs(y[: len(bound)]) / bound))

    inside.terminal = True  # type: ignore[attr-defined]
    options: dict[str, Any] = {"method": method, "events": inside}
    if method in ("Radau", "BDF", "LSODA"):
        options["jac"] = jacobian
    with np.errstate(over="ignore", invalid="ignore"):
        solution = solve_ivp(
            slope,
            (theta[0], theta[-1]),
            state,
            dense_output=True,
            t_eval=theta,
            rtol=max(rtol, 2.5e-14),
            atol=atol,
            **options,
        )
    status = {0: 0, 1: 1}.get(solution.status, 2)
    steps = 0 if solution.sol is None else len(solution.sol.ts) - 1
    return np.ascontiguousarray(solution.y.T), steps, status, str(solution.message)
