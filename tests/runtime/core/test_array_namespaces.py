"""Solvers given arrays of another namespace convert them."""

import array_api_strict as xp
import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.inputs import as_numpy

SCENE = "smith_1972_5152_thirtysecond_inch"


@pytest.mark.parametrize("where", ["CPU_DEVICE", "device1"])
def test_other_solvers_turn_arrays_into_those_of_numpy(where) -> None:
    """Right, whatever device they come from."""
    one, device = el.load_scene(SCENE, {"coupler.damping": 0.2}).system(), xp.Device(where)
    speeds = xp.asarray([60.0, 80.0], device=device)
    inertia = xp.asarray([1e-3, 2e-3], device=device)
    plain = as_numpy(speeds)
    for solver in (el.monodromy, el.floquet_multipliers):
        found = solver(one, speeds, follower_inertia=inertia)
        exact = solver(one, plain, follower_inertia=as_numpy(inertia))
        for name in exact.arrays():
            np.testing.assert_array_equal(getattr(found, name), getattr(exact, name))
    quiet = {"damping": xp.asarray(40.0, device=device)}
    steady = el.steady_state(one, speeds, **quiet)
    np.testing.assert_array_equal(steady.q, el.steady_state(one, plain, damping=40.0).q)
    other, start = one.with_parameters(**quiet), (xp.asarray(1e-4, device=device), 0.0)
    run = el.simulate(other, speeds[0], 2.0, initial=start, samples=8)
    quiet = one.with_parameters(damping=40.0)
    alone = el.simulate(quiet, 60.0, 2.0, initial=(1e-4, 0.0), samples=8)
    np.testing.assert_array_equal(run.q, alone.q)
    chart = el.stability_chart(one, x=("speed", speeds), y=("follower_inertia", inertia))
    rows = el.stability_chart(one, x=("speed", plain), y=("follower_inertia", as_numpy(inertia)))
    np.testing.assert_array_equal(chart.stable, rows.stable)
