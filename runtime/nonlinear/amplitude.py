"""How the frequency of a flexible coupler depends on its amplitude, the crank held still."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from ...derive.spec import INEXTENSIBLE
from ...generated import beam_amplitude_law
from ..core.errors import bad
from ..core.families import Array
from ..core.inputs import numbers, require_kind, require_whole
from ..core.results import Result, provenance
from ..scenes import Scene

if TYPE_CHECKING:
    from ..linkages.four_bar import FourBarMotion
    from ..linkages.slider_crank import SliderCrankMotion

_LAW: ModuleType = beam_amplitude_law
# Round-offs of the sums in the law: a dozen operations on terms four times as large as their sum.
_ROUND_OFFS = 40.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class AmplitudeLaw(Result):
    """``omega = frequency (1 + coefficient (A/length)^2 + ...)`` at crank angles, entry by entry.

    Attributes
    ----------
    theta, transmission_angle : ndarray
        Crank angle and transmission angle [rad].
    coefficient : ndarray
        Negative where the coupler softens; ``error`` is its absolute error.
    frequency : float
        Natural frequency of small vibrations [rad/s], the same at all crank angles.
    length : float
        Length of the coupler [m].
    mode, modes : int
        Number of the mode, from 1, and of all that are taken into account.
    """

    theta: Array
    transmission_angle: Array
    coefficient: Array
    frequency: float
    length: float
    mode: int
    modes: int

    arrays_along: ClassVar = {"angle": "theta transmission_angle coefficient error"}
    column_units: ClassVar = {"m": "length"}

    def at(self, amplitude: ArrayLike) -> Array:
        """Return the frequency [rad/s] at amplitudes of the mode's deflection [m]."""
        part = np.asarray(amplitude, dtype=float) / self.length
        return np.asarray(self.frequency * (1.0 + self.coefficient * part**2))


def amplitude_law(
    scene: Scene, theta: ArrayLike, mode: int = 1, modes: int | None = None
) -> AmplitudeLaw:
    """Return the first coefficient by which a coupler's frequency falls with the amplitude.

    Exact for the inextensible coupler: a bent coupler is shorter, and moves follower and chord.
    Both have their inertia; the more the further the transmission angle is from a right one, where
    the other modes, which follow at twice the frequency, do not count.

    Parameters
    ----------
    scene : Scene
        A four-bar or slider-crank of formulation ``inextensible`` or ``inextensible_cubic``.
    theta : array_like
        Crank angles [rad], any shape.
    mode : int
        Number of the mode, from 1.
    modes : int, optional
        How many modes the coupler has; by default as many as the scene says, and the one wanted.

    Returns
    -------
    AmplitudeLaw

    Raises
    ------
    BadInput
        If an argument is unusable, or the linkage cannot reach an angle or folds there.

    Examples
    --------
    >>> import elastolink as el
    >>> changes = {"model.formulation": "inextensible"}
    >>> scene = el.load_scene("smith_1972_5152_sixteenth_inch", changes)
    >>> law = el.nonlinear.amplitude_law(scene, theta=[0.0, 1.0])
    >>> print(law.frequency.round(2), law.coefficient.round(2))
    163.36 [-21.22 -14.93]
    """
    require_kind("scene", scene, Scene, "take what load_scene returns")
    if scene.model["formulation"] not in INEXTENSIBLE:
        found = f"formulation '{scene.model['formulation']}'"
        fix = "set model.formulation = 'inextensible'"
        raise bad(f"scene {scene.name}", found, f"one of {INEXTENSIBLE}", fix)
    require_whole("mode", mode, 1, 1000)
    count = max(mode, int(scene.model["modes"])) if modes is None else modes
    require_whole("modes", count, mode, 1000)
    linkage, coupler = scene.mechanism(), scene["coupler"]
    motion = cast("FourBarMotion | SliderCrankMotion", linkage.motion(numbers("theta", theta)))
    length, density = linkage.lengths["coupler"], coupler["mass_per_length"]
    if "slider" in scene.tables:
        driven = scene["slider"]["mass"]
    else:
        driven = scene["follower"]["inertia"] / linkage.lengths["follower"] ** 2
    angle = np.asarray(motion.transmission_angle)
    others = np.array([m for m in range(1, count + 1) if m != mode], dtype=float)
    alone, slope, beside, beside_slope = _LAW.coefficients(
        angle[..., None], float(mode), others, driven / (density * length)
    )
    size = np.abs(alone[..., 0]) + np.sum(np.abs(beside), axis=-1)
    slopes = slope[..., 0] + np.sum(beside_slope, axis=-1)
    return AmplitudeLaw(
        theta=motion.theta2,
        transmission_angle=angle,
        coefficient=alone[..., 0] + np.sum(beside, axis=-1),
        frequency=(mode * np.pi / length) ** 2 * np.sqrt(coupler["bending_stiffness"] / density),
        length=length,
        mode=mode,
        modes=count,
        method="closed form",
        # Twice the first order: enough until the angle's error is a third of its sine.
        error=_ROUND_OFFS * size + 2.0 * np.abs(slopes) * motion.errors["transmission_angle"],
        error_norm="coefficient, absolute, entrywise",
        provenance=provenance({"scene": scene.name, "scene_digest": scene.digest()}),
    )
