"""Redraw the figures of the documents and check the numbers that they quote."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..core.errors import LinearRangeWarning, bad
from ..core.progress import bar
from ..core.results import Check
from . import registry
from .records import FigureEntry, Gallery, Shown


def figures(document: str | None = None, figure: str | None = None) -> tuple[FigureEntry, ...]:
    """Return the figures that a document's name and a label choose.

    Parameters
    ----------
    document : str, optional
        Short name; all documents by default.
    figure : str, optional
        A label such as ``84`` or ``27(c)`` (``27c`` will do); a number alone stands for all its
        parts, the letter of an appendix for all its sheets, ``C.3`` for the sheet that holds it.
        All figures by default.

    Raises
    ------
    BadInput
        If there is no such document or figure.
    """
    known = registry.documents()
    if document is not None and document not in known:
        raise bad("document", repr(document), f"one of {sorted(known)}", "correct the name")
    names = list(known) if document is None else [document]
    entries = tuple(entry for name in names for entry in known[name])
    if figure is None:
        return entries
    wanted = _plain(figure)
    exact = tuple(entry for entry in entries if _plain(entry.label) == wanted)
    parts = tuple(
        entry
        for entry in entries
        if _number(entry.label) == wanted or wanted in _spanned(entry.label)
    )
    if not (exact or parts):
        labels = ", ".join(entry.label for entry in entries)
        raise bad("figure", repr(figure), f"one of {labels}", "correct the label")
    return exact or parts


def reproduce(
    document: str | None = None,
    figure: str | None = None,
    out: str | os.PathLike[str] | None = None,
    *,
    progress: bool = False,
) -> Gallery:
    """Redraw figures and compare every number that the text quotes with the computed one.

    Parameters
    ----------
    document : str, optional
        Short name of a document; all of them by default.
    figure : str, optional
        One figure, see :func:`figures`.
    out : path, optional
        Folder for the pictures (PNG) and ``index.html``: all appear, or none.  The same input
        gives the same bytes.  By default nothing is written.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    Gallery
        One check per quoted number: agreement, or, for a number known to differ, that it still
        does.

    Raises
    ------
    BadInput
        If there is no such document or figure, or the folder cannot be written.
    """
    chosen = figures(document, figure)
    shown, files = [], {}
    with bar(progress, len(chosen)) as tick:
        for done, entry in enumerate(chosen, start=1):
            item, picture = render(entry, picture=out is not None)
            shown.append(item)
            if picture is not None:
                files[f"{entry.stem}.png"] = picture
                files |= {name: text.encode() for name, text in item.files.items()}
            if tick is not None:
                tick(done)
    if out is not None:
        from .page import page, write_together

        names = ", ".join(sorted({entry.document.capitalize() for entry in chosen}))
        title = f"Figures of {names}, redrawn and checked"
        files = {"index.html": page(title, shown).encode(), **files}
        write_together(Path(out), files)
    return _gallery(shown, "" if out is None else str(out), tuple(files))


def render(entry: FigureEntry, *, picture: bool = True) -> tuple[Shown, bytes | None]:
    """Draw one figure; return it with its numbers, and the PNG file's bytes where wanted."""
    import matplotlib as mpl

    from ..core.plotting import new_figure
    from .drawing import SETTINGS, finish

    with mpl.rc_context(), warnings.catch_warnings():
        # At a resonance the linear range is left; the figures' notes say so.
        warnings.simplefilter("ignore", LinearRangeWarning)
        # The user's own settings must not change the pictures.
        mpl.rcdefaults()
        mpl.rcParams.update(SETTINGS)
        canvas = new_figure(*entry.size)
        options = {"projection": entry.projection}
        axes = list(np.ravel(canvas.subplots(*entry.panels, squeeze=False, subplot_kw=options)))
        shown = entry.show(axes)
        finish(axes, entry.panels[1], entry.axes, entry.panel, entry.legend)
        if not picture:
            return shown, None
        buffer = io.BytesIO()
        canvas.savefig(buffer, format="png", dpi=150, metadata={"Software": None})
        return shown, buffer.getvalue()


def _gallery(shown: Sequence[Shown], folder: str, files: tuple[str, ...]) -> Gallery:
    checks: dict[str, Check] = {}
    worst = 0.0
    for item in shown:
        for row in item.quoted:
            name = f"{item.entry.document} {item.entry.label}: {row.number}"
            checks[name if not row.differs else f"{name} (known to differ)"] = row.check
            if not row.differs:
                worst = max(worst, row.share)
    return Gallery(
        method="figures redrawn from built-in scenes",
        error=worst,
        error_norm="largest deviation of a quoted number over its tolerance",
        checks=checks,
        shown=tuple(shown),
        folder=folder,
        files=files,
    )


def _plain(label: str) -> str:
    return "".join(c for c in label.lower() if c.isalnum() or c in "_.")


def _number(label: str) -> str:
    plain = _plain(label)
    return plain.rstrip("abcdefghijklmnopqrstuvwxyz") if plain[:1].isdigit() else plain


def _spanned(label: str) -> tuple[str, ...]:
    """Return what a sheet ``C.1-C.6`` answers to: each figure on it, and its letter."""
    first, _, last = label.partition("-")
    if not last:
        return ()
    letter, _, low = first.partition(".")
    high = last.rpartition(".")[2]
    return (letter.lower(), *(f"{letter.lower()}.{k}" for k in range(int(low), int(high) + 1)))
