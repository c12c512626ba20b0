"""Bands of answers within tolerances: they hold every machine that is drawn, and hardly more."""

import itertools

import elastolink as el
import numpy as np
import pytest
from elastolink import BadInput
from elastolink.runtime.design import tolerance_bands
from elastolink.runtime.linkages.parametric import Parametric
from elastolink.runtime.rigid.evaluation import ParametricMachine
from elastolink.runtime.scenes import with_numbers
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

COUPLER = "smith_1972_5152_sixteenth_inch"
ANGLES = np.array([0.3, 1.1, 1.9, 2.8, 3.6, 4.4, 5.3, 6.1])
# Tolerances in per cent by the last name of a key; lengths have 0.2.
PER_CENT = {"inertia": 2, "mass": 1, "weight": 1, "density": 1, "mass_per_length": 1, "modulus": 2}
PER_CENT |= {"bending_stiffness": 2, "natural_frequency": 1, "lam2": 1, "mu": 2}
RIGID = ("aannaque_1996_table_3_2", "quick_return_example", "slider_crank_example")
RIGID += ("smith_1972_12_6_12_12",)
MOTION = ("10_8_10_10", "2122", "4144", "54_04_54_3")
SMITH = [
    f"smith_1972_{rig}_{thick}_inch"
    for rig in ("5152", "101104")
    for thick in ("sixteenth", "thirtysecond", "threesixtyfourths")
]
BEALE = ("bahgat_willmert", "bahgat_willmert_heavy", "flexible_rod")


def toleranced(name):
    """Return a scene whose lengths, masses and stiffnesses have tolerances, the first seven."""
    found = {}
    for table, values in el.load_scene(name).given.items():
        for key, value in values.items():
            width = 0.2 if table == "links" else PER_CENT.get(key)
            if width and isinstance(value, float) and value:
                found[f"{table}.{key}"] = f"{value!r} +- {width} %"
    return el.load_scene(name, dict(list(found.items())[:7]))


def drawn(scene, count):
    """Return numbers of machines, all corners first, ``(count, n)``."""
    names = list(scene.tolerances)
    random = np.random.default_rng(20)
    corners = list(itertools.product((-1.0, 1.0), repeat=len(names)))
    points = np.concatenate([corners, random.uniform(-1.0, 1.0, (count, len(names)))])
    return names, [scene.get(k) for k in names] + points * [scene.tolerances[k] for k in names]


def bodies(scene, numbers, links):
    """Return masses, moments and inertias of links, of all machines at once, as documented."""

    def value(key):
        return numbers.get(key, scene.given.get(key.split(".")[0], {}).get(key.split(".")[1]))

    found = {}
    for link in links:
        length = 0.0 if link in ("slider", "block") else value(f"links.{link}")
        given = {key: value(f"{link}.{key}") for key in scene.given.get(link, {})}
        mass = given.get("mass", 0.0)
        if "weight" in given:
            mass = given["weight"] / scene.get("gravity.acceleration")
        if "density" in given:
            mass = given["density"] * given["width"] * given["thickness"] * length
        if "natural_frequency" in given:
            square = given["natural_frequency"] ** 2
            mass = length * given["bending_stiffness"] * (np.pi / length) ** 4 / square
        along = mass * given.get("centre_along", length / 2.0)
        inertia = given.get("inertia", mass * length**2 / 3.0)
        if "inertia_about_centre" in given:
            inertia = given["inertia_about_centre"] + along**2 / mass
        found |= {f"{link}.mass": mass, f"{link}.along": along, f"{link}.inertia": inertia}
    return found


def model_of(machine, *drive):
    return ParametricMachine(machine.linkage, *drive, machine=machine)


