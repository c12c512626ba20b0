"""Campbell's diagram: constant systems by hand, a pair of exponents, the linkage, bad input."""

import numpy as np
import pytest
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.frequencies import campbell
from periodic_systems import system_of, wave
from refusals import refused


def _system(softening=0.0, varying=0.0) -> LinearPeriodic:
    """Two oscillators of 30 and 70 rad/s, axial forces w^2 softening, a varying stiffness."""
    return system_of(
        M=np.eye(2),
        K=[np.diag([900.0, 4900.0]), wave(np.diag([varying, 0.0]))],
        Kg=(None, -softening * np.eye(2), 2),
    )


def test_constant_frequencies_and_their_orders():
    found = campbell(_system(), np.linspace(8.3, 41.0, 40))
    np.testing.assert_allclose(found.held, np.tile([30.0, 70.0], (40, 1)), rtol=1e-12)
    np.testing.assert_allclose(found.running, found.held, rtol=1e-7)
    assert np.max(np.abs(found.growth)) < 1e-5
    # At 10 rad/s two orders meet: which comes first is round-off.
    labels = sorted(zip(found.crossing_mode, found.crossing_order, strict=True))
    expected = sorted(
        (value / n, mode, n)
        for mode, value in ((1, 30.0), (2, 70.0))
        for n in range(1, 9)
        if 8.3 < value / n < 41.0
    )
    assert labels == sorted((mode, n) for _, mode, n in expected)
    np.testing.assert_allclose(found.crossing_speed, [w for w, _, _ in expected], rtol=1e-3)
    away = np.abs(found.crossing_speed - [w for w, _, _ in expected])
    assert np.all(away <= found.crossing_error + 1e-6)
    np.testing.assert_allclose(found.share, 1.0, rtol=1e-12)
    assert found.buckling == np.inf and found.passed


def test_axial_forces_move_the_frequencies_until_buckling():
    speeds = np.linspace(10.0, 40.0, 16)
    found = campbell(_system(1.0), speeds)
    assert found.buckling == pytest.approx(30.0, rel=1e-12)
    below = speeds < 29.9
    np.testing.assert_allclose(
        found.held[below], np.sqrt(np.array([900.0, 4900.0]) - speeds[below, None] ** 2), rtol=1e-9
    )
    assert np.all(np.isnan(found.held[~below]))
    # omega^2 = k - w^2 meets n w at k / (n^2 + 1).
    level = np.array([900.0, 4900.0])[found.crossing_mode - 1]
    exact = np.sqrt(level / (found.crossing_order**2 + 1.0))
    np.testing.assert_allclose(found.crossing_speed, exact, rtol=1e-3)
    assert np.all(np.abs(found.crossing_speed - exact) <= found.crossing_error)


def test_modes_are_told_by_their_shapes_where_others_are_nearer():
    """Gyroscopic coupling 0.8 w moves 30 and 70 rad/s apart: near 70 - 30 they pass each other."""
    gyro = np.array([[0.0, 0.0], [0.8, 0.0]])
    system = _system().with_terms(Term("A", None, gyro))
    speeds = np.linspace(20.0, 55.0, 8)
    found = campbell(system, speeds)
    # (900 - x) (4900 - x) = (0.8 w)^2 x, x the squares of the frequencies.
    middle = 0.5 * (5800.0 + (0.8 * speeds) ** 2)
    root = np.sqrt(middle**2 - 900.0 * 4900.0)
    exact = np.sqrt(np.stack([middle - root, middle + root], axis=1))
    np.testing.assert_allclose(found.running, exact, rtol=1e-6)
    # A multiple of the speed aside the other motion is nearer to the mode held still.
    shift = exact - [30.0, 70.0]
    swapped = exact[:, ::-1] - [30.0, 70.0]
    swapped -= speeds[:, None] * np.round(swapped / speeds[:, None])
    assert np.any(np.sum(np.abs(swapped), axis=1) < 0.7 * np.sum(np.abs(shift), axis=1))
    assert np.all(found.share > 0.6) and found.passed


def test_a_parametric_resonance_grows_and_locks():
    # q'' + (900 + 200 cos(w t)) q = 0 at w = 60: growth 200/(4 * 30) to first order.
    speeds = np.array([50.0, 55.0, 60.0, 65.0])
    found = campbell(_system(0.0, 200.0), speeds, modes=1)
    assert found.growth[2, 0] == pytest.approx(200 / 120, rel=0.02)
    assert found.running[2, 0] == pytest.approx(30.0, rel=1e-6)
    assert np.max(np.abs(found.growth[[0, 3], 0])) < 1e-5
    assert found.plot().get_xlabel().startswith("crank")


test_bad_input_is_refused = refused(
    lambda speed, changes: campbell(_system(), speed, **changes),
    [
        ([1.0, 2.0, 3.0], {}, "four rising"),
        ([0.0, 1.0, 2.0, 3.0], {}, "four rising"),
        ([1.0, 2.0, 3.0, 4.0], {"modes": 3}, "from 1 to 2"),
    ],
)
