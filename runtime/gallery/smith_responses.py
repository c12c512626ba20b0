"""Smith's frequency responses, Figs. 52 to 80: the coupler's steady motion against the speed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning
from ..core.families import LinearPeriodic
from ..scenes import load_scene
from .records import Drawn, Quoted
from .smith_linkages import LBF_IN_S2, RIG, RPM, Array, Rig
from .style import COLOURS, crank_axis, legend_below, panel_title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..periodic import SteadyState

_LEAST, _MOST = 0.0058, 0.0190
_POINTS = 241
# Orders whose marks have room for a label.
_LABELLED = 8
# Largest deflection drawn, and that up to which linear equations hold, over the coupler's length.
_DRAWN, _LINEAR = 0.15, 0.05


@dataclass(frozen=True)
class Response:
    """One recorded frequency response of chapter 9.

    Attributes
    ----------
    figure : str
        Its number.
    chart : str
        Number of the rig's stability chart, which names the rig.
    inertia : float
        Follower inertia [lbf in s^2].
    low, high : float
        Range of the crank speed [rpm]: as written in the text or beside the trace, else chosen.
    resonances : tuple of (float, int)
        Crank speed [rpm] of a resonance that the text quotes, and the n of Omega/n.
    notes : tuple of str
        What is to be said of it.
    """

    figure: str
    chart: str
    inertia: float
    low: float
    high: float
    resonances: tuple[tuple[float, int], ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def rig(self) -> Rig:
        """Linkage and coupler."""
        return RIG[self.chart]

    @property
    def title(self) -> str:
        """Title of the picture."""
        return f"Frequency response, linkage {self.rig.name}, I4 = {self.inertia:g} lbf in s2"


_FALLING = (
    "The trace was taken while the speed fell. The linear equation has one periodic motion at each "
    "speed, whichever way it is reached: what falling changes, the jump of a softening spring, is "
    "measured and lies beyond it.",
)
_ASKEW = (
    "The caption has 0.00788, the list of figures 0.00783 or 0.0079 lbf in s2; the inertia of the "
    "table is 0.0079.",
)
_RANGE = ("The range of the speed is not legible and was chosen.",)

RESPONSES = (
    Response("52", "83", _LEAST, 100.0, 470.0),
    Response("53", "85", 0.0079, 300.0, 420.0, ((350.0, 2),), (*_ASKEW, *_RANGE)),
    Response("56", "82", 0.0069, 150.0, 350.0, ((250.0, 3),)),
    Response("57", "82", 0.0079, 150.0, 350.0, ((250.0, 3),)),
    Response("58", "82", 0.0109, 150.0, 350.0),
    Response("59", "82", 0.0130, 150.0, 350.0),
    Response("60", "82", 0.0149, 150.0, 350.0),
    Response("61", "82", _MOST, 150.0, 350.0, ((220.0, 3),)),
    Response("62", "85", _LEAST, 300.0, 420.0, ((360.0, 2),), _RANGE),
    Response("63", "85", _LEAST, 400.0, 530.0, (), _RANGE),
    Response("65", "85", 0.0079, 300.0, 500.0, ((360.0, 2),), (*_ASKEW, *_RANGE)),
    Response("66", "85", _LEAST, 400.0, 500.0, (), (*_FALLING, *_RANGE)),
    Response("67", "85", _LEAST, 290.0, 420.0, (), (*_FALLING, *_RANGE)),
    Response("68", "85", 0.0079, 290.0, 500.0, (), (*_FALLING, *_ASKEW, *_RANGE)),
    Response("74", "83", _LEAST, 200.0, 600.0, ((300.0, 4), (400.0, 3), (600.0, 2))),
    Response("75", "83", _LEAST, 250.0, 520.0, ((300.0, 4), (400.0, 3)), _RANGE),
    Response("76", "83", 0.0109, 150.0, 320.0, (), _RANGE),
    Response("79", "84", _LEAST, 200.0, 600.0),
    Response("80", "84", _LEAST, 550.0, 1000.0),
)
RESPONSE = {one.figure: one for one in RESPONSES}

_NOTE = (
    "The document's curve is a recorded trace; drawn is the least and the greatest deflection of "
    "the coupler's middle over a turn in the periodic motion by the complete linear equation, one "
    "mode, with viscous damping of the logarithmic decrements measured at rest (9.5.5). Shaded: "
    "speeds at which that motion is unstable with the middle decrement. Dashed: 5 % of the "
    "coupler's length, beyond which linear equations do not describe the rig; peaks are cut off."
)
_UNDRAWN = (
    "Figs. 69 to 71, 77 and 78 show the non-linearity of the higher resonances and 72, 73 free "
    "vibrations: measured, not computed here; so is Fig. 64, the vibration of period 4 pi that "
    "damping just keeps in check."
)


@lru_cache(maxsize=64)
def coupler(scene: str, inertia: float, decrement: float) -> LinearPeriodic:
    """Return the coupler's vibration by the complete equation.

    Parameters
    ----------
    scene : str
        Built-in scene.
    inertia : float
        Follower inertia [lbf in s^2].
    decrement : float
        Logarithmic decrement at rest.
    """
    changes = {
        "model.formulation": "complete",
        "coupler.damping_ratio": decrement / (2 * pi),
        "follower.inertia": inertia * LBF_IN_S2,
    }
    return load_scene(scene, overrides=changes).linear_system()


def quiet_state(system: LinearPeriodic, speed: float | Array, samples: int = 256) -> SteadyState:
    """Return the periodic motion, warning of nothing."""
    from ..periodic import steady_state

    with warnings.catch_warnings():
        # At a resonance the linear range is left; the figures' notes say so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        return steady_state(system, speed, rtol=1e-6, samples=samples)


@dataclass(frozen=True)
class Envelope:
    """Extreme deflections of the coupler's middle against the crank speed.

    Attributes
    ----------
    speed : ndarray, shape (ns,)
        Crank speeds [rpm].
    least, greatest : ndarray, shape (ns,)
        Deflections [mm].
    stable : ndarray of bool, shape (ns,)
        Whether the periodic motion is stable.
    frequency : float
        Natural frequency of the coupler as a crank speed [rpm].
    """

    speed: Array
    least: Array
    greatest: Array
    stable: NDArray[np.bool_]
    frequency: float


@lru_cache(maxsize=64)
def envelope(figure: str, decrement: float) -> Envelope:
    """Return the extreme deflections that a figure shows, for a logarithmic decrement."""
    one = RESPONSE[figure]
    system = coupler(one.rig.scene, one.inertia, decrement)
    speed = np.linspace(one.low, one.high, _POINTS)
    motion = quiet_state(system, speed * RPM)
    middle = 1e3 * system.reference_length * motion.q[..., 0]
    stable = np.ones(len(speed), bool) if motion.stable is None else np.asarray(motion.stable)
    return Envelope(
        speed, middle.min(axis=-1), middle.max(axis=-1), stable, one.rig.frequency / RPM
    )


def decrements(rig: Rig) -> tuple[float, float, float]:
    """Return the least, the middle and the greatest logarithmic decrement measured at rest."""
    least, most = load_scene(rig.scene)["measured"]["log_decrement"]
    return float(least), 0.5 * float(least + most), float(most)


def response_figure(figure: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws one frequency response."""
    one = RESPONSE[figure]

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        low, middle, high = decrements(one.rig)
        for decrement, colour, width in (
            (low, COLOURS[1], 0.8),
            (middle, COLOURS[0], 1.3),
            (high, COLOURS[2], 0.8),
        ):
            found = envelope(figure, decrement)
            label = f"decrement {decrement:.3g}"
            front = 3.0 if decrement == middle else 2.0
            ax.plot(found.speed, found.greatest, color=colour, lw=width, label=label, zorder=front)
            ax.plot(found.speed, found.least, color=colour, lw=width, zorder=front)
        found = envelope(figure, middle)
        _shade(ax, found)
        _limits(ax, found, 1e3 * coupler(one.rig.scene, one.inertia, middle).reference_length)
        _fractions(ax, found)
        ax.set_xlim(one.low, one.high)
        ax.set_xlabel("crank speed [rpm]")
        ax.set_ylabel("deflection of the middle [mm]")
        legend_below(axes)
        from .smith_response_rows import response_rows

        return Drawn(response_rows(one), (_NOTE, *one.notes, _UNDRAWN))

    return draw


