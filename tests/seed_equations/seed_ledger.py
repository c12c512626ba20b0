"""The equation ledger: rows of the documents' equations, each with the check of its verdict.

A row holds the printed formula once, as a text (``seed_formula``): the page typesets it, the check
evaluates it, and a machine changes it and sees the check fail.  ``inventory.toml`` lists what the
documents contain, independently of the rows.
"""

from __future__ import annotations

import importlib.util
import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Literal

import mpmath
import numpy as np
import pytest
import sympy as sp
from seed_formula import Formula, greatest

HERE = Path(__file__).resolve().parent
TARGET = HERE.parents[1] / "docs" / "equations.md"
Verdict = Literal["agrees", "slip", "approximation", "not legible"]
VERDICTS = ("agrees", "slip", "approximation", "not legible")
FORMULAS = ("printed", "corrected")
DOCUMENTS = ("Smith", "Aannaque", "Beale & Scott")
_NUMBERED = re.compile(r"(\d+|[A-Z])\.\d+|\d+")
# What a falsified formula ends in: a check that does not hold, or numbers that cannot be formed.
FALSIFIED = (AssertionError, ArithmeticError, ValueError)
Points = Callable[[], Iterable[Mapping[str, object]]]


def title(document: str, label: str) -> str:
    """Return how a row of the table begins: ``Smith (2.1)`` or ``Smith 2.2.2 phi``."""
    return f"{document} ({label})" if _NUMBERED.fullmatch(label) else f"{document} {label}"


def _cell(text: str) -> str:
    assert "|" not in text and "\n" not in text, f"breaks the table: {text!r}"
    return text


def _mathematics(form: str) -> str:
    return f"${_cell(form)}$" if form else ""


@dataclass(frozen=True)
class Entry:
    """One equation: what is printed, what is derived, and the check of the verdict.

    The label is that of the inventory.  ``printed`` is None where the document prints ``prose``
    (LaTeX) that is no expression, for a ``reason``; ``corrected`` is the right form, tested like
    the printed one.  ``derived`` is the derived cell where it is no ``corrected`` formula: LaTeX,
    or a function that returns the machine's own forms by their names, or a list of forms that
    vanish, or LaTeX.  The remark says what is wrong or dropped, with a number.  ``check`` is called
    with the entry and raises AssertionError where the verdict does not hold; ``place`` is the test
    that runs it, in the second stage only where ``slow``.
    """

    document: str
    label: str
    check: Callable[[Entry], None]
    place: str
    printed: Formula | None = None
    verdict: Verdict = "agrees"
    corrected: Formula | None = None
    derived: str | Callable[[], object] = ""
    prose: str = ""
    reason: str = "a statement in words"
    remark: str = ""
    slow: bool = False
    letters: Mapping[str, str] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """How the row begins."""
        return title(self.document, self.label)

    def row(self, *, derived: bool = True) -> str:
        """Return the row of the table; without its machine-written cell where not ``derived``."""
        if self.corrected:
            right = self.corrected.latex
        elif callable(self.derived):
            right = latex(self.derived(), letters=self.letters) if derived else "..."
        else:
            right = self.derived
        cells = (
            _cell(self.title),
            self.verdict,
            _mathematics(self.printed.latex if self.printed else self.prose),
            _mathematics(right),
            _cell(self.remark),
            f"`{self.place}`",
        )
        return "| " + " | ".join(cells) + " |"

    def changed(self) -> Iterable[Entry]:
        """Yield the entry with its printed, then its corrected formula changed in each place."""
        for name in FORMULAS:
            form = getattr(self, name)
            for mutant in form.mutants() if form else ():
                yield replace(self, **{name: mutant})

    def survives(self) -> bool:
        """Return whether the check holds."""
        try:
            with np.errstate(all="ignore"):
                self.check(self)
        except FALSIFIED:
            return False
        return True


TABLES = {"Smith": "smith", "Aannaque": "aannaque", "Beale & Scott": "beale_scott"}


@cache
def table(document: str) -> dict[str, dict[str, str]]:
    """Return what a document prints and what is said of it, by label, and the letters."""
    return tomllib.loads((HERE / f"{TABLES[document]}.toml").read_text(encoding="utf-8"))


