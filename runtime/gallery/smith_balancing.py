"""Smith's Figs. 20 to 23: cases of balance, force and moment on the frame, a balanced link.

The balanced single link of chapter 5: a thin uniform rod (length L, mass M) turns about one end.
Beyond the pivot the same section goes on for ``l = delta L`` (mass ``delta M``) and carries at its
end a cylinder of mass m_c, thickness h and density rho, such that the centre of mass lies on the
pivot.  Then::

    m_c = (M/2) (1/delta - delta)
    I = M L^2 [1/3 + delta/2 - delta^3/6 + (K/4) (1/delta - delta)^2],  K = M/(2 pi L^2 h rho)
    dI/d(delta) = (M L^2/2) (1 - delta^2) [1 - K (1 + delta^2)/delta^3]

Smith prints ``M L^2 (1 + delta^2)/2`` for the two bars; they have ``M L^2 (1 + delta^3)/3``.  His
derivative, his K and ``K = delta^3/(1 + delta^2)`` follow from the latter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import radians
from typing import Any

import numpy as np

from ..rigid import (
    Counterweight,
    RigidForces,
    case_counterweights,
    rigid_forces,
    with_counterweights,
)
from ..rigid.counterweights import CASES, Case
from . import sketch
from .drawing import COLOURS, Array, Axes, Panels, panel_title
from .records import Drawn
from .smith_forces import INCH, TURN, example, example_forces, finish_polar, peak

# Discs half an inch thick, 6 in from the pins, as the thesis states none of these.
_THICKNESS, _OFFSET = 0.5 * INCH, 6.0 * INCH
_NAMES: Mapping[Case, str] = {
    "a": "unbalanced",
    "b": "crank and follower balanced",
    "c": "fully balanced, 3 counterweights",
    "d": "fully balanced, 2 counterweights",
}


def _weights(
    case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS
) -> dict[str, Counterweight]:
    """Return the counterweights of a case, steel discs."""
    return case_counterweights(example()[0], case, offset, density=7850.0, thickness=thickness)


@lru_cache(maxsize=8)
def _forces(case: Case, offset: float = _OFFSET, thickness: float = _THICKNESS) -> RigidForces:
    if case == "a":
        return example_forces()
    machine, speed = example()
    changed = with_counterweights(machine, _weights(case, offset, thickness).values())
    return rigid_forces(changed, TURN, speed)


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
            sketch.bar(ax, start, centre, colour, lw=2.2, zorder=2)
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
    return Drawn(_balance_values(), tables=[rows])


def _balance_values() -> list[float]:
    """Return counts of weights, growth of pin forces and of the torque, inertia of two masses."""

    def growth(*names: str) -> float:
        return min(
            peak(getattr(_forces(case), name))[0] / peak(getattr(_forces("a"), name))[0]
            for case in ("b", "c", "d")
            for name in names
        )

    # The two masses at B and C have the coupler's mass and centre, but not its inertia.
    coupler, length = example()[0].mass("coupler"), example()[0].linkage.lengths["coupler"]
    return [
        *(len(_weights(case)) for case in CASES[1:]),
        growth("f12", "f23", "f34", "f41"),
        growth("torque"),
        coupler.along / length * length**2 / coupler.inertia,
    ]


def figure_21(axes: Panels) -> Drawn:
    """Draw the force on the frame, unbalanced and partially balanced, as a polar diagram."""
    ax = axes[0]
    plans: tuple[tuple[Case, str, int, str], ...] = (
        ("a", COLOURS[0], 40, "o"),
        ("b", COLOURS[1], 120, "^"),
    )
    for case, colour, step, style in plans:
        values = _forces(case).shaking_force
        ax.plot(*values.T, color=colour, label=f"({case}) {_NAMES[case]}")
        face = "w" if style == "o" else colour
        ax.plot(*values[:-1:step].T, style, color=colour, ms=3.5, mfc=face)
        for angle in (0, 60, 120, 180, 240, 300):
            place = values[4 * angle]
            way = place / (np.hypot(*place) or 1.0)
            sketch.write(ax, place, f"{angle}°", 12.0 * way, color=colour, fontsize=7)
    finish_polar(ax)
    return Drawn([peak(_forces("b").shaking_force)[0] / peak(_forces("a").shaking_force)[0]])


def figure_22(axes: Panels) -> Drawn:
    """Draw the moment on the frame in the four cases, by (4.13) and complete."""
    for ax in axes:
        for case in CASES:
            label = f"({case}) {_NAMES[case]}"
            ax.plot(np.degrees(TURN), _moment(case, ax is axes[1]), label=label)
    axes[1].set_ylim(axes[0].get_ylim())

    def growth(case: Case, complete: bool) -> tuple[float, float]:
        """Return that of the greatest size, and that of the range."""
        now, before = _moment(case, complete), _moment("a", complete)
        sizes = float(np.max(np.abs(now)) / np.max(np.abs(before)))
        return sizes, float(np.ptp(now) / np.ptp(before))

    printed = [growth("b", False)[0], *growth("c", False), *growth("d", False)]
    cases: tuple[Case, ...] = ("b", "c", "d")
    return Drawn([*printed, *(growth(case, True)[0] for case in cases)])


def _moment(case: Case, complete: bool) -> Array:
    forces = _forces(case)
    if complete:
        return forces.shaking_moment
    return np.asarray(example()[0].linkage.lengths["frame"] * forces["y41"])


def figure_23d(axes: Panels) -> Drawn:
    """Draw the crank-pin force for several offsets of the counterweights of case (d)."""
    ax, peaks = axes[0], {}
    cases = ((0.0, "(a) unbalanced"), (6.0, "(d)"), (3.0, "(d')"), (1.0, "(d'')"))
    for (inches, name), colour in zip(cases, COLOURS, strict=False):
        force = (_forces("d", inches * INCH) if inches else _forces("a")).f23
        peaks[inches] = peak(force)[0]
        label = f"{name} offset {inches:g} in" if inches else name
        ax.plot(*force.T, color=colour, label=f"{label}: {peaks[inches]:.1f} N")
        ax.plot(*force[:-1:120].T, "o", color=colour, ms=2.6)
    finish_polar(ax)
    thin, usual, thick = (_best_offset(part * INCH) for part in (0.25, 0.5, 1.0))
    rise = {inches: peaks[inches] - peaks[0.0] for inches in (1.0, 3.0, 6.0)}
    ratios = [peaks[inches] / peaks[0.0] for inches in rise]
    values = [*ratios, rise[3.0] / rise[1.0], rise[3.0] / rise[6.0], usual]
    return Drawn(values, {"thin": thin, "usual": usual, "thick": thick})


def _best_offset(thickness: float) -> float:
    """Return the offset [in] of least peak crank-pin force in case (d)."""
    offsets = np.linspace(1.5, 5.0, 71)
    peaks = [peak(_forces("d", INCH * inches, thickness).f23)[0] for inches in offsets]
    return float(offsets[int(np.argmin(peaks))])


@dataclass(frozen=True)
class BalancedLink:
    """A link balanced on its pivot, by offset delta (above 0, at most 1) and density number K."""

    offset: Any
    density_number: Any

    @property
    def inertia(self) -> Any:
        """Moment of inertia about the pivot over ``M L^2``."""
        delta, k = np.asarray(self.offset), self.density_number
        bars = 1.0 / 3.0 + delta * (0.5 - delta * delta / 6.0)
        return bars + k / 4.0 * ((1.0 - delta) * (1.0 + delta) / delta) ** 2

    @property
    def counterweight(self) -> Any:
        """Mass of the counterweight over that of the link."""
        delta = np.asarray(self.offset)
        return (1.0 - delta) * (1.0 + delta) / (2.0 * delta)

    @property
    def radius(self) -> Any:
        """Radius of the counterweight over the length of the link."""
        return np.sqrt(2.0 * self.density_number * self.counterweight)


def density_number(mass: float, length: float, thickness: float, density: float) -> float:
    """Return K of a link [kg, m] and its counterweight [m, kg/m^3]."""
    return mass / (2.0 * np.pi * length * length * thickness * density)


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
    """Return letter, density, K and best offset of five counterweights, M = L = 1 and h = 0.1."""
    densities = (5.0, 10.0, 20.0, 40.0, 80.0)
    numbers = [density_number(1.0, 1.0, 0.1, density) for density in densities]
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
        link = BalancedLink(delta, number)
        ax.plot(delta, link.inertia, color=colour, label=rf"$\rho$ = {density:g}")
        least = float(BalancedLink(best, number).inertia)
        ax.plot(best, least, "o", color=colour, ms=4.5)
        sketch.write(ax, (best, least), letter, (beside, -10.0), color=colour)


def figure_23b(axes: Panels) -> Drawn:
    """Draw the inertia over the offset for a range of densities."""
    ax, delta = axes[0], np.linspace(0.06, 1.0, 471)
    # So light that no counterweight at all is best.
    light = BalancedLink(delta, density_number(1.0, 1.0, 0.1, 2.5))
    ax.plot(delta, light.inertia, "--", color="0.45", label=r"$\rho$ = 2.5")
    _densities(ax, delta, 0.0)
    offsets = [best for *_, best in _best()]
    rows = []
    for letter, density, number, best in _best():
        link = BalancedLink(best, number)
        sizes = (link.inertia, link.counterweight, link.radius)
        rows.append((letter, density, number, best, *sizes))
    return Drawn([max(offsets), min(offsets)], tables=[rows])


def figure_23c(axes: Panels) -> Drawn:
    """Draw the neighbourhood of the minima, and the line on which they lie."""
    ax, delta = axes[0], np.linspace(0.1, 1.0, 451)
    line = BalancedLink(delta, offset_function(delta))
    ax.plot(delta, line.inertia, "--", color="0.3", lw=1.3, label="minima of all densities")
    _densities(ax, delta, 6.0)
    minima = [(best, float(BalancedLink(best, number).inertia)) for *_, number, best in _best()]
    return Drawn([np.max(np.diff(minima, axis=0))])
