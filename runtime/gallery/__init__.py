"""The gallery: computed figures of the documents redrawn, the numbers they quote checked."""

from __future__ import annotations

from .records import Drawn, FigureEntry, Gallery, Quoted, Shown, Table
from .rendering import figures, reproduce

__all__ = ["Drawn", "FigureEntry", "Gallery", "Quoted", "Shown", "Table", "figures", "reproduce"]
