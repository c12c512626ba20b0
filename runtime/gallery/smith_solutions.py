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
from .historic_steps import de_vogelaere_maps, de_vogelaere_start, kutta_merson
from .records import Drawn, Quoted
from .smith_linkages import Array, f3_series, linkage_of
from .style import COLOURS, crank_axis, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# A wave of 20 degrees, as the text says of Fig. 28.
_LAMBDA = 18.0
_MODES = 3
_KUTTA_MERSON_RTOL = 1e-4
_MU = 0.5
_UNSTABLE, _STABLE = (0.25, 1.0, 2.25), (0.5, 1.5, 3.0)
_DATA = (
    "The text gives no data beyond a wavelength of about 20 deg: taken are lambda = 18, linkage "
    "(2,1,2,2), whose ratio of the modes' amplitudes is the one described under Fig. 31, the "
    "coupler 1/16 in thick and 15 in long with the least follower inertia of chapter 9, and a "
    "start from rest at 0 deg."
)
_HALF_STEP = (
    "By the listing of appendix 4 the step length h is half of the step after which values are "
    "kept; the decay below shows that the text uses it in this sense too. That listing halves h "
    "from 10 deg, and so could use 2.5, 1.25 or 0.625 deg but none of the steps of this figure."
)


@lru_cache(maxsize=1)
def _system() -> LinearPeriodic:
    """Return three modes of (6.18) for the data of :data:`_DATA`."""
    scene = load_scene(
        "smith_1972_5152_sixteenth_inch",
        overrides={
            "model.formulation": "reduced",
            "model.modes": _MODES,
            "links.crank": "7.5 in",
            "links.follower": "15 in",
        },
    )
    return scene.linear_system()


@lru_cache(maxsize=1)
def _first_mode() -> LinearPeriodic:
    scene = load_scene(
        "smith_1972_5152_sixteenth_inch",
        overrides={
            "model.formulation": "reduced",
            "links.crank": "7.5 in",
            "links.follower": "15 in",
        },
    )
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
    system, h = _first_mode(), np.radians(step)
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
    system = _first_mode()
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
    ends = []
    # Small enough to stay within the linear range, which a free vibration has no part in.
    size = 1e-3
    for start in ((size, 0.0), (0.0, size)):
        run = _march(step, 1, start)
        ends.append((run.q[-1, 0] / size, run.qd[-1, 0] / (size * run.speed)))
    return float(np.sqrt(abs(np.linalg.det(np.array(ends)))))


def _phase(run: _Run, turn: int) -> complex:
    """Return the fast vibration's complex amplitude over one turn, by a smooth window."""
    inside = (run.theta >= 2 * pi * (turn - 1)) & (run.theta <= 2 * pi * turn)
    theta, values = run.theta[inside], run.q[inside, 0]
    window = np.sin(0.5 * (theta - theta[0])) ** 4
    return complex(np.sum(values * window * np.exp(-1j * _LAMBDA * theta)))


def _lag(one: _Run, other: _Run, turn: int) -> float:
    """Return the phase between two runs in degrees of the fast vibration, without sign."""
    return float(abs(np.degrees(np.angle(_phase(one, turn) / _phase(other, turn)))))


def _line(ax: Axes, run: _Run, colour: str, label: str, style: str = "-") -> None:
    ax.plot(np.degrees(run.theta), 1e3 * run.q[:, 0], style, color=colour, lw=1.0, label=label)
    ax.set_ylabel(r"$10^3\,U_1$")


