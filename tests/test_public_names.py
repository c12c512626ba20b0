"""Public names: they exist, they are listed in one order, and what is not public says so."""

import ast
import contextlib
import importlib
import inspect
import pkgutil
import traceback
from pathlib import Path

import elastolink as el
import elastolink.derive.authoring
import elastolink.runtime
import public_index
import pytest
from fresh_process import python

ROOT = Path(__file__).parents[1]
RUNTIME = ["elastolink.runtime"] + [
    found.name
    for found in pkgutil.walk_packages(elastolink.runtime.__path__, "elastolink.runtime.")
]
PACKAGES = [name for name in RUNTIME if hasattr(importlib.import_module(name), "__path__")]


@pytest.mark.parametrize("name", el.__all__)
def test_a_public_name_loads_and_says_what_it_is(name):
    value = getattr(el, name)
    assert name in dir(el)
    if name != "__version__":
        assert inspect.getdoc(value)
        assert value.__module__.startswith("elastolink.runtime.")


def test_the_list_of_public_names_is_sorted_and_complete():
    assert el.__all__ == sorted(el.__all__, key=lambda name: (name != "__version__", name))
    assert dir(el) == sorted([*el.__all__, *public_index.SUBJECTS])


@pytest.mark.parametrize("subject", public_index.SUBJECTS)
def test_a_subject_lists_its_public_names_alone(subject):
    room = getattr(el, subject)
    assert room is importlib.import_module(f"elastolink.runtime.{subject}")
    assert dir(room) == sorted(room.__all__)
    for name in room.__all__:
        assert getattr(room, name) is not None


def test_the_package_and_its_stub_say_what_is_there():
    """``python tests/public_index.py`` writes both."""
    source = public_index.PACKAGE.read_text()
    assert source == public_index.package(source)
    assert public_index.STUB.read_text() == public_index.stub()
    assert el.__doc__ in source


@pytest.mark.parametrize(
    ("misspelt", "meant"),
    [
        ("natural_frequancies", "natural_frequencies"),
        ("four_bar", "FourBar"),
        ("StressCurve", "stress_curve"),
        ("diagnose", "design.diagnose"),
        ("stabilize", "design.stabilise"),
        ("desing", "design"),
        ("design.diagnos", "diagnose"),
        ("hill.hill_boundary", "hill_boundaries"),
        ("eigenvalues", None),
        ("derived", None),
        ("a.b", None),
    ],
)
def test_a_misspelt_name_is_refused_once_with_the_right_one(misspelt, meant):
    """In what the error says, and in the traceback, to which Python can add a suggestion."""
    subject, _, name = misspelt.rpartition(".") if misspelt != "a.b" else ("", "", misspelt)
    package = getattr(el, subject) if subject else el
    with pytest.raises(AttributeError) as refused:
        getattr(package, name)
    hint = f"; did you mean '{meant}'?" if meant else ""
    says = f"module '{package.__name__}' has no attribute '{name}'{hint}"
    assert str(refused.value) == says
    assert "".join(traceback.format_exception_only(refused.value)) == f"AttributeError: {says}\n"


def test_python_itself_asks_for_names_at_no_cost():
    """What Python and its tools look for, and modules before their import, loads nothing."""
    code = (
        "import sys, elastolink as el\n"
        "assert not any(hasattr(el, name) for name in ('derive', '__path__x', '_repr_html_'))\n"
        "from elastolink import derive\n"
        "print(sorted(n for n in sys.modules if n.startswith('elastolink.runtime')))"
    )
    assert python(code) == "[]\n"


def test_a_name_loads_its_own_module_alone():
    code = (
        "import sys, elastolink as el; el.BadInput\n"
        "print(sorted(n for n in sys.modules if n.startswith('elastolink.runtime.')))"
    )
    assert python(code) == "['elastolink.runtime.core', 'elastolink.runtime.core.errors']\n"


@pytest.mark.parametrize("package", PACKAGES)
def test_no_public_name_is_hidden_by_a_module_of_that_name(package):
    # Importing such a module can put it in the place of what the name stands for.
    module = importlib.import_module(package)
    for found in pkgutil.iter_modules(module.__path__):
        importlib.import_module(f"{package}.{found.name}")
    hidden = [n for n in getattr(module, "__all__", ()) if inspect.ismodule(getattr(module, n))]
    assert not hidden


