"""A machine: a rigid linkage with masses, gravity, loads and springs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import astuple, dataclass, field, replace
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Problem, bad, refuse, shown
from ..core.inputs import are_finite, numbers, require_kind, require_one_of
from ..linkages.linkage import Array, Linkage
from .loads import FRAME, Load, Spring, TorsionSpring, Wrench
from .masses import MassDistribution

AnySpring: TypeAlias = Spring | TorsionSpring
Part: TypeAlias = Literal["all", "outside", "springs", "nonconservative"]

_NONE = (0.0, 0.0)


@dataclass(frozen=True)
class Machine:
    """A rigid linkage with the masses of its links and what acts on them.

    Parameters
    ----------
    linkage : Linkage
        The lengths and the assembly: :class:`FourBar`, :class:`SliderCrank`, :class:`QuickReturn`.
    masses : mapping of str to MassDistribution
        By link; a link that is not named has no mass.  A flywheel on the crankshaft belongs to the
        crank.
    gravity : pair of float
        Acceleration of gravity [m/s^2] in the fixed frame; ``(0, -9.81)`` for a vertical plane.
    loads : sequence of Load
        Forces and couples from outside.
    springs : sequence of Spring or TorsionSpring
        Springs and dampers between links, or between a link and the frame.

    Raises
    ------
    BadInput
        If a link is unknown, or an item is of the wrong kind; every problem is listed.

    Examples
    --------
    >>> import elastolink as el
    >>> flywheel = el.MassDistribution(inertia=0.01)
    >>> machine = el.Machine(el.FourBar(0.3, 0.15, 0.3, 0.3), {"crank": flywheel})
    >>> print(round(machine.kinetic_energy(theta=0.0, speed=10.0).item(), 9))
    0.5
    """

    linkage: Linkage
    masses: Mapping[str, MassDistribution] = field(default_factory=dict)
    gravity: tuple[float, float] = _NONE
    loads: tuple[Load, ...] = ()
    springs: tuple[AnySpring, ...] = ()

    def __post_init__(self) -> None:
        """Check every part, and hold copies that do not change."""
        require_kind("Machine.linkage", self.linkage, Linkage, "give a FourBar, for example")
        problems = _mass_problems(self.masses, self.linkage.links)
        if not are_finite(self.gravity, 2):
            fix = "write it like (0.0, -9.81)"
            given = shown(self.gravity)
            problems.append(Problem("Machine.gravity", given, "two finite components", fix))
        for name, kinds in (("loads", (Load,)), ("springs", (Spring, TorsionSpring))):
            problems += _item_problems(name, getattr(self, name), kinds, self.linkage.links)
        refuse(problems)
        object.__setattr__(self, "masses", dict(self.masses))
        object.__setattr__(self, "gravity", tuple(float(part) for part in self.gravity))
        object.__setattr__(self, "loads", tuple(self.loads))
        object.__setattr__(self, "springs", tuple(self.springs))

    def mass(self, link: str) -> MassDistribution:
        """Return the mass distribution of a link, an empty one where it has no mass."""
        return self.masses.get(link, MassDistribution())

    @property
    def loaded(self) -> bool:
        """True where something acts on the links beside their inertia."""
        return bool(self._heavy or self.loads or self.springs)

    @property
    def _heavy(self) -> bool:
        return self.gravity != _NONE and any(mass.mass > 0 for mass in self.masses.values())

    def course(self, name: str, speed: float) -> Callable[[Array], Array]:
        """Return a force as a function of the crank angle at constant crank speed [rad/s].

        Raises ``BadInput`` if the crank cannot turn fully, or there is no such force.
        """
        from .forces import OUTPUTS, rigid_forces

        self.linkage.require_full_turn()
        known = rigid_forces(self, np.zeros(1), speed).values
        require_one_of("source", name, known, "choose a force")
        # What is wanted alone takes a shorter way than all pin forces.
        alone = {"shaking_x": "shaking_force", "shaking_y": "shaking_force"}.get(name, name)
        outputs = [output for output in OUTPUTS if output == alone] or ["pins"]
        return lambda theta: rigid_forces(self, theta, speed, outputs=outputs)[name]

    @property
    def provenance(self) -> dict[str, str]:
        """Lengths, assembly and masses, for results."""
        numbers = {
            f"masses.{link}": " ".join(repr(float(number)) for number in astuple(mass))
            for link, mass in self.masses.items()
        }
        return {"links.assembly": "", **self.linkage.provenance, **numbers}

    def kinetic_energy(self, theta: ArrayLike, speed: ArrayLike) -> Array:
        """Return the kinetic energy [J].

        Parameters
        ----------
        theta, speed : array_like
            Crank angle [rad] and crank speed [rad/s]; they broadcast.

        Raises
        ------
        BadInput
            If the linkage cannot reach an angle.
        """
        motion = self.linkage.motion(theta, speed)
        parts = []
        for link, mass in self.masses.items():
            moving = motion.link(link)
            x, y = moving.turned(mass.along, mass.across)
            vx, vy = np.moveaxis(np.asarray(moving.velocity), -1, 0)
            translation = mass.mass * (vx * vx + vy * vy) / 2.0
            mixed = moving.speed * (x * vy - y * vx)
            parts.append(translation + mixed + mass.inertia * moving.speed**2 / 2.0)
        return _sum(parts, motion)

    def potential_energy(self, theta: ArrayLike) -> Array:
        """Return the energy [J] of springs (zero at their free lengths) and of the weights.

        That of a weight is zero where its centre is at the height of A.

        Raises ``BadInput`` if the linkage cannot reach an angle.
        """
        motion = self.linkage.motion(theta)
        parts = [spring.potential(motion) for spring in self.springs]
        if self._heavy:
            gx, gy = self.gravity
            for link, mass in self.masses.items():
                moving = motion.link(link)
                x, y = moving.turned(mass.along, mass.across)
                ox, oy = np.moveaxis(np.asarray(moving.origin), -1, 0)
                parts.append(-gx * (mass.mass * ox + x) - gy * (mass.mass * oy + y))
        return _sum(parts, motion)

    def power(self, theta: ArrayLike, speed: ArrayLike, part: Part = "nonconservative") -> Array:
        """Return the power [W] that loads and dampers bring into the machine.

        Parameters
        ----------
        theta, speed : array_like
            Crank angle [rad] and crank speed [rad/s]; they broadcast.
        part : str
            Which of the wrenches, as :func:`wrenches`; by default those that no potential energy
            accounts for.

        Raises
        ------
        BadInput
            If the linkage cannot reach an angle, or a load's callable is wrong.
        """
        motion = self.linkage.motion(theta, speed)
        return power_of(wrenches(self, motion, speed, part), motion)


def wrenches(
    machine: Machine, motion: Any, speed: ArrayLike, part: Part = "all"
) -> dict[str, Wrench]:
    """Return what acts on each loaded link, as force and couple at its first joint.

    The motion is that at the crank speed.  The parts are everything; from outside, loads and
    weights; springs and dampers; or what no potential energy accounts for, loads and dampers.
    """
    crank_speed = np.asarray(speed, dtype=float)
    sources: list[dict[str, Wrench]] = []
    if part in ("all", "outside") and machine.gravity != _NONE:
        sources.append(_weights(machine, motion))
    if part != "springs":
        sources += [load.wrenches(motion, crank_speed) for load in machine.loads]
    if part in ("all", "springs"):
        sources += [spring.wrenches(motion, crank_speed) for spring in machine.springs]
    elif part == "nonconservative":
        damped = (spring for spring in machine.springs if spring.damping)
        dampers = (replace(spring, stiffness=0.0, preload=0.0) for spring in damped)
        sources += [damper.wrenches(motion, crank_speed) for damper in dampers]
    total: dict[str, Wrench] = {}
    for source in sources:
        for link, (fx, fy, couple) in source.items():
            x, y, c = total.get(link, (0.0, 0.0, 0.0))
            total[link] = x + fx, y + fy, c + couple
    return total


def _weights(machine: Machine, motion: Any) -> dict[str, Wrench]:
    gx, gy = machine.gravity
    weights = {}
    for link, mass in machine.masses.items():
        x, y = motion.link(link).turned(mass.along, mass.across)
        none = np.zeros(np.shape(x))
        weights[link] = (none + mass.mass * gx, none + mass.mass * gy, x * gy - y * gx)
    return weights


def power_of(by_link: Mapping[str, Wrench], motion: Any) -> Array:
    """Return the power [W] of wrenches at the links' first joints."""
    parts = []
    for link, (fx, fy, couple) in by_link.items():
        moving = motion.link(link)
        vx, vy = np.moveaxis(np.asarray(moving.velocity), -1, 0)
        parts.append(fx * vx + fy * vy + couple * moving.speed)
    return _sum(parts, motion)


