"""Smith's linkages and rigs; Figs. 6 to 10 and 27: follower, clearance, the coupler's end load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import acos, cos, degrees, pi, radians, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..hill import HillForm, hill_boundaries, hill_form
from ..linkages import FourBar, FourBarMotion
from ..linkages.clearance import clearance_range
from ..linkages.transmission import transmission_angle
from ..scenes import load_scene
from . import sketch
from .drawing import COLOURS, Array, Axes, Looks, Panels, peak
from .records import Drawn, contents

RPM = pi / 30.0
# 1 lbf in s^2 in kg m^2, from the exact pound, standard gravity and the exact inch.
LBF_IN_S2 = 0.45359237 * 9.80665 * 0.0254
# The linkages that the thesis names by their proportions, and their scenes.
PROPORTIONS: Mapping[str, str] = contents("smith")["proportions"]
EQUATIONS = ("reduced", "printed", "complete")


def end_load(linkage: FourBar, theta: ArrayLike) -> dict[str, Array]:
    """Return the functions of the coupler equation at crank angles [rad], by name.

    phi, f1, f2, f3 as defined under Smith (6.17), and ``cos23``, the cosine of theta2 - theta3: the
    shape of the tension that (6.17) leaves out.
    """
    motion = linkage.motion(theta)
    between = motion.theta3 - motion.theta4
    crank = motion.theta2 - motion.theta3
    return {
        "phi": motion.omega3**2,
        "f1": -motion.alpha3 / np.tan(between),
        "f2": np.sin(crank) / np.tan(between),
        "f3": -motion.alpha4 / np.sin(between),
        "cos23": np.cos(crank),
    }


def linkage_of(proportions: str) -> FourBar:
    """Return the linkage that the thesis names by its proportions."""
    return four_bar_of(PROPORTIONS[proportions])


def four_bar_of(scene: str) -> FourBar:
    """Return the four-bar linkage of a built-in scene; another one is refused."""
    linkage = load_scene(scene).mechanism()
    if not isinstance(linkage, FourBar):
        raise bad(f"scene {scene}", type(linkage).__name__, "a four-bar linkage", "choose another")
    return linkage


@lru_cache(maxsize=16)
def series(linkage: FourBar, name: str = "f3") -> PeriodicFunction:
    """Return the Fourier series of one of the functions of :func:`end_load`."""
    return PeriodicFunction.from_callable(lambda theta: end_load(linkage, theta)[name])


@dataclass(frozen=True)
class Rig:
    """One linkage and coupler of chapter 9: scene, proportions, thickness, number of the chart.

    ``decrement`` is the logarithmic one that is taken for the nonlinear equation.
    """

    scene: str
    linkage: str
    thickness: str
    figure: str
    decrement: float

    @property
    def name(self) -> str:
        """Linkage and coupler in a few words."""
        return f"{self.linkage}, {self.thickness} in"

    @property
    def frequency(self) -> float:
        """Natural frequency of the coupler [rad/s]."""
        return float(load_scene(self.scene)["coupler"]["natural_frequency"])

    @property
    def inertias(self) -> Array:
        """The eight measured follower inertias [kg m^2]."""
        return np.array(load_scene(self.scene).get("measured.follower_inertias"))

    @property
    def decrements(self) -> tuple[float, float, float]:
        """The least, the middle and the greatest logarithmic decrement measured at rest."""
        least, most = load_scene(self.scene).get("measured.log_decrement")
        return float(least), 0.5 * float(least + most), float(most)

    def system(
        self,
        equation: str = "complete",
        modes: int = 1,
        decrement: float = 0.0,
        inertia: float | None = None,
    ) -> LinearPeriodic:
        """Return the coupler's vibration by one of the :data:`EQUATIONS`.

        With a logarithmic decrement, and the follower's inertia [lbf in s^2] or the scene's.
        """
        changes: dict[str, Any] = {"model.formulation": equation, "model.modes": modes}
        if decrement:
            changes["coupler.damping_ratio"] = decrement / (2 * pi)
        if inertia is not None:
            changes["follower.inertia"] = inertia * LBF_IN_S2
        return load_scene(self.scene, overrides=changes).linear_system()

    def function(
        self, equation: str, inertia: float | None = None, **changes: float
    ) -> PeriodicFunction:
        """Return the periodic coefficient at a follower inertia [kg m^2], or the scene's."""
        if inertia is not None:
            changes["follower_inertia"] = inertia
        return _form(self, equation).function(1.0, **changes)

    def ends(self, equation: str, inertia: ArrayLike, regions: tuple[int, ...]) -> Array:
        """Return the crank speeds [rad/s] that bound unstable regions of the first mode.

        By one of the :data:`EQUATIONS`, at follower inertias [kg m^2] ``(k,)``; region n starts at
        the speed 2 Omega / n.  Lower and upper speeds ``(2, len(regions), k)``, infinite where
        lambda^2 would be negative.
        """
        functions = (self.function(equation, float(one)) for one in np.atleast_1d(inertia))
        each = [hill_boundaries(f, 1.0, regions) for f in functions]
        lam2 = np.moveaxis(np.array([[one.upper, one.lower] for one in each]), 0, -1)
        positive = lam2 > 0.0
        roots = np.sqrt(np.where(positive, lam2, 1.0))
        return np.asarray(np.where(positive, self.frequency / roots, np.inf))


