"""Numeric truth of rigid linkages that no printed formula enters: Newton and Euler, link by link.

Motion comes from the closure by search and from spectral derivatives; the forces from three
equations a link, moments about each link's centre of mass, solved together.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
from seed_truth import TURN, motion, spectral_derivative

GRAVITY = 386.09
SMITH_LENGTHS = (12.0, 6.0, 12.0, 12.0)
TABLE_3_2 = (0.547, 0.170, 0.328, 0.525)


@dataclass(frozen=True)
class Link:
    """A link about its first joint: mass, first moments along and across, moment of inertia."""

    mass: float
    along: float
    inertia: float
    across: float = 0.0

    @classmethod
    def bar(cls, mass, length):
        """Return a uniform thin bar."""
        return cls(mass, mass * length / 2.0, mass * length**2 / 3.0)

    @classmethod
    def disc(cls, mass, place, radius=0.0):
        """Return a cylinder, its axis across the plane at ``place``; a point with no radius."""
        return cls(mass, mass * place, mass * (place**2 + radius**2 / 2.0))

    def __add__(self, other):
        """Return both bodies fixed to each other."""
        return Link(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))

    @property
    def centre(self):
        """Return the centre of mass in the link's axes, a complex number."""
        return (self.along + 1j * self.across) / self.mass

    @property
    def inertia_about_centre(self):
        """Return the moment of inertia about the centre of mass."""
        return self.inertia - self.mass * abs(self.centre) ** 2


@dataclass(frozen=True)
class Forces:
    """Force of link i upon link j as complex numbers, driving torque, force and moment on frame."""

    f12: np.ndarray
    f23: np.ndarray
    f34: np.ndarray
    f41: np.ndarray
    torque: np.ndarray
    shaking_force: np.ndarray
    momentum_rate: np.ndarray
    energy_rate: np.ndarray


def centres(lengths, links, m):
    """Return the place of each link's centre of mass, complex, and the angle's unit vector."""
    l1, l2, _, _ = lengths
    units = [np.exp(1j * angle) for angle in (m.theta2, m.theta3, m.theta4)]
    firsts = (0.0, l2 * units[0], l1)
    return [
        first + link.centre * unit for first, link, unit in zip(firsts, links, units, strict=True)
    ]


def cross(arm, vector):
    """Return the moment of a vector on an arm, both complex."""
    return np.imag(np.conj(arm) * vector)


def joint_forces(joints, bodies):
    """Return F12, F23, F34, F41 as complex numbers, and the driving torque, at every sample.

    From the nine equations of the three links, moments about the centres of mass.  ``joints`` are
    the places of A to D; a body is its mass, its inertia about its centre, the centre's place and
    acceleration and the angular acceleration.
    """
    count = joints[1].size
    matrix, right = np.zeros((count, 9, 9)), np.zeros((count, 9))
    for i, (mass, inertia, place, acceleration, spin) in enumerate(bodies):
        for sign, joint in ((1.0, i), (-1.0, i + 1)):
            arm = joints[joint] - place
            matrix[:, 3 * i, 2 * joint] = sign
            matrix[:, 3 * i + 1, 2 * joint + 1] = sign
            matrix[:, 3 * i + 2, 2 * joint] = -sign * arm.imag
            matrix[:, 3 * i + 2, 2 * joint + 1] = sign * arm.real
        right[:, 3 * i] = mass * acceleration.real
        right[:, 3 * i + 1] = mass * acceleration.imag
        right[:, 3 * i + 2] = inertia * spin
    matrix[:, 2, 8] = 1.0
    solution = np.linalg.solve(matrix, right[..., None])[..., 0]
    return [*(solution[:, 2 * i] + 1j * solution[:, 2 * i + 1] for i in range(4)), solution[:, 8]]


def forces(lengths, links, speed=1.0, assembly="open", unsteady=0.0, count=512):
    """Return the forces of the links at every sample of one turn.

    The rates of the angular momentum about A and of the kinetic energy stand beside them, unused.
    """
    l1, l2, _, l4 = lengths
    m = motion(lengths, assembly, count, unsteady)
    places = centres(lengths, links, m)
    joints = (0.0, l2 * np.exp(1j * m.theta2), l1 + l4 * np.exp(1j * m.theta4), l1)
    momentum, energy, bodies = np.zeros(count), np.zeros(count), []
    for number, (link, place) in enumerate(zip(links, places, strict=True), 2):
        rate = getattr(m, f"omega{number}") * speed
        spin = getattr(m, f"alpha{number}") * speed**2
        velocity = spectral_derivative(place) * speed
        acceleration = spectral_derivative(place, 2) * speed**2
        inertia = link.inertia_about_centre
        bodies.append((link.mass, inertia, place, acceleration, spin))
        momentum += link.mass * cross(place, velocity) + inertia * rate
        energy += link.mass * abs(velocity) ** 2 / 2 + inertia * rate**2 / 2
    *pins, torque = joint_forces(joints, bodies)
    return Forces(
        *pins,
        torque=torque,
        shaking_force=pins[3] - pins[0],
        momentum_rate=spectral_derivative(momentum) * speed,
        energy_rate=spectral_derivative(energy) * speed,
    )


def smith_links(gravity=GRAVITY):
    """Return the links of Figs. 12-16: printed weights and inertias [lbf, in, s]."""
    crank = Link.bar(0.5 / gravity, 6.0)
    other = Link(1.0 / gravity, 6.0 / gravity, 0.125)
    return crank, other, other


def balanced(case, links, lengths=SMITH_LENGTHS, offsets=(6.0, 6.0, 6.0), radius=None):
    """Return the links of Fig. 20 (a)-(d) with their counterweights.

    ``offsets`` are the distances of the counterweights of links 2, 3, 4 behind their pivots;
    ``radius`` gives a counterweight's radius from its mass (points where None).
    """
    _, l2, l3, l4 = lengths
    crank, coupler, follower = links

    def weight(first_moment, offset):
        mass = first_moment / offset
        return Link.disc(mass, -offset, radius(mass) if radius else 0.0)

    if case == "a":
        return links
    at_b = at_c = 0.0
    if case == "c":
        coupler = coupler + weight(coupler.along, offsets[1])
        at_b = coupler.mass
    elif case == "d":
        at_c = coupler.along / l3
        at_b = coupler.mass - at_c
    return (
        crank + weight(crank.along + at_b * l2, offsets[0]),
        coupler,
        follower + weight(follower.along + at_c * l4, offsets[2]),
    )


def sweeps(link, frame, others, samples=721):
    """Return whether a link takes every angle to the frame, by looking at many, 0 and pi included.

    ``others`` are the two links between: they must span the distance of the free ends.
    """
    angles = np.linspace(0.0, TURN, samples)
    distance = np.abs(frame - link * np.exp(1j * angles))
    slack = 1e-9 * max(frame, link, *others)
    near, far = abs(others[0] - others[1]) - slack, sum(others) + slack
    return bool(np.all((near <= distance) & (distance <= far)))


def turning_letters(lengths):
    """Return C or R for input, coupler and output: which of them turns fully about the frame."""
    l1, l2, l3, l4 = lengths
    turning = (sweeps(l2, l1, (l3, l4)), sweeps(l3, l1, (l2, l4)), sweeps(l4, l1, (l2, l3)))
    return "".join("C" if full else "R" for full in turning)
