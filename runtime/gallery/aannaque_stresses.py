"""Aannaque's chapter 7: critical speeds, stresses over the speed, pivots' distance, elements."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..beams.element_forms import required_structure
from ..core.families import Array, LinearPeriodic
from ..core.trigonometric import resampled
from ..frequencies import NaturalFrequencies, natural_frequencies
from ..hill import Meissner, discriminant
from ..periodic import floquet_multipliers, steady_state
from ..periodic.reduced import reduced_system
from ..recovery import recover, stress_operator
from .aannaque_beams import (
    CRITICAL,
    FRAMES,
    FULL,
    LINKS,
    THESIS,
    beams,
    hybrid,
    hybrid_model,
    maxima,
    moved,
    nearest,
    rms,
    stresses,
    tops,
)
from .drawing import COLOURS, Looks, Panels, peak
from .records import Drawn

# Speeds [rad/s] of Figs. 7.1 and 7.3, of 7.4 and 7.6, of 7.7 to 7.11.
_SPEEDS, _COARSE = np.linspace(20.0, 75.0, 221), np.linspace(20.0, 70.0, 81)
_WIDE = np.linspace(5.0, 70.0, 326)
_MODES = 4


def _apart(places: Array, others: Array) -> float:
    """Return the largest distance of a place from the nearest of others, over the place."""
    return max(float(np.min(np.abs(others - place)) / place) for place in places)


@lru_cache(maxsize=2)
def _stress(drop: tuple[str, ...]) -> Array:
    """Return the largest stress of all links [Pa], one element for each."""
    return np.asarray(np.max(stresses(beams(1, drop), _SPEEDS).maximum, axis=1))


@lru_cache(maxsize=1)
def real_parts() -> Array:
    """Return the larger real part of each pair of multipliers, by falling modulus, (ns, 4).

    With one damping ratio they follow one another as the modes do, but where two pairs meet.
    """
    system = reduced_system(beams(1), _MODES)
    real = floquet_multipliers(system, _SPEEDS, rtol=1e-6).multipliers.real
    return np.asarray(np.max(real.reshape(len(_SPEEDS), _MODES, 2), axis=-1))


def figure_7_1(axes: Panels, looks: Looks) -> Drawn:
    """Draw the largest stress and the real parts of the multipliers over the speed."""
    # The two modes whose multipliers tell the critical speeds of this range.
    largest, second = real_parts().T[:2]
    for drop, look in zip((THESIS, FULL), looks, strict=False):
        axes[0].semilogy(_SPEEDS, 1e-6 * _stress(drop), **look)
    for real, look in zip((largest, second), looks[2:], strict=True):
        axes[1].plot(_SPEEDS, real, **look)
    places = maxima(_SPEEDS, _stress(THESIS))
    for ax in axes:
        for place in places:
            ax.axvline(place, color="0.6", lw=0.6, ls=(0, (1, 3)))
    both = [tops(_SPEEDS, largest), tops(_SPEEDS, second)]
    values = [_apart(places, np.concatenate(both)), nearest(places, CRITICAL)]
    values += [nearest(both[0], CRITICAL), peak(real_parts())]
    rows, mean = [], float(_held().mean[0])
    for place in places:
        rank = int(np.argmin([np.min(np.abs(one - place), initial=np.inf) for one in both]))
        order = max(round(mean / float(place)), 1)
        name, divided = ("largest", "second")[rank], f"{mean / order:.2f} (n = {order})"
        rows.append((place, nearest(both[rank], place), name, "" if rank else divided))
    return Drawn(values, tables=[rows])


@lru_cache(maxsize=1)
def _held() -> NaturalFrequencies:
    """Return the frequencies of the one-element model, 720 to a cycle."""
    return natural_frequencies(beams(1, FULL), 2.0 * np.pi * np.arange(720) / 720, _MODES)


def _meissner(speed: Array, intervals: int) -> Array:
    """Return J of so many intervals of the first mode; exact means of each."""
    levels = _held().frequency[:, 0].reshape(intervals, -1).mean(axis=1)
    return discriminant(Meissner.of(levels**2), 0.0, 1.0 / speed**2).value


def figure_7_3(axes: Panels) -> Drawn:
    """Draw J_2, J_3, J_4 and the real part of a multiplier over the speed, first mode."""
    ax, fine = axes[0], _meissner(_SPEEDS, 180)
    ax.plot(_SPEEDS, fine, color="0.15", lw=1.2, label="180 intervals")
    counts = {count: _meissner(_SPEEDS, count) for count in (2, 3, 4)}
    for (count, values), mark, colour in zip(counts.items(), "os^", COLOURS, strict=False):
        some = slice(2 * count - 4, None, 6)
        ax.plot(_SPEEDS[some], values[some], mark, color=colour, ms=4, label=f"$J_{count}$")
    damped = real_parts()[:, 0]
    ax.plot(_SPEEDS, damped, "--", color=COLOURS[3], label="all modes, damping 2 %")
    for level in (-1.0, 1.0):
        ax.axhline(level, color="0.6", lw=0.6)
    reference, whole = tops(_SPEEDS, fine), _meissner(_SPEEDS, 720)
    places = [tops(_SPEEDS, values) for values in counts.values()]
    places += [_held().mean[0] / np.arange(1, 12), tops(_SPEEDS, damped)]
    gaps = [peak(_meissner(_SPEEDS, count) - whole) for count in (90, 180)]
    return Drawn([*(_apart(reference, some) for some in places), np.log2(gaps[0] / gaps[1])])


@lru_cache(maxsize=8)
def _response(frame: float) -> tuple[Array, Array]:
    """Return rms displacement of the follower's midpoint [mm] and peak strain energy [J]."""
    system = beams(1, frame=frame)
    motion = steady_state(system, _COARSE, rtol=1e-3)
    stiffness = system.array("K", motion.theta)
    energy = 0.5 * np.einsum("stn,tnm,stm->st", motion.q, stiffness, motion.q)
    return 1e3 * rms(moved(system, "follower", motion.theta, motion.q)), np.max(energy, axis=1)


