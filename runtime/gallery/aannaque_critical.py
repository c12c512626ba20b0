"""Aannaque's Figs. 7.1 and 7.3: stress, multipliers and Meissner's J over the crank speed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..core.families import Array
from .aannaque_models import (
    CRITICAL,
    FORM_NOTE,
    FULL,
    RANGE_NOTE,
    THESIS,
    beams,
    maxima,
    nearest,
    stresses,
    tops,
)
from .records import Drawn, Quoted, Table
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..frequencies import NaturalFrequencies

_SPEEDS = np.linspace(20.0, 75.0, 221)
_MODES = 4
# Modes whose multipliers tell the critical speeds of this range.
_DRAWN = 2
_INTERVALS = 180


@lru_cache(maxsize=2)
def _stress(drop: tuple[str, ...]) -> Array:
    """Return the largest stress of all links [Pa], one element for each."""
    return np.asarray(np.max(stresses(beams(1, drop), _SPEEDS).maximum, axis=1))


@lru_cache(maxsize=2)
def real_parts(drop: tuple[str, ...] = THESIS) -> Array:
    """Return the larger real part of each pair of multipliers, by falling modulus, (ns, 4).

    With one damping ratio they follow one another as the modes do, but where two pairs meet.
    """
    from ..periodic import floquet_multipliers
    from ..periodic.reduced import reduced_system

    system = reduced_system(beams(1, drop), _MODES)
    found = floquet_multipliers(system, _SPEEDS, rtol=1e-6).multipliers.real
    return np.asarray(np.max(found.reshape(len(_SPEEDS), _MODES, 2), axis=-1))


def figure_7_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the largest stress and the real parts of the multipliers over the speed."""
    for drop, style, label in ((THESIS, "-", "the thesis' form"), (FULL, ":", "full form")):
        axes[0].semilogy(
            _SPEEDS, 1e-6 * _stress(drop), style, color=COLOURS[0] if drop else "0.4", label=label
        )
    places = maxima(_SPEEDS, _stress(THESIS))
    axes[0].set_ylabel("largest stress [MPa]")
    for values, style, colour, name in zip(
        real_parts().T[:_DRAWN], ("-", "."), COLOURS[1:], ("largest", "second"), strict=False
    ):
        label = f"multipliers of {name} modulus"
        axes[1].plot(_SPEEDS, values, style, ms=3.5, color=colour, label=label)
    axes[1].set_ylabel("real part")
    axes[1].set_xlabel("crank speed [rad/s]")
    for ax in axes:
        ax.set_xlim(_SPEEDS[0], _SPEEDS[-1])
        for place in places:
            ax.axvline(place, color="0.6", lw=0.6, ls=(0, (1, 3)))
    legend_below(axes, columns=3)
    note = (
        f"{FORM_NOTE} One element for each link, damping 2 %; multipliers of the four lowest "
        "modes, which move with the mechanism, two are drawn; where moduli meet, the second is "
        f"another mode's. Dotted: local maxima of the stress. {RANGE_NOTE}"
    )
    return Drawn(tuple(_maxima_rows(places)), (note,), (_maxima_table(places),))


def _maxima_rows(places: Array) -> list[Quoted]:
    found = np.concatenate([tops(_SPEEDS, values) for values in real_parts().T[:_DRAWN]])
    off = [float(np.min(np.abs(found - place)) / place) for place in places]
    first = tops(_SPEEDS, real_parts()[:, 0])
    return [
        Quoted(
            "maxima of the stress, farthest off a maximum of a real part, relative",
            0.0,
            max(off),
            0.02,
            "'coincides, or nearly coincides', read as 2 %; modes 1 and 2",
            "7.2.3",
        ),
        Quoted(
            "critical speed nearest to 62, by the largest stress",
            CRITICAL,
            nearest(places, CRITICAL),
            1.0,
            "within 1 rad/s",
            "6.8",
            unit="rad/s",
            differs="the stress follows the second mode there, six oscillations in a turn; the "
            "first mode's multiplier and the follower's deflection (Fig. 7.4) have 61.3",
        ),
        Quoted(
            "critical speed nearest to 62, by the multiplier of the first mode",
            CRITICAL,
            nearest(first, CRITICAL),
            1.0,
            "within 1 rad/s",
            "6.8",
            unit="rad/s",
        ),
        Quoted(
            "largest modulus of the real parts",
            1.0,
            float(np.max(np.abs(real_parts()))),
            0.0,
            "critical speeds without an unstable band",
            "7.2.3",
            relation="<",
        ),
    ]


