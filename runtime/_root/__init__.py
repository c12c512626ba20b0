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

_NAMES = {
    "beams": "Beam Node Section Structure frame linkage_system",
    "cli.explanation": "explain",
    "constrained": "consistent_state constrained_motion orbit_multipliers periodic_orbit",
    "core.errors": "BadInput ElastolinkError LinearRangeWarning",
    "core.families": "Constrained LinearPeriodic Nonlinear Term",
    "core.periodic_function": "PeriodicFunction",
    "core.results": "load",
    "design": "Material SpeedProfile fatigue quiet_speeds run_through running_speed",
    "frequencies": (
        "campbell critical_speeds dynamic_stiffness natural_frequencies resonance_curve "
        "wittrick_williams"
    ),
    "hill": (
        "Mathieu Meissner boundary_series boundary_solution characteristic_exponents "
        "critical_damping discriminant hill_boundaries hill_form perturbation_boundaries"
    ),
    "linkages": (
        "FourBar QuickReturn SliderCrank animate classify clearance_range coupler_curve harmonics "
        "mobility transmission_angle"
    ),
    "nonlinear": "response_curve sweep_response",
    "periodic": "floquet_multipliers monodromy prepare simulate steady_state",
    "recovery": "pin_reactions recover stress stress_curve",
    "rigid": (
        "Bounds Load Machine MassDistribution Spring TorqueLine TorsionSpring balance "
        "driving_torque flywheel_inertia pin_forces rigid_forces run_up shaking_force "
        "shaking_moment trade_off"
    ),
    "scenes": "list_scenes load_scene",
    "stability": "speed_boundaries stability_chart stability_edges",
    "sweeps": "process_pool sweep",
    "systems": "assemble with_modal_damping",
}
_PUBLIC = dict(sorted((name, module) for module, names in _NAMES.items() for name in names.split()))

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