def six_frames(axes: Panels, quantity: str) -> Drawn:
    """Draw ``displacement``, ``stress`` or ``energy`` over the speed, six frames (7.4 to 7.6)."""
    ax, speed = axes[0], _COARSE
    if quantity == "stress":
        speed = np.linspace(20.0, 70.0, 251)
        curves = [1e-6 * stresses(beams(1, frame=frame), speed).of("crank") for frame in FRAMES]
    else:
        curves = [_response(frame)[quantity == "energy"] for frame in FRAMES]
    for frame, values in zip(FRAMES, curves, strict=True):
        ax.semilogy(speed, values, label=f"$L_4$ = {frame:.3f} m")
    falls = _falls(speed, curves)
    if quantity != "displacement":
        return Drawn(falls)
    ax.axhline(50.0 * 0.525, color="0.5", lw=0.8, ls="--")
    ax.text(20.5, 50.0 * 0.525 * 1.1, "5 % of the follower", fontsize=8, color="0.4")
    places = [nearest(maxima(speed, values), CRITICAL) for values in curves[:3]]
    systems = (beams(1, FULL, frame=frame) for frame in FRAMES)
    means = [natural_frequencies(system, 0.0, 1).mean[0] for system in systems]
    return Drawn([*falls, places[0], np.ptp(places) / places[0], np.ptp(means) / means[0]])


def _falls(speed: Array, curves: Sequence[Array]) -> list[float]:
    """Return how curves change with L4: in the mean, and at their peaks up to 65 rad/s."""
    # Up to this L4 the stresses fall.
    chosen = [values for frame, values in zip(FRAMES, curves, strict=True) if frame <= 0.632]
    ratios = [float(np.exp(np.mean(np.log(later / one)))) for one, later in pairwise(chosen)]
    slow = [values[speed < 65.0] for values in chosen]
    peaks = [float(np.max(values)) for values in slow]
    heights = [peak / float(np.median(values)) for peak, values in zip(peaks, slow, strict=True)]
    return [max(ratios), heights[0] / heights[-1], peaks[0] / peaks[-1]]


@lru_cache(maxsize=8)
def _curve(elements: int, ratio: float = 0.02, drop: tuple[str, ...] = THESIS) -> Array:
    """Return the largest stress of crank, coupler and follower [Pa], (ns, 3)."""
    curve = stresses(beams(elements, drop, ratio=ratio), _WIDE)
    return np.stack([curve.of(link) for link in LINKS], axis=1)


