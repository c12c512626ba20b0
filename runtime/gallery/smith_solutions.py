"""Smith's Figs. 28 to 33: solutions of the coupler equation step by step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import LinearPeriodic
from ..hill import discriminant
from ..periodic import simulate
from ..periodic.equation import equation_of
from ..scenes import load_scene
from .drawing import COLOURS, Array, panel_title
from .historic_steps import de_vogelaere_maps, de_vogelaere_start, kutta_merson
from .records import Drawn
from .smith_linkages import f3_series, linkage_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# A wave of 20 degrees, as the text says of Fig. 28.
_LAMBDA = 18.0
_KUTTA_MERSON_RTOL = 1e-4
_MU = 0.5
_UNSTABLE, _STABLE = (0.25, 1.0, 2.25), (0.5, 1.5, 3.0)


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


@dataclass(frozen=True)
class _Run:
    """A march: crank angles ``(nt,)``, coordinates and time derivatives ``(nt, 1)``, the speed."""

    theta: Array
    q: Array
    qd: Array
    speed: float


@lru_cache(maxsize=32)
def _march(step: float, turns: int, start: tuple[float, float] | None = None) -> _Run:
    """March with de Vogelaere's method and a half step in degrees, against Smith's rule or not."""
    system, h = _system(1), np.radians(step)
    speed = _speed(system)
    equation = equation_of(system, speed, {}, forcing=start is None)

    def spring(theta: Array) -> Array:
        # q'' = P q + F of one freedom, whose A has no skew part.
        inertia = 1.0 / equation.at("mass", theta)[0]
        out = np.zeros((len(theta), 1 + equation.forced, 1 + equation.forced))
        stiffness = equation.at("stiffness", theta)[0]
        if "gyroscopic" in equation.fields:
            stiffness = stiffness - equation.slope("gyroscopic", theta)
        out[:, :1, :1] = inertia * stiffness
        if equation.forced:
            out[:, 0, 1] = inertia[:, 0, 0] * equation.at("force", theta)[0, :, 0]
        return out

    count, unit = round(180.0 / step), float(equation.scale[0, 0])
    maps = de_vogelaere_maps(spring, 2.0 * h * np.arange(float(count)), h)
    q, rate = (0.0, 0.0) if start is None else start
    one, zero = np.ones(int(equation.forced)), np.zeros(int(equation.forced))
    first = np.append(q / unit, one), np.append(rate / unit, zero)
    states = [de_vogelaere_start(spring, 0.0, h, *first)]
    for _ in range(turns):
        for matrix in maps:
            states.append(matrix @ states[-1])
    every = max(1, count // 360)
    kept = unit * np.array(states)[::every]
    theta = 2.0 * h * every * np.arange(float(len(kept)))
    slope = kept[:, 1 + equation.forced] / h
    return _Run(theta, kept[:, :1], speed * slope[:, None], speed)


def _kutta_merson(turns: int) -> _Run:
    """March from rest with the Kutta-Merson programme, values kept at each degree."""
    system = _system(1)
    speed = _speed(system)
    equation = equation_of(system, speed, {}, forcing=True)
    unit = float(equation.scale[0, 0])
    # The motion from rest has no size yet: that of the first quarter of a wave.
    begin = simulate(system, speed, 0.25 / _LAMBDA, samples=16 * round(_LAMBDA))
    peak = np.max(np.abs(begin.q)) / unit + np.max(np.abs(begin.qd)) / speed * unit
    theta = np.radians(np.arange(360.0 * turns + 1.0))
    run = kutta_merson(
        lambda angles: equation.generator(angles)[0],
        theta,
        np.array([0.0, 0.0, 1.0]),
        _KUTTA_MERSON_RTOL,
        np.full(3, 1e-2 * _KUTTA_MERSON_RTOL * peak),
        first=0.1 / _LAMBDA,
    )
    q = unit * run.states[:, :1]
    return _Run(theta, q, np.full_like(q, np.nan), speed)


def _remaining(step: float) -> float:
    """Return the amplitude of a free vibration after one turn over that at its start."""
    # Small enough to stay within the linear range, which a free vibration has no part in.
    size = 1e-3
    runs = [_march(step, 1, start) for start in ((size, 0.0), (0.0, size))]
    ends = [(run.q[-1, 0] / size, run.qd[-1, 0] / (size * run.speed)) for run in runs]
    return float(np.sqrt(abs(np.linalg.det(np.array(ends)))))


def _phase(run: _Run, turn: int) -> complex:
    """Return the fast vibration's complex amplitude over one turn, by a smooth window."""
    inside = (run.theta >= 2 * pi * (turn - 1)) & (run.theta <= 2 * pi * turn)
    theta, values = run.theta[inside], run.q[inside, 0]
    window = np.sin(0.5 * (theta - theta[0])) ** 4
    return complex(np.sum(values * window * np.exp(-1j * _LAMBDA * theta)))


