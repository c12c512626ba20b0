"""Sensitivities of the four-bar's motion: derived ones against many digits, scale, and folds.

The measure of every output at all points is that of ``emitted_accuracy``; here are the truth
itself, the laws that sensitivities obey, and what happens next to a fold.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.generated import four_bar_kinematics, four_bar_sensitivities
from linkage_truth import LENGTHS, motion, random_points
from sensitivity_truth import QUANTITIES

NAMES = four_bar_sensitivities.RETURNS["sensitivities"]
SMITH = {"frame": 5.0, "crank": 1.0, "coupler": 5.0, "follower": 2.0}


def emitted(theta, assembly=1.0, **lengths):
    values = four_bar_sensitivities.sensitivities(theta, **lengths, assembly=assembly)
    return dict(zip(NAMES, values, strict=True))


def test_a_common_factor_of_all_lengths_leaves_angles_and_rates():
    """Euler: functions of degree 0 in the lengths."""
    for point in random_points(60, seed=5):
        lengths = {name: point.inputs[name] for name in LENGTHS}
        found = emitted(point.inputs["theta2"], point.fixed["assembly"], **lengths)
        for quantity in QUANTITIES:
            terms = [size * found[f"{quantity}_by_{name}"] for name, size in lengths.items()]
            fair = max(map(abs, terms)) + abs(found[f"{quantity}_by_theta2"])
            # Rounding of the input passes through the condition of the closure at this point.
            with mpmath.workdps(40):
                n = {key: mpmath.mpf(value) for key, value in point.arguments.items()}
                sine = abs(float(mpmath.sin(motion(n)["transmission_angle"])))
            assert abs(sum(terms)) <= 1e-14 * fair / sine**2, point.name


def test_derivatives_by_the_crank_angle_are_the_rates_themselves():
    theta = np.linspace(-4.0, 9.0, 101)
    found = emitted(theta, **SMITH)
    rates = four_bar_kinematics.motion(theta, **SMITH, assembly=1.0, winding=0.0)
    rates = dict(zip(four_bar_kinematics.RETURNS["motion"], rates, strict=True))
    for angle, speed in (
        ("theta3", "omega3"),
        ("theta4", "omega4"),
        ("omega3", "alpha3"),
        ("omega4", "alpha4"),
    ):
        np.testing.assert_allclose(
            found[f"{angle}_by_theta2"], rates[speed], rtol=0, atol=1e-14 * abs(rates[speed]).max()
        )


@pytest.mark.parametrize("power, quantity", [(1, "theta"), (3, "omega"), (5, "alpha")])
def test_growth_next_to_a_fold(power, quantity):
    """Sensitivities grow as odd powers of 1/sin of the transmission angle."""
    lengths = {"frame": 0.5, "crank": 0.4, "coupler": 0.45, "follower": 0.3}
    # BD = coupler + follower; the square of the sine is in proportion to the angle from there.
    square = lengths["frame"] ** 2 + lengths["crank"] ** 2 - 0.75**2
    fold = np.arccos(square / (2.0 * lengths["frame"] * lengths["crank"]))
    near, nearer = (
        abs(emitted(fold - distance, **lengths)[f"{quantity}4_by_coupler"])
        for distance in (1e-6, 1e-8)
    )
    assert nearer / near == pytest.approx(10.0**power, rel=0.01)


@pytest.mark.parametrize("power, quantity", [(1, "theta"), (2, "omega"), (3, "alpha")])
def test_growth_next_to_a_change_point(power, quantity):
    """A crank that only just passes: angle from the dead centre and sine shrink together."""
    found = []
    for gap in (1e-6, 1e-8):
        lengths = {"frame": 3.0, "crank": 1.0, "coupler": 2.5, "follower": 1.5 + gap}
        values = emitted(np.pi - 0.3 * gap**0.5, **lengths)
        found.append(abs(values[f"{quantity}4_by_coupler"]))
    assert found[1] / found[0] == pytest.approx(10.0**power, rel=0.01)