class Ledger:
    """The rows of one document that one test file proves; call it to add the check of one."""

    def __init__(self, document: str, file: str):
        self.document, self.file = document, Path(file).name
        self.entries: list[Entry] = []

    def cell(self, label: str, name: str = "printed") -> Formula:
        """Return the printed or the corrected formula of a row of the document."""
        return Formula(table(self.document)[label][name], table(self.document)["letters"])

    def __call__(
        self,
        *labels: str,
        check: Callable[[Entry], None] | None = None,
        derived: Callable[[], object] | None = None,
        slow: bool = False,
    ):
        """Add rows; without ``check``, return a decorator of the function that is the check."""

        def add(function):
            self.entries += [self._entry(label, function, derived, slow) for label in labels]
            return function

        return add(check) if check else add

    def _entry(self, label, check, derived, slow) -> Entry:
        letters, cells = table(self.document)["letters"], dict(table(self.document)[label])
        cells |= {name: self.cell(label, name) for name in cells.keys() & set(FORMULAS)}
        if derived:
            cells["derived"] = derived
        place = f"{self.file}::test_row[{label}]"
        return Entry(self.document, label, check, place, slow=slow, letters=letters, **cells)

    def tests(self):
        """Return the test of every row, and the slow one that no changed formula passes its check.

        The first changes each formula in one place only, the second in every place.
        """
        rows = [
            pytest.param(e, id=e.label, marks=[pytest.mark.slow] if e.slow else [])
            for e in self.entries
        ]

        @pytest.mark.parametrize("entry", rows)
        def test_row(entry: Entry):
            entry.check(entry)
            assert_current(entry)
            changed = next(entry.changed(), None)
            assert (changed is None) == (not (entry.printed or entry.corrected))
            assert changed is None or not changed.survives()

        @pytest.mark.slow
        @pytest.mark.parametrize("entry", [e for e in rows if e.values[0].printed])
        def test_falsified_row(entry: Entry):
            survivors = [e for e in entry.changed() if e.survives()]
            assert [f"{e.printed} / {e.corrected}" for e in survivors] == []

        return test_row, test_falsified_row


@cache
def _page() -> tuple[str, dict[str, str]]:
    lines = TARGET.read_text(encoding="utf-8").splitlines()
    rows = {line[2:].split(" | ")[0]: line for line in lines if line.startswith("| ")}
    return lines[-1], rows


def assert_current(entry: Entry) -> None:
    """Compare a row with the page; another SymPy may typeset its own cell otherwise."""
    last, rows = _page()
    theirs = rows.get(entry.title, "")
    advice = "run tests/seed_equations/write_equations.py"
    if f"SymPy {sp.__version__} wrote" in last:
        assert theirs == entry.row(), advice
        return
    before, _, after = entry.row(derived=False).partition("| $...$ |")
    assert theirs.startswith(before) and theirs.endswith(after), advice


# The checks that most rows need.


def derivative(order: int, value: object) -> Callable[..., object]:
    """Return ``D`` for an equation that holds one derivative; any other order is another number."""
    return lambda _, __, times: value if times == order else 0.7317


def by_differences(function: Callable, at: float, order: int = 1, h: float = 1e-3):
    """Return the first or second derivative of anything by central differences of sixth order."""
    weights = {1: (-1, 9, -45, 0, 45, -9, 1), 2: (2, -27, 270, -490, 270, -27, 2)}[order]
    values = (w * function(at + k * h) for k, w in enumerate(weights, -3))
    return sum(values) / ({1: 60, 2: 180}[order] * h**order)


