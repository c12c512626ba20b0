"""Systems prepared for a range of speeds: against the solvers that start anew each time."""

import pickle
from dataclasses import replace

import elastolink as el
import numpy as np
import pytest
from edge_truth import scene_rod
from elastolink.runtime.core.errors import BadInput
from periodic_systems import forced_mathieu, system_of, wave

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.LinearRangeWarning")

SCENE = "smith_1972_5152_sixteenth_inch"


@pytest.fixture(scope="module", params=[1, 2, 3, "rod", "beams"])
def pair(request):
    """A system and its prepared form, 50 to 200 rad/s (the rod 500 to 2000, beams 20 to 30)."""
    if request.param == "rod":
        system, span = scene_rod(modes=3, **{"model.formulation": "polynomial"}), (500.0, 2000.0)
    elif request.param == "beams":
        # Modes that no segment resolves; a force that is large in the units of the state.
        overrides = {"mesh.elements": 1}
        system = el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()
        span = (20.0, 30.0)
    else:
        system = el.load_scene(SCENE, overrides={"model.modes": request.param}).system()
        span = (50.0, 200.0)
    return system, el.prepare(system, span, samples=16)


def _speeds(ready: el.periodic.Prepared, count: int) -> np.ndarray:
    # By the golden section: neither nodes nor ends of tables.
    low, high = ready.span
    return low + (high - low) * (np.arange(1, count + 1) * 0.6180339887 % 1.0)


def test_monodromy_matrices_are_within_their_figure(pair) -> None:
    """Of two tables, against Gauss-Legendre collocation of order 16 asked for 1e-13."""
    system, ready = pair
    speeds = _speeds(ready, 25)
    found, exact = ready.monodromy(speeds), el.monodromy(system, speeds, rtol=1e-13)
    truth = exact.matrix / found.scale[..., :, None] * found.scale[..., None, :]
    size = np.max(np.abs(truth), axis=(1, 2))
    gap = np.max(np.abs(found.scaled - truth), axis=(1, 2)) / size
    assert np.all(gap <= found.error + exact.error)
    assert np.all(found.error <= (1e-10 if system.size < 4 else 5e-10))
    assert found.passed


def test_steady_states_are_within_their_error(pair) -> None:
    """Against shooting, which closes a ring of segments; stability by its multipliers."""
    system, ready = pair
    speeds = _speeds(ready, 12)
    found = ready.steady_state(speeds)
    for k, speed in enumerate(speeds):
        other = el.steady_state(system, speed, samples=16, rtol=1e-10)
        step = len(other.theta) // 16
        peak = np.max(np.abs(other.q), axis=0)
        gap = np.max(np.abs(found.q[k] - other.q[::step]), axis=0) / peak
        assert np.all(gap <= found.error[k] + other.error)
        slope = np.max(np.abs(other.qd), axis=0)
        assert np.all(np.abs(found.qd[k] - other.qd[::step]) <= 1e-7 * slope)
        if abs(other.distance) > 1e-6 and np.max(np.abs(np.abs(other.multipliers) - 1)) > 1e-9:
            assert bool(found.stable[k]) == bool(other.stable)


def test_motions_are_within_their_error(pair) -> None:
    """Five periods from a start that moves, against simulate, forced and not."""
    system, ready = pair
    n = system.size
    start = (1e-4 * np.arange(1, n + 1), 1e-2 * np.ones(n))
    for forced in (True, False):
        own = ready if forced else el.prepare(system, ready.span, samples=16, forcing=False)
        speed = float(_speeds(own, 3)[2])
        found = own.simulate(speed, 5, start)
        other = el.simulate(system, speed, 5, initial=start, samples=16, forcing=forced)
        step = (len(other.theta) - 1) // (len(found.theta) - 1)
        peak = np.max(np.abs(other.q), axis=0)
        gap = np.max(np.abs(found.q - other.q[::step]), axis=0) / peak
        assert np.all(gap <= found.error + other.error)
        np.testing.assert_allclose(found.theta, other.theta[::step], atol=1e-12)
        scale = np.max(np.abs(other.qd))
        np.testing.assert_allclose(found.qd, other.qd[::step], atol=1e-8 * scale)