RIGS = tuple(Rig(**row) for row in contents("smith")["rig"])
RIG: Mapping[str, Rig] = {rig.figure: rig for rig in RIGS}


@dataclass(frozen=True)
class OfRig:
    """What was observed with a rig, known by the number of its chart."""

    chart: str

    @property
    def rig(self) -> Rig:
        """The linkage and coupler."""
        return RIG[self.chart]


@lru_cache(maxsize=64)
def _form(rig: Rig, equation: str) -> HillForm:
    return hill_form(rig.system(equation))


def region_name(n: int) -> str:
    """Return the speed at which region n starts, as the thesis writes it."""
    if n == 2:
        return "Ω"
    return f"Ω/{n // 2}" if n % 2 == 0 else f"2Ω/{n}"


_CRANKS = (2.0, 4.0, 6.0, 8.0, 9.0, 9.9)
_DASHED = (0, (3.5, 1.5))


def _follower(crank: float, theta: Array) -> FourBarMotion:
    return FourBar(frame=10.0, crank=crank, coupler=10.0, follower=10.0).motion(theta)


def output(axes: Panels, rate: str, small: float, slope: float, level: float) -> Drawn:
    """Draw the follower's angle, speed or acceleration for a family of cranks (Fig. 6).

    ``small`` is its value for a vanishing crank, slope and level are the parallelogram's.
    """
    ax, scale = axes[0], 180.0 / pi if rate == "theta4" else 1.0

    def value(crank: float, theta: Array) -> Array:
        return scale * np.asarray(getattr(_follower(crank, theta), rate))

    # Closer angles where the follower turns back within a few degrees.
    near = np.concatenate([np.linspace(0.0, 0.35, 701), np.linspace(0.35, 2 * pi - 0.35, 721)])
    theta = np.unique(np.concatenate([near, 2 * pi - near]))
    for crank in _CRANKS:
        ax.plot(np.degrees(theta), value(crank, theta), label=f"crank {crank:g}")
    ends = [level, 360.0 * slope + level]
    ax.plot([0, 360], ends, "--", color="0.4", lw=1.0, label="parallelogram")
    halves = [np.radians(np.arange(start, start + 170.0, 10.0)) for start in (10.0, 190.0)]
    # Both limits, crank 0 and 10, are read off beside them; deviations are of that order.
    tiny = value(10.0 * 1e-7, np.concatenate(halves))
    gaps = [
        value(10.0 * (1.0 - 1e-7), half) - (slope * np.degrees(half) + level) for half in halves
    ]
    fine = np.linspace(0.0, 2 * pi, 36001)
    peaks = (f"{np.max(np.abs(value(one, fine))):.3g} (crank {one:g})" for one in _CRANKS[3:])
    return Drawn(
        [tiny[np.argmax(np.abs(tiny - small))], *(np.max(np.abs(gap)) for gap in gaps)],
        {"deepest": value(_CRANKS[-1], np.zeros(1))[0], "peaks": ", ".join(peaks)},
    )


