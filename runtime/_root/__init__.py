"""Dynamics of elastic linkages: derive the equations, emit them as NumPy, solve and check.

The names below load on first use, so that importing the package costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PUBLIC = {
    "BadInput": "errors",
    "Bounds": "balancing",
    "Constrained": "families",
    "Counterweight": "balancing",
    "ElastolinkError": "errors",
    "FourBar": "mechanisms",
    "LinearPeriodic": "families",
    "LinearRangeWarning": "errors",
    "Load": "dynamics",
    "Machine": "dynamics",
    "MassDistribution": "dynamics",
    "PeriodicFunction": "series.periodic",
    "QuickReturn": "mechanisms",
    "SliderCrank": "mechanisms",
    "Spring": "dynamics",
    "StepTooLongWarning": "errors",
    "Term": "families",
    "TorqueLine": "dynamics",
    "TorsionSpring": "dynamics",
    "Transcendental": "families",
    "animate": "kinematics",
    "array_function": "families",
    "assemble": "systems.assembly",
    "balance": "balancing",
    "balance_case": "balancing",
    "base_plane": "kinematics",
    "classify": "kinematics",
    "classify_many": "kinematics",
    "clearance_range": "kinematics",
    "cognates": "kinematics",
    "coupler_curve": "kinematics",
    "discriminant": "hill.half_trace",
    "driving_torque": "dynamics",
    "find_module": "systems.modules",
    "floquet_multipliers": "floquet.monodromy_matrix",
    "flywheel_inertia": "dynamics",
    "harmonics": "kinematics",
    "hill_boundaries": "hill.matrix",
    "kutzbach": "kinematics",
    "list_scenes": "scenes",
    "load_scene": "scenes",
    "mechanical_advantage": "kinematics",
    "mobility": "kinematics",
    "monodromy": "floquet.monodromy_matrix",
    "optimal_offset": "balancing",
    "perturbation_boundaries": "hill.perturbation",
    "pin_forces": "dynamics",
    "reciprocating_balance": "balancing",
    "rigid_forces": "dynamics",
    "run_up": "dynamics",
    "shaking_force": "dynamics",
    "shaking_moment": "dynamics",
    "simpson_harmonics": "kinematics",
    "simulate": "simulation.trajectory",
    "speed_boundaries": "floquet.boundary_speeds",
    "stability_chart": "charts.chart",
    "tolerances": "kinematics",
    "torque_fluctuation": "dynamics",
    "trade_off": "balancing",
    "transmission_angle": "kinematics",
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
