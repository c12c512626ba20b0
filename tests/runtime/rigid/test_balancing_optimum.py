from dataclasses import replace

import balancing_truth as truth
import numpy as np
import pytest
from balancing_machines import (
    nine_equations,
    random_machine,
    sampled_peaks,
    smith,
    with_crank_counterweight,
)
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.rigid import (
    Bounds,
    Counterweight,
    balance,
    balance_case,
    peaks_of,
    trade_off,
    with_counterweights,
)
from elastolink.runtime.rigid.barrier import Cones, PeakProblem, Room, _Barrier
from elastolink.runtime.rigid.designs import BalancedLinkDesign, PointDesign
from elastolink.runtime.rigid.force_basis import TERMS, ForceBasis
from elastolink.runtime.rigid.machine import Machine

SPEED = 10.0
OFFSET = 6.0 * truth.INCH
# The heaviest counterweight of Fig. 20 at 6 in.: 2.25 lbf on the crank of case (c).
HEAVIEST = 2.25 * truth.POUND
FIGURE_20 = Bounds(mass=HEAVIEST, offset=OFFSET)
TWO, THREE = ("crank", "follower"), ("crank", "coupler", "follower")
TURN = np.linspace(0.0, 2.0 * np.pi, 1441)


def weighted(machine, weights):
    base, found = peaks_of(smith(), SPEED), peaks_of(machine, SPEED)
    return sum(weight * found[term] / base[term] for term, weight in weights.items())


@pytest.mark.parametrize("frame", ["shaking_force", "shaking_moment"])
@pytest.mark.parametrize("links", [TWO, THREE])
def test_optimum_is_below_every_case_of_figure_20(frame, links):
    weights = {"f23": 1.0, "torque": 1.0, frame: 1.0}
    found = balance(smith(), SPEED, weights=weights, links=links, bounds=FIGURE_20)
    found.require()
    assert found.error < 1e-8
    for case in "abcd":
        assert found.value < weighted(balance_case(smith(), case, OFFSET), weights)
    for item in found.counterweights.values():
        assert item.mass <= HEAVIEST * (1 + 1e-12)
        assert item.offset <= OFFSET * (1 + 1e-12)
    # The nine equations know nothing of the search; their samples miss a peak by 1e-5 of it.
    base = sampled_peaks(smith(), TURN, SPEED)
    after = sampled_peaks(found.machine, TURN, SPEED)
    assert sum(after[t] / base[t] for t in weights) == pytest.approx(found.value, rel=2e-5)


# First values of this program, certified by their lower bounds to the digits given.
@pytest.mark.parametrize(
    ("frame", "links", "value"),
    [
        ("shaking_moment", TWO, 2.75353412),
        ("shaking_moment", THREE, 2.53946687),
        ("shaking_force", TWO, 2.58932122),
        ("shaking_force", THREE, 1.89083362),
    ],
)
def test_certified_values(frame, links, value):
    weights = {"f23": 1.0, "torque": 1.0, frame: 1.0}
    found = balance(smith(), SPEED, weights=weights, links=links, bounds=FIGURE_20)
    assert found.value == pytest.approx(value, abs=6e-9)
    assert found.lower_bound == pytest.approx(value, abs=1.2e-8)


def test_three_counterweights_at_six_inches_beat_case_c():
    bounds = Bounds(mass=HEAVIEST, offset=OFFSET, least_offset=OFFSET)
    found = balance(smith(), SPEED, links=THREE, bounds=bounds)
    for item in found.counterweights.values():
        assert item.offset == pytest.approx(OFFSET, rel=1e-9)
    assert found.value < weighted(balance_case(smith(), "c", OFFSET), found.weights) - 0.5


def test_no_random_counterweights_come_below_the_bound():
    rng = np.random.default_rng(3)
    for seed in range(3):
        machine = random_machine(np.random.default_rng(seed))
        found = balance(machine, SPEED, links=THREE, bounds=Bounds(mass=1.0, offset=0.4))
        base = sampled_peaks(machine, TURN, SPEED)
        for _ in range(150):
            added = []
            for link in THREE:
                radius, angle = 0.4 * np.sqrt(rng.uniform()), rng.uniform(0.0, 2.0 * np.pi)
                place = radius * np.cos(angle), radius * np.sin(angle)
                added.append(Counterweight(link, rng.uniform(), *place))
            after = sampled_peaks(with_counterweights(machine, added), TURN, SPEED)
            value = sum(after[t] / base[t] for t in found.weights)
            assert value > found.lower_bound * (1 - 1e-4)


