"""Smith's Figs. 45 to 80: wave-forms of the coupler and its steady motion against the speed."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import LinearRangeWarning
from ..core.families import LinearPeriodic
from ..hill import discriminant
from ..periodic import SteadyState, simulate, steady_state
from ..scenes import load_scene
from .drawing import COLOURS, Array, crank_axis, legend_below, panel_title
from .records import Drawn
from .smith_linkages import LBF_IN_S2, RIG, RPM, Rig

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RIG = RIG["84"]
# Between the least and the greatest logarithmic decrement measured at 1/16 in (section 9.5.5).
_DECREMENT = 0.075
_LEAST = 0.0058
# Largest deflection drawn, and that up to which linear equations hold, over the coupler's length.
_DRAWN, _LINEAR = 0.15, 0.05


def figure_45(axes: Sequence[Axes]) -> Drawn:
    """Draw the sine and the shape under a central load over half the coupler."""
    ax, x = axes[0], np.linspace(0.0, 0.5, 251)
    ax.plot(x, np.sin(pi * x), color=COLOURS[0], label=r"$\sin(\pi x/l)$")
    ax.plot(x, 3 * x - 4 * x**3, "--", color=COLOURS[1], label=r"$3(x/l) - 4(x/l)^3$")
    ax.set(xlim=(0.0, 0.5), xlabel="x/l", ylabel="y")
    legend_below([ax])
    at = 0.1
    return Drawn([100.0 * (1.0 - (3 * at - 4 * at**3) / np.sin(pi * at))])


@lru_cache(maxsize=64)
def coupler(
    scene: str, decrement: float, inertia: float | None = None, equation: str = "complete"
) -> LinearPeriodic:
    """Return the coupler's vibration by a formulation, with a logarithmic decrement at rest.

    The follower's inertia [lbf in s^2] is the scene's where none is given.
    """
    changes: dict[str, Any] = {
        "model.formulation": equation,
        "coupler.damping_ratio": decrement / (2 * pi),
    }
    if inertia is not None:
        changes["follower.inertia"] = inertia * LBF_IN_S2
    return load_scene(scene, overrides=changes).linear_system()


def quiet_state(system: LinearPeriodic, speed: float | Array, samples: int = 256) -> SteadyState:
    """Return the periodic motion, warning of nothing."""
    with warnings.catch_warnings():
        # At a resonance the linear range is left; the figures' notes say so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        return steady_state(system, speed, samples=samples)


def periodic_response(system: LinearPeriodic, speed: float) -> tuple[Array, Array]:
    """Return crank angles over one closed turn and the first mode's periodic motion at them."""
    state = quiet_state(system, speed, 512)
    return np.append(state.theta, 2 * pi), np.append(state.q[:, 0], state.q[0, 0])


def wave_form(axes: Sequence[Axes], divisor: float) -> Drawn:
    """Draw the wave-form at the speed Omega/divisor (Figs. 47 to 51)."""
    ax, speed = axes[0], _RIG.frequency / divisor
    damped = {name: coupler(_RIG.scene, _DECREMENT, None, name) for name in ("reduced", "complete")}
    length = 1e3 * damped["complete"].reference_length
    for equation, label, colour in (
        ("reduced", "equation of the thesis (6.18)", COLOURS[0]),
        ("complete", "complete equation", COLOURS[1]),
    ):
        theta, q = periodic_response(damped[equation], speed)
        ax.plot(np.degrees(theta), length * q, color=colour, label=f"{label}, damped")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        undamped = coupler(_RIG.scene, 0.0, None, "reduced")
        run = simulate(undamped, speed, 1.0, initial=(0.0, 0.0), samples=512)
    label = "(6.18), undamped, from rest"
    ax.plot(np.degrees(run.theta), length * run.q[:, 0], "--", color=COLOURS[4], label=label)
    crank_axis(ax)
    ax.set_ylabel("deflection of the middle [mm]")
    legend_below([ax], columns=3)
    values = [_vibrations(name, speed) for name in damped]
    if divisor == round(divisor):

        def harmonic(speed: float) -> float:
            _, q = periodic_response(damped["reduced"], speed)
            return float(np.abs(np.fft.rfft(q[:-1])[int(divisor)]))

        values.append(harmonic(speed) / harmonic(0.97 * speed))
    return Drawn(values)


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


@dataclass(frozen=True)
class Response:
    """One recorded frequency response of chapter 9: chart of the rig, inertia, range of the speed.

    The follower's inertia [lbf in s^2]; speeds [rpm] as written in the text or beside the trace,
    else chosen.
    """

    chart: str
    inertia: float
    low: float
    high: float

    @property
    def rig(self) -> Rig:
        """Linkage and coupler."""
        return RIG[self.chart]

    def envelope(self, decrement: float) -> Envelope:
        """Return the extreme deflections over the range, for a logarithmic decrement."""
        return _envelope(self, decrement)