def closed_form(scene, count, model, outputs):
    """Return least and greatest of closed forms, all machines at once."""
    names, rows = drawn(scene, count)
    numbers = dict(zip(names, rows.T[:, :, None], strict=True))
    columns = model.values | {k.removeprefix("links."): v for k, v in numbers.items()}
    if any("." in k for k in model.values):
        columns |= bodies(scene, numbers, [k[:-5] for k in model.values if k.endswith(".mass")])
        machine = with_numbers(scene, dict(zip(names, rows[-1].tolist(), strict=True))).machine()
        last = model_of(machine, model.theta, model.speed, model.acceleration).values
        for name, value in last.items():
            here = np.broadcast_to(columns[name], (len(rows), 1))
            assert here[-1, 0] == pytest.approx(value, rel=1e-12)
    values = model.evaluate(columns)
    every = np.array([np.broadcast_to(values[k], (len(rows), model.theta.size)) for k in outputs])
    return every.min(axis=1), every.max(axis=1)


def held(bands, low, high):
    """Assert that bands hold extremes; return how many times too wide they are, in the median."""
    assert bands.passed, bands.checks
    assert np.all(bands.lower <= low) and np.all(high <= bands.upper)
    needed = high - low
    moving = needed > 1e-9 * np.max(needed, axis=1, keepdims=True)
    return float(np.median((bands.upper - bands.lower)[moving] / needed[moving]))


def forces(name, count):
    scene = toleranced(name)
    bands = tolerance_bands(scene, "forces", ANGLES)
    drive = scene.get("operation.speed"), scene.get("operation.acceleration", 0.0)
    assert bands.proved is not scene.machine().loaded
    model = model_of(scene.machine(), ANGLES, *(np.full(8, one) for one in drive))
    return held(bands, *closed_form(scene, count, model, bands.rows))


def motion(name, count):
    scene = toleranced(name)
    linkage = scene.mechanism()
    low, high = (0.0, 2 * np.pi) if linkage.crank_turns else linkage.crank_ranges()[0]
    theta = low + (high - low) * np.linspace(0.15, 0.85, 8)
    bands = tolerance_bands(scene, "motion", theta)
    assert bands.proved
    drive = (np.full(8, one) for one in (scene.get("operation.speed", 1.0), 0.0))
    return held(bands, *closed_form(scene, count, Parametric(linkage, theta, *drive), bands.rows))


def hill(name, count):
    scene = toleranced(name)
    _, rows = drawn(scene, count)
    a, b = (scene.get(f"function.{key}") for key in "ab")
    waves = np.outer(np.arange(len(a)), ANGLES)
    squares = rows[:, :1] + rows[:, 1:] * (a @ np.cos(waves) + b @ np.sin(waves))
    bands = tolerance_bands(scene, "frequencies", ANGLES)
    assert bands.proved
    return held(bands, *(np.sqrt(end)[None] for end in (squares.min(axis=0), squares.max(axis=0))))


def frequencies(name, count):
    scene = toleranced(name)
    theta = ANGLES[:3]
    bands = tolerance_bands(scene, "frequencies", theta)
    names, rows = drawn(scene, count)

    def answer(row):
        system = with_numbers(scene, dict(zip(names, row.tolist(), strict=True))).linear_system()
        pairs = zip(system.array("K", theta), system.array("M", theta), strict=True)
        return [np.sqrt(eigh(k, m, eigvals_only=True)[: len(bands.rows)]) for k, m in pairs]

    found = np.array([answer(row) for row in rows])
    return held(bands, found.min(axis=0).T, found.max(axis=0).T)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["closed form", "by eigenvalues"])
def test_worst_cases_hold_every_sample_of_twenty_scenes(kind):
    """1e5 machines of each of 16 scenes by closed forms; of six of beams and rods 100 and 20."""
    if kind == "closed form":
        found = [forces(name, 100_000) for name in (*RIGID, *SMITH)]
        found += [motion(f"smith_1972_{name}", 100_000) for name in MOTION]
        found += [hill(name, 100_000) for name in ("mathieu", "hill_example")]
    else:
        found = [frequencies(f"beale_1992_{name}", 100) for name in BEALE]
        beams = ("long_coupler", "portal_frame", "table_4_1")
        found += [frequencies(f"aannaque_1996_{name}", 20) for name in beams]
    assert 1.0 <= np.median(found) < 1.1 and np.max(found) < 1.5


