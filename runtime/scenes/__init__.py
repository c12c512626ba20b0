"""Scenes: the numbers of a machine as a TOML file, checked whole and handed over in SI units."""

from __future__ import annotations

from .loader import list_scenes, load_scene, scene_from_document, scene_titles, with_numbers
from .scene import ReadOnlyTable, Scene

__all__ = [
    "ReadOnlyTable",
    "Scene",
    "list_scenes",
    "load_scene",
    "scene_from_document",
    "scene_titles",
    "with_numbers",
]
