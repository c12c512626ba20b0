"""Sweeps: the same bytes by any workers and order, stores, refusals, estimates."""

import io
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path

import elastolink as el
import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput, ElastolinkWarning, LinearRangeWarning
from elastolink.runtime.scenes import with_numbers
from elastolink.runtime.sweeps import Sweep, WorkersLost, estimate_sweep, sweeping
from elastolink.runtime.sweeps.pieces import grid_of
from elastolink.runtime.sweeps.requests import digest
from elastolink.runtime.systems import rod_system
from fresh_process import python

MU, LAM2 = np.linspace(0.0, 3.0, 23), np.linspace(-0.5, 6.0, 31)
VALUES = {"mu": MU, "lam2": LAM2}
CHART = "stability_chart"


def square_sum(subject, a, b=1.0):
    """A function of one's own: a number and an array at each point."""
    return {"sum": subject * a**2 + b, "pair": np.array([a, b])}


def fails_at_two(subject, a):
    if a == 2.0:
        raise BadInput("a is two")
    return a


def now_and_then(subject, a, b):
    """A whole number, a truth, a pair and a text; errors of several kinds at known points."""
    if a == 1.0:
        raise BadInput("a is one")
    if b == 2.0:
        return {"n": 1 // int(b - 2.0)}
    return {"n": int(a), "right": a > b, "pair": [a + 1j * b, b], "text": f"{a:g}"}


def only_at(subject, a):
    if a != subject:
        raise BadInput("nothing here")
    return a


def ends_the_process(subject, a):
    os._exit(3)


@pytest.fixture(scope="module")
def mathieu():
    return el.load_scene("mathieu").system()


@pytest.fixture(scope="module")
def chart(mathieu) -> Sweep:
    return el.sweep("stability_chart", mathieu, VALUES, chunk=150)


@pytest.fixture(scope="module")
def pool():
    with el.process_pool(2) as found:
        yield found


def same_bytes(one: Sweep, other: Sweep) -> bool:
    return sorted(one.outputs) == sorted(other.outputs) and all(
        one[name].tobytes() == other[name].tobytes() for name in one.outputs
    )


def contents(path: Path) -> dict[str, bytes]:
    files = [path] if path.is_file() else sorted(path.rglob("*"))
    return {str(p.relative_to(path)): p.read_bytes() for p in files if p.is_file()}


@pytest.mark.parametrize("chunk", [1, 2, 5, 7, 12, 40, 1000])
@pytest.mark.parametrize(
    ("shape", "rows"), [*product([(4, 5), (3, 2), (7, 3)], [False, True]), ((3, 4, 5), False)]
)
def test_pieces_are_runs_that_cover_the_grid_once(chunk, shape, rows):
    axes = {name: np.arange(float(n)) for name, n in zip("abc", shape, strict=False)}
    grid = grid_of(axes, chunk, rows=rows)
    runs = [grid.run(number) for number in range(grid.pieces)]
    assert [i for run in runs for i in range(run.start, run.stop)] == list(range(grid.points))
    every = [*product(*axes.values())]
    for number, run in enumerate(runs):
        values = grid.values(number)
        assert [*product(*values.values())] == every[run]
        if rows:
            assert len(values["b"]) == shape[1]
            assert len(values["a"]) >= 2
    if not rows:
        assert max(run.stop - run.start for run in runs) <= chunk


def test_a_chart_in_pieces_is_the_chart(mathieu, chart):
    whole = el.stability_chart(mathieu, ("lam2", LAM2), ("mu", MU), boundaries=False)
    assert chart.pieces > 3
    assert np.array_equal(chart["stable"], whole.stable)
    assert np.array_equal(chart["kind"], whole.kind)
    # Both errors, of half traces X, as the modulus X + sqrt(X^2 - 1) moves with them.
    moved = 2.0 * (chart["slack"] + whole.slack) * chart["largest"]
    assert np.all(np.abs(chart["largest"] - whole.largest) <= moved)
    assert chart.passed
    assert chart.error <= 1e-9


@pytest.mark.parametrize("name", ["whole.npz", "folder"])
def test_a_store_gives_the_same_bytes_and_is_found_again(tmp_path, mathieu, chart, name):
    store = tmp_path / name
    first = el.sweep("stability_chart", mathieu, VALUES, chunk=150, store=store)
    before = contents(store)
    again = el.sweep("stability_chart", mathieu, VALUES, chunk=150, store=store)
    assert same_bytes(first, chart)
    assert same_bytes(again, chart)
    assert (first.resumed, again.resumed) == (0, first.pieces)
    assert (again.error, again.checks) == (first.error, first.checks) == (chart.error, chart.checks)
    assert contents(store) == before
    assert [p.name for p in tmp_path.iterdir()] == [name]
    assert isinstance(first["stable"], np.memmap) == (name == "folder")


@pytest.mark.parametrize("name", ["whole.npz", "folder"])
def test_a_resumed_sweep_ends_with_the_same_bytes(tmp_path, mathieu, name, monkeypatch):
    """Pieces missing, cut short, and a file that a killed process had begun."""
    store, other = tmp_path / name, tmp_path / "other" / name
    other.parent.mkdir()
    el.sweep("stability_chart", mathieu, VALUES, chunk=150, store=other)
    grid = grid_of(VALUES, 150, rows=True)
    write, left = sweeping.Store.write, iter(range(3))

    def stopping(store, number, piece):
        """Write three pieces; then the user stops the program."""
        if next(left, None) is None:
            raise KeyboardInterrupt
        write(store, number, piece)

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(sweeping.Store, "write", stopping)
        el.sweep("stability_chart", mathieu, VALUES, chunk=150, store=store)
    folder = (store if name == "folder" else tmp_path / f"{name}.parts") / "pieces"
    pieces = sorted(folder.iterdir())
    assert len(pieces) == 3 < grid.pieces
    pieces[1].write_bytes(pieces[1].read_bytes()[:-100])
    (folder / ".00000004.npz.abcd1234").write_bytes(b"half")
    found = el.sweep("stability_chart", mathieu, VALUES, chunk=150, store=store)
    assert found.resumed == len(pieces) - 1
    assert contents(store) == contents(other)


KILLED = """
import sys, time, numpy as np, elastolink as el
from elastolink.runtime.sweeps import sweeping
quick = sweeping.Store.write
def write(self, number, piece):
    quick(self, number, piece)
    time.sleep(0.2)
sweeping.Store.write = write
values = {"mu": np.linspace(0.0, 3.0, 60), "lam2": np.linspace(-0.5, 6.0, 50)}
el.sweep("stability_chart", el.load_scene("mathieu"), values, chunk=100, store=sys.argv[1])
"""


@pytest.mark.parametrize("name", ["folder", pytest.param("whole.npz", marks=pytest.mark.slow)])
def test_a_killed_process_is_taken_up_by_another(tmp_path, name):
    """While it runs its store is its own; killed, another process ends with the same bytes."""
    store, other = tmp_path / "killed" / name, tmp_path / "other" / name
    store.parent.mkdir()
    other.parent.mkdir()
    values = {"mu": np.linspace(0.0, 3.0, 60), "lam2": np.linspace(-0.5, 6.0, 50)}
    request = ("stability_chart", el.load_scene("mathieu"), values)
    folder = (store if name == "folder" else store.with_name(f"{name}.parts")) / "pieces"
    running = subprocess.Popen([sys.executable, "-c", KILLED, str(store)])
    try:
        until = time.monotonic() + 60.0
        while time.monotonic() < until and len(list(folder.glob("0*.npz"))) < 4:
            time.sleep(0.01)
        if sys.platform != "win32":
            with pytest.raises(BadInput, match="another process at work"):
                el.sweep(*request, chunk=100, store=store)
    finally:
        running.send_signal(signal.SIGKILL)
    assert running.wait() == -signal.SIGKILL
    had = len(list(folder.glob("0*.npz")))
    found = el.sweep(*request, chunk=100, store=store)
    assert 4 <= found.resumed == had < found.pieces == 30
    el.sweep(*request, chunk=100, store=other)
    assert contents(store.parent) == contents(other.parent)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"values": {"mu": MU, "lam2": LAM2 + 1e-9}}, "values"),
        ({"chunk": 140}, "pieces"),
        ({"options": {"rtol": 1e-9}}, "options"),
        ({"outputs": ("stable",)}, "outputs"),
        ({"subject": el.load_scene("mathieu", {"parameters.damping": 0.5}).system()}, "subject"),
        ({"what": square_sum, "subject": 1.0, "values": {"a": [1.0, 2.0]}}, "task"),
    ],
)
def test_a_store_of_another_request_is_refused(tmp_path, mathieu, changed, told):
    store = tmp_path / "store"
    el.sweep("stability_chart", mathieu, VALUES, chunk=200, store=store)
    before = contents(store)
    asked = {"what": "stability_chart", "subject": mathieu, "values": VALUES, "chunk": 200}
    asked |= changed
    first = [asked.pop(name) for name in ("what", "subject", "values")]
    with pytest.raises(BadInput, match=f"a sweep that differs in .*{told}") as refusal:
        el.sweep(*first, store=store, **asked)
    assert len(refusal.value.problems) == 1
    assert contents(store) == before


