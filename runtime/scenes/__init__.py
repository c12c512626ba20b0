"""Scenes: the numbers of a machine as a TOML file, checked whole and handed over in SI units."""

from __future__ import annotations

from .loader import changed_scene, list_scenes, load_scene, scene_from_document, scene_titles
from .scene import ReadOnlyTable, Scene

__all__ = [
    "ReadOnlyTable",
    "Scene",
    "changed_scene",
    "list_scenes",
    "load_scene",
    "scene_from_document",
    "scene_titles",
]
