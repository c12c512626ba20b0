"""Smith's Figs. 11 to 23: free bodies, pin forces, cases of balance, a balanced link.

The balanced single link of chapter 5: a thin uniform rod (length L, mass M) turns about one end.
Beyond the pivot the same section goes on for ``l = delta L`` (mass ``delta M``) and carries at its
end a cylinder of mass m_c, thickness h and density rho, such that the centre of mass lies on the
pivot.  Then::

    m_c = (M/2) (1/delta - delta),  r_c = L sqrt(2 K m_c/M)
    I = M L^2 [1/3 + delta/2 - delta^3/6 + (K/4) (1/delta - delta)^2],  K = M/(2 pi L^2 h rho)
    dI/d(delta) = (M L^2/2) (1 - delta^2) [1 - K (1 + delta^2)/delta^3]

Smith prints ``M L^2 (1 + delta^2)/2`` for the two bars; they have ``M L^2 (1 + delta^3)/3``.  His
derivative, his K and ``K = delta^3/(1 + delta^2)`` follow from the latter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import degrees, pi, radians
from typing import Any

import numpy as np

from ..linkages import FourBar
from ..rigid import (
    Counterweight,
    Machine,
    MassDistribution,
    RigidForces,
    case_counterweights,
    rigid_forces,
    with_counterweights,
)
from ..rigid.counterweights import CASES, Case
from ..scenes import load_scene
from . import sketch
from .drawing import COLOURS, Array, Axes, Looks, Panels, panel_title
from .records import Drawn, contents

INCH, POUND = 0.0254, 4.4482216152605
TURN = np.linspace(0.0, 2.0 * pi, 1441)
# Discs half an inch thick, 6 in from the pins, as the thesis states none of these.
_THICKNESS, _OFFSET = 0.5 * INCH, 6.0 * INCH
_NAMES: Mapping[Case, str] = contents("smith")["cases"]


@lru_cache(maxsize=1)
def example() -> tuple[Machine, float]:
    """Return the machine of Figs. 12 to 16 and its crank speed [rad/s]."""
    scene = load_scene("smith_1972_12_6_12_12")
    return scene.machine(), float(scene["operation"]["speed"])


def _weights(
    case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS
) -> dict[str, Counterweight]:
    return case_counterweights(example()[0], case, offset, density=7850.0, thickness=thickness)


@lru_cache(maxsize=8)
def _forces(case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS) -> RigidForces:
    """Return the forces over a turn, a quarter of a degree apart."""
    machine, speed = example()
    if case != "a":
        machine = with_counterweights(machine, _weights(case, offset, thickness).values())
    return rigid_forces(machine, TURN, speed)


def peak(values: Array) -> tuple[float, float]:
    """Return the largest size of vectors over the turn, and its crank angle [deg] from 0."""
    size = np.hypot(*values.T) if values.ndim > 1 else np.abs(values)
    at = int(np.argmax(size))
    return float(size[at]), (degrees(TURN[at]) + 180.0) % 360.0 - 180.0


def figure_11(axes: Panels) -> Drawn:
    """Draw the links cut free, every force to one scale."""
    ax = sketch.canvas(axes[0])
    machine, speed = example()
    bodies, forces = sketch.free_bodies(machine, radians(30.0), speed)
    largest = max(float(np.hypot(*force)) for body in bodies.values() for force in body.forces)
    frame = machine.linkage.lengths["frame"]
    scale = 0.5 * frame / largest
    for link, body in bodies.items():
        drawn = contents("smith")["bodies"][link]
        place = frame * np.array(drawn["place"])
        sketch.draw_body(ax, body, drawn["letters"], drawn["names"], scale, place)
    ground = frame * np.array([[-0.45, -0.75], [1.95, -0.55]])
    on_frame = ((-forces.f12, "$F_{21}$"), (forces.f41, "$F_{41}$"))
    for place, (force, text) in zip(ground, on_frame, strict=True):
        sketch.pivot(ax, place, 0.1 * frame)
        sketch.arrow(ax, place, scale * np.asarray(force), COLOURS[3], text)
    sketch.scale_bar(ax, (0.15 * frame, -0.8 * frame), scale, largest)
    names = ("f12", "f23", "f34", "f41")
    rows = [(name.upper(), *(getattr(forces, name) / POUND)) for name in names]
    return Drawn(tables=[rows])


def polar(axes: Panels, joint: str) -> Drawn:
    """Draw one polar diagram of Figs. 12 to 16."""
    ax, forces = axes[0], _forces("a")
    forces.plot(ax, joint)
    ax.set_title("")
    _cross(ax)
    values = [peak(forces.shaking_force if joint == "frame" else getattr(forces, f"f{joint}"))[1]]
    if joint == "12":
        motion: Any = example()[0].linkage.motion(TURN)
        values += [peak(motion.alpha3)[1], peak(motion.alpha4)[1]]
    return Drawn(values)


def _cross(ax: Axes) -> None:
    """Draw the lines through the origin of a polar diagram, in equal scales, with room around."""
    ax.axhline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.axvline(0.0, color="0.75", lw=0.8, zorder=1)
    ax.plot(0.0, 0.0, "+", color="k")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.12)
    ax.autoscale_view()


def _hodograph(ax: Axes, force: Array, colour: str, label: str) -> None:
    """Draw a force over the turn with dots every 30 degrees of crank angle, the open one at 0."""
    ax.plot(*force.T, color=colour, label=label)
    ax.plot(*force[:-1:120].T, "o", color=colour, ms=2.6)
    ax.plot(*force[0], "o", mfc="w", mec=colour, ms=5.0)


def family(
    axes: Panels, frame: float, coupler: float, follower: float, cranks: Sequence[float]
) -> Drawn:
    """Draw the follower-frame force of linkages that differ in the crank [in], Figs. 17 to 19."""
    peaks, accelerations = [], []
    machine, speed = example()
    per_length = machine.mass("coupler").mass / machine.linkage.lengths["coupler"]
    for crank, colour in zip(cranks, COLOURS, strict=False):
        linkage = FourBar(INCH * frame, INCH * crank, INCH * coupler, INCH * follower)
        masses = {
            link: MassDistribution.uniform_bar(per_length * length, length)
            for link, length in linkage.lengths.items()
            if link != "frame"
        }
        force = rigid_forces(Machine(linkage, masses), TURN, speed, outputs=("pins",)).f41
        peaks.append(peak(force)[0])
        accelerations.append(float(np.max(np.abs(linkage.motion(TURN).alpha4))))
        name = f"({frame:g}, {crank:g}, {coupler:g}, {follower:g})"
        _hodograph(axes[0], force, colour, f"{name}: {peaks[-1]:.1f} N")
    _cross(axes[0])
    powers = np.diff(np.log([accelerations, peaks])) / np.diff(np.log(cranks))
    return Drawn(list(np.min(powers, axis=1)))


def figure_20(axes: Panels) -> Drawn:
    """Draw the four configurations with their counterweights to scale."""
    from matplotlib.patches import Circle

    linkage = example()[0].linkage
    motion = linkage.motion(radians(60.0))
    rows = []
    for ax, case in zip(axes, CASES, strict=True):
        sketch.canvas(ax)
        panel_title(ax, f"({case}) {_NAMES[case]}")
        for link, weight in _weights(case).items():
            colour, radius = sketch.LINK_COLOURS[link], weight.disc_radius
            start = motion.point(link, 0.0).position
            centre = motion.point(link, weight.along, weight.across).position
            sketch.bar(ax, start, centre, link, lw=2.2, zorder=2)
            look: dict[str, Any] = {"facecolor": colour, "edgecolor": sketch.INK, "lw": 0.9}
            ax.add_patch(Circle(tuple(centre), radius, zorder=2, alpha=0.45, **look))
            ax.update_datalim([centre - radius, centre + radius])
            sizes = (weight.offset / INCH, weight.disc_radius / INCH)
            rows.append((f"({case})", link, weight.mass / 0.45359237, *sizes))
        sketch.four_bar(ax, motion.joints, 0.1 * linkage.lengths["frame"])
    # All panels have the limits that hold every one of them.
    boxes = np.array([ax.dataLim.get_points() for ax in axes])
    (left, low), (right, high) = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    edge = 0.04 * (right - left)
    for ax in axes:
        ax.set_aspect("equal", adjustable="box")
        ax.set(xlim=(left - edge, right + edge), ylim=(low - edge, high + edge))

    def growth(*names: str) -> float:
        return min(
            peak(getattr(_forces(case), name))[0] / peak(getattr(_forces("a"), name))[0]
            for case in CASES[1:]
            for name in names
        )

    values = [float(len(_weights(case))) for case in CASES[1:]]
    values += [growth("f12", "f23", "f34", "f41"), growth("torque")]
    # The two masses at B and C have the coupler's mass and centre, but not its inertia.
    coupler, length = example()[0].mass("coupler"), linkage.lengths["coupler"]
    return Drawn([*values, coupler.along / length * length**2 / coupler.inertia], tables=[rows])


def figure_21(axes: Panels, looks: Looks) -> Drawn:
    """Draw the force on the frame, unbalanced and partially balanced, as a polar diagram."""
    ax = axes[0]
    for case, colour, step, look in zip(CASES[:2], COLOURS, (40, 120), looks, strict=False):
        values = _forces(case).shaking_force
        ax.plot(*values.T, color=colour, label=f"({case}) {_NAMES[case]}")
        ax.plot(*values[:-1:step].T, color=colour, **look)
        for angle in (0, 60, 120, 180, 240, 300):
            place = values[4 * angle]
            way = place / (np.hypot(*place) or 1.0)
            sketch.write(ax, place, f"{angle}°", 12.0 * way, color=colour, fontsize=7)
    _cross(ax)
    return Drawn([peak(_forces("b").shaking_force)[0] / peak(_forces("a").shaking_force)[0]])


def figure_22(axes: Panels) -> Drawn:
    """Draw the moment on the frame in the four cases, by (4.13) and complete."""
    frame = example()[0].linkage.lengths["frame"]
    moments = {case: (frame * _forces(case)["y41"], _forces(case).shaking_moment) for case in CASES}
    for case, both in moments.items():
        for ax, moment in zip(axes, both, strict=True):
            ax.plot(np.degrees(TURN), moment, label=f"({case}) {_NAMES[case]}")
    axes[1].set_ylim(axes[0].get_ylim())
    # Each case over case (a): the greatest size by (4.13) and complete, the range by (4.13).
    size = {
        case: np.max(np.abs(both), axis=1) / np.max(np.abs(moments["a"]), axis=1)
        for case, both in moments.items()
    }
    span = {case: np.ptp(both[0]) / np.ptp(moments["a"][0]) for case, both in moments.items()}
    printed = [size["b"][0], size["c"][0], span["c"], size["d"][0], span["d"]]
    return Drawn([*printed, *(size[case][1] for case in CASES[1:])])


def figure_23d(axes: Panels) -> Drawn:
    """Draw the crank-pin force for several offsets of the counterweights of case (d)."""
    peaks = {}
    cases = ((0.0, "(a) unbalanced"), (6.0, "(d)"), (3.0, "(d')"), (1.0, "(d'')"))
    for (inches, name), colour in zip(cases, COLOURS, strict=False):
        force = (_forces("d", inches * INCH) if inches else _forces("a")).f23
        peaks[inches] = peak(force)[0]
        label = f"{name} offset {inches:g} in" if inches else name
        _hodograph(axes[0], force, colour, f"{label}: {peaks[inches]:.1f} N")
    _cross(axes[0])
    # The offset [in] of least peak force, for three thicknesses [in].
    offsets, best = np.linspace(1.5, 5.0, 71), {}
    for name, part in (("thin", 0.25), ("usual", 0.5), ("thick", 1.0)):
        sizes = [peak(_forces("d", INCH * inches, INCH * part).f23)[0] for inches in offsets]
        best[name] = float(offsets[int(np.argmin(sizes))])
    rise = {inches: peaks[inches] - peaks[0.0] for inches in (1.0, 3.0, 6.0)}
    ratios = [peaks[inches] / peaks[0.0] for inches in rise]
    return Drawn([*ratios, rise[3.0] / rise[1.0], rise[3.0] / rise[6.0], best["usual"]], best)


def relative_inertia(delta: Any, k: Any) -> Any:
    """Return the balanced link's moment of inertia over ``M L^2``, by offset and K."""
    delta = np.asarray(delta)
    bars = 1.0 / 3.0 + delta * (0.5 - delta * delta / 6.0)
    return bars + k / 4.0 * ((1.0 - delta) * (1.0 + delta) / delta) ** 2


