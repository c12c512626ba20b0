"""The work-precision benchmark: its references, contenders, levels and regression guard."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from elastolink.runtime.benchmarking import work_precision as work
from elastolink.runtime.benchmarking.work_precision import method, peers, reference
from elastolink.runtime.benchmarking.work_precision.method import Point
from elastolink.runtime.benchmarking.work_precision.systems import case
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.floquet import monodromy


def _points(*rows: tuple[str, bool, float, float]) -> tuple[Point, ...]:
    return tuple(Point("hill-chart", name, ours, 0.0, ms, error) for name, ours, ms, error in rows)


def _result(points: tuple[Point, ...]) -> work.WorkPrecision:
    return work.WorkPrecision(
        method="by hand",
        error=0.0,
        error_norm="none",
        checks={},
        points=points,
        titles={"hill-chart": "a chart"},
        absent=("heyoka: not installed",),
    )


POINTS = _points(
    ("mine", True, 1.0, 1e-9),
    ("mine", True, 3.0, 1e-13),
    ("theirs", False, 2.0, 1e-5),
    ("theirs", False, 2.5, 1e-13),
)


def test_the_fastest_within_each_level_is_compared() -> None:
    """At 1e-4 to 1e-8 the loose setting leads by two; at 1e-10 and below the tight one trails."""
    found = {lead.level: lead for lead in _result(POINTS).leads}
    assert found[1e-4].ratio == 2.0
    assert found[1e-6].ratio == found[1e-8].ratio == 2.5
    assert found[1e-10].ratio == pytest.approx(2.5 / 3.0)
    assert [lead.level for lead in _result(POINTS).losses] == [1e-10, 1e-12]
    text = _result(POINTS).table()
    assert "lost" in text
    assert "left out: heyoka: not installed" in text


def test_a_level_without_a_peer_or_without_ours_says_so() -> None:
    """Neither is a number."""
    mine = _result(_points(("mine", True, 1.0, 1e-9)))
    assert mine.leads[0].ratio == np.inf
    assert "no peer" in mine.table()
    theirs = _result(_points(("theirs", False, 1.0, 1e-9)))
    assert theirs.losses
    assert "not reached" in theirs.table()


def test_ratios_are_stored_and_a_fall_is_told(tmp_path) -> None:
    """A file keeps what was not measured; a ratio halved since fails the check."""
    path = tmp_path / "ratios.json"
    path.write_text('{"coupler-chart": {"1e-04": 7.0}}')
    work.store_ratios(_result(POINTS), path)
    kept = json.loads(path.read_text())
    assert kept["coupler-chart"] == {"1e-04": 7.0}
    assert kept["hill-chart"]["1e-06"] == 2.5
    same = work.compared(_result(POINTS), work.load_ratios(path))
    assert same.checks["regression"].value == pytest.approx(1.0)
    slower = _points(
        ("mine", True, 2.0, 1e-13), ("theirs", False, 2.0, 1e-5), ("theirs", False, 2.5, 1e-13)
    )
    fallen = work.compared(_result(slower), work.load_ratios(path))
    assert fallen.checks["regression"].value == pytest.approx(2.0)
    assert not fallen.passed


@pytest.mark.parametrize("content", ["", "[1]", '{"hill-chart": 3}', '{"hill-chart": {"a": "b"}}'])
def test_a_file_of_something_else_is_refused(tmp_path, content) -> None:
    """One line that names the file and the fix."""
    path = tmp_path / "ratios.json"
    path.write_text(content)
    with pytest.raises(BadInput, match="--compare"):
        work.load_ratios(path)


def test_nothing_in_common_is_refused() -> None:
    """A comparison of nothing must not pass."""
    with pytest.raises(BadInput, match="in common"):
        work.compared(_result(POINTS), {"rod": {"1e-04": 1.0}})


def test_names_of_systems_and_tasks_choose_problems() -> None:
    """By system, by task, by both; in the order of all problems."""
    assert work.selected(["hill"]) == tuple(p for p in work.PROBLEMS if p.startswith("hill-"))
    assert work.selected(["steady"]) == tuple(p for p in work.PROBLEMS if p.endswith("-steady"))
    assert work.selected(["hill-chart", "four-bar-steady"]) == ("hill-chart", "four-bar-steady")
    assert work.selected(None) == work.PROBLEMS
    with pytest.raises(BadInput, match="problems"):
        work.selected(["hil"])


@pytest.mark.parametrize(("option", "value"), [("peers", ["matlab"]), ("rounds", 0)])
def test_bad_arguments_are_refused(option, value) -> None:
    """Before anything is measured."""
    with pytest.raises(BadInput, match=option):
        work.benchmark_work_precision(["hill"], **{option: value})


def test_the_reference_agrees_with_the_collocation_of_the_system() -> None:
    """Taylor series in extended precision of the Fourier series, and order 16 of the terms."""
    own = case("hill")
    equation = own.equation(forced=False)
    exact = reference.flows(equation, 1.0, 1)[-1].astype(float)
    found = monodromy(own.system, own.speed)
    gap = np.max(np.abs(found.scaled - exact)) / np.max(np.abs(exact))
    assert gap <= 1e-13
    # Two lengths of the steps give the same digits.
    half = reference.flows(equation, 1.0, 7)[-1]
    assert np.max(np.abs(half - reference.flows(equation, 1.0, 1)[-1])) <= 1e-16 * np.max(exact)


@pytest.mark.parametrize("name", ["solve_ivp DOP853", "CVODE", "heyoka", "numba loop", "Exudyn"])
def test_every_peer_solves_the_same_equation(name) -> None:
    """Each gets to 1e-6 of the reference at a tight setting."""
    own = case("hill")
    equation = own.equation(forced=False)
    setting = peers.settings_of(name, equation)[3]
    solve = peers.PEERS[name](equation, setting)
    if solve is None:
        pytest.skip(f"{name} is not installed")
    angles = np.array([0.0, equation.period])
    found = solve(np.eye(2), angles)[-1]
    exact = reference.flows(equation, 1.0, 1)[-1].astype(float)
    assert np.max(np.abs(found - exact)) <= 1e-6 * np.max(np.abs(exact))


@pytest.mark.parametrize("task", ["trajectory", "monodromy", "steady", "chart"])
def test_a_problem_is_measured_from_end_to_end(task) -> None:
    """One round, one peer: the prepared points are right, and it can be drawn."""
    found = work.benchmark_work_precision(
        [f"hill-{task}"],
        methods=["prepared", "magnus4", "cyclic"],
        peers=["solve_ivp DOP853"],
        rounds=1,
    )
    ours = [p for p in found.points if p.ours and p.method in ("prepared", "stability_chart")]
    assert ours
    assert all(p.error <= 1e-9 for p in ours)
    assert all(p.milliseconds > 0.0 for p in found.points)
    assert any(not p.ours for p in found.points)
    assert found.plot() is not None
    assert f"hill-{task}" in found.full_table()
    assert set(found.to_dict()) >= {"points", "ratios"}


def test_methods_that_refuse_and_peers_that_take_too_long_are_left_out_by_name(monkeypatch):
    """A symplectic method that damping forbids; a peer with no patience left."""
    monkeypatch.setattr(method, "PATIENCE", 0.0)
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        # Measured in this process, which knows of the patience.
        monkeypatch.setenv(name, "1")
    own = {"methods": ["srkn4"], "peers": ["solve_ivp DOP853", "CVODE"], "rounds": 1}
    found = work.benchmark_work_precision(["quick-return-monodromy"], **own)
    assert found.points == ()
    reasons = {text.split(": ")[1]: text for text in found.absent}
    assert "other first derivatives" in reasons["srkn4, fixed steps"]
    assert "broken off after 0 s" in reasons["solve_ivp DOP853"]
    assert "broken off after 0 s" in reasons["CVODE"]


def test_methods_can_be_chosen() -> None:
    """Then nothing else of ours runs."""
    found = work.benchmark_work_precision(
        ["hill-monodromy"], methods=["magnus4"], peers=[], rounds=1
    )
    assert {p.method for p in found.points} == {"magnus4, fixed steps"}


def test_stored_ratios_are_of_known_problems_and_levels() -> None:
    """What ``--compare`` reads: ahead of every peer wherever it was measured."""
    stored = work.load_ratios(Path(__file__).with_name("ratios.json"))
    assert stored
    assert set(stored) <= set(work.PROBLEMS)
    for own in stored.values():
        assert {float(level) for level in own} <= set(work.LEVELS)
        assert all(ratio > 1.0 for ratio in own.values())
