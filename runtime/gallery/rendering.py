"""Redraw the figures of the documents and check their numbers: an HTML page with its pictures."""

from __future__ import annotations

import os
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from html import escape
from importlib import resources
from pathlib import Path
from string import ascii_lowercase

import numpy as np

from ..core.errors import LinearRangeWarning, bad
from ..core.progress import bar
from ..core.results import Check
from . import records
from .records import KINDS, FigureEntry, Gallery, Quoted, Shown, counts

_STYLE = (resources.files(__package__) / "data" / "page.css").read_text("utf-8")


def figures(document: str | None = None, figure: str | None = None) -> tuple[FigureEntry, ...]:
    """Return the figures that a document's name and a label choose; all by default.

    A label such as ``84`` or ``27(c)`` (``27c`` will do); a number alone stands for all its parts,
    the letter of an appendix for all its sheets, ``C.3`` for the sheet that holds it.
    """
    known = records.documents()
    if document is not None and document not in known:
        raise bad("document", repr(document), f"one of {sorted(known)}", "correct the name")
    names = list(known) if document is None else [document]
    entries = tuple(entry for name in names for entry in known[name])
    if figure is None:
        return entries
    wanted = _plain(figure)
    exact = tuple(entry for entry in entries if _plain(entry.label) == wanted)
    parts = tuple(entry for entry in entries if wanted in _answers(entry.label))
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

    Document and figure as for :func:`figures`.  Into the folder ``out``, if any, go the pictures
    (PNG) and ``index.html``: all appear, or none, and the same input gives the same bytes.  There
    is one check per quoted number: agreement, or, for a number known to differ, that it still does.
    """
    chosen = figures(document, figure)
    folder = None if out is None else _writable(Path(out))
    shown, files = [], {}
    with bar(progress, len(chosen)) as tick:
        for done, entry in enumerate(chosen, start=1):
            item, picture = render(entry, picture=folder is not None)
            shown.append(item)
            if picture is not None:
                files[f"{entry.stem}.png"] = picture
                files |= {name: text.encode() for name, text in item.files.items()}
            tick(done)
    if folder is not None:
        names = ", ".join(sorted({entry.document.capitalize() for entry in chosen}))
        title = f"Figures of {names}, redrawn and checked"
        files = {"index.html": page(title, shown).encode(), **files}
        write_together(folder, files)
    return _gallery(shown, "" if out is None else str(out), tuple(files))


def _writable(folder: Path) -> Path:
    """Return a folder that can be made or written, refused here before any work starts."""
    whole = folder.absolute()
    try:
        with suppress(FileNotFoundError):
            whole.stat()
        there = next(path for path in (whole, *whole.parents) if path.exists())
        fits = there.is_dir() and os.access(there, os.W_OK)
    except (OSError, ValueError):  # below a file, too long, or no name at all
        fits = False
    if not fits:
        raise bad("--out", repr(str(folder)), "a folder that can be written", "choose another")
    return folder


def render(entry: FigureEntry, *, picture: bool = True) -> tuple[Shown, bytes | None]:
    """Draw one figure; return it with its numbers, and the PNG file's bytes where wanted."""
    import matplotlib as mpl

    from ..core.plotting import figure_bytes, new_figure
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
        return shown, figure_bytes(canvas, ".png") if picture else None


def _gallery(shown: Sequence[Shown], folder: str, files: tuple[str, ...]) -> Gallery:
    checks: dict[str, Check] = {}
    for item in shown:
        for row in item.quoted:
            known = " (known to differ)" if row.differs else ""
            checks[f"{item.entry.document} {item.entry.label}: {row.number}{known}"] = row.check
    shares = (row.share for item in shown for row in item.quoted if not row.differs)
    return Gallery(
        method="figures redrawn from built-in scenes",
        error=max(shares, default=0.0),
        error_norm="largest deviation of a quoted number over its tolerance",
        checks=checks,
        shown=tuple(shown),
        folder=folder,
        files=files,
    )


def _plain(label: str) -> str:
    return "".join(c for c in label.lower() if c.isalnum() or c in "_.")


