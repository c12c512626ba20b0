"""What the axes of a chart do to a system: where damping acts, what changes the frequency."""

from __future__ import annotations

import numpy as np

from ..families import Array, LinearPeriodic

Names = tuple[str, str]
Axes = tuple[Array, Array]


def on_grid(names: Names, axes: Axes) -> tuple[Array, dict[str, Array]]:
    """Return speeds (1 where speed is no axis) and parameters, broadcasting to ``(ny, nx)``."""
    grid = {names[0]: axes[0][None, :], names[1]: axes[1][:, None]}
    return grid.pop("speed", np.ones((1, 1))), grid


def is_damped(system: LinearPeriodic, names: Names, axes: Axes) -> bool:
    """Return True where some damping term acts at some angle, somewhere on the chart."""
    scales = system.scale_values(**on_grid(names, axes)[1])
    angles = np.linspace(0.0, system.period, 65)[:-1]
    return any(
        (term.scale is None or bool(np.any(scales[term.scale]))) and bool(np.any(term(angles)))
        for term in system.terms
        if term.array == "C"
    )


def is_symplectic(system: LinearPeriodic, damped: bool) -> bool:
    """Return True where multipliers come in reciprocal pairs: undamped, symmetric B, K and Kg."""
    angles = np.linspace(0.0, system.period, 65)[:-1]
    symmetric = all(
        np.max(np.abs(value - np.swapaxes(value, -1, -2))) <= 1e-13 * np.max(np.abs(value))
        for value in (term(angles) for term in system.terms if term.array in {"B", "K", "Kg"})
    )
    return symmetric and not damped


def damping_rate(system: LinearPeriodic, names: Names, axes: Axes) -> Array:
    """Return c/m of one mode with constant mass and damping [1/s], shape ``(ny, nx)``."""
    scales = system.scale_values(**on_grid(names, axes)[1])
    total = {name: np.zeros((len(axes[1]), len(axes[0]))) for name in ("M", "C")}
    for term in system.terms:
        if term.array in total:
            factor = 1.0 if term.scale is None else scales[term.scale]
            total[term.array] = total[term.array] + factor * term(np.zeros(1))[0, 0, 0]
    rate: Array = total["C"] / total["M"]
    return rate


def natural_frequency(system: LinearPeriodic, names: Names, axes: Axes) -> float:
    """Return the lowest natural frequency at rest [rad/s]; NaN where it is not one number.

    It is one number where speed is an axis and the other parameter leaves it alone.
    """
    if "speed" not in names:
        return float("nan")
    other = 1 - names.index("speed")
    ends = [
        _at_rest(system, {names[other]: float(value)})
        for value in (axes[other][0], axes[other][-1])
    ]
    return ends[0] if abs(ends[1] - ends[0]) <= 1e-12 * abs(ends[0]) else float("nan")


def _at_rest(system: LinearPeriodic, changes: dict[str, float]) -> float:
    mass = system.array("M", 0.0, **changes)[0]
    stiffness = system.array("K", 0.0, **changes)[0]
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    return float(np.sqrt(max(np.min(squares), 0.0)))
