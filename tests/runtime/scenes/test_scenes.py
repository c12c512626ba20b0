"""Scenes: the built-in data against the printed numbers, overrides, and what follows from them."""

import hashlib
import json
import math
import pickle
from dataclasses import asdict
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from elastolink import generated
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.scenes import Scene, scene_from_document, scene_titles

INCH, LBF = 0.0254, 4.4482216152605
RPM = math.pi / 30
THICKNESSES = {"sixteenth": 1 / 16, "threesixtyfourths": 3 / 64, "thirtysecond": 1 / 32}
PROPORTIONS = {"5152": (5, 1, 5, 2), "101104": (10, 1, 10, 4)}
RIGS = [(p, t) for p in PROPORTIONS for t in THICKNESSES]
RIG = "smith_1972_5152_sixteenth_inch"
COUPLER = ("bending_stiffness", "mass_per_length", "damping", "inertia", "first_moment")


def test_the_promised_scenes_are_there():
    promised = {f"smith_1972_{p}_{t}_inch" for p, t in RIGS}
    promised |= {f"smith_1972_{n}" for n in ("2122", "4144", "54_04_54_3", "12_6_12_12")}
    promised |= {"smith_1972_10_8_10_10", "mathieu", "hill_example"}
    assert promised <= set(el.list_scenes())
    assert list(el.list_scenes()) == sorted(el.list_scenes())


@pytest.mark.parametrize("name", el.list_scenes())
def test_a_built_in_scene_loads_says_its_source_and_survives_a_round_trip(name):
    scene = el.load_scene(name)
    assert isinstance(scene, Scene)
    assert scene.title and scene.source
    assert scene_titles()[name] == (scene.title, scene.source)
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene and hash(again) == hash(scene)
    assert again.digest() == el.load_scene(name).digest()


@pytest.mark.parametrize(("proportions", "thickness"), RIGS)
def test_numbers_of_the_rigs(proportions, thickness):
    scene = el.load_scene(f"smith_1972_{proportions}_{thickness}_inch")
    links = [scene.get(f"links.{name}") for name in ("frame", "crank", "coupler", "follower")]
    unit = 15 * INCH / PROPORTIONS[proportions][2]
    assert links == pytest.approx([n * unit for n in PROPORTIONS[proportions]], rel=1e-15)
    # Section 9.4.2: 171.5 lbf in^2 at 1/16 in, and with the cube of the thickness elsewhere.
    stiffness = 171.5 * LBF * INCH**2 * (16 * THICKNESSES[thickness]) ** 3
    assert scene.get("coupler.bending_stiffness") == pytest.approx(stiffness, rel=1e-14)
    # Section 9.5.3: 26 Hz and 20 Hz observed; 13 Hz by proportion.
    observed = {"sixteenth": 26.0, "threesixtyfourths": 20.0, "thirtysecond": 13.0}[thickness]
    assert scene.get("coupler.natural_frequency") == pytest.approx(2 * math.pi * observed)
    mass = scene.get("coupler.mass_per_length")
    rate = (math.pi / links[2]) ** 2 * math.sqrt(stiffness / mass)
    assert rate == pytest.approx(2 * math.pi * observed, rel=1e-14)
    measured = scene["measured"]
    # Section 9.4.1.
    printed = [0.0058, 0.0069, 0.0079, 0.0109, 0.0130, 0.0149, 0.0164, 0.0190]
    spread = [0.0001, 0.0002, 0.0002, 0.0003, 0.0003, 0.0004, 0.0004, 0.0005]
    unit = LBF * INCH
    assert measured["follower_inertias"] == pytest.approx([i * unit for i in printed])
    assert measured["follower_inertia_tolerances"] == pytest.approx([i * unit for i in spread])
    # Quoted resonances lie near the fraction that their region names.
    regions = measured.get("regions", ())
    for speed, region in zip(measured.get("speeds", ()), regions, strict=True):
        assert speed == pytest.approx(4 * math.pi * observed / region, rel=0.16)


def test_chapter_4_linkage_is_printed_data_with_its_own_gravity():
    scene = el.load_scene("smith_1972_12_6_12_12")
    # The printed inertia is a uniform bar's, W l^2 / (3 g), with the g of the scene alone.
    mass, length = scene.get("coupler.mass"), scene.get("links.coupler")
    assert scene.get("coupler.inertia") == pytest.approx(0.125 * LBF * INCH, rel=1e-14)
    assert mass * length**2 / 3 == pytest.approx(scene.get("coupler.inertia"), rel=1e-12)
    assert scene.get("coupler.first_moment") == pytest.approx(mass * length / 2)
    standard = el.load_scene("smith_1972_12_6_12_12", {"gravity.acceleration": 9.80665})
    assert standard.get("coupler.mass") == pytest.approx(0.45359237, rel=1e-12)


