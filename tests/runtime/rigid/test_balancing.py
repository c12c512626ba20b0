"""Counterweights: the classic cases, the optimum with its proved bound, the trade-off."""

import elastolink as el
import numpy as np
import pytest
from balancing_machines import INCH, POUND, random_machine, sampled_peaks, smith
from elastolink.runtime.rigid import (
    Counterweight,
    case_counterweights,
    force_peaks,
    with_counterweights,
)
from elastolink.runtime.rigid.optimum import Cones, Design, PeakProblem, hull_minimum, least
from elastolink.runtime.rigid.peaks import TERMS
from refusals import refused

SPEED = 10.0
OFFSET = 6.0 * INCH
# The heaviest counterweight of Fig. 20 at 6 in.: 2.25 lbf on the crank of case (c).
HEAVIEST = 2.25 * POUND
FIGURE_20 = el.Bounds(mass=HEAVIEST, offset=OFFSET)
TWO, THREE = ("crank", "follower"), ("crank", "coupler", "follower")
TURN = np.linspace(0.0, 2.0 * np.pi, 7201)


def cased(machine, case, *where, **options):
    return with_counterweights(
        machine, case_counterweights(machine, case, *where, **options).values()
    )


def bodies(links, seed, across=1.0):
    rng, masses = np.random.default_rng(seed), {}
    for link in links:
        mass, x, y = rng.uniform([0.2, -0.05, -0.05], [1.0, 0.15, 0.05])
        masses[link] = el.MassDistribution.about_centre(mass, x, across * y, 0.002)
    return masses


def slider_crank(seed=1, offset=0.02, across=1.0):
    linkage = el.SliderCrank(0.1, 0.35, offset)
    return el.Machine(linkage, bodies(linkage.links, seed, across))


def quick_return():
    linkage = el.QuickReturn(0.3, 0.1, 0.5)
    return el.Machine(linkage, bodies(linkage.links, 2))


@pytest.mark.parametrize("case", ["a", "b", "c", "d"])
def test_peaks_agree_with_the_nine_equations(case):
    found = el.balance(smith(), SPEED, case=case, offsets=OFFSET)
    found.require()
    base, expected = (sampled_peaks(one, TURN, SPEED) for one in (smith(), found.machine))
    peaks = force_peaks(found.machine, SPEED)
    for name in TERMS:
        # The samples miss a peak by (dtheta/2)^2/2 of its curvature: below 1e-6 of it here.
        size = pytest.approx(expected[name], rel=2e-6, abs=1e-12 * max(expected.values()))
        assert abs(peaks[name].value) == size
        assert found.unbalanced[name] == pytest.approx(base[name], rel=2e-6)
        assert found.relative[name] * found.unbalanced[name] == size
    assert len(found.plot().patches) == len(TERMS)


def test_counterweights_of_the_cases_of_figure_20():
    wanted = {
        "a": {},
        "b": {"crank": 0.25, "follower": 1.0},
        "c": {"crank": 2.25, "coupler": 1.0, "follower": 1.0},
        "d": {"crank": 0.75, "follower": 2.0},
    }
    for case, weights in wanted.items():
        found = case_counterweights(smith(), case, OFFSET)
        masses = {link: item.mass / POUND for link, item in found.items()}
        assert masses == pytest.approx(weights)
        assert all(item.along == pytest.approx(-OFFSET) for item in found.values())
    assert set(case_counterweights(slider_crank(), "b", 0.1)) == {"crank"}


@pytest.mark.parametrize(
    ("machine", "case"),
    [
        *((random_machine(np.random.default_rng(5 + n)), "cd"[n % 2]) for n in range(6)),
        (slider_crank(), "c"),
        (slider_crank(3, 0.0), "c"),
        (quick_return(), "c"),
        (quick_return(), "d"),
    ],
)
def test_full_balance_leaves_no_momentum(machine, case):
    """Linear momentum from the motion of the centres of mass alone."""

    def momentum(of):
        motion = of.linkage.motion(TURN[::30], SPEED)
        parts = [
            of.mass(link).mass * motion.point(link, *of.mass(link).centre).velocity
            for link in of.linkage.links
        ]
        return np.ptp(np.sum(parts, axis=0), axis=0).max()

    assert momentum(cased(machine, case, 0.08)) < 1e-13 * momentum(machine)
    three = case == "c" and isinstance(machine.linkage, el.FourBar)
    assert len(case_counterweights(machine, case)) == (3 if three else 2)


