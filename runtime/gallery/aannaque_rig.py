"""Aannaque's rig: paths, modes and largest stresses of chapters 8 and 9, appendices C and D."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import degrees, radians

import numpy as np

from .. import frequencies
from ..beams.element_forms import required_structure
from ..core.families import Array, LinearPeriodic
from ..periodic import steady_state
from ..recovery import ElasticCurve, elastic_coupler_curve, stress_operator
from ..recovery.stress_over_speed import StressCurve, stress_curve
from ..scenes import load_scene
from .aannaque_beams import FRAME, exact_frequencies, maxima, nearest
from .aannaque_kinematics import cycle
from .drawing import COLOURS, Axes, Looks, Panels, mark_fractions, panel_title, turn
from .records import Drawn, contents

SHORT, LONG = "aannaque_1996_table_4_1", "aannaque_1996_long_coupler"
# Speeds in the captions of appendices C and D [rad/s].
SPEEDS: Mapping[str, Sequence[float]] = contents("aannaque")["speeds"]
# Where the gauges sat.
STATIONS: Mapping[str, Sequence[float]] = contents("aannaque")["gauges"]
# By section 8.4 the cycle is divided into ten equal angles.
ANGLES = tuple(range(0, 360, 36))
_LENGTHS = np.concatenate([np.linspace(0.30, 0.52, 8), np.linspace(0.535, 0.80, 16)])
FRAMES = (0.547, 0.632, 0.642, 0.652, 0.662)
_LOW, _HIGH, _LONG_HIGH = 5.0, 40.0, 30.0
# Speeds at which the stresses of several L4 are compared: one far below the critical speeds, and
# that of Fig. 8.24 [rad/s].
_QUIET, _SHOWN = 6.0, 17.0


@lru_cache(maxsize=12)
def rig(scene: str = SHORT, frame: float = FRAME) -> LinearPeriodic:
    """Return the linkage of a built-in scene with another distance of the pivots [m]."""
    return load_scene(scene, overrides={"links.frame": frame}).linear_system()


@lru_cache(maxsize=4)
def midpoint(speed: float) -> ElasticCurve:
    """Return the path of the coupler's midpoint at a crank speed [rad/s]."""
    return elastic_coupler_curve(rig(), steady_state(rig(), speed, rtol=1e-5))


def paths(
    axes: Panels,
    shown: Sequence[tuple[int, float, float]],
    distances: Sequence[tuple[float, str]],
    looks: Looks,
) -> Drawn:
    """Draw paths of the midpoint, and how far they lie from the rigid linkage's (8.2 to 8.4).

    ``shown``: panel, speed, how many times as large the displacement is, 0 of the rigid linkage.
    """
    for (panel, speed, larger), look in zip(shown, looks, strict=True):
        path = midpoint(speed)
        places = 1e3 * (path.rigid + larger * path.displacement)
        axes[panel].plot(*np.vstack([places, places[:1]]).T, **look)
    for speed, colour in distances:
        path = midpoint(speed)
        turn(axes[1], path.theta, 1e3 * np.hypot(*path.displacement.T), color=colour)
    speeds = list(dict.fromkeys(speed for _, speed, _ in shown))
    largest = [1e3 * midpoint(speed).largest for speed in speeds]
    if len(distances) < 2:
        return Drawn(largest)
    (slow, fast), (before, after) = speeds, largest
    return Drawn([after / before / (fast / slow) ** 2])


@lru_cache(maxsize=1)
def held_modes() -> frequencies.NaturalFrequencies:
    """Return the first three modes at the ten crank angles of section 8.4."""
    return frequencies.natural_frequencies(rig(), np.radians(ANGLES), 3)


def modes(axes: Panels, place: int) -> Drawn:
    """Draw the modes at one of the ten crank angles (Figs. 8.9 to 8.18)."""
    angle, tracked = ANGLES[place], held_modes().tracked[place]
    computed, order = np.sort(tracked), np.argsort(tracked)
    for rank, ax in enumerate(axes):
        frequencies.draw_mode(rig(), radians(angle), int(order[rank]) + 1, ax, found=held_modes())
        hertz = computed[rank] / (2 * np.pi)
        ax.set_title(f"mode {rank + 1}: {hertz:.1f} Hz, {computed[rank]:.1f} rad/s", fontsize=9)
    exact = exact_frequencies(required_structure(rig()), np.array([radians(angle)]), 3)[0]
    rows = zip((1, 2, 3), computed / (2 * np.pi), exact / (2 * np.pi), strict=True)
    gap = 100.0 * np.max(np.abs(computed / exact - 1.0))
    return Drawn([angle, gap], {"angle": angle}, [rows])


@lru_cache(maxsize=1)
def over_coupler() -> frequencies.LinkFrequencies:
    """Return the mean first natural frequency against the coupler's length."""
    return frequencies.link_frequencies(rig(), "coupler", "length", _LENGTHS)