def coupler(**more):
    """Return Smith's coupler with tolerances of stiffness and length."""
    given = {"coupler.natural_frequency": "26 Hz +- 1 %", "links.crank": "76.2 +- 0.5 mm"}
    return el.load_scene(COUPLER, given | more)


def test_bands_of_few_machines_hold_what_closed_forms_say():
    assert 1.0 <= forces("smith_1972_12_6_12_12", 200) < 1.1
    assert 1.0 <= motion("smith_1972_54_04_54_3", 200) < 1.2
    assert 1.0 <= hill("mathieu", 200) < 1.1
    assert 1.0 <= frequencies("beale_1992_flexible_rod", 2) < 1.1


def test_a_rocking_crank_is_moved_within_what_it_reaches():
    scene = el.load_scene("smith_1972_12_6_12_12", {"links.crank": "14 in +- 0.1 mm"})
    bands = tolerance_bands(scene, "motion", trials=1)
    ends = scene.mechanism().crank_ranges()[0]
    assert ends[0] < bands.place[0] and bands.place[-1] < ends[1] and bands.passed
    assert dict(zip(bands.rows, bands.units, strict=True))["omega4"] == "rad/s"


def test_nothing_is_proved_of_a_machine_that_may_fold():
    scene = el.load_scene("smith_1972_12_6_12_12", {"links.crank": "14 in +- 0.1 mm"})
    end = scene.mechanism().crank_ranges()[0][1]
    for back, proved in ((4e-3, True), (1e-3, False)):
        bands = tolerance_bands(scene, "motion", [end - back], trials=1)
        assert bands.proved is proved
        assert bands.method.endswith("proved" if proved else "doubled")


@pytest.mark.slow
@pytest.mark.parametrize("answer", ["motion", "forces"])
def test_default_angles_of_scenes_are_proved_and_as_narrow_as_what_is_measured(answer, monkeypatch):
    names = (*RIGID, *(f"smith_1972_{name}" for name in MOTION))
    scenes = [toleranced(name) for name in names if answer == "motion" or name in RIGID]
    for scene in scenes:
        loaded = answer == "forces" and scene.machine().loaded
        with monkeypatch.context() as patch:
            proved = tolerance_bands(scene, answer, trials=3)
            patch.setattr("elastolink.runtime.design.within_tolerances._enclosed", lambda *_: None)
            measured = tolerance_bands(scene, answer, trials=1)
        assert proved.proved is not loaded and proved.passed and not measured.proved
        width = measured.upper - measured.lower
        kept = width > 1e-6 * np.maximum(np.max(width, axis=1, keepdims=True), 1e-6)
        assert np.all((proved.upper - proved.lower)[kept] < 1.2 * width[kept])


def test_a_quadratic_answer_is_bounded_exactly_and_its_parts_are_known():
    scene = coupler()

    def answer(one):
        u = (
            one.get("coupler.natural_frequency") / scene.get("coupler.natural_frequency") - 1
        ) * 100
        v = (one.get("links.crank") - 0.0762) / 5e-4
        return [3.0 * u - v, u**2 - 0.5 * u, -(v**2) + v, u * v, 5.0]

    bands = tolerance_bands(scene, answer)
    number = [bands.numbers.index(k) for k in ("coupler.natural_frequency", "links.crank")]
    assert bands.value[0] == pytest.approx([0, 0, 0, 0, 5])
    assert bands.lower[0] == pytest.approx([-4, -0.0625, -2, -1, 5], abs=1e-9)
    assert bands.upper[0] == pytest.approx([4, 1.5, 0.25, 1, 5], abs=1e-9)
    slopes = np.array([[3, -1], [-0.5, 0], [0, 1], [0, 0], [0, 0]])
    assert bands.slope[0][:, number] == pytest.approx(slopes, abs=1e-9)
    assert bands.share[0, 0, number] == pytest.approx([0.9, 0.1], rel=0.05)
    assert bands.standard_deviation[0, 0] == pytest.approx(np.sqrt(10 / 3), rel=0.02)
    assert np.all((bands.lower <= bands.likely_lower) & (bands.likely_upper <= bands.upper))
    assert bands.passed and bands.reserve.max() < 1e-9


