"""Numbers that were planted and are fitted again; what one point cannot tell; files of points."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import elastolink as el
import numpy as np
import pytest
from elastolink import BadInput
from elastolink.runtime.design import Point, identify, read_points

RPM = np.pi / 30.0
STIFFNESS, INERTIA = "bending_stiffness", "follower_inertia"


@cache
def coupler(damping: float = 0.0):
    """Return Smith's coupler, whose regions lie at 620 and 761 rpm."""
    return el.load_scene("smith_1972_5152_sixteenth_inch").system().with_parameters(damping=damping)


@cache
def ends() -> tuple[Point, ...]:
    """Return the ends of its two regions, as computed."""
    edges = el.stability_edges(coupler(), (60.0, 90.0))
    both = (("unstable from", edges.lower), ("unstable to", edges.upper))
    return tuple(Point(kind, speed) for kind, speeds in both for speed in speeds.tolist())


@cache
def ringing() -> tuple[Point, ...]:
    """Return two resonances of the damped coupler and the deflection beside one, as computed."""
    system = coupler(0.05)
    found = el.critical_speeds(system, (300.0 * RPM, 400.0 * RPM), method="response").speed
    assert len(found) == 2
    speed = 1.004 * float(found[-1])
    state = el.steady_state(system, [speed], rtol=1e-9)
    deflection = system.largest_deflection(state.theta, state.q) * system.reference_length
    points = [Point("resonance", value) for value in found.tolist()]
    return (*points, Point("deflection", speed, deflection))


def noisy(points, random, part: float) -> list[Point]:
    """Return points with normal deviations, which they tell."""
    made = []
    for point in points:
        wrong = part * point.measured
        value = point.measured + wrong * random.standard_normal()
        name = "speed" if point.deflection is None else "deflection"
        made.append(replace(point, **{name: value}, deviation=wrong))
    return made


def started(system, **factors: float):
    """Return a system with other numbers to start from."""
    numbers = {name: factor * system.parameters[name] for name, factor in factors.items()}
    return system.with_parameters(**numbers)


def test_planted_stiffness_and_inertia_are_found_from_the_ends_of_regions():
    begin = started(coupler(), **{STIFFNESS: 1.08, INERTIA: 0.8})
    found = identify(begin, ends(), [STIFFNESS, INERTIA])
    exact = [coupler().parameters[name] for name in found.unknown]
    assert found.value == pytest.approx(exact, rel=1e-6)
    assert np.all(found.decided) and not found.undecided and found.passed
    assert found.computed == pytest.approx(found.measured, rel=1e-7)
    assert found.start == pytest.approx([1.08 * exact[0], 0.8 * exact[1]], rel=1e-14)


def test_planted_stiffness_and_damping_are_found_from_resonances_and_a_deflection():
    begin = started(coupler(0.05), **{STIFFNESS: 1.03, "damping": 1.5})
    found = identify(begin, ringing(), [STIFFNESS, "damping"])
    exact = [coupler(0.05).parameters[name] for name in found.unknown]
    assert found.value == pytest.approx(exact, rel=1e-5)
    assert np.all(found.decided) and found.passed


@pytest.mark.parametrize(
    "seed", [pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3, 4)]
)
def test_standard_errors_cover_planted_numbers(seed):
    """Three of them in 98 % of 30 sets of each seed; of 300 by hand in all, one in 70 %."""
    random, inside = np.random.default_rng(seed), []
    exact = np.array([coupler().parameters[name] for name in (STIFFNESS, INERTIA)])
    for _ in range(30):
        found = identify(coupler(), noisy(ends(), random, 5e-4), [STIFFNESS, INERTIA])
        assert np.all(found.decided)
        inside += (np.abs(found.value - exact) <= 3.0 * found.deviation).tolist()
    assert np.mean(inside) >= 0.98


DAMPED = (79.32853744, 80.04444889)  # ends of region 4 with a damping of 0.3 [rad/s]