def _maxima_table(places: Array) -> Table:
    rows = []
    mean = float(_held().mean[0])
    for place in places:
        found = [tops(_SPEEDS, values) for values in real_parts().T[:_DRAWN]]
        rank = int(np.argmin([np.min(np.abs(own - place), initial=np.inf) for own in found]))
        order = max(round(mean / float(place)), 1)
        rows.append(
            (
                f"{place:.2f}",
                f"{nearest(found[rank], float(place)):.2f}",
                ("largest", "second")[rank],
                f"{mean / order:.2f} (n = {order})" if rank == 0 else "",
            )
        )
    header = ("stress [rad/s]", "real part [rad/s]", "modulus", "first mean frequency/n [rad/s]")
    return Table("Critical speeds of the one-element model", header, tuple(rows))


# ---------------------------------------------------------------- Fig. 7.3


@lru_cache(maxsize=1)
def _held() -> NaturalFrequencies:
    """Return the frequencies of the one-element model, 720 to a cycle."""
    from ..frequencies import natural_frequencies

    return natural_frequencies(beams(1, FULL), 2.0 * np.pi * np.arange(720) / 720, _MODES)


def _meissner(speed: Array, intervals: int) -> Array:
    """Return J of so many intervals of the first mode; exact means of each."""
    from ..hill import Meissner, discriminant

    first = _held().frequency[:, 0]
    levels = first.reshape(intervals, -1).mean(axis=1)
    return discriminant(Meissner.of(levels**2), 0.0, 1.0 / speed**2).value


def figure_7_3(axes: Sequence[Axes]) -> Drawn:
    """Draw J_2, J_3, J_4 and the real part of a multiplier over the speed, first mode."""
    ax = axes[0]
    fine = _meissner(_SPEEDS, _INTERVALS)
    ax.plot(_SPEEDS, fine, color="0.15", lw=1.2, label=f"{_INTERVALS} intervals")
    for count, mark, colour in zip((2, 3, 4), "os^", COLOURS, strict=False):
        some = slice(2 * count - 4, None, 6)
        values = _meissner(_SPEEDS, count)[some]
        ax.plot(_SPEEDS[some], values, mark, color=colour, ms=4, label=f"$J_{count}$")
    damped = real_parts()[:, 0]
    ax.plot(_SPEEDS, damped, "--", color=COLOURS[3], label="all modes, damping 2 %")
    for level in (-1.0, 1.0):
        ax.axhline(level, color="0.6", lw=0.6)
    ax.set_xlim(_SPEEDS[0], _SPEEDS[-1])
    ax.set_ylim(-1.3, 1.3)
    ax.set_xlabel("crank speed [rad/s]")
    ax.set_ylabel("half trace, real part")
    legend_below([ax], columns=5)
    note = (
        "First mode of the one-element model of Table 4.1 by itself, its frequency constant in "
        "each interval and no damping; inside stable bands J is the real part of both multipliers. "
        "The thesis' ranges are not legible."
    )
    return Drawn(tuple(_meissner_rows(fine)), (note,))


def _meissner_rows(fine: Array) -> list[Quoted]:
    reference = tops(_SPEEDS, fine)
    rows = []
    for count in (2, 3, 4):
        found = tops(_SPEEDS, _meissner(_SPEEDS, count))
        off = [float(np.min(np.abs(found - place)) / place) for place in reference]
        rows.append(
            Quoted(
                f"critical speeds from J_{count}, farthest off those of {_INTERVALS} intervals, "
                "relative",
                0.0,
                max(off),
                0.01,
                "'a good approximation', read as 1 %",
                "7.2.3",
            )
        )
    mean = float(_held().mean[0])
    divisions = mean / np.arange(1, 12)
    off = [float(np.min(np.abs(divisions - place)) / place) for place in reference]
    rows.append(
        Quoted(
            "critical speeds off whole divisions of the mean frequency, relative",
            0.0,
            max(off),
            0.01,
            "'integer divisions of the mean value', read as 1 %",
            "7.2.3",
        )
    )
    coupled = tops(_SPEEDS, real_parts()[:, 0])
    off = [float(np.min(np.abs(coupled - place)) / place) for place in reference]
    rows.append(
        Quoted(
            "the same off the maxima with all modes and damping, relative",
            0.0,
            max(off),
            0.02,
            "'correspond to the real part', read as 2 %",
            "7.2.3",
        )
    )
    exact = [_meissner(_SPEEDS, count) for count in (90, 180, 720)]
    gaps = [float(np.max(np.abs(values - exact[2]))) for values in exact[:2]]
    rows.append(
        Quoted(
            "order of convergence in the number of intervals",
            2.0,
            float(np.log2(gaps[0] / gaps[1])),
            0.15,
            "from 90 to 180 against 720: 2.1 of order 2; 'converges quite rapidly'",
            "7.2.3",
        )
    )
    return rows
