"""Numbers of the documents' tables, which tests compute again."""

from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"


def documented_rows(page: str, table: str) -> list[list[str]]:
    """Return the cells of the table of a page that stands after ``<!-- table -->``."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    lines = text.partition(f"<!-- {table} -->\n")[2].partition("\n<!-- end -->")[0].splitlines()
    return [line.strip("| ").split(" | ") for line in lines[2:]]


def last_digit(written: str) -> float:
    """Return what is allowed where the last printed digit may fall either way."""
    whole, _, power = written.partition("e")
    return 1.01 * 10.0 ** (int(power or 0) - len(whole.partition(".")[2]))
