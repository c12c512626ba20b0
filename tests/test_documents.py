"""Every piece of Python in the README and the pages runs, in order, in a folder of its own."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = {
    path.relative_to(ROOT).as_posix(): re.findall(
        r"^```python\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL
    )
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
}
# Their pieces need files, and run in tests of their own.
ELSEWHERE = ("docs/measured_points.md", "docs/own_model.md")


def test_there_are_pages_with_python():
    assert len(PAGES["README.md"]) == 3
    assert all(len(piece.splitlines()) <= 12 for piece in PAGES["README.md"])


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", [page for page, pieces in PAGES.items() if pieces and page not in ELSEWHERE]
)
def test_pieces_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict = {"__name__": page}
    for number, piece in enumerate(PAGES[page]):
        exec(compile(piece, f"{page}[{number}]", "exec"), names)


def test_pictures_and_pages_that_are_named_exist():
    for page in PAGES:
        text = (ROOT / page).read_text()
        for name in re.findall(r"`(docs/[\w/]+\.(?:md|py|toml))`", text):
            assert (ROOT / name).exists(), f"{page}: {name}"
        for name in re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text):
            assert ((ROOT / page).parent / name).exists(), f"{page}: {name}"
