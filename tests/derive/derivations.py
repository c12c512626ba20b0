"""Derivations that several tests look at, each made once in a process."""

from functools import cache
from types import ModuleType

from elastolink.derive.catalogue import CATALOGUE
from elastolink.derive.emission import emit
from elastolink.derive.jobs import jobs_of
from elastolink.derive.pipeline import equations_of_motion, lower, only_wanted
from elastolink.derive.spec import ModelSpec

CONTENT = "0" * 32
# One spec for each formulation, with everything in it.
WHOLE = [spec for entry in CATALOGUE for spec in entry.specs]
# Within half a second each.
QUICK = {
    "beam_shapes_cubic",
    "four_bar_coupler_reduced",
    "hill_plain",
    "hill_recursion",
    "quick_return_kinematics",
    "quick_return_multibody",
    "slider_crank_kinematics",
}


@cache
def model_of(spec: ModelSpec):
    """Return the model that derives a spec."""
    (job,) = jobs_of([], [], [spec.canonical()], None)
    return job.model()


@cache
def system_of(spec: ModelSpec):
    model = model_of(spec)
    return model.discretise(spec, equations_of_motion(model.energies(spec)))


@cache
def lowered(spec: ModelSpec, derived: ModelSpec | None = None):
    """Return the intermediate representation of a spec, its system derived for another one."""
    system = only_wanted(spec, system_of(derived or spec))
    return lower(spec, system, model_of(spec).describe(spec))


@cache
def text_of(spec: ModelSpec) -> str:
    return emit(lowered(spec), CONTENT)


def loaded(text: str) -> ModuleType:
    """Return an emitted text as a module."""
    module = ModuleType("emitted")
    exec(compile(text, "emitted", "exec"), module.__dict__)
    return module


@cache
def namespace_of(spec: ModelSpec) -> dict:
    """Return what the emitted text of a spec defines."""
    return vars(loaded(text_of(spec)))
