"""Aannaque's Fig. 7.12: the follower's acceleration as the pivots are moved apart."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, radians
from typing import TYPE_CHECKING

import numpy as np

from ..scenes import load_scene
from .aannaque_kinematics import SCENE, cycle
from .records import Drawn, Quoted
from .sketches import Array
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Fig. 7.12 gives its lengths beside the curves; these are the ones of Figs. 8.19 to 8.23.
FRAMES = (0.547, 0.600, 0.632, 0.642, 0.652, 0.662)
_REVERSAL = 0.66


def figure_7_12(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's acceleration for several distances of the pivots."""
    ax = axes[0]
    speed = load_scene(SCENE)["operation"]["speed"]
    for frame, colour in zip(FRAMES, COLOURS, strict=False):
        motion = cycle(frame)
        greatest = degrees(float(np.max(motion.transmission_angle)))
        label = rf"$L_4$ = {frame:.3f} m, $\gamma_{{\max}}$ = {greatest:.0f}°"
        ax.plot(np.degrees(motion.theta2), speed**2 * motion.alpha4, color=colour, label=label)
    ax.axhline(0.0, color="0.6", lw=0.8, zorder=1)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel("acceleration of the follower [rad/s$^2$]")
    legend_below([ax], columns=3)
    note = (
        "The values of L4 are not legible; drawn are those of Figs. 8.19 to 8.23 and 0.600 m. The "
        "text speaks of the stress; here the acceleration that drives it is compared."
    )
    return Drawn(tuple(_pulse_rows()), (note,))


def pulses_of(frame: float) -> tuple[float, float]:
    """Return the sizes of the first pulse (0 to 90 deg) and of the one about 180 deg."""
    motion = cycle(frame)
    turned = np.degrees(motion.theta2)
    size = np.abs(motion.alpha4)
    first, second = (turned < 90.0), (np.abs(turned - 180.0) < 30.0)
    return float(size[first].max()), float(size[second].max())


def crossover() -> float:
    """Return the frame length [m] at which the second pulse is as large as the first."""
    low, high = 0.60, 0.68
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        first, second = pulses_of(middle)
        low, high = (middle, high) if second < first else (low, middle)
    return 0.5 * (low + high)


def _pulse_rows() -> list[Quoted]:
    pulses = np.array([pulses_of(frame) for frame in FRAMES])
    last = cycle(FRAMES[-1])
    later = last.theta2 > radians(90.0)
    place = last.theta2[later][int(np.argmax(np.abs(last.alpha4[later])))]
    greatest = degrees(float(np.max(last.transmission_angle)))
    return [
        Quoted(
            "angle of the second pulse with the longest frame",
            180.0,
            degrees(float(place)),
            5.0,
            "where the transmission angle is greatest (8.5), within 5 deg",
            "7.5",
            unit="deg",
        ),
        Quoted(
            "greatest transmission angle with L4 = 0.662 m",
            140.0,
            greatest,
            0.0,
            "'beyond the acceptable range'",
            "7.5",
            relation=">",
            unit="deg",
        ),
        *_size_rows(pulses),
    ]


def _size_rows(pulses: Array) -> list[Quoted]:
    """Return what the text says of the two pulses' sizes, first and second in a row."""
    return [
        Quoted(
            "least growth of the second pulse from one L4 to the next, ratio",
            1.0,
            float(np.min(pulses[1:, 1] / pulses[:-1, 1])),
            0.0,
            "'its effect increases with L4 progressively'",
            "7.5",
            relation=">",
        ),
        Quoted(
            "second pulse over the first with L4 = 0.547 m",
            1.0,
            float(pulses[0, 1] / pulses[0, 0]),
            0.0,
            "not dominant at first",
            "7.5",
            relation="<",
        ),
        Quoted(
            "the same with L4 = 0.662 m",
            1.0,
            float(pulses[-1, 1] / pulses[-1, 0]),
            0.0,
            "'becomes dominant'",
            "7.5",
            relation=">",
        ),
        Quoted(
            "frame length from which the second pulse is the larger",
            _REVERSAL,
            crossover(),
            0.005,
            "half of the last digit; the measured stress turns there (8.5)",
            "8.5",
            unit="m",
        ),
        Quoted(
            "largest first pulse with a longer frame, over that at 0.547 m",
            1.0,
            float(np.max(pulses[1:, 0]) / pulses[0, 0]),
            0.0,
            "'the amplitude reduces if L4 is increased'",
            "7.5",
            relation="<",
        ),
    ]
