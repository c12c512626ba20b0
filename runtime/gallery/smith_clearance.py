"""Smith's Figs. 8 to 10: free motion of the follower that a clearance in a coupler joint allows."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, cos, degrees, pi, radians, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput
from ..linkages import FourBar
from ..linkages.clearance import clearance_range
from ..linkages.transmission import transmission_angle
from .records import Drawn, Quoted
from .sketches import GROUND, LINK_COLOURS, Array, arc, bar, canvas, pin, pivot, write
from .smith_linkages import four_bar_of
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SCENE = "smith_1972_10_8_10_10"
_ROUND_OFF = 1e-11
_CLEARANCES = (0.05, 0.1, 0.2, 0.4)
# Lengths of the schematic figures, chosen so that the angles asked for are reached.
_GENERAL = FourBar(frame=10.0, crank=4.0, coupler=9.0, follower=7.0)
_IN_LINE = FourBar(frame=16.0, crank=8.0, coupler=7.0, follower=8.0)
_SQUARE = FourBar(frame=10.0, crank=4.0, coupler=10.0, follower=6.0)
_ANGLE = radians(70.0)
_SHOWN = 1.6


def _with_coupler(linkage: FourBar, change: float, assembly: str = "open") -> FourBar:
    """Return the linkage whose coupler is longer: what a clearance taken up amounts to."""
    sizes = (linkage.frame, linkage.crank, linkage.coupler + change, linkage.follower)
    return FourBar(*sizes, assembly="crossed" if assembly == "crossed" else "open")


def _phi(linkage: FourBar, theta: ArrayLike) -> Array:
    """Return the angle BDC."""
    motion = linkage.motion(theta)
    joints = motion.joints
    to_crank = joints["B"] - joints["D"]
    turned = np.arctan2(to_crank[..., 1], to_crank[..., 0]) - motion.theta4
    return np.asarray(np.abs(np.angle(np.exp(1j * turned))))


def _movements(linkage: FourBar, theta: ArrayLike, c: float) -> tuple[Array, Array]:
    """Return delta phi' and delta phi'' of an open linkage: its follower turns back, and on."""
    found = clearance_range(linkage, c, theta)
    return found.below, found.above


def _distance(linkage: FourBar, theta: float) -> float:
    joints = linkage.motion(theta).joints
    return float(np.hypot(*(joints["B"] - joints["D"])))


def _reach(linkage: FourBar, distance: float) -> float:
    """Return the crank angle at which B is so far from D."""
    l1, l2 = linkage.frame, linkage.crank
    return acos((l1**2 + l2**2 - distance**2) / (2.0 * l1 * l2))


def figure_8(axes: Sequence[Axes]) -> Drawn:
    """Draw the nominal position and the two extremes for one crank angle."""
    ax = axes[0]
    canvas(ax)
    places = _draw_extremes(ax, _GENERAL, _ANGLE, _SHOWN, (0.5, -0.5))
    a, b, d = places["A"], places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    ax.plot(*np.transpose([a, d]), color="0.6", lw=0.8, zorder=1)
    base = float(np.arctan2(*(b - d)[::-1]))
    for radius, name, text in (
        (2.0, "C", r"$\phi$"),
        (2.9, "C'", r"$\phi'$"),
        (1.2, "C''", r"$\phi''$"),
    ):
        arc(ax, d, radius, (base, float(np.arctan2(*(places[name] - d)[::-1]))), text)
    arc(ax, a, 1.1, (0.0, _ANGLE), r"$\theta_2$")
    note = (
        f"Lengths {_sizes(_GENERAL)}, crank angle {degrees(_ANGLE):g} deg and a clearance of "
        f"{_SHOWN:g}, exaggerated; the figure states none of them. Solid: nominal; the circles are "
        "the hole of the coupler, in which the follower's pin C lies anywhere."
    )
    return Drawn(tuple(_general_rows()), (note,))


def _sizes(linkage: FourBar) -> str:
    return f"({', '.join(f'{value:g}' for value in linkage.lengths.values())})"