def crossing() -> float:
    """Return the coupler length [m] at which coupler and follower, pinned, vibrate alike."""
    pinned = dict(zip(over_coupler().links, over_coupler().pinned.T, strict=True))
    # A pinned beam's frequency goes with the inverse square of its length.
    return float(_LENGTHS[0] * np.sqrt(pinned["coupler"][0] / pinned["follower"][0]))


def figure_9_1(axes: Panels) -> Drawn:
    """Draw the mean first frequency over the coupler's length, and those of the pinned links."""
    over = over_coupler()
    ax = over.plot(axes[0])
    ax.axvline(FRAME, color="0.6", lw=0.8, ls=(0, (1, 3)))
    # The document shows it up to 60 Hz.
    ax.set_ylim(0.0, 120.0 * np.pi)
    pinned = dict(zip(over.links, over.pinned.T, strict=True))
    lowest = np.minimum(pinned["coupler"], pinned["follower"])
    apart, short = 100.0 * np.abs(over.mean[:, 0] / lowest - 1.0), over.value < FRAME
    words = {"most": np.max(apart), "crank": pinned["crank"][0] / (2 * np.pi)}
    return Drawn([crossing(), np.max(apart[short]), np.max(apart[~short])], words)


@lru_cache(maxsize=16)
def curve(scene: str, frame: float, high: float = _HIGH) -> StressCurve:
    """Return the largest stresses at the gauges over speeds from 5 rad/s up to a highest one."""
    speeds = np.linspace(_LOW, high, 211)
    return stress_curve(
        rig(scene, frame), speeds, stations=STATIONS, rtol=1e-3, stability=False, whole=False
    )


@lru_cache(maxsize=2)
def _held(scene: str) -> frequencies.LinkFrequencies:
    """Return the first two frequencies of a held linkage for all L4."""
    return frequencies.link_frequencies(rig(scene), "frame", "length", FRAMES, count=2)


def mean_frequency(scene: str, frame: float, mode: int = 1) -> float:
    """Return a mean natural frequency over the cycle [rad/s], crank held."""
    return float(_held(scene).mean[FRAMES.index(frame), mode - 1])


def _critical(over: StressCurve, link: str) -> Array:
    """Return the speeds of maxima beside which the stress falls by 5 % at least."""
    return maxima(over.speed, over.of(link), -np.log1p(-0.05))


def long_frame(axes: Panels, frame: float) -> Drawn:
    """Draw the follower's largest stress over the speed for one L4 (Figs. 8.19 to 8.23)."""
    ax, looks = axes[0], {FRAME: ("--", COLOURS[4]), frame: ("-", COLOURS[0])}
    for value, (style, colour) in looks.items():
        over = curve(SHORT, value)
        label = f"$L_4$ = {value:.3f} m"
        ax.semilogy(over.speed, over.of("follower") / 1e6, style, color=colour, label=label)
    _mark_fractions(ax, mean_frequency(SHORT, frame), _HIGH)
    values = _orders(SHORT, frame, curve(SHORT, frame), "follower")
    place = FRAMES.index(frame)
    if place:
        values += [_at(frame, w) / _at(FRAMES[place - 1], w) for w in (_QUIET, _SHOWN)]
    if frame == FRAMES[-1]:
        shift = [
            abs(_nearest(other, order) / _nearest(FRAME, order) - 1.0)
            for other in FRAMES[1:]
            for order in (5, 6)
        ]
        values += [least_frame(_QUIET), least_frame(_SHOWN), 100.0 * max(shift)]
    return Drawn(values)


def _mark_fractions(ax: Axes, mean: float, high: float, mode: int = 1) -> None:
    """Mark a mode's mean frequency over whole numbers: of the second mode the lowest alone."""
    first = int(mean / high) + 1
    orders = range(first, (10 if mode == 1 else first) + 1)
    name = rf"$\bar\omega_{mode}/{{}}$"
    mark_fractions(ax, mean, orders, name, (_LOW, high), low=True)


def _orders(scene: str, frame: float, over: StressCurve, link: str) -> list[float]:
    """Return the mean frequency over each critical speed."""
    values = []
    for speed in _critical(over, link):
        ratios = [mean_frequency(scene, frame, mode) / float(speed) for mode in (1, 2)]
        apart = [abs(ratio / round(ratio) - 1.0) for ratio in ratios]
        # The second mode only where the first does not explain it to 3 %.
        values.append(ratios[0 if apart[0] <= 0.03 else int(np.argmin(apart))])
    return values


def _at(frame: float, speed: float) -> float:
    """Return the largest stress at the follower's midpoint [MPa]."""
    over = curve(SHORT, frame)
    return float(np.interp(speed, over.speed, over.of("follower"))) / 1e6


def least_frame(speed: float) -> float:
    """Return the L4 [m] of those tried with the least stress at the follower's midpoint."""
    return min(FRAMES, key=lambda frame: _at(frame, speed))


