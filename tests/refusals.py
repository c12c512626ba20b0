"""Tests of what is refused: one line that holds the words of each row."""

from collections.abc import Callable, Iterable

import pytest
from elastolink.runtime.core.errors import BadInput


def refused(call: Callable, rows: Iterable[tuple]) -> Callable:
    """Return a test that a call refuses the arguments of each row; its words, a pattern, are last.

    The refusal is a single line.
    """

    @pytest.mark.parametrize("row", list(rows), ids=lambda row: str(row[-1]))
    def test(row):
        *arguments, words = row
        with pytest.raises(BadInput, match=words) as refusal:
            call(*arguments)
        assert "\n" not in str(refusal.value)

    return test


def each_of(cases: dict[Callable, list[tuple]]) -> list[tuple]:
    """Return the rows of several calls, of which each comes first."""
    return [(call, *case) for call, rows in cases.items() for case in rows]