def require_machine(machine: object) -> None:
    """Raise BadInput for what is no Machine."""
    require_kind("machine", machine, Machine, "build one of a linkage")


def _sum(parts: Iterable[Array], motion: Any) -> Array:
    return np.asarray(sum(parts, np.zeros(np.shape(motion.theta2))))


def _mass_problems(masses: object, links: tuple[str, ...]) -> list[Problem]:
    if not isinstance(masses, Mapping):
        given = type(masses).__name__
        return [Problem("Machine.masses", given, "a mapping from link to mass", "correct it")]
    problems = []
    for link, mass in masses.items():
        where = f"Machine.masses[{link!r}]"
        if link not in links:
            problems.append(Problem(where, repr(link), f"a link of {links}", "correct the name"))
        if not isinstance(mass, MassDistribution):
            given, fix = type(mass).__name__, "build one with MassDistribution.uniform_bar"
            problems.append(Problem(where, given, "a MassDistribution", fix))
    return problems


def _item_problems(
    name: str, items: object, kinds: tuple[type, ...], links: tuple[str, ...]
) -> list[Problem]:
    if not isinstance(items, (tuple, list)):
        given = type(items).__name__
        return [Problem(f"Machine.{name}", given, "a sequence", "put it into brackets")]
    problems = []
    listed: list[Any] = list(items)
    for place, item in enumerate(listed):
        where = f"Machine.{name}[{place}]"
        if not isinstance(item, kinds):
            wanted = " or ".join(kind.__name__ for kind in kinds)
            problems.append(Problem(where, type(item).__name__, wanted, "build one"))
            continue
        known: Any = item
        allowed = (*links, FRAME) if name == "springs" else links
        problems += [
            Problem(where, repr(link), f"a link of {allowed}", "correct the name")
            for link in known.links
            if link not in allowed
        ]
    return problems


def finite_number(value: object, where: str) -> float:
    """Return a finite number, or raise BadInput."""
    number = numbers(where, value)
    if number.size != 1 or not np.isfinite(number).all():
        raise bad(where, shown(value), "a finite number", "correct it")
    return float(number.item())
