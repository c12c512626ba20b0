"""Entries of the registry for Smith's frequency responses, Figs. 52 to 80."""

from __future__ import annotations

from . import smith_responses
from .records import FigureEntry

_CURVES = tuple(
    FigureEntry("smith", one.figure, one.title, smith_responses.response_figure(one.figure))
    for one in smith_responses.RESPONSES
)

_WAVES = (
    FigureEntry(
        "smith",
        "54",
        "Wave-form of the coupler through a resonance",
        smith_responses.figure_54,
        panels=(1, 3),
        size=(10.0, 3.4),
    ),
    FigureEntry(
        "smith",
        "55",
        "Wave-form of the coupler at 230 rpm: effect of the follower's inertia",
        smith_responses.figure_55,
    ),
)

RESPONSE_FIGURES = tuple(sorted((*_CURVES, *_WAVES), key=lambda entry: int(entry.label)))