def test_derived_quantities_of_a_flexible_coupler():
    bar = el.load_scene(RIG)["coupler"]
    length = 15 * INCH
    assert bar["mass"] == pytest.approx(bar["mass_per_length"] * length)
    assert bar["inertia"] == pytest.approx(bar["mass_per_length"] * length**3 / 3)
    assert bar["first_moment"] == pytest.approx(bar["mass_per_length"] * length**2 / 2)
    assert bar["damping"] == 0.0 and bar["damping_ratio"] == 0.0
    damped = el.load_scene(RIG, {"coupler.damping_ratio": 0.01})["coupler"]
    assert damped["damping"] == pytest.approx(
        0.02 * damped["mass_per_length"] * damped["natural_frequency"]
    )
    back = el.load_scene(RIG, {"coupler.damping": damped["damping"]})["coupler"]
    assert back["damping_ratio"] == pytest.approx(0.01)


def test_a_balanced_coupler_has_no_first_moment_and_its_own_module():
    scene = el.load_scene(RIG, {"model.balanced": ["coupler"]})
    assert scene.get("coupler.first_moment") == 0.0
    assert scene.model_spec().balanced == ("coupler",)
    with pytest.raises(el.BadInput, match=r"coupler\.first_moment.*model\.balanced"):
        el.load_scene(RIG, {"model.balanced": ["coupler"], "coupler.first_moment": 0.1})


def test_overrides_replace_keys_and_rivals():
    scene = el.load_scene(RIG, {"model.modes": 3, "links.crank": "0.07 m"})
    assert scene.model["modes"] == 3 and scene.get("links.crank") == 0.07
    heavier = el.load_scene(RIG, {"coupler.mass_per_length": 0.2})
    assert heavier.get("coupler.mass_per_length") == 0.2
    assert heavier.get("coupler.natural_frequency") < scene.get("coupler.natural_frequency")
    with pytest.raises(el.BadInput, match="exactly one"):
        el.load_scene(RIG, {"coupler.mass_per_length": 0.2, "coupler.natural_frequency": "9 Hz"})
    with pytest.raises(el.BadInput, match="exactly one"):
        el.load_scene(RIG, {"coupler.natural_frequency": None})
    assert el.load_scene(RIG, {"title": "mine"}).title == "mine"
    ranged = el.load_scene(
        RIG, {"operation.speed_range": np.array([10, 20]), "model.modes": np.int64(2)}
    )
    assert ranged.get("operation.speed_range") == (10.0, 20.0) and ranged.model["modes"] == 2


def test_tables_cannot_be_changed_and_wrong_keys_name_the_right_one():
    scene = el.load_scene(RIG)
    with pytest.raises(TypeError):
        scene["links"]["crank"] = 1.0
    with pytest.raises(AttributeError):
        scene.title = "other"
    with pytest.raises(KeyError, match=r"links\.crnk.*did you mean crank"):
        scene.get("links.crnk")
    with pytest.raises(KeyError, match="did you mean links"):
        scene["lnks"]
    assert scene.get("links.crnk", 7) == 7 and scene.get("nothing.here", None) is None
    assert "links" in scene and "function" not in scene
    assert scene.get("links") == scene["links"]


def test_the_model_spec_leaves_the_mode_count_open_where_one_module_serves_all():
    spec = el.load_scene(RIG, {"model.modes": 4}).model_spec()
    assert spec == ModelSpec("four_bar", "complete", flexible=("coupler",))
    assert el.load_scene("mathieu").model_spec() == ModelSpec("hill", "plain")
    assert el.load_scene("smith_1972_2122").model_spec() == ModelSpec("four_bar", "kinematics")
    wanted = el.load_scene(RIG, {"model.outputs": ["stability"]}).model_spec()
    assert wanted.outputs == ("stability",)


def test_the_mechanism_has_the_lengths_of_the_scene():
    linkage = el.load_scene("smith_1972_2122", {"links.assembly": "crossed"}).mechanism()
    assert linkage.assembly == "crossed"
    assert linkage.crank / linkage.frame == pytest.approx(0.5)
    with pytest.raises(el.BadInput, match="a linkage"):
        el.load_scene("mathieu").mechanism()


def test_series_of_unequal_length_are_filled_with_zeros():
    scene = el.load_scene("mathieu", {"function.b": [0.0, 0.0, 0.5]})
    assert scene.get("function.a") == (0.0, 1.0, 0.0)
    assert scene.get("function.b") == (0.0, 0.0, 0.5)


OWN = {
    "title": "a slider-crank of my own",
    "model": dict(mechanism="slider_crank_rod", formulation="linear", flexible=["rod"], modes=2),
    "schema": {
        "closed_in_modes": True,
        "parameters": {"speed": "frequency"},
        "links": {"crank": {"dimension": "length", "limit": "positive"}, "rod": "length"},
        "rod": {"bending_stiffness": "bending_stiffness", "count": {"kind": "count", "default": 3}},
    },
    "links": {"crank": "10 cm", "rod": "0.3 m"},
    "rod": {"bending_stiffness": 2.0},
    "chart": {"x": "speed", "x_range": ["10 rpm", "20 rpm"]},
}


