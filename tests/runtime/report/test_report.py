"""The report of a scene: one page, whole, well-formed, complete in itself, and true."""

import base64
import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import ElastolinkError
from elastolink.runtime.design import diagnose
from elastolink.runtime.report import make_report, sections
from elastolink.runtime.rigid import force_peaks
from elastolink.runtime.scenes import load_scene

SMITH, ENGINE = "smith_1972_5152_sixteenth_inch", "slider_crank_example"
OTHERS = ("beale_1992_flexible_rod", "aannaque_1996_table_4_1", "mathieu", "quick_return_example")
VOID = {"meta", "img", "input", "link", "br", "hr"}


class Page(HTMLParser):
    """A page's elements; a tag that closes another one, or none, fails."""

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.words = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        assert len(dict(attributes)) == len(attributes), f"{tag}: an attribute twice"
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            self.words.append(data)

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


def rows(text):
    """Return the cells of each row of every table."""
    found = re.findall(r"<tr>(.*?)</tr>", text, re.DOTALL)
    return [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in found]


def row(text, first):
    return next(cells[1:] for cells in rows(text) if cells[0] == first)


@pytest.fixture(scope="module")
def texts():
    return {name: make_report(load_scene(name)).html() for name in (SMITH, ENGINE)}


def check_page(text):
    """Check what every page has to keep; return its elements."""
    page = Page(text)
    assert len(text.encode()) < 1_500_000
    assert page.all("html") == [{"lang": "en"}] and len(page.all("h1")) == 1
    # Nothing is loaded: what is shown stands within, what is linked is on the page.
    names = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(set(names)) == len(names)
    for _, attributes in page.elements:
        assert attributes.get("src", "data:image/").startswith("data:image/")
        assert attributes.get("href", f"#{names[0]}")[1:] in names
        assert not any(name.startswith("on") for name in attributes)
    assert not {"link", "iframe", "object", "base", "form"} & {tag for tag, _ in page.elements}
    style = text.partition("<style>")[2].partition("</style>")[0]
    assert "url(" not in style and "@import" not in style and "@media print" in style
    assert len(page.all("script")) == 1 and "prefers-reduced-motion" in text
    for image in page.all("img"):
        assert len(image["alt"]) > 20
        kind, _, data = image["src"].partition(";base64,")
        if kind.endswith("svg+xml"):
            drawing = base64.b64decode(data)
            ElementTree.fromstring(drawing)
            assert not re.search(rb'(?:href|src)="(?!#|data:)', drawing)
    for drawing in page.all("svg"):
        assert drawing["role"] == "img" and len(drawing["aria-label"]) > 20
    assert len(page.all("svg")) == text.count("<title>") - 1
    levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch(r"h\d", tag)]
    assert all(after <= before + 1 for before, after in pairwise(levels))
    return page


@pytest.mark.smoke
@pytest.mark.parametrize("name", [SMITH, ENGINE])
def test_a_page_is_well_formed_and_complete_in_itself(texts, name):
    page = check_page(texts[name])
    assert load_scene(name).title in page.text and "self-checks passed" in page.text
    assert len(page.all("svg")) == 1


def test_a_machine_has_the_sections_that_it_can_have(texts):
    headings = [re.findall(r"<h2 id[^>]*>(.*?)</h2>", texts[name]) for name in (SMITH, ENGINE)]
    first = ["The machine", "Its numbers", "Motion"]
    vibration = ["Natural frequencies", "Stability", "Steady deflection"]
    assert headings[0] == [*first, *vibration, "What was checked"]
    assert headings[1] == [*first, "Forces", "What was checked"]


def test_the_numbers_are_those_of_the_solvers(texts):
    scene = load_scene(SMITH)
    system, speed, text = scene.system(), scene.get("operation.speed"), texts[SMITH]
    mean = el.natural_frequencies(system).mean[0]
    assert float(row(text, "1")[0]) == pytest.approx(mean, rel=1e-5)
    peak = 1e3 * float(el.steady_state(system, speed).peak(0.5))
    assert float(row(text, "0.5")[0]) == pytest.approx(peak, rel=1e-5)
    near = diagnose(scene, speed).nearest
    end, error, unit = row(text, f"{near.region[0]}: nearer end")
    assert float(end) == pytest.approx(near.end[0] * 30.0 / np.pi, rel=1e-5) and unit == "rpm"
    assert float(error) == pytest.approx(near.error[0] * 30.0 / np.pi, rel=0.1)
    assert row(text, "coupler")[:2] == ["0.381 m", "15 in"]
    assert row(text, "mass_per_length")[1] == "follows"
    # The least and the greatest value between the angles of the table, by a hundred times as many.
    fine = scene.mechanism().motion(np.linspace(0.0, 2.0 * np.pi, 72_001), speed)
    _, least, at, greatest, _, error = row(text, "angular acceleration of the follower")
    assert float(least) == pytest.approx(fine.alpha4.min(), abs=float(error) + 1e-3)
    assert float(greatest) == pytest.approx(fine.alpha4.max(), abs=float(error) + 1e-3)
    assert float(at) == pytest.approx(np.degrees(fine.theta2[fine.alpha4.argmin()]), abs=0.01)


def test_the_forces_are_those_of_the_machine(texts):
    scene = load_scene(ENGINE)
    peaks = force_peaks(scene.machine(), scene.get("operation.speed"))
    value, unit, at, _ = row(texts[ENGINE], "driving torque")
    assert (float(value), unit) == (pytest.approx(peaks["torque"].value, rel=1e-5), "N m")
    assert float(at) == pytest.approx(np.degrees(peaks["torque"].crank_angle), abs=0.01)
    assert "Mean driving torque 0 N m" in texts[ENGINE]


