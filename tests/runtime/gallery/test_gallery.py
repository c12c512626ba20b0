"""The gallery: which figures there are, what a quoted number is, and how files are written."""

import json
import subprocess
import sys

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.gallery import Drawn, FigureEntry, Quoted, figures, registry, reproduce
from elastolink.runtime.gallery.smith_charts import _to_order
from elastolink.runtime.gallery.smith_linkages import (
    LBF_IN_S2,
    RIGS,
    RPM,
    end_load,
    linkage_of,
)
from elastolink.runtime.gallery.smith_observations import OBSERVATIONS
from elastolink.runtime.gallery.smith_waves import _system, periodic_response
from elastolink.runtime.gallery.writing import write_together
from elastolink.runtime.hill import hill_boundaries
from elastolink.runtime.periodic import simulate
from elastolink.runtime.scenes import load_scene

QUICK = ("6", "7", "27", "28", "29", "32", "33", "34", "35", "36", "37", "38", "45", "83", "87")


def quoted(printed, computed, tolerance=0.5, relation="=", differs=""):
    return Quoted("a number", printed, computed, tolerance, "half", "1.1", relation, "", differs)


def entry_with(*rows):
    def draw(axes):
        axes[0].plot([0.0, 1.0], [0.0, 1.0])
        return Drawn(tuple(rows), ("a note with < and &",))

    return FigureEntry("smith", "99", "A line", draw)


@pytest.mark.parametrize(
    ("asked", "labels"),
    [
        ("27", ["27(a)", "27(b)", "27(c)", "27(d)", "27(e)"]),
        ("27(c)", ["27(c)"]),
        ("27C", ["27(c)"]),
        ("6", ["6(a)", "6(b)", "6(c)"]),
        ("7", ["7"]),
        ("table_coupler", ["table_coupler"]),
    ],
)
def test_a_label_chooses_its_figure_or_all_its_parts(asked, labels):
    assert [entry.label for entry in figures("smith", asked)] == labels


def test_every_figure_that_was_promised_is_there_once():
    labels = [entry.label for entry in figures("smith")]
    wanted = {"6(a)", "6(b)", "6(c)", "7", "table_coupler"}
    wanted |= {f"27({letter})" for letter in "abcde"}
    wanted |= {str(n) for n in (*range(28, 35), *range(47, 52), *range(82, 88))}
    assert wanted <= set(labels)
    assert len(labels) == len(set(labels))
    stems = [entry.stem for entry in figures()]
    assert len(stems) == len(set(stems))


@pytest.mark.parametrize(
    ("document", "figure", "word"),
    [("nobody", None, "document"), ("smith", "99", "figure"), (None, "x", "figure")],
)
def test_an_unknown_name_is_refused_with_those_there_are(document, figure, word):
    with pytest.raises(BadInput, match=word):
        reproduce(document, figure)


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


@pytest.mark.parametrize("label", QUICK)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(label):
    gallery = reproduce("smith", label)
    assert gallery.rows
    failed = [name for name, check in gallery.checks.items() if not check.passed]
    assert failed == []
    assert len(gallery.checks) == len(gallery.rows)


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


def test_texts_of_a_page_are_escaped(tmp_path, monkeypatch):
    entry = entry_with(quoted(1.0, 1.0, relation="<"))
    monkeypatch.setattr(registry, "DOCUMENTS", {"smith": (entry,)})
    reproduce("smith", None, tmp_path)
    page = (tmp_path / "index.html").read_text()
    assert "a note with &lt; and &amp;" in page and "&lt; 1" in page


def test_nothing_is_written_without_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gallery = reproduce("smith", "45")
    assert gallery.folder == "" and gallery.files == ()
    assert list(tmp_path.iterdir()) == []


def test_files_appear_together_or_the_folder_stays_as_it_was(tmp_path):
    (tmp_path / "a.txt").write_text("old")
    wanted = ("a.txt", "b.txt", "c.txt")

    class Interrupting(dict):
        """Staged whole; interrupted before the third file is moved to its place."""

        def __iter__(self):
            yield from wanted[:2]
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_together(tmp_path, Interrupting(dict.fromkeys(wanted, b"new")))
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"
    write_together(tmp_path, dict.fromkeys(wanted, b"new"))
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == dict.fromkeys(
        wanted, "new"
    )


def test_a_folder_made_for_files_that_fail_is_removed_again(tmp_path):
    with pytest.raises(TypeError):
        write_together(tmp_path / "new" / "deep", {"a.txt": "text, not bytes"})
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BadInput, match="file"):
        reproduce("smith", "45", tmp_path / "file" / "gallery")


