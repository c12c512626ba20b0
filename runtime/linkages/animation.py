"""A moving picture of a linkage: links, pins, guide, slider or block, and traced paths, as GIF."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import bad
from ..core.inputs import require_whole
from ..core.plotting import require_writable
from ..core.results import write_whole
from ._circuits import Circuit
from ._drawing import COLOURS, bars, draw_frame, draw_linkage, pins, point_bar
from ._taylor import Complex
from .curves import CouplerCurve, require_linkage
from .linkage import Linkage

_MOST_FRAMES, _FASTEST = 2000, 50
_TRACE_POINTS = 721


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
        Which closed motion (see :func:`~.coupler_curve.coupler_curve`).

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
    """
    target = check_animation_path(path)
    require_linkage(linkage)
    motion = Circuit(linkage, circuit)
    motion.check()
    require_whole("frames", frames, 2, _MOST_FRAMES)
    require_whole("fps", fps, 1, _FASTEST)
    for curve in curves:
        if not isinstance(curve, CouplerCurve):
            raise bad("curves", type(curve).__name__, "coupler curves", "use coupler_curve")
        if curve.linkage != linkage or curve.circuit != circuit:
            raise bad("curves", "a curve of another linkage or circuit", "its own", "leave it out")
    return write_whole(target, _gif(motion, curves, int(frames), int(fps)))


def check_animation_path(path: str | Path) -> Path:
    """Return the path of a GIF that can be written; refuse it before any work starts.

    Raises
    ------
    BadInput
        If the ending is another one, or the folder does not exist or is read-only.
    """
    target = Path(path)
    if target.suffix != ".gif":
        raise bad(str(target), repr(target.suffix), "the ending '.gif'", "rename the file")
    return require_writable(target)


def _gif(motion: Circuit, curves: Sequence[CouplerCurve], frames: int, fps: int) -> bytes:
    """Return the bytes of the moving picture."""
    import matplotlib as mpl
    from matplotlib.animation import PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from ..core.plotting import new_figure

    figure = new_figure(6.4, 4.8)
    FigureCanvasAgg(figure)
    scene = _Scene(figure.add_subplot(), motion, curves)
    writer = PillowWriter(fps=fps)
    # The user's own settings of saved figures would change the size of a picture.
    settings = {"savefig.bbox": None, "savefig.facecolor": "white"}
    with tempfile.TemporaryDirectory() as folder, mpl.rc_context(settings):
        file = Path(folder) / "motion.gif"
        writer.setup(figure, str(file), dpi=100)
        for s in np.arange(frames) * 2.0 * pi / frames:
            scene.move(float(s))
            writer.grab_frame()
        # Not its context manager, which would finish an interrupted picture too.
        writer.finish()
        return file.read_bytes()


class _Scene:
    """The artists of one linkage, moved from picture to picture."""

    def __init__(self, ax: Any, motion: Circuit, curves: Sequence[CouplerCurve]) -> None:
        self._motion, self._curves = motion, curves
        s = np.linspace(0.0, 2.0 * pi, _TRACE_POINTS)
        places = [complex(curve.along, curve.across) for curve in curves]
        traces: list[Complex] = [
            motion.scale * motion.path(s, curve.link, place / motion.scale, 0).c[0]
            for curve, place in zip(curves, places, strict=True)
        ]
        draw_frame(ax, motion, traces)
        for trace in traces:
            ax.plot(trace.real, trace.imag, color="k", lw=1.0, zorder=1)
        self._places = places
        self._artists = draw_linkage(ax, motion, 0.0)
        self._arms, self._dots = [], []
        for curve, place in zip(curves, places, strict=True):
            line = point_bar(motion, 0.0, curve.link, place)
            (arm,) = ax.plot(line.real, line.imag, color=COLOURS[curve.link], lw=1.0, zorder=2)
            (dot,) = ax.plot(line[1:2].real, line[1:2].imag, "o", color="k", ms=4, zorder=6)
            self._arms.append(arm)
            self._dots.append(dot)

    def move(self, s: float) -> None:
        """Bring every artist to one position."""
        for link, line in bars(self._motion, s).items():
            self._artists[link].set_data(line.real, line.imag)
        at = pins(self._motion, s)
        self._artists["pins"].set_data(at.real, at.imag)
        for i, (curve, place) in enumerate(zip(self._curves, self._places, strict=True)):
            line = point_bar(self._motion, s, curve.link, place)
            self._arms[i].set_data(line.real, line.imag)
            self._dots[i].set_data(line[1:2].real, line[1:2].imag)