def figure_7(axes: Panels) -> Drawn:
    """Draw the harmonics of the follower's angle over the length of the crank."""
    cranks = np.linspace(0.25, 9.5, 38)

    def harmonics(crank: float) -> tuple[Array, Array]:
        f = PeriodicFunction.from_callable(lambda theta: _follower(crank, theta).theta4)
        return np.degrees(f.a[:6]), np.degrees(f.b[:6])

    a, b = (np.array(part) for part in zip(*map(harmonics, cranks.tolist()), strict=True))
    for ax, values in zip(axes, (a, b), strict=True):
        for m in range(1, 6):
            ax.plot(cranks, values[:, m], label=f"m = {m}")
    cosine, sine = np.abs(a[:, 1:]), np.abs(b[:, 1:])
    total = np.hypot(cosine, sine)
    higher = [np.max(part[:, 1:]) / np.max(part[:, 0]) for part in (sine, cosine)]
    return Drawn([total[0, 1] / total[0, 0], *higher, np.min(cosine / sine), np.min(sine / cosine)])


def end_loads(axes: Panels, proportions: str, looks: Looks) -> Drawn:
    """Draw phi, f1, f2 and f3 of one linkage (Fig. 27)."""
    linkage, theta = linkage_of(proportions), np.linspace(0.0, 2 * pi, 1441)
    for part, look in zip(end_load(linkage, theta).values(), looks, strict=False):
        axes[0].plot(np.degrees(theta), part, **look)
    phi, f1, f2, f3 = _sizes(proportions)
    eps2 = pi**2 * linkage.crank / (2 * linkage.coupler)
    if proportions == "(54,0.4,54,3)":
        return Drawn([phi / f3, f1 / f3, f2 / f3, eps2])
    values = [phi / max(f1, f2, f3)]
    if proportions == "(2,1,2,2)":
        every = [_sizes(other) for other in PROPORTIONS]
        values.append(sum(sizes[3] == max(sizes) for sizes in every))
    if proportions == "(5,1,5,2)":
        values += [pi**2 / 3, eps2, pi**2 / 3]
    return Drawn(values)


def _sizes(proportions: str) -> list[float]:
    parts = end_load(linkage_of(proportions), np.linspace(0.0, 2 * pi, 2881))
    return [peak(parts[name]) for name in ("phi", "f1", "f2", "f3")]


def _with_coupler(linkage: FourBar, change: float, crossed: bool = False) -> FourBar:
    """Return the linkage whose coupler is longer: what a clearance taken up amounts to."""
    coupler = linkage.coupler + change
    return replace(linkage, coupler=coupler, assembly="crossed" if crossed else "open")


def _reach(linkage: FourBar, distance: float) -> float:
    """Return the crank angle at which B is so far from D."""
    l1, l2 = linkage.frame, linkage.crank
    return acos((l1**2 + l2**2 - distance**2) / (2.0 * l1 * l2))


def _direction(vector: Array) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def figure_8(axes: Panels, angles: Sequence[tuple[float, str, str]]) -> None:
    """Draw the nominal position and the two extremes for one crank angle."""
    ax = sketch.canvas(axes[0])
    linkage, theta = FourBar(frame=10.0, crank=4.0, coupler=9.0, follower=7.0), radians(70.0)
    places = _draw_extremes(ax, linkage, theta, 1.6, (0.5, -0.5))
    a, b, d = places["A"], places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    ax.plot(*np.transpose([a, d]), color="0.6", lw=0.8, zorder=1)
    for radius, name, text in angles:
        sketch.arc(ax, d, radius, (_direction(b - d), _direction(places[name] - d)), text)
    sketch.arc(ax, a, 1.1, (0.0, theta), r"$\theta_2$")


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
        for link, start, stop in (("coupler", b, end), ("follower", d, at)):
            sketch.bar(ax, start, stop, link, lw=2.4, alpha=alpha, ls=style)
        hole = Circle((float(end[0]), float(end[1])), 0.5 * c, fill=False, lw=0.9, alpha=alpha)
        hole.set(edgecolor=sketch.LINK_COLOURS["coupler"], zorder=4)
        ax.add_patch(hole)
        ax.update_datalim([end - 0.5 * c, end + 0.5 * c])
        sketch.pin(ax, at, size=4.5)
        shift = {"C": (0.0, 17.0), "C'": (16.0, 4.0), "C''": (-16.0, 6.0)}[name]
        sketch.write(ax, at, name, shift, style="italic")
    sketch.bar(ax, a, b, "crank")
    sketch.grounds(ax, a, d, 0.09 * linkage.frame)
    sketch.pin(ax, b)
    sketch.write(ax, b, "B", (-11.0, 9.0), style="italic")
    return {**joints, **pins}


