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

Array = NDArray[np.float64]

RPM = pi / 30.0
# 1 lbf in s^2 in kg m^2, from the exact pound, standard gravity and the exact inch.
LBF_IN_S2 = 0.45359237 * 9.80665 * 0.0254
PROPORTIONS = {
    "(2,1,2,2)": "smith_1972_2122",
    "(4,1,4,4)": "smith_1972_4144",
    "(5,1,5,2)": "smith_1972_5152_sixteenth_inch",
    "(10,1,10,4)": "smith_1972_101104_sixteenth_inch",
    "(54,0.4,54,3)": "smith_1972_54_04_54_3",
}
EQUATIONS = ("reduced", "printed", "complete")


@dataclass(frozen=True)
class EndLoad:
    """Functions of the coupler equation at crank angles; every array has their shape.

    phi, f1, f2, f3 as defined under Smith (6.17), and ``cos(theta2 - theta3)``, the shape of the
    tension that (6.17) leaves out.
    """

    phi: Array
    f1: Array
    f2: Array
    f3: Array
    cos23: Array


def end_load(linkage: FourBar, theta: ArrayLike) -> EndLoad:
    """Return the functions phi, f1, f2, f3 of Smith (6.17) at crank angles [rad]."""
    motion = linkage.motion(theta)
    between = motion.theta3 - motion.theta4
    crank = motion.theta2 - motion.theta3
    return EndLoad(
        phi=motion.omega3**2,
        f1=-motion.alpha3 / np.tan(between),
        f2=np.sin(crank) / np.tan(between),
        f3=-motion.alpha4 / np.sin(between),
        cos23=np.cos(crank),
    )


def linkage_of(proportions: str) -> FourBar:
    """Return the linkage that the thesis names by its proportions."""
    return four_bar_of(PROPORTIONS[proportions])


def four_bar_of(scene: str) -> FourBar:
    """Return the four-bar linkage of a built-in scene; another one is refused."""
    linkage = load_scene(scene).mechanism()
    if not isinstance(linkage, FourBar):
        raise bad(f"scene {scene}", type(linkage).__name__, "a four-bar linkage", "choose another")
    return linkage


@lru_cache(maxsize=8)
def f3_series(proportions: str) -> PeriodicFunction:
    """Return the Fourier series of f3, Smith (6.17), for a linkage named by its proportions."""
    linkage = linkage_of(proportions)
    return PeriodicFunction.from_callable(lambda theta: end_load(linkage, theta).f3)


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


RIGS = tuple(
    Rig(f"smith_1972_{plain}_{inch}_inch", linkage, thickness, figure)
    for plain, linkage, first in (("5152", "(5,1,5,2)", 82), ("101104", "(10,1,10,4)", 85))
    for figure, inch, thickness in (
        (str(first), "thirtysecond", "1/32"),
        (str(first + 1), "threesixtyfourths", "3/64"),
        (str(first + 2), "sixteenth", "1/16"),
    )
)
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