def _answers(label: str) -> set[str]:
    """Return a label's number alone; of a sheet ``C.1-C.6`` each figure on it, and its letter."""
    plain, (first, _, last) = _plain(label), label.lower().partition("-")
    if not last:
        return {plain.rstrip(ascii_lowercase) if plain[:1].isdigit() else plain}
    letter, _, low = first.partition(".")
    high = last.rpartition(".")[2]
    return {letter, *(f"{letter}.{k}" for k in range(int(low), int(high) + 1))}


def page(title: str, shown: Sequence[Shown]) -> str:
    """Return the whole page under a heading, figures in order."""
    rows = [row for item in shown for row in item.quoted]
    parts = [
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        f"<title>{escape(title)}</title>\n<style>\n{_STYLE}</style>\n</head>\n<body>",
        f"<h1>{escape(title)}</h1>",
        f"<p>{len(shown)} figures redrawn, and what is computed held against:</p>\n<ul>",
        *(f"<li>{escape(line)}</li>" for line in counts(rows)),
        "</ul>",
        _summary(shown),
        *(_figure(item) for item in shown),
        "</body>\n</html>\n",
    ]
    return "\n".join(parts)


def _summary(shown: Sequence[Shown]) -> str:
    rows = []
    for item in shown:
        numbers = [sum(row.kind == kind for row in item.quoted) for kind in KINDS]
        numbers.append(sum(row.agrees for row in item.quoted))
        link = f'<a href="#{item.entry.stem}">{escape(item.entry.label)}</a>'
        rows.append(
            f"<td>{link}</td><td>{escape(item.entry.title)}</td>"
            + "".join(f'<td class="number">{number}</td>' for number in numbers)
        )
    return _html(("figure", "title", "printed", "in words", "tables", "agree"), rows)


def _figure(item: Shown) -> str:
    entry = item.entry
    heading = f"{entry.document.capitalize()}, {entry.label}: {entry.title}"
    lines = [
        f'<h2 id="{entry.stem}">{escape(heading)}</h2>',
        f'<p><img src="{entry.stem}.png" alt="{escape(entry.title, quote=True)}"></p>',
    ]
    lines += [f'<p class="note">{escape(note)}</p>' for note in item.notes]
    for kind, (what, name) in KINDS.items():
        rows = [row for row in item.quoted if row.kind == kind]
        if rows:
            lines += [f"<h3>{what.capitalize()}</h3>", _quoted(rows, name)]
    for table in item.tables:
        cells = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in table.rows]
        lines += [f"<h3>{escape(table.title)}</h3>", _html(table.header, cells)]
    return "\n".join(lines)


def _quoted(rows: Sequence[Quoted], name: str) -> str:
    lines = []
    for row in rows:
        sign = "" if row.relation == "=" else f"{escape(row.relation)} "
        unit = f" {escape(row.unit)}" if row.unit else ""
        kind = "agrees" if row.agrees else "known" if row.differs else "differs"
        remark = f": {escape(row.differs)}" if row.differs else ""
        lines.append(
            f"<td>{escape(row.number)}</td><td>{escape(row.where)}</td>"
            f'<td class="number">{sign}{row.expected:.4g}{unit}</td>'
            f'<td class="number">{row.computed:.4g}{unit}</td>'
            f'<td class="number">{row.deviation:+.2g}{unit}</td>'
            f"<td>{row.tolerance:.2g}{unit} ({escape(row.meaning)})</td>"
            f'<td class="{kind}">{row.verdict}{remark}</td>'
        )
    header = ("what", "section", name, "computed", "deviation", "tolerance", "verdict")
    return _html(header, lines)


def _html(header: Sequence[str], rows: Sequence[str]) -> str:
    """Return a table under its headings, the cells of each row in their marks."""
    lines = ["".join(f"<th>{escape(name)}</th>" for name in header), *rows]
    return "\n".join(["<table>", *(f"<tr>{line}</tr>" for line in lines), "</table>"])


def write_together(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files into a folder, made where there is none; others there stay.

    All are written beside the folder's own first, then moved: what fails or is interrupted while
    writing leaves the folder as it was.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".gallery.", dir=folder) as place:
        for name, content in contents.items():
            Path(place, name).write_bytes(content)
        for name in contents:
            Path(place, name).replace(folder / name)
