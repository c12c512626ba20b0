"""Energies of beams that move with a linkage, by quadrature: what the assembled arrays must give.

Nothing here knows of element matrices, of turned kernels or of the library's kinematics.  Places of
material points are written down, displaced by interpolated nodal values; a complex step in time
gives their velocities, Gauss's rule the energies.  Velocities are linear in the rates and in the
crank speed times the displacements, so that columns of them give every array of the Lagrangian.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from elastolink.runtime.linkages import FourBar, QuickReturn

_STEP = 1e-30
# Central differences of order 8, and how far apart.
STEP, DIFFERENCES = 0.01, (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(9)
_POINTS, _WEIGHTS = 0.5 * (_POINTS + 1.0), 0.5 * _WEIGHTS


def distance(found, expected):
    """Return the largest difference over the entries' natural sizes."""
    return np.max(np.abs(found - expected)) / np.max(np.abs(expected))


def scaled(found, expected, mass):
    """Return the largest difference of a matrix, rows and columns scaled by the mass matrix."""
    size = 1.0 / np.sqrt(np.diag(mass))
    return distance(found * np.outer(size, size), expected * np.outer(size, size))


def slope(function, theta, step=STEP):
    """Return the derivative of a function by central differences."""
    total = sum(
        weight * (function(theta + k * step) - function(theta - k * step))
        for k, weight in enumerate(DIFFERENCES, start=1)
    )
    return total / step


def array_gaps(system, energies, theta):
    """Return by array how far a system's are from those of the energies."""
    known = {**energies.kinetic(theta), **energies.elastic(theta)}
    return {
        array: scaled(system.array(array, theta)[0], known[array], known["M"])
        for array in ("M", "A", "B", "K", "C", "D")
    }


def places_of(linkage, theta):
    """Return the joints as ``(x, y)`` by letter, analytic in complex crank angles."""
    known = linkage.motion(np.array([0.4])).joints["C"][0]
    crank, coupler = linkage.crank, getattr(linkage, "coupler", None)
    fixed = 0.0 * theta

    def third(theta, sign):
        x, y = crank * np.cos(theta), crank * np.sin(theta)
        if not isinstance(linkage, FourBar):
            return x + sign * np.sqrt(coupler**2 - (known[1] - y) ** 2), known[1] + 0.0 * theta
        across, up = linkage.frame - x, -y
        gap = np.sqrt(across**2 + up**2)
        along = (coupler**2 - linkage.follower**2 + gap**2) / (2.0 * gap)
        aside = sign * np.sqrt(coupler**2 - along**2)
        return x + (along * across - aside * up) / gap, y + (along * up + aside * across) / gap

    def gap(sign):
        x, y = third(0.4, sign)
        return abs(x - known[0]) + abs(y - known[1])

    if isinstance(linkage, QuickReturn):
        pin = crank * np.cos(theta), crank * np.sin(theta)
        start = fixed - linkage.frame, fixed
        across = pin[0] - start[0]
        far = np.sqrt(across**2 + pin[1] ** 2) / linkage.rod
        tip = start[0] + across / far, pin[1] / far
        return {"A": (fixed, fixed), "B": pin, "C": tip, "D": start}
    joints = {
        "A": (fixed, fixed),
        "B": (crank * np.cos(theta), crank * np.sin(theta)),
        "C": third(theta, min((1.0, -1.0), key=gap)),
    }
    if isinstance(linkage, FourBar):
        joints["D"] = (linkage.frame + fixed, fixed)
    return joints


def monomials(x, count, times):
    """Return derivatives of 1, x, x^2 ... at places: ``(len(x), count)``."""
    powers = np.arange(count)
    factor = np.ones(count)
    for k in range(times):
        factor = factor * (powers - k)
    return factor * np.power.outer(np.asarray(x, dtype=float), np.maximum(powers - times, 0))


def interpolation(kind, length, ratio):
    """Return the powers of x in an element's deflection per nodal value: ``(powers, values)``.

    Values in the order ``v1, r1, v2, r2`` and the further ones; the ratio is EI over k G A [m^2]
    for a sheared element, else 0.
    """
    count = {"cubic": 4, "timoshenko": 4}.get(kind, 6)

    def row(x, times):
        return monomials([x], count, times)[0]

    def turn(x):
        # Without load M' = -Q: the section turns by v' + (EI/kGA) v'''.
        return row(x, 1) + ratio * row(x, 3)

    rows = [row(0.0, 0), turn(0.0), row(length, 0), turn(length)]
    if kind == "internal_node":
        rows += [row(length / 2.0, 0), row(length / 2.0, 1)]
    if kind == "curvature":
        rows += [row(0.0, 2), row(length, 2)]
    return np.linalg.inv(np.array(rows))


class Points(NamedTuple):
    """One element at Gauss's points: fields ``(points, m)`` for m states."""

    beam: object
    weight: np.ndarray
    along: np.ndarray
    x: np.ndarray
    y: np.ndarray
    turn: np.ndarray
    slope: np.ndarray
    strains: tuple[np.ndarray, ...]


