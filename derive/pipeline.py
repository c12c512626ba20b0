"""The pipeline, stage by stage: from a model specification to the text of a module.

    ModelSpec -> energies -> equations of motion -> discrete system -> ModuleSpec -> text

Each stage hands over one frozen record; a stage that a family does not need passes it on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from .arrays import VECTORS, DiscreteSystem
from .bloch import Recursion, lower_recursion
from .emission import emit
from .entries import (
    ConstrainedSystem,
    MatrixForm,
    TranscendentalSystem,
    lower_constrained,
    lower_matrices,
    lower_transcendental,
)
from .ir import Description, ModuleSpec
from .lagrange import euler_lagrange
from .lowering import lower_closed_form, lower_kernel_forms
from .records import ActionDensity, EquationsOfMotion, FieldEquations, Lagrangian
from .separation import StagedSystem, lower_linear_periodic
from .spec import Choices, ModelSpec
from .staged import ClosedForm, KernelForms
from .variational import hamilton

Energies = ActionDensity | Lagrangian | MatrixForm | ClosedForm | KernelForms | Recursion
Equations = FieldEquations | EquationsOfMotion | MatrixForm | ClosedForm | KernelForms | Recursion
System = (
    StagedSystem
    | ConstrainedSystem
    | TranscendentalSystem
    | MatrixForm
    | ClosedForm
    | KernelForms
    | Recursion
)

_WANTED: dict[type, tuple[str, ...]] = {
    StagedSystem: ("forcing", "stability"),
    ConstrainedSystem: ("motion", "variations"),
}


def _as_it_is(spec: ModelSpec, equations: Any) -> System:
    """Return what needs no discretisation: closed forms, and equations of a discrete system."""
    if isinstance(equations, EquationsOfMotion):
        return ConstrainedSystem(equations)
    if isinstance(equations, FieldEquations):
        raise TypeError("a continuum has to be discretised: give the model a discretise function")
    system: System = equations
    return system


@dataclass(frozen=True)
class Model:
    """One mechanism in one or more formulations: what a person writes to add it.

    Attributes
    ----------
    mechanism : str
        Name that specs and scenes use.
    formulations : tuple of str
        Named sets of assumptions.
    energies : callable
        ModelSpec to energies, virtual work and constraints (or to a closed form).
    describe : callable
        ModelSpec to the words of the module: title, arguments, units, equations.
    discretise : callable
        ModelSpec and equations of motion to the discrete system.  By default the equations of a
        discrete system are taken as constrained ones, and closed forms as they are.
    closed_in_modes : bool
        True where one module serves any number of modes.
    choices : Choices
        Names that specs may use for links that bend, terms left out, links that are balanced.
    """

    mechanism: str
    formulations: tuple[str, ...]
    energies: Callable[[ModelSpec], Energies]
    describe: Callable[[ModelSpec], Description]
    discretise: Callable[[ModelSpec, Any], System] = _as_it_is
    closed_in_modes: bool = False
    choices: Choices = field(default_factory=Choices)


def module_text(spec: ModelSpec, model: Model, content: str) -> str:
    """Derive, lower and emit one module: the whole pipeline.

    ``spec``: what is wanted; ``model``: how its energies are written down; ``content``: content
    hash for the header.
    """
    energies = model.energies(spec)
    equations = equations_of_motion(energies)
    system = only_wanted(spec, model.discretise(spec, equations))
    module = lower(spec, system, model.describe(spec))
    return emit(module, content)


def equations_of_motion(energies: Energies) -> Equations:
    """Apply Hamilton's principle to a continuum, Euler and Lagrange's to a discrete system."""
    if isinstance(energies, ActionDensity):
        return hamilton(energies)
    if isinstance(energies, Lagrangian):
        return euler_lagrange(energies)
    return energies


def only_wanted(spec: ModelSpec, system: System) -> System:
    """Drop what the spec does not ask for: the forcing of a stability-only module, idle outputs.

    Raises ``ValueError`` if the spec asks for something that does not exist.
    """
    if not spec.outputs:
        return system
    if isinstance(system, ClosedForm | MatrixForm | KernelForms | Recursion):
        return system.only(spec.outputs)
    known = _WANTED.get(type(system), ())
    unknown = sorted(set(spec.outputs) - set(known))
    if unknown:
        raise ValueError(f"outputs: found {unknown}; expected some of {list(known)}")
    if isinstance(system, ConstrainedSystem) and "variations" not in spec.outputs:
        return replace(system, variations=None)
    if not isinstance(system, StagedSystem) or "forcing" in spec.outputs:
        return system
    dropped = {terms: _unforced(left) for terms, left in system.dropped.items()}
    return replace(system, system=_unforced(system.system), dropped=dropped)


def _unforced(system: DiscreteSystem) -> DiscreteSystem:
    arrays = {name: entry for name, entry in system.arrays.items() if name not in VECTORS}
    return system.with_(arrays=arrays)


def lower(spec: ModelSpec, system: System, description: Description) -> ModuleSpec:
    """Separate, stage and print a system; no SymPy object is left in the result."""
    if isinstance(system, StagedSystem):
        return lower_linear_periodic(spec, system, description)
    if isinstance(system, ConstrainedSystem):
        return lower_constrained(spec, system, description)
    if isinstance(system, TranscendentalSystem):
        return lower_transcendental(spec, system, description)
    if isinstance(system, MatrixForm):
        return lower_matrices(spec, system, description)
    if isinstance(system, KernelForms):
        return lower_kernel_forms(spec, system, description)
    if isinstance(system, Recursion):
        return lower_recursion(spec, system, description)
    return lower_closed_form(spec, system, description)
