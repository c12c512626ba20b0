"""Aannaque's Figs. 7.4 to 7.6 and 7.13: what the distance of the ground pivots does."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import LinearRangeWarning
from ..core.families import Array, LinearPeriodic
from .aannaque_models import (
    CRITICAL,
    FORM_NOTE,
    FRAME,
    FULL,
    RANGE_NOTE,
    beams,
    maxima,
    moved,
    nearest,
    periodic,
    rms,
    stresses,
)
from .aannaque_pulses import FRAMES
from .records import Drawn, Quoted
from .style import COLOURS, crank_axis, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SPEEDS = np.linspace(20.0, 70.0, 81)
_FINE = np.linspace(20.0, 70.0, 251)
_SPEED = 30.0
_LATE = 0.632
_LENGTHS_NOTE = (
    "The six values of L4 are not legible: those of Figs. 8.19 to 8.23 and 0.600 m. One element "
    "for each link, damping 2 %."
)


@lru_cache(maxsize=8)
def _response(frame: float) -> tuple[Array, Array]:
    """Return rms displacement of the follower's midpoint [m] and peak strain energy [J]."""
    system = beams(1, frame=frame)
    found = periodic(system, _SPEEDS, rtol=1e-3)
    stiffness = system.array("K", found.theta)
    energy = 0.5 * np.einsum("stn,tnm,stm->st", found.q, stiffness, found.q)
    return rms(moved(system, "follower", found.theta, found.q)), np.max(energy, axis=1)


@lru_cache(maxsize=8)
def _crank_stress(frame: float) -> Array:
    curve = stresses(beams(1, frame=frame), _FINE)
    return curve.of("crank")


def _draw(ax: Axes, speed: Array, curves: Sequence[Array], unit: str) -> None:
    for frame, colour, values in zip(FRAMES, COLOURS, curves, strict=False):
        ax.semilogy(speed, values, color=colour, label=f"$L_4$ = {frame:.3f} m")
    ax.set_xlim(speed[0], speed[-1])
    ax.set_xlabel("crank speed [rad/s]")
    ax.set_ylabel(unit)
    legend_below([ax], columns=3)


def figure_7_4(axes: Sequence[Axes]) -> Drawn:
    """Draw the rms displacement of the follower's midpoint over the speed, six frames."""
    curves = [_response(frame)[0] for frame in FRAMES]
    _draw(axes[0], _SPEEDS, [1e3 * own for own in curves], "rms of the follower's midpoint [mm]")
    axes[0].axhline(50.0 * 0.525, color="0.5", lw=0.8, ls="--")
    axes[0].text(20.5, 50.0 * 0.525 * 1.1, "5 % of the follower", fontsize=8, color="0.4")
    rows = (*_length_rows(_SPEEDS, curves, "rms"), *_weak_rows(curves))
    return Drawn(rows, (f"{_LENGTHS_NOTE} {FORM_NOTE} {RANGE_NOTE}",))


def figure_7_5(axes: Sequence[Axes]) -> Drawn:
    """Draw the largest stress of the input link over the speed, six frames."""
    curves = [_crank_stress(frame) for frame in FRAMES]
    _draw(axes[0], _FINE, [1e-6 * own for own in curves], "largest stress of the crank [MPa]")
    rows = _length_rows(_FINE, curves, "stress")
    return Drawn(tuple(rows), (f"{_LENGTHS_NOTE} {FORM_NOTE} {RANGE_NOTE}",))


def figure_7_6(axes: Sequence[Axes]) -> Drawn:
    """Draw the peak strain energy over the speed, six frames."""
    curves = [_response(frame)[1] for frame in FRAMES]
    _draw(axes[0], _SPEEDS, curves, "peak strain energy [J]")
    rows = _length_rows(_SPEEDS, curves, "strain energy")
    return Drawn(tuple(rows), (f"{_LENGTHS_NOTE} {FORM_NOTE} {RANGE_NOTE}",))


def _height(speed: Array, values: Array) -> float:
    """Return the largest value at the critical speeds up to 65 rad/s, over the median."""
    inside = speed < 65.0
    return float(np.max(values[inside]) / np.median(values[inside]))


def _length_rows(speed: Array, curves: Sequence[Array], name: str) -> list[Quoted]:
    chosen = [own for frame, own in zip(FRAMES, curves, strict=True) if frame <= _LATE]
    ratios = [
        float(np.exp(np.mean(np.log(later / earlier)))) for earlier, later in pairwise(chosen)
    ]
    reason = "the largest peak grows by 2.4, the median by more" if "energy" in name else ""
    heights = [_height(speed, own) for own in chosen]
    inside = speed < 65.0
    peaks = [float(np.max(own[inside])) for own in chosen]
    return [
        Quoted(
            f"{name} with a longer frame over that with the one before, largest mean ratio",
            1.0,
            max(ratios),
            0.0,
            f"'when L4 decreases, the deflections are greater'; L4 to {_LATE} m, mean over the "
            "speeds",
            "7.3",
            relation="<",
        ),
        Quoted(
            f"peak {name} over its median, L4 = {FRAME} m against {_LATE} m",
            1.0,
            heights[0] / heights[-1],
            0.0,
            "'the peaks are more pronounced' with a short frame; up to 65 rad/s",
            "7.3",
            relation=">",
            differs=reason,
        ),
        Quoted(
            f"peak {name}, L4 = {FRAME} m over {_LATE} m",
            1.5,
            peaks[0] / peaks[-1],
            0.0,
            "'depend very strongly on L4': more than half as much again; up to 65 rad/s",
            "7.3",
            relation=">",
        ),
    ]


