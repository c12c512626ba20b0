"""Charts: perturbation boundaries of any order, kinds of instability, traced regions, options."""

import elastolink as el
import numpy as np
import pytest
from edge_truth import RIG, rig
from elastolink.runtime.cli.application import main
from periodic_systems import wave

SPEEDS = ("speed", np.linspace(40.0, 99.0, 31))
INERTIAS = ("follower_inertia", np.linspace(1e-4, 9e-4, 9))
LINE = ["chart", "mathieu", "--x", "lam2=0.1:1.4:21", "--y", "mu=0:0.5:9"]


def mathieu():
    return el.load_scene("mathieu").system()


@pytest.mark.parametrize(("ratio", "rtol", "fewest"), [(0.0, 1e-12, 20), (0.0004, 1e-8, 4)])
@pytest.mark.parametrize("order", [1, 4])
def test_overlay_along_the_speed_belongs_to_its_own_row_and_damping(order, ratio, rtol, fewest):
    """At a drawn end, lam2 and K of that very speed: the perturbation gives this lam2 again."""
    system = rig(**{"coupler.damping_ratio": ratio})
    chart = el.stability_chart(system, SPEEDS, INERTIAS, order=order)
    form = el.hill_form(system)
    curves, checked = chart.perturbation, 0
    for j, inertia in enumerate(curves.at):
        f = form.function(1.0, follower_inertia=float(inertia))
        for i, n in enumerate(curves.regions):
            for side, speed in ((0, curves.lower[i, j]), (1, curves.upper[i, j])):
                if np.isnan(speed):
                    continue
                damping = form.damping() / (2 * speed)
                row = el.perturbation_boundaries(f, 1.0, (n,), order, damping)
                lam2 = (row.lower, row.upper)[side][0]
                assert lam2 == pytest.approx(form.stiffness() / speed**2, rel=rtol)
                checked += 1
    assert checked > fewest


def test_figures_of_the_overlay_cover_what_is_drawn():
    chart = el.stability_chart(rig(), SPEEDS, INERTIAS, order=4)
    exact, near = chart.exact, chart.perturbation
    for ends, others in ((exact.lower, near.lower), (exact.upper, near.upper)):
        both = np.isfinite(ends) & np.isfinite(others)
        assert both.sum() > 10
        gap = np.abs(ends - others)[both]
        assert np.all(gap <= (near.error + exact.error)[both])


def test_heavy_loads_leave_gaps_not_lines():
    """Where the orders do not converge nothing is drawn, and the legend says so."""
    heavy = ("follower_inertia", np.linspace(4e-3, 6e-3, 5))
    chart = el.stability_chart(rig(), ("speed", np.linspace(70.0, 99.0, 21)), heavy, order=4)
    ends = np.concatenate([chart.perturbation.lower, chart.perturbation.upper])
    exact = np.concatenate([chart.exact.lower, chart.exact.upper])
    assert np.any((exact > 70.0) & (exact < 99.0))
    assert not np.any((ends > 70.0) & (ends < 99.0))
    assert np.any(np.isnan(ends))
    labels = [text.get_text() for text in chart.plot().get_legend().get_texts()]
    assert "boundary of order 4: none here" in labels


def test_three_independent_parts_go_row_by_row():
    """More parts than are done together: each row is its own function all the same."""
    values = {"a": 0.02, "k": 1.0}
    names = {"a": 1, "square": 2, "cube": 3}
    waves = [el.Term("Kg", name, wave(np.eye(1), m)) for name, m in names.items()]
    terms = (el.Term("M", None, np.eye(1)), el.Term("K", "k", np.eye(1)), *waves)

    def scales(given):
        a = np.asarray(given["a"], dtype=float)
        k = np.asarray(given["k"], dtype=float)
        return {"a": a, "square": a**2, "cube": a**3, "k": k}

    system = el.LinearPeriodic(1, terms, values, scales)
    rows = np.array([0.02, 0.05, 0.1])
    chart = el.stability_chart(system, ("k", np.linspace(0.1, 1.3, 9)), ("a", rows), order=3)
    for j, a in enumerate(rows):
        f = el.PeriodicFunction(a=[0.0, a, a**2, a**3], b=[0.0] * 4)
        row = el.hill_boundaries(f, 1.0, chart.exact.regions)
        near = el.perturbation_boundaries(f, 1.0, chart.exact.regions, 3)
        for curves, other in ((chart.exact, row), (chart.perturbation, near)):
            # Region 0 has no lower end.
            lower = np.where(np.isfinite(other.lower), other.lower, np.nan)
            np.testing.assert_allclose(curves.lower[:, j], lower, rtol=1e-10)


