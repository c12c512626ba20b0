"""Forces as linear functions of what counterweights add to the links, and their true peaks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .barrier import PER_LINK
from .masses import MassDistribution

if TYPE_CHECKING:
    from . import Machine

Array = NDArray[np.float64]

TERMS = (
    "shaking_force",
    "shaking_moment",
    "torque",
    "f12",
    "f23",
    "f34",
    "f41",
)

_OUTPUT_OF = {term: "pins" if term.startswith("f") else term for term in TERMS}
_FIRST_GRID = 256
_LAST_GRID = 8192
# The tail of the force's spectrum at which the peaks between samples are safe.
_TAIL = 1e-10
# Sampled peaks lower than this, over the highest, cannot be the highest one.
_CANDIDATE = 0.75
NODES = np.cos(np.pi * np.arange(13) / 12.0)
_TO_CHEBYSHEV = np.linalg.inv(np.polynomial.chebyshev.chebvander(NODES, 12))


@dataclass(frozen=True)
class ForceBasis:
    """A machine at one speed: the forces at any angle, and what each unit of mass adds.

    Attributes
    ----------
    machine : Machine
        Without the counterweights.
    links : sequence of str
        Links that carry counterweights.
    speed, acceleration : float
        Of the crank [rad/s, rad/s^2].
    terms : sequence of str
        Which forces.
    masses, lengths : ndarray
        Units of mass [kg] and length [m] of each link's parameters.
    """

    machine: Machine
    links: Sequence[str]
    speed: float
    acceleration: float
    terms: Sequence[str]
    masses: Array
    lengths: Array

    def forces(self, theta: Array, p: Array | None = None) -> dict[str, Array]:
        """Return each term (n, d) at n angles, with the parameters p of the counterweights."""
        machine = self.machine if p is None else self.with_parameters(p)
        return _forces(machine, theta, self.speed, self.acceleration, self.terms)

    def with_parameters(self, p: Array) -> Machine:
        """Return the machine with scaled parameters added to its links."""
        masses = dict(self.machine.masses)
        for i, link in enumerate(self.links):
            added = self._distribution(i, p[PER_LINK * i : PER_LINK * (i + 1)])
            masses[link] = masses.get(link, MassDistribution()) + added
        return replace(self.machine, masses=masses)

    def unit_forces(self, theta: Array) -> dict[str, Array]:
        """Return what each scaled parameter adds: (n, d, 4 links) for each term.

        The unit vectors are differences of bodies that exist: a point at the first joint, a ring
        about it, and points beside it.
        """
        bodies = (
            (1.0, 0.0, 0.0, 0.0),
            (1.0, 1.0, 0.0, 1.0),
            (1.0, 0.0, 1.0, 1.0),
            (1.0, 0.0, 0.0, 1.0),
        )
        columns: dict[str, list[Array]] = {term: [] for term in self.terms}
        for i, link in enumerate(self.links):
            found = []
            for body in bodies:
                machine = replace(
                    self.machine,
                    masses={link: self._distribution(i, np.array(body))},
                    loads=(),
                    springs=(),
                )
                found.append(_forces(machine, theta, self.speed, self.acceleration, self.terms))
            mass, along, across, ring = found
            for term in self.terms:
                columns[term] += [
                    mass[term],
                    along[term] - ring[term],
                    across[term] - ring[term],
                    ring[term] - mass[term],
                ]
        return {term: np.stack(parts, axis=-1) for term, parts in columns.items()}

    def _distribution(self, i: int, p: Array) -> MassDistribution:
        m, a, b, j = (float(x) for x in p)
        mass, length = float(self.masses[i]), float(self.lengths[i])
        moment = mass * length
        return MassDistribution(m * mass, a * moment, b * moment, j * moment * length)

    def grid(self) -> Array:
        """Return equally spaced angles of a turn, dense enough for the peaks between them."""
        n = _FIRST_GRID
        while True:
            theta = 2.0 * np.pi * np.arange(n) / n
            if n >= _LAST_GRID or self._tail(theta) < _TAIL:
                return theta
            n *= 2

    def _tail(self, theta: Array) -> float:
        worst = 0.0
        for forces in self.forces(theta).values():
            spectrum = np.abs(np.fft.rfft(forces, axis=0))
            whole = float(spectrum.max())
            high = float(spectrum[len(spectrum) * 3 // 4 :].max())
            worst = max(worst, high / whole if whole > 0 else 0.0)
        return worst

    def peaks(self, theta: Array, p: Array, between: bool) -> dict[str, tuple[Array, Array]]:
        """Return angles and magnitudes of each term's highest local peaks.

        Parameters
        ----------
        theta : ndarray
            Sampled angles, a whole turn where ``between``.
        p : ndarray
            Scaled parameters of the counterweights.
        between : bool
            Search between the samples too: the maximum of an interpolating polynomial of degree
            12, twice, the second time in an eighth of the interval.
        """
        machine = self.with_parameters(p)
        sampled = _forces(machine, theta, self.speed, self.acceleration, self.terms)
        sizes = {term: np.linalg.norm(value, axis=1) for term, value in sampled.items()}
        starts = {term: _local(theta, size, between) for term, size in sizes.items()}
        if between:
            # Two rounds, all terms at once: the angles of one are evaluated for the others too.
            width = float(theta[1] - theta[0])
            for half in (width, width / 8.0):
                starts = self._refined(machine, starts, half)
        found = {}
        joined = np.concatenate([starts[term] for term in self.terms])
        values = _forces(machine, joined, self.speed, self.acceleration, self.terms)
        place = 0
        for term in self.terms:
            count = len(starts[term])
            size = np.linalg.norm(values[term][place : place + count], axis=1)
            found[term] = (starts[term], size)
            place += count
        return found

    def _refined(
        self, machine: Machine, starts: Mapping[str, Array], half: float
    ) -> dict[str, Array]:
        joined = np.concatenate([starts[term] for term in self.terms])
        theta = (joined[:, None] + half * NODES).ravel()
        values = _forces(machine, theta, self.speed, self.acceleration, self.terms)
        refined, place = {}, 0
        for term in self.terms:
            count = len(starts[term])
            squares = np.sum(values[term] ** 2, axis=1).reshape(-1, len(NODES))
            own = squares[place : place + count]
            refined[term] = starts[term] + half * np.array([summit(row) for row in own])
            place += count
        return refined


def _local(theta: Array, size: Array, periodic: bool) -> Array:
    """Return the sampled angles of the local maxima that may be the highest."""
    if periodic:
        before, after = np.roll(size, 1), np.roll(size, -1)
        chosen = (size >= before) & (size >= after) & (size >= _CANDIDATE * size.max())
        found: Array = theta[chosen]
        # A force that is constant has maxima everywhere, and one of them is enough.
        return found[:1] if len(found) > len(theta) // 8 else found
    return np.asarray(theta[[int(np.argmax(size))]])


def summit(squares: Array) -> float:
    """Return where in [-1, 1] the interpolating polynomial is greatest near its highest node."""
    series = _TO_CHEBYSHEV @ squares
    slope = np.polynomial.chebyshev.chebder(series)
    bend = np.polynomial.chebyshev.chebder(slope)
    x = float(NODES[int(np.argmax(squares))])
    for _ in range(12):
        rise = float(np.polynomial.chebyshev.chebval(x, slope))
        curve = float(np.polynomial.chebyshev.chebval(x, bend))
        if not curve < 0.0:
            break
        x = min(max(x - rise / curve, -1.0), 1.0)
    return x


def _forces(
    machine: Machine, theta: Array, speed: float, acceleration: float, terms: Sequence[str]
) -> dict[str, Array]:
    from .forces import OUTPUTS, rigid_forces

    wanted = [output for output in OUTPUTS if any(_OUTPUT_OF[term] == output for term in terms)]
    result = rigid_forces(machine, theta, speed, acceleration, outputs=wanted)
    found = {}
    for term in terms:
        value = np.asarray(getattr(result, term), dtype=float)
        found[term] = value[:, None] if value.ndim == 1 else value
    return found
