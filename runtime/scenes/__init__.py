"""Scenes: the numbers of a machine as a TOML file, checked whole and handed over in SI units."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .loader import list_scenes as list_scenes
    from .loader import load_scene as load_scene
    from .loader import scene_from_document as scene_from_document
    from .loader import scene_titles as scene_titles
    from .loader import with_numbers as with_numbers
    from .scene import ReadOnlyTable as ReadOnlyTable
    from .scene import Scene as Scene

__all__ = on_first_use(globals())