@dataclass(frozen=True)
class Envelope:
    """Extreme deflections [mm] of the coupler's middle at crank speeds [rpm], and stability."""

    speed: Array
    least: Array
    greatest: Array
    stable: NDArray[np.bool_]

    @property
    def height(self) -> Array:
        """Greatest less least deflection [mm]."""
        return self.greatest - self.least

    @property
    def unstable(self) -> Array:
        """The unstable ones of the speeds [rpm]."""
        return self.speed[~self.stable]


@lru_cache(maxsize=64)
def _envelope(one: Response, decrement: float) -> Envelope:
    system = coupler(one.rig.scene, decrement, one.inertia)
    speed = np.linspace(one.low, one.high, 241)
    motion = quiet_state(system, speed * RPM)
    middle = 1e3 * system.reference_length * motion.q[..., 0]
    stable = np.ones(len(speed), bool) if motion.stable is None else np.asarray(motion.stable)
    return Envelope(speed, middle.min(axis=-1), middle.max(axis=-1), stable)


def decrements(rig: Rig) -> tuple[float, float, float]:
    """Return the least, the middle and the greatest logarithmic decrement measured at rest."""
    least, most = load_scene(rig.scene)["measured"]["log_decrement"]
    return float(least), 0.5 * float(least + most), float(most)


def response(
    axes: Sequence[Axes],
    chart: str,
    inertia: float,
    low: float,
    high: float,
    resonances: Sequence[float] = (),
    claim: str = "",
) -> Drawn:
    """Draw a frequency response; compute resonances near speeds [rpm] and what a claim needs."""
    one, ax = Response(chart, inertia, low, high), axes[0]
    least, middle, most = decrements(one.rig)
    for decrement, colour, width, front in (
        (least, COLOURS[1], 0.8, 2.0),
        (middle, COLOURS[0], 1.3, 3.0),
        (most, COLOURS[2], 0.8, 2.0),
    ):
        ends = one.envelope(decrement)
        label = f"decrement {decrement:.3g}"
        ax.plot(ends.speed, ends.greatest, color=colour, lw=width, label=label, zorder=front)
        ax.plot(ends.speed, ends.least, color=colour, lw=width, zorder=front)
    ends = one.envelope(middle)
    _shade(ax, ends)
    _limits(ax, ends, 1e3 * coupler(one.rig.scene, middle, inertia).reference_length)
    _fractions(ax, one)
    ax.set(xlim=(low, high), xlabel="crank speed [rpm]", ylabel="deflection of the middle [mm]")
    legend_below(axes)
    return Drawn([*(resonance(one, at) for at in resonances), *(_CLAIMS[claim](one))])


def _shade(ax: Axes, ends: Envelope) -> None:
    """Mark the speeds at which the periodic motion is unstable."""
    ax.fill_between(
        ends.speed,
        0.0,
        1.0,
        where=list(~ends.stable),
        color="#f7e3d3",
        lw=0,
        step="mid",
        transform=ax.get_xaxis_transform(),
        label="unstable" if not np.all(ends.stable) else None,
        zorder=0,
    )


def _limits(ax: Axes, ends: Envelope, length: float) -> None:
    """Keep the axis to what can be read; mark how far linear equations hold."""
    top = max(float(np.max(np.abs(values))) for values in (ends.least, ends.greatest))
    end = min(1.15 * top, _DRAWN * length)
    ax.set_ylim(-end, end)
    if _LINEAR * length < end:
        for level in (_LINEAR * length, -_LINEAR * length):
            ax.axhline(level, color="0.5", lw=0.7, ls="--", zorder=1)


def _fractions(ax: Axes, one: Response) -> None:
    """Mark the fractions of the natural frequency; those up to the eighth have room for a name."""
    place: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
    for order in range(1, 13):
        speed = one.rig.frequency / RPM / order
        if one.low < speed < one.high:
            ax.axvline(speed, color="0.6", lw=0.7, ls=(0, (1, 3)), zorder=1)
            if order <= 8:
                text = f"Ω/{order}"
                ax.annotate(text, (speed, 1.0), xytext=(2, -8), fontsize=7, color="0.4", **place)


def resonance(one: Response, speed: float) -> float:
    """Return the crank speed [rpm] of the greatest deflection's maximum nearest to a speed."""
    ends = one.envelope(decrements(one.rig)[0])
    height = ends.height
    inner = (height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:])
    places = ends.speed[1:-1][inner]
    return float(places[np.argmin(np.abs(places - speed))]) if len(places) else float("nan")