def test_a_mechanism_of_ones_own_declares_its_tables():
    scene = scene_from_document("own", OWN)
    assert scene.get("links.crank") == 0.1 and scene.get("rod.count") == 3
    assert scene.get("chart.x_range") == pytest.approx((10 * RPM, 20 * RPM))
    assert scene.model_spec() == ModelSpec("slider_crank_rod", "linear", flexible=("rod",))
    assert scene.dimension("links.rod") == "length"
    # A default that is declared is read like a given value.
    links = {"crank": "length", "rod": {"dimension": "length", "default": "30 cm"}}
    change = {"schema.links": links, "links.rod": None}
    assert scene_from_document("own", OWN, change).get("links.rod") == 0.3
    links["rod"]["default"] = "3 kg"
    with pytest.raises(el.BadInput, match=r"links\.rod: found '3 kg'"):
        scene_from_document("own", OWN, change)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"links.crank": -1.0}, "links.crank"),
        ({"links.crank": "3 kg"}, "[mass]"),
        ({"links.wrist": 1.0}, "links.wrist"),
        ({"links.rod": None}, "links.rod"),
        ({"schema.links": {"rod": "lenght"}}, "schema.links.rod"),
        ({"schema.links": {"rod": {"dimension": "length", "limits": 3}}}, "schema.links.rod"),
        ({"schema.links": 3}, "schema.links"),
        ({"schema.links": {"rod": 3}}, "schema.links.rod"),
        ({"schema.parameters": {"speed": "speed"}}, "schema.parameters.speed"),
    ],
)
def test_a_declared_table_is_checked_like_a_built_in_one(change, part):
    with pytest.raises(el.BadInput) as caught:
        scene_from_document("own", OWN, change)
    assert part in str(caught.value)


@pytest.fixture
def own_module(tmp_path, monkeypatch):
    """A module of an own mechanism: the packaged reduced coupler under another spec."""
    spec = ModelSpec("own_linkage", "reduced", flexible=("coupler",))
    source = Path(generated.__path__[0]) / "four_bar_coupler_reduced.py"
    text = source.read_bytes()
    (tmp_path / f"{spec.name()}.py").write_bytes(text)
    digest = hashlib.sha256(text).hexdigest()
    row = {"module": spec.name(), "spec": asdict(spec), "content": "0" * 32, "text": digest}
    (tmp_path / "manifest.json").write_text(json.dumps({"modules": {spec.key(): row}}))
    monkeypatch.setenv("ELASTOLINK_GENERATED", str(tmp_path))
    return spec


def own_rig():
    """The rig's numbers under names of one's own, as the module takes them."""
    rig = el.load_scene(RIG)
    lengths = {key: rig["links"][key] for key in ("frame", "crank", "coupler", "follower")}
    return {
        "model": {"mechanism": "own_linkage", "formulation": "reduced", "flexible": ["coupler"]},
        "schema": {
            "closed_in_modes": True,
            "geometry": {**dict.fromkeys(lengths, "length"), "assembly": "dimensionless"},
            "coupler": {name: name for name in COUPLER} | {"damping": "damping_per_length"},
            "follower": {"inertia": "inertia"},
        },
        "geometry": {**lengths, "assembly": 1.0},
        "coupler": {key: rig["coupler"][key] for key in COUPLER},
        "follower": {"inertia": rig.get("follower.inertia")},
    }


def test_an_own_scene_with_an_own_module_gives_the_same_system(own_module, monkeypatch):
    scene = scene_from_document("own", own_rig(), {"model.modes": 2})
    assert scene.model_spec() == own_module
    own = scene.system()
    packaged = el.load_scene(RIG, {"model.formulation": "reduced", "model.modes": 2}).system()
    theta = np.linspace(0.0, 6.0, 7)
    assert own.size == packaged.size == 2
    for array in ("M", "B", "S", "K", "f", "g"):
        assert np.array_equal(own.array(array, theta), packaged.array(array, theta))
    assert own.provenance["module"] == own_module.name()
    document = own_rig()
    del document["schema"]["follower"], document["follower"]
    with pytest.raises(el.BadInput, match="follower_inertia: found nothing"):
        scene_from_document("own", document, {"model.modes": 1}).system()
    monkeypatch.delenv("ELASTOLINK_GENERATED")
    with pytest.raises(el.BadInput, match="regenerate-equations"):
        scene_from_document("own", own_rig(), {"model.modes": 1}).system()


def test_a_scene_shows_itself_on_ten_lines_at_most():
    for name in el.list_scenes():
        lines = repr(el.load_scene(name)).splitlines()
        assert len(lines) <= 10 and max(map(len, lines)) < 200 and name in lines[0]
    told = repr(el.load_scene("smith_1972_5152_sixteenth_inch", {"links.crank": 0.08}))
    assert "four_bar, formulation 'complete', bending: coupler" in told
    assert "links: frame 0.381 m, crank 0.08 m" in told and "(332 rpm)" in told
