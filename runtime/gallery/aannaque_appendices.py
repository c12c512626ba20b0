"""Aannaque's Appendices C and D: stresses of all three links over the cycle, sheet by sheet."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .aannaque_rig import FRAME, LONG, SHORT, SPEEDS_C, SPEEDS_D, Array, Cycles, cycles
from .records import Drawn, Quoted
from .style import COLOURS, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST = 6
_SAMPLING = 1000.0
_COUNTS = 0.01
_LINKS = (("crank", "input link"), ("coupler", "coupler"), ("follower", "follower"))
_NOTE = (
    "Computed; the measured curves are lost in the scan. Stress of one outer fibre, tension "
    "positive; which fibre the gauges count as positive is not stated. The captions say the input "
    "link's midpoint, section 8.5 that the gauges sat at its end on the flywheel: both are drawn."
)
_MODEL = (
    "Three cubic elements per link, full equations with stiffening, 2 % modal damping; the "
    "document's curves are of one element per link with its frequency corrected."
)
_SLIPS = {
    "C": "The list of figures has 20.07 rad/s for one part of Fig. C.11; its captions 20.40.",
    "D": "Fig. D.5 is without caption: its speed is that of the list of figures. The list also has "
    "21.37 for one part of D.18, 233.62 for one of D.22 and 25.54 for one of D.26.",
}
_DATA: dict[str, tuple[str, tuple[float, ...]]] = {
    "C": (SHORT, SPEEDS_C),
    "D": (LONG, SPEEDS_D),
}


def sheets(letter: str) -> tuple[tuple[int, ...], ...]:
    """Return the figures' numbers on each sheet of Appendix C or D, as even as can be."""
    numbers = range(1, len(speeds_of(letter)) + 1)
    count = -(-len(numbers) // _MOST)
    ends = [len(numbers) * k // count for k in range(count + 1)]
    return tuple(tuple(numbers[low:high]) for low, high in pairwise(ends))


def speeds_of(letter: str) -> tuple[float, ...]:
    """Return the speeds of Appendix C or D [rad/s], figure by figure."""
    return _DATA[letter][1]


def gauges(letter: str, numbers: tuple[int, ...]) -> Cycles:
    """Return the stresses over the cycle at the speeds of some figures of an appendix."""
    scene, speeds = _DATA[letter]
    return cycles(scene, FRAME, tuple(speeds[number - 1] for number in numbers))


def sheet(letter: str, numbers: tuple[int, ...]) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws some figures of an appendix, a row of links for each."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        found = gauges(letter, numbers)
        angle = np.degrees(np.append(found.theta, 2 * np.pi))
        for row, number in enumerate(numbers):
            for column, (link, name) in enumerate(_LINKS):
                ax = axes[len(_LINKS) * row + column]
                _draw(ax, found, row, link, angle)
                panel_title(ax, f"{letter}.{number}: {name}, {found.speed[row]:g} rad/s")
                if row < len(numbers) - 1:
                    ax.tick_params(labelbottom=False)
                else:
                    ax.set_xlabel("crank angle [deg]")
            axes[len(_LINKS) * row].set_ylabel("stress [MPa]")
        legend_below(axes)
        return Drawn(tuple(_rows(found)), (_NOTE, _MODEL, _SLIPS[letter]))

    return draw


def _draw(ax: Axes, found: Cycles, place: int, link: str, angle: Array) -> None:
    """Draw the stress at the middle of a link, and of the input link also at its end."""
    middle = found.stress[link, 0.5][place] / 1e6
    ax.plot(angle, np.append(middle, middle[0]), color=COLOURS[0], lw=1.0, label="midpoint")
    if (link, 0.0) in found.stress:
        end = found.stress[link, 0.0][place] / 1e6
        ax.plot(
            angle,
            np.append(end, end[0]),
            "--",
            color=COLOURS[1],
            lw=0.8,
            label="end at the flywheel",
        )
    ax.set_xlim(0.0, 360.0)
    ax.set_xticks([0, 90, 180, 270, 360])
    ax.locator_params(axis="y", nbins=4)


def _rows(found: Cycles) -> list[Quoted]:
    chosen = range(len(found.speed))
    highest = max(_highest(found, place) for place in chosen)
    ratio = [_largest(found, "crank", 0.0, k) / _largest(found, "crank", 0.5, k) for k in chosen]
    return [
        Quoted(
            "highest frequency in the stresses of the sheet that carries 1 % of the largest",
            _SAMPLING / 2,
            highest,
            0.0,
            "half of the 1 kHz at which the gauges were read, 'well above the highest expected'",
            "8.5",
            relation="<",
            unit="Hz",
        ),
        Quoted(
            "input link: largest stress at its end over that at its midpoint, least of the sheet",
            1.5,
            float(min(ratio)),
            0.0,
            "captions and section 8.5 name two places, not one: they differ by half and more",
            "8.5, captions",
            relation=">",
        ),
    ]


def _largest(found: Cycles, link: str, place: float, speed: int) -> float:
    return float(np.max(np.abs(found.stress[link, place][speed])))


def _highest(found: Cycles, speed: int) -> float:
    """Return the frequency [Hz] of the highest harmonic with 1 % of the largest, all links."""
    best = 0.0
    for values in found.stress.values():
        waves = np.abs(np.fft.rfft(values[speed]))[1:]
        best = max(best, float(1 + np.flatnonzero(waves >= _COUNTS * waves.max())[-1]))
    return best * float(found.speed[speed]) / (2 * np.pi)
