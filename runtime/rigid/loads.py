"""Loads, springs and dampers on the links of a machine, as wrenches at the links' first joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal, TypeAlias

import numpy as np

from ..core.errors import BadInput, Problem, bad, refuse, shown
from ..core.inputs import are_finite, is_one_of, names_problems, number_problems, text_problems
from ..linkages.linkage import Array, LinkMotion, PointMotion

End: TypeAlias = tuple[str, float, float]
Wrench: TypeAlias = tuple[Array, Array, Array]
"""Force components in the fixed frame at the first joint [N], and couple [N m]."""

FRAME = "frame"
_STILL = LinkMotion(*[np.zeros(2)] * 3, *[np.zeros(())] * 3)


@dataclass(frozen=True)
class LoadState:
    """What a load that depends on the motion is given; arrays broadcast with the crank angles.

    Attributes
    ----------
    theta : ndarray
        Crank angle [rad].
    crank_speed : ndarray
        Crank speed [rad/s].
    position, velocity : ndarray, shape (..., 2)
        Of the point where the load acts [m, m/s], fixed axes.
    angle, speed : ndarray
        Angle and angular speed of the loaded link [rad, rad/s].
    """

    theta: Array
    crank_speed: Array
    position: Array
    velocity: Array
    angle: Array
    speed: Array


Force: TypeAlias = tuple[float, float] | Callable[[Any], Any]
Couple: TypeAlias = float | Callable[[Any], Any]


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link, from outside the machine.

    Parameters
    ----------
    link : str
        The loaded link, for example ``"follower"``.
    force : pair of float, or callable
        Force components [N].  A callable is given the crank angles and returns the pair ``fx, fy``
        as a tuple, an array of shape (2,), or one of shape (..., 2): the components last.  For as
        many angles as components it is called once more, at one angle more.
    couple : float or callable
        Couple [N m], anticlockwise, in the same way.
    along, across : float
        The point of the link where the force acts [m], in the link's frame.
    axes : {"fixed", "link"}
        Whether the force components are those along x and y of the frame, or along and across the
        link.
    given : {"angle", "motion"}
        What a callable is given: the crank angles, or a :class:`LoadState`.

    Raises
    ------
    BadInput
        If a number is not finite, or a choice is unknown.

    Examples
    --------
    >>> import elastolink as el
    >>> def resistance(at):
    ...     return -500.0 * (at.velocity[..., 0] > 0.0), 0.0
    >>> press = el.Load("slider", resistance, given="motion")
    >>> machine = el.Machine(el.SliderCrank(crank=0.1, coupler=0.3), loads=(press,))
    >>> print(el.driving_torque(machine, theta=[-1.0, 1.0], speed=10.0).torque.round(2))
    [49.97  0.  ]
    """

    link: str
    force: Force = (0.0, 0.0)
    couple: Couple = 0.0
    along: float = 0.0
    across: float = 0.0
    axes: Literal["fixed", "link"] = "fixed"
    given: Literal["angle", "motion"] = "angle"

    def __post_init__(self) -> None:
        numbers: dict[str, Any] = {"along": self.along, "across": self.across}
        if not callable(self.couple):
            numbers["couple"] = self.couple
        problems = text_problems("Load", link=self.link) + number_problems("Load", numbers)
        if not (callable(self.force) or are_finite(self.force, 2)):
            expected = "a pair of finite numbers"
            problems.append(Problem("Load.force", shown(self.force), expected, "give (fx, fy)"))
        for name, choices in (("axes", ("fixed", "link")), ("given", ("angle", "motion"))):
            if not is_one_of(getattr(self, name), choices):
                given = shown(getattr(self, name))
                problems.append(Problem(f"Load.{name}", given, f"one of {choices}", "choose one"))
        refuse(problems)

    @property
    def links(self) -> tuple[str, ...]:
        """The links concerned."""
        return (self.link,)

    def wrenches(self, motion: Any, crank_speed: Array) -> dict[str, Wrench]:
        """Return the wrench on the link, given the motion at the crank speed [rad/s]."""
        force, couple = frozen(self, motion, crank_speed)
        return {self.link: at_first_joint(self, motion, force, couple)}


def frozen(load: Load, motion: Any, crank_speed: Array) -> tuple[Array, Array]:
    """Return force components (..., 2) along the load's own axes [N], and couple [N m]."""
    given: Any = motion.theta2
    if load.given == "motion" and (callable(load.force) or callable(load.couple)):
        point = motion.point(load.link, load.along, load.across)
        link, places = motion.link(load.link), (point.position, point.velocity)
        given = LoadState(motion.theta2, crank_speed, *places, link.angle, link.speed)
    shape = motion.theta2.shape
    force = evaluated(load.force, given, 2, f"Load.force on {load.link}", shape)
    return force, evaluated(load.couple, given, 0, f"Load.couple on {load.link}", shape)


