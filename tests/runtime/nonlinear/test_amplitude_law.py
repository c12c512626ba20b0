"""The law of frequency against amplitude, against free vibrations of the exact equations."""

from __future__ import annotations

import tomllib
from itertools import pairwise

import numpy as np
import pytest
from elastolink import load_scene
from elastolink.runtime.core.families import Drive
from elastolink.runtime.nonlinear import amplitude_law
from elastolink.runtime.scenes import scene_from_document
from scipy.integrate import solve_ivp

SCENE = "smith_1972_101104_thirtysecond_inch"
SLIDER = """
[model]
mechanism = "slider_crank"
formulation = "{formulation}"
flexible = ["coupler"]
modes = {modes}
[links]
crank = "120 mm"
coupler = "0.3 m"
offset = "20 mm"
[coupler]
bending_stiffness = "1.7 N m^2"
mass_per_length = "0.4 kg/m"
[slider]
mass = "0.2 kg"
"""


def scene_of(mechanism, formulation, modes):
    if mechanism == "slider_crank":
        text = SLIDER.format(formulation=formulation, modes=modes)
        return scene_from_document("slider", tomllib.loads(text))
    return load_scene(SCENE, {"model.formulation": formulation, "model.modes": modes})


def half_period(system, frequency, theta, mode, size, start):
    """Return half a period over that of small vibrations, less 1, and the amplitude.

    From one rest position to the next.  The amplitudes of the other modes at the first one, which
    follow in what is returned, are found by Newton's method, with states beside the motion that
    are integrated along; ``start`` is where it begins.
    """
    n, others = system.size, [i for i in range(system.size) if i != mode - 1]
    numbers, drive = {**system.parameters, "damping": 0.0}, Drive(np.full(n, theta), 0.0)

    def rates(_, flat):
        q, qd = np.moveaxis(flat.reshape(n, 2, n), 1, 0)
        at = system.equations(q, qd * frequency, np.zeros_like(q), drive, numbers)
        qdd = -np.linalg.solve(at.mass, at.residual[..., None])[..., 0] / frequency**2
        return np.stack([qd, qdd], axis=1).ravel()

    longer, aside, step = start[0], np.array(start[1:]), 1e-4 * size
    for _ in range(6):
        states = np.zeros((n, 2, n))  # the motion itself, and one for each other mode
        states[:, 0, mode - 1], states[:, 0, others] = size, aside
        states[range(1, n), 0, others] += step
        span = (0.0, np.pi * (1.0 + longer))
        moved = solve_ivp(rates, span, states.ravel(), method="DOP853", rtol=1e-11, atol=1e-13)
        end = moved.y[:, -1].reshape(n, 2, n)
        by_time = np.pi * rates(0.0, moved.y[:, -1]).reshape(n, 2, n)[0, 1]
        by_start = (end[1:, 1] - end[0, 1]) / step
        change = -np.linalg.solve(np.column_stack([by_time, *by_start]), end[0, 1])
        longer, aside = longer + change[0], aside + change[1:]
        # The others' frequencies are near multiples of this one: their own motion hardly counts.
        if abs(change[0]) < 1e-8 * abs(longer):
            return np.array([longer, *aside]), (size - end[0, 0, mode - 1]) / 2.0
    raise AssertionError("no vibration from rest to rest was found")


def measured(mechanism, formulation, theta, mode, modes):
    """Return the law's coefficient from free vibrations of amplitudes that are halved twice."""
    scene = scene_of(mechanism, formulation, modes)
    system = scene.system()
    law = amplitude_law(scene, theta, mode)
    found, start = [], np.zeros(modes)
    for size in np.array([0.08, 0.04, 0.02]) / mode**2:
        start, amplitude = half_period(system, law.frequency, theta, mode, size, start)
        part = amplitude / (mode * np.pi)  # A over the length
        found.append(-start[0] / (1.0 + start[0]) / part**2)
        start = start / 4.0
    first = [(4.0 * b - a) / 3.0 for a, b in pairwise(found)]
    return (16.0 * first[1] - first[0]) / 15.0, law


CASES = [
    ("four_bar", 0.3, 1, 1),
    ("four_bar", 2.2, 1, 1),
    ("slider_crank", 0.3, 1, 1),
    ("four_bar", 0.3, 1, 2),
    ("four_bar", 4.5, 2, 2),
    ("slider_crank", 1.2, 2, 2),
]


@pytest.mark.parametrize(("mechanism", "theta", "mode", "modes"), CASES[2::2])
def test_free_vibrations_to_third_order_obey_the_law(mechanism, theta, mode, modes):
    coefficient, law = measured(mechanism, "inextensible_cubic", theta, mode, modes)
    assert coefficient == pytest.approx(float(law.coefficient), rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("mechanism", "theta", "mode", "modes"), [*CASES, ("four_bar", 0.3, 1, 3)])
def test_free_vibrations_of_any_amplitude_obey_the_law(mechanism, theta, mode, modes):
    coefficient, law = measured(mechanism, "inextensible", theta, mode, modes)
    assert coefficient == pytest.approx(float(law.coefficient), rel=1e-5)


def test_values_of_an_independent_derivation():
    """By numbers of modes, to all digits given; 200 modes are nearly all."""
    scene = scene_of("four_bar", "inextensible", 1)
    for mode, modes, expected in (
        (1, 1, -27.95143741),
        (1, 2, -27.99711240),
        (1, 3, -28.00027603),
        (1, 200, -28.001045),
        (2, 2, -472.64966178),
        (2, 3, -476.31798992),
        (3, 3, -2413.87006353),
    ):
        found = amplitude_law(scene, 0.3, mode, modes)
        assert float(found.coefficient) == pytest.approx(expected, rel=3e-9 if modes < 4 else 1e-7)


def test_other_modes_count_as_far_as_the_transmission_angle_is_not_right():
    scene = scene_of("four_bar", "inextensible", 1)
    law = amplitude_law(scene, np.linspace(0.0, 6.0, 13))
    more = amplitude_law(scene, law.theta, modes=4)
    shares = (more.coefficient - law.coefficient) * np.tan(law.transmission_angle) ** 2
    assert np.all(law.coefficient < 0.0) and np.ptp(shares) < 1e-9 * np.abs(shares[0])
    assert law.at(0.1 * law.length) == pytest.approx(law.frequency * (1 + 0.01 * law.coefficient))


def test_refusals():
    scene = scene_of("four_bar", "inextensible", 1)
    for arguments, words in (
        ((load_scene(SCENE), 0.3), "formulation 'complete'"),
        ((scene, 0.3, 0), "mode"),
        ((scene, 0.3, 3, 2), "modes"),
        ((scene, float("nan")), "theta"),
        (("scene", 0.3), "scene"),
    ):
        with pytest.raises(ValueError, match=words):
            amplitude_law(*arguments)
