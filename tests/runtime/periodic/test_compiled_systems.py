"""Systems with compiled functions: every solver takes them, and the answers are the same."""

from __future__ import annotations

import inspect
import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import elastolink as el
import elastolink.generated
import numpy as np
import pytest
from compiled_loops import NEEDS_NUMBA, emitted
from elastolink.runtime.compiled import (
    CompiledFunction,
    compiled,
    compiled_function,
    compiled_module,
)
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import MATRICES, VECTORS
from elastolink.runtime.systems import with_modal_damping

pytestmark = [
    pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning"),
    pytest.mark.usefixtures("loop_cache"),
    NEEDS_NUMBA,
]

SCENE = "smith_1972_5152_sixteenth_inch"


AGAIN = """
import pickle, sys
import numpy as np
from elastolink.runtime.compiled import store
system = pickle.load(open(sys.argv[1], "rb"))
found = [system.array(name, np.linspace(0.0, 6.0, 7)).ravel() for name in "MBSfg"]
print(store.compilations(), len(store._MADE), np.concatenate(found).tobytes().hex())
"""


@pytest.fixture(scope="module")
def pair():
    system = el.load_scene(SCENE, overrides={"model.formulation": "reduced"}).system()
    return system, compiled(system)


def test_another_process_loads_what_was_compiled(pair, tmp_path) -> None:
    """A pickled system arrives compiled, nothing is compiled again, and the bytes are the same."""
    _, fast = pair
    theta = np.linspace(0.0, 6.0, 7)
    wanted = np.concatenate([fast.array(name, theta).ravel() for name in "MBSfg"])
    (tmp_path / "system").write_bytes(pickle.dumps(fast))
    command = [sys.executable, "-c", AGAIN, str(tmp_path / "system")]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    compilations, loops, found = done.stdout.split()
    assert (compilations, int(loops) >= 4) == ("0", True)
    assert found == wanted.tobytes().hex()


def test_a_compiled_system_is_the_same_system(pair) -> None:
    """Arrays, multipliers, motions and steady states; only the provenance tells."""
    plain, fast = pair
    theta = np.linspace(0.0, 6.2, 40)
    for name in (*MATRICES, *VECTORS):
        one, other = plain.array(name, theta), fast.array(name, theta)
        assert np.max(np.abs(one - other)) <= 1e-13 * np.max(np.abs(one)), name
    one, other = el.monodromy(plain, 60.0), el.monodromy(fast, 60.0)
    assert np.max(np.abs(one.matrix - other.matrix)) <= 1e-13 * np.max(np.abs(one.matrix))
    one, other = el.steady_state(plain, 60.0), el.steady_state(fast, 60.0)
    assert np.max(np.abs(one.q - other.q)) <= 1e-12 * np.max(np.abs(one.q))
    np.testing.assert_allclose(other.multipliers, one.multipliers, rtol=1e-12)
    one, other = el.simulate(plain, 60.0, 2), el.simulate(fast, 60.0, 2)
    assert np.max(np.abs(one.q - other.q)) <= 1e-12 * np.max(np.abs(one.q))
    told = dict(fast.provenance)
    assert told.pop("functions").startswith("compiled by numba ")
    assert told == plain.provenance
    assert compiled(fast).provenance == fast.provenance


def test_a_chart_of_a_compiled_system_is_the_same(pair) -> None:
    charts = [
        el.stability_chart(
            system,
            x=("speed", np.linspace(40.0, 90.0, 6)),
            y=("follower_inertia", np.linspace(1e-3, 4e-3, 5)),
        )
        for system in pair
    ]
    assert np.array_equal(charts[0].stable, charts[1].stable)


@pytest.mark.slow
def test_processes_of_a_pool_take_compiled_systems(pair) -> None:
    """Started anew, they load the loops; the chart is that of one process."""
    _, fast = pair
    axes = {
        "x": ("speed", np.linspace(40.0, 90.0, 6)),
        "y": ("follower_inertia", np.linspace(1e-3, 4e-3, 5)),
    }
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        shared = el.stability_chart(fast, **axes, executor=pool)
    alone = el.stability_chart(fast, **axes)
    assert np.array_equal(shared.stable, alone.stable)
    assert np.array_equal(shared.largest, alone.largest)


def test_changed_systems_stay_compiled(pair) -> None:
    """Other parameters, modal damping, another geometry."""
    plain, fast = pair
    theta = np.array([0.3, 2.0, 4.4])
    changes = {"follower_inertia": 2e-3}
    for change in (lambda s: s.with_parameters(**changes), lambda s: with_modal_damping(s, 0.02)):
        one, other = change(plain), change(fast)
        assert "functions" in other.provenance
        for name in "CKBf":
            np.testing.assert_allclose(other.array(name, theta), one.array(name, theta), rtol=1e-12)
    damped = compiled(with_modal_damping(plain, 0.02))
    np.testing.assert_allclose(
        damped.array("C", theta), with_modal_damping(plain, 0.02).array("C", theta), rtol=1e-12
    )


