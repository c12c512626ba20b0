"""Beale and Scott's Figs. 2 to 12: a tip by polynomial and free-free modes, resonances; a chart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from ..constrained import constrained_motion
from ..core.families import LinearPeriodic
from ..core.plotting import ABOVE
from ..frequencies import ResonanceCurve, natural_frequencies, resonance_curve
from ..linkages import QuickReturn
from ..periodic import FloquetMultipliers, floquet_multipliers, simulate, steady_state
from ..scenes import load_scene
from ..stability import StabilityChart, stability_chart
from ..systems.rod import FreeFreeRod
from . import sketch
from .drawing import COLOURS, Array, Axes, Looks, Panels, panel_title, peak
from .records import Drawn

STIFF = "beale_1992_bahgat_willmert"
HEAVY = "beale_1992_bahgat_willmert_heavy"
FLEXIBLE = "beale_1992_flexible_rod"
# The mass read as lbm/in, and as lbf s^2/in^2.
READINGS = (STIFF, HEAVY)
AS_PRINTED = ("as_printed",)
# The free-free equations as printed have the frame term, and no tension.
FRAME = ("tension",)
ENOUGH = 6
SPEED = 90.0
# The converged curve lies under the others as a pale band.
BAND: dict[str, Any] = {"color": "0.25", "lw": 3.0, "alpha": 0.35}
CONVERGED = f"{ENOUGH} overhang modes (converged)"
# Crank angles of a turn at which deflections are given, and their error over the peak of each mode.
_GIVEN, _FINE = 720, 1e-5
# Places along the rod.
_STATIONS = 201
_RATIO, _QUOTED = 0.2, 900.0
_COMPLETE: tuple[str, ...] = ()
# Speeds of the chart [rad/s].
_SPEEDS = np.linspace(500.0, 4000.0, 1401)


def rod(
    scene: str, formulation: str, modes: int, drop: Sequence[str] = AS_PRINTED, **more: Any
) -> LinearPeriodic:
    """Return the system of a scene in another formulation; ``rod__damping`` is ``rod.damping``."""
    changes = {"model.formulation": formulation, "model.modes": modes, "model.drop": list(drop)}
    overrides = {**changes, **{key.replace("__", "."): value for key, value in more.items()}}
    return load_scene(scene, overrides=overrides).linear_system()


def tip_from_rest(
    system: LinearPeriodic,
    speed: float,
    turns: int = 1,
    samples: int = _GIVEN,
    places: ArrayLike = 1.0,
) -> tuple[Array, Array]:
    """Return crank angles and the deflection [m] of a rod that starts undeflected, at rest.

    At the tip, or at places x/length, shape ``(nt, nx)``.
    """
    motion = simulate(system, speed, turns, rtol=_FINE, samples=samples)
    shapes = system.shapes(np.atleast_1d(places), motion.theta)
    assert shapes is not None, "a rod has mode shapes"
    bent = system.reference_length * np.einsum("txn,tn->tx", shapes, motion.q)
    return motion.theta, bent if np.ndim(places) else bent[:, 0]


@lru_cache(maxsize=64)
def stiff_tip(
    scene: str, formulation: str, modes: int, drop: tuple[str, ...] = AS_PRINTED
) -> tuple[Array, Array]:
    """Return the first turn of the stiff rod: crank angles and the tip's deflection [m]."""
    return tip_from_rest(rod(scene, formulation, modes, drop), SPEED)


def _gap(one: Array, other: Array) -> float:
    """Return the largest difference over the other's peak."""
    return peak(one - other) / peak(other)


def _draw(ax: Axes, run: tuple[Array, Array], label: str, **look: Any) -> Array:
    """Draw the deflection of a tip over the crank angle, and return it."""
    theta, tip = run
    ax.plot(np.degrees(theta), 1e3 * tip, label=label, **look)
    return tip


