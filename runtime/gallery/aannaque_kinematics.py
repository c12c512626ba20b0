"""Aannaque's Figs. 3.6 to 3.10: assemblies, rates, transmission angle, coupler curves."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import atan, cos, degrees, pi, radians, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from ..linkages import FourBar, FourBarMotion
from ..linkages.curves import CouplerCurve, coupler_curve
from ..linkages.transmission import TransmissionAngle, transmission_angle
from .records import Drawn, Quoted
from .sketches import Array, arc, bar, canvas, four_bar, pin, pivot, write
from .smith_linkages import four_bar_of
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SCENE = "aannaque_1996_table_3_2"
_INPUT = radians(130.0)
_ROUND_OFF = 1e-11


@lru_cache(maxsize=1)
def linkage() -> FourBar:
    """Return the linkage of Table 3.2."""
    return four_bar_of(SCENE)


def cycle(frame: float | None = None) -> FourBarMotion:
    """Return one turn, a tenth of a degree apart, of the linkage or one with another frame."""
    own = linkage()
    chosen = own if frame is None else FourBar(frame, own.crank, own.coupler, own.follower)
    return chosen.motion(np.linspace(0.0, 2.0 * pi, 3601))


def figure_3_6(axes: Sequence[Axes]) -> Drawn:
    """Draw both assemblies at one crank angle."""
    ax, own = axes[0], linkage()
    canvas(ax)
    unit = 0.1 * own.frame
    other = FourBar(own.frame, own.crank, own.coupler, own.follower, assembly="crossed")
    both = [item.motion(_INPUT) for item in (own, other)]
    a, b, _, d = (np.asarray(both[0].joints[name]) for name in "ABCD")
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    for motion, name, style in zip(both, ("B", "B'"), ("-", (0, (3, 1.2))), strict=True):
        c = np.asarray(motion.joints["C"])
        bar(ax, b, c, "#1f5a8c", ls=style, zorder=3)
        bar(ax, d, c, "#3a7d44", ls=style, zorder=3)
        pin(ax, c)
        write(ax, c, name, (12.0, 10.0 if name == "B" else -10.0), style="italic")
    bar(ax, a, b, "#c8641e", zorder=4)
    for place, name, shift in ((a, "O", -16.0), (d, "C", 16.0)):
        pivot(ax, place, unit)
        write(ax, place, name, (shift, 4.0), style="italic")
    pin(ax, b)
    write(ax, b, "A", (-10.0, 10.0), style="italic")
    ax.plot([0.0, 0.12 * own.frame], [0.0, 0.0], color="0.35", lw=0.8)
    arc(ax, a, 0.07 * own.frame, (0.0, _INPUT), "$t_1$")
    note = (
        f"The input angle is not stated; drawn at {degrees(_INPUT):g} deg. Solid: open assembly, "
        "dashed: crossed; the dotted line joins crank pin and follower pivot."
    )
    return Drawn(tuple(_assembly_rows(both)), (note,))


def _printed_angles(theta: float) -> tuple[list[float], list[float]]:
    """Return t3 by (3.6) and t2 by (3.8), as printed, with either sign of the root."""
    own = linkage()
    r2, r3, r4 = (part / own.crank for part in (own.coupler, own.follower, own.frame))
    k1, k2, k4 = r4, r4 / r3, r4 / r2
    k3 = (1.0 - r2**2 + r3**2 + r4**2) / (2.0 * r3)
    k5 = (r3**2 - r4**2 - 1.0 - r2**2) / (2.0 * r2)
    found = []
    for first, last in (
        ((1.0 - k2) * cos(theta) + k3 - k1, k1 + k3 - (1.0 + k2) * cos(theta)),
        ((1.0 + k4) * cos(theta) + k5 - k1, k1 + (k4 - 1.0) * cos(theta) + k5),
    ):
        root = sqrt(4.0 * sin(theta) ** 2 - 4.0 * first * last)
        found.append(
            [2.0 * atan((2.0 * sin(theta) + sign * root) / (2.0 * first)) for sign in (1.0, -1.0)]
        )
    return found[0], found[1]


def _assembly_rows(both: Sequence[FourBarMotion]) -> list[Quoted]:
    follower, coupler = _printed_angles(_INPUT)
    rows = []
    for name, printed, angles in (
        ("t3 by (3.6)", follower, [float(m.theta4) for m in both]),
        ("t2 by (3.8)", coupler, [float(m.theta3) for m in both]),
    ):
        gaps = [min(abs(np.angle(np.exp(1j * (p - q)))) for p in printed) for q in angles]
        rows.append(
            Quoted(
                f"{name}, worse of its two values, less the assemblies'",
                0.0,
                degrees(max(gaps)),
                _ROUND_OFF,
                "round-off",
                "3.5",
                unit="deg",
            )
        )
    gammas = [degrees(float(m.transmission_angle)) for m in both]
    rows.append(
        Quoted(
            "transmission angles of the two, difference",
            0.0,
            gammas[1] - gammas[0],
            _ROUND_OFF,
            "(3.9) holds for both: round-off",
            "3.5",
            unit="deg",
        )
    )
    return rows


def figure_3_7(axes: Sequence[Axes]) -> Drawn:
    """Draw speeds of coupler and follower over the crank's."""
    motion = cycle()
    _rates(axes[0], motion, "omega", "relative angular velocity")
    t1, t2, t3 = motion.theta2, motion.theta3, motion.theta4
    own = linkage()
    printed = {
        "omega2": -own.crank * np.sin(t3 - t1) / (own.coupler * np.sin(t3 - t2)),
        "omega3": -own.crank * np.sin(t2 - t1) / (own.follower * np.sin(t3 - t2)),
    }
    rows = _rate_rows(printed, motion, ("omega3", "omega4"))
    return Drawn((*rows, *_advantage_rows(own)))


