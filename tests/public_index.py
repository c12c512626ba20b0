"""What the package says of its public names: by subject in its docstring, with types in its stub.

``python tests/public_index.py`` writes both anew; tests/test_help.py holds them.
"""

import re
import textwrap
from pathlib import Path

import elastolink as el
from elastolink.runtime.core.results import Result

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "api.md").read_text().partition("## Names that went")[0]
PACKAGE = ROOT / "runtime" / "_root" / "__init__.py"
STUB = PACKAGE.with_suffix(".pyi")

SUBJECTS = sorted(set(dir(el)) - set(el.__all__))
ROOM = el._PUBLIC


def called(subject: str) -> list[str]:
    """Return further names of a subject that the page of the interface tells one to call."""
    room = getattr(el, subject)
    named = [name for name in room.__all__ if re.search(rf"\b{name}\b", PAGE)]
    results = [name for name in named if Result in getattr(getattr(room, name), "__mro__", ())]
    return [name for name in named if name not in {*ROOM, *results}]


MORE = {subject: called(subject) for subject in SUBJECTS}


def index() -> str:
    """Return the public names by subject, as they stand in the docstring of the package."""

    def lines(text: str) -> str:
        return textwrap.fill(
            text, 100, initial_indent="    ", subsequent_indent="    ", break_on_hyphens=False
        )

    parts = []
    for subject in SUBJECTS:
        first, *_ = getattr(el, subject).__doc__.splitlines()
        own = [name for name in sorted(ROOM) if ROOM[name] == subject]
        names = ", ".join([*own, *(f"{subject}.{name}" for name in MORE[subject])])
        parts.append(f"{subject}\n{lines(first)}\n{lines(names)}")
    rest = ", ".join(name for name in sorted(ROOM) if ROOM[name] not in SUBJECTS)
    shared = "What all share: families of systems, results, errors."
    parts.append(f"all subjects\n{lines(shared)}\n{lines(rest)}")
    return "\n".join(parts) + "\n"


def stub() -> str:
    """Return the stub, from which type checkers and editors know what the names are."""
    origins = [(f".runtime.{room}", name) for name, room in ROOM.items()]
    origins += [(".runtime", subject) for subject in SUBJECTS]
    return (
        '"""Types of the public names, as tests/public_index.py writes them."""\n\n'
        + "".join(f"from {module} import {name} as {name}\n" for module, name in sorted(origins))
        + "\n__version__: str\n"
    )


def package(source: str) -> str:
    """Return the source of the package with its docstring's index as it is now."""
    head, first, rest = source.partition("beams\n    ")
    _, quotes, code = rest.partition('"""')
    assert first and quotes
    return head + index() + quotes + code


if __name__ == "__main__":
    PACKAGE.write_text(package(PACKAGE.read_text()))
    STUB.write_text(stub())
