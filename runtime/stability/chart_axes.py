"""What the axes of a chart do to a system: damping, frequency, the function of Hill's equation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..hill import HillForm
from ..hill.form import is_hill
from ..periodic.equation import SPEED_POWER, at_geometry
from ..scenes import Scene

Names = tuple[str, str]
Axes = tuple[Array, Array]

# Values that show a proportional dependence, and angles at which functions are compared.
_PROBES = (1.0, 2.0, 5.0, 0.37)
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 17)

PlainAxes = tuple[int, PeriodicFunction, Callable[[Array], Array]]


def axis_of_scene(scene: Scene, axis: str) -> tuple[str, Array] | None:
    """Return the axis of ``[chart]``, or of the speed range and the measured inertias."""
    name = scene.get(f"chart.{axis}", None)
    ends = scene.get(f"chart.{axis}_range", None)
    points = scene.get(f"chart.{axis}_points", 201)
    speeds = scene.get("operation.speed_range", None)
    inertias = scene.get("measured.follower_inertias", None)
    if name is None or ends is None:
        if axis == "x" and name in {None, "speed"} and speeds:
            name, ends = "speed", speeds
        elif axis == "y" and name in {None, "follower_inertia"} and inertias:
            name, ends = "follower_inertia", (0.9 * min(inertias), 1.1 * max(inertias))
        else:
            return None
    return name, np.linspace(ends[0], ends[1], max(points, 2))


def measured_marks(scene: Scene, y: tuple[str, Array]) -> dict[str, tuple[float, ...]]:
    """Return the measured follower inertias within a chart, where they lie along y."""
    measured = scene.get("measured.follower_inertias", ())
    shown = tuple(value for value in measured if y[1][0] <= value <= y[1][-1])
    return {"measured follower inertias": shown} if y[0] == "follower_inertia" and shown else {}


def on_grid(names: Names, axes: Axes, fixed: float = 1.0) -> tuple[Array, dict[str, Array]]:
    """Return speeds (one, where it is no axis) and parameters, broadcasting to ``(ny, nx)``."""
    grid = {names[0]: axes[0][None, :], names[1]: axes[1][:, None]}
    return grid.pop("speed", np.full((1, 1), fixed)), grid


def fixed_speed(system: LinearPeriodic, names: Names, speed: float | None) -> float:
    """Return the speed of all points of a chart; 1 where it is left out, or an axis.

    Refused where it is given beside an axis of that name, is no positive number, or is missing of
    a system whose inertia forces come from a turning crank.
    """
    if "speed" in names:
        if speed is not None:
            raise bad("speed", speed, "none where the speed is an axis", "leave it out")
        return 1.0
    if speed is None:
        if _turned(system, names):
            found = f"the axes {names[0]} and {names[1]} and no speed"
            expected = "a crank speed, which decides between inertia and stiffness here"
            fix = "give speed=..., in rad/s, or make the speed an axis"
            raise bad("stability_chart", found, expected, fix)
        return 1.0
    try:
        value = float(speed)
    except (TypeError, ValueError):
        value = float("nan")
    if not (np.isfinite(value) and value > 0.0):
        raise bad("speed", repr(speed), "a positive number [rad/s]", "correct it")
    return value


def _turned(system: LinearPeriodic, names: Names) -> bool:
    """Return whether a speed of 1 is more than a way to write a plain Hill equation."""
    if is_hill(system) and not any(name in system.geometry for name in names):
        return False
    resisting = any(SPEED_POWER.get(term.array, 0) + term.power != 0 for term in system.terms)
    moving = any(system.has(name) for name in ("A", "B", "D")) or not system.is_constant("M")
    return resisting and moving


def is_symplectic(system: LinearPeriodic, damped: bool) -> bool:
    """Return True where multipliers come in reciprocal pairs: undamped, symmetric B, K and Kg."""
    angles = np.linspace(0.0, system.period, 65)[:-1]
    symmetric = all(
        np.max(np.abs(value - np.swapaxes(value, -1, -2))) <= 1e-13 * np.max(np.abs(value))
        for value in (term(angles) for term in system.terms if term.array in {"B", "K", "Kg"})
    )
    return symmetric and not damped


def natural_frequency(system: LinearPeriodic, names: Names, axes: Axes) -> float:
    """Return the lowest natural frequency at rest [rad/s]; NaN where it is not one number.

    It is one number where speed is an axis and the other parameter leaves it alone.
    """
    if "speed" not in names:
        return float("nan")
    other = 1 - names.index("speed")
    name = names[other]
    pair = float(axes[other][0]), float(axes[other][-1])
    ends = [_at_rest(*at_geometry(system, {name: value})) for value in pair]
    return ends[0] if abs(ends[1] - ends[0]) <= 1e-12 * abs(ends[0]) else float("nan")


def _at_rest(system: LinearPeriodic, changes: Mapping[str, Any]) -> float:
    mass = system.array("M", 0.0, **changes)[0]
    stiffness = system.array("K", 0.0, **changes)[0]
    squares = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real
    return float(np.sqrt(max(np.min(squares), 0.0)))


# ---------------------------------------------------------------- one mode


def plain_axes(form: HillForm, names: tuple[str, str], fixed: float) -> PlainAxes | None:
    """Return how two axes amount to ``y'' + (lam2 + mu f) y = 0`` at a speed, where they do.

    That is which one is lam2's, f, and lam2 of its values; those of the other are mu.
    """
    for which in (0, 1):
        along, other = names[which], names[1 - which]
        if other == "speed" or (along == "speed" and form.elastic):
            continue
        if not leaves_function_alone(form, along):
            continue
        unit = form.function(fixed, **{other: 1.0})
        at = unit(_ANGLES)
        if not all(
            np.allclose(form.function(fixed, **{other: v})(_ANGLES), v * at, rtol=1e-14, atol=0.0)
            for v in _PROBES
        ):
            continue
        stiffness = form.stiffness()
        if any(form.stiffness(**{other: v}) != stiffness for v in _PROBES):
            continue
        if along == "speed":
            return which, unit, partial(_over_square, stiffness)
        if is_stiffness(form, along):
            return which, unit, partial(np.multiply, fixed**-2)
    return None


def _over_square(stiffness: float, speed: Array) -> Array:
    return stiffness / speed**2


def is_stiffness(form: HillForm, name: str) -> bool:
    """Return True where a parameter is the constant stiffness itself."""
    if name not in form.system.parameters:
        return False
    probe = [form.stiffness(**{name: v}) for v in _PROBES]
    return bool(np.allclose(probe, _PROBES, rtol=1e-14)) and leaves_function_alone(form, name)


def leaves_function_alone(form: HillForm, name: str) -> bool:
    """Return True where an axis changes the constant stiffness and damping but not f."""
    if name == "speed":
        return not form.elastic
    parts = {scale for scale, _ in (*form.inertial, *form.elastic)}
    parts |= {term.scale for term in form.system.terms if term.array == "M"}
    own = form.system.parameters[name]
    base = form.system.scale_values()
    return all(
        np.all(base[scale] == form.system.scale_values(**{name: value})[scale])
        for scale in parts
        if scale is not None
        for value in (own + 1.0, 2.0 * abs(own) + 3.0)
    )