def density_number(density: float) -> float:
    """Return K of the link of Figs. 23(b) and (c), M = L = 1, and a counterweight of h = 0.1."""
    return 1.0 / (2.0 * pi * 0.1 * density)


def offset_function(delta: Any) -> Any:
    """Return ``delta^3/(1 + delta^2)``, the K for which delta is best (Smith Fig. 23 a)."""
    return delta * delta * delta / (1.0 + delta * delta)


def optimal_offset(density_number: Any) -> Any:
    """Return the offset over length that makes the balanced link's inertia least.

    For K < 1/2 it is the one real root of ``delta^3 = K (1 + delta^2)``, a minimum; ``delta = 1``
    is a maximum then.  For K >= 1/2 the inertia falls all the way to ``delta = 1``: the
    counterweight vanishes and the least inertia is that of a bar of twice the length.  With s =
    1/delta the root of ``s^3 + s = 1/K`` is ``s = (2/sqrt 3) sinh(asinh(3 sqrt 3/(2 K))/3)``, and
    one step of Newton's method mends the round-off that sinh amplifies.
    """
    k = np.asarray(density_number, dtype=float)
    # 1/K of a smaller one would overflow.
    safe = np.clip(k, np.finfo(float).tiny, 0.5)
    s = 2.0 / np.sqrt(3.0) * np.sinh(np.arcsinh(1.5 * np.sqrt(3.0) / safe) / 3.0)
    s = s - (s * s * s + s - 1.0 / safe) / (3.0 * s * s + 1.0)
    return np.where(k >= 0.5, 1.0, 1.0 / s)