def at_first_joint(load: Load, motion: Any, force: Array, couple: Array) -> Wrench:
    """Return a force along the load's axes and a couple as a wrench at the link's first joint."""
    moving = motion.link(load.link)
    fx, fy = force[..., 0], force[..., 1]
    if load.axes == "link":
        fx, fy = moving.turned(fx, fy)
    x, y = moving.turned(load.along, load.across)
    return fx, fy, couple + x * fy - y * fx


@dataclass(frozen=True)
class Spring:
    """A spring with a damper beside it, between points of two links or of a link and the frame.

    Its tension is ``preload + stiffness (length - free_length) + damping d(length)/dt``, along the
    line between the points.

    Parameters
    ----------
    first, second : (str, float, float)
        Link and point of it [m], along and across; for ``"frame"`` the point's x and y.
    stiffness : float
        Stiffness [N/m].
    free_length : float
        Length [m] at which the stiffness gives no force.
    damping : float
        Damping [N s/m].
    preload : float
        Tension [N] at the free length.

    Raises
    ------
    BadInput
        If a number is not finite or, the preload apart, negative, an end is no point, or both ends
        are on one link.

    Examples
    --------
    >>> import elastolink as el
    >>> spring = el.Spring(("frame", 0.0, 0.3), ("crank", 0.1, 0.0), stiffness=2000.0)
    >>> machine = el.Machine(el.SliderCrank(crank=0.1, coupler=0.3), springs=(spring,))
    >>> print(el.driving_torque(machine, theta=0.0, speed=0.0).torque.round(6))
    -60.0
    """

    first: End
    second: End
    stiffness: float = 0.0
    free_length: float = 0.0
    damping: float = 0.0
    preload: float = 0.0

    def __post_init__(self) -> None:
        problems = []
        for name in ("first", "second"):
            where, end = f"Spring.{name}", getattr(self, name)
            if isinstance(end, tuple) and len(end) == 3 and isinstance(end[0], str):
                problems += number_problems(where, {"along": end[1], "across": end[2]})
            else:
                expected, fix = "a link and two coordinates", "write it like ('crank', 0.1, 0.0)"
                problems.append(Problem(where, shown(end), expected, fix))
        sizes = {name: getattr(self, name) for name in ("stiffness", "free_length", "damping")}
        problems += number_problems("Spring", sizes, "not negative")
        problems += number_problems("Spring", {"preload": self.preload})
        if not problems and self.first[0] == self.second[0]:
            given = f"both ends on {self.first[0]!r}"
            problems.append(Problem("Spring", given, "two different links", "move an end"))
        refuse(problems)

    @property
    def links(self) -> tuple[str, ...]:
        """The links concerned, the frame among them."""
        return self.first[0], self.second[0]

    def wrenches(self, motion: Any, crank_speed: Array) -> dict[str, Wrench]:
        """Return the wrench on each of the links; see :meth:`Load.wrenches`."""
        a, b, span, length = self._span(motion)
        constant = self.preload - self.stiffness * self.free_length
        if constant == 0.0 and self.damping == 0.0:
            pull = self.stiffness * span
        else:
            if not np.all(np.real(length) > 0):
                given = "points that meet"
                fix = "move a point, or leave free length, preload and damping zero"
                raise bad("Spring", given, "points that stay apart", fix)
            unit = span / length[..., None]
            rate = np.sum(unit * (b.velocity - a.velocity), axis=-1)
            pull = self.stiffness * span + (constant + self.damping * rate)[..., None] * unit
        wrenches = {}
        for end, place, sign in ((self.first, a, 1.0), (self.second, b, -1.0)):
            if end[0] != FRAME:
                origin = motion.link(end[0]).origin
                x, y = np.moveaxis(place.position - origin, -1, 0)
                fx, fy = sign * pull[..., 0], sign * pull[..., 1]
                wrenches[end[0]] = (fx, fy, x * fy - y * fx)
        return wrenches

    def potential(self, motion: Any) -> Array:
        """Return the energy stored [J], zero at the free length."""
        length = self._span(motion)[3]
        stretch = length - self.free_length
        return np.asarray(self.stiffness / 2.0 * stretch**2 + self.preload * stretch)

    def _span(self, motion: Any) -> tuple[PointMotion, PointMotion, Array, Array]:
        a, b = (_moving(motion, link).point(*at) for link, *at in (self.first, self.second))
        span = b.position - a.position
        # Beside the real axis, where derivatives come from, there is no hypot.
        real = not np.iscomplexobj(span)
        length = np.hypot(*np.moveaxis(span, -1, 0)) if real else np.sqrt(np.sum(span**2, axis=-1))
        return a, b, span, np.asarray(length)


