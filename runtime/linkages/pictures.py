"""Pictures of a linkage: bars, pins, pivots, guide, slider and block, paths; moving ones as GIF."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable, Sequence
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.errors import bad
from ..core.files import write_whole
from ..core.inputs import require_kind, require_whole
from ..core.plotting import Axes, new_figure, require_writable
from .circuits import Circuit, Complex
from .linkage import Array, Linkage, require_linkage

if TYPE_CHECKING:
    from .curves import CouplerCurve

_COLOURS = {
    "crank": "tab:red",
    "coupler": "tab:blue",
    "follower": "tab:green",
    "slider": "tab:green",
    "block": "tab:green",
    "rod": "tab:blue",
}
_GREY = "0.45"
# Corners of a block of unit half-width.
_BLOCK = np.array([1 + 0.6j, -1 + 0.6j, -1 - 0.6j, 1 - 0.6j, 1 + 0.6j])


def draw_curve(ax: Axes, curve: CouplerCurve) -> None:
    """Draw a path, the linkage at some positions, and what is marked on it."""
    motion = Circuit(curve.linkage, curve.circuit)
    trace = _trace(motion, curve)
    _draw_frame(ax, motion, [trace])
    for i, start in enumerate((0.7, 0.7 + pi / 2, 0.7 + pi, 0.7 + 3 * pi / 2)):
        alpha = 1.0 if i == 0 else 0.22
        _draw_linkage(ax, motion, start, alpha)
        line = _point_bar(motion, start, curve)
        ax.plot(line.real, line.imag, color=_COLOURS[curve.link], lw=1.0, alpha=alpha, zorder=2)
        ax.plot(line[1].real, line[1].imag, ".", color="k", alpha=alpha, zorder=6)
    ax.plot(trace.real, trace.imag, color="k", lw=1.3, label=f"point of the {curve.link}")
    _mark(ax, curve.cusp_position, "v", "tab:orange", "cusp")
    _mark(ax, curve.double_position, "D", "tab:purple", "double point")
    ax.legend(loc="best", fontsize="small")


def animate(
    linkage: Linkage,
    path: str | Path,
    *,
    curves: Sequence[CouplerCurve] = (),
    frames: int = 72,
    fps: int = 25,
    circuit: int = 0,
) -> Path:
    """Write the linkage moving once through its whole circuit, for endless repetition.

    Parameters
    ----------
    linkage : FourBar, SliderCrank or QuickReturn
        The linkage.
    path : str or Path
        A file that ends in ``.gif``; it appears whole or not at all.
    curves : sequence of CouplerCurve
        Paths to draw, each with its tracing point moving on it; of this linkage and circuit.
    frames : int
        Pictures in a circuit, 2 to 2000, at even steps of the circuit's parameter: of the crank
        angle where the crank turns.
    fps : int
        Pictures in a second, 1 to 50; the format counts in hundredths of a second.
    circuit : int
        Which closed motion (see :func:`~elastolink.runtime.linkages.coupler_curve`).

    Returns
    -------
    Path
        The file.  The same input gives the same bytes with the same versions of matplotlib and
        Pillow.

    Raises
    ------
    BadInput
        If this is no linkage, or the ending, the folder, a number, a curve or the circuit is
        impossible.

    Examples
    --------
    >>> import elastolink as el
    >>> linkage = el.FourBar(frame=12.0, crank=6.0, coupler=12.0, follower=12.0)
    >>> print(el.animate(linkage, "motion.gif", frames=4))
    motion.gif
    """
    target = check_animation_path(path)
    require_linkage(linkage)
    motion = Circuit(linkage, circuit)
    motion.check()
    require_whole("frames", frames, 2, 2000)
    require_whole("fps", fps, 1, 50)
    for curve in curves:
        if not hasattr(curve, "double_position"):
            raise bad("curves", type(curve).__name__, "coupler curves", "use coupler_curve")
        if curve.linkage != linkage or curve.circuit != circuit:
            raise bad("curves", "a curve of another linkage or circuit", "its own", "leave it out")
    return write_whole(target, _gif(motion, curves, int(frames), int(fps)))


def check_animation_path(path: str | Path) -> Path:
    """Return the path of a GIF; refuse another ending and a folder that is missing or read-only."""
    require_kind("path", path, (str, os.PathLike), "give the path of a GIF")
    target = Path(path)
    if target.suffix != ".gif":
        raise bad(str(target), repr(target.suffix), "the ending '.gif'", "rename the file")
    return require_writable(target)


def _gif(motion: Circuit, curves: Sequence[CouplerCurve], frames: int, fps: int) -> bytes:
    """Return the bytes of the moving picture: one palette, what stands still drawn once."""
    from PIL import Image

    film, plain = _Film(motion, curves), Image.Dither.NONE
    # Slanting bars, whose edges have mixed colours.
    slanting = np.concatenate([film.picture(0.3 + k * 2.0 * pi / 5.0) for k in range(5)])
    covering = Image.Quantize.MAXCOVERAGE
    palette = Image.fromarray(slanting).quantize(256, method=covering, dither=plain)
    turn = np.arange(frames) * 2.0 * pi / frames
    first, *rest = (
        Image.fromarray(film.picture(float(s))).quantize(palette=palette, dither=plain)
        for s in turn
    )
    buffer = io.BytesIO()
    first.save(buffer, "GIF", save_all=True, append_images=rest, duration=1000 // fps, loop=0)
    return buffer.getvalue()


class _Film:
    """The artists of one linkage on a canvas, moved from picture to picture."""

    def __init__(self, motion: Circuit, curves: Sequence[CouplerCurve]) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self._motion = motion
        figure = new_figure(6.4, 4.8)
        figure.set_dpi(100)
        figure.set_facecolor("white")
        self._canvas = FigureCanvasAgg(figure)
        self._ax = ax = figure.add_subplot()
        traces = [_trace(motion, curve) for curve in curves]
        _draw_frame(ax, motion, traces)
        for trace in traces:
            ax.plot(trace.real, trace.imag, color="k", lw=1.0, zorder=1)
        self._links = _draw_linkage(ax, motion, 0.0)
        self._points: list[tuple[CouplerCurve, Any, Any]] = []
        for curve in curves:
            bar = _point_bar(motion, 0.0, curve)
            (arm,) = ax.plot(bar.real, bar.imag, color=_COLOURS[curve.link], lw=1.0, zorder=2)
            (dot,) = ax.plot(bar[1:2].real, bar[1:2].imag, "o", color="k", ms=4, zorder=6)
            self._points.append((curve, arm, dot))
        # Artists above this order may be covered by moving ones, or cover them: drawn in every
        # frame.
        above = [line for line in ax.lines if line.get_zorder() >= 2]
        self._moving = sorted(above, key=lambda line: line.get_zorder())
        for line in self._moving:
            line.set_animated(True)
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(figure.bbox)

    def picture(self, s: float) -> Any:
        """Return the picture at one position, bytes of shape (height, width, 3)."""
        for link, line in bars_at(self._motion, s).items():
            self._links[link].set_data(line.real, line.imag)
        at = pins_at(self._motion, s)
        self._links["pins"].set_data(at.real, at.imag)
        for curve, arm, dot in self._points:
            line = _point_bar(self._motion, s, curve)
            arm.set_data(line.real, line.imag)
            dot.set_data(line[1:2].real, line[1:2].imag)
        self._canvas.restore_region(self._still)
        for artist in self._moving:
            self._ax.draw_artist(artist)
        return np.array(self._canvas.buffer_rgba())[..., :3]


def _trace(motion: Circuit, curve: CouplerCurve) -> Complex:
    s = np.linspace(0.0, 2.0 * pi, max(721, len(curve.parameter) + 1))
    place = complex(curve.along, curve.across) / motion.scale
    return np.asarray(motion.scale * motion.path(s, curve.link, place, 0).c[0])


def bars_at(motion: Circuit, s: float) -> dict[str, Complex]:
    """Return the moving parts at one position as lines through complex places, blocks last."""
    here, unit = np.array([s]), half_width(motion)
    joints, links = motion.joints(here), motion.links(here, 0)
    bars = {}
    for link, letters in sorted(motion.linkage.bars.items(), key=lambda bar: -len(bar[1])):
        ends = np.array([complex(joints[name][0]) for name in letters])
        turned = complex(links[link].direction.c[0, 0])
        bars[link] = ends if len(ends) == 2 else ends[0] + turned * (unit * _BLOCK)
    return bars


def pins_at(motion: Circuit, s: float) -> Complex:
    """Return the moving pins at one position."""
    at = motion.joints(np.array([s]))
    names = ("B",) if motion.linkage.mechanism == "quick_return" else ("B", "C")
    return np.array([complex(at[name][0]) for name in names])


def _point_bar(motion: Circuit, s: float, curve: CouplerCurve) -> Complex:
    """Return the line from the joints of the curve's link to its point."""
    here = motion.links(np.array([s]), 0)[curve.link]
    origin, turn = complex(here.origin.c[0, 0]), complex(here.direction.c[0, 0])
    ends = [0.0, complex(curve.along, curve.across) / motion.scale]
    if curve.link in motion.sizes and curve.across != 0:
        ends.append(motion.sizes[curve.link])
    return motion.scale * (origin + turn * np.array(ends))


