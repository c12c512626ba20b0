"""The JSON Schema of scenes and the page of their keys, against the loader that they describe."""

import json
import random
import re
import tomllib
from collections import Counter
from copy import deepcopy
from importlib import resources
from pathlib import Path

import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.units import DIMENSIONS, text_pattern, to_si
from elastolink.runtime.scenes import list_scenes, load_scene, scene_from_document
from elastolink.runtime.scenes.beginning import new_kinds, new_scene
from elastolink.runtime.scenes.descriptions import keys_page, scene_schema
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

DOCS = Path(__file__).parents[3] / "docs"
FOLDER = resources.files("elastolink.runtime.scenes") / "data"
DOCUMENTS = {name: tomllib.loads((FOLDER / f"{name}.toml").read_text()) for name in list_scenes()}
SCHEMA = scene_schema()
VALIDATOR = Draft202012Validator(SCHEMA)


def problems_of(document):
    """Return what the loader says of a document; nothing where it takes it."""
    try:
        scene_from_document("mutant", document)
    except BadInput as refusal:
        return str(refusal)
    return ""


def test_the_schema_is_one_and_the_committed_copies_are_current():
    Draft202012Validator.check_schema(SCHEMA)
    text = json.dumps(SCHEMA, indent=1, ensure_ascii=False)
    assert (DOCS / "scene.schema.json").read_text("utf-8") == text + "\n"
    assert (DOCS / "scene_keys.md").read_text("utf-8") == keys_page() + "\n"


@pytest.mark.parametrize("name", list_scenes())
def test_built_in_scenes_are_accepted(name):
    assert best_match(VALIDATOR.iter_errors(DOCUMENTS[name])) is None


@pytest.mark.parametrize("kind", new_kinds())
def test_begun_scenes_are_accepted(kind):
    assert best_match(VALIDATOR.iter_errors(tomllib.loads(new_scene(kind)))) is None


def test_what_declares_its_own_tables_is_accepted_and_checked():
    own = tomllib.loads((DOCS / "examples" / "slider_crank_rod.toml").read_text())
    assert best_match(VALIDATOR.iter_errors(own)) is None
    own["schema"]["rod"]["damping"]["dimension"] = "dampness"
    assert "dampness" in best_match(VALIDATOR.iter_errors(own)).message


def test_an_error_names_its_place():
    document = deepcopy(DOCUMENTS["smith_1972_5152_sixteenth_inch"])
    document["links"]["crnk"] = document["links"].pop("crank")
    found = {(error.json_path, error.validator) for error in VALIDATOR.iter_errors(document)}
    assert found == {("$.links", "required"), ("$.links", "additionalProperties")}


def misspelt(word, rng):
    """Return a word with one letter doubled."""
    place = rng.randrange(len(word))
    return word[: place + 1] + word[place:]


def mutants(count, seed):
    """Yield scenes with one wrong thing each, as people make them."""
    rng = random.Random(seed)
    kinds = ("key", "table", "type", "unit", "sign", "missing", "choice", "rival")
    while count:
        kind, document = rng.choice(kinds), deepcopy(DOCUMENTS[rng.choice(list_scenes())])
        scene = scene_from_document("whole", document)
        tables = [name for name, table in document.items() if isinstance(table, dict)]
        table = rng.choice(tables)
        content, known = document[table], scene.layout.table(table)
        if known.named:
            content = content[rng.choice(list(content))]
        name = rng.choice(list(content))
        key, value = known.key(name), content[name]
        units = isinstance(value, str) and key.kind == "quantity" and " " in value
        if kind == "key":
            content[misspelt(name, rng)] = content.pop(name)
        elif kind == "table":
            document[misspelt(table, rng)] = document.pop(table)
        elif kind == "type":
            content[name] = rng.choice(([], {}, True, [[]], "much", 2.5))
        elif kind == "unit" and units:
            wrong = "m" if key.dimension != "length" else "kg"
            content[name] = f"{value.split()[0]} {wrong}"
        elif kind == "sign" and units and key.limit != "any":
            content[name] = f"-{value}"
        elif kind == "missing":
            del content[name]
        elif kind == "choice" and key.choices and isinstance(value, str):
            content[name] = misspelt(value, rng)
        elif kind == "rival" and known.rivals(name):
            content[known.rivals(name)[0]] = 1.0
        else:
            continue
        count -= 1
        yield document


def compared(count, seed):
    """Return how many changed scenes loader and schema refuse, and why the loader alone does."""
    told, alone = Counter(), []
    for document in mutants(count, seed):
        problems, valid = problems_of(document), VALIDATOR.is_valid(document)
        assert problems or valid, best_match(VALIDATOR.iter_errors(document))
        told["loader"] += bool(problems)
        told["schema"] += not valid
        alone += [problems] * (bool(problems) and valid)
    return told, alone


def test_of_a_hundred_changed_scenes_the_schema_refuses_all_that_it_can():
    told, alone = compared(100, seed=1972)
    assert told == {"loader": 90, "schema": 89}
    assert len(alone) == 1 and "the lengths cannot close" in alone[0]


UNITS = """m mm in kg s rad rpm Hz N Pa GPa lbf percent deg J min 1/s mm**2 in^4 N*m lbf*in**2
kg/m 1/rpm furlong inn µm 5 % m**+2 m) (m *m"""
NUMBERS = "0 1 -1 +2.5 .5 -.5 0.0 -0.0 1e-3 21 0e5 12,5 1.2.3 1e99999 x"


def texts():
    """Return a strategy of quantities as people write them, right and wrong."""
    units, numbers = (st.sampled_from(line.split()) for line in (UNITS, NUMBERS))
    gaps, more = st.sampled_from(["", " "]), st.sampled_from(["", " ", " +- 1", " +- 2 %"])
    return st.builds("{}{}{}{}".format, numbers, gaps, units | st.just(""), more)


@settings(max_examples=400, deadline=None, derandomize=True)
@given(texts(), st.sampled_from(sorted(DIMENSIONS)), st.sampled_from(("any", "positive")))
def test_no_text_that_the_loader_reads_is_refused(text, dimension, limit):
    value = text.partition("+-")[0]
    try:
        number = to_si(value, dimension)
    except BadInput:
        return
    if limit == "any" or number > 0.0:
        assert re.search(text_pattern(dimension, limit), text)


@pytest.mark.parametrize(
    ("text", "dimension", "limit"),
    [
        ("3 kg", "length", "any"),
        ("21 kg", "length", "any"),
        ("2.1kg", "length", "any"),
        ("2e1 kg", "length", "any"),
        ("3 mm", "area", "any"),
        ("3 mm**3", "area", "any"),
        ("3 1/s", "frequency", "any"),
        ("3 kg +- 1 mm", "length", "any"),
        ("-3 mm", "length", "positive"),
        ("0.0 mm", "length", "positive"),
        ("-0.1", "dimensionless", "non-negative"),
        ("12,5 mm", "length", "any"),
        ("5 %", "dimensionless", "any"),
        ("mm", "length", "any"),
    ],
)
def test_texts_that_a_pattern_can_judge_are_refused(text, dimension, limit):
    assert not re.search(text_pattern(dimension, limit), text)


def test_every_key_of_the_loader_is_on_the_page():
    page = keys_page()
    for name in list_scenes():
        for table in load_scene(name).layout.all_tables():
            assert f"## {table.heading}" in page
            assert all(f"| `{key.name}` |" in page and key.meaning in page for key in table.keys)
