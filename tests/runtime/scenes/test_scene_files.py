"""Scenes written as TOML files: what is loaded again is equal."""

import tomllib

import pytest
from elastolink.runtime.scenes import list_scenes, load_scene, with_numbers
from elastolink.runtime.scenes.writing import toml_text
from hypothesis import given, settings
from hypothesis import strategies as st

RIG = "smith_1972_5152_sixteenth_inch"
CHANGES = {
    "links.crank": "75 mm +- 0.1 mm",
    "coupler.mass_per_length": 0.25,
    "model.modes": 2,
    "title": 'A "rig" of one\'s own,\nof 1/16 in \\ µ \x7f\u2028',
    "deviations.links.frame": "0.2 mm",
    "measured.follower_inertias": None,
    "measured.follower_inertia_tolerances": None,
    "operation.speed_range": [10.5, "900 rpm"],
}


def again(scene, folder):
    """Return the scene of the file that a scene is written to."""
    path = folder / f"{scene.name}.toml"
    path.write_text(scene.to_toml(), "utf-8")
    return load_scene(path)


@pytest.mark.parametrize("name", list_scenes())
def test_every_built_in_scene_is_equal_when_loaded_again(tmp_path, name):
    scene = load_scene(name)
    read = again(scene, tmp_path)
    assert read == scene and read.digest() == scene.digest()
    assert read.document == scene.document


def test_so_is_a_changed_one(tmp_path):
    scene = load_scene(RIG, CHANGES)
    read = again(scene, tmp_path)
    assert read == scene and read.title == CHANGES["title"]
    assert read.tolerances["links.crank"] == pytest.approx(1e-4)
    assert read.deviations["links.frame"] == pytest.approx(2e-4)
    assert "natural_frequency" not in read.document["coupler"]


def test_and_one_with_other_numbers(tmp_path):
    scene = with_numbers(load_scene("quick_return_example"), {"loads.tool.couple": -1.0 / 3.0})
    assert again(scene, tmp_path) == scene


def test_tables_of_a_scene_of_ones_own_stay_as_they_are():
    document = {"schema": {"a": {"b": {"dimension": "length", "default": [1.0]}}}, "a": {"b": 1}}
    assert toml_text(document).splitlines() == [
        "",
        "[schema.a]",
        'b = { dimension = "length", default = [1.0] }',
        "",
        "[a]",
        "b = 1",
    ]


VALUES = st.recursive(
    st.text(st.characters(exclude_categories=["Cs"]))
    | st.integers()
    | st.booleans()
    # As numbers of a scene are: finite.
    | st.floats(allow_nan=False, allow_infinity=False),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), inner, max_size=3)
    ),
    max_leaves=12,
)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), VALUES, max_size=4))
def test_any_tables_are_read_again_as_they_were(document):
    assert tomllib.loads(toml_text(document)) == document