def _advantage_rows(own: FourBar) -> list[Quoted]:
    """Return (3.1) at the input angle of Fig. 3.6, as printed and as it must be."""
    motion = own.motion(_INPUT)
    beta = float(motion.theta3 - motion.theta2)
    sines = abs(sin(float(motion.transmission_angle)) / sin(beta))
    ratio = abs(1.0 / float(motion.omega4))
    rows = []
    for name, length, differs in (
        ("L3 sin(gamma)/(L4 sin(beta))", own.frame, _NOT_FRAME),
        ("L3 sin(gamma)/(L1 sin(beta))", own.crank, ""),
    ):
        rows.append(
            Quoted(
                f"{name} less omega1/omega3, input angle {degrees(_INPUT):g} deg",
                0.0,
                own.follower * sines / length - ratio,
                _ROUND_OFF,
                "round-off; (3.1)",
                "3.3",
                differs=differs,
            )
        )
    return rows


_NOT_FRAME = "the length below is the input link's, L1: the frame's L4 has no part in the ratio"


def figure_3_8(axes: Sequence[Axes]) -> Drawn:
    """Draw accelerations of coupler and follower over the crank's speed squared."""
    motion = cycle()
    _rates(axes[0], motion, "alpha", "relative angular acceleration")
    t1, t2, t3, own = motion.theta2, motion.theta3, motion.theta4, linkage()
    w2, w3 = motion.omega3**2, motion.omega4**2
    printed = {
        "alpha2": (
            own.crank * np.cos(t3 - t1) + own.coupler * w2 * np.cos(t3 - t2) - own.follower * w3
        )
        / (own.coupler * np.sin(t3 - t2)),
        "alpha3": (
            own.crank * np.cos(t2 - t1) - own.follower * w3 * np.cos(t2 - t3) + own.coupler * w2
        )
        / (own.follower * np.sin(t3 - t2)),
    }
    rows = _rate_rows(printed, motion, ("alpha3", "alpha4"))
    return Drawn((*rows, *_jump_rows(motion)), (_JUMP_NOTE,))


_JUMP_NOTE = (
    "The sudden variation that section 7.5 sees here is the rise of the follower's acceleration "
    "from its trough, 28 deg before the input angle 0, to its peak, 43 deg after it."
)


