"""The systems that are measured, each at one speed and with its equation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import cast

import numpy as np

from ...core.families import LinearPeriodic
from ..rod import rod_of
from .equation import Array, Equation


@dataclass(frozen=True)
class Case:
    """A system at a crank speed.

    Attributes
    ----------
    name, title : str
        Of the system.
    system : LinearPeriodic
        The system.
    speed : float
        Crank speed [rad/s].
    turns : int
        Length of a trajectory in revolutions.
    deflection : float
        Start of its first coordinate.
    chart : tuple or None
        Two parameters, each with ends and number of values; None where no chart is measured.
    """

    name: str
    title: str
    system: LinearPeriodic
    speed: float
    turns: int
    deflection: float
    chart: tuple[tuple[str, float, float, int], tuple[str, float, float, int]] | None = None

    def equation(self, *, forced: bool) -> Equation:
        """Return what peers solve."""
        return Equation.of(self.system, self.speed, forced=forced)

    @property
    def start(self) -> Array:
        """Coordinates at the start, at rest, ``(n,)``."""
        q = np.zeros(self.system.size)
        q[0] = self.deflection
        return q


def _coupler(modes: int) -> LinearPeriodic:
    from ...scenes import load_scene

    scene = load_scene("smith_1972_5152_sixteenth_inch", overrides={"model.modes": modes})
    return cast(LinearPeriodic, scene.system())


def _four_bar() -> LinearPeriodic:
    from ...scenes import load_scene

    overrides = {f"{link}.elements": 1 for link in ("crank", "coupler", "follower")}
    scene = load_scene("aannaque_1996_table_4_1", overrides=overrides)
    return cast(LinearPeriodic, scene.system())


_INERTIA = ("follower_inertia", 5.65e-4, 2.26e-3, 250)


def _hill() -> Case:
    title = "flexible coupler of Smith's (5,1,5,2) rig, one mode, 1/16 inch, 80 rad/s"
    chart = (("speed", 40.0, 150.0, 400), _INERTIA)
    return Case("hill", title, _coupler(1), 80.0, 10, 1e-4, chart)


def _coupled() -> Case:
    title = "the same coupler with three modes"
    chart = (("speed", 40.0, 150.0, 400), _INERTIA)
    return Case("coupler", title, _coupler(3), 80.0, 10, 1e-4, chart)


def _quick_return() -> Case:
    title = "flexible rod of Beale & Scott, three polynomial modes, 1000 rad/s"
    chart = (("speed", 500.0, 4000.0, 400), ("crank_ratio", 0.01, 0.2, 250))
    system = rod_of("3 polynomial modes")
    return Case("quick-return", title, system, 1000.0, 10, 1e-4, chart)


def _beams() -> Case:
    title = "four-bar of Aannaque's Table 4.1, nine freedoms, damping 2 %, 40 rad/s"
    return Case("four-bar", title, _four_bar(), 40.0, 1, 0.0)


_CASES: Mapping[str, Callable[[], Case]] = {
    "hill": _hill,
    "coupler": _coupled,
    "quick-return": _quick_return,
    "four-bar": _beams,
}
SYSTEMS = tuple(_CASES)


@cache
def case(name: str) -> Case:
    """Return a system by name."""
    return _CASES[name]()
