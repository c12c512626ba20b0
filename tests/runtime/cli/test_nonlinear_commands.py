"""``elastolink response``: branches, slow sweeps, searches."""

from importlib import resources

import pytest
from command_runs import shown, told

RIG = "smith_1972_101104_thirtysecond_inch"
RPM = 0.10471975511965977
# Less than a turn of the branch about its folds at 357.104 and 355.572 rpm.
FOLDS = ("response", RIG, "--speed", "352:359rpm")


def test_folds_are_listed_with_their_errors_and_the_damping_that_is_taken(capsys):
    lines = shown(capsys, *FOLDS).splitlines()
    assert lines[0].startswith(
        "damping: a logarithmic decrement of 0.212, the geometric mean of 0.15"
    )
    assert lines[1].endswith("points on 1 branch")
    folds = [line.split() for line in lines if line.startswith("fold")]
    for row, speed in zip(folds, (357.10428, 355.57179), strict=True):
        assert float(row[1]) == pytest.approx(speed, abs=2e-5)
        assert float(row[2]) < 1e-6 and row[-1] == "0"
    assert float(folds[0][3]) < float(folds[1][3])


def test_the_json_holds_the_branch_and_the_linear_answer_and_the_picture_both(capsys, tmp_path):
    picture = tmp_path / "response.svg"
    found = told(capsys, *FOLDS, "--plot", picture)
    assert found["parameter"] == "speed" and found["special"] == ["fold", "fold"]
    assert found["special_value"][0] == pytest.approx(357.10428 * RPM, abs=1e-6)
    assert len(found["value"]) == len(found["stable"]) == len(found["peak_to_peak"])
    assert not all(found["stable"]) and found["passed"] is True
    # Below its own resonance the linear equation knows nothing of the jump.
    assert max(found["linear_highest"]) < 0.6 * max(found["highest"])
    text = picture.read_text()
    assert "peak-to-peak deflection [mm]" in text and "crank speed [rpm]" in text


def test_a_damping_of_the_scene_stays_and_where_there_is_none_it_is_said(capsys, tmp_path):
    quiet = ("--speed", "300:301rpm")
    assert "damping" not in shown(
        capsys, "response", RIG, *quiet, "--set", "coupler.damping_ratio=0.03"
    )
    none = shown(capsys, "response", RIG, *quiet, "--set", "coupler.damping_ratio=0")
    assert none.startswith("no damping: ")
    data = resources.files("elastolink.runtime.scenes") / "data" / f"{RIG}.toml"
    lines = data.read_text().splitlines()
    own = tmp_path / "rig.toml"
    own.write_text("\n".join(line for line in lines if not line.startswith("log_decrement")))
    assert shown(capsys, "response", own, *quiet).startswith("no damping: ")


def test_doublings_are_followed_to_motions_of_two_turns(capsys):
    arguments = ("response", RIG, "--speed", "480:486rpm", "--turns", "2")
    lines = shown(capsys, *arguments).splitlines()
    assert lines[2].startswith("  branch 0, 1 turn: 480 to 486, ")
    assert lines[3].startswith("  branch 1, 2 turns: 48")
    doublings = [line.split() for line in lines if line.startswith("doubling")]
    assert [float(row[1]) for row in doublings] == [pytest.approx(484.91849, abs=2e-5)]


@pytest.mark.slow
def test_another_parameter_is_varied_at_one_speed(capsys):
    where = "follower.inertia=0.0072:0.0077 lbf*in*s**2"
    found = told(capsys, "response", RIG, "--speed", "350 rpm", "--in", where)
    assert found["parameter"] == "follower_inertia"
    # Both ways to one fold: at this inertia it lies at this speed.
    assert found["special"] == ["fold"]
    inertia = f"{found['special_value'][0]:.12g} kg*m**2"
    again = told(
        capsys, *FOLDS[:2], "--speed", "348:351rpm", "--set", f"follower.inertia={inertia}"
    )
    assert again["special_value"][0] == pytest.approx(350.0 * RPM, rel=1e-8)


@pytest.mark.slow
def test_a_search_says_what_it_tried_and_finds_the_motion_across_the_fold(capsys):
    lines = shown(capsys, "response", RIG, "--speed", "352:355rpm", "--search").splitlines()
    assert lines[1].startswith("searched at three values: ") and "mode 1" in lines[1]
    assert lines[1].endswith("there may be other motions")


@pytest.mark.slow
def test_a_sweep_jumps_up_after_the_fold_and_down_before_it(capsys):
    arguments = ("response", RIG, "--speed", "300:400rpm", "--sweep", "2 rpm/s")
    found = told(capsys, *arguments)
    up, down = (speed / RPM for speed in found["jump_speed"])
    assert found["jump_rising"] == [True, False]
    assert 357.104 < up < 364.0 and 345.0 < down < 355.572


def test_a_short_sweep_counts_its_revolutions(capsys):
    arguments = ("response", RIG, "--speed", "300:302rpm", "--sweep", "10 rpm/s", "--kicks", "0")
    out = shown(capsys, *arguments)
    assert "2 revolutions" in out and "no jumps" in out
