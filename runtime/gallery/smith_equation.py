"""Smith's Figs. 28 to 38: the coupler equation step by step, charts and space of its edges."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from .. import hill
from ..core.families import LinearPeriodic
from ..core.periodic_function import PeriodicFunction
from ..core.trigonometric import PeriodicArray, interpolated
from ..linkages import FourBar
from ..periodic import simulate
from ..scenes import load_scene
from .algorithms import de_vogelaere_maps, de_vogelaere_start, kutta_merson, second_order_form
from .drawing import COLOURS, Array, Axes, Looks, Panels, outline, panel_title, peak
from .records import Drawn
from .smith_linkages import linkage_of, series

_LINKAGE = linkage_of("(2,1,2,2)")
# A wave of 20 degrees, as the text says of Fig. 28.
_LAMBDA = 18.0
# Of the space: the region and the parameters' range.
_REGION, _REACH = 2, 0.6
# Crank angles, a coordinate and its derivative by the angle.
_Run = tuple[Array, Array, Array]


@lru_cache(maxsize=2)
def _system(modes: int) -> tuple[LinearPeriodic, float]:
    """Return (6.18) for linkage (2,1,2,2) with the 1/16 in coupler, 15 in long, and its speed."""
    changes = {"model.formulation": "reduced", "model.modes": modes}
    sizes = {"links.crank": "7.5 in", "links.follower": "15 in"}
    scene = load_scene("smith_1972_5152_sixteenth_inch", overrides=changes | sizes)
    system = scene.linear_system()
    square = system.array("K", 0.0)[0, 0, 0] / system.array("M", 0.0)[0, 0, 0]
    return system, float(np.sqrt(square)) / _LAMBDA


@lru_cache(maxsize=1)
def _equation() -> PeriodicArray:
    """Return the first mode's ``q'' = P q + F`` as a matrix on (q, 1)."""
    mass, _, stiffness, force = second_order_form(*_system(1), 512)
    samples = np.zeros((512, 2, 2))
    samples[:, 0] = np.stack([-stiffness[:, 0, 0], force[:, 0]], axis=-1) / mass[:, :, 0]
    return interpolated(samples, 2.0 * pi)


