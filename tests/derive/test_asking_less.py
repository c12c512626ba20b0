"""Every term that a model can drop, and every output that it can do without, costs nothing.

Derived here, so that it holds for what is not packaged, too.
"""

import itertools

import numpy as np
import pytest
from derivations import CONTENT, QUICK, WHOLE, lowered, namespace_of, system_of
from elastolink.derive.bloch import Recursion
from elastolink.derive.catalogue import CATALOGUE, find
from elastolink.derive.emission import emit
from elastolink.derive.entries import ConstrainedSystem, MatrixForm
from elastolink.derive.models import coupler
from elastolink.derive.pipeline import only_wanted
from elastolink.derive.separation import StagedSystem
from elastolink.derive.staged import ClosedForm

QUICK_TERM = ("four_bar_coupler_reduced", "follower_end_load")
COUPLER = [s for s in WHOLE if s.formulation in coupler.MODEL.formulations]


def cost(module):
    """Return operations and bytes."""
    return module.operations, len(emit(module, CONTENT).encode())


def case(spec, *more, quick):
    """Return a case named after what it holds, of the first stage where it is quick."""
    words = [spec.name(), *(item if isinstance(item, str) else "-".join(item) for item in more)]
    return pytest.param(spec, *more, marks=() if quick else pytest.mark.slow, id="-".join(words))


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


@pytest.mark.parametrize("spec", [case(s, quick=s.name() in QUICK) for s in WHOLE])
def test_each_output_alone_costs_less_than_all(spec):
    system = system_of(spec)
    names = outputs_of(system)
    operations, size = cost(lowered(spec))
    if len(names) > 1 or isinstance(system, (StagedSystem, ConstrainedSystem)):
        for name in names:
            fewer, shorter = cost(lowered(spec.with_(outputs=(name,)), spec))
            assert fewer < operations, name
            assert shorter < size, name
    with pytest.raises(ValueError, match=r"unknown outputs|outputs: found"):
        only_wanted(spec.with_(outputs=("colour",)), system)


# What general modules can leave out themselves; the others are derived without it.
DROPPED = [
    (spec, terms)
    for spec in WHOLE
    for entry in CATALOGUE
    if spec in entry.specs and spec.formulation not in coupler.MODEL.formulations
    for count in range(1, 3)
    for terms in itertools.combinations(sorted(entry.choices.drop), count)
]


@pytest.mark.parametrize(
    ("spec", "terms"), [case(spec, terms, quick=spec.name() in QUICK) for spec, terms in DROPPED]
)
def test_a_general_module_leaves_out_what_the_derivation_does(spec, terms):
    """The same numbers as the module that is derived without the terms."""
    general, special = namespace_of(spec), namespace_of(spec.with_(drop=terms))
    assert "DROPS" not in special
    gone = general["DROPS"][tuple(sorted(terms))]
    numbers = Numbers()
    if general["FAMILY"] == "linear_periodic":
        kept = [row for row in general["TERMS"] if row not in gone[0]]
        found = separated(general, [*kept, *gone[1]], numbers)
        wanted = separated(special, special["TERMS"], numbers)
        assert found.keys() == wanted.keys()
        for role, value in wanted.items():
            assert found[role] == pytest.approx(value, rel=1e-13), role
        return
    for name in special["RETURNS"]:
        found, wanted = (returned(space, name, numbers, gone) for space in (general, special))
        assert found.keys() >= wanted.keys()
        for key, value in wanted.items():
            assert np.asarray(found[key]) == pytest.approx(
                np.asarray(value), rel=1e-11, abs=1e-13
            ), (name, key)


class Numbers(dict):
    """A number of its own for every name, the same each time."""

    def __missing__(self, name):
        self[name] = 0.3 + 0.61803398875 * (sum(map(ord, name)) % 17)
        return self[name]


GEOMETRY = {"frame": 4.0, "crank": 1.3, "coupler": 4.1, "follower": 3.0, "length": 7.0}
GEOMETRY |= {"offset": 0.4, "assembly": 1.0}


def arguments(function, numbers, gone=()):
    """Return an argument of an emitted function by name: zero where it is gone."""
    names = function.__code__.co_varnames[: function.__code__.co_argcount]
    return {n: 0.0 if n in gone else GEOMETRY.get(n, numbers[n]) for n in names}


def separated(space, rows, numbers):
    """Return the value of each separated term, summed by array and integral."""
    values = {None: 1.0}
    for kernel, names in space["RETURNS"].items():
        if kernel != "basis_products":
            made = space[kernel](**arguments(space[kernel], numbers))
            values |= dict(zip(names, made if isinstance(made, tuple) else (made,), strict=True))
    total: dict = {}
    for array, _, scale, angle, modal in rows:
        total[array, modal] = total.get((array, modal), 0.0) + values[scale] * values[angle]
    return total


def returned(space, name, numbers, gone):
    """Return what a function returns by name, of arrays by place, without released constraints."""
    function = space[name]
    given = arguments(function, numbers, gone)
    if "torque" in given:  # the drive's load is a load on the crank
        given["torque"] = 0.0
    if "MODES" in space:
        amplitude, modal = space["MODES"]
        vectors = {amplitude, f"{amplitude}_dot", f"{amplitude}_ddot", *space["EXTERNAL"]}
        for item in given.keys() & (vectors | {"left", "stiffness"}):
            given[item] = [given[item], 0.7]
        for item in given.keys() & {"inward", "retreat"}:
            same = given[item]
            given[item] = [[same, 0.5 * same], [0.5 * same, 2.0 * same]]
        assert set(modal) == {"left", "stiffness", "inward", "retreat"}
    values = function(**given)
    if "ARRAYS" not in space:
        values = values if isinstance(values, tuple) else (values,)
        return dict(zip(space["RETURNS"][name], values, strict=True))
    held = [i for i, item in enumerate(space["MULTIPLIERS"]) if item not in gone]
    found = {}
    for array, (shape, filled) in space["ARRAYS"][name].items():
        of_rows = shape[0] == len(space["MULTIPLIERS"]) and array not in ("rest", "forces", "mass")
        for i, j, at, *kind in filled:
            if not of_rows or i in held:
                found[array, i, j, *kind] = values[at]
    return {key: value for key, value in found.items() if np.any(np.asarray(value) != 0)}


@pytest.mark.parametrize(
    ("spec", "term"),
    [
        case(spec, term, quick=(spec.name(), term) == QUICK_TERM)
        for spec in COUPLER
        for term in find(spec).choices.drop
    ],
)
def test_each_term_of_the_coupler_dropped_costs_less(spec, term):
    operations, size = cost(lowered(spec))
    fewer, shorter = cost(lowered(spec.with_(drop=(term,))))
    if term in coupler.DROPPED.get(spec.formulation, ()):
        assert fewer == operations  # left out already
    elif (spec.formulation, term) == ("complete", "spin"):
        # The axial inertia has its functions of angle and of the modes: it is one number in them.
        assert fewer == operations
        tables = [
            {t.name: t.value for t in lowered(s).tables} for s in (spec, spec.with_(drop=(term,)))
        ]
        assert tables[0] == tables[1]
    else:
        assert fewer < operations and shorter < size


def test_every_model_is_looked_at():
    assert {(s.mechanism, s.formulation) for s in WHOLE} == {
        (entry.mechanism, name) for entry in CATALOGUE for name in entry.formulations
    }
    assert {s.name() for s in WHOLE} >= QUICK
