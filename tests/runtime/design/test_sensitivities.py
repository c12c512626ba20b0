"""Derivatives of answers: against differences of the answers, laws that they obey, collisions."""

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.families import Term
from elastolink.runtime.design import sensitivities
from elastolink.runtime.scenes import with_numbers
from oscillators import oscillators
from refusals import refused

COUPLER = "smith_1972_5152_sixteenth_inch"
# Of eighth order: (f(x + k h) - f(x - k h)) / h.
EIGHTH = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}


def coupler(**overrides):
    return el.load_scene(COUPLER, {"model.modes": 2, **overrides})


def differences(answer, value, part=1e-3):
    """Return the derivative of an answer by differences of eighth order, and their step."""
    step = part * value
    pairs = (w * (answer(value + k * step) - answer(value - k * step)) for k, w in EIGHTH.items())
    return sum(pairs) / step


@pytest.mark.parametrize(
    ("damping", "names"),
    [
        (0.3, ["links.crank"]),
        pytest.param(0.3, ["links.coupler", "follower.inertia"], marks=pytest.mark.slow),
        pytest.param(0.0, ["links.coupler", "follower.inertia"], marks=pytest.mark.slow),
    ],
)
def test_ends_of_regions_by_numbers_of_the_drawing(damping, names):
    def ends(**changes):
        scene = coupler(**{"coupler.damping": damping, **changes})
        found = el.stability_edges(scene.system(), (77.5, 105.0))
        return scene, found

    scene, found = ends()
    wide = np.flatnonzero(found.width > 0.5)
    made = sensitivities(scene, found, names)
    assert made.passed
    for i, name in enumerate(names):
        value = scene.get(name)

        def answer(x, name=name):
            _, other = ends(**{name: x})
            wide_ones = other.width > 0.5
            return np.stack([other.lower[wide_ones], other.upper[wide_ones]], axis=1)

        # Ends good to 1e-12 over steps of 1e-3.
        expected = differences(answer, value) * value
        assert np.allclose(made.derivative[wide, :, i] * value, expected, rtol=0, atol=3e-7)


def test_a_stiffer_coupler_and_a_lighter_machine_are_one_and_the_same():
    """Speeds scale with the root of stiffness over inertia, exactly."""
    system = coupler().system()
    names = [*system.parameters]
    for answer in (el.stability_edges(system, (77.5, 105.0)), el.natural_frequencies(system, 0.7)):
        found = sensitivities(system, answer, names)
        known = np.isfinite(found.error[..., 0])
        share = dict(zip(names, np.moveaxis(found.relative[known], -1, 0), strict=True))
        masses = set(names) - {"bending_stiffness", "damping"}
        assert np.allclose(share["bending_stiffness"], 0.5, atol=1e-10)
        assert np.allclose(sum(share[name] for name in masses), -0.5, atol=1e-9)


def test_widths_and_lumped_masses_together_change_no_frequency_of_a_linkage():
    """By dimensions: stiffnesses and masses grow alike (Aannaque 9.2)."""
    scene = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1})
    answer = el.natural_frequencies(scene.linear_system(), [0.4, 2.0], 3)
    links = ("crank", "coupler", "follower")
    wide = [f"{link}.{number}" for link in links for number in ("area", "second_moment")]
    found = sensitivities(scene, answer, [*wide, "joints.B.mass", "joints.C.mass"])
    assert np.allclose(np.sum(found.relative, axis=-1), 0.0, rtol=0, atol=1e-10)


def test_geometry_of_a_system_that_has_some():
    system = el.load_scene("beale_1992_flexible_rod").system()
    answer = el.floquet_multipliers(system, 20.0, rtol=1e-12)
    name = "crank_ratio"
    found = sensitivities(system, answer, [name])
    value = system.geometry[name]

    def multipliers(x):
        return el.floquet_multipliers(system, 20.0, rtol=1e-12, **{name: x}).multipliers

    expected = differences(multipliers, value, 1e-5)
    size = np.max(np.abs(expected))
    assert np.allclose(found.derivative[:, 0], expected, rtol=0, atol=1e-7 * size)