def test_a_crank_counterweight_turns_the_primary_force_across_the_guide():
    machine = slider_crank(offset=0.0, across=0.0)
    coupler = machine.mass("coupler").along / machine.linkage.coupler
    amplitude = (machine.mass("slider").mass + coupler) * 0.1 * SPEED**2
    best = el.balance(machine, SPEED, weights={"shaking_force": 1.0}, links=("crank",))
    best.require()
    for fraction in (0.0, 0.4, 1.0):
        found = el.balance(machine, SPEED, case="reciprocating", offsets=0.05, fraction=fraction)
        along, across = (
            el.harmonics((found.machine, name, SPEED), order=2)
            for name in ("shaking_x", "shaking_y")
        )
        assert along.a[1] == pytest.approx((1.0 - fraction) * amplitude, abs=1e-10 * amplitude)
        assert abs(across.b[1]) == pytest.approx(fraction * amplitude, abs=1e-10 * amplitude)
        # The secondary force, m r omega^2 (r/l + (r/l)^3/4 + 15 (r/l)^5/128), stays.
        ratio = 0.1 / 0.35
        second = amplitude * (ratio + ratio**3 / 4 + 15 * ratio**5 / 128)
        assert along.a[2] == pytest.approx(second, rel=2e-4)  # of the next term's order
        assert abs(across.b[2]) < 1e-10 * amplitude
        assert best.value < found.relative["shaking_force"] * (1.0 + 1e-12)


def test_counterweight_bodies():
    disc = Counterweight("crank", 2.0, -0.3, 0.4, radius=0.1)
    assert disc.offset == pytest.approx(0.5)
    assert disc.distribution.inertia == pytest.approx(2.0 * 0.25 + 0.01)
    cylinder = Counterweight("crank", 2.0, -0.3, density=7800.0, thickness=0.02)
    assert cylinder.own_inertia == pytest.approx(0.5 * 2.0 * cylinder.disc_radius**2)
    two = with_counterweights(smith(), [disc, cylinder])
    assert two.mass("crank").mass == pytest.approx(smith().mass("crank").mass + 4.0)


# First values of this program, certified by their lower bounds to the digits given.
@pytest.mark.parametrize(
    ("frame", "links", "value"),
    [
        pytest.param("shaking_moment", TWO, 2.75353412, marks=pytest.mark.smoke),
        pytest.param("shaking_moment", THREE, 2.53946687, marks=pytest.mark.slow),
        pytest.param("shaking_force", TWO, 2.58932122, marks=pytest.mark.slow),
        ("shaking_force", THREE, 1.89083362),
    ],
)
def test_certified_values_lie_below_every_case(frame, links, value):
    weights = {"f23": 1.0, "torque": 1.0, frame: 1.0}
    found = el.balance(smith(), SPEED, weights=weights, links=links, bounds=FIGURE_20)
    found.require()
    assert found.error < 1e-8
    assert found.value == pytest.approx(value, abs=6e-9)
    assert found.lower_bound == pytest.approx(value, abs=1.2e-8)
    for case in "abcd":
        relative = el.balance(smith(), SPEED, case=case, offsets=OFFSET).relative
        assert found.value < sum(relative[term] for term in weights)
    for item in found.counterweights.values():
        assert item.mass <= HEAVIEST * (1 + 1e-12)
        assert item.offset <= OFFSET * (1 + 1e-12)
    # The nine equations know nothing of the search; their samples miss a peak by 1e-6 of it.
    base, after = (sampled_peaks(one, TURN, SPEED) for one in (smith(), found.machine))
    assert sum(after[t] / base[t] for t in weights) == pytest.approx(found.value, rel=2e-6)