@pytest.mark.parametrize("name", ["taken.npz", "taken"])
def test_what_is_no_store_is_left_alone(tmp_path, mathieu, name):
    place = tmp_path / name
    if name == "taken":
        place.mkdir()
        (place / "letter.txt").write_text("dear")
    else:
        np.savez(place, a=np.zeros(3))
    before = contents(place)
    with pytest.raises(BadInput, match="taken"):
        el.sweep("stability_chart", mathieu, VALUES, store=place)
    assert contents(place) == before


def flipped(data: bytes, rng: np.random.Generator) -> bytes:
    """Return a file's bytes with one bit turned over."""
    place = int(rng.integers(8 * len(data)))
    changed = bytearray(data)
    changed[place // 8] ^= 1 << place % 8
    return bytes(changed)


def other_array(data: bytes) -> bytes:
    """Return a sound file with an array of another shape."""
    stream = io.BytesIO()
    np.save(stream, np.zeros((3, 2)))
    return stream.getvalue()


def odd_compression(data: bytes) -> bytes:
    """Return an archive whose entries name a compression that there is not."""
    changed = bytearray(data)
    for mark, place in ((b"PK\x03\x04", 8), (b"PK\x01\x02", 10)):
        at = -1
        while (at := changed.find(mark, at + 1)) >= 0:
            changed[at + place] = 77
    return bytes(changed)


SUM = (square_sum, 2.0, {"a": [1.0, 2.0, 3.0], "b": [0.0, 1.0, 2.0, 5.0]})


def stopped(store: Path, monkeypatch) -> None:
    """Leave a store whose user stopped the program when all pieces were there."""

    def stop(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(sweeping.Store, "join", stop)
        el.sweep(*SUM, chunk=4, store=store)


@pytest.mark.parametrize("name", ["whole.npz", "folder"])
@pytest.mark.parametrize("complete", [True, False])
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2, 3))])
def test_a_damaged_store_is_refused_or_done_anew(tmp_path, monkeypatch, name, complete, seed):
    """Bits, truncations, strange files, swaps: what is answered is right, and the store mended."""
    rng = np.random.default_rng(seed)
    good, store = tmp_path / "good" / name, tmp_path / "bad" / name
    good.parent.mkdir()
    right = el.sweep(*SUM, chunk=4, store=good)
    refused = mended = 0
    for turn in range(40):
        shutil.rmtree(store.parent, ignore_errors=True)
        store.parent.mkdir()
        if complete:
            (shutil.copytree if good.is_dir() else shutil.copy)(good, store)
        else:
            stopped(store, monkeypatch)
        every = sorted(p for p in store.parent.rglob("*") if p.is_file())
        path = every[int(rng.integers(len(every)))]
        data = path.read_bytes()
        other = every[int(rng.integers(len(every)))].read_bytes()
        kinds = [
            lambda d: flipped(d, rng),
            lambda d: d[: int(rng.integers(len(d)))],
            other_array,
            odd_compression,
            lambda d: other,  # noqa: B023
            lambda d: b"[" * 100_000,
            lambda d: b"[1, 2]",
            lambda d: b"{}",
            lambda d: d + b"more",
        ]
        new = kinds[0 if turn % 2 else turn // 2 % len(kinds)](data)
        path.write_bytes(new)
        try:
            found = el.sweep(*SUM, chunk=4, store=store)
        except BadInput as refusal:
            assert "\n" not in str(refusal)
            assert path.name in str(refusal) or path.parent.name in str(refusal)
            assert path.read_bytes() == new
            refused += 1
            continue
        assert same_bytes(found, right)
        assert {n: a.shape for n, a in found.outputs.items()} == {"sum": (3, 4), "pair": (3, 4, 2)}
        if path.suffix == ".npy" and new != data:
            assert found.damaged[0].startswith(path.name)
        if found.damaged or not complete:  # else where nothing is kept: a date, a space
            assert contents(store) == contents(good)
        del found
        mended += 1
    assert mended or name == "whole.npz"
    assert refused or not complete


def test_only_damaged_pieces_are_done_anew_and_told(tmp_path, monkeypatch):
    """One bit in an array, one in a piece, a piece in the place of its neighbour."""
    store = tmp_path / "store"
    el.sweep(*SUM, chunk=4, store=store)
    array = store / "sum.npy"
    array.write_bytes(array.read_bytes()[:-1] + b"?")
    found = el.sweep(*SUM, chunk=4, store=store)
    assert (found.resumed, found.pieces) == (2, 3)
    assert found.damaged == ("sum.npy (1 of 3 pieces)",)
    begun = tmp_path / "begun"
    stopped(begun, monkeypatch)
    first, second, third = sorted((begun / "pieces").iterdir())
    shutil.copy(first, second)
    third.write_bytes(third.read_bytes()[:200] + b"!" + third.read_bytes()[201:])
    found = el.sweep(*SUM, chunk=4, store=begun)
    assert found.resumed == 1
    assert found.damaged == ("pieces/00000001.npz", "pieces/00000002.npz")
    assert contents(begun) == contents(store)


def test_files_of_others_in_a_store_stay(tmp_path, monkeypatch):
    """Beside its own a store neither takes nor removes what lies in its folders."""
    foreign = tmp_path / "foreign"
    (foreign / "pieces").mkdir(parents=True)
    (foreign / "pieces" / "keep.txt").write_text("mine")
    with pytest.raises(BadInput, match="something that is no sweep"):
        el.sweep(*SUM, chunk=4, store=foreign)
    assert contents(foreign) == {str(Path("pieces", "keep.txt")): b"mine"}
    for name in ("folder", "whole.npz"):
        store = tmp_path / name
        stopped(store, monkeypatch)
        folder = store if name == "folder" else tmp_path / "whole.npz.parts"
        kept = [folder / "pieces" / "keep.txt", folder / "pieces" / "00009999.npz"]
        kept += [folder / ".keep.me.settings", folder / "notes.npy", folder / "pieces" / "0.npz"]
        for path in kept:
            path.write_text("mine")
        for _ in range(2):
            el.sweep(*SUM, chunk=4, store=store)
            assert [path.read_text() for path in kept] == ["mine"] * len(kept)
    whole = tmp_path / "again.npz"
    el.sweep(*SUM, chunk=4, store=whole)
    beside = tmp_path / "again.npz.parts"
    beside.mkdir()
    (beside / "manifest.json").write_text("[]")
    el.sweep(*SUM, chunk=4, store=whole)
    assert contents(beside) == {"manifest.json": b"[]"}


def test_a_function_of_ones_own_and_results_of_public_ones(tmp_path, pool):
    values = {"a": [1.0, 2.0, 3.0], "b": [0.0, 1.0]}
    own = el.sweep(square_sum, 2.0, values, chunk=4)
    assert np.array_equal(own["sum"], 2.0 * np.array([[1.0], [4.0], [9.0]]) + [0.0, 1.0])
    assert own["pair"].shape == (3, 2, 2)
    assert np.isnan(own.error)
    cranks = {"crank": [0.8, 0.9, 1.0]}
    linkage = el.FourBar(5.0, 1.0, 5.0, 2.0)
    angles = el.sweep("transmission_angle", linkage, cranks, outputs=("least",), chunk=2)
    for crank, least in zip(cranks["crank"], angles["least"], strict=True):
        assert least == el.transmission_angle(el.FourBar(5.0, crank, 5.0, 2.0)).least
    many = el.sweep(
        "transmission_angle", linkage, cranks, outputs=("least",), chunk=2, executor=pool
    )
    assert same_bytes(many, angles)


@pytest.mark.parametrize("chunk", [1, 3, 100])
@pytest.mark.parametrize("name", ["whole", "whole.npz", None])
def test_points_that_fail_keep_their_errors_and_the_others_their_values(tmp_path, name, chunk):
    values = {"a": [0.0, 1.0, 2.0, 3.0], "b": [1.0, 2.0, 4.0]}
    told = {"chunk": chunk} | ({} if name is None else {"store": tmp_path / name})
    with pytest.warns(ElastolinkWarning, match="6 of 12 points failed.*ZeroDivisionError"):
        found = el.sweep(now_and_then, None, values, **told)
    assert sorted(found.failures) == [1, 3, 4, 5, 7, 10]
    assert {found.failures[k] for k in (3, 4, 5)} == {"a is one"}
    assert "6 of 12 points failed" in found.method
    failed = np.isin(np.arange(12), list(found.failures)).reshape(4, 3)
    for k, array in ((1, found["n"]), (2, found["pair"]), (1, found["right"])):
        assert np.array_equal(np.isnan(array), failed if k == 1 else np.stack([failed] * 2, -1))
    assert np.array_equal(found["n"][~failed], [0, 0, 2, 2, 3, 3])
    assert np.array_equal(found["right"][~failed], [0, 0, 1, 0, 1, 0])
    assert np.array_equal(found["text"] == "", failed)
    if name is None:
        return
    with pytest.warns(ElastolinkWarning, match="6 of 12"):
        again = el.sweep(now_and_then, None, values, **told)
    assert again.failures == found.failures and again.resumed == again.pieces
    assert "a is one" in json.dumps(again.to_dict())


def test_damage_beside_failed_points_is_done_anew(tmp_path):
    values = {"a": [0.0, 1.0, 2.0, 3.0], "b": [1.0, 2.0, 4.0]}
    told = {"chunk": 3, "store": tmp_path / "whole"}
    with pytest.warns(ElastolinkWarning):
        el.sweep(now_and_then, None, values, **told)
    files = {path: path.read_bytes() for path in sorted(told["store"].iterdir())}
    for path in told["store"].glob("*.npy"):
        path.write_bytes(path.read_bytes()[:-1] + b"?")
        with pytest.warns(ElastolinkWarning, match="6 of 12"):
            assert el.sweep(now_and_then, None, values, **told).damaged
        assert {path: path.read_bytes() for path in sorted(told["store"].iterdir())} == files


def test_solvers_of_many_points_go_on_beside_those_they_refuse():
    system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    values = {"bending_stiffness": [50.0, -50.0, 60.0], "speed": [50.0, 60.0, 70.0, -np.pi]}
    with pytest.warns(ElastolinkWarning, match="6 of 12 points failed"):
        found = el.sweep("floquet_multipliers", system, values)
    assert sorted(found.failures) == [3, 4, 5, 6, 7, 11]
    assert all("bending_stiffness" in found.failures[k] for k in (4, 5, 6))
    assert all("positive finite speeds" in found.failures[k] for k in (3, 11))
    for row, column in product((0, 2), range(3)):
        stiffness, speed = values["bending_stiffness"][row], values["speed"][column]
        alone = el.floquet_multipliers(system, speed, bending_stiffness=stiffness)
        gap = np.abs(found["multipliers"][row, column] - alone.multipliers)
        assert np.all(gap <= alone.error + found["error"][row, column])


@pytest.mark.parametrize("turned", [False, True])
def test_a_chart_leaves_out_points_that_make_no_system(tmp_path, turned):
    """A rod too short for its crank, in rows or columns; a sound row of a piece may be alone."""
    given = {"crank_ratio": 0.4, "frame": 0.3, "length": 1.2}
    system = rod_system("overhang", 2, **given, bending_stiffness=100.0, mass_per_length=1.0)
    values = {"length": [0.35, 0.4, 0.6, 0.9, 1.2], "speed": np.linspace(30.0, 90.0, 12)}
    if turned:
        values = dict(reversed(values.items()))
    told = {"chunk": 3 * len(values["speed"] if not turned else values["length"])}
    with pytest.warns(ElastolinkWarning, match="24 of 60 points failed.*the block leaves the rod"):
        found = el.sweep("stability_chart", system, values, store=tmp_path / "chart", **told)
    row = (lambda name: found[name].T) if turned else (lambda name: found[name])
    assert np.array_equal(np.isnan(row("largest")), np.isnan(row("stable")))
    assert np.array_equal(np.isnan(row("stable")).all(axis=1), [True, True, False, False, False])
    for length, largest in zip(values["length"][2:], row("largest")[2:], strict=True):
        alone = el.floquet_multipliers(system, values["speed"], length=length, rtol=1e-11)
        modulus = np.abs(alone.multipliers[:, 0])
        assert np.all(np.abs(largest - modulus) <= 1e-7 * modulus)
    with pytest.warns(ElastolinkWarning):
        assert el.sweep("stability_chart", system, values, store=tmp_path / "chart", **told).resumed
    with pytest.raises(BadInput, match="rtol"):
        el.sweep("stability_chart", system, values, options={"rtol": 3.0})


def test_a_store_of_a_function_without_error_figures(tmp_path):
    values = {"a": [1.0, 2.0, 3.0]}
    first = el.sweep(square_sum, 2.0, values, chunk=2, store=tmp_path / "store")
    again = el.sweep(square_sum, 2.0, values, chunk=2, store=tmp_path / "store")
    assert np.isnan([first.error, again.error]).all()
    assert same_bytes(first, again)
    # Plain JSON: no NaN.
    json.loads((tmp_path / "store" / "manifest.json").read_text(), parse_constant=pytest.fail)


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_multipliers_and_steady_states_over_parameters():
    scene = el.load_scene("smith_1972_5152_sixteenth_inch")
    values = {"follower_inertia": [1e-3, 2e-3], "speed": np.linspace(31.0, 40.0, 7)}
    found = el.sweep("floquet_multipliers", scene, values, chunk=3)
    motion = el.sweep("steady_state", scene, values, chunk=3)
    for i, inertia in enumerate(values["follower_inertia"]):
        direct = el.floquet_multipliers(scene.system(), values["speed"], follower_inertia=inertia)
        assert np.all(np.abs(found["multipliers"][i] - direct.multipliers) <= 2 * direct.error)
        assert np.array_equal(found["stable"][i], direct.stable)
        steady = el.steady_state(scene.system(), values["speed"], follower_inertia=inertia)
        assert motion["peak"][i] == pytest.approx(steady.peak(), rel=1e-8)
        growth = np.log(np.abs(direct.multipliers).max(axis=-1))
        assert np.all(np.abs(found["growth"][i] - growth) <= 2 * direct.error.max(axis=-1))


LENGTHS = {"links.coupler": [0.36, 0.45, 0.7], "links.follower": [0.16, 0.2]}


def peak_of(scene, speed):
    return el.steady_state(scene.system(), speed).peak(0.5)


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
def test_numbers_of_a_scene_are_axes(tmp_path):
    """Of solvers of many points, public functions and one's own; failed designs are named."""
    scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.mass_per_length": 0.0853})
    told = {"options": {"speed": 35.0}}
    warned = pytest.warns(ElastolinkWarning, match="2 of 6 points failed.*cannot close")
    with warned:
        motion = el.sweep("steady_state", scene, LENGTHS, chunk=4, **told)
    with warned:
        multipliers = el.sweep("floquet_multipliers", scene, LENGTHS, store=tmp_path / "a", **told)
    with warned:
        own = el.sweep(peak_of, scene, LENGTHS, chunk=1, **told)
    with warned:
        public = el.sweep("natural_frequencies", scene, LENGTHS, outputs=("mean",))
    assert sorted(own.failures) == [4, 5]
    for found in (motion, multipliers, public):
        assert sorted(found.failures) == [4, 5]
    for place in range(4):
        numbers = own.point(place)
        assert numbers == {
            "links.coupler": LENGTHS["links.coupler"][place // 2],
            "links.follower": LENGTHS["links.follower"][place % 2],
        }
        system = with_numbers(scene, numbers).system()
        steady = el.steady_state(system, 35.0)
        assert own["value"].flat[place] == steady.peak(0.5)
        assert motion["peak"].flat[place] == pytest.approx(steady.peak(), rel=1e-9)
        rms = np.sqrt(np.mean(steady.deflection() ** 2))
        assert motion["rms"].flat[place] == pytest.approx(rms, rel=1e-9)
        alone = el.floquet_multipliers(system, 35.0)
        gap = multipliers["multipliers"].reshape(6, -1)[place] - alone.multipliers
        assert np.all(np.abs(gap) <= 2 * alone.error + 1e-14)
        growth = np.log(np.abs(alone.multipliers).max())
        assert multipliers["growth"].flat[place] == pytest.approx(growth, abs=1e-10)
        assert (
            multipliers["error"].flat[place]
            == multipliers["multiplier_error"][np.unravel_index(place, (3, 2))].max()
        )
        mean = el.natural_frequencies(system).mean
        assert np.array_equal(public["mean"].reshape(6, -1)[place], mean)
    metres = dict.fromkeys(LENGTHS, "m")
    assert motion.units == {**metres, "peak": "m", "rms": "m"}
    assert multipliers.units == {**metres, "growth": "per turn"}
    with pytest.raises(BadInput, match=r"axes .*cuopler"):
        el.sweep("steady_state", scene, {"links.cuopler": [0.3]}, **told)
    with pytest.raises(BadInput, match="place"):
        own.point(6)


@pytest.mark.parametrize("name", ["folder", None])
def test_large_deflections_of_a_function_are_told_once_by_threads_too(tmp_path, name):
    """The largest of all points, a check that fails, also from a store; nothing point by point."""
    scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.damping_ratio": 0.01})
    speeds = {"speed": np.linspace(70.0, 90.0, 12)}
    told = {"chunk": 2} | ({} if name is None else {"store": tmp_path / name})
    for _ in range(2):
        with pytest.warns(LinearRangeWarning) as warned, ThreadPoolExecutor(3) as threads:
            found = el.sweep(peak_of, scene, speeds, executor=threads, **told)
        assert len(warned) == 1
        check = found.checks["linear range"]
        assert not found.passed and f"reaches {check.value:.3g} of" in str(warned[0].message)
        assert check.value == pytest.approx(
            found["value"].max() / scene["links"]["coupler"], rel=0.1
        )


def test_failures_by_reason_and_in_a_table(tmp_path):
    values = {"a": [0.0, 1.0, 2.0, 3.0], "b": [1.0, 2.0, 4.0]}
    with pytest.warns(ElastolinkWarning):
        found = el.sweep(now_and_then, None, values, outputs=("n",))
    assert found.reasons() == {found.failures[3]: (3, 4, 5), found.failures[1]: (1, 7, 10)}
    told = {"links: 0.25 m, not 1e-3": (0, 2), "links: short": (1,)}
    some = {0: "links: 0.25 m, not 1e-3", 1: "links: short", 2: "links: -3 m, not 7.5"}
    assert replace(found, failures=some).reasons() == told
    text = found.save(tmp_path / "found.csv").read_text().splitlines()
    assert text[0] == "axis_a,axis_b,failure,n"
    assert text[1:5] == [
        "0.0,1.0,,0.0",
        "0.0,2.0,ZeroDivisionError: integer division or modulo by zero,nan",
        "0.0,4.0,,0.0",
        "1.0,1.0,a is one,nan",
    ]
    assert len(text) == 13


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.ElastolinkWarning")
def test_a_table_has_one_row_for_each_design_and_units_in_its_header(tmp_path):
    """The multipliers stand in a file beside it; truths stay truths where some points failed."""
    scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"coupler.mass_per_length": 0.0853})
    found = el.sweep("floquet_multipliers", scene, LENGTHS, options={"speed": 35.0})
    text = found.save(tmp_path / "designs.csv").read_text().splitlines()
    lengths = "axis_links.coupler [m],axis_links.follower [m]"
    assert text[0] == f"{lengths},failure,growth [per turn],stable,error"
    assert len(text) == 7
    rows = [row.rsplit(",", 2)[1] for row in text[1:]]
    assert rows == [*(str(bool(one)) for one in found["stable"].flat[:4]), "", ""]
    beside = tmp_path / "designs.links.coupler_links.follower_multiplier.csv"
    rows = beside.read_text().splitlines()
    assert len(rows) == 1 + found["multipliers"].size
    assert {"multiplier_error", "multipliers_real", "multipliers_imag"} < {*rows[0].split(",")}
    scene = el.load_scene("smith_1972_5152_sixteenth_inch", {"model.modes": 2})
    motion = el.sweep("steady_state", scene, {"speed": [30.0, 35.0]})
    text = motion.save(tmp_path / "motion.csv").read_text().splitlines()
    assert text[0] == "axis_speed [rad/s],peak [m],rms [m],error" and len(text) == 3
    assert motion.to_xarray()["peak"].attrs == {"units": "m"}
    assert motion.to_xarray()["speed"].attrs == {"units": "rad/s"}