def _best() -> list[tuple[str, float, float, float]]:
    """Return letter, density, K and best offset of the five counterweights."""
    densities = (5.0, 10.0, 20.0, 40.0, 80.0)
    numbers = [density_number(density) for density in densities]
    return list(zip("ABCDE", densities, numbers, optimal_offset(numbers).tolist(), strict=True))


def figure_23a(axes: Panels) -> Drawn:
    """Draw K over the offset for which it makes the inertia least."""
    ax, delta = axes[0], np.linspace(0.0, 1.0, 401)
    ax.plot(delta, offset_function(delta), color=COLOURS[0])
    for letter, _, number, best in _best():
        ax.plot([best, best, 0.0], [0.0, number, number], ":", color="0.6", lw=0.9)
        ax.plot(best, number, "o", color=COLOURS[1], ms=5)
        sketch.write(ax, (best, number), letter, (-10.0, 8.0))
    return Drawn([offset_function(1.0)])


def _densities(ax: Axes, delta: Array, beside: float) -> None:
    """Draw the inertia over the offset for the densities, and its minima with their letters."""
    for (letter, density, number, best), colour in zip(_best(), COLOURS, strict=False):
        least = float(relative_inertia(best, number))
        ax.plot(
            delta, relative_inertia(delta, number), color=colour, label=rf"$\rho$ = {density:g}"
        )
        ax.plot(best, least, "o", color=colour, ms=4.5)
        sketch.write(ax, (best, least), letter, (beside, -10.0), color=colour)


