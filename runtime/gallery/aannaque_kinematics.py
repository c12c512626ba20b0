"""Aannaque's chapter 3 and Fig. 7.12: solution space, assemblies, rates, paths, free bodies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from math import cos, degrees, pi, radians, sin, sqrt

import numpy as np
from scipy.optimize import brentq

from ..linkages import FourBar, FourBarMotion
from ..linkages.base_planes import base_plane
from ..linkages.classification import SYMBOLS, classify
from ..linkages.curves import coupler_curve
from ..linkages.transmission import transmission_angle
from ..rigid import rigid_forces
from ..scenes import load_scene
from . import sketch
from .aannaque_beams import FRAMES
from .drawing import COLOURS, Array, Axes, Panels, panel_title
from .records import Drawn, contents
from .smith_linkages import four_bar_of

_SCENE = "aannaque_1996_table_3_2"
# The projection of the three axes on the paper, the third upwards.
_TURN, _TILT = radians(38.0), radians(24.0)
_VIEW = np.array([[-sin(_TURN), cos(_TURN), 0.0], [0.0, 0.0, cos(_TILT)]])
_VIEW[1, :2] = -sin(_TILT) * np.array([cos(_TURN), sin(_TURN)])


def figure_3_4(axes: Panels, faces: Sequence[tuple[str, tuple[float, float]]]) -> None:
    """Draw the solution space up to a base plane, seen obliquely."""
    ax, plane = axes[0], base_plane(1.5)
    total = sqrt(3.0) * plane.lam
    ax.set_axis_off()
    ax.set_aspect("equal")
    far, near = 0.5 * (total + 1.0), 0.5 * (total - 1.0)
    for i, (name, shift) in enumerate(faces):
        corners = np.full((3, 3), 0.0)
        corners[:, i] = 1.0, far, far
        corners[1, (i + 1) % 3] = near
        corners[2, (i + 2) % 3] = near
        _face(ax, corners, COLOURS[i], 0.30)
        _call(ax, corners.mean(axis=0), name, shift)
    _face(ax, np.eye(3), COLOURS[3], 0.45)
    _call(ax, np.full(3, 1.0 / 3.0), r"$1=\lambda_2+\lambda_3+\lambda_4$", (-172, 62))
    _face(ax, plane.outline, "0.55", 0.25)
    _call(ax, total * np.array([0.08, 0.46, 0.46]), "base plane", (84, 20))
    for i, axis in enumerate(np.eye(3)):
        ends = np.array([np.zeros(3), 1.25 * far * axis]) @ _VIEW.T
        ax.plot(*ends.T, color="0.3", lw=0.9, zorder=1)
        beyond = 8.0 * ends[1] / np.hypot(*ends[1])
        sketch.write(ax, ends[1], rf"$\lambda_{i + 2}$", beyond, fontsize=11)
    line = np.array([np.zeros(3), np.full(3, plane.lam / sqrt(3.0))]) @ _VIEW.T
    ax.plot(*line.T, "--", color="0.2", lw=1.0, zorder=8)
    ax.plot(*line[1], "o", color="0.2", ms=3.5, zorder=8)
    sketch.write(ax, line[1], r"$\lambda$", (8.0, 8.0), fontsize=11)


def _face(ax: Axes, corners: Array, colour: str, alpha: float) -> None:
    flat = corners @ _VIEW.T
    ax.fill(*flat.T, facecolor=colour, alpha=alpha, edgecolor="none", zorder=2)
    ax.fill(*flat.T, facecolor="none", edgecolor=colour, lw=1.1, zorder=3)


def _call(ax: Axes, place: Array, text: str, shift: tuple[float, float]) -> None:
    """Name a face from outside, with a thin line to it."""
    line = {"arrowstyle": "-", "color": "0.4", "lw": 0.7}
    sketch.write(ax, _VIEW @ place, text, shift, arrowprops=line)


def figure_3_5(axes: Panels) -> Drawn:
    """Draw three base planes with the class of each region."""
    # Below, at and above the plane through the linkage of four equal links.
    planes = [base_plane(lam) for lam in (1.0, sqrt(3.0), 3.0)]
    for ax, plane, sign in zip(axes, planes, "<=>", strict=True):
        plane.plot(ax)
        for text in ax.texts:
            text.set_fontsize(7.0)
        for axis in (ax.xaxis, ax.yaxis):
            axis.label.set_fontsize(8.0)
        panel_title(ax, rf"$\lambda{sign}\sqrt{{3}}$: {plane.lam:.4g}")
        ax.set_title("")
        ax.grid(visible=False)
    rows = [
        (symbol, *(plane.shares.get(symbol, 0.0) for plane in planes)) for symbol in SYMBOLS[1:9]
    ]
    values = [
        len(SYMBOLS) - 1,
        len({symbol for plane in planes for symbol in plane.regions}),
        int(classify(np.ones((1, 4)))[0]),
    ]
    return Drawn(values, tables=[rows])


@lru_cache(maxsize=1)
def linkage() -> FourBar:
    """Return the linkage of Table 3.2."""
    return four_bar_of(_SCENE)


def cycle(frame: float | None = None) -> FourBarMotion:
    """Return one turn, a tenth of a degree apart, of the linkage or one with another frame."""
    bars = linkage() if frame is None else replace(linkage(), frame=frame)
    return bars.motion(np.linspace(0.0, 2.0 * pi, 3601))


def figure_3_6(axes: Panels) -> None:
    """Draw both assemblies at one crank angle."""
    ax, bars, theta = sketch.canvas(axes[0]), linkage(), radians(130.0)
    joints, crossed = bars.motion(theta).joints, replace(bars, assembly="crossed")
    a, b, d = (np.asarray(joints[name]) for name in "ABD")
    c = np.asarray(crossed.motion(theta).joints["C"])
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    for link, start in (("coupler", b), ("follower", d)):
        sketch.bar(ax, start, c, link, ls=(0, (3, 1.2)))
    sketch.pin(ax, c)
    sketch.write(ax, c, "B'", (12.0, -10.0), style="italic")
    sketch.four_bar(ax, joints, 0.1 * bars.frame, "OABC")
    ax.plot([0.0, 0.12 * bars.frame], [0.0, 0.0], color="0.35", lw=0.8)
    sketch.arc(ax, a, 0.07 * bars.frame, (0.0, theta), "$t_1$")


def rates(axes: Panels, kind: str) -> Drawn | None:
    """Draw speeds ``omega`` or accelerations ``alpha`` of both links (Figs. 3.7 and 3.8)."""
    motion = cycle()
    for number, link in ((3, "coupler"), (4, "follower")):
        rate = getattr(motion, f"{kind}{number}")
        axes[0].plot(np.degrees(motion.theta2), rate, label=link)
    if kind == "omega":
        return None
    theta, alpha = motion.theta2[:-1], motion.alpha4[:-1]
    size = np.abs(np.gradient(motion.alpha4, motion.theta2)[:-1])
    peaks = (size >= np.roll(size, 1)) & (size > np.roll(size, -1)) & (size > 0.5 * size.max())
    rise = degrees((theta[int(np.argmax(alpha))] - theta[int(np.argmin(alpha))]) % (2.0 * pi))
    return Drawn([np.count_nonzero(peaks), rise / 360.0])


def figure_3_9(axes: Panels) -> Drawn:
    """Draw the transmission angle over one cycle with the recommended band."""
    ax, bars, theta = axes[0], linkage(), np.linspace(0.0, 2.0 * pi, 721)
    mu = transmission_angle(bars)
    ax.axhspan(*np.degrees(mu.band), color=COLOURS[2], alpha=0.10, label="recommended band")
    ax.plot(np.degrees(theta), np.degrees(mu.angle(theta)), color=COLOURS[0])
    least, greatest = degrees(mu.least), degrees(mu.greatest)
    ax.plot([0.0, 180.0, 360.0], [least, greatest, least], "o", color=COLOURS[1], ms=5)
    sketch.write(ax, (0.0, least), f"least: {least:.2f}°", (38.0, -12.0))
    sketch.write(ax, (180.0, greatest), f"greatest: {greatest:.2f}°", (0.0, 10.0))
    return Drawn([least, greatest])


def figure_3_10(axes: Panels, shares: Mapping[str, tuple[float, float]]) -> None:
    """Draw the mechanism at several positions, and the paths of some points of its coupler."""
    ax, bars = sketch.canvas(axes[0]), linkage()
    first = radians(70.0)
    points = {name: bars.coupler * np.array(share) for name, share in shares.items()}
    curves = {name: coupler_curve(bars, *place) for name, place in points.items()}
    for k in range(1, 8):
        joints = bars.motion(first + k * pi / 4.0).joints
        for ends, link in (("AB", "crank"), ("BC", "coupler"), ("DC", "follower")):
            start, end = (joints[name] for name in ends)
            sketch.bar(ax, start, end, link, lw=1.6, alpha=0.22, zorder=2)
    for (name, curve), colour in zip(curves.items(), ("0.35", "0.35", *COLOURS[3:]), strict=False):
        closed = np.vstack([curve.position, curve.position[:1]])
        ax.plot(*closed.T, color=colour, lw=1.4, ls="--" if name in "AB" else "-", zorder=4)
    now = bars.motion(first)
    joints = now.joints
    for name in "PQRS":
        at = now.point("coupler", *points[name]).position
        if name in "RS":
            lines = np.array([joints["B"], at, joints["C"]])
            ax.plot(*lines.T, color=sketch.LINK_COLOURS["coupler"], lw=1.0, zorder=4)
        ax.plot(*at, "o", color="0.15", ms=4.0, zorder=8)
        sketch.write(ax, at, name, (8.0, 8.0), style="italic")
    sketch.four_bar(ax, joints, 0.07 * bars.frame, "OABC")


def free_body(axes: Panels, link: str) -> Drawn:
    """Draw one link cut free (Fig. 3.11)."""
    ax, scene = sketch.canvas(axes[0]), load_scene(_SCENE)
    machine, speed = scene.machine(), scene["operation"]["speed"]
    body = sketch.free_bodies(machine, radians(105.0), speed)[0][link]
    letters, names = contents("aannaque")["bodies"][link].values()
    largest = max(float(np.hypot(*force)) for force in body.forces)
    length = float(np.hypot(*(body.places[1] - body.places[0])))
    scale = 0.55 * length / largest
    sketch.draw_body(ax, body, letters, names, scale)
    heads = np.array(body.places) + scale * np.array(body.forces)
    low = np.min([*body.places, *heads], axis=0) - 0.22 * length
    sketch.scale_bar(ax, low, scale, largest)
    values = []
    if link == "crank":
        turn = np.linspace(0.0, 2.0 * pi, 361)
        values.append(float(np.min(rigid_forces(machine, turn, speed).torque)))
    rows = []
    for letter, force in zip(letters, body.forces, strict=True):
        name = "".join(c for c in names[letter] if c not in "${}")
        rows.append((name, *force, np.hypot(*force)))
    return Drawn(values, tables=[rows])


def figure_7_12(axes: Panels) -> Drawn:
    """Draw the follower's acceleration for several distances of the pivots."""
    ax, speed = axes[0], load_scene(_SCENE)["operation"]["speed"]
    for frame in FRAMES:
        motion = cycle(frame)
        greatest = degrees(float(np.max(motion.transmission_angle)))
        label = rf"$L_4$ = {frame:.3f} m, $\gamma_{{\max}}$ = {greatest:.0f}°"
        ax.plot(np.degrees(motion.theta2), speed**2 * motion.alpha4, label=label)
    pulses = np.array([pulses_of(frame) for frame in FRAMES])
    last = cycle(FRAMES[-1])
    later = last.theta2 > radians(90.0)
    place = last.theta2[later][int(np.argmax(np.abs(last.alpha4[later])))]
    first, second = pulses.T
    values = [degrees(float(place)), degrees(float(np.max(last.transmission_angle)))]
    values += [np.min(second[1:] / second[:-1]), second[0] / first[0], second[-1] / first[-1]]
    return Drawn([*values, crossover(), np.max(first[1:]) / first[0]])


def pulses_of(frame: float) -> tuple[float, float]:
    """Return the sizes of the first pulse (0 to 90 deg) and of the one about 180 deg."""
    motion = cycle(frame)
    turned, size = np.degrees(motion.theta2), np.abs(motion.alpha4)
    first, second = (turned < 90.0), (np.abs(turned - 180.0) < 30.0)
    return float(size[first].max()), float(size[second].max())


def crossover() -> float:
    """Return the frame length [m] at which the second pulse is as large as the first."""
    return float(brentq(lambda frame: np.diff(pulses_of(frame))[0], 0.60, 0.68, xtol=1e-9))
