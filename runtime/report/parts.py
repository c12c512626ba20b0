"""What a report is made of, section by section, and how numbers are written in it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from ..core.plotting import Axes, figure_bytes, new_figure
from ..core.results import Result

# Colours that the colour-blind tell apart (Okabe and Ito), the yellow left out.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
_LOOK = {
    "axes.prop_cycle": f"cycler(color={list(COLOURS)})",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "font.size": 9.0,
    "axes.titlesize": 9.0,
}
# Bytes beyond which a figure is given as pixels in place of lines.
_LARGEST = 150_000


@dataclass(frozen=True)
class Table:
    """A table: what it shows, the heads of its columns parted by bars, and rows of text."""

    caption: str
    heads: str
    rows: Iterable[tuple[str, ...]]


@dataclass(frozen=True)
class Figure:
    """A picture as the bytes of an SVG or PNG file."""

    caption: str
    told: str  # what is to be seen, for those who do not see it
    content: bytes
    kind: str  # "svg+xml" or "png"


@dataclass(frozen=True)
class Markup:
    """HTML of this toolkit's own making."""

    text: str


@dataclass(frozen=True)
class Checked:
    """A result whose method, error and checks are told."""

    name: str
    result: Result


Part = str | Table | Figure | Markup | Checked  # a text is a paragraph


@dataclass(frozen=True)
class Section:
    """One subject of a report; its first paragraph is the short of it."""

    heading: str
    parts: tuple[Part, ...]
    warned: tuple[str, ...] = ()
    failed: str = ""  # why there is no more of it

    @property
    def brief(self) -> str:
        """The first paragraph."""
        return next((part for part in self.parts if isinstance(part, str)), "")

    @property
    def results(self) -> dict[str, Result]:
        """Its results by name."""
        return {part.name: part.result for part in self.parts if isinstance(part, Checked)}


def figure(caption: str, told: str, draw: Callable[[Axes], Any], height: float = 3.7) -> Figure:
    """Return a drawing as a figure: of lines, or of pixels where there are too many of them."""
    import matplotlib as mpl

    with mpl.rc_context(_LOOK):
        drawing = new_figure(5.4, height)
        ax = drawing.add_subplot()
        draw(ax)
        if (legend := ax.get_legend()) is not None:  # below, where it covers nothing
            legend.remove()
            named = dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))
            place = {"loc": "outside lower center", "ncols": 2, "fontsize": 8, "frameon": False}
            drawing.legend(named.values(), named, **place)
        content, kind = figure_bytes(drawing, ".svg"), "svg+xml"
        if len(content) > _LARGEST:
            content, kind = figure_bytes(drawing, ".png"), "png"
    return Figure(caption, told, content, kind)


def number(value: float, error: float | None = None) -> str:
    """Return a number to six digits, or to the first digit of its error where that is before."""
    digits = 6
    if error is not None and math.isfinite(error) and error > 0.0:
        if abs(value) <= error:
            return "0"
        size, doubt = (math.floor(math.log10(one)) for one in (abs(value), error))
        digits = min(size - doubt + 1, 6)
    return f"{float(f'{value + 0.0:.{digits}g}'):.6g}"


def small(value: float) -> str:
    """Return an error to two digits; in words where it is not known."""
    return f"{value:.2g}" if math.isfinite(value) else "not known"


def known(value: float, error: float, unit: float = 1.0) -> tuple[str, str]:
    """Return a number and its error as text, both in a unit that is so large."""
    return number(float(value) / unit, float(error) / unit), small(float(error) / unit)


def set_unit(text: str) -> str:
    """Return a unit as it is set: powers raised, products apart."""
    raised = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
    plain = text.replace("**", "^").replace("*", " ")
    return re.sub(r"\^(-?\d+)", lambda power: power[1].translate(raised), plain)
