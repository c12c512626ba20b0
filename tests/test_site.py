"""The site of the pages: what it lists, and how a browser shows it.

The built site is that of ``$ELASTOLINK_SITE``; without it one is built from a copy of the pages, in
which recipes and notebooks are not run.
"""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote, urlsplit
from xml.etree import ElementTree

import elastolink as el
import pytest

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
BROWSER = ROOT / "tests" / "runtime" / "report" / "open_in_browser.py"
NEEDED = ("sphinx", "furo", "myst_nb", "numpydoc", "sphinx_gallery", "latex2mathml", "ziamath")
MAIN = (
    "index",
    "first_linkage",
    "hill",
    "equations",
    "notebooks/four_bar",
    "build/recipes/rattling_coupler",
    "build/api/index",
    "build/api/names/elastolink.floquet_multipliers",
    "build/figures",
)


def test_every_page_is_listed():
    lists = re.findall(r"```\{toctree\}\n(.*?)```", (DOCS / "index.md").read_text(), re.DOTALL)
    listed = [line for text in lists for line in text.splitlines() if re.match(r"\w", line)]
    pages = {path.stem for path in DOCS.glob("*.md")} - {"index"}
    starts = tuple(line[:-1] for line in listed if line.endswith("*"))
    assert [page for page in pages - set(listed) if not page.startswith(starts)] == []
    assert len(listed) == len(set(listed))


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Return the module that makes pages, of a copy of the folder."""
    if any(find_spec(name) is None for name in NEEDED):
        pytest.skip("no site without pip install 'elastolink[docs]'")
    folder = tmp_path_factory.mktemp("site") / "docs"
    shutil.copytree(DOCS, folder, ignore=shutil.ignore_patterns("build", "__pycache__"))
    shutil.copy(ROOT / "CONTRIBUTING.md", folder.parent)  # a page includes it
    spec = importlib.util.spec_from_file_location("made_pages", folder / "made_pages.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_public_name_has_its_place(pages):
    texts = dict(pages.interface())
    listed = [name for text in texts.values() for name in re.findall(r"^   (elast\S+)", text, re.M)]
    assert len(set(listed)) == len(listed)
    names = {f"elastolink.{name}" for name in el.__all__ if name != "__version__"}
    for room in (ROOT / "runtime").iterdir():
        if not (room / "__init__.py").is_file() or room.name in ("_root", "cli"):
            continue
        module = importlib.import_module(f"elastolink.runtime.{room.name}")
        for name in getattr(module, "__all__", ()):
            known = name in el.__all__
            if not known and pages.documented(getattr(module, name)):
                names.add(f"{module.__name__}.{name}")
    assert names <= set(listed)


def test_all_figures_stand_on_their_page_with_what_is_quoted(pages):
    entries = pages.figures()
    rows = [row for entry in entries for row in entry.quoted]
    text = pages.figures_page()
    assert text.count("| agrees |") == sum(not row.differs for row in rows) > 400
    assert text.count("| differs: ") == sum(bool(row.differs) for row in rows) > 0
    assert len(re.findall(r"^\| \*\*", text, re.M)) == len(entries)
    assert all(
        len(re.findall(r"(?<!\\)\|", line)) == 6 for line in text.splitlines() if "|" in line
    )


@pytest.mark.parametrize(
    ("formula", "text", "spaces"),
    [
        (r"\lambda^2 + \mu\cos\theta < 1", "λ2+μcosθ<1", 2),
        (r"\sin^{2}(\phi)", "sin2(ϕ)", 0),
        (r"2\sin^2 x \cos(y)", "2sin2xcos(y)", 3),
    ],
)
def test_formulas_are_mathml_with_the_spaces_of_functions(pages, formula, text, spaces):
    math = ElementTree.fromstring(pages.mathml(formula))
    assert "".join(math.itertext()) == text
    assert len(math.findall(".//{*}mspace")) == spaces


@pytest.fixture(scope="module")
def site(pages, tmp_path_factory):
    """Return the folder of the built site."""
    if os.environ.get("ELASTOLINK_SITE"):
        return Path(os.environ["ELASTOLINK_SITE"])
    source, out = Path(pages.__file__).parent, tmp_path_factory.mktemp("built") / "site"
    quick = ["-D", "nb_execution_mode=off", "-D", "plot_gallery=0"]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", *quick, source, out],
        capture_output=True,
        text=True,
        timeout=500,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return out


class Links(HTMLParser):
    """The places of a page, what it links to and what it loads."""

    def __init__(self, text):
        super().__init__()
        self.places, self.links, self.loads = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.places |= {given[key] for key in ("id", "name") if given.get(key)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if given.get("src") or tag == "link":
            self.loads.append(given.get("src") or given["href"])


@pytest.mark.slow
def test_links_lead_to_places_of_the_site_and_nothing_is_loaded_from_elsewhere(site):
    found = {path: Links(path.read_text()) for path in site.rglob("*.html")}
    assert len(found) > 200
    broken = []
    for path, page in found.items():
        for link in page.links + page.loads:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loads and parts.scheme != "data":
                    broken.append((path.name, link))
                continue
            there = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            other = found.get(site.resolve() / there.relative_to(site.resolve()), page)
            if not there.exists() or (
                link in page.links
                and there.suffix == ".html"
                and parts.fragment
                and unquote(parts.fragment) not in other.places
            ):
                broken.append((path.name, link))
    assert broken == []


@pytest.mark.slow
@pytest.mark.parametrize("name", MAIN)
def test_a_browser_shows_a_page(name, site, tmp_path):
    if find_spec("PySide6") is None or find_spec("PySide6.QtWebEngineWidgets") is None:
        pytest.skip("no browser engine: pip install 'elastolink[browser]'")
    path = site / f"{name}.html"
    done = subprocess.run(
        [sys.executable, str(BROWSER), str(path), str(tmp_path), "380", "1400"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    assert seen["loaded"] and seen["said"] == []
    assert path.resolve().as_uri() in seen["requests"]
    ours = (site.resolve().as_uri(), "data:")
    assert [request for request in seen["requests"] if not request.startswith(ours)] == []
    for width in seen["widths"].values():
        assert width["scroll"] <= width["width"]
        assert width["small"] >= 11.0
        assert all(natural > 0 for natural, *_ in width["images"])
