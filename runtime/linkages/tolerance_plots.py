"""Pictures of tolerances: error bands against the crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..core.errors import bad

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .tolerance_result import Tolerances

_PREFERRED = ("theta4", "position", "theta3")
_NAMES = {"theta2": "crank angle"}
_SYMBOLS = {"theta3": r"$\theta_3$", "theta4": r"$\theta_4$"}


def draw(found: Tolerances, ax: Axes | None, output: str | None) -> Axes:
    """Draw the band of an output's deviation: worst case, root of squares, and each length's part.

    Raises
    ------
    BadInput
        If there is no such output, or the crank angles are not a one-dimensional array.
    """
    from ..core.plotting import axes_or_new

    if found.theta2.ndim != 1:
        shape = f"crank angles of shape {found.theta2.shape}"
        raise bad("plot", shape, "a one-dimensional array", "choose one speed, a row of angles")
    name = output or next(name for name in _PREFERRED if name in found.outputs)
    row, unit = found.place(name), found.unit(name)
    factor = 1.0
    if unit == "rad":
        factor, unit = 1e3, "mrad"
    elif unit == "m":
        factor, unit = 1e3, "mm"
    ax = axes_or_new(ax)
    order = np.argsort(found.theta2)
    degrees = np.degrees(found.theta2[order])
    for values, words, shade in (
        (found.worst_case, "worst case", "0.88"),
        (found.root_sum_square, "root of the sum of squares", "0.72"),
    ):
        band = factor * values[row][order]
        ax.fill_between(degrees, -band, band, color=shade, lw=0, label=words)
    for place, parameter in enumerate(found.parameters):
        if found.tolerance[place] > 0.0:
            line = factor * found.deviations[row, place][order]
            ax.plot(degrees, line, lw=1.2, label=f"{_NAMES.get(parameter, parameter)} alone")
    ax.axhline(0.0, color="0.4", lw=0.8)
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel(f"deviation of {_SYMBOLS.get(name, name)} [{unit}]")
    ax.margins(x=0.0)
    # Beside the band, which fills the axes.
    ax.legend(fontsize="small", ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return ax
