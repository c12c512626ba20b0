"""Malformed scene files: whatever stands in them, the answer is a scene or BadInput."""

import math
import tomllib
from importlib import resources

import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.scenes import load_scene, scene_from_document
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

RIG = "smith_1972_5152_sixteenth_inch"
FOLDER = resources.files("elastolink.runtime.scenes") / "data"
TEXT = (FOLDER / f"{RIG}.toml").read_text()
DOCUMENT = tomllib.loads(TEXT)
BROKEN = tomllib.loads("""
title = 3
extra = 1
modell = {}
model = {mechanism = "four_bar", flexible = ["couplr"], formulation = "complet", modes = 0}
coupler = {bending_stiffness = -1, mass_per_length = 1, natural_frequency = "3 1/s", damping = -0.1}
measured = {follower_inertias = [1, 2], follower_inertia_tolerances = [1], speeds = 3}
chart = {x = "sped", x_range = [1, 2, 3], y = "follower_inertia", y_range = ["3 m", 4]}
[links]
frame = "15 inn"
crank = "3 kg"
coupler = -3
crnk = 3
bending_stiffness = 3
assembly = "opened"
""")
KEYS = [f"{table}.{key}" for table, v in DOCUMENT.items() if isinstance(v, dict) for key in v]


def refuse(document, *parts):
    """Check that a document is refused, naming each of the parts, and return the problems."""
    with pytest.raises(BadInput) as caught:
        scene_from_document("broken", document)
    for part in parts:
        assert part in str(caught.value)
    assert all("\n" not in str(problem) for problem in caught.value.problems)
    return caught.value.problems


WRONG = """
model.formulation title extra [modell] model.flexible[0] model.modes links.crnk
links.bending_stiffness links.frame links.crank links.coupler links.follower links.assembly
coupler.bending_stiffness coupler.natural_frequency coupler.damping [coupler] [follower]
measured.speeds chart.x chart.x_range chart.y_range[0] measured.follower_inertia_tolerances
"""


def test_every_problem_of_a_file_is_reported_at_once():
    problems = refuse(BROKEN)
    assert [problem.where for problem in problems] == WRONG.split()
    assert all(problem.found and problem.expected and problem.fix for problem in problems)


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"links.frame": "30 in"}, "cannot close"),
        ({"links.crank": "10 in"}, "make it shorter than 0.1524 m"),
        ({"links.crank": "6 in"}, "exclusive"),
        ({"links.frame": "9 in", "links.crank": "6 in"}, "cannot turn fully"),
        ({"links.crank": 0.0}, "positive"),
        ({"links.crank": math.nan}, "finite"),
        ({"links.crank": True}, "a length"),
        ({"coupler.bending_stiffness": "171.5 lbf*in"}, "a bending stiffness"),
        ({"coupler.mass_per_length": "0.3 lbf/in"}, "a weight"),
        ({"coupler.damping": -1e-9}, "non-negative"),
        ({"coupler.first_moment": 100.0}, "first_moment^2 / mass"),
        ({"coupler.damping": 0.1, "coupler.damping_ratio": 0.1}, "at most one"),
        ({"follower.inertia": None}, "add it to [follower]"),
        ({"operation.speed_range": [10.0, 5.0]}, "increase"),
        ({"operation.speed_range": 10.0}, "brackets"),
        ({"operation.speed_range": ["10 rpm", "20 m"]}, "operation.speed_range[1]"),
        ({"measured.follower_inertias": []}, "an empty list"),
        ({"measured.regions": [1.5], "measured.speeds": [1.0]}, "a whole number"),
        ({"measured.inertias": [0.001]}, "as many as measured.speeds"),
        ({"model.formulation": "kinematics"}, "model.flexible"),
        ({"model.flexible": ["follower"]}, "model.flexible[0]"),
        *(({"model.modes": modes}, "a whole number") for modes in ("2", 2.0, True)),
        ({"model.modes": 10**9}, "at most 1000"),
        ({"model.outputs": ["stablity"]}, "did you mean stability?"),
        ({"model.mechanism": "four-bar"}, "did you mean four_bar?"),
        ({"model.mechanism": "trolley"}, "[schema]"),
        ({"model.mechanism": None}, "model.mechanism"),
        ({"model.formulation": None}, "model.formulation"),
        ({"chart.x": "follower_inertia"}, "chart"),
        ({"chart.x_range": [0.0, 4.0]}, "above 0"),
        ({"chart.y_range": [-1.0, 4.0]}, "from 0 up"),
        ({"chart.x_points": 10**6}, "at most"),
        ({"chart.x_points": 1}, "chart.x_points: found 1; expected at least 2"),
        *(({key: 1.0}, "") for key in ("foo", "links", "", "links.", "links.crnk", "title.x")),
    ],
)
def test_one_wrong_value(changes, part):
    with pytest.raises(BadInput) as caught:
        load_scene(RIG, changes)
    assert part in str(caught.value)


