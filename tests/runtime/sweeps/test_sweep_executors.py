"""Executors of the solvers themselves, Dask, the command line, a chart of 1e7 points."""

import json
import sys
from concurrent.futures import ThreadPoolExecutor

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.workers import in_order
from fresh_process import python

FIELDS = ("invariants", "stable", "largest", "slack", "undecided", "kind")
# What a chart of 1e7 points may take [bytes], issue 7.
MOST_MEMORY = 2e9


@pytest.fixture(scope="module")
def pool():
    with el.process_pool(2) as found:
        yield found


@pytest.fixture(scope="module")
def rod():
    return el.load_scene("beale_1992_flexible_rod", {"model.modes": 1}).system()


@pytest.fixture(scope="module")
def coupler():
    return el.load_scene("smith_1972_5152_sixteenth_inch").system()


def charts(rod, coupler):
    """One chart of each path: lines at nodes, every line, a fixed speed, rows of half traces."""
    few, more = (("crank_ratio", np.linspace(0.02, 0.2, count)) for count in (5, 14))
    stiffness = ("bending_stiffness", np.linspace(3e4, 4e4, 12))
    inertia = ("follower_inertia", np.linspace(1e-3, 5e-3, 20))
    damping = ("damping", np.linspace(0.0, 1.0, 18))

    def speeds(low, high, count):
        return "speed", np.linspace(low, high, count)

    return [
        (rod, speeds(1500.0, 4000.0, 40), more, {}),
        (rod, speeds(1500.0, 4000.0, 8), few, {}),
        (rod, stiffness, few, {"speed": 2000.0}),
        (coupler, speeds(40.0, 90.0, 30), inertia, {}),
        (coupler, speeds(40.0, 90.0, 9), damping, {}),
    ]


@pytest.mark.parametrize(
    "number", [0, 3, *(pytest.param(n, marks=pytest.mark.slow) for n in (1, 2, 4))]
)
def test_a_chart_does_not_depend_on_who_works_it_out(rod, coupler, pool, number):
    system, x, y, options = charts(rod, coupler)[number]
    alone = el.stability_chart(system, x, y, **options)
    with ThreadPoolExecutor(3) as threads:
        others = [
            el.stability_chart(system, x, y, workers=workers, **options)
            for workers in (pool.map, in_order(pool), threads.map)
        ]
    for other in others:
        for name in FIELDS:
            assert getattr(other, name).tobytes() == getattr(alone, name).tobytes(), name
        assert (other.error, other.nodes) == (alone.error, alone.nodes)


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
@pytest.mark.parametrize("solver", ["stability_chart", "floquet_multipliers", "steady_state"])
def test_points_do_not_depend_on_who_works_them_out(coupler, pool, solver):
    values = {"speed": np.linspace(30.0, 50.0, 12), "follower_inertia": [6.5e-4, 7e-4]}
    alone = el.sweep(solver, coupler, values, chunk=5)
    with ThreadPoolExecutor(2) as threads:
        others = [el.sweep(solver, coupler, values, chunk=5, executor=e) for e in (pool, threads)]
    assert alone.pieces > 2
    for other in others:
        for name, array in alone.outputs.items():
            assert other.outputs[name].tobytes() == array.tobytes(), name


def test_what_is_no_map_is_refused():
    mathieu = el.load_scene("mathieu").system()
    with pytest.raises(BadInput, match=r"pool\.map"):
        el.stability_chart(mathieu, ("lam2", [0.0, 1.0]), ("mu", [0.0, 1.0]), workers=2)


def test_the_command_line_keeps_and_finds_a_chart(tmp_path, capsys):
    store = tmp_path / "chart"
    words = ["chart", "mathieu", "--x", "lam2=-0.5:10:40", "--y", "mu=0:4:30"]
    words += ["--store", str(store)]
    assert main([*words, "--estimate"]) == 0
    assert "1200 points in 1 pieces" in capsys.readouterr().out
    assert not store.exists()
    assert main([*words, "--plot", str(tmp_path / "chart.png")]) == 0
    assert "0 of them found there" in capsys.readouterr().out
    assert main([*words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["resumed"] == told["pieces"] == 1
    assert told["outputs"]["kind"] == {"shape": [30, 40], "type": "int8"}
    for wrong in (["--order", "3"], ["--edges"], ["--workers", "none"], ["--set", "model.modes=0"]):
        assert main([*words, *wrong]) == 2
    assert main([*words[:-2], "--estimate"]) == 2
    assert main([*words[:5], "mu=0:3:30", "--y", "mu=0:3:31", "--store", str(store)]) == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.slow
def test_an_executor_of_dask_gives_the_same_bytes(rod):
    distributed = pytest.importorskip("distributed", reason="extra cluster is not installed")
    values = {"speed": np.linspace(2000.0, 4000.0, 12)}
    alone = el.sweep("floquet_multipliers", rod, values, chunk=4)
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = el.sweep(
            "floquet_multipliers", rod, values, chunk=4, executor=client.get_executor()
        )
    for name in alone.outputs:
        assert found[name].tobytes() == alone[name].tobytes()


TEN_MILLION = """
import resource, sys, numpy as np, elastolink as el
x, y = np.linspace(-0.5, 30.0, 4000), np.linspace(0.0, 4.0, 2500)
system = el.load_scene("mathieu").system()
if sys.argv[1] == "store":
    chart = el.sweep("stability_chart", system, {"mu": y, "lam2": x}, store=sys.argv[2])
    stable = chart["stable"]
else:
    chart = el.stability_chart(system, ("lam2", x), ("mu", y), boundaries=False)
    stable = chart.stable
assert chart.passed and stable.shape == (2500, 4000)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
@pytest.mark.parametrize("way", ["store", "memory"])
def test_ten_million_points_within_two_gigabytes(tmp_path, way):
    pytest.importorskip("resource")
    unit = 1 if sys.platform == "darwin" else 1024
    assert int(python(TEN_MILLION, way, str(tmp_path / "store"))) * unit < MOST_MEMORY
