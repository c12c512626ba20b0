"""Batched solvers given arrays of another namespace: computed there, converted, or refused."""

from __future__ import annotations

import json
import pickle

import array_api_strict as xp
import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.namespaces import common_array, to_numpy
from elastolink.runtime.floquet import monodromy_matrices
from elastolink.runtime.floquet.first_order import canonical_form
from elastolink.runtime.floquet.namespace_monodromy import NamespaceForm
from elastolink.runtime.floquet.period_products import ordered_product
from elastolink.runtime.integrators import METHODS, expm

SCENE = "smith_1972_5152_thirtysecond_inch"
SPEEDS = np.linspace(55.0, 90.0, 6).reshape(2, 3)
# Products of matrices may be summed in another order.
ROUND = 1e-13
NEEDS_PAIRS = {"srkn4", "srkn6"}


def system(modes: int = 2, damping: float = 0.2) -> LinearPeriodic:
    return el.load_scene(
        SCENE, overrides={"model.modes": modes, "coupler.damping": damping}
    ).system()


def same(strict, plain) -> None:
    """Assert that an array is of the strict namespace and holds the numbers of a plain one."""
    assert strict.__array_namespace__() is xp
    assert isinstance(plain, np.ndarray)
    assert strict.shape == plain.shape
    np.testing.assert_allclose(to_numpy(strict), plain, rtol=0, atol=ROUND * np.max(np.abs(plain)))


def generators(m: int, apart: bool, forced: bool):
    """Return one generator in both namespaces, ``(2, nt, m, m)``."""
    rng = np.random.default_rng(m)
    first, second = rng.standard_normal((2, 2, 1, m, m))
    n = (m - forced) // 2

    def plain(theta):
        values = first + np.cos(theta)[:, None, None] * second
        if apart:
            values[..., :n, :n] = values[..., n : 2 * n, n : 2 * n] = 0.0
        if forced:
            values[..., -1, :] = values[..., :n, -1] = 0.0
        return values

    return plain, lambda theta: xp.asarray(plain(theta))


@pytest.mark.parametrize("name", sorted(METHODS))
@pytest.mark.parametrize("size", [2, 4, 5])
@pytest.mark.parametrize("apart", [True, False])
def test_every_one_step_method_gives_the_same_maps(name, size, apart) -> None:
    """Maps are of the generator's namespace: split or not, forced (an odd size) or not."""
    if name in NEEDS_PAIRS and not apart:
        return
    plain, strict = generators(size, apart, bool(size % 2))
    theta = 0.2 * np.arange(5.0)
    expected = METHODS[name].maps(plain, theta, 0.2)
    same(METHODS[name].maps(strict, theta, 0.2), expected)


def test_methods_that_need_pairs_refuse_others_in_any_namespace() -> None:
    _, strict = generators(4, False, False)
    with pytest.raises(BadInput, match="first derivatives"):
        METHODS["srkn6"].maps(strict, np.zeros(1), 0.1)


@pytest.mark.parametrize("size", [1e-5, 1e-2, 0.2, 3.0])
@pytest.mark.parametrize("m", [2, 3])
def test_exponentials_of_every_degree(size, m) -> None:
    matrices = size * np.random.default_rng(0).standard_normal((4, m, m))
    same(expm(xp.asarray(matrices)), expm(matrices))


@pytest.mark.parametrize("growth", [1.0, 1e70, 1e-70, 1e-150, 1e150])
def test_products_of_many_matrices_keep_their_powers_of_two(growth) -> None:
    """Also where a factor alone is near the ends of the range of doubles."""
    maps = growth * np.random.default_rng(1).uniform(0.5, 1.0, (3, 11, 2, 2))
    plain, power = ordered_product(maps)
    strict, exponent = ordered_product(xp.asarray(maps))
    same(strict, plain)
    np.testing.assert_array_equal(to_numpy(exponent), power)
    assert exponent.dtype == xp.int64


@pytest.mark.parametrize("forcing", [True, False])
@pytest.mark.parametrize("scene", [SCENE, "beale_1992_flexible_rod"])
def test_generators_of_scenes(scene, forcing) -> None:
    """Coriolis, damping and centrifugal terms, forcing; common mass matrices or not."""
    form = canonical_form(el.load_scene(scene).system(), np.array([50.0, 70.0]), forcing=forcing)
    theta = np.linspace(0.0, 6.0, 5)
    moved = NamespaceForm.of(form, xp.asarray(np.ones(1)))
    same(moved.generator(theta), form.generator(theta))
    same(moved.take(slice(1, 2)).generator(theta), form.take(slice(1, 2)).generator(theta))


