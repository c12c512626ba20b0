"""The whole gallery, and the document that is written with it."""

import re
from pathlib import Path

import pytest
from elastolink.runtime.gallery import figures, reproduce
from elastolink.runtime.gallery.smith_coupler_equation import FILE, coupler_equation_document
from elastolink.runtime.gallery.smith_damping import damping_document

pytestmark = pytest.mark.slow
DOCS = Path(__file__).parents[3] / "docs"
DOCUMENTS = {
    FILE: ("table_coupler", coupler_equation_document),
    "damping_estimates.md": ("table_damping", damping_document),
}
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?")


def test_every_quoted_number_agrees_or_differs_for_a_known_reason(tmp_path):
    gallery = reproduce(out=tmp_path)
    failed = [name for name, check in gallery.checks.items() if not check.passed]
    assert failed == []
    pictures = {f"{entry.stem}.png" for entry in figures()}
    assert {path.name for path in tmp_path.iterdir()} == pictures | {"index.html", *DOCUMENTS}
    page = (tmp_path / "index.html").read_text()
    assert all(page.count(f'src="{name}"') == 1 for name in pictures)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_the_document_holds_what_is_computed(name):
    figure, document = DOCUMENTS[name]
    written, computed = (DOCS / name).read_text(), document()
    assert NUMBER.sub("#", written) == NUMBER.sub("#", computed), (
        f"write it anew: elastolink reproduce smith --figure {figure} --out docs"
    )
    pairs = zip(NUMBER.findall(written), NUMBER.findall(computed), strict=True)
    # The last printed digit may fall either way on another machine.
    for one, other in pairs:
        digit = 10.0 ** -len(one.partition(".")[2])
        assert abs(float(one) - float(other)) <= 1.01 * digit
