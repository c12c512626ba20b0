"""The closed-form family: the slider-crank against its loop in many digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec

CRANK, ROD = 0.11, 0.31


@pytest.fixture(scope="module")
def module(emit):
    return emit("offset_slider", ModelSpec("offset_slider", "kinematics")).module


def motion(module, theta, offset):
    names = module.RETURNS["motion"]
    return dict(zip(names, module.motion(theta, CRANK, ROD, offset), strict=True))


@pytest.mark.parametrize("offset", [0.0, 0.04, -0.15])
def test_motion_against_the_loop_at_30_digits(module, offset):
    thetas = np.linspace(-7.0, 7.0, 29)
    found = motion(module, thetas, offset)
    with mpmath.workdps(30):
        for k, theta in enumerate(thetas):

            def place(angle):
                """Solve |C - B| = rod, C on the slide, by Newton from the right-hand side."""
                bx, by = CRANK * mpmath.cos(angle), CRANK * mpmath.sin(angle)
                return mpmath.findroot(
                    lambda x: (x - bx) ** 2 + (offset - by) ** 2 - mpmath.mpf(ROD) ** 2, bx + ROD
                )

            def turn(angle):
                x = place(angle)
                rise = offset - CRANK * mpmath.sin(angle)
                return mpmath.atan2(rise, x - CRANK * mpmath.cos(angle))

            at = mpmath.mpf(float(theta))
            expected = {
                "position": place(at),
                "speed": mpmath.diff(place, at),
                "acceleration": mpmath.diff(place, at, 2),
                "rod_angle": turn(at),
                "rod_speed": mpmath.diff(turn, at),
                "rod_acceleration": mpmath.diff(turn, at, 2),
            }
            for name, value in expected.items():
                assert found[name][k] == pytest.approx(float(value), abs=2e-15), name


def test_only_what_is_wanted_is_emitted(emit, module):
    spec = ModelSpec("offset_slider", "kinematics", outputs=("position",))
    lean = emit("offset_slider", spec).module
    assert lean.RETURNS["motion"] == ("position",)
    theta = np.linspace(0.0, 6.0, 7)
    expected = motion(module, theta, 0.02)["position"]
    np.testing.assert_array_equal(lean.motion(theta, CRANK, ROD, 0.02), expected)