@pytest.mark.parametrize("told", [True, pytest.param(False, marks=pytest.mark.slow)])
@pytest.mark.parametrize("start", [0.05, pytest.param(0.2, marks=pytest.mark.slow)])
def test_damping_is_found_from_where_the_ends_hardly_feel_it(start, told):
    """Ends shift with its square: at 0.05 by a sixth of what they do at 0.3."""
    points = [
        Point(kind, speed, deviation=0.02 if told else None)
        for kind, speed in zip(("unstable from", "unstable to"), DAMPED, strict=True)
    ]
    found = identify(coupler(start), points, ["damping"])
    assert found.value == pytest.approx([0.3], rel=1e-6) and np.all(found.decided)


@pytest.mark.slow
def test_a_step_that_closes_the_region_is_none():
    """Ends known to a millionth, from far off: more damping leaves no region to compare."""
    point = Point("unstable from", DAMPED[0], deviation=1e-4)
    found = identify(coupler(0.05), [point], ["damping"])
    assert found.value == pytest.approx([0.3], rel=1e-5)
    assert found.computed == pytest.approx(found.measured, rel=1e-8)


def test_a_resonance_that_hardly_stands_out_is_found():
    """The tenth part of the frequency: a peak of one per cent, 0.002 rad/s wide."""
    found = identify(coupler(0.002), [Point("resonance", 16.34579802, deviation=0.01)], [STIFFNESS])
    assert found.value == pytest.approx(found.start, rel=1e-7)


def test_stiffness_and_mass_of_which_one_ratio_is_sharp_are_open_together():
    """What is decided is said of both or of neither."""
    for part in (3e-3, 3e-2):
        points = [replace(point, deviation=part * point.speed) for point in ends()]
        found = identify(coupler(), points, [STIFFNESS, "mass_per_length"])
        assert found.decided[0] == found.decided[1]
        assert np.all(found.decided) == (not found.undecided)
        if found.undecided:
            assert all(name in found.undecided[0] for name in found.unknown)


def test_as_many_points_as_numbers_are_met_without_a_standard_error():
    begin = started(coupler(), **{STIFFNESS: 1.05})
    found = identify(begin, ends()[:1], [STIFFNESS])
    assert found.value == pytest.approx([coupler().parameters[STIFFNESS]], rel=1e-6)
    assert np.isnan(found.deviation[0]) and found.decided[0] and np.isnan(found.scatter)
    assert np.all(np.isnan(found.without)) and np.isnan(found.residual[0])
    # A resonance off by a thousandth says nothing of the damping, exactly as it could be met.
    off = replace(ringing()[1], speed=1.001 * ringing()[1].speed)
    found = identify(coupler(0.05), [off], ["damping"])
    assert not found.decided[0] and found.value == pytest.approx([0.05], rel=1e-12)


def test_one_observation_does_not_decide_two_unknowns():
    point = ends()[0]
    found = identify(coupler(), [replace(point, deviation=0.1)], [STIFFNESS, INERTIA])
    assert not np.any(found.decided) and np.all(np.isinf(found.deviation))
    (words,) = found.undecided
    assert "not decided" in words and STIFFNESS in words and INERTIA in words
    assert found.computed == pytest.approx(found.measured, rel=1e-8)
    # Along what is said to be open, the observation stays: 1 % of the one for so much of the other.
    rise = float(words.rsplit(" by ", 1)[1].split(" %")[0])
    first = words.split("if ")[1].split(" changes")[0]
    other = ({STIFFNESS, INERTIA} - {first}).pop()
    moved = started(coupler(), **{first: 1.01, other: 1.0 + 0.01 * rise})
    edges = el.stability_edges(moved, (60.0, 90.0))
    assert abs(edges.lower[0] / point.speed - 1.0) < 3e-4


