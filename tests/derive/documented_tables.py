"""Tables of the documents, computed anew between ``<!-- name -->`` and ``<!-- end -->``.

``python tests/write_tables.py`` writes them; tests compare them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
_NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]\d+)?")


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = (heads, ["---"] * len(heads), *rows)
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def filled(text: str, tables: Mapping[str, Callable[[], str]]) -> str:
    """Return a document with its tables computed anew."""
    for name, made in tables.items():
        pattern = rf"(<!-- {name} -->\n).*?(\n<!-- end -->)"
        text, count = re.subn(pattern, lambda m, t=made: m[1] + t() + m[2], text, flags=re.S)
        if count != 1:
            raise ValueError(f"no place for table {name}")
    return text


def last_digit(written: str) -> dict[str, float]:
    """Return what is allowed where the last printed digit may fall either way."""
    whole, _, power = written.partition("e")
    return {"rel": 0.0, "abs": 1.01 * 10.0 ** (int(power or 0) - len(whole.partition(".")[2]))}


def compare(written: str, computed: str, allowed=last_digit) -> None:
    """Assert that two documents have the same words, and numbers alike to what is allowed."""
    assert _NUMBER.sub("#", written) == _NUMBER.sub("#", computed), "run: tests/write_tables.py"
    for one, other in zip(_NUMBER.findall(written), _NUMBER.findall(computed), strict=True):
        assert float(other) == pytest.approx(float(one), **allowed(one))
