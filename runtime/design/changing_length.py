"""Arrays of a structure of beams while a length of its ground changes in time.

Between the levels of the length at which the structure is made the arrays are cubic polynomials of
it.  Straight lines would not do: halfway between two directions of a link the mean of its stiffness
matrices holds it across as a spring of a part of its axial stiffness would.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ..beams.assembly import products
from ..beams.element_forms import required_structure
from ..core.errors import bad
from ..core.families import LinearPeriodic
from .speed_profile import Array, SpeedProfile
from .unsteady import Drive, arrays_of

# Levels whose cubic holds between the middle two, or beside the ends.
_STENCIL = 4

ByName = Mapping[str, Array]
Places = NDArray[np.intp]


class ChangingLength:
    """A structure at even levels of a length that changes, four or more, and what is between.

    The length is one of the ground, so that no beam's own changes; the crank turns at every level.
    """

    def __init__(
        self, system: LinearPeriodic, profile: SpeedProfile, name: str, count: int
    ) -> None:
        values = profile.geometry[name]
        self.profile, self.name = profile, name
        self.places = np.linspace(min(values), max(values), count)
        self.made = [system.with_geometry(**{name: float(place)}) for place in self.places]
        own = [placed.length for placed in required_structure(system).elements]
        for one in (self.made[0], self.made[-1]):
            lengths = [placed.length for placed in required_structure(one).elements]
            if not np.allclose(lengths, own, rtol=1e-12, atol=0.0):
                fix = "change one of the ground, such as frame"
                found = f"{name}, the length of a beam"
                raise bad("profile.geometry", found, "a length that no beam has", fix)

    def arrays(self, drive: Drive, time: Array) -> dict[str, Array]:
        """Return the arrays of the system at points of time, by name."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            return arrays_of(
                system, Drive(drive.angle[own], drive.speed[own], drive.acceleration[own])
            )

        return self._between(time, find)

    def directions(self, angle: Array, time: Array) -> dict[str, Array]:
        """Return cosine and sine of each link's angle, ``(nt, 2)`` by link."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            motion = required_structure(system).configuration(angle[own])
            return {link: products(each.angle)[:, 1:3] for link, each in motion.items()}

        return self._between(time, find)

    def deflections(self, angle: Array, time: Array) -> Array:
        """Return the rows of the deflections over the links' lengths, ``(nt, k, n)``."""

        def find(system: LinearPeriodic, own: Places) -> ByName:
            return {"rows": np.asarray(system.deflection_rows(angle[own]))}

        return self._between(time, find)["rows"]

    def _between(
        self, time: Array, find: Callable[[LinearPeriodic, Places], ByName]
    ) -> dict[str, Array]:
        """Return what is found at the levels about each point of time, by Lagrange's cubic."""
        places = self.places
        at = np.clip(self.profile.lengths(self.name, time), places[0], places[-1])
        position = (at - places[0]) / (places[1] - places[0])
        first = np.clip(position.astype(int) - 1, 0, len(places) - _STENCIL)
        weights = _cubic(position - first)
        total: dict[str, Array] = {}
        for k in range(int(np.min(first)), int(np.max(first)) + _STENCIL):
            own = np.flatnonzero((first <= k) & (k < first + _STENCIL))
            if not own.size:
                continue
            weight = weights[own, k - first[own]]
            for name, value in find(self.made[k], own).items():
                if name not in total:
                    total[name] = np.zeros((len(time), *value.shape[1:]))
                total[name][own] += value * weight.reshape(-1, *(1,) * (value.ndim - 1))
        return total


def _cubic(place: Array) -> Array:
    """Return the weights of values at 0, 1, 2, 3 for a place between, ``(nt, 4)``."""
    nodes = np.arange(_STENCIL, dtype=float)
    weights = np.ones((len(place), _STENCIL))
    for i in range(_STENCIL):
        for j in range(_STENCIL):
            if i != j:
                weights[:, i] *= (place - nodes[j]) / (nodes[i] - nodes[j])
    return weights
