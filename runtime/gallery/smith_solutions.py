"""Smith's Figs. 28 to 33: solutions of the coupler equation step by step."""

from __future__ import annotations

from functools import lru_cache
from math import pi

import numpy as np

from ..core.families import LinearPeriodic
from ..core.trigonometric import PeriodicArray, interpolated
from ..hill import discriminant
from ..periodic import simulate
from ..scenes import load_scene
from .algorithms import de_vogelaere_maps, de_vogelaere_start, kutta_merson, second_order_form
from .drawing import COLOURS, Array, Axes, Panels, panel_title
from .records import Drawn
from .smith_linkages import linkage_of, series

# A wave of 20 degrees, as the text says of Fig. 28.
_LAMBDA = 18.0
# Crank angles, a coordinate and its derivative by the angle.
_Run = tuple[Array, Array, Array]


@lru_cache(maxsize=2)
def _system(modes: int) -> LinearPeriodic:
    """Return (6.18) for linkage (2,1,2,2) with the 1/16 in coupler, 15 in long."""
    changes = {"model.formulation": "reduced", "model.modes": modes}
    sizes = {"links.crank": "7.5 in", "links.follower": "15 in"}
    scene = load_scene("smith_1972_5152_sixteenth_inch", overrides=changes | sizes)
    return scene.linear_system()


def _speed(system: LinearPeriodic) -> float:
    stiffness = float(system.array("K", 0.0)[0, 0, 0] / system.array("M", 0.0)[0, 0, 0])
    return float(np.sqrt(stiffness)) / _LAMBDA


@lru_cache(maxsize=1)
def _equation() -> PeriodicArray:
    """Return the first mode's ``q'' = P q + F`` as a matrix on (q, 1)."""
    system = _system(1)
    mass, _, stiffness, force = second_order_form(system, _speed(system), 512)
    samples = np.zeros((512, 2, 2))
    samples[:, 0] = np.stack([-stiffness[:, 0, 0], force[:, 0]], axis=-1) / mass[:, :, 0]
    return interpolated(samples, 2.0 * pi)


@lru_cache(maxsize=32)
def _march(step: float, turns: int, start: tuple[float, float] | None = None) -> _Run:
    """March with de Vogelaere's method and a half step in degrees, against Smith's rule or not.

    From rest, or without forcing from q and its derivative by the angle.
    """
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
    begin = simulate(_system(1), _speed(_system(1)), 0.25 / _LAMBDA, samples=16 * round(_LAMBDA))
    sizes = [np.max(np.abs(values)) for values in (begin.q, begin.qd / begin.speed, 1.0)]
    theta = np.radians(np.arange(360.0 * turns + 1.0))
    rtol = 1e-4
    states = kutta_merson(
        generator,
        theta,
        np.array([0.0, 0.0, 1.0]),
        rtol,
        1e-2 * rtol * np.array(sizes),
        first=0.1 / _LAMBDA,
    )
    return theta, states[:, 0], states[:, 1]


def _remaining(step: float) -> float:
    """Return the amplitude of a free vibration after one turn over that at its start."""
    runs = (_march(step, 1, start) for start in ((1.0, 0.0), (0.0, 1.0)))
    ends = [[q[-1], slope[-1]] for _, q, slope in runs]
    return float(np.sqrt(abs(np.linalg.det(ends))))


def _phase(run: _Run, turn: int) -> complex:
    """Return the fast vibration's complex amplitude over one turn, by a smooth window."""
    theta, q, _ = run
    inside = (theta >= 2 * pi * (turn - 1)) & (theta <= 2 * pi * turn)
    window = np.sin(0.5 * (theta[inside] - theta[inside][0])) ** 4
    return complex(np.sum(q[inside] * window * np.exp(-1j * _LAMBDA * theta[inside])))


def _line(ax: Axes, run: _Run, colour: str, label: str = "", style: str = "-") -> None:
    ax.plot(np.degrees(run[0]), 1e3 * run[1], style, color=colour, lw=1.0, label=label)


def figure_28(axes: Panels) -> Drawn:
    """Draw solutions with a step that is too long and one that is short enough."""
    for ax, step, colour in zip(axes, (2.0, 1.0, 0.1), COLOURS, strict=False):
        _line(ax, _march(step, 2), colour)
        panel_title(ax, f"step length {step:g} deg")
    # What a half step of 2 degrees leaves of y'' = -(360/17)^2 y after one turn.
    h, waves = np.radians(2.0), 360.0 / 17.0
    maps = de_vogelaere_maps(lambda t: np.full((len(t), 1, 1), -waves * waves), np.zeros(1), h)
    decay = float(np.max(np.abs(np.linalg.eigvals(maps[0]))) ** (pi / h))
    left = [_remaining(step) for step in (2.0, 1.0, 0.1)]
    return Drawn([left[0], decay, *left[1:]])


