"""Energies of a structure of beams over the cycle, and their balance (Aannaque Fig. 7.6)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..core.deferred import DeferredGroup
from ..core.families import LinearPeriodic
from ..core.results import Check
from .assembly import Array
from .beam_motion import BeamMotion, beam_motion, chunks
from .beam_result import BeamResult, in_motion
from .element_forms import required_structure
from .energy_terms import Energies, force_slopes
from .finer_mesh import CAUTION, on_finer_mesh
from .motion_forms import over_motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .beam_motion import Motion

# Round-off of energies that are sums of large parts, over the largest power.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class BeamEnergies(BeamResult):
    """Energies of a structure of beams in a motion.

    Speed and crank angles: see :class:`BeamResult`.

    Attributes
    ----------
    links : tuple of str
        The beams.
    strain : ndarray
        Strain energy of each beam [J], shape ``(nt, links)``.
    springs : ndarray
        Energy of springs at nodes [J], ``(nt,)``.
    stiffening : ndarray
        Energy that axial forces give to beams which bend [J]: of constant loads a potential, of
        inertia what the shortening takes from the kinetic energy.
    kinetic : ndarray
        Kinetic energy [J] of the rigid and the elastic motion together.
    dissipated : ndarray
        Power that damping takes [W].
    loads : ndarray
        Power of weight and constant loads [W].
    drive : ndarray
        Power of the drive [W]: the generalised force of the crank angle times the speed.
    error : float
        Largest error of the whole strain energy [J]: by the error of the motion and, where it was
        found on a finer mesh too, by that of the mesh.
    """

    links: tuple[str, ...]
    strain: Array
    springs: Array
    stiffening: Array
    kinetic: Array
    dissipated: Array
    loads: Array
    drive: Array

    dimensions: ClassVar[dict[str, tuple[str, ...]]] = {
        **BeamResult.dimensions,
        "strain": ("sample", "link"),
        **dict.fromkeys(
            ("springs", "stiffening", "kinetic", "dissipated", "loads", "drive", "total"),
            ("sample",),
        ),
    }
    exported: ClassVar[tuple[str, ...]] = ("total",)

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
        from ..core.plotting import axes_or_new

        ax = axes_or_new(ax)
        degrees = np.degrees(self.theta)
        for link, values in zip(self.links, self.strain.T, strict=True):
            ax.plot(degrees, values, label=link, linewidth=0.9)
        ax.plot(degrees, np.sum(self.strain, axis=1), "k", label="all", linewidth=0.9)
        ax.set_xlabel("crank angle [deg]")
        ax.set_ylabel("strain energy [J]")
        ax.set_title(f"{self.speed:.4g} rad/s", fontsize="medium")
        ax.legend()
        return ax


def beam_energies(
    system: LinearPeriodic, motion: Motion | float | None = None, *, finer_mesh: bool = True
) -> BeamEnergies:
    """Return the energies of a structure of beams over the cycle.

    Parameters
    ----------
    system : LinearPeriodic
        Of a structure of beams.
    motion : SteadyState, Trajectory, BeamMotion, float or None
        A computed motion; a crank speed [rad/s], for the steady state there; None for a frame.
    finer_mesh : bool
        Whether the error of the mesh is told by a finer one, as :func:`stress` does.

    Returns
    -------
    BeamEnergies
        Of a periodic motion in the full form its check ``balance`` compares the power of drive and
        loads, less what damping takes, with the rate of the energy, over the largest power.  The
        power of the drive comes from virtual work, the rate from the Fourier series of the energy.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Notes
    -----
    The energy holds the squares of the elastic motion; the moment that :func:`pin_reactions`
    finds at the clamp is linear in it.  The two torques differ by these squares.

    The instantaneous form has no energy that its equation keeps, and no check.
    """
    moving = beam_motion(system, motion)
    structure = required_structure(system)
    joined = _energies(system, moving)
    doubt = DeferredGroup(partial(_doubt, system, moving, joined["strain"], finer_mesh))
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


def _doubt(
    system: LinearPeriodic, moving: BeamMotion, strain: Array, finer_mesh: bool
) -> dict[str, float | str]:
    """Return the error figure and its norm."""
    error, norm = _figure(system, moving), "largest error of the strain energy of all beams [J]"
    finer = on_finer_mesh(system, moving) if finer_mesh else None
    if finer is None:
        norm = f"{norm}, by that of the motion; the mesh apart"
    else:
        both = [np.sum(own, axis=1) for own in (strain, _energies(*finer)["strain"])]
        error += CAUTION * float(np.max(np.abs(both[1] - both[0])))
    return {"error": error, "error_norm": norm}


def _energies(system: LinearPeriodic, motion: BeamMotion) -> dict[str, Any]:
    """Return the energies and powers of a motion by name."""
    slopes = force_slopes(system)
    return over_motion(
        system, motion, lambda forms, values: Energies(forms, values, slopes).found()
    )


def _balance(made: BeamEnergies, motion: BeamMotion) -> Check:
    """Return the difference of power and rate of energy over the largest power."""
    count = len(made.theta)
    waves = np.arange(count // 2 + 1) * (2j * np.pi / (motion.period or 1.0))
    if count % 2 == 0:
        waves[-1] = 0.0
    spectrum = made.speed * waves * np.fft.rfft(made.total)
    rate = np.fft.irfft(spectrum, n=count)
    power = made.drive + made.loads - made.dissipated
    largest = float(np.max(np.abs(power)))
    peaks = np.max(np.abs(motion.q), axis=0)
    relative = float(np.max(motion.doubt / np.where(peaks > 0, peaks, 1.0)))
    # The rate of the highest harmonic enlarges an error of the motion; squares of a motion have
    # twice its harmonics, and those beyond the samples fall upon the upper ones.
    beyond = 4.0 * float(np.sum(np.abs(spectrum[count // 3 :]))) / count
    limit = count * relative + beyond / max(largest, np.finfo(float).tiny) + _ROUNDING
    return Check(float(np.max(np.abs(rate - power))) / largest if largest else 0.0, limit)


def _figure(system: LinearPeriodic, motion: BeamMotion) -> float:
    """Return what the error of the motion can do to the strain energy [J]."""
    if not np.any(motion.doubt):
        return 0.0
    largest = 0.0
    for chunk in chunks(motion):
        stiffness = system.array("K", motion.theta[chunk])
        force = np.einsum("tij,tj->ti", stiffness, motion.q[chunk])
        largest = max(largest, float(np.max(np.abs(force) @ motion.doubt)))
    return largest
