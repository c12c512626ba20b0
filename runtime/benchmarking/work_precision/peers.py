"""What a user would pick instead: SciPy, SUNDIALS, heyoka, and a compiled loop by hand.

Each gets the Fourier series of L ready made; compilation is not timed.  A peer returns None
where :func:`absence` has a reason.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.util import find_spec
from typing import Any

import numpy as np

from .equation import Array, Equation
from .exudyn_peer import exudyn_rk67
from .method import patient
from .numba_loop import compiled_loop

# From a start ``(m, columns)`` and rising angles to the states ``(angles, m, columns)``.
Solve = Callable[[Array, Array], Array]
Peer = Callable[[Equation, float], Solve | None]

# States from which heyoka compiles in its compact mode, and entries beyond which it is left out.
_COMPACT, _MOST_TERMS = 6, 20_000
# Absolute tolerance over the relative one; states are scaled.
_ABSOLUTE = 1e-2
# What must be installed; SciPy always is.
_NEEDED = {
    "CVODE": "sksundae",
    "heyoka": "heyoka",
    "heyoka batch": "heyoka",
    "numba loop": "numba",
    "Exudyn": "exudyn",
}


def absence(name: str, equation: Equation) -> str | None:
    """Return why a peer is left out of an equation, None where it is not; nothing is compiled."""
    needed = _NEEDED.get(name)
    if needed is not None and find_spec(needed) is None:
        return "not installed"
    terms = np.count_nonzero(equation.a) + np.count_nonzero(equation.b)
    return "too many terms" if needed == "heyoka" and terms > _MOST_TERMS else None


def scipy_method(name: str) -> Peer:
    """Return ``solve_ivp`` with a method."""
    # The stubs want a literal.
    scheme: Any = name

    def peer(equation: Equation, tolerance: float) -> Solve:
        from scipy.integrate import solve_ivp

        def solve(start: Array, angles: Array) -> Array:
            shape = start.shape
            slope = patient(equation.slope(shape))
            options: dict[str, Any] = {}
            if name == "Radau" and shape[1] == 1:
                options["jac"] = lambda theta, _: equation.at(theta)
            found = solve_ivp(
                slope,
                (angles[0], angles[-1]),
                start.ravel(),
                method=scheme,
                t_eval=angles,
                rtol=max(tolerance, 3e-14),
                atol=_ABSOLUTE * tolerance,
                **options,
            )
            return np.asarray(found.y.T.reshape(-1, *shape))

        return solve

    return peer


def sundials(equation: Equation, tolerance: float) -> Solve | None:
    """Return CVODE of scikit-sundae: Adams, BDF where the system is stiff."""
    if absence("CVODE", equation):
        return None
    from sksundae.cvode import CVODE

    stiff = equation.rate > 100.0

    def solve(start: Array, angles: Array) -> Array:
        shape = start.shape
        slope = patient(equation.slope(shape))

        def into(theta: float, flat: Array, out: Array) -> None:
            out[:] = slope(theta, flat)

        solver = CVODE(
            into,
            method="BDF" if stiff else "Adams",
            rtol=max(tolerance, 1e-15),
            atol=_ABSOLUTE * tolerance,
            max_num_steps=10_000_000,
        )
        found = solver.solve(angles, start.ravel())
        return np.asarray(found.y).reshape(-1, *shape)

    return solve


def heyoka_scalar(equation: Equation, tolerance: float) -> Solve | None:
    """Return heyoka's Taylor method for one start: compiled for the equation, dense output."""
    built = _heyoka_system(equation)
    if built is None:
        return None
    hy, system = built
    stepper = hy.taylor_adaptive(
        system,
        [0.0] * equation.states,
        tol=tolerance,
        fast_math=True,
        compact_mode=equation.states > _COMPACT,
    )

    def solve(start: Array, angles: Array) -> Array:
        found = np.empty((len(angles), *start.shape))
        for column in range(start.shape[1]):
            stepper.time = angles[0]
            stepper.state[:] = start[:, column]
            found[:, :, column] = stepper.propagate_grid(angles)[-1]
        return found

    return solve


