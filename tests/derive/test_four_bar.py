"""The derived kinematics of the four-bar linkage: exact identities, structure, namespaces."""

from __future__ import annotations

import array_api_strict
import mpmath
import numpy as np
import pytest
import sympy as sp
from elastolink.derive.models import four_bar
from elastolink.derive.models.four_bar import MODEL, coupler, crank, follower, frame, theta2
from elastolink.derive.pipeline import lower
from elastolink.derive.spec import ModelSpec
from elastolink.generated import four_bar_kinematics
from judging import Point, exact_at, reference_of
from linkage_truth import OUTPUTS, Linkage, random_points

SPEC = ModelSpec("four_bar", "kinematics")
INPUTS = (theta2, frame, crank, coupler, follower, four_bar.assembly)
ROCKER = Linkage(5.0, 1.0, 5.0, 2.0, 1.0)


def motion(theta, linkage, **changes):
    arguments = {**linkage.point("", 0.0).arguments, "theta2": theta, **changes}
    return dict(zip(OUTPUTS, four_bar_kinematics.motion(**arguments), strict=True))


# ---------------------------------------------------------------- before lowering


@pytest.fixture
def symbolic():
    """The steps at random linkages, evaluated in 80 digits without any lowering."""
    k = four_bar.kinematics()
    outputs = [(symbol.name, symbol) for symbol, _ in k.steps.steps]
    reference = reference_of(INPUTS, outputs, k.steps)
    found = [
        (point, exact_at(reference, Point(point.name, {}, point.arguments)).values)
        for point in random_points(12, seed=3)
    ]
    with mpmath.workdps(80):
        yield found


def test_steps_satisfy_the_loop_closure_and_its_derivatives(symbolic):
    for point, v in symbolic:
        f, c, a, b = (point.inputs[n] for n in ("frame", "crank", "coupler", "follower"))
        residuals = (
            c * v["cos2"] + a * v["cos3"] - b * v["cos4"] - f,
            c * v["sin2"] + a * v["sin3"] - b * v["sin4"],
            c * v["cos2"] + a * v["omega3"] * v["cos3"] - b * v["omega4"] * v["cos4"],
            -c * v["sin2"]
            + a * (v["alpha3"] * v["cos3"] - v["omega3"] ** 2 * v["sin3"])
            - b * (v["alpha4"] * v["cos4"] - v["omega4"] ** 2 * v["sin4"]),
        )
        scale = max(1.0, abs(v["alpha3"]), abs(v["alpha4"]), abs(v["omega4"])) * max(f, c, a, b)
        assert all(abs(r) < 1e-65 * scale for r in residuals), point.name


def test_differences_of_speeds_are_what_their_names_say(symbolic):
    for _, v in symbolic:
        size = 1 + abs(v["omega3"]) + abs(v["omega4"])
        assert abs(v["slip3"] - (1 - v["omega3"])) < 1e-70 * size
        assert abs(v["slip4"] - (1 - v["omega4"])) < 1e-70 * size
        assert abs(v["spread"] - (v["omega4"] - v["omega3"])) < 1e-70 * size
        assert abs(v["sine_transmission"] ** 2 + v["cosine_transmission"] ** 2 - 1) < 1e-70


def test_kinematics_needs_no_more_than_the_motion_uses():
    """Each step serves an output, so that nothing idle is emitted."""
    closed = MODEL.energies(SPEC)
    assert closed.steps == closed.steps.needed(value for _, value in closed.outputs)


# ---------------------------------------------------------------- pruning


def test_fewer_outputs_cost_fewer_operations():
    counts = {}
    for outputs in ((), ("theta4",), ("omega3", "omega4"), ("transmission_angle",)):
        spec = SPEC.with_(outputs=outputs)
        module = lower(spec, MODEL.energies(spec), MODEL.describe(spec))
        (kernel,) = module.kernels
        expected = outputs or OUTPUTS
        assert [result.name for result in kernel.results] == list(expected)
        counts[outputs] = module.operations
    assert counts["transmission_angle",] < counts["theta4",] < counts["omega3", "omega4"]
    assert counts["omega3", "omega4"] < 0.8 * counts[()]


def test_an_output_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match="unknown outputs"):
        MODEL.energies(SPEC.with_(outputs=("theta5",)))


# ---------------------------------------------------------------- the emitted function


