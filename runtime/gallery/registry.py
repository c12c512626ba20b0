"""Which figures of which documents the gallery redraws, as data."""

from __future__ import annotations

from collections.abc import Mapping

from . import (
    smith_charts,
    smith_coupler_equation,
    smith_kinematics,
    smith_solutions,
    smith_speeds,
    smith_waves,
)
from .records import FigureEntry
from .smith_linkages import PROPORTIONS, RIGS

_END_LOADS = tuple(
    FigureEntry(
        "smith",
        f"27({letter})",
        f"Components of the coupler end force, {proportions}",
        smith_kinematics.end_load_figure(proportions),
    )
    for letter, proportions in zip("abcde", PROPORTIONS, strict=True)
)

_WAVES = tuple(
    FigureEntry(
        "smith",
        str(number),
        f"Wave-form of the coupler at Omega/{divisor:g}",
        smith_waves.wave_figure(divisor),
    )
    for number, divisor in zip(range(47, 52), (8.0, 5.0, 3.0, 4.0, 4.7), strict=True)
)

_CHARTS = tuple(
    FigureEntry(
        "smith",
        rig.figure,
        f"Stability chart, linkage {rig.linkage}, coupler {rig.thickness} in",
        smith_speeds.chart_figure(rig.figure),
        size=(7.4, 6.0),
    )
    for rig in RIGS
)

_SMITH = (
    FigureEntry("smith", "6(a)", "Output angle against input angle", smith_kinematics.figure_6a),
    FigureEntry("smith", "6(b)", "Output angular velocity", smith_kinematics.figure_6b),
    FigureEntry("smith", "6(c)", "Output angular acceleration", smith_kinematics.figure_6c),
    FigureEntry(
        "smith",
        "7",
        "Fourier components of the output motion",
        smith_kinematics.figure_7,
        panels=(1, 2),
        size=(8.4, 4.2),
    ),
    *_END_LOADS,
    FigureEntry(
        "smith",
        "28",
        "Solution of Hill's equation: effect of the step length",
        smith_solutions.figure_28,
        panels=(3, 1),
        size=(7.2, 6.4),
    ),
    FigureEntry(
        "smith",
        "29",
        "Solution of Hill's equation: effect of the step length on the phase",
        smith_solutions.figure_29,
        panels=(2, 1),
        size=(7.2, 5.0),
    ),
    FigureEntry(
        "smith",
        "30",
        "Solution of Hill's equation: de Vogelaere and Kutta-Merson",
        smith_solutions.figure_30,
        panels=(2, 1),
        size=(7.2, 5.0),
    ),
    FigureEntry(
        "smith",
        "31",
        "Solution of Hill's equation: amplitudes of the first three modes",
        smith_solutions.figure_31,
        panels=(3, 1),
        size=(7.2, 6.4),
    ),
    FigureEntry(
        "smith", "32", "Forcing functions of the first two modes", smith_solutions.figure_32
    ),
    FigureEntry(
        "smith",
        "33",
        "Stable and unstable solutions",
        smith_solutions.figure_33,
        panels=(3, 2),
        size=(7.8, 6.4),
    ),
    FigureEntry(
        "smith",
        "34",
        "Stability chart: exact, first and second order",
        smith_charts.figure_34,
        size=(7.2, 5.0),
    ),
    FigureEntry(
        "smith",
        "35",
        "Stability chart: effect of the crank's length",
        smith_charts.figure_35,
        panels=(2, 2),
        size=(7.6, 6.0),
    ),
    FigureEntry(
        "smith", "36", "Stability chart: first unstable region, damped", smith_charts.figure_36
    ),
    FigureEntry(
        "smith", "37", "Stability chart: effect of damping on four regions", smith_charts.figure_37
    ),
    FigureEntry(
        "smith", "45", "Calibration: sinusoidal and point-load shapes", smith_waves.figure_45
    ),
    *_WAVES,
    *_CHARTS,
    FigureEntry(
        "smith",
        "table_coupler",
        "Printed against complete coupler equation",
        smith_coupler_equation.figure_table,
        size=(7.8, 4.8),
    ),
)

DOCUMENTS: Mapping[str, tuple[FigureEntry, ...]] = {"smith": _SMITH}
