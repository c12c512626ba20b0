"""Beale and Scott's Figs. 7 to 10: tip deflection by free-free modes with constraints."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..constrained import constrained_motion
from ..core.errors import LinearRangeWarning
from ..core.families import Array
from ..scenes import load_scene
from ..systems.rod import FreeFreeRod
from .beale_tip import (
    AS_PRINTED,
    BAND,
    CONVERGED,
    ENOUGH,
    FLEXIBLE,
    HEAVY,
    NAMES,
    READINGS,
    SIGN,
    STIFF,
    UNITS,
    peak,
    rod,
    stiff_tip,
    tip_axis,
    tip_from_rest,
)
from .records import Drawn, Quoted
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..constrained.motion import ConstrainedMotion

# The free-free equations as printed have the frame term, and no tension.
_FRAME = ("tension",)
_SAMPLES = 720
_TOLERANCE = 1e-6
_FORMS = (
    "Free-free modes in the nonlinear equations with constraints as printed, (42)-(49): without "
    "centrifugal tension, but with what the rotation of the floating frame brings. The converged "
    "curve has the same physics, linear."
)


@lru_cache(maxsize=16)
def constrained_tip(scene: str, modes: int) -> tuple[Array, Array, ConstrainedMotion]:
    """Return crank angles, the tip's deflection [m] and the motion of the first turn.

    From the paper's initial conditions: undeformed, at the speeds of the rigid mechanism.
    """
    overrides = {"model.formulation": "free_free", "model.modes": modes, "model.drop": _FRAME}
    system = load_scene(scene, overrides=overrides).system()
    if not isinstance(system, FreeFreeRod):
        raise TypeError("not the rod with constraints")
    with warnings.catch_warnings():
        # The heavy reading passes the linear range; the figure's own note says so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        run = constrained_motion(system, rtol=_TOLERANCE, samples=_SAMPLES)
    return system.speed * run.time, system.deflection(run.q, run.time, 1.0)[..., 0], run


@lru_cache(maxsize=2)
def _small_crank() -> tuple[Array, Array]:
    return tip_from_rest(rod(FLEXIBLE, "overhang", ENOUGH, _FRAME), 100.0)


def figure_7(axes: Sequence[Axes]) -> Drawn:
    """Draw the flexible rod's tip at the small crank with one, two and three modes."""
    theta, exact = _small_crank()
    size, angle = peak(exact), np.degrees(theta)
    axes[0].plot(angle, 1e3 * exact, **BAND, label=CONVERGED)
    gaps = []
    for modes in (1, 2, 3):
        _, tip, _ = constrained_tip(FLEXIBLE, modes)
        colour, style = COLOURS[modes - 1], ("-", "--", ":")[modes - 1]
        label = f"{modes} free-free mode{'s' if modes > 1 else ''}"
        axes[0].plot(angle, 1e3 * tip, style, color=colour, label=label)
        axes[1].plot(angle, 1e2 * (tip - exact) / size, style, color=colour)
        gaps.append(peak(tip - exact) / size)
    for ax, title, name in zip(
        axes,
        ("crank ratio 0.01, 100 rad/s", "less the converged deflection, over its peak"),
        ("tip deflection [mm]", "difference [%]"),
        strict=True,
    ):
        tip_axis(ax, title)
        ax.set_ylabel(name)
    axes[0].set_xlabel("")
    legend_below(axes)
    rows = (
        _below(
            "largest gap of one mode to the converged modes over the peak",
            0.1,
            gaps[0],
            "'a one mode approximation is very accurate': within a tenth",
        ),
        _below(
            "gap of two modes less that of three, over the peak",
            0.01,
            gaps[1] - gaps[2],
            "'beyond two modes no significant increase in accuracy': a hundredth",
        ),
        _defect(FLEXIBLE, (1, 2, 3)),
    )
    return Drawn(rows, (_FORMS, SIGN))


def large_crank_figure(modes: int) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws the stiff rod's tip with so many free-free modes."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        word = f"{modes} free-free mode{'s' if modes > 1 else ''}"
        rows = []
        for ax, (scene, title) in zip(axes, READINGS, strict=True):
            _draw_large(ax, scene, modes, word)
            tip_axis(ax, title)
            rows += _large_rows(scene, modes)
        axes[0].set_ylabel("tip deflection [mm]")
        legend_below(axes)
        runs = [scene for scene in (STIFF, HEAVY) if _affordable(scene, modes)]
        rows += [_defect(scene, (modes,)) for scene in runs]
        return Drawn(tuple(rows), (_FORMS, *_LARGE_NOTES, UNITS, SIGN))

    return draw


