"""Smith's Figs. 45 and 47 to 51: mode shapes of the calibration, wave-forms of the coupler."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import LinearRangeWarning
from ..core.families import LinearPeriodic
from ..hill import discriminant
from ..periodic import simulate
from ..scenes import load_scene
from .records import Drawn, Quoted
from .smith_linkages import RIG, Array
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RIG = RIG["84"]
# Between the least and the greatest logarithmic decrement measured at 1/16 in (section 9.5.5).
_DECREMENT = 0.075
_SAMPLES = 512
_NOTE = (
    "Which coupler and which follower inertia is not said: the 1/16 in coupler and the least "
    "inertia are taken. Periodic response with viscous damping of logarithmic decrement "
    f"{_DECREMENT:g} at rest, the middle of the range measured for this coupler; the deflection is "
    "that of the middle, positive towards +y of the coupler's axes. The thesis's programme has no "
    "damping and starts from given values, which are not stated: the dashed curve starts from rest."
)


@lru_cache(maxsize=8)
def _system(equation: str, damped: bool) -> LinearPeriodic:
    ratio = _DECREMENT / (2 * pi) if damped else 0.0
    scene = load_scene(
        _RIG.scene,
        overrides={"model.formulation": equation, "coupler.damping_ratio": ratio},
    )
    return scene.linear_system()


def periodic_response(system: LinearPeriodic, speed: float) -> tuple[Array, Array]:
    """Return crank angles over one closed turn and the first mode's periodic motion at them.

    Parameters
    ----------
    system : LinearPeriodic
        One mode, damped and forced.
    speed : float
        Crank speed [rad/s].
    """
    from ..periodic import steady_state

    with warnings.catch_warnings():
        # Resonant amplitudes may pass the linear range; the figure's own note says so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        state = steady_state(system, speed, samples=_SAMPLES)
    q = state.q[:, 0]
    return np.append(state.theta, 2 * pi), np.append(q, q[0])


def _from_rest(system: LinearPeriodic, speed: float) -> tuple[Array, Array]:
    """Return crank angles of one turn and the first mode from rest."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        run = simulate(system, speed, 1.0, initial=(0.0, 0.0), samples=_SAMPLES)
    return run.theta, run.q[:, 0]


def wave_figure(divisor: float) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws the wave-form at the speed Omega/divisor."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        speed = _RIG.frequency / divisor
        length = 1e3 * _system("complete", True).reference_length
        for equation, label, colour in (
            ("reduced", "equation of the thesis (6.18)", COLOURS[0]),
            ("complete", "complete equation", COLOURS[1]),
        ):
            theta, q = periodic_response(_system(equation, True), speed)
            ax.plot(np.degrees(theta), length * q, color=colour, label=f"{label}, damped")
        theta, q = _from_rest(_system("reduced", False), speed)
        ax.plot(
            np.degrees(theta),
            length * q,
            "--",
            color=COLOURS[4],
            label="(6.18), undamped, from rest",
        )
        crank_axis(ax)
        ax.set_ylabel("deflection of the middle [mm]")
        legend_below([ax], columns=3)
        return Drawn(tuple(_rows(divisor, speed)), (_NOTE, *_WAVE_NOTES.get(divisor, ())))

    return draw


_WAVE_NOTES = {
    3.0: (
        "The list of figures and the captions give Omega/3 for Fig. 49 and Omega/4 for Fig. 50; "
        "section 9.5.2 speaks of a quarter of the frequency in Fig. 49.",
    ),
    4.0: (
        "Section 9.5.2 calls Fig. 49 the one at a quarter of the frequency, and this one the next "
        "resonant speed.",
    ),
    4.7: ("Only the undamped curve can show 4.7 vibrations: a periodic one holds whole numbers.",),
}


def _rows(divisor: float, speed: float) -> list[Quoted]:
    rows = [
        Quoted(
            f"free vibrations in one crank cycle, {name} equation",
            divisor,
            _vibrations(name, speed),
            0.05,
            "half of the last digit of 4.7",
            "9.5.2",
        )
        for name in ("reduced", "complete")
    ]
    if divisor == round(divisor):
        rows.append(
            Quoted(
                f"harmonic {divisor:g} over the same at a speed 3 % lower",
                1.0,
                _harmonic(speed, int(divisor)) / _harmonic(0.97 * speed, int(divisor)),
                0.0,
                "'resonant': above 1, by (6.18) with the damping taken",
                "9.5.2",
                relation=">",
            )
        )
    return rows


def _harmonic(speed: float, number: int) -> float:
    """Return the amplitude of one harmonic of the damped periodic response by (6.18)."""
    _, q = periodic_response(_system("reduced", True), speed)
    return float(np.abs(np.fft.rfft(q[:-1])[number]))


def _vibrations(equation: str, speed: float) -> float:
    """Return the undamped characteristic exponent: free vibrations in one crank cycle."""
    f = _RIG.form(equation).function(speed)
    lam2 = (_RIG.frequency / speed) ** 2
    half = float(discriminant(f, lam2, 1.0).value)
    # Within a region the exponent has the region's own real part.
    part = float(np.arccos(np.clip(half, -1.0, 1.0))) / (2 * pi)
    # The half trace fixes it up to sign and whole numbers; the mean stiffness says which.
    near = float(np.sqrt(lam2 + f.mean))
    candidates = [whole + sign * part for whole in range(int(near) + 3) for sign in (-1, 1)]
    return min(candidates, key=lambda value: abs(value - near))


def figure_45(axes: Sequence[Axes]) -> Drawn:
    """Draw the sine and the shape under a central load over half the coupler."""
    x = np.linspace(0.0, 0.5, 251)
    sine, load = np.sin(pi * x), 3 * x - 4 * x**3
    ax = axes[0]
    ax.plot(x, sine, color=COLOURS[0], label=r"$\sin(\pi x/l)$")
    ax.plot(x, load, "--", color=COLOURS[1], label=r"$3(x/l) - 4(x/l)^3$")
    ax.set_xlim(0.0, 0.5)
    ax.set_xlabel("x/l")
    ax.set_ylabel("y")
    legend_below([ax])
    at = 0.1
    gap = 100.0 * (1.0 - (3 * at - 4 * at**3) / np.sin(pi * at))
    row = Quoted(
        "difference of the shapes at the gauges, x/l = 0.1",
        5.0,
        float(gap),
        0.0,
        "'less than 5 %' of the sine, the greater",
        "9.4.3",
        relation="<",
        unit="%",
    )
    return Drawn((row,))