def test_a_linkage_at_a_change_point_but_for_rounding_is_refused_by_its_name():
    scene = el.load_scene("smith_1972_5152_sixteenth_inch")
    lengths = {"links.frame": 0.3, "links.crank": 0.06, "links.coupler": 0.28}
    values = {"links.follower": [0.04, 0.08, 0.16, 0.52]}
    scene = with_numbers(scene, lengths)
    with pytest.warns(ElastolinkWarning, match="3 of 4 points failed"):
        found = el.sweep("floquet_multipliers", scene, values, options={"speed": 62.8})
    # By the doubles alone the crank of the second turns; the others are at the limit itself.
    assert with_numbers(scene, {"links.follower": 0.08}).mechanism().crank_turns
    side = "frame + crank = coupler + follower"
    assert f"at this change point, {side}, the crank cannot" in found.failures[1]
    assert all("the crank cannot turn fully" in found.failures[place] for place in (0, 1, 3))
    assert np.isfinite(found["growth"][2])


def test_the_picture_of_growth_parts_stable_from_unstable():
    """Its line runs where the multipliers leave the unit circle; axes have units."""
    scene = el.load_scene("smith_1972_5152_sixteenth_inch")
    values = {"damping": np.linspace(0.0, 0.4, 9), "speed": np.linspace(70.0, 90.0, 41)}
    found = el.sweep("floquet_multipliers", scene, values)
    assert 0 < np.sum(found["stable"]) < found["stable"].size
    axes = found.plot(output="growth")
    assert axes.get_xlabel() == "speed [rpm]"
    assert axes.get_ylabel().startswith("damping [N s/m")
    assert "black line: growth 0" in axes.get_title()
    (line,) = (one for one in axes.collections if hasattr(one, "levels"))
    assert list(line.levels) == [0.0]
    points = np.concatenate([path.vertices for path in line.get_paths()])
    # No lines in the noise of the undamped row: each point has both kinds beside it.
    steps = np.array([np.ptp(values["speed"]) / 40, np.ptp(values["damping"]) / 8])
    for speed, damping in points * (np.pi / 30.0, 1.0):
        gaps = np.abs(
            np.array(np.meshgrid(values["speed"], values["damping"])).T - (speed, damping)
        )
        near = np.all(gaps <= 1.001 * steps, axis=-1).T
        assert len({*found["stable"][near].tolist()}) == 2
    single = el.sweep("floquet_multipliers", scene, {"speed": values["speed"]})
    lines = single.plot(output="growth").lines
    assert [list(one.get_ydata()) for one in lines[1:]] == [[0.0, 0.0]]