def _draw_extremes(
    ax: Axes, linkage: FourBar, theta: float, c: float, shares: Sequence[float]
) -> dict[str, Array]:
    """Draw the linkage with a clearance taken up by shares of it; return the joints."""
    from matplotlib.patches import Circle

    joints = {name: np.asarray(place) for name, place in linkage.motion(theta).joints.items()}
    a, b, d = (joints[name] for name in "ABD")
    follower = {"C": joints["C"]}
    for share, name in zip(shares, ("C'", "C''"), strict=False):
        follower[name] = np.asarray(
            _with_coupler(linkage, share * c).motion(theta).joints["C"], dtype=float
        )
    for name, c_place in follower.items():
        nominal = name == "C"
        alpha, style = (1.0, "-") if nominal else (0.6, (0, (3.5, 1.5)))
        end = b + linkage.coupler * (c_place - b) / np.hypot(*(c_place - b))
        bar(ax, b, end, LINK_COLOURS["coupler"], lw=2.4, alpha=alpha, ls=style, zorder=3)
        bar(ax, d, c_place, LINK_COLOURS["follower"], lw=2.4, alpha=alpha, ls=style, zorder=3)
        hole = Circle((float(end[0]), float(end[1])), 0.5 * c, fill=False, lw=0.9, alpha=alpha)
        hole.set_edgecolor(LINK_COLOURS["coupler"])
        hole.set_zorder(4)
        ax.add_patch(hole)
        ax.update_datalim([end - 0.5 * c, end + 0.5 * c])
        pin(ax, c_place, size=4.5)
        shift = {"C": (0.0, 17.0), "C'": (16.0, 4.0), "C''": (-16.0, 6.0)}[name]
        write(ax, c_place, name, shift, style="italic")
    bar(ax, a, b, LINK_COLOURS["crank"], zorder=3)
    for place, name, side in ((a, "A", -16.0), (d, "D", 16.0)):
        pivot(ax, place, 0.09 * linkage.frame)
        write(ax, place, name, (side, 4.0), style="italic")
    pin(ax, b)
    write(ax, b, "B", (-11.0, 9.0), style="italic")
    return {**joints, **follower}


def _general_rows() -> list[Quoted]:
    """Return (3.1) to (3.3) beside the range that is computed, and beside other linkages."""
    l3, l4 = _GENERAL.coupler, _GENERAL.follower
    distance, phi = _distance(_GENERAL, _ANGLE), float(_phi(_GENERAL, _ANGLE))
    c = 0.2
    rows = []
    for number, sign, move in zip(
        ("3.1", "3.2"), (1.0, -1.0), _movements(_GENERAL, _ANGLE, c), strict=True
    ):
        printed = (l3 * c + sign * c**2 / 4.0) / (2.0 * distance * l4)
        coupler = "longer" if sign > 0 else "shorter"
        other = float(_phi(_with_coupler(_GENERAL, 0.5 * sign * c), _ANGLE))
        for route, angle in (
            ("", phi + sign * float(move)),
            (f", linkage with a {coupler} coupler", other),
        ):
            rows.append(
                Quoted(
                    f"difference of the cosines by ({number}), clearance 0.2{route}",
                    printed,
                    sign * (cos(phi) - cos(angle)),
                    _ROUND_OFF,
                    "round-off",
                    "3",
                )
            )
    for small in (0.2, 0.02):
        total = float(sum(_movements(_GENERAL, _ANGLE, small)))
        printed = l3 * small / (distance * l4 * sin(phi))
        rows.append(
            Quoted(
                f"delta phi by (3.3) with clearance {small:g}",
                degrees(printed),
                degrees(total),
                degrees(printed) * (small / l4) ** 2,
                "second order: the square of the clearance over the follower",
                "3",
                unit="deg",
            )
        )
    return rows


