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
    "PeriodicFunction": "series.periodic",
    "StepTooLongWarning": "errors",
    "Term": "families",
    "Transcendental": "families",
    "array_function": "families",
    "assemble": "systems.assembly",
    "discriminant": "hill.half_trace",
    "find_module": "systems.modules",
    "floquet_multipliers": "floquet.monodromy_matrix",
    "hill_boundaries": "hill.matrix",
    "list_scenes": "scenes",
    "load_scene": "scenes",
    "monodromy": "floquet.monodromy_matrix",
    "perturbation_boundaries": "hill.perturbation",
    "simulate": "simulation.trajectory",
    "speed_boundaries": "floquet.boundary_speeds",
    "stability_chart": "charts.chart",
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