@pytest.mark.parametrize("stiffness", [0.0, 0.2])
def test_lower_bounds_of_a_link_against_all_its_counterweights(stiffness):
    """The least of a linear function, and the conic bound of a peak, over a grid of bodies."""
    rng = np.random.default_rng(10)
    sides = (np.linspace(0.0, 1.0, 21), np.linspace(0.0, 1.0, 11), np.linspace(0.0, 2 * np.pi, 73))
    m, r, turn = (item.ravel() for item in np.meshgrid(*sides, indexing="ij"))
    inertia = m * (r * r + stiffness * m)
    p = np.stack([m, m * r * np.cos(turn), m * r * np.sin(turn), inertia], axis=-1)
    for gradient in rng.normal(size=(50, 4)):
        reached, lowest = float(np.min(p @ gradient)), least(gradient, stiffness)
        # Half a step of each grid, squared, with gradients of about 1.
        assert reached - 0.03 < lowest <= reached + 1e-12
    for _ in range(2):
        cone = Cones(0, rng.normal(size=(9, 2)), rng.normal(size=(9, 2, 4)))
        problem = PeakProblem(Design(np.array([stiffness])), [cone], np.ones(1), np.full(1, np.inf))
        best, bound = hull_minimum(problem)
        forces = cone.fixed[:, None] + np.einsum("ndp,kp->nkd", cone.basis, p)
        lowest = float(np.min(np.max(np.linalg.norm(forces, axis=-1), axis=0)))
        assert bound <= lowest + 1e-9
        assert bound <= problem.bounds(best)[0] + 1e-9


def test_limits_are_kept_and_cost_something_and_one_force_alone_can_be_removed():
    free = el.balance(smith(), SPEED, bounds=FIGURE_20)
    bound = el.balance(smith(), SPEED, bounds=FIGURE_20, limits={"shaking_force": 0.3})
    bound.require()
    assert free.relative["shaking_force"] > 0.31
    assert bound.relative["shaking_force"] == pytest.approx(0.3, abs=1e-7)
    assert bound.value > free.value
    # No counterweight at all meets limits of 1.
    el.balance(smith(), SPEED, limits={"torque": 1.0}).require()
    alone = el.balance(smith(), SPEED, weights={"shaking_force": 1.0}, bounds=FIGURE_20)
    assert alone.value < 1e-9
    assert alone.error < 1e-9


def test_cylinders_have_the_radius_of_their_mass():
    cylinders = el.Bounds(mass=HEAVIEST, offset=OFFSET, density=2700.0, thickness=0.003)
    heavy = el.balance(smith(), SPEED, bounds=cylinders)
    assert heavy.value > el.balance(smith(), SPEED, bounds=FIGURE_20).value
    for item in heavy.counterweights.values():
        assert np.pi * item.radius**2 * 0.003 * 2700.0 == pytest.approx(item.mass, rel=1e-9)


def test_quick_return_can_be_optimised():
    found = el.balance(quick_return(), SPEED, weights={"torque": 1.0, "shaking_force": 1.0})
    found.require()
    assert set(found.counterweights) <= {"crank", "rod"}
    assert found.value < 2.0


# Case (c) has a counterweight on the coupler: only a curve whose coupler may have one is below it.
@pytest.mark.parametrize(
    ("links", "cases", "points"),
    [(TWO, "abd", 4), pytest.param(THREE, "abcd", 8, marks=pytest.mark.slow)],
)
def test_trade_off_falls_and_lies_below_the_cases(links, cases, points):
    curve = el.trade_off(
        smith(), SPEED, points=points, bounds=FIGURE_20, offsets=OFFSET, links=links
    )
    curve.require()
    assert np.all(np.diff(curve.first_values) > 0)
    assert np.all(np.diff(curve.second_values) < 0)
    assert np.max(curve.error) < 1e-8
    # Convex, for the problem is: no point above the chord of its neighbours.
    slopes = np.diff(curve.second_values) / np.diff(curve.first_values)
    assert np.all(np.diff(slopes) > 0)
    for case in cases:
        x, y = curve.cases[case]
        # The chords lie above the curve itself; its ends may be 1e-6 worse than the least possible,
        # and every point by its error.
        allowed = 1e-6 + np.max(curve.error)
        assert np.interp(x, curve.first_values, curve.second_values) < y + allowed
    ax = curve.plot()
    assert {text.get_text() for text in ax.texts} == {"(a)", "(b)", "(c)", "(d)"}