def figure_9a(axes: Sequence[Axes]) -> Drawn:
    """Draw the extreme position in which coupler and follower lie in one line."""
    ax = axes[0]
    canvas(ax)
    l3, l4 = _IN_LINE.coupler, _IN_LINE.follower
    theta, c = _reach(_IN_LINE, l3 + l4), 0.8
    b = _IN_LINE.crank * np.array([cos(theta), sin(theta)])
    d = np.array([_IN_LINE.frame, 0.0])
    middle = d + l4 * (b - d) / (l3 + l4)
    bar(ax, b, middle, LINK_COLOURS["coupler"], zorder=3)
    bar(ax, d, middle, LINK_COLOURS["follower"], zorder=3)
    bar(ax, (0.0, 0.0), b, LINK_COLOURS["crank"], zorder=3)
    base = float(np.arctan2(*(b - d)[::-1]))
    for name, assembly in (("C'", "open"), ("C''", "crossed")):
        moved = _with_coupler(_IN_LINE, 0.5 * c, assembly).motion(theta)
        at = np.asarray(moved.joints["C"])
        for start, link in ((b, "coupler"), (d, "follower")):
            bar(ax, start, at, LINK_COLOURS[link], lw=1.8, alpha=0.6, ls=(0, (3.5, 1.5)))
        pin(ax, at, size=4.5)
        up = assembly == "open"
        write(ax, at, name, (6.0, 12.0) if up else (-6.0, -12.0), style="italic")
        if up:
            arc(ax, d, 0.45 * l4, (base, float(moved.theta4)), r"$\phi'$")
    for place, name, shift in (((0.0, 0.0), "A", -16.0), (d, "D", 16.0)):
        pivot(ax, place, 1.3)
        write(ax, place, name, (shift, 4.0), style="italic")
    pin(ax, b, middle)
    write(ax, b, "B", (-11.0, 9.0), style="italic")
    write(ax, middle, "C", (10.0, 8.0), style="italic")
    note = (
        f"Lengths {_sizes(_IN_LINE)} and a clearance of {c:g}, exaggerated; the figure states "
        "none. Either side of the line is reached with the coupler at its longest."
    )
    return Drawn(tuple(_in_line_rows(theta)), (note,))


def _in_line_rows(theta: float) -> list[Quoted]:
    l3, l4, c = _IN_LINE.coupler, _IN_LINE.follower, 0.1
    printed = 1.0 - (l3 * c + c**2 / 4.0) / (2.0 * l4 * (l3 + l4))
    shorter = 1.0 + (l3 * c - c**2 / 4.0) / (2.0 * l4 * (l3 + l4))
    back, on = (float(move) for move in _movements(_IN_LINE, theta, c))
    rows = [
        Quoted(
            f"cos phi{mark} in the extreme position, clearance 0.1",
            printed,
            cos(move),
            _ROUND_OFF,
            meaning,
            "3",
        )
        for mark, move, meaning in (
            ("'", back, "round-off"),
            ("''", on, "'similar': the other side of the line, round-off"),
        )
    ]
    return [
        *rows,
        Quoted(
            "cos phi'' by (3.2) with phi = 0",
            1.0,
            shorter,
            0.0,
            "a cosine",
            "3",
            relation="<",
            differs="BD = l3 + l4 is out of reach of a shorter coupler, for which (3.2) stands "
            f"({_refusal(theta, c)}): both extremes belong to the longer one and to (3.1)",
        ),
        Quoted(
            "delta phi' with clearance 0.1 over that with 0.025",
            2.0,
            back / float(_movements(_IN_LINE, theta, 0.25 * c)[0]),
            0.01,
            "the root of the clearance, as the cosine's series begins with the square",
            "3",
        ),
    ]


def _refusal(theta: float, c: float) -> str:
    """Say that the linkage with the shorter coupler cannot be assembled at this crank angle."""
    try:
        _with_coupler(_IN_LINE, -0.5 * c).motion(theta)
    except BadInput:
        return "that linkage is refused here"
    return "that linkage closes here"