def test_the_machine_moves_as_its_joints_do(texts):
    """Places of the crank's pin in the drawing lie on a circle, at the angles that are told."""
    found = re.search(r'data-angles="([^"]*)"', texts[ENGINE])
    angles = np.radians([float(angle) for angle in found[1].split()])
    poses = re.search(r'class="link crank" data-poses="([^"]*)"', texts[ENGINE])[1].split(";")
    x0, y0, x, y = np.array([[float(v) for v in pose.split()] for pose in poses]).T
    arm = np.hypot(x - x0, y - y0)
    assert len(angles) == len(poses) == 90 and np.ptp(arm) < 0.3
    assert np.allclose((x - x0) / arm, np.cos(angles), atol=2e-3)
    assert np.allclose((y0 - y) / arm, np.sin(angles), atol=2e-3)


def test_the_bytes_are_the_same_each_time():
    first, second = (make_report(load_scene("mathieu")).html() for _ in range(2))
    assert first == second


def hostile(folder):
    """Write a scene whose texts would steer a page."""
    scene = load_scene("mathieu")
    title = '<script>alert(1)</script> \\" onload=\\"x'
    lines = [f'title = "{title}"', 'source = "</title><img src=http://x>"']
    for name, table in scene.document.items():
        if isinstance(table, dict):
            lines += ["", f"[{name}]", *(f"{k} = {json.dumps(v)}" for k, v in table.items())]
    path = folder / "a&b<i>.toml"
    path.write_text("\n".join(lines))
    return path


def test_texts_of_a_scene_are_escaped_and_the_file_is_whole(capsys, tmp_path, monkeypatch):
    scene, out = hostile(tmp_path), tmp_path / "page.html"
    assert main(["report", str(scene), "--out", str(out)]) == 0
    page = check_page(out.read_text())
    assert "<script>alert(1)</script>" in page.text and "</title><img src=http://x>" in page.text
    assert [path.name for path in tmp_path.iterdir() if path.suffix != ".toml"] == ["page.html"]
    monkeypatch.chdir(tmp_path)
    assert main(["report", str(scene), "--set", "parameters.mu=0.4375"]) == 0
    assert "0.4375" in (tmp_path / "a&b<i>.html").read_text()
    capsys.readouterr()


def test_a_section_that_fails_says_so_and_the_others_stand(capsys, tmp_path, monkeypatch):
    def refuses(*_, **__):
        raise ElastolinkError("no torque: <b>broken</b>")

    monkeypatch.setattr(sections, "rigid_forces", refuses)
    out = tmp_path / "page.html"
    assert main(["report", ENGINE, "--out", str(out)]) == 1
    assert "Forces failed: no torque" in capsys.readouterr().err
    page = check_page(out.read_text())
    assert "This section failed: no torque: <b>broken</b>" in page.text and "Motion" in page.text


@pytest.mark.parametrize(
    ("more", "word"),
    [(["--out", "page.pdf"], "page.pdf"), (["--out", "missing/page.html"], "missing")],
)
def test_an_impossible_file_is_refused_and_nothing_is_written(
    capsys, tmp_path, monkeypatch, more, word
):
    monkeypatch.chdir(tmp_path)
    assert main(["report", ENGINE, *more]) == 2
    assert word in capsys.readouterr().err and list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_other_scenes_have_pages_too(name):
    found = make_report(load_scene(name))
    check_page(found.html())
    assert found.failed == ()


@pytest.mark.slow
def test_a_model_of_ones_own_has_a_page():
    example = Path(__file__).parents[3] / "docs" / "examples" / "slider_crank_rod.toml"
    if not example.is_file():
        pytest.skip("the example is not here")
    try:
        scene = load_scene(example)
        page = make_report(scene).html()
    except ElastolinkError as refusal:  # its module is emitted by the user
        assert "regenerate-equations" in str(refusal)
    else:
        check_page(page)


def seen_in_browser(name, folder, *widths, **environment):
    """Return the page's address, and what a browser engine sees of it."""
    if find_spec("PySide6") is None or find_spec("PySide6.QtWebEngineWidgets") is None:
        pytest.skip("no browser engine: pip install 'elastolink[browser]'")
    path = make_report(load_scene(name)).save(folder / "page.html")
    program = Path(__file__).with_name("open_in_browser.py")
    done = subprocess.run(
        [sys.executable, str(program), str(path), str(folder), *widths],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return path.as_uri(), json.loads(done.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("name", [SMITH, ENGINE, *OTHERS])
def test_a_browser_shows_moves_and_prints_it(name, tmp_path):
    address, seen = seen_in_browser(name, tmp_path, "380", "1400")
    assert seen["loaded"] and seen["said"] == [] and seen["requests"] == [address]
    assert seen["printed"] and (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")
    for width in seen["widths"].values():
        assert width["scroll"] <= width["width"] and width["beyond"] == []
        assert width["small"] >= 12.0
        for natural, across, high, _ in width["images"]:
            assert natural > 0 and across > 200 and high > 100
        assert all(across > 200 and high > 20 for across, high, _ in width["drawings"])
        assert width["moves"] == width["controls"] == bool(width["drawings"])


@pytest.mark.slow
def test_the_machine_stands_still_where_less_motion_is_wanted(tmp_path):
    flags = "--force-prefers-reduced-motion"
    _, seen = seen_in_browser(ENGINE, tmp_path, "800", QTWEBENGINE_CHROMIUM_FLAGS=flags)
    assert seen["widths"]["800"]["controls"] and not seen["widths"]["800"]["moves"]