def _shade(ax: Axes, found: Envelope) -> None:
    """Mark the speeds at which the periodic motion is unstable."""
    ax.fill_between(
        found.speed,
        0.0,
        1.0,
        where=list(~found.stable),
        color="#f7e3d3",
        lw=0,
        step="mid",
        transform=ax.get_xaxis_transform(),
        label="unstable" if not np.all(found.stable) else None,
        zorder=0,
    )


def _limits(ax: Axes, found: Envelope, length: float) -> None:
    """Keep the axis to what can be read; mark how far linear equations hold."""
    top = max(float(np.max(np.abs(values))) for values in (found.least, found.greatest))
    end = min(1.15 * top, _DRAWN * length)
    ax.set_ylim(-end, end)
    for sign in (1.0, -1.0):
        if _LINEAR * length < end:
            ax.axhline(sign * _LINEAR * length, color="0.5", lw=0.7, ls="--", zorder=1)


def _fractions(ax: Axes, found: Envelope) -> None:
    for order in range(1, 13):
        speed = found.frequency / order
        if found.speed[0] < speed < found.speed[-1]:
            ax.axvline(speed, color="0.6", lw=0.7, ls=(0, (1, 3)), zorder=1)
        if found.speed[0] < speed < found.speed[-1] and order <= _LABELLED:
            ax.annotate(
                f"Ω/{order}",
                (speed, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(2, -8),
                textcoords="offset points",
                fontsize=7,
                color="0.4",
            )


def resonance(figure: str, speed: float) -> float:
    """Return the crank speed [rpm] of the greatest deflection's maximum nearest to a speed."""
    one = RESPONSE[figure]
    found = envelope(figure, decrements(one.rig)[0])
    height = found.greatest - found.least
    inner = (height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:])
    places = found.speed[1:-1][inner]
    return float(places[np.argmin(np.abs(places - speed))]) if len(places) else float("nan")


