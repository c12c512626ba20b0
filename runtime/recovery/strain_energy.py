"""Energies and powers of a structure of beams in a motion, by virtual work."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from ..beams.assembly import Array
from ..beams.element_forms import ElementForms, MovingElement, required_structure
from ..beams.recovery_forms import LinearForm
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check
from ..core.trigonometric import differentiated, even_angles, interpolated
from .beam_motion import BeamMotion, Motion, beam_motion, chunks
from .beam_result import BeamResult, MotionValues, in_motion, over_motion
from .finer_mesh import with_mesh

# How the axial forces of the geometric stiffness change with the crank angle: by power of the
# speed, from angles (nt,) to (nt, elements, 3).
Slopes = Mapping[int, Callable[[Array], Array]]


def _slope(system: LinearPeriodic, power: int) -> Callable[[Array], Array]:
    """Return the derivative of the axial forces of one power by their Fourier series."""
    count = 256
    while True:
        theta = even_angles(system.period, count)
        forms = ElementForms(system, theta)
        values = forms.stiffening[power]
        amplitudes = np.abs(np.fft.rfft(values, axis=0)) / count
        largest = float(np.max(amplitudes))
        if power == 0:
            # Supports may take all of a constant load: what is left is round-off of it.
            largest += float(np.max(np.abs(forms.axial.force("static", theta))))
            largest += float(np.max(np.abs(forms.axial.node_forces)))
        # Round-off in solving for the forces leaves amplitudes of 1e-10 of the largest.
        if float(np.max(amplitudes[count // 3 :])) <= 1e-10 * largest:
            return interpolated(values, system.period, noise=1e-13).derivative
        count *= 2
        if count > 4096:
            found = "axial forces that 4096 samples do not resolve"
            raise bad("structure", found, "a smooth motion", "keep off dead points")


_SUMS = ("springs", "stiffening", "kinetic", "dissipated", "loads", "drive")


class Energies:
    """Energies and powers of a motion at some of its angles."""

    def __init__(self, forms: ElementForms, values: MotionValues, slopes: Slopes) -> None:
        self.forms, self.values = forms, values
        self.speed, self.q, self.slope = values.speed, values.q, values.slope
        self.rigid = forms.arrays.motion(forms.theta)
        self.changing = {power: slope(forms.theta) for power, slope in slopes.items()}

    def _spread(self, form: LinearForm, like: Array) -> Array:
        return np.broadcast_to(self.values(form), like.shape)

    def by_name(self) -> dict[str, Array]:
        """Return the arrays by name, as :class:`BeamEnergies` has them."""
        forms, count = self.forms, len(self.forms.theta)
        links = [beam.name for beam in forms.structure.beams]
        strain = np.zeros((count, len(links)))
        sums = {name: np.zeros(count) for name in _SUMS}
        for element in forms.elements:
            link = links.index(element.placed.beam.name)
            strain[:, link] += self._element(element, sums)
        self._nodes(sums)
        if forms.outside.parts:
            force = forms.outside.turned(forms.mass).values(self.speed, self.q, self.slope)
            sums["dissipated"] += np.vecdot(self.speed * self.slope, force)
        return {"strain": strain, **sums}

    def _element(self, at: MovingElement, sums: dict[str, Array]) -> Array:
        """Add what an element has to the sums; return its strain energy."""
        forms, own, turning = self.forms, at.arrays, at.turning[..., 0]
        share, stiff = forms.factor["distributed_mass"], forms.factor["elasticity"]
        mass, across, centre = (share * m for m in (own.mass, own.coupling, own.centripetal))
        local = _times(at.own, self.q)
        turned = turning * _times(at.slope, self.q)
        rate = _times(at.own, self.slope) + turned
        first = np.einsum("tij,tj->ti", at.back, self.rigid.first[:, at.placed.indices])
        spun = turning * local
        w = self.speed
        sums["kinetic"] += 0.5 * w**2 * _square(first + rate, mass, spun, across, centre)
        # Accelerations, with gravity but without what acts from outside.
        direct = self._spread(at.direct() - forms.outside.turned(at.own), local)
        sideways = self._spread(at.across(), local)
        towards = self._spread(at.centripetal(), local)
        virtual = first + turned
        work = np.vecdot(virtual, direct @ mass + sideways @ across.T - towards @ centre)
        work += np.vecdot(spun, direct @ across + sideways @ centre - towards @ across)
        forces = self._spread(at.strain(), local) @ own.stiffness
        # Rayleigh's damping knows the rates of the coordinates alone; it turns nothing.
        resisted = forms.factor["rayleigh_stiffness"] * stiff * w * _times(at.own, self.slope)
        passive = resisted @ own.stiffness
        work += np.vecdot(turned, forces - passive)
        work += self._stiffening(at, local, turned, rate, sums)
        weight = at.weight()
        sums["loads"] += w * np.vecdot(first + rate, weight @ mass)
        sums["loads"] += w * np.vecdot(spun, weight @ across)
        # The direct part holds the weight; the drive's own share is what is left without it.
        sums["drive"] += w * work
        elastic = stiff * (local @ own.stiffness)
        sums["dissipated"] += np.vecdot(w * rate, forces - elastic - passive)
        sums["dissipated"] += w * np.vecdot(_times(at.own, self.slope), passive)
        return np.asarray(0.5 * np.vecdot(local, elastic))

    def _stiffening(
        self, at: MovingElement, local: Array, turned: Array, rate: Array, sums: dict[str, Array]
    ) -> Array:
        """Add the energy of the axial forces; return the work that their change asks for."""
        geometric = at.arrays.geometric
        total = np.zeros(len(local))
        for power, forces in self.forms.stiffening.items():
            weights = forces[:, at.number] * self.speed**power
            kernel = np.tensordot(weights, geometric, axes=1)
            pull = np.einsum("tij,tj->ti", kernel, local)
            change = np.vecdot(turned, pull)
            if power in self.changing:
                rates = self.changing[power][:, at.number] * self.speed**power
                slope = np.tensordot(rates, geometric, axes=1)
                change = 0.5 * np.einsum("ti,tij,tj->t", local, slope, local) + change
            energy = 0.5 * np.vecdot(local, pull)
            if power == 0:
                sums["stiffening"] += energy
                total += change
            else:
                # Of inertia: the energy is kinetic, -1/2 td^2 q Kg q, and so is its momentum.
                sums["stiffening"] -= energy
                total -= change + 2.0 * np.vecdot(rate - turned, pull)
        return total

    def _nodes(self, sums: dict[str, Array]) -> None:
        """Add lumped masses, springs, dampers and loads."""
        forms, first, spread = self.forms, self.rigid.first, self.forms.spread.T
        lumped = forms.factor["lumped_mass"] * forms.lumped
        q, rates = self.q @ spread, self.speed * self.slope @ spread
        speeds = self.speed * first + rates
        sums["kinetic"] += 0.5 * speeds**2 @ lumped
        drag = self._spread(forms.outside, self.q) @ spread
        inertia = self._spread(forms.node_inertia(), first) - drag * lumped
        loads = self._spread(forms.node_loads(), first)
        weight = forms.axial.weight_field(forms.theta) * lumped
        sums["drive"] += self.speed * np.vecdot(first, inertia - loads)
        sums["loads"] += np.vecdot(speeds, weight + loads)
        sums["springs"] += 0.5 * q**2 @ forms.springs
        holds = self._spread(forms.node_holds(), first)
        sums["dissipated"] += np.vecdot(rates, holds - q * forms.springs)


def _times(matrices: Array, vectors: Array) -> Array:
    return np.asarray(np.matmul(matrices, vectors[..., None])[..., 0])


def _square(direct: Array, mass: Array, spun: Array, across: Array, centre: Array) -> Array:
    """Return the square of ``N direct + J N spun`` over the mass."""
    plain = np.vecdot(direct @ mass, direct) + np.vecdot(spun @ centre, spun)
    return np.asarray(plain + 2.0 * np.vecdot(direct, spun @ across.T))


@dataclass(frozen=True, kw_only=True)
class BeamEnergies(BeamResult):
    """Energies of a structure of beams in a motion, ``(nt,)`` each but for ``strain``.

    Speed and crank angles: see :class:`BeamResult`.  The error is the largest of the whole strain
    energy [J]: by the error of the motion and, where it was found on a finer mesh too, by that of
    the mesh.
    """

    links: tuple[str, ...]
    strain: Array  # strain energy of each beam [J], (nt, links)
    springs: Array  # energy of springs at nodes [J]
    # Energy that axial forces give to beams which bend [J]: of constant loads a potential, of
    # inertia what the shortening takes from the kinetic energy.
    stiffening: Array
    kinetic: Array  # of the rigid and the elastic motion together [J]
    dissipated: Array  # power that damping takes [W]
    loads: Array  # power of weight and constant loads [W]
    drive: Array  # power of the drive [W]: generalised force of the crank angle times the speed

    arrays_along: ClassVar = {
        "sample link": "strain",
        "sample": " ".join((*_SUMS, "total")),
    }
    exported: ClassVar[tuple[str, ...]] = ("total",)
    column_units: ClassVar = {"J": "error total", "W": "dissipated loads drive"}

    @property
    def total(self) -> Array:
        """Energy of all kinds [J], ``(nt,)``."""
        stored = np.sum(self.strain, axis=1) + self.springs + self.stiffening
        return np.asarray(stored + self.kinetic)

    @property
    def torque(self) -> Array:
        """Torque of the drive [N m]: its power over the speed."""
        return np.asarray(self.drive / self.speed)

    @property
    def peak(self) -> float:
        """Largest strain energy of all beams together over the given angles [J]."""
        return float(np.max(np.sum(self.strain, axis=1)))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the strain energy of each beam and of all over the crank angle."""
        ax = axes_or_new(ax)
        degrees = np.degrees(self.theta)
        for link, values in zip(self.links, self.strain.T, strict=True):
            ax.plot(degrees, values, label=link, linewidth=0.9)
        ax.plot(degrees, np.sum(self.strain, axis=1), "k", label="all", linewidth=0.9)
        ax.set(xlabel="crank angle [deg]", ylabel="strain energy [J]")
        ax.set_title(f"{self.speed:.4g} rad/s", fontsize="medium")
        ax.legend()
        return ax


