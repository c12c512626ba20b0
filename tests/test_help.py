"""What ``help`` says of each public name: a sentence, what goes in and comes out, an example."""

import doctest
import inspect
import re
from collections.abc import Callable
from operator import attrgetter

import elastolink as el
import pytest
from public_index import MORE, ROOM

NAMES = [*ROOM, *(f"{subject}.{name}" for subject, names in MORE.items() for name in names)]
# Examples that take longer than a second, as their functions do.
SLOW = {
    "animate",
    "campbell",
    "fatigue",
    "nonlinear.basins",
    "nonlinear.coexisting_motions",
    "quiet_speeds",
    "run_through",
    "running_speed",
}


def marked(names: list[str]) -> list:
    return [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in names]


def lacking(value: Callable) -> list[str]:
    """Return what the docstring of a function or class lacks."""
    first, *rest = (inspect.getdoc(value) or "").splitlines() or [""]
    sections = set(re.findall(r"^(\w+)\n-{4,}$", inspect.getdoc(value) or "", re.MULTILINE))
    wanted = [{"Examples"}]
    if not inspect.isclass(value):
        takes = inspect.signature(value).parameters
        wanted += [{"Returns", "Yields"}, *([{"Parameters"}, {"Raises"}] if takes else [])]
    elif not issubclass(value, Exception):
        wanted.append({"Parameters", "Attributes"})
    lacks = [" or ".join(sorted(names)) for names in wanted if not names & sections]
    if not re.fullmatch(r"\S.*[.]", first) or (rest and rest[0]):
        lacks.insert(0, "one sentence in one line")
    if not doctest.DocTestParser().get_examples(inspect.getdoc(value) or ""):
        lacks.append("an example to run")
    return lacks


@pytest.mark.parametrize("name", NAMES)
def test_help_says_what_a_name_does_takes_and_returns(name):
    assert lacking(attrgetter(name)(el)) == []


def test_what_help_lacks_is_seen():
    def bare(x):
        return x

    def half(x):
        """Return
        x.

        Examples
        --------
        None.
        """
        return x

    sections = ["Returns or Yields", "Parameters", "Raises"]
    sentence, example = "one sentence in one line", "an example to run"
    assert lacking(bare) == [sentence, "Examples", *sections, example]
    assert lacking(half) == [sentence, *sections, example]
    assert set(NAMES) >= SLOW


@pytest.mark.parametrize("name", marked(NAMES))
def test_the_example_gives_what_it_shows(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    value = inspect.unwrap(attrgetter(name)(el))
    (test,) = doctest.DocTestFinder(recurse=False).find(value, name, module=False, globs={})
    assert test.examples[0].source == "import elastolink as el\n"
    assert test.examples[-1].want
    assert not any(example.options for example in test.examples)
    said: list[str] = []
    runner = doctest.DocTestRunner()
    runner.run(test, out=said.append)
    assert runner.failures == 0, "".join(said)
