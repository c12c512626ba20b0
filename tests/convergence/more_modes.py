"""Folds and doublings of Smith's rigs with more and more modes of the coupler.

Those of a response curve with few modes are the guess for one mode more, which is at rest in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import elastolink as el
import numpy as np
from bent_rigs import RPM
from elastolink.runtime.nonlinear.branch import value_error
from elastolink.runtime.nonlinear.loci import special_near
from elastolink.runtime.nonlinear.orbit import FIRST_STEPS, STAGES, Direction, Orbit, Solver
from elastolink.runtime.nonlinear.response import extremes
from elastolink.runtime.nonlinear.segments import Motion, Problem


@dataclass(frozen=True)
class Rig:
    """A rig of Smith's with the least follower inertia, and where its resonances are.

    Decrement; ranges of the speed [rpm] about the resonances and how many turns motions may have;
    a speed in the middle of the resonance at a third of the frequency.
    """

    title: str
    scene: str
    decrement: float
    ranges: tuple[tuple[float, float, int], ...]
    third: float

    @cache  # noqa: B019 - a handful
    def system(self, modes: int):
        """Return the coupler with so many modes."""
        changes = {
            "model.formulation": "inextensible",
            "model.modes": modes,
            "coupler.damping_ratio": self.decrement / (2 * np.pi),
        }
        return el.load_scene(self.scene, changes).system()


RIGS = {
    "A": Rig(
        "(10,1,10,4), 1/32 in",
        "smith_1972_101104_thirtysecond_inch",
        0.2,
        ((340, 370, 1), (440, 495, 2)),
        257,
    ),
    "B": Rig("(5,1,5,2), 1/16 in", "smith_1972_5152_sixteenth_inch", 0.07, ((596, 700, 1),), 518),
    "C": Rig(
        "(5,1,5,2), 3/64 in", "smith_1972_5152_threesixtyfourths_inch", 0.16, ((365, 620, 1),), 393
    ),
}


class Found(NamedTuple):
    """A special point: speed and its error [rpm], peak to peak [m], and the motion."""

    kind: str
    speed: float
    error: float
    size: float
    orbit: Orbit

    @property
    def turns(self) -> int:
        """Revolutions after which the motion repeats."""
        return self.orbit.motion.turns

    def is_like(self, other: Found) -> bool:
        """Return True for the same special point with other modes."""
        same = (self.kind, self.turns) == (other.kind, other.turns)
        near = abs(self.speed - other.speed) < 5e-3 * self.speed
        return same and near and abs(self.size - other.size) < 0.02 * self.size


def found(rig: Rig, modes: int) -> list[Found]:
    """Return the special points along the response curves over the rig's ranges."""
    points = []
    for low, high, turns in rig.ranges:
        bounds = low * RPM, high * RPM
        curve = el.response_curve(rig.system(modes), "speed", bounds, turns=turns)
        points += [
            Found(kind, value / RPM, error / RPM, top - bottom, orbit)
            for kind, value, error, top, bottom, orbit in zip(
                curve.special,
                curve.special_value,
                curve.special_error,
                curve.special_highest,
                curve.special_lowest,
                curve.special_orbits,
                strict=True,
            )
        ]
    return points


def with_more(rig: Rig, point: Found, modes: int) -> Iterator[Found]:
    """Yield a special point with one mode more each time, up to so many."""
    while (n := point.orbit.motion.x.shape[1]) < modes:
        orbit, problem = point.orbit, Problem(rig.system(n + 1), "speed", 0.0)
        solver = Solver(problem, orbit.tangent.span)
        steps = -(-len(orbit.motion.x) * (n + 1) // n)
        near = replace(
            orbit,
            motion=_wider(orbit.motion).resampled(steps, STAGES),
            tangent=_wider_direction(orbit.tangent).resampled(steps),
        )
        orbit = special_near(solver, near, orbit.value, point.kind)
        low, high = extremes(problem, orbit)
        error = value_error(solver, orbit, point.kind)
        point = Found(point.kind, orbit.value / RPM, error / RPM, high - low, orbit)
        yield point


def third(rig: Rig, modes: int) -> Iterator[float]:
    """Yield the peak-to-peak deflection [m] in the resonance at a third of the frequency.

    With one mode, and one more each time.
    """
    speed = rig.third * RPM
    curve = el.response_curve(rig.system(1), "speed", (0.85 * speed, speed))
    motion = curve.orbits[np.flatnonzero(curve.branch == 0)[-1]].motion
    for n in range(1, modes + 1):
        if n > 1:
            motion = _wider(motion).resampled(len(motion.x) + FIRST_STEPS, STAGES)
        solver = Solver(Problem(rig.system(n), "speed", 0.0), speed)
        motion = solver.settled(speed, motion)
        orbit, _ = solver.fine(speed, motion, solver.along_parameter(motion))
        motion = orbit.motion
        yield float(np.ptp(extremes(solver.problem, orbit)))


def _wider(motion: Motion) -> Motion:
    """Return a motion with a mode more, which is at rest."""
    return replace(motion, **{name: _zero_after(getattr(motion, name)) for name in ("x", "v", "a")})


def _wider_direction(direction: Direction) -> Direction:
    n = direction.states.shape[1] // 2
    x, v = direction.states[:, :n], direction.states[:, n:]
    states = np.concatenate([_zero_after(x), _zero_after(v)], axis=1)
    return replace(direction, states=states, scale=np.repeat(direction.scale[[0, -1]], n + 1))


def _zero_after(values: np.ndarray) -> np.ndarray:
    return np.concatenate([values, np.zeros_like(values[..., :1])], axis=-1)