@dataclass
class Energies:
    """A structure's energies, for m states at once: angles ``(m,)``, displacements ``(size, m)``.

    The structure is read for names, lengths, sections and lumped values alone; ``places`` gives
    places of the nodes as ``(x, y)`` at complex crank angles.
    """

    structure: object
    places: object

    def full(self, theta, q):
        """Return all free displacements of the nodes: more than q where a pin slides."""
        return q

    @property
    def labels(self):
        """Names of what :meth:`full` returns."""
        return self.structure.freedoms.free_labels

    def _value(self, label, q):
        labels = self.labels
        return q[labels.index(label)] if label in labels else np.zeros_like(q[0])

    def _turn(self, node, beam, q):
        joined = beam in self.structure.node(node).joined
        return self._value(f"{node}.rotation" if joined else f"{node}.{beam}", q)

    def _local(self, beam, k, q, axis):
        """Return u, v, rotation and curvature at element end k of a beam, in its own axes."""
        node = {0: beam.start, len(beam.places) - 1: beam.end}.get(k)
        stem = node or f"{beam.name}.{k}"
        x, y = self._value(f"{stem}.x", q), self._value(f"{stem}.y", q)
        turn = self._turn(node, beam.name, q) if node else self._value(f"{stem}.rotation", q)
        bend = f"{node}.{beam.name}.curvature" if node else f"{stem}.curvature"
        c, s = axis
        return c * x + s * y, c * y - s * x, turn, self._value(bend, q)

    def axis(self, beam, theta):
        """Return where a rigid beam begins, and cosine and sine of its angle."""
        ends = self.places(theta)
        (x0, y0), (x1, y1) = ends[beam.start], ends[beam.end]
        return (x0, y0), ((x1 - x0) / beam.length, (y1 - y0) / beam.length)

    def points(self, theta, q):
        """Yield every element with its fields at Gauss's points."""
        q = self.full(theta, q)
        for beam in self.structure.beams:
            (x0, y0), (c, s) = self.axis(beam, theta)
            for k, (left, right) in enumerate(zip(beam.places[:-1], beam.places[1:], strict=True)):
                ends = [self._local(beam, i, q, (c, s)) for i in (k, k + 1)]
                length = right - left
                powers, ratio = self._interpolated(beam, k, length, ends, q)
                v, slope, second, third = (
                    monomials(_POINTS * length, len(powers), times) @ powers for times in range(4)
                )
                along = (left + length * _POINTS)[:, None]
                moved = along + np.outer(1 - _POINTS, ends[0][0]) + np.outer(_POINTS, ends[1][0])
                turn = slope + ratio * third
                stretch = np.broadcast_to((ends[1][0] - ends[0][0]) / length, v.shape)
                yield Points(
                    beam,
                    _WEIGHTS * length,
                    along[:, 0],
                    x0 + c * moved - s * v,
                    y0 + s * moved + c * v,
                    turn,
                    slope,
                    (stretch, second, slope - turn),
                )

    def _interpolated(self, beam, number, length, ends, q):
        """Return the powers of x in the deflection, ``(powers, m)``, and EI over k G A."""
        section, sheared = beam.section, beam.kind == "timoshenko"
        ratio = section.bending_stiffness / section.shear_stiffness if sheared else 0.0
        values = [ends[0][1], ends[0][2], ends[1][1], ends[1][2]]
        if beam.kind == "internal_node":
            stem = f"{beam.name}.{number + 1}m"
            values += [self._value(f"{stem}.{part}", q) for part in ("across", "rotation")]
        if beam.kind == "curvature":
            values += [ends[0][3], ends[1][3]]
        return interpolation(beam.kind, length, ratio) @ np.array(values), ratio

    def _turning_beam(self, node):
        meeting = [beam for beam in self.structure.beams if node.name in (beam.start, beam.end)]
        name = node.carried_by or (node.joined or (meeting[0].name,))[0]
        return next(beam for beam in meeting if beam.name == name)

    def rates(self, theta, speed, q, qd):
        """Return weights ``(k,)`` and rates ``(k, m)`` of all that has kinetic energy."""
        now, moved = theta + 1j * _STEP * speed, q + 1j * _STEP * qd
        weights, rates = [], []

        def turning(beam, turn):
            c, s = self.axis(beam, now)[1]
            return (c.real * s.imag - s.real * c.imag + turn.imag) / _STEP

        for part in self.points(now, moved):
            section = part.beam.section
            kinds = [(section.mass_per_length, part.x.imag), (section.mass_per_length, part.y.imag)]
            if part.beam.kind == "timoshenko":
                rate = _STEP * turning(part.beam, part.turn)
                kinds.append((section.density * section.second_moment, rate))
            for weight, value in kinds:
                weights.append(weight * part.weight)
                rates.append(value / _STEP)
        at, moved = self.places(now), self.full(now, moved)
        for node in self.structure.nodes:
            for i, part in enumerate(("x", "y")):
                value = at[node.name][i] + self._value(f"{node.name}.{part}", moved)
                weights.append([node.mass])
                rates.append(value.imag[None] / _STEP)
            beam = self._turning_beam(node)
            weights.append([node.inertia])
            rates.append(turning(beam, self._turn(node.name, beam.name, moved))[None])
        return np.concatenate(weights), np.concatenate(rates)

    def _columns(self, function, theta):
        """Return columns of rates: at unit crank speed, per rate, per displacement."""
        size = self.structure.size
        none, unit = np.zeros((size, size)), np.eye(size)
        angles = np.full(size, theta)
        rigid = function(angles, 1.0, none, none)
        by_rate = function(angles, 0.0, none, unit)
        by_place = function(angles, 1.0, unit, none) - rigid
        return rigid[:, 0], by_rate, by_place

    def kinetic(self, theta):
        """Return M, A, B and the linear parts: ``td b . qd`` and ``td^2 a . q``."""
        size = self.structure.size
        none = np.zeros((size, 1))
        weights, _ = self.rates(np.full(1, theta), 1.0, none, none)
        rigid, rate, place = self._columns(lambda *state: self.rates(*state)[1], theta)
        weighted, moved = rate.T * weights, place.T * weights
        return {
            "M": weighted @ rate,
            "A": weighted @ place,
            "B": moved @ place,
            "b": weighted @ rigid,
            "a": moved @ rigid,
        }

    def elastic(self, theta):
        """Return K, and C and D of Kelvin and Voigt's material, springs and dampers included."""
        size = self.structure.size

        def strains(angles, speed, q, qd):
            points = self.points(angles + 1j * _STEP * speed, q + 1j * _STEP * qd)
            return np.concatenate([value.imag / _STEP for p in points for value in p.strains])

        stiff, late = [], []
        for part in self.points(np.full(1, theta), np.zeros((size, 1))):
            section = part.beam.section
            shear = section.shear_stiffness if part.beam.kind == "timoshenko" else 0.0
            for modulus in (section.axial_stiffness, section.bending_stiffness, shear):
                stiff.append(part.weight * modulus)
                late.append(part.weight * modulus * section.retardation)
        _, rate, place = self._columns(strains, theta)
        stiff, late = np.concatenate(stiff), np.concatenate(late)
        return {
            "K": (rate.T * stiff) @ rate + self._on_nodes("stiffness"),
            "C": (rate.T * late) @ rate + self._on_nodes("damping"),
            "D": (rate.T * late) @ place,
        }

    def _on_nodes(self, kind):
        found = np.zeros((self.structure.size,) * 2)
        for node in self.structure.nodes:
            for part, value in getattr(node, kind).items():
                own = self._turning_beam(node).name if part == "rotation" else part
                label = f"{node.name}.{own}"
                found[(self.structure.labels.index(label),) * 2] += value
        return found

    def geometric(self, theta, tension):
        """Return ``int P v'^2`` for axial forces ``tension(beam, along)`` [N]."""
        unit = np.eye(self.structure.size)
        total = np.zeros_like(unit)
        for part in self.points(np.full(len(unit), theta), unit):
            pull = part.weight * tension(part.beam, part.along)
            total += (part.slope.T * pull) @ part.slope
        return total

    def weight(self, theta, gravity):
        """Return generalised forces of weight and of constant loads on nodes."""
        unit = np.eye(self.structure.size)
        angles = np.full(len(unit), theta)
        found = np.zeros(len(unit))
        none = self.points(angles, np.zeros_like(unit))
        for part, rigid in zip(self.points(angles, unit), none, strict=True):
            lines = gravity[0] * (part.x - rigid.x) + gravity[1] * (part.y - rigid.y)
            found += part.beam.section.mass_per_length * (part.weight @ lines)
        full = self.full(angles, unit)
        for node in self.structure.nodes:
            for part, force, pull in zip(("x", "y"), node.force, gravity, strict=True):
                found += (force + node.mass * pull) * self._value(f"{node.name}.{part}", full)
        return found