def _nearest(frame: float, order: int) -> float:
    """Return the critical speed nearest to the mean first frequency over a whole number."""
    speeds = _critical(curve(SHORT, frame), "follower")
    return nearest(speeds, mean_frequency(SHORT, frame) / order)


def figure_8_24(axes: Panels) -> Drawn:
    """Draw the follower's stress over the cycle with a long ground link."""
    ax, motion = axes[0], cycle(0.662)
    values = []
    for frame, style, colour in ((0.662, "-", COLOURS[0]), (FRAME, "--", COLOURS[4])):
        theta, by_station = cycles(SHORT, frame, (_SHOWN,))
        stress = by_station["follower", 0.5][0] / 1e6
        turn(ax, theta, stress, style, color=colour, label=f"$L_4$ = {frame:.3f} m")
        if frame != FRAME:
            values.append(np.degrees(theta[int(np.argmax(np.abs(stress)))]))
    ax.axvline(180.0, color="0.6", lw=0.7, ls=(0, (1, 3)))
    widest = degrees(float(motion.theta2[int(np.argmax(motion.transmission_angle))]))
    lowest = min(float(_held(scene).least[:, 0].min()) for scene in (SHORT, LONG)) / (2 * np.pi)
    # The input link with its flywheel: calculated and measured frequency [Hz].
    return Drawn([*values, widest, lowest, 100.0 * (11.31 / 13.67 - 1.0)])


def long_coupler(axes: Panels, link: str) -> Drawn:
    """Draw a link's largest stress over the speed, long coupler (Figs. 8.25 and 8.26)."""
    ax, short, long = axes[0], curve(SHORT, FRAME), curve(LONG, FRAME, _LONG_HIGH)
    ax.semilogy(long.speed, long.of(link) / 1e6, color=COLOURS[0], label="$L_2$ = 0.636 m")
    kept = short.speed <= _LONG_HIGH
    before = short.of(link)[kept] / 1e6
    ax.semilogy(short.speed[kept], before, "--", color=COLOURS[4], label="$L_2$ = 0.328 m")
    for mode in (1, 2):
        _mark_fractions(ax, mean_frequency(LONG, FRAME, mode), _LONG_HIGH, mode)
    ratios = [one.of("coupler") / one.of("follower") for one in (long, short)]
    growth = np.exp(np.mean(np.log(ratios[0])) - np.mean(np.log(ratios[1][kept])))
    return Drawn([*_orders(LONG, FRAME, long, link), growth])


@lru_cache(maxsize=16)
def cycles(
    scene: str, frame: float, speeds: tuple[float, ...]
) -> tuple[Array, Mapping[tuple[str, float], Array]]:
    """Return crank angles [rad] and stresses [Pa] at the gauges, ``(ns, nt)``, by link and place.

    Those of the outer fibre to the left of the link's direction, tension positive.
    """
    system = rig(scene, frame)
    motion = steady_state(system, np.array(speeds), rtol=1e-5)
    form, stations = stress_operator(system, motion.theta, STATIONS)
    each = zip(speeds, motion.q, motion.qd, strict=True)
    values = np.stack([form.values(speed, q, qd / speed) for speed, q, qd in each])
    # Of each station the fibre on the positive side comes first.
    by_station = {(one.beam, one.place): values[:, :, k] for k, one in enumerate(stations)}
    return motion.theta, by_station


def sheet(axes: Panels, letter: str, first: int, last: int, looks: Looks) -> Drawn:
    """Draw some figures of appendix C or D, a row of links for each."""
    numbers = range(first, last + 1)
    speeds = tuple(SPEEDS[letter][number - 1] for number in numbers)
    theta, stress = cycles({"C": SHORT, "D": LONG}[letter], FRAME, speeds)
    names = {"crank": "input link", "coupler": "coupler", "follower": "follower"}
    for row, number in enumerate(numbers):
        for ax, (link, name) in zip(axes[3 * row :], names.items(), strict=False):
            for place, look in zip((0.5, 0.0), looks, strict=True):
                if (link, place) in stress:
                    turn(ax, theta, stress[link, place][row] / 1e6, **look)
            ax.locator_params(axis="y", nbins=4)
            panel_title(ax, f"{letter}.{number}: {name}, {speeds[row]:g} rad/s")
            ax.tick_params(labelbottom=number == last)
    highest = 0.0
    for values in stress.values():
        waves = np.abs(np.fft.rfft(values))[:, 1:]
        kept = waves >= 0.01 * np.max(waves, axis=1, keepdims=True)
        last_kept = waves.shape[1] - np.argmax(kept[:, ::-1], axis=1)
        highest = max(highest, float(np.max(last_kept * speeds)) / (2 * np.pi))
    peaks = [np.max(np.abs(stress["crank", place]), axis=1) for place in (0.0, 0.5)]
    return Drawn([highest, float(np.min(peaks[0] / peaks[1]))])
