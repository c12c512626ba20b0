"""Aannaque's Figs. 8.19 to 8.26: the largest stresses over the speed, for other L4 and L2."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from .aannaque_kinematics import cycle
from .aannaque_rig import FRAME, LONG, SHORT, Array, curve, cycles, rig, tops
from .records import Drawn, Quoted
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..frequencies import LinkFrequencies
    from ..recovery.stress_over_speed import StressCurve

FRAMES = (0.547, 0.632, 0.642, 0.652, 0.662)
_LOW, _HIGH, _COUNT = 5.0, 40.0, 211
# Speeds at which the stresses of several L4 are compared: one far below the critical speeds, and
# that of Fig. 8.24 [rad/s].
_QUIET, _SHOWN = 6.0, 17.0
_LIMIT = 0.66
# The least fall beside a maximum that counts as a critical speed.
_STANDS_OUT = 0.05
# Orders that have room for a label.
_LABELLED = 8
# What is near, of a critical speed.
_NEAR = 0.03
_FLYWHEEL, _COMPUTED_FLYWHEEL = 13.67, 11.31
_NOTE = (
    "Computed; the measured points are lost in the scan. Three cubic elements per link, full "
    "equations with stiffening, 2 % modal damping; the range of the speeds is that of Appendix C. "
    "Dotted: the mean first natural frequency over n."
)
_BEYOND = (
    "The linear equations are left where the stress passes some hundred MPa: with a long ground "
    "link the follower's pulse at 180 deg holds high harmonics, and what is drawn beyond is the "
    "linear equations' answer, not the rig's."
)


def _curve(frame: float) -> StressCurve:
    return curve(SHORT, frame, _LOW, _HIGH, _COUNT)


@lru_cache(maxsize=2)
def _held(scene: str) -> LinkFrequencies:
    """Return the first two frequencies of a held linkage for all L4."""
    from ..frequencies import link_frequencies

    return link_frequencies(rig(scene), "frame", "length", FRAMES, count=2)


def mean_frequency(scene: str, frame: float, mode: int = 1) -> float:
    """Return a mean natural frequency over the cycle [rad/s], crank held."""
    return float(_held(scene).mean[FRAMES.index(frame), mode - 1])


def frame_figure(frame: float) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws the follower's largest stress over the speed for one L4."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        for value, style, colour in ((FRAME, "--", COLOURS[4]), (frame, "-", COLOURS[0])):
            if value != frame or style == "-":
                found = _curve(value)
                label = f"$L_4$ = {value:.3f} m"
                ax.semilogy(
                    found.speed, found.of("follower") / 1e6, style, color=colour, label=label
                )
        _fractions(ax, mean_frequency(SHORT, frame), _LOW, _HIGH)
        _speed_axis(ax, "largest stress at the follower's midpoint [MPa]")
        legend_below(axes)
        rows = _critical_rows(SHORT, frame, _curve(frame), "follower")
        notes = (_NOTE,) if frame < 0.65 else (_NOTE, _BEYOND)
        return Drawn((*rows, *_frame_rows(frame)), notes)

    return draw


def _speed_axis(ax: Axes, label: str) -> None:
    ax.set_xlabel("crank speed [rad/s]")
    ax.set_ylabel(label)


def _fractions(ax: Axes, mean: float, low: float, high: float, mode: int = 1) -> None:
    """Mark a mode's mean frequency over whole numbers: of the second mode the lowest alone."""
    last = 10 if mode == 1 else int(mean / high) + 1
    for order in range(int(mean / high) + 1, last + 1):
        speed = mean / order
        if low < speed < high:
            ax.axvline(speed, color="0.6", lw=0.7, ls=(0, (1, 3)), zorder=1)
        if low < speed < high and order <= _LABELLED:
            ax.annotate(
                rf"$\bar\omega_{mode}/{order}$",
                (speed, 0.0),
                xycoords=("data", "axes fraction"),
                xytext=(2, 3),
                textcoords="offset points",
                fontsize=7,
                color="0.4",
            )


