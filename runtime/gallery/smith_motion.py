"""Smith's Figs. 6 to 10 and 27: the follower's motion, clearance, the coupler's end load."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import acos, cos, degrees, pi, radians, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import BadInput
from ..core.periodic_function import PeriodicFunction
from ..linkages import FourBar, FourBarMotion
from ..linkages.clearance import clearance_range
from ..linkages.transmission import transmission_angle
from .drawing import (
    COLOURS,
    GROUND,
    LINK_COLOURS,
    Array,
    arc,
    bar,
    canvas,
    crank_axis,
    legend_below,
    pin,
    pivot,
    write,
)
from .records import Drawn, Value
from .smith_linkages import PROPORTIONS, end_load, four_bar_of, linkage_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CRANKS = (2.0, 4.0, 6.0, 8.0, 9.0, 9.9)
# Distance from a limit (crank 0 or 10) at which it is read off; deviations are of its order.
_NEAR = 1e-7
_CLEARANCES = (0.05, 0.1, 0.2, 0.4)
# Lengths of the schematic figures, chosen so that their angles are reached.
_GENERAL = FourBar(frame=10.0, crank=4.0, coupler=9.0, follower=7.0)
_IN_LINE = FourBar(frame=16.0, crank=8.0, coupler=7.0, follower=8.0)
_SQUARE = FourBar(frame=10.0, crank=4.0, coupler=10.0, follower=6.0)
_ANGLE = radians(70.0)
_DASHED = (0, (3.5, 1.5))


def _follower(crank: float, theta: Array) -> FourBarMotion:
    return FourBar(frame=10.0, crank=crank, coupler=10.0, follower=10.0).motion(theta)


def _family(ax: Axes, value: Callable[[FourBarMotion], Array], label: str) -> None:
    """Draw one quantity of the follower for all cranks."""
    # Closer angles where the follower turns back within a few degrees.
    near = np.concatenate([np.linspace(0.0, 0.35, 701), np.linspace(0.35, 2 * pi - 0.35, 721)])
    theta = np.unique(np.concatenate([near, 2 * pi - near]))
    for crank in _CRANKS:
        motion = _follower(crank, theta)
        ax.plot(np.degrees(theta), value(motion), label=f"crank {crank:g}")
    crank_axis(ax)
    ax.set_ylabel(label)


def _limits(quantity: str, small: float, parallel: Callable[[Array], Array]) -> list[float]:
    """Return the quantity for a vanishing crank, its distance to the parallelogram's twice."""
    theta = np.radians(np.arange(10.0, 180.0, 10.0))
    scale = 180.0 / pi if quantity == "theta4" else 1.0

    def at(crank: float, angles: Array) -> Array:
        return scale * np.asarray(getattr(_follower(crank, angles), quantity))

    halves = (theta, theta + pi)
    tiny = at(10.0 * _NEAR, np.concatenate(halves))
    gaps = (np.abs(at(10.0 * (1.0 - _NEAR), half) - scale * parallel(half)) for half in halves)
    return [tiny[np.argmax(np.abs(tiny - small))], *(np.max(gap) for gap in gaps)]