test_bad_input_is_refused = refused(
    lambda options: el.balance(**{"machine": smith(), "speed": SPEED, **options}),
    [
        ({"weights": {"noise": 1.0}}, "weights: found 'noise'"),
        ({"weights": {"torque": -1.0}}, "zero or more"),
        ({"weights": {"torque": 0.0}}, "no weight above zero"),
        ({"links": ("rod",)}, "links: found 'rod'"),
        ({"links": ()}, "at least one"),
        ({"bounds": 3.0}, "expected Bounds"),
        ({"bounds": {"coupler": el.Bounds()}}, "bounds: found 'coupler'"),
        ({"limits": {"shaking_force": 0.0}}, "above zero"),
        ({"limits": {"f23": 0.5}}, "f23 at least 1.001"),
        ({"limits": {"torque": 0.01}}, "torque at least 1"),
        ({"angles": []}, "angles: found none"),
        ({"measure": "mean"}, "measure: found 'mean'"),
        ({"acceleration": np.nan}, "acceleration: found nan"),
        ({"case": "b", "weights": {"torque": 1.0}}, "beside case 'b'"),
        ({"case": "e"}, "case: found 'e'"),
        ({"case": "b", "offsets": 0.0}, "offsets.crank: found 0"),
        ({"case": "b", "offsets": {"rod": 0.1}}, "offsets: found 'rod'"),
        ({"case": "reciprocating"}, "for a FourBar"),
        ({"machine": el.Machine(el.FourBar(1.0, 0.9, 0.5, 0.5)), "case": "a"}, "turn fully"),
        ({"machine": slider_crank(), "links": ("slider",)}, "links: found 'slider'"),
        # Balanced already.
        (
            {"machine": cased(smith(), "d", OFFSET), "weights": {"shaking_force": 1.0}},
            "no such force",
        ),
        ({"machine": "crank"}, "machine"),
        ({"machine": "crank", "case": "b"}, "machine"),
    ],
)
FULL = {"radius": 0.1, "density": 7800.0, "thickness": 0.1}
test_impossible_bodies_bounds_and_cases_are_refused = refused(
    lambda call, given, options: call(*given, **options),
    [
        (Counterweight, ("crank", -1.0, 0.1), {}, "mass: found -1"),
        (Counterweight, ("crank", 1.0, 0.1), {"density": 7800.0}, "both density and thickness"),
        (Counterweight, ("crank", 1.0, 0.1), FULL, "found all three"),
        (
            Counterweight,
            ("crank", 1.0, 0.1),
            {"density": -1.0, "thickness": 0.1},
            "density: found -1",
        ),
        (with_counterweights, (smith(), [Counterweight("rod", 1.0, 0.1)]), {}, "found 'rod'"),
        (with_counterweights, (None, ()), {}, "machine"),
        (force_peaks, ("crank", 1.0), {}, "machine"),
        (el.trade_off, ("crank", 1.0), {}, "machine"),
        (el.Bounds, (0.0,), {}, "mass: found 0"),
        (el.Bounds, (), {"density": 7800.0}, "both density and thickness"),
        (case_counterweights, ("crank", "a"), {}, "machine"),
        (case_counterweights, (slider_crank(), "d"), {}, "case: found 'd'"),
        (
            case_counterweights,
            (slider_crank(), "b", {"slider": -0.1, "crank": -0.1}),
            {},
            "found -0.1",
        ),
        (case_counterweights, (slider_crank(), "reciprocating"), {"fraction": np.nan}, "fraction"),
    ],
)