def _critical_rows(scene: str, frame: float, found: StressCurve, link: str) -> list[Quoted]:
    """Return the rows on critical speeds near fractions of the mean frequencies."""
    rows = []
    for speed in tops(found.speed, found.of(link), _STANDS_OUT):
        ratios = [mean_frequency(scene, frame, mode) / float(speed) for mode in (1, 2)]
        apart = [abs(ratio / round(ratio) - 1.0) for ratio in ratios]
        # The second mode only where the first does not explain it.
        mode = 0 if apart[0] <= _NEAR else int(np.argmin(apart))
        order = round(ratios[mode])
        name = ("first", "second")[mode]
        rows.append(
            Quoted(
                f"mean {name} frequency over the critical speed {speed:.1f} rad/s",
                float(order),
                ratios[mode],
                _NEAR * order,
                "'near integer divisions of the mean value' (9.1): within 3 %",
                "8.5.1",
            )
        )
    return rows


def _at(frame: float, speed: float) -> float:
    """Return the largest stress at the follower's midpoint [MPa]."""
    found = _curve(frame)
    return float(np.interp(speed, found.speed, found.of("follower"))) / 1e6


def _frame_rows(frame: float) -> list[Quoted]:
    """Return what the text says of the stress as L4 grows."""
    place = FRAMES.index(frame)
    rows = []
    if place:
        before = FRAMES[place - 1]
        falls = frame < _LIMIT
        for speed in (_QUIET, _SHOWN):
            ratio = _at(frame, speed) / _at(before, speed)
            early = falls and ratio > 1.0
            rows.append(
                Quoted(
                    f"stress with L4 = {frame:.3f} m over that with {before:.3f} m, "
                    f"at {speed:g} rad/s",
                    1.0,
                    ratio,
                    0.0,
                    "'when L4 increases, the maximum stresses decrease'"
                    if falls
                    else "'above L4 = 0.66 m the trend is reversed'",
                    "8.5.1",
                    relation="<" if falls else ">",
                    differs=_EARLY if early else "",
                )
            )
    if frame == FRAMES[-1]:
        rows += _reversal_rows()
    return rows


_EARLY = (
    "the pulse at 180 deg excites the first mode: the higher the speed, the sooner longer ground "
    "links raise the stress"
)


def least_frame(speed: float) -> float:
    """Return the L4 [m] of those tried with the least stress at the follower's midpoint."""
    return min(FRAMES, key=lambda frame: _at(frame, speed))


def _reversal_rows() -> list[Quoted]:
    shift = [
        abs(_nearest(frame, order) / _nearest(FRAME, order) - 1.0)
        for frame in FRAMES[1:]
        for order in (5, 6)
    ]
    return [
        *(
            Quoted(
                f"L4 of least stress among those tried, at {speed:g} rad/s",
                _LIMIT,
                least_frame(speed),
                0.01,
                "the step between the values tried",
                "8.5.1",
                unit="m",
                differs=_EARLY if speed == _SHOWN else "",
            )
            for speed in (_QUIET, _SHOWN)
        ),
        Quoted(
            "largest shift of the critical speeds of orders 5 and 6 over all L4",
            5.0,
            100.0 * max(shift),
            0.0,
            "'only very weakly dependent on L4' (7.3), 'not affected' (9.1); 8.5.1 has 'do vary': "
            "below 5 %",
            "7.3, 8.5.1, 9.1",
            relation="<",
            unit="%",
        ),
    ]


def _nearest(frame: float, order: int) -> float:
    """Return the critical speed nearest to the mean first frequency over a whole number."""
    found = _curve(frame)
    speeds = tops(found.speed, found.of("follower"), _STANDS_OUT)
    return float(speeds[np.argmin(np.abs(speeds - mean_frequency(SHORT, frame) / order))])


def figure_8_24(axes: Sequence[Axes]) -> Drawn:
    """Draw the follower's stress over the cycle with a long ground link."""
    ax = axes[0]
    for frame, style, colour in ((0.662, "-", COLOURS[0]), (FRAME, "--", COLOURS[4])):
        angle, values = _follower(frame)
        ax.plot(angle, values, style, color=colour, label=f"$L_4$ = {frame:.3f} m")
    ax.axvline(180.0, color="0.6", lw=0.7, ls=(0, (1, 3)))
    crank_axis(ax)
    ax.set_ylabel("stress at the follower's midpoint [MPa]")
    legend_below(axes)
    return Drawn(tuple(_cycle_rows()), (*_CYCLE_NOTES,))