def test_normal_deviations_spread_less_than_uniform_ones_and_reach_three_of_them():
    key = "coupler.natural_frequency"

    def answer(one):
        return [one.get(key)]

    middle = el.load_scene(COUPLER).get(key)
    alone = el.load_scene(COUPLER, {f"deviations.{key}": "1 %"})
    both = el.load_scene(COUPLER, {key: "26 Hz +- 2 %", f"deviations.{key}": "2 %"})
    alone, both = (tolerance_bands(one, answer, samples=100_000) for one in (alone, both))
    assert alone.upper[0] == pytest.approx([1.03 * middle], rel=1e-9)
    assert alone.standard_deviation[0] == pytest.approx([0.01 * middle], rel=0.02)
    assert both.upper[0] == pytest.approx([1.02 * middle], rel=1e-9)
    # Of a normal distribution cut off at one deviation: its variance is 0.29 of the whole.
    assert both.standard_deviation[0] == pytest.approx([0.02 * middle * 0.5396], rel=0.02)


def test_ends_of_unstable_regions():
    key, span = "coupler.natural_frequency", (72.0, 86.0)
    scene = el.load_scene(COUPLER, {key: "26 Hz +- 1 %"})
    edges = tolerance_bands(scene, "edges", span, trials=1)
    assert edges.rows == ("from region 4 of mode 1", "to region 4 of mode 1") and edges.passed
    assert edges.proved
    found = []
    for part in (-0.01, 0.01, 0.004):
        moved = with_numbers(scene, {key: (1.0 + part) * scene.get(key)}).linear_system()
        ends = el.stability_edges(moved, span)
        found.append(np.array([ends.lower[0], ends.upper[0]]))
        assert np.all((edges.lower[:, 0] <= found[-1]) & (found[-1] <= edges.upper[:, 0]))
    assert edges.slope[:, 0, 0] == pytest.approx((found[1] - found[0]) / 2.0, rel=1e-4)
    # The extremes are at the ends: nothing but the reserve is beyond them.
    assert edges.upper[:, 0] - found[1] == pytest.approx(edges.reserve[:, 0], rel=0.5)


def wide(**more):
    """Return Smith's coupler with tolerances of five numbers, lengths among them."""
    given = {
        "coupler.natural_frequency": "26 Hz +- 0.3 %",
        "links.crank": "76.2 +- 0.02 mm",
        "links.coupler": "381 +- 0.05 mm",
        "links.frame": "381 +- 0.05 mm",
        "follower.inertia": "655e-6 kg*m**2 +- 1 %",
    }
    return el.load_scene(COUPLER, given | more)


@pytest.mark.slow
@pytest.mark.parametrize("formulation", ["complete", "printed", "reduced"])
def test_proved_ends_hold_machines_and_are_no_wider_than_measured_ones(formulation, monkeypatch):
    scene, span = wide(**{"model.formulation": formulation}), (50.0, 88.0)
    bands = tolerance_bands(scene, "edges", span, trials=1)
    assert bands.proved and bands.passed and len(bands.rows) >= 6
    names, rows = drawn(scene, 12)
    for row in rows:
        moved = with_numbers(scene, dict(zip(names, row.tolist(), strict=True))).linear_system()
        found = el.stability_edges(moved, (48.0, 92.0))
        ends = {f"from {k}": v for k, v in zip(found.labels, found.lower, strict=True)}
        ends |= {f"to {k}": v for k, v in zip(found.labels, found.upper, strict=True)}
        place = np.array([ends[name] for name in bands.rows])
        assert np.all((bands.lower[:, 0] <= place) & (place <= bands.upper[:, 0]))
    monkeypatch.setattr("elastolink.runtime.design.within_tolerances._enclosed", lambda *_: None)
    measured = tolerance_bands(scene, "edges", span, trials=1)
    assert not measured.proved
    assert np.all(bands.upper - bands.lower < 1.02 * (measured.upper - measured.lower))
    assert bands.slope == pytest.approx(measured.slope, abs=1e-4 * np.max(measured.slope))


