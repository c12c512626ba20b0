"""One HTML page of a scene's sections, complete in itself: styles, figures and script within."""

from __future__ import annotations

import base64
import hashlib
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from html import escape
from importlib import resources
from pathlib import Path

import numpy as np

from ... import __version__
from ..core.errors import bad, printable
from ..core.files import write_whole
from ..core.inputs import require_kind
from ..core.plotting import require_writable
from ..core.results import Check, Result
from ..scenes import Scene
from .parts import Figure, Markup, Section, Table, small
from .sections import sections, subject_of

ENDINGS = (".html", ".htm")
_STYLE, _SCRIPT = (
    (resources.files(__package__) / "data" / name).read_text("utf-8")
    for name in ("page.css", "page.js")
)
# Nothing is loaded from anywhere, and no script runs but the one of this toolkit.
_DIGEST = base64.b64encode(hashlib.sha256(_SCRIPT.encode()).digest()).decode()
_POLICY = (
    "default-src 'none'; img-src data:; style-src 'unsafe-inline';"
    f" script-src 'sha256-{_DIGEST}'; base-uri 'none'; form-action 'none'"
)


@dataclass(frozen=True)
class Report:
    """What is known of a scene.

    Attributes
    ----------
    name, title : str
        Of the scene.
    sections : tuple of Section
        Those that the scene has.
    checks : mapping of str to Check
        The self-checks of every result, by "result: check".
    """

    name: str
    title: str
    sections: tuple[Section, ...] = field(repr=False)

    @property
    def results(self) -> dict[str, Result]:
        """Every result by name."""
        return {k: v for section in self.sections for k, v in section.results.items()}

    @property
    def checks(self) -> dict[str, Check]:
        """The self-checks of every result, by ``"result: check"``."""
        return {
            f"{name}: {check}": result.checks[check]
            for name, result in self.results.items()
            for check in sorted(result.checks)
        }

    @property
    def failed(self) -> tuple[str, ...]:
        """Headings of the sections whose solver refused."""
        return tuple(section.heading for section in self.sections if section.failed)

    @property
    def passed(self) -> bool:
        """Whether no section failed and no self-check."""
        return not self.failed and all(check.passed for check in self.checks.values())

    def html(self) -> str:
        """Return the page; the same scene and versions give the same text."""
        return "\n".join(_page(self))

    def save(self, path: str | Path) -> Path:
        """Write the page, whole or not at all.

        Raises ``BadInput`` if the ending is not .html or .htm, or the place cannot be written.
        """
        return write_whole(check_report_path(path), self.html().encode())


def make_report(scene: Scene) -> Report:
    """Return the report of a scene.

    Parameters
    ----------
    scene : Scene
        Any scene; what it has no numbers for is left out.

    Returns
    -------
    Report
        A section whose solver refuses says why, and the others stand.

    Raises
    ------
    BadInput
        If this is no scene, or its equations are not there.

    Examples
    --------
    >>> import elastolink as el
    >>> report = el.report.make_report(el.load_scene("mathieu"))
    >>> print([section.heading for section in report.sections])
    ['The machine', 'Its numbers', 'Stability']
    """
    require_kind("scene", scene, (Scene,), "use load_scene")
    return Report(scene.name, scene.title, tuple(sections(subject_of(scene))))


def check_report_path(path: str | Path) -> Path:
    """Return the path of a page that can be written; refuse any other."""
    target = Path(path)
    if target.suffix not in ENDINGS:
        raise bad(str(target), repr(target.suffix), f"an ending of {ENDINGS}", "rename the file")
    return require_writable(target)


def _text(text: object) -> str:
    """Return text for a page: what would steer it is escaped."""
    return escape(printable(str(text)))