def _rates(ax: Axes, motion: FourBarMotion, kind: str, label: str) -> None:
    for number, link, colour in ((3, "coupler", COLOURS[0]), (4, "follower", COLOURS[1])):
        ax.plot(
            np.degrees(motion.theta2), getattr(motion, f"{kind}{number}"), color=colour, label=link
        )
    ax.axhline(0.0, color="0.6", lw=0.8, zorder=1)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel(label)
    legend_below([ax])


def _rate_rows(
    printed: dict[str, Array], motion: FourBarMotion, names: Sequence[str]
) -> list[Quoted]:
    rows = []
    for (name, values), own in zip(printed.items(), names, strict=True):
        gap = values - getattr(motion, own)
        rows.append(
            Quoted(
                f"{name} by (3.11) less the one here, worst over the cycle",
                0.0,
                float(np.max(np.abs(gap))),
                _ROUND_OFF,
                "round-off; t2 and t3 are theta3 and theta4 here",
                "3.5",
            )
        )
    return rows


def _jump_rows(motion: FourBarMotion) -> list[Quoted]:
    theta, alpha = motion.theta2[:-1], motion.alpha4[:-1]
    slope = np.gradient(motion.alpha4, motion.theta2)[:-1]
    size = np.abs(slope)
    peaks = (size >= np.roll(size, 1)) & (size > np.roll(size, -1)) & (size > 0.5 * size.max())
    rise = degrees((theta[int(np.argmax(alpha))] - theta[int(np.argmin(alpha))]) % (2.0 * pi))
    return [
        Quoted(
            "places in the cycle where the follower's acceleration changes suddenly",
            1.0,
            float(np.count_nonzero(peaks)),
            0.0,
            "peaks of |d alpha/dt1| above half the largest",
            "7.5",
        ),
        Quoted(
            "share of the cycle that the rise from trough to peak takes",
            0.25,
            rise / 360.0,
            0.0,
            "'sudden' read as less than a quarter",
            "7.5",
            relation="<",
        ),
    ]


def figure_3_9(axes: Sequence[Axes]) -> Drawn:
    """Draw the transmission angle over one cycle with the recommended band."""
    ax, own = axes[0], linkage()
    found = transmission_angle(own)
    theta = np.linspace(0.0, 2.0 * pi, 721)
    ax.axhspan(*np.degrees(found.band), color=COLOURS[2], alpha=0.10, label="recommended band")
    ax.plot(np.degrees(theta), np.degrees(found.angle(theta)), color=COLOURS[0])
    for angles, value, name in (
        ([0.0, 360.0], found.least, "least"),
        ([180.0], found.greatest, "greatest"),
    ):
        text = f"{name}: {degrees(value):.2f}°"
        ax.plot(angles, [degrees(value)] * len(angles), "o", color=COLOURS[1], ms=5)
        shift = (38.0, -12.0) if name == "least" else (0.0, 10.0)
        write(ax, (angles[0], degrees(value)), text, shift)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel(r"transmission angle $\gamma$ [deg]")
    ax.set_ylim(30.0, 150.0)
    legend_below([ax])
    return Drawn(tuple(_transmission_rows(own, found)))


def _transmission_rows(own: FourBar, found: TransmissionAngle) -> list[Quoted]:
    rows = []
    for name, angle, value, sign in (
        ("minimum", found.at_least, found.least, 1.0),
        ("maximum", found.at_greatest, found.greatest, -1.0),
    ):
        cosine = (
            own.coupler**2
            + own.follower**2
            + sign * 2.0 * own.crank * own.frame
            - own.crank**2
            - own.frame**2
        ) / (2.0 * own.coupler * own.follower)
        rows += [
            Quoted(
                f"input angle of the {name} transmission angle",
                0.0 if sign > 0 else 180.0,
                degrees(abs(float(angle[0]))),
                1e-9,
                "round-off",
                "3.5",
                unit="deg",
            ),
            Quoted(
                f"{name} transmission angle, by (3.10)",
                degrees(np.arccos(cosine)),
                degrees(value),
                _ROUND_OFF,
                "round-off",
                "3.5",
                unit="deg",
            ),
        ]
    return [
        *rows,
        Quoted(
            "least transmission angle in the recommended band",
            40.0,
            degrees(found.least),
            0.0,
            "as stated",
            "3.5",
            relation=">",
            unit="deg",
        ),
        Quoted(
            "greatest transmission angle in the recommended band",
            140.0,
            degrees(found.greatest),
            0.0,
            "as stated",
            "3.5",
            relation="<",
            unit="deg",
        ),
    ]