@pytest.mark.slow
def test_ends_of_hills_equation_are_those_of_mathieus_functions():
    """Ends of y'' + (a - 2 q cos 2t) y = 0 are its characteristic values, known to 15 digits."""
    scene = el.load_scene("mathieu", {"parameters.lam2": "1 +- 1 %", "parameters.mu": "0.2 +- 2 %"})
    bands = tolerance_bands(scene, "edges", (0.9, 2.5), trials=1)
    assert bands.proved and bands.rows[-1] == "to region 1 of mode 1"
    for x, y in itertools.product((-1.0, 0.3, 1.0), repeat=2):
        lam2, mu = 1.0 + 0.01 * x, 0.2 * (1.0 + 0.02 * y)
        for order in (1, 2):
            ends = []
            for value in (mathieu_a, mathieu_b):
                # Of the speed w, in turns of half its angle: a = 4 lam2 / w^2, q = 2 mu / w^2.
                def gap(w, value=value, order=order, lam2=lam2, mu=mu):
                    return 4.0 * lam2 / w**2 - value(order, 2.0 * mu / w**2)

                ends.append(brentq(gap, 0.5, 3.0, xtol=1e-13))
            for edge, end in zip(("from", "to"), sorted(ends), strict=True):
                i = bands.rows.index(f"{edge} region {order} of mode 1")
                assert bands.lower[i, 0] <= end <= bands.upper[i, 0]


@pytest.mark.parametrize(
    ("more", "span"),
    [
        ({"coupler.damping_ratio": 0.001}, (78.0, 82.0)),
        pytest.param({"model.modes": 2}, (74.0, 74.2), marks=pytest.mark.slow),
    ],
)
def test_damping_and_combinations_of_modes_are_measured(more, span):
    bands = tolerance_bands(coupler(**more), "edges", span, trials=1)
    assert not bands.proved and bands.method.endswith("doubled")


@pytest.mark.slow
def test_boundaries_of_a_chart():
    scene, span = coupler(), (72.0, 86.0)
    inertia = scene.linear_system().parameters["follower_inertia"]
    over = "follower_inertia", [inertia, 1.05 * inertia]
    chart = tolerance_bands(scene, "boundaries", span, over=over, trials=1)
    edges = tolerance_bands(scene, "edges", span, trials=1)
    assert chart.rows == edges.rows and chart.value.shape == (2, 2) and chart.passed
    assert chart.proved and edges.proved
    assert chart.lower[:, :1] == pytest.approx(edges.lower, rel=1e-6)
    found = el.stability_edges(scene.linear_system(), span, follower_inertia=over[1][1])
    assert chart.value[:, 1] == pytest.approx([found.lower[0], found.upper[0]], rel=1e-9)


@pytest.mark.slow
def test_stresses_of_beams_near_a_resonance():
    name = "aannaque_1996_table_4_1"
    scene = el.load_scene(name, {"material.modulus": "210 GPa +- 1 %"})
    speeds = [20.0, 21.0]
    bands = tolerance_bands(scene, "stress", speeds, trials=1)
    assert bands.passed and bands.value.shape == (len(bands.rows), 2)
    soft = el.load_scene(name, {"material.modulus": "208.5 GPa"}).linear_system()
    found = el.stress_curve(soft, speeds, rtol=1e-5).maximum.T
    assert np.all((bands.lower <= found) & (found <= bands.upper))