@pytest.mark.parametrize("size", [1e-12, 1e9])
def test_figures_do_not_depend_on_the_size_of_the_force(size) -> None:
    """A force has its own unit: motions and errors scale with it."""
    system = forced_mathieu()

    def scaled(term):
        return (
            replace(term, function=lambda theta: size * term(theta)) if term.array == "p" else term
        )

    plain = el.prepare(system, (60.0, 100.0), samples=8)
    other = el.prepare(system.with_changed_terms(scaled), (60.0, 100.0), samples=8)
    runs = [(r.steady_state(70.0), r.simulate(70.0, 2, (0.0, 0.0))) for r in (plain, other)]
    for one, two in zip(*runs, strict=True):
        np.testing.assert_allclose(two.q, size * one.q, atol=1e-12 * size * np.max(one.q))
        assert np.max(two.error) <= 4.0 * np.max(one.error)


@pytest.mark.slow
@pytest.mark.parametrize("modes", [1, 3])
def test_compiled_answers_are_the_same_to_round_off(modes) -> None:
    """The same sums in loops: to 1e-13 of the largest value, with the same figures."""
    pytest.importorskip("numba")
    system = el.load_scene(SCENE, overrides={"model.modes": modes}).system()
    plain = el.prepare(system, (40.0, 100.0), samples=8)
    fast = el.prepare(system, (40.0, 100.0), samples=8, compiled=True)
    for speed in (40.0, 47.1, 64.0, 100.0):
        pairs = [
            (ready.monodromy(speed), ready.steady_state(speed), ready.simulate(speed, 3, (1e-4, 0)))
            for ready in (plain, fast)
        ]
        for one, other in zip(*pairs, strict=True):
            for name in ("matrix", "q", "qd"):
                value = getattr(one, name, None)
                if value is not None:
                    gap = np.max(np.abs(getattr(other, name) - value))
                    assert gap <= 1e-13 * np.max(np.abs(value)), name
            np.testing.assert_allclose(other.error, one.error, rtol=1e-6)


def test_compiling_without_numba_is_refused(monkeypatch) -> None:
    """One line that names the extra."""
    monkeypatch.setitem(__import__("sys").modules, "numba", None)
    with pytest.raises(BadInput, match=r"elastolink\[fast\]"):
        el.prepare(el.load_scene(SCENE).system(), 80.0, compiled=True)


def test_one_speed_alone_needs_no_polynomials() -> None:
    """A single speed has one node; parameters and geometry may be given."""
    system = el.load_scene(SCENE).system()
    ready = el.prepare(system, 80.0, follower_inertia=1e-3)
    exact = el.monodromy(system, 80.0, follower_inertia=1e-3).matrix
    np.testing.assert_allclose(ready.monodromy(80.0).matrix, exact, rtol=1e-11, atol=1e-12)
    assert len(ready.tables) == 1
    assert len(ready.tables[0].groups) == 1


def test_results_bear_pickling_and_know_their_origin() -> None:
    """The checks of a motion are made when they are looked at."""
    system = el.load_scene(SCENE).system()
    found = el.prepare(system, (70.0, 90.0)).simulate(80.0, 2, (1e-4, 0.0))
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.q, found.q)
    assert dict(again.checks) == dict(found.checks)
    assert found.checks["accuracy"].passed
    steady = el.prepare(system, (70.0, 90.0)).steady_state(80.0)
    other = el.steady_state(system, 80.0)
    assert set(steady.checks) <= set(other.checks)
    ours, theirs = (one.checks["linear range"].value for one in (steady, other))
    assert abs(ours - theirs) <= 1e-2 * theirs
    assert found.provenance == el.simulate(system, 80.0, 2, initial=(1e-4, 0.0)).provenance


def test_a_start_that_shakes_a_dying_mode_is_followed_too() -> None:
    """Two oscillators by themselves; the fast one dies within a sixth of a revolution."""
    rate, drag = np.array([30.0, 3e4]), np.array([1.0, 4e3])
    springs = {"K": np.diag(rate**2), "Kg": wave(1e-9 * np.eye(2))}
    ready = el.prepare(system_of(M=np.eye(2), C=np.diag(drag), **springs), 60.0, samples=16)
    found = ready.simulate(60.0, 2, (1.0, 0.0))
    turning = np.sqrt(rate**2 - drag**2 / 4)
    time = found.time[:, None]
    exact = np.exp(-drag / 2 * time) * (
        np.cos(turning * time) + drag / 2 / turning * np.sin(turning * time)
    )
    assert found.passed and np.max(found.error) < 1e-6
    assert np.all(np.max(np.abs(found.q - exact), axis=0) <= found.error)
    assert ready.monodromy(60.0).error <= 1e-9
