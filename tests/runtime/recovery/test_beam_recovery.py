"""Forces along beams against statics by hand, and as linear forms of the motion."""

from dataclasses import replace

import beam_motions as motions
import numpy as np
import pytest
from elastolink.runtime.beams import KINDS
from elastolink.runtime.beams.element_forms import ElementForms
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.recovery import recover, stress_operator
from elastolink.runtime.recovery.beam_forces import stations_of
from periodic_systems import second_order

# Round-off of forces that are differences of stiffness times displacement.
ROUND = 1e-9


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", ["equilibrium", "shape"])
def test_cantilever_under_a_load_at_its_end(kind, method):
    # By hand: M = F (L - x), V = F, N = P; both ways are exact without a load between nodes.
    along, across = 3.0, 5.0
    c, s = np.cos(0.4), np.sin(0.4)
    force = (c * along - s * across, s * along + c * across)
    found = recover(motions.cantilever(kind, 2, 2.0, 0.4, force), method=method)
    x = 2.0 * found.places
    np.testing.assert_allclose(found.moment[0], across * (2.0 - x), atol=ROUND * 2.0 * across)
    np.testing.assert_allclose(found.shear[0], across, rtol=1e-7)
    np.testing.assert_allclose(found.axial[0], along, rtol=1e-7)
    # Deflection and slope of a beam with shear deformation: F L^3/3EI (+ F L/kGA), F L^2/2EI.
    stiffness = motions.BAR.bending_stiffness
    sheared = across * 2.0 / motions.BAR.shear_stiffness if kind == "timoshenko" else 0.0
    assert found.across[0, -1] == pytest.approx(across * 8.0 / 3.0 / stiffness + sheared, rel=1e-7)
    assert found.slope[0, -1] == pytest.approx(across * 4.0 / 2.0 / stiffness, rel=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_cantilever_under_its_weight(kind):
    # By hand: M = -m g cos(a) (L - x)^2 / 2, V = -m g cos(a) (L - x), N = -m g sin(a) (L - x).
    found = recover(motions.cantilever(kind, 1, 2.0, 0.4, gravity=(0.0, -9.81)))
    weight, rest = 9.81 * motions.BAR.mass_per_length, 2.0 - 2.0 * found.places
    size = weight * 4.0
    np.testing.assert_allclose(found.axial[0], -weight * np.sin(0.4) * rest, atol=1e-7 * size)
    np.testing.assert_allclose(found.shear[0], -weight * np.cos(0.4) * rest, atol=1e-7 * size)
    np.testing.assert_allclose(
        found.moment[0], -0.5 * weight * np.cos(0.4) * rest**2, atol=1e-7 * size
    )


@pytest.mark.parametrize("kind", KINDS)
def test_bar_that_turns_steadily(kind):
    # By hand: N = m w^2 (L^2 - x^2)/2; the stretch adds a share of (k L)^2, k^2 = m w^2/EA, which
    # is (w/w_1)^2 of the first mode along the bar: 5e-5 at 50 rad/s.
    system = motions.turning_bar(motions.steadily, kind=kind, elements=2)
    found = recover(system, motions.periodic_motion(system, 50.0, 8))
    mass = motions.BAR.mass_per_length
    expected = 0.5 * mass * 2500.0 * (1.0 - found.places**2)
    share = mass * 2500.0 / motions.BAR.axial_stiffness
    assert np.max(np.abs(found.axial - expected)) <= share * np.max(expected)
    # Of the stretch itself: N = EA (cos(kx) + tan(kL) sin(kx) - 1 - ...) at the clamp, where
    # u = sin(kx)/(k cos kL) - x gives N = EA (1/cos(kL) - 1).
    k = np.sqrt(share)
    exact = motions.BAR.axial_stiffness * (np.cos(k * found.places) / np.cos(k) - 1.0)
    assert np.max(np.abs(found.axial - exact)) <= 0.1 * share * np.max(expected)
    assert np.max(np.abs(found.moment)) <= 1e-7 * np.max(expected)


@pytest.mark.parametrize("kind", KINDS)
def test_pinned_bar_that_rocks(kind):
    # By hand, of a stiff bar: M = m phi'' (L^2 x - x^3)/6, V = -dM/dx; rotary inertia and the
    # elastic motion are of the order of (w/w_1)^2 and smaller.
    system = motions.turning_bar(
        motions.rocking, pinned=True, modulus=210e15, kind=kind, elements=1
    )
    motion = motions.periodic_motion(system, 10.0, 16)
    found = recover(system, motion)
    x = found.places
    force = motions.BAR.mass_per_length * 100.0 * motions.rocking(motion.theta)[2][:, None]
    rotary = 0.0
    if kind == "timoshenko":
        # rho I phi'' per length takes a constant part of the shear force, and no moment at pins.
        rotary = motions.BAR.rotary_inertia * 100.0 * motions.rocking(motion.theta)[2][:, None]
    moment, shear = force * (x - x**3) / 6.0, -force * (1.0 - 3.0 * x**2) / 6.0 + rotary
    size = np.max(np.abs(force))
    np.testing.assert_allclose(found.moment, moment, atol=1e-5 * size)
    np.testing.assert_allclose(found.shear, shear, atol=1e-5 * size)


@pytest.mark.parametrize(
    ("form", "kind"), [("full", "cubic"), ("instantaneous", "internal_node"), ("full", "curvature")]
)
def test_forces_of_the_elements_add_up_to_the_equation_of_motion(form, kind):
    system = motions.damped_four_bar(
        2, kind=kind, form=form, rayleigh=(0.1, 1e-5), gravity=(0.3, -9.81)
    )
    theta, speed = np.array([0.3, 1.7, 4.0]), 31.0
    forms = ElementForms(system, theta)
    assert forms.gravity == pytest.approx((0.3, -9.81), rel=1e-9)
    q, slope, second = np.random.default_rng(0).normal(size=(3, 3, system.size))
    found = forms.resisted.values(speed, q, slope, second)[:, forms.arrays.free]
    stiffness, damping, mass, force = second_order(system, theta, speed)
    expected = -force
    for matrices, vector in ((stiffness, q), (speed * damping, slope), (speed**2 * mass, second)):
        expected += np.einsum("tij,tj->ti", matrices, vector)
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.max(np.abs(expected)))


