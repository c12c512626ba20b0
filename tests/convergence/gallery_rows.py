"""What a figure of the gallery has to say of the numbers that its document quotes."""

from __future__ import annotations

from elastolink.runtime.gallery import reproduce


def require_rows(document, label, differing, *, quoted=True):
    """Draw a figure: each quoted number agrees, but for so many that differ for a known reason.

    Of a figure without a number in the text, ``quoted`` is False.
    """
    gallery = reproduce(document, label)
    assert [item.entry.label for item in gallery.shown] == [label]
    assert [name for name, check in gallery.checks.items() if not check.passed] == []
    assert len(gallery.checks) == len(gallery.rows)
    assert bool(gallery.rows) is quoted
    assert sum(bool(row.differs) for _, row in gallery.rows) == differing
    return gallery