_LARGE_NOTES = (
    "In the mass reading the deflection is a five-thousandth of the length. The nonlinear and the "
    "linear form of one mode are then a ten-thousandth of the peak apart; with three and five "
    "modes, whose highest vibrations take thousands of explicit steps a turn, the linear form "
    "stands alone.",
    "In the other reading the deflection is a fifth of the length, where both forms are beyond "
    "what they assume: the gap between them says by how much.",
)


def _affordable(scene: str, modes: int) -> bool:
    return scene == HEAVY or modes == 1


def _draw_large(ax: Axes, scene: str, modes: int, word: str) -> None:
    for (formulation, count, drop), look, label in (
        (("overhang", ENOUGH, _FRAME), BAND, CONVERGED),
        (("polynomial", 10, AS_PRINTED), {"color": COLOURS[1], "ls": "--"}, "10 polynomial modes"),
        (("free_free_linear", modes, _FRAME), {"color": COLOURS[2]}, f"{word}, linear"),
    ):
        theta, tip = stiff_tip(scene, formulation, count, drop)
        ax.plot(np.degrees(theta), 1e3 * tip, **look, label=label)
    if _affordable(scene, modes):
        theta, tip, _ = constrained_tip(scene, modes)
        label = f"{word}, with constraints"
        ax.plot(np.degrees(theta), 1e3 * tip, ":", color=COLOURS[0], lw=2.0, label=label)


def _gap(scene: str, modes: int) -> float:
    """Return the largest gap of free-free modes to the converged ones, both linear."""
    exact = stiff_tip(scene, "overhang", ENOUGH, _FRAME)[1]
    return peak(stiff_tip(scene, "free_free_linear", modes, _FRAME)[1] - exact) / peak(exact)


def _large_rows(scene: str, modes: int) -> list[Quoted]:
    name = NAMES[scene]
    tip = stiff_tip(scene, "free_free_linear", modes, _FRAME)[1]
    ten = stiff_tip(scene, "polynomial", 10)[1]
    rows = []
    if modes > 1:
        before = modes - 2
        rows.append(
            _below(
                f"gap to the converged modes with {modes} over that with {before}, {name}",
                1.0,
                _gap(scene, modes) / _gap(scene, before),
                "'rapid convergence': below that of two modes fewer",
            )
        )
    agree = "'agree quite well with those using the polynomial modes': within a fifth"
    one = modes == 1
    rows.append(
        _below(
            f"largest gap to ten polynomial modes over their peak, {name}",
            0.2,
            peak(tip - ten) / peak(ten),
            agree,
            "one mode does not have the period of the vibration" if one and scene == HEAVY else "",
        )
    )
    if _affordable(scene, modes):
        nonlinear = constrained_tip(scene, modes)[1]
        rows.append(
            _below(
                f"gap of constrained and linear form over the peak, {name}",
                0.01,
                peak(nonlinear - tip) / peak(tip),
                "linear equations suffice for Figs. 2 and 3: within a hundredth",
                "deflections of a fifth of the length" if scene == HEAVY else "",
            )
        )
    return rows


def _below(number: str, printed: float, computed: float, meaning: str, differs: str = "") -> Quoted:
    return Quoted(number, printed, computed, 0.0, meaning, "2.3", relation="<", differs=differs)


def _defect(scene: str, counts: Sequence[int]) -> Quoted:
    """Return how well the constraints hold over the turn: nothing in the paper, but a check."""
    runs = [constrained_tip(scene, modes)[2] for modes in counts]
    name = NAMES.get(scene, "small crank")
    norms = ("position_norm", "velocity_norm", "acceleration_norm")
    worst = max(float(np.max(getattr(run, name))) for run in runs for name in norms)
    return Quoted(
        f"largest scaled defect of the constraints on all levels, {name}",
        0.0,
        worst,
        1e-12,
        "the constraints (42), (43), (45) are equations",
        "2.3",
    )