def heyoka_batch(equation: Equation, tolerance: float) -> Solve | None:
    """Return heyoka's batch integrator, a column of the matrix in each lane."""
    built = _heyoka_system(equation)
    if built is None:
        return None
    hy, system = built
    m, lanes = equation.states, int(hy.recommended_simd_size())
    stepper = hy.taylor_adaptive_batch(
        system,
        np.zeros((m, lanes)),
        tol=tolerance,
        fast_math=True,
        compact_mode=m > _COMPACT,
    )

    def solve(start: Array, angles: Array) -> Array:
        found = np.empty((len(angles), *start.shape))
        grid = np.repeat(angles[:, None], lanes, axis=1)
        for first in range(0, start.shape[1], lanes):
            part = start[:, first : first + lanes]
            stepper.set_time(float(angles[0]))
            stepper.state[:] = start[:, :1]
            stepper.state[:, : part.shape[1]] = part
            if len(angles) == 2:
                stepper.propagate_until(float(angles[1]))
                found[0, :, first : first + lanes] = part
                found[1, :, first : first + lanes] = stepper.state[:, : part.shape[1]]
            else:
                values = stepper.propagate_grid(grid)[-1]
                found[:, :, first : first + lanes] = values[..., : part.shape[1]]
        return found

    return solve


def by_hand(equation: Equation, steps: float) -> Solve | None:
    """Return a numba loop over fixed steps of Dormand & Prince's order 8."""
    run = compiled_loop()
    if run is None:
        return None
    rows, columns = np.nonzero(np.any((equation.a != 0.0) | (equation.b != 0.0), axis=0))
    a, b = (np.ascontiguousarray(v[:, rows, columns].T) for v in (equation.a, equation.b))
    wave = 2.0 * np.pi / equation.period

    def solve(start: Array, angles: Array) -> Array:
        step = angles[1] - angles[0]
        inner = max(1, round(steps * step / (2.0 * np.pi)))
        found: Array = run(rows, columns, a, b, wave, start, angles, inner)
        return found

    return solve


def _heyoka_system(equation: Equation) -> tuple[Any, list[Any]] | None:
    if absence("heyoka", equation):
        return None
    import heyoka as hy

    m = equation.states
    state = hy.make_vars(*(f"y{i}" for i in range(m)))
    state = list(state) if m > 1 else [state]
    wave = 2.0 * np.pi / equation.period
    waves = [
        (hy.cos(k * wave * hy.time), hy.sin(k * wave * hy.time)) for k in range(len(equation.a))
    ]
    system = []
    for i in range(m):
        products = []
        for j in range(m):
            terms = [hy.expression(float(equation.a[0, i, j]))] if equation.a[0, i, j] else []
            for k in range(1, len(equation.a)):
                for factor, function in zip(
                    (equation.a[k, i, j], equation.b[k, i, j]), waves[k], strict=True
                ):
                    terms += [float(factor) * function] if factor else []
            if terms:
                products.append(hy.sum(terms) * state[j])
        system.append((state[i], hy.sum(products) if products else hy.expression(0.0)))
    return hy, system


# Tolerances from loose to tight, and steps a revolution over the largest rate.
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14)
_STEPS = (2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
PEERS: Mapping[str, Peer] = {
    "solve_ivp DOP853": scipy_method("DOP853"),
    "solve_ivp Radau": scipy_method("Radau"),
    "CVODE": sundials,
    "heyoka": heyoka_scalar,
    "heyoka batch": heyoka_batch,
    "numba loop": by_hand,
    "Exudyn": exudyn_rk67,
}


def settings_of(name: str, equation: Equation) -> tuple[float, ...]:
    """Return the settings of a peer, from loose to tight."""
    if name not in ("numba loop", "Exudyn"):
        return TOLERANCES
    return tuple(float(round(2.0 * np.pi * max(equation.rate, 1.0) * s)) for s in _STEPS)