def test_each_member_may_have_its_own_mass() -> None:
    """Mass, Coriolis, centrifugal, damping, carried and stiffness terms, each by a parameter."""
    rng = np.random.default_rng(5)
    parts = {name: rng.standard_normal((2, 2)) for name in "MABCDK"}
    parts["M"] = np.eye(2) + 0.1 * parts["M"] @ parts["M"].T

    def wave(matrix):
        return lambda theta: (1.0 + 0.3 * np.cos(theta))[:, None, None] * matrix

    made = LinearPeriodic(
        2,
        tuple(Term(name, name.lower(), wave(matrix)) for name, matrix in parts.items()),
        {name.lower(): 1.0 for name in parts},
        lambda values: {name: np.asarray(value, dtype=float) for name, value in values.items()},
    )
    values = {name.lower(): rng.uniform(0.5, 2.0, 3) for name in parts}
    plain = monodromy_matrices(made, 1.5, steps=24, **values)
    strict = {name: xp.asarray(value) for name, value in values.items()}
    same(monodromy_matrices(made, 1.5, steps=24, **strict).matrix, plain.matrix)
    exact = el.monodromy(made, 1.5, **values)
    np.testing.assert_allclose(plain.matrix, exact.matrix, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", sorted(set(METHODS) - {"de_vogelaere"} - NEEDS_PAIRS))
def test_monodromy_matrices_of_every_method(name) -> None:
    """Of the namespace given, in the shape of the batch, equal to NumPy's to round-off."""
    plain = monodromy_matrices(system(), SPEEDS, method=name, steps=48)
    strict = monodromy_matrices(system(), xp.asarray(SPEEDS), method=name, steps=48)
    for field in ("speed", "matrix", "exponent", "scale", "determinant"):
        same(getattr(strict, field), getattr(plain, field))
    assert plain.matrix.shape == (2, 3, 4, 4)
    # Both hold the same difference of two solutions, to their rounding.
    assert abs(strict.error - plain.error) <= 1e-9 * plain.error + 1e-15
    assert isinstance(strict.error, float)
    exact = el.monodromy(system(), SPEEDS, rtol=1e-13)
    gap = plain._scaled - exact.scaled
    size = np.max(np.abs(exact.scaled), axis=(-2, -1), keepdims=True)
    assert np.max(np.abs(gap) / size) <= plain.error + np.max(exact.error)


def test_the_batch_keeps_its_order_where_speeds_need_unlike_steps() -> None:
    speeds = np.array([90.0, 11.0, 45.0, 12.0, 88.0])
    strict = monodromy_matrices(system(), xp.asarray(speeds), rtol=1e-8)
    assert len(set(strict.steps.tolist())) > 1
    exact = el.monodromy(system(), speeds)
    size = np.max(np.abs(exact.matrix), axis=(-2, -1), keepdims=True)
    gap = np.abs(to_numpy(strict.matrix) - exact.matrix) / size
    # From scaled variables to these, errors grow by the ratio of two scales.
    assert np.max(gap) <= 1e-8 * np.max(exact.scale / exact.scale[:, ::-1])
    assert strict.error <= 1e-8
    assert strict.passed, dict(strict.checks)
    assert set(strict.checks) == {"converged", "liouville"}


def test_parameters_broadcast_in_their_namespace() -> None:
    """Arrays of parameters, plain numbers and whole numbers beside them."""
    inertia = np.array([[1e-3], [2e-3]])
    plain = monodromy_matrices(system(), [60, 70, 80], follower_inertia=inertia)
    strict = monodromy_matrices(
        system(), xp.asarray([60, 70, 80]), follower_inertia=xp.asarray(inertia)
    )
    same(strict.matrix, plain.matrix)
    alone = monodromy_matrices(system(), 70.0, follower_inertia=xp.asarray(inertia[:, 0]))
    same(alone.matrix, np.ascontiguousarray(plain.matrix[:, 1]))


def test_hill_equations_are_judged_by_half_the_trace() -> None:
    """Mathieu's equation: half trace and stability as the discriminant gives them."""
    hill = el.load_scene("mathieu").system()
    lam2, mu = np.linspace(0.1, 9.0, 12), np.array([[0.0], [0.7], [2.5]])
    found = monodromy_matrices(hill, 1.0, lam2=xp.asarray(lam2), mu=xp.asarray(mu))
    exact = monodromy_matrices(hill, 1.0, lam2=lam2, mu=mu)
    same(found.half_trace, exact.half_trace)
    multipliers = el.floquet_multipliers(hill, 1.0, lam2=lam2, mu=mu)
    half = 0.5 * np.sum(multipliers.multipliers, axis=-1).real
    np.testing.assert_allclose(to_numpy(found.half_trace), half, rtol=1e-10, atol=1e-10)
    stable = to_numpy(found.stable)
    np.testing.assert_array_equal(stable, multipliers.stable)
    assert 0 < np.sum(stable) < stable.size


def test_damping_moves_the_stable_range_of_the_half_trace() -> None:
    one = system(modes=1, damping=0.1)
    speeds = np.linspace(20.0, 95.0, 60)
    found = monodromy_matrices(one, xp.asarray(speeds))
    exact = el.floquet_multipliers(one, speeds)
    np.testing.assert_array_equal(to_numpy(found.stable), exact.stable)
    np.testing.assert_allclose(
        to_numpy(found.determinant), np.prod(exact.multipliers, axis=-1).real, rtol=1e-9
    )
    with pytest.raises(BadInput, match="2 degrees of freedom"):
        _ = monodromy_matrices(system(), 60.0, steps=16).stable


def repelled(rate: float) -> LinearPeriodic:
    terms = (Term("M", None, np.eye(1)), Term("K", None, np.array([[-(rate**2)]])))
    return LinearPeriodic(1, terms, {}, lambda values: {})


def test_growth_beyond_doubles_keeps_its_exponent() -> None:
    """cosh(2 pi r) and cosh(2 pi 200): the first is a double, the other is not."""
    for rate, power in ((50.0, False), (200.0, True)):
        strict = monodromy_matrices(repelled(rate), xp.asarray([1.0]))
        plain = monodromy_matrices(repelled(rate), [1.0])
        same(strict.matrix, plain.matrix)
        assert bool(strict.exponent[0] != 0) is power
        half = 0.5 * np.trace(plain.matrix[0])
        grown = np.log(half) + plain.exponent[0] * np.log(2.0)
        assert abs(grown - (2 * np.pi * rate - np.log(2.0))) < 1e-10 * rate
        assert not bool(strict.stable[0])
        assert bool(xp.isinf(strict.half_trace[0])) is power


def test_a_result_of_another_namespace_can_be_kept(tmp_path) -> None:
    """NumPy's arrays leave: to files, dictionaries, and by name."""
    found = monodromy_matrices(system(), xp.asarray(SPEEDS), steps=16)
    plain = found.to_numpy()
    assert isinstance(plain.matrix, np.ndarray)
    np.testing.assert_array_equal(found.arrays()["matrix"], plain.matrix)
    kept = np.load(found.save(tmp_path / "found.npz"))
    np.testing.assert_array_equal(kept["matrix"], plain.matrix)
    table = json.loads(found.save(tmp_path / "found.json").read_text())
    assert np.shape(table["matrix"]) == (2, 3, 4, 4)
    assert pickle.loads(pickle.dumps(plain)).passed == plain.passed


def refusal(*arguments, **named) -> str:
    """Return the one line with which a call is refused."""
    with pytest.raises(BadInput) as refused:
        monodromy_matrices(system(1), *arguments, **named)
    text = str(refused.value)
    assert "\n" not in text
    return text


def test_single_precision_is_refused_in_one_line() -> None:
    assert "float32" in refusal(xp.asarray([60.0], dtype=xp.float32))
    line = refusal(60.0, damping=xp.asarray(0.1, dtype=xp.float32))
    assert line.startswith("damping: found an array of")
    assert "complex128" in refusal(xp.asarray([60.0 + 0j]))
    assert "bool" in refusal(xp.asarray([True]))


def test_mixed_namespaces_and_devices_are_refused_in_one_line() -> None:
    line = refusal(xp.asarray([60.0]), damping=np.array([0.1]))
    assert line.startswith("speed and damping: found array_api_strict and numpy")
    assert "array_api_strict" in refusal(np.array([60.0]), damping=xp.asarray([0.1]))
    other = xp.asarray([0.1], device=xp.Device("device1"))
    assert "device1" in refusal(xp.asarray([60.0]), damping=other)
    # A number of NumPy is a number.
    assert monodromy_matrices(system(1), xp.asarray([60.0]), damping=np.float64(0.1)).passed


def test_arrays_on_another_device_stay_there() -> None:
    device = xp.Device("device1")
    found = monodromy_matrices(system(), xp.asarray(SPEEDS[0], device=device), steps=16)
    assert found.matrix.device == device
    assert found.exponent.device == device
    assert found.half_trace.device == device
    plain = monodromy_matrices(system(), SPEEDS[0], steps=16)
    same(found.matrix, plain.matrix)
    assert found.checks.keys() == plain.checks.keys()


class Bare:
    """A namespace without linear algebra."""

    float64 = np.dtype(float)
    __name__ = "bare"


class BareArray:
    dtype, device, shape = np.dtype(float), "cpu", ()

    def __array_namespace__(self):
        return Bare()


def test_a_namespace_without_linear_algebra_is_refused() -> None:
    with pytest.raises(BadInput, match="speed: found bare; expected a namespace with linalg"):
        common_array({"speed": BareArray()})
    assert common_array({"speed": 1.0, "damping": np.ones(2)}) is None


def test_unusable_arguments_are_refused_in_one_line() -> None:
    assert "de_vogelaere" not in refusal(60.0, method="newmark").split("expected")[1]
    assert "found 'de_vogelaere'" in refusal(60.0, method="de_vogelaere")
    assert refusal(60.0, steps=1).startswith("steps")
    assert refusal(60.0, rtol=1.0).startswith("rtol")
    assert refusal(xp.asarray([60.0, -1.0])).startswith("speed")
    assert refusal(xp.asarray([])).startswith("speed")
    assert "broadcast" in refusal(xp.asarray([60.0, 70.0]), damping=xp.asarray([0.1, 0.2, 0.3]))


def test_a_mass_that_vanishes_at_some_angle_is_refused() -> None:
    """Where it escapes the angles that are looked at beforehand."""

    def mass(theta):
        dip = np.exp(-2000.0 * np.sin((theta - 0.05) / 2) ** 2)
        return (1.0 - 1.5 * dip)[:, None, None] * np.eye(2)

    weak = LinearPeriodic(
        2, (Term("M", None, mass), Term("K", None, np.eye(2))), {}, lambda values: {}
    )
    form = canonical_form(weak, np.ones(1))
    moved = NamespaceForm.of(form, xp.asarray(np.ones(1)))
    with pytest.raises(BadInput, match="mass matrix M"):
        moved.generator(np.array([0.05]))


@pytest.mark.parametrize("where", ["CPU_DEVICE", "device1"])
def test_other_solvers_turn_arrays_into_those_of_numpy(where) -> None:
    """Right, whatever device they come from."""
    one, device = system(1), xp.Device(where)
    speeds = xp.asarray([60.0, 80.0], device=device)
    inertia = xp.asarray([1e-3, 2e-3], device=device)
    plain = to_numpy(speeds)
    for solver in (el.monodromy, el.floquet_multipliers):
        found = solver(one, speeds, follower_inertia=inertia)
        exact = solver(one, plain, follower_inertia=to_numpy(inertia))
        for name in exact.arrays():
            np.testing.assert_array_equal(getattr(found, name), getattr(exact, name))
    quiet = {"damping": xp.asarray(40.0, device=device)}
    steady = el.steady_state(one, speeds, **quiet)
    np.testing.assert_array_equal(steady.q, el.steady_state(one, plain, damping=40.0).q)
    other, start = one.with_parameters(**quiet), (xp.asarray(1e-4, device=device), 0.0)
    run = el.simulate(other, speeds[0], 2.0, initial=start, samples=8)
    alone = el.simulate(
        one.with_parameters(damping=40.0), 60.0, 2.0, initial=(1e-4, 0.0), samples=8
    )
    np.testing.assert_array_equal(run.q, alone.q)
    chart = el.stability_chart(one, x=("speed", speeds), y=("follower_inertia", inertia))
    rows = el.stability_chart(one, x=("speed", plain), y=("follower_inertia", to_numpy(inertia)))
    np.testing.assert_array_equal(chart.stable, rows.stable)
