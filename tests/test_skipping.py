"""Asking for less costs less: emitted modules beside fuller ones, imports, functions called."""

import importlib.util
import itertools
import pickle
from pathlib import Path
from unittest.mock import Mock

import elastolink as el
import elastolink.generated
import numpy as np
import pytest
from elastolink.derive.spec import read_manifest
from elastolink.runtime import recovery
from elastolink.runtime.cli.explanation import read_cost
from elastolink.runtime.rigid import evaluation, forces
from elastolink.runtime.systems import assembly
from fresh_process import python

PACKAGED = Path(elastolink.generated.__path__[0])
SPECS = {entry.module: entry.spec for entry in read_manifest(PACKAGED).values()}
COSTS = {name: read_cost(PACKAGED / f"{name}.py") for name in SPECS}

# Functions that one calls for a part of what another one gives.
PARTS = {
    "forces": ("pin_forces", "driving_torque", "shaking_force", "shaking_moment", "load_forces"),
    "dynamics": ("constraints",),
    "variations": ("constraints",),
    "angle_functions": ("acceleration_functions", "acceleration_forcing_functions"),
}


def test_a_function_of_a_module_costs_less_than_the_module():
    for name, cost in COSTS.items():
        busy = {function: n for function, n in cost.functions.items() if n}
        assert len(busy) < 2 or max(busy.values()) < cost.operations, name
        for whole, parts in PARTS.items():
            for part in parts:
                if whole in cost.functions and part in cost.functions:
                    assert cost.functions[part] < cost.functions[whole], (name, part)


def machine():
    linkage = el.FourBar(frame=0.3, crank=0.1, coupler=0.25, follower=0.2)
    link = el.MassDistribution(mass=0.4, along=0.02, across=0.002, inertia=2e-3)
    return el.Machine(linkage, {"crank": link, "coupler": link, "follower": link})


@pytest.mark.parametrize("acceleration", [0.0, 3.0])
def test_every_set_of_outputs_costs_no_more_than_a_larger_one(monkeypatch, acceleration):
    costs, calls, add = {}, [], evaluation.Evaluation._add

    def noting(self, function, *arguments, **options):
        calls.append((self.kernels.__name__.rpartition(".")[2], function))
        return add(self, function, *arguments, **options)

    monkeypatch.setattr(evaluation.Evaluation, "_add", noting)
    for count in range(1, len(forces.OUTPUTS) + 1):
        for wanted in itertools.combinations(forces.OUTPUTS, count):
            el.rigid_forces(machine(), [0.3, 1.0], 10.0, acceleration, outputs=wanted)
            # One call of an emitted function.
            ((module, function),) = calls
            costs[wanted] = COSTS[module].functions[function]
            calls.clear()
    for wanted, cost in costs.items():
        assert len(wanted) > 1 or cost < costs[forces.OUTPUTS]
        assert all(cost <= costs[other] for other in costs if set(wanted) <= set(other))


RIG = "smith_1972_5152_sixteenth_inch"
FAMILY = "four_bar_coupler_complete"
STABILITY = {"angle_functions"}
FORCED = {"angle_functions", "forcing_functions"}
AXES = {"x": ("speed", [30.0, 40.0]), "y": ("follower_inertia", [1e-3, 2e-3])}
QUESTIONS = {
    "multipliers": (lambda system: el.floquet_multipliers(system, 34.0), STABILITY),
    "chart": (lambda system: el.stability_chart(system, **AXES), STABILITY),
    "steady state": (lambda system: el.steady_state(system, 34.0), FORCED),
    "resonance": (lambda system: el.resonance_curve(system, [30.0, 35.0, 40.0]), FORCED),
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_question_evaluates_the_functions_that_it_needs_alone(question, monkeypatch):
    """Stability takes no forcing; a constant speed, nothing of the crank's acceleration."""
    ask, needed = QUESTIONS[question]
    system = el.load_scene(RIG, {"coupler.damping_ratio": 0.01}).system()
    kernels = {name for name in COSTS[FAMILY].functions if name.endswith("_functions")}
    assert kernels > needed | {"acceleration_functions"}
    called, compute = set(), assembly._AtAngles._computed

    def noting(arrays, name, theta):
        called.add(arrays._functions[name][0].__name__)
        return compute(arrays, name, theta)

    monkeypatch.setattr(assembly._AtAngles, "_computed", noting)
    ask(system)
    assert called == needed


def test_a_term_that_nobody_asks_about_is_never_sampled():
    def refused(theta):
        if len(theta) > 1:
            raise AssertionError("a forcing was evaluated")
        return np.zeros((len(theta), 1))

    system = el.load_scene("mathieu").system()
    system = system.with_terms(el.Term("f", None, refused), el.Term("g", None, refused))
    assert np.all(np.isfinite(el.floquet_multipliers(system, 1.0).multipliers))
    with pytest.raises(AssertionError, match="was evaluated"):
        el.steady_state(system, 1.0)


@pytest.fixture(scope="module")
def steady_four_bar():
    system = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).system()
    return system, el.steady_state(system, 30.0, rtol=1e-3)


RESULTS = {
    "stress": "maximum",
    "recover": "moment",
    "pin_reactions": "torque",
    "beam_energies": "peak",
    "elastic_coupler_curve": "largest",
}