@lru_cache(maxsize=32)
def _march(step: float, turns: int, start: tuple[float, float] | None = None) -> _Run:
    """March with de Vogelaere's method and a half step in degrees, against Smith's rule or not."""
    # From rest, or without forcing from q and its derivative by the angle.
    h, count = np.radians(step), round(180.0 / step)
    maps = de_vogelaere_maps(_equation(), 2.0 * h * np.arange(float(count)), h)
    q, slope, forced = (0.0, 0.0, 1.0) if start is None else (*start, 0.0)
    y, rate = np.array([q, forced]), np.array([slope, 0.0])
    states = [de_vogelaere_start(_equation(), 0.0, h, y, rate)]
    for _ in range(turns):
        for matrix in maps:
            states.append(matrix @ states[-1])
    every = max(1, count // 360)
    kept = np.array(states)[::every]
    return 2.0 * h * every * np.arange(float(len(kept))), kept[:, 0], kept[:, 2] / h


def _kutta_merson(turns: int) -> _Run:
    """March from rest with the Kutta-Merson programme, values kept at each degree."""

    def generator(angles: Array) -> Array:
        # Of q, its derivative by the angle, and 1.
        rows = np.zeros((len(angles), 3, 3))
        rows[:, 0, 1] = 1.0
        rows[:, 1, ::2] = _equation()(angles)[:, 0]
        return rows

    # The motion from rest has no size yet: that of the first quarter of a wave.
    begin = simulate(*_system(1), 0.25 / _LAMBDA, samples=16 * round(_LAMBDA))
    sizes = [np.max(np.abs(values)) for values in (begin.q, begin.qd / begin.speed, 1.0)]
    theta, start = np.radians(np.arange(360.0 * turns + 1.0)), np.array([0.0, 0.0, 1.0])
    atol = 1e-6 * np.array(sizes)
    states = kutta_merson(generator, theta, start, 1e-4, atol, first=0.1 / _LAMBDA)
    return theta, states[:, 0], states[:, 1]


def _line(ax: Axes, run: _Run, colour: str, label: str = "", style: str = "-") -> None:
    ax.plot(np.degrees(run[0]), 1e3 * run[1], style, color=colour, lw=1.0, label=label)


def figure_28(axes: Panels) -> Drawn:
    """Draw solutions with a step that is too long and one that is short enough."""
    # Amplitude of a free vibration after one turn over that at its start.
    left = []
    for ax, step, colour in zip(axes, (2.0, 1.0, 0.1), COLOURS, strict=False):
        _line(ax, _march(step, 2), colour)
        panel_title(ax, f"step length {step:g} deg")
        runs = (_march(step, 1, start) for start in ((1.0, 0.0), (0.0, 1.0)))
        left.append(np.sqrt(abs(np.linalg.det([[q[-1], slope[-1]] for _, q, slope in runs]))))
    # What a half step of 2 degrees leaves of y'' = -(360/17)^2 y after one turn.
    h, waves = np.radians(2.0), 360.0 / 17.0
    maps = de_vogelaere_maps(lambda t: np.full((len(t), 1, 1), -waves * waves), np.zeros(1), h)
    decay = float(np.max(np.abs(np.linalg.eigvals(maps[0]))) ** (pi / h))
    return Drawn([left[0], decay, *left[1:]])


def methods(axes: Panels, other: str) -> Drawn:
    """Draw the first and the fourth cycle of two solutions (Figs. 29 and 30).

    De Vogelaere's with a half step of 0.5 degrees, beside another step or Kutta and Merson's.
    """
    runs = {"h = 0.5 deg": _march(0.5, 4), "h = 1 deg": _march(1.0, 4)}
    if other != "1 deg":
        first, second = "de Vogelaere, h = 0.5 deg", "Kutta-Merson, variable step"
        runs = {first: _march(0.5, 4), second: _kutta_merson(4)}
    # Of the fast vibration in the fourth cycle, by a smooth window: its phase, without sign.
    sizes = []
    for (name, run), colour, style in zip(runs.items(), COLOURS, ("-", "--"), strict=False):
        for ax in axes:
            _line(ax, run, colour, name, style)
        last = run[0] >= 6 * pi
        theta = run[0][last]
        window = np.sin(0.5 * (theta - theta[0])) ** 4
        sizes.append(np.sum(run[1][last] * window * np.exp(-1j * _LAMBDA * theta)))
    return Drawn([abs(np.degrees(np.angle(sizes[0] / sizes[1])))])


def figure_31(axes: Panels) -> Drawn:
    """Draw the first three modes, each on a scale of its own."""
    run = simulate(*_system(3), 1.0, samples=3240)
    # Coordinates less their means over one wave of their modes.
    fast, per_turn = np.full_like(run.q, np.nan), len(run.q) - 1
    for m, (ax, colour, values) in enumerate(zip(axes, COLOURS, run.q.T, strict=False), start=1):
        ax.plot(np.degrees(run.theta), 1e6 * values, color=colour, lw=0.9)
        panel_title(ax, f"mode {m}")
        ax.set_ylabel(rf"$10^6\,U_{m}$")
        wave = per_turn // (round(_LAMBDA) * m * m)
        kernel = np.full(wave + 1, 1.0 / wave)
        kernel[[0, -1]] *= 0.5
        slow = np.convolve(values, kernel, mode="valid")
        inside = slice(wave // 2, wave // 2 + len(slow))
        fast[inside, m - 1] = values[inside] - slow
    size = np.sqrt(2.0 * np.nanmean(fast**2, axis=0))
    rest, whole = np.nanmax(np.abs(run.q - fast), axis=0), np.max(np.abs(run.q), axis=0)
    ratios = [part[m] / part[m + 1] for part in (size, rest) for m in (0, 1)]
    return Drawn([*ratios, whole[0] / whole[2], whole[0] / whole[1]])


def figure_32(axes: Panels) -> Drawn:
    """Draw the forcing of the first and the second mode."""
    theta = np.linspace(0.0, 2 * pi, 721)
    forcing = _system(3)[0].array("f", theta)
    for m in (1, 2):
        axes[0].plot(np.degrees(theta), forcing[:, m - 1], label=f"mode {m}: $g_{m}$")
    peaks = np.max(np.abs(forcing), axis=0)
    odd = np.max(np.abs(forcing[:, 2] - forcing[:, 0] / 3.0))
    return Drawn([peaks[0] / peaks[2], odd])


def figure_33(axes: Panels) -> Drawn:
    """Draw three unstable and three stable solutions of the homogeneous equation."""
    f, mu = series(_LINKAGE), 0.5
    # Unstable and stable ones by turns.
    squares = (0.25, 0.5, 1.0, 1.5, 2.25, 3.0)
    function = {"function.a": f.a.tolist(), "function.b": f.b.tolist()}
    changes = {**function, "parameters.mu": mu, "parameters.damping": 0.0}
    system = load_scene("hill_example", overrides=changes).linear_system()
    half = hill.discriminant(f, squares, mu).value
    for ax, lam2, colour in zip(axes, squares, 3 * (COLOURS[1], COLOURS[0]), strict=True):
        run = simulate(system.with_parameters(lam2=lam2), 1.0, 6.0, initial=(1.0, 0.0))
        ax.plot(run.theta / (2 * pi), run.q[:, 0], color=colour, lw=1.0)
    # The unstable ones, at the left, come first.
    return Drawn([*np.abs(half[::2]), *np.abs(half[1::2])])


def _edges(ax: Axes, mu: Array, ends: Array, **look: Any) -> None:
    ax.plot(np.concatenate(ends).T, mu, lw=1.3, **look)


def _to_order(f: PeriodicFunction, mu: Array, regions: Sequence[int], order: int) -> Array:
    """Return both ends by (7.25), (7.37), also where they are poor, ``(2, regions, mu)``."""
    return np.stack([hill.boundary_series(f, n, order)(mu) for n in regions], axis=1)


def _shade(ax: Axes, f: PeriodicFunction, mu: Array, regions: Sequence[int], left: float) -> None:
    """Shade the unstable regions of a chart and draw their exact boundaries."""
    exact = hill.hill_boundaries(f, mu, regions)
    for low, high in zip(exact.lower, exact.upper, strict=True):
        ax.fill_betweenx(mu, np.maximum(low, left), high, color="#f4dcc8", lw=0)
    _edges(ax, mu, np.stack([exact.lower, exact.upper]), color=COLOURS[5], label="exact")


def figure_34(axes: Panels, looks: Looks) -> Drawn:
    """Draw exact, first-order and second-order boundaries of a typical linkage."""
    ax, f, regions = axes[0], series(_LINKAGE), (1, 2, 3, 4)
    mu = np.linspace(0.0, 1.5, 151)
    _shade(ax, f, mu, (0, *regions, 5, 6), -1.5)
    exact, words = hill.hill_boundaries(f, mu, (1,)), {}
    for order, name, look in zip((1, 2), ("first", "second"), looks, strict=True):
        near = _to_order(f, mu, (*regions, 5), order)
        _edges(ax, mu, near, **look)
        words[name] = peak(near[:, 0] - np.concatenate([exact.lower, exact.upper]))
    return Drawn(words=words)


def figure_35(axes: Panels, looks: Looks) -> Drawn:
    """Draw the unstable regions for four cranks, the other links being equal."""
    mu, regions, widths = np.linspace(0.0, 1.0, 121), (1, 2, 3), []
    for ax, crank in zip(axes, (0.5, 1.5, 3.0, 4.0), strict=True):
        f = series(FourBar(frame=6.0, crank=crank, coupler=6.0, follower=6.0))
        _shade(ax, f, mu, (0, *regions, 4), -1.0)
        _edges(ax, mu, _to_order(f, mu, regions, 2), **looks[0])
        widths.append(hill.hill_boundaries(f, 1.0, regions).width)
    short = widths[0]
    growth = min(float(np.min(b / a)) for a, b in pairwise(widths))
    return Drawn([short[1] / short[0], short[2] / short[0], growth])


def damped(axes: Panels, regions: list[int], dampings: list[float], top: float) -> None:
    """Draw regions for several dampings, exact and, of a single one, first order (Figs. 36, 37)."""
    f, ax = series(_LINKAGE), axes[0]
    for damping, colour in zip(dampings, COLOURS, strict=False):
        # Closer values above the tips, exact and by (7.51), where the outlines are flat.
        tips = 2.0 * damping * np.array(regions) / f.amplitudes[regions]
        if damping:
            exact = hill.critical_damping(f, None, regions, damping=damping).mu
            tips = np.concatenate([tips, exact])
        near = np.outer(tips, 1.0 + 1e-9 + np.linspace(0.0, 0.3, 1 + 30 // len(tips)) ** 2).ravel()
        mu = np.unique(np.concatenate([np.linspace(0.0, top, 181), near[near < top]]))
        drawn = {"exact": ("-", hill.hill_boundaries(f, mu, regions, damping=damping))}
        if len(regions) == 1:
            first = hill.perturbation_boundaries(f, mu, regions, damping=damping, outside="value")
            drawn["first order"] = ("--", first)
        for name, (style, ends) in drawn.items():
            for low, high in zip(ends.lower, ends.upper, strict=True):
                label = f"K = {damping:g}, {name}"
                ax.plot(*outline(low, high, mu), style, color=colour, label=label)


def space_ends(eps1: float, eps2: float, amounts: Array) -> tuple[Array, Array]:
    """Return both ends of the region in lam2 with ``amounts * (eps1 f1 + eps2 f3)``, (8.3)."""
    f = series(_LINKAGE, "f1") * eps1 + series(_LINKAGE) * eps2
    ends = hill.hill_boundaries(f, amounts, (_REGION,))
    return ends.lower[0], ends.upper[0]


def space_series(eps1: Array, eps2: Array, order: int) -> tuple[Array, Array]:
    """Return both ends to an order in the parameters."""
    both = [series(_LINKAGE, "f1"), series(_LINKAGE)]
    ends = hill.perturbation_boundaries(
        both, [eps1, eps2], (_REGION,), order=order, outside="value"
    )
    return ends.lower[0], ends.upper[0]


def figure_38(axes: Panels, lines: Sequence[Sequence[Any]]) -> Drawn:
    """Draw both boundary surfaces of one region and their first-order lines in the planes."""
    space: Any = axes[0]
    turn, amounts = np.linspace(0.0, 0.5 * pi, 41), np.linspace(0.0, 1.0, 33)
    ways = np.cos(turn), np.sin(turn)
    reach = np.minimum(_REACH / np.maximum(*ways), 2.0 * _REACH)
    rays = [space_ends(r * c, r * s, amounts) for r, c, s in zip(reach, *ways, strict=True)]
    eps1, eps2 = (np.outer(reach * way, amounts) for way in ways)
    for which, (colour, side) in enumerate(zip(COLOURS, ("lower", "upper"), strict=False)):
        sheet, label = np.stack([ray[which] for ray in rays]), f"{side} boundary, exact"
        space.plot_surface(
            eps1, sheet, eps2, color=colour, alpha=0.45, rcount=41, ccount=33, linewidth=0.0
        )
        for ray in range(0, len(turn), 10):
            space.plot(eps1[ray], sheet[ray], eps2[ray], color=colour, lw=0.7)
        space.plot(eps1[:, -1], sheet[:, -1], eps2[:, -1], color=colour, lw=0.9, label=label)
    _first_order(space, lines)
    space.plot([0.0, 0.0], [0.0, 1.75], [0.0, 0.0], color="0.2", lw=1.0)
    space.set_box_aspect((1.0, 1.7, 1.0), zoom=1.12)
    space.view_init(elev=22.0, azim=-28.0)
    # The least width in all directions, over parameters so small that second order adds less than
    # twice their size, and how harmonics fall.
    around, small = [], np.array([1e-4])
    for t in np.linspace(0.0, 2.0 * pi, 73):
        lower, upper = space_ends(float(np.cos(t)), float(np.sin(t)), small)
        around.append(float((upper - lower)[0] / small[0]))
    falls = [f.amplitudes[8] / f.amplitudes[1] for f in (series(_LINKAGE, "f1"), series(_LINKAGE))]
    # How far the ends to first and second order are off on both sides.
    share = np.array([0.8 * _REACH])
    words = {"share": float(share[0])}
    for side, (one, two) in {"left": (1.0, 0.0), "right": (0.0, 1.0)}.items():
        for order in (1, 2):
            near = np.array(space_series(share * one, share * two, order))
            words[f"{side}{order}"] = peak(near - space_ends(one, two, share))
    return Drawn([min(around), max(falls)], words)


def _first_order(space: Any, named: Sequence[Sequence[Any]]) -> None:
    """Draw the straight lines of the first order and name the points as the thesis does."""
    amounts, ink = np.array([0.0, 1.0]), "0.25"

    def name(place: tuple[float, float, float], text: str) -> None:
        space.plot(*([x] for x in place), "o", color=ink, ms=2.5, zorder=22)
        space.text(*place, f" {text}", fontsize=10, fontstyle="italic", zorder=23)

    for names, share, (eps1, eps2) in named:
        x, z = share * _REACH * eps1 * amounts, share * _REACH * eps2 * amounts
        lower, upper = space_series(x, z, 1)
        lines = ((lower, "--", ""), (upper, "--", ""), (0.5 * (lower + upper), ":", "middle, "))
        for letter, (line, style, lead) in zip(names, lines, strict=False):
            look: dict[str, Any] = {"color": ink, "lw": 1.0, "zorder": 20}
            space.plot(x, line, z, style, label=f"{lead}first order", **look)
            name((x[1], line[1], z[1]), letter)
        space.plot([x[1]] * 2, [lower[1], upper[1]], [z[1]] * 2, color=ink, lw=1.6, zorder=21)
    name((0.0, 0.25 * _REGION**2, 0.0), "P")
    name((0.0, 0.0, 0.0), "O")
