"""The gallery's rigid linkages: clearance, forces, balancing, and Aannaque's kinematics."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.plotting import new_figure
from elastolink.runtime.gallery import figures
from elastolink.runtime.gallery.aannaque_kinematics import linkage
from elastolink.runtime.gallery.aannaque_pulses import crossover
from elastolink.runtime.gallery.free_bodies import free_bodies, round_force
from elastolink.runtime.gallery.sketches import arrow, turning_arrow
from elastolink.runtime.gallery.smith_forces import INCH, TURN, example, peak
from elastolink.runtime.gallery.smith_linkages import four_bar_of
from elastolink.runtime.linkages import FourBar
from elastolink.runtime.rigid import case_counterweights, rigid_forces, with_counterweights
from gallery_rows import require_rows
from scipy.optimize import brentq

SMITH = ("8", "9(a)", "9(b)", *(str(n) for n in range(10, 23)), *(f"23({x})" for x in "abcd"))
AANNAQUE = (*(f"3.{n}" for n in range(4, 11)), *(f"3.11({x})" for x in "abc"), "7.12")
DIFFERING = {
    ("smith", "9(a)"): 1,
    ("smith", "10"): 1,
    ("smith", "11"): 1,
    ("smith", "22"): 3,
    ("smith", "23(a)"): 1,
    ("aannaque", "3.7"): 1,
}
ALL = [("smith", label) for label in SMITH] + [("aannaque", label) for label in AANNAQUE]


@pytest.mark.parametrize(("document", "label"), ALL, ids=lambda part: part)
def test_every_quoted_number_agrees_or_differs_for_a_known_reason(document, label):
    require_rows(document, label, DIFFERING.get((document, label), 0))


def test_every_figure_that_was_promised_is_there_once():
    for document, wanted in (("smith", SMITH), ("aannaque", AANNAQUE)):
        labels = [entry.label for entry in figures(document)]
        assert set(wanted) <= set(labels) and len(labels) == len(set(labels))
    rigid = [entry.label for entry in figures("aannaque") if entry.label in AANNAQUE]
    assert rigid == list(AANNAQUE)


@pytest.mark.parametrize(
    ("asked", "labels"),
    [
        ("3.4", ["3.4"]),
        ("3.11", ["3.11(a)", "3.11(b)", "3.11(c)"]),
        ("3.11B", ["3.11(b)"]),
        ("34", ["34"]),
    ],
)
def test_a_label_with_a_point_is_not_one_without(asked, labels):
    assert [entry.label for entry in figures(None, asked)] == labels


def test_a_chapter_alone_is_no_figure():
    with pytest.raises(BadInput, match="figure"):
        figures("aannaque", "3.1")


def test_names_of_files_sort_as_the_figures_do():
    stems = [entry.stem for entry in figures("aannaque") if "table" not in entry.stem]
    assert stems == sorted(stems)
    assert stems[0] == "aannaque_03_04" and "aannaque_07_12" in stems


def test_the_command_draws_the_second_document(tmp_path, capsys):
    status = main(["reproduce", "aannaque", "--figure", "3.9", "--out", str(tmp_path / "gallery")])
    assert status == 0
    assert "transmission angle" in capsys.readouterr().out
    names = {path.name for path in (tmp_path / "gallery").iterdir()}
    assert names == {"index.html", "aannaque_03_09.png"}


@pytest.mark.parametrize("link", ["crank", "coupler", "follower"])
def test_a_free_body_with_a_wrong_force_is_out_of_balance(link):
    machine, speed = example()
    body = free_bodies(machine, TURN, speed, 25.0)[0][link]
    assert body.unbalanced_force < 1e-12 and body.unbalanced_moment < 1e-12
    first, second, inertia = body.forces
    wrong = replace(body, forces=(first, 1.01 * second, inertia))
    assert wrong.unbalanced_force > 1e-4 and wrong.unbalanced_moment > 1e-4
    # The couple alone spoils the moments and leaves the forces.
    wrong = replace(body, inertia_couple=1.01 * body.inertia_couple, torque=1.01 * body.torque)
    assert wrong.unbalanced_force < 1e-12
    assert wrong.unbalanced_moment > 1e-4


def test_forces_in_every_picture_have_the_scale_of_the_axes():
    ax = new_figure().add_subplot()
    arrow(ax, (1.0, 2.0), (3.0, -1.0), "k", "F")
    assert ax.texts[0].xy == (4.0, 1.0)
    low, high = ax.dataLim.get_points()
    assert low == pytest.approx([1.0, 1.0]) and high == pytest.approx([4.0, 2.0])


@pytest.mark.parametrize(("value", "turn"), [(2.0, 1.0), (-2.0, -1.0)])
def test_a_couple_turns_with_its_sign(value, turn):
    ax = new_figure().add_subplot()
    turning_arrow(ax, (0.0, 0.0), 1.0, value, "T", "k")
    tip, start = np.array(ax.texts[0].xy), np.array(ax.texts[0].xyann)
    assert np.sign(start[0] * tip[1] - start[1] * tip[0]) == turn


@pytest.mark.parametrize(
    ("largest", "size"), [(7.0, 2.0), (10.0, 5.0), (3.9, 1.0), (0.05, 0.02), (4.0, 2.0)]
)
def test_the_measure_of_forces_is_round_and_at_most_half_of_the_largest(largest, size):
    assert round_force(largest) == pytest.approx(size, rel=1e-12)


def test_the_pulses_cross_where_the_peaks_found_by_roots_do():
    # Another route: extremes of the acceleration as roots of its derivative.
    own = linkage()

    def excess(frame):
        other = FourBar(frame, own.crank, own.coupler, own.follower)

        def slope(angle, h=1e-5):
            ends = other.motion([angle - h, angle + h]).alpha4
            return (ends[1] - ends[0]) / (2.0 * h)

        places = [brentq(slope, *np.radians(ends)) for ends in ((30.0, 60.0), (165.0, 200.0))]
        first, second = np.abs(other.motion(places).alpha4)
        return second - first

    # Samples a tenth of a degree apart miss a peak by less than 2e-6 of its size here.
    assert crossover() == pytest.approx(brentq(excess, 0.62, 0.67), abs=5e-6)


def test_point_masses_alone_would_have_no_best_offset():
    # What the note on Fig. 23(d) says: without a size of its own the nearest weight is the best.
    machine, speed = example()
    cases = [case_counterweights(machine, "d", INCH * offset) for offset in (0.25, 1.0, 3.0, 6.0)]
    balanced = [with_counterweights(machine, weights.values()) for weights in cases]
    peaks = [peak(rigid_forces(one, TURN, speed).f23)[0] for one in balanced]
    assert np.all(np.diff(peaks) > 0.0)


def test_the_unbalanced_peaks_are_those_by_newton_and_euler():
    # Smith's example at its worst angle: nine equations, written down here once more.
    machine, speed = example()
    theta = radians(18.0)
    motion = machine.linkage.motion(theta, speed)
    a, b = np.zeros((9, 9)), np.zeros(9)
    # Unknowns: x12, y12, x23, y23, x34, y34, x41, y41, torque.
    plan = (("crank", "AB"), ("coupler", "BC"), ("follower", "CD"))
    for row, (link, pins) in enumerate(plan):
        mass = machine.mass(link)
        place = motion.point(link, mass.along / mass.mass)
        arms = [motion.joints[name] - place.position for name in pins]
        for start, arm, way in ((2 * row, arms[0], 1.0), (2 * row + 2, arms[1], -1.0)):
            a[3 * row, start] = a[3 * row + 1, start + 1] = way
            a[3 * row + 2, start : start + 2] = -way * arm[1], way * arm[0]
        b[3 * row : 3 * row + 2] = mass.mass * place.acceleration
        b[3 * row + 2] = mass.inertia_about_centre * motion.link(link).angular_acceleration
    a[2, 8] = 1.0
    solved = np.linalg.solve(a, b)
    found = rigid_forces(machine, theta, speed)
    expected = np.concatenate([found.f12, found.f23, found.f34, found.f41, [found.torque]])
    np.testing.assert_allclose(solved, expected, rtol=0.0, atol=1e-11 * np.max(np.abs(expected)))


def test_only_a_scene_with_a_four_bar_gives_one():
    assert four_bar_of("smith_1972_10_8_10_10").lengths["crank"] == pytest.approx(8.0 * INCH)
    with pytest.raises(BadInput, match="four-bar"):
        four_bar_of("slider_crank_example")