def test_neighbours_of_the_optimum_are_no_better():
    found = balance(smith(), SPEED, links=THREE, bounds=FIGURE_20)
    rng = np.random.default_rng(4)
    for _ in range(60):
        added = []
        for item in found.counterweights.values():
            shift = 10.0 ** rng.uniform(-5, -2) * rng.normal(size=3)
            mass = min(item.mass * (1.0 + shift[0]), HEAVIEST)
            place = np.array([item.along, item.across]) + OFFSET * shift[1:]
            place *= min(1.0, OFFSET / np.hypot(*place))
            added.append(Counterweight(item.link, mass, *place))
        moved = with_counterweights(smith(), added)
        assert weighted(moved, found.weights) > found.value - 1e-12


def test_forces_are_linear_in_the_parameters():
    rng = np.random.default_rng(6)
    machine = random_machine(rng)
    basis = ForceBasis(machine, THREE, 7.0, 30.0, TERMS, np.full(3, 0.8), np.full(3, 0.3))
    theta = np.linspace(0.0, 6.0, 37)
    points = [Counterweight(k, *rng.uniform(0.1, 0.6, 3), radius=0.1) for k in THREE]
    p = []
    for item in points:
        own = item.distribution
        moment = 0.8 * 0.3
        p += [own.mass / 0.8, own.along / moment, own.across / moment, own.inertia / (0.3 * moment)]
    fixed, unit = basis.forces(theta), basis.unit_forces(theta)
    expected = nine_equations(with_counterweights(machine, points), theta, 7.0, 30.0)
    for term in TERMS:
        found = (fixed[term] + unit[term] @ np.array(p)).squeeze()
        np.testing.assert_allclose(
            found, expected[term], rtol=0, atol=1e-11 * np.abs(expected[term]).max()
        )


def test_weight_is_part_of_the_basis():
    machine = replace(random_machine(np.random.default_rng(11)), gravity=(1.0, -9.81))
    basis = ForceBasis(machine, THREE, 7.0, 0.0, TERMS, np.full(3, 0.8), np.full(3, 0.3))
    theta = np.linspace(0.0, 6.0, 37)
    p = np.array([0.4, 0.1, 0.2, 0.3, 0.5, -0.1, 0.2, 0.3, 0.6, 0.1, -0.3, 0.4])
    fixed, unit = basis.forces(theta), basis.unit_forces(theta)
    for term, expected in basis.forces(theta, p).items():
        np.testing.assert_allclose(
            fixed[term] + unit[term] @ p, expected, rtol=0, atol=1e-11 * np.abs(expected).max()
        )


ROOMS = (Room(), Room(0.3, 0.2, 0.4), Room(0.0, 0.5, 0.0))


def five_points(function, x, step=1e-2):
    """Derivative by five points: exact for the polynomials here, but for round-off."""
    columns = []
    for unit in np.eye(len(x)):
        a, b, c, d = (function(x + k * step * unit) for k in (-2, -1, 1, 2))
        columns.append((a - 8 * b + 8 * c - d) / (12 * step))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("design", [PointDesign(ROOMS), BalancedLinkDesign(0.2)])
def test_exact_derivatives_of_the_designs(design):
    rng = np.random.default_rng(7)
    low, _ = design.box
    x = rng.uniform(0.2, 0.6, len(low))
    np.testing.assert_allclose(five_points(design.parameters, x), design.jacobian(x), atol=1e-12)
    price = rng.normal(size=len(design.parameters(x)))
    np.testing.assert_allclose(
        five_points(lambda y: price @ design.jacobian(y), x),
        design.curvature(x, price),
        atol=1e-12,
    )
    for part in (design.conditions, design.equations):
        _, slope, bend = part(x)
        if len(slope):
            np.testing.assert_allclose(five_points(lambda y, f=part: f(y)[0], x), slope, atol=1e-12)
            np.testing.assert_allclose(five_points(lambda y, f=part: f(y)[1], x), bend, atol=1e-12)