def damping(axes: Panels, ratio: float) -> Drawn:
    """Draw the largest stress of each link over the speed (Figs. 7.7, 7.10, 7.11)."""
    ax = axes[0]
    for drop, style, lead in ((THESIS, "-", ""), (FULL, ":", "full form, ")):
        for link, colour, values in zip(LINKS, COLOURS, _curve(3, ratio, drop).T, strict=False):
            ax.semilogy(_WIDE, 1e-6 * values, style, color=colour, label=f"{lead}{link}")
    base, damped = _curve(3), _curve(3, ratio)
    if ratio == 0.02:
        slow = (_WIDE > 20.0) & (_WIDE < 30.0)
        return Drawn([np.max(np.abs(_curve(3, ratio, FULL) / base - 1.0)[slow])])
    values = []
    for k in range(len(LINKS)):
        peaks = [top for top in maxima(_WIDE, base[:, k], 0.1) if top > 20.0]
        at = [int(np.argmin(np.abs(_WIDE - top))) for top in peaks]
        values.append(np.max(damped[at, k] / base[at, k]))
    return Drawn([*values, np.max((damped / base)[_WIDE > 20.0])])


def figure_7_8(axes: Panels) -> Drawn:
    """Draw the largest stress over the speed for one, two and three elements, and "exact"."""
    ax, counts = axes[0], (1, 2, 3)
    largest = [np.max(_curve(count), axis=1) for count in counts]
    for count, values in zip(counts, largest, strict=True):
        label = f"{count} element{'s' if count > 1 else ''}"
        ax.semilogy(_WIDE, 1e-6 * values, label=label)
    speeds = np.linspace(10.0, 70.0, 121)
    motion = steady_state(hybrid_model(), speeds, rtol=1e-3)
    form = stress_operator(beams(1), motion.theta, 7, method="shape")[0]
    each = zip(speeds.tolist(), motion.q, motion.qd, strict=True)
    exact = [1e-6 * np.max(np.abs(form.values(speed, q, qd / speed))) for speed, q, qd in each]
    ax.semilogy(speeds, exact, "--", color="0.2", label='"exact"')
    second, third = (nearest(maxima(_WIDE, values), 23.5) for values in largest[1:])
    means = [float(natural_frequencies(beams(count), 0.0, 1).mean[0]) for count in counts]
    means.append(float(np.mean(hybrid(1e-10).first)))
    ratios = [means[0] / means[2], means[1] / means[2], means[2] / means[3]]
    return Drawn([*ratios, second / third, np.max(hybrid(1e-3).iterations)])


def bending_at_midpoint(
    system: LinearPeriodic, moving: LinearPeriodic | None = None
) -> tuple[Array, Array]:
    """Return crank angles [rad] and the bending stress at the follower's midpoint [Pa], 30 rad/s.

    The motion is that of another system where one is given, the stress by the first one's shapes.
    """
    motion = steady_state(moving or system, 30.0, rtol=1e-5)
    forces = recover(system, motion, stations={"follower": [0.5]}, method="shape")
    bars = required_structure(system).beams
    (section,) = (bar.section for bar in bars if bar.name == "follower")
    factor = 0.5 * (section.thickness or np.nan) / section.second_moment
    return forces.theta, np.asarray(factor * forces.of("follower", "moment")[:, 0])


def figure_7_9(axes: Panels, looks: Looks) -> Drawn:
    """Draw the stress at the follower's midpoint over the cycle at 30 rad/s, four models."""
    models = [bending_at_midpoint(beams(count)) for count in (1, 2, 3)]
    models.append(bending_at_midpoint(beams(1), hybrid_model()))
    even = []
    for (theta, values), look in zip(models, looks, strict=True):
        axes[0].plot(np.degrees(theta), 1e-6 * values, **look)
        even.append(resampled(values, 512))
    one, two = (float(np.corrcoef(values, even[2])[0, 1]) for values in even[:2])
    peaks = [peak(values) for values in even]
    return Drawn([two, one / two, peaks[1] / peaks[0], peaks[2] / peaks[1]])


def figure_7_13(axes: Panels) -> Drawn:
    """Draw the stress at the follower's midpoint over the cycle, six frames."""
    ax, pulses = axes[0], []
    for frame in FRAMES:
        theta, values = bending_at_midpoint(beams(3, frame=frame))
        turned, size = np.degrees(theta), np.abs(values)
        ax.plot(turned, 1e-6 * values, label=f"$L_4$ = {frame:.3f} m")
        # Before a quarter turn with the response after it, and about half a turn.
        later = (turned > 150.0) & (turned < 300.0)
        pulses.append((float(np.max(size[~later])), float(np.max(size[later]))))
    least = FRAMES[int(np.argmin(np.max(pulses, axis=1)))]
    return Drawn([pulses[0][1] / pulses[0][0], pulses[-1][1] / pulses[-1][0], least])
