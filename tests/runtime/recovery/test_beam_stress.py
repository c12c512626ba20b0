"""Stresses over the cycle: hand cases, the four-bar of Aannaque's Table 4.1, refusals."""

from dataclasses import replace

import beam_motions as motions
import numpy as np
import pytest
from command_runs import shown
from elastolink.runtime.core.errors import BadInput, LinearRangeWarning
from elastolink.runtime.periodic import simulate, steady_state
from elastolink.runtime.recovery import stress
from elastolink.runtime.recovery.stresses import stress_operator


@pytest.fixture(scope="module")
def at_20():
    system = motions.damped_four_bar()
    motion = motions.periodic_motion(system, 20.0, 128)
    return system, motion, stress(system, motion)


@pytest.mark.smoke
def test_cantilever_stress_by_hand():
    # sigma = N/A -+ M c/I: 10 N along and 2 N across the end of 1 m, 20 mm by 10 mm.
    found = stress(motions.cantilever(force=(10.0, 2.0)))
    bending = 2.0 * 0.005 / (0.02 * 0.01**3 / 12)
    axial = 10.0 / 2e-4
    assert found.maximum.value == pytest.approx(axial + bending, rel=1e-7)
    # Cubics are exact between loaded nodes: what a finer mesh leaves is round-off.
    assert abs(found.maximum.value - axial - bending) <= found.error <= 1e-6 * bending
    assert (found.maximum.link, found.maximum.place) == ("bar", 0.0)
    assert found.maximum.fibre == "negative"
    assert found.safety(250e6)["bar"] == pytest.approx(250e6 / (axial + bending), rel=1e-7)
    np.testing.assert_allclose(found.at("bar", 0.0)[0], axial - bending, rtol=1e-7)
    np.testing.assert_allclose(found.fibre("positive", "dynamic"), 0.0, atol=1e-7 * bending)
    assert found.plot().get_xlabel() == "place x/length"


def test_stress_of_a_frame_needs_no_speed(capsys):
    portal = ("stress", "aannaque_1996_portal_frame", "--set", "frame.axial=elastic")
    force = ("--set", 'nodes.B.force=["100 N", "0 N"]')
    # Built-in portal of equal bars, force F along the beam: Kleinlogel's base moment 2 F L/7 for
    # k = 1, half on each side, over the section's modulus b t^2/6; the axial parts are below 1 %.
    moment, modulus = 2.0 / 7.0 * 100.0, 0.02 * 0.01183**2 / 6.0
    lines = shown(capsys, *portal, *force, "--limit", "250 MPa").splitlines()
    first = next(line for line in lines if line.startswith("left")).split()
    assert float(first[1]) == pytest.approx(moment / modulus / 1e6, rel=0.02)
    # Pushed to the right, the left column is drawn on its left, the positive side of A to B.
    assert first[4] == "positive"
    shown(capsys, *portal)


def test_maximum_lies_between_the_samples(at_20):
    _, motion, found = at_20
    sampled = float(np.max(found.stress))
    assert abs(found.maximum.value) >= sampled * (1 - 1e-12)
    fine = found.maximum
    sparse = replace(motion, theta=motion.theta[::2], q=motion.q[::2], qd=motion.qd[::2])
    again = stress(at_20[0], sparse).maximum
    # 64 angles hold the motion: 30 harmonics.
    assert again.value == pytest.approx(fine.value, rel=1e-3)
    assert again.link == fine.link == "crank"
    assert abs(again.value) > np.max(np.abs(found.stress[::4]))


def test_static_and_dynamic_part_add_up(at_20):
    _, _, found = at_20
    for fibre in ("positive", "negative"):
        parts = [found.fibre(fibre, name) for name in ("all", "quasi-static", "dynamic")]
        np.testing.assert_allclose(parts[0], parts[1] + parts[2], atol=1e-9 * np.max(found.stress))
    still = np.abs(found.static_axial) + np.abs(found.static_bending)
    assert np.max(still) < np.max(found.stress)
    labels = [text.get_text() for text in found.plot().get_legend().get_texts()]
    assert [label.split(",")[0] for label in labels] == ["crank", "coupler", "follower"]


def test_quasi_static_stress_is_that_of_rigid_links(at_20):
    # Statically determinate: with a modulus a million times as large the whole is quasi-static.
    system, _, _ = at_20
    bare = system.without("C").without("Kg")
    stiff = bare.with_parameters(elasticity=1e6)
    whole = stress(stiff, motions.periodic_motion(stiff, 20.0, 64))
    still = stress(bare, motions.periodic_motion(bare, 20.0, 64))
    size = np.max(whole.stress)
    # Elastic displacements turn no force in these equations without the axial forces; what is
    # left is centripetal acceleration of the displacement, some 1e-4 of the rigid one.
    np.testing.assert_allclose(still.static_bending, whole.bending, atol=2e-3 * size)


def test_form_of_the_stresses_gives_the_stresses(at_20):
    system, motion, found = at_20
    form, stations = stress_operator(system, motion.theta, 25)
    values = form.values(20.0, motion.q, motion.slope)
    expected = np.concatenate([found.fibre("positive"), found.fibre("negative")], axis=1)
    np.testing.assert_allclose(values, expected, atol=1e-9 * np.max(found.stress))
    assert tuple(s.beam for s in stations) == found.links
    whole, _ = stress_operator(system, motion.theta, 25, accelerations=True)
    assert ("ddq", 2) in whole.parts
    assert not any(name == "ddq" for name, _ in form.parts)


def test_steady_state_and_march_agree_with_collocation():
    system = motions.turning_bar(motions.rocking, elements=1)
    expected = stress(system, motions.periodic_motion(system, 8.0, 32))
    steady = steady_state(system, 8.0)
    found = stress(system, steady)
    assert found.maximum.value == pytest.approx(expected.maximum.value, rel=1e-6)
    assert found.mesh_error > 0.0
    assert stress(system, 8.0).maximum.value == pytest.approx(expected.maximum.value, rel=1e-5)
    start = (steady.q[0], steady.qd[0])
    march = simulate(system, 8.0, 0.125, initial=start, samples=len(steady.theta))
    again = stress(system, march)
    count = len(again.theta)
    np.testing.assert_allclose(again.theta, found.theta[:count], atol=1e-12)
    size = np.max(found.stress)
    np.testing.assert_allclose(again.bending, found.bending[:count], atol=1e-4 * size)
    assert "frequencies apart" in again.error_norm


def test_left_linear_range_is_said():
    system = motions.turning_bar(motions.rocking, modulus=1e8, elements=1)
    with pytest.warns(LinearRangeWarning):
        found = stress(system, motions.periodic_motion(system, 8.0, 32))
    assert not found.checks["linear range"].passed


def test_unusable_arguments_are_refused(at_20):
    _, motion, found = at_20
    bar = motions.turning_bar(motions.rocking, elements=1)
    thin = {name: replace(section, thickness=None) for name, section in motions.SECTIONS.items()}
    for call, words in (
        (lambda: found.safety({"crank": 1e8}), "limit"),
        (lambda: found.safety(-1.0), "limit"),
        (lambda: found.fibre("top"), None),
        (lambda: found.fibre("positive", "half"), None),
        (lambda: found.at("rod", 0.5), None),
        (lambda: stress(bar, steady_state(bar, [7.0, 8.0])), None),
        (lambda: stress(motions.four_bar(1, thin), motion), "thickness"),
    ):
        with pytest.raises(BadInput, match=words):
            call()
