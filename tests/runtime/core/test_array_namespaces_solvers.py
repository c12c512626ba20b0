"""Batched solvers given arrays of another namespace: computed there, converted, or refused."""

from __future__ import annotations

import array_api_strict as xp
import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic
from elastolink.runtime.core.namespaces import common_array, to_numpy
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
