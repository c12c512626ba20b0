"""Public names: they exist, they are listed in one order, and what is not public says so."""

import ast
import contextlib
import importlib
import inspect
import pkgutil
from pathlib import Path

import elastolink as el
import elastolink.derive.authoring
import elastolink.runtime
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
    assert dir(el) == sorted(el.__all__)


def test_an_unknown_name_is_refused_as_python_does():
    with pytest.raises(AttributeError, match="no attribute 'four_bar'"):
        _ = el.four_bar


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
