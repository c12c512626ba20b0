"""Wrenches of weights, constant loads and springs from numbers that may carry derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .dual import _Functions

if TYPE_CHECKING:
    from ..rigid import Machine, Spring, TorsionSpring

Pair = tuple[Any, Any]
_TURNING = {"coupler": "3", "follower": "4", "block": "4", "rod": "4"}


@dataclass(frozen=True)
class Pose:
    """Where the links are and how they move.

    Attributes
    ----------
    theta, speed : array_like or Dual
        Crank angle [rad] and speed [rad/s].
    lengths : mapping of str to array_like or Dual
        Of the linkage.
    motion : mapping of str to array_like or Dual
        What the emitted kinematics return, at the crank speed.
    """

    theta: Any
    speed: Any
    lengths: Mapping[str, Any]
    motion: Mapping[str, Any]

    def turning(self, link: str) -> Pair:
        """Return angle and angular speed of a link or the frame."""
        if link == "crank":
            return self.theta, self.speed
        if link not in _TURNING:
            return 0.0, 0.0
        return self.motion[f"theta{_TURNING[link]}"], self.motion[f"omega{_TURNING[link]}"]

    def turned(self, link: str, along: Any, across: Any) -> Pair:
        """Return a vector of a link's axes in the fixed frame."""
        angle = self.turning(link)[0]
        cos, sin = _Functions.cos(angle), _Functions.sin(angle)
        return cos * along - sin * across, sin * along + cos * across

    def origin(self, link: str) -> tuple[Pair, Pair]:
        """Return place and velocity of a link's first joint."""
        if link in ("coupler", "block"):
            x, y = self.turned("crank", self.lengths["crank"], 0.0)
            return (x, y), (-y * self.speed, x * self.speed)
        if link == "slider":
            place = self.motion["position"], self.lengths["offset"]
            return place, (self.motion["slider_velocity"], 0.0)
        pivots = {"follower": 1.0, "rod": -1.0}
        x = self.lengths["frame"] * pivots[link] if link in pivots else 0.0
        return (x, 0.0), (0.0, 0.0)

    def point(self, link: str, along: float, across: float) -> tuple[Pair, Pair, Pair]:
        """Return a point's place from the link's first joint, its place, and its velocity."""
        x, y = self.turned(link, along, across)
        (ox, oy), (vx, vy) = self.origin(link)
        speed = self.turning(link)[1]
        return (x, y), (x + ox, y + oy), (vx - y * speed, vy + x * speed)


Wrenches = dict[str, tuple[Any, Any, Any]]


def outside(machine: Machine, pose: Pose, masses: Mapping[str, tuple[Any, Any, Any]]) -> Wrenches:
    """Return weights and constant loads, by link, at the links' first joints.

    Parameters
    ----------
    machine : Machine
        Gravity and loads.
    pose : Pose
        Of the linkage.
    masses : mapping of str to (mass, along, across)
        Of each link.
    """
    found: Wrenches = {}
    gx, gy = machine.gravity
    for link, (mass, along, across) in masses.items():
        x, y = pose.turned(link, along, across)
        _add(found, link, mass * gx, mass * gy, x * gy - y * gx)
    for load in machine.loads:
        force: Any = load.force
        fx, fy = pose.turned(load.link, *force) if load.axes == "link" else force
        x, y = pose.turned(load.link, load.along, load.across)
        _add(found, load.link, fx, fy, load.couple + x * fy - y * fx)
    return found


def springs(machine: Machine, pose: Pose) -> Wrenches:
    """Return what springs and dampers do, by link, at the links' first joints."""
    found: Wrenches = {}
    for item in machine.springs:
        ends: Any = item
        parts = _twist(ends, pose) if isinstance(item.first, str) else _pull(ends, pose)
        for link, wrench in parts:
            if link != "frame":
                _add(found, link, *wrench)
    return found


def _add(found: Wrenches, link: str, *wrench: Any) -> None:
    fx, fy, couple = found.get(link, (0.0, 0.0, 0.0))
    found[link] = fx + wrench[0], fy + wrench[1], couple + wrench[2]


def _pull(spring: Spring, pose: Pose) -> list[tuple[str, tuple[Any, Any, Any]]]:
    ends = [(end[0], *pose.point(*end)) for end in (spring.first, spring.second)]
    (_, _, (ax, ay), (avx, avy)), (_, _, (bx, by), (bvx, bvy)) = ends
    span_x, span_y = bx - ax, by - ay
    constant = spring.preload - spring.stiffness * spring.free_length
    tension: Any = spring.stiffness  # over the length
    if constant or spring.damping:
        square = span_x * span_x + span_y * span_y
        length = _Functions.sqrt(square)
        closing = span_x * (bvx - avx) + span_y * (bvy - avy)
        tension = tension + constant / length + spring.damping * closing / square
    found = []
    for (link, (x, y), _, _), sign in zip(ends, (1.0, -1.0), strict=True):
        fx, fy = sign * tension * span_x, sign * tension * span_y
        found.append((link, (fx, fy, x * fy - y * fx)))
    return found


def _twist(spring: TorsionSpring, pose: Pose) -> list[tuple[str, tuple[Any, Any, Any]]]:
    (first, own), (second, other) = (pose.turning(link) for link in (spring.first, spring.second))
    couple = spring.preload + spring.stiffness * (second - first - spring.free_angle)
    couple = couple + spring.damping * (other - own)
    return [(spring.first, (0.0, 0.0, couple)), (spring.second, (0.0, 0.0, -couple))]
