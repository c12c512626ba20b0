"""Numbers of a scene with tolerances: how they are read, what follows, what is refused."""

import math
import pickle

import elastolink as el
import pytest
from elastolink import BadInput
from elastolink.runtime.scenes import with_numbers

SCENE = "smith_1972_5152_sixteenth_inch"


def load(**overrides):
    return el.load_scene(SCENE, {key.replace("__", "."): v for key, v in overrides.items()})


@pytest.mark.parametrize(
    ("text", "value", "width"),
    [
        ("381 mm +- 0.1 mm", 0.381, 1e-4),
        ("381 +- 0.1 mm", 0.381, 1e-4),
        ("381 mm ± 0.1", 0.381, 1e-4),
        ("15 in +/- 0.004 in", 0.381, 0.004 * 0.0254),
        ("0.381 +- 1e-4", 0.381, 1e-4),
        ("381 mm +- 2 %", 0.381, 0.02 * 0.381),
        ("3.81e2 mm +-100 um", 0.381, 1e-4),
    ],
)
def test_value_and_half_width(text, value, width):
    scene = load(links__coupler=text)
    assert scene.get("links.coupler") == pytest.approx(value, rel=1e-15)
    assert dict(scene.tolerances) == pytest.approx({"links.coupler": width}, rel=1e-14)


def test_hertz_count_cycles_in_the_half_width_too():
    scene = load(coupler__natural_frequency="26 Hz ± 0.5 Hz", operation__speed="12 rad/s ± 2 %")
    assert scene.tolerances["coupler.natural_frequency"] == pytest.approx(math.pi, rel=1e-14)
    assert scene.tolerances["operation.speed"] == pytest.approx(0.24, rel=1e-14)


def test_all_else_stays_as_it_is_without_tolerances():
    plain, wide = load(), load(links__coupler="15 in +- 0.1 mm")
    assert wide.tables == plain.tables and not plain.tolerances
    assert wide.digest() != plain.digest() and wide != plain
    assert "tolerances" not in plain.to_dict() and "deviations" not in plain.to_dict()
    assert wide.to_dict()["tolerances"] == {"links.coupler": pytest.approx(1e-4)}
    assert load(links__coupler="15 in +- 0 mm").digest() == plain.digest()
    assert pickle.loads(pickle.dumps(wide)).tolerances == wide.tolerances


def test_a_file_with_tolerances_and_deviations(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(
        '[model]\nmechanism = "four_bar"\nformulation = "forces"\n'
        '[links]\nframe = "0.3 m"\ncrank = "0.1 m ± 0.1 mm"\ncoupler = 0.3\nfollower = 0.25\n'
        '[coupler]\nmass = "0.4 kg"\n'
        "[loads.tool]\nlink = 'follower'\ncouple = '3 N*m +- 0.1 N*m'\n"
        '[deviations]\n"links.coupler" = "0.03 mm"\ncoupler.mass = "1 %"\n'
    )
    scene = el.load_scene(path)
    assert scene.tolerances["loads.tool.couple"] == pytest.approx(0.1)
    assert dict(scene.deviations) == pytest.approx({"links.coupler": 3e-5, "coupler.mass": 4e-3})
    more = el.load_scene(path, {"deviations.links.coupler": "0.01 mm", "links.crank": 0.1})
    assert more.deviations["links.coupler"] == pytest.approx(1e-5)
    assert "links.crank" not in more.tolerances
    assert with_numbers(scene, {"loads.tool.couple": 4.0}).get("loads.tool.couple") == 4.0


def test_another_number_changes_what_follows_from_it():
    scene = load(links__coupler="381 mm +- 1 mm", coupler__natural_frequency="26 Hz +- 1 %")
    numbers = {"links.coupler": 0.38, "coupler.natural_frequency": 160.0}
    moved, again = (
        with_numbers(scene, numbers),
        load(**{k.replace(".", "__"): v for k, v in numbers.items()}),
    )
    assert moved.tables == again.tables and moved.digest() == again.digest()
    assert moved.get("coupler.mass_per_length") != scene.get("coupler.mass_per_length")
    assert with_numbers(scene, {}).tables == scene.tables


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("links.coupler", "381 mm +- banana", "found 'banana'"),
        ("links.coupler", "381 mm +- ", "found ''"),
        ("links.coupler", "381 mm +- -1 mm", "half-width of 0 or more"),
        ("links.coupler", "381 mm +- 1 kg", "of dimension [mass]"),
        ("links.coupler", "381 mm +- 0.1 mm +- 1 mm", "one number and one unit"),
        ("links.coupler", "381 mm +- 400 mm", "the sign would change"),
        ("links.coupler", "381 mm +- 100 %", "the sign would change"),
        ("links.crank", "3 in +- 3.5 in", "the sign would change"),
        ("links.coupler", "15 in +- 5 in", "within the tolerances a diagonal"),
        ("model.modes", "1 +- 1", "a whole number"),
        (
            "operation.speed_range",
            ["100 rpm +- 1 rpm", "900 rpm"],
            "single quantity that the scene gives",
        ),
        ("links.nix", "1 mm +- 1 mm", "unknown key"),
        ("deviations.links.nix", "1 mm", "single quantity that the scene gives"),
        ("deviations.coupler.mass_per_length", "1 %", "single quantity that the scene gives"),
        ("deviations.links.coupler", "-1 mm", "half-width of 0 or more"),
        ("deviations.links.coupler", "150 mm", "3 times that less"),
        ("deviations.links", 3, "single quantity"),
    ],
)
def test_what_is_no_tolerance(key, text, words):
    with pytest.raises(BadInput) as refusal:
        el.load_scene(SCENE, {key: text})
    assert words in str(refusal.value) and key.rpartition(".")[2] in str(refusal.value)


def test_every_tolerance_that_is_none_is_told_at_once():
    with pytest.raises(BadInput) as refusal:
        load(links__coupler="381 mm +- 1 kg", links__crank="3 in +- x", deviations__x__y=3)
    told = {problem.where for problem in refusal.value.problems}
    assert told == {"links.coupler", "links.crank", "deviations.x.y"}


def test_a_bound_of_a_quantity_without_a_sign_may_be_wider_than_it(tmp_path):
    scene = el.load_scene("slider_crank_example", {"links.offset": "1 mm +- 3 mm"})
    assert scene.tolerances["links.offset"] == pytest.approx(3e-3)
