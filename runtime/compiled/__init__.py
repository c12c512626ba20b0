"""Emitted functions as compiled loops over points instead of passes of NumPy (extra ``fast``)."""

from __future__ import annotations

from .functions import CompiledFunction, compiled_function
from .modules import compiled_module
from .systems import compiled

__all__ = ["CompiledFunction", "compiled", "compiled_function", "compiled_module"]
