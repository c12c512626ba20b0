"""What the axes of a chart do to a system: where damping acts, what changes the frequency."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.errors import bad
from ...core.families import DAMPING, Array, LinearPeriodic, Term
from ...hill.form import is_hill
from ...periodic.equation import SPEED_POWER

Names = tuple[str, str]
Axes = tuple[Array, Array]


def on_grid(names: Names, axes: Axes) -> tuple[Array, dict[str, Array]]:
    """Return speeds (1 where speed is no axis) and parameters, broadcasting to ``(ny, nx)``."""
    grid = {names[0]: axes[0][None, :], names[1]: axes[1][:, None]}
    return grid.pop("speed", np.ones((1, 1))), grid


def at_speed(system: LinearPeriodic, names: Names, speed: float | None) -> LinearPeriodic:
    """Return the system of a chart: as it is, or such that a speed of 1 does what ``speed`` did.

    Parameters
    ----------
    system : LinearPeriodic
        The system.
    names : tuple of str
        The axes.
    speed : float, optional
        Crank speed [rad/s], where that is no axis.

    Raises
    ------
    BadInput
        If the speed is given beside an axis of that name, or is no positive number; if none is
        given and no axis, of a system whose inertia forces come from a turning crank.
    """
    if "speed" in names:
        if speed is not None:
            raise bad("speed", speed, "none where the speed is an axis", "leave it out")
        return system
    if speed is None:
        if _turned(system, names):
            raise bad(
                "stability_chart",
                f"the axes {names[0]} and {names[1]} and no speed",
                "a crank speed, which decides between inertia and stiffness here",
                "give speed=..., in rad/s, or make the speed an axis",
            )
        return system
    try:
        value = float(speed)
    except (TypeError, ValueError):
        value = float("nan")
    if not (np.isfinite(value) and value > 0.0):
        raise bad("speed", repr(speed), "a positive number [rad/s]", "correct it")
    return system if value == 1.0 else _slowed(system, value)


def _turned(system: LinearPeriodic, names: Names) -> bool:
    """Return whether a speed of 1 is more than a way to write a plain Hill equation."""
    if is_hill(system) and not any(name in system.geometry for name in names):
        return False
    resisting = any(SPEED_POWER.get(term.array, 0) + term.power != 0 for term in system.terms)
    moving = any(system.has(name) for name in ("A", "B", "D")) or not system.is_constant("M")
    return resisting and moving


def _slowed(system: LinearPeriodic, speed: float) -> LinearPeriodic:
    """Return the system with each term times the power of the speed that it carries."""
    rebuild = system.rebuild
    return replace(
        system,
        terms=tuple(_times(term, speed) for term in system.terms),
        rebuild=None if rebuild is None else lambda shape: _slowed(rebuild(shape), speed),
    )


def _times(term: Term, speed: float) -> Term:
    power = SPEED_POWER.get(term.array, 0) + term.power
    if not power:
        return term
    given, factor = term.function, float(speed**power)
    if callable(given):
        return replace(term, function=lambda theta: given(theta) * factor)
    return replace(term, function=given * factor)


def is_damped(system: LinearPeriodic, names: Names, axes: Axes) -> bool:
    """Return True where some damping term acts at some angle, somewhere on the chart."""
    grid = on_grid(names, axes)[1]
    scales = system.scale_values(**{k: v for k, v in grid.items() if k not in system.geometry})
    angles = np.linspace(0.0, system.period, 65)[:-1]
    return any(
        (term.scale is None or bool(np.any(scales[term.scale]))) and bool(np.any(term(angles)))
        for term in system.terms
        if term.array in DAMPING
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
    name = names[other]
    pair = float(axes[other][0]), float(axes[other][-1])
    ends = [
        _at_rest(system.with_geometry(**{name: value}), {})
        if name in system.geometry
        else _at_rest(system, {name: value})
        for value in pair
    ]
    return ends[0] if abs(ends[1] - ends[0]) <= 1e-12 * abs(ends[0]) else float("nan")


def _at_rest(system: LinearPeriodic, changes: dict[str, float]) -> float:
    mass = system.array("M", 0.0, **changes)[0]
    stiffness = system.array("K", 0.0, **changes)[0]
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    return float(np.sqrt(max(np.min(squares), 0.0)))
