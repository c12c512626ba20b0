"""Planar linkages of rigid bodies as data: bodies, joints, one drive, and what follows by machine.

A body's own frame has its origin at the body's first joint and its x axis along the link.  All
else, positions of points, velocities, accelerations and inertia forces, follows from the angle
and the origin of each body as functions of time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import sympy as sp

Vector = tuple[sp.Expr, sp.Expr]
XI, ETA = sp.symbols("xi eta", real=True)
FRAME = 1
STRAIGHT = "across"  # what specs drop where masses lie along the links


@dataclass(frozen=True)
class MassMoments:
    """Mass of a body and its moments in the body's own frame.

    ``mass``: [kg]; ``along``, ``across``: first moments along and across the link [kg m];
    ``across`` is 0 for a straight link; ``inertia``: about the first joint [kg m^2].
    """

    mass: sp.Expr
    along: sp.Expr
    across: sp.Expr
    inertia: sp.Expr

    def integral(self, density: sp.Expr) -> sp.Expr:
        """Return the integral of a polynomial in the body's coordinates xi, eta over the mass.

        Raises ``ValueError`` if it is not a quadratic one with equal coefficients of xi^2 and
        eta^2: then four numbers do not describe the body.
        """
        terms = sp.Poly(sp.expand(density), XI, ETA).as_dict()
        known = {(0, 0): self.mass, (1, 0): self.along, (0, 1): self.across}
        square, other, mixed = (
            _on_circle(terms.pop(powers, sp.S.Zero)) for powers in ((2, 0), (0, 2), (1, 1))
        )
        strange = set(terms) - set(known)
        if strange or mixed != 0 or square != other:
            raise ValueError(f"mass, first moments and inertia do not determine {density}")
        total = square * self.inertia
        for powers, value in terms.items():
            total += known[powers] * value
        return sp.expand(total)


def _on_circle(expression: sp.Expr) -> sp.Expr:
    """Return an expanded polynomial in sines and cosines, without squares of sines."""
    expression = sp.expand(expression)
    for sine in expression.atoms(sp.sin):
        expression = sp.expand(expression.subs(sine**2, 1 - sp.cos(sine.args[0]) ** 2))
    return expression


@dataclass(frozen=True)
class Body:
    """One moving link.

    ``name``: of the link; ``angle``: from the fixed x axis to the link's own, a function of time;
    ``origin``: place of the first joint, functions of time; ``moments``: distribution of mass.
    """

    name: str
    angle: sp.Expr
    origin: Vector
    moments: MassMoments

    def place(self, along: sp.Expr, across: sp.Expr) -> Vector:
        """Return the place of a point that is fixed in the body."""
        cosine, sine = sp.cos(self.angle), sp.sin(self.angle)
        return (
            self.origin[0] + along * cosine - across * sine,
            self.origin[1] + along * sine + across * cosine,
        )


@dataclass(frozen=True)
class Pin:
    """A pin joint: a point of one link stays on a point of another.

    ``first``, ``second``: numbers of the links, 1 for the frame; the reaction is the force of the
    first on the second; ``on_first``, ``on_second``: the joint in the frame of either link.
    """

    first: int
    second: int
    on_first: Vector
    on_second: Vector


@dataclass(frozen=True)
class Slide:
    """A sliding joint: a link slides without turning along the x axis of another.

    ``first``, ``second``: numbers of the links; force and couple are those of the first on the
    second; ``slider``, ``guide``: which of the two is the one that slides, and which holds the
    guide; ``through``: a point of the guide in its own frame; ``distance``: from there to the
    slider's origin, where the reaction acts; a function of time.
    """

    first: int
    second: int
    slider: int
    guide: int
    through: Vector
    distance: sp.Expr


Joint = Pin | Slide


@dataclass(frozen=True)
class PlanarLinkage:
    """A mechanism of rigid links with one drive.

    ``t``: time; ``bodies``: moving links 2, 3, ... in order; ``joints``: in the order of their
    reactions; ``driven``: number of the link on which the drive's torque acts; its angle is the
    crank angle.
    """

    t: sp.Symbol
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    driven: int = 2

    def body(self, number: int) -> Body:
        """Return the frame (number 1) or a moving link."""
        return _GROUND if number == FRAME else self.bodies[number - 2]

    @property
    def numbers(self) -> range:
        """Numbers of the moving links."""
        return range(2, 2 + len(self.bodies))

    def place(self, joint: Joint) -> Vector:
        """Return where the reaction of a joint acts."""
        if isinstance(joint, Slide):
            return self.body(joint.slider).origin
        return self.body(joint.second).place(*joint.on_second)

    def place_on(self, joint: Joint, number: int) -> Vector:
        """Return where the reaction of a joint acts, by the coordinates of one of its links."""
        if isinstance(joint, Pin):
            mine = joint.on_first if joint.first == number else joint.on_second
            return self.body(number).place(*mine)
        if number == joint.guide:
            along, across = joint.through
            return self.body(number).place(along + joint.distance, across)
        return self.body(joint.slider).origin

    def normal(self, joint: Slide) -> Vector:
        """Return the unit vector across the guide of a sliding joint."""
        angle = self.body(joint.guide).angle
        return -sp.sin(angle), sp.cos(angle)


_NOTHING = MassMoments(*[sp.S.Zero] * 4)
_GROUND = Body("frame", sp.S.Zero, (sp.S.Zero, sp.S.Zero), _NOTHING)


@dataclass(frozen=True)
class Wrench:
    """A force and its moment about the first joint of the body on which it acts."""

    x: sp.Expr
    y: sp.Expr
    moment: sp.Expr

    def __iter__(self) -> Iterator[sp.Expr]:
        """Return both components and the moment."""
        return iter((self.x, self.y, self.moment))


def cross(a: Vector, b: Vector) -> sp.Expr:
    """Return the moment of b at a."""
    return a[0] * b[1] - a[1] * b[0]


@cache
def inertia_wrench(body: Body, t: sp.Symbol) -> Wrench:
    """Return what the acceleration of a body takes: the integrals of a dm and of its moment.

    ``body``: angle and origin as functions of time; ``t``: time.
    """
    place = body.place(XI, ETA)
    pull = place[0].diff(t, 2), place[1].diff(t, 2)
    arm = place[0] - body.origin[0], place[1] - body.origin[1]
    over = body.moments.integral
    return Wrench(over(pull[0]), over(pull[1]), over(cross(arm, pull)))


def kinetic_energy(body: Body, t: sp.Symbol) -> sp.Expr:
    """Return the kinetic energy of a body, the integral of v^2/2 dm."""
    place = body.place(XI, ETA)
    return body.moments.integral((place[0].diff(t) ** 2 + place[1].diff(t) ** 2) / 2)


def momenta(body: Body, t: sp.Symbol) -> Wrench:
    """Return linear momentum, and moment of momentum about the fixed origin."""
    place = body.place(XI, ETA)
    speed = place[0].diff(t), place[1].diff(t)
    over = body.moments.integral
    return Wrench(over(speed[0]), over(speed[1]), over(cross(place, speed)))
