"""Which figures of which documents the gallery redraws, as data."""

from __future__ import annotations

from collections.abc import Mapping

from . import (
    aannaque_forces,
    aannaque_kinematics,
    aannaque_space,
    aannaque_stability,
    beale_chart,
    beale_free_free,
    beale_response,
    beale_setting,
    beale_tip,
    smith_balanced_link,
    smith_balancing,
    smith_charts,
    smith_clearance,
    smith_coupler_equation,
    smith_damping,
    smith_forces,
    smith_kinematics,
    smith_second_mode,
    smith_solutions,
    smith_space,
    smith_speeds,
    smith_waves,
)
from .aannaque_figures import CHAPTERS_4_TO_7
from .records import FigureEntry
from .response_entries import RESPONSE_FIGURES
from .rig_entries import RIG_APPENDICES, RIG_FIGURES
from .smith_linkages import PROPORTIONS, RIGS
from .strutt import Which

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

_CLEARANCE = (
    FigureEntry(
        "smith", "8", "Kinematic effects of clearance", smith_clearance.figure_8, size=(6.4, 4.6)
    ),
    FigureEntry(
        "smith",
        "9(a)",
        "Kinematic effects of clearance: extreme position, phi = 0 deg",
        smith_clearance.figure_9a,
        size=(6.4, 4.2),
    ),
    FigureEntry(
        "smith",
        "9(b)",
        "Kinematic effects of clearance: extreme position, phi = 90 deg",
        smith_clearance.figure_9b,
        size=(6.4, 4.2),
    ),
    FigureEntry(
        "smith", "10", "Kinematic effects of clearance: free motion", smith_clearance.figure_10
    ),
)

_FORCES = (
    FigureEntry(
        "smith", "11", "Free bodies of the four links", smith_forces.figure_11, size=(7.4, 5.4)
    ),
    *(
        FigureEntry("smith", str(number), title, smith_forces.polar_figure(joint), size=(5.8, 5.0))
        for number, joint, title in (
            (12, "12", "Pin force of the frame upon the crank"),
            (13, "23", "Pin force of the crank upon the coupler"),
            (14, "34", "Pin force of the coupler upon the follower"),
            (15, "41", "Pin force of the follower upon the frame"),
            (16, "frame", "Force on the frame"),
        )
    ),
    *(
        FigureEntry(
            "smith",
            label,
            "Follower-frame force: effect of the dimensions",
            smith_forces.family_figure(label),
            size=(6.0, 5.4),
        )
        for label in ("17", "18", "19")
    ),
)

_BALANCING = (
    FigureEntry(
        "smith",
        "20",
        "Unbalanced, partially and fully balanced configurations",
        smith_balancing.figure_20,
        panels=(2, 2),
        size=(7.6, 6.2),
    ),
    FigureEntry(
        "smith",
        "21",
        "Force on the frame: effect of balancing",
        smith_balancing.figure_21,
        size=(6.0, 5.2),
    ),
    FigureEntry(
        "smith",
        "22",
        "Torque on the frame: effect of balancing",
        smith_balancing.figure_22,
        panels=(1, 2),
        size=(9.0, 4.4),
    ),
    FigureEntry(
        "smith",
        "23(a)",
        "Place of the counterweight for the least inertia of a balanced link",
        smith_balanced_link.figure_23a,
    ),
    FigureEntry(
        "smith",
        "23(b)",
        "Inertia of a balanced link: density and place of the counterweight",
        smith_balanced_link.figure_23b,
    ),
    FigureEntry(
        "smith",
        "23(c)",
        "Place of the least inertia: density of the counterweight",
        smith_balanced_link.figure_23c,
    ),
    FigureEntry(
        "smith",
        "23(d)",
        "Crank-pin force: effect of the counterweights' offset",
        smith_balancing.figure_23d,
        size=(6.0, 5.2),
    ),
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
    *_CLEARANCE,
    *_FORCES,
    *_BALANCING,
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
        "smith",
        "38",
        "Stability space of Hill's equation with two periodic functions",
        smith_space.figure_38,
        size=(7.2, 5.4),
        projection="3d",
    ),
    FigureEntry(
        "smith", "45", "Calibration: sinusoidal and point-load shapes", smith_waves.figure_45
    ),
    *_WAVES,
    *RESPONSE_FIGURES,
    *_CHARTS,
    FigureEntry(
        "smith",
        "table_coupler",
        "Printed against complete coupler equation",
        smith_coupler_equation.figure_table,
        size=(7.8, 4.8),
    ),
    FigureEntry(
        "smith",
        "table_damping",
        "Damping read from unstable regions: first order, higher orders, exact",
        smith_damping.figure_table,
        panels=(2, 2),
        size=(8.4, 6.4),
    ),
    FigureEntry(
        "smith",
        "table_second_mode",
        "Unstable regions of two modes, principal and combination",
        smith_second_mode.figure_table,
        panels=(2, 2),
        size=(8.4, 6.4),
    ),
)

