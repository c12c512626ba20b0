"""The inextensible coupler of a four-bar or a slider-crank as a nonlinear system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from ...generated import beam_tangent_harmonics, four_bar_kinematics, slider_crank_kinematics
from ..core.errors import bad
from ..core.families import Array, Constrained
from ..core.families.nonlinear import Drive, Nonlinear, Reduced
from ..core.families.stations import Stations
from ..core.modules import EmittedModule, find_module
from .driven import Given, nothing_held

if TYPE_CHECKING:
    from ..scenes import Scene

_HARMONICS: ModuleType = beam_tangent_harmonics
_FOUR_BAR: ModuleType = four_bar_kinematics
_SLIDER_CRANK: ModuleType = slider_crank_kinematics
# Stations of the coupler: with amplitudes up to 0.7 / k^1.5 of the tangent's angle what is left of
# the equations is right to 1e-13 (one mode) to 5e-12 (five).
_LEAST, _PER_MODE = 8, 4
_LIMITS = {
    **dict.fromkeys(("frame", "crank", "coupler", "follower"), "positive"),
    **dict.fromkeys(("bending_stiffness", "mass_per_length", "slider_mass"), "positive"),
    **dict.fromkeys(("damping", "follower_inertia"), "non-negative"),
}


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
    return Stations(np.ascontiguousarray(cosines[: modes + 1].T), numbers)


@dataclass(frozen=True)
class InextensibleCoupler:
    """What the equations of the coupler are made of; see :class:`.Reduced`.

    Coordinates of the exact equations: the follower's angle (or the slider's place), the mean
    angle of the coupler's tangent, and the amplitudes ``q_k`` of ``cos(k pi s)`` in it, which are
    the free ones.  Those to third order have ``q_k`` alone.

    Attributes
    ----------
    emitted : EmittedModule
        The equations.
    modes : int
        How many amplitudes.
    assembly : float
        Which closure the linkage takes: 1 or -1.
    """

    emitted: EmittedModule
    modes: int
    assembly: float

    @property
    def _module(self) -> ModuleType:
        return self.emitted.module

    @property
    def exact(self) -> bool:
        """Whether the equations hold at any amplitude."""
        return hasattr(self._module, "STATIONS")

    @property
    def equations(self) -> Reduced:
        """The equations in the amplitudes."""
        if self.exact:
            return Reduced(self.constrained, tuple(range(2, self.modes + 2)), (0, 1), self.ends)
        return Reduced(self.constrained, tuple(range(self.modes)), (), nothing_held)

    @cached_property
    def _straight(self) -> Stations:
        return coupler_stations(self.modes)

    def constrained(self, parameters: Mapping[str, float], drive: Drive) -> Constrained:
        """Return the constrained system at numbers and a drive."""
        given = dict(zip(self._module.EXTERNAL, map(Given, drive), strict=True))
        numbers = {**parameters, "assembly": self.assembly}
        values = {name: numbers[name] for name in self._module.PARAMETERS}
        if not self.exact:
            return Constrained.from_module(self._module, values, external=given)
        stations = self._straight
        if bow := parameters["bow"]:
            # A bow b sin(pi s) has the slope (pi b / l3) cos(pi s) at its pins.
            angle = np.pi * bow / parameters["coupler"] * stations.shapes[:, 1]
            stations = Stations(stations.shapes, {**stations.numbers, "bow": angle})
        return Constrained.at_stations(self._module, values, stations, given)

    def ends(self, q: Array, drive: Drive, parameters: Mapping[str, float]) -> Array:
        """Return the follower's angle (or the slider's place) and the coupler's mean angle.

        Those of the rigid linkage whose coupler is as long as the chord of the bent one.
        """
        shapes = self._straight.shapes
        chord = np.mean(np.exp(1j * (q @ shapes[:, 1:].T)), axis=-1)
        given = {name: parameters[name] for name in parameters}
        given["coupler"] = parameters["coupler"] * np.abs(chord)
        angle = np.broadcast_to(np.asarray(drive.angle, dtype=float), chord.shape)
        if "slider_mass" in given:
            lengths = (given[name] for name in ("crank", "coupler", "offset"))
            moved = _SLIDER_CRANK.motion(angle, *lengths, self.assembly)
        else:
            lengths = (given[name] for name in ("frame", "crank", "coupler", "follower"))
            drag_link = float(given["crank"] > given["frame"])
            moved = _FOUR_BAR.motion(angle, *lengths, self.assembly, drag_link)
        return np.stack([moved[1], moved[0] - np.angle(chord)], axis=-1)

    def middle(self, q: Array, parameters: Mapping[str, float]) -> Array:
        """Return the deflection of the coupler's middle from its chord [m]; shape batch."""
        return parameters["coupler"] * self.shape(q, np.array([0.5]))[..., 0]

    def largest(self, q: Array) -> Array:
        """Return the largest deflection from the chord over the coupler's length; shape batch."""
        return np.asarray(np.max(np.abs(self.shape(q, _PLACES)), axis=-1))

    def shape(self, q: Array, places: Array) -> Array:
        """Return deflections from the chord over the length at places s, ``(*batch, ns)``."""
        tangent = np.exp(1j * (q @ self._straight.shapes[:, 1:].T))
        mean = np.mean(tangent, axis=-1, keepdims=True)
        place = tangent @ _integrals(tangent.shape[-1], tuple(places.tolist()))
        return np.asarray(np.imag(place * np.conj(mean)) / np.abs(mean))


_PLACES = np.linspace(0.0, 1.0, 41)


@lru_cache(maxsize=64)
def _integrals(count: int, places: tuple[float, ...]) -> Array:
    """Return the integrals from 0 to places s of a function by its values at stations.

    Of as many cosines as there are stations in the middles of equal intervals, ``(count, ns)``.
    """
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
    direction, pull = scene.get("gravity.direction", None), scene["gravity"]["acceleration"]
    parameters = {
        **linkage.lengths,
        "bending_stiffness": coupler["bending_stiffness"],
        "mass_per_length": coupler["mass_per_length"],
        "damping": coupler["damping"],
        "bow": coupler["bow"],
        "gravity_x": 0.0 if direction is None else pull * np.cos(direction),
        "gravity_y": 0.0 if direction is None else pull * np.sin(direction),
    }
    if "slider_mass" in emitted.module.PARAMETERS:
        parameters["slider_mass"] = scene["slider"]["mass"]
    else:
        follower = scene["follower"]
        parameters["follower_inertia"] = follower["inertia"]
        if direction is not None and "first_moment" not in follower:
            expected, fix = "the follower's, for gravity pulls at it", "add it (0 if balanced)"
            raise bad("follower.first_moment", "nothing", expected, fix)
        parameters["follower_first_moment"] = follower.get("first_moment", 0.0)
    made = InextensibleCoupler(emitted, modes, linkage.branch)
    return Nonlinear(
        size=modes,
        equations=made.equations,
        parameters=parameters,
        labels=tuple(f"q{k}" for k in range(1, modes + 1)),
        deflection=made.middle,
        watch=made.largest,
        unit="m",
        limits=_LIMITS,
        provenance={"scene": scene.name, "scene_digest": scene.digest(), **emitted.provenance},
    )
