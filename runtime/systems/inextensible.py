"""The inextensible coupler of a four-bar or a slider-crank as a nonlinear system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from ...generated import beam_tangent_harmonics
from ..core.errors import bad
from ..core.families import Array
from ..core.families.linear_periodic import PLACES
from ..core.families.nonlinear import Drive, Equations, Nonlinear, Reduced
from ..core.families.stations import AtStations, Stations
from ..core.modules import find_module
from .driven import Driven, nothing_held
from .from_scene import COUPLER_LIMITS, origin, pull_of_gravity

if TYPE_CHECKING:
    from ..scenes import Scene

_HARMONICS: ModuleType = beam_tangent_harmonics
# Stations of the coupler: with amplitudes up to 0.7 / k^1.5 of the tangent's angle what is left of
# the equations is right to 1e-13 (one mode) to 5e-12 (five).
_LEAST, _PER_MODE = 8, 4
_POSITIVE = ("frame", "crank", "coupler", "follower", "slider_mass")
_LIMITS = {**COUPLER_LIMITS, **dict.fromkeys(_POSITIVE, "positive")}


@lru_cache(maxsize=32)
def coupler_stations(modes: int) -> Stations:
    """Return the stations along a coupler with so many modes, all but its initial bow.

    The tangent ``(cos phi, sin phi)`` is the sum of cosines that passes through the stations, the
    middles of Q equal parts; their integrals are exact.
    """
    count = _LEAST + _PER_MODE * modes
    places = (np.arange(count) + 0.5) / count
    harmonics = np.arange(1.0, count)
    cosines = np.cos(np.pi * np.multiply.outer(np.arange(float(count)), places))
    to_harmonics = cosines * (2.0 / count)
    to_harmonics[0] /= 2.0
    moment, beside_mean, inertia, bending = _HARMONICS.integrals(harmonics)
    place = np.zeros((count, count))  # int (int cos n) (int cos m), of harmonics from 0
    place[0, 0] = 1.0 / 3.0
    place[0, 1:] = place[1:, 0] = beside_mean
    place[1:, 1:] = np.diag(inertia)
    curved, bent = np.zeros_like(place), np.zeros_like(place)
    curved[1:, 1:], bent[1:, 1:] = np.diag(bending), np.diag(inertia)

    def between(kernel: Array) -> Array:
        return np.asarray(to_harmonics.T @ kernel @ to_harmonics)

    numbers = {
        "end": np.full(count, 1.0 / count),
        "moment": np.concatenate([[0.5], moment]) @ to_harmonics,
        "bow": np.zeros(count),
        "inertia": between(place),
        "bending": between(curved),
        "drag": between(bent),
    }
    return Stations(cosines[1 : modes + 1], numbers)


@dataclass(frozen=True)
class InextensibleCoupler:
    """What the geometrically exact equations are made of, beside the emitted module."""

    modes: int  # how many amplitudes q_k of cos(k pi s) the tangent's angle has, beside its mean
    assembly: float  # which closure the linkage takes: 1 or -1

    def stations(self, parameters: Mapping[str, float]) -> Stations:
        """Return the stations of a coupler with its initial bow."""
        stations = coupler_stations(self.modes)
        if bow := parameters["bow"]:
            # A bow b sin(pi s) has the slope (pi b / l3) cos(pi s) at its pins.
            angle = np.pi * bow / parameters["coupler"] * stations.shapes[0]
            stations = Stations(stations.shapes, {**stations.numbers, "bow": angle})
        return stations

    def ends(self, chord: Array, drive: Drive, parameters: Mapping[str, float]) -> Array:
        """Return the follower's angle (or the slider's place) and the coupler's mean angle.

        Those of the rigid linkage whose coupler is as long as the chord of the bent one: ``(2, N)``
        from the chord over the length, ``x + i y`` at no mean angle, ``(N,)``.
        """
        chord = parameters["coupler"] * chord
        pin, length = parameters["crank"] * np.exp(1j * np.asarray(drive.angle)), np.abs(chord)
        if "slider_mass" in parameters:
            rise = parameters["offset"] - pin.imag
            straight = self.assembly * np.sqrt(length**2 - rise**2) + 1j * rise
            driven = pin.real + straight.real
        else:
            across = parameters["frame"] - pin
            square = np.abs(across) ** 2
            along = 0.5 * (1.0 + (length**2 - parameters["follower"] ** 2) / square)
            aside = self.assembly * np.sqrt(length**2 / square - along**2)
            straight = across * (along + 1j * aside)
            driven = np.angle(straight - across)
        return np.stack([driven, np.angle(straight * np.conj(chord))])

    def middle(self, q: Array, parameters: Mapping[str, float]) -> Array:
        """Return the deflection of the coupler's middle from its chord [m]; shape batch."""
        return parameters["coupler"] * self.shape(q, np.array([0.5]))[..., 0]

    def largest(self, q: Array) -> Array:
        """Return the largest deflection from the chord over the coupler's length; shape batch."""
        return np.asarray(np.max(np.abs(self.shape(q, PLACES)), axis=-1))

    def shape(self, q: Array, places: Array) -> Array:
        """Return deflections from the chord over the length at places s, ``(*batch, ns)``."""
        angle = q @ coupler_stations(self.modes).shapes
        x, y = np.cos(angle), np.sin(angle)
        along, across = (part.sum(axis=-1, keepdims=True) for part in (x, y))
        weights = _integrals(angle.shape[-1], tuple(places.tolist()))
        found: Array = (y @ weights * along - x @ weights * across) / np.hypot(along, across)
        return found