def turns(values: Array) -> int:
    """Return how often a curve turns round between its ends."""
    return int(np.count_nonzero(np.diff(np.sign(np.diff(values)))))


def polynomials(axes: Panels, modes: int) -> Drawn:
    """Draw the large crank's tip with so many polynomial modes (Figs. 2 and 3)."""
    values: list[float] = []
    for ax, scene in zip(axes, READINGS, strict=True):
        exact = _draw(ax, stiff_tip(scene, "overhang", ENOUGH), CONVERGED, **BAND)
        for count, (style, colour) in {10: ("--", COLOURS[1]), modes: ("-", COLOURS[0])}.items():
            run = stiff_tip(scene, "polynomial", count)
            _draw(ax, run, f"{count} polynomial modes", color=colour, ls=style)
        three, ten = (stiff_tip(scene, "polynomial", count)[1] for count in (3, 10))
        if modes == 3:
            values += [peak(three) / peak(ten), _gap(three, ten), turns(three)]
        else:
            values += [peak(ten) / peak(exact), turns(ten)]
    return Drawn(values)


def _linkage() -> QuickReturn:
    return cast("QuickReturn", load_scene(STIFF).mechanism())


@lru_cache(maxsize=4)
def _stiff_shapes(scene: str) -> tuple[Array, Array]:
    """Return crank angles and the whole rod's deflection [m], converged, tension kept."""
    # At evenly spaced places from pin to tip, shape (nt, places), for the first turn.
    system = rod(scene, "overhang", ENOUGH, _COMPLETE)
    return tip_from_rest(system, SPEED, places=np.linspace(0.0, 1.0, _STATIONS))


def components(scene: str) -> tuple[Array, Array, Array]:
    """Return crank angles and the tip deflection's components U3 and V2 [m], converged."""
    theta, bent = _stiff_shapes(scene)
    direction = np.asarray(_linkage().motion(theta).theta4)
    return theta, -bent[:, -1] * np.sin(direction), bent[:, -1] * np.cos(direction)


def figure_4(axes: Panels) -> Drawn:
    """Draw the linkage at some crank angles, and both components for both mass readings."""
    _draw_linkage(axes[0])
    values: list[float] = []
    for ax, scene in zip(axes[1:], READINGS, strict=True):
        theta, across, up = components(scene)
        angle = np.degrees(theta)
        ax.plot(angle, 1e3 * up, color=COLOURS[0], label="$V_2$, across the base (j)")
        ax.plot(angle, 1e3 * across, "--", color=COLOURS[1], label="$U_3$, along the base (i)")
        moved, whole = np.abs(up) > 1e-3 * peak(up), np.hypot(across, up)
        share = peak(across[moved] / up[moved])
        values += [share, peak(whole - np.abs(up)) / peak(whole), lean(scene), turns(up)]
    return Drawn(values)


def _draw_linkage(ax: Axes) -> None:
    """Draw the mechanism to scale [cm], one position full and the others pale."""
    linkage, cm, shown = _linkage(), 100.0, 60.0
    centre = np.array([linkage.frame, 0.0]) * cm
    sketch.canvas(ax)
    around = np.linspace(0.0, 2.0 * np.pi, 181)
    circle = centre[:, None] + linkage.crank * cm * np.array([np.cos(around), np.sin(around)])
    ax.plot(*circle, color="0.75", lw=0.7, ls=(0, (4, 3)))
    for degrees in (0.0, 120.0, 180.0, 240.0, 300.0, shown):
        theta = np.radians(degrees)
        direction = float(linkage.motion(theta).theta4)
        tip = linkage.rod * cm * np.array([np.cos(direction), np.sin(direction)])
        block = centre + linkage.crank * cm * np.array([np.cos(theta), np.sin(theta)])
        alpha = 1.0 if degrees == shown else 0.25
        sketch.bar(ax, (0.0, 0.0), tip, "coupler", alpha=alpha, lw=2.6, zorder=2)
        sketch.bar(ax, centre, block, "crank", alpha=alpha, lw=2.6)
        away = 11.0 * (block - centre) / np.hypot(*(block - centre))
        sketch.write(ax, block, f"{degrees:.0f}°", away, fontsize=7, color="0.3")
        if degrees == shown:
            box = np.array([[-0.9, -0.5], [0.9, -0.5], [0.9, 0.5], [-0.9, 0.5]])
            turn = np.array([[tip[0], tip[1]], [-tip[1], tip[0]]]) / np.hypot(*tip)
            ax.fill(*(block + box @ turn).T, facecolor="w", edgecolor=sketch.INK, lw=1.0, zorder=5)
            sketch.pin(ax, block)
            sketch.write(ax, tip, "tip", (6.0, 9.0), style="italic")
    sketch.pivot(ax, (0.0, 0.0), 1.0)
    sketch.pivot(ax, centre, 1.0)
    sketch.write(ax, centre, "$C$", (0.0, -20.0))
    sketch.write(ax, (0.0, 0.0), "O", (-10.0, 5.0), style="italic")


