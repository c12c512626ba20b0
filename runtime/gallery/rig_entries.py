"""Entries of the registry for Aannaque's rig: chapters 8 and 9, appendices C and D."""

from __future__ import annotations

from . import aannaque_appendices, aannaque_measured, aannaque_modes, aannaque_paths
from .records import FigureEntry

_PATHS = tuple(
    FigureEntry("aannaque", label, title, draw, panels=(1, 2), size=(8.4, 4.2))
    for label, title, draw in (
        ("8.2", "Paths of the coupler's midpoint at two speeds", aannaque_paths.figure_8_2),
        ("8.3", "Path of the coupler's midpoint at a low speed", aannaque_paths.figure_8_3),
        ("8.4", "Paths at a low and at a higher speed", aannaque_paths.figure_8_4),
    )
)

_MODES = tuple(
    FigureEntry(
        "aannaque",
        f"8.{9 + place}",
        f"Mode shapes and frequencies at the crank angle {angle} deg",
        aannaque_modes.mode_figure(place),
        panels=(1, 3),
        size=(9.0, 3.2),
    )
    for place, angle in enumerate(aannaque_modes.ANGLES)
)

_STRESSES = (
    *(
        FigureEntry(
            "aannaque",
            f"8.{19 + place}",
            f"Largest stress at the follower's midpoint, L4 = {frame:.3f} m",
            aannaque_measured.frame_figure(frame),
        )
        for place, frame in enumerate(aannaque_measured.FRAMES)
    ),
    FigureEntry(
        "aannaque",
        "8.24",
        "Stress at the follower's midpoint at 17 rad/s, L4 = 0.662 m",
        aannaque_measured.figure_8_24,
    ),
    *(
        FigureEntry(
            "aannaque",
            label,
            f"Largest stress at the {link}'s midpoint, L2 = 0.636 m",
            aannaque_measured.long_figure(link),
        )
        for label, link in (("8.25", "coupler"), ("8.26", "follower"))
    ),
)

_LENGTH = FigureEntry(
    "aannaque", "9.1", "Natural frequencies over the coupler's length", aannaque_modes.figure_9_1
)

RIG_FIGURES = (*_PATHS, *_MODES, *_STRESSES, _LENGTH)

RIG_APPENDICES = tuple(
    FigureEntry(
        "aannaque",
        f"{letter}.{numbers[0]}-{letter}.{numbers[-1]}",
        f"Stresses over the cycle, L2 = {length} m, "
        f"{aannaque_appendices.speeds_of(letter)[numbers[0] - 1]:g} to "
        f"{aannaque_appendices.speeds_of(letter)[numbers[-1] - 1]:g} rad/s",
        aannaque_appendices.sheet(letter, numbers),
        panels=(len(numbers), 3),
        size=(9.0, 0.8 + 1.6 * len(numbers)),
    )
    for letter, length in (("C", "0.328"), ("D", "0.636"))
    for numbers in aannaque_appendices.sheets(letter)
)
