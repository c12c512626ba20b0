"""Emission: templates and keys agree both ways, lines fit, the text is what the records say."""

from __future__ import annotations

import ast
import json
import shutil
from dataclasses import replace

import numpy as np
import pytest
from derivations import loaded
from elastolink.derive import emission
from elastolink.derive.emission import TemplateKeys, emit
from elastolink.derive.ir import Argument, Kernel, ModuleSpec, Result, Statement, Table
from elastolink.derive.spec import ModelSpec

WORDS = "a quantity whose meaning takes very many words to explain, " * 3 + "at last"
KERNEL = Kernel(
    name="angle_functions",
    summary="Return something",
    arguments=(
        Argument("theta", "array_like, shape (...)", "rad", "Crank angle"),
        *(Argument(f"length_{i}", "float", "m", WORDS) for i in range(12)),
    ),
    results=(
        Result("first", "ndarray, shape (...)", "", WORDS),
        Result("second", "ndarray, shape (...)", "m", "Short"),
    ),
    statements=(
        Statement("x0", "xp.sin(theta)"),
        Statement("x1", " + ".join(f"length_{i} * x0**{i}" for i in range(12))),
    ),
    returns=("x0", " - ".join(["x1", *(f"length_{i} * theta" for i in range(12))])),
    operations=42,
)
LINEAR = ModuleSpec(
    spec=ModelSpec("press", "full", flexible=("ram", "slide"), modes=3, drop=("spin",)),
    family="linear_periodic",
    title="A press",
    notes=(WORDS,),
    references=("Nobody (1.1)",) * 12,
    kernels=(KERNEL,),
    parameters=(Argument("inertia", "float", "kg m^2", 'The "big" one'),),
    tables=(
        Table(
            "TERMS",
            (
                ("K", 0, None, "first", "modal_1"),
                ("B", 2, "inertia_" * 9, "second_" * 9, "modal_" * 6),
            ),
            WORDS,
        ),
        Table("MODAL_1", (1.0,) * 60),
        Table("PLACES", {"mass": ((2, 2), ((0, 0, 0), (1, 1, 1)))}),
    ),
)
CLOSED = replace(LINEAR, family="closed_form", tables=(), parameters=())
CONTENT = "0123456789abcdef" * 2


@pytest.fixture
def templates(tmp_path, monkeypatch):
    """Return a copy of the templates that a test may spoil."""
    copy = tmp_path / "templates"
    shutil.copytree(emission._TEMPLATES, copy)
    monkeypatch.setattr(emission, "_TEMPLATES", copy)
    return copy


@pytest.mark.parametrize("module", [LINEAR, CLOSED], ids=lambda m: m.family)
def test_the_text_is_a_module_that_says_what_the_records_say(module):
    text = emit(module, CONTENT)
    space = vars(loaded(text))
    assert space["FAMILY"] == module.family
    assert json.loads(space["SPEC"]) == json.loads(module.spec.canonical())
    assert space["CONTENT"] == CONTENT
    assert space["__all__"] == ["angle_functions"]
    assert space["RETURNS"] == {"angle_functions": ("first", "second")}
    header = ast.get_docstring(ast.parse(text))
    for part in ("A press.", "Do not edit.", "angle_functions: 42 operations", CONTENT, "SymPy"):
        assert part in header
    for part in ("mechanism press", "flexible ram, slide", "3 modes", "without spin"):
        assert part in " ".join(header.split())


def test_tables_and_meanings_stand_in_the_text():
    space = vars(loaded(emit(LINEAR, CONTENT)))
    for table in LINEAR.tables:
        assert space[table.name] == table.value
    assert space["PARAMETERS"] == ("inertia",)
    assert space["QUANTITIES"]["inertia"] == ("kg m^2", 'The "big" one')
    assert space["QUANTITIES"]["second"] == ("m", "Short")


def test_a_name_with_two_meanings_is_refused():
    other = replace(KERNEL, name="other", results=(Result("second", "float", "s", "A time"),))
    with pytest.raises(ValueError, match="second stands for"):
        emit(replace(CLOSED, kernels=(KERNEL, other)), CONTENT)


def test_the_function_computes_what_the_statements_say():
    function = vars(loaded(emit(LINEAR, CONTENT)))["angle_functions"]
    theta, lengths = np.linspace(-1.0, 2.0, 5), np.arange(1.0, 13.0)
    first, second = function(theta, *lengths)
    powers = np.sin(theta)[:, None] ** np.arange(12)
    assert first == pytest.approx(np.sin(theta), rel=1e-15)
    assert second == pytest.approx(powers @ lengths - lengths.sum() * theta, rel=1e-13)


@pytest.mark.parametrize("module", [LINEAR, CLOSED], ids=lambda m: m.family)
def test_lines_fit_and_end_cleanly(module):
    text = emit(module, CONTENT)
    assert max(map(len, text.splitlines())) <= 100
    assert all(line == line.rstrip() for line in text.splitlines())
    assert text.endswith("\n")
    assert not text.endswith("\n\n")
    assert "\n\n\n\n" not in text


def test_a_key_that_the_template_does_not_use_is_an_error(templates):
    base = templates / "module.py.j2"
    base.write_text(base.read_text().replace("{{ title }}", "Title"))
    with pytest.raises(TemplateKeys, match=r"not used \['title'\]"):
        emit(CLOSED, CONTENT)


def test_a_key_that_is_not_supplied_is_an_error(templates):
    base = templates / "module.py.j2"
    base.write_text(base.read_text() + "{{ colour }}")
    with pytest.raises(TemplateKeys, match=r"not supplied \['colour'\]"):
        emit(CLOSED, CONTENT)