def lean(scene: str) -> float:
    """Return the angle [deg] by which foreshortening turns the tip's largest displacement.

    The tip is drawn in by half the integral of the squared slope, to second order.
    """
    _, bent = _stiff_shapes(scene)
    last = bent[int(np.argmax(np.abs(bent[:, -1])))]
    along = np.linspace(0.0, _linkage().rod, _STATIONS)
    drawn_in = 0.5 * float(np.trapezoid(np.gradient(last, along) ** 2, along))
    return float(np.degrees(np.arctan2(drawn_in, abs(last[-1]))))


def figure_5(
    axes: Panels, dampings: Mapping[str, Mapping[str, Any]], looks: Mapping[str, Sequence[str]]
) -> Drawn:
    """Draw the first turn and the periodic motion of ten polynomial modes with 0.002 damping."""
    values, rows = [], []
    for ax, scene in zip(axes, READINGS, strict=True):
        _draw(ax, stiff_tip(scene, "polynomial", 10), "undamped, from rest", **BAND)
        mass = "read as lbm/in" if scene == STIFF else "read as lbf s^2/in^2"
        for name, changes in dampings.items():
            system = rod(scene, "polynomial", 10, **changes)
            theta, tip = tip_from_rest(system, SPEED)
            around = steady_state(system, SPEED, rtol=1e-8, samples=_GIVEN).deflection()
            settled = np.append(around, around[0])
            if look := looks.get(name):
                label, colour = look
                _draw(ax, (theta, tip), f"{label}, from rest", color=colour)
                _draw(ax, (theta, settled), f"{label}, periodic", color=colour, ls="--", lw=1.0)
            values.append(_gap(tip, settled))
            numbers = (1e3 * peak(tip), 1e3 * peak(settled), 100 * values[-1], turns(settled))
            rows.append((mass, name, *numbers))
    return Drawn(values, tables=[rows])


@lru_cache(maxsize=16)
def constrained_tip(scene: str, modes: int) -> tuple[Array, Array]:
    """Return crank angles and the tip's deflection [m] of the first turn.

    From the paper's initial conditions: undeformed, at the speeds of the rigid mechanism.
    """
    overrides = {"model.formulation": "free_free", "model.modes": modes, "model.drop": FRAME}
    system = cast("FreeFreeRod", load_scene(scene, overrides=overrides).system())
    run = constrained_motion(system, rtol=1e-6, samples=720)
    return system.speed * run.time, system.deflection(run.q, run.time, 1.0)[..., 0]


def _word(modes: int) -> str:
    return f"{modes} free-free mode{'s' if modes > 1 else ''}"