def _harmonics(one: Response, orders: range) -> list[float]:
    """Return how far from Omega/n [%] each harmonic is greatest, at most."""
    system = coupler(one.rig.scene, decrements(one.rig)[0], one.inertia)
    factor, apart = np.linspace(0.94, 1.06, 61), []
    for order in orders:
        motion = quiet_state(system, factor * one.rig.frequency / order)
        size = np.abs(np.fft.rfft(motion.q[..., 0], axis=-1)[:, order])
        apart.append(abs(float(factor[np.argmax(size)]) - 1.0))
    return [100.0 * max(apart)]


def _increment(one: Response) -> list[float]:
    """Return how the second increment of the inertia raises the amplitude near 300 rpm."""
    sizes = []
    for inertia in (one.inertia, 0.0069):
        other = Response(one.chart, inertia, one.low, one.high)
        ends = other.envelope(decrements(one.rig)[0])
        sizes.append(float(np.interp(300.0, ends.speed, ends.height)))
    return [sizes[0] / sizes[1]]


def _middle(speeds: Array) -> float:
    return 0.5 * float(speeds[0] + speeds[-1])


def _region(one: Response) -> list[float]:
    """Return the middle of the unstable region 2 Omega/5 below 300 rpm."""
    unstable = one.envelope(decrements(one.rig)[0]).unstable
    return [_middle(unstable[(unstable > 245.0) & (unstable < 291.0)])]


def _passed(one: Response) -> list[float]:
    """Return place and end of the unstable region 2 Omega/3 at the least inertia."""
    unstable = one.envelope(decrements(one.rig)[1]).unstable
    return [_middle(unstable), float(unstable[-1])]


def _onset(one: Response) -> list[float]:
    return [float(one.envelope(decrements(one.rig)[1]).unstable[0])]


def _above(one: Response) -> list[float]:
    unstable = one.envelope(decrements(one.rig)[1]).unstable
    return [float(unstable[unstable > 1.2 * one.rig.frequency / RPM / 2][0])]


def _between(one: Response) -> list[float]:
    """Return at how many speeds about 500 rpm the periodic motion is largest."""
    ends = one.envelope(decrements(one.rig)[0])
    inside = np.flatnonzero(np.abs(ends.speed - 500.0) < 15.0)
    beside = np.maximum(ends.height[inside - 1], ends.height[inside + 1])
    return [int(np.count_nonzero(ends.height[inside] > beside))]


# What section 9.5.3 says of single figures, by the names in their records.
_CLAIMS: dict[str, Callable[[Response], list[float]]] = {
    "": lambda one: [],
    "harmonics 3 to 10": lambda one: _harmonics(one, range(3, 11)),
    "harmonics 4 to 7": lambda one: _harmonics(one, range(4, 8)),
    "increment": _increment,
    "region 5": _region,
    "region 3 passed": _passed,
    "region 3 onset": _onset,
    "region 3 onset, second": _above,
    "largest about 500 rpm": _between,
}


def wave(chart: str, inertia: float, speed: float) -> tuple[Array, Array]:
    """Return crank angles [rad] and the deflection of the coupler's middle [mm] at them.

    Rig by the number of its chart, follower inertia [lbf in s^2], crank speed [rad/s].
    """
    rig = RIG[chart]
    system = coupler(rig.scene, decrements(rig)[1], inertia)
    motion = quiet_state(system, speed)
    return motion.theta, 1e3 * system.reference_length * motion.q[:, 0]


def figure_54(axes: Sequence[Axes]) -> Drawn:
    """Draw the wave-form below, at and above the resonance Omega/4."""
    order, first = 4, []
    for ax, factor, name in zip(axes, (0.96, 1.0, 1.04), ("below", "at", "above"), strict=True):
        speed = factor * RIG["84"].frequency / order
        theta, bent = wave("84", _LEAST, speed)
        ax.plot(np.degrees(theta), bent, color=COLOURS[0])
        crank_axis(ax)
        panel_title(ax, f"{name} resonance: {speed / RPM:.0f} rpm")
        first.append(np.fft.rfft(bent)[order] / len(bent))
    axes[0].set_ylabel("deflection of the middle [mm]")
    turned = abs(float(np.degrees(np.angle(first[2] / first[0]))))
    return Drawn([abs(first[1]) / max(abs(first[0]), abs(first[2])), turned])


def figure_55(axes: Sequence[Axes]) -> Drawn:
    """Draw the wave-form at one speed for several follower inertias."""
    ax, sizes = axes[0], []
    for inertia in (_LEAST, 0.0079, 0.0109):
        theta, bent = wave("82", inertia, 230.0 * RPM)
        ax.plot(np.degrees(theta), bent, label=f"I4 = {inertia:g} lbf in s2")
        sizes.append(float(np.ptp(bent)))
    crank_axis(ax)
    ax.set_ylabel("deflection of the middle [mm]")
    legend_below(axes)
    return Drawn([np.min(np.array(sizes[1:]) / np.array(sizes[:-1]))])