@pytest.mark.parametrize("room", [*ROOMS, Room(1.0), Room(1.0, 0.2)])
def test_exact_derivatives_of_the_barrier(room):
    rng = np.random.default_rng(9)
    cones = [
        Cones(0, rng.normal(size=(9, 2)), rng.normal(size=(9, 2, 8))),
        Cones(1, rng.normal(size=(5, 1)), rng.normal(size=(5, 1, 8))),
    ]
    problem = PeakProblem([room, room], cones, np.array([1.0, 2.0]), np.array([50.0, np.inf]))
    barrier = _Barrier(problem)
    z = barrier.free(problem.centre(), problem.lifted(problem.centre(), 0.4))
    z[1:3] += 0.05, -0.03

    def value(y):
        return 3.0 * barrier.cost @ y - np.sum(np.log(barrier.slacks(y)))

    gradient, hessian = barrier.derivatives(z, 3.0)
    # Truncation of five points with this step, against third and higher derivatives of a
    # logarithm with slacks above 0.05.
    np.testing.assert_allclose(five_points(value, z, 1e-4), gradient, rtol=1e-7, atol=1e-6)
    slope = five_points(lambda y: barrier.derivatives(y, 3.0)[0], z, 1e-4)
    np.testing.assert_allclose(slope, hessian, rtol=1e-6, atol=1e-6 * np.abs(hessian).max())


def test_lower_bound_of_a_room_is_the_least_over_its_counterweights():
    rng = np.random.default_rng(10)
    masses, turns = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 2.0 * np.pi, 73)
    for room in (*ROOMS, Room(1.0), Room(0.5, 0.3, 0.1)):
        offsets = np.linspace(room.nearest, 1.0, 21)
        m, r, turn, q = (
            item.ravel()
            for item in np.meshgrid(masses, offsets, turns, [0.0, room.own], indexing="ij")
        )
        inertia = m * (r * r + room.stiffness * m + q)
        p = np.stack([m, m * r * np.cos(turn), m * r * np.sin(turn), inertia], axis=-1)
        for gradient in rng.normal(size=(50, 4)):
            reached, least = float(np.min(p @ gradient)), room.least(gradient)
            assert least <= reached + 1e-12
            # Half a step of each grid, squared, with gradients of about 1.
            assert reached - least < 0.01


def test_root_mean_square_of_the_shaking_force_by_least_squares():
    # With the crank's first moments alone, the mean square is a quadratic form: closed form.
    for seed in range(5):
        machine = random_machine(np.random.default_rng(seed))
        found = with_crank_counterweight(machine, SPEED)
        theta = TURN[:-1]
        force = nine_equations(machine, theta, SPEED)["shaking_force"]
        turned = SPEED**2 * np.exp(1j * theta)  # of a unit moment: its centrifugal force
        along = np.stack([turned.real, turned.imag], axis=-1).ravel()
        across = np.stack([-turned.imag, turned.real], axis=-1).ravel()
        best, left = np.linalg.lstsq(
            np.stack([along, across], axis=-1), -force.ravel(), rcond=None
        )[:2]
        item = found.counterweights["crank"]
        moment = item.mass * np.array([item.along, item.across])
        np.testing.assert_allclose(moment, best, atol=1e-7 * np.hypot(*best))
        assert found.value == pytest.approx(np.sqrt(left[0] / np.sum(force**2)), rel=1e-12)


def test_limits_are_kept_and_cost_something():
    free = balance(smith(), SPEED, bounds=FIGURE_20)
    bound = balance(smith(), SPEED, bounds=FIGURE_20, limits={"shaking_force": 0.3})
    bound.require()
    assert free.relative["shaking_force"] > 0.31
    assert bound.relative["shaking_force"] == pytest.approx(0.3, abs=1e-7)
    assert bound.value > free.value


def test_shaking_force_alone_can_be_removed():
    found = balance(smith(), SPEED, weights={"shaking_force": 1.0}, bounds=FIGURE_20)
    assert found.value < 1e-7
    assert found.error < 1e-7