def figure_7(axes: Panels) -> Drawn:
    """Draw the flexible rod's tip at the small crank with one, two and three modes."""
    theta, exact = tip_from_rest(rod(FLEXIBLE, "overhang", ENOUGH, FRAME), 100.0)
    _draw(axes[0], (theta, exact), CONVERGED, **BAND)
    gaps = []
    for modes, colour, style in zip((1, 2, 3), COLOURS, ("-", "--", ":"), strict=False):
        run = constrained_tip(FLEXIBLE, modes)
        tip = _draw(axes[0], run, _word(modes), color=colour, ls=style)
        axes[1].plot(np.degrees(theta), 1e2 * (tip - exact) / peak(exact), style, color=colour)
        gaps.append(_gap(tip, exact))
    return Drawn([gaps[0], gaps[1] - gaps[2]])


def large_crank(axes: Panels, modes: int) -> Drawn:
    """Draw the stiff rod's tip with so many free-free modes (Figs. 8 to 10)."""
    values: list[float] = []
    for ax, scene in zip(axes, READINGS, strict=True):
        exact = _draw(ax, stiff_tip(scene, "overhang", ENOUGH, FRAME), CONVERGED, **BAND)
        ten = stiff_tip(scene, "polynomial", 10)
        printed = _draw(ax, ten, "10 polynomial modes", color=COLOURS[1], ls="--")
        free = stiff_tip(scene, "free_free_linear", modes, FRAME)
        linear = _draw(ax, free, f"{_word(modes)}, linear", color=COLOURS[2])
        if modes > 1:
            fewer = stiff_tip(scene, "free_free_linear", modes - 2, FRAME)[1]
            values.append(_gap(linear, exact) / _gap(fewer, exact))
        values.append(_gap(linear, printed))
        # With more modes the constrained form of the light rod takes thousands of steps a turn.
        if scene == HEAVY or modes == 1:
            held, label = constrained_tip(scene, modes), f"{_word(modes)}, with constraints"
            tip = _draw(ax, held, label, color=COLOURS[0], ls=":", lw=2.0)
            values.append(_gap(tip, linear))
    return Drawn(values)


@lru_cache(maxsize=16)
def _rod(
    formulation: str, modes: int, drop: tuple[str, ...], ratio: float = _RATIO
) -> LinearPeriodic:
    return rod(FLEXIBLE, formulation, modes, drop, links__crank_ratio=ratio)


def mean_frequency(formulation: str = "polynomial", modes: int = 3, ratio: float = _RATIO) -> float:
    """Return the mean first natural frequency [rad/s] over the crank angle."""
    return float(natural_frequencies(_rod(formulation, modes, AS_PRINTED, ratio), 0.0, 1).mean[0])


def figure_11(axes: Panels) -> Drawn:
    """Draw the first natural frequency with the crank held, against its angle."""
    ax = axes[0]
    for formulation, modes, style, colour in (
        ("polynomial", 3, "-", COLOURS[0]),
        ("overhang", ENOUGH, "--", COLOURS[1]),
    ):
        held = natural_frequencies(_rod(formulation, modes, AS_PRINTED))
        label = f"{modes} {formulation} modes, mean {held.mean[0]:.1f} rad/s"
        ax.plot(np.degrees(held.theta), held.frequency[:, 0], style, color=colour, label=label)
        ax.axhline(held.mean[0], color=colour, lw=0.6, ls=(0, (1, 3)))
    first = natural_frequencies(_rod("polynomial", 3, AS_PRINTED)).frequency[:, 0]
    return Drawn([mean_frequency(), np.max(first) / np.min(first)])