@pytest.mark.parametrize("ratio", [0.0, 1e-5])
def test_kinds_are_those_of_the_largest_multiplier(ratio):
    """Undamped by the reduced polynomial, damped by the whole one."""
    system = rig(**{"model.modes": 2, "coupler.damping_ratio": ratio})
    speeds = np.concatenate([np.linspace(78.0, 82.0, 12), [81.4000, 81.4005], [96.5, 99.0]])
    speeds = np.sort(speeds)
    chart = el.stability_chart(system, ("speed", speeds), ("follower_inertia", [6.55e-4, 7e-4]))
    direct = el.floquet_multipliers(
        system, speeds[None], follower_inertia=np.array([6.55e-4, 7e-4])[:, None]
    )
    top = direct.multipliers[..., 0]
    clear = np.abs(np.abs(top) - 1.0) > 1e-5
    np.testing.assert_allclose(chart.largest[clear], np.abs(top)[clear], rtol=1e-5)
    seen = set()
    for place in np.ndindex(chart.stable.shape):
        if chart.stable[place]:
            assert chart.kind[place] == 0
            continue
        real = abs(top[place].imag) < 1e-8
        wanted = (1 if top[place].real > 0 else -1) if real else 2
        assert chart.kind[place] == wanted
        seen.add(wanted)
    assert seen == {1, -1, 2}


def test_kind_of_one_mode_is_the_sign_of_the_half_trace():
    chart = el.stability_chart(
        mathieu(), ("lam2", np.linspace(0.0, 2.0, 41)), ("mu", np.linspace(0.1, 1.0, 5))
    )
    assert set(np.unique(chart.kind)) == {-1, 0, 1}
    np.testing.assert_array_equal(chart.kind != 0, ~chart.stable)
    assert np.all(np.sign(chart.invariants[..., 0])[chart.kind != 0] == chart.kind[chart.kind != 0])
    labels = [text.get_text() for text in chart.plot().get_legend().get_texts()]
    assert "unstable: odd regions (multiplier below -1)" in labels
    assert not any("combination" in label for label in labels)


@pytest.fixture(scope="module")
def traced():
    speeds = ("speed", np.linspace(79.0, 83.0, 9))
    inertias = ("follower_inertia", np.array([6.0e-4, 8.0e-4]))
    return el.stability_chart(rig(**{"model.modes": 2}), speeds, inertias, edges=True)


def test_traced_regions_are_joined_by_their_labels(traced):
    edges = traced.edges
    assert traced.checks["edges"].passed
    assert edges.at.tolist() == [6.0e-4, 8.0e-4]
    at = [i for i, kind in enumerate(edges.kind) if kind == "sum" and edges.harmonic[i] == 10]
    assert len(at) == 1
    width = edges.upper[at[0]] - edges.lower[at[0]]
    assert np.all(width > 1e-4)
    system = rig(**{"model.modes": 2})
    for j, inertia in enumerate(edges.at):
        middle = 0.5 * (edges.upper[at[0], j] + edges.lower[at[0], j])
        assert not el.floquet_multipliers(system, middle, follower_inertia=inertia).stable


def test_picture_labels_combinations(traced):
    axes = traced.plot()
    labels = {text.get_text() for text in axes.get_legend().get_texts()}
    assert {"principal regions, traced", "sum regions, traced"} <= labels
    assert any(text.get_text() == "1+2, 10" for text in axes.texts)
    table = traced.to_dict()
    assert "sum" in table["edges"]["kind"]


def test_command_takes_the_order(tmp_path, capsys):
    picture = tmp_path / "chart.svg"
    assert main([*LINE, "--order", "4", "--plot", str(picture)]) == 0
    assert "boundary of order 4" in picture.read_text()
    assert main([*LINE, "--order", "4", "--json"]) == 0
    assert '"order": 4' in capsys.readouterr().out


def test_command_lists_traced_combinations(capsys):
    axes = ["--x", "speed=79:83:9rad/s", "--y", "follower_inertia=0.0006:0.0008:2"]
    assert main(["chart", RIG, "--set", "model.modes=2", *axes, "--edges"]) == 0
    assert "sum of 1 and 2" in capsys.readouterr().out