@lru_cache(maxsize=64)
def _integrals(count: int, places: tuple[float, ...]) -> Array:
    """Return the integrals from 0 to places s of a function by its values at stations."""
    # Of as many cosines as there are stations in the middles of equal intervals, (count, ns).
    n, middles = np.arange(1.0, count), (np.arange(count) + 0.5) / count
    harmonics = 2.0 / count * np.cos(np.pi * np.multiply.outer(middles, n))
    rise = np.sin(np.pi * np.multiply.outer(n, places)) / (n * np.pi)[:, None]
    whole: Array = np.array(places) / count + harmonics @ rise
    return whole


def inextensible_system(scene: Scene) -> Nonlinear:
    """Return the inextensible coupler of a scene's four-bar or slider-crank.

    The coordinates are the amplitudes of ``cos(k pi s)`` in the angle of the coupler's tangent.
    """
    linkage = scene.mechanism()
    linkage.require_full_turn()
    emitted = find_module(scene.model_spec())
    coupler, modes = scene["coupler"], int(scene.model["modes"])
    own = ("bending_stiffness", "mass_per_length", "damping", "bow")
    parameters = {**linkage.lengths, **{name: coupler[name] for name in own}}
    parameters["gravity_x"], parameters["gravity_y"] = pull_of_gravity(scene)
    if "slider_mass" in emitted.module.PARAMETERS:
        parameters["slider_mass"] = scene["slider"]["mass"]
    else:
        follower = scene["follower"]
        parameters["follower_inertia"] = follower["inertia"]
        if "direction" in scene["gravity"] and "first_moment" not in follower:
            expected, fix = "the follower's, for gravity pulls at it", "add it (0 if balanced)"
            raise bad("follower.first_moment", "nothing", expected, fix)
        parameters["follower_first_moment"] = follower.get("first_moment", 0.0)
    made, module = InextensibleCoupler(modes, linkage.branch), emitted.module
    equations: Equations
    if hasattr(module, "STATIONS"):
        equations = AtStations(module, made.stations, made.ends)
    else:
        driven = Driven(emitted, {"assembly": linkage.branch})
        equations = Reduced(driven, tuple(range(modes)), (), nothing_held)
    return Nonlinear(
        size=modes,
        equations=equations,
        parameters=parameters,
        labels=tuple(f"q{k}" for k in range(1, modes + 1)),
        deflection=made.middle,
        watch=made.largest,
        unit="m",
        limits=_LIMITS,
        provenance={**origin(scene), **emitted.provenance},
    )