def test_geometry_is_made_anew_within_a_piece():
    rod = el.load_scene("beale_1992_flexible_rod", {"model.modes": 1}).system()
    values = {"speed": [900.0, 1100.0], "crank_ratio": [0.05, 0.1]}
    found = el.sweep("floquet_multipliers", rod, values, chunk=4)
    for i, speed in enumerate(values["speed"]):
        for j, ratio in enumerate(values["crank_ratio"]):
            direct = el.floquet_multipliers(rod.with_geometry(crank_ratio=ratio), speed)
            gap = np.abs(found["multipliers"][i, j] - direct.multipliers)
            assert np.all(gap <= 2 * direct.error + 1e-15)
    alone = {"crank_ratio": values["crank_ratio"]}
    alone = el.sweep("floquet_multipliers", rod, alone, options={"speed": 900.0}, chunk=2)
    assert np.allclose(alone["multipliers"], found["multipliers"][0], rtol=0.0, atol=1e-9)


def test_digests_tell_content_and_nothing_else(mathieu):
    again = el.load_scene("mathieu").system()
    assert digest(mathieu) == digest(again)
    assert digest(mathieu) != digest(mathieu.with_parameters(damping=1e-12))
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})
    assert digest({"x", "y", "z"}) == digest({"z", "y", "x"})
    assert digest([1.0]) != digest([1])
    code = "import elastolink as el; from elastolink.runtime.sweeps.requests import digest;"
    code += "print(digest((el.load_scene('mathieu').system(), {'a', 'b', 'c'}, el.load_scene)))"
    seen = {python(code, PYTHONHASHSEED=seed) for seed in ("1", "2")}
    assert seen == {digest((mathieu, {"a", "b", "c"}, el.load_scene)) + "\n"}