_SURFACES: tuple[tuple[str, Which], ...] = (("E.1", "first"), ("E.2", "second"))

_AANNAQUE = (
    FigureEntry(
        "aannaque",
        "3.4",
        "Zero-mobility planes and base plane",
        aannaque_space.figure_3_4,
        size=(7.2, 5.4),
    ),
    FigureEntry(
        "aannaque",
        "3.5",
        "Base planes for typical values of lambda",
        aannaque_space.figure_3_5,
        panels=(1, 3),
        size=(10.5, 3.8),
    ),
    FigureEntry(
        "aannaque",
        "3.6",
        "The two mechanisms for one input angle",
        aannaque_kinematics.figure_3_6,
        size=(6.4, 5.0),
    ),
    FigureEntry(
        "aannaque",
        "3.7",
        "Relative angular velocity of coupler and follower",
        aannaque_kinematics.figure_3_7,
    ),
    FigureEntry(
        "aannaque",
        "3.8",
        "Relative angular accelerations of coupler and follower",
        aannaque_kinematics.figure_3_8,
    ),
    FigureEntry(
        "aannaque",
        "3.9",
        "Transmission angle against input angle",
        aannaque_kinematics.figure_3_9,
    ),
    FigureEntry(
        "aannaque",
        "3.10",
        "Paths of some points of the coupler",
        aannaque_kinematics.figure_3_10,
        size=(6.6, 5.4),
    ),
    *(
        FigureEntry(
            "aannaque",
            f"3.11({letter})",
            f"Free body of the {name}",
            aannaque_forces.body_figure(link),
            size=(5.6, 4.8),
        )
        for letter, link, name in (
            ("a", "crank", "input link"),
            ("b", "coupler", "coupler"),
            ("c", "follower", "follower"),
        )
    ),
    *CHAPTERS_4_TO_7,
    *RIG_FIGURES,
    *RIG_APPENDICES,
    *(
        FigureEntry(
            "aannaque",
            label,
            f"The {which} multiplier of Mathieu's equation over d and epsilon",
            aannaque_stability.surface_figure(which),
            size=(7.4, 5.4),
            projection="3d",
        )
        for label, which in _SURFACES
    ),
    FigureEntry(
        "aannaque",
        "E.3",
        "Stability chart of Mathieu's equation",
        aannaque_stability.figure_e_3,
        panels=(1, 2),
        size=(9.0, 4.4),
    ),
)

_WIDE = (9.4, 4.2)

_BEALE = (
    FigureEntry(
        "beale",
        "2",
        "Large crank: tip deflection by three polynomial modes",
        beale_tip.polynomial_figure(3),
        panels=(1, 2),
        size=_WIDE,
    ),
    FigureEntry(
        "beale",
        "3",
        "Large crank: tip deflection by ten polynomial modes",
        beale_tip.polynomial_figure(10),
        panels=(1, 2),
        size=_WIDE,
    ),
    FigureEntry(
        "beale",
        "4",
        "Large crank: the setting, and the tip deflection's components",
        beale_setting.figure_4,
        panels=(1, 3),
        size=(12.0, 4.2),
    ),
    FigureEntry(
        "beale",
        "5",
        "Large crank: ten polynomial modes with 0.002 damping",
        beale_tip.figure_5,
        panels=(1, 2),
        size=_WIDE,
    ),
    FigureEntry(
        "beale",
        "7",
        "Small crank: tip deflection by one, two and three free-free modes",
        beale_free_free.figure_7,
        panels=(2, 1),
        size=(7.2, 6.0),
    ),
    *(
        FigureEntry(
            "beale",
            str(figure),
            f"Large crank: tip deflection by {name}",
            beale_free_free.large_crank_figure(modes),
            panels=(1, 2),
            size=_WIDE,
        )
        for figure, modes, name in (
            (8, 1, "one free-free mode"),
            (9, 3, "three free-free modes"),
            (10, 5, "five free-free modes"),
        )
    ),
    FigureEntry(
        "beale",
        "11",
        "First natural frequency against crank angle, crank ratio 0.2",
        beale_response.figure_11,
    ),
    FigureEntry(
        "beale",
        "12",
        "Tip deflection near the mean first natural frequency, crank ratio 0.2",
        beale_response.figure_12,
        panels=(2, 1),
        size=(7.6, 6.0),
    ),
    FigureEntry(
        "beale",
        "resonances",
        "Largest steady tip deflection against the crank speed",
        beale_response.figure_resonances,
    ),
    FigureEntry(
        "beale",
        "chart",
        "Stability chart of the flexible rod over crank speed and crank ratio",
        beale_chart.figure_chart,
        panels=(2, 2),
        size=(9.0, 7.2),
    ),
)

DOCUMENTS: Mapping[str, tuple[FigureEntry, ...]] = {
    "smith": _SMITH,
    "aannaque": _AANNAQUE,
    "beale": _BEALE,
}
