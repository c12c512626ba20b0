"""What "0.2 percent proportional damping" can mean for the stiff rod: docs/rod_damping.md."""

import warnings

import elastolink as el
import numpy as np
import pytest
from edge_truth import scene_rod
from elastolink.runtime.periodic import steady_state
from elastolink.runtime.systems.rod import OverhangBasis
from scipy.interpolate import CubicSpline

SPEED = 90.0
PERIOD = 2 * np.pi / SPEED
READINGS = {
    "none": {},
    "viscous": {"rod.damping_ratio": 0.002, "rod.damping_law": "viscous"},
    "internal": {"rod.damping_ratio": 0.002, "rod.damping_law": "internal"},
    "modal": {"rod.damping_ratio": 0.002, "rod.damping_law": "modal"},
    "0.002 K": {"rod.relaxation_time": "0.002 s"},
}


def _rod(reading, suffix="_heavy", modes=2, **more):
    return el.load_scene(
        f"beale_1992_bahgat_willmert{suffix}",
        overrides={"model.modes": modes, **READINGS[reading], **more},
    ).linear_system()


def _first(system):
    geometry, values = system.geometry, system.parameters
    found = OverhangBasis(1).frequencies(
        geometry["frame"] / geometry["length"],
        length=geometry["length"],
        bending_stiffness=values["bending_stiffness"],
        mass_per_length=values["mass_per_length"],
    )
    return found.frequencies[0, 0]


def _decay(system):
    """Nepers per revolution of the slowest and the fastest transient."""
    values = el.floquet_multipliers(system, SPEED).multipliers
    rates = -np.log(np.abs(values))
    return float(np.min(rates)), float(np.max(rates))


def _transients(system, revolutions):
    """Largest distance of the tip from its steady motion over the peak, quarter by quarter."""
    with warnings.catch_warnings():
        # The heavy rod leaves the linear range; the comparison is of the linear equations.
        warnings.simplefilter("ignore", el.LinearRangeWarning)
        steady, motion = steady_state(system, SPEED), el.simulate(system, SPEED, revolutions)
    end = np.ones(1)
    tip = np.sum(system.shapes(end, motion.theta)[:, 0] * motion.q, axis=1)
    periodic = np.sum(system.shapes(end, steady.theta)[:, 0] * steady.q, axis=1)
    angle = np.append(steady.theta, steady.theta[0] + 2 * np.pi)
    curve = CubicSpline(angle, np.append(periodic, periodic[0]), bc_type="periodic")
    there = curve(np.mod(motion.theta, 2 * np.pi))
    off = np.abs(tip - there) / np.max(np.abs(periodic))
    quarter = np.minimum(motion.theta // (np.pi / 2), 4 * revolutions - 1).astype(int)
    return np.array([np.max(off[quarter == i]) for i in range(4 * revolutions)])


def test_decay_of_the_heavy_rod_by_reading():
    """Nepers per revolution; the first frequency is 4.57 turns, so 0.002 of it is next to none."""
    first = _first(_rod("none"))
    assert first / SPEED == pytest.approx(4.566, abs=1e-3)
    found = {reading: _decay(_rod(reading)) for reading in READINGS}
    assert found["none"][1] < 1e-12
    np.testing.assert_allclose(found["viscous"], 0.002 * first * PERIOD, rtol=1e-9)
    np.testing.assert_allclose(found["internal"], [0.0743, 1.815], rtol=2e-3)
    np.testing.assert_allclose(found["modal"], [0.0631, 0.3208], rtol=2e-3)
    assert found["0.002 K"][0] == pytest.approx(15.26, rel=2e-3)


@pytest.mark.slow
def test_only_damping_of_the_stiffness_by_a_time_is_steady_at_once():
    """From rest the heavy rod: 0.002 K forgets the start in a quarter turn, no ratio does."""
    at_once = _transients(_rod("0.002 K"), 1)
    assert at_once[0] < 5e-3
    assert np.all(at_once[1:] < 2e-5)
    for reading in ("viscous", "internal", "modal"):
        found = _transients(_rod(reading), 3)
        assert np.all(found > 0.5)


def test_mass_read_as_a_mass_the_start_hardly_stirs_the_rod():
    """The first frequency is 90 turns: without any damping the transient is 2e-4 of the peak."""
    system = _rod("none", suffix="", modes=1)
    assert _first(system) / SPEED == pytest.approx(89.7, abs=0.1)
    found = _transients(system, 1)
    assert np.all(found < 5e-4)
    assert np.max(found) > 5e-5


def test_viscous_damping_shifts_every_growth_rate_by_its_own():
    """v = exp(-c t/2m) y: the growth in the tongue 2 w1 = w less zeta w1, to (zeta w1)^2."""
    speed = np.linspace(1450.0, 1640.0, 7)
    rates = []
    for damping in ({}, READINGS["viscous"]):
        found = el.floquet_multipliers(scene_rod(**damping), speed)
        values = np.max(np.abs(found.multipliers), axis=-1)
        rates.append(np.log(values) * speed / (2 * np.pi))
    assert np.min(rates[0]) > 50.0
    np.testing.assert_allclose(rates[0] - rates[1], 0.002 * 858.228, rtol=2e-3)


@pytest.mark.slow
def test_no_reading_in_per_cent_closes_the_wide_tongues():
    """Crank ratio 0.2, damping ratio 0.002: of eight tongues only 2 w1 = 3 w closes."""
    narrow, next_one = np.linspace(567.1, 568.2, 23), np.linspace(819.0, 825.6, 23)
    for reading, left in (("viscous", 2.11), ("internal", 0.745), ("modal", 1.72)):
        system = scene_rod(**READINGS[reading])
        growth = [
            np.max(
                np.log(np.max(np.abs(el.floquet_multipliers(system, at).multipliers), axis=-1))
                * at
                / (2 * np.pi)
            )
            for at in (narrow, next_one)
        ]
        assert growth[0] < -1.0
        assert growth[1] == pytest.approx(left, abs=0.03)