def beam_energies(system: LinearPeriodic, motion: Motion | float | None = None) -> BeamEnergies:
    """Return the energies of a structure of beams over the cycle.

    The energy holds the squares of the elastic motion; the moment that :func:`pin_reactions` finds
    at the clamp is linear in it.  The two torques differ by these squares.

    Parameters
    ----------
    system, motion
        As :func:`elastolink.recover`.

    Returns
    -------
    BeamEnergies
        Of a periodic motion in the full form the check ``balance`` compares the power of drive and
        loads, less what damping takes, with the rate of the energy, over the largest power: the
        former comes from virtual work, the rate from the Fourier series of the energy.  The
        instantaneous form has no energy that its equation keeps, and no check.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> found = el.recovery.beam_energies(system, 20.0)
    >>> print(abs(found.torque).max().round(1), round(float(found.peak), 4))
    8.5 0.0386
    """
    moving = beam_motion(system, motion)
    structure = required_structure(system)
    joined = _energies(system, moving)
    doubt = partial(_doubt, system, moving, joined["strain"])
    shared = in_motion(system, moving, doubt)
    made = BeamEnergies(
        method="element matrices",
        links=tuple(beam.name for beam in structure.beams),
        **shared,
        **joined,
    )
    if moving.period is not None and system.has("A"):
        shared["checks"]["balance"] = _balance(made, moving)
    return made