class SlidingEnergies(Energies):
    """The same where the pin B slides along the rod: it lies where the bent rod is."""

    def full(self, theta, q):
        """Return all free displacements; a state that is complete is passed on."""
        labels = self.structure.labels
        if len(q) > len(labels):
            return q
        beam = self.structure.beam("rod")
        (x0, y0), (c, s) = self.axis(beam, theta)
        pin = self.places(theta)["B"]
        place = c * (pin[0] - x0) + s * (pin[1] - y0)
        known = dict(zip(labels, q, strict=True))
        along = known.pop("B.along")
        # Of B itself the rod knows nothing.
        none = np.zeros_like(along)
        known |= {"B.x": none, "B.y": none}
        rest = np.array([known[label] for label in self.labels])
        across = np.zeros_like(along)
        for i in range(len(across)):
            k = int(np.searchsorted(beam.places, place[i].real, side="right")) - 1
            ends = [self._local(beam, end, rest, (c, s)) for end in (k, k + 1)]
            left, right = beam.places[k], beam.places[k + 1]
            powers, _ = self._interpolated(beam, k, right - left, ends, rest)
            across[i] = sum(a * (place[i] - left) ** n for n, a in enumerate(powers[:, i]))
        known |= {"B.x": c * along - s * across, "B.y": s * along + c * across}
        return np.array([known[label] for label in self.labels])
