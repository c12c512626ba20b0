"""Aannaque's chapters 4 to 7: which figures and tables the gallery redraws, as data."""

from __future__ import annotations

from . import (
    aannaque_critical,
    aannaque_elements,
    aannaque_exact,
    aannaque_lengths,
    aannaque_newmark,
    aannaque_operations,
    aannaque_pulses,
    aannaque_stability,
    aannaque_steady_state,
    aannaque_stresses,
)
from .records import FigureEntry

_MODES = tuple(enumerate(("first", "second", "third", "fourth"), start=1))
_TWO_ROWS, _TWO_COLUMNS = (2, 1), (1, 2)

_ELEMENTS = tuple(
    FigureEntry(
        "aannaque",
        f"4.6({letter})",
        f"The {name} natural frequency: more elements against higher polynomials",
        aannaque_elements.frequency_figure(mode),
    )
    for letter, (mode, name) in zip("abcd", _MODES, strict=True)
)

_EXACT = (
    FigureEntry(
        "aannaque",
        "5.1",
        "Logarithm of the determinant of D, one and two elements for each bar",
        aannaque_exact.figure_5_1,
        panels=_TWO_ROWS,
        size=(7.2, 6.0),
    ),
    FigureEntry(
        "aannaque",
        "table_5.1",
        "Natural frequencies of the portal frame and their errors",
        aannaque_exact.figure_table_5_1,
    ),
    *(
        FigureEntry(
            "aannaque",
            f"5.3({letter})",
            f"The {name} natural frequency: three elements against exact",
            aannaque_exact.frequency_figure(mode),
            panels=_TWO_ROWS,
            size=(7.2, 5.4),
        )
        for letter, (mode, name) in zip("abcd", _MODES, strict=True)
    ),
)

_STEADY_STATE = (
    FigureEntry(
        "aannaque",
        "6.1",
        "Limits of stability of Newmark's scheme",
        aannaque_newmark.figure_6_1,
    ),
    *(
        FigureEntry(
            "aannaque",
            f"6.3({letter})",
            f"Displacement of the {link}'s midpoint at 35 rad/s",
            aannaque_steady_state.deflection_figure(link),
        )
        for letter, link in (("a", "coupler"), ("b", "follower"))
    ),
    *(
        FigureEntry(
            "aannaque",
            f"6.4({letter})",
            f"Contributions of the modes to the {link}'s midpoint at 35 rad/s",
            aannaque_steady_state.contribution_figure(link),
        )
        for letter, link in (("a", "coupler"), ("b", "follower"))
    ),
    FigureEntry(
        "aannaque",
        "6.5",
        "Convergence of the follower's midpoint from rest at 62 rad/s",
        aannaque_steady_state.figure_6_5,
        panels=_TWO_ROWS,
        size=(7.2, 5.6),
    ),
    FigureEntry(
        "aannaque",
        "6.6",
        "Operations of the algorithms over the number of intervals",
        aannaque_operations.figure_6_6,
        panels=_TWO_COLUMNS,
        size=(9.2, 4.6),
    ),
    FigureEntry(
        "aannaque",
        "table_6.1",
        "Operations of the algorithms: counted against the printed formulas",
        aannaque_operations.figure_table_6_1,
        panels=_TWO_COLUMNS,
        size=(9.0, 4.4),
    ),
    FigureEntry(
        "aannaque",
        "table_6.2",
        "Operations of three algorithms, in millions",
        aannaque_operations.figure_table_6_2,
        size=(7.8, 4.8),
    ),
    FigureEntry(
        "aannaque",
        "table_6.3",
        "Operations of the Fourier series and of algorithm 1",
        aannaque_operations.figure_table_6_3,
        panels=_TWO_COLUMNS,
        size=(9.0, 4.4),
    ),
)

_SPEEDS = (
    FigureEntry(
        "aannaque",
        "7.1",
        "Maxima of the stress and of the real part of a multiplier over the speed",
        aannaque_critical.figure_7_1,
        panels=_TWO_ROWS,
        size=(7.2, 6.0),
    ),
    FigureEntry(
        "aannaque",
        "7.2",
        "Instability regions corresponding to J_2 = 1 and J_2 = -1",
        aannaque_stability.figure_7_2,
        size=(6.2, 6.4),
    ),
    FigureEntry(
        "aannaque",
        "7.3",
        "Functions J and the real part of a multiplier",
        aannaque_critical.figure_7_3,
    ),
    FigureEntry(
        "aannaque",
        "7.4",
        "Response of the follower's midpoint over the speed, six frames",
        aannaque_lengths.figure_7_4,
    ),
    FigureEntry(
        "aannaque",
        "7.5",
        "Largest stress of the input link over the speed, six frames",
        aannaque_lengths.figure_7_5,
    ),
    FigureEntry(
        "aannaque",
        "7.6",
        "Peak strain energy over the speed, six frames",
        aannaque_lengths.figure_7_6,
    ),
)


def _damping(label: str, percent: int) -> FigureEntry:
    return FigureEntry(
        "aannaque",
        label,
        f"Largest stress of each link over the speed, damping {percent} %",
        aannaque_stresses.damping_figure(percent / 100),
    )


_STRESSES = (
    _damping("7.7", 2),
    FigureEntry(
        "aannaque",
        "7.8",
        "Largest stress over the speed: number of elements",
        aannaque_stresses.figure_7_8,
    ),
    FigureEntry(
        "aannaque",
        "7.9",
        "Stress at the follower's midpoint at 30 rad/s, four models",
        aannaque_stresses.figure_7_9,
    ),
    _damping("7.10", 3),
    _damping("7.11", 6),
    FigureEntry(
        "aannaque",
        "7.12",
        "Acceleration of the follower for various transmission angles",
        aannaque_pulses.figure_7_12,
    ),
    FigureEntry(
        "aannaque",
        "7.13",
        "Stress at the follower's midpoint at 30 rad/s, six frames",
        aannaque_lengths.figure_7_13,
    ),
)

CHAPTERS_4_TO_7 = (*_ELEMENTS, *_EXACT, *_STEADY_STATE, *_SPEEDS, *_STRESSES)