def watched(monkeypatch, module, name):
    """Return what counts the calls of a function of a module."""
    module = importlib.import_module(f"elastolink.runtime.{module}")
    monkeypatch.setattr(module, name, Mock(wraps=getattr(module, name)))
    return getattr(module, name)


@pytest.mark.parametrize("name", RESULTS)
def test_asking_for_the_error_is_what_finds_it(name, steady_four_bar, monkeypatch):
    """A finer mesh takes longer than the motion: none is made for values alone."""
    finer = watched(monkeypatch, "recovery.finer_mesh", "finer_system")
    found = getattr(recovery, name)(*steady_four_bar)
    asked = getattr(found, RESULTS[name])
    assert asked() is not None if callable(asked) else asked is not None
    assert found.passed and not finer.called
    assert np.all(np.asarray(found.error) > 0.0) and found.error_norm
    # What is computed once is kept, and goes with a copy.
    copied = pickle.loads(pickle.dumps(found))
    assert np.array_equal(copied.error, found.error) and finer.call_count == 1


LOADED = """
import sys
import numpy as np
import elastolink as el
{code}
names = (name.removeprefix("elastolink.") for name in sys.modules if name.startswith("elastolink."))
print(*sorted(names))
"""
LINKAGES = {"generated.four_bar_kinematics"}
EVERY_LINKAGE = {f"generated.{n}_kinematics" for n in ("four_bar", "slider_crank", "quick_return")}
# What is done, what it may load of these packages, and packages that it has no use for.
LOADS = {
    "a four-bar moves": (
        "el.FourBar(frame=5.0, crank=1.0, coupler=5.0, follower=2.0).motion(0.3)",
        LINKAGES,
        ("periodic", "stability", "hill", "beams", "scenes"),
    ),
    "multipliers and response of a coupler": (
        f"el.floquet_multipliers(el.load_scene('{RIG}').system(), 34.0); el.simulate",
        LINKAGES | {f"generated.{FAMILY}"},
        (
            *("stability", "hill", "beams", "periodic.lowest_modes"),
            *("recovery", "frequencies", "design", "nonlinear", "systems.inextensible"),
        ),
    ),
    "beams of one kind": (
        "el.load_scene('aannaque_1996_table_4_1').system()",
        # The table of supports knows every linkage.
        EVERY_LINKAGE | {"generated.beam_element_cubic", "generated.beam_shapes_cubic"},
        ("hill", "beams.layered", "recovery", "design", "nonlinear", "systems.inextensible"),
    ),
}


@pytest.mark.parametrize("what", LOADS)
def test_what_is_not_used_is_not_loaded(what):
    code, allowed, unused = LOADS[what]
    loaded = set(python(LOADED.format(code=code)).split())
    own = {name for name in loaded if name.startswith("generated.")}
    assert own <= allowed
    for part in unused:
        assert importlib.util.find_spec(f"elastolink.runtime.{part}"), part
        assert not {name for name in loaded if f"{name}.".startswith(f"runtime.{part}.")}


COMMANDS = """
import contextlib, io, sys
from elastolink.runtime.cli import main
for line in {lines!r}:
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(line.split()) == 0, line
print(*(name.removeprefix("elastolink.") for name in sys.modules))
"""
PLAIN = (
    f"kinematics {RIG}",
    f"stability {RIG} --speed 200rpm",
    f"steady-state {RIG} --speed 200rpm",
    f"simulate {RIG} --speed 200rpm --revolutions 2",
    "stability beale_1992_flexible_rod --speed 200",
    "stress aannaque_1996_table_4_1 --speed 30 --set mesh.elements=1",
)
# For motions beyond the linear range alone; the first page of their room has but the names.
BEYOND = ("runtime.nonlinear.", "runtime.systems.inextensible")


def beyond_the_linear_range(*lines: str) -> list[str]:
    """Return what commands load that is for motions beyond the linear range alone."""
    names = python(COMMANDS.format(lines=lines)).split()
    return [
        name
        for name in names
        if name.startswith(BEYOND) or (name.startswith("generated.") and "inextensible" in name)
    ]


def test_commands_within_the_linear_range_load_nothing_for_motions_beyond_it():
    assert beyond_the_linear_range(*PLAIN) == []
    # Which is not for want of looking.
    found = beyond_the_linear_range(f"response {RIG} --speed 100:101rpm")
    assert {"generated.four_bar_coupler_inextensible", "runtime.nonlinear.response"} <= set(found)


@pytest.mark.parametrize("method", ["auto", "harmonic_balance"])
def test_asking_for_the_stability_of_a_response_is_what_computes_it(method, monkeypatch):
    computed = watched(monkeypatch, "periodic.periodic_motion", "floquet_multipliers")
    system = el.load_scene(RIG, {"coupler.damping_ratio": 0.01}).system()
    motion = el.steady_state(system, [30.0, 40.0], method=method)
    assert motion.passed and np.all(motion.peak() > 0.0) and np.all(motion.error < 1e-6)
    assert not computed.called
    assert motion.stable.shape == motion.distance.shape == (2,)
    assert motion.multipliers.shape == (2, 2) and computed.call_count == 1