def figure_9b(axes: Sequence[Axes]) -> Drawn:
    """Draw the position in which BD and the follower are square."""
    ax = axes[0]
    canvas(ax)
    l3, l4 = _SQUARE.coupler, _SQUARE.follower
    theta = _reach(_SQUARE, sqrt(l3**2 - l4**2))
    places = _draw_extremes(ax, _SQUARE, theta, 1.4, (0.5,))
    b, d = places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    base = float(np.arctan2(*(b - d)[::-1]))
    side = 0.55
    first, second = (side * (place - d) / np.hypot(*(place - d)) for place in (b, places["C"]))
    ax.plot(*np.transpose([d + first, d + first + second, d + second]), color=GROUND, lw=0.9)
    arc(ax, d, 2.6, (base, float(np.arctan2(*(places["C'"] - d)[::-1]))), r"$\phi'$")
    note = f"Lengths {_sizes(_SQUARE)} and a clearance of 1.4, exaggerated; the figure states none."
    rows = []
    for c in (0.1, 0.01):
        sine = (l3 * c + c**2 / 4.0) / (2.0 * sqrt(l3**2 - l4**2) * l4)
        move = float(_movements(_SQUARE, theta, c)[0])
        rows += [
            Quoted(
                f"sin delta phi' with clearance {c:g}",
                sine,
                sin(move),
                _ROUND_OFF,
                "round-off",
                "3",
            ),
            Quoted(
                f"delta phi' itself, clearance {c:g}, by the approximate equation",
                degrees(sine),
                degrees(move),
                degrees(sine**3),
                "the sine's third power",
                "3",
                unit="deg",
            ),
        ]
    return Drawn(tuple(rows), (note,))


def figure_10(axes: Sequence[Axes]) -> Drawn:
    """Draw the free motion of the follower over the crank angle for several clearances."""
    ax, own = axes[0], four_bar_of(SCENE)
    unit = own.frame / 10.0
    theta = np.linspace(0.0, 2.0 * pi, 3601)
    moves, apart = {}, 0.0
    for c, colour in zip(_CLEARANCES, COLOURS, strict=False):
        found = clearance_range(own, c * unit, theta)
        moves[c] = found.below, found.above
        apart = max(apart, degrees(float(np.max(np.abs(found.width - found.small)))))
        ax.plot(np.degrees(theta), np.degrees(found.width), color=colour, label=f"c = {c:g}")
        ax.plot(np.degrees(theta), np.degrees(found.small), ":", color="0.15", lw=1.1, zorder=5)
    ax.plot([], [], ":", color="0.15", lw=1.1, label="small clearance, (3.3)")
    crank_axis(ax)
    ax.set_ylim(0.0, 14.0)
    ax.set_ylabel(r"free motion $\delta\phi$ [deg]")
    legend_below([ax], columns=5)
    note = (
        "The clearances are not legible; taken as 0.05, 0.1, 0.2 and 0.4, the links being 10, 8, "
        "10, 10. Drawn is the whole free motion, delta phi' + delta phi''. The dotted "
        f"lines of (3.3) lie on the solid ones, at most {apart:.2g} deg apart."
    )
    rows = [*_extreme_rows(theta, moves), *_transmission_rows(own, theta, moves), *_always_rows()]
    rows.append(_crank_pin_row(own, unit))
    return Drawn(tuple(rows), (note,))


def _crank_pin_row(own: FourBar, unit: float) -> Quoted:
    """Return the free motion with the clearance at B, by trial, less that with it at C."""
    theta, c = np.radians(np.arange(0.0, 360.0, 30.0)), _CLEARANCES[-1] * unit
    joints = own.motion(theta).joints
    trial = np.exp(1j * np.linspace(0.0, 2.0 * pi, 7201))
    way = (joints["B"] - joints["D"]) @ np.array([1.0, 1.0j])
    moved = way[:, np.newaxis] + 0.5 * c * trial
    size = np.abs(moved)
    inner = (size**2 + own.follower**2 - own.coupler**2) / (2.0 * size * own.follower)
    # Seen from the nominal direction of DB, so that no angle passes half a turn.
    turned = np.angle(moved / way[:, np.newaxis]) - np.arccos(inner)
    gap = np.ptp(turned, axis=1) - clearance_range(own, c, theta, joint="34").width
    return Quoted(
        "free motion with the clearance at B less that with it at C",
        0.0,
        degrees(float(gap[int(np.argmax(np.abs(gap)))])),
        1e-4,
        "7200 directions of the gap at B, twelve crank angles: the square of half a step",
        "3",
        unit="deg",
    )