def test_points_of_a_machine_with_several_inertias_are_fitted_together():
    """Stiffness and mass, of which the inertia over the mass alone moves a region."""
    points = []
    for factor in (1.0, 1.6):
        inertia = factor * coupler().parameters[INERTIA]
        edges = el.stability_edges(coupler(), (70.0, 84.0), **{INERTIA: inertia})
        ends_of = (("unstable from", edges.lower[0]), ("unstable to", edges.upper[0]))
        points += [Point(kind, float(v), given={INERTIA: inertia}) for kind, v in ends_of]
    names = [STIFFNESS, "mass_per_length"]
    found = identify(started(coupler(), **{names[0]: 1.05, names[1]: 0.97}), points, names)
    assert found.value == pytest.approx([coupler().parameters[name] for name in names], rel=1e-6)
    assert found.passed and np.all(found.decided)


def test_damping_that_no_point_depends_on_is_left_where_it_is():
    """Undamped regions' ends hardly feel it, and a resonance's speed as little."""
    points = [replace(point, deviation=1e-3 * point.speed) for point in ringing()[:2]]
    found = identify(coupler(0.05), points, [STIFFNESS, "damping"])
    assert found.decided.tolist() == [True, False]
    assert found.value[1] == pytest.approx(0.05, rel=1e-3)
    assert found.undecided == ("damping is not decided: the points hardly depend on it",)


@pytest.mark.slow
def test_values_without_a_point_are_those_of_a_fit_without_it():
    points = noisy(ends(), np.random.default_rng(5), 5e-4)
    found = identify(coupler(), points, [STIFFNESS, INERTIA])
    for i in range(len(points)):
        rest = [point for k, point in enumerate(points) if k != i]
        again = identify(coupler(), rest, [STIFFNESS, INERTIA])
        off = np.abs(again.value - found.without[i])
        # To first order: a tenth of what leaving it out does, or of the standard error.
        assert np.all(off <= 0.1 * np.maximum(np.abs(again.value - found.value), found.deviation))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"points": []}, "points: found"),
        ({"points": [1.0]}, "points: found"),
        ({"unknown": []}, "unknown: found"),
        ({"unknown": ["mass"]}, "unknown: found 'mass'"),
        ({"unknown": ["damping"]}, "damping: found 0.0"),
        ({"unknown": [STIFFNESS, STIFFNESS]}, "different names"),
        ({"window": 0.0}, "window: found 0.0"),
        ({"system": None}, "system: found"),
        (
            {"system": started(coupler(), **{STIFFNESS: 1.25}), "points": ends()[1:2]},
            "computed ones at 692.034 and 841.74 rpm; expected one that is clearly the nearest",
        ),
        ({"points": [Point("unstable to", 79.0, given={"mass": 1.0})]}, "point 1: found 'mass'"),
        ({"points": [Point("unstable to", 79.0, given={STIFFNESS: 1.0})]}, "known or unknown"),
        (
            {"points": [Point("unstable from", 130.0)], "window": 0.03},
            "point 1: found unstable from at 1241.41 rpm",
        ),
        (
            {"points": [Point("unstable to", 79.0), Point("unstable from", 79.0, deviation=1.0)]},
            "found 1 of 2 deviations",
        ),
    ],
)
def test_what_cannot_be_fitted_is_refused(change, words):
    given = {"system": coupler(), "points": ends(), "unknown": [STIFFNESS], **change}
    with pytest.raises(BadInput) as refused:
        identify(given.pop("system"), **given)
    assert words in str(refused.value)


RIG = "smith_1972_101104_thirtysecond_inch"
LBF_IN_S2 = 0.112984829  # kg m^2, to nine digits
# Section 9.5.3 of Smith (1972): what is seen, the speed [rpm], the inertia [lbf in s^2].
QUOTED = (
    ("jump rising", 360.0, 0.0058),
    ("unstable from", 460.0, 0.0058),
    ("unstable to", 480.0, 0.0058),
    ("jump rising", 350.0, 0.00783),
    ("jump rising", 360.0, 0.0079),
    ("unstable from", 450.0, 0.0079),
)