def _doubt(system: LinearPeriodic, moving: BeamMotion, strain: Array) -> dict[str, float | str]:
    def change(finer: LinearPeriodic, motion: BeamMotion) -> float:
        better = np.sum(_energies(finer, motion)["strain"], axis=1)
        return float(np.max(np.abs(better - np.sum(strain, axis=1))))

    # What the error of the motion can do to the strain energy.
    error = 0.0
    for chunk in chunks(moving) if np.any(moving.doubt) else ():
        stiffness = system.array("K", moving.theta[chunk])
        force = np.einsum("tij,tj->ti", stiffness, moving.q[chunk])
        error = max(error, float(np.max(np.abs(force) @ moving.doubt)))
    norm = "largest error of the strain energy of all beams [J]"
    return with_mesh(system, moving, norm, error, change)


def _energies(system: LinearPeriodic, motion: BeamMotion) -> dict[str, Any]:
    slopes: Slopes = {}
    if required_structure(system).moving:
        powers = ElementForms(system, np.zeros(1)).stiffening
        slopes = {power: _slope(system, power) for power in powers}
    return over_motion(
        system, motion, lambda forms, values: Energies(forms, values, slopes).by_name()
    )


def _balance(made: BeamEnergies, motion: BeamMotion) -> Check:
    """Return the difference of power and rate of energy over the largest power."""
    count = len(made.theta)
    rate = made.speed * differentiated(made.total, motion.period or 1.0)
    upper = np.abs(np.fft.rfft(rate))
    power = made.drive + made.loads - made.dissipated
    largest = float(np.max(np.abs(power)))
    peaks = np.max(np.abs(motion.q), axis=0)
    relative = float(np.max(motion.doubt / np.where(peaks > 0, peaks, 1.0)))
    # The rate of the highest harmonic enlarges an error of the motion; squares of a motion have
    # twice its harmonics, and those beyond the samples fall upon the upper ones.
    beyond = 4.0 * float(np.sum(upper[count // 3 :])) / count
    # Round-off of energies that are sums of large parts, over the largest power.
    limit = count * relative + beyond / max(largest, np.finfo(float).tiny) + 1e-9
    return Check(float(np.max(np.abs(rate - power))) / largest if largest else 0.0, limit)