def figure_28(axes: Sequence[Axes]) -> Drawn:
    """Draw solutions with a step that is too long and one that is short enough."""
    for ax, step, colour in zip(axes, (2.0, 1.0, 0.1), COLOURS, strict=False):
        _line(ax, _march(step, 2), colour, f"h = {step:g} deg")
        crank_axis(ax, 2.0)
        panel_title(ax, f"step length {step:g} deg")
    for ax in axes[:-1]:
        ax.set_xlabel("")
    rows = (
        Quoted(
            "longest step for lambda = 18, h < 18/lambda",
            1.0,
            360.0 / (20.0 * _LAMBDA),
            1e-12,
            "exact",
            "6.2.3.1",
            unit="deg",
        ),
        Quoted(
            "fast vibration left after one crank cycle, step 2 deg",
            0.2,
            _remaining(2.0),
            0.0,
            "'almost disappeared' read as a fifth",
            "6.2.3.1",
            relation="<",
            differs="0.53 for a wave of 20 deg exactly, since the decay grows with the sixth power "
            "of lambda; a fifth needs a wave of 17 deg",
        ),
        Quoted(
            "the same for a wave of 17 deg",
            0.2,
            _free_decay(2.0, 360.0 / 17.0),
            0.02,
            "a tenth of it",
            "6.2.3.1",
            relation="<",
        ),
        Quoted(
            "fast vibration left after one crank cycle, step 1 deg",
            1.0,
            _remaining(1.0),
            0.05,
            "'approximately constant' read as 5 %",
            "6.2.3.1",
        ),
        Quoted(
            "the same, step 0.1 deg",
            1.0,
            _remaining(0.1),
            0.05,
            "'no essential change' read as 5 %",
            "6.2.3.1",
        ),
    )
    return Drawn(rows, (_DATA, _HALF_STEP))


def _free_decay(step: float, lam: float) -> float:
    """Return what de Vogelaere's method leaves of y'' = -lam^2 y after one turn.

    Parameters
    ----------
    step : float
        Half step [deg].
    lam : float
        Vibrations in one turn.
    """
    h = np.radians(step)

    def generator(theta: Array) -> Array:
        return np.full((len(theta), 1, 1), -lam * lam)

    step_map = de_vogelaere_maps(generator, np.zeros(1), h)[0]
    return float(np.max(np.abs(np.linalg.eigvals(step_map))) ** (pi / h))


def _cycles(axes: Sequence[Axes]) -> None:
    """Show the first and the fourth crank cycle."""
    for ax, turn in zip(axes, (1, 4), strict=True):
        ax.set_xlim(360.0 * (turn - 1), 360.0 * turn)
        ax.set_xticks([360.0 * (turn - 1) + 60.0 * i for i in range(7)])
        panel_title(ax, f"crank cycle {turn}")
    axes[-1].set_xlabel(r"crank angle $\theta_2$ [deg]")
    legend_below(axes[:1])


def figure_29(axes: Sequence[Axes]) -> Drawn:
    """Draw the first and the fourth crank cycle with steps of 1 and 0.5 degrees."""
    long, short = _march(1.0, 4), _march(0.5, 4)
    for ax in axes:
        _line(ax, long, COLOURS[1], "h = 1 deg", "--")
        _line(ax, short, COLOURS[0], "h = 0.5 deg")
    _cycles(axes)
    lag = _lag(long, short, 4)
    row = Quoted(
        "phase between steps of 1 and 0.5 deg in the fourth cycle",
        30.0,
        lag,
        0.0,
        "'slight' after 'a few cycles' read as a twelfth of a wave in the fourth",
        "6.2.3.1",
        relation="<",
        unit="deg of the wave",
    )
    return Drawn((row,), (_DATA,))


