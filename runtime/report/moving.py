"""The machine in motion: a drawing whose parts carry the places that a script moves them to."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..linkages import Linkage
from ..linkages.circuits import Circuit
from ..linkages.pictures import bars_at, half_width, pins_at

Complex = NDArray[np.complex128]

# Positions in a turn, units of the drawing across, and seconds that a turn takes on the screen.
FRAMES, _WIDE, SECONDS = 90, 600.0, 4.0
# A foot below a fixed pivot, over the half-width of a block.
_FOOT = np.array([0.0, -0.6 - 0.9j, 0.6 - 0.9j])


def positions(linkage: Linkage) -> NDArray[np.float64]:
    """Return the crank angles [rad] of the drawing's positions."""
    return np.asarray(Circuit(linkage).crank_angle(np.arange(FRAMES) * 2.0 * pi / FRAMES))


def moving_machine(linkage: Linkage, told: str, bent: Mapping[str, Complex] | None = None) -> str:
    """Return an SVG of a linkage in its first position, with all others beside each part.

    ``told``: the title.  ``bent``: by link, places along it at every position ``(FRAMES, n)`` in
    place of the straight line; a motion that closes is required of the linkage.
    """
    motion = Circuit(linkage)
    motion.check()
    turn = np.arange(FRAMES) * 2.0 * pi / FRAMES
    each = [bars_at(motion, float(s)) for s in turn]
    bars = {link: np.array([bars[link] for bars in each]) for link in each[0]} | dict(bent or {})
    pins = np.array([pins_at(motion, float(s)) for s in turn])
    joints, unit = motion.joints(turn), half_width(motion)
    pivots = [0j, *([complex(joints["D"][0])] if "D" in joints else [])]
    still = [("foot", pivot + unit * _FOOT) for pivot in pivots]
    if linkage.mechanism == "slider_crank":
        travel, level = joints["C"].real, joints["C"][0].imag
        ends = np.array([np.min(travel) - 1.6 * unit, np.max(travel) + 1.6 * unit])
        still += [("guide", ends + 1j * (level + side * unit)) for side in (-0.6, 0.6)]
    everything = np.concatenate([*map(np.ravel, bars.values()), *(line for _, line in still)])
    margin = 0.8 * unit
    left, top = float(np.min(everything.real)) - margin, float(np.max(everything.imag)) + margin
    across = float(np.max(everything.real)) + margin - left
    down = top - float(np.min(everything.imag)) + margin
    scale = _WIDE / across

    def placed(line: NDArray[np.complexfloating[Any, Any]]) -> str:
        x, y = scale * (line.real - left), scale * (top - line.imag)
        return " ".join(f"{value:.1f}" for pair in zip(x, y, strict=True) for value in pair)

    def moved(name: str, lines: Complex) -> str:
        return f'class="{name}" data-poses="{";".join(map(placed, lines))}"'

    drawn = [f'<polyline class="path" points="{placed(np.append(p, p[:1]))}"/>' for p in pins.T]
    for name, line in still:
        shape = "polygon" if name == "foot" else "polyline"
        drawn.append(f'<{shape} class="{name}" points="{placed(line)}"/>')
    for link, lines in bars.items():
        drawn.append(f'<polyline {moved(f"link {link}", lines)} points="{placed(lines[0])}"/>')
    for places in (*pins.T, *(np.full(FRAMES, pivot) for pivot in pivots)):
        x, y = placed(places[:1]).split()
        drawn.append(f'<circle {moved("pin", places[:, None])} cx="{x}" cy="{y}" r="5"/>')
    angles = " ".join(f"{angle:.1f}" for angle in np.degrees(motion.crank_angle(turn)))
    keys = "".join(f'<li class="{link}">{link}</li>' for link in bars)
    return (
        f'<figure class="moving"><svg viewBox="0 0 {_WIDE:.0f} {scale * down:.0f}" role="img"'
        f' aria-label="{escape(told)}" data-angles="{angles}" data-seconds="{SECONDS:g}">'
        f"<title>{escape(told)}</title>{''.join(drawn)}</svg>"
        '<p class="controls" hidden><button type="button">Pause</button> <label>position'
        f' <input type="range" min="0" max="{FRAMES - 1}" value="0"></label>'
        " <output>crank at 0°</output></p>"
        f'<ul class="key">{keys}</ul><figcaption>{escape(told)}</figcaption></figure>'
    )
