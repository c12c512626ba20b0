"""Smith's Figs. 20 to 22 and 23(d): cases of balance, force and torque on the frame, offset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import degrees, radians
from typing import TYPE_CHECKING

import numpy as np

from ..linkages import Motion
from ..rigid import (
    Counterweight,
    RigidForces,
    case_counterweights,
    rigid_forces,
    with_counterweights,
)
from ..rigid.counterweights import CASES, Case
from .records import Drawn, Quoted, Table
from .sketches import INK, LINK_COLOURS, Array, bar, canvas, four_bar, write
from .smith_forces import INCH, TURN, example, example_forces, peak, polar_look
from .style import COLOURS, crank_axis, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CRANK_ANGLE = radians(60.0)
_OFFSET = 6.0 * INCH
# Steel discs half an inch thick, as the thesis states neither.
_STEEL, _THICKNESS = 7850.0, 0.5 * INCH
_POUND_MASS = 0.45359237
_NAMES: Mapping[Case, str] = {
    "a": "unbalanced",
    "b": "crank and follower balanced",
    "c": "fully balanced, 3 counterweights",
    "d": "fully balanced, 2 counterweights",
}
_DISCS = (
    "The counterweights' material and size are not stated; taken as steel discs half an inch "
    "thick, centred 6 in from the pins."
)


def _weights(
    case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS
) -> dict[str, Counterweight]:
    return case_counterweights(example()[0], case, offset, density=_STEEL, thickness=thickness)


def _forces(case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS) -> RigidForces:
    machine, speed = example()
    if case == "a":
        return example_forces()
    changed = with_counterweights(machine, _weights(case, offset, thickness).values())
    return rigid_forces(changed, TURN, speed)


@lru_cache(maxsize=8)
def _case_forces(case: Case) -> RigidForces:
    return _forces(case)


def figure_20(axes: Sequence[Axes]) -> Drawn:
    """Draw the four configurations with their counterweights to scale."""
    linkage = example()[0].linkage
    motion = linkage.motion(_CRANK_ANGLE)
    rows = []
    for ax, case in zip(axes, CASES, strict=True):
        canvas(ax)
        panel_title(ax, f"({case}) {_NAMES[case]}")
        for link, weight in _weights(case).items():
            _draw_weight(ax, motion, weight)
            rows.append(
                (
                    f"({case})",
                    link,
                    f"{weight.mass / _POUND_MASS:.4f}",
                    f"{weight.offset / INCH:.3f}",
                    f"{weight.disc_radius / INCH:.3f}",
                )
            )
        four_bar(ax, motion.joints, 0.1 * linkage.lengths["frame"])
    _same_limits(axes)
    header = ("case", "link", "mass [lb]", "offset [in]", "radius [in]")
    table = Table("Counterweights", header, tuple(rows))
    note = f"Drawn at theta2 = {degrees(_CRANK_ANGLE):g} deg, discs to scale. {_DISCS}"
    return Drawn(tuple(_balance_rows()), (note,), (table,))


def _draw_weight(ax: Axes, motion: Motion, weight: Counterweight) -> None:
    from matplotlib.patches import Circle

    colour = LINK_COLOURS[weight.link]
    start = motion.point(weight.link, 0.0).position
    centre = motion.point(weight.link, weight.along, weight.across).position
    bar(ax, start, centre, colour, lw=2.2, zorder=2)
    disc = Circle(
        (float(centre[0]), float(centre[1])),
        weight.disc_radius,
        facecolor=colour,
        alpha=0.45,
        edgecolor=INK,
        lw=0.9,
        zorder=2,
    )
    ax.add_patch(disc)
    ax.update_datalim([centre - weight.disc_radius, centre + weight.disc_radius])


def _same_limits(axes: Sequence[Axes]) -> None:
    """Give all panels the limits that hold every one of them."""
    boxes = np.array([ax.dataLim.get_points() for ax in axes])
    (left, low), (right, high) = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    edge = 0.04 * (right - left)
    for ax in axes:
        ax.set_aspect("equal", adjustable="box")
        ax.set_xlim(left - edge, right + edge)
        ax.set_ylim(low - edge, high + edge)


def _balance_rows() -> list[Quoted]:
    unbalanced = peak(_case_forces("a").shaking_force)[0]
    rows = []
    plans: tuple[tuple[Case, int], ...] = (("b", 2), ("c", 3), ("d", 2))
    for case, count in plans:
        rows.append(
            Quoted(
                f"counterweights in case ({case})",
                float(count),
                float(len(_weights(case))),
                0.0,
                "a count",
                "5",
            )
        )
        if case != "b":
            left = peak(_case_forces(case).shaking_force)[0] / unbalanced
            text = f"force on the frame left in case ({case}), over case (a)"
            rows.append(Quoted(text, 0.0, left, 1e-12, "round-off", "5"))
    rows += [
        Quoted(
            f"least growth of the peak {name} in cases (b) to (d), ratio",
            1.0,
            min(_growth(case, names) for case, _ in plans),
            0.0,
            f"'adverse effects' upon {what}",
            "5",
            relation=">",
        )
        for name, what, names in (
            ("pin force", "the individual pin forces", ("f12", "f23", "f34", "f41")),
            ("driving torque", "the torque developed", ("torque",)),
        )
    ]
    # The two masses at B and C have the coupler's mass and centre, but not its inertia.
    coupler = example()[0].mass("coupler")
    length = example()[0].linkage.lengths["coupler"]
    replaced = coupler.along / length * length**2
    rows.append(
        Quoted(
            "inertia about B of the masses at B and C, over the coupler's",
            1.0,
            replaced / coupler.inertia,
            0.0,
            "'differs'; that the forces increase asks for more",
            "5",
            relation=">",
        )
    )
    return rows


def _growth(case: Case, names: Sequence[str]) -> float:
    """Return the least ratio of peaks to those of the unbalanced machine."""
    now, before = _case_forces(case), _case_forces("a")
    return min(peak(getattr(now, name))[0] / peak(getattr(before, name))[0] for name in names)


def figure_21(axes: Sequence[Axes]) -> Drawn:
    """Draw the force on the frame, unbalanced and partially balanced, as a polar diagram."""
    ax = axes[0]
    plans: tuple[tuple[Case, str, int, str], ...] = (
        ("a", COLOURS[0], 40, "o"),
        ("b", COLOURS[1], 120, "^"),
    )
    for case, colour, step, style in plans:
        values = _case_forces(case).shaking_force
        ax.plot(*values.T, color=colour, label=f"({case}) {_NAMES[case]}")
        marked = values[:-1:step]
        ax.plot(*marked.T, style, color=colour, ms=3.5, mfc="w" if style == "o" else colour)
        _angles(ax, values, colour)
    ax.plot(0.0, 0.0, "+", color="k")
    ax.set_aspect("equal", adjustable="datalim")
    polar_look(ax)
    ax.set_xlabel("X [N]")
    ax.set_ylabel("Y [N]")
    legend_below([ax], columns=2)
    ratio = peak(_case_forces("b").shaking_force)[0] / peak(_case_forces("a").shaking_force)[0]
    row = Quoted(
        "greatest force on the frame, partially balanced over unbalanced",
        0.5,
        ratio,
        0.05,
        "'approximately 50 %': a tenth",
        "5",
    )
    return Drawn((row,), ("Marks every 10 deg in case (a), every 30 deg in case (b).",))


def _angles(ax: Axes, values: Array, colour: str) -> None:
    for angle in (0, 60, 120, 180, 240, 300):
        place = values[4 * angle]
        way = place / (np.hypot(*place) or 1.0)
        write(ax, place, f"{angle}°", 12.0 * way, color=colour, fontsize=7)


def figure_22(axes: Sequence[Axes]) -> Drawn:
    """Draw the moment on the frame in the four cases, by (4.13) and complete."""
    for ax, title in zip(axes, ("(4.13): $l_1 Y_{41}$", "with the drive's reaction"), strict=True):
        complete = ax is axes[1]
        for case, colour in zip(CASES, COLOURS, strict=False):
            label = f"({case}) {_NAMES[case]}"
            ax.plot(np.degrees(TURN), _moment(case, complete), color=colour, label=label)
        ax.axhline(0.0, color="0.6", lw=0.8, zorder=1)
        crank_axis(ax)
        ax.set_ylabel("moment on the frame about A [N m]")
        panel_title(ax, title)
    axes[1].set_ylim(axes[0].get_ylim())
    legend_below(axes[:1], columns=2)
    note = (
        f"{_DISCS} 'Torque on the frame' is taken as (4.13), which the text's percentages fit; the "
        "complete moment is beside it. For 'the balanced case' read the unbalanced one."
    )
    return Drawn(tuple(_moment_rows()), (note,))


def _moment(case: Case, complete: bool) -> Array:
    forces = _case_forces(case)
    if complete:
        return forces.shaking_moment
    return np.asarray(example()[0].linkage.lengths["frame"] * forces["y41"])


def _moment_rows() -> list[Quoted]:
    half = "'50 %' read as 40 to 60 %"
    nearer = "'nearer 100 %' read as nearer to it than to 50 %"
    incomplete = (
        "the percentages are those of (4.13), which leaves out the reaction of the drive; the "
        "complete moment grows less"
    )
    one_sided = (
        "nearer 50 % by the greatest size, as the moment of case (a) leans to one side and that of "
        "case (c) does not; its range, greatest less least, grows as stated"
    )
    plans: tuple[tuple[Case, bool, str, float, float, str, str], ...] = (
        ("b", False, "size", 1.5, 0.1, half, ""),
        ("c", False, "size", 2.0, 0.25, nearer, one_sided),
        ("c", False, "range", 2.0, 0.25, nearer, ""),
        ("d", False, "size", 2.0, 0.25, nearer, ""),
        ("d", False, "range", 2.0, 0.25, nearer, ""),
        ("b", True, "size", 1.5, 0.1, half, incomplete),
        ("c", True, "size", 2.0, 0.25, nearer, incomplete),
        ("d", True, "size", 2.0, 0.25, nearer, ""),
    )
    rows = []
    for case, complete, measure, printed, tolerance, meaning, differs in plans:
        now, before = (_moment(name, complete) for name in (case, "a"))
        size = np.ptp if measure == "range" else lambda values: np.max(np.abs(values))
        which = "complete moment" if complete else "l1 Y41"
        kind = "range" if measure == "range" else "greatest size"
        rows.append(
            Quoted(
                f"{kind} of {which} in case ({case}) over case (a)",
                printed,
                float(size(now) / size(before)),
                tolerance,
                meaning,
                "5",
                differs=differs,
            )
        )
    return rows


def figure_23d(axes: Sequence[Axes]) -> Drawn:
    """Draw the crank-pin force for several offsets of the counterweights of case (d)."""
    ax = axes[0]
    peaks = {}
    cases = ((None, "(a) unbalanced"), (6.0, "(d)"), (3.0, "(d')"), (1.0, "(d'')"))
    for (inches, name), colour in zip(cases, COLOURS, strict=False):
        values = _forces("a").f23 if inches is None else _forces("d", inches * INCH).f23
        peaks[inches or 0.0] = peak(values)[0]
        label = name if inches is None else f"{name} offset {inches:g} in"
        ax.plot(*values.T, color=colour, label=f"{label}: {peak(values)[0]:.1f} N")
        ax.plot(*values[:-1:120].T, "o", color=colour, ms=2.6)
    ax.plot(0.0, 0.0, "+", color="k")
    ax.set_aspect("equal", adjustable="datalim")
    polar_look(ax)
    ax.set_xlabel("$X_{23}$ [N]")
    ax.set_ylabel("$Y_{23}$ [N]")
    legend_below([ax], columns=2)
    best = {part: _best_offset(part * INCH) for part in (0.25, 0.5, 1.0)}
    note = (
        "The counterweights' material and size are not stated; with point masses the force would "
        "only grow with the offset. With steel discs half an inch thick the best offset is "
        f"{best[0.5]:.2f} in (a quarter of an inch: {best[0.25]:.2f} in, one inch: "
        f"{best[1.0]:.2f} in). For pivots 'A and B' read A and D. Dots every 30 deg."
    )
    return Drawn(tuple(_offset_rows(peaks, best[0.5])), (note,))


def _best_offset(thickness: float) -> float:
    """Return the offset [in] of least peak crank-pin force in case (d)."""
    offsets = np.linspace(1.5, 5.0, 71)
    peaks = [peak(_forces("d", INCH * inches, thickness).f23)[0] for inches in offsets]
    return float(offsets[int(np.argmin(peaks))])


def _offset_rows(peaks: Mapping[float, float], best: float) -> list[Quoted]:
    rows = [
        Quoted(
            f"peak of F23 with an offset of {inches:g} in over the unbalanced one",
            1.0,
            peaks[inches] / peaks[0.0],
            0.0,
            "'an increase in the pin force'",
            "5",
            relation=">",
        )
        for inches in (1.0, 3.0, 6.0)
    ]
    rows += [
        Quoted(
            f"increase with 3 in over that with {inches:g} in",
            1.0,
            (peaks[3.0] - peaks[0.0]) / (peaks[inches] - peaks[0.0]),
            0.0,
            "'can be kept much lower'",
            "5",
            relation="<",
        )
        for inches in (1.0, 6.0)
    ]
    return [
        *rows,
        Quoted(
            "best offset",
            3.0,
            best,
            0.5,
            "'approximately 3 in'; depends on the discs, see the note",
            "5",
            unit="in",
        ),
    ]