def test_peaks_of_a_steady_motion_by_lengths_and_the_speed():
    scene = coupler(**{"coupler.damping": 3.0})
    answer = el.steady_state(scene.system(), 60.0)
    found = sensitivities(scene, answer, ["speed", "links.crank"])

    def peaks(system, speed):
        fine = el.steady_state(system, speed, rtol=1e-11, samples=512)
        return fine.peak(np.array([0.5]))[0] / system.reference_length

    # The middle of the coupler bends as the first sine less the third: with two modes the first.
    by_speed = differences(lambda w: peaks(scene.system(), w), 60.0)
    crank = scene.get("links.crank")
    by_crank = differences(
        lambda x: peaks(coupler(**{"coupler.damping": 3.0, "links.crank": x}).system(), 60.0), crank
    )
    sign = np.sign(found.value[0])
    assert sign * found.derivative[0, 0] * 60.0 == pytest.approx(by_speed * 60.0, rel=1e-7)
    assert sign * found.derivative[0, 1] * crank == pytest.approx(by_crank * crank, rel=1e-7)


def test_of_what_coincides_the_mean_has_a_derivative():
    # Two equal oscillators: exp(+-2 pi i w), w = sqrt(k) / speed, each twice.
    twin = (Term("M", None, np.eye(2)), Term("K", "k", np.eye(2)))
    system = el.LinearPeriodic(2, twin, {"k": 2.0}, lambda values: {"k": values["k"]})
    answer = el.floquet_multipliers(system, 1.3)
    found = sensitivities(system, answer, ["k"])
    assert np.all(found.collided) and np.all(found.error < 1e-9)
    turned = np.sign(answer.multipliers.imag) * 1j * np.pi / (1.3 * np.sqrt(2.0))
    by_hand = answer.multipliers * turned * np.sign(np.sin(2.0 * np.pi * np.sqrt(2.0) / 1.3))
    np.testing.assert_allclose(found.derivative[:, 0], by_hand, rtol=1e-9)
    held = sensitivities(system, el.natural_frequencies(system, 0.0), ["k"])
    assert np.all(held.collided)
    np.testing.assert_allclose(held.derivative, 0.5 / np.sqrt(2.0), rtol=1e-12)


def test_two_multipliers_that_meet_have_a_mean_that_moves_smoothly():
    # At an end of a region of Mathieu's equation two meet at -1, and one vector is left of two:
    # their mean is half the trace.
    system = el.LinearPeriodic(
        1,
        (
            Term("M", None, np.eye(1)),
            Term("K", "k", np.eye(1)),
            Term("K", "e", lambda theta: np.cos(theta)[:, None, None]),
        ),
        {"k": 1.0, "e": 0.3},
        dict,
    )
    edges = el.stability_edges(system, (1.5, 2.5))
    speed = float(edges.lower[0])
    answer = el.floquet_multipliers(system, speed)
    found = sensitivities(system, answer, ["speed", "k", "e"])
    assert np.all(found.collided) and np.all(np.isfinite(found.derivative))

    def half_trace(speed, **changes):
        moved = system.with_parameters(**changes)
        return 0.5 * np.trace(el.monodromy(moved, speed).matrix.reshape(2, 2))

    h = 1e-4
    by_difference = [
        (half_trace(speed + h) - half_trace(speed - h)) / (2.0 * h),
        (half_trace(speed, k=1.0 + h) - half_trace(speed, k=1.0 - h)) / (2.0 * h),
        (half_trace(speed, e=0.3 + h) - half_trace(speed, e=0.3 - h)) / (2.0 * h),
    ]
    np.testing.assert_allclose(found.derivative[0], by_difference, rtol=1e-6)