def _points() -> tuple[tuple[str, float, float], ...]:
    """Return the coupler points that are drawn: name, place along and across the coupler [m]."""
    length = linkage().coupler
    return (
        ("A", 0.0, 0.0),
        ("B", length, 0.0),
        ("P", 0.25 * length, 0.0),
        ("Q", 0.5 * length, 0.0),
        ("R", 0.5 * length, 0.6 * length),
        ("S", 1.3 * length, 0.5 * length),
    )


def figure_3_10(axes: Sequence[Axes]) -> Drawn:
    """Draw the mechanism at several positions, and the paths of some points of its coupler."""
    ax, own = axes[0], linkage()
    canvas(ax)
    curves = {name: coupler_curve(own, *place) for name, *place in _points()}
    start = radians(70.0)
    for k in range(1, 8):
        joints = own.motion(start + k * pi / 4.0).joints
        for ends, colour in (("AB", "#c8641e"), ("BC", "#1f5a8c"), ("DC", "#3a7d44")):
            bar(ax, joints[ends[0]], joints[ends[1]], colour, lw=1.6, alpha=0.22, zorder=2)
    for (name, curve), colour in zip(curves.items(), ("0.35", "0.35", *COLOURS[3:]), strict=False):
        closed = np.vstack([curve.position, curve.position[:1]])
        ax.plot(*closed.T, color=colour, lw=1.4, ls="--" if name in "AB" else "-", zorder=4)
    now = own.motion(start)
    joints = now.joints
    for name, *place in _points()[2:]:
        at = now.point("coupler", *place).position
        if place[1]:
            lines = np.array([joints["B"], at, joints["C"]])
            ax.plot(*lines.T, color="#1f5a8c", lw=1.0, zorder=4)
        ax.plot(*at, "o", color="0.15", ms=4.0, zorder=8)
        write(ax, at, name, (8.0, 8.0), style="italic")
    four_bar(ax, joints, 0.07 * own.frame, "OABC")
    note = (
        "The points are not stated. A and B are the coupler's pins; P and Q lie on its line at a "
        "quarter and a half of its length l, R at (0.5, 0.6) l and S at (1.3, 0.5) l of its own "
        "axes. Eight positions of the crank, 45 deg apart."
    )
    return Drawn(tuple(_curve_rows(own, curves)), (note,))


def _curve_rows(own: FourBar, curves: dict[str, CouplerCurve]) -> list[Quoted]:
    swing = transmission_angle(own).swing or 0.0
    pins = (("A", np.zeros(2), own.crank), ("B", np.array([own.frame, 0.0]), own.follower))
    off = [np.abs(np.hypot(*(curves[n].position - at).T) - r).max() for n, at, r in pins]
    return [
        Quoted(
            "paths of the pins off a circle about their pivots",
            0.0,
            float(max(off)),
            1e-12,
            "round-off",
            "3.6",
            unit="m",
        ),
        Quoted(
            "length of the crank pin's path over that of the circle",
            1.0,
            curves["A"].length / (2.0 * pi * own.crank),
            1e-9,
            "'either circles': round-off",
            "3.6",
        ),
        Quoted(
            "length of the follower pin's path over its arc, there and back",
            1.0,
            curves["B"].length / (2.0 * own.follower * swing),
            1e-9,
            "'or arcs': round-off",
            "3.6",
        ),
    ]
