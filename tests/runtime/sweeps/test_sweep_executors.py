"""Executors of solvers, on clusters, a study that is killed, the command line, 1e7 points."""

import importlib.util
import json
import subprocess
import sys
import tempfile
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from types import ModuleType

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.cli import main
from elastolink.runtime.core.errors import BadInput, ElastolinkWarning
from elastolink.runtime.core.workers import WorkersLost, at_once, in_order
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


# The study of docs/clusters.md; a file of a user, no module that a worker could import.
EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "coupler_study.py"
BENT = "ignore::elastolink.runtime.core.errors.LinearRangeWarning"
FAILED = "ignore:.*points failed:elastolink.runtime.core.errors.ElastolinkWarning"


def example() -> ModuleType:
    spec = importlib.util.spec_from_file_location("coupler_study", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@contextmanager
def dask(**told):
    distributed = pytest.importorskip("distributed", reason="extra cluster is not installed")
    given = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None} | told
    with distributed.LocalCluster(**given) as cluster, distributed.Client(cluster) as client:
        yield client.get_executor()


@contextmanager
def loky():
    reason = "extra cluster is not installed"
    externals = pytest.importorskip("joblib.externals.loky", reason=reason)
    with externals.get_reusable_executor(max_workers=2) as found:
        yield found


class Jobs(ThreadPoolExecutor):
    """A job of a cluster for each piece, as in docs/clusters.md."""

    def __init__(self, jobs, at_once):
        super().__init__(at_once)
        self.jobs = jobs

    def submit(self, function, *arguments):
        return super().submit(lambda: self.jobs.submit(function, *arguments).result())


@contextmanager
def submitit():
    jobs = pytest.importorskip("submitit", reason="extra cluster is not installed")
    with tempfile.TemporaryDirectory() as folder, Jobs(jobs.LocalExecutor(folder), 2) as found:
        found.jobs.update_parameters(timeout_min=5)
        yield found


@pytest.fixture(scope="module")
def alone():
    """The study of 225 designs, one after another."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ElastolinkWarning)
        return example().study(15, chunk=50)


@pytest.mark.slow
@pytest.mark.filterwarnings(FAILED, BENT)
@pytest.mark.parametrize(
    "executor",
    [
        partial(el.process_pool, 2),
        dask,
        partial(dask, processes=False),
        loky,
        submitit,
    ],
)
def test_a_study_does_not_depend_on_its_executor(tmp_path, alone, executor):
    """Bytes, failures and the files of the store."""
    study = partial(example().study, 15, chunk=50)
    with executor() as found:
        other = study(executor=found, store=tmp_path / "other")
    study(store=tmp_path / "alone")
    assert len(alone.failures) > 20
    assert other.failures == alone.failures
    for name in alone.outputs:
        assert other[name].tobytes() == alone[name].tobytes()
    for path in (tmp_path / "alone").iterdir():
        assert (tmp_path / "other" / path.name).read_bytes() == path.read_bytes()


@pytest.mark.slow
def test_dask_tells_how_many_workers_it_has_and_that_they_ended():
    names = {"__name__": "typed"}
    exec("import os\ndef ends(subject, a):\n    os._exit(3)", names)
    with dask(n_workers=1, threads_per_worker=7, processes=False) as seven:
        assert at_once(seven) == 7
    config = pytest.importorskip("dask").config
    with (
        config.set({"distributed.scheduler.allowed-failures": 0}),
        dask(n_workers=1) as one,
        pytest.raises(WorkersLost, match="the same store"),
    ):
        el.sweep(names["ends"], None, {"a": [1.0]}, executor=one)


SLOWLY = """
import runpy, sys, time
from elastolink.runtime.sweeps import sweeping
quick = sweeping.Store.write
def write(self, number, piece):
    quick(self, number, piece)
    time.sleep(0.1)
if __name__ == "__main__":
    sweeping.Store.write = write
    runpy.run_path(sys.argv[1], run_name="__main__")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_a_killed_study_goes_on_and_names_the_designs_that_failed(tmp_path):
    """The page's script, killed in the middle, and begun again with the same words."""
    killed, whole, table = (tmp_path / name for name in ("killed", "whole", "table.csv"))
    words = ["--count", "15", "--chunk", "15", "--workers", "2"]
    slowly = [sys.executable, "-c", SLOWLY.replace("sys.argv[1]", repr(str(EXAMPLE)))]
    pieces = killed / "pieces"
    running = subprocess.Popen([*slowly, str(killed), *words], stderr=subprocess.PIPE)
    try:
        until = time.monotonic() + 60.0
        while time.monotonic() < until and len(list(pieces.glob("0*.npz"))) < 4:
            time.sleep(0.01)
    finally:
        running.kill()
    # It ends when its workers have ended, too.
    running.communicate(timeout=60)
    assert 4 <= len(list(pieces.glob("0*.npz"))) < 15

    def run(store):
        command = [sys.executable, str(EXAMPLE), str(store), *words, "--csv", str(table)]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout

    told, other = run(killed), run(whole)
    assert "15 pieces, 0 of them from the store" in other
    assert told.splitlines()[1:] == other.splitlines()[1:]
    assert told.splitlines()[0] != other.splitlines()[0]
    assert sorted(p.name for p in killed.iterdir()) == sorted(p.name for p in whole.iterdir())
    for path in whole.iterdir():
        assert (killed / path.name).read_bytes() == path.read_bytes()
    failed = [line for line in table.read_text().splitlines() if '"' in line]
    counts = [int(line.split()[0]) for line in other.splitlines() if " failed, the first: " in line]
    assert len(failed) == sum(counts) > 20
    assert all("cannot close" in line or "cannot turn fully" in line for line in failed)


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
try:  # its own peak: the other one begins with that of the process which it was forked from
    with open("/proc/self/status") as status:
        print(status.read().split("VmHWM:")[1].split()[0])
except OSError:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
@pytest.mark.parametrize("way", ["store", "memory"])
def test_ten_million_points_within_two_gigabytes(tmp_path, way):
    pytest.importorskip("resource")
    unit = 1 if sys.platform == "darwin" else 1024
    assert int(python(TEN_MILLION, way, str(tmp_path / "store"))) * unit < MOST_MEMORY