def test_a_closed_region_has_none():
    system = coupler().system()
    answer = el.stability_edges(system, (62.0, 62.5))
    found = sensitivities(system, answer, ["bending_stiffness"])
    closed = answer.width == 0.0
    assert np.all(np.isnan(found.derivative[closed])) and np.all(found.collided[closed])


def _softening(**changes):
    return oscillators(damping=0.02, cubic=-0.3, **{"force": 0.03, **changes})


def test_folds_of_a_response_curve_by_numbers_and_by_their_differences():
    system = _softening()
    curve = el.response_curve(system, "speed", (0.6, 1.1), rtol=1e-10)
    found = sensitivities(system, curve, ["force", "damping"])
    assert found.passed and found.answer == "speed at special points [rad/s]"
    step = 1e-4
    up, down = (
        el.response_curve(_softening(force=0.03 + h), "speed", (0.6, 1.1), rtol=1e-10)
        for h in (step, -step)
    )
    assert up.special == down.special == curve.special == ("fold", "fold")
    by_difference = (up.special_value - down.special_value) / (2.0 * step)
    np.testing.assert_allclose(found.derivative[:, 0], by_difference, rtol=1e-4)
    # More force folds earlier, more damping later, on the way down the softening resonance.
    assert found.derivative[1, 0] < 0.0 < found.derivative[1, 1]


def test_a_fold_over_the_force_moves_with_the_speed_as_the_inverse():
    over_force = el.response_curve(_softening(), "force", (0.001, 0.2), speed=0.85)
    by_speed = sensitivities(_softening(), over_force, ["speed"]).derivative[:, 0]
    for force, slope in zip(over_force.special_value, by_speed, strict=True):
        system = _softening(force=float(force))
        over_speed = el.response_curve(system, "speed", (0.6, 1.1))
        by_force = sensitivities(system, over_speed, ["force"]).derivative[:, 0]
        place = int(np.argmin(np.abs(over_speed.special_value - 0.85)))
        assert over_speed.special_value[place] == pytest.approx(0.85, abs=1e-8)
        assert slope * by_force[place] == pytest.approx(1.0, rel=1e-6)


@pytest.mark.slow
def test_lengths_of_a_rig_move_its_folds():
    changes = {"model.formulation": "inextensible", "coupler.damping_ratio": 0.03}
    name, speeds = "smith_1972_101104_thirtysecond_inch", (36.0, 39.0)
    scene = el.load_scene(name, overrides=changes)
    curve = el.response_curve(scene.system(), "speed", speeds)
    found = sensitivities(scene, curve, ["links.follower"])
    length = scene.given["links"]["follower"]
    places = []
    for part in (1e-4, -1e-4):
        moved = with_numbers(scene, {"links.follower": length * (1.0 + part)})
        places.append(el.response_curve(moved.system(), "speed", speeds).special_value)
    by_difference = (places[0] - places[1]) / (2e-4 * length)
    np.testing.assert_allclose(found.derivative[:, 0], by_difference, rtol=1e-4)


def test_stresses_of_beams_by_numbers_of_the_drawing_and_by_dimensions():
    """A stiffer material at the root of that speed bears as much more; lengths by differences."""
    scene = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1})
    system, speed = scene.linear_system(), 23.0
    answer = el.stress(system, speed)
    by = ["speed", "material.modulus", "links.crank", "crank.thickness", "damping_ratio"]
    found = sensitivities(scene, answer, by)
    assert found.passed and found.value.shape == (3,)
    assert np.allclose(found.value, [one.value for one in answer.maxima.values()], rtol=1e-7)
    share = found.derivative * found.number / found.value[:, None]
    assert np.allclose(0.5 * share[:, 0] + share[:, 1], 1.0, atol=1e-8)
    # The scene gives areas and second moments: a crank's thickness is the lever of its fibre alone.
    assert np.allclose(share[1:, 3], 0.0, atol=1e-8) and 0.5 < share[0, 3] <= 1.0

    def longer(factor):
        moved = {"links.crank": factor * scene.get("links.crank")}
        return with_numbers(scene, moved).linear_system()

    def damped(factor):
        return system.with_parameters(damping_ratio=factor * system.parameters["damping_ratio"])

    def largest(moved, peak):
        motion = el.steady_state(moved, speed, rtol=1e-11, samples=512)
        return el.stress(moved, motion, stations={peak.link: [peak.place]}).maximum.value

    for row, peak in zip(share, answer.maxima.values(), strict=True):
        for place, moved in ((2, longer), (4, damped)):
            ends = [largest(moved(1.0 + step), peak) for step in (1e-5, -1e-5)]
            assert row[place] == pytest.approx((ends[0] - ends[1]) / (2e-5 * peak.value), rel=1e-6)


