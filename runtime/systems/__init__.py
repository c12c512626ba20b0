"""From scenes and emitted modules to the systems that the solvers take."""

from __future__ import annotations

from .assembly import assemble
from .geometry_series import taylor_in_geometry
from .modules import EmittedModule, find_module
from .rod.constrained import free_free_rod

__all__ = ["EmittedModule", "assemble", "find_module", "free_free_rod", "taylor_in_geometry"]
