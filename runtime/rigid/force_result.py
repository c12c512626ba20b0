"""The forces of a rigid machine as a result: by name, by joint, as a picture, as a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..core.deferred import DeferredField
from ..core.errors import bad
from ..core.results import BROADCAST, Result
from .blocks import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

JOINTS = ("12", "23", "34", "41")
FRAME_FORCE = ("shaking_x", "shaking_y")
_LATER = DeferredField()


@dataclass(frozen=True, kw_only=True)
class RigidForces(Result):
    """Forces of a rigid machine; every array has the common shape of angles, speeds, accelerations.

    Signs are Smith's (Fig. 11): ``f_ij`` is the force of link i upon link j, the torque acts on the
    crank, anticlockwise positive.  What was not asked for raises :class:`BadInput`.

    ``error`` is worked out when it is looked at, the checks likewise: power balance, the momenta,
    and the statics of each link, at some of the angles.

    Attributes
    ----------
    theta2, speed, acceleration : ndarray
        Crank angle [rad], crank speed [rad/s] and crank acceleration [rad/s^2], as given.
    values : mapping of str to ndarray
        The arrays by name: ``x12`` ... ``y41`` [N], the couple of the sliding joint where there is
        one [N m], ``torque`` [N m], ``shaking_x``, ``shaking_y`` [N], ``shaking_moment`` [N m].
    """

    theta2: Array
    speed: Array
    acceleration: Array
    values: Mapping[str, Array]
    error: Any = _LATER

    dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        (
            *("theta2", "speed", "acceleration", "torque", "error", "couple34", "couple41"),
            *(axis + joint for axis in "xy" for joint in JOINTS),
            *FRAME_FORCE,
            "shaking_moment",
        ),
        BROADCAST,
    )

    def __getitem__(self, name: str) -> Array:
        """Return one array of ``values``.

        Raises
        ------
        BadInput
            If it was not asked for.
        """
        if name not in self.values:
            fix = "ask for it in outputs"
            raise bad("RigidForces", f"no {name}", f"one of {sorted(self.values)}", fix)
        return self.values[name]

    def _pair(self, x: str, y: str) -> Array:
        return np.stack((self[x], self[y]), axis=-1)

    @property
    def f12(self) -> Array:
        """Force of the frame on the crank at A [N], shape (..., 2)."""
        return self._pair("x12", "y12")

    @property
    def f23(self) -> Array:
        """Force of link 2 on link 3 at B [N], shape (..., 2)."""
        return self._pair("x23", "y23")

    @property
    def f34(self) -> Array:
        """Force of link 3 on link 4 [N], shape (..., 2); a quick-return's acts at B."""
        return self._pair("x34", "y34")

    @property
    def f41(self) -> Array:
        """Force of link 4 on the frame [N], shape (..., 2)."""
        return self._pair("x41", "y41")

    @property
    def sliding_couple(self) -> Array:
        """Couple in the sliding joint [N m]: of link 3 on 4 (quick-return), or of 4 on the frame.

        Raises
        ------
        BadInput
            If there is no sliding joint, or the pin forces were not asked for.
        """
        return self["couple34" if "couple34" in self.values else "couple41"]

    @property
    def torque(self) -> Array:
        """Driving torque on the crank [N m]."""
        return self["torque"]

    @property
    def shaking_force(self) -> Array:
        """Force on the frame [N], shape (..., 2); defined in :func:`rigid_forces`."""
        return self._pair(*FRAME_FORCE)

    @property
    def shaking_moment(self) -> Array:
        """Moment on the frame about A [N m]; defined in :func:`rigid_forces`."""
        return self["shaking_moment"]

    def arrays(self) -> dict[str, Array]:
        """Return the numeric fields and the values by name."""
        return {**super().arrays(), **self.values}

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists, numbers and strings, ready for JSON."""
        found = super().to_dict()
        values = found.pop("values")
        return {**found, **values}

    def plot(self, ax: Axes | None = None, joint: str | None = None) -> Axes:
        """Draw a polar diagram (Smith Figs. 12-16), or the torque against the crank angle.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw.
        joint : {"12", "23", "34", "41", "frame", "torque", "moment"}, optional
            The pin force of a joint, the force on the frame, the torque or the moment; by default
            the first of frame, 34, torque, moment that was asked for.

        Raises
        ------
        BadInput
            If the joint is unknown or its force was not asked for.
        """
        from .force_plots import draw

        return draw(self, ax, joint)