def _draw_frame(ax: Axes, motion: Circuit, places: Iterable[Complex] = ()) -> None:
    """Draw what stands still, and set the limits so that the whole motion is seen."""
    unit = half_width(motion)
    joints = motion.joints(np.arange(181) * 2 * pi / 181)
    pivots = [0j, *([complex(joints["D"][0])] if "D" in joints else [])]
    for pivot in pivots:
        foot = pivot + unit * np.array([0, -0.6 - 0.9j, 0.6 - 0.9j, 0])
        ax.fill(foot.real, foot.imag, color="0.8", ec=_GREY, lw=1.0, zorder=1)
        ax.plot(pivot.real, pivot.imag, "o", color="w", mec=_GREY, ms=5, zorder=5)
    if motion.linkage.mechanism == "slider_crank":
        travel = joints["C"].real
        ends = np.array([np.min(travel) - 1.6 * unit, np.max(travel) + 1.6 * unit])
        for side in (-0.6, 0.6):
            level = motion.scale * motion.sizes["offset"] + side * unit
            ax.plot(ends, [level, level], color=_GREY, lw=1.0, zorder=1)
    drawn = np.concatenate([*joints.values(), *(np.ravel(place) for place in places)])
    edge = 1.8 * unit
    ax.set_xlim(float(np.min(drawn.real)) - edge, float(np.max(drawn.real)) + edge)
    ax.set_ylim(float(np.min(drawn.imag)) - edge, float(np.max(drawn.imag)) + edge)
    ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")


def _draw_linkage(ax: Axes, motion: Circuit, s: float, alpha: float = 1.0) -> dict[str, Any]:
    """Draw the moving parts at one position; return the artists by link, and "pins"."""
    artists: dict[str, Any] = {}
    for link, line in bars_at(motion, s).items():
        width = 2.5 if len(line) == 2 else 1.5
        (artists[link],) = ax.plot(
            line.real, line.imag, color=_COLOURS[link], lw=width, alpha=alpha, zorder=3
        )
    at = pins_at(motion, s)
    (artists["pins"],) = ax.plot(
        at.real, at.imag, "o", color="w", mec="0.2", ms=5, alpha=alpha, zorder=4
    )
    return artists


def _mark(ax: Axes, places: Array, marker: str, colour: str, label: str) -> None:
    if len(places):
        ax.plot(
            *places.T, marker, color=colour, mec="k", mew=0.5, ms=7, ls="", label=label, zorder=7
        )


def half_width(motion: Circuit) -> float:
    """Return the half-width of a drawn block."""
    joints = motion.joints(np.arange(8) * pi / 4)
    places = np.concatenate(list(joints.values()))
    return 0.035 * float(np.ptp(places.real) + np.ptp(places.imag))