def _weak_rows(curves: Sequence[Array]) -> list[Quoted]:
    places = [nearest(maxima(_SPEEDS, own), CRITICAL) for own in curves[:3]]
    means = [_mean_frequencies(frame) for frame in FRAMES]
    spread = np.ptp(np.array(means), axis=0) / means[0]
    return [
        Quoted(
            f"critical speed nearest to 62, L4 = {FRAME} m",
            CRITICAL,
            places[0],
            1.0,
            "within 1 rad/s",
            "6.8",
            unit="rad/s",
        ),
        Quoted(
            f"critical speed near 62 rad/s, its range over L4 to {_LATE} m, relative",
            0.0,
            float(np.ptp(places) / places[0]),
            0.02,
            "'only very weakly dependent on L4', read as 2 %",
            "7.3",
        ),
        Quoted(
            "mean first natural frequency, its range over six L4, relative",
            0.0,
            float(spread[0]),
            0.02,
            "'very weakly dependent on L4', read as 2 %",
            "7.3",
        ),
    ]


def _mean_frequencies(frame: float) -> Array:
    from ..frequencies import natural_frequencies

    return np.asarray(natural_frequencies(beams(1, FULL, frame=frame), 0.0, 4).mean)


# ---------------------------------------------------------------- Fig. 7.13


def bending_at_midpoint(
    system: LinearPeriodic, moving: LinearPeriodic | None = None
) -> tuple[Array, Array]:
    """Return crank angles [rad] and the bending stress at the follower's midpoint [Pa], 30 rad/s.

    The motion is that of another system where one is given, the stress by the first one's shapes.
    """
    from ..recovery import recover

    motion = periodic(system if moving is None else moving, _SPEED)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LinearRangeWarning)
        forces = recover(system, motion, stations={"follower": [0.5]}, method="shape")
    structure = system.structure
    assert structure is not None
    (section,) = (beam.section for beam in structure.beams if beam.name == "follower")
    assert section.thickness is not None
    factor = 0.5 * section.thickness / section.second_moment
    return forces.theta, np.asarray(factor * forces.of("follower", "moment")[:, 0])


@lru_cache(maxsize=8)
def midpoint_stress(frame: float) -> tuple[Array, Array]:
    """Return angles and stress with three elements and another frame."""
    return bending_at_midpoint(beams(3, frame=frame))


def figure_7_13(axes: Sequence[Axes]) -> Drawn:
    """Draw the stress at the follower's midpoint over the cycle, six frames."""
    ax = axes[0]
    for frame, colour in zip(FRAMES, COLOURS, strict=False):
        theta, values = midpoint_stress(frame)
        ax.plot(np.degrees(theta), 1e-6 * values, color=colour, label=f"$L_4$ = {frame:.3f} m")
    ax.axhline(0.0, color="0.6", lw=0.8, zorder=1)
    crank_axis(ax)
    ax.set_xlabel("input angle $t_1$ [deg]")
    ax.set_ylabel("stress at the follower's midpoint [MPa]")
    legend_below([ax], columns=3)
    note = (
        "The values of L4 are not legible: those of Figs. 8.19 to 8.23 and 0.600 m. Three elements "
        f"for each link, damping 2 %, 30 rad/s. {FORM_NOTE}"
    )
    return Drawn(tuple(_late_rows()), (note,))


def _pulses(frame: float) -> tuple[float, float]:
    """Return the largest stress before a quarter turn, the response after, and about half."""
    theta, values = midpoint_stress(frame)
    turned, size = np.degrees(theta), np.abs(values)
    later = (turned > 150.0) & (turned < 300.0)
    return float(np.max(size[~later])), float(np.max(size[later]))


def _late_rows() -> list[Quoted]:
    pulses = np.array([_pulses(frame) for frame in FRAMES])
    whole = pulses.max(axis=1)
    least = FRAMES[int(np.argmin(whole))]
    return [
        Quoted(
            "stress after the second pulse over that of the first, L4 = 0.547 m",
            1.0,
            float(pulses[0, 1] / pulses[0, 0]),
            0.0,
            "one pulse in a cycle at first; second: 150 to 300 deg",
            "7.5",
            relation="<",
        ),
        Quoted(
            "the same, L4 = 0.662 m",
            1.0,
            float(pulses[-1, 1] / pulses[-1, 0]),
            0.0,
            "'the stress at the latter angle becomes dominant'",
            "7.5",
            relation=">",
        ),
        Quoted(
            "L4 of the least largest stress of the six",
            0.66,
            least,
            0.03,
            "'increased only in a certain range': the measured stress turns at 0.66 m (8.5)",
            "7.5",
            unit="m",
        ),
    ]