_CYCLE_NOTES = (
    "Stress of one outer fibre, tension positive; which one the gauges count as positive is not "
    "stated.",
    "Of the vibration at 13.67 Hz of the input link with its flywheel the document gives neither "
    "inertia nor shaft: 11.31 Hz cannot be computed again. What can: that no natural frequency of "
    "the linkage on a clamped shaft is so low, for either coupler and any L4, so that it has to "
    "come from what the clamped shaft leaves out; and that the flywheel's calculated frequency is "
    "17 % below the measured one, a factor of 1.46 in stiffness over inertia.",
)


def _follower(frame: float) -> tuple[Array, Array]:
    """Return crank angles [deg] and the follower's stress at its midpoint [MPa]."""
    found = cycles(SHORT, frame, (_SHOWN,))
    angle = np.degrees(np.append(found.theta, 2 * np.pi))
    values = found.stress["follower", 0.5][0] / 1e6
    return angle, np.append(values, values[0])


def _cycle_rows() -> list[Quoted]:
    angle, values = _follower(0.662)
    motion = cycle(0.662)
    widest = degrees(float(motion.theta2[int(np.argmax(motion.transmission_angle))]))
    lowest = min(float(_held(scene).least[:, 0].min()) for scene in (SHORT, LONG)) / (2 * np.pi)
    return [
        Quoted(
            "crank angle of the largest stress",
            180.0,
            float(angle[int(np.argmax(np.abs(values)))]),
            10.0,
            "'for an input angle of 180 deg'; the follower's vibration lags: within 10 deg",
            "8.5.1",
            unit="deg",
        ),
        Quoted(
            "crank angle of the greatest transmission angle",
            180.0,
            widest,
            0.5,
            "the step of the angles",
            "8.5.1",
            unit="deg",
        ),
        Quoted(
            "lowest natural frequency of the held linkage, both couplers, L4 from 0.547 to 0.662 m",
            _FLYWHEEL,
            lowest,
            0.0,
            "the vibration at 13.67 Hz is none of the linkage: 'independent of L4 and L2'",
            "8.5.1",
            relation=">",
            unit="Hz",
        ),
        Quoted(
            "flywheel's calculated frequency over the measured one, less 1",
            -17.0,
            100.0 * (_COMPUTED_FLYWHEEL / _FLYWHEEL - 1.0),
            0.5,
            "arithmetic of the two quoted numbers; no data to compute either",
            "8.5.1",
            unit="%",
        ),
    ]


def long_figure(link: str) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws a link's largest stress over the speed, long coupler."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        ax = axes[0]
        short, found = _curve(FRAME), curve(LONG, FRAME, _LOW, _LONG_HIGH, _COUNT)
        ax.semilogy(found.speed, found.of(link) / 1e6, color=COLOURS[0], label="$L_2$ = 0.636 m")
        kept = short.speed <= _LONG_HIGH
        ax.semilogy(
            short.speed[kept],
            short.of(link)[kept] / 1e6,
            "--",
            color=COLOURS[4],
            label="$L_2$ = 0.328 m",
        )
        for mode in (1, 2):
            _fractions(ax, mean_frequency(LONG, FRAME, mode), _LOW, _LONG_HIGH, mode)
        _speed_axis(ax, f"largest stress at the {link}'s midpoint [MPa]")
        legend_below(axes)
        rows = _critical_rows(LONG, FRAME, found, link)
        ratio = found.of("coupler") / found.of("follower")
        before = short.of("coupler")[kept] / short.of("follower")[kept]
        rows.append(
            Quoted(
                "coupler's over follower's stress, geometric mean over the speeds, long over short",
                1.0,
                float(np.exp(np.mean(np.log(ratio)) - np.mean(np.log(before)))),
                0.0,
                "'both the coupler and the follower were flexible'; before, the follower most",
                "8.5.2",
                relation=">",
            )
        )
        return Drawn(tuple(rows), (_LONG_NOTE,))

    return draw


_LONG_HIGH = 30.0
_LONG_NOTE = (
    "Computed; the measured points are lost in the scan. Range of the speeds as in Appendix D, "
    "and a little beyond; 2 % modal damping. Dotted: the mean first natural frequency over n, and "
    "that of the second mode, the follower's, over 6."
)
