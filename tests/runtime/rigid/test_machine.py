"""Machines: refusals, and springs, dampers and loads against their own potentials and powers."""

import math

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.trigonometric import differentiated
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank
from elastolink.runtime.rigid import Load, Machine, MassDistribution, Spring, TorsionSpring
from refusals import refused

LINKAGE = FourBar(0.3, 0.1, 0.28, 0.25)
THETA = np.linspace(0.0, 2.0 * np.pi, 256, endpoint=False)
LINKAGES = [
    LINKAGE,
    FourBar(0.3, 0.1, 0.28, 0.25, "crossed"),
    SliderCrank(0.1, 0.35, 0.04),
    QuickReturn(0.3, 0.1, 0.6),
]


@pytest.mark.parametrize("linkage", LINKAGES, ids=lambda item: type(item).__name__)
def test_weights_and_springs_pull_down_their_potential(linkage) -> None:
    _, second, third = linkage.links
    heavy = {link: MassDistribution.about_centre(0.5, 0.08, 0.03, 0.01) for link in linkage.links}
    springs = (
        Spring(("frame", -0.2, 0.5), (second, 0.05, 0.02), 300.0, free_length=0.1, preload=4.0),
        Spring(("crank", 0.05, 0.0), (third, 0.1, 0.2), 500.0),
        TorsionSpring("crank", second, 3.0, free_angle=0.2, preload=-1.0),
    )
    sources = [{"masses": heavy, "gravity": (1.0, -9.81)}]
    sources += [{"springs": (spring,)} for spring in springs[:2]]
    for source in sources:
        machine = Machine(linkage, **source)
        power = machine.power(THETA, 2.0, "all")
        slope = differentiated(machine.potential_energy(THETA), 2.0 * np.pi)
        # Spectral differentiation of 256 samples: round-off times the highest harmonic.
        np.testing.assert_allclose(power, -2.0 * slope, atol=1e-11 * np.max(np.abs(slope)))
    # Relative angles grow over a turn: a finite difference there.
    machine = Machine(linkage, springs=springs[2:])
    h = 1e-3
    offsets, weights = np.array([-2, -1, 1, 2]) * h, np.array([1, -8, 8, -1]) / (12 * h)
    slope = sum(
        w * machine.potential_energy(THETA + d) for w, d in zip(weights, offsets, strict=True)
    )
    # The five-point rule is off by h^4/30 times a fifth derivative, here below 1e4.
    np.testing.assert_allclose(machine.power(THETA, 2.0, "all"), -2.0 * slope, atol=1e-8)


def test_dampers_take_what_their_rate_says() -> None:
    damper = Spring(("frame", 0.1, 0.4), ("coupler", 0.1, 0.05), damping=12.0)
    machine = Machine(LINKAGE, springs=(damper,))
    motion = LINKAGE.motion(THETA, 5.0)
    end = motion.point("coupler", 0.1, 0.05)
    arm = end.position - np.array([0.1, 0.4])
    rate = np.sum(arm * end.velocity, axis=-1) / np.hypot(*arm.T)
    np.testing.assert_allclose(machine.power(THETA, 5.0), -12.0 * rate**2, atol=1e-13)
    turning = Machine(LINKAGE, springs=(TorsionSpring("coupler", "follower", damping=0.3),))
    expected = -0.3 * (motion.omega3 - motion.omega4) ** 2
    np.testing.assert_allclose(turning.power(THETA, 5.0), expected, atol=1e-13)


def test_a_load_works_where_it_acts() -> None:
    motion = LINKAGE.motion(THETA, 5.0)
    point, link = motion.point("coupler", 0.1, 0.05), motion.link("coupler")
    ahead = np.stack([np.cos(link.angle), np.sin(link.angle)], axis=-1)
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
    fixed = Load("coupler", (3.0, -2.0), 0.7, 0.1, 0.05)
    carried = Load("coupler", (3.0, -2.0), 0.7, 0.1, 0.05, axes="link")
    turned = Load("coupler", lambda t: (np.cos(t), 2.0), lambda t: np.sin(t), 0.1, 0.05)
    expected = {
        fixed: np.array([3.0, -2.0]) * np.ones((THETA.size, 1)),
        carried: 3.0 * ahead - 2.0 * aside,
        turned: np.stack([np.cos(THETA), np.full(THETA.shape, 2.0)], axis=-1),
    }
    for load, force in expected.items():
        couple = np.sin(THETA) if load is turned else 0.7
        power = np.sum(force * point.velocity, axis=-1) + couple * link.speed
        found = Machine(LINKAGE, loads=(load,)).power(THETA, 5.0)
        np.testing.assert_allclose(found, power, atol=1e-13 * np.max(np.abs(power)))
    drag = Load("follower", lambda at: -2.0 * at.velocity, along=0.25, given="motion")
    found, speed = Machine(LINKAGE, loads=(drag,)).power(THETA, 5.0), 0.25 * motion.omega4
    np.testing.assert_allclose(found, -2.0 * speed**2, atol=1e-13)