@dataclass(frozen=True)
class TorsionSpring:
    """A torsion spring with a damper beside it, between two links or a link and the frame.

    Its couple on the first link is ``preload + stiffness (angle of second - angle of first -
    free_angle) + damping (their relative speed)``, the opposite on the second.

    Parameters
    ----------
    first, second : str
        Links, or ``"frame"``, whose angle is zero.
    stiffness : float
        Stiffness [N m/rad].
    free_angle : float
        Relative angle [rad] without a couple; the angles of the links are continuous over turns.
    damping : float
        Damping [N m s/rad].
    preload : float
        Couple [N m] at the free angle.

    Raises
    ------
    BadInput
        If a number is not finite, stiffness or damping is negative, or both links are the same.

    Examples
    --------
    >>> import elastolink as el
    >>> spring = el.TorsionSpring("frame", "crank", stiffness=5.0)
    >>> machine = el.Machine(el.SliderCrank(crank=0.1, coupler=0.3), springs=(spring,))
    >>> print(el.driving_torque(machine, theta=0.2, speed=0.0).torque.round(6))
    1.0
    """

    first: str
    second: str
    stiffness: float = 0.0
    free_angle: float = 0.0
    damping: float = 0.0
    preload: float = 0.0

    def __post_init__(self) -> None:
        where = "TorsionSpring"
        rates = {"stiffness": self.stiffness, "damping": self.damping}
        problems = number_problems(where, rates, "not negative")
        problems += number_problems(where, {"free_angle": self.free_angle, "preload": self.preload})
        problems += names_problems(f"{where}: first, second", self.links)
        if not problems and self.first == self.second:
            given = f"both ends on {self.first!r}"
            problems.append(Problem(where, given, "two different links", "name another link"))
        refuse(problems)

    @property
    def links(self) -> tuple[str, ...]:
        """The links concerned, the frame among them."""
        return self.first, self.second

    def wrenches(self, motion: Any, crank_speed: Array) -> dict[str, Wrench]:
        """Return the wrench on each of the links; see :meth:`Load.wrenches`."""
        first, second = (_moving(motion, link) for link in self.links)
        twist, rate = second.angle - first.angle, second.speed - first.speed
        couple = self.preload + self.stiffness * (twist - self.free_angle) + self.damping * rate
        none = np.zeros(np.shape(couple))
        ends = ((self.first, couple), (self.second, -couple))
        return {link: (none, none, value) for link, value in ends if link != FRAME}

    def potential(self, motion: Any) -> Array:
        """Return the energy stored [J], zero at the free angle."""
        first, second = (_moving(motion, link) for link in self.links)
        twist = second.angle - first.angle - self.free_angle
        return np.asarray(self.stiffness / 2.0 * twist**2 + self.preload * twist)


def _moving(motion: Any, link: str) -> LinkMotion:
    """Return the motion of a link; the frame's is none."""
    moving: LinkMotion = _STILL if link == FRAME else motion.link(link)
    return moving


def evaluated(law: Any, given: Any, size: int, where: str, shape: tuple[int, ...]) -> Array:
    """Return a constant, or what a callable returns, as an array of shape ``(..., size)``.

    ``size`` 0 stands for numbers.
    """
    expected = f"{size or 'one'} number{'s' if size else ''} for each of the angles"
    value = law
    if callable(law):
        try:
            value = law(given)
        except BadInput:
            raise
        except (TypeError, ValueError, IndexError) as refusal:
            found = f"a callable that raises {type(refusal).__name__}: {refusal}"[:160]
            raise bad(where, found, expected, "correct the callable") from refusal
    square = shape and isinstance(value, np.ndarray) and value.shape == (2,) * (len(shape) + 1)
    if callable(law) and size and square:
        # As many angles as components: at one angle more, the array shows its order.
        longer = (int(np.prod(shape)) + 1,)
        evaluated(law, _one_more(given, shape), size, where, longer)
    try:
        if size and isinstance(value, Sequence) and len(value) == size:
            value = np.stack(np.broadcast_arrays(*value), axis=-1)
        values = np.asarray(value, dtype=float)
        fits = not size or (values.ndim > 0 and values.shape[-1] == size)
        outer = values.shape[:-1] if size else values.shape
        fits = fits and np.broadcast_shapes(outer, shape) == shape
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise bad(where, shown(value), expected, "correct what the callable returns")
    if not np.all(np.isfinite(values)):
        raise bad(where, "a value that is not finite", expected, "correct the callable")
    return values


def _one_more(given: Any, shape: tuple[int, ...]) -> Any:
    """Return what a callable is given, with the first of its places once more at the end."""
    if isinstance(given, LoadState):
        return LoadState(*(_one_more(getattr(given, item.name), shape) for item in fields(given)))
    inner = np.shape(given)[len(shape) :]
    flat = np.broadcast_to(given, (*shape, *inner)).reshape(-1, *inner)
    return np.concatenate([flat, flat[:1]])