def figure_30(axes: Sequence[Axes]) -> Drawn:
    """Draw de Vogelaere's and the Kutta-Merson solution over four crank cycles."""
    ours = _march(0.5, 4)
    other = _kutta_merson(4)
    for ax in axes:
        _line(ax, ours, COLOURS[0], "de Vogelaere, h = 0.5 deg")
        _line(ax, other, COLOURS[1], "Kutta-Merson, variable step", "--")
    _cycles(axes)
    row = Quoted(
        "phase between the two methods in the fourth cycle",
        60.0,
        _lag(ours, other, 4),
        0.0,
        "'slight difference in frequency' read as a sixth of a wave in the fourth cycle",
        "6.2.3.1",
        relation="<",
        unit="deg of the wave",
    )
    note = (
        "The tolerance of the Kutta-Merson programme is not stated; taken is a relative "
        f"{_KUTTA_MERSON_RTOL:g} for one step, none longer than the 1 deg at which values are "
        "kept. A difference is the error of the looser method, no necessary feature of a variable "
        "step: here it cannot be seen."
    )
    return Drawn((row,), (_DATA, note))


def _modes() -> tuple[Array, Array, Array]:
    """Return angles [rad], coordinates and their fast parts over one turn."""
    system = _system()
    per_turn = 3240
    run = simulate(system, _speed(system), 1.0, samples=per_turn)
    fast = np.full_like(run.q, np.nan)
    for m in range(1, _MODES + 1):
        # The mean over one wave of the mode is the slow part.
        wave = per_turn // (round(_LAMBDA) * m * m)
        kernel = np.full(wave + 1, 1.0 / wave)
        kernel[[0, -1]] *= 0.5
        slow = np.convolve(run.q[:, m - 1], kernel, mode="valid")
        first = wave // 2
        inside = slice(first, first + len(slow))
        fast[inside, m - 1] = run.q[inside, m - 1] - slow
    return run.theta, run.q, fast


def figure_31(axes: Sequence[Axes]) -> Drawn:
    """Draw the first three modes, each on a scale of its own."""
    theta, q, fast = _modes()
    for m, (ax, colour) in enumerate(zip(axes, COLOURS, strict=False), start=1):
        ax.plot(np.degrees(theta), 1e6 * q[:, m - 1], color=colour, lw=0.9)
        ax.set_ylabel(rf"$10^6\,U_{m}$")
        crank_axis(ax)
        panel_title(ax, f"mode {m}")
        if m < _MODES:
            ax.set_xlabel("")
    return Drawn(tuple(_mode_rows(q, fast)), (_DATA,))


def _mode_rows(q: Array, fast: Array) -> list[Quoted]:
    size = np.sqrt(2.0 * np.nanmean(fast**2, axis=0))
    slow = np.nanmax(np.abs(q - fast), axis=0)
    return [
        Quoted(
            "fast part: first mode over second",
            10.0,
            float(size[0] / size[1]),
            0.0,
            "'more than an order of magnitude'",
            "6.2.3.2",
            relation=">",
        ),
        Quoted(
            "fast part: second mode over third",
            10.0,
            float(size[1] / size[2]),
            5.0,
            "'approximately the same' read as within a half",
            "6.2.3.2",
        ),
        Quoted(
            "slow part: first mode over second",
            10.0,
            float(slow[0] / slow[1]),
            0.0,
            "'a similar relationship' read as an order of magnitude",
            "6.2.3.2",
            relation=">",
        ),
        Quoted(
            "slow part: second mode over third",
            10.0,
            float(slow[1] / slow[2]),
            5.0,
            "'a similar relationship' read as within a half",
            "6.2.3.2",
        ),
        Quoted(
            "peak of the first mode over that of the third",
            100.0,
            float(np.max(np.abs(q[:, 0])) / np.max(np.abs(q[:, 2]))),
            0.0,
            "'two or three orders of magnitude', the lower",
            "6.2.2",
            relation=">",
        ),
        Quoted(
            "peak of the first mode over that of the second",
            100.0,
            float(np.max(np.abs(q[:, 0])) / np.max(np.abs(q[:, 1]))),
            0.0,
            "'two or three orders of magnitude', the lower",
            "6.2.2",
            relation=">",
            differs="one and a half orders; section 6.2.3.2 itself says 'more than an order'",
        ),
    ]


