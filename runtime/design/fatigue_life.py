"""Fatigue of links in periodic motion: rainflow cycles, Goodman's line, Miner's sum (9.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..core.errors import ElastolinkError, Problem, bad, refuse
from ..core.inputs import number_problems, require_kind
from ..core.maxima import turned_by_parabolas
from ..core.results import Result
from ..core.trigonometric import resampled
from ..recovery.stresses import FIBRES, FINER, StressResult
from .speed_profile import Array


@dataclass(frozen=True, kw_only=True)
class Material:
    """What a material bears under changing stress.

    Parameters
    ----------
    tensile_strength : float
        Ultimate strength [Pa]: the end of Goodman's line.
    endurance_limit : float
        Amplitude [Pa] borne for ever at no mean stress, surface and size accounted for.
    exponent : float
        Basquin's k > 0: life falls with the amplitude to this power.
    knee : float
        Cycles at which the endurance limit is reached.

    Raises
    ------
    BadInput
        If a value is not a positive number, or the limit is above the strength.

    Examples
    --------
    >>> import elastolink as el
    >>> steel = el.Material(tensile_strength=600e6, endurance_limit=200e6, exponent=9.0)
    >>> print(steel.endurance_limit / steel.tensile_strength)
    0.3333333333333333
    """

    tensile_strength: float
    endurance_limit: float
    exponent: float = 9.0
    knee: float = 1e6

    def __post_init__(self) -> None:
        """Check the values."""
        problems = number_problems("Material", vars(self), "positive")
        if not problems and self.endurance_limit >= self.tensile_strength:
            expected = f"less than tensile_strength, {self.tensile_strength:g}"
            found = f"{self.endurance_limit:g}"
            problems.append(Problem("Material.endurance_limit", found, expected, "swap them"))
        refuse(problems)


@dataclass(frozen=True, kw_only=True)
class Fatigue(Result):
    """Fatigue of the outer fibres over the stations of a motion.

    Attributes
    ----------
    speed : float
        Crank speed [rad/s].
    links : tuple of str
        Beam of each station.
    places : ndarray, shape (stations,)
        x over the beam's length.
    amplitude : ndarray, shape (2, stations)
        Largest amplitude of the cycles brought to no mean stress by Goodman's line [Pa], of the
        fibre on the positive and on the negative side; inf where a cycle touches the strength.
    safety : ndarray, shape (2, stations)
        Endurance limit over that amplitude.
    damage : ndarray, shape (2, stations)
        Miner's sum of one revolution.
    """

    speed: float
    links: tuple[str, ...]
    places: Array
    amplitude: Array
    safety: Array
    damage: Array

    arrays_along: ClassVar = {"station": "places", "fibre station": "amplitude safety damage"}
    exported: ClassVar[tuple[str, ...]] = ("revolutions", "hours")
    column_units: ClassVar = {"Pa": "amplitude", "h": "hours"}

    @property
    def revolutions(self) -> float:
        """Life of the worst place in revolutions; inf where every cycle is below the limit."""
        worst = float(np.max(self.damage))
        return 1.0 / worst if worst > 0 else np.inf

    @property
    def hours(self) -> float:
        """Life in hours at the crank speed."""
        return self.revolutions * 2.0 * np.pi / self.speed / 3600.0

    @property
    def worst(self) -> tuple[str, float, str]:
        """Link, place and fibre of the least safety."""
        row, column = np.unravel_index(int(np.argmin(self.safety)), self.safety.shape)
        return self.links[column], float(self.places[column]), FIBRES[row]


def fatigue(stress: StressResult, material: Material) -> Fatigue:
    """Return the fatigue of the links in a periodic motion.

    The cycles of one revolution are counted by rainflow (ASTM E1049, extra ``fatigue``), begun at
    the largest stress, so that a periodic history has closed cycles alone.  Each, with amplitude a
    and mean m, has the amplitude ``a / (1 - m / tensile_strength)`` at no mean stress (Goodman; a
    compressive mean counts as none), and by Basquin a share ``(amplitude/limit)^k / knee`` of the
    life; amplitudes within the endurance limit none.

    Parameters
    ----------
    stress : StressResult
        Of a steady state.
    material : Material
        Strength and endurance.

    Returns
    -------
    Fatigue
        ``error`` is what the stresses' own error, and what may lie between the angles, do to the
        least safety, relative.

    Raises
    ------
    BadInput
        If the motion is not periodic, or its stresses are not finite.
    ElastolinkError
        If the counting library is not installed.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    >>> steel = el.Material(tensile_strength=600e6, endurance_limit=200e6)
    >>> found = el.fatigue(el.stress(system, 20.0), steel)
    >>> print(found.worst, found.safety.min().round(2))
    ('crank', 0.0, 'negative') 4.62
    """
    require_kind("fatigue stress", stress, StressResult, "make one with stress")
    require_kind("fatigue material", material, Material, "make one")
    if stress.period is None:
        fix = "take the stress of a steady state"
        raise bad("fatigue", "a motion that is not periodic", "a periodic one", fix)
    doubt = float(stress.error)
    amplitude = np.zeros((2, len(stress.places)))
    worse, damage = np.zeros_like(amplitude), np.zeros_like(amplitude)
    for row, fibre in enumerate(FIBRES):
        history = stress.fibre(fibre)
        fine = resampled(history, FINER * len(history))
        if not np.all(np.isfinite(fine)):
            fix = "choose a speed with a single periodic motion"
            raise bad("fatigue", "stresses that are not finite", "finite ones", fix)
        around = (np.roll(fine, shift, axis=0) for shift in (2, 1, 0, -1, -2))
        topped, missed = turned_by_parabolas(*around)
        off = doubt + np.max(missed, axis=0)
        for column, own in enumerate(topped.T):
            size, mean, counts = _cycles(own)
            equivalent = _equivalent(size, mean, material)
            # Both the amplitude and the mean may be larger by the stresses' error.
            beyond = _equivalent(size + 2.0 * off[column], mean + off[column], material)
            amplitude[row, column] = np.max(equivalent, initial=0.0)
            worse[row, column] = np.max(beyond, initial=0.0)
            damage[row, column] = _damage(equivalent, counts, material)
    with np.errstate(divide="ignore"):
        safety = material.endurance_limit / amplitude
    largest = float(np.max(amplitude))
    known = 0 < largest < np.inf
    return Fatigue(
        method="rainflow, Goodman, Basquin and Miner",
        error=float(np.max(worse)) / largest - 1.0 if known else np.inf,
        error_norm="least safety, relative",
        checks=dict(stress.checks),
        provenance=dict(stress.provenance),
        speed=stress.speed,
        links=stress.links,
        places=stress.places,
        amplitude=amplitude,
        safety=safety,
        damage=damage,
    )


def _cycles(history: Array) -> tuple[Array, Array, Array]:
    try:
        import rainflow
    except ImportError:
        raise ElastolinkError(
            "fatigue: rainflow is not installed; pip install 'elastolink[fatigue]'"
        ) from None
    start = int(np.argmax(history))
    closed = np.concatenate([history[start:], history[: start + 1]])
    cycles = [cycle[:3] for cycle in rainflow.extract_cycles(closed)]
    size, mean, count = np.array(cycles, dtype=float).reshape(-1, 3).T
    return size, mean, count


def _equivalent(size: Array, mean: Array, material: Material) -> Array:
    """Return amplitudes at no mean stress of cycles of some range and mean."""
    room = 1.0 - np.maximum(mean, 0.0) / material.tensile_strength
    amplitude = np.where(room > 0, size / 2.0 / np.where(room > 0, room, 1.0), np.inf)
    return np.where(size > 0, amplitude, 0.0)


def _damage(amplitude: Array, counts: Array, material: Material) -> float:
    beyond = amplitude > material.endurance_limit
    ratio = amplitude[beyond] / material.endurance_limit
    with np.errstate(over="ignore"):
        return float(np.sum(counts[beyond] * ratio**material.exponent) / material.knee)
