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
    "FreeFreeBasis": "systems.rod",
    "Guard": "constrained",
    "LinearPeriodic": "families",
    "LinearRangeWarning": "errors",
    "Load": "dynamics",
    "Machine": "dynamics",
    "MassDistribution": "dynamics",
    "Mathieu": "hill.cases.named",
    "Meissner": "hill.cases.named",
    "OverhangBasis": "systems.rod",
    "PeriodicFunction": "series.periodic",
    "PolynomialBasis": "systems.rod",
    "QuickReturn": "mechanisms",
    "SliderCrank": "mechanisms",
    "Spring": "dynamics",
    "StepTooLongWarning": "errors",
    "Term": "families",
    "TorqueLine": "dynamics",
    "TorsionSpring": "dynamics",
    "Transcendental": "families",
    "TwoSegmentBasis": "systems.rod",
    "WhittakerHill": "hill.cases.named",
    "animate": "kinematics",
    "array_function": "families",
    "assemble": "systems.assembly",
    "balance": "balancing",
    "balance_case": "balancing",
    "base_plane": "kinematics",
    "bloch_bands": "hill.exact.quasi",
    "boundary_derivatives": "hill.exact.derivatives",
    "boundary_latex": "hill.perturbation.formulas",
    "boundary_series": "hill.perturbation.coefficients",
    "boundary_solution": "hill.perturbation.solutions",
    "characteristic_exponents": "hill.exact.quasi",
    "classify": "kinematics",
    "classify_many": "kinematics",
    "clearance_range": "kinematics",
    "cognates": "kinematics",
    "consistent_state": "constrained",
    "constrained_motion": "constrained",
    "coupler_curve": "kinematics",
    "critical_damping": "hill.perturbation.thresholds",
    "discriminant": "hill.half_trace",
    "driving_torque": "dynamics",
    "effective_operator": "hill.perturbation.effective",
    "find_module": "systems.modules",
    "floquet_multipliers": "floquet.monodromy_matrix",
    "flywheel_inertia": "dynamics",
    "free_free_rod": "systems.rod",
    "frozen_frequencies": "response",
    "harmonics": "kinematics",
    "hill_boundaries": "hill.exact.matrix",
    "hill_exponents": "hill.exact.systems",
    "hill_form": "hill.form",
    "krein_signatures": "floquet.krein",
    "kutzbach": "kinematics",
    "least_parameter": "hill.perturbation.thresholds",
    "list_scenes": "scenes",
    "load_scene": "scenes",
    "mathieu_characteristic": "hill.cases.named",
    "mechanical_advantage": "kinematics",
    "meissner_boundaries": "hill.cases.meissner",
    "mobility": "kinematics",
    "monodromy": "floquet.monodromy_matrix",
    "multiplier_surfaces": "hill.cases.strutt",
    "optimal_offset": "balancing",
    "orbit_multipliers": "constrained",
    "overhang_frequencies": "systems.rod",
    "periodic_orbit": "constrained",
    "perturbation_boundaries": "hill.perturbation.boundaries",
    "piecewise_approximation": "hill.cases.piecewise",
    "piecewise_monodromy": "hill.cases.piecewise",
    "pin_forces": "dynamics",
    "reciprocating_balance": "balancing",
    "resonance_curve": "response",
    "resonances": "floquet.tongues.resonances",
    "rigid_forces": "dynamics",
    "rod_motion": "systems.rod",
    "rod_orbit": "systems.rod",
    "rod_system": "systems.rod",
    "run_up": "dynamics",
    "shaking_force": "dynamics",
    "shaking_moment": "dynamics",
    "simpson_harmonics": "kinematics",
    "simulate": "simulation.trajectory",
    "slow_tongues": "floquet",
    "speed_boundaries": "floquet.boundary_speeds",
    "stability_chart": "charts.chart",
    "stability_edges": "floquet.edges.tracing",
    "steady_peaks": "response",
    "steady_state": "response",
    "strutt_chart": "hill.cases.strutt",
    "taylor_in_geometry": "systems",
    "tolerances": "kinematics",
    "tongue": "floquet.tongues.series",
    "tongue_curves": "floquet",
    "torque_fluctuation": "dynamics",
    "trace_tongue": "floquet.edges.over_parameter",
    "trade_off": "balancing",
    "transmission_angle": "kinematics",
    "with_modal_damping": "systems.modal_damping",
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