def test_every_problem_is_listed_at_once() -> None:
    with pytest.raises(BadInput) as refusal:
        Machine(
            LINKAGE,
            {"slider": MassDistribution(), "crank": 3.0},
            gravity=(0.0, math.nan),
            loads=(Load("rod"),),
            springs=(TorsionSpring("crank", "rod"), 3.0),
        )
    assert len(refusal.value.problems) == 6


test_refusals = refused(
    lambda make: make(),
    [
        (lambda: Machine(3.0), "linkage: found float"),
        (lambda: Machine(LINKAGE, [1.0]), "masses: found list"),
        (lambda: Machine(LINKAGE, gravity=9.81), "gravity: found 9.81"),
        (lambda: Machine(LINKAGE, loads=Load("crank")), "loads: found Load"),
        (lambda: Load("crank", (1.0,)), "force: found"),
        (lambda: Load("crank", (1.0, math.inf)), "force: found"),
        (lambda: Load("crank", axes="global"), "axes: found 'global'"),
        (lambda: Load("crank", given="speed"), "given: found 'speed'"),
        (lambda: Spring(("frame", 0.0, 0.0), ("frame", 1.0, 0.0), 3.0), "both ends on 'frame'"),
        (lambda: Spring(("frame", 0.0), ("crank", 1.0, 0.0), 3.0), "first: found"),
        (lambda: Spring(("frame", 0.0, 0.0), ("crank", 1.0, 0.0), -3.0), "stiffness: found -3"),
        (lambda: TorsionSpring("crank", "crank", 1.0), "both ends on 'crank'"),
    ],
)


@pytest.mark.parametrize(
    ("name", "law", "given", "told"),
    [
        ("force", lambda t: "x", "angle", ""),
        ("force", lambda t: (1.0, 2.0, 3.0), "angle", ""),
        ("force", lambda t: (math.nan, 0.0), "angle", ""),
        # Components along the first axis.
        ("force", lambda t: np.array([np.cos(t), 2.0 + t]), "angle", ""),
        ("force", lambda at: np.array([np.cos(at.theta), 2.0 + at.theta]), "motion", ""),
        ("couple", lambda t: t[:, 1], "angle", ".*IndexError"),
        ("couple", lambda t: t @ np.ones(4), "angle", ".*ValueError"),
    ],
)
@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_a_callable_that_returns_nonsense_or_fails_is_named(name, law, given, told, count) -> None:
    machine = Machine(LINKAGE, loads=(Load("coupler", **{name: law}, given=given),))
    with pytest.raises(BadInput, match=rf"Load\.{name} on coupler{told}"):
        machine.power(THETA[:count], 1.0)


def test_what_is_no_mistake_of_shape_or_type_is_the_callables_own_affair() -> None:
    with pytest.raises(AttributeError):
        Machine(LINKAGE, loads=(Load("coupler", couple=lambda t: t.x),)).power(THETA, 1.0)


@pytest.mark.parametrize("given", ["angle", "motion"])
def test_two_angles_may_have_two_components(given) -> None:
    def law(at):
        theta = at if given == "angle" else at.theta
        return np.stack([np.cos(theta), 2.0 + theta], axis=-1)

    pair = Load("coupler", lambda theta: (np.cos(theta), 2.0 + theta))
    expected = Machine(LINKAGE, loads=(pair,)).power(THETA[3:5], 1.0)
    machine = Machine(LINKAGE, loads=(Load("coupler", law, given=given),))
    np.testing.assert_array_equal(machine.power(THETA[3:5], 1.0), expected)
    both = machine.power(THETA[3:7].reshape(2, 2), np.array([[1.0], [2.0]]))
    assert both.shape == (2, 2)
    # A force that depends on no angle, for two angles.
    constant = Load("coupler", lambda theta: np.array([3.0, -1.0]))
    assert Machine(LINKAGE, loads=(constant,)).power(THETA[3:5], 1.0).shape == (2,)


def test_a_spring_whose_points_meet_has_no_direction() -> None:
    met = Spring(("frame", 0.1, 0.0), ("crank", 0.1, 0.0), 100.0, free_length=0.05)
    with pytest.raises(BadInput, match="meet"):
        Machine(LINKAGE, springs=(met,)).power([0.0], 1.0, "all")
    bare = Spring(("frame", 0.1, 0.0), ("crank", 0.1, 0.0), 100.0)
    assert Machine(LINKAGE, springs=(bare,)).power([0.0], 1.0, "all")[0] == 0.0