def wave(chart: str, inertia: float, speed: float) -> tuple[Array, Array]:
    """Return crank angles [rad] and the deflection of the coupler's middle [mm] at them.

    Parameters
    ----------
    chart : str
        Number of the rig's stability chart.
    inertia : float
        Follower inertia [lbf in s^2].
    speed : float
        Crank speed [rad/s].
    """
    rig = RIG[chart]
    system = coupler(rig.scene, inertia, decrements(rig)[1])
    motion = quiet_state(system, speed)
    return motion.theta, 1e3 * system.reference_length * motion.q[:, 0]


_ORDER, _BESIDE = 4, 0.04
_INERTIAS = (0.0058, 0.0079, 0.0109)


def figure_54(axes: Sequence[Axes]) -> Drawn:
    """Draw the wave-form below, at and above a resonance."""
    rig = RIG["84"]
    first = []
    for ax, factor, name in zip(
        axes, (1.0 - _BESIDE, 1.0, 1.0 + _BESIDE), ("below", "at", "above"), strict=True
    ):
        speed = factor * rig.frequency / _ORDER
        theta, bent = wave("84", _LEAST, speed)
        ax.plot(np.degrees(theta), bent, color=COLOURS[0])
        crank_axis(ax)
        panel_title(ax, f"{name} resonance: {speed / RPM:.0f} rpm")
        first.append(np.fft.rfft(bent)[_ORDER] / len(bent))
    axes[0].set_ylabel("deflection of the middle [mm]")
    turned = abs(float(np.degrees(np.angle(first[2] / first[0]))))
    rows = (
        Quoted(
            "fundamental vibration at resonance over the greater one beside it",
            1.0,
            float(abs(first[1]) / max(abs(first[0]), abs(first[2]))),
            0.0,
            "'rapid increase in amplitude of the fundamental vibration'",
            "9.5.3",
            relation=">",
        ),
        Quoted(
            "its phase above resonance against below",
            90.0,
            turned,
            0.0,
            "'changed phase relationship': more than a quarter of a wave",
            "9.5.3",
            relation=">",
            unit="deg",
        ),
    )
    note = (
        "Which resonance is not stated: Omega/4 is taken, and 4 % less and more, with the least "
        "follower inertia and the middle of the decrements measured."
    )
    return Drawn(rows, (note,))


def figure_55(axes: Sequence[Axes]) -> Drawn:
    """Draw the wave-form at one speed for several follower inertias."""
    ax, sizes = axes[0], []
    for inertia, colour in zip(_INERTIAS, COLOURS, strict=False):
        theta, bent = wave("82", inertia, 230.0 * RPM)
        ax.plot(np.degrees(theta), bent, color=colour, label=f"I4 = {inertia:g} lbf in s2")
        sizes.append(float(np.ptp(bent)))
    crank_axis(ax)
    ax.set_ylabel("deflection of the middle [mm]")
    legend_below(axes)
    row = Quoted(
        "least growth of the amplitude from one inertia to the next, ratio",
        1.0,
        float(np.min(np.array(sizes[1:]) / np.array(sizes[:-1]))),
        0.0,
        "'correspondingly increased vibrational amplitude'",
        "9.5.3",
        relation=">",
    )
    note = "The inertias are not legible: three of the table in section 9.4.1 are taken."
    return Drawn((row,), (note,))
