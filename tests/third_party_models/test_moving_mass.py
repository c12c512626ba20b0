"""The linear-periodic family with mode shapes passed in at a point that moves along the link."""

from __future__ import annotations

import numpy as np
import pytest
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.periodic import floquet_multipliers, monodromy, simulate
from elastolink.runtime.systems import assemble

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


def by_hand() -> LinearPeriodic:
    """The same arrays in another gauge: from the second-order form, with second derivatives.

    M = m I + M0 s s^T; adding d/dt (td q^T P q / 2) moves the symmetric part of A into B.
    """
    m, k, slider, g = PARAMETERS.values()

    def parts(theta):
        phase = WAVES * place(theta)[:, None]
        moved = TRAVEL * np.cos(theta)[:, None]
        shape, slope = np.sin(phase), WAVES * np.cos(phase) * moved
        bend = -(WAVES**2) * shape * moved**2 - WAVES * np.cos(phase) * (
            TRAVEL * np.sin(theta)[:, None]
        )
        return shape, slope, bend

    def outer(a, b):
        return slider * a[:, :, None] * b[:, None, :]

    def gyro(theta):
        shape, slope, _ = parts(theta)
        return (outer(shape, slope) - outer(slope, shape)) / 2

    def spin(theta):
        shape, slope, bend = parts(theta)
        even = outer(slope, slope) + (outer(shape, bend) + outer(bend, shape)) / 2
        return outer(slope, slope) - even

    terms = (
        Term("M", None, lambda theta: m * np.eye(2) + outer(parts(theta)[0], parts(theta)[0])),
        Term("A", None, gyro),
        Term("B", None, spin),
        Term("K", None, k * np.diag([1.0, 4.0])),
        Term("p", None, lambda theta: -slider * g * parts(theta)[0]),
    )
    return LinearPeriodic(2, terms, {}, lambda values: {})


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
    """The canonical form without it has the multipliers of the form with it."""
    speeds = np.array([2.5, 4.0, 7.0])
    found, expected = (floquet_multipliers(one, speeds) for one in (system, by_hand()))
    assert monodromy(system, speeds).checks["symplectic"].passed
    for mine, other in zip(found.multipliers, expected.multipliers, strict=True):
        distance = np.abs(mine[:, None] - other[None, :])
        assert np.max(np.min(distance, axis=1)) < 1e-8
        assert np.max(np.min(distance, axis=0)) < 1e-8


def test_motion_under_gravity(system):
    one, other = (simulate(item, 3.0, 1.0, rtol=1e-10) for item in (system, by_hand()))
    assert np.max(np.abs(one.q)) > 1e-3
    np.testing.assert_allclose(one.q, other.q, atol=1e-9)
    np.testing.assert_allclose(one.qd, other.qd, atol=1e-8)
