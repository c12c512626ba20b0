"""Stress against speed: the error estimate of each maximum against its actual error.

References solve the whole equations speed by speed: no modal truncation, no tables.  Those of
random four-bars do it by dense Fourier collocation, and recover stresses at many angles.
"""

import elastolink as el
import numpy as np
import pytest
from beam_motions import elastic_linkage, peaks, periodic_motion
from elastolink.runtime.core.trigonometric import differentiated, even_angles, resampled
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.recovery import BeamMotion
from elastolink.runtime.recovery.beam_forces import Recovered, stations_of
from elastolink.runtime.recovery.stress_over_speed import Fibres
from elastolink.runtime.recovery.stresses import fibre_factors, stresses
from honesty import covers, over_scenes

STATIONS = 5
# Elements of each link, damping ratio, lowest and highest speed [rad/s], way to the stresses.
CASES = (
    (1, 0.02, 5.0, 70.0, "shape"),
    (1, 0.005, 20.0, 60.0, "equilibrium"),
    (1, 0.05, 12.0, 90.0, "shape"),
)

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")


def compared(elements, ratio, low, high, method, count):
    """Return actual relative errors and their estimates at random speeds."""
    overrides = {"mesh.elements": elements, "damping.ratio": ratio}
    system = el.load_scene("aannaque_1996_table_4_1", overrides=overrides).system()
    speeds = np.sort(np.random.default_rng(96).uniform(low, high, count))
    curve = el.stress_curve(system, speeds, stations=STATIONS, method=method)
    fibres = Fibres(system, STATIONS, method)
    motion = el.steady_state(system, speeds, rtol=1e-8, samples=512)
    truth = fibres.peaks(motion.theta, motion.q, speeds).size.T
    return np.abs(curve.maximum / truth - 1.0), curve.error


@pytest.mark.parametrize("count", [2, pytest.param(24, marks=pytest.mark.slow)])
def test_estimates_cover_the_actual_errors_and_are_not_idle(count):
    actual, estimate = zip(*(compared(*case, count) for case in CASES), strict=True)
    covers(estimate, actual, floor=1e-12)


@pytest.mark.slow
def test_three_elements_meet_what_is_wanted():
    """27 freedoms."""
    actual, estimate = compared(3, 0.02, 5.0, 70.0, "shape", 3)
    assert np.all(actual <= np.minimum(estimate, 1e-4))


def exact_maxima(system, speed, method, count=160, fine=1024):
    """Return the largest stress of each link, by dense collocation and parabolas between angles.

    None where the motion has harmonics beyond those of the collocation.
    """
    coarse = periodic_motion(system, speed, count)
    waves = np.abs(np.fft.rfft(coarse.q, axis=0)) * np.arange(count // 2 + 1.0)[:, None] ** 2
    if np.max(waves[-count // 8 :] / np.max(waves, axis=0)) > 1e-7:
        return None
    q = resampled(coarse.q, fine)
    theta, qd = even_angles(system.period, fine), speed * differentiated(q, system.period)
    motion = BeamMotion(theta=theta, q=q, qd=qd, speed=speed, period=system.period)
    stations = stations_of(system.structure, STATIONS)
    asked = Recovered(system, motion, STATIONS, method)
    axial, bending = stresses(asked, fibre_factors(system, stations))
    fibres = np.concatenate([axial + bending, axial - bending], axis=1)
    top = peaks(fibres, 16 * fine)
    links = np.array([station.beam for station in stations] * 2)
    return np.array([np.max(top[links == link]) for link in dict.fromkeys(links)])


@over_scenes(1414, few=1, many=8)
@pytest.mark.parametrize("method", ["equilibrium", "shape"])
def test_random_four_bars(rng, method):
    system, speed = elastic_linkage(rng, FourBar, 1)
    speeds = speed * np.sort(rng.uniform(0.5, 1.5, 3))
    rtol = float(10.0 ** rng.uniform(-5.0, -3.0))
    exact = [exact_maxima(system, at, method) for at in speeds]
    if any(truth is None for truth in exact):
        return None
    curve = el.stress_curve(
        system, speeds, stations=STATIONS, method=method, rtol=rtol, stability=False
    )
    # The reference is known to less than 3e-7.
    actual = np.abs(curve.maximum / np.array(exact) - 1.0)
    return curve.error + 3e-7, np.maximum(actual, 3e-7)
