"""The gallery: its records, what a quoted number is, how files are written, every figure."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.gallery import (
    Drawn,
    FigureEntry,
    Quoted,
    figures,
    records,
    rendering,
    reproduce,
)
from elastolink.runtime.gallery.rendering import write_together
from elastolink.runtime.gallery.sketch import arrow, turning_arrow
from refusals import refused

# Figures that are drawn within a second, of every kind.
QUICK = {
    "smith": ("8", "11", "15", "20", "23", "27", "31", "33", "38", "45", "83"),
    "aannaque": ("3.5", "3.7", "3.11", "5.1", "table_5.1", "6.1", "table_6.3", "7.12"),
    "beale": ("11",),
}
# Comparisons by kind, and how many of them are known to differ.
ROWS = {"printed": (175, 38), "words": (321, 38), "check": (15, 3)}
DOCS = Path(__file__).parents[3] / "docs"
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?")


def quoted(expected, computed, tolerance=0.5, relation="=", differs="", kind="printed"):
    return Quoted(
        "a number", expected, computed, tolerance, "half", "1.1", relation, "", differs, kind
    )


def entry_with(*rows):
    def draw(axes):
        axes[0].plot([0.0, 1.0], [0.0, 1.0])
        return Drawn([row.computed for row in rows])

    return FigureEntry("smith", "99", "A line", draw, quoted=rows, notes=("a note, < and &",))


def only(monkeypatch, *rows):
    monkeypatch.setattr(records, "documents", lambda: {"smith": (entry_with(*rows),)})


@pytest.mark.parametrize(
    ("document", "label", "labels"),
    [
        ("smith", "27", [f"27({letter})" for letter in "abcde"]),
        ("smith", "27C", ["27(c)"]),
        ("smith", "table_coupler", ["table_coupler"]),
        (None, "3.4", ["3.4"]),
        (None, "3.11B", ["3.11(b)"]),
        ("aannaque", "4.6", [f"4.6({letter})" for letter in "abcd"]),
        ("aannaque", "C.8", ["C.7-C.12"]),
        ("aannaque", "d.26", ["D.21-D.26"]),
        ("aannaque", "C", ["C.1-C.6", "C.7-C.12", "C.13-C.18", "C.19-C.24"]),
    ],
)
def test_a_label_chooses_its_figure_or_all_its_parts(document, label, labels):
    assert [entry.label for entry in figures(document, label)] == labels


def test_every_figure_that_was_promised_is_there_once():
    smith = {entry.label for entry in figures("smith")}
    # Recorded free vibrations, and an onset of instability.
    left_out = {72, 73, 81}
    wanted = {7, 8, *range(10, 23), *range(28, 39), 45, *range(47, 88)} - left_out
    assert {int(label) for label in smith if label.isdigit()} == wanted
    parts = "6(a) 6(b) 6(c) 9(a) 9(b) 23(a) 23(b) 23(c) 23(d) 27(a) 27(b) 27(c) 27(d) 27(e)"
    tables = " table_coupler table_damping table_nonlinear table_second_mode"
    assert {label for label in smith if not label.isdigit()} == set((parts + tables).split())
    beale = "2 3 4 5 7 8 9 10 11 12 resonances chart"
    assert [entry.label for entry in figures("beale")] == beale.split()
    entries = figures()
    assert len({entry.stem for entry in entries}) == len(entries) == 172
    stems = [entry.stem for entry in figures("aannaque") if "table" not in entry.stem]
    assert stems == sorted(stems) and stems[0] == "aannaque_03_04"
    # Sheets hold each figure of an appendix once.
    for letter, count in (("C", 24), ("D", 26)):
        sheets = [entry.label.split("-") for entry in figures("aannaque", letter)]
        ends = [[int(label.partition(".")[2]) for label in sheet] for sheet in sheets]
        assert [k for low, high in ends for k in range(low, high + 1)] == list(range(1, count + 1))


def test_the_numbers_that_the_documents_quote_are_all_there():
    rows = [row for entry in figures() for row in entry.quoted]
    kinds = {kind: [row for row in rows if row.kind == kind] for kind in ROWS}
    assert {k: (len(v), sum(bool(row.differs) for row in v)) for k, v in kinds.items()} == ROWS
    assert sum(map(len, kinds.values())) == len(rows)
    assert all(row.number and row.meaning and row.where for row in rows)


def test_one_record_stands_for_figures_that_differ_in_a_few_words(monkeypatch):
    shared = {"draw": "sketch.canvas", "title": "A <shape>", "notes": ["@of", "plain"]}
    kind = {**shared, "quoted": {"area": {"words": 1.0, "meaning": "@of"}}}
    square = {"label": "1", "texts": {"shape": "square", "corners": 4}}
    disc = {"label": "2", "texts": {"shape": "disc", "corners": 0}}
    disc["quoted"] = {"area": {"differs": "no corners"}}
    record = {"kind": "drawn", "each": [square, disc]}
    record["quoted"] = {"corners of a <shape>": {"printed": "<corners>"}}
    data = {"notes": {"of": "of a <shape>"}, "kind": {"drawn": kind}, "figure": [record]}
    monkeypatch.setattr(records, "contents", lambda document: data)
    read = records.documents.__wrapped__
    one, two = read()["smith"]
    assert (one.label, one.title, one.notes) == ("1", "A square", ("of a square", "plain"))
    assert [(row.number, row.expected) for row in one.quoted] == [
        ("corners of a square", 4.0),
        ("area", 1.0),
    ]
    # What a kind and a figure both say of a number is joined, at the figure's place for it.
    first, last = two.quoted
    assert (first.number, first.meaning, first.differs) == ("area", "of a disc", "no corners")
    assert (last.number, last.kind, last.expected) == ("corners of a disc", "printed", 0.0)
    del disc["texts"]["corners"]
    with pytest.raises(KeyError):
        read()


test_an_unknown_name_is_refused_with_those_there_are = refused(
    lambda document, figure: reproduce(document, figure),
    [
        ("nobody", None, "document"),
        ("smith", "99", "figure"),
        (None, "x", "figure"),
        # A chapter alone is no figure.
        ("aannaque", "3.1", "figure"),
    ],
)


@pytest.mark.parametrize(
    ("row", "deviation", "agrees", "passed"),
    [
        (quoted(10.0, 10.4), 0.4, True, True),
        (quoted(10.0, 9.4), -0.6, False, False),
        (quoted(10.0, 8.0, 0.0, "<"), 0.0, True, True),
        (quoted(10.0, 11.0, 0.0, "<"), 1.0, False, False),
        (quoted(10.0, 11.0, 0.0, ">"), 0.0, True, True),
        (quoted(10.0, 9.0, 0.0, ">"), -1.0, False, False),
        (quoted(10.0, 12.0, differs="a slip"), 2.0, False, True),
        (quoted(10.0, 10.1, differs="a slip"), 0.1, True, False),
        (quoted(10.0, float("nan")), float("nan"), False, False),
    ],
)
def test_a_quoted_number_agrees_within_its_tolerance(row, deviation, agrees, passed):
    assert row.deviation == pytest.approx(deviation, nan_ok=True)
    assert row.agrees is agrees
    assert row.check.passed is passed


def failed(gallery):
    return [name for name, check in gallery.checks.items() if not check.passed]


@pytest.mark.parametrize(
    ("document", "label"), [(name, label) for name, labels in QUICK.items() for label in labels]
)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(
    document, label, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    gallery = reproduce(document, label)
    # Without a folder nothing is written.
    assert gallery.folder == "" and gallery.files == () == (*tmp_path.iterdir(),)
    assert failed(gallery) == []
    assert len(gallery.checks) == len(gallery.rows)


@pytest.mark.slow
@pytest.mark.parametrize("document", ["smith", "aannaque", "beale"])
def test_the_whole_gallery(document, tmp_path):
    gallery = reproduce(document, out=tmp_path)
    assert failed(gallery) == []
    pictures = {f"{entry.stem}.png" for entry in figures(document)}
    texts = {name: text for item in gallery.shown for name, text in item.files.items()}
    assert {path.name for path in tmp_path.iterdir()} == pictures | {"index.html", *texts}
    page = (tmp_path / "index.html").read_text()
    assert all(page.count(f'src="{name}"') == 1 for name in pictures)
    assert set(texts) == (
        {"coupler_equation.md", "damping_estimates.md", "nonlinear.md"}
        if document == "smith"
        else set()
    )
    for name, text in texts.items():
        require_document(name, text)


def require_document(name, text):
    written = (DOCS / name).read_text()
    assert NUMBER.sub("#", written) == NUMBER.sub("#", text), (
        f"write it anew: elastolink reproduce smith --out DIR, and copy {name} to docs"
    )
    # The last printed digit may fall either way on another machine.
    for one, other in zip(NUMBER.findall(written), NUMBER.findall(text), strict=True):
        digit = 10.0 ** -len(one.partition(".")[2])
        assert abs(float(one) - float(other)) <= 1.01 * digit


@pytest.mark.smoke
def test_pictures_and_page_appear_with_relative_links_and_the_same_bytes(tmp_path):
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "own.txt").write_text("kept")
    for name in ("one", "two/deeper"):
        gallery = reproduce("smith", "45", tmp_path / name)
        assert gallery.files == ("index.html", "smith_45.png")
    one, two = tmp_path / "one", tmp_path / "two" / "deeper"
    assert sorted(path.name for path in two.iterdir()) == ["index.html", "smith_45.png"]
    assert (one / "own.txt").read_text() == "kept"
    for name in gallery.files:
        assert (one / name).read_bytes() == (two / name).read_bytes()
    page = (two / "index.html").read_text()
    assert 'src="smith_45.png"' in page
    assert "http" not in page and str(tmp_path) not in page
    assert (two / "smith_45.png").read_bytes().startswith(b"\x89PNG")


def test_only_what_a_document_prints_is_called_printed(tmp_path, monkeypatch):
    only(monkeypatch, *(quoted(1.0, 1.2, kind=kind) for kind in ("printed", "words", "check")))
    gallery = reproduce("smith", None, tmp_path)
    page, lines = (tmp_path / "index.html").read_text(), "\n".join(gallery.lines())
    assert "a note, &lt; and &amp;" in page
    assert page.count("<th>printed</th>") == 2 and page.count("<th>read as</th>") == 1
    assert "numbers that the documents print: 1, of which 1 agree" in page
    for name in ("printed", "read as", "expected"):
        assert lines.count(f": {name} 1, computed 1.2: agrees") == 1


def test_files_appear_together_or_the_folder_stays_as_it_was(tmp_path):
    (tmp_path / "a.txt").write_text("old")
    with pytest.raises(TypeError):
        write_together(tmp_path, {"a.txt": b"new", "b.txt": "text, not bytes"})
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"
    write_together(tmp_path, {"a.txt": b"new", "b.txt": b"more"})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "a.txt": "new",
        "b.txt": "more",
    }


@pytest.mark.parametrize("place", ["file/gallery", "file", "a\0b", "x" * 300, "y/" * 3000])
def test_a_place_that_cannot_be_written_is_refused_before_any_work(tmp_path, monkeypatch, place):
    (tmp_path / "file").write_text("taken")
    monkeypatch.setattr(rendering, "render", None)
    with pytest.raises(BadInput, match="a folder that can be written"):
        reproduce("smith", "45", tmp_path / place)


def test_the_command_reports_rows_and_fails_with_them(tmp_path, monkeypatch, capsys):
    arguments = ["reproduce", "smith", "--out", str(tmp_path / "gallery")]
    for row, status, word in (
        (quoted(1.0, 1.2), 0, "agrees"),
        (quoted(1.0, 3.0), 1, "DIFFERS"),
        (quoted(1.0, 3.0, differs="a slip"), 0, "known to differ"),
    ):
        only(monkeypatch, row)
        assert main(arguments) == status
        assert word in capsys.readouterr().out
    ax = reproduce("smith").plot()
    assert float(ax.lines[1].get_xdata()[0]) == pytest.approx(4.0)
    assert main([*arguments, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["figures"][0]["quoted"][0]["deviation"] == 2.0
    assert found["passed"] is True


def test_the_notes_of_a_record_take_up_computed_words():
    entry = replace(
        entry_with(quoted(1.0, 0.0)),
        notes=("of {name}: {x:.1f}",),
        draw=lambda axes: Drawn([2.0], {"name": "a", "x": 0.26}),
    )
    shown = entry.show(())
    assert shown.notes == ("of a: 0.3",)
    assert shown.quoted[0].computed == 2.0
    with pytest.raises(ValueError, match="zip"):
        replace(entry, draw=lambda axes: Drawn([])).show(())


@pytest.mark.parametrize(("value", "turn"), [(2.0, 1.0), (-2.0, -1.0)])
def test_forces_have_the_scale_of_the_axes_and_couples_turn_with_their_sign(value, turn):
    ax = new_figure().add_subplot()
    arrow(ax, (1.0, 2.0), (3.0, -1.0), "k", "F")
    assert ax.texts[0].xy == (4.0, 1.0)
    low, high = ax.dataLim.get_points()
    assert low == pytest.approx([1.0, 1.0]) and high == pytest.approx([4.0, 2.0])
    ax = new_figure().add_subplot()
    turning_arrow(ax, (0.0, 0.0), 1.0, value, "T", "k")
    (x, y), (u, v) = ax.texts[0].xy, ax.texts[0].xyann
    assert (u * y - v * x) * turn > 0.0