def test_a_kinematic_scene_may_have_a_crank_that_does_not_turn_but_must_close():
    rocker = load_scene("smith_1972_2122", {"links.crank": "2.5 in"})
    assert not rocker.mechanism().crank_turns
    with pytest.raises(BadInput, match="cannot close"):
        load_scene("smith_1972_2122", {"links.crank": "6 in"})
    with pytest.raises(BadInput, match=r"model\.modes"):
        load_scene("smith_1972_2122", {"model.modes": 2})


@pytest.mark.parametrize(
    "document",
    [
        {},
        {"model": 3},
        {"model": {}},
        {"model": {"mechanism": 3}},
        {"model": {"mechanism": ["four_bar"], "formulation": "complete"}},
        {"model": {"mechanism": "four_bar"}},
        {"model": {"mechanism": "four_bar", "formulation": "complete"}, "links": 3},
        {"model": {"mechanism": "hill", "formulation": "plain"}, "function": {"a": []}},
        {"model": {"mechanism": "own", "formulation": "x"}, "schema": 3},
        {"model": {"mechanism": 3}, "schema": {"links": {"crank": "length"}}},
        {"schema": {}},
    ],
)
def test_documents_without_a_usable_model(document):
    refuse(document)


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (b"", "[model]"),
        (b"[model", "broken TOML"),
        (b"a = 1\na = 2\n", "broken TOML"),
        (b'title = "\xff"\n', "UTF-8"),
        (b"\x00\x01\x02", "broken TOML"),
        (b"a = " + b"[" * 5000, "TOML"),
        (b"a = 1979-05-27\n[model]\nmechanism = 'hill'\n", "unknown key"),
    ],
)
def test_files_that_are_no_scene(tmp_path, content, part):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(BadInput) as caught:
        load_scene(path)
    assert part in str(caught.value)


@pytest.mark.parametrize(
    "name", ["smith", "missing.toml", "", "a\0b", "a\0b.toml", ".", "x" * 5000]
)
def test_names_that_are_no_scene(name):
    with pytest.raises(BadInput):
        load_scene(name)


def test_a_folder_and_a_file_with_another_ending(tmp_path):
    with pytest.raises(BadInput, match="readable file"):
        load_scene(tmp_path)
    path = tmp_path / "scene.txt"
    path.write_text(TEXT)
    assert load_scene(path).get("links.crank") == load_scene(RIG).get("links.crank")


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=12),
    st.lists(st.one_of(st.floats(), st.text(max_size=4), st.integers()), max_size=4),
    st.dictionaries(st.text(max_size=4), st.floats(), max_size=2),
)


def sound_or_refused(load, *arguments):
    """Check what every accepted scene promises, or that there are problems to tell."""
    try:
        scene = load(*arguments)
    except BadInput as error:
        assert error.problems
        return
    assert scene.to_dict()["links"]["frame"] > 0
    assert scene.mechanism().crank_turns
    for key in ("bending_stiffness", "mass_per_length", "inertia"):
        assert 0 < scene.get(f"coupler.{key}") <= math.inf


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.dictionaries(st.sampled_from(KEYS), VALUES, min_size=1, max_size=3))
def test_random_values_in_a_sound_file(changes):
    sound_or_refused(load_scene, RIG, changes)


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_a_file_with_a_random_cut(data):
    start = data.draw(st.integers(0, len(TEXT)))
    length = data.draw(st.integers(1, 60))
    insert = data.draw(st.text(alphabet="[]{}=\"'\n.#abc019 -_", max_size=6))
    try:
        document = tomllib.loads(TEXT[:start] + insert + TEXT[start + length :])
    except tomllib.TOMLDecodeError:
        return
    sound_or_refused(scene_from_document, "damaged", document)


@settings(max_examples=40, deadline=None)
@given(st.recursive(VALUES, lambda inner: st.dictionaries(st.text(max_size=6), inner, max_size=4)))
def test_any_document_at_all(content):
    document = content if isinstance(content, dict) else {"model": content}
    with pytest.raises(BadInput):
        scene_from_document("random", document)
