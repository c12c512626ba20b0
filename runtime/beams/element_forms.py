"""Element end forces and inertia of a structure of beams, linear in its motion.

Each element is looked at in the axes of its rigid link.  Its end forces are those that the nodes
exert; with them and its inertia it is in equilibrium, whatever its shape functions.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from ..core.errors import bad
from ..core.families import LinearPeriodic, Term
from ..linkages.linkage import LinkMotion
from .assembly import AngleArrays, Array, rotation, rotation_slope
from .linear import AxialForces, lumped_values
from .recovery_forms import LinearForm
from .structure import Structure

# The terms that the structure itself gives; all others are taken for forces from outside.
_OWN = {
    "M": ("distributed_mass", "lumped_mass"),
    "A": ("distributed_mass",),
    "B": ("distributed_mass",),
    "K": ("elasticity", None),
    "Kg": ("distributed_mass", "lumped_mass", None),
    "C": ("distributed_mass", None, "viscous", "rayleigh elastic", "rayleigh springs"),
    "D": ("viscous",),
    "f": ("distributed_mass", "lumped_mass"),
    "g": ("distributed_mass", "lumped_mass"),
    "p": (None,),
}
# Of those from outside, what they multiply, with the power of the speed.
_OUTSIDE = {
    "C": ("dq", 1, 1.0),
    "D": ("q", 1, 1.0),
    "K": ("q", 0, 1.0),
    "Kg": ("q", 0, 1.0),
    "f": ("1", 2, -1.0),
    "h": ("1", 1, -1.0),
    "p": ("1", 0, -1.0),
    "g": ("1", 0, 0.0),
}


class MovingElement:
    """One element of a system of beams at crank angles ``(nt,)``, in the axes of its rigid link."""

    def __init__(self, forms: ElementForms, number: int) -> None:
        self.forms, self.number = forms, number
        self.placed, self.arrays = forms.arrays.local[number]
        name, size = self.placed.beam.name, len(self.arrays.mass)
        motion = forms.arrays.motion(forms.theta)
        weights, pick = motion.products[name][:, :3], forms.spread[self.placed.indices]
        # R itself, from fixed to own axes: (nt, n_local, n_local).
        self.back = np.tensordot(weights, rotation(size), axes=1)
        # From the free coordinates to local nodal values, (nt, n_local, n): R, dR/dphi, -d2R/dphi2.
        self.own = self.back @ pick
        self.slope = np.tensordot(weights, rotation_slope(size), axes=1) @ pick
        self.circle = (self.back - rotation(size)[0]) @ pick
        # dphi/dtheta, d2phi/dtheta2, (nt, 1, 1).
        self.turning = motion.turning[name][:, None, None]
        self.hurrying = np.asarray(forms.moving[name].angular_acceleration)[:, None, None]
        # Nodal values of the rigid acceleration at unit crank speed, (nt, n_local).
        self.rigid = np.einsum("tij,tj->ti", self.back, motion.second[:, self.placed.indices])

    @property
    def fixed(self) -> Array:
        """From own to fixed axes, ``(nt, n_local, n_local)``."""
        return np.swapaxes(self.back, -1, -2)

    def local(self) -> LinearForm:
        """Return the local nodal values: ``R q``."""
        return LinearForm({("q", 0): self.own})

    def direct(self) -> LinearForm:
        """Return nodal accelerations with the shapes as they are: elastic, rigid, weight, outside.

        The field of the acceleration is ``N direct + J N across - N centripetal``.
        """
        forms = self.forms
        parts = {("ddq", 2): self.own}
        if forms.full:
            parts["dq", 2] = 2.0 * self.turning * self.slope
            parts["q", 2] = self.hurrying * self.slope - self.turning**2 * self.circle
        if forms.structure.moving:
            parts["1", 2] = self.rigid
        if any(forms.gravity):
            parts["1", 0] = -self.weight()
        return LinearForm(parts) + forms.outside.turned(self.own)

    def weight(self) -> Array:
        """Return gravity as local nodal values, ``(nt, n_local)`` [m/s^2]."""
        field = self.forms.axial.weight_field(self.forms.theta)[:, self.placed.indices]
        return np.asarray(np.einsum("tij,tj->ti", self.back, field))

    def across(self) -> LinearForm:
        """Return nodal values of what acts at a right angle: Coriolis' and Euler's parts."""
        if not self.forms.full:
            return LinearForm()
        own, slope = 2.0 * self.turning * self.own, 2.0 * self.turning**2 * self.slope
        return LinearForm({("dq", 2): own, ("q", 2): slope + self.hurrying * self.own})

    def centripetal(self) -> LinearForm:
        """Return nodal values of the part towards the centre, to be taken off."""
        parts = {("q", 2): self.turning**2 * self.own} if self.forms.full else {}
        return LinearForm(parts)

    def strain(self) -> LinearForm:
        """Return what the stiffness multiplies: values, and rates times the retardation."""
        found, factor = self.local(), self.forms.factor
        tau = self.placed.beam.section.retardation * factor["retardation"]
        if tau:
            rates = LinearForm({("dq", 1): self.own, ("q", 1): self.turning * self.slope})
            found = found + rates.scaled(tau)
        share = factor["rayleigh_stiffness"]
        if share:
            found = found + LinearForm({("dq", 1): share * self.own})
        return found.scaled(factor["elasticity"])

    def end_forces(self) -> LinearForm:
        """Return the generalised forces of the nodes on the element, in its own axes."""
        share, own = self.forms.factor["distributed_mass"], self.arrays
        total = self.direct().turned(share * own.mass)
        total = total + self.across().turned(share * own.coupling)
        total = total - self.centripetal().turned(share * own.centripetal)
        total = total + self.strain().turned(own.stiffness)
        for power, forces in self.forms.stiffening.items():
            kernel = np.tensordot(forces[:, self.number], own.geometric, axes=1)
            total = total + self.local().turned(kernel).faster(power)
        return total


class ElementForms:
    """The elements of a system of beams at crank angles ``(nt,)``, as forms linear in its motion.

    The system is one of ``linear_system``, with whatever damping was added.
    """

    def __init__(self, system: LinearPeriodic, theta: Array) -> None:
        self.system = system
        self.structure = required_structure(system)
        self.theta = theta
        self.arrays = AngleArrays(self.structure)
        self.lumped, self.springs, self.dampers = lumped_values(self.structure)
        self.full = system.has("A") or not self.structure.moving
        masses = dict.fromkeys(("distributed_mass", "lumped_mass"), 1.0)
        factors = {"elasticity": 1.0, **masses, "rayleigh_stiffness": 0.0, "retardation": 1.0}
        self.factor = {k: float(system.parameters.get(k, one)) for k, one in factors.items()}
        dampings = (("rayleigh_stiffness", "rayleigh elastic"), ("retardation", "viscous"))
        for name, kind in dampings:
            self.factor[name] *= self.has_damping(kind)

    @cached_property
    def spread(self) -> Array:
        """What makes all coordinates of the free ones, ``(N, n)``."""
        return np.eye(self.arrays.count)[:, self.arrays.free]

    @cached_property
    def moving(self) -> Mapping[str, LinkMotion]:
        """The motion of each rigid beam, by name."""
        return self.structure.configuration(self.theta)

    @cached_property
    def elements(self) -> tuple[MovingElement, ...]:
        """Every element, beam by beam."""
        return tuple(MovingElement(self, e) for e in range(len(self.arrays.local)))

    @cached_property
    def gravity(self) -> tuple[float, float]:
        """Acceleration of gravity [m/s^2]: the one that the constant forces tell."""
        probe = np.zeros(1)
        forces = [self._axial(pair).force("static", probe)[0] for pair in ((0, 0), (1, 0), (0, 1))]
        own = [t(probe)[0] for t in self.system.terms if t.array == "p" and t.scale is None]
        if not own:
            return (0.0, 0.0)
        unit = np.stack([forces[1] - forces[0], forces[2] - forces[0]], axis=-1)
        sizes = np.maximum(np.max(np.abs(unit), axis=0), np.finfo(float).tiny)
        found = np.linalg.lstsq(unit / sizes, np.sum(own, axis=0) - forces[0], rcond=None)[0]
        return (float(found[0] / sizes[0]), float(found[1] / sizes[1]))

    def _axial(self, gravity: tuple[float, float]) -> AxialForces:
        free = self.arrays.free
        return AxialForces(self.arrays, np.diag(self.springs[free]), self.lumped, gravity)

    @cached_property
    def axial(self) -> AxialForces:
        """The axial forces that the geometric stiffness holds."""
        return self._axial(self.gravity)

    @cached_property
    def stiffening(self) -> dict[int, Array]:
        """Axial forces of the geometric stiffness, ``(nt, elements, 3)`` by power of the speed."""
        found: dict[int, Array] = {}
        sources = {("distributed_mass", 2): "distributed", ("lumped_mass", 2): "lumped"}
        for term in self.system.terms:
            if term.array != "Kg" or not self._is_own(term):
                continue
            source = sources.get((term.scale or "", term.power), "static")
            scale = 1.0 if term.scale is None else self.factor[term.scale]
            value = scale * self.axial.along(source, self.theta)
            found[term.power] = found.get(term.power, 0.0) + value
        return found

    @staticmethod
    def _is_own(term: Term) -> bool:
        return term.scale in _OWN.get(term.array, ())

    @cached_property
    def mass(self) -> Array:
        """M of the system, ``(nt, n, n)``."""
        return self.system.array("M", self.theta)

    @cached_property
    def outside(self) -> LinearForm:
        """Accelerations ``M^-1 X`` of forces -X that act on the mass from outside: ``(nt, n)``.

        Modal damping is one: spread over the mass like the inertia of these accelerations.
        """
        total = LinearForm()
        scales = self.system.scale_values()
        for term in self.system.terms:
            if self._is_own(term):
                continue
            if term.array not in _OUTSIDE:
                found = "inertia that is not the structure's own"
                expected = "masses on nodes and beams"
                fix = "give it to Node or Section"
                raise bad(f"term {term.array} ({term.scale})", found, expected, fix)
            name, power, sign = _OUTSIDE[term.array]
            scale = 1.0 if term.scale is None else float(scales[term.scale])
            if not sign or not scale:
                continue
            value = np.asarray(sign * scale * term(self.theta))
            total = total + LinearForm({(name, power + term.power): value})
        return total.turned(_inverse(self.mass)) if total.parts else total

    def has_damping(self, scale: str | None) -> bool:
        """Return True where the system has a damping of that kind; None is that of dampers."""
        return any(term.array == "C" and term.scale == scale for term in self.system.terms)

    def node_inertia(self) -> LinearForm:
        """Return lumped mass times acceleration less gravity, of every coordinate."""
        lumped = self.factor["lumped_mass"] * self.lumped
        parts = {("ddq", 2): np.tile(self.spread, (len(self.theta), 1, 1))}
        if self.structure.moving:
            parts["1", 2] = self.arrays.motion(self.theta).second
        if any(self.gravity):
            parts["1", 0] = -self.axial.weight_field(self.theta)
        total = LinearForm(parts) + self.outside.turned(self.spread)
        return total.turned(np.diag(lumped))

    def node_holds(self) -> LinearForm:
        """Return the forces of springs and dampers at the nodes, of every coordinate."""
        pick = np.tile(self.spread, (len(self.theta), 1, 1))
        parts = {("q", 0): self.springs[:, None] * pick}
        drag = self.dampers * self.has_damping(None)
        drag = drag + self.factor["rayleigh_stiffness"] * self.springs
        if np.any(drag):
            parts["dq", 1] = drag[:, None] * pick
        return LinearForm(parts)

    def node_loads(self) -> LinearForm:
        """Return constant loads on the nodes, of every coordinate."""
        if not self.system.has("p"):
            return LinearForm()
        loads = np.broadcast_to(self.axial.node_forces, (len(self.theta), self.arrays.count))
        return LinearForm({("1", 0): np.asarray(loads)})

    @cached_property
    def resisted(self) -> LinearForm:
        """The forces that the motion needs at every coordinate ``(nt, N)``; of free ones none."""
        total = self.node_inertia() + self.node_holds() - self.node_loads()
        for element in self.elements:
            scatter = np.eye(self.arrays.count)[:, element.placed.indices]
            total = total + element.end_forces().turned(scatter @ element.fixed)
        return total

    @cached_property
    def acceleration(self) -> LinearForm:
        """``w^2 d2q/dtheta2`` from the equation of motion, in the rest: ``(nt, n)``."""
        free = self.arrays.free
        rest, mass = {}, None
        for key, value in self.resisted.parts.items():
            if key[0] == "ddq":
                mass = value[:, free]
            else:
                rest[key] = value[:, free]
        if mass is None:
            raise bad("structure", "no mass", "beams with mass", "give a density")
        return LinearForm(rest).turned(-_inverse(mass))

    def require_same(self) -> None:
        """Refuse a system whose stiffness or forces are not those of its structure."""
        free = self.arrays.free
        still = self.resisted.parts
        expected = {("q", 0): self.system.array("K", self.theta)}
        for term in self.system.terms:
            if term.array == "Kg" and term.power == 0:
                scale = 1.0 if term.scale is None else self.system.scale_values()[term.scale]
                expected["q", 0] = expected["q", 0] + scale * term(self.theta)
        if self.structure.moving:
            expected["1", 2] = -self.system.array("f", self.theta)
        for key, value in expected.items():
            found = still[key][:, free]
            size = max(float(np.max(np.abs(value))), np.finfo(float).tiny)
            # Difference of two ways to the same matrix, over its largest entry.
            if not np.max(np.abs(found - value)) <= 1e-9 * size:
                given = f"a {'stiffness' if key[0] == 'q' else 'force'} that is not its structure's"
                fix = "change the structure instead of the terms"
                raise bad("system", given, "a system as linear_system makes it", fix)


def _inverse(matrices: Array) -> Array:
    return np.asarray(np.linalg.inv(matrices), dtype=float)


def required_structure(system: object) -> Structure:
    """Return the structure of a system; refuse one that was not made from beams."""
    found = system.structure if isinstance(system, LinearPeriodic) else None
    if isinstance(found, Structure) and found.size == getattr(system, "size", None):
        return found
    given = f"{type(system).__name__} without beams, or with a sliding pin"
    fix = "make it by linear_system or a scene of beams"
    raise bad("system", given, "a LinearPeriodic that keeps its structure", fix)