def figure_12(axes: Panels) -> Drawn:
    """Draw the tip from rest near the mean frequency: three polynomials, and converged modes."""
    mean, heights, turns = mean_frequency(), [], 60
    runs = (
        ("polynomial", 3, AS_PRINTED, mean),
        ("polynomial", 3, AS_PRINTED, _QUOTED),
        ("overhang", ENOUGH, AS_PRINTED, _QUOTED),
        ("overhang", ENOUGH, _COMPLETE, _QUOTED),
    )
    for k, (formulation, modes, drop, speed) in enumerate(runs):
        system = _rod(formulation, modes, drop)
        theta, tip = tip_from_rest(system, speed, turns=turns, samples=192)
        physics = "as printed" if drop else "with tension"
        label = f"{modes} {formulation} modes, {physics}, {speed:.4g} rad/s"
        axes[k // 2].plot(theta / (2 * np.pi), tip, color=COLOURS[k], lw=0.7, label=label)
        heights.append(np.abs(tip[1:]).reshape(turns, -1).max(axis=1))
    three = heights[0]
    values = [np.max(three), np.min(three) / np.max(three)]
    values += [peak(_motion(*runs[k]).multipliers) for k in (0, 2)]
    rows = []
    speeds = (_QUOTED, mean, mean_frequency("overhang", ENOUGH))
    for drop in (AS_PRINTED, _COMPLETE):
        for formulation, modes in (("polynomial", 3), *(("overhang", n) for n in (2, 4, ENOUGH))):
            cells = [f"{modes} {formulation} modes", "as printed" if drop else "with tension"]
            for speed in speeds:
                motion = _motion(formulation, modes, drop, speed)
                growth = 0.0 if motion.stable else float(motion.growth)
                cells.append(f"{peak(motion.multipliers):.5f}, {growth:.2f} 1/s")
            rows.append(cells)
    return Drawn(values, {"speeds": speeds}, [rows])


def _motion(
    formulation: str, modes: int, drop: tuple[str, ...], speed: float, ratio: float = _RATIO
) -> FloquetMultipliers:
    return floquet_multipliers(_rod(formulation, modes, drop, ratio), speed, rtol=1e-9)


@lru_cache(maxsize=4)
def resonances(ratio: float) -> ResonanceCurve:
    """Return the damped resonance curve of the flexible rod's tip at a crank ratio.

    Two overhang modes, with tension; internal damping, 1 % of critical in the first mode.
    """
    system = _rod("overhang", 2, _COMPLETE, ratio)
    stiffness = 0.7e11 * 0.5208e-6
    drag = 2 * 0.01 * stiffness / mean_frequency("overhang", 2, ratio)
    speeds = np.geomspace(150.0, 1000.0, 240)
    return resonance_curve(system.with_parameters(internal_damping=drag), speeds)


def figure_resonances(axes: Panels) -> Drawn:
    """Draw the largest steady tip deflection against the crank speed, for three crank ratios."""
    ax = axes[0]
    values: list[float] = []
    for ratio in (0.05, 0.1, _RATIO):
        curve = resonances(ratio)
        curve.plot(ax).lines[-1].set_label(f"crank ratio {ratio:g}")
        mean, first = float(curve.mean_frequency[0]), curve.mode == 1
        at = zip(curve.order[first], curve.maxima[first], strict=True)
        values += [order * speed / mean for order, speed in at if order <= 4]
        system = _rod("polynomial", 3, AS_PRINTED, ratio)
        values.append(peak(tip_from_rest(system, mean_frequency(ratio=ratio) / 10, turns=10)[1]))
        for order in range(1, 6) if ratio == _RATIO else ():
            ax.axvline(mean / order, color="0.7", lw=0.6, ls=(0, (1, 3)))
    return Drawn(values)


@lru_cache(maxsize=4)
def chart(formulation: str, modes: int, drop: tuple[str, ...]) -> StabilityChart:
    """Return the flexible rod's stability over crank speed and crank ratio."""
    system = _rod(formulation, modes, drop, 0.1)
    return stability_chart(system, ("speed", _SPEEDS), ("crank_ratio", np.linspace(0.01, 0.2, 191)))


@lru_cache(maxsize=4)
def frequencies(formulation: str, modes: int) -> Array:
    """Return the natural frequencies [rad/s] of the rod as the crank's length goes to zero."""
    return natural_frequencies(_rod(formulation, modes, AS_PRINTED, 1e-6)).mean


def figure_chart(axes: Panels, bases: Sequence[Sequence[Any]], looks: Looks) -> Drawn:
    """Draw two bases, three polynomials and four overhang modes, with and without tension."""
    from matplotlib.colors import ListedColormap

    kinds = (-1, 1, 2)
    colours, rows = ListedColormap(["#ffffff", *(look["color"] for look in looks)]), []
    for ax, (formulation, modes, drop, words) in zip(axes, bases, strict=True):
        points = chart(formulation, modes, tuple(drop))
        codes = sum((points.kind == kind) * i for i, kind in enumerate(kinds, start=1))
        ax.pcolormesh(points.x, points.y, codes, cmap=colours, vmin=0, vmax=3, rasterized=True)
        _mark(ax, frequencies(formulation, modes))
        panel_title(ax, f"{modes} {formulation} modes, {words}")
        shares = (100.0 * float(np.mean(points.kind == kind)) for kind in kinds)
        rows.append((f"{modes} {formulation}", words, *shares, np.max(points.error)))
    for look in looks:
        axes[0].fill([], [], **look)
    # Frequencies of two bases, a practical rod's multiplier, where regions start.
    three, four = frequencies("polynomial", 3), frequencies("overhang", 4)
    values = [three[0] / four[0], (three[0] + three[1]) / (four[0] + four[1])]
    values.append(peak(_motion("overhang", 2, AS_PRINTED, 20.0, 0.3).multipliers))
    values += [_start(0, 0, 1, 0.01), _start(0, 1, 1, 0.01), _start(1, 1, 2, 0.05)]
    return Drawn(values, tables=[rows])


def _mark(ax: Axes, omega: Array) -> None:
    """Mark the speeds from which regions start, at the foot of the axes, where they fit."""
    places = sorted(
        (float((omega[i] + omega[j]) / n), _name(i, j, n))
        for i, j in combinations_with_replacement(range(2), 2)
        for n in range(1, 4)
    )
    places = [place for place in places if _SPEEDS[0] <= place[0] <= _SPEEDS[-1]]
    speeds = np.array([speed for speed, _ in places])
    ax.plot(speeds, np.zeros(len(speeds)), "^", color="0.2", ms=4, zorder=6)
    ax.axhline(0.0, color="0.2", lw=0.7)
    # Marks closer than 150 rad/s share one label.
    apart = np.flatnonzero(np.diff(speeds) >= 150.0) + 1
    for i, group in enumerate(np.split(np.arange(len(places)), apart)):
        # Neighbours stand on two lines, so that they do not meet.
        names, look = (
            ", ".join(places[k][1] for k in group),
            {**ABOVE, "va": "top", "fontsize": 6.5},
        )
        ax.annotate(names, (np.mean(speeds[group]), 0.0), (0.0, -4.0 - 9.0 * (i % 2)), **look)


def _name(i: int, j: int, n: int) -> str:
    if i == j and n == 2:
        return rf"$\omega_{i + 1}$"
    above = rf"2\omega_{i + 1}" if i == j else rf"\omega_{i + 1}+\omega_{j + 1}"
    if n == 1:
        return f"${above}$"
    return f"${above}/{n}$" if i == j else f"$({above})/{n}$"


def _start(i: int, j: int, n: int, ratio: float) -> float:
    """Return the middle of a region at a crank ratio over where it should start."""
    points, omega = chart("overhang", 4, AS_PRINTED), frequencies("overhang", 4)
    start = float(omega[i] + omega[j]) / n
    row = points.kind[int(np.argmin(np.abs(points.y - ratio)))]
    kind = 2 if i != j else (-1) ** n
    near = points.x[(row == kind) & (np.abs(points.x - start) < 0.05 * start)]
    return (float(np.mean(near)) if len(near) else float("nan")) / start
