"""Smith's Figs. 45 to 80: wave-forms of the coupler and its steady motion against the speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from ..hill import characteristic_exponents
from ..periodic import simulate, steady_state
from .drawing import COLOURS, Array, Looks, Panels, mark_fractions, panel_title, peak, turn
from .records import Drawn
from .smith_linkages import RIG, RPM, OfRig

_RIG = RIG["84"]
_LEAST = 0.0058


def figure_45(axes: Panels) -> Drawn:
    """Draw the sine and the shape under a central load over half the coupler."""
    ax, x = axes[0], np.linspace(0.0, 0.5, 251)
    sine, loaded = np.sin(pi * x), 3 * x - 4 * x**3
    ax.plot(x, sine, color=COLOURS[0], label=r"$\sin(\pi x/l)$")
    ax.plot(x, loaded, "--", color=COLOURS[1], label=r"$3(x/l) - 4(x/l)^3$")
    # At the gauges, a tenth of the length from the end.
    return Drawn([100.0 * (1.0 - loaded[50] / sine[50])])


def wave_form(axes: Panels, divisor: float, looks: Looks) -> Drawn:
    """Draw the wave-form at the speed Omega/divisor (Figs. 47 to 51)."""
    ax, speed = axes[0], _RIG.frequency / divisor
    # Between the least and the greatest logarithmic decrement measured at 1/16 in (9.5.5).
    damped = {name: _RIG.system(name, decrement=0.075) for name in ("reduced", "complete")}
    length = 1e3 * damped["complete"].reference_length
    for system, look in zip(damped.values(), looks, strict=False):
        state = steady_state(system, speed, samples=512)
        turn(ax, state.theta, length * state.q[:, 0], **look)
    run = simulate(_RIG.system("reduced"), speed, 1.0, initial=(0.0, 0.0), samples=512)
    ax.plot(np.degrees(run.theta), length * run.q[:, 0], **looks[-1])
    values = [_vibrations(name, speed) for name in damped]
    if divisor == round(divisor):
        both = steady_state(damped["reduced"], speed * np.array([1.0, 0.97]), samples=512)
        harmonic = np.abs(np.fft.rfft(both.q[..., 0]))[:, int(divisor)]
        values.append(float(harmonic[0] / harmonic[1]))
    return Drawn(values)


def _vibrations(equation: str, speed: float) -> float:
    """Return the undamped characteristic exponent: free vibrations in one crank cycle."""
    f = _RIG.function(equation)
    lam2 = (_RIG.frequency / speed) ** 2
    # Within a region its imaginary part is the region's own.
    part = float(characteristic_exponents(f, lam2, 1.0).nu)
    # Known up to sign and whole numbers; the mean stiffness says which.
    near = float(np.sqrt(lam2 + f.mean))
    candidates = [whole + sign * part for whole in range(int(near) + 3) for sign in (-1, 1)]
    return min(candidates, key=lambda value: abs(value - near))


@dataclass(frozen=True)
class Response(OfRig):
    """One recorded frequency response of chapter 9: chart of the rig, inertia, range of the speed.

    The follower's inertia [lbf in s^2]; speeds [rpm] as written in the text or beside the trace,
    else chosen.  Methods that records name say what section 9.5.3 does of single figures.
    """

    inertia: float
    low: float
    high: float

    def resonance(self, speed: float) -> float:
        """Return the crank speed [rpm] of the greatest deflection's maximum nearest to a speed."""
        ends = envelope(self, self.rig.decrements[0])
        places = ends.speed[find_peaks(ends.height)[0]]
        return float(places[np.argmin(np.abs(places - speed))]) if len(places) else float("nan")

    def harmonics(self, first: int, last: int) -> list[float]:
        """Return how far from Omega/n [%] each of some harmonics is greatest, at most."""
        system = self.rig.system(decrement=self.rig.decrements[0], inertia=self.inertia)
        factor, apart = np.linspace(0.94, 1.06, 61), []
        for order in range(first, last + 1):
            motion = steady_state(system, factor * self.rig.frequency / order)
            size = np.abs(np.fft.rfft(motion.q[..., 0], axis=-1)[:, order])
            apart.append(abs(float(factor[np.argmax(size)]) - 1.0))
        return [100.0 * max(apart)]

    def increment(self, before: float, at: float) -> list[float]:
        """Return how an increment of the inertia, from one before, raises the amplitude."""
        sizes = []
        for inertia in (self.inertia, before):
            ends = envelope(replace(self, inertia=inertia), self.rig.decrements[0])
            sizes.append(float(np.interp(at, ends.speed, ends.height)))
        return [sizes[0] / sizes[1]]

    def unstable(self, which: str, damping: int, low: float, high: float) -> list[float]:
        """Return ``first``, ``middle``, ``last`` unstable speed within a range, as many as named.

        With the least measured decrement, the middle or the greatest one (0, 1, 2).
        """
        ends = envelope(self, self.rig.decrements[damping])
        inside = ends.speed[~ends.stable & (ends.speed > low) & (ends.speed < high)]
        first, last = float(inside[0]), float(inside[-1])
        found = {"first": first, "middle": 0.5 * (first + last), "last": last}
        return [found[name] for name in which.split()]

    def largest(self, at: float, apart: float) -> list[float]:
        """Return at how many speeds about one the periodic motion is largest."""
        ends = envelope(self, self.rig.decrements[0])
        inside = np.flatnonzero(np.abs(ends.speed - at) < apart)
        beside = np.maximum(ends.height[inside - 1], ends.height[inside + 1])
        return [int(np.count_nonzero(ends.height[inside] > beside))]