def point_by_point(body: Callable, low: float, high: float, _: bool = False):
    """Return the integral of a number or a matrix, which takes one place at a time."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = (high - low) / 2
    return half * sum(w * body(low + half * (1 + s)) for s, w in zip(nodes, weights, strict=True))


def order_of(error: Callable[[float], float], size: float) -> float:
    """Return the power at which an error falls where its parameter is halved from a size."""
    return float(np.log2(error(size) / error(size / 2)))


def quoted(value: object, *numbers: str) -> None:
    """Compare values with quoted numbers, to half a unit of the last digit that is quoted."""
    values = np.atleast_1d(np.asarray(value, dtype=complex))
    for ours, text in zip(values, numbers, strict=True):
        mantissa, _, power = text.partition("e")
        digits = len(mantissa.partition(".")[2]) - int(power or 0)
        assert abs(ours - float(text)) <= 0.5000001 * 10.0**-digits, f"{ours} is not {text}"


def is_zero(expression: object) -> bool:
    """Return whether an expression vanishes at two random points, in 30 digits.

    Functions and derivatives count as symbols of their own.
    """
    form = sp.sympify(expression)
    if isinstance(form, sp.MatrixBase):
        return all(is_zero(entry) for entry in form)
    form = form.doit()
    opaque = form.atoms(sp.Derivative) | form.atoms(sp.core.function.AppliedUndef)
    form = form.xreplace({item: sp.Dummy(str(item), real=True) for item in opaque})
    symbols = sorted(form.free_symbols, key=str)
    terms = sp.Add.make_args(form)
    rng = np.random.default_rng(len(symbols))
    with mpmath.workdps(30):
        function = sp.lambdify(symbols, terms, "mpmath", cse=True)
        for _ in range(2):
            point = [mpmath.mpf(str(round(v, 6))) for v in rng.uniform(0.3, 1.7, len(symbols))]
            values = function(*point)
            size = max((abs(v) for v in values), default=0)
            if abs(mpmath.fsum(values)) > 1e-20 * size:
                return False
    return True


_COMPARE = {"<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal}


def truths(form: Formula, **point: object) -> list[bool]:
    """Return which of the inequalities of a formula hold."""
    return [
        bool(np.all(_COMPARE[sign](one, other)))
        for sign, one, other, _ in form.pairs(**point)
        if sign in _COMPARE
    ]


def gap(form: Formula, point: Mapping[str, object]) -> float:
    """Return the greatest difference of the sides of a formula over their size."""
    if any(isinstance(value, (sp.Basic, sp.MatrixBase)) for value in point.values()):
        chains = [pair for sides in form.sides(**point) for pair in pairwise(sides)]
        return 0.0 if all(is_zero(sp.sympify(a) - sp.sympify(b)) for a, b in chains) else np.inf
    assert all(truths(form, **point)), str(form)
    worst = 0.0
    for sign, one, other, size in form.pairs(**point):
        if sign in _COMPARE:
            continue
        difference = greatest(np.subtract(one, other))
        part = difference / size if size else difference
        worst = max(worst, part if np.isfinite(part) else np.inf)
    return worst


def holds(*points: Points, tol: float = 1e-9) -> Callable[[Entry], None]:
    """Return the check that a formula and its other form hold at all points."""

    def check(entry: Entry) -> None:
        for form in filter(None, (entry.printed, entry.corrected)):
            hold(form, *points, tol=tol)

    return check


def is_difference(form_and_letters: Callable[[], tuple]) -> Callable[[Entry], None]:
    """Return the check that left less right side is a form of the machine."""

    def check(entry: Entry) -> None:
        form, letters = form_and_letters()
        one, other = entry.printed.sides(**letters)[0]
        same(one - other, form)

    return check


def hold(form: Formula, *points: object, tol: float = 1e-9) -> None:
    """Assert that a formula holds at all points, to a part of its greatest addend."""
    for source in points:
        for point in source() if callable(source) else [source]:
            worst = gap(form, point)
            assert worst <= tol, f"{form}: {worst:.3g} of its greatest addend"


def plain(name: str) -> str:
    """Return a name without what only LaTeX needs."""
    return re.sub(r"[^A-Za-z0-9]", "", name.replace("ell_", "l"))


def same(one: object, other: object, tol: float = 1e-12) -> None:
    """Assert that numbers, arrays or expressions are equal, to a part of the greatest."""
    if any(isinstance(v, (sp.Basic, sp.MatrixBase)) for v in (one, other)):
        assert is_zero(sp.sympify(one) - sp.sympify(other)), f"{one} is not {other}"
        return
    size = max(greatest(one), greatest(other))
    assert greatest(np.subtract(one, other)) <= tol * size, f"{one} is not {other}"


def latex(*forms: object, letters: Mapping[str, str] | None = None) -> str:
    """Return LaTeX of derived forms: by what they equal, a list of those that vanish, or words.

    What a form equals is a symbol, or a text in the notation of formulas.
    """
    parts = []
    for form in forms:
        if isinstance(form, Mapping):
            names = (Formula(n, letters).latex if isinstance(n, str) else sp.latex(n) for n in form)
            parts += [f"{n} = {sp.latex(v)}" for n, v in zip(names, form.values(), strict=True)]
        elif isinstance(form, (list, tuple)):
            parts += [f"{sp.latex(zero)} = 0" for zero in form]
        else:
            parts.append(form if isinstance(form, str) else sp.latex(form))
    return r",\; ".join(parts)


# The whole.


@dataclass(frozen=True)
class Part:
    """A part of a document: the labels found in it."""

    document: str
    chapter: str
    labels: tuple[str, ...]
    scan: dict[str, str]


def entries() -> tuple[Entry, ...]:
    """Return the entries of every ``test_*.py`` of this folder, in order of file and line."""
    rows: list[Entry] = []
    for path in sorted(HERE.glob("test_*.py")):
        if path.name != "test_ledger.py":
            spec = importlib.util.spec_from_file_location(f"ledger_{path.stem}", path)
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            rows += module.row.entries if hasattr(module, "row") else []
    return tuple(rows)


def _numbers(ranges: Iterable[str]) -> tuple[str, ...]:
    """Return the labels of ``2.1..2.10`` and of single numbers."""
    labels: list[str] = []
    for text in ranges:
        first, _, last = text.partition("..")
        prefix, _, low = first.rpartition(".")
        high = (last or first).rpartition(".")[2]
        labels += [f"{prefix}.{k}" if prefix else str(k) for k in range(int(low), int(high) + 1)]
    return tuple(labels)


def inventory() -> tuple[Part, ...]:
    """Return the parts of the documents."""
    table = tomllib.loads((HERE / "inventory.toml").read_text(encoding="utf-8"))
    return tuple(
        Part(
            row["document"],
            row["chapter"],
            (*_numbers(row.get("numbered", ())), *row.get("unnumbered", ())),
            row.get("scan", {}),
        )
        for row in table["part"]
    )


def page() -> str:
    """Return the whole page, parts in the order of the inventory."""
    rows = {(entry.document, entry.label): entry for entry in entries()}
    return "\n".join(frame(rows, lambda entry: entry.row()))


_HEAD = """# The documents' equations, checked