@pytest.mark.parametrize("package", PACKAGES)
def test_each_package_lists_what_it_makes_public(package):
    module = importlib.import_module(package)
    tree = ast.parse(Path(module.__file__).read_text())
    own = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.level and node.module != "core.lazy"
    ]
    names = {alias.asname or alias.name for node in own if node.module for alias in node.names}
    if not own:
        return  # a package of files that are asked for one by one
    assert len(set(module.__all__)) == len(module.__all__)
    assert set(module.__all__) <= set(dir(module))
    assert {name for name in names if not name.startswith("_")} <= set(module.__all__)


SCRIPT = """
import elastolink as el

system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
chart = el.stability_chart(system, x=("speed", [20.0, 90.0]), y=("follower_inertia", [1e-3, 5e-3]))
reveal_type(chart)
reveal_type(chart.stable)
reveal_type(el.FourBar(5.0, 1.0, 5.0, 2.0).motion(0.3))
reveal_type(el.design.diagnose)
el.stability_chart(system, x="speed", y="follower_inertia")
el.natural_frequancies
el.design.diagnos
"""
SAID = (
    '6: note: Revealed type is "elastolink.runtime.stability.chart.StabilityChart"',
    '7: note: Revealed type is "numpy.ndarray[',
    '8: note: Revealed type is "elastolink.runtime.linkages.four_bar.FourBarMotion"',
    '9: note: Revealed type is "def (scene: elastolink.runtime.scenes.scene.Scene, speed: float,',
    '10: error: Argument "x" to "stability_chart" has incompatible type "str"',
    '10: error: Argument "y" to "stability_chart" has incompatible type "str"',
    '11: error: Module has no attribute "natural_frequancies"',
    '12: error: Module has no attribute "diagnos"',
)


@pytest.mark.slow
def test_a_type_checker_knows_what_a_script_of_a_user_gets(tmp_path):
    import mypy.api

    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    options = ["--strict", "--config-file=", f"--cache-dir={tmp_path / 'cache'}"]
    said, trouble, _ = mypy.api.run([*options, str(script)])
    lines = [line.partition("script.py:")[2] for line in said.splitlines()[:-1]]
    assert trouble == ""
    assert [line[: len(start)] for line, start in zip(lines, SAID, strict=True)] == list(SAID)


def test_the_names_for_authors_of_models_are_there():
    authoring = elastolink.derive.authoring
    assert authoring.__all__ == sorted(authoring.__all__)
    for name in authoring.__all__:
        assert inspect.getdoc(getattr(authoring, name))


def test_every_public_name_is_on_the_page_of_the_interface():
    page = (ROOT / "docs" / "api.md").read_text()
    missing = [name for name in el.__all__ if name not in page and name != "__version__"]
    assert missing == []


# A likely second argument of each name, so that the first one is what is refused.
SECOND = {
    "speed": 50.0,
    "speeds": (40.0, 50.0),
    "speed_range": (40.0, 50.0),
    "x": ("speed", [40.0, 50.0]),
    "y": ("mu", [0.0, 1.0]),
    "regions": (1,),
    "path": "motion.gif",
}


@pytest.mark.parametrize("name", el.__all__)
@pytest.mark.parametrize(
    "wrong", [None, "x", 1.5, {}, el.load_scene("mathieu")], ids=lambda wrong: type(wrong).__name__
)
def test_what_is_nothing_of_the_kind_is_refused_in_words(name, wrong, tmp_path, monkeypatch):
    """Never by an error of Python's own; what a name can use is answered."""
    monkeypatch.chdir(tmp_path)
    call = getattr(el, name)
    if not callable(call) or (inspect.isclass(call) and issubclass(call, BaseException)):
        return
    wanted = [
        parameter
        for parameter in inspect.signature(call).parameters.values()
        if parameter.default is parameter.empty
        and parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    ]
    given = {one.name: SECOND.get(one.name, 1.0) for one in wanted[1:]}
    if wanted:
        with contextlib.suppress(el.ElastolinkError):
            call(**{wanted[0].name: wrong}, **given)
