"""The flexible coupler of a four-bar linkage: from a scene to its system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array, LinearPeriodic
from .assembly import assemble
from .modules import find_module

if TYPE_CHECKING:
    from ..scenes import Scene


def coupler_system(scene: Scene) -> LinearPeriodic:
    """Return the transverse vibration of the coupler (Smith 6.6, corrected; 6.17; 6.18).

    The coordinates are ``Y_m / l3``; the parameters are those of the emitted module.

    Parameters
    ----------
    scene : Scene
        With mechanism ``four_bar`` and flexible ``coupler``.

    Raises
    ------
    BadInput
        If the crank cannot turn fully, or no module was emitted for the scene's model.
    """
    linkage = scene.mechanism()
    linkage.require_full_turn()
    emitted = find_module(scene.model_spec())
    coupler = scene["coupler"]
    parameters = {
        "bending_stiffness": coupler["bending_stiffness"],
        "mass_per_length": coupler["mass_per_length"],
        "damping": coupler["damping"],
        "coupler_inertia": coupler["inertia"],
        "coupler_first_moment": coupler["first_moment"],
        "follower_inertia": scene["follower"]["inertia"],
    }
    modes = int(scene.model["modes"])
    return assemble(
        emitted.module,
        geometry={**linkage.lengths, "assembly": linkage.branch},
        parameters=parameters,
        modes=modes,
        labels=tuple(f"Y{m}/l3" for m in range(1, modes + 1)),
        reference_length=linkage.lengths["coupler"],
        shape=PinnedModes(modes),
        provenance={"scene": scene.name, "scene_digest": scene.digest(), **emitted.provenance},
    )


@dataclass(frozen=True)
class PinnedModes:
    """Mode shapes ``sin(m pi x / l)`` of a pinned beam, as a function of x over length.

    Attributes
    ----------
    modes : int
        How many.
    """

    modes: int

    def __call__(self, x: Array) -> Array:
        """Return the shapes at ``x`` of shape ``(nx,)`` as an array ``(nx, modes)``."""
        m = np.arange(1, self.modes + 1)
        return np.asarray(np.sin(np.pi * np.multiply.outer(np.asarray(x, dtype=float), m)))
