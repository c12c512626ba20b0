"""Smith's linkages and rigs as the gallery uses them: end-load functions, Hill equations, units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..hill import HillForm, hill_boundaries, hill_form
from ..linkages import FourBar
from ..scenes import load_scene
from .registry import contents

Array = NDArray[np.float64]

RPM = pi / 30.0
# 1 lbf in s^2 in kg m^2, from the exact pound, standard gravity and the exact inch.
LBF_IN_S2 = 0.45359237 * 9.80665 * 0.0254
# The linkages that the thesis names by their proportions, and their scenes.
PROPORTIONS: Mapping[str, str] = contents("smith")["proportions"]
EQUATIONS = ("reduced", "printed", "complete")


def end_load(linkage: FourBar, theta: ArrayLike) -> dict[str, Array]:
    """Return the functions of the coupler equation at crank angles [rad], by name.

    phi, f1, f2, f3 as defined under Smith (6.17), and ``cos23``, the cosine of theta2 - theta3: the
    shape of the tension that (6.17) leaves out.
    """
    motion = linkage.motion(theta)
    between = motion.theta3 - motion.theta4
    crank = motion.theta2 - motion.theta3
    return {
        "phi": motion.omega3**2,
        "f1": -motion.alpha3 / np.tan(between),
        "f2": np.sin(crank) / np.tan(between),
        "f3": -motion.alpha4 / np.sin(between),
        "cos23": np.cos(crank),
    }


def linkage_of(proportions: str) -> FourBar:
    """Return the linkage that the thesis names by its proportions."""
    return four_bar_of(PROPORTIONS[proportions])


def four_bar_of(scene: str) -> FourBar:
    """Return the four-bar linkage of a built-in scene; another one is refused."""
    linkage = load_scene(scene).mechanism()
    if not isinstance(linkage, FourBar):
        raise bad(f"scene {scene}", type(linkage).__name__, "a four-bar linkage", "choose another")
    return linkage


@lru_cache(maxsize=16)
def series(linkage: FourBar, name: str = "f3") -> PeriodicFunction:
    """Return the Fourier series of one of the functions of :func:`end_load`."""
    return PeriodicFunction.from_callable(lambda theta: end_load(linkage, theta)[name])


@dataclass(frozen=True)
class Rig:
    """One linkage and coupler of chapter 9: scene, proportions, thickness, number of the chart."""

    scene: str
    linkage: str
    thickness: str
    figure: str

    @property
    def name(self) -> str:
        """Linkage and coupler in a few words."""
        return f"{self.linkage}, {self.thickness} in"

    @property
    def frequency(self) -> float:
        """Natural frequency of the coupler [rad/s]."""
        return float(load_scene(self.scene)["coupler"]["natural_frequency"])

    @property
    def inertias(self) -> Array:
        """The eight measured follower inertias [kg m^2]."""
        return np.array(load_scene(self.scene).get("measured.follower_inertias"))

    @property
    def decrements(self) -> tuple[float, float, float]:
        """The least, the middle and the greatest logarithmic decrement measured at rest."""
        least, most = load_scene(self.scene).get("measured.log_decrement")
        return float(least), 0.5 * float(least + most), float(most)

    def system(
        self,
        equation: str = "complete",
        modes: int = 1,
        decrement: float = 0.0,
        inertia: float | None = None,
    ) -> LinearPeriodic:
        """Return the coupler's vibration by one of the :data:`EQUATIONS`.

        With a logarithmic decrement, and the follower's inertia [lbf in s^2] or the scene's.
        """
        return _system(self.scene, equation, modes, decrement, inertia)

    def function(self, equation: str, inertia: float | None = None) -> PeriodicFunction:
        """Return the periodic coefficient at a follower inertia [kg m^2], or the scene's."""
        changes = {} if inertia is None else {"follower_inertia": inertia}
        return _form(self.scene, equation).function(1.0, **changes)

    def ends(self, equation: str, inertia: ArrayLike, regions: tuple[int, ...]) -> Array:
        """Return the crank speeds [rad/s] that bound unstable regions of the first mode.

        By one of the :data:`EQUATIONS`, at follower inertias [kg m^2] ``(k,)``; region n starts at
        the speed 2 Omega / n.  Lower and upper speeds ``(2, len(regions), k)``, infinite where
        lambda^2 would be negative.
        """
        values = np.atleast_1d(np.asarray(inertia, dtype=float))
        if equation == "reduced":
            # Its coefficient is proportional to the inertia.
            bounds = hill_boundaries(self.function(equation, 1.0), values, regions)
            lam2 = np.stack([bounds.upper, bounds.lower])
        else:
            each = [hill_boundaries(self.function(equation, v), 1.0, regions) for v in values]
            upper = np.stack([one.upper for one in each], axis=-1)
            lam2 = np.stack([upper, np.stack([one.lower for one in each], axis=-1)])
        positive = lam2 > 0.0
        roots = np.sqrt(np.where(positive, lam2, 1.0))
        return np.asarray(np.where(positive, self.frequency / roots, np.inf))


RIGS = tuple(Rig(**row) for row in contents("smith")["rig"])
RIG: Mapping[str, Rig] = {rig.figure: rig for rig in RIGS}


@dataclass(frozen=True)
class OfRig:
    """What was observed with a rig, known by the number of its chart."""

    chart: str

    @property
    def rig(self) -> Rig:
        """The linkage and coupler."""
        return RIG[self.chart]


@lru_cache(maxsize=64)
def _system(
    scene: str, equation: str, modes: int, decrement: float = 0.0, inertia: float | None = None
) -> LinearPeriodic:
    changes = {"model.formulation": equation, "model.modes": modes}
    if decrement:
        changes["coupler.damping_ratio"] = decrement / (2 * pi)
    if inertia is not None:
        changes["follower.inertia"] = inertia * LBF_IN_S2
    return load_scene(scene, overrides=changes).linear_system()


@lru_cache(maxsize=64)
def _form(scene: str, equation: str) -> HillForm:
    return hill_form(_system(scene, equation, 1))


def region_name(n: int) -> str:
    """Return the speed at which region n starts, as the thesis writes it."""
    if n == 2:
        return "Ω"
    return f"Ω/{n // 2}" if n % 2 == 0 else f"2Ω/{n}"
