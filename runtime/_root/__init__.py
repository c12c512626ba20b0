"""Dynamics of elastic linkages: derive the equations, emit them as NumPy, solve and check.

The names below load on first use, so that importing the package costs next to nothing.  Those with
a subject before them are taken from it: ``el.design.certify``.  ``dir(el.design)`` lists a subject.

beams
    Planar linkages and frames of beams: elements, sections, structures and their equations.
    Beam, Node, Section, Structure, frame, linkage_system, beams.ElasticLayer,
    beams.ViscoelasticLayer, beams.beam_linkage, beams.linear_system, beams.sandwich_section,
    beams.without_stretching
constrained
    Constrained systems: consistent initial values, motion on the constraints, its stability.
    consistent_state, constrained_motion, orbit_multipliers, periodic_orbit
design
    Diagnosis, margins, changes that help, running speeds, run-ups, fatigue, tolerances, fits.
    Material, SpeedProfile, fatigue, quiet_speeds, run_through, running_speed, design.Point,
    design.certify, design.closing_damping, design.diagnose, design.identify, design.margins,
    design.read_points, design.sensitivities, design.stabilise, design.tolerance_bands
frequencies
    Natural frequencies, critical speeds and resonance curves, of finite elements and exact members.
    campbell, critical_speeds, dynamic_stiffness, natural_frequencies, resonance_curve,
    wittrick_williams, frequencies.buckling_speed, frequencies.draw_modes,
    frequencies.link_frequencies
hill
    Hill's equation ``y'' + 2 K y' + (lam2 + mu f(theta)) y = 0``, f of period 2 pi.
    Mathieu, Meissner, boundary_series, boundary_solution, characteristic_exponents,
    critical_damping, discriminant, hill_boundaries, hill_form, perturbation_boundaries
linkages
    Rigid linkages: mechanisms and their motion, classes, curves, clearance.
    FourBar, QuickReturn, SliderCrank, animate, classify, clearance_range, coupler_curve, harmonics,
    mobility, transmission_angle
nonlinear
    Nonlinear systems under a periodic drive: periodic motions over a parameter, sweeps, jumps.
    response_curve, sweep_response, nonlinear.amplitude_law, nonlinear.basins,
    nonlinear.coexisting_motions, nonlinear.special_curve
periodic
    Linear periodic systems: the transition matrices of a revolution, and what follows from them.
    floquet_multipliers, monodromy, prepare, simulate, steady_state, periodic.Prepared,
    periodic.cycles_to_settle, periodic.reduced_system
recovery
    What beams have to bear: forces, stresses, pin reactions and energies from a computed motion.
    pin_reactions, recover, stress, stress_curve, recovery.beam_energies,
    recovery.elastic_coupler_curve
report
    A report of a scene: one page that holds all that is known of the machine, and how well.
    report.make_report
rigid
    Rigid machines: masses, loads, pin forces, flywheels, run-up, balancing.
    Bounds, Load, Machine, MassDistribution, Spring, TorqueLine, TorsionSpring, balance,
    driving_torque, flywheel_inertia, pin_forces, rigid_forces, run_up, shaking_force,
    shaking_moment, trade_off
scenes
    Scenes: the numbers of a machine as a TOML file, checked whole and handed over in SI units.
    list_scenes, load_scene
stability
    Where linear periodic systems are unstable.
    speed_boundaries, stability_chart, stability_edges, stability.resonances, stability.tongue,
    stability.tongue_curves
sweeps
    Sweeps at scale: pieces on any executor, resumed after a kill, estimated beforehand.
    process_pool, sweep, sweeps.estimate_sweep
systems
    From emitted modules and numbers to the systems that the solvers take.
    assemble, with_modal_damping, systems.find_module, systems.free_free_rod, systems.rod_system
all subjects
    What all share: families of systems, results, errors.
    BadInput, Constrained, ElastolinkError, LinearPeriodic, LinearRangeWarning, Nonlinear,
    PeriodicFunction, Term, explain, load
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, cast

__version__ = "0.2.0"

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
    "trade_off": "rigid",
    "transmission_angle": "linkages",
    "with_modal_damping": "systems",
    "wittrick_williams": "frequencies",
}

__all__ = ["__version__", *sorted(_PUBLIC)]
_SUBJECTS = {"report", *(module for module in _PUBLIC.values() if "." not in module)}


def __getattr__(name: str) -> Any:
    """Load a public name from its module, or a subject, on first use."""
    if name in _PUBLIC:
        value = getattr(import_module(f"elastolink.runtime.{_PUBLIC[name]}"), name)
    elif name in _SUBJECTS:
        value = import_module(f"elastolink.runtime.{name}")
    else:
        raise _unknown_name(name)
    globals()[name] = value
    return value


def _unknown_name(name: str) -> AttributeError:
    """Return an error that names what is near, of the names of subjects, too."""
    from importlib.util import find_spec

    if name.startswith("_") or (name.isidentifier() and find_spec(f"{__name__}.{name}")):
        return AttributeError(f"module {__name__!r} has no attribute {name!r}", name=name)
    names = [*_PUBLIC, *sorted(_SUBJECTS)]
    for subject in sorted(_SUBJECTS):
        public = import_module(f"elastolink.runtime.{subject}").__all__
        names += [f"{subject}.{one}" for one in public if one not in _PUBLIC]
    lazy = import_module("elastolink.runtime.core.lazy")
    return cast(AttributeError, lazy.unknown_name(__name__, name, names))


def __dir__() -> list[str]:
    """List the public names and the subjects, loaded or not."""
    return sorted([*__all__, *_SUBJECTS])