def methods(axes: Panels, other: str) -> Drawn:
    """Draw the first and the fourth cycle of two solutions (Figs. 29 and 30).

    De Vogelaere's with a half step of 0.5 degrees, beside another step or Kutta and Merson's.
    """
    usual, step = _march(0.5, 4), other == "1 deg"
    looser = _march(1.0, 4) if step else _kutta_merson(4)
    names = ("h = 0.5 deg", "h = 1 deg")
    if not step:
        names = ("de Vogelaere, h = 0.5 deg", "Kutta-Merson, variable step")
    for ax in axes:
        _line(ax, usual, COLOURS[0], names[0])
        _line(ax, looser, COLOURS[1], names[1], "--")
    # Phase in degrees of the fast vibration in the fourth cycle, without sign.
    return Drawn([abs(np.degrees(np.angle(_phase(usual, 4) / _phase(looser, 4))))])


def _fast_parts(q: Array) -> Array:
    """Return coordinates of one turn less their means over one wave of their modes."""
    fast, per_turn = np.full_like(q, np.nan), len(q) - 1
    for m, values in enumerate(q.T, start=1):
        wave = per_turn // (round(_LAMBDA) * m * m)
        kernel = np.full(wave + 1, 1.0 / wave)
        kernel[[0, -1]] *= 0.5
        slow = np.convolve(values, kernel, mode="valid")
        inside = slice(wave // 2, wave // 2 + len(slow))
        fast[inside, m - 1] = values[inside] - slow
    return fast


def figure_31(axes: Panels) -> Drawn:
    """Draw the first three modes, each on a scale of its own."""
    system = _system(3)
    run = simulate(system, _speed(system), 1.0, samples=3240)
    for m, (ax, colour) in enumerate(zip(axes, COLOURS, strict=False), start=1):
        ax.plot(np.degrees(run.theta), 1e6 * run.q[:, m - 1], color=colour, lw=0.9)
        panel_title(ax, f"mode {m}")
        ax.set_ylabel(rf"$10^6\,U_{m}$")
    fast = _fast_parts(run.q)
    size = np.sqrt(2.0 * np.nanmean(fast**2, axis=0))
    slow = np.nanmax(np.abs(run.q - fast), axis=0)
    peak = np.max(np.abs(run.q), axis=0)
    ratios = [part[m] / part[m + 1] for part in (size, slow) for m in (0, 1)]
    return Drawn([*ratios, peak[0] / peak[2], peak[0] / peak[1]])


def figure_32(axes: Panels) -> Drawn:
    """Draw the forcing of the first and the second mode."""
    theta = np.linspace(0.0, 2 * pi, 721)
    forcing = _system(3).array("f", theta)
    for m in (1, 2):
        axes[0].plot(np.degrees(theta), forcing[:, m - 1], label=f"mode {m}: $g_{m}$")
    peaks = np.max(np.abs(forcing), axis=0)
    odd = np.max(np.abs(forcing[:, 2] - forcing[:, 0] / 3.0))
    return Drawn([peaks[0] / peaks[2], odd])


def figure_33(axes: Panels) -> Drawn:
    """Draw three unstable and three stable solutions of the homogeneous equation."""
    f, mu = series(linkage_of("(2,1,2,2)")), 0.5
    # Unstable and stable ones by turns.
    squares = (0.25, 0.5, 1.0, 1.5, 2.25, 3.0)
    changes = {
        "function.a": [float(v) for v in f.a],
        "function.b": [float(v) for v in f.b],
        "parameters.mu": mu,
        "parameters.damping": 0.0,
    }
    system = load_scene("hill_example", overrides=changes).linear_system()
    half = discriminant(f, squares, mu).value
    for ax, lam2, colour in zip(axes, squares, 3 * (COLOURS[1], COLOURS[0]), strict=True):
        run = simulate(system.with_parameters(lam2=lam2), 1.0, 6.0, initial=(1.0, 0.0))
        ax.plot(run.theta / (2 * pi), run.q[:, 0], color=colour, lw=1.0)
    # The unstable ones, at the left, come first.
    return Drawn([*np.abs(half[::2]), *np.abs(half[1::2])])