def figure_32(axes: Sequence[Axes]) -> Drawn:
    """Draw the forcing of the first and the second mode."""
    system = _system()
    theta = np.linspace(0.0, 2 * pi, 721)
    forcing = system.array("f", theta)
    ax = axes[0]
    for m, colour in zip((1, 2), COLOURS, strict=False):
        ax.plot(np.degrees(theta), forcing[:, m - 1], color=colour, label=f"mode {m}: $g_{m}$")
    crank_axis(ax)
    ax.set_ylabel(r"forcing $g_m(\theta_2)$")
    legend_below([ax])
    note = (
        "The caption's number (6.14) belongs to the end force; the forcing stands on the right of "
        "(6.16). Linkage (2,1,2,2), as for Fig. 28."
    )
    same = float(np.max(np.abs(forcing[:, 2] - forcing[:, 0] / 3.0)))
    peaks = np.max(np.abs(forcing), axis=0)
    rows = (
        Quoted(
            "forcing less the right side of (6.16), modes 1 and 2",
            0.0,
            float(np.max(np.abs(forcing[:, :2] - _right_side(theta)))),
            1e-12,
            "round-off",
            "6.2.2",
        ),
        Quoted(
            "peak of g_1 over that of g_3",
            3.0,
            float(peaks[0] / peaks[2]),
            1e-9,
            "'inversely proportional to the mode order', odd modes",
            "6.2.2",
        ),
        Quoted(
            "largest difference of g_3 and g_1/3",
            0.0,
            same,
            1e-12,
            "odd modes 'similar in form'",
            "6.2.3.2",
        ),
    )
    return Drawn(rows, (note,))


def _right_side(theta: Array) -> Array:
    """Return the right sides of Smith (6.16) for the first two modes, shape ``(nt, 2)``."""
    linkage = linkage_of("(2,1,2,2)")
    motion = linkage.motion(theta)
    carried = 2.0 * linkage.crank / linkage.coupler * np.sin(motion.theta2 - motion.theta3)
    return np.stack([2.0 / pi * (carried - motion.alpha3), motion.alpha3 / pi], axis=-1)


def figure_33(axes: Sequence[Axes]) -> Drawn:
    """Draw three unstable and three stable solutions of the homogeneous equation."""
    f = f3_series("(2,1,2,2)")
    scene = load_scene(
        "hill_example",
        overrides={
            "function.a": [float(v) for v in f.a],
            "function.b": [float(v) for v in f.b],
            "parameters.mu": _MU,
            "parameters.damping": 0.0,
        },
    )
    system = scene.linear_system()
    half = discriminant(f, np.array(_UNSTABLE + _STABLE), _MU).value
    rows = []
    for i, lam2 in enumerate(_UNSTABLE + _STABLE):
        run = simulate(system.with_parameters(lam2=lam2), 1.0, 6.0, initial=(1.0, 0.0))
        column, row = divmod(i, 3)
        ax = axes[2 * row + column]
        ax.plot(run.theta / (2 * pi), run.q[:, 0], color=COLOURS[1 - column], lw=1.0)
        kind = "unstable" if column == 0 else "stable"
        panel_title(ax, rf"$\lambda^2$ = {lam2:g}: {kind}")
        ax.set_xlim(0.0, 6.0)
        ax.set_ylabel("u")
        if row == 2:
            ax.set_xlabel("crank cycles")
        rows.append(
            Quoted(
                f"|half trace| at lambda^2 = {lam2:g}",
                1.0,
                float(abs(half[i])),
                0.0,
                f"{kind}: {'above' if column == 0 else 'below'} 1",
                "6.2.3.3",
                relation=">" if column == 0 else "<",
            )
        )
    note = (
        "Linkage and epsilon are not stated; taken are f3 of (2,1,2,2) and epsilon = "
        f"{_MU:g}, without forcing, from u = 1, u' = 0. The verdicts hold for epsilon from 0.1 "
        "to 0.5 at least."
    )
    return Drawn(tuple(rows), (note,))