def figure_6a(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's angle for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: np.degrees(motion.theta4), r"output angle $\theta_4$ [deg]")
    ax.plot([0, 360], [0, 360], "--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_yticks(range(0, 361, 60))
    legend_below([ax])
    return Drawn(_limits("theta4", 120.0, lambda theta: theta))


def figure_6b(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's speed for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: motion.omega4, r"output speed $\omega_4/\omega_2$")
    ax.axhline(1.0, ls="--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_ylim(-5.0, 1.5)
    legend_below([ax])
    deepest = _follower(9.9, np.zeros(1)).omega4[0]
    return Drawn(_limits("omega4", 0.0, np.ones_like), {"deepest": deepest})


def figure_6c(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's acceleration for a family of cranks."""
    ax = axes[0]
    _family(ax, lambda motion: motion.alpha4, r"output acceleration $\alpha_4/\omega_2^2$")
    ax.axhline(0.0, ls="--", color="0.4", lw=1.0, label="parallelogram")
    ax.set_ylim(-8.0, 8.0)
    legend_below([ax])
    theta = np.linspace(0.0, 2 * pi, 36001)
    peaks = ", ".join(
        f"{np.max(np.abs(_follower(crank, theta).alpha4)):.3g} (crank {crank:g})"
        for crank in _CRANKS[3:]
    )
    return Drawn(_limits("alpha4", 0.0, np.zeros_like), {"peaks": peaks})


def figure_7(axes: Sequence[Axes]) -> Drawn:
    """Draw the harmonics of the follower's angle over the length of the crank."""
    cranks, top = np.linspace(0.25, 9.5, 38), 8

    def padded(values: Array) -> Array:
        return np.pad(values, (0, max(0, top + 1 - len(values))))[: top + 1]

    def harmonics(crank: float) -> PeriodicFunction:
        return PeriodicFunction.from_callable(lambda theta: _follower(crank, theta).theta4)

    series = [harmonics(float(crank)) for crank in cranks]
    a = np.degrees([padded(f.a) for f in series])
    b = np.degrees([padded(f.b) for f in series])
    for ax, values, name in ((axes[0], a, "cosine $a_m$"), (axes[1], b, "sine $b_m$")):
        for m in range(1, 6):
            ax.plot(cranks, values[:, m], label=f"m = {m}")
        ax.set(xlim=(0.0, 10.0), ylim=(-60.0, 4.0), xlabel="crank length (other links 10)")
        ax.set_ylabel(f"{name} of $\\theta_4$ [deg]")
    legend_below(axes[:1], columns=5)
    cosine, sine = np.abs(a[:, 1:6]), np.abs(b[:, 1:6])
    total = np.hypot(cosine, sine)
    return Drawn(
        [
            total[0, 1] / total[0, 0],
            np.max(sine[:, 1:]) / np.max(sine[:, 0]),
            np.max(cosine[:, 1:]) / np.max(cosine[:, 0]),
            np.min(cosine / sine),
            np.min(sine / cosine),
        ]
    )


def end_loads(axes: Sequence[Axes], proportions: str) -> Drawn:
    """Draw phi, f1, f2 and f3 of one linkage (Fig. 27)."""
    ax, theta = axes[0], np.linspace(0.0, 2 * pi, 1441)
    linkage = linkage_of(proportions)
    parts = end_load(linkage, theta)
    for name, label, colour in (
        ("phi", r"$\varphi$", COLOURS[4]),
        ("f1", "$f_1$", COLOURS[1]),
        ("f2", "$f_2$", COLOURS[2]),
        ("f3", "$f_3$", COLOURS[0]),
    ):
        ax.plot(np.degrees(theta), getattr(parts, name), color=colour, label=label)
    crank_axis(ax)
    ax.set_ylabel("component of the end load")
    legend_below([ax])
    sizes = _sizes(proportions)
    small = sizes["phi"] / max(sizes["f1"], sizes["f2"], sizes["f3"])
    eps2 = pi**2 * linkage.crank / (2 * linkage.coupler)
    if proportions == "(2,1,2,2)":
        every = [_sizes(other) for other in PROPORTIONS]
        return Drawn([small, sum(size["f3"] == max(size.values()) for size in every)])
    if proportions == "(5,1,5,2)":
        return Drawn([small, pi**2 / 3, eps2, pi**2 / 3])
    if proportions == "(54,0.4,54,3)":
        return Drawn([*(sizes[name] / sizes["f3"] for name in ("phi", "f1", "f2")), eps2])
    return Drawn([small])


def _sizes(proportions: str) -> dict[str, float]:
    """Return the peaks of the components."""
    parts = end_load(linkage_of(proportions), np.linspace(0.0, 2 * pi, 2881))
    return {n: float(np.max(np.abs(getattr(parts, n)))) for n in ("phi", "f1", "f2", "f3")}


def _with_coupler(linkage: FourBar, change: float, crossed: bool = False) -> FourBar:
    """Return the linkage whose coupler is longer: what a clearance taken up amounts to."""
    sizes = (linkage.frame, linkage.crank, linkage.coupler + change, linkage.follower)
    return FourBar(*sizes, assembly="crossed" if crossed else "open")


def _phi(linkage: FourBar, theta: ArrayLike) -> Array:
    """Return the angle BDC."""
    motion = linkage.motion(theta)
    to_crank = motion.joints["B"] - motion.joints["D"]
    turned = np.arctan2(to_crank[..., 1], to_crank[..., 0]) - motion.theta4
    return np.asarray(np.abs(np.angle(np.exp(1j * turned))))


def _movements(linkage: FourBar, theta: ArrayLike, c: float) -> tuple[Array, Array]:
    """Return delta phi' and delta phi'' of an open linkage: its follower turns back, and on."""
    moves = clearance_range(linkage, c, theta)
    return moves.below, moves.above


def _reach(linkage: FourBar, distance: float) -> float:
    """Return the crank angle at which B is so far from D."""
    l1, l2 = linkage.frame, linkage.crank
    return acos((l1**2 + l2**2 - distance**2) / (2.0 * l1 * l2))


def _direction(vector: Array) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def figure_8(axes: Sequence[Axes]) -> Drawn:
    """Draw the nominal position and the two extremes for one crank angle."""
    ax = axes[0]
    canvas(ax)
    places = _draw_extremes(ax, _GENERAL, _ANGLE, 1.6, (0.5, -0.5))
    a, b, d = places["A"], places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    ax.plot(*np.transpose([a, d]), color="0.6", lw=0.8, zorder=1)
    for radius, name, text in (
        (2.0, "C", r"$\phi$"),
        (2.9, "C'", r"$\phi'$"),
        (1.2, "C''", r"$\phi''$"),
    ):
        arc(ax, d, radius, (_direction(b - d), _direction(places[name] - d)), text)
    arc(ax, a, 1.1, (0.0, _ANGLE), r"$\theta_2$")
    return Drawn(_general_values(float(np.hypot(*(b - d)))))


def _draw_extremes(
    ax: Axes, linkage: FourBar, theta: float, c: float, shares: Sequence[float]
) -> dict[str, Array]:
    """Draw the linkage with a clearance taken up by shares of it; return the joints."""
    from matplotlib.patches import Circle

    joints = {name: np.asarray(place) for name, place in linkage.motion(theta).joints.items()}
    a, b, d = (joints[name] for name in "ABD")
    pins = {"C": joints["C"]}
    for share, name in zip(shares, ("C'", "C''"), strict=False):
        pins[name] = np.asarray(_with_coupler(linkage, share * c).motion(theta).joints["C"])
    for name, at in pins.items():
        alpha, style = (1.0, "-") if name == "C" else (0.6, _DASHED)
        end = b + linkage.coupler * (at - b) / np.hypot(*(at - b))
        bar(ax, b, end, LINK_COLOURS["coupler"], lw=2.4, alpha=alpha, ls=style, zorder=3)
        bar(ax, d, at, LINK_COLOURS["follower"], lw=2.4, alpha=alpha, ls=style, zorder=3)
        hole = Circle((float(end[0]), float(end[1])), 0.5 * c, fill=False, lw=0.9, alpha=alpha)
        hole.set(edgecolor=LINK_COLOURS["coupler"], zorder=4)
        ax.add_patch(hole)
        ax.update_datalim([end - 0.5 * c, end + 0.5 * c])
        pin(ax, at, size=4.5)
        shift = {"C": (0.0, 17.0), "C'": (16.0, 4.0), "C''": (-16.0, 6.0)}[name]
        write(ax, at, name, shift, style="italic")
    bar(ax, a, b, LINK_COLOURS["crank"], zorder=3)
    _ground(ax, a, d, 0.09 * linkage.frame)
    pin(ax, b)
    write(ax, b, "B", (-11.0, 9.0), style="italic")
    return {**joints, **pins}


def _ground(ax: Axes, a: Array, d: Array, unit: float) -> None:
    for place, name, side in ((a, "A", -16.0), (d, "D", 16.0)):
        pivot(ax, place, unit)
        write(ax, place, name, (side, 4.0), style="italic")


def _general_values(distance: float) -> list[Value]:
    """Return (3.1) to (3.3) beside the computed range, and beside other linkages."""
    l3, l4, c = _GENERAL.coupler, _GENERAL.follower, 0.2
    phi = float(_phi(_GENERAL, _ANGLE))
    values: list[Value] = []
    for sign, move in zip((1.0, -1.0), _movements(_GENERAL, _ANGLE, c), strict=True):
        printed = (l3 * c + sign * c**2 / 4.0) / (2.0 * distance * l4)
        other = float(_phi(_with_coupler(_GENERAL, 0.5 * sign * c), _ANGLE))
        angles = (phi + sign * float(move), other)
        values += [(sign * (cos(phi) - cos(angle)), printed) for angle in angles]
    for small in (0.2, 0.02):
        printed = degrees(l3 * small / (distance * l4 * sin(phi)))
        total = float(sum(_movements(_GENERAL, _ANGLE, small)))
        values.append((degrees(total), printed, printed * (small / l4) ** 2))
    return values


def figure_9a(axes: Sequence[Axes]) -> Drawn:
    """Draw the extreme position in which coupler and follower lie in one line."""
    ax = axes[0]
    canvas(ax)
    l3, l4 = _IN_LINE.coupler, _IN_LINE.follower
    theta, a = _reach(_IN_LINE, l3 + l4), np.zeros(2)
    b = _IN_LINE.crank * np.array([cos(theta), sin(theta)])
    d = np.array([_IN_LINE.frame, 0.0])
    middle = d + l4 * (b - d) / (l3 + l4)
    for start, end, link in ((b, middle, "coupler"), (d, middle, "follower"), (a, b, "crank")):
        bar(ax, start, end, LINK_COLOURS[link], zorder=3)
    for name, up in (("C'", True), ("C''", False)):
        moved = _with_coupler(_IN_LINE, 0.4, crossed=not up).motion(theta)
        at = np.asarray(moved.joints["C"])
        for start, link in ((b, "coupler"), (d, "follower")):
            bar(ax, start, at, LINK_COLOURS[link], lw=1.8, alpha=0.6, ls=_DASHED)
        pin(ax, at, size=4.5)
        write(ax, at, name, (6.0, 12.0) if up else (-6.0, -12.0), style="italic")
        if up:
            arc(ax, d, 0.45 * l4, (_direction(b - d), float(moved.theta4)), r"$\phi'$")
    _ground(ax, a, d, 1.3)
    pin(ax, b, middle)
    write(ax, b, "B", (-11.0, 9.0), style="italic")
    write(ax, middle, "C", (10.0, 8.0), style="italic")
    c = 0.1
    printed = 1.0 - (l3 * c + c**2 / 4.0) / (2.0 * l4 * (l3 + l4))
    shorter = 1.0 + (l3 * c - c**2 / 4.0) / (2.0 * l4 * (l3 + l4))
    back, on = (float(move) for move in _movements(_IN_LINE, theta, c))
    quarter = float(_movements(_IN_LINE, theta, 0.25 * c)[0])
    try:
        _with_coupler(_IN_LINE, -0.5 * c).motion(theta)
        outcome = "that linkage closes here"
    except BadInput:
        outcome = "that linkage is refused here"
    return Drawn(
        [(cos(back), printed), (cos(on), printed), shorter, back / quarter], {"outcome": outcome}
    )


def figure_9b(axes: Sequence[Axes]) -> Drawn:
    """Draw the position in which BD and the follower are square."""
    ax = axes[0]
    canvas(ax)
    l3, l4 = _SQUARE.coupler, _SQUARE.follower
    theta = _reach(_SQUARE, sqrt(l3**2 - l4**2))
    places = _draw_extremes(ax, _SQUARE, theta, 1.4, (0.5,))
    b, d = places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    first, second = (0.55 * (at - d) / np.hypot(*(at - d)) for at in (b, places["C"]))
    ax.plot(*np.transpose([d + first, d + first + second, d + second]), color=GROUND, lw=0.9)
    arc(ax, d, 2.6, (_direction(b - d), _direction(places["C'"] - d)), r"$\phi'$")
    values: list[Value] = []
    for c in (0.1, 0.01):
        sine = (l3 * c + c**2 / 4.0) / (2.0 * sqrt(l3**2 - l4**2) * l4)
        move = float(_movements(_SQUARE, theta, c)[0])
        values += [(sin(move), sine), (degrees(move), degrees(sine), degrees(sine**3))]
    return Drawn(values)


def figure_10(axes: Sequence[Axes]) -> Drawn:
    """Draw the free motion of the follower over the crank angle for several clearances."""
    ax, linkage = axes[0], four_bar_of("smith_1972_10_8_10_10")
    unit, theta = linkage.frame / 10.0, np.linspace(0.0, 2.0 * pi, 3601)
    ranges = [clearance_range(linkage, c * unit, theta) for c in _CLEARANCES]
    for c, moves, colour in zip(_CLEARANCES, ranges, COLOURS, strict=False):
        ax.plot(np.degrees(theta), np.degrees(moves.width), color=colour, label=f"c = {c:g}")
        ax.plot(np.degrees(theta), np.degrees(moves.small), ":", color="0.15", lw=1.1, zorder=5)
    ax.plot([], [], ":", color="0.15", lw=1.1, label="small clearance, (3.3)")
    crank_axis(ax)
    ax.set_ylim(0.0, 14.0)
    ax.set_ylabel(r"free motion $\delta\phi$ [deg]")
    legend_below([ax], columns=5)
    apart = max(degrees(float(np.max(np.abs(moves.width - moves.small)))) for moves in ranges)
    greatest = [degrees(theta[int(np.argmax(moves.below[:-1]))]) for moves in ranges]
    small, near = ranges[0], np.abs(theta - pi) < radians(60.0)
    local = theta[near][int(np.argmax(small.below[near]))]
    values = [
        *((at + 180.0) % 360.0 - 180.0 for at in greatest),
        degrees(local),
        *_transmission_values(linkage, theta, small.below, small.above),
        *_always_values(),
        _crank_pin_gap(linkage, unit),
    ]
    return Drawn(values, {"apart": apart})


def _crank_pin_gap(linkage: FourBar, unit: float) -> float:
    """Return the free motion with the clearance at B, by trial, less that with it at C."""
    theta, c = np.radians(np.arange(0.0, 360.0, 30.0)), _CLEARANCES[-1] * unit
    joints = linkage.motion(theta).joints
    trial = np.exp(1j * np.linspace(0.0, 2.0 * pi, 7201))
    way = (joints["B"] - joints["D"]) @ np.array([1.0, 1.0j])
    moved = way[:, np.newaxis] + 0.5 * c * trial
    size = np.abs(moved)
    l3, l4 = linkage.coupler, linkage.follower
    inner = (size**2 + l4**2 - l3**2) / (2.0 * size * l4)
    # Seen from the nominal direction of DB, so that no angle passes half a turn.
    turned = np.angle(moved / way[:, np.newaxis]) - np.arccos(inner)
    gap = np.ptp(turned, axis=1) - clearance_range(linkage, c, theta, joint="34").width
    return degrees(float(gap[int(np.argmax(np.abs(gap)))]))


def _transmission_values(
    linkage: FourBar, theta: Array, longer: Array, shorter: Array
) -> list[Value]:
    """Return the extremes of the transmission angle, and (3.3) where it is square."""
    extremes, c = transmission_angle(linkage), _CLEARANCES[0]
    mu = linkage.motion(theta).transmission_angle
    first_half = slice(len(mu) // 2)
    square = int(np.argmin(np.abs(mu - pi / 2.0)[first_half]))
    least = int(np.argmin((longer + shorter)[first_half]))
    printed = c * linkage.frame / 10.0 / (linkage.follower * np.sin(mu[square]))
    return [
        degrees(extremes.least),
        degrees(extremes.greatest),
        (degrees(theta[least]), degrees(theta[square])),
        printed / longer[square],
        printed / (longer[square] + shorter[square]),
    ]


def _always_values() -> list[float]:
    """Return the case in which the transmission angle stays below 90 degrees."""
    theta = np.linspace(0.0, 2.0 * pi, 3601)
    equal = [FourBar(10.0, crank, 10.0, 10.0) for crank in (4.0, 4.3)]
    longer = _movements(equal[0], theta, 0.05)[0]
    greatest = (degrees(transmission_angle(linkage).greatest) for linkage in equal)
    return [*greatest, degrees(theta[int(np.argmin(longer))])]