def _extreme_rows(theta: Array, moves: dict[float, tuple[Array, Array]]) -> list[Quoted]:
    rows = []
    for c, (longer, _) in moves.items():
        at = degrees(theta[int(np.argmax(longer[:-1]))])
        rows.append(
            Quoted(
                f"crank angle of the greatest delta phi', c = {c:g}",
                0.0,
                (at + 180.0) % 360.0 - 180.0,
                0.05,
                "half a step of the angles",
                "3",
                unit="deg",
            )
        )
    longer = next(iter(moves.values()))[0]
    near = np.abs(theta - pi) < radians(60.0)
    rows.append(
        Quoted(
            "crank angle of the local maximum",
            180.0,
            degrees(theta[near][int(np.argmax(longer[near]))]),
            0.05,
            "half a step of the angles",
            "3",
            unit="deg",
        )
    )
    return rows


def _transmission_rows(
    own: FourBar, theta: Array, moves: dict[float, tuple[Array, Array]]
) -> list[Quoted]:
    found = transmission_angle(own)
    c = _CLEARANCES[0]
    longer, shorter = moves[c]
    mu = own.motion(theta).transmission_angle
    square = int(np.argmin(np.abs(mu - pi / 2.0)[: len(mu) // 2]))
    printed = c * own.frame / 10.0 / (own.follower * np.sin(mu[square]))
    least = int(np.argmin((longer + shorter)[: len(mu) // 2]))
    rows = [
        Quoted(
            f"{name} transmission angle",
            90.0,
            degrees(value),
            0.0,
            "'respectively < 90 and > 90'",
            "3",
            relation="<" if name == "least" else ">",
            unit="deg",
        )
        for name, value in (("least", found.least), ("greatest", found.greatest))
    ]
    return [
        *rows,
        Quoted(
            "crank angle of the least free motion: that of a transmission angle of 90 deg",
            degrees(theta[square]),
            degrees(theta[least]),
            1.0,
            "as c goes to 0; c = 0.05 here",
            "3",
            unit="deg",
        ),
        Quoted(
            "delta phi' by c/(l4 sin mu) over the exact one, mu = 90 deg",
            1.0,
            printed / float(longer[square]),
            0.01,
            "first order in the clearance: a hundredth",
            "3",
            differs="c/(l4 sin mu) is delta phi, both sides together; delta phi' is half of it",
        ),
        Quoted(
            "the same over the exact delta phi' + delta phi''",
            1.0,
            printed / float(longer[square] + shorter[square]),
            1e-3,
            "second order in the clearance",
            "3",
        ),
    ]


def _always_rows() -> list[Quoted]:
    """Return the case in which the transmission angle stays below 90 degrees."""
    theta = np.linspace(0.0, 2.0 * pi, 3601)
    rows = []
    for crank, inside in ((4.0, True), (4.3, False)):
        linkage = FourBar(frame=10.0, crank=crank, coupler=10.0, follower=10.0)
        greatest = degrees(transmission_angle(linkage).greatest)
        rows.append(
            Quoted(
                f"greatest transmission angle of (10, {crank:g}, 10, 10)",
                90.0,
                greatest,
                0.0,
                f"(l1 + l2)^2 {'<' if inside else '>'} l3^2 + l4^2",
                "3",
                relation="<" if inside else ">",
                unit="deg",
            )
        )
    longer = _movements(FourBar(10.0, 4.0, 10.0, 10.0), theta, 0.05)[0]
    rows.append(
        Quoted(
            "crank angle of the least delta phi' of (10, 4, 10, 10)",
            180.0,
            degrees(theta[int(np.argmin(longer))]),
            0.05,
            "half a step of the angles",
            "3",
            unit="deg",
        )
    )
    return rows