def test_forces_are_of_degree_two_in_the_speed_and_one_in_the_masses():
    """Of a slider-crank in a horizontal plane: masses, inertias and lengths by their degrees."""
    name = "slider_crank_example"
    scene = el.load_scene(name)
    forces = el.rigid_forces(scene.machine(), [0.4, 2.0, 5.0], 150.0)
    keys = [f"{link}.{k}" for link in ("crank", "coupler", "slider") for k in scene.given[link]]
    heavy = [k for k in keys if "mass" in k or "inertia" in k]
    found = sensitivities(scene, forces, heavy)
    total = np.sum(found.derivative * found.number, axis=-1)
    assert np.allclose(total, found.value, rtol=0, atol=1e-10 * np.max(np.abs(found.value)))
    assert found.passed and found.answer.split(", ") == list(forces.values)


def test_it_draws(tmp_path):
    scene = coupler()
    answer = el.stability_edges(scene.system(), (77.5, 105.0))
    ax = sensitivities(scene, answer, ["links.crank", "bending_stiffness"]).plot()
    assert len(ax.patches) == 2 and "for 1 % more" in ax.get_xlabel()


SYSTEM = coupler().system()
ANSWER = el.floquet_multipliers(SYSTEM, 90.0)
HELD = el.natural_frequencies(SYSTEM, 0.0)
OSCILLATOR = _softening()
CURVE = el.response_curve(OSCILLATOR, "speed", (0.6, 0.7))
FOUR_BAR, ENGINE = (el.load_scene(n) for n in ("smith_1972_12_6_12_12", "slider_crank_example"))
MOTION = FOUR_BAR.mechanism().motion([0.5, 1.0])
BEAMS = el.load_scene("aannaque_1996_table_4_1", {"mesh.elements": 1}).linear_system()
RUN_UP = el.stress(BEAMS, el.simulate(BEAMS, 20.0, revolutions=0.1))
test_refusals = refused(
    sensitivities,
    [
        (SYSTEM, ANSWER, ["stiffness"], "by"),
        (SYSTEM, ANSWER, ["links.crank"], "by"),
        (coupler(), ANSWER, ["links.crnk"], "by"),
        (coupler(), ANSWER, ["model.formulation"], "by"),
        (SYSTEM, ANSWER, [], "by"),
        (SYSTEM, ANSWER, ["speed", "speed"], "by"),
        (SYSTEM, HELD, ["speed"], "by"),
        (SYSTEM, 3.0, ["speed"], "answer"),
        ("coupler", ANSWER, ["speed"], "machine"),
        (OSCILLATOR, CURVE, ["speed"], "by"),
        (_softening(force=0.02), CURVE, ["force"], "machine"),
        (SYSTEM, CURVE, ["force"], "machine"),
        (SYSTEM, MOTION, ["links.crank"], "a Scene"),
        (ENGINE, MOTION, ["links.crank"], "another machine"),
        (coupler(), MOTION, ["links.crank"], "another machine"),
        (FOUR_BAR, MOTION, ["links.crnk"], "by"),
        (BEAMS, RUN_UP, ["elasticity"], "steady motion"),
    ],
)