def test_forces_jump_nowhere_between_elements():
    system = motions.damped_four_bar(2)
    motion = motions.periodic_motion(system, 20.0, 32)
    beside = 0.5 + np.array([-1e-9, 1e-9])
    found = recover(system, motion, stations={"coupler": beside, "follower": beside})
    for name in ("axial", "shear", "moment"):
        for link in ("coupler", "follower"):
            values = found.of(link, name)
            size = np.max(np.abs(values))
            # What 2e-9 of the length changes, beside round-off.
            assert np.max(np.abs(values[:, 1] - values[:, 0])) <= 1e-7 * size


def test_stations_keep_their_order_and_picture_has_the_links():
    system = motions.turning_bar(motions.rocking, elements=3)
    motion = motions.periodic_motion(system, 5.0, 16)
    places = [0.9, 0.1, 0.5]
    found = recover(system, motion, stations={"bar": places})
    assert found.places.tolist() == places
    np.testing.assert_allclose(
        found.moment[:, ::-1], recover(system, motion, stations={"bar": places[::-1]}).moment
    )
    labels = [text.get_text() for text in found.plot().get_legend().get_texts()]
    assert labels == ["bar"]


def test_unusable_arguments_are_refused():
    system = motions.turning_bar(motions.rocking, elements=1)
    motion = motions.periodic_motion(system, 5.0, 16)
    other = motions.turning_bar(motions.rocking, elements=2)
    changed = system.with_changed_terms(lambda term: replace(term, function=lambda t: 2 * term(t)))
    places = (["middle"], [1.5], [], [np.nan])
    for call, words in (
        (lambda: recover(system, motion, method="guess"), "method"),
        (lambda: recover(other, motion), "coordinates"),
        (lambda: recover(changed, motion), "structure"),
        (lambda: recover(system, None), "motion"),
        (lambda: recover(object(), motion), "without beams"),
        (lambda: replace(motion, q=motion.q * np.nan), "finite"),
        (lambda: stress_operator(system, [[0.0]]), "theta"),
        (lambda: stress_operator(system, []), "theta"),
        *(
            (lambda at=at: stations_of(system.structure, at), None)
            for at in (1, True, {}, {"rod": [0.5]}, *({"bar": at} for at in places))
        ),
    ):
        with pytest.raises(BadInput, match=words):
            call()
