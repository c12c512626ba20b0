"""Results of a structure of beams in one motion, and its forms along that motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..beams.assembly import Array
from ..beams.element_forms import ElementForms
from ..beams.recovery_forms import LinearForm
from ..core.errors import LINEAR_RANGE, warn_of_large_deflection
from ..core.families import LinearPeriodic
from ..core.inputs import require_one_of
from ..core.results import Check, DeferredField, DeferredGroup, Result, provenance
from .beam_motion import BeamMotion, chunks

# Fields that are computed when they are first looked at.
_LATER = {name: DeferredField() for name in ("error", "error_norm")}


@dataclass(frozen=True, kw_only=True)
class BeamResult(Result):
    """Base of what is found of a structure of beams in one motion.

    The error estimate is computed when it is first looked at.
    """

    speed: float  # crank speed [rad/s]
    theta: Array  # crank angles [rad], (nt,)
    error: Any = _LATER["error"]
    error_norm: Any = _LATER["error_norm"]  # str

    arrays_along: ClassVar = {"sample": "theta"}


@dataclass(frozen=True, kw_only=True)
class StationResult(BeamResult):
    """Base of what is found at stations along the beams."""

    links: tuple[str, ...]  # beam of each station
    places: Array  # x over the beam's length of each station, (stations,)

    arrays_along: ClassVar = {"station": "places"}


def stations_on(links: tuple[str, ...], link: str) -> NDArray[np.int64]:
    """Return the places of a beam's stations among all; refuse a beam that has none."""
    require_one_of("link", link, dict.fromkeys(links), "choose one with stations")
    return np.flatnonzero(np.array(links) == link).astype(np.int64)


def in_motion(
    system: LinearPeriodic,
    motion: BeamMotion,
    doubt: Callable[[], Mapping[str, Any]],
    checks: Mapping[str, Check] | None = None,
    later: tuple[str, ...] = (),
) -> dict[str, Any]:
    """Return the fields of :class:`BeamResult`, all but the method.

    The error, its norm and those named in ``later`` come from ``doubt()`` when they are first
    looked at.  Warns whoever called the caller where a deflection is beyond 5 % of the length of
    its beam.
    """
    found = {**motion.checks, **(checks or {})}
    parts = [system.largest_deflection(motion.theta[c], motion.q[None, c]) for c in chunks(motion)]
    sizes = [size for size in parts if size is not None]
    if sizes:
        found["linear range"] = Check(max(sizes), LINEAR_RANGE)
        fix = "lower the speed or stiffen the beams"
        warn_of_large_deflection(max(sizes), "the length of its beam", fix, stacklevel=4)
    group = DeferredGroup(doubt)
    return {
        **group.fields(("error", "error_norm", *later)),
        "checks": found,
        "provenance": provenance({**system.provenance, **motion.provenance}),
        "speed": motion.speed,
        "theta": motion.theta,
    }


class MotionValues:
    """Values of forms in a piece of a motion, accelerations by the equation of motion."""

    def __init__(self, forms: ElementForms, motion: BeamMotion, chunk: slice) -> None:
        self.speed = motion.speed
        self.q, self.slope = motion.q[chunk], motion.slope[chunk]
        self.second = np.zeros_like(self.q)
        if not motion.frozen:
            second = forms.acceleration.values(self.speed, self.q, self.slope)
            self.second = second / self.speed**2

    def __call__(self, form: LinearForm) -> Array:
        """Return the rows of a form ``(nt, rows)``."""
        return form.values(self.speed, self.q, self.slope, self.second)


def checked_forms(system: LinearPeriodic, theta: Array) -> ElementForms:
    """Return the elements of a system at crank angles, its terms being those of its structure."""
    forms = ElementForms(system, theta)
    forms.require_same()
    return forms


def over_motion(
    system: LinearPeriodic,
    motion: BeamMotion,
    piece: Callable[[ElementForms, MotionValues], dict[str, Array]],
) -> dict[str, Array]:
    """Return arrays over the angles of a motion by name, joined from its pieces."""
    pieces = []
    for chunk in chunks(motion):
        forms = checked_forms(system, motion.theta[chunk])
        pieces.append(piece(forms, MotionValues(forms, motion, chunk)))
    return {name: np.concatenate([found[name] for found in pieces]) for name in pieces[0]}