Each row is one equation of a document: the verdict of the test named in its last cell, the printed
form, the derived or corrected form, and what is wrong or dropped, with its size. Printed formulas
are transcribed once and typeset from the very text that the test evaluates; where a scan may be at
fault and not the author, the row says what the scan has.

- **agrees**: equal to an independent derivation or computation.
- **slip**: wrong as printed; the derived cell holds the correction, the remark a counterexample.
- **approximation**: terms are dropped; the remark gives their size in the document's own examples.
- **not legible**: the scan has lost it.

Written by `tests/seed_equations/write_equations.py`; edit the rows there, not this file.
"""


def frame(rows: Mapping[tuple[str, str], Entry], line: Callable[[Entry], str]) -> list[str]:
    """Return the lines of the page, each row as ``line`` writes it."""
    count = Counter(entry.verdict for entry in rows.values())
    total = ", ".join(f"{count[verdict]} {verdict}" for verdict in VERDICTS)
    lines = [*_HEAD.splitlines(), "", f"{len(rows)} rows: {total}.", ""]
    for part in inventory():
        place = f"chapter {part.chapter}" if part.chapter[0].isdigit() else part.chapter
        lines += [
            f"## {part.document}, {place}",
            "",
            "| equation | verdict | printed | derived or corrected | remark | test |",
            "| --- | --- | --- | --- | --- | --- |",
            *(line(rows[part.document, label]) for label in part.labels),
            "",
        ]
    prose = [entry for entry in rows.values() if not entry.printed]
    lines += ["## Rows whose printed cell is no formula", ""]
    reasons = Counter(entry.reason for entry in prose)
    lines += [f"- {reason}: {number}" for reason, number in sorted(reasons.items())]
    return [*lines, "", f"SymPy {sp.__version__} wrote the machine-derived forms."]
