"""Dynamics of elastic linkages: derive the equations, emit them as NumPy, solve and check.

The names below load on first use, so that importing the package costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PUBLIC = {
    "BadInput": "core.errors",
    "Beam": "beams",
    "Bounds": "rigid",
    "Constrained": "core.families",
    "ElastolinkError": "core.errors",
    "FourBar": "linkages",
    "LinearPeriodic": "core.families",
    "LinearRangeWarning": "core.errors",
    "Load": "rigid",
    "Machine": "rigid",
    "MassDistribution": "rigid",
    "Material": "design",
    "Mathieu": "hill",
    "Meissner": "hill",
    "Node": "beams",
    "Nonlinear": "core.families",
    "PeriodicFunction": "core.periodic_function",
    "Prepared": "periodic",
    "QuickReturn": "linkages",
    "Section": "beams",
    "SliderCrank": "linkages",
    "SpeedProfile": "design",
    "Spring": "rigid",
    "Structure": "beams",
    "Term": "core.families",
    "TorqueLine": "rigid",
    "TorsionSpring": "rigid",
    "animate": "linkages",
    "assemble": "systems",
    "balance": "rigid",
    "boundary_derivatives": "hill",
    "boundary_series": "hill",
    "boundary_solution": "hill",
    "campbell": "frequencies",
    "characteristic_exponents": "hill",
    "classify": "linkages",
    "clearance_range": "linkages",
    "consistent_state": "constrained",
    "constrained_motion": "constrained",
    "coupler_curve": "linkages",
    "critical_damping": "hill",
    "critical_speeds": "frequencies",
    "discriminant": "hill",
    "driving_torque": "rigid",
    "dynamic_stiffness": "frequencies",
    "explain": "cli.explanation",
    "fatigue": "design",
    "floquet_multipliers": "periodic",
    "flywheel_inertia": "rigid",
    "frame": "beams",
    "harmonics": "linkages",
    "hill_boundaries": "hill",
    "hill_form": "hill",
    "linkage_system": "beams",
    "list_scenes": "scenes",
    "load": "core.results",
    "load_scene": "scenes",
    "mobility": "linkages",
    "monodromy": "periodic",
    "natural_frequencies": "frequencies",
    "orbit_multipliers": "constrained",
    "periodic_orbit": "constrained",
    "perturbation_boundaries": "hill",
    "pin_forces": "rigid",
    "pin_reactions": "recovery",
    "prepare": "periodic",
    "process_pool": "sweeps",
    "quiet_speeds": "design",
    "recover": "recovery",
    "resonance_curve": "frequencies",
    "response_curve": "nonlinear",
    "rigid_forces": "rigid",
    "run_through": "design",
    "run_up": "rigid",
    "running_speed": "design",
    "shaking_force": "rigid",
    "shaking_moment": "rigid",
    "simulate": "periodic",
    "speed_boundaries": "stability",
    "stability_chart": "stability",
    "stability_edges": "stability",
    "steady_state": "periodic",
    "stress": "recovery",
    "stress_curve": "recovery",
    "sweep": "sweeps",
    "sweep_response": "nonlinear",
    "tolerances": "linkages",
    "trade_off": "rigid",
    "transmission_angle": "linkages",
    "with_modal_damping": "systems",
    "wittrick_williams": "frequencies",
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
