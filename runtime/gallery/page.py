"""The page of the gallery: one HTML file, its pictures beside it, written together."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, suppress
from html import escape
from pathlib import Path

from ..core.errors import bad
from .records import KINDS, Quoted, Shown, Table, counts

_CSS = """
body { font: 15px/1.5 Georgia, serif; color: #222; max-width: 62rem; margin: 2rem auto;
  padding: 0 1rem; }
h1, h2, h3, th, .note { font-family: Helvetica, Arial, sans-serif; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin-top: 3rem; }
h3 { font-size: 1rem; }
img { max-width: 100%; height: auto; display: block; }
table { border-collapse: collapse; font-size: 0.85rem; margin: 0.8rem 0; }
th, td { border-bottom: 1px solid #ddd; padding: 0.25rem 0.6rem; text-align: left;
  vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.agrees { color: #2c6b37; } .known { color: #a3480f; }
.differs { color: #b00020; font-weight: bold; }
.note { font-size: 0.85rem; color: #444; }
""".strip()


def page(title: str, shown: Sequence[Shown]) -> str:
    """Return the whole page under a heading, figures in order."""
    rows = [row for item in shown for row in item.quoted]
    parts = [
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        f"<title>{escape(title)}</title>\n<style>\n{_CSS}\n</style>\n</head>\n<body>",
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
    lines += [_table(table) for table in item.tables]
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


def _table(table: Table) -> str:
    rows = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in table.rows]
    return f"<h3>{escape(table.title)}</h3>\n{_html(table.header, rows)}"


def _html(header: Sequence[str], rows: Sequence[str]) -> str:
    """Return a table under its headings, the cells of each row in their marks."""
    lines = ["".join(f"<th>{escape(name)}</th>" for name in header), *rows]
    return "\n".join(["<table>", *(f"<tr>{line}</tr>" for line in lines), "</table>"])


def write_together(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files into a folder; on an error or an interrupt it is left as it was.

    The files are written beside the folder's own first, then moved.  Other files in the folder
    stay.  A folder that cannot be made or written is refused.
    """
    with ExitStack() as undo:
        missing = [path for path in (folder, *folder.parents) if not path.exists()]
        try:
            folder.mkdir(parents=True, exist_ok=True)
            staging = Path(tempfile.mkdtemp(prefix=".gallery.", dir=folder))
        except OSError as refusal:
            _remove(missing)
            reason = refusal.strerror or "an error"
            raise bad(
                str(folder), reason, "a folder that can be written", "choose another"
            ) from refusal
        undo.callback(_remove, missing)
        undo.callback(shutil.rmtree, staging)
        new, old = staging / "new", staging / "old"
        new.mkdir()
        old.mkdir()
        for name, content in contents.items():
            (new / name).write_bytes(content)
        for name in contents:
            undo.callback(_restore, folder / name, new / name, old / name)
            if (folder / name).exists():
                (folder / name).replace(old / name)
            (new / name).replace(folder / name)
        undo.pop_all()
    shutil.rmtree(staging)


def _restore(target: Path, new: Path, old: Path) -> None:
    """Take back the move of a new file to its place, however far it came."""
    if old.exists():
        old.replace(target)
    elif not new.exists():
        target.unlink()


def _remove(folders: list[Path]) -> None:
    """Remove those of the folders, the innermost first, that are there and empty."""
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()
