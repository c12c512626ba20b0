"""Every term that a model can drop, and every output that it can do without, cuts what is emitted.

Derived here, so that it holds for what is not packaged, too.
"""

from __future__ import annotations

from functools import cache

import pytest
from elastolink.derive.catalogue import CATALOGUE
from elastolink.derive.emission import emit
from elastolink.derive.entries import ConstrainedSystem, MatrixForm
from elastolink.derive.jobs import jobs_of
from elastolink.derive.models import coupler
from elastolink.derive.perturbation.bloch import Recursion
from elastolink.derive.pipeline import equations_of_motion, lower, only_wanted
from elastolink.derive.separation import StagedSystem
from elastolink.derive.spec import ModelSpec
from elastolink.derive.staged import ClosedForm

# One spec for each formulation, with everything in it and as few modes as there are.
WHOLE = [
    min((s for s in entry.specs if s.formulation == name and not s.drop), key=ModelSpec.name)
    for entry in CATALOGUE
    for name in entry.formulations
]
# Seconds to derive, five and more on a busy core.
LONG = {
    "beam_dynamic_stiffness",
    *(f"beam_element_{kind}" for kind in ("cubic", "curvature", "internal_node", "timoshenko")),
    "four_bar_forces",
    "quick_return_forces",
    "quick_return_overhang_modes",
}


@cache
def model_of(spec):
    (job,) = jobs_of([], [], [spec.canonical()], None)
    return job.model()


@cache
def system_of(spec):
    model = model_of(spec)
    return model.discretise(spec, equations_of_motion(model.energies(spec)))


@cache
def emitted(spec, derived=None):
    """Return the intermediate representation of a spec, its system derived for another one."""
    system = only_wanted(spec, system_of(derived or spec))
    return lower(spec, system, model_of(spec).describe(spec))


def cost(module):
    """Return operations and bytes."""
    return sum(k.operations for k in module.kernels), len(emit(module, "0" * 32).encode())


def marked(specs):
    return [
        pytest.param(s, marks=pytest.mark.slow if s.name() in LONG else (), id=s.name())
        for s in specs
    ]


def outputs_of(system):
    """Return what a system can be asked for, and what it cannot do without."""
    if isinstance(system, StagedSystem):
        forced = any(name in system.system.arrays for name in "fghp")
        return ("stability",) if forced else ()
    if isinstance(system, ConstrainedSystem):
        return ("motion",) if system.variations is not None else ()
    if isinstance(system, ClosedForm):
        return tuple(name for name, _ in system.outputs)
    if isinstance(system, MatrixForm):
        return tuple(name for name, _ in system.arrays)
    if isinstance(system, Recursion):
        return tuple(f"order_{order}" for order in system.orders)
    return tuple(kernel.name for kernel in system.kernels)


@pytest.mark.parametrize("spec", marked(WHOLE))
def test_each_output_alone_costs_less_than_all(spec):
    system = system_of(spec)
    names = outputs_of(system)
    operations, size = cost(emitted(spec))
    for name in (
        names if len(names) > 1 or isinstance(system, (StagedSystem, ConstrainedSystem)) else ()
    ):
        fewer, shorter = cost(emitted(spec.with_(outputs=(name,)), spec))
        assert fewer < operations, name
        assert shorter < size, name


@pytest.mark.parametrize("spec", marked(WHOLE))
def test_an_unknown_output_is_refused(spec):
    with pytest.raises(ValueError, match=r"unknown outputs|outputs: found"):
        only_wanted(spec.with_(outputs=("colour",)), system_of(spec))


DROPS = [
    (spec, term)
    for entry in CATALOGUE
    for spec in WHOLE
    if spec in entry.specs
    for term in entry.choices.drop
    if term != "drive"  # a constraint that a force takes the place of
]


@pytest.mark.parametrize(
    ("spec", "term"),
    [
        pytest.param(
            spec,
            term,
            marks=pytest.mark.slow if spec.name() in LONG else (),
            id=f"{spec.name()}-{term}",
        )
        for spec, term in DROPS
    ],
)
def test_each_term_dropped_costs_less(spec, term):
    operations, size = cost(emitted(spec))
    fewer, shorter = cost(emitted(spec.with_(drop=(term,))))
    if term in coupler.DROPPED.get(spec.formulation, ()):
        assert fewer == operations  # left out already
        return
    if (spec.formulation, term) == ("complete", "spin"):
        # The axial inertia has its functions of angle and of the modes: it is one number in them.
        assert fewer == operations
        rows = [emitted(s).terms for s in (spec, spec.with_(drop=(term,)))]
        assert rows[0] == rows[1]
        return
    if spec.formulation == "moving_basis":
        # Each is the whole tension less the other; the two together cost less.
        both, short = cost(emitted(spec.with_(drop=("frame", "tension"))))
        assert both < operations < fewer and short < size
        return
    assert fewer < operations
    assert shorter < size


@pytest.mark.parametrize("formulation", ["complete", "printed"])
def test_a_balanced_coupler_costs_less(formulation):
    spec = ModelSpec("four_bar", formulation, flexible=("coupler",))
    operations, size = cost(emitted(spec))
    fewer, shorter = cost(emitted(spec.with_(balanced=("coupler",))))
    assert fewer < operations and shorter < size
    names = [name for kernel in emitted(spec).kernels for name in _returned(kernel)]
    balanced = emitted(spec.with_(balanced=("coupler",)))
    left = [name for kernel in balanced.kernels for name in _returned(kernel)]
    assert any("first_moment" in name for name in names)
    assert not any("first_moment" in name for name in left)


def _returned(kernel):
    return [result.name for result in kernel.results]


def test_every_model_and_every_term_is_looked_at():
    assert {(s.mechanism, s.formulation) for s in WHOLE} == {
        (entry.mechanism, name) for entry in CATALOGUE for name in entry.formulations
    }
    offered = {(e.mechanism, term) for e in CATALOGUE for term in e.choices.drop}
    assert {(spec.mechanism, term) for spec, term in DROPS} == {
        pair for pair in offered if pair[1] != "drive"
    }
