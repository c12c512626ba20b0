"""Dynamics of elastic linkages: derive the equations, emit them as NumPy, solve and check.

The names below load on first use, so that importing the package costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PUBLIC = {
    "BadInput": "errors",
    "Constrained": "families",
    "ElastolinkError": "errors",
    "FourBar": "mechanisms",
    "LinearPeriodic": "families",
    "LinearRangeWarning": "errors",
    "PeriodicFunction": "periodic",
    "StepTooLongWarning": "errors",
    "Term": "families",
    "Transcendental": "families",
    "array_function": "families",
    "assemble": "assembly",
    "discriminant": "hill",
    "find_module": "modules",
    "floquet_multipliers": "floquet",
    "hill_boundaries": "hill_matrix",
    "list_scenes": "scenes",
    "load_scene": "scenes",
    "monodromy": "floquet",
    "perturbation_boundaries": "hill_perturbation",
    "simulate": "simulation",
    "speed_boundaries": "speed_boundaries",
    "stability_chart": "charts",
}

__all__ = ["__version__", *sorted(_PUBLIC)]


def __getattr__(name: str) -> Any:
    """Load a public name from its module on first use."""
    if name not in _PUBLIC:
        raise AttributeError(f"module 'elastolink' has no attribute {name!r}")
    value = getattr(import_module(f"elastolink.runtime.{_PUBLIC[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the public names, loaded or not."""
    return sorted(__all__)