def bent(formulation: str = "inextensible", inertia: float = 0.0058, **changes: float):
    """Return Smith's rig whose coupler bends most, by its measured decrement."""
    numbers = {
        "model.formulation": formulation,
        "model.modes": 1,
        "coupler.damping_ratio": 0.2 / (2.0 * np.pi),
        "follower.inertia": inertia * LBF_IN_S2,
    }
    return el.load_scene(RIG, numbers).system().with_parameters(**changes)


def seen(system) -> dict[str, float]:
    """Return what is seen, as a curve shows it: its lowest folds and its doublings."""
    curve = el.response_curve(system, "speed", (330.0 * RPM, 500.0 * RPM))
    folds, doublings = (
        np.sort(curve.special_value[[name == kind for name in curve.special]])
        for kind in ("fold", "doubling")
    )
    assert len(doublings) == 2
    names = ("jump falling", "jump rising", "unstable from", "unstable to")
    return dict(zip(names, [*folds[:2].tolist(), *doublings.tolist()], strict=True))


@pytest.mark.slow
def test_planted_stiffness_and_damping_are_found_from_jumps_and_doublings():
    system, names = bent(), (STIFFNESS, "damping")
    points = [Point(kind, speed) for kind, speed in seen(system).items()]
    found = identify(started(system, **dict(zip(names, (1.02, 0.95), strict=True))), points, names)
    wanted = [system.parameters[name] for name in names]
    assert np.all(found.decided)
    assert np.abs(found.value / wanted - 1.0) == pytest.approx(0.0, abs=1e-7)
    assert np.all(np.abs(found.value / wanted - 1.0) <= found.error + 1e-9)


@pytest.mark.slow
def test_chapter_nine_wants_the_drawings_stiffness_by_the_nonlinear_equation_alone():
    """By jumps and doublings the coupler is as stiff as drawn, by the linear equation a tenth less.

    What the text calls resonance is a jump by the one, the largest deflection by the other.
    """
    points = [
        Point(kind, speed * RPM, given={INERTIA: inertia * LBF_IN_S2})
        for kind, speed, inertia in QUOTED
    ]
    found = identify(bent(), points, [STIFFNESS])
    assert found.value[0] / found.start[0] == pytest.approx(1.0223, abs=5e-4)
    assert found.deviation[0] / found.value[0] == pytest.approx(0.016, abs=5e-4)
    peaks = [replace(p, kind=p.kind.replace("jump rising", "resonance")) for p in points]
    linear = identify(bent("complete"), peaks, [STIFFNESS])
    assert linear.value[0] / linear.start[0] == pytest.approx(0.8989, abs=5e-4)
    assert linear.deviation[0] / linear.value[0] == pytest.approx(0.020, abs=5e-4)
    assert linear.scatter > 1.2 * found.scatter

    # Squares of curves that are made anew, beside the place: least there, as a parabola tells.
    def squares(factor: float) -> float:
        stiffness = factor * float(found.value[0])
        curves = {
            inertia: seen(bent(inertia=inertia, **{STIFFNESS: stiffness}))
            for _, _, inertia in QUOTED
        }
        gaps = [1.0 - curves[inertia][kind] / (speed * RPM) for kind, speed, inertia in QUOTED]
        return float(np.sum(np.square(gaps)))

    sides = [squares(factor) for factor in (0.99, 1.0, 1.01)]
    assert sides[1] / 5.0 == pytest.approx(found.scatter**2, rel=1e-7)
    vertex = 0.5 * (sides[0] - sides[2]) / (sides[0] - 2.0 * sides[1] + sides[2])
    assert abs(vertex) * 0.01 < 2e-4