def _holders(system) -> dict[int, list]:
    """Return what holds emitted functions among the parts of a system's terms, and these."""
    found = {}

    def look(value: object) -> None:
        own = [getattr(value, name, None) for name in ("_function", "_place", "_multiply")]
        functions = [function for function in own if hasattr(function, "__name__")]
        if functions:
            found[id(value)] = functions
        for part in (*getattr(value, "args", ()), getattr(value, "func", None)):
            if part is not None:
                look(part)

    for term in system.terms:
        look(term.function)
    return found


def test_a_rod_of_another_geometry_stays_compiled() -> None:
    """Its place of the block, too, which its basis asks for."""
    plain = el.load_scene("beale_1992_flexible_rod", overrides={"model.modes": 2}).system()
    fast = compiled(plain)
    names = {"angle_functions", "forcing_functions", "acceleration_forcing_functions", "place"}
    theta = np.array([0.3, 2.0, 4.4])
    for one, other in ((plain, fast), (s.with_geometry(crank_ratio=0.2) for s in (plain, fast))):
        holders = _holders(other)
        calls = [call for own in holders.values() for call in own if call is not tuple]
        assert {call.__name__ for call in calls} == names
        assert all(isinstance(call, CompiledFunction) for call in calls)
        # Terms that shared values go on sharing them.
        assert len(holders) == len(_holders(one))
        for name in "MABKf":
            wanted = one.array(name, theta)
            gap = np.abs(other.array(name, theta) - wanted)
            assert np.max(gap) <= 1e-13 * np.max(np.abs(wanted)), name
    assert not any(isinstance(c, CompiledFunction) for own in _holders(plain).values() for c in own)


def test_constraints_are_compiled() -> None:
    """The rod in Buckens' frame: one state and many."""
    overrides = {"model.formulation": "free_free", "model.modes": 1}
    plain = el.load_scene("beale_1992_flexible_rod", overrides=overrides).system()
    fast = compiled(plain)
    assert type(fast) is type(plain)
    assert fast.provenance["functions"].startswith("compiled by numba ")

    for theta in (0.4, np.linspace(0.0, 6.0, 9)):
        q, qd = plain.undeformed(theta / plain.speed)
        qd = qd + 1e-3
        at = np.asarray(theta) / plain.speed
        one, other = plain.dynamics(q, qd, at), fast.dynamics(q, qd, at)
        assert set(one) == set(other)
        for name, wanted in one.items():
            gap = np.max(np.abs(other[name] - wanted))
            assert gap <= 1e-13 * max(np.max(np.abs(wanted)), 1.0), name
        for one, other in zip(
            plain.accelerations(q, qd, at), fast.accelerations(q, qd, at), strict=True
        ):
            assert np.max(np.abs(one - other)) <= 1e-12 * np.max(np.abs(one))


@pytest.mark.slow
def test_a_constrained_motion_is_the_same() -> None:
    from elastolink.runtime.constrained import constrained_motion

    overrides = {"model.formulation": "free_free", "model.modes": 2}
    plain = el.load_scene("beale_1992_flexible_rod", overrides=overrides).system()
    span = 0.25 * plain.period
    one, other = (constrained_motion(rod, span=span) for rod in (plain, compiled(plain)))
    assert np.max(np.abs(one.q - other.q)) <= 1e-11 * np.max(np.abs(one.q))


def test_a_module_can_be_assembled_compiled() -> None:
    """A view of an emitted module, for systems of one's own."""
    module = emitted("four_bar_coupler_reduced")
    view = compiled_module(module)
    assert compiled_module(view) is view
    assert view.FAMILY == module.FAMILY
    assert pickle.loads(pickle.dumps(view)) is view
    assert view.angle_functions is compiled_function(module.angle_functions)
    with pytest.raises(AttributeError):
        _ = view.nothing
    element = emitted("beam_element_cubic")
    names = inspect.signature(element.element).parameters
    numbers = dict(zip(names, np.linspace(0.5, 2.0, len(names)), strict=True))
    wanted = el.array_function(element, "element")(**numbers)
    found = el.array_function(compiled_module(element), "element")(**numbers)
    for name, array in wanted.items():
        np.testing.assert_allclose(found[name], array, rtol=1e-13)


@pytest.mark.parametrize("scene", ["mathieu", "aannaque_1996_table_4_1"])
def test_a_system_without_emitted_functions_is_refused(scene) -> None:
    with pytest.raises(BadInput, match="no emitted function in its terms"):
        compiled(el.load_scene(scene).system())


def test_what_is_no_system_is_refused() -> None:
    with pytest.raises(BadInput, match="expected a LinearPeriodic or Constrained system"):
        compiled(el.FourBar(4.0, 1.0, 3.0, 3.0))
