"""Emission: templates and keys agree both ways, lines fit, the text is what the records say.

The text of the packaged modules is compared byte by byte: ``test_regenerate.py``.
"""

import json
import shutil
from dataclasses import replace

import pytest
from derivations import CONTENT, loaded
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
    results=(Result("first", "float", "", WORDS), Result("second", "float", "m", "Short")),
    statements=(Statement("x1", " + ".join(f"length_{i} * theta**{i}" for i in range(12))),),
    returns=("x1", " - ".join(["x1", *(f"length_{i} * theta" for i in range(12))])),
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
        Table("TERMS", (("B", 2, "inertia_" * 9, "second_" * 9, "modal_" * 6),), WORDS),
        Table("MODAL_1", (1.0,) * 60),
        Table("PLACES", {"mass": ((2, 2), ((0, 0, 0), (1, 1, 1)))}),
    ),
)
CLOSED = replace(LINEAR, family="closed_form", tables=(), parameters=())


@pytest.fixture
def template(tmp_path, monkeypatch):
    """Return a copy of the module's template that a test may spoil."""
    copy = tmp_path / "templates"
    shutil.copytree(emission._TEMPLATES, copy)
    monkeypatch.setattr(emission, "_TEMPLATES", copy)
    return copy / "module.py.j2"


@pytest.mark.parametrize("module", [LINEAR, CLOSED], ids=lambda m: m.family)
def test_lines_fit_whatever_a_model_says(module):
    text = emit(module, CONTENT)
    assert max(map(len, text.splitlines())) <= 100
    assert all(line == line.rstrip() for line in text.splitlines())
    assert text.endswith("\n") and not text.endswith("\n\n") and "\n\n\n\n" not in text
    space = vars(loaded(text))
    assert json.loads(space["SPEC"]) == json.loads(module.spec.canonical())
    assert {table.name: space[table.name] for table in module.tables} == {
        table.name: table.value for table in module.tables
    }
    assert module is CLOSED or space["QUANTITIES"]["inertia"] == ("kg m^2", 'The "big" one')


def test_a_name_with_two_meanings_is_refused():
    other = replace(KERNEL, name="other", results=(Result("second", "float", "s", "A time"),))
    with pytest.raises(ValueError, match="second stands for"):
        emit(replace(CLOSED, kernels=(KERNEL, other)), CONTENT)


def test_a_key_that_the_template_does_not_use_is_an_error(template):
    template.write_text(template.read_text().replace("{{ title }}", "Title"))
    with pytest.raises(TemplateKeys, match=r"not used \['title'\]"):
        emit(CLOSED, CONTENT)


def test_a_key_that_is_not_supplied_is_an_error(template):
    template.write_text(template.read_text() + "{{ colour }}")
    with pytest.raises(TemplateKeys, match=r"not supplied \['colour'\]"):
        emit(CLOSED, CONTENT)