def test_value_does_not_depend_on_units():
    plain = balance(smith(), SPEED, bounds=FIGURE_20)
    lengths = {name: 1000.0 * size for name, size in smith().linkage.lengths.items()}
    masses = {
        link: type(own)(5.0 * own.mass, 5e3 * own.along, 0.0, 5e6 * own.inertia)
        for link, own in smith().masses.items()
    }
    scaled = balance(
        Machine(FourBar(**lengths), masses),
        3.0 * SPEED,
        bounds=Bounds(mass=5.0 * HEAVIEST, offset=1000.0 * OFFSET),
    )
    assert scaled.value == pytest.approx(plain.value, abs=2e-9)


def test_given_angles_count_alone():
    machine = Machine(FourBar(1.0, 0.9, 0.5, 0.5), smith().masses)  # a rocking crank
    theta = np.linspace(0.6, 0.9, 21)
    found = balance(machine, SPEED, angles=theta, bounds=Bounds(mass=1.0, offset=0.5))
    base = sampled_peaks(machine, theta, SPEED)
    after = sampled_peaks(found.machine, theta, SPEED)
    assert sum(after[t] / base[t] for t in found.weights) == pytest.approx(found.value, abs=1e-9)
    assert found.value < 3.0


def test_heavy_cylinders_are_kept_further_out():
    thin = Bounds(mass=HEAVIEST, offset=OFFSET, density=2700.0, thickness=0.003)
    point = balance(smith(), SPEED, bounds=FIGURE_20)
    cylinder = balance(smith(), SPEED, bounds=thin)
    assert cylinder.value > point.value
    assert all(item.radius > 0 for item in cylinder.counterweights.values())
    # The radius is that of the mass.
    for item in cylinder.counterweights.values():
        assert np.pi * item.radius**2 * 0.003 * 2700.0 == pytest.approx(item.mass, rel=1e-9)


# Case (c) has a counterweight on the coupler: only a curve whose coupler may have one is below it.
@pytest.mark.parametrize(
    ("links", "cases", "points"),
    [(TWO, "abd", 3), pytest.param(THREE, "abcd", 6, marks=pytest.mark.slow)],
)
def test_trade_off_falls_and_lies_below_the_cases(links, cases, points):
    curve = trade_off(smith(), SPEED, points=points, bounds=FIGURE_20, offsets=OFFSET, links=links)
    curve.require()
    assert np.all(np.diff(curve.first_values) > 0)
    assert np.all(np.diff(curve.second_values) < 0)
    assert np.max(curve.error) < 1e-6
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


def test_picture_has_a_bar_for_each_force():
    found = balance(smith(), SPEED, bounds=FIGURE_20)
    assert len(found.plot().patches) == len(TERMS)


@pytest.mark.parametrize(
    "options",
    [
        {"weights": {"noise": 1.0}},
        {"weights": {"torque": -1.0}},
        {"weights": {"torque": 0.0}},
        {"weights": {"torque": "much"}},
        {"links": ("rod",)},
        {"links": ()},
        {"links": ("crank", "crank")},
        {"bounds": 3.0},
        {"bounds": {"coupler": Bounds()}},
        {"limits": {"shaking_force": 0.0}},
        {"limits": {"f23": 0.5}},
        {"angles": []},
        {"angles": ["a"]},
        {"measure": "mean"},
        {"acceleration": np.nan},
        {"acceleration": "much"},
        {"bounds": Bounds(least_offset=10.0)},
    ],
)
def test_bad_input_is_one_line(options):
    with pytest.raises(BadInput) as caught:
        balance(smith(), SPEED, **options)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "options",
    [{"mass": 0.0}, {"radius": -1.0}, {"offset": 1.0, "least_offset": 2.0}, {"density": 1.0}],
)
def test_impossible_bounds(options):
    with pytest.raises(BadInput):
        Bounds(**options)


def test_a_force_that_is_zero_has_no_relative_peak():
    balanced = balance_case(smith(), "d", OFFSET)
    with pytest.raises(BadInput, match="no such force"):
        balance(balanced, SPEED, weights={"shaking_force": 1.0})