def test_the_same_bytes_each_time_and_others_with_another_seed():
    runs = [tolerance_bands(coupler(), "forces", ANGLES, seed=seed) for seed in (0, 0, 1)]
    assert runs[0].to_dict() == runs[1].to_dict()
    assert np.any(runs[0].standard_deviation != runs[2].standard_deviation)


def test_kinks_and_tolerances_too_wide_for_the_model_are_told():
    scene = coupler()
    middle = scene.get("coupler.natural_frequency")

    def kink(one):
        u = (one.get("coupler.natural_frequency") / middle - 1.0) * 100.0
        return [np.sin(6.0 * u)]

    bands = tolerance_bands(scene, kink)
    assert not bands.passed and not bands.checks["narrow"].passed
    assert bands.lower[0, 0] <= -1.0 and bands.upper[0, 0] >= 1.0


def test_picture(tmp_path):
    bands = tolerance_bands(coupler(), "forces", trials=1)
    ax = bands.plot()
    assert ax.get_xlabel() == "crank angle [deg]" and "N m" in ax.get_ylabel()
    torque = bands.plot(row="torque")
    assert [line.get_label() for line in torque.get_lines()] == ["torque"]
    light, dark = (c.get_paths()[0].get_extents() for c in torque.collections)
    assert light.y0 <= dark.y0 < dark.y1 <= light.y1
    with pytest.raises(BadInput, match="one of"):
        bands.plot(row="nothing")
    assert bands.save(tmp_path / "bands.csv").stat().st_size > 1000


def test_bands_that_would_not_be_seen_are_drawn_as_deviations():
    scene = el.load_scene("smith_1972_10_8_10_10", {"links.crank": "8 in +- 0.05 mm"})
    bands = tolerance_bands(scene, "motion", trials=1)
    ax = bands.plot(row="theta4")
    assert ax.get_ylabel() == "deviation of theta4 [rad]"
    row = bands.rows.index("theta4")
    top = np.max((bands.upper - bands.value)[row])
    assert top == pytest.approx(max(c.get_paths()[0].get_extents().y1 for c in ax.collections))
    assert np.all(ax.get_lines()[0].get_ydata() == 0.0)


@pytest.mark.parametrize(
    ("scene", "answer", "more", "words"),
    [
        (COUPLER, "forces", {}, "no tolerance"),
        ("toleranced", "bands", {}, "one of frequencies"),
        ("toleranced", "forces", {"over": ("x", [1.0])}, "boundaries"),
        ("toleranced", "edges", {"at": (20.0, 20.2)}, "unstable regions"),
        ("toleranced", "boundaries", {"at": (72.0, 86.0), "over": ("mass", [1.0])}, "mass"),
        ("toleranced", "forces", {"trials": 0}, "trials"),
        ("toleranced", "forces", {"samples": 1}, "samples"),
        ("toleranced", "forces", {"seed": -1}, "seed"),
        ("toleranced", lambda scene: [1.0], {"at": [0.0]}, "without 'at'"),
        ("toleranced", lambda scene: [np.nan], {}, "finite"),
        ("toleranced", "stress", {"at": [20.0]}, "beams"),
    ],
)
def test_refusals(scene, answer, more, words):
    loaded = coupler() if scene == "toleranced" else el.load_scene(scene)
    with pytest.raises(BadInput, match=words):
        tolerance_bands(loaded, answer, **more)


def test_a_machine_within_the_tolerances_that_cannot_be_is_told():
    scene = el.load_scene("mathieu", {"parameters.mu": "0.9 +- 0.2"})
    with pytest.raises(BadInput, match=r"with parameters\.mu = 1\.1.*narrow"):
        tolerance_bands(scene, "frequencies", [3.1416])
