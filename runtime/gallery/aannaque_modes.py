"""Aannaque's Figs. 8.9 to 8.18 and 9.1: natural modes, and the coupler's length."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import radians
from typing import TYPE_CHECKING

import numpy as np

from .aannaque_rig import Array, rig
from .records import Drawn, Quoted, Table
from .style import COLOURS, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..frequencies import LinkFrequencies, NaturalFrequencies

_MODES = 3
# Captions of Figs. 8.9 to 8.18.
CAPTIONS = (0, 36, 72, 108, 144, 180, 216, 252, 288, 316)
ANGLES = tuple(360 * k // len(CAPTIONS) for k in range(len(CAPTIONS)))
_SLIP = "the cycle is divided into ten equal angles (8.4): the last is 324 deg"
# Agreement of three cubic elements per link with dynamic stiffness [%]; section 4.3 is content
# with 1.18 % between meshes.
_MESH = 1.18
_NOTE = (
    "Computed by three cubic elements per link, crank clamped to its shaft; the measured "
    "frequencies and shapes of the document are lost in the scan. Grey: the linkage undeformed."
)
_CROSSING = 0.547
_LENGTHS = np.concatenate([np.linspace(0.30, 0.52, 8), np.linspace(0.535, 0.80, 16)])
_NEAR = 5.0


@lru_cache(maxsize=1)
def held_modes() -> NaturalFrequencies:
    """Return the first three modes at the ten crank angles of section 8.4."""
    from ..frequencies import natural_frequencies

    return natural_frequencies(rig(), np.radians(ANGLES), _MODES)


@lru_cache(maxsize=16)
def _exact(angle: int) -> Array:
    """Return the first frequencies [rad/s] at a crank angle [deg] by dynamic stiffness."""
    from .model_comparison import exact_frequencies

    structure = rig().structure
    assert structure is not None
    found = exact_frequencies(structure, np.array([radians(angle)]), _MODES)
    return np.asarray(found[0])


def mode_figure(place: int) -> Callable[[Sequence[Axes]], Drawn]:
    """Return the function that draws the modes at one of the ten crank angles."""

    def draw(axes: Sequence[Axes]) -> Drawn:
        from ..frequencies import draw_mode

        angle, found = ANGLES[place], held_modes()
        computed = np.sort(found.tracked[place])
        order = np.argsort(found.tracked[place])
        for rank, ax in enumerate(axes):
            draw_mode(rig(), radians(angle), int(order[rank]) + 1, ax, found=found)
            hertz = computed[rank] / (2 * np.pi)
            ax.set_title(f"mode {rank + 1}: {hertz:.1f} Hz, {computed[rank]:.1f} rad/s", fontsize=9)
        exact = _exact(angle)
        rows = (
            Quoted(
                "crank angle in the caption",
                float(CAPTIONS[place]),
                float(angle),
                0.0,
                "ten equal angles",
                "8.4",
                unit="deg",
                differs="" if CAPTIONS[place] == angle else _SLIP,
            ),
            Quoted(
                "three elements per link above dynamic stiffness, the worst of three modes",
                _MESH,
                float(100.0 * np.max(np.abs(computed / exact - 1.0))),
                0.0,
                "the predictions were made by dynamic stiffness; 1.18 % is the document's own "
                "measure of a mesh that is fine enough",
                "5.4, 8.4",
                relation="<",
                unit="%",
            ),
        )
        return Drawn(rows, (_NOTE,), (_table(angle, computed, exact),))

    return draw


def _table(angle: int, computed: Array, exact: Array) -> Table:
    rows = tuple(
        (str(rank + 1), *(f"{value / (2 * np.pi):.2f}" for value in pair))
        for rank, pair in enumerate(zip(computed, exact, strict=True))
    )
    header = ("mode", "three elements per link [Hz]", "dynamic stiffness [Hz]")
    return Table(f"Natural frequencies at the crank angle {angle} deg", header, rows)


@lru_cache(maxsize=1)
def over_coupler() -> LinkFrequencies:
    """Return the mean first natural frequency against the coupler's length."""
    from ..frequencies import link_frequencies

    return link_frequencies(rig(), "coupler", "length", _LENGTHS)


def figure_9_1(axes: Sequence[Axes]) -> Drawn:
    """Draw the mean first frequency over the coupler's length, and those of the pinned links."""
    ax = axes[0]
    found = over_coupler()
    hertz = 1.0 / (2 * np.pi)
    mean = found.mean[:, 0]
    pinned = dict(zip(found.links, found.pinned.T, strict=True))
    coupler, follower = pinned["coupler"], pinned["follower"]
    ax.plot(found.value, hertz * mean, color=COLOURS[0], label="mechanism, mean over the cycle")
    ax.fill_between(
        found.value,
        hertz * found.least[:, 0],
        hertz * found.largest[:, 0],
        color=COLOURS[0],
        alpha=0.15,
        lw=0,
        label="its range over the cycle",
    )
    ax.plot(found.value, hertz * coupler, "--", color=COLOURS[1], label="coupler, pinned-pinned")
    ax.plot(found.value, hertz * follower, "-.", color=COLOURS[2], label="follower, pinned-pinned")
    ax.axvline(_CROSSING, color="0.6", lw=0.8, ls=(0, (1, 3)))
    ax.set_ylim(0.0, 60.0)
    ax.set_xlabel("length of the coupler $L_2$ [m]")
    ax.set_ylabel("first natural frequency [Hz]")
    legend_below(axes, columns=2)
    lowest = np.minimum(coupler, follower)
    apart = 100.0 * np.abs(mean / lowest - 1.0)
    short = found.value < _CROSSING
    rows = (
        Quoted(
            "coupler length at which the two links' frequencies are equal",
            _CROSSING,
            crossing(),
            0.0005,
            "half of the last digit",
            "9.2",
            unit="m",
        ),
        _close("follower, pinned, against the mechanism, shorter couplers", apart[short]),
        _close("coupler, pinned, against the mechanism, longer couplers", apart[~short]),
    )
    note = (
        "By three elements per link; the range of L2 is not legible. The mean lies below the "
        f"lowest pinned frequency at all lengths drawn, most so where both are equal, "
        f"{np.max(apart):.1f} %: the links couple there. The input link alone, pinned, vibrates at "
        f"{hertz * pinned['crank'][0]:.0f} Hz, far above the picture."
    )
    return Drawn(rows, (note,))


def crossing() -> float:
    """Return the coupler length [m] at which coupler and follower, pinned, vibrate alike."""
    found = over_coupler()
    pinned = dict(zip(found.links, found.pinned.T, strict=True))
    # A pinned beam's frequency goes with the inverse square of its length.
    return float(found.value[0] * np.sqrt(pinned["coupler"][0] / pinned["follower"][0]))


def _close(number: str, apart: Array) -> Quoted:
    return Quoted(
        f"{number}, largest difference",
        _NEAR,
        float(np.max(apart)),
        0.0,
        "'could be approximated': within 5 %",
        "9.2",
        relation="<",
        unit="%",
    )