def test_what_one_equation_does_not_know_is_refused():
    with pytest.raises(BadInput, match="point 1: found jump rising; expected no jump of a linear"):
        identify(coupler(), [Point("jump rising", 60.0)], [STIFFNESS])
    with pytest.raises(BadInput, match="point 1: found resonance; expected one of"):
        identify(bent(), [Point("resonance", 36.0)], [STIFFNESS])
    with pytest.raises(BadInput, match="expected a computed one within 2 % of the speed"):
        identify(bent(), [Point("jump rising", 44.0)], [STIFFNESS], window=0.02)


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "flutter"},
        {"speed": 0.0},
        {"speed": float("nan")},
        {"deviation": -1.0},
        {"deflection": 1e-3},
        {"kind": "deflection"},
        {"given": {"follower_inertia": "large"}},
        {"given": 3.0},
    ],
)
def test_points_that_are_none_are_refused(wrong):
    with pytest.raises(BadInput):
        Point(**{"kind": "resonance", "speed": 30.0, **wrong})


def test_a_file_of_points_is_read_with_its_units(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text(
        "# run of the fifth of May\n"
        "Kind, speed [rpm], deflection [in], speed deviation [Hz], deflection deviation [mm],"
        " follower_inertia [g m^2]\n"
        "unstable from, 600, , 0.1,,\n\n"
        "deflection, 300, 0.25, , 0.2, 2\n"
    )
    first, second = read_points(path)
    assert (first.kind, first.deflection) == ("unstable from", None)
    assert (first.speed, first.deviation) == pytest.approx((20.0 * np.pi, 0.2 * np.pi), rel=1e-15)
    assert (second.kind, second.deflection) == ("deflection", 0.00635)
    assert (second.speed, second.deviation) == pytest.approx((10.0 * np.pi, 0.0002), rel=1e-15)
    assert first.given == {} and second.given == {"follower_inertia": pytest.approx(0.002)}
    assert first.measured == first.speed and second.measured == second.deflection


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no rows"),
        ("kind, speed [rpm]\n", "no rows"),
        ("kind, speed\nresonance, 3\n", "line 1: found 'speed'; expected its unit"),
        ("kind [rpm], speed [rpm]\nresonance, 3\n", "line 1: found 'kind [rpm]'"),
        ("kind, speed [mm]\nresonance, 3\n", "line 1"),
        ("kind, rate [rpm]\nresonance, 3\n", "line 1: found kind, rate [rpm]"),
        ("kind, speed [rpm], my mass [kg]\nresonance, 3, 1\n", "line 1: found 'my mass [kg]'"),
        ("kind, speed [rpm], mass [xyz]\nresonance, 3, 1\n", "line 1"),
        ("kind, deflection [mm]\nresonance, 3\n", "line 1"),
        ("kind, kind\nresonance, 3\n", "line 1"),
        ('kind, speed [rpm]\n"resonance, 3\nresonance, 3\n', "line 2: found unexpected"),
        ("kind; speed [rpm]\nresonance; 3\n", "line 1"),
        ("kind, speed [rpm]\nresonance, -3\n", "line 2, speed"),
        ("kind, speed [rpm]\nresonance\n", "line 2: found 1 fields"),
        ("kind, speed [rpm]\nresonance, x\n", "line 2, speed"),
        ("kind, speed [rpm]\nresonance,\n", "line 2: found no speed"),
        ("kind, speed [rpm]\nflutter, 3\n", "line 2, kind: found 'flutter'"),
        ("kind, speed [rpm], deflection deviation [mm]\nresonance, 3, 1\n", "line 2: found deflec"),
    ],
)
def test_a_file_that_holds_no_points_is_refused_with_its_line(tmp_path, text, words):
    path = tmp_path / "points.csv"
    path.write_text(text)
    with pytest.raises(BadInput, match=r"points\.csv") as refused:
        read_points(path)
    assert words in str(refused.value)
    with pytest.raises(BadInput, match="No such file"):
        read_points(tmp_path / "none.csv")