def _line(ax: Axes, run: _Run, colour: str, label: str = "", style: str = "-") -> None:
    ax.plot(np.degrees(run.theta), 1e3 * run.q[:, 0], style, color=colour, lw=1.0, label=label)


def figure_28(axes: Sequence[Axes]) -> Drawn:
    """Draw solutions with a step that is too long and one that is short enough."""
    for ax, step, colour in zip(axes, (2.0, 1.0, 0.1), COLOURS, strict=False):
        _line(ax, _march(step, 2), colour)
        panel_title(ax, f"step length {step:g} deg")
    # What a half step of 2 degrees leaves of y'' = -(360/17)^2 y after one turn.
    h, waves = np.radians(2.0), 360.0 / 17.0
    maps = de_vogelaere_maps(lambda t: np.full((len(t), 1, 1), -waves * waves), np.zeros(1), h)
    decay = float(np.max(np.abs(np.linalg.eigvals(maps[0]))) ** (pi / h))
    left = [_remaining(step) for step in (2.0, 1.0, 0.1)]
    return Drawn([360.0 / (20.0 * _LAMBDA), left[0], decay, *left[1:]])


def methods(axes: Sequence[Axes], other: str) -> Drawn:
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


def figure_31(axes: Sequence[Axes]) -> Drawn:
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


def figure_32(axes: Sequence[Axes]) -> Drawn:
    """Draw the forcing of the first and the second mode."""
    theta = np.linspace(0.0, 2 * pi, 721)
    forcing = _system(3).array("f", theta)
    for m in (1, 2):
        axes[0].plot(np.degrees(theta), forcing[:, m - 1], label=f"mode {m}: $g_{m}$")
    # The right sides of (6.16) for the first two modes.
    linkage = linkage_of("(2,1,2,2)")
    motion = linkage.motion(theta)
    carried = 2.0 * linkage.crank / linkage.coupler * np.sin(motion.theta2 - motion.theta3)
    right = np.stack([2.0 / pi * (carried - motion.alpha3), motion.alpha3 / pi], axis=-1)
    peaks = np.max(np.abs(forcing), axis=0)
    odd = np.max(np.abs(forcing[:, 2] - forcing[:, 0] / 3.0))
    return Drawn([np.max(np.abs(forcing[:, :2] - right)), peaks[0] / peaks[2], odd])


def figure_33(axes: Sequence[Axes]) -> Drawn:
    """Draw three unstable and three stable solutions of the homogeneous equation."""
    f = f3_series("(2,1,2,2)")
    changes = {
        "function.a": [float(v) for v in f.a],
        "function.b": [float(v) for v in f.b],
        "parameters.mu": _MU,
        "parameters.damping": 0.0,
    }
    system = load_scene("hill_example", overrides=changes).linear_system()
    half = discriminant(f, np.array(_UNSTABLE + _STABLE), _MU).value
    for i, lam2 in enumerate(_UNSTABLE + _STABLE):
        run = simulate(system.with_parameters(lam2=lam2), 1.0, 6.0, initial=(1.0, 0.0))
        column, row = divmod(i, 3)
        ax = axes[2 * row + column]
        ax.plot(run.theta / (2 * pi), run.q[:, 0], color=COLOURS[1 - column], lw=1.0)
        kind = "unstable" if column == 0 else "stable"
        panel_title(ax, rf"$\lambda^2$ = {lam2:g}: {kind}")
    return Drawn(list(np.abs(half)))
