"""What may be asked of machines within tolerances: rows of numbers that keep their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad, shown
from ..core.families import Array, LinearPeriodic
from ..core.inputs import numbers_in_a_row, speed_span
from ..frequencies.held import held_frequencies
from ..recovery.stress_over_speed import stress_curve
from ..rigid import rigid_forces
from ..scenes import Scene
from ..stability import stability_edges

KINDS = ("frequencies", "edges", "boundaries", "stress", "forces")
Over = tuple[str, ArrayLike]
_ANGLE = "crank angle [rad]"
_MODES, _ANGLES, _SPEEDS, _VALUES = 6, 73, 21, 5  # by default
_ASIDE = 1.2  # factor beyond a range of speeds within which the same regions are looked for


@dataclass(frozen=True)
class Answer:
    """Numbers ``(rows, places)`` of a scene, with their names."""

    compute: Callable[[Scene], ArrayLike]
    rows: tuple[str, ...]
    units: tuple[str, ...]
    place: Array
    across: str
    quantity: str


def answer_of(
    scene: Scene,
    kind: str | Callable[[Scene], ArrayLike],
    at: ArrayLike | None,
    over: Over | None,
) -> Answer:
    """Return what is asked, by its kind, or a function of one's own."""
    if over is not None and kind != "boundaries":
        raise bad("over", shown(over), "nothing with this answer", "ask for boundaries")
    if kind in ("edges", "boundaries"):
        return _ends(scene, at, over, with_second=kind == "boundaries")
    if kind == "stress":
        return _stress(scene, _range(scene) if at is None else at, at is None)
    if kind in ("frequencies", "forces"):
        theta = numbers_in_a_row("at", np.linspace(0, 2 * np.pi, _ANGLES) if at is None else at)
        return (_frequencies if kind == "frequencies" else _forces)(scene, theta)
    if not callable(kind) or at is not None:
        expected = f"one of {', '.join(KINDS)}, or a function of a scene without 'at'"
        raise bad("answer", shown(kind), expected, "choose one")
    values = np.atleast_2d(np.asarray(kind(scene), dtype=float))
    rows = tuple(f"row {k + 1}" for k in range(len(values)))
    return Answer(
        kind, rows, ("-",) * len(rows), np.arange(float(values[0].size)), "entry", "answer"
    )


def _frequencies(scene: Scene, theta: Array) -> Answer:
    count = min(scene.linear_system().size, _MODES)

    def compute(one: Scene) -> Array:
        return held_frequencies(one.linear_system(), theta, {})[0][:, :count].T

    rows = tuple(f"mode {k + 1}" for k in range(count))
    return Answer(compute, rows, ("rad/s",) * count, theta, _ANGLE, "natural frequency")


def _forces(scene: Scene, theta: Array) -> Answer:
    def compute(one: Scene) -> dict[str, Array]:
        speed, faster = one.get("operation.speed"), one.get("operation.acceleration", 0.0)
        return dict(rigid_forces(one.machine(), theta, speed, faster).values)

    rows = tuple(sorted(compute(scene)))
    units = tuple("N" if name[0] in "xy" or name[-1] in "xy" else "N m" for name in rows)

    def stacked(one: Scene) -> Array:
        found = compute(one)
        return np.array([np.broadcast_to(found[name], theta.shape) for name in rows])

    return Answer(stacked, rows, units, theta, _ANGLE, "force or moment")


def _stress(scene: Scene, at: ArrayLike, spaced: bool) -> Answer:
    speeds = numbers_in_a_row("at", at)
    speeds = np.linspace(speeds[0], speeds[-1], _SPEEDS) if spaced else speeds

    def compute(one: Scene) -> Array:
        system = one.linear_system()
        return stress_curve(system, speeds, rtol=1e-5, stability=False, whole=False).maximum.T

    links = stress_curve(scene.linear_system(), speeds[:1], stability=False, whole=False).links
    return Answer(
        compute, links, ("Pa",) * len(links), speeds, "crank speed [rad/s]", "largest stress"
    )


def _ends(scene: Scene, at: ArrayLike | None, over: Over | None, *, with_second: bool) -> Answer:
    """Return ends of the unstable regions that every machine has, by name, also over a parameter.

    Regions whose label is a matter of words are left out, and ends far beyond the range.
    """
    low, high = speed_span(_range(scene) if at is None else at)  # type: ignore[arg-type]
    if with_second and over is None:
        if scene.get("chart.y", None) not in scene.linear_system().parameters:
            raise bad("over", "nothing", "a parameter and its values", "give both")
        least, most = scene.get("chart.y_range")
        over = scene.get("chart.y"), np.linspace(least, most, _VALUES)
    name, values = over or ("", np.zeros(1))
    places = numbers_in_a_row("over", values)

    def regions(system: LinearPeriodic, place: float, factor: float) -> Mapping[str, float]:
        moved = system.with_parameters(**{name: place}) if name else system
        edges = stability_edges(moved, (low / factor, high * factor))
        ends = {"from": edges.lower, "to": edges.upper}
        sure = np.flatnonzero(~edges.doubtful).tolist()
        found = {f"{e} {edges.labels[k]}": float(ends[e][k]) for k in sure for e in ends}
        return {label: speed for label, speed in found.items() if np.isfinite(speed)}

    first = [regions(scene.linear_system(), place, 1.0) for place in places.tolist()]
    rows = tuple(label for label in first[0] if all(label in others for others in first))
    if not rows:
        raise bad("at", f"{low:g} to {high:g} rad/s", "unstable regions with ends", "widen it")

    def compute(one: Scene) -> Array:
        found = [regions(one.linear_system(), place, _ASIDE) for place in places.tolist()]
        return np.array([[ends.get(label, np.nan) for ends in found] for label in rows])

    across = f"{name or 'edges'} [SI]"
    return Answer(compute, rows, ("rad/s",) * len(rows), places, across, "crank speed")


def _range(scene: Scene) -> tuple[float, float]:
    found = scene.get("operation.speed_range", None) if "operation" in scene else None
    if found is None:
        raise bad("at", "nothing", "speeds, for the scene names no range", "give at")
    return float(found[0]), float(found[1])
