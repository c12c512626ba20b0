"""The linear-periodic family with mode shapes passed in at a point that moves along the link."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic import monodromy
from elastolink.runtime.systems import assemble
from periodic_systems import second_order

LENGTH, TRAVEL = 2.0, 0.6
PARAMETERS = {"modal_mass": 1.3, "stiffness": 40.0, "slider_mass": 0.5, "gravity": 9.81}
WAVES = np.array([1, 2]) * np.pi / LENGTH


def place(theta):
    return LENGTH / 2 + TRAVEL * np.sin(theta)


def passed():
    """The shapes sin(k pi s / length) at the mass, by argument name."""
    functions = {}
    for k, wave in enumerate(WAVES, start=1):
        functions[f"shape_{k}"] = lambda theta, wave=wave: np.sin(wave * place(theta))
        functions[f"slope_{k}"] = lambda theta, wave=wave: wave * np.cos(wave * place(theta))
    return functions


@pytest.fixture(scope="module")
def emitted(emit):
    spec = ModelSpec("moving_mass", "external_shapes", flexible=("string",), modes=2)
    return emit("moving_mass", spec).module


@pytest.fixture(scope="module")
def system(emitted):
    geometry = {"travel": TRAVEL}
    return assemble(emitted, geometry=geometry, parameters=PARAMETERS, external=passed())


def by_hand(theta, speed):
    """The second-order form for one crank angle, with second derivatives of the shapes.

    With the mass at s(t) and c = shapes there, L = m qd.qd/2 + M0 ((c.q)')^2/2 - M0 g c.q - ...
    """
    m, k, slider, g = PARAMETERS.values()
    moved, turned = TRAVEL * np.cos(theta) * speed, -TRAVEL * np.sin(theta) * speed**2
    phase = WAVES * place(theta)
    shape, slope = np.sin(phase), WAVES * np.cos(phase)
    rate, bend = slope * moved, -(WAVES**2) * shape * moved**2 + slope * turned
    # (M0 (c.q)'' + M0 g) c = M0 c (c.qdd + 2 c'.qd + c''.q + g)
    stiffness = k * np.diag([1.0, 4.0]) + slider * np.outer(shape, bend)
    damping = 2.0 * slider * np.outer(shape, rate)
    return stiffness, damping, m * np.eye(2) + slider * np.outer(shape, shape), -slider * g * shape


def test_shapes_are_passed_in_by_name(emitted, system):
    assert emitted.EXTERNAL == ("shape_1", "shape_2", "slope_1", "slope_2")
    theta = np.linspace(0.0, 6.0, 9)
    shapes = np.stack([passed()[f"shape_{k}"](theta) for k in (1, 2)], axis=-1)
    expected = 1.3 * np.eye(2) + 0.5 * shapes[:, :, None] * shapes[:, None, :]
    np.testing.assert_allclose(system.array("M", theta), expected, rtol=1e-14)
    with pytest.raises(BadInput, match=r"\['slope_2'\]"):
        some = {name: value for name, value in passed().items() if name != "slope_2"}
        assemble(emitted, geometry={"travel": TRAVEL}, parameters=PARAMETERS, external=some)


def test_no_second_derivative_of_a_shape_is_needed(system):
    """The canonical form without it is the second-order form with it."""
    for theta, speed in ((0.3, 2.5), (2.0, 4.0), (-1.2, 7.0)):
        for mine, hand in zip(
            second_order(system, theta, speed), by_hand(theta, speed), strict=True
        ):
            np.testing.assert_allclose(mine[0], hand, rtol=0, atol=1e-12 * np.max(np.abs(hand)))
    assert monodromy(system, np.array([2.5, 4.0, 7.0])).checks["symplectic"].passed