class Envelope(NamedTuple):
    """Extreme deflections [mm] of the coupler's middle at crank speeds [rpm], and stability."""

    speed: Array
    least: Array
    greatest: Array
    stable: NDArray[np.bool_]

    @property
    def height(self) -> Array:
        """Greatest less least deflection [mm]."""
        return self.greatest - self.least


@lru_cache(maxsize=64)
def envelope(one: Response, decrement: float) -> Envelope:
    """Return the extreme deflections over the range, for a logarithmic decrement."""
    system = one.rig.system(decrement=decrement, inertia=one.inertia)
    speed = np.linspace(one.low, one.high, 241)
    motion = steady_state(system, speed * RPM)
    middle = 1e3 * system.reference_length * motion.q[..., 0]
    return Envelope(speed, middle.min(axis=-1), middle.max(axis=-1), np.asarray(motion.stable))


def response(
    axes: Panels,
    chart: str,
    inertia: float,
    low: float,
    high: float,
    resonances: Sequence[float] = (),
    claim: Sequence[Any] = (),
) -> Drawn:
    """Draw a frequency response; compute resonances near speeds [rpm], and what the text says.

    ``claim``: a method of :class:`Response` and what it takes.
    """
    one, ax = Response(chart, inertia, low, high), axes[0]
    for decrement, colour, width in zip(
        one.rig.decrements, (1, 0, 2), (0.8, 1.3, 0.8), strict=True
    ):
        ends = envelope(one, decrement)
        look: dict[str, Any] = {"color": COLOURS[colour], "lw": width, "zorder": 2.0 + width}
        ax.plot(ends.speed, ends.greatest, label=f"decrement {decrement:.3g}", **look)
        ax.plot(ends.speed, ends.least, **look)
    ends = envelope(one, one.rig.decrements[1])
    if not np.all(ends.stable):
        look = {"transform": ax.get_xaxis_transform(), "color": "#f7e3d3", "lw": 0, "zorder": 0}
        inside = ~ends.stable
        ax.fill_between(ends.speed, 0.0, 1.0, inside, step="mid", label="unstable", **look)
    # The axis is kept to what can be read, 15 % of the length; dashed lines say that up to 5 %
    # linear equations hold.
    length = 1e3 * one.rig.system(inertia=inertia).reference_length
    top = max(peak(values) for values in (ends.least, ends.greatest))
    end = min(1.15 * top, 0.15 * length)
    if 0.05 * length < end:
        for level in (0.05 * length, -0.05 * length):
            ax.axhline(level, color="0.5", lw=0.7, ls="--", zorder=1)
    mark_fractions(ax, one.rig.frequency / RPM, range(1, 13), "Ω/{}", (low, high), low=False)
    ax.set(xlim=(low, high), ylim=(-end, end))
    values = [one.resonance(at) for at in resonances]
    return Drawn([*values, *getattr(one, claim[0])(*claim[1:])] if claim else values)


def wave(chart: str, inertia: float, speed: float) -> tuple[Array, Array]:
    """Return crank angles [rad] and the deflection of the coupler's middle [mm] at them.

    Rig by the number of its chart, follower inertia [lbf in s^2], crank speed [rad/s].
    """
    rig = RIG[chart]
    system = rig.system(decrement=rig.decrements[1], inertia=inertia)
    motion = steady_state(system, speed)
    return motion.theta, 1e3 * system.reference_length * motion.q[:, 0]


def figure_54(axes: Panels) -> Drawn:
    """Draw the wave-form below, at and above the resonance Omega/4."""
    order, first = 4, []
    for ax, factor, name in zip(axes, (0.96, 1.0, 1.04), ("below", "at", "above"), strict=True):
        speed = factor * RIG["84"].frequency / order
        theta, bent = wave("84", _LEAST, speed)
        ax.plot(np.degrees(theta), bent, color=COLOURS[0])
        panel_title(ax, f"{name} resonance: {speed / RPM:.0f} rpm")
        first.append(np.fft.rfft(bent)[order] / len(bent))
    turned = abs(float(np.degrees(np.angle(first[2] / first[0]))))
    return Drawn([abs(first[1]) / max(abs(first[0]), abs(first[2])), turned])


def figure_55(axes: Panels) -> Drawn:
    """Draw the wave-form at one speed for several follower inertias."""
    ax, sizes = axes[0], []
    for inertia in (_LEAST, 0.0079, 0.0109):
        theta, bent = wave("82", inertia, 230.0 * RPM)
        ax.plot(np.degrees(theta), bent, label=f"I4 = {inertia:g} lbf in s2")
        sizes.append(float(np.ptp(bent)))
    return Drawn([np.min(np.array(sizes[1:]) / np.array(sizes[:-1]))])