def test_array_namespaces_give_the_same_numbers():
    theta = np.concatenate([np.linspace(-20.0, 20.0, 41), [0.0, 1e-300, 1000 * np.pi]])
    for point in random_points(6, seed=5):
        linkage = Linkage(*(point.inputs[n] for n in ROCKER.lengths), point.fixed["assembly"])
        expected = motion(theta, linkage)
        strict = motion(array_api_strict.asarray(theta), linkage)
        for name, value in expected.items():
            assert isinstance(strict[name], type(array_api_strict.asarray(theta)))
            # vector loops may round the last digit differently with an array's alignment
            size = 4 * np.finfo(float).eps * np.max(np.abs(value))
            np.testing.assert_allclose(np.asarray(strict[name]), value, rtol=0, atol=size)


def test_nothing_is_filled_in_place_and_scalars_work():
    theta = np.linspace(-1.0, 7.0, 9)
    theta.flags.writeable = False
    expected = motion(theta, ROCKER)
    for kind in (float, np.float64):
        for i, angle in enumerate(theta):
            for name, value in motion(kind(angle), ROCKER).items():
                assert value == pytest.approx(expected[name][i], rel=1e-15, abs=1e-15)
    whole = motion(3, ROCKER, frame=5, crank=1, coupler=5, follower=2, assembly=1, winding=0)
    assert whole == motion(3.0, ROCKER)
    shaped = motion(theta.reshape(3, 3), ROCKER)
    np.testing.assert_array_equal(shaped["alpha4"].ravel(), expected["alpha4"])


def test_lengths_broadcast_against_angles():
    theta, cranks = np.linspace(0.0, 6.0, 5), np.array([[0.5], [1.0], [1.5]])
    together = motion(theta, ROCKER, crank=cranks)
    for i, length in enumerate(cranks[:, 0]):
        alone = motion(theta, ROCKER, crank=float(length))
        for name, value in alone.items():
            np.testing.assert_allclose(together[name][i], value, rtol=1e-14, atol=1e-15)


def test_pythagoras_at_a_hand_case():
    """Frame 4, crank 3 at 90 deg: BD = 5; coupler 12 and follower 13 make BCD right-angled."""
    m = motion(np.pi / 2, Linkage(4.0, 3.0, 12.0, 13.0, 1.0))
    assert m["transmission_angle"] == pytest.approx(np.arctan2(5, 12), rel=1e-15)
    # BD points down by atan(3/4); CB is at right angles to it, C on the left: the open assembly.
    assert m["theta3"] == pytest.approx(np.pi / 2 - np.arctan2(3, 4), rel=1e-15)


def test_identities_of_the_emitted_numbers():
    """Smith (2.7): the speed ratio by the instant centres; rates sum up round the loop."""
    for point in random_points(40, seed=6):
        m = dict(zip(OUTPUTS, four_bar_kinematics.motion(**point.arguments), strict=True))
        n = point.arguments
        turn = n["theta2"] - m["theta3"]
        sine = np.sin(m["theta4"] - m["theta3"])
        ratio = n["crank"] * np.sin(turn) / (n["follower"] * sine)
        assert m["omega4"] == pytest.approx(ratio, rel=1e-10, abs=1e-11 / abs(sine))
        assert np.sign(sine) == n["assembly"]
        assert abs(np.sin(m["transmission_angle"])) == pytest.approx(abs(sine), abs=1e-11)


def test_no_typed_in_result_in_the_model_file():
    """The closure occurs once, as a vector equation; rates come from its derivatives alone."""
    k = four_bar.kinematics()
    values = k.steps.mapping()
    assert values[k.w3] == k.share + k.reduced * k.excess3
    t = sp.Symbol("t", real=True)
    angles = [sp.Function(name)(t) for name in ("a2", "a3", "a4")]
    loop = [
        crank * trig(angles[0]) + coupler * trig(angles[1]) - follower * trig(angles[2])
        for trig in (sp.cos, sp.sin)
    ]
    # Cramer's rule by hand on the plainly differentiated closure, at a random pose.
    numbers = {frame: 2.0, crank: 0.7, coupler: 2.3, follower: 1.9, theta2: 1.1}
    m = motion(1.1, Linkage(2.0, 0.7, 2.3, 1.9, 1.0))
    pose = dict(zip(angles, (1.1, m["theta3"], m["theta4"]), strict=True))
    speeds = {a.diff(t): s for a, s in zip(angles, (1.0, m["omega3"], m["omega4"]), strict=True)}
    for equation in loop:
        assert abs(equation.diff(t).subs(speeds).subs(pose).subs(numbers)) < 1e-14