def test_the_command_reports_rows_and_fails_with_them(tmp_path, monkeypatch, capsys):
    arguments = ["reproduce", "smith", "--out", str(tmp_path / "gallery")]
    for row, status, word in (
        (quoted(1.0, 1.2), 0, "agrees"),
        (quoted(1.0, 3.0), 1, "DIFFERS"),
        (quoted(1.0, 3.0, differs="a slip"), 0, "known to differ"),
    ):
        monkeypatch.setattr(registry, "DOCUMENTS", {"smith": (entry_with(row),)})
        assert main(arguments) == status
        assert word in capsys.readouterr().out
    assert main([*arguments, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["figures"][0]["quoted"][0]["deviation"] == 2.0
    assert found["passed"] is True


def test_the_deviations_can_be_drawn(monkeypatch):
    rows = (quoted(1.0, 1.2), quoted(1.0, 3.0, differs="a slip"))
    monkeypatch.setattr(registry, "DOCUMENTS", {"smith": (entry_with(*rows),)})
    ax = reproduce("smith").plot()
    assert [float(line.get_xdata()[0]) for line in ax.lines[:2]] == pytest.approx([0.4, 4.0])


def test_the_gallery_loads_without_matplotlib():
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "from elastolink.runtime.gallery import figures\n"
        "assert figures('smith', '84')"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.figure)
def test_the_reduced_coefficient_is_eps3_times_f3(rig):
    # Two routes: the emitted module, and f3 and eps3 as defined under Smith (6.17).
    scene = load_scene(rig.scene)
    inertia = float(rig.inertias[3])
    coupler, follower = scene["links"]["coupler"], scene["links"]["follower"]
    eps3 = inertia * np.pi**2 / (scene["coupler"]["mass_per_length"] * coupler**2 * follower)
    theta = np.linspace(0.0, 2 * np.pi, 50)
    expected = eps3 * end_load(linkage_of(rig.linkage), theta).f3
    np.testing.assert_allclose(rig.function("reduced", inertia)(theta), expected, atol=1e-11)


def test_ends_in_a_batch_are_those_one_by_one():
    rig, regions = RIGS[0], (4, 5)
    for equation in ("reduced", "complete"):
        together = rig.ends(equation, rig.inertias[:3], regions)
        for k, inertia in enumerate(rig.inertias[:3]):
            one = hill_boundaries(rig.function(equation, float(inertia)), 1.0, regions)
            expected = rig.frequency / np.sqrt(np.stack([one.upper, one.lower]))
            np.testing.assert_allclose(together[..., k], expected, rtol=1e-11)


def test_observations_agree_with_the_scenes():
    for one in OBSERVATIONS:
        measured = one.rig.inertias / LBF_IN_S2
        assert len(measured) == 8
        assert np.min(np.abs(measured - one.inertia)) < 1e-9, one
    for rig in RIGS:
        scene = load_scene(rig.scene)
        keys = ("measured.speeds", "measured.regions", "measured.inertias")
        speeds, numbers, inertias = (scene.get(key, ()) for key in keys)
        seen = {
            (round(one.speed), one.region, round(one.inertia, 4))
            for one in OBSERVATIONS
            if one.rig is rig
        }
        for speed, n, inertia in zip(speeds, numbers, inertias, strict=True):
            assert (round(speed / RPM), n, round(inertia / LBF_IN_S2, 4)) in seen


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_second_order_boundaries_miss_by_the_third_power(n):
    f = PeriodicFunction([0.1, 1.0, 0.4, 0.15, 0.3], [0.0, 0.3, -0.2, 0.1, 0.2])
    errors = []
    for mu in (0.04, 0.02, 0.01):
        exact = hill_boundaries(f, mu, (n,))
        drawn = _to_order(f, np.array(mu), (n,), 2)
        gaps = np.abs([exact.lower - drawn.lower, exact.upper - drawn.upper])
        errors.append(float(np.max(gaps)))
    slopes = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(slopes, 3.0, atol=0.15)


def test_the_periodic_response_closes_and_is_what_marching_settles_to():
    system = _system("complete", True)
    speed = RIGS[2].frequency / 3.5
    theta, q = periodic_response(system, speed)
    assert abs(q[-1] - q[0]) < 1e-12
    # After 120 turns the start has decayed by exp(-0.075 * 3.5 * 120) = 2e-14.
    settled = simulate(system, speed, 121.0, samples=64)
    np.testing.assert_allclose(settled.q[-65:, 0], q[::8], atol=1e-10)
    assert len(theta) == 513
