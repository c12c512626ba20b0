"""What the benchmark of forces compares: the rivals, the reference, the table."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.benchmarking import benchmark_forces
from elastolink.runtime.benchmarking.rigid_by_hand import (
    NAMES,
    Data,
    forces_by_hand,
    forces_by_solving,
    forces_in_blocks,
    reference,
)
from elastolink.runtime.core.errors import BadInput

LENGTHS = np.array([12.0, 6.0, 12.0, 12.0])
MASSES = np.array([0.6, 1.2, 1.3])
BARS = Data(LENGTHS, MASSES * LENGTHS[1:] / 2, MASSES * LENGTHS[1:] ** 2 / 3, MASSES, 10.0)
THETA = np.linspace(0.1, 6.2, 57)


def test_two_ways_by_hand_agree_and_meet_the_momenta():
    closed, solved = forces_by_hand(THETA, BARS), forces_by_solving(THETA, BARS)
    np.testing.assert_allclose(closed, solved, rtol=0, atol=1e-13 * np.abs(solved).max())
    np.testing.assert_array_equal(forces_in_blocks(THETA, BARS), closed)


def _by_mpmath(theta):
    """Momenta of the bars by numerical differentiation in 40 digits: X, Y, M."""
    l1, l2, l3, l4 = map(mpmath.mpf, LENGTHS)

    def momenta(t):
        speed = mpmath.mpf(10)

        def places(time):
            angle = mpmath.mpf(float(theta)) + speed * (time - t)
            b = l2 * mpmath.expj(angle)
            gap = l1 - b
            along = (abs(gap) ** 2 + l3**2 - l4**2) / (2 * l3)
            turn = mpmath.mpc(along, mpmath.sqrt(abs(gap) ** 2 - along**2)) / abs(gap)
            c = b + l3 * turn * gap / abs(gap)
            return b, c

        return places, speed

    def total(time):
        places, _ = momenta(0)
        b, c = places(time)
        db, dc = (mpmath.diff(lambda s, i=i: places(s)[i], time) for i in (0, 1))
        linear = mpmath.mpc(0)
        moment = mpmath.mpf(0)
        for mass, (start, end), (ds, de) in zip(
            MASSES, ((0, b), (b, c), (l1, c)), ((0, db), (db, dc), (0, dc)), strict=True
        ):
            start, end, ds, de = map(mpmath.mpmathify, (start, end, ds, de))
            linear += mass * (ds + de) / 2
            # A uniform bar: the integral of x cross v between ends that move linearly.
            for weight, p, v in (
                (2, start, ds),
                (1, start, de),
                (1, end, ds),
                (2, end, de),
            ):
                moment += mass * weight * (p.conjugate() * v).imag / 6
        return linear, moment

    force = -mpmath.diff(lambda s: total(s)[0], 0)
    turn = -mpmath.diff(lambda s: total(s)[1], 0)
    return float(force.real), float(force.imag), float(turn)


def test_shaking_force_and_moment_against_40_digits():
    with mpmath.workdps(40):
        for theta in (0.7, 2.9):
            found = forces_by_hand(np.array([theta]), BARS)[9:, 0]
            np.testing.assert_allclose(found, _by_mpmath(theta), rtol=1e-12)


def test_reference_has_digits_to_spare_and_the_rounding_of_the_inputs():
    value, scale = reference(THETA, BARS)
    error = np.abs(forces_by_hand(THETA, BARS) - value)
    assert np.all(error <= 32 * 2.0**-53 * scale)
    assert np.any(error > 0)
    # Forces are of the first degree in the masses and of the second in the speed.
    assert np.all(scale >= 3.9 * np.abs(value))


@pytest.mark.parametrize("angles", [1000, 2000, 3001])
def test_no_digits_are_lost_near_a_change_point(angles):
    """Where the form by hand loses a hundred units: C comes near A."""
    result = benchmark_forces(angles, rounds=1)
    near = {row.contender: row.error for row in result.rows if "change point" in row.problem}
    assert near["elastolink"] < 32
    assert near["closed form by hand"] > 64


def test_the_table_names_every_contender():
    result = benchmark_forces(angles=2000, rounds=1)
    names = {row.contender for row in result.rows}
    assert {"elastolink", "closed form by hand", "closed form by hand, in blocks"} < names
    assert "nine equations, numpy.linalg.solve" in names
    assert result.passed
    ours = {row.problem: row.error for row in result.rows if row.contender == "elastolink"}
    assert len(ours) == 3
    assert max(ours.values()) < 32
    assert len(NAMES) == 12
    assert "near toggle" in result.table()


@pytest.mark.parametrize("numbers", [(10, 3), (2000, 0)])
def test_refuses_too_few(numbers):
    with pytest.raises(BadInput):
        benchmark_forces(*numbers)


def test_exudyn_converges_to_the_pin_forces_in_second_order():
    pytest.importorskip("exudyn")
    from elastolink.runtime.benchmarking.exudyn_linkage import simulate_revolution
    from elastolink.runtime.scenes import load_scene

    machine = load_scene("smith_1972_12_6_12_12").machine()
    from elastolink.runtime.rigid import rigid_forces

    errors = []
    for steps in (1000, 2000, 4000):
        run = simulate_revolution(machine, 10.0, steps)
        ours = rigid_forces(machine, run.theta, 10.0)
        exact = np.stack([ours.f12, ours.f23, ours.f34])
        errors.append(np.abs(run.joints[:3] - exact).max() / np.abs(exact).max())
        assert np.abs(run.torque - ours.torque).max() < 1e-3 * np.abs(ours.torque).max()
    slopes = np.diff(np.log2(errors))
    np.testing.assert_allclose(slopes, -2.0, atol=0.1)