def figure_23b(axes: Panels) -> Drawn:
    """Draw the inertia over the offset for a range of densities."""
    ax, delta = axes[0], np.linspace(0.06, 1.0, 471)
    # So light that no counterweight at all is best.
    light = relative_inertia(delta, density_number(2.5))
    ax.plot(delta, light, "--", color="0.45", label=r"$\rho$ = 2.5")
    _densities(ax, delta, 0.0)
    rows = []
    for letter, density, number, best in _best():
        mass = (1.0 - best) * (1.0 + best) / (2.0 * best)
        sizes = (relative_inertia(best, number), mass, np.sqrt(2.0 * number * mass))
        rows.append((letter, density, number, best, *sizes))
    offsets = [best for *_, best in _best()]
    return Drawn([max(offsets), min(offsets)], tables=[rows])


def figure_23c(axes: Panels) -> Drawn:
    """Draw the neighbourhood of the minima, and the line on which they lie."""
    ax, delta = axes[0], np.linspace(0.1, 1.0, 451)
    line = relative_inertia(delta, offset_function(delta))
    ax.plot(delta, line, "--", color="0.3", lw=1.3, label="minima of all densities")
    _densities(ax, delta, 6.0)
    minima = [(best, float(relative_inertia(best, number))) for *_, number, best in _best()]
    return Drawn([np.max(np.diff(minima, axis=0))])