@pytest.mark.parametrize(
    ("what", "values", "options", "message"),
    [
        ("nothing_such", {"a": [1.0]}, {}, "name of a public function"),
        (3, {"a": [1.0]}, {}, "a name or a function"),
        (square_sum, {}, {}, "at least one named axis"),
        (square_sum, {"a": [1.0, np.nan]}, {}, "at least one finite value"),
        (square_sum, {"a": "x"}, {}, "numbers"),
        (square_sum, {"a": [1.0], "c": [1.0]}, {}, "axes"),
        (square_sum, {"a": [1.0]}, {"store": "/proc/none/such"}, "writable"),
        (fails_at_two, {"a": [2.0, 2.0]}, {"chunk": 1}, "all of 2 points.*a is two"),
        (CHART, {"mu": MU}, {}, "two axes"),
        (CHART, {"mu": MU, "lam": LAM2}, {}, "correct the names"),
        ("floquet_multipliers", {"mu": MU}, {}, "a crank speed"),
        (CHART, VALUES, {"chunk": 0}, "chunk"),
        (CHART, VALUES, {"executor": 4}, "executor"),
        (CHART, VALUES, {"outputs": ()}, "outputs"),
        (CHART, VALUES, {"outputs": ("stabel",)}, "outputs"),
        (CHART, VALUES, {"options": {"mu": 1.0}}, "options"),
        (CHART, VALUES, {"store": 3}, "store"),
    ],
)
def test_bad_input_is_refused_by_name(mathieu, what, values, options, message):
    with pytest.raises(BadInput, match=message):
        el.sweep(what, mathieu, values, **options)