def figure_9a(axes: Panels) -> None:
    """Draw the extreme position in which coupler and follower lie in one line."""
    ax = sketch.canvas(axes[0])
    linkage = FourBar(frame=16.0, crank=8.0, coupler=7.0, follower=8.0)
    l3, l4 = linkage.coupler, linkage.follower
    theta, a = _reach(linkage, l3 + l4), np.zeros(2)
    b = linkage.crank * np.array([cos(theta), sin(theta)])
    d = np.array([linkage.frame, 0.0])
    middle = d + l4 * (b - d) / (l3 + l4)
    for start, end, link in ((b, middle, "coupler"), (d, middle, "follower"), (a, b, "crank")):
        sketch.bar(ax, start, end, link)
    for name, up in (("C'", True), ("C''", False)):
        moved = _with_coupler(linkage, 0.4, crossed=not up).motion(theta)
        at = np.asarray(moved.joints["C"])
        for start, link in ((b, "coupler"), (d, "follower")):
            sketch.bar(ax, start, at, link, lw=1.8, alpha=0.6, ls=_DASHED, zorder=2)
        sketch.pin(ax, at, size=4.5)
        sketch.write(ax, at, name, (6.0, 12.0) if up else (-6.0, -12.0), style="italic")
        if up:
            sketch.arc(ax, d, 0.45 * l4, (_direction(b - d), float(moved.theta4)), r"$\phi'$")
    sketch.grounds(ax, a, d, 1.3)
    sketch.pin(ax, b, middle)
    sketch.write(ax, b, "B", (-11.0, 9.0), style="italic")
    sketch.write(ax, middle, "C", (10.0, 8.0), style="italic")


def figure_9b(axes: Panels) -> None:
    """Draw the position in which BD and the follower are square."""
    ax = sketch.canvas(axes[0])
    linkage = FourBar(frame=10.0, crank=4.0, coupler=10.0, follower=6.0)
    theta = _reach(linkage, sqrt(linkage.coupler**2 - linkage.follower**2))
    places = _draw_extremes(ax, linkage, theta, 1.4, (0.5,))
    b, d = places["B"], places["D"]
    ax.plot(*np.transpose([b, d]), ":", color="0.4", lw=1.0)
    first, second = (0.55 * (at - d) / np.hypot(*(at - d)) for at in (b, places["C"]))
    ax.plot(*np.transpose([d + first, d + first + second, d + second]), color=sketch.GROUND, lw=0.9)
    sketch.arc(ax, d, 2.6, (_direction(b - d), _direction(places["C'"] - d)), r"$\phi'$")


def figure_10(axes: Panels) -> Drawn:
    """Draw the free motion of the follower over the crank angle for several clearances."""
    ax, linkage = axes[0], four_bar_of("smith_1972_10_8_10_10")
    unit, theta = linkage.frame / 10.0, np.linspace(0.0, 2.0 * pi, 3601)
    ranges = {c: clearance_range(linkage, c * unit, theta) for c in (0.05, 0.1, 0.2, 0.4)}
    for (c, moves), colour in zip(ranges.items(), COLOURS, strict=False):
        ax.plot(np.degrees(theta), np.degrees(moves.width), color=colour, label=f"c = {c:g}")
        ax.plot(np.degrees(theta), np.degrees(moves.small), ":", color="0.15", lw=1.1, zorder=5)
    ax.plot([], [], ":", color="0.15", lw=1.1, label="small clearance, (3.3)")
    every = ranges.values()
    apart = max(degrees(peak(moves.width - moves.small)) for moves in every)
    greatest = [degrees(theta[int(np.argmax(moves.below[:-1]))]) for moves in every]
    near = np.abs(theta - pi) < radians(60.0)
    values = [(at + 180.0) % 360.0 - 180.0 for at in greatest]
    values.append(degrees(theta[near][int(np.argmax(ranges[0.05].below[near]))]))
    # The first of these has a transmission angle that stays below 90 degrees.
    equal = [FourBar(10.0, crank, 10.0, 10.0) for crank in (4.0, 4.3)]
    extremes = [transmission_angle(bars) for bars in (linkage, *equal)]
    values += [degrees(extremes[0].least), *(degrees(one.greatest) for one in extremes)]
    longer = clearance_range(equal[0], 0.05, theta).below
    values.append(degrees(theta[int(np.argmin(longer))]))
    return Drawn(values, {"apart": apart})