def _page(report: Report) -> Iterator[str]:
    title = _text(report.title)
    yield '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">'
    yield f'<meta http-equiv="Content-Security-Policy" content="{escape(_POLICY)}">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n<body>"
    yield f"<header><h1>{title}</h1>\n<p>Report of the scene <code>{_text(report.name)}</code>,"
    yield f"by elastolink {__version__}.</p>\n{_verdict(report)}</header>\n<main>"
    yield '<nav aria-label="In short"><h2>In short</h2>\n<ul>'
    shown = (*report.sections, _checked(report))
    for section in shown:
        said = f"failed: {section.failed}" if section.failed else section.brief
        link = f'<a href="#{_name(section)}">{_text(section.heading)}</a>'
        yield f"<li>{link}: {_text(said)}</li>"
    yield "</ul></nav>"
    for section in shown:
        yield from _section(section)
    yield f"</main>\n<script>{_SCRIPT}</script>\n</body>\n</html>\n"


def _verdict(report: Report) -> str:
    checks = report.checks
    lines = [f"section failed: {heading}" for heading in report.failed]
    lines += [f"self-check failed: {name}" for name, check in checks.items() if not check.passed]
    told = "; ".join(lines) or f"All {len(checks)} self-checks passed."
    return f'<p class="{"failed" if lines else "passed"}">{_text(told)}</p>\n'


def _name(section: Section) -> str:
    return re.sub(r"\W+", "-", section.heading.lower())


def _section(section: Section) -> Iterator[str]:
    name, parts = _name(section), section.parts
    yield f'<section id="{name}" aria-labelledby="{name}-heading">'
    yield f'<h2 id="{name}-heading">{_text(section.heading)}</h2>'
    yield from (f"<p>{_text(part)}</p>" for part in parts if isinstance(part, str))
    yield from (f'<p class="warned">Note: {_text(line)}</p>' for line in section.warned)
    if section.failed:
        yield f'<p class="failed">This section failed: {_text(section.failed)}</p>'
    yield from (part.text for part in parts if isinstance(part, Markup))
    figures = "".join(_figure(part) for part in parts if isinstance(part, Figure))
    if figures:
        yield f'<div class="figures">{figures}</div>'
    yield from (_table(part) for part in parts if isinstance(part, Table))
    yield "</section>"


def _figure(figure: Figure) -> str:
    data = base64.b64encode(figure.content).decode()
    return (
        f'<figure><img alt="{_text(figure.told)}" src="data:image/{figure.kind};base64,{data}">'
        f"<figcaption>{_text(figure.caption)}</figcaption></figure>\n"
    )


def _table(table: Table) -> str:
    """Return a table in a box that scrolls by itself where the page is narrow."""
    caption, head = _text(table.caption), table.heads.split("|")
    heads = "".join(f'<th scope="col">{_text(cell)}</th>' for cell in head)
    rows = "".join(f"<tr>{_row(cells)}</tr>\n" for cells in table.rows)
    return (
        f'<h3>{caption}</h3>\n<div class="scroll" role="region" aria-label="{caption}"'
        f' tabindex="0"><table aria-label="{caption}">\n<thead><tr>{heads}</tr></thead>\n'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _row(cells: Iterable[str]) -> str:
    first, *others = (_text(cell) for cell in cells)
    return f'<th scope="row">{first}</th>' + "".join(f"<td>{cell}</td>" for cell in others)


def _checked(report: Report) -> Section:
    """Return the section of methods, errors and self-checks."""
    methods, checks = list[tuple[str, ...]](), list[tuple[str, ...]]()
    for name, result in report.results.items():
        error = np.asarray(result.error, dtype=float)
        finite = error[np.isfinite(error)]
        worst = small(float(np.max(finite)) if finite.size else math.inf)
        methods.append((name, result.method, worst, result.error_kind, result.error_norm))
    for name, check in report.checks.items():
        verdict = "passed" if check.passed else "FAILED"
        checks.append((name, small(check.value), small(check.limit), verdict))
    passed = sum(check.passed for check in report.checks.values())
    told = (
        f"{passed} of {len(checks)} self-checks passed.",
        "Each compares what was measured with the largest value that passes.  An error that is an"
        " estimate is likely not to be exceeded; a bound cannot be.",
        Table("Methods and errors", "result|method|largest error|kind|of what", methods),
        Table("Self-checks", "self-check|value|limit|verdict", checks),
    )
    return Section("What was checked", told)
