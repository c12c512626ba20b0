"""The free-free rod of a quick-return in coordinates without constraints: its modes alone.

An oracle: the constrained equations, reduced at run time, for response curves of the rod.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from elastolink import QuickReturn
from elastolink.runtime.core.families import Array, Constrained, Drive, Nonlinear
from elastolink.runtime.core.families.nonlinear import Reduced
from elastolink.runtime.systems.rod.floating import FreeFreeRod, rod_equations
from elastolink.runtime.systems.rod.free_free import FreeFreeModes


@dataclass(frozen=True)
class DrivenRod:
    """Makes the constrained system of a rod at numbers and a drive of steady speed."""

    modes: FreeFreeModes

    def __call__(self, parameters: Mapping[str, float], drive: Drive) -> Constrained:
        """Return the system; its equations hold at a steady speed."""
        speed = float(np.ravel(drive.speed)[0])
        assert not np.any(drive.acceleration)
        assert np.all(np.asarray(drive.speed) == speed)
        return rod_equations(self.modes, _linkage(parameters), speed, parameters, ())

    def undeformed(self, q: Array, drive: Drive, parameters: Mapping[str, float]) -> Array:
        """Return mean position and direction of the undeformed rod, ``(*batch, 3)``."""
        angle = _linkage(parameters).motion(np.asarray(drive.angle, dtype=float)).theta4
        half = parameters["length"] / 2.0
        return np.stack([half * np.cos(angle), half * np.sin(angle), angle], axis=-1)


def _linkage(parameters: Mapping[str, float]) -> QuickReturn:
    frame = parameters["frame"]
    crank = parameters["crank_ratio"] * frame
    return QuickReturn(frame=frame, crank=crank, rod=parameters["length"])


def driven_rod(rod: FreeFreeRod) -> Nonlinear:
    """Return a free-free rod as a nonlinear system of its modes (Beale & Scott (29)-(49)).

    Pin and block determine the mean position and direction of the rod, which go.  Without damping,
    as the constrained equations are.
    """
    linkage, made = rod.linkage, DrivenRod(rod.modes)
    count = rod.modes.size
    return Nonlinear(
        size=count,
        equations=Reduced(made, tuple(range(3, count + 3)), (0, 1, 2), made.undeformed),
        parameters={
            "crank_ratio": linkage.crank / linkage.frame,
            "frame": linkage.frame,
            "length": linkage.rod,
            "bending_stiffness": rod.bending_stiffness,
            "mass_per_length": rod.mass_per_length,
        },
        labels=rod.labels[3:],
        limits=dict.fromkeys(
            ("crank_ratio", "frame", "length", "bending_stiffness", "mass_per_length"), "positive"
        ),
        provenance=dict(rod.provenance),
    )