def test_a_number_is_no_system_and_no_worker_is_no_pool():
    with pytest.raises(BadInput, match="a linear periodic system"):
        el.sweep(CHART, 1.0, VALUES)
    with pytest.raises(BadInput, match="workers"), el.process_pool(0):
        pass


def test_workers_that_end_and_pools_that_are_shut_are_told():
    with el.process_pool(1) as ending, pytest.raises(WorkersLost, match="the same store"):
        el.sweep(ends_the_process, 1.0, {"a": [1.0]}, executor=ending)
    shut = ThreadPoolExecutor(1)
    shut.shutdown()
    with pytest.raises(BadInput, match="with block"):
        el.sweep(square_sum, 1.0, {"a": [1.0]}, executor=shut)


def test_what_cannot_be_sent_is_told(pool):
    with pytest.raises(BadInput, match="ThreadPoolExecutor"):
        el.sweep(lambda subject, a: a, threading.Lock(), {"a": [1.0]}, executor=pool)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "cloudpickle", None)
        with pytest.raises(BadInput, match="install cloudpickle"):
            el.sweep(lambda subject, a: a, 1.0, {"a": [1.0]}, executor=pool)


NOTEBOOK = """
import elastolink as el
FACTOR = 3.0
def triple(subject, a):
    return FACTOR * a
if __name__ == "__main__":
    with el.process_pool(2) as pool:
        print(el.sweep(triple, None, {"a": [1.0, 2.0]}, chunk=1, executor=pool)["value"])
"""


