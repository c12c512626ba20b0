"""A quick screen of the stresses: quasi-static ones, harmonic by harmonic, times a factor (9.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..beams.element_forms import required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import is_finite
from ..core.results import Result, provenance
from ..frequencies import natural_frequencies
from ..recovery.stresses import stress_operator
from .effects import positive_row
from .speed_profile import Array

_ANGLES = 256


@dataclass(frozen=True, kw_only=True)
class Screening(Result):
    """Estimated largest stresses over the crank speed.

    ``error`` is NaN: a screen knows no bound of what it leaves out; compare it with the maxima of
    :func:`elastolink.stress_curve`.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Crank speeds [rad/s].
    links : tuple of str
        Links.
    maximum : ndarray, shape (ns, links)
        Estimated largest stress [Pa].
    quasi_static : ndarray, shape (ns, links)
        Largest quasi-static stress [Pa].
    mean_frequency : float
        Mean of the lowest natural frequency over the cycle [rad/s].
    """

    speed: Array
    links: tuple[str, ...]
    maximum: Array
    quasi_static: Array
    mean_frequency: float

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "speed": ("speed",),
        **dict.fromkeys(("maximum", "quasi_static"), ("speed", "link")),
    }


def screen(system: LinearPeriodic, speeds: ArrayLike, *, damping: float) -> Screening:
    """Return estimated largest stresses over crank speeds [rad/s], without solving equations.

    The quasi-static stress is a function of the crank angle times the squared speed, found once,
    and another of the constant loads.  Its n-th harmonic is taken to be carried by the lowest mode
    alone, as a single mass of the mean natural frequency W: it grows by ``1 / (1 - (n w/W)^2 + 2 i
    z n w/W)``, z the damping ratio.  Resonances at W/n are in it, infinite without damping;
    parametric terms and the other modes are not.
    """
    given = positive_row("speeds", speeds, "crank speeds")
    if not (is_finite(damping) and damping >= 0):
        raise bad("damping", repr(damping), "a ratio, 0 or more", "correct it")
    structure = required_structure(system)
    mean = float(natural_frequencies(system, count=1).mean[0])
    theta = system.period * np.arange(_ANGLES) / _ANGLES
    form, stations = stress_operator(system, theta, 7, method="shape")
    stiffness = system.array("K", theta)
    unit, constant = (
        form.values(1.0, still, np.zeros_like(still))
        for still in (
            np.asarray(np.linalg.solve(stiffness, system.array(name, theta)[..., None])[..., 0])
            for name in ("f", "p")
        )
    )
    spectra = np.fft.rfft(unit, axis=0), np.fft.rfft(constant, axis=0)
    links = tuple(beam.name for beam in structure.beams)
    named = np.array([station.beam for station in stations] * 2)
    n = np.arange(len(spectra[0]))
    maximum, static = np.empty((2, len(given), len(links)))
    for i, speed in enumerate(given):
        ratio = n * speed / mean
        below = 1.0 - ratio**2 + 2j * damping * ratio
        still = speed**2 * unit + constant
        static[i] = [np.max(np.abs(still[:, named == link])) for link in links]
        if not np.all(below):
            maximum[i] = np.inf
            continue
        series = (speed**2 * spectra[0] + spectra[1]) / below[:, None]
        history = np.fft.irfft(series, n=_ANGLES, axis=0)
        maximum[i] = [np.max(np.abs(history[:, named == link])) for link in links]
    return Screening(
        method="quasi-static stress times the factor of one mode, by harmonics",
        error=np.nan,
        error_norm="none",
        provenance=provenance(dict(system.provenance)),
        speed=given,
        links=links,
        maximum=maximum,
        quasi_static=static,
        mean_frequency=mean,
    )