def test_a_function_of_a_notebook_is_sent_to_processes():
    """Typed in, not in a file that another process could import."""
    pytest.importorskip("cloudpickle", reason="extra cluster is not installed")
    assert python(NOTEBOOK) == "[3. 6.]\n"


WAITING = """
import time, elastolink as el
if __name__ == "__main__":
    with el.process_pool(2) as pool:
        list(pool.map(abs, range(8)))
        print("ready", flush=True)
        time.sleep(600)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_workers_end_when_the_process_that_began_them_is_killed():
    running = subprocess.Popen([sys.executable, "-c", WAITING], stdout=subprocess.PIPE)
    try:
        assert running.stdout.readline() == b"ready\n"
    finally:
        running.kill()
    # It ends when the last process that writes there has ended.
    assert running.communicate(timeout=60) == (b"", None)


STUDY = '''
import numpy as np
import elastolink as el
LIMIT = 2.5
TABLE = {"machine": el.FourBar(5.0, 1.0, 5.0, 2.0), "factors": [1.0, 1.0]}
def helper(a):
    return a + 1.0
def design(subject, a):
    """One design."""
    factor = TABLE["factors"][0] * TABLE["machine"].crank
    return factor * np.min([helper(a), LIMIT, *map(lambda x: x * 3.0, [a])])
'''


def typed(text: str):
    names = {"__name__": "study"}
    exec(text, names)
    return names["design"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        *(
            ("np.min", "np.max"),
            ("a + 1.0", "a + 2.0"),
            ("= 2.5", "= 2.75"),
            ("x * 3.0", "x * 4.0"),
        ),
        *(("[1.0, 1.0]", "[1.0, 1.5]"), ("(5.0, 1.0", "(5.0, 1.25")),
    ],
)
def test_a_store_knows_the_function_that_it_was_begun_with(tmp_path, old, new):
    """Its attributes, helpers, constants and inner functions; not its docstring or its lines."""
    values, store = {"a": [0.5, 1.0, 2.0]}, tmp_path / "store"
    first = el.sweep(typed(STUDY), None, values, store=store)
    assert np.array_equal(first["value"], [1.5, 2.0, 2.5])
    with pytest.raises(BadInput, match="a sweep that differs in function"):
        el.sweep(typed(STUDY.replace(old, new)), None, values, store=store)
    moved = "\n\n" + STUDY.replace("One design", "One design of many")
    again = el.sweep(typed(moved), None, values, store=store)
    assert again.resumed == again.pieces and same_bytes(again, first)


def test_an_estimate_counts_what_the_sweep_holds(mathieu, chart):
    found = estimate_sweep("stability_chart", mathieu, VALUES, chunk=150, workers=2)
    assert (found.points, found.pieces) == (len(MU) * len(LAM2), chart.pieces)
    assert found.bytes == sum(array.nbytes for array in chart.outputs.values())
    assert found.piece_bytes > 0
    assert found.seconds > 0
    assert str(found.points) in str(found)


@pytest.mark.parametrize("good", [0.0, 4.0, 9.0])
def test_an_estimate_passes_over_pieces_that_fail(good):
    found = estimate_sweep(only_at, good, {"a": np.arange(10.0)}, chunk=1)
    assert (found.points, found.pieces, found.bytes) == (10, 10, 80)
    with pytest.raises(BadInput, match=r"all of 10 points.*nothing here"):
        estimate_sweep(only_at, -1.0, {"a": np.arange(10.0)}, chunk=1)


def test_the_result_is_drawn_and_exported(tmp_path, mathieu, chart):
    assert chart.plot().get_title() == "white: stable"
    assert chart.plot(output="largest").get_xlabel() == "lam2"
    with pytest.raises(BadInput, match="output 'none'"):
        chart.plot(output="none")
    data = chart.to_xarray()
    assert data["stable"].dims == ("mu", "lam2")
    assert np.array_equal(data["mu"], MU)
    with np.load(chart.save(tmp_path / "chart.npz")) as held:
        assert np.array_equal(held["stable"], chart["stable"])
    kept = el.sweep("stability_chart", mathieu, VALUES, store=tmp_path / "store")
    told = json.loads(json.dumps(kept.to_dict()))
    assert told["outputs"]["stable"] == {"shape": [23, 31], "type": "bool"}
